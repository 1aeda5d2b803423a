/* Floating-point environments that a program may have set, and what this thread's is. */
#ifndef VOX_TESTS_FLOAT_MODES_H
#define VOX_TESTS_FLOAT_MODES_H

#include <fenv.h>
#include <stdint.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

typedef struct float_mode {
    const char* name;
    int rounding;     /* of fesetround */
    uint32_t on, off; /* bits of the control register */
} float_mode;

/* The first is the default. */
static const float_mode float_modes[] = {
    {"default", FE_TONEAREST, 0, 0},
    {"downward", FE_DOWNWARD, 0, 0},
    {"upward", FE_UPWARD, 0, 0},
    {"towards zero", FE_TOWARDZERO, 0, 0},
#if defined(__x86_64__)
    {"denormals are zero", FE_TONEAREST, 0x0040, 0},
    {"flushed to zero", FE_TONEAREST, 0x8000, 0},
    {"-ffast-math", FE_TONEAREST, 0x8040, 0},
    {"everything traps", FE_TONEAREST, 0, 0x1f80},
    {"all at once", FE_UPWARD, 0x8040, 0x1f80},
#elif defined(__aarch64__)
    {"-ffast-math", FE_TONEAREST, 1u << 24, 0},
    {"all at once", FE_UPWARD, 1u << 24, 0},
#endif
};
enum { float_mode_count = sizeof float_modes / sizeof *float_modes };

/* Control and flags of this thread. */
static inline uint64_t float_state(void) {
#if defined(__x86_64__)
    uint16_t control, status;
    __asm__ volatile("fnstcw %0\n\tfnstsw %1" : "=m"(control), "=m"(status));
    return (uint64_t)(status & 0x7f) << 48 | (uint64_t)control << 32 | _mm_getcsr();
#elif defined(__aarch64__)
    uint64_t control, status;
    __asm__ volatile("mrs %0, fpcr\n\tmrs %1, fpsr" : "=r"(control), "=r"(status));
    return control << 32 | status;
#else
    return (uint64_t)fegetround() << 32 | (uint64_t)fetestexcept(FE_ALL_EXCEPT);
#endif
}

/* No flag is raised afterwards. */
static inline void set_float_mode(const float_mode* mode) {
    (void)fesetenv(FE_DFL_ENV);
#if defined(__x86_64__)
    _mm_setcsr(0x1f80); /* which fesetenv of MinGW-w64 10 leaves as it is */
#endif
    (void)fesetround(mode->rounding);
#if defined(__x86_64__)
    _mm_setcsr((_mm_getcsr() | mode->on) & ~mode->off);
#elif defined(__aarch64__)
    uint64_t control;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control));
    __asm__ volatile("msr fpcr, %0" : : "r"(control | mode->on));
#endif
}

/* A call of the library in this mode. It succeeds, and leaves the environment as it was. */
#define ck_in_mode(mode, call)                                                                               \
    do {                                                                                                     \
        set_float_mode(mode);                                                                                \
        const uint64_t before_ = float_state();                                                              \
        const vox_result result_of_call_ = (call);                                                           \
        const uint64_t after_ = float_state();                                                               \
        set_float_mode(&float_modes[0]);                                                                     \
        ck_assert_msg(result_of_call_ == VOX_OK, "%s, %s: %s", (mode)->name, #call, vox_last_error());       \
        ck_assert_msg(before_ == after_, "%s, %s: the environment was %llx and is %llx", (mode)->name,       \
                      #call, (unsigned long long)before_, (unsigned long long)after_);                       \
    } while (0)

#endif
