#include "cell_size/reference_model.hpp"

#include "fast/broad_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vox {

namespace {

// Tetrahedra of one body: so many of them, one from each of as many equal parts, at a place in it that goes
// round by the golden ratio (Weyl), so that no pattern in their order shows.
template <class Visit>
void for_some(std::size_t count, std::size_t wanted, Visit&& visit) {
    if (count <= wanted) {
        for (std::size_t i = 0; i < count; ++i) visit(i);
        return;
    }
    const double part = static_cast<double>(count) / static_cast<double>(wanted);
    double place = 0.5;
    for (std::size_t i = 0; i < wanted; ++i) {
        visit(std::min(static_cast<std::size_t>((static_cast<double>(i) + place) * part), count - 1));
        place += 0.6180339887498949;
        place -= std::floor(place);
    }
}

// Never more than this of any body goes unseen.
constexpr std::size_t least_of_body = 64;

struct Corner {
    double c[3];
};

// What a list of another length than the one before costs, in visits, and what fetching a vertex costs beside
// reading it, in readings. Fitted, as the weights are.
constexpr double changed_list = 6.7, fetch = 1.8;

// A flat one holds nothing, and the engine gives it no box.
bool has_volume(const std::array<Corner, 4>& p) {
    double e[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a) e[i][a] = p[i + 1].c[a] - p[0].c[a];
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
               e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) !=
           0;
}

// From the box of the tetrahedron before.
bool is_apart(const Body& body, std::size_t tet, const Lookup& box) {
    if (tet == 0) return true;
    bool below[3] = {true, true, true}, above[3] = {true, true, true};
    for (const std::uint32_t v : body.tets[tet - 1].v) {
        const Vec3f p = body.positions[v];
        const double x[3] = {p.x, p.y, p.z};
        for (int a = 0; a < 3; ++a) {
            below[a] = below[a] && x[a] < box.lo[a];
            above[a] = above[a] && x[a] > box.hi[a];
        }
    }
    return below[0] || below[1] || below[2] || above[0] || above[1] || above[2];
}

} // namespace

SampleBudget quick(std::uint64_t tets) noexcept {
    const auto t = static_cast<std::size_t>(tets);
    // How lists change takes the surroundings of a hundred boxes to tell, whatever the scene. In a small one
    // that takes too long, and is worth little: how the lattice happens to lie decides there.
    constexpr std::size_t many = 60000;
    return {std::clamp<std::size_t>(t / 8, 512, 1u << 15),
            {std::clamp<std::size_t>(t / 400, 64, 256), 128, std::clamp<std::size_t>(t / 256, 64, 192),
             t < many ? 0 : std::size_t{128}},
            64,
            true};
}

ReferenceModel::ReferenceModel(std::span<const Body> bodies, vox_storage storage, const SampleBudget& effort,
                             const vox_cost_weights& weights, std::pmr::memory_resource* memory)
    : profile_(effort.sample, memory), weights_(weights), dense_(storage == VOX_STORAGE_DENSE) {
    std::size_t vertices = 0, tets = 0;
    for (const Body& body : bodies) {
        vertices += body.vertex_count;
        tets += body.tets.size();
    }
    vertices_ = static_cast<double>(vertices);
    tets_ = static_cast<double>(tets);
    fast::Points points(memory);
    points.reserve(vertices);
    std::pmr::vector<Box> boxes(memory);
    for (const Body& body : bodies) {
        boxes.push_back(empty_box);
        for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
            const auto p = body.positions[v];
            const std::uint32_t i = points.count++;
            points.x[i] = static_cast<float>(p.x);
            points.y[i] = static_cast<float>(p.y);
            points.z[i] = static_cast<float>(p.z);
            points.id[i] = i;
            add(boxes.back(), {{points.x[i], points.y[i], points.z[i], 0},
                                     {points.x[i], points.y[i], points.z[i], 0}});
        }
    }
    fast::PairBuffers buffers(memory);
    std::pmr::vector<fast::Pair> pairs(memory);
    fast::find_pairs(boxes, buffers, pairs);
    const fast::Pair* pair = pairs.data(); // sorted by a
    const fast::Pair* const last_pair = pair + pairs.size();
    std::uint32_t first = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        const fast::Pair* const begin = pair;
        while (pair != last_pair && pair->a == b) ++pair;
        const std::span<const fast::Pair> others(begin, pair);
        Lookup lookup{};
        lookup.last_read = static_cast<std::uint32_t>(vertices);
        lookup.first_passed = first;
        first += body.vertex_count;
        lookup.last_passed = body.self_collision ? lookup.first_passed : first;
        const std::size_t count = body.tets.size();
        const auto share = static_cast<std::size_t>(static_cast<double>(effort.most_tets) *
                                                    static_cast<double>(count) / std::max(tets_, 1.0));
        const std::size_t wanted = std::max(share, least_of_body);
        const double weight = static_cast<double>(count) / static_cast<double>(std::min(count, wanted));
        for_some(count, wanted, [&](std::size_t t) {
            std::array<Corner, 4> corner;
            for (std::size_t i = 0; i < 4; ++i) {
                const auto p = body.positions[body.tets[t].v[i]];
                corner[i] = {{p.x, p.y, p.z}};
            }
            if (!has_volume(corner)) return;
            for (int a = 0; a < 3; ++a) {
                const auto [lo, hi] =
                    std::minmax({corner[0].c[a], corner[1].c[a], corner[2].c[a], corner[3].c[a]});
                lookup.lo[a] = lo;
                lookup.hi[a] = hi;
            }
            lookup.jumps = is_apart(body, t, lookup);
            // Also through cells as large as it is itself.
            const double margin = std::max(
                {lookup.hi[0] - lookup.lo[0], lookup.hi[1] - lookup.lo[1], lookup.hi[2] - lookup.lo[2]});
            lookup.may_meet = std::any_of(others.begin(), others.end(), [&](const fast::Pair& other) {
                const Box& box = boxes[other.b];
                for (int a = 0; a < 3; ++a)
                    if (lookup.lo[a] - margin > double{box.hi[a]} ||
                        lookup.hi[a] + margin < double{box.lo[a]})
                        return false;
                return true;
            });
            profile_.add(lookup, weight);
        });
    }
    if (points.count > 0) {
        const Box box = fast::bounds(points);
        for (int a = 0; a < 3; ++a) sides_[a] = double{box.hi[a]} - double{box.lo[a]};
    }
    profile_.count_points(points, Occupied::counted);
}

bool ReferenceModel::range(double& min, double& max) const noexcept {
    double smallest = 0, largest = 0;
    if (!profile_.sides(smallest, largest)) return false;
    min = smallest / 16;
    max = largest * 16;
    return true;
}

double ReferenceModel::dense_cells(double cell_size) const noexcept {
    double cells = 1;
    for (const double side : sides_) cells *= std::max(1.0, std::ceil(side / cell_size));
    return cells;
}

double ReferenceModel::least_cell_size(double byte_limit, const CellSizeRange& range) const noexcept {
    const double limit = 0x1p31 - 1, fitting = byte_limit / sizeof(std::uint32_t);
    const double most = byte_limit > 0 ? std::min(limit, fitting) : limit;
    if (dense_cells(range.min) <= most) return 0;
    // All in one cell at the latest.
    double low = std::log(range.min),
           high = std::log(std::max({range.max, 2 * sides_[0], 2 * sides_[1], 2 * sides_[2]}));
    while (high - low > 1e-9) {
        const double middle = (low + high) / 2;
        (dense_cells(std::exp(middle)) <= most ? high : low) = middle;
    }
    return std::exp(high);
}

double ReferenceModel::buckets(double cell_size) const noexcept {
    return dense_ ? dense_cells(cell_size) : 2 * vertices_;
}

double ReferenceModel::occupied(double cell_size) const noexcept {
    return std::min(profile_.occupied(cell_size), vertices_);
}

// Beyond the sizes looked at, in proportion to what it would be in an irregular mesh.
double ReferenceModel::changed_share(const SizeClass& c, double cell_size, double mean) noexcept {
    const double nearest = c.changes.nearest(cell_size);
    if (nearest == cell_size) return c.changes.share(cell_size);
    const double irregular = BranchMisses::of_irregular(mean);
    if (nearest == 0) return irregular;
    const double mean_there = (c.passed.at(nearest) + c.tested.at(nearest)) / c.cells.at(nearest);
    if (!(mean_there > 0)) return 0;
    return std::min(c.changes.share(nearest) * irregular / BranchMisses::of_irregular(mean_there), 1.0);
}

// A box that meets more cells than are occupied goes through those instead.
ReferenceModel::Work ReferenceModel::work(const SizeClass& c, double cell_size, double occupied) noexcept {
    Work work;
    const double cells = c.cells.at(cell_size), scanned = occupied * c.count, passed = c.passed.at(cell_size);
    work.tested = c.tested.at(cell_size);
    work.read = passed + work.tested;
    work.fetched = passed * c.jumped / c.count;
    if (cells > scanned) {
        work.scanned = scanned;
    } else {
        work.visited = cells;
        work.changed = cells * changed_share(c, cell_size, work.read / cells);
    }
    return work;
}

ReferenceModel::Work ReferenceModel::work(double cell_size) const noexcept {
    const double occupied_cells = occupied(cell_size);
    Work sum;
    for (const SizeClass& c : profile_.classes()) {
        const Work own = work(c, cell_size, occupied_cells);
        sum.visited += own.visited;
        sum.changed += own.changed;
        sum.scanned += own.scanned;
        sum.read += own.read;
        sum.fetched += own.fetched;
        sum.tested += own.tested;
    }
    return sum;
}

double ReferenceModel::visit_units(double cell_size) const noexcept {
    const Work w = work(cell_size);
    return w.visited + w.changed * changed_list;
}

double ReferenceModel::read_units(double cell_size) const noexcept {
    const Work w = work(cell_size);
    return w.read + w.fetched * fetch;
}

CostTerms ReferenceModel::terms(double cell_size) const {
    const Work w = work(cell_size);
    CostTerms terms;
    terms.add("classify a vertex", vertices_, weights_.reference_classify_vertex);
    terms.add("prepare a tet", tets_, weights_.reference_prepare_tet);
    terms.add("visit a cell", w.visited, weights_.reference_visit_cell);
    terms.add("list of another length", w.changed, changed_list * weights_.reference_visit_cell);
    terms.add("scan an occupied cell", w.scanned, weights_.reference_scan_cell);
    terms.add("read a vertex", w.read, weights_.reference_read_vertex);
    terms.add("fetch a vertex", w.fetched, fetch * weights_.reference_read_vertex);
    terms.add("test a box", w.tested, weights_.reference_test_box);
    terms.add("handle one in the box", profile_.candidates(), weights_.reference_test_tet);
    terms.add("clear a bucket", buckets(cell_size), weights_.reference_clear_bucket);
    return terms;
}

double ReferenceModel::of_grid(double cell_size) const noexcept {
    return vertices_ * weights_.reference_classify_vertex +
           buckets(cell_size) * weights_.reference_clear_bucket;
}

double ReferenceModel::of_changes(double cell_size) const noexcept {
    return work(cell_size).changed * changed_list * weights_.reference_visit_cell;
}

double ReferenceModel::of_class(const SizeClass& c, double cell_size, double occupied) const noexcept {
    const Work w = work(c, cell_size, occupied);
    return (w.visited + w.changed * changed_list) * weights_.reference_visit_cell +
           w.scanned * weights_.reference_scan_cell +
           (w.read + w.fetched * fetch) * weights_.reference_read_vertex +
           w.tested * weights_.reference_test_box;
}

double ReferenceModel::shared() const noexcept {
    return tets_ * weights_.reference_prepare_tet + profile_.candidates() * weights_.reference_test_tet;
}

} // namespace vox
