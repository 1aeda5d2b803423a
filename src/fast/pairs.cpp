// Sweep along one axis (Baraff, Dynamic simulation of non-penetrating rigid bodies, 1992; Cohen et al.,
// I-COLLIDE, 1995): the boxes sorted by where they begin, each tested against those that begin before it
// ends. The axis is the one along which the boxes' centres vary most.
#include "fast/pairs.hpp"

#include <algorithm>
#include <cstddef>

namespace vox::fast {

namespace {

int widest_axis(std::span<const Box> boxes) {
    double sum[3] = {}, squares[3] = {}, count = 0;
    for (const Box& box : boxes) {
        if (is_empty(box)) continue;
        count += 1;
        for (int a = 0; a < 3; ++a) {
            const double c = 0.5 * (double{box.lo[a]} + double{box.hi[a]});
            sum[a] += c;
            squares[a] += c * c;
        }
    }
    int axis = 0;
    double widest = -1;
    for (int a = 0; a < 3 && count > 0; ++a) {
        const double variance = squares[a] / count - sum[a] / count * (sum[a] / count);
        if (variance > widest) {
            widest = variance;
            axis = a;
        }
    }
    return axis;
}

// One pass of a radix sort whose digit is a whole index: stable, by Pair::*key.
void sort_by(std::uint32_t Pair::*key, std::size_t indices, std::span<const Pair> from, std::span<Pair> to,
             std::pmr::vector<std::uint32_t>& first) {
    first.assign(indices + 1, 0);
    for (const Pair& pair : from) ++first[pair.*key + 1];
    for (std::size_t i = 1; i <= indices; ++i) first[i] += first[i - 1];
    for (const Pair& pair : from) to[first[pair.*key]++] = pair;
}

} // namespace

void find_pairs(std::span<const Box> boxes, PairBuffers& buffers, std::pmr::vector<Pair>& pairs) {
    std::pmr::vector<std::uint32_t>& order = buffers.order;
    std::pmr::vector<Pair>& found = buffers.found;
    order.clear();
    found.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!is_empty(boxes[i])) order.push_back(i);
    const int axis = widest_axis(boxes);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float x = boxes[a].lo[axis], y = boxes[b].lo[axis];
        return x != y ? x < y : a < b;
    });
    buffers.boxes.clear();
    for (const std::uint32_t i : order) buffers.boxes.push_back(boxes[i]);
    const Box* sorted = buffers.boxes.data();
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Box box = sorted[i];
        for (std::size_t j = i + 1; j < order.size() && sorted[j].lo[axis] <= box.hi[axis]; ++j) {
            if (!overlap(box, sorted[j])) continue;
            found.push_back({order[i], order[j]});
            found.push_back({order[j], order[i]});
        }
    }
    pairs.resize(found.size());
    sort_by(&Pair::b, boxes.size(), found, pairs, buffers.first);
    std::copy(pairs.begin(), pairs.end(), found.begin());
    sort_by(&Pair::a, boxes.size(), found, pairs, buffers.first);
}

} // namespace vox::fast
