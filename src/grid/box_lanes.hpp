// Boxes of the faces of a tile, side by side, so that one box is compared with all of them at once: along the
// coordinate axes, or along axes of each face.
#pragma once

#include "base/boxes.hpp"
#include "base/vectors.hpp"
#include "grid/surface_features.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vox {

struct FaceBoxes {
    static constexpr std::size_t count = SurfaceTile::most_faces;
    static_assert(count <= 32);
    alignas(64) float lo[3][count] = {}, hi[3][count] = {};

    void set(std::size_t i, const Box& box) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis][i] = box.lo[axis];
            hi[axis][i] = box.hi[axis];
        }
    }
};

// Finds, for each of the boxes, the faces whose boxes it overlaps, as bits.
void find_faces(const Box* boxes, std::size_t count, const FaceBoxes& faces, std::uint32_t face_count,
                std::uint32_t* out) noexcept;

// Oriented boxes of the faces, as seen from `origin`, and so small that sums of floats do not overflow.
struct FaceSlabs {
    static constexpr double scale = 0x1p-3;
    Vec3d origin;
    alignas(64) float axis[3][3][FaceBoxes::count] = {}; // axis, coordinate, face
    alignas(64) float lo[3][FaceBoxes::count] = {}, hi[3][FaceBoxes::count] = {};
};

// Takes faces out of `met` along an axis of which both ends of a segment lie beyond the face, on the same
// side, by more than `reach`. That covers what is rounded here: 2^-19 of the largest coordinate.
struct Segment {
    Vec3d from, to;
};
void keep_near(const Segment* segments, std::size_t count, const FaceSlabs& faces, float reach,
               std::uint32_t* met) noexcept;

// The direction of a line and its moment about the origin, rounded to floats, and the largest coordinate of
// each; what doubles lose of the moment is in its size.
struct Line {
    float at[6], size[2];

    Line(const Vec3d& from, const Vec3d& way) noexcept {
        const Vec3d moment = cross(from, way);
        const double of[] = {way.x, way.y, way.z, moment.x, moment.y, moment.z};
        std::transform(of, of + 6, at, [](double x) { return static_cast<float>(x); });
        const double length = largest_coordinate(way), lost = 0x1p-28 * largest_coordinate(from) * length;
        size[0] = static_cast<float>(length);
        size[1] = static_cast<float>(largest_coordinate(moment) + lost);
    }
};

// The sides of the faces as lines, seen from `origin`, times a scale by which coordinates are at most 1.
struct FaceLines {
    Vec3d origin;
    double scale = 0;
    alignas(64) float at[3][6][FaceBoxes::count] = {}, size[3][2][FaceBoxes::count] = {};
};

// Takes faces out of `met` that the line of a segment certainly passes beside: it does so clockwise of one
// side, and counter-clockwise of another.
void keep_crossed(const Segment* segments, std::size_t count, const FaceLines& faces,
                  std::uint32_t* met) noexcept;

} // namespace vox
