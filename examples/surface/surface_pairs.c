/* Surface pairs: a sheet falls onto another. Which edges can meet on the way, how far it may fall and what
 * touches first, which faces and vertices touch at all, how far every vertex may move before anything
 * touches, which are close, whether the sheets cross where they end, and the cell size behind it. */
#include "example.h"

#include <string.h>
#include <vox/vox_surface.h>

enum { side = 11, sheet = side * side };

int main(void) {
    static double from[2 * sheet][3], to[2 * sheet][3], clearance[2 * sheet];
    static uint32_t faces[4 * (side - 1) * (side - 1)][3];
    uint64_t count = 0;
    for (uint32_t v = 0; v < 2 * sheet; ++v) {
        const uint32_t i = v % sheet, upper = v / sheet;
        const double x = i % side + 0.5 * upper, y = i / side + 0.25 * upper;
        const double at[3] = {x, y, upper ? 1 : 0.001 * (x * x + y * y)};
        for (int k = 0; k < 3; ++k) from[v][k] = to[v][k] = at[k];
        if (upper) to[v][2] -= 2;
        if (i % side + 1 == side || i / side + 1 == side) continue;
        const uint32_t quad[6] = {v, v + 1, v + side, v + side, v + 1, v + side + 1};
        for (uint32_t k = 0; k < 6; ++k) faces[count + k / 3][k % 3] = quad[k];
        count += 2;
    }

    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = 2 * sheet;
    desc.faces = faces[0];
    desc.face_count = count;
    vox_surface* surface = NULL;
    must(vox_surface_create(&desc, &surface));

    vox_motion motion = vox_default_motion();
    motion.from = vox_double_positions(from[0], 2 * sheet);
    motion.to = vox_double_positions(to[0], 2 * sheet);
    vox_partner_lists lists;
    uint64_t pairs[2];
    for (uint32_t cull = 0; cull < 2; ++cull) {
        motion.flags = cull ? VOX_MOTION_CULL : 0;
        must(vox_surface_move(surface, &motion));
        must(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
        pairs[cull] = lists.offsets[lists.count];
    }
    printf("%" PRIu64 " pairs of edges, of which %" PRIu64 " can meet\n", pairs[0], pairs[1]);

    vox_safe_step safe;
    vox_crossing_view crossings;
    must(vox_surface_find_safe_step(surface, NULL, &safe));
    must(vox_surface_find_crossings(surface, &crossings));
    printf("free of contact for %.3f of the way; at its end %s\n", safe.step,
           crossings.count > 0 ? "the sheets cross" : "nothing crosses");

    vox_impact_view times;
    must(vox_surface_find_impacts(surface, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, NULL, &times));
    double first = 1;
    for (uint64_t i = 0; i < times.count; ++i)
        first = times.data[i].time < first ? times.data[i].time : first;
    printf("faces and vertices: %" PRIu64 " touch, the first at %.3f\n", times.count, first);

    /* The surface chooses its cell size by this; one may also set it. No answer depends on it. */
    vox_cell_size_result suggestion;
    vox_counter_view counters;
    suggestion.struct_size = sizeof suggestion;
    must(vox_surface_suggest_cell_size(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, &suggestion));
    must(vox_surface_set_cell_size(surface, suggestion.cell_size));
    must(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
    must(vox_surface_get_counters(surface, &counters));
    printf("cells of %.1f:", suggestion.cell_size);
    for (uint64_t i = 0; i < counters.count; ++i)
        if (strcmp(counters.data[i].name, "overlaps") == 0 || strcmp(counters.data[i].name, "culled") == 0)
            printf(" %" PRIu64 " %s", counters.data[i].value, counters.data[i].name);
    printf("\n");

    motion.to.data = NULL; /* where the sheets began */
    must(vox_surface_move(surface, &motion));
    must(vox_surface_find_crossings(surface, &crossings));
    must(vox_surface_find_clearances(surface, 10, clearance));
    double least = clearance[0];
    for (int v = 1; v < 2 * sheet; ++v) least = clearance[v] < least ? clearance[v] : least;
    printf("before, %" PRIu64 " crossings; every vertex may move by %.3f at least\n", crossings.count, least);

    vox_proximity_view close;
    vox_feature_view edges;
    must(vox_surface_find_proximities(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0.95, &close));
    must(vox_surface_get_features(surface, VOX_FEATURE_EDGE, &edges));
    if (close.count > 0) {
        const vox_proximity* p = &close.data[0];
        const uint32_t* e = edges.vertices + 2 * p->a;
        printf("%" PRIu64 " edges are close, first that of vertices %u and %u, %.3f away from another\n",
               close.count, (unsigned)e[0], (unsigned)e[1], p->distance);
    }
    vox_surface_destroy(surface);
    return 0;
}
