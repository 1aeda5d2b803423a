// What a grid answers between steps: locators, and views of the last step's results.
#include "grid/grid.hpp"

#include "base/structs.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"

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
        if (!skips_bad_meshes()) check_finite(body); // else that has looked at it
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

void vox_grid::find_constraints(vox_constraint_desc desc) {
    check_enum(desc.method, VOX_DEPTH_METHOD_NONE, "desc.method");
    if (desc.body_a == VOX_NULL_BODY && desc.body_b != VOX_NULL_BODY)
        refuse(format("desc.body_b is %u, but there is no body_a", desc.body_b));
    for (const vox_body body : {desc.body_a, desc.body_b})
        if (body != VOX_NULL_BODY) (void)mesh(body); // throws for an id that names no body
    if (!stepped_)
        throw Error(VOX_ERROR_INVALID_STATE, "there are no results of a step: call vox_grid_step first");
    make_constraints(desc, false, counters_, profile_);
    list_counters();
}

vox_constraint_view vox_grid::constraints() const {
    if (!constraints_->constraints().found())
        throw Error(VOX_ERROR_INVALID_STATE,
                    "no constraints were looked for since the last step: call vox_grid_find_constraints "
                    "after it, or set VOX_GRID_CONSTRAINTS");
    return constraints_->constraints().view();
}

vox_contact_view vox_grid::contacts() const noexcept {
    return {step_.contacts.data(), step_.contacts.size(), step_.interiors.data()};
}

vox_failure vox_grid::failure(std::uint32_t index) const noexcept {
    if (failure_.result != VOX_OK && index == 0) return failure_;
    if (failure_.result == VOX_OK && index < left_out_.size()) return left_out_[index];
    vox_failure none{};
    none.vertex = VOX_NONE;
    return none;
}

std::uint64_t vox_grid::hash() const noexcept { return hash_contacts(step_.contacts); }

vox_grid_info vox_grid::info() const noexcept {
    return {.struct_size = sizeof(vox_grid_info),
            .flags = flags_,
            .epoch = epoch_,
            .cell_size = used_cell_size_,
            .margin = surfaces_.margin(),
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
