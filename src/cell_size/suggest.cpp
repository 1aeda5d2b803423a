#include "cell_size/suggest.hpp"

#include "base/error.hpp"
#include "base/structs.hpp"
#include "cell_size/fast_model.hpp"
#include "cell_size/paper_model.hpp"
#include "cell_size/reference_model.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdint>

namespace vox {

// ---- arguments ------------------------------------------------------------------------------------

namespace {

// The most a zone may lose; keeps every number of the cost function in range.
constexpr double max_zone_loss = 1e6;

void check_number(bool good, double value, const char* name, const char* expected) {
    if (!good || !std::isfinite(value))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("suggest %s is %.9g, expected %s", name, value, expected));
}

} // namespace

void check_reference_flags(std::uint32_t flags, const char* name) {
    constexpr std::uint32_t known_flags = VOX_REFERENCE_DENSE | VOX_REFERENCE_PAPER_HASH;
    if (flags & ~known_flags)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%s is 0x%" PRIx32 ", of which 0x%" PRIx32 " is unknown", name, flags,
                           flags & ~known_flags));
}

void check_suggest_desc(vox_cell_size_desc& desc) {
    set_default(desc.p_nc, 0.99);
    set_default(desc.cost_ratio, 5.0);
    set_default(desc.zone_loss, default_zone_loss);
    check_enum(desc.model, VOX_COST_MODEL_SURFACE, "suggest model");
    check_number(desc.p_nc > 0 && desc.p_nc < 1, desc.p_nc, "p_nc",
                 "a number between 0 and 1, both excluded");
    check_number(desc.cost_ratio > 0, desc.cost_ratio, "cost_ratio", "a number above 0");
    check_number(desc.world_edge >= 0, desc.world_edge, "world_edge", "0 or a length");
    check_number(desc.zone_loss >= 0 && desc.zone_loss <= max_zone_loss, desc.zone_loss, "zone_loss",
                 "a number from 0 to 1e6");
    check_reference_flags(desc.reference_flags, "suggest reference_flags");
    (void)read_weights(desc.weights);
    if (desc.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("suggest reserved is %" PRIu32 ", expected 0", desc.reserved));
}

// ---- suggestion -----------------------------------------------------------------------------------

namespace {

bool is_dense(const vox_cell_size_desc& desc) noexcept { return desc.reference_flags & VOX_REFERENCE_DENSE; }

double world_edge(const vox_cell_size_desc& desc, const vox_geometry& stats) {
    if (desc.world_edge > 0) return desc.world_edge;
    double edge = 0;
    for (int axis = 0; axis < 3; ++axis)
        edge = std::max(edge, stats.bounds_max[axis] - stats.bounds_min[axis]);
    return edge;
}

// Everything that is written in the same way for all models. `cost` is below the least one nowhere.
void write(vox_cell_size_result& result, const vox_cell_size_desc& desc, const Geometry& geometry,
           const vox_cost_sample& best, const CellSizeRange& zone, const CostFunction& cost,
           const CostTerms& terms) {
    const vox_geometry& stats = geometry.stats;
    const double unit = desc.model == VOX_COST_MODEL_PAPER ? 1 : 1e-9; // else nanoseconds become seconds
    const CostFunction scaled = [&](double log_size) { return unit * cost(log_size); };
    result.cell_size = best.cell_size;
    result.cost = unit * best.cost;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.cells_per_axis = world_edge(desc, stats) / best.cell_size;
    const auto add_rule = [&](const char* name, double cell_size) {
        result.rules[result.rule_count++] = {name, cell_size,
                                             cell_size > 0 ? scaled(std::log2(cell_size)) : 0};
    };
    add_rule("mean edge (Teschner et al. 2003)", stats.mean_edge);
    add_rule("2 mean edges (Gregory et al. 2000)", 2 * stats.mean_edge);
    add_rule("512 voxels an object (Garcia-Alonso et al. 1994)", geometry.mean_object_side / 8);
    add_rule("cube root of the mean volume", std::cbrt(stats.mean_volume));
    add_rule("median box side (IPC Toolkit)", stats.median_box_side);
    draw_curve(scaled, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
    write_terms(terms, unit, result);
}

vox_cell_size_result suggest_paper(const vox_cell_size_desc& desc, const CellSizeScene& scene) {
    const PaperModel cost(scene, desc);
    const vox_cost_sample best = cost.minimum();
    vox_cell_size_result result{};
    write(result, desc, scene.geometry, best, cost.zone(desc.zone_loss), of_size(cost),
          cost.terms(best.cell_size));
    return result;
}

[[noreturn]] void throw_no_size(const vox_geometry& stats) {
    throw Error(
        VOX_ERROR_INVALID_ARGUMENT,
        stats.tets == 0
            ? format("no tetrahedra: %" PRIu64 " vertices alone give no cell size", stats.vertices)
            : format("%" PRIu64 " tets of no size: mean box side %g", stats.tets, stats.mean_box_side));
}

// No model is more accurate.
constexpr Fineness model_fineness{
    .scans_per_octave = 3, .least_scans = 12, .tolerance = 1e-3, .zone_tolerance = 1e-5};

vox_cell_size_result suggest_reference(const vox_cell_size_desc& desc, const CellSizeScene& scene,
                                       const CostWeights& weights) {
    const ReferenceModel model(scene, is_dense(desc), weights);
    if (!model.range()) throw_no_size(scene.geometry.stats);
    CellSizeRange range = *model.range();
    double least = 0;
    if (is_dense(desc)) least = model.least_cell_size(static_cast<double>(desc.byte_budget), range);
    range.min = std::max(range.min, least);
    range.max = std::max(range.max, range.min);
    vox_cell_size_result result = suggest_by(
        desc, scene.geometry, [&](double cell_size) { return model.terms(cell_size); }, range, range);
    result.min_cell_size = least;
    return result;
}

vox_cell_size_result suggest_fast(const vox_cell_size_desc& desc, const CellSizeScene& scene,
                                  const CostWeights& weights) {
    const vox_geometry& stats = scene.geometry.stats;
    const FastModel model(scene, weights);
    if (stats.tets == 0 || !(stats.mean_box_side > 0)) throw_no_size(stats);
    const auto terms = [&](double cell_size) { return model.terms(cell_size); };
    if (const std::optional<CellSizeRange> range = model.range())
        return suggest_by(desc, scene.geometry, terms, *range, *range);
    // No body is near another one: any size will do, so a usual one for when some are.
    const double usual = 2 * stats.mean_box_side;
    return suggest_by(desc, scene.geometry, terms, {usual, usual},
                      {stats.mean_box_side / 8, stats.mean_box_side * 64});
}

} // namespace

vox_cell_size_result suggest(const vox_cell_size_desc& desc, CellSizeScene& scene,
                             const CostWeights& weights) {
    scene.prepare(desc.model);
    switch (desc.model) {
    case VOX_COST_MODEL_REFERENCE:
        return suggest_reference(desc, scene, weights);
    case VOX_COST_MODEL_FAST:
        return suggest_fast(desc, scene, weights);
    default:
        return suggest_paper(desc, scene);
    }
}

vox_cell_size_result suggest_by(const vox_cell_size_desc& desc, const Geometry& geometry,
                                const std::function<CostTerms(double cell_size)>& terms,
                                const CellSizeRange& range, const CellSizeRange& whole) {
    const CostFunction cost = [&](double log_size) { return terms(std::exp2(log_size)).cost(); };
    const vox_cost_sample best = minimise(cost, range, model_fineness);
    // Sizes between those of the search may cost a little less.
    const CostFunction curve = [&](double log_size) { return std::max(cost(log_size), best.cost); };
    vox_cell_size_result result{};
    write(result, desc, geometry, best,
          zone_around(best, (1 + desc.zone_loss) * best.cost, curve, whole, model_fineness), curve,
          terms(best.cell_size));
    return result;
}

} // namespace vox
