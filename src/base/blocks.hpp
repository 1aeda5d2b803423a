// A list in small blocks: items never move, and little memory is unused.
#pragma once

#include "base/array.hpp"
#include "base/room.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <new>
#include <utility>

namespace vox {

template <class T>
class Blocks {
public:
    explicit Blocks(std::pmr::memory_resource* memory) noexcept : blocks_(memory) {}

    std::pmr::memory_resource* memory() const noexcept { return blocks_.memory(); }
    std::size_t size() const noexcept { return size_; }
    T& operator[](std::size_t i) noexcept { return blocks_[i / block][i % block]; }
    const T& operator[](std::size_t i) const noexcept { return blocks_[i / block][i % block]; }

    // Makes room for `count` items in total. Throws what the memory throws.
    void reserve(std::uint64_t count) {
        if (count > blocks_.max_size()) throw std::bad_alloc();
        reserve_growing(blocks_, static_cast<std::size_t>((count + block - 1) / block));
        while (blocks_.size() * block < count) {
            Array<T> one(memory());
            one.reserve(block);
            blocks_.push_back(std::move(one));
        }
    }

    // If it throws what the memory throws, nothing has changed.
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        reserve(size_ + 1);
        T& added = blocks_[size_ / block].emplace_back(std::forward<Arguments>(arguments)...);
        ++size_;
        return added;
    }

private:
    static constexpr std::size_t block = 4;

    Array<Array<T>> blocks_;
    std::size_t size_ = 0;
};

} // namespace vox
