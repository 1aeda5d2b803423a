// Scenes on a device: their arrays, the rooms of lists, positions, steps.
#pragma once

#include "gpu/backend.hpp"
#include "gpu/scene_data.hpp"

#include <vector>

namespace vox::gpu {

// How long lists are whose length a step finds out, and how large the table of cells is. 0: chosen.
struct StepRooms {
    u64 points = 0, findings = 0, contacts = 0;
    u64 bricks = 0; // a power of two
};

class Pipeline {
public:
    // Throws Error(BUDGET) for more than `byte_budget` bytes.
    Pipeline(std::unique_ptr<Backend> backend, const SceneData& data, const StepRooms& rooms,
             u64 byte_budget);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    // Positions on the device, borrowed.
    void bind(const void* positions, u64 byte_stride);

    // Throws Error(INVALID_STATE) for a body without positions. Allocates nothing.
    void step(void* stream);
    // Until the last step is done. Lists that were too short are made longer, and are empty then.
    StepStatus finish();

    const SceneArrays& arrays() const noexcept { return arrays_; }
    const std::vector<BodyOfScene>& bodies() const noexcept { return bodies_; }
    u64 bytes() const noexcept { return bytes_; }
    Backend& backend() noexcept { return *backend_; }

private:
    struct Block {
        void* memory;
        u64 bytes;
    };
    void* allocate(u64 bytes, bool work);
    void release(void* memory) noexcept;
    template <class T>
    const T* copy(const std::vector<T>& from);
    template <class T>
    void make(T*& array, u64 count);
    void make_lists(const StepRooms& rooms);
    void make_work(u64 bricks);

    std::unique_ptr<Backend> backend_;
    u64 byte_budget_, bytes_ = 0;
    std::vector<Block> blocks_;
    SceneArrays arrays_{};
    std::vector<BodyOfScene> bodies_;
};

} // namespace vox::gpu
