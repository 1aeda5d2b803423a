// Doubles from and to text by the C library, as vox_io does it where the C++ library cannot: as by the C++
// library, in any locale.
#include "internal/random.hpp"
#include "io/formats/decimal.hpp"
#include "support/suite.h"

#include <bit>
#include <cfloat>
#include <clocale>
#include <cstdio>
#include <cstring>
#include <string>

using namespace vox;
using namespace vox::io;

namespace {

#if defined(__cpp_lib_to_chars)

// From the first to the last that is not 0.
std::size_t digits_of(std::string text) {
    text.resize(std::min(text.find('e'), text.size()));
    std::erase_if(text, [](char c) { return c < '0' || c > '9'; });
    const std::size_t first = text.find_first_not_of('0');
    return first == std::string::npos ? 0 : text.find_last_not_of('0') - first + 1;
}

void check_written(double value) {
    char expected[64] = "", found[64] = "";
    *std::to_chars(expected, expected + 63, value, std::chars_format::scientific).ptr = 0;
    *write_double_by_c(found, found + 32, value) = 0;
    ck_assert_uint_le(digits_of(found), digits_of(expected) + 1); // a power of two may take one more
    double read = 0;
    const auto [stop, error] = read_double_by_c(found, found + std::strlen(found), read);
    ck_assert(*stop == 0 && error == std::errc{});
    ck_assert(std::bit_cast<std::uint64_t>(read) == std::bit_cast<std::uint64_t>(value));
}

void check_read(const std::string& text) {
    const char *const begin = text.data(), *const end = begin + text.size();
    double expected = 77, found = 77;
    const auto by_cpp = std::from_chars(begin, end, expected);
    const auto by_c = read_double_by_c(begin, end, found);
    if (by_cpp.ec == std::errc::result_out_of_range && (found == 0 || std::isinf(found))) found = expected;
    ck_assert_msg(by_cpp.ptr == by_c.ptr && by_cpp.ec == by_c.ec &&
                      (std::bit_cast<std::uint64_t>(expected) == std::bit_cast<std::uint64_t>(found) ||
                       (expected != expected && found != found)),
                  "%.100s: read as %.17g, expected %.17g; after %d characters, expected %d", text.c_str(),
                  found, expected, int(by_c.ptr - begin), int(by_cpp.ptr - begin));
}

void check_numbers() {
    for (const double value :
         {0.0,     -0.0,    1.0,  -1.5,   0.1,    1e21,    1e22,     1e23,      123456789012345680.0, 5e-324,
          DBL_MIN, DBL_MAX, 1e-5, 1.5e-5, 0.0001, 0.00012, 100000.0, 1e5 + 0.5, 9007199254740993.0,   4.35,
          9.5e-44})
        for (const double sign : {1.0, -1.0}) check_written(sign * value);
    for (int power = -1074; power < 1024; ++power) {
        check_written(std::ldexp(1.0, power));
        check_written(std::nextafter(std::ldexp(1.0, power), 0));
    }
    Random random{7};
    for (int times = 0; times < 20000; ++times) {
        const std::uint64_t bits =
            std::uint64_t{random.below(1u << 31)} << 33 | std::uint64_t{random.below(1u << 31)} << 2;
        const double any = std::bit_cast<double>(bits ^ std::uint64_t(times));
        if (std::isfinite(any)) check_written(any);
        check_written(double(random.below(1u << 30)) / 1000);
        check_written(double(float(random.below(1u << 30)) * 0x1p-30f));
    }
}

START_TEST(written_with_few_digits) { check_numbers(); }
END_TEST

START_TEST(in_any_locale) {
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"})
        if (std::setlocale(LC_ALL, name)) break;
    check_numbers(); // with a comma in place of the point, where there is such a locale
}
END_TEST

START_TEST(read_as_by_the_cpp_library) {
    for (const char* text : {"",
                             "-",
                             "+1",
                             "1",
                             "-1",
                             "1.",
                             ".5",
                             ".",
                             "-.5e",
                             "1e",
                             "1e+",
                             "1e-",
                             "1e5",
                             "1E+05x",
                             "1.5e-3 ",
                             "0x10",
                             "1,5",
                             "1e400",
                             "-1e400",
                             "1e-400",
                             "0e999999999999999999999",
                             "1e999999999999999999999",
                             "1e-999999999999999999999",
                             "inf",
                             "-INF",
                             "infinity",
                             "Infinit",
                             "nan",
                             "-NaN",
                             "na",
                             "00012.500",
                             "0.000",
                             "-0.0",
                             "2.4703282292062327208e-324",
                             "2.4703282292062328e-324",
                             "1.7976931348623157e308",
                             "1.7976931348623159e308",
                             "9007199254740993",
                             "9007199254740992.999999999999999999999999",
                             "1..2",
                             "1.2.3",
                             "1e5.5",
                             "- 1",
                             " 1"})
        check_read(text);
    check_read("0." + std::string(500, '0') + "1e501");
    check_read("1" + std::string(500, '0') + "e-500");
    check_read(std::string(2000, '9'));
    check_read("9007199254740993." + std::string(900, '0') + "1");
    check_read("0." + std::string(100000, '0') + "123e100001");
    Random random{9};
    for (int times = 0; times < 20000; ++times) {
        std::string text;
        static const char letters[] = "0123456789.eE+-";
        for (std::uint32_t left = 1 + random.below(24); left > 0; --left)
            text += letters[random.below(random.below(2) ? 10 : 15)];
        check_read(text);
        char written[64];
        const double near =
            (double(random.below(1u << 30)) + 0.5) * std::ldexp(1.0, int(random.below(200)) - 100);
        (void)std::snprintf(written, sizeof written, "%.*g", 1 + int(random.below(24)), near);
        check_read(written);
    }
}
END_TEST

#endif

} // namespace

SUITE(decimal) {
    TCase* tests = add_case(suite, "decimal");
#if defined(__cpp_lib_to_chars)
    for (const TTest* test : {written_with_few_digits, in_any_locale, read_as_by_the_cpp_library})
        tcase_add_test(tests, test);
#else
    (void)tests;
#endif
}
