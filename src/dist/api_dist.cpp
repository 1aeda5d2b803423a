// The C border of distributed scenes.
#include "base/border.hpp"
#include "base/structs.hpp"
#include "dist/hash.hpp"
#include "dist/scene.hpp"

using namespace vox;
using namespace vox::dist;

namespace {

vox_transport checked(const vox_transport* transport) {
    vox_transport one{};
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
vox_grid_desc grid_settings(const vox_scene_desc& desc) {
    vox_grid_desc grid = vox_default_grid_desc();
    grid.flags = 0;
    if (!desc.grid) return grid;
    grid = read_struct(desc.grid, "desc.grid");
    if (grid.flags != 0)
        throw Error(
            VOX_ERROR_UNSUPPORTED,
            format("desc.grid->flags is %u, expected 0: depth, events and edge contacts of bodies that are "
                   "split are not supported",
                   grid.flags));
    if (grid.margin != 0)
        throw Error(VOX_ERROR_UNSUPPORTED,
                    format("desc.grid->margin is %g, expected 0: a margin is not supported", grid.margin));
    check_allocator(grid.allocator, "desc.grid->allocator");
    return grid;
}

} // namespace

vox_result vox_scene_create(const vox_scene_desc* desc, const vox_transport* transport,
                            vox_scene** out_scene) {
    return border([&] {
        require(out_scene, "out_scene");
        const vox_transport callbacks = checked(transport);
        vox_scene* scene = nullptr;
        Failure failure;
        failure.guard([&] {
            const vox_scene_desc settings = desc ? read_struct(desc, "desc") : vox_scene_desc{};
            const vox_grid_desc grid = grid_settings(settings);
            CallerMemory memory(grid.allocator);
            scene = std::pmr::polymorphic_allocator<>(&memory).new_object<vox_scene>(grid, callbacks);
        });
        try {
            Transport carrier(callbacks);
            failure.agree(carrier);
        } catch (...) {
            vox_scene_destroy(scene);
            throw;
        }
        *out_scene = scene;
    });
}

void vox_scene_destroy(vox_scene* scene) {
    if (!scene) return;
    CallerMemory memory(scene->grid_desc_->allocator);
    std::pmr::polymorphic_allocator<>(&memory).delete_object(scene);
}

vox_result vox_scene_insert(vox_scene* scene, const vox_part_desc* desc, vox_part* out_part) {
    return border(scene, "scene", [&] {
        require(out_part, "out_part");
        *out_part = scene->insert(read_struct(desc, "desc"));
    });
}

vox_result vox_scene_remove(vox_scene* scene, vox_part part) {
    return border(scene, "scene", [&] { scene->remove(part); });
}

vox_result vox_scene_bind_positions(vox_scene* scene, vox_part part, const vox_positions* positions) {
    return border(scene, "scene", [&] {
        require(positions, "positions");
        scene->bind(part, *positions);
    });
}

vox_result vox_scene_step(vox_scene* scene) {
    return border(scene, "scene", [&] { scene->step(); });
}

vox_result vox_scene_contacts(const vox_scene* scene, vox_scene_contact_view* out_view) {
    return border(scene, "scene", out_view, "out_view", [&] {
        return vox_scene_contact_view{scene->contacts_.data(), sizeof(vox_scene_contact),
                                      scene->contacts_.size()};
    });
}

vox_result vox_scene_incoming(const vox_scene* scene, vox_scene_contact_view* out_view) {
    return border(scene, "scene", out_view, "out_view", [&] {
        return vox_scene_contact_view{scene->incoming_.data(), sizeof(vox_scene_contact),
                                      scene->incoming_.size()};
    });
}

vox_result vox_scene_send(vox_scene* scene, vox_direction direction, uint64_t item_bytes, const void* in,
                          void* out) {
    return border(scene, "scene", [&] { scene->send(direction, item_bytes, in, out); });
}

vox_result vox_scene_hash(vox_scene* scene, uint64_t out_hash[2]) {
    return border(scene, "scene", [&] {
        std::uint64_t hash[2];
        scene->hash(hash);
        require(out_hash, "out_hash");
        std::copy_n(hash, 2, out_hash);
    });
}

vox_result vox_scene_hash_of_grid(const vox_grid* grid, uint64_t out_hash[2]) {
    return border(grid, "grid", [&] {
        require(out_hash, "out_hash");
        std::uint64_t hash[2];
        hash_of_grid(grid, hash);
        std::copy_n(hash, 2, out_hash);
    });
}

vox_result vox_scene_locate(vox_scene* scene, const vox_positions* points, vox_scene_point* out_points) {
    return border(scene, "scene", [&] { scene->locate(points, out_points); });
}

vox_result vox_scene_check(vox_scene* scene) {
    return border(scene, "scene", [&] { scene->check_numbers(); });
}

vox_result vox_scene_costs(const vox_scene* scene, vox_part_cost* costs, uint64_t capacity,
                           uint64_t* out_count) {
    return border(scene, "scene", [&] {
        require(out_count, "out_count");
        if (capacity) require(costs, "costs");
        *out_count = scene->costs(costs, capacity);
    });
}

vox_result vox_scene_get_counters(const vox_scene* scene, vox_scene_counters* out_counters) {
    return border(scene, "scene", [&] { write_struct(out_counters, scene->counters_, "out_counters"); });
}
