// Points anywhere, by the rounds of a step, in a second grid whose meshes collide with points alone.
#include "base/room.hpp"
#include "base/structs.hpp"
#include "dist/clusters.hpp"
#include "dist/rounds.hpp"

#include <algorithm>
#include <tuple>

using namespace vox;
using namespace vox::dist;

namespace {

// Parts that the second grid lacks are inserted; all get the positions that they have now.
void place_parts(vox_dist_scene& scene) {
    Side& side = scene.points_side_;
    if (!side.grid) {
        vox_grid* grid = nullptr;
        check(vox_grid_create(&*scene.grid_desc_, &grid));
        side.grid.reset(grid);
    }
    vox_filter filter = everything();
    filter.group = -1; // not with each other
    for (Part* part : scene.parts_) {
        const vox_positions positions = as_given(part->positions, part->vertex_count);
        const auto known = std::find_if(side.placed.begin(), side.placed.end(),
                                        [&](const Placed& placed) { return placed.part == part; });
        if (known != side.placed.end()) {
            check(vox_mesh_bind_positions(side.grid.get(), known->mesh, &positions));
            continue;
        }
        vox_mesh_desc mesh = vox_default_mesh_desc();
        mesh.flags = VOX_MESH_BORROW_TETS;
        mesh.positions = positions;
        mesh.tets = part->tets.data();
        mesh.tet_count = part->tet_count;
        mesh.filter = filter;
        reserve_growing(side.placed, side.placed.size() + 1);
        vox_body id = VOX_NULL_BODY;
        check(vox_mesh_insert(side.grid.get(), &mesh, &id));
        side.placed.insert(std::upper_bound(side.placed.begin(), side.placed.end(), id,
                                            [](vox_body m, const Placed& placed) { return m < placed.mesh; }),
                           Placed{id, part});
    }
}

// Of the hits of a point the one that counts comes first.
auto order(const Found& f) noexcept {
    const vox_dist_contact& c = f.contact;
    return std::tuple(c.vertex, c.body_b, c.interior == 0, c.tet);
}

} // namespace

void vox_dist_scene::locate(const vox_positions* points, vox_dist_location* out_locations) {
    const auto before = counters_;
    counters_ = {};
    counters_.contacts = before.contacts;
    counters_.incoming = before.incoming;
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
            throw Error(VOX_ERROR_LIMIT, format("points.count is %llu, expected at most %u",
                                                static_cast<unsigned long long>(count), VOX_MAX_VERTICES));
        positions = check_positions(*points, "points");
        if (count) require(points->data, "points.data");
        if (count) require(out_locations, "out_locations");
        double at[3];
        for (std::uint64_t i = 0; i < count; ++i) {
            get(positions, i, at);
            check_position(at, {"point", i, 0, false});
        }
        look();
        place_parts(*this);
        clusters.make(static_cast<std::uint32_t>(count), 64,
                      [&](std::uint32_t i, double out[3]) { get(positions, i, out); });
        for (std::uint32_t c = 0; c < clusters.size(); ++c) {
            for (const std::uint32_t i : clusters.of(c)) {
                get(positions, i, at);
                add_point(clusters.boxes[c], at);
            }
            mine.vertices.add(clusters.boxes[c]);
        }
        for (const Part* part : parts_) mine.tets.add(part->tet_box);
    });
    meet(mine, failure);

    Rounds rounds(*this, points_side_, true);
    const Source source{nullptr, &clusters, positions, mine.vertices};
    rounds.run({&source, count != 0 ? 1u : 0u}, failure);
    failure.guard([&] {
        std::sort(rounds.found.begin(), rounds.found.end(),
                  [](const Found& a, const Found& b) { return order(a) < order(b); });
    });
    failure.agree(transport_);
    for (std::uint64_t i = 0; i < count; ++i) {
        out_locations[i] = {};
        out_locations[i].rank = VOX_NONE;
    }
    for (const Found& f : rounds.found) {
        vox_dist_location& location = out_locations[f.contact.vertex];
        if (location.rank != VOX_NONE) continue;
        location = {f.contact.body_b, f.contact.tet, {}, f.contact.rank, f.contact.interior};
        std::copy_n(f.contact.weights, 4, location.weights);
    }
    counters_.messages = transport_.messages;
    counters_.collectives = transport_.collectives;
}
