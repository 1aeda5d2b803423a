#include "fast/step.hpp"

#include "base/vectors.hpp"

#include <limits>

namespace vox::fast {

namespace {

// Far from zero, floats are far apart. So bodies whose positions are rounded anyway are rounded relative to a
// point among them. Zero where they are near enough to it, judged by a few vertices: it only matters for
// speed.
Vec3d choose_origin(std::span<const Body> bodies) {
    constexpr std::uint32_t samples = 8;
    constexpr double far = 256, infinity = std::numeric_limits<double>::infinity();
    Vec3d lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};
    for (const Body& body : bodies) {
        if (!body.positions.rounded()) continue;
        const std::uint32_t count = std::min(samples, body.vertex_count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3d p = body.positions.exact(std::uint64_t{i} * body.vertex_count / count);
            lo = min(lo, p);
            hi = max(hi, p);
        }
    }
    return far_middle(lo, hi, far); // zero where there is no finite one
}

void add_pieces(std::uint32_t body, std::uint32_t count, std::uint32_t most, Array<Piece>& pieces) {
    for (std::uint32_t first = 0; first < count; first += most)
        pieces.push_back({body, first, std::min(first + most, count)});
}

} // namespace

void begin_step(std::span<const Body> bodies, Workers* workers, Step& step) {
    step.bodies = bodies;
    step.workers = workers;
    step.of.assign(bodies.size(), {});
}

void lay_out(Step& step, StepBoxes& boxes) {
    step.origin = choose_origin(step.bodies);
    std::size_t blocks = 0, groups = 0, supers = 0, tiles = 0;
    step.block_pieces.clear();
    step.super_pieces.clear();
    for (std::uint32_t b = 0; b < step.bodies.size(); ++b) {
        StepBody& body = step.of[b];
        const std::uint32_t own_blocks = body.tiles->block_count(),
                            own_supers = body.tiles->super_tile_count();
        body.rounded = step.moved_origin() || step.bodies[b].positions.rounded();
        body.first_block = static_cast<std::uint32_t>(blocks);
        body.first_group = static_cast<std::uint32_t>(groups);
        body.first_super = static_cast<std::uint32_t>(supers);
        body.first_tile = static_cast<std::uint32_t>(tiles);
        blocks += own_blocks;
        groups += (own_blocks + group_blocks - 1) / group_blocks;
        supers += own_supers;
        tiles += body.tiles->tiles.size();
        add_pieces(b, own_blocks, piece_blocks, step.block_pieces);
        add_pieces(b, own_supers, piece_super_tiles, step.super_pieces);
    }
    step.block_count = blocks;
    step.super_count = supers;
    step.tile_count = tiles;
    boxes.blocks.resize(blocks);
    boxes.groups.resize(groups);
    boxes.super_tiles.resize(supers);
    boxes.super_change.resize(supers);
    boxes.super_positive.resize(supers);
    boxes.tiles.resize(tiles);
    boxes.tile_known.assign(tiles, 0);
}

} // namespace vox::fast
