#include "grid/passages.hpp"

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <tuple>

namespace vox {

void Passages::bind(vox_body mesh, const Positions& positions) {
    const auto at = std::ranges::lower_bound(bound_, mesh, {}, &Bound::mesh);
    const bool is_bound = at != bound_.end() && at->mesh == mesh;
    if (!positions.data)
        forget(mesh);
    else if (is_bound)
        at->positions = positions;
    else
        bound_.insert(at, {mesh, positions});
}

void Passages::forget(vox_body mesh) noexcept {
    erase_if(bound_, [mesh](const Bound& bound) { return bound.mesh == mesh; });
}

void Passages::find(const StepScene& scene, std::span<const vox_contact> contacts, VertexFaceSearch& search,
                    Counters& counters) {
    scene_ = &scene;
    previous_.assign(scene.bodies.size(), {});
    for (std::size_t b = 0, i = 0; b < scene.bodies.size(); ++b) {
        while (i < bound_.size() && bound_[i].mesh < scene.bodies[b].mesh_id) ++i;
        if (i < bound_.size() && bound_[i].mesh == scene.bodies[b].mesh_id)
            previous_[b] = bound_[i].positions;
    }
    workers_.grow(scene.workers->count());
    for (Worker& worker : workers_) {
        worker.found.clear();
        worker.tile = nullptr;
    }
    search.find_meeting(scene, previous_, *this);
    found_.clear();
    std::size_t count = 0;
    for (const Worker& worker : workers_) count += worker.found.size();
    reserve_sparingly(found_, count);
    for (const Worker& worker : workers_)
        found_.insert(found_.end(), worker.found.begin(), worker.found.end());
    for (Worker& worker : workers_) { // in a later step, one may find all
        reserve_sparingly(worker.found, count);
        reserve_sparingly(worker.met, count);
    }
    workers_.level();

    // The first of each vertex and mesh.
    std::sort(found_.begin(), found_.end(), [](const Passage& x, const Passage& y) {
        return std::tie(x.body_a, x.vertex, x.body_b, x.time, x.tet, x.facet) <
               std::tie(y.body_a, y.vertex, y.body_b, y.time, y.tet, y.facet);
    });
    passages_.clear();
    reserve_sparingly(passages_, found_.size());
    std::unique_copy(found_.begin(), found_.end(), std::back_inserter(passages_),
                     [](const Passage& x, const Passage& y) {
                         return x.body_a == y.body_a && x.vertex == y.vertex && x.body_b == y.body_b;
                     });
    check_contact_count(passages_.size(), "passages");
    counters.passages = passages_.size();
    list_impacts(contacts);
}

void Passages::list_impacts(std::span<const vox_contact> contacts) {
    impacts_.clear();
    reserve_sparingly(impacts_, passages_.size());
    const auto place = [](const auto& c) { return std::tuple(c.body_a, c.vertex, c.body_b); };
    const auto body_of = [&](vox_body id) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(scene_->bodies, id, {}, &Body::mesh_id) -
                                          scene_->bodies.begin());
    };
    auto inside = contacts.begin();
    for (const Passage& passage : passages_) {
        inside =
            std::lower_bound(inside, contacts.end(), place(passage),
                             [&](const vox_contact& c, const auto& sought) { return place(c) < sought; });
        if (inside != contacts.end() && place(*inside) == place(passage)) continue;
        const std::uint32_t a = body_of(passage.body_a), b = body_of(passage.body_b);
        const Positions &of_a = scene_->bodies[a].positions, &of_b = scene_->bodies[b].positions;
        const Vec3d p = of_a.exact(passage.vertex);
        const Vec3d corner[3] = {of_b.exact(passage.face[0]), of_b.exact(passage.face[1]),
                                 of_b.exact(passage.face[2])};
        const Vec3d apex = of_b.exact(scene_->bodies[b].tets[passage.tet].v[passage.facet]);
        std::uint64_t exact_tests = 0;
        const int side = orientation(corner[0], corner[1], corner[2], p, exact_tests),
                  inner = orientation(corner[0], corner[1], corner[2], apex, exact_tests);
        if (side == 0 || side == -inner) continue;
        const auto at = [&](const Vec3d& from, const Vec3d& to) { return from + passage.time * (to - from); };
        Vec3d met[3];
        for (int i = 0; i < 3; ++i) met[i] = at(before(b, passage.face[i]), corner[i]);
        const SeenPoint seen = closest_seen_from(at(before(a, passage.vertex), p), met[0], met[1], met[2]);
        const std::array<double, 3> weights = normalised(seen.at.weight);
        const Vec3d normal = facet_normal(corner[0], corner[1], corner[2], apex, p, seen.way);
        impacts_.push_back({passage,
                            {weights[0], weights[1], weights[2]},
                            {normal.x, normal.y, normal.z},
                            std::min(dot(normal, p - corner[0]), 0.0)});
    }
    list_pairs(std::span<const Impact>(impacts_), pairs_);
}

Vec3d Passages::before(std::uint32_t body, std::uint32_t vertex) const noexcept {
    const Positions& previous = previous_[body];
    return previous.data ? previous.exact(vertex) : scene_->bodies[body].positions.exact(vertex);
}

void Passages::leave_out(std::uint32_t a, std::uint32_t, Array<std::uint32_t>& vertices) const {
    const auto removed = scene_->bodies[a].removed_vertices;
    erase_if(vertices, [&](std::uint32_t vertex) { return has_bit(removed, vertex); });
}

void Passages::begin(const VertexFacePair& pair, std::uint32_t w) {
    Worker& worker = workers_[w];
    worker.pair = pair;
    worker.tile = nullptr;
    worker.met.clear();
    reserve_growing(worker.met_of, pair.vertices.size());
    worker.met_of.assign(pair.vertices.size(), none_yet);
}

void Passages::load(Worker& worker, const SurfaceTile& tile) const {
    const std::uint32_t* vertices = worker.pair.surface->features.vertices.data() + tile.first_vertex;
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v) {
        worker.from[v] = before(worker.pair.b, vertices[v]);
        worker.to[v] = scene_->bodies[worker.pair.b].positions.exact(vertices[v]);
    }
    worker.tile = &tile;
}

void Passages::visit(const SurfaceTile& tile, std::span<const NearFaces> near, std::uint32_t w) {
    Worker& worker = workers_[w];
    if (worker.tile != &tile) load(worker, tile);
    for (const NearFaces& one : near) visit(worker, tile, one);
}

void Passages::visit(Worker& worker, const SurfaceTile& tile, const NearFaces& near) const {
    const SearchedSurface& surface = *worker.pair.surface;
    const std::uint32_t vertex = worker.pair.vertices[near.place];
    const Vec3d from = before(worker.pair.a, vertex),
                to = scene_->bodies[worker.pair.a].positions.exact(vertex);
    const auto key_of = [&](std::uint32_t face) {
        return std::tuple(surface.features.tets[face], surface.facets[face]);
    };
    std::uint32_t& met = worker.met_of[near.place];
    for (std::uint32_t left = near.faces; left; left &= left - 1) {
        const std::uint32_t face = tile.first_face + static_cast<std::uint32_t>(std::countr_zero(left));
        const std::array<std::uint8_t, 3>& corners = surface.features.faces[face];
        SeenMotion motion;
        for (std::size_t i = 0; i < 3; ++i) {
            motion.from[i] = worker.from[corners[i]] - from;
            motion.to[i] = worker.to[corners[i]] - to;
        }
        const double first = met == none_yet ? 1 : worker.met[met].time;
        const double time = meeting_time(motion, first);
        if (time > first ||
            (time == first && met != none_yet && !(key_of(face) < key_of(worker.met[met].face))))
            continue;
        if (met == none_yet) {
            met = static_cast<std::uint32_t>(worker.met.size());
            reserve_growing(worker.met, worker.met.size() + 1);
            worker.met.emplace_back();
        }
        const std::uint32_t* vertices = surface.features.vertices.data() + tile.first_vertex;
        worker.met[met] = {
            near.place, face, {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]}, time};
    }
}

void Passages::end(std::uint32_t w) {
    Worker& worker = workers_[w];
    const SearchedSurface& surface = *worker.pair.surface;
    reserve_growing(worker.found, worker.found.size() + worker.met.size());
    for (const Met& met : worker.met)
        worker.found.push_back({.body_a = scene_->bodies[worker.pair.a].mesh_id,
                                .vertex = worker.pair.vertices[met.place],
                                .body_b = scene_->bodies[worker.pair.b].mesh_id,
                                .tet = surface.features.tets[met.face],
                                .facet = surface.facets[met.face],
                                .face = {met.corners[0], met.corners[1], met.corners[2]},
                                .time = met.time});
}

} // namespace vox
