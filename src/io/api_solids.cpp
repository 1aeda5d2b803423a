// The C border of the ready-made bodies and of surface to tetrahedra: validate, catch, forward.
#include "border.hpp"
#include "lattice_ball.hpp"
#include "structs.hpp"

#include <cmath>

using namespace vox;
using namespace vox::io;

vox_result vox_io_make_lattice_ball(std::uint64_t tet_count, double radius, vox_io_mesh** out_mesh) {
    return border([&] {
        require(out_mesh, "out_mesh");
        if (tet_count == 0 || tet_count > VOX_MAX_TETS / 4)
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("tet_count is %llu, expected 1 to %u",
                               static_cast<unsigned long long>(tet_count), VOX_MAX_TETS / 4));
        if (!std::isfinite(radius) || radius <= 0)
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("radius is %g, expected a finite number above 0", radius));
        *out_mesh = make_mesh(make_lattice_ball(tet_count, radius));
    });
}
