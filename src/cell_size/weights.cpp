#include "cell_size/weights.hpp"

#include "base/error.hpp"
#include "base/structs.hpp"

#include <cmath>
#include <cstddef>
#include <mutex>

namespace vox {

namespace {

// What a list of another length costs beside an empty visit, and what it costs to fetch a vertex beside
// reading it: fitted together with the weights of the reference engine.
constexpr double list_over_visit = 6.7, fetch_over_read = 1.8;

// With gcc 12, fitted to steps at many cell sizes: of the reference engine on a Zen 5 at 2.6 GHz, of the fast
// engine on a Xeon at 2.5 GHz. fast_visit_row was fitted later, on the Zen 5.
constexpr struct {
    const char* name;
    double vox_cost_weights::*field;
    double shipped;
} fields[] = {
    {"reference_classify_vertex", &vox_cost_weights::reference_classify_vertex, 30},
    {"reference_prepare_tet", &vox_cost_weights::reference_prepare_tet, 15},
    {"reference_visit_cell", &vox_cost_weights::reference_visit_cell, 2.6},
    {"reference_scan_cell", &vox_cost_weights::reference_scan_cell, 1.3},
    {"reference_read_vertex", &vox_cost_weights::reference_read_vertex, 1.2},
    {"reference_test_box", &vox_cost_weights::reference_test_box, 0.6},
    {"reference_test_tet", &vox_cost_weights::reference_test_tet, 24},
    {"reference_clear_bucket", &vox_cost_weights::reference_clear_bucket, 0.2},
    {"fast_bin_vertex", &vox_cost_weights::fast_bin_vertex, 5},
    {"fast_clear_cell", &vox_cost_weights::fast_clear_cell, 0.7},
    {"fast_visit_tile", &vox_cost_weights::fast_visit_tile, 170},
    {"fast_visit_row", &vox_cost_weights::fast_visit_row, 4},
    {"fast_read_vertex", &vox_cost_weights::fast_read_vertex, 0.35},
    {"fast_test_vertex", &vox_cost_weights::fast_test_vertex, 3},
    {"reference_changed_list", &vox_cost_weights::reference_changed_list, list_over_visit * 2.6},
    {"reference_fetch_vertex", &vox_cost_weights::reference_fetch_vertex, fetch_over_read * 1.2},
};

std::mutex& lock() {
    static std::mutex mutex;
    return mutex;
}

vox_cost_weights& in_use() {
    static vox_cost_weights weights = shipped_weights();
    return weights;
}

} // namespace

vox_cost_weights shipped_weights() noexcept {
    vox_cost_weights weights{};
    weights.struct_size = sizeof weights;
    for (const auto& field : fields) weights.*field.field = field.shipped;
    return weights;
}

vox_cost_weights weights_in_use() noexcept {
    const std::lock_guard guard(lock());
    return in_use();
}

void use_weights(const vox_cost_weights& weights) noexcept {
    const std::lock_guard guard(lock());
    in_use() = weights;
}

// Programs built before the last two fields scale them with the weights that stood for them.
vox_cost_weights read_weights(const vox_cost_weights* given) {
    vox_cost_weights weights = shipped_weights();
    if (!given) return weights;
    weights = read_struct(given, "vox_cost_weights");
    for (const auto& [name, field, shipped] : fields) set_default(weights.*field, shipped);
    if (given->struct_size <= offsetof(vox_cost_weights, reference_changed_list)) {
        weights.reference_changed_list = list_over_visit * weights.reference_visit_cell;
        weights.reference_fetch_vertex = fetch_over_read * weights.reference_read_vertex;
    }
    for (const auto& [name, field, shipped] : fields) {
        const double value = weights.*field;
        if (!(value > 0) || !std::isfinite(value))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("weight %s is %g, expected a finite number above 0", name, value));
    }
    return weights;
}

} // namespace vox
