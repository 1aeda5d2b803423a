/* What the tests of filters ask of a grid. */
#ifndef VOX_TESTS_FILTER_CHECKS_H
#define VOX_TESTS_FILTER_CHECKS_H

#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

static inline vox_grid* new_grid(void) {
    static uint32_t grids = 0;
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    desc.worker_count = 1 + grids++ % 3; /* of the fast engine: contacts do not depend on it */
    desc.engine = suite_engine;
    desc.flags = 0;
    ck_ok(vox_grid_create(&desc, &grid));
    return grid;
}

static inline vox_mesh insert(vox_grid* grid, const vox_mesh_desc* desc) {
    vox_mesh mesh = 0;
    ck_ok(vox_mesh_insert(grid, desc, &mesh));
    return mesh;
}

static inline vox_contact_view stepped(vox_grid* grid) {
    vox_contact_view view = {NULL, 0, 0, 0};
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_contacts(grid, &view));
    return view;
}

static inline vox_counters counters_of(const vox_grid* grid) {
    vox_counters counters;
    memset(&counters, 0, sizeof counters);
    counters.struct_size = sizeof counters;
    ck_ok(vox_grid_counters(grid, &counters));
    return counters;
}

static inline vox_filter filter_of(const vox_grid* grid, vox_mesh mesh) {
    vox_filter filter = vox_default_filter();
    ck_ok(vox_mesh_filter(grid, mesh, &filter));
    return filter;
}

static inline uint64_t contacts_between(vox_contact_view view, vox_mesh a, vox_mesh b) {
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i)
        count += (view.data[i].mesh_a == a && view.data[i].mesh_b == b) ||
                 (view.data[i].mesh_a == b && view.data[i].mesh_b == a);
    return count;
}

#endif
