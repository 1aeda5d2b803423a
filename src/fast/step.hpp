// What the stages of one step of the fast engine share.
#pragma once

#include "base/parallel.hpp"
#include "fast/engine.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace vox {

inline constexpr std::uint32_t piece_blocks = 2048; // of a piece of a body, at most

struct FastEngine::Step {
    std::span<const Body> bodies;
    std::span<const fast::PreparedBody> prepared;
    const FastSettings& settings;
    std::pmr::vector<Hit>& hits;
    Vec3d origin{};     // of rounded positions as floats; else zero
    std::mutex mutex{}; // of hits and degenerate_

    std::uint32_t worker_count() const noexcept { return settings.workers ? settings.workers->count() : 1; }

    // function(begin, end, worker) for ranges of all items, at once. `work` is that of all items together,
    // `least` what is worth a task of its own.
    template <class Function>
    void for_ranges(std::size_t items, std::size_t work, std::size_t least, Function&& function) const {
        if (items == 0) return;
        if (worker_count() == 1 || work <= least) return function(std::size_t{0}, items, std::uint32_t{0});
        settings.workers->for_ranges(items, std::max<std::size_t>(items * least / work, 1), function);
    }
};

} // namespace vox
