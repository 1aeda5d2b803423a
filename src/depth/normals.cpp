// The normal at a corner is the sum of the normals of the triangles around it, weighted by sin(angle) over
// the lengths of the two edges, which is exact for corners on a sphere (Max, "Weights for computing vertex
// normals from facet normals", Journal of Graphics Tools 4, 1999). Triangles whose normals are more than 60
// degrees from that of the triangle in question are left out, so that the faces of a box stay flat.
//
// Where all triangles around a corner are within 29 degrees of their mean, none of them leaves out another,
// and the sum is the same for each.
#include "depth/normals.hpp"

#include "base/vectors.hpp"

#include <algorithm>

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
    for (const Face& face : faces_) places_[face.triangle] = none;
    faces_.clear();
    solid_ = solid;
    const std::size_t triangles = solid.topology->triangles.size();
    if (triangles > places_.size()) places_.resize(triangles, none);
}

void Normals::add(std::uint32_t triangle) {
    if (places_[triangle] != none) return;
    const Triangle& t = solid_.topology->triangles[triangle];
    Face& face = faces_.emplace_back();
    face.triangle = triangle;
    std::copy_n(t.v, 3, face.v);
    places_[triangle] = static_cast<std::uint32_t>(faces_.size() - 1);
}

void Normals::prepare(std::span<const std::uint32_t> triangles) {
    const std::size_t first = faces_.size();
    for (const std::uint32_t triangle : triangles) add(triangle);
    for (const std::uint32_t triangle : triangles)
        for (int i = 0; i < 3; ++i)
            if (!face(triangle).has_corner[i])
                for (const std::uint32_t other : solid_.topology->ring_of(face(triangle).v[i])) add(other);
    for (std::size_t i = first; i < faces_.size(); ++i) compute_face(faces_[i]);
    for (const std::uint32_t triangle : triangles)
        for (int i = 0; i < 3; ++i)
            if (!face(triangle).has_corner[i]) compute_corner(face(triangle), i);
}

void Normals::compute_face(Face& face) const {
    const Vec3d a = solid_.at(face.v[0]), b = solid_.at(face.v[1]), c = solid_.at(face.v[2]);
    const Vec3d apex = solid_.at(solid_.topology->triangles[face.triangle].apex);
    const Vec3d ab = b - a, bc = c - b, ca = a - c;
    const Vec3d doubled = cross(ab, c - a);
    const double area = length(doubled);
    const double inside = dot(doubled, apex - a);
    face.is_flat = inside == 0;
    face.normal = normalised(inside > 0 ? -1.0 * doubled : doubled);
    // `area` is sin(angle) * e * f at each corner, with the lengths e and f of its edges.
    const double lab = dot(ab, ab), lbc = dot(bc, bc), lca = dot(ca, ca);
    const auto weight = [area](double e, double f) { return e > 0 && f > 0 ? area / e / f : 0; };
    face.weight[0] = weight(lab, lca);
    face.weight[1] = weight(lab, lbc);
    face.weight[2] = weight(lbc, lca);
}

void Normals::compute_corner(Face& asking, int i) {
    const std::uint32_t vertex = asking.v[i];
    const std::span<const std::uint32_t> ring = solid_.topology->ring_of(vertex);
    Vec3d sum{0, 0, 0};
    for (const std::uint32_t other : ring) {
        const Face& f = face(other);
        sum = sum + f.weight[f.corner_at(vertex)] * f.normal;
    }
    const Vec3d mean = normalised(sum);
    constexpr double close = 0.875; // the cosine of 29 degrees
    const bool is_smooth = std::all_of(ring.begin(), ring.end(), [&](std::uint32_t other) {
        const Face& f = face(other);
        return !f.is_flat && dot(f.normal, mean) > close;
    });
    if (is_smooth) {
        for (const std::uint32_t other : ring) {
            Face& f = face(other);
            const int at = f.corner_at(vertex);
            f.corner[at] = mean;
            f.has_corner[at] = true;
        }
        return;
    }
    constexpr double crease = 0.5; // the cosine of 60 degrees
    sum = {0, 0, 0};
    for (const std::uint32_t other : ring) {
        const Face& f = face(other);
        const double cosine = dot(f.normal, asking.normal);
        const bool turn = cosine < 0 && (f.is_flat || asking.is_flat);
        if ((turn ? -cosine : cosine) < crease) continue;
        const double weight = f.weight[f.corner_at(vertex)];
        sum = sum + (turn ? -weight : weight) * f.normal;
    }
    asking.corner[i] = normalised(sum);
    asking.has_corner[i] = true;
}

Vec3d Normals::at(const SurfacePoint& point, const Vec3d& outward) const {
    const Face& face = faces_[places_[point.triangle]];
    const Vec3d normal = normalised(point.weight[0] * face.corner[0] + point.weight[1] * face.corner[1] +
                                    point.weight[2] * face.corner[2]);
    return dot(face.normal, outward) < 0 ? -1.0 * normal : normal;
}

} // namespace vox::depth
