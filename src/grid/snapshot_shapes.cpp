// The part of a snapshot that describes shapes. Each is a mesh without vertices in MESH.
#include "grid/snapshot.hpp"

#include "shape/shape.hpp"

#include <utility>

namespace vox {

void Snapshot::check(const vox_grid& grid) {
    for_each_mesh(grid, [](vox_body id, const Mesh& mesh) {
        if (mesh.shape() && mesh.shape()->kind() == VOX_SHAPE_FIELD)
            throw Error(
                VOX_ERROR_INVALID_STATE,
                format("body %" PRIu32 " is a shape with a field, whose function cannot be saved", id));
    });
}

void Snapshot::save_shapes(const vox_grid& grid, SnapshotWriter& out) {
    for_each_mesh(grid, [&](vox_body id, const Mesh& mesh) {
        if (!mesh.shape()) return;
        const vox_shape_desc& desc = mesh.shape()->desc();
        const auto* const points = static_cast<const double*>(desc.positions.data);
        out.begin_chunk("SHAP");
        out.u32(id);
        out.u32(static_cast<std::uint32_t>(desc.kind));
        for (const double number : {desc.radius, desc.half_length, desc.half_size[0], desc.half_size[1],
                                    desc.half_size[2], desc.spacing[0], desc.spacing[1]})
            out.real(number);
        out.u32(desc.columns);
        out.u32(desc.rows);
        out.u64(desc.positions.count);
        out.u64(desc.triangle_count);
        for (std::uint64_t i = 0; i < desc.positions.count; ++i)
            for (std::uint64_t k = desc.kind == VOX_SHAPE_HEIGHTFIELD ? 2 : 0; k < 3; ++k)
                out.real(points[3 * i + k]);
        for (std::uint64_t i = 0; i < 3 * desc.triangle_count; ++i) out.u32(desc.triangles[i]);
        out.end_chunk();
    });
}

void Snapshot::load_shape(SnapshotChunk& in, Loading& to) {
    std::pmr::memory_resource* const memory = &to.grid.memory_;
    Mesh& mesh = next_mesh(in, to.grid, to.last_shape);
    const vox_body id = to.last_shape;
    if (mesh.vertex_count() > 0 || mesh.tet_count() > 0)
        in.refuse(format("body %" PRIu32 " has vertices or tetrahedra, expected none", id));
    vox_shape_desc desc = vox_default_shape_desc();
    const std::uint32_t kind = in.u32();
    if (kind >= VOX_SHAPE_FIELD) in.refuse(format("its kind is %" PRIu32 ", not one that is saved", kind));
    desc.kind = static_cast<vox_shape_kind>(kind);
    for (double* const number : {&desc.radius, &desc.half_length, &desc.half_size[0], &desc.half_size[1],
                                 &desc.half_size[2], &desc.spacing[0], &desc.spacing[1]})
        *number = in.real<double>();
    desc.columns = in.u32();
    desc.rows = in.u32();
    const std::uint64_t points = in.u64();
    desc.triangle_count = in.u64();
    const bool has_heights = kind == VOX_SHAPE_HEIGHTFIELD;
    if (has_heights && points != std::uint64_t{desc.columns} * desc.rows)
        in.refuse(
            format("%" PRIu64 " heights, expected %" PRIu32 " * %" PRIu32, points, desc.columns, desc.rows));
    in.expect(points, has_heights ? 8 : 24, "points");
    Array<double> numbers(static_cast<std::size_t>(has_heights ? points : 3 * points), memory);
    for (double& number : numbers) number = in.real<double>();
    in.expect(desc.triangle_count, 12, "triangles");
    Array<std::uint32_t> triangles(static_cast<std::size_t>(3 * desc.triangle_count), memory);
    for (std::uint32_t& corner : triangles) corner = in.u32();
    in.end();
    if (has_heights)
        desc.heights = numbers.data();
    else
        desc.positions = vox_double_positions(numbers.data(), points);
    desc.triangles = triangles.data();
    or_refuse(in, id, [&] { to.grid.become_shape(id, make_shape(desc, memory)); });
}

} // namespace vox
