// The parts of a snapshot that describe meshes.
#include "grid/snapshot.hpp"

#include "base/vectors.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <array>
#include <cmath>
#include <span>

namespace vox {

namespace {

// Of a MESH chunk.
constexpr std::uint32_t self_collision_bit = 1, disabled_bit = 2, transform_bit = 4, sensor_bit = 8,
                        known_bits = 15;
// Of a FILT chunk.
constexpr std::uint32_t no_rest = 0, rest_in_floats = 1, rest_in_doubles = 2;

// The positions of a mesh, in floats or doubles.
struct LoadedPositions {
    explicit LoadedPositions(std::pmr::memory_resource* memory) : floats(memory), doubles(memory) {}

    Positions load(SnapshotChunk& in, std::uint64_t count, bool in_doubles) {
        if (in_doubles) return {load(in, count, doubles), sizeof(Vec3d), true};
        return {load(in, count, floats), sizeof(Vec3f)};
    }

private:
    template <class Point>
    static const std::byte* load(SnapshotChunk& in, std::uint64_t count, Array<Point>& points) {
        in.expect(count, sizeof(Point), "positions");
        points.reserve(static_cast<std::size_t>(count));
        for (std::uint64_t i = 0; i < count; ++i) {
            Point& p = points.emplace_back();
            for (auto* x : {&p.x, &p.y, &p.z}) *x = in.real<std::remove_pointer_t<decltype(x)>>();
        }
        return reinterpret_cast<const std::byte*>(points.data());
    }

    Array<Vec3f> floats;
    Array<Vec3d> doubles;
};

// Writes `count` bits as whole words, with zeros past the end of `bits`.
void save_bits(std::span<const std::uint64_t> bits, std::uint64_t count, SnapshotWriter& out) {
    for (std::size_t word = 0; word < (count + 63) / 64; ++word) out.u64(word < bits.size() ? bits[word] : 0);
}

void load_bits(SnapshotChunk& in, std::uint64_t count, const char* what, Array<std::uint64_t>& bits) {
    const std::uint64_t words = (count + 63) / 64;
    in.expect(words, 8, what);
    bits.resize(static_cast<std::size_t>(words));
    for (std::uint64_t& word : bits) word = in.u64();
    if (count % 64 != 0 && bits.back() >> count % 64 != 0)
        in.refuse(format("bits of %s past the last one, number %" PRIu64, what, count));
}

} // namespace

// ---- MESH: one mesh, in the order of ids ----------------------------------------------------------

void Snapshot::save_meshes(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_body id, const Mesh& mesh) {
        const Body body = mesh.body(id);
        const Positions& positions = mesh.positions_; // as given, not transformed
        const bool has_positions = positions.data != nullptr && body.vertex_count > 0;
        std::uint32_t bits = 0;
        if (body.self_collision) bits |= self_collision_bit;
        if (body.sensor) bits |= sensor_bit;
        if (!mesh.is_enabled()) bits |= disabled_bit;
        if (mesh.has_transform_) bits |= transform_bit;
        out.begin_chunk("MESH");
        out.u32(id);
        out.u32(bits);
        out.u64(mesh.user_data());
        out.u64(body.vertex_count);
        out.u64(body.tets.size());
        out.u32(has_positions);
        out.u32(positions.doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT);
        if (mesh.has_transform_)
            for (const double element : mesh.transform_) out.real(element);
        for (std::uint32_t t = 0; t < body.tets.size(); ++t)
            for (const std::uint32_t vertex : mesh.given(t).v) out.u32(vertex);
        for (std::uint32_t v = 0; has_positions && v < body.vertex_count; ++v)
            if (positions.doubles)
                out.point(positions.exact(v));
            else
                out.point(positions.floats(v));
        out.end_chunk();
    });
}

void Snapshot::load_mesh(SnapshotChunk& in, Loading& to) {
    vox_grid& grid = to.grid;
    const vox_body id = in.u32();
    if (to.next == to.awaited.size())
        in.refuse(format("it is of body %" PRIu32 ", expected no more bodies", id));
    if (id != to.awaited[to.next])
        in.refuse(format("it is of body %" PRIu32 ", expected body %" PRIu32, id, to.awaited[to.next]));
    ++to.next;

    vox_mesh_desc desc = vox_default_mesh_desc();
    const std::uint32_t bits = in.u32();
    desc.user_data = in.u64();
    const std::uint64_t vertex_count = in.u64();
    desc.tet_count = in.u64();
    const bool has_positions = in.flag("whether it has positions");
    const std::uint32_t position_format = in.u32();
    if (bits & ~known_bits)
        in.refuse(
            format("flags are 0x%" PRIx32 ", of which 0x%" PRIx32 " is unknown", bits, bits & ~known_bits));
    if (position_format != VOX_FORMAT_FLOAT && position_format != VOX_FORMAT_DOUBLE)
        in.refuse(format("position format is %" PRIu32 ", not a vox_format", position_format));
    std::array<double, 12> transform{};
    if (bits & transform_bit)
        for (double& element : transform) {
            element = in.real<double>();
            if (!std::isfinite(element)) in.refuse(format("its transform has the element %g", element));
        }

    Array<Tet> tets(&grid.memory_);
    in.expect(desc.tet_count, sizeof(Tet), "tetrahedra");
    tets.reserve(static_cast<std::size_t>(desc.tet_count));
    for (std::uint64_t tet = 0; tet < desc.tet_count; ++tet) {
        Tet& t = tets.emplace_back();
        for (std::uint32_t& vertex : t.v) vertex = in.u32();
    }
    LoadedPositions loaded(&grid.memory_);
    desc.positions.count = vertex_count;
    desc.positions.format = static_cast<vox_format>(position_format);
    if (has_positions)
        desc.positions.data = loaded.load(in, vertex_count, position_format == VOX_FORMAT_DOUBLE).data;
    in.end();

    desc.flags = VOX_MESH_COPY_POSITIONS;
    if (bits & self_collision_bit) desc.filter.flags |= VOX_FILTER_SELF_COLLISION;
    if (bits & sensor_bit) desc.filter.flags |= VOX_FILTER_SENSOR;
    desc.tets = reinterpret_cast<const std::uint32_t*>(tets.data());
    // The slot becomes the only free one, and has had one mesh less: so the mesh gets its old id.
    const std::uint32_t slot = slot_of(id);
    grid.meshes_.slots_[slot].generation = generation_of(id) - 1;
    grid.meshes_.free_slots_.assign(1, slot);
    or_refuse(in, id, [&] {
        const Body view = check_mesh(desc, "", NullPositions::allowed);
        (void)grid.insert(desc, view, checked_filter(desc.filter));
        if (bits & disabled_bit) grid.set_enabled(id, false);
        if (bits & transform_bit) grid.mesh(id).set_transform(transform.data());
    });
}

// The mesh that a chunk is of; `last` is that of the one before.
Mesh& Snapshot::next_mesh(SnapshotChunk& in, vox_grid& grid, vox_body& last) {
    const vox_body id = in.u32();
    if (!grid.is_valid(id)) in.refuse(format("body %" PRIu32 " is not in it", id));
    if (id <= last) in.refuse(format("body %" PRIu32 " comes after body %" PRIu32, id, last));
    last = id;
    return grid.body(id);
}

// ---- CUTS: which tets are off or removed, and which vertices are removed -------------------------

void Snapshot::save_cuts(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_body id, const Mesh& mesh) {
        if (mesh.edits_.off.count() == 0 && mesh.edits_.removed_vertices.count() == 0) return;
        out.begin_chunk("CUTS");
        out.u32(id);
        out.u32(0); // reserved
        save_bits(mesh.edits_.off.words(), mesh.tet_count(), out);
        save_bits(mesh.edits_.removed.words(), mesh.tet_count(), out);
        save_bits(mesh.edits_.removed_vertices.words(), mesh.vertex_count(), out);
        out.end_chunk();
    });
}

void Snapshot::load_cuts(SnapshotChunk& in, Loading& to) {
    Mesh& mesh = next_mesh(in, to.grid, to.last_cut);
    in.reserved_word();
    Array<std::uint64_t> off(&to.grid.memory_), removed(off.memory()), removed_vertices(off.memory());
    load_bits(in, mesh.tet_count(), "tetrahedra that are off", off);
    load_bits(in, mesh.tet_count(), "tetrahedra that are removed", removed);
    load_bits(in, mesh.vertex_count(), "vertices that are removed", removed_vertices);
    in.end();
    or_refuse(in, to.last_cut, [&] { mesh.restore_edits(off, removed, removed_vertices); });
}

// ---- FILT: what a mesh does not collide with, where that is not the default ----------------------

void Snapshot::save_filters(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_body id, const Mesh& mesh) {
        const RestPose& rest = mesh.self_filter_.rest;
        const vox_filter filter = mesh.filter(), usual = checked_filter({});
        if (rest.empty() && filter.group == usual.group && filter.category == usual.category &&
            filter.mask == usual.mask && filter.world == usual.world &&
            filter.self_rings == usual.self_rings && filter.self_rest_distance == usual.self_rest_distance)
            return; // flags are in MESH
        out.begin_chunk("FILT");
        out.u32(id);
        out.u32(static_cast<std::uint32_t>(filter.group));
        out.u64(filter.category);
        out.u64(filter.mask);
        out.u32(filter.world);
        out.u32(filter.self_rings);
        out.u32(0); // reserved
        out.u32(rest.empty() ? no_rest : rest.in_doubles() ? rest_in_doubles : rest_in_floats);
        out.real(filter.self_rest_distance);
        for (std::size_t v = 0; v < rest.size(); ++v)
            if (rest.in_doubles())
                out.point(rest[v]);
            else
                out.point(nearest_floats(rest[v]));
        out.end_chunk();
    });
}

void Snapshot::load_filter(SnapshotChunk& in, Loading& to) {
    Mesh& mesh = next_mesh(in, to.grid, to.last_filtered);
    vox_filter filter = mesh.filter();
    filter.group = static_cast<std::int32_t>(in.u32());
    filter.category = in.u64();
    filter.mask = in.u64();
    filter.world = in.u32();
    filter.self_rings = in.u32();
    in.reserved_word();
    const std::uint32_t rest = in.u32();
    if (rest > rest_in_doubles)
        in.refuse(
            format("its rest pose is of kind %" PRIu32 ", expected 0 to %" PRIu32, rest, rest_in_doubles));
    filter.self_rest_distance = in.real<double>();
    LoadedPositions loaded(&to.grid.memory_);
    Positions given;
    if (rest != no_rest) given = loaded.load(in, mesh.vertex_count(), rest == rest_in_doubles);
    in.end();
    or_refuse(in, to.last_filtered, [&] {
        if (rest != no_rest) mesh.self_filter_.rest = mesh.rest_pose(given, mesh.vertex_count());
        mesh.set_filter(checked_filter(filter));
    });
}

} // namespace vox
