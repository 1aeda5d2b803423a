// Rigid shapes that the caller has put into the grid. Within a step each moves at constant speed from where
// the step before left it to where the caller has placed it since, so that it pushes and drags bodies.
#pragma once

#include "base/array.hpp"
#include "sim/body.hpp"

#include <span>

namespace vox::sim {

struct Placed {
    Eigen::Matrix3d axes; // a rotation times a scale
    Vec3 place;
};

struct MovingShape {
    vox_body id;
    bool moves;
    Placed from, to;
    Placed now, next;  // at the beginning and the end of the substep
    double target[12]; // `to` as the caller set it

    Placed at(double part) const; // of the step, from 0 to 1
};

class Shapes {
public:
    explicit Shapes(std::pmr::memory_resource* memory) : shapes_(memory), before_(memory), ids_(memory) {}

    // Reads the enabled shapes of the grid. A shape that was not in the step before appears where it is.
    void begin_step(vox_grid* grid, std::span<const BodyHandle> bodies);
    // Places the shapes at the beginning of a substep, which is from `begin` to `end` in parts of the step.
    void begin_substep(vox_grid* grid, double begin, double end);
    // Places the shapes where the caller had them. The next step begins where this one stopped.
    void end_step(vox_grid* grid, double part) noexcept;

    // How a point at p moves with the shape in the substep.
    Vec3 motion(vox_body shape, const Vec3& p) const;

private:
    Array<MovingShape> shapes_; // ascending in id
    Array<MovingShape> before_;
    Array<vox_body> ids_;
};

} // namespace vox::sim
