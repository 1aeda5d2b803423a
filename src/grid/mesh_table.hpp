// The meshes of a grid: slots, ids, generations and limits.
#pragma once

#include "base/array.hpp"
#include "base/blocks.hpp"
#include "fast/mesh_state.hpp"
#include "mesh/ids.hpp"
#include "mesh/mesh.hpp"
#include "query/tets.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <utility>

namespace vox {

// Throws Error(LIMIT) when `added` more of what a grid holds `count` of would be more than `limit`.
void check_limit(std::uint64_t count, std::uint64_t added, std::uint64_t limit, const char* what);

struct MeshSlot {
    explicit MeshSlot(std::pmr::memory_resource* memory, std::uint32_t last_generation = 0) noexcept
        : mesh(memory), generation(last_generation), state(memory) {}

    Mesh mesh;
    std::uint32_t generation; // of the mesh that lives here, or of the last one that did; 0: there was none
    bool live = false;
    bool left_out = false; // for a coordinate, in the last step
    bool edited = false;   // since the last step
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t body = none;                   // index in the last step; none when it took no part
    fast::MeshState state;                       // of the mesh, for the fast engine
    std::shared_ptr<const QueryTets> query_tets; // of the mesh as it is now; null until queries need it
};

class MeshTable {
public:
    explicit MeshTable(std::pmr::memory_resource* memory) noexcept : slots_(memory), free_slots_(memory) {}

    void reserve(std::uint32_t mesh_count);
    std::size_t slot_count() const noexcept { return slots_.size(); }

    // Of all meshes together.
    std::uint64_t vertex_count() const noexcept { return vertex_count_; }
    std::uint64_t tet_count() const noexcept { return tet_count_; }
    std::uint32_t shape_count() const noexcept { return shape_count_; }

    // Throw Error(LIMIT) where there is no room for one more such mesh, or for so many more vertices and
    // tetrahedra; with `old`, in its place.
    void check_room(const Body& mesh, const Mesh* old = nullptr) const;
    void check_growth(std::uint64_t vertices, std::uint64_t tets, const Mesh* old = nullptr) const;

    // After check_room(). Throws what the memory throws and leaves all unchanged then.
    vox_body insert(Mesh&& mesh, fast::MeshState&& state);
    void replace(vox_body id, Mesh&& mesh, fast::MeshState&& state) noexcept;
    void become_shape(vox_body id, std::shared_ptr<const RigidShape> shape) noexcept;
    void remove(vox_body id); // throws as operator[]
    void clear() noexcept;

    // After check_growth(). Throw as Mesh does.
    std::uint32_t append_tets(vox_body id, std::span<const Tet> corners);
    std::uint32_t append_vertices(vox_body id, const vox_vertices_desc& desc);

    // Null for an id that names no mesh.
    const MeshSlot* find(vox_body id) const noexcept;
    MeshSlot* find(vox_body id) noexcept { return const_cast<MeshSlot*>(std::as_const(*this).find(id)); }
    // Throws Error(INVALID_HANDLE) for such an id.
    const MeshSlot& operator[](vox_body id) const;
    MeshSlot& operator[](vox_body id) { return const_cast<MeshSlot&>(std::as_const(*this)[id]); }

    // Calls visit(id, slot), ascending.
    template <class Visit>
    void for_each(Visit&& visit) {
        for (std::size_t s = 0; s < slots_.size(); ++s)
            if (slots_[s].live)
                visit(make_id(static_cast<std::uint32_t>(s), slots_[s].generation), slots_[s]);
    }
    template <class Visit>
    void for_each(Visit&& visit) const {
        const_cast<MeshTable*>(this)->for_each(
            [&](vox_body id, MeshSlot& slot) { visit(id, std::as_const(slot)); });
    }

private:
    friend class Snapshot;

    void vacate(std::uint32_t slot) noexcept;
    std::pmr::memory_resource* memory() const noexcept { return slots_.memory(); }

    Blocks<MeshSlot> slots_;
    Array<std::uint32_t> free_slots_; // capacity for every slot, so that removing cannot fail
    std::uint64_t vertex_count_ = 0;
    std::uint64_t tet_count_ = 0;
    std::uint32_t shape_count_ = 0;
};

} // namespace vox
