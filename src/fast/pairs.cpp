// Sweep along one axis (Baraff, Dynamic simulation of non-penetrating rigid bodies, 1992; Cohen et al.,
// I-COLLIDE, 1995): the boxes sorted by where they begin, each tested against those that begin before it
// ends. The axis is the one along which the boxes' centres vary most.
#include "pairs.hpp"

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

} // namespace

void find_pairs(std::span<const Box> boxes, std::pmr::vector<std::uint32_t>& order,
                std::pmr::vector<Pair>& pairs) {
    pairs.clear();
    order.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!is_empty(boxes[i])) order.push_back(i);
    const int axis = widest_axis(boxes);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float x = boxes[a].lo[axis], y = boxes[b].lo[axis];
        return x != y ? x < y : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Box& box = boxes[order[i]];
        for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].lo[axis] <= box.hi[axis]; ++j) {
            if (!overlap(box, boxes[order[j]])) continue;
            pairs.push_back({order[i], order[j]});
            pairs.push_back({order[j], order[i]});
        }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
}

} // namespace vox::fast
