#include "cell_size/reference_model.hpp"

#include "base/array.hpp"
#include "base/sampling.hpp"
#include "base/vectors.hpp"
#include "fast/body_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// At least this many tetrahedra of each body are sampled, so that a small body among large ones is seen.
constexpr std::size_t least_of_body = 64;

// Whether all of a box lies to one side of the tetrahedron before it in the mesh.
bool is_apart(const Body& body, std::size_t tet, const Lookup& box) {
    if (tet == 0) return true;
    bool below[3] = {true, true, true}, above[3] = {true, true, true};
    for (const std::uint32_t v : body.tets[tet - 1].v) {
        const Vec3f p = body.positions[v];
        const double x[3] = {double{p.x}, double{p.y}, double{p.z}};
        for (int a = 0; a < 3; ++a) {
            below[a] = below[a] && x[a] < box.lo[a];
            above[a] = above[a] && x[a] > box.hi[a];
        }
    }
    return below[0] || below[1] || below[2] || above[0] || above[1] || above[2];
}

} // namespace

ReferenceModel::ReferenceModel(const CellSizeScene& scene, bool dense, const CostWeights& weights)
    : lookups_(scene.budget, scene.memory), weights_(weights), dense_(dense) {
    std::size_t vertices = 0, tets = 0;
    for (const Body& body : scene.bodies) {
        vertices += body.vertex_count;
        tets += body.tets.size();
    }
    vertices_ = static_cast<double>(vertices);
    tets_ = static_cast<double>(tets);
    fast::Points points(scene.memory);
    points.reserve(vertices);
    Array<Box> boxes(scene.memory);
    for (const Body& body : scene.bodies) {
        const std::uint32_t first = points.count;
        for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
            const Vec3f p = body.positions[v];
            const std::uint32_t i = first + v;
            points.x[i] = p.x;
            points.y[i] = p.y;
            points.z[i] = p.z;
            points.id[i] = i;
        }
        points.count = first + body.vertex_count;
        boxes.push_back(fast::bounds(points, first, body.vertex_count));
    }
    fast::PairBuffers buffers(scene.memory);
    Array<fast::Pair> pairs(scene.memory);
    fast::find_pairs(boxes, {.bodies = scene.bodies}, buffers, pairs);
    const fast::Pair* pair = pairs.data(); // sorted by a
    const fast::Pair* const last_pair = pair + pairs.size();
    std::uint32_t first = 0;
    for (std::uint32_t b = 0; b < scene.bodies.size(); ++b) {
        const Body& body = scene.bodies[b];
        const fast::Pair* const begin = pair;
        while (pair != last_pair && pair->a == b) ++pair;
        const std::span<const fast::Pair> others(begin, pair);
        Lookup lookup{};
        lookup.last_read = static_cast<std::uint32_t>(vertices);
        lookup.first_passed = first;
        first += body.vertex_count;
        lookup.last_passed = body.self_collision ? lookup.first_passed : first;
        const std::size_t count = body.tets.size();
        const auto share = static_cast<std::size_t>(static_cast<double>(scene.budget.most_tets) *
                                                    static_cast<double>(count) / std::max(tets_, 1.0));
        const std::size_t wanted = std::max(share, least_of_body);
        const double weight = static_cast<double>(count) / static_cast<double>(std::min(count, wanted));
        for_stratified(count, wanted, 0.5, [&](std::uint64_t t) {
            const std::uint32_t* v = body.tets[t].v;
            const Vec3d p[4] = {body.positions[v[0]], body.positions[v[1]], body.positions[v[2]],
                                body.positions[v[3]]};
            // The engine gives a flat tetrahedron no box.
            if (determinant(p[1] - p[0], p[2] - p[0], p[3] - p[0]) == 0) return;
            const Vec3d lo = min(min(p[0], p[1]), min(p[2], p[3])),
                        hi = max(max(p[0], p[1]), max(p[2], p[3]));
            std::copy_n(&lo.x, 3, lookup.lo);
            std::copy_n(&hi.x, 3, lookup.hi);
            lookup.jumps = is_apart(body, t, lookup);
            // Near is what cells as large as the box itself may reach.
            const Vec3d sides = hi - lo;
            const double margin = std::max({sides.x, sides.y, sides.z});
            lookup.may_meet = std::any_of(others.begin(), others.end(), [&](const fast::Pair& other) {
                const Box& box = boxes[other.b];
                for (int a = 0; a < 3; ++a)
                    if (lookup.lo[a] - margin > double{box.hi[a]} ||
                        lookup.hi[a] + margin < double{box.lo[a]})
                        return false;
                return true;
            });
            lookups_.add(lookup, weight);
        });
    }
    if (points.count > 0) {
        const Box box = fast::bounds(points);
        for (int a = 0; a < 3; ++a) sides_[a] = double{box.hi[a]} - double{box.lo[a]};
    }
    lookups_.count_points(points, true);
}

std::optional<CellSizeRange> ReferenceModel::range() const noexcept {
    double smallest = 0, largest = 0;
    if (!lookups_.sides(smallest, largest)) return std::nullopt;
    return CellSizeRange{smallest / 16, largest * 16};
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
    // At most all of the scene in one cell.
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
    return std::min(lookups_.occupied(cell_size), vertices_);
}

// Beyond the sizes that were counted, the nearest of them is scaled as the share of an irregular mesh
// changes.
double ReferenceModel::changed_share(const SizeClass& c, double cell_size, double mean) noexcept {
    const double nearest = c.changes.nearest(cell_size);
    if (nearest == cell_size) return c.changes.share(cell_size);
    const double irregular = BranchMisses::of_irregular(mean);
    if (nearest == 0) return irregular;
    const double mean_there = (c.passed.at(nearest) + c.tested.at(nearest)) / c.cells.at(nearest);
    if (!(mean_there > 0)) return 0;
    return std::min(c.changes.share(nearest) * irregular / BranchMisses::of_irregular(mean_there), 1.0);
}

// Where the boxes meet more cells than are occupied, those are scanned instead.
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
    for (const SizeClass& c : lookups_.classes()) {
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

CostTerms ReferenceModel::terms(double cell_size) const {
    const Work w = work(cell_size);
    CostTerms terms;
    terms.add("classify a vertex", vertices_, weights_.classify_vertex);
    terms.add("prepare a tet", tets_, weights_.prepare_tet);
    terms.add("visit a cell", w.visited, weights_.visit_cell);
    terms.add("list of another length", w.changed, weights_.changed_list);
    terms.add("scan an occupied cell", w.scanned, weights_.scan_cell);
    terms.add("read a vertex", w.read, weights_.read_vertex);
    terms.add("fetch a vertex", w.fetched, weights_.fetch_vertex);
    terms.add("test a box", w.tested, weights_.test_box);
    terms.add("handle one in the box", lookups_.candidates(), weights_.test_tet);
    terms.add("clear a bucket", buckets(cell_size), weights_.clear_bucket);
    return terms;
}

double ReferenceModel::of_grid(double cell_size) const noexcept {
    return vertices_ * weights_.classify_vertex + buckets(cell_size) * weights_.clear_bucket;
}

double ReferenceModel::of_class(const SizeClass& c, double cell_size, double occupied) const noexcept {
    const Work w = work(c, cell_size, occupied);
    return w.visited * weights_.visit_cell + w.changed * weights_.changed_list +
           w.scanned * weights_.scan_cell + w.read * weights_.read_vertex +
           w.fetched * weights_.fetch_vertex + w.tested * weights_.test_box;
}

double ReferenceModel::shared() const noexcept {
    return tets_ * weights_.prepare_tet + lookups_.candidates() * weights_.test_tet;
}

} // namespace vox
