#include "cell_size/fast_model.hpp"

#include "fast/broad_phase.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <cmath>

namespace vox {


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

void append(const fast::Points& from, std::size_t first, std::uint32_t count, fast::Points& to) {
    to.reserve(std::size_t{to.count} + count);
    const auto copy = [&](const auto& a, auto& b) {
        std::copy_n(a.begin() + static_cast<std::ptrdiff_t>(first), count, b.begin() + to.count);
    };
    copy(from.x, to.x);
    copy(from.y, to.y);
    copy(from.z, to.z);
    copy(from.id, to.id);
    to.count += count;
}

// What is near what, from the positions as they are now.
class FromPositions {
public:
    FromPositions(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
                  std::span<const Activity> activity, SceneBoxes& boxes, std::pmr::memory_resource* memory)
        : bodies_(bodies), tiles_(tiles), activity_(activity), boxes_(boxes), memory_(memory) {}

    // `met` are the boxes of the tiles.
    void find_reaches(std::pmr::vector<Reach>& reaches, std::pmr::vector<Box>& met) {
        fast::PairBuffers buffers(memory_);
        std::pmr::vector<fast::Pair> pairs(memory_);
        fast::find_pairs(boxes_.bodies(), buffers, pairs);
        for (const fast::Pair& pair : pairs) {
            if (bodies_[pair.b].tets.empty() || !collide(bodies_[pair.a], bodies_[pair.b])) continue;
            if (!activity_.empty() && !activity_[pair.a].moves && !activity_[pair.b].moves) continue;
            Box region = boxes_.bodies()[pair.a];
            intersect(region, boxes_.bodies()[pair.b]);
            Box covered = empty_box;
            for (const Box& block : boxes_.blocks(pair.a))
                if (overlap(block, region)) add(covered, block);
            intersect(region, covered);
            if (is_empty(region)) continue;
            const std::size_t first_tile = met.size();
            boxes_.find_tiles(pair.b, region, met);
            covered = empty_box;
            for (std::size_t t = first_tile; t < met.size(); ++t) add(covered, met[t]);
            intersect(region, covered);
            if (is_empty(region))
                met.resize(first_tile);
            else
                reaches.push_back({pair.a, pair.b, region, first_tile, met.size()});
        }
    }

    Box own_region(std::uint32_t body) const {
        const bool self = bodies_[body].self_collision && !bodies_[body].tets.empty() &&
                          (activity_.empty() || activity_[body].meets_itself);
        return self ? boxes_.bodies()[body] : empty_box;
    }

    void find_tiles(std::uint32_t body, const Box& region, std::pmr::vector<Box>& met) {
        boxes_.find_tiles(body, region, met);
    }

    // The points of the blocks that meet one of the regions, and lie in the box around them all.
    void collect(std::uint32_t body, std::span<const Reach> reaches, const Box& own, const Box& around,
                 fast::Points& points) const {
        const std::span<const Box> blocks = boxes_.blocks(body);
        const std::pmr::vector<std::uint32_t>& first_of = tiles_[body]->block_first;
        const bool all = !is_empty(own);
        const auto is_wanted = [&](const Box& block) {
            return all || std::any_of(reaches.begin(), reaches.end(),
                                      [&](const Reach& r) { return overlap(block, r.region); });
        };
        std::uint32_t first = 0, last = 0; // of a run of wanted blocks
        const auto collect_run = [&] {
            if (first == last) return;
            points.reserve(std::size_t{points.count} + (last - first));
            fast::collect(boxes_.positions(body), first, last, first_of.back(), around, points);
        };
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            if (!is_wanted(blocks[b])) continue;
            if (first_of[b] != last) {
                collect_run();
                first = first_of[b];
            }
            last = first_of[b + 1];
        }
        collect_run();
    }

private:
    std::span<const Body> bodies_;
    std::span<const Tiles* const> tiles_;
    std::span<const Activity> activity_;
    SceneBoxes& boxes_;
    std::pmr::memory_resource* memory_;
};

// The same from the engine's last step.
class FromLastStep {
public:
    FromLastStep(std::span<const Body> bodies, const FastEngine& engine) : bodies_(bodies), engine_(engine) {}

    void find_reaches(std::pmr::vector<Reach>& reaches, std::pmr::vector<Box>& met) const {
        for (const fast::PairRegion& pair : engine_.broad_phase().regions) {
            if (is_empty(pair.region)) continue;
            const std::size_t first_tile = met.size();
            find_tiles(pair.b, pair.region, met);
            reaches.push_back({pair.a, pair.b, pair.region, first_tile, met.size()});
        }
    }
    Box own_region(std::uint32_t body) const {
        return !engine_.cleared(body, bodies_[body].vertex_count) ? engine_.windows().of[body].own : empty_box;
    }
    void find_tiles(std::uint32_t body, const Box& region, std::pmr::vector<Box>& met) const {
        const fast::StepBoxes& boxes = engine_.boxes();
        const std::pmr::vector<fast::StepBody>& of = engine_.last_step().of;
        const std::size_t end = body + 1 < of.size() ? of[body + 1].first_tile : boxes.tiles.size();
        for (std::size_t t = of[body].first_tile; t < end; ++t)
            if (boxes.tile_known[t] && overlap(boxes.tiles[t], region)) met.push_back(boxes.tiles[t]);
    }
    void collect(std::uint32_t body, std::span<const Reach>, const Box&, const Box&,
                 fast::Points& points) const {
        const fast::BodyWindow& of = engine_.windows().of[body];
        if (!of.bins) return;
        for (std::uint32_t w = of.root; w < of.bins->windows[of.root].end; ++w) {
            const fast::Window& window = of.bins->windows[w];
            if (window.count) append(of.bins->points, window.first_point, window.count, points);
        }
    }

private:
    std::span<const Body> bodies_;
    const FastEngine& engine_;
};

} // namespace

SampleBudget quick_tiles(std::uint64_t tets) noexcept {
    const std::size_t lookups = std::clamp<std::size_t>(static_cast<std::size_t>(tets / 2048), 4, 32);
    return {0, {lookups, 2 * lookups + 32, lookups + 8}, std::max<std::size_t>(lookups, 16), true};
}

FastModel::FastModel(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
                   std::span<const Activity> activity, const SampleBudget& effort, const vox_cost_weights& weights,
                   std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights), most_looks_(effort.most_looks) {
    SceneBoxes boxes(bodies, tiles, memory);
    look(bodies, FromPositions(bodies, tiles, activity, boxes, memory), effort, memory);
}

FastModel::FastModel(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
                   std::span<const Activity> activity, SceneBoxes& boxes, const SampleBudget& effort,
                   const vox_cost_weights& weights, std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights), most_looks_(effort.most_looks) {
    look(bodies, FromPositions(bodies, tiles, activity, boxes, memory), effort, memory);
}

FastModel::FastModel(std::span<const Body> bodies, const FastEngine& last_step, const SampleBudget& effort,
                   const vox_cost_weights& weights, std::pmr::memory_resource* memory)
    : pools_(memory), weights_(weights), most_looks_(effort.most_looks) {
    look(bodies, FromLastStep(bodies, last_step), effort, memory);
}

template <class Source>
void FastModel::look(std::span<const Body> bodies, Source&& source, const SampleBudget& effort,
                    std::pmr::memory_resource* memory) {
    std::pmr::vector<Box> met(memory);
    std::pmr::vector<Reach> reaches(memory);
    source.find_reaches(reaches, met);
    std::size_t all = met.size();
    for (const Body& body : bodies)
        if (body.self_collision) all += body.tets.size() / tile_size;
    // Of very many looks, every so many.
    const std::size_t stride = all / (looks_to_take * most_looks_) + 1;
    std::size_t seen = stride / 2;

    fast::Points points(memory);
    std::uint32_t first_vertex = 0;
    const Reach* reach = reaches.data(); // sorted by a
    const Reach* const last_reach = reach + reaches.size();
    for (std::uint32_t a = 0; a < bodies.size(); first_vertex += bodies[a].vertex_count, ++a) {
        const Reach* const begin = reach;
        while (reach != last_reach && reach->a == a) ++reach;
        const std::span<const Reach> own(begin, reach);
        const Box own_region = source.own_region(a);
        Box region = own_region;
        for (const Reach& r : own) add(region, r.region);
        if (is_empty(region)) continue;
        points.count = 0;
        source.collect(a, own, own_region, region, points);
        if (points.count == 0) continue;

        const Box window = fast::bounds(points);
        const fast::WindowLattice finest = fast::make_lattice(window, 0, most_cells(points.count));
        Pool& pool = pool_of(1 / double{finest.inverse}, effort.sample);
        pool.windows += 1;
        pool.smallest_cell += 1 / double{finest.inverse};
        const Sides sides = sides_of(window);
        pool.cells.add(cells_met(sides.w));
        pool.largest_side = std::max({pool.largest_side, sides.w[0], sides.w[1], sides.w[2]});
        for (std::uint32_t i = 0; i < points.count; ++i) points.id[i] += first_vertex;
        if (pool.points.count == 0)
            std::swap(points, pool.points);
        else
            append(points, 0, points.count, pool.points);
        const auto look = [&](std::span<const Box> tile_boxes, Box where) {
            intersect(where, window);
            for (Box box : tile_boxes) {
                if (!overlap(box, where) || seen++ % stride != 0) continue;
                intersect(box, where);
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
        if (!is_empty(own_region)) {
            const std::size_t first_tile = met.size();
            source.find_tiles(a, own_region, met);
            look(std::span(met).subspan(first_tile), own_region);
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

FastModel::Pool& FastModel::pool_of(double smallest_cell, const SampleSizes& sizes) {
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest_cell)));
    for (Pool& pool : pools_)
        if (pool.key == key) return pool;
    return pools_.emplace_back(key, sizes, pools_.get_allocator().resource());
}

// In the mean, a side has this much added to it along an axis by whole cells, inside the window: a point at
// distance e from the side is in one of its cells with probability 1 - e/d.
double FastModel::Pool::along(const Look& look, int axis, double inverse) noexcept {
    const double below = std::min(look.below[axis] * inverse, 1.0),
                 above = std::min(look.above[axis] * inverse, 1.0);
    return look.side[axis] * inverse + below * (1 - below / 2) + above * (1 - above / 2);
}

void FastModel::Pool::add(double cell_size, Alignment lie, std::size_t most_looks, Counts& sum) const noexcept {
    sum.vertices += points.count;
    sum.cells += cells.at(cell_size);
    sum.looks += profile.count();
    sum.tested += profile.candidates();
    if (looks.empty()) return;
    if (lie == Alignment::average) sum.rows += mean_rows(cell_size, most_looks);
    sum.read += profile.read(cell_size) * (lie == Alignment::actual ? laid(cell_size, most_looks, sum) : 1);
}

double FastModel::Pool::mean_rows(double cell_size, std::size_t most_looks) const noexcept {
    if (cell_size >= largest_side) return profile.count(); // all in one cell
    const std::size_t stride = looks.size() / most_looks + 1;
    const double inverse = 1 / cell_size;
    double rows = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1)
        rows += std::max(along(looks[i], 1, inverse), 1.0) * std::max(along(looks[i], 2, inverse), 1.0);
    return rows * (profile.count() / count);
}

double FastModel::Pool::laid(double cell_size, std::size_t most_looks, Counts& sum) const noexcept {
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

FastModel::Work FastModel::work() const noexcept {
    Work work;
    for (const Pool& pool : pools_) {
        const std::size_t stride = pool.looks.size() / most_looks_ + 1;
        work.points += pool.profile.points_looked_at();
        work.looks += (pool.looks.size() + stride - 1) / stride;
    }
    return work;
}

bool FastModel::range(double& min, double& max) const noexcept {
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

FastModel::Counts FastModel::counts(double cell_size, Alignment lie) const {
    Counts sum;
    for (const Pool& pool : pools_) pool.add(pool.effective(cell_size), lie, most_looks_, sum);
    return sum;
}

CostTerms FastModel::terms(double cell_size, Alignment lie) const {
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
