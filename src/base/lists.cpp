#include "base/lists.hpp"

#include <utility>

namespace vox {

// Makes room for `count` items in a list, which may move it.
void IndexLists::make_room(std::size_t list, std::uint32_t count) {
    Row& row = rows_[list];
    if (count <= row.room) return;
    const std::uint32_t room = std::max(count + count / 2, 4u);
    if (abandoned_ + row.room > items_.size() / 2 + 64) return compact(list, room);
    const std::size_t first = items_.size();
    items_.resize(first + room);
    std::copy_n(items_.begin() + static_cast<std::ptrdiff_t>(row.first), row.count,
                items_.begin() + static_cast<std::ptrdiff_t>(first));
    abandoned_ += row.room;
    row.first = first;
    row.room = room;
}

// Moves all lists together. Each keeps its room, except that `list` gets the given one.
void IndexLists::compact(std::size_t list, std::uint32_t room) {
    std::size_t size = room;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (i != list) size += rows_[i].room;
    Array<std::uint32_t> items(size, memory());
    rows_[list].room = room;
    std::size_t next = 0;
    for (Row& row : rows_) {
        std::copy_n(items_.begin() + static_cast<std::ptrdiff_t>(row.first), row.count,
                    items.begin() + static_cast<std::ptrdiff_t>(next));
        row.first = next;
        next += row.room;
    }
    items_ = std::move(items);
    abandoned_ = 0;
}

void IndexLists::insert(std::size_t list, std::size_t place, std::uint32_t value) {
    make_room(list, rows_[list].count + 1);
    ++rows_[list].count;
    const std::span<std::uint32_t> items = (*this)[list];
    std::copy_backward(items.begin() + static_cast<std::ptrdiff_t>(place), items.end() - 1, items.end());
    items[place] = value;
}

void IndexLists::assign(std::size_t list, std::span<const std::uint32_t> values) {
    make_room(list, static_cast<std::uint32_t>(values.size()));
    rows_[list].count = static_cast<std::uint32_t>(values.size());
    std::copy(values.begin(), values.end(), (*this)[list].begin());
}

void IndexLists::remove(std::size_t list, std::uint32_t value) noexcept {
    const std::span<std::uint32_t> items = (*this)[list];
    const auto found = std::find(items.begin(), items.end(), value);
    if (found == items.end()) return;
    std::copy(found + 1, items.end(), found);
    --rows_[list].count;
}

} // namespace vox
