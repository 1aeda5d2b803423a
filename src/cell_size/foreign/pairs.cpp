// Groups of far boxes are represented by one as in J. Barnes, P. Hut, A hierarchical O(N log N)
// force-calculation algorithm, Nature 324, 1986, but by one that is drawn from them, so that no sum is
// biased. The order of boxes is that of G. M. Morton, A computer oriented geodetic data base, IBM 1966.
#include "cell_size/foreign/pairs.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace vox {

// ---- sums -----------------------------------------------------------------------------------------

void PiecewiseMoments::finish() noexcept {
    for (std::size_t c = 1; c < classes; ++c) sums_[c].add(sums_[c - 1]);
}

// The class of the cell size itself is added in part, so that the sum is continuous.
double PiecewiseMoments::at(double d) const noexcept {
    const double ratio = d * inverse_least_;
    const std::size_t c = class_of_ratio(ratio, step_bits);
    if (c == 0) return std::max(sums_[0].at(d), 0.0); // rounding can leave a little less
    if (c >= classes) return std::max(sums_.back().at(d), 0.0);
    constexpr std::uint64_t rest = std::uint64_t{1} << (52 - step_bits);
    const double part = static_cast<double>(std::bit_cast<std::uint64_t>(ratio) & (rest - 1)) / double{rest};
    const double below = sums_[c - 1].at(d);
    return std::max(below + part * (sums_[c].at(d) - below), 0.0);
}

// ---- tree -----------------------------------------------------------------------------------------

namespace {

constexpr std::size_t longest_run = 8; // of boxes whose order does not matter
constexpr std::size_t least_for_radix = 256;

struct Keyed {
    std::uint32_t key, index;
};

std::uint32_t spread_bits(std::uint32_t v) noexcept { // ten bits, two zeros after each
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

void sort_keys(Keyed* keys, Keyed* other, std::size_t count) {
    if (count < least_for_radix) {
        std::sort(keys, keys + count, [](const Keyed& a, const Keyed& b) {
            return a.key != b.key ? a.key < b.key : a.index < b.index;
        });
        return;
    }
    for (int shift = 0; shift < 30; shift += 10) {
        std::array<std::uint32_t, 1025> begin{};
        for (std::size_t i = 0; i < count; ++i) ++begin[(keys[i].key >> shift & 1023) + 1];
        for (std::size_t b = 1; b < begin.size(); ++b) begin[b] += begin[b - 1];
        for (std::size_t i = 0; i < count; ++i) other[begin[keys[i].key >> shift & 1023]++] = keys[i];
        std::swap(keys, other);
    }
    // After three passes the sorted keys are in what was `other`.
    std::copy_n(keys, count, other);
}

// Sorts by place, and those that are so close together that they have one key by their place among
// themselves.
void sort_by_place(const PlainBox* boxes, Keyed* keys, Keyed* other, std::size_t count) {
    if (count <= 1) return;
    PlainBox bounds = boxes[keys[0].index].centre();
    for (std::size_t i = 1; i < count; ++i) bounds.include(boxes[keys[i].index].centre());
    const double longest = bounds.longest_side(), scale = 1023.99 / longest;
    if (!(longest > 0) || !std::isfinite(scale)) return;
    for (std::size_t i = 0; i < count; ++i) {
        const PlainBox at = boxes[keys[i].index].centre();
        std::uint32_t key = 0;
        for (int a = 0; a < 3; ++a)
            key |= spread_bits(static_cast<std::uint32_t>((at.lo[a] - bounds.lo[a]) * scale)) << a;
        keys[i].key = key;
    }
    sort_keys(keys, other, count);
    for (std::size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && keys[end].key == keys[i].key; ++end) {
        }
        if (end - i > longest_run) sort_by_place(boxes, keys + i, other + i, end - i);
    }
}

} // namespace

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
// They are away from everything, and add nothing to a box.
constexpr FourBoxes no_boxes{{{endless, endless, endless, endless},
                              {endless, endless, endless, endless},
                              {endless, endless, endless, endless}},
                             {{-endless, -endless, -endless, -endless},
                              {-endless, -endless, -endless, -endless},
                              {-endless, -endless, -endless, -endless}}};

PlainBox box_of(const FourBoxes& boxes) noexcept {
    PlainBox box = boxes.get(0);
    for (std::size_t i = 1; i < 4; ++i) box.include(boxes.get(i));
    return box;
}

} // namespace

SampleTree::SampleTree(const BoxSample& sample, bool centres, double share, std::pmr::memory_resource* memory)
    : groups_(memory), ids_(memory), share_(share) {
    const std::size_t count = sample.boxes.size();
    Array<Keyed> keys(count, memory), other(count, memory);
    for (std::size_t i = 0; i < count; ++i) keys[i].index = static_cast<std::uint32_t>(i);
    sort_by_place(sample.boxes.data(), keys.data(), other.data(), count);
    ids_.reserve(count);
    groups_.reserve((count + 3) / 4 * 4 / 3 + most_levels);
    for (std::size_t i = 0; i < count; ++i) {
        const PlainBox& box = sample.boxes[keys[i].index];
        if (i % 4 == 0) groups_.push_back(no_boxes);
        groups_.back().set(i % 4, centres ? box.centre() : box);
        ids_.push_back(sample.ids[keys[i].index]);
    }
    // A level has a box for each group of the one below.
    for (levels_ = 1;; ++levels_) {
        const std::size_t below = first_[levels_ - 1], end = groups_.size();
        first_[levels_] = end;
        if (end - below == 1) break;
        for (std::size_t g = below; g < end; ++g) {
            if ((g - below) % 4 == 0) groups_.push_back(no_boxes);
            groups_.back().set((g - below) % 4, box_of(groups_[g]));
        }
    }
    bounds_ = box_of(groups_.back());
}

double SampleTree::crowd_side(std::size_t i) const noexcept {
    const std::size_t level = std::min<std::size_t>(2, levels_ - 1), at = i >> (2 * level);
    return groups_[first_[level] + at / 4].get(at % 4).longest_side();
}

namespace {

// How far four boxes are from a cube [lo, hi) along the axis where that is most: those meet it that end at lo
// or above and begin below hi.
struct FourDistances {
    double end_below[4], begin_above[4];

    FourDistances(const FourBoxes& boxes, const double (&lo)[3], const double (&hi)[3]) noexcept {
        for (std::size_t i = 0; i < 4; ++i) end_below[i] = begin_above[i] = -endless;
        for (int a = 0; a < 3; ++a)
            for (std::size_t i = 0; i < 4; ++i) {
                end_below[i] = std::max(end_below[i], lo[a] - boxes.hi[a][i]);
                begin_above[i] = std::max(begin_above[i], boxes.lo[a][i] - hi[a]);
            }
    }
    bool meets(std::size_t i) const noexcept { return end_below[i] <= 0 && begin_above[i] < 0; }
    std::size_t meeting() const noexcept {
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i)
            count +=
                static_cast<std::size_t>(end_below[i] <= 0) & static_cast<std::size_t>(begin_above[i] < 0);
        return count;
    }
};

bool is_inside(const PlainBox& box, const double (&lo)[3], const double (&hi)[3]) noexcept {
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside &= box.lo[a] >= lo[a] && box.hi[a] < hi[a];
    return inside;
}

} // namespace

double SampleTree::count_meeting(const double (&lo)[3], double side, double rough) const noexcept {
    const double hi[3] = {lo[0] + side, lo[1] + side, lo[2] + side};
    double count = 0;
    Place stack[most_stacked];
    int top = 0;
    stack[top++] = {levels_ - 1, 0};
    while (top > 0) {
        const Place p = stack[--top];
        const FourBoxes& group = groups_[first_[p.level] + p.group];
        const FourDistances distances(group, lo, hi);
        if (p.level == 0) {
            count += static_cast<double>(distances.meeting());
            continue;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            if (!distances.meets(i)) continue;
            const Place child{p.level - 1, 4 * p.group + i};
            const auto most = static_cast<double>(boxes_in(child));
            if (most <= rough * count)
                count += most / 2;
            else if (is_inside(group.get(i), lo, hi))
                count += most;
            else
                stack[top++] = child;
        }
    }
    return count;
}

bool SampleTree::meets_any(const double (&lo)[3], double side) const noexcept {
    const double hi[3] = {lo[0] + side, lo[1] + side, lo[2] + side};
    Place stack[most_stacked];
    int top = 0;
    stack[top++] = {levels_ - 1, 0};
    while (top > 0) {
        const Place p = stack[--top];
        const FourBoxes& group = groups_[first_[p.level] + p.group];
        const FourDistances distances(group, lo, hi);
        for (std::size_t i = 0; i < 4; ++i) {
            if (!distances.meets(i)) continue;
            if (p.level == 0 || is_inside(group.get(i), lo, hi)) return true;
            stack[top++] = {p.level - 1, 4 * p.group + i};
        }
    }
    return false;
}

// ---- asking ---------------------------------------------------------------------------------------

Array<Asking> choose_asking(const SampleTree& tree, std::size_t wanted, std::pmr::memory_resource* memory) {
    Array<Asking> chosen(memory);
    const std::size_t count = tree.size();
    const double each = 1 / tree.share();
    if (count <= wanted) {
        chosen.reserve(count);
        for (std::size_t i = 0; i < count; ++i) chosen.push_back({i, each});
        return chosen;
    }
    // By the octaves of the own size and of that of 16 neighbours; the order in a kind is that of places.
    const auto octave = [](double size) {
        return static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52);
    };
    struct Kind {
        int own, crowd;
        std::uint32_t count;
    };
    Array<Kind> kinds(memory);
    Array<std::uint32_t> kind_of(count, memory);
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int own = octave(tree.box(i).longest_side()), crowd = octave(tree.crowd_side(i));
        const auto is_same = [&](const Kind& kind) { return kind.own == own && kind.crowd == crowd; };
        if (kinds.empty() || !is_same(kinds[k])) { // often that of the box before
            k = static_cast<std::size_t>(std::find_if(kinds.begin(), kinds.end(), is_same) - kinds.begin());
            if (k == kinds.size()) kinds.push_back({own, crowd, 0});
        }
        ++kinds[k].count;
        kind_of[i] = static_cast<std::uint32_t>(k);
    }
    Array<std::uint32_t> begin(memory), sorted(count, memory);
    begin.reserve(kinds.size());
    std::uint32_t before = 0;
    for (const Kind& kind : kinds) {
        begin.push_back(before);
        before += kind.count;
    }
    for (std::size_t i = 0; i < count; ++i) sorted[begin[kind_of[i]]++] = static_cast<std::uint32_t>(i);

    std::uint64_t random = 1;
    std::size_t first = 0;
    for (const Kind& kind : kinds) {
        // Half of the places go to the kinds by their number, half evenly: a few large boxes, or few that are
        // close together, can cost as much as many others.
        const auto there = static_cast<double>(kind.count);
        const double part = (there / static_cast<double>(count) + 1 / static_cast<double>(kinds.size())) / 2;
        const auto places = std::min(std::size_t{kind.count},
                                     static_cast<std::size_t>(static_cast<double>(wanted) * part) + 1);
        const double step = there / static_cast<double>(places);
        for (std::size_t k = 0; k < places; ++k) {
            const double place = static_cast<double>(next_random(random) >> 11) * 0x1p-53;
            const auto at = std::min(static_cast<std::size_t>((static_cast<double>(k) + place) * step),
                                     std::size_t{kind.count} - 1);
            chosen.push_back({sorted[first + at], each * step});
        }
        first += kind.count;
    }
    return chosen;
}

// ---- pairs ----------------------------------------------------------------------------------------

namespace {

// Of four boxes, of which each counts `weights` times.
void add_common_cells(const PlainBox& box, const FourBoxes& others, const double (&weights)[4],
                      PiecewiseMoments& sums) noexcept {
    double gap[3][4], most[4], moments[4][4];
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 4; ++i)
            gap[k][i] = std::max(box.lo[k], others.lo[k][i]) - std::min(box.hi[k], others.hi[k][i]);
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = gap[0][i], y = gap[1][i], z = gap[2][i], w = weights[i];
        most[i] = std::max(std::max(x, y), z);
        moments[0][i] = w; // (1 - x/d) (1 - y/d) (1 - z/d)
        moments[1][i] = -w * (x + y + z);
        moments[2][i] = w * (x * y + (x + y) * z);
        moments[3][i] = -w * (x * y * z);
    }
    for (std::size_t i = 0; i < 4; ++i)
        if (weights[i] > 0) sums.add(most[i], {{moments[0][i], moments[1][i], moments[2][i], moments[3][i]}});
}

void add_neighbours(const PlainBox& a, const PlainBox& b, double weight, PiecewiseMoments& sums) noexcept {
    double x[3];
    for (int k = 0; k < 3; ++k) x[k] = std::abs(a.lo[k] - b.lo[k]);
    if (x[0] > x[1]) std::swap(x[0], x[1]);
    if (x[1] > x[2]) std::swap(x[1], x[2]);
    if (x[0] > x[1]) std::swap(x[0], x[1]);
    // From half of the largest distance on, each factor is 2 - x/d, or 1 from x on.
    const double from = x[2] / 2;
    double c[3] = {2, 2, 2}, s[3] = {x[0], x[1], x[2]};
    int k = 0;
    for (; k < 3 && x[k] <= from; ++k) {
        c[k] = 1;
        s[k] = 0;
    }
    sums.add(from, c, s, weight);
    for (; k < 3; ++k) {
        c[k] = -1; // 1 instead of 2 - x/d, beside the others
        s[k] = -x[k];
        sums.add(x[k], c, s, weight);
        c[k] = 1;
        s[k] = 0;
    }
}

} // namespace

PiecewiseMoments sum_pairs(const SampleTree& from, const Array<Asking>& asking, const SampleTree& held,
                           double coarse, Meeting meeting, bool same_set, std::pmr::memory_resource* memory) {
    PlainBox bounds = from.bounds();
    bounds.include(held.bounds());
    const double longest = bounds.longest_side();
    PiecewiseMoments sums(longest > 0 ? longest : 1, memory);
    std::uint64_t random = 2;
    for (const Asking& ask : asking) {
        const PlainBox box = from.box(ask.index);
        const std::uint32_t id = from.id(ask.index);
        const double each = ask.weight / held.share();
        const auto weight = [&](std::size_t i) { return same_set && held.id(i) == id ? 0 : each; };
        const auto add = [&](const FourBoxes& others, const double(&weights)[4]) {
            if (meeting == Meeting::in_cells) return add_common_cells(box, others, weights, sums);
            for (std::size_t i = 0; i < 4; ++i)
                if (weights[i] > 0) add_neighbours(box, others.get(i), weights[i], sums);
        };
        FourBoxes some; // those that stand for others, until there are four
        double weights_of_some[4];
        std::size_t count_of_some = 0;
        held.sample_around(
            box, coarse, random,
            [&](std::size_t first, std::size_t count) {
                double weights[4] = {0, 0, 0, 0};
                for (std::size_t i = 0; i < count; ++i) weights[i] = weight(first + i);
                add(held.four(first), weights);
            },
            [&](std::size_t i, double number) {
                some.set(count_of_some, held.box(i));
                weights_of_some[count_of_some] = number * weight(i);
                if (++count_of_some < 4) return;
                add(some, weights_of_some);
                count_of_some = 0;
            });
        std::fill(weights_of_some + count_of_some, weights_of_some + 4, 0.0);
        if (count_of_some > 0) add(some, weights_of_some);
    }
    sums.finish();
    return sums;
}

} // namespace vox
