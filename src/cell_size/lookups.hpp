// How many cells and points a set of boxes meets in a lattice of cubic cells, as a function of
// the cell size.
//
// A box of sides w, w', w'' placed at random in a lattice of cell size d meets on average exactly
// (w/d + 1)(w'/d + 1)(w''/d + 1) cells. A point beside it, at distances e, e', e'' from it along the axes,
// lies in one of these cells with probability (1 - e/d)(1 - e'/d)(1 - e''/d), which is 0 as soon as one
// factor is not positive. Both are polynomials in 1/d: four sums over all boxes give the cells at any d, and
// four sums for each class of the largest e give the points. No size is averaged, so graded meshes, slivers
// and bodies of unlike resolution need no special care.
#pragma once

#include "base/array.hpp"
#include "cell_size/branch_misses.hpp"
#include "fast/window.hpp"

#include <vox/vox_cell_size.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

// How closely a scene is looked at before its cell size is chosen.
struct SampleBudget {
    std::size_t most_tets;   // about this many tetrahedra give their boxes; in a larger scene a sample does
    std::size_t lookups;     // boxes whose surroundings are looked at
    std::size_t near_points; // points looked at near each of them
    std::size_t far_points;  // points looked at among those that are near none of them
    std::size_t listed;      // boxes whose cells are filled and visited for the lengths of their lists
    std::size_t most_looks;  // looks of tiles into windows, gone through for each cell size
};

// As closely as a model looks at all. The tests hold its counts to within 10 % of the engines' own.
inline constexpr SampleBudget thorough{std::size_t{1} << 18, 4096, 4096, 1024, 512, 4096};

// For vox_suggest_cell_size, of a scene of so many tetrahedra.
SampleBudget usual(vox_cost_model model, std::uint64_t tets) noexcept;

// For a grid, where choosing has to cost less than a step of `tets` tetrahedra.
SampleBudget quick(vox_cost_model model, std::uint64_t tets) noexcept;

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

// How many points lie in the cells that a box meets, from their distances to the box along the axes.
class PointsMet {
public:
    // `scale` is a length of the size of the boxes. Points are summed in classes of their largest distance,
    // each a sixteenth of an octave wide, from scale / 256 on; those further away than 4096 * scale are left
    // out.
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
    // Call once, after the last add(): turns each class into the sum of all classes up to it.
    void finish() noexcept;

    double at(double cell_size) const noexcept;
    double inside() const noexcept { return sums_[0].sum[0]; } // in the box, or nearer than scale / 256

private:
    static constexpr int step_bits = 4;
    static constexpr std::size_t octaves = 20, classes = (octaves << step_bits) + 1;

    // The class of a distance, given as a multiple of the least.
    static std::size_t class_of(double ratio) noexcept {
        return std::min(class_of_ratio(ratio, step_bits), classes);
    }
    void grow(std::size_t to);

    double inverse_least_;
    Array<Moments> sums_; // of the classes up to the last that holds a point
};

// A box that is looked up in the lattice. It reads points there, and tests those of them that it does not
// pass over. Points are ranges of indices in the scene.
struct Lookup {
    double lo[3], hi[3];
    std::uint32_t first_read, last_read;     // [first, last)
    std::uint32_t first_passed, last_passed; // [first, last)
    bool may_meet = true; // whether points of bodies that may collide with its own may be near it: such
                          // lookups are sampled separately
    bool jumps = false;   // whether it is apart from the lookup before, which then read other points
};

// Lookups whose longest side is at least 2^exponent and less than twice that, and that agree in may_meet.
struct SizeClass {
    SizeClass(int exponent, bool may_meet, std::size_t most_samples, std::pmr::memory_resource* memory);

    int exponent;
    bool may_meet;
    double count = 0;         // of lookups, as are all sums here
    double jumped = 0;        // of lookups that jump
    std::uint64_t added = 0;  // calls of Lookups::add()
    Moments cells;            // met
    PointsMet passed, tested; // points read, passed over or tested
    BranchMisses changes;
    Array<Lookup> sample;
};

class Lookups {
public:
    Lookups(const SampleBudget& budget, std::pmr::memory_resource* memory);

    // Adds a lookup that stands for `weight` lookups like it; a sample of each class is kept. Sides are
    // finite.
    void add(const Lookup& lookup, double weight = 1);
    // Call once, after the last add(): looks at the points around the samples. The ids of `points` are the
    // indices that lookups refer to; all points are finite. Estimating occupied() takes an extra pass.
    void count_points(const fast::Points& points, bool count_occupied);

    // How many points count_points() looked at, once for each sample near them.
    std::uint64_t points_looked_at() const noexcept { return points_looked_at_; }

    const Array<SizeClass>& classes() const noexcept { return classes_; }
    double count() const noexcept {
        return sum([](const SizeClass& c) { return c.count; });
    }
    double cells(double cell_size) const noexcept {
        return sum([&](const SizeClass& c) { return c.cells.at(cell_size); });
    }
    double read(double cell_size) const noexcept {
        return sum([&](const SizeClass& c) { return c.passed.at(cell_size) + c.tested.at(cell_size); });
    }
    double candidates() const noexcept { // tested points that are in the boxes themselves
        return sum([](const SizeClass& c) { return c.tested.inside(); });
    }
    double occupied(double cell_size) const noexcept; // estimated number of cells with a point in them
    // Longest sides of the smallest and the largest lookup, to within a factor of two; false where none has a
    // side.
    bool sides(double& smallest, double& largest) const noexcept;

private:
    static constexpr int exponents = 512;

    template <class Value>
    double sum(Value&& value) const noexcept {
        double all = 0;
        for (const SizeClass& c : classes_) all += value(c);
        return all;
    }
    SizeClass& class_of(double side, bool may_meet);
    template <class Around>
    std::size_t count_around(SizeClass& c, double lookups, Around&& around);
    void count_binned(const fast::Points& points, double lookups, bool count_occupied);
    template <class In>
    void count_lists(SizeClass& c, std::size_t wanted, const In& in, Array<BranchMisses::Point>& points);
    template <class In>
    void count_crowds(const SizeClass& c, std::size_t wanted, double near, const In& in,
                      double points_per_lookup);

    SampleBudget budget_;
    Array<SizeClass> classes_;                      // that occur
    std::array<std::int16_t, 2 * exponents> index_; // in classes_; -1: none
    std::uint64_t random_ = 0, points_looked_at_ = 0;
    // Occupied cells at sizes that are evenly spaced in the logarithm.
    static constexpr std::size_t occupied_sizes = 64;
    double first_size_ = 1, size_ratio_ = 2;
    std::array<double, occupied_sizes> occupied_{};
};

} // namespace vox
