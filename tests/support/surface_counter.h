/* A counter of a surface, by its name. */
#ifndef VOX_TESTS_SURFACE_COUNTER_H
#define VOX_TESTS_SURFACE_COUNTER_H

#include <string.h>
#include <vox/vox_surface.h>

#include "support/suite.h"

static inline uint64_t surface_counter(const vox_surface* surface, const char* name) {
    vox_counter_view view;
    ck_ok(vox_surface_get_counters(surface, &view));
    for (uint64_t i = 0; i < view.count; ++i)
        if (strcmp(view.data[i].name, name) == 0) return view.data[i].value;
    ck_abort_msg("no counter %s", name);
    return 0;
}

#endif
