// What a grid answers between steps: locators, and views of the last step's results.
#include "grid/grid.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"

#include <algorithm>

using namespace vox;

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
    return {contacts_.data(), contacts_.size(), interiors_.data()};
}

vox_failure vox_grid::failure(std::uint32_t index) const noexcept {
    if (failure_.result != VOX_OK && index == 0) return failure_;
    if (failure_.result == VOX_OK && index < left_out_.size()) return left_out_[index];
    vox_failure none{};
    none.vertex = VOX_NONE;
    return none;
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
            .moved_bodies = counters_.moved_bodies,
            .skipped_bodies = counters_.skipped_bodies,
            .total_began = counters_.total_touches_began,
            .total_ended = counters_.total_touches_ended};
}

void vox_grid::list_counters() noexcept {
    vox_counter* out = counter_list_;
    for (const NamedCounter& c : named_counters) *out++ = {c.name, counters_.*c.field};
    for (const NamedTime& t : named_times) *out++ = {t.name, profile_.*t.field};
}
