// The random numbers of scenes/, for tests in C++.
#pragma once

#include "scenes/random.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace vox::test {

struct Random {
    std::uint64_t state;

    std::uint64_t next() { return random_next(&state); }
    std::uint32_t below(std::uint32_t count) { return random_below(&state, count); }
    double unit() { return random_unit(&state); }
    float uniform(double min, double max) { return static_cast<float>(min + unit() * (max - min)); }

    // Any finite float, by its bits: all exponents are equally likely, denormals and both zeros occur.
    float any_finite() {
        for (;;) {
            const float value = std::bit_cast<float>(static_cast<std::uint32_t>(next()));
            if (std::isfinite(value)) return value;
        }
    }
};

} // namespace vox::test

using namespace vox::test;
