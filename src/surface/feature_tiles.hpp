// The features of one kind in tiles of at most 64 that lie close together, and their boxes.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "surface/motion.hpp"
#include "surface/topology.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

inline constexpr std::uint32_t features_a_tile = 64;
inline constexpr std::uint32_t no_feature = ~0u;

// A feature has a slot: slot / 64 is its tile, slot % 64 its lane there. The features of a tile ascend; the
// lanes after the last one are empty.
struct FeatureTiles {
    explicit FeatureTiles(std::pmr::memory_resource* memory) noexcept
        : features(memory), corners(memory), boxes(memory), tile_boxes(memory) {}

    std::uint32_t tile_count() const noexcept { return static_cast<std::uint32_t>(tile_boxes.size()); }
    const float* boxes_of(std::uint32_t tile) const noexcept {
        return boxes.data() + std::size_t{tile} * 6 * features_a_tile;
    }
    // The corners of a slot, and of the slots after it.
    const std::uint32_t* corners_from(std::uint32_t slot) const noexcept {
        return corner_count == 1 ? features.data() + slot : corners.data() + std::size_t{slot} * corner_count;
    }
    std::span<const std::uint32_t> corners_at(std::uint32_t slot) const noexcept {
        return {corners_from(slot), corner_count};
    }

    unsigned corner_count = 0;     // of a feature
    Array<std::uint32_t> features; // of each slot; no_feature of an empty one
    Array<std::uint32_t> corners;  // corner_count vertices a slot; none of vertices, which are their own
    // For each tile 6 * 64 floats: low x of its lanes, low y, low z, high x, high y, high z. They hold the
    // boxes of the features; where positions are doubles, they are a little larger. Empty lanes have empty
    // boxes.
    Array<float> boxes;
    Array<Box> tile_boxes;
    double looseness = 0; // of the tiles as they were made (looseness_of)
};

// The boxes of vertices in motion: outer bounds of those of vox_motion.radius, in floats.
void make_vertex_boxes(const SurfaceMotion& motion, Array<Box>& out);

// Sorts the features of a kind into tiles: by a k-d tree over their middles at the start of the motion, those
// that are much larger than others apart from them. Throws what the memory throws and leaves `out` without
// tiles then.
void make_feature_tiles(const SurfaceTopology& topology, vox_feature feature, std::span<const Vec3d> from,
                        FeatureTiles& out);

// The boxes of all features and tiles, from those of vertices.
void make_boxes(std::span<const Box> vertex_boxes, FeatureTiles& tiles) noexcept;

// How long tiles are in relation to what is in them. It grows when features that were close together part.
double looseness_of(const FeatureTiles& tiles) noexcept;

} // namespace vox
