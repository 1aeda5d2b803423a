// Locates points by the rounds of a step, in a second grid whose meshes collide only with points; those
// outside by the closest surface.
#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "dist/clusters.hpp"
#include "dist/outside.hpp"
#include "dist/rounds.hpp"

#include <algorithm>
#include <tuple>

using namespace vox;
using namespace vox::dist;

namespace {

// Gives all parts to the second grid, at their present positions.
void update_point_grid(vox_dist_scene& scene) {
    SearchGrid& in = scene.point_grid_;
    if (!in.grid) in.grid = create_grid(*scene.grid_desc_);
    for (Part* part : scene.parts_) {
        const vox_positions positions = as_given(part->positions, part->vertex_count);
        const auto inserted = std::ranges::find(in.inserted, part, &InsertedPart::part);
        if (inserted != in.inserted.end()) {
            check(vox_mesh_bind_positions(in.grid.get(), inserted->mesh, &positions));
            continue;
        }
        vox_mesh_desc mesh = vox_default_mesh_desc();
        mesh.flags = VOX_MESH_BORROW_TETS;
        mesh.positions = positions;
        mesh.tets = part->tets.data();
        mesh.tet_count = part->tet_count;
        mesh.filter = unfiltered();
        mesh.filter.group = -1; // not with each other
        reserve_growing(in.inserted, in.inserted.size() + 1);
        vox_body id = VOX_NULL_BODY;
        check(vox_mesh_insert(in.grid.get(), &mesh, &id));
        in.insert(id, part);
    }
}

// Sorts hits by point; the first one of a point counts.
auto order(const VertexHit& hit) noexcept {
    const vox_dist_contact& c = hit.contact;
    return std::tuple(c.vertex, c.body_b, c.interior == 0, c.tet);
}

} // namespace

void vox_dist_scene::locate(const vox_positions* points, vox_dist_location* out_locations) {
    counters_ = {.contacts = counters_.contacts, .incoming = counters_.incoming};
    transport_.messages = transport_.collectives = 0;
    Failure failure;
    Overview mine;
    mine.call = Call::locate;
    Clusters clusters(&memory_);
    Positions positions;
    const std::uint64_t count = points ? points->count : 0;
    failure.guard([&] {
        require(points, "points");
        if (count > VOX_MAX_VERTICES)
            throw Error(VOX_ERROR_LIMIT,
                        format("points.count is %llu, expected at most %u", llu(count), VOX_MAX_VERTICES));
        positions = check_positions(*points, "points");
        if (count) require(points->data, "points.data");
        if (count) require(out_locations, "out_locations");
        for (std::uint64_t i = 0; i < count; ++i)
            check_position(positions.exact(i), [&] { return format("point %llu", llu(i)); });
        read_positions();
        update_point_grid(*this);
        clusters.make(static_cast<std::uint32_t>(count), 64,
                      [&](std::uint32_t i) { return positions.exact(i); });
        mine.vertices = clusters.update_boxes(positions);
        for (const Part* part : parts_) extend(mine.tets, part->tet_box);
    });
    exchange_overviews(mine, failure);

    Rounds rounds(*this, point_grid_, true);
    const VertexSource source{nullptr, &clusters, positions, mine.vertices};
    rounds.run({&source, count != 0 ? 1u : 0u}, failure);
    std::ranges::sort(rounds.vertex_hits, {}, order);
    std::uint64_t outside = count;
    for (std::size_t i = 0; i < rounds.vertex_hits.size(); ++i)
        outside -= i == 0 || rounds.vertex_hits[i].contact.vertex != rounds.vertex_hits[i - 1].contact.vertex;
    failure.agree(transport_, &outside);
    vox_dist_location none{};
    none.rank = VOX_NONE;
    std::fill_n(out_locations, count, none);
    for (const VertexHit& hit : rounds.vertex_hits) {
        vox_dist_location& location = out_locations[hit.contact.vertex];
        if (location.rank != VOX_NONE) continue;
        location = {hit.contact.body_b, hit.contact.tet, VOX_LOCATION_INSIDE, hit.contact.rank, {}, 0};
        std::copy_n(hit.contact.weights, 4, location.weights);
    }
    if (outside != 0) Outside(*this).run(positions, {out_locations, static_cast<std::size_t>(count)});
    counters_.messages = transport_.messages;
    counters_.collectives = transport_.collectives;
}
