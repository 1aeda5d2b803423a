// How many cells two boxes have in common in a lattice of cubic cells, on average over all its positions and
// summed over all pairs of a box that asks and a box that is held, as a function of the cell size d.
//
// Along an axis, two intervals that overlap by o have o/d + 1 cells in common. Two that are apart by g have
// one where no plane of the lattice is between them: with probability 1 - g/d, or 0. With the signed gap e,
// which is -o or g, both are max(0, 1 - e/d), and the axes are independent. Centres at a distance x along an
// axis are in the same cell with probability max(0, 1 - x/d), and in cells that are the same or neighbours
// with max(0, 2 - x/d) - max(0, 1 - x/d): 2 - x/d from d = x/2 on, and 1 from d = x on.
//
// So every pair is a polynomial in 1/d that changes at some sizes. Sums of such polynomials, in narrow
// classes of the size where they change, give the sum over all pairs at every d at once.
#pragma once

#include "base/array.hpp"
#include "base/sampling.hpp"
#include "cell_size/foreign/primitives.hpp"
#include "cell_size/lookups.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

// A sum of polynomials in 1/d, each from a cell size on.
class PiecewiseMoments {
public:
    // Sizes from `largest` down to 2^-32 of it differ; smaller ones count as that.
    PiecewiseMoments(double largest, std::pmr::memory_resource* memory)
        : inverse_least_(0x1p32 / largest), sums_(classes, memory) {}

    // Adds (c[0] - s[0]/d) (c[1] - s[1]/d) (c[2] - s[2]/d) for d >= from, `weight` times.
    void add(double from, const double (&c)[3], const double (&s)[3], double weight) noexcept {
        const double one = c[0] * s[1] + s[0] * c[1], two = s[0] * s[1], none = c[0] * c[1];
        add(from, {{weight * none * c[2], -weight * (one * c[2] + none * s[2]),
                    weight * (two * c[2] + one * s[2]), -weight * two * s[2]}});
    }
    void add(double from, const Moments& polynomial) noexcept {
        ++added_;
        const std::size_t index = class_of_ratio(from * inverse_least_, step_bits);
        if (index < classes) sums_[index].add(polynomial);
    }
    std::uint64_t added() const noexcept { return added_; } // how often add() was called
    // Call once, after the last add(): turns each class into the sum of all up to it.
    void finish() noexcept;
    double at(double d) const noexcept;

private:
    static constexpr int step_bits = 4; // sixteen classes an octave
    static constexpr std::size_t classes = (std::size_t{34} << step_bits) + 1;

    double inverse_least_;
    std::uint64_t added_ = 0;
    Array<Moments> sums_;
};

// Four boxes side by side: compilers make vectors of loops over them.
struct FourBoxes {
    double lo[3][4], hi[3][4];

    PlainBox get(std::size_t i) const noexcept {
        return {{lo[0][i], lo[1][i], lo[2][i]}, {hi[0][i], hi[1][i], hi[2][i]}};
    }
    void set(std::size_t i, const PlainBox& box) noexcept {
        for (int a = 0; a < 3; ++a) {
            lo[a][i] = box.lo[a];
            hi[a][i] = box.hi[a];
        }
    }
};

// Boxes in an order along which neighbours are near, with the boxes of each 4, 16, 64, ... of them.
class SampleTree {
public:
    // Of boxes that are `share` of all there are. With `centres`, of their centres.
    SampleTree(const BoxSample& sample, bool centres, double share, std::pmr::memory_resource* memory);

    std::size_t size() const noexcept { return ids_.size(); }
    double share() const noexcept { return share_; }
    PlainBox box(std::size_t i) const noexcept { return groups_[i / 4].get(i % 4); }
    const FourBoxes& four(std::size_t first) const noexcept { return groups_[first / 4]; }
    std::uint32_t id(std::size_t i) const noexcept { return ids_[i]; }
    const PlainBox& bounds() const noexcept { return bounds_; }
    // Longest side of the box of the 16 or fewer boxes that this one is kept with.
    double crowd_side(std::size_t i) const noexcept;

    // Visits boxes of which each stands for a number like it: all that are near the given box, and one out of
    // each group whose longest side is at most `coarse` times its distance or half the given box. Of few
    // boxes all are visited. Calls four(first, count) for boxes that stand for themselves, and one(index,
    // number) for the others.
    template <class Four, class One>
    void sample_around(const PlainBox& box, double coarse, std::uint64_t& random, Four&& four,
                       One&& one) const {
        const double half = box.longest_side() / 2;
        const bool is_small = size() <= exact_size;
        Place stack[most_stacked];
        int top = 0;
        stack[top++] = {levels_ - 1, 0};
        while (top > 0) {
            const Place p = stack[--top];
            if (p.level == 0) {
                four(4 * p.group, count_in(p));
                continue;
            }
            const FourBoxes& group = groups_[first_[p.level] + p.group];
            double gap[4], side[4];
            for (std::size_t i = 0; i < 4; ++i) {
                gap[i] = half;
                side[i] = 0;
            }
            for (int k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < 4; ++i) {
                    const double lo = group.lo[k][i], hi = group.hi[k][i];
                    gap[i] = std::max(gap[i], std::max(lo, box.lo[k]) - std::min(hi, box.hi[k]));
                    side[i] = std::max(side[i], hi - lo);
                }
            for (std::size_t i = 0; i < count_in(p); ++i) {
                const Place child{p.level - 1, 4 * p.group + i};
                if (!is_small && side[i] <= coarse * gap[i]) {
                    const std::size_t boxes = boxes_in(child);
                    const std::uint64_t drawn = (next_random(random) >> 32) * boxes >> 32;
                    one(first_box(child) + static_cast<std::size_t>(drawn), static_cast<double>(boxes));
                } else {
                    stack[top++] = child;
                }
            }
        }
    }

    // How many boxes meet a cube [lo, lo + side) along each axis. Of groups on its boundary that are smaller
    // than `rough` times what was found before, half are taken to meet it.
    double count_meeting(const double (&lo)[3], double side, double rough) const noexcept;
    bool meets_any(const double (&lo)[3], double side) const noexcept;

private:
    struct Place { // a group of four boxes, each of which holds a group of the level below
        std::size_t level, group;
    };
    static constexpr std::size_t exact_size = 256; // of so few boxes, each is looked at
    static constexpr std::size_t most_levels = 16;
    static constexpr int most_stacked = 4 * 16; // three of each level stay while the fourth is looked at

    static std::size_t first_box(const Place& p) noexcept { return p.group << (2 * (p.level + 1)); }
    std::size_t boxes_in(const Place& p) const noexcept {
        return std::min(size() - first_box(p), std::size_t{4} << (2 * p.level));
    }
    // Boxes of its own level in a group.
    std::size_t count_in(const Place& p) const noexcept {
        const std::size_t all = p.level == 0 ? size() : first_[p.level] - first_[p.level - 1];
        return std::min<std::size_t>(all - 4 * p.group, 4);
    }

    std::size_t levels_ = 0;
    std::array<std::size_t, most_levels + 1> first_{}; // group of each level; those of the boxes come first
    Array<FourBoxes> groups_;
    Array<std::uint32_t> ids_;
    PlainBox bounds_{};
    double share_;
};

// A box that asks, standing for `weight` like it.
struct Asking {
    std::size_t index; // in a tree
    double weight;
};

// About `wanted` boxes of a tree, so that each kind of size and of surroundings has its part. The weights add
// up to the number that the tree stands for.
Array<Asking> choose_asking(const SampleTree& tree, std::size_t wanted, std::pmr::memory_resource* memory);

enum class Meeting : std::uint8_t {
    in_cells,      // of boxes: cells in common
    in_neighbours, // of points: whether their cells are the same or neighbours
};

// Sums over all pairs of boxes in `asking`, a part of those in `from`, and boxes in `held`, as coarsely as
// SampleTree::sample_around. With `same_set`, pairs of a box with itself (the same id) are left out.
PiecewiseMoments sum_pairs(const SampleTree& from, const Array<Asking>& asking, const SampleTree& held,
                           double coarse, Meeting meeting, bool same_set, std::pmr::memory_resource* memory);

} // namespace vox
