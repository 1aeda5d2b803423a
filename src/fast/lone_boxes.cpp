// Boxes are sorted into rows along one axis, by their low corners. A row is as high and as wide as the boxes
// are, but for some large ones. So a box meets only boxes of its own row and of the eight around it; half of
// these are looked at from the other side. The rows are swept together, in order: each has a place in each of
// the rows around it, which only moves on. Large boxes are tested against all others.
#include "fast/lone_boxes.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vox::fast {

namespace {

constexpr std::size_t most_large = 16;        // boxes that are tested against all others
constexpr std::uint64_t most_met_tests = 64;  // for each box, of those in rows
constexpr std::uint32_t most_rows = 1u << 15; // along an axis

struct Sizes {
    double low[3], high[3]; // of all low corners
    double mean[3] = {};    // sides
    std::size_t count = 0;
};

Sizes measure(std::span<const Box> boxes) {
    Sizes sizes;
    std::fill_n(sizes.low, 3, double{float_infinity});
    std::fill_n(sizes.high, 3, -double{float_infinity});
    for (const Box& box : boxes) {
        if (is_empty(box)) continue;
        ++sizes.count;
        for (int a = 0; a < 3; ++a) {
            const double lo = box.lo[a];
            sizes.low[a] = std::min(sizes.low[a], lo);
            sizes.high[a] = std::max(sizes.high[a], lo);
            sizes.mean[a] += box.hi[a] - lo;
        }
    }
    for (double& side : sizes.mean) side /= static_cast<double>(std::max<std::size_t>(sizes.count, 1));
    return sizes;
}

bool is_large(const Box& box, const double (&most)[3]) noexcept {
    bool large = false;
    for (int a = 0; a < 3; ++a) large |= double{box.hi[a]} - double{box.lo[a]} > most[a];
    return large;
}

// Rows along `axis`. A box that is not large reaches no further than the next row.
struct Rows {
    Rows(const Sizes& sizes, double factor) {
        double longest = -1;
        for (int a = 0; a < 3; ++a) {
            most_side[a] = factor * sizes.mean[a];
            const double extent = sizes.high[a] - sizes.low[a];
            const double length = most_side[a] > 0 ? extent / most_side[a] : extent > 0 ? 1e300 : 0;
            if (length > longest) longest = length, axis = a;
        }
        for (int i = 0; i < 2; ++i) {
            across[i] = (axis + 1 + i) % 3;
            const double extent = sizes.high[across[i]] - sizes.low[across[i]];
            low[i] = sizes.low[across[i]];
            per_length[i] = std::min(0.999 / most_side[across[i]], (most_rows - 1) / extent);
            if (!(per_length[i] < 1e300)) per_length[i] = 0; // all in one row, or both were 0
        }
    }

    // The rows of a layer come one after another, with a gap after each layer.
    std::uint32_t of(const Box& box) const noexcept {
        std::uint32_t at[2];
        for (int i = 0; i < 2; ++i)
            at[i] = static_cast<std::uint32_t>((double{box.lo[across[i]]} - low[i]) * per_length[i]);
        return at[1] * next_layer + at[0];
    }
    static constexpr std::uint32_t next_layer = 2 * most_rows;

    double most_side[3];
    int axis = 0, across[2];
    double low[2], per_length[2];
};

} // namespace

bool find_met_boxes(std::span<const Box> boxes, PairBuffers& buffers, Array<std::uint8_t>& met) {
    const Sizes sizes = measure(boxes);
    met.assign(boxes.size(), 0);
    // Rows for boxes of twice the mean size, or of more where many are larger. Sorted by where they begin,
    // then by row: sorting is stable.
    Array<std::uint64_t>& items = buffers.corners;
    std::array<std::uint32_t, most_large> large;
    std::size_t large_count = most_large + 1;
    Rows rows(sizes, 1);
    for (double factor = 2; large_count > most_large && factor <= 16; factor *= 2) {
        rows = Rows(sizes, factor);
        items.clear();
        large_count = 0;
        for (std::uint32_t i = 0; i < boxes.size() && large_count <= most_large; ++i) {
            if (is_empty(boxes[i])) continue;
            if (!is_large(boxes[i], rows.most_side))
                items.push_back(std::uint64_t{ordered_bits(boxes[i].lo[rows.axis])} << 32 | i);
            else if (++large_count <= most_large)
                large[large_count - 1] = i;
        }
    }
    if (large_count > most_large) return false;
    sort_by_upper_half(items, buffers.other_corners);
    const std::size_t count = items.size();
    Array<std::uint32_t>& order = buffers.order;
    order.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        order[k] = static_cast<std::uint32_t>(items[k]);
        items[k] = std::uint64_t{rows.of(boxes[order[k]])} << 32 | k;
    }
    sort_by_upper_half(items, buffers.other_corners);

    const auto index_of = [&](std::size_t k) { return order[static_cast<std::uint32_t>(items[k])]; };
    const auto row_of = [&](std::size_t k) { return static_cast<std::uint32_t>(items[k] >> 32); };
    Array<Box>& sorted = buffers.boxes;
    sorted.resize(count);
    for (std::size_t k = 0; k < count; ++k) sorted[k] = boxes[index_of(k)];
    const auto mark = [&](std::size_t k, std::size_t l) { met[index_of(k)] = met[index_of(l)] = 1; };
    const double reach = 1.001 * rows.most_side[rows.axis];
    constexpr std::uint32_t to_next[4] = {1, Rows::next_layer - 1, Rows::next_layer, Rows::next_layer + 1};
    std::array<std::size_t, 4> place{}; // in the rows around, of what may meet this box or later ones
    std::uint64_t tests = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Box& box = sorted[k];
        const float end = box.hi[rows.axis];
        const double begin = double{box.lo[rows.axis]} - reach;
        const std::uint32_t row = row_of(k);
        for (std::size_t l = k + 1; l < count && row_of(l) == row && sorted[l].lo[rows.axis] <= end;
             ++l, ++tests)
            if (overlap(box, sorted[l])) mark(k, l);
        for (std::size_t i = 0; i < place.size(); ++i) {
            const std::uint32_t other = row + to_next[i];
            std::size_t& l = place[i];
            while (l < count &&
                   (row_of(l) < other || (row_of(l) == other && sorted[l].lo[rows.axis] < begin)))
                ++l;
            for (std::size_t m = l; m < count && row_of(m) == other && sorted[m].lo[rows.axis] <= end;
                 ++m, ++tests)
                if (overlap(box, sorted[m])) mark(k, m);
        }
        if (tests > most_met_tests * (count + 1)) return false;
    }
    for (std::size_t i = 0; i < large_count; ++i)
        for (std::size_t j = 0; j < boxes.size(); ++j)
            if (j != large[i] && overlap(boxes[large[i]], boxes[j])) met[j] = met[large[i]] = 1;
    return true;
}

} // namespace vox::fast
