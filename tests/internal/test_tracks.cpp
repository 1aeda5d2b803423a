// The tetrahedra that segments pass through, by definition: rational numbers, every tetrahedron tried.
#include <thread> // before check.h, which defines fail()

#include "base/simd.hpp"
#include "internal/exact_queries.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <vector>

using namespace vox;
using namespace vox::test;

namespace {

bool is_same(const Rational& a, const Rational& b) { return !(a < b) && !(b < a); }

// The nearest double, the even one of two, for values in [0, 1].
double nearest(const Rational& value) {
    const double low = value.rounded(), high = std::nextafter(low, 2); // GMP rounds down
    const Rational middle = (Rational(low) + Rational(high)) / Rational(2);
    if (is_same(middle, value)) return (std::bit_cast<std::uint64_t>(low) & 1) != 0 ? high : low;
    return value < middle ? low : high;
}

struct WantedPiece {
    std::uint32_t tet, facet_in = VOX_NONE, facet_out = VOX_NONE;
    bool within = false;
    Rational t_in = 0.0, t_out = 1.0;
};

// The part of a segment in a closed tetrahedron; false if it has no length.
bool find_chord(const Vec3d& from, const Vec3d& to, const QueryDefinition& mesh, WantedPiece& piece) {
    Vec3d corner[4], low = from, high = from;
    for (std::size_t i = 0; i < 4; ++i) {
        corner[i] = mesh.corner(piece.tet, i);
        low = i == 0 ? corner[0] : min(low, corner[i]);
        high = i == 0 ? corner[0] : max(high, corner[i]);
    }
    const Vec3d least = min(from, to), most = max(from, to);
    if (least.x > high.x || least.y > high.y || least.z > high.z || most.x < low.x || most.y < low.y ||
        most.z < low.z)
        return false;
    const Rational all = volume(corner[0], corner[1], corner[2], corner[3]);
    if (all.sign() == 0) return false;
    for (std::uint32_t i = 0; i < 4; ++i) {
        const auto weight_of = [&](const Vec3d& p) {
            Vec3d with[4] = {corner[0], corner[1], corner[2], corner[3]};
            with[i] = p;
            return volume(with[0], with[1], with[2], with[3]) / all;
        };
        const Rational before = weight_of(from), after = weight_of(to);
        if (before.sign() <= 0 && after.sign() <= 0) {
            if (before.sign() < 0 || after.sign() < 0) return false;
            piece.within = true;
            continue;
        }
        if (before.sign() >= 0 && after.sign() >= 0) continue;
        const Rational t = before / (before - after);
        if (before.sign() < 0 && piece.t_in < t) {
            piece.t_in = t;
            piece.facet_in = i;
        } else if (after.sign() < 0 && t < piece.t_out) {
            piece.t_out = t;
            piece.facet_out = i;
        }
    }
    return piece.t_in < piece.t_out;
}

std::vector<WantedPiece> wanted_pieces(const Vec3d& from, const Vec3d& to, const QueryDefinition& mesh) {
    std::vector<WantedPiece> chords, wanted;
    std::vector<Rational> borders;
    if (from.x == to.x && from.y == to.y && from.z == to.z) return wanted;
    for (std::uint32_t tet = 0; tet < mesh.tets().size(); ++tet) {
        WantedPiece piece{tet};
        if (!find_chord(from, to, mesh, piece)) continue;
        chords.push_back(piece);
        borders.push_back(piece.t_in);
        borders.push_back(piece.t_out);
        if (!piece.within) wanted.push_back(piece);
    }
    std::sort(borders.begin(), borders.end());
    const std::size_t first = wanted.size();
    for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
        const WantedPiece* lowest = nullptr;
        bool is_inside = !(borders[b] < borders[b + 1]);
        for (const WantedPiece& chord : chords) {
            if (borders[b] < chord.t_in || chord.t_out < borders[b + 1]) continue;
            is_inside |= !chord.within;
            if (!lowest) lowest = &chord;
        }
        if (is_inside || !lowest) continue;
        if (wanted.size() == first || wanted.back().tet != lowest->tet ||
            !is_same(wanted.back().t_out, borders[b])) {
            wanted.push_back(*lowest);
            wanted.back().t_in = borders[b];
            if (lowest->t_in < borders[b]) wanted.back().facet_in = VOX_NONE;
        }
        wanted.back().t_out = borders[b + 1];
        wanted.back().facet_out = borders[b + 1] < lowest->t_out ? VOX_NONE : lowest->facet_out;
    }
    return wanted;
}

struct Segments {
    std::vector<Vec3d> from, to;

    void add(const Vec3d& a, const Vec3d& b) {
        from.push_back(a);
        to.push_back(b);
    }
};

std::vector<vox_track_piece> find_all(const OwnLocator& locator, const Segments& of) {
    const vox_positions from = vox_double_positions(&of.from.data()->x, of.from.size()),
                        to = vox_double_positions(&of.to.data()->x, of.to.size());
    std::uint64_t count = 0, again = 0;
    ck_ok(vox_locator_find_tracks(locator.get(), &from, &to, nullptr, nullptr, 0, &count));
    std::vector<vox_track_piece> pieces(std::size_t(count) + 1);
    ck_ok(vox_locator_find_tracks(locator.get(), &from, &to, nullptr, pieces.data(), count, &again));
    ck_assert_uint_eq(count, again);
    ck_assert_uint_eq(pieces.back().body, VOX_NULL_BODY);
    pieces.pop_back();
    return pieces;
}

// Some segments one by one, others together, give the same.
void check_alone(const OwnLocator& locator, const Segments& segments,
                 const std::vector<vox_track_piece>& pieces) {
    std::vector<vox_track_piece> alone;
    for (std::uint32_t i = 0; i < segments.from.size(); ++i)
        for (vox_track_piece& piece : find_all(locator, {{segments.from[i]}, {segments.to[i]}})) {
            piece.segment = i;
            alone.push_back(piece);
        }
    ck_assert_uint_eq(alone.size(), pieces.size());
    for (std::size_t i = 0; i < alone.size(); ++i) ck_assert_mem_eq(&alone[i], &pieces[i], sizeof alone[i]);
}

void check_tracks(const std::vector<QueryDefinition>& meshes, const Segments& segments) {
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of(meshes, ids);
    const std::vector<vox_track_piece> pieces = find_all(locator, segments);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < segments.from.size(); ++i)
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            std::vector<vox_track_piece> wanted;
            bool stretches = false; // the last one is a stretch in a facet
            for (const WantedPiece& piece : wanted_pieces(segments.from[i], segments.to[i], meshes[m])) {
                wanted.push_back({i, ids[m], piece.tet, piece.facet_in, piece.facet_out, 0,
                                  nearest(piece.t_in), nearest(piece.t_out)});
                // Rounded, a stretch in a facet may be a point, which is none, and so may be what parts two.
                vox_track_piece& last = wanted.back();
                if (!piece.within) continue;
                if (last.t_in == last.t_out) {
                    wanted.pop_back();
                } else if (stretches && (&last)[-1].tet == last.tet && (&last)[-1].t_out == last.t_in) {
                    (&last)[-1].t_out = last.t_out;
                    (&last)[-1].facet_out = last.facet_out;
                    wanted.pop_back();
                } else {
                    stretches = true;
                }
            }
            std::sort(wanted.begin(), wanted.end(), [](const vox_track_piece& x, const vox_track_piece& y) {
                return std::tie(x.t_in, x.t_out, x.tet) < std::tie(y.t_in, y.t_out, y.tet);
            });
            for (const vox_track_piece& piece : wanted) {
                ck_assert_uint_lt(next, pieces.size());
                ck_assert_mem_eq(&pieces[next], &piece, sizeof piece);
                ++next;
            }
        }
    ck_assert_uint_eq(next, pieces.size());
    check_alone(locator, segments, pieces);
}

// Half of them through vertices, along edges and in facets.
Segments segments_in(const QueryDefinition& mesh, Random& random, std::size_t count) {
    Segments segments;
    while (segments.from.size() < count) {
        const std::uint32_t tet = random.below(std::uint32_t(mesh.tets().size())),
                            other = random.below(std::uint32_t(mesh.tets().size()));
        const auto corner = [&] { return mesh.corner(tet, random.below(4)); };
        const Vec3d a = mesh.corner(tet, 0), b = mesh.corner(tet, 1), c = mesh.corner(tet, 2),
                    d = mesh.corner(tet, 3), e = mesh.corner(other, random.below(4));
        const Vec3d p = 0.25 * a + 0.25 * b + 0.25 * c + 0.25 * d + 0.1 * random_vector(random, 1);
        switch (segments.from.size() % 12) {
        case 0:
            segments.add(a, b); // an edge
            break;
        case 1:
            segments.add(a - (b - a), b + (b - a)); // along it, beyond both ends
            break;
        case 2:
            segments.add(2 * a - e, e); // from vertex to vertex through a vertex
            break;
        case 3:
            segments.add(0.5 * a + 0.5 * b, 2 * c - a); // in a facet
            break;
        case 4:
            segments.add(a, e);
            break;
        case 5:
            segments.add(corner() + 0.5 * (a - b), corner() + 0.5 * (c - d));
            break;
        default:
            segments.add(p, p + random_vector(random, std::ldexp(1.0, int(random.below(8)) - 4)));
            break;
        case 7:
            segments.add(p, 4 * (p - e) + e);
            break;
        case 8:
            segments.add(a, random.below(8) ? p : a); // some without length
            break;
        case 9:
            segments.add(p, e);
            break;
        }
    }
    return segments;
}

std::size_t usual_count(std::uint64_t usual) { return std::size_t(volume_from("VOX_TRACKS", usual)); }

START_TEST(by_definition) {
    Random random{1};
    const QueryDefinition cubes = definition_of(kuhn_block(3, 3, 2, {0.5, 0.5, 0.5}, 0.5));
    const QueryDefinition near = definition_of(kuhn_block(2, 2, 2, {2, 0.5, 0.5}, 0.5)); // they share a side
    check_tracks({cubes}, segments_in(cubes, random, usual_count(240)));
    check_tracks({cubes, near}, segments_in(near, random, usual_count(120)));
    const QueryDefinition round = definition_of(jittered(ball(500), random, 0.2));
    check_tracks({round}, segments_in(round, random, usual_count(240)));
    std::vector<Vec3d> moved = round.positions();
    for (Vec3d& p : moved) p = p + random_vector(random, 1e-3);
    check_tracks({{moved, round.tets()}}, segments_in({moved, round.tets()}, random, usual_count(120)));
    for (Vec3d& p : moved) p = p + random_vector(random, 1); // inverted ones, which overlap
    check_tracks({{moved, round.tets()}}, segments_in({moved, round.tets()}, random, usual_count(60)));
}
END_TEST

// A mesh of parts that touch or overlap and share no vertices, with doubled and flat tetrahedra.
START_TEST(parts) {
    Random random{2};
    Mesh mesh = kuhn_block(2, 2, 2, {0, 0, 0}, 0.5);
    append(mesh, kuhn_block(2, 2, 2, {1, 0.25, 0}, 0.5));
    append(mesh, kuhn_block(1, 1, 1, {0.25, 0.25, 1}, 0.5));
    append(mesh, kuhn_block(1, 1, 1, {0.5, 0.5, 0.5}, 1));
    for (int i = 0; i < 5; ++i) {
        mesh.tets.push_back(mesh.tets[random.below(std::uint32_t(mesh.tets.size()))]);
        Tet flat = mesh.tets[random.below(std::uint32_t(mesh.tets.size()))];
        flat.v[0] = flat.v[1 + random.below(3)];
        mesh.tets.push_back(flat);
    }
    for (int round = 0; round < 3; ++round) {
        check_tracks({definition_of(mesh)}, segments_in(definition_of(mesh), random, usual_count(120)));
        renumber(mesh, random);
    }
}
END_TEST

START_TEST(bad_shapes) {
    Random random{3};
    for (int shape = 0; shape < shape_count; ++shape) {
        if (Shape(shape) == Shape::huge) continue; // differences of segments overflow
        const QueryDefinition soup = make_soup(random, Shape(shape), 40);
        check_tracks({soup}, segments_in(soup, random, usual_count(60)));
    }
}
END_TEST

// Many segments at once, in a mesh of many tetrahedra: as each alone, without gaps in a convex mesh.
START_TEST(many) {
    Random random{4};
    const Mesh mesh = kuhn_block(8, 8, 8, {0, 0, 0}, 1);
    Mesh inner = mesh;
    for (Vec3f& p : inner.positions)
        for (float* x : {&p.x, &p.y, &p.z})
            if (*x > 0 && *x < 8) *x += random.uniform(-0.2f, 0.2f); // the sides stay plane
    for (const Mesh& of : {mesh, inner}) {
        const QueryDefinition cube = definition_of(of);
        std::vector<vox_body> ids;
        const OwnLocator locator = locator_of({cube}, ids);
        const Segments segments = segments_in(cube, random, 10 * usual_count(240));
        const std::vector<vox_track_piece> pieces = find_all(locator, segments);
        check_alone(locator, segments, pieces);
        for (const simd::Level level : {simd::Level::portable, simd::Level::sse4, simd::Level::avx2}) {
            simd::force_level(level);
            const std::vector<vox_track_piece> again = find_all(locator, segments);
            ck_assert_uint_eq(again.size(), pieces.size());
            ck_assert_mem_eq(again.data(), pieces.data(), pieces.size() * sizeof pieces[0]);
        }
        simd::force_level(simd::best_level());
        for (std::size_t i = 1; i < pieces.size(); ++i)
            if (pieces[i].segment == pieces[i - 1].segment) ck_assert(pieces[i].t_in == pieces[i - 1].t_out);
    }
}
END_TEST

// The first call of a locator finds what is across facets; several threads may make it.
START_TEST(threads_ask_first) {
    Random random{5};
    const QueryDefinition cube = definition_of(kuhn_block(4, 4, 4, {0, 0, 0}, 1));
    const Segments segments = segments_in(cube, random, 400);
    std::vector<vox_body> ids;
    const std::vector<vox_track_piece> expected = find_all(locator_of({cube}, ids), segments);
    for (int round = 0; round < 5; ++round) {
        const OwnLocator locator = locator_of({cube}, ids);
        std::vector<std::vector<vox_track_piece>> found(4, std::vector<vox_track_piece>(expected.size()));
        std::uint64_t counts[4] = {};
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < found.size(); ++t)
            threads.emplace_back([&, t] {
                const vox_positions from = vox_double_positions(&segments.from[0].x, segments.from.size()),
                                    to = vox_double_positions(&segments.to[0].x, segments.to.size());
                (void)vox_locator_find_tracks(locator.get(), &from, &to, nullptr, found[t].data(),
                                              found[t].size(), &counts[t]);
            });
        for (std::thread& thread : threads) thread.join();
        for (std::size_t t = 0; t < found.size(); ++t) {
            ck_assert_uint_eq(counts[t], expected.size());
            for (std::size_t i = 0; i < expected.size(); ++i) {
                vox_track_piece piece = found[t][i];
                piece.body = expected[i].body; // of another grid
                ck_assert_mem_eq(&piece, &expected[i], sizeof piece);
            }
        }
    }
}
END_TEST

START_TEST(errors) {
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of({definition_of(kuhn_block(1, 1, 1, {0, 0, 0}, 1))}, ids);
    const Vec3d ends[2] = {{-1, 0.5, 0.25}, {2, 0.5, 0.25}};
    const vox_positions one = vox_double_positions(&ends[0].x, 1), two = vox_double_positions(&ends[0].x, 2),
                        other = vox_double_positions(&ends[1].x, 1);
    std::uint64_t count = 77;
    ck_fails(vox_locator_find_tracks(locator.get(), &one, &two, nullptr, nullptr, 0, &count),
             VOX_ERROR_INVALID_ARGUMENT, "from.count is 1, to.count is 2");
    ck_fails(vox_locator_find_tracks(locator.get(), &one, &other, nullptr, nullptr, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "pieces");
    ck_fails(vox_locator_find_tracks(locator.get(), &one, &other, nullptr, nullptr, 0, nullptr),
             VOX_ERROR_INVALID_ARGUMENT, "out_count");
    ck_assert_uint_eq(count, 77);
    const vox_query_desc none = query_of(0, ids[0]);
    ck_ok(vox_locator_find_tracks(locator.get(), &one, &other, &none, nullptr, 0, &count));
    ck_assert_uint_eq(count, 0);
    ck_ok(vox_locator_find_tracks(locator.get(), &one, &other, nullptr, nullptr, 0, &count));
    ck_assert_uint_gt(count, 0);
}
END_TEST

} // namespace

SUITE(tracks) {
    tcase_add_each(add_case(suite, "tracks"), by_definition, parts, bad_shapes, many, threads_ask_first,
                   errors);
}
