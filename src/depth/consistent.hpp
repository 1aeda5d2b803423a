// Consistent penetration depths of the colliding vertices of one body in another.
#pragma once

#include "base/bits.hpp"
#include "depth/normals.hpp"
#include "depth/points.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>
#include <vector>

namespace vox::depth {

// The places of some vertices in a list.
class VertexPlaces {
public:
    explicit VertexPlaces(std::pmr::memory_resource* memory) : places_(memory) {}

    static constexpr std::uint32_t none = 0xffffffffu;

    auto& buffer() noexcept { return places_; }
    // For vertices below `vertex_count`. Throws what the memory throws.
    void reserve(std::size_t vertex_count) {
        if (places_.size() < vertex_count) places_.resize(vertex_count, none);
    }
    void add(std::uint32_t vertex, std::uint32_t place) noexcept { places_[vertex] = place; }
    void remove(std::uint32_t vertex) noexcept { places_[vertex] = none; }
    bool has(std::uint32_t vertex) const noexcept { return places_[vertex] != none; }
    std::uint32_t operator[](std::uint32_t vertex) const noexcept { return places_[vertex]; }

private:
    std::pmr::vector<std::uint32_t> places_;
};

// What find_consistent_depths() keeps from call to call.
struct ConsistentScratch {
    explicit ConsistentScratch(std::pmr::memory_resource* memory)
        : places(memory), queue(memory), normals(memory) {}

    VertexPlaces places;                   // empty between calls
    std::pmr::vector<std::uint32_t> queue; // of points
    Normals normals;

    auto buffers() { return std::tuple_cat(std::tie(places.buffer(), queue), normals.buffers()); }
};

// Sets the states of `points`, which are in the order of their vertices, and depth and direction of all that
// do not end as ENCLOSED or CROSSING. Throws what the memory throws.
void find_consistent_depths(const BodyPair& pair, std::span<Point> points, ConsistentScratch& scratch,
                            Counts& counts);

} // namespace vox::depth
