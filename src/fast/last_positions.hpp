// Which bodies moved: their positions are compared, bit by bit, with a copy of those of the last step.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox::fast {

// A body's positions in the last step. Its vertices are cut into parts, the same ones in each step.
struct LastPositions {
    explicit LastPositions(std::pmr::memory_resource* memory) noexcept
        : positions(memory), exact(memory), parts(memory) {}

    // Makes room for doubles if positions are `rounded`, and drops that room if they are not. What was kept
    // of the other kind is invalid then.
    void expect(bool rounded);

    struct Part {
        Box box = empty_box; // in the last step; empty before the first
        bool copied = false; // whether `positions` or `exact` has those of the last step
    };
    Array<float> positions; // packed; with room for all vertices
    Array<Vec3d> exact;     // of bodies whose positions are rounded; else empty
    Array<Part> parts;
};

// True if the caller's positions are an array of packed, aligned floats.
inline bool is_packed(const Positions& positions) noexcept {
    return !positions.rounded() && positions.byte_stride == sizeof(Vec3f) && positions.component_gap == 0 &&
           reinterpret_cast<std::uintptr_t>(positions.data) % alignof(float) == 0;
}

// Copies the vertices [first, last) of a part that is not packed; returns whether they are those of the last
// step, bit by bit.
bool copy_strided(LastPositions& rest, std::size_t part, const Positions& positions, std::uint32_t first,
                  std::uint32_t last) noexcept;

// Returns whether the packed vertices [first, last) of a part are those of the last step, bit by bit. `box`
// is the box around them. Only parts that were copied can be compared. A part is copied when it is new, and
// when its box stays the same: so a part that moves in every step is not copied in every step.
bool compare_packed(LastPositions& rest, std::size_t part, const float* positions, std::uint32_t first,
                    std::uint32_t last, const Box& box) noexcept;

// Compares positions that were rounded into rest.positions.
bool compare_exact(LastPositions& rest, std::size_t part, const Positions& positions, std::uint32_t first,
                   std::uint32_t last, const Box& box) noexcept;

} // namespace vox::fast
