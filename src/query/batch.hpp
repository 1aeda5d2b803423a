// Locates many points at once in the tiles of all meshes, by stages of the fast engine.
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
    // find() appends hits to `found`, in no particular order. If a point is on the boundary of several
    // tetrahedra of a mesh, only the lowest one is reported.
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
    Array<PointHit>& hits_;
    Box region_ = empty_box;        // around the meshes
    std::span<const Vec3d> points_; // of this call
    bool rounded_ = false;          // some are not floats
    fast::Points collected_;        // those in the region, as floats
    fast::Bins bins_;
    Array<fast::Source> windows_;
    static constexpr std::uint32_t none = ~0u;
    Array<std::uint32_t> boundary_hits_; // for each of points_ its last hit on a boundary, in hits_
    Array<fast::LookupScratch> scratch_; // one
    // The place of the present finding. Findings come in the order of tiles.
    std::uint32_t mesh_ = 0, tile_ = 0;
    std::optional<LeafTets> tets_;
    // Points that wait until they fill whole registers, each with a tetrahedron that may contain it.
    struct Unlocated {
        std::uint32_t point, mesh, leaf, place; // see PointHit
    };
    Unlocated unlocated_[point_block];
    std::size_t unlocated_count_ = 0;
    PointBlock block_; // the coordinates of unlocated_
};

} // namespace vox
