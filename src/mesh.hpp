// One inserted mesh: topology (copied), positions (borrowed or copied), settings.
#pragma once

#include "depth/topology.hpp"
#include "fast.hpp"
#include "filter.hpp"
#include "scene.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

namespace vox {

class Mesh {
public:
    // An empty slot's mesh.
    explicit Mesh(std::pmr::memory_resource* memory) noexcept
        : tets_(memory), owned_(memory), topology_(memory), tiles_(memory), filter_(filter_defaults()),
          self_filter_(memory), exceptions_(memory) {}
    // A copy of a checked desc: `view` are its arrays (mesh_check.hpp), desc.filter not looked at.
    Mesh(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter,
         std::pmr::memory_resource* memory);

    Mesh(Mesh&&) noexcept = default;
    Mesh& operator=(Mesh&&) noexcept = default;

    // Prepares the depth stage, once.
    void make_topology() { depth::make_topology(tets_, vertex_count_, topology_); }
    const depth::Topology& topology() const noexcept { return topology_; }

    // Makes the fast engine's tiles, once; needs positions.
    void make_tiles();
    FastMesh& tiles() noexcept { return tiles_; }
    // Null before they are made.
    const FastMesh* tiles_if_made() const noexcept { return has_tiles_ ? &tiles_ : nullptr; }

    // Borrows positions; those of its own are released.
    void bind(const Positions& positions) noexcept;

    // The mesh's own positions, to be written to: at first a copy of the borrowed ones, or zeros where there
    // are none, in the same format.
    void* map_positions();
    std::size_t position_size() const noexcept { return positions_.doubles ? sizeof(Vec3d) : sizeof(Vec3f); }

    // Null: none. Three rows of four, finite.
    void set_transform(const double* matrix) noexcept;

    bool has_positions() const noexcept { return vertex_count_ == 0 || positions_.data != nullptr; }
    std::uint32_t vertex_count() const noexcept { return vertex_count_; }
    std::uint64_t tet_count() const noexcept { return tets_.size(); }
    std::uint64_t user_data() const noexcept { return user_data_; }

    // Takes a checked filter, and takes the rest pose from the positions when it is wanted and not known.
    // Throws Error(INVALID_STATE or NON_FINITE) or what the memory throws, and leaves all as it was then.
    void set_filter(const vox_filter& filter);
    const vox_filter& filter() const noexcept { return filter_; }

    void set_enabled(bool enabled) noexcept { enabled_ = enabled; }
    bool is_enabled() const noexcept { return enabled_; }

    // Meshes that this one does not collide with, ascending. Room first, so that adding cannot fail.
    void reserve_exception();
    void add_exception(vox_mesh other) noexcept;
    void remove_exception(vox_mesh other) noexcept;
    std::span<const vox_mesh> exceptions() const noexcept { return exceptions_; }

    Body body(vox_mesh id) const noexcept;

private:
    friend class Snapshot;

    void set_rest(const Positions& positions);
    // For a rest pose. Throws Error(NON_FINITE or LIMIT).
    std::pmr::vector<Vec3f> copy_finite(const Positions& positions) const;

    std::pmr::vector<Tet> tets_;
    std::pmr::vector<double> owned_; // positions, packed in their format, unless they are borrowed
    depth::Topology topology_;       // empty unless it was made
    FastMesh tiles_;
    bool has_tiles_ = false;
    Positions positions_; // without the transform
    std::array<double, 12> transform_{};
    bool has_transform_ = false;
    std::uint64_t user_data_ = 0;
    std::uint32_t vertex_count_ = 0;
    vox_filter filter_;
    SelfFilter self_filter_;
    std::pmr::vector<vox_mesh> exceptions_;
    bool enabled_ = true;
};

} // namespace vox
