// A C++ heap that counts and fails at a chosen allocation. failing_heap.cpp puts it in the place of a
// program's own, that of the libraries that the program links, too.
#pragma once

#include "support/suite.h"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace heap {

inline std::atomic<std::uint64_t> calls{0};   // to allocate, since it was last set to 0; failed ones included
inline std::atomic<std::uint64_t> fail_at{0}; // the one of these calls that fails; 0: none
inline std::atomic<bool> fail_on{false};      // whether all later ones fail, too
inline std::atomic<std::int64_t> held{0};     // blocks

inline void* take(std::size_t size, std::size_t alignment) noexcept {
    const std::uint64_t call = ++calls, fails = fail_at;
    if (fails != 0 && (call == fails || (fail_on && call > fails))) return nullptr;
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size ? size : 1) != 0)
        return nullptr;
    ++held;
    return memory;
}
inline void* take_or_throw(std::size_t size, std::size_t alignment) {
    void* memory = take(size, alignment);
    if (!memory) throw std::bad_alloc();
    return memory;
}
inline void give(void* memory) noexcept {
    held -= memory != nullptr;
    std::free(memory);
}

// The program's life, a function that makes calls through a Life& and releases all it has.
class Life {
public:
    // Makes a call again if it runs out of memory, unless the heap goes on failing. Returns whether it
    // succeeded.
    template <class Call>
    bool operator()(Call&& call) {
        vox_result result = call();
        if (result == VOX_ERROR_OUT_OF_MEMORY && fail_at != 0) {
            failed = true;
            if (fail_on) return false;
            fail_at = 0;
            result = call();
        }
        ck_assert_msg(result == VOX_OK, "allocation %d: %s (%s)", int(n), vox_result_string(result),
                      vox_last_error());
        return true;
    }

    std::uint64_t n = 0;    // the allocation that fails
    bool failed = false;    // whether a call did
    std::uint64_t hash = 0; // what the life found; set at its end
};

// Lives once with a sound heap, then with each n-th allocation failing (in steps of `stride`), once alone and
// once with all that follow. Each call fails with OUT_OF_MEMORY or succeeds, a call made again succeeds, the
// life finds the same, and nothing is left behind.
template <class Function>
void fail_each(Function&& function, std::uint64_t stride = 1) {
    Life sound;
    function(sound); // what is made once a process
    calls = 0;
    const std::int64_t before = held;
    function(sound);
    ck_assert_int_eq(held, before);
    const std::uint64_t all = calls;
    std::uint64_t failures = 0;
    for (const bool on : {false, true})
        for (std::uint64_t n = 1; n <= all; n += stride) {
            Life life;
            life.n = n;
            fail_on = on;
            calls = 0;
            fail_at = n;
            function(life);
            fail_at = 0;
            failures += life.failed;
            if (!on) ck_assert_uint_eq(life.hash, sound.hash);
            ck_assert_msg(held == before, "allocation %d: %d blocks are left", int(n), int(held - before));
        }
    ck_assert_uint_gt(all, 10);
    ck_assert_uint_gt(failures, all / stride); // half of all failures are seen, at least
}

} // namespace heap
