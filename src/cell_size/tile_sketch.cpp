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
        items_ = items;
        overhang_known_ = false;
        cut(box, count, in_super_tile);
    }

    void cut(const Box& box, std::uint32_t count, bool in_super_tile) {
        const bool is_super_tile = begins_super_tile(count, in_super_tile);
        if (count <= tile_size) {
            emit(box, count);
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

    void emit(const Box& cell, std::uint32_t count) {
        if (!overhang_known_) find_overhang(cell, count);
        Box box = cell;
        for (int a = 0; a < 3; ++a) {
            box.lo[a] -= overhang_.lo[a];
            box.hi[a] += overhang_.hi[a];
            if (!(box.lo[a] <= box.hi[a])) box.lo[a] = box.hi[a] = cell.lo[a] + (cell.hi[a] - cell.lo[a]) / 2;
        }
        out_.boxes.push_back(box);
    }

    // From one tile for all of the part, which are alike.
    void find_overhang(const Box& cell, std::uint32_t count) {
        overhang_ = empty_box;
        for (int a = 0; a < 3; ++a) {
            const float side = cell.hi[a] - cell.lo[a];
            overhang_.lo[a] = beyond(side, count, [a](const SampledTet& item) { return item.below[a]; });
            overhang_.hi[a] = beyond(side, count, [a](const SampledTet& item) { return item.above[a]; });
        }
        overhang_known_ = true;
    }

    // How far the tetrahedra of a tile extend beyond one end of the interval where their centroids are. With
    // n of them spread over a length s, n/s E[(extent - x)+] extend beyond x on average. Were they placed
    // independently, the largest would be beyond x half of the time where that is log 2. Those of a mesh lie
    // more evenly, and a tree cuts between them: where it is 2 fits the tiles of meshes. Newton's method from
    // below, where the function is convex.
    template <class Extent>
    float beyond(float side, std::uint32_t count, Extent&& extent) const {
        const float wanted = 2 * side / static_cast<float>(count);
        const auto n = static_cast<float>(items_.size());
        float x = 0, most = 0;
        for (const SampledTet& item : items_) {
            x += extent(item) / n;
            most = std::max(most, extent(item));
        }
        x -= wanted; // as if all extents were above
        for (int i = 0; i < 4; ++i) {
            float sum = 0, above = 0;
            for (const SampledTet& item : items_) {
                const float e = extent(item) - x;
                sum += e > 0 ? e : 0.0f;
                above += e > 0 ? 1.0f : 0.0f;
            }
            if (above == 0) break;
            x += (sum - wanted * n) / above;
        }
        return std::min(x, most);
    }

    TileSketch& out_;
    // Of the part whose box is being cut.
    std::span<const SampledTet> items_;
    Box overhang_; // of its tiles over the boxes of their centroids, below and above
    bool overhang_known_ = false;
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
