#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

// The highest number of a list; 0 if it is empty.
std::uint32_t highest_index(const std::uint32_t* list, std::size_t count) noexcept;

} // namespace vox
