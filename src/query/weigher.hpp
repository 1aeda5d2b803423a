// Weights for the caller, collected so that they fill whole registers.
#pragma once

#include "exact/accurate.hpp"
#include "query/facets.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox {

class Queries::Weigher {
public:
    enum class Of {
        inside,  // points in closed tetrahedra
        any,     // points anywhere, in tetrahedra of non-zero volume
        closest, // the closest points of facets
    };
    explicit Weigher(Of of) noexcept : of_(of) {}
    ~Weigher() { flush(); }
    Weigher(const Weigher&) = delete;
    Weigher& operator=(const Weigher&) = delete;

    // Writes the weights for p to `out`, now or later.
    void add(const Vec3d& p, const LeafTets& tets, std::size_t place, double (&out)[4]) noexcept {
        for (std::size_t c = 0; c < 4; ++c) put_corner(c, tets.corner(place, c), c);
        put(p, out);
    }
    // Likewise of a facet's corners. If it is too thin, `out` stays.
    void add(const Vec3d& p, const LeafTets& tets, std::size_t place, std::size_t facet,
             double (&out)[4]) noexcept {
        const OrderedFacet f(tets, place, facet);
        for (std::size_t c = 0; c < 3; ++c)
            put_corner(c, tets.at(f.vertex[c]), facet_corners[facet][f.place[c]]);
        put(p, out);
    }

private:
    void put_corner(std::size_t c, const Vec3d& at, std::size_t corner) noexcept {
        set(block_.corner[c], count_, at);
        corner_[c][count_] = static_cast<std::uint8_t>(corner);
    }
    void put(const Vec3d& p, double (&out)[4]) noexcept {
        set(block_.point, count_, p);
        out_[count_++] = &out;
        if (count_ == point_block) flush();
    }
    void flush() noexcept {
        if (count_ == 0) return;
        const std::size_t corners = of_ == Of::closest ? 3 : 4;
        fill_last_register(block_, count_, corners);
        std::uint64_t unknown = 0;
        if (of_ == Of::closest)
            unknown = weigh_closest(block_, count_, weights_);
        else
            weigh_accurately(block_, count_, of_ == Of::inside, weights_);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t c = 0; c < corners && !(unknown >> i & 1); ++c)
                (*out_[i])[corner_[c][i]] = weights_.weight[c][i];
        count_ = 0;
    }

    Of of_;
    std::size_t count_ = 0;
    PointBlock block_;
    std::uint8_t corner_[4][point_block]; // of the tetrahedron
    double (*out_[point_block])[4];
    AccurateWeights weights_;
};

} // namespace vox
