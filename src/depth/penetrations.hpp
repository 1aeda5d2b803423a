// The penetrations of a step, and which of them are those of the step before: those between bodies at rest.
// Each depends on the positions and the topology of its two bodies and on their contacts, on nothing else.
#pragma once

#include "base/scene.hpp"
#include "mesh/filter.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Where the penetrations of a pair of bodies come from.
enum class PenetrationSource { none, carried, found };

inline PenetrationSource penetration_source(const Body& a, const Body& b) noexcept {
    if (!have_penetrations(a, b)) return PenetrationSource::none;
    return a.carried && b.carried ? PenetrationSource::carried : PenetrationSource::found;
}

// Whether hits[i], in the order of make_contacts, is the first of its vertex in its body_b.
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

    // Keeps those of the last step that are carried over, and moves them to their places among the
    // penetrations of `hits`, of which there are `count`. The rest is to be set.
    void carry(std::span<const Body> bodies, std::span<const Hit> hits, std::size_t count);
    void set(std::size_t place, const vox_penetration& penetration, double depth, const Vec3d& direction,
             std::uint32_t closest) noexcept;

    std::span<const vox_penetration> all() const noexcept { return all_; }
    std::span<const vox_depth> depths() const noexcept { return depths_; } // of each
    // For each the triangle of mesh_b's surface that is closest, where that was searched (depth/points.hpp).
    std::span<const std::uint32_t> closest() const noexcept { return closest_; }

    // How many carry() kept.
    std::size_t carried() const noexcept { return carried_; }

private:
    void keep_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept;
    void spread_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept;

    std::pmr::vector<vox_penetration> all_;
    std::pmr::vector<vox_depth> depths_;
    std::pmr::vector<std::uint32_t> closest_;
    std::size_t carried_ = 0;
};

} // namespace vox
