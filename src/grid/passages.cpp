#include "grid/passages.hpp"

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "grid/contact_pairs.hpp"

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

void Passages::find(const EdgeScene& scene, VertexFaceSearch& search, Counters& counters) {
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
    std::sort(found_.begin(), found_.end(), [](const vox_passage& x, const vox_passage& y) {
        return std::tie(x.body_a, x.vertex, x.body_b, x.time, x.tet, x.facet) <
               std::tie(y.body_a, y.vertex, y.body_b, y.time, y.tet, y.facet);
    });
    passages_.clear();
    reserve_sparingly(passages_, found_.size());
    std::unique_copy(found_.begin(), found_.end(), std::back_inserter(passages_),
                     [](const vox_passage& x, const vox_passage& y) {
                         return x.body_a == y.body_a && x.vertex == y.vertex && x.body_b == y.body_b;
                     });
    check_contact_count(passages_.size(), "passages");
    counters.passages = passages_.size();
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
