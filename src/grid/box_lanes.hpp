// Boxes of the features of a tile, side by side, so that one box is compared with all of them at once.
#pragma once

#include "base/boxes.hpp"
#include "grid/surface_features.hpp"

#include <cstddef>
#include <cstdint>

namespace vox {

template <std::size_t Count>
struct BoxLanes {
    alignas(64) float lo[3][Count] = {}, hi[3][Count] = {};

    void set(std::size_t i, const Box& box) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis][i] = box.lo[axis];
            hi[axis][i] = box.hi[axis];
        }
    }
};
using FaceBoxes = BoxLanes<SurfaceTile::most_faces>;
using EdgeBoxes = BoxLanes<SurfaceTile::most_edges>;
static_assert(SurfaceTile::most_faces <= 32);

// An edge, and the faces whose boxes its box overlaps, as bits.
struct EdgeFaces {
    std::uint32_t edge, faces;
};

// The edges of a tile whose boxes overlap those of faces of another: writes them to `out`, which has room for
// all edges, and returns their number. `around_edges` is the box of all edges.
std::uint32_t find_edge_faces(const EdgeBoxes& edges, std::uint32_t edge_count, const Box& around_edges,
                              const FaceBoxes& faces, std::uint32_t face_count, EdgeFaces* out) noexcept;

// Of each of the boxes the faces whose boxes it overlaps, as bits.
void find_faces(const Box* boxes, std::size_t count, const FaceBoxes& faces, std::uint32_t face_count,
                std::uint32_t* out) noexcept;

} // namespace vox
