#include "mesh/vertex_links.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace vox {

std::size_t VertexLinks::length(std::size_t neighbours, std::size_t ring, bool is_long, bool wide) noexcept {
    const std::size_t differences = neighbours == 0 ? 0 : neighbours - 1;
    return (is_long ? 3 : 1) + ring + (neighbours > 0) + (wide ? differences : (differences + 1) / 2);
}

std::size_t VertexLinks::length_of(std::uint32_t vertex) const noexcept {
    const Record record = this->record(vertex);
    return length(record.neighbour_count, record.ring_count, words_[places_[vertex]] == long_record,
                  record.wide);
}

void VertexLinks::resize(std::size_t vertices) {
    if (words_.empty()) words_.push_back(0);
    places_.resize(vertices, 0);
}

void VertexLinks::assign(std::uint32_t vertex, std::span<const std::uint32_t> neighbours,
                         std::span<const std::uint32_t> ring) {
    const bool is_long = neighbours.size() >= few_neighbours || ring.size() >= few_triangles;
    bool wide = is_long;
    for (std::size_t i = 1; i < neighbours.size(); ++i) wide |= neighbours[i] - neighbours[i - 1] > 0xffff;
    const std::size_t needed = length(neighbours.size(), ring.size(), is_long, wide);
    const std::size_t room = places_[vertex] == 0 ? 0 : length_of(vertex);
    std::size_t place = places_[vertex];
    if (needed > room) {
        place = words_.size();
        if (place > UINT32_MAX)
            throw Error(VOX_ERROR_LIMIT, "the mesh has too many vertices and edges for penetrations");
        words_.resize(place + needed);
        places_[vertex] = static_cast<std::uint32_t>(place);
        abandoned_ += room;
    } else {
        abandoned_ += room - needed;
    }

    std::uint32_t* next = words_.data() + place;
    const auto neighbour_count = static_cast<std::uint32_t>(neighbours.size());
    const auto ring_count = static_cast<std::uint32_t>(ring.size());
    if (is_long) {
        for (const std::uint32_t word : {long_record, neighbour_count, ring_count}) *next++ = word;
    } else {
        *next++ = (wide ? wide_bit : 0) | neighbour_count << 16 | ring_count;
    }
    next = std::copy(ring.begin(), ring.end(), next);
    if (!neighbours.empty()) *next++ = neighbours.front();
    auto* bytes = reinterpret_cast<std::byte*>(next);
    for (std::size_t i = 1; i < neighbours.size(); ++i) {
        const std::uint32_t difference = neighbours[i] - neighbours[i - 1];
        const auto half = static_cast<std::uint16_t>(difference);
        if (wide)
            std::memcpy(bytes + 4 * (i - 1), &difference, sizeof difference);
        else
            std::memcpy(bytes + 2 * (i - 1), &half, sizeof half);
    }
    if (abandoned_ > words_.size() / 2 + 64) compact();
}

// Moves all records together.
void VertexLinks::compact() {
    std::pmr::vector<std::uint32_t> words(words_.get_allocator());
    words.reserve(words_.size() - abandoned_);
    words.push_back(0);
    for (std::uint32_t v = 0; v < places_.size(); ++v) {
        if (places_[v] == 0) continue;
        const std::uint32_t* from = words_.data() + places_[v];
        const std::size_t length = length_of(v);
        places_[v] = static_cast<std::uint32_t>(words.size());
        words.insert(words.end(), from, from + length);
    }
    words_ = std::move(words);
    abandoned_ = 0;
}

} // namespace vox
