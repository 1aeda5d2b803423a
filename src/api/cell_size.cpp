// The C border of vox.h's cell-size section.

#include "base/bits.hpp"
#include "base/border.hpp"
#include "base/scratch.hpp"
#include "base/structs.hpp"
#include "cell_size/calibrate.hpp"
#include "cell_size/geometry.hpp"
#include "cell_size/search.hpp"
#include "cell_size/suggest.hpp"
#include "cell_size/weights.hpp"
#include "fast/last_positions.hpp"
#include "fast/stream.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

using namespace vox;

namespace {

constexpr double default_zone_loss = 0.05;

vox_suggest_desc suggest_defaults() {
    vox_suggest_desc desc{};
    desc.struct_size = sizeof desc;
    desc.p_nc = 0.99;
    desc.cost_ratio = 5;
    desc.zone_loss = default_zone_loss;
    desc.mean_edge_factor = 2;
    return desc;
}

vox_suggest_desc read_suggest_desc(const vox_suggest_desc* desc) {
    vox_suggest_desc settings =
        desc ? read_struct(desc, suggest_defaults(), "vox_suggest_desc") : suggest_defaults();
    check_suggest_desc(settings);
    return settings;
}

// The caller's array: its elements are as far apart as the caller's own vox_mesh_desc is large.
std::vector<Body> read_bodies(const vox_mesh_desc* meshes, std::uint64_t count) {
    std::vector<Body> bodies;
    if (count == 0) return bodies;
    require(meshes, "meshes");
    if (count > VOX_MAX_MESHES)
        throw Error(VOX_ERROR_LIMIT,
                    format("mesh_count is %" PRIu64 ", the limit is %u", count, VOX_MAX_MESHES));
    check_out_struct(meshes, "meshes[0]");
    const std::uint32_t stride = meshes->struct_size;
    if (stride % alignof(vox_mesh_desc) != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("meshes[0].struct_size is %u, expected a multiple of %zu", stride,
                           alignof(vox_mesh_desc)));
    vox_mesh_desc defaults{};
    defaults.struct_size = sizeof defaults;
    bodies.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto* element = reinterpret_cast<const vox_mesh_desc*>(
            reinterpret_cast<const std::byte*>(meshes) + std::size_t{i} * stride);
        if (element->struct_size != stride)
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("meshes[%u].struct_size is %u, that of meshes[0] is %u", i,
                               element->struct_size, stride));
        const vox_mesh_desc desc = read_struct(element, defaults, "mesh");
        Body body = check_mesh(desc, format("mesh %u: ", i).c_str(), NullPositions::rejected);
        body.mesh_id = i;
        bodies.push_back(body);
    }
    return bodies;
}

// Bodies with what the models need of them.
class Scene {
public:
    Scene(vox_cost_model model, std::vector<Body> bodies)
        : memory_(std::pmr::get_default_resource()), bodies_(bodies.begin(), bodies.end(), memory_),
          made_(memory_), tiles_(bodies_.size(), nullptr, memory_), activity_(memory_), body_boxes_(memory_) {
        geometry_ = measure(bodies_);
        if (model == VOX_COST_MODEL_FAST) make_tiles();
    }

    // A grid asks between its steps, and should not wait longer than for one of them: from a sample.
    Scene(vox_cost_model model, vox_grid::Known known, std::pmr::memory_resource* memory)
        : memory_(memory), bodies_(std::move(known.bodies)), made_(memory), tiles_(std::move(known.tiles)),
          activity_(std::move(known.activity)), body_boxes_(memory) {
        std::size_t tets = 0;
        for (const Body& body : bodies_) tets += body.tets.size();
        std::span<const Box> boxes;
        if (model == VOX_COST_MODEL_FAST) {
            effort_ = quick_tiles(tets);
            if (known.last_step && !moved_since(*known.last_step)) {
                last_step_ = known.last_step;
                boxes = body_boxes_;
            } else {
                make_tiles();
                boxes = boxes_.emplace(bodies_, tiles_, memory_).bodies();
            }
        } else {
            effort_ = quick(tets);
        }
        const std::size_t samples = sampled_tets(tets);
        const bool may_sample = std::all_of(known.meshes.begin(), known.meshes.end(),
                                            [](const Mesh* mesh) { return mesh->may_sample(); });
        geometry_ =
            tets > 2 * samples && may_sample ? sampled(known.meshes, boxes, samples) : measure_without_off();
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    const Geometry& geometry() const noexcept { return geometry_; }
    SuggestScene view() noexcept {
        return {bodies_, tiles_, activity_, effort_, boxes_ ? &*boxes_ : nullptr, last_step_};
    }

private:
    // Whether any of the bodies has another box than in a step. Those whose positions are not packed count as
    // moved. What moves inside its box and nowhere reaches further than before is near enough where it was.
    bool moved_since(const FastEngine& step) {
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            const Body& body = bodies_[b];
            Box& box = body_boxes_.emplace_back(empty_box);
            if (body.vertex_count == 0) continue;
            if (!fast::is_packed(body.positions)) return true;
            const std::uint32_t ends[2] = {0, body.vertex_count};
            Box block{};
            if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), ends, &block, box))
                check_finite(body);
            if (!std::equal(box.lo, box.lo + 3, step.boxes().bodies[b].lo) ||
                !std::equal(box.hi, box.hi + 3, step.boxes().bodies[b].hi))
                return true;
        }
        return false;
    }

    Geometry sampled(std::span<const Mesh* const> meshes, std::span<const Box> boxes,
                     std::size_t samples) const {
        std::pmr::vector<const MeshSample*> of_meshes(memory_);
        of_meshes.reserve(meshes.size());
        for (const Mesh* mesh : meshes) of_meshes.push_back(&mesh->sample());
        return estimate(bodies_, of_meshes, boxes, samples, memory_);
    }

    // Of the tetrahedra that are not off.
    Geometry measure_without_off() const {
        std::vector<std::vector<Tet>> on;
        std::vector<Body> bodies(bodies_.begin(), bodies_.end());
        for (Body& body : bodies) {
            if (body.off_count == 0) continue;
            std::vector<Tet>& tets = on.emplace_back(); // whose elements stay where they are as `on` grows
            for (std::size_t t = 0; t < body.tets.size(); ++t)
                if (!has_bit(body.off, t)) tets.push_back(body.tets[t]);
            body.tets = tets;
        }
        return measure(bodies);
    }

    // Where there are none.
    void make_tiles() {
        made_.reserve(bodies_.size());
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            if (tiles_[b]) continue;
            const Body& body = bodies_[b];
            vox::make_tiles(body.tets, body.vertex_count, body.positions,
                             made_.emplace_back(std::pmr::get_default_resource()), body.off);
            tiles_[b] = &made_.back();
        }
    }

    std::pmr::memory_resource* memory_;
    std::pmr::vector<Body> bodies_;
    std::pmr::vector<Tiles> made_;
    std::pmr::vector<const Tiles*> tiles_;
    std::pmr::vector<Activity> activity_;
    std::pmr::vector<Box> body_boxes_;
    std::optional<SceneBoxes> boxes_; // this or the next one for the fast engine's model
    const FastEngine* last_step_ = nullptr;
    Geometry geometry_{};
    SampleBudget effort_ = thorough;
};

// ---- cost functions of others ---------------------------------------------------------------------

vox_cost_bounds bounds_defaults() {
    vox_cost_bounds bounds{};
    bounds.struct_size = sizeof bounds;
    bounds.zone_loss = default_zone_loss;
    return bounds;
}

vox_cost_minimum minimise_within(const CostFunction& cost, const vox_cost_bounds* given) {
    const vox_cost_bounds bounds = read_struct(given, bounds_defaults(), "bounds");
    if (!(bounds.min > 0 && bounds.min <= bounds.max && std::isfinite(bounds.max)))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("bounds are %g to %g, expected 0 < min <= max", bounds.min, bounds.max));
    if (!(bounds.zone_loss >= 0 && bounds.zone_loss <= 1e6))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("bounds zone_loss is %g, expected a number from 0 to 1e6", bounds.zone_loss));
    if (bounds.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("bounds reserved is %u, expected 0", bounds.reserved));
    const CellSizeRange range{bounds.min, bounds.max};
    const CostMinimum best = minimise(cost, range);
    if (!std::isfinite(best.cost))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("no finite cost for a cell size from %g to %g", bounds.min, bounds.max));
    if (best.cost < 0)
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("the cost is %g at cell size %g, expected none below 0", best.cost, best.cell_size));
    vox_cost_minimum result{};
    result.cell_size = best.cell_size;
    result.cost = best.cost;
    const Zone zone = zone_around(best, (1 + bounds.zone_loss) * best.cost, cost, range);
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.curve_count = VOX_COST_CURVE_CAPACITY;
    for (std::uint32_t i = 0; i < result.curve_count; ++i) {
        const double part = static_cast<double>(i) / (result.curve_count - 1);
        const double at = i == 0 ? bounds.min
                          : i == result.curve_count - 1
                              ? bounds.max
                              : bounds.min * std::pow(bounds.max / bounds.min, part);
        result.curve[i] = {at, cost(at)};
    }
    return result;
}

void check_cells(double cells, const char* name) {
    if (!(cells > 0) || !std::isfinite(cells))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("%s is %.9g, expected a number above 0", name, cells));
}

// Eq. 9 as printed has the factors a = floor(n_opt / n) and b = floor(n / n_opt) to choose the side that n
// lies on; the other one is zero, and where the one is above 1 it cancels out.
double zone_distance(double n, double n_min, double n_opt, double n_max) {
    if (n == n_opt) return 0;
    const double width = n < n_opt ? n_opt - n_min : n_max - n_opt;
    return width > 0 ? std::abs(n_opt - n) / width : std::numeric_limits<double>::infinity();
}

} // namespace

vox_result vox_suggest_desc_init(vox_suggest_desc* desc, uint32_t struct_size) {
    return border([&] { init_struct(desc, struct_size, suggest_defaults(), "vox_suggest_desc"); });
}

vox_result vox_suggest_cell_size(const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                 uint64_t mesh_count, vox_suggestion* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings = read_suggest_desc(desc);
        Scene scene(settings.model, read_bodies(meshes, mesh_count));
        write_struct(out,
                     suggest(settings, scene.geometry(), scene.view(), weights_in_use(),
                             std::pmr::get_default_resource()),
                     "out");
    });
}

vox_result vox_grid_suggest_cell_size(const vox_grid* grid, const vox_suggest_desc* desc,
                                      vox_suggestion* out) {
    return border([&] {
        require(grid, "grid");
        check_out_struct(out, "out");
        vox_suggest_desc settings = read_suggest_desc(desc);
        if (!desc) grid->describe(settings);
        const double p_nc = grid->share_without_contact();
        if (p_nc > 0 && p_nc < 1 && settings.p_nc == suggest_defaults().p_nc) settings.p_nc = p_nc;
        Scratch<std::size_t{1} << 16> memory; // enough for a small scene
        Scene scene(settings.model, grid->known(&memory), &memory);
        write_struct(out, suggest(settings, scene.geometry(), scene.view(), weights_in_use(), &memory),
                     "out");
    });
}

vox_result vox_cost_predict(const vox_suggest_desc* desc, const vox_mesh_desc* meshes, uint64_t mesh_count,
                            double cell_size, vox_cost_prediction* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings = read_suggest_desc(desc);
        check_cells(cell_size, "cell_size");
        Scene scene(settings.model, read_bodies(meshes, mesh_count));
        const CostTerms terms = predict(settings, scene.geometry(), scene.view(), weights_in_use(), cell_size,
                                        std::pmr::get_default_resource());
        vox_cost_prediction prediction{};
        prediction.cell_size = cell_size;
        prediction.cost = terms.cost();
        write_shares(terms, prediction.terms, prediction.term_count);
        write_struct(out, prediction, "out");
    });
}

vox_result vox_cost_calibrate(vox_cost_weights* out) {
    return border([&] {
        if (out) check_out_struct(out, "out");
        use_weights(measured_weights());
        if (out) write_struct(out, measured_weights(), "out");
    });
}

vox_result vox_cost_get_weights(vox_cost_weights* out) {
    return border([&] { write_struct(out, weights_in_use(), "out"); });
}

vox_result vox_cost_set_weights(const vox_cost_weights* weights) {
    return border([&] {
        vox_cost_weights read = shipped_weights();
        if (weights) read = read_struct(weights, read, "vox_cost_weights");
        check_weights(read);
        read.struct_size = sizeof read;
        use_weights(read);
    });
}

vox_result vox_cost_bounds_init(vox_cost_bounds* bounds, uint32_t struct_size) {
    return border([&] { init_struct(bounds, struct_size, bounds_defaults(), "vox_cost_bounds"); });
}

vox_result vox_cost_minimise(vox_cost_function* cost, void* user, const vox_cost_bounds* bounds,
                             vox_cost_minimum* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (!cost) throw Error(VOX_ERROR_INVALID_ARGUMENT, "cost is null");
        write_struct(out, minimise_within([&](double cell_size) { return cost(cell_size, user); }, bounds),
                     "out");
    });
}

vox_result vox_cost_minimise_terms(const vox_cost_term* terms, uint64_t term_count,
                                   const vox_cost_bounds* bounds, vox_cost_minimum* out) {
    return border([&] {
        check_out_struct(out, "out");
        require(terms, "terms");
        for (std::uint64_t i = 0; i < term_count; ++i)
            if (!std::isfinite(terms[i].coefficient) || !std::isfinite(terms[i].power))
                throw Error(VOX_ERROR_INVALID_ARGUMENT, format("term %" PRIu64 " is %g * size^%g", i,
                                                               terms[i].coefficient, terms[i].power));
        const auto sum = [&](double cell_size) {
            double cost = 0;
            for (std::uint64_t i = 0; i < term_count; ++i)
                cost += terms[i].coefficient * std::pow(cell_size, terms[i].power);
            return cost;
        };
        write_struct(out, minimise_within(sum, bounds), "out");
    });
}

vox_result vox_zone_distance(double n, double n_min, double n_opt, double n_max, double* out_epsilon) {
    return border([&] {
        require(out_epsilon, "out_epsilon");
        check_cells(n, "n");
        check_cells(n_min, "n_min");
        check_cells(n_opt, "n_opt");
        check_cells(n_max, "n_max");
        if (!(n_min <= n_opt && n_opt <= n_max))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("n_min %.9g, n_opt %.9g, n_max %.9g: expected in ascending order", n_min,
                               n_opt, n_max));
        *out_epsilon = zone_distance(n, n_min, n_opt, n_max);
    });
}
