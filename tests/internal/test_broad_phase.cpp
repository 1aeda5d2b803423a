// The broad phase by itself, over plain arrays and without an engine, against loops over everything.
#include "base/parallel.hpp"
#include "fast/broad_phase.hpp"
#include "fast/stream.hpp"
#include "grid/box_lanes.hpp"
#include "internal/stage_checks.hpp"
#include "mesh/filter.hpp"

#include <array>
#include <deque>
#include <limits>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

std::pmr::memory_resource* const memory = std::pmr::get_default_resource();

// Bodies, and what the broad phase makes of them.
struct Bodies {
    std::deque<Mesh> meshes;
    std::deque<Tiles> tiles;
    std::vector<Body> bodies;
    std::vector<bool> moved;
    fast::Step step{memory};
    fast::StepBoxes boxes{memory};
    fast::StreamBuffers stream{memory};
    fast::BroadPhase broad{memory};

    Body& add(Mesh mesh, bool has_moved) {
        const Mesh& kept = meshes.emplace_back(std::move(mesh));
        tiles.push_back(tiles_of(kept));
        moved.push_back(has_moved);
        Body body;
        body.mesh_id = std::uint32_t(bodies.size() + 1);
        body.vertex_count = vertex_count(kept);
        body.positions = view(kept);
        body.tets = kept.tets;
        return bodies.emplace_back(body);
    }

    void run(Workers* workers = nullptr) {
        fast::begin_step(bodies, workers, step);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            step.of[b].tiles = &tiles[b];
            step.of[b].moved = moved[b];
        }
        fast::lay_out(step, boxes);
        fast::stream(step, boxes, stream);
        fast::find_regions(step, boxes, broad);
    }

    Box tile_box(std::size_t body, std::size_t t) const {
        Box box = empty_box;
        const Tile& tile = tiles[body].tiles[t];
        for (std::uint32_t i = 0; i < tile.vertex_count; ++i)
            vox::add(box, box_around(meshes[body].positions[tiles[body].vertices[tile.first_vertex + i]]));
        return box;
    }
    Box block_box(std::size_t body, std::size_t b) const {
        Box box = empty_box;
        for (std::uint32_t v = tiles[body].block_first[b]; v < tiles[body].block_first[b + 1]; ++v)
            vox::add(box, box_around(meshes[body].positions[v]));
        return box;
    }
    // The box found for the super-tile of a tile.
    const Box& super_tile_box(std::size_t b, std::uint32_t t) const {
        return boxes.super_tiles[step.of[b].first_super + tiles[b].super_tile_of(t)];
    }
    bool is_in_super_tile_inside(std::size_t b, std::uint32_t t, const Box& region) const {
        const Box& box = super_tile_box(b, t);
        return !is_empty(box) && contains(region, box);
    }
    bool may_collide(std::size_t a, std::size_t b) const {
        return a != b && !bodies[b].tets.empty() && collide(bodies[a], bodies[b]) && (moved[a] || moved[b]);
    }

    // The region as documented, by loops, before tiles shrink it.
    Box region_of_blocks(std::size_t a, std::size_t b) const {
        Box region = box_of(meshes[a]), covered = empty_box;
        intersect(region, box_of(meshes[b]));
        for (std::size_t i = 0; i < tiles[a].block_count(); ++i)
            if (overlap(block_box(a, i), region)) vox::add(covered, block_box(a, i));
        if (tiles[a].block_count() == 1) {
            covered = empty_box;
            for (const Vec3f& p : meshes[a].positions)
                if (overlap(box_around(p), region)) vox::add(covered, box_around(p));
        }
        intersect(region, covered);
        return region;
    }
    // The same at last; the sizes of the tiles of b that meet it are added to `size`.
    Box expected_region(std::size_t a, std::size_t b, TileSize& size) const {
        Box region = region_of_blocks(a, b), covered = empty_box;
        if (is_empty(region)) return empty_box;
        for (std::uint32_t t = 0; t < tiles[b].tiles.size(); ++t) {
            const Box box = tile_box(b, t);
            const bool is_inside = is_in_super_tile_inside(b, t, region);
            if (is_inside) vox::add(covered, super_tile_box(b, t));
            if (!overlap(box, region)) continue;
            vox::add(covered, box);
            const std::uint32_t super = tiles[b].super_tile_of(t), first = tiles[b].super_first[super];
            size.add(is_inside ? tile_box(b, first) : box);
        }
        intersect(region, covered);
        return is_empty(region) ? empty_box : region;
    }
};

bool is_inside(const Vec3f& p, const Box& box) { return overlap(box_around(p), box); }

// The regions are the documented ones, in order, and the index finds them. Returns how many are not empty.
std::size_t check_regions(const Bodies& s, const char* level) {
    const fast::BroadPhase& broad = s.broad;
    const std::size_t count = s.bodies.size();
    std::size_t next = 0, filled = 0;
    std::vector<std::vector<std::uint32_t>> of_b(count);
    for (std::uint32_t a = 0; a < count; ++a) {
        const std::size_t first = next;
        for (std::uint32_t b = 0; b < count; ++b) {
            const bool listed =
                next < broad.regions.size() && broad.regions[next].a == a && broad.regions[next].b == b;
            TileSize size;
            const Box expected = s.may_collide(a, b) ? s.expected_region(a, b, size) : empty_box;
            ck_assert_msg(listed || is_empty(expected), "%s: bodies %u, %u are missing", level, a, b);
            if (!listed) continue;
            const fast::PairRegion& found = broad.regions[next];
            ck_assert_msg(s.may_collide(a, b), "%s: bodies %u, %u do not collide", level, a, b);
            ck_assert_msg(same(found.region, expected), "%s: region of bodies %u, %u", level, a, b);
            ck_assert_double_eq(found.tile_size.count, size.count);
            ck_assert_double_eq_tol(found.tile_size.inverse_sum, size.inverse_sum,
                                    1e-9 * (size.inverse_sum + 1));
            of_b[b].push_back(std::uint32_t(next++));
            filled += !is_empty(expected);
        }
        ck_assert_uint_eq(broad.of_a(a).size(), next - first);
        ck_assert(next == first || broad.of_a(a).data() == broad.regions.data() + first);
    }
    ck_assert_uint_eq(next, broad.regions.size());
    for (std::uint32_t b = 0; b < count; ++b) {
        const std::span<const std::uint32_t> found = broad.of_b(b);
        ck_assert(std::equal(found.begin(), found.end(), of_b[b].begin(), of_b[b].end()));
        ck_assert_int_eq(broad.is_reached(b), !of_b[b].empty());
    }
    return filled;
}

// Tiles that meet a region have their box, unless the super-tile is inside; no box is wrong; super-tiles are
// in theirs, unless they are out of reach.
void check_boxes(const Bodies& s, const char* level) {
    for (std::uint32_t b = 0; b < s.bodies.size(); ++b) {
        const Tiles& tiles = s.tiles[b];
        const fast::StepBody& body = s.step.of[b];
        for (std::uint32_t t = 0; t < tiles.tiles.size(); ++t) {
            const Box expected = s.tile_box(b, t);
            const bool known = s.boxes.tile_known[body.first_tile + t];
            ck_assert_msg(!known || same(s.boxes.tiles[body.first_tile + t], expected), "%s: box of a tile",
                          level);
            const std::uint32_t super = tiles.super_tile_of(t);
            for (const std::uint32_t r : s.broad.of_b(b)) {
                if (!overlap(expected, s.broad.regions[r].region)) continue;
                const Box before = s.region_of_blocks(s.broad.regions[r].a, b);
                ck_assert_msg(known || s.is_in_super_tile_inside(b, t, before),
                              "%s: tile %u of body %u is needed", level, t, b);
                Box both = expected;
                intersect(both, s.boxes.super_tiles[body.first_super + super]);
                ck_assert_msg(same(both, expected), "%s: super-tile %u of body %u", level, super, b);
            }
        }
    }
}

// Whatever may be in contact is in a region. Returns how many vertices are.
std::size_t check_vertices(const Bodies& s, const char* level) {
    std::size_t met = 0;
    for (std::uint32_t b = 0; b < s.bodies.size(); ++b)
        for (const Tet& tet : s.meshes[b].tets) {
            Box box = empty_box;
            for (const std::uint32_t v : tet.v) add(box, box_around(s.meshes[b].positions[v]));
            for (std::uint32_t a = 0; a < s.bodies.size(); ++a) {
                if (!s.may_collide(a, b)) continue;
                const auto of_a = s.broad.of_a(a);
                const auto pair = std::find_if(of_a.begin(), of_a.end(),
                                               [&](const fast::PairRegion& r) { return r.b == b; });
                for (const Vec3f& p : s.meshes[a].positions) {
                    if (!is_inside(p, box)) continue;
                    ck_assert_msg(pair != of_a.end() && is_inside(p, pair->region),
                                  "%s: a vertex of body %u in a tet of body %u", level, a, b);
                    ++met;
                }
            }
        }
    return met;
}

// A body of some kind, somewhere.
Mesh any_body(Random& r) {
    Mesh mesh;
    const std::uint32_t kind = r.below(6);
    if (kind == 0)
        mesh = soup(r, 4 + r.below(60), r.below(60), 2, r.below(2) != 0);
    else if (kind == 1)
        mesh.positions.assign(r.below(20), {0, 0, 0}); // no tets, and perhaps no vertices
    else if (kind == 2)
        mesh = block(1 + int(r.below(20)), 1, 1);
    else
        mesh = ball(50 + r.below(800));
    if (r.below(2)) jitter(mesh, 0.2, r);
    if (r.below(3) == 0) renumber(mesh, r);
    const auto place = [&] { return double(r.below(2) ? r.uniform(-3, 3) : float(r.below(4))); };
    move(mesh, 1, place(), place(), place());
    return mesh;
}

START_TEST(regions_hold_what_may_be_in_contact) {
    Random r{11};
    std::size_t filled = 0, met = 0, rounds = 0;
    at_each_level([&](const char* level) {
        for (int round = 0; round < 25; ++round, ++rounds) {
            Bodies s;
            const std::uint32_t count = r.below(9);
            for (std::uint32_t b = 0; b < count; ++b) {
                Body& body = s.add(any_body(r), round % 3 != 0 || r.below(2));
                body.self_collision = r.below(2) != 0;
                if (round % 4 != 1) continue;
                body.filter.category = std::uint64_t{1} << r.below(3);
                body.filter.mask = r.below(8);
                body.filter.group = std::int32_t(r.below(5)) - 2;
            }
            s.run();
            filled += check_regions(s, level);
            check_boxes(s, level);
            met += check_vertices(s, level);
            // The buffers know nothing of the scene before.
            std::reverse(s.moved.begin(), s.moved.end());
            s.run();
            filled += check_regions(s, level);
            check_boxes(s, level);
        }
    });
    ck_assert_uint_gt(filled, 10 * rounds);
    ck_assert_uint_gt(met, 100 * rounds);
}
END_TEST

START_TEST(filters_and_bodies_at_rest_leave_pairs_out) {
    Bodies s;
    for (int b = 0; b < 4; ++b) {
        Mesh mesh = ball(300);
        move(mesh, 1, b, 0, 0);
        s.add(std::move(mesh), true);
    }
    const auto pairs = [&] {
        s.run();
        ck_assert_uint_eq(check_regions(s, "best"), s.broad.regions.size());
        return s.broad.regions.size();
    };
    ck_assert_uint_eq(pairs(), 12);
    s.moved = {false, false, false, true};
    ck_assert_uint_eq(pairs(), 6); // the last one with each other
    s.moved = {false, false, false, false};
    ck_assert_uint_eq(pairs(), 0);
    s.moved = {true, true, true, true};
    const std::uint32_t others[2] = {s.bodies[0].mesh_id, s.bodies[1].mesh_id},
                        last[1] = {s.bodies[2].mesh_id};
    s.bodies[2].exceptions = others;
    s.bodies[0].exceptions = s.bodies[1].exceptions = last;
    ck_assert_uint_eq(pairs(), 8);
    s.bodies[0].filter.mask = 0;
    ck_assert_uint_eq(pairs(), 4);
    s.bodies[3].tets = {};
    s.tiles[3] = Tiles(memory);
    s.tiles[3].block_first = Array<std::uint32_t>({0, s.bodies[3].vertex_count}, memory); // one block of all
    ck_assert_uint_eq(pairs(), 2); // its vertices may be in others, whose vertices cannot be in it
}
END_TEST

// Enough work for tasks of every stage.
START_TEST(workers_find_the_same) {
    Random r{13};
    Bodies s;
    for (int b = 0; b < 12; ++b) {
        double radius = 0;
        Mesh mesh = ball(24000, &radius);
        jitter(mesh, 0.1, r);
        move(mesh, 1, radius * (b % 4), radius * (b / 4 % 2), radius * (b / 8));
        s.add(std::move(mesh), true).self_collision = b % 3 == 0;
    }
    s.run();
    ck_assert_uint_gt(s.step.block_count, 8192);
    ck_assert_uint_gt(check_regions(s, "best"), 50);
    check_boxes(s, "best");
    const std::vector<fast::PairRegion> one(s.broad.regions.begin(), s.broad.regions.end());
    const std::vector<std::uint8_t> known(s.boxes.tile_known.begin(), s.boxes.tile_known.end());
    for (const std::uint32_t count : {2u, 3u}) {
        Workers workers({}, count);
        for (int round = 0; round < 3; ++round) {
            s.run(&workers);
            ck_assert_uint_eq(s.broad.regions.size(), one.size());
            for (std::size_t i = 0; i < one.size(); ++i) {
                const fast::PairRegion &found = s.broad.regions[i], &expected = one[i];
                ck_assert(found.a == expected.a && found.b == expected.b &&
                          same(found.region, expected.region));
                ck_assert_double_eq(found.tile_size.inverse_sum, expected.tile_size.inverse_sum);
            }
            ck_assert(std::equal(known.begin(), known.end(), s.boxes.tile_known.begin()));
        }
    }
}
END_TEST

// ---- sides ----------------------------------------------------------------------------------------

// Boxes have a side of a region in common when, and only when, the box around them does not reach it.
START_TEST(common_sides_are_those_of_the_box_around) {
    Random r{4};
    std::size_t out = 0, touching = 0;
    for (int round = 0; round < 20000; ++round) {
        const auto box = [&] { // of whole numbers, so that many touch
            Box made = empty_box;
            for (int a = 0; a < 3; ++a) {
                made.lo[a] = float(r.below(9));
                made.hi[a] = made.lo[a] + float(r.below(3));
            }
            made.lo[3] = made.hi[3] = std::numeric_limits<float>::quiet_NaN(); // the fourth means nothing
            return made;
        };
        const Box region = box();
        Box around = empty_box;
        unsigned common = all_sides;
        for (std::uint32_t i = 0; i < 1 + r.below(5); ++i) {
            const Box one = box();
            const unsigned sides = sides_of(one, region);
            ck_assert_int_eq(sides == 0, overlap(one, region));
            common &= sides;
            add(around, one);
        }
        ck_assert_int_eq(common == 0, overlap(around, region));
        out += common != 0;
        touching += common == 0 && around.hi[0] == region.lo[0];
    }
    ck_assert_uint_gt(out, 1000);
    ck_assert_uint_gt(touching, 100);
}
END_TEST

// Many boxes at once say what each says by itself, however many they are, at every SIMD level; empty ones,
// too.
START_TEST(sides_of_many_boxes) {
    Random r{6};
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    std::size_t overlapping = 0, with_side = 0, all = 0;
    at_each_level([&](const char* level) {
        for (std::uint32_t count = 0; count <= fast::most_boxes; ++count) {
            const auto box = [&] { // of whole numbers, so that many touch
                Box made = empty_box;
                for (int a = 0; a < 3; ++a) {
                    made.lo[a] = float(r.below(5));
                    made.hi[a] = made.lo[a] + float(r.below(4));
                }
                made.lo[3] = made.hi[3] = nan; // the fourth means nothing
                return made;
            };
            const Box region = box();
            std::vector<Box> boxes(count);
            for (Box& one : boxes) one = r.below(8) == 0 ? empty_box : box();
            std::vector<std::uint8_t> sides(count + 1, 0xee);
            fast::find_sides(boxes.data(), count, region, sides.data());
            const std::uint64_t overlaps = fast::find_overlaps(boxes.data(), count, region);
            for (std::uint32_t i = 0; i < count; ++i) {
                ck_assert_msg(sides[i] == sides_of(boxes[i], region), "%s: box %u of %u: sides %x", level, i,
                              count, unsigned{sides[i]});
                ck_assert_msg((overlaps >> i & 1) == overlap(boxes[i], region), "%s: box %u of %u", level, i,
                              count);
                overlapping += overlaps >> i & 1;
            }
            for (std::uint32_t most = 0; most < 40; ++most) { // few, as many have hardly a side in common
                std::vector<std::uint32_t> which;
                unsigned common = all_sides;
                for (std::uint32_t i = 0; count > 0 && i < most; ++i) {
                    const std::uint32_t one = i < 3 ? r.below(count) : which[r.below(3)];
                    which.push_back(one);
                    common &= sides[one];
                }
                ck_assert_uint_eq(fast::common_sides(boxes.data(), which, region), common);
                with_side += !which.empty() && common != 0;
            }
            ck_assert_uint_eq(sides[count], 0xee); // nothing is written beyond
            if (count < 64) ck_assert_uint_eq(overlaps >> count, 0);
            all += count;
        }
    });
    ck_assert_uint_gt(with_side, all / 20);
    ck_assert_uint_gt(overlapping, all / 20);
    ck_assert_uint_lt(overlapping, all / 2);
}
END_TEST

// Boxes against the faces of tiles of any size, at every SIMD level.
START_TEST(boxes_side_by_side) {
    Random r{7};
    std::size_t found_any = 0;
    at_each_level([&](const char* level) {
        for (int round = 0; round < 2000; ++round) {
            const auto box = [&] { // of whole numbers, so that many touch
                Box made = empty_box;
                for (int a = 0; a < 3; ++a) {
                    made.lo[a] = float(r.below(12));
                    made.hi[a] = made.lo[a] + float(r.below(4));
                }
                return made;
            };
            const std::uint32_t box_count = r.below(SurfaceTile::most_edges + 1),
                                face_count = r.below(SurfaceTile::most_faces + 1);
            FaceBoxes face_lanes;
            std::vector<Box> boxes, faces;
            // Lanes that are not in use hold what another tile left there.
            for (std::uint32_t f = 0; f < SurfaceTile::most_faces; ++f) face_lanes.set(f, box());
            for (std::uint32_t b = 0; b < box_count; ++b) boxes.push_back(box());
            for (std::uint32_t f = 0; f < face_count; ++f) face_lanes.set(f, faces.emplace_back(box()));
            std::vector<std::uint32_t> met(boxes.size());
            find_faces(boxes.data(), boxes.size(), face_lanes, face_count, met.data());
            for (std::uint32_t b = 0; b < box_count; ++b) {
                std::uint32_t expected = 0;
                for (std::uint32_t f = 0; f < face_count; ++f)
                    expected |= std::uint32_t{overlap(faces[f], boxes[b])} << f;
                ck_assert_msg(met[b] == expected, "%s: box %u of %u, %u faces", level, b, box_count,
                              face_count);
                found_any += expected != 0;
            }
        }
    });
    ck_assert_uint_gt(found_any, 1000);
}
END_TEST

} // namespace

SUITE(broad_phase) {
    TCase* tests = add_case(suite, "broad_phase");
    tcase_add_each(tests, regions_hold_what_may_be_in_contact, filters_and_bodies_at_rest_leave_pairs_out,
                   workers_find_the_same, common_sides_are_those_of_the_box_around, sides_of_many_boxes,
                   boxes_side_by_side);
}
