#include "cell_size/suggest.hpp"

#include "base/error.hpp"
#include "cell_size/cost_table.hpp"
#include "cell_size/fast_model.hpp"
#include "cell_size/levels.hpp"
#include "cell_size/paper_model.hpp"
#include "cell_size/reference_model.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vox {

// ---- cost function --------------------------------------------------------------------------------

// Newton's method from the right of the root: 1/4 + cbrt(c/4) is not below it (the left side, x^2 (4x - 1),
// is at least 4 (x - 1/4)^3 there), and on an ascending convex function every step from the right stays on
// the right.
double PaperModel::minimiser() const {
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
double crossing(double inside, double factor, double limit, const PaperModel& cost) {
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

Zone zone_around(double x_best, double limit, const PaperModel& cost) {
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
    check_enum(desc.model, VOX_COST_MODEL_FAST, "model");
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
    check_enum(desc.storage, VOX_STORAGE_DENSE, "storage");
    if (desc.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("suggest reserved is %" PRIu32 ", expected 0", desc.reserved));
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

PaperModel paper_cost(const vox_suggest_desc& desc, const Reading& s, const Reading& area,
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

void write_shares(const CostTerms& terms, vox_cost_share (&out)[VOX_COST_TERM_CAPACITY],
                  std::uint32_t& count) {
    const double cost = terms.cost();
    count = 0;
    for (const CostTerm& term : terms) {
        vox_cost_share& share = out[count++];
        const std::size_t length = std::min(std::strlen(term.name), sizeof share.name - 1);
        *std::copy_n(term.name, length, share.name) = '\0';
        share.count = term.count;
        share.cost = term.count * term.weight;
        share.share = cost > 0 ? share.cost / cost : 0;
    }
}

namespace {

// What is the same for all models, at their cell size and for their cost function.
void explain(vox_suggestion& result, const vox_suggest_desc& desc, const Geometry& geometry,
             const CostFunction& cost, const CostTerms& terms) {
    result.model = desc.model;
    result.cells_per_axis = world_edge(desc, geometry.stats) / result.cell_size;
    result.rules = other_rules(desc, geometry);
    result.stats = geometry.stats;
    const auto cost_of = [&](double cell_size) { return cell_size > 0 ? cost(cell_size) : 0; };
    result.rule_costs = {cost_of(result.rules.mean_edge),   cost_of(result.rules.mean_edge_multiple),
                         cost_of(result.rules.object_512),  cost_of(result.rules.resolution),
                         cost_of(result.rules.mean_volume), cost_of(result.rules.median_box_side)};
    write_shares(terms, result.terms, result.term_count);
}

constexpr double curve_octaves = 6; // from an eighth of the best cell size to eight times it

double curve_begin(const vox_suggestion& result) { return result.cell_size * std::exp2(-curve_octaves / 2); }

void draw(vox_suggestion& result, const CostFunction& cost) {
    result.curve_count = VOX_COST_CURVE_CAPACITY;
    const double last = result.curve_count - 1;
    for (std::uint32_t i = 0; i < result.curve_count; ++i) {
        const double at = curve_begin(result) * std::exp2(curve_octaves * i / last);
        result.curve[i] = {at, cost(at)};
    }
}

struct Paper {
    Reading s;
    PaperModel cost;
};

Paper paper_model(const vox_suggest_desc& desc, const vox_geometry_stats& stats) {
    const Reading s = tet_size(desc.size_reading, stats), area = facet_area(desc.area_reading, stats);
    return {s, paper_cost(desc, s, area, stats)};
}

CostTerms paper_terms(const vox_suggest_desc& desc, const Paper& paper, double cell_size) {
    const double x = cell_size / paper.s.value, side = 1 / x + 2, voxels = side * side * side;
    CostTerms terms;
    terms.add("visit a cell", desc.p_nc * voxels, 1);
    terms.add("test a particle", voxels * paper.cost.k * x * x / desc.cost_ratio, desc.cost_ratio);
    return terms;
}

vox_suggestion suggest_paper(const vox_suggest_desc& desc, const Geometry& geometry) {
    const Paper paper = paper_model(desc, geometry.stats);
    const double s = paper.s.value, x = paper.cost.minimiser();
    const Zone zone = zone_around(x, (1 + desc.zone_loss) * paper.cost(x), paper.cost);
    vox_suggestion result{};
    result.cell_size = x * s;
    result.zone_min = zone.min * s;
    result.zone_max = zone.max * s;
    result.predicted_cost = paper.cost(x);
    const CostFunction cost = [&](double d) { return paper.cost(d / s); };
    explain(result, desc, geometry, cost, paper_terms(desc, paper, result.cell_size));
    draw(result, cost);
    return result;
}

[[noreturn]] void throw_no_size(const vox_geometry_stats& stats) {
    throw Error(
        VOX_ERROR_INVALID_ARGUMENT,
        stats.tets == 0
            ? format("no tetrahedra: %" PRIu64 " vertices alone give no cell size", stats.vertices)
            : format("%" PRIu64 " tets of no size: mean box side %g", stats.tets, stats.mean_box_side));
}

constexpr double near = 1e-4; // no model is as good as that

void write_minimum(vox_suggestion& result, const CostMinimum& best, const Zone& zone) {
    result.cell_size = best.cell_size;
    result.predicted_cost = best.cost;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
}

void minimise_into(vox_suggestion& result, const vox_suggest_desc& desc, const CostFunction& cost,
                   CostTable* table, const CellSizeRange& range) {
    const CostMinimum best = table ? table->minimum() : minimise(cost, range, {.tolerance = near});
    const double limit = (1 + desc.zone_loss) * best.cost;
    write_minimum(result, best, table ? table->zone(best, limit) : zone_around(best, limit, cost, range));
}

// What the rest of a suggestion says about the cell size in it. Costs are those of the table where there is
// one; between its nodes it may be a little below the least cost.
void explain_model(vox_suggestion& result, const vox_suggest_desc& desc, const Geometry& geometry,
                   const CostFunction& cost, CostTable* table, const CostTerms& terms) {
    const CostFunction tabulated = [&](double d) { return std::max((*table)(d), result.predicted_cost); };
    explain(result, desc, geometry, table ? tabulated : cost, terms);
    if (!table) return draw(result, cost);
    result.curve_count = VOX_COST_CURVE_CAPACITY;
    table->sample(curve_begin(result), curve_octaves, result.curve);
    for (vox_cost_sample& sample : result.curve) sample.cost = std::max(sample.cost, result.predicted_cost);
}

vox_suggestion suggest_reference(const vox_suggest_desc& desc, const Geometry& geometry,
                                 const SuggestScene& scene, const vox_cost_weights& weights,
                                 std::pmr::memory_resource* memory) {
    const ReferenceModel cost(scene.bodies, desc.storage, scene.effort, weights, memory);
    CellSizeRange range{};
    if (!cost.range(range.min, range.max)) throw_no_size(geometry.stats);
    vox_suggestion result{};
    if (desc.storage == VOX_STORAGE_DENSE)
        result.budget_cell_size = cost.least_cell_size(static_cast<double>(desc.byte_budget), range);
    range.min = std::max(range.min, result.budget_cell_size);
    range.max = std::max(range.max, range.min);
    // The table is of what is smooth; what the lists' lengths make of it is added, and costs little to ask.
    const CostFunction smooth = [&](double d) { return cost(d) - cost.of_changes(d); };
    CostTable table(smooth, range, memory);
    const CostFunction function = [&](double d) {
        return scene.effort.tabulated ? table(d) + cost.of_changes(d) : cost(d);
    };
    const double scans = scene.effort.sample.listed > 0 ? 32 : 5;
    CostMinimum best = minimise(function, range, {.scans_per_octave = scans, .tolerance = near});
    best.cost = cost(best.cell_size);
    const CostFunction curve = [&](double d) { return std::max(function(d), best.cost); };
    write_minimum(result, best, zone_around(best, (1 + desc.zone_loss) * best.cost, curve, range));
    const Levels levels = choose_levels(cost, range);
    if (levels.count > 1) result.uniform_loss = std::max(result.predicted_cost / levels.cost - 1, 0.0);
    result.level_count = levels.count;
    for (std::uint32_t l = 0; l < levels.count; ++l) result.levels[l] = levels.level[l].cell_size;
    explain_model(result, desc, geometry, curve, nullptr, cost.terms(result.cell_size));
    return result;
}

FastModel fast_cost(const SuggestScene& scene, const vox_cost_weights& weights,
                   std::pmr::memory_resource* memory) {
    if (scene.last_step) return {scene.bodies, *scene.last_step, scene.effort, weights, memory};
    if (scene.boxes)
        return {scene.bodies, scene.tiles, scene.activity, *scene.boxes, scene.effort, weights, memory};
    return {scene.bodies, scene.tiles, scene.activity, scene.effort, weights, memory};
}

vox_suggestion suggest_fast(const vox_suggest_desc& desc, const Geometry& geometry, const SuggestScene& scene,
                            const vox_cost_weights& weights, std::pmr::memory_resource* memory) {
    const FastModel cost = fast_cost(scene, weights, memory);
    if (geometry.stats.tets == 0 || !(geometry.stats.mean_box_side > 0)) throw_no_size(geometry.stats);
    // Where no body is near another one any size will do; the usual one is there when some come near.
    CellSizeRange range{geometry.stats.mean_box_side / 8, geometry.stats.mean_box_side * 64};
    const bool any = cost.range(range.min, range.max);
    vox_suggestion result{};
    const CostFunction function = [&](double d) { return cost(d); };
    CostTable made(function, range, memory);
    CostTable* table = any && scene.effort.tabulated ? &made : nullptr;
    if (any) {
        minimise_into(result, desc, function, table, range);
    } else {
        result.cell_size = 2 * geometry.stats.mean_box_side;
        result.zone_min = range.min;
        result.zone_max = range.max;
        result.predicted_cost = cost(result.cell_size);
    }
    explain_model(result, desc, geometry, function, table,
                  cost.terms(result.cell_size, FastModel::Alignment::average));
    return result;
}

} // namespace

vox_suggestion suggest(const vox_suggest_desc& desc, const Geometry& geometry, const SuggestScene& scene,
                       const vox_cost_weights& weights, std::pmr::memory_resource* memory) {
    switch (desc.model) {
    case VOX_COST_MODEL_REFERENCE:
        return suggest_reference(desc, geometry, scene, weights, memory);
    case VOX_COST_MODEL_FAST:
        return suggest_fast(desc, geometry, scene, weights, memory);
    default:
        return suggest_paper(desc, geometry);
    }
}

CostTerms predict(const vox_suggest_desc& desc, const Geometry& geometry, const SuggestScene& scene,
                  const vox_cost_weights& weights, double cell_size, std::pmr::memory_resource* memory) {
    switch (desc.model) {
    case VOX_COST_MODEL_REFERENCE:
        return ReferenceModel(scene.bodies, desc.storage, scene.effort, weights, memory).terms(cell_size);
    case VOX_COST_MODEL_FAST:
        return FastModel(scene.bodies, scene.tiles, scene.activity, scene.effort, weights, memory)
            .terms(cell_size, FastModel::Alignment::actual);
    default:
        return paper_terms(desc, paper_model(desc, geometry.stats), cell_size);
    }
}

} // namespace vox
