// Errors with a text like printf's.
#pragma once

#include "base/error.hpp"

namespace vox::io {

inline std::string text_of(const char* pattern, va_list arguments) {
    char text[1024];
    write_text(text, sizeof text, pattern, arguments);
    return text;
}

[[noreturn]] VOX_PRINTF(2) inline void throw_error(vox_result result, const char* pattern, ...) {
    va_list arguments;
    va_start(arguments, pattern);
    const std::string text = text_of(pattern, arguments);
    va_end(arguments);
    throw Error(result, text);
}

} // namespace vox::io
