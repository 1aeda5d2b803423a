// The straight walk (Devillers, Pion, Teillaud, "Walking in a triangulation", Int. J. of Foundations of
// Computer Science 13, 2002). Vertices are sheared so that the segment becomes the z axis, and the walk
// passes the facets whose projections contain the origin (Woop, Benthin, Wald, "Watertight ray/triangle
// intersection", Journal of Computer Graphics Techniques 2, 2013). The side of an edge on which the origin
// is found is computed in the same way for all facets around the edge, so the walk never slips between two of
// them. The winding of tetrahedra plays no part, so the walk goes through inverted and flat ones, too.
#include "depth/walk.hpp"

#include "base/prefetch.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace vox::depth {

namespace {

// A vertex in the frame in which p is the origin and q is (0, 0, 1).
struct Corner {
    std::uint32_t vertex;
    double x, y, z;
};

class Frame {
public:
    Frame() = default;
    Frame(const Vec3d& p, const Vec3d& q) : origin_(p), z_(0) {
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

    Corner operator()(const Solid& solid, std::uint32_t vertex) const {
        const Vec3d from_p = solid.at(vertex) - origin_;
        const double r[3] = {from_p.x, from_p.y, from_p.z};
        return {vertex, r[x_] - shear_x_ * r[z_], r[y_] - shear_y_ * r[z_], r[z_] / dz_};
    }

private:
    Vec3d origin_;
    int x_, y_, z_; // the axes of the frame
    double dz_, shear_x_, shear_y_;
};

// Twice the area of the triangle (origin, a, b); the negative of area(b, a), exactly.
double area(const Corner& a, const Corner& b) { return a.x * b.y - b.x * a.y; }

// True if the origin is to the left of a -> b. An origin on the edge counts as if it were moved by (e, e^2)
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
};

// Where the line crosses a gate, as numerator and denominator, which is 0 for a gate that is seen edge-on.
struct Ratio {
    double above, below;
};
Ratio height(const Corner& a, const Corner& b, const Corner& c) {
    const double of_a = area(b, c), of_b = area(c, a), of_c = area(a, b);
    return {of_a * a.z + of_b * b.z + of_c * c.z, of_a + of_b + of_c};
}
Ratio height(const Gate& gate) { return height(gate.a, gate.b, gate.c); }

// The facet through which the line from the origin, inside or on the tetrahedron, leaves it.
bool first_gate(const Frame& frame, const Solid& solid, const Tet& tet, Gate& out) {
    std::array<Corner, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) corner[i] = frame(solid, tet.v[i]);
    bool is_left[4][4];
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) is_left[j][i] = !(is_left[i][j] = left(corner[i], corner[j]));
    int best = -1;
    double farthest = 0;
    for (int i = 0; i < 4; ++i) {
        const auto& [a, b, c] = facet_corners[i];
        if (is_left[a][b] != is_left[b][c] || is_left[a][b] != is_left[c][a]) continue;
        const Ratio at =
            is_left[a][b] ? height(corner[a], corner[b], corner[c]) : height(corner[a], corner[c], corner[b]);
        const double z =
            at.below > 0 ? at.above / at.below : std::max({corner[a].z, corner[b].z, corner[c].z});
        if (best >= 0 && z <= farthest) continue;
        best = i;
        farthest = z;
    }
    if (best < 0) return false;
    const auto& [a, b, c] = facet_corners[best];
    const bool turn = !is_left[a][b];
    out = {corner[a], corner[turn ? c : b], corner[turn ? b : c], tet.v[best]};
    return true;
}

// Goes from the facet by which the line enters a tetrahedron, whose fourth corner is `apex`, to that by which
// it leaves.
bool to_next_gate(Gate& gate, const Corner& apex) {
    const bool a = left(apex, gate.a), b = left(apex, gate.b), c = left(apex, gate.c);
    if (a && !b) {
        gate.behind = gate.c.vertex;
        gate.c = gate.b;
        gate.b = gate.a;
    } else if (b && !c) {
        gate.behind = gate.a.vertex;
    } else if (c && !a) {
        gate.behind = gate.b.vertex;
        gate.b = gate.c;
        gate.c = gate.a;
    } else {
        return false; // happens only by rounding
    }
    gate.a = apex;
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
    const double weights[3] = {area(gate.b, gate.c), area(gate.c, gate.a), area(gate.a, gate.b)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (corners[j]->vertex == triangle.v[i]) out.weight[i] = weights[j] / at.below;
    out.point = p + std::clamp(t, 0.0, 1.0) * (q - p);
    return true;
}

// A walk that is under way. What it does for each tetrahedron is cut where it waits for memory, so that many
// walks side by side wait together.
class Steps {
public:
    // True if there is a first tetrahedron to leave.
    bool begin(const Solid& solid, Walk& walk) {
        walk_ = &walk;
        walk.leaves = false;
        walk.visited = 0;
        tet_ = walk.tet;
        frame_ = Frame(walk.p, walk.q);
        remembered_tet_ = ~0u;
        remembered_behind_ = 0;
        remember_at_ = 1;
        return frame_.is_usable() && first_gate(frame_, solid, solid.tets[tet_], gate_);
    }

    // Finds out what lies across the gate, and prefetches it.
    void look_across(const Solid& solid) {
        const std::uint32_t* v = solid.tets[tet_].v;
        // Without branches, which would be mispredicted.
        const auto facet = (v[1] == gate_.behind ? 1u : 0u) | (v[2] == gate_.behind ? 2u : 0u) |
                           (v[3] == gate_.behind ? 3u : 0u);
        across_ = solid.topology->across(tet_, facet);
        if (across_ & Topology::surface_bit)
            prefetch(solid.topology->triangles.data() + (across_ & ~Topology::surface_bit));
        else
            prefetch(&solid.tets[across_]);
    }

    // Finds the vertex behind the tetrahedron there, if it is one, and prefetches its position.
    void look_at_apex(const Solid& solid) {
        if (across_ & Topology::surface_bit) return; // also `nothing`
        const std::uint32_t* v = solid.tets[across_].v;
        apex_ = v[0] ^ v[1] ^ v[2] ^ v[3] ^ gate_.a.vertex ^ gate_.b.vertex ^ gate_.c.vertex;
        prefetch(solid.positions.place_of(apex_));
        prefetch(solid.topology->across.place_of(across_));
    }

    // Goes there; false where the walk ends.
    bool go_across(const Solid& solid) {
        // Inverted tetrahedra may lead the walk back to where it was. Then it would go round for ever, since
        // the facet by which it leaves decides all that follows. To find that out, a place is remembered
        // after 1, 2, 4, ... steps (R. P. Brent, "An improved Monte Carlo factorization algorithm", BIT 20,
        // 1980).
        ++walk_->visited;
        if (tet_ == remembered_tet_ && gate_.behind == remembered_behind_) return false;
        if (walk_->visited == remember_at_) {
            remembered_tet_ = tet_;
            remembered_behind_ = gate_.behind;
            remember_at_ *= 2;
        }
        if (across_ == Topology::nothing) return false;
        if (across_ & Topology::surface_bit) {
            SurfacePoint& exit = walk_->exit;
            exit.triangle = across_ & ~Topology::surface_bit;
            walk_->leaves =
                cross_surface(gate_, walk_->p, walk_->q, solid.topology->triangles[exit.triangle], exit);
            return false;
        }
        const Ratio at = height(gate_);
        if (at.above > at.below) return false; // q is passed
        if (!to_next_gate(gate_, frame_(solid, apex_))) return false;
        tet_ = across_;
        return true;
    }

private:
    // They have no values before begin(), as there are many.
    Walk* walk_;
    Frame frame_;
    Gate gate_;
    std::uint32_t tet_, across_, apex_;
    std::uint32_t remembered_tet_, remembered_behind_;
    std::uint64_t remember_at_;
};

} // namespace

void walk_out(const Solid& solid, std::span<Walk> walks) {
    constexpr std::size_t side_by_side = 64;
    std::array<Steps, side_by_side> steps;
    for (; !walks.empty(); walks = walks.subspan(std::min(side_by_side, walks.size()))) {
        const std::span<Walk> some = walks.first(std::min(side_by_side, walks.size()));
        for (const Walk& walk : some) {
            prefetch(&solid.tets[walk.tet]);
            prefetch(solid.topology->across.place_of(walk.tet));
        }
        for (const Walk& walk : some)
            for (const std::uint32_t v : solid.tets[walk.tet].v) prefetch(solid.positions.place_of(v));
        std::array<std::uint8_t, side_by_side> going_on;
        std::size_t count = 0;
        for (std::size_t i = 0; i < some.size(); ++i) {
            going_on[count] = static_cast<std::uint8_t>(i);
            count += steps[i].begin(solid, some[i]);
        }
        while (count > 0) {
            for (std::size_t i = 0; i < count; ++i) steps[going_on[i]].look_across(solid);
            for (std::size_t i = 0; i < count; ++i) steps[going_on[i]].look_at_apex(solid);
            const std::size_t before = std::exchange(count, 0);
            for (std::size_t i = 0; i < before; ++i) {
                const std::uint8_t walk = going_on[i];
                going_on[count] = walk;
                count += steps[walk].go_across(solid);
            }
        }
    }
}

bool walk_out(const Solid& solid, std::uint32_t tet, const Vec3d& p, const Vec3d& q, SurfacePoint& out,
              std::uint64_t& visited) {
    Walk walk{p, q, tet, false, 0, {}};
    Steps steps;
    for (bool goes_on = steps.begin(solid, walk); goes_on; goes_on = steps.go_across(solid)) {
        steps.look_across(solid);
        steps.look_at_apex(solid);
    }
    visited += walk.visited;
    if (walk.leaves) out = walk.exit;
    return walk.leaves;
}

} // namespace vox::depth
