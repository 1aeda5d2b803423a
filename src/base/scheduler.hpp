// The built-in scheduler: oneTBB if the library is built with it (VOX_TBB), else threads of its own, else
// none.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <memory>

// What the built-in scheduler runs on, as vox_build_info names it. VOX_NO_THREADS: nothing may need threads.
#if defined(VOX_TBB)
#define VOX_SCHEDULER "oneTBB"
#elif defined(VOX_NO_THREADS) || (defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)) ||           \
    defined(__wasi__)
#define VOX_SCHEDULER "no threads"
#define VOX_SCHEDULER_SERIAL 1
#else
#define VOX_SCHEDULER "std::thread"
#define VOX_SCHEDULER_THREADS 1
#endif

namespace vox {

class Scheduler {
public:
    // The number of workers for a request, where 0 requests one per core.
    static std::uint32_t most_workers(std::uint32_t asked);

    // Threads are made when a task first needs them, and kept. If the system gives fewer, these and the
    // caller's do all the work.
    explicit Scheduler(std::uint32_t worker_count);
    ~Scheduler();

    // For a call without an object to keep a scheduler in: the one that the last such call left, if it has as
    // many workers and no other call uses it, else a new one.
    static std::unique_ptr<Scheduler> of_last_call(std::uint32_t worker_count);
    // Leaves it to the next such call. At most one is kept, until the process ends or the library is
    // unloaded; none if making its threads is as quick, or if they could not be joined then.
    static void leave(std::unique_ptr<Scheduler> scheduler) noexcept;

    Scheduler(const Scheduler&) = delete;
    Scheduler& operator=(const Scheduler&) = delete;

    // Does the work of vox_task_system.enqueue and finish. One thread at a time may call it. After a fork,
    // the child gets threads of its own.
    void run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context);

private:
    struct Pool;
    std::unique_ptr<Pool> pool_;
};

} // namespace vox
