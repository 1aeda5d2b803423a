// Which pairs never collide: meshes, by category, mask, group and exception; a vertex and a tetrahedron of
// one mesh, by their distance along edges and in the rest pose.
#pragma once

#include "base/array.hpp"
#include "base/lists.hpp"
#include "base/scene.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

struct TetChange;

// A caller's filter with its defaults. Throws Error(INVALID_ARGUMENT), and Error(LIMIT) for too many rings.
vox_filter checked_filter(vox_filter filter);

inline bool is_sensor(const vox_filter& filter) noexcept { return (filter.flags & VOX_FILTER_SENSOR) != 0; }
inline bool collides_with_itself(const vox_filter& filter) noexcept {
    return (filter.flags & VOX_FILTER_SELF_COLLISION) != 0;
}

// True if vertices of one body may make contacts with tetrahedra of another one.
bool collide(const Body& a, const Body& b) noexcept;

// True if contacts between the two bodies have penetrations.
inline bool have_penetrations(const Body& a, const Body& b) noexcept { return !a.sensor && !b.sensor; }

// The vertices within so many edges of each vertex.
struct Rings {
    explicit Rings(std::pmr::memory_resource* memory) noexcept : near(memory), reached_from(memory) {}
    // `count` is the number of edges; the rings are empty for 0. Time and memory are proportional to their
    // size.
    Rings(std::span<const Tet> tets, std::uint32_t vertex_count, std::uint32_t count,
          std::pmr::memory_resource* memory);

    // Applies changes. `tets` and `tets_of`, which lists the tets at each vertex, are the state after them.
    // Throws what the memory throws; then the rings must be made again.
    void repair(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                std::uint32_t count);

    // Appends vertices that are in no tetrahedron. Throws like repair().
    void add_vertices(std::size_t vertex_count);

    IndexLists near; // one list a vertex, which contains it; ascending

private:
    void search(std::span<const Tet> tets, const IndexLists& tets_of, std::uint32_t vertex,
                std::uint32_t count, Array<std::uint32_t>& found);

    Array<std::uint32_t> reached_from; // for each vertex, the last search that reached it
    std::uint32_t searches = 0;
};

// Positions of a mesh at rest: as floats while these are exact, otherwise as doubles.
class RestPose {
public:
    explicit RestPose(std::pmr::memory_resource* memory) noexcept : floats_(memory), doubles_(memory) {}
    // Copies `count` finite positions. Throws what the memory throws.
    RestPose(const Positions& positions, std::uint32_t count, std::pmr::memory_resource* memory);

    bool empty() const noexcept { return size() == 0; }
    std::size_t size() const noexcept { return in_doubles_ ? doubles_.size() : floats_.size(); }
    bool in_doubles() const noexcept { return in_doubles_; }
    Vec3d operator[](std::size_t vertex) const noexcept {
        return in_doubles_ ? doubles_[vertex] : Vec3d(floats_[vertex]);
    }

    // The positions of some vertices.
    RestPose of(std::span<const std::uint32_t> vertices) const;
    // Makes append(more) unable to fail.
    void reserve_for(const RestPose& more);
    void append(const RestPose& more) noexcept;

private:
    void push(const Vec3d& p);

    bool in_doubles_ = false; // else in floats; the other list is empty
    Array<Vec3f> floats_;
    Array<Vec3d> doubles_;
};

// The filters of self-contact.
struct SelfFilter {
    explicit SelfFilter(std::pmr::memory_resource* memory) noexcept : rings(memory), rest(memory) {}

    Rings rings;              // empty: no such filter
    RestPose rest;            // empty until it is known
    double rest_distance = 0; // 0: no such filter

    // True if the filters drop a contact of `vertex` with `tet`: a corner of the tet is within the rings, or
    // the closed tet is closer than rest_distance in the rest pose.
    bool skips(std::uint32_t vertex, const Tet& tet) const noexcept {
        return (!rings.near.empty() && is_near(vertex, tet)) ||
               (rest_distance > 0 && rests_close(vertex, tet));
    }

private:
    bool is_near(std::uint32_t vertex, const Tet& tet) const noexcept;
    bool rests_close(std::uint32_t vertex, const Tet& tet) const noexcept;
};

} // namespace vox
