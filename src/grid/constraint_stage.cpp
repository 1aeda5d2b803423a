#include "grid/constraint_stage.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "grid/pairs.hpp"
#include "mesh/check.hpp"

#include <algorithm>

namespace vox {

namespace {

bool is_named(const vox_pair& pair, const vox_constraint_desc& desc) {
    return (desc.body_a == VOX_NULL_BODY || pair.body_a == desc.body_a || pair.body_b == desc.body_a) &&
           (desc.body_b == VOX_NULL_BODY ||
            std::minmax(desc.body_a, desc.body_b) == std::minmax(pair.body_a, pair.body_b));
}

// Throws unless the body is as it was in the step, positions aside.
void check_since_step(const MeshSlot* slot, vox_body id) {
    if (!slot || slot->edited)
        throw Error(VOX_ERROR_INVALID_STATE,
                    format("body %u was %s since the step", id, slot ? "edited" : "removed"));
    if (!slot->mesh.has_positions())
        throw MeshError(VOX_ERROR_INVALID_STATE, slot->mesh.body(id), " has no positions: bind some before");
}

} // namespace

void ConstraintStage::begin_step(bool last_succeeded) noexcept {
    constraints_.begin_step(last_succeeded);
    depths_may_carry_ = depths_.all && last_succeeded;
}

void ConstraintStage::carry(bool carried, bool all_carried, Counters& counters) noexcept {
    depths_may_carry_ = depths_may_carry_ && carried;
    depths_.all = depths_may_carry_ && all_carried;
    if (depths_.all) counters.carried_penetrations = penetrations_.all().size();
}

void ConstraintStage::clear(bool all) noexcept {
    penetrations_.clear();
    depths_ = {};
    depths_may_carry_ = false;
    constraints_.clear(all);
    if (all) trees_.forget_all();
}

void ConstraintStage::reserve(std::uint32_t body_count, std::uint64_t contact_count) {
    penetrations_.reserve(contact_count);
    depth().reserve(body_count, contact_count);
    constraints_.reserve(body_count, static_cast<std::size_t>(contact_count));
}

void ConstraintStage::prepare(const Body& body, const Topology& topology, bool folds) {
    trees_.add(body.mesh_id);
    trees_[body.mesh_id].update({&topology, body.tets, body.positions}, folds, nullptr);
}

DepthStage& ConstraintStage::depth() {
    return depth_ ? *depth_ : depth_.emplace(chosen_hits_.memory(), trees_);
}

// Outside of a step, bodies and topologies become those of now.
void ConstraintStage::renew(const Scene& scene) {
    for (std::size_t b = 0; b < scene.step.bodies.size(); ++b) {
        Body& body = scene.step.bodies[b];
        MeshSlot* const slot = scene.meshes.find(body.mesh_id);
        if (!slot) continue;
        Body now = slot->mesh.body(body.mesh_id);
        now.carried = body.carried;
        now.sensor = body.sensor; // a filter counts from the next step on
        now.filter = body.filter;
        if (body.tets.empty()) now.tets = {};
        body = now;
        scene.step.topologies[b] = &slot->mesh.topology();
    }
}

// Chooses pairs, none of them of a sensor. Returns whether all are chosen that have constraints.
bool ConstraintStage::choose_pairs(const vox_constraint_desc& desc, const Scene& scene) {
    if (!scene.in_step) renew(scene);
    const Array<Body>& bodies = scene.step.bodies;
    bool all = true;
    chosen_pairs_.assign(scene.pairs.size(), 0);
    chosen_bodies_.assign(bodies.size(), 0);
    for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
        const vox_pair& pair = scene.pairs[p];
        if (!is_named(pair, desc)) {
            all = false;
            continue;
        }
        std::uint32_t index[2]; // of the bodies, if they took part
        for (int i = 0; i < 2; ++i) {
            const vox_body id = i == 0 ? pair.body_a : pair.body_b;
            const MeshSlot* const slot = scene.meshes.find(id);
            index[i] = slot ? slot->body : MeshSlot::none;
            if (!scene.in_step && (index[i] != MeshSlot::none || pair.state != VOX_PAIR_ENDED))
                check_since_step(slot, id);
        }
        if (index[0] == MeshSlot::none || index[1] == MeshSlot::none) continue;
        const Body &a = bodies[index[0]], &b = bodies[index[1]];
        if (a.sensor || b.sensor) continue;
        if (desc.mask != 0 && !(desc.mask & (a.filter.category | b.filter.category))) {
            all = false;
            continue;
        }
        chosen_pairs_[p] = 1;
        for (const std::uint32_t i : index) chosen_bodies_[i] = !scene.in_step;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (chosen_bodies_[b]) check_finite(bodies[b]);
    return all;
}

// Penetrations of the chosen pairs. Those of the last step that may be carried over, or those of this step
// that are there already, stay.
void ConstraintStage::find_depths(const FoundDepths& wanted, const Scene& scene, Counters& counters) {
    if (wanted.all && depths_ == wanted) return;
    StepData& step = scene.step;
    const bool carry = wanted.all && depths_may_carry_ && depths_.method == wanted.method &&
                       depths_.closest_budget == wanted.closest_budget;
    for (std::size_t p = 0; p < scene.pairs.size(); ++p)
        if (chosen_pairs_[p] && scene.pairs[p].state != VOX_PAIR_ENDED)
            for (const vox_body id : {scene.pairs[p].body_a, scene.pairs[p].body_b}) {
                MeshSlot& slot = *scene.meshes.find(id);
                slot.mesh.make_topology();
                step.topologies[slot.body] = &slot.mesh.topology();
            }
    if (!wanted.all) {
        chosen_hits_.clear();
        PairIndex index(scene.pairs);
        for (std::size_t i = 0; i < step.contacts.size(); ++i)
            if (chosen_pairs_[index(step.contacts[i].body_a, step.contacts[i].body_b)])
                chosen_hits_.push_back(step.hits[i]);
    }
    depths_ = {};
    depths_may_carry_ = false;
    if (!carry)
        for (Body& body : step.bodies) body.carried = false;
    counters.leaving_edges = counters.edge_tests = 0;
    depth().find(step.bodies, step.topologies, wanted.all ? step.hits : chosen_hits_,
                 wanted.method == VOX_DEPTH_METHOD_CLOSEST, wanted.closest_budget, &scene.workers,
                 penetrations_, counters);
    counters.carried_penetrations = penetrations_.carried();
    depths_ = wanted;
}

void ConstraintStage::find(const vox_constraint_desc& desc, const Scene& scene, Counters& counters,
                           Profile& profile) {
    profile.depth_ns = profile.constraints_ns = 0;
    ConstraintSources sources{};
    sources.method = desc.method;
    sources.closest_budget = desc.closest_budget;
    sources.most_per_pair = most_per_pair_;
    {
        const Timed timed(profile.depth_ns);
        const bool all = choose_pairs(desc, scene), with_depth = desc.method != VOX_DEPTH_METHOD_NONE;
        if (with_depth) find_depths({all, desc.method, desc.closest_budget}, scene, counters);
        counters.penetrations = penetrations_.all().size();
        sources.bodies = scene.step.bodies;
        sources.topologies = scene.step.topologies;
        sources.pairs = scene.pairs;
        sources.chosen = chosen_pairs_;
        sources.hits = with_depth && !all ? chosen_hits_ : scene.step.hits;
        sources.penetrations = with_depth ? &penetrations_ : nullptr;
        scene.surfaces.add_to(sources, trees_, scene.workers);
    }
    const Timed timed(profile.constraints_ns);
    constraints_.find(sources, scene.workers);
    counters.constraints = constraints_.view().count;
    counters.constraints_left_out = constraints_.left_out();
    if (sources.penetrations && desc.closest_budget > 0)
        counters.unknown_penetrations = static_cast<std::uint64_t>(
            std::ranges::count(penetrations_.all(), VOX_DEPTH_UNKNOWN, &Penetration::state));
}

} // namespace vox
