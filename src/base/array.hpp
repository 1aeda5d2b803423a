// A growing array whose memory comes from a resource: the part of std::pmr::vector that this library needs,
// with half as many functions to compile. What both have is named and behaves alike. The differences:
//
// - One function moves bytes for all element types, and iterators are pointers.
// - The memory resource is always given: there is no default constructor and no copy constructor without it.
// - Moving an element throws nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <memory_resource>
#include <new>
#include <type_traits>
#include <utility>

#if defined(_GLIBCXX_ASSERTIONS)
#define VOX_ASSERT_INSIDE(condition) __glibcxx_assert(condition)
#else
#define VOX_ASSERT_INSIDE(condition) ((void)0)
#endif

namespace vox {

// Allocates `wanted` bytes, moves the first `used` of the `room` bytes at `data` there, and releases these.
// Returns null for no bytes. If it throws what the resource throws, nothing has changed.
inline void* move_bytes(std::pmr::memory_resource* memory, void* data, std::size_t used, std::size_t room,
                        std::size_t wanted, std::size_t alignment) {
    void* made = wanted ? memory->allocate(wanted, alignment) : nullptr;
    if (used) std::memcpy(made, data, used);
    if (data) memory->deallocate(data, room, alignment);
    return made;
}

template <class T>
class Array {
    static_assert(std::is_nothrow_move_constructible_v<T>);

public:
    using value_type = T;

    explicit Array(std::pmr::memory_resource* memory) noexcept : memory_(memory) {}
    Array(std::size_t count, std::pmr::memory_resource* memory) : Array(memory) { resize(count); }
    Array(std::size_t count, const T& value, std::pmr::memory_resource* memory) : Array(memory) {
        resize(count, value);
    }
    template <std::forward_iterator Iterator>
    Array(Iterator first, Iterator last, std::pmr::memory_resource* memory) : Array(memory) {
        append(first, last);
    }
    Array(std::initializer_list<T> items, std::pmr::memory_resource* memory)
        : Array(items.begin(), items.end(), memory) {}
    Array(const Array& other, std::pmr::memory_resource* memory)
        : Array(other.begin(), other.end(), memory) {}
    Array(Array&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)),
          room_(std::exchange(other.room_, 0)), memory_(other.memory_) {}
    ~Array() { release(); }

    // Assignment keeps the memory resource of the left side.
    Array& operator=(const Array& other) {
        if (this != &other) assign(other.begin(), other.end());
        return *this;
    }
    Array& operator=(Array&& other) {
        if (this == &other) return *this;
        if (memory_ != other.memory_) {
            clear();
            reserve(other.size_);
            for (T& item : other) emplace_back(std::move(item));
            return *this;
        }
        release();
        data_ = std::exchange(other.data_, nullptr);
        size_ = std::exchange(other.size_, 0);
        room_ = std::exchange(other.room_, 0);
        return *this;
    }
    // Both must have the same memory resource.
    void swap(Array& other) noexcept {
        VOX_ASSERT_INSIDE(memory_ == other.memory_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(room_, other.room_);
    }

    std::pmr::memory_resource* memory() const noexcept { return memory_; }
    std::size_t size() const noexcept { return size_; }
    std::size_t capacity() const noexcept { return room_; }
    static constexpr std::size_t max_size() noexcept { return PTRDIFF_MAX / sizeof(T); }
    bool empty() const noexcept { return size_ == 0; }

    T* data() noexcept { return data_; }
    const T* data() const noexcept { return data_; }
    T* begin() noexcept { return data_; }
    T* end() noexcept { return data_ + size_; }
    const T* begin() const noexcept { return data_; }
    const T* end() const noexcept { return data_ + size_; }
    auto rbegin() noexcept { return std::reverse_iterator(end()); }
    auto rend() noexcept { return std::reverse_iterator(begin()); }
    T& operator[](std::size_t i) noexcept {
        VOX_ASSERT_INSIDE(i < size_);
        return data_[i];
    }
    const T& operator[](std::size_t i) const noexcept {
        VOX_ASSERT_INSIDE(i < size_);
        return data_[i];
    }
    T& front() noexcept { return (*this)[0]; }
    const T& front() const noexcept { return (*this)[0]; }
    T& back() noexcept { return (*this)[size_ - 1]; }
    const T& back() const noexcept { return (*this)[size_ - 1]; }

    // If a function that makes room throws what the resource throws, nothing has changed.
    void reserve(std::size_t count) {
        if (count > room_) move_to(count);
    }
    // Keeps its room if there is no memory to move to.
    void shrink_to_fit() noexcept {
        try {
            if (size_ < room_) move_to(size_);
        } catch (...) {
        }
    }
    void resize(std::size_t count) {
        make_room(count);
        for (; size_ < count; ++size_) ::new (static_cast<void*>(data_ + size_)) T();
        truncate(count);
    }
    void resize(std::size_t count, const T& value) {
        if (count > size_) {
            const T copy = value; // which may lie in this array
            make_room(count);
            for (; size_ < count; ++size_) ::new (static_cast<void*>(data_ + size_)) T(copy);
        }
        truncate(count);
    }
    void assign(std::size_t count, const T& value) {
        const T copy = value;
        make_room_without_moving(count);
        resize(count, copy);
    }
    // The items must not be in this array.
    template <std::forward_iterator Iterator>
    void assign(Iterator first, Iterator last) {
        make_room_without_moving(static_cast<std::size_t>(std::distance(first, last)));
        append(first, last);
    }
    void push_back(const T& value) { emplace_back(value); }
    void push_back(T&& value) { emplace_back(std::move(value)); }
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        if (size_ == room_) [[unlikely]]
            return emplace_growing(std::forward<Arguments>(arguments)...);
        ::new (static_cast<void*>(data_ + size_)) T(std::forward<Arguments>(arguments)...);
        return data_[size_++];
    }
    // Insert before `place`. The items of a range must not be in this array.
    T* insert(const T* place, const T& value) {
        const std::size_t at = static_cast<std::size_t>(place - data_);
        emplace_back(value);
        return rotate_to(at, 1);
    }
    T* insert(const T* place, T&& value) {
        const std::size_t at = static_cast<std::size_t>(place - data_);
        emplace_back(std::move(value));
        return rotate_to(at, 1);
    }
    template <std::forward_iterator Iterator>
    T* insert(const T* place, Iterator first, Iterator last) {
        const std::size_t at = static_cast<std::size_t>(place - data_), before = size_;
        append(first, last);
        return rotate_to(at, size_ - before);
    }

    void clear() noexcept { truncate(0); }
    void pop_back() noexcept {
        VOX_ASSERT_INSIDE(size_ > 0);
        truncate(size_ - 1);
    }
    T* erase(const T* place) noexcept { return erase(place, place + 1); }
    T* erase(const T* first, const T* last) noexcept {
        T* to = data_ + (first - data_);
        if (first != last)
            truncate(static_cast<std::size_t>(std::move(data_ + (last - data_), end(), to) - data_));
        return to;
    }

    friend bool operator==(const Array& a, const Array& b) {
        return a.size_ == b.size_ && std::equal(a.begin(), a.end(), b.begin());
    }

private:
    void truncate(std::size_t count) noexcept {
        if constexpr (!std::is_trivially_destructible_v<T>)
            for (std::size_t i = count; i < size_; ++i) data_[i].~T();
        if (count < size_) size_ = count;
    }
    void release() noexcept {
        clear();
        if (data_) memory_->deallocate(data_, room_ * sizeof(T), alignof(T));
    }
    // Room is at least doubled, so that n additions move O(n) elements.
    std::size_t grown(std::size_t count) const noexcept {
        return std::max(count, room_ <= max_size() / 2 ? 2 * room_ : max_size());
    }
    void make_room(std::size_t count) {
        if (count > room_) move_to(grown(count));
    }
    // The arguments may lie in this array.
    template <class... Arguments>
    T& emplace_growing(Arguments&&... arguments) {
        if constexpr (std::is_trivially_copyable_v<T>) {
            const T made(std::forward<Arguments>(arguments)...);
            make_room(size_ + 1);
            ::new (static_cast<void*>(data_ + size_)) T(made);
        } else {
            Array larger(memory_);
            larger.move_to(grown(size_ + 1));
            ::new (static_cast<void*>(larger.data_ + size_)) T(std::forward<Arguments>(arguments)...);
            for (T& item : *this)
                ::new (static_cast<void*>(larger.data_ + larger.size_++)) T(std::move(item));
            swap(larger);
        }
        return data_[size_++];
    }
    // Allocates before it releases, so that a failure changes nothing.
    void make_room_without_moving(std::size_t count) {
        if (count > room_) {
            Array made(memory_);
            made.move_to(count);
            swap(made);
        }
        clear();
    }
    void move_to(std::size_t count) {
        if (count > max_size()) throw std::bad_alloc();
        if constexpr (std::is_trivially_copyable_v<T>) {
            data_ = static_cast<T*>(move_bytes(memory_, data_, size_ * sizeof(T), room_ * sizeof(T),
                                               count * sizeof(T), alignof(T)));
        } else {
            T* made = count ? static_cast<T*>(memory_->allocate(count * sizeof(T), alignof(T))) : nullptr;
            for (std::size_t i = 0; i < size_; ++i) {
                ::new (static_cast<void*>(made + i)) T(std::move(data_[i]));
                data_[i].~T();
            }
            if (data_) memory_->deallocate(data_, room_ * sizeof(T), alignof(T));
            data_ = made;
        }
        room_ = count;
    }
    template <class Iterator>
    void append(Iterator first, Iterator last) {
        make_room(size_ + static_cast<std::size_t>(std::distance(first, last)));
        for (; first != last; ++first, ++size_) ::new (static_cast<void*>(data_ + size_)) T(*first);
    }
    // Moves the last `count` elements to `at`.
    T* rotate_to(std::size_t at, std::size_t count) {
        std::rotate(data_ + at, end() - count, end());
        return data_ + at;
    }

    T* data_ = nullptr;
    std::size_t size_ = 0, room_ = 0;
    std::pmr::memory_resource* memory_;
};

template <class T, class Predicate>
std::size_t erase_if(Array<T>& array, Predicate predicate) {
    T* left = std::remove_if(array.begin(), array.end(), predicate);
    const auto erased = static_cast<std::size_t>(array.end() - left);
    array.erase(left, array.end());
    return erased;
}

template <class T>
std::size_t erase(Array<T>& array, const T& value) {
    return erase_if(array, [&](const T& item) { return item == value; });
}

} // namespace vox
