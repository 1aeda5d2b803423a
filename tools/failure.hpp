// How a command fails. Bad input gives exit code 1 with the library's error text.
#pragma once

#include <vox/vox.h>

#include <stdexcept>
#include <string>

namespace tool {

class Failure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The exit code of a command that has printed its answer, where that is not 0.
struct Verdict {
    int code;
};

// Every call of the library goes through here.
inline void check(vox_result result) {
    if (result == VOX_OK) return;
    const std::string words = vox_last_error();
    throw Failure(words.empty() ? vox_result_string(result) : words);
}

} // namespace tool
