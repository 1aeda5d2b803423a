#include "grid/impacts.hpp"

#include "base/bits.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "grid/constraints.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace vox {

void Impacts::find(const StepScene& scene, KeptFeatures& kept) {
    begin_step(scene, 1);
    find_meeting(scene, scene.previous, kept);
    end_step("impacts");
    list_impacts();
}

void Impacts::list_impacts() {
    impacts_.clear();
    reserve_sparingly(impacts_, all().size());
    const std::span<const vox_contact> contacts = scene().contacts;
    auto inside = contacts.begin();
    for (const SurfaceMeeting& met : all()) {
        inside =
            std::lower_bound(inside, contacts.end(), place_of(met),
                             [&](const vox_contact& c, const auto& sought) { return place_of(c) < sought; });
        if (inside != contacts.end() && place_of(*inside) == place_of(met)) continue;
        const std::uint32_t a = body_index(scene().bodies, met.body_a),
                            b = body_index(scene().bodies, met.body_b);
        const Vec3d p = position(a, met.vertex);
        const Vec3d corner[3] = {position(b, met.face[0]), position(b, met.face[1]),
                                 position(b, met.face[2])};
        const Vec3d apex = position(b, scene().bodies[b].tets[met.tet].v[met.facet]);
        std::uint64_t exact_tests = 0;
        const int side = orientation(corner[0], corner[1], corner[2], p, exact_tests),
                  inner = orientation(corner[0], corner[1], corner[2], apex, exact_tests);
        if (side == 0 || side == -inner) continue;
        const auto at = [&](const Vec3d& from, const Vec3d& to) { return from + met.time * (to - from); };
        Vec3d face[3];
        for (int i = 0; i < 3; ++i) face[i] = at(before(b, met.face[i]), corner[i]);
        const SeenPoint seen = closest_seen_from(at(before(a, met.vertex), p), face[0], face[1], face[2]);
        const std::array<double, 3> weights = normalised(seen.at.weight);
        const Vec3d normal = facet_normal(corner[0], corner[1], corner[2], apex, p, seen.way);
        impacts_.push_back({met,
                            {weights[0], weights[1], weights[2]},
                            {normal.x, normal.y, normal.z},
                            std::min(dot(normal, p - corner[0]), 0.0)});
    }
    list_pairs(std::span<const Impact>(impacts_), VOX_PAIR_BEGAN, pairs_);
}

void Impacts::add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept {
    sources.meetings = all();
    sources.impacts = impacts_;
}

Vec3d Impacts::before(std::uint32_t body, std::uint32_t vertex) const noexcept {
    const Positions& previous = scene().previous[body];
    return previous.data ? previous.exact(vertex) : position(body, vertex);
}

void Impacts::leave_out(std::uint32_t a, std::uint32_t, Array<std::uint32_t>& vertices) const {
    const auto removed = scene().bodies[a].removed_vertices;
    erase_if(vertices, [&](std::uint32_t vertex) { return has_bit(removed, vertex); });
}

void Impacts::load(Worker& worker) const {
    const SurfaceFeatures& surface = *worker.pair.surface;
    const Positions &now = scene().bodies[worker.pair.b].positions,
                    &previous = scene().previous[worker.pair.b];
    load_positions(previous.data ? previous : now, surface, *worker.tile, worker.read.from.data());
    load_positions(now, surface, *worker.tile, worker.read.to.data());
    worker.read.has_lanes = false;
}

void Impacts::make_lanes(Worker& worker) const {
    MovingTile& read = worker.read;
    const SurfaceTile& tile = *worker.tile;
    const SurfaceMotion motion{{read.from.data(), tile.vertex_count}, {read.to.data(), tile.vertex_count}};
    std::array<std::uint32_t, SurfaceTile::most_vertices> all;
    std::iota(all.begin(), all.end(), 0u);
    read.frame = frame_along(motion, {all.data(), tile.vertex_count});
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [u, v, w] = worker.pair.surface->faces[tile.first_face + f];
        const std::uint32_t corners[3] = {u, v, w};
        set_lane(read.frame, motion, corners, f, read.lanes);
    }
    read.has_lanes = true;
}

// Leaves faces that an axis does not prove to stay apart from a vertex. Those of all vertices fill the lanes.
void Impacts::sieve(Worker& worker, std::span<NearFaces> near) const {
    constexpr int few = 4; // faces a vertex, whose times are computed sooner
    std::array<std::uint32_t, NearFaces::at_once * SurfaceTile::most_faces> lanes, partner;
    std::array<CullPartner, NearFaces::at_once> partners;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < near.size(); ++i) {
        if (std::popcount(near[i].faces) < few) continue;
        if (!worker.read.has_lanes) make_lanes(worker);
        const std::uint32_t vertex = worker.pair.vertices[near[i].place];
        const Vec3d from = before(worker.pair.a, vertex), to = position(worker.pair.a, vertex);
        constexpr std::uint32_t only = 0;
        partners[i] = partner_in(worker.read.frame, {{&from, 1}, {&to, 1}}, {&only, 1});
        std::uint32_t left = cull_across(worker.read.lanes, partners[i], near[i].faces);
        for (; left; left &= left - 1, ++count) {
            lanes[count] = static_cast<std::uint32_t>(std::countr_zero(left));
            partner[count] = i;
        }
        near[i].faces = 0;
    }
    count = cull_some({worker.read.lanes, partners.data(), 3, 1, 0, lanes.data(), partner.data(), count});
    for (std::size_t i = 0; i < count; ++i) near[partner[i]].faces |= 1u << lanes[i];
}

void Impacts::look(Worker& worker, const NearFaces& near) const {
    if (near.faces == 0) return;
    const std::uint32_t vertex = worker.pair.vertices[near.place];
    const Vec3d from = before(worker.pair.a, vertex), to = position(worker.pair.a, vertex);
    worker.candidates += static_cast<std::uint64_t>(std::popcount(near.faces));
    std::uint64_t tests = 0;
    for (std::uint32_t left = near.faces; left; left &= left - 1) {
        const auto face = static_cast<std::uint32_t>(std::countr_zero(left));
        const std::array<std::uint8_t, 3>& corners =
            worker.pair.surface->faces[worker.tile->first_face + face];
        SeenMotion motion;
        for (std::size_t i = 0; i < 3; ++i) {
            motion.from[i] = worker.read.from[corners[i]] - from;
            motion.to[i] = worker.read.to[corners[i]] - to;
        }
        offer(worker, near.place, face, meeting_time(motion, worker.of_vertex[near.place].most, tests));
    }
}

SurfaceMeeting Impacts::element_of(const Worker& worker, const Least& least) const {
    return {vertex_face(worker, least), least.number};
}

} // namespace vox
