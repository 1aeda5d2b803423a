#include "gpu/host_backend.hpp"

#include "gpu/stages.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

namespace vox::gpu {
namespace {

constexpr unsigned char poison_byte = 0xee;
constexpr std::size_t guard_size = 64;

std::atomic<const char*> first_fault{nullptr};

class HostLauncher {
public:
    explicit HostLauncher(const HostOrder& order) : order_(order) {}

    template <class Kernel>
    void items(u32 count, const Kernel& kernel) {
        share(count, [&](u32 begin, u32 end) {
            for (u32 i = begin; i < end; ++i) kernel(place(i, count));
        });
    }
    template <class Kernel>
    void groups(u32 count, const Kernel& kernel) {
        share(count, [&](u32 begin, u32 end) {
            const Group group(order_.lanes, order_.lane_offset);
            for (u32 i = begin; i < end; ++i) {
                alignas(typename Kernel::Shared) unsigned char memory[sizeof(typename Kernel::Shared)];
                std::memset(memory, poison_byte, sizeof memory);
                kernel(group, place(i, count), *new (memory) typename Kernel::Shared);
            }
        });
    }
    template <class Kernel>
    void counted(const u32* count, u32 room, u32 least, const Kernel& kernel) {
        items(std::max(*count <= room ? *count : 0, least), kernel);
    }
    void sum(const u32* from, u32* to, u32 count) {
        u32 before = 0;
        for (u32 i = 0; i < count; ++i) {
            const u32 value = from[i]; // `to` may be where `from` is
            to[i] = before;
            before += value;
        }
    }

private:
    u32 place(u32 i, u32 count) const {
        return static_cast<u32>((u64{i} * order_.items + order_.item_offset) % count);
    }
    template <class Work>
    void share(u32 count, Work&& work) {
        const u32 workers = std::max(1u, std::min(order_.workers, count));
        const auto part = [&](u32 w) {
            work(static_cast<u32>(u64{count} * w / workers),
                 static_cast<u32>(u64{count} * (w + 1) / workers));
            if (phase_check.fault) first_fault = phase_check.fault;
            phase_check.fault = nullptr;
        };
        std::vector<std::thread> others;
        for (u32 w = 1; w < workers; ++w) others.emplace_back(part, w);
        part(0);
        for (std::thread& other : others) other.join();
    }

    HostOrder order_;
};

class HostBackend final : public Backend {
public:
    explicit HostBackend(const HostOrder& order) : order_(order) {}
    ~HostBackend() override {
        for (const Block& block : blocks_) std::free(block.memory);
    }
    HostBackend(const HostBackend&) = delete;
    HostBackend& operator=(const HostBackend&) = delete;

    void* allocate(std::size_t bytes, bool work) override {
        blocks_.reserve(blocks_.size() + 1);
        auto* memory = static_cast<unsigned char*>(std::malloc(bytes + 2 * guard_size));
        if (!memory) throw std::bad_alloc();
        std::memset(memory, poison_byte, bytes + 2 * guard_size);
        blocks_.push_back({memory, bytes, work});
        return memory + guard_size;
    }
    void release(void* memory) noexcept override {
        const auto is_it = [memory](const Block& b) { return b.memory + guard_size == memory; };
        const auto at = std::find_if(blocks_.begin(), blocks_.end(), is_it);
        if (at == blocks_.end()) return;
        std::free(at->memory);
        blocks_.erase(at);
    }
    void write(void* to, const void* from, std::size_t bytes) override {
        if (bytes) std::memcpy(to, from, bytes);
    }
    void read(void* to, const void* from, std::size_t bytes) override {
        if (bytes) std::memcpy(to, from, bytes);
    }
    void step(const SceneArrays& scene, void*) override {
        for (const Block& block : blocks_)
            if (order_.poison && block.work) std::memset(block.memory + guard_size, poison_byte, block.bytes);
        HostLauncher launcher(order_);
        launch_step(launcher, scene);
    }
    void wait() override {}

    bool guards_hold() const {
        for (const Block& block : blocks_)
            for (std::size_t i = 0; i < guard_size; ++i)
                if (block.memory[i] != poison_byte ||
                    block.memory[guard_size + block.bytes + i] != poison_byte)
                    return false;
        return true;
    }

private:
    struct Block {
        unsigned char* memory;
        std::size_t bytes;
        bool work;
    };
    HostOrder order_;
    std::vector<Block> blocks_;
};

} // namespace

std::unique_ptr<Backend> make_host_backend(const HostOrder& order) {
    return std::make_unique<HostBackend>(order);
}

const char* take_phase_fault() { return first_fault.exchange(nullptr); }

bool guards_hold(const Backend& host) { return static_cast<const HostBackend&>(host).guards_hold(); }

} // namespace vox::gpu
