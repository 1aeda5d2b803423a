// Tiles of faces in reach of the other body are joined with runs of its vertices, box by box, then the faces
// of a tile with the vertices of the runs.
#include "grid/vertex_face_search.hpp"

#include "base/error.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "fast/broad_phase.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"
#include "mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vox {

namespace {

void check_previous(const Body& body, const Positions& previous) {
    Body moving = body;
    moving.positions = previous;
    const std::uint32_t vertex = first_bad_vertex(moving);
    if (vertex == VOX_NONE) return;
    const vox_result result = bad_position(moving, vertex);
    throw MeshError(result, body,
                    format(", vertex %u: a coordinate of the previous position is %s", vertex,
                           result == VOX_ERROR_LIMIT ? "too large" : "not finite"),
                    vertex);
}

Vec3d middle_of(const Box& box) noexcept {
    return 0.5 * (Vec3d{box.lo[0], box.lo[1], box.lo[2]} + Vec3d{box.hi[0], box.hi[1], box.hi[2]});
}

// A tile of faces of b, where a and b stand still. If it is crowded, it gets a box along its length, and then
// boxes along its faces.
class CrowdedTile {
public:
    CrowdedTile(const SearchedBody& a, const SearchedBody& b) noexcept
        : body_(b), reach_(a.grow + b.grow),
          lanes_reach_(reach_ + 16 * (growth(a.box, 0) + growth(b.box, 0))) {}

    void begin(std::uint32_t tile) noexcept {
        tile_ = tile;
        has_box_ = has_slabs_ = false;
    }
    bool is_apart(const Box& other) const noexcept {
        return has_box_ && apart_along_axes(around_, oriented_box(other), double{reach_});
    }
    // Removes from `met` the faces that are certainly apart from their vertex.
    void thin_out(std::span<const Box> vertices, std::uint32_t* met) noexcept {
        const auto is_crowd = [&] { return count_pairs({met, vertices.size()}) > crowd / 4; };
        if (!is_crowd()) return;
        if (!has_box_) {
            around_ = oriented_box(body_, tile_);
            has_box_ = true;
            for (std::size_t k = 0; k < vertices.size(); ++k)
                if (is_apart(vertices[k])) met[k] = 0;
            if (!is_crowd()) return;
        }
        if (!has_slabs_) {
            std::array<Vec3d, SurfaceTile::most_vertices> corners;
            load_still(body_, body_.features->tiles[tile_], corners.data());
            load_slabs(*body_.features, body_.features->tiles[tile_], corners.data(), slabs_);
        }
        has_slabs_ = true;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const float* const p = vertices[k].lo;
            const Segment point{{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
            keep_near(&point, 1, slabs_, lanes_reach_, &met[k]);
        }
    }

private:
    const SearchedBody& body_;
    float reach_, lanes_reach_;
    std::uint32_t tile_ = 0;
    bool has_box_ = false, has_slabs_ = false;
    OrientedBox around_{};
    FaceSlabs slabs_{};
};

} // namespace

VertexFaceSearch::VertexFaceSearch(std::pmr::memory_resource* memory)
    : packed_(memory), block_boxes_(memory), group_boxes_(memory), bodies_(memory), body_boxes_(memory),
      pair_buffers_(memory), pairs_(memory), lists_(memory) {}

// ---- which bodies ---------------------------------------------------------------------------------

void VertexFaceSearch::find_near(const StepScene& scene, double margin, KeptFeatures& kept) {
    bodies_.begin(scene);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (!is_empty(bodies_[b].box)) bodies_[b].grow = growth(bodies_[b].box, margin);
    find_pairs(scene, {scene.bodies, scene.of});
    search(scene, kept);
}

void VertexFaceSearch::find_meeting(const StepScene& scene, std::span<const Positions> previous,
                                    KeptFeatures& kept) {
    bodies_.begin(scene);
    move_bodies(scene, previous);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (!is_empty(bodies_[b].box)) bodies_[b].grow = growth(bodies_[b].box, 0);
    find_pairs(scene, {scene.bodies, {}});
    erase_if(pairs_, [&](const fast::Pair& pair) {
        const SearchedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
        return !moves(pair) || stay_apart(a.moving_box, b.moving_box, a.grow + b.grow);
    });
    search(scene, kept);
}

// Bodies with previous positions get boxes of their own, around where their vertices are and were.
void VertexFaceSearch::move_bodies(const StepScene& scene, std::span<const Positions> previous) {
    const auto groups_of = [](std::size_t blocks) {
        return (blocks + fast::group_blocks - 1) / fast::group_blocks;
    };
    std::size_t floats = 0, blocks = 0, groups = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].moving_box = {bodies_[b].box, bodies_[b].box};
        if (!previous[b].data) continue;
        floats += 3 * std::size_t{scene.bodies[b].vertex_count};
        blocks += bodies_[b].block_count();
        groups += groups_of(bodies_[b].block_count());
    }
    packed_.resize(floats);
    block_boxes_.assign(blocks, empty_box);
    group_boxes_.assign(groups, empty_box);
    float* packed = packed_.data();
    Box *boxes = block_boxes_.data(), *around = group_boxes_.data();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (!previous[b].data) continue;
        const Body& body = scene.bodies[b];
        check_previous(body, previous[b]);
        fast::round_positions(previous[b], scene.origin, 0, body.vertex_count, packed);
        SearchedBody& out = bodies_[b];
        out.before = packed;
        out.blocks = {boxes, around};
        out.box = empty_box;
        out.moving_box = empty_moving_box;
        for (std::uint32_t block = 0; block < out.block_count(); ++block) {
            for (std::uint32_t v = out.first_of_block[block]; v < out.first_of_block[block + 1]; ++v) {
                add(boxes[block], out.vertex_box(v));
                add(out.moving_box, out.moving_vertex(v));
            }
            add(around[block / fast::group_blocks], boxes[block]);
            add(out.box, boxes[block]);
        }
        packed += 3 * std::size_t{body.vertex_count};
        boxes += out.block_count();
        around += groups_of(out.block_count());
    }
}

void VertexFaceSearch::find_pairs(const StepScene& scene, const fast::PairRules& rules) {
    body_boxes_.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        body_boxes_.push_back(is_empty(bodies_[b].box) ? empty_box : grown(bodies_[b].box, bodies_[b].grow));
    fast::find_pairs(body_boxes_, rules, pair_buffers_, pairs_);
    erase_if(pairs_, [&](const fast::Pair& pair) { return scene.topologies[pair.b]->triangles.empty(); });
}

void VertexFaceSearch::search(const StepScene& scene, KeptFeatures& kept) {
    for (const fast::Pair& pair : pairs_) {
        Box reached = grown(bodies_[pair.a].box, bodies_[pair.a].grow + bodies_[pair.b].grow);
        intersect(reached, bodies_[pair.b].box);
        bodies_.reach(pair.b, reached);
    }
    bodies_.make_boxes(scene, kept);
    lists_.grow(scene.workers->count());
    join_pairs(
        std::span<const fast::Pair>(pairs_), lists_, *scene.workers,
        [&](const fast::Pair& pair) { return bodies_[pair.b].tile_count(); },
        [&](const fast::Pair& pair, Lists& lists) { return list(pair, lists); },
        [&](const fast::Pair& pair, const Lists& lists, std::size_t first, std::size_t last,
            std::uint32_t w) { search_tiles(pair, lists, first, last, w); });
    lists_.level();
}

// ---- which vertices and faces ---------------------------------------------------------------------

// Tiles of b and vertices of a that are in reach of each other's bodies.
std::size_t VertexFaceSearch::list(const fast::Pair& pair, Lists& lists) const {
    const SearchedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
    const float reach = a.grow + b.grow;
    const Box* const tile_boxes = bodies_.tile_boxes(pair.b);
    // The tiles first, as there are less of them.
    list_overlaps(tile_boxes, b.tile_count(), grown(a.box, reach), lists.tiles);
    if (lists.tiles.empty()) return 0;
    Box around_tiles = empty_box;
    for (const std::uint32_t tile : lists.tiles) add(around_tiles, tile_boxes[tile]);
    const Box region = grown(around_tiles, reach);
    list_found(a.block_count(), lists.blocks, [&](std::uint32_t first, std::uint32_t some) {
        return fast::find_blocks(a.blocks.blocks + first, a.blocks.groups + first / fast::group_blocks, some,
                                 region);
    });
    lists.vertices.clear();
    for (const std::uint32_t block : lists.blocks) {
        const std::uint32_t begin = a.first_of_block[block], end = a.first_of_block[block + 1];
        reserve_growing(lists.vertices, lists.vertices.size() + (end - begin));
        for (std::uint32_t v = begin; v < end; ++v)
            if (overlap(a.vertex_box(v), region)) lists.vertices.push_back(v);
    }
    leave_out(pair.a, pair.b, lists.vertices);
    if (lists.vertices.empty()) return 0;
    make_runs(a, moves(pair), lists);
    Box around_vertices = empty_box;
    for (const Box& group : lists.runs.groups) add(around_vertices, group);
    const Box reached = grown(around_vertices, reach);
    erase_if(lists.tiles, [&](std::uint32_t t) { return !overlap(tile_boxes[t], reached); });
    if (moves(pair)) sort_by_motion(pair, lists.tiles);
    return lists.tiles.size();
}

// Tiles in front, as b moves relative to a, come first: what a vertex meets there leaves out most of the
// others.
void VertexFaceSearch::sort_by_motion(const fast::Pair& pair, Array<std::uint32_t>& tiles) const {
    const auto way_of = [](const MovingBox& box) { return middle_of(box.to) - middle_of(box.from); };
    const Vec3d way = way_of(bodies_[pair.b].moving_box) - way_of(bodies_[pair.a].moving_box);
    const Box* const boxes = bodies_.tile_boxes(pair.b);
    const auto place = [&](std::uint32_t tile) { return std::pair(-dot(way, middle_of(boxes[tile])), tile); };
    std::sort(tiles.begin(), tiles.end(),
              [&](std::uint32_t s, std::uint32_t t) { return place(s) < place(t); });
}

// From the blocks and the vertices that are left of them.
void VertexFaceSearch::make_runs(const SearchedBody& body, bool moves, Lists& lists) const {
    lists.first_of_run.clear();
    lists.runs.clear();
    lists.moving_runs.clear();
    lists.moving_groups.clear();
    const Array<std::uint32_t>& vertices = lists.vertices;
    auto block = lists.blocks.begin();
    for (std::uint32_t i = 0; i < vertices.size();) {
        while (body.first_of_block[*block + 1] <= vertices[i]) ++block;
        const std::uint32_t end = body.first_of_block[*block + 1];
        reserve_growing(lists.first_of_run, lists.first_of_run.size() + 2);
        lists.first_of_run.push_back(i);
        Box run = empty_box;
        const std::uint32_t first = i;
        for (; i < vertices.size() && vertices[i] < end; ++i) add(run, body.vertex_box(vertices[i]));
        lists.runs.push_back(run);
        if (!moves) continue;
        MovingBox moving = empty_moving_box;
        for (std::uint32_t k = first; k < i; ++k) add(moving, body.moving_vertex(vertices[k]));
        reserve_growing(lists.moving_runs, lists.moving_runs.size() + 1);
        lists.moving_runs.push_back(moving);
        if (lists.moving_groups.size() < lists.runs.groups.size()) {
            reserve_growing(lists.moving_groups, lists.runs.groups.size());
            lists.moving_groups.push_back(empty_moving_box);
        }
        add(lists.moving_groups.back(), moving);
    }
    lists.first_of_run.push_back(static_cast<std::uint32_t>(vertices.size()));
}

// The tiles [first, last) of the list against all of its vertices.
void VertexFaceSearch::search_tiles(const fast::Pair& pair, const Lists& lists, std::size_t first,
                                    std::size_t last, std::uint32_t worker) {
    constexpr std::uint32_t at_once = NearFaces::at_once;
    const SearchedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
    const float reach = a.grow + b.grow;
    const bool is_moving = moves(pair);
    FaceBoxes faces;
    CrowdedTile crowded(a, b);
    // Vertices in the box of a tile, by their places.
    std::array<std::uint32_t, at_once> places, met_faces;
    std::array<Box, at_once> boxes;
    std::array<NearFaces, at_once> near;
    begin({pair.a, pair.b, lists.vertices, b.features}, worker);
    for (std::size_t i = first; i < last; ++i) {
        const SurfaceTile& tile = b.features->tiles[lists.tiles[i]];
        const Box box = grown(bodies_.tile_boxes(pair.b)[lists.tiles[i]], reach);
        MovingBox moving = empty_moving_box;
        if (is_moving)
            for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
                add(moving, b.moving_vertex(b.features->vertices[tile.first_vertex + v]));
        const auto may_meet = [&](const MovingBox& other, double until = 1) {
            return !stay_apart(other, moving, reach, until);
        };
        bool is_loaded = false;
        crowded.begin(lists.tiles[i]);
        std::uint32_t count = 0;
        const auto compare = [&] {
            if (!is_loaded) {
                TilePoints points;
                load_points(b, tile, points);
                load_faces(*b.features, tile, points, reach, faces);
            }
            is_loaded = true;
            find_faces(boxes.data(), count, faces, tile.face_count, met_faces.data());
            if (!is_moving) crowded.thin_out(std::span(boxes).first(count), met_faces.data());
            std::size_t found = 0;
            for (std::uint32_t k = 0; k < count; ++k) {
                near[found] = {places[k], met_faces[k]};
                found += met_faces[k] != 0;
            }
            if (found > 0) visit(tile, std::span(near).first(found), worker);
            count = 0;
        };
        const auto enter = [&](std::size_t group) {
            return !crowded.is_apart(lists.runs.groups[group]) &&
                   (!is_moving || may_meet(lists.moving_groups[group]));
        };
        lists.runs.for_overlaps(box, enter, [&](std::size_t run) {
            if (crowded.is_apart(lists.runs.boxes[run]) || (is_moving && !may_meet(lists.moving_runs[run])))
                return;
            for (std::uint32_t k = lists.first_of_run[run]; k < lists.first_of_run[run + 1]; ++k) {
                places[count] = k;
                boxes[count] = a.vertex_box(lists.vertices[k]);
                count += overlap(boxes[count], box) && !crowded.is_apart(boxes[count]) &&
                         (!is_moving || may_meet(a.moving_vertex(lists.vertices[k]), latest(k, worker)));
                if (count == at_once) compare();
            }
        });
        if (count > 0) compare();
    }
    end(worker);
}

} // namespace vox
