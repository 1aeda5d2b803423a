// Tiles are made by splits at medians. An edge belongs to the first of its faces in their order.
#include "grid/surface_features.hpp"

#include "base/median_splits.hpp"
#include "base/vectors.hpp"
#include "mesh/facets.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace vox {

namespace {

// The triangles in the order of their tiles, by three times their middles.
Array<std::uint32_t> order_of_faces(const Topology& topology, const Positions& positions,
                                    std::pmr::memory_resource* memory) {
    Array<SplitPoint<double>> faces(topology.triangles.size(), memory);
    for (std::uint32_t t = 0; t < faces.size(); ++t) {
        const std::uint32_t* v = topology.triangles[t].v;
        const Vec3d sum = positions.exact(v[0]) + positions.exact(v[1]) + positions.exact(v[2]);
        faces[t] = {{sum.x, sum.y, sum.z}, t};
    }
    split_at_medians(std::span(faces), SurfaceTile::most_faces, tiles_of_group, [](const auto&) {});
    Array<std::uint32_t> order(faces.size(), memory);
    for (std::size_t i = 0; i < faces.size(); ++i) order[i] = faces[i].index;
    return order;
}

bool has_vertex(const Triangle& triangle, std::uint32_t vertex) {
    return triangle.v[0] == vertex || triangle.v[1] == vertex || triangle.v[2] == vertex;
}

// Adds the tile of these triangles, of which `place` has all.
void add_tile(const Topology& topology, std::span<const std::uint32_t> tile,
              const Array<std::uint32_t>& place, const Tiles& tiles, SurfaceFeatures& out) {
    std::array<std::uint32_t, SurfaceTile::most_vertices> vertices;
    auto end = vertices.begin();
    for (const std::uint32_t t : tile) end = std::copy_n(topology.triangles[t].v, 3, end);
    std::sort(vertices.begin(), end);
    end = std::unique(vertices.begin(), end);
    const auto index_of = [&](std::uint32_t vertex) {
        return static_cast<std::uint8_t>(std::lower_bound(vertices.begin(), end, vertex) - vertices.begin());
    };
    const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    SurfaceTile made{size(out.vertices), size(out.faces), size(out.edges), size(out.blocks), 0, 0, 0, 0};
    out.vertices.insert(out.vertices.end(), vertices.begin(), end);
    for (const std::uint32_t t : tile) {
        const std::uint32_t* v = topology.triangles[t].v;
        out.faces.push_back({index_of(v[0]), index_of(v[1]), index_of(v[2])});
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = v[side], b = v[(side + 1) % 3];
            bool is_first = true;
            for (const std::uint32_t other : topology.ring_of(a))
                is_first &= place[other] >= place[t] || !has_vertex(topology.triangles[other], b);
            if (is_first) out.edges.push_back({index_of(a), index_of(b)});
        }
    }
    for (auto v = vertices.begin(); v != end; ++v) {
        const std::uint32_t block = tiles.block_of(*v);
        if (out.blocks.size() == made.first_block || out.blocks.back() != block) out.blocks.push_back(block);
    }
    made.block_count = static_cast<std::uint8_t>(out.blocks.size() - made.first_block);
    made.vertex_count = static_cast<std::uint8_t>(end - vertices.begin());
    made.face_count = static_cast<std::uint8_t>(tile.size());
    made.edge_count = static_cast<std::uint8_t>(out.edges.size() - made.first_edge);
    out.tiles.push_back(made);
}

// Adds the group of the tiles from `first` on.
void add_group(std::size_t first, SurfaceFeatures& out) {
    Array<std::uint32_t>& groups = out.block_groups;
    const auto begin = static_cast<std::ptrdiff_t>(groups.size());
    for (std::size_t i = out.tiles[first].first_block; i < out.blocks.size(); ++i)
        groups.push_back(out.blocks[i] / fast::group_blocks);
    std::sort(groups.begin() + begin, groups.end());
    groups.erase(std::unique(groups.begin() + begin, groups.end()), groups.end());
    out.groups.push_back({static_cast<std::uint32_t>(begin),
                          static_cast<std::uint32_t>(groups.end() - groups.begin() - begin)});
}

// The tetrahedron behind each face, and which of its facets the face is.
void add_tets(const Topology& topology, const Array<std::uint32_t>& place, SurfaceFeatures& out) {
    out.tets.assign(place.size(), ~0u);
    out.facets.resize(place.size());
    for (std::uint32_t tet = 0; tet < topology.across.size(); ++tet)
        for (std::uint8_t facet = 0; facet < 4; ++facet) {
            const std::uint32_t across = topology.across(tet, facet);
            if (across == Across::nothing || !(across & Across::surface_bit)) continue;
            const std::uint32_t face = place[across & ~Across::surface_bit];
            if (out.tets[face] != ~0u) continue; // doubled
            out.tets[face] = tet;
            out.facets[face] = facet;
        }
}

// Puts the corners of faces in the order of their facets, which those of doubled tetrahedra may not be in.
void order_corners(std::span<const Tet> tets, SurfaceFeatures& out) {
    for (const SurfaceTile& tile : out.tiles)
        for (std::uint32_t f = tile.first_face; f < tile.first_face + tile.face_count; ++f) {
            const std::array<std::uint8_t, 3> given = out.faces[f];
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t vertex = tets[out.tets[f]].v[facet_corners[out.facets[f]][c]];
                for (const std::uint8_t i : given)
                    if (out.vertices[tile.first_vertex + i] == vertex) out.faces[f][c] = i;
            }
        }
}

void make_features(const Topology& topology, const Body& body, const Tiles& tiles, SurfaceFeatures& out) {
    std::pmr::memory_resource* memory = out.tiles.memory();
    const std::size_t count = topology.triangles.size();
    const Array<std::uint32_t> order = order_of_faces(topology, body.positions, memory);
    Array<std::uint32_t> place(count, memory);
    for (std::size_t i = 0; i < count; ++i) place[order[i]] = static_cast<std::uint32_t>(i);

    // A closed surface has three edges for two faces. Vertices are in two tiles, or three.
    out.tiles.reserve((count + SurfaceTile::most_faces - 1) / SurfaceTile::most_faces);
    out.faces.reserve(count);
    out.edges.reserve(count + count / 2 + 3);
    out.vertices.reserve(count + 3);
    for (std::size_t first = 0; first < count; first += SurfaceTile::most_faces) {
        add_tile(
            topology,
            std::span(order).subspan(first, std::min<std::size_t>(SurfaceTile::most_faces, count - first)),
            place, tiles, out);
        if (out.tiles.size() % tiles_of_group == 0) add_group(out.tiles.size() - tiles_of_group, out);
    }
    if (const std::size_t rest = out.tiles.size() % tiles_of_group; rest > 0)
        add_group(out.tiles.size() - rest, out);
    add_tets(topology, place, out);
    order_corners(body.tets, out);
}

} // namespace

const SurfaceFeatures& KeptFeatures::of(const StepScene& scene, std::uint32_t body) {
    const vox_body mesh = scene.bodies[body].mesh_id;
    auto place = std::ranges::lower_bound(meshes_, mesh, {}, &Kept::mesh);
    const bool is_there = place != meshes_.end() && place->mesh == mesh;
    if (is_there && place->version == scene.versions[body]) return place->features;
    Kept made{mesh, scene.versions[body], SurfaceFeatures(meshes_.memory())};
    make_features(*scene.topologies[body], scene.bodies[body], *scene.of[body].tiles, made.features);
    if (is_there)
        *place = std::move(made);
    else
        place = meshes_.insert(place, std::move(made));
    return place->features;
}

void KeptFeatures::forget(vox_body mesh) noexcept {
    erase_if(meshes_, [mesh](const Kept& kept) { return kept.mesh == mesh; });
}

} // namespace vox
