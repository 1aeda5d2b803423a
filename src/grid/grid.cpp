#include "grid/grid.hpp"

#include "base/caller_memory.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "cell_size/suggest.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"
#include "shape/shape.hpp"

#include <cmath>
#include <cstdarg>
#include <cstring>
#include <utility>

namespace vox {

namespace {

// Boxes of floats cannot grow by more (vertex_face_search.cpp).
constexpr double most_margin = 0x1p125;

void check_margin(double margin) {
    if (!(margin >= 0 && margin <= most_margin))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("margin is %g, expected a number from 0 to %g", margin, most_margin));
}

ReferenceSettings read_reference(const vox_reference_desc* given) {
    const vox_reference_desc desc = read_struct(given, "reference");
    check_reference_flags(desc.flags, "reference flags");
    bool all_zero = true;
    for (int axis = 0; axis < 3; ++axis)
        all_zero = all_zero && desc.world_min[axis] == 0 && desc.world_max[axis] == 0;
    for (int axis = 0; axis < 3 && !all_zero; ++axis) {
        const double min = desc.world_min[axis], max = desc.world_max[axis];
        if (!std::isfinite(min) || !std::isfinite(max) || !(min < max))
            refuse(
                format("reference world is [%g, %g] on axis %d, expected finite min < max", min, max, axis));
    }
    if (desc.hash_table_size > VOX_MAX_VERTICES)
        refuse(format("reference hash_table_size is %llu, expected at most %u", llu(desc.hash_table_size),
                      VOX_MAX_VERTICES));
    return {.dense = (desc.flags & VOX_REFERENCE_DENSE) != 0,
            .paper_hash = (desc.flags & VOX_REFERENCE_PAPER_HASH) != 0,
            .hash_table_size = desc.hash_table_size,
            .world_min = {desc.world_min[0], desc.world_min[1], desc.world_min[2]},
            .world_max = {desc.world_max[0], desc.world_max[1], desc.world_max[2]}};
}

void check_matrix(const double* matrix, bool of_shape) {
    for (int i = 0; matrix && i < 12; ++i)
        if (!std::isfinite(matrix[i]))
            refuse(format("matrix[%d] is %g, expected a finite number", i, matrix[i]));
    if (matrix && of_shape) ShapePlace::check(matrix, "matrix");
}

CostWeights weights_of(const vox_reference_desc* given) {
    return read_weights(given ? read_struct(given, "reference").weights : nullptr);
}

} // namespace

void check_grid_desc(const vox_grid_desc& desc) {
    if (!(desc.cell_size >= 0) || std::isinf(desc.cell_size))
        refuse(format("grid cell_size is %g, expected a finite number >= 0", desc.cell_size));
    if (desc.max_constraints_per_pair > VOX_MAX_CONSTRAINTS_PER_PAIR)
        refuse(format("grid max_constraints_per_pair is %u, expected at most %u",
                      desc.max_constraints_per_pair, VOX_MAX_CONSTRAINTS_PER_PAIR));
    check_allocator(desc.allocator, "grid allocator");
    check_workers(value_of(desc.tasks), desc.worker_count);
    check_flags(desc.flags);
    check_margin(desc.margin);
    if (desc.reference) (void)read_reference(desc.reference);
    (void)weights_of(desc.reference);
}

void check_flags(std::uint32_t flags) {
    constexpr std::uint32_t known_flags = VOX_GRID_CONSTRAINTS | VOX_GRID_SKIP_BAD_BODIES | VOX_GRID_EDGES;
    if (flags & ~known_flags)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("grid flags is 0x%x, of which 0x%x is unknown", flags, flags & ~known_flags));
}

} // namespace vox

using namespace vox;

vox_grid::vox_grid(const vox_grid_desc& desc, const MemoryShare& memory)
    : share_(memory), memory_(*memory), log_(value_of(desc.log)), tasks_(value_of(desc.tasks)),
      workers_(tasks_, desc.worker_count), fast_(!desc.reference),
      settings_(desc.reference ? read_reference(desc.reference) : ReferenceSettings{}), flags_(desc.flags),
      requested_cell_size_(desc.cell_size), used_cell_size_(desc.cell_size),
      adaptive_(weights_of(desc.reference)), meshes_(&memory_), step_(&memory_), fast_engine_(&memory_),
      reference_(&memory_), surfaces_(&memory_), pairs_(&memory_),
      constraints_(std::in_place, &memory_, desc.max_constraints_per_pair), left_out_(&memory_),
      locators_(share_), query_bodies_(&memory_) {
    surfaces_.find_edges((flags_ & VOX_GRID_EDGES) != 0);
    surfaces_.set_margin(desc.margin);
    list_counters();
}

// ---- meshes ---------------------------------------------------------------------------------------

// What the stages need of a mesh, unless it is there already. The topology comes first, as tiles use its
// facets.
void vox_grid::prepare(Mesh& mesh, fast::MeshState& state) {
    if (needs_topology(mesh.filter())) mesh.make_topology();
    if (!mesh.has_positions()) return;
    if (fast_) {
        mesh.make_tiles();
        state.update(mesh.tiled(), mesh.tiles_version(), mesh.vertex_count());
    } else if (surfaces_.any()) {
        mesh.make_tiles();
    }
}

// Also what stages make of a surface when they first search it. If that fails, what is made stays.
void vox_grid::prepare_meshes() {
    meshes_.for_each([&](vox_body id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        if (mesh.tet_count() == 0 || !mesh.has_positions()) return;
        mesh.check_format_once(id);
        if (is_left_out(mesh.body(id))) return;
        check_finite(mesh.body(id));
        mesh.make_rings();
        prepare(mesh, slot.state);
        if (!mesh.has_topology() || mesh.topology().triangles.empty()) return;
        const Body body = mesh.body(id);
        if (finds_constraints() && !is_sensor(mesh.filter()))
            constraints_->prepare(body, mesh.topology(),
                                  (mesh.filter().flags & VOX_FILTER_SELF_COLLISION) != 0);
        if (surfaces_.reads_surfaces())
            surfaces_.prepare(body, mesh.topology(), {mesh.topology_version(), mesh.tiles_version()},
                              mesh.tiled().tiles);
    });
}

vox_body vox_grid::insert(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter) {
    meshes_.check_room(view);
    Mesh mesh(desc, view, filter, &memory_);
    fast::MeshState state(&memory_);
    prepare(mesh, state);
    const vox_body id = meshes_.insert(std::move(mesh), std::move(state));
    scene_changed();
    warn_of_traps(meshes_[id].mesh, id);
    return id;
}

vox_body vox_grid::insert_shape(const vox_shape_desc& desc, const vox_filter& filter) {
    vox_mesh_desc empty = vox_default_mesh_desc();
    empty.user_data = desc.user_data;
    std::shared_ptr<const RigidShape> shape = make_shape(desc, &memory_);
    surfaces_.find_shapes(true); // the last that can fail, but for insert()
    const vox_body id = insert(empty, check_mesh(empty, "", NullPositions::allowed), filter);
    become_shape(id, std::move(shape));
    return id;
}

void vox_grid::become_shape(vox_body id, std::shared_ptr<const RigidShape> shape) {
    const vox_body_info info = body(id).info();
    check_matrix(info.transform, true);
    surfaces_.find_shapes(true);
    meshes_.become_shape(id, std::move(shape));
    surfaces_.shapes()->change();
}

// What is allowed, but collides with less than one may think: each once, as a program may mean it.
void vox_grid::warn_of_traps(const Mesh& mesh, vox_body id) {
    if (!log_.write || warned_of_edges_ || mesh.tet_count() > 0 || mesh.vertex_count() == 0) return;
    warned_of_edges_ = true;
    warn("body %u (slot %u, user data %llu) has no tetrahedra: its vertices collide with the tetrahedra of "
         "other meshes, its edges and "
         "faces with nothing (said once for a grid; the counter bodies_without_tets counts such "
         "meshes)",
         id, slot_of(id), llu(mesh.user_data()));
}

// The last step of the fast engine does not describe the meshes any more.
void vox_grid::scene_changed() noexcept {
    adaptive_.scene_changed();
    meshes_hold_ = false;
}

void vox_grid::remove(vox_body id) {
    if (body(id).shape()) contacts_hold_ = false; // without the stage of shapes, pairs are not looked at anew
    meshes_.remove(id);
    constraints_->forget(id);
    surfaces_.topology_changed(id);
    scene_changed();
}

void vox_grid::clear() {
    meshes_.clear();
    scene_changed();
    forget_contacts();
    surfaces_.forget_all();
    drop_unused();
    constraints_->clear(true);
    stepped_ = false;
    failure_ = {};
    contacts_hold_ = false;
    pairs_.hide();
    locators_.clear();
    query_bodies_.clear();
    ++epoch_;
}

void vox_grid::mark_moved(vox_body id) {
    meshes_hold_ = false;
    meshes_[id].state.invalidate_positions();
    if (meshes_[id].mesh.shape()) surfaces_.shapes()->change();
}

const Mesh& vox_grid::mesh(vox_body id) const {
    const Mesh& found = meshes_[id].mesh;
    if (found.shape()) refuse(format("body %u is a shape, expected a mesh", id));
    return found;
}

void vox_grid::set_transform(vox_body id, const double* matrix) {
    Mesh& placed = body(id);
    check_matrix(matrix, placed.shape() != nullptr);
    if (placed.shape()) surfaces_.shapes()->change();
    placed.set_transform(matrix);
}

void vox_grid::set_previous_transform(vox_body id, const double* matrix) {
    if (!body(id).shape())
        refuse(format("body %u is a mesh, expected a shape: vox_mesh_bind_previous_positions says where its "
                      "vertices were",
                      id));
    check_matrix(matrix, true);
    surfaces_.shapes()->bind_previous(id, matrix);
}

void vox_grid::set_filter(vox_body id, const vox_filter& filter) {
    Mesh& filtered = body(id);
    const bool had_topology = filtered.has_topology(), needed_it = needs_topology(filtered.filter());
    if (needs_topology(filter)) filtered.make_topology();
    try {
        filtered.set_filter(filter);
    } catch (...) {
        if (!had_topology) filtered.drop_topology();
        throw;
    }
    if (needed_it && !needs_topology(filter)) {
        filtered.drop_topology();
        constraints_->forget(id);
    }
    mark_moved(id);
    warn_of_traps(filtered, id);
}

void vox_grid::set_enabled(vox_body id, bool enabled) {
    body(id).set_enabled(enabled);
    mark_moved(id);
}

void vox_grid::set_pair_enabled(vox_body a, vox_body b, bool enabled) {
    Mesh &body_a = body(a), &body_b = body(b);
    if (a == b)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("body_a and body_b are both %u: self-collision is a matter of its filter", a));
    if (enabled) {
        body_a.remove_exception(b);
        body_b.remove_exception(a);
    } else {
        body_a.reserve_exception();
        body_b.reserve_exception();
        body_a.add_exception(b);
        body_b.add_exception(a);
    }
    mark_moved(a);
}

void vox_grid::bind_previous(vox_body id, const Positions& positions) {
    (void)mesh(id);                              // throws for an id that names no mesh
    if (!positions.data) contacts_hold_ = false; // as in remove(), without impacts
    surfaces_.bind_previous(id, positions);
}

// ---- cutting and growing --------------------------------------------------------------------------

void vox_grid::was_edited(vox_body id, std::uint64_t count) {
    if (count == 0) return;
    meshes_[id].query_tets = nullptr;
    meshes_[id].edited = true;
    mark_moved(id);
    constraints_->topology_changed(id);
    adaptive_.scene_changed();
}

void vox_grid::set_topology(vox_body id, const vox_mesh_desc& desc, const Body& view) {
    const Mesh& old = mesh(id);
    meshes_.check_room(view, &old);
    Mesh made = old.with_topology(desc, view);
    fast::MeshState state(&memory_);
    prepare(made, state);
    meshes_.replace(id, std::move(made), std::move(state));
    meshes_[id].edited = true;
    constraints_->topology_changed(id);
    surfaces_.topology_changed(id);
    if (view.vertex_count == 0) contacts_hold_ = false; // no positions show that it changed
    scene_changed();
    warn_of_traps(meshes_[id].mesh, id);
}

std::uint32_t vox_grid::append_tets(vox_body id, std::span<const Tet> corners) {
    const Mesh& grown = mesh(id);
    meshes_.check_growth(0, corners.size());
    if (needs_topology(grown.filter())) check_tet_count(grown.tet_count() + corners.size());
    const std::uint32_t first = meshes_.append_tets(id, corners);
    was_edited(id, corners.size());
    return first;
}

std::uint32_t vox_grid::append_vertices(vox_body id, const vox_vertices_desc& desc) {
    (void)mesh(id); // throws for an id that names no mesh
    meshes_.check_growth(desc.count, 0);
    const std::uint32_t first = meshes_.append_vertices(id, desc);
    if (desc.count > 0) surfaces_.forget(id);
    was_edited(id, desc.count);
    return first;
}

// ---- settings -------------------------------------------------------------------------------------

void vox_grid::reserve(std::uint32_t mesh_count, std::uint64_t contact_count) {
    meshes_.reserve(mesh_count);
    reserve_exactly(step_.bodies, mesh_count);
    reserve_exactly(step_.prepared, mesh_count);
    reserve_exactly(step_.hits, contact_count);
    reserve_exactly(step_.contacts, contact_count);
    reserve_exactly(step_.interiors, contact_count);
    if (finds_constraints()) constraints_->reserve(mesh_count, contact_count);
    pairs_.reserve(mesh_count, static_cast<std::size_t>(contact_count));
    ++epoch_; // views of the contacts were left behind if they moved
}

void vox_grid::set_cell_size(double cell_size) {
    if (!(cell_size >= 0) || std::isinf(cell_size))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("cell_size is %g, expected a finite number >= 0", cell_size));
    requested_cell_size_ = used_cell_size_ = cell_size;
    adaptive_.restart();
    contacts_hold_ = false; // contacts do not depend on it, but the next step should show what it costs
}

void vox_grid::set_worker_count(std::uint32_t worker_count) {
    check_workers(tasks_, worker_count);
    workers_.set_count(worker_count);
    contacts_hold_ = false; // as in set_cell_size()
}

void vox_grid::set_flags(std::uint32_t flags) {
    check_flags(flags);
    if (flags == flags_) return;
    if (flags & ~flags_ & VOX_GRID_CONSTRAINTS) make_topologies();
    const bool no_constraints = (flags_ & ~flags & VOX_GRID_CONSTRAINTS) != 0;
    flags_ = flags;
    if (no_constraints) {
        constraints_.emplace(&memory_, constraints_->most_per_pair());
        drop_topologies();
    }
    surfaces_.find_edges((flags & VOX_GRID_EDGES) != 0);
    drop_unused();
    contacts_hold_ = false; // there is more, or less, to do with those of meshes at rest
    ++epoch_;
}

// All meshes get what the depth stage needs, or none.
void vox_grid::make_topologies() {
    Array<Mesh*> made(&memory_);
    try {
        made.reserve(meshes_.slot_count());
        meshes_.for_each([&](vox_body, MeshSlot& slot) {
            if (slot.mesh.has_topology() || is_sensor(slot.mesh.filter())) return;
            slot.mesh.make_topology();
            made.push_back(&slot.mesh);
        });
    } catch (...) {
        for (Mesh* mesh : made) mesh->drop_topology();
        throw;
    }
}

void vox_grid::drop_topologies() noexcept {
    meshes_.for_each([this](vox_body, MeshSlot& slot) {
        if (!needs_topology(slot.mesh.filter())) slot.mesh.drop_topology();
    });
    constraints_->forget_trees();
}

void vox_grid::set_margin(double margin) {
    check_margin(margin);
    if (margin == surfaces_.margin()) return;
    surfaces_.set_margin(margin); // the next step prepares what it needs
    drop_unused();
    contacts_hold_ = false; // there is more, or less, to do with meshes at rest
    ++epoch_;
}

// What no stage over surfaces needs any more.
void vox_grid::drop_unused() noexcept {
    if (meshes_.shape_count() == 0) surfaces_.find_shapes(false);
    if (!surfaces_.drop_unused()) return;
    step_.versions = Array<SurfaceVersion>(&memory_);
    drop_topologies();
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
        if (body != VOX_NULL_BODY) (void)this->body(body); // throws for an id that names no body
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

// ---- what a cell size is suggested from, and the log ------------------------------------------------

void vox_grid::describe(CellSizeScene& scene) const {
    const auto reserve_all = [this](auto&... lists) { (lists.reserve(meshes_.slot_count()), ...); };
    reserve_all(scene.bodies, scene.tiles, scene.meshes, scene.at_rest, scene.cleared);
    meshes_.for_each([&](vox_body id, const MeshSlot& slot) {
        const Mesh& mesh = slot.mesh;
        if (!mesh.is_enabled() || mesh.shape()) return;
        const Body body = mesh.body(id);
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, body, " has no positions: bind some before");
        if (!mesh.is_format_checked()) check_not_doubles(body);
        if (is_left_out(body)) return;
        scene.bodies.push_back(body);
        scene.tiles.push_back(mesh.tiles_if_made());
        scene.meshes.push_back(&mesh);
        scene.at_rest.push_back(!fast_engine_.moved(slot.body));
        scene.cleared.push_back(fast_engine_.cleared(slot.body, mesh.vertex_count()));
    });
    if (fast_ && meshes_hold_) scene.last_step = &fast_engine_;
}

void vox_grid::describe(vox_cell_size_desc& desc, bool chosen) const noexcept {
    if (!chosen) {
        desc.model = fast_ ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
        desc.reference_flags = settings_.dense ? VOX_REFERENCE_DENSE : 0;
        desc.byte_budget = memory_.budget();
    }
    if (counters_.tets == 0) return;
    const double p_nc = 1 - static_cast<double>(counters_.contacts) / static_cast<double>(counters_.tets);
    if (p_nc > 0 && p_nc < 1 && desc.p_nc == 0) desc.p_nc = p_nc;
}

void vox_grid::write_log(vox_log_level level, const char* text) const {
    if (!log_.write) return;
    const CallersFloats floats;
    log_.write(level, text, log_.user);
}

void vox_grid::warn(const char* pattern, ...) const noexcept {
    if (!log_.write) return;
    char text[400];
    va_list arguments;
    va_start(arguments, pattern);
    write_text(text, sizeof text, pattern, arguments);
    va_end(arguments);
    write_log(VOX_LOG_WARNING, text);
}
