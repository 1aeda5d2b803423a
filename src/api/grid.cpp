// The C border of the core: read the caller's structs, forward to the grid, nothing else.

#include "grid/grid.hpp"
#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/memory.hpp"
#include "base/scheduler.hpp"
#include "base/simd.hpp"
#include "base/structs.hpp"
#include "mesh/check.hpp"
#include "mesh/filter.hpp"
#include "mesh/ids.hpp"
#include "shape/shape.hpp"

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <span>

using namespace vox;

#define VOX_STRING_(x) #x
#define VOX_STRING(x) VOX_STRING_(x)

// ---- version --------------------------------------------------------------------------------------

uint32_t vox_version(void) {
    return VOX_VERSION_MAJOR * 1000000u + VOX_VERSION_MINOR * 1000u + VOX_VERSION_PATCH;
}

uint32_t vox_abi_version(void) { return VOX_ABI_VERSION; }

const char* vox_build_info(void) {
    // clang-format off
    return "vox " VOX_STRING(VOX_VERSION_MAJOR) "." VOX_STRING(VOX_VERSION_MINOR)
        "." VOX_STRING(VOX_VERSION_PATCH)
#if defined(__clang__)
        ", clang " VOX_STRING(__clang_major__) "." VOX_STRING(__clang_minor__)
        "." VOX_STRING(__clang_patchlevel__)
#elif defined(__GNUC__)
        ", gcc " __VERSION__
#elif defined(_MSC_VER)
        ", msvc " VOX_STRING(_MSC_FULL_VER)
#endif
        ", C++ " VOX_STRING(__cplusplus)
#if defined(__MINGW32__) && !defined(__clang__) && !defined(VOX_UNALIGNED_MOVES)
        ", SIMD SSE4" // base/simd.hpp
#elif defined(__x86_64__) || defined(_M_X64)
        ", SIMD SSE4 AVX2 AVX-512"
#elif defined(__aarch64__)
        ", SIMD NEON"
#elif defined(__wasm_simd128__)
        ", SIMD 128"
#endif
        ", " VOX_SCHEDULER
#if defined(NDEBUG)
        ", release"
#else
        ", debug"
#endif
        ;
    // clang-format on
}

// ---- grid -----------------------------------------------------------------------------------------

vox_result vox_grid_create(const vox_grid_desc* desc, vox_grid** out_grid) {
    return border([&] {
        require(out_grid, "out_grid");
        simd::require_instructions();
        vox_grid_desc settings = desc ? read_struct(desc, "desc") : vox_default_grid_desc();
        settings.byte_budget = byte_limit(settings.byte_budget);
        check_grid_desc(settings);
        constexpr std::size_t least = sizeof(GridMemory) + sizeof(vox_grid);
        if (settings.byte_budget < least)
            throw Error(VOX_ERROR_BUDGET, format("an empty grid needs %zu bytes, its byte budget is %llu",
                                                 least, llu(settings.byte_budget)));
        const MemoryShare memory(settings.allocator, settings.byte_budget);
        std::pmr::polymorphic_allocator<> allocator(&*memory);
        *out_grid = allocator.new_object<vox_grid>(settings, memory);
    });
}

void vox_grid_destroy(vox_grid* grid) {
    if (!grid) return;
    const MemoryShare memory = grid->memory();
    std::pmr::polymorphic_allocator<> allocator(&*memory);
    allocator.delete_object(grid);
}

vox_result vox_grid_clear(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->clear(); });
}

vox_result vox_grid_reserve(vox_grid* grid, uint32_t mesh_count, uint64_t contact_count) {
    return border(grid, "grid", [&] { grid->reserve(mesh_count, contact_count); });
}

vox_result vox_grid_prepare(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->prepare_meshes(); });
}

vox_result vox_grid_set_cell_size(vox_grid* grid, double cell_size) {
    return border(grid, "grid", [&] { grid->set_cell_size(cell_size); });
}

vox_result vox_grid_set_worker_count(vox_grid* grid, uint32_t worker_count) {
    return border(grid, "grid", [&] { grid->set_worker_count(worker_count); });
}

vox_result vox_grid_set_flags(vox_grid* grid, uint32_t flags) {
    return border(grid, "grid", [&] { grid->set_flags(flags); });
}

vox_result vox_grid_set_margin(vox_grid* grid, double margin) {
    return border(grid, "grid", [&] { grid->set_margin(margin); });
}

vox_result vox_grid_get_info(const vox_grid* grid, vox_grid_info* out_info) {
    return border(grid, "grid", [&] { write_struct(out_info, grid->info(), "out_info"); });
}

// ---- meshes ---------------------------------------------------------------------------------------

vox_result vox_mesh_insert(vox_grid* grid, const vox_mesh_desc* desc, vox_body* out_body) {
    return border(grid, "grid", [&] {
        require(out_body, "out_body");
        const vox_mesh_desc settings = read_struct(desc, "desc");
        const Body view = check_mesh(settings, "", NullPositions::allowed);
        *out_body = grid->insert(settings, view, checked_filter(settings.filter));
    });
}

vox_result vox_shape_insert(vox_grid* grid, const vox_shape_desc* desc, vox_body* out_body) {
    return border(grid, "grid", [&] {
        require(out_body, "out_body");
        const vox_shape_desc settings = read_struct(desc, "desc");
        *out_body = grid->insert_shape(settings, checked_filter(settings.filter));
    });
}

vox_result vox_shape_set_previous_transform(vox_grid* grid, vox_body body, const double matrix[12]) {
    return border(grid, "grid", [&] { grid->set_previous_transform(body, matrix); });
}

vox_result vox_body_remove(vox_grid* grid, vox_body body) {
    return border(grid, "grid", [&] { grid->remove(body); });
}

uint32_t vox_body_is_valid(const vox_grid* grid, vox_body body) {
    return grid && grid->is_valid(body) ? 1u : 0u;
}

vox_result vox_body_get_user_data(const vox_grid* grid, vox_body body, uint64_t* out_user_data) {
    return border(grid, "grid", out_user_data, "out_user_data", [&] { return grid->body(body).user_data(); });
}

vox_result vox_grid_get_bodies(const vox_grid* grid, vox_body* bodies, uint64_t capacity,
                               uint64_t* out_count) {
    return border(grid, "grid", out_count, "out_count", [&] {
        if (capacity > 0) require(bodies, "bodies");
        std::uint64_t count = 0;
        grid->meshes().for_each([&](vox_body id, const MeshSlot&) {
            if (count < capacity) bodies[count] = id;
            ++count;
        });
        return count;
    });
}

vox_result vox_body_get_info(const vox_grid* grid, vox_body body, vox_body_info* out_info) {
    return border(grid, "grid", [&] {
        const Mesh& from = grid->body(body);
        vox_body_info info = from.info();
        if (from.shape()) info.shape = static_cast<std::uint32_t>(from.shape()->kind());
        write_struct(out_info, info, "out_info");
    });
}

vox_result vox_mesh_get_tets(const vox_grid* grid, vox_body body, uint32_t* corners, uint8_t* enabled,
                             uint64_t capacity, uint64_t* out_count) {
    return border(grid, "grid", out_count, "out_count", [&] {
        const Mesh& from = grid->mesh(body);
        const std::uint64_t count = std::min(capacity, from.tet_count());
        for (std::uint32_t t = 0; t < count; ++t) {
            if (corners) std::copy_n(from.given(t).v, 4, corners + 4 * std::size_t{t});
            if (enabled) enabled[t] = from.is_off(t) ? 0 : 1;
        }
        return from.tet_count();
    });
}

vox_result vox_mesh_bind_positions(vox_grid* grid, vox_body body, const vox_positions* positions) {
    return border(grid, "grid", [&] {
        require(positions, "positions");
        Mesh& target = grid->mesh(body);
        if (target.vertex_count() > 0) require(positions->data, "positions.data");
        target.bind(check_positions_of(target.vertex_count(), *positions, "positions"));
    });
}

vox_result vox_mesh_map_positions(vox_grid* grid, vox_body body, void** out_positions) {
    return border(grid, "grid", out_positions, "out_positions",
                  [&] { return grid->mesh(body).map_positions(); });
}

vox_result vox_body_set_transform(vox_grid* grid, vox_body body, const double matrix[12]) {
    return border(grid, "grid", [&] { grid->set_transform(body, matrix); });
}

vox_result vox_body_mark_moved(vox_grid* grid, vox_body body) {
    return border(grid, "grid", [&] { grid->mark_moved(body); });
}

vox_result vox_mesh_bind_previous_positions(vox_grid* grid, vox_body body, const vox_positions* positions) {
    return border(grid, "grid", [&] {
        const std::uint32_t vertices = grid->mesh(body).vertex_count();
        grid->bind_previous(body, positions && positions->data
                                      ? check_positions_of(vertices, *positions, "positions")
                                      : Positions{});
    });
}

vox_result vox_body_set_filter(vox_grid* grid, vox_body body, const vox_filter* filter) {
    return border(grid, "grid", [&] {
        require(filter, "filter");
        grid->set_filter(body, checked_filter(*filter));
    });
}

vox_result vox_body_set_enabled(vox_grid* grid, vox_body body, uint32_t enabled) {
    return border(grid, "grid", [&] { grid->set_enabled(body, read_bool(enabled, "enabled")); });
}

vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_body body_a, vox_body body_b, uint32_t enabled) {
    return border(grid, "grid",
                  [&] { grid->set_pair_enabled(body_a, body_b, read_bool(enabled, "enabled")); });
}

// ---- step and results -----------------------------------------------------------------------------

vox_result vox_grid_step(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->step(); });
}

vox_result vox_grid_get_contacts(const vox_grid* grid, vox_contact_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->contacts(); });
}

vox_result vox_grid_get_failure(const vox_grid* grid, uint32_t index, vox_failure* out_failure) {
    return border(grid, "grid", [&] { write_struct(out_failure, grid->failure(index), "out_failure"); });
}

vox_result vox_grid_get_hash(const vox_grid* grid, uint64_t* out_hash) {
    return border(grid, "grid", out_hash, "out_hash", [&] { return grid->hash(); });
}

vox_result vox_grid_get_counters(const vox_grid* grid, vox_counter_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->counters(); });
}

vox_result vox_grid_get_pairs(const vox_grid* grid, vox_pair_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_pair_view {
        const std::span<const vox_pair> pairs = grid->pairs().all();
        return {pairs.data(), pairs.size(), grid->pairs().contacts()};
    });
}

vox_result vox_grid_find_constraints(vox_grid* grid, const vox_constraint_desc* desc) {
    return border(grid, "grid",
                  [&] { grid->find_constraints(desc ? read_struct(desc, "desc") : vox_constraint_desc{}); });
}

vox_result vox_grid_get_constraints(const vox_grid* grid, vox_constraint_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->constraints(); });
}
