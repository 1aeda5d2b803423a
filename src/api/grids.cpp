// The C border of calls for many grids.

#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/parallel.hpp"
#include "grid/grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <mutex>
#include <vector>

using namespace vox;

namespace {

void check_grids(const vox_grid* const* grids, std::uint64_t count) {
    if (count > 0) require(grids, "grids");
    for (std::uint64_t i = 0; i < count; ++i)
        if (!grids[i]) refuse(format("grids[%llu] is null", llu(i)));
}

// Two threads must not step the same grid.
void check_different(vox_grid* const* grids, std::uint64_t count) {
    std::vector<std::uint64_t> order(count);
    for (std::uint64_t i = 0; i < count; ++i) order[i] = i;
    std::ranges::sort(order, [&](std::uint64_t a, std::uint64_t b) {
        return grids[a] != grids[b] ? std::less<>()(grids[a], grids[b]) : a < b;
    });
    for (std::uint64_t i = 1; i < count; ++i)
        if (grids[order[i - 1]] == grids[order[i]])
            refuse(format("grids[%llu] and grids[%llu] are the same", llu(order[i - 1]), llu(order[i])));
}

// The failure of the grid with the lowest index. Its text is copied, as vox_last_error() is one a thread.
class FirstFailure {
public:
    void add(std::uint64_t grid, vox_result result, const char* text) {
        const std::lock_guard lock(mutex_);
        if (result_ != VOX_OK && grid_ < grid) return;
        grid_ = grid;
        result_ = result;
        (void)std::snprintf(text_, sizeof text_, "%s", text);
    }
    void rethrow() const {
        if (result_ != VOX_OK) throw Error(result_, format("grid %llu: %s", llu(grid_), text_));
    }

private:
    std::mutex mutex_;
    std::uint64_t grid_ = 0;
    vox_result result_ = VOX_OK;
    char text_[1024]; // the longest error text
};

} // namespace

vox_result vox_grids_step(vox_grid* const* grids, uint64_t count, uint32_t worker_count,
                          const vox_task_system* tasks, vox_result* results) {
    return border([&] {
        check_grids(grids, count);
        check_different(grids, count);
        const vox_task_system system = tasks ? *tasks : vox_task_system{};
        check_workers(system, worker_count);
        FirstFailure failure;
        Workers(system, worker_count, Workers::Threads::of_process)
            .for_ranges(count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
                for (std::size_t i = begin; i < end; ++i) {
                    const vox_result result = vox_grid_step(grids[i]);
                    if (results) results[i] = result;
                    if (result != VOX_OK) failure.add(i, result, vox_last_error());
                }
            });
        failure.rethrow();
    });
}
