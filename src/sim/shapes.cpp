#include "sim/shapes.hpp"

#include "base/library.hpp"
#include "sim/contacts.hpp"

#include <algorithm>
#include <utility>

namespace vox::sim {

namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

void place(vox_grid* grid, vox_body id, const Placed& at) {
    Matrix34 matrix;
    matrix << at.axes, at.place;
    check(vox_body_set_transform(grid, id, matrix.data()));
}

const MovingShape* find(std::span<const MovingShape> shapes, vox_body id) {
    const auto found = std::ranges::lower_bound(shapes, id, {}, &MovingShape::id);
    return found != shapes.end() && found->id == id ? &*found : nullptr;
}

} // namespace

// Rotations by the shorter way, through a chord of the quaternions: roots are the same on every machine, and
// sines are not.
Placed MovingShape::at(double part) const {
    if (part == 0) return from;
    if (part == 1) return to;
    const double scales[2] = {from.axes.col(0).norm(), to.axes.col(0).norm()};
    const Eigen::Quaterniond first(Eigen::Matrix3d(from.axes / scales[0])),
        last(Eigen::Matrix3d(to.axes / scales[1]));
    const double side = first.dot(last) < 0 ? -1 : 1;
    const Eigen::Quaterniond turn(
        Eigen::Vector4d((1 - part) * first.coeffs() + (side * part) * last.coeffs()));
    return {((1 - part) * scales[0] + part * scales[1]) * turn.normalized().toRotationMatrix(),
            (1 - part) * from.place + part * to.place};
}

void Shapes::begin_step(vox_grid* grid, std::span<const BodyHandle> bodies) {
    std::uint64_t count = 0;
    check(vox_grid_get_bodies(grid, nullptr, 0, &count));
    ids_.resize(count);
    check(vox_grid_get_bodies(grid, ids_.data(), count, &count));
    std::swap(shapes_, before_);
    shapes_.clear();
    for (const vox_body id : ids_) {
        if (find_body(bodies, id)) continue;
        vox_body_info info{};
        info.struct_size = sizeof info;
        check(vox_body_get_info(grid, id, &info));
        if (info.shape == VOX_SHAPE_NONE || !info.enabled) continue;
        MovingShape shape{};
        const Eigen::Map<const Matrix34> matrix(info.transform);
        shape.id = id;
        shape.to = {matrix.leftCols<3>(), matrix.col(3)};
        const MovingShape* before = find(before_, id);
        shape.from = before ? before->from : shape.to;
        shape.now = shape.next = shape.from;
        shape.moves = shape.from.axes != shape.to.axes || shape.from.place != shape.to.place;
        std::ranges::copy(info.transform, shape.target);
        shapes_.push_back(shape);
    }
}

void Shapes::begin_substep(vox_grid* grid, double begin, double end) {
    for (MovingShape& shape : shapes_) {
        if (!shape.moves) continue;
        shape.now = shape.at(begin);
        shape.next = shape.at(end);
        place(grid, shape.id, shape.now);
    }
}

void Shapes::end_step(vox_grid* grid, double part) noexcept {
    for (MovingShape& shape : shapes_) {
        if (!shape.moves) continue;
        shape.from = shape.at(part);
        (void)vox_body_set_transform(grid, shape.id, shape.target); // it has had one, so this needs no memory
    }
}

Vec3 Shapes::motion(vox_body id, const Vec3& p) const {
    const MovingShape* shape = find(shapes_, id);
    if (!shape || !shape->moves) return Vec3::Zero();
    const Placed &now = shape->now, &next = shape->next;
    const Vec3 in_frame = now.axes.transpose() * (p - now.place) / now.axes.col(0).squaredNorm();
    return next.axes * in_frame + next.place - p;
}

} // namespace vox::sim
