// Failures inside the libraries are exceptions, which the C border (border.hpp) turns into a result code and
// a text. This header uses no symbol that is not public, so that vox_io and vox_sim can share it.
#pragma once

#include <vox/vox.h>

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

// The compiler checks the arguments against a pattern like printf's: the parameter of that number, from 1, or
// from 2 in a class.
#if defined(__MINGW_PRINTF_FORMAT)
#define VOX_PRINTF(pattern) __attribute__((format(__MINGW_PRINTF_FORMAT, pattern, pattern + 1)))
#elif defined(__GNUC__)
#define VOX_PRINTF(pattern) __attribute__((format(printf, pattern, pattern + 1)))
#else
#define VOX_PRINTF(pattern)
#endif

namespace vox {

// A failure, with the result code for the caller and the text for vox_last_error().
class Error : public std::runtime_error {
public:
    Error(vox_result result, const std::string& text) : std::runtime_error(text), result_(result) {}
    vox_result result() const noexcept { return result_; }

private:
    vox_result result_;
};

// Writes "nan" where the C library wrote a sign or a kind with it, "-nan" or "nan(ind)": the same text on
// every machine. Only where it stands like a number, not in names.
inline void write_nan_plainly(char* text) noexcept {
    char* out = text;
    for (const char* at = text; *at; *out++ = *at++) {
        const char* number = at + (*at == '-');
        if (std::strncmp(number, "nan", 3) != 0 || (at != text && !std::strchr(" ([,=", at[-1]))) continue;
        const char* end = number + 3;
        if (*end == '(')
            if (const char* const close = std::strchr(end, ')')) end = close + 1;
        if (!std::strchr(" )],;:", *end) && !(*end == '.' && (end[1] == ' ' || end[1] == 0))) continue;
        std::memcpy(out, "nan", 3);
        out += 3;
        at = end;
        if (*at == 0) break;
    }
    *out = 0;
}

// The length of a text that was cut at `length`, without the part of a character of UTF-8 that may be left at
// its end.
inline std::size_t whole_characters(const char* text, std::size_t length) noexcept {
    for (std::size_t bytes = 1; bytes <= 3 && bytes <= length; ++bytes) {
        const auto byte = static_cast<unsigned char>(text[length - bytes]);
        if (byte >= 0xc0) { // the first of a character
            const std::size_t all = byte < 0xe0 ? 2 : byte < 0xf0 ? 3 : 4;
            return bytes < all ? length - bytes : length;
        }
        if (byte < 0x80) break;
    }
    return length;
}

// vsnprintf for messages. Longer texts are cut, between characters.
inline void write_text(char* text, std::size_t size, const char* pattern, va_list arguments) {
    const int length = std::vsnprintf(text, size, pattern, arguments);
    if (length >= 0 && static_cast<std::size_t>(length) >= size) text[whole_characters(text, size - 1)] = 0;
    write_nan_plainly(text);
}

// printf into a string, for messages with numbers, as in throw Error(code, format("tet %u names ...", t)).
VOX_PRINTF(1)
inline std::string format(const char* pattern, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, pattern);
    write_text(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

[[noreturn]] inline void refuse(const std::string& text) { throw Error(VOX_ERROR_INVALID_ARGUMENT, text); }

// Throws LIMIT, with the name of the number, when it is above `most`.
inline void check_limit(std::uint64_t number, std::uint64_t most, const char* name) {
    if (number > most)
        throw Error(VOX_ERROR_LIMIT,
                    format("%s is %llu, the limit is %llu", name, static_cast<unsigned long long>(number),
                           static_cast<unsigned long long>(most)));
}

// Throws INVALID_ARGUMENT, with the name of the parameter, when `pointer` is null.
inline void require(const void* pointer, const char* name) {
    if (!pointer) refuse(format("%s is null", name));
}

} // namespace vox
