// The C border of cutting and growing.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"

#include <cinttypes>

using namespace vox;

namespace {

// Reads `count` elements of `each` numbers.
std::span<const std::uint32_t> read_numbers(const std::uint32_t* numbers, std::uint64_t count,
                                            std::size_t each, const char* name) {
    if (count > 0) require(numbers, name);
    check_limit(count, VOX_MAX_TETS, "count");
    if (reinterpret_cast<std::uintptr_t>(numbers) % alignof(std::uint32_t) != 0)
        refuse(format("%s is not aligned to %zu bytes", name, alignof(std::uint32_t)));
    return {numbers, static_cast<std::size_t>(count) * each};
}

std::span<const Tet> read_corners(const std::uint32_t* corners, std::uint64_t count) {
    (void)read_numbers(corners, count, 4, "corners");
    return {reinterpret_cast<const Tet*>(corners), static_cast<std::size_t>(count)};
}

// Calls function(mesh), which edits `count` tets or vertices.
template <class Function>
vox_result edit(vox_grid* grid, vox_body body, std::uint64_t count, Function&& function) {
    return border(grid, "grid", [&] {
        function(grid->mesh(body));
        grid->was_edited(body, count);
    });
}

} // namespace

vox_result vox_mesh_set_topology(vox_grid* grid, vox_body body, const vox_mesh_desc* desc) {
    return border(grid, "grid", [&] {
        (void)grid->mesh(body); // throws for an invalid id
        const vox_mesh_desc settings = read_struct(desc, "desc");
        grid->set_topology(body, settings, check_mesh(settings, "", NullPositions::allowed));
    });
}

vox_result vox_mesh_set_tets_enabled(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                     uint32_t enabled) {
    return edit(grid, body, count, [&](Mesh& edited) {
        const bool is_on = read_bool(enabled, "enabled"); // fails before read_numbers() does
        edited.set_tets_enabled(read_numbers(tets, count, 1, "tets"), is_on);
    });
}

vox_result vox_mesh_replace_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                 const uint32_t* corners) {
    return edit(grid, body, count, [&](Mesh& edited) {
        edited.replace_tets(read_numbers(tets, count, 1, "tets"), read_corners(corners, count));
    });
}

vox_result vox_mesh_append_tets(vox_grid* grid, vox_body body, const uint32_t* corners, uint64_t count,
                                uint32_t* out_first) {
    return border(grid, "grid", [&] {
        (void)grid->mesh(body);
        require(out_first, "out_first");
        *out_first = grid->append_tets(body, read_corners(corners, count));
    });
}

vox_result vox_mesh_remove_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count) {
    return edit(grid, body, count,
                [&](Mesh& edited) { edited.remove_tets(read_numbers(tets, count, 1, "tets")); });
}

vox_result vox_mesh_append_vertices(vox_grid* grid, vox_body body, const vox_vertices_desc* desc,
                                    uint32_t* out_first) {
    return border(grid, "grid", [&] {
        (void)grid->mesh(body);
        require(out_first, "out_first");
        const vox_vertices_desc vertices = read_struct(desc, "desc");
        if (vertices.reserved != 0)
            refuse(format("desc reserved is %" PRIu32 ", expected 0", vertices.reserved));
        if (vertices.copies_of) (void)read_numbers(vertices.copies_of, vertices.count, 1, "copies_of");
        *out_first = grid->append_vertices(body, vertices);
    });
}

vox_result vox_mesh_remove_vertices(vox_grid* grid, vox_body body, const uint32_t* vertices, uint64_t count) {
    return edit(grid, body, count,
                [&](Mesh& edited) { edited.remove_vertices(read_numbers(vertices, count, 1, "vertices")); });
}
