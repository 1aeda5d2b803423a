#include "dist/clusters.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace vox::dist {
namespace {

constexpr std::uint32_t tets_of_a_cluster = 64;
constexpr std::uint32_t vertices_of_a_cluster = 64;

std::string named(const PositionName& name) {
    if (!name.has_body) return format("%s %llu", name.what, static_cast<unsigned long long>(name.id));
    return format("%s %llu of body %llu", name.what, static_cast<unsigned long long>(name.id),
                  static_cast<unsigned long long>(name.body));
}

// The order of `ids`; throws if a number is there twice.
void sort_ids(std::span<const std::uint64_t> ids, Array<std::uint32_t>& order, const char* what) {
    order.resize(ids.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (ids[order[i]] == ids[order[i - 1]])
            refuse(format("%s %u and %u both have the number %llu", what, order[i - 1], order[i],
                          static_cast<unsigned long long>(ids[order[i]])));
}

} // namespace

void check_position(const double position[3], const PositionName& name) {
    for (int axis = 0; axis < 3; ++axis) {
        const double number = position[axis];
        if (!std::isfinite(number))
            throw Error(VOX_ERROR_NON_FINITE,
                        named(name) + format(" has coordinate %g on axis %d", number, axis));
        if (!(std::abs(number) < 0x1.ffffffp127))
            throw Error(VOX_ERROR_LIMIT,
                        named(name) + format(" has coordinate %g on axis %d, expected less than "
                                             "2^128 - 2^103 in size",
                                             number, axis));
    }
}

void add_point(Box& box, const double position[3]) noexcept {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const auto near = static_cast<float>(position[axis]);
        const float low = near > position[axis] ? std::nextafter(near, -infinity) : near;
        const float high = near < position[axis] ? std::nextafter(near, infinity) : near;
        if (low < box.min[axis]) box.min[axis] = low;
        if (high > box.max[axis]) box.max[axis] = high;
    }
}

void Part::take(const vox_dist_part_desc& desc, const vox_mesh_desc& mesh) {
    if (mesh.positions.count > VOX_MAX_VERTICES || mesh.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the part has %llu vertices and %llu tets, expected at most %u of each",
                           static_cast<unsigned long long>(mesh.positions.count),
                           static_cast<unsigned long long>(mesh.tet_count), VOX_MAX_TETS));
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
    const auto place = std::lower_bound(by_id.begin(), by_id.end(), id,
                                        [&](std::uint32_t v, std::uint64_t i) { return vertex_ids[v] < i; });
    return place != by_id.end() && vertex_ids[*place] == id ? std::optional(*place) : std::nullopt;
}

void Part::look(Memory* memory) {
    double at[3];
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        get(positions, v, at);
        check_position(at, {"vertex", id_of(v), body, true});
    }
    if (!clustered) {
        const auto centre = [&](std::uint32_t tet, double out[3]) {
            get(positions, tets[4 * std::size_t{tet}], out);
            double other[3];
            get(positions, tets[4 * std::size_t{tet} + 2], other);
            for (int axis = 0; axis < 3; ++axis) out[axis] = out[axis] / 2 + other[axis] / 2;
        };
        tet_clusters.make(tet_count, tets_of_a_cluster, centre);
        // Each vertex once, instead of the tetrahedra.
        Array<std::uint32_t> vertices(memory), of_one(memory);
        Array<std::uint64_t> begins(memory);
        for (std::uint32_t c = 0; c < tet_clusters.size(); ++c) {
            of_one.clear();
            for (const std::uint32_t tet : tet_clusters.of(c))
                of_one.insert(of_one.end(), tets.begin() + 4 * std::ptrdiff_t{tet},
                              tets.begin() + 4 * std::ptrdiff_t{tet} + 4);
            std::sort(of_one.begin(), of_one.end());
            begins.push_back(vertices.size());
            vertices.insert(vertices.end(), of_one.begin(), std::unique(of_one.begin(), of_one.end()));
        }
        begins.push_back(vertices.size());
        tet_clusters.order = std::move(vertices);
        tet_clusters.begins = std::move(begins);

        Array<std::uint32_t> mine(memory);
        for (std::uint32_t v = 0; v < vertex_count; ++v)
            if (owns(v)) mine.push_back(v);
        vertex_clusters.make(static_cast<std::uint32_t>(mine.size()), vertices_of_a_cluster,
                             [&](std::uint32_t i, double out[3]) { get(positions, mine[i], out); });
        for (std::uint32_t& item : vertex_clusters.order) item = mine[item];
        clustered = true;
    }
    for (auto [clusters, whole] :
         {std::pair(&tet_clusters, &tet_box), std::pair(&vertex_clusters, &vertex_box)}) {
        *whole = Box{};
        for (std::uint32_t c = 0; c < clusters->size(); ++c) {
            Box box;
            for (const std::uint32_t vertex : clusters->of(c)) {
                get(positions, vertex, at);
                add_point(box, at);
            }
            clusters->boxes[c] = box;
            whole->add(box);
        }
    }
}

} // namespace vox::dist
