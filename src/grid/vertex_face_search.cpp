// Tiles of faces in reach of the other body are joined with runs of its vertices, box by box, then the faces
// of a tile with the vertices of the runs.
#include "grid/vertex_face_search.hpp"

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "fast/broad_phase.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace vox {

namespace {

constexpr std::uint32_t near_group_size = 32; // runs whose common box is tested first

// How much work is worth a task of its own.
constexpr std::size_t near_task_tiles = 128;  // whose boxes are made: 40 vertices each
constexpr std::size_t near_task_pairs = 16;   // of small bodies
constexpr std::size_t near_task_searches = 8; // of tiles against all vertices of the other body

constexpr std::size_t near_small_body = 64; // tiles, which take no task of their own

// Positions of which nothing is known but the nearest floats are off by 2^-24 of the largest coordinate at
// most, on each axis, and so is a side of a box that has grown.
constexpr double rounding = 0x1p-21;

Box grown(const Box& box, float by) noexcept {
    Box out;
    for (int i = 0; i < 4; ++i) out.lo[i] = box.lo[i] - by;
    for (int i = 0; i < 4; ++i) out.hi[i] = box.hi[i] + by;
    return out;
}

// Half of how far apart two bodies with this box can be, as boxes of floats show it.
float growth(const Box& box, double margin) noexcept {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, double{std::abs(box.lo[i])}, double{std::abs(box.hi[i])}});
    const double by = 0.5 * margin + rounding * (largest + margin) + 0x1p-126;
    return static_cast<float>(std::min(by, 0x1p126));
}

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

// The faces in the order that their tetrahedra have them in, which those of doubled ones may not be in, and
// the facets that they are.
void order_faces(std::span<const Tet> tets, SearchedSurface& surface) {
    SurfaceFeatures& features = surface.features;
    surface.facets.resize(features.faces.size());
    for (const SurfaceTile& tile : features.tiles)
        for (std::uint32_t f = tile.first_face; f < tile.first_face + tile.face_count; ++f) {
            const std::array<std::uint8_t, 3> given = features.faces[f];
            const std::uint32_t* vertices = features.vertices.data() + tile.first_vertex;
            const Tet& tet = tets[features.tets[f]];
            const auto local = [&](std::uint32_t vertex) {
                for (const std::uint8_t i : given)
                    if (vertices[i] == vertex) return int{i};
                return -1;
            };
            for (std::uint8_t facet = 0; facet < 4; ++facet) {
                int corner[3];
                for (int c = 0; c < 3; ++c) corner[c] = local(tet.v[facet_corners[facet][c]]);
                if (corner[0] < 0 || corner[1] < 0 || corner[2] < 0) continue;
                for (std::size_t c = 0; c < 3; ++c)
                    features.faces[f][c] = static_cast<std::uint8_t>(corner[c]);
                surface.facets[f] = facet;
            }
        }
}

} // namespace

VertexFaceSearch::VertexFaceSearch(std::pmr::memory_resource* memory)
    : surfaces_(memory), packed_(memory), block_boxes_(memory), group_boxes_(memory), searched_(memory),
      body_boxes_(memory), pair_buffers_(memory), pairs_(memory), pieces_(memory), tile_boxes_(memory),
      workers_(memory) {}

void VertexFaceSearch::forget(vox_body mesh) noexcept {
    erase_if(surfaces_, [mesh](const Kept& kept) { return kept.mesh == mesh; });
}

// ---- which bodies ---------------------------------------------------------------------------------

void VertexFaceSearch::find_near(const StepScene& scene, double margin, NearFacesVisitor& visitor) {
    prepare_bodies(scene, {}, margin);
    fast::find_pairs(body_boxes_, {scene.bodies, scene.of}, pair_buffers_, pairs_);
    search(scene, visitor);
}

void VertexFaceSearch::find_meeting(const StepScene& scene, std::span<const Positions> previous,
                                    NearFacesVisitor& visitor) {
    prepare_bodies(scene, previous, 0);
    fast::find_pairs(body_boxes_, {scene.bodies, {}}, pair_buffers_, pairs_);
    erase_if(pairs_,
             [&](const fast::Pair& pair) { return !previous[pair.a].data && !previous[pair.b].data; });
    search(scene, visitor);
}

// A body that moves gets boxes of its own, around where its vertices are and were.
void VertexFaceSearch::prepare_bodies(const StepScene& scene, std::span<const Positions> previous,
                                      double margin) {
    const std::size_t bodies = scene.bodies.size();
    const auto moves = [&](std::size_t b) { return !previous.empty() && previous[b].data; };
    const auto groups_of = [](std::size_t count) {
        return (count + fast::group_blocks - 1) / fast::group_blocks;
    };
    std::size_t floats = 0, blocks = 0, groups = 0;
    for (std::size_t b = 0; b < bodies; ++b) {
        if (!moves(b)) continue;
        floats += 3 * std::size_t{scene.bodies[b].vertex_count};
        blocks += scene.of[b].tiles->block_count();
        groups += groups_of(scene.of[b].tiles->block_count());
    }
    packed_.resize(floats);
    block_boxes_.resize(blocks);
    group_boxes_.assign(groups, empty_box);
    searched_.assign(bodies, {});
    body_boxes_.assign(bodies, empty_box);
    float* packed = packed_.data();
    Box *boxes = block_boxes_.data(), *around = group_boxes_.data();
    for (std::size_t b = 0; b < bodies; ++b) {
        const fast::StepBody& of = scene.of[b];
        Searched& out = searched_[b];
        out.at = of.positions;
        out.blocks = {scene.boxes->blocks.data() + of.first_block,
                      scene.boxes->groups.data() + of.first_group};
        out.first_of_block = of.tiles->block_first;
        out.box = scene.boxes->bodies[b];
        if (moves(b)) {
            check_previous(scene.bodies[b], previous[b]);
            fast::round_positions(previous[b], scene.origin, 0, scene.bodies[b].vertex_count, packed);
            out.before = packed;
            out.blocks = {boxes, around};
            out.box = empty_box;
            for (std::uint32_t block = 0; block < out.block_count(); ++block) {
                boxes[block] = empty_box;
                for (std::uint32_t v = out.first_of_block[block]; v < out.first_of_block[block + 1]; ++v)
                    add(boxes[block], out.vertex_box(v));
                add(around[block / fast::group_blocks], boxes[block]);
                add(out.box, boxes[block]);
            }
            packed += 3 * std::size_t{scene.bodies[b].vertex_count};
            boxes += out.block_count();
            around += groups_of(out.block_count());
        }
        if (is_empty(out.box)) continue;
        if (margin > 0) out.grow = growth(out.box, margin);
        body_boxes_[b] = grown(out.box, out.grow);
    }
}

// ---- which tiles ----------------------------------------------------------------------------------

const SearchedSurface& VertexFaceSearch::surface_of(const StepScene& scene, std::uint32_t body) {
    const vox_body mesh = scene.bodies[body].mesh_id;
    auto place = std::lower_bound(surfaces_.begin(), surfaces_.end(), mesh,
                                  [](const Kept& kept, vox_body id) { return kept.mesh < id; });
    if (place == surfaces_.end() || place->mesh != mesh || place->version != scene.versions[body]) {
        Kept made{mesh, scene.versions[body], SearchedSurface(memory())};
        make_surface_features(*scene.topologies[body], scene.bodies[body].positions, *scene.of[body].tiles,
                              made.surface.features);
        order_faces(scene.bodies[body].tets, made.surface);
        if (place == surfaces_.end() || place->mesh != mesh)
            place = surfaces_.insert(place, std::move(made));
        else
            *place = std::move(made);
    }
    return place->surface;
}

void VertexFaceSearch::search(const StepScene& scene, NearFacesVisitor& visitor) {
    workers_.grow(scene.workers->count());
    erase_if(pairs_, [&](const fast::Pair& pair) { return scene.topologies[pair.b]->triangles.empty(); });
    prepare_surfaces(scene);
    make_tile_boxes(scene);
    const auto is_large = [&](const fast::Pair& pair) {
        return searched_[pair.b].surface->features.tiles.size() >= near_small_body;
    };
    scene.workers->for_ranges(pairs_.size(), near_task_pairs,
                              [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                                  for (std::size_t i = begin; i < end; ++i) {
                                      Worker& lists = workers_[w];
                                      if (!is_large(pairs_[i]) && list(pairs_[i], visitor, lists))
                                          search_tiles(pairs_[i], lists, 0, lists.tiles.size(), visitor, w);
                                  }
                              });
    for (const fast::Pair& pair : pairs_) {
        Worker& lists = workers_[0];
        if (!is_large(pair) || !list(pair, visitor, lists)) continue;
        // Each piece finds its own closest faces, so their number decides how many are found. It must not
        // depend on how the pieces are shared.
        const std::size_t tiles = lists.tiles.size(), workers = scene.workers->count();
        const std::size_t pieces =
            workers == 1 ? 1 : std::min((tiles - 1) / near_task_searches + 1, 4 * workers);
        scene.workers->for_ranges(pieces, 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            for (std::size_t i = begin; i < end; ++i)
                search_tiles(pair, lists, i * tiles / pieces, (i + 1) * tiles / pieces, visitor, w);
        });
    }
    workers_.level();
}

// The surfaces of the bodies that are reached, and room for the boxes of their tiles.
void VertexFaceSearch::prepare_surfaces(const StepScene& scene) {
    for (const fast::Pair& pair : pairs_) {
        (void)surface_of(scene, pair.b); // which may move those of others
        Box reached = grown(searched_[pair.a].box, searched_[pair.a].grow + searched_[pair.b].grow);
        intersect(reached, searched_[pair.b].box);
        add(searched_[pair.b].reached, reached);
    }
    pieces_.clear();
    std::size_t tiles = 0;
    for (const fast::Pair& pair : pairs_) {
        Searched& body = searched_[pair.b];
        if (body.surface) continue;
        body.surface = &surface_of(scene, pair.b);
        body.first_tile = static_cast<std::uint32_t>(tiles);
        const auto count = static_cast<std::uint32_t>(body.surface->features.tiles.size());
        for (std::uint32_t first = 0; first < count; first += near_small_body)
            pieces_.push_back({pair.b, first, std::min<std::uint32_t>(first + near_small_body, count)});
        tiles += count;
    }
    if (tile_boxes_.size() < tiles) tile_boxes_.resize(tiles);
}

// Of tiles that others may reach; the others get an empty box.
void VertexFaceSearch::make_tile_boxes(const StepScene& scene) {
    constexpr std::size_t least = near_task_tiles / near_small_body;
    scene.workers->for_ranges(pieces_.size(), least, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const TilePiece& piece = pieces_[i];
            const Searched& body = searched_[piece.body];
            const SurfaceFeatures& features = body.surface->features;
            const auto box_of = [&](const SurfaceTile& tile) {
                Box box = empty_box;
                for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
                    add(box, body.vertex_box(features.vertices[tile.first_vertex + v]));
                return box;
            };
            make_boxes_in(body.reached, features, body.blocks, piece.first, piece.last,
                          &tile_boxes_[body.first_tile + piece.first], box_of);
        }
    });
}

// ---- which vertices and faces ---------------------------------------------------------------------

// Tiles of b and vertices of a that are in reach of each other's bodies.
bool VertexFaceSearch::list(const fast::Pair& pair, const NearFacesVisitor& visitor, Worker& worker) const {
    const Searched &a = searched_[pair.a], &b = searched_[pair.b];
    const float reach = a.grow + b.grow;
    // Calls find(first, count) for some of many boxes at a time, and lists those of which it gives the bits.
    const auto list_met = [](std::uint32_t count, auto& out, const auto& find) {
        out.clear();
        for (std::uint32_t first = 0; first < count; first += fast::most_boxes)
            for (std::uint64_t met = find(first, std::min(fast::most_boxes, count - first)); met;
                 met &= met - 1) {
                reserve_growing(out, out.size() + 1);
                out.push_back(first + static_cast<std::uint32_t>(std::countr_zero(met)));
            }
    };
    // The tiles first, as there are less of them.
    const Box around_a = grown(a.box, reach);
    const Box* tile_boxes = &tile_boxes_[b.first_tile];
    list_met(static_cast<std::uint32_t>(b.surface->features.tiles.size()), worker.tiles,
             [&](std::uint32_t first, std::uint32_t some) {
                 return fast::find_overlaps(tile_boxes + first, some, around_a);
             });
    if (worker.tiles.empty()) return false;
    Box around_tiles = empty_box;
    for (const std::uint32_t tile : worker.tiles) add(around_tiles, tile_boxes[tile]);
    const Box region = grown(around_tiles, reach);
    list_met(a.block_count(), worker.blocks, [&](std::uint32_t first, std::uint32_t some) {
        return fast::find_blocks(a.blocks.blocks + first, a.blocks.groups + first / fast::group_blocks, some,
                                 region);
    });
    worker.vertices.clear();
    for (const std::uint32_t block : worker.blocks) {
        const std::uint32_t begin = a.first_of_block[block], end = a.first_of_block[block + 1];
        reserve_growing(worker.vertices, worker.vertices.size() + (end - begin));
        for (std::uint32_t v = begin; v < end; ++v)
            if (overlap(a.vertex_box(v), region)) worker.vertices.push_back(v);
    }
    visitor.leave_out(pair.a, pair.b, worker.vertices);
    if (worker.vertices.empty()) return false;
    make_runs(a, worker);
    Box around_vertices = empty_box;
    for (const Box& group : worker.groups) add(around_vertices, group);
    const Box reached = grown(around_vertices, reach);
    erase_if(worker.tiles, [&](std::uint32_t t) { return !overlap(tile_boxes[t], reached); });
    return !worker.tiles.empty();
}

// From the blocks and the vertices that are left of them.
void VertexFaceSearch::make_runs(const Searched& body, Worker& worker) const {
    worker.first_of_run.clear();
    worker.runs.clear();
    worker.groups.clear();
    const Array<std::uint32_t>& vertices = worker.vertices;
    auto block = worker.blocks.begin();
    for (std::uint32_t i = 0; i < vertices.size();) {
        while (body.first_of_block[*block + 1] <= vertices[i]) ++block;
        reserve_growing(worker.first_of_run, worker.first_of_run.size() + 2);
        worker.first_of_run.push_back(i);
        Box run = empty_box;
        for (const std::uint32_t end = body.first_of_block[*block + 1];
             i < vertices.size() && vertices[i] < end; ++i)
            add(run, body.vertex_box(vertices[i]));
        if (worker.runs.size() % near_group_size == 0) {
            reserve_growing(worker.groups, worker.groups.size() + 1);
            worker.groups.push_back(empty_box);
        }
        add(worker.groups.back(), run);
        reserve_growing(worker.runs, worker.runs.size() + 1);
        worker.runs.push_back(run);
    }
    worker.first_of_run.push_back(static_cast<std::uint32_t>(worker.vertices.size()));
}

void VertexFaceSearch::load(const Searched& body, const SurfaceTile& tile, float reach,
                            FaceBoxes& out) const {
    const SurfaceFeatures& features = body.surface->features;
    std::array<Box, SurfaceTile::most_vertices> points;
    for (std::uint32_t p = 0; p < tile.vertex_count; ++p)
        points[p] = body.vertex_box(features.vertices[tile.first_vertex + p]);
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [u, v, w] = features.faces[tile.first_face + f];
        Box box = points[u];
        add(box, points[v]);
        add(box, points[w]);
        out.set(f, grown(box, reach));
    }
}

// The tiles [begin, end) of the list against all of its vertices.
void VertexFaceSearch::search_tiles(const fast::Pair& pair, const Worker& lists, std::size_t begin,
                                    std::size_t end, NearFacesVisitor& visitor, std::uint32_t worker) const {
    constexpr std::uint32_t at_once = 64;
    const Searched &a = searched_[pair.a], &b = searched_[pair.b];
    const SurfaceFeatures& features = b.surface->features;
    const float reach = a.grow + b.grow;
    FaceBoxes faces;
    // Vertices in the box of a tile, by their places.
    std::array<std::uint32_t, at_once> places, met_faces;
    std::array<Box, at_once> boxes;
    std::array<NearFaces, at_once> near;
    visitor.begin({pair.a, pair.b, lists.vertices, b.surface}, worker);
    for (std::size_t i = begin; i < end; ++i) {
        const SurfaceTile& tile = features.tiles[lists.tiles[i]];
        const Box box = grown(tile_boxes_[b.first_tile + lists.tiles[i]], reach);
        bool is_loaded = false;
        std::uint32_t count = 0;
        const auto compare = [&] {
            if (!is_loaded) load(b, tile, reach, faces);
            is_loaded = true;
            find_faces(boxes.data(), count, faces, tile.face_count, met_faces.data());
            std::size_t found = 0;
            for (std::uint32_t k = 0; k < count; ++k) {
                near[found] = {places[k], met_faces[k]};
                found += met_faces[k] != 0;
            }
            if (found > 0) visitor.visit(tile, std::span(near).first(found), worker);
            count = 0;
        };
        for (std::size_t group = 0; group < lists.groups.size(); ++group) {
            if (!overlap(lists.groups[group], box)) continue;
            const std::size_t first = group * near_group_size;
            const auto some =
                static_cast<std::uint32_t>(std::min<std::size_t>(near_group_size, lists.runs.size() - first));
            std::uint64_t met = fast::find_overlaps(&lists.runs[first], some, box);
            for (; met; met &= met - 1) {
                const std::size_t run = first + static_cast<std::size_t>(std::countr_zero(met));
                for (std::uint32_t k = lists.first_of_run[run]; k < lists.first_of_run[run + 1]; ++k) {
                    places[count] = k;
                    boxes[count] = a.vertex_box(lists.vertices[k]);
                    count += overlap(boxes[count], box);
                    if (count == at_once) compare();
                }
            }
        }
        if (count > 0) compare();
    }
    visitor.end(worker);
}

} // namespace vox
