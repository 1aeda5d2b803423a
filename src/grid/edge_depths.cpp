// The way out of edge contacts: from the middle of the part of an edge that is inside to the closest point of
// the surface.
#include "grid/edge_contacts.hpp"

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "exact/facet_normal.hpp"
#include "grid/constraints.hpp"
#include "grid/pairs.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

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
