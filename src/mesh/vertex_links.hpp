// What the topology knows of each vertex: its neighbours over edges, and the triangles of the surface around
// it, in one place. Neighbours ascend, so all but the first are stored as differences, in 16 bits where those
// of a vertex fit. A vertex takes about 40 bytes, mostly in one cache line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Vertices in ascending order, as they are stored.
class NeighbourRange {
public:
    class Iterator {
    public:
        using value_type = std::uint32_t;
        using difference_type = std::ptrdiff_t;
        using reference = std::uint32_t;
        using pointer = void;
        using iterator_category = std::forward_iterator_tag;

        std::uint32_t operator*() const noexcept { return vertex_; }
        Iterator& operator++() noexcept {
            if (--left_ == 0) return *this;
            if (wide_) {
                vertex_ += read<std::uint32_t>();
            } else {
                vertex_ += read<std::uint16_t>();
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
        friend class NeighbourRange;

        template <class Difference>
        Difference read() noexcept {
            Difference difference;
            std::memcpy(&difference, next_, sizeof difference);
            next_ += sizeof difference;
            return difference;
        }

        const std::byte* next_ = nullptr;
        std::uint32_t left_ = 0, vertex_ = 0;
        bool wide_ = false;
    };

    NeighbourRange() = default;
    // `words` is the first vertex and what follows it.
    NeighbourRange(const std::uint32_t* words, std::uint32_t count, bool wide) noexcept {
        if (count == 0) return;
        first_.vertex_ = *words;
        first_.next_ = reinterpret_cast<const std::byte*>(words + 1);
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
    std::size_t capacity() const noexcept { return places_.capacity() + words_.capacity(); }
    NeighbourRange neighbours(std::uint32_t vertex) const noexcept {
        const Record record = this->record(vertex);
        return {record.ring + record.ring_count, record.neighbour_count, record.wide};
    }
    std::span<const std::uint32_t> ring(std::uint32_t vertex) const noexcept {
        const Record record = this->record(vertex);
        return {record.ring, record.ring_count};
    }
    std::span<std::uint32_t> ring(std::uint32_t vertex) noexcept {
        const Record record = this->record(vertex);
        return {words_.data() + (record.ring - words_.data()), record.ring_count};
    }

    // For a vertex that is looked at soon, the first some time before the second.
    const void* place_of(std::uint32_t vertex) const noexcept { return places_.data() + vertex; }
    const void* record_of(std::uint32_t vertex) const noexcept { return words_.data() + places_[vertex]; }

    // Each throws what the memory throws, and Error(LIMIT) where 2^32 words are not enough, and changes
    // nothing then.
    // Sets the number of vertices; new ones have neither neighbours nor triangles.
    void resize(std::size_t vertices);
    void reserve(std::size_t words) { words_.reserve(words); }
    void shrink_to_fit() { words_.shrink_to_fit(); }
    // `neighbours` ascend.
    void assign(std::uint32_t vertex, std::span<const std::uint32_t> neighbours,
                std::span<const std::uint32_t> ring);

private:
    // A record is a word with the counts and the kind of differences, or three words where the counts are
    // large. Then come the ring, the first neighbour, and the differences between neighbours.
    static constexpr std::uint32_t long_record = 0xffffffffu, wide_bit = 0x80000000u;
    static constexpr std::uint32_t few_neighbours = 0x7fff, few_triangles = 0xffff; // less than that

    struct Record {
        const std::uint32_t* ring;
        std::uint32_t neighbour_count, ring_count;
        bool wide;
    };

    Record record(std::uint32_t vertex) const noexcept {
        const std::uint32_t* words = words_.data() + places_[vertex];
        if (*words == long_record) return {words + 3, words[1], words[2], true};
        return {words + 1, *words >> 16 & few_neighbours, *words & few_triangles, (*words & wide_bit) != 0};
    }
    static std::size_t length(std::size_t neighbours, std::size_t ring, bool is_long, bool wide) noexcept;
    std::size_t length_of(std::uint32_t vertex) const noexcept;
    void compact();

    std::pmr::vector<std::uint32_t> places_; // of each vertex, where its record begins in words_
    std::pmr::vector<std::uint32_t> words_;  // the first record is that of all vertices without links
    std::size_t abandoned_ = 0;              // words that are in no record
};

} // namespace vox
