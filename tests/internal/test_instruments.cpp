// What triangles meet, still and moving, and the closest points of segments: against rational numbers, every
// tetrahedron tried.
#include <atomic>
#include <thread> // before check.h, which defines fail()

#include "exact/closest_point.hpp"
#include "exact/moving_triangle.hpp"
#include "internal/exact_queries.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

using namespace vox;
using namespace vox::test;

namespace {

using Time = Rational;

RationalPoint exact(const Vec3d& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }

RationalPoint at_time(const Vec3d& from, const Vec3d& to, const Time& t) {
    const RationalPoint way = between(from, to), begin = exact(from);
    return {begin[0] + t * way[0], begin[1] + t * way[1], begin[2] + t * way[2]};
}

// Whether non-negative x with sum(columns * x) = right exist for these columns, which are tried as the only
// ones that are not zero: if they are independent, by elimination.
bool solves(const std::vector<std::array<Rational, 5>>& columns, unsigned chosen) {
    std::vector<std::size_t> index;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (chosen >> c & 1) index.push_back(c);
    const std::size_t n = index.size();
    std::vector<std::vector<Rational>> row(5, std::vector<Rational>(n + 1));
    for (std::size_t r = 0; r < 5; ++r) {
        for (std::size_t c = 0; c < n; ++c) row[r][c] = columns[index[c]][r];
        row[r][n] = r < 3 ? 0.0 : 1.0;
    }
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t pivot = c;
        while (pivot < 5 && row[pivot][c].sign() == 0) ++pivot;
        if (pivot == 5) return false; // dependent: a smaller set does as well
        std::swap(row[c], row[pivot]);
        for (std::size_t r = 0; r < 5; ++r) {
            if (r == c || row[r][c].sign() == 0) continue;
            const Rational factor = row[r][c] / row[c][c];
            for (std::size_t k = c; k <= n; ++k) row[r][k] = row[r][k] - factor * row[c][k];
        }
    }
    for (std::size_t r = 0; r < 5; ++r) {
        if (r >= n && row[r][n].sign() != 0) return false;
        if (r < n && (row[r][n] / row[r][r]).sign() < 0) return false;
    }
    return true;
}

// Whether two convex hulls have a point in common: a linear program has a basic solution, if any.
bool meet(const std::vector<RationalPoint>& a, const std::vector<RationalPoint>& b) {
    std::vector<std::array<Rational, 5>> columns;
    for (const RationalPoint& p : a) columns.push_back({p[0], p[1], p[2], 1.0, 0.0});
    for (const RationalPoint& p : b) columns.push_back({0.0 - p[0], 0.0 - p[1], 0.0 - p[2], 0.0, 1.0});
    for (std::size_t axis = 0; axis < 3; ++axis) { // most are apart along an axis
        const auto less = [axis](const RationalPoint& p, const RationalPoint& q) {
            return p[axis] < q[axis];
        };
        const auto of_a = std::minmax_element(a.begin(), a.end(), less),
                   of_b = std::minmax_element(b.begin(), b.end(), less);
        if ((*of_a.second)[axis] < (*of_b.first)[axis] || (*of_b.second)[axis] < (*of_a.first)[axis])
            return false;
    }
    for (unsigned chosen = 1; chosen < 1u << columns.size(); ++chosen)
        if (std::popcount(chosen) <= 5 && solves(columns, chosen)) return true;
    return false;
}

struct Motion {
    std::array<Vec3d, 3> from, to;

    std::vector<RationalPoint> at(const Time& t) const {
        return {at_time(from[0], to[0], t), at_time(from[1], to[1], t), at_time(from[2], to[2], t)};
    }
    Vec3d rounded(std::size_t i, double t) const { return (1 - t) * from[i] + t * to[i]; }
};

// True if an axis is found that keeps the moving triangle and the points apart between two times.
bool stay_apart(const Motion& motion, const std::vector<Vec3d>& still, const Time& begin, const Time& end) {
    const double middle = 0.5 * begin.rounded() + 0.5 * end.rounded();
    const Vec3d moving[3] = {motion.rounded(0, middle), motion.rounded(1, middle), motion.rounded(2, middle)};
    std::vector<Vec3d> sides, others, axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < 3; ++i) sides.push_back(moving[(i + 1) % 3] - moving[i]);
    for (std::size_t i = 0; i < still.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) others.push_back(still[i] - still[j]);
    axes.push_back(cross(sides[0], sides[1]));
    for (const Vec3d& side : sides)
        for (const Vec3d& other : others) axes.push_back(cross(side, other));
    for (std::size_t i = 1; i < others.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) axes.push_back(cross(others[i], others[j]));
    for (const Vec3d& side : sides) {
        axes.push_back(cross(axes[3], side));
        for (const Vec3d& other : others) axes.push_back(cross(cross(side, other), other));
        for (const Vec3d& other : others) axes.push_back(cross(cross(side, other), side));
    }
    for (const Vec3d& p : moving)
        for (const Vec3d& q : still) axes.push_back(p - q);
    std::vector<RationalPoint> points = motion.at(begin);
    for (const RationalPoint& p : motion.at(end)) points.push_back(p);
    for (const Vec3d& axis : axes) {
        // In doubles first: most axes fail clearly.
        double high = -1e300, low = 1e300;
        for (const Vec3d& q : still) {
            high = std::max(high, dot(axis, q));
            low = std::min(low, dot(axis, q));
        }
        double least = 1e300, most = -1e300;
        for (const RationalPoint& p : points) {
            const double d = dot(axis, {p[0].rounded(), p[1].rounded(), p[2].rounded()});
            least = std::min(least, d);
            most = std::max(most, d);
        }
        const double near = 1e-6 * (std::abs(high) + std::abs(low) + std::abs(least) + std::abs(most));
        if (least < high - near && low < most - near) continue;
        const RationalPoint n = exact(axis);
        bool above = true, below = true;
        for (const Vec3d& q : still)
            for (const RationalPoint& p : points) {
                const Rational apart = dot(n, p) - dot(n, exact(q));
                above &= apart.sign() > 0;
                below &= apart.sign() < 0;
            }
        if (above || below) return true;
    }
    return false;
}

bool stay_apart_in_parts(const Motion& motion, const std::vector<Vec3d>& still, const Time& begin,
                         const Time& end, int divisions) {
    if (!(begin < end) || stay_apart(motion, still, begin, end)) return true;
    if (divisions == 0) return false;
    const Time middle = (begin + end) / Time(2);
    return stay_apart_in_parts(motion, still, begin, middle, divisions - 1) &&
           stay_apart_in_parts(motion, still, middle, end, divisions - 1);
}

std::vector<vox_triangle_hit> find_all(const OwnLocator& locator, const std::vector<Motion>& motions,
                                       bool moving) {
    std::vector<Vec3d> from, to;
    for (const Motion& motion : motions) {
        from.insert(from.end(), motion.from.begin(), motion.from.end());
        to.insert(to.end(), motion.to.begin(), motion.to.end());
    }
    const vox_positions begins = vox_double_positions(&from.data()->x, from.size()),
                        ends = vox_double_positions(&to.data()->x, to.size());
    const vox_positions* const given = moving ? &ends : nullptr;
    std::uint64_t count = 0, again = 0;
    ck_ok(vox_locator_find_triangle_hits(locator.get(), &begins, given, nullptr, nullptr, 0, &count));
    std::vector<vox_triangle_hit> hits(std::size_t(count) + 1);
    ck_ok(vox_locator_find_triangle_hits(locator.get(), &begins, given, nullptr, hits.data(), count, &again));
    ck_assert_uint_eq(count, again);
    ck_assert_uint_eq(hits.back().body, VOX_NULL_BODY);
    hits.pop_back();
    return hits;
}

struct Tally {
    std::size_t met = 0, later = 0, apart = 0, touched = 0, // for one moment
        nearly = 0, maybe_near = 0;                         // not proved
};

// The distance of a segment and a triangle: that of a point of the segment is a convex function of its place.
double distance_of(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto at = [&](double s) {
        return closest_seen_from((1 - s) * p + s * q, a, b, c).at.squared_distance;
    };
    double begin = 0, end = 1;
    for (int i = 0; i < 80; ++i) {
        const double low = begin + 0.4 * (end - begin), high = begin + 0.6 * (end - begin);
        (at(low) < at(high) ? end : begin) = at(low) < at(high) ? high : low;
    }
    return std::sqrt(std::min({at(0), at(1), at(begin)}));
}

// Checks one answer, `t` or none (2), about a moving triangle and some still points.
void check_first(const Motion& motion, const std::vector<Vec3d>& still, double t, Tally& tally) {
    std::vector<RationalPoint> points;
    for (const Vec3d& p : still) points.push_back(exact(p));
    const auto meets_at = [&](const Time& when) { return meet(motion.at(when), points); };
    ck_assert_int_eq(meets_at(Time(0)), t == 0);
    if (t == 0) {
        ++tally.met;
        return;
    }
    for (const double when : {0.25, 0.5, 0.75, 1.0})
        if (meets_at(Time(when))) ck_assert_double_le(t, when);
    if (t == 2) {
        ++tally.apart;
        tally.maybe_near += !stay_apart_in_parts(motion, still, Time(0), Time(1), 8);
        return;
    }
    ++tally.later;
    const double before = std::nextafter(t, 0), after = std::nextafter(t, 2);
    const Time earliest = (Time(before) + Time(t)) / Time(2), latest = (Time(after) + Time(t)) / Time(2);
    ck_assert(!meets_at(Time(before)));
    ck_assert(!meets_at(Time(0.5 * t)));
    tally.maybe_near += !stay_apart_in_parts(motion, still, Time(0), Time(t - 1e-3 * t), 8);
    if (meets_at(t < 1 ? latest : Time(1))) return;
    // It only touches, at a time that may be a simple fraction.
    for (int under = 1; under <= 64; ++under) {
        const double over = std::round(t * under);
        const Time when = Time(over) / Time(double(under));
        if (!(when < earliest) && !(latest < when) && meets_at(when)) return void(++tally.touched);
    }
    double distance = 1;
    for (const Vec3d& p : still)
        for (const Vec3d& q : still)
            distance = std::min(distance, distance_of(p, q, motion.rounded(0, t), motion.rounded(1, t),
                                                      motion.rounded(2, t)));
    ck_assert_double_lt(distance, 1e-7);
    ++tally.nearly;
}

void check_edges(const std::vector<vox_triangle_hit>& hits, const QueryDefinition& mesh) {
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::pair<bool, double>> known;
    for (const vox_triangle_hit& hit : hits)
        for (std::size_t e = 0; e < 6; ++e) {
            const Tet& tet = mesh.tets()[hit.tet];
            const auto [low, high] = std::minmax(tet.v[edge_corners[e][0]], tet.v[edge_corners[e][1]]);
            const std::pair<bool, double> its{(hit.edges >> e & 1) != 0, hit.s[e]};
            const auto [at, is_new] = known.insert({{hit.triangle, low, high}, its});
            ck_assert(at->second == its);
            ck_assert(its.first ? its.second >= 0 && its.second <= 1 : its.second == 0);
        }
}

void check_proved(const Tally& tally) {
    ck_assert_uint_le(tally.maybe_near, (tally.later + tally.apart) / 50);
    ck_assert_uint_le(tally.nearly, tally.later / 10);
}

Tally check_triangles(const QueryDefinition& mesh, const std::vector<Motion>& motions, bool moving) {
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of({mesh}, ids);
    const std::vector<vox_triangle_hit> hits = find_all(locator, motions, moving);
    ck_assert(std::is_sorted(hits.begin(), hits.end(), [](const auto& x, const auto& y) {
        return std::tie(x.triangle, x.t, x.tet) < std::tie(y.triangle, y.t, y.tet);
    }));
    check_edges(hits, mesh);
    std::map<std::pair<std::uint32_t, std::uint32_t>, vox_triangle_hit> by_tet;
    for (const vox_triangle_hit& hit : hits) by_tet[{hit.triangle, hit.tet}] = hit;
    ck_assert_uint_eq(by_tet.size(), hits.size());
    Tally tally, of_edges;
    for (std::uint32_t i = 0; i < motions.size(); ++i) {
        Motion motion = motions[i];
        if (!moving) motion.to = motion.from;
        for (std::uint32_t tet = 0; tet < mesh.tets().size(); ++tet) {
            std::vector<Vec3d> still;
            for (std::size_t c = 0; c < 4; ++c) still.push_back(mesh.corner(tet, c));
            const auto found = by_tet.find({i, tet});
            check_first(motion, still, found == by_tet.end() ? 2 : found->second.t, tally);
            if (found == by_tet.end()) continue;
            for (std::size_t e = 0; e < 6; ++e) { // as a flat tetrahedron, that says when
                const Vec3d &p = still[edge_corners[e][0]], &q = still[edge_corners[e][1]];
                const Vec3d* const ends[4] = {&p, &q, &q, &q};
                const TetMeeting meeting =
                    MovingTriangle(motion.from.data(), motion.to.data()).meet(ends, {0, 1, 1, 1});
                ck_assert_int_eq(meeting.any, found->second.edges >> e & 1);
                check_first(motion, {p, q}, meeting.any ? meeting.t : 2, of_edges);
            }
        }
    }
    check_proved(of_edges);
    return tally;
}

Vec3d lattice_point(Random& random, int side) {
    const auto one = [&] { return double(random.below(std::uint32_t(2 * side + 1))) / 2 - 0.5 * side + 0.5; };
    return {one(), one(), one()};
}

// Triangles near a mesh, half of them on a lattice; some are segments or points.
std::vector<Motion> motions_in(const QueryDefinition& mesh, Random& random, std::size_t count, double size) {
    std::vector<Motion> motions;
    for (std::size_t i = 0; i < count; ++i) {
        Motion motion;
        const Vec3d centre = mesh.positions()[random.below(std::uint32_t(mesh.positions().size()))];
        const Vec3d step = i % 2 ? lattice_point(random, 1) : random_vector(random, size);
        for (std::size_t c = 0; c < 3; ++c) {
            motion.from[c] = i % 2 ? centre + lattice_point(random, 2) : centre + random_vector(random, size);
            // As one, or each by itself.
            motion.to[c] = motion.from[c] + step;
            if (i % 3 == 0)
                motion.to[c] =
                    motion.to[c] + (i % 2 ? lattice_point(random, 1) : random_vector(random, size));
        }
        const auto join = [&motion](std::size_t from, std::size_t to) {
            motion.from[to] = motion.from[from];
            motion.to[to] = motion.to[from];
        };
        if (i % 5 == 4) join(random.below(2), 2);
        if (i % 15 == 14) {
            join(0, 1);
            join(0, 2);
        }
        if (i % 7 == 6) motion.from[0] = motion.from[1] + (motion.from[2] - motion.from[1]); // on one line
        motions.push_back(motion);
    }
    return motions;
}

QueryDefinition with_flat_tets(const QueryDefinition& mesh, Random& random) {
    std::vector<Tet> tets = mesh.tets();
    for (int i = 0; i < 4; ++i) {
        Tet flat = tets[random.below(std::uint32_t(tets.size()))];
        for (int c = 0; c <= i; ++c) flat.v[c] = flat.v[3 - c / 2];
        tets.push_back(flat);
    }
    std::vector<Vec3d> positions = mesh.positions();
    const auto n = std::uint32_t(positions.size());
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0.5, 0.5, 0}})
        positions.push_back(p); // flat, with four corners
    tets.push_back({{n, n + 1, n + 2, n + 3}});
    return {positions, tets};
}

std::size_t usual_count(std::uint64_t usual) { return std::size_t(volume_from("VOX_INSTRUMENTS", usual)); }

START_TEST(still_triangles) {
    Random random{1};
    const QueryDefinition cubes = with_flat_tets(definition_of(kuhn_block(2, 2, 1, {0, 0, 0}, 1)), random);
    const Tally tally = check_triangles(cubes, motions_in(cubes, random, usual_count(60), 1), false);
    ck_assert_uint_gt(tally.met, usual_count(60));
    ck_assert_uint_gt(tally.apart, usual_count(60));
}
END_TEST

START_TEST(moving_triangles) {
    Random random{2};
    const QueryDefinition cubes = with_flat_tets(definition_of(kuhn_block(2, 1, 1, {0, 0, 0}, 1)), random);
    const Tally tally = check_triangles(cubes, motions_in(cubes, random, usual_count(60), 1), true);
    ck_assert_uint_gt(tally.later, usual_count(60));
    check_proved(tally);
}
END_TEST

START_TEST(bad_shapes) {
    Random random{3};
    for (const Shape shape :
         {Shape::needles, Shape::coincident, Shape::flat, Shape::lines, Shape::tiny, Shape::far}) {
        const QueryDefinition soup = make_soup(random, shape, 12);
        std::vector<Motion> motions;
        while (motions.size() < usual_count(12)) {
            Motion motion;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto place = [&] {
                    return soup.positions()[random.below(std::uint32_t(soup.positions().size()))];
                };
                motion.from[c] = place();
                motion.to[c] = place();
            }
            motions.push_back(motion);
        }
        std::vector<vox_body> ids;
        const OwnLocator locator = locator_of({soup}, ids);
        std::map<std::pair<std::uint32_t, std::uint32_t>, double> first;
        for (const vox_triangle_hit& hit : find_all(locator, motions, true))
            first[{hit.triangle, hit.tet}] = hit.t;
        for (std::uint32_t i = 0; i < motions.size(); ++i)
            for (std::uint32_t tet = 0; tet < soup.tets().size(); ++tet) {
                std::vector<RationalPoint> still;
                for (std::size_t c = 0; c < 4; ++c) still.push_back(exact(soup.corner(tet, c)));
                const auto found = first.find({i, tet});
                const double t = found == first.end() ? 2 : found->second;
                ck_assert_int_eq(meet(motions[i].at(Time(0)), still), t == 0);
                for (const double when : {0.25, 0.5, 1.0})
                    if (meet(motions[i].at(Time(when)), still)) ck_assert_double_le(t, when);
                if (t > 0 && t <= 1) ck_assert(!meet(motions[i].at(Time(std::nextafter(t, 0))), still));
            }
    }
}
END_TEST

// The closest points of segments, by search along the segment for each facet.
START_TEST(segments) {
    Random random{4};
    Mesh mesh = jittered(ball(400), random, 0.2);
    const QueryDefinition round = definition_of(mesh),
                          cubes = definition_of(kuhn_block(2, 2, 2, {0, 0, 0}, 1));
    for (const QueryDefinition* body : {&round, &cubes}) {
        std::vector<vox_body> ids;
        const OwnLocator locator = locator_of({*body}, ids);
        std::vector<Vec3d> from, to;
        const bool on_lattice = body == &cubes;
        for (std::size_t i = 0; i < usual_count(120); ++i) {
            const Vec3d centre = body->positions()[random.below(std::uint32_t(body->positions().size()))];
            from.push_back(on_lattice ? centre + lattice_point(random, 2)
                                      : 0.8 * centre + random_vector(random, 1));
            to.push_back(on_lattice   ? from.back() + lattice_point(random, 2)
                         : i % 8 == 0 ? from.back()
                                      : from.back() + random_vector(random, 0.5));
        }
        const vox_positions begins = vox_double_positions(&from[0].x, from.size()),
                            ends = vox_double_positions(&to[0].x, to.size());
        std::vector<vox_closest_hit> hits(from.size()), near(from.size()), points(from.size());
        ck_ok(vox_locator_find_closest_to_segments(locator.get(), &begins, &ends, nullptr, hits.data()));
        vox_query_desc desc = vox_default_query_desc();
        desc.max_distance = 0.25;
        ck_ok(vox_locator_find_closest_to_segments(locator.get(), &begins, &ends, &desc, near.data()));
        ck_ok(vox_locator_find_closest(locator.get(), &begins, nullptr, points.data()));
        std::size_t crossing = 0, inner = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            double wanted = 1e300;
            bool meets = false;
            for (const auto& [tet, facet] : body->surface()) {
                const Vec3d corner[3] = {body->corner(tet, facet_corners[facet][0]),
                                         body->corner(tet, facet_corners[facet][1]),
                                         body->corner(tet, facet_corners[facet][2])};
                wanted = std::min(wanted, distance_of(from[i], to[i], corner[0], corner[1], corner[2]));
                if (wanted < 1e-6)
                    meets |= meet({exact(from[i]), exact(to[i])},
                                  {exact(corner[0]), exact(corner[1]), exact(corner[2])});
            }
            const vox_closest_hit& hit = hits[i];
            ck_assert_uint_eq(hit.body, ids[0]);
            ck_assert_int_eq(hit.distance == 0, meets);
            ck_assert_double_eq_tol(std::abs(hit.distance), wanted, 1e-6);
            ck_assert_uint_eq(hit.inside, points[i].inside);
            if (!meets) ck_assert_int_eq(hit.distance<0, hit.inside> 0);
            const Vec3d position = vector_of(hit.position);
            const double back = distance_of(from[i], to[i], position, position, position);
            ck_assert_double_eq_tol(back, std::abs(hit.distance), 1e-6);
            ck_assert_int_eq(near[i].body == ids[0], std::abs(hit.distance) <= 0.25);
            if (near[i].body != VOX_NULL_BODY) ck_assert_mem_eq(&near[i], &hit, sizeof hit);
            vox_closest_hit alone{};
            const vox_positions begin = vox_double_positions(&from[i].x, 1),
                                end = vox_double_positions(&to[i].x, 1);
            ck_ok(vox_locator_find_closest_to_segments(locator.get(), &begin, &end, nullptr, &alone));
            ck_assert_mem_eq(&alone, &hit, sizeof hit);
            crossing += meets;
            inner += hit.distance < 0;
        }
        ck_assert_uint_gt(crossing, from.size() / 10);
        if (!on_lattice) ck_assert_uint_gt(inner, 0);
    }
}
END_TEST

// A tool's thread asks the newest locator while the grid steps.
START_TEST(asked_while_the_grid_steps) {
    Random random{5};
    Mesh mesh = jittered(ball(2000), random, 0.1);
    vox_grid* grid = engine_grid();
    vox_mesh_desc desc = vox_default_mesh_desc();
    std::vector<Vec3d> positions(mesh.positions.begin(), mesh.positions.end());
    desc.positions = vox_double_positions(&positions[0].x, positions.size());
    desc.tets = mesh.tets.front().v;
    desc.tet_count = mesh.tets.size();
    insert_mesh(grid, &desc);
    vox_locator* const locator = take_locator(grid);
    const auto ask = [locator](std::vector<vox_triangle_hit>& hits, vox_closest_hit& closest) {
        const Vec3d from[3] = {{-9, 0.1, 0}, {9, 0.2, 0.1}, {0, 0.3, 9}},
                    to[3] = {{-9, 1, 0}, {9, 0, 0.1}, {1, 2, 9}};
        const vox_positions begin = vox_double_positions(&from[0].x, 3),
                            end = vox_double_positions(&to[0].x, 3);
        std::uint64_t count = 0;
        const bool good =
            vox_locator_find_triangle_hits(locator, &begin, &end, nullptr, hits.data(), hits.size(),
                                           &count) == VOX_OK &&
            vox_locator_find_closest_to_segments(locator, &begin, &end, nullptr, &closest) == VOX_OK;
        return good ? count : 0;
    };
    std::vector<vox_triangle_hit> wanted(10000);
    vox_closest_hit closest[3];
    const std::uint64_t count = ask(wanted, closest[0]);
    ck_assert_uint_gt(count, 10);
    ck_assert_uint_le(count, wanted.size());
    std::atomic<bool> ends = false;
    std::atomic<int> wrong = 0, asked = 0;
    std::thread tool([&] {
        std::vector<vox_triangle_hit> hits(10000);
        vox_closest_hit found[3];
        while (!ends || asked == 0) {
            const std::uint64_t again = ask(hits, found[0]);
            wrong += again != count || std::memcmp(hits.data(), wanted.data(), count * sizeof hits[0]) != 0 ||
                     std::memcmp(found, closest, sizeof found) != 0;
            ++asked;
        }
    });
    for (int step = 0; step < 20; ++step) {
        ck_ok(vox_grid_step(grid));
        vox_locator* next = nullptr;
        ck_ok(vox_grid_update_locator(grid, &next));
        vox_locator_release(next);
    }
    ends = true;
    tool.join();
    ck_assert_int_eq(wrong, 0);
    vox_grid_destroy(grid);
    vox_locator_release(locator);
}
END_TEST

START_TEST(errors) {
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of({definition_of(kuhn_block(1, 1, 1, {0, 0, 0}, 1))}, ids);
    const Vec3d corners[4] = {{-1, 0.5, 0.25}, {2, 0.5, 0.25}, {0, 1, 2}, {0, 0, NAN}};
    const vox_positions two = vox_double_positions(&corners[0].x, 2),
                        three = vox_double_positions(&corners[0].x, 3),
                        bad = vox_double_positions(&corners[1].x, 3);
    std::uint64_t count = 77;
    const auto triangles = [&](const vox_positions* from, const vox_positions* to) {
        return vox_locator_find_triangle_hits(locator.get(), from, to, nullptr, nullptr, 0, &count);
    };
    ck_fails(triangles(&two, nullptr), VOX_ERROR_INVALID_ARGUMENT,
             "from.count is 2, expected a multiple of 3");
    ck_fails(triangles(&three, &two), VOX_ERROR_INVALID_ARGUMENT, "from.count is 3, to.count is 2");
    ck_fails(triangles(&three, &bad), VOX_ERROR_NON_FINITE, "to: position 2");
    ck_fails(vox_locator_find_triangle_hits(locator.get(), &three, nullptr, nullptr, nullptr, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "hits");
    ck_assert_uint_eq(count, 77);
    ck_ok(triangles(&three, nullptr));
    ck_assert_uint_gt(count, 0);
    const vox_query_desc none = query_of(0, ids[0]);
    ck_ok(vox_locator_find_triangle_hits(locator.get(), &three, nullptr, &none, nullptr, 0, &count));
    ck_assert_uint_eq(count, 0);
    vox_closest_hit hits[3];
    ck_fails(vox_locator_find_closest_to_segments(locator.get(), &three, &two, nullptr, hits),
             VOX_ERROR_INVALID_ARGUMENT, "from.count is 3, to.count is 2");
    ck_ok(vox_locator_find_closest_to_segments(locator.get(), &two, &two, &none, hits));
    ck_assert_uint_eq(hits[0].body, VOX_NULL_BODY);
}
END_TEST

} // namespace

SUITE(instruments) {
    tcase_add_each(add_case(suite, "instruments"), still_triangles, moving_triangles, bad_shapes, segments,
                   asked_while_the_grid_steps, errors);
}
