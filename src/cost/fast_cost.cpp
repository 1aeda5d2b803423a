#include "fast_cost.hpp"

#include "../fast/pairs.hpp"
#include "../fast/query.hpp"
#include "../fast/rest.hpp"
#include "../fast/stream.hpp"
#include "../filter.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

using fast::Box;

namespace {

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
};

// The boxes of everything, one list for all bodies, found as the engine finds them: those of blocks from one
// pass over the positions, those of tiles where somebody may look.
class Boxes {
public:
    Boxes(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
          std::pmr::memory_resource* memory)
        : tiles_(tiles), rounded_(memory), positions_(memory), bodies_(memory), blocks_(memory),
          tile_boxes_(memory), known_(memory), first_block_(memory), first_tile_(memory) {
        std::size_t block_count = 0, tile_count = 0, rounded = 0;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            first_block_.push_back(block_count);
            first_tile_.push_back(tile_count);
            block_count += tiles[b]->block_count();
            tile_count += tiles[b]->tiles.size();
            if (!fast::is_packed(bodies[b].positions)) rounded += 3 * std::size_t{bodies[b].vertex_count};
        }
        blocks_.resize(block_count);
        tile_boxes_.resize(tile_count);
        known_.resize(tile_count);
        rounded_.resize(rounded);
        float* copy = rounded_.data();
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const Body& body = bodies[b];
            const float* positions = copy;
            if (fast::is_packed(body.positions))
                positions = reinterpret_cast<const float*>(body.positions.data);
            else
                for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
                    const Vec3f p = body.positions[v];
                    for (const float x : {p.x, p.y, p.z}) *copy++ = x;
                }
            positions_.push_back(positions);
            bodies_.push_back(fast::empty_box);
            if (body.vertex_count > 0)
                (void)fast::stream_boxes(positions, tiles[b]->block_first, blocks_.data() + first_block_[b],
                                         bodies_.back());
        }
    }

    const float* positions(std::size_t body) const noexcept { return positions_[body]; }
    std::span<const Box> bodies() const noexcept { return bodies_; }
    std::span<const Box> blocks(std::size_t body) const noexcept {
        return {blocks_.data() + first_block_[body], tiles_[body]->block_count()};
    }

    // Calls visit(box) for the tiles of a body that meet a region.
    template <class Visit>
    void for_tiles(std::size_t body, const Box& region, Visit&& visit) {
        const fast::Tiles& tiles = *tiles_[body];
        Box* boxes = tile_boxes_.data() + first_tile_[body];
        for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) {
            Box super = fast::empty_box;
            for (const std::uint32_t block : tiles.blocks[s])
                fast::add(super, blocks_[first_block_[body] + block]);
            if (!fast::overlap(super, region)) continue;
            const std::uint32_t first = tiles.super_first[s], last = tiles.super_first[s + 1];
            fast::tile_boxes(tiles, positions_[body], first, last, boxes, known_.data() + first_tile_[body]);
            for (std::uint32_t t = first; t < last; ++t)
                if (fast::overlap(boxes[t], region)) visit(boxes[t]);
        }
    }

private:
    std::span<const fast::Tiles* const> tiles_;
    std::pmr::vector<float> rounded_;
    std::pmr::vector<const float*> positions_; // of each body, packed
    std::pmr::vector<Box> bodies_, blocks_, tile_boxes_;
    std::pmr::vector<std::uint8_t> known_;
    std::pmr::vector<std::size_t> first_block_, first_tile_;
};

std::pmr::vector<Reach> find_reaches(std::span<const Body> bodies, std::span<const Activity> activity,
                                     Boxes& boxes, std::pmr::memory_resource* memory) {
    fast::PairBuffers buffers(memory);
    std::pmr::vector<fast::Pair> pairs(memory);
    std::pmr::vector<Reach> reaches(memory);
    fast::find_pairs(boxes.bodies(), buffers, pairs);
    for (const fast::Pair& pair : pairs) {
        if (bodies[pair.b].tets.empty() || !collide(bodies[pair.a], bodies[pair.b])) continue;
        if (!activity.empty() && !activity[pair.a].moves && !activity[pair.b].moves) continue;
        Reach reach{pair.a, pair.b, boxes.bodies()[pair.a]};
        fast::intersect(reach.region, boxes.bodies()[pair.b]);
        Box covered = fast::empty_box;
        for (const Box& block : boxes.blocks(pair.a))
            if (fast::overlap(block, reach.region)) fast::add(covered, block);
        fast::intersect(reach.region, covered);
        if (fast::is_empty(reach.region)) continue;
        covered = fast::empty_box;
        boxes.for_tiles(pair.b, reach.region, [&](const Box& tile) { fast::add(covered, tile); });
        fast::intersect(reach.region, covered);
        if (!fast::is_empty(reach.region)) reaches.push_back(reach);
    }
    return reaches;
}

// The points of the blocks that meet one of the regions, and lie in the box around them all.
void collect(const Boxes& boxes, const fast::Tiles& tiles, std::uint32_t body, bool all,
             std::span<const Reach> reaches, const Box& around, fast::Points& points) {
    const std::span<const Box> blocks = boxes.blocks(body);
    const auto is_wanted = [&](const Box& block) {
        return all || std::any_of(reaches.begin(), reaches.end(),
                                  [&](const Reach& r) { return fast::overlap(block, r.region); });
    };
    points.count = 0;
    for (std::size_t b = 0; b < blocks.size();) { // runs of wanted blocks
        const std::size_t begin = b;
        while (b < blocks.size() && is_wanted(blocks[b])) ++b;
        if (b == begin) {
            ++b;
            continue;
        }
        const std::uint32_t first = tiles.block_first[begin], last = tiles.block_first[b];
        points.reserve(std::size_t{points.count} + (last - first));
        fast::collect(boxes.positions(body), first, last, tiles.block_first.back(), around, points);
    }
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
    Boxes boxes(bodies, tiles, memory);
    const std::pmr::vector<Reach> reaches = find_reaches(bodies, activity, boxes, memory);

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
        pool.cells.add(cells_met(sides_of(window).w));
        for (std::uint32_t i = 0; i < points.count; ++i) points.id[i] += first_vertex;
        append(points, pool.points);
        const auto look = [&](std::uint32_t b, Box where) {
            fast::intersect(where, window);
            boxes.for_tiles(b, where, [&](Box box) {
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
            });
        };
        if (self) look(a, region);
        for (const Reach& r : own) look(r.b, r.region);
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
void FastCost::Pool::add(double cell_size, Lie lie, std::size_t most_looks, Counts& sum) const noexcept {
    const std::size_t stride = looks.size() / most_looks + 1;
    const double inverse = 1 / cell_size;
    double rows = 0, visited = 0, mean = 0, as_laid = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1) {
        const Look& look = looks[i];
        double along[3];                    // cells along each axis
        double volume = 1, volume_laid = 1; // so much of them as is in the window
        for (int a = 0; a < 3; ++a) {
            const double below = std::min(look.below[a] * inverse, 1.0),
                         above = std::min(look.above[a] * inverse, 1.0);
            const double side = look.side[a] * inverse + below * (1 - below / 2) + above * (1 - above / 2);
            volume *= side;
            if (lie == Lie::in_the_mean) {
                along[a] = std::max(side, 1.0);
                continue;
            }
            const double first = std::floor(look.below[a] * inverse);
            const double last = std::floor((look.below[a] + look.side[a]) * inverse);
            const double end = (look.below[a] + look.side[a] + look.above[a]) * inverse;
            along[a] = last - first + 1;
            volume_laid *= std::min(last + 1, end) - first;
        }
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
