// A hash of contacts that does not depend on their order.
#pragma once

#include <vox/vox_dist.h>

#include <cstdint>

namespace vox::dist {

struct ContactSum {
    void add(const vox_scene_contact& contact) noexcept;
    void carry() noexcept;
    void write(std::uint64_t out[2]) noexcept;

    std::uint64_t limbs[4] = {}; // 32 bits each, the lowest first
};

void hash_of_grid(const vox_grid* grid, std::uint64_t out[2]);

} // namespace vox::dist
