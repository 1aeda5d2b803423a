// Facets of tetrahedra, matched in one place, for the topology, the boundary and the geometry of a mesh.
#pragma once

#include "base/array.hpp"
#include "base/lists.hpp"
#include "base/scene.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <utility>

namespace vox {

// A facet by its vertices, sorted.
struct FacetKey {
    std::uint32_t low, middle, high;

    auto operator<=>(const FacetKey&) const = default;
};

struct SortedFacet {
    FacetKey key;
    bool even; // sorting took an even permutation
};
inline SortedFacet sorted_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) noexcept {
    bool even = true;
    const auto order = [&even](std::uint32_t& x, std::uint32_t& y) {
        if (x <= y) return;
        std::swap(x, y);
        even = !even;
    };
    order(a, b);
    order(b, c);
    order(a, b);
    return {{a, b, c}, even};
}
// Facet i of a tetrahedron.
inline SortedFacet sorted_facet(const Tet& tet, std::uint32_t i) noexcept {
    const auto& [a, b, c] = facet_corners[i];
    return sorted_facet(tet.v[a], tet.v[b], tet.v[c]);
}

// A facet of one tetrahedron, in a list of facets with the same lowest vertex.
struct TetFacet {
    std::uint64_t others;   // the middle vertex << 32 | the highest one
    std::uint32_t opposite; // the tetrahedron's fourth vertex
    std::uint32_t place;    // 4 * tetrahedron + local index of `opposite`

    std::uint32_t tet() const noexcept { return place >> 2; }
    std::uint32_t index() const noexcept { return place & 3; }
    bool operator<(const TetFacet& other) const noexcept {
        if (others != other.others) return others < other.others;
        if (opposite != other.opposite) return opposite < other.opposite;
        return place < other.place;
    }
};

// A facet of one tetrahedron only, in the order of facet_corners of that tetrahedron.
struct Triangle {
    std::uint32_t v[3];
    std::uint32_t apex; // the tetrahedron's other vertex
};

// What lies across each facet of each tetrahedron, mostly in 16 bits: neighbours, and the triangles of
// neighbours, have similar numbers.
class Across {
public:
    explicit Across(std::pmr::memory_resource* memory) noexcept
        : codes_(memory), blocks_(memory), far_(memory), unsorted_(memory), wide_(memory) {}

    // A value is a tetrahedron, or with surface_bit a triangle of the surface, or `nothing` if three or more
    // tetrahedra share the facet.
    static constexpr std::uint32_t surface_bit = 0x80000000u;
    static constexpr std::uint32_t nothing = 0xffffffffu;

    std::pmr::memory_resource* memory() const noexcept { return codes_.memory(); }
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
    // The address to prefetch for a tetrahedron.
    const void* place_of(std::uint32_t tet) const noexcept {
        return is_wide_ ? static_cast<const void*>(wide_.data() + tet) : codes_.data() + 4 * std::size_t{tet};
    }

    // Building, which throws what the memory throws. At first nothing is across the facets. Each is set at
    // most once, with triangles ascending. The result can be read after finish().
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

    // Changing. widen() comes first, and takes 16 bytes a tetrahedron. Nothing is across new facets.
    void widen();
    void resize(std::size_t tets);
    void set(std::uint32_t tet, std::uint32_t facet, std::uint32_t value) noexcept {
        wide_[tet][facet] = value;
    }

private:
    // Codes below near_codes count tetrahedra from first_near() on, those below first_far_code triangles from
    // the block's first one on, and the others, but for nothing_code, places in `far_` from the block's first
    // one on.
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
        std::uint32_t place; // 4 * tetrahedron + facet
        std::uint32_t value;
    };

    void build_far(std::uint32_t tet, std::uint32_t facet, std::uint32_t value);

    std::size_t size_ = 0;
    bool is_wide_ = false; // if differences are large, and after edits
    Array<std::uint16_t> codes_;
    Array<Block> blocks_;
    Array<std::uint32_t> far_;
    Array<Far> unsorted_; // becomes `far_` in finish()
    Array<std::array<std::uint32_t, 4>> wide_;
};

// The facets of a mesh, matched. Doubled tetrahedra count once.
struct MatchedFacets {
    explicit MatchedFacets(std::pmr::memory_resource* memory) noexcept : across(memory), triangles(memory) {}

    static constexpr std::uint32_t surface_bit = Across::surface_bit, nothing = Across::nothing;

    Across across; // a triangle of the surface is one of `triangles`
    Array<Triangle> triangles;
    bool is_repaired = false; // if not, the triangles are sorted by their FacetKey

    // Prepares for `tets` tetrahedra, none of them matched.
    void clear(std::size_t tets);
    // Matches the tetrahedra that share a facet. Calls set(tet, facet, value of `across`).
    template <class Set>
    void match(std::span<const Tet> tets, std::span<const TetFacet> same, Set&& set) {
        const auto set_across = [&](std::span<const TetFacet> of, std::uint32_t value) {
            for (const TetFacet& facet : of) set(facet.tet(), facet.index(), value);
        };
        std::size_t second = same.size(), sides = 1; // different tetrahedra; doubled ones follow each other
        for (std::size_t i = 1; i < same.size(); ++i)
            if (same[i].opposite != same[i - 1].opposite && ++sides == 2) second = i;
        if (sides == 1) {
            const Tet& tet = tets[same[0].tet()];
            const auto& [a, b, c] = facet_corners[same[0].index()];
            set_across(same, surface_bit | static_cast<std::uint32_t>(triangles.size()));
            triangles.push_back({{tet.v[a], tet.v[b], tet.v[c]}, same[0].opposite});
        } else if (sides == 2) {
            set_across(same.first(second), same[second].tet());
            set_across(same.subspan(second), same[0].tet());
        }
    }
};

// Matches facets vertex by vertex, in ascending order; across.finish() is left to the caller.
class FacetMatcher {
public:
    // `out` is prepared for `tets`.
    FacetMatcher(std::span<const Tet> tets, MatchedFacets& out)
        : tets_(tets), out_(out), room_(out.triangles.memory()) {}

    // Matches the facets whose lowest vertex is `vertex`; `around` are the tetrahedra at the vertex.
    void match_at(std::uint32_t vertex, std::span<const std::uint32_t> around);

private:
    static constexpr std::size_t most_hashed = 96, table_bits = 8;
    struct Slot {
        std::uint64_t others = 0;
        std::uint32_t used_at = 0; // the vertex plus 1
        std::uint32_t first = 0;   // the index of the facet
    };

    void match(std::span<const TetFacet> same);
    bool match_pairs(std::uint32_t vertex, std::span<TetFacet> facets);

    std::span<const Tet> tets_;
    MatchedFacets& out_;
    Array<TetFacet> room_;
    std::array<std::uint32_t, most_hashed> partner_{}; // the tetrahedron on the other side of each facet
    std::array<Slot, std::size_t{1} << table_bits> table_{};
};

// The most tetrahedra that can be matched: lists of three corners of four facets have 32-bit ends.
inline constexpr std::uint32_t most_tets = UINT32_MAX / 12;

// Matches at most `most_tets` tetrahedra. If it throws what the memory throws, `out` is unchanged.
void match_facets(std::span<const Tet> tets, std::uint32_t vertex_count, MatchedFacets& out);

} // namespace vox
