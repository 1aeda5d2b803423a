// Tracks through meshes whose neighbours are on opposite sides of their common facets: from where a segment
// begins, and from each facet of the surface where it enters, from tetrahedron to tetrahedron. No such way
// turns back, so all pieces are on one. A segment that passes through an edge or a vertex, lies in a facet, or
// begins on one is left to the search of the tree.
#include "query/tracker.hpp"

#include "base/vectors.hpp"

#include <algorithm>

namespace vox {

bool Queries::is_walkable(const Mesh& mesh, bool may_find, std::pmr::memory_resource* memory) const {
    return mesh.walkable.get(may_find, [&] {
        const QueryTets& tets = *mesh.tets;
        if (tets.links.empty()) return false;
        Array<std::int8_t> sign(tets.tiles.tets.size(), memory);
        std::uint64_t exact_tests = 0;
        std::size_t next = 0;
        for (std::uint32_t tile = 0; tile < tets.tiles.tiles.size(); ++tile) {
            const LeafTets some = tets_of({static_cast<std::uint32_t>(&mesh - meshes_.data()), tile});
            for (std::size_t i = 0; i < some.size(); ++i) {
                const int volume = orientation(some.corner(i, 0), some.corner(i, 1), some.corner(i, 2),
                                               some.corner(i, 3), exact_tests);
                if (volume == 0) return false;
                sign[next++] = static_cast<std::int8_t>(volume);
            }
        }
        for (std::size_t t = 0; t < sign.size(); ++t)
            for (std::size_t f = 0; f < 4; ++f) {
                const std::uint32_t across = tets.links[t][f];
                if (across == QueryTets::no_link) continue;
                const bool turned = tets.facets[t] >> (4 + f) & 1;
                if ((sign[t] == sign[tets.place(across)]) == turned) return false;
            }
        return true;
    });
}

// Finds the ways of the segment; false if that takes the search of the tree.
bool Queries::Tracker::walk_all(std::span<const PointHit> around_from, const EntryBound& bound) {
    for (const PointHit& hit : around_from) {
        if (!hit.interior) return false;
        if (!walk(hit.leaf, hit.place, VOX_NONE, 0)) return false;
    }
    bool simple = true;
    const double most = 1;
    queries_.visit_facets(which_, most, bound,
                          [&](std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet, double) {
                              simple = simple && enter(leaf, tets, tet, facet);
                          });
    return simple;
}

// Walks on from a facet of the surface, if the segment enters there; false if it may lie in the facet or
// enters at its border.
bool Queries::Tracker::enter(std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet) {
    std::uint64_t exact_tests = 0;
    const Vec3d* corner[3];
    for (std::size_t c = 0; c < 3; ++c) corner[c] = &tets.corner(tet, facet_corners[facet][c]);
    const TrianglePlane plane(*corner[0], *corner[1], *corner[2]);
    if (plane.has_on_one_side(from_, to_)) return true;
    bool positive = false, negative = false, zero = false;
    for (std::size_t c = 0; c < 3; ++c) {
        const int side = orientation(from_, to_, *corner[c], *corner[(c + 1) % 3], exact_tests);
        positive |= side > 0;
        negative |= side < 0;
        zero |= side == 0;
        if (positive && negative) return true;
    }
    const int before = orientation(*corner[0], *corner[1], *corner[2], from_, exact_tests),
              after = orientation(*corner[0], *corner[1], *corner[2], to_, exact_tests);
    if (before == after) return before != 0;
    if (before == 0 || after == 0) return true; // a point alone
    const int volume = orientation(tets.corner(tet, 0), tets.corner(tet, 1), tets.corner(tet, 2),
                                   tets.corner(tet, 3), exact_tests);
    if (before != volume) return true; // it leaves; corners are counter-clockwise from outside
    return !zero && walk(leaf, static_cast<std::uint32_t>(tet), facet, volume);
}

// Appends the pieces from a tetrahedron on, which the segment enters by a facet, or in which it begins if that
// is VOX_NONE; `volume` is its sign, or 0. False at an edge or a vertex.
bool Queries::Tracker::walk(std::uint32_t leaf, std::uint32_t place, std::uint32_t facet_in, int volume) {
    const std::uint32_t mesh = queries_.leaves_[leaf].mesh;
    const auto first_leaf = static_cast<std::uint32_t>(queries_.meshes_[mesh].first_leaf);
    std::uint64_t exact_tests = 0;
    for (bool follows = false;; follows = true) {
        const LeafTets tets = queries_.tets_of(queries_.leaves_[leaf]);
        const Vec3d* const corner[4] = {&tets.corner(place, 0), &tets.corner(place, 1), &tets.corner(place, 2),
                                        &tets.corner(place, 3)};
        if (volume == 0) volume = orientation(*corner[0], *corner[1], *corner[2], *corner[3], exact_tests);
        const auto after = [&](std::uint32_t i) { // the side of facet i where the segment ends
            return volume * orientation(i == 0 ? to_ : *corner[0], i == 1 ? to_ : *corner[1],
                                        i == 2 ? to_ : *corner[2], i == 3 ? to_ : *corner[3], exact_tests);
        };
        // Of two facets, it leaves by the first one that it meets.
        std::uint32_t out = VOX_NONE;
        for (std::uint32_t i = 0; i < 4; ++i) {
            if (i == facet_in || (facet_in == VOX_NONE && after(i) >= 0)) continue;
            if (out == VOX_NONE) {
                out = i;
                continue;
            }
            const std::uint8_t* const others = other_corners[i][out];
            const int turn = orientation(from_, to_, *corner[others[0]], *corner[others[1]], exact_tests);
            if (turn == 0) return false;
            if (volume * turn > 0) out = i;
        }
        if (facet_in != VOX_NONE && after(out) >= 0) out = VOX_NONE;
        pieces_.push_back({mesh, tets.index(place), leaf, place, {true, false, facet_in, out}, follows});
        if (out == VOX_NONE) return true;
        const std::uint32_t across = tets.links(place)[out];
        if (across == QueryTets::no_link) return true;
        const std::uint32_t here = (leaf - first_leaf) * tile_size + place;
        if (tets.is_turned(place, out)) volume = -volume;
        leaf = first_leaf + across / tile_size;
        place = across % tile_size;
        const auto& back = queries_.tets_of(queries_.leaves_[leaf]).links(place);
        facet_in = static_cast<std::uint32_t>(std::find(back.begin(), back.end(), here) - back.begin());
    }
}

} // namespace vox
