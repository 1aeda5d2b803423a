#include "overlaps.hpp"

#include "body.hpp"
#include "failure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace tool {
namespace {

using Vector = std::array<double, 3>;

Vector minus(const double* p, const double* q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// By its largest number, so that no product overflows.
Vector scaled(const Vector& a) {
    const double largest = std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])});
    return largest > 0 ? Vector{a[0] / largest, a[1] / largest, a[2] / largest} : a;
}

class Finder {
public:
    Finder(const std::vector<double>& positions, const std::vector<Triangle>& triangles)
        : positions_(positions), triangles_(triangles) {}

    std::vector<Overlap> find() {
        find_same();
        std::vector<Wing> wings;
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            for (std::size_t i = 0; i < 3 && is_proper(triangles_[t]); ++i) {
                const std::uint32_t v = triangles_[t][i], w = triangles_[t][(i + 1) % 3];
                wings.push_back({{std::min(v, w), std::max(v, w)}, triangles_[t][(i + 2) % 3], t, 0});
            }
        const auto less = [](const Wing& x, const Wing& y) {
            return std::tie(x.edge, x.tip, x.triangle) < std::tie(y.edge, y.tip, y.triangle);
        };
        std::sort(wings.begin(), wings.end(), less);
        const auto same_tip = [](const Wing& x, const Wing& y) { return x.edge == y.edge && x.tip == y.tip; };
        wings.erase(std::unique(wings.begin(), wings.end(), same_tip), wings.end()); // doubled, opposite
        for (auto first = wings.begin(), last = first; first != wings.end(); first = last) {
            while (last != wings.end() && last->edge == first->edge) ++last;
            if (last - first > 1) find_folds(first, last);
        }
        return std::move(found_);
    }

private:
    struct Wing { // a triangle at one of its edges
        std::array<std::uint32_t, 2> edge;
        std::uint32_t tip;
        std::size_t triangle;
        double angle; // about the edge, from any direction
    };
    using WingIterator = std::vector<Wing>::iterator;

    const double* at(std::uint32_t v) const { return &positions_[3 * std::size_t{v}]; }
    static bool is_proper(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

    void find_same() {
        struct Sorted {
            Triangle corners;
            std::size_t triangle;
        };
        std::vector<Sorted> all;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (!is_proper(triangles_[t])) continue;
            all.push_back({triangles_[t], t});
            std::sort(all.back().corners.begin(), all.back().corners.end());
        }
        std::stable_sort(all.begin(), all.end(),
                         [](const Sorted& x, const Sorted& y) { return x.corners < y.corners; });
        for (std::size_t i = 1; i < all.size(); ++i) {
            if (all[i].corners != all[i - 1].corners) continue;
            const Triangle &x = triangles_[all[i - 1].triangle], &y = triangles_[all[i].triangle];
            const auto start = static_cast<std::size_t>(std::find(y.begin(), y.end(), x[0]) - y.begin());
            const bool same_way = y[(start + 1) % 3] == x[1];
            found_.push_back({all[i - 1].triangle, all[i].triangle,
                              same_way ? OverlapKind::doubled : OverlapKind::opposite});
        }
    }

    // The triangles of one edge, sorted by their angle. Rounding may confuse those of nearly the same angle:
    // these are sorted again, exactly.
    void find_folds(WingIterator first, WingIterator last) {
        last = std::remove_if(first, last,
                              [this, x = Vector{}](Wing& wing) mutable { return !set_angle(wing, x); });
        std::sort(first, last, [](const Wing& x, const Wing& y) { return x.angle < y.angle; });
        constexpr double near = 1e-3, circle = 2 * std::numbers::pi;
        // The circle is cut where there is a gap.
        const auto gap = std::adjacent_find(
            first, last, [](const Wing& x, const Wing& y) { return y.angle - x.angle > near; });
        if (gap != last) {
            for (auto wing = first; wing != gap + 1; ++wing) wing->angle += circle;
            std::rotate(first, gap + 1, last);
        }
        for (auto begin = first, end = first; begin != last; begin = end) {
            for (++end;
                 end != last && end->angle - (end - 1)->angle <= near && end->angle - begin->angle < 1;)
                ++end;
            if (end - begin < 2) continue;
            std::sort(begin, end, [this](const Wing& x, const Wing& y) { return side(x, y) > 0; });
            for (auto wing = begin + 1; wing != end; ++wing)
                if (side(wing[-1], wing[0]) == 0) {
                    const auto [low, high] = std::minmax(wing[-1].triangle, wing[0].triangle);
                    found_.push_back({low, high, OverlapKind::folded});
                }
        }
    }

    // The angle of the tip about the edge, from the direction `x`, which the first sets. Returns false for a
    // triangle so flat that rounding may have moved the tip to anywhere.
    bool set_angle(Wing& wing, Vector& x) const {
        const Vector edge = scaled(minus(at(wing.edge[1]), at(wing.edge[0])));
        const Vector side = scaled(minus(at(wing.tip), at(wing.edge[0])));
        const Vector normal = cross(edge, side);
        if (!(dot(normal, normal) > 1e-24 * dot(edge, edge) * dot(side, side))) return false;
        const Vector up = scaled(cross(normal, edge));
        if (dot(x, x) == 0) x = up;
        wing.angle = std::atan2(dot(cross(x, up), edge) / std::sqrt(dot(edge, edge)), dot(x, up));
        return true;
    }

    // The exact sign of the volume of the tetrahedron of an edge and two tips, as vox_io decides it.
    int side(const Wing& x, const Wing& y) const {
        if (x.tip == y.tip) return 0;
        double corners[12];
        const std::uint32_t vertices[4] = {x.edge[0], x.edge[1], x.tip, y.tip};
        for (std::size_t i = 0; i < 4; ++i) std::copy_n(at(vertices[i]), 3, corners + 3 * i);
        const std::uint32_t tet[4] = {0, 1, 2, 3};
        const vox_io_mesh_view arrays{corners, 4, tet, 1, nullptr, 0, nullptr, nullptr, nullptr};
        vox_io_mesh* made = nullptr;
        check(vox_io_mesh_create(&arrays, &made));
        const Mesh mesh(made);
        auto report = sized<vox_io_report>();
        check(vox_io_mesh_get_report(mesh.get(), &report));
        return report.degenerate_tets ? 0 : report.inverted_tets ? -1 : 1;
    }

    const std::vector<double>& positions_;
    const std::vector<Triangle>& triangles_;
    std::vector<Overlap> found_;
};

} // namespace

std::vector<Overlap> find_overlaps(const std::vector<double>& positions,
                                   const std::vector<Triangle>& triangles) {
    std::vector<Overlap> found = Finder(positions, triangles).find();
    std::sort(found.begin(), found.end(), [](const Overlap& x, const Overlap& y) {
        return std::tie(x.first, x.second, x.kind) < std::tie(y.first, y.second, y.kind);
    });
    return found;
}

} // namespace tool
