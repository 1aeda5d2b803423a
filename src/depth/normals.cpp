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
    for (const Face& face : faces_) places_[face.triangle & ~flat_bit] = none;
    faces_.clear();
    corners_.clear();
    known_.clear();
    solid_ = solid;
    const std::size_t triangles = solid.topology->triangles.size();
    if (triangles > places_.size()) places_.resize(triangles, none);
}

// The place of a triangle in faces_.
std::uint32_t Normals::add(std::uint32_t triangle) {
    std::uint32_t place = places_[triangle];
    if (place != none) return place;
    place = static_cast<std::uint32_t>(faces_.size());
    const std::uint32_t* v = solid_.topology->triangles[triangle].v;
    faces_.push_back({{}, {}, {v[0], v[1], v[2]}, triangle});
    places_[triangle] = place;
    return place;
}

void Normals::prepare(std::span<const std::uint32_t> triangles) {
    const std::size_t first = known_.size();
    for (const std::uint32_t triangle : triangles) {
        const std::uint32_t place = add(triangle);
        if (place < first && known_[place] == all_corners) continue;
        for (const std::uint32_t v : solid_.topology->triangles[triangle].v)
            for (const std::uint32_t other : solid_.topology->ring_of(v)) add(other);
    }
    corners_.resize(faces_.size());
    known_.resize(faces_.size(), 0);
    for (std::size_t i = first; i < faces_.size(); ++i) compute_face(faces_[i]);
    for (const std::uint32_t triangle : triangles) {
        const std::uint32_t place = places_[triangle];
        for (std::size_t i = 0; i < 3 && known_[place] != all_corners; ++i)
            if (!(known_[place] >> i & 1)) compute_corner(place, i);
    }
}

void Normals::compute_face(Face& face) const {
    const Vec3d a = solid_.at(face.v[0]), b = solid_.at(face.v[1]), c = solid_.at(face.v[2]);
    const Vec3d apex = solid_.at(solid_.topology->triangles[face.triangle].apex);
    const Vec3d ab = b - a, bc = c - b, ca = a - c;
    const Vec3d doubled = cross(ab, c - a);
    const double area = length(doubled);
    const double inside = dot(doubled, apex - a);
    if (inside == 0) face.triangle |= flat_bit;
    face.normal = normalised(inside > 0 ? -1.0 * doubled : doubled);
    // `area` is sin(angle) * e * f at each corner, with the lengths e and f of its edges.
    const double lab = dot(ab, ab), lbc = dot(bc, bc), lca = dot(ca, ca);
    const auto weight = [area](double e, double f) { return e > 0 && f > 0 ? area / e / f : 0; };
    face.weight[0] = weight(lab, lca);
    face.weight[1] = weight(lab, lbc);
    face.weight[2] = weight(lbc, lca);
}

void Normals::compute_corner(std::uint32_t asking, std::size_t i) {
    constexpr double crease = 0.5; // the cosine of 60 degrees
    const Face& ask = faces_[asking];
    const std::uint32_t vertex = ask.v[i];
    const std::span<const std::uint32_t> ring = solid_.topology->ring_of(vertex);
    Vec3d sum{0, 0, 0};
    bool all = true; // take part, as they are
    for (const std::uint32_t other : ring) {
        const Face& f = faces_[places_[other]];
        const double cosine = dot(f.normal, ask.normal);
        const bool turn = cosine < 0 && (f.is_flat() || ask.is_flat());
        const bool close = (turn ? -cosine : cosine) >= crease;
        const double weight = f.weight[f.corner_at(vertex)];
        sum = sum + (!close ? 0.0 : turn ? -weight : weight) * f.normal;
        all &= close && !turn && !f.is_flat();
    }
    const Vec3d mean = normalised(sum);
    corners_[asking][i] = mean;
    known_[asking] |= static_cast<std::uint8_t>(1u << i);
    if (!all) return;
    constexpr double near = 0.875; // the cosine of 29 degrees
    for (const std::uint32_t other : ring)
        if (!(dot(faces_[places_[other]].normal, mean) > near)) return;
    for (const std::uint32_t other : ring) {
        const std::uint32_t place = places_[other];
        const std::size_t at = faces_[place].corner_at(vertex);
        corners_[place][at] = mean;
        known_[place] |= static_cast<std::uint8_t>(1u << at);
    }
}

Vec3d Normals::at(const SurfacePoint& point, const Vec3d& outward) const {
    const std::uint32_t place = places_[point.triangle];
    const std::array<Vec3d, 3>& corner = corners_[place];
    const Vec3d normal = normalised(point.weight[0] * corner[0] + point.weight[1] * corner[1] +
                                    point.weight[2] * corner[2]);
    return dot(faces_[place].normal, outward) < 0 ? -1.0 * normal : normal;
}

} // namespace vox::depth
