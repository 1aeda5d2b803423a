// The cost models' counts against those of the engines themselves, in scenes of every kind.
#include "base/array.hpp"
#include "cell_size/adaptive.hpp"
#include "cell_size/fast_model.hpp"
#include "cell_size/levels.hpp"
#include "cell_size/reference_model.hpp"
#include "cell_size/search.hpp"
#include "cell_size/weights.hpp"
#include "fast/engine.hpp"
#include "internal/fast_scenes.hpp"
#include "reference/engine.hpp"
#include "support/suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory_resource>
#include <string>

using namespace vox;

namespace {

using vox::test::Mesh; // of a test scene, not of a grid

std::pmr::memory_resource* const heap = std::pmr::new_delete_resource();

// ---- scenes ---------------------------------------------------------------------------------------

Mesh jittered_ball(double tets, double scale, double x, double y, double z, std::uint64_t seed) {
    Random random{seed};
    Mesh mesh = ball(tets);
    jitter(mesh, 0.12, random);
    move(mesh, scale, x, y, z);
    return mesh;
}

// Finer towards the centre, sides about 1 : 8.
Mesh graded_ball(double tets, double x) {
    double radius = 0;
    Random random{3};
    Mesh mesh = ball(tets, &radius);
    jitter(mesh, 0.12, random);
    for (Vec3f& p : mesh.positions) {
        const double factor = std::sqrt(double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z) / radius;
        p = {float(p.x * factor + x), float(p.y * factor), float(p.z * factor)};
    }
    return mesh;
}

struct Named {
    const char* name;
    void (*fill)(Scene& scene);
    double unit; // an edge, about
};

constexpr double radius_of(double tets) { return std::cbrt(tets / 5 * 3 / (4 * 3.14159265358979)); }

const Named scenes[] = {
    {"pair",
     [](Scene& s) {
         s.add(jittered_ball(12000, 1, 0.3, 0.1, 0.2, 1));
         s.add(jittered_ball(12000, 1, 0.3 + 1.8 * radius_of(12000), 0.4, 0.7, 2));
     },
     1.2},
    {"self", [](Scene& s) { s.add(jittered_ball(20000, 1, 0.3, 0.1, 0.2, 1), true); }, 1.2},
    {"pile",
     [](Scene& s) {
         const double r = radius_of(1500);
         for (int i = 0; i < 12; ++i)
             s.add(jittered_ball(1500, 1, 0.3 + 1.8 * r * (i % 3), 0.2 + 1.7 * r * (i / 3 % 2),
                                 0.4 + 1.9 * r * (i / 6), std::uint64_t(i)));
     },
     1.2},
    {"deep",
     [](Scene& s) {
         s.add(jittered_ball(10000, 1, 0.3, 0.1, 0.2, 1));
         s.add(jittered_ball(10000, 1, 0.3 + 0.5 * radius_of(10000), 0.4, 0.7, 2));
     },
     1.2},
    {"graded",
     [](Scene& s) {
         s.add(graded_ball(10000, 0));
         s.add(graded_ball(10000, 1.5 * radius_of(10000)));
     },
     1.2},
    {"unlike 1:10",
     [](Scene& s) {
         const double r = radius_of(6000);
         s.add(jittered_ball(6000, 1, 0.3, 0.1, 0.2, 1));
         s.add(jittered_ball(6000, 0.1, 0.3 + r - 0.05 * r, 0.17, 0.26, 2));
     },
     0.7},
    {"unlike 1:100",
     [](Scene& s) {
         const double r = radius_of(6000);
         s.add(jittered_ball(6000, 1, 0.3, 0.1, 0.2, 1));
         s.add(jittered_ball(6000, 0.01, 0.3 + 0.9 * r, 0.17, 0.26, 2));
     },
     0.3},
};

void ck_near(const Named& scene, double size, const char* what, double predicted, double counted,
             double tolerance) {
    ck_assert_msg(std::abs(predicted - counted) <= tolerance * counted,
                  "%s, cell size %g: %s %.0f, counted %.0f", scene.name, size, what, predicted, counted);
}

std::uint64_t tets_of(Scene& scene) {
    std::uint64_t tets = 0;
    for (const Body& body : scene.bodies()) tets += body.tets.size();
    return tets;
}

// What the models see of a scene, prepared for one of them.
struct Described : CellSizeScene {
    explicit Described(Scene& scene, const SampleBudget& with = thorough) : CellSizeScene(heap) {
        bodies.assign(scene.bodies().begin(), scene.bodies().end());
        budget = with;
    }
    Described(Scene& scene, const SampleBudget& with, const std::vector<std::uint8_t>& resting)
        : Described(scene, with) {
        for (const Tiles* of : scene.tiles()) tiles.push_back(of);
        at_rest.assign(resting.begin(), resting.end());
        prepare(VOX_COST_MODEL_FAST);
    }
};

double term(const CostTerms& terms, const std::string& name) {
    for (const vox_cost_term& t : terms)
        if (t.name == name) return t.count;
    ck_abort_msg("no term %s", name.c_str());
    return 0;
}

// ---- the reference engine -------------------------------------------------------------------------

// The model's counts are means over all positions of the lattice. Where a small dense body meets few cells,
// the engine's counts depend on the position, so they are averaged over a few.
START_TEST(reference_counts) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const ReferenceModel cost(Described(scene), false, shipped_weights);
    ReferenceEngine engine(heap);
    for (const double size : {0.7, 1.0, 1.5, 2.2}) {
        ReferenceSettings settings;
        settings.cell_size = size * named.unit;
        double cells = 0, read = 0, occupied = 0, in_boxes = 0;
        constexpr int places = 9;
        for (int place = 0; place < places; ++place) {
            vox::Array<Hit> hits(heap);
            vox::Counters counters{};
            vox::Profile profile{};
            engine.detect(scene.bodies(), settings, hits, counters, profile);
            cells += double(counters.visited_cells) / places;
            read += double(counters.visited_entries) / places;
            occupied += double(counters.cells) / places;
            in_boxes += double(counters.candidates) / places;
            for (const Body& body : scene.bodies()) // the engine does not count a tet's own corners
                if (body.self_collision) in_boxes += 4 * double(body.tets.size()) / places;
            for (Mesh& mesh : scene.meshes())
                move(mesh, 1, 0.382 * settings.cell_size, 0.276 * settings.cell_size,
                     0.618 * settings.cell_size);
        }
        double predicted_cells = 0;
        for (const auto& c : cost.classes()) predicted_cells += c.cells.at(settings.cell_size);
        ck_near(named, size, "cells", predicted_cells, cells, 0.1);
        ck_near(named, size, "vertices read", term(cost.terms(settings.cell_size), "read a vertex"), read,
                0.1);
        ck_near(named, size, "vertices in boxes", cost.candidates(), in_boxes, 0.1);
        ck_near(named, size, "occupied cells", cost.occupied(settings.cell_size), occupied, 0.35);
    }
}
END_TEST

// With the quick budget the model has its minimum where the thorough one has it, or loses next to nothing.
START_TEST(reference_quick_look) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const ReferenceModel all(Described(scene), false, shipped_weights);
    const CellSizeRange range = all.range().value();
    const vox_cost_sample best = minimise(of_size(all), range, {.scans_per_octave = 16});
    for (const std::uint64_t tets : {tets_of(scene), std::uint64_t{200000}}) {
        const ReferenceModel some(Described(scene, quick(VOX_COST_MODEL_REFERENCE, tets)), false,
                                  shipped_weights);
        const vox_cost_sample found = minimise(of_size(some), range, {.scans_per_octave = 16});
        ck_assert_msg(all(found.cell_size) <= 1.02 * best.cost, "%s: quick %g, thorough %g, cost %g over %g",
                      named.name, found.cell_size, best.cell_size, all(found.cell_size), best.cost);
    }
}
END_TEST

// What vox_suggest_cell_size loses by looking at samples, by the thorough model.
START_TEST(reference_usual_look) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const ReferenceModel all(Described(scene), false, shipped_weights);
    const ReferenceModel some(Described(scene, usual(VOX_COST_MODEL_REFERENCE, tets_of(scene))), false,
                              shipped_weights);
    const CellSizeRange range = all.range().value();
    const vox_cost_sample best = minimise(of_size(all), range, {.scans_per_octave = 16});
    const vox_cost_sample found = minimise(of_size(some), range, {.scans_per_octave = 16});
    ck_assert_msg(all(found.cell_size) <= 1.04 * best.cost, "%s: %g, thorough %g, cost %g over %g",
                  named.name, found.cell_size, best.cell_size, all(found.cell_size), best.cost);
}
END_TEST

// Visits of cells whose list is of another length than that of the cell before, in the order of the engine.
double visits_of_other_length(Scene& scene, double cell_size) {
    const auto cell_of = [&](float x) { return std::int64_t(std::floor(double(x) / cell_size)); };
    using At = std::array<std::int64_t, 3>;
    std::map<At, int> length;
    for (const Mesh& mesh : scene.meshes())
        for (const Vec3f& p : mesh.positions) ++length[{cell_of(p.x), cell_of(p.y), cell_of(p.z)}];
    double count = 0;
    int before = 0;
    for (const Mesh& mesh : scene.meshes())
        for (const Tet& tet : mesh.tets) {
            At lo{}, hi{};
            for (int i = 0; i < 4; ++i) {
                const Vec3f& p = mesh.positions[tet.v[i]];
                const At at{cell_of(p.x), cell_of(p.y), cell_of(p.z)};
                for (std::size_t a = 0; a < 3; ++a) {
                    lo[a] = i ? std::min(lo[a], at[a]) : at[a];
                    hi[a] = i ? std::max(hi[a], at[a]) : at[a];
                }
            }
            for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
                for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
                    for (std::int64_t i = lo[0]; i <= hi[0]; ++i) {
                        const auto found = length.find({i, j, k});
                        const int here = found == length.end() ? 0 : found->second;
                        count += here != before;
                        before = here;
                    }
        }
    return count;
}

// The formula takes vertices to be irregular everywhere. It does not know of a fine body that lies in few of
// the cells, so scenes with one have a wide tolerance.
START_TEST(reference_lists_of_other_length) {
    const Named& named = scenes[_i];
    const double tolerance = named.unit < 1 ? 0.8 : 0.4;
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const ReferenceModel cost(Described(scene), false, shipped_weights);
    for (const double size : {0.7, 1.0, 1.5, 2.2}) {
        const double cell_size = size * named.unit;
        ck_near(named, size, "lists of another length", term(cost.terms(cell_size), "list of another length"),
                visits_of_other_length(scene, cell_size), tolerance);
    }
}
END_TEST

// Vertices are fetched where a tet is not beside the one before: in next to none of a mesh in the order of a
// lattice, in all of a mesh in no order. Nothing else depends on the order.
START_TEST(tets_in_no_order_fetch_their_vertices) {
    Scene scene;
    scenes[0].fill(scene);
    scene.prepare();
    const auto terms = [&] { return ReferenceModel(Described(scene), false, shipped_weights).terms(1.5); };
    const CostTerms before = terms();
    Random random{5};
    for (Mesh& mesh : scene.meshes())
        for (std::size_t t = mesh.tets.size() - 1; t > 0; --t)
            std::swap(mesh.tets[t], mesh.tets[random.next() % (t + 1)]);
    scene.prepare();
    const CostTerms after = terms();
    ck_assert_double_lt(term(before, "fetch a vertex"), 0.1 * term(before, "read a vertex"));
    ck_assert_double_gt(term(after, "fetch a vertex"), 0.9 * term(after, "read a vertex"));
    ck_assert_double_le(term(after, "fetch a vertex"), term(after, "read a vertex"));
    ck_assert_double_eq_tol(term(after, "visit a cell"), term(before, "visit a cell"),
                            1e-6 * term(before, "visit a cell"));
    ck_assert_double_eq_tol(term(after, "read a vertex"), term(before, "read a vertex"),
                            0.05 * term(before, "read a vertex"));
    ck_assert_double_gt(after.cost(), before.cost());
}
END_TEST

// ---- the fast engine ------------------------------------------------------------------------------

// A window's lattice begins at its corner, so with few cells the counts depend on the exact size. Those at
// nine slightly different sizes are summed.
START_TEST(fast_counts) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const FastModel cost(Described(scene, thorough, {}), shipped_weights);
    FastEngine engine(heap);
    for (const double size : {1.0, 1.4, 2.0, 2.8}) {
        double cells = 0, read = 0, predicted_cells = 0, predicted_read = 0;
        constexpr int sizes = 9;
        for (int i = 0; i < sizes; ++i) {
            vox::Array<Hit> hits(heap);
            vox::Counters counters{};
            vox::Profile profile{};
            FastSettings settings;
            settings.cell_size = size * named.unit * std::pow(1.2, (i - 4.0) / sizes);
            settings.winding = false; // the model counts self-collision as if nothing were culled
            engine.detect(scene.bodies(), scene.prepared(), settings, hits, counters, profile);
            const CostTerms terms = cost.terms(settings.cell_size, true);
            ck_near(named, size, "vertices binned", term(terms, "bin a vertex"), double(counters.entries),
                    0.02);
            predicted_cells += cost.visited_cells(settings.cell_size);
            predicted_read += term(terms, "read a vertex");
            cells += double(counters.visited_cells);
            read += double(counters.visited_entries);
        }
        ck_near(named, size, "cells", predicted_cells, cells, 0.1);
        ck_near(named, size, "vertices read", predicted_read, read, 0.1);
    }
}
END_TEST

// As for the reference engine. Some scenes have next to no tiles to look at; what the quick budget loses is
// computed with the thorough model.
START_TEST(fast_quick_look) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const std::uint64_t tets = tets_of(scene);
    const FastModel all(Described(scene, thorough, {}), shipped_weights);
    const FastModel some(Described(scene, quick(VOX_COST_MODEL_FAST, tets), {}), shipped_weights);
    const CellSizeRange range = all.range().value();
    const vox_cost_sample best = minimise(of_size(all), range);
    const vox_cost_sample found = minimise(of_size(some), range);
    ck_assert_msg(all(found.cell_size) <= 1.03 * best.cost, "%s: quick %g, thorough %g, cost %g over %g",
                  named.name, found.cell_size, best.cell_size, all(found.cell_size), best.cost);
}
END_TEST

// The same with tiles that are sketched from a sample of the tetrahedra, as vox_suggest_cell_size does it.
// Their counts are near those of the tiles themselves.
START_TEST(fast_usual_look) {
    const Named& named = scenes[_i];
    Scene scene;
    named.fill(scene);
    scene.prepare();
    const FastModel all(Described(scene, thorough, {}), shipped_weights);
    Described sketched(scene, usual(VOX_COST_MODEL_FAST, tets_of(scene)));
    sketched.prepare(VOX_COST_MODEL_FAST);
    const FastModel some(sketched, shipped_weights);
    const CellSizeRange range = all.range().value();
    const vox_cost_sample best = minimise(of_size(all), range);
    const vox_cost_sample found = minimise(of_size(some), range);
    ck_assert_msg(all(found.cell_size) <= 1.02 * best.cost, "%s: %g, thorough %g, cost %g over %g",
                  named.name, found.cell_size, best.cell_size, all(found.cell_size), best.cost);
    const CostTerms sketch = some.terms(best.cell_size), real = all.terms(best.cell_size);
    const auto check = [&](const char* name, double tolerance) {
        ck_near(named, best.cell_size, name, term(sketch, name), term(real, name), tolerance);
    };
    check("bin a vertex", 0.1);
    if (term(real, "visit a tile") < 60) return; // of a small body: too few to be estimated from a sample
    check("visit a tile", 0.15);
    check("visit a row", 0.15);
    check("read a vertex", 0.2);
}
END_TEST

// Bodies at rest cost nothing where they meet others at rest.
START_TEST(fast_bodies_at_rest) {
    Scene scene;
    scenes[2].fill(scene);
    scene.prepare();
    std::vector<std::uint8_t> at_rest(scene.bodies().size(), 1);
    const auto model = [&] { return FastModel(Described(scene, thorough, at_rest), shipped_weights); };
    ck_assert_double_eq(term(model().terms(2), "bin a vertex"), 0);
    at_rest[0] = 0;
    FastEngine engine(heap);
    vox::Array<Hit> hits(heap);
    vox::Counters counters{};
    vox::Profile profile{};
    FastSettings settings;
    settings.cell_size = 2;
    settings.carry = true;
    engine.detect(scene.bodies(), scene.prepared(), settings, hits, counters, profile);
    for (Mesh& mesh : scene.meshes()) {
        move(mesh, 1, 0.01, 0, 0);
        break;
    }
    engine.detect(scene.bodies(), scene.prepared(), settings, hits, counters, profile);
    const FastModel one = model();
    const double binned = term(one.terms(2), "bin a vertex");
    ck_assert_double_gt(binned, 0);
    ck_near(scenes[2], 2, "vertices binned", binned, double(counters.entries), 0.02);
    ck_near(scenes[2], 2, "cells", one.visited_cells(2), double(counters.visited_cells), 0.1);
    for (std::size_t b = 0; b < at_rest.size(); ++b) ck_assert_int_eq(engine.moved(b), !at_rest[b]);
}
END_TEST

// ---- several sizes --------------------------------------------------------------------------------

// Two bodies of unlike resolution want two sizes; bodies alike want one.
START_TEST(levels_where_they_pay) {
    Scene alike, unlike;
    scenes[0].fill(alike);
    alike.prepare();
    const ReferenceModel one(Described(alike), false, shipped_weights);
    CellSizeRange range = one.range().value();
    ck_assert_uint_eq(choose_levels(one, range).count, 1);

    scenes[5].fill(unlike);
    unlike.prepare();
    const ReferenceModel cost(Described(unlike), false, shipped_weights);
    range = cost.range().value();
    const Levels levels = choose_levels(cost, range);
    const vox_cost_sample uniform = minimise(of_size(cost), range);
    ck_assert_uint_ge(levels.count, 2);
    ck_assert_double_lt(levels.cost, 0.8 * uniform.cost);
    ck_assert_double_gt(levels.level[levels.count - 1].cell_size, 3 * levels.level[0].cell_size);
}
END_TEST

// The engine with levels finds what it finds with one cell size, and counts what the model says.
START_TEST(levels_are_one_engine) {
    for (const std::size_t s : {std::size_t{4}, std::size_t{5}, std::size_t{6}}) {
        Scene scene;
        scenes[s].fill(scene);
        scene.prepare();
        const ReferenceModel cost(Described(scene), false, shipped_weights);
        CellSizeRange range = cost.range().value();
        range.min = std::max(range.min, cost.least_cell_size(0, range)); // what dense storage can have
        const Levels best = choose_levels(cost, range);
        // Also where they do not pay: shares of the classes, one size smaller than the other.
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const CellLevel some[3] = {{0.5, 0.25}, {0.7, 1}, {1.5, infinity}};
        std::vector<Key> expected;
        for (const bool dense : {false, true})
            for (const std::span<const CellLevel> levels :
                 {std::span<const CellLevel>(), best.list(), std::span<const CellLevel>(some)}) {
                ReferenceEngine engine(heap);
                vox::Array<Hit> hits(heap);
                vox::Counters counters{};
                vox::Profile profile{};
                ReferenceSettings settings;
                settings.dense = dense;
                settings.cell_size = scenes[s].unit;
                settings.levels = levels;
                engine.detect(scene.bodies(), settings, hits, counters, profile);
                if (expected.empty()) expected = keys(hits);
                ck_assert_uint_gt(expected.size(), 0);
                ck_assert(keys(hits) == expected);
            }

        double cells = 0, read = 0, predicted_cells = 0, predicted_read = 0;
        for (const auto& c : cost.classes()) {
            const double side = std::ldexp(1.0, c.exponent);
            const auto level =
                std::ranges::find_if(best.list(), [&](const CellLevel& l) { return side <= l.longest_side; });
            predicted_cells += c.cells.at(level->cell_size);
            predicted_read += c.read(level->cell_size);
        }
        constexpr int places = 25; // a fine body lies in few coarse cells
        const double step = best.level[best.count - 1].cell_size;
        for (int place = 0; place < places; ++place) {
            ReferenceEngine engine(heap);
            vox::Array<Hit> hits(heap);
            vox::Counters counters{};
            vox::Profile profile{};
            ReferenceSettings settings;
            settings.levels = best.list();
            engine.detect(scene.bodies(), settings, hits, counters, profile);
            cells += double(counters.visited_cells) / places;
            read += double(counters.visited_entries) / places;
            for (Mesh& mesh : scene.meshes()) move(mesh, 1, 0.382 * step, 0.276 * step, 0.618 * step);
        }
        ck_near(scenes[s], 0, "cells of the levels", predicted_cells, cells, 0.1);
        ck_near(scenes[s], 0, "read in the levels", predicted_read, read, 0.1);
    }
}
END_TEST

// ---- a cell size that follows ---------------------------------------------------------------------

double step(ReferenceEngine& engine, Scene& scene, AdaptiveCellSize& adaptive) {
    vox::Array<Hit> hits(heap);
    vox::Counters counters{};
    vox::Profile profile{};
    ReferenceSettings settings;
    settings.levels = adaptive.cell_sizes(scene.bodies(), false, 0, heap);
    engine.detect(scene.bodies(), settings, hits, counters, profile);
    for (const Body& body : scene.bodies()) {
        counters.vertices += body.vertex_count;
        counters.tets += body.tets.size();
    }
    adaptive.observe(counters);
    ck_assert_uint_eq(settings.levels.size(), 1); // of a scene of like tetrahedra
    return settings.levels[0].cell_size;
}

// The loss of a size for the scene as it is now, by the model.
double loss(Scene& scene, double cell_size) {
    const ReferenceModel cost(Described(scene), false, shipped_weights);
    const CellSizeRange range = cost.range().value();
    return cost(cell_size) / minimise(of_size(cost), range).cost - 1;
}

// A body inflated tenfold in two hundred steps: the size goes with it, never far off; at rest it stays.
START_TEST(adaptive_follows) {
    Scene scene;
    scenes[0].fill(scene);
    scene.prepare();
    ReferenceEngine engine(heap);
    AdaptiveCellSize adaptive(shipped_weights);
    const double first = step(engine, scene, adaptive);
    for (int i = 0; i < 20; ++i) ck_assert_double_eq(step(engine, scene, adaptive), first);
    ck_assert_uint_eq(adaptive.changes(), 0);
    double size = first, worst = 0;
    for (int i = 0; i < 200; ++i) {
        for (Mesh& mesh : scene.meshes()) move(mesh, std::pow(10, 1.0 / 200), 0, 0, 0);
        size = step(engine, scene, adaptive);
        if (i % 10 == 0) worst = std::max(worst, loss(scene, size));
    }
    ck_assert_double_eq_tol(size / first, 10, 1.5);
    ck_assert_double_lt(worst, 0.1);
    ck_assert_uint_ge(adaptive.changes(), 5);
    ck_assert_uint_le(adaptive.changes(), 100); // not at every step
}
END_TEST

} // namespace

SUITE(cost) {
    TCase* tests = add_case(suite, "cost");
    const int scene_count = sizeof scenes / sizeof scenes[0];
    tcase_add_loop_test(tests, reference_counts, 0, scene_count);
    tcase_add_loop_test(tests, reference_quick_look, 0, scene_count);
    tcase_add_loop_test(tests, reference_usual_look, 0, scene_count);
    tcase_add_loop_test(tests, reference_lists_of_other_length, 0, scene_count);
    tcase_add_test(tests, tets_in_no_order_fetch_their_vertices);
    tcase_add_loop_test(tests, fast_counts, 0, scene_count);
    tcase_add_loop_test(tests, fast_quick_look, 0, scene_count);
    tcase_add_loop_test(tests, fast_usual_look, 0, scene_count);
    tcase_add_test(tests, fast_bodies_at_rest);
    tcase_add_test(tests, levels_where_they_pay);
    TCase* many_steps =
        add_tagged_case(suite, "many steps", "large"); // half of the time under the sanitizers
    tcase_add_each(many_steps, levels_are_one_engine, adaptive_follows);
}
