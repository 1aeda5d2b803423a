#include "grid/snapshot.hpp"

#include "base/error.hpp"
#include "grid/grid.hpp"
#include "grid/snapshot_chunks.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <iterator>
#include <memory_resource>
#include <tuple>
#include <vector>

namespace vox {

namespace {

constexpr std::uint32_t live_bit = 1u << 31; // of a slot's word; the generation is in the others

// Of a MESH chunk.
constexpr std::uint32_t self_collision_bit = 1, disabled_bit = 2, transform_bit = 4, known_bits = 7;

// What loading knows that the grid does not show yet.
struct Loading {
    vox_grid& grid;
    std::pmr::vector<vox_mesh> awaited; // meshes whose chunk has to come, ascending
    std::size_t next = 0;               // of them
    std::pmr::vector<std::uint32_t> free_slots;
    vox_mesh last_filtered = VOX_NULL_MESH, last_cut = VOX_NULL_MESH;
};

void save_point(const Vec3f& p, SnapshotWriter& out) {
    for (const float x : {p.x, p.y, p.z}) out.f32(x);
}

void save_point(const Vec3d& p, SnapshotWriter& out) {
    for (const double x : {p.x, p.y, p.z}) out.f64(x);
}

void load_point(SnapshotChunk& in, Vec3f& p) {
    for (float* x : {&p.x, &p.y, &p.z}) *x = in.f32();
}

void load_point(SnapshotChunk& in, Vec3d& p) {
    for (double* x : {&p.x, &p.y, &p.z}) *x = in.f64();
}

template <class Point>
void load_points(SnapshotChunk& in, std::uint64_t count, std::pmr::vector<Point>& points) {
    in.expect(count, sizeof(Point), "positions");
    points.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) load_point(in, points.emplace_back());
}

// As many words as that many bits take, zeros past the end of `bits`.
void save_bits(std::span<const std::uint64_t> bits, std::uint64_t count, SnapshotWriter& out) {
    for (std::size_t word = 0; word < (count + 63) / 64; ++word) out.u64(word < bits.size() ? bits[word] : 0);
}

void load_bits(SnapshotChunk& in, std::uint64_t count, const char* what,
               std::pmr::vector<std::uint64_t>& bits) {
    const std::uint64_t words = (count + 63) / 64;
    in.expect(words, 8, what);
    bits.resize(static_cast<std::size_t>(words));
    for (std::uint64_t& word : bits) word = in.u64();
    if (count % 64 != 0 && bits.back() >> count % 64 != 0)
        in.refuse(format("bits of %s past the last one, number %" PRIu64, what, count));
}

// Calls what a program would call; where it says that an argument is wrong, the snapshot is.
template <class Function>
void or_refuse(const SnapshotChunk& in, vox_mesh id, Function&& function) {
    try {
        function();
    } catch (const Error& error) {
        const vox_result result = error.result();
        if (result == VOX_ERROR_LIMIT || result == VOX_ERROR_BUDGET) throw;
        in.refuse(format("mesh %" PRIu32 ": %s", id, error.what()));
    }
}

} // namespace

// The grid's state, part by part: each is one chunk, with a function that writes it and one that reads it.
class Snapshot {
public:
    static void save(const vox_grid& grid, SnapshotWriter& out);
    static vox_grid_desc settings(SnapshotReader& in, const vox_grid_desc& machine);
    static void load(SnapshotReader& in, vox_grid& grid);

private:
    static void save_settings(const vox_grid& grid, SnapshotWriter& out);
    static vox_grid_desc read_settings(SnapshotChunk& in, vox_grid_desc desc);
    static void load_settings(SnapshotChunk& in, Loading& to);
    static void save_slots(const vox_grid& grid, SnapshotWriter& out);
    static void load_slots(SnapshotChunk& in, Loading& to);
    static void load_free_slots(SnapshotChunk& in, Loading& to);
    static void save_meshes(const vox_grid& grid, SnapshotWriter& out);
    static void save_mesh(const vox_grid& grid, vox_mesh id, SnapshotWriter& out);
    static void load_mesh(SnapshotChunk& in, Loading& to);
    static void save_cuts(const vox_grid& grid, SnapshotWriter& out);
    static void load_cuts(SnapshotChunk& in, Loading& to);
    static void save_filters(const vox_grid& grid, SnapshotWriter& out);
    static void load_filter(SnapshotChunk& in, Loading& to);
    static void save_exceptions(const vox_grid& grid, SnapshotWriter& out);
    static void load_exceptions(SnapshotChunk& in, Loading& to);
    static void save_events(const vox_grid& grid, SnapshotWriter& out);
    static void load_events(SnapshotChunk& in, Loading& to);

    template <class Function>
    static void for_each_mesh(const vox_grid& grid, Function&& function) {
        for (std::uint32_t slot = 0; slot < grid.slots_.size(); ++slot)
            if (grid.slots_[slot].live) function(make_id(slot, grid.slots_[slot].generation));
    }
    static vox_mesh mesh_that_was(SnapshotChunk& in, const vox_grid& grid);

    // In the order in which they follow each other in a file.
    struct Part {
        const char* name;
        bool repeats;  // may come any number of times, else once
        bool required; // where it may come once
        void (*load)(SnapshotChunk& in, Loading& to);
    };
    static constexpr Part parts[] = {
        {"GRID", false, true, load_settings}, {"SLOT", false, true, load_slots},
        {"MESH", true, false, load_mesh},     {"CUTS", true, false, load_cuts},
        {"FILT", true, false, load_filter},   {"PAIR", false, true, load_exceptions},
        {"EVNT", false, true, load_events}};
};

// ---- GRID: settings -------------------------------------------------------------------------------

void Snapshot::save_settings(const vox_grid& grid, SnapshotWriter& out) {
    const ReferenceSettings& settings = grid.settings_;
    out.begin_chunk("GRID");
    out.u32(grid.fast_ ? VOX_ENGINE_FAST : VOX_ENGINE_REFERENCE);
    out.u32(settings.storage);
    out.u32(settings.hash);
    std::uint32_t flags = 0;
    if (grid.find_penetrations_) flags |= VOX_GRID_PENETRATIONS;
    if (grid.events_.of_contacts_) flags |= VOX_GRID_CONTACT_EVENTS;
    out.u32(flags);
    out.u64(settings.hash_table_size);
    for (const Vec3d& corner : {settings.world_min, settings.world_max})
        for (const double x : {corner.x, corner.y, corner.z}) out.f64(x);
    out.f64(grid.cell_size_);
    out.u32(grid.choose_cell_size_);
    out.u32(0); // reserved; a grid that chooses its cell size does so again once it is loaded
    out.u64(grid.epoch_);
    out.end_chunk();
}

vox_grid_desc Snapshot::read_settings(SnapshotChunk& in, vox_grid_desc desc) {
    const auto enumerator = [&](std::uint32_t last, const char* what) {
        const std::uint32_t value = in.u32();
        if (value > last) in.refuse(format("%s is %" PRIu32 ", expected 0 to %" PRIu32, what, value, last));
        return value;
    };
    const auto engine = static_cast<vox_engine>(enumerator(VOX_ENGINE_FAST, "engine"));
    if (engine == VOX_ENGINE_AUTO) in.refuse("engine is 0, expected the one in use");
    if (desc.engine == VOX_ENGINE_AUTO) desc.engine = engine;
    desc.storage = static_cast<vox_storage>(enumerator(VOX_STORAGE_DENSE, "storage"));
    desc.hash = static_cast<vox_hash>(enumerator(VOX_HASH_PAPER, "hash"));
    desc.flags = in.u32();
    desc.hash_table_size = in.u64();
    for (double& x : desc.world_min) x = in.f64();
    for (double& x : desc.world_max) x = in.f64();
    desc.cell_size = in.f64();
    if (!(desc.cell_size >= 0) || std::isinf(desc.cell_size))
        in.refuse(format("cell size is %g, expected a finite number >= 0", desc.cell_size));
    const bool choose = in.flag("whether the cell size was chosen");
    if (!choose && desc.cell_size == 0) in.refuse("cell size is 0, but not to be chosen");
    if (choose) desc.cell_size = 0;
    if (const std::uint32_t reserved = in.u32(); reserved != 0)
        in.refuse(format("a reserved word is %" PRIu32 ", expected 0", reserved));
    (void)in.u64(); // the epoch
    in.end();
    try {
        check_grid_desc(desc);
    } catch (const Error& error) {
        in.refuse(error.what());
    }
    return desc;
}

// What a grid's settings do not hold; all is checked by read_settings().
void Snapshot::load_settings(SnapshotChunk& in, Loading& to) {
    for (int word = 0; word < 4; ++word) (void)in.u32();
    for (int word = 0; word < 7; ++word) (void)in.u64();
    to.grid.cell_size_ = in.f64();
    to.grid.choose_cell_size_ = in.flag("");
    (void)in.u32();
    to.grid.epoch_ = in.u64();
}

// ---- SLOT: mesh slots, their generations, and which of them is taken next -------------------------

void Snapshot::save_slots(const vox_grid& grid, SnapshotWriter& out) {
    out.begin_chunk("SLOT");
    out.u32(static_cast<std::uint32_t>(grid.slots_.size()));
    out.u32(static_cast<std::uint32_t>(grid.free_slots_.size()));
    for (const vox_grid::Slot& slot : grid.slots_) out.u32(slot.generation | (slot.live ? live_bit : 0));
    for (const std::uint32_t slot : grid.free_slots_) out.u32(slot);
    out.end_chunk();
}

void Snapshot::load_slots(SnapshotChunk& in, Loading& to) {
    const std::uint32_t slots = in.u32(), free = in.u32();
    if (slots > VOX_MAX_MESHES)
        in.refuse(format("%" PRIu32 " slots, the limit is %" PRIu32, slots, VOX_MAX_MESHES));
    in.expect(std::uint64_t{slots} + free, 4, "slots");

    vox_grid& grid = to.grid;
    grid.slots_.reserve(slots);
    grid.free_slots_.reserve(slots);
    to.awaited.reserve(slots);
    std::uint32_t reusable = 0;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        const std::uint32_t word = in.u32(), generation = word & ~live_bit;
        if (generation == 0 || generation > VOX_MAX_GENERATIONS)
            in.refuse(format("slot %" PRIu32 " has generation %" PRIu32 ", expected 1 to %" PRIu32, slot,
                             generation, VOX_MAX_GENERATIONS));
        grid.slots_.emplace_back(&grid.memory_, generation);
        if (word & live_bit)
            to.awaited.push_back(make_id(slot, generation));
        else
            reusable += generation < VOX_MAX_GENERATIONS;
    }
    if (free != reusable)
        in.refuse(format("%" PRIu32 " free slots are listed, %" PRIu32 " are free", free, reusable));

    std::pmr::vector<bool> listed(slots, false, &grid.memory_);
    for (const vox_mesh id : to.awaited) listed[slot_of(id)] = true;
    to.free_slots.reserve(slots);
    for (std::uint32_t i = 0; i < free; ++i) {
        const std::uint32_t slot = in.u32();
        if (slot >= slots) in.refuse(format("free slot %" PRIu32 " of %" PRIu32 " slots", slot, slots));
        if (listed[slot] || grid.slots_[slot].generation == VOX_MAX_GENERATIONS)
            in.refuse(format("slot %" PRIu32 " is listed as free, but it is taken, retired or listed before",
                             slot));
        listed[slot] = true;
        to.free_slots.push_back(slot);
    }
    in.end();
}

// ---- MESH: one mesh, in the order of ids ----------------------------------------------------------

void Snapshot::save_mesh(const vox_grid& grid, vox_mesh id, SnapshotWriter& out) {
    const Mesh& mesh = grid.mesh(id);
    const Body body = mesh.body(id);
    const Positions& positions = mesh.positions_; // as given, not transformed
    const bool has_positions = positions.data != nullptr && body.vertex_count > 0;
    std::uint32_t bits = 0;
    if (body.self_collision) bits |= self_collision_bit;
    if (!mesh.is_enabled()) bits |= disabled_bit;
    if (mesh.has_transform_) bits |= transform_bit;
    out.begin_chunk("MESH");
    out.u32(id);
    out.u32(bits);
    out.u64(mesh.user_data());
    out.u64(body.vertex_count);
    out.u64(body.tets.size());
    out.u32(has_positions);
    out.u32(positions.doubles ? VOX_FORMAT_DOUBLE3 : VOX_FORMAT_FLOAT3);
    if (mesh.has_transform_)
        for (const double element : mesh.transform_) out.f64(element);
    for (std::uint32_t t = 0; t < body.tets.size(); ++t)
        for (const std::uint32_t vertex : mesh.given(t).v) out.u32(vertex);
    for (std::uint32_t v = 0; has_positions && v < body.vertex_count; ++v)
        if (positions.doubles)
            save_point(positions.exact(v), out);
        else
            save_point(positions.floats(v), out);
    out.end_chunk();
}

void Snapshot::save_meshes(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_mesh id) { save_mesh(grid, id, out); });
}

void Snapshot::load_mesh(SnapshotChunk& in, Loading& to) {
    vox_grid& grid = to.grid;
    const vox_mesh id = in.u32();
    if (to.next == to.awaited.size())
        in.refuse(format("it is of mesh %" PRIu32 ", expected no more meshes", id));
    if (id != to.awaited[to.next])
        in.refuse(format("it is of mesh %" PRIu32 ", expected mesh %" PRIu32, id, to.awaited[to.next]));
    ++to.next;

    vox_mesh_desc desc = vox_default_mesh_desc();
    const std::uint32_t bits = in.u32();
    desc.user_data = in.u64();
    desc.vertex_count = in.u64();
    desc.tet_count = in.u64();
    const bool has_positions = in.flag("whether it has positions");
    const std::uint32_t position_format = in.u32();
    if (bits & ~known_bits)
        in.refuse(
            format("flags are 0x%" PRIx32 ", of which 0x%" PRIx32 " is unknown", bits, bits & ~known_bits));
    if (position_format != VOX_FORMAT_FLOAT3 && position_format != VOX_FORMAT_DOUBLE3)
        in.refuse(format("position format is %" PRIu32 ", not a vox_format", position_format));
    desc.position_format = static_cast<vox_format>(position_format);
    std::array<double, 12> transform{};
    if (bits & transform_bit)
        for (double& element : transform) {
            element = in.f64();
            if (!std::isfinite(element)) in.refuse(format("its transform has the element %g", element));
        }

    std::pmr::vector<Tet> tets(&grid.memory_);
    in.expect(desc.tet_count, sizeof(Tet), "tetrahedra");
    tets.reserve(static_cast<std::size_t>(desc.tet_count));
    for (std::uint64_t tet = 0; tet < desc.tet_count; ++tet) {
        Tet& t = tets.emplace_back();
        for (std::uint32_t& vertex : t.v) vertex = in.u32();
    }
    std::pmr::vector<Vec3f> floats(&grid.memory_);
    std::pmr::vector<Vec3d> doubles(&grid.memory_);
    if (has_positions && desc.position_format == VOX_FORMAT_DOUBLE3) {
        load_points(in, desc.vertex_count, doubles);
        desc.positions = doubles.data();
    } else if (has_positions) {
        load_points(in, desc.vertex_count, floats);
        desc.positions = floats.data();
    }
    in.end();

    desc.flags = VOX_MESH_COPY_POSITIONS;
    if (bits & self_collision_bit) desc.flags |= VOX_MESH_SELF_COLLISION;
    desc.tets = reinterpret_cast<const std::uint32_t*>(tets.data());
    // The slot becomes the only free one, and has had one mesh less: so the mesh gets its old id.
    const std::uint32_t slot = slot_of(id);
    grid.slots_[slot].generation = generation_of(id) - 1;
    grid.free_slots_.assign(1, slot);
    or_refuse(in, id, [&] {
        (void)grid.insert(desc, check_mesh(desc, "", NullPositions::allowed));
        if (bits & disabled_bit) grid.set_enabled(id, false);
        if (bits & transform_bit) grid.mesh(id).set_transform(transform.data());
    });
}

// ---- CUTS: which tets are off or removed, and which vertices are removed -------------------------

void Snapshot::save_cuts(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_mesh id) {
        const Mesh& mesh = grid.mesh(id);
        if (mesh.off_.count() == 0 && mesh.removed_vertices_.count() == 0) return;
        out.begin_chunk("CUTS");
        out.u32(id);
        out.u32(0); // reserved
        save_bits(mesh.off_.words(), mesh.tet_count(), out);
        save_bits(mesh.removed_.words(), mesh.tet_count(), out);
        save_bits(mesh.removed_vertices_.words(), mesh.vertex_count(), out);
        out.end_chunk();
    });
}

void Snapshot::load_cuts(SnapshotChunk& in, Loading& to) {
    const vox_mesh id = in.u32();
    if (!to.grid.is_valid(id)) in.refuse(format("mesh %" PRIu32 " is not in it", id));
    if (id <= to.last_cut) in.refuse(format("mesh %" PRIu32 " comes after mesh %" PRIu32, id, to.last_cut));
    to.last_cut = id;
    if (const std::uint32_t reserved = in.u32(); reserved != 0)
        in.refuse(format("a reserved word is %" PRIu32 ", expected 0", reserved));

    Mesh& mesh = to.grid.mesh(id);
    std::pmr::vector<std::uint64_t> off(&to.grid.memory_), removed(off.get_allocator()),
        removed_vertices(off.get_allocator());
    load_bits(in, mesh.tet_count(), "tetrahedra that are off", off);
    load_bits(in, mesh.tet_count(), "tetrahedra that are removed", removed);
    load_bits(in, mesh.vertex_count(), "vertices that are removed", removed_vertices);
    in.end();
    or_refuse(in, id, [&] { mesh.restore_edits(off, removed, removed_vertices); });
}

// ---- FILT: what a mesh does not collide with, where that is not the default ----------------------

void Snapshot::save_filters(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_mesh id) {
        const Mesh& mesh = grid.mesh(id);
        const std::pmr::vector<Vec3f>& rest = mesh.self_filter_.rest;
        const vox_filter filter = mesh.filter(), usual = filter_defaults();
        if (rest.empty() && filter.group == usual.group && filter.category == usual.category &&
            filter.mask == usual.mask && filter.self_rings == usual.self_rings &&
            filter.self_rest_distance == usual.self_rest_distance)
            return; // self-collision is in MESH
        out.begin_chunk("FILT");
        out.u32(id);
        out.u32(static_cast<std::uint32_t>(filter.group));
        out.u64(filter.category);
        out.u64(filter.mask);
        out.u32(filter.self_rings);
        out.u32(!rest.empty());
        out.f64(filter.self_rest_distance);
        for (const Vec3f& p : rest) save_point(p, out);
        out.end_chunk();
    });
}

void Snapshot::load_filter(SnapshotChunk& in, Loading& to) {
    const vox_mesh id = in.u32();
    if (!to.grid.is_valid(id)) in.refuse(format("mesh %" PRIu32 " is not in it", id));
    if (id <= to.last_filtered)
        in.refuse(format("mesh %" PRIu32 " comes after mesh %" PRIu32, id, to.last_filtered));
    to.last_filtered = id;

    Mesh& mesh = to.grid.mesh(id);
    vox_filter filter = mesh.filter();
    filter.group = static_cast<std::int32_t>(in.u32());
    filter.category = in.u64();
    filter.mask = in.u64();
    filter.self_rings = in.u32();
    const bool has_rest = in.flag("whether it has a rest pose");
    filter.self_rest_distance = in.f64();
    std::pmr::vector<Vec3f> rest(&to.grid.memory_);
    if (has_rest) load_points(in, mesh.vertex_count(), rest);
    in.end();
    or_refuse(in, id, [&] {
        if (has_rest) mesh.set_rest({reinterpret_cast<const std::byte*>(rest.data()), sizeof(Vec3f)});
        mesh.set_filter(read_filter(&filter));
    });
}

// ---- PAIR: pairs of meshes that do not collide ---------------------------------------------------

void Snapshot::save_exceptions(const vox_grid& grid, SnapshotWriter& out) {
    out.begin_chunk("PAIR");
    for_each_mesh(grid, [&](vox_mesh id) {
        for (const vox_mesh other : grid.mesh(id).exceptions())
            if (id < other) {
                out.u32(id);
                out.u32(other);
            }
    });
    out.end_chunk();
}

void Snapshot::load_exceptions(SnapshotChunk& in, Loading& to) {
    vox_mesh last_a = VOX_NULL_MESH, last_b = VOX_NULL_MESH;
    while (in.left() > 0) {
        const vox_mesh a = in.u32(), b = in.u32();
        if (a >= b || std::tie(last_a, last_b) >= std::tie(a, b))
            in.refuse(format("pair (%" PRIu32 ", %" PRIu32 ") is out of order", a, b));
        or_refuse(in, a, [&] { to.grid.set_pair_enabled(a, b, false); });
        last_a = a;
        last_b = b;
    }
}

// ---- EVNT: what the next step's events are counted from -------------------------------------------

void Snapshot::save_events(const vox_grid& grid, SnapshotWriter& out) {
    const Events& events = grid.events_;
    const std::pmr::vector<vox_pair>& pairs = events.touching_[events.current_].pairs;
    const std::pmr::vector<Events::Inside>& inside = events.inside_[events.current_];
    out.begin_chunk("EVNT");
    out.u64(pairs.size());
    out.u64(inside.size());
    for (const vox_pair& pair : pairs) {
        out.u32(pair.mesh_a);
        out.u32(pair.mesh_b);
        out.u64(pair.user_data_a);
        out.u64(pair.user_data_b);
    }
    for (const Events::Inside& vertex : inside) {
        out.u32(vertex.mesh_a);
        out.u32(vertex.vertex);
        out.u32(vertex.mesh_b);
    }
    out.end_chunk();
}

// The id of a mesh that is in the grid or was: events end pairs of meshes that were removed.
vox_mesh Snapshot::mesh_that_was(SnapshotChunk& in, const vox_grid& grid) {
    const vox_mesh id = in.u32();
    const std::uint32_t slot = slot_of(id), generation = generation_of(id);
    if (generation == 0 || slot >= grid.slots_.size() || generation > grid.slots_[slot].generation)
        in.refuse(format("mesh %" PRIu32 " was never in the grid", id));
    return id;
}

void Snapshot::load_events(SnapshotChunk& in, Loading& to) {
    Events& events = to.grid.events_;
    std::pmr::vector<vox_pair>& pairs = events.touching_[events.current_].pairs;
    std::pmr::vector<Events::Inside>& inside = events.inside_[events.current_];
    const std::uint64_t pair_count = in.u64(), inside_count = in.u64();
    in.expect(pair_count, 24, "pairs");
    pairs.reserve(static_cast<std::size_t>(pair_count));
    for (std::uint64_t i = 0; i < pair_count; ++i) {
        vox_pair pair{};
        pair.mesh_a = mesh_that_was(in, to.grid);
        pair.mesh_b = mesh_that_was(in, to.grid);
        pair.user_data_a = in.u64();
        pair.user_data_b = in.u64();
        if (pair.mesh_a > pair.mesh_b || (i > 0 && std::tie(pairs.back().mesh_a, pairs.back().mesh_b) >=
                                                       std::tie(pair.mesh_a, pair.mesh_b)))
            in.refuse(format("pair %" PRIu64 " (%" PRIu32 ", %" PRIu32 ") is out of order", i, pair.mesh_a,
                             pair.mesh_b));
        pairs.push_back(pair);
    }
    if (inside_count > 0 && !events.of_contacts_)
        in.refuse(format("%" PRIu64 " vertices in meshes, but the grid does not follow them", inside_count));
    in.expect(inside_count, 12, "vertices in meshes");
    inside.reserve(static_cast<std::size_t>(inside_count));
    for (std::uint64_t i = 0; i < inside_count; ++i) {
        Events::Inside vertex{};
        vertex.mesh_a = mesh_that_was(in, to.grid);
        vertex.vertex = in.u32();
        vertex.mesh_b = mesh_that_was(in, to.grid);
        if (i > 0 && inside.back() >= vertex)
            in.refuse(format("vertex in mesh %" PRIu64 " of %" PRIu64 " is out of order", i, inside_count));
        inside.push_back(vertex);
    }
    in.end();
}

// ---- the whole ------------------------------------------------------------------------------------

void Snapshot::save(const vox_grid& grid, SnapshotWriter& out) {
    save_settings(grid, out);
    save_slots(grid, out);
    save_meshes(grid, out);
    save_cuts(grid, out);
    save_filters(grid, out);
    save_exceptions(grid, out);
    save_events(grid, out);
}

vox_grid_desc Snapshot::settings(SnapshotReader& in, const vox_grid_desc& machine) {
    SnapshotChunk chunk;
    if (!in.next(chunk)) throw Error(VOX_ERROR_FORMAT, "snapshot: it has no chunk");
    if (!chunk.is("GRID")) chunk.refuse("expected chunk GRID first");
    return read_settings(chunk, machine);
}

void Snapshot::load(SnapshotReader& in, vox_grid& grid) {
    Loading to{.grid = grid,
               .awaited = std::pmr::vector<vox_mesh>(&grid.memory_),
               .free_slots = std::pmr::vector<std::uint32_t>(&grid.memory_)};
    bool seen[std::size(parts)] = {};
    std::size_t last = 0; // the part that came last
    for (SnapshotChunk chunk; in.next(chunk);) {
        const auto part =
            std::find_if(std::begin(parts), std::end(parts), [&](const Part& p) { return chunk.is(p.name); });
        if (part == std::end(parts)) {
            if (chunk.may_be_skipped()) continue;
            throw Error(VOX_ERROR_UNSUPPORTED,
                        format("snapshot: chunk %s is unknown, a later version of the library wrote it",
                               chunk.name().c_str()));
        }
        const auto index = static_cast<std::size_t>(part - std::begin(parts));
        if (index < last) chunk.refuse(format("it comes after chunk %s", parts[last].name));
        if (seen[index] && !part->repeats) chunk.refuse("it comes a second time");
        for (std::size_t before = 0; before < index; ++before)
            if (parts[before].required && !seen[before])
                chunk.refuse(format("expected chunk %s before it", parts[before].name));
        seen[index] = true;
        last = index;
        part->load(chunk, to);
    }
    for (std::size_t part = 0; part < std::size(parts); ++part)
        if (parts[part].required && !seen[part])
            throw Error(VOX_ERROR_FORMAT, format("snapshot: it has no chunk %s", parts[part].name));
    if (to.next != to.awaited.size())
        throw Error(VOX_ERROR_FORMAT,
                    format("snapshot: it has %zu of %zu meshes, mesh %" PRIu32 " is missing", to.next,
                           to.awaited.size(), to.awaited[to.next]));
    grid.free_slots_.assign(to.free_slots.begin(), to.free_slots.end()); // within the capacity
}

std::uint64_t snapshot_size(const vox_grid& grid) noexcept {
    SnapshotWriter count;
    Snapshot::save(grid, count);
    return count.finish();
}

std::uint64_t save_snapshot(const vox_grid& grid, std::byte* out) noexcept {
    SnapshotWriter writer(out);
    Snapshot::save(grid, writer);
    return writer.finish();
}

vox_grid_desc snapshot_settings(SnapshotReader in, const vox_grid_desc& machine) {
    return Snapshot::settings(in, machine);
}

void load_snapshot(SnapshotReader in, vox_grid& grid) { Snapshot::load(in, grid); }

} // namespace vox
