// Calls of the library, and how a command fails. Bad input gives exit code 1 with the library's error text.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace tool {

class Failure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The exit code, if not 0, of a command that has printed its answer.
struct Verdict {
    int code;
};

// A struct for the library to fill.
template <class T>
T sized() {
    T out{};
    out.struct_size = sizeof out;
    return out;
}

// A number for printf's %llu, whatever type it has on the platform.
inline unsigned long long llu(std::uint64_t number) { return number; }

// Every call of the library goes through here.
inline void check(vox_result result) {
    if (result == VOX_OK) return;
    const std::string words = vox_last_error();
    throw Failure(words.empty() ? vox_result_string(result) : words);
}

} // namespace tool
