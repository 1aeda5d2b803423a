#include "cell_size/weights.hpp"

#include "base/error.hpp"
#include "base/structs.hpp"

#include <cmath>
#include <cstddef>
#include <iterator>

namespace vox {

namespace {

// In the order of vox_cost_weights.ns.
constexpr double CostWeights::*fields[] = {
    &CostWeights::classify_vertex, &CostWeights::prepare_tet,  &CostWeights::visit_cell,
    &CostWeights::scan_cell,       &CostWeights::read_vertex,  &CostWeights::test_box,
    &CostWeights::test_tet,        &CostWeights::clear_bucket, &CostWeights::changed_list,
    &CostWeights::fetch_vertex,    &CostWeights::bin_vertex,   &CostWeights::clear_cell,
    &CostWeights::visit_tile,      &CostWeights::visit_row,    &CostWeights::found_vertex,
    &CostWeights::test_vertex,
};
static_assert(std::size(fields) <= VOX_COST_WEIGHT_CAPACITY);

} // namespace

CostWeights read_weights(const vox_cost_weights* given) {
    CostWeights weights = shipped_weights;
    if (!given) return weights;
    const vox_cost_weights read = read_struct(given, "weights");
    for (std::size_t i = 0; i < VOX_COST_WEIGHT_CAPACITY; ++i) {
        const double ns = read.ns[i];
        if (!(ns >= 0) || !std::isfinite(ns))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("weights.ns[%zu] is %g, expected a finite number >= 0", i, ns));
        if (ns > 0 && i < std::size(fields)) weights.*fields[i] = ns;
    }
    return weights;
}

vox_cost_weights as_given(const CostWeights& weights) {
    vox_cost_weights given{};
    given.struct_size = sizeof given;
    for (std::size_t i = 0; i < std::size(fields); ++i) given.ns[i] = weights.*fields[i];
    return given;
}

} // namespace vox
