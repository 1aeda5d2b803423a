/* The library's internal switch of instruction sets, for a program in C that links it statically. */
#ifndef VOX_TESTS_SIMD_LEVEL_H
#define VOX_TESTS_SIMD_LEVEL_H

#ifdef __cplusplus
extern "C" {
#endif

/* 0 portable to 3 AVX-512, or the best that the machine has where that is less. Returns the name of that in
 * force. */
const char* force_simd_level(int level);

#ifdef __cplusplus
}
#endif

#endif
