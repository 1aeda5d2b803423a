// Asks for a cache line ahead of its use.
#pragma once

namespace vox {

// Does nothing if the compiler has no such function.
inline void prefetch([[maybe_unused]] const void* line) noexcept {
#ifdef __GNUC__
    __builtin_prefetch(line);
    // gcc considers a function that only prefetches free of effects, and drops calls of it unless they are
    // inlined early. The empty statement is an effect.
    asm volatile("");
#endif
}

} // namespace vox
