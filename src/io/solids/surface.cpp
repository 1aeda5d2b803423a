// Finds the nodes inside by counting the crossings of lines with the surface. Degenerate cases are resolved
// by simulation of simplicity: Edelsbrunner and Mücke, "Simulation of simplicity: a technique to cope with
// degenerate cases in geometric algorithms", ACM Trans. Graphics 9(1), 1990.
#include "io/solids/surface.hpp"

#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox::io {
namespace {

using IntPoint = std::array<std::int32_t, 3>;
using Corners = std::array<std::uint32_t, 3>;

using Triangle = OrderedTriangle;

Triangle in_order(Corners corners) {
    int turn = 1;
    for (const std::size_t k : std::array<std::size_t, 3>{0, 1, 0})
        if (corners[k] > corners[k + 1]) {
            std::swap(corners[k], corners[k + 1]);
            turn = -turn;
        }
    return {corners, turn};
}

// Integer coordinates stay below 2^29, so that differences of products of differences fit into 63 bits.
constexpr int coordinate_bits = 29;

// For each direction a linear map of determinant one to (t, u, v). t runs along the direction, at the rate of
// its first coordinate; u and v are the same for all points of a line.
struct Projection {
    std::array<std::array<std::int32_t, 3>, 3> rows; // t, u, v in terms of x, y, z
};
constexpr std::array<Projection, 7> projections = {{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}}},
    {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}},
    {{{{1, 0, 0}, {-1, 1, 0}, {-1, 0, 1}}}},
    {{{{1, 0, 0}, {-1, 1, 0}, {1, 0, 1}}}},
    {{{{1, 0, 0}, {1, 1, 0}, {-1, 0, 1}}}},
    {{{{1, 0, 0}, {1, 1, 0}, {1, 0, 1}}}},
}};

std::int64_t apply(const std::array<std::int32_t, 3>& row, const IntPoint& p) {
    return std::int64_t{row[0]} * p[0] + std::int64_t{row[1]} * p[1] + std::int64_t{row[2]} * p[2];
}

int sign(std::int64_t x) { return (x > 0) - (x < 0); }

struct Flat {
    std::int64_t u, v;
};

// Twice the area of (a, b, q) in the plane of u and v.
std::int64_t area(const Flat& a, const Flat& b, const Flat& q) {
    return (b.u - a.u) * (q.v - a.v) - (b.v - a.v) * (q.u - a.u);
}

// The sign of that area after q is shifted by (e, e^2, e^3) in x, y, z, for any sufficiently small e > 0. It
// is zero only if a = b.
int side(std::int64_t area, const Flat& a, const Flat& b, const Projection& projection) {
    if (area != 0) return sign(area);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t change = (b.u - a.u) * projection.rows[2][k] - (b.v - a.v) * projection.rows[1][k];
        if (change != 0) return sign(change);
    }
    return 0;
}

// Whether a point in the plane of the triangle, shifted in the same way, is on the side that its normal
// points to.
bool shifted_above(const IntPoint& a, const IntPoint& b, const IntPoint& c) {
    const std::array<std::int64_t, 3> p = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const std::array<std::int64_t, 3> q = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t normal = p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
        if (normal != 0) return normal > 0;
    }
    return true;
}

struct Crossing {
    std::int32_t v, u;
    std::int32_t turn; // +1 if the line enters a surface that is oriented outwards
    double t;
    bool operator<(const Crossing& other) const {
        if (v != other.v) return v < other.v;
        if (u != other.u) return u < other.u;
        if (t != other.t) return t < other.t;
        return turn > other.turn;
    }
};

// What the line v cuts out of the triangle, rounded outwards: a long thin one across the lattice fills little
// of its box.
std::array<std::int64_t, 2> cut_of_row(const std::array<Flat, 3>& p, std::int64_t v) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < 3; ++k) {
        const Flat &a = p[k], &b = p[(k + 1) % 3];
        if (v < std::min(a.v, b.v) || v > std::max(a.v, b.v)) continue;
        const auto u = [](std::int64_t x) { return static_cast<double>(x); };
        const double at = a.v == b.v ? u(a.u) : u(a.u) + u(b.u - a.u) * (u(v - a.v) / u(b.v - a.v));
        low = std::min({low, at, a.v == b.v ? u(b.u) : at});
        high = std::max({high, at, a.v == b.v ? u(b.u) : at});
    }
    return {static_cast<std::int64_t>(std::floor(low)) - 1, static_cast<std::int64_t>(std::ceil(high)) + 1};
}

std::int64_t round_up(std::int64_t x, std::int64_t step) { // step a power of two
    return (x + step - 1) & ~(step - 1);
}

// Numbers equal positions the same. Returns the numbers and keeps one of each position in `points`.
std::vector<std::uint32_t> weld(std::vector<IntPoint>& points) {
    std::vector<std::uint32_t> order(points.size()), number(points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return points[a] < points[b]; });
    std::vector<IntPoint> kept;
    for (const std::uint32_t i : order) {
        if (kept.empty() || kept.back() != points[i]) kept.push_back(points[i]);
        number[i] = static_cast<std::uint32_t>(kept.size() - 1);
    }
    points = std::move(kept);
    return number;
}

void check_edges(const std::vector<Corners>& triangles, SurfaceCheck& check) {
    std::vector<std::uint64_t> edges; // from high to low bits: lower vertex, higher vertex, direction
    edges.reserve(3 * triangles.size());
    for (const Corners& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = t[k], b = t[(k + 1) % 3];
            edges.push_back(a < b ? a << 32 | b << 1 : b << 32 | a << 1 | 1);
        }
    std::sort(edges.begin(), edges.end());
    check.oriented = true;
    for (std::size_t i = 0; i < edges.size();) {
        std::int64_t forward = 0, backward = 0;
        const std::uint64_t edge = edges[i] >> 1;
        for (; i < edges.size() && edges[i] >> 1 == edge; ++i) ++(edges[i] & 1 ? backward : forward);
        ++check.edges;
        check.open_edges += static_cast<std::uint64_t>((forward + backward) & 1);
        check.oriented = check.oriented && forward == backward;
    }
}

// Intersects all lines of a direction with all triangles. Inside is decided by winding number if the surface
// is `oriented`, otherwise by parity.
LatticeLines cast(unsigned direction, const std::vector<IntPoint>& points,
                  const std::vector<Triangle>& triangles, int shift, bool oriented) {
    const Projection& projection = projections[direction];
    const bool diagonal = direction >= 3;
    const std::int64_t unit = std::int64_t{1} << shift;
    std::vector<Crossing> crossings;
    for (const auto& [triangle, turn] : triangles) {
        std::array<Flat, 3> p{};
        std::array<double, 3> t{};
        for (std::size_t k = 0; k < 3; ++k) {
            const IntPoint& point = points[triangle[k]];
            p[k] = {apply(projection.rows[1], point), apply(projection.rows[2], point)};
            t[k] = static_cast<double>(apply(projection.rows[0], point));
        }
        const std::int64_t whole = area(p[0], p[1], p[2]);
        if (whole == 0) continue; // parallel to the lines
        const bool after =
            shifted_above(points[triangle[0]], points[triangle[1]], points[triangle[2]]) == (whole > 0);
        const auto [low_v, high_v] = std::minmax({p[0].v, p[1].v, p[2].v});
        // In lattice units, u and v have the same parity for lines along an axis, and are both even along a
        // diagonal.
        const std::int64_t step_v = diagonal ? 2 * unit : unit;
        for (std::int64_t v = round_up(low_v, step_v); v <= high_v; v += step_v) {
            const std::int64_t odd = (v >> shift) & 1 ? unit : 0;
            const auto [low_u, high_u] = cut_of_row(p, v);
            for (std::int64_t u = round_up(low_u - odd, 2 * unit) + odd; u <= high_u; u += 2 * unit) {
                const Flat q = {u, v};
                const std::int64_t w0 = area(p[1], p[2], q), w1 = area(p[2], p[0], q),
                                   w2 = area(p[0], p[1], q);
                if (side(w0, p[1], p[2], projection) != sign(whole) ||
                    side(w1, p[2], p[0], projection) != sign(whole) ||
                    side(w2, p[0], p[1], projection) != sign(whole))
                    continue;
                double at = t[0] + (static_cast<double>(w1) * (t[1] - t[0]) +
                                    static_cast<double>(w2) * (t[2] - t[0])) /
                                       static_cast<double>(whole);
                at = std::clamp(at, std::min({t[0], t[1], t[2]}), std::max({t[0], t[1], t[2]}));
                at /= static_cast<double>(unit);
                // A point exactly on the triangle counts as behind it (its t is at least the toggle's) if its
                // shifted image is behind it.
                if (!after) at = std::nextafter(at, std::numeric_limits<double>::infinity());
                crossings.push_back({static_cast<std::int32_t>(v >> shift),
                                     static_cast<std::int32_t>(u >> shift), whole > 0 ? -turn : turn, at});
            }
        }
    }
    std::sort(crossings.begin(), crossings.end());

    LatticeLines lines;
    if (crossings.size() >= std::numeric_limits<std::uint32_t>::max())
        throw_error(VOX_ERROR_LIMIT,
                    "the surface crosses more than 4294967294 lattice lines: choose larger cells");
    if (crossings.empty()) {
        lines.row_start.assign(1, 0);
        lines.start.assign(1, 0);
        return lines;
    }
    lines.first_v = crossings.front().v;
    lines.row_start.assign(static_cast<std::size_t>(crossings.back().v - lines.first_v) + 2, 0);
    for (std::size_t i = 0; i < crossings.size();) {
        const Crossing first = crossings[i];
        lines.line_u.push_back(first.u);
        lines.start.push_back(static_cast<std::uint32_t>(lines.toggles.size()));
        ++lines.row_start[static_cast<std::size_t>(first.v - lines.first_v) + 1];
        std::int64_t winding = 0;
        for (; i < crossings.size() && crossings[i].v == first.v && crossings[i].u == first.u; ++i) {
            const bool was_inside = winding != 0;
            winding = oriented ? winding + crossings[i].turn : 1 - winding;
            if ((winding != 0) != was_inside) lines.toggles.push_back(crossings[i].t);
        }
    }
    lines.start.push_back(static_cast<std::uint32_t>(lines.toggles.size()));
    for (std::size_t row = 1; row < lines.row_start.size(); ++row)
        lines.row_start[row] += lines.row_start[row - 1];
    return lines;
}

} // namespace

SurfaceLines::SurfaceLines(const vox_io_mesh_view& surface, const Frame& frame) : shift_(coordinate_bits) {
    const std::int32_t longest = 2 * *std::max_element(frame.cells.begin(), frame.cells.end());
    while ((std::int64_t{longest} << shift_) >= std::int64_t{1} << coordinate_bits) --shift_;

    points_.resize(surface.vertex_count);
    const double scale = std::ldexp(1.0, shift_) / frame.half_cell;
    for (std::size_t i = 0; i < points_.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            // Vertices that no triangle uses may be outside of the lattice.
            const double x = std::floor((surface.positions[3 * i + k] - frame.origin[k]) * scale + 0.5);
            points_[i][k] = static_cast<std::int32_t>(std::clamp(x, -1.0, std::ldexp(1.0, coordinate_bits)));
        }
    const std::vector<std::uint32_t> number = weld(points_);
    std::vector<Corners> given;
    given.reserve(surface.triangle_count);
    for (std::size_t t = 0; t < surface.triangle_count; ++t) {
        const Corners corners = {number[surface.triangles[3 * t]], number[surface.triangles[3 * t + 1]],
                                 number[surface.triangles[3 * t + 2]]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            given.push_back(corners);
    }
    check_edges(given, check_);
    triangles_.resize(given.size());
    std::transform(given.begin(), given.end(), triangles_.begin(), in_order);
    cast_up_to(check_.open_edges == 0 ? 1 : 3);
}

void SurfaceLines::cast_up_to(unsigned directions) {
    for (; cast_ < directions; ++cast_)
        lines_[cast_] = cast(cast_, points_, triangles_, shift_, check_.oriented);
}

void SurfaceLines::cast_rest(const Progress& progress) {
    while (cast_ < lines_.size()) {
        cast_up_to(cast_ + 1);
        progress.report(cast_ / 7.0);
    }
}

SurfaceLines::Line SurfaceLines::find(unsigned direction, const Node& node) const {
    const LatticeLines& lines = lines_[direction];
    const IntPoint point = {node.x, node.y, node.z};
    const auto u = static_cast<std::int32_t>(apply(projections[direction].rows[1], point));
    const auto v = static_cast<std::int32_t>(apply(projections[direction].rows[2], point));
    const std::int64_t row = std::int64_t{v} - lines.first_v;
    if (row < 0 || row + 1 >= static_cast<std::int64_t>(lines.row_start.size())) return {nullptr, nullptr};
    const auto begin = lines.line_u.begin() + lines.row_start[static_cast<std::size_t>(row)];
    const auto end = lines.line_u.begin() + lines.row_start[static_cast<std::size_t>(row) + 1];
    const auto found = std::lower_bound(begin, end, u);
    if (found == end || *found != u) return {nullptr, nullptr};
    const auto line = static_cast<std::size_t>(found - lines.line_u.begin());
    return {lines.toggles.data() + lines.start[line], lines.toggles.data() + lines.start[line + 1]};
}

// The nodes inside according to the lines along one axis. Lines that end inside are ignored.
std::vector<Run> SurfaceLines::runs_along(unsigned axis) const {
    const LatticeLines& lines = lines_[axis];
    std::vector<Run> runs;
    for (std::size_t row = 0; row + 1 < lines.row_start.size(); ++row)
        for (std::uint32_t line = lines.row_start[row]; line < lines.row_start[row + 1]; ++line) {
            const std::int32_t u = lines.line_u[line], v = lines.first_v + static_cast<std::int32_t>(row);
            const double* toggle = lines.toggles.data() + lines.start[line];
            const double* end = lines.toggles.data() + lines.start[line + 1];
            if ((end - toggle) % 2 != 0) continue;
            const std::int32_t parity = u & 1;
            for (; toggle != end; toggle += 2) {
                // The nodes at t = 2 i + parity with toggle[0] <= t < toggle[1].
                const auto first = static_cast<std::int32_t>(std::ceil((toggle[0] - parity) / 2));
                const auto last = static_cast<std::int32_t>(std::ceil((toggle[1] - parity) / 2)) - 1;
                if (first > last) continue;
                if (axis == 0) {
                    runs.push_back({u, v, first, last});
                } else {
                    for (std::int32_t i = first; i <= last; ++i) {
                        const std::int32_t t = 2 * i + parity;
                        if (axis == 1) runs.push_back({t, u, v >> 1, v >> 1}); // (t, u, v) = (y, z, x)
                        if (axis == 2) runs.push_back({v, t, u >> 1, u >> 1}); // (t, u, v) = (z, x, y)
                    }
                }
            }
        }
    return runs;
}

NodeSet SurfaceLines::inside(const Frame& frame, double& doubtful) const {
    doubtful = 0;
    if (check_.open_edges == 0) return NodeSet(frame, runs_along(0));

    std::uint64_t lines = 0, ending_inside = 0;
    std::vector<Run> runs;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::vector<Run> more = runs_along(axis);
        runs.insert(runs.end(), more.begin(), more.end());
        for (std::size_t line = 0; line + 1 < lines_[axis].start.size(); ++line) {
            ++lines;
            ending_inside += (lines_[axis].start[line + 1] - lines_[axis].start[line]) & 1;
        }
    }
    std::uint64_t nodes = 0, unsure = 0;
    std::vector<Run> chosen;
    NodeSet(frame, std::move(runs)).for_each_node([&](std::uint32_t, const Node& node) {
        int in = 0, out = 0;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const Line line = find(axis, node);
            if ((line.end - line.begin) % 2 != 0) continue;
            const double t = axis == 0 ? node.x : axis == 1 ? node.y : node.z;
            ++((std::upper_bound(line.begin, line.end, t) - line.begin) % 2 != 0 ? in : out);
        }
        ++nodes;
        unsure += in == 0 || out != 0;
        if (in > out) chosen.push_back({node.y, node.z, node.x >> 1, node.x >> 1});
    });
    const auto share = [](std::uint64_t part, std::uint64_t all) {
        return all ? static_cast<double>(part) / static_cast<double>(all) : 0;
    };
    doubtful = std::max(share(ending_inside, lines), share(unsure, nodes));
    return NodeSet(frame, std::move(chosen));
}

double SurfaceLines::leaves(const Node& node, unsigned neighbour) const {
    const unsigned direction = neighbour / 2;
    const Line line = find(direction, node);
    const double from = direction == 1 ? node.y : direction == 2 ? node.z : node.x;
    const double length = direction < 3 ? 2 : 1;
    // The edge starts between the last toggle at or before the node and the next one.
    const double* next = std::upper_bound(line.begin, line.end, from);
    const bool forward = neighbour % 2 == 0;
    double nearest = std::numeric_limits<double>::infinity(); // along the edge; negative behind the node
    if (next != line.end) nearest = forward ? *next - from : from - *next;
    if (next != line.begin) {
        const double before = forward ? next[-1] - from : from - next[-1];
        // The toggle ahead is used. One behind is used only if rounding or a vote put it on the wrong side.
        const bool ahead = nearest >= 0 && nearest <= length;
        const bool before_ahead = before >= 0 && before <= length;
        if (before_ahead ? !ahead || before < nearest : !ahead && std::abs(before) < std::abs(nearest))
            nearest = before;
    }
    if (std::abs(nearest) > 2 * length) return 0.5; // no crossing is near because a vote has closed a hole
    return std::clamp(nearest / length, 0.0, 1.0);
}

} // namespace vox::io
