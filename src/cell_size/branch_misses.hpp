// How often a visited cell's list of points is of another length than the one visited just before: where the
// end of a list comes as it came last, the processor foretells it, and fetches what follows meanwhile.
//
// That depends on how regular the points are at the scale of a cell. Of points at random the share is a
// smooth function of their number in a cell; those of a mesh cut from a lattice lie two and two in every
// cell as large as a cube of it. No mean tells the two apart, so the cells of a few sampled boxes are filled
// and gone through, in the order of the engine, at sizes around those of the boxes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

class BranchMisses {
public:
    // Of boxes whose longest side is from `scale` to twice that.
    explicit BranchMisses(double scale) : scale_(scale) {}

    // Cell sizes that are looked at; a point further from a box than one is in no cell of that size.
    double first_size() const noexcept { return cell_size(0); }
    double last_size() const noexcept { return cell_size(sizes - 1); }
    // The most points near one box; where they are more the larger sizes are left out.
    static constexpr std::size_t most_points = 256;

    // In units of the scale, which keeps any scene's numbers small.
    struct Point {
        float at[3];    // from the box's lower corner
        float distance; // from the box, the largest along an axis
    };
    double scale() const noexcept { return scale_; }
    // The surroundings of one box: all points that are nearer than `known`, most_points at most. A corner of
    // a cell lies at 0, as in hashed storage.
    void add(const double (&lo)[3], const double (&hi)[3], std::span<const Point> points, double known);
    // Once, after the last add(). A size that is followed only roughly should not be chosen for a length of
    // lists that it has there alone: so a share is the mean over the sizes around, too.
    void finish() noexcept;

    // The nearest of the sizes looked at; 0: none was.
    double nearest(double cell_size) const noexcept;
    // The share of visits at one of these.
    double share(double cell_size) const noexcept;
    // About what it is where `mean` points of a mesh lie in a cell, as irregular as those of mesh generators:
    // fitted. Few points are alone in their cell, and make two changes each.
    static double of_irregular(double mean) noexcept { return 1 - std::pow(1 + 2.5 * mean, -0.8); }

private:
    static constexpr std::size_t per_octave = 32, octaves = 3, sizes = per_octave * octaves + 1;
    // Even within an octave.
    double cell_size(std::size_t i) const noexcept;
    // The first of them above a distance, in units of the scale; `sizes` or more: none.
    static std::size_t first_above(double distance) noexcept;

    double scale_;
    std::size_t known_ = 0; // sizes looked at, from the first one on
    std::uint32_t boxes_ = 0;
    std::array<std::uint32_t, sizes> known_boxes_{}, visited_{}, changed_{};
    std::array<float, sizes> share_{};
};

} // namespace vox
