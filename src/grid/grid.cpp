#include "grid/grid.hpp"

#include "base/bits.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "cell_size/suggest.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <utility>

namespace vox {

namespace {

// Whether this build has edge contacts, contacts within a margin and passages. The module for WebAssembly, where nobody could
// read them, is a twentieth smaller without.
#if defined(VOX_WITHOUT_SURFACE_CONTACTS)
constexpr bool finds_surface_contacts = false;
#else
constexpr bool finds_surface_contacts = true;
#endif

void check_surface_contacts(bool wanted) {
    if (!finds_surface_contacts && wanted)
        throw Error(VOX_ERROR_UNSUPPORTED, "this build finds no edge contacts, contacts within a margin or passages");
}

// Boxes of floats cannot grow by more (vertex_face_search.cpp).
constexpr double most_margin = 0x1p125;

void check_margin(double margin) {
    if (!(margin >= 0 && margin <= most_margin))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("margin is %g, expected a number from 0 to %g", margin, most_margin));
    check_surface_contacts(margin > 0);
}

} // namespace

void check_grid_desc(const vox_grid_desc& desc) {
    const auto refuse = [](const std::string& text) { throw Error(VOX_ERROR_INVALID_ARGUMENT, text); };
    check_enum(desc.engine, VOX_ENGINE_FAST, "grid engine");
    check_enum(desc.storage, VOX_STORAGE_DENSE, "grid storage");
    check_enum(desc.hash, VOX_HASH_PAPER, "grid hash");
    if (!(desc.cell_size >= 0) || std::isinf(desc.cell_size))
        refuse(format("grid cell_size is %g, expected a finite number >= 0", desc.cell_size));

    bool all_zero = true;
    for (int axis = 0; axis < 3; ++axis)
        all_zero = all_zero && desc.world_min[axis] == 0 && desc.world_max[axis] == 0;
    for (int axis = 0; axis < 3 && !all_zero; ++axis) {
        const double min = desc.world_min[axis], max = desc.world_max[axis];
        if (!std::isfinite(min) || !std::isfinite(max) || !(min < max))
            refuse(format("grid world is [%g, %g] on axis %d, expected finite min < max", min, max, axis));
    }
    if (desc.hash_table_size > VOX_MAX_VERTICES)
        refuse(format("grid hash_table_size is %llu, expected at most %u", llu(desc.hash_table_size),
                      VOX_MAX_VERTICES));
    if (!desc.allocator.allocate != !desc.allocator.release)
        refuse("grid allocator has one of allocate and release, expected both or none");
    check_workers(desc.tasks, desc.worker_count);
    check_flags(desc.flags);
    check_margin(desc.margin);
}

void check_flags(std::uint32_t flags) {
    constexpr std::uint32_t known_flags =
        VOX_GRID_PENETRATIONS | VOX_GRID_CONTACT_EVENTS | VOX_GRID_SKIP_BAD_MESHES | VOX_GRID_EDGE_CONTACTS;
    if (flags & ~known_flags)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("grid flags is 0x%x, of which 0x%x is unknown", flags, flags & ~known_flags));
    check_surface_contacts((flags & VOX_GRID_EDGE_CONTACTS) != 0);
}

namespace {

// Whether nothing was set in the desc of a grid but what the caller hands in.
bool is_zeroed(const vox_grid_desc& desc) noexcept {
    const vox_grid_desc zero{};
    vox_grid_desc bare = desc;
    bare.struct_size = 0;
    bare.allocator = {};
    bare.log = {};
    bare.tasks = {};
    return std::memcmp(&bare, &zero, sizeof zero) == 0;
}

bool is_bad(const Body& body) noexcept { return first_bad_vertex(body) != VOX_NO_VERTEX; }

} // namespace
} // namespace vox

using namespace vox;

vox_grid::vox_grid(const vox_grid_desc& desc, const MemoryShare& memory)
    : share_(memory), memory_(*memory), log_(desc.log), tasks_(desc.tasks),
      workers_(desc.tasks, desc.worker_count),
      fast_(desc.engine == VOX_ENGINE_FAST ||
            (desc.engine == VOX_ENGINE_AUTO && desc.storage == VOX_STORAGE_AUTO)),
      settings_{.storage = desc.storage,
                .hash = desc.hash,
                .hash_table_size = desc.hash_table_size,
                .world_min = {desc.world_min[0], desc.world_min[1], desc.world_min[2]},
                .world_max = {desc.world_max[0], desc.world_max[1], desc.world_max[2]}},
      skips_bad_meshes_((desc.flags & VOX_GRID_SKIP_BAD_MESHES) != 0), closest_budget_(desc.closest_budget),
      requested_cell_size_(desc.cell_size), used_cell_size_(desc.cell_size), shared_tets_(&memory_),
      meshes_(&memory_), bodies_(&memory_), prepared_(&memory_), lone_(&memory_), fast_engine_(&memory_),
      reference_(&memory_), topologies_(&memory_), trees_(&memory_), hits_(&memory_),
      surface_versions_(&memory_), contacts_(&memory_), interiors_(&memory_), left_out_(&memory_),
      penetrations_(&memory_), events_(&memory_, (desc.flags & VOX_GRID_CONTACT_EVENTS) != 0),
      readings_(&memory_), queries_(&memory_), query_views_(share_), query_bodies_(&memory_) {
    if (desc.flags & VOX_GRID_PENETRATIONS) depth_.emplace(&memory_, trees_);
    if (desc.flags & VOX_GRID_EDGE_CONTACTS) edges_.emplace(&memory_);
    set_margin(desc.margin);
    if (is_zeroed(desc))
        write_log(VOX_LOG_WARNING,
                  "vox_grid_desc is all 0: no penetrations, no byte budget and a thread per core; "
                  "vox_default_grid_desc and vox_grid_desc_init fill in the defaults");
}

// ---- meshes ---------------------------------------------------------------------------------------

// What the stages need of a mesh, unless it is there already. The topology comes first, as tiles use its
// facets.
void vox_grid::prepare(Mesh& mesh, fast::MeshState& state) {
    if (mesh.may_share()) mesh.share(shared_tets_);
    if (needs_topology(mesh.filter())) mesh.make_topology();
    if (!fast_ || !mesh.has_positions()) return;
    mesh.make_tiles();
    state.update(mesh.tiled(), mesh.tiles_version(), mesh.vertex_count());
}

vox_mesh vox_grid::insert(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter) {
    meshes_.check_room(view);
    Mesh mesh(desc, view, filter, &memory_);
    fast::MeshState state(&memory_);
    prepare(mesh, state);
    const vox_mesh id = meshes_.insert(std::move(mesh), std::move(state));
    scene_changed();
    warn_of_traps(meshes_[id].mesh, id);
    return id;
}

// What is allowed, but collides with less than one may think: each once, as a program may mean it.
void vox_grid::warn_of_traps(const Mesh& mesh, vox_mesh id) {
    if (!log_.write) return;
    const auto warn_of = [&](const char* text) noexcept {
        warn("mesh %u (slot %u, user data %llu) %s", id, slot_of(id), llu(mesh.user_data()), text);
    };
    const vox_filter& filter = mesh.filter();
    if (!warned_of_filter_ && filter.group <= 0 && (filter.category == 0 || filter.mask == 0)) {
        warned_of_filter_ = true;
        warn_of(filter.mask == 0
                    ? "collides with no other mesh: the mask of its filter is 0 (said once for a grid)"
                    : "collides with no other mesh: the category of its filter is 0 (said once for a grid)");
    }
    if (warned_of_edges_ || mesh.tet_count() > 0 || mesh.vertex_count() == 0) return;
    warned_of_edges_ = true;
    warn_of("has no tetrahedra: its vertices collide with the tetrahedra of other meshes, its edges and "
            "faces with nothing (said once for a grid; vox_counters.meshes_without_tets counts such "
            "meshes)");
}

// The last step of the fast engine does not describe the meshes any more.
void vox_grid::scene_changed() noexcept {
    adaptive_.scene_changed();
    meshes_hold_ = false;
}

void vox_grid::remove(vox_mesh id) {
    meshes_.remove(id);
    trees_.forget(id);
    if (edges_) edges_->forget(id);
    if (near_faces_) near_faces_->forget(id);
    if (passages_) passages_->forget(id);
    scene_changed();
}

void vox_grid::clear() {
    meshes_.clear();
    trees_.forget_all();
    scene_changed();
    if (edges_) {
        edges_->forget_all();
        edges_->clear();
    }
    passages_.reset();
    if (margin_contacts_) margin_contacts_->clear();
    if (near_faces_) near_faces_->forget_all();
    look_near();
    contacts_.clear();
    interiors_.clear();
    penetrations_.clear();
    failure_ = {};
    left_out_.clear();
    contacts_hold_ = false;
    events_.hide_pairs();
    readings_.invalidate();
    queries_.invalidate();
    query_views_.clear();
    query_bodies_.clear();
    ++epoch_;
}

void vox_grid::mark_moved(vox_mesh id) {
    meshes_hold_ = false;
    meshes_[id].state.invalidate_positions();
}

void vox_grid::set_filter(vox_mesh id, const vox_filter& filter) {
    Mesh& filtered = mesh(id);
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
        trees_.forget(id);
    }
    mark_moved(id);
    warn_of_traps(filtered, id);
}

void vox_grid::set_enabled(vox_mesh id, bool enabled) {
    mesh(id).set_enabled(enabled);
    mark_moved(id);
}

void vox_grid::set_pair_enabled(vox_mesh a, vox_mesh b, bool enabled) {
    Mesh &mesh_a = mesh(a), &mesh_b = mesh(b);
    if (a == b)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("mesh_a and mesh_b are both %u: self-collision is a matter of its filter", a));
    if (enabled) {
        mesh_a.remove_exception(b);
        mesh_b.remove_exception(a);
    } else {
        mesh_a.reserve_exception();
        mesh_b.reserve_exception();
        mesh_a.add_exception(b);
        mesh_b.add_exception(a);
    }
    mark_moved(a);
}

void vox_grid::bind_previous(vox_mesh id, const Positions& positions) {
    (void)mesh(id); // throws for an id that names no mesh
    check_surface_contacts(positions.data != nullptr);
    if (!passages_ && !positions.data) return;
    if (!passages_) passages_.emplace(&memory_);
    passages_->bind(id, positions);
    look_near();
}

// ---- cutting and growing --------------------------------------------------------------------------

void vox_grid::was_edited(vox_mesh id, std::uint64_t count) {
    if (count == 0) return;
    meshes_[id].query_tets = nullptr;
    mark_moved(id);
    trees_.topology_changed(id);
    adaptive_.scene_changed();
}

void vox_grid::set_topology(vox_mesh id, const vox_mesh_desc& desc, const Body& view) {
    const Mesh& old = mesh(id);
    meshes_.check_room(view, &old);
    Mesh made = old.with_topology(desc, view);
    fast::MeshState state(&memory_);
    prepare(made, state);
    meshes_.replace(id, std::move(made), std::move(state));
    trees_.topology_changed(id);
    if (edges_) edges_->forget(id);
    if (near_faces_) near_faces_->forget(id);
    if (passages_) passages_->forget(id);
    if (view.vertex_count == 0) contacts_hold_ = false; // no positions show that it changed
    scene_changed();
    warn_of_traps(meshes_[id].mesh, id);
}

std::uint32_t vox_grid::append_tets(vox_mesh id, std::span<const Tet> corners) {
    const Mesh& grown = mesh(id);
    meshes_.check_growth(0, corners.size());
    if (needs_topology(grown.filter())) check_tet_count(grown.tet_count() + corners.size());
    const std::uint32_t first = meshes_.append_tets(id, corners);
    was_edited(id, corners.size());
    return first;
}

std::uint32_t vox_grid::append_vertices(vox_mesh id, const vox_vertices_desc& desc) {
    (void)mesh(id); // throws for an id that names no mesh
    meshes_.check_growth(desc.count, 0);
    const std::uint32_t first = meshes_.append_vertices(id, desc);
    if (passages_ && desc.count > 0) passages_->forget(id);
    was_edited(id, desc.count);
    return first;
}

// ---- settings -------------------------------------------------------------------------------------

void vox_grid::reserve(std::uint32_t mesh_count, std::uint64_t contact_count) {
    meshes_.reserve(mesh_count);
    reserve_exactly(bodies_, mesh_count);
    reserve_exactly(prepared_, mesh_count);
    reserve_exactly(hits_, contact_count);
    reserve_exactly(contacts_, contact_count);
    reserve_exactly(interiors_, contact_count);
    if (finds_penetrations()) {
        penetrations_.reserve(contact_count);
        depth_->reserve(contact_count);
    }
    events_.reserve(mesh_count, static_cast<std::size_t>(contact_count));
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

std::uint32_t vox_grid::flags() const noexcept {
    return (finds_penetrations() ? std::uint32_t{VOX_GRID_PENETRATIONS} : 0u) |
           (events_.of_contacts() ? std::uint32_t{VOX_GRID_CONTACT_EVENTS} : 0u) |
           (skips_bad_meshes_ ? std::uint32_t{VOX_GRID_SKIP_BAD_MESHES} : 0u) |
           (edges_ ? std::uint32_t{VOX_GRID_EDGE_CONTACTS} : 0u);
}

void vox_grid::set_flags(std::uint32_t flags) {
    check_flags(flags);
    if (flags == this->flags()) return;
    const bool find = (flags & VOX_GRID_PENETRATIONS) != 0;
    if (find && !finds_penetrations()) find_penetrations();
    if (!find && finds_penetrations()) stop_finding_penetrations();
    const bool edges = (flags & VOX_GRID_EDGE_CONTACTS) != 0;
    if (edges && !edges_) edges_.emplace(&memory_); // the next step prepares what it needs
    if (!edges && edges_) {
        edges_.reset();
        drop_surfaces();
    }
    events_.set_of_contacts((flags & VOX_GRID_CONTACT_EVENTS) != 0);
    skips_bad_meshes_ = (flags & VOX_GRID_SKIP_BAD_MESHES) != 0;
    contacts_hold_ = false; // there is more, or less, to do with those of meshes at rest
    ++epoch_;
}

// All meshes get what the depth stage needs, or none.
void vox_grid::find_penetrations() {
    depth_.emplace(&memory_, trees_);
    std::pmr::vector<Mesh*> prepared(&memory_);
    try {
        prepared.reserve(meshes_.slot_count());
        meshes_.for_each([&](vox_mesh, MeshSlot& slot) {
            if (slot.mesh.has_topology() || !needs_topology(slot.mesh.filter())) return;
            slot.mesh.make_topology();
            prepared.push_back(&slot.mesh);
        });
    } catch (...) {
        for (Mesh* mesh : prepared) mesh->drop_topology();
        depth_.reset();
        throw;
    }
}

void vox_grid::stop_finding_penetrations() noexcept {
    meshes_.for_each([](vox_mesh, MeshSlot& slot) { slot.mesh.drop_topology(); });
    shared_tets_.drop_topologies();
    depth_.reset();
    trees_.forget_all();
    penetrations_ = Penetrations(&memory_);
}

void vox_grid::set_margin(double margin) {
    check_margin(margin);
    if (margin == margin_) return;
    margin_ = margin;
    if (finds_surface_contacts && margin > 0 && !margin_contacts_) margin_contacts_.emplace(&memory_);
    if (margin == 0) margin_contacts_.reset();
    look_near();
    contacts_hold_ = false; // there is more, or less, to do with meshes at rest
    ++epoch_;
}

// The next step prepares what it needs; what none needs is given up.
void vox_grid::look_near() noexcept {
    const bool look = margin_contacts_ || passages_;
    if (look == near_faces_.has_value()) return;
    if (look) {
        near_faces_.emplace(&memory_);
    } else {
        near_faces_.reset();
        drop_surfaces();
    }
}

// Of those that nothing needs any more.
void vox_grid::drop_surfaces() noexcept {
    if (finds_surfaces()) return;
    surface_versions_ = std::pmr::vector<SurfaceVersion>(&memory_);
    meshes_.for_each([this](vox_mesh, MeshSlot& slot) {
        if (!needs_topology(slot.mesh.filter())) slot.mesh.drop_topology();
    });
    trees_.forget_all();
    if (!finds_penetrations()) shared_tets_.drop_topologies();
}

// ---- step -----------------------------------------------------------------------------------------

void vox_grid::step() {
    const std::uint64_t start = nanoseconds();
    bool carry = contacts_hold_;
    contacts_hold_ = meshes_hold_ = false;
    hits_.clear();
    events_.hide_pairs();
    events_.hide_events();
    readings_.invalidate();
    failure_ = {};
    left_out_.clear();
    if (passages_ && !passages_->any_bound()) {
        passages_.reset();
        look_near();
    }
    ++epoch_;

    vox_counters counters{};
    vox_profile profile{};
    try {
        detect(carry, counters, profile);
        drop_removed_vertices();

        const std::uint64_t detected = nanoseconds();
        if (carry && counters.moved_meshes < bodies_.size()) counters.carried_contacts = carry_contacts();
        // If every old contact was carried and no new one found, contacts, depth and events are unchanged.
        const bool all_carried =
            counters.carried_contacts == contacts_.size() && hits_.size() == contacts_.size();
        if (!all_carried) make_contacts(bodies_, hits_, contacts_, &workers_, &interiors_);
        std::uint64_t contacts_made = nanoseconds();
        profile.contacts_ns = contacts_made - detected;
        const bool same_edges = find_edges(counters);
        if (edges_) {
            profile.edges_ns = nanoseconds() - contacts_made;
            contacts_made += profile.edges_ns;
        }
        if (near_faces_) {
            find_near(counters);
            profile.margin_ns = nanoseconds() - contacts_made;
            contacts_made += profile.margin_ns;
        }

        if (all_carried) counters.carried_penetrations = penetrations_.all().size();
        if (depth_ && !all_carried) {
            depth_->find(bodies_, topologies_, hits_, contacts_, closest_budget_, &workers_, penetrations_,
                         counters);
            counters.carried_penetrations = penetrations_.carried();
            profile.depth_ns = nanoseconds() - contacts_made;
            contacts_made += profile.depth_ns;
        }

        if (carry && all_carried && same_edges)
            events_.repeat();
        else
            events_.update(contacts_, edges_ ? edges_->pairs() : std::span<const EdgePair>(),
                           meshes_.slot_count(), [this](vox_mesh id) { return mesh(id).user_data(); });
        profile.events_ns = nanoseconds() - contacts_made;
    } catch (const MeshError& error) {
        forget_contacts();
        failure_ = failure_of(error.result(), error.mesh, error.vertex);
        throw;
    } catch (...) {
        forget_contacts();
        throw;
    }

    counters.meshes = static_cast<std::uint32_t>(bodies_.size() + lone_.totals().bodies);
    counters.vertices = lone_.totals().vertices;
    counters.tets = lone_.totals().tets;
    counters.moved_meshes += carry ? lone_.totals().moved : lone_.totals().bodies;
    for (const Body& body : bodies_) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size() - body.off_count;
        counters.meshes_without_tets += body.tets.empty() && body.vertex_count > 0;
    }
    counters.skipped_meshes = left_out_.size();
    counters.contacts = contacts_.size();
    counters.penetrations = penetrations_.all().size();
    events_.count(counters);
    if (chooses_cell_size() && !fast_) {
        adaptive_.observe(counters);
        counters.cell_size_changes = adaptive_.changes();
    }
    if (closest_budget_ > 0) // those carried over included
        counters.unknown_penetrations = static_cast<std::uint64_t>(
            std::ranges::count(penetrations_.all(), VOX_PENETRATION_UNKNOWN, &vox_penetration::state));
    counters_ = counters;
    profile.step_ns = nanoseconds() - start;
    profile_ = profile;
    contacts_hold_ = fast_;
    meshes_hold_ = fast_ && left_out_.empty() && lone_.totals().bodies == 0;
    if (counters.unknown_penetrations > 0)
        warn("%llu of %llu penetrations are unknown: the closest_budget of %llu was used up",
             llu(counters.unknown_penetrations), llu(counters.penetrations), llu(closest_budget_));
}

// Returns whether there are the same edge contacts as in the last step, or none are looked for.
bool vox_grid::find_edges(vox_counters& counters) {
    if (!finds_surface_contacts || !edges_) return true;
    edges_->find({bodies_, topologies_, surface_versions_, fast_ ? &fast_engine_ : nullptr, &workers_},
                 counters);
    return edges_->unchanged();
}

// Vertices near or through surfaces that they are not inside of.
void vox_grid::find_near(vox_counters& counters) {
    if constexpr (!finds_surface_contacts) return;
    const EdgeScene scene{bodies_, topologies_, surface_versions_, fast_ ? &fast_engine_ : nullptr,
                          &workers_};
    if (passages_) passages_->find(scene, *near_faces_, counters);
    if (margin_contacts_) margin_contacts_->find(scene, margin_, contacts_, *near_faces_, counters);
}

void vox_grid::forget_contacts() noexcept {
    if (edges_) edges_->clear();
    if (margin_contacts_) margin_contacts_->clear();
    if (passages_) passages_->clear();
    contacts_.clear();
    interiors_.clear();
    penetrations_.clear();
    left_out_.clear();
}

// Finds the hits. If a coordinate of a mesh makes that fail, it starts again without all such meshes, where
// the flags ask for that. Then nothing is carried over, as the engine may have taken in the positions of
// others already.
void vox_grid::detect(bool& carry, vox_counters& counters, vox_profile& profile) {
    const auto detect_once = [&] {
        if (fast_ && !shared_tets_.empty() && !near_faces_) // a body near others is not alone
            lone_.find(meshes_, fast_engine_.last_step().moved_origin(), fast_engine_.pair_buffers(),
                       workers_);
        else
            lone_.forget(); // small bodies share their tets: there are none
        gather_bodies(counters);
        if (fast_)
            detect_fast(carry, counters, profile);
        else
            detect_reference(counters, profile);
    };
    try {
        return detect_once();
    } catch (const MeshError& error) {
        if (!skips_bad_meshes_ || error.vertex == VOX_NO_VERTEX) throw;
    }
    leave_out_bad_meshes();
    carry = false;
    hits_.clear();
    detect_once();
}

// Marks those that gather_bodies() leaves out, from now until they are well again.
void vox_grid::leave_out_bad_meshes() {
    meshes_.for_each([&](vox_mesh id, MeshSlot& slot) {
        if (slot.body == MeshSlot::none) return;
        const Body body = slot.mesh.body(id);
        const std::uint32_t vertex = first_bad_vertex(body);
        if (vertex == VOX_NO_VERTEX) return;
        slot.left_out = true;
        slot.state.invalidate_positions(); // a later step must not take it for one at rest
        if (log_.write) warn("left out of the step: %s", position_error(body, vertex).what());
    });
}

bool vox_grid::is_left_out(const Body& body) const noexcept { return skips_bad_meshes_ && is_bad(body); }

vox_failure vox_grid::failure_of(vox_result result, vox_mesh id, std::uint32_t vertex) const noexcept {
    vox_failure failure{};
    failure.result = result;
    failure.mesh = id;
    failure.slot = slot_of(id);
    failure.vertex = vertex;
    if (const MeshSlot* slot = meshes_.find(id)) {
        failure.user_data = slot->mesh.user_data();
        if (vertex < slot->mesh.vertex_count()) {
            const Vec3d p = slot->mesh.body(id).positions.exact(vertex);
            failure.position[0] = p.x, failure.position[1] = p.y, failure.position[2] = p.z;
        }
    }
    return failure;
}

void vox_grid::gather_bodies(vox_counters& counters) {
    counters.disabled_meshes = 0;
    left_out_.clear();
    bodies_.clear();
    topologies_.clear();
    surface_versions_.clear();
    prepared_.clear();
    const auto gather = [&](vox_mesh id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        slot.body = MeshSlot::none;
        if (!mesh.is_enabled()) {
            ++counters.disabled_meshes;
            return;
        }
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, mesh.body(id),
                            " has no positions: bind some before the step");
        mesh.check_format_once(id);
        if (slot.left_out) { // looked at before the engine does, as others may be at rest
            const std::uint32_t vertex = first_bad_vertex(mesh.body(id));
            slot.left_out = skips_bad_meshes_ && vertex != VOX_NO_VERTEX;
            if (slot.left_out) {
                left_out_.push_back(failure_of(bad_position(mesh.body(id), vertex), id, vertex));
                return;
            }
        }
        slot.body = static_cast<std::uint32_t>(bodies_.size());
        // What edits invalidated, and what meshes inserted without positions lack.
        mesh.make_rings();
        prepare(mesh, slot.state);
        Body& body = bodies_.emplace_back(mesh.body(id));
        if (body.off_count == body.tets.size()) { // the stages need not look at them
            body.tets = {};
            body.off_count = 0;
        }
        topologies_.push_back(&mesh.topology());
        if (finds_surfaces()) surface_versions_.push_back({mesh.topology_version(), mesh.tiles_version()});
        slot.topology_version = mesh.topology_version();
        if (fast_)
            prepared_.push_back({&mesh.tiled().tiles, &mesh.tiled().boundary, &slot.state,
                                 lone_.compared(slot_of(id)), lone_.moved(slot_of(id))});
    };
    for (std::uint32_t s = 0; s < meshes_.slot_count(); ++s)
        if (!lone_.is_lone(s) && meshes_.slot(s).live)
            gather(make_id(s, meshes_.slot(s).generation), meshes_.slot(s));
}

// Removed vertices make no contacts.
void vox_grid::drop_removed_vertices() {
    if (std::all_of(bodies_.begin(), bodies_.end(),
                    [](const Body& body) { return body.removed_vertices.empty(); }))
        return;
    std::erase_if(
        hits_, [this](const Hit& hit) { return has_bit(bodies_[hit.body_a].removed_vertices, hit.vertex); });
}

void vox_grid::detect_fast(bool carry, vox_counters& counters, vox_profile& profile) {
    // The engine chooses a cell size for each of its windows unless one is set.
    const FastSettings settings{.cell_size = requested_cell_size_,
                                .workers = &workers_,
                                .carry = carry,
                                .keep_certified = edges_.has_value(),
                                .others = lone_.totals().rounded};
    fast_engine_.detect(bodies_, prepared_, settings, hits_, counters, profile);
    if (chooses_cell_size()) used_cell_size_ = fast_engine_.cell_size();
}

// Appends the contacts of the last step between meshes that have not moved as hits, and returns how many.
// Either all contacts of a vertex with a mesh are carried or none, so they become the same contacts again.
std::uint64_t vox_grid::carry_contacts() {
    const std::size_t found = hits_.size();
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) bodies_[b].carried = !fast_engine_.moved(b);
    const auto resting_body = [this](vox_mesh id) {
        const MeshSlot* slot = meshes_.find(id);
        return slot && slot->body != MeshSlot::none && bodies_[slot->body].carried ? slot->body
                                                                                   : MeshSlot::none;
    };
    for (const vox_contact& contact : contacts_) {
        Hit hit{};
        hit.body_a = resting_body(contact.mesh_a);
        hit.body_b = resting_body(contact.mesh_b);
        if (hit.body_a == MeshSlot::none || hit.body_b == MeshSlot::none) continue;
        hit.vertex = contact.vertex;
        hit.tet = contact.tet & 0x7fffffffu;
        hit.interior = interiors_[static_cast<std::size_t>(&contact - contacts_.data())] != 0;
        std::copy(contact.barycentric, contact.barycentric + 4, hit.weights.of);
        reserve_sparingly(hits_, hits_.size() + 1);
        hits_.push_back(hit);
    }
    return hits_.size() - found;
}

void vox_grid::detect_reference(vox_counters& counters, vox_profile& profile) {
    choose_cell_size();
    counters.moved_meshes = bodies_.size();
    reference_.detect(bodies_, settings_, hits_, counters, profile);
}

void vox_grid::choose_cell_size() {
    settings_.cell_size = requested_cell_size_;
    settings_.levels = {};
    if (!chooses_cell_size()) return;
    const double before = used_cell_size_;
    const std::uint64_t changes = adaptive_.changes();
    settings_.levels = adaptive_.cell_sizes(bodies_, settings_.storage, byte_limit(), &memory_);
    used_cell_size_ = settings_.levels[0].cell_size;
    if (before > 0 && adaptive_.changes() == changes) return;
    if (!log_.write) return;
    std::string text = format("cell size %.9g", used_cell_size_);
    for (std::size_t l = 1; l < settings_.levels.size(); ++l)
        text += format(", %.9g", settings_.levels[l].cell_size);
    text += before > 0 ? format(" after %.9g,", before) : " chosen";
    write_log(VOX_LOG_INFO,
              format("%s for %llu tets in %zu meshes", text.c_str(), llu(meshes_.tet_count()), bodies_.size())
                  .c_str());
}

// The most bytes that cells of dense storage may take: the budget less what the grid holds beside them, and
// less what a first step will take. 0: no limit.
double vox_grid::byte_limit() const noexcept {
    if (memory_.budget() == 0) return 0;
    double held = static_cast<double>(memory_.bytes());
    if (counters_.vertices == 0) // of positions, links and cells, and of boxes
        held +=
            40 * static_cast<double>(meshes_.vertex_count()) + 24 * static_cast<double>(meshes_.tet_count());
    else
        held -= static_cast<double>(reference_.cells().bucket_bytes());
    return std::max(0.9 * (static_cast<double>(memory_.budget()) - held), 4.0);
}

void vox_grid::describe(CellSizeScene& scene) const {
    const auto reserve_all = [this](auto&... lists) { (lists.reserve(meshes_.slot_count()), ...); };
    reserve_all(scene.bodies, scene.tiles, scene.meshes, scene.at_rest, scene.cleared);
    meshes_.for_each([&](vox_mesh id, const MeshSlot& slot) {
        const Mesh& mesh = slot.mesh;
        if (!mesh.is_enabled()) return;
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

void vox_grid::describe(vox_suggest_desc& desc, bool chosen) const noexcept {
    if (!chosen) {
        desc.model = fast_ ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
        desc.storage = settings_.storage;
        desc.byte_budget = memory_.budget();
    }
    if (counters_.tets == 0) return;
    const double p_nc = 1 - static_cast<double>(counters_.contacts) / static_cast<double>(counters_.tets);
    if (p_nc > 0 && p_nc < 1 && desc.p_nc == suggest_defaults().p_nc) desc.p_nc = p_nc;
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

// ---- readings --------------------------------------------------------------------------------------

void vox_grid::prepare_readings(const vox_readings_desc& desc) {
    constexpr std::uint32_t known = VOX_READING_POSITION | VOX_READING_SURFACE | VOX_READING_DEPTH;
    if (desc.what & ~known)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("desc.what is 0x%x, of which 0x%x is unknown", desc.what, desc.what & ~known));
    if (desc.mesh_a == VOX_NULL_MESH && desc.mesh_b != VOX_NULL_MESH)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("desc.mesh_b is %u, but there is no mesh_a", desc.mesh_b));
    const vox_mesh meshes[2] = {desc.mesh_a, desc.mesh_b};
    const std::size_t named = desc.mesh_a == VOX_NULL_MESH ? 0 : desc.mesh_b == VOX_NULL_MESH ? 1 : 2;
    for (std::size_t i = 0; i < named; ++i) (void)mesh(meshes[i]); // throws for an id that names no mesh

    for (ReadingBody& reading : readings_.choose(events_, {meshes, named})) {
        const vox_mesh id = reading.body.mesh_id;
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
    std::pmr::vector<EdgeBody> bodies(&memory_);
    bodies.reserve(2 * edges_->pairs().size());
    for (const EdgePair& pair : edges_->pairs())
        for (const vox_mesh id : {pair.mesh_a, pair.mesh_b}) {
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

    std::pmr::vector<vox_mesh> entered(&memory_);
    for (const vox_edge_contact& contact : contacts)
        if (contact.mesh_a != contact.mesh_b && (entered.empty() || entered.back() != contact.mesh_b))
            entered.push_back(contact.mesh_b);
    std::ranges::sort(entered);
    entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
    for (const vox_mesh id : entered) trees_.add(id); // which moves those of others
    for (EdgeBody& b : bodies) {
        const vox_mesh id = b.body.mesh_id;
        if (!std::ranges::binary_search(entered, id)) continue;
        depth::SurfaceTree& tree = trees_[id];
        tree.update({&mesh(id).topology(), b.body.tets, b.body.positions}, false, &workers_);
        b.tree = &tree;
    }
    edges_->prepare_depths(bodies, workers_);
}

// ---- queries ---------------------------------------------------------------------------------------

void vox_grid::list_query_bodies() {
    query_bodies_.clear();
    meshes_.for_each([&](vox_mesh id, MeshSlot& slot) {
        Mesh& mesh = slot.mesh;
        if (!mesh.is_enabled() || mesh.tet_count() == 0) return;
        const Body body = mesh.body(id);
        if (!mesh.has_positions())
            throw MeshError(VOX_ERROR_INVALID_STATE, body, " has no positions: bind some before the queries");
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
}

void vox_grid::prepare_queries() {
    list_query_bodies();
    queries_.prepare(query_bodies_, workers_);
    query_bodies_.clear();
}

vox_query_view* vox_grid::take_query_view() {
    list_query_bodies();
    vox_query_view* view = query_views_.take(query_bodies_, workers_, epoch_);
    query_bodies_.clear();
    return view;
}

// ---- results --------------------------------------------------------------------------------------

vox_contact_view vox_grid::contacts() const noexcept {
    return {contacts_.data(), sizeof(vox_contact), contacts_.size(), epoch_};
}

vox_interior_view vox_grid::interiors() const noexcept {
    return {interiors_.data(), sizeof(std::uint8_t), interiors_.size(), epoch_};
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

vox_counters vox_grid::counters() const noexcept {
    vox_counters counters = counters_;
    counters.bytes = memory_.bytes();
    counters.peak_bytes = memory_.peak_bytes();
    return counters;
}
