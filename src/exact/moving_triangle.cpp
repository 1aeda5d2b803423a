// A triangle that does not meet a convex polytope at first, and meets it later, first does so with a corner,
// in a corner of the polytope, or where an edge of the one crosses an edge of the other: an extreme point of
// what they have in common then is where two faces of complementary dimension cross, and two that cross in a
// point inside both crossed before, unless both can part along their common plane. A flat tetrahedron is the
// union of its faces.
#include "exact/moving_triangle.hpp"

#include "base/scene.hpp"
#include "exact/crossing.hpp"
#include "exact/first_contact.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

namespace vox {

namespace {

bool is_at(const Vec3d& p, const Vec3d& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }

bool is_apart(const ContactRows& rows) {
    Vec3d low[2] = {rows.from[0], rows.origin}, high[2] = {rows.from[0], rows.origin};
    for (std::size_t i = 0; i < rows.count; ++i) {
        const std::size_t still = i >= rows.moving;
        low[still] = min(low[still], min(rows.from[i], rows.to[i]));
        high[still] = max(high[still], max(rows.from[i], rows.to[i]));
    }
    return low[0].x > high[1].x || low[0].y > high[1].y || low[0].z > high[1].z || high[0].x < low[1].x ||
           high[0].y < low[1].y || high[0].z < low[1].z;
}

} // namespace

// The first contacts of a moving triangle with parts of a tetrahedron.
class MovingTriangle::Contacts {
public:
    explicit Contacts(const MovingTriangle& triangle) : triangle_(triangle) {}

    // Looks at all contacts with an edge. Returns whether there are any, and sets where the first one is.
    bool look_at_edge(const Vec3d& p, const Vec3d& q, double& s) {
        best_ = 2;
        degenerate_ = triangle_.corners_ == 1;
        const std::size_t n = triangle_.corners_;
        if (n == 3)
            for (const Vec3d* at : {&p, &q}) try_rows(rows({0, 1, 2}, *at), at == &p ? 0 : 1, s);
        for (std::size_t side = 0; side < triangle_.sides(); ++side) {
            ContactRows of_side = rows({side, (side + 1) % n}, p);
            of_side.add_still(q);
            try_rows(of_side, in_between, s);
        }
        if (!degenerate_) return best_ <= 1;
        for (const Vec3d* at : {&p, &q}) {
            const double end = at == &p ? 0 : 1;
            for (std::size_t side = 0; side < triangle_.sides(); ++side)
                try_rows(rows({side, (side + 1) % n}, *at), end, s);
            for (std::size_t i = 0; i < n; ++i) try_rows(rows({i}, *at), end, s);
        }
        for (std::size_t i = 0; i < n; ++i) {
            ContactRows of_corner = rows({i}, p);
            of_corner.add_still(q);
            try_rows(of_corner, in_between, s);
        }
        return best_ <= 1;
    }

    // Looks at the contacts of corners with a face. Its border is looked at by itself.
    void look_at_face(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        double s = 0;
        best_ = 2;
        for (std::size_t i = 0; i < triangle_.corners_; ++i) {
            ContactRows of_corner = rows({i}, a);
            of_corner.add_still(b);
            of_corner.add_still(c);
            try_rows(of_corner, 0, s);
        }
    }

    bool any() const { return !found_.empty(); }

    // The time of the first one, rounded to nearest.
    double first_time() {
        double t = most_;
        for (const Found& found : found_)
            if (found.contact.low <= t) t = std::min(t, exact_time(found.rows, found.contact));
        return t;
    }

private:
    struct Found {
        ContactRows rows;
        FirstContact contact;
    };
    static constexpr double in_between = -1; // for `end`

    ContactRows rows(std::initializer_list<std::size_t> corners, const Vec3d& origin) const {
        ContactRows result;
        result.origin = origin;
        for (const std::size_t i : corners) {
            const std::size_t corner = triangle_.corner_[i];
            result.add_moving(triangle_.from_[corner], triangle_.to_[corner]);
        }
        return result;
    }
    // If it is the earliest contact with the edge so far, s becomes where it is: `end`, or in between.
    void try_rows(const ContactRows& rows, double end, double& s) {
        if (is_apart(rows)) return;
        FirstContact contact = quick_contact(rows);
        if (contact.answer == FirstContact::unsure) contact = exact_contact(rows, degenerate_);
        if (contact.answer != FirstContact::found) return;
        if (contact.low < most_) found_.push_back({rows, contact});
        most_ = std::min(most_, contact.high);
        if (!(contact.t < best_)) return;
        best_ = contact.t;
        s = end == in_between ? place_on_edge(rows, contact.t) : end;
    }
    static double place_on_edge(const ContactRows& rows, double t) {
        if (rows.count == 2) { // a corner on the edge
            const Vec3d along = rows.from[1] - rows.origin,
                        way = (1 - t) * rows.from[0] + t * rows.to[0] - rows.origin;
            const double length = dot(along, along);
            return length > 0 ? std::clamp(dot(way, along) / length, 0.0, 1.0) : 0;
        }
        double weight[3];
        contact_weights(rows, t, weight);
        const double whole = weight[0] + weight[1];
        return whole > 0 ? std::clamp(-weight[2] / whole, 0.0, 1.0) : 0.5;
    }

    const MovingTriangle& triangle_;
    bool degenerate_ = false;
    double best_ = 2;
    double most_ = 2;          // the first one is no later
    std::vector<Found> found_; // that may be the first one
};

MovingTriangle::MovingTriangle(const Vec3d* from, const Vec3d* to)
    : from_{from[0], from[1], from[2]}, plane_(from[0], from[1], from[2]) {
    for (std::size_t i = 0; i < 3; ++i) {
        to_[i] = to ? to[i] : from[i];
        moves_ |= !is_at(from_[i], to_[i]);
        bool is_new = true;
        for (std::size_t n = 0; n < corners_; ++n)
            is_new &= !is_at(from_[i], from_[corner_[n]]) || !is_at(to_[i], to_[corner_[n]]);
        if (is_new) corner_[corners_++] = i;
    }
}

// True if a face certainly separates the two all the time.
bool MovingTriangle::is_beside(const Vec3d* const (&corner)[4]) const {
    for (std::size_t f = 0; f < 4; ++f) {
        const std::uint8_t* const c = facet_corners[f];
        const TrianglePlane face(*corner[c[0]], *corner[c[1]], *corner[c[2]]);
        const BoundedVolume inside = face.volume(*corner[f]);
        if (!inside.certain()) continue;
        const auto is_outside = [&](const Vec3d& p) {
            const BoundedVolume side = face.volume(p);
            return side.certain() && (side.volume > 0) != (inside.volume > 0);
        };
        if (is_outside(from_[0]) && is_outside(from_[1]) && is_outside(from_[2]) &&
            (!moves_ || (is_outside(to_[0]) && is_outside(to_[1]) && is_outside(to_[2]))))
            return true;
    }
    return false;
}

// Whether it meets the tetrahedron at first, if it meets no edge of it.
bool MovingTriangle::meets_faces(const Vec3d* const (&corner)[4]) const {
    std::uint64_t exact_tests = 0;
    const Containment where = locate(from_[0], *corner[0], *corner[1], *corner[2], *corner[3], exact_tests);
    if (where == Containment::interior || where == Containment::boundary) return true;
    for (const std::uint8_t* c : facet_corners)
        for (std::size_t i = 0; i < sides(); ++i)
            if (find_crossing(from_[corner_[i]], from_[corner_[(i + 1) % corners_]], *corner[c[0]],
                              *corner[c[1]], *corner[c[2]], exact_tests)
                    .kind != CrossingKind::none)
                return true;
    return false;
}

// On which side of its plane a point certainly is all the time; else 0.
int MovingTriangle::side_of(const Vec3d& p) const {
    if (corners_ < 3) return 0;
    ContactRows rows;
    rows.origin = p;
    for (std::size_t i = 0; i < 3; ++i) rows.add_moving(from_[i], to_[i]);
    return constant_side(rows);
}

TetMeeting MovingTriangle::meet(const Vec3d* const (&corner)[4], const std::uint32_t (&vertex)[4]) const {
    TetMeeting meeting;
    if (is_beside(corner)) return meeting;
    int first_side[4], side[4]; // of its plane, where it is certain: at first, and if it is that all the time
    for (std::size_t c = 0; c < 4; ++c) {
        const BoundedVolume volume = plane_.volume(*corner[c]);
        first_side[c] = !volume.certain() ? 0 : volume.volume > 0 ? 1 : -1;
        side[c] = moves_ ? side_of(*corner[c]) : first_side[c];
    }
    const auto is_on_one_side = [](const int(&of)[4]) {
        return of[0] != 0 && of[0] == of[1] && of[0] == of[2] && of[0] == of[3];
    };
    if (is_on_one_side(side)) return meeting;
    const bool is_in_plane = !is_on_one_side(first_side);
    std::uint64_t exact_tests = 0;
    Contacts contacts(*this);
    for (std::uint32_t e = 0; e < 6; ++e) {
        std::size_t low = edge_corners[e][0], high = edge_corners[e][1];
        if (side[low] != 0 && side[low] == side[high]) continue;
        if (vertex[low] > vertex[high]) std::swap(low, high);
        const Vec3d &p = *corner[low], &q = *corner[high];
        // A segment meets an edge only in one plane.
        if (is_in_plane &&
            (corners_ == 3 ||
             !bounded_volume(p, q, from_[corner_[0]], from_[corner_[corners_ - 1]]).certain())) {
            const Crossing crossing = find_crossing(p, q, from_[0], from_[1], from_[2], exact_tests);
            if (crossing.kind != CrossingKind::none) {
                meeting.any = true;
                meeting.edges |= 1u << e;
                meeting.s[e] = crossing.edge_weights[1];
                continue;
            }
        }
        if (moves_ && contacts.look_at_edge(p, q, meeting.s[e])) meeting.edges |= 1u << e;
    }
    if (meeting.any || (is_in_plane && meets_faces(corner))) return meeting.any = true, meeting;
    if (!moves_) return meeting;
    for (const std::uint8_t* c : facet_corners)
        contacts.look_at_face(*corner[c[0]], *corner[c[1]], *corner[c[2]]);
    meeting.any = contacts.any();
    if (meeting.any) meeting.t = contacts.first_time();
    return meeting;
}

} // namespace vox
