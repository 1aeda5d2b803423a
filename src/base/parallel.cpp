#include "base/parallel.hpp"

#include "base/error.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"
#include "base/sampling.hpp"
#include "base/structs.hpp"

namespace vox {

void check_workers(const vox_task_system& tasks, std::uint32_t worker_count) {
    if (!tasks.enqueue != !tasks.finish)
        refuse("grid tasks has one of enqueue and finish, expected both or none");
    if (worker_count == VOX_ALL_CORES) {
        if (!tasks.enqueue) return;
        refuse("grid worker_count is VOX_ALL_CORES with a task system of "
               "the caller's, expected how many it has");
    }
    if (worker_count > VOX_MAX_WORKERS)
        refuse(format("grid worker_count is %u, the limit is %u", worker_count, VOX_MAX_WORKERS));
}

Workers::Workers(const vox_task_system& tasks, std::uint32_t worker_count, Threads threads)
    : tasks_(tasks), threads_(threads) {
    set_count(worker_count);
}

Workers::~Workers() {
    if (scheduler_ && threads_ == Threads::of_process) Scheduler::leave(std::move(scheduler_));
}

void Workers::set_count(std::uint32_t worker_count) {
    set_default(worker_count, 1u);
    if (tasks_.enqueue) {
        count_ = worker_count;
        return;
    }
    const std::uint32_t count = Scheduler::most_workers(worker_count);
    if (count == count_) return; // and keep the threads
    scheduler_ = count == 1                        ? nullptr
                 : threads_ == Threads::of_process ? Scheduler::of_last_call(count)
                                                   : std::make_unique<Scheduler>(count);
    count_ = count;
}

namespace {

// A hash of the end minus one of the beginning. If ranges follow each other from 0 to `items`, all hashes but
// those of 0 and `items` cancel in their sum. In any other set of ranges some end is the beginning of no
// range, as each range goes forwards; then the sum differs, except with probability 2^-64.
std::uint64_t way(std::uint64_t begin, std::uint64_t end) noexcept {
    return next_random(end) - next_random(begin);
}

} // namespace

Workers::Job::Job(Call* call_, void* callable_, std::uint32_t worker_count_, std::size_t items_) noexcept
    : call(call_), callable(callable_), worker_count(worker_count_), items(items_),
      uncovered(way(0, items_)) {}

void Workers::run_range(std::uint64_t begin, std::uint64_t end, std::uint32_t worker,
                        void* context) noexcept {
    const DefaultFloats floats; // the thread's own environment may be any
    Job& job = *static_cast<Job*>(context);
    std::exception_ptr failure;
    bool runs = false, has_failed = false;
    try {
        if (worker >= job.worker_count || begin > end || end > job.items)
            refuse(format("the task system ran items %llu to %llu of %zu on worker %u of %u", llu(begin),
                          llu(end), job.items, worker, job.worker_count));
        {
            const std::lock_guard lock(job.mutex);
            runs = !job.busy[worker];
            job.busy[worker] = true;
            has_failed = job.failure != nullptr;
        }
        if (!runs)
            refuse(format("the task system ran two ranges on worker %u at the same time, one of them "
                          "items %llu to %llu of %zu",
                          worker, llu(begin), llu(end), job.items));
        // After a failure the rest is not needed, and a worker's buffers may be half written.
        if (!has_failed)
            job.call(job.callable, static_cast<std::size_t>(begin), static_cast<std::size_t>(end), worker);
    } catch (...) {
        failure = std::current_exception();
    }
    const std::lock_guard lock(job.mutex);
    if (runs) job.busy[worker] = false;
    job.done += static_cast<std::size_t>(end - begin);
    job.uncovered -= way(begin, end);
    if (failure && !job.failure) job.failure = failure;
}

void Workers::run(Job& job, std::size_t items, std::size_t min_range) {
    if (tasks_.enqueue) {
        const CallersFloats floats; // a thread that waits may do other work of the caller's
        void* handle = tasks_.enqueue(&run_range, items, min_range, &job, tasks_.user);
        if (handle) tasks_.finish(handle, tasks_.user);
    } else {
        scheduler_->run(&run_range, items, min_range, &job);
    }
    if (job.failure) std::rethrow_exception(job.failure);
    if (job.done != items) refuse(format("the task system ran %zu of %zu items", job.done, items));
    if (job.uncovered != 0)
        refuse(format("the task system ran some of %zu items twice and others not at all", items));
}

} // namespace vox
