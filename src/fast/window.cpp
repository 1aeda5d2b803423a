// Binning by counting sort (D. E. Knuth, The Art of Computer Programming, vol. 3, 5.2): count, sum, place.
#include "window.hpp"
#include "../simd.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/window.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "compress-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Writes the points of [first, last) inside `region` from x[0], y[0], z[0], id[0] on; returns how many.
std::uint32_t Collect(const float* HWY_RESTRICT positions, std::uint32_t first, std::uint32_t last,
                      const Box& region, float* HWY_RESTRICT x, float* HWY_RESTRICT y, float* HWY_RESTRICT z,
                      std::uint32_t* HWY_RESTRICT id) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const auto lx = hn::Set(d, region.lo[0]), ly = hn::Set(d, region.lo[1]), lz = hn::Set(d, region.lo[2]);
    const auto hx = hn::Set(d, region.hi[0]), hy = hn::Set(d, region.hi[1]), hz = hn::Set(d, region.hi[2]);
    std::uint32_t n = 0, v = first;
    for (; v + lanes <= last; v += lanes) {
        auto px = hn::Undefined(d), py = px, pz = px;
        hn::LoadInterleaved3(d, positions + std::size_t{v} * 3, px, py, pz);
        const auto inside_x = hn::And(hn::Ge(px, lx), hn::Le(px, hx));
        const auto inside_y = hn::And(hn::Ge(py, ly), hn::Le(py, hy));
        const auto inside_z = hn::And(hn::Ge(pz, lz), hn::Le(pz, hz));
        const auto inside = hn::And(hn::And(inside_x, inside_y), inside_z);
        if (hn::AllFalse(d, inside)) continue;
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
    auto lo = hn::Set(d, infinity), hi = hn::Set(d, -infinity);
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

// Lattice::cell for all three axes of whole registers of points; writes up to a register past `count`.
void Cells(const Lattice& lattice, const float* HWY_RESTRICT x, const float* HWY_RESTRICT y,
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

void Points::reserve(std::size_t most) {
    if (id.size() >= most + padding) return; // the last one: an earlier call may have run out of memory
    const std::size_t size = most + most / 8 + padding;
    x.resize(size);
    y.resize(size);
    z.resize(size);
    id.resize(size);
}

Lattice make_lattice(const Box& box, double cell_size, std::size_t most_cells) {
    double extent[3], longest = 0;
    for (int a = 0; a < 3; ++a) {
        extent[a] = double{box.hi[a]} - double{box.lo[a]};
        longest = std::max(longest, extent[a]);
    }
    // Numbers a float holds well, whatever was asked for: a cell index stays below 2^23, the inverse normal.
    cell_size = std::clamp(std::max(cell_size, longest * 0x1p-20), 0x1p-100, 0x1p+125);
    const auto most = static_cast<double>(std::max<std::size_t>(most_cells, 1));
    Lattice lattice;
    double cells[3];
    for (;;) {
        for (int a = 0; a < 3; ++a) cells[a] = std::floor(extent[a] / cell_size) + 1;
        const double count = cells[0] * cells[1] * cells[2];
        if (count <= most) break;
        cell_size *= std::max(1.05, 0.99 * std::cbrt(count / most));
        if (!(cell_size < 0x1p+125)) {
            // One cell: coordinates that span all of what a float can hold.
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

Lattice make_lattice(const Points& points, const Box& box, double cell_size, std::size_t most_cells) {
    Lattice lattice = make_lattice(box, cell_size, most_cells);
    constexpr std::uint32_t most_samples = 1024,
                            tail = 16; // samples on either side that are no bulk, at most
    if (points.count < most_samples || !(double{lattice.inverse} * cell_size < 0.5)) return lattice;
    // The bulk: what is left of some samples without the outermost on either side, and half of that again.
    const float* coordinates[3] = {points.x.data(), points.y.data(), points.z.data()};
    Box bulk = box;
    for (int a = 0; a < 3; ++a) {
        std::array<float, most_samples> sample;
        for (std::uint32_t i = 0; i < most_samples; ++i)
            sample[i] = coordinates[a][std::uint64_t{points.count} * i / most_samples];
        std::nth_element(sample.begin(), sample.begin() + tail, sample.end());
        std::nth_element(sample.begin() + tail, sample.end() - 1 - tail, sample.end());
        const double lo = sample[tail], hi = sample[most_samples - 1 - tail],
                     margin = 0.25 * (hi - lo) + 2 * cell_size;
        bulk.lo[a] = std::max(box.lo[a], static_cast<float>(lo - margin));
        bulk.hi[a] = std::min(box.hi[a], static_cast<float>(hi + margin));
    }
    return make_lattice(bulk, cell_size, most_cells);
}

void collect(const float* positions, std::uint32_t first, std::uint32_t last, const Box& region,
             Points& points) {
    const std::size_t n = points.count;
    points.count +=
        VOX_SIMD_DISPATCH(Collect)(positions, first, last, region, points.x.data() + n, points.y.data() + n,
                                   points.z.data() + n, points.id.data() + n);
}

Box bounds(const Points& points) {
    const auto min_max = VOX_SIMD_DISPATCH(MinMax);
    Box box{};
    min_max(points.x.data(), points.count, box.lo[0], box.hi[0]);
    min_max(points.y.data(), points.count, box.lo[1], box.hi[1]);
    min_max(points.z.data(), points.count, box.lo[2], box.hi[2]);
    return box;
}

Window bin(const Points& points, const Lattice& lattice, const Box& box,
           std::pmr::vector<std::uint32_t>& buffer, Bins& bins) {
    const std::uint32_t n = points.count;
    const std::size_t cells = lattice.count();
    const Window window{&bins, lattice, box, bins.points.count, bins.cells, n};
    bins.points.reserve(bins.points.count + std::size_t{n});
    if (buffer.size() < n + Points::padding) buffer.resize(n + n / 8 + Points::padding);
    const std::size_t used = bins.cells + cells + 2;
    if (bins.begin.size() < used) bins.begin.resize(used + used / 8);
    std::uint32_t* cell_of = buffer.data();
    VOX_SIMD_DISPATCH(Cells)(lattice, points.x.data(), points.y.data(), points.z.data(), n, cell_of);

    // begin[c + 1] is first the number of points in c, then where c begins, and in the end where it ends.
    std::uint32_t* begin = bins.begin.data() + window.first_cell;
    std::fill_n(begin, cells + 2, 0u);
    for (std::uint32_t i = 0; i < n; ++i) ++begin[cell_of[i] + 1];
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
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t place = begin[cell_of[i] + 1]++;
        x[place] = points.x[i];
        y[place] = points.y[i];
        z[place] = points.z[i];
        id[place] = points.id[i];
    }
    bins.points.count += n;
    bins.cells = used;
    bins.occupied_cells += occupied;
    bins.fullest_cell = std::max<std::uint64_t>(bins.fullest_cell, fullest);
    return window;
}

} // namespace vox::fast
#endif
