// The closest point of each face that a vertex may be near to, compared as queries compare them.
#include "grid/margin_contacts.hpp"

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace vox {

namespace {

// Of a contact or a margin contact in the canonical order.
template <class Contact>
auto place(const Contact& contact) {
    return std::tuple(contact.body_a, contact.vertex, contact.body_b);
}

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
        Vec3d normal = normalised(cross(scaled(corner[1] - corner[0]), scaled(corner[2] - corner[0])));
        if (side < 0) normal = -1.0 * normal;
        if (side != 0 && length(normal) > 0) return normal;
    }
    const Vec3d normal = normalised(scaled(away));
    if (length(normal) > 0) return normal;
    return facet_normal(corner[0], corner[1], corner[2], apex, p, seen.way);
}

} // namespace

void MarginContacts::find(const StepScene& scene, double margin, std::span<const vox_contact> contacts,
                          VertexFaceSearch& search, Counters& counters) {
    scene_ = &scene;
    inside_ = contacts;
    most_ = margin * margin;
    workers_.grow(scene.workers->count());
    for (Worker& worker : workers_) {
        worker.found.clear();
        worker.tile = nullptr;
    }
    found_.clear();
    scene.carry(std::span<const MarginContact>(contacts_), [&](const MarginContact& contact) {
        reserve_sparingly(found_, found_.size() + 1);
        found_.push_back({contact, 0}); // there is no other for this vertex and mesh
    });
    counters.carried_proximities = found_.size();
    search.find_near(scene, margin, *this);
    std::size_t count = found_.size();
    for (const Worker& worker : workers_) count += worker.found.size();
    reserve_sparingly(found_, count);
    for (const Worker& worker : workers_)
        found_.insert(found_.end(), worker.found.begin(), worker.found.end());
    for (Worker& worker : workers_) { // in a later step, one may find all
        reserve_sparingly(worker.found, count);
        reserve_sparingly(worker.closest, count);
    }
    workers_.level();
    put_in_order();
    counters.proximities = contacts_.size();
}

// Vertices that are gone, and those that have a contact.
void MarginContacts::leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const {
    const vox_body body_a = scene_->bodies[a].mesh_id, body_b = scene_->bodies[b].mesh_id;
    const auto removed = scene_->bodies[a].removed_vertices;
    auto inside = inside_.begin();
    erase_if(vertices, [&](std::uint32_t vertex) {
        const std::tuple sought(body_a, vertex, body_b);
        const auto is_before = [&](const vox_contact& contact) { return place(contact) < sought; };
        const auto is_behind = [&] { return inside != inside_.end() && is_before(*inside); };
        for (int steps = 0; steps < 8 && is_behind(); ++steps) ++inside; // the next is mostly near
        if (is_behind()) inside = std::partition_point(inside, inside_.end(), is_before);
        return has_bit(removed, vertex) || (inside != inside_.end() && place(*inside) == sought);
    });
}

void MarginContacts::begin(const VertexFacePair& pair, std::uint32_t w) {
    Worker& worker = workers_[w];
    worker.pair = pair;
    worker.tile = nullptr;
    worker.closest.clear();
    reserve_growing(worker.reached, pair.vertices.size());
    worker.reached.assign(pair.vertices.size(), {most_, none_yet});
}

void MarginContacts::load(Worker& worker, const SurfaceTile& tile) const {
    const SurfaceFeatures& features = worker.pair.surface->features;
    const Positions& positions = scene_->bodies[worker.pair.b].positions;
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
        worker.points[v] = positions.exact(features.vertices[tile.first_vertex + v]);
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [u, v, x] = features.faces[tile.first_face + f];
        const Vec3d &p = worker.points[u], &q = worker.points[v], &r = worker.points[x];
        worker.boxes[f] = {min(min(p, q), r), max(max(p, q), r)};
    }
    worker.tile = &tile;
}

void MarginContacts::visit(const SurfaceTile& tile, std::span<const NearFaces> near, std::uint32_t w) {
    Worker& worker = workers_[w];
    if (worker.tile != &tile) load(worker, tile);
    for (const NearFaces& one : near) visit(worker, tile, one);
}

// The distance is never less than that to the box of the face, so that a face may be left out for its box:
// which faces of how many tiles are looked at, in which order, plays no part then. The faces whose boxes are
// nearest come first, as they leave out most of the others.
void MarginContacts::visit(Worker& worker, const SurfaceTile& tile, const NearFaces& near) const {
    const SearchedSurface& surface = *worker.pair.surface;
    const Vec3d p = scene_->bodies[worker.pair.a].positions.exact(worker.pair.vertices[near.place]);
    Reached& reached = worker.reached[near.place];
    struct Candidate {
        double least; // distance, squared
        std::uint32_t face;
    };
    std::array<Candidate, SurfaceTile::most_faces> candidates;
    std::size_t count = 0;
    for (std::uint32_t left = near.faces; left; left &= left - 1) {
        const auto face = static_cast<std::uint32_t>(std::countr_zero(left));
        candidates[count] = {squared_distance_bound(p, worker.boxes[face]), face};
        count += candidates[count].least <= reached.squared;
    }
    const auto key_of = [&](std::uint32_t face) {
        return std::tuple(surface.features.tets[face], surface.facets[face]);
    };
    while (count > 0) {
        std::size_t next = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (candidates[i].least < candidates[next].least) next = i;
        const auto [least, local] = candidates[next];
        if (least > reached.squared) return;
        candidates[next] = candidates[--count];
        const std::uint32_t face = tile.first_face + local;
        const auto& [u, v, x] = surface.features.faces[face];
        const SeenPoint seen = closest_seen_from(p, worker.points[u], worker.points[v], worker.points[x]);
        const double squared = std::max(seen.at.squared_distance, least);
        if (squared > reached.squared || (squared == reached.squared && reached.closest != none_yet &&
                                          !(key_of(face) < key_of(worker.closest[reached.closest].face))))
            continue;
        if (reached.closest == none_yet) {
            reached.closest = static_cast<std::uint32_t>(worker.closest.size());
            reserve_growing(worker.closest, worker.closest.size() + 1);
            worker.closest.emplace_back();
        }
        reached.squared = squared;
        const std::uint32_t* vertices = surface.features.vertices.data() + tile.first_vertex;
        worker.closest[reached.closest] = {
            near.place, face, {vertices[u], vertices[v], vertices[x]}, seen, squared};
    }
}

void MarginContacts::end(std::uint32_t w) {
    Worker& worker = workers_[w];
    const Body &a = scene_->bodies[worker.pair.a], &b = scene_->bodies[worker.pair.b];
    const SearchedSurface& surface = *worker.pair.surface;
    reserve_growing(worker.found, worker.found.size() + worker.closest.size());
    for (const Closest& closest : worker.closest) {
        const std::uint32_t vertex = worker.pair.vertices[closest.place];
        const auto& [u, v, x] = closest.corners;
        const Vec3d corner[3] = {b.positions.exact(u), b.positions.exact(v), b.positions.exact(x)};
        const std::uint32_t tet = surface.features.tets[closest.face], facet = surface.facets[closest.face];
        const Vec3d normal = normal_to(a.positions.exact(vertex), corner, closest.seen,
                                       b.positions.exact(b.tets[tet].v[facet]));
        const std::array<double, 3> weights = normalised(closest.seen.at.weight);
        worker.found.push_back({{.body_a = a.mesh_id,
                                 .vertex = vertex,
                                 .body_b = b.mesh_id,
                                 .tet = tet,
                                 .facet = facet,
                                 .face = {u, v, x},
                                 .face_weights = {weights[0], weights[1], weights[2]},
                                 .distance = std::sqrt(closest.squared),
                                 .normal = {normal.x, normal.y, normal.z}},
                                closest.squared});
    }
}

// The closest of each vertex and mesh.
void MarginContacts::put_in_order() {
    order_.clear();
    reserve_sparingly(order_, found_.size());
    for (std::uint32_t i = 0; i < found_.size(); ++i) order_.push_back(i);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) {
        const MarginContact &x = found_[i].contact, &y = found_[j].contact;
        return std::tie(x.body_a, x.vertex, x.body_b, found_[i].squared, x.tet, x.facet) <
               std::tie(y.body_a, y.vertex, y.body_b, found_[j].squared, y.tet, y.facet);
    });
    contacts_.clear();
    reserve_sparingly(contacts_, found_.size());
    for (const std::uint32_t i : order_) {
        const MarginContact& found = found_[i].contact;
        if (!contacts_.empty() && place(contacts_.back()) == place(found)) continue;
        contacts_.push_back(found);
    }
    check_contact_count(contacts_.size(), "margin contacts");
    list_pairs(std::span<const MarginContact>(contacts_), pairs_);
}

} // namespace vox
