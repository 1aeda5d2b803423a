// Small bodies that meet no other one. A step looks at their positions and leaves them out of its stages, in
// which each body costs as much as some hundred vertices.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "fast/body_pairs.hpp"
#include "grid/mesh_table.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

class LoneBodies {
public:
    explicit LoneBodies(std::pmr::memory_resource* memory) noexcept
        : boxes_(memory), slots_(memory), met_(memory) {}

    // Looks at all meshes that take part in a step, and marks those that need not, by their slots; none where
    // small bodies are few or that would take long. Takes in the positions of small bodies: whether they
    // moved is known here, and no longer found by comparing them again. `all_rounded` if the engine is likely
    // to round positions of all bodies (Step::origin).
    void find(MeshTable& meshes, bool all_rounded, fast::PairBuffers& buffers, Workers& workers);
    // None.
    void forget() noexcept {
        slots_.clear();
        totals_ = {};
    }

    bool is_lone(std::size_t slot) const noexcept { return slot < slots_.size() && slots_[slot].is_lone; }
    // Whether it is known that a body moved or that it did not.
    bool compared(std::size_t slot) const noexcept { return slot < slots_.size() && slots_[slot].is_small; }
    bool moved(std::size_t slot) const noexcept { return compared(slot) && slots_[slot].moved; }

    // Of those marked.
    struct Totals {
        std::uint64_t bodies = 0, vertices = 0, tets = 0, moved = 0;
        Box rounded = empty_box; // around those whose positions are rounded
    };
    const Totals& totals() const noexcept { return totals_; }

private:
    struct Slot {
        std::uint16_t is_small : 1, is_large : 1, moved : 1, rounded : 1, is_lone : 1, vertices : 4, tets : 5;
    };
    static_assert(SharedTets::most_vertices < 1u << 4 && SharedTets::most_tets < 1u << 5);

    void look_at(MeshSlot& mesh, std::size_t slot, bool all_rounded);

    Array<Box> boxes_; // by slot; empty where no mesh takes part
    Array<Slot> slots_;
    Array<std::uint8_t> met_;
    Totals totals_;
};

} // namespace vox
