// Tetrahedra are listed by corner with a counting sort. Then the facets that have a vertex as their lowest
// one are sorted and matched, vertex by vertex: these lists are short and stay in cache.
#include "mesh/facets.hpp"

#include <algorithm>

namespace vox {

namespace {

// The corners of a tetrahedron, ascending, each as vertex << 2 | local index. Without branches, which would
// be mispredicted.
std::array<std::uint64_t, 4> sorted_corners(const Tet& tet) noexcept {
    std::array<std::uint64_t, 4> c;
    for (std::uint32_t i = 0; i < 4; ++i) c[i] = std::uint64_t{tet.v[i]} << 2 | i;
    const auto order = [&c](std::size_t i, std::size_t j) {
        const std::uint64_t low = std::min(c[i], c[j]), high = std::max(c[i], c[j]);
        c[i] = low;
        c[j] = high;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
    return c;
}

// For each vertex the tetrahedra that have it as one of their two lowest corners, which list_facets_at()
// needs.
IndexLists list_by_lowest(std::span<const Tet> tets, std::uint32_t vertex_count,
                          std::pmr::memory_resource* memory) {
    IndexLists lists(memory);
    std::uint32_t lowest[2];
    lists.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count, [&](std::uint32_t t) {
        const std::array<std::uint64_t, 4> corners = sorted_corners(tets[t]);
        for (std::size_t i = 0; i < 2; ++i) lowest[i] = static_cast<std::uint32_t>(corners[i] >> 2);
        return std::span<const std::uint32_t>(lowest, names_a_vertex_twice(tets[t]) ? 0 : 2);
    });
    return lists;
}

// Lists the facets whose lowest vertex is `vertex` in `room`, which grows as needed. `around` are the
// tetrahedra at the vertex. Without branches, which would be mispredicted in meshes numbered at random: of
// each tetrahedron all facets that may be wanted are written, and then as many kept as are.
std::span<TetFacet> list_facets_at(std::uint32_t vertex, std::span<const Tet> tets,
                                   std::span<const std::uint32_t> around, Array<TetFacet>& room) {
    if (room.size() < 3 * around.size()) room.resize(3 * around.size());
    TetFacet* next = room.data();
    for (const std::uint32_t t : around) {
        const std::uint32_t* v = tets[t].v;
        // With two lower corners, every facet has one of them.
        const auto lower =
            static_cast<std::uint32_t>((v[0] < vertex) + (v[1] < vertex) + (v[2] < vertex) + (v[3] < vertex));
        const std::array<std::uint64_t, 4> c = sorted_corners(tets[t]);
        const auto facet = [t](std::uint64_t middle, std::uint64_t high, std::uint64_t opposite) {
            return TetFacet{middle >> 2 << 32 | high >> 2, static_cast<std::uint32_t>(opposite >> 2),
                            4 * t + static_cast<std::uint32_t>(opposite & 3)};
        };
        const std::uint64_t other = c[lower == 0];
        next[0] = facet(c[2], c[3], other);
        next[1] = facet(other, c[2], c[3]);
        next[2] = facet(other, c[3], c[2]);
        constexpr std::uint8_t wanted[] = {3, 1, 0, 0};
        next += wanted[lower];
    }
    return {room.data(), next};
}

} // namespace

std::size_t Across::bytes() const noexcept {
    return codes_.capacity() * sizeof codes_[0] + blocks_.capacity() * sizeof(Block) +
           far_.capacity() * sizeof far_[0] + unsorted_.capacity() * sizeof(Far) +
           wide_.capacity() * sizeof wide_[0];
}

void Across::begin(std::size_t tets) {
    *this = Across(memory());
    size_ = tets;
    codes_.assign(4 * tets, static_cast<std::uint16_t>(nothing_code));
    blocks_.assign((tets + block_size - 1) / block_size, Block{});
}

void Across::build_far(std::uint32_t tet, std::uint32_t facet, std::uint32_t value) {
    const std::size_t place = 4 * std::size_t{tet} + facet;
    if (value & surface_bit) {
        Block& block = blocks_[tet / block_size];
        const std::uint32_t triangle = value & ~surface_bit;
        if (block.first_triangle == nothing) block.first_triangle = triangle;
        if (triangle - block.first_triangle < first_far_code - near_codes) {
            codes_[place] = static_cast<std::uint16_t>(near_codes + (triangle - block.first_triangle));
            return;
        }
    }
    unsorted_.push_back({static_cast<std::uint32_t>(place), value});
    if (unsorted_.size() > 2 * size_) widen(); // which takes less memory then
}

// By a counting sort.
void Across::finish() {
    if (unsorted_.empty()) return;
    for (const Far& far : unsorted_) ++blocks_[far.place / (4 * block_size)].first_far;
    std::uint32_t sum = 0;
    for (Block& block : blocks_) block.first_far = sum += block.first_far; // its end, so far
    far_.resize(unsorted_.size());
    for (auto far = unsorted_.rbegin(); far != unsorted_.rend(); ++far)
        far_[--blocks_[far->place / (4 * block_size)].first_far] = far->value;
    Array<std::uint16_t> count(blocks_.size(), 0, memory()); // of each block
    for (const Far& far : unsorted_)
        codes_[far.place] =
            static_cast<std::uint16_t>(first_far_code + count[far.place / (4 * block_size)]++);
    unsorted_ = Array<Far>(memory());
}

void Across::widen() {
    if (is_wide_) return;
    Array<std::array<std::uint32_t, 4>> wide(memory());
    wide.reserve(size_);
    for (std::size_t t = 0; t < size_; ++t) wide.push_back((*this)[t]);
    for (const Far& far : unsorted_) wide[far.place / 4][far.place % 4] = far.value;
    const std::size_t size = size_;
    *this = Across(memory());
    size_ = size;
    is_wide_ = true;
    wide_ = std::move(wide);
}

void Across::resize(std::size_t tets) {
    widen();
    wide_.resize(tets, {nothing, nothing, nothing, nothing});
    size_ = tets;
}

void MatchedFacets::clear(std::size_t tets) {
    across.begin(tets);
    triangles.clear();
    is_repaired = false;
}

void FacetMatcher::match_at(std::uint32_t vertex, std::span<const std::uint32_t> around) {
    const std::span<TetFacet> facets = list_facets_at(vertex, tets_, around, room_);
    if (facets.size() <= most_hashed && match_pairs(vertex, facets)) return;
    std::sort(facets.begin(), facets.end());
    for (std::size_t first = 0, last = 0; first < facets.size(); first = last) {
        while (last < facets.size() && facets[last].others == facets[first].others) ++last;
        match(facets.subspan(first, last - first));
    }
}

void FacetMatcher::match(std::span<const TetFacet> same) {
    out_.match(tets_, same, [this](std::uint32_t tet, std::uint32_t facet, std::uint32_t value) {
        out_.across.build(tet, facet, value);
    });
}

// Almost all facets belong to one tetrahedron or two different ones, which a small hash table finds sooner
// than sorting does. Returns false, and has matched nothing, where a facet does not.
bool FacetMatcher::match_pairs(std::uint32_t vertex, std::span<TetFacet> facets) {
    constexpr std::uint32_t none = 0xffffffffu;
    constexpr std::size_t last = (std::size_t{1} << table_bits) - 1;
    const auto count = static_cast<std::uint32_t>(facets.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const TetFacet& facet = facets[i];
        // Multiplicative hashing (D. E. Knuth, The Art of Computer Programming 3, Sect. 6.4).
        std::size_t place = facet.others * 0x9e3779b97f4a7c15u >> (64 - table_bits);
        while (table_[place].used_at == vertex + 1 && table_[place].others != facet.others)
            place = (place + 1) & last;
        Slot& slot = table_[place];
        partner_[i] = none;
        if (slot.used_at != vertex + 1) {
            slot = {facet.others, vertex + 1, i};
            continue;
        }
        if (partner_[slot.first] != none || facets[slot.first].opposite == facet.opposite) return false;
        partner_[slot.first] = facet.tet();
        partner_[i] = facets[slot.first].tet();
    }
    std::size_t alone = 0; // they move to the front
    for (std::uint32_t i = 0; i < count; ++i) {
        const TetFacet facet = facets[i];
        if (partner_[i] != none)
            out_.across.build(facet.tet(), facet.index(), partner_[i]);
        else
            facets[alone++] = facet;
    }
    std::sort(facets.begin(), facets.begin() + static_cast<std::ptrdiff_t>(alone));
    for (const TetFacet& facet : facets.first(alone)) match({&facet, 1});
    return true;
}

void match_facets(std::span<const Tet> tets, std::uint32_t vertex_count, MatchedFacets& out) {
    std::pmr::memory_resource* memory = out.across.memory();
    MatchedFacets made(memory);
    made.clear(tets.size());
    const IndexLists around = list_by_lowest(tets, vertex_count, memory);
    FacetMatcher matcher(tets, made);
    for (std::uint32_t v = 0; v < vertex_count; ++v) matcher.match_at(v, around[v]);
    made.across.finish();
    out = std::move(made);
}

} // namespace vox
