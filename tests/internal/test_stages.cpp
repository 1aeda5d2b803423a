// Stages of the fast engine by themselves, over plain arrays, against loops over everything: tiles, stream
// and indices. The broad phase is in test_broad_phase.cpp, windows and the lookup in test_windows.cpp,
// surface and winding numbers in test_winding.cpp.
#include "fast/stream.hpp"
#include "internal/stage_checks.hpp"

#include <cfloat>
#include <limits>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

// ---- tiles ----------------------------------------------------------------------------------------

void check_blocks(const Mesh& mesh, const Tiles& tiles, const char* name) {
    if (mesh.positions.empty()) {
        ck_assert_uint_eq(tiles.block_count(), 0);
        ck_assert_uint_eq(tiles.super_tile_count(), 0);
        return;
    }
    const auto& first = tiles.block_first;
    ck_assert_uint_eq(first.front(), 0);
    ck_assert_uint_eq(first.back(), vertex_count(mesh));
    std::vector<std::uint32_t> block_of(mesh.positions.size());
    for (std::uint32_t b = 0; b < tiles.block_count(); ++b) {
        ck_assert_msg(first[b] < first[b + 1] && first[b + 1] - first[b] <= block_size,
                      "%s: block %u is vertices %u to %u", name, b, first[b], first[b + 1]);
        for (std::uint32_t v = first[b]; v < first[b + 1]; ++v) block_of[v] = b;
    }
    ck_assert_uint_eq(tiles.super_first.front(), 0);
    ck_assert_uint_eq(tiles.super_first.back(), tiles.tiles.size());
    ck_assert_uint_eq(tiles.super_tile_count(), tiles.blocks.size());
    for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) {
        ck_assert_uint_lt(tiles.super_first[s], tiles.super_first[s + 1]);
        std::set<std::uint32_t> blocks;
        for (std::uint32_t t = tiles.super_first[s]; t < tiles.super_first[s + 1]; ++t)
            for (std::uint32_t i = 0; i < tiles.tiles[t].vertex_count; ++i)
                blocks.insert(block_of[tiles.vertices[tiles.tiles[t].first_vertex + i]]);
        const std::span<const std::uint32_t> listed = tiles.blocks[s];
        ck_assert_msg(std::equal(listed.begin(), listed.end(), blocks.begin(), blocks.end()),
                      "%s: blocks of super-tile %u", name, s);
    }
}

void check_tiles(const Mesh& mesh, const char* name) {
    const Tiles tiles = tiles_of(mesh);
    ck_assert_uint_eq(tiles.tets.size(), mesh.tets.size());
    std::vector<int> seen(mesh.tets.size());
    std::uint32_t next_tet = 0;
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
        const Tile& tile = tiles.tiles[t];
        ck_assert_msg(tile.tet_count >= 1 && tile.tet_count <= 64 && tile.vertex_count >= 1 &&
                          tile.vertex_count <= 64,
                      "%s: tile %zu has %u tets, %u vertices", name, t, tile.tet_count, tile.vertex_count);
        ck_assert_uint_eq(tile.first_tet, next_tet);
        next_tet += tile.tet_count;
        ck_assert_uint_eq(tile.first_vertex % 4, 0);
        const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
        const std::uint64_t* own = tiles.own.data() + tile.first_vertex;
        const std::uint32_t count = tile.vertex_count;
        const std::set<std::uint32_t> different(vertices, vertices + count);
        ck_assert_msg(different.size() == count, "%s: tile %zu lists a vertex twice", name, t);
        ck_assert_int_eq(tile.holds_last_vertex, different.count(vertex_count(mesh) - 1) != 0);
        for (std::uint32_t i = count; i % 4; ++i) ck_assert_uint_eq(vertices[i], vertices[count - 1]);
        std::vector<std::uint64_t> expected_own(count);
        for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
            const std::uint32_t tet = tiles.tets[tile.first_tet + i];
            ck_assert_uint_lt(tet, mesh.tets.size());
            ++seen[tet];
            for (std::uint32_t c = 0; c < 4; ++c) {
                const std::uint32_t local = tiles.corners[(t * 4 + c) * tile_size + i];
                ck_assert_uint_lt(local, count);
                ck_assert_msg(vertices[local] == mesh.tets[tet].v[c], "%s: corner %u of tet %u is %u", name,
                              c, tet, vertices[local]);
                expected_own[local] |= std::uint64_t{1} << i;
            }
        }
        ck_assert_msg(std::equal(expected_own.begin(), expected_own.end(), own), "%s: owners in tile %zu",
                      name, t);
    }
    for (std::size_t t = 0; t < seen.size(); ++t)
        ck_assert_msg(seen[t] == 1, "%s: tet %zu is in %d tiles", name, t, seen[t]);
    check_blocks(mesh, tiles, name);
}

START_TEST(tiles_hold_every_tet_once) {
    Random r{1};
    for (const int n : {1, 2, 3, 5, 8, 14}) check_tiles(block(n, n, n), "a block");
    Mesh mesh = ball(5000);
    renumber(mesh, r);
    check_tiles(mesh, "a renumbered ball");
    for (int i = 0; i < 30; ++i) {
        const std::uint32_t vertices = 1 + r.below(300), tets = r.below(600);
        check_tiles(soup(r, vertices, tets, 3, i % 2 != 0), "a soup");
    }
    Mesh star; // more than 64 tets around one vertex, more than 64 vertices among 64 tets
    star.positions.resize(301);
    for (std::uint32_t i = 0; i < 100; ++i) star.tets.push_back({{0, 3 * i + 1, 3 * i + 2, 3 * i + 3}});
    check_tiles(star, "a star");
    Mesh twins; // all in one place
    twins.positions.resize(4);
    twins.tets.assign(1000, {{0, 1, 2, 3}});
    check_tiles(twins, "a thousand times the same tet");
    for (const float bad :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), FLT_MAX}) {
        mesh = block(6, 6, 6);
        for (int i = 0; i < 50; ++i) mesh.positions[r.below(vertex_count(mesh))].y = bad;
        check_tiles(mesh, "positions that are none");
    }
    check_tiles(Mesh{}, "nothing");
    Mesh points;
    points.positions.resize(77);
    check_tiles(points, "points");
}
END_TEST

START_TEST(tiles_are_full_and_compact) {
    double radius = 0;
    const Mesh mesh = ball(20000, &radius);
    const Tiles tiles = tiles_of(mesh);
    const double per_tile = double(mesh.tets.size()) / double(tiles.tiles.size());
    ck_assert_msg(per_tile > 40, "%g tets a tile", per_tile);
    double volume = 0; // of the tiles' boxes; five tets make up a cube of one
    for (const Tile& tile : tiles.tiles) {
        Box box = empty_box;
        for (std::uint32_t i = 0; i < tile.vertex_count; ++i)
            add(box, box_around(mesh.positions[tiles.vertices[tile.first_vertex + i]]));
        volume +=
            double(box.hi[0] - box.lo[0]) * double(box.hi[1] - box.lo[1]) * double(box.hi[2] - box.lo[2]);
    }
    ck_assert_msg(volume < 4 * double(mesh.tets.size()) / 5, "boxes of %g for a volume of %g", volume,
                  double(mesh.tets.size()) / 5);
}
END_TEST

// ---- stream ---------------------------------------------------------------------------------------

START_TEST(stream_finds_the_boxes) {
    Random r{2};
    for (int round = 0; round < 200; ++round) {
        const std::uint32_t count = round < 60 ? std::uint32_t(round) + 1 : 1 + r.below(1500);
        std::vector<float> positions(3 * std::size_t{count}); // no longer than it has to be
        for (float& c : positions) c = r.below(50) ? r.uniform(-9, 9) : r.any_finite();
        std::vector<std::uint32_t> first{0};
        while (first.back() < count) first.push_back(std::min(count, first.back() + 1 + r.below(block_size)));
        const std::size_t blocks = first.size() - 1;
        std::vector<Box> expected(blocks, empty_box);
        Box expected_all = empty_box;
        for (std::size_t b = 0; b < blocks; ++b) {
            for (std::uint32_t v = first[b]; v < first[b + 1]; ++v)
                add(expected[b], box_around({positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]}));
            add(expected_all, expected[b]);
        }
        at_each_level([&](const char* level) {
            std::vector<Box> boxes(blocks), groups((blocks + fast::group_blocks - 1) / fast::group_blocks);
            Box all{};
            ck_assert(fast::stream_boxes(positions.data(), first, boxes.data(), groups.data(), all));
            ck_assert_msg(same(all, expected_all), "%s: box of %u positions", level, count);
            for (std::size_t b = 0; b < blocks; ++b)
                ck_assert_msg(same(boxes[b], expected[b]), "%s: block %zu of %zu", level, b, blocks);
            for (std::size_t g = 0; g < groups.size(); ++g) {
                Box around = empty_box;
                for (std::size_t b = g * fast::group_blocks;
                     b < std::min(blocks, (g + 1) * fast::group_blocks); ++b)
                    add(around, expected[b]);
                ck_assert_msg(same(groups[g], around), "%s: group %zu of %zu", level, g, groups.size());
            }
        });
    }
}
END_TEST

START_TEST(stream_sees_what_is_not_finite) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const std::uint32_t count : {1u, 3u, 8u, 9u, 37u, 300u}) {
        std::vector<float> positions(3 * std::size_t{count});
        for (std::size_t i = 0; i < positions.size(); ++i)
            positions[i] = i % 5 == 0 ? FLT_MAX : i % 5 == 1 ? -FLT_MAX : i % 5 == 2 ? 1e-45f : -0.0f;
        std::vector<std::uint32_t> first{0};
        while (first.back() < count) first.push_back(std::min(count, first.back() + block_size));
        at_each_level([&](const char* level) {
            std::vector<Box> boxes(first.size()), groups(first.size());
            Box all{};
            ck_assert(fast::stream_boxes(positions.data(), first, boxes.data(), groups.data(), all));
            for (float& c : positions)
                for (const float bad : {infinite, -infinite, std::numeric_limits<float>::quiet_NaN()}) {
                    const float good = c;
                    c = bad;
                    ck_assert_msg(
                        !fast::stream_boxes(positions.data(), first, boxes.data(), groups.data(), all),
                        "%s: coordinate %td of %u positions is %g", level, &c - positions.data(), count,
                        double(bad));
                    c = good;
                }
        });
    }
}
END_TEST

// A block ends before a vertex that is far from the one before it, or when it is full.
START_TEST(blocks_end_at_jumps) {
    Mesh mesh;
    for (std::uint32_t v = 0; v < 40; ++v)
        mesh.positions.push_back({float(v) + (v >= 13 && v < 21 ? 100.f : 0.f), 0, 0});
    const std::uint32_t expected[] = {0, 8, 13, 21, 29, 37, 40};
    for (const bool doubles : {false, true}) {
        std::vector<Vec3d> exact(mesh.positions.begin(), mesh.positions.end());
        Positions positions = view(mesh);
        if (doubles)
            positions = {.data = reinterpret_cast<const std::byte*>(exact.data()),
                         .byte_stride = sizeof(Vec3d),
                         .doubles = true};
        Tiles tiles(std::pmr::new_delete_resource());
        cut_blocks(vertex_count(mesh), positions, tiles);
        ck_assert_uint_eq(tiles.block_first.size(), std::size(expected));
        for (std::size_t b = 0; b < std::size(expected); ++b)
            ck_assert_uint_eq(tiles.block_first[b], expected[b]);
    }
}
END_TEST

} // namespace

SUITE(stages) {
    TCase* tests = add_case(suite, "stages");
    tcase_add_each(tests, tiles_hold_every_tet_once, tiles_are_full_and_compact, stream_finds_the_boxes,
                   stream_sees_what_is_not_finite, blocks_end_at_jumps);
}
