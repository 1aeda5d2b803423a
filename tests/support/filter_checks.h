/* What the tests of filters ask of a grid. */
#ifndef VOX_TESTS_FILTER_CHECKS_H
#define VOX_TESTS_FILTER_CHECKS_H

#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

static inline vox_grid* new_grid(void) {
    static uint32_t grids = 0;
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = 1 + grids++ % 3; /* of the fast engine: contacts do not depend on it */
    use_engine(&desc, suite_engine);
    desc.flags = 0;
    return grid_of(&desc);
}

static inline vox_body insert(vox_grid* grid, const vox_mesh_desc* desc) { return insert_mesh(grid, desc); }

static inline vox_contact_view stepped(vox_grid* grid) {
    ck_ok(vox_grid_step(grid));
    return contacts_of(grid);
}

static inline vox_filter filter_of(const vox_grid* grid, vox_body mesh) {
    vox_filter filter = plain_filter();
    ck_ok(get_filter(grid, mesh, &filter));
    return filter;
}

static inline uint64_t contacts_between(vox_contact_view view, vox_body a, vox_body b) {
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i)
        count += (view.data[i].body_a == a && view.data[i].body_b == b) ||
                 (view.data[i].body_a == b && view.data[i].body_b == a);
    return count;
}

#endif
