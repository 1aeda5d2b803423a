/* libFuzzer target: vox_surface.h. The bytes are a small surface, its motion and a budget. Pairs are those of
 * a loop over all boxes, in ascending order, whatever the budget and the cell size; what is culled is one of
 * them; all other answers are in order and in range. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox_surface.h>

#include "bytes.h"

enum { most_vertices = 24, most_features = 32 };

typedef struct scene {
    uint32_t vertices, counts[3], corners[3][3 * most_features], patches[most_vertices];
    uint64_t categories[4], masks[4];
    double from[3 * most_vertices], to[3 * most_vertices], radius;
    int moves, columns, has_patches;
} scene;

/* Coordinates that others often have too, or that differ in the last place. */
static double coordinate(bytes* b, double scale) {
    const uint32_t x = next(b);
    const double at = scale * ((double)(x & 31) - 16) / 8;
    return x & 32 ? nextafter(at, x & 64 ? INFINITY : -INFINITY) : at;
}

static scene read_scene(bytes* b) {
    static const double scales[] = {1, 1, 1e-30, 1e30, 1e-300, 1e6, 1, 0.1},
                        mixed[] = {1, 1e-40, 1e8, 1.7e38};
    scene s;
    memset(&s, 0, sizeof s);
    const uint32_t how = next(b);
    const double scale = scales[how & 7];
    const int mixes = next(b) % 4 == 0; /* sizes of all orders in one scene */
    s.moves = how >> 3 & 1;
    s.columns = how >> 4 & 1;
    s.has_patches = how >> 5 & 1;
    s.radius = how >> 6 == 3 ? INFINITY : how >> 6 ? scale * next(b) / 64 : 0;
    s.vertices = 2 + next(b) % (most_vertices - 1);
    for (int kind = 1; kind < 3; ++kind) {
        s.counts[kind] = 1 + next(b) % most_features;
        for (uint32_t i = 0; i < s.counts[kind] * (uint32_t)(kind + 1); ++i)
            s.corners[kind][i] = next(b) % s.vertices;
    }
    s.counts[0] = s.vertices;
    for (uint32_t v = 0; v < s.vertices; ++v) s.corners[0][v] = v;
    for (uint32_t i = 0; i < 3 * s.vertices; ++i) {
        const double of_this = mixes ? mixed[next(b) & 3] : scale;
        s.from[i] = coordinate(b, of_this);
        s.to[i] = s.moves ? coordinate(b, of_this) : s.from[i];
    }
    for (uint32_t v = 0; s.has_patches && v < s.vertices; ++v) s.patches[v] = next(b) & 3;
    for (int p = 0; p < 4; ++p) {
        s.categories[p] = 1ull << (p & 1);
        s.masks[p] = s.has_patches ? next(b) & 3 : 3;
    }
    return s;
}

static vox_surface* surface_of(const scene* s, uint32_t workers, double cell_size, uint64_t budget) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = workers;
    desc.vertex_count = s->vertices;
    desc.edges = s->corners[1];
    desc.edge_count = s->counts[1];
    desc.faces = s->corners[2];
    desc.face_count = s->counts[2];
    desc.cell_size = cell_size;
    desc.byte_budget = budget;
    if (s->has_patches) {
        desc.patches = s->patches;
        desc.patch_categories = s->categories;
        desc.patch_masks = s->masks;
        desc.patch_count = 4;
    }
    vox_surface* surface = NULL;
    const vox_result result = vox_surface_create(&desc, &surface);
    demand(result == VOX_OK || (budget != 0 && result == VOX_ERROR_BUDGET));
    return surface;
}

static vox_result move(vox_surface* surface, const scene* s, uint32_t flags) {
    double from[3 * most_vertices], to[3 * most_vertices];
    for (uint32_t v = 0; v < s->vertices; ++v)
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t at = s->columns ? c * s->vertices + v : 3 * v + c;
            from[at] = s->from[3 * v + c];
            to[at] = s->to[3 * v + c];
        }
    vox_motion motion = vox_default_motion();
    motion.flags = flags;
    motion.from.data = from;
    motion.to.data = s->moves ? to : NULL;
    motion.from.count = motion.to.count = s->vertices;
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    motion.radius = s->radius;
    motion.from.byte_stride = motion.to.byte_stride = s->columns ? sizeof(double) : 0;
    motion.from.component_byte_stride = motion.to.component_byte_stride =
        s->columns ? s->vertices * sizeof(double) : 0;
    return vox_surface_move(surface, &motion);
}

static void box_of(const scene* s, int kind, uint32_t feature, double low[3], double high[3]) {
    for (int a = 0; a < 3; ++a) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
        for (int c = 0; c <= kind; ++c) {
            const uint32_t v = s->corners[kind][feature * (uint32_t)(kind + 1) + (uint32_t)c];
            const double x = s->from[3 * v + (uint32_t)a], y = s->to[3 * v + (uint32_t)a];
            low[a] = fmin(low[a], nextafter(fmin(x, y) - s->radius, -INFINITY));
            high[a] = fmax(high[a], nextafter(fmax(x, y) + s->radius, INFINITY));
        }
    }
}

static int make_a_pair(const scene* s, int a, uint32_t i, int b, uint32_t j) {
    double low_a[3], high_a[3], low_b[3], high_b[3];
    box_of(s, a, i, low_a, high_a);
    box_of(s, b, j, low_b, high_b);
    for (int k = 0; k < 3; ++k)
        if (!(low_a[k] <= high_b[k] && low_b[k] <= high_a[k])) return 0;
    int may_meet = !s->has_patches;
    for (int c = 0; c <= a; ++c)
        for (int d = 0; d <= b; ++d) {
            const uint32_t v = s->corners[a][i * (uint32_t)(a + 1) + (uint32_t)c],
                           w = s->corners[b][j * (uint32_t)(b + 1) + (uint32_t)d];
            if (v == w) return 0;
            may_meet |= (s->categories[s->patches[v]] & s->masks[s->patches[w]]) != 0 &&
                        (s->categories[s->patches[w]] & s->masks[s->patches[v]]) != 0;
        }
    return may_meet;
}

/* All pairs, asked for `step` features at a time. Where some are left out, no others may be there. */
static void check_pairs(vox_surface* surface, const scene* s, int a, int b, uint64_t step, int culled) {
    for (uint64_t first = 0; first < s->counts[a];) {
        vox_partner_lists lists;
        const vox_result result =
            vox_surface_find_pairs(surface, (vox_feature)a, (vox_feature)b, first, step, &lists);
        if (result == VOX_ERROR_BUDGET) return;
        demand(result == VOX_OK);
        demand(lists.first == first && lists.count >= 1 && lists.count <= step && lists.offsets[0] == 0);
        for (uint64_t i = 0; i < lists.count; ++i) {
            uint64_t k = lists.offsets[i];
            for (uint32_t j = a == b ? (uint32_t)(first + i) + 1 : 0; j < s->counts[b]; ++j) {
                const int is_there = k < lists.offsets[i + 1] && lists.partners[k] == j;
                const int expected = make_a_pair(s, a, (uint32_t)(first + i), b, j);
                demand(is_there == expected || (culled && !is_there));
                k += (uint64_t)is_there;
            }
            demand(k == lists.offsets[i + 1]); /* none is left, so they ascend */
        }
        first += lists.count;
    }
}

static int in_order(uint32_t a, uint32_t b, uint32_t next_a, uint32_t next_b) {
    return a < next_a || (a == next_a && b < next_b);
}

/* With a budget, an answer may not fit into it, and nothing else may go wrong. */
static int answered(vox_result result, int has_budget) {
    demand(result == VOX_OK || (has_budget && result == VOX_ERROR_BUDGET));
    return result == VOX_OK;
}

static void check_answers(vox_surface* surface, const scene* s, const vox_impact_desc* rule, int has_budget) {
    vox_crossing_view crossings;
    if (!answered(vox_surface_find_crossings(surface, &crossings), has_budget)) crossings.count = 0;
    for (uint64_t i = 0; i < crossings.count; ++i) {
        const vox_crossing* c = &crossings.data[i];
        demand(c->edge < s->counts[1] && c->face < s->counts[2]);
        demand(i == 0 || in_order(c[-1].edge, c[-1].face, c->edge, c->face));
        for (int k = 0; k < 2; ++k) demand(c->edge_weights[k] >= 0 && c->edge_weights[k] <= 1);
        for (int k = 0; k < 3; ++k) demand(c->face_weights[k] >= 0 && c->face_weights[k] <= 1);
    }
    static const int kinds[][2] = {{2, 0}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 2}};
    const double distance = isinf(s->radius) ? 1 : s->radius;
    for (int k = 0; k < 6; ++k) {
        vox_proximity_view close;
        if (!answered(vox_surface_find_proximities(surface, (vox_feature)kinds[k][0],
                                                   (vox_feature)kinds[k][1], distance, &close),
                      has_budget))
            continue;
        for (uint64_t i = 0; i < close.count; ++i) {
            const vox_proximity* c = &close.data[i];
            demand(c->distance >= 0 && c->distance <= distance);
            demand(i == 0 || in_order(c[-1].a, c[-1].b, c->a, c->b));
        }
    }
    double clearance[most_vertices];
    for (uint32_t v = 0; v < s->vertices; ++v) clearance[v] = -1;
    const int is_clear = answered(vox_surface_find_clearances(surface, 1, clearance), has_budget);
    for (uint32_t v = 0; v < s->vertices; ++v)
        demand(is_clear ? clearance[v] >= 0 && clearance[v] <= 1 : clearance[v] == -1);
    vox_safe_step step;
    int all_there = answered(vox_surface_find_safe_step(surface, rule, &step), has_budget);
    demand(!all_there || (step.step >= 0 && step.step <= 1));
    double first = 1;
    for (int k = 0; k < 2; ++k) {
        vox_impact_view times;
        if (!answered(vox_surface_find_impacts(surface, (vox_feature)kinds[k][0], (vox_feature)kinds[k][1],
                                               rule, &times),
                      has_budget)) {
            all_there = 0;
            continue;
        }
        for (uint64_t i = 0; i < times.count; ++i) {
            const vox_impact* t = &times.data[i];
            demand(t->time >= 0 && t->time <= 1);
            demand(i == 0 || in_order(t[-1].a, t[-1].b, t->a, t->b));
            first = fmin(first, t->time);
        }
    }
    demand(!all_there || first == step.step);

    for (int kind = 1; kind < 3; ++kind) {
        vox_feature_view view;
        demand(vox_surface_get_features(surface, (vox_feature)kind, &view) == VOX_OK &&
               view.count == s->counts[kind]);
        demand(memcmp(view.vertices, s->corners[kind],
                      s->counts[kind] * (uint32_t)(kind + 1) * sizeof(uint32_t)) == 0);
    }
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    const vox_result suggested =
        vox_surface_suggest_cell_size(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE, &suggestion);
    if (suggested == VOX_OK)
        demand(suggestion.cell_size > 0 &&
               vox_surface_set_cell_size(surface, suggestion.cell_size) == VOX_OK);
    else /* boxes without an end */
        demand((has_budget && suggested == VOX_ERROR_BUDGET) || suggested == VOX_ERROR_INVALID_ARGUMENT);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size < 16) return -1;
    bytes b = {data, size};
    const uint32_t how = next(&b), step = 1 + next(&b);
    const scene s = read_scene(&b);
    const double cell_size = how & 1 ? ldexp(1, (int)(how >> 1 & 63) - 32) : 0;
    const uint64_t budget = how & 128 ? 1000 * (uint64_t)(1 + next(&b)) : 0;
    vox_impact_desc rule = vox_default_impact_desc();
    const uint32_t of_rule = next(&b);
    if (of_rule & 1) rule.distance = ldexp(1, (int)(of_rule >> 1 & 15) - 12);
    if (of_rule & 32) rule.max_iterations = 1 + (of_rule >> 6);
    vox_surface* const surface = surface_of(&s, budget == 0 && how & 64 ? 2 : 1, cell_size, budget);
    if (!surface) return 0;
    const vox_result moved = move(surface, &s, 0);
    demand(moved == VOX_OK || (budget != 0 && moved == VOX_ERROR_BUDGET));
    for (int a = 0; a < 3 && moved == VOX_OK; ++a)
        for (int c = 0; c < 3; ++c) check_pairs(surface, &s, a, c, step, 0);
    if (budget == 0) {
        check_answers(surface, &s, of_rule == 0 ? NULL : &rule, 0);
        demand(move(surface, &s, VOX_MOTION_CULL) == VOX_OK);
        for (int a = 0; a < 3; ++a)
            for (int c = 0; c < 3; ++c) check_pairs(surface, &s, a, c, UINT64_MAX, 1);
    } else {
        if (moved == VOX_OK) check_answers(surface, &s, &rule, 1);
        vox_counter_view counters;
        demand(vox_surface_get_counters(surface, &counters) == VOX_OK);
        const vox_counter* const last = &counters.data[counters.count - 1];
        demand(strcmp(last->name, "peak_bytes") == 0 && last->value <= budget);
    }
    vox_surface_destroy(surface);
    return 0;
}
