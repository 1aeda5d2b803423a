#include "cell_size/tile_sketch.hpp"

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace vox {

namespace {

// Parts of the sample are cut while both of them keep at least so many tetrahedra.
constexpr std::size_t least_items = 12;

struct SampledTet {
    float centroid[3];
    float below[3], above[3]; // how far it extends beyond
    std::uint32_t tet;
};

SampledTet sampled(const Body& body, std::size_t t) {
    SampledTet item{};
    Vec3f p[4];
    for (int c = 0; c < 4; ++c) p[c] = body.positions[body.tets[t].v[c]];
    for (int a = 0; a < 3; ++a) {
        float at[4];
        for (int c = 0; c < 4; ++c) {
            const float x = (&p[c].x)[a] / 4;
            at[c] = std::isfinite(x) ? x : 0;
        }
        item.centroid[a] = at[0] + at[1] + at[2] + at[3];
        const float lo = std::min(std::min(at[0], at[1]), std::min(at[2], at[3])),
                    hi = std::max(std::max(at[0], at[1]), std::max(at[2], at[3]));
        item.below[a] = item.centroid[a] - 4 * lo;
        item.above[a] = 4 * hi - item.centroid[a];
    }
    item.tet = static_cast<std::uint32_t>(t);
    return item;
}

Box box_of_centroids(std::span<const SampledTet> items) {
    Box box = empty_box;
    for (const SampledTet& item : items)
        for (int a = 0; a < 3; ++a) {
            box.lo[a] = std::min(box.lo[a], item.centroid[a]);
            box.hi[a] = std::max(box.hi[a], item.centroid[a]);
        }
    return box;
}

int longest_axis(const Box& box) {
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (box.hi[a] - box.lo[a] > box.hi[axis] - box.lo[axis]) axis = a;
    return axis;
}

class Sketcher {
public:
    explicit Sketcher(TileSketch& out) : out_(out) {}

    // `items` stand for `count` tetrahedra, whose centroids are in `cell`.
    void split(std::span<SampledTet> items, std::uint32_t count, const Box& cell, bool in_super_tile) {
        const std::uint32_t middle = lower_part(count);
        const auto part = static_cast<std::size_t>(static_cast<double>(items.size()) * middle / count + 0.5);
        if (count <= tile_size || std::min(part, items.size() - part) < least_items)
            return cut_box(items, count, cell, in_super_tile);
        const bool is_super_tile = begins_super_tile(count, in_super_tile);
        const int axis = longest_axis(box_of_centroids(items));
        const auto before = [axis](const SampledTet& a, const SampledTet& b) {
            return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis] : a.tet < b.tet;
        };
        std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(part), items.end(),
                         before);
        const auto lower = items.first(part), upper = items.subspan(part);
        const float below = std::max_element(lower.begin(), lower.end(), before)->centroid[axis];
        Box low = cell, high = cell;
        low.hi[axis] = high.lo[axis] = below + (upper[0].centroid[axis] - below) / 2;
        split(lower, middle, low, in_super_tile || is_super_tile);
        split(upper, count - middle, high, in_super_tile || is_super_tile);
        if (is_super_tile) end_super_tile();
    }

private:
    static bool begins_super_tile(std::uint32_t count, bool in_super_tile) {
        return !in_super_tile && count <= super_tile_size * target_tets;
    }
    void end_super_tile() {
        Box box = empty_box;
        for (std::size_t t = out_.tiles.super_first.back(); t < out_.boxes.size(); ++t)
            add(box, out_.boxes[t]);
        out_.super_tiles.push_back(box);
        out_.tiles.super_first.push_back(static_cast<std::uint32_t>(out_.boxes.size()));
    }

    void cut_box(std::span<SampledTet> items, std::uint32_t count, const Box& cell, bool in_super_tile) {
        // Standard libraries leave them in different orders, and sums below depend on it.
        std::sort(items.begin(), items.end(),
                  [](const SampledTet& a, const SampledTet& b) { return a.tet < b.tet; });
        // The box of n evenly distributed points is smaller than where they may be by (n - 1)/(n + 1).
        Box box = box_of_centroids(items);
        const float more = items.size() > 1 ? 1 / static_cast<float>(items.size() - 1) : 0;
        for (int a = 0; a < 3; ++a) {
            const float side = box.hi[a] - box.lo[a];
            box.lo[a] = std::max(box.lo[a] - more * side, cell.lo[a]);
            box.hi[a] = std::min(box.hi[a] + more * side, cell.hi[a]);
        }
        // A tile extends beyond the centroids of its tetrahedra by about what these do on average: those at
        // its surface are cut off where they lie, and the longest of some is further out than the mean.
        for (int a = 0; a < 3; ++a) {
            const auto n = static_cast<float>(items.size());
            overhang_.lo[a] = overhang_.hi[a] = 0;
            for (const SampledTet& item : items) {
                overhang_.lo[a] += item.below[a] / n;
                overhang_.hi[a] += item.above[a] / n;
            }
        }
        cut(box, count, in_super_tile);
    }

    void cut(const Box& box, std::uint32_t count, bool in_super_tile) {
        const bool is_super_tile = begins_super_tile(count, in_super_tile);
        if (count <= tile_size) {
            Box& tile = out_.boxes.emplace_back(box);
            for (int a = 0; a < 3; ++a) {
                tile.lo[a] -= overhang_.lo[a];
                tile.hi[a] += overhang_.hi[a];
            }
        } else {
            const std::uint32_t middle = lower_part(count);
            const int axis = longest_axis(box);
            const float part = static_cast<float>(middle) / static_cast<float>(count);
            Box low = box, high = box;
            low.hi[axis] = high.lo[axis] = box.lo[axis] + part * (box.hi[axis] - box.lo[axis]);
            cut(low, middle, in_super_tile || is_super_tile);
            cut(high, count - middle, in_super_tile || is_super_tile);
        }
        if (is_super_tile) end_super_tile();
    }

    TileSketch& out_;
    Box overhang_ = empty_box; // of the tiles of a part beyond its centroids, below and above
};

} // namespace

void sketch_tiles(const Body& body, std::size_t wanted, TileSketch& out) {
    Array<SampledTet> items(out.boxes.memory());
    items.reserve(std::min(wanted, body.tets.size()));
    for_stratified(body.tets.size(), wanted, 0.5, [&](std::uint64_t t) {
        if (!has_bit(body.off, t)) items.push_back(sampled(body, static_cast<std::size_t>(t)));
    });
    out.tiles.super_first.assign(1, 0);
    if (!items.empty())
        Sketcher(out).split(items, static_cast<std::uint32_t>(body.tets.size() - body.off_count),
                            box_of_centroids(items), false);
    out.tiles.tiles.resize(out.boxes.size());
}

} // namespace vox
