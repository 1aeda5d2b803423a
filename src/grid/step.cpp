// One step of a grid: gather the bodies, detect, contacts, depth, pairs.
#include "grid/grid.hpp"

#include "base/clock.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"

#include <algorithm>

using namespace vox;

void vox_grid::step() {
    bool carry = contacts_hold_;
    begin_step();
    Counters counters{};
    Profile profile{};
    try {
        const Timed timed(profile.step_ns);
        detect(carry, counters, profile);
        drop_removed_vertices();
        const bool all_carried = make_contacts(carry, counters, profile);
        const bool same_surfaces = search_surfaces(counters, profile);
        constraints_->carry(carry, all_carried, counters);
        {
            const Timed pairs_timed(profile.pairs_ns);
            if (carry && all_carried && same_surfaces)
                pairs_.repeat();
            else
                pairs_.update(
                    step_.contacts, [this](const auto& add) { surfaces_.for_pairs(add); },
                    meshes_.slot_count(), [this](vox_body id) { return body(id).user_data(); });
        }
        if (finds_constraints()) make_constraints({}, true, counters, profile);
        count(counters);
    } catch (const MeshError& error) {
        forget_contacts();
        failure_ = failure_of(error.result(), error.mesh, error.vertex);
        throw;
    } catch (...) {
        forget_contacts();
        throw;
    }
    pairs_.commit();
    pairs_.count(counters);
    if (chooses_cell_size() && !fast_) {
        adaptive_.observe(counters);
        counters.cell_size_changes = adaptive_.changes();
    }
    counters_ = counters;
    profile_ = profile;
    list_counters();
    stepped_ = true;
    contacts_hold_ = fast_;
    meshes_hold_ = fast_ && left_out_.empty();
}

void vox_grid::begin_step() noexcept {
    contacts_hold_ = meshes_hold_ = false;
    step_.hits.clear();
    pairs_.hide();
    constraints_->begin_step(stepped_);
    stepped_ = false;
    failure_ = {};
    left_out_.clear();
    drop_unused();
    ++epoch_;
}

// Returns whether every old contact was carried and no new one found: then contacts, depths and pairs are
// those of the last step.
bool vox_grid::make_contacts(bool carry, Counters& counters, Profile& profile) {
    const Timed timed(profile.contacts_ns);
    if (carry && counters.moved_bodies < step_.bodies.size()) counters.carried_contacts = carry_contacts();
    const std::size_t had = step_.contacts.size();
    if (counters.carried_contacts == had && step_.hits.size() == had) return true;
    vox::make_contacts(step_.bodies, step_.hits, step_.contacts, &workers_, &step_.interiors);
    return false;
}

// Contacts that stages over surfaces find. Returns whether they are those of the last step.
bool vox_grid::search_surfaces(Counters& counters, Profile& profile) {
    StepScene scene{step_.bodies, step_.topologies, step_.versions, &workers_, step_.contacts};
    const auto fill = [this](StepScene& filled, StreamedScene& streamed) {
        if (fast_)
            fast_engine_.fill(filled);
        else
            streamed.fill(step_.prepared, filled);
    };
    return surfaces_.find(scene, fill, counters, profile);
}

void vox_grid::make_constraints(const vox_constraint_desc& desc, bool in_step, Counters& counters,
                                Profile& profile) {
    constraints_->find(desc, {step_, meshes_, pairs_.pending(), surfaces_, workers_, in_step}, counters,
                       profile);
    if (desc.method != VOX_DEPTH_METHOD_NONE && counters.unknown_penetrations > 0)
        warn("%llu of %llu penetrations are unknown: the closest_budget of %llu was used up",
             llu(counters.unknown_penetrations), llu(counters.penetrations), llu(desc.closest_budget));
}

void vox_grid::count(Counters& counters) {
    counters.bodies = static_cast<std::uint32_t>(step_.bodies.size());
    for (const Body& body : step_.bodies) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size() - body.off_count;
        counters.bodies_without_tets += body.tets.empty() && body.vertex_count > 0;
    }
    counters.skipped_bodies = left_out_.size();
    counters.contacts = step_.contacts.size();
}

void vox_grid::forget_contacts() noexcept {
    surfaces_.clear();
    step_.contacts.clear();
    step_.interiors.clear();
    constraints_->clear(false);
    left_out_.clear();
}

// Finds the hits. If a coordinate of a mesh makes that fail, it starts again without all such meshes, where
// the flags ask for that. Then nothing is carried over, as the engine may have taken in the positions of
// others already.
void vox_grid::detect(bool& carry, Counters& counters, Profile& profile) {
    const auto detect_once = [&] {
        gather_bodies(counters);
        if (fast_)
            detect_fast(carry, counters, profile);
        else
            detect_reference(counters, profile);
    };
    try {
        return detect_once();
    } catch (const MeshError& error) {
        if (!skips_bad_meshes() || error.vertex == VOX_NONE) throw;
    }
    leave_out_bad_meshes();
    carry = false;
    step_.hits.clear();
    detect_once();
}

// Marks those that gather_bodies() leaves out, from now until they are well again.
void vox_grid::leave_out_bad_meshes() {
    meshes_.for_each([&](vox_body id, MeshSlot& slot) {
        if (slot.body == MeshSlot::none) return;
        const Body body = slot.mesh.body(id);
        const std::uint32_t vertex = first_bad_vertex(body);
        if (vertex == VOX_NONE) return;
        slot.left_out = true;
        slot.state.invalidate_positions(); // a later step must not take it for one at rest
        if (log_.write) warn("left out of the step: %s", position_error(body, vertex).what());
    });
}

bool vox_grid::is_left_out(const Body& body) const noexcept {
    return skips_bad_meshes() && first_bad_vertex(body) != VOX_NONE;
}

vox_failure vox_grid::failure_of(vox_result result, vox_body id, std::uint32_t vertex) const noexcept {
    vox_failure failure{};
    failure.result = result;
    failure.body = id;
    failure.vertex = vertex;
    if (const MeshSlot* slot = meshes_.find(id)) {
        failure.user_data = slot->mesh.user_data();
        if (vertex < slot->mesh.vertex_count()) {
            const Vec3d p = slot->mesh.body(id).positions.exact(vertex);
            failure.position[0] = p.x, failure.position[1] = p.y, failure.position[2] = p.z;
        }
    }
    return failure;
}

void vox_grid::gather_bodies(Counters& counters) {
    counters.disabled_bodies = 0;
    left_out_.clear();
    step_.bodies.clear();
    step_.topologies.clear();
    step_.versions.clear();
    step_.prepared.clear();
    meshes_.for_each([&](vox_body id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        slot.body = MeshSlot::none;
        if (!mesh.is_enabled()) {
            ++counters.disabled_bodies;
            return;
        }
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, mesh.body(id),
                            " has no positions: bind some before the step");
        mesh.check_format_once(id);
        if (slot.left_out) { // looked at before the engine does, as others may be at rest
            const std::uint32_t vertex = first_bad_vertex(mesh.body(id));
            slot.left_out = skips_bad_meshes() && vertex != VOX_NONE;
            if (slot.left_out) {
                left_out_.push_back(failure_of(bad_position(mesh.body(id), vertex), id, vertex));
                return;
            }
        }
        slot.body = static_cast<std::uint32_t>(step_.bodies.size());
        // What edits invalidated, and what meshes inserted without positions lack.
        mesh.make_rings();
        prepare(mesh, slot.state);
        Body& body = step_.bodies.emplace_back(mesh.body(id));
        if (body.off_count == body.tets.size()) { // the stages need not look at them
            body.tets = {};
            body.off_count = 0;
        }
        step_.topologies.push_back(&mesh.topology());
        if (surfaces_.any()) step_.versions.push_back({mesh.topology_version(), mesh.tiles_version()});
        slot.edited = false;
        if (fast_ || surfaces_.any())
            step_.prepared.push_back({&mesh.tiled().tiles, &mesh.tiled().boundary, &slot.state});
    });
}

// Removed vertices make no contacts.
void vox_grid::drop_removed_vertices() {
    if (std::all_of(step_.bodies.begin(), step_.bodies.end(),
                    [](const Body& body) { return body.removed_vertices.empty(); }))
        return;
    erase_if(step_.hits, [this](const Hit& hit) {
        return has_bit(step_.bodies[hit.body_a].removed_vertices, hit.vertex);
    });
}

void vox_grid::detect_fast(bool carry, Counters& counters, Profile& profile) {
    // The engine chooses a cell size for each of its windows unless one is set.
    const FastSettings settings{.cell_size = requested_cell_size_,
                                .workers = &workers_,
                                .carry = carry,
                                .keep_certified = (flags_ & VOX_GRID_EDGES) != 0};
    fast_engine_.detect(step_.bodies, step_.prepared, settings, step_.hits, counters, profile);
    if (chooses_cell_size()) used_cell_size_ = fast_engine_.cell_size();
}

// Appends the contacts of the last step between meshes that have not moved as hits, and returns how many.
// Either all contacts of a vertex with a mesh are carried or none, so they become the same contacts again.
std::uint64_t vox_grid::carry_contacts() {
    const std::size_t found = step_.hits.size();
    for (std::uint32_t b = 0; b < step_.bodies.size(); ++b) step_.bodies[b].carried = !fast_engine_.moved(b);
    const auto resting_body = [this](vox_body id) {
        const MeshSlot* slot = meshes_.find(id);
        return slot && slot->body != MeshSlot::none && step_.bodies[slot->body].carried ? slot->body
                                                                                        : MeshSlot::none;
    };
    for (const vox_contact& contact : step_.contacts) {
        Hit hit{};
        hit.body_a = resting_body(contact.body_a);
        hit.body_b = resting_body(contact.body_b);
        if (hit.body_a == MeshSlot::none || hit.body_b == MeshSlot::none) continue;
        hit.vertex = contact.vertex;
        hit.tet = contact.tet & 0x7fffffffu;
        hit.interior = step_.interiors[static_cast<std::size_t>(&contact - step_.contacts.data())] != 0;
        reserve_sparingly(step_.hits, step_.hits.size() + 1);
        step_.hits.push_back(hit);
    }
    return step_.hits.size() - found;
}

void vox_grid::detect_reference(Counters& counters, Profile& profile) {
    choose_cell_size();
    counters.moved_bodies = step_.bodies.size();
    reference_.detect(step_.bodies, settings_, step_.hits, counters, profile);
}

void vox_grid::choose_cell_size() {
    settings_.cell_size = requested_cell_size_;
    settings_.levels = {};
    if (!chooses_cell_size()) return;
    const double before = used_cell_size_;
    const std::uint64_t changes = adaptive_.changes();
    settings_.levels = adaptive_.cell_sizes(step_.bodies, settings_.dense, byte_limit(), &memory_);
    used_cell_size_ = settings_.levels[0].cell_size;
    if (before > 0 && adaptive_.changes() == changes) return;
    if (!log_.write) return;
    std::string text = format("cell size %.9g", used_cell_size_);
    for (std::size_t l = 1; l < settings_.levels.size(); ++l)
        text += format(", %.9g", settings_.levels[l].cell_size);
    text += before > 0 ? format(" after %.9g,", before) : " chosen";
    write_log(VOX_LOG_INFO, format("%s for %llu tets in %zu meshes", text.c_str(), llu(meshes_.tet_count()),
                                   step_.bodies.size())
                                .c_str());
}

// The most bytes that cells of dense storage may take: the budget less what the grid holds beside them, and
// less what a first step will take. 0: no limit.
double vox_grid::byte_limit() const noexcept {
    if (memory_.budget() == UINT64_MAX) return 0;
    double held = static_cast<double>(memory_.bytes());
    if (counters_.vertices == 0) // of positions, links and cells, and of boxes
        held +=
            40 * static_cast<double>(meshes_.vertex_count()) + 24 * static_cast<double>(meshes_.tet_count());
    else
        held -= static_cast<double>(reference_.cells().bucket_bytes());
    return std::max(0.9 * (static_cast<double>(memory_.budget()) - held), 4.0);
}
