#include "cell_size/scene.hpp"

#include "fast/last_positions.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <span>

namespace vox {

namespace {

// At least so many tetrahedra of each body give its tiles.
constexpr std::size_t least_sketched = 64;

} // namespace

// The tests hold the loss in the model's own cost to 4 % for the reference engine, and 2 % for the fast one.
SampleBudget usual(vox_cost_model model, std::uint64_t tets) noexcept {
    if (model == VOX_COST_MODEL_FAST) {
        const std::size_t chosen = std::clamp<std::size_t>(static_cast<std::size_t>(tets / 256), 64, 96);
        return {.summed = 1024,
                .held = 512,
                .asking = 0,
                .chosen = chosen,
                .coarse = 0,
                .cells = 64,
                .rough = 0,
                .singly = 0};
    }
    const std::uint64_t summed = std::clamp<std::uint64_t>(tets / 64, 1024, 2048);
    return {summed, std::clamp<std::uint64_t>(tets / 32, 2048, 8192), summed, 64, 3, 48, 0.5, 0};
}

// Sample sizes keep a suggestion below the time of a step (docs/evidence/cell-size.md, "What a suggestion
// costs") with a regret within a few per cent of the thorough look: the tests hold the loss in the model's
// own cost to 2 % for the reference engine and 3 % for the fast one.
SampleBudget quick(vox_cost_model model, std::uint64_t tets) noexcept {
    if (model == VOX_COST_MODEL_FAST) { // whose boxes are fewer and more alike, and its cost flatter
        const std::size_t chosen = std::clamp<std::size_t>(static_cast<std::size_t>(tets / 3072), 4, 32);
        return {.summed = 16 * chosen,
                .held = std::clamp<std::uint64_t>(tets / 128, 96, 160),
                .asking = 0,
                .chosen = chosen,
                .coarse = 0,
                .cells = std::max<std::size_t>(chosen, 8),
                .rough = 0,
                .singly = 0};
    }
    const std::uint64_t summed = std::clamp<std::uint64_t>(tets / 12, 512, std::uint64_t{1} << 14);
    const auto chosen = static_cast<std::size_t>(std::clamp<std::uint64_t>(tets / 400, 48, 256));
    return {summed, std::clamp<std::uint64_t>(tets / 32, 2048, 8192), summed, chosen, 4, 48, 0.5, 0};
}

CellSizeScene::CellSizeScene(std::pmr::memory_resource* m)
    : memory(m), bodies(m), meshes(m), tiles(m), at_rest(m), cleared(m), sketches_(m), step_(m), boxes_(m),
      stream_(m), broad_phase_(m) {}

void CellSizeScene::prepare(vox_cost_model model) {
    std::uint64_t tets = 0;
    for (const Body& body : bodies) tets += body.tets.size();
    if (!meshes.empty()) budget = quick(model, tets);
    if (model != VOX_COST_MODEL_FAST || (last_step && moved_since_last_step())) last_step = nullptr;
    if (model == VOX_COST_MODEL_FAST && !last_step) find_near_bodies();
    geometry = measure(*this, model == VOX_COST_MODEL_PAPER ? whole_for_paper : whole_for_rules);
}

// A body that moves within its box and reaches no further than before is close enough to where it was.
// Positions that are not packed count as moved.
bool CellSizeScene::moved_since_last_step() const {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        if (body.vertex_count == 0) continue;
        if (!fast::is_packed(body.positions)) return true;
        const std::uint32_t ends[2] = {0, body.vertex_count};
        Box block{}, group{}, box = empty_box;
        if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), ends, &block, &group,
                                box))
            check_finite(body);
        const Box& before = last_step->boxes().bodies[b];
        if (!std::equal(box.lo, box.lo + 3, before.lo) || !std::equal(box.hi, box.hi + 3, before.hi))
            return true;
    }
    return false;
}

void CellSizeScene::find_near_bodies() {
    tiles.resize(bodies.size(), nullptr);
    fast::begin_step(bodies, nullptr, step_);
    const bool some_missing = std::find(tiles.begin(), tiles.end(), nullptr) != tiles.end();
    if (some_missing) sketches_.reserve(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (some_missing) sketches_.emplace_back(memory);
        if (!tiles[b] && bodies[b].vertex_count > 0)
            cut_blocks(bodies[b].vertex_count, bodies[b].positions, sketches_[b].tiles);
        step_.of[b].tiles = tiles[b] ? tiles[b] : &sketches_[b].tiles;
    }
    fast::lay_out(step_, boxes_);
    fast::stream(step_, boxes_, stream_);
    if (some_missing) sketch_missing_tiles();
    for (std::size_t b = 0; b < bodies.size(); ++b) step_.of[b].moved = at_rest.empty() || !at_rest[b];
    fast::find_regions(step_, boxes_, broad_phase_);
    for (std::size_t b = 0; b < bodies.size(); ++b) make_tile_boxes(b);
}

// From the positions as stream() has packed them. The boxes are known then, and nothing is asked of the tiles
// themselves.
void CellSizeScene::sketch_missing_tiles() {
    std::uint64_t tets = 0;
    for (const Body& body : bodies) tets += body.tets.size();
    const auto wanted = static_cast<double>(std::clamp<std::uint64_t>(tets / 40, 1024, 2048));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (tiles[b] || bodies[b].tets.empty()) continue;
        Body packed = bodies[b];
        packed.positions = {reinterpret_cast<const std::byte*>(step_.of[b].positions), sizeof(Vec3f)};
        const double part = static_cast<double>(packed.tets.size()) / static_cast<double>(tets);
        sketch_tiles(packed, static_cast<std::size_t>(wanted * part) + least_sketched, sketches_[b]);
    }
    fast::lay_out(step_, boxes_); // now with tiles; the boxes of blocks stay as they are
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (tiles[b]) continue;
        fast::StepBody& body = step_.of[b];
        const TileSketch& sketch = sketches_[b];
        std::ranges::copy(sketch.boxes, boxes_.tiles.begin() + body.first_tile);
        std::ranges::copy(sketch.super_tiles, boxes_.super_tiles.begin() + body.first_super);
        std::fill_n(boxes_.tile_known.begin() + body.first_tile, sketch.boxes.size(), std::uint8_t{1});
        body.has_super_boxes = true;
    }
}

// Of the tiles that would be looked up in a step.
void CellSizeScene::make_tile_boxes(std::size_t b) {
    const bool all = !is_empty(own_region(b));
    const fast::StepBody& body = step_.of[b];
    const std::span<const std::uint32_t> reaching = broad_phase_.of_b(static_cast<std::uint32_t>(b));
    for (std::uint32_t s = 0; s < body.tiles->super_tile_count() && (all || !reaching.empty()); ++s)
        if (all || std::any_of(reaching.begin(), reaching.end(), [&](std::uint32_t r) {
                return overlap(boxes_.super_tiles[body.first_super + s], broad_phase_.regions[r].region);
            }))
            fast::make_tile_boxes(body, body.tiles->super_first[s], body.tiles->super_first[s + 1], boxes_);
}

const Box* CellSizeScene::box(std::size_t body) const noexcept {
    const fast::Step& of = step();
    return body < of.of.size() && !of.of[body].rounded ? &boxes().bodies[body] : nullptr;
}

Box CellSizeScene::own_region(std::size_t b) const noexcept {
    const Body& body = bodies[b];
    if (!body.self_collision || body.tets.empty() || (!cleared.empty() && cleared[b])) return empty_box;
    if (!last_step) return boxes_.bodies[b];
    return last_step->windows().of[b].own;
}

} // namespace vox
