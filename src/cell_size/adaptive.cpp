#include "cell_size/adaptive.hpp"

#include "base/error.hpp"
#include "base/sampling.hpp"
#include "cell_size/reference_model.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace vox {

namespace {

// The size stays as it is where a new one would differ by less than this part. Next to nothing is lost by
// that, not even where the vertices of a lattice make some sizes better than those beside them.
constexpr double hysteresis = 0.03;
// The sizes in use are kept where they cost at most this factor more than the best ones.
constexpr double as_good = 1.02;
// The most a size is scaled in one step: far away the straight line through the slope no longer holds.
constexpr double most_at_once = 2;
// The model is asked again when the size has been scaled by more than this factor since.
constexpr double far_off = 1.5;
// The budget of choosing, as a part of the time of the steps. Estimated from counters, which is up to a
// factor of two off (a choice finds little in the caches), and in a short run exceeded by one choice, so less
// than the hundredth that is promised.
constexpr double time_share = 0.003;
// Nanoseconds of a choice: for each vertex, for each tetrahedron and vertex of the samples, and for each box
// that is looked at with what is around it.
constexpr double vertex_ns = 3, tet_ns = 30, held_ns = 60, chosen_ns = 1800;

double choice_ns(double vertices, double tets, const SampleBudget& budget) {
    return vertices * vertex_ns + std::min(tets, static_cast<double>(budget.summed)) * tet_ns +
           std::min(vertices, static_cast<double>(budget.held)) * held_ns +
           static_cast<double>(budget.chosen) * chosen_ns;
}

// What a visited cell costs with its list, in visits of empty cells.
constexpr double cell_visits = 5;

double step_ns(const Counters& c, const CostWeights& w) {
    return static_cast<double>(c.vertices) * w.classify_vertex + static_cast<double>(c.tets) * w.prepare_tet +
           static_cast<double>(c.visited_cells) * cell_visits * w.visit_cell +
           static_cast<double>(c.visited_entries) * w.read_vertex;
}

// Mean longest side of the boxes of a few tetrahedra, for when there is no memory for more.
double few_box_sides(std::span<const Body> bodies) {
    double sum = 0, count = 0;
    for (const Body& body : bodies) {
        const std::size_t stride = stride_for(body.tets.size(), 64);
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

std::span<const CellLevel> AdaptiveCellSize::cell_sizes(std::span<const Body> bodies, bool dense,
                                                        double byte_limit,
                                                        std::pmr::memory_resource* memory) {
    const Levels before = sizes_;
    if (must_choose()) {
        try {
            sized_ = choose(bodies, dense, byte_limit, memory);
        } catch (const std::bad_alloc&) {
            sized_ = false;
        } catch (const Error& error) {
            if (error.result() != VOX_ERROR_BUDGET) throw;
            sized_ = false;
        }
        if (!sized_ && (before.count == 0 || scene_changed_)) {
            const double side = few_box_sides(bodies);
            // Where no tetrahedron has a size nothing can touch, and any cell will do.
            sizes_ = {};
            sizes_.count = 1;
            sizes_.level[0] = {side > 0 ? std::max(1.5 * side, floor_) : 1,
                               std::numeric_limits<double>::infinity()};
            moved_ = 0;
        }
        scene_changed_ = balanced_ = false;
    } else {
        adapt();
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
    if (!sized_)
        return balanced_ && credit_ >= 0; // since then tetrahedra may have got a size, or memory is free
    // The size has been adapted meanwhile, so a choice can wait until the steps since have paid for it.
    return balanced_ && credit_ >= price_ && std::abs(moved_) > std::log(far_off);
}

void AdaptiveCellSize::adapt() noexcept {
    if (!balanced_ || !(slope_ > 0)) return;
    const double part =
        std::clamp((balance_ - last_balance_) / slope_, -std::log(most_at_once), std::log(most_at_once));
    if (std::abs(part) < hysteresis) return;
    const double factor = std::exp(part);
    for (std::uint32_t l = 0; l < sizes_.count; ++l) {
        sizes_.level[l].cell_size = std::max(sizes_.level[l].cell_size * factor, floor_);
        sizes_.level[l].longest_side *= factor;
    }
    moved_ += part;
    last_balance_ = balance_; // what the next step will count
}

bool AdaptiveCellSize::choose(std::span<const Body> bodies, bool dense, double byte_limit,
                              std::pmr::memory_resource* memory) {
    std::uint64_t tets = 0, vertices = 0;
    for (const Body& body : bodies) {
        tets += body.tets.size();
        vertices += body.vertex_count;
    }
    for (const Body& body : bodies) check_finite(body);
    CellSizeScene scene(memory);
    scene.bodies.assign(bodies.begin(), bodies.end());
    scene.budget = quick(VOX_COST_MODEL_REFERENCE, tets);
    // The first choice has to be made, so it is not charged.
    if (sizes_.count != 0)
        credit_ -= choice_ns(static_cast<double>(vertices), static_cast<double>(tets), scene.budget);
    const ReferenceModel cost(scene, dense, weights_);
    std::optional<CellSizeRange> range = cost.range();
    if (!range) return false;
    floor_ = 0;
    if (dense) {
        floor_ = cost.least_cell_size(byte_limit, *range);
        range->min = std::max(range->min, floor_);
        range->max = std::max(range->max, range->min);
    }
    const Levels best = choose_levels(cost, *range);
    // The sizes in use stay where they are about as good.
    const bool can_stay = sizes_.count != 0 && std::ranges::all_of(sizes_.list(), [this](const CellLevel& l) {
                              return l.cell_size >= floor_;
                          });
    if (!can_stay || cost_of_levels(cost, sizes_.list()) > as_good * best.cost) sizes_ = best;
    // R / V with all cell sizes changed by the same factor.
    const auto balance = [&](double factor) {
        double read = 0, cells = 0;
        for (const auto& c : cost.classes()) {
            const double d = level_of(c, sizes_.list()).cell_size * factor;
            read += c.read(d);
            cells += c.cells.at(d);
        }
        return std::log(read / cells);
    };
    constexpr double nearby = 1.1;
    slope_ = (balance(nearby) - balance(1 / nearby)) / (2 * std::log(nearby));
    moved_ = 0;
    return true;
}

void AdaptiveCellSize::observe(const Counters& counters) noexcept {
    price_ = choice_ns(static_cast<double>(counters.vertices), static_cast<double>(counters.tets),
                       quick(VOX_COST_MODEL_REFERENCE, counters.tets));
    credit_ = std::min(credit_ + time_share * step_ns(counters, weights_), price_);
    if (counters.visited_entries == 0 || counters.visited_cells == 0) return;
    last_balance_ =
        std::log(static_cast<double>(counters.visited_entries) / static_cast<double>(counters.visited_cells));
    if (!balanced_) balance_ = last_balance_;
    balanced_ = true;
}

} // namespace vox
