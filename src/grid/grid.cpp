#include "grid/grid.hpp"

#include "base/bits.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "cell_size/suggest.hpp"
#include "grid/contacts.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace vox {

void check_grid_desc(const vox_grid_desc& desc) {
    const auto refuse = [](const std::string& text) { throw Error(VOX_ERROR_INVALID_ARGUMENT, text); };
    const auto check_enum = [&](const auto& field, int last, const char* name) {
        std::int32_t value; // copied as a number: a value outside the enum must not be read as one
        std::memcpy(&value, &field, sizeof value);
        if (value < 0 || value > last) refuse(format("grid %s is %d, expected 0 to %d", name, value, last));
    };
    check_enum(desc.engine, VOX_ENGINE_FAST, "engine");
    check_enum(desc.storage, VOX_STORAGE_DENSE, "storage");
    check_enum(desc.hash, VOX_HASH_PAPER, "hash");
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
        refuse(format("grid hash_table_size is %llu, expected at most %u",
                      static_cast<unsigned long long>(desc.hash_table_size), VOX_MAX_VERTICES));
    if (!desc.allocator.allocate != !desc.allocator.release)
        refuse("grid allocator has one of allocate and release, expected both or none");
    check_workers(desc.tasks, desc.worker_count);
    constexpr std::uint32_t known_flags = VOX_GRID_PENETRATIONS | VOX_GRID_CONTACT_EVENTS;
    if (desc.flags & ~known_flags)
        refuse(
            format("grid flags is 0x%x, of which 0x%x is unknown", desc.flags, desc.flags & ~known_flags));
}

namespace {

// Room for `count` elements, at least doubled when it grows, so that n insertions copy O(n) elements.
template <class T>
void grow_capacity(std::pmr::vector<T>& vector, std::size_t count) {
    if (count > vector.capacity()) vector.reserve(std::max(count, 2 * vector.capacity()));
}

} // namespace

void check_limit(std::uint64_t count, std::uint64_t added, std::uint64_t limit, const char* what) {
    if (added > limit - count)
        throw Error(VOX_ERROR_LIMIT,
                    format("the grid holds %llu %s and cannot take %llu more, the limit is %llu",
                           static_cast<unsigned long long>(count), what,
                           static_cast<unsigned long long>(added), static_cast<unsigned long long>(limit)));
}

} // namespace vox

using namespace vox;

vox_grid::vox_grid(const vox_grid_desc& desc, std::uint64_t held)
    : allocator_(desc.allocator), log_(desc.log), memory_(desc.allocator, desc.byte_budget, held),
      tasks_(desc.tasks), workers_(desc.tasks, desc.worker_count),
      fast_(desc.engine == VOX_ENGINE_FAST ||
            (desc.engine == VOX_ENGINE_AUTO && desc.storage == VOX_STORAGE_AUTO)),
      find_penetrations_((desc.flags & VOX_GRID_PENETRATIONS) != 0),
      settings_{.storage = desc.storage,
                .hash = desc.hash,
                .hash_table_size = desc.hash_table_size,
                .world_min = {desc.world_min[0], desc.world_min[1], desc.world_min[2]},
                .world_max = {desc.world_max[0], desc.world_max[1], desc.world_max[2]}},
      cell_size_(desc.cell_size), choose_cell_size_(desc.cell_size == 0), slots_(&memory_),
      free_slots_(&memory_), bodies_(&memory_), prepared_(&memory_), fast_engine_(&memory_),
      reference_(&memory_), topologies_(&memory_), depth_(&memory_), hits_(&memory_),
      contacts_(&memory_), penetrations_(&memory_),
      events_(&memory_, (desc.flags & VOX_GRID_CONTACT_EVENTS) != 0), readings_(&memory_),
      queries_(&memory_) {}

// ---- meshes ---------------------------------------------------------------------------------------

// What the stages need of a mesh, unless it is there already. The topology comes first, as tiles use its facets.
void vox_grid::prepare(Mesh& mesh, fast::MeshState& state) const {
    if (find_penetrations_) mesh.make_topology();
    if (!fast_ || !mesh.has_positions()) return;
    mesh.make_tiles();
    state.update(mesh.tiled(), mesh.tiles_version(), mesh.vertex_count());
}

vox_mesh vox_grid::insert(const vox_mesh_desc& desc, const Body& view) {
    check_limit(vertex_count_, view.vertex_count, VOX_MAX_VERTICES, "vertices");
    check_limit(tet_count_, view.tets.size(), VOX_MAX_TETS, "tets");
    const bool fresh_slot = free_slots_.empty();
    if (fresh_slot) check_limit(slots_.size(), 1, VOX_MAX_MESHES, "mesh slots");

    // Everything that can fail comes first.
    vox_filter filter = read_filter(desc.filter);
    if (desc.flags & VOX_MESH_SELF_COLLISION) filter.self_collision = 1;
    Mesh mesh(desc, view, filter, &memory_);
    fast::MeshState state(&memory_);
    prepare(mesh, state);
    if (fresh_slot) {
        grow_capacity(slots_, slots_.size() + 1);
        grow_capacity(free_slots_, slots_.size() + 1);
    }

    std::uint32_t slot;
    if (fresh_slot) {
        slot = static_cast<std::uint32_t>(slots_.size());
        slots_.emplace_back(&memory_);
    } else {
        slot = free_slots_.back();
        free_slots_.pop_back();
    }
    slots_[slot].mesh = std::move(mesh);
    slots_[slot].state = std::move(state);
    slots_[slot].live = true;
    slots_[slot].generation += 1;
    vertex_count_ += view.vertex_count;
    tet_count_ += view.tets.size();
    adaptive_.scene_changed();
    meshes_hold_ = false;
    return make_id(slot, slots_[slot].generation);
}

void vox_grid::remove(vox_mesh id) {
    (void)mesh(id); // throws for an id that names no mesh
    vacate(slot_of(id));
}

void vox_grid::clear() {
    for (std::size_t slot = slots_.size(); slot-- > 0;)
        if (slots_[slot].live) vacate(static_cast<std::uint32_t>(slot));
    contacts_.clear();
    penetrations_.clear();
    contacts_hold_ = false;
    events_.hide_pairs();
    readings_.forget();
    queries_.invalidate();
    ++epoch_;
}

void vox_grid::mark_moved(vox_mesh id) {
    meshes_hold_ = false;
    (void)mesh(id); // throws for an id that names no mesh
    slots_[slot_of(id)].state.invalidate_positions();
}

void vox_grid::set_filter(vox_mesh id, const vox_filter& filter) {
    mesh(id).set_filter(filter);
    mark_moved(id);
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

// ---- cutting and growing --------------------------------------------------------------------------

void vox_grid::was_cut(vox_mesh id, std::uint64_t count) {
    if (count == 0) return;
    mark_moved(id);
    adaptive_.scene_changed();
}

void vox_grid::set_topology(vox_mesh id, const vox_mesh_desc& desc, const Body& view) {
    Mesh& changed = mesh(id);
    check_limit(vertex_count_ - changed.vertex_count(), view.vertex_count, VOX_MAX_VERTICES, "vertices");
    check_limit(tet_count_ - changed.tet_count(), view.tets.size(), VOX_MAX_TETS, "tets");
    Mesh made = changed.with_topology(desc, view);
    fast::MeshState state(&memory_);
    prepare(made, state);
    vertex_count_ += view.vertex_count - std::uint64_t{changed.vertex_count()};
    tet_count_ += view.tets.size() - changed.tet_count();
    made.take_over(std::move(changed));
    changed = std::move(made);
    slots_[slot_of(id)].state = std::move(state);
    if (view.vertex_count == 0) contacts_hold_ = false; // nothing of it can be seen to move
    meshes_hold_ = false;
    adaptive_.scene_changed();
}

void vox_grid::set_tets_enabled(vox_mesh id, std::span<const std::uint32_t> tets, bool enabled) {
    mesh(id).set_tets_enabled(tets, enabled);
    was_cut(id, tets.size());
}

void vox_grid::replace_tets(vox_mesh id, std::span<const std::uint32_t> tets, std::span<const Tet> corners) {
    mesh(id).replace_tets(tets, corners);
    was_cut(id, tets.size());
}

std::uint32_t vox_grid::append_tets(vox_mesh id, std::span<const Tet> corners) {
    Mesh& grown = mesh(id);
    check_limit(tet_count_, corners.size(), VOX_MAX_TETS, "tets");
    if (find_penetrations_) check_tet_count(grown.tet_count() + corners.size());
    const std::uint32_t first = grown.append_tets(corners);
    tet_count_ += corners.size();
    was_cut(id, corners.size());
    return first;
}

void vox_grid::remove_tets(vox_mesh id, std::span<const std::uint32_t> tets) {
    mesh(id).remove_tets(tets);
    was_cut(id, tets.size());
}

std::uint32_t vox_grid::append_vertices(vox_mesh id, const vox_vertices_desc& desc) {
    Mesh& grown = mesh(id);
    check_limit(vertex_count_, desc.count, VOX_MAX_VERTICES, "vertices");
    const std::uint32_t first = grown.append_vertices(desc);
    vertex_count_ += desc.count;
    was_cut(id, desc.count);
    return first;
}

void vox_grid::remove_vertices(vox_mesh id, std::span<const std::uint32_t> vertices) {
    mesh(id).remove_vertices(vertices);
    was_cut(id, vertices.size());
}

// ---- more of meshes -------------------------------------------------------------------------------

void vox_grid::vacate(std::uint32_t slot) noexcept {
    Slot& s = slots_[slot];
    for (const vox_mesh other : s.mesh.exceptions())
        slots_[slot_of(other)].mesh.remove_exception(make_id(slot, s.generation));
    vertex_count_ -= s.mesh.vertex_count();
    tet_count_ -= s.mesh.tet_count();
    s.mesh = Mesh(&memory_);
    s.state = fast::MeshState(&memory_);
    s.live = false;
    s.body = Slot::none;
    adaptive_.scene_changed();
    meshes_hold_ = false;
    // A slot whose generations are used up is retired, so that no old id comes to life again.
    if (s.generation < VOX_MAX_GENERATIONS) free_slots_.push_back(slot);
}

void vox_grid::reserve(std::uint32_t mesh_count, std::uint64_t contact_count) {
    if (mesh_count > VOX_MAX_MESHES)
        throw Error(VOX_ERROR_LIMIT,
                    format("mesh_count is %u, the limit is %u", mesh_count, VOX_MAX_MESHES));
    const auto room_for = [](auto& vector, std::uint64_t count) {
        if (count > vector.max_size()) throw std::bad_alloc();
        if (count > vector.capacity()) vector.reserve(static_cast<std::size_t>(count));
    };
    room_for(slots_, mesh_count);
    room_for(free_slots_, mesh_count);
    room_for(bodies_, mesh_count);
    room_for(prepared_, mesh_count);
    room_for(hits_, contact_count);
    room_for(contacts_, contact_count);
    if (find_penetrations_) room_for(penetrations_, contact_count);
    events_.reserve(mesh_count, static_cast<std::size_t>(contact_count));
    ++epoch_; // views of the contacts were left behind if they moved
}

const Mesh* vox_grid::find(vox_mesh id) const noexcept {
    const std::uint32_t slot = slot_of(id);
    if (slot >= slots_.size() || !slots_[slot].live || slots_[slot].generation != generation_of(id))
        return nullptr;
    return &slots_[slot].mesh;
}

const Mesh& vox_grid::mesh(vox_mesh id) const {
    if (const Mesh* found = find(id)) return *found;
    if (id == VOX_NULL_MESH) throw Error(VOX_ERROR_INVALID_HANDLE, "mesh id is 0, which names no mesh");
    const std::uint32_t slot = slot_of(id);
    if (slot >= slots_.size())
        throw Error(VOX_ERROR_INVALID_HANDLE,
                    format("mesh id %u names slot %u, the grid has %zu", id, slot, slots_.size()));
    throw Error(VOX_ERROR_INVALID_HANDLE,
                format("mesh id %u (slot %u, generation %u) is stale: the slot %s generation %u", id, slot,
                       generation_of(id), slots_[slot].live ? "holds" : "is empty after",
                       slots_[slot].generation));
}

Mesh& vox_grid::mesh(vox_mesh id) { return const_cast<Mesh&>(std::as_const(*this).mesh(id)); }

void vox_grid::set_cell_size(double cell_size) {
    if (!(cell_size >= 0) || std::isinf(cell_size))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("cell_size is %g, expected a finite number >= 0", cell_size));
    cell_size_ = cell_size;
    choose_cell_size_ = cell_size == 0;
    adaptive_.restart();
    contacts_hold_ = false; // they do, but the next step should show what the cell size does
}

void vox_grid::set_worker_count(std::uint32_t worker_count) {
    check_workers(tasks_, worker_count);
    workers_.set_count(worker_count);
    contacts_hold_ = false; // as for the cell size
}

// ---- step -----------------------------------------------------------------------------------------

void vox_grid::step() {
    const std::uint64_t start = nanoseconds();
    const bool carry = contacts_hold_;
    contacts_hold_ = meshes_hold_ = false;
    hits_.clear();
    events_.hide_pairs();
    events_.hide_events();
    readings_.forget();
    ++epoch_;

    vox_counters counters{};
    vox_profile profile{};
    try {
        gather_bodies(counters);
        if (fast_)
            detect_fast(carry, counters, profile);
        else
            detect_reference(counters, profile);
        drop_removed_vertices();

        const std::uint64_t detected = nanoseconds();
        if (carry && counters.moved_meshes < bodies_.size()) counters.carried_contacts = carry_contacts();
        // Where these are all there were and all there are, they and what follows from them stay as they are.
        const bool all_carried =
            counters.carried_contacts == contacts_.size() && hits_.size() == contacts_.size();
        if (!all_carried) make_contacts(bodies_, hits_, contacts_, &workers_);
        std::uint64_t contacts_made = nanoseconds();
        profile.contacts_ns = contacts_made - detected;

        if (find_penetrations_ && !all_carried) {
            depth_.find(bodies_, topologies_, hits_, contacts_, &workers_, penetrations_, counters);
            profile.depth_ns = nanoseconds() - contacts_made;
            contacts_made += profile.depth_ns;
        }

        if (carry && all_carried)
            events_.repeat();
        else
            events_.update(contacts_, slots_.size(), [this](vox_mesh id) { return mesh(id).user_data(); });
        profile.events_ns = nanoseconds() - contacts_made;
    } catch (...) {
        contacts_.clear();
        penetrations_.clear();
        throw;
    }

    counters.meshes = static_cast<std::uint32_t>(bodies_.size());
    for (const Body& body : bodies_) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size() - body.off_count;
    }
    counters.contacts = contacts_.size();
    counters.penetrations = penetrations_.size();
    if (choose_cell_size_ && !fast_) {
        adaptive_.observe(counters);
        counters.cell_size_changes = adaptive_.changes();
    }
    counters_ = counters;
    profile.step_ns = nanoseconds() - start;
    profile_ = profile;
    contacts_hold_ = meshes_hold_ = fast_;
}

void vox_grid::gather_bodies(vox_counters& counters) {
    bodies_.clear();
    topologies_.clear();
    prepared_.clear();
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        Slot& s = slots_[slot];
        s.body = Slot::none;
        if (!s.live) continue;
        if (!s.mesh.is_enabled()) {
            ++counters.disabled_meshes;
            continue;
        }
        const vox_mesh id = make_id(static_cast<std::uint32_t>(slot), s.generation);
        if (!s.mesh.has_positions())
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("mesh %u has no positions: bind some before the step", id));
        s.body = static_cast<std::uint32_t>(bodies_.size());
        // Of meshes that were inserted without positions, and after edits.
        s.mesh.make_rings();
        prepare(s.mesh, s.state);
        Body& body = bodies_.emplace_back(s.mesh.body(id));
        if (body.off_count == body.tets.size()) { // no stage need know of them
            body.tets = {};
            body.off_count = 0;
        }
        topologies_.push_back(&s.mesh.topology());
        if (fast_) prepared_.push_back({&s.mesh.tiled().tiles, &s.mesh.tiled().boundary, &s.state});
    }
}

// What vertices that were removed are in does not matter.
void vox_grid::drop_removed_vertices() {
    if (std::all_of(bodies_.begin(), bodies_.end(),
                    [](const Body& body) { return body.removed_vertices.empty(); }))
        return;
    std::erase_if(hits_, [this](const Hit& hit) {
        return has_bit(bodies_[hit.body_a].removed_vertices, hit.vertex);
    });
}

void vox_grid::detect_fast(bool carry, vox_counters& counters, vox_profile& profile) {
    // The engine chooses a cell size for each of its windows unless one is set.
    const FastSettings settings{
        .cell_size = choose_cell_size_ ? 0 : cell_size_, .workers = &workers_, .carry = carry};
    fast_engine_.detect(bodies_, prepared_, settings, hits_, counters, profile);
    if (choose_cell_size_) cell_size_ = fast_engine_.cell_size();
}

// Appends the contacts of the last step between meshes that have not moved as hits, and returns how many. All
// hits of a vertex with a mesh are carried or none; taken for interior ones, those that became contacts do so
// again.
std::uint64_t vox_grid::carry_contacts() {
    const std::size_t found = hits_.size();
    const auto rests = [this](vox_mesh id) {
        const Slot& s = slots_[slot_of(id)];
        return s.body != Slot::none && s.generation == generation_of(id) && !fast_engine_.moved(s.body);
    };
    for (const vox_contact& contact : contacts_) {
        if (!rests(contact.mesh_a) || !rests(contact.mesh_b)) continue;
        Hit hit{};
        hit.body_a = slots_[slot_of(contact.mesh_a)].body;
        hit.vertex = contact.vertex;
        hit.body_b = slots_[slot_of(contact.mesh_b)].body;
        hit.tet = contact.tet & 0x7fffffffu;
        hit.interior = 1;
        std::copy(contact.barycentric, contact.barycentric + 4, hit.weights.of);
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
    settings_.cell_size = cell_size_;
    settings_.levels = {};
    if (!choose_cell_size_) return;
    const double before = cell_size_;
    const std::uint64_t changes = adaptive_.changes();
    settings_.levels = adaptive_.cell_sizes(bodies_, settings_.storage, byte_limit(), &memory_);
    cell_size_ = settings_.levels[0].cell_size;
    if (before > 0 && adaptive_.changes() == changes) return;
    if (!log_.write) return;
    std::string text = format("cell size %.9g", cell_size_);
    for (std::size_t l = 1; l < settings_.levels.size(); ++l)
        text += format(", %.9g", settings_.levels[l].cell_size);
    text += before > 0 ? format(" after %.9g,", before) : " chosen";
    write_log(VOX_LOG_INFO, format("%s for %llu tets in %zu meshes", text.c_str(),
                                   static_cast<unsigned long long>(tet_count_), bodies_.size())
                                .c_str());
}

// Most bytes for the cells of dense storage: the budget less what is held without them, and less what a first step
// is about to take. 0: no limit.
double vox_grid::byte_limit() const noexcept {
    if (memory_.budget() == 0) return 0;
    double held = static_cast<double>(memory_.bytes());
    if (counters_.vertices == 0) // of positions, links and cells, and of boxes
        held += 40 * static_cast<double>(vertex_count_) + 24 * static_cast<double>(tet_count_);
    else
        held -= static_cast<double>(reference_.cell_bytes());
    return std::max(0.9 * (static_cast<double>(memory_.budget()) - held), 4.0);
}

void vox_grid::describe(CellSizeScene& scene) const {
    const auto reserve = [this](auto&... lists) { (lists.reserve(slots_.size()), ...); };
    reserve(scene.bodies, scene.tiles, scene.meshes, scene.at_rest, scene.cleared);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        const Slot& s = slots_[slot];
        if (!s.live || !s.mesh.is_enabled()) continue;
        const vox_mesh id = make_id(static_cast<std::uint32_t>(slot), s.generation);
        if (!s.mesh.has_positions())
            throw Error(VOX_ERROR_INVALID_STATE, format("mesh %u has no positions: bind some before", id));
        scene.bodies.push_back(s.mesh.body(id));
        scene.tiles.push_back(s.mesh.tiles_if_made());
        scene.meshes.push_back(&s.mesh);
        scene.at_rest.push_back(!fast_engine_.moved(s.body));
        scene.cleared.push_back(fast_engine_.cleared(s.body, s.mesh.vertex_count()));
    }
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
    if (log_.write) log_.write(level, text, log_.user);
}

// ---- readings --------------------------------------------------------------------------------------

void vox_grid::prepare_readings() {
    for (ReadingBody& reading : readings_.list_meshes(events_)) {
        const vox_mesh id = reading.body.mesh_id;
        if (!is_valid(id)) continue;
        Mesh& mesh = slots_[slot_of(id)].mesh;
        if (!mesh.has_positions()) continue;
        mesh.make_topology();
        reading = {mesh.body(id), &mesh.topology()};
        check_finite(reading.body);
    }
    readings_.prepare(contacts_, penetrations_, events_, workers_);
}

// ---- queries ---------------------------------------------------------------------------------------

void vox_grid::prepare_queries() {
    std::pmr::vector<QueryBody> bodies(&memory_);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        Slot& s = slots_[slot];
        if (!s.live || !s.mesh.is_enabled() || s.mesh.tet_count() == 0) continue;
        const vox_mesh id = make_id(static_cast<std::uint32_t>(slot), s.generation);
        if (!s.mesh.has_positions())
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("mesh %u has no positions: bind some before the queries", id));
        const Body body = s.mesh.body(id);
        check_finite(body);
        s.mesh.make_topology();
        s.mesh.make_tiles(); // of the reference engine's meshes too
        bodies.push_back({body, &s.mesh.tiled().tiles, &s.mesh.topology()});
    }
    queries_.prepare(bodies);
}

// ---- results --------------------------------------------------------------------------------------

vox_contact_view vox_grid::contacts() const noexcept {
    return {contacts_.data(), sizeof(vox_contact), contacts_.size(), epoch_};
}

vox_penetration_view vox_grid::penetrations() const {
    if (!find_penetrations_)
        throw Error(VOX_ERROR_INVALID_STATE, "the grid was created without VOX_GRID_PENETRATIONS");
    return {penetrations_.data(), sizeof(vox_penetration), penetrations_.size(), epoch_};
}

std::uint64_t vox_grid::hash() const noexcept { return hash_contacts(contacts_); }

vox_counters vox_grid::counters() const noexcept {
    vox_counters counters = counters_;
    counters.bytes = memory_.bytes();
    counters.peak_bytes = memory_.peak_bytes();
    return counters;
}
