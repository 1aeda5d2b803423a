#include "cell_size/adaptive.hpp"

#include "cell_size/reference_model.hpp"
#include "cell_size/weights.hpp"

#include "base/error.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace vox {

namespace {

// The size stays as long as following would change it by less than this part: next to nothing is lost, also
// where the vertices of a lattice make some sizes better than those beside them.
constexpr double hysteresis = 0.03;
// A choice that costs so much more than the best one is kept.
constexpr double as_good = 1.02;
// At most by this factor in one step: what is far off is off the straight line, too.
constexpr double most_at_once = 2;
// Beyond this factor from what the model chose it is asked again.
constexpr double far_off = 1.5;
// Of the time of the steps, for choosing: a hundredth at most, told by counts to within a factor of two (a
// choice finds little in the caches), and with one more in a short while than in the long run.
constexpr double time_share = 0.003;
// Nanoseconds of a choice: for each vertex, tetrahedron looked at, pair of a sampled one and a point near it
// or one of the few far ones, and sampled one whose lists are gone through.
constexpr double vertex_ns = 20, tet_ns = 50, pair_ns = 10, near_points = 128, lists_ns = 20000;

double choice_ns(double vertices, double tets, const SampleBudget& effort) {
    return vertices * vertex_ns + std::min(tets, static_cast<double>(effort.most_tets)) * tet_ns +
           static_cast<double>(effort.sample.lookups) *
               (near_points + static_cast<double>(effort.sample.far_points)) * pair_ns +
           static_cast<double>(effort.sample.listed) * lists_ns;
}

// What a visited cell costs, with its list, in visits.
constexpr double cell_visits = 5;

double step_ns(const vox_counters& c, const vox_cost_weights& w) {
    return static_cast<double>(c.vertices) * w.reference_classify_vertex +
           static_cast<double>(c.tets) * w.reference_prepare_tet +
           static_cast<double>(c.visited_cells) * cell_visits * w.reference_visit_cell +
           static_cast<double>(c.visited_entries) * w.reference_read_vertex;
}

// Mean longest side of the boxes of a few tetrahedra, for when there is no memory for more.
double few_box_sides(std::span<const Body> bodies) {
    double sum = 0, count = 0;
    for (const Body& body : bodies) {
        const std::size_t stride = body.tets.size() / 64 + 1;
        for (std::size_t t = 0; t < body.tets.size(); t += stride) {
            double longest = 0;
            for (const std::uint32_t v : body.tets[t].v) {
                const auto p = body.positions[v], q = body.positions[body.tets[t].v[0]];
                longest =
                    std::max({longest, std::abs(double{p.x} - double{q.x}),
                              std::abs(double{p.y} - double{q.y}), std::abs(double{p.z} - double{q.z})});
            }
            if (!(longest > 0) || !std::isfinite(longest)) continue;
            sum += longest;
            count += 1;
        }
    }
    return count > 0 ? sum / count : 0;
}

} // namespace

std::span<const CellLevel> AdaptiveCellSize::cell_sizes(std::span<const Body> bodies, const Setting& setting,
                                                        std::pmr::memory_resource* memory) {
    const Levels before = sizes_;
    if (must_choose()) {
        try {
            sized_ = choose(bodies, setting, memory);
        } catch (const std::bad_alloc&) {
            sized_ = false;
        } catch (const Error& error) {
            if (error.result() != VOX_ERROR_BUDGET) throw;
            sized_ = false;
        }
        if (!sized_ && (before.count == 0 || scene_changed_)) {
            const double side = few_box_sides(bodies);
            // Without any size nothing can touch: any cell will do.
            use(side > 0 ? std::max(1.5 * side, floor_) : 1);
        }
        scene_changed_ = balanced_ = false;
    } else {
        follow();
    }
    const auto same = [](const CellLevel& a, const CellLevel& b) {
        return a.cell_size == b.cell_size && a.longest_side == b.longest_side;
    };
    if (before.count != 0 && !std::ranges::equal(before.list(), sizes_.list(), same)) ++changes_;
    return sizes_.list();
}

bool AdaptiveCellSize::must_choose() const noexcept {
    if (sizes_.count == 0) return true;
    if (scene_changed_) return credit_ >= 0 || !sized_;
    if (!sized_) return balanced_ && credit_ >= 0; // now some have a size, or there may be memory now
    // The size has followed so far, and may wait until the steps since have paid for the choice.
    return balanced_ && credit_ >= price_ && std::abs(moved_) > std::log(far_off);
}

void AdaptiveCellSize::follow() noexcept {
    if (!balanced_ || !(slope_ > 0)) return;
    const double part =
        std::clamp((balance_ - last_balance_) / slope_, -std::log(most_at_once), std::log(most_at_once));
    if (std::abs(part) < hysteresis) return;
    scale(std::exp(part));
    moved_ += part;
    last_balance_ = balance_; // as it will be
}

void AdaptiveCellSize::use(double cell_size) noexcept {
    sizes_ = {};
    sizes_.count = 1;
    sizes_.level[0] = {cell_size, std::numeric_limits<double>::infinity()};
    moved_ = 0;
}

void AdaptiveCellSize::scale(double factor) noexcept {
    for (std::uint32_t l = 0; l < sizes_.count; ++l) {
        sizes_.level[l].cell_size = std::max(sizes_.level[l].cell_size * factor, floor_);
        sizes_.level[l].longest_side *= factor;
    }
}

bool AdaptiveCellSize::choose(std::span<const Body> bodies, const Setting& setting,
                              std::pmr::memory_resource* memory) {
    std::uint64_t tets = 0, vertices = 0;
    for (const Body& body : bodies) {
        tets += body.tets.size();
        vertices += body.vertex_count;
    }
    for (const Body& body : bodies) check_finite(body);
    const SampleBudget effort = quick(tets);
    const vox_cost_weights weights = weights_in_use();
    // The first choice has to be made.
    if (sizes_.count != 0)
        credit_ -= choice_ns(static_cast<double>(vertices), static_cast<double>(tets), effort);
    const ReferenceModel cost(bodies, setting.storage, effort, weights, memory);
    CellSizeRange range{};
    if (!cost.range(range.min, range.max)) return false;
    floor_ = 0;
    if (setting.storage == VOX_STORAGE_DENSE) {
        floor_ = cost.least_cell_size(setting.byte_limit, range);
        range.min = std::max(range.min, floor_);
        range.max = std::max(range.max, range.min);
    }
    const Levels best = choose_levels(cost, range);
    // Those that are about as good are kept.
    const bool can_stay = sizes_.count != 0 && std::ranges::all_of(sizes_.list(), [this](const CellLevel& l) {
                              return l.cell_size >= floor_;
                          });
    if (!can_stay || cost_of_levels(cost, sizes_.list()) > as_good * best.cost) sizes_ = best;
    // R / V with all cell sizes changed by the same factor.
    const auto balance = [&](double factor) {
        double read = 0, cells = 0;
        for (const SizeClass& c : cost.profile().classes()) {
            const double d = level_of(c, sizes_.list()).cell_size * factor;
            read += c.passed.at(d) + c.tested.at(d);
            cells += c.cells.at(d);
        }
        return std::log(read / cells);
    };
    constexpr double nearby = 1.1;
    slope_ = (balance(nearby) - balance(1 / nearby)) / (2 * std::log(nearby));
    moved_ = 0;
    return true;
}

void AdaptiveCellSize::observe(const vox_counters& counters) noexcept {
    const SampleBudget effort = quick(counters.tets);
    price_ = choice_ns(static_cast<double>(counters.vertices), static_cast<double>(counters.tets), effort);
    credit_ = std::min(credit_ + time_share * step_ns(counters, weights_in_use()), price_);
    if (counters.visited_entries == 0 || counters.visited_cells == 0) return;
    last_balance_ =
        std::log(static_cast<double>(counters.visited_entries) / static_cast<double>(counters.visited_cells));
    if (!balanced_) balance_ = last_balance_;
    balanced_ = true;
}

} // namespace vox
