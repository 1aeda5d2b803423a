/* Eq. 9 of the paper, for `vox sweep` and for the tests of the paper's tables. */
#ifndef VOX_TOOLS_ZONE_DISTANCE_H
#define VOX_TOOLS_ZONE_DISTANCE_H

#include <math.h>

/* How far `n` is from the best number n_opt, in units of the zone from n_min to n_max, all in cells per axis:
 * 0 at n_opt, below 1 inside the zone. As printed, Eq. 9 has the factors a = floor(n_opt / n) and b = floor(n
 * / n_opt) to choose the side that n lies on. One of them is zero, and the other cancels out. */
static inline double zone_distance(double n, double n_min, double n_opt, double n_max) {
    if (n == n_opt) return 0;
    const double width = n < n_opt ? n_opt - n_min : n_max - n_opt;
    return width > 0 ? fabs(n_opt - n) / width : (double)INFINITY;
}

#endif
