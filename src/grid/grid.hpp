// A grid: meshes, settings, and step(), which runs the stages in order.
#pragma once

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "cell_size/adaptive.hpp"
#include "cell_size/scene.hpp"
#include "fast/engine.hpp"
#include "grid/constraint_stage.hpp"
#include "grid/mesh_table.hpp"
#include "grid/pairs.hpp"
#include "grid/surface_stages.hpp"
#include "query/locator.hpp"
#include "reference/engine.hpp"

#include <vox/vox_cell_size.h>

#include <optional>

namespace vox {

class Snapshot;

// Throw Error(INVALID_ARGUMENT) naming the field and its value.
void check_grid_desc(const vox_grid_desc& desc);
void check_flags(std::uint32_t flags);

} // namespace vox

// What the public functions of a grid do; those of a mesh, of pairs, queries and snapshots go on from here
// to their own classes. Members that are not noexcept throw; one that throws has changed nothing
// (for step, see vox_grid_step).
struct vox_grid {
public:
    // `desc` is checked. Everything is taken from `memory`.
    vox_grid(const vox_grid_desc& desc, const vox::MemoryShare& memory);
    vox_grid(const vox_grid&) = delete;
    vox_grid& operator=(const vox_grid&) = delete;

    void clear();
    void reserve(std::uint32_t mesh_count, std::uint64_t contact_count);
    void prepare_meshes();
    void set_cell_size(double cell_size);
    void set_worker_count(std::uint32_t worker_count);
    void set_flags(std::uint32_t flags);
    std::uint32_t flags() const noexcept { return flags_; }
    void set_margin(double margin);
    vox_grid_info info() const noexcept;

    // For suggestions: the scene as it is now, and what the grid knows of a desc: its model, storage and
    // budget unless the caller chose these, and 1 - contacts / tets of the last step as a p_nc left at its
    // default. The first throws INVALID_STATE for a mesh without positions.
    void describe(vox::CellSizeScene& scene) const;
    void describe(vox_cell_size_desc& desc, bool chosen) const noexcept;
    const vox::CostWeights& weights() const noexcept { return adaptive_.weights(); }

    // `view` is what check_mesh() makes of `desc`, whose filter is not looked at; `filter` is checked.
    vox_body insert(const vox_mesh_desc& desc, const vox::Body& view, const vox_filter& filter);
    vox_body insert_shape(const vox_shape_desc& desc, const vox_filter& filter);
    // Makes a shape of a mesh without vertices.
    void become_shape(vox_body id, std::shared_ptr<const vox::RigidShape> shape);
    void remove(vox_body mesh);
    void mark_moved(vox_body mesh);
    void set_filter(vox_body mesh, const vox_filter& filter);
    void set_enabled(vox_body mesh, bool enabled);
    // Null: none.
    void set_transform(vox_body id, const double* matrix);
    void set_previous_transform(vox_body shape, const double* matrix);
    void set_pair_enabled(vox_body a, vox_body b, bool enabled);
    void set_topology(vox_body mesh, const vox_mesh_desc& desc, const vox::Body& view);
    // `positions` are checked; without data: it has none any more.
    void bind_previous(vox_body mesh, const vox::Positions& positions);
    std::uint32_t append_tets(vox_body mesh, std::span<const vox::Tet> corners);
    std::uint32_t append_vertices(vox_body mesh, const vox_vertices_desc& desc);
    // To be called after any other edit of a mesh, with the number of tets or vertices that it named.
    void was_edited(vox_body mesh, std::uint64_t count);
    bool is_valid(vox_body mesh) const noexcept { return meshes_.find(mesh) != nullptr; }
    // A mesh or a shape.
    vox::Mesh& body(vox_body id) { return meshes_[id].mesh; }
    const vox::Mesh& body(vox_body id) const { return meshes_[id].mesh; }
    // Throw INVALID_ARGUMENT for a shape.
    vox::Mesh& mesh(vox_body id) { return const_cast<vox::Mesh&>(std::as_const(*this).mesh(id)); }
    const vox::Mesh& mesh(vox_body id) const;
    const vox::MeshTable& meshes() const noexcept { return meshes_; }
    const vox::FastEngine& fast_engine() const noexcept { return fast_engine_; }

    void step();

    void find_constraints(vox_constraint_desc desc);
    // Throws INVALID_STATE unless they were found since the last step.
    vox_constraint_view constraints() const;

    vox_locator* take_locator();

    vox_contact_view contacts() const noexcept;
    vox_failure failure(std::uint32_t index) const noexcept;
    std::uint64_t epoch() const noexcept { return epoch_; }
    const vox::Pairs& pairs() const noexcept { return pairs_; }
    std::uint64_t hash() const noexcept;
    vox_counter_view counters() const noexcept { return {counter_list_, std::size(counter_list_)}; }
    const vox::MemoryShare& memory() const noexcept { return share_; }

private:
    friend class vox::Snapshot;

    bool finds_constraints() const noexcept { return (flags_ & VOX_GRID_CONSTRAINTS) != 0; }
    bool skips_bad_meshes() const noexcept { return (flags_ & VOX_GRID_SKIP_BAD_BODIES) != 0; }
    bool needs_topology(const vox_filter& filter) const noexcept {
        return (finds_constraints() && !vox::is_sensor(filter)) || surfaces_.reads_surfaces();
    }
    void prepare(vox::Mesh& mesh, vox::fast::MeshState& state);
    void make_topologies();
    void drop_topologies() noexcept;
    void drop_unused() noexcept;
    void list_counters() noexcept;
    void scene_changed() noexcept;
    bool chooses_cell_size() const noexcept { return requested_cell_size_ == 0; }
    void begin_step() noexcept;
    void gather_bodies(vox::Counters& counters);
    void detect(bool& carry, vox::Counters& counters, vox::Profile& profile);
    bool make_contacts(bool carry, vox::Counters& counters, vox::Profile& profile);
    bool search_surfaces(vox::Counters& counters, vox::Profile& profile);
    void make_constraints(const vox_constraint_desc& desc, bool in_step, vox::Counters& counters,
                          vox::Profile& profile);
    void count(vox::Counters& counters);
    void leave_out_bad_meshes();
    void forget_contacts() noexcept;
    bool is_left_out(const vox::Body& body) const noexcept;
    vox_failure failure_of(vox_result result, vox_body mesh, std::uint32_t vertex) const noexcept;
    void warn_of_traps(const vox::Mesh& mesh, vox_body id);
    void drop_removed_vertices();
    void detect_fast(bool carry, vox::Counters& counters, vox::Profile& profile);
    std::uint64_t carry_contacts();
    void detect_reference(vox::Counters& counters, vox::Profile& profile);
    void choose_cell_size();
    double byte_limit() const noexcept;
    void write_log(vox_log_level level, const char* text) const;
    // A warning about a call that has succeeded: it takes no memory, so that it cannot fail.
    VOX_PRINTF(2)
    void warn(const char* pattern, ...) const noexcept;

    vox::MemoryShare share_; // first, as all else is released to it
    vox::GridMemory& memory_;
    vox_log log_;
    vox_task_system tasks_;
    vox::Workers workers_;

    // settings
    bool fast_;
    vox::ReferenceSettings settings_; // each step sets the cell size in it
    std::uint32_t flags_;             // vox_grid_flags
    double requested_cell_size_;      // 0: the library chooses it; the fast engine itself, for each window
    double used_cell_size_;           // in the last step; before the first one the requested one
    vox::AdaptiveCellSize adaptive_;  // chooses for the reference engine

    vox::MeshTable meshes_;

    // one step, and its results
    vox::StepData step_;
    vox::FastEngine fast_engine_;
    vox::ReferenceEngine reference_;
    vox::SurfaceStages surfaces_;
    vox::Pairs pairs_;
    std::optional<vox::ConstraintStage> constraints_; // always there
    vox_failure failure_{};                           // of a mesh that made the last step fail
    vox::Array<vox_failure> left_out_;                // the meshes that the last step left out
    // Whether another step would find the same contacts between meshes that were in the last one and have not
    // moved since. False after every change of a setting that contacts may depend on.
    bool contacts_hold_ = false;
    // Whether the meshes, positions aside, are those of the last step of the fast engine.
    bool meshes_hold_ = false;
    bool stepped_ = false; // the last step succeeded, and the grid was not cleared since
    vox::Locators locators_;
    vox::Array<vox::QueryBody> query_bodies_; // in one call
    vox::Counters counters_{};
    vox::Profile profile_{};
    vox_counter counter_list_[std::size(vox::named_counters) + std::size(vox::named_times)]; // of both
    std::uint64_t epoch_ = 0;
    bool warned_of_edges_ = false; // of a mesh without tetrahedra
};
