// How failures travel inside the libraries: as exceptions, caught at the C border (border.hpp) and turned
// into a code and a text there. Header only and on public symbols alone, so that vox_io shares it.
#pragma once

#include <vox/vox.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace vox {

// A failure with the result code the caller gets and the text vox_last_error() gives.
class Error : public std::runtime_error {
public:
    Error(vox_result result, const std::string& text) : std::runtime_error(text), result_(result) {}
    vox_result result() const noexcept { return result_; }

private:
    vox_result result_;
};

// printf into a string, so that messages carry their numbers: throw Error(code, format("tet %u names ...",
// t)).
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
inline std::string
format(const char* pattern, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, pattern);
    (void)std::vsnprintf(text, sizeof text, pattern, arguments); // a longer text is cut
    va_end(arguments);
    return text;
}

// Throws INVALID_ARGUMENT naming the parameter when `pointer` is null.
inline void require(const void* pointer, const char* name) {
    if (!pointer) throw Error(VOX_ERROR_INVALID_ARGUMENT, format("%s is null", name));
}

} // namespace vox
