// Queries for the tetrahedra that segments pass through. Which of the four planes of a tetrahedron a segment
// enters or leaves by, and in which order, is decided exactly; where it does so is rounded once, so that it
// is the same for all tetrahedra that meet there, and in the same order.
#include "query/tracker.hpp"

#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace vox {

// Let h_i be the volume with P in place of corner i, which is 0 where the segment P(t) crosses plane i, at
// t_i. The order of t_i and t_j follows from the sign of h_i(0) h_j(1) - h_j(0) h_i(1), which is the
// tetrahedron's volume times the volume of the segment's ends and the two other corners, in an even
// permutation.
TrackChord find_chord(const Vec3d& from, const Vec3d& to, const Vec3d* const (&corner)[4]) {
    std::uint64_t exact_tests = 0;
    const auto sign_of = [&exact_tests](const BoundedVolume& volume, const Vec3d& a, const Vec3d& b,
                                        const Vec3d& c, const Vec3d& d) {
        if (volume.certain()) return volume.volume > 0 ? 1 : -1;
        return uncertain_orientation(volume, a, b, c, d, exact_tests);
    };
    const Vec3d &a = *corner[0], &b = *corner[1], &c = *corner[2], &d = *corner[3];
    const auto volumes_from = corner_volumes(from, a, b, c, d), volumes_to = corner_volumes(to, a, b, c, d);
    const int volume = orientation(a, b, c, d, exact_tests);
    if (volume == 0) return {};
    TrackChord chord{.any = true};
    std::uint32_t enters = 0, leaves = 0; // a bit for each facet
    for (std::uint32_t i = 0; i < 4; ++i) {
        const auto side = [&](const BoundedVolume& of, const Vec3d& p) {
            return volume * sign_of(of, i == 0 ? p : a, i == 1 ? p : b, i == 2 ? p : c, i == 3 ? p : d);
        };
        const int before = side(volumes_from[i], from), after = side(volumes_to[i], to);
        if (before <= 0 && after <= 0) {
            if (before < 0 || after < 0) return {};
            chord.within = true;
        }
        enters |= std::uint32_t{before < 0} << i;
        leaves |= std::uint32_t{after < 0} << i;
    }
    // -1 if t_i is greater than t_j and both are entered, or if t_i is less and it is entered and j left.
    const auto turn = [&](std::uint32_t i, std::uint32_t j) {
        const std::uint8_t* const others = other_corners[i][j];
        return volume * orientation(from, to, *corner[others[0]], *corner[others[1]], exact_tests);
    };
    const auto choose = [&](std::uint32_t i, std::uint32_t& facet, int wanted) {
        const int side = facet == VOX_NONE ? wanted : turn(i, facet);
        if (side == wanted) facet = i;
        chord.tied |= side == 0;
    };
    for (std::uint32_t i = 0; i < 4; ++i) {
        if (enters >> i & 1) choose(i, chord.facet_in, -1);
        if (leaves >> i & 1) choose(i, chord.facet_out, 1);
    }
    chord.any = chord.facet_in == VOX_NONE || chord.facet_out == VOX_NONE ||
                turn(chord.facet_in, chord.facet_out) < 0;
    return chord;
}

void Queries::Tracker::find(std::uint32_t segment, const Vec3d& from, const Vec3d& to,
                            const std::span<const PointHit>* around_from, HitList<vox_track_piece>& out) {
    if (from.x == to.x && from.y == to.y && from.z == to.z) return;
    from_ = from;
    to_ = to;
    const Vec3d way = to - from;
    axis_ = std::abs(way.x) >= std::abs(way.y) ? 0 : 1;
    if (std::abs(way.z) > std::max(std::abs(way.x), std::abs(way.y))) axis_ = 2;
    ascends_ = (axis_ == 0 ? way.x : axis_ == 1 ? way.y : way.z) > 0;
    pieces_.clear();
    const EntryBound bound(from, to);
    if (!around_from || !walk_all(*around_from, bound)) {
        pieces_.clear();
        end_count_ = 0;
        queries_.tree_.visit_accepted([&bound](const Box3f& box) { return bound(box) <= 1; },
                                      [&](std::uint32_t leaf) { find_in(leaf, bound); });
    }
    place_ends();
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        if (pieces_[i].follows) pieces_[i].t_in = pieces_[i - 1].t_out;
    const auto before = [](const Piece& x, const Piece& y) { return x.order() < y.order(); };
    if (!std::is_sorted(pieces_.begin(), pieces_.end(), before))
        std::sort(pieces_.begin(), pieces_.end(), before);
    const bool settled =
        std::none_of(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.chord.within; });
    if (!settled) {
        settled_.clear();
        for (std::size_t begin = 0, end; begin < pieces_.size(); begin = end) {
            for (end = begin + 1; end < pieces_.size() && pieces_[end].mesh == pieces_[begin].mesh;) ++end;
            settle(std::span(pieces_).subspan(begin, end - begin));
        }
        std::sort(settled_.begin(), settled_.end(), before);
    }
    for (const Piece& p : settled ? pieces_ : settled_)
        if (vox_track_piece* const piece = out.add())
            *piece = {
                segment, queries_.meshes_[p.mesh].id, p.tet, p.chord.facet_in, p.chord.facet_out, 0, p.t_in,
                p.t_out};
}

void Queries::Tracker::find_in(std::uint32_t leaf, const EntryBound& bound) {
    if (!queries_.wants(queries_.leaves_[leaf], which_)) return;
    const LeafTets tets = queries_.tets_of(queries_.leaves_[leaf]);
    for (std::uint32_t i = 0; i < tets.size(); ++i) {
        if (!(bound(tets.box(i)) <= 1)) continue;
        const Vec3d* const corner[4] = {&tets.corner(i, 0), &tets.corner(i, 1), &tets.corner(i, 2),
                                        &tets.corner(i, 3)};
        const TrackChord chord = find_chord(from_, to_, corner);
        if (!chord.any) continue;
        pieces_.push_back({queries_.leaves_[leaf].mesh, tets.index(i), chord});
        add_end(corner, chord.facet_in, false);
        add_end(corner, chord.facet_out, true);
    }
}

// Places the end of the last piece where the segment crosses a facet, now or later.
void Queries::Tracker::add_end(const Vec3d* const (&corner)[4], std::uint32_t facet, bool out) {
    if (facet == VOX_NONE) return;
    const std::size_t i = end_count_++;
    set(block_.point, i, from_);
    for (std::size_t c = 0; c < 3; ++c) set(block_.corner[c], i, *corner[facet_corners[facet][c]]);
    set(block_.corner[3], i, to_);
    ends_[i] = {pieces_.size() - 1, out};
    if (end_count_ == point_block) place_ends();
}

void Queries::Tracker::place_ends() {
    if (end_count_ == 0) return;
    fill_last_register(block_, end_count_);
    cross_planes(block_, end_count_, crossings_);
    for (std::size_t i = 0; i < end_count_; ++i) {
        Piece& piece = pieces_[ends_[i].piece];
        (ends_[i].out ? piece.t_out : piece.t_in) = crossings_.t[i];
    }
    end_count_ = 0;
}

// Leaves of the stretches in facets and edges those outside all interiors, each to its lowest tetrahedron: a
// sweep along the segment, through the pieces of one mesh.
void Queries::Tracker::settle(std::span<const Piece> pieces) {
    borders_.clear();
    active_.clear(); // a heap of stretches, the lowest tetrahedron on top
    for (const Piece& p : pieces) {
        borders_.push_back(p.t_in);
        borders_.push_back(p.t_out);
        if (!p.chord.within) settled_.push_back(p);
    }
    std::sort(borders_.begin(), borders_.end());
    const auto higher = [](const Piece* x, const Piece* y) { return x->tet > y->tet; };
    double inside_until = 0;
    std::size_t next = 0, last = ~std::size_t{0}; // the last stretch in settled_
    for (std::size_t b = 0; b + 1 < borders_.size(); ++b) {
        const double begin = borders_[b], end = borders_[b + 1];
        if (begin == end) continue;
        for (; next < pieces.size() && pieces[next].t_in <= begin; ++next) {
            if (!pieces[next].chord.within) {
                inside_until = std::max(inside_until, pieces[next].t_out);
                continue;
            }
            active_.push_back(&pieces[next]);
            std::push_heap(active_.begin(), active_.end(), higher);
        }
        while (!active_.empty() && active_[0]->t_out <= begin) {
            std::pop_heap(active_.begin(), active_.end(), higher);
            active_.pop_back();
        }
        if (active_.empty() || inside_until > begin) continue;
        const Piece& lowest = *active_[0];
        if (last < settled_.size() && settled_[last].tet == lowest.tet && settled_[last].t_out == begin) {
            settled_[last].t_out = end;
        } else {
            last = settled_.size();
            settled_.push_back(lowest);
            settled_[last].t_in = begin;
            settled_[last].t_out = end;
            if (begin != lowest.t_in) settled_[last].chord.facet_in = VOX_NONE;
        }
        settled_[last].chord.facet_out = end == lowest.t_out ? lowest.chord.facet_out : VOX_NONE;
    }
}

void Queries::tracks(std::span<const Vec3d> from, std::span<const Vec3d> to, QueryMeshes which,
                     std::pmr::memory_resource* memory, HitList<vox_track_piece>& pieces) const {
    // To find whether a mesh can be walked through takes as long as a search of the tree for so many
    // tetrahedra.
    constexpr std::size_t tets_a_segment = 64;
    const bool may_find = from.size() * tets_a_segment >= boxes_.size();
    const bool walks = std::all_of(meshes_.begin(), meshes_.end(), [&](const Mesh& mesh) {
        return !wants(mesh, which) || is_walkable(mesh, may_find, memory);
    });
    Array<PointHit> around(memory);
    if (walks) find_all(from, which, memory, around);
    Tracker tracker(*this, which, walks, memory);
    std::size_t begin = 0;
    for (std::uint32_t i = 0; i < from.size(); ++i) {
        std::size_t end = begin;
        while (end < around.size() && around[end].point == i) ++end;
        const std::span<const PointHit> around_from =
            std::span<const PointHit>(around).subspan(begin, end - begin);
        tracker.find(i, from[i], to[i], walks ? &around_from : nullptr, pieces);
        begin = end;
    }
}

} // namespace vox
