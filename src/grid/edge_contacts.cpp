// Two bodies whose boxes overlap: tiles of each in the box of the other are joined, box by box, then the
// edges of one tile with the faces of the other, and what is left is decided exactly. Of a body with itself,
// what winding numbers have certified is left out (fast/winding/certificate.cpp).
#include "grid/edge_contacts.hpp"

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/crossing.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace vox {

namespace {

constexpr std::uint32_t group_size = 32; // tiles whose common box is tested first

// How much work is worth a task of its own.
constexpr std::size_t task_tiles = 128;  // whose boxes are made: 40 vertices each
constexpr std::size_t task_pairs = 16;   // of small bodies
constexpr std::size_t task_searches = 8; // of tiles against all of the other body

// The tiles of a small body take no task.
constexpr std::size_t small_body = 64;

// A vertex of packed positions.
Box box_at(const float* positions, std::uint32_t vertex) {
    const float* p = positions + 3 * std::size_t{vertex};
    return {{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
}

// Where a body certainly has no edge contact with itself; null for a pair of two, and where nothing is known.
const fast::CertifiedCells* certified_for(const StepScene& scene, const fast::Pair& pair) {
    return pair.a == pair.b ? scene.certified(pair.a) : nullptr;
}

} // namespace

EdgeContacts::EdgeContacts(std::pmr::memory_resource* memory)
    : surfaces_(memory), pairs_of_bodies_(memory), step_surfaces_(memory), pieces_(memory),
      tile_boxes_(memory), workers_(memory), found_(memory), keys_(memory), contacts_(memory), pairs_(memory),
      depths_(memory) {}

void EdgeContacts::clear() noexcept {
    contacts_.clear();
    pairs_.clear();
    unchanged_ = false;
}

void EdgeContacts::forget(vox_body mesh) noexcept {
    erase_if(surfaces_, [mesh](const Surface& surface) { return surface.mesh == mesh; });
}

void EdgeContacts::find(const StepScene& scene, Counters& counters) {
    workers_.grow(scene.workers->count());
    for (Worker& worker : workers_) {
        worker.candidates = worker.exact_tests = 0;
        worker.loaded.resize(Worker::most_loaded + 1);
        for (LoadedTile& tile : worker.loaded) tile.body = ~0u; // that of another step
    }
    found_.clear();
    scene.carry(std::span<const EdgeContact>(contacts_), [&](const EdgeContact& contact) {
        reserve_sparingly(found_, found_.size() + 1);
        found_.push_back(contact);
    });
    const std::size_t carried = found_.size();
    list_pairs(scene);
    prepare_surfaces(scene);
    make_tile_boxes(scene);
    search_pairs(scene);
    workers_.level();

    unchanged_ = found_.size() == carried && carried == contacts_.size();
    if (!unchanged_) {
        put_in_order();
        vox::list_pairs(std::span<const EdgeContact>(contacts_), pairs_);
    }
    counters.edge_contacts = contacts_.size();
    counters.carried_edge_contacts = carried;
    for (const Worker& worker : workers_) {
        counters.edge_candidates += worker.candidates;
        counters.exact_tests += worker.exact_tests;
    }
}

// ---- which bodies ---------------------------------------------------------------------------------

// Pairs of bodies with surfaces whose boxes overlap, that the filters let collide, and of which one moved.
void EdgeContacts::list_pairs(const StepScene& scene) {
    const auto has_surface = [&](std::uint32_t body) { return !scene.topologies[body]->triangles.empty(); };
    pairs_of_bodies_.clear();
    for (const fast::Pair& pair : scene.pairs)
        if (pair.a < pair.b && has_surface(pair.a) && has_surface(pair.b)) pairs_of_bodies_.push_back(pair);
    for (std::uint32_t b = 0; b < scene.bodies.size(); ++b) {
        if (!scene.bodies[b].self_collision || !has_surface(b) || !scene.of[b].moved) continue;
        const fast::CertifiedCells* const certified = scene.certified(b);
        if (!certified || !certified->complete) pairs_of_bodies_.push_back({b, b});
    }
}

const SurfaceFeatures& EdgeContacts::surface_of(const StepScene& scene, std::uint32_t body) {
    const vox_body mesh = scene.bodies[body].mesh_id;
    auto place = std::lower_bound(surfaces_.begin(), surfaces_.end(), mesh,
                                  [](const Surface& surface, vox_body id) { return surface.mesh < id; });
    if (place == surfaces_.end() || place->mesh != mesh || place->version != scene.versions[body]) {
        Surface made(mesh, scene.versions[body], memory());
        make_surface_features(*scene.topologies[body], scene.bodies[body].positions, *scene.of[body].tiles,
                              made.features);
        if (place == surfaces_.end() || place->mesh != mesh)
            place = surfaces_.insert(place, std::move(made));
        else
            *place = std::move(made);
    }
    return place->features;
}

// What is known of bodies in pairs, room for the boxes of their tiles, and the pieces of work to make them.
void EdgeContacts::prepare_surfaces(const StepScene& scene) {
    step_surfaces_.assign(scene.bodies.size(), {nullptr, 0, {}, nullptr, empty_box, empty_box});
    for (const fast::Pair& pair : pairs_of_bodies_) {
        Box common = scene.boxes->bodies[pair.a];
        intersect(common, scene.boxes->bodies[pair.b]);
        for (const std::uint32_t body : {pair.a, pair.b}) {
            (void)surface_of(scene, body); // which may move those of others
            add(step_surfaces_[body].reached, common);
        }
    }
    pieces_.clear();
    std::size_t tiles = 0;
    for (const fast::Pair& pair : pairs_of_bodies_)
        for (const std::uint32_t body : {pair.a, pair.b}) {
            StepSurface& surface = step_surfaces_[body];
            if (surface.features) continue;
            surface.features = &surface_of(scene, body);
            surface.first_tile = static_cast<std::uint32_t>(tiles);
            const auto count = static_cast<std::uint32_t>(surface.features->tiles.size());
            for (std::uint32_t first = 0; first < count; first += small_body)
                pieces_.push_back({body, first, std::min<std::uint32_t>(first + small_body, count)});
            tiles += count;
            const fast::StepBody& of = scene.of[body];
            surface.positions = of.positions;
            surface.blocks = {scene.boxes->blocks.data() + of.first_block,
                              scene.boxes->groups.data() + of.first_group};
        }
    if (tile_boxes_.size() < tiles) tile_boxes_.resize(tiles);
}

void EdgeContacts::make_tile_boxes(const StepScene& scene) {
    scene.workers->for_ranges(
        pieces_.size(), task_tiles / small_body, [&](std::size_t begin, std::size_t end, std::uint32_t) {
            for (std::size_t i = begin; i < end; ++i) {
                const TilePiece& piece = pieces_[i];
                const StepSurface& surface = step_surfaces_[piece.body];
                const auto box_of = [&](const SurfaceTile& tile) {
                    Box box = empty_box;
                    const std::uint32_t* vertices = surface.features->vertices.data() + tile.first_vertex;
                    for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
                        add(box, box_at(surface.positions, vertices[v]));
                    return box;
                };
                make_boxes_in(surface.reached, *surface.features, surface.blocks, piece.first, piece.last,
                              &tile_boxes_[surface.first_tile + piece.first], box_of);
            }
        });
    for (const TilePiece& piece : pieces_) {
        StepSurface& surface = step_surfaces_[piece.body];
        for (std::uint32_t t = piece.first; t < piece.last; ++t)
            if (const Box& box = tile_boxes_[surface.first_tile + t]; box.lo[0] <= box.hi[0])
                add(surface.box, box);
    }
}

// ---- which edges and faces ------------------------------------------------------------------------

// Workers share pairs of small bodies, and then the tiles of each pair of large ones.
void EdgeContacts::search_pairs(const StepScene& scene) {
    const auto is_large = [&](const fast::Pair& pair) {
        return step_surfaces_[pair.a].features->tiles.size() >= small_body;
    };
    scene.workers->for_ranges(
        pairs_of_bodies_.size(), task_pairs, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            for (std::size_t i = begin; i < end; ++i) {
                const fast::Pair& pair = pairs_of_bodies_[i];
                if (!is_large(pair) && list_tiles(scene, pair, workers_[w]))
                    search(scene, pair, workers_[w], 0, workers_[w].tiles_a.size(), workers_[w]);
            }
        });
    for (const fast::Pair& pair : pairs_of_bodies_) {
        const Worker& tiles = workers_[0];
        if (!is_large(pair) || !list_tiles(scene, pair, workers_[0])) continue;
        scene.workers->for_ranges(tiles.tiles_a.size(), task_searches,
                                  [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                                      search(scene, pair, tiles, begin, end, workers_[w]);
                                  });
    }
}

// The tiles of the two that meet where the boxes of the two overlap. Of a body with itself, those that are
// not certified.
bool EdgeContacts::list_tiles(const StepScene& scene, const fast::Pair& pair, Worker& worker) const {
    const StepSurface &a = step_surfaces_[pair.a], &b = step_surfaces_[pair.b];
    Box region = a.box;
    intersect(region, b.box);
    const auto list = [&](const StepSurface& surface, Array<std::uint32_t>& tiles) {
        tiles.clear();
        const auto count = static_cast<std::uint32_t>(surface.features->tiles.size());
        for (std::uint32_t first = 0; first < count; first += fast::most_boxes) {
            std::uint64_t met = fast::find_overlaps(&tile_boxes_[surface.first_tile + first],
                                                    std::min(fast::most_boxes, count - first), region);
            for (; met; met &= met - 1)
                tiles.push_back(first + static_cast<std::uint32_t>(std::countr_zero(met)));
        }
        if (const fast::CertifiedCells* certified = certified_for(scene, pair))
            erase_if(tiles, [&](std::uint32_t tile) {
                return certified->holds(tile_boxes_[surface.first_tile + tile]);
            });
        return !tiles.empty();
    };
    if (is_empty(region) || !list(a, worker.tiles_a) || !list(b, worker.tiles_b)) return false;
    worker.boxes_b.clear();
    worker.groups_b.clear();
    for (std::size_t i = 0; i < worker.tiles_b.size(); ++i) {
        const Box& box = tile_boxes_[b.first_tile + worker.tiles_b[i]];
        if (i % group_size == 0) worker.groups_b.push_back(empty_box);
        add(worker.groups_b.back(), box);
        worker.boxes_b.push_back(box);
    }
    return true;
}

// The tiles [begin, end) of tiles.tiles_a against all of tiles.tiles_b, edges of either with faces of the
// other. Of a body with itself, each two tiles once.
void EdgeContacts::search(const StepScene& scene, const fast::Pair& pair, const Worker& tiles,
                          std::size_t begin, std::size_t end, Worker& worker) {
    const fast::CertifiedCells* const certified = certified_for(scene, pair);
    LoadedTile& a = worker.loaded[Worker::most_loaded];
    for (std::size_t i = begin; i < end; ++i) {
        const Box& box = tile_boxes_[step_surfaces_[pair.a].first_tile + tiles.tiles_a[i]];
        bool is_loaded = false;
        for (std::size_t group = 0; group < tiles.groups_b.size(); ++group) {
            if (!overlap(tiles.groups_b[group], box)) continue;
            const std::size_t first = group * group_size;
            const auto count =
                static_cast<std::uint32_t>(std::min<std::size_t>(group_size, tiles.tiles_b.size() - first));
            std::uint64_t met = fast::find_overlaps(&tiles.boxes_b[first], count, box);
            for (; met; met &= met - 1) {
                const std::size_t j = first + static_cast<std::size_t>(std::countr_zero(met));
                if (pair.a == pair.b && j < i) continue; // the lists are the same
                if (certified) {
                    Box common = box;
                    intersect(common, tiles.boxes_b[j]);
                    if (certified->holds(common)) continue;
                }
                if (!is_loaded) load(pair.a, tiles.tiles_a[i], a);
                is_loaded = true;
                if (pair.a == pair.b && j == i) {
                    test(scene, a, a, worker);
                    continue;
                }
                LoadedTile& b = worker.loaded[(pair.b + tiles.tiles_b[j]) % Worker::most_loaded];
                if (b.body != pair.b || b.index != tiles.tiles_b[j]) load(pair.b, tiles.tiles_b[j], b);
                test(scene, a, b, worker);
                test(scene, b, a, worker);
            }
        }
    }
}

void EdgeContacts::load(std::uint32_t body, std::uint32_t index, LoadedTile& out) const {
    const StepSurface& surface = step_surfaces_[body];
    const SurfaceFeatures& features = *surface.features;
    const SurfaceTile& tile = features.tiles[index];
    std::array<Box, SurfaceTile::most_vertices> points;
    for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
        points[v] = box_at(surface.positions, features.vertices[tile.first_vertex + v]);
    out.body = body;
    out.index = index;
    out.tile = &tile;
    out.has_points = false;
    out.has_plane = 0;
    out.box = tile_boxes_[surface.first_tile + index];
    for (std::uint32_t f = 0; f < tile.face_count; ++f) {
        const auto& [u, v, w] = features.faces[tile.first_face + f];
        Box box = points[u];
        add(box, points[v]);
        add(box, points[w]);
        out.faces.set(f, box);
    }
    for (std::uint32_t e = 0; e < tile.edge_count; ++e) {
        const auto& [u, v] = features.edges[tile.first_edge + e];
        Box box = points[u];
        add(box, points[v]);
        out.edges.set(e, box);
    }
}

void EdgeContacts::make_points(const StepScene& scene, LoadedTile& tile) const {
    if (tile.has_points) return;
    const Positions& positions = scene.bodies[tile.body].positions;
    const std::uint32_t* vertices =
        step_surfaces_[tile.body].features->vertices.data() + tile.tile->first_vertex;
    for (std::uint32_t v = 0; v < tile.tile->vertex_count; ++v) tile.points[v] = positions.exact(vertices[v]);
    tile.has_points = true;
}

const TrianglePlane& EdgeContacts::plane_of(LoadedTile& tile, std::size_t face) const {
    if (!(tile.has_plane >> face & 1)) {
        const auto& [u, v, w] = step_surfaces_[tile.body].features->faces[tile.tile->first_face + face];
        tile.planes[face] = {tile.points[u], tile.points[v], tile.points[w]};
        tile.has_plane |= std::uint64_t{1} << face;
    }
    return tile.planes[face];
}

void EdgeContacts::test(const StepScene& scene, LoadedTile& edges, LoadedTile& faces, Worker& worker) {
    std::array<EdgeFaces, SurfaceTile::most_edges> near;
    const std::uint32_t count = find_edge_faces(edges.edges, edges.tile->edge_count, edges.box, faces.faces,
                                                faces.tile->face_count, near.data());
    if (count == 0) return;
    const bool is_self = edges.body == faces.body;
    const SurfaceFeatures& features = *step_surfaces_[faces.body].features;
    const std::uint32_t* corners = features.vertices.data() + faces.tile->first_vertex;
    const std::uint32_t* ends =
        step_surfaces_[edges.body].features->vertices.data() + edges.tile->first_vertex;
    make_points(scene, edges);
    make_points(scene, faces);
    for (const EdgeFaces& edge_faces : std::span(near).first(count)) {
        const auto [edge, met] = edge_faces;
        worker.candidates += static_cast<std::uint64_t>(std::popcount(met));
        const auto& [u, v] = step_surfaces_[edges.body].features->edges[edges.tile->first_edge + edge];
        const Vec3d &p = edges.points[u], &q = edges.points[v];
        const std::uint32_t low = ends[u], high = ends[v];
        for (std::uint32_t left = met; left; left &= left - 1) {
            const auto face = static_cast<std::size_t>(std::countr_zero(left));
            const auto& [a, b, c] = features.faces[faces.tile->first_face + face];
            if (is_self) {
                const std::uint32_t of_face[3] = {corners[a], corners[b], corners[c]};
                if (std::count(of_face, of_face + 3, low) + std::count(of_face, of_face + 3, high) > 0) {
                    --worker.candidates;
                    continue;
                }
            }
            if (plane_of(faces, face).has_on_one_side(p, q)) continue;
            if (!passes_beside(p, q, faces.points[a], faces.points[b], faces.points[c]))
                decide(scene, edges, edge, faces, face, worker);
        }
    }
}

// ---- contacts -------------------------------------------------------------------------------------

void EdgeContacts::decide(const StepScene& scene, const LoadedTile& edges, std::size_t edge,
                          const LoadedTile& faces, std::size_t face, Worker& worker) {
    const SurfaceFeatures& of_edge = *step_surfaces_[edges.body].features;
    const SurfaceFeatures& of_face = *step_surfaces_[faces.body].features;
    // Vertices of the mesh, and of the tile.
    struct Corner {
        std::uint32_t vertex;
        std::uint8_t local;

        bool operator<(const Corner& other) const { return vertex < other.vertex; }
    };
    const auto corner_of = [](const SurfaceFeatures& features, const SurfaceTile& tile, std::uint8_t local) {
        return Corner{features.vertices[tile.first_vertex + local], local};
    };
    const std::size_t place = faces.tile->first_face + face;
    std::array<Corner, 2> ends;
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 2; ++i)
        ends[i] = corner_of(of_edge, *edges.tile, of_edge.edges[edges.tile->first_edge + edge][i]);
    for (std::size_t i = 0; i < 3; ++i) corners[i] = corner_of(of_face, *faces.tile, of_face.faces[place][i]);
    // In an order that does not depend on how the mesh was edited, nor do the bits of the weights then.
    std::sort(ends.begin(), ends.end());
    std::sort(corners.begin(), corners.end());
    const std::uint32_t low = ends[0].vertex, high = ends[1].vertex;
    const std::uint32_t v[3] = {corners[0].vertex, corners[1].vertex, corners[2].vertex};
    const Vec3d p = edges.points[ends[0].local], q = edges.points[ends[1].local];
    const Vec3d corner[3] = {faces.points[corners[0].local], faces.points[corners[1].local],
                             faces.points[corners[2].local]};
    const Crossing found = find_crossing(p, q, corner[0], corner[1], corner[2], worker.exact_tests);
    if (found.kind == CrossingKind::none) return;
    const std::uint32_t tet = of_face.tets[place];
    if (const SelfFilter* filter = scene.bodies[faces.body].self_filter; edges.body == faces.body && filter) {
        const Tet& behind = scene.bodies[faces.body].tets[tet];
        if (filter->skips(low, behind) || filter->skips(high, behind)) return;
    }

    const std::uint32_t apex = scene.topologies[faces.body]->triangles[of_face.triangles[place]].apex;
    int inside = orientation(corner[0], corner[1], corner[2], scene.bodies[faces.body].positions.exact(apex),
                             worker.exact_tests);
    if (inside == 0) inside = orientation(corner[0], corner[1], corner[2], p, worker.exact_tests);
    const std::size_t second = inside > 0 ? 2 : 1, third = 3 - second;
    Vec3d normal = normalised(cross(scaled(corner[second] - corner[0]), scaled(corner[third] - corner[0])));
    if (!(length(normal) > 0)) normal = {0, 0, 1};
    const EdgeContact contact{
        .body_a = scene.bodies[edges.body].mesh_id,
        .edge = {low, high},
        .body_b = scene.bodies[faces.body].mesh_id,
        .face = {v[0], v[second], v[third]},
        .tet = tet,
        .kind = found.kind,
        .edge_weights = {found.edge_weights[0], found.edge_weights[1]},
        .face_weights = {found.face_weights[0], found.face_weights[second], found.face_weights[third]},
        .position = {found.position.x, found.position.y, found.position.z},
        .normal = {normal.x, normal.y, normal.z}};
    const std::lock_guard lock(mutex_);
    reserve_sparingly(found_, found_.size() + 1);
    found_.push_back(contact);
}

void EdgeContacts::put_in_order() {
    check_contact_count(found_.size(), "edge contacts");
    keys_.clear();
    reserve_sparingly(keys_, found_.size());
    for (const EdgeContact& c : found_) {
        const auto [middle, last] = std::minmax(c.face[1], c.face[2]);
        keys_.push_back({{c.body_a, c.edge[0], c.edge[1], c.body_b, c.face[0], middle, last},
                         static_cast<std::uint32_t>(keys_.size())});
    }
    std::sort(keys_.begin(), keys_.end());
    contacts_.clear();
    reserve_sparingly(contacts_, found_.size());
    for (const Key& key : keys_) contacts_.push_back(found_[key.index]);
}

} // namespace vox
