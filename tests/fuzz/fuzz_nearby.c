/* libFuzzer target: edge contacts, margin contacts and passages of a grid. The bytes are a few small bodies
 * and where they were before. Both engines find the same, in canonical order and in range, in the first step
 * and in one in which some stand still; nothing of it changes the contacts. */
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
        desc.flags |= VOX_GRID_EDGE_CONTACTS;
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

static void key_of(const vox_edge_contact* c, uint32_t key[7]) {
    const uint32_t all[7] = {c->body_a,  c->edge[0], c->edge[1], c->body_b,
                             c->face[0], c->face[1], c->face[2]};
    memcpy(key, all, sizeof all);
    sort3(key + 4);
}

static void check(const vox_grid* grid, const scene* s) {
    vox_edge_contact_view edges;
    demand(vox_grid_edge_contacts(grid, &edges) == VOX_OK);
    for (uint64_t i = 0; i < edges.count; ++i) {
        const vox_edge_contact* c = &edges.data[i];
        uint32_t key[7], last[7];
        key_of(c, key);
        if (i > 0) key_of(c - 1, last);
        demand(i == 0 || before(last, key, 7));
        demand(c->edge[0] < c->edge[1] && c->face[0] < c->face[1] && c->face[0] < c->face[2]);
        for (int k = 0; k < 2; ++k) demand(c->edge_weights[k] >= 0 && c->edge_weights[k] <= 1);
        for (int k = 0; k < 3; ++k) demand(c->face_weights[k] >= 0 && c->face_weights[k] <= 1);
        for (int k = 0; k < 3; ++k) demand(isfinite(c->position[k]) && fabs(c->normal[k]) <= 1 + 1e-9);
    }
    vox_margin_contact_view margins;
    const vox_result has_margin = vox_grid_margin_contacts(grid, &margins);
    demand(has_margin == (s->margin > 0 ? VOX_OK : VOX_ERROR_INVALID_STATE));
    for (uint64_t i = 0; has_margin == VOX_OK && i < margins.count; ++i) {
        const vox_margin_contact* c = &margins.data[i];
        const uint32_t key[3] = {c->body_a, c->vertex, c->body_b};
        const uint32_t last[3] = {i ? c[-1].body_a : 0, i ? c[-1].vertex : 0, i ? c[-1].body_b : 0};
        demand(i == 0 || before(last, key, 3));
        demand(c->body_a != c->body_b && c->distance >= 0 && c->distance <= s->margin);
    }
    vox_passage_view passages;
    demand(vox_grid_passages(grid, &passages) == VOX_OK);
    for (uint64_t i = 0; i < passages.count; ++i) {
        const vox_passage* c = &passages.data[i];
        const uint32_t key[3] = {c->body_a, c->vertex, c->body_b};
        const uint32_t last[3] = {i ? c[-1].body_a : 0, i ? c[-1].vertex : 0, i ? c[-1].body_b : 0};
        demand(i == 0 || before(last, key, 3));
        demand(c->body_a != c->body_b && c->time >= 0 && c->time <= 1);
    }
}

static void check_same(const vox_grid* x, const vox_grid* y, int margin) {
    uint64_t a = 0, b = 1;
    demand(vox_grid_get_hash(x, &a) == VOX_OK && vox_grid_get_hash(y, &b) == VOX_OK && a == b);
    demand(vox_grid_edge_hash(x, &a) == VOX_OK && vox_grid_edge_hash(y, &b) == VOX_OK && a == b);
    vox_passage_view p, q;
    demand(vox_grid_passages(x, &p) == VOX_OK && vox_grid_passages(y, &q) == VOX_OK);
    demand(p.count == q.count && (p.count == 0 || memcmp(p.data, q.data, p.count * sizeof *p.data) == 0));
    if (!margin) return;
    vox_margin_contact_view m, n;
    demand(vox_grid_margin_contacts(x, &m) == VOX_OK && vox_grid_margin_contacts(y, &n) == VOX_OK);
    demand(m.count == n.count && (m.count == 0 || memcmp(m.data, n.data, m.count * sizeof *m.data) == 0));
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
        check(fast, &s);
        check_same(fast, reference, s.margin > 0);
        uint64_t with = 0, without = 1;
        demand(vox_grid_get_hash(fast, &with) == VOX_OK && vox_grid_get_hash(plain, &without) == VOX_OK &&
               with == without);
        demand(vox_grid_prepare_edge_depths(fast) == VOX_OK);
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
