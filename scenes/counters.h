/* A grid's counters and times as fields, for tests and benchmarks: by the names of vox_grid_get_counters, and
 * from vox_grid_info. */
#ifndef VOX_SCENES_COUNTERS_H
#define VOX_SCENES_COUNTERS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox.h>

/* clang-format off */
#define GRID_COUNTS(X) \
    X(bodies) X(vertices) X(tets) X(cells) X(entries) X(fullest_cell) X(visited_cells) \
    X(visited_entries) X(candidates) X(exact_tests) X(contacts) X(skipped_degenerate) \
    X(carried_contacts) X(penetrations) X(leaving_edges) X(edge_tests) X(closest_searches) \
    X(closest_tests) X(disabled_bodies) X(filtered) X(cell_size_changes) X(unknown_penetrations) \
    X(carried_penetrations) X(bodies_without_tets) X(edge_contacts) X(carried_edge_contacts) \
    X(edge_candidates) X(proximities) X(carried_proximities) X(passages) X(face_candidates) X(constraints)
#define GRID_TIMES(X) \
    X(step_ns) X(bin_ns) X(broad_ns) X(narrow_ns) X(contacts_ns) X(depth_ns) X(constraints_ns) \
    X(pairs_ns) X(stream_ns) X(winding_ns) X(broad_phase_ns) X(windows_ns) X(lookup_ns) X(decide_ns) \
    X(edges_ns) X(margin_ns)
/* clang-format on */

#define GRID_FIELD(name) uint64_t name;
typedef struct grid_counts {
    GRID_COUNTS(GRID_FIELD)
    uint64_t moved_bodies, skipped_bodies, total_touches_began, total_touches_ended, bytes, peak_bytes;
} grid_counts;
typedef struct grid_times {
    GRID_TIMES(GRID_FIELD)
} grid_times;
#undef GRID_FIELD

/* The counter of this name, which must exist. */
static inline uint64_t counter_of(const vox_grid* grid, const char* name) {
    vox_counter_view view = {NULL, 0};
    if (vox_grid_get_counters(grid, &view) == VOX_OK)
        for (uint64_t i = 0; i < view.count; ++i)
            if (strcmp(view.data[i].name, name) == 0) return view.data[i].value;
    fprintf(stderr, "no counter %s\n", name);
    abort();
}

static inline grid_counts counters_of(const vox_grid* grid) {
    grid_counts counts;
    vox_grid_info info;
    info.struct_size = (uint32_t)sizeof info;
    if (vox_grid_get_info(grid, &info) != VOX_OK) abort();
#define GRID_READ(name) counts.name = counter_of(grid, #name);
    GRID_COUNTS(GRID_READ)
    counts.moved_bodies = info.moved_bodies;
    counts.skipped_bodies = info.skipped_bodies;
    counts.total_touches_began = info.total_began;
    counts.total_touches_ended = info.total_ended;
    counts.bytes = info.bytes;
    counts.peak_bytes = info.peak_bytes;
    return counts;
}

static inline grid_times times_of(const vox_grid* grid) {
    grid_times times;
#define GRID_TIME(name) times.name = counter_of(grid, #name);
    GRID_TIMES(GRID_TIME)
    return times;
}
#undef GRID_READ
#undef GRID_TIME

#endif
