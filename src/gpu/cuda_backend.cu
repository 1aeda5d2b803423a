// Launches, device memory and sums: the one file with cuda_runtime.h and CUB.
#include "gpu/backend.hpp"
#include "gpu/stages.hpp"

#include "base/error.hpp"

#include <cub/device/device_scan.cuh>
#include <cuda_runtime.h>

#include <algorithm>

namespace vox::gpu {

constexpr u32 block = 128, groups_of_block = block / lanes;
// Look_up has 80 registers a lane, which an H200 does best with; the short exact kernels have 96.
constexpr int blocks_of_groups = 6, blocks_of_counted = 5;

template <class Kernel>
__global__ void __launch_bounds__(block) run_items(Kernel kernel, u32 count) {
    for (u32 i = blockIdx.x * block + threadIdx.x; i < count; i += gridDim.x * block) kernel(i);
}
template <class Kernel>
__global__ void __launch_bounds__(block, blocks_of_counted)
    run_counted(Kernel kernel, const u32* counted, u32 room, u32 least) {
    const u32 found = *counted <= room ? *counted : 0, count = found > least ? found : least;
    for (u32 i = blockIdx.x * block + threadIdx.x; i < count; i += gridDim.x * block) kernel(i);
}
template <class Kernel>
__global__ void __launch_bounds__(block, blocks_of_groups) run_groups(Kernel kernel, u32 count) {
    __shared__ typename Kernel::Shared shared[groups_of_block];
    const Group group;
    // The same for all lanes of a warp, so that none leaves the loop alone.
    const u32 of_block = threadIdx.x / lanes;
    for (u32 i = blockIdx.x * groups_of_block + of_block; i < count; i += gridDim.x * groups_of_block)
        kernel(group, i, shared[of_block]);
}

namespace {

void check_cuda(cudaError_t error) {
    if (error == cudaSuccess) return;
    if (error == cudaErrorMemoryAllocation) throw std::bad_alloc();
    const bool none = error == cudaErrorNoDevice || error == cudaErrorInsufficientDriver;
    throw Error(none ? VOX_ERROR_UNSUPPORTED : VOX_ERROR_INTERNAL,
                format("CUDA: %s%s", cudaGetErrorString(error),
                       none ? " (vox_gpu needs an NVIDIA GPU and a driver of version 580 or newer)" : ""));
}

class CudaLauncher {
public:
    CudaLauncher(cudaStream_t stream, int processors, void* temporary, std::size_t temporary_bytes)
        : stream_(stream), processors_(static_cast<u32>(processors)), temporary_(temporary),
          temporary_bytes_(temporary_bytes) {}

    template <class Kernel>
    void items(u32 count, const Kernel& kernel) {
        if (count) run_items<<<blocks(count, block), block, 0, stream_>>>(kernel, count);
    }
    template <class Kernel>
    void groups(u32 count, const Kernel& kernel) {
        if (count) run_groups<<<blocks(count, groups_of_block), block, 0, stream_>>>(kernel, count);
    }
    // How many there will be is not known here: as many blocks as run at a time.
    template <class Kernel>
    void counted(const u32* count, u32 room, u32 least, const Kernel& kernel) {
        const u32 most = std::max(room, least);
        const u32 grid = std::min(processors_ * (2048 / block), blocks(most, block));
        if (grid) run_counted<<<grid, block, 0, stream_>>>(kernel, count, room, least);
    }
    void sum(const u32* from, u32* to, u32 count) {
        std::size_t bytes = temporary_bytes_;
        const auto items = static_cast<int>(count);
        check_cuda(cub::DeviceScan::ExclusiveSum(temporary_, bytes, from, to, items, stream_));
    }

private:
    static u32 blocks(u32 count, u32 each) { return (count + each - 1) / each; }

    cudaStream_t stream_;
    u32 processors_;
    void* temporary_;
    std::size_t temporary_bytes_;
};

class CudaBackend final : public Backend {
public:
    explicit CudaBackend(int device) : device_(device) {
        use();
        check_cuda(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device));
    }
    ~CudaBackend() override {
        cudaSetDevice(device_);
        cudaFree(temporary_);
    }
    CudaBackend(const CudaBackend&) = delete;
    CudaBackend& operator=(const CudaBackend&) = delete;

    void* allocate(std::size_t bytes, bool) override {
        use();
        void* memory = nullptr;
        check_cuda(cudaMalloc(&memory, bytes));
        return memory;
    }
    void release(void* memory) noexcept override {
        cudaSetDevice(device_);
        cudaFree(memory);
    }
    void write(void* to, const void* from, std::size_t bytes) override {
        use();
        if (bytes) check_cuda(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice));
    }
    void read(void* to, const void* from, std::size_t bytes) override {
        use();
        if (bytes) check_cuda(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost));
    }
    void prepare(const SceneArrays& s) override {
        use();
        std::size_t most = 0;
        for (const u32 count : {s.vertex_count + 1, s.slots() + 1}) {
            std::size_t bytes = 0;
            check_cuda(cub::DeviceScan::ExclusiveSum(nullptr, bytes, s.cell_count, s.cell_begin,
                                                     static_cast<int>(count)));
            most = std::max(most, bytes);
        }
        if (most > temporary_bytes_) {
            check_cuda(cudaFree(temporary_));
            temporary_ = nullptr;
            check_cuda(cudaMalloc(&temporary_, most));
            temporary_bytes_ = most;
        }
        check_cuda(cudaDeviceSynchronize()); // copies are of another stream than steps
    }
    void step(const SceneArrays& scene, void* stream) override {
        use();
        last_ = static_cast<cudaStream_t>(stream);
        CudaLauncher launcher(last_, processors_, temporary_, temporary_bytes_);
        launch_step(launcher, scene);
        check_cuda(cudaGetLastError());
    }
    void wait() override {
        use();
        check_cuda(cudaStreamSynchronize(last_));
    }

private:
    void use() { check_cuda(cudaSetDevice(device_)); }

    int device_;
    int processors_ = 0;
    void* temporary_ = nullptr;
    std::size_t temporary_bytes_ = 0;
    cudaStream_t last_ = nullptr;
};

} // namespace

std::unique_ptr<Backend> make_backend(int device) { return std::make_unique<CudaBackend>(device); }

} // namespace vox::gpu
