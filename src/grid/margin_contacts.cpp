// The closest point of each face that a vertex may be near to, compared as queries compare them.
#include "grid/margin_contacts.hpp"

#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "fast/engine.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace vox {

namespace {

// Of a contact or a margin contact in the canonical order.
template <class Contact>
auto place(const Contact& contact) {
    return std::tuple(contact.mesh_a, contact.vertex, contact.mesh_b);
}

struct Box3d {
    Vec3d min, max;
};

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

void MarginContacts::find(const EdgeScene& scene, double margin, std::span<const vox_contact> contacts,
                          VertexFaceSearch& search, vox_counters& counters) {
    scene_ = &scene;
    inside_ = contacts;
    most_ = margin * margin;
    workers_.grow(scene.workers->count());
    for (Worker& worker : workers_) {
        worker.found.clear();
        worker.body = worker.tile = ~0u;
    }
    found_.clear();
    carry(scene);
    counters.carried_margin_contacts = found_.size();
    search.find_near(scene, margin, *this);
    std::size_t count = found_.size();
    for (const Worker& worker : workers_) count += worker.found.size();
    reserve_sparingly(found_, count);
    for (const Worker& worker : workers_)
        found_.insert(found_.end(), worker.found.begin(), worker.found.end());
    for (Worker& worker : workers_) { // in a later step, one may find all
        reserve_sparingly(worker.found, count);
        worker.points.reserve(SurfaceTile::most_vertices);
    }
    workers_.level();
    put_in_order();
    counters.margin_contacts = contacts_.size();
}

// Those of the last step between bodies that have not moved since.
void MarginContacts::carry(const EdgeScene& scene) {
    if (!scene.engine) return;
    const auto rests = [&](vox_mesh mesh) {
        const auto body = std::lower_bound(scene.bodies.begin(), scene.bodies.end(), mesh,
                                           [](const Body& b, vox_mesh id) { return b.mesh_id < id; });
        return body != scene.bodies.end() && body->mesh_id == mesh &&
               !scene.engine->moved(static_cast<std::size_t>(body - scene.bodies.begin()));
    };
    vox_mesh last_a = VOX_NULL_MESH, last_b = VOX_NULL_MESH;
    bool last_rests = false;
    for (const vox_margin_contact& contact : contacts_) {
        if (contact.mesh_a != last_a || contact.mesh_b != last_b)
            last_rests = rests(contact.mesh_a) && rests(contact.mesh_b);
        last_a = contact.mesh_a;
        last_b = contact.mesh_b;
        if (!last_rests) continue;
        reserve_sparingly(found_, found_.size() + 1);
        found_.push_back({contact, 0}); // there is no other for this vertex and mesh
    }
}

// Vertices that are gone, and those that have a contact.
void MarginContacts::leave_out(std::uint32_t a, std::uint32_t b,
                               std::pmr::vector<std::uint32_t>& vertices) const {
    const vox_mesh mesh_a = scene_->bodies[a].mesh_id, mesh_b = scene_->bodies[b].mesh_id;
    const auto removed = scene_->bodies[a].removed_vertices;
    auto inside = inside_.begin();
    std::erase_if(vertices, [&](std::uint32_t vertex) {
        const std::tuple sought(mesh_a, vertex, mesh_b);
        const auto is_before = [&](const vox_contact& contact) { return place(contact) < sought; };
        const auto is_behind = [&] { return inside != inside_.end() && is_before(*inside); };
        for (int steps = 0; steps < 8 && is_behind(); ++steps) ++inside; // the next is mostly near
        if (is_behind()) inside = std::partition_point(inside, inside_.end(), is_before);
        return has_bit(removed, vertex) || (inside != inside_.end() && place(*inside) == sought);
    });
}

// The distance is never less than that to the box of the face, so that a face may be left out for its box:
// which faces of how many tiles are looked at, in which order, plays no part then.
void MarginContacts::visit(const NearFaces& near, std::uint32_t w) {
    Worker& worker = workers_[w];
    const Body &a = scene_->bodies[near.a], &b = scene_->bodies[near.b];
    const SurfaceFeatures& features = near.surface->features;
    const SurfaceTile& tile = features.tiles[near.tile];
    if (worker.body != near.b || worker.tile != near.tile) {
        worker.body = near.b;
        worker.tile = near.tile;
        worker.points.clear();
        for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
            worker.points.push_back(b.positions.exact(features.vertices[tile.first_vertex + v]));
    }
    const Vec3d p = a.positions.exact(near.vertex);
    const auto key_of = [&](std::uint32_t face) { // of a face of the mesh
        return std::tuple(features.tets[face], near.surface->facets[face]);
    };
    double squared = most_;
    std::uint32_t best = ~0u;
    SeenPoint seen{};
    for (std::uint64_t left = near.faces; left; left &= left - 1) {
        const std::uint32_t face = tile.first_face + static_cast<std::uint32_t>(std::countr_zero(left));
        const auto& [u, v, x] = features.faces[face];
        const Vec3d &c0 = worker.points[u], &c1 = worker.points[v], &c2 = worker.points[x];
        const double least = squared_distance_bound(p, Box3d{min(min(c0, c1), c2), max(max(c0, c1), c2)});
        if (least > squared) continue;
        const SeenPoint found = closest_seen_from(p, c0, c1, c2);
        const double distance = std::max(found.at.squared_distance, least);
        if (distance > squared || (distance == squared && best != ~0u && !(key_of(face) < key_of(best))))
            continue;
        squared = distance;
        best = face;
        seen = found;
    }
    if (best == ~0u) return;
    const auto& [u, v, x] = features.faces[best];
    const Vec3d corner[3] = {worker.points[u], worker.points[v], worker.points[x]};
    const std::uint32_t tet = features.tets[best], facet = near.surface->facets[best];
    const Vec3d normal = normal_to(p, corner, seen, b.positions.exact(b.tets[tet].v[facet]));
    const std::array<double, 3> weights = normalised(seen.at.weight);
    const std::uint32_t* vertices = features.vertices.data() + tile.first_vertex;
    reserve_growing(worker.found, worker.found.size() + 1);
    worker.found.push_back({{.mesh_a = a.mesh_id,
                             .vertex = near.vertex,
                             .mesh_b = b.mesh_id,
                             .tet = tet,
                             .facet = facet,
                             .face = {vertices[u], vertices[v], vertices[x]},
                             .face_weights = {weights[0], weights[1], weights[2]},
                             .distance = std::sqrt(squared),
                             .normal = {normal.x, normal.y, normal.z}},
                            squared});
}

// The closest of each vertex and mesh.
void MarginContacts::put_in_order() {
    order_.clear();
    reserve_sparingly(order_, found_.size());
    for (std::uint32_t i = 0; i < found_.size(); ++i) order_.push_back(i);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) {
        const vox_margin_contact &x = found_[i].contact, &y = found_[j].contact;
        return std::tie(x.mesh_a, x.vertex, x.mesh_b, found_[i].squared, x.tet, x.facet) <
               std::tie(y.mesh_a, y.vertex, y.mesh_b, found_[j].squared, y.tet, y.facet);
    });
    contacts_.clear();
    reserve_sparingly(contacts_, found_.size());
    for (const std::uint32_t i : order_) {
        const vox_margin_contact& found = found_[i].contact;
        if (!contacts_.empty() && place(contacts_.back()) == place(found)) continue;
        contacts_.push_back(found);
    }
    if (contacts_.size() > VOX_MAX_CONTACTS)
        throw Error(VOX_ERROR_LIMIT, format("the step has %zu margin contacts, the limit is %u",
                                            contacts_.size(), VOX_MAX_CONTACTS));
}

} // namespace vox
