// The parts of a snapshot that describe meshes.
#include "base/array.hpp"
#include "grid/snapshot.hpp"

#include "base/vectors.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>
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
void load_points(SnapshotChunk& in, std::uint64_t count, Array<Point>& points) {
    in.expect(count, sizeof(Point), "positions");
    points.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) load_point(in, points.emplace_back());
}

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
            for (const double element : mesh.transform_) out.f64(element);
        for (std::uint32_t t = 0; t < body.tets.size(); ++t)
            for (const std::uint32_t vertex : mesh.given(t).v) out.u32(vertex);
        for (std::uint32_t v = 0; has_positions && v < body.vertex_count; ++v)
            if (positions.doubles)
                save_point(positions.exact(v), out);
            else
                save_point(positions.floats(v), out);
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
            element = in.f64();
            if (!std::isfinite(element)) in.refuse(format("its transform has the element %g", element));
        }

    Array<Tet> tets(&grid.memory_);
    in.expect(desc.tet_count, sizeof(Tet), "tetrahedra");
    tets.reserve(static_cast<std::size_t>(desc.tet_count));
    for (std::uint64_t tet = 0; tet < desc.tet_count; ++tet) {
        Tet& t = tets.emplace_back();
        for (std::uint32_t& vertex : t.v) vertex = in.u32();
    }
    Array<Vec3f> floats(&grid.memory_);
    Array<Vec3d> doubles(&grid.memory_);
    desc.positions.count = vertex_count;
    desc.positions.format = static_cast<vox_format>(position_format);
    if (has_positions && desc.positions.format == VOX_FORMAT_DOUBLE) {
        load_points(in, vertex_count, doubles);
        desc.positions.data = doubles.data();
    } else if (has_positions) {
        load_points(in, vertex_count, floats);
        desc.positions.data = floats.data();
    }
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
    const vox_body id = in.u32();
    if (!to.grid.is_valid(id)) in.refuse(format("body %" PRIu32 " is not in it", id));
    if (id <= to.last_cut) in.refuse(format("body %" PRIu32 " comes after body %" PRIu32, id, to.last_cut));
    to.last_cut = id;
    if (const std::uint32_t reserved = in.u32(); reserved != 0)
        in.refuse(format("a reserved word is %" PRIu32 ", expected 0", reserved));

    Mesh& mesh = to.grid.mesh(id);
    Array<std::uint64_t> off(&to.grid.memory_), removed(off.memory()), removed_vertices(off.memory());
    load_bits(in, mesh.tet_count(), "tetrahedra that are off", off);
    load_bits(in, mesh.tet_count(), "tetrahedra that are removed", removed);
    load_bits(in, mesh.vertex_count(), "vertices that are removed", removed_vertices);
    in.end();
    or_refuse(in, id, [&] { mesh.restore_edits(off, removed, removed_vertices); });
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
        out.f64(filter.self_rest_distance);
        for (std::size_t v = 0; v < rest.size(); ++v)
            if (rest.in_doubles())
                save_point(rest[v], out);
            else
                save_point(nearest_floats(rest[v]), out);
        out.end_chunk();
    });
}

void Snapshot::load_filter(SnapshotChunk& in, Loading& to) {
    const vox_body id = in.u32();
    if (!to.grid.is_valid(id)) in.refuse(format("body %" PRIu32 " is not in it", id));
    if (id <= to.last_filtered)
        in.refuse(format("body %" PRIu32 " comes after body %" PRIu32, id, to.last_filtered));
    to.last_filtered = id;

    Mesh& mesh = to.grid.mesh(id);
    vox_filter filter = mesh.filter();
    filter.group = static_cast<std::int32_t>(in.u32());
    filter.category = in.u64();
    filter.mask = in.u64();
    filter.world = in.u32();
    filter.self_rings = in.u32();
    if (const std::uint32_t reserved = in.u32(); reserved != 0)
        in.refuse(format("a reserved word is %" PRIu32 ", expected 0", reserved));
    const std::uint32_t rest = in.u32();
    if (rest > rest_in_doubles)
        in.refuse(
            format("its rest pose is of kind %" PRIu32 ", expected 0 to %" PRIu32, rest, rest_in_doubles));
    filter.self_rest_distance = in.f64();
    Array<Vec3f> floats(&to.grid.memory_);
    Array<Vec3d> doubles(&to.grid.memory_);
    Positions given;
    if (rest == rest_in_doubles) {
        load_points(in, mesh.vertex_count(), doubles);
        given = {reinterpret_cast<const std::byte*>(doubles.data()), sizeof(Vec3d), true};
    } else if (rest == rest_in_floats) {
        load_points(in, mesh.vertex_count(), floats);
        given = {reinterpret_cast<const std::byte*>(floats.data()), sizeof(Vec3f)};
    }
    in.end();
    or_refuse(in, id, [&] {
        if (rest != no_rest) mesh.self_filter_.rest = mesh.rest_pose(given, mesh.vertex_count());
        mesh.set_filter(checked_filter(filter));
    });
}

} // namespace vox
