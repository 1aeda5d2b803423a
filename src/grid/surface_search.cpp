#include "grid/surface_search.hpp"

#include "base/vectors.hpp"

#include <cmath>

namespace vox {

namespace {

// Positions of which nothing is known but the nearest floats are off by 2^-24 of the largest coordinate at
// most, on each axis, and so is a side of a box that has grown.
constexpr double rounding = 0x1p-21;

} // namespace

float growth(const Box& box, double margin) noexcept {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, double{std::abs(box.lo[i])}, double{std::abs(box.hi[i])}});
    const double by = 0.5 * margin + rounding * (largest + margin) + 0x1p-126;
    return static_cast<float>(std::min(by, 0x1p126));
}

// Proof. At either end of the step the differences of points of a and of b fill a box around `middle` that
// reaches `half` from it; in between, the difference of two points is on the straight way from one to the
// other. So it stays further than `reach` from zero if along some vector w, at both ends,
//     w . middle - |w| . half > reach |w|,    where |w| . half sums the products of magnitudes.
// How w was found does not matter: here it is each axis, and then the point where the middles come closest.
// The products are in doubles, whose rounding is less than that of a coordinate to a float by 2^-25.
bool stay_apart(const MovingBox& a, const MovingBox& b, float reach, double until) noexcept {
    double middle[2][3], half[2][3];
    const auto take = [&](int end, const Box& of_a, const Box& of_b) {
        for (int i = 0; i < 3; ++i) {
            const double low = double{of_a.lo[i]} - double{of_b.hi[i]},
                         high = double{of_a.hi[i]} - double{of_b.lo[i]};
            middle[end][i] = 0.5 * (low + high);
            half[end][i] = 0.5 * (high - low) + double{reach};
        }
    };
    take(0, a.from, b.from);
    take(1, a.to, b.to);
    for (int i = 0; until < 1 && i < 3; ++i) {
        middle[1][i] = middle[0][i] + until * (middle[1][i] - middle[0][i]);
        half[1][i] = half[0][i] + until * (half[1][i] - half[0][i]);
    }
    for (int i = 0; i < 3; ++i)
        if ((middle[0][i] > half[0][i] && middle[1][i] > half[1][i]) ||
            (middle[0][i] < -half[0][i] && middle[1][i] < -half[1][i]))
            return true;
    const Vec3d from = vector_of(middle[0]), to = vector_of(middle[1]), way = to - from;
    const double squared = dot(way, way);
    const double closest = squared > 0 ? std::clamp(-dot(from, way) / squared, 0.0, 1.0) : 0;
    const Vec3d w = from + closest * way;
    const Vec3d size{std::abs(w.x), std::abs(w.y), std::abs(w.z)};
    return dot(w, from) > dot(size, vector_of(half[0])) && dot(w, to) > dot(size, vector_of(half[1]));
}

OrientedBox oriented_box(const SearchedBody& body, std::uint32_t index) noexcept {
    const SurfaceTile& tile = body.features->tiles[index];
    std::array<Vec3d, SurfaceTile::most_vertices> points;
    load_still(body, tile, points.data());
    Vec3d along{0, 0, 0};
    for (std::uint32_t f = tile.first_face; f < tile.first_face + tile.face_count; ++f) {
        const auto& [a, b, c] = body.features->faces[f];
        const Vec3d edge = longest_edge(points[a], points[b], points[c]);
        along = along + (dot(edge, along) < 0 ? -1 : 1) * edge;
    }
    return oriented_box(std::span(points).first(tile.vertex_count), along);
}

namespace {

struct Span {
    double lo, hi;
};

Span span_along(const Vec3d& w, const OrientedBox& box, double reach) noexcept {
    const double middle = dot(w, box.middle), half = extent(box, w) + reach;
    return {middle - half, middle + half};
}

// What the faces of a tile whose box is `box` span along w, where they lie within `within` along u. The
// corners of that part of a face are on its sides. A side is cut only where it is so steep that rounding
// moves the cut by less than 2^-29 of the largest coordinate.
Span span_of_part(const SearchedBody& body, std::uint32_t index, const OrientedBox& box, const Vec3d& u,
                  const Span& within, const Vec3d& w) noexcept {
    const SurfaceTile& tile = body.features->tiles[index];
    std::array<Vec3d, SurfaceTile::most_vertices> points;
    load_still(body, tile, points.data());
    std::array<double, SurfaceTile::most_vertices> along, at;
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v) {
        along[v] = dot(u, points[v]);
        at[v] = dot(w, points[v]);
    }
    const double steep = 0x1p-19 * (box.half[0] + box.half[1] + box.half[2]);
    Span out{HUGE_VAL, -HUGE_VAL};
    for (std::uint32_t f = tile.first_face; f < tile.first_face + tile.face_count; ++f) {
        const std::array<std::uint8_t, 3>& corners = body.features->faces[f];
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t i = corners[c], j = corners[c == 2 ? 0 : c + 1];
            if (std::max(along[i], along[j]) < within.lo || std::min(along[i], along[j]) > within.hi)
                continue;
            const double way = along[j] - along[i], rise = at[j] - at[i];
            double from = 0, to = 1;
            if (std::abs(way) > steep) {
                const double s = (within.lo - along[i]) / way, t = (within.hi - along[i]) / way;
                from = std::max(from, std::min(s, t));
                to = std::min(to, std::max(s, t));
            }
            const double first = at[i] + from * rise, last = at[i] + to * rise;
            out.lo = std::min({out.lo, first, last});
            out.hi = std::max({out.hi, first, last});
        }
    }
    return out;
}

// The axis of the box that cuts the other one shortest.
const Vec3d& narrow_axis(const OrientedBox& box, const OrientedBox& other) noexcept {
    std::size_t best = 0;
    const auto steepness = [&](std::size_t k) { return std::abs(dot(box.axis[k], other.axis[0])); };
    for (std::size_t k = 1; k < 3; ++k)
        if (steepness(k) * box.half[best] > steepness(best) * box.half[k]) best = k;
    return box.axis[best];
}

} // namespace

bool tiles_stay_apart(const SearchedBody& a, std::uint32_t tile_a, const OrientedBox& box_a,
                      const SearchedBody& b, std::uint32_t tile_b, const OrientedBox& box_b,
                      double reach) noexcept {
    if (stay_apart(box_a, box_b, reach)) return true;
    const Vec3d w = normalised(cross(box_a.axis[0], box_b.axis[0]));
    if (!(dot(w, w) > 0)) return false;
    const Vec3d &of_a = narrow_axis(box_a, box_b), &of_b = narrow_axis(box_b, box_a);
    const Span part_a = span_of_part(a, tile_a, box_a, of_b, span_along(of_b, box_b, reach), w);
    const Span part_b = span_of_part(b, tile_b, box_b, of_a, span_along(of_a, box_a, reach), w);
    return part_a.hi + reach < part_b.lo || part_b.hi + reach < part_a.lo;
}

void load_slabs(const SurfaceFeatures& features, const SurfaceTile& tile, const Vec3d* points,
                FaceSlabs& out) noexcept {
    out.origin = points[0];
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [a, b, c] = features.faces[tile.first_face + f];
        const Vec3d corners[] = {points[a] - out.origin, points[b] - out.origin, points[c] - out.origin};
        const OrientedBox box = oriented_box(corners, longest_edge(corners[0], corners[1], corners[2]));
        for (std::size_t k = 0; k < 3; ++k) {
            const double w[3] = {box.axis[k].x, box.axis[k].y, box.axis[k].z},
                         at = dot(box.axis[k], box.middle);
            for (std::size_t i = 0; i < 3; ++i) out.axis[k][i][f] = static_cast<float>(w[i]);
            out.lo[k][f] = static_cast<float>(FaceSlabs::scale * (at - box.half[k]));
            out.hi[k][f] = static_cast<float>(FaceSlabs::scale * (at + box.half[k]));
        }
    }
}

void load_lines(const SurfaceFeatures& features, const SurfaceTile& tile, const Vec3d* points,
                FaceLines& out) noexcept {
    Vec3d lo = points[0], hi = lo;
    for (const Vec3d& p : std::span(points, tile.vertex_count)) lo = min(lo, p), hi = max(hi, p);
    out.origin = 0.5 * (lo + hi);
    const double size = largest_coordinate(hi - lo);
    out.scale = size > 0x1p-900 ? 1 / size : 0; // if 0, no line is beside any other
    for (std::uint32_t f = 0; f < tile.face_count; ++f)
        for (std::size_t side = 0; side < 3; ++side) {
            const std::array<std::uint8_t, 3>& corners = features.faces[tile.first_face + f];
            const Vec3d &from = points[corners[side]], &to = points[corners[side == 2 ? 0 : side + 1]];
            const Line line(out.scale * (from - out.origin), out.scale * (to - from));
            for (std::size_t c = 0; c < 6; ++c) out.at[side][c][f] = line.at[c];
            for (std::size_t c = 0; c < 2; ++c) out.size[side][c][f] = line.size[c];
        }
}

void SearchedBodies::begin(const StepScene& scene) {
    bodies_.clear();
    bodies_.reserve(scene.bodies.size());
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const fast::StepBody& of = scene.of[b];
        const BlockBoxes blocks{scene.boxes->blocks.data() + of.first_block,
                                scene.boxes->groups.data() + of.first_group};
        bodies_.push_back({of.positions, blocks, of.tiles->block_first, scene.boxes->bodies[b]});
    }
    reached_.clear();
}

void SearchedBodies::reach(std::uint32_t body, const Box& region) {
    SearchedBody& of = bodies_[body];
    if (of.first_tile == SearchedBody::not_reached) reached_.push_back(body);
    of.first_tile = 0;
    add(of.reached, region);
}

void SearchedBodies::make_boxes(const StepScene& scene, KeptFeatures& kept) {
    for (const std::uint32_t b : reached_) (void)kept.of(scene, b); // which may move those of others
    pieces_.clear();
    std::uint32_t tiles = 0;
    for (const std::uint32_t b : reached_) {
        SearchedBody& body = bodies_[b];
        body.features = &kept.of(scene, b);
        body.first_tile = tiles;
        const std::uint32_t count = body.tile_count();
        for (std::uint32_t first = 0; first < count; first += tiles_of_small_body)
            pieces_.push_back({b, first, std::min(first + tiles_of_small_body, count)});
        tiles += count;
    }
    if (tile_boxes_.size() < tiles) tile_boxes_.resize(tiles);
    constexpr std::size_t task_tiles = 128; // that are worth a task: 40 vertices each
    scene.workers->for_ranges(pieces_.size(), task_tiles / tiles_of_small_body,
                              [&](std::size_t begin, std::size_t end, std::uint32_t) {
                                  for (std::size_t i = begin; i < end; ++i) make_boxes(pieces_[i]);
                              });
    for (const std::uint32_t b : reached_) {
        Box around = empty_box;
        for (const Box& box : std::span(tile_boxes(b), bodies_[b].tile_count()))
            if (!is_empty(box)) add(around, box);
        bodies_[b].tiles_box = around;
    }
}

// Empty where the blocks of a tile, or those of its group, and so its faces, all lie to one side of where the
// body is reached.
void SearchedBodies::make_boxes(const Piece& piece) {
    const SearchedBody& body = bodies_[piece.body];
    const SurfaceFeatures& features = *body.features;
    const auto is_beyond = [&](const Box* boxes, const Array<std::uint32_t>& which, std::uint32_t first,
                               std::uint32_t count) {
        return fast::common_sides(boxes, std::span(which).subspan(first, count), body.reached) != 0;
    };
    Box* out = &tile_boxes_[body.first_tile + piece.first];
    static_assert(tiles_of_small_body % tiles_of_group == 0);
    for (std::uint32_t begin = piece.first; begin < piece.last; begin += tiles_of_group) {
        const std::uint32_t end = std::min(begin + tiles_of_group, piece.last);
        const SurfaceGroup& group = features.groups[begin / tiles_of_group];
        if (is_beyond(body.blocks.groups, features.block_groups, group.first, group.count)) {
            out = std::fill_n(out, end - begin, empty_box);
            continue;
        }
        for (std::uint32_t t = begin; t < end; ++t) {
            const SurfaceTile& tile = features.tiles[t];
            Box box = empty_box;
            if (!is_beyond(body.blocks.blocks, features.blocks, tile.first_block, tile.block_count))
                body.for_vertex_boxes(features.vertices.data() + tile.first_vertex, tile.vertex_count,
                                      [&](std::uint32_t, const Box& of_vertex) { add(box, of_vertex); });
            *out++ = box;
        }
    }
}

} // namespace vox
