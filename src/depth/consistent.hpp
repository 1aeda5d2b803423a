// Consistent penetration depths of the colliding vertices of one body in another.
#pragma once

#include "base/array.hpp"
#include "base/bits.hpp"
#include "depth/normals.hpp"
#include "depth/penetrations.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox::depth {

// The colliding vertices of a pair of bodies: those of body a in tetrahedra of body b. A point is such a
// vertex, and what is known of it is its penetration.
struct BodyPair {
    const Topology* topology_a;
    Positions positions_a;
    std::uint32_t vertex_count_a;
    Solid b;
    bool self;
    std::span<const std::uint32_t> places; // of their penetrations, in the order of vertices
};

struct Counts {
    std::uint64_t leaving_edges = 0, edge_tests = 0, closest_tests = 0; // as in Counters
};

// The colliding vertices of a body: for each the place of its penetration, and the wave in which depth and
// direction were found, by the number of the vertex.
class WaveTable {
public:
    explicit WaveTable(std::pmr::memory_resource* memory) : entries_(memory) {}

    struct Entry {
        std::uint32_t wave = absent, place = 0;
    };
    static constexpr std::uint32_t absent = 0xffffffffu; // the wave of a vertex that does not collide

    auto& buffer() noexcept { return entries_; }
    // Makes room for vertices below `vertex_count`. Throws what the memory throws.
    void reserve(std::size_t vertex_count) {
        if (entries_.size() < vertex_count) entries_.resize(vertex_count);
    }
    void add(std::uint32_t vertex, std::uint32_t wave, std::uint32_t place) noexcept {
        entries_[vertex] = {wave, place};
    }
    void remove(std::uint32_t vertex) noexcept { entries_[vertex].wave = absent; }
    const Entry& operator[](std::uint32_t vertex) const noexcept { return entries_[vertex]; }
    void set_wave(std::uint32_t vertex, std::uint32_t wave) noexcept { entries_[vertex].wave = wave; }

private:
    Array<Entry> entries_;
};

// What find_consistent_depths() keeps from call to call.
struct ConsistentScratch {
    explicit ConsistentScratch(std::pmr::memory_resource* memory) : waves(memory), normals(memory) {}

    WaveTable waves; // empty between calls
    Normals normals; // of body b: begin() is the caller's, as several bodies may be inside one

    auto buffers() { return std::tuple_cat(std::tie(waves.buffer()), normals.buffers()); }
};

// Sets the states of the pair's penetrations, which begin() made, and depth and direction of all but those
// that need a closest point: ENCLOSED ones, and CROSSING ones to which no edge helps
// (Depth::has_answer). `queue` is as long as pair.places, and is written to. Throws what the memory throws.
// `hits` are those that the penetrations are of.
void find_consistent_depths(const BodyPair& pair, std::span<const Hit> hits, Penetrations& penetrations,
                            std::span<std::uint32_t> queue, ConsistentScratch& scratch, Counts& counts);

} // namespace vox::depth
