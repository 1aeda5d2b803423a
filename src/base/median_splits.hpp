// Points in tiles that lie close together: split at the median along the longest side of their box, and the
// halves again (J. L. Bentley, Multidimensional binary search trees used for associative searching, CACM 18,
// 1975), each of whole tiles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

template <class Number>
struct SplitPoint {
    Number at[3];
    std::uint32_t index;
};

// The axis along which points reach furthest.
template <class Point>
int longest_axis(std::span<Point> points) {
    int axis = 0;
    decltype(points[0].at[0] + 0) most = -1;
    for (int a = 0; a < 3; ++a) {
        auto lo = points[0].at[a], hi = lo;
        for (const Point& point : points) {
            lo = std::min(lo, point.at[a]);
            hi = std::max(hi, point.at[a]);
        }
        if (!(hi - lo > most)) continue;
        most = hi - lo;
        axis = a;
    }
    return axis;
}

// Calls leaf(points) for each tile, in their order, with indices ascending. While there are more tiles than
// that, halves consist of whole groups of `group` tiles. All tiles but the last are full.
template <class Number, class Leaf>
void split_at_medians(std::span<SplitPoint<Number>> points, std::size_t tile_size, std::size_t group,
                      const Leaf& leaf) {
    using Point = SplitPoint<Number>;
    if (points.size() <= tile_size) {
        std::ranges::sort(points, {}, &Point::index);
        return leaf(std::span<const Point>(points));
    }
    const int axis = longest_axis(points);
    const std::size_t tiles = (points.size() + tile_size - 1) / tile_size, unit = tiles > group ? group : 1;
    const std::size_t left = (tiles / 2 + unit - 1) / unit * unit * tile_size;
    // By index where points are the same, so that the order never depends on how they are sorted.
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(left), points.end(),
                     [axis](const Point& x, const Point& y) {
                         return x.at[axis] != y.at[axis] ? x.at[axis] < y.at[axis] : x.index < y.index;
                     });
    split_at_medians(points.first(left), tile_size, group, leaf);
    split_at_medians(points.subspan(left), tile_size, group, leaf);
}

} // namespace vox
