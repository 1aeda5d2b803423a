// What a triangle, whose corners may move linearly, meets of a tetrahedron that stands still: decided
// exactly, whether the triangle is a segment or a point, and the tetrahedron flat.
#pragma once

#include "base/vectors.hpp"
#include "exact/predicates.hpp"

#include <cstddef>
#include <cstdint>

namespace vox {

// The corners of the edges of a tetrahedron.
inline constexpr std::uint8_t edge_corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

struct TetMeeting {
    bool any = false;
    std::uint32_t edges = 0; // a bit for each edge that it meets
    double t = 0;            // of the first meeting with the tetrahedron, rounded to nearest
    double s[6] = {};        // where it first meets an edge: 0 at the end with the lower vertex
};

class MovingTriangle {
public:
    // `to` may be null: it stands still.
    MovingTriangle(const Vec3d* from, const Vec3d* to);

    // What is said of an edge is the same for all tetrahedra that have it: `vertex` are their corners'
    // numbers.
    TetMeeting meet(const Vec3d* const (&corner)[4], const std::uint32_t (&vertex)[4]) const;

    const Vec3d* from() const { return from_; }
    const Vec3d* to() const { return to_; }

private:
    class Contacts;
    bool is_beside(const Vec3d* const (&corner)[4]) const;
    bool meets_faces(const Vec3d* const (&corner)[4]) const;
    int side_of(const Vec3d& p) const;
    std::size_t sides() const { return corners_ == 3 ? 3 : corners_ - 1; }

    Vec3d from_[3], to_[3];
    TrianglePlane plane_; // at first
    bool moves_ = false;
    std::size_t corners_ = 0, corner_[3] = {}; // those that are different
};

} // namespace vox
