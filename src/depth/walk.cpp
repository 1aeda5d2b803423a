// The straight walk (Devillers, Pion, Teillaud, "Walking in a triangulation", Int. J. of Foundations of
// Computer Science 13, 2002). Vertices are sheared so that the segment becomes the z axis, and the walk
// passes the facets whose projections contain the origin (Woop, Benthin, Wald, "Watertight ray/triangle
// intersection", Journal of Computer Graphics Techniques 2, 2013). The side of an edge on which the origin
// is found is computed in the same way for all facets around the edge, so the walk never slips between two of
// them. The winding of tetrahedra plays no part, so the walk goes through inverted and flat ones, too.
#include "depth/walk.hpp"

#include "base/vectors.hpp"

#include <algorithm>
#include <array>

namespace vox::depth {

namespace {

// A vertex in the frame in which p is the origin and q is (0, 0, 1).
struct Corner {
    std::uint32_t vertex;
    double x, y, z;
};

class Frame {
public:
    Frame(const Solid& solid, const Vec3d& p, const Vec3d& q) : positions_(solid.positions), origin_(p) {
        const double d[3] = {q.x - p.x, q.y - p.y, q.z - p.z};
        for (int axis = 1; axis < 3; ++axis)
            if (std::abs(d[axis]) > std::abs(d[z_])) z_ = axis;
        x_ = (z_ + 1) % 3;
        y_ = (z_ + 2) % 3;
        dz_ = d[z_];
        shear_x_ = d[x_] / dz_;
        shear_y_ = d[y_] / dz_;
    }

    bool is_usable() const { return dz_ != 0; } // p and q differ

    Corner operator()(std::uint32_t vertex) const {
        const Vec3d from_p = positions_.exact(vertex) - origin_;
        const double r[3] = {from_p.x, from_p.y, from_p.z};
        return {vertex, r[x_] - shear_x_ * r[z_], r[y_] - shear_y_ * r[z_], r[z_] / dz_};
    }

private:
    Positions positions_;
    Vec3d origin_;
    int x_, y_, z_ = 0;
    double dz_, shear_x_, shear_y_;
};

// Twice the area of the triangle (origin, a, b); the negative of area(b, a), exactly.
double area(const Corner& a, const Corner& b) { return a.x * b.y - b.x * a.y; }

// Whether the origin is to the left of a -> b. An origin on the edge counts as if it were moved by (e, e^2)
// for a small e (Edelsbrunner, Muecke, "Simulation of simplicity", ACM Transactions on Graphics 9, 1990), so
// that the answers for all edges still belong to one line.
bool left(const Corner& a, const Corner& b) {
    const double twice = area(a, b);
    if (twice != 0) return twice > 0;
    if (a.y != b.y) return a.y > b.y;
    return a.x != b.x ? a.x < b.x : a.vertex < b.vertex;
}

// A facet through which the line goes, with its corners counter-clockwise around the line.
struct Gate {
    Corner a, b, c;
    std::uint32_t behind; // the fourth vertex of the tetrahedron that the line leaves here

    double weight_a() const { return area(b, c); }
    double weight_b() const { return area(c, a); }
    double weight_c() const { return area(a, b); }
};

// Where the line crosses a gate, as numerator and denominator, which is 0 for a gate that is seen edge-on.
struct Ratio {
    double above, below;
};
Ratio height(const Gate& gate) {
    const double a = gate.weight_a(), b = gate.weight_b(), c = gate.weight_c();
    return {a * gate.a.z + b * gate.b.z + c * gate.c.z, a + b + c};
}

// The facet through which the line from the origin, inside or on the tetrahedron, leaves it.
bool first_gate(const Frame& frame, const Tet& tet, Gate& out) {
    const std::array<Corner, 4> corner = {frame(tet.v[0]), frame(tet.v[1]), frame(tet.v[2]), frame(tet.v[3])};
    bool found = false;
    double farthest = 0;
    for (int i = 0; i < 4; ++i) {
        const auto& [a, b, c] = facet_corners[i];
        Gate gate{corner[a], corner[b], corner[c], corner[std::size_t(i)].vertex};
        const bool ab = left(gate.a, gate.b), bc = left(gate.b, gate.c), ca = left(gate.c, gate.a);
        if (ab != bc || ab != ca) continue;
        if (!ab) std::swap(gate.b, gate.c);
        const Ratio at = height(gate);
        const double z = at.below > 0 ? at.above / at.below : std::max({gate.a.z, gate.b.z, gate.c.z});
        if (found && z <= farthest) continue;
        found = true;
        farthest = z;
        out = gate;
    }
    return found;
}

// The facet through which the line leaves the tetrahedron it enters by `in`, whose fourth corner is `apex`.
bool next_gate(const Gate& in, const Corner& apex, Gate& out) {
    const bool a = left(apex, in.a), b = left(apex, in.b), c = left(apex, in.c);
    if (a && !b)
        out = {apex, in.a, in.b, in.c.vertex};
    else if (b && !c)
        out = {apex, in.b, in.c, in.a.vertex};
    else if (c && !a)
        out = {apex, in.c, in.a, in.b.vertex};
    else
        return false; // happens only by rounding
    return true;
}

// The point where the line crosses `gate`; false when that is not between p and q.
bool cross_surface(const Gate& gate, const Vec3d& p, const Vec3d& q, const Triangle& triangle,
                   SurfacePoint& out) {
    constexpr double rounding = 1e-9; // of the length of the segment
    const Ratio at = height(gate);
    if (!(at.below > 0)) return false;
    const double t = at.above / at.below;
    if (!(t >= -rounding) || t > 1 + rounding) return false;
    const Corner* corners[3] = {&gate.a, &gate.b, &gate.c};
    const double weights[3] = {gate.weight_a(), gate.weight_b(), gate.weight_c()};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (corners[j]->vertex == triangle.v[i]) out.weight[i] = weights[j] / at.below;
    out.point = p + std::clamp(t, 0.0, 1.0) * (q - p);
    return true;
}

} // namespace

bool walk_out(const Solid& solid, std::uint32_t tet, const Vec3d& p, const Vec3d& q, SurfacePoint& out,
              std::uint64_t& visited) {
    const Frame frame(solid, p, q);
    Gate gate;
    if (!frame.is_usable() || !first_gate(frame, solid.tets[tet], gate)) return false;
    // Inverted tetrahedra may lead the walk back to where it was. Then it would go round for ever, since the
    // facet by which it leaves decides all that follows. To find that out, a place is remembered after 1, 2,
    // 4, ... steps (R. P. Brent, "An improved Monte Carlo factorization algorithm", BIT 20, 1980).
    std::uint32_t remembered_tet = ~0u, remembered_behind = 0;
    for (std::size_t steps = 1, remember_at = 1;; ++steps) {
        ++visited;
        if (tet == remembered_tet && gate.behind == remembered_behind) return false;
        if (steps == remember_at) {
            remembered_tet = tet;
            remembered_behind = gate.behind;
            remember_at *= 2;
        }
        const Tet& from = solid.tets[tet];
        int facet = 0;
        while (from.v[facet] != gate.behind) ++facet;
        const std::uint32_t across = solid.topology->across(tet, static_cast<std::uint32_t>(facet));
        if (across == Topology::nothing) return false;
        if (across & Topology::surface_bit) {
            out.triangle = across & ~Topology::surface_bit;
            return cross_surface(gate, p, q, solid.topology->triangles[out.triangle], out);
        }
        const Ratio at = height(gate);
        if (at.above > at.below) return false; // q is passed
        const std::uint32_t* v = solid.tets[across].v;
        const std::uint32_t apex = v[0] ^ v[1] ^ v[2] ^ v[3] ^ gate.a.vertex ^ gate.b.vertex ^ gate.c.vertex;
        Gate next;
        if (!next_gate(gate, frame(apex), next)) return false;
        gate = next;
        tet = across;
    }
}

} // namespace vox::depth
