/* A model of meshes that are cut: plain arrays. A new grid is made of what the model has left, and the grid
 * that went through the edits is compared with it. */
#ifndef VOX_TESTS_CUTTING_MODEL_H
#define VOX_TESTS_CUTTING_MODEL_H

#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/constraint_checks.h"

enum { tet_on, tet_off, tet_removed };
enum { most_cut_meshes = 4 };
#define no_number 0xffffffffu

typedef struct cut_mesh {
    vox_body id;
    uint32_t vertices, tets, most_vertices, most_tets;
    double* positions; /* floats where the mesh has floats */
    float* rest;
    uint32_t* corners;
    uint8_t* state;  /* of each tet */
    uint8_t* gone;   /* vertices that were removed */
    uint32_t* names; /* of each vertex, how many tets that are on name it; made when asked for */
    int doubles, owned;
    void* borrowed; /* what the grid reads unless the mesh owns its positions */
    vox_filter filter;
    uint64_t user_data;
} cut_mesh;

typedef struct cut_scene {
    uint64_t random;
    vox_grid* grid;
    cut_mesh meshes[most_cut_meshes];
    uint32_t count;
    uint8_t was[most_cut_meshes][most_cut_meshes];    /* which touched in the last step */
    kept_constraints last;                            /* of the last step; none after a load */
    uint64_t contacts, constraints, changes, carried; /* sums over all steps */
} cut_scene;

static inline size_t position_bytes(const cut_mesh* m) {
    return m->doubles ? 3 * sizeof(double) : 3 * sizeof(float);
}

static inline void write_positions(const cut_mesh* m, const double* from, uint32_t count, void* to) {
    for (uint32_t i = 0; i < 3 * count; ++i)
        if (m->doubles)
            ((double*)to)[i] = from[i];
        else
            ((float*)to)[i] = (float)from[i];
}

/* Gives the grid the positions of the model. */
static inline void show_positions(cut_scene* s, cut_mesh* m) {
    void* to = m->borrowed;
    if (m->owned) ck_ok(vox_mesh_map_positions(s->grid, m->id, &to));
    write_positions(m, m->positions, m->vertices, to);
}

/* Makes the model a copy of a body with all tets on. */
static inline void set_model(cut_mesh* m, const body* shape) {
    m->vertices = shape->vertex_count;
    m->tets = shape->tet_count;
    for (uint32_t i = 0; i < 3 * m->vertices; ++i) {
        m->positions[i] = shape->positions[i];
        m->rest[i] = shape->positions[i];
    }
    if (m->tets) memcpy(m->corners, shape->tets, 4 * sizeof(uint32_t) * m->tets);
    memset(m->state, tet_on, m->most_tets);
    memset(m->gone, 0, m->most_vertices);
}

static inline void make_model(cut_mesh* m, const body* shape, uint32_t more_vertices, uint32_t more_tets) {
    m->most_vertices = shape->vertex_count + more_vertices;
    m->most_tets = shape->tet_count + more_tets;
    m->positions = (double*)calloc(3 * m->most_vertices, sizeof(double));
    m->rest = (float*)calloc(3 * m->most_vertices, sizeof(float));
    m->corners = (uint32_t*)calloc(4 * m->most_tets, sizeof(uint32_t));
    m->state = (uint8_t*)calloc(m->most_tets, 1);
    m->gone = (uint8_t*)calloc(m->most_vertices, 1);
    m->names = (uint32_t*)calloc(m->most_vertices, sizeof(uint32_t));
    m->borrowed = calloc(3 * m->most_vertices, sizeof(double));
    set_model(m, shape);
}

static inline void free_model(cut_mesh* m) {
    free(m->positions);
    free(m->rest);
    free(m->corners);
    free(m->state);
    free(m->gone);
    free(m->names);
    free(m->borrowed);
}

static inline void insert_model(cut_scene* s, cut_mesh* m) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    float* rest = (float*)malloc(3 * sizeof(double) * m->vertices);
    write_positions(m, m->positions, m->vertices, m->borrowed);
    for (uint32_t i = 0; i < 3 * m->vertices; ++i)
        if (m->doubles)
            ((double*)(void*)rest)[i] = m->rest[i];
        else
            rest[i] = m->rest[i];
    desc.positions.data = m->borrowed;
    desc.positions.format = m->doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    desc.positions.count = m->vertices;
    desc.tets = m->corners;
    desc.tet_count = m->tets;
    desc.filter = m->filter;
    desc.rest_positions = desc.positions;
    desc.rest_positions.data = rest;
    desc.user_data = m->user_data;
    if (m->owned) desc.flags = VOX_MESH_COPY_POSITIONS;
    ck_ok(vox_mesh_insert(s->grid, &desc, &m->id));
    free(rest);
}

static inline void count_names(cut_mesh* m) {
    memset(m->names, 0, m->most_vertices * sizeof(uint32_t));
    for (uint32_t t = 0; t < m->tets; ++t)
        for (uint32_t c = 0; c < 4 && m->state[t] == tet_on; ++c) ++m->names[m->corners[4 * t + c]];
}

/* ---- the comparison ---- */

/* What is left of a model, and the indices that it had there. */
typedef struct rest_of_mesh {
    cut_mesh mesh;
    uint32_t *vertex, *tet;
} rest_of_mesh;

static inline rest_of_mesh leave_rest(const cut_mesh* m) {
    rest_of_mesh r;
    uint32_t* new_vertex = (uint32_t*)malloc((m->vertices + 1) * sizeof(uint32_t));
    const body none = {NULL, NULL, 0, 0};
    memset(&r, 0, sizeof r);
    make_model(&r.mesh, &none, m->vertices + 1, m->tets + 1);
    r.vertex = (uint32_t*)malloc((m->vertices + 1) * sizeof(uint32_t));
    r.tet = (uint32_t*)malloc((m->tets + 1) * sizeof(uint32_t));
    r.mesh.doubles = m->doubles;
    r.mesh.filter = m->filter;
    r.mesh.user_data = m->user_data;
    for (uint32_t v = 0; v < m->vertices; ++v) {
        new_vertex[v] = m->gone[v] ? no_number : r.mesh.vertices;
        if (m->gone[v]) continue;
        memcpy(r.mesh.positions + 3 * r.mesh.vertices, m->positions + 3 * v, 3 * sizeof(double));
        memcpy(r.mesh.rest + 3 * r.mesh.vertices, m->rest + 3 * v, 3 * sizeof(float));
        r.vertex[r.mesh.vertices++] = v;
    }
    for (uint32_t t = 0; t < m->tets; ++t) {
        if (m->state[t] != tet_on) continue;
        for (uint32_t c = 0; c < 4; ++c)
            r.mesh.corners[4 * r.mesh.tets + c] = new_vertex[m->corners[4 * t + c]];
        r.tet[r.mesh.tets++] = t;
    }
    free(new_vertex);
    return r;
}

/* Which pairs touched, and touch: each persists, begins or ends. */
static inline void check_cut_pairs(cut_scene* s) {
    const vox_contact_view contacts = contacts_of(s->grid);
    const vox_pair_view pairs = pairs_of(s->grid);
    uint8_t is[most_cut_meshes][most_cut_meshes] = {{0}};
    uint64_t next = 0;
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const uint32_t a = vox_body_slot(contacts.data[i].body_a), b = vox_body_slot(contacts.data[i].body_b);
        is[a < b ? a : b][a < b ? b : a] = 1;
    }
    for (uint32_t a = 0; a < s->count; ++a)
        for (uint32_t b = a; b < s->count; ++b) {
            if (!s->was[a][b] && !is[a][b]) continue;
            ck_assert_uint_lt(next, pairs.count);
            const vox_pair* pair = &pairs.data[next++];
            ck_assert(pair->body_a == s->meshes[a].id && pair->body_b == s->meshes[b].id);
            ck_assert_int_eq(pair->state, !s->was[a][b] ? VOX_PAIR_BEGAN
                                          : is[a][b]    ? VOX_PAIR_PERSISTED
                                                        : VOX_PAIR_ENDED);
            s->changes += pair->state != VOX_PAIR_PERSISTED;
        }
    ck_assert_uint_eq(next, pairs.count);
    memcpy(s->was, is, sizeof is);
}

/* What a constraint of a new grid, whose slots are 0, 1, ..., is in the grid that it stands for. */
static inline vox_constraint renamed(const cut_scene* s, const rest_of_mesh* rest, vox_constraint c) {
    const uint32_t a = vox_body_slot(c.body_a), b = vox_body_slot(c.body_b);
    c.body_a = s->meshes[a].id;
    c.body_b = s->meshes[b].id;
    for (uint32_t i = 0; i < c.count; ++i) c.vertices[i] = rest[i < c.count_a ? a : b].vertex[c.vertices[i]];
    c.element_b = rest[b].tet[c.element_b];
    return c;
}

/* Steps, and compares all results with those of a new grid over what is left of the meshes. */
static inline void step_and_compare(cut_scene* s, const vox_grid_desc* desc) {
    rest_of_mesh rest[most_cut_meshes];
    cut_scene other;
    memset(&other, 0, sizeof other);
    ck_ok(vox_grid_step(s->grid));
    ck_ok(vox_grid_create(desc, &other.grid));
    for (uint32_t i = 0; i < s->count; ++i) {
        rest[i] = leave_rest(&s->meshes[i]);
        insert_model(&other, &rest[i].mesh);
    }
    ck_ok(vox_grid_step(other.grid));
    vox_contact_view mine = contacts_of(s->grid);
    vox_contact_view fresh = contacts_of(other.grid);
    ck_assert_uint_eq(mine.count, fresh.count);
    for (uint64_t i = 0; i < mine.count; ++i) {
        vox_contact c = fresh.data[i];
        const uint32_t a = vox_body_slot(c.body_a), b = vox_body_slot(c.body_b);
        c.body_a = s->meshes[a].id;
        c.body_b = s->meshes[b].id;
        c.vertex = rest[a].vertex[c.vertex];
        c.tet = rest[b].tet[c.tet];
        ck_assert_msg(
            memcmp(&c, &mine.data[i], sizeof c) == 0,
            "contact %llu is vertex %u of mesh %u in tet %u of mesh %u, expected %u of %u in %u of %u",
            (unsigned long long)i, mine.data[i].vertex, mine.data[i].body_a, mine.data[i].tet,
            mine.data[i].body_b, c.vertex, c.body_a, c.tet, c.body_b);
    }
    const vox_constraint_view found = constraints_of(s->grid), expected = constraints_of(other.grid);
    ck_assert_uint_eq(found.count, expected.count);
    for (uint64_t i = 0; i < found.count; ++i) {
        vox_constraint c = renamed(s, rest, expected.data[i]);
        c.pair = found.data[i].pair; /* there are pairs that ended, too */
        c.previous = found.data[i].previous;
        ck_assert_msg(memcmp(&c, &found.data[i], sizeof c) == 0,
                      "constraint %llu: vertex %u of mesh %u in mesh %u, state %d gap %.17g, expected vertex "
                      "%u of mesh "
                      "%u in mesh %u, state %d gap %.17g",
                      (unsigned long long)i, found.data[i].vertices[0], found.data[i].body_a,
                      found.data[i].body_b, (int)found.data[i].state, found.data[i].gap, c.vertices[0],
                      c.body_a, c.body_b, (int)c.state, c.gap);
    }
    check_previous(s->grid, &s->last);
    const grid_counts counters = counters_of(s->grid), fresh_counters = counters_of(other.grid);
    ck_assert_uint_eq(counters.tets, fresh_counters.tets);
    if (suite_engine == ENGINE_REFERENCE && desc->reference) /* which meets all of them */
        ck_assert_uint_eq(counters.skipped_degenerate, fresh_counters.skipped_degenerate);
    check_cut_pairs(s);
    free(s->last.data);
    s->last = keep_constraints(s->grid);
    s->contacts += mine.count;
    s->constraints += found.count;
    s->carried += counters.carried_contacts;
    vox_grid_destroy(other.grid);
    for (uint32_t i = 0; i < s->count; ++i) {
        free(rest[i].vertex);
        free(rest[i].tet);
        free_model(&rest[i].mesh);
    }
}

#endif
