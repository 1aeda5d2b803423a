/* What doubles cost: each scene in a grid of floats and in one of doubles that are no floats, stepped in
 * turn, and the ratio of their lower quartiles of processor time. "rigid" moves the same floats by
 * transforms. Usage: bench_doubles [frames], 30 by default. */
#include "scenes/scenes.h"
#include "timing.h"

enum { FLOATS, DOUBLES, DOUBLES_FAR, RIGID, VARIANTS };

typedef struct variant {
    vox_grid* grid;
    void* positions[MOST_BODIES]; /* its own, written just before each step */
    vox_body ids[MOST_BODIES];
    uint64_t contacts;
    double* seconds;
} variant;

static int is_double(int kind) { return kind == DOUBLES || kind == DOUBLES_FAR; }

static void make_variant(variant* v, int kind, const scene* s, int frames) {
    check(vox_grid_create(NULL, &v->grid));
    v->seconds = (double*)malloc(sizeof(double) * (size_t)frames);
    for (uint32_t i = 0; i < s->count; ++i) {
        vox_mesh_desc desc = body_desc(&s->bodies[i]);
        v->positions[i] = malloc(3 * sizeof(double) * s->bodies[i].vertex_count);
        desc.filter.flags = s->self_collision ? VOX_FILTER_SELF_COLLISION : 0;
        memcpy(v->positions[i], s->bodies[i].positions, 3 * sizeof(float) * s->bodies[i].vertex_count);
        check(vox_mesh_insert(v->grid, &desc, &v->ids[i]));
        const uint64_t vertices = s->bodies[i].vertex_count;
        check(is_double(kind) ? vox_mesh_bind_doubles(v->grid, v->ids[i], v->positions[i], vertices)
                              : vox_mesh_bind_floats(v->grid, v->ids[i], v->positions[i], vertices));
    }
}

static void pose_variant(variant* v, int kind, const scene* s) {
    /* Less than a float shows; always the same, so that bodies at rest are at rest in each variant. */
    const double off = 1e-9 + (kind == DOUBLES_FAR ? 1e6 : 0);
    for (uint32_t i = 0; i < s->count; ++i) {
        const double m[12] = {1, 0, 0, off, 0, 1, 0, off, 0, 0, 1, off};
        if (kind == RIGID) check(vox_body_set_transform(v->grid, v->ids[i], m));
        const float* from = s->bodies[i].positions;
        const uint32_t count = 3 * s->bodies[i].vertex_count;
        if (is_double(kind)) {
            double* to = (double*)v->positions[i];
            for (uint32_t k = 0; k < count; ++k) to[k] = (double)from[k] + off;
        } else {
            memcpy(v->positions[i], from, sizeof(float) * count);
        }
    }
}

static int ascending(const void* a, const void* b) {
    const double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static void measure(scene* s, const char* name, int frames) {
    static variant variants[VARIANTS];
    for (int k = 0; k < VARIANTS; ++k) make_variant(&variants[k], k, s, frames);
    for (int frame = -2; frame < frames; ++frame) {
        pose_scene(s, frame + 2);
        for (int k = 0; k < VARIANTS; ++k) {
            variant* v = &variants[(k + frame + 2) % VARIANTS]; /* in another order each time */
            vox_contact_view view;
            pose_variant(v, (k + frame + 2) % VARIANTS, s);
            const double start = now();
            check(vox_grid_step(v->grid));
            const double end = now();
            if (frame >= 0) v->seconds[frame] = end - start;
            check(vox_grid_get_contacts(v->grid, &view));
            v->contacts = view.count;
        }
    }
    double taken[VARIANTS];
    for (int k = 0; k < VARIANTS; ++k) {
        variant* v = &variants[k];
        qsort(v->seconds, (size_t)frames, sizeof *v->seconds, ascending);
        taken[k] = v->seconds[frames / 4];
        vox_grid_destroy(v->grid);
        free(v->seconds);
        for (uint32_t i = 0; i < s->count; ++i) free(v->positions[i]);
    }
    printf("%-6s %7.3f ms of floats, %6llu contacts; doubles %.3f, at 1e6 %.3f, rigid %.3f\n", name,
           1e3 * taken[FLOATS], (unsigned long long)variants[FLOATS].contacts, taken[DOUBLES] / taken[FLOATS],
           taken[DOUBLES_FAR] / taken[FLOATS], taken[RIGID] / taken[FLOATS]);
    free_scene(s);
}

int main(int argc, char** argv) {
    const int frames = argc > 1 ? atoi(argv[1]) : 30;
    static scene s;
    if (frames < 1) return 2;
    make_pair(&s, 28);
    measure(&s, "pair", frames);
    memset(&s, 0, sizeof s);
    make_self(&s, 22);
    measure(&s, "self", frames);
    memset(&s, 0, sizeof s);
    make_many(&s, 5, 8);
    measure(&s, "many", frames);
    return EXIT_SUCCESS;
}
