// Tracks through meshes whose neighbours are on opposite sides of their common facets: from where a segment
// begins, and from each facet of the surface where it enters, from tetrahedron to tetrahedron. No such way
// turns back, so all pieces are on one. A segment that passes through an edge or a vertex, lies in a facet,
// or begins on one is left to the search of the tree.
#include "query/tracker.hpp"

#include "base/prefetch.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace vox {

bool Queries::is_walkable(const Mesh& mesh, bool may_find, std::pmr::memory_resource* memory) const {
    return mesh.walkable.get(may_find, [&] {
        const QueryTets& tets = *mesh.tets;
        const QueryTets::Links& links = tets.links();
        if (links.empty()) return false;
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
                const TetLink across = links[t][f];
                if (across.tile == TetLink::no_tile) continue;
                const std::int8_t other = sign[tets.tiles.tiles[across.tile].first_tet + across.place];
                if ((sign[t] == other) == across.turned) return false;
            }
        return true;
    });
}

// Finds the ways of the segment; false if that takes the search of the tree.
bool Queries::Tracker::walk_all(std::span<const PointHit> around_from, const EntryBound& bound) {
    for (const PointHit& hit : around_from) {
        if (!hit.interior) return false;
        std::uint64_t exact_tests = 0;
        const LeafTets tets = queries_.tets_of(queries_.leaves_[hit.leaf]);
        const int volume = orientation(tets.corner(hit.place, 0), tets.corner(hit.place, 1),
                                       tets.corner(hit.place, 2), tets.corner(hit.place, 3), exact_tests);
        if (!walk(hit.leaf, hit.place, VOX_NONE, volume)) return false;
    }
    bool simple = true;
    const double most = 1;
    queries_.visit_facets(which_, most, bound,
                          [&](std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet,
                              double) { simple = simple && enter(leaf, tets, tet, facet); });
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

namespace {

// The facet by which the line from `from` to `to` leaves a tetrahedron that it enters by the interior of
// facet `in`; VOX_NONE if it may pass through an edge. `volume` is the tetrahedron's sign.
std::uint32_t way_out(const Vec3d& from, const Vec3d& to, const Vec3d* const (&corner)[4], std::uint32_t in,
                      int volume) {
    std::uint64_t exact_tests = 0;
    const TrianglePlane plane(from, to, *corner[in]);
    // Chooses from two facets the first one that it meets: see find_chord().
    const auto first = [&](std::uint32_t i, std::uint32_t j) {
        const std::uint8_t* const others = other_corners[i][j];
        const bool swapped = others[1] == in;
        const Vec3d& other = *corner[swapped ? others[0] : others[1]];
        const BoundedVolume turn = plane.volume(other);
        int side = turn.volume > 0 ? 1 : -1;
        if (!turn.certain()) side = orientation(from, to, *corner[in], other, exact_tests);
        if (side == 0) return std::uint32_t{VOX_NONE};
        return (volume * side > 0) != swapped ? i : j;
    };
    const std::uint32_t out = first((in + 1) % 4, (in + 2) % 4);
    return out == VOX_NONE ? out : first(out, (in + 3) % 4);
}

double coordinate(const Vec3d& p, int axis) noexcept { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

} // namespace

// True if the segment certainly does not end before it is beyond a facet: all corners are.
bool Queries::Tracker::ends_beyond(const Vec3d* const (&corner)[4], std::uint32_t facet) const noexcept {
    const double end = coordinate(to_, axis_);
    bool beyond = true;
    for (const std::uint8_t c : facet_corners[facet]) {
        const double at = coordinate(*corner[c], axis_);
        beyond &= ascends_ ? at < end : at > end;
    }
    return beyond;
}

// Appends the pieces from a tetrahedron on, which the segment enters by a facet, or in which it begins if
// that is VOX_NONE; `volume` is its sign. False at an edge or a vertex.
bool Queries::Tracker::walk(std::uint32_t leaf, std::uint32_t place, std::uint32_t facet_in, int volume) {
    const std::uint32_t m = queries_.leaves_[leaf].mesh;
    const Mesh& mesh = queries_.meshes_[m];
    std::uint32_t next = queries_.leaves_[leaf].tile, tile = TetLink::no_tile;
    std::optional<LeafTets> tets;
    const QueryTets::Links& links = *links_[m];
    const auto prefetch_links = [&](const TetLink& tet) {
        if (tet.tile != TetLink::no_tile)
            prefetch(links.data() + mesh.tets->tiles.tiles[tet.tile].first_tet + tet.place);
    };
    std::uint64_t exact_tests = 0;
    for (bool follows = false;; follows = true) {
        if (next != tile) {
            tile = next;
            tets.emplace(mesh, tile, queries_.vertices_.data(), queries_.boxes_.data());
        }
        const Vec3d* const corner[4] = {&tets->corner(place, 0), &tets->corner(place, 1),
                                        &tets->corner(place, 2), &tets->corner(place, 3)};
        const std::array<TetLink, 4>& here = links[tets->first_tet() + place];
        for (std::size_t f = 0; f < 4; ++f)
            if (f != facet_in) prefetch_links(here[f]);
        const auto leaves_by = [&](std::uint32_t facet) {
            return ends_beyond(corner, facet) ||
                   volume * orientation(*corner[facet_corners[facet][0]], *corner[facet_corners[facet][1]],
                                        *corner[facet_corners[facet][2]], to_, exact_tests) >
                       0;
        };
        std::uint32_t out = VOX_NONE;
        if (facet_in == VOX_NONE) {
            const TrackChord chord = find_chord(from_, to_, corner);
            if (chord.tied) return false;
            out = chord.facet_out;
        } else {
            out = way_out(from_, to_, corner, facet_in, volume);
            if (out == VOX_NONE) return false;
            if (!leaves_by(out)) out = VOX_NONE;
        }
        pieces_.push_back({m, tets->index(place), {true, false, false, facet_in, out}, follows});
        if (!follows) add_end(corner, facet_in, false);
        add_end(corner, out, true);
        if (out == VOX_NONE) return true;
        const TetLink across = here[out];
        if (across.tile == TetLink::no_tile) return true;
        if (across.turned) volume = -volume;
        next = across.tile;
        place = across.place;
        facet_in = across.facet;
    }
}

} // namespace vox
