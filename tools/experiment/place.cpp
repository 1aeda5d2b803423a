#include "experiment/place.hpp"

#include "failure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tool {

// ---- bodies -----------------------------------------------------------------------------------------

Point Bounds::centre() const { return {(min[0] + max[0]) / 2, (min[1] + max[1]) / 2, (min[2] + max[2]) / 2}; }

Bounds bounds_of(const std::vector<double>& positions) {
    Bounds bounds;
    std::copy_n(positions.begin(), 3, bounds.min.begin());
    bounds.max = bounds.min;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        bounds.min[i % 3] = std::min(bounds.min[i % 3], positions[i]);
        bounds.max[i % 3] = std::max(bounds.max[i % 3], positions[i]);
    }
    return bounds;
}

namespace {

// Rotates about the centre of the box by a quaternion, which need not have unit length.
void turn(std::vector<double>& positions, double w, double x, double y, double z) {
    const double s = 2 / (w * w + x * x + y * y + z * z);
    const double matrix[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                                 {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                                 {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
    const Point centre = bounds_of(positions).centre();
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const double p[3] = {positions[i] - centre[0], positions[i + 1] - centre[1],
                             positions[i + 2] - centre[2]};
        for (std::size_t k = 0; k < 3; ++k)
            positions[i + k] = centre[k] + matrix[k][0] * p[0] + matrix[k][1] * p[1] + matrix[k][2] * p[2];
    }
}

} // namespace

// Rotations by about 41 and 57 degrees, about axes that are not symmetry axes of a cube.
void turn_first(std::vector<double>& positions) { turn(positions, 1, 0.11, 0.23, 0.28); }
void turn_second(std::vector<double>& positions) { turn(positions, 1, 0.31, -0.37, 0.26); }

void move(std::vector<double>& positions, const Point& by) {
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += by[i % 3];
}

vox_mesh_desc mesh_of(const std::vector<float>& positions, const std::vector<std::uint32_t>& tets) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(positions.data(), positions.size() / 3);
    desc.tets = tets.data();
    desc.tet_count = tets.size() / 4;
    return desc;
}

// ---- shares -----------------------------------------------------------------------------------------

double share_in_contact(const vox_grid* grid, std::uint64_t tet_count) {
    std::vector<std::uint64_t> held;
    for (const vox_contact& contact : contacts_of(grid))
        held.push_back(std::uint64_t{contact.body_b} << 32 | contact.tet);
    std::sort(held.begin(), held.end());
    const auto end = std::unique(held.begin(), held.end());
    return static_cast<double>(end - held.begin()) / static_cast<double>(tet_count);
}

ContactShare::ContactShare(const ExperimentBody& a, const ExperimentBody& b)
    : b_(b), tet_count_((a.tets.size() + b.tets.size()) / 4) {
    a_positions_.assign(a.positions.begin(), a.positions.end()); // rounds
    b_positions_.resize(b.positions.size());
    const vox_mesh_desc meshes[2] = {mesh_of(a_positions_, a.tets), mesh_of(b_positions_, b.tets)};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = 0; // contacts alone
    std::vector<vox_body> ids;
    grid_ = make_grid(desc, meshes, ids);
}

double ContactShare::at(const Point& offset) {
    for (std::size_t i = 0; i < b_positions_.size(); ++i)
        b_positions_[i] = static_cast<float>(b_.positions[i] + offset[i % 3]);
    check(vox_grid_step(grid_.get()));
    return share_in_contact(grid_.get(), tet_count_);
}

double place_at_share(ContactShare& share, const ExperimentBody& a, const ExperimentBody& b,
                      const Point& axis, double wanted) {
    const auto shadow = [&](const ExperimentBody& shape) {
        double min = HUGE_VAL, max = -HUGE_VAL;
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            const double along = shape.positions[i] * axis[0] + shape.positions[i + 1] * axis[1] +
                                 shape.positions[i + 2] * axis[2];
            min = std::min(min, along);
            max = std::max(max, along);
        }
        return std::pair(min, max);
    };
    const auto [a_min, a_max] = shadow(a);
    const auto [b_min, b_max] = shadow(b);
    const auto share_at = [&](double along) {
        return share.at({along * axis[0], along * axis[1], along * axis[2]});
    };

    // Moves b from just touching a on one side to just touching it on the other, in steps small enough not to
    // miss a shallow contact of slender bodies.
    double outside = a_max - b_min, inside = outside;
    const double through = a_min - b_max;
    constexpr int steps = 256;
    double most = 0, reached = 0;
    for (int i = 1; i <= steps && reached < wanted; ++i) {
        outside = inside;
        inside = a_max - b_min + (through - (a_max - b_min)) * i / steps;
        reached = share_at(inside);
        most = std::max(most, reached);
    }
    if (reached < wanted) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "at most %.3g of the tets come into contact along the axis (%.9g, %.9g, %.9g), "
                      "expected %.3g",
                      most, axis[0], axis[1], axis[2], wanted);
        throw Failure(text);
    }
    while (std::abs(reached - wanted) > 0.005 * wanted) {
        const double middle = inside + (outside - inside) / 2;
        if (middle == inside || middle == outside) break;
        const double middle_share = share_at(middle);
        if (middle_share >= wanted) {
            inside = middle;
            reached = middle_share;
        } else if (wanted - middle_share <= 0.005 * wanted) {
            return middle;
        } else {
            outside = middle;
        }
    }
    return inside;
}

} // namespace tool
