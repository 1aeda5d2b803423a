#include "suggest.hpp"

#include "cost.hpp"
#include "error.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace vox {

// ---- cost function --------------------------------------------------------------------------------

// Newton's method from the right of the root: 1/4 + cbrt(c/4) is not below it (the left side, x^2 (4x - 1),
// is at least 4 (x - 1/4)^3 there), and on an ascending convex function every step from the right stays on
// the right.
double PaperCost::minimiser() const {
    const double c = 3 * p_nc / k;
    double x = 0.25 + std::cbrt(c / 4);
    for (;;) {
        const double next = x - (x * x * (4 * x - 1) - c) / (x * (12 * x - 2));
        if (!(next < x)) return x; // rounding: no further to go
        x = next;
    }
}

namespace {

// Where the cost passes `limit` on one side of `inside`, found by halving the interval to the last bit;
// `outside` starts at inside * factor and moves on until the cost there is above the limit.
double crossing(double inside, double factor, double limit, const PaperCost& cost) {
    double outside = inside * factor;
    while (cost(outside) <= limit) {
        inside = outside;
        outside *= factor;
    }
    for (;;) {
        const double middle = inside + (outside - inside) / 2;
        if (middle == inside || middle == outside) return inside;
        (cost(middle) <= limit ? inside : outside) = middle;
    }
}

} // namespace

Zone zone_around(double x_best, double limit, const PaperCost& cost) {
    if (!(limit > cost(x_best))) return {x_best, x_best};
    return {crossing(x_best, 0.5, limit, cost), crossing(x_best, 2, limit, cost)};
}

// ---- arguments ------------------------------------------------------------------------------------

namespace {

// The most a zone may lose: keeps every number of the cost function in range.
constexpr double max_zone_loss = 1e6;

template <class Enum>
void check_enum(const Enum& field, std::int32_t last, const char* name) {
    std::int32_t value; // copied as a number: a value outside the enum must not be read as one
    std::memcpy(&value, &field, sizeof value);
    if (value < 0 || value > last)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("suggest %s is %" PRId32 ", expected 0 to %" PRId32, name, value, last));
}

void check_number(bool good, double value, const char* name, const char* expected) {
    if (!good || !std::isfinite(value))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("suggest %s is %.9g, expected %s", name, value, expected));
}

} // namespace

void check_suggest_desc(const vox_suggest_desc& desc) {
    check_enum(desc.model, VOX_COST_MODEL_PAPER, "model");
    check_enum(desc.size_reading, VOX_SIZE_MEAN_BOX_SIDE, "size_reading");
    check_enum(desc.area_reading, VOX_AREA_BOUNDARY_FACETS, "area_reading");
    check_number(desc.p_nc > 0 && desc.p_nc < 1, desc.p_nc, "p_nc",
                 "a number between 0 and 1, both excluded");
    check_number(desc.cost_ratio > 0, desc.cost_ratio, "cost_ratio", "a number above 0");
    check_number(desc.world_edge >= 0, desc.world_edge, "world_edge", "0 or a length");
    check_number(desc.zone_loss >= 0 && desc.zone_loss <= max_zone_loss, desc.zone_loss, "zone_loss",
                 "a number from 0 to 1e6");
    check_number(desc.mean_edge_factor > 0, desc.mean_edge_factor, "mean_edge_factor", "a number above 0");
    check_number(desc.resolution >= 0, desc.resolution, "resolution", "0 or a length");
}

// ---- suggestion -----------------------------------------------------------------------------------

namespace {

struct Reading {
    double value;
    const char* name;
};

Reading tet_size(vox_size_reading reading, const vox_geometry_stats& stats) {
    switch (reading) {
    case VOX_SIZE_MEAN_LONGEST_EDGE:
        return {stats.mean_longest_edge, "mean longest edge"};
    case VOX_SIZE_MEAN_BOX_SIDE:
        return {stats.mean_box_side, "mean box side"};
    default:
        return {stats.mean_edge, "mean edge"};
    }
}

Reading facet_area(vox_area_reading reading, const vox_geometry_stats& stats) {
    switch (reading) {
    case VOX_AREA_TET_FACETS:
        return {stats.mean_tet_facet_area, "mean facet area over tets"};
    case VOX_AREA_BOUNDARY_FACETS:
        return {stats.mean_boundary_facet_area, "mean boundary facet area"};
    default:
        return {stats.mean_facet_area, "mean facet area"};
    }
}

PaperCost paper_cost(const vox_suggest_desc& desc, const Reading& s, const Reading& area,
                     const vox_geometry_stats& stats) {
    if (stats.tets == 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("no tetrahedra: %" PRIu64 " vertices alone give no cell size", stats.vertices));
    if (!(s.value > 0) || !(area.value > 0))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("%" PRIu64 " tets of no size: %s %g, %s %g",
                                                       stats.tets, s.name, s.value, area.name, area.value));
    const double k =
        (1 - desc.p_nc) * desc.cost_ratio * 1.5 * std::sqrt(3.0) * (s.value * s.value / area.value);
    if (!(k >= 1e-290 && k <= 1e290))
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("p_nc %.9g, cost_ratio %g, %s %g and %s %g are beyond the cost model: its k is %g, "
                   "expected 1e-290 to 1e290",
                   desc.p_nc, desc.cost_ratio, s.name, s.value, area.name, area.value, k));
    return {desc.p_nc, k};
}

// References at vox_cell_size_rules.
vox_cell_size_rules other_rules(const vox_suggest_desc& desc, const Geometry& geometry) {
    vox_cell_size_rules rules{};
    rules.mean_edge = geometry.stats.mean_edge;
    rules.mean_edge_multiple = desc.mean_edge_factor * geometry.stats.mean_edge;
    rules.object_512 = geometry.mean_object_side / 8; // 8 * 8 * 8 = 512
    rules.resolution = desc.resolution;
    rules.mean_volume = std::cbrt(geometry.stats.mean_volume);
    rules.median_box_side = geometry.stats.median_box_side;
    return rules;
}

double world_edge(const vox_suggest_desc& desc, const vox_geometry_stats& stats) {
    if (desc.world_edge > 0) return desc.world_edge;
    double edge = 0;
    for (int axis = 0; axis < 3; ++axis)
        edge = std::max(edge, stats.bounds_max[axis] - stats.bounds_min[axis]);
    return edge;
}

} // namespace

vox_suggestion suggest(const vox_suggest_desc& desc, const Geometry& geometry) {
    const Reading s = tet_size(desc.size_reading, geometry.stats);
    const Reading area = facet_area(desc.area_reading, geometry.stats);
    const PaperCost cost = paper_cost(desc, s, area, geometry.stats);
    const double x = cost.minimiser();
    const Zone zone = zone_around(x, (1 + desc.zone_loss) * cost(x), cost);

    vox_suggestion result{};
    result.model = desc.model;
    result.cell_size = x * s.value;
    result.cells_per_axis = world_edge(desc, geometry.stats) / result.cell_size;
    result.zone_min = zone.min * s.value;
    result.zone_max = zone.max * s.value;
    result.predicted_cost = cost(x);
    result.rules = other_rules(desc, geometry);
    result.stats = geometry.stats;

    // From an eighth of the best cell size to eight times it.
    result.curve_count = VOX_COST_CURVE_CAPACITY;
    for (std::uint32_t i = 0; i < result.curve_count; ++i) {
        const double at = x * std::exp2(6.0 * i / (result.curve_count - 1) - 3);
        result.curve[i] = {at * s.value, cost(at)};
    }
    return result;
}

} // namespace vox
