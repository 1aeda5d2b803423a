// Failures: a failed call of the library becomes an exception, and an exception ends the program with a line
// of text.
#pragma once

#include <vox/vox.h>

#include <cstdio>
#include <exception>
#include <stdexcept>

namespace bench {

inline void must(vox_result result) {
    if (result != VOX_OK) throw std::runtime_error(vox_last_error());
}

// What main() returns: what run() does, or 1 where it throws.
template <class Run>
int run_program(const char* name, const Run& run) {
    try {
        return run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
        return 1;
    }
}

} // namespace bench
