#include "query/batch.hpp"

#include "base/vectors.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <utility>

namespace vox {

namespace {

// The edge length of a cell in harmonic mean box sides of tiles, the value of a step (fast/windows.cpp).
constexpr double cell_in_tile_sides = 0.6;

} // namespace

Queries::Batch::Batch(const Queries& queries, QueryMeshes which, std::pmr::memory_resource* memory,
                      Array<PointHit>& found)
    : queries_(queries), which_(which), hits_(found), collected_(memory), bins_(memory), windows_(memory),
      boundary_hits_(memory), scratch_(1, memory) {
    for (const Mesh& mesh : queries.meshes_)
        if (wants(mesh, which)) add(region_, mesh.box);
}

void Queries::Batch::find(std::span<const Vec3d> points) {
    points_ = points;
    if (!collect(points)) return;
    const Box around = fast::bounds(collected_);
    TileSize size;
    for (const Mesh& mesh : queries_.meshes_)
        if (wants(mesh, which_) && overlap(mesh.box, around)) size.add(mesh.tile_size);
    bins_.clear();
    const std::uint32_t root = fast::bin_tree(collected_, cell_in_tile_sides * size.mean(), bins_);
    for (std::uint32_t m = 0; m < queries_.meshes_.size(); ++m)
        if (wants(queries_.meshes_[m], which_) && overlap(queries_.meshes_[m].box, around))
            find_in_mesh(m, root);
    locate_all();
}

// Rounds the points to floats and drops those that are in no mesh's box. Returns whether any are left.
bool Queries::Batch::collect(std::span<const Vec3d> points) {
    collected_.reserve(points.size(), points.size());
    std::uint32_t n = 0;
    bool exact = true;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3d& exact_point = points[i];
        const Vec3f p = nearest_floats(exact_point);
        collected_.x[n] = p.x;
        collected_.y[n] = p.y;
        collected_.z[n] = p.z;
        collected_.id[n] = i;
        exact &=
            (double{p.x} == exact_point.x) & (double{p.y} == exact_point.y) & (double{p.z} == exact_point.z);
        n += (p.x >= region_.lo[0]) & (p.x <= region_.hi[0]) & (p.y >= region_.lo[1]) &
             (p.y <= region_.hi[1]) & (p.z >= region_.lo[2]) & (p.z <= region_.hi[2]);
    }
    collected_.count = n;
    rounded_ = !exact;
    boundary_hits_.assign(points.size(), none);
    return n > 0;
}

void Queries::Batch::find_in_mesh(std::uint32_t m, std::uint32_t root) {
    const Mesh& mesh = queries_.meshes_[m];
    const Tiles& tiles = mesh.tets->tiles;
    const auto count = static_cast<std::uint32_t>(tiles.tiles.size());
    fast::TiledBody body{};
    body.tiles = &tiles;
    body.positions = &queries_.floats_[mesh.first_vertex].x;
    body.boxes = queries_.tile_boxes_.data() + mesh.first_leaf;
    body.rounded = mesh.rounded || rounded_;
    body.by_place = true;
    mesh_ = m;
    tile_ = 0;
    tets_.reset();
    for (std::uint32_t first = 0, group = 0; first < count; first += super_tile_size, ++group) {
        windows_.clear();
        fast::for_windows(bins_, root, queries_.groups_[mesh.first_group + group],
                          [&](const fast::Window& window) {
                              windows_.push_back({window, window.box, 0});
                          });
        if (windows_.empty()) continue;
        fast::look_up_tiles(body, windows_, first, std::min(first + super_tile_size, count), scratch_[0],
                            *this);
    }
    fast::flush(scratch_[0], *this);
}

// The lookup goes from tile to tile, so the tile of a finding is that of the previous finding or a later one.
void Queries::Batch::take(std::span<const fast::Finding> findings) {
    const Mesh& mesh = queries_.meshes_[mesh_];
    const Array<Tile>& tiles = mesh.tets->tiles.tiles;
    for (const fast::Finding& f : findings) {
        const std::uint32_t before = tile_;
        while (f.tet - tiles[tile_].first_tet >= tiles[tile_].tet_count) ++tile_;
        const auto leaf = static_cast<std::uint32_t>(mesh.first_leaf) + tile_;
        if (!tets_ || tile_ != before) tets_.emplace(queries_.tets_of(queries_.leaves_[leaf]));
        const LeafTets& tets = *tets_;
        const std::uint32_t place = f.tet - tiles[tile_].first_tet;
        if (f.certain)
            hits_.push_back({f.vertex, mesh_, tets.index(place), true, leaf, place});
        else
            locate_later(f.vertex, leaf, place);
    }
}

void Queries::Batch::locate_later(std::uint32_t point, std::uint32_t leaf, std::uint32_t place) {
    const std::size_t i = unlocated_count_++;
    unlocated_[i] = {point, mesh_, leaf, place};
    set(block_.point, i, points_[point]);
    for (std::size_t c = 0; c < 4; ++c) set(block_.corner[c], i, tets_->corner(place, c));
    if (unlocated_count_ == point_block) locate_all();
}

void Queries::Batch::locate_all() {
    const std::size_t count = std::exchange(unlocated_count_, 0);
    if (count == 0) return;
    fill_last_register(block_, count);
    std::uint64_t exact_tests = 0;
    VolumeBlock volumes;
    const CertainLocations certain = locate(block_, count, volumes);
    for (std::size_t i = 0; i < count; ++i) {
        if (certain.outside >> i & 1) continue;
        const Unlocated& one = unlocated_[i];
        const LeafTets tets = queries_.tets_of(queries_.leaves_[one.leaf]);
        bool interior = certain.interior >> i & 1;
        if (!interior && !(certain.boundary >> i & 1)) {
            const Containment where = locate_in_solid(
                volumes.of(i), points_[one.point], tets.corner(one.place, 0), tets.corner(one.place, 1),
                tets.corner(one.place, 2), tets.corner(one.place, 3), exact_tests);
            if (where == Containment::outside || where == Containment::degenerate) continue;
            interior = where == Containment::interior;
        }
        const PointHit hit{one.point, one.mesh, tets.index(one.place), interior, one.leaf, one.place};
        if (interior)
            hits_.push_back(hit);
        else
            keep_lowest(hit);
    }
}

// Keeps only the lowest tetrahedron of a mesh that has the point on its boundary, as a vertex may be in
// dozens.
void Queries::Batch::keep_lowest(const PointHit& hit) {
    std::uint32_t& kept = boundary_hits_[hit.point];
    if (kept == none || hits_[kept].mesh != hit.mesh) {
        kept = static_cast<std::uint32_t>(hits_.size());
        hits_.push_back(hit);
    } else if (hit.tet < hits_[kept].tet) {
        hits_[kept] = hit;
    }
}

} // namespace vox
