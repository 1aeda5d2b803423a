// The voxel grid of the reference engine, with a list of particles for each cubic cell. Two storages and two
// hashes differ only in how the coordinates of a cell become a bucket:
//   dense   linear id k*nx*ny + j*nx + i in a box of cells (paper, Sect. 3)
//   hashed  the hash of Teschner, Heidelberger, Mueller, Pomeranets, Gross, "Optimized Spatial Hashing for
//           Collision Detection of Deformable Objects", VMV 2003, or a well-mixed 64-bit hash, modulo a prime
// A bucket holds the occupied cells that fell into it with their coordinates, so that two cells in one bucket
// are never confused. Positions can be chosen so that a hash puts all cells into one bucket. A bucket with
// far more cells than chance gives it is noticed (CellLists::insert), and SortedAddress takes the hash's
// place.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

struct CellCoord {
    std::int32_t i, j, k;

    bool operator==(const CellCoord&) const = default;
};

// Maps positions to cells, both for particles and for the corners of boxes. The map is monotone on each axis,
// rounding and clamping included, so a particle in a box is always in one of the cells of the box.
class Lattice {
public:
    Lattice(const Vec3d& origin, double cell_size, const CellCoord& min, const CellCoord& max)
        : origin_(origin), inverse_(std::min(1 / cell_size, std::numeric_limits<double>::max())), min_(min),
          max_(max) {}

    CellCoord cell_of(const Vec3f& p) const {
        return {along_axis(p.x, origin_.x, min_.i, max_.i), along_axis(p.y, origin_.y, min_.j, max_.j),
                along_axis(p.z, origin_.z, min_.k, max_.k)};
    }

private:
    std::int32_t along_axis(float x, double origin, std::int32_t min, std::int32_t max) const {
        // An infinite product is clamped before it becomes an integer; a NaN cannot arise.
        const double scaled = std::min(std::max((double(x) - origin) * inverse_, double(min)), double(max));
        const auto truncated = static_cast<std::int32_t>(scaled);
        return truncated - (double(truncated) > scaled); // floor
    }

    Vec3d origin_;
    double inverse_;
    CellCoord min_, max_;
};

// number % divisor for 32-bit numbers by multiplication: Lemire, Kaser, Kurz, "Faster remainder by direct
// computation", Software: Practice and Experience 49, 2019.
class Modulus {
public:
    explicit Modulus(std::uint32_t divisor)
        : divisor_(divisor), reciprocal_(std::numeric_limits<std::uint64_t>::max() / divisor + 1) {}

    std::uint32_t operator()(std::uint32_t number) const {
        const std::uint64_t fraction = reciprocal_ * number;
        // The high half of the 96-bit product fraction * divisor.
        return std::uint32_t(((fraction >> 32) * divisor_ + (((fraction & 0xffffffffu) * divisor_) >> 32)) >>
                             32);
    }

private:
    std::uint64_t divisor_;
    std::uint64_t reciprocal_;
};

// The three ways from a cell to a bucket. row(j, k) is the part that is the same for all cells along x,
// bucket(row, i) does the rest.
struct DenseAddress {
    std::uint32_t nx, ny;

    std::uint32_t row(std::int32_t j, std::int32_t k) const {
        return (std::uint32_t(k) * ny + std::uint32_t(j)) * nx;
    }
    std::uint32_t bucket(std::uint32_t row, std::int32_t i) const { return row + std::uint32_t(i); }
};

struct PaperAddress { // in 32-bit unsigned arithmetic, which wraps for negative coordinates too
    Modulus table;

    std::uint32_t row(std::int32_t j, std::int32_t k) const {
        return std::uint32_t(j) * 19349663u ^ std::uint32_t(k) * 83492791u;
    }
    std::uint32_t bucket(std::uint32_t row, std::int32_t i) const {
        return table(row ^ std::uint32_t(i) * 73856093u);
    }
};

struct MixedAddress { // odd multipliers of 64 bits, folded and multiplied again; the upper half is taken
    Modulus table;

    std::uint64_t row(std::int32_t j, std::int32_t k) const {
        return std::uint64_t(std::int64_t(j)) * 0xc2b2ae3d27d4eb4fu +
               std::uint64_t(std::int64_t(k)) * 0x165667b19e3779f9u;
    }
    std::uint32_t bucket(std::uint64_t row, std::int32_t i) const {
        std::uint64_t h = row + std::uint64_t(std::int64_t(i)) * 0x9e3779b97f4a7c15u;
        h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
        return table(std::uint32_t(h >> 32));
    }
};

// No hash: the number of a cell in a sorted list of the occupied ones, by binary search. A cell that is not
// in the list gets the bucket of another.
struct SortedAddress {
    std::span<const CellCoord> cells; // not empty

    struct Row {
        std::int32_t j, k;
    };
    static bool before(const CellCoord& a, const CellCoord& b) {
        return std::tie(a.k, a.j, a.i) < std::tie(b.k, b.j, b.i);
    }
    Row row(std::int32_t j, std::int32_t k) const { return {j, k}; }
    std::uint32_t bucket(const Row& row, std::int32_t i) const {
        const auto found = std::lower_bound(cells.begin(), cells.end(), CellCoord{i, row.j, row.k}, before);
        return std::uint32_t(
            std::min<std::ptrdiff_t>(found - cells.begin(), std::ptrdiff_t(cells.size()) - 1));
    }
};

// An occupied cell and the head of its list of particles.
struct Cell {
    CellCoord at;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t next; // cell in the same bucket
};

// A particle of the scene, packed with its link in the list of its cell.
struct Particle {
    Vec3f position;
    std::uint32_t next;
};

class CellLists {
public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    explicit CellLists(std::pmr::memory_resource* memory) : heads_(memory), cells_(memory) {}

    // Empties the grid and makes room for `particle_count` occupied cells.
    void reset(std::size_t bucket_count, std::size_t particle_count) {
        cells_.clear();
        // The old array is released before the new one is allocated, so that the budget never has to hold
        // both.
        if (bucket_count > heads_.capacity()) heads_ = Array<std::uint32_t>(heads_.memory());
        heads_.assign(bucket_count, none);
        cells_.reserve(particle_count);
        // A hash without pattern gives the fullest bucket of n about ln n / ln ln n cells where there is one
        // for each bucket (Knuth 3, Sect. 6.4; 9 of a million), and few more than the mean where there are
        // many. The bound is far above that.
        longest_chain_ = 32 + 8 * (particle_count / std::max<std::size_t>(bucket_count, 1));
    }

    // The occupied cell at these coordinates of this bucket, or null.
    const Cell* find(std::uint32_t bucket, const CellCoord& at) const {
        for (std::uint32_t c = heads_[bucket]; c != none; c = cells_[c].next)
            if (cells_[c].at == at) return &cells_[c];
        return nullptr;
    }

    // Puts particle `index` at the head of its cell's list; returns how many are in the cell now. Returns 0,
    // and has changed nothing, if the bucket has so many cells that its hash is not to be used.
    std::uint32_t insert(std::uint32_t bucket, const CellCoord& at, Particle& particle, std::uint32_t index) {
        std::uint32_t c = heads_[bucket];
        std::size_t left = longest_chain_;
        for (; c != none && cells_[c].at != at; c = cells_[c].next)
            if (--left == 0) return 0;
        if (c == none) {
            c = std::uint32_t(cells_.size());
            cells_.push_back({at, none, 0, heads_[bucket]});
            heads_[bucket] = c;
        }
        particle.next = cells_[c].first;
        cells_[c].first = index;
        return ++cells_[c].count;
    }

    const Array<Cell>& occupied() const { return cells_; }
    std::size_t bucket_bytes() const noexcept { return heads_.capacity() * sizeof(std::uint32_t); }

private:
    Array<std::uint32_t> heads_; // by bucket
    Array<Cell> cells_;
    std::size_t longest_chain_ = 0; // most cells of a bucket
};

// The smallest prime that is at least `number`, or else the largest prime of 32 bits.
inline std::uint32_t next_prime(std::uint64_t number) {
    const auto is_prime = [](std::uint64_t n) {
        if (n % 2 == 0) return n == 2;
        for (std::uint64_t d = 3; d * d <= n; d += 2)
            if (n % d == 0) return false;
        return n > 1;
    };
    constexpr std::uint64_t largest = 4294967291u;
    number = std::clamp<std::uint64_t>(number, 2, largest);
    while (!is_prime(number)) ++number;
    return std::uint32_t(number);
}

} // namespace vox
