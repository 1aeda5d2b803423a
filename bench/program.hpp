// Failures: a failed call of the library becomes an exception, and an exception ends the program with a line
// of text.
#pragma once

#include <vox/vox.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

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

// What the benchmarks of single stages are asked for.
struct Size {
    double tets;
    int rounds;
};

// Reads --tets and --rounds into `size`. Anything else: the usage goes to stderr, and false is returned.
inline bool read_size(int argc, char** argv, const char* name, Size& size) {
    for (int i = 1; i < argc; i += 2) {
        const std::string option = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
        if (option == "--tets" && std::atof(value.c_str()) >= 1000)
            size.tets = std::atof(value.c_str());
        else if (option == "--rounds" && std::atoi(value.c_str()) > 0)
            size.rounds = std::atoi(value.c_str());
        else {
            std::fprintf(stderr, "usage: %s [--tets N >= 1000] [--rounds K]\n", name);
            return false;
        }
    }
    return true;
}

} // namespace bench
