// Failures inside the libraries are exceptions, which the C border (border.hpp) turns into a result code and
// a text. This header uses no symbol that is not public, so that vox_io and vox_sim can share it.
#pragma once

#include <vox/vox.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace vox {

// A failure, with the result code for the caller and the text for vox_last_error().
class Error : public std::runtime_error {
public:
    Error(vox_result result, const std::string& text) : std::runtime_error(text), result_(result) {}
    vox_result result() const noexcept { return result_; }

private:
    vox_result result_;
};

// printf into a string, for messages with numbers, as in throw Error(code, format("tet %u names ...", t)).
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
inline std::string
format(const char* pattern, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, pattern);
    (void)std::vsnprintf(text, sizeof text, pattern, arguments); // longer texts are cut
    va_end(arguments);
    return text;
}

[[noreturn]] inline void refuse(const std::string& text) { throw Error(VOX_ERROR_INVALID_ARGUMENT, text); }

// Throws INVALID_ARGUMENT, with the name of the parameter, when `pointer` is null.
inline void require(const void* pointer, const char* name) {
    if (!pointer) refuse(format("%s is null", name));
}

} // namespace vox
