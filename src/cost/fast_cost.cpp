#include "fast_cost.hpp"

#include "../fast/pairs.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

using fast::Box;

namespace {

// As in fast/body_window.cpp: most cells of a window.
std::size_t most_cells(std::uint32_t points) { return 2 * std::size_t{points} + 64; }

template <class Position>
void extend(Box& box, const Position& p) {
    const float c[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    for (int a = 0; a < 3; ++a) {
        box.lo[a] = std::min(box.lo[a], c[a]);
        box.hi[a] = std::max(box.hi[a], c[a]);
    }
}

Box block_box(const Body& body, const fast::Tiles& tiles, std::uint32_t block) {
    Box box = fast::empty_box;
    for (std::uint32_t v = tiles.block_first[block]; v < tiles.block_first[block + 1]; ++v)
        extend(box, body.positions[v]);
    return box;
}

Box tile_box(const Body& body, const fast::Tiles& tiles, const fast::Tile& tile) {
    Box box = fast::empty_box;
    for (std::uint32_t i = 0; i < tile.vertex_count; ++i)
        extend(box, body.positions[tiles.vertices[tile.first_vertex + i]]);
    return box;
}

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
};

// The boxes of everything, one list for all bodies.
struct Boxes {
    explicit Boxes(std::pmr::memory_resource* memory)
        : bodies(memory), blocks(memory), tiles(memory), first_block(memory), first_tile(memory) {}

    std::pmr::vector<Box> bodies, blocks, tiles;
    std::pmr::vector<std::size_t> first_block, first_tile; // of each body, and the end
};

void measure(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles, Boxes& out) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        out.first_block.push_back(out.blocks.size());
        out.first_tile.push_back(out.tiles.size());
        Box all = fast::empty_box;
        for (std::uint32_t i = 0; i < tiles[b]->block_count(); ++i) {
            out.blocks.push_back(block_box(bodies[b], *tiles[b], i));
            fast::add(all, out.blocks.back());
        }
        for (const fast::Tile& tile : tiles[b]->tiles)
            out.tiles.push_back(tile_box(bodies[b], *tiles[b], tile));
        out.bodies.push_back(all);
    }
    out.first_block.push_back(out.blocks.size());
    out.first_tile.push_back(out.tiles.size());
}

template <class List>
std::span<const Box> of_body(const std::pmr::vector<Box>& boxes, const List& first, std::size_t body) {
    return std::span(boxes).subspan(first[body], first[body + 1] - first[body]);
}

// Cuts the region to the boxes of the list that meet it.
void shrink(Box& region, std::span<const Box> boxes) {
    Box covered = fast::empty_box;
    for (const Box& box : boxes)
        if (fast::overlap(box, region)) fast::add(covered, box);
    fast::intersect(region, covered);
    if (fast::is_empty(region)) region = fast::empty_box;
}

std::pmr::vector<Reach> find_reaches(std::span<const Body> bodies, const Boxes& boxes,
                                     std::pmr::memory_resource* memory) {
    fast::PairBuffers buffers(memory);
    std::pmr::vector<fast::Pair> pairs(memory);
    std::pmr::vector<Reach> reaches(memory);
    fast::find_pairs(boxes.bodies, buffers, pairs);
    for (const fast::Pair& pair : pairs) {
        if (bodies[pair.b].tets.empty()) continue;
        Reach reach{pair.a, pair.b, boxes.bodies[pair.a]};
        fast::intersect(reach.region, boxes.bodies[pair.b]);
        shrink(reach.region, of_body(boxes.blocks, boxes.first_block, pair.a));
        shrink(reach.region, of_body(boxes.tiles, boxes.first_tile, pair.b));
        if (!fast::is_empty(reach.region)) reaches.push_back(reach);
    }
    return reaches;
}

} // namespace

FastCost::FastCost(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
                   const Effort& effort, const vox_cost_weights& weights, std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights) {
    Boxes boxes(memory);
    measure(bodies, tiles, boxes);
    const std::pmr::vector<Reach> reaches = find_reaches(bodies, boxes, memory);

    fast::Points points(memory);
    std::uint32_t first_vertex = 0;
    auto reach = reaches.begin(); // sorted by a
    for (std::uint32_t a = 0; a < bodies.size(); first_vertex += bodies[a].vertex_count, ++a) {
        const auto begin = reach;
        while (reach != reaches.end() && reach->a == a) ++reach;
        const std::span<const Reach> own(begin, reach);
        const bool self = bodies[a].self_collision && !bodies[a].tets.empty();
        Box region = self ? boxes.bodies[a] : fast::empty_box;
        for (const Reach& r : own) fast::add(region, r.region);
        if (fast::is_empty(region)) continue;

        points.count = 0;
        points.reserve(bodies[a].vertex_count);
        const std::span<const Box> blocks = of_body(boxes.blocks, boxes.first_block, a);
        for (std::uint32_t b = 0; b < blocks.size(); ++b) {
            if (!self && std::none_of(own.begin(), own.end(),
                                      [&](const Reach& r) { return fast::overlap(blocks[b], r.region); }))
                continue;
            for (std::uint32_t v = tiles[a]->block_first[b]; v < tiles[a]->block_first[b + 1]; ++v) {
                const auto p = bodies[a].positions[v];
                Box at = fast::empty_box;
                extend(at, p);
                if (!fast::overlap(at, region)) continue;
                const std::uint32_t i = points.count++;
                points.x[i] = static_cast<float>(p.x);
                points.y[i] = static_cast<float>(p.y);
                points.z[i] = static_cast<float>(p.z);
                points.id[i] = first_vertex + v;
            }
        }
        if (points.count == 0) continue;

        const Box window = fast::bounds(points);
        const fast::Lattice finest = fast::make_lattice(window, 0, most_cells(points.count));
        Pool& pool = pool_of(1 / double{finest.inverse});
        pool.windows += 1;
        pool.smallest_cell += 1 / double{finest.inverse};
        pool.cells.add(cells_met(sides_of(window).w));
        pool.points.reserve(pool.points.count + std::size_t{points.count});
        for (std::uint32_t i = 0; i < points.count; ++i, ++pool.points.count) {
            pool.points.x[pool.points.count] = points.x[i];
            pool.points.y[pool.points.count] = points.y[i];
            pool.points.z[pool.points.count] = points.z[i];
            pool.points.id[pool.points.count] = points.id[i];
        }
        const auto look = [&](std::uint32_t b, Box where) {
            fast::intersect(where, window);
            for (Box box : of_body(boxes.tiles, boxes.first_tile, b)) {
                if (!fast::overlap(box, where)) continue;
                fast::intersect(box, where);
                Lookup lookup{};
                Look look{};
                for (int i = 0; i < 3; ++i) {
                    lookup.lo[i] = box.lo[i];
                    lookup.hi[i] = box.hi[i];
                    look.side[i] = double{box.hi[i]} - double{box.lo[i]};
                    look.below[i] = double{box.lo[i]} - double{window.lo[i]};
                    look.above[i] = double{window.hi[i]} - double{box.hi[i]};
                }
                pool.looks.push_back(look);
                lookup.first_read = first_vertex;
                lookup.last_read = first_vertex + bodies[a].vertex_count;
                pool.profile.add(lookup);
            }
        };
        if (self) look(a, region);
        for (const Reach& r : own) look(r.b, r.region);
    }
    for (Pool& pool : pools_) {
        pool.profile.count_points(pool.points, effort.sample);
        pool.smallest_cell /= pool.windows;
    }
}

FastCost::Pool& FastCost::pool_of(double smallest_cell) {
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest_cell)));
    for (Pool& pool : pools_)
        if (pool.key == key) return pool;
    return pools_.emplace_back(key, pools_.get_allocator().resource());
}

// In the mean, a side has this much added to it along an axis by whole cells, inside the window: a point at
// distance e from the side is in one of its cells with probability 1 - e/d.
void FastCost::Pool::add(double cell_size, Lie lie, Counts& sum) const noexcept {
    constexpr std::size_t most = 4096;
    const std::size_t stride = looks.size() / most + 1;
    const double inverse = 1 / cell_size;
    double rows = 0, visited = 0, mean = 0, as_laid = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1) {
        const Look& look = looks[i];
        double met[3], laid[3]; // cells along each axis, and so much of them that is in the window
        double volume = 1, volume_laid = 1;
        for (int a = 0; a < 3; ++a) {
            const double below = std::min(look.below[a] * inverse, 1.0),
                         above = std::min(look.above[a] * inverse, 1.0);
            const double side = look.side[a] * inverse + below * (1 - below / 2) + above * (1 - above / 2);
            met[a] = std::max(side, 1.0);
            volume *= side;
            const double first = std::floor(look.below[a] * inverse);
            const double last = std::floor((look.below[a] + look.side[a]) * inverse);
            const double end = (look.below[a] + look.side[a] + look.above[a]) * inverse;
            laid[a] = last - first + 1;
            volume_laid *= std::min(last + 1, end) - first;
        }
        const double(&along)[3] = lie == Lie::as_it_is ? laid : met;
        rows += along[1] * along[2];
        visited += along[0] * along[1] * along[2];
        mean += volume;
        as_laid += volume_laid;
    }
    sum.vertices += points.count;
    sum.cells += cells.at(cell_size);
    sum.looks += static_cast<double>(looks.size());
    sum.tested += profile.candidates();
    if (count == 0) return;
    const double scale = static_cast<double>(looks.size()) / count;
    sum.rows += rows * scale;
    sum.visited_cells += visited * scale;
    sum.read += profile.read(cell_size) * (lie == Lie::as_it_is && mean > 0 ? as_laid / mean : 1);
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
    for (const Pool& pool : pools_) pool.add(pool.effective(cell_size), lie, sum);
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
