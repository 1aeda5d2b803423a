// vox_cell_size.hpp: vox_cell_size.h for C++20, under the rules of vox.hpp. Every function here stands for the one
// of vox_cell_size.h that its comment names.
#ifndef VOX_VOX_CELL_SIZE_HPP
#define VOX_VOX_CELL_SIZE_HPP

#include <vox/vox.hpp>
#include <vox/vox_cell_size.h>

namespace vox {
// ---- cell size ----------------------------------------------------------------------------------

// vox_grid_suggest_cell_size, with desc null or given
inline vox_suggestion suggest_cell_size(const grid& of) {
    return detail::filled<vox_suggestion>(vox_grid_suggest_cell_size, of.get(), nullptr);
}
inline vox_suggestion suggest_cell_size(const grid& of, const vox_suggest_desc& desc) {
    return detail::filled<vox_suggestion>(vox_grid_suggest_cell_size, of.get(), &desc);
}

// vox_suggest_cell_size
inline vox_suggestion suggest_cell_size(span<const vox_mesh_desc> meshes,
                                        const vox_suggest_desc& desc = vox_default_suggest_desc()) {
    return detail::filled<vox_suggestion>(vox_suggest_cell_size, &desc, meshes.data(), meshes.size());
}

// vox_cost_calibrate
inline vox_cost_weights calibrate() { return detail::filled<vox_cost_weights>(vox_cost_calibrate); }

namespace detail {
// Of a cell size, from the callable of a called_back; NaN ends the search if it has thrown.
template <class F>
double cost_of(double cell_size, void* user) {
    auto& at = *static_cast<called_back<F>*>(user);
    double value = std::numeric_limits<double>::quiet_NaN();
    at.caught.run([&] { value = static_cast<double>(at.call(cell_size)); });
    return value;
}
} // namespace detail

// vox_cost_minimise, for any callable that takes a cell size and returns a number. What it throws ends the search.
template <class F>
requires std::is_invocable_r_v<double, F&, double> vox_cost_minimum minimise(F&& cost, double min, double max,
                                                                             double zone_loss = 0) {
    using callable = std::remove_reference_t<F>;
    detail::called_back<callable> with{cost};
    vox_cost_minimum minimum = detail::sized<vox_cost_minimum>();
    const vox_result result = vox_cost_minimise(detail::cost_of<callable>, &with, min, max, zone_loss, &minimum);
    with.caught.rethrow();
    detail::check(result);
    return minimum;
}

// ---- the cell size of any grid ------------------------------------------------------------------

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

// vox_foreign_grid_set_known, of a vox_foreign_grid of primitives, which it borrows. Its other fields are the caller's
// to set.
inline vox_foreign_grid foreign_grid(const vox_primitives& held, vox_known_grid known = VOX_KNOWN_GRID_ANY) {
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.held = &held;
    detail::check(vox_foreign_grid_set_known(&grid, known));
    return grid;
}
vox_foreign_grid foreign_grid(const vox_primitives&& temporary, vox_known_grid = VOX_KNOWN_GRID_ANY) = delete;

// vox_suggest_for
inline vox_foreign_suggestion suggest_for(const vox_foreign_grid& grid) {
    return detail::filled<vox_foreign_suggestion>(vox_suggest_for, &grid);
}

// vox_count_for
inline vox_grid_work count_for(const vox_foreign_grid& grid, double cell_size) {
    return detail::filled<vox_grid_work>(vox_count_for, &grid, cell_size);
}

// vox_cost_fit
inline vox_grid_fit cost_fit(const vox_foreign_grid& grid, span<const vox_grid_timing> timings) {
    return detail::filled<vox_grid_fit>(vox_cost_fit, &grid, timings.data(), timings.size());
}

// vox_cost_tune, for any callable that takes a cell size and returns seconds. What it throws ends the runs. Without a
// description, by a null pointer, nothing is known of the grid.
template <class F>
requires std::is_invocable_r_v<double, F&, double>
    vox_tuning cost_tune(const vox_foreign_grid* grid, F&& run, const vox_tune_desc& desc = vox_default_tune_desc()) {
    using callable = std::remove_reference_t<F>;
    detail::called_back<callable> with{run};
    vox_tuning tuning = detail::sized<vox_tuning>();
    const vox_result result = vox_cost_tune(grid, &desc, detail::cost_of<callable>, &with, &tuning);
    with.caught.rethrow();
    detail::check(result);
    return tuning;
}

// The curve of a suggestion, fit, tuning or vox_cost_minimum; the terms of a suggestion; the runs of
// a vox_tuning.
template <class S>
span<const vox_cost_sample> curve(const S& of) {
    return {of.curve, of.curve_count};
}
template <class S>
span<const vox_cost_share> terms(const S& of) {
    return {of.terms, of.term_count};
}
inline span<const vox_grid_timing> runs(const vox_tuning& of) { return {of.runs, of.run_count}; }
template <class S>
void curve(const S&& temporary) = delete;
template <class S>
void terms(const S&& temporary) = delete;
void runs(const vox_tuning&& temporary) = delete;

} // namespace vox

#endif
