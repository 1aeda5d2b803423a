// Boxes of bodies, of groups of blocks and of blocks are asked whether they are beyond a shape, as spheres
// around them; what is left is looked at vertex by vertex, in the shape's frame.
#include "grid/shape_contacts.hpp"

#include "base/bits.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "fast/step.hpp"
#include "grid/constraints.hpp"
#include "grid/pairs.hpp"
#include "grid/surface_search.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {

namespace {

constexpr std::size_t task_groups = 64, task_tiles = 16; // that are worth a task of their own

// More than what a few roundings move a point.
double rounding_at(const Vec3d& p) noexcept { return 0x1p-48 * largest_coordinate(p); }

std::size_t group_count(const fast::StepBody& of) noexcept {
    return (of.tiles->block_first.size() - 1 + fast::group_blocks - 1) / fast::group_blocks;
}

} // namespace

void ShapeContacts::bind_previous(vox_body shape, const double* matrix) {
    changed_ = true;
    const auto at = std::ranges::lower_bound(previous_, shape, {}, &Previous::shape);
    const bool is_bound = at != previous_.end() && at->shape == shape;
    if (!matrix) {
        if (is_bound) previous_.erase(at, at + 1);
        return;
    }
    Previous made{shape, {}};
    std::copy_n(matrix, 12, made.matrix.begin());
    if (is_bound)
        *at = made;
    else
        previous_.insert(at, made);
}

void ShapeContacts::forget(vox_body body) noexcept {
    changed_ = true;
    erase_if(previous_, [body](const Previous& previous) { return previous.shape == body; });
}

// ---- what there is to do --------------------------------------------------------------------------

void ShapeContacts::place_shapes(const StepScene& scene) {
    placed_.clear();
    auto previous = previous_.begin();
    for (std::uint32_t b = 0; b < scene.bodies.size(); ++b) {
        const Body& body = scene.bodies[b];
        if (!body.shape) continue;
        while (previous != previous_.end() && previous->shape < body.mesh_id) ++previous;
        const bool moves = previous != previous_.end() && previous->shape == body.mesh_id;
        const ShapePlace now(body.positions.transform),
            before = moves ? ShapePlace(previous->matrix.data()) : now;
        RigidShape::Bounds bounds = now.to_world(body.shape->bounds());
        const double far = margin_ * (1 + 4 * ShapePlace::tolerance);
        const Vec3d reach{far, far, far};
        bounds = {bounds.min - reach, bounds.max + reach};
        reserve_growing(placed_, placed_.size() + 1);
        placed_.push_back({b, body.shape, now, before, moves, bounds});
    }
}

// Spheres around where groups of blocks were.
void ShapeContacts::surround_previous(const StepScene& scene) {
    moving_groups_.clear();
    for (std::uint32_t b = 0; b < scene.previous.size(); ++b) {
        if (!has_previous(scene, b) || scene.bodies[b].vertex_count == 0) continue;
        const std::span<const std::uint32_t> first = scene.of[b].tiles->block_first;
        reserve_growing(moving_groups_, moving_groups_.size() + group_count(scene.of[b]));
        for (std::size_t block = 0; block + 1 < first.size(); block += fast::group_blocks) {
            const std::size_t end = std::min<std::size_t>(block + fast::group_blocks, first.size() - 1);
            Vec3d lo = scene.previous[b].exact(first[block]), hi = lo;
            for (std::uint32_t v = first[block]; v < first[end]; ++v) {
                const Vec3d p = scene.previous[b].exact(v);
                lo = min(lo, p);
                hi = max(hi, p);
            }
            const Vec3d half = 0.5 * (hi - lo);
            moving_groups_.push_back({lo + half, length(half)});
        }
    }
}

void ShapeContacts::list_tasks(const StepScene& scene, KeptFeatures& kept) {
    tasks_.clear();
    std::size_t carried = 0, first_moving = 0;
    for (std::uint32_t a = 0; a < scene.bodies.size() && !placed_.empty(); ++a) {
        const Body& body = scene.bodies[a];
        if (body.shape || body.vertex_count == 0) continue;
        const std::size_t groups = group_count(scene.of[a]), moving = first_moving;
        if (has_previous(scene, a)) first_moving += groups;
        for (std::uint32_t p = 0; p < placed_.size(); ++p) {
            const Body& shape = scene.bodies[placed_[p].body];
            if (!collide(body, shape)) continue;
            reserve_growing(tasks_, tasks_.size() + groups / task_groups + 2);
            if (!changed_ && !scene.of[a].moved && !has_previous(scene, a) && !placed_[p].moves) {
                const auto is_before = [&](const ShapeRun& run) {
                    return std::tie(run.body_a, run.body_b) < std::tie(body.mesh_id, shape.mesh_id);
                };
                while (carried < runs_.size() && is_before(runs_[carried])) ++carried;
                const std::size_t first = carried;
                while (carried < runs_.size() && runs_[carried].body_a == body.mesh_id &&
                       runs_[carried].body_b == shape.mesh_id)
                    ++carried;
                if (first != carried)
                    tasks_.push_back({a, p, first, carried, Does::carry, 0, 0, 0, 0, 0, 0, 0, 0});
                continue;
            }
            for (std::size_t first = 0; first < groups; first += task_groups)
                tasks_.push_back({a, p, first, std::min(first + task_groups, groups), Does::vertices, moving,
                                  0, 0, 0, 0, 0, 0, 0});
            if (!finds_edges_ || !shape.shape->facets() || scene.topologies[a]->triangles.empty() ||
                !overlap(scene.boxes->bodies[a], box_of(scene, a, placed_[p])))
                continue;
            const std::size_t tiles = kept.of(scene, a).tiles.size(); // which may move those of others
            reserve_growing(tasks_, tasks_.size() + tiles / task_tiles + 1);
            for (std::size_t first = 0; first < tiles; first += task_tiles)
                tasks_.push_back(
                    {a, p, first, std::min(first + task_tiles, tiles), Does::edges, 0, 0, 0, 0, 0, 0, 0, 0});
        }
    }
}

// The box of floats, less the origin, that boxes of a mesh overlap where they may be in reach of a shape.
Box ShapeContacts::box_of(const StepScene& scene, std::uint32_t body, const Placed& placed) const noexcept {
    const Vec3d lo = placed.bounds.min - scene.origin, hi = placed.bounds.max - scene.origin;
    const float slack = 2 * growth(scene.boxes->bodies[body], margin_);
    Box box{{static_cast<float>(lo.x), static_cast<float>(lo.y), static_cast<float>(lo.z), 0},
            {static_cast<float>(hi.x), static_cast<float>(hi.y), static_cast<float>(hi.z), 0}};
    for (int i = 0; i < 3; ++i) { // also what large sides are rounded by
        box.lo[i] -= slack + 0x1p-21f * std::abs(box.lo[i]);
        box.hi[i] += slack + 0x1p-21f * std::abs(box.hi[i]);
    }
    return box;
}

// ---- one mesh and one shape -----------------------------------------------------------------------

struct ShapeContacts::Search {
    Search(const ShapeContacts& of, const StepScene& step, const Task& task, Array<ShapeVertex>& to)
        : scene(step), body(step.bodies[task.body]), of_body(step.of[task.body]),
          placed(of.placed_[task.placed]), shape(*placed.shape), out(to), margin(of.margin_),
          reach(margin / placed.now.scale()), slack(growth(step.boxes->bodies[task.body], 0)),
          box(of.box_of(step, task.body, placed)), has_previous(of.has_previous(step, task.body)),
          moves(has_previous || placed.moves) {
        if (has_previous) moving = of.moving_groups_.data() + task.first_moving;
    }

    // In the world.
    Sphere around(const Box& b) const noexcept {
        const Vec3d lo{b.lo[0], b.lo[1], b.lo[2]}, hi{b.hi[0], b.hi[1], b.hi[2]},
            half = 0.5 * (hi - lo), centre = lo + half + scene.origin;
        return {centre, length(half) * (1 + 0x1p-40) + 2 * double{slack} + rounding_at(centre)};
    }
    bool is_beyond(const Sphere& sphere) const {
        return is_beyond(placed.now.to_shape(sphere.centre), placed.now.to_shape(sphere.radius));
    }
    bool is_beyond(const Vec3d& centre, double radius) const {
        return shape.is_beyond(centre, radius + rounding_at(centre), reach);
    }
    // On all straight ways from the one sphere to the other.
    bool stays_beyond(const Sphere& from, const Sphere& to) const {
        const Vec3d a = placed.before.to_shape(from.centre), b = placed.now.to_shape(to.centre),
                    half = 0.5 * (b - a);
        const double radius = std::max(placed.before.to_shape(from.radius + rounding_at(from.centre)),
                                       placed.now.to_shape(to.radius));
        return is_beyond(a + half, length(half) * (1 + 0x1p-40) + radius + rounding_at(a) + rounding_at(b));
    }

    void search_group(std::size_t group) {
        const Box& around_group = scene.boxes->groups[of_body.first_group + group];
        const Sphere now = around(around_group);
        if (moves ? stays_beyond(has_previous ? moving[group] : now, now)
                  : !overlap(around_group, box) || is_beyond(now))
            return;
        const std::size_t first = group * fast::group_blocks,
                          last = std::min<std::size_t>(first + fast::group_blocks,
                                                       of_body.tiles->block_first.size() - 1);
        for (std::size_t block = first; block < last; ++block) {
            const Box& around_block = scene.boxes->blocks[of_body.first_block + block];
            const std::uint32_t begin = of_body.tiles->block_first[block],
                                end = of_body.tiles->block_first[block + 1];
            if (moves || (overlap(around_block, box) && !is_beyond(around(around_block))))
                search_block(begin, end);
        }
    }

    void search_block(std::uint32_t first, std::uint32_t last) {
        std::array<Vec3d, RigidShape::most_points> at, from;
        std::array<std::uint32_t, RigidShape::most_points> vertex;
        std::array<ShapePoint, RigidShape::most_points> seen;
        std::size_t count = 0;
        for (std::uint32_t v = first; v < last; ++v) {
            if (has_bit(body.removed_vertices, v)) continue;
            vertex[count] = v;
            if (moves) from[count] = before(v);
            at[count++] = placed.now.to_shape(body.positions.exact(v));
        }
        if (moves && all_stay_beyond(std::span(from).first(count), std::span(at).first(count))) return;
        const std::uint32_t found = shape.look(std::span(at).first(count), reach, state, seen.data());
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_near = (found >> i & 1) != 0, is_inside = is_near && seen[i].is_inside;
            ShapePoint met;
            const double met_at = moves ? meeting(from[i], at[i], met) : no_meeting;
            if (is_inside)
                add(vertex[i], VOX_CONSTRAINT_INSIDE, seen[i], met_at <= 1 ? met_at : 1);
            else if (met_at <= 1 && met.distance < 0)
                add(vertex[i], VOX_CONSTRAINT_IMPACT, met, met_at);
            else if (is_near && margin > 0)
                add(vertex[i], VOX_CONSTRAINT_PROXIMITY, seen[i], 1);
        }
    }

    // In the shape's frame.
    Vec3d before(std::uint32_t vertex) const noexcept {
        const auto index = static_cast<std::size_t>(&body - scene.bodies.data());
        const Positions& positions = has_previous ? scene.previous[index] : body.positions;
        return placed.before.to_shape(positions.exact(vertex));
    }
    bool all_stay_beyond(std::span<const Vec3d> from, std::span<const Vec3d> to) const {
        if (from.empty()) return true;
        Vec3d lo = from[0], hi = lo;
        for (const std::span<const Vec3d> ends : {from, to})
            for (const Vec3d& p : ends) {
                lo = min(lo, p);
                hi = max(hi, p);
            }
        const Vec3d half = 0.5 * (hi - lo);
        return is_beyond(lo + half, length(half) * (1 + 0x1p-40));
    }
    // When a vertex met the shape on its way, and how far it is behind the plane there.
    double meeting(const Vec3d& from, const Vec3d& to, ShapePoint& met) const {
        ShapePoint start;
        if (!shape.is_thin() && shape.look(from, 0, start) && start.is_inside) return no_meeting;
        const double time = shape.meeting(from, to, met);
        if (time <= 1) met.distance = dot(met.normal, (1 - time) * (to - from));
        return time;
    }

    void add(std::uint32_t vertex, vox_constraint_kind kind, const ShapePoint& seen, double time) {
        const double gap = seen.distance * placed.now.scale();
        if (!(seen.normal.x == local.x && seen.normal.y == local.y && seen.normal.z == local.z)) {
            local = seen.normal;
            normal = placed.now.to_world(local);
        }
        const vox_depth_state state = kind == VOX_CONSTRAINT_IMPACT ? VOX_DEPTH_PLANE
                                      : gap == 0                    ? VOX_DEPTH_TOUCHING
                                                                    : VOX_DEPTH_CLOSEST;
        reserve_growing(out, out.size() + 1);
        out.push_back({vertex, seen.element, gap, time, {normal.x, normal.y, normal.z}, kind, state});
    }

    const StepScene& scene;
    const Body& body;
    const fast::StepBody& of_body;
    const Placed& placed;
    const RigidShape& shape;
    Array<ShapeVertex>& out;
    double margin, reach; // in the world and in the shape's frame
    float slack;          // what boxes of floats are off by
    Box box;              // around the shape, for boxes of the mesh
    bool has_previous, moves;
    const Sphere* moving = nullptr;
    RigidShape::LookState state;
    Vec3d local{0, 0, 0}, normal{0, 0, 0}; // of the last contact, in the shape's frame and in the world
};

// ---- all of them ----------------------------------------------------------------------------------

void ShapeContacts::run(const StepScene& scene, KeptFeatures& kept, Task& task, Worker& out) const {
    const Array<ShapeEdge>& edges = task.does == Does::edges ? out.crossings.of_mesh : out.edges;
    task.begin_vertex = out.vertices.size();
    task.begin_edge = edges.size();
    task.begin_crossing = out.crossings.of_shape.size();
    if (task.does == Does::vertices) {
        Search search(*this, scene, task, out.vertices);
        const Box& all = scene.boxes->bodies[task.body];
        if (search.moves || (overlap(all, search.box) && !search.is_beyond(search.around(all))))
            for (std::size_t g = task.first; g < task.last; ++g) search.search_group(g);
    } else if (task.does == Does::edges) {
        find_shape_edges(pair_of(scene, task), kept.of(scene, task.body), task.first, task.last,
                         out.crossings);
    } else {
        for (const ShapeRun& from : std::span(runs_).subspan(task.first, task.last - task.first)) {
            reserve_growing(out.vertices, out.vertices.size() + from.vertices.size());
            out.vertices.insert(out.vertices.end(), from.vertices.begin(), from.vertices.end());
            reserve_growing(out.edges, out.edges.size() + from.edges.size());
            out.edges.insert(out.edges.end(), from.edges.begin(), from.edges.end());
        }
    }
    task.end_vertex = out.vertices.size();
    task.end_edge = edges.size();
    task.end_crossing = out.crossings.of_shape.size();
}

ShapePair ShapeContacts::pair_of(const StepScene& scene, const Task& task) const noexcept {
    const Placed& placed = placed_[task.placed];
    return {scene, task.body, *placed.shape, placed.now, box_of(scene, task.body, placed)};
}

// From what the task at `first` and those that follow it have found.
void ShapeContacts::join_edges(const StepScene& scene, std::size_t first, std::uint32_t worker) {
    PerWorker<Worker>& workers = workers_[1 - now_];
    Worker& out = workers[worker];
    Array<ShapeCrossing>& crossings = out.crossings.of_one_search;
    crossings.clear();
    Task& joined = tasks_[first];
    const std::size_t begin = out.edges.size();
    std::size_t end = first;
    do {
        Task& task = tasks_[end++];
        const ShapeCrossings& found = workers[task.worker].crossings;
        const auto of_mesh =
            std::span(found.of_mesh).subspan(task.begin_edge, task.end_edge - task.begin_edge);
        reserve_growing(out.edges, out.edges.size() + of_mesh.size());
        out.edges.insert(out.edges.end(), of_mesh.begin(), of_mesh.end());
        const auto of_shape =
            std::span(found.of_shape).subspan(task.begin_crossing, task.end_crossing - task.begin_crossing);
        reserve_growing(crossings, crossings.size() + of_shape.size());
        crossings.insert(crossings.end(), of_shape.begin(), of_shape.end());
        task.begin_edge = task.end_edge = 0;
    } while (end < tasks_.size() && tasks_[end].does == Does::edges && tasks_[end].first != 0);
    join_shape_edges(pair_of(scene, joined), crossings, begin, out.edges);
    joined.worker = worker;
    joined.begin_vertex = joined.end_vertex = 0;
    joined.begin_edge = begin;
    joined.end_edge = out.edges.size();
}

void ShapeContacts::find(const StepScene& scene, KeptFeatures& kept) {
    place_shapes(scene);
    surround_previous(scene);
    list_tasks(scene, kept);
    PerWorker<Worker>& workers = workers_[1 - now_];
    workers.grow(scene.workers->count());
    for (Worker& worker : workers) {
        worker.vertices.clear();
        worker.edges.clear();
        worker.crossings.of_shape.clear();
        worker.crossings.of_mesh.clear();
    }
    // Edges are worth more than vertices, most of which are far away.
    const std::size_t least_tasks = finds_edges_ ? 1 : 8;
    scene.workers->for_ranges(tasks_.size(), least_tasks,
                              [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                                  for (Task& task : std::span(tasks_).subspan(begin, end - begin)) {
                                      task.worker = w;
                                      run(scene, kept, task, workers[w]);
                                  }
                              });
    if (finds_edges_)
        scene.workers->for_ranges(tasks_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
            for (std::size_t i = begin; i < end; ++i)
                if (tasks_[i].does == Does::edges && tasks_[i].first == 0) join_edges(scene, i, w);
        });
    workers.level();
    now_ = 1 - now_;
    list_results(scene);
    check_contact_count(count_, "contacts with shapes");
    changed_ = false;
}

void ShapeContacts::list_results(const StepScene& scene) {
    const std::size_t last_count = count_;
    std::size_t vertices = 0, edges = 0, crossings = 0, of_mesh = 0;
    for (const Task& task : tasks_) {
        vertices += task.end_vertex - task.begin_vertex;
        edges += task.end_edge - task.begin_edge;
        crossings += task.end_crossing - task.begin_crossing;
    }
    for (Worker& worker : workers_[now_]) of_mesh += worker.crossings.of_mesh.size();
    for (PerWorker<Worker>& workers : workers_) // in a later step, one may find all
        for (Worker& worker : workers) {
            reserve_sparingly(worker.vertices, vertices);
            reserve_sparingly(worker.edges, edges);
            reserve_sparingly(worker.crossings.of_shape, crossings);
            reserve_sparingly(worker.crossings.of_mesh, of_mesh);
        }
    count_ = carried_ = 0;
    runs_.clear();
    pairs_.clear();
    reserve_growing(runs_, 2 * tasks_.size());
    reserve_growing(pairs_, tasks_.size());
    for (const Task& task : tasks_) {
        const vox_body body_a = scene.bodies[task.body].mesh_id,
                       body_b = scene.bodies[placed_[task.placed].body].mesh_id;
        const Worker& from = workers_[now_][task.worker];
        ShapeRun of_vertices{body_a, body_b, count_, {}, {}, {}};
        of_vertices.vertices =
            std::span(from.vertices).subspan(task.begin_vertex, task.end_vertex - task.begin_vertex);
        for (const ShapeVertex& vertex : of_vertices.vertices) ++of_vertices.of_kind[vertex.kind];
        ShapeRun of_edges{body_a, body_b, count_ + of_vertices.count(), {}, {}, {}};
        of_edges.edges = std::span(from.edges).subspan(task.begin_edge, task.end_edge - task.begin_edge);
        of_edges.of_kind[VOX_CONSTRAINT_EDGE] = of_edges.edges.size();
        for (const ShapeRun& found : {of_vertices, of_edges}) {
            if (found.count() == 0) continue;
            count_ += found.count();
            if (task.does == Does::carry) carried_ += found.count();
            runs_.push_back(found);
            const auto [a, b] = std::minmax(body_a, body_b);
            if (pairs_.empty() || ids_of(pairs_.back()) != IdPair{a, b})
                pairs_.push_back({a, b, 0, 0, VOX_PAIR_NEAR, 0, 0, 0});
            if (found.of_kind[VOX_CONSTRAINT_PROXIMITY] != found.count())
                pairs_.back().state = VOX_PAIR_BEGAN;
        }
    }
    is_unchanged_ = !changed_ && carried_ == count_ && carried_ == last_count &&
                    std::none_of(pairs_.begin(), pairs_.end(), [](const vox_pair& pair) {
                        return pair.state == VOX_PAIR_NEAR; // which Pairs::repeat() has none of
                    });
    std::ranges::sort(pairs_, {}, ids_of);
}

void ShapeContacts::add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept {
    sources.shapes = runs_;
    sources.shape_count = count_;
}

} // namespace vox
