#include "grid/mesh_table.hpp"

#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"

namespace vox {

void check_limit(std::uint64_t count, std::uint64_t added, std::uint64_t limit, const char* what) {
    if (added > limit - count)
        throw Error(VOX_ERROR_LIMIT,
                    format("the grid holds %llu %s and cannot take %llu more, the limit is %llu", llu(count),
                           what, llu(added), llu(limit)));
}

void MeshTable::reserve(std::uint32_t mesh_count) {
    if (mesh_count > VOX_MAX_BODIES)
        throw Error(VOX_ERROR_LIMIT, format("mesh_count is %u, the limit is %u", mesh_count, VOX_MAX_BODIES));
    slots_.reserve(mesh_count);
    reserve_exactly(free_slots_, mesh_count);
}

void MeshTable::check_room(const Body& mesh, const Mesh* old) const {
    check_growth(mesh.vertex_count, mesh.tets.size(), old);
    if (!old && free_slots_.empty()) check_limit(slots_.size(), 1, VOX_MAX_BODIES, "body slots");
}

vox_body MeshTable::insert(Mesh&& mesh, fast::MeshState&& state) {
    if (free_slots_.empty()) {
        slots_.reserve(slots_.size() + 1);
        reserve_growing(free_slots_, slots_.size() + 1);
        free_slots_.push_back(static_cast<std::uint32_t>(slots_.size()));
        slots_.emplace_back(memory());
    }
    const std::uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    MeshSlot& taken = slots_[slot];
    vertex_count_ += mesh.vertex_count();
    tet_count_ += mesh.tet_count();
    taken.mesh = std::move(mesh);
    taken.state = std::move(state);
    taken.live = true;
    taken.generation += 1;
    return make_id(slot, taken.generation);
}

void MeshTable::replace(vox_body id, Mesh&& mesh, fast::MeshState&& state) noexcept {
    MeshSlot& slot = slots_[slot_of(id)];
    vertex_count_ += std::uint64_t{mesh.vertex_count()} - slot.mesh.vertex_count();
    tet_count_ += mesh.tet_count() - slot.mesh.tet_count();
    mesh.take_over(std::move(slot.mesh));
    slot.mesh = std::move(mesh);
    slot.state = std::move(state);
    slot.query_tets = nullptr;
}

void MeshTable::become_shape(vox_body id, std::shared_ptr<const RigidShape> shape) noexcept {
    slots_[slot_of(id)].mesh.set_shape(std::move(shape));
    ++shape_count_;
}

void MeshTable::remove(vox_body id) {
    (void)(*this)[id]; // throws for an id that names no mesh
    vacate(slot_of(id));
}

// The last slots first, so that the next meshes take the first ones.
void MeshTable::clear() noexcept {
    for (std::size_t slot = slots_.size(); slot-- > 0;)
        if (slots_[slot].live) vacate(static_cast<std::uint32_t>(slot));
}

void MeshTable::vacate(std::uint32_t index) noexcept {
    MeshSlot& slot = slots_[index];
    const std::uint32_t generation = slot.generation;
    for (const vox_body other : slot.mesh.exceptions())
        slots_[slot_of(other)].mesh.remove_exception(make_id(index, generation));
    vertex_count_ -= slot.mesh.vertex_count();
    tet_count_ -= slot.mesh.tet_count();
    shape_count_ -= slot.mesh.shape() != nullptr;
    slot = MeshSlot(memory(), generation);
    // A slot whose generations are used up is retired, so that no old id becomes valid again.
    if (generation < most_generations) free_slots_.push_back(index);
}

void MeshTable::check_growth(std::uint64_t vertices, std::uint64_t tets, const Mesh* old) const {
    check_limit(vertex_count_ - (old ? old->vertex_count() : 0), vertices, VOX_MAX_VERTICES, "vertices");
    check_limit(tet_count_ - (old ? old->tet_count() : 0), tets, VOX_MAX_TETS, "tets");
}

std::uint32_t MeshTable::append_tets(vox_body id, std::span<const Tet> corners) {
    Mesh& mesh = (*this)[id].mesh;
    const std::uint32_t first = mesh.append_tets(corners);
    tet_count_ += corners.size();
    return first;
}

std::uint32_t MeshTable::append_vertices(vox_body id, const vox_vertices_desc& desc) {
    Mesh& mesh = (*this)[id].mesh;
    const std::uint32_t first = mesh.append_vertices(desc);
    vertex_count_ += desc.count;
    return first;
}

const MeshSlot* MeshTable::find(vox_body id) const noexcept {
    const std::uint32_t slot = slot_of(id);
    if (slot >= slots_.size() || !slots_[slot].live || slots_[slot].generation != generation_of(id))
        return nullptr;
    return &slots_[slot];
}

const MeshSlot& MeshTable::operator[](vox_body id) const {
    if (const MeshSlot* found = find(id)) return *found;
    if (id == VOX_NULL_BODY) throw Error(VOX_ERROR_INVALID_HANDLE, "body id is 0, which names no body");
    const std::uint32_t slot = slot_of(id);
    if (slot >= slots_.size())
        throw Error(VOX_ERROR_INVALID_HANDLE,
                    format("body id %u names slot %u, the grid has %zu", id, slot, slots_.size()));
    throw Error(VOX_ERROR_INVALID_HANDLE,
                format("body id %u (slot %u, generation %u) is stale: the slot %s generation %u", id, slot,
                       generation_of(id), slots_[slot].live ? "holds" : "is empty after",
                       slots_[slot].generation));
}

} // namespace vox
