// Decided by the signs of the volumes that the ends make with the triangle, and its sides with the segment
// (P. Guigue and O. Devillers, "Fast and Robust Triangle-Triangle Overlap Test Using Orientation Predicates",
// Journal of Graphics Tools 8, 2003). Coplanar input is projected along an axis that preserves its dimension.
// An area in the plane z = 0 is a volume of height 1 over it, so one predicate decides all.
#include "exact/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace vox {

namespace {

constexpr Vec3d apex{0, 0, 1}; // over the plane of projections

Vec3d projected(const Vec3d& p, int axis) {
    return axis == 0 ? Vec3d{p.y, p.z, 0} : axis == 1 ? Vec3d{p.z, p.x, 0} : Vec3d{p.x, p.y, 0};
}

bool same(const Vec3d& p, const Vec3d& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }

// Volumes up to a common factor; each is off by less than 2^-40 of the sum of their magnitudes. Not all are
// zero.
template <std::size_t Count>
std::array<double, Count> volumes_in_proportion(const VolumePoints& points,
                                                const std::array<VolumeCorners, Count>& of) {
    std::array<double, Count> volumes;
    double total = 0, error = 0;
    for (std::size_t i = 0; i < Count; ++i) {
        const BoundedVolume bounded =
            bounded_volume(points[of[i][0]], points[of[i][1]], points[of[i][2]], points[of[i][3]]);
        volumes[i] = bounded.volume;
        total += std::abs(bounded.volume);
        error = std::max(error, bounded.error);
    }
    if (!(static_cast<double>(Count + 1) * error < 0x1p-40 * total)) scaled_volumes(points, of, volumes);
    return volumes;
}

// Weights in proportion to volumes. Their signs are not all zero, and no two are opposite.
template <std::size_t Count>
std::array<double, Count> weights_of(const std::array<double, Count>& volumes, const int (&sign)[Count]) {
    std::array<double, Count> weights;
    double sum = 0;
    for (std::size_t i = 0; i < Count; ++i) {
        weights[i] = sign[i] == 0 ? 0 : std::max(sign[i] * volumes[i], 0.0);
        sum += weights[i];
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

Vec3d between(const Vec3d& p, const Vec3d& q, const std::array<double, 2>& weights) {
    if (weights[1] <= 0.5) return weights[1] == 0 ? p : p + weights[1] * (q - p);
    return weights[0] == 0 ? q : q + weights[0] * (p - q);
}

// ---- in one plane ---------------------------------------------------------------------------------

class InPlane {
public:
    InPlane(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c,
            std::uint64_t& exact_tests)
        : end_{p, q}, corner_{a, b, c}, exact_tests_(exact_tests) {}

    Crossing find() {
        Crossing found;
        for (int axis = 0; axis < 3; ++axis)
            if (const int winding = area(axis, corner_[0], corner_[1], corner_[2]); winding != 0) {
                if (holds(end_[0], axis, winding, found.face_weights)) return at_end(0, found);
                if (holds(end_[1], axis, winding, found.face_weights)) return at_end(1, found);
                break;
            }
        // Otherwise the segment meets a side, or nothing. A triangle without area is the union of its sides.
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            std::array<double, 2> side_weights{};
            if (!meets(corner_[i], corner_[j], found, side_weights)) continue;
            found.kind = CrossingKind::coplanar;
            found.face_weights = {};
            found.face_weights[i] = side_weights[0];
            found.face_weights[j] = side_weights[1];
            return found;
        }
        return found;
    }

private:
    int area(int axis, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        return orientation(projected(a, axis), projected(b, axis), projected(c, axis), apex, exact_tests_);
    }

    Crossing& at_end(std::size_t end, Crossing& found) const {
        found.kind = CrossingKind::coplanar;
        found.edge_weights = {end == 0 ? 1.0 : 0.0, end == 0 ? 0.0 : 1.0};
        found.position = end_[end];
        return found;
    }

    // True if the triangle contains p, a point of its plane. `winding` is the sign of its projected area.
    bool holds(const Vec3d& p, int axis, int winding, std::array<double, 3>& weights) {
        const auto& [a, b, c] = corner_;
        const int sign[3] = {area(axis, p, b, c), area(axis, a, p, c), area(axis, a, b, p)};
        if (std::min({sign[0] * winding, sign[1] * winding, sign[2] * winding}) < 0) return false;
        const VolumePoints points{
            projected(a, axis), projected(b, axis), projected(c, axis), projected(p, axis), apex, apex};
        weights =
            weights_of(volumes_in_proportion<3>(points, {{{3, 1, 2, 4}, {0, 3, 2, 4}, {0, 1, 3, 4}}}), sign);
        return true;
    }

    // True if x, which may be anywhere, is on the closed segment rs. Sets its weights.
    bool is_on(const Vec3d& x, const Vec3d& r, const Vec3d& s, std::array<double, 2>& weights) {
        const double at[3] = {x.x, x.y, x.z}, from[3] = {r.x, r.y, r.z}, to[3] = {s.x, s.y, s.z};
        int longest = 0;
        for (int i = 0; i < 3; ++i) {
            if (at[i] < std::min(from[i], to[i]) || at[i] > std::max(from[i], to[i])) return false;
            if (std::abs(to[i] - from[i]) > std::abs(to[longest] - from[longest])) longest = i;
        }
        for (int axis = 0; axis < 3; ++axis)
            if (area(axis, x, r, s) != 0) return false;
        if (same(x, r) || same(x, s)) {
            weights = {same(x, r) ? 1.0 : 0.0, same(x, r) ? 0.0 : 1.0};
            return true;
        }
        const double length = to[longest] - from[longest]; // rounded once, and so are its two parts
        weights = {(to[longest] - at[longest]) / length, (at[longest] - from[longest]) / length};
        return true;
    }

    // True if the segment meets the segment rs. Sets the edge's weights and the position, and the weights of
    // r and s.
    bool meets(const Vec3d& r, const Vec3d& s, Crossing& found, std::array<double, 2>& side) {
        const auto& [p, q] = end_;
        if (orientation(p, q, r, s, exact_tests_) != 0) return false;
        for (std::size_t end = 0; end < 2; ++end)
            if (is_on(end_[end], r, s, side)) {
                at_end(end, found);
                return true;
            }
        for (const Vec3d* corner : {&r, &s})
            if (is_on(*corner, p, q, found.edge_weights)) {
                side = {corner == &r ? 1.0 : 0.0, corner == &r ? 0.0 : 1.0};
                found.position = *corner;
                return true;
            }
        // No end of one is on the other. So they cross, or the four points are on one line and apart.
        for (int axis = 0; axis < 3; ++axis) {
            const int of_r = area(axis, p, q, r), of_s = area(axis, p, q, s);
            if (of_r == 0 && of_s == 0) continue; // seen along this axis they may be on one line
            const int of_p = area(axis, r, s, p), of_q = area(axis, r, s, q);
            if (of_r * of_s >= 0 || of_p * of_q >= 0) return false;
            const VolumePoints points{
                projected(p, axis), projected(q, axis), projected(r, axis), projected(s, axis), apex, apex};
            // Each point is as near as the area of the other one is large.
            found.edge_weights =
                weights_of(volumes_in_proportion<2>(points, {{{3, 2, 1, 4}, {2, 3, 0, 4}}}), {-of_q, of_p});
            side =
                weights_of(volumes_in_proportion<2>(points, {{{1, 0, 3, 4}, {0, 1, 2, 4}}}), {-of_s, of_r});
            found.position = between(p, q, found.edge_weights);
            return true;
        }
        return false;
    }

    std::array<Vec3d, 2> end_;
    std::array<Vec3d, 3> corner_;
    std::uint64_t& exact_tests_;
};

} // namespace

Crossing find_crossing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                       std::uint64_t& exact_tests) {
    Crossing found;
    const int of_p = orientation(a, b, c, p, exact_tests), of_q = orientation(a, b, c, q, exact_tests);
    if (of_p * of_q > 0) return found;
    if (of_p == 0 && of_q == 0) return InPlane(p, q, a, b, c, exact_tests).find();
    if (passes_beside(p, q, a, b, c)) return found;

    // The line meets the plane of the triangle, which has an area, in one point of the segment. It is in the
    // triangle when no two volumes over its sides have opposite signs.
    int of_side[3];
    bool positive = false, negative = false;
    for (int i = 0; i < 3; ++i) {
        of_side[i] = orientation(p, q, i == 0 ? b : i == 1 ? c : a, i == 0 ? c : i == 1 ? a : b, exact_tests);
        positive |= of_side[i] > 0;
        negative |= of_side[i] < 0;
        if (positive && negative) return found;
    }
    const bool is_inside = of_side[0] != 0 && of_side[1] != 0 && of_side[2] != 0;
    found.kind = is_inside && of_p * of_q < 0 ? CrossingKind::through : CrossingKind::touching;
    const VolumePoints points{p, q, a, b, c, c};
    found.edge_weights =
        weights_of(volumes_in_proportion<2>(points, {{{3, 2, 4, 1}, {2, 3, 4, 0}}}), {-of_q, of_p});
    found.face_weights =
        weights_of(volumes_in_proportion<3>(points, {{{0, 1, 3, 4}, {0, 1, 4, 2}, {0, 1, 2, 3}}}), of_side);
    found.position = between(p, q, found.edge_weights);
    for (std::size_t i = 0; i < 3; ++i) // two zeros: at the third corner
        if (of_side[(i + 1) % 3] == 0 && of_side[(i + 2) % 3] == 0) found.position = points[2 + i];
    return found;
}

} // namespace vox
