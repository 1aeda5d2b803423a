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

double longest_side(const Box& box) {
    return std::max({double{box.hi[0]} - double{box.lo[0]}, double{box.hi[1]} - double{box.lo[1]},
                     double{box.hi[2]} - double{box.lo[2]}});
}

PlainBox plain(const Box& box) {
    return {{double{box.lo[0]}, double{box.lo[1]}, double{box.lo[2]}},
            {double{box.hi[0]}, double{box.hi[1]}, double{box.hi[2]}}};
}

} // namespace

FastModel::FastModel(const CellSizeScene& scene, const CostWeights& weights)
    : pools_(scene.memory), weights_(weights), budget_(scene.budget) {
    fast::Points points(scene.memory);
    Array<Window> windows(scene.memory);
    Array<Look> looks(scene.memory);
    gather(scene, points, windows, looks);
    for (Pool& pool : pools_) pool.smallest_cell /= pool.windows;
    keep_looks(windows, looks);
    count_points(points, windows, looks);
}

// Of all looks, one in a stride is in the list, so that there are about as many as are to be summed.
void FastModel::gather(const CellSizeScene& scene, fast::Points& points, Array<Window>& windows,
                       Array<Look>& looks) {
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
        if (points.count == first) continue;
        const std::uint32_t window = add_window(points, first, windows);
        Pool& pool = pools_[windows[window].pool];
        const auto look_from = [&](std::uint32_t body, const Box& where) {
            Box inside = where;
            intersect(inside, windows[window].box);
            for_tiles(scene, body, where, [&](const Box& tile) {
                if (!overlap(tile, inside) || seen++ % stride != 0) return;
                Box box = tile;
                intersect(box, inside);
                looks.push_back({box, window});
                pool.look_count += each_;
            });
        };
        if (!is_empty(own_region)) look_from(a, own_region);
        for (const fast::PairRegion& pair : near.of_a(a)) look_from(pair.b, pair.region);
    }
}

// Of the points from `first` on.
std::uint32_t FastModel::add_window(const fast::Points& points, std::uint32_t first, Array<Window>& windows) {
    const std::uint32_t count = points.count - first;
    const Box box = fast::bounds(points, first, count);
    const double smallest = 1 / double{fast::make_lattice(box, 0, fast::most_window_cells(count)).inverse};
    const int key = static_cast<int>(std::floor(2 * std::log2(smallest)));
    std::size_t p = 0;
    while (p < pools_.size() && pools_[p].key != key) ++p;
    if (p == pools_.size()) pools_.emplace_back(key, pools_.memory());
    Pool& pool = pools_[p];
    const PlainBox sides = plain(box);
    pool.windows += 1;
    pool.smallest_cell += smallest;
    pool.largest_side = std::max(pool.largest_side, sides.longest_side());
    pool.vertices += count;
    pool.cells.add(cells_met({sides.side(0), sides.side(1), sides.side(2)}));
    windows.push_back({box, first, count, static_cast<std::uint32_t>(p)});
    return static_cast<std::uint32_t>(windows.size() - 1);
}

void FastModel::keep_looks(const Array<Window>& windows, const Array<Look>& looks) {
    Array<std::uint32_t> in_pool(pools_.size(), pools_.memory());
    for (const Look& look : looks) {
        const std::uint32_t p = windows[look.window].pool;
        ++in_pool[p];
        const double side = longest_side(look.box);
        if (!(side > 0)) continue;
        Pool& pool = pools_[p];
        pool.smallest_look = pool.largest_look > 0 ? std::min(pool.smallest_look, side) : side;
        pool.largest_look = std::max(pool.largest_look, side);
    }
    Array<std::uint32_t> seen(pools_.size(), pools_.memory());
    for (const Look& look : looks) {
        const Window& window = windows[look.window];
        Pool& pool = pools_[window.pool];
        if (seen[window.pool]++ % stride_for(in_pool[window.pool], budget_.cells) != 0) continue;
        ++pool.kept;
        for (int a = 0; a < 3; ++a) {
            pool.axes[a].side.push_back(look.box.hi[a] - look.box.lo[a]);
            pool.axes[a].below.push_back(look.box.lo[a] - window.box.lo[a]);
            pool.axes[a].above.push_back(window.box.hi[a] - look.box.hi[a]);
        }
    }
}

// A look reads the points of its own window. Some of these stand for all.
void FastModel::count_points(const fast::Points& points, const Array<Window>& windows,
                             const Array<Look>& looks) {
    std::pmr::memory_resource* const memory = pools_.memory();
    for (Pool& pool : pools_)
        pool.read.emplace(nearest_distance *
                              (pool.smallest_look > 0 ? pool.smallest_look : pool.smallest_cell),
                          octaves_of_distance, memory);
    Array<std::uint32_t> kinds(memory);
    kinds.reserve(looks.size());
    for (const Look& look : looks) {
        const auto octave = std::bit_cast<std::uint64_t>(longest_side(look.box)) >> 52;
        kinds.push_back(windows[look.window].pool << 12 | static_cast<std::uint32_t>(octave));
    }
    Array<FourBoxes> some(memory);
    some.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(points.count, budget_.held)) / 4 + 1);
    Array<Asking> chosen = choose_of_kinds(kinds, budget_.chosen, each_, memory);
    std::sort(chosen.begin(), chosen.end(),
              [](const Asking& a, const Asking& b) { return a.index < b.index; });
    std::size_t n = 0; // points in `some`, which are of the window of the look before
    const Window* before = nullptr;
    for (const Asking& ask : chosen) {
        const Look& look = looks[ask.index];
        const Window& window = windows[look.window];
        if (before != &window) {
            before = &window;
            n = 0;
            some.clear();
            for_stratified(window.count, budget_.held, 0.5, [&](std::uint64_t i) {
                const std::size_t p = window.first + static_cast<std::size_t>(i);
                const double x = double{points.x[p]}, y = double{points.y[p]}, z = double{points.z[p]};
                if (n % 4 == 0) some.push_back(no_boxes);
                some.back().set(n++ % 4, {{x, y, z}, {x, y, z}});
            });
        }
        const double each = ask.weight * window.count / static_cast<double>(n);
        double weights[4];
        PiecewiseMoments& read = *pools_[window.pool].read;
        for (std::size_t f = 0; f < some.size(); ++f) {
            for (std::size_t i = 0; i < 4; ++i) weights[i] = 4 * f + i < n ? each : 0;
            add_common_cells(plain(look.box), some[f], weights, read);
        }
    }
    for (Pool& pool : pools_) pool.read->finish();
}

void FastModel::Pool::add(double cell_size, Alignment alignment, Counts& sum) const noexcept {
    sum.vertices += vertices;
    sum.cells += cells.at(cell_size);
    sum.looks += look_count;
    sum.tested += read->at_least();
    if (kept == 0) return;
    if (alignment == Alignment::average) sum.rows += mean_rows(cell_size);
    sum.read += read->at(cell_size) * (alignment == Alignment::actual ? add_actual(cell_size, sum) : 1);
}

// Whole cells extend a box beyond each end along an axis, within the window: a point at distance e from the
// end is in a cell that the box meets with probability 1 - e/d.
double FastModel::Extents::cells(std::size_t look, double inverse) const noexcept {
    const double b = std::min(double{below[look]} * inverse, 1.0),
                 e = std::min(double{above[look]} * inverse, 1.0);
    return double{side[look]} * inverse + b * (1 - b / 2) + e * (1 - e / 2);
}

// By the same formula, for some looks at a time.
double FastModel::Pool::mean_rows(double cell_size) const noexcept {
    if (cell_size >= largest_side) return look_count; // all in one cell
    constexpr std::size_t some = 64;
    const auto inverse = static_cast<float>(1 / cell_size);
    double sum = 0;
    float rows[some];
    for (std::size_t first = 0; first < kept; first += some) {
        const std::size_t count = std::min(some, kept - first);
        for (int a = 1; a < 3; ++a) {
            const float *side = axes[a].side.data() + first, *below = axes[a].below.data() + first,
                        *above = axes[a].above.data() + first;
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

double FastModel::Pool::add_actual(double cell_size, Counts& sum) const noexcept {
    const double inverse = 1 / cell_size;
    double rows = 0, visited = 0, mean = 0, as_laid = 0;
    for (std::size_t i = 0; i < kept; ++i) {
        double along[3];
        double volume = 1, volume_laid = 1; // of the part of them that is in the window
        for (int a = 0; a < 3; ++a) {
            const double side = double{axes[a].side[i]}, below = double{axes[a].below[i]},
                         above = double{axes[a].above[i]};
            volume *= axes[a].cells(i, inverse);
            const double first = std::floor(below * inverse), last = std::floor((below + side) * inverse);
            along[a] = last - first + 1;
            volume_laid *= std::min(last + 1, (below + side + above) * inverse) - first;
        }
        rows += along[1] * along[2];
        visited += along[0] * along[1] * along[2];
        mean += volume;
        as_laid += volume_laid;
    }
    const double scale = look_count / static_cast<double>(kept);
    sum.rows += rows * scale;
    sum.visited_cells += visited * scale;
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

FastModel::Counts FastModel::counts(double cell_size, Alignment alignment) const {
    Counts sum;
    for (const Pool& pool : pools_) pool.add(std::max(cell_size, pool.smallest_cell), alignment, sum);
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
