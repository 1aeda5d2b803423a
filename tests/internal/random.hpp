// Reproducible random numbers for tests: the same on every compiler and library.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

struct Random { // splitmix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA
                // 2014
    std::uint64_t state;

    std::uint64_t next() {
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(next() % count); }
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    float uniform(double min, double max) { return static_cast<float>(min + unit() * (max - min)); }

    // Any finite float, by its bits: all exponents alike, denormals and both zeros among them.
    float any_finite() {
        for (;;) {
            const float value = std::bit_cast<float>(static_cast<std::uint32_t>(next()));
            if (std::isfinite(value)) return value;
        }
    }
};
