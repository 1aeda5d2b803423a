// Points are searched in the order of a Z-shaped curve, in chunks that do not depend on the workers: each
// search within a chunk begins with the triangle that the last one found.
#include "depth/fallback.hpp"

#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "exact/facet_normal.hpp"

#include <algorithm>
#include <tuple>

namespace vox::depth {

namespace {

constexpr std::size_t chunk_size = 64;

} // namespace

bool Scene::needs_search(std::uint32_t place) const {
    const vox_depth_state state = penetrations.of(place).state;
    return (state == VOX_DEPTH_CLOSEST || state == VOX_DEPTH_AMBIGUOUS) &&
           !penetrations.depth_of(place).has_answer();
}

Fallback::Fallback(std::pmr::memory_resource* memory, SurfaceTrees& trees)
    : trees_(trees), tree_of_body_(memory), used_(memory), items_(memory), places_(memory), chunks_(memory),
      workers_(memory) {}

Fallback::Searched Fallback::find(const Scene& scene, std::uint64_t budget, Workers* workers,
                                  Counts& counts) {
    items_.clear();
    const std::uint64_t unknown = spend(scene, budget);
    if (items_.empty()) return {0, unknown};

    workers_.grow(workers ? workers->count() : 1);
    for (Worker& worker : workers_) worker.counts = {};
    update_trees(scene, workers);
    sort_items(scene);
    list_chunks();
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
        for (std::size_t i = begin; i < end; ++i) search(scene, i, workers_[worker]);
    };
    constexpr std::size_t least = 8; // chunks that are worth a task
    for_ranges(workers, chunks_.size(), least, run);
    workers_.level();
    for (const Worker& worker : workers_) counts.closest_tests += worker.counts.closest_tests;
    return {items_.size(), unknown};
}

// Lists the points that are searched, and returns how many others become UNKNOWN.
std::uint64_t Fallback::spend(const Scene& scene, std::uint64_t budget) {
    std::uint64_t wanted = 0;
    for (const std::uint32_t place : scene.places) wanted += scene.needs_search(place);
    std::uint64_t end = ~std::uint64_t{0}; // the first place for which nothing is left
    reserve_growing(items_, wanted);       // there are never more, nor more chunks
    reserve_growing(chunks_, wanted);
    if (budget > 0) reserve_growing(places_, wanted);
    if (budget > 0 && wanted > budget) {
        places_.clear();
        for (const std::uint32_t place : scene.places)
            if (scene.needs_search(place)) places_.push_back(place);
        const auto first_out = places_.begin() + static_cast<std::ptrdiff_t>(budget);
        std::nth_element(places_.begin(), first_out, places_.end());
        end = *first_out;
    }
    for (const std::uint32_t place : scene.places) {
        if (!scene.needs_search(place)) continue;
        const Hit& hit = scene.hit(place);
        if (place < end) {
            items_.push_back({hit.body_b, SurfaceTree::all_parts, 0, place});
        } else {
            scene.penetrations.of(place).state = VOX_DEPTH_UNKNOWN;
            scene.penetrations.depth_of(place).set(0, facet_normal(scene.solid(hit.body_b), hit.tet, 0));
        }
    }
    return wanted - items_.size();
}

// The trees of all bodies that points are searched in, fitted to their positions.
void Fallback::update_trees(const Scene& scene, Workers* workers) {
    tree_of_body_.assign(scene.bodies.size(), {});
    for (const Item& item : items_) {
        if (scene.topologies[item.body_b]->triangles.empty()) continue;
        BodyTree& tree = tree_of_body_[item.body_b];
        tree.is_wanted = true;
        tree.folds |= scene.hit(item.place).body_a == item.body_b;
    }
    used_.clear();
    used_.reserve(scene.bodies.size());
    for (std::uint32_t b = 0; b < tree_of_body_.size(); ++b)
        if (tree_of_body_[b].is_wanted) {
            trees_.add(scene.bodies[b].mesh_id);
            used_.push_back(b);
        }
    for (const std::uint32_t b : used_) tree_of_body_[b].tree = &trees_[scene.bodies[b].mesh_id];
    // Workers share one or two large trees, and otherwise each takes some of the trees. To share one takes a
    // few tasks, so their number is limited to stay below VOX_MAX_TASKS.
    constexpr std::size_t least_shared = 4096, most_shared = 2; // triangles, trees
    const auto has_many = [&](std::uint32_t b) {
        return scene.topologies[b]->triangles.size() >= least_shared;
    };
    const auto large = static_cast<std::size_t>(std::ranges::count_if(used_, has_many));
    const bool shares = workers && large <= most_shared;
    const auto is_large = [&](std::uint32_t b) { return shares && has_many(b); };
    const auto update = [&](std::uint32_t b, Workers* shared) {
        tree_of_body_[b].tree->update(scene.solid(b), tree_of_body_[b].folds, shared);
    };
    for (const std::uint32_t b : used_)
        if (is_large(b)) update(b, workers);
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i)
            if (!is_large(used_[i])) update(used_[i], nullptr);
    };
    for_ranges(used_.size() > (shares ? large : 0) + 1 ? workers : nullptr, used_.size(), 1, run);
}

void Fallback::sort_items(const Scene& scene) {
    for (Item& item : items_) {
        const SurfaceTree* tree = tree_of_body_[item.body_b].tree;
        if (!tree) continue;
        const Hit& hit = scene.hit(item.place);
        if (hit.body_a == hit.body_b) item.part = tree->part_of(hit.tet);
        item.code = tree->place_on_curve(scene.position(hit));
    }
    std::sort(items_.begin(), items_.end(), [](const Item& x, const Item& y) {
        return std::tie(x.body_b, x.part, x.code, x.place) < std::tie(y.body_b, y.part, y.code, y.place);
    });
}

void Fallback::list_chunks() {
    chunks_.clear();
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const bool fits = i > 0 && i - chunks_.back() < chunk_size &&
                          items_[i].body_b == items_[i - 1].body_b && items_[i].part == items_[i - 1].part;
        if (!fits) chunks_.push_back(static_cast<std::uint32_t>(i));
    }
}

void Fallback::search(const Scene& scene, std::size_t chunk, Worker& worker) const {
    const std::size_t first = chunks_[chunk],
                      last = chunk + 1 < chunks_.size() ? chunks_[chunk + 1] : items_.size();
    const SurfaceTree* tree = tree_of_body_[items_[first].body_b].tree;
    SearchState state;
    for (std::size_t i = first; i < last; ++i) search_one(scene, items_[i], tree, state, worker);
    worker.counts.closest_tests += state.visited;
}

void Fallback::search_one(const Scene& scene, const Item& item, const SurfaceTree* tree, SearchState& state,
                          Worker& worker) const {
    const Hit& hit = scene.hit(item.place);
    const bool self = hit.body_a == hit.body_b;
    const std::uint32_t tet = hit.tet;
    vox_depth_state& point_state = scene.penetrations.of(item.place).state;
    Depth& out = scene.penetrations.depth_of(item.place);
    const Vec3d p = scene.position(hit);
    const Solid solid = scene.solid(item.body_b);
    Closest closest;
    const bool is_crossing = point_state == VOX_DEPTH_AMBIGUOUS;
    const bool found = tree && (!self         ? tree->find(p, SurfaceTree::no_vertex, state, closest)
                                : is_crossing ? tree->find_in_part(p, hit.vertex, tet, state, closest)
                                              : tree->find_in_fold(p, hit.vertex, tet, state, closest));
    // For a vertex in its own mesh it has to be the point of the fold, which this one need not be.
    if (found && !(self && is_crossing)) scene.penetrations.closest_of(item.place) = closest.at.triangle;
    const Stretch stretch(found ? closest.way : Vec3d{0, 0, 0});
    Vec3d direction = stretch.direction;
    if (stretch.length > 0) return out.set(stretch.length, direction);
    if (found) { // on the surface of a part of b that overlaps the part with the hit
        point_state = VOX_DEPTH_TOUCHING;
        worker.normals.begin(solid);
        const Vec3d apex = solid.at(solid.topology->triangles[closest.at.triangle].apex);
        direction = worker.normals.at(closest.at, p - apex);
    }
    if (!(length(direction) > 0)) direction = facet_normal(solid, tet, 0);
    out.set(0, direction);
}

} // namespace vox::depth
