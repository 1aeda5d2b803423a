// Integers as the types that printf's %llu and %lld take, whatever type 64 bits have on the platform.
#pragma once

#include <cstdint>

namespace vox {

inline unsigned long long llu(std::uint64_t number) noexcept { return number; }
inline long long lld(std::int64_t number) noexcept { return number; }

} // namespace vox
