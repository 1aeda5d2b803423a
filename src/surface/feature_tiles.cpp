// Tiles of features whose middles lie close together, and that are of about the same size.
#include "surface/feature_tiles.hpp"

#include "base/median_splits.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace vox {

namespace {

using Middle = SplitPoint<float>; // as seen from the first vertex

// A feature that is more than 4 times as large as the median one gets into tiles of its size, within a factor
// of 4: else it would blow up the box of a tile.
constexpr float size_ratio = 4;
constexpr int size_classes = 12;

int size_class(float size, float median) noexcept {
    if (!(size > size_ratio * median) || !(median > 0)) return 0;
    // In doubles, as the quotient may be no float; a size may be infinite.
    const double classes = std::log2(double{size} / (double{size_ratio} * median)) / 2;
    return 1 + static_cast<int>(std::min(classes, double{size_classes - 2}));
}

void cut_into_tiles(std::span<Middle> items, Array<std::uint32_t>& features) {
    split_at_medians(items, features_a_tile, 1, [&](std::span<const Middle> tile) {
        const std::size_t end = features.size() + features_a_tile;
        for (const Middle& item : tile) features.push_back(item.index);
        features.resize(end, no_feature);
    });
}

} // namespace

// Sides in floats: those of lower_side() for floats, and for doubles at most two floats below them. What is
// rounded when the origin is subtracted is much less than a float.
void make_vertex_boxes(const SurfaceMotion& motion, Array<Box>& out) {
    out.resize(motion.from.size());
    const Vec3d o = motion.origin;
    const auto make = [&](const auto& below) {
        for (std::size_t v = 0; v < out.size(); ++v) {
            const Vec3d p = motion.from[v], q = motion.to[v];
            const Vec3d lo = min(p, q), hi = max(p, q);
            out[v] = {{below(lo.x, o.x), below(lo.y, o.y), below(lo.z, o.z), 0},
                      {-below(-hi.x, -o.x), -below(-hi.y, -o.y), -below(-hi.z, -o.z), 0}};
        }
    };
    const double r = motion.radius;
    if (o.x == 0 && o.y == 0 && o.z == 0)
        make([r](double at, double) { return number_before(static_cast<float>(at - r)); });
    else
        make([r](double at, double origin) {
            return number_before(static_cast<float>(lower_side(at, r, true) - origin));
        });
}

void make_feature_tiles(const SurfaceTopology& topology, vox_feature feature, std::span<const Vec3d> from,
                        FeatureTiles& out) {
    std::pmr::memory_resource* const memory = out.features.memory();
    const std::uint32_t count = topology.count(feature);
    const unsigned corners = corners_of(feature);
    out.tile_boxes.clear();
    out.features.clear();
    out.corner_count = corners;

    Array<Middle> items(count, memory);
    Array<float> sizes(count, memory);
    const Vec3d origin = from.empty() ? Vec3d{0, 0, 0} : from[0];
    for (std::uint32_t f = 0; f < count; ++f) {
        const std::uint32_t* const v = feature == VOX_FEATURE_VERTEX ? &f : topology.corners(feature, f);
        Vec3d lo = from[v[0]] - origin, hi = lo;
        for (unsigned c = 1; c < corners; ++c) {
            const Vec3d p = from[v[c]] - origin;
            lo = min(lo, p);
            hi = max(hi, p);
        }
        const Vec3d sides = hi - lo, middle = 0.5 * lo + 0.5 * hi;
        items[f] = {
            {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)}, f};
        sizes[f] = static_cast<float>(std::max({sides.x, sides.y, sides.z}));
    }
    float median = 0;
    if (feature != VOX_FEATURE_VERTEX && count > 0) {
        Array<float> sorted(sizes, memory);
        const auto half = sorted.begin() + count / 2;
        std::nth_element(sorted.begin(), half, sorted.end());
        median = *half;
    }
    // A counting sort by class: mostly there is one.
    std::array<std::size_t, size_classes + 1> first{};
    for (std::uint32_t f = 0; f < count; ++f)
        ++first[static_cast<std::size_t>(size_class(sizes[f], median)) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    out.features.reserve((count / features_a_tile + size_classes) * features_a_tile);
    if (first[1] < count) {
        Array<Middle> sorted(count, memory);
        auto next = first;
        for (std::uint32_t f = 0; f < count; ++f)
            sorted[next[static_cast<std::size_t>(size_class(sizes[f], median))]++] = items[f];
        items.swap(sorted);
    }
    for (std::size_t i = 0; i + 1 < first.size(); ++i)
        if (first[i + 1] > first[i])
            cut_into_tiles(std::span(items).subspan(first[i], first[i + 1] - first[i]), out.features);

    const std::size_t slots = out.features.size();
    out.corners.assign(feature == VOX_FEATURE_VERTEX ? 0 : slots * corners, 0u);
    if (feature != VOX_FEATURE_VERTEX)
        for (std::size_t s = 0; s < slots; ++s)
            if (out.features[s] != no_feature)
                std::copy_n(topology.corners(feature, out.features[s]), corners,
                            out.corners.data() + s * corners);
    out.boxes.resize(slots * 6);
    out.tile_boxes.resize(slots / features_a_tile);
}

void make_boxes(std::span<const Box> vertex_boxes, FeatureTiles& tiles) noexcept {
    for (std::uint32_t t = 0; t < tiles.tile_count(); ++t) {
        float* const out = tiles.boxes.data() + std::size_t{t} * 6 * features_a_tile;
        Box all = empty_box;
        for (std::uint32_t lane = 0; lane < features_a_tile; ++lane) {
            const std::uint32_t slot = t * features_a_tile + lane;
            Box box = empty_box;
            if (tiles.features[slot] != no_feature)
                for (const std::uint32_t v : tiles.corners_at(slot)) add(box, vertex_boxes[v]);
            for (unsigned a = 0; a < 3; ++a) {
                out[a * features_a_tile + lane] = box.lo[a];
                out[(a + 3) * features_a_tile + lane] = box.hi[a];
            }
            add(all, box);
        }
        tiles.tile_boxes[t] = all;
    }
}

double looseness_of(const FeatureTiles& tiles) noexcept {
    double of_tiles = 0, of_features = 0;
    const auto sides = [](float x, float y, float z) { return double{x} + double{y} + double{z}; };
    for (std::uint32_t t = 0; t < tiles.tile_count(); ++t) {
        const Box& box = tiles.tile_boxes[t];
        of_tiles += sides(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
        const float* const b = tiles.boxes_of(t); // the first lane is never empty
        constexpr std::size_t n = features_a_tile;
        of_features += sides(b[3 * n] - b[0], b[4 * n] - b[n], b[5 * n] - b[2 * n]);
    }
    return of_features > 0 && of_tiles < 1e300 ? of_tiles / of_features : 0;
}

} // namespace vox
