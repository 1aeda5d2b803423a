// What a grid answers between steps: readings, depths of edge contacts, queries, and views of the last step's
// results.
#include "grid/grid.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"

#include <algorithm>

using namespace vox;

// ---- readings --------------------------------------------------------------------------------------

void vox_grid::prepare_readings(vox_readings_desc desc) {
    constexpr std::uint32_t known = VOX_READING_POSITION | VOX_READING_SURFACE | VOX_READING_DEPTH;
    set_default(desc.what, known);
    if (desc.what & ~known)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("desc.what is 0x%x, of which 0x%x is unknown", desc.what, desc.what & ~known));
    if (desc.body_a == VOX_NULL_BODY && desc.body_b != VOX_NULL_BODY)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("desc.body_b is %u, but there is no body_a", desc.body_b));
    const vox_body meshes[2] = {desc.body_a, desc.body_b};
    const std::size_t named = desc.body_a == VOX_NULL_BODY ? 0 : desc.body_b == VOX_NULL_BODY ? 1 : 2;
    for (std::size_t i = 0; i < named; ++i) (void)mesh(meshes[i]); // throws for an id that names no mesh

    for (ReadingBody& reading : readings_.choose(events_, {meshes, named})) {
        const vox_body id = reading.body.mesh_id;
        if (!is_valid(id)) continue;
        Mesh& mesh = this->mesh(id);
        if (!mesh.has_positions()) continue;
        reading.body = mesh.body(id);
        reading.is_present = true;
        if (!reading.is_entered || !(desc.what & VOX_READING_SURFACE)) continue;
        check_finite(reading.body);
        mesh.make_topology();
        if (!mesh.topology().triangles.empty()) reading.topology = &mesh.topology();
        reading.is_as_stepped = mesh.topology_version() == meshes_[id].topology_version;
    }
    const std::uint64_t left_out =
        readings_.prepare(desc.what, desc.closest_budget, contacts_, penetrations_, trees_, workers_);
    if (left_out > 0)
        warn("%llu vertices have no surface in the readings: the closest_budget of %llu was used up",
             llu(left_out), llu(desc.closest_budget));
}

// ---- depths of edge contacts -----------------------------------------------------------------------

void vox_grid::prepare_edge_depths() {
    const std::span<const vox_edge_contact> contacts = edge_contacts().all();
    Array<EdgeBody> bodies(&memory_);
    bodies.reserve(2 * edges_->pairs().size());
    for (const EdgePair& pair : edges_->pairs())
        for (const vox_body id : {pair.body_a, pair.body_b}) {
            const MeshSlot* slot = meshes_.find(id);
            if (!slot || slot->mesh.topology_version() != slot->topology_version)
                throw Error(VOX_ERROR_INVALID_STATE,
                            format("mesh %u of an edge contact was %s since the step", id,
                                   slot ? "edited" : "removed"));
            const Body body = slot->mesh.body(id);
            if (!slot->mesh.has_positions())
                throw MeshError(VOX_ERROR_INVALID_STATE, body, " has no positions: bind some before");
            bodies.push_back({body, nullptr});
        }
    std::sort(bodies.begin(), bodies.end(),
              [](const EdgeBody& a, const EdgeBody& b) { return a.body.mesh_id < b.body.mesh_id; });
    const auto same = [](const EdgeBody& a, const EdgeBody& b) { return a.body.mesh_id == b.body.mesh_id; };
    bodies.erase(std::unique(bodies.begin(), bodies.end(), same), bodies.end());
    for (const EdgeBody& b : bodies) check_finite(b.body);

    Array<vox_body> entered(&memory_);
    for (const vox_edge_contact& contact : contacts)
        if (contact.body_a != contact.body_b && (entered.empty() || entered.back() != contact.body_b))
            entered.push_back(contact.body_b);
    std::ranges::sort(entered);
    entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
    for (const vox_body id : entered) trees_.add(id); // which moves those of others
    for (EdgeBody& b : bodies) {
        const vox_body id = b.body.mesh_id;
        if (!std::ranges::binary_search(entered, id)) continue;
        depth::SurfaceTree& tree = trees_[id];
        tree.update({&mesh(id).topology(), b.body.tets, b.body.positions}, false, &workers_);
        b.tree = &tree;
    }
    edges_->prepare_depths(bodies, workers_);
}

// ---- locators ---------------------------------------------------------------------------------------

vox_locator* vox_grid::take_locator() {
    query_bodies_.clear();
    meshes_.for_each([&](vox_body id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        if (!mesh.is_enabled() || mesh.tet_count() == 0) return;
        const Body body = mesh.body(id);
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, body, " has no positions: bind some before");
        mesh.check_format_once(id);
        if (is_left_out(body)) return;
        if (!skips_bad_meshes_) check_finite(body); // else that has looked at it
        if (!slot.query_tets) {
            mesh.make_topology();
            mesh.make_tiles(); // the reference engine needs none
            slot.query_tets = make_query_tets(mesh.tiled().tiles, mesh.topology(), &memory_);
        }
        query_bodies_.push_back({body, slot.query_tets, mesh.user_data()});
    });
    vox_locator* const locator = locators_.take(query_bodies_, workers_, epoch_);
    query_bodies_.clear();
    return locator;
}

// ---- results --------------------------------------------------------------------------------------

vox_contact_view vox_grid::contacts() const noexcept {
    return {contacts_.data(), sizeof(vox_contact), contacts_.size(), epoch_, interiors_.data()};
}

vox_failure vox_grid::failure(std::uint32_t index) const noexcept {
    if (failure_.result != VOX_OK && index == 0) return failure_;
    if (failure_.result == VOX_OK && index < left_out_.size()) return left_out_[index];
    vox_failure none{};
    none.vertex = VOX_NO_VERTEX;
    return none;
}

vox_penetration_view vox_grid::penetrations() const {
    require_penetrations();
    const std::span<const vox_penetration> all = penetrations_.all();
    return {all.data(), sizeof(vox_penetration), all.size(), epoch_};
}

vox_depth_view vox_grid::depths() const {
    require_penetrations();
    const std::span<const vox_depth> depths = penetrations_.depths();
    return {depths.data(), sizeof(vox_depth), depths.size(), epoch_};
}

vox_margin_contact_view vox_grid::margin_contacts() const {
    if (!margin_contacts_)
        throw Error(VOX_ERROR_INVALID_STATE, "the grid has no margin: vox_grid_set_margin sets one");
    const std::span<const vox_margin_contact> all = margin_contacts_->all();
    return {all.data(), sizeof(vox_margin_contact), all.size(), epoch_};
}

vox_passage_view vox_grid::passages() const noexcept {
    const std::span<const vox_passage> all = passages_ ? passages_->all() : std::span<const vox_passage>();
    return {all.data(), sizeof(vox_passage), all.size(), epoch_};
}

const EdgeContacts& vox_grid::edge_contacts() const {
    if (!edges_) throw Error(VOX_ERROR_INVALID_STATE, "the flags of the grid lack VOX_GRID_EDGE_CONTACTS");
    return *edges_;
}

void vox_grid::require_penetrations() const {
    if (!finds_penetrations())
        throw Error(VOX_ERROR_INVALID_STATE,
                    "the flags of the grid lack VOX_GRID_PENETRATIONS, which vox_default_grid_desc sets");
}

std::uint64_t vox_grid::hash() const noexcept { return hash_contacts(contacts_); }

vox_grid_info vox_grid::info() const noexcept {
    return {.struct_size = sizeof(vox_grid_info),
            .flags = flags(),
            .epoch = epoch_,
            .cell_size = used_cell_size_,
            .margin = margin_,
            .bytes = memory_.bytes(),
            .peak_bytes = memory_.peak_bytes(),
            .step_ns = profile_.step_ns,
            .moved_bodies = counters_.moved_meshes,
            .skipped_bodies = counters_.skipped_meshes,
            .total_began = counters_.total_touches_began,
            .total_ended = counters_.total_touches_ended};
}

void vox_grid::list_counters() noexcept {
    vox_counter* out = counter_list_;
    for (const NamedCounter& c : named_counters) *out++ = {c.name, counters_.*c.field};
    for (const NamedTime& t : named_times) *out++ = {t.name, profile_.*t.field};
}
