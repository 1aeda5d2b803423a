// Questions about pairs of features that may meet: crossings, distances, clearances, times of contact.
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "base/room.hpp"
#include "surface/contact_time.hpp"
#include "surface/motion.hpp"
#include "surface/pairs.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

// The partners of a range of features of kind a, which are of kind b.
struct Candidates {
    const SurfaceTopology& topology;
    const SurfaceMotion& motion;
    vox_feature a, b;
    const FeaturePairs& pairs;

    // The same, asked about another motion than they were searched by.
    Candidates in(const SurfaceMotion& other) const noexcept { return {topology, other, a, b, pairs}; }
    std::size_t count() const noexcept { return static_cast<std::size_t>(pairs.count); }
    // Calls visit(feature, partner) for all partners of feature i of the range, in their order.
    template <class Visit>
    void for_partners(std::size_t i, const Visit& visit) const {
        for (std::uint64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k)
            visit(static_cast<std::uint32_t>(pairs.first + i), pairs.partners[k]);
    }
};

// A number that many threads may lower at once, and that a vector can hold.
struct SharedLeast {
    SharedLeast() noexcept = default;
    SharedLeast(const SharedLeast& other) noexcept : number(other.number.load(std::memory_order_relaxed)) {}
    std::atomic<double> number = 0;
};

// Collects what workers find of a range of features, in their order.
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

// Answers to one question, in the order of features and partners. `lives` while the caller may have a view of
// them.
template <class T>
struct Answers {
    explicit Answers(std::pmr::memory_resource* memory) noexcept : all(memory), gathered(memory) {}

    bool lives = false;
    Array<T> all;
    Gathered<T> gathered;
};

// Each appends what it finds; all throw what the memory throws. Edges through faces, exactly
// (exact/crossing.hpp):
void add_crossings(const Candidates& candidates, Workers& workers, Answers<vox_crossing>& out);
// Pairs within a distance at the end of the motion.
void add_proximities(const Candidates& candidates, double distance, Workers& workers,
                     Answers<vox_proximity>& out);
// Pairs that may come into contact within the motion.
void add_impacts(const Candidates& candidates, const ContactTimeRule& rule, Workers& workers,
                 Answers<vox_impact>& out);

// By how much larger than half the distance the boxes have to be for add_proximities() to miss nothing.
double proximity_radius(std::span<const Vec3d> positions, double distance) noexcept;

// Lowers `found` to the first contact among these pairs, if that is before found.step, or at the same time
// and before it in the order of kinds, a, b. What it finds depends neither on workers nor on their order.
void lower_safe_step(const Candidates& candidates, const ContactTimeRule& rule, Workers& workers,
                     vox_safe_step& found);
// Lowers that of each vertex, at most `most`, to how far all may move before these pairs can meet.
void lower_clearances(const Candidates& candidates, double most, Workers& workers,
                      Array<SharedLeast>& clearances);

} // namespace vox
