// Many points at once against the tiles of all meshes, by stages of the fast engine.
#pragma once

#include "base/array.hpp"
#include "exact/point_location.hpp"
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
    // boundary, the lowest only.
    Batch(const Queries& queries, QueryMeshes which, std::pmr::memory_resource* memory,
          Array<PointHit>& found);

    void find(std::span<const Vec3d> points);

private:
    bool collect(std::span<const Vec3d> points);
    void find_in_mesh(std::uint32_t mesh, std::uint32_t root);
    void take(std::span<const fast::Finding> findings) override;
    void keep_lowest(const PointHit& hit);
    void locate_later(std::uint32_t point, std::uint32_t leaf, std::uint32_t place);
    void locate_all();

    const Queries& queries_;
    const QueryMeshes which_;
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
    // Points that wait until there are enough of them for whole registers, and the tetrahedra that they may
    // be in.
    struct Unlocated {
        std::uint32_t point, mesh, leaf, place; // as in PointHit
    };
    Unlocated unlocated_[point_block];
    std::size_t unlocated_count_ = 0;
    PointBlock block_; // of unlocated_
};

} // namespace vox
