// Reserves room in vectors, before code that must not fail.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>

namespace vox {

// Makes room for exactly `count` elements in total.
template <class Vector>
void reserve_exactly(Vector& vector, std::uint64_t count) {
    if (count > vector.max_size()) throw std::bad_alloc();
    if (count > vector.capacity()) vector.reserve(static_cast<std::size_t>(count));
}

// Grows by half at least, so that n additions copy O(n) elements.
template <class Vector>
void reserve_growing(Vector& vector, std::size_t count) {
    if (count > vector.capacity()) vector.reserve(std::max(count, vector.capacity() + vector.capacity() / 2));
}

// Grows by a quarter: for long lists, of which twice the room would stay allocated.
template <class Vector>
void reserve_sparingly(Vector& vector, std::size_t count) {
    if (count > vector.capacity()) vector.reserve(count + count / 4);
}

} // namespace vox
