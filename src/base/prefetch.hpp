// Asks for a cache line ahead of its use.
#pragma once

#include <hwy/cache_control.h>

namespace vox {

// As hwy::Prefetch. But gcc takes a function that only prefetches for one without effect and drops calls of
// it unless they are inlined early; the empty statement is an effect.
inline void prefetch(const void* line) noexcept {
    hwy::Prefetch(static_cast<const char*>(line));
#ifdef __GNUC__
    asm volatile("");
#endif
}

} // namespace vox
