// The straight walk (Devillers, Pion, Teillaud, "Walking in a triangulation", Int. J. of Foundations of
// Computer Science 13, 2002). Vertices are sheared so that the segment becomes the z axis, and the walk
// passes the facets whose projections contain the origin (Woop, Benthin, Wald, "Watertight ray/triangle
// intersection", Journal of Computer Graphics Techniques 2, 2013). The side of an edge on which the origin
// is found is computed in the same way for all facets around the edge, so the walk never slips between two of
// them. The winding of tetrahedra plays no part, so the walk goes through inverted and flat ones, too.
//
// Each lane of a register has a walk of its own. Registers take the place of branches that would be
// mispredicted, and many walks wait for memory together. What is an index (which tetrahedron, which facet) is
// plain code.
#include "depth/walk.hpp"

#include "base/prefetch.hpp"
#include "base/simd.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#undef VOX_SOURCE
#define VOX_SOURCE "depth/walk.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

#ifndef VOX_DEPTH_WALK_ONCE
#define VOX_DEPTH_WALK_ONCE
namespace vox::depth {

constexpr std::size_t walk_group = 64, walk_register = 8; // most walks side by side, most lanes

// The numbers of walks side by side. Coordinates are in the order of a walk's frame, in which z is the
// longest axis of the segment.
struct WalkLanes {
    alignas(64) double origin[3][walk_group];
    double way[3][walk_group]; // from p to q
    double shear[2][walk_group];
    // Coordinates and numbers of vertices: the corners of the first tetrahedron. Later the first is the apex
    // of the next one, or just the number of the vertex behind the gate, the fourth of the tetrahedron that
    // the line leaves; the others are the corners of the gate, in the frame.
    double corner[4][4][walk_group];
    // Where the line crosses the gate: weights of corners, and the height as numerator and denominator, which
    // is 0 for a gate that is seen edge-on.
    double weight[3][walk_group], above[walk_group], below[walk_group];
};

} // namespace vox::depth
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::depth {
namespace HWY_NAMESPACE {
namespace walks { // near.cpp has registers, too

#if HWY_HAVE_FLOAT64

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, walk_register>;
using D = hn::Vec<Doubles>;
using M = hn::Mask<Doubles>;
constexpr std::size_t lane_count = hn::MaxLanes(Doubles());

HWY_INLINE D Load(const double* from) { return hn::Load(Doubles(), from); }
HWY_INLINE void Store(D value, double* to) { hn::Store(value, Doubles(), to); }
HWY_INLINE D Set(double value) { return hn::Set(Doubles(), value); }
HWY_INLINE std::uint64_t BitsOf(M mask) { return vox::HWY_NAMESPACE::BitsOfMask(Doubles(), mask); }

#else // no doubles in registers: a plain number has the names of Highway's operations

using D = double;
using M = bool;
constexpr std::size_t lane_count = 1;

HWY_INLINE D Load(const double* from) { return *from; }
HWY_INLINE void Store(D value, double* to) { *to = value; }
HWY_INLINE D Set(double value) { return value; }
HWY_INLINE std::uint64_t BitsOf(M mask) { return mask; }
HWY_INLINE M And(M a, M b) { return a && b; }
HWY_INLINE M AndNot(M a, M b) { return !a && b; }
HWY_INLINE M Or(M a, M b) { return a || b; }
HWY_INLINE M Xor(M a, M b) { return a != b; }
HWY_INLINE M Not(M a) { return !a; }
HWY_INLINE D IfThenElse(M mask, D yes, D no) { return mask ? yes : no; }

#endif

// A vertex in the frame in which p is the origin and q is (0, 0, 1).
struct Corner {
    D x, y, z, vertex;
};

// The corners of a facet through which the line goes, counter-clockwise around the line.
using Gate = Corner[3];

HWY_INLINE Corner LoadCorner(const double (&from)[4][walk_group], std::size_t i) {
    return {Load(from[0] + i), Load(from[1] + i), Load(from[2] + i), Load(from[3] + i)};
}
HWY_INLINE void StoreCorner(const Corner& corner, double (&to)[4][walk_group], std::size_t i) {
    Store(corner.x, to[0] + i);
    Store(corner.y, to[1] + i);
    Store(corner.z, to[2] + i);
    Store(corner.vertex, to[3] + i);
}
HWY_INLINE Corner Select(M mask, const Corner& yes, const Corner& no) {
    return {IfThenElse(mask, yes.x, no.x), IfThenElse(mask, yes.y, no.y), IfThenElse(mask, yes.z, no.z),
            IfThenElse(mask, yes.vertex, no.vertex)};
}

HWY_INLINE Corner InFrame(const WalkLanes& walks, std::size_t c, std::size_t i) {
    const Corner at = LoadCorner(walks.corner[c], i);
    const D z = at.z - Load(walks.origin[2] + i);
    return {(at.x - Load(walks.origin[0] + i)) - Load(walks.shear[0] + i) * z,
            (at.y - Load(walks.origin[1] + i)) - Load(walks.shear[1] + i) * z, z / Load(walks.way[2] + i),
            at.vertex};
}

// Twice the area of the triangle (origin, a, b); the negative of Area(b, a), exactly.
HWY_INLINE D Area(const Corner& a, const Corner& b) { return a.x * b.y - b.x * a.y; }

// True if the origin is to the left of a -> b. An origin on the edge counts as if it were moved by (e, e^2)
// for a small e (Edelsbrunner, Muecke, "Simulation of simplicity", ACM Transactions on Graphics 9, 1990), so
// that the answers for all edges still belong to one line.
HWY_INLINE M Left(const Corner& a, const Corner& b) {
    const D twice = Area(a, b), zero = Set(0);
    const M by_x = Or(a.x < b.x, And(a.x == b.x, a.vertex < b.vertex));
    return Or(twice > zero, And(twice == zero, Or(a.y > b.y, And(a.y == b.y, by_x))));
}

struct GatePoint {
    D weight[3], above, below;
};
HWY_INLINE GatePoint CrossGate(const Gate& gate) {
    const D a = Area(gate[1], gate[2]), b = Area(gate[2], gate[0]), c = Area(gate[0], gate[1]);
    return {{a, b, c}, a * gate[0].z + b * gate[1].z + c * gate[2].z, a + b + c};
}

HWY_INLINE bool HaveWalks(std::uint64_t active, std::size_t i) { // the lanes of a register
    return (active >> i & ((std::uint64_t{1} << lane_count) - 1)) != 0;
}

// Returns the bits of walks whose gates are found.
HWY_INLINE std::uint64_t TakeGates(const Gate& gate, D behind, M found, std::size_t i, WalkLanes& walks) {
    const GatePoint at = CrossGate(gate);
    for (std::size_t k = 0; k < 3; ++k) {
        StoreCorner(gate[k], walks.corner[k + 1], i);
        Store(at.weight[k], walks.weight[k] + i);
    }
    Store(behind, walks.corner[0][3] + i);
    Store(at.above, walks.above + i);
    Store(at.below, walks.below + i);
    return BitsOf(found) << i;
}

// Finds the facets through which lines from the origin, inside or on the first tetrahedra, leave these.
std::uint64_t FirstGates(WalkLanes& walks, std::uint64_t active) {
    std::uint64_t all_found = 0;
    for (std::size_t i = 0; i < walk_group; i += lane_count) {
        if (!HaveWalks(active, i)) continue;
        const D zero = Set(0), length = Load(walks.way[2] + i);
        for (int axis = 0; axis < 2; ++axis) Store(Load(walks.way[axis] + i) / length, walks.shear[axis] + i);
        const Corner corner[4] = {InFrame(walks, 0, i), InFrame(walks, 1, i), InFrame(walks, 2, i),
                                  InFrame(walks, 3, i)};
        M left[4][4];
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b) left[b][a] = Not(left[a][b] = Left(corner[a], corner[b]));
        M found = zero > zero;
        D farthest = zero, behind = zero;
        Gate gate{corner[0], corner[0], corner[0]};
        for (int facet = 0; facet < 4; ++facet) {
            const auto& [a, b, c] = facet_corners[facet];
            const M is_gate = Not(Or(Xor(left[a][b], left[b][c]), Xor(left[a][b], left[c][a])));
            const Gate other{corner[a], Select(left[a][b], corner[b], corner[c]),
                             Select(left[a][b], corner[c], corner[b])};
            const GatePoint at = CrossGate(other);
            const D ab = IfThenElse(corner[a].z < corner[b].z, corner[b].z, corner[a].z);
            const D highest = IfThenElse(ab < corner[c].z, corner[c].z, ab);
            const D z = IfThenElse(at.below > zero, at.above / at.below, highest);
            const M take = AndNot(And(found, z <= farthest), is_gate);
            found = Or(found, take);
            farthest = IfThenElse(take, z, farthest);
            behind = IfThenElse(take, corner[facet].vertex, behind);
            for (int k = 0; k < 3; ++k) gate[k] = Select(take, other[k], gate[k]);
        }
        // None where p and q are one.
        all_found |= TakeGates(gate, behind, AndNot(length == zero, found), i, walks);
    }
    return all_found & active;
}

// Goes from the facets by which lines enter tetrahedra, whose fourth corners are apexes, to those by which
// they leave. By rounding alone, there may be none.
std::uint64_t NextGates(WalkLanes& walks, std::uint64_t active) {
    std::uint64_t all_found = 0;
    for (std::size_t i = 0; i < walk_group; i += lane_count) {
        if (!HaveWalks(active, i)) continue;
        const Corner apex = InFrame(walks, 0, i);
        const Gate in{LoadCorner(walks.corner[1], i), LoadCorner(walks.corner[2], i),
                      LoadCorner(walks.corner[3], i)};
        const M a = Left(apex, in[0]), b = Left(apex, in[1]), c = Left(apex, in[2]);
        const M by_ab = AndNot(b, a), by_bc = AndNot(c, b), by_ca = AndNot(a, c); // at most one
        const Gate out{apex, Select(by_ab, in[0], Select(by_bc, in[1], in[2])),
                       Select(by_ab, in[1], Select(by_bc, in[2], in[0]))};
        const D behind = IfThenElse(by_ab, in[2].vertex, IfThenElse(by_bc, in[0].vertex, in[1].vertex));
        all_found |= TakeGates(out, behind, Or(by_ab, Or(by_bc, by_ca)), i, walks);
    }
    return all_found & active;
}

} // namespace walks
using walks::FirstGates;
using walks::NextGates;

} // namespace HWY_NAMESPACE
} // namespace vox::depth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::depth {

namespace {

// Calls visit(i) for each bit i that is set.
template <class Visit>
void for_each_bit(std::uint64_t bits, Visit&& visit) {
    for (; bits; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

// Walks side by side. Each pass over them prefetches what the next one reads.
class WalkGroup {
public:
    WalkGroup(const Solid& solid, std::span<Walk> walks)
        : solid_(solid), topology_(*solid.topology), walks_(walks) {}

    void run() {
        for (const Walk& walk : walks_) {
            prefetch(&solid_.tets[walk.tet]);
            prefetch(topology_.across.place_of(walk.tet));
        }
        // Whole registers are computed, so the last one is filled up.
        for (std::size_t i = 0; i < walks_.size() || i % walk_register; ++i)
            begin(i, walks_[std::min(i, walks_.size() - 1)]);
        const auto next_gates = VOX_SIMD_DISPATCH(NextGates);
        std::uint64_t active =
            VOX_SIMD_DISPATCH(FirstGates)(lanes_, ~std::uint64_t{0} >> (walk_group - walks_.size()));
        while (active) {
            for_each_bit(active, [&](std::size_t i) { look_across(i); });
            std::uint64_t going_on = 0;
            for_each_bit(active, [&](std::size_t i) { going_on |= std::uint64_t{go_across(i)} << i; });
            active = next_gates(lanes_, going_on);
        }
    }

private:
    // Where a walk is, and where it was.
    struct Trail {
        std::uint32_t tet, behind, across, gate; // `gate`: exclusive or of its vertices
        std::uint32_t remembered_tet, remembered_behind;
        const std::uint8_t* row; // of each axis in the walk's frame
    };

    // Writes a vector in the order of the walk's frame.
    void put(const Vec3d& v, std::size_t i, double (*to)[walk_group]) const {
        const std::uint8_t* row = trails_[i].row;
        to[row[0]][i] = v.x;
        to[row[1]][i] = v.y;
        to[row[2]][i] = v.z;
    }
    void put_corner(std::uint32_t vertex, std::size_t i, std::size_t c) {
        put(solid_.at(vertex), i, lanes_.corner[c]);
        lanes_.corner[c][3][i] = vertex;
    }

    void begin(std::size_t i, Walk& walk) {
        static constexpr std::uint8_t rows[3][3] = {{2, 0, 1}, {1, 2, 0}, {0, 1, 2}};
        const Vec3d way = walk.q - walk.p;
        const double x = std::abs(way.x), y = std::abs(way.y);
        const int longest = std::abs(way.z) > std::max(x, y) ? 2 : y > x ? 1 : 0;
        trails_[i] = {walk.tet, 0, 0, 0, ~0u, 0, rows[longest]};
        walk.leaves = false;
        walk.visited = 0;
        put(walk.p, i, lanes_.origin);
        put(way, i, lanes_.way);
        for (std::size_t c = 0; c < 4; ++c) put_corner(solid_.tets[walk.tet].v[c], i, c);
    }

    // Finds out what lies across the gate, and prefetches it.
    void look_across(std::size_t i) {
        Trail& trail = trails_[i];
        const std::uint32_t* v = solid_.tets[trail.tet].v;
        const auto behind = static_cast<std::uint32_t>(lanes_.corner[0][3][i]);
        // Without branches, which would be mispredicted.
        const auto facet =
            (v[1] == behind ? 1u : 0u) | (v[2] == behind ? 2u : 0u) | (v[3] == behind ? 3u : 0u);
        trail.behind = behind;
        trail.gate = v[0] ^ v[1] ^ v[2] ^ v[3] ^ behind;
        trail.across = topology_.across(trail.tet, facet);
        if (trail.across & Topology::surface_bit)
            prefetch(topology_.triangles.data() + (trail.across & ~Topology::surface_bit));
        else
            prefetch(&solid_.tets[trail.across]);
    }

    // Returns whether the walk goes on in the tetrahedron across the gate.
    bool go_across(std::size_t i) {
        Trail& trail = trails_[i];
        // Inverted tetrahedra may lead a walk back to where it was. Then it would go round for ever, since
        // the facet by which it leaves decides all that follows. To find out, a place is remembered after 1,
        // 2, 4, ... steps (R. P. Brent, "An improved Monte Carlo factorization algorithm", BIT 20, 1980).
        const std::uint64_t steps = ++walks_[i].visited;
        if (trail.tet == trail.remembered_tet && trail.behind == trail.remembered_behind) return false;
        if ((steps & (steps - 1)) == 0) {
            trail.remembered_tet = trail.tet;
            trail.remembered_behind = trail.behind;
        }
        if (trail.across == Topology::nothing) return false;
        if (trail.across & Topology::surface_bit) {
            leave(i, trail.across & ~Topology::surface_bit);
            return false;
        }
        if (lanes_.above[i] > lanes_.below[i]) return false; // q is passed
        const std::uint32_t* v = solid_.tets[trail.across].v;
        put_corner(v[0] ^ v[1] ^ v[2] ^ v[3] ^ trail.gate, i, 0);
        trail.tet = trail.across;
        prefetch(topology_.across.place_of(trail.tet));
        return true;
    }

    // Sets where the line crosses the surface, if that is between p and q.
    void leave(std::size_t i, std::uint32_t triangle) {
        constexpr double rounding = 1e-9; // of the length of the segment
        Walk& walk = walks_[i];
        const double below = lanes_.below[i], t = lanes_.above[i] / below;
        walk.leaves = below > 0 && t >= -rounding && t <= 1 + rounding;
        walk.exit.triangle = triangle;
        walk.exit.point = walk.p + std::clamp(t, 0.0, 1.0) * (walk.q - walk.p);
        for (std::size_t c = 0; c < 3; ++c) {
            const double vertex = topology_.triangles[triangle].v[c];
            const auto k =
                (lanes_.corner[2][3][i] == vertex ? 1u : 0u) | (lanes_.corner[3][3][i] == vertex ? 2u : 0u);
            walk.exit.weight[c] = lanes_.weight[k][i] / below;
        }
    }

    const Solid& solid_;
    const Topology& topology_;
    std::span<Walk> walks_;
    Trail trails_[walk_group];
    WalkLanes lanes_;
};

} // namespace

void walk_out(const Solid& solid, std::span<Walk> walks) {
    for (; !walks.empty(); walks = walks.subspan(std::min(walk_group, walks.size())))
        WalkGroup(solid, walks.first(std::min(walk_group, walks.size()))).run();
}

bool walk_out(const Solid& solid, std::uint32_t tet, const Vec3d& p, const Vec3d& q, SurfacePoint& out,
              std::uint64_t& visited) {
    Walk walk{p, q, tet, false, 0, {}};
    walk_out(solid, std::span(&walk, 1));
    visited += walk.visited;
    if (walk.leaves) out = walk.exit;
    return walk.leaves;
}

} // namespace vox::depth
#endif
