// Asks for a cache line ahead of its use.
#pragma once

namespace vox {

// Does nothing where compilers have no word for it.
inline void prefetch([[maybe_unused]] const void* line) noexcept {
#ifdef __GNUC__
    __builtin_prefetch(line);
    // gcc takes a function that only prefetches for one without effect, and drops calls of it unless they are
    // inlined early. The empty statement is an effect.
    asm volatile("");
#endif
}

} // namespace vox
