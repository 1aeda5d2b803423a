// A sweep along one axis finds the pairs where that takes few tests (Baraff, Dynamic simulation of
// non-penetrating rigid bodies, 1992; Cohen et al., I-COLLIDE, 1995): the boxes are sorted by where they
// begin, each is tested against those that begin before it ends. Along that axis the boxes' centres vary
// most.
//
// Else a streamed segment tree does, as for a scaffold of rods: its time does not depend on where the boxes
// are (A. Zomorodian, H. Edelsbrunner, Fast software for box intersections, Int. J. Comput. Geom. Appl. 12,
// 2002, Sect. 3). It joins classes of bodies that the filters treat alike, two at a time, so that it never
// meets pairs that filters exclude, as in a pile of bodies of one negative group.
#include "fast/body_pairs.hpp"

#include "mesh/filter.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace vox::fast {

namespace {

// Tests of the sweep for each box beyond which the join takes over. In the arrangements of bench_pairs_worst
// the two take equally long at 250 to 800, so the number matters little.
constexpr std::uint64_t most_tests = 400;
constexpr std::uint64_t few_boxes = 64; // up to so many, the sweep is always used

// The bits of a float in the order of its value; the two zeros are one.
std::uint32_t ordered_bits(float value) noexcept {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

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
             Array<std::uint32_t>& first) {
    first.assign(indices + 1, 0);
    for (const Pair& pair : from) ++first[pair.*key + 1];
    for (std::size_t i = 1; i <= indices; ++i) first[i] += first[i - 1];
    for (const Pair& pair : from) to[first[pair.*key]++] = pair;
}

// True if a pair of bodies is wanted; PairRules says when.
bool is_wanted(const Body& a, bool a_moved, const Body& b, bool b_moved) {
    return (a_moved || b_moved) && !(a.tets.empty() && b.tets.empty()) && collide(a, b);
}

// Collects the pairs that are wanted.
class PairCollector {
public:
    PairCollector(const PairRules& rules, Array<Pair>& found) : rules_(rules), found_(found) {
        found_.clear();
    }

    // Two boxes overlap.
    void add(std::uint32_t a, std::uint32_t b) {
        if (!rules_.bodies.empty() &&
            !is_wanted(rules_.bodies[a], rules_.has_moved(a), rules_.bodies[b], rules_.has_moved(b)))
            return;
        found_.push_back({a, b});
        found_.push_back({b, a});
    }

    void count_looks(std::uint64_t looks) noexcept { looks_ += looks; }
    std::uint64_t looks() const noexcept { return looks_; }

private:
    const PairRules& rules_;
    Array<Pair>& found_;
    std::uint64_t looks_ = 0;
};

// The boxes that are not empty, by where they begin along an axis, then by index.
void sort_boxes(std::span<const Box> boxes, int axis, PairBuffers& buffers) {
    buffers.corners.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!is_empty(boxes[i]))
            buffers.corners.push_back(std::uint64_t{ordered_bits(boxes[i].lo[axis])} << 32 | i);
    std::sort(buffers.corners.begin(), buffers.corners.end());
    buffers.order.resize(buffers.corners.size());
    buffers.boxes.resize(buffers.corners.size());
    for (std::size_t i = 0; i < buffers.corners.size(); ++i) {
        buffers.order[i] = static_cast<std::uint32_t>(buffers.corners[i]);
        buffers.boxes[i] = boxes[buffers.order[i]];
    }
}

// ---- the sweep --------------------------------------------------------------------------------------

// How many tests it takes, or a number above `most` where it takes more.
std::uint64_t count_tests(std::span<const Box> sorted, int axis, std::uint64_t most) {
    std::uint64_t tests = 0;
    for (std::size_t i = 0; i < sorted.size() && tests <= most; ++i) {
        const float end = sorted[i].hi[axis];
        const auto after = sorted.subspan(i + 1);
        const auto next =
            std::ranges::upper_bound(after, end, {}, [axis](const Box& box) { return box.lo[axis]; });
        tests += static_cast<std::uint64_t>(next - after.begin());
    }
    return tests;
}

void sweep(std::span<const Box> sorted, std::span<const std::uint32_t> order, int axis, PairCollector& out) {
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Box box = sorted[i];
        std::size_t j = i + 1;
        for (; j < order.size() && sorted[j].lo[axis] <= box.hi[axis]; ++j)
            if (overlap(box, sorted[j])) out.add(order[i], order[j]);
        out.count_looks(j - i);
    }
}

// ---- the join ---------------------------------------------------------------------------------------

// Ranks the sorted boxes. Their last axis is the given one.
void rank_boxes(int axis_of_last, PairBuffers& buffers) {
    const auto count = static_cast<std::uint32_t>(buffers.order.size());
    buffers.ranked.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) buffers.ranked[i].box = buffers.order[i];
    buffers.corners.resize(2 * std::size_t{count});
    for (int axis = 0; axis < 3; ++axis) {
        const int from = (axis_of_last + 1 + axis) % 3;
        for (std::uint32_t i = 0; i < count; ++i) { // low corners before high ones in the same place
            const Box& box = buffers.boxes[i];
            buffers.corners[i] = std::uint64_t{ordered_bits(box.lo[from])} << 32 | i;
            buffers.corners[count + i] = std::uint64_t{ordered_bits(box.hi[from])} << 32 | (count + i);
        }
        std::sort(buffers.corners.begin(), buffers.corners.end());
        std::uint32_t next = 0;
        for (const std::uint64_t item : buffers.corners) {
            const auto corner = static_cast<std::uint32_t>(item);
            if (corner < count)
                buffers.ranked[corner].lo[axis] = next++;
            else
                buffers.ranked[corner - count].hi[axis] = next - 1;
        }
    }
}

bool overlap(const RankedBox& a, const RankedBox& b, int axis) noexcept {
    return (a.lo[axis] <= b.hi[axis]) & (b.lo[axis] <= a.hi[axis]);
}

bool holds_low_corner(const RankedBox& outer, const RankedBox& inner, int axis) noexcept {
    return (outer.lo[axis] <= inner.lo[axis]) & (inner.lo[axis] <= outer.hi[axis]);
}

// Adds all pairs of an outer and an inner box of which the outer one holds the low corner of the inner one
// along `axis`, and that overlap along the axes before it; along those after it they are known to. It goes
// down a segment tree over the ranks [first, last), of `all` ranks, that is not stored. The low corners of
// inner boxes are in that range, and outer boxes meet it. Boxes change their order.
void join(std::span<RankedBox> outer, std::span<RankedBox> inner, std::uint32_t first, std::uint32_t last,
          std::uint32_t all, int axis, PairCollector& out) {
    constexpr std::size_t few = 12; // boxes that are tested one by one
    const auto add = [&](const RankedBox& a, const RankedBox& b) {
        if (a.box != b.box) out.add(a.box, b.box);
    };
    if (outer.empty() || inner.empty()) return;
    if (std::min(outer.size(), inner.size()) <= few) {
        out.count_looks(outer.size() * inner.size());
        for (const RankedBox& a : outer)
            for (const RankedBox& b : inner) {
                bool meet = holds_low_corner(a, b, axis);
                for (int i = 0; i < axis; ++i) meet &= overlap(a, b, i);
                if (meet) add(a, b);
            }
        return;
    }
    out.count_looks(outer.size() + inner.size());
    const auto end_of_spanning = std::partition(outer.begin(), outer.end(), [=](const RankedBox& box) {
        return box.lo[axis] <= first && box.hi[axis] >= last - 1;
    });
    const std::span<RankedBox> spanning(outer.begin(), end_of_spanning), rest(end_of_spanning, outer.end());
    if (axis > 0) {
        join(spanning, inner, 0, all, all, axis - 1, out);
        join(inner, spanning, 0, all, all, axis - 1, out);
    } else {
        out.count_looks(spanning.size() * inner.size());
        for (const RankedBox& a : spanning)
            for (const RankedBox& b : inner) add(a, b);
    }
    if (rest.empty()) return;
    const std::uint32_t middle = first + (last - first) / 2;
    const auto low_inner = std::partition(inner.begin(), inner.end(),
                                          [=](const RankedBox& box) { return box.lo[axis] < middle; });
    const auto low_end =
        std::partition(rest.begin(), rest.end(), [=](const RankedBox& box) { return box.lo[axis] < middle; });
    join({rest.begin(), low_end}, {inner.begin(), low_inner}, first, middle, all, axis, out);
    const auto high_end = std::partition(rest.begin(), rest.end(),
                                         [=](const RankedBox& box) { return box.hi[axis] >= middle; });
    join({rest.begin(), high_end}, {low_inner, inner.end()}, middle, last, all, axis, out);
}

constexpr int last_axis = 2;

// ---- classes ----------------------------------------------------------------------------------------

// Bodies that all rules but exceptions treat alike.
struct RuleClass {
    Body body; // its filter, and tets if any
    bool moved;
    std::uint32_t first, count; // of the boxes, sorted by class
};

// Gives each ranked box its class. Returns how many there are, or 0 where there are no rules or too many.
std::size_t find_classes(const PairRules& rules, std::span<RankedBox> ranked,
                         std::array<RuleClass, most_rule_classes>& classes) {
    std::size_t count = 0;
    if (rules.bodies.empty()) return 0;
    for (RankedBox& box : ranked) {
        const Body& body = rules.bodies[box.box];
        const bool moved = rules.has_moved(box.box);
        std::size_t c = 0;
        while (c < count && (classes[c].body.filter != body.filter || classes[c].moved != moved ||
                             classes[c].body.tets.empty() != body.tets.empty()))
            ++c;
        if (c == most_rule_classes) return 0;
        if (c == count) {
            classes[count++] = {{.tets = body.tets, .filter = body.filter}, moved, 0, 0};
        }
        box.rule = static_cast<std::uint32_t>(c);
        ++classes[c].count;
    }
    return count;
}

void join_classes(const PairRules& rules, PairBuffers& buffers, PairCollector& out) {
    std::array<RuleClass, most_rule_classes> classes;
    const std::size_t count = find_classes(rules, buffers.ranked, classes);
    const auto all = static_cast<std::uint32_t>(buffers.ranked.size());
    if (count == 0) {
        buffers.inner.assign(buffers.ranked.begin(), buffers.ranked.end());
        return join(buffers.ranked, buffers.inner, 0, all, all, last_axis, out);
    }
    std::sort(buffers.ranked.begin(), buffers.ranked.end(), [](const RankedBox& a, const RankedBox& b) {
        return a.rule != b.rule ? a.rule < b.rule : a.box < b.box;
    });
    std::uint32_t first = 0;
    for (std::size_t c = 0; c < count; first += classes[c++].count) classes[c].first = first;
    const auto of_class = [&](const RuleClass& c) {
        return std::span<const RankedBox>(buffers.ranked).subspan(c.first, c.count);
    };
    const auto meet = [](const RuleClass& a, const RuleClass& b) {
        return is_wanted(a.body, a.moved, b.body, b.moved);
    };
    for (std::size_t c = 0; c < count; ++c) {
        const std::span<const RankedBox> own = of_class(classes[c]);
        buffers.outer.assign(own.begin(), own.end());
        buffers.inner.clear();
        if (meet(classes[c], classes[c])) {
            buffers.inner.assign(own.begin(), own.end());
            join(buffers.outer, buffers.inner, 0, all, all, last_axis, out);
            buffers.inner.clear();
        }
        for (std::size_t d = c + 1; d < count; ++d) {
            const std::span<const RankedBox> others = of_class(classes[d]);
            if (meet(classes[c], classes[d]))
                buffers.inner.insert(buffers.inner.end(), others.begin(), others.end());
        }
        join(buffers.outer, buffers.inner, 0, all, all, last_axis, out);
        join(buffers.inner, buffers.outer, 0, all, all, last_axis, out);
    }
}

} // namespace

void find_pairs(std::span<const Box> boxes, const PairRules& rules, PairBuffers& buffers,
                Array<Pair>& pairs) {
    const int axis = widest_axis(boxes);
    sort_boxes(boxes, axis, buffers);
    const std::size_t count = buffers.order.size();
    const std::uint64_t most = most_tests * count;
    PairCollector out(rules, buffers.found);
    if (count <= few_boxes || count_tests(buffers.boxes, axis, most) <= most) {
        sweep(buffers.boxes, buffers.order, axis, out);
    } else {
        rank_boxes(axis, buffers);
        join_classes(rules, buffers, out);
    }
    buffers.looks = out.looks();

    Array<Pair>& found = buffers.found;
    pairs.resize(found.size());
    sort_by(&Pair::b, boxes.size(), found, pairs, buffers.first);
    std::copy(pairs.begin(), pairs.end(), found.begin());
    sort_by(&Pair::a, boxes.size(), found, pairs, buffers.first);
}

} // namespace vox::fast
