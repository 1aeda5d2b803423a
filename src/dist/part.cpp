#include "dist/part.hpp"
#include "base/llu.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vox::dist {
namespace {

constexpr std::uint32_t items_of_a_cluster = 64;

// Sorts the indices of `ids` by number; throws if a number is there twice.
void sort_ids(std::span<const std::uint64_t> ids, Array<std::uint32_t>& order, const char* what) {
    order.resize(ids.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (ids[order[i]] == ids[order[i - 1]])
            refuse(format("%s %u and %u both have the number %llu", what, order[i - 1], order[i],
                          llu(ids[order[i]])));
}

} // namespace

void Part::take(const vox_dist_part_desc& desc, const vox_mesh_desc& mesh) {
    if (mesh.positions.count > VOX_MAX_VERTICES || mesh.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the part has %llu vertices and %llu tets, expected at most %u of each",
                           llu(mesh.positions.count), llu(mesh.tet_count), VOX_MAX_TETS));
    if (mesh.tet_count) require(mesh.tets, "mesh.tets");
    vertex_count = static_cast<std::uint32_t>(mesh.positions.count);
    tet_count = static_cast<std::uint32_t>(mesh.tet_count);
    if (desc.vertex_ids) {
        vertex_ids.assign(desc.vertex_ids, desc.vertex_ids + vertex_count);
        sort_ids(vertex_ids, by_id, "vertices");
    }
    if (desc.owned) {
        owned.assign(desc.owned, desc.owned + vertex_count);
        for (std::uint32_t v = 0; v < vertex_count; ++v)
            if (owned[v] > 1) refuse(format("owned[%u] is %u, expected 0 or 1", v, owned[v]));
    }
    for (std::size_t corner = 0; corner < 4 * std::size_t{tet_count}; ++corner)
        if (mesh.tets[corner] >= vertex_count)
            throw Error(VOX_ERROR_INVALID_MESH,
                        format("tet %zu names vertex %u of %u", corner / 4, mesh.tets[corner], vertex_count));
    tets.resize(4 * std::size_t{tet_count});
    if (desc.tet_ids) {
        sort_ids({desc.tet_ids, tet_count}, tet_indices, "tets");
        tet_ids.resize(tet_count);
        for (std::uint32_t t = 0; t < tet_count; ++t) {
            tet_ids[t] = desc.tet_ids[tet_indices[t]];
            std::copy_n(mesh.tets + 4 * std::size_t{tet_indices[t]}, 4, tets.data() + 4 * std::size_t{t});
        }
    } else if (tet_count) {
        std::copy_n(mesh.tets, tets.size(), tets.data());
    }
}

std::optional<std::uint32_t> Part::find(std::uint64_t id) const noexcept {
    if (vertex_ids.empty())
        return id < vertex_count ? std::optional(static_cast<std::uint32_t>(id)) : std::nullopt;
    const auto place =
        std::ranges::lower_bound(by_id, id, {}, [&](std::uint32_t v) { return vertex_ids[v]; });
    return place != by_id.end() && vertex_ids[*place] == id ? std::optional(*place) : std::nullopt;
}

void Part::make_clusters(Memory* memory) {
    const auto middle = [&](std::uint32_t tet) {
        const std::uint32_t* const corners = tets.data() + 4 * std::size_t{tet};
        return 0.5 * positions.exact(corners[0]) + 0.5 * positions.exact(corners[2]);
    };
    tet_clusters.make(tet_count, items_of_a_cluster, middle);
    // Replaces the tetrahedra of a cluster by their vertices, each once.
    Array<std::uint32_t> vertices(memory), of_one(memory);
    Array<std::uint64_t> begins(memory);
    for (std::uint32_t c = 0; c < tet_clusters.size(); ++c) {
        of_one.clear();
        for (const std::uint32_t tet : tet_clusters.of(c)) {
            const std::uint32_t* const corners = tets.data() + 4 * std::size_t{tet};
            of_one.insert(of_one.end(), corners, corners + 4);
        }
        std::ranges::sort(of_one);
        begins.push_back(vertices.size());
        vertices.insert(vertices.end(), of_one.begin(), std::unique(of_one.begin(), of_one.end()));
    }
    begins.push_back(vertices.size());
    tet_clusters.order = std::move(vertices);
    tet_clusters.begins = std::move(begins);

    Array<std::uint32_t> mine(memory);
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (owns(v)) mine.push_back(v);
    vertex_clusters.make(static_cast<std::uint32_t>(mine.size()), items_of_a_cluster,
                         [&](std::uint32_t i) { return positions.exact(mine[i]); });
    for (std::uint32_t& item : vertex_clusters.order) item = mine[item];
}

void Part::find_facets(Memory* memory) {
    if (has_facets) return;
    struct TetFacet {
        std::array<std::uint32_t, 3> vertices;
        std::uint32_t opposite, place;
    };
    Array<TetFacet> all(memory);
    all.reserve(4 * std::size_t{tet_count});
    for (std::uint32_t t = 0; t < tet_count; ++t) {
        const std::uint32_t* const tet = tets.data() + 4 * std::size_t{t};
        if (names_a_vertex_twice({tet[0], tet[1], tet[2], tet[3]})) continue;
        for (std::uint32_t f = 0; f < 4; ++f) all.push_back({sorted_facet(tet, f), tet[f], 4 * t + f});
    }
    std::ranges::sort(all, {}, [](const TetFacet& f) { return std::tie(f.vertices, f.place); });
    facets.clear();
    for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
        bool one = true;
        for (end = begin; end < all.size() && all[end].vertices == all[begin].vertices; ++end)
            one &= all[end].opposite == all[begin].opposite;
        for (std::size_t i = begin; one && i < end; ++i) facets.push_back(all[i].place);
    }
    has_facets = true;
}

void Part::read_positions(Memory* memory) {
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        check_position(positions.exact(v),
                       [&] { return format("vertex %llu of body %llu", llu(id_of(v)), llu(body)); });
    if (!clustered) make_clusters(memory);
    clustered = true;
    tet_box = tet_clusters.update_boxes(positions);
    vertex_box = vertex_clusters.update_boxes(positions);
}

} // namespace vox::dist
