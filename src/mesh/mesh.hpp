// One inserted mesh: tetrahedra and positions (borrowed or copied), settings, and what stages prepare from
// them. Edits (edit.cpp) keep it up to date.
#pragma once

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/scene.hpp"
#include "mesh/filter.hpp"
#include "mesh/sample.hpp"
#include "mesh/tiled_mesh.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <utility>

namespace vox {

// The state of an edited mesh.
struct MeshEdits {
    explicit MeshEdits(std::pmr::memory_resource* memory) noexcept
        : given(memory), off(memory), removed(memory), removed_vertices(memory), tets_of(memory) {}

    Array<Tet> given;  // corners as given by the caller; empty while no tet is off
    Bits off, removed; // tets; removed ones are off, too
    Bits removed_vertices;
    IndexLists tets_of; // the tets at each vertex, from the first edit on
    bool has_tets_of = false;
};

// Made by the first call of get(), and then kept. If several threads call at the same time, each makes a
// value, and the first one ready is kept.
template <class T>
class Lazy {
public:
    Lazy() noexcept = default;
    Lazy(Lazy&& other) noexcept : made_(other.made_.exchange(nullptr)) {}
    Lazy& operator=(Lazy&& other) noexcept {
        delete made_.exchange(other.made_.exchange(nullptr));
        return *this;
    }
    ~Lazy() { reset(); }

    // The reference is valid until the next call that is not const.
    template <class Make>
    const T& get(Make&& make) const {
        if (const T* made = made_.load(std::memory_order_acquire)) return *made;
        auto value = std::make_unique<T>(std::forward<Make>(make)());
        const T* first = nullptr;
        if (!made_.compare_exchange_strong(first, value.get(), std::memory_order_acq_rel,
                                           std::memory_order_acquire))
            return *first;
        return *value.release();
    }

    void reset() noexcept { delete made_.exchange(nullptr); }

private:
    mutable std::atomic<const T*> made_ = nullptr;
};

class Mesh {
public:
    // An empty slot's mesh.
    explicit Mesh(std::pmr::memory_resource* memory) noexcept
        : topology_(memory), tiled_(memory), own_tets_(memory), edits_(memory), owned_(memory),
          self_filter_(memory), exceptions_(memory), filter_(checked_filter({})) {}
    // Copies or borrows the arrays of a checked desc, as its flags say. `view` is what check_mesh() made of
    // it; `filter` is used in place of desc.filter.
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
    // Releases its memory.
    void drop_topology() noexcept;

    // The sample from which cell sizes are suggested, made by the first call.
    const MeshSample& sample() const;

    // Makes the tiles, unless that is done; needs positions.
    void make_tiles();
    const TiledMesh& tiled() const noexcept { return tiled_; }
    // Grows when the tiles are made anew; at least 1 once they are made.
    std::uint32_t tiles_version() const noexcept { return tiles_version_; }
    // Null before they are made.
    const Tiles* tiles_if_made() const noexcept { return has_tiles_ ? &tiled().tiles : nullptr; }

    // Makes the rings of the filter if necessary.
    void make_rings();

    // Edits. Each checks its arguments and takes the memory that it needs, then changes the mesh, then
    // repairs its prepared data, or invalidates what there is no memory to repair and what is cheaper to make
    // again. If an edit throws Error or what the memory throws, nothing has changed.
    void set_tets_enabled(std::span<const std::uint32_t> tets, bool enabled);
    void replace_tets(std::span<const std::uint32_t> tets, std::span<const Tet> corners);
    std::uint32_t append_tets(std::span<const Tet> corners); // the index of the first
    void remove_tets(std::span<const std::uint32_t> tets);
    std::uint32_t append_vertices(const vox_vertices_desc& desc);
    void remove_vertices(std::span<const std::uint32_t> vertices);

    // For a mesh without edits: sets which tets are off, which of these are removed, and which vertices are
    // removed (bits). Throws INVALID_MESH if these contradict each other or the tets.
    void restore_edits(std::span<const std::uint64_t> off, std::span<const std::uint64_t> removed,
                       std::span<const std::uint64_t> removed_vertices);

    // A mesh of another topology with this one's settings; `desc` and `view` are those of the constructor.
    // Without desc.positions, and with as many vertices as before, it keeps positions and rest pose.
    // take_over() completes it and cannot fail.
    Mesh with_topology(const vox_mesh_desc& desc, const Body& view) const;
    void take_over(Mesh&& before) noexcept;

    // Borrows positions and releases the mesh's own ones.
    void bind(const Positions& positions) noexcept;

    // The mesh's own positions, for the caller to write to: at first a copy of the borrowed ones in their
    // format, or zeros if there are none.
    void* map_positions();

    // Throws MeshError(INVALID_ARGUMENT) if the positions are not of their format. Checks it once there are
    // enough of them, and again when another format is bound.
    void check_format_once(vox_body id);
    bool is_format_checked() const noexcept { return format_checked_; }
    // Positions with the transform; null before they are bound.
    Positions positions() const noexcept {
        Positions positions = positions_;
        if (has_transform_) positions.transform = transform_.data();
        return positions;
    }
    std::size_t position_size() const noexcept { return positions_.doubles ? sizeof(Vec3d) : sizeof(Vec3f); }

    // Three rows of four finite numbers; null: no transform.
    void set_transform(const double* matrix) noexcept;

    bool has_positions() const noexcept { return vertex_count_ == 0 || positions_.data != nullptr; }
    std::uint32_t vertex_count() const noexcept { return vertex_count_; }
    std::uint64_t tet_count() const noexcept { return tets().size(); }
    std::uint64_t user_data() const noexcept { return user_data_; }
    vox_body_info info() const noexcept;

    // Corners as given by the caller, also of a tet that is off.
    const Tet& given(std::uint32_t tet) const noexcept {
        return edits_.given.empty() ? tets_[tet] : edits_.given[tet];
    }
    bool is_off(std::uint32_t tet) const noexcept { return edits_.off[tet]; }

    // What makes a body without vertices a shape; null for a mesh.
    const std::shared_ptr<const RigidShape>& shape() const noexcept { return shape_; }
    void set_shape(std::shared_ptr<const RigidShape> shape) noexcept { shape_ = std::move(shape); }

    // Sets a checked filter. Where that needs a rest pose and there is none, it is copied from the positions.
    // Throws Error(INVALID_STATE or NON_FINITE) or what the memory throws, and changes nothing then.
    void set_filter(const vox_filter& filter);
    const vox_filter& filter() const noexcept { return filter_; }

    void set_enabled(bool enabled) noexcept { enabled_ = enabled; }
    bool is_enabled() const noexcept { return enabled_; }

    // Meshes that this one does not collide with, ascending. After reserve_exception(), adding one cannot
    // fail.
    void reserve_exception();
    void add_exception(vox_body other) noexcept;
    void remove_exception(vox_body other) noexcept { erase(exceptions_, other); }
    std::span<const vox_body> exceptions() const noexcept { return exceptions_; }

    Body body(vox_body id) const noexcept;

private:
    friend class Snapshot;

    // The positions of vertices to append, or of all `count` vertices.
    Positions check_appended(const vox_vertices_desc& desc, std::uint32_t count) const;

    // A view of packed positions in the mesh's format.
    Positions packed(const void* data) const noexcept;

    // Throws NON_FINITE or LIMIT.
    RestPose rest_pose(const Positions& positions, std::uint32_t count) const;

    // Edits.
    std::pmr::memory_resource* memory() const noexcept { return owned_.memory(); }
    std::span<const Tet> tets() const noexcept { return tets_; }
    bool borrows_tets() const noexcept { return !tets_.empty() && own_tets_.data() != tets_.data(); }
    void check_tets(std::span<const std::uint32_t> tets) const;
    void check_corners(std::uint32_t tet, const Tet& corners) const;
    void switch_off(std::uint32_t tet, Array<TetChange>& changes) noexcept;
    Array<Tet>& own_tets();
    MeshEdits& reserve_off();
    MeshEdits& list_tets_of();
    void apply(std::span<const TetChange> changes) noexcept;
    void apply_vertices(std::uint32_t count_before) noexcept;
    void invalidate_tiles() noexcept;
    void invalidate_prepared() noexcept;

    // Prepared of the tetrahedra as they are.
    Topology topology_;
    TiledMesh tiled_;
    Array<Tet> own_tets_; // empty where those of the caller are borrowed
    MeshEdits edits_;
    Array<double> owned_; // positions, packed in their format, unless they are borrowed
    Lazy<MeshSample> sample_;
    std::shared_ptr<const RigidShape> shape_;
    SelfFilter self_filter_;
    Array<vox_body> exceptions_;
    vox_filter filter_;
    std::uint64_t user_data_ = 0;
    // Each step looks at the members from here on.
    std::array<double, 12> transform_{};
    Positions positions_; // without the transform
    // For the stages: tets that are off name one vertex four times. The caller's, or in own_tets_.
    std::span<const Tet> tets_;
    std::uint32_t vertex_count_ = 0;
    std::uint32_t tiles_version_ = 0;
    std::uint32_t topology_version_ = 0;
    bool owns_positions_ = false; // may be true while there are no vertices yet
    bool has_topology_ = false, has_tiles_ = false, has_rings_ = false;
    bool has_transform_ = false;
    bool format_checked_ = false; // the positions are of their format
    bool enabled_ = true;
};

} // namespace vox
