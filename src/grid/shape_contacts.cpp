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

constexpr std::size_t task_groups = 64; // that are worth a task of their own

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

void ShapeContacts::list_tasks(const StepScene& scene) {
    tasks_.clear();
    const auto place = [](const ShapeContact& contact) { return std::tuple(contact.body_a, contact.body_b); };
    std::size_t carried = 0, first_moving = 0;
    for (std::uint32_t a = 0; a < scene.bodies.size() && !placed_.empty(); ++a) {
        const Body& body = scene.bodies[a];
        if (body.shape || body.vertex_count == 0) continue;
        const std::size_t groups = group_count(scene.of[a]), moving = first_moving;
        if (has_previous(scene, a)) first_moving += groups;
        for (std::uint32_t p = 0; p < placed_.size(); ++p) {
            const Body& shape = scene.bodies[placed_[p].body];
            if (!collide(body, shape)) continue;
            reserve_growing(tasks_, tasks_.size() + groups / task_groups + 1);
            if (!changed_ && !scene.of[a].moved && !has_previous(scene, a) && !placed_[p].moves) {
                const std::tuple sought(body.mesh_id, shape.mesh_id);
                const auto rest = std::span(all_).subspan(carried);
                const auto same = std::ranges::lower_bound(rest, sought, {}, place),
                           end = std::ranges::upper_bound(rest, sought, {}, place);
                const std::size_t first = carried + static_cast<std::size_t>(same - rest.begin());
                carried += static_cast<std::size_t>(end - rest.begin());
                if (same != end) tasks_.push_back({a, p, first, carried, true, 0, 0, 0, 0});
                continue;
            }
            for (std::size_t first = 0; first < groups; first += task_groups)
                tasks_.push_back(
                    {a, p, first, std::min(first + task_groups, groups), false, moving, 0, 0, 0});
        }
    }
}

// ---- one mesh and one shape -----------------------------------------------------------------------

struct ShapeContacts::Search {
    Search(const ShapeContacts& of, const StepScene& step, const Task& task, Array<ShapeContact>& to)
        : scene(step), body(step.bodies[task.body]), of_body(step.of[task.body]),
          placed(of.placed_[task.placed]), shape(*placed.shape), out(to), margin(of.margin_),
          reach(margin / placed.now.scale()), slack(growth(step.boxes->bodies[task.body], 0)),
          has_previous(of.has_previous(step, task.body)), moves(has_previous || placed.moves) {
        const RigidShape::Bounds& b = placed.bounds;
        const Vec3d lo = b.min - step.origin, hi = b.max - step.origin;
        // Rounded to floats and back, within what `slack` is twice.
        box = {{static_cast<float>(lo.x), static_cast<float>(lo.y), static_cast<float>(lo.z), 0},
               {static_cast<float>(hi.x), static_cast<float>(hi.y), static_cast<float>(hi.z), 0}};
        const float by = 2 * slack + 0x1p-20f * static_cast<float>(std::min(margin, 0x1p100));
        box = grown(box, by);
        for (int i = 0; i < 3; ++i) { // what a float is off by, of large sides
            box.lo[i] -= 0x1p-21f * std::abs(box.lo[i]);
            box.hi[i] += 0x1p-21f * std::abs(box.hi[i]);
        }
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
            if (moves || (overlap(around_block, box) && !is_beyond(around(around_block))))
                search_block(of_body.tiles->block_first[block], of_body.tiles->block_first[block + 1]);
        }
    }

    void search_block(std::uint32_t first, std::uint32_t last) {
        std::array<Vec3d, RigidShape::most_points> at;
        std::array<std::uint32_t, RigidShape::most_points> vertex;
        std::array<ShapePoint, RigidShape::most_points> seen;
        std::size_t count = 0;
        for (std::uint32_t v = first; v < last; ++v) {
            if (has_bit(body.removed_vertices, v)) continue;
            vertex[count] = v;
            at[count++] = placed.now.to_shape(body.positions.exact(v));
        }
        const std::uint32_t found = shape.look(std::span(at).first(count), reach, seen.data());
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_near = (found >> i & 1) != 0, is_inside = is_near && seen[i].is_inside;
            ShapePoint met;
            const double met_at = moves ? meeting(vertex[i], at[i], met) : no_shape_meeting;
            if (is_inside)
                add(vertex[i], VOX_CONSTRAINT_INSIDE, seen[i], met_at <= 1 ? met_at : 1);
            else if (met_at <= 1 && met.distance < 0)
                add(vertex[i], VOX_CONSTRAINT_IMPACT, met, met_at);
            else if (is_near && margin > 0)
                add(vertex[i], VOX_CONSTRAINT_PROXIMITY, seen[i], 1);
        }
    }

    // When a vertex that is at `to` now met the shape on its way, and how far it is behind the plane there.
    double meeting(std::uint32_t vertex, const Vec3d& to, ShapePoint& met) const {
        const Vec3d from = placed.before.to_shape(
            (has_previous ? scene.previous[static_cast<std::size_t>(&body - scene.bodies.data())]
                          : body.positions)
                .exact(vertex));
        ShapePoint start;
        if (shape.look(from, 0, start) && start.is_inside) return no_shape_meeting;
        const double time = shape.meeting(from, to, met);
        if (time <= 1) met.distance = dot(met.normal, (1 - time) * (to - from));
        return time;
    }

    void add(std::uint32_t vertex, vox_constraint_kind kind, const ShapePoint& seen, double time) {
        const double gap = seen.distance * placed.now.scale();
        const Vec3d normal = placed.now.to_world(seen.normal);
        const vox_depth_state state = kind == VOX_CONSTRAINT_IMPACT ? VOX_DEPTH_PLANE
                                      : gap == 0                    ? VOX_DEPTH_TOUCHING
                                                                    : VOX_DEPTH_CLOSEST;
        reserve_growing(out, out.size() + 1);
        out.push_back({body.mesh_id,
                       vertex,
                       scene.bodies[placed.body].mesh_id,
                       seen.element,
                       kind,
                       state,
                       gap,
                       time,
                       {normal.x, normal.y, normal.z}});
    }

    const StepScene& scene;
    const Body& body;
    const fast::StepBody& of_body;
    const Placed& placed;
    const RigidShape& shape;
    Array<ShapeContact>& out;
    double margin, reach; // in the world and in the shape's frame
    float slack;          // what boxes of floats are off by
    bool has_previous, moves;
    Box box{};
    const Sphere* moving = nullptr;
};

// ---- all of them ----------------------------------------------------------------------------------

void ShapeContacts::find(const StepScene& scene, KeptFeatures&) {
    place_shapes(scene);
    surround_previous(scene);
    list_tasks(scene);
    workers_.grow(scene.workers->count());
    for (Worker& worker : workers_) worker.found.clear();
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t w) {
        for (Task& task : std::span(tasks_).subspan(begin, end - begin)) {
            task.worker = w;
            task.begin = workers_[w].found.size();
            if (!task.carries) {
                Search search(*this, scene, task, workers_[w].found);
                const Box& all = scene.boxes->bodies[task.body];
                if (search.moves || (overlap(all, search.box) && !search.is_beyond(search.around(all))))
                    for (std::size_t g = task.first; g < task.last; ++g) search.search_group(g);
            }
            task.end = workers_[w].found.size();
        }
    };
    constexpr std::size_t least_tasks = 8;
    scene.workers->for_ranges(tasks_.size(), least_tasks, run);
    list_results();
    check_contact_count(all_.size(), "contacts with shapes");
    changed_ = false;
}

void ShapeContacts::list_results() {
    found_.clear();
    std::size_t count = 0;
    for (const Task& task : tasks_) count += task.carries ? task.last - task.first : task.end - task.begin;
    reserve_sparingly(found_, count);
    carried_ = 0;
    for (const Task& task : tasks_) {
        const ShapeContact* const from =
            task.carries ? all_.data() + task.first : workers_[task.worker].found.data() + task.begin;
        const std::size_t some = task.carries ? task.last - task.first : task.end - task.begin;
        found_.insert(found_.end(), from, from + some);
        if (task.carries) carried_ += some;
    }
    const bool all_carried = !changed_ && carried_ == found_.size() && carried_ == all_.size();
    std::swap(all_, found_);
    reserve_sparingly(found_, count);
    for (Worker& worker : workers_) reserve_sparingly(worker.found, count); // one may find all
    pairs_.clear();
    for (const ShapeContact& contact : all_) {
        const auto [a, b] = std::minmax(contact.body_a, contact.body_b);
        if (pairs_.empty() || ids_of(pairs_.back()) != IdPair{a, b}) {
            reserve_growing(pairs_, pairs_.size() + 1);
            pairs_.push_back({a, b, 0, 0, VOX_PAIR_NEAR, 0, 0, 0});
        }
        if (contact.kind != VOX_CONSTRAINT_PROXIMITY) pairs_.back().state = VOX_PAIR_BEGAN;
    }
    is_unchanged_ = all_carried && std::ranges::none_of(pairs_, [](const vox_pair& pair) {
                        return pair.state == VOX_PAIR_NEAR; // which Pairs::repeat() has none of
                    });
    std::ranges::sort(pairs_, {}, ids_of);
}

void ShapeContacts::add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept {
    sources.shapes = all_;
}

} // namespace vox
