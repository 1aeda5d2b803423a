// The closest point of each face that a vertex may be near to, compared as queries compare them.
#include "grid/proximities.hpp"

#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "grid/constraints.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace vox {

namespace {

// The unit vector from the closest point, `seen` from p, to p. Where they are so close that rounding errors
// would turn it, and the point is no corner and on no edge, it is across the face, to the side that p is on.
Vec3d normal_to(const Vec3d& p, const Vec3d (&corner)[3], const SeenPoint& seen, const Vec3d& apex) {
    const auto largest = [](const Vec3d& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    const Vec3d away{-seen.way.x, -seen.way.y, -seen.way.z};
    const double reach = std::max({largest(corner[0] - p), largest(corner[1] - p), largest(corner[2] - p)});
    const double* weight = seen.at.weight;
    if (largest(away) < 0x1p-20 * reach && weight[0] > 0 && weight[1] > 0 && weight[2] > 0) {
        std::uint64_t exact_tests = 0;
        const int side = orientation(corner[0], corner[1], corner[2], p, exact_tests);
        Vec3d normal = triangle_normal(corner[0], corner[1], corner[2]);
        if (side < 0) normal = -1.0 * normal;
        if (side != 0 && length(normal) > 0) return normal;
    }
    const Vec3d normal = normalised(scaled(away));
    if (length(normal) > 0) return normal;
    return facet_normal(corner[0], corner[1], corner[2], apex, p, seen.way);
}

} // namespace

void Proximities::find(const StepScene& scene, KeptFeatures& kept) {
    begin_step(scene, margin_ * margin_); // distances are squared
    carried_ = carry();
    find_near(scene, margin_, kept);
    end_step("proximities");
    list_pairs(all(), VOX_PAIR_NEAR, pairs_);
}

void Proximities::count(Counters& counters) const noexcept {
    counters.proximities = all().size();
    counters.carried_proximities = carried_;
    count_candidates(counters);
}

void Proximities::add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept {
    sources.proximities = all();
}

// Vertices that are gone, and those that have a contact.
void Proximities::leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const {
    const vox_body body_a = scene().bodies[a].mesh_id, body_b = scene().bodies[b].mesh_id;
    const auto removed = scene().bodies[a].removed_vertices;
    const auto end = scene().contacts.end();
    auto inside = scene().contacts.begin();
    erase_if(vertices, [&](std::uint32_t vertex) {
        const std::tuple sought(body_a, vertex, body_b);
        const auto is_before = [&](const vox_contact& contact) { return place_of(contact) < sought; };
        const auto is_behind = [&] { return inside != end && is_before(*inside); };
        for (int steps = 0; steps < 8 && is_behind(); ++steps) ++inside; // the next is mostly near
        if (is_behind()) inside = std::partition_point(inside, end, is_before);
        return has_bit(removed, vertex) || (inside != end && place_of(*inside) == sought);
    });
}

void Proximities::load(Worker& worker) const {
    const SurfaceFeatures& surface = *worker.pair.surface;
    auto& [points, boxes] = worker.read;
    load_positions(scene().bodies[worker.pair.b].positions, surface, *worker.tile, points.data());
    for (std::uint32_t f = 0; f < worker.tile->face_count; ++f) {
        const auto& [u, v, w] = surface.faces[worker.tile->first_face + f];
        boxes[f] = {min(min(points[u], points[v]), points[w]), max(max(points[u], points[v]), points[w])};
    }
}

// The distance is never less than that to the box of the face, so that a face may be left out for its box:
// which faces of how many tiles are looked at, in which order, plays no part then. The faces whose boxes are
// nearest come first, as they leave out most of the others.
void Proximities::look(Worker& worker, const NearFaces& near) const {
    const auto& [points, boxes] = worker.read;
    const Vec3d p = position(worker.pair.a, worker.pair.vertices[near.place]);
    const double& most = worker.of_vertex[near.place].most; // lower with every face that is offered
    struct Candidate {
        double least; // distance, squared
        std::uint32_t face;
    };
    std::array<Candidate, SurfaceTile::most_faces> candidates;
    std::size_t count = 0;
    for (std::uint32_t left = near.faces; left; left &= left - 1) {
        const auto face = static_cast<std::uint32_t>(std::countr_zero(left));
        candidates[count] = {squared_distance_bound(p, boxes[face]), face};
        count += candidates[count].least <= most;
    }
    while (count > 0) {
        std::size_t next = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (candidates[i].least < candidates[next].least) next = i;
        const auto [least, face] = candidates[next];
        if (least > most) return;
        ++worker.candidates;
        candidates[next] = candidates[--count];
        const auto& [u, v, w] = worker.pair.surface->faces[worker.tile->first_face + face];
        const SeenPoint seen = closest_seen_from(p, points[u], points[v], points[w]);
        offer(worker, near.place, face, std::max(seen.at.squared_distance, least));
    }
}

Proximity Proximities::element_of(const Worker& worker, const Least& least) const {
    const VertexFace at = vertex_face(worker, least);
    const std::uint32_t b = worker.pair.b;
    const Vec3d corner[3] = {position(b, at.face[0]), position(b, at.face[1]), position(b, at.face[2])};
    const Vec3d apex = position(b, scene().bodies[b].tets[at.tet].v[at.facet]);
    const Vec3d p = position(worker.pair.a, at.vertex);
    const SeenPoint seen = closest_seen_from(p, corner[0], corner[1], corner[2]);
    const Vec3d normal = normal_to(p, corner, seen, apex);
    const std::array<double, 3> weights = normalised(seen.at.weight);
    return {
        at, {weights[0], weights[1], weights[2]}, std::sqrt(least.number), {normal.x, normal.y, normal.z}};
}

} // namespace vox
