// What queries answer, by definition: one mesh, every tetrahedron tried. And meshes as bad as can be.
#pragma once

#include "base/boxes.hpp"
#include "base/rounding.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/predicates.hpp"
#include "internal/random.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace vox::test {

class QueryDefinition {
public:
    QueryDefinition(std::vector<Vec3d> positions, std::vector<Tet> tets)
        : positions_(std::move(positions)), tets_(std::move(tets)) {
        std::map<FacetKey, int> owners;
        for (const Tet& tet : tets_)
            for (std::uint32_t f = 0; f < 4; ++f) ++owners[sorted_facet(tet, f).key];
        for (std::uint32_t t = 0; t < tets_.size(); ++t)
            for (std::uint32_t f = 0; f < 4; ++f)
                if (owners[sorted_facet(tets_[t], f).key] == 1) surface_.emplace_back(t, f);
    }

    const std::vector<Vec3d>& positions() const { return positions_; }
    const std::vector<Tet>& tets() const { return tets_; }
    const Vec3d& corner(std::uint32_t tet, std::size_t c) const { return positions_[tets_[tet].v[c]]; }

    std::vector<std::uint32_t> tets_with(const Vec3d& p) const {
        std::vector<std::uint32_t> inner, outer;
        for (std::uint32_t t = 0; t < tets_.size(); ++t) {
            const Containment where = locate_in(p, t);
            if (where == Containment::interior) inner.push_back(t);
            if (where == Containment::boundary && outer.empty()) outer.push_back(t);
        }
        return inner.empty() ? outer : inner;
    }

    using Facet = std::pair<std::uint32_t, std::uint32_t>; // tet, facet
    const std::vector<Facet>& surface() const { return surface_; }
    // With the squared distance.
    std::pair<double, Facet> closest(const Vec3d& p) const {
        std::pair<double, Facet> best{std::numeric_limits<double>::infinity(), {}};
        for (const auto& [t, f] : surface_) {
            const double computed =
                closest_seen_from(p, corner_of(t, f, 0), corner_of(t, f, 1), corner_of(t, f, 2))
                    .at.squared_distance;
            // For a triangle of very unequal sides that may be off by much, but never below that of the box.
            best = std::min(best, {std::max(computed, squared_distance_bound(p, box_of(t))), {t, f}});
        }
        return best;
    }

    // The facets of the surface that a segment hits, sorted.
    std::vector<Facet> hits(const Vec3d& from, const Vec3d& to) const {
        std::vector<Facet> found;
        for (const auto& [t, f] : surface_)
            if (crosses(from, to, t, f)) found.emplace_back(t, f);
        return found;
    }

    bool any(const Vec3d& from, const Vec3d& to) const {
        for (std::uint32_t t = 0; t < tets_.size(); ++t) {
            const Containment where = locate_in(from, t);
            if (where == Containment::interior || where == Containment::boundary) return true;
            for (std::uint32_t f = 0; f < 4; ++f)
                if (where != Containment::degenerate && crosses(from, to, t, f)) return true;
        }
        return false;
    }

    // The tetrahedra whose boxes meet a box.
    std::vector<std::uint32_t> near(const Vec3d& low, const Vec3d& high) const {
        std::vector<std::uint32_t> found;
        for (std::uint32_t t = 0; t < tets_.size(); ++t) {
            const Vec3d least = min(min(corner(t, 0), corner(t, 1)), min(corner(t, 2), corner(t, 3)));
            const Vec3d most = max(max(corner(t, 0), corner(t, 1)), max(corner(t, 2), corner(t, 3)));
            if (least.x <= high.x && least.y <= high.y && least.z <= high.z && most.x >= low.x &&
                most.y >= low.y && most.z >= low.z)
                found.push_back(t);
        }
        return found;
    }

private:
    Box3f box_of(std::uint32_t t) const {
        Vec3d low = corner(t, 0), high = low;
        for (std::size_t c = 1; c < 4; ++c) {
            low = min(low, corner(t, c));
            high = max(high, corner(t, c));
        }
        return {{rounded_down(low.x), rounded_down(low.y), rounded_down(low.z)},
                {rounded_up(high.x), rounded_up(high.y), rounded_up(high.z)}};
    }
    const Vec3d& corner_of(std::uint32_t tet, std::uint32_t facet, std::size_t c) const {
        return corner(tet, facet_corners[facet][c]);
    }
    Containment locate_in(const Vec3d& p, std::uint32_t t) const {
        std::uint64_t exact = 0;
        return locate(p, corner(t, 0), corner(t, 1), corner(t, 2), corner(t, 3), exact);
    }
    bool crosses(const Vec3d& from, const Vec3d& to, std::uint32_t t, std::uint32_t f) const {
        const Vec3d &a = corner_of(t, f, 0), &b = corner_of(t, f, 1), &c = corner_of(t, f, 2);
        std::uint64_t exact = 0;
        if (orientation(a, b, c, from, exact) == orientation(a, b, c, to, exact)) return false;
        const int sides[3] = {orientation(from, to, a, b, exact), orientation(from, to, b, c, exact),
                              orientation(from, to, c, a, exact)};
        return *std::max_element(sides, sides + 3) <= 0 || *std::min_element(sides, sides + 3) >= 0;
    }

    std::vector<Vec3d> positions_;
    std::vector<Tet> tets_;
    std::vector<Facet> surface_;
};

// ---- bad shapes -------------------------------------------------------------------------------------

enum class Shape { usual, needles, coincident, flat, lines, huge, tiny, far, mixed };
inline constexpr const char* shape_names[] = {"usual", "needles", "coincident", "flat", "lines",
                                              "huge",  "tiny",    "far",        "mixed"};
inline constexpr int shape_count = 9;

inline Vec3d random_vector(Random& random, double size) {
    return {size * (2 * random.unit() - 1), size * (2 * random.unit() - 1), size * (2 * random.unit() - 1)};
}

inline Vec3d random_place(Random& random, Shape shape) {
    switch (shape) {
    case Shape::huge:
        return random_vector(random, 3.4028235e38);
    case Shape::tiny:
        return random_vector(random, 1e-42);
    case Shape::far:
        return Vec3d{1e9, -1e9, 1e9} + random_vector(random, 1e-6);
    case Shape::mixed:
        return random_vector(random, std::ldexp(1.0, int(random.below(200)) - 100));
    default:
        return random_vector(random, 1);
    }
}

// Tetrahedra that share no vertices, so that every facet is on the surface.
inline QueryDefinition make_soup(Random& random, Shape shape, std::size_t count) {
    std::vector<Vec3d> positions;
    std::vector<Tet> tets;
    Vec3d same[4];
    for (Vec3d& p : same) p = random_vector(random, 1);
    const double size = 2 / std::cbrt(double(count));
    for (std::uint32_t t = 0; t < count; ++t) {
        const Vec3d at = random_place(random, shape), way = random_vector(random, 1);
        for (int c = 0; c < 4; ++c) {
            Vec3d p = random_place(random, shape);
            if (shape == Shape::usual) p = at + random_vector(random, size);
            if (shape == Shape::needles) p = at + random.unit() * way + random_vector(random, 1e-9);
            if (shape == Shape::coincident) p = same[c];
            if (shape == Shape::flat) p = {at.x + size * random.unit(), at.y + size * random.unit(), at.z};
            if (shape == Shape::lines) p = {at.x, at.y, at.z + size * random.below(3)};
            positions.push_back(p);
        }
        tets.push_back({{4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3}});
    }
    return {std::move(positions), std::move(tets)};
}

} // namespace vox::test
