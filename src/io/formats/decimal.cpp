#include "io/formats/decimal.hpp"

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace vox::io {

// strtod also reads blanks, a plus and hexadecimal digits, and has the locale's decimal point.
std::from_chars_result read_double_by_c(const char* begin, const char* end, double& value) {
    constexpr std::string_view letters = ".0123456789+-eEinfatyINFATY";
    std::string text(begin,
                     std::find_if(begin, end, [&](char c) { return letters.find(c) == letters.npos; }));
    const std::string_view point = std::localeconv()->decimal_point;
    const std::size_t at = text.find('.');
    if (at != std::string::npos) text.replace(at, 1, point);
    char* stop = nullptr;
    errno = 0;
    const double found = std::strtod(text.c_str(), &stop);
    auto size = static_cast<std::size_t>(stop - text.c_str());
    if (size == 0 || text[0] == '+') return {begin, std::errc::invalid_argument};
    if (size > at) size -= point.size() - 1;
    value = found;
    const bool fits = errno != ERANGE || (found != 0 && !std::isinf(found));
    return {begin + size, fits ? std::errc{} : std::errc::result_out_of_range};
}

std::from_chars_result read_fortran(const char* begin, std::from_chars_result found, const char* end,
                                    double& value) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    std::string text(begin, found.ptr);
    const bool letter = *found.ptr == 'D' || *found.ptr == 'd';
    if (text.find_first_of("eE") != std::string::npos || (!letter && text.find('.') == std::string::npos))
        return found;
    const char* const exponent = found.ptr + letter;
    const char* stop = exponent != end && (*exponent == '+' || *exponent == '-') ? exponent + 1 : exponent;
    const char* const digits = stop;
    while (stop != end && is_digit(*stop)) ++stop;
    if (stop == digits) return found;
    text.append("e").append(exponent + (*exponent == '+'), stop);
    return {stop, read_double(text.data(), text.data() + text.size(), value).ec};
}

char* write_double_by_c(char* begin, char* end, double value) {
    char text[40];
    for (int digits = 1; digits <= 17; ++digits) {
        (void)std::snprintf(text, sizeof text, "%.*g", digits, value);
        if (std::strtod(text, nullptr) == value) break;
    }
    std::string out = text;
    const std::string_view point = std::localeconv()->decimal_point;
    const std::size_t at = out.find(point);
    if (at != std::string::npos) out.replace(at, point.size(), 1, '.');
    return std::copy_n(out.data(), std::min(out.size(), static_cast<std::size_t>(end - begin)), begin);
}

} // namespace vox::io
