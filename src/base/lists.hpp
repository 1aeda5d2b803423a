// Lists of numbers in one array (compressed rows), which may change. A list that outgrows its room moves to
// the end of the array and gets half as much again as it needs. When half of the array is abandoned, all
// lists are compacted. So the amortised cost of a change is proportional to the length of its list.
#pragma once

#include "base/array.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class IndexLists {
public:
    explicit IndexLists(std::pmr::memory_resource* memory) noexcept : rows_(memory), items_(memory) {}

    std::pmr::memory_resource* memory() const noexcept { return rows_.memory(); }
    bool empty() const noexcept { return rows_.empty(); }
    std::size_t size() const noexcept { return rows_.size(); }
    std::span<const std::uint32_t> operator[](std::size_t list) const noexcept {
        return {items_.data() + rows_[list].first, rows_[list].count};
    }
    std::span<std::uint32_t> operator[](std::size_t list) noexcept {
        return {items_.data() + rows_[list].first, rows_[list].count};
    }

    // Building. begin_list() begins the next list, and push() adds to it; earlier lists stay as they are.
    void reserve(std::size_t lists) { rows_.reserve(lists); }
    void begin_list() { rows_.push_back({items_.size(), 0, 0}); }
    void push(std::uint32_t value) {
        items_.push_back(value);
        rows_.back().room = ++rows_.back().count;
    }
    void shrink_to_fit() { items_.shrink_to_fit(); }

    // Makes for each vertex the list of the items that have it as a corner, ascending, by a counting sort.
    // corners_of(item) is a range without duplicates, which may be empty.
    template <class CornersOf>
    void list_by_vertex(std::uint32_t items, std::uint32_t vertex_count, CornersOf&& corners_of) {
        rows_.assign(vertex_count, Row{});
        abandoned_ = 0;
        for (std::uint32_t i = 0; i < items; ++i)
            for (const std::uint32_t v : corners_of(i)) ++rows_[v].room;
        std::uint64_t sum = 0;
        for (Row& row : rows_) {
            row.first = sum;
            sum += row.room;
        }
        items_.resize(static_cast<std::size_t>(sum));
        for (std::uint32_t i = 0; i < items; ++i)
            for (const std::uint32_t v : corners_of(i)) items_[rows_[v].first + rows_[v].count++] = i;
    }

    // Changes. One that throws (what the memory resource throws) changes nothing.
    // Adds empty lists at the end.
    void resize(std::size_t lists) { rows_.resize(lists); }
    // Inserts before the item at `place`.
    void insert(std::size_t list, std::size_t place, std::uint32_t value);
    void add(std::size_t list, std::uint32_t value) { insert(list, rows_[list].count, value); }
    void assign(std::size_t list, std::span<const std::uint32_t> values);
    // Removes the first item of that value, if there is one. The others keep their order.
    void remove(std::size_t list, std::uint32_t value) noexcept;

private:
    struct Row {
        std::uint64_t first = 0;
        std::uint32_t count = 0, room = 0;
    };

    void make_room(std::size_t list, std::uint32_t count);
    void compact(std::size_t list, std::uint32_t room);

    Array<Row> rows_;
    Array<std::uint32_t> items_;
    std::size_t abandoned_ = 0; // items that are not in the room of any list
};

} // namespace vox
