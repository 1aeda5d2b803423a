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
