// Mesh ids: slot and generation in 32 bits. The slot is in the high bits, so that ids sort by slot;
// generations start at 1, so that no id is VOX_NULL_BODY.
#pragma once

#include <vox/vox.h>

namespace vox {

constexpr std::uint32_t generation_bits = 12;
constexpr std::uint32_t most_generations = (1u << generation_bits) - 1; // uses of a slot before it is retired
static_assert(VOX_MAX_BODIES == 1u << (32 - generation_bits));

constexpr vox_body make_id(std::uint32_t slot, std::uint32_t generation) noexcept {
    return slot << generation_bits | generation;
}
constexpr std::uint32_t slot_of(vox_body id) noexcept { return id >> generation_bits; }
constexpr std::uint32_t generation_of(vox_body id) noexcept { return id & most_generations; }

} // namespace vox
