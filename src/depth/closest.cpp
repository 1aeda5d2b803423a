// A tree over the triangles, sorted along a Z-shaped curve (Lauterbach et al., "Fast BVH construction on
// GPUs", Computer Graphics Forum 28, 2009), whose boxes follow the positions. depth/near.* searches it.
#include "depth/closest.hpp"

#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "depth/points.hpp"
#include "exact/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace vox::depth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int axis_bits = 10; // the curve runs through 2^axis_bits cells an axis
constexpr int digit_bits = 10;

struct Box3d {
    Vec3d min, max;
};
constexpr Box3d empty_box3d{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

Box3d box_of(const Solid& solid, std::uint32_t triangle) {
    const std::uint32_t* v = solid.topology->triangles[triangle].v;
    const Vec3d a = solid.at(v[0]), b = solid.at(v[1]), c = solid.at(v[2]);
    return {min(min(a, b), c), max(max(a, b), c)};
}

// The cell of x on an axis from min to max, which may be equal.
std::uint32_t cell_of(double x, double min, double max) {
    constexpr double cells = 1 << axis_bits;
    const double cell = max > min ? (x - min) / (max - min) * cells : 0;
    return static_cast<std::uint32_t>(std::clamp(cell, 0.0, cells - 1));
}

float most_of(const float (&p)[3]) { return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}); }

} // namespace

Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p) {
    const std::uint32_t* v = solid.topology->triangles[triangle].v;
    const Vec3d a = solid.at(v[0]), b = solid.at(v[1]), c = solid.at(v[2]);
    const auto [at, way] = closest_seen_from(p, a, b, c);
    return {{triangle, {at.weight[0], at.weight[1], at.weight[2]}, p + way}, way, at.squared_distance};
}

// ---- the tree ---------------------------------------------------------------------------------------

void SurfaceTree::reserve(std::size_t triangles) {
    const std::size_t leaves = (triangles + tree_width - 1) / tree_width;
    order_.reserve(triangles);
    scratch_.reserve(triangles);
    triangles_.reserve(leaves * tree_width);
    leaves_.reserve(leaves);
    std::size_t nodes = 0;
    for (std::size_t count = leaves; count > 0; count = count > 1 ? (count + tree_width - 1) / tree_width : 0)
        nodes += (count + tree_width - 1) / tree_width;
    nodes_.reserve(nodes);
}

// The frame of the solid's positions as they are now.
void SurfaceTree::take_frame() {
    Box3d all = empty_box3d;
    for (std::uint32_t t = 0; t < solid_.topology->triangles.size(); ++t) extend(all, box_of(solid_, t));
    middle_ = 0.5 * all.min + 0.5 * all.max;
    const Vec3d half = all.max - middle_;
    const double most = std::max({half.x, half.y, half.z});
    scale_ = most > 0 ? std::ldexp(1.0, std::clamp(-1 - std::ilogb(most), -1000, 1000)) : 1;
}

std::uint32_t SurfaceTree::place_on_curve(const Vec3d& p) const noexcept {
    const double half = 1 / scale_;
    const auto cell = [&](double x, double middle) { return cell_of(x, middle - half, middle + half); };
    return morton_code(cell(p.x, middle_.x), cell(p.y, middle_.y), cell(p.z, middle_.z));
}

// Part after part.
void SurfaceTree::sort_along_curve() {
    const auto count = static_cast<std::uint32_t>(solid_.topology->triangles.size());
    order_.resize(count);
    scratch_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const Box3d box = box_of(solid_, t);
        order_[t] = {place_on_curve(0.5 * box.min + 0.5 * box.max), t};
    }
    std::array<std::uint32_t, 1 << digit_bits> place;
    for (int shift = 0; shift < 3 * axis_bits; shift += digit_bits) {
        const auto digit = [shift](const Key& key) { return key.code >> shift & ((1u << digit_bits) - 1); };
        place.fill(0);
        for (const Key& key : order_) ++place[digit(key)];
        std::uint32_t sum = 0;
        for (std::uint32_t& p : place) sum += std::exchange(p, sum);
        for (const Key& key : order_) scratch_[place[digit(key)]++] = key;
        order_.swap(scratch_);
    }
    if (part_.empty()) return;
    const auto key = [&](const Key& k) {
        return std::tuple(part_[solid_.topology->triangles[k.triangle].v[0]], k.code, k.triangle);
    };
    std::sort(order_.begin(), order_.end(), [&](const Key& x, const Key& y) { return key(x) < key(y); });
}

// No leaf has triangles of two parts. The lanes that this leaves over hold the triangle before them again.
void SurfaceTree::lay_out() {
    triangles_.clear();
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::uint32_t triangle = order_[i].triangle;
        const auto part = [&](std::uint32_t t) { return part_[solid_.topology->triangles[t].v[0]]; };
        if (!part_.empty() && i > 0 && part(triangle) != part(order_[i - 1].triangle))
            while (triangles_.size() % tree_width != 0) triangles_.push_back(triangles_.back());
        triangles_.push_back(triangle);
    }
    while (triangles_.size() % tree_width != 0) triangles_.push_back(triangles_.back());

    const auto leaves = static_cast<std::uint32_t>(triangles_.size() / tree_width);
    levels_.clear();
    levels_.reserve(TreeView::most_levels);
    std::uint32_t first_child = 0, last_child = leaves;
    std::size_t below = 1;
    do {
        const std::size_t count = (last_child - first_child + tree_width - 1) / tree_width;
        levels_.push_back({last_child - leaves, count, first_child, last_child, below});
        first_child = last_child;
        last_child += static_cast<std::uint32_t>(count);
        below *= tree_width;
    } while (levels_.back().count > 1);
    leaves_.resize(leaves);
    nodes_.resize(last_child - leaves);
    name_parts_of_nodes();
    view_ = {leaves_.data(),
             nodes_.data(),
             triangles_.data(),
             part_of_nodes_.empty() ? nullptr : part_of_nodes_.data(),
             leaves,
             last_child - leaves};
}

void SurfaceTree::name_parts_of_nodes() {
    part_of_nodes_.clear();
    if (part_.empty()) return;
    part_of_nodes_.reserve(leaves_.size() + nodes_.size());
    for (std::size_t i = 0; i < leaves_.size(); ++i)
        part_of_nodes_.push_back(part_[solid_.topology->triangles[triangles_[i * tree_width]].v[0]]);
    for (const TreeLevel& level : levels_)
        for (std::size_t first = level.first_child; first < level.last_child; first += tree_width) {
            std::uint32_t part = part_of_nodes_[first];
            for (std::size_t i = first; i < std::min<std::size_t>(first + tree_width, level.last_child); ++i)
                if (part_of_nodes_[i] != part) part = TreeView::mixed;
            part_of_nodes_.push_back(part);
        }
}

void SurfaceTree::invalidate() noexcept {
    is_built_ = has_parts_ = false;
    part_.clear();
}

void SurfaceTree::build(const Solid& solid) {
    invalidate();
    update(solid, false, nullptr);
}

void SurfaceTree::update(const Solid& solid, bool folds, Workers* workers) {
    solid_ = solid;
    state_ = {};
    if (folds && !has_parts_) {
        find_parts();
        is_built_ &= part_.empty();
    }
    if (!is_built_) {
        reserve(solid.topology->triangles.size());
        take_frame();
        sort_along_curve();
        lay_out();
        is_built_ = true;
    }
    fit(workers);
    if (fits_frame()) return;
    take_frame();
    fit(workers);
    (void)fits_frame();
}

void SurfaceTree::fit(Workers* workers) {
    constexpr std::size_t least = 256; // leaves that are worth a task
    const auto run = [&](std::size_t items, std::size_t least_items, auto&& function) {
        const auto range = [&](std::size_t begin, std::size_t end, std::uint32_t) { function(begin, end); };
        if (workers)
            workers->for_ranges(items, least_items, range);
        else
            range(0, items, 0);
    };
    run(leaves_.size(), least, [&](std::size_t begin, std::size_t end) { fit_leaves(begin, end); });
    for (const TreeLevel& level : levels_)
        run(level.count, least, [&](std::size_t begin, std::size_t end) {
            refit_nodes(view_, level, begin, end, nodes_.data());
        });
}

void SurfaceTree::fit_leaves(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
        TreeLeaf& leaf = leaves_[i];
        for (std::size_t lane = 0; lane < tree_width; ++lane) {
            const std::uint32_t* v = solid_.topology->triangles[triangles_[i * tree_width + lane]].v;
            float corner[3][3];
            for (int c = 0; c < 3; ++c) {
                const Vec3d at = scale_ * (solid_.at(v[c]) - middle_);
                corner[c][0] = static_cast<float>(at.x);
                corner[c][1] = static_cast<float>(at.y);
                corner[c][2] = static_cast<float>(at.z);
            }
            for (int axis = 0; axis < 3; ++axis) {
                leaf.a[axis][lane] = corner[0][axis];
                leaf.ab[axis][lane] = corner[1][axis] - corner[0][axis];
                leaf.ac[axis][lane] = corner[2][axis] - corner[0][axis];
            }
        }
    }
}

// Whether the frame still suits the positions: the largest coordinate, of which it notes a bound, is neither
// much more than 1, so that nothing overflows, nor much less, which would waste digits.
bool SurfaceTree::fits_frame() {
    const TreeNode& root = nodes_.back();
    const std::size_t children = levels_.back().last_child - levels_.back().first_child;
    most_ = 0;
    for (std::size_t child = 0; child < children; ++child) {
        float squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float most = std::max(std::abs(root.low[k][child]), std::abs(root.high[k][child]));
            if (!(most <= 8)) return false;
            squared += most * most;
        }
        most_ = std::max(most_, 1.01f * std::sqrt(squared));
    }
    return most_ >= 0.125f;
}

// (R. E. Tarjan, "Efficiency of a good but not linear set union
// algorithm", Journal of the ACM 22, 1975).
void SurfaceTree::find_parts() {
    const Topology& topology = *solid_.topology;
    const auto count = static_cast<std::uint32_t>(topology.neighbours.size());
    part_.resize(count);
    for (std::uint32_t v = 0; v < count; ++v) part_[v] = v;
    const auto root = [&](std::uint32_t v) {
        while (part_[v] != v) v = part_[v] = part_[part_[v]];
        return v;
    };
    for (std::uint32_t v = 0; v < count; ++v)
        for (const std::uint32_t w : topology.neighbours_of(v)) {
            if (w > v) break;
            const std::uint32_t a = root(v), b = root(w);
            part_[std::max(a, b)] = std::min(a, b);
        }
    for (std::uint32_t v = 0; v < count; ++v) part_[v] = part_[part_[v]];
    const std::uint32_t first = part_[solid_.topology->triangles[0].v[0]];
    if (std::all_of(topology.triangles.begin(), topology.triangles.end(),
                    [&](const Triangle& t) { return part_[t.v[0]] == first; }))
        part_.clear();
    has_parts_ = true;
}

// ---- searches ---------------------------------------------------------------------------------------

// A point in the frame of the tree, and how far a search has to look for points up to some distance.
class SurfaceTree::Query {
public:
    Query(const SurfaceTree& tree, const Vec3d& p) : scale_(tree.scale_) {
        const Vec3d at = tree.scale_ * (p - tree.middle_);
        p_[0] = static_cast<float>(at.x);
        p_[1] = static_cast<float>(at.y);
        p_[2] = static_cast<float>(at.z);
        const float most = most_of(p_);
        constexpr float far = 0x1p40f; // beyond it, squares might overflow
        if (most < far) {
            slack_ = 0x1p-18 * double{most + tree.most_};
        } else {
            for (float& x : p_) x = 0;
            slack_ = infinity;
        }
    }
    const float (&point() const)[3] { return p_; }
    float reach(double squared) const {
        constexpr double rounding = 1 + 0x1p-19;
        return static_cast<float>(rounding * (std::sqrt(squared) * scale_ + slack_));
    }

private:
    float p_[3];
    double scale_, slack_;
};

// Receives the triangles near a point, and keeps the closest.
class SurfaceTree::NearestOne {
public:
    NearestOne(const SurfaceTree& tree, const Vec3d& p, std::uint32_t left_out, std::uint32_t part,
               SearchState& state, Closest& out)
        : tree_(tree), query_(tree, p), p_(p), left_out_(left_out), part_(part), state_(state), out_(out) {}

    bool run() {
        if (state_.near != SearchState::none) look_at(state_.near);
        const auto visit = [](void* self, std::uint32_t triangle) {
            auto& nearest = *static_cast<NearestOne*>(self);
            nearest.look_at(triangle);
            return nearest.reach_;
        };
        find_near(tree_.view_, part_, query_.point(), reach_, visit, this);
        if (found_) state_.near = out_.at.triangle;
        return found_;
    }

private:
    void look_at(std::uint32_t triangle) {
        const Triangle& corners = tree_.solid_.topology->triangles[triangle];
        if (has_corner(corners, left_out_) || !tree_.is_in(part_, corners)) return;
        if (found_ && triangle == out_.at.triangle) return;
        ++state_.visited;
        const Closest candidate = closest_point(tree_.solid_, triangle, p_);
        if (found_ &&
            (candidate.squared > out_.squared ||
             (candidate.squared == out_.squared &&
              !tree_.solid_.topology->before(candidate.at.triangle, out_.at.triangle))))
            return;
        found_ = true;
        out_ = candidate;
        reach_ = query_.reach(candidate.squared);
    }

    const SurfaceTree& tree_;
    const Query query_;
    const Vec3d p_;
    const std::uint32_t left_out_, part_;
    SearchState& state_;
    Closest& out_;
    float reach_ = std::numeric_limits<float>::infinity();
    bool found_ = false;
};

bool SurfaceTree::find_among(const Vec3d& p, std::uint32_t left_out, std::uint32_t part, SearchState& state,
                             Closest& out) const {
    return NearestOne(*this, p, left_out, part, state, out).run();
}

// ---- folds ------------------------------------------------------------------------------------------

namespace {

// Where a closest point lies: inside a triangle, inside an edge or at a vertex, by the corners with a weight.
struct Place {
    std::uint32_t vertex[3] = {SurfaceTree::no_vertex, SurfaceTree::no_vertex, SurfaceTree::no_vertex};
    std::uint32_t count = 0;

    Place() = default;
    Place(const Topology& topology, const SurfacePoint& at) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (at.weight[i] == 0) continue;
            std::size_t k = count++;
            const std::uint32_t corner = topology.triangles[at.triangle].v[i];
            for (; k > 0 && vertex[k - 1] > corner; --k) vertex[k] = vertex[k - 1];
            vertex[k] = corner;
        }
    }
    bool operator==(const Place&) const = default;
};

// The way from p to the closest point there, the same for all triangles that meet there.
Vec3d way_to(const Solid& solid, const Place& place, const Vec3d& p, const Closest& found) {
    if (place.count == 3) return found.way;
    const Vec3d a = solid.at(place.vertex[0]);
    if (place.count == 1) return a - p;
    const Vec3d along = solid.at(place.vertex[1]) - a;
    const double squared = dot(along, along);
    const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
    return (a - p) + t * along;
}

// Whether no point of the surface next to the place is nearer than the place is, which is at the end of `way`.
bool is_local_minimum(const Solid& solid, const Place& place, const Vec3d& way) {
    if (place.count == 3) return true;
    const Vec3d origin = solid.at(place.vertex[0]);
    const Vec3d along = place.count == 2 ? solid.at(place.vertex[1]) - origin : Vec3d{0, 0, 0};
    const double squared = dot(along, along);
    for (const std::uint32_t t : solid.topology->ring_of(place.vertex[0])) {
        const Triangle& triangle = solid.topology->triangles[t];
        if (place.count == 2 && !has_corner(triangle, place.vertex[1])) continue;
        for (const std::uint32_t v : triangle.v) {
            if (v == place.vertex[0] || v == place.vertex[1]) continue;
            // The way into the triangle, at right angles to the edge.
            Vec3d into = solid.at(v) - origin;
            if (squared > 0) into = into - (dot(into, along) / squared) * along;
            constexpr double rounding = 1e-12, squared_rounding = rounding * rounding;
            const double nearer = -dot(way, into);
            if (nearer > 0 && nearer * nearer > squared_rounding * dot(way, way) * dot(into, into))
                return false;
        }
    }
    return true;
}

struct FoundPlace {
    Place place;
    Closest found;
};

// The nearest of different places, in order.
template <std::size_t capacity>
class Nearest {
public:
    explicit Nearest(const Topology& topology) : topology_(topology) {}

    bool before(const Closest& a, const Closest& b) const {
        return a.squared != b.squared ? a.squared < b.squared
                                      : topology_.before(a.at.triangle, b.at.triangle);
    }
    // To be asked before add().
    bool wants(const Closest& found) const { return size_ < capacity || before(found, list_[size_ - 1].found); }
    void add(const Place& place, const Closest& found) {
        std::size_t last = 0;
        while (last < size_ && !(list_[last].place == place)) ++last;
        if (last < size_ && !before(found, list_[last].found)) return;
        if (last == size_) {
            if (size_ < capacity) ++size_;
            last = size_ - 1;
        }
        for (; last > 0 && before(found, list_[last - 1].found); --last) list_[last] = list_[last - 1];
        list_[last] = {place, found};
    }
    bool has(const Place& place) const {
        return std::any_of(begin(), end(), [&](const FoundPlace& known) { return known.place == place; });
    }
    // The squared distance within which another is wanted.
    double squared() const { return size_ < capacity ? infinity : list_[size_ - 1].found.squared; }

    const FoundPlace* begin() const { return list_; }
    const FoundPlace* end() const { return list_ + size_; }

private:
    const Topology& topology_;
    FoundPlace list_[capacity];
    std::size_t size_ = 0;
};

} // namespace

// Receives the triangles near a vertex that is in a fold, and keeps the nearest places.
class SurfaceTree::NearestPlaces {
public:
    NearestPlaces(const SurfaceTree& tree, const Line& line, std::uint32_t part, SearchState& state)
        : tree_(tree), query_(tree, line.p), line_(line), part_(part), state_(state),
          places_(*tree.solid_.topology) {}

    // Returns whether a straight line reaches one of them, not the first, which was tried before.
    bool run(Closest& out) {
        const auto visit = [](void* self, std::uint32_t triangle) {
            auto& nearest = *static_cast<NearestPlaces*>(self);
            nearest.look_at(triangle);
            return nearest.query_.reach(nearest.places_.squared());
        };
        find_nearest_first(tree_.view_, part_, query_.point(), query_.reach(infinity), visit, this);
        for (const FoundPlace* next = places_.begin() + 1; next < places_.end(); ++next) {
            const Vec3d way = way_to(tree_.solid_, next->place, line_.p, next->found);
            if (!tree_.reaches(line_, way)) continue;
            out = next->found;
            return true;
        }
        return false;
    }

    bool has(const Place& place) const { return places_.has(place); }

private:
    void look_at(std::uint32_t triangle) {
        const Triangle& corners = tree_.solid_.topology->triangles[triangle];
        if (has_corner(corners, line_.vertex) || !tree_.is_in(part_, corners)) return;
        ++state_.visited;
        const Closest found = closest_point(tree_.solid_, triangle, line_.p);
        if (places_.wants(found)) places_.add(Place(*tree_.solid_.topology, found.at), found);
    }

    const SurfaceTree& tree_;
    const Query query_;
    const Line line_;
    const std::uint32_t part_;
    SearchState& state_;
    Nearest<4> places_;
};

// Receives the triangles near a vertex that is in a fold, and tries the nearest places where the distance has
// a local minimum.
class SurfaceTree::NearestMinima {
public:
    // Those in `tried` are known not to be reached. None is tried at a greater squared distance than
    // `squared_exit`.
    NearestMinima(const SurfaceTree& tree, const Line& line, std::uint32_t part, const NearestPlaces& tried,
                  double squared_exit, SearchState& state)
        : tree_(tree), query_(tree, line.p), line_(line), part_(part), tried_(tried),
          squared_exit_(squared_exit), state_(state), minima_(*tree.solid_.topology) {}

    // Returns whether a straight line reaches one of them.
    bool run(Closest& out) {
        const auto visit = [](void* self, std::uint32_t triangle) {
            auto& nearest = *static_cast<NearestMinima*>(self);
            nearest.look_at(triangle);
            return nearest.reach();
        };
        find_nearest_first(tree_.view_, part_, query_.point(), reach(), visit, this);
        if (!is_reached_ || !minima_.has(reached_.place)) return false;
        out = reached_.found;
        return true;
    }

private:
    float reach() const {
        const double squared = std::min(squared_exit_, minima_.squared());
        return query_.reach(is_reached_ ? std::min(squared, reached_.found.squared) : squared);
    }

    // Each is tried at once, since one that is reached makes the search short.
    void look_at(std::uint32_t triangle) {
        const Triangle& corners = tree_.solid_.topology->triangles[triangle];
        if (has_corner(corners, line_.vertex) || !tree_.is_in(part_, corners)) return;
        ++state_.visited;
        const Closest found = closest_point(tree_.solid_, triangle, line_.p);
        if (found.squared > squared_exit_ || !minima_.wants(found)) return;
        if (is_reached_ && !minima_.before(found, reached_.found)) return;
        const Place place(*tree_.solid_.topology, found.at);
        const Vec3d way = way_to(tree_.solid_, place, line_.p, found);
        const bool is_known = minima_.has(place);
        if (!is_known && !is_local_minimum(tree_.solid_, place, way)) return;
        minima_.add(place, found);
        // A place is tried once, and belongs to the first of the triangles that meet there.
        if (is_known ? !(is_reached_ && reached_.place == place)
                     : tried_.has(place) || !tree_.reaches(line_, way))
            return;
        is_reached_ = true;
        reached_ = {place, found};
    }

    const SurfaceTree& tree_;
    const Query query_;
    const Line line_;
    const std::uint32_t part_;
    const NearestPlaces& tried_;
    const double squared_exit_;
    SearchState& state_;
    Nearest<8> minima_;
    FoundPlace reached_;
    bool is_reached_ = false;
};

// The squared distance at which a line in the direction of `way` leaves the fold, or 0 where it does not.
double SurfaceTree::squared_exit(const Line& line, const Vec3d& way) const {
    const double beyond = 4 * (length(line.p - middle_) + double{most_} / scale_);
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (!walk_out(solid_, line.tet, line.p, line.p + (beyond / length(way)) * way, out, tets) ||
        has_corner(solid_.topology->triangles[out.triangle], line.vertex))
        return 0;
    const Vec3d whole = out.point - line.p;
    return dot(whole, whole);
}

// Whether a line leads inside the fold to the point at the end of `way`.
bool SurfaceTree::reaches(const Line& line, const Vec3d& way) const {
    if (dot(way, way) == 0) return true;
    // The walk goes twice as far, so that rounding does not end it too early.
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (!walk_out(solid_, line.tet, line.p, line.p + 2.0 * way, out, tets)) return false;
    const Vec3d whole = out.point - line.p, rest = whole - way;
    constexpr double rounding = 1e-12; // squared
    return !has_corner(solid_.topology->triangles[out.triangle], line.vertex) &&
           dot(rest, rest) <= rounding * dot(whole, whole);
}

bool SurfaceTree::find_in_fold(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, SearchState& state,
                               Closest& out) const {
    const std::uint32_t part = part_of(tet);
    if (!find_among(p, vertex, part, state, out)) return find(p, vertex, state, out);
    const Line line{p, vertex, tet};
    if (reaches(line, out.way)) return true;
    NearestPlaces places(*this, line, part, state);
    Closest other;
    bool found = places.run(other);
    if (!found) {
        const double exit = squared_exit(line, out.way);
        found = exit > 0 && NearestMinima(*this, line, part, places, exit, state).run(other);
    }
    if (found) out = other;
    return found || part == all_parts || find(p, vertex, state, out);
}

bool SurfaceTree::find_of_contact(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, bool self,
                                  Closest& out, std::uint64_t& visited) {
    const bool found =
        self ? find_in_fold(p, vertex, tet, state_, out) : find(p, no_vertex, state_, out);
    visited += std::exchange(state_.visited, 0);
    return found;
}

} // namespace vox::depth
