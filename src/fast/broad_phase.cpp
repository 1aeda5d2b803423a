// For each pair of bodies (body_pairs.hpp), the region where the boxes of the two overlap is shrunk to what
// blocks of a and tiles of b cover.
#include "fast/broad_phase.hpp"

#include "base/simd.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/broad_phase.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"
#include "fast/tile-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// A box is above or below a region along an axis where its low corner is beyond the region's high one, or the
// other way round. With the signs of all high corners turned that is one comparison of all six.
//
// The region's are turned before they are blended: gcc 12 stops with an internal error (sse.md, output_6924)
// on a blend of two broadcasts at -O1 with sanitizers.

// A region, and the sides of eight boxes from there, a byte each.
class Sides {
public:
    static constexpr std::uint32_t at_once = 8;

    HWY_INLINE explicit Sides(const Box& region)
        : sign_(hn::OddEvenBlocks(hn::Set(d, -0.0f), hn::Zero(d))), // odd blocks are high corners
          bound_(hn::OddEvenBlocks(hn::Neg(hn::LoadDup128(d, region.lo)), hn::LoadDup128(d, region.hi))),
          region_(region) {}

    HWY_INLINE std::uint64_t operator()(const Box* boxes) const {
        std::uint64_t sides = 0;
        constexpr std::size_t lanes = hn::MaxLanes(d);
        if constexpr (lanes >= 8) { // whole boxes
            for (std::size_t i = 0; i < at_once; i += lanes / 8) {
                const auto corners = hn::Xor(hn::LoadU(d, boxes[i].lo), sign_);
                std::uint8_t bits[8];
                hn::StoreMaskBits(d, hn::Gt(corners, bound_), bits);
                std::uint64_t some = 0;
                std::memcpy(&some, bits, lanes / 8);
                sides |= some << (8 * i);
            }
        } else {
            for (unsigned i = 0; i < at_once; ++i)
                sides |= std::uint64_t{sides_of(boxes[i], region_)} << (8 * i);
        }
        return sides & (all_sides * each_byte);
    }

    // Bits of the bytes that are zero.
    HWY_INLINE static std::uint64_t None(std::uint64_t sides) {
        // No byte is above 0x77, so that nothing is carried from one to the next; then the bits are gathered.
        const std::uint64_t some = (sides + 0x7f * each_byte) >> 7 & each_byte;
        return (some ^ each_byte) * 0x0102040810204080u >> 56;
    }

private:
    static constexpr std::uint64_t each_byte = 0x0101010101010101u;
    static constexpr hn::CappedTag<float, 16> d{};
    hn::Vec<hn::CappedTag<float, 16>> sign_, bound_;
    const Box& region_;
};

void FindSides(const Box* HWY_RESTRICT boxes, std::size_t count, const Box& region,
               std::uint8_t* HWY_RESTRICT out) {
    const Sides sides(region);
    std::size_t i = 0;
    for (; i + Sides::at_once <= count; i += Sides::at_once) {
        const std::uint64_t some = sides(boxes + i);
        std::memcpy(out + i, &some, sizeof some);
    }
    for (; i < count; ++i) out[i] = static_cast<std::uint8_t>(sides_of(boxes[i], region));
}

unsigned CommonSides(const Box* HWY_RESTRICT boxes, const std::uint32_t* HWY_RESTRICT which,
                     std::size_t count, const Box& region) {
    constexpr hn::CappedTag<float, 8> d;
    constexpr std::size_t at_once = 16; // between branches
    if constexpr (hn::MaxLanes(d) == 8) {
        const auto sign = hn::OddEvenBlocks(hn::Set(d, -0.0f), hn::Zero(d));
        const auto bound =
            hn::OddEvenBlocks(hn::Neg(hn::LoadDup128(d, region.lo)), hn::LoadDup128(d, region.hi));
        unsigned common = all_sides;
        for (std::size_t i = 0; i < count && common; i += at_once) {
            auto beyond = hn::VecFromMask(d, hn::Eq(bound, bound));
            for (std::size_t k = i; k < std::min(i + at_once, count); ++k)
                beyond = hn::And(
                    beyond,
                    hn::VecFromMask(d, hn::Gt(hn::Xor(hn::LoadU(d, boxes[which[k]].lo), sign), bound)));
            common &= static_cast<unsigned>(vox::HWY_NAMESPACE::BitsOfMask(d, hn::MaskFromVec(beyond)));
        }
        return common;
    } else {
        unsigned common = all_sides;
        for (std::size_t i = 0; i < count && common; ++i) common &= sides_of(boxes[which[i]], region);
        return common;
    }
}

std::uint64_t FindOverlaps(const Box* HWY_RESTRICT boxes, std::uint32_t count, const Box& region) {
    const Sides sides(region);
    std::uint64_t overlaps = 0;
    std::uint32_t i = 0;
    for (; i + Sides::at_once <= count; i += Sides::at_once) overlaps |= Sides::None(sides(boxes + i)) << i;
    for (; i < count; ++i) overlaps |= std::uint64_t{sides_of(boxes[i], region) == 0} << i;
    return overlaps;
}

void TileBoxes(const Tiles& tiles, const float* HWY_RESTRICT positions, std::uint32_t first,
               std::uint32_t last, Box* HWY_RESTRICT boxes, std::uint8_t* HWY_RESTRICT known) {
    for (std::uint32_t t = first; t < last; ++t) {
        if (known[t]) continue;
        known[t] = 1;
        const Tile& tile = tiles.tiles.data()[t];
        const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
        const std::uint32_t padded = (tile.vertex_count + 3u) & ~3u;
        if (tile.holds_last_vertex)
            BoxOf(positions, vertices, padded, LoadLastVertex, boxes[t]);
        else
            BoxOf(positions, vertices, padded, LoadVertex, boxes[t]);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

void find_sides(const Box* boxes, std::size_t count, const Box& region, std::uint8_t* sides) {
    VOX_SIMD_DISPATCH(FindSides)(boxes, count, region, sides);
}

unsigned common_sides(const Box* boxes, std::span<const std::uint32_t> which, const Box& region) {
    return VOX_SIMD_DISPATCH(CommonSides)(boxes, which.data(), which.size(), region);
}

std::uint64_t find_overlaps(const Box* boxes, std::uint32_t count, const Box& region) {
    return VOX_SIMD_DISPATCH(FindOverlaps)(boxes, count, region);
}

std::uint64_t find_blocks(const Box* blocks, const Box* groups, std::uint32_t count, const Box& region) {
    std::uint64_t met = 0;
    for (std::uint32_t i = 0; i < count; i += group_blocks) {
        const Box& group = groups[i / group_blocks];
        if (!overlap(group, region)) continue;
        const std::uint32_t some = std::min(group_blocks, count - i);
        met |= (contains(region, group) ? (std::uint64_t{1} << some) - 1
                                        : find_overlaps(blocks + i, some, region))
               << i;
    }
    return met;
}

void make_tile_boxes(const Tiles& tiles, const float* positions, std::uint32_t first, std::uint32_t last,
                     Box* boxes, std::uint8_t* known) {
    VOX_SIMD_DISPATCH(TileBoxes)(tiles, positions, first, last, boxes, known);
}

namespace {

// How much work is worth a task of its own. Handing out a task takes a microsecond or more, and by
// bench_stages so much work takes two to eight: testing boxes at 0.5 to 1 ns each, or making boxes of tiles
// at 15 to 30 ns each.
constexpr std::size_t task_boxes = 4096;
constexpr std::size_t task_blocks = 4 * piece_blocks;
constexpr std::size_t task_tiles = 256;

// The box around those vertices of a body of one block that are in a region.
Box box_of_vertices(const StepBody& body, const Box& region) {
    Box box = empty_box;
    const float* p = body.positions;
    for (std::uint32_t v = body.tiles->block_first.front(); v < body.tiles->block_first.back(); ++v, p += 3) {
        const Box point{{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
        if (overlap(point, region)) add(box, point);
    }
    return box;
}

// Pairs of bodies that may collide, with the region where their boxes overlap. Where many small bodies are in
// one place, their vertices show that most pairs are none: here already, so that these take no memory.
void list_regions(const Step& step, const StepBoxes& boxes, BroadPhase& out) {
    find_pairs(boxes.bodies, {step.bodies, step.of}, out.pair_buffers, out.pairs);
    out.regions.clear();
    for (const Pair& pair : out.pairs) {
        if (step.bodies[pair.b].tets.empty()) continue;
        PairRegion region{pair.a, pair.b, boxes.bodies[pair.a], {}};
        intersect(region.region, boxes.bodies[pair.b]);
        if (step.of[pair.a].tiles->block_count() == 1) {
            region.region = box_of_vertices(step.of[pair.a], region.region);
            if (is_empty(region.region)) continue;
        }
        out.regions.push_back(region);
    }
}

// Shrinks the region to what blocks of a cover.
void shrink_to_blocks(const Step& step, const StepBoxes& boxes, PairRegion& pair) {
    Box reached = empty_box;
    const StepBody& body = step.of[pair.a];
    if (body.tiles->block_count() == 1) return; // list_regions() has looked at its vertices
    const Box* blocks = boxes.blocks.data() + body.first_block;
    const Box* groups = boxes.groups.data() + body.first_group;
    const std::uint32_t count = body.tiles->block_count();
    for (std::uint32_t i = 0; i < count; i += group_blocks) {
        const Box& group = groups[i / group_blocks];
        if (!overlap(group, pair.region)) continue;
        if (contains(pair.region, group)) {
            add(reached, group);
            continue;
        }
        std::uint64_t met = find_overlaps(blocks + i, std::min(group_blocks, count - i), pair.region);
        for (; met; met &= met - 1)
            add(reached, blocks[i + static_cast<std::uint32_t>(std::countr_zero(met))]);
    }
    intersect(pair.region, reached);
}

// Where each body begins in `regions`, and the same by b: counted, summed, placed.
void index_regions(std::size_t body_count, BroadPhase& out) {
    out.first_of_a.assign(body_count + 1, 0);
    out.first_of_b.assign(body_count + 2, 0);
    for (const PairRegion& r : out.regions) {
        ++out.first_of_a[r.a + 1];
        ++out.first_of_b[r.b + 2];
    }
    std::partial_sum(out.first_of_a.begin(), out.first_of_a.end(), out.first_of_a.begin());
    std::partial_sum(out.first_of_b.begin(), out.first_of_b.end(), out.first_of_b.begin());
    out.by_b.resize(out.regions.size());
    for (std::uint32_t r = 0; r < out.regions.size(); ++r)
        out.by_b[out.first_of_b[out.regions[r].b + 1]++] = r;
}

// True if the super-tiles of a body only matter where others reach it.
bool uses_block_sides(const Step& step, const BroadPhase& broad, std::uint32_t body) {
    return broad.is_reached(body) && !step.bodies[body].self_collision;
}

// On which side of the reached region the blocks of a body are: a byte shows that most super-tiles are out of
// reach, and is less to read than a box. Those that are to one side all together have the sides that all of
// them are on, and no others.
void find_block_sides(const Step& step, const StepBoxes& boxes, const Piece& piece, BroadPhase& out) {
    if (!uses_block_sides(step, out, piece.body)) return;
    const Box region = out.reached[piece.body];
    const StepBody& body = step.of[piece.body];
    for (std::uint32_t i = piece.first; i < piece.last; i += group_blocks) {
        const std::uint32_t count = std::min(group_blocks, piece.last - i);
        std::uint8_t* sides = &out.block_sides[body.first_block + i];
        if (const unsigned common = sides_of(boxes.groups[body.first_group + i / group_blocks], region))
            std::fill_n(sides, count, static_cast<std::uint8_t>(common));
        else
            find_sides(&boxes.blocks[body.first_block + i], count, region, sides);
    }
}

// The boxes of the super-tiles of a body, and of all tiles in those that others reach. Of a super-tile inside
// the regions that it meets, only the first tile gets one: nearly all of its tiles will be looked up in, and
// their vertices be read for that anyway.
void make_reached_boxes(const Step& step, const BroadPhase& broad, const Piece& piece, StepBoxes& boxes) {
    if (!broad.is_reached(piece.body)) return;
    const StepBody& body = step.of[piece.body];
    if (!body.has_super_boxes) make_super_tile_boxes(step, broad, piece, boxes);
    const Tiles& tiles = *body.tiles;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        const Box& box = boxes.super_tiles[body.first_super + s];
        bool meets_one = false, is_inside = true;
        for (const std::uint32_t r : broad.of_b(piece.body)) {
            const Box& region = broad.regions[r].region;
            if (!overlap(box, region)) continue;
            meets_one = true;
            is_inside &= contains(region, box);
        }
        const std::uint32_t first = tiles.super_first[s], last = tiles.super_first[s + 1];
        if (meets_one) make_tile_boxes(body, first, is_inside ? std::min(first + 1, last) : last, boxes);
    }
}

// Shrinks the region to what tiles of b cover. Super-tiles inside it stand for their tiles.
void shrink_to_tiles(const Step& step, const StepBoxes& boxes, PairRegion& pair) {
    const StepBody& body = step.of[pair.b];
    const Tiles& tiles = *body.tiles;
    const std::uint32_t super_tiles = tiles.super_tile_count();
    const Box* tile_boxes = boxes.tiles.data() + body.first_tile;
    Box covered = empty_box;
    for (std::uint32_t s = 0; s < super_tiles; ++s) {
        const Box& box = boxes.super_tiles[body.first_super + s];
        if (!overlap(box, pair.region)) continue;
        const std::uint32_t first = tiles.super_first[s], last = tiles.super_first[s + 1];
        if (contains(pair.region, box)) {
            add(covered, box);
            if (first < last) pair.tile_size.add(tile_boxes[first], last - first);
            continue;
        }
        for (std::uint32_t t = first; t < last; ++t) {
            if (!overlap(tile_boxes[t], pair.region)) continue;
            add(covered, tile_boxes[t]);
            pair.tile_size.add(tile_boxes[t]);
        }
    }
    intersect(pair.region, covered);
    if (is_empty(pair.region)) pair.region = empty_box;
}

} // namespace

void find_regions(const Step& step, StepBoxes& boxes, BroadPhase& out) {
    list_regions(step, boxes, out);
    std::size_t blocks = 0, tiles = 0;
    for (const PairRegion& pair : out.regions) blocks += step.of[pair.a].tiles->block_count();
    step.for_each(out.regions.size(), blocks, task_boxes,
                  [&](std::size_t r, std::uint32_t) { shrink_to_blocks(step, boxes, out.regions[r]); });
    erase_if(out.regions, [](const PairRegion& pair) { return is_empty(pair.region); });
    index_regions(step.bodies.size(), out);

    out.block_sides.resize(step.block_count);
    out.reached.assign(step.bodies.size(), empty_box);
    if (out.regions.empty()) return;
    for (const PairRegion& pair : out.regions) {
        add(out.reached[pair.b], pair.region);
        tiles += step.of[pair.b].tiles->tiles.size();
    }
    step.for_each(step.block_pieces.size(), step.block_count, task_blocks, [&](std::size_t p, std::uint32_t) {
        find_block_sides(step, boxes, step.block_pieces[p], out);
    });
    step.for_each(step.super_pieces.size(), step.tile_count, task_tiles, [&](std::size_t p, std::uint32_t) {
        make_reached_boxes(step, out, step.super_pieces[p], boxes);
    });
    step.for_each(out.regions.size(), tiles, task_boxes,
                  [&](std::size_t r, std::uint32_t) { shrink_to_tiles(step, boxes, out.regions[r]); });
}

void make_super_tile_boxes(const Step& step, const BroadPhase& broad, const Piece& piece, StepBoxes& boxes) {
    const StepBody& body = step.of[piece.body];
    const Box* blocks = boxes.blocks.data() + body.first_block;
    const std::uint8_t* sides = broad.block_sides.data() + body.first_block;
    const bool has_sides = uses_block_sides(step, broad, piece.body);
    const auto is_out_of_reach = [&](std::span<const std::uint32_t> of) {
        constexpr std::size_t at_once = 8; // between branches
        unsigned common = all_sides;
        std::size_t i = 0;
        for (; i + at_once <= of.size() && common; i += at_once)
            for (std::size_t j = 0; j < at_once; ++j) common &= sides[of[i + j]];
        for (; i < of.size() && common; ++i) common &= sides[of[i]];
        return common != 0;
    };
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        Box box = empty_box;
        const std::span<const std::uint32_t> of = body.tiles->blocks[s];
        if (!has_sides || !is_out_of_reach(of))
            for (const std::uint32_t block : of) add(box, blocks[block]);
        boxes.super_tiles[body.first_super + s] = box;
    }
}

} // namespace vox::fast
#endif
