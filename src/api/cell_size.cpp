// The C border of vox_cell_size.h: cell sizes for meshes and for any cost function.

#include "base/array.hpp"
#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/scratch.hpp"
#include "base/simd.hpp"
#include "base/structs.hpp"
#include "cell_size/paper_model.hpp"
#include "cell_size/search.hpp"
#include "cell_size/suggest.hpp"
#include "cell_size/weights.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"
#include "surface/suggest.hpp"

#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <memory_resource>

using namespace vox;

namespace {

#if defined(VOX_WITHOUT_SURFACES)
constexpr bool has_surfaces = false;
#else
constexpr bool has_surfaces = true;
#endif

vox_cell_size_desc read_suggest_desc(const vox_cell_size_desc* desc, const vox_grid* grid = nullptr) {
    vox_cell_size_desc settings{};
    if (desc) settings = read_struct(desc, "desc");
    if (grid) grid->describe(settings, desc != nullptr);
    check_suggest_desc(settings);
    if (!has_surfaces && settings.model == VOX_COST_MODEL_SURFACE)
        throw Error(VOX_ERROR_UNSUPPORTED, "this build has no surfaces");
    check_allocator(settings.allocator, "desc.allocator");
    return settings;
}

// Reads the caller's array; its stride is the size of the caller's vox_mesh_desc. Sets the model's sampling
// budget.
void read_bodies(const vox_mesh_desc* meshes, std::uint64_t count, vox_cost_model model,
                 CellSizeScene& scene) {
    simd::require_instructions();
    Array<Body>& bodies = scene.bodies;
    if (count == 0) return;
    require(meshes, "meshes");
    check_limit(count, VOX_MAX_BODIES, "mesh_count");
    check_out_struct(meshes, "meshes[0]");
    const std::uint32_t stride = meshes->struct_size;
    if (stride % alignof(vox_mesh_desc) != 0)
        refuse(format("meshes[0].struct_size is %u, expected a multiple of %zu", stride,
                      alignof(vox_mesh_desc)));
    bodies.reserve(static_cast<std::size_t>(count));
    std::uint64_t tets = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto* element = reinterpret_cast<const vox_mesh_desc*>(
            reinterpret_cast<const std::byte*>(meshes) + std::size_t{i} * stride);
        if (element->struct_size != stride)
            refuse(format("meshes[%u].struct_size is %u, that of meshes[0] is %u", i, element->struct_size,
                          stride));
        const vox_mesh_desc desc = read_struct(element, "mesh");
        Body named; // for errors: a mesh of an array, which has no slot
        named.mesh_id = i;
        named.user_data = desc.user_data;
        Body body = check_mesh(desc, (name_of(named) + ": ").c_str(), NullPositions::rejected);
        body.mesh_id = i;
        check_not_doubles(body);
        bodies.push_back(body);
        tets += body.tets.size();
    }
    scene.budget = usual(model, tets);
}

// `usual` are the weights if the settings have none.
vox_cell_size_result suggestion(const vox_cell_size_desc& settings, CellSizeScene& scene,
                                const CostWeights& usual) {
    return has_surfaces && settings.model == VOX_COST_MODEL_SURFACE
               ? suggest_for_surfaces(settings, scene)
               : suggest(settings, scene, settings.weights ? read_weights(settings.weights) : usual);
}

} // namespace

vox_result vox_suggest_cell_size(const vox_cell_size_desc* desc, const vox_mesh_desc* meshes,
                                 uint64_t mesh_count, vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_cell_size_desc settings = read_suggest_desc(desc);
        CallerMemory memory(settings.allocator);
        CellSizeScene scene(&memory);
        read_bodies(meshes, mesh_count, settings.model, scene);
        write_struct(out, suggestion(settings, scene, shipped_weights), "out");
    });
}

vox_result vox_grid_suggest_cell_size(const vox_grid* grid, const vox_cell_size_desc* desc,
                                      vox_cell_size_result* out) {
    return border(grid, "grid", [&] {
        check_out_struct(out, "out");
        const vox_cell_size_desc settings = read_suggest_desc(desc, grid);
        CallerMemory caller(settings.allocator);
        Scratch<std::size_t{1} << 16> memory(&caller); // enough for a small scene
        CellSizeScene scene(&memory);
        grid->describe(scene);
        write_struct(out, suggestion(settings, scene, grid->weights()), "out");
    });
}

vox_result vox_measure_geometry(const vox_mesh_desc* meshes, uint64_t mesh_count, vox_geometry* out) {
    return border([&] {
        check_out_struct(out, "out");
        CallerMemory memory(nullptr);
        CellSizeScene scene(&memory);
        read_bodies(meshes, mesh_count, VOX_COST_MODEL_PAPER, scene);
        scene.prepare(VOX_COST_MODEL_PAPER);
        write_struct(out, scene.geometry.stats, "out");
    });
}

vox_result vox_cost_calibrate(vox_cost_weights* out) {
    return border([&] {
        check_out_struct(out, "out");
        simd::require_instructions();
        vox_cost_weights weights = as_given(measured_weights());
        weights.measured = 1;
        write_struct(out, weights, "out");
    });
}

vox_result vox_cost_minimise(vox_cost_function* cost, void* user, double min, double max, double zone_loss,
                             vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (!cost) refuse("cost is null");
        set_default(zone_loss, default_zone_loss);
        write_struct(
            out,
            minimise_within([&](double cell_size) { return cost(cell_size, user); }, {min, max}, zone_loss),
            "out");
    });
}
