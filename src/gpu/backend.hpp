// Where kernels run and their arrays lie: loops and the heap (host_backend.cpp), or a GPU (cuda_backend.cu).
// A library has one of them.
#pragma once

#include "gpu/scene.hpp"

#include <cstddef>
#include <memory>

namespace vox::gpu {

class Backend {
public:
    virtual ~Backend() = default;

    // `work`: for what each step writes anew. Throws std::bad_alloc.
    virtual void* allocate(std::size_t bytes, bool work) = 0;
    virtual void release(void* memory) noexcept = 0;
    virtual void write(void* to, const void* from, std::size_t bytes) = 0;
    virtual void read(void* to, const void* from, std::size_t bytes) = 0;

    // Allocates what step() needs besides the arrays of these sizes.
    virtual void prepare(const SceneArrays&) {}
    // Enqueues a step into a stream of the backend's kind. Allocates nothing.
    virtual void step(const SceneArrays& scene, void* stream) = 0;
    // Until the last step is done.
    virtual void wait() = 0;
};

// Throws Error.
std::unique_ptr<Backend> make_backend(int device);

} // namespace vox::gpu
