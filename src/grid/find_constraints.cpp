// The constraints of the last step: which pairs are wanted, the depths of their contacts, and the records.
#include "grid/grid.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "mesh/check.hpp"

#include <algorithm>

using namespace vox;

namespace {

void check(const vox_constraint_desc& desc) {
    check_enum(desc.method, VOX_DEPTH_METHOD_NONE, "desc.method");
    if (desc.body_a == VOX_NULL_BODY && desc.body_b != VOX_NULL_BODY)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("desc.body_b is %u, but there is no body_a", desc.body_b));
}

} // namespace

void vox_grid::find_constraints(vox_constraint_desc desc) {
    check(desc);
    for (const vox_body body : {desc.body_a, desc.body_b})
        if (body != VOX_NULL_BODY) (void)mesh(body); // throws for an id that names no body
    if (!stepped_)
        throw Error(VOX_ERROR_INVALID_STATE, "there are no results of a step: call vox_grid_step first");
    make_constraints(desc, false, counters_, profile_);
    list_counters();
}

vox_constraint_view vox_grid::constraints() const {
    if (!constraints_.found())
        throw Error(VOX_ERROR_INVALID_STATE,
                    "no constraints were looked for since the last step: call vox_grid_find_constraints "
                    "after it, or set VOX_GRID_CONSTRAINTS");
    return constraints_.view();
}

// Chooses pairs, none of them of a sensor. Outside of a step, bodies and topologies become those of now, and
// a body of a chosen pair that is not as it was in the step is an error. Returns whether all pairs are chosen
// that have constraints.
bool vox_grid::choose_pairs(const vox_constraint_desc& desc, bool in_step) {
    if (!in_step)
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            MeshSlot* const slot = meshes_.find(bodies_[b].mesh_id);
            if (!slot) continue;
            Body now = slot->mesh.body(bodies_[b].mesh_id);
            now.carried = bodies_[b].carried;
            now.sensor = bodies_[b].sensor; // a filter counts from the next step on
            now.filter = bodies_[b].filter;
            if (bodies_[b].tets.empty()) now.tets = {};
            bodies_[b] = now;
            topologies_[b] = &slot->mesh.topology();
        }
    const std::span<const vox_pair> pairs = in_step ? pairs_.pending() : pairs_.all();
    bool all = true;
    chosen_pairs_.assign(pairs.size(), 0);
    chosen_bodies_.assign(bodies_.size(), 0);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const vox_pair& pair = pairs[p];
        const bool named =
            (desc.body_a == VOX_NULL_BODY || pair.body_a == desc.body_a || pair.body_b == desc.body_a) &&
            (desc.body_b == VOX_NULL_BODY ||
             std::minmax(desc.body_a, desc.body_b) == std::minmax(pair.body_a, pair.body_b));
        all = all && named;
        if (!named) continue;
        std::uint64_t categories = 0;
        bool complete = true, sensor = false;
        for (const vox_body id : {pair.body_a, pair.body_b}) {
            const MeshSlot* slot = meshes_.find(id);
            const bool took_part = slot && slot->body != MeshSlot::none;
            complete = complete && took_part;
            if (took_part) {
                const Body& body = bodies_[slot->body];
                categories |= body.filter.category;
                sensor = sensor || body.sensor;
            }
            if (in_step || (pair.state == VOX_PAIR_ENDED && !took_part)) continue;
            if (!slot || slot->edited)
                throw Error(VOX_ERROR_INVALID_STATE,
                            format("body %u was %s since the step", id, slot ? "edited" : "removed"));
            if (!slot->mesh.has_positions())
                throw MeshError(VOX_ERROR_INVALID_STATE, slot->mesh.body(id),
                                " has no positions: bind some before");
        }
        if (!complete || sensor) continue;
        if (desc.mask != 0 && !(desc.mask & categories)) {
            all = false;
            continue;
        }
        chosen_pairs_[p] = 1;
        if (in_step) continue;
        for (const vox_body id : {pair.body_a, pair.body_b}) chosen_bodies_[meshes_.find(id)->body] = 1;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (chosen_bodies_[b]) check_finite(bodies_[b]);
    return all;
}

// Penetrations of the chosen pairs. Those of the last step that may be carried over, or those of this step
// that are there already, stay.
void vox_grid::find_depths(const FoundDepths& wanted, Counters& counters) {
    if (wanted.all && depths_ == wanted) return;
    const bool carry = wanted.all && depths_may_carry_ && depths_.method == wanted.method &&
                       depths_.closest_budget == wanted.closest_budget;
    if (!depth_) depth_.emplace(&memory_, trees_);
    const std::span<const vox_pair> pairs = pairs_.pending();
    for (std::size_t p = 0; p < pairs.size(); ++p)
        if (chosen_pairs_[p] && pairs[p].state != VOX_PAIR_ENDED)
            for (const vox_body id : {pairs[p].body_a, pairs[p].body_b}) {
                MeshSlot& slot = *meshes_.find(id);
                slot.mesh.make_topology();
                topologies_[slot.body] = &slot.mesh.topology();
            }
    std::span<const Hit> hits = hits_;
    if (!wanted.all) {
        chosen_hits_.clear();
        PairIndex index(pairs);
        for (std::size_t i = 0; i < contacts_.size(); ++i)
            if (chosen_pairs_[index(contacts_[i].body_a, contacts_[i].body_b)])
                chosen_hits_.push_back(hits_[i]);
        hits = chosen_hits_;
    }
    depths_ = {};
    depths_may_carry_ = false;
    if (!carry)
        for (Body& body : bodies_) body.carried = false;
    counters.leaving_edges = counters.edge_tests = 0;
    depth_->find(bodies_, topologies_, hits, wanted.method == VOX_DEPTH_METHOD_CLOSEST, wanted.closest_budget,
                 &workers_, penetrations_, counters);
    counters.carried_penetrations = penetrations_.carried();
    depths_ = wanted;
}

void vox_grid::make_constraints(const vox_constraint_desc& desc, bool in_step, Counters& counters,
                                Profile& profile) {
    const std::uint64_t start = nanoseconds();
    const bool all = choose_pairs(desc, in_step);
    const std::span<const vox_pair> pairs = pairs_.pending();
    const bool with_depth = desc.method != VOX_DEPTH_METHOD_NONE;
    if (with_depth) find_depths({all, desc.method, desc.closest_budget}, counters);
    counters.penetrations = penetrations_.all().size();
    const bool with_edges = edges_ && !edges_->all().empty();
    if (with_depth && with_edges) find_edge_depths();
    const std::uint64_t depths_found = nanoseconds();
    profile.depth_ns = depths_found - start;

    ConstraintSources sources{};
    sources.bodies = bodies_;
    sources.topologies = topologies_;
    sources.pairs = pairs;
    sources.chosen = chosen_pairs_;
    sources.hits = with_depth && !all ? chosen_hits_ : hits_;
    sources.penetrations = with_depth ? &penetrations_ : nullptr;
    sources.method = desc.method;
    sources.closest_budget = desc.closest_budget;
    if (with_edges) {
        sources.edges = edges_->all();
        if (with_depth) sources.edge_depths = edges_->depths();
    }
    if (proximities_) sources.proximities = proximities_->all();
    if (impacts_) {
        sources.meetings = impacts_->meetings();
        sources.impacts = impacts_->all();
    }
    constraints_.find(sources, workers_);
    profile.constraints_ns = nanoseconds() - depths_found;
    counters.constraints = constraints_.view().count;
    if (with_depth && desc.closest_budget > 0)
        counters.unknown_penetrations = static_cast<std::uint64_t>(
            std::ranges::count(penetrations_.all(), VOX_DEPTH_UNKNOWN, &Penetration::state));
    if (with_depth && counters.unknown_penetrations > 0)
        warn("%llu of %llu penetrations are unknown: the closest_budget of %llu was used up",
             llu(counters.unknown_penetrations), llu(counters.penetrations), llu(desc.closest_budget));
}

// ---- depths of edges -------------------------------------------------------------------------------

// The way out for the edges of the chosen pairs.
void vox_grid::find_edge_depths() {
    PairIndex index(pairs_.pending());
    Array<EdgeBody>& bodies = edge_bodies_;
    bodies.clear();
    reserve_growing(bodies, 2 * edges_->pairs().size());
    for (const IdPair& pair : edges_->pairs()) {
        if (!chosen_pairs_[index(pair.body_a, pair.body_b)]) continue;
        for (const vox_body id : {pair.body_a, pair.body_b})
            bodies.push_back({bodies_[meshes_.find(id)->body], nullptr});
    }
    const auto id_of_body = [](const EdgeBody& b) { return b.body.mesh_id; };
    std::ranges::sort(bodies, {}, id_of_body);
    const auto same = [](const EdgeBody& a, const EdgeBody& b) { return a.body.mesh_id == b.body.mesh_id; };
    bodies.erase(std::unique(bodies.begin(), bodies.end(), same), bodies.end());

    Array<vox_body>& entered = entered_bodies_;
    entered.clear();
    for (const EdgeContact& contact : edges_->all())
        if (contact.body_a != contact.body_b && (entered.empty() || entered.back() != contact.body_b))
            entered.push_back(contact.body_b);
    std::ranges::sort(entered);
    entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
    erase_if(entered, [&](vox_body id) { return !std::ranges::binary_search(bodies, id, {}, id_of_body); });
    for (const vox_body id : entered) trees_.add(id); // which moves those of others
    for (const vox_body id : entered) {
        EdgeBody& b = *std::ranges::lower_bound(bodies, id, {}, id_of_body);
        depth::SurfaceTree& tree = trees_[id];
        tree.update({&mesh(id).topology(), b.body.tets, b.body.positions}, false, &workers_);
        b.tree = &tree;
    }
    edges_->prepare_depths(bodies, workers_);
}
