/* What the timing programs in C share: processor time, and the end of a run that failed. */
#ifndef VOX_BENCH_TIMING_H
#define VOX_BENCH_TIMING_H

#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <vox/vox.h>

/* Seconds of processor time of this process. */
static inline double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(EXIT_FAILURE);
}

#endif
