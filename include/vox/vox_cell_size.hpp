// vox_cell_size.hpp: vox_cell_size.h for C++20, under the rules of vox.hpp. Every function here stands for the one
// of vox_cell_size.h that its comment names.
#ifndef VOX_VOX_CELL_SIZE_HPP
#define VOX_VOX_CELL_SIZE_HPP

#include <vox/vox.hpp>
#include <vox/vox_cell_size.h>

#include <limits>

namespace vox {
// ---- results ------------------------------------------------------------------------------------

// The arrays of a result.
inline span<const vox_cost_sample> curve(const vox_cell_size_result& of) { return {of.curve, of.curve_count}; }
inline span<const vox_cost_term> terms(const vox_cell_size_result& of) { return {of.terms, of.term_count}; }
inline span<const vox_cell_size_rule> rules(const vox_cell_size_result& of) { return {of.rules, of.rule_count}; }
inline span<const vox_timing> timings(const vox_cell_size_result& of) { return {of.timings, of.timing_count}; }
void curve(const vox_cell_size_result&& temporary) = delete;
void terms(const vox_cell_size_result&& temporary) = delete;
void rules(const vox_cell_size_result&& temporary) = delete;
void timings(const vox_cell_size_result&& temporary) = delete;

// ---- meshes -------------------------------------------------------------------------------------

// vox_grid_suggest_cell_size, with desc null or given
inline vox_cell_size_result suggest_cell_size(const grid& of) {
    return detail::filled<vox_cell_size_result>(vox_grid_suggest_cell_size, of.get(), nullptr);
}
inline vox_cell_size_result suggest_cell_size(const grid& of, const vox_cell_size_desc& desc) {
    return detail::filled<vox_cell_size_result>(vox_grid_suggest_cell_size, of.get(), &desc);
}

// vox_suggest_cell_size
inline vox_cell_size_result suggest_cell_size(span<const vox_mesh_desc> meshes,
                                              const vox_cell_size_desc& desc = vox_default_cell_size_desc()) {
    return detail::filled<vox_cell_size_result>(vox_suggest_cell_size, &desc, meshes.data(), meshes.size());
}

// vox_measure_geometry
inline vox_geometry measure_geometry(span<const vox_mesh_desc> meshes) {
    return detail::filled<vox_geometry>(vox_measure_geometry, meshes.data(), meshes.size());
}

// vox_cost_calibrate
inline vox_cost_weights calibrate() { return detail::filled<vox_cost_weights>(vox_cost_calibrate); }

// ---- any algorithm ------------------------------------------------------------------------------

namespace detail {
// What `search` finds by calling `f`, which takes a cell size and returns a number. What `f` throws ends the search.
template <class F, class S>
vox_cell_size_result searched(F& f, S&& search) {
    called_back<F> with{f};
    const auto number = [](double cell_size, void* user) {
        auto& at = *static_cast<called_back<F>*>(user);
        double value = std::numeric_limits<double>::quiet_NaN();
        at.caught.run([&] { value = static_cast<double>(at.call(cell_size)); });
        return value;
    };
    vox_cell_size_result found = sized<vox_cell_size_result>();
    const vox_result result = search(number, &with, &found);
    with.caught.rethrow();
    check(result);
    return found;
}
} // namespace detail

// vox_cost_minimise, for any callable that takes a cell size and returns a number
template <class F>
requires std::is_invocable_r_v<double, F&, double> vox_cell_size_result minimise(F&& cost, double min, double max,
                                                                                 double zone_loss = 0) {
    return detail::searched(cost, [&](vox_cost_function* call, void* user, vox_cell_size_result* out) {
        return vox_cost_minimise(call, user, min, max, zone_loss, out);
    });
}

// ---- other uniform grids ------------------------------------------------------------------------

// A vox_primitives of arrays, which it borrows. Radii are the caller's to set; without indices the vertices of a
// primitive follow each other.
inline vox_primitives primitives(vox_primitive_type type, const borrowed_points& positions,
                                 const borrowed_indices& indices = {}) {
    constexpr std::uint64_t widths[] = {1, 2, 3, 4, 2};
    const std::uint64_t size = indices.given ? indices.size : positions.count,
                        width = static_cast<std::size_t>(type) < std::size(widths) ? widths[type] : 1;
    vox_primitives described = vox_default_primitives();
    described.type = type;
    described.positions = positions;
    described.indices = indices.data;
    described.count = size / width;
    if (indices.each != 1 && indices.each != width)
        detail::refuse("indices: %llu for each primitive, expected %llu", indices.each, width);
    if (size % width != 0) detail::refuse("primitives: %llu vertices are not %llu for each", size, width);
    return described;
}

// A vox_foreign_grid of primitives, which it borrows. Its other fields are the caller's to set.
inline vox_foreign_grid foreign_grid(const vox_primitives& stored, vox_known_grid known = VOX_KNOWN_GRID_NONE) {
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.stored = &stored;
    grid.known = known;
    return grid;
}
vox_foreign_grid foreign_grid(const vox_primitives&& temporary, vox_known_grid = VOX_KNOWN_GRID_NONE) = delete;

// vox_foreign_grid_suggest
inline vox_cell_size_result foreign_grid_suggest(const vox_foreign_grid& grid) {
    return detail::filled<vox_cell_size_result>(vox_foreign_grid_suggest, &grid);
}

// vox_foreign_grid_count
inline vox_foreign_counts foreign_grid_count(const vox_foreign_grid& grid, double cell_size) {
    return detail::filled<vox_foreign_counts>(vox_foreign_grid_count, &grid, cell_size);
}

// vox_foreign_grid_fit
inline vox_cell_size_result foreign_grid_fit(const vox_foreign_grid& grid, span<const vox_timing> timings) {
    return detail::filled<vox_cell_size_result>(vox_foreign_grid_fit, &grid, timings.data(), timings.size());
}

// vox_foreign_grid_tune, for any callable that takes a cell size and returns seconds. A null `grid` is one without a
// description.
template <class F>
requires std::is_invocable_r_v<double, F&, double> vox_cell_size_result
foreign_grid_tune(const vox_foreign_grid* grid, F&& run, const vox_tune_desc& desc = vox_default_tune_desc()) {
    return detail::searched(run, [&](vox_foreign_run* call, void* user, vox_cell_size_result* out) {
        return vox_foreign_grid_tune(grid, &desc, call, user, out);
    });
}

} // namespace vox

#endif
