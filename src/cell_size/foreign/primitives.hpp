// What a grid that is not this library's holds, or what asks it: vox_primitives, checked, each as its box.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "cell_size/pairs.hpp"

#include <vox/vox_cell_size.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

// The caller's primitives, borrowed.
class Primitives {
public:
    // Reads and checks all but the arrays. `where` starts every error text, e.g. "held: ". Throws
    // INVALID_ARGUMENT, LIMIT; INVALID_MESH where there are too few vertices.
    Primitives(const vox_primitives& desc, const char* where);

    std::uint64_t count() const noexcept { return count_; }
    int corners() const noexcept { return corners_; } // vertices of one
    bool is_box() const noexcept { return is_box_; }
    bool has_radii() const noexcept { return radii_ != nullptr; }
    double common_radius() const noexcept { return radius_; }

    // Their own and the common one. Throws INVALID_ARGUMENT, NON_FINITE.
    double radius(std::uint64_t primitive) const;
    // The box of the vertices of one, without its radius. Throws INVALID_MESH for a vertex that does not
    // exist, NON_FINITE or LIMIT for a position.
    PlainBox box(std::uint64_t primitive) const;
    Vec3d corner(std::uint64_t primitive, int corner) const; // of one that box() accepted

private:
    friend struct PackedPrimitives;
    std::uint64_t vertex(std::uint64_t primitive, int corner) const noexcept;
    [[noreturn]] void refuse_position(std::uint64_t primitive, std::uint64_t vertex) const;

    const char* where_;
    Positions positions_;
    std::uint64_t vertex_count_;
    const std::byte* indices_; // or null
    std::size_t index_stride_;
    std::uint64_t count_;
    const std::byte* radii_; // or null
    std::size_t radius_stride_;
    bool double_radii_, is_box_;
    double radius_;
    int corners_;
};

// The longest side of a box, with its radius, among all. Throws as Primitives::box(), but not for every NaN.
double longest_side(const Primitives& primitives);

// Adds boxes of about `wanted` primitives, with radii and `grown` beyond: all of them, or one of each part of
// the list, at a place that is independent from part to part and from seed to seed. So a pair of one
// primitive from each of two samples is as likely as any other. Throws as Primitives::box().
void sample_boxes(const Primitives& primitives, double grown, std::uint64_t wanted, std::uint64_t seed,
                  SampleTree& sample);

} // namespace vox
