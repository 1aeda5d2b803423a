// The built-in scheduler, which is oneTBB when the library is built with it, and serial otherwise.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <memory>

namespace vox {

class Scheduler {
public:
    // The number of workers that there can be when `asked` are asked for, where 0 asks for one per core.
    static std::uint32_t most_workers(std::uint32_t asked);

    explicit Scheduler(std::uint32_t worker_count);
    ~Scheduler();
    Scheduler(const Scheduler&) = delete;
    Scheduler& operator=(const Scheduler&) = delete;

    // Does what vox_task_system.enqueue and finish do together.
    void run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context);

private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
};

} // namespace vox
