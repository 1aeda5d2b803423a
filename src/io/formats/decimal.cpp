#include "io/formats/decimal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace vox::io {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

// Passes `word`, which is in lower case, if it is next in any case.
bool pass(const char*& at, const char* end, const char* word) noexcept {
    const std::size_t size = std::strlen(word);
    if (static_cast<std::size_t>(end - at) < size) return false;
    for (std::size_t i = 0; i < size; ++i)
        if ((at[i] | 0x20) != word[i]) return false;
    at += size;
    return true;
}

// The text of a positive finite number: its first `count` significant digits, and where the decimal point is
// behind them. strtod reads it in any locale, as it has no point.
double number_of(const char* digits, int count, int exponent) {
    char text[48];
    (void)std::snprintf(text, sizeof text, "%.*se%d", count, digits, exponent - count);
    return std::strtod(text, nullptr);
}

} // namespace

std::from_chars_result read_double_by_c(const char* begin, const char* end, double& value) {
    const char* at = begin;
    const bool negative = at != end && *at == '-';
    at += negative;
    const auto give = [&](double magnitude) -> std::from_chars_result {
        value = negative ? -magnitude : magnitude;
        return {at, std::errc{}};
    };
    if (pass(at, end, "inf")) {
        (void)pass(at, end, "inity");
        return give(HUGE_VAL);
    }
    if (pass(at, end, "nan")) return give(std::nan(""));

    // Without a decimal point, of which locales have different ones.
    std::string text;
    std::int64_t exponent = 0;
    bool any = false, nonzero = false, point = false;
    for (; at != end && (is_digit(*at) || (*at == '.' && !point)); ++at) {
        if (*at == '.') {
            point = true;
            continue;
        }
        any = true;
        nonzero = nonzero || *at != '0';
        exponent -= point;
        if (nonzero) text += *at;
    }
    if (!any) return {begin, std::errc::invalid_argument};
    if (at != end && (*at == 'e' || *at == 'E')) {
        const char* digit = at + 1;
        const bool down = digit != end && *digit == '-';
        if (digit != end && (*digit == '-' || *digit == '+')) ++digit;
        if (digit != end && is_digit(*digit)) {
            constexpr std::int64_t most = std::int64_t{1}
                                          << 40; // far from any double, whatever the digits are
            std::int64_t written = 0;
            for (; digit != end && is_digit(*digit); ++digit)
                written = std::min(10 * written + (*digit - '0'), most);
            exponent += down ? -written : written;
            at = digit;
        }
    }
    if (!nonzero) return give(0);
    // The size of the number; strtod might add up exponents in an int.
    const std::int64_t size = static_cast<std::int64_t>(text.size()) + exponent;
    if (size < -400 || size > 400) return {at, std::errc::result_out_of_range};
    text += 'e';
    text += std::to_string(exponent);
    const double magnitude = std::strtod(text.c_str(), nullptr);
    if (magnitude == 0 || magnitude == HUGE_VAL) return {at, std::errc::result_out_of_range};
    return give(magnitude);
}

// As many digits as are needed to get the same double again, and of the texts with so many the nearest; in
// fixed or scientific notation, whichever is shorter.
char* write_double_by_c(char* begin, char* end, double value) {
    const auto put = [&](const char* text, int size) {
        const int room = static_cast<int>(end - begin);
        std::memcpy(begin, text, static_cast<std::size_t>(std::min(size, room)));
        begin += std::min(size, room);
    };
    if (std::signbit(value)) put("-", 1);
    const double magnitude = std::fabs(value);
    if (std::isnan(value)) put("nan", 3);
    if (std::isinf(value)) put("inf", 3);
    if (magnitude == 0) put("0", 1);
    if (!(magnitude > 0 && magnitude < HUGE_VAL)) return begin;

    char digits[20] = "";
    int count = 0, exponent = 0; // 0.DIGITS * 10^exponent
    for (int precision = 1; precision <= 17 && count == 0; ++precision) {
        char text[40];
        (void)std::snprintf(text, sizeof text, "%.*e", precision - 1, magnitude);
        const char* const mark = std::strchr(text, 'e');
        int size = 0;
        for (const char* c = text; c != mark; ++c)
            if (is_digit(*c)) digits[size++] = *c;
        exponent = std::atoi(mark + 1) + 1;
        if (number_of(digits, size, exponent) == magnitude) {
            count = size;
            break;
        }
        // Below a power of two doubles are closer together than above, so that the nearest text may stand for
        // the one below, and the next text for this one.
        int last = size - 1;
        while (last > 0 && digits[last] == '9') --last;
        if (digits[last] == '9') continue;
        ++digits[last];
        if (number_of(digits, last + 1, exponent) == magnitude) count = last + 1;
    }
    while (count > 1 && digits[count - 1] == '0') --count;

    const int power = exponent - 1, sign_and_digits = std::abs(power) >= 100 ? 4 : 3;
    const int scientific = count + (count > 1) + 1 + sign_and_digits;
    const int fixed = exponent <= 0 ? 2 - exponent + count : std::max(exponent, count + (count > exponent));
    char text[400];
    int size = 0;
    if (fixed > scientific) {
        size = std::snprintf(text, sizeof text, "%c%s%.*se%c%02d", digits[0], count > 1 ? "." : "", count - 1,
                             digits + 1, power < 0 ? '-' : '+', std::abs(power));
    } else if (exponent <= 0) {
        size = std::snprintf(text, sizeof text, "0.%0*d%.*s", -exponent, 0, count, digits);
        if (exponent == 0) size = std::snprintf(text, sizeof text, "0.%.*s", count, digits);
    } else if (count > exponent) {
        size = std::snprintf(text, sizeof text, "%.*s.%.*s", exponent, digits, count - exponent,
                             digits + exponent);
    } else {
        size =
            std::snprintf(text, sizeof text, "%.0f", magnitude); // all digits of a whole number, as they are
    }
    put(text, size);
    return begin;
}

#if !defined(__cpp_lib_to_chars)

std::from_chars_result read_double(const char* begin, const char* end, double& value) {
    return read_double_by_c(begin, end, value);
}

char* write_double(char* begin, char* end, double value) { return write_double_by_c(begin, end, value); }

#endif

} // namespace vox::io
