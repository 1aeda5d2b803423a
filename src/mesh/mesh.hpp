// One inserted mesh: tetrahedra and positions (borrowed or copied), settings, and what the stages prepare of
// them, which edits (edit.cpp) keep up to date.
#pragma once

#include "base/bits.hpp"
#include "base/lazy.hpp"
#include "base/scene.hpp"
#include "mesh/filter.hpp"
#include "mesh/sample.hpp"
#include "mesh/tiled_mesh.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class Mesh {
public:
    // An empty slot's mesh.
    explicit Mesh(std::pmr::memory_resource* memory) noexcept
        : tets_(memory), given_(memory), off_(memory), removed_(memory), removed_vertices_(memory),
          owned_(memory), tets_of_(memory), topology_(memory), tiled_(memory), filter_(filter_defaults()),
          self_filter_(memory), exceptions_(memory) {}
    // Of a checked desc, whose arrays it copies or borrows as the flags say. `view` is what check_mesh() made
    // of it; `filter` is used in place of desc.filter.
    Mesh(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter,
         std::pmr::memory_resource* memory);

    Mesh(Mesh&&) noexcept = default;
    Mesh& operator=(Mesh&&) noexcept = default;

    // Makes the topology, unless that is done.
    void make_topology();
    const Topology& topology() const noexcept { return topology_; }
    bool has_topology() const noexcept { return has_topology_; }
    // Grows when the topology is made, changed or dropped.
    std::uint32_t topology_version() const noexcept { return topology_version_; }
    // Gives its memory back.
    void drop_topology() noexcept;

    // What suggestions of a cell size look at, made at the first call, from the topology where that is made.
    const MeshSample& sample() const;
    bool may_sample() const noexcept { return tets().size() <= most_tets; }

    // Makes the tiles, unless that is done; needs positions.
    void make_tiles();
    const TiledMesh& tiled() const noexcept { return tiled_; }
    // Grows when the tiles are made anew; at least 1 once they are made.
    std::uint32_t tiles_version() const noexcept { return tiles_version_; }
    // Null before they are made.
    const Tiles* tiles_if_made() const noexcept { return has_tiles_ ? &tiled_.tiles : nullptr; }

    // Makes the rings of the filter, unless that is done.
    void make_rings();

    // Edits. Each checks its arguments and takes the memory that it needs, then changes the mesh, then
    // repairs what was prepared of it. What cannot be repaired for lack of memory, or is cheaper to make
    // anew, is invalidated. Throw Error or what the memory throws, and have changed nothing then.
    void set_tets_enabled(std::span<const std::uint32_t> tets, bool enabled);
    void replace_tets(std::span<const std::uint32_t> tets, std::span<const Tet> corners);
    std::uint32_t append_tets(std::span<const Tet> corners); // the index of the first
    void remove_tets(std::span<const std::uint32_t> tets);
    std::uint32_t append_vertices(const vox_vertices_desc& desc);
    void remove_vertices(std::span<const std::uint32_t> vertices);

    // For a mesh that was not edited yet: which tets are off, which of these are removed, and which vertices
    // are (bits). Throws Error(INVALID_MESH) where these contradict each other or the tets.
    void restore_edits(std::span<const std::uint64_t> off, std::span<const std::uint64_t> removed,
                       std::span<const std::uint64_t> removed_vertices);

    // A mesh of another topology with this one's settings; `desc` and `view` as for the constructor. Without
    // desc.positions, and with as many vertices as before, it keeps positions and rest pose. take_over()
    // completes it and cannot fail.
    Mesh with_topology(const vox_mesh_desc& desc, const Body& view) const;
    void take_over(Mesh&& before) noexcept;

    // Borrows positions and releases the mesh's own ones.
    void bind(const Positions& positions) noexcept;

    // The mesh's own positions, for the caller to write to: at first a copy of the borrowed ones in their
    // format, or zeros where there are none.
    void* map_positions();

    // Throws MeshError(INVALID_ARGUMENT) where the positions are not of their format, which is looked at once
    // there are enough of them, and again when another format is bound.
    void check_format_once(vox_mesh id);
    bool is_format_checked() const noexcept { return format_checked_; }
    std::size_t position_size() const noexcept { return positions_.doubles ? sizeof(Vec3d) : sizeof(Vec3f); }

    // Three rows of four finite numbers; null: no transform.
    void set_transform(const double* matrix) noexcept;

    bool has_positions() const noexcept { return vertex_count_ == 0 || positions_.data != nullptr; }
    std::uint32_t vertex_count() const noexcept { return vertex_count_; }
    std::uint64_t tet_count() const noexcept { return tets().size(); }
    std::uint64_t user_data() const noexcept { return user_data_; }
    vox_mesh_info info(std::uint32_t slot) const noexcept;

    // Corners as given by the caller, also of a tet that is off.
    const Tet& given(std::uint32_t tet) const noexcept { return given_.empty() ? tets()[tet] : given_[tet]; }
    bool is_off(std::uint32_t tet) const noexcept { return off_[tet]; }

    // Sets a checked filter. Where that needs a rest pose and there is none, it is copied from the positions.
    // Throws Error(INVALID_STATE or NON_FINITE) or what the memory throws, and changes nothing then.
    void set_filter(const vox_filter& filter);
    const vox_filter& filter() const noexcept { return filter_; }

    void set_enabled(bool enabled) noexcept { enabled_ = enabled; }
    bool is_enabled() const noexcept { return enabled_; }

    // Meshes that this one does not collide with, ascending. After reserve_exception(), adding one cannot
    // fail.
    void reserve_exception();
    void add_exception(vox_mesh other) noexcept;
    void remove_exception(vox_mesh other) noexcept;
    std::span<const vox_mesh> exceptions() const noexcept { return exceptions_; }

    Body body(vox_mesh id) const noexcept;

private:
    friend class Snapshot;

    // One after the other, in the mesh's format.
    Positions packed(const void* data) const noexcept;

    // For a rest pose. Throws Error(NON_FINITE or LIMIT).
    RestPose rest_pose(const Positions& positions, std::uint32_t count) const;

    // Edits.
    std::pmr::memory_resource* memory() const noexcept { return tets_.get_allocator().resource(); }
    std::span<const Tet> tets() const noexcept { return borrowed_.empty() ? std::span(tets_) : borrowed_; }
    void check_tets(std::span<const std::uint32_t> tets) const;
    void check_corners(std::uint32_t tet, const Tet& corners) const;
    void switch_off(std::uint32_t tet, std::pmr::vector<TetChange>& changes) noexcept;
    void own_tets();
    void reserve_off();
    void list_tets_of();
    void apply(std::span<const TetChange> changes) noexcept;
    void apply_vertices(std::uint32_t count_before) noexcept;
    void invalidate_tiles() noexcept;
    void invalidate_prepared() noexcept;

    std::span<const Tet> borrowed_; // the caller's tets; empty once the mesh has its own
    std::pmr::vector<Tet> tets_;    // as the stages see them: those that are off name one vertex four times
    std::pmr::vector<Tet> given_;   // corners as given by the caller; empty while no tet is off
    Bits off_, removed_;            // tets; those that are removed are off as well
    Bits removed_vertices_;
    std::pmr::vector<double> owned_; // positions, packed in their format, unless they are borrowed
    IndexLists tets_of_;             // the tets around each vertex, from the first edit on
    Topology topology_;
    Lazy<MeshSample> sample_;
    TiledMesh tiled_;
    Positions positions_; // without the transform
    std::array<double, 12> transform_{};
    std::uint64_t user_data_ = 0;
    std::uint32_t vertex_count_ = 0;
    std::uint32_t tiles_version_ = 0;
    std::uint32_t topology_version_ = 0;
    bool owns_positions_ = false; // may be true while there are no vertices yet
    bool has_tets_of_ = false, has_topology_ = false, has_tiles_ = false, has_rings_ = false;
    bool has_transform_ = false;
    bool format_checked_ = false; // that the positions are of their format
    bool enabled_ = true;
    vox_filter filter_;
    Rare<SelfFilter> self_filter_;
    std::pmr::vector<vox_mesh> exceptions_;
};

} // namespace vox
