// How closely a scene is looked at before its cell size is chosen.
#pragma once

#include "cell_size/lookups.hpp"

#include <cstddef>
#include <cstdint>

namespace vox {

struct SampleBudget {
    std::size_t most_tets;  // whose boxes are taken, about; of more, some from everywhere
    SampleSizes sample;     // of which the surroundings are
    std::size_t most_looks; // of tiles into windows, gone through for each cell size
    bool tabulated;         // the curve from a table of a few costs
};

// For a person who asks.
inline constexpr SampleBudget thorough{std::size_t{1} << 18, {4096, 4096, 1024, 512}, 4096, false};

// Within a step, where choosing has to cost less than that step.
SampleBudget quick(std::uint64_t tets) noexcept;
// The same for the model of the fast engine, whose steps are shorter; its lookups are fewer and more alike
// and its cost is flat.
SampleBudget quick_tiles(std::uint64_t tets) noexcept;

} // namespace vox
