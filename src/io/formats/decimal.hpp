// Doubles from and to decimal text, rounded correctly, whatever the locale: by std::from_chars and
// std::to_chars, or by the C library where the C++ library does not have them for doubles (libc++ before 20).
#pragma once

#include <charconv>
#include <version>

namespace vox::io {

// Numbers out of range give 0 or infinity, and the error result_out_of_range. By the C library: the one in
// the syntax of std::from_chars, the other with the fewest digits of which the nearest text gives the same
// double.
std::from_chars_result read_double_by_c(const char* begin, const char* end, double& value);
char* write_double_by_c(char* begin, char* end, double value);

inline std::from_chars_result read_double(const char* begin, const char* end, double& value) {
#if defined(__cpp_lib_to_chars)
    const auto result = std::from_chars(begin, end, value);
    if (result.ec != std::errc::result_out_of_range) return result;
#endif
    return read_double_by_c(begin, end, value);
}

// Room for any double: 32 characters.
inline char* write_double(char* begin, char* end, double value) {
#if defined(__cpp_lib_to_chars)
    return std::to_chars(begin, end, value).ptr;
#else
    return write_double_by_c(begin, end, value);
#endif
}

} // namespace vox::io
