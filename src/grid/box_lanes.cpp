#include "grid/box_lanes.hpp"

#include "base/simd.hpp"

#include <algorithm>
#include <bit>

#undef VOX_SOURCE
#define VOX_SOURCE "grid/box_lanes.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;

// A box, each of its numbers in all lanes.
struct Spread {
    hn::Vec<Floats> lo[3], hi[3];

    HWY_INLINE explicit Spread(const Box& box)
        : lo{hn::Set(Floats(), box.lo[0]), hn::Set(Floats(), box.lo[1]), hn::Set(Floats(), box.lo[2])},
          hi{hn::Set(Floats(), box.hi[0]), hn::Set(Floats(), box.hi[1]), hn::Set(Floats(), box.hi[2])} {}

    template <std::size_t Count>
    HWY_INLINE hn::Mask<Floats> Meets(const BoxLanes<Count>& boxes, std::size_t first) const {
        const auto within = [&](std::size_t axis) HWY_ATTR {
            return hn::And(hn::Le(hn::LoadU(Floats(), boxes.lo[axis] + first), hi[axis]),
                           hn::Le(lo[axis], hn::LoadU(Floats(), boxes.hi[axis] + first)));
        };
        return hn::And(within(0), hn::And(within(1), within(2)));
    }
};

HWY_INLINE std::uint32_t FacesMet(const Spread& box, const FaceBoxes& faces, std::size_t face_count) {
    std::uint64_t met = 0;
    for (std::size_t k = 0; k < face_count; k += hn::Lanes(Floats()))
        met |= BitsOfMask(Floats(), box.Meets(faces, k)) << k;
    return static_cast<std::uint32_t>(met);
}

HWY_INLINE std::uint32_t FirstBits(std::uint32_t count) { return count < 32 ? (1u << count) - 1 : ~0u; }

std::uint32_t FindEdgeFaces(const EdgeBoxes& edges, std::uint32_t edge_count, const Box& around_edges,
                            const FaceBoxes& faces, std::uint32_t face_count, EdgeFaces* HWY_RESTRICT out) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    const std::uint32_t near = FacesMet(Spread(around_edges), faces, face_count) & FirstBits(face_count);
    if (near == 0) return 0;
    Box around_faces = empty_box; // those near
    for (std::uint32_t left = near; left; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        add(around_faces, Box{{faces.lo[0][f], faces.lo[1][f], faces.lo[2][f], 0},
                              {faces.hi[0][f], faces.hi[1][f], faces.hi[2][f], 0}});
    }
    const Spread all(around_faces);
    std::uint32_t found = 0;
    for (std::size_t k = 0; k < edge_count; k += lanes) {
        std::uint64_t met = BitsOfMask(d, all.Meets(edges, k));
        if (edge_count - k < lanes) met &= (std::uint64_t{1} << (edge_count - k)) - 1;
        for (; met; met &= met - 1) {
            const std::size_t e = k + static_cast<std::size_t>(std::countr_zero(met));
            const Spread edge(Box{{edges.lo[0][e], edges.lo[1][e], edges.lo[2][e], 0},
                                  {edges.hi[0][e], edges.hi[1][e], edges.hi[2][e], 0}});
            out[found] = {static_cast<std::uint32_t>(e), FacesMet(edge, faces, face_count) & near};
            found += out[found].faces != 0;
        }
    }
    return found;
}

void FindFaces(const Box* HWY_RESTRICT boxes, std::size_t count, const FaceBoxes& faces,
               std::uint32_t face_count, std::uint32_t* HWY_RESTRICT out) {
    for (std::size_t i = 0; i < count; ++i)
        out[i] = FacesMet(Spread(boxes[i]), faces, face_count) & FirstBits(face_count);
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

std::uint32_t find_edge_faces(const EdgeBoxes& edges, std::uint32_t edge_count, const Box& around_edges,
                              const FaceBoxes& faces, std::uint32_t face_count, EdgeFaces* out) noexcept {
    return VOX_SIMD_DISPATCH(FindEdgeFaces)(edges, edge_count, around_edges, faces, face_count, out);
}

void find_faces(const Box* boxes, std::size_t count, const FaceBoxes& faces, std::uint32_t face_count,
                std::uint32_t* out) noexcept {
    VOX_SIMD_DISPATCH(FindFaces)(boxes, count, faces, face_count, out);
}

} // namespace vox
#endif
