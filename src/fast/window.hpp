// The vertices of one body that may be in contact, binned into a dense window of cells. The window is stored
// as compressed rows over all cells, x fastest, so that the cells of a tile's box along x are one range of
// vertices, and coordinates are a structure of arrays. One window over clumps that are far apart would need
// cells so large that most vertices share a few of them; such a body gets a k-d tree of windows.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::fast {

// Vertices as a structure of arrays, with room for a whole vector register past the end.
struct Points {
    explicit Points(std::pmr::memory_resource* memory) : x(memory), y(memory), z(memory), id(memory) {}

    Array<float> x, y, z;
    Array<std::uint32_t> id; // the caller's vertex index
    std::uint32_t count = 0;

    static constexpr std::size_t padding = 64;
    // Keeps what is there. `ever` is the most that there ever will be.
    void reserve(std::size_t most, std::size_t ever = ~std::size_t{0});
};

struct alignas(16) WindowCell {
    std::uint32_t index[4]; // along x, y, z; [3] is unused
};

// A coordinate is in cell trunc((c - origin) * inverse), clamped to [0, last]. As computed, this is still
// monotone in c. So the cells from that of a box's low corner to that of its high corner hold every point of
// the box, wherever the lattice is; points outside belong to the nearest border cell.
struct WindowLattice {
    alignas(16) float origin[4] = {0, 0, 0, 0}; // [3] is unused, here and in `last`
    alignas(16) float last[4] = {0, 0, 0, 0};
    float inverse = 1; // of the cell size; > 0, finite
    std::uint32_t cells[3] = {1, 1, 1};

    std::uint32_t cell(float c, int axis) const noexcept {
        float t = (c - origin[axis]) * inverse;
        t = t > 0 ? t : 0;
        t = t < last[axis] ? t : last[axis];
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(t));
    }
    // The cells of all axes, from a corner of a box. In SSE2 as it is inlined in loops of code that is
    // compiled for the base target, and compilers do not vectorise the loop below.
    WindowCell cell(const float (&corner)[4]) const noexcept {
        WindowCell c;
#if defined(__SSE2__)
        __m128 t = _mm_mul_ps(_mm_sub_ps(_mm_load_ps(corner), _mm_load_ps(origin)), _mm_set1_ps(inverse));
        t = _mm_min_ps(_mm_max_ps(t, _mm_setzero_ps()), _mm_load_ps(last));
        _mm_store_si128(reinterpret_cast<__m128i*>(c.index), _mm_cvttps_epi32(t));
#else
        for (int a = 0; a < 3; ++a) c.index[a] = cell(corner[a], a);
#endif
        return c;
    }
    std::size_t offset(const WindowCell& c) const noexcept {
        return (std::size_t{c.index[2]} * cells[1] + c.index[1]) * cells[0] + c.index[0];
    }
    std::size_t count() const noexcept { return std::size_t{cells[0]} * cells[1] * cells[2]; }
};

// The most cells of a window with so many points.
inline std::size_t most_window_cells(std::uint32_t points) noexcept {
    return 2 * std::size_t{points} + std::min(std::size_t{64}, 2 * std::size_t{points});
}

// Covers `box` with cells of `cell_size`, or of larger ones where more than `most_cells` would be needed.
WindowLattice make_lattice(const Box& box, double cell_size, std::size_t most_cells);

// Covers points in `box`; only their bulk, where a few points far from the others would make cells large.
WindowLattice make_lattice(const Points& points, const Box& box, double cell_size, std::size_t most_cells);

struct Bins;

// The binned vertices of a body, or some of them; or, without any, a node of the tree over several windows.
struct Window {
    const Bins* bins; // that hold the points
    WindowLattice lattice;
    Box box;                 // around its points
    std::size_t first_point; // in Bins::points
    // In Bins::begin, which has the first point of each cell, counted from first_point, and the end.
    std::size_t first_cell;
    std::uint32_t count;   // points; 0: a node, and the windows of its two parts come next
    std::uint32_t end = 0; // index in Bins::windows after this one and, if it is a node, after all below it
};

struct Bins {
    explicit Bins(std::pmr::memory_resource* memory) : points(memory), begin(memory), windows(memory) {}

    Points points; // window after window, sorted by cell
    Array<std::uint32_t> begin;
    Array<Window> windows; // tree after tree, each in preorder
    std::size_t cells = 0; // entries of `begin` in use
    std::uint64_t occupied_cells = 0, fullest_cell = 0;
    std::size_t most_points = ~std::size_t{0}; // that there ever will be

    void clear() noexcept {
        points.count = 0;
        windows.clear();
        cells = occupied_cells = fullest_cell = 0;
    }
};

// Appends the vertices [first, last) of `count` packed positions that are in `region`. The caller has
// reserved room.
void collect(const float* positions, std::uint32_t first, std::uint32_t last, std::uint32_t count,
             const Box& region, Points& points);

// The box of points.
Box bounds(const Points& points);
Box bounds(const Points& points, std::uint32_t first, std::uint32_t count);

// Adds the window of `points`, sorted stably into the cells of `lattice`.
Window bin(const Points& points, const WindowLattice& lattice, const Box& box, Bins& bins);

// Appends to bins.windows a tree of windows of all points, with cells of `cell_size`, or of larger ones where
// those would be too many. It is a single window unless its cells would be crowded. Changes the order of
// `points`. Returns the index of the root.
std::uint32_t bin_tree(Points& points, double cell_size, Bins& bins);

// True if there is a point in `box`.
bool holds_point(const Window& window, const Box& box) noexcept;

// Calls function(window) for each window with points of the tree at `root` whose box meets `box`.
template <class Function>
void for_windows(const Bins& bins, std::uint32_t root, const Box& box, Function&& function) {
    for (std::uint32_t i = root; i < bins.windows[root].end;) {
        const Window& window = bins.windows[i];
        if (!overlap(window.box, box)) {
            i = window.end;
            continue;
        }
        if (window.count) function(window);
        ++i;
    }
}

} // namespace vox::fast
