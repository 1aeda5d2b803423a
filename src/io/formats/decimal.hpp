// Doubles from and to decimal text, rounded correctly, whatever the locale: what std::from_chars and
// std::to_chars do, which some C++ libraries do not have for floating point (libc++ before 20).
#pragma once

#include <charconv>
#include <version>

namespace vox::io {

#if defined(__cpp_lib_to_chars)

inline std::from_chars_result read_double(const char* begin, const char* end, double& value) {
    return std::from_chars(begin, end, value);
}

// Room for any double: 32 characters.
inline char* write_double(char* begin, char* end, double value) {
    return std::to_chars(begin, end, value).ptr;
}

#else

std::from_chars_result read_double(const char* begin, const char* end, double& value);
char* write_double(char* begin, char* end, double value);

#endif

// The same by the C library, whose functions also round correctly. For the above, and for tests.
std::from_chars_result read_double_by_c(const char* begin, const char* end, double& value);
char* write_double_by_c(char* begin, char* end, double value);

} // namespace vox::io
