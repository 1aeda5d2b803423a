// Pairs of boxes, against loops over all of them; and what finding them takes.
#include "base/array.hpp"
#include "fast/body_pairs.hpp"
#include "internal/counting_memory.hpp"
#include "internal/random.hpp"
#include "mesh/filter.hpp"

#include <cfloat>
#include <limits>
#include <utility>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
constexpr Tet tet{{0, 1, 2, 3}};

// Boxes of bodies, and the rules that these bring.
struct Scene {
    std::vector<Box> boxes;
    std::vector<Body> bodies;
    std::vector<fast::StepBody> of;
    fast::PairRules rules() const { return {bodies, of}; }

    Body& add(const Box& box) {
        boxes.push_back(box);
        of.push_back({});
        of.back().moved = true;
        Body& body = bodies.emplace_back();
        body.mesh_id = std::uint32_t(bodies.size());
        body.tets = {&tet, 1};
        return body;
    }
};

Pairs by_definition(const std::vector<Box>& boxes, const fast::PairRules& rules) {
    Pairs pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            const Box &p = boxes[a], &q = boxes[b];
            bool meet = a != b;
            for (int i = 0; i < 3; ++i)
                meet = meet && p.lo[i] <= p.hi[i] && q.lo[i] <= q.hi[i] && p.lo[i] <= q.hi[i] &&
                       q.lo[i] <= p.hi[i];
            if (meet && !rules.bodies.empty())
                meet = collide(rules.bodies[a], rules.bodies[b]) &&
                       !(rules.bodies[a].tets.empty() && rules.bodies[b].tets.empty()) &&
                       (rules.of.empty() || rules.of[a].moved || rules.of[b].moved);
            if (meet) pairs.emplace_back(a, b);
        }
    return pairs;
}

std::size_t check(const std::vector<Box>& boxes, const fast::PairRules& rules, fast::PairBuffers& buffers) {
    vox::Array<fast::Pair> pairs(std::pmr::get_default_resource());
    fast::find_pairs(boxes, rules, buffers, pairs);
    Pairs found;
    for (const fast::Pair& pair : pairs) found.emplace_back(pair.a, pair.b);
    const Pairs expected = by_definition(boxes, rules);
    ck_assert_msg(found == expected, "%zu boxes: %zu pairs, expected %zu", boxes.size(), found.size(),
                  expected.size());
    return found.size();
}

// Of whole numbers, so that many touch. Long ones along all axes, empty ones, and all but infinite ones.
Box random_box(Random& r, std::uint32_t range, std::uint32_t side, int long_axis) {
    Box box = empty_box;
    if (r.below(20) == 0) return box;
    for (int a = 0; a < 3; ++a) {
        box.lo[a] = float(r.below(range)) - float(range / 2);
        box.hi[a] = box.lo[a] + float(r.below(a == long_axis ? range : side));
        if (box.lo[a] == 0 && r.below(2)) box.lo[a] = -0.0f;
        if (r.below(100) == 0) box.lo[a] = -FLT_MAX;
        if (r.below(100) == 0) box.hi[a] = FLT_MAX;
    }
    box.lo[3] = std::numeric_limits<float>::quiet_NaN(); // the fourth means nothing
    return box;
}

START_TEST(pairs_are_all_that_overlap) {
    Random r{3};
    fast::PairBuffers buffers(std::pmr::get_default_resource());
    std::size_t found = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Box> boxes;
        const std::uint32_t count = r.below(round % 10 ? 60 : 1500), range = 5 + r.below(60);
        for (std::uint32_t i = 0; i < count; ++i)
            boxes.push_back(random_box(r, range, 1 + r.below(5), int(r.below(4))));
        found += check(boxes, {}, buffers);
    }
    ck_assert_uint_gt(found, 10000);
}
END_TEST

// Every way to find pairs asks the same of them: few kinds of filters, or many, exceptions, bodies without
// tetrahedra or at rest, where most pairs are excluded or none.
START_TEST(pairs_are_those_that_are_wanted) {
    Random r{4};
    fast::PairBuffers buffers(std::pmr::get_default_resource());
    std::size_t found = 0;
    for (int round = 0; round < 100; ++round) {
        Scene s;
        const std::uint32_t count = round % 4 ? 100 + r.below(400) : 700 + r.below(500);
        const std::uint32_t range = round % 3 ? 3 : 40, kinds = round % 2 ? 4 : 200;
        std::vector<PairFilter> filters(kinds);
        for (PairFilter& filter : filters) {
            filter.category = std::uint64_t{1} << r.below(16);
            filter.mask = std::uint64_t{1} << r.below(16);
            if (r.below(4) == 0) filter.mask = ~std::uint64_t{0};
            if (r.below(3) == 0) filter.group = std::int32_t(r.below(5)) - 3;
        }
        std::vector<std::vector<std::uint32_t>> exceptions(count);
        for (std::uint32_t i = 1; i < count; ++i)
            if (r.below(10) == 0) {
                exceptions[i].push_back(i); // the one before
                exceptions[i - 1].push_back(i + 1);
            }
        for (std::uint32_t i = 0; i < count; ++i) {
            Body& body = s.add(random_box(r, range, 3, int(r.below(4))));
            body.filter = filters[r.below(kinds)];
            body.exceptions = exceptions[i];
            if (r.below(5) == 0) body.tets = {};
            s.of.back().moved = round % 5 == 0 || r.below(3) == 0;
        }
        found += check(s.boxes, s.rules(), buffers);
        found += check(s.boxes, {.bodies = s.bodies}, buffers);
    }
    ck_assert_uint_gt(found, 10000);
}
END_TEST

// ---- what it takes --------------------------------------------------------------------------------

// Looks at pairs and boxes, and bytes, of each box. No pair is wanted.
struct Cost {
    double looks, bytes;
};

Cost cost_of(const Scene& s) {
    CountingMemory memory;
    fast::PairBuffers buffers(&memory);
    vox::Array<fast::Pair> pairs(&memory);
    fast::find_pairs(s.boxes, s.rules(), buffers, pairs);
    ck_assert_uint_eq(pairs.size(), 0);
    const double count = double(s.boxes.size());
    return {double(buffers.looks) / count, double(memory.peak) / count};
}

constexpr double most_bytes = 500;

// Rods along three axes that do not touch: along every axis, a third of them is side by side with all.
START_TEST(scaffold) {
    for (const std::size_t side : {30u, 60u, 120u}) {
        Scene s;
        for (std::size_t i = 0; i < 3 * side * side; ++i) {
            Box box = empty_box;
            const std::size_t axis = i % 3, k = i / 3, across = (axis + 1) % 3, up = (axis + 2) % 3;
            box.lo[axis] = 0;
            box.hi[axis] = float(side);
            box.lo[across] = float(k % side) + float(axis) / 3;
            box.hi[across] = box.lo[across] + 0.1f;
            box.lo[up] = float(k / side) + float(axis) / 3;
            box.hi[up] = box.lo[up] + 0.1f;
            s.add(box);
        }
        const Cost cost = cost_of(s);
        ck_assert_msg(cost.looks < 600 && cost.bytes < most_bytes, "%zu rods: %.0f looks, %.0f bytes each",
                      s.boxes.size(), cost.looks, cost.bytes);
    }
}
END_TEST

// What rules out all pairs: how body i is made.
struct Rule {
    const char* name;
    void (*apply)(std::uint32_t i, Body& body, fast::StepBody& of);
};
constexpr Rule rules_that_exclude_all[] = {
    {"one group", [](std::uint32_t, Body& body, fast::StepBody&) { body.filter.group = -1; }},
    {"two masks", // every other body looks for a category that none has
     [](std::uint32_t i, Body& body, fast::StepBody&) {
         body.filter.category = i % 2 ? 4 : 1;
         body.filter.mask = i % 2 ? 1 : 2;
     }},
    {"layers", // here all of them do
     [](std::uint32_t i, Body& body, fast::StepBody&) {
         body.filter.category = std::uint64_t{1} << i % 30;
         body.filter.mask = std::uint64_t{1} << (i % 30 + 30);
     }},
    {"at rest", [](std::uint32_t, Body&, fast::StepBody& of) { of.moved = false; }},
    {"no tets", [](std::uint32_t, Body& body, fast::StepBody&) { body.tets = {}; }}};

// All boxes in one place.
START_TEST(one_place) {
    for (const Rule& rule : rules_that_exclude_all)
        for (const std::uint32_t count : {2000u, 16000u}) {
            Scene s;
            for (std::uint32_t i = 0; i < count; ++i) {
                Body& body = s.add({{0, 0, 0, 0}, {1, 1, 1, 0}});
                rule.apply(i, body, s.of[i]);
            }
            const Cost cost = cost_of(s);
            ck_assert_msg(cost.looks < 2000 && cost.bytes < most_bytes,
                          "%s, %u boxes: %.0f looks, %.0f bytes each", rule.name, count, cost.looks,
                          cost.bytes);
        }
}
END_TEST

} // namespace

SUITE(body_pairs) {
    TCase* tests = add_case(suite, "body_pairs");
    tcase_add_each(tests, pairs_are_all_that_overlap, pairs_are_those_that_are_wanted, scaffold, one_place);
}
