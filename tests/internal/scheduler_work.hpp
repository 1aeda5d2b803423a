// A task that notes what a scheduler does with it.
#pragma once

#include "base/scheduler.hpp"
#include "support/suite.h"

#include <atomic>
#include <cstring>
#include <vector>

namespace vox {

// Counts how often each item is run, and by how many workers, each of which may be at one place at a time
// only.
struct Work {
    explicit Work(std::uint64_t items, std::uint32_t workers) : runs(items), busy(workers) {}

    std::vector<std::atomic<int>> runs;
    std::vector<std::atomic<bool>> busy;
    std::atomic<int> wrong{0}, ranges{0}, short_ranges{0};
    std::uint64_t least = 1;

    static void task(std::uint64_t begin, std::uint64_t end, std::uint32_t worker, void* context) {
        Work& work = *static_cast<Work*>(context);
        if (worker >= work.busy.size() || begin >= end || end > work.runs.size() ||
            work.busy[worker].exchange(true)) {
            ++work.wrong;
            return;
        }
        for (std::uint64_t i = begin; i < end; ++i) ++work.runs[i];
        ++work.ranges;
        work.short_ranges += end - begin < work.least;
        work.busy[worker] = false;
    }

    bool each_once() const {
        for (const auto& count : runs)
            if (count != 1) return false;
        return wrong == 0;
    }
};

inline void run_once(Scheduler& scheduler, std::uint32_t workers, std::uint64_t items,
                     std::uint64_t min_range) {
    Work work(items, workers);
    work.least = min_range;
    scheduler.run(&Work::task, items, min_range, &work);
    ck_assert_msg(work.each_once(), "%u workers, %d items, ranges of %d", workers, int(items),
                  int(min_range));
    if (std::strcmp(VOX_SCHEDULER, "oneTBB") != 0 &&
        items >= min_range) // its ranges have half of that and more
        ck_assert_int_eq(work.short_ranges, 0);
}

} // namespace vox
