// Distances of edges that cross at a small angle, where a formula that subtracts squared lengths has few digits.
#include "base/vectors.hpp"
#include "internal/random.hpp"
#include "surface/distance.hpp"

#include <algorithm>
#include <cmath>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

START_TEST(edges_that_cross_at_any_angle) {
    test::Random random{5};
    const auto uniform = [&] {
        const double x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
        return Vec3d{x, y, 2 * random.unit() - 1};
    };
    double worst = 0;
    for (int digits = 0; digits <= 12; ++digits)
        for (int n = 0; n < 2000; ++n) {
            const Vec3d along = uniform(), other = along + std::pow(10, -digits) * uniform(), middle = uniform();
            const Vec3d a[2] = {middle - along, middle + along}, b[2] = {middle - other, middle + other};
            worst = std::max(worst, closest_features(a, b).distance); // 0 but for the rounding of the corners
        }
    ck_assert_msg(worst < 1e-14, "edges that cross are %g apart", worst);
}
END_TEST

} // namespace

int main() {
    Suite* suite = suite_create("feature_distance");
    TCase* tests = add_case(suite, "feature_distance");
    tcase_add_each(tests, edges_that_cross_at_any_angle);
    return run_suite(suite);
}
