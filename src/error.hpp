// How failures travel inside the library: as exceptions, caught at the C border (border.hpp) and turned
// into a code and a text there.
#pragma once

#include <vox/vox.h>

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

// printf-style text, so that messages carry their numbers: throw Error(code, format("tet %u names ...", t)).
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string format(const char* pattern, ...);

// Sets this thread's vox_last_error() text. Never throws.
void set_last_error(const char* text) noexcept;

} // namespace vox
