// How large tiles are.
#pragma once

#include "base/boxes.hpp"

namespace vox {

// The harmonic mean of the sides of tiles: a few that reach across the world have little weight.
struct TileSize {
    double inverse_sum = 0, count = 0;

    // Adds `tiles` tiles of the size of `box`.
    void add(const Box& box, double tiles = 1) noexcept {
        const double sides = (double{box.hi[0]} - double{box.lo[0]}) +
                             (double{box.hi[1]} - double{box.lo[1]}) +
                             (double{box.hi[2]} - double{box.lo[2]});
        if (!(sides > 0)) return;
        inverse_sum += tiles * (3 / sides);
        count += tiles;
    }
    void add(const TileSize& other) noexcept {
        inverse_sum += other.inverse_sum;
        count += other.count;
    }
    double mean() const noexcept { return count > 0 ? count / inverse_sum : 0; }
};

} // namespace vox
