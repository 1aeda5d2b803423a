// How often a visited cell's list of points has another length than the list visited just before. A branch
// predictor guesses the loop exit when the length repeats, and the processor fetches ahead; otherwise it
// waits.
//
// That depends on how regular the points are at the scale of a cell. For random points the share of other
// lengths is a smooth function of their mean number in a cell. A mesh cut from a body-centred lattice has two
// points in every cell that is as large as a cube of the lattice. A mean number cannot distinguish the two.
// So the cells of a few sampled boxes are filled and visited, in the order of the engine, at sizes around
// those of the boxes.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

// The class of a number: 0 below 1; from there on each octave has 2^bits classes of equal width.
inline std::size_t class_of_ratio(double ratio, int bits) noexcept {
    if (!(ratio >= 1)) return 0;
    const std::uint64_t upper = std::bit_cast<std::uint64_t>(ratio) >> (52 - bits); // octave and part of it
    return static_cast<std::size_t>(upper - (std::uint64_t{1023} << bits) + 1);
}

class BranchMisses {
public:
    // For boxes whose longest side is from `scale` to twice that.
    explicit BranchMisses(double scale) : scale_(scale) {}

    // The range of cell sizes that are counted. A point further from a box than the cell size is in none of
    // the cells that the box meets.
    double first_size() const noexcept { return cell_size(0); }
    double last_size() const noexcept { return cell_size(sizes - 1); }
    // The most points near one box. Where there are more, the larger sizes are left out.
    static constexpr std::size_t most_points = 256;

    // In units of the scale, so that floats suffice.
    struct Point {
        float at[3];    // from the box's lower corner
        float distance; // from the box, the largest along an axis
    };
    double scale() const noexcept { return scale_; }
    // Adds the surroundings of one box: all points that are nearer than `known`, at most most_points. The
    // corner of a cell is at 0, as in hashed storage.
    void add(const double (&lo)[3], const double (&hi)[3], std::span<const Point> points, double known);
    // Call once, after the last add(). Averages each share with those of the sizes beside it: a grid keeps
    // its cell size only to within some per cent, so a gain at one size alone is not worth choosing.
    void finish() noexcept;

    // The size nearest to `cell_size` within the counted range; 0 where nothing was counted.
    double nearest(double cell_size) const noexcept;
    // The share of visits with another length, at a size in that range.
    double share(double cell_size) const noexcept;
    // The share where a mean number of points lies in a cell, placed as irregularly as by mesh generators.
    // Fitted to counts. A point that is alone among empty cells makes two changes.
    static double of_irregular(double mean) noexcept { return 1 - std::pow(1 + 2.5 * mean, -0.8); }

private:
    static constexpr int bits_per_octave = 4;
    static constexpr std::size_t per_octave = 1 << bits_per_octave, octaves = 3,
                                 sizes = per_octave * octaves + 1;
    // Evenly spaced within an octave.
    double cell_size(std::size_t i) const noexcept;
    // The index of the first size above a distance (in units of the scale); `sizes` or more where there is
    // none.
    static std::size_t first_above(double distance) noexcept;

    double scale_;
    std::size_t known_ = 0; // sizes counted, from the first one on
    std::uint32_t boxes_ = 0;
    std::array<std::uint32_t, sizes> known_boxes_{}, visited_{}, changed_{};
    std::array<float, sizes> share_{};
};

} // namespace vox
