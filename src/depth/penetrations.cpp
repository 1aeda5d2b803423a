#include "depth/penetrations.hpp"

#include "base/room.hpp"

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

void Penetrations::begin(std::span<const Body> bodies, std::span<const Hit> hits) {
    reserve(hits.size()); // never more
    const std::size_t count = keep_carried(bodies, hits);
    all_.resize(count);
    depths_.resize(count);
    closest_.resize(count);
    spread_carried(bodies, hits);
}

// Moves those that are carried to the front, and returns how many there are with the others. Both lists are
// sorted, and every vertex that is carried is in the old one.
std::size_t Penetrations::keep_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept {
    const auto key = [](const Penetration& p) { return std::tuple(p.body_a, p.vertex, p.body_b); };
    std::size_t old = 0, count = 0;
    carried_ = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!is_first_of_vertex(hits, i)) continue;
        const Body &a = bodies[hits[i].body_a], &b = bodies[hits[i].body_b];
        const PenetrationSource source = penetration_source(a, b);
        count += source != PenetrationSource::none;
        if (source != PenetrationSource::carried) continue;
        while (key(all_[old]) != std::tuple(a.mesh_id, hits[i].vertex, b.mesh_id)) ++old;
        all_[carried_] = all_[old];
        depths_[carried_] = depths_[old];
        closest_[carried_] = closest_[old];
        ++carried_;
    }
    return count;
}

// Moves them to their places, and makes the others, last to first, as none moves to a lower place.
void Penetrations::spread_carried(std::span<const Body> bodies, std::span<const Hit> hits) noexcept {
    std::size_t place = all_.size(), left = carried_;
    for (std::size_t i = hits.size(); place > 0; --i) {
        if (!is_first_of_vertex(hits, i - 1)) continue;
        const Hit& hit = hits[i - 1];
        const Body &a = bodies[hit.body_a], &b = bodies[hit.body_b];
        const PenetrationSource source = penetration_source(a, b);
        if (source == PenetrationSource::none) continue;
        --place;
        if (source == PenetrationSource::found) {
            all_[place] = {a.mesh_id, hit.vertex, b.mesh_id, VOX_DEPTH_CLOSEST, i - 1};
            depths_[place].set(0, {0, 0, 0});
            closest_[place] = no_triangle;
            continue;
        }
        --left;
        all_[place] = all_[left];
        all_[place].contact = i - 1;
        depths_[place] = depths_[left];
        closest_[place] = closest_[left];
    }
}

} // namespace vox
