// Faces are sorted along a Z-shaped curve through their first corners (Morton 1966), and every 64 that follow
// each other make a tile. An edge belongs to the first of its faces in that order.
#include "grid/surface_features.hpp"

#include "base/bits.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace vox {

namespace {

constexpr std::uint32_t axis_bits = 10;

// Of each place on the curve the triangle there.
std::pmr::vector<std::uint32_t> sort_along_curve(const Topology& topology, const Positions& positions,
                                                 std::pmr::memory_resource* memory) {
    const std::size_t count = topology.triangles.size();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const Triangle& triangle : topology.triangles) {
        const Vec3d p = positions.exact(triangle.v[0]);
        low = min(low, p);
        high = max(high, p);
    }
    const auto cell = [](double x, double least, double most) {
        constexpr double cells = 1 << axis_bits;
        return most > least ? static_cast<std::uint32_t>(
                                  std::clamp((x - least) / (most - least) * cells, 0.0, cells - 1))
                            : 0;
    };
    std::pmr::vector<std::uint64_t> keys(count, memory);
    for (std::size_t t = 0; t < count; ++t) {
        const Vec3d p = positions.exact(topology.triangles[t].v[0]);
        const std::uint32_t code =
            morton_code(cell(p.x, low.x, high.x), cell(p.y, low.y, high.y), cell(p.z, low.z, high.z));
        keys[t] = std::uint64_t{code} << 32 | t;
    }
    std::sort(keys.begin(), keys.end());
    std::pmr::vector<std::uint32_t> order(count, memory);
    for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(keys[i]);
    return order;
}

bool has_vertex(const Triangle& triangle, std::uint32_t vertex) {
    return triangle.v[0] == vertex || triangle.v[1] == vertex || triangle.v[2] == vertex;
}

// Adds the tile of these triangles, of which `place` has all.
void add_tile(const Topology& topology, std::span<const std::uint32_t> tile,
              const std::pmr::vector<std::uint32_t>& place, const Tiles* tiles, SurfaceFeatures& out) {
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
        out.triangles.push_back(t);
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = v[side], b = v[(side + 1) % 3];
            bool is_first = true;
            for (const std::uint32_t other : topology.ring_of(a))
                is_first &= place[other] >= place[t] || !has_vertex(topology.triangles[other], b);
            if (is_first) out.edges.push_back({index_of(a), index_of(b)});
        }
    }
    if (tiles)
        for (auto v = vertices.begin(); v != end; ++v) {
            const std::uint32_t block = tiles->block_of(*v);
            if (out.blocks.size() == made.first_block || out.blocks.back() != block)
                out.blocks.push_back(block);
        }
    made.block_count = static_cast<std::uint8_t>(out.blocks.size() - made.first_block);
    made.vertex_count = static_cast<std::uint8_t>(end - vertices.begin());
    made.face_count = static_cast<std::uint8_t>(tile.size());
    made.edge_count = static_cast<std::uint8_t>(out.edges.size() - made.first_edge);
    out.tiles.push_back(made);
}

} // namespace

void make_surface_features(const Topology& topology, const Positions& positions, const Tiles* tiles,
                           SurfaceFeatures& out) {
    std::pmr::memory_resource* memory = out.tiles.get_allocator().resource();
    const std::size_t count = topology.triangles.size();
    const std::pmr::vector<std::uint32_t> order = sort_along_curve(topology, positions, memory);
    std::pmr::vector<std::uint32_t> place(count, memory);
    for (std::size_t i = 0; i < count; ++i) place[order[i]] = static_cast<std::uint32_t>(i);

    // A closed surface has three edges for two faces. Vertices are in two tiles, or three.
    out.tiles.reserve((count + SurfaceTile::most_faces - 1) / SurfaceTile::most_faces);
    out.faces.reserve(count);
    out.triangles.reserve(count);
    out.edges.reserve(count + count / 2 + 3);
    out.vertices.reserve(count + 3);
    for (std::size_t first = 0; first < count; first += SurfaceTile::most_faces)
        add_tile(
            topology,
            std::span(order).subspan(first, std::min<std::size_t>(SurfaceTile::most_faces, count - first)),
            place, tiles, out);

    out.tets.assign(count, ~0u);
    for (std::uint32_t tet = 0; tet < topology.across.size(); ++tet)
        for (std::uint32_t facet = 0; facet < 4; ++facet) {
            const std::uint32_t across = topology.across(tet, facet);
            if (across == Across::nothing || !(across & Across::surface_bit)) continue;
            std::uint32_t& of_face = out.tets[place[across & ~Across::surface_bit]];
            of_face = std::min(of_face, tet);
        }
}

} // namespace vox
