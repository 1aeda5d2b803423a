#include "mesh/vertex_links.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace vox {

namespace {

// True if the numbers ascend, in steps of 16 bits.
bool are_near(std::span<const std::uint32_t> numbers) noexcept {
    bool near = true;
    for (std::size_t i = 1; i < numbers.size(); ++i) near &= numbers[i] - numbers[i - 1] <= 0xffff;
    return near;
}

std::uint16_t* write32(std::uint32_t number, std::uint16_t* to) noexcept {
    std::memcpy(to, &number, sizeof number);
    return to + 2;
}

// All but the first.
std::uint16_t* write_differences(std::span<const std::uint32_t> numbers, bool wide,
                                 std::uint16_t* to) noexcept {
    for (std::size_t i = 1; i < numbers.size(); ++i) {
        const std::uint32_t difference = numbers[i] - numbers[i - 1];
        if (wide)
            to = write32(difference, to);
        else
            *to++ = static_cast<std::uint16_t>(difference);
    }
    return to;
}

} // namespace

std::size_t VertexLinks::length_of(std::uint32_t vertex) const noexcept {
    const Record record = this->record(vertex);
    return length(record.neighbour_count, record.ring_count, record.wide);
}

void VertexLinks::resize(std::size_t vertices) {
    if (words_.empty()) words_.push_back(0);
    places_.resize(vertices, 0);
}

void VertexLinks::assign(std::uint32_t vertex, std::span<const std::uint32_t> neighbours,
                         std::span<const std::uint32_t> ring) {
    const std::uint32_t first = neighbours.empty() ? 0 : neighbours[0] - vertex;
    const bool wide = neighbours.size() >= few || ring.size() >= few || first + 0x8000 > 0xffff ||
                      !are_near(neighbours) || !are_near(ring);
    const std::size_t needed = length(neighbours.size(), ring.size(), wide);
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

    std::uint16_t* next = words_.data() + place;
    const auto neighbour_count = static_cast<std::uint32_t>(neighbours.size());
    const auto ring_count = static_cast<std::uint32_t>(ring.size());
    if (wide) {
        *next++ = static_cast<std::uint16_t>(wide_record);
        next = write32(ring_count, write32(neighbour_count, next));
    } else {
        *next++ = static_cast<std::uint16_t>(ring_count << few_bits | neighbour_count);
    }
    if (!ring.empty()) next = write_differences(ring, wide, write32(ring[0], next));
    if (!neighbours.empty()) {
        if (wide)
            next = write32(neighbours[0], next);
        else
            *next++ = static_cast<std::uint16_t>(first);
        write_differences(neighbours, wide, next);
    }
    if (abandoned_ > words_.size() / 2 + 64) compact();
}

// Moves all records together.
void VertexLinks::compact() {
    Array<std::uint16_t> words(words_.memory());
    words.reserve(words_.size() - abandoned_);
    words.push_back(0);
    for (std::uint32_t v = 0; v < places_.size(); ++v) {
        if (places_[v] == 0) continue;
        const std::uint16_t* from = words_.data() + places_[v];
        const std::size_t length = length_of(v);
        places_[v] = static_cast<std::uint32_t>(words.size());
        words.insert(words.end(), from, from + length);
    }
    words_ = std::move(words);
    abandoned_ = 0;
}

} // namespace vox
