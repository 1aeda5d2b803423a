// The threads of a step: the caller's task system, or the built-in one. What the stages compute never depends
// on how many there are.
#pragma once

#include "base/scheduler.hpp"

#include <vox/vox.h>

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <type_traits>

namespace vox {

class Workers {
public:
    // Who keeps the threads of the built-in scheduler: this object, or the process, from one call to the
    // next.
    enum class Threads { of_object, of_process };

    // `worker_count` as in vox_grid_desc, checked (check_workers).
    Workers(const vox_task_system& tasks, std::uint32_t worker_count, Threads threads = Threads::of_object);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void set_count(std::uint32_t worker_count);
    std::uint32_t count() const noexcept { return count_; }

    // Calls function(begin, end, worker) for ranges that make up [0, items), each of at least min_range items
    // if possible, and returns after the last call. Rethrows the first exception of a call. Throws
    // INVALID_ARGUMENT if the caller's task system violates vox_task_system. Counts as one task of the step.
    template <class Function>
    void for_ranges(std::size_t items, std::size_t min_range, Function&& function) {
        if (items == 0) return;
        if (count_ == 1 || items <= min_range) {
            function(std::size_t{0}, items, std::uint32_t{0});
            return;
        }
        using Plain = std::remove_reference_t<Function>;
        Job job([](void* callable, std::size_t begin, std::size_t end,
                   std::uint32_t worker) { (*static_cast<Plain*>(callable))(begin, end, worker); },
                const_cast<std::remove_const_t<Plain>*>(&function), count_, items);
        run(job, items, min_range);
    }

private:
    using Call = void(void* callable, std::size_t begin, std::size_t end, std::uint32_t worker);

    struct Job {
        Job(Call* call, void* callable, std::uint32_t worker_count, std::size_t items) noexcept;

        Call* const call;
        void* const callable;
        const std::uint32_t worker_count;
        const std::size_t items;
        std::mutex mutex{}; // guards the members below
        std::exception_ptr failure{};
        std::bitset<VOX_MAX_WORKERS> busy{}; // workers that run a range
        std::size_t done = 0;
        // Becomes 0 when the ranges run make up [0, items) without a gap or an overlap.
        std::uint64_t uncovered;
    };

    static void run_range(std::uint64_t begin, std::uint64_t end, std::uint32_t worker, void* job) noexcept;
    void run(Job& job, std::size_t items, std::size_t min_range);

    vox_task_system tasks_;
    Threads threads_;
    std::uint32_t count_ = 1;
    std::unique_ptr<Scheduler> scheduler_;
};

// Workers::for_ranges(); without workers all at once.
template <class Function>
void for_ranges(Workers* workers, std::size_t items, std::size_t min_range, Function&& function) {
    if (workers)
        workers->for_ranges(items, min_range, function);
    else
        function(std::size_t{0}, items, std::uint32_t{0});
}

// Throws INVALID_ARGUMENT when the two fields do not fit each other.
void check_workers(const vox_task_system& tasks, std::uint32_t worker_count);

} // namespace vox
