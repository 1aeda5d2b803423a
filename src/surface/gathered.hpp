// What workers find of a range of features, in the order of these.
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <tuple>

namespace vox {

template <class T>
class Gathered {
public:
    explicit Gathered(std::pmr::memory_resource* memory) noexcept : workers_(memory), ranges_(memory) {}

    // Calls find(item, found) for each of `items`, which appends what it finds to `found`; then appends all
    // of that to `out`, item after item. Only a part of what is found is held twice at a time.
    template <class Find>
    void run(std::size_t items, Workers& workers, Find&& find, Array<T>& out) {
        workers_.grow(workers.count());
        constexpr std::size_t most_items = 1 << 14;
        for (std::size_t first = 0; first < items; first += most_items)
            run_part(first, std::min(most_items, items - first), workers, find, out);
        workers_.level();
    }

private:
    template <class Find>
    void run_part(std::size_t first_item, std::size_t items, Workers& workers, Find& find, Array<T>& out) {
        for (Worker& worker : workers_) {
            worker.found.clear();
            worker.ranges.clear();
        }
        constexpr std::size_t least_items = 64;
        workers.for_ranges(items, least_items, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            Worker& worker = workers_[w];
            const std::size_t first = worker.found.size();
            for (std::size_t i = begin; i < end; ++i)
                find(static_cast<std::uint32_t>(first_item + i), worker.found);
            worker.ranges.push_back({begin, first, worker.found.size(), w});
        });
        ranges_.clear();
        std::size_t count = out.size();
        for (const Worker& worker : workers_) {
            ranges_.insert(ranges_.end(), worker.ranges.begin(), worker.ranges.end());
            count += worker.found.size();
        }
        std::sort(ranges_.begin(), ranges_.end(),
                  [](const Range& x, const Range& y) { return x.item < y.item; });
        reserve_sparingly(out, count);
        for (const Range& range : ranges_) {
            const T* const found = workers_[range.worker].found.data();
            out.insert(out.end(), found + range.begin, found + range.end);
        }
    }

    struct Range {
        std::size_t item, begin, end; // the first item; places in what the worker found
        std::uint32_t worker;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : found(memory), ranges(memory) {}
        auto buffers() { return std::tie(found, ranges); }

        Array<T> found;
        Array<Range> ranges;
    };
    PerWorker<Worker> workers_;
    Array<Range> ranges_;
};

} // namespace vox
