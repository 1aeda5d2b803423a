#include "cell_size/reference_model.hpp"

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/sampling.hpp"
#include "base/vectors.hpp"
#include "fast/body_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// At least this many tetrahedra of each body are sampled, so that a small body among large ones is seen.
constexpr std::size_t least_of_body = 64;
// Vertices further away than 2^octaves times the nearest distance are in no cell of a size that matters.
constexpr std::size_t octaves = 18;
// A box that meets fewer cells than this is never better off with a scan of all that are occupied.
constexpr double few_cells = 512;
// With more sampled vertices than this in a cell, the number of all in it is known well enough.
constexpr double crowd = 4;

constexpr const char* work_names[] = {"visit a cell",  "list of another length", "scan an occupied cell",
                                      "read a vertex", "fetch a vertex",         "test a box"};
constexpr double CostWeights::*work_weights[] = {&CostWeights::visit_cell,   &CostWeights::changed_list,
                                                 &CostWeights::scan_cell,    &CostWeights::read_vertex,
                                                 &CostWeights::fetch_vertex, &CostWeights::test_box};

Box box_of(const Body& body) {
    Box box = empty_box;
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        const Vec3f p = body.positions[v];
        const float at[3] = {p.x, p.y, p.z};
        for (int a = 0; a < 3; ++a) {
            box.lo[a] = std::min(box.lo[a], at[a]);
            box.hi[a] = std::max(box.hi[a], at[a]);
        }
    }
    return box;
}

// Whether all of a box lies to one side of the tetrahedron before it in the mesh.
bool is_apart(const Body& body, std::size_t tet, const PlainBox& box) {
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

// Whether cells as large as the box itself may reach one of these boxes of bodies.
bool is_near(const PlainBox& box, std::span<const fast::Pair> others, const Array<Box>& of_bodies) {
    const double margin = box.longest_side();
    return std::any_of(others.begin(), others.end(), [&](const fast::Pair& pair) {
        const Box& other = of_bodies[pair.b];
        bool meets = true;
        for (int a = 0; a < 3; ++a)
            meets &= box.lo[a] - margin <= double{other.hi[a]} && box.hi[a] + margin >= double{other.lo[a]};
        return meets;
    });
}

} // namespace

ReferenceModel::SizeClass::SizeClass(int e, bool may_meet_points, std::pmr::memory_resource* memory)
    : exponent(e), may_meet(may_meet_points), passed(std::ldexp(nearest_distance, e), octaves, memory),
      tested(std::ldexp(nearest_distance, e), octaves, memory) {}

ReferenceModel::ReferenceModel(const CellSizeScene& scene, bool dense, const CostWeights& weights)
    : weights_(weights), dense_(dense), budget_(scene.budget), classes_(scene.memory),
      points_chosen_(scene.memory) {
    for (const Body& body : scene.bodies) {
        vertices_ += static_cast<double>(body.vertex_count);
        tets_ += static_cast<double>(body.tets.size());
    }
    const Array<AskingBox> boxes = sample_boxes(scene);
    if (classes_.empty()) return;
    int smallest = classes_[0].exponent, largest = smallest;
    for (const SizeClass& c : classes_) {
        smallest = std::min(smallest, c.exponent);
        largest = std::max(largest, c.exponent);
    }
    range_ = {std::ldexp(1.0, smallest - 3), std::ldexp(1.0, largest + 5)};
    occupied_shares_.emplace(*range_, 0, scene.memory);
    count_points(scene, boxes);
}

Array<AskingBox> ReferenceModel::sample_boxes(const CellSizeScene& scene) {
    Array<Box> of_bodies(scene.memory);
    Box all = empty_box;
    for (const Body& body : scene.bodies) {
        of_bodies.push_back(box_of(body));
        add(all, of_bodies.back());
    }
    for (int a = 0; a < 3; ++a) sides_[a] = std::max(double{all.hi[a]} - double{all.lo[a]}, 0.0);
    fast::PairBuffers buffers(scene.memory);
    Array<fast::Pair> pairs(scene.memory);
    fast::find_pairs(of_bodies, {.bodies = scene.bodies}, buffers, pairs);
    const fast::Pair* pair = pairs.data(); // sorted by a
    const fast::Pair* const last_pair = pair + pairs.size();
    Array<AskingBox> boxes(scene.memory);
    std::uint32_t first = 0;
    for (std::uint32_t b = 0; b < scene.bodies.size(); first += scene.bodies[b].vertex_count, ++b) {
        const Body& body = scene.bodies[b];
        const std::uint32_t end = body.self_collision ? first : first + body.vertex_count;
        const fast::Pair* const begin = pair;
        while (pair != last_pair && pair->a == b) ++pair;
        const std::span<const fast::Pair> others(begin, pair);
        const std::size_t count = body.tets.size();
        const auto share = static_cast<std::size_t>(static_cast<double>(budget_.summed) *
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
            const PlainBox box{{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}};
            SizeClass& c = class_of(box.longest_side(), is_near(box, others, of_bodies));
            c.count += weight;
            if (is_apart(body, t, box)) c.apart += weight;
            c.cells.add(cells_met({box.side(0), box.side(1), box.side(2)}), weight);
            boxes.push_back({box, static_cast<std::uint32_t>(&c - classes_.data()), first, end, weight});
        });
    }
    return boxes;
}

ReferenceModel::SizeClass& ReferenceModel::class_of(double side, bool may_meet) {
    const int exponent = std::ilogb(side);
    for (SizeClass& c : classes_)
        if (c.exponent == exponent && c.may_meet == may_meet) return c;
    return classes_.emplace_back(exponent, may_meet, classes_.memory());
}

void ReferenceModel::count_points(const CellSizeScene& scene, const Array<AskingBox>& boxes) {
    std::pmr::memory_resource* const memory = scene.memory;
    const auto vertices = static_cast<std::uint64_t>(vertices_);
    SampleTree& sample = points_.emplace(memory);
    sample.reserve(static_cast<std::size_t>(std::min(vertices, budget_.held)));
    const Body* body = scene.bodies.data();
    std::uint64_t first = 0; // of its vertices
    for_stratified(vertices, budget_.held, 0.5, [&](std::uint64_t v) {
        while (v >= first + body->vertex_count) first += body++->vertex_count;
        const Vec3d p = body->positions[static_cast<std::size_t>(v - first)];
        sample.add({{p.x, p.y, p.z}, {p.x, p.y, p.z}}, v);
    });
    sample.build(false, vertices_);

    Array<std::uint32_t> kinds(memory);
    kinds.reserve(boxes.size());
    for (const AskingBox& box : boxes) kinds.push_back(box.kind);
    std::uint64_t random = 2;
    for (const Asking& ask : choose_of_kinds(kinds, budget_.chosen, 1, memory)) {
        const AskingBox& own = boxes[ask.index];
        SizeClass& c = classes_[own.kind];
        const double each = ask.weight * own.weight / points_->share();
        for_fours_around(own.box, *points_, budget_.coarse, random,
                         [&](const FourBoxes& others, const std::uint32_t* ids, const double* numbers_of) {
                             double of_passed[4], of_tested[4], any_tested = 0;
                             for (std::size_t i = 0; i < 4; ++i) {
                                 const bool is_passed = ids[i] >= own.first && ids[i] < own.last;
                                 of_passed[i] = is_passed ? each * numbers_of[i] : 0;
                                 of_tested[i] = is_passed ? 0 : each * numbers_of[i];
                                 any_tested += of_tested[i];
                             }
                             add_common_cells(own.box, others, of_passed, c.passed);
                             if (any_tested > 0) add_common_cells(own.box, others, of_tested, c.tested);
                         });
    }
    for (SizeClass& c : classes_) {
        c.passed.finish();
        c.tested.finish();
    }
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

double ReferenceModel::occupied(double cell_size) const {
    if (points_chosen_.empty())
        points_chosen_ = choose_asking(*points_, budget_.chosen, points_chosen_.memory());
    const double share = occupied_shares_->at(cell_size, [this](double d) {
        std::uint64_t random = 4;
        CellCounts counts;
        look_at_entries(*points_, nullptr, points_chosen_, budget_.cells, d, budget_.rough, crowd, random,
                        counts);
        return counts.mean_inverse();
    });
    return std::max(share * vertices_, 1.0);
}

double ReferenceModel::candidates() const noexcept {
    double sum = 0;
    for (const SizeClass& c : classes_) sum += c.tested.at_least();
    return sum;
}

// Where the boxes meet more cells than are occupied, those are scanned instead.
ReferenceModel::Work ReferenceModel::work(const SizeClass& c, double cell_size) const {
    const double cells = c.cells.at(cell_size), passed = c.passed.at(cell_size),
                 tested = c.tested.at(cell_size), read = passed + tested,
                 fetched = passed * c.apart / c.count;
    const double scanned = cells > few_cells * c.count ? occupied(cell_size) * c.count : cells;
    if (cells > scanned) return {0, 0, scanned, read, fetched, tested};
    return {cells, cells * (1 - std::pow(1 + 2.5 * read / cells, -0.8)), 0, read, fetched, tested};
}

CostTerms ReferenceModel::terms(double cell_size) const {
    Work sum{};
    for (const SizeClass& c : classes_) {
        const Work own = work(c, cell_size);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
    }
    CostTerms terms;
    terms.add("classify a vertex", vertices_, weights_.classify_vertex);
    terms.add("prepare a tet", tets_, weights_.prepare_tet);
    for (std::size_t i = 0; i < sum.size(); ++i) terms.add(work_names[i], sum[i], weights_.*work_weights[i]);
    terms.add("handle one in the box", candidates(), weights_.test_tet);
    terms.add("clear a bucket", buckets(cell_size), weights_.clear_bucket);
    return terms;
}

double ReferenceModel::of_grid(double cell_size) const noexcept {
    return vertices_ * weights_.classify_vertex + buckets(cell_size) * weights_.clear_bucket;
}

double ReferenceModel::of_class(const SizeClass& c, double cell_size) const {
    const Work w = work(c, cell_size);
    double sum = 0;
    for (std::size_t i = 0; i < w.size(); ++i) sum += w[i] * (weights_.*work_weights[i]);
    return sum;
}

double ReferenceModel::shared() const noexcept {
    return tets_ * weights_.prepare_tet + candidates() * weights_.test_tet;
}

} // namespace vox
