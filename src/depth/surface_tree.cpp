// A tree over the triangles, sorted along a Z-shaped curve (Lauterbach et al., "Fast BVH construction on
// GPUs", Computer Graphics Forum 28, 2009), whose boxes follow the positions.
#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "depth/closest.hpp"

#include <algorithm>
#include <cmath>

namespace vox::depth {

namespace {

constexpr int axis_bits = 10; // the curve runs through 2^axis_bits cells an axis

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

} // namespace

void SurfaceTree::reserve(std::size_t triangles) {
    const std::size_t leaves = (triangles + tree_width - 1) / tree_width;
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
Array<SurfaceTree::Key> SurfaceTree::sort_along_curve() const {
    const auto count = static_cast<std::uint32_t>(solid_.topology->triangles.size());
    Array<Key> order(count, part_.memory());
    for (std::uint32_t t = 0; t < count; ++t) {
        const Box3d box = box_of(solid_, t);
        const std::uint32_t part = part_.empty() ? 0 : part_[solid_.topology->triangles[t].v[0]];
        order[t] = {part, place_on_curve(0.5 * box.min + 0.5 * box.max), t};
    }
    std::sort(order.begin(), order.end());
    return order;
}

// No leaf has triangles of two parts. The lanes that this leaves over hold the triangle before them again.
void SurfaceTree::lay_out(std::span<const Key> order) {
    triangles_.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && order[i].part != order[i - 1].part)
            while (triangles_.size() % tree_width != 0) triangles_.push_back(triangles_.back());
        triangles_.push_back(order[i].triangle);
    }
    while (triangles_.size() % tree_width != 0) triangles_.push_back(triangles_.back());

    const auto leaves = static_cast<std::uint32_t>(triangles_.size() / tree_width);
    levels_.clear();
    levels_.reserve(TreeView::most_levels);
    std::uint32_t first_child = 0, last_child = leaves;
    do {
        const std::size_t count = (last_child - first_child + tree_width - 1) / tree_width;
        levels_.push_back({last_child - leaves, count, first_child, last_child});
        first_child = last_child;
        last_child += static_cast<std::uint32_t>(count);
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

void SurfaceTree::update(const Solid& solid, bool folds, Workers* workers) {
    solid_ = solid;
    if (folds && !has_parts_) {
        find_parts();
        is_built_ &= part_.empty();
    }
    if (!is_built_) {
        reserve(solid.topology->triangles.size());
        take_frame();
        lay_out(sort_along_curve());
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
    for_ranges(workers, leaves_.size(), least,
               [&](std::size_t begin, std::size_t end, std::uint32_t) { fit_leaves(begin, end); });
    for (const TreeLevel& level : levels_)
        for_ranges(workers, level.count, least, [&](std::size_t begin, std::size_t end, std::uint32_t) {
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

// True if the frame still suits the positions: the largest coordinate, of which it notes a bound, is neither
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
    const auto count = static_cast<std::uint32_t>(topology.links.size());
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

// ---- all trees --------------------------------------------------------------------------------------

auto SurfaceTrees::place(std::uint32_t mesh_id) noexcept -> Tree* {
    return std::ranges::lower_bound(trees_, mesh_id, {}, &Tree::mesh_id);
}

void SurfaceTrees::add(std::uint32_t mesh_id) {
    const auto at = place(mesh_id);
    if (at != trees_.end() && at->mesh_id == mesh_id) return;
    trees_.insert(at, {mesh_id, SurfaceTree(trees_.memory())});
}

SurfaceTree& SurfaceTrees::operator[](std::uint32_t mesh_id) noexcept { return place(mesh_id)->tree; }

void SurfaceTrees::topology_changed(std::uint32_t mesh_id) noexcept {
    const auto at = place(mesh_id);
    if (at != trees_.end() && at->mesh_id == mesh_id) at->tree.invalidate();
}

void SurfaceTrees::forget(std::uint32_t mesh_id) noexcept {
    erase_if(trees_, [mesh_id](const Tree& tree) { return tree.mesh_id == mesh_id; });
}

void SurfaceTrees::forget_all() noexcept { trees_ = Array<Tree>(trees_.memory()); }

} // namespace vox::depth
