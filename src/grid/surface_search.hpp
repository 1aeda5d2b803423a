// What the searches over surfaces share. Two bodies are joined by the boxes of their tiles: those tiles that
// the other body reaches get a box, these are compared with the boxes of the other body, by groups of them,
// and then the features of a tile with those of another, in lanes (box_lanes.hpp).
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "base/room.hpp"
#include "base/scene.hpp"
#include "fast/broad_phase.hpp"
#include "fast/step_scene.hpp"
#include "grid/box_lanes.hpp"
#include "grid/oriented_box.hpp"
#include "grid/surface_features.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

inline constexpr std::uint32_t tiles_of_small_body = 64; // fewer are not worth tasks of their own

// The boxes of the blocks of a body, and of groups of them.
struct BlockBoxes {
    const Box *blocks, *groups;
};

// Where something is at both ends of a step; in between, each of its points is on a straight way.
struct MovingBox {
    Box from, to;
};
inline constexpr MovingBox empty_moving_box{empty_box, empty_box};

inline void add(MovingBox& a, const MovingBox& b) noexcept {
    add(a.from, b.from);
    add(a.to, b.to);
}

// Whether two that move certainly stay further apart than `reach`, which also covers what their coordinates
// are rounded by; until a time, 1 being the end of the step.
bool stay_apart(const MovingBox& a, const MovingBox& b, float reach, double until = 1) noexcept;

// By how much boxes of floats of a body grow, so that two that are within the margin overlap.
float growth(const Box& box, double margin) noexcept;

// A tile is crowded if more pairs of its features and another tile's have boxes that overlap. It is then
// worth an oriented box: of slivers laid across each other, all boxes overlap, and little touches.
inline constexpr std::uint32_t crowd = 768;
inline std::uint32_t count_pairs(std::span<const std::uint32_t> met) noexcept {
    std::uint32_t pairs = 0;
    for (const std::uint32_t bits : met) pairs += static_cast<std::uint32_t>(std::popcount(bits));
    return pairs;
}

// A body as a search sees it. A vertex may be anywhere on its way from `before` to `at`.
struct SearchedBody {
    const float* at; // packed, rounded to floats
    BlockBoxes blocks;
    std::span<const std::uint32_t> first_of_block; // vertices, and the end
    Box box;                                       // around all vertices
    const float* before = nullptr;                 // as `at`; null for one that stands still
    float grow = 0;                                // of two bodies, the sum is how far apart boxes can be
    MovingBox moving_box = empty_moving_box;       // around all vertices; of bodies in a search for meetings

    // Set for bodies of which tiles are reached.
    static constexpr std::uint32_t not_reached = ~0u;
    const SurfaceFeatures* features = nullptr;
    std::uint32_t first_tile = not_reached;
    Box reached = empty_box;   // around where others reach the body
    Box tiles_box = empty_box; // around the tiles there

    std::uint32_t block_count() const noexcept {
        return static_cast<std::uint32_t>(first_of_block.size() - 1);
    }
    std::uint32_t tile_count() const noexcept { return static_cast<std::uint32_t>(features->tiles.size()); }
    Box vertex_box(std::uint32_t vertex) const noexcept {
        Box box_there = box_at(at, vertex);
        if (before) add(box_there, box_at(before, vertex));
        return box_there;
    }
    MovingBox moving_vertex(std::uint32_t vertex) const noexcept {
        return {box_at(before ? before : at, vertex), box_at(at, vertex)};
    }
    // Calls visit(i, box) for vertices[i], i < count. What stands still gets a loop of its own.
    template <class Visit>
    void for_vertex_boxes(const std::uint32_t* vertices, std::uint32_t count, const Visit& visit) const {
        if (before)
            for (std::uint32_t i = 0; i < count; ++i) visit(i, vertex_box(vertices[i]));
        else
            for (std::uint32_t i = 0; i < count; ++i) visit(i, box_at(at, vertices[i]));
    }

private:
    static Box box_at(const float* positions, std::uint32_t vertex) noexcept {
        const float* p = positions + 3 * std::size_t{vertex};
        return {{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
    }
};

// Of a tile of a body that stands still: its vertices; the box around them along what its longest edges have
// in common; boxes of its faces, each along axes of its own; and the sides of these as lines.
inline void load_still(const SearchedBody& body, const SurfaceTile& tile, Vec3d* out) noexcept {
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v) {
        const float* const p = body.at + 3 * std::size_t{body.features->vertices[tile.first_vertex + v]};
        out[v] = {p[0], p[1], p[2]};
    }
}
OrientedBox oriented_box(const SearchedBody& body, std::uint32_t tile) noexcept;
// Whether what there is of two tiles in the box of the other is certainly further apart than `reach`.
bool tiles_stay_apart(const SearchedBody& a, std::uint32_t tile_a, const OrientedBox& box_a,
                      const SearchedBody& b, std::uint32_t tile_b, const OrientedBox& box_b,
                      double reach) noexcept;
void load_slabs(const SurfaceFeatures& features, const SurfaceTile& tile, const Vec3d* points,
                FaceSlabs& out) noexcept;
void load_lines(const SurfaceFeatures& features, const SurfaceTile& tile, const Vec3d* points,
                FaceLines& out) noexcept;

// The bodies of one search, and the boxes of their tiles: made where others reach them, else empty.
class SearchedBodies {
public:
    explicit SearchedBodies(std::pmr::memory_resource* memory) noexcept
        : bodies_(memory), reached_(memory), pieces_(memory), tile_boxes_(memory) {}

    // All bodies of the step, as they stand, none of them reached.
    void begin(const StepScene& scene);
    // Adds to where the surface of a body, which has one, is reached.
    void reach(std::uint32_t body, const Box& region);
    // Makes the boxes. Throws what the memory throws.
    void make_boxes(const StepScene& scene, KeptFeatures& kept);

    SearchedBody& operator[](std::size_t body) noexcept { return bodies_[body]; }
    const SearchedBody& operator[](std::size_t body) const noexcept { return bodies_[body]; }
    std::size_t size() const noexcept { return bodies_.size(); }
    const Box* tile_boxes(std::uint32_t body) const noexcept {
        return tile_boxes_.data() + bodies_[body].first_tile;
    }

private:
    struct Piece { // tiles of a body
        std::uint32_t body, first, last;
    };
    void make_boxes(const Piece& piece);

    Array<SearchedBody> bodies_;
    Array<std::uint32_t> reached_; // bodies
    Array<Piece> pieces_;
    Array<Box> tile_boxes_; // of bodies that are reached
};

inline Box grown(const Box& box, float by) noexcept {
    Box out;
    for (int i = 0; i < 4; ++i) out.lo[i] = box.lo[i] - by;
    for (int i = 0; i < 4; ++i) out.hi[i] = box.hi[i] + by;
    return out;
}

// The boxes of the vertices of a tile, and from these those of its faces, grown by `reach` on each side.
using TilePoints = std::array<Box, SurfaceTile::most_vertices>;
inline void load_points(const SearchedBody& body, const SurfaceTile& tile, TilePoints& out) noexcept {
    body.for_vertex_boxes(body.features->vertices.data() + tile.first_vertex, tile.vertex_count,
                          [&](std::uint32_t v, const Box& box) { out[v] = box; });
}

inline void load_faces(const SurfaceFeatures& features, const SurfaceTile& tile, const TilePoints& points,
                       float reach, FaceBoxes& out) noexcept {
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [u, v, w] = features.faces[tile.first_face + f];
        Box box = points[u];
        add(box, points[v]);
        add(box, points[w]);
        out.set(f, grown(box, reach));
    }
}

// The positions of the vertices of a tile.
inline void load_positions(const Positions& positions, const SurfaceFeatures& features,
                           const SurfaceTile& tile, Vec3d* out) noexcept {
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
        out[v] = positions.exact(features.vertices[tile.first_vertex + v]);
}

// Lists those of `count` boxes of which find(first, some) gives the bits, for some of them at a time.
template <class Find>
void list_found(std::uint32_t count, Array<std::uint32_t>& out, const Find& find) {
    out.clear();
    for (std::uint32_t first = 0; first < count; first += fast::most_boxes)
        for (std::uint64_t met = find(first, std::min(fast::most_boxes, count - first)); met;
             met &= met - 1) {
            reserve_growing(out, out.size() + 1);
            out.push_back(first + static_cast<std::uint32_t>(std::countr_zero(met)));
        }
}
inline void list_overlaps(const Box* boxes, std::uint32_t count, const Box& region,
                          Array<std::uint32_t>& out) {
    list_found(count, out, [&](std::uint32_t first, std::uint32_t some) {
        return fast::find_overlaps(boxes + first, some, region);
    });
}

// Boxes that follow each other and are near each other, and a box around each group of them.
struct GroupedBoxes {
    static constexpr std::uint32_t group_size = 32;

    explicit GroupedBoxes(std::pmr::memory_resource* memory) : boxes(memory), groups(memory) {}
    auto buffers() { return std::tie(boxes, groups); }

    Array<Box> boxes, groups;

    void clear() noexcept {
        boxes.clear();
        groups.clear();
    }
    void push_back(const Box& box) {
        if (boxes.size() % group_size == 0) {
            reserve_growing(groups, groups.size() + 1);
            groups.push_back(empty_box);
        }
        add(groups.back(), box);
        reserve_growing(boxes, boxes.size() + 1);
        boxes.push_back(box);
    }
    // Calls visit(i) for those that overlap `box`, in their order, but of groups that do enter(group) only.
    template <class Enter, class Visit>
    void for_overlaps(const Box& box, const Enter& enter, const Visit& visit) const {
        for (std::size_t group = 0; group < groups.size(); ++group) {
            if (!overlap(groups[group], box) || !enter(group)) continue;
            const std::size_t first = group * group_size;
            const auto count =
                static_cast<std::uint32_t>(std::min<std::size_t>(group_size, boxes.size() - first));
            for (std::uint64_t met = fast::find_overlaps(&boxes[first], count, box); met; met &= met - 1)
                visit(first + static_cast<std::size_t>(std::countr_zero(met)));
        }
    }
    template <class Visit>
    void for_overlaps(const Box& box, const Visit& visit) const {
        for_overlaps(
            box, [](std::size_t) { return true; }, visit);
    }
};

// Workers share pairs of bodies, and then the tiles of each pair whose tiles_of(pair) is large. list(pair,
// lists) puts into the lists of a worker what search(pair, lists, begin, end, worker) goes through: items
// [begin, end) of as many as it returned. A search in pieces may find more, so their number does not depend
// on how they are shared.
template <class Lists, class TilesOf, class List, class Search>
void join_pairs(std::span<const fast::Pair> pairs, PerWorker<Lists>& lists, Workers& workers,
                const TilesOf& tiles_of, const List& list, const Search& search) {
    constexpr std::size_t task_pairs = 16, task_tiles = 8; // that are worth a task of their own
    const auto is_large = [&](const fast::Pair& pair) { return tiles_of(pair) >= tiles_of_small_body; };
    workers.for_ranges(pairs.size(), task_pairs, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
        for (std::size_t i = begin; i < end; ++i)
            if (!is_large(pairs[i]))
                if (const std::size_t count = list(pairs[i], lists[w]); count > 0)
                    search(pairs[i], lists[w], std::size_t{0}, count, w);
    });
    for (const fast::Pair& pair : pairs) {
        const std::size_t count = is_large(pair) ? list(pair, lists[0]) : 0;
        if (count == 0) continue;
        const std::size_t pieces =
            workers.count() == 1
                ? 1
                : std::min<std::size_t>((count - 1) / task_tiles + 1, std::size_t{4} * workers.count());
        workers.for_ranges(pieces, 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            for (std::size_t i = begin; i < end; ++i)
                search(pair, lists[0], i * count / pieces, (i + 1) * count / pieces, w);
        });
    }
}

} // namespace vox
