// The arithmetic of walk.cpp, operation by operation, for several segments at once, so that the bits are the
// same. Registers take the place of branches that would be mispredicted, and loads of different segments
// wait for memory at the same time. What has an index in it (which tetrahedron, which facet) is plain code.
#include "depth/walks.hpp"

#include "base/prefetch.hpp"
#include "base/simd.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#undef VOX_SOURCE
#define VOX_SOURCE "depth/walks.cpp"
#include "base/each_target.hpp"

#ifndef VOX_DEPTH_WALKS_ONCE
#define VOX_DEPTH_WALKS_ONCE
namespace vox::depth {

constexpr std::size_t walk_lanes = 8;

// Coordinates and numbers of vertices, one in each lane.
struct LaneCorners {
    alignas(64) double at[3][walk_lanes];
    alignas(64) std::uint64_t vertex[walk_lanes];
};

// The state of as many walks as there are lanes; the words are those of walk.cpp.
struct WalkBlock {
    // Segments: where they begin, and the way to their ends.
    alignas(64) double origin[3][walk_lanes], way[3][walk_lanes];
    LaneCorners corner[4]; // of the first tetrahedra; later corner[0] is the apex of the next one
    // Frames. `axis` is that of z.
    alignas(64) double axis[walk_lanes], dz[walk_lanes], shear_x[walk_lanes], shear_y[walk_lanes];
    LaneCorners gate[3];
    alignas(64) std::uint64_t behind[walk_lanes];
    // Where segments cross their gates.
    alignas(64) double weight[3][walk_lanes], point[3][walk_lanes];
};

// A bit for each lane.
struct LaneBits {
    std::uint32_t found;  // a gate
    std::uint32_t passed; // the segment ends before the gate
};

} // namespace vox::depth
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::depth {
namespace HWY_NAMESPACE {
namespace walks { // other files of the folder have a Load, too

#if HWY_HAVE_FLOAT64

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, walk_lanes>;
using Numbers = hn::RebindToSigned<Doubles>;
using D = hn::Vec<Doubles>;
using M = hn::Mask<Doubles>;

struct Corner {
    D x, y, z;
    D vertex; // the bits of an integer
};

HWY_INLINE D Load(const double* from) { return hn::Load(Doubles(), from); }
HWY_INLINE D LoadNumber(const std::uint64_t* from) {
    return hn::BitCast(Doubles(), hn::Load(hn::RebindToUnsigned<Doubles>(), from));
}
HWY_INLINE void StoreNumber(D number, std::uint64_t* to) {
    hn::Store(hn::BitCast(hn::RebindToUnsigned<Doubles>(), number), hn::RebindToUnsigned<Doubles>(), to);
}
HWY_INLINE Corner LoadCorner(const LaneCorners& from, std::size_t i) {
    return {Load(from.at[0] + i), Load(from.at[1] + i), Load(from.at[2] + i), LoadNumber(from.vertex + i)};
}
HWY_INLINE void StoreCorner(const Corner& corner, LaneCorners& to, std::size_t i) {
    hn::Store(corner.x, Doubles(), to.at[0] + i);
    hn::Store(corner.y, Doubles(), to.at[1] + i);
    hn::Store(corner.z, Doubles(), to.at[2] + i);
    StoreNumber(corner.vertex, to.vertex + i);
}
HWY_INLINE Corner Select(M mask, const Corner& yes, const Corner& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z), hn::IfThenElse(mask, yes.vertex, no.vertex)};
}
HWY_INLINE std::uint32_t Bits(M mask, std::size_t i) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Doubles(), mask, bits);
    return std::uint32_t{bits[0]} << i;
}

// Frame of walk.cpp.
struct Frame {
    D origin[3], dz, shear_x, shear_y;
    M z_is_0, z_is_1;

    HWY_INLINE Frame() {} // one that gcc makes by itself is not for these instructions: on Arm an error

    // Coordinates in the order of the frame's axes.
    HWY_INLINE void Turn(const D* v, D& x, D& y, D& z) const {
        x = hn::IfThenElse(z_is_0, v[1], hn::IfThenElse(z_is_1, v[2], v[0]));
        y = hn::IfThenElse(z_is_0, v[2], hn::IfThenElse(z_is_1, v[0], v[1]));
        z = hn::IfThenElse(z_is_0, v[0], hn::IfThenElse(z_is_1, v[1], v[2]));
    }
    HWY_INLINE Corner operator()(const LaneCorners& corner, std::size_t i) const {
        D from_p[3], x, y, z;
        for (int a = 0; a < 3; ++a) from_p[a] = hn::Sub(Load(corner.at[a] + i), origin[a]);
        Turn(from_p, x, y, z);
        return {hn::Sub(x, hn::Mul(shear_x, z)), hn::Sub(y, hn::Mul(shear_y, z)), hn::Div(z, dz),
                LoadNumber(corner.vertex + i)};
    }
};

HWY_INLINE Frame MakeFrame(WalkBlock& block, std::size_t i) {
    const Doubles d;
    Frame frame;
    D way[3];
    for (int a = 0; a < 3; ++a) {
        way[a] = Load(block.way[a] + i);
        frame.origin[a] = Load(block.origin[a] + i);
    }
    const M more_1 = hn::Gt(hn::Abs(way[1]), hn::Abs(way[0]));
    const M more_2 = hn::Gt(hn::Abs(way[2]), hn::Abs(hn::IfThenElse(more_1, way[1], way[0])));
    frame.z_is_0 = hn::Not(hn::Or(more_1, more_2));
    frame.z_is_1 = hn::AndNot(more_2, more_1);
    D x, y;
    frame.Turn(way, x, y, frame.dz);
    frame.shear_x = hn::Div(x, frame.dz);
    frame.shear_y = hn::Div(y, frame.dz);
    const D axis = hn::IfThenElse(more_2, hn::Set(d, 2.0), hn::IfThenElseZero(more_1, hn::Set(d, 1.0)));
    hn::Store(axis, d, block.axis + i);
    hn::Store(frame.dz, d, block.dz + i);
    hn::Store(frame.shear_x, d, block.shear_x + i);
    hn::Store(frame.shear_y, d, block.shear_y + i);
    return frame;
}

HWY_INLINE Frame LoadFrame(const WalkBlock& block, std::size_t i) {
    const D axis = Load(block.axis + i);
    Frame frame;
    for (int a = 0; a < 3; ++a) frame.origin[a] = Load(block.origin[a] + i);
    frame.dz = Load(block.dz + i);
    frame.shear_x = Load(block.shear_x + i);
    frame.shear_y = Load(block.shear_y + i);
    frame.z_is_0 = hn::Eq(axis, hn::Zero(Doubles()));
    frame.z_is_1 = hn::Eq(axis, hn::Set(Doubles(), 1.0));
    return frame;
}

// area() both ways; each is the negative of the other but for the sign of zero.
struct Areas {
    D ab, ba;
};
HWY_INLINE Areas AreasOf(const Corner& a, const Corner& b) {
    const D first = hn::Mul(a.x, b.y), second = hn::Mul(b.x, a.y);
    return {hn::Sub(first, second), hn::Sub(second, first)};
}
HWY_INLINE D Area(const Corner& a, const Corner& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y)); }

// left() where the origin is on the edge.
HWY_INLINE M LeftOfEdge(const Corner& a, const Corner& b) {
    const Numbers di;
    const M same_x = hn::Eq(a.x, b.x), same_y = hn::Eq(a.y, b.y);
    const M before = hn::RebindMask(Doubles(), hn::Lt(hn::BitCast(di, a.vertex), hn::BitCast(di, b.vertex)));
    const M by_x = hn::Or(hn::AndNot(same_x, hn::Lt(a.x, b.x)), hn::And(same_x, before));
    return hn::Or(hn::AndNot(same_y, hn::Gt(a.y, b.y)), hn::And(same_y, by_x));
}
HWY_INLINE M Left(const Corner& a, const Corner& b, D twice) {
    const D zero = hn::Zero(Doubles());
    const M left = hn::Gt(twice, zero), on = hn::Eq(twice, zero);
    if (HWY_LIKELY(hn::AllFalse(Doubles(), on))) return left;
    return hn::Or(left, hn::And(on, LeftOfEdge(a, b)));
}

// An edge of the first tetrahedron, from both sides.
struct Edge {
    Areas area;
    M ab, ba; // left()
};
HWY_INLINE Edge EdgeOf(const Corner& a, const Corner& b) {
    const Areas area = AreasOf(a, b);
    return {area, Left(a, b, area.ab), Left(b, a, area.ba)};
}
HWY_INLINE Edge Reversed(const Edge& edge) { return {{edge.area.ba, edge.area.ab}, edge.ba, edge.ab}; }

HWY_INLINE D Height(D weight_a, D a, D weight_b, D b, D weight_c, D c) {
    return hn::Add(hn::Add(hn::Mul(weight_a, a), hn::Mul(weight_b, b)), hn::Mul(weight_c, c));
}
HWY_INLINE D Max3(D a, D b, D c) { // std::max, which keeps the first of equals
    const D ab = hn::IfThenElse(hn::Lt(a, b), b, a);
    return hn::IfThenElse(hn::Lt(ab, c), c, ab);
}

// The gate found so far by first_gate().
struct FarthestGate {
    M found, swapped, passed;
    D z, facet;
};
HWY_INLINE void TryFacet(double facet, D az, D bz, D cz, const Edge& ab, const Edge& bc, const Edge& ca,
                         FarthestGate& best) {
    const Doubles d;
    const M is_gate = hn::Not(hn::Or(hn::Xor(ab.ab, bc.ab), hn::Xor(ab.ab, ca.ab)));
    const M swap = hn::Not(ab.ab);
    const D weight_a = hn::IfThenElse(swap, bc.area.ba, bc.area.ab);
    const D weight_b = hn::IfThenElse(swap, ab.area.ba, ca.area.ab);
    const D weight_c = hn::IfThenElse(swap, ca.area.ba, ab.area.ab);
    const D above =
        Height(weight_a, az, weight_b, hn::IfThenElse(swap, cz, bz), weight_c, hn::IfThenElse(swap, bz, cz));
    const D below = hn::Add(hn::Add(weight_a, weight_b), weight_c);
    const D z = hn::IfThenElse(hn::Gt(below, hn::Zero(d)), hn::Div(above, below), Max3(az, bz, cz));
    const M take = hn::AndNot(hn::And(best.found, hn::Le(z, best.z)), is_gate);
    best.found = hn::Or(best.found, take);
    best.z = hn::IfThenElse(take, z, best.z);
    best.facet = hn::IfThenElse(take, hn::Set(d, facet), best.facet);
    best.swapped = hn::Or(hn::And(take, swap), hn::AndNot(take, best.swapped));
    best.passed = hn::Or(hn::And(take, hn::Gt(above, below)), hn::AndNot(take, best.passed));
}

// first_gate(), and whether segments end before it. Lanes whose segments have no length find none.
LaneBits FirstGates(WalkBlock& block) {
    const Doubles d;
    LaneBits bits{0, 0};
    for (std::size_t i = 0; i < walk_lanes; i += hn::Lanes(d)) {
        const Frame frame = MakeFrame(block, i);
        const Corner c0 = frame(block.corner[0], i), c1 = frame(block.corner[1], i),
                     c2 = frame(block.corner[2], i), c3 = frame(block.corner[3], i);
        const Edge e01 = EdgeOf(c0, c1), e02 = EdgeOf(c0, c2), e03 = EdgeOf(c0, c3);
        const Edge e12 = EdgeOf(c1, c2), e13 = EdgeOf(c1, c3), e23 = EdgeOf(c2, c3);
        const M none = hn::FirstN(d, 0);
        FarthestGate best{none, none, none, hn::Zero(d), hn::Zero(d)};
        // The facets of facet_corners.
        TryFacet(0, c1.z, c2.z, c3.z, e12, e23, Reversed(e13), best);
        TryFacet(1, c0.z, c3.z, c2.z, e03, Reversed(e23), Reversed(e02), best);
        TryFacet(2, c0.z, c1.z, c3.z, e01, e13, Reversed(e03), best);
        TryFacet(3, c0.z, c2.z, c1.z, e02, Reversed(e12), Reversed(e01), best);
        const M is_0 = hn::Eq(best.facet, hn::Zero(d)), is_1 = hn::Eq(best.facet, hn::Set(d, 1.0)),
                is_2 = hn::Eq(best.facet, hn::Set(d, 2.0)), is_3 = hn::Eq(best.facet, hn::Set(d, 3.0));
        const Corner b = Select(is_1, c3, Select(is_2, c1, c2));
        const Corner c = Select(is_1, c2, Select(is_3, c1, c3));
        StoreCorner(Select(is_0, c1, c0), block.gate[0], i);
        StoreCorner(Select(best.swapped, c, b), block.gate[1], i);
        StoreCorner(Select(best.swapped, b, c), block.gate[2], i);
        StoreNumber(
            hn::IfThenElse(is_0, c0.vertex,
                           hn::IfThenElse(is_1, c1.vertex, hn::IfThenElse(is_2, c2.vertex, c3.vertex))),
            block.behind + i);
        bits.found |= Bits(hn::AndNot(hn::Eq(frame.dz, hn::Zero(d)), best.found), i);
        bits.passed |= Bits(best.passed, i);
    }
    return bits;
}

// next_gate() for the lanes that are `active`, whose apex is corner[0], and whether segments end before it.
LaneBits NextGates(WalkBlock& block, std::uint32_t active) {
    const Doubles d;
    LaneBits bits{0, 0};
    for (std::size_t i = 0; i < walk_lanes; i += hn::Lanes(d)) {
        const std::uint8_t lanes[8] = {static_cast<std::uint8_t>(active >> i)};
        const M is_active = hn::LoadMaskBits(d, lanes);
        const Corner apex = LoadFrame(block, i)(block.corner[0], i);
        const Corner in_a = LoadCorner(block.gate[0], i), in_b = LoadCorner(block.gate[1], i),
                     in_c = LoadCorner(block.gate[2], i);
        const M a = Left(apex, in_a, Area(apex, in_a)), b = Left(apex, in_b, Area(apex, in_b)),
                c = Left(apex, in_c, Area(apex, in_c));
        const M through_ab = hn::AndNot(b, a), through_bc = hn::AndNot(c, b);
        const M through_ca = hn::AndNot(a, c);
        const M found = hn::And(is_active, hn::Or(through_ab, hn::Or(through_bc, through_ca)));
        const Corner out_b = Select(through_ab, in_a, Select(through_bc, in_b, in_c));
        const Corner out_c = Select(through_ab, in_b, Select(through_bc, in_c, in_a));
        const D behind =
            hn::IfThenElse(through_ab, in_c.vertex, hn::IfThenElse(through_bc, in_a.vertex, in_b.vertex));
        StoreCorner(Select(found, apex, in_a), block.gate[0], i);
        StoreCorner(Select(found, out_b, in_b), block.gate[1], i);
        StoreCorner(Select(found, out_c, in_c), block.gate[2], i);
        StoreNumber(hn::IfThenElse(found, behind, LoadNumber(block.behind + i)), block.behind + i);
        const D weight_a = Area(out_b, out_c), weight_b = Area(out_c, apex), weight_c = Area(apex, out_b);
        const D above = Height(weight_a, apex.z, weight_b, out_b.z, weight_c, out_c.z);
        const D below = hn::Add(hn::Add(weight_a, weight_b), weight_c);
        bits.found |= Bits(found, i);
        bits.passed |= Bits(hn::Gt(above, below), i);
    }
    return bits;
}

// The arithmetic of cross_surface(). Returns a bit for each lane whose segment crosses its gate; the weights
// are those of the corners of the gate.
std::uint32_t CrossGates(WalkBlock& block) {
    const Doubles d;
    constexpr double rounding = 1e-9; // as in cross_surface()
    const D zero = hn::Zero(d), one = hn::Set(d, 1.0);
    std::uint32_t crossed = 0;
    for (std::size_t i = 0; i < walk_lanes; i += hn::Lanes(d)) {
        const Corner a = LoadCorner(block.gate[0], i), b = LoadCorner(block.gate[1], i),
                     c = LoadCorner(block.gate[2], i);
        const D weight_a = Area(b, c), weight_b = Area(c, a), weight_c = Area(a, b);
        const D below = hn::Add(hn::Add(weight_a, weight_b), weight_c);
        const D t = hn::Div(Height(weight_a, a.z, weight_b, b.z, weight_c, c.z), below);
        const M from_p = hn::And(hn::Gt(below, zero), hn::Ge(t, hn::Set(d, -rounding)));
        crossed |= Bits(hn::AndNot(hn::Gt(t, hn::Set(d, 1 + rounding)), from_p), i);
        const D on_segment = hn::IfThenElse(hn::Lt(t, zero), zero, hn::IfThenElse(hn::Lt(one, t), one, t));
        hn::Store(hn::Div(weight_a, below), d, block.weight[0] + i);
        hn::Store(hn::Div(weight_b, below), d, block.weight[1] + i);
        hn::Store(hn::Div(weight_c, below), d, block.weight[2] + i);
        for (int axis = 0; axis < 3; ++axis)
            hn::Store(hn::Add(Load(block.origin[axis] + i), hn::Mul(on_segment, Load(block.way[axis] + i))),
                      d, block.point[axis] + i);
    }
    return crossed;
}

#else // without registers of doubles, walk_out() takes the segments one by one

LaneBits FirstGates(WalkBlock&) { return {0, 0}; }
LaneBits NextGates(WalkBlock&, std::uint32_t) { return {0, 0}; }
std::uint32_t CrossGates(WalkBlock&) { return 0; }

#endif

bool HasDoubles() { return HWY_HAVE_FLOAT64 != 0; }

} // namespace walks
using walks::CrossGates;
using walks::FirstGates;
using walks::HasDoubles;
using walks::NextGates;

} // namespace HWY_NAMESPACE
} // namespace vox::depth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::depth {

namespace {

void set_lane(double (&to)[3][walk_lanes], std::size_t lane, const Vec3d& from) {
    to[0][lane] = from.x;
    to[1][lane] = from.y;
    to[2][lane] = from.z;
}
void set_lane(LaneCorners& to, std::size_t lane, const Solid& solid, std::uint32_t vertex) {
    set_lane(to.at, lane, solid.at(vertex));
    to.vertex[lane] = vertex;
}

// Calls visit(i) for each bit i that is set.
template <class Visit>
void for_each_bit(std::uint64_t bits, Visit&& visit) {
    for (; bits; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

// Walks that are made together, so that all wait for memory at the same time: each pass over them prefetches
// what the next one reads.
class WalkGroup {
public:
    static constexpr std::size_t size = 64;

    WalkGroup(const Solid& solid, std::span<Walk> walks)
        : solid_(solid), topology_(*solid.topology), walks_(walks) {
        for (const Walk& walk : walks_) prefetch_start(walk.tet);
        for (std::size_t i = 0; i < walks_.size(); ++i) begin(i);
        // Whole registers are computed, so the last one is filled up.
        for (std::size_t i = walks_.size(); i % walk_lanes; ++i) set_segment(i, walks_.back());
    }

    void run() {
        const auto first_gates = VOX_SIMD_DISPATCH(FirstGates);
        const auto next_gates = VOX_SIMD_DISPATCH(NextGates);
        const auto cross_gates = VOX_SIMD_DISPATCH(CrossGates);
        const std::size_t blocks = (walks_.size() + walk_lanes - 1) / walk_lanes;
        std::uint64_t active = 0;
        const auto take = [&](std::size_t b, const LaneBits& gates) {
            active |= std::uint64_t{gates.found} << b * walk_lanes;
            passed_ |= std::uint64_t{gates.passed} << b * walk_lanes;
        };
        for (std::size_t b = 0; b < blocks; ++b) take(b, first_gates(block_[b]));
        active &= ~std::uint64_t{0} >> (size - walks_.size());
        while (active) {
            for_each_bit(active, [&](std::size_t i) { look_across(i); });
            std::uint64_t going_on = 0;
            for_each_bit(active, [&](std::size_t i) { going_on |= std::uint64_t{go_across(i)} << i; });
            active = passed_ = 0;
            for (std::size_t b = 0; b < blocks; ++b)
                if (const auto lanes = static_cast<std::uint8_t>(going_on >> b * walk_lanes))
                    take(b, next_gates(block_[b], lanes));
        }
        for (std::size_t b = 0; b < blocks; ++b)
            if (const auto lanes = static_cast<std::uint8_t>(leaving_ >> b * walk_lanes))
                for_each_bit(lanes & cross_gates(block_[b]), [&](std::size_t i) { leave(b, i); });
    }

private:
    // Where a walk is, and where it was, to find out whether it goes round (walk.cpp).
    struct Trail {
        std::uint32_t tet, remembered_tet;
        std::uint32_t behind, remembered_behind; // vertices
        std::uint32_t across;
        std::uint64_t remember_at;
    };

    void prefetch_start(std::uint32_t tet) const {
        prefetch(&solid_.tets[tet]);
        prefetch(topology_.across.place_of(tet));
    }

    void set_segment(std::size_t i, const Walk& walk) {
        WalkBlock& block = block_[i / walk_lanes];
        const std::size_t lane = i % walk_lanes;
        set_lane(block.origin, lane, walk.p);
        set_lane(block.way, lane, walk.q - walk.p);
        const Tet& tet = solid_.tets[walk.tet];
        for (std::size_t c = 0; c < 4; ++c) set_lane(block.corner[c], lane, solid_, tet.v[c]);
    }

    void begin(std::size_t i) {
        Walk& walk = walks_[i];
        walk.leaves = false;
        walk.visited = 0;
        set_segment(i, walk);
        trail_[i] = {walk.tet, ~0u, 0, 0, 0, 1};
    }

    void look_across(std::size_t i) {
        Trail& trail = trail_[i];
        const auto behind = static_cast<std::uint32_t>(block_[i / walk_lanes].behind[i % walk_lanes]);
        const std::uint32_t* v = solid_.tets[trail.tet].v;
        // Without branches, which would be mispredicted.
        const auto facet =
            (v[1] == behind ? 1u : 0u) | (v[2] == behind ? 2u : 0u) | (v[3] == behind ? 3u : 0u);
        trail.behind = behind;
        trail.across = topology_.across(trail.tet, facet);
        if (trail.across & Topology::surface_bit)
            prefetch(topology_.triangles.data() + (trail.across & ~Topology::surface_bit));
        else
            prefetch(&solid_.tets[trail.across]);
    }

    // Whether the walk goes on in the tetrahedron across the gate.
    bool go_across(std::size_t i) {
        Trail& trail = trail_[i];
        Walk& walk = walks_[i];
        ++walk.visited;
        if (trail.tet == trail.remembered_tet && trail.behind == trail.remembered_behind) return false;
        if (walk.visited == trail.remember_at) {
            trail.remembered_tet = trail.tet;
            trail.remembered_behind = trail.behind;
            trail.remember_at *= 2;
        }
        if (trail.across == Topology::nothing) return false;
        if (trail.across & Topology::surface_bit) {
            walk.exit.triangle = trail.across & ~Topology::surface_bit;
            leaving_ |= std::uint64_t{1} << i;
            return false;
        }
        if (passed_ >> i & 1) return false;
        WalkBlock& block = block_[i / walk_lanes];
        const std::size_t lane = i % walk_lanes;
        const std::uint32_t* v = solid_.tets[trail.across].v;
        const auto gate = static_cast<std::uint32_t>(block.gate[0].vertex[lane] ^ block.gate[1].vertex[lane] ^
                                                     block.gate[2].vertex[lane]);
        set_lane(block.corner[0], lane, solid_, v[0] ^ v[1] ^ v[2] ^ v[3] ^ gate);
        trail.tet = trail.across;
        prefetch(topology_.across.place_of(trail.tet));
        return true;
    }

    void leave(std::size_t b, std::size_t lane) {
        const WalkBlock& block = block_[b];
        Walk& walk = walks_[b * walk_lanes + lane];
        walk.leaves = true;
        walk.exit.point = {block.point[0][lane], block.point[1][lane], block.point[2][lane]};
        const std::uint32_t* v = topology_.triangles[walk.exit.triangle].v;
        for (std::size_t corner = 0; corner < 3; ++corner) { // without branches, as above
            const auto k = (block.gate[1].vertex[lane] == v[corner] ? 1u : 0u) |
                           (block.gate[2].vertex[lane] == v[corner] ? 2u : 0u);
            walk.exit.weight[corner] = block.weight[k][lane];
        }
    }

    const Solid& solid_;
    const Topology& topology_;
    std::span<Walk> walks_;
    std::uint64_t leaving_ = 0, passed_ = 0; // bits of walks at the surface, and of those that end before
                                             // their gate
    Trail trail_[size];
    WalkBlock block_[size / walk_lanes];
};

} // namespace

void walk_out(const Solid& solid, std::span<Walk> walks) {
    if (!VOX_SIMD_DISPATCH(HasDoubles)()) {
        for (Walk& walk : walks) {
            walk.visited = 0;
            walk.leaves = walk_out(solid, walk.tet, walk.p, walk.q, walk.exit, walk.visited);
        }
        return;
    }
    for (std::size_t first = 0; first < walks.size(); first += WalkGroup::size)
        WalkGroup(solid, walks.subspan(first, std::min(WalkGroup::size, walks.size() - first))).run();
}

} // namespace vox::depth
#endif
