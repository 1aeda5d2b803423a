// One step of a grid: gather the bodies, detect, contacts, depth, events.
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
    events_.hide_pairs();
    events_.hide_events();
    readings_.invalidate();
    failure_ = {};
    left_out_.clear();
    if (passages_ && !passages_->any_bound()) {
        passages_.reset();
        look_near();
    }
    ++epoch_;

    Counters counters{};
    Profile profile{};
    try {
        detect(carry, counters, profile);
        drop_removed_vertices();

        const std::uint64_t detected = nanoseconds();
        if (carry && counters.moved_meshes < bodies_.size()) counters.carried_contacts = carry_contacts();
        // If every old contact was carried and no new one found, contacts, depth and events are unchanged.
        const bool all_carried =
            counters.carried_contacts == contacts_.size() && hits_.size() == contacts_.size();
        if (!all_carried) make_contacts(bodies_, hits_, contacts_, &workers_, &interiors_);
        std::uint64_t contacts_made = nanoseconds();
        profile.contacts_ns = contacts_made - detected;
        const bool same_edges = find_edges(counters);
        if (edges_) {
            profile.edges_ns = nanoseconds() - contacts_made;
            contacts_made += profile.edges_ns;
        }
        if (near_faces_) {
            find_near(counters);
            profile.margin_ns = nanoseconds() - contacts_made;
            contacts_made += profile.margin_ns;
        }

        if (all_carried) counters.carried_penetrations = penetrations_.all().size();
        if (depth_ && !all_carried) {
            depth_->find(bodies_, topologies_, hits_, contacts_, closest_budget_, &workers_, penetrations_,
                         counters);
            counters.carried_penetrations = penetrations_.carried();
            profile.depth_ns = nanoseconds() - contacts_made;
            contacts_made += profile.depth_ns;
        }

        if (carry && all_carried && same_edges)
            events_.repeat();
        else
            events_.update(contacts_, edges_ ? edges_->pairs() : std::span<const EdgePair>(),
                           meshes_.slot_count(), [this](vox_body id) { return mesh(id).user_data(); });
        profile.events_ns = nanoseconds() - contacts_made;
    } catch (const MeshError& error) {
        forget_contacts();
        failure_ = failure_of(error.result(), error.mesh, error.vertex);
        throw;
    } catch (...) {
        forget_contacts();
        throw;
    }

    counters.meshes = static_cast<std::uint32_t>(bodies_.size() + lone_.totals().bodies);
    counters.vertices = lone_.totals().vertices;
    counters.tets = lone_.totals().tets;
    counters.moved_meshes += carry ? lone_.totals().moved : lone_.totals().bodies;
    for (const Body& body : bodies_) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size() - body.off_count;
        counters.meshes_without_tets += body.tets.empty() && body.vertex_count > 0;
    }
    counters.skipped_meshes = left_out_.size();
    counters.contacts = contacts_.size();
    counters.penetrations = penetrations_.all().size();
    events_.count(counters);
    if (chooses_cell_size() && !fast_) {
        adaptive_.observe(counters);
        counters.cell_size_changes = adaptive_.changes();
    }
    if (closest_budget_ > 0) // those carried over included
        counters.unknown_penetrations = static_cast<std::uint64_t>(
            std::ranges::count(penetrations_.all(), VOX_PENETRATION_UNKNOWN, &vox_penetration::state));
    counters_ = counters;
    profile.step_ns = nanoseconds() - start;
    profile_ = profile;
    list_counters();
    contacts_hold_ = fast_;
    meshes_hold_ = fast_ && left_out_.empty() && lone_.totals().bodies == 0;
    if (counters.unknown_penetrations > 0)
        warn("%llu of %llu penetrations are unknown: the closest_budget of %llu was used up",
             llu(counters.unknown_penetrations), llu(counters.penetrations), llu(closest_budget_));
}

// Returns whether there are the same edge contacts as in the last step, or none are looked for.
bool vox_grid::find_edges(Counters& counters) {
    if (!finds_surface_contacts || !edges_) return true;
    edges_->find({bodies_, topologies_, surface_versions_, fast_ ? &fast_engine_ : nullptr, &workers_},
                 counters);
    return edges_->unchanged();
}

// Vertices near or through surfaces that they are not inside of.
void vox_grid::find_near(Counters& counters) {
    if constexpr (!finds_surface_contacts) return;
    const EdgeScene scene{bodies_, topologies_, surface_versions_, fast_ ? &fast_engine_ : nullptr,
                          &workers_};
    if (passages_) passages_->find(scene, *near_faces_, counters);
    if (margin_contacts_) margin_contacts_->find(scene, margin_, contacts_, *near_faces_, counters);
}

void vox_grid::forget_contacts() noexcept {
    if (edges_) edges_->clear();
    if (margin_contacts_) margin_contacts_->clear();
    if (passages_) passages_->clear();
    contacts_.clear();
    interiors_.clear();
    penetrations_.clear();
    left_out_.clear();
}

// Finds the hits. If a coordinate of a mesh makes that fail, it starts again without all such meshes, where
// the flags ask for that. Then nothing is carried over, as the engine may have taken in the positions of
// others already.
void vox_grid::detect(bool& carry, Counters& counters, Profile& profile) {
    const auto detect_once = [&] {
        if (fast_ && !shared_tets_.empty() && !near_faces_) // a body near others is not alone
            lone_.find(meshes_, fast_engine_.last_step().moved_origin(), fast_engine_.pair_buffers(),
                       workers_);
        else
            lone_.forget(); // small bodies share their tets: there are none
        gather_bodies(counters);
        if (fast_)
            detect_fast(carry, counters, profile);
        else
            detect_reference(counters, profile);
    };
    try {
        return detect_once();
    } catch (const MeshError& error) {
        if (!skips_bad_meshes_ || error.vertex == VOX_NO_VERTEX) throw;
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
        if (vertex == VOX_NO_VERTEX) return;
        slot.left_out = true;
        slot.state.invalidate_positions(); // a later step must not take it for one at rest
        if (log_.write) warn("left out of the step: %s", position_error(body, vertex).what());
    });
}

bool vox_grid::is_left_out(const Body& body) const noexcept {
    return skips_bad_meshes_ && first_bad_vertex(body) != VOX_NO_VERTEX;
}

vox_failure vox_grid::failure_of(vox_result result, vox_body id, std::uint32_t vertex) const noexcept {
    vox_failure failure{};
    failure.result = result;
    failure.mesh = id;
    failure.slot = slot_of(id);
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
    counters.disabled_meshes = 0;
    left_out_.clear();
    bodies_.clear();
    topologies_.clear();
    surface_versions_.clear();
    prepared_.clear();
    const auto gather = [&](vox_body id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        slot.body = MeshSlot::none;
        if (!mesh.is_enabled()) {
            ++counters.disabled_meshes;
            return;
        }
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, mesh.body(id),
                            " has no positions: bind some before the step");
        mesh.check_format_once(id);
        if (slot.left_out) { // looked at before the engine does, as others may be at rest
            const std::uint32_t vertex = first_bad_vertex(mesh.body(id));
            slot.left_out = skips_bad_meshes_ && vertex != VOX_NO_VERTEX;
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
        slot.topology_version = mesh.topology_version();
        if (fast_)
            prepared_.push_back({&mesh.tiled().tiles, &mesh.tiled().boundary, &slot.state,
                                 lone_.compared(slot_of(id)), lone_.moved(slot_of(id))});
    };
    for (std::uint32_t s = 0; s < meshes_.slot_count(); ++s)
        if (!lone_.is_lone(s) && meshes_.slot(s).live)
            gather(make_id(s, meshes_.slot(s).generation), meshes_.slot(s));
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
                                .keep_certified = edges_.has_value(),
                                .others = lone_.totals().rounded};
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
        std::copy(contact.barycentric, contact.barycentric + 4, hit.weights.of);
        reserve_sparingly(hits_, hits_.size() + 1);
        hits_.push_back(hit);
    }
    return hits_.size() - found;
}

void vox_grid::detect_reference(Counters& counters, Profile& profile) {
    choose_cell_size();
    counters.moved_meshes = bodies_.size();
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
