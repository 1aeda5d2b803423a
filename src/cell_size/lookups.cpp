// Lookups of a class are sampled before their number is known, by Algorithm R (J. S. Vitter, Random sampling
// with a reservoir, ACM Trans. Math. Software 11, 1985).
#include "cell_size/lookups.hpp"

#include "base/array.hpp"
#include "base/sampling.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace vox {

namespace {

// Points nearer to a box than this multiple of its longest side are looked at in full, up to a number; those
// beyond are thinned out.
constexpr double near_sides = 1;
// At most this many rows of cells are looked at for one box.
constexpr std::size_t most_rows = 1024;
// About this many points are put into one cell.
constexpr double points_per_cell = 3;
// One of this many sampled lookups is used to estimate how many cells are occupied.
constexpr std::size_t crowd_part = 8;

double longest_side(const Lookup& l) {
    return std::max(std::max(l.hi[0] - l.lo[0], l.hi[1] - l.lo[1]), l.hi[2] - l.lo[2]);
}

// Distances of a point from a box along the axes; returns the largest.
double distances(const Lookup& l, const double (&p)[3], double (&along)[3]) {
    for (int a = 0; a < 3; ++a) along[a] = std::max(std::max(l.lo[a] - p[a], p[a] - l.hi[a]), 0.0);
    return std::max(std::max(along[0], along[1]), along[2]);
}

// All points, sorted into cells.
struct Binned {
    const fast::Window& window;
    const fast::Points& points;
    const std::uint32_t* begin; // of each cell
    std::size_t most_near;      // points looked at near one lookup
    struct Far {
        double at[3];
        std::uint32_t id;
    };
    std::span<const Far> far; // of all points, those that are looked at where they are far from a lookup
    double far_weight;        // how many points each of them stands for

    void at(std::size_t i, double (&p)[3]) const noexcept {
        p[0] = double{points.x[i]};
        p[1] = double{points.y[i]};
        p[2] = double{points.z[i]};
    }
};

// The cells that hold every point whose distance from a box is at most `near`.
void cells_around(const Lookup& l, double near, const fast::WindowLattice& lattice, std::uint32_t (&lo)[3],
                  std::uint32_t (&hi)[3]) {
    // Rounded outwards.
    constexpr double largest = std::numeric_limits<float>::max();
    for (int a = 0; a < 3; ++a) {
        const auto below = static_cast<float>(std::max(l.lo[a] - near, -largest));
        const auto above = static_cast<float>(std::min(l.hi[a] + near, largest));
        lo[a] = lattice.cell(std::nextafter(below, -float_infinity), a);
        hi[a] = lattice.cell(std::nextafter(above, float_infinity), a);
    }
}

// Calls count(id, distances, weight) for points around one lookup, of which each stands for `weight` points:
// near ones from the cells, far ones from all points at a stride.
template <class Count>
void for_points_around(const Lookup& l, double near, const Binned& in, std::uint64_t& random, Count&& count) {
    const fast::WindowLattice& lattice = in.window.lattice;
    std::uint32_t lo[3], hi[3];
    cells_around(l, near, lattice, lo, hi);
    const std::size_t rows_y = hi[1] - lo[1] + 1, rows = rows_y * (hi[2] - lo[2] + 1);
    const std::size_t row_stride = stride_for(rows, std::min(most_rows, in.most_near));
    const auto row_of = [&](std::size_t r) {
        const std::size_t y = lo[1] + r % rows_y, z = lo[2] + r / rows_y;
        return (z * lattice.cells[1] + y) * lattice.cells[0];
    };
    const std::size_t first_row = row_stride > 1 ? next_below(random, row_stride) : 0;
    std::size_t there = 0;
    for (std::size_t r = first_row; r < rows; r += row_stride)
        there += in.begin[row_of(r) + hi[0] + 1] - in.begin[row_of(r) + lo[0]];
    const std::size_t stride = stride_for(there, in.most_near);
    const auto near_weight = static_cast<double>(row_stride * stride);
    std::size_t skip = stride > 1 ? next_below(random, stride) : 0;
    double p[3], along[3];
    for (std::size_t r = first_row; r < rows; r += row_stride) {
        const std::size_t row = row_of(r), end = in.begin[row + hi[0] + 1];
        std::size_t i = in.begin[row + lo[0]] + skip;
        for (; i < end; i += stride) {
            in.at(i, p);
            if (distances(l, p, along) <= near) count(in.points.id[i], along, near_weight);
        }
        skip = i - end;
    }
    for (const Binned::Far& point : in.far)
        if (distances(l, point.at, along) > near) count(point.id, along, in.far_weight);
}

// Collects the points nearer to a box than `most`, or than some smaller distance where those are too many.
// Returns that distance; 0 where even those nearer than the smallest cell size are too many.
double gather(const Lookup& l, const BranchMisses& changes, double most, const Binned& in,
              Array<BranchMisses::Point>& points) {
    const fast::WindowLattice& lattice = in.window.lattice;
    const auto in_scale = [&](double length) { return static_cast<float>(length / changes.scale()); };
    for (double near = most; near >= changes.first_size(); near *= 0.8) {
        points.clear();
        std::uint32_t lo[3], hi[3];
        cells_around(l, near, lattice, lo, hi);
        for (std::uint32_t z = lo[2]; z <= hi[2]; ++z)
            for (std::uint32_t y = lo[1]; y <= hi[1] && points.size() <= BranchMisses::most_points; ++y) {
                const std::size_t row = (std::size_t{z} * lattice.cells[1] + y) * lattice.cells[0];
                for (std::size_t i = in.begin[row + lo[0]]; i < in.begin[row + hi[0] + 1]; ++i) {
                    double p[3], along[3];
                    in.at(i, p);
                    const double distance = distances(l, p, along);
                    if (distance >= near) continue;
                    points.push_back(
                        {{in_scale(p[0] - l.lo[0]), in_scale(p[1] - l.lo[1]), in_scale(p[2] - l.lo[2])},
                         in_scale(distance)});
                    if (points.size() > BranchMisses::most_points) break;
                }
            }
        if (points.size() <= BranchMisses::most_points) return near;
    }
    points.clear();
    return 0;
}

} // namespace

// The tests hold the loss in the model's own cost to 4 % for the reference engine, and 2 % for the fast one.
SampleBudget usual(vox_cost_model model, std::uint64_t tets) noexcept {
    const auto t = static_cast<std::size_t>(tets);
    if (model == VOX_COST_MODEL_FAST) return {0, std::clamp<std::size_t>(t / 512, 32, 128), 96, 32, 0, 64};
    const std::size_t lookups = std::clamp<std::size_t>(t / 1024, 32, 64);
    return {std::clamp<std::size_t>(t / 64, 1024, 2048),
            lookups,
            96,
            lookups,
            lookups * 3 / 4, // in small scenes, too: there is time for it
            64};
}

// Sample sizes are what keeps a suggestion below the time of a step (docs/cell-size.md, "What a suggestion
// costs") with a regret within a few per cent of the thorough look: the tests hold the loss in the model's
// own cost to 2 % (4 % with lists) for the reference engine and 3 % for the fast one.
SampleBudget quick(vox_cost_model model, std::uint64_t tets) noexcept {
    const auto t = static_cast<std::size_t>(tets);
    if (model == VOX_COST_MODEL_FAST) { // whose lookups are fewer and more alike, and its cost flatter
        const std::size_t lookups = std::clamp<std::size_t>(t / 2048, 4, 32);
        return {0, lookups, 2 * lookups + 32, lookups + 8, 0, std::max<std::size_t>(lookups, 16)};
    }
    // The lengths of lists take the surroundings of 128 boxes, 20 microseconds each, whatever the scene. At
    // this many tetrahedra a step takes 6 to 15 ms (docs/regret.md). In smaller scenes how the lattice
    // happens to lie matters more than the lengths of lists.
    constexpr std::size_t many = 60000;
    return {std::clamp<std::size_t>(t / 8, 512, std::size_t{1} << 15),
            std::clamp<std::size_t>(t / 400, 64, 256),
            128,
            std::clamp<std::size_t>(t / 256, 64, 192),
            t < many ? 0 : std::size_t{128},
            64};
}

// ---- sums -----------------------------------------------------------------------------------------

void PointsMet::grow(std::size_t to) { sums_.resize(to + 1); }

// The class of points about as far away as the cell size is added in part, so that the sum is continuous.
double PointsMet::at(double cell_size) const noexcept {
    if (sums_.size() == 1 && sums_[0].sum[0] == 0) return 0; // no points
    const double ratio = cell_size * inverse_least_;
    const std::size_t c = class_of(ratio);
    if (c == 0) return sums_[0].sum[0];
    if (c >= sums_.size()) return sums_.back().at(cell_size);
    constexpr std::uint64_t rest = std::uint64_t{1} << (52 - step_bits);
    const double part = static_cast<double>(std::bit_cast<std::uint64_t>(ratio) & (rest - 1)) / double{rest};
    const double below = sums_[c - 1].at(cell_size);
    return below + part * (sums_[c].at(cell_size) - below);
}

void PointsMet::finish() noexcept {
    for (std::size_t c = 1; c < sums_.size(); ++c) sums_[c].add(sums_[c - 1]);
}

// ---- lookups --------------------------------------------------------------------------------------

SizeClass::SizeClass(int e, bool may_meet_points, std::size_t most_samples, std::pmr::memory_resource* memory)
    : exponent(e), may_meet(may_meet_points), passed(std::ldexp(1.0, e), memory),
      tested(std::ldexp(1.0, e), memory), changes(std::ldexp(1.0, e)), sample(memory) {
    sample.reserve(most_samples);
}

Lookups::Lookups(const SampleBudget& budget, std::pmr::memory_resource* memory)
    : budget_(budget), classes_(memory) {
    index_.fill(-1);
}

SizeClass& Lookups::class_of(double side, bool may_meet) {
    // A box without sides counts as very small.
    const int exponent =
        side > 0 ? std::clamp(std::ilogb(side), -exponents / 2, exponents / 2 - 1) : -exponents / 2;
    std::int16_t& index = index_[2 * static_cast<std::size_t>(exponent + exponents / 2) + may_meet];
    if (index < 0) {
        index = static_cast<std::int16_t>(classes_.size());
        classes_.emplace_back(exponent, may_meet, budget_.lookups, classes_.memory());
    }
    return classes_[static_cast<std::size_t>(index)];
}

void Lookups::add(const Lookup& lookup, double weight) {
    SizeClass& c = class_of(longest_side(lookup), lookup.may_meet);
    const double w[3] = {lookup.hi[0] - lookup.lo[0], lookup.hi[1] - lookup.lo[1],
                         lookup.hi[2] - lookup.lo[2]};
    c.count += weight;
    if (lookup.jumps) c.jumped += weight;
    c.added += 1;
    c.cells.add(cells_met(w), weight);
    if (c.sample.size() < budget_.lookups) {
        c.sample.push_back(lookup);
        return;
    }
    const std::uint64_t place = next_below(random_, c.added);
    if (place < budget_.lookups) c.sample[static_cast<std::size_t>(place)] = lookup;
}

// Calls around(lookup, count) for some of the sampled lookups of a class, which calls count(id, distances,
// weight) for points. Returns for how many.
template <class Around>
std::size_t Lookups::count_around(SizeClass& c, double lookups, Around&& around) {
    // Half of the samples go to the classes by their number, half evenly: a few large boxes can cost as much
    // as many small ones.
    const double share = (c.count / lookups + 1 / static_cast<double>(classes_.size())) / 2;
    const auto size =
        std::min(c.sample.size(), static_cast<std::size_t>(static_cast<double>(budget_.lookups) * share) + 1);
    const double each = c.count / static_cast<double>(size);
    for (std::size_t i = 0; i < size; ++i) {
        const Lookup& l = c.sample[i];
        around(l, [&](std::uint32_t id, const double(&along)[3], double weight) {
            ++points_looked_at_;
            if (id < l.first_read || id >= l.last_read) return;
            (id >= l.first_passed && id < l.last_passed ? c.passed : c.tested).add(along, each * weight);
        });
    }
    return size;
}

void Lookups::count_points(const fast::Points& points, bool count_occupied) {
    const double lookups = count();
    if (!count_occupied && points.count <= budget_.near_points + budget_.far_points) {
        for (SizeClass& c : classes_) // so few points that all of them are looked at
            count_around(c, lookups, [&](const Lookup& l, auto&& count) {
                double along[3];
                for (std::uint32_t i = 0; i < points.count; ++i) {
                    if (points.id[i] < l.first_read || points.id[i] >= l.last_read) continue;
                    distances(l, {points.x[i], points.y[i], points.z[i]}, along);
                    count(points.id[i], along, 1.0);
                }
            });
    } else {
        count_binned(points, lookups, count_occupied);
    }
    for (SizeClass& c : classes_) {
        c.changes.finish();
        c.passed.finish();
        c.tested.finish();
    }
}

void Lookups::count_binned(const fast::Points& points, double lookups, bool count_occupied) {
    if (points.count == 0) return;
    std::pmr::memory_resource* memory = classes_.memory();
    fast::Bins bins(memory);
    Array<BranchMisses::Point> around(memory);
    const Box box = fast::bounds(points);
    const auto most = static_cast<std::size_t>(points.count / points_per_cell) + 1;
    bins.points.reserve(points.count);
    const fast::WindowLattice lattice = fast::make_lattice(points, box, 0, most);
    const fast::Window window = fast::bin(points, lattice, box, bins);
    double smallest = 1, largest = 1;
    if (sides(smallest, largest)) {
        first_size_ = smallest / 16;
        size_ratio_ = std::pow(256 * largest / smallest, 1.0 / (occupied_sizes - 1));
    }
    const std::size_t far_stride = stride_for(points.count, budget_.far_points);
    Array<Binned::Far> far(memory);
    Binned binned{window,
                  bins.points,
                  bins.begin.data() + window.first_cell,
                  budget_.near_points,
                  {},
                  static_cast<double>(far_stride)};
    for (std::size_t i = far_stride / 2; i < points.count; i += far_stride) {
        Binned::Far& point = far.emplace_back();
        binned.at(i, point.at);
        point.id = bins.points.id[i];
    }
    binned.far = far;
    for (SizeClass& c : classes_) {
        const double near = near_sides * std::ldexp(2.0, c.exponent);
        const std::size_t size = count_around(c, lookups, [&](const Lookup& l, auto&& count) {
            for_points_around(l, near, binned, random_, count);
        });
        count_lists(c, size * budget_.listed / budget_.lookups, binned, around);
        if (!count_occupied) continue;
        count_crowds(c, size / crowd_part + 1, near, binned, static_cast<double>(points.count) / lookups);
    }
}

template <class In>
void Lookups::count_lists(SizeClass& c, std::size_t wanted, const In& in,
                          Array<BranchMisses::Point>& points) {
    const double least = c.changes.first_size(), most = c.changes.last_size();
    double near = most;
    for (std::size_t i = 0; i < std::min(c.sample.size(), wanted); ++i) {
        const Lookup& l = c.sample[i];
        const double known = gather(l, c.changes, near, in, points);
        near = std::clamp(1.1 * known, 2 * least, most); // a first guess for the next lookup
        points_looked_at_ += points.size();
        c.changes.add(l.lo, l.hi, points, known);
    }
}

// The number of occupied cells is the sum over all points of 1 / (points in their cell). Corners of sampled
// boxes stand for all points. The number of others in the cell of a corner is taken as random with the mean m
// found there (Poisson): E[1 / (1 + N)] = (1 - exp(-m)) / m.
template <class In>
void Lookups::count_crowds(const SizeClass& c, std::size_t wanted, double near, const In& in,
                           double points_per_lookup) {
    const std::size_t size = std::min(c.sample.size(), wanted);
    const double each = c.count * points_per_lookup / static_cast<double>(size);
    for (std::size_t i = 0; i < size; ++i) {
        Lookup corner = c.sample[i];
        for (int a = 0; a < 3; ++a) corner.hi[a] = corner.lo[a];
        PointsMet met(std::ldexp(1.0, c.exponent), classes_.memory());
        for_points_around(corner, near, in, random_,
                          [&](std::uint32_t, const double(&along)[3], double w) { met.add(along, w); });
        met.finish();
        double size_at = first_size_;
        for (double& occupied : occupied_) {
            const double others = std::max(met.at(size_at) - 1, 0.0);
            occupied += each * (others > 1e-9 ? -std::expm1(-others) / others : 1);
            size_at *= size_ratio_;
        }
    }
}

// ---- results --------------------------------------------------------------------------------------

double Lookups::occupied(double cell_size) const noexcept {
    const double place = std::clamp(std::log(cell_size / first_size_) / std::log(size_ratio_), 0.0,
                                    static_cast<double>(occupied_sizes - 1));
    const auto below = std::min(static_cast<std::size_t>(place), occupied_sizes - 2);
    const double part = place - static_cast<double>(below);
    return std::max(occupied_[below] * (1 - part) + occupied_[below + 1] * part, 1.0);
}

bool Lookups::sides(double& smallest, double& largest) const noexcept {
    bool any = false;
    for (const SizeClass& c : classes_) {
        if (c.exponent == -exponents / 2) continue;
        const double side = std::ldexp(1.0, c.exponent);
        smallest = any ? std::min(smallest, side) : side;
        largest = any ? std::max(largest, 2 * side) : 2 * side;
        any = true;
    }
    return any;
}

} // namespace vox
