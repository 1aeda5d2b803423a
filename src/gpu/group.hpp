// One source for a GPU and the host. A group is 32 lanes in step: a warp on the GPU, a loop on the host. A
// kernel does what its lanes do in phases, each(): a lane never reads in a phase what another lane writes in
// it. Builds with VOX_GPU_CHECKS see when one does (PhaseCheck).
#pragma once

#include "base/device.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#if defined(__CUDACC__)
#include <cuda_runtime.h>
#endif

namespace vox::gpu {

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr u32 lanes = 32;

// A value of each lane: a register on the GPU.
template <class T>
struct PerLane {
#if defined(__CUDA_ARCH__)
    T value;
    VOX_HD T& operator[](u32) { return value; }
#else
    T value[lanes];
    T& operator[](u32 lane) { return value[lane]; }
#endif
};

VOX_HD u32 count_bits(u32 x) {
#if defined(__CUDA_ARCH__)
    return static_cast<u32>(__popc(x));
#else
    return static_cast<u32>(std::popcount(x));
#endif
}
VOX_HD u32 lowest_bit(u32 x) { // of a number that is not 0
#if defined(__CUDA_ARCH__)
    return static_cast<u32>(__ffs(static_cast<int>(x))) - 1;
#else
    return static_cast<u32>(std::countr_zero(x));
#endif
}
VOX_HD u32 below(u32 lane) { return (1u << lane) - 1; }

#if !defined(__CUDA_ARCH__)
// Who runs now on this thread: of host loops.
struct PhaseCheck {
    u32 lane = 0;
    u64 phase = 0;               // counts up; never 0 within a group
    const char* fault = nullptr; // the first one
};
inline thread_local PhaseCheck phase_check;
#endif

// An array that the lanes of a group share.
template <class T, u32 count>
class SharedArray {
public:
#if !defined(VOX_GPU_CHECKS)
    VOX_HD T operator[](u32 i) const { return items_[i]; }
    VOX_HD void set(u32 i, T value) { items_[i] = value; }

private:
    T items_[count];
#else
    T operator[](u32 i) const {
        if (i >= count) return check(false, "a shared array is read past its end"), T{};
        check(written_phase_[i] != 0, "what no lane has written is read");
        check(written_phase_[i] != phase_check.phase || written_by_[i] == phase_check.lane,
              "a lane reads what another one writes in the same phase");
        const bool again = read_phase_[i] == phase_check.phase;
        read_by_[i] = again && read_by_[i] != phase_check.lane ? lanes : phase_check.lane;
        read_phase_[i] = phase_check.phase;
        return items_[i];
    }
    void set(u32 i, T value) {
        if (i >= count) return check(false, "a shared array is written past its end");
        check(written_phase_[i] != phase_check.phase || written_by_[i] == phase_check.lane,
              "two lanes write to one place in the same phase");
        check(read_phase_[i] != phase_check.phase || read_by_[i] == phase_check.lane,
              "a lane writes what another one reads in the same phase");
        written_by_[i] = phase_check.lane;
        written_phase_[i] = phase_check.phase;
        items_[i] = value;
    }

private:
    static void check(bool holds, const char* fault) {
        if (!holds && !phase_check.fault) phase_check.fault = fault;
    }
    T items_[count];
    u32 written_by_[count] = {};
    u64 written_phase_[count] = {};
    mutable u32 read_by_[count] = {}; // `lanes`: several
    mutable u64 read_phase_[count] = {};
#endif
};

class Group {
public:
#if !defined(__CUDA_ARCH__)
    // Lanes run in the order (i * multiplier + offset) mod 32, for an odd multiplier.
    VOX_HD explicit Group(u32 multiplier = 1, u32 offset = 0) : multiplier_(multiplier), offset_(offset) {}
#endif

    // f(lane) for each lane.
    template <class F>
    VOX_HD void each(F&& f) const {
#if defined(__CUDA_ARCH__)
        f(threadIdx.x & (lanes - 1));
        __syncwarp();
#else
        ++phase_check.phase;
        for (u32 i = 0; i < lanes; ++i) {
            phase_check.lane = (i * multiplier_ + offset_) % lanes;
            f(phase_check.lane);
        }
#endif
    }
    // A bit for each lane.
    VOX_HD u32 ballot(PerLane<bool>& of) const {
#if defined(__CUDA_ARCH__)
        return __ballot_sync(~0u, of.value);
#else
        u32 mask = 0;
        for (u32 lane = 0; lane < lanes; ++lane) mask |= u32{of[lane]} << lane;
        return mask;
#endif
    }
    VOX_HD float lowest(PerLane<float>& of) const {
#if defined(__CUDA_ARCH__)
        float low = of.value;
        for (int d = 16; d; d >>= 1) {
            const float other = __shfl_xor_sync(~0u, low, d);
            low = other < low ? other : low;
        }
        return low;
#else
        float low = of[0];
        for (u32 lane = 1; lane < lanes; ++lane) low = of[lane] < low ? of[lane] : low;
        return low;
#endif
    }
    // The value of one lane, for all.
    VOX_HD u32 of_lane(PerLane<u32>& of, u32 lane) const {
#if defined(__CUDA_ARCH__)
        return __shfl_sync(~0u, of.value, static_cast<int>(lane));
#else
        return of[lane];
#endif
    }
    // What f() gives when it is called once.
    template <class F>
    VOX_HD u32 once(F&& f) const {
#if defined(__CUDA_ARCH__)
        u32 value = 0;
        if ((threadIdx.x & (lanes - 1)) == 0) value = f();
        return __shfl_sync(~0u, value, 0);
#else
        return f();
#endif
    }

private:
#if !defined(__CUDA_ARCH__)
    u32 multiplier_, offset_;
#endif
};

// Integers alone: the result does not depend on who comes first, or only decides a place in a list.
VOX_HD u32 atomic_add(u32* at, u32 n) {
#if defined(__CUDA_ARCH__)
    return atomicAdd(at, n);
#else
    return __atomic_fetch_add(at, n, __ATOMIC_RELAXED);
#endif
}
VOX_HD void atomic_or(u32* at, u32 bits) {
#if defined(__CUDA_ARCH__)
    atomicOr(at, bits);
#else
    __atomic_fetch_or(at, bits, __ATOMIC_RELAXED);
#endif
}
#if !defined(__CUDA_ARCH__)
template <class IsBetter>
VOX_HD void replace_while(u32* at, u32 value, const IsBetter& is_better) {
    u32 was = __atomic_load_n(at, __ATOMIC_RELAXED);
    while (is_better(value, was) &&
           !__atomic_compare_exchange_n(at, &was, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
}
#endif
VOX_HD void atomic_lowest(u32* at, u32 value) {
#if defined(__CUDA_ARCH__)
    atomicMin(at, value);
#else
    replace_while(at, value, [](u32 a, u32 b) { return a < b; });
#endif
}
VOX_HD void atomic_highest(u32* at, u32 value) {
#if defined(__CUDA_ARCH__)
    atomicMax(at, value);
#else
    replace_while(at, value, [](u32 a, u32 b) { return a > b; });
#endif
}

} // namespace vox::gpu
