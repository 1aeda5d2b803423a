// What a described grid does at a cell size, against a plain grid of that kind that is really filled, over
// many random positions of its lattice; and how much a quick look loses against a thorough one.
#include "cell_size/foreign/grid.hpp"
#include "internal/counting_memory.hpp"
#include "internal/random.hpp"
#include "support/suite.h"

#include <vox/vox_cell_size.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

using namespace vox;

namespace {

std::pmr::memory_resource* const heap = std::pmr::new_delete_resource();

// ---- scenes ---------------------------------------------------------------------------------------

struct Boxes {
    std::vector<double> corners; // two of each
    void add(double x, double y, double z, double w, double h, double d) {
        corners.insert(corners.end(), {x - w / 2, y - h / 2, z - d / 2, x + w / 2, y + h / 2, z + d / 2});
    }
    std::size_t count() const { return corners.size() / 6; }
    PlainBox box(std::size_t i) const {
        const double* c = corners.data() + 6 * i;
        return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
    }
    vox_primitives describe() const {
        vox_primitives p = vox_default_primitives();
        p.type = VOX_PRIMITIVE_BOX;
        p.positions = vox_double_positions(corners.data(), 2 * count());
        p.count = count();
        return p;
    }
};

enum Scene { body, shell, cloud, clumps, graded, wide, flat, sticks, lattice, scene_count };
const char* const scene_names[] = {"body", "shell", "cloud",  "clumps", "graded",
                                   "wide", "flat",  "sticks", "lattice"};

Boxes make(Scene scene, std::size_t count, std::uint64_t seed) {
    Random random{seed};
    const auto unit = [&] { return random.unit(); };
    Boxes boxes;
    const double edge = std::cbrt(1.0 / static_cast<double>(count));
    struct Point {
        double x, y, z;
    };
    // One after the other: compilers evaluate arguments in orders of their own.
    const auto in_cube = [&] {
        const double z = unit(), y = unit(), x = unit();
        return Point{x, y, z};
    };
    const auto around = [&](double x, double y, double z, double size) {
        const Point sides = in_cube();
        boxes.add(x, y, z, size * (0.5 + sides.x), size * (0.5 + sides.y), size * (0.5 + sides.z));
    };
    for (std::size_t i = 0; i < count; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(count);
        const auto spread_out = [&](double s, double size) {
            const Point p = in_cube();
            around(s * p.x, s * p.y, s * p.z, size);
        };
        switch (scene) {
        case body:
            spread_out(1, 1.7 * edge);
            break;
        case shell: {
            const double z = 2 * unit() - 1, a = 6.2831853 * unit(), r = std::sqrt(1 - z * z);
            around(r * std::cos(a), r * std::sin(a), z, 4 / std::sqrt(static_cast<double>(count)));
            break;
        }
        case cloud: {
            const Point p = in_cube();
            boxes.add(p.x, p.y, p.z, 0, 0, 0);
            break;
        }
        case clumps: {
            const double c = std::floor(unit() * 10), r = 0.02 * unit();
            const Point p = in_cube();
            around(0.1 * c + r * p.x, std::fmod(c * 0.37, 1) + r * p.y, std::fmod(c * 0.61, 1) + r * p.z,
                   0.002);
            break;
        }
        case graded: {
            const double s = std::pow(10, -2 * part);
            const Point p = in_cube();
            around(s * p.x, p.y, p.z, 0.3 * s * std::sqrt(edge));
            break;
        }
        case wide: {
            const double s = std::pow(10, -6 * part);
            spread_out(s, 0.1 * s);
            break;
        }
        case flat: {
            const double y = unit(), x = unit(), side = 1.5 * std::sqrt(1 / double(count));
            boxes.add(x, y, 0.5, side, side, 0);
            break;
        }
        case sticks: {
            const Point p = in_cube();
            boxes.add(p.x, p.y, p.z, i % 3 == 0 ? 6 * edge : 0.1 * edge, i % 3 == 1 ? 6 * edge : 0.1 * edge,
                      i % 3 == 2 ? 6 * edge : 0.1 * edge);
            break;
        }
        default: {
            const auto n = static_cast<std::size_t>(std::cbrt(double(count))) + 1;
            boxes.add(double(i % n) / double(n), double(i / n % n) / double(n), double(i / n / n) / double(n),
                      0.9 / double(n), 0.9 / double(n), 0.9 / double(n));
        }
        }
    }
    return boxes;
}

// ---- a plain grid ---------------------------------------------------------------------------------

struct Key {
    std::int64_t x, y, z;
    bool operator==(const Key&) const = default;
};

// What is in a cell, and a table of cells, in one array: a map of the standard library takes four times as
// long.
struct Cell {
    Key key{};
    double held = 0, asking = 0; // both 0: a place that is free
};
class Cells {
public:
    explicit Cells(std::size_t expected) : places_(std::bit_ceil(2 * expected + 2)) {}

    std::size_t count() const { return count_; }
    const std::vector<Cell>& places() const { return places_; }
    const Cell& find(const Key& key) const { return places_[place(key)]; }
    void add(const Key& key, double held, double asking) {
        if (2 * count_ >= places_.size()) grow();
        Cell& cell = places_[place(key)];
        count_ += free(cell);
        cell.key = key;
        cell.held += held;
        cell.asking += asking;
    }
    static bool free(const Cell& cell) { return cell.held + cell.asking == 0; }

private:
    std::size_t place(const Key& key) const {
        std::uint64_t hash = 0;
        for (const std::int64_t c : {key.x, key.y, key.z})
            hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
        std::size_t at = hash & (places_.size() - 1);
        while (!free(places_[at]) && places_[at].key != key) at = (at + 1) & (places_.size() - 1);
        return at;
    }
    void grow() {
        Cells larger(places_.size());
        for (const Cell& cell : places_)
            if (!free(cell)) larger.add(cell.key, cell.held, cell.asking);
        *this = std::move(larger);
    }

    std::vector<Cell> places_;
    std::size_t count_ = 0;
};

struct Lattice {
    double d, origin[3];
    Key cell(const double (&p)[3]) const {
        std::int64_t c[3];
        for (int a = 0; a < 3; ++a) c[a] = static_cast<std::int64_t>(std::floor((p[a] - origin[a]) / d));
        return {c[0], c[1], c[2]};
    }
    template <class Visit>
    void cells(const PlainBox& box, Visit&& visit) const {
        const Key lo = cell(box.lo), hi = cell(box.hi);
        for (auto x = lo.x; x <= hi.x; ++x)
            for (auto y = lo.y; y <= hi.y; ++y)
                for (auto z = lo.z; z <= hi.z; ++z) visit(Key{x, y, z});
    }
};

struct Kind {
    const char* name;
    vox_cells_stored stored;
    vox_cells_queried queried;
    bool two_sets;
    double radius; // in mean box sides of the ones held; of points: in spacings
};
const Kind kinds[] = {
    {"boxes in cells, boxes ask", VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, false, 0},
    {"boxes in cells, boxes ask around", VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, false, 0.3},
    {"boxes in cells, others ask", VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, true, 0},
    {"boxes in cells, pairs", VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_PAIRS, false, 0},
    {"boxes in cells, pairs of two sets", VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_PAIRS, true, 0.1},
    {"centres, balls ask", VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, false, 0.7},
    {"centres, others ask", VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, true, 0.2},
    {"centres, 27 around", VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_27, false, 0},
    {"centres, 27 around others", VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_27, true, 0},
    {"centres, pairs", VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_PAIRS, false, 0},
};

vox_foreign_counts count_once(const Kind& kind, const Boxes& held, const Boxes& asking, double radius,
                              const Lattice& lattice) {
    vox_foreign_counts work{};
    const bool pairs = kind.queried == VOX_CELLS_QUERIED_PAIRS,
               centres = kind.stored == VOX_CELLS_STORED_CENTRE;
    Cells cells(held.count() + asking.count());
    const auto put = [&](const Boxes& boxes, double grown, bool second) {
        for (std::size_t i = 0; i < boxes.count(); ++i) {
            PlainBox box = boxes.box(i);
            box.grow(grown);
            lattice.cells(centres ? box.centre() : box, [&](const Key& k) {
                cells.add(k, !second, second);
                ++work.stored;
            });
        }
    };
    put(held, pairs && !kind.two_sets ? radius : 0, false);
    if (pairs && kind.two_sets) put(asking, radius, true);
    work.occupied = static_cast<double>(cells.count());
    if (pairs) {
        for (const Cell& c : cells.places())
            if (!Cells::free(c)) work.reads += kind.two_sets ? c.held * c.asking : c.held * (c.held - 1) / 2;
        work.visits = work.occupied;
        return work;
    }
    const auto look = [&](const Key& k) {
        ++work.visits;
        const Cell& found = cells.find(k);
        work.empty += Cells::free(found);
        work.reads += found.held;
    };
    for (std::size_t i = 0; i < asking.count(); ++i) {
        PlainBox box = asking.box(i);
        box.grow(radius);
        if (kind.queried == VOX_CELLS_QUERIED_27) {
            const Key c = lattice.cell(box.centre().lo);
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    for (int z = -1; z <= 1; ++z) look({c.x + x, c.y + y, c.z + z});
        } else
            lattice.cells(box, look);
    }
    return work;
}

vox_foreign_counts mean_count(const Kind& kind, const Boxes& held, const Boxes& asking, double radius,
                              double d, int positions, std::uint64_t seed) {
    // Additive recurrences with powers of the plastic number of three dimensions: evenly spread positions.
    Random random{seed};
    double at[3] = {random.unit(), random.unit(), random.unit()};
    constexpr double step[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    vox_foreign_counts sum{};
    for (int i = 0; i < positions; ++i) {
        for (int a = 0; a < 3; ++a) at[a] = std::fmod(at[a] + step[a], 1);
        const Lattice lattice{d, {at[0] * d, at[1] * d, at[2] * d}};
        const vox_foreign_counts w = count_once(kind, held, asking, radius, lattice);
        sum.stored += w.stored / positions;
        sum.visits += w.visits / positions;
        sum.empty += w.empty / positions;
        sum.reads += w.reads / positions;
        sum.occupied += w.occupied / positions;
    }
    return sum;
}

double typical_size(const Boxes& boxes) {
    double sum = 0;
    for (std::size_t i = 0; i < boxes.count(); ++i) sum += boxes.box(i).longest_side();
    return sum > 0 ? sum / double(boxes.count()) : std::cbrt(1 / double(boxes.count()));
}

vox_foreign_grid describe(const Kind& kind, const vox_primitives& held, const vox_primitives& asking,
                          double radius) {
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.cells_stored = kind.stored;
    grid.cells_queried = kind.queried;
    grid.stored = &held;
    if (kind.two_sets) grid.querying = &asking;
    grid.radius = radius;
    return grid;
}

// The sanitizers look at memory, which every scene uses alike, and take ten times as long.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VOX_TESTS_FEWER_SCENES 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define VOX_TESTS_FEWER_SCENES 1
#endif
#ifdef VOX_TESTS_FEWER_SCENES
constexpr int scene_step = 4;
#else
constexpr int scene_step = 1;
#endif

// Long or crowded boxes are of several scenes, as their counts vary most with the boxes that stand for
// others.
struct CountedScene {
    Scene scene;
    std::uint64_t seed;
    std::size_t asking; // how many, where they are not those held
};
constexpr CountedScene counted_scenes[] = {
    {body, 1, 700},     {clumps, 100, 700}, {sticks, 100, 700}, {shell, 1, 700},    {cloud, 1, 700},
    {graded, 1, 700},   {wide, 1, 700},     {flat, 1, 700},     {lattice, 1, 700},  {body, 1, 2},
    {sticks, 102, 700}, {clumps, 102, 700}, {sticks, 104, 700}, {clumps, 104, 700},
};

START_TEST(counts_are_those_of_a_filled_grid) {
    const Kind& kind = kinds[_i];
    for (std::size_t n = 0; n < std::size(counted_scenes); n += std::size_t{scene_step}) {
        const Scene s = counted_scenes[n].scene;
        const std::uint64_t seed = counted_scenes[n].seed;
        const Boxes held = make(s, 1500, seed), others = make(s, counted_scenes[n].asking, seed + 1);
        const Boxes& asking = kind.two_sets ? others : held;
        const double size = typical_size(held), radius = kind.radius * size;
        const vox_primitives held_desc = held.describe(), asking_desc = asking.describe();
        const vox_foreign_grid grid = describe(kind, held_desc, asking_desc, radius);
        const double factors[] = {0.3, 1.0, 3.0};
        for (std::size_t f = 0; f < std::size(factors); ++f) {
            // One of the three in each scene, another one for the next kind of grid; all of them in long
            // runs.
            if (test_volume() == 1 && f != (n + std::size_t(_i)) % std::size(factors)) continue;
            const double d = factors[f] * size;
            vox_foreign_counts got{};
            const double cells = [&] {
                double sum = 0;
                for (std::size_t i = 0; i < held.count(); ++i) {
                    const PlainBox b = held.box(i);
                    sum += cells_met({b.side(0), b.side(1), b.side(2)}).at(d);
                }
                return sum;
            }();
            if (cells > 2e5) continue;
            const int positions = int(std::clamp(2e6 / (cells + 27e3), 24.0, 200.0));
            ck_assert_int_eq(vox_foreign_grid_count(&grid, d, &got), VOX_OK);
            const vox_foreign_counts real = mean_count(kind, held, asking, radius, d, positions, 7);
            const auto near = [&](double a, double b, double whole, const char* what) {
                ck_assert_msg(std::abs(a - b) <= 0.05 * whole, "%s, %s %d, cell size %g: %s %g, counted %g",
                              kind.name, scene_names[s], int(seed), d, what, a, b);
            };
            near(got.stored, real.stored, real.stored, "stored");
            near(got.visits, real.visits, real.visits, "visits");
            near(got.reads, real.reads, real.reads, "reads");
            near(got.empty, real.empty, real.visits, "empty");
            near(got.occupied, real.occupied, real.occupied, "occupied");
        }
    }
}
END_TEST

// ---- a quick look ---------------------------------------------------------------------------------

// What the cell size of a quick look costs more than the best one, by the counts of a thorough look.
double loss_of_quick(const vox_foreign_grid& desc, double* quick_size, double* best_size) {
    const ForeignGrid grid(&desc);
    ForeignWork quick(grid, quick_look(grid), heap),
        thorough(grid, {~std::uint64_t{0}, 1 << 16, 4096, 1024, 1, 1024, 0, 1024}, heap);
    const vox_cell_size_result found = suggest_for(grid, quick), best = suggest_for(grid, thorough);
    const auto cost = [&](double d) { return grid_cost(thorough.exactly_at(d), found.weights); };
    *quick_size = found.cell_size;
    *best_size = best.cell_size;
    return cost(found.cell_size) / cost(best.cell_size) - 1;
}

START_TEST(a_quick_look_loses_little) {
    const Kind& kind = kinds[_i];
    for (int s = 0; s < scene_count; s += scene_step) {
        const Boxes held = make(Scene(s), 12000, 1), others = make(Scene(s), 5000, 2);
        const vox_primitives held_desc = held.describe(), asking_desc = others.describe();
        vox_foreign_grid grid = describe(kind, held_desc, asking_desc, kind.radius * typical_size(held));
        grid.weights = {0, 12, 4, 4, 2, s % 2 ? 40.0 : 0.0, 0};
        double quick = 0, best = 0;
        const double loss = loss_of_quick(grid, &quick, &best);
        ck_assert_msg(loss <= 0.08, "%s, %s: %g instead of %g costs %.1f %% more", kind.name, scene_names[s],
                      quick, best, 100 * loss);
    }
}
END_TEST

// The pairs that are looked at and the memory that is taken hardly grow with the scene.
START_TEST(a_quick_look_looks_at_few) {
    const Kind& kind = kinds[_i];
    for (const std::size_t count : {2000u, 20000u, 200000u}) {
        const Boxes held = make(body, count, 1), others = make(body, count / 4, 2);
        const vox_primitives held_desc = held.describe(), asking_desc = others.describe();
        const vox_foreign_grid desc =
            describe(kind, held_desc, asking_desc, kind.radius * typical_size(held));
        const ForeignGrid grid(&desc);
        CountingMemory memory;
        ForeignWork work(grid, quick_look(grid), &memory);
        (void)suggest_for(grid, work);
        const std::size_t most = count > 65536 ? 120000 : 50000;
        ck_assert_msg(work.pairs_looked_at() <= most, "%s, %zu boxes: %llu pairs", kind.name, count,
                      static_cast<unsigned long long>(work.pairs_looked_at()));
        ck_assert_msg(memory.peak <= (count > 65536 ? 2u << 20 : 1u << 20), "%s, %zu boxes: %zu bytes",
                      kind.name, count, memory.peak);
        ck_assert_msg(memory.allocations <= 100, "%s, %zu boxes: %zu allocations", kind.name, count,
                      memory.allocations);
    }
}
END_TEST

} // namespace

SUITE(foreign_grid) {
    TCase* tests = add_case(suite, "foreign_grid");
    tcase_add_loop_test(tests, counts_are_those_of_a_filled_grid, 0, int(std::size(kinds)));
    tcase_add_loop_test(tests, a_quick_look_loses_little, 0, int(std::size(kinds)));
    tcase_add_loop_test(tests, a_quick_look_looks_at_few, 0, int(std::size(kinds)));
}
