// What lies across each facet of each tetrahedron, mostly in 16 bits: neighbours are near each other in the
// caller's numbering, and so are the triangles of tetrahedra near each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox {

class Across {
public:
    explicit Across(std::pmr::memory_resource* memory) noexcept
        : codes_(memory), blocks_(memory), far_(memory), unsorted_(memory), wide_(memory) {}

    // What lies there: a tetrahedron, or with this bit a triangle of the surface, or nothing that can be
    // determined where three or more tetrahedra meet.
    static constexpr std::uint32_t surface_bit = 0x80000000u;
    static constexpr std::uint32_t nothing = 0xffffffffu;

    std::pmr::memory_resource* memory() const noexcept { return codes_.get_allocator().resource(); }
    std::size_t size() const noexcept { return size_; } // tetrahedra
    std::size_t bytes() const noexcept;

    std::uint32_t operator()(std::uint32_t tet, std::uint32_t facet) const noexcept {
        if (is_wide_) return wide_[tet][facet];
        const std::uint32_t code = codes_[4 * std::size_t{tet} + facet];
        if (code < near_codes) return first_near(tet) + code;
        const Block& block = blocks_[tet / block_size];
        if (code < first_far_code) return surface_bit | (block.first_triangle + (code - near_codes));
        return code == nothing_code ? nothing : far_[block.first_far + (code - first_far_code)];
    }
    std::array<std::uint32_t, 4> operator[](std::size_t tet) const noexcept {
        const auto t = static_cast<std::uint32_t>(tet);
        return {(*this)(t, 0), (*this)(t, 1), (*this)(t, 2), (*this)(t, 3)};
    }
    // For a tetrahedron that is looked at soon.
    const void* place_of(std::uint32_t tet) const noexcept {
        return is_wide_ ? static_cast<const void*>(wide_.data() + tet) : codes_.data() + 4 * std::size_t{tet};
    }

    // Each throws what the memory throws.
    // Building. At first nothing is across the facets. Then each is set at most once, to something else, with
    // triangles ascending. The result can be read after finish().
    void begin(std::size_t tets);
    void build(std::uint32_t tet, std::uint32_t facet, std::uint32_t value) {
        if (is_wide_) {
            wide_[tet][facet] = value;
            return;
        }
        std::uint16_t& code = codes_[4 * std::size_t{tet} + facet];
        const std::uint32_t near = value - first_near(tet);
        if (near < near_codes)
            code = static_cast<std::uint16_t>(near);
        else
            build_far(tet, facet, value);
    }
    void finish();

    // Changes, of which the first takes 16 bytes a tetrahedron: widen() prepares for them. Nothing is across
    // new facets.
    void widen();
    void resize(std::size_t tets);
    void set(std::uint32_t tet, std::uint32_t facet, std::uint32_t value) noexcept {
        wide_[tet][facet] = value;
    }

private:
    // Codes: tetrahedra from first_near() on, triangles and places in `far_` from the first one of the block
    // on, and `nothing`.
    static constexpr std::uint32_t block_size = 256; // tetrahedra
    static constexpr std::uint32_t nothing_code = 0xffff, first_far_code = nothing_code - 4 * block_size,
                                   near_codes = 0xe000;
    // In a small mesh all tetrahedra are near each other.
    std::uint32_t first_near(std::uint32_t tet) const noexcept {
        return size_ <= near_codes ? 0 : tet - near_codes / 2;
    }
    struct Block {
        std::uint32_t first_triangle = nothing, first_far = 0;
    };
    struct Far {
        std::uint64_t place; // 4 * tetrahedron + facet
        std::uint32_t value;
    };

    void build_far(std::uint32_t tet, std::uint32_t facet, std::uint32_t value);

    std::size_t size_ = 0;
    bool is_wide_ = false; // where differences are large, and after edits
    std::pmr::vector<std::uint16_t> codes_;
    std::pmr::vector<Block> blocks_;
    std::pmr::vector<std::uint32_t> far_;
    std::pmr::vector<Far> unsorted_; // of `far_`, while it is built
    std::pmr::vector<std::array<std::uint32_t, 4>> wide_;
};

} // namespace vox
