#include "fast_cost.hpp"

#include "../fast/pairs.hpp"
#include "../filter.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

using fast::Box;

namespace {

// So many times the looks that are gone through for each cell size are enough to know how many of which size
// there are.
constexpr std::size_t looks_to_take = 16;

// As in fast/body_window.cpp: most cells of a window.
std::size_t most_cells(std::uint32_t points) { return 2 * std::size_t{points} + 64; }

struct Sides {
    double w[3];
};
Sides sides_of(const Box& box) {
    Sides s{};
    for (int a = 0; a < 3; ++a) s.w[a] = double{box.hi[a]} - double{box.lo[a]};
    return s;
}

// Vertices of body a may be in tiles of body b, and then are in `region`.
struct Reach {
    std::uint32_t a, b;
    Box region;
    std::size_t first_tile, last_tile; // those tiles, in a list of their boxes
};

// `met` are the boxes of the tiles.
std::pmr::vector<Reach> find_reaches(std::span<const Body> bodies, std::span<const Activity> activity,
                                     SceneBoxes& boxes, std::pmr::vector<Box>& met,
                                     std::pmr::memory_resource* memory) {
    fast::PairBuffers buffers(memory);
    std::pmr::vector<fast::Pair> pairs(memory);
    std::pmr::vector<Reach> reaches(memory);
    fast::find_pairs(boxes.bodies(), buffers, pairs);
    for (const fast::Pair& pair : pairs) {
        if (bodies[pair.b].tets.empty() || !collide(bodies[pair.a], bodies[pair.b])) continue;
        if (!activity.empty() && !activity[pair.a].moves && !activity[pair.b].moves) continue;
        Box region = boxes.bodies()[pair.a];
        fast::intersect(region, boxes.bodies()[pair.b]);
        Box covered = fast::empty_box;
        for (const Box& block : boxes.blocks(pair.a))
            if (fast::overlap(block, region)) fast::add(covered, block);
        fast::intersect(region, covered);
        if (fast::is_empty(region)) continue;
        const std::size_t first_tile = met.size();
        boxes.find_tiles(pair.b, region, met);
        covered = fast::empty_box;
        for (std::size_t t = first_tile; t < met.size(); ++t) fast::add(covered, met[t]);
        fast::intersect(region, covered);
        if (fast::is_empty(region))
            met.resize(first_tile);
        else
            reaches.push_back({pair.a, pair.b, region, first_tile, met.size()});
    }
    return reaches;
}

// The points of the blocks that meet one of the regions, and lie in the box around them all.
void collect(const SceneBoxes& boxes, const fast::Tiles& tiles, std::uint32_t body, bool all,
             std::span<const Reach> reaches, const Box& around, fast::Points& points) {
    const std::span<const Box> blocks = boxes.blocks(body);
    const auto is_wanted = [&](const Box& block) {
        return all || std::any_of(reaches.begin(), reaches.end(),
                                  [&](const Reach& r) { return fast::overlap(block, r.region); });
    };
    points.count = 0;
    std::uint32_t first = 0, last = 0; // of a run of wanted blocks
    const auto collect_run = [&] {
        if (first == last) return;
        points.reserve(std::size_t{points.count} + (last - first));
        fast::collect(boxes.positions(body), first, last, around, points);
    };
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (!is_wanted(blocks[b])) continue;
        if (tiles.block_first[b] != last) {
            collect_run();
            first = tiles.block_first[b];
        }
        last = tiles.block_first[b + 1];
    }
    collect_run();
}

// The points may change places.
void append(fast::Points& from, fast::Points& to) {
    if (to.count == 0) {
        std::swap(from, to);
        return;
    }
    to.reserve(to.count + std::size_t{from.count});
    const auto copy = [&](const auto& a, auto& b) {
        std::copy_n(a.begin(), from.count, b.begin() + to.count);
    };
    copy(from.x, to.x);
    copy(from.y, to.y);
    copy(from.z, to.z);
    copy(from.id, to.id);
    to.count += from.count;
}

} // namespace

Effort quick_tiles(std::uint64_t tets) noexcept {
    const std::size_t lookups = std::clamp<std::size_t>(static_cast<std::size_t>(tets / 2048), 8, 32);
    return {0, {lookups, 2 * lookups + 32, lookups + 8}, std::max<std::size_t>(lookups, 16), true};
}

FastCost::FastCost(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
                   std::span<const Activity> activity, const Effort& effort, const vox_cost_weights& weights,
                   std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights), most_looks_(effort.most_looks) {
    SceneBoxes boxes(bodies, tiles, memory);
    look(bodies, tiles, activity, boxes, effort, memory);
}

FastCost::FastCost(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
                   std::span<const Activity> activity, SceneBoxes& boxes, const Effort& effort,
                   const vox_cost_weights& weights, std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights), most_looks_(effort.most_looks) {
    look(bodies, tiles, activity, boxes, effort, memory);
}

void FastCost::look(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
                    std::span<const Activity> activity, SceneBoxes& boxes, const Effort& effort,
                    std::pmr::memory_resource* memory) {
    std::pmr::vector<Box> met(memory);
    const std::pmr::vector<Reach> reaches = find_reaches(bodies, activity, boxes, met, memory);
    std::size_t all = met.size();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (bodies[b].self_collision) all += tiles[b]->tiles.size();
    // Of very many looks, every so many.
    const std::size_t stride = all / (looks_to_take * most_looks_) + 1;
    std::size_t seen = stride / 2;

    fast::Points points(memory);
    std::uint32_t first_vertex = 0;
    auto reach = reaches.begin(); // sorted by a
    for (std::uint32_t a = 0; a < bodies.size(); first_vertex += bodies[a].vertex_count, ++a) {
        const auto begin = reach;
        while (reach != reaches.end() && reach->a == a) ++reach;
        const std::span<const Reach> own(begin, reach);
        const bool self = bodies[a].self_collision && !bodies[a].tets.empty() &&
                          (activity.empty() || activity[a].meets_itself);
        Box region = self ? boxes.bodies()[a] : fast::empty_box;
        for (const Reach& r : own) fast::add(region, r.region);
        if (fast::is_empty(region)) continue;
        collect(boxes, *tiles[a], a, self, own, region, points);
        if (points.count == 0) continue;

        const Box window = fast::bounds(points);
        const fast::Lattice finest = fast::make_lattice(window, 0, most_cells(points.count));
        Pool& pool = pool_of(1 / double{finest.inverse}, effort.sample);
        pool.windows += 1;
        pool.smallest_cell += 1 / double{finest.inverse};
        const Sides sides = sides_of(window);
        pool.cells.add(cells_met(sides.w));
        pool.largest_side = std::max({pool.largest_side, sides.w[0], sides.w[1], sides.w[2]});
        for (std::uint32_t i = 0; i < points.count; ++i) points.id[i] += first_vertex;
        append(points, pool.points);
        const auto look = [&](std::span<const Box> tile_boxes, Box where) {
            fast::intersect(where, window);
            for (Box box : tile_boxes) {
                if (!fast::overlap(box, where) || seen++ % stride != 0) continue;
                fast::intersect(box, where);
                Lookup lookup{};
                Look& look = pool.looks.emplace_back();
                for (int i = 0; i < 3; ++i) {
                    lookup.lo[i] = box.lo[i];
                    lookup.hi[i] = box.hi[i];
                    look.side[i] = double{box.hi[i]} - double{box.lo[i]};
                    look.below[i] = double{box.lo[i]} - double{window.lo[i]};
                    look.above[i] = double{window.hi[i]} - double{box.hi[i]};
                }
                lookup.first_read = first_vertex;
                lookup.last_read = first_vertex + bodies[a].vertex_count;
                pool.profile.add(lookup, static_cast<double>(stride));
            }
        };
        if (self) {
            const std::size_t first_tile = met.size();
            boxes.find_tiles(a, region, met);
            look(std::span(met).subspan(first_tile), region);
            met.resize(first_tile);
        }
        for (const Reach& r : own)
            look(std::span(met).subspan(r.first_tile, r.last_tile - r.first_tile), r.region);
    }
    for (Pool& pool : pools_) {
        pool.profile.count_points(pool.points, Occupied::not_counted);
        pool.smallest_cell /= pool.windows;
    }
}

FastCost::Pool& FastCost::pool_of(double smallest_cell, const SampleSizes& sizes) {
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest_cell)));
    for (Pool& pool : pools_)
        if (pool.key == key) return pool;
    return pools_.emplace_back(key, sizes, pools_.get_allocator().resource());
}

// In the mean, a side has this much added to it along an axis by whole cells, inside the window: a point at
// distance e from the side is in one of its cells with probability 1 - e/d.
double FastCost::Pool::along(const Look& look, int axis, double inverse) noexcept {
    const double below = std::min(look.below[axis] * inverse, 1.0),
                 above = std::min(look.above[axis] * inverse, 1.0);
    return look.side[axis] * inverse + below * (1 - below / 2) + above * (1 - above / 2);
}

void FastCost::Pool::add(double cell_size, Lie lie, std::size_t most_looks, Counts& sum) const noexcept {
    sum.vertices += points.count;
    sum.cells += cells.at(cell_size);
    sum.looks += profile.count();
    sum.tested += profile.candidates();
    if (looks.empty()) return;
    if (lie == Lie::in_the_mean) sum.rows += mean_rows(cell_size, most_looks);
    sum.read += profile.read(cell_size) * (lie == Lie::as_it_is ? laid(cell_size, most_looks, sum) : 1);
}

double FastCost::Pool::mean_rows(double cell_size, std::size_t most_looks) const noexcept {
    if (cell_size >= largest_side) return profile.count(); // all in one cell
    const std::size_t stride = looks.size() / most_looks + 1;
    const double inverse = 1 / cell_size;
    double rows = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1)
        rows += std::max(along(looks[i], 1, inverse), 1.0) * std::max(along(looks[i], 2, inverse), 1.0);
    return rows * (profile.count() / count);
}

double FastCost::Pool::laid(double cell_size, std::size_t most_looks, Counts& sum) const noexcept {
    const std::size_t stride = looks.size() / most_looks + 1;
    const double inverse = 1 / cell_size;
    double rows = 0, visited = 0, mean = 0, as_laid = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1) {
        const Look& look = looks[i];
        double cells[3];                    // along each axis
        double volume = 1, volume_laid = 1; // so much of them as is in the window
        for (int a = 0; a < 3; ++a) {
            volume *= along(look, a, inverse);
            const double first = std::floor(look.below[a] * inverse);
            const double last = std::floor((look.below[a] + look.side[a]) * inverse);
            const double end = (look.below[a] + look.side[a] + look.above[a]) * inverse;
            cells[a] = last - first + 1;
            volume_laid *= std::min(last + 1, end) - first;
        }
        rows += cells[1] * cells[2];
        visited += cells[0] * cells[1] * cells[2];
        mean += volume;
        as_laid += volume_laid;
    }
    const double scale = profile.count() / count;
    sum.rows += rows * scale;
    sum.visited_cells += visited * scale;
    return mean > 0 ? as_laid / mean : 1;
}

bool FastCost::range(double& min, double& max) const noexcept {
    bool any = false;
    for (const Pool& pool : pools_) {
        double smallest = 0, largest = 0;
        if (!pool.profile.sides(smallest, largest)) continue;
        smallest = std::min(smallest, pool.smallest_cell);
        min = any ? std::min(min, smallest) : smallest;
        max = any ? std::max(max, largest) : largest;
        any = true;
    }
    max *= 2;
    return any;
}

FastCost::Counts FastCost::counts(double cell_size, Lie lie) const {
    Counts sum;
    for (const Pool& pool : pools_) pool.add(pool.effective(cell_size), lie, most_looks_, sum);
    return sum;
}

CostTerms FastCost::terms(double cell_size, Lie lie) const {
    const Counts c = counts(cell_size, lie);
    CostTerms terms;
    terms.add("bin a vertex", c.vertices, weights_.fast_bin_vertex);
    terms.add("clear a cell", c.cells, weights_.fast_clear_cell);
    terms.add("visit a tile", c.looks, weights_.fast_visit_tile);
    terms.add("visit a row", c.rows, weights_.fast_visit_row);
    terms.add("read a vertex", c.read, weights_.fast_read_vertex);
    terms.add("test a vertex", c.tested, weights_.fast_test_vertex);
    return terms;
}

} // namespace vox
