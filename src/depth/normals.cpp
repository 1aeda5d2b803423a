// The normal at a corner is the sum of the normals of the triangles around it, weighted by sin(angle) over
// the lengths of the two edges, which is exact for corners on a sphere (Max, "Weights for computing vertex
// normals from facet normals", Journal of Graphics Tools 4, 1999). Triangles whose normals are more than 60
// degrees from that of the triangle in question are left out, so that the faces of a box stay flat.
//
// Where all triangles around a corner are within 29 degrees of their mean, none of them leaves out another,
// and the sum is the same for each.
#include "depth/normals.hpp"

#include "base/prefetch.hpp"
#include "base/simd.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>

#undef VOX_SOURCE
#define VOX_SOURCE "depth/normals.cpp"
#include "base/each_target.hpp"

#ifndef VOX_DEPTH_NORMALS_ONCE
#define VOX_DEPTH_NORMALS_ONCE
namespace vox::depth {

constexpr std::size_t face_lanes = 8;

// Triangles of a surface, one in each lane.
struct FaceBlock {
    alignas(64) double corner[4][3][face_lanes]; // the last one is the apex
    // What a Face holds; `inside` is 0 where the tetrahedron is flat.
    alignas(64) double normal[3][face_lanes], weight[3][face_lanes], inside[face_lanes];
};

} // namespace vox::depth
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::depth {
namespace HWY_NAMESPACE {
namespace normals { // other files of the folder have a Load, too

#if HWY_HAVE_FLOAT64
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, face_lanes>;
using D = hn::Vec<Doubles>;

HWY_INLINE std::size_t LaneCount() { return hn::Lanes(Doubles()); }
HWY_INLINE D Load(const double* from) { return hn::Load(Doubles(), from); }
HWY_INLINE void Store(D value, double* to) { hn::Store(value, Doubles(), to); }
HWY_INLINE D Number(double value) { return hn::Set(Doubles(), value); }
HWY_INLINE D Add(D a, D b) { return hn::Add(a, b); }
HWY_INLINE D Sub(D a, D b) { return hn::Sub(a, b); }
HWY_INLINE D Mul(D a, D b) { return hn::Mul(a, b); }
HWY_INLINE D Div(D a, D b) { return hn::Div(a, b); }
HWY_INLINE D Root(D a) { return hn::Sqrt(a); }
HWY_INLINE D SelectAbove(D a, D b, D yes, D no) { return hn::IfThenElse(hn::Gt(a, b), yes, no); }
#else // one lane, without registers of doubles
using D = double;

HWY_INLINE std::size_t LaneCount() { return 1; }
HWY_INLINE D Load(const double* from) { return *from; }
HWY_INLINE void Store(D value, double* to) { *to = value; }
HWY_INLINE D Number(double value) { return value; }
HWY_INLINE D Add(D a, D b) { return a + b; }
HWY_INLINE D Sub(D a, D b) { return a - b; }
HWY_INLINE D Mul(D a, D b) { return a * b; }
HWY_INLINE D Div(D a, D b) { return a / b; }
HWY_INLINE D Root(D a) { return std::sqrt(a); }
HWY_INLINE D SelectAbove(D a, D b, D yes, D no) { return a > b ? yes : no; }
#endif

HWY_INLINE D Dot(const D* a, const D* b) {
    return Add(Add(Mul(a[0], b[0]), Mul(a[1], b[1])), Mul(a[2], b[2]));
}
HWY_INLINE D Minor(const D* a, const D* b, int i, int j) { return Sub(Mul(a[i], b[j]), Mul(a[j], b[i])); }
// area / e / f, or 0 where e or f is.
HWY_INLINE D Weight(D area, D e, D f) {
    const D zero = Number(0);
    return SelectAbove(e, zero, SelectAbove(f, zero, Div(Div(area, e), f), zero), zero);
}

// Normals out of the tetrahedra, unit or zero, and their weights in the normals of the corners. Computes
// whole registers.
void ComputeFaces(FaceBlock& block) {
    for (std::size_t i = 0; i < face_lanes; i += LaneCount()) {
        D ab[3], bc[3], ca[3], ac[3], to_apex[3];
        for (int x = 0; x < 3; ++x) {
            const D a = Load(block.corner[0][x] + i), b = Load(block.corner[1][x] + i),
                    c = Load(block.corner[2][x] + i);
            ab[x] = Sub(b, a);
            bc[x] = Sub(c, b);
            ca[x] = Sub(a, c);
            ac[x] = Sub(c, a);
            to_apex[x] = Sub(Load(block.corner[3][x] + i), a);
        }
        const D zero = Number(0), minus = Number(-1);
        D normal[3] = {Minor(ab, ac, 1, 2), Minor(ab, ac, 2, 0), Minor(ab, ac, 0, 1)};
        const D area = Root(Dot(normal, normal)); // doubled
        const D inside = Dot(normal, to_apex);
        for (D& n : normal) n = SelectAbove(inside, zero, Mul(minus, n), n);
        const D squared = Dot(normal, normal), length = Root(squared);
        for (int x = 0; x < 3; ++x) // normalised() of base/vectors.hpp
            Store(SelectAbove(squared, Number(1e-290), Div(normal[x], length), zero), block.normal[x] + i);
        Store(inside, block.inside + i);
        // `area` is sin(angle) * e * f at each corner, with the lengths e and f of its edges.
        const D lab = Dot(ab, ab), lbc = Dot(bc, bc), lca = Dot(ca, ca);
        Store(Weight(area, lab, lca), block.weight[0] + i);
        Store(Weight(area, lab, lbc), block.weight[1] + i);
        Store(Weight(area, lbc, lca), block.weight[2] + i);
    }
}

} // namespace normals
using normals::ComputeFaces;

} // namespace HWY_NAMESPACE
} // namespace vox::depth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vox::depth {

Vec3d facet_normal(const Solid& solid, std::uint32_t tet, int i) {
    const std::uint32_t* v = solid.tets[tet].v;
    const auto& corner = facet_corners[i];
    const Vec3d a = solid.at(v[corner[0]]), b = solid.at(v[corner[1]]), c = solid.at(v[corner[2]]);
    const Vec3d normal = normalised(cross(b - a, c - a));
    if (!(length(normal) > 0)) return {0, 0, 1};
    return dot(normal, solid.at(v[i]) - a) > 0 ? -1.0 * normal : normal;
}

void Normals::begin(const Solid& solid) {
    solid_ = solid;
    face_places_.clear();
    ring_places_.clear();
    asked_places_.clear();
    faces_.clear();
    rings_.clear();
    ring_faces_.clear();
    asked_.clear();
}

// The place of a triangle in faces_.
std::uint32_t Normals::add_face(std::uint32_t triangle) {
    const std::uint32_t place = face_places_.add(triangle);
    if (place == faces_.size()) {
        const std::uint32_t* v = solid_.topology->triangles[triangle].v;
        faces_.push_back({{}, {}, {v[0], v[1], v[2]}, triangle});
    }
    return place;
}

void Normals::prepare(std::span<const std::uint32_t> triangles) {
    if (faces_.size() > most_faces) begin(solid_);
    const std::size_t first_face = faces_.size(), first_asked = asked_.size();
    for (const std::uint32_t triangle : triangles) {
        if (asked_places_.add(triangle) < asked_.size()) continue;
        Asked& asked = asked_.emplace_back();
        asked.face = add_face(triangle);
        for (const std::uint32_t v : faces_[asked.face].v) prefetch(solid_.topology->links.place_of(v));
    }
    if (first_asked == asked_.size()) return;
    list_rings(first_asked);
    compute_faces(first_face);
    for (std::size_t i = first_asked; i < asked_.size(); ++i) {
        Asked& asked = asked_[i];
        const Face& face = faces_[asked.face];
        for (std::size_t c = 0; c < 3; ++c)
            asked.normal[c] = corner_normal(face, face.v[c], rings_[asked.ring[c]]);
    }
}

// Those around the corners of triangles from `first_asked` on. These are anywhere in memory, so each pass
// prefetches what the next one reads.
void Normals::list_rings(std::size_t first_asked) {
    const Topology& topology = *solid_.topology;
    for (std::size_t i = first_asked; i < asked_.size(); ++i)
        for (const std::uint32_t v : faces_[asked_[i].face].v) {
            prefetch(topology.links.record_of(v));
            ring_places_.prefetch(v);
        }
    const std::size_t first_ring = rings_.size();
    for (std::size_t i = first_asked; i < asked_.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = faces_[asked_[i].face].v[c];
            asked_[i].ring[c] = ring_places_.add(v);
            if (asked_[i].ring[c] < rings_.size()) continue;
            const auto first = static_cast<std::uint32_t>(ring_faces_.size());
            for (const std::uint32_t triangle : topology.ring_of(v)) {
                ring_faces_.push_back(triangle); // its place comes later
                prefetch(&topology.triangles[triangle]);
                face_places_.prefetch(triangle);
            }
            rings_.push_back({first, static_cast<std::uint32_t>(ring_faces_.size()), false, false, {}});
        }
    if (first_ring == rings_.size()) return;
    for (std::size_t i = rings_[first_ring].first; i < ring_faces_.size(); ++i)
        ring_faces_[i] = add_face(ring_faces_[i]);
}

// Those from `first` on.
void Normals::compute_faces(std::size_t first) {
    const auto compute = VOX_SIMD_DISPATCH(ComputeFaces);
    FaceBlock block;
    for (; first < faces_.size(); first += face_lanes) {
        const std::size_t count = std::min(face_lanes, faces_.size() - first);
        for (std::size_t lane = 0; lane < face_lanes; ++lane) { // the last registers are filled up
            const Face& face = faces_[first + std::min(lane, count - 1)];
            const std::uint32_t apex = solid_.topology->triangles[face.triangle & ~Face::flat_bit].apex;
            const std::uint32_t v[4] = {face.v[0], face.v[1], face.v[2], apex};
            for (std::size_t c = 0; c < 4; ++c) {
                const Vec3d p = solid_.at(v[c]);
                block.corner[c][0][lane] = p.x;
                block.corner[c][1][lane] = p.y;
                block.corner[c][2][lane] = p.z;
            }
        }
        compute(block);
        for (std::size_t lane = 0; lane < count; ++lane) {
            Face& face = faces_[first + lane];
            face.normal = {block.normal[0][lane], block.normal[1][lane], block.normal[2][lane]};
            for (std::size_t c = 0; c < 3; ++c) face.weight[c] = block.weight[c][lane];
            if (block.inside[lane] == 0) face.triangle |= Face::flat_bit;
        }
    }
}

// The normal at a corner of the triangle `asking`.
Vec3d Normals::corner_normal(const Face& asking, std::uint32_t vertex, Ring& ring) const {
    if (ring.is_smooth) return ring.normal;
    constexpr double crease = 0.5; // the cosine of 60 degrees
    Vec3d sum{0, 0, 0};
    bool all = true; // take part, as they are
    for (std::uint32_t i = ring.first; i < ring.last; ++i) {
        const Face& f = faces_[ring_faces_[i]];
        const double cosine = dot(f.normal, asking.normal);
        const bool turn = cosine < 0 && (f.is_flat() || asking.is_flat());
        const bool close = (turn ? -cosine : cosine) >= crease;
        const double weight = f.weight_at(vertex);
        sum = sum + (!close ? 0.0 : turn ? -weight : weight) * f.normal;
        all &= close && !turn && !f.is_flat();
    }
    const Vec3d mean = normalised(sum);
    if (all && !ring.is_rough) {
        constexpr double near = 0.875; // the cosine of 29 degrees
        ring.is_smooth = true;
        for (std::uint32_t i = ring.first; i < ring.last; ++i)
            ring.is_smooth &= dot(faces_[ring_faces_[i]].normal, mean) > near;
        ring.is_rough = !ring.is_smooth;
        ring.normal = mean;
    }
    return mean;
}

Vec3d Normals::at(const SurfacePoint& point, const Vec3d& outward) {
    std::uint32_t place = asked_places_[point.triangle];
    if (place == PlaceMap::none) {
        prepare({&point.triangle, 1});
        place = asked_places_[point.triangle];
    }
    const Asked& asked = asked_[place];
    const Vec3d normal = normalised(point.weight[0] * asked.normal[0] + point.weight[1] * asked.normal[1] +
                                    point.weight[2] * asked.normal[2]);
    return dot(faces_[asked.face].normal, outward) < 0 ? -1.0 * normal : normal;
}

} // namespace vox::depth
#endif
