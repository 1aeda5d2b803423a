#include "cell_size/fast_model.hpp"

#include "base/array.hpp"
#include "base/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace vox {

namespace {

// At most this multiple of the looks that are gone through for each cell size is kept, which is enough to
// know how many looks there are of each size.
constexpr std::size_t looks_to_keep = 16;

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

// Appends the vertices of a body that are binned: those of the last step's windows, or those near what the
// broad phase found.
void append_near(const CellSizeScene& scene, std::uint32_t body, const Box& own, const Box& around,
                 fast::Points& points) {
    if (!scene.last_step) {
        fast::collect_near(scene.step(), scene.boxes(), scene.broad_phase(), body, around, !is_empty(own),
                           nullptr, points);
        return;
    }
    const fast::BodyWindow& found = scene.last_step->windows().of[body];
    if (!found.bins) return;
    for (std::uint32_t w = found.root; w < found.bins->windows[found.root].end; ++w) {
        const fast::Window& window = found.bins->windows[w];
        if (window.count) append(found.bins->points, window.first_point, window.count, points);
    }
}

// Appends the boxes of the tiles of a body that meet a region.
void append_tiles(const CellSizeScene& scene, std::uint32_t body, const Box& region, Array<Box>& out) {
    const fast::StepBoxes& boxes = scene.boxes();
    const Array<fast::StepBody>& of = scene.step().of;
    const std::size_t end = body + 1 < of.size() ? of[body + 1].first_tile : boxes.tiles.size();
    for (std::size_t t = of[body].first_tile; t < end; ++t)
        if (boxes.tile_known[t] && overlap(boxes.tiles[t], region)) out.push_back(boxes.tiles[t]);
}

} // namespace

FastModel::FastModel(const CellSizeScene& scene, const CostWeights& weights)
    : pools_(scene.memory), weights_(weights), budget_(scene.budget) {
    const fast::BroadPhase& near = scene.broad_phase();
    Array<Box> tiles(scene.memory);              // that meet the regions
    Array<std::size_t> first_tile(scene.memory); // of each region in `tiles`, and the end
    first_tile.reserve(near.regions.size() + 1);
    for (const fast::PairRegion& pair : near.regions) {
        first_tile.push_back(tiles.size());
        append_tiles(scene, pair.b, pair.region, tiles);
    }
    first_tile.push_back(tiles.size());
    std::size_t all = tiles.size();
    for (const Body& body : scene.bodies)
        if (body.self_collision) all += body.tets.size() / tile_size;
    const std::size_t stride = stride_for(all, looks_to_keep * budget_.most_looks);
    std::size_t seen = stride / 2;

    fast::Points points(scene.memory);
    std::uint32_t first_vertex = 0;
    for (std::uint32_t a = 0; a < scene.bodies.size(); first_vertex += scene.bodies[a].vertex_count, ++a) {
        const Box own_region = scene.own_region(a);
        Box region = own_region;
        for (const fast::PairRegion& pair : near.of_a(a)) add(region, pair.region);
        if (is_empty(region)) continue;
        points.count = 0;
        append_near(scene, a, own_region, region, points);
        if (points.count == 0) continue;

        const Box window = fast::bounds(points);
        const fast::WindowLattice finest =
            fast::make_lattice(window, 0, fast::most_window_cells(points.count));
        Pool& pool = pool_of(1 / double{finest.inverse});
        pool.windows += 1;
        pool.smallest_cell += 1 / double{finest.inverse};
        double sides[3];
        for (int i = 0; i < 3; ++i) {
            sides[i] = double{window.hi[i]} - double{window.lo[i]};
            pool.largest_side = std::max(pool.largest_side, sides[i]);
        }
        pool.cells.add(cells_met(sides));
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
                Look& kept = pool.looks.emplace_back();
                for (int i = 0; i < 3; ++i) {
                    lookup.lo[i] = box.lo[i];
                    lookup.hi[i] = box.hi[i];
                    kept.side[i] = double{box.hi[i]} - double{box.lo[i]};
                    kept.below[i] = double{box.lo[i]} - double{window.lo[i]};
                    kept.above[i] = double{window.hi[i]} - double{box.hi[i]};
                }
                lookup.first_read = first_vertex;
                lookup.last_read = first_vertex + scene.bodies[a].vertex_count;
                pool.lookups.add(lookup, static_cast<double>(stride));
            }
        };
        if (!is_empty(own_region)) {
            const std::size_t first = tiles.size();
            append_tiles(scene, a, own_region, tiles);
            look(std::span(tiles).subspan(first), own_region);
            tiles.resize(first);
        }
        for (const fast::PairRegion& pair : near.of_a(a)) {
            const auto r = static_cast<std::size_t>(&pair - near.regions.data());
            look(std::span(tiles).subspan(first_tile[r], first_tile[r + 1] - first_tile[r]), pair.region);
        }
    }
    for (Pool& pool : pools_) {
        pool.lookups.count_points(pool.points, false);
        pool.smallest_cell /= pool.windows;
    }
}

FastModel::Pool& FastModel::pool_of(double smallest_cell) {
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest_cell)));
    for (Pool& pool : pools_)
        if (pool.key == key) return pool;
    return pools_.emplace_back(key, budget_, pools_.memory());
}

// Whole cells extend a box beyond each end along an axis, within the window: a point at distance e from the
// end is in a cell that the box meets with probability 1 - e/d.
double FastModel::Pool::along(const Look& look, int axis, double inverse) noexcept {
    const double below = std::min(look.below[axis] * inverse, 1.0),
                 above = std::min(look.above[axis] * inverse, 1.0);
    return look.side[axis] * inverse + below * (1 - below / 2) + above * (1 - above / 2);
}

void FastModel::Pool::add(double cell_size, Alignment alignment, std::size_t most_looks,
                          Counts& sum) const noexcept {
    sum.vertices += points.count;
    sum.cells += cells.at(cell_size);
    sum.looks += lookups.count();
    sum.tested += lookups.candidates();
    if (looks.empty()) return;
    if (alignment == Alignment::average) sum.rows += mean_rows(cell_size, most_looks);
    sum.read += lookups.read(cell_size) *
                (alignment == Alignment::actual ? add_actual(cell_size, most_looks, sum) : 1);
}

double FastModel::Pool::mean_rows(double cell_size, std::size_t most_looks) const noexcept {
    if (cell_size >= largest_side) return lookups.count(); // all in one cell
    const std::size_t stride = stride_for(looks.size(), most_looks);
    const double inverse = 1 / cell_size;
    double rows = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1)
        rows += std::max(along(looks[i], 1, inverse), 1.0) * std::max(along(looks[i], 2, inverse), 1.0);
    return rows * (lookups.count() / count);
}

double FastModel::Pool::add_actual(double cell_size, std::size_t most_looks, Counts& sum) const noexcept {
    const std::size_t stride = stride_for(looks.size(), most_looks);
    const double inverse = 1 / cell_size;
    double rows = 0, visited = 0, mean = 0, as_laid = 0, count = 0;
    for (std::size_t i = 0; i < looks.size(); i += stride, count += 1) {
        const Look& look = looks[i];
        double cells[3];                    // along each axis
        double volume = 1, volume_laid = 1; // of the part of them that is in the window
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
    const double scale = lookups.count() / count;
    sum.rows += rows * scale;
    sum.visited_cells += visited * scale;
    return mean > 0 ? as_laid / mean : 1;
}

std::uint64_t FastModel::points_looked_at() const noexcept {
    std::uint64_t sum = 0;
    for (const Pool& pool : pools_) sum += pool.lookups.points_looked_at();
    return sum;
}

std::uint64_t FastModel::looks_per_call() const noexcept {
    std::uint64_t sum = 0;
    for (const Pool& pool : pools_) {
        const std::size_t stride = stride_for(pool.looks.size(), budget_.most_looks);
        sum += (pool.looks.size() + stride - 1) / stride;
    }
    return sum;
}

std::optional<CellSizeRange> FastModel::range() const noexcept {
    std::optional<CellSizeRange> range;
    for (const Pool& pool : pools_) {
        double smallest = 0, largest = 0;
        if (!pool.lookups.sides(smallest, largest)) continue;
        smallest = std::min(smallest, pool.smallest_cell);
        largest *= 2;
        range = range ? CellSizeRange{std::min(range->min, smallest), std::max(range->max, largest)}
                      : CellSizeRange{smallest, largest};
    }
    return range;
}

FastModel::Counts FastModel::counts(double cell_size, Alignment alignment) const {
    Counts sum;
    for (const Pool& pool : pools_)
        pool.add(std::max(cell_size, pool.smallest_cell), alignment, budget_.most_looks, sum);
    return sum;
}

CostTerms FastModel::terms(double cell_size, Alignment alignment) const {
    const Counts c = counts(cell_size, alignment);
    CostTerms terms;
    terms.add("bin a vertex", c.vertices, weights_.bin_vertex);
    terms.add("clear a cell", c.cells, weights_.clear_cell);
    terms.add("visit a tile", c.looks, weights_.visit_tile);
    terms.add("visit a row", c.rows, weights_.visit_row);
    terms.add("read a vertex", c.read, weights_.found_vertex);
    terms.add("test a vertex", c.tested, weights_.test_vertex);
    return terms;
}

} // namespace vox
