// A hash of contacts that does not depend on their order: the sum of a hash of each, modulo 2^128. The tests
// compare it with that of contacts found otherwise.
#pragma once

#include "base/sampling.hpp"

#include <vox/vox_dist.h>

#include <cstdint>
#include <cstring>

namespace vox::dist {

struct ContactSum {
    void add(const vox_dist_contact& c) noexcept {
        std::uint64_t words[9] = {c.body_a, c.vertex, c.body_b, c.tet, 0, 0, 0, 0, c.interior};
        std::memcpy(&words[4], c.weights, sizeof c.weights);
        std::uint64_t low = 1, high = 2;
        for (const std::uint64_t word : words) {
            low = next_random(low ^= word);
            high = next_random(high += word * 0x9fb21c651e98df25u);
        }
        limbs[0] += low & 0xffffffff;
        limbs[1] += low >> 32;
        limbs[2] += high & 0xffffffff;
        limbs[3] += high >> 32;
        carry();
    }
    void carry() noexcept {
        for (int i = 0; i < 4; ++i) {
            if (i < 3) limbs[i + 1] += limbs[i] >> 32;
            limbs[i] &= 0xffffffff;
        }
    }
    void write(std::uint64_t out[2]) noexcept {
        carry();
        out[0] = limbs[1] << 32 | limbs[0];
        out[1] = limbs[3] << 32 | limbs[2];
    }

    std::uint64_t limbs[4] = {}; // 32 bits each, the lowest first
};

} // namespace vox::dist
