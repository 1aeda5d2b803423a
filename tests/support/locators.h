/* Short questions to locators. */
#ifndef VOX_TESTS_LOCATORS_H
#define VOX_TESTS_LOCATORS_H

#include <vox/vox_query.h>

#include "support/suite.h"

static inline vox_locator* take_locator(vox_grid* grid) {
    vox_locator* locator = NULL;
    ck_ok(vox_grid_update_locator(grid, &locator));
    return locator;
}

static inline vox_query_desc query_of(uint64_t mask, vox_body excluded) {
    vox_query_desc desc = vox_default_query_desc();
    desc.mask = mask;
    desc.excluded = excluded;
    return desc;
}

/* How many tetrahedra contain a point. */
static inline uint64_t count_at(const vox_locator* locator, const double p[3]) {
    const vox_positions at = vox_double_positions(p, 1);
    uint64_t count = 77;
    ck_ok(vox_locator_find_point_hits(locator, &at, NULL, NULL, 0, &count));
    return count;
}

static inline vox_closest_hit closest_to(const vox_locator* locator, const double p[3],
                                         const vox_query_desc* desc) {
    const vox_positions at = vox_double_positions(p, 1);
    vox_closest_hit hit;
    ck_ok(vox_locator_find_closest(locator, &at, desc, &hit));
    return hit;
}

#endif
