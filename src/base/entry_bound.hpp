// Where segments enter boxes.
#pragma once

#include "base/scene.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vox {

// A lower bound of the t at which a segment enters a box, at most 1; infinite if it misses the box.
class EntryBound {
public:
    EntryBound(const Vec3d& from, const Vec3d& to) noexcept
        : from_{from.x, from.y, from.z}, least_(min(from, to)), most_(max(from, to)) {
        const double way[3] = {to.x - from.x, to.y - from.y, to.z - from.z};
        constexpr double small = 0x1p-1000; // the inverse of smaller numbers may be infinite
        for (int axis = 0; axis < 3; ++axis) inverse_[axis] = std::abs(way[axis]) < small ? 0 : 1 / way[axis];
    }

    double operator()(const Box3f& box) const noexcept {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr double slack = 0x1p-48; // more than the relative error, a few roundings
        const float lo[3] = {box.min.x, box.min.y, box.min.z}, hi[3] = {box.max.x, box.max.y, box.max.z};
        const bool is_apart = most_.x < double{lo[0]} || most_.y < double{lo[1]} || most_.z < double{lo[2]} ||
                              least_.x > double{hi[0]} || least_.y > double{hi[1]} ||
                              least_.z > double{hi[2]};
        if (is_apart) return infinity;
        double enter = 0, leave = 1;
        for (int axis = 0; axis < 3; ++axis) {
            if (inverse_[axis] == 0) continue; // the segment hardly moves along this axis
            double t0 = (double{lo[axis]} - from_[axis]) * inverse_[axis];
            double t1 = (double{hi[axis]} - from_[axis]) * inverse_[axis];
            if (t0 > t1) std::swap(t0, t1);
            enter = std::max(enter, t0 - std::abs(t0) * slack);
            leave = std::min(leave, t1 + std::abs(t1) * slack);
        }
        return enter <= leave ? enter : infinity;
    }

private:
    double from_[3], inverse_[3];
    Vec3d least_, most_; // the segment's box
};

} // namespace vox
