// The C border of filling surfaces with tetrahedra, and of the ready-made bodies.
#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "io/mesh.hpp"
#include "io/solids/bodies.hpp"

#include <algorithm>
#include <cmath>

using namespace vox;
using namespace vox::io;

namespace {

void require_length(double length, const char* name) {
    if (!std::isfinite(length) || length <= 0)
        refuse(format("%s is %g, expected a finite number above 0", name, length));
}

// Checks the lengths of a body, so that their squares, cubes and quotients are finite and normal, and makes
// it.
template <class Make>
vox_result make_body(vox_io_mesh** out_mesh, std::initializer_list<std::pair<double, const char*>> lengths,
                     double cell, const Make& make) {
    return border([&] {
        require(out_mesh, "out_mesh");
        require_length(cell, "cell");
        for (const auto& [length, name] : lengths) {
            require_length(length, name);
            if (length > 1e100 || length < 1e-100)
                refuse(format("%s is %g, expected 1e-100 to 1e100", name, length));
        }
        *out_mesh = make_mesh(make());
    });
}

} // namespace

vox_result vox_io_tetrahedralize(const vox_io_mesh* surface, const vox_io_tetrahedralize_desc* desc,
                                 vox_io_mesh** out_mesh) {
    return border([&] {
        require(surface, "surface");
        require(out_mesh, "out_mesh");
        vox_io_tetrahedralize_desc wanted{};
        if (desc) wanted = read_struct(desc, "desc");
        set_default(wanted.max_tets, std::uint64_t{100000000});
        check_enum(wanted.kind, VOX_IO_SOLID_CUBES, "desc.kind");
        if (!std::isfinite(wanted.cell) || wanted.cell < 0)
            refuse(format("desc.cell is %g, expected a finite number above 0, or 0", wanted.cell));
        if (!std::isfinite(wanted.max_distance) || wanted.max_distance < 0)
            refuse(format("desc.max_distance is %g, expected a finite number above 0, or 0",
                          wanted.max_distance));
        if (wanted.max_tets > VOX_MAX_TETS)
            refuse(format("desc.max_tets is %llu, expected 1 to %u", llu(wanted.max_tets), VOX_MAX_TETS));
        check_allocator(wanted.allocator, "desc.allocator");
        if (wanted.reserved != 0) refuse(format("desc.reserved is %u, expected 0", wanted.reserved));
        const vox_io_mesh_view& view = surface->view;
        if (view.triangle_count == 0)
            refuse(format("the surface has no triangles (%llu vertices, %llu tets)", llu(view.vertex_count),
                          llu(view.tet_count)));
        *out_mesh = make_mesh(tetrahedralize(view, wanted), wanted.allocator);
    });
}

vox_result vox_io_mesh_measure(const vox_io_mesh* mesh, const vox_io_mesh* surface,
                               vox_io_quality* out_quality) {
    return border([&] {
        require(mesh, "mesh");
        check_out_struct(out_quality, "out_quality");
        write_struct(out_quality, measure_quality(mesh->view, surface ? &surface->view : nullptr),
                     "out_quality");
    });
}

vox_result vox_io_make_lattice_ball(std::uint64_t tet_count, double radius, vox_io_mesh** out_mesh) {
    return border([&] {
        require(out_mesh, "out_mesh");
        if (tet_count == 0 || tet_count > VOX_MAX_TETS / 4)
            refuse(format("tet_count is %llu, expected 1 to %u", llu(tet_count), VOX_MAX_TETS / 4));
        require_length(radius, "radius");
        *out_mesh = make_mesh(make_lattice_ball(tet_count, radius));
    });
}

vox_result vox_io_make_ball(double radius, double cell, vox_io_mesh** out_mesh) {
    return make_body(out_mesh, {{radius, "radius"}}, cell, [&] { return make_ball(radius, cell); });
}

vox_result vox_io_make_torus(double radius, double tube_radius, double cell, vox_io_mesh** out_mesh) {
    return make_body(out_mesh, {{radius, "radius"}, {tube_radius, "tube_radius"}}, cell, [&] {
        if (tube_radius >= radius)
            refuse(format("tube_radius is %g, expected less than radius, %g", tube_radius, radius));
        return make_torus(radius, tube_radius, cell);
    });
}

vox_result vox_io_make_capsule(double radius, double length, double cell, vox_io_mesh** out_mesh) {
    return make_body(out_mesh, {{radius, "radius"}, {length, "length"}}, cell,
                     [&] { return make_capsule(radius, length, cell); });
}

vox_result vox_io_make_cylinder(double radius, double length, double cell, vox_io_mesh** out_mesh) {
    return make_body(out_mesh, {{radius, "radius"}, {length, "length"}}, cell,
                     [&] { return make_cylinder(radius, length, cell); });
}

vox_result vox_io_make_box(double size_x, double size_y, double size_z, double cell, vox_io_mesh** out_mesh) {
    return make_body(out_mesh, {{size_x, "size_x"}, {size_y, "size_y"}, {size_z, "size_z"}}, cell, [&] {
        const std::array<double, 3> size = {size_x, size_y, size_z};
        std::array<std::int32_t, 3> cells{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double count = std::max(1.0, std::floor(size[k] / cell + 0.5));
            if (!(count <= 1e6))
                throw_error(VOX_ERROR_LIMIT,
                            "a cell of %g makes %.0f cells along %c, at most 1000000 are possible", cell,
                            count, static_cast<int>('x' + k));
            cells[k] = static_cast<std::int32_t>(count);
        }
        return make_box(size, cells);
    });
}
