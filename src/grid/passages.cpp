#include "grid/passages.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <tuple>

namespace vox {

void Passages::bind(vox_mesh mesh, const Positions& positions) {
    const auto at = std::ranges::lower_bound(bound_, mesh, {}, &Bound::mesh);
    const bool is_bound = at != bound_.end() && at->mesh == mesh;
    if (!positions.data)
        forget(mesh);
    else if (is_bound)
        at->positions = positions;
    else
        bound_.insert(at, {mesh, positions});
}

void Passages::forget(vox_mesh mesh) noexcept {
    std::erase_if(bound_, [mesh](const Bound& bound) { return bound.mesh == mesh; });
}

void Passages::find(const EdgeScene& scene, VertexFaceSearch& search, vox_counters& counters) {
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
        worker.body = worker.tile = ~0u;
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
        worker.from.reserve(SurfaceTile::most_vertices);
        worker.to.reserve(SurfaceTile::most_vertices);
    }
    workers_.level();

    // The first of each vertex and mesh.
    std::sort(found_.begin(), found_.end(), [](const vox_passage& x, const vox_passage& y) {
        return std::tie(x.mesh_a, x.vertex, x.mesh_b, x.time, x.tet, x.facet) <
               std::tie(y.mesh_a, y.vertex, y.mesh_b, y.time, y.tet, y.facet);
    });
    passages_.clear();
    reserve_sparingly(passages_, found_.size());
    std::unique_copy(found_.begin(), found_.end(), std::back_inserter(passages_),
                     [](const vox_passage& x, const vox_passage& y) {
                         return x.mesh_a == y.mesh_a && x.vertex == y.vertex && x.mesh_b == y.mesh_b;
                     });
    if (passages_.size() > VOX_MAX_CONTACTS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the step has %zu passages, the limit is %u", passages_.size(), VOX_MAX_CONTACTS));
    counters.passages = passages_.size();
}

Vec3d Passages::before(std::uint32_t body, std::uint32_t vertex) const noexcept {
    const Positions& previous = previous_[body];
    return previous.data ? previous.exact(vertex) : scene_->bodies[body].positions.exact(vertex);
}

void Passages::leave_out(std::uint32_t a, std::uint32_t, std::pmr::vector<std::uint32_t>& vertices) const {
    const auto removed = scene_->bodies[a].removed_vertices;
    std::erase_if(vertices, [&](std::uint32_t vertex) { return has_bit(removed, vertex); });
}

void Passages::visit(const NearFaces& near, std::uint32_t w) {
    Worker& worker = workers_[w];
    const Body &a = scene_->bodies[near.a], &b = scene_->bodies[near.b];
    const SurfaceFeatures& features = near.surface->features;
    const SurfaceTile& tile = features.tiles[near.tile];
    const std::uint32_t* vertices = features.vertices.data() + tile.first_vertex;
    if (worker.body != near.b || worker.tile != near.tile) {
        worker.body = near.b;
        worker.tile = near.tile;
        worker.from.clear();
        worker.to.clear();
        for (std::uint32_t v = 0; v < tile.vertex_count; ++v) {
            worker.from.push_back(before(near.b, vertices[v]));
            worker.to.push_back(b.positions.exact(vertices[v]));
        }
    }
    const Vec3d from = before(near.a, near.vertex), to = a.positions.exact(near.vertex);
    const auto key_of = [&](std::uint32_t face) {
        return std::tuple(features.tets[face], near.surface->facets[face]);
    };
    double first = 1;
    std::uint32_t best = ~0u;
    for (std::uint64_t left = near.faces; left; left &= left - 1) {
        const std::uint32_t face = tile.first_face + static_cast<std::uint32_t>(std::countr_zero(left));
        SeenMotion motion;
        for (std::size_t i = 0; i < 3; ++i) {
            motion.from[i] = worker.from[features.faces[face][i]] - from;
            motion.to[i] = worker.to[features.faces[face][i]] - to;
        }
        const double time = meeting_time(motion, first);
        if (time > first || (time == first && best != ~0u && !(key_of(face) < key_of(best)))) continue;
        first = time;
        best = face;
    }
    if (best == ~0u) return;
    const auto& [u, v, x] = features.faces[best];
    reserve_growing(worker.found, worker.found.size() + 1);
    worker.found.push_back({.mesh_a = a.mesh_id,
                            .vertex = near.vertex,
                            .mesh_b = b.mesh_id,
                            .tet = features.tets[best],
                            .facet = near.surface->facets[best],
                            .face = {vertices[u], vertices[v], vertices[x]},
                            .time = first});
}

} // namespace vox
