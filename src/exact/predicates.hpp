// Exact geometric decisions: orientation, and whether a point is in a closed tetrahedron. Coordinates are
// doubles (any float is one) of magnitude below 2^128. Every decision is that of infinite precision.
//
// The determinant is computed in double with the error bound A of ORIENT3D (Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", Discrete & Computational Geometry 18,
// 1997, Sect. 4.3). Where the bound does not decide, exact integers do (predicates.cpp).
//
// The bound assumes that no operation overflows or underflows. None overflows, since differences are below
// 2^129 and products of three below 2^387. Sums and differences do not underflow. A product that underflows
// is off by at most 2^-1075. The determinant has three minors of two products each, times a third factor of
// less than 2^129. If all of these products underflow, it is off by less than 2^-940; the summand 2^-900 of
// the bound covers that.
#pragma once

#include "base/device.hpp"
#include "base/vectors.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

// The sign (-1, 0, +1) of |p - q| - radius, decided exactly. The radius is not negative.
int side_of_sphere(const Vec3d& p, const Vec3d& q, double radius);

// The sign of orientation() by exact arithmetic.
int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

inline constexpr double underflow_error = 0x1p-900;

// A determinant in double and how far it may be from the true one.
struct BoundedVolume {
    double volume;
    double error; // at least underflow_error

    VOX_HD bool certain() const { return volume > error || -volume > error; }
};

// The orientation of points whose volume is not certain. Counts an exact test, unless the volume is
// recognised as zero without one.
int uncertain_orientation(const BoundedVolume& volume, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                          const Vec3d& d, std::uint64_t& exact_tests);

// The minor ux*vy - vx*uy and, for the error bound, |ux*vy| + |vx*uy|.
struct Minor {
    double value;
    double magnitude;
};

VOX_HD Minor minor(const Vec3d& u, const Vec3d& v) {
    const double left = u.x * v.y;
    const double right = v.x * u.y;
    return {left - right, std::abs(left) + std::abs(right)};
}

// det[u, v, w], expanded by the z coordinates, from the minors of the other two coordinates.
VOX_HD BoundedVolume determinant(double uz, const Minor& vw, double vz, const Minor& uw, double wz,
                                 const Minor& uv) {
    constexpr double epsilon = 0x1p-53;
    constexpr double bound = (7.0 + 56.0 * epsilon) * epsilon;
    const double permanent =
        std::abs(uz) * vw.magnitude + std::abs(vz) * uw.magnitude + std::abs(wz) * uv.magnitude;
    return {uz * vw.value - vz * uw.value + wz * uv.value, bound * permanent + underflow_error};
}

// det[b-a, c-a, d-a]
VOX_HD BoundedVolume bounded_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    const Vec3d u = b - a, v = c - a, w = d - a;
    return determinant(u.z, minor(v, w), v.z, minor(u, w), w.z, minor(u, v));
}

// The plane of a triangle abc, for many points d: bounded_volume(a, b, c, d), expanded by d - a in place of
// the z coordinates, with the minors of the other two rows computed once. A determinant stays the same when
// its matrix is transposed, so the bound is that of determinant().
struct TrianglePlane {
    Vec3d a;
    Minor x, y, z; // minors of b - a and c - a that leave out this coordinate

    TrianglePlane() = default;
    TrianglePlane(const Vec3d& corner_a, const Vec3d& b, const Vec3d& c) : a(corner_a) {
        const Vec3d u = b - a, v = c - a;
        x = minor({u.y, u.z, 0}, {v.y, v.z, 0});
        y = minor({u.z, u.x, 0}, {v.z, v.x, 0});
        z = minor(u, v);
    }

    BoundedVolume volume(const Vec3d& d) const {
        const Vec3d w = d - a;
        const Minor minus_y{-y.value, y.magnitude};
        return determinant(w.x, x, w.y, minus_y, w.z, z);
    }
    // True if p and q are certainly on the same side, and not on the plane.
    bool has_on_one_side(const Vec3d& p, const Vec3d& q) const {
        const BoundedVolume of_p = volume(p), of_q = volume(q);
        return (of_p.volume > of_p.error && of_q.volume > of_q.error) ||
               (-of_p.volume > of_p.error && -of_q.volume > of_q.error);
    }
};

// The sign (-1, 0, +1) of det[b-a, c-a, d-a]. It is positive when d is on the side of triangle abc to which
// its counter-clockwise normal points. `exact_tests` counts the calls that the error bound could not decide.
inline int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                       std::uint64_t& exact_tests) {
    const BoundedVolume det = bounded_volume(a, b, c, d);
    if (det.certain()) return det.volume > 0 ? 1 : -1;
    return uncertain_orientation(det, a, b, c, d, exact_tests);
}

// Volumes of quadruples of points, given by indices, times one power of two that makes the largest about 1.
// Each is rounded to double once, or 0 if it underflows.
inline constexpr std::size_t most_volume_points = 6;
using VolumePoints = std::array<Vec3d, most_volume_points>;
using VolumeCorners = std::array<std::uint8_t, 4>; // indices of the arguments of orientation()
void scaled_volumes(const VolumePoints& points, std::span<const VolumeCorners> of, std::span<double> volumes);

enum class Containment : std::uint8_t {
    outside,
    boundary, // on a face, an edge or a corner
    interior,
    degenerate // the tetrahedron has exactly zero volume and holds nothing
};

// Six times the volumes of abcd with one corner replaced by p. They add up to that of abcd; divided by it,
// they are the barycentric coordinates of p.
VOX_HD std::array<BoundedVolume, 4> corner_volumes(const Vec3d& p, const Vec3d& a, const Vec3d& b,
                                                   const Vec3d& c, const Vec3d& d) {
    const Vec3d u = a - p, v = b - p, w = c - p, x = d - p;
    const Minor uv = minor(u, v), uw = minor(u, w), ux = minor(u, x);
    const Minor vw = minor(v, w), vx = minor(v, x), wx = minor(w, x);
    std::array<BoundedVolume, 4> volumes = {
        determinant(v.z, wx, w.z, vx, x.z, vw), determinant(u.z, wx, w.z, ux, x.z, uw),
        determinant(u.z, vx, v.z, ux, x.z, uv), determinant(u.z, vw, v.z, uw, w.z, uv)};
    volumes[1].volume = -volumes[1].volume; // p is second and fourth, an odd number of row swaps from first
    volumes[3].volume = -volumes[3].volume;
    return volumes;
}

// Like locate(), but for a tetrahedron of non-zero volume, and from its corner volumes. These add up to its
// volume, so p is in the closed tetrahedron exactly if no two of them have opposite signs, for either
// winding. settle(volume, i) is the orientation for a volume that is not certain: of abcd with corner i
// replaced by p.
template <class Settle>
VOX_HD Containment locate_in_solid(const std::array<BoundedVolume, 4>& volumes, const Vec3d& p,
                                   const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                                   Settle& settle) {
    int above = 0, below = 0;
    for (const BoundedVolume& v : volumes) {
        above += v.volume > v.error;
        below += -v.volume > v.error;
    }
    bool positive = above > 0, negative = below > 0, zero = false;
    if (positive && negative) return Containment::outside; // decided without exact arithmetic
    // At a corner, the three volumes that contain the corner are exactly zero, and the certain one is the
    // fourth.
    const auto is_p = [&p](const Vec3d& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
    if (above + below == 1 && (is_p(a) || is_p(b) || is_p(c) || is_p(d))) return Containment::boundary;
    for (int i = 0; i < 4; ++i) {
        if (volumes[std::size_t(i)].certain()) continue;
        const int sign = settle(volumes[std::size_t(i)], i);
        positive |= sign > 0;
        negative |= sign < 0;
        zero |= sign == 0;
        if (positive && negative) return Containment::outside;
    }
    if (!positive && !negative) return Containment::degenerate;
    return zero ? Containment::boundary : Containment::interior;
}

// Where p lies with respect to the closed tetrahedron abcd, of either winding. settle(volume, 4) is the
// orientation of abcd.
template <class Settle>
VOX_HD Containment locate_by(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                             Settle& settle) {
    const Containment in_solid = locate_in_solid(corner_volumes(p, a, b, c, d), p, a, b, c, d, settle);
    if (in_solid != Containment::outside) return in_solid;
    const BoundedVolume volume = bounded_volume(a, b, c, d);
    if (volume.certain() || settle(volume, 4) != 0) return Containment::outside;
    return Containment::degenerate; // four volumes of both signs that cancel
}

#if !defined(__CUDACC__)
// Settles what is not certain by uncertain_orientation().
struct CountedSettling {
    const Vec3d &p, &a, &b, &c, &d;
    std::uint64_t& exact_tests;

    int operator()(const BoundedVolume& volume, int i) {
        return uncertain_orientation(volume, i == 0 ? p : a, i == 1 ? p : b, i == 2 ? p : c, i == 3 ? p : d,
                                     exact_tests);
    }
};

inline Containment locate_in_solid(const std::array<BoundedVolume, 4>& volumes, const Vec3d& p,
                                   const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                                   std::uint64_t& exact_tests) {
    CountedSettling settle{p, a, b, c, d, exact_tests};
    return locate_in_solid(volumes, p, a, b, c, d, settle);
}

inline Containment locate_in_solid(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                   const Vec3d& d, std::uint64_t& exact_tests) {
    return locate_in_solid(corner_volumes(p, a, b, c, d), p, a, b, c, d, exact_tests);
}

inline Containment locate(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                          std::uint64_t& exact_tests) {
    CountedSettling settle{p, a, b, c, d, exact_tests};
    return locate_by(p, a, b, c, d, settle);
}
#endif

// Barycentric coordinates of any point, each rounded to double once. Slow: see exact/accurate.hpp.
std::array<double, 4> exact_weights(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                    const Vec3d& d);

// (b-a) x (c-a) times a power of two that makes its largest coordinate about 1, each rounded to double once.
Vec3d exact_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Where the segment crosses the plane of abc, from 0 to 1, rounded once. One of its ends may be on the plane.
double exact_crossing(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b, const Vec3d& c);

} // namespace vox
