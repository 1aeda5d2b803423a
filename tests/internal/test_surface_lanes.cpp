// The parts of the search for pairs that work on a tile of 64 lanes, at every SIMD level: boxes in quanta
// against boxes of floats, lists of partners against loops, numbers sorted by counting.
#include "base/simd.hpp"
#include "internal/random.hpp"
#include "surface/lanes.hpp"
#include "surface/pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t n = lanes_a_tile;

struct TestTile {
    float boxes[6 * n];
    float low[3], high[3];

    float& lo(std::size_t axis, std::size_t lane) { return boxes[axis * n + lane]; }
    float& hi(std::size_t axis, std::size_t lane) { return boxes[(axis + 3) * n + lane]; }
    void enclose() {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = *std::min_element(boxes + a * n, boxes + a * n + n);
            high[a] = *std::max_element(boxes + (a + 3) * n, boxes + (a + 3) * n + n);
        }
    }
};

enum Kind { ordinary, flat, steps, distant, tiny, huge_, endless, kinds };

TestTile random_tile(Random& random, Kind kind, const float* around) {
    TestTile tile;
    const float scale = kind == tiny ? 1e-40f : kind == huge_ ? 1e38f : 1.0f;
    const float side = 0.6f * float(random.unit());
    const std::size_t axes = 1 + random.below(3); // that are endless
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < n; ++k) {
            float lo = around[a] + float(random.unit()) - 0.5f, size = side * float(random.unit());
            if (kind == flat && a == 2) lo = 0, size = 0;
            if (kind == steps) lo = std::round(8 * lo) / 8, size = std::round(8 * size) / 8;
            if (kind == distant) lo += 30000;
            tile.lo(a, k) = scale * lo;
            tile.hi(a, k) = scale * (lo + size);
            if (kind == endless && a < axes && random.below(8) == 0) tile.lo(a, k) = -infinity;
            if (kind == endless && a < axes && random.below(8) == 0) tile.hi(a, k) = infinity;
        }
    tile.enclose();
    return tile;
}

START_TEST(boxes_in_quanta) {
    Random random{7};
    std::uint64_t certain = 0, open = 0, kept[kinds] = {};
    for (int scene = 0; scene < 60 * kinds; ++scene) {
        const Kind kind = Kind(scene % kinds);
        const float here[3] = {0, 0, 0},
                    there[3] = {float(random.unit()), float(random.unit()), kind == flat ? 0 : 0.3f};
        TestTile a = random_tile(random, kind, here), b = random_tile(random, kind, there);
        float largest = 0;
        for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(a.low[i]), std::abs(a.high[i])});
        const float close_by = largest * 0x1p-20f + 0x1p-140f;
        const std::uint64_t asked = scene % 3 ? ~std::uint64_t{0} : random.next(),
                            wanted = scene % 5 ? ~std::uint64_t{0} : random.next();
        TileOverlaps first{};
        std::size_t first_count = 0;
        for (int level = 0; level <= int(simd::best_level()); ++level) {
            simd::force_level(simd::Level(level));
            QuantisedTile tile;
            TileOverlaps found{};
            quantise_tile(a.boxes, a.low, a.high, close_by, tile);
            QuantisedSides other;
            quantise_sides(b.boxes, tile, other);
            const std::size_t count = compare_tiles(tile, asked, other, wanted, found);
            if (level > 0) {
                ck_assert_uint_eq(count, first_count);
                ck_assert_uint_eq(found.compared, first.compared);
                for (std::size_t i = 0; i < count; ++i) {
                    ck_assert_uint_eq(found.others[i], first.others[i]);
                    ck_assert(found.lanes[i] == first.lanes[i] && found.open[i] == first.open[i]);
                }
                continue;
            }
            first = found;
            first_count = count;
            std::uint64_t lanes_of[n] = {}, open_of[n] = {};
            for (std::size_t i = 0; i < count; ++i) {
                ck_assert(i == 0 || found.others[i] > found.others[i - 1]);
                ck_assert(found.lanes[i] != 0 && (found.lanes[i] & ~asked) == 0 &&
                          (found.open[i] & ~found.lanes[i]) == 0);
                ck_assert(wanted >> found.others[i] & 1);
                lanes_of[found.others[i]] = found.lanes[i];
                open_of[found.others[i]] = found.open[i];
            }
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k < n; ++k) {
                    if (!(wanted >> j & 1) || !(asked >> k & 1)) continue;
                    double reach = infinity; // of one box into the other
                    for (std::size_t x = 0; x < 3; ++x)
                        reach = std::min({reach, double(b.hi(x, j)) - double(a.lo(x, k)),
                                          double(a.hi(x, k)) - double(b.lo(x, j))});
                    const bool is_kept = lanes_of[j] >> k & 1, is_open = open_of[j] >> k & 1;
                    if (reach >= 0)
                        ck_assert_msg(is_kept, "scene %d: lanes %zu, %zu reach %g and are lost", scene, j, k,
                                      reach);
                    if (is_kept && !is_open)
                        ck_assert_msg(reach > double(close_by), "scene %d: lanes %zu, %zu reach %g", scene, j,
                                      k, reach);
                    kept[kind] += is_kept;
                    if (kind == ordinary) certain += is_kept && !is_open, open += is_open;
                }
        }
    }
    for (int kind = 0; kind < kinds; ++kind)
        ck_assert_msg(kept[kind] > 300, "kind %d: %d pairs", kind, int(kept[kind]));
    ck_assert_msg(50 * open < certain, "%llu are open, %llu certain", (unsigned long long)open,
                  (unsigned long long)certain);
    simd::force_level(simd::best_level());
}
END_TEST

START_TEST(lists_of_lanes) {
    Random random{8};
    constexpr std::uint32_t mark = 0xabababab; // what nobody may touch
    for (int scene = 0; scene < 100; ++scene) {
        const std::size_t count = 1 + random.below(300),
                          blocks = (count + partners_a_block - 1) / partners_a_block;
        std::vector<std::uint64_t> words(blocks * partners_a_block, 0);
        std::vector<std::uint32_t> partners(words.size(), 0xffffffff);
        const unsigned sparse = random.below(4);
        std::vector<std::uint32_t> expected[partners_a_block];
        for (std::size_t i = 0; i < count; ++i) {
            words[i] = random.next();
            for (unsigned s = 0; s < sparse; ++s) words[i] &= random.next();
            partners[i] = std::uint32_t(random.next());
            for (std::size_t lane = 0; lane < partners_a_block; ++lane)
                if (words[i] >> lane & 1) expected[lane].push_back(partners[i]);
        }
        const std::uint64_t skipped = random.next() & random.next();
        for (int level = 0; level <= int(simd::best_level()); ++level) {
            simd::force_level(simd::Level(level));
            std::vector<std::uint64_t> turned = words;
            std::array<std::uint32_t, partners_a_block> counts{};
            turn_blocks(turned.data(), blocks, counts.data());
            std::vector<std::uint32_t> out;
            std::array<std::size_t, partners_a_block> first;
            for (std::size_t lane = 0; lane < partners_a_block; ++lane) {
                ck_assert_uint_eq(counts[lane], expected[lane].size());
                first[lane] = out.size() + 1;
                out.insert(out.end(), counts[lane] + 2, mark); // one on each side
            }
            const std::vector<std::uint32_t> untouched = out;
            std::array<std::uint32_t*, partners_a_block> lists;
            for (std::size_t lane = 0; lane < partners_a_block; ++lane)
                lists[lane] = skipped >> lane & 1 ? nullptr : out.data() + first[lane];
            write_lists(turned.data(), blocks, partners.data(), lists.data(), counts.data());
            for (std::size_t lane = 0; lane < partners_a_block; ++lane) {
                const bool is_skipped = skipped >> lane & 1;
                for (std::size_t i = 0; i < expected[lane].size(); ++i)
                    ck_assert_uint_eq(out[first[lane] + i], is_skipped ? mark : expected[lane][i]);
                ck_assert_uint_eq(out[first[lane] - 1], mark);
                ck_assert_uint_eq(out[first[lane] + expected[lane].size()], mark);
            }
            ck_assert_uint_eq(out.size(), untouched.size());
        }
    }
    simd::force_level(simd::best_level());
}
END_TEST

START_TEST(places_of_listed_features) {
    Random random{9};
    ListedFeatures listed(std::pmr::get_default_resource());
    for (int scene = 0; scene < 200; ++scene) {
        const std::uint32_t end = 1 + random.below(scene % 2 ? 300 : 100000);
        if (scene % 4 < 2) listed.reset(end); // else it is as large as before, and empty again
        const std::uint32_t most = scene % 4 < 2 ? end : 1;
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t left = random.below(200); left > 0; --left) {
            const std::uint32_t f = random.below(most);
            const bool is_listed = random.below(3) != 0;
            if (is_listed && std::find(numbers.begin(), numbers.end(), f) == numbers.end())
                numbers.push_back(f);
            listed.add(f, is_listed);
        }
        listed.count();
        std::sort(numbers.begin(), numbers.end());
        for (std::size_t i = 0; i < numbers.size(); ++i) ck_assert_uint_eq(listed.place_of(numbers[i]), i);
        listed.clear();
    }
}
END_TEST

} // namespace

SUITE(surface_lanes) {
    TCase* tests = add_case(suite, "surface_lanes");
    tcase_add_each(tests, boxes_in_quanta, lists_of_lanes, places_of_listed_features);
}
