// Binning by counting sort (D. E. Knuth, The Art of Computer Programming, vol. 3, 5.2): count, sum, place.
// Sparse space is halved at the middle of the longest side, as in a k-d tree (J. L. Bentley, Multidimensional
// binary search trees used for associative searching, CACM 18, 1975), until the parts are not sparse.
#include "fast/window.hpp"
#include "base/simd.hpp"

#include <array>
#include <cmath>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/window.cpp"
#include "base/each_target.hpp"

#include "base/compress-inl.hpp"
#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using vox::HWY_NAMESPACE::Compressor;

// Writes the points of [first, last) inside `region` from x[0], y[0], z[0], id[0] on, and returns their
// number. `count` is the number of all positions. Runs are short, so the end of a run takes a whole register
// too, where other positions follow it.
std::uint32_t Collect(const float* HWY_RESTRICT positions, std::uint32_t first, std::uint32_t last,
                      std::uint32_t count, const Box& region, float* HWY_RESTRICT x, float* HWY_RESTRICT y,
                      float* HWY_RESTRICT z, std::uint32_t* HWY_RESTRICT id) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const auto lx = hn::Set(d, region.lo[0]), ly = hn::Set(d, region.lo[1]), lz = hn::Set(d, region.lo[2]);
    const auto hx = hn::Set(d, region.hi[0]), hy = hn::Set(d, region.hi[1]), hz = hn::Set(d, region.hi[2]);
    std::uint32_t n = 0, v = first;
    for (; v < last && count - v >= lanes; v += lanes) {
        auto px = hn::Undefined(d), py = px, pz = px;
        hn::LoadInterleaved3(d, positions + std::size_t{v} * 3, px, py, pz);
        const auto inside_x = hn::And(hn::Ge(px, lx), hn::Le(px, hx));
        const auto inside_y = hn::And(hn::Ge(py, ly), hn::Le(py, hy));
        const auto inside_z = hn::And(hn::Ge(pz, lz), hn::Le(pz, hz));
        const auto inside = hn::And(hn::And(inside_x, inside_y), hn::And(inside_z, hn::FirstN(d, last - v)));
        if (vox::HWY_NAMESPACE::NoneOfMask(d, inside)) continue;
        const Compressor compress(inside);
        hn::StoreU(compress(px), d, x + n);
        hn::StoreU(compress(py), d, y + n);
        hn::StoreU(compress(pz), d, z + n);
        hn::StoreU(compress(hn::Iota(du, v)), du, id + n);
        n += compress.count();
    }
    for (; v < last; ++v) {
        const float* p = positions + std::size_t{v} * 3;
        x[n] = p[0];
        y[n] = p[1];
        z[n] = p[2];
        id[n] = v;
        n += (p[0] >= region.lo[0]) & (p[0] <= region.hi[0]) & (p[1] >= region.lo[1]) &
             (p[1] <= region.hi[1]) & (p[2] >= region.lo[2]) & (p[2] <= region.hi[2]);
    }
    return n;
}

void MinMax(const float* HWY_RESTRICT values, std::uint32_t count, float& lowest, float& highest) {
    const hn::CappedTag<float, 16> d;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    auto lo = hn::Set(d, float_infinity), hi = hn::Set(d, -float_infinity);
    std::uint32_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto v = hn::LoadU(d, values + i);
        lo = hn::Min(lo, v);
        hi = hn::Max(hi, v);
    }
    lowest = hn::GetLane(hn::MinOfLanes(d, lo));
    highest = hn::GetLane(hn::MaxOfLanes(d, hi));
    for (; i < count; ++i) {
        lowest = values[i] < lowest ? values[i] : lowest;
        highest = values[i] > highest ? values[i] : highest;
    }
}

// WindowLattice::cell for all three axes of whole registers of points; writes up to a register past `count`.
void Cells(const WindowLattice& lattice, const float* HWY_RESTRICT x, const float* HWY_RESTRICT y,
           const float* HWY_RESTRICT z, std::uint32_t count, std::uint32_t* HWY_RESTRICT cell) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto zero = hn::Zero(d), inverse = hn::Set(d, lattice.inverse);
    const auto index = [&](const float* c, int axis) HWY_ATTR {
        const auto t = hn::Mul(hn::Sub(hn::LoadU(d, c), hn::Set(d, lattice.origin[axis])), inverse);
        return hn::ConvertTo(di, hn::Min(hn::Max(t, zero), hn::Set(d, lattice.last[axis])));
    };
    const auto nx = hn::Set(di, static_cast<std::int32_t>(lattice.cells[0]));
    const auto ny = hn::Set(di, static_cast<std::int32_t>(lattice.cells[1]));
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const auto row = hn::Add(hn::Mul(index(z + i, 2), ny), index(y + i, 1));
        hn::StoreU(hn::BitCast(du, hn::Add(hn::Mul(row, nx), index(x + i, 0))), du, cell + i);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

void Points::reserve(std::size_t most, std::size_t ever) {
    if (id.size() >= most + padding)
        return; // `id` grows last, so this holds after an earlier call ran out of memory
    // An eighth more, so that a number of points that varies needs no new room in every step. resize() alone
    // would double the room.
    const std::size_t size = std::max(most, std::min(most + most / 8, ever)) + padding;
    const auto grow = [size](auto& list) {
        list.reserve(size);
        list.resize(size);
    };
    grow(x);
    grow(y);
    grow(z);
    grow(id);
}

WindowLattice make_lattice(const Box& box, double cell_size, std::size_t most_cells) {
    double extent[3], longest = 0;
    for (int a = 0; a < 3; ++a) {
        extent[a] = double{box.hi[a]} - double{box.lo[a]};
        longest = std::max(longest, extent[a]);
    }
    // Whatever was asked for, a cell index stays below 2^23, where floats are exact, and the inverse is
    // normal.
    cell_size = std::clamp(std::max(cell_size, longest * 0x1p-20), 0x1p-100, 0x1p+125);
    const auto most = static_cast<double>(std::max<std::size_t>(most_cells, 1));
    WindowLattice lattice;
    double cells[3];
    for (;;) {
        for (int a = 0; a < 3; ++a) cells[a] = std::floor(extent[a] / cell_size) + 1;
        const double count = cells[0] * cells[1] * cells[2];
        if (count <= most) break;
        cell_size *= std::max(1.05, 0.99 * std::cbrt(count / most));
        if (!(cell_size < 0x1p+125)) {
            // The coordinates span all that a float can hold: one cell.
            cell_size = 0x1p+125;
            for (double& c : cells) c = 1;
            break;
        }
    }
    lattice.inverse = static_cast<float>(1 / cell_size);
    for (int a = 0; a < 3; ++a) {
        lattice.origin[a] = box.lo[a];
        lattice.last[a] = static_cast<float>(cells[a] - 1);
        lattice.cells[a] = static_cast<std::uint32_t>(cells[a]);
    }
    return lattice;
}

namespace {

// Points [first, first + count).
struct Range {
    std::uint32_t first, count;
};

// A window is crowded when a point shares its cell with this many others on average: one register of them, so
// that up to there a row of cells takes little longer to read than an empty one. bench/README.md has what
// halving crowded windows gains ("A k-d tree of windows") and what it costs where nothing is gained.
constexpr std::uint64_t most_crowded = 16;
// So few points are never halved: they are read in a few registers, whatever cells they are in.
constexpr std::uint32_t few_points = 128;
// Points looked at to judge a window of at least four times as many.
constexpr std::uint32_t most_samples = 256;

// True if the cells of the lattice are much larger than wanted.
bool is_coarse(const WindowLattice& lattice, double cell_size) {
    return double{lattice.inverse} * cell_size < 0.5;
}

// Covers the bulk of some points where a few far from it would make the cells large.
WindowLattice bulk_lattice(const Points& points, Range range, const Box& box, double cell_size,
                           std::size_t most_cells) {
    const WindowLattice lattice = make_lattice(box, cell_size, most_cells);
    constexpr std::uint32_t tail =
        4; // samples at either end that are not of the bulk: some 3 % of the points
    if (range.count < 4 * most_samples || !is_coarse(lattice, cell_size)) return lattice;
    // The bulk is the interval of the samples without those tails, and a quarter of it more on either side.
    const float* coordinates[3] = {points.x.data(), points.y.data(), points.z.data()};
    Box bulk = box;
    for (int a = 0; a < 3; ++a) {
        std::array<float, most_samples> sample;
        for (std::uint32_t i = 0; i < most_samples; ++i)
            sample[i] = coordinates[a][range.first + std::uint64_t{range.count} * i / most_samples];
        std::nth_element(sample.begin(), sample.begin() + tail, sample.end());
        std::nth_element(sample.begin() + tail, sample.end() - 1 - tail, sample.end());
        const double lo = sample[tail], hi = sample[most_samples - 1 - tail],
                     margin = 0.25 * (hi - lo) + 2 * cell_size;
        bulk.lo[a] = std::max(box.lo[a], static_cast<float>(lo - margin));
        bulk.hi[a] = std::min(box.hi[a], static_cast<float>(hi + margin));
    }
    return make_lattice(bulk, cell_size, most_cells);
}

Box bounds(const Points& points, Range range) {
    const auto min_max = VOX_SIMD_DISPATCH(MinMax);
    Box box{};
    min_max(points.x.data() + range.first, range.count, box.lo[0], box.hi[0]);
    min_max(points.y.data() + range.first, range.count, box.lo[1], box.hi[1]);
    min_max(points.z.data() + range.first, range.count, box.lo[2], box.hi[2]);
    return box;
}

// True if far too many of some sampled points share a cell: then it is not worth binning all of them to know.
bool looks_crowded(const Points& points, Range range, const WindowLattice& lattice) {
    if (range.count < 4 * most_samples) return false;
    std::array<std::size_t, most_samples> cell;
    for (std::uint32_t i = 0; i < most_samples; ++i) {
        const std::size_t p = range.first + std::uint64_t{range.count} * i / most_samples;
        cell[i] = lattice.offset(
            {{lattice.cell(points.x[p], 0), lattice.cell(points.y[p], 1), lattice.cell(points.z[p], 2), 0}});
    }
    std::sort(cell.begin(), cell.end());
    std::uint64_t pairs = 0, same = 0; // of samples in one cell; samples in the cell before i
    for (std::uint32_t i = 1; i < most_samples; ++i) {
        same = cell[i] == cell[i - 1] ? same + 1 : 0;
        pairs += same;
    }
    constexpr std::uint64_t all_pairs = most_samples * (most_samples - 1) / 2;
    // Four times what counts as crowded, and more pairs than chance makes: samples only decide clear cases.
    return pairs > 8 && pairs * range.count > 4 * most_crowded * all_pairs;
}

// True if a point finds too many others in its own cell, by the number of points in each.
bool is_crowded(const std::uint32_t* counts, std::size_t cells, std::uint32_t points) {
    std::uint64_t sum = 0;
    for (std::size_t c = 0; c < cells; ++c) sum += std::uint64_t{counts[c]} * counts[c];
    return sum > (most_crowded + 1) * points;
}

// Calls visit(point, cell) for each of some points, counted from the first one. Cells are computed some at a
// time, and twice for each window: storing them would take more time, and memory.
template <class Visit>
void for_cells(const Points& points, Range range, const WindowLattice& lattice, Visit&& visit) {
    constexpr std::uint32_t at_once = 512;
    alignas(64) std::uint32_t cell[at_once + Points::padding];
    const auto cells = VOX_SIMD_DISPATCH(Cells);
    for (std::uint32_t done = 0; done < range.count; done += at_once) {
        const std::size_t first = std::size_t{range.first} + done;
        const std::uint32_t count = std::min(at_once, range.count - done);
        cells(lattice, points.x.data() + first, points.y.data() + first, points.z.data() + first, count,
              cell);
        for (std::uint32_t i = 0; i < count; ++i) visit(done + i, cell[i]);
    }
}

// Adds a window of some points, and returns whether it did. With `unless_crowded`, adds none that would be
// crowded.
bool try_bin(const Points& points, Range range, const WindowLattice& lattice, const Box& box,
             bool unless_crowded, Bins& bins, Window& window) {
    const std::uint32_t n = range.count;
    const std::size_t cells = lattice.count();
    window = {&bins, lattice, box, bins.points.count, bins.cells, n};
    bins.points.reserve(bins.points.count + std::size_t{n}, bins.most_points);
    const std::size_t used = bins.cells + cells + 2;
    if (bins.begin.size() < used) {
        bins.begin.reserve(used + used / 8); // resize() alone would double the room
        bins.begin.resize(used + used / 8);
    }

    // begin[c + 1] is first the number of points in c, then where c begins, and in the end where it ends.
    std::uint32_t* begin = bins.begin.data() + window.first_cell;
    std::fill_n(begin, cells + 2, 0u);
    for_cells(points, range, lattice, [begin](std::uint32_t, std::uint32_t c) { ++begin[c + 1]; });
    if (unless_crowded && is_crowded(begin + 1, cells, n)) return false;
    std::uint32_t sum = 0, occupied = 0, fullest = 0;
    for (std::size_t c = 1; c <= cells; ++c) {
        const std::uint32_t count = begin[c];
        begin[c] = sum;
        sum += count;
        occupied += count != 0;
        fullest = count > fullest ? count : fullest;
    }
    float* x = bins.points.x.data() + window.first_point;
    float* y = bins.points.y.data() + window.first_point;
    float* z = bins.points.z.data() + window.first_point;
    std::uint32_t* id = bins.points.id.data() + window.first_point;
    const float *from_x = points.x.data() + range.first, *from_y = points.y.data() + range.first,
                *from_z = points.z.data() + range.first;
    const std::uint32_t* from_id = points.id.data() + range.first;
    for_cells(points, range, lattice, [=](std::uint32_t i, std::uint32_t c) {
        const std::uint32_t place = begin[c + 1]++;
        x[place] = from_x[i];
        y[place] = from_y[i];
        z[place] = from_z[i];
        id[place] = from_id[i];
    });
    bins.points.count += n;
    bins.cells = used;
    bins.occupied_cells += occupied;
    bins.fullest_cell = std::max<std::uint64_t>(bins.fullest_cell, fullest);
    return true;
}

// Puts the points on the low side of the middle of the longest side of their box first, and returns how many
// there are: some, but not all. 0 where all points are in one place.
std::uint32_t halve(Points& points, Range range, const Box& box) {
    float* coordinates[3] = {points.x.data() + range.first, points.y.data() + range.first,
                             points.z.data() + range.first};
    std::uint32_t* id = points.id.data() + range.first;
    int axis = 0;
    const auto side = [&](int a) { return double{box.hi[a]} - double{box.lo[a]}; };
    for (int a = 1; a < 3; ++a)
        if (side(a) > side(axis)) axis = a;
    if (!(side(axis) > 0)) return 0;
    float middle = 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
    if (!(middle >= box.lo[axis] && middle < box.hi[axis])) middle = box.lo[axis]; // next to each other
    std::uint32_t low = 0, high = range.count;
    const float* along = coordinates[axis];
    for (;;) {
        while (low < high && along[low] <= middle) ++low;
        while (low < high && along[high - 1] > middle) --high;
        if (low == high) return low;
        --high;
        for (float* c : coordinates) std::swap(c[low], c[high]);
        std::swap(id[low], id[high]);
        ++low;
    }
}

void add_tree(Points& points, Range range, double cell_size, Bins& bins) {
    const std::size_t index = bins.windows.size();
    bins.windows.emplace_back();
    const Box box = bounds(points, range);
    const std::size_t cells = most_window_cells(range.count);
    const WindowLattice lattice = bulk_lattice(points, range, box, cell_size, cells);
    const bool may_halve =
        range.count > few_points && is_coarse(make_lattice(box, cell_size, cells), cell_size);
    Window window;
    if ((may_halve && looks_crowded(points, range, lattice)) ||
        !try_bin(points, range, lattice, box, may_halve, bins, window)) {
        const std::uint32_t low = halve(points, range, box);
        if (low == 0) {
            (void)try_bin(points, range, lattice, box, false, bins, window);
        } else {
            window = {&bins, {}, box, 0, 0, 0};
            add_tree(points, {range.first, low}, cell_size, bins);
            add_tree(points, {range.first + low, range.count - low}, cell_size, bins);
        }
    }
    window.end = static_cast<std::uint32_t>(bins.windows.size());
    bins.windows[index] = window;
}

} // namespace

WindowLattice make_lattice(const Points& points, const Box& box, double cell_size, std::size_t most_cells) {
    return bulk_lattice(points, {0, points.count}, box, cell_size, most_cells);
}

void collect(const float* positions, std::uint32_t first, std::uint32_t last, std::uint32_t count,
             const Box& region, Points& points) {
    const std::size_t n = points.count;
    points.count +=
        VOX_SIMD_DISPATCH(Collect)(positions, first, last, count, region, points.x.data() + n,
                                   points.y.data() + n, points.z.data() + n, points.id.data() + n);
}

Box bounds(const Points& points) { return bounds(points, {0, points.count}); }
Box bounds(const Points& points, std::uint32_t first, std::uint32_t count) {
    return bounds(points, {first, count});
}

Window bin(const Points& points, const WindowLattice& lattice, const Box& box, Bins& bins) {
    Window window;
    (void)try_bin(points, {0, points.count}, lattice, box, false, bins, window);
    return window;
}

bool holds_point(const Window& window, const Box& box) noexcept {
    const WindowLattice& lattice = window.lattice;
    const Points& points = window.bins->points;
    const std::uint32_t* begin = window.bins->begin.data() + window.first_cell;
    const float* x = points.x.data() + window.first_point;
    const float* y = points.y.data() + window.first_point;
    const float* z = points.z.data() + window.first_point;
    const WindowCell lo = lattice.cell(box.lo), hi = lattice.cell(box.hi);
    WindowCell c = lo;
    for (c.index[2] = lo.index[2]; c.index[2] <= hi.index[2]; ++c.index[2])
        for (c.index[1] = lo.index[1]; c.index[1] <= hi.index[1]; ++c.index[1]) {
            const std::size_t row = lattice.offset(c);
            const std::uint32_t end = begin[row + hi.index[0] - lo.index[0] + 1];
            for (std::uint32_t i = begin[row]; i < end; ++i)
                if ((x[i] >= box.lo[0]) & (x[i] <= box.hi[0]) & (y[i] >= box.lo[1]) & (y[i] <= box.hi[1]) &
                    (z[i] >= box.lo[2]) & (z[i] <= box.hi[2]))
                    return true;
        }
    return false;
}

std::uint32_t bin_tree(Points& points, double cell_size, Bins& bins) {
    const auto root = static_cast<std::uint32_t>(bins.windows.size());
    add_tree(points, {0, points.count}, cell_size, bins);
    return root;
}

} // namespace vox::fast
#endif
