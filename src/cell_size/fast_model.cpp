#include "cell_size/fast_model.hpp"

#include "base/array.hpp"
#include "base/sampling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace vox {

namespace {

// Vertices further away than 64 times the smallest tile are in no cell of a size that is searched.
constexpr std::size_t octaves_of_distance = 14;
// Looks whose extents are gone through at a time, and the numbers of each.
constexpr std::size_t some_looks = 64, numbers = 9;

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

// Calls visit(box) for the tiles of a body that meet a region.
template <class Visit>
void for_tiles(const CellSizeScene& scene, std::uint32_t body, const Box& region, Visit&& visit) {
    const fast::StepBoxes& boxes = scene.boxes();
    const Array<fast::StepBody>& of = scene.step().of;
    const std::size_t end = body + 1 < of.size() ? of[body + 1].first_tile : boxes.tiles.size();
    for (std::size_t t = of[body].first_tile; t < end; ++t)
        if (boxes.tile_known[t] && overlap(boxes.tiles[t], region)) visit(boxes.tiles[t]);
}

PlainBox plain(const Box& box) {
    return {{double{box.lo[0]}, double{box.lo[1]}, double{box.lo[2]}},
            {double{box.hi[0]}, double{box.hi[1]}, double{box.hi[2]}}};
}

} // namespace

FastModel::FastModel(const CellSizeScene& scene, const CostWeights& weights)
    : pools_(scene.memory), weights_(weights), budget_(scene.budget) {
    fast::Points points(scene.memory);
    Array<AskingBox> looks(scene.memory);
    gather(scene, points, looks);
    for (Pool& pool : pools_) {
        pool.smallest_cell /= pool.windows;
        pool.keep(budget_.cells);
    }
    count_points(points, looks);
}

// Of all looks, one in a stride is in the list, so that there are about as many as are to be summed.
void FastModel::gather(const CellSizeScene& scene, fast::Points& points, Array<AskingBox>& looks) {
    const fast::BroadPhase& near = scene.broad_phase();
    std::size_t all = 0;
    for (const fast::PairRegion& pair : near.regions)
        for_tiles(scene, pair.b, pair.region, [&](const Box&) { ++all; });
    for (const Body& body : scene.bodies)
        if (body.self_collision) all += body.tets.size() / tile_size;
    const std::size_t stride = stride_for(all, static_cast<std::size_t>(budget_.summed));
    each_ = static_cast<double>(stride);
    std::size_t seen = stride / 2;
    for (std::uint32_t a = 0; a < scene.bodies.size(); ++a) {
        const Box own_region = scene.own_region(a);
        Box region = own_region;
        for (const fast::PairRegion& pair : near.of_a(a)) add(region, pair.region);
        if (is_empty(region)) continue;
        const std::uint32_t first = points.count;
        append_near(scene, a, own_region, region, points);
        const std::uint32_t count = points.count - first;
        if (count == 0) continue;
        const Box window = fast::bounds(points, first, count);
        const PlainBox sides = plain(window);
        const double smallest =
            1 / double{fast::make_lattice(window, 0, fast::most_window_cells(count)).inverse};
        Pool& pool = pool_of(smallest);
        pool.windows += 1;
        pool.smallest_cell += smallest;
        pool.largest_side = std::max(pool.largest_side, sides.longest_side());
        pool.vertices += count;
        pool.cells.add(cells_met({sides.side(0), sides.side(1), sides.side(2)}));
        const auto kind = static_cast<std::uint32_t>(&pool - pools_.data());
        const auto look_from = [&](std::uint32_t body, const Box& where) {
            Box inside = where;
            intersect(inside, window);
            for_tiles(scene, body, where, [&](const Box& tile) {
                if (!overlap(tile, inside) || seen++ % stride != 0) return;
                Box box = tile;
                intersect(box, inside);
                looks.push_back({plain(box), kind, first, points.count, each_});
                pool.look_count += each_;
                pool.add_look(box, window);
            });
        };
        if (!is_empty(own_region)) look_from(a, own_region);
        for (const fast::PairRegion& pair : near.of_a(a)) look_from(pair.b, pair.region);
    }
}

FastModel::Pool& FastModel::pool_of(double smallest_cell) {
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest_cell)));
    for (Pool& pool : pools_)
        if (pool.key == key) return pool;
    return pools_.emplace_back(key, pools_.memory());
}

void FastModel::Pool::add_look(const Box& look, const Box& window) {
    const double side = plain(look).longest_side();
    if (side > 0) {
        smallest_look = largest_look > 0 ? std::min(smallest_look, side) : side;
        largest_look = std::max(largest_look, side);
    }
    if (kept % some_looks == 0) extents.resize(extents.size() + numbers * some_looks);
    float* at = &extents[kept / some_looks * some_looks * numbers + kept % some_looks];
    for (int a = 0; a < 3; ++a)
        for (const float number :
             {look.hi[a] - look.lo[a], look.lo[a] - window.lo[a], window.hi[a] - look.hi[a]}) {
            *at = number;
            at += some_looks;
        }
    ++kept;
}

void FastModel::Pool::keep(std::size_t most) {
    const std::size_t stride = stride_for(kept, most), all = kept;
    kept = 0;
    for (std::size_t from = 0; from < all; from += stride, ++kept)
        for (std::size_t n = 0; n < numbers; ++n)
            extents[(kept / some_looks * numbers + n) * some_looks + kept % some_looks] =
                extents[(from / some_looks * numbers + n) * some_looks + from % some_looks];
}

// A look reads the points of its own window. Some of these stand for all.
void FastModel::count_points(const fast::Points& points, const Array<AskingBox>& looks) {
    std::pmr::memory_resource* const memory = pools_.memory();
    for (Pool& pool : pools_)
        pool.read.emplace(nearest_distance *
                              (pool.smallest_look > 0 ? pool.smallest_look : pool.smallest_cell),
                          octaves_of_distance, memory);
    Array<std::uint32_t> kinds(memory);
    kinds.reserve(looks.size());
    for (const AskingBox& look : looks) {
        const auto octave = std::bit_cast<std::uint64_t>(look.box.longest_side()) >> 52;
        kinds.push_back(look.kind << 12 | static_cast<std::uint32_t>(octave));
    }
    Array<FourBoxes> some(memory);
    some.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(points.count, budget_.held)) / 4 + 1);
    Array<Asking> chosen = choose_of_kinds(kinds, budget_.chosen, each_, memory);
    std::sort(chosen.begin(), chosen.end(),
              [](const Asking& a, const Asking& b) { return a.index < b.index; });
    std::size_t n = 0; // points in `some`, which are of the window of the look before
    std::uint32_t before = points.count;
    for (const Asking& ask : chosen) {
        const AskingBox& look = looks[ask.index];
        if (before != look.first) {
            before = look.first;
            n = 0;
            some.clear();
            for_stratified(look.last - look.first, budget_.held, 0.5, [&](std::uint64_t i) {
                const std::size_t p = look.first + static_cast<std::size_t>(i);
                const double x = double{points.x[p]}, y = double{points.y[p]}, z = double{points.z[p]};
                if (n % 4 == 0) some.push_back(no_boxes);
                some.back().set(n++ % 4, {{x, y, z}, {x, y, z}});
            });
        }
        const double each = ask.weight * (look.last - look.first) / static_cast<double>(n);
        double weights[4];
        PiecewiseMoments& read = *pools_[look.kind].read;
        for (std::size_t f = 0; f < some.size(); ++f) {
            for (std::size_t i = 0; i < 4; ++i) weights[i] = 4 * f + i < n ? each : 0;
            add_common_cells(look.box, some[f], weights, read);
        }
    }
    for (Pool& pool : pools_) pool.read->finish();
}

const float* FastModel::Pool::extent(std::size_t look, int axis) const noexcept {
    return &extents[(look / some_looks * numbers + static_cast<std::size_t>(3 * axis)) * some_looks +
                    look % some_looks];
}

// Whole cells extend a box beyond each end along an axis, within the window: a point at distance e from the
// end is in a cell that the box meets with probability 1 - e/d.
double FastModel::Pool::mean_rows(double cell_size) const noexcept {
    if (cell_size >= largest_side) return look_count; // all in one cell
    const auto inverse = static_cast<float>(1 / cell_size);
    double sum = 0;
    float rows[some_looks];
    for (std::size_t first = 0; first < kept; first += some_looks) {
        const std::size_t count = std::min(some_looks, kept - first);
        for (int a = 1; a < 3; ++a) {
            const float *side = extent(first, a), *below = side + some_looks, *above = below + some_looks;
            for (std::size_t i = 0; i < count; ++i) {
                float b = below[i] * inverse, e = above[i] * inverse;
                b = b < 1 ? b : 1;
                e = e < 1 ? e : 1;
                const float along = side[i] * inverse + b * (1 - 0.5f * b) + e * (1 - 0.5f * e);
                rows[i] = (a == 1 ? 1 : rows[i]) * (along > 1 ? along : 1);
            }
        }
        for (std::size_t i = 0; i < count; ++i) sum += double{rows[i]};
    }
    return sum * (look_count / static_cast<double>(kept));
}

double FastModel::Pool::lay(double cell_size, double& rows, double& cells) const noexcept {
    const double inverse = 1 / cell_size;
    double mean = 0, as_laid = 0;
    rows = cells = 0;
    for (std::size_t i = 0; i < kept; ++i) {
        double along[3];
        double volume = 1, volume_laid = 1; // of the part of them that is in the window
        for (int a = 0; a < 3; ++a) {
            const float* of = extent(i, a);
            const double side = double{of[0]} * inverse, below = double{of[some_looks]} * inverse,
                         above = double{of[2 * some_looks]} * inverse, b = std::min(below, 1.0),
                         e = std::min(above, 1.0);
            volume *= side + b * (1 - b / 2) + e * (1 - e / 2);
            const double first = std::floor(below), last = std::floor(below + side);
            along[a] = last - first + 1;
            volume_laid *= std::min(last + 1, below + side + above) - first;
        }
        rows += along[1] * along[2];
        cells += along[0] * along[1] * along[2];
        mean += volume;
        as_laid += volume_laid;
    }
    const double scale = look_count / static_cast<double>(kept);
    rows *= scale;
    cells *= scale;
    return mean > 0 ? as_laid / mean : 1;
}

std::uint64_t FastModel::points_looked_at() const noexcept {
    std::uint64_t sum = 0;
    for (const Pool& pool : pools_) sum += pool.read->added();
    return sum;
}

std::uint64_t FastModel::looks_per_call() const noexcept {
    std::uint64_t sum = 0;
    for (const Pool& pool : pools_) sum += pool.kept;
    return sum;
}

std::optional<CellSizeRange> FastModel::range() const noexcept {
    std::optional<CellSizeRange> range;
    for (const Pool& pool : pools_) {
        if (!(pool.largest_look > 0)) continue;
        const double smallest = std::min(pool.smallest_look / 2, pool.smallest_cell),
                     largest = 4 * pool.largest_look;
        range = range ? CellSizeRange{std::min(range->min, smallest), std::max(range->max, largest)}
                      : CellSizeRange{smallest, largest};
    }
    return range;
}

CostTerms FastModel::terms(double cell_size, bool as_laid) const {
    double vertices = 0, cells = 0, looks = 0, rows = 0, read = 0, tested = 0;
    for (const Pool& pool : pools_) {
        const double d = std::max(cell_size, pool.smallest_cell);
        vertices += pool.vertices;
        cells += pool.cells.at(d);
        looks += pool.look_count;
        tested += pool.read->at_least();
        if (pool.kept == 0) continue;
        double own_rows = 0, own_cells = 0;
        const double covered = as_laid ? pool.lay(d, own_rows, own_cells) : 1;
        rows += as_laid ? own_rows : pool.mean_rows(d);
        read += pool.read->at(d) * covered;
    }
    CostTerms terms;
    terms.add("bin a vertex", vertices, weights_.bin_vertex);
    terms.add("clear a cell", cells, weights_.clear_cell);
    terms.add("visit a tile", looks, weights_.visit_tile);
    terms.add("visit a row", rows, weights_.visit_row);
    terms.add("read a vertex", read, weights_.found_vertex);
    terms.add("test a vertex", tested, weights_.test_vertex);
    return terms;
}

double FastModel::visited_cells(double cell_size) const {
    double sum = 0, rows = 0, cells = 0;
    for (const Pool& pool : pools_) {
        if (pool.kept == 0) continue;
        pool.lay(std::max(cell_size, pool.smallest_cell), rows, cells);
        sum += cells;
    }
    return sum;
}

} // namespace vox
