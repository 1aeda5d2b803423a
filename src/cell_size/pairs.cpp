// Groups of far boxes are represented by one as in J. Barnes, P. Hut, A hierarchical O(N log N)
// force-calculation algorithm, Nature 324, 1986, but by one that is drawn from them, so that no sum is
// biased. The order of boxes is that of G. M. Morton, A computer oriented geodetic data base, IBM 1966.
#include "cell_size/pairs.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace vox {

// ---- tree -----------------------------------------------------------------------------------------

namespace {

constexpr std::size_t longest_run = 8; // of boxes whose order does not matter
constexpr std::size_t least_for_radix = 256;

// The key of a place above, the index of a box below.
using Keyed = std::uint64_t;

std::uint32_t index_of(Keyed keyed) noexcept { return static_cast<std::uint32_t>(keyed); }

std::uint32_t spread_bits(std::uint32_t v) noexcept { // ten bits, two zeros after each
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

void sort_keys(Keyed* keys, Keyed* other, std::size_t count) {
    if (count < least_for_radix) return std::sort(keys, keys + count);
    for (int shift = 32; shift < 62; shift += 10) {
        std::array<std::uint32_t, 1025> begin{};
        for (std::size_t i = 0; i < count; ++i) ++begin[(keys[i] >> shift & 1023) + 1];
        for (std::size_t b = 1; b < begin.size(); ++b) begin[b] += begin[b - 1];
        for (std::size_t i = 0; i < count; ++i) other[begin[keys[i] >> shift & 1023]++] = keys[i];
        std::swap(keys, other);
    }
    // After three passes the sorted keys are in what was `other`.
    std::copy_n(keys, count, other);
}

// Sorts by place, and those that are so close together that they have one key by their place among
// themselves.
void sort_by_place(const PlainBox* boxes, Keyed* keys, Keyed* other, std::size_t count) {
    if (count <= 1) return;
    PlainBox bounds = boxes[index_of(keys[0])].centre();
    for (std::size_t i = 1; i < count; ++i) bounds.include(boxes[index_of(keys[i])].centre());
    const double longest = bounds.longest_side(), scale = 1023.99 / longest;
    if (!(longest > 0) || !std::isfinite(scale)) return;
    for (std::size_t i = 0; i < count; ++i) {
        const PlainBox at = boxes[index_of(keys[i])].centre();
        std::uint32_t key = 0;
        for (int a = 0; a < 3; ++a)
            key |= spread_bits(static_cast<std::uint32_t>((at.lo[a] - bounds.lo[a]) * scale)) << a;
        keys[i] = Keyed{key} << 32 | index_of(keys[i]);
    }
    sort_keys(keys, other, count);
    for (std::size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && keys[end] >> 32 == keys[i] >> 32; ++end) {
        }
        if (end - i > longest_run) sort_by_place(boxes, keys + i, other + i, end - i);
    }
}

PlainBox box_of(const FourBoxes& boxes) noexcept {
    PlainBox box = boxes.get(0);
    for (std::size_t i = 1; i < 4; ++i) box.include(boxes.get(i));
    return box;
}

} // namespace

void SampleTree::build(bool centres, double of_all, std::uint64_t most) {
    const std::size_t stride =
        stride_for(added_.size(), static_cast<std::size_t>(std::min<std::uint64_t>(added_.size(), most)));
    const std::size_t count = (added_.size() + stride - 1) / stride;
    for (std::size_t i = 0; i < count; ++i) {
        added_[i] = added_[i * stride];
        ids_[i] = ids_[i * stride];
    }
    ids_.resize(count);
    share_ = static_cast<double>(count) / of_all;
    Array<Keyed> keys(count, added_.memory()), other(count, added_.memory());
    for (std::size_t i = 0; i < count; ++i) keys[i] = i;
    sort_by_place(added_.data(), keys.data(), other.data(), count);
    groups_.reserve((count + 3) / 4 * 4 / 3 + most_levels);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t index = index_of(keys[i]);
        if (i % 4 == 0) groups_.push_back(no_boxes);
        groups_.back().set(i % 4, centres ? added_[index].centre() : added_[index]);
        keys[i] = ids_[index];
    }
    for (std::size_t i = 0; i < count; ++i) ids_[i] = index_of(keys[i]);
    added_ = Array<PlainBox>(added_.memory());
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

// Which of four boxes meet a cube [lo, hi): those that end at lo or above and begin below hi, along all axes.
void find_meeting(const FourBoxes& boxes, const double (&lo)[3], const double (&hi)[3],
                  bool (&meets)[4]) noexcept {
    double end_below[4], begin_above[4]; // how far, along the axis where that is most
    for (std::size_t i = 0; i < 4; ++i) end_below[i] = begin_above[i] = -endless;
    for (int a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < 4; ++i) {
            end_below[i] = std::max(end_below[i], lo[a] - boxes.hi[a][i]);
            begin_above[i] = std::max(begin_above[i], boxes.lo[a][i] - hi[a]);
        }
    for (std::size_t i = 0; i < 4; ++i) meets[i] = bool(int(end_below[i] <= 0) & int(begin_above[i] < 0));
}

bool is_inside(const PlainBox& box, const double (&lo)[3], const double (&hi)[3]) noexcept {
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside &= box.lo[a] >= lo[a] && box.hi[a] < hi[a];
    return inside;
}

} // namespace

double SampleTree::count_meeting(const double (&lo)[3], double side, double rough,
                                 double enough) const noexcept {
    const double hi[3] = {lo[0] + side, lo[1] + side, lo[2] + side};
    double count = 0;
    Place stack[most_stacked];
    int top = 0;
    stack[top++] = {levels_ - 1, 0};
    while (top > 0 && count < enough) {
        const Place p = stack[--top];
        const FourBoxes& group = groups_[first_[p.level] + p.group];
        bool meets[4];
        find_meeting(group, lo, hi, meets);
        if (p.level == 0) {
            count += static_cast<double>(int{meets[0]} + int{meets[1]} + int{meets[2]} + int{meets[3]});
            continue;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            if (!meets[i]) continue;
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

// ---- asking ---------------------------------------------------------------------------------------

Array<Asking> choose_of_kinds(std::span<const std::uint32_t> kind_of, std::size_t wanted, double each,
                              std::pmr::memory_resource* memory) {
    Array<Asking> chosen(memory);
    const std::size_t count = kind_of.size();
    if (count <= wanted) {
        chosen.reserve(count);
        for (std::size_t i = 0; i < count; ++i) chosen.push_back({i, each});
        return chosen;
    }
    struct Kind {
        std::uint32_t kind, count;
    };
    Array<Kind> kinds(memory);
    Array<std::uint32_t> place_of(count, memory);
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto is_same = [&](const Kind& kind) { return kind.kind == kind_of[i]; };
        if (kinds.empty() || !is_same(kinds[k])) { // often that of the one before
            k = static_cast<std::size_t>(std::find_if(kinds.begin(), kinds.end(), is_same) - kinds.begin());
            if (k == kinds.size()) kinds.push_back({kind_of[i], 0});
        }
        ++kinds[k].count;
        place_of[i] = static_cast<std::uint32_t>(k);
    }
    Array<std::uint32_t> begin(memory), sorted(count, memory);
    begin.reserve(kinds.size());
    std::uint32_t before = 0;
    for (const Kind& kind : kinds) {
        begin.push_back(before);
        before += kind.count;
    }
    for (std::size_t i = 0; i < count; ++i) sorted[begin[place_of[i]]++] = static_cast<std::uint32_t>(i);

    std::uint64_t random = 1;
    std::size_t first = 0;
    for (const Kind& kind : kinds) {
        const auto there = static_cast<double>(kind.count);
        const double part = (there / static_cast<double>(count) + 1 / static_cast<double>(kinds.size())) / 2;
        const auto places = std::min(std::size_t{kind.count},
                                     static_cast<std::size_t>(static_cast<double>(wanted) * part) + 1);
        const double step = there / static_cast<double>(places);
        for (std::size_t p = 0; p < places; ++p) {
            const auto at =
                std::min(static_cast<std::size_t>((static_cast<double>(p) + next_unit(random)) * step),
                         std::size_t{kind.count} - 1);
            chosen.push_back({sorted[first + at], each * step});
        }
        first += kind.count;
    }
    return chosen;
}

// By the octaves of the own size and of that of 16 neighbours; the order in a kind is that of places.
Array<Asking> choose_asking(const SampleTree& tree, std::size_t wanted, std::pmr::memory_resource* memory) {
    const auto octave = [](double size) {
        return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(size) >> 52);
    };
    Array<std::uint32_t> kind_of(tree.size(), memory);
    if (tree.size() > wanted)
        for (std::size_t i = 0; i < tree.size(); ++i)
            kind_of[i] = octave(tree.box(i).longest_side()) << 12 | octave(tree.crowd_side(i));
    return choose_of_kinds(kind_of, wanted, 1 / tree.share(), memory);
}

// ---- pairs ----------------------------------------------------------------------------------------

namespace {

void add_neighbours(const PlainBox& a, const PlainBox& b, double weight, PiecewiseMoments& sums) {
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
                           double coarse, bool around, bool same_set, std::pmr::memory_resource* memory) {
    PlainBox bounds = from.bounds();
    bounds.include(held.bounds());
    const double longest = bounds.longest_side();
    PiecewiseMoments sums((longest > 0 ? longest : 1) * 0x1p-32, 34, memory);
    std::uint64_t random = 2;
    for (const Asking& ask : asking) {
        const PlainBox box = from.box(ask.index);
        const std::uint32_t id = from.id(ask.index);
        const double each = ask.weight / held.share();
        for_fours_around(box, held, coarse, random,
                         [&](const FourBoxes& others, const std::uint32_t* ids, const double* numbers) {
                             double weights[4];
                             for (std::size_t i = 0; i < 4; ++i)
                                 weights[i] = same_set && ids[i] == id ? 0 : each * numbers[i];
                             if (!around) return add_common_cells(box, others, weights, sums);
                             for (std::size_t i = 0; i < 4; ++i)
                                 if (weights[i] > 0) add_neighbours(box, others.get(i), weights[i], sums);
                         });
    }
    sums.finish();
    return sums;
}

// ---- what is in cells -----------------------------------------------------------------------------

double some_cell(const PlainBox& box, double d, bool around, std::uint64_t& random,
                 double (&lo)[3]) noexcept {
    double of = 1;
    for (int a = 0; a < 3; ++a) {
        const double before = next_unit(random) * d; // from a plane of the lattice to the box
        double first = 0, count = std::floor((before + box.side(a)) / d) + 1;
        if (around) {
            first = -1;
            count += 2;
        }
        lo[a] = box.lo[a] - before + (first + std::floor(next_unit(random) * count)) * d;
        of *= count;
    }
    return of;
}

namespace {

double power_of_none(double m, double q) noexcept { // (1 + q)^(-m / q)
    return std::abs(q) < 1e-6 ? std::exp(-m) : std::exp(-m / q * std::log1p(q));
}

// The integral of the generating function (1 + q (1 - s))^(-m / q) from 0 to 1.
double integral(double m, double q) noexcept {
    if (m < 1e-9) return 1;
    if (std::abs(q) < 1e-6) return -std::expm1(-m) / m;
    const double power = 1 - m / q;
    if (std::abs(power) < 1e-6) return std::log1p(q) / q;
    return std::expm1(power * std::log1p(q)) / (power * q);
}

} // namespace

double CellCounts::none() const noexcept {
    if (weight_ == 0) return known_ / known_weight_;
    return power_of_none(mean_ / weight_, excess());
}

double CellCounts::mean_inverse() const noexcept {
    return (known_ + (weight_ > 0 ? weight_ * integral(mean_ / weight_, excess()) : 0)) /
           (known_weight_ + weight_);
}

// The variance over the mean, less 1; at least what a number of things can have that are in the cell or not.
double CellCounts::excess() const noexcept {
    const double m = mean_ / weight_;
    return m > 0 ? std::max(factorial_ / weight_ / m - m, -0.9) : 0;
}

void look_at_entries(const SampleTree& own, const SampleTree* other, const Array<Asking>& chosen,
                     std::size_t cells, double size, double rough, double crowd, std::uint64_t& random,
                     CellCounts& counts) noexcept {
    const double p = own.share(), q = other ? other->share() : 1;
    const bool all_kept = p == 1 && q == 1;
    for (std::size_t i = 0; i < cells; ++i) {
        const Asking& one = chosen[i * chosen.size() / cells];
        double lo[3];
        const double weight = one.weight * some_cell(own.box(one.index), size, false, random, lo) *
                              static_cast<double>(chosen.size());
        const double a = std::max(own.count_meeting(lo, size, rough) - 1, 0.0); // beside itself
        const double b = other ? other->count_meeting(lo, size, rough) : 0;
        if (all_kept || a + b > crowd)
            counts.add_known(weight, weight / (1 + a / p + b / q));
        else
            counts.add_part(weight, a / p + b / q,
                            a * (a - 1) / (p * p) + 2 * a * b / (p * q) + b * (b - 1) / (q * q));
    }
}

} // namespace vox
