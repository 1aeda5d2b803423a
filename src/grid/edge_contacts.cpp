// Two bodies whose boxes overlap: tiles of each in the box of the other are joined, box by box, then the
// edges of one tile with the faces of the other, and what is left is decided exactly. Of a body with itself,
// what winding numbers have certified is left out (fast/winding/certificate.cpp).
#include "grid/edge_contacts.hpp"

#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/facet_normal.hpp"
#include "grid/constraints.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {

namespace {

// Where a body certainly has no edge contact with itself; null for a pair of two, and where nothing is known.
const fast::CertifiedCells* certified_for(const StepScene& scene, const fast::Pair& pair) {
    return pair.a == pair.b ? scene.certified(pair.a) : nullptr;
}

} // namespace

EdgeContacts::EdgeContacts(std::pmr::memory_resource* memory)
    : pairs_of_bodies_(memory), bodies_(memory), workers_(memory), found_(memory), keys_(memory),
      entered_(memory), contacts_(memory), pairs_(memory), depths_(memory) {}

void EdgeContacts::clear() noexcept {
    contacts_.clear();
    pairs_.clear();
    unchanged_ = false;
}

void EdgeContacts::find(const StepScene& scene, KeptFeatures& kept) {
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
    carried_ = found_.size();
    list_pairs(scene);
    bodies_.make_boxes(scene, kept);
    join_pairs(
        std::span<const fast::Pair>(pairs_of_bodies_), workers_, *scene.workers,
        [&](const fast::Pair& pair) { return bodies_[pair.a].tile_count(); },
        [&](const fast::Pair& pair, Worker& tiles) { return list_tiles(scene, pair, tiles); },
        [&](const fast::Pair& pair, const Worker& tiles, std::size_t begin, std::size_t end,
            std::uint32_t w) { search(scene, pair, tiles, begin, end, workers_[w]); });
    workers_.level();

    unchanged_ = found_.size() == carried_ && carried_ == contacts_.size();
    if (unchanged_) return;
    put_in_order();
    vox::list_pairs(std::span<const EdgeContact>(contacts_), VOX_PAIR_BEGAN, pairs_);
}

void EdgeContacts::count(Counters& counters) {
    counters.edges = contacts_.size();
    counters.carried_edges = carried_;
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
    bodies_.begin(scene);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].grow = growth(bodies_[b].box, 0);
    for (const fast::Pair& pair : pairs_of_bodies_) {
        Box common = bodies_[pair.a].box;
        intersect(common, bodies_[pair.b].box);
        bodies_.reach(pair.a, common);
        bodies_.reach(pair.b, common);
    }
}

// ---- which edges and faces ------------------------------------------------------------------------

// The tiles of the two that meet where the boxes of the two overlap. Of a body with itself, those that are
// not certified.
std::size_t EdgeContacts::list_tiles(const StepScene& scene, const fast::Pair& pair, Worker& worker) const {
    Box region = bodies_[pair.a].tiles_box;
    intersect(region, bodies_[pair.b].tiles_box);
    const fast::CertifiedCells* const certified = certified_for(scene, pair);
    const auto list = [&](std::uint32_t body, Array<std::uint32_t>& tiles) {
        const Box* const boxes = bodies_.tile_boxes(body);
        list_overlaps(boxes, bodies_[body].tile_count(), region, tiles);
        if (certified) erase_if(tiles, [&](std::uint32_t tile) { return certified->holds(boxes[tile]); });
        return !tiles.empty();
    };
    if (is_empty(region) || !list(pair.a, worker.tiles_a) || !list(pair.b, worker.tiles_b)) return 0;
    worker.boxes_b.clear();
    for (const std::uint32_t tile : worker.tiles_b)
        worker.boxes_b.push_back(bodies_.tile_boxes(pair.b)[tile]);
    return worker.tiles_a.size();
}

// The tiles [begin, end) of tiles.tiles_a against all of tiles.tiles_b, edges of either with faces of the
// other. Of a body with itself, each two tiles once.
void EdgeContacts::search(const StepScene& scene, const fast::Pair& pair, const Worker& tiles,
                          std::size_t begin, std::size_t end, Worker& worker) {
    const fast::CertifiedCells* const certified = certified_for(scene, pair);
    const bool is_self = pair.a == pair.b; // the lists are the same
    const double reach = double{bodies_[pair.a].grow} + double{bodies_[pair.b].grow};
    LoadedTile& a = worker.loaded[Worker::most_loaded];
    worker.oriented_b.clear();
    for (std::size_t i = begin; i < end; ++i) {
        const Box& box = bodies_.tile_boxes(pair.a)[tiles.tiles_a[i]];
        bool is_loaded = false;
        worker.is_crowded = false;
        const auto is_apart = [&](std::size_t j) {
            return tiles_stay_apart(bodies_[pair.a], tiles.tiles_a[i], worker.oriented_a, bodies_[pair.b],
                                    tiles.tiles_b[j], worker.oriented_b[j], reach);
        };
        tiles.boxes_b.for_overlaps(box, [&](std::size_t j) {
            if (is_self && j < i) return;
            if (worker.is_crowded && is_apart(j)) return;
            if (certified) {
                Box common = box;
                intersect(common, tiles.boxes_b.boxes[j]);
                if (certified->holds(common)) return;
            }
            if (!is_loaded) load(pair.a, tiles.tiles_a[i], a);
            is_loaded = true;
            const auto test_apart = [&](LoadedTile& edges, LoadedTile& faces) {
                if (test(scene, edges, faces, worker)) return false;
                orient(pair, tiles.tiles_a[i], tiles, worker);
                if (is_apart(j)) return true;
                (void)test(scene, edges, faces, worker);
                return false;
            };
            if (is_self && j == i) return (void)test_apart(a, a);
            LoadedTile& b = worker.loaded[(pair.b + tiles.tiles_b[j]) % Worker::most_loaded];
            if (b.body != pair.b || b.index != tiles.tiles_b[j]) load(pair.b, tiles.tiles_b[j], b);
            if (!test_apart(a, b)) (void)test_apart(b, a);
        });
    }
}

// From now on, oriented boxes decide what a tile of body a is tested with.
void EdgeContacts::orient(const fast::Pair& pair, std::uint32_t tile_a, const Worker& tiles,
                          Worker& worker) const {
    worker.is_crowded = true;
    worker.oriented_a = oriented_box(bodies_[pair.a], tile_a);
    if (!worker.oriented_b.empty()) return; // of this pair
    reserve_growing(worker.oriented_b, tiles.tiles_b.size());
    for (const std::uint32_t tile : tiles.tiles_b)
        worker.oriented_b.push_back(oriented_box(bodies_[pair.b], tile));
}

void EdgeContacts::load(std::uint32_t body, std::uint32_t index, LoadedTile& out) const {
    out.body = body;
    out.index = index;
    out.features = bodies_[body].features;
    out.tile = &out.features->tiles[index];
    out.vertices = &out.features->vertices[out.tile->first_vertex];
    out.corners = &out.features->faces[out.tile->first_face];
    out.ends = out.features->edges.data() + out.tile->first_edge;
    out.has_points = out.has_slabs = false;
    out.has_plane = 0;
    out.box = bodies_.tile_boxes(body)[index];
    TilePoints points;
    load_points(bodies_[body], *out.tile, points);
    load_faces(*out.features, *out.tile, points, 0, out.faces);
    for (std::uint32_t e = 0; e < out.tile->edge_count; ++e) {
        const auto& [u, v] = out.ends[e];
        out.edges[e] = points[u];
        add(out.edges[e], points[v]);
    }
}

// False, and nothing done, if the two are crowded and nothing was known of that.
bool EdgeContacts::test(const StepScene& scene, LoadedTile& edges, LoadedTile& faces, Worker& worker) {
    // Edges in the box of the faces, and the faces whose boxes these overlap, as bits.
    std::array<std::uint32_t, SurfaceTile::most_edges> near, met;
    std::array<Box, SurfaceTile::most_edges> boxes;
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < edges.tile->edge_count; first += fast::most_boxes) {
        const std::uint32_t some = std::min<std::uint32_t>(edges.tile->edge_count - first, fast::most_boxes);
        for (std::uint64_t bits = fast::find_overlaps(&edges.edges[first], some, faces.box); bits;
             bits &= bits - 1) {
            near[count] = first + static_cast<std::uint32_t>(std::countr_zero(bits));
            boxes[count] = edges.edges[near[count]];
            ++count;
        }
    }
    if (count == 0) return true;
    find_faces(boxes.data(), count, faces.faces, faces.tile->face_count, met.data());
    std::uint32_t pairs = count_pairs(std::span(met).first(count));
    if (pairs == 0) return true;
    if (pairs > crowd && !worker.is_crowded) return false;
    for (LoadedTile* tile : {&edges, &faces}) {
        if (!tile->has_points)
            load_positions(scene.bodies[tile->body].positions, *tile->features, *tile->tile,
                           tile->points.data());
        tile->has_points = true;
    }
    if (pairs > crowd) {
        if (!faces.has_slabs) {
            load_slabs(*faces.features, *faces.tile, faces.points.data(), faces.slabs);
            load_lines(*faces.features, *faces.tile, faces.points.data(), faces.lines);
        }
        faces.has_slabs = true;
        std::array<Segment, SurfaceTile::most_edges> segments;
        for (std::uint32_t i = 0; i < count; ++i)
            segments[i] = {edges.points[edges.ends[near[i]][0]], edges.points[edges.ends[near[i]][1]]};
        keep_crossed(segments.data(), count, faces.lines, met.data());
        keep_near(segments.data(), count, faces.slabs,
                  16 * (bodies_[edges.body].grow + bodies_[faces.body].grow), met.data());
        pairs = count_pairs(std::span(met).first(count));
    }
    worker.candidates += pairs;
    const bool is_self = edges.body == faces.body;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t edge = near[i];
        const auto& [u, v] = edges.ends[edge];
        const Vec3d &p = edges.points[u], &q = edges.points[v];
        const std::uint32_t low = edges.vertices[u], high = edges.vertices[v];
        for (std::uint32_t left = met[i]; left; left &= left - 1) {
            const auto face = static_cast<std::size_t>(std::countr_zero(left));
            const auto& [a, b, c] = faces.corners[face];
            if (is_self) {
                const std::uint32_t corners[3] = {faces.vertices[a], faces.vertices[b], faces.vertices[c]};
                if (std::count(corners, corners + 3, low) + std::count(corners, corners + 3, high) > 0) {
                    --worker.candidates;
                    continue;
                }
            }
            if (!(faces.has_plane >> face & 1)) {
                faces.planes[face] = {faces.points[a], faces.points[b], faces.points[c]};
                faces.has_plane |= std::uint64_t{1} << face;
            }
            if (faces.planes[face].has_on_one_side(p, q)) continue;
            if (!passes_beside(p, q, faces.points[a], faces.points[b], faces.points[c]))
                decide(scene, edges, edge, faces, face, worker);
        }
    }
    return true;
}

// ---- contacts -------------------------------------------------------------------------------------

void EdgeContacts::decide(const StepScene& scene, const LoadedTile& edges, std::size_t edge,
                          const LoadedTile& faces, std::size_t face, Worker& worker) {
    // Vertices of the mesh, and of the tile.
    struct Corner {
        std::uint32_t vertex;
        std::uint8_t local;

        bool operator<(const Corner& other) const { return vertex < other.vertex; }
    };
    std::array<Corner, 2> ends;
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 2; ++i) ends[i] = {edges.vertices[edges.ends[edge][i]], edges.ends[edge][i]};
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = {faces.vertices[faces.corners[face][i]], faces.corners[face][i]};
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
    const Body& body = scene.bodies[faces.body];
    const std::size_t place = faces.tile->first_face + face;
    const std::uint32_t tet = faces.features->tets[place];
    const Tet& behind = body.tets[tet];
    if (const SelfFilter* filter = body.self_filter; edges.body == faces.body && filter)
        if (filter->skips(low, behind) || filter->skips(high, behind)) return;

    int inside =
        orientation(corner[0], corner[1], corner[2],
                    body.positions.exact(behind.v[faces.features->facets[place]]), worker.exact_tests);
    if (inside == 0) inside = orientation(corner[0], corner[1], corner[2], p, worker.exact_tests);
    const std::size_t second = inside > 0 ? 2 : 1, third = 3 - second;
    Vec3d normal = triangle_normal(corner[0], corner[second], corner[third]);
    if (!(length(normal) > 0)) normal = {0, 0, 1};
    const EdgeContact contact{
        .body_a = scene.bodies[edges.body].mesh_id,
        .edge = {low, high},
        .body_b = body.mesh_id,
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
    check_contact_count(found_.size(), "edges");
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

// ---- their depths: from the middle of the part of an edge that is inside to the closest point of the
// surface

namespace {

bool same_edge(const EdgeContact& x, const EdgeContact& y) {
    return x.body_a == y.body_a && x.edge[0] == y.edge[0] && x.edge[1] == y.edge[1] && x.body_b == y.body_b;
}

// The middle of the part of the edge pq behind a face that it passes through at `at`, as a fraction of the
// way from p to q. The part ends at the next face of the mesh that the edge meets, or at the end of the edge;
// `crossed_at` are those places, ascending.
double middle_of_part(std::span<const double> crossed_at, double at, bool enters) {
    double end = enters ? 1 : 0;
    if (enters) {
        const auto next = std::upper_bound(crossed_at.begin(), crossed_at.end(), at);
        if (next != crossed_at.end()) end = std::min(end, *next);
    } else {
        const auto next = std::lower_bound(crossed_at.begin(), crossed_at.end(), at);
        if (next != crossed_at.begin()) end = std::max(end, *(next - 1));
    }
    return (at + end) / 2;
}

} // namespace

void EdgeContacts::add_to(ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers) {
    sources.edges = contacts_;
    if (contacts_.empty() || sources.method == VOX_DEPTH_METHOD_NONE) return;
    fit_trees(sources, trees, workers);
    find_depths(sources, trees, workers);
    sources.edge_depths = depths_;
}

// The trees of bodies that edges of others are in.
void EdgeContacts::fit_trees(const ConstraintSources& from, depth::SurfaceTrees& trees, Workers& workers) {
    entered_.clear();
    PairIndex index(from.pairs);
    for (const EdgeContact& contact : contacts_)
        if (contact.body_a != contact.body_b && (entered_.empty() || entered_.back() != contact.body_b) &&
            from.chosen[index(contact.body_a, contact.body_b)])
            entered_.push_back(contact.body_b);
    std::ranges::sort(entered_);
    entered_.erase(std::unique(entered_.begin(), entered_.end()), entered_.end());
    for (const vox_body id : entered_) trees.add(id); // which moves those of others
    for (const vox_body id : entered_) {
        const std::uint32_t b = body_index(from.bodies, id);
        trees[id].update({from.topologies[b], from.bodies[b].tets, from.bodies[b].positions}, false,
                         &workers);
    }
}

void EdgeContacts::find_depths(const ConstraintSources& from, depth::SurfaceTrees& trees, Workers& workers) {
    constexpr std::size_t least_searches = 256; // that are worth a task
    depths_.reserve(contacts_.size());
    depths_.resize(contacts_.size());
    const auto find_depth = [&](std::span<const double> crossed_at, const EdgeContact& contact,
                                depth::SearchState& state) -> Depth {
        const Vec3d normal = vector_of(contact.normal);
        Depth out{0, {normal.x, normal.y, normal.z}};
        if (contact.kind != CrossingKind::through) return out;
        const Positions &a = from.bodies[body_index(from.bodies, contact.body_a)].positions,
                        &b = from.bodies[body_index(from.bodies, contact.body_b)].positions;
        const Vec3d p = a.exact(contact.edge[0]), q = a.exact(contact.edge[1]);
        std::uint64_t exact_tests = 0;
        const bool enters = orientation(b.exact(contact.face[0]), b.exact(contact.face[1]),
                                        b.exact(contact.face[2]), q, exact_tests) < 0;
        const Vec3d middle = p + middle_of_part(crossed_at, contact.edge_weights[1], enters) * (q - p);
        if (contact.body_a == contact.body_b) {
            out.depth = std::max(dot(vector_of(contact.position) - middle, normal), 0.0);
            return out;
        }
        depth::Closest closest;
        if (!trees[contact.body_b].find(middle, depth::SurfaceTree::no_vertex, state, closest)) return out;
        const Vec3d way = normalised(scaled(closest.way));
        if (!(length(way) > 0)) return out;
        return {std::sqrt(closest.squared), {way.x, way.y, way.z}};
    };
    workers_.grow(workers.count());
    workers.for_ranges(
        contacts_.size(), least_searches, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            Array<double>& crossed_at = workers_[w].crossed_at;
            depth::SearchState state;
            PairIndex index(from.pairs);
            vox_body last = VOX_NULL_BODY;
            std::size_t past = begin; // the contacts of one edge with one mesh end there
            for (std::size_t i = begin; i < end; ++i) {
                const EdgeContact& contact = contacts_[i];
                if (!from.chosen[index(contact.body_a, contact.body_b)]) continue;
                if (i >= past) {
                    std::size_t first = i;
                    while (first > 0 && same_edge(contacts_[first - 1], contact)) --first;
                    crossed_at.clear();
                    for (past = first; past < contacts_.size() && same_edge(contacts_[past], contact); ++past)
                        crossed_at.push_back(contacts_[past].edge_weights[1]);
                    std::sort(crossed_at.begin(), crossed_at.end());
                }
                if (contact.body_b != last)
                    state.near = depth::SearchState::none; // a triangle of another tree
                last = contact.body_b;
                depths_[i] = find_depth(crossed_at, contact, state);
            }
        });
    workers_.level();
}

} // namespace vox
