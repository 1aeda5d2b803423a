// The links of each vertex in one place: its neighbours over edges, and the triangles of the surface around
// it. Numbers ascend, so all but the first are stored as differences, in 16 bits if those of the vertex fit.
// An interior vertex takes about 35 bytes, mostly in one cache line.
#pragma once

#include "base/array.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory_resource>
#include <span>

namespace vox {

// A stored list of vertices or triangles, ascending.
class LinkRange {
public:
    class Iterator {
    public:
        using value_type = std::uint32_t;
        using difference_type = std::ptrdiff_t;
        using reference = std::uint32_t;
        using pointer = void;
        using iterator_category = std::forward_iterator_tag;

        std::uint32_t operator*() const noexcept { return number_; }
        Iterator& operator++() noexcept {
            if (--left_ == 0) return *this;
            if (wide_) {
                number_ += read<std::uint32_t>();
            } else {
                number_ += read<std::uint16_t>();
            }
            return *this;
        }
        Iterator operator++(int) noexcept {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        bool operator==(const Iterator& other) const noexcept { return left_ == other.left_; }

    private:
        friend class LinkRange;

        template <class Difference>
        Difference read() noexcept {
            Difference difference;
            std::memcpy(&difference, next_, sizeof difference);
            next_ += sizeof difference / sizeof *next_;
            return difference;
        }

        const std::uint16_t* next_ = nullptr;
        std::uint32_t left_ = 0, number_ = 0;
        bool wide_ = false;
    };

    LinkRange() = default;
    // `next` are the differences between `count` numbers, which begin with `first`.
    LinkRange(std::uint32_t first, const std::uint16_t* next, std::uint32_t count, bool wide) noexcept {
        first_.number_ = first;
        first_.next_ = next;
        first_.left_ = count;
        first_.wide_ = wide;
    }

    Iterator begin() const noexcept { return first_; }
    Iterator end() const noexcept { return {}; }
    std::size_t size() const noexcept { return first_.left_; }
    bool empty() const noexcept { return size() == 0; }

private:
    Iterator first_;
};

class VertexLinks {
public:
    explicit VertexLinks(std::pmr::memory_resource* memory) noexcept : places_(memory), words_(memory) {}

    std::size_t size() const noexcept { return places_.size(); } // vertices
    bool empty() const noexcept { return places_.empty(); }
    std::size_t bytes() const noexcept {
        return places_.capacity() * sizeof places_[0] + words_.capacity() * sizeof words_[0];
    }
    LinkRange neighbours(std::uint32_t vertex) const noexcept {
        const Record record = this->record(vertex);
        const std::uint16_t* words = record.ring + record.ring_length();
        if (record.neighbour_count == 0) return {};
        if (record.wide) return {read32(words), words + 2, record.neighbour_count, true};
        const auto first = static_cast<std::int16_t>(*words); // from the vertex on
        return {vertex + static_cast<std::uint32_t>(std::int32_t{first}), words + 1, record.neighbour_count,
                false};
    }
    LinkRange ring(std::uint32_t vertex) const noexcept {
        const Record record = this->record(vertex);
        if (record.ring_count == 0) return {};
        return {read32(record.ring), record.ring + 2, record.ring_count, record.wide};
    }

    // Addresses to prefetch for a vertex; the first one some time before the second.
    const void* place_of(std::uint32_t vertex) const noexcept { return places_.data() + vertex; }
    const void* record_of(std::uint32_t vertex) const noexcept { return words_.data() + places_[vertex]; }

    // Changes. One that throws what the memory throws, or LIMIT if 2^32 words are not enough, has changed
    // nothing. Sets the number of vertices; new ones have neither neighbours nor triangles.
    void resize(std::size_t vertices);
    void reserve(std::size_t words) { words_.reserve(words); } // 16 bits each
    void shrink_to_fit() { words_.shrink_to_fit(); }
    // `neighbours` ascend. A ring that ascends, too, takes the least room.
    void assign(std::uint32_t vertex, std::span<const std::uint32_t> neighbours,
                std::span<const std::uint32_t> ring);

private:
    // A record begins with a word: 7 bits for the number of neighbours, 7 for that of triangles. The ring and
    // the neighbours follow, each as its first number and the differences between the others. The first
    // neighbour is a difference, too, from the vertex. If this does not fit, the first word is the bit for
    // wide records, and all that follows has 32 bits: the two numbers, the ring and the neighbours, with
    // differences modulo 2^32.
    static constexpr std::uint32_t wide_record = 0x8000u, few_bits = 7, few = 1u << few_bits;

    struct Record {
        const std::uint16_t* ring;
        std::uint32_t neighbour_count, ring_count;
        bool wide;

        std::size_t ring_length() const noexcept { return vox::VertexLinks::ring_length(ring_count, wide); }
    };
    // The length in words.
    static std::size_t ring_length(std::uint32_t count, bool wide) noexcept {
        return count == 0 ? 0 : wide ? 2 * std::size_t{count} : std::size_t{count} + 1;
    }
    static std::size_t length(std::size_t neighbours, std::size_t ring, bool wide) noexcept {
        return wide ? 5 + 2 * (neighbours + ring)
                    : 1 + neighbours + ring_length(static_cast<std::uint32_t>(ring), false);
    }

    static std::uint32_t read32(const std::uint16_t* words) noexcept {
        std::uint32_t number;
        std::memcpy(&number, words, sizeof number);
        return number;
    }
    Record record(std::uint32_t vertex) const noexcept {
        const std::uint16_t* words = words_.data() + places_[vertex];
        if (*words == wide_record) return {words + 5, read32(words + 1), read32(words + 3), true};
        return {words + 1, *words & (few - 1), std::uint32_t{*words} >> few_bits, false};
    }
    std::size_t length_of(std::uint32_t vertex) const noexcept;
    void compact();

    Array<std::uint32_t> places_; // for each vertex, where its record begins in words_
    Array<std::uint16_t> words_;  // the first record serves all vertices without links
    std::size_t abandoned_ = 0;   // words in no record
};

} // namespace vox
