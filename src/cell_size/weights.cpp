#include "cell_size/weights.hpp"

#include "base/error.hpp"

#include <cmath>
#include <mutex>

namespace vox {

namespace {

struct Named {
    const char* name;
    double vox_cost_weights::*field;
};

constexpr Named fields[] = {
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

// gcc 12: fitted to steps at many cell sizes, of the reference engine on a Zen 5 at 2.6 GHz, of the fast one
// on a Xeon at 2.5, but for the rows, which cost less since: on the Zen 5.
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

void check_weights(const vox_cost_weights& weights) {
    for (const Named& named : fields) {
        const double value = weights.*named.field;
        if (!(value > 0) || !std::isfinite(value))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("weight %s is %g, expected a finite number above 0", named.name, value));
    }
}

} // namespace vox
