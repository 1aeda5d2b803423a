// The C border of distributed scenes.
#include "base/border.hpp"
#include "base/structs.hpp"
#include "dist/scene.hpp"

using namespace vox;
using namespace vox::dist;

namespace {

vox_dist_transport checked(const vox_dist_transport* transport) {
    vox_dist_transport one{};
    one.size = 1;
    if (!transport) return one;
    one = read_struct(transport, "transport");
    if (one.size > INT32_MAX) refuse(format("transport.size is %u, at most 2147483647", one.size));
    if (one.rank >= one.size) refuse(format("transport.rank is %u of %u", one.rank, one.size));
    if (one.size > 1 && !(one.allgather && one.exchange && one.agree))
        refuse(format("a transport of %u ranks lacks one of its functions", one.size));
    return one;
}

// The settings of the grid inside.
vox_grid_desc grid_settings(const vox_grid_desc* desc) {
    vox_grid_desc grid = vox_default_grid_desc();
    grid.flags = 0;
    if (!desc) return grid;
    grid = read_struct(desc, "grid");
    if (grid.flags != 0)
        throw Error(VOX_ERROR_UNSUPPORTED,
                    format("grid->flags is %u, expected 0: constraints and edges of bodies that are "
                           "split are not supported",
                           grid.flags));
    if (grid.margin != 0)
        throw Error(VOX_ERROR_UNSUPPORTED,
                    format("grid->margin is %g, expected 0: a margin is not supported", grid.margin));
    check_allocator(grid.allocator, "grid->allocator");
    return grid;
}

} // namespace

vox_result vox_dist_scene_create(const vox_grid_desc* grid, const vox_dist_transport* transport,
                                 vox_dist_scene** out_scene) {
    return border([&] {
        require(out_scene, "out_scene");
        const vox_dist_transport callbacks = checked(transport);
        vox_dist_scene* scene = nullptr;
        Failure failure;
        failure.guard([&] {
            const vox_grid_desc settings = grid_settings(grid);
            CallerMemory memory(settings.allocator);
            scene =
                std::pmr::polymorphic_allocator<>(&memory).new_object<vox_dist_scene>(settings, callbacks);
        });
        try {
            Transport carrier(callbacks);
            failure.agree(carrier);
        } catch (...) {
            vox_dist_scene_destroy(scene);
            throw;
        }
        *out_scene = scene;
    });
}

void vox_dist_scene_destroy(vox_dist_scene* scene) {
    if (!scene) return;
    CallerMemory memory(scene->grid_desc_->allocator);
    std::pmr::polymorphic_allocator<>(&memory).delete_object(scene);
}

vox_result vox_dist_scene_insert(vox_dist_scene* scene, const vox_dist_part_desc* desc) {
    return border(scene, "scene", [&] { scene->insert(read_struct(desc, "desc")); });
}

vox_result vox_dist_scene_remove(vox_dist_scene* scene, uint64_t body) {
    return border(scene, "scene", [&] { scene->remove(body); });
}

vox_result vox_dist_scene_bind_positions(vox_dist_scene* scene, uint64_t body,
                                         const vox_positions* positions) {
    return border(scene, "scene", [&] {
        require(positions, "positions");
        scene->bind(body, *positions);
    });
}

vox_result vox_dist_scene_step(vox_dist_scene* scene) {
    return border(scene, "scene", [&] { scene->step(); });
}

vox_result vox_dist_scene_get_contacts(const vox_dist_scene* scene, vox_dist_side side,
                                       vox_dist_contact_view* out_view) {
    return border(scene, "scene", out_view, "out_view", [&] {
        check_enum(side, VOX_DIST_TETS, "side");
        const auto& contacts = side == VOX_DIST_VERTICES ? scene->contacts_ : scene->tet_contacts_;
        return vox_dist_contact_view{contacts.data(), contacts.size()};
    });
}

vox_result vox_dist_scene_send(vox_dist_scene* scene, vox_dist_side from, uint64_t item_bytes, const void* in,
                               void* out) {
    return border(scene, "scene", [&] { scene->send(enum_value(from), item_bytes, in, out); });
}

vox_result vox_dist_scene_get_hash(vox_dist_scene* scene, uint64_t out_hash[2]) {
    return border(scene, "scene", [&] {
        std::uint64_t hash[2];
        scene->hash(hash);
        require(out_hash, "out_hash");
        std::copy_n(hash, 2, out_hash);
    });
}

vox_result vox_dist_scene_locate(vox_dist_scene* scene, const vox_positions* points,
                                 vox_dist_location* out_locations) {
    return border(scene, "scene", [&] { scene->locate(points, out_locations); });
}

vox_result vox_dist_scene_check(vox_dist_scene* scene) {
    return border(scene, "scene", [&] { scene->check_numbers(); });
}

vox_result vox_dist_scene_get_costs(const vox_dist_scene* scene, vox_dist_cost* costs, uint64_t capacity,
                                    uint64_t* out_count) {
    return border(scene, "scene", [&] {
        require(out_count, "out_count");
        if (capacity) require(costs, "costs");
        *out_count = scene->costs(costs, capacity);
    });
}

vox_result vox_dist_scene_get_counters(const vox_dist_scene* scene, vox_counter_view* out_view) {
    return border(scene, "scene", out_view, "out_view", [&] { return scene->counters(); });
}
