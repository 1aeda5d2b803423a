// The normal at a corner is the sum of the normals of the triangles around it, weighted by sin(angle) over
// the lengths of the two edges, which is exact for corners on a sphere (Max, "Weights for computing vertex
// normals from facet normals", Journal of Graphics Tools 4, 1999). Triangles whose normals are more than 60
// degrees from that of the triangle in question are left out, so that the faces of a box stay flat.
//
// Where all triangles around a corner are within 29 degrees of their mean, none of them leaves out another,
// and the sum is the same for each.
#include "depth/normals.hpp"

#include "base/prefetch.hpp"
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
    known_.clear();
    ring_faces_.clear();
    const std::size_t triangles = solid.topology->triangles.size(), vertices = solid.topology->links.size();
    if (triangles <= few && vertices <= few) {
        if (faces_.size() < triangles) faces_.resize(triangles);
        if (asked_.size() < triangles) asked_.resize(triangles);
        if (rings_.size() < vertices) rings_.resize(vertices);
        ring_faces_.reserve(3 * triangles);
        known_.resize(std::max(triangles, vertices), 0);
        return;
    }
    face_places_.clear();
    ring_places_.clear();
    asked_places_.clear();
    faces_.clear();
    rings_.clear();
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
    if (has_few()) return prepare_few(triangles);
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
    for (std::size_t i = first_face; i < faces_.size(); ++i)
        compute_face(solid_.topology->triangles[faces_[i].triangle], faces_[i]);
    for (std::size_t i = first_asked; i < asked_.size(); ++i) {
        Asked& asked = asked_[i];
        const Face& face = faces_[asked.face];
        for (std::size_t c = 0; c < 3; ++c)
            asked.normal[c] = corner_normal(face, face.v[c], rings_[asked.ring[c]]);
    }
}

// Lists the rings around the corners of triangles from `first_asked` on. These are anywhere in memory, so
// each pass prefetches what the next one reads.
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

// Prepares triangles of a body that has places for all of them.
void Normals::prepare_few(std::span<const std::uint32_t> triangles) {
    const Topology& topology = *solid_.topology;
    for (const std::uint32_t triangle : triangles) {
        if (known_[triangle] & known_corners) continue;
        known_[triangle] |= known_corners;
        Asked& asked = asked_[triangle];
        asked.face = triangle;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = topology.triangles[triangle].v[c];
            Ring& ring = rings_[v];
            if (!(known_[v] & known_ring)) {
                known_[v] |= known_ring;
                const auto first = static_cast<std::uint32_t>(ring_faces_.size());
                for (const std::uint32_t t : topology.ring_of(v)) {
                    ring_faces_.push_back(t);
                    if (known_[t] & known_face) continue;
                    known_[t] |= known_face;
                    const Triangle& of = topology.triangles[t];
                    faces_[t].triangle = t;
                    std::copy_n(of.v, 3, faces_[t].v);
                    compute_face(of, faces_[t]);
                }
                ring = {first, static_cast<std::uint32_t>(ring_faces_.size()), false, false, {}};
            }
            asked.normal[c] = corner_normal(faces_[triangle], v, ring);
        }
    }
}

// Computes the normal of a triangle, out of its tetrahedron, and its weights at the corners.
void Normals::compute_face(const Triangle& of, Face& face) const {
    const std::uint32_t vertices[4] = {of.v[0], of.v[1], of.v[2], of.apex};
    Vec3d at[4];
    for (std::size_t i = 0; i < 4; ++i) at[i] = solid_.at(vertices[i]);
    const auto& [a, b, c, apex] = at;
    const Vec3d ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, c - a);
    const double inside = dot(normal, apex - a);
    const Vec3d unit = normalised(normal);
    face.normal = inside > 0 ? -1.0 * unit : unit;
    if (inside == 0) face.triangle |= Face::flat_bit;
    // `area`, doubled, is sin(angle) * e * f at each corner, with the lengths e and f of its edges.
    const double area = length(normal), lab = dot(ab, ab), lbc = dot(bc, bc), lca = dot(ca, ca);
    const auto weight = [area](double e, double f) { return e > 0 && f > 0 ? area / e / f : 0.0; };
    face.weight[0] = weight(lab, lca);
    face.weight[1] = weight(lab, lbc);
    face.weight[2] = weight(lbc, lca);
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

std::uint32_t Normals::asked_place(std::uint32_t triangle) const noexcept {
    if (!has_few()) return asked_places_[triangle];
    return known_[triangle] & known_corners ? triangle : PlaceMap::none;
}

Vec3d Normals::at(const SurfacePoint& point, const Vec3d& outward) {
    std::uint32_t place = asked_place(point.triangle);
    if (place == PlaceMap::none) {
        prepare({&point.triangle, 1});
        place = asked_place(point.triangle);
    }
    const Asked& asked = asked_[place];
    const Vec3d normal = normalised(point.weight[0] * asked.normal[0] + point.weight[1] * asked.normal[1] +
                                    point.weight[2] * asked.normal[2]);
    return dot(faces_[asked.face].normal, outward) < 0 ? -1.0 * normal : normal;
}

} // namespace vox::depth
