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
// Reads a number again whose mantissa `found` ended at an exponent of Fortran; gives `found` if it is none.
std::from_chars_result read_fortran(const char* begin, std::from_chars_result found, const char* end,
                                    double& value);
constexpr bool is_fortran_exponent(char c) { return c == 'D' || c == 'd' || c == '+' || c == '-'; }

inline std::from_chars_result read_double(const char* begin, const char* end, double& value) {
#if defined(__cpp_lib_to_chars)
    const auto result = std::from_chars(begin, end, value);
    if (result.ec != std::errc::result_out_of_range) return result;
#endif
    return read_double_by_c(begin, end, value);
}

// The same with the exponents that Fortran writes: 1.0D+00, and 1.0-100 where three digits leave no room for
// a letter.
inline std::from_chars_result read_real(const char* begin, const char* end, double& value) {
    const auto result = read_double(begin, end, value);
    const bool exponent = result.ec == std::errc{} && result.ptr != end && is_fortran_exponent(*result.ptr);
    return exponent ? read_fortran(begin, result, end, value) : result;
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
