// The C border of vox.h's cell-size section.

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

#if defined(VOX_WITHOUT_SURFACE_CONTACTS)
constexpr bool has_surfaces = false;
#else
constexpr bool has_surfaces = true;
#endif

vox_suggest_desc read_suggest_desc(const vox_suggest_desc* desc, const vox_grid* grid = nullptr) {
    vox_suggest_desc settings{};
    if (desc) settings = read_struct(desc, "vox_suggest_desc");
    if (grid) grid->describe(settings, desc != nullptr);
    check_suggest_desc(settings);
    if (!has_surfaces && settings.model == VOX_COST_MODEL_SURFACE)
        throw Error(VOX_ERROR_UNSUPPORTED, "this build has no surfaces");
    check_allocator(settings.allocator, "desc.allocator");
    return settings;
}

// Reads the caller's array, whose elements are as far apart as the caller's own vox_mesh_desc is large. A
// model is to look at samples of the bodies.
void read_bodies(const vox_mesh_desc* meshes, std::uint64_t count, vox_cost_model model,
                 CellSizeScene& scene) {
    simd::require_instructions();
    Array<Body>& bodies = scene.bodies;
    if (count == 0) return;
    require(meshes, "meshes");
    if (count > VOX_MAX_BODIES)
        throw Error(VOX_ERROR_LIMIT,
                    format("mesh_count is %" PRIu64 ", the limit is %u", count, VOX_MAX_BODIES));
    check_out_struct(meshes, "meshes[0]");
    const std::uint32_t stride = meshes->struct_size;
    if (stride % alignof(vox_mesh_desc) != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("meshes[0].struct_size is %u, expected a multiple of %zu", stride,
                           alignof(vox_mesh_desc)));
    bodies.reserve(static_cast<std::size_t>(count));
    std::uint64_t tets = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto* element = reinterpret_cast<const vox_mesh_desc*>(
            reinterpret_cast<const std::byte*>(meshes) + std::size_t{i} * stride);
        if (element->struct_size != stride)
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("meshes[%u].struct_size is %u, that of meshes[0] is %u", i,
                               element->struct_size, stride));
        const vox_mesh_desc desc = read_struct(element, "mesh");
        Body named; // a mesh of an array: it has no slot
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

vox_cost_bounds read_bounds(const vox_cost_bounds* bounds) {
    vox_cost_bounds read = read_struct(bounds, "bounds");
    set_default(read.zone_loss, default_zone_loss);
    return read;
}

// Whether the surfaces of the meshes are what is asked about.
bool is_of_surfaces(const vox_suggest_desc& settings) {
    return has_surfaces && settings.model == VOX_COST_MODEL_SURFACE;
}

vox_suggestion suggestion(const vox_suggest_desc& settings, CellSizeScene& scene) {
    return is_of_surfaces(settings) ? suggest_for_surfaces(settings, scene)
                                    : suggest(settings, scene, weights_in_use());
}

void check_cells(double cells, const char* name) {
    if (!(cells > 0) || !std::isfinite(cells))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("%s is %.9g, expected a number above 0", name, cells));
}

} // namespace

vox_result vox_suggest_cell_size(const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                 uint64_t mesh_count, vox_suggestion* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings = read_suggest_desc(desc);
        CallerMemory memory(settings.allocator);
        CellSizeScene scene(&memory);
        read_bodies(meshes, mesh_count, settings.model, scene);
        write_struct(out, suggestion(settings, scene), "out");
    });
}

vox_result vox_grid_suggest_cell_size(const vox_grid* grid, const vox_suggest_desc* desc,
                                      vox_suggestion* out) {
    return border(grid, "grid", [&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings = read_suggest_desc(desc, grid);
        CallerMemory caller(settings.allocator);
        Scratch<std::size_t{1} << 16> memory(&caller); // enough for a small scene
        CellSizeScene scene(&memory);
        grid->describe(scene);
        write_struct(out, suggestion(settings, scene), "out");
    });
}

vox_result vox_cost_predict(const vox_suggest_desc* desc, const vox_mesh_desc* meshes, uint64_t mesh_count,
                            double cell_size, vox_cost_prediction* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings = read_suggest_desc(desc);
        check_cells(cell_size, "cell_size");
        CallerMemory memory(settings.allocator);
        CellSizeScene scene(&memory);
        read_bodies(meshes, mesh_count, settings.model, scene);
        write_struct(out,
                     is_of_surfaces(settings) ? predict_for_surfaces(settings, scene, cell_size)
                                              : predict(settings, scene, weights_in_use(), cell_size),
                     "out");
    });
}

vox_result vox_cost_calibrate(vox_cost_weights* out) {
    return border([&] {
        if (out) check_out_struct(out, "out");
        simd::require_instructions();
        use_weights(measured_weights());
        if (out) write_struct(out, measured_weights(), "out");
    });
}

vox_result vox_cost_get_weights(vox_cost_weights* out) {
    return border([&] { write_struct(out, weights_in_use(), "out"); });
}

vox_result vox_cost_set_weights(const vox_cost_weights* weights) {
    return border([&] { use_weights(read_weights(weights)); });
}

vox_result vox_cost_minimise(vox_cost_function* cost, void* user, const vox_cost_bounds* bounds,
                             vox_cost_minimum* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (!cost) throw Error(VOX_ERROR_INVALID_ARGUMENT, "cost is null");
        write_struct(
            out,
            minimise_within([&](double cell_size) { return cost(cell_size, user); }, read_bounds(bounds)),
            "out");
    });
}

vox_result vox_cost_minimise_terms(const vox_cost_term* terms, uint64_t term_count,
                                   const vox_cost_bounds* bounds, vox_cost_minimum* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (term_count > 0) require(terms, "terms");
        for (std::uint64_t i = 0; i < term_count; ++i)
            if (!std::isfinite(terms[i].coefficient) || !std::isfinite(terms[i].power))
                throw Error(VOX_ERROR_INVALID_ARGUMENT, format("term %" PRIu64 " is %g * size^%g", i,
                                                               terms[i].coefficient, terms[i].power));
        const auto sum = [&](double cell_size) {
            double cost = 0;
            for (std::uint64_t i = 0; i < term_count; ++i)
                cost += terms[i].coefficient * std::pow(cell_size, terms[i].power);
            return cost;
        };
        write_struct(out, minimise_within(sum, read_bounds(bounds)), "out");
    });
}

vox_result vox_zone_distance(double n, double n_min, double n_opt, double n_max, double* out_epsilon) {
    return border([&] {
        require(out_epsilon, "out_epsilon");
        check_cells(n, "n");
        check_cells(n_min, "n_min");
        check_cells(n_opt, "n_opt");
        check_cells(n_max, "n_max");
        if (!(n_min <= n_opt && n_opt <= n_max))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("n_min %.9g, n_opt %.9g, n_max %.9g: expected in ascending order", n_min,
                               n_opt, n_max));
        *out_epsilon = zone_distance(n, n_min, n_opt, n_max);
    });
}
