/* Random edits of meshes: after each of them the grid finds what a new grid finds of what is left. */
#include <stdio.h>

#include "support/cutting_model.h"

static uint32_t below(cut_scene* s, uint32_t count) { return random_below(&s->random, count); }

static cut_mesh* some_mesh(cut_scene* s) { return &s->meshes[below(s, s->count)]; }

/* ---- edits, of the model and of the grid ---- */

/* A few tets with neighbouring indices, in [0, tets); of states that the mask has. */
static uint32_t some_tets(cut_scene* s, const cut_mesh* m, uint32_t states, uint32_t most, uint32_t* out) {
    uint32_t count = 0;
    if (m->tets == 0) return 0;
    for (uint32_t i = 0, t = below(s, m->tets); i < 4 * most && count < most; ++i, t = (t + 1) % m->tets)
        if (states >> m->state[t] & 1) out[count++] = t;
    return count;
}

static void set_enabled(cut_scene* s, cut_mesh* m) {
    uint32_t tets[64];
    const uint32_t enabled = below(s, 2);
    uint32_t count = some_tets(s, m, 1u << tet_on | 1u << tet_off, 1 + below(s, below(s, 8) ? 6 : 60), tets);
    if (count > 1 && below(s, 4) == 0) tets[count - 1] = tets[0]; /* one twice */
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) { /* none that names a vertex which is gone */
        int whole = 1;
        for (uint32_t c = 0; c < 4; ++c) whole &= !m->gone[m->corners[4 * tets[i] + c]];
        if (whole || !enabled) tets[kept++] = tets[i];
    }
    ck_ok(vox_mesh_set_tets_enabled(s->grid, m->id, tets, kept, enabled));
    for (uint32_t i = 0; i < kept; ++i) m->state[tets[i]] = enabled ? tet_on : tet_off;
}

static void remove_tets(cut_scene* s, cut_mesh* m) {
    uint32_t tets[8];
    const uint32_t count = some_tets(s, m, 1u << tet_on | 1u << tet_off, 1 + below(s, 4), tets);
    ck_ok(vox_mesh_remove_tets(s->grid, m->id, tets, count));
    for (uint32_t i = 0; i < count; ++i) m->state[tets[i]] = tet_removed;
}

/* A vertex that may be named. */
static uint32_t some_vertex(cut_scene* s, const cut_mesh* m) {
    for (;;) {
        const uint32_t v = below(s, m->vertices);
        if (!m->gone[v]) return v;
    }
}

static uint32_t append_vertices(cut_scene* s, cut_mesh* m, uint32_t count, const uint32_t* copies_of) {
    vox_vertices_desc desc = vox_default_vertices_desc();
    uint32_t first = no_number;
    const uint32_t had = m->vertices;
    const int with_rest = !copies_of || below(s, 2);
    double* given = (double*)malloc(3 * sizeof(double) * m->most_vertices);
    double* rest = (double*)malloc(3 * sizeof(double) * (count + 1));
    double* new_rest = rest;
    if (had + count > m->most_vertices) ck_abort_msg("the test has no room");
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t near = copies_of ? copies_of[i] : some_vertex(s, m);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            m->positions[3 * (had + i) + axis] =
                m->positions[3 * near + axis] + (copies_of ? 0 : (float)below(s, 5) * 0.0625f - 0.125f);
            m->rest[3 * (had + i) + axis] =
                with_rest && !copies_of ? (float)below(s, 64) * 0.03125f : m->rest[3 * near + axis];
        }
        m->gone[had + i] = 0;
    }
    for (uint32_t i = 0; i < 3 * count; ++i)
        if (m->doubles)
            rest[i] = m->rest[3 * had + i];
        else
            ((float*)(void*)new_rest)[i] = m->rest[3 * had + i];
    m->vertices = had + count;
    desc.count = count;
    desc.copies_of = copies_of;
    const vox_format format = m->doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    const vox_positions of_new = {given, count, format, 0, 0, 0},
                        rest_of_new = {rest, count, format, 0, 0, 0};
    if (with_rest) desc.rest_positions = rest_of_new;
    if (m->owned) {
        write_positions(m, m->positions + 3 * had, count, given);
        if (!copies_of || below(s, 2)) desc.positions = of_new;
    } else { /* another array, and the one before is no good any more */
        void* array = calloc(3 * m->most_vertices, sizeof(double));
        memset(m->borrowed, 0xff, 3 * had * (m->doubles ? sizeof(double) : sizeof(float)));
        write_positions(m, m->positions, m->vertices, array);
        const vox_positions all = {array, m->vertices, format, 0, 0, 0};
        desc.positions = all;
        ck_ok(vox_mesh_append_vertices(s->grid, m->id, &desc, &first));
        free(m->borrowed);
        m->borrowed = array;
    }
    if (m->owned) ck_ok(vox_mesh_append_vertices(s->grid, m->id, &desc, &first));
    ck_assert_uint_eq(first, had);
    free(given);
    free(rest);
    return first;
}

static void loose_vertices(cut_scene* s, cut_mesh* m) {
    const uint32_t count = 1 + below(s, 3);
    if (m->vertices + count <= m->most_vertices) (void)append_vertices(s, m, count, NULL);
}

/* Splits a vertex: some of the tets around it name a copy. */
static void split(cut_scene* s, cut_mesh* m) {
    uint32_t tets[64], corners[4 * 64], count = 0;
    if (m->vertices == m->most_vertices) return;
    const uint32_t v = some_vertex(s, m), copy = append_vertices(s, m, 1, &v);
    for (uint32_t t = 0; t < m->tets && count < 64; ++t) {
        if (m->state[t] == tet_removed || below(s, 2)) continue;
        const uint32_t* old = m->corners + 4 * t;
        if (old[0] != v && old[1] != v && old[2] != v && old[3] != v) continue;
        int whole = 1;
        for (uint32_t c = 0; c < 4; ++c) {
            corners[4 * count + c] = old[c] == v ? copy : old[c];
            whole &= !m->gone[old[c]];
        }
        if (whole) tets[count++] = t;
    }
    ck_ok(vox_mesh_replace_tets(s->grid, m->id, tets, count, corners));
    for (uint32_t i = 0; i < count; ++i)
        memcpy(m->corners + 4 * tets[i], corners + 4 * i, 4 * sizeof(uint32_t));
}

/* Anything: doubled tets, facets of many, vertices named twice. */
static void some_corners(cut_scene* s, const cut_mesh* m, uint32_t count, uint32_t* corners) {
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t like = below(s, m->tets);
        for (uint32_t c = 0; c < 4; ++c) {
            const uint32_t v = m->corners[4 * like + c];
            corners[4 * i + c] = m->gone[v] || below(s, 3) == 0 ? some_vertex(s, m) : v;
        }
        if (below(s, 16) == 0) corners[4 * i + 3] = corners[4 * i];
    }
}

static void replace_tets(cut_scene* s, cut_mesh* m) {
    uint32_t tets[8], corners[32];
    const uint32_t count = some_tets(s, m, 1u << tet_on | 1u << tet_off, 1 + below(s, 4), tets);
    if (count > 1 && below(s, 4) == 0) tets[count - 1] = tets[0]; /* one twice: the last counts */
    if (count) some_corners(s, m, count, corners);
    ck_ok(vox_mesh_replace_tets(s->grid, m->id, tets, count, corners));
    for (uint32_t i = 0; i < count; ++i)
        memcpy(m->corners + 4 * tets[i], corners + 4 * i, 4 * sizeof(uint32_t));
}

static void append_tets(cut_scene* s, cut_mesh* m) {
    uint32_t corners[32], first = no_number;
    const uint32_t count = 1 + below(s, 8);
    if (m->tets + count > m->most_tets || m->tets == 0) return;
    some_corners(s, m, count, corners);
    ck_ok(vox_mesh_append_tets(s->grid, m->id, corners, count, &first));
    ck_assert_uint_eq(first, m->tets);
    memcpy(m->corners + 4 * m->tets, corners, 4 * sizeof(uint32_t) * count);
    memset(m->state + m->tets, tet_on, count);
    m->tets += count;
}

static void remove_vertices(cut_scene* s, cut_mesh* m) {
    uint32_t vertices[8], count = 0;
    count_names(m);
    for (uint32_t i = 0, v = below(s, m->vertices); i < m->vertices && count < 2;
         ++i, v = (v + 1) % m->vertices)
        if (m->names[v] == 0 && !m->gone[v]) vertices[count++] = v;
    ck_ok(vox_mesh_remove_vertices(s->grid, m->id, vertices, count));
    for (uint32_t i = 0; i < count; ++i) m->gone[vertices[i]] = 1;
}

/* Replaces everything: a box, or other tets over the same vertices. */
static void set_topology(cut_scene* s, cut_mesh* m) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    float* rest = NULL;
    if (below(s, 3)) {
        const uint32_t cubes = 1 + below(s, 5), x = below(s, 8), y = below(s, 8);
        body box = make_box(cubes, 0.25f, (float)x * 0.125f, (float)y * 0.125f, 0.25f);
        m->doubles = (int)below(s, 2);
        m->owned = (int)below(s, 2);
        set_model(m, &box);
        free_body(&box);
        write_positions(m, m->positions, m->vertices, m->borrowed);
        desc.positions.data = m->borrowed;
        rest = (float*)malloc(3 * sizeof(double) * m->vertices);
        for (uint32_t i = 0; i < 3 * m->vertices; ++i)
            if (m->doubles)
                ((double*)(void*)rest)[i] = m->rest[i];
            else
                rest[i] = m->rest[i];
        desc.rest_positions.data = rest;
        desc.rest_positions.count = m->vertices;
        desc.rest_positions.format = m->doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    } else {
        rest_of_mesh left = leave_rest(m);
        uint32_t* corners = (uint32_t*)calloc(4 * (left.mesh.tets + 1), sizeof(uint32_t));
        for (uint32_t i = 0; i < left.mesh.tets; ++i)
            memcpy(corners + 4 * i, m->corners + 4 * left.tet[i], 4 * sizeof(uint32_t));
        memcpy(m->corners, corners, 4 * sizeof(uint32_t) * left.mesh.tets);
        m->tets = left.mesh.tets;
        memset(m->state, tet_on, m->most_tets);
        memset(m->gone, 0, m->most_vertices);
        free(corners);
        free(left.vertex);
        free(left.tet);
        free_model(&left.mesh);
    }
    desc.positions.count = m->vertices;
    desc.tets = m->corners;
    desc.tet_count = m->tets;
    desc.positions.format = m->doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    if (m->owned && desc.positions.data) desc.flags = VOX_MESH_COPY_POSITIONS;
    ck_ok(vox_mesh_set_topology(s->grid, m->id, &desc));
    free(rest);
}

static void set_filter(cut_scene* s, cut_mesh* m) {
    m->filter.flags = below(s, 4) != 0 ? VOX_FILTER_SELF_COLLISION : 0u;
    m->filter.self_rings = below(s, 4) ? 0 : 1 + below(s, 2);
    m->filter.self_rest_distance = below(s, 3) ? 0 : 0.25;
    ck_ok(vox_body_set_filter(s->grid, m->id, &m->filter));
}

static void move_some(cut_scene* s, cut_mesh* m) {
    const uint32_t how = below(s, 4);
    const float by = (float)below(s, 9) * 0.0625f - 0.25f;
    if (how == 0) return; /* at rest */
    if (how == 1)
        for (uint32_t v = 0; v < m->vertices; ++v) m->positions[3 * v + below(s, 1)] += by;
    if (how == 2)
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t v = below(s, m->vertices), axis = below(s, 3);
            m->positions[3 * v + axis] += by;
        }
    if (how == 3)
        for (uint32_t i = 0; i < 3 * m->vertices; ++i)
            m->positions[i] = (float)(m->positions[i] + random_float(&s->random, -0.01f, 0.01f));
}

/* Calls that fail. The comparison shows that they changed nothing. */
static void bad_calls(cut_scene* s, cut_mesh* m) {
    const uint32_t beyond_tets[2] = {0, m->tets}, beyond[4] = {0, 0, 0, m->vertices};
    uint32_t first = no_number;
    ck_fails(vox_mesh_set_tets_enabled(s->grid, m->id, beyond_tets, 2, 0), VOX_ERROR_INVALID_ARGUMENT,
             "tets[");
    ck_fails(vox_mesh_append_tets(s->grid, m->id, beyond, 1, &first), VOX_ERROR_INVALID_MESH, "names vertex");
    for (uint32_t t = 0; t < m->tets; ++t)
        if (m->state[t] == tet_removed) {
            const uint32_t tets[1] = {t};
            ck_fails(vox_mesh_set_tets_enabled(s->grid, m->id, tets, 1, 1), VOX_ERROR_INVALID_ARGUMENT,
                     "was removed");
            break;
        }
    for (uint32_t v = 0; v < m->vertices; ++v)
        if (m->gone[v]) {
            const uint32_t corners[4] = {v, v, v, v};
            ck_fails(vox_mesh_append_tets(s->grid, m->id, corners, 1, &first), VOX_ERROR_INVALID_MESH,
                     "was removed");
            break;
        }
    count_names(m);
    for (uint32_t v = 0; v < m->vertices; ++v)
        if (m->names[v]) {
            ck_fails(vox_mesh_remove_vertices(s->grid, m->id, &v, 1), VOX_ERROR_INVALID_ARGUMENT,
                     "is a corner of tet");
            break;
        }
    ck_assert_uint_eq(first, no_number);
}

/* Goes on with what a snapshot holds; there the meshes own their positions. */
static void save_and_load(cut_scene* s) {
    uint64_t size = 0;
    vox_grid* loaded = NULL;
    ck_ok(vox_grid_save(s->grid, NULL, 0, &size));
    void* bytes = malloc((size_t)size);
    ck_ok(vox_grid_save(s->grid, bytes, size, &size));
    ck_ok(vox_grid_load(bytes, size, NULL, &loaded));
    vox_grid_destroy(s->grid);
    s->grid = loaded;
    free(bytes);
    for (uint32_t i = 0; i < s->count; ++i) s->meshes[i].owned = 1;
    s->last.count = 0; /* no results of the last step */
}

static void edit(cut_scene* s) {
    cut_mesh* m = some_mesh(s);
    const uint32_t draw = below(s, 100);
    if (draw < 24)
        set_enabled(s, m);
    else if (draw < 32)
        remove_tets(s, m);
    else if (draw < 54)
        split(s, m);
    else if (draw < 64)
        replace_tets(s, m);
    else if (draw < 76)
        append_tets(s, m);
    else if (draw < 80)
        loose_vertices(s, m);
    else if (draw < 86)
        remove_vertices(s, m);
    else if (draw < 88)
        set_topology(s, m);
    else if (draw < 93)
        set_filter(s, m);
    else if (draw < 96)
        bad_calls(s, m);
    else if (draw < 97)
        save_and_load(s);
    else
        ck_ok(vox_grid_set_cell_size(s->grid, below(s, 2) ? 0 : 0.2));
}

static vox_grid_desc edited_desc(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    return desc;
}

static void run_edits(uint64_t seed, uint32_t edits) {
    cut_scene s;
    const vox_grid_desc desc = edited_desc();
    vox_grid_desc fresh = desc;
    memset(&s, 0, sizeof s);
    s.random = seed;
    s.count = most_cut_meshes;
    use_engine(&fresh, seed % 2 ? ENGINE_FAST : ENGINE_REFERENCE);
    ck_ok(vox_grid_create(&desc, &s.grid));
    for (uint32_t i = 0; i < s.count; ++i) {
        cut_mesh* m = &s.meshes[i];
        body box = make_box(3 + i % 3, 0.25f, 0.375f * (float)i, 0.125f * (float)i, 0.0625f * (float)(i % 2));
        make_model(m, &box, 800, 1200);
        free_body(&box);
        m->doubles = i % 2 == 1;
        m->owned = i / 2 == 1;
        m->user_data = 100 + i;
        m->filter = plain_filter();
        m->filter.flags = i != 3 ? VOX_FILTER_SELF_COLLISION : 0u;
        m->filter.self_rings = i == 1;
        m->filter.self_rest_distance = i == 2 ? 0.125 : 0;
        insert_model(&s, m);
    }
    for (uint32_t i = 0; i < edits; ++i) {
        uint32_t at_once = 1;
        if (below(&s, 4) == 0) at_once += below(&s, 4);
        while (at_once-- > 0) edit(&s);
        for (uint32_t b = 0; b < s.count; ++b) {
            if (below(&s, 2)) move_some(&s, &s.meshes[b]);
            show_positions(&s, &s.meshes[b]);
        }
        step_and_compare(&s, &fresh);
    }
    printf("%llu contacts, %llu carried, %llu constraints, %llu pairs began or ended\n",
           (unsigned long long)s.contacts, (unsigned long long)s.carried, (unsigned long long)s.constraints,
           (unsigned long long)s.changes);
    ck_assert(s.contacts > 10 * edits && s.constraints > 5 * edits && s.changes > edits / 20);
    vox_grid_destroy(s.grid);
    for (uint32_t i = 0; i < s.count; ++i) free_model(&s.meshes[i]);
    free(s.last.data);
}

START_TEST(thousand_edits) { run_edits((uint64_t)_i + 1, 500); }
END_TEST

static void add_tests(TCase* tests) { tcase_add_loop_test(tests, thousand_edits, 0, 2); }

SUITE(cutting) { add_for_each_engine(suite, add_tests); }
