// The built-in scheduler: oneTBB where the library is built with it, else serial.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <memory>

namespace vox {

class Scheduler {
public:
    // The most workers there can be of as many as were asked for, 0 for one per core.
    static std::uint32_t most_workers(std::uint32_t asked);

    explicit Scheduler(std::uint32_t worker_count);
    ~Scheduler();
    Scheduler(const Scheduler&) = delete;
    Scheduler& operator=(const Scheduler&) = delete;

    // As vox_task_system.enqueue and finish.
    void run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context);

private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
};

} // namespace vox
