// What is asked about pairs of features that may meet: crossings, distances, clearances, times of contact.
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "surface/contact_time.hpp"
#include "surface/gathered.hpp"
#include "surface/motion.hpp"
#include "surface/pairs.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

// The partners of a range of features of kind a, which are of kind b.
struct Candidates {
    const SurfaceTopology& topology;
    const SurfaceMotion& motion;
    vox_feature a, b;
    const FeaturePairs& pairs;

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
