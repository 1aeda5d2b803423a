// Many points at once against the tiles of all meshes, by stages of the fast engine.
#pragma once

#include "base/array.hpp"
#include "exact/barycentric.hpp"
#include "fast/lookup.hpp"
#include "fast/window.hpp"
#include "query/queries.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>

namespace vox {

class Queries::Batch final : public fast::Findings {
public:
    // Appends what it finds to `found`, in no particular order; of tetrahedra of a mesh with a point on their
    // boundary, the lowest only. `weigh` says whether barycentric coordinates are wanted.
    Batch(const Queries& queries, QueryMeshes which, bool weigh, std::pmr::memory_resource* memory,
          Array<PointHit>& found);

    void find(std::span<const Vec3d> points);

private:
    bool collect(std::span<const Vec3d> points);
    void find_in_mesh(std::uint32_t mesh, std::uint32_t root);
    void take(std::span<const fast::Finding> findings) override;
    void keep_lowest(const PointHit& hit);
    void locate_all();
    void weigh_last(const LeafTets& tets);
    void weigh_all();

    const Queries& queries_;
    const QueryMeshes which_;
    const bool weigh_;
    Array<PointHit>& found_;
    Box region_ = empty_box;        // around the meshes
    std::span<const Vec3d> points_; // those asked for
    bool rounded_ = false;          // whether the nearest floats are not all exact
    fast::Points collected_;        // those of them in the region
    fast::Bins bins_;
    Array<fast::Source> near_;
    // Of each of points_: its last hit on a boundary, in found_.
    static constexpr std::uint32_t none = ~0u;
    Array<std::uint32_t> on_boundary_;
    Array<fast::LookupScratch> scratch_; // one
    // While findings are taken, in the order of tiles: where they are.
    std::uint32_t mesh_ = 0, tile_ = 0;
    std::optional<LeafTets> tets_;
    // Points and tetrahedra that wait until there are enough of them for whole registers: for their location,
    // or in found_, for their weights.
    template <class Item>
    struct Waiting {
        Item items[barycentric_block];
        std::size_t count = 0;
        BarycentricBlock<double> block;

        // The item is to be written.
        Item& add(const Vec3d& p, const LeafTets& tets, std::size_t place);
        bool full() const { return count == barycentric_block; }
        // Fills up the last register, and returns how many items there were.
        std::size_t end();
    };
    struct Unlocated {
        std::uint32_t point, mesh, leaf, place; // as in PointHit
    };
    Waiting<Unlocated> unlocated_;
    Waiting<std::uint32_t> unweighed_;
};

} // namespace vox
