// One step of a grid: gather the bodies, detect, contacts, depth, pairs.
#include "grid/grid.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>

using namespace vox;

void vox_grid::step() {
    const std::uint64_t start = nanoseconds();
    bool carry = contacts_hold_;
    contacts_hold_ = meshes_hold_ = false;
    hits_.clear();
    pairs_.hide();
    constraints_.begin_step(stepped_);
    const bool had_depths = depths_.all && stepped_;
    depths_may_carry_ = stepped_ = false;
    failure_ = {};
    left_out_.clear();
    if (impacts_ && !impacts_->any_bound()) {
        impacts_.reset();
        look_near();
    }
    ++epoch_;

    Counters counters{};
    Profile profile{};
    try {
        detect(carry, counters, profile);
        drop_removed_vertices();

        const std::uint64_t detected = nanoseconds();
        if (carry && counters.moved_bodies < bodies_.size()) counters.carried_contacts = carry_contacts();
        // If every old contact was carried and no new one found, contacts, depth and pairs are unchanged.
        const bool all_carried =
            counters.carried_contacts == contacts_.size() && hits_.size() == contacts_.size();
        if (!all_carried) make_contacts(bodies_, hits_, contacts_, &workers_, &interiors_);
        std::uint64_t contacts_made = nanoseconds();
        profile.contacts_ns = contacts_made - detected;
        const bool same_edges = !finds_surfaces() || search_surfaces(counters, profile);
        contacts_made += profile.edges_ns + profile.margin_ns;

        // If every contact was carried, so are the depths.
        if (!(carry && all_carried && had_depths)) depths_.all = false;
        depths_may_carry_ = carry && had_depths;
        if (depths_.all) counters.carried_penetrations = penetrations_.all().size();

        if (carry && all_carried && same_edges && !near_faces_)
            pairs_.repeat();
        else
            pairs_.update(contacts_, touching_pairs(),
                          proximities_ ? proximities_->pairs() : std::span<const IdPair>(),
                          meshes_.slot_count(), [this](vox_body id) { return mesh(id).user_data(); });
        profile.pairs_ns = nanoseconds() - contacts_made;
        if (finds_constraints_) make_constraints({}, true, counters, profile);
    } catch (const MeshError& error) {
        forget_contacts();
        failure_ = failure_of(error.result(), error.mesh, error.vertex);
        throw;
    } catch (...) {
        forget_contacts();
        throw;
    }

    counters.bodies = static_cast<std::uint32_t>(bodies_.size());
    for (const Body& body : bodies_) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size() - body.off_count;
        counters.bodies_without_tets += body.tets.empty() && body.vertex_count > 0;
    }
    counters.skipped_bodies = left_out_.size();
    counters.contacts = contacts_.size();
    pairs_.commit();
    pairs_.count(counters);
    if (chooses_cell_size() && !fast_) {
        adaptive_.observe(counters);
        counters.cell_size_changes = adaptive_.changes();
    }
    counters_ = counters;
    profile.step_ns = nanoseconds() - start;
    profile_ = profile;
    list_counters();
    stepped_ = true;
    contacts_hold_ = fast_;
    meshes_hold_ = fast_ && left_out_.empty();
}

// Pairs that touch by edges, or by vertices that went through.
std::span<const IdPair> vox_grid::touching_pairs() {
    const auto edges = edges_ ? edges_->pairs() : std::span<const IdPair>();
    const auto impacts = impacts_ ? impacts_->pairs() : std::span<const IdPair>();
    if (impacts.empty()) return edges;
    touching_pairs_.clear();
    reserve_growing(touching_pairs_, edges.size() + impacts.size());
    touching_pairs_.resize(edges.size() + impacts.size());
    std::ranges::merge(edges, impacts, touching_pairs_.begin());
    touching_pairs_.erase(std::unique(touching_pairs_.begin(), touching_pairs_.end()), touching_pairs_.end());
    return touching_pairs_;
}

// Edges through faces, vertices through faces, and vertices near faces that they are not inside of. Returns
// whether there are the same edges as in the last step, or none are looked for.
bool vox_grid::search_surfaces(Counters& counters, Profile& profile) {
    const std::uint64_t start = nanoseconds();
    StepScene scene{bodies_, topologies_, surface_versions_, &workers_, contacts_};
    if (fast_)
        fast_engine_.fill(scene);
    else
        streamed_.fill(prepared_, scene);
    if (edges_) {
        edges_->find(scene, features_);
        edges_->count(counters);
        profile.edges_ns = nanoseconds() - start;
    }
    if (impacts_) {
        impacts_->find(scene, *near_faces_);
        impacts_->count(counters);
    }
    if (proximities_) {
        proximities_->find(scene, *near_faces_);
        proximities_->count(counters);
    }
    if (near_faces_) profile.margin_ns = nanoseconds() - start - profile.edges_ns;
    return !edges_ || edges_->unchanged();
}

void vox_grid::forget_contacts() noexcept {
    if (edges_) edges_->clear();
    if (proximities_) proximities_->clear();
    if (impacts_) impacts_->clear();
    contacts_.clear();
    interiors_.clear();
    penetrations_.clear();
    depths_ = {};
    constraints_.clear(false);
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
        if (!skips_bad_meshes_ || error.vertex == VOX_NONE) throw;
    }
    leave_out_bad_meshes();
    carry = false;
    hits_.clear();
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
    return skips_bad_meshes_ && first_bad_vertex(body) != VOX_NONE;
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
    bodies_.clear();
    topologies_.clear();
    surface_versions_.clear();
    prepared_.clear();
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
            slot.left_out = skips_bad_meshes_ && vertex != VOX_NONE;
            if (slot.left_out) {
                left_out_.push_back(failure_of(bad_position(mesh.body(id), vertex), id, vertex));
                return;
            }
        }
        slot.body = static_cast<std::uint32_t>(bodies_.size());
        // What edits invalidated, and what meshes inserted without positions lack.
        mesh.make_rings();
        prepare(mesh, slot.state);
        Body& body = bodies_.emplace_back(mesh.body(id));
        if (body.off_count == body.tets.size()) { // the stages need not look at them
            body.tets = {};
            body.off_count = 0;
        }
        topologies_.push_back(&mesh.topology());
        if (finds_surfaces()) surface_versions_.push_back({mesh.topology_version(), mesh.tiles_version()});
        slot.edited = false;
        if (fast_ || finds_surfaces())
            prepared_.push_back({&mesh.tiled().tiles, &mesh.tiled().boundary, &slot.state});
    });
}

// Removed vertices make no contacts.
void vox_grid::drop_removed_vertices() {
    if (std::all_of(bodies_.begin(), bodies_.end(),
                    [](const Body& body) { return body.removed_vertices.empty(); }))
        return;
    erase_if(hits_,
             [this](const Hit& hit) { return has_bit(bodies_[hit.body_a].removed_vertices, hit.vertex); });
}

void vox_grid::detect_fast(bool carry, Counters& counters, Profile& profile) {
    // The engine chooses a cell size for each of its windows unless one is set.
    const FastSettings settings{.cell_size = requested_cell_size_,
                                .workers = &workers_,
                                .carry = carry,
                                .keep_certified = edges_.has_value()};
    fast_engine_.detect(bodies_, prepared_, settings, hits_, counters, profile);
    if (chooses_cell_size()) used_cell_size_ = fast_engine_.cell_size();
}

// Appends the contacts of the last step between meshes that have not moved as hits, and returns how many.
// Either all contacts of a vertex with a mesh are carried or none, so they become the same contacts again.
std::uint64_t vox_grid::carry_contacts() {
    const std::size_t found = hits_.size();
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) bodies_[b].carried = !fast_engine_.moved(b);
    const auto resting_body = [this](vox_body id) {
        const MeshSlot* slot = meshes_.find(id);
        return slot && slot->body != MeshSlot::none && bodies_[slot->body].carried ? slot->body
                                                                                   : MeshSlot::none;
    };
    for (const vox_contact& contact : contacts_) {
        Hit hit{};
        hit.body_a = resting_body(contact.body_a);
        hit.body_b = resting_body(contact.body_b);
        if (hit.body_a == MeshSlot::none || hit.body_b == MeshSlot::none) continue;
        hit.vertex = contact.vertex;
        hit.tet = contact.tet & 0x7fffffffu;
        hit.interior = interiors_[static_cast<std::size_t>(&contact - contacts_.data())] != 0;
        reserve_sparingly(hits_, hits_.size() + 1);
        hits_.push_back(hit);
    }
    return hits_.size() - found;
}

void vox_grid::detect_reference(Counters& counters, Profile& profile) {
    choose_cell_size();
    counters.moved_bodies = bodies_.size();
    reference_.detect(bodies_, settings_, hits_, counters, profile);
}

void vox_grid::choose_cell_size() {
    settings_.cell_size = requested_cell_size_;
    settings_.levels = {};
    if (!chooses_cell_size()) return;
    const double before = used_cell_size_;
    const std::uint64_t changes = adaptive_.changes();
    settings_.levels = adaptive_.cell_sizes(bodies_, settings_.dense, byte_limit(), &memory_);
    used_cell_size_ = settings_.levels[0].cell_size;
    if (before > 0 && adaptive_.changes() == changes) return;
    if (!log_.write) return;
    std::string text = format("cell size %.9g", used_cell_size_);
    for (std::size_t l = 1; l < settings_.levels.size(); ++l)
        text += format(", %.9g", settings_.levels[l].cell_size);
    text += before > 0 ? format(" after %.9g,", before) : " chosen";
    write_log(VOX_LOG_INFO,
              format("%s for %llu tets in %zu meshes", text.c_str(), llu(meshes_.tet_count()), bodies_.size())
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
