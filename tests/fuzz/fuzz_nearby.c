/* libFuzzer target: constraints of all kinds. The bytes are a few small bodies and where they were before.
 * Both engines find the same, in canonical order and in range, by each method, in the first step and in two
 * in which some stand still; nothing of it changes the contacts. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox_cell_size.h>

#include "bytes.h"

enum { most_bodies = 3, most_vertices = 10, most_tets = 8 };

typedef struct small_body {
    uint32_t vertices, tets, flags, corners[4 * most_tets];
    float now[3 * most_vertices], before[3 * most_vertices];
    int moves;
} small_body;

typedef struct scene {
    uint32_t count;
    small_body bodies[most_bodies];
    double margin;
} scene;

static scene read_scene(bytes* b) {
    static const float scales[] = {1, 1, 1e-20f, 1e20f, 1, 1, 1e6f, 0.1f};
    scene s;
    memset(&s, 0, sizeof s);
    const uint32_t how = next(b);
    const float scale = scales[how & 7];
    s.margin = how & 8 ? (double)scale * next(b) / 32 : 0;
    s.count = 1 + (how >> 4) % most_bodies;
    for (uint32_t k = 0; k < s.count; ++k) {
        small_body* body = &s.bodies[k];
        const uint32_t kind = next(b);
        body->moves = kind & 1;
        body->flags = kind & 2 ? VOX_FILTER_SELF_COLLISION : 0;
        body->vertices = 4 + (kind >> 2) % (most_vertices - 3);
        body->tets = 1 + next(b) % most_tets;
        for (uint32_t i = 0; i < 4 * body->tets; ++i) body->corners[i] = next(b) % body->vertices;
        for (uint32_t i = 0; i < 3 * body->vertices; ++i) {
            body->now[i] = scale * ((float)(next(b) & 31) - 16) / 4;
            body->before[i] =
                body->moves ? body->now[i] + scale * ((float)(next(b) & 15) - 8) / 4 : body->now[i];
        }
    }
    return s;
}

static vox_grid* grid_of(scene* s, const vox_reference_desc* reference, int nearby,
                         vox_body ids[most_bodies]) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = reference;
    desc.byte_budget = 64u << 20;
    if (nearby) {
        desc.flags |= VOX_GRID_EDGES;
        desc.margin = s->margin;
    }
    vox_grid* grid = NULL;
    demand(vox_grid_create(&desc, &grid) == VOX_OK);
    for (uint32_t k = 0; k < s->count; ++k) {
        small_body* body = &s->bodies[k];
        vox_mesh_desc mesh = vox_mesh_desc_floats(body->now, body->vertices, body->corners, body->tets);
        mesh.filter.flags = body->flags;
        demand(vox_mesh_insert(grid, &mesh, &ids[k]) == VOX_OK);
        const vox_positions before = vox_float_positions(body->before, body->vertices);
        if (nearby && body->moves) demand(vox_mesh_bind_previous_positions(grid, ids[k], &before) == VOX_OK);
    }
    return grid;
}

/* Lexicographic order of what a contact is about. */
static int before(const uint32_t* a, const uint32_t* b, int count) {
    for (int i = 0; i < count; ++i)
        if (a[i] != b[i]) return a[i] < b[i];
    return 0;
}

static void sort3(uint32_t v[3]) {
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k)
            if (v[k] > v[k + 1]) {
                const uint32_t t = v[k];
                v[k] = v[k + 1];
                v[k + 1] = t;
            }
}

static void key_of(const vox_constraint* c, uint32_t key[8]) {
    memset(key, 0, 8 * sizeof *key);
    key[0] = c->pair;
    key[1] = (uint32_t)c->kind;
    key[2] = c->body_a;
    key[3] = c->vertices[0];
    if (c->kind != VOX_CONSTRAINT_EDGE) return;
    memcpy(key + 4, c->vertices + 1, 4 * sizeof *key);
    sort3(key + 5);
}

static const small_body* body_of(const scene* s, const vox_body ids[most_bodies], vox_body id) {
    uint32_t k = 0;
    while (k < s->count && ids[k] != id) ++k;
    demand(k < s->count);
    return &s->bodies[k];
}

static void check(const vox_grid* grid, const scene* s, const vox_body ids[most_bodies]) {
    vox_constraint_view view;
    vox_pair_view pairs;
    demand(vox_grid_get_constraints(grid, &view) == VOX_OK && vox_grid_get_pairs(grid, &pairs) == VOX_OK);
    demand(view.pair_count == pairs.count && view.pair_offsets[pairs.count] == view.count);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        const int is_edge = c->kind == VOX_CONSTRAINT_EDGE;
        uint32_t key[8], last[8];
        key_of(c, key);
        if (i > 0) key_of(c - 1, last);
        demand(i == 0 || before(last, key, 8));
        demand(c->pair < pairs.count && view.pair_offsets[c->pair] <= i &&
               i < view.pair_offsets[c->pair + 1]);
        demand(c->count_a == (is_edge ? 2u : 1u) && c->count <= VOX_STENCIL_CAPACITY);
        for (uint32_t k = 0; k < c->count; ++k) {
            const double weight = k < c->count_a ? c->weights[k] : -c->weights[k];
            demand(c->vertices[k] < body_of(s, ids, k < c->count_a ? c->body_a : c->body_b)->vertices);
            demand(weight >= 0 && weight <= 1);
        }
        for (int k = 0; k < 3; ++k) demand(isfinite(c->position[k]) && fabs(c->normal[k]) <= 1 + 1e-9);
        demand(isfinite(c->offset) && c->time >= 0 && c->time <= 1);
        demand(c->element_b < body_of(s, ids, c->body_b)->tets);
        if (is_edge) {
            const uint32_t* face = c->vertices + 2;
            demand(c->vertices[0] < c->vertices[1] && face[0] < face[1] && face[0] < face[2]);
        }
        if (c->kind == VOX_CONSTRAINT_PROXIMITY)
            demand(c->gap >= 0 && c->gap <= s->margin);
        else
            demand(c->gap <= 0);
        demand(is_edge || c->kind == VOX_CONSTRAINT_INSIDE || c->body_a != c->body_b);
    }
}

static void check_same(const vox_grid* x, const vox_grid* y) {
    uint64_t a = 0, b = 1;
    demand(vox_grid_get_hash(x, &a) == VOX_OK && vox_grid_get_hash(y, &b) == VOX_OK && a == b);
    vox_constraint_view c, d;
    demand(vox_grid_get_constraints(x, &c) == VOX_OK && vox_grid_get_constraints(y, &d) == VOX_OK);
    demand(c.count == d.count && (c.count == 0 || memcmp(c.data, d.data, c.count * sizeof *c.data) == 0));
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size < 24) return -1;
    bytes b = {data, size};
    scene s = read_scene(&b);
    vox_body ids[most_bodies];
    const vox_reference_desc slow = vox_default_reference_desc();
    vox_grid *const plain = grid_of(&s, NULL, 0, ids), *const fast = grid_of(&s, NULL, 1, ids),
                    *const reference = grid_of(&s, &slow, 1, ids);
    for (int step = 0; step < 3; ++step) {
        const vox_result result = vox_grid_step(fast);
        demand(vox_grid_step(reference) == result && vox_grid_step(plain) == result);
        demand(result == VOX_OK || result == VOX_ERROR_BUDGET || result == VOX_ERROR_LIMIT ||
               result == VOX_ERROR_NON_FINITE);
        if (result != VOX_OK) break;
        vox_constraint_desc by = vox_default_constraint_desc();
        by.method = (vox_depth_method)step;
        const vox_result found = vox_grid_find_constraints(fast, &by);
        demand(vox_grid_find_constraints(reference, &by) == found);
        demand(found == VOX_OK || found == VOX_ERROR_BUDGET);
        if (found != VOX_OK) break;
        check(fast, &s, ids);
        check_same(fast, reference);
        uint64_t with = 0, without = 1;
        demand(vox_grid_get_hash(fast, &with) == VOX_OK && vox_grid_get_hash(plain, &without) == VOX_OK &&
               with == without);
        if (step == 0) /* then one of them moves, and the others stand still */
            for (uint32_t i = 0; i < 3 * s.bodies[0].vertices; ++i) {
                s.bodies[0].before[i] = s.bodies[0].now[i];
                s.bodies[0].now[i] += s.bodies[0].now[0] / 8;
            }
    }
    vox_grid_destroy(plain);
    vox_grid_destroy(fast);
    vox_grid_destroy(reference);
    return 0;
}
