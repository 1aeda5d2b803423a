// The penetrations of a step, and which of them are those of the step before: those between bodies at rest.
// Each depends on the positions and the topology of its two bodies and on their contacts, on nothing else.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "mesh/filter.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

// In half a cache line, since those of neighbours are looked at.
struct alignas(32) Depth {
    double depth;
    double direction[3];

    Vec3d way_out() const noexcept { return {direction[0], direction[1], direction[2]}; }
    // True if depth and direction of an ENCLOSED or CROSSING vertex are known.
    bool has_answer() const noexcept { return depth > 0; }
    void set(double new_depth, const Vec3d& new_direction) noexcept {
        depth = new_depth;
        direction[0] = new_direction.x;
        direction[1] = new_direction.y;
        direction[2] = new_direction.z;
    }
};
static_assert(sizeof(Depth) == 32);

// Vertex `vertex` of body_a is inside body_b and leaves it by moving its depth along the direction of that.
struct Penetration {
    vox_body body_a;
    std::uint32_t vertex;
    vox_body body_b;
    vox_depth_state state;
    std::uint64_t contact; // index of the first of (body_a, vertex, body_b)
};

constexpr std::uint32_t no_triangle = 0xffffffffu;

// Where the penetrations of a pair of bodies come from.
enum class PenetrationSource { none, carried, found };

inline PenetrationSource penetration_source(const Body& a, const Body& b) noexcept {
    if (!have_penetrations(a, b)) return PenetrationSource::none;
    return a.carried && b.carried ? PenetrationSource::carried : PenetrationSource::found;
}

// True if hits[i], in the order of make_contacts, is the first of its vertex in its body_b.
inline bool is_first_of_vertex(std::span<const Hit> hits, std::size_t i) noexcept {
    return i == 0 || hits[i].vertex != hits[i - 1].vertex || hits[i].body_b != hits[i - 1].body_b ||
           hits[i].body_a != hits[i - 1].body_a;
}

class Penetrations {
public:
    explicit Penetrations(std::pmr::memory_resource* memory)
        : all_(memory), depths_(memory), closest_(memory) {}

    void clear() noexcept;
    // Never gives room back. Throws what the memory throws.
    void reserve(std::uint64_t count);

    // Makes those of `hits`. Those of the last step that are carried over are kept; the others are ENCLOSED,
    // with nothing known. Throws what the memory throws.
    void begin(std::span<const Body> bodies, std::span<const Hit> hits);

    // The stage writes here: state, depth and direction in double, and the closest triangle.
    Penetration& of(std::uint32_t place) noexcept { return all_[place]; }
    Depth& depth_of(std::uint32_t place) noexcept { return depths_[place]; }
    std::uint32_t& closest_of(std::uint32_t place) noexcept { return closest_[place]; }

    std::span<const Penetration> all() const noexcept { return all_; }
    std::span<const Depth> depths() const noexcept { return depths_; } // of each
    // For each the triangle of body_b's surface that is closest, where that was searched, or no_triangle.
    std::span<const std::uint32_t> closest() const noexcept { return closest_; }

    // How many begin() kept.
    std::size_t carried() const noexcept { return carried_; }

private:
    std::size_t keep_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept;
    void spread_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept;

    Array<Penetration> all_;
    Array<Depth> depths_;
    Array<std::uint32_t> closest_;
    std::size_t carried_ = 0;
};

} // namespace vox
