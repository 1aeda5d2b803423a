#include "cell_size/weights.hpp"

#include "base/error.hpp"
#include "base/structs.hpp"

#include <cmath>
#include <cstddef>
#include <mutex>
#include <utility>

namespace vox {

namespace {

constexpr std::pair<const char*, double vox_cost_weights::*> fields[] = {
    {"reference_classify_vertex", &vox_cost_weights::reference_classify_vertex},
    {"reference_prepare_tet", &vox_cost_weights::reference_prepare_tet},
    {"reference_visit_cell", &vox_cost_weights::reference_visit_cell},
    {"reference_scan_cell", &vox_cost_weights::reference_scan_cell},
    {"reference_read_vertex", &vox_cost_weights::reference_read_vertex},
    {"reference_test_box", &vox_cost_weights::reference_test_box},
    {"reference_test_tet", &vox_cost_weights::reference_test_tet},
    {"reference_clear_bucket", &vox_cost_weights::reference_clear_bucket},
    {"fast_bin_vertex", &vox_cost_weights::fast_bin_vertex},
    {"fast_clear_cell", &vox_cost_weights::fast_clear_cell},
    {"fast_visit_tile", &vox_cost_weights::fast_visit_tile},
    {"fast_visit_row", &vox_cost_weights::fast_visit_row},
    {"fast_read_vertex", &vox_cost_weights::fast_read_vertex},
    {"fast_test_vertex", &vox_cost_weights::fast_test_vertex},
    {"reference_changed_list", &vox_cost_weights::reference_changed_list},
    {"reference_fetch_vertex", &vox_cost_weights::reference_fetch_vertex},
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

// What a list of another length costs beside an empty visit, and what it costs to fetch a vertex beside reading
// it: fitted together with the weights of the reference engine.
constexpr double list_over_visit = 6.7, fetch_over_read = 1.8;

// With gcc 12, fitted to steps at many cell sizes: of the reference engine on a Zen 5 at 2.6 GHz, of the fast
// engine on a Xeon at 2.5 GHz. fast_visit_row was fitted later, on the Zen 5.
vox_cost_weights shipped_weights() noexcept {
    vox_cost_weights weights{};
    weights.struct_size = sizeof weights;
    weights.measured = 0;
    weights.reference_classify_vertex = 30;
    weights.reference_prepare_tet = 15;
    weights.reference_visit_cell = 2.6;
    weights.reference_scan_cell = 1.3;
    weights.reference_read_vertex = 1.2;
    weights.reference_test_box = 0.6;
    weights.reference_test_tet = 24;
    weights.reference_clear_bucket = 0.2;
    weights.fast_bin_vertex = 5;
    weights.fast_clear_cell = 0.7;
    weights.fast_visit_tile = 170;
    weights.fast_visit_row = 4;
    weights.fast_read_vertex = 0.35;
    weights.fast_test_vertex = 3;
    weights.reference_changed_list = list_over_visit * weights.reference_visit_cell;
    weights.reference_fetch_vertex = fetch_over_read * weights.reference_read_vertex;
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
    weights = read_struct(given, weights, "vox_cost_weights");
    if (weights.struct_size <= offsetof(vox_cost_weights, reference_changed_list)) {
        weights.reference_changed_list = list_over_visit * weights.reference_visit_cell;
        weights.reference_fetch_vertex = fetch_over_read * weights.reference_read_vertex;
    }
    for (const auto& [name, field] : fields) {
        const double value = weights.*field;
        if (!(value > 0) || !std::isfinite(value))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("weight %s is %g, expected a finite number above 0", name, value));
    }
    weights.struct_size = sizeof weights;
    return weights;
}

} // namespace vox
