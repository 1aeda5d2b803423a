// Bodies by isosurface stuffing, from functions of space that are positive inside.
#include "io/solids/bodies.hpp"

#include "base/error.hpp"
#include "io/solids/stuff.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {
namespace {

using Point = std::array<double, 3>;

double norm(double x, double y, double z = 0) { return std::sqrt(x * x + y * y + z * z); }

// Fills the region where `depth` is positive, which must be within +-half of the origin.
template <class Depth>
MeshData make(const Eigen::Vector3d& half, double cell, Depth&& depth) {
    const Frame frame = make_frame({-half, half}, cell);
    std::vector<Run> runs;
    for (std::int32_t z = 0; z <= 2 * frame.cells[2]; ++z)
        for (std::int32_t y = z & 1; y <= 2 * frame.cells[1]; y += 2)
            for (std::int32_t i = 0; 2 * i + (z & 1) <= 2 * frame.cells[0]; ++i) {
                if (!(depth(frame.position(2 * i + (z & 1), y, z)) > 0)) continue;
                if (!runs.empty() && runs.back().y == y && runs.back().z == z && runs.back().last == i - 1)
                    ++runs.back().last;
                else
                    runs.push_back({y, z, i, i});
            }
    const SolidShape body = {
        frame, NodeSet(frame, std::move(runs)), [&](const Node& node, unsigned neighbour) {
            const Node& step = neighbour_steps[neighbour];
            double in = 0, out = 1;
            for (int i = 0; i < 52; ++i) {
                const double middle = (in + out) / 2;
                const Point p = frame.position(node.x + middle * step.x, node.y + middle * step.y,
                                               node.z + middle * step.z);
                (depth(p) > 0 ? in : out) = middle;
            }
            return out;
        }};
    MeshData mesh = stuff(body, 0, VOX_MAX_TETS, Progress());
    if (mesh.tets.empty()) refuse(format("no tet fits into the body with a cell of %g", cell));
    return mesh;
}

} // namespace

MeshData make_ball(double radius, double cell) {
    return make({radius, radius, radius}, cell,
                [=](const Point& p) { return radius - norm(p[0], p[1], p[2]); });
}

MeshData make_torus(double radius, double tube_radius, double cell) {
    const double reach = radius + tube_radius;
    return make({reach, reach, tube_radius}, cell,
                [=](const Point& p) { return tube_radius - norm(norm(p[0], p[1]) - radius, p[2]); });
}

MeshData make_capsule(double radius, double length, double cell) {
    return make({radius, radius, radius + length / 2}, cell, [=](const Point& p) {
        return radius - norm(p[0], p[1], std::max(std::abs(p[2]) - length / 2, 0.0));
    });
}

MeshData make_cylinder(double radius, double length, double cell) {
    return make({radius, radius, length / 2}, cell, [=](const Point& p) {
        return std::min(radius - norm(p[0], p[1]), length / 2 - std::abs(p[2]));
    });
}

} // namespace vox::io
