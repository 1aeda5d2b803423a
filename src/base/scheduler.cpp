// oneTBB is not built with the thread sanitizer, which therefore does not see how oneTBB orders what its
// threads do. With VOX_TSAN this file is not instrumented, and reports the order to the sanitizer itself.
#include "base/scheduler.hpp"

#include <algorithm>

#if defined(VOX_TBB)
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#if defined(VOX_TSAN)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace vox {

#if defined(VOX_TBB)

namespace {

// Everything before release() on one thread happens before acquire() returns on another.
#if defined(VOX_TSAN)
void acquire(void* address) { __tsan_acquire(address); }
void release(void* address) { __tsan_release(address); }
#else
void acquire(void*) {}
void release(void*) {}
#endif

} // namespace

struct Scheduler::Arena : tbb::task_arena {
    using task_arena::task_arena;
};

// oneTBB has no more threads than there are cores, and prints a warning when asked for more.
std::uint32_t Scheduler::most_workers(std::uint32_t asked) {
    if (asked == 1) return 1;
    const int cores = tbb::task_arena(tbb::task_arena::automatic).max_concurrency();
    const std::uint32_t most =
        std::clamp<std::uint32_t>(static_cast<std::uint32_t>(cores), 1, VOX_MAX_WORKERS);
    return asked == 0 ? most : std::min(asked, most);
}

Scheduler::Scheduler(std::uint32_t worker_count)
    : arena_(std::make_unique<Arena>(static_cast<int>(worker_count))) {}

void Scheduler::run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context) {
    release(context);
    arena_->execute([&] {
        using Range = tbb::blocked_range<std::uint64_t>;
        // Isolated, so that it is not cancelled with the caller's tasks.
        tbb::task_group_context own(tbb::task_group_context::isolated);
        tbb::parallel_for(
            Range(0, items, std::max<std::uint64_t>(min_range, 1)),
            [&](const Range& range) {
                acquire(context);
                const int worker = tbb::this_task_arena::current_thread_index();
                task(range.begin(), range.end(), static_cast<std::uint32_t>(worker), context);
                release(context);
            },
            own);
    });
    acquire(context);
}

#else

struct Scheduler::Arena {};

std::uint32_t Scheduler::most_workers(std::uint32_t) { return 1; }

Scheduler::Scheduler(std::uint32_t) {}

void Scheduler::run(vox_task* task, std::uint64_t items, std::uint64_t, void* context) {
    task(0, items, 0, context);
}

#endif

Scheduler::~Scheduler() = default;

} // namespace vox
