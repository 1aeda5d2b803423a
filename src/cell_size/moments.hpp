// How many cells boxes meet in a lattice of cubic cells, and have in common, on average over all positions of
// the lattice, as functions of the cell size d. All cost models count by these formulas.
//
// A box of sides w, w', w'' meets (w/d + 1)(w'/d + 1)(w''/d + 1) cells. Along an axis, two intervals that
// overlap by o have o/d + 1 cells in common. Two that are apart by g have one where no plane of the lattice
// is between them: with probability 1 - g/d, or 0. With the signed gap e, which is -o or g, both are
// max(0, 1 - e/d), and the axes are independent. A point is a box without sides: it is in a cell that the box
// meets with this probability. Centres at a distance x along an axis are in the same cell with probability
// max(0, 1 - x/d), and in cells that are the same or neighbours with max(0, 2 - x/d) - max(0, 1 - x/d):
// 2 - x/d from d = x/2 on, and 1 from d = x on.
//
// So every box and every pair is a polynomial in 1/d, the latter from some cell size on. Sums of such
// polynomials, in narrow classes of that size, give the sum over all boxes and pairs at every d at once. No
// size is averaged, so graded meshes, slivers and bodies of unlike resolution need no special care.
#pragma once

#include "base/array.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

// sum[0] + sum[1] / d + sum[2] / d^2 + sum[3] / d^3
struct Moments {
    double sum[4] = {0, 0, 0, 0};

    double at(double d) const noexcept {
        const double inverse = 1 / d;
        return ((sum[3] * inverse + sum[2]) * inverse + sum[1]) * inverse + sum[0];
    }
    void add(const Moments& other, double weight = 1) noexcept {
        for (int i = 0; i < 4; ++i) sum[i] += weight * other.sum[i];
    }
};

// Cells that a box of these sides meets.
inline Moments cells_met(const double (&w)[3]) noexcept {
    return {{1, w[0] + w[1] + w[2], w[0] * w[1] + w[1] * w[2] + w[2] * w[0], w[0] * w[1] * w[2]}};
}

// Distances from a box up to this part of its size are no different from none.
inline constexpr double nearest_distance = 1.0 / 256;

// A sum of polynomials in 1/d, each from a cell size on.
class PiecewiseMoments {
public:
    // Sizes from `least` up to so many octaves above it differ. Smaller ones count as `least`, larger ones as
    // never.
    PiecewiseMoments(double least, std::size_t octaves, std::pmr::memory_resource* memory)
        : inverse_least_(1 / least), sums_((octaves << step_bits) + 1, memory) {}

    // Adds (c[0] - s[0]/d) (c[1] - s[1]/d) (c[2] - s[2]/d) for d >= from, `weight` times.
    void add(double from, const double (&c)[3], const double (&s)[3], double weight) noexcept {
        const double one = c[0] * s[1] + s[0] * c[1], two = s[0] * s[1], none = c[0] * c[1];
        add(from, {{weight * none * c[2], -weight * (one * c[2] + none * s[2]),
                    weight * (two * c[2] + one * s[2]), -weight * two * s[2]}});
    }
    void add(double from, const Moments& polynomial) noexcept {
        ++added_;
        const std::size_t index = class_of(from * inverse_least_);
        if (index < sums_.size()) sums_[index].add(polynomial);
    }
    std::uint64_t added() const noexcept { return added_; } // how often add() was called
    // Call once, after the last add(): turns each class into the sum of all up to it.
    void finish() noexcept;
    double at(double d) const noexcept;
    // The sum where d is next to nothing: of those from `least` or less on.
    double at_least() const noexcept { return sums_[0].sum[0]; }

private:
    static constexpr int step_bits = 4; // sixteen classes an octave

    // The class of a size, given as a multiple of the least: 0 below 1, from there on each octave has classes
    // of equal width.
    static std::size_t class_of(double ratio) noexcept {
        if (!(ratio >= 1)) return 0;
        const std::uint64_t octave_and_part = std::bit_cast<std::uint64_t>(ratio) >> (52 - step_bits);
        return static_cast<std::size_t>(octave_and_part - (std::uint64_t{1023} << step_bits) + 1);
    }

    double inverse_least_;
    std::uint64_t added_ = 0;
    Array<Moments> sums_; // of each class
};

} // namespace vox
