#include "depth/penetrations.hpp"

#include "base/room.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace vox {

void Penetrations::clear() noexcept {
    all_.clear();
    depths_.clear();
    closest_.clear();
    carried_ = 0;
}

void Penetrations::reserve(std::uint64_t count) {
    reserve_exactly(all_, count);
    reserve_exactly(depths_, count);
    reserve_exactly(closest_, count);
}

void Penetrations::carry(std::span<const Body> bodies, std::span<const Hit> hits, std::size_t count) {
    reserve(count);
    carried_ = 0;
    if (std::ranges::any_of(bodies, &Body::carried)) keep_carried(bodies, hits);
    all_.resize(count);
    depths_.resize(count);
    closest_.resize(count);
    if (carried_ > 0) spread_carried(bodies, hits);
}

// Both lists are sorted, and every vertex that is carried is in the old one.
void Penetrations::keep_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept {
    const auto key = [](const vox_penetration& p) { return std::tuple(p.mesh_a, p.vertex, p.mesh_b); };
    std::size_t old = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!is_first_of_vertex(hits, i)) continue;
        const Body &a = bodies[hits[i].body_a], &b = bodies[hits[i].body_b];
        if (penetration_source(a, b) != PenetrationSource::carried) continue;
        while (key(all_[old]) != std::tuple(a.mesh_id, hits[i].vertex, b.mesh_id)) ++old;
        all_[carried_] = all_[old];
        depths_[carried_] = depths_[old];
        closest_[carried_] = closest_[old];
        ++carried_;
    }
}

// From the last to the first, as none moves to a place before its own.
void Penetrations::spread_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept {
    std::size_t place = all_.size(), left = carried_;
    for (std::size_t i = hits.size(); left > 0; --i) {
        if (!is_first_of_vertex(hits, i - 1)) continue;
        const Hit& hit = hits[i - 1];
        const PenetrationSource source = penetration_source(bodies[hit.body_a], bodies[hit.body_b]);
        if (source == PenetrationSource::none) continue;
        --place;
        if (source != PenetrationSource::carried) continue;
        --left;
        all_[place] = all_[left];
        all_[place].contact = i - 1;
        depths_[place] = depths_[left];
        closest_[place] = closest_[left];
    }
}

void Penetrations::set(std::size_t place, const vox_penetration& penetration, double depth,
                       const Vec3d& direction, std::uint32_t closest) noexcept {
    all_[place] = penetration;
    all_[place].depth = static_cast<float>(std::min<double>(depth, std::numeric_limits<float>::max()));
    all_[place].direction[0] = static_cast<float>(direction.x);
    all_[place].direction[1] = static_cast<float>(direction.y);
    all_[place].direction[2] = static_cast<float>(direction.z);
    depths_[place] = {depth, {direction.x, direction.y, direction.z}};
    closest_[place] = closest;
}

} // namespace vox
