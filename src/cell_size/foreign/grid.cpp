#include "cell_size/foreign/grid.hpp"

#include "base/array.hpp"
#include "base/caller_memory.hpp"
#include "base/sampling.hpp"
#include "base/structs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cinttypes>
#include <cmath>

namespace vox {

// ---- the caller's description ---------------------------------------------------------------------

namespace {

constexpr std::array<const char*, std::tuple_size_v<WeightArray>> weight_names{
    "run", "store", "visit", "found", "read", "occupied", "cell"};

void check_grid_number(bool good, double value, const char* name, const char* expected) {
    if (!good || !std::isfinite(value)) refuse(format("grid %s is %.9g, expected %s", name, value, expected));
}

vox_foreign_grid checked(vox_foreign_grid grid) {
    set_default(grid.zone_loss, default_zone_loss);
    check_enum(grid.cells_stored, VOX_CELLS_STORED_CENTRE, "grid cells_stored");
    check_enum(grid.cells_queried, VOX_CELLS_QUERIED_PAIRS, "grid cells_queried");
    check_enum(grid.cells_kept, VOX_CELLS_KEPT_DENSE, "grid cells_kept");
    check_enum(grid.known, VOX_KNOWN_GRID_NUMPY, "grid known");
    const vox_foreign_grid& known = known_grid(grid.known);
    set_default(grid.cells_stored, known.cells_stored);
    set_default(grid.cells_queried, known.cells_queried);
    set_default(grid.cells_kept, known.cells_kept);
    if (grid.cells_queried == VOX_CELLS_QUERIED_27 && grid.cells_stored != VOX_CELLS_STORED_CENTRE)
        refuse(
            "grid cells_queried is 27 and cells_stored BOX: 27 cells are visited where cells store centres");
    if (grid.reserved != 0) refuse(format("grid reserved is %" PRIu32 ", expected 0", grid.reserved));
    check_grid_number(grid.radius >= 0, grid.radius, "radius", "0 or a length");
    check_grid_number(grid.min_cell_size >= 0, grid.min_cell_size, "min_cell_size", "0 or a length");
    check_grid_number(grid.zone_loss >= 0 && grid.zone_loss <= 1e6, grid.zone_loss, "zone_loss",
                      "a number from 0 to 1e6");
    const auto weights = std::bit_cast<WeightArray>(grid.weights);
    for (std::size_t i = 0; i < weights.size(); ++i)
        check_grid_number(weights[i] >= 0, weights[i], format("weights.%s", weight_names[i]).c_str(),
                          "0 or more nanoseconds");
    check_allocator(grid.allocator, "grid.allocator");
    require(grid.stored, "grid.stored");
    return grid;
}

} // namespace

ForeignGrid::ForeignGrid(const vox_foreign_grid* from_caller)
    : desc(checked(read_struct(from_caller, "grid"))), held(read_struct(desc.stored, "stored"), "stored: ") {
    if (desc.querying) asking.emplace(read_struct(desc.querying, "querying"), "querying: ");
    const auto weights = std::bit_cast<WeightArray>(desc.weights);
    const bool given = std::any_of(weights.begin(), weights.end(), [](double ns) { return ns > 0; });
    weights_known = given || desc.known != VOX_KNOWN_GRID_NONE;
    if (!weights_known) {
        // A point is in one cell, whatever cells hold.
        const bool points = held.corners() == 1 && !held.has_radii() && held.common_radius() == 0;
        desc.weights =
            weights_of_any(points ? VOX_CELLS_STORED_CENTRE : desc.cells_stored, desc.cells_queried, dense());
    } else if (!given) {
        desc.weights = known_grid(desc.known).weights;
    }
    if (!dense()) desc.weights.cell = 0;
}

// ---- looking at the primitives --------------------------------------------------------------------

namespace {

constexpr double curve_octaves = 3;     // that a curve goes beyond the range
constexpr std::uint64_t measured = 512; // primitives whose edges and sides make the rules

double mean_edge(const Primitives& primitives) {
    if (primitives.corners() < 2) return 0;
    double sum = 0, count = 0;
    for_stratified(primitives.count(), measured, 0.5, [&](std::uint64_t i) {
        if (primitives.is_box()) {
            const PlainBox box = primitives.box(i);
            sum += box.side(0) + box.side(1) + box.side(2);
            count += 3;
            return;
        }
        Vec3d at[4];
        for (int k = 0; k < primitives.corners(); ++k) at[k] = primitives.corner(i, k);
        for (int k = 1; k < primitives.corners(); ++k)
            for (int j = 0; j < k; ++j) {
                sum += std::hypot(at[k].x - at[j].x, at[k].y - at[j].y, at[k].z - at[j].z);
                count += 1;
            }
    });
    return sum / count;
}

double mean_radius(const Primitives& primitives) {
    if (!primitives.has_radii()) return primitives.common_radius();
    double sum = 0, count = 0;
    for_stratified(primitives.count(), measured, 0.5, [&](std::uint64_t i) {
        sum += primitives.radius(i);
        count += 1;
    });
    return sum / count;
}

// Mean and median of the longest sides.
std::array<double, 2> middle_sides(const Array<PlainBox>& sample, std::pmr::memory_resource* memory) {
    Array<double> sides(memory);
    double sum = 0;
    for_stratified(sample.size(), measured, 0.5, [&](std::uint64_t i) {
        sides.push_back(sample[static_cast<std::size_t>(i)].longest_side());
        sum += sides.back();
    });
    const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
    std::nth_element(sides.begin(), middle, sides.end());
    return {sum / static_cast<double>(sides.size()), *middle};
}

// Sets what is summed over sampled boxes, which stand for `count`: the cells that they meet, the box of all
// or, with `centres`, of their centres, and the longest side.
void sum_boxes(const Array<PlainBox>& sample, double count, bool centres, Moments& cells, PlainBox& bounds,
               double& longest) {
    bounds = sample[0].centre();
    for (const PlainBox& box : sample) {
        cells.add(cells_met({box.side(0), box.side(1), box.side(2)}));
        bounds.include(centres ? box.centre() : box);
        longest = std::max(longest, box.longest_side());
    }
    for (double& sum : cells.sum) sum *= count / static_cast<double>(sample.size());
}

// The cells that these boxes meet when they are larger by `by` on all sides.
Moments grown(const Moments& cells, double by) {
    const double w = 2 * by, (&m)[4] = cells.sum;
    return {{m[0], m[1] + 3 * w * m[0], m[2] + w * (2 * m[1] + 3 * w * m[0]),
             m[3] + w * (m[2] + w * (m[1] + w * m[0]))}};
}

// What is around fewer boxes is looked at more closely: the boxes seen around one are as coarse^-3.
double coarseness(const SampleBudget& budget, std::size_t chosen) {
    const double part = static_cast<double>(chosen) / static_cast<double>(budget.chosen);
    return budget.coarse * std::cbrt(std::min(part, 1.0));
}

} // namespace

ForeignWork::ForeignWork(const ForeignGrid& grid, const SampleBudget& budget,
                         std::pmr::memory_resource* memory)
    : centres_(grid.centres()), pairs_(grid.pairs()), same_set_(grid.same_set()),
      around_(grid.desc.cells_queried == VOX_CELLS_QUERIED_27), chosen_(budget.chosen),
      looked_cells_(budget.cells), singly_(budget.singly), rough_(budget.rough),
      held_count_(static_cast<double>(grid.held.count())),
      asking_count_(static_cast<double>(grid.those_asking().count())), held_(memory), asking_(memory),
      asking_chosen_(memory), held_chosen_(memory), read_(1, 0, memory), memory_(memory) {
    sample_boxes(grid.held, grid.held_grown(), budget.held, 1, held_);
    // More of another set than are kept, for its sums.
    sample_boxes(grid.those_asking(), grid.desc.radius, (same_set_ ? 1 : 4) * budget.asking, 2, asking_);
    const Array<PlainBox>&held = held_.added(), &asking = asking_.added();
    const auto [mean_side, median_side] = middle_sides(held, memory);
    double held_side = 0, asking_side = 0;
    sum_boxes(held, held_count_, centres_, held_cells_, held_bounds_, held_side);
    if (same_set_) {
        const double by = grid.desc.radius - grid.held_grown();
        asking_cells_ = grown(held_cells_, by);
        asking_bounds_ = held_bounds_;
        asking_side = held_side + 2 * by;
    } else {
        sum_boxes(asking, asking_count_, centres_ && pairs_, asking_cells_, asking_bounds_, asking_side);
    }
    has_size_ = centres_ ? !around_ && !pairs_ && asking_side > 0 : held_side > 0 || asking_side > 0;
    held_.build(centres_, held_count_);
    asking_.build(around_ || (pairs_ && centres_), asking_count_, budget.asking);
    asking_chosen_ = choose_asking(asking_, budget.chosen, memory);
    read_ = sum_pairs(asking_, asking_chosen_, held_, coarseness(budget, asking_chosen_.size()), around_,
                      same_set_, memory);
    least_ = grid.desc.min_cell_size;
    if (around_ && least_ == 0) { // of all: it must not be missed
        const double longest = longest_side(grid.held);
        least_ = grid.desc.radius + (longest + (same_set_ ? longest : longest_side(*grid.asking))) / 2;
    }
    PlainBox bounds = held_bounds_;
    bounds.include(asking_bounds_);
    bounds.include(held_.bounds());
    bounds.include(asking_.bounds());
    extent_ = bounds.longest_side();
    if (extent_ > 0)
        range_ = {std::max(extent_ * 0x1p-28, least_), std::max(2 * extent_, least_)};
    else if (least_ > 0)
        range_ = {least_, least_};

    const PlainBox& all = held_bounds_;
    rules_ = {{{"mean edge (Teschner et al. 2003)", mean_edge(grid.held), 0},
               {"mean box side", mean_side, 0},
               {"median box side (IPC Toolkit)", median_side, 0},
               {"spacing", std::cbrt(all.side(0) * all.side(1) * all.side(2) / held_count_), 0},
               {"mean radius", mean_radius(grid.those_asking()) + grid.desc.radius, 0}}};
    for (auto* shares : {&empty_shares_, &occupied_shares_}) shares->emplace(range_, curve_octaves, memory);
    never_empty_ = same_set_ && !centres_ && grid.desc.radius == 0; // each finds itself
}

// ---- counts ---------------------------------------------------------------------------------------

vox_foreign_counts ForeignWork::smooth_at(double d) const noexcept {
    vox_foreign_counts work{};
    const double held_cells = centres_ ? held_count_ : held_cells_.at(d);
    work.stored = held_cells;
    const double others = read_.at(d);
    if (pairs_) {
        if (!same_set_) work.stored += centres_ ? asking_count_ : asking_cells_.at(d);
        work.visits = work.stored;
        work.reads = same_set_ ? others / 2 : others;
    } else {
        work.visits = around_ ? 27 * asking_count_ : asking_cells_.at(d);
        // Its own cells are what a box finds itself in.
        work.reads = same_set_ ? held_cells + others : others;
    }
    work.empty = work.visits;
    PlainBox all = held_bounds_;
    if (pairs_) all.include(asking_bounds_);
    work.cells = cells_met({all.side(0), all.side(1), all.side(2)}).at(d);
    return work;
}

bool ForeignWork::is_countable(double d) const noexcept {
    const vox_foreign_counts work = smooth_at(d);
    return work.stored <= most_counted && work.visits <= most_counted && work.reads <= most_counted &&
           work.cells <= most_counted;
}

vox_foreign_counts ForeignWork::with_shares(double d, double empty_part,
                                            double occupied_part) const noexcept {
    vox_foreign_counts work = smooth_at(d);
    work.occupied = occupied_part * work.stored;
    if (pairs_) work.visits = work.occupied;
    work.empty = pairs_ ? 0 : empty_part * work.visits;
    return work;
}

vox_foreign_counts ForeignWork::exactly_at(double d) {
    return with_shares(d, empty_share(d), occupied_share(d));
}

vox_foreign_counts ForeignWork::at(double d, bool empty, bool occupied) {
    return with_shares(
        d, empty ? empty_shares_->at(d, [this](double size) { return empty_share(size); }) : 0,
        occupied ? occupied_shares_->at(d, [this](double size) { return occupied_share(size); }) : 0);
}

double ForeignWork::empty_share(double d) const {
    if (pairs_ || never_empty_) return 0;
    std::uint64_t random = 3;
    CellCounts counts;
    const double share = held_.share();
    for (std::size_t i = 0; i < looked_cells_; ++i) {
        const Asking& ask = asking_chosen_[i * asking_chosen_.size() / looked_cells_];
        double lo[3];
        const double weight = ask.weight * some_cell(asking_.box(ask.index), d, around_, random, lo);
        if (share == 1) {
            counts.add_known(weight, held_.meets_any(lo, d) ? 0 : weight);
        } else {
            const double n = held_.count_meeting(lo, d, rough_);
            counts.add_part(weight, n / share, n * (n - 1) / (share * share));
        }
    }
    return counts.none();
}

namespace {

// Positions of a lattice in which few cells are looked at one by one.
constexpr double least_positions = 32;

} // namespace

// Where all lie in a few cells, these are looked at one by one, in as many positions of the lattice as there
// is time for.
double ForeignWork::occupied_of_few(double d, double cells_there) const {
    const bool both = pairs_ && !same_set_;
    PlainBox all = held_.bounds();
    if (both) all.include(asking_.bounds());
    // Additive recurrences with powers of the plastic number of three dimensions: evenly spread positions.
    double place[3] = {0.5, 0.5, 0.5};
    constexpr double step[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    const auto positions = static_cast<std::size_t>(static_cast<double>(singly_) / cells_there);
    double found = 0;
    for (std::size_t p = 0; p < positions; ++p) {
        double first[3];
        int along[3]; // few: steps of d itself may be below the rounding of a position
        for (int a = 0; a < 3; ++a) {
            place[a] += step[a] - static_cast<double>(place[a] + step[a] >= 1);
            first[a] = all.lo[a] - place[a] * d;
            along[a] = static_cast<int>((all.hi[a] - first[a]) / d) + 1;
        }
        for (int x = 0; x < along[0]; ++x)
            for (int y = 0; y < along[1]; ++y)
                for (int z = 0; z < along[2]; ++z) {
                    const double lo[3] = {first[0] + x * d, first[1] + y * d, first[2] + z * d};
                    found += held_.meets_any(lo, d) || (both && asking_.meets_any(lo, d));
                }
    }
    return std::max(found / static_cast<double>(positions), 1.0);
}

double ForeignWork::occupied_share(double d) {
    if (held_chosen_.empty()) held_chosen_ = choose_asking(held_, chosen_, memory_);
    const vox_foreign_counts smooth = smooth_at(d);
    const bool both = pairs_ && !same_set_, all_kept = held_.share() == 1 && (!both || asking_.share() == 1);
    // More of them are few where none can be missed for want of what is not in the sample.
    if (smooth.cells * least_positions <=
        static_cast<double>(all_kept ? singly_ : std::min(singly_, looked_cells_)))
        return occupied_of_few(d, smooth.cells) / smooth.stored;
    std::uint64_t random = 4;
    CellCounts counts;
    const auto look = [&](const SampleTree& own, const SampleTree* other, const Array<Asking>& chosen) {
        look_at_entries(own, other, chosen, looked_cells_, d, rough_, endless, random, counts);
    };
    look(held_, both ? &asking_ : nullptr, held_chosen_);
    if (both) look(asking_, &held_, asking_chosen_);
    return counts.mean_inverse();
}

} // namespace vox
