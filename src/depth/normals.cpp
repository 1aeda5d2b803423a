// The normal at a corner is the sum of the normals of the triangles around it, weighted by sin(angle) over
// the lengths of the two edges, which is exact for corners on a sphere (Max, "Weights for computing vertex
// normals from facet normals", Journal of Graphics Tools 4, 1999). Triangles whose normals are more than 60
// degrees from that of the triangle in question are left out, so that the faces of a box stay flat.
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
    solid_ = solid;
    reserve(solid.topology->triangles.size());
    if (++age_ == 0) { // after 2^32 calls
        std::fill(faces_.begin(), faces_.end(), Face{});
        age_ = 1;
    }
}

Normals::Face& Normals::face(std::uint32_t triangle) {
    Face& face = faces_[triangle];
    if (face.age == age_) return face;
    face.age = age_;
    face.has_corners = false;
    const auto [a, b, c] = solid_.corners(triangle);
    const Vec3d ab = b - a, bc = c - b, ca = a - c;
    const Vec3d doubled = cross(ab, c - a);
    const double area = length(doubled);
    const double inside = dot(doubled, solid_.at(solid_.topology->triangles[triangle].apex) - a);
    face.is_flat = inside == 0;
    face.normal = normalised(inside > 0 ? -1.0 * doubled : doubled);
    // `area` is sin(angle) * e * f at each corner, with the lengths e and f of its edges.
    const double lab = dot(ab, ab), lbc = dot(bc, bc), lca = dot(ca, ca);
    const auto weight = [area](double e, double f) { return e > 0 && f > 0 ? area / e / f : 0; };
    face.corner_weight[0] = weight(lab, lca);
    face.corner_weight[1] = weight(lab, lbc);
    face.corner_weight[2] = weight(lbc, lca);
    return face;
}

const Normals::Face& Normals::face_with_corners(std::uint32_t triangle) {
    constexpr double crease = 0.5; // the cosine of 60 degrees
    Face& asking = face(triangle);
    if (asking.has_corners) return asking;
    asking.has_corners = true;
    const Triangle& t = solid_.topology->triangles[triangle];
    for (int i = 0; i < 3; ++i) {
        Vec3d sum{0, 0, 0};
        for (const std::uint32_t other : solid_.topology->ring_of(t.v[i])) {
            const Face& f = face(other);
            const double cosine = dot(f.normal, asking.normal);
            const bool turn = cosine < 0 && (f.is_flat || asking.is_flat);
            if ((turn ? -cosine : cosine) < crease) continue;
            const std::uint32_t* v = solid_.topology->triangles[other].v;
            const double weight = f.corner_weight[v[0] == t.v[i] ? 0 : v[1] == t.v[i] ? 1 : 2];
            sum = sum + (turn ? -weight : weight) * f.normal;
        }
        asking.corner[i] = normalised(sum);
    }
    return asking;
}

Vec3d Normals::at(const SurfacePoint& point, const Vec3d& outward) {
    const Face& face = face_with_corners(point.triangle);
    const Vec3d normal = normalised(point.weight[0] * face.corner[0] + point.weight[1] * face.corner[1] +
                                    point.weight[2] * face.corner[2]);
    return dot(face.normal, outward) < 0 ? -1.0 * normal : normal;
}

} // namespace vox::depth
