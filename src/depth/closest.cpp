// A tree of boxes over the triangles, sorted along a Z-shaped curve (Lauterbach et al., "Fast BVH
// construction on GPUs", Computer Graphics Forum 28, 2009), and searched nearest box first (Roussopoulos,
// Kelley, Vincent, "Nearest neighbor queries", SIGMOD 1995).
#include "depth/closest.hpp"

#include "base/bits.hpp"
#include "base/vectors.hpp"
#include "depth/points.hpp"
#include "exact/closest_point.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace vox::depth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int axis_bits = 10; // the curve runs through 2^axis_bits cells an axis
constexpr int digit_bits = 10;
constexpr Box3d empty_box3d{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

// The cell of x on an axis from min to max, which may be equal.
std::uint32_t cell_of(double x, double min, double max) {
    constexpr double cells = 1 << axis_bits;
    const double cell = max > min ? (x - min) / (max - min) * cells : 0;
    return static_cast<std::uint32_t>(std::clamp(cell, 0.0, cells - 1));
}

// Whether the plane of a triangle, and so the triangle, is farther from p than the root of `squared`.
bool is_beyond_plane(const Solid& solid, std::uint32_t triangle, const Vec3d& p, double squared) {
    constexpr double rounding = 1 + 0x1p-40;
    const auto [a, b, c] = solid.corners(triangle);
    const Vec3d normal = cross(b - a, c - a);
    const double height = dot(normal, p - a);
    return height * height > rounding * squared * dot(normal, normal);
}

} // namespace

Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p) {
    const auto [a, b, c] = solid.corners(triangle);
    const auto [at, way] = closest_seen_from(p, a, b, c);
    return {{triangle, {at.weight[0], at.weight[1], at.weight[2]}, p + way}, way, at.squared_distance};
}

Box3d SurfaceTree::box_of(std::uint32_t triangle) const {
    const auto [a, b, c] = solid_.corners(triangle);
    Box3d box{a, a};
    extend(box, {b, b});
    extend(box, {c, c});
    return box;
}

void SurfaceTree::sort_along_curve() {
    const auto count = static_cast<std::uint32_t>(solid_.topology->triangles.size());
    Box3d all = empty_box3d;
    for (std::uint32_t t = 0; t < count; ++t) extend(all, box_of(t));
    order_.resize(count);
    scratch_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const Box3d box = box_of(t);
        const std::uint64_t code = morton_code(cell_of((box.min.x + box.max.x) / 2, all.min.x, all.max.x),
                                               cell_of((box.min.y + box.max.y) / 2, all.min.y, all.max.y),
                                               cell_of((box.min.z + box.max.z) / 2, all.min.z, all.max.z));
        order_[t] = {static_cast<std::uint32_t>(code), t};
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
}

std::uint32_t SurfaceTree::leaves_of(std::size_t triangles) {
    return static_cast<std::uint32_t>(
        std::bit_ceil(std::max<std::size_t>((triangles + leaf_size - 1) / leaf_size, 1)));
}

void SurfaceTree::reserve(std::size_t triangles) {
    order_.reserve(triangles);
    scratch_.reserve(triangles);
    boxes_.reserve(2 * std::size_t{leaves_of(triangles)} - 1);
    slabs_.reserve(2 * std::size_t{leaves_of(triangles)} - 1);
}

void SurfaceTree::build(const Solid& solid) {
    solid_ = solid;
    reserve(solid.topology->triangles.size());
    sort_along_curve();
    const auto count = static_cast<std::uint32_t>(order_.size());
    leaves_ = leaves_of(count);
    boxes_.assign(2 * std::size_t{leaves_} - 1, empty_box3d);
    for (std::uint32_t i = 0; i < count; ++i)
        extend(boxes_[std::size_t{leaves_} - 1 + i / leaf_size], box_of(order_[i].triangle));
    for (std::size_t i = leaves_ - 1; i-- > 0;) {
        boxes_[i] = boxes_[2 * i + 1];
        extend(boxes_[i], boxes_[2 * i + 2]);
    }
    slabs_.assign(boxes_.size(), {});
    last_ = order_[0].triangle;
    middle_ = 0.5 * (boxes_[0].min + boxes_[0].max);
    size_ = length(boxes_[0].max - boxes_[0].min);
}

// Whether the slab of a node shows that all its triangles are farther from p than `distance`.
bool SurfaceTree::is_beyond_slab(std::size_t node, const Vec3d& p, double distance) {
    // Only for nodes with few triangles. With many, a slab is as thick as their box, and takes long to make.
    constexpr std::size_t most_leaves = 16;
    if (most_leaves * (node + 1) < leaves_) return false;
    std::size_t first = node, leaves = 1; // of the node's subtree
    for (; first < leaves_ - 1; leaves *= 2) first = 2 * first + 1;
    first = (first - (leaves_ - 1)) * leaf_size;
    const std::size_t last = std::min(first + leaves * leaf_size, order_.size());
    Slab& slab = slabs_[node];
    if (!slab.is_made) {
        slab.is_made = true;
        Vec3d areas{0, 0, 0};
        for (std::size_t i = first; i < last; ++i) {
            const auto [a, b, c] = solid_.corners(order_[i].triangle);
            const Vec3d area = cross(b - a, c - a);
            areas = dot(areas, area) < 0 ? areas - area : areas + area; // whatever their winding
        }
        slab.normal = normalised(areas);
        slab.low = infinity;
        slab.high = -infinity;
        for (std::size_t i = first; i < last; ++i)
            for (const Vec3d& corner : solid_.corners(order_[i].triangle)) {
                const double height = dot(slab.normal, corner - middle_);
                slab.low = std::min(slab.low, height);
                slab.high = std::max(slab.high, height);
            }
    }
    const Vec3d from_middle = p - middle_;
    const double height = dot(slab.normal, from_middle);
    const double rounding = 0x1p-48 * (size_ + length(from_middle));
    return std::max(slab.low - height, height - slab.high) > distance + rounding;
}

bool SurfaceTree::accept(const Vec3d& p, const Fold& fold, const Closest& found) const {
    if (has_corner(solid_.topology->triangles[found.at.triangle], fold.vertex)) return false;
    if (!fold.only_straight || found.squared == 0) return true;
    // The walk goes twice as far, so that rounding does not end it too early.
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (!walk_out(solid_, fold.tet, p, p + 2.0 * found.way, out, tets)) return false;
    const Vec3d way = out.point - p, rest = out.point - found.at.point;
    constexpr double rounding = 1e-12; // squared
    return !has_corner(solid_.topology->triangles[out.triangle], fold.vertex) &&
           dot(rest, rest) <= rounding * dot(way, way);
}

bool SurfaceTree::find(const Vec3d& p, const Fold* fold, Closest& out, std::uint64_t& visited) {
    struct Node {
        double squared; // a bound of the squared distance to the box
        std::size_t box;
    };
    bool found = false;
    double best = infinity, best_distance = infinity;
    const auto look_at = [&](std::uint32_t triangle) {
        ++visited;
        if (is_beyond_plane(solid_, triangle, p, best)) return;
        const Closest candidate = closest_point(solid_, triangle, p);
        if (candidate.squared > best || (candidate.squared == best && found &&
                                         !solid_.topology->before(candidate.at.triangle, out.at.triangle)))
            return;
        if (fold && !accept(p, *fold, candidate)) return;
        found = true;
        best = candidate.squared;
        best_distance = std::sqrt(best);
        out = candidate;
    };
    look_at(last_);
    std::array<Node, 64> stack; // one box waits at each level
    std::size_t waiting = 0;
    for (Node node{squared_distance_bound(p, boxes_[0]), 0};; node = stack[--waiting]) {
        while (node.squared <= best && node.squared < infinity &&
               !is_beyond_slab(node.box, p, best_distance)) {
            const std::size_t child = 2 * node.box + 1;
            if (child < boxes_.size()) {
                Node near{squared_distance_bound(p, boxes_[child]), child},
                    far{squared_distance_bound(p, boxes_[child + 1]), child + 1};
                if (far.squared < near.squared) std::swap(near, far);
                stack[waiting++] = far;
                node = near;
                continue;
            }
            const std::size_t first = (node.box - (leaves_ - 1)) * leaf_size;
            for (std::size_t i = first; i < std::min(first + leaf_size, order_.size()); ++i)
                look_at(order_[i].triangle);
            break;
        }
        if (waiting == 0) break;
    }
    if (found) last_ = out.at.triangle;
    return found;
}

bool SurfaceTree::find_of_contact(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, bool self,
                                  Closest& out, std::uint64_t& visited) {
    if (!self) return find(p, nullptr, out, visited);
    Fold fold{vertex, tet, true};
    if (find(p, &fold, out, visited)) return true;
    fold.only_straight = false;
    return find(p, &fold, out, visited);
}

} // namespace vox::depth
