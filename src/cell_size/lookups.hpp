// How many cells, rows of cells and points a set of boxes meets in a lattice of cubic cells, as a function of
// the cell size.
//
// A box of sides w, w', w'' laid at random into a lattice of cell size d meets (w/d + 1)(w'/d + 1)(w''/d + 1)
// cells in the mean, exactly; and a point beside it, at distances e, e', e'' from it along the axes, lies in
// one of these cells with probability (1 - e/d)(1 - e'/d)(1 - e''/d), and with 0 as soon as one factor is not
// positive. Both are polynomials in 1/d, so that four sums over all boxes give the cells at any d; and four
// sums for each class of the largest e give the points. No mean size is taken anywhere: graded meshes,
// slivers and bodies of unlike resolution come out as they are.
#pragma once

#include "cell_size/branch_misses.hpp"

#include "fast/window.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

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

// Cells, and rows of cells along x, that a box of these sides meets.
inline Moments cells_met(const double (&w)[3]) noexcept {
    return {{1, w[0] + w[1] + w[2], w[0] * w[1] + w[1] * w[2] + w[2] * w[0], w[0] * w[1] * w[2]}};
}
inline Moments rows_met(const double (&w)[3]) noexcept { return {{1, w[1] + w[2], w[1] * w[2], 0}}; }

// Points met, from their distances to the box along the axes.
class PointsMet {
public:
    // Sums of points by the largest of their distances, in classes of a sixteenth of an octave from `scale` /
    // 256 on, where `scale` is a length of the size of the boxes; points further away than 4096 times that do
    // not count.
    PointsMet(double scale, std::pmr::memory_resource* memory)
        : inverse_least_(256 / scale), sums_(1, memory) {}

    void add(const double (&e)[3], double weight) {
        const std::size_t c = class_of(std::max(std::max(e[0], e[1]), e[2]) * inverse_least_);
        if (c == classes) return;
        if (c >= sums_.size()) grow(c);
        Moments& m = sums_[c];
        const double both = e[0] * e[1];
        m.sum[0] += weight;
        m.sum[1] -= weight * (e[0] + e[1] + e[2]);
        m.sum[2] += weight * (both + (e[0] + e[1]) * e[2]);
        m.sum[3] -= weight * (both * e[2]);
    }
    // Once, after the last add(): makes of each class the sum of all up to it.
    void finish() noexcept;

    double at(double cell_size) const noexcept;
    double inside() const noexcept { return sums_[0].sum[0]; } // or as good as

private:
    static constexpr std::size_t octaves = 20, steps = 16, classes = octaves * steps + 1;

    // Of a distance, given over the least. Octave and sixteenth are the bits above the rest of the mantissa:
    // even within an octave, not in the logarithm, which does not matter.
    static constexpr int rest_bits = 48;
    static std::size_t class_of(double ratio) noexcept {
        if (!(ratio >= 1)) return 0;
        const std::uint64_t c = (std::bit_cast<std::uint64_t>(ratio) >> rest_bits) -
                                (std::uint64_t{1023} << (52 - rest_bits)) + 1;
        return c < classes ? static_cast<std::size_t>(c) : classes;
    }
    void grow(std::size_t to);

    double inverse_least_;
    std::pmr::vector<Moments> sums_; // of the first class and all up to the last with any
};

// Something that is looked up in the lattice: a box, the points that it looks at there, and those of them
// that it does not test. Points by their index in the scene.
struct Lookup {
    double lo[3], hi[3];
    std::uint32_t first_read, last_read;     // [first, last)
    std::uint32_t first_passed, last_passed; // [first, last)
    bool may_meet = true; // points that it tests may be near it: such lookups are sampled for themselves
    bool jumps = false;   // it is away from the one before, so that what it meets was not looked at just now
};

// Lookups whose longest side is at least 2^exponent and less than twice that, and that may meet something, or
// not.
struct SizeClass {
    SizeClass(int exponent, bool may_meet, std::size_t most_samples, std::pmr::memory_resource* memory);

    int exponent;
    bool may_meet;
    double count = 0;        // of lookups
    double jumped = 0;       // of them, those that jump
    std::uint64_t added = 0; // of calls that gave them
    Moments cells, rows;     // of all lookups of the class together, as the points are
    PointsMet passed, tested;
    BranchMisses changes;
    std::pmr::vector<Lookup> sample;
};

// How much is looked at: lookups whose surroundings are, points near each of them, and points in what is far
// from them all.
struct SampleSizes {
    std::size_t lookups, near_points, far_points;
    std::size_t listed = 0; // lookups whose cells are filled and gone through
};

// Whether it is told how many cells have a point in them, which takes a look of its own.
enum class Occupied : bool { not_counted, counted };

class Lookups {
public:
    Lookups(const SampleSizes& sizes, std::pmr::memory_resource* memory);

    // A lookup that stands for `weight` of its like, one by one; some of each class are kept as a sample.
    // Sides are finite.
    void add(const Lookup& lookup, double weight = 1);
    // Once, when all are there: the points around the samples. `points` are those of the scene, their ids
    // what the lookups mean by an index; all are finite.
    void count_points(const fast::Points& points, Occupied occupied);

    // How many points were looked at for that, once for each sample.
    std::uint64_t points_looked_at() const noexcept { return points_looked_at_; }

    const std::pmr::vector<SizeClass>& classes() const noexcept { return classes_; }
    double count() const noexcept;
    double cells(double cell_size) const noexcept;
    double rows(double cell_size) const noexcept;
    double read(double cell_size) const noexcept;
    double tested(double cell_size) const noexcept;
    double candidates() const noexcept;               // tested points that are in the boxes themselves
    double occupied(double cell_size) const noexcept; // cells with a point in them, in all the world, about
    // Sides of lookups that have any, to within a factor of two; false: none has.
    bool sides(double& smallest, double& largest) const noexcept;

private:
    static constexpr int exponents = 512;

    SizeClass& class_of(double side, bool may_meet);
    template <class Around>
    std::size_t count_around(SizeClass& c, double lookups, Around&& around);
    void count_binned(const fast::Points& points, double lookups, Occupied occupied);
    template <class In>
    void count_lists(SizeClass& c, std::size_t wanted, const In& in,
                     std::pmr::vector<BranchMisses::Point>& points);
    template <class In>
    void count_crowds(const SizeClass& c, std::size_t wanted, double near, const In& in,
                      double points_per_lookup);

    SampleSizes sizes_;
    std::pmr::vector<SizeClass> classes_;           // those that occur
    std::array<std::int16_t, 2 * exponents> index_; // in classes_; -1: none
    std::uint64_t random_ = 0, points_looked_at_ = 0;
    // Of cells with a point, for cell sizes that are even in the logarithm.
    static constexpr std::size_t occupied_sizes = 64;
    double first_size_ = 1, size_ratio_ = 2;
    std::array<double, occupied_sizes> occupied_{};
};

} // namespace vox
