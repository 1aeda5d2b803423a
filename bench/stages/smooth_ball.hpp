// A smooth ball, so that depths and closest points are those of a sphere.
#pragma once

#include "internal/meshes.hpp"

#include <algorithm>
#include <cmath>

// A lattice cube of about `tets` tetrahedra pushed onto the ball of that radius around the origin.
inline vox::test::Mesh smooth_ball(double tets, double radius) {
    const int n = std::max(2, int(std::lround(std::cbrt(tets / 5))));
    vox::test::Mesh mesh = vox::test::block(n, n, n);
    for (vox::Vec3f& p : mesh.positions) {
        const double x = 2.0 * double{p.x} / n - 1, y = 2.0 * double{p.y} / n - 1,
                     z = 2.0 * double{p.z} / n - 1;
        const double length = std::sqrt(x * x + y * y + z * z);
        const double scale =
            length > 0 ? radius * std::max({std::abs(x), std::abs(y), std::abs(z)}) / length : 0;
        p = {float(scale * x), float(scale * y), float(scale * z)};
    }
    return mesh;
}
