// The floating-point environment: how results are rounded, whether denormals count as zero, what traps.
// Programs change it (games, audio, -ffast-math). The library computes in the default environment and
// restores the program's, flags included.
//
// A compiler may move arithmetic across a change of the environment. So code that computes is called, not
// inlined, while a DefaultFloats exists (border.hpp, parallel.cpp).
#pragma once

#include <cstdint>
#include <utility>

#if !(defined(__GNUC__) && (defined(__x86_64__) || defined(__aarch64__)))
#include <cfenv>
#endif

namespace vox {

#if defined(__GNUC__) && defined(__x86_64__)

// MXCSR and the control word of the x87, in which C libraries look up the rounding mode. MinGW-w64's C
// library also computes with the x87, so ldexp and log2 raise its flags; elsewhere only long double does,
// which vox does not use.
struct FloatEnvironment {
    std::uint32_t mxcsr = 0x1f80; // the defaults: to nearest, with denormals, no traps, no flags
    std::uint16_t x87_control = 0x037f, x87_flags = 0;

    static FloatEnvironment of_thread() noexcept {
        FloatEnvironment e;
        asm volatile("stmxcsr %0\n\tfnstcw %1" : "=m"(e.mxcsr), "=m"(e.x87_control) : : "memory");
        if constexpr (x87_computes) e.x87_flags = flags_of_x87();
        return e;
    }
    void set() const noexcept { // ten times as fast as reading
        if constexpr (x87_computes) {
            if (flags_of_x87() != x87_flags) set_flags_of_x87(x87_flags); // while they do not trap
        }
        set_control();
    }
    static void set_default() noexcept {
        FloatEnvironment{}.set_control();
    } // flags of the x87 can stay: none traps now

private:
#if defined(_WIN32)
    static constexpr bool x87_computes = true;
#else
    static constexpr bool x87_computes = false; // reading its flags costs as much as all else here
#endif

    void set_control() const noexcept {
        asm volatile("ldmxcsr %0\n\tfldcw %1" : : "m"(mxcsr), "m"(x87_control) : "memory");
    }
    static std::uint16_t flags_of_x87() noexcept {
        std::uint16_t status;
        asm volatile("fnstsw %0" : "=a"(status) : : "memory");
        return status & 0x7f;
    }
    static void set_flags_of_x87(std::uint16_t flags) noexcept {
        std::uint16_t environment[14]; // the third is the status
        asm volatile("fnstenv %0" : "=m"(environment) : : "memory");
        environment[2] = static_cast<std::uint16_t>((environment[2] & ~0xff) | flags);
        asm volatile("fldenv %0" : : "m"(environment) : "memory");
    }
};

#elif defined(__GNUC__) && defined(__aarch64__)

// FPCR, and FPSR with the flags.
struct FloatEnvironment {
    std::uint64_t control = 0, status = 0;

    static FloatEnvironment of_thread() noexcept {
        FloatEnvironment e;
        asm volatile("mrs %0, fpcr\n\tmrs %1, fpsr" : "=r"(e.control), "=r"(e.status) : : "memory");
        return e;
    }
    void set() const noexcept { // only what differs: writing takes longer than reading
        const FloatEnvironment now = of_thread();
        if (now.control != control) asm volatile("msr fpcr, %0" : : "r"(control) : "memory");
        if (now.status != status) asm volatile("msr fpsr, %0" : : "r"(status) : "memory");
    }
    static void set_default() noexcept { FloatEnvironment{0, of_thread().status}.set(); }
};

#else

struct FloatEnvironment {
    std::fenv_t value;

    static FloatEnvironment of_thread() noexcept {
        FloatEnvironment e;
        (void)std::fegetenv(&e.value);
        return e;
    }
    void set() const noexcept { (void)std::fesetenv(&value); }
    static void set_default() noexcept { (void)std::fesetenv(FE_DFL_ENV); }
};

#endif

// The caller's environment, on a thread that is in a call of the library; null elsewhere.
inline constinit thread_local const FloatEnvironment* callers_floats = nullptr;

// Sets the default environment while it exists, then restores the previous one, flags included.
class DefaultFloats {
public:
    DefaultFloats() noexcept
        : callers_(FloatEnvironment::of_thread()), outer_(std::exchange(callers_floats, &callers_)) {
        FloatEnvironment::set_default();
    }
    ~DefaultFloats() {
        callers_floats = outer_;
        callers_.set();
    }
    DefaultFloats(const DefaultFloats&) = delete;
    DefaultFloats& operator=(const DefaultFloats&) = delete;

private:
    const FloatEnvironment callers_;
    const FloatEnvironment* const outer_;
};

// Restores the caller's environment while it exists: around calls of the caller's functions.
class CallersFloats {
public:
    CallersFloats() noexcept : callers_(std::exchange(callers_floats, nullptr)) {
        if (callers_) callers_->set();
    }
    ~CallersFloats() {
        if (!callers_) return;
        callers_floats = callers_;
        FloatEnvironment::set_default();
    }
    CallersFloats(const CallersFloats&) = delete;
    CallersFloats& operator=(const CallersFloats&) = delete;

private:
    const FloatEnvironment* const callers_;
};

} // namespace vox
