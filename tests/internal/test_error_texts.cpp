// Texts with numbers are the same on every machine.
#include "base/error.hpp"
#include "support/suite.h"

#include <cmath>
#include <limits>
#include <string>

using namespace vox;

namespace {

void check(const std::string& found, const char* expected) { ck_assert_str_eq(found.c_str(), expected); }

START_TEST(nan_has_no_sign) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double value : {nan, -nan, std::copysign(nan, -1.0), std::copysign(nan, 1.0)}) {
        check(format("cell_size is %.9g", value), "cell_size is nan");
        check(format("point is (%g, %g, 0)", value, value), "point is (nan, nan, 0)");
        check(format("%.17g.", value), "nan.");
        check(format("world is [%g, %g]: not finite; %f", value, -1.5, value),
              "world is [nan, -1.5]: not finite; nan");
    }
    // As other C libraries write it.
    check(format("%s, %s and %s", "-nan(ind)", "nan(snan)", "nan(0x8000000000000)"), "nan, nan and nan");
}
END_TEST

START_TEST(names_stay) {
    for (const char* name :
         {"", "-", "n", "-na", "banana", "my-nan.vtu", "-nan.vtu: no such file", "a/-nan/b", "nan(1", "-nano",
          "nanometres", "-1 -inf", "--nan", "-nan(", "x-nan"})
        check(format("%s", name), name);
    check(format("%s: %g", "my-nan", std::copysign(std::nan(""), -1.0)), "my-nan: nan");
    ck_assert_uint_eq(format("%2000d", 1).size(), 1023);
}
END_TEST

START_TEST(cut_between_characters) {
    const std::string character = "\xe2\x82\xac";
    std::string text;
    while (text.size() < 2000) text += character;
    for (const std::size_t before : {0u, 1u, 2u}) {
        const std::string whole = std::string(before, 'x') + text;
        check(format("%s", whole.c_str()), whole.substr(0, before + (1023 - before) / 3 * 3).c_str());
    }
}
END_TEST

} // namespace

SUITE(error_texts) {
    TCase* tests = add_case(suite, "texts");
    tcase_add_test(tests, nan_has_no_sign);
    tcase_add_test(tests, names_stay);
    tcase_add_test(tests, cut_between_characters);
}
