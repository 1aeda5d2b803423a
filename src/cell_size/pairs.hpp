// Sums over all pairs of a box that asks and a box that is held, by samples of both (moments.hpp has the
// formulas), and which cells have a box in them.
#pragma once

#include "base/array.hpp"
#include "base/sampling.hpp"
#include "cell_size/moments.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>

namespace vox {

// How closely a scene is looked at before its cell size is chosen.
struct SampleBudget {
    std::uint64_t summed; // boxes that are summed up
    std::uint64_t held;   // boxes or points that are kept, of those held
    std::uint64_t asking; // and of boxes that ask, of which
    std::size_t chosen;   // so many are looked at with what is around them,
    double coarse;        // and so coarsely (SampleTree::sample_around)
    std::size_t cells;    // cells looked at for what is in them, or boxes for their cells, at each size
    double rough;         // how roughly it is counted (SampleTree::count_meeting)
    std::size_t singly;   // cells looked at for whether there is anything in them, where those of some
                          // positions of the lattice are no more
};

struct PlainBox {
    double lo[3], hi[3];

    double side(int axis) const noexcept { return hi[axis] - lo[axis]; }
    double longest_side() const noexcept { return std::max(std::max(side(0), side(1)), side(2)); }
    void grow(double by) noexcept {
        for (int a = 0; a < 3; ++a) {
            lo[a] -= by;
            hi[a] += by;
        }
    }
    PlainBox centre() const noexcept { // as a box without sides
        PlainBox point;
        for (int a = 0; a < 3; ++a) point.lo[a] = point.hi[a] = lo[a] + (hi[a] - lo[a]) / 2;
        return point;
    }
    void include(const PlainBox& other) noexcept {
        for (int a = 0; a < 3; ++a) {
            lo[a] = std::min(lo[a], other.lo[a]);
            hi[a] = std::max(hi[a], other.hi[a]);
        }
    }
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

inline constexpr double endless = std::numeric_limits<double>::infinity();
// They are away from everything, and add nothing to a box.
inline constexpr FourBoxes no_boxes{{{endless, endless, endless, endless},
                                     {endless, endless, endless, endless},
                                     {endless, endless, endless, endless}},
                                    {{-endless, -endless, -endless, -endless},
                                     {-endless, -endless, -endless, -endless},
                                     {-endless, -endless, -endless, -endless}}};

// Boxes in an order along which neighbours are near, with the boxes of each 4, 16, 64, ... of them.
class SampleTree {
public:
    explicit SampleTree(std::pmr::memory_resource* memory) : added_(memory), groups_(memory), ids_(memory) {}

    // Boxes are added in the order of their ids, which are less than 2^32.
    void reserve(std::size_t count) {
        added_.reserve(count);
        ids_.reserve(count);
    }
    void add(const PlainBox& box, std::uint64_t id) {
        added_.push_back(box);
        ids_.push_back(static_cast<std::uint32_t>(id));
    }
    const Array<PlainBox>& added() const noexcept { return added_; }
    // Call once, after the last add(), of some of `of_all` boxes. Keeps about `most` of them, or their
    // centres.
    void build(bool centres, double of_all, std::uint64_t most = ~std::uint64_t{0});

    std::size_t size() const noexcept { return ids_.size(); }
    double share() const noexcept { return share_; }
    PlainBox box(std::size_t i) const noexcept { return groups_[i / 4].get(i % 4); }
    const FourBoxes& four(std::size_t first) const noexcept { return groups_[first / 4]; }
    std::uint32_t id(std::size_t i) const noexcept { return ids_[i]; }
    const std::uint32_t* ids() const noexcept { return ids_.data(); }
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

    // How many boxes meet a cube [lo, lo + side) along each axis; at least `enough` where there are more. Of
    // groups on its boundary that are smaller than `rough` times what was found before, half are taken to
    // meet it.
    double count_meeting(const double (&lo)[3], double side, double rough,
                         double enough = endless) const noexcept;
    bool meets_any(const double (&lo)[3], double side) const noexcept {
        return count_meeting(lo, side, 0, 1) > 0;
    }

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
    Array<PlainBox> added_;                            // until build()
    Array<FourBoxes> groups_;
    Array<std::uint32_t> ids_;
    PlainBox bounds_{};
    double share_ = 1;
};

// Calls add(four boxes, their ids, how many boxes each of them stands for) for boxes around one,
// as SampleTree::sample_around.
template <class Add>
void for_fours_around(const PlainBox& box, const SampleTree& held, double coarse, std::uint64_t& random,
                      Add&& add) {
    FourBoxes some{}; // those that stand for others, until there are four
    std::uint32_t ids[4];
    double numbers[4];
    std::size_t gathered = 0;
    constexpr double once[4] = {1, 1, 1, 1};
    held.sample_around(
        box, coarse, random,
        [&](std::size_t first, std::size_t count) {
            if (count == 4) return add(held.four(first), held.ids() + first, once);
            std::uint32_t last_ids[4] = {};
            double last_numbers[4] = {};
            std::copy_n(held.ids() + first, count, last_ids);
            std::copy_n(once, count, last_numbers);
            add(held.four(first), last_ids, last_numbers);
        },
        [&](std::size_t i, double number) {
            some.set(gathered, held.box(i));
            ids[gathered] = held.id(i);
            numbers[gathered] = number;
            if (++gathered < 4) return;
            add(some, ids, numbers);
            gathered = 0;
        });
    std::fill(ids + gathered, ids + 4, 0u);
    std::fill(numbers + gathered, numbers + 4, 0.0);
    if (gathered > 0) add(some, ids, numbers);
}

// Adds the cells that a box has in common with each of four others, which count `weights` times.
inline void add_common_cells(const PlainBox& box, const FourBoxes& others, const double (&weights)[4],
                             PiecewiseMoments& sums) {
    double gap[3][4], most[4], moments[4][4];
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 4; ++i)
            gap[k][i] = std::max(box.lo[k], others.lo[k][i]) - std::min(box.hi[k], others.hi[k][i]);
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = gap[0][i], y = gap[1][i], z = gap[2][i], w = weights[i];
        most[i] = std::max(std::max(x, y), z);
        moments[0][i] = w; // (1 - x/d) (1 - y/d) (1 - z/d)
        moments[1][i] = -w * (x + y + z);
        moments[2][i] = w * (x * y + (x + y) * z);
        moments[3][i] = -w * (x * y * z);
    }
    for (std::size_t i = 0; i < 4; ++i)
        if (weights[i] > 0) sums.add(most[i], {{moments[0][i], moments[1][i], moments[2][i], moments[3][i]}});
}

// ---- who asks -------------------------------------------------------------------------------------

// A box that asks a part of a list of points, from `first` to before `last`, or all but these.
struct AskingBox {
    PlainBox box;
    std::uint32_t kind;
    std::uint32_t first, last;
    double weight; // how many like it there are
};

// A box that asks, standing for `weight` like it.
struct Asking {
    std::size_t index; // in a list
    double weight;
};

// About `wanted` of some things of which each stands for `each` like it, so that each kind has its part:
// half of the places go to the kinds by their number, half evenly. A few large boxes, or few that are close
// together, can cost as much as many others. The weights add up to the number that all stand for.
Array<Asking> choose_of_kinds(std::span<const std::uint32_t> kind_of, std::size_t wanted, double each,
                              std::pmr::memory_resource* memory);

// By kinds of size and of surroundings.
Array<Asking> choose_asking(const SampleTree& tree, std::size_t wanted, std::pmr::memory_resource* memory);

// Sums over all pairs of boxes in `asking`, a part of those in `from`, and boxes in `held`, as coarsely as
// SampleTree::sample_around: cells in common, or with `around`, of points, whether their cells are the same
// or neighbours. With `same_set`, pairs of a box with itself (the same id) are left out.
PiecewiseMoments sum_pairs(const SampleTree& from, const Array<Asking>& asking, const SampleTree& held,
                           double coarse, bool around, bool same_set, std::pmr::memory_resource* memory);

// ---- what is in cells -----------------------------------------------------------------------------

// How many are in a cell, N, from cells that are sampled. In some, N is known, or what it is asked for. In
// the others only a part of all was counted: a count of a part p of them has p times the mean of N, and p^2
// times the mean of N (N - 1). With these two, N is taken to follow a negative binomial distribution, or a
// binomial one where it varies less than by chance.
class CellCounts {
public:
    void add_known(double weight, double weighted) noexcept {
        known_weight_ += weight;
        known_ += weighted;
    }
    void add_part(double weight, double n, double n_times_less_one) noexcept {
        weight_ += weight;
        mean_ += weight * n;
        factorial_ += weight * n_times_less_one;
    }
    double none() const noexcept;         // probability that N is 0
    double mean_inverse() const noexcept; // of 1 / (1 + N)

private:
    double excess() const noexcept;
    double known_weight_ = 0, known_ = 0;
    double weight_ = 0, mean_ = 0, factorial_ = 0;
};

// Sets the lower corner of one of the cells that a box meets in a lattice of some position, all equally
// likely, and returns how many there are. With `around`, of these and of all their neighbours.
double some_cell(const PlainBox& box, double d, bool around, std::uint64_t& random, double (&lo)[3]) noexcept;

// Looks at cells of `cells` of the chosen boxes of a tree, as roughly as SampleTree::count_meeting, for
// occupied cells for each entry of a box in a cell: `counts.mean_inverse()`. `other`: a further tree that is
// in the same cells, or null. Where the trees have only a part of all boxes, cells with more than `crowd`
// boxes of these count by themselves, and the others together.
void look_at_entries(const SampleTree& own, const SampleTree* other, const Array<Asking>& chosen,
                     std::size_t cells, double size, double rough, double crowd, std::uint64_t& random,
                     CellCounts& counts) noexcept;

// A share that takes long to count, from its values at sizes an octave apart.
class ShareTable {
public:
    // From `margin` octaves below `range` to as many above.
    ShareTable(const CellSizeRange& range, double margin, std::pmr::memory_resource* memory)
        : least_(range.min), margin_(margin),
          values_(static_cast<std::size_t>(std::log2(range.max / range.min) + 2 * margin) + 3, -1.0, memory) {
    }

    // count(size) is called for sizes that are needed and not known, and directly for those beyond the table.
    template <class Count>
    double at(double d, Count&& count) {
        const double place = std::log2(d / least_) + margin_;
        if (!(place >= 0 && place < static_cast<double>(values_.size() - 1))) return count(d);
        const auto node = static_cast<std::size_t>(place);
        const auto known = [&](std::size_t i) {
            if (values_[i] < 0) values_[i] = count(least_ * std::exp2(static_cast<double>(i) - margin_));
            return values_[i];
        };
        const double below = known(node), above = known(node + 1), part = place - static_cast<double>(node);
        // The logarithm is more nearly straight, where there is one.
        return below > 0 && above > 0 ? below * std::pow(above / below, part)
                                      : below + part * (above - below);
    }

private:
    double least_, margin_;
    Array<double> values_; // -1: not known yet
};

} // namespace vox
