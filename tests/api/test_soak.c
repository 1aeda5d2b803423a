/* A long life of two grids, one of each engine: random operations, after each of them a step, and a model of
 * what must hold. Environment: VOX_SOAK_STEPS (default 400), VOX_SOAK_SEED. ./dev soak takes 100,000 steps.
 */
#include <stdio.h>

#include "support/soak_model.h"

/* ---- operations: each changes both grids and the model ----
 *
 * One that steps by itself ends with meshes and positions as it found them, so that what touched before still
 * does. */

static void place(soak* s, member* m, uint32_t stride) {
    const float x = random_float(&s->random, -0.7f, 0.7f), y = random_float(&s->random, -0.7f, 0.7f),
                z = random_float(&s->random, -0.7f, 0.7f);
    const float offset[3] = {x, y, z};
    m->stride = stride;
    for (uint32_t v = 0; v < m->shape.vertex_count; ++v)
        for (uint32_t axis = 0; axis < 3; ++axis)
            m->positions[stride * v + axis] = m->shape.positions[3 * v + axis] + offset[axis];
}

/* A body of one's own to grow: 0 cubes a side are one vertex and no tets. */
static body make_shape(soak* s) {
    body shape = make_box(below(s, 4), 0.25f, -0.25f, -0.25f, -0.25f);
    shape.positions = (float*)realloc(shape.positions, 3 * max_vertices * sizeof(float));
    return shape;
}

static vox_filter random_filter(soak* s) {
    vox_filter filter = plain_filter();
    if (below(s, 2)) filter.group = (int32_t)below(s, 4) - 2;
    if (below(s, 2)) filter.category = 1u + below(s, 3);
    if (below(s, 2)) filter.mask = 1u + below(s, 3);
    filter.flags = below(s, 3) == 0 ? VOX_FILTER_SELF_COLLISION : 0u;
    filter.self_rings = below(s, 3);
    filter.self_rest_distance = below(s, 3) == 0 ? 0.2 : 0;
    return filter;
}

static void bind_all(soak* s, int g) {
    for (uint32_t i = 0; i < s->count; ++i)
        good(bind_array(s->grids[g], s->members[i].id, s->members[i].positions, VOX_FORMAT_FLOAT,
                        s->members[i].stride * sizeof(float), 0));
}

static void insert(soak* s) {
    if (s->count == max_members) return;
    member m;
    memset(&m, 0, sizeof m);
    m.shape = make_shape(s);
    m.user_data = random_next(&s->random);
    m.filter = plain_filter();
    if (below(s, 3) == 0) m.filter = random_filter(s);
    m.enabled = 1;
    place(s, &m, below(s, 2) ? 3 : 5);

    vox_body ids[2] = {0, 0};
    for (int g = 0; g < 2; ++g) {
        const vox_mesh_desc desc = member_desc(&m);
        if (below(s, 8) == 0) { /* it may fail once, and then has changed nothing */
            s->ledgers[g].fail_at = s->ledgers[g].calls + 1 + below(s, 12);
            const uint64_t bytes = s->ledgers[g].bytes;
            const vox_result result = vox_mesh_insert(s->grids[g], &desc, &ids[g]);
            s->ledgers[g].fail_at = 0;
            if (result == VOX_OK) continue;
            demand(result == VOX_ERROR_OUT_OF_MEMORY && ids[g] == 0);
            demand(s->ledgers[g].bytes >= bytes); /* room for slots may stay */
            ++s->failures;
        }
        good(vox_mesh_insert(s->grids[g], &desc, &ids[g]));
    }
    demand(ids[0] == ids[1]);
    m.id = ids[0];
    never_seen_before(s, m.id);
    uint32_t at = s->count++;
    for (; at > 0 && s->members[at - 1].id > m.id; --at) s->members[at] = s->members[at - 1];
    s->members[at] = m;
    for (int g = 0; g < 2; ++g) bind_all(s, g); /* members moved in memory */
}

static void forget(soak* s, uint32_t index) {
    const vox_body id = s->members[index].id;
    s->stale = id;
    free_body(&s->members[index].shape);
    memmove(s->members + index, s->members + index + 1, (--s->count - index) * sizeof(member));
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->excepted_count; ++i)
        if (s->excepted[i][0] != id && s->excepted[i][1] != id) {
            memmove(s->excepted[kept++], s->excepted[i], sizeof s->excepted[i]);
        }
    s->excepted_count = kept;
}

static void remove_one(soak* s) {
    if (s->count == 0) return;
    const uint32_t index = below(s, s->count);
    for (int g = 0; g < 2; ++g) good(vox_body_remove(s->grids[g], s->members[index].id));
    forget(s, index);
    for (int g = 0; g < 2; ++g) bind_all(s, g);
}

static void clear(soak* s) {
    if (below(s, 8)) return; /* seldom */
    for (int g = 0; g < 2; ++g) good(vox_grid_clear(s->grids[g]));
    while (s->count) forget(s, s->count - 1);
    s->last.count = 0;
    ++s->epoch;
}

static void jump(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    place(s, m, m->stride);
}

static void deform(soak* s) {
    for (uint32_t i = 0; i < s->count; ++i) {
        member* m = &s->members[i];
        if (below(s, 2)) continue;                     /* stays at rest */
        const float size = below(s, 4) ? 0.01f : 0.3f; /* seldom enough to turn tets inside out */
        for (uint32_t v = 0; v < m->shape.vertex_count; ++v)
            for (uint32_t axis = 0; axis < 3; ++axis)
                m->positions[m->stride * v + axis] += random_float(&s->random, -size, size);
    }
}

static void set_cell_size(soak* s) {
    static const double sizes[] = {0, 0, 0.05, 0.25, 1, 1000};
    for (int g = 0; g < 2; ++g) good(vox_grid_set_cell_size(s->grids[g], sizes[below(s, 6)]));
}

static void set_worker_count(soak* s) { good(vox_grid_set_worker_count(s->grids[0], 1 + below(s, 4))); }

static void set_filter(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    m->filter = random_filter(s);
    for (int g = 0; g < 2; ++g) good(vox_body_set_filter(s->grids[g], m->id, &m->filter));
}

static void set_enabled(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    m->enabled = below(s, 2);
    for (int g = 0; g < 2; ++g) good(vox_body_set_enabled(s->grids[g], m->id, m->enabled));
}

static void except_pair(soak* s) {
    if (s->count < 2) return;
    const uint32_t i = below(s, s->count), j = (i + 1 + below(s, s->count - 1)) % s->count;
    const vox_body a = s->members[i < j ? i : j].id, b = s->members[i < j ? j : i].id;
    uint32_t known = 0;
    while (known < s->excepted_count && (s->excepted[known][0] != a || s->excepted[known][1] != b)) ++known;
    const uint32_t enabled = known < s->excepted_count;
    for (int g = 0; g < 2; ++g) good(vox_grid_set_pair_enabled(s->grids[g], b, a, enabled));
    if (enabled) {
        memmove(s->excepted[known], s->excepted[--s->excepted_count], sizeof s->excepted[known]);
    } else {
        s->excepted[s->excepted_count][0] = a;
        s->excepted[s->excepted_count++][1] = b;
    }
}

static int may_fail(soak* s, int g, vox_result result) {
    s->ledgers[g].fail_at = 0;
    if (result == VOX_OK) return 0;
    demand(result == VOX_ERROR_OUT_OF_MEMORY);
    ++s->failures;
    return 1;
}

/* Calls an edit, which may fail once and then has changed nothing. */
#define edit(call)                                                                                           \
    do {                                                                                                     \
        if (below(s, 8) == 0) s->ledgers[g].fail_at = s->ledgers[g].calls + 1 + below(s, 6);                 \
        if (may_fail(s, g, call)) good(call);                                                                \
    } while (0)

/* Tets off, on again, or gone for good. */
static void cut(soak* s) {
    uint32_t tets[8], count = 0;
    member* m = s->count ? &s->members[below(s, s->count)] : NULL;
    if (!m || m->shape.tet_count == 0) return;
    const uint32_t how = below(s, 5), first = below(s, m->shape.tet_count);
    for (uint32_t t = first; t < m->shape.tet_count && count < 1 + first % 8; ++t)
        if (!m->removed[t]) tets[count++] = t;
    for (int g = 0; g < 2; ++g)
        if (how == 0)
            edit(vox_mesh_remove_tets(s->grids[g], m->id, tets, count));
        else
            edit(vox_mesh_set_tets_enabled(s->grids[g], m->id, tets, count, how > 2));
    for (uint32_t i = 0; i < count; ++i) {
        m->off[tets[i]] = how < 3;
        m->removed[tets[i]] = how == 0;
    }
}

/* A vertex becomes two, and some of its tets take the other one. */
static void split(soak* s) {
    uint32_t tets[max_tets], corners[4 * max_tets], count = 0;
    member* m = s->count ? &s->members[below(s, s->count)] : NULL;
    if (!m || m->shape.vertex_count == max_vertices) return;
    const uint32_t v = below(s, m->shape.vertex_count), copy = m->shape.vertex_count++;
    memcpy(m->positions + m->stride * copy, m->positions + m->stride * v, 3 * sizeof(float));
    memcpy(m->shape.positions + 3 * copy, m->shape.positions + 3 * v, 3 * sizeof(float));
    for (uint32_t t = 0; t < m->shape.tet_count; ++t) {
        uint32_t* tet = m->shape.tets + 4 * t;
        for (uint32_t c = 0; c < 4 && !m->removed[t]; ++c) {
            if (tet[c] != v || below(s, 2)) continue;
            tet[c] = copy;
            memcpy(corners + 4 * count, tet, 4 * sizeof(uint32_t));
            tets[count++] = t;
        }
    }
    vox_vertices_desc desc = vox_default_vertices_desc();
    desc.count = 1;
    desc.copies_of = &v;
    desc.positions = vox_float_positions(m->positions, m->shape.vertex_count);
    desc.positions.byte_stride = m->stride * sizeof(float);
    for (int g = 0; g < 2; ++g) {
        uint32_t first = 0;
        edit(vox_mesh_append_vertices(s->grids[g], m->id, &desc, &first));
        demand(first == copy);
        edit(vox_mesh_replace_tets(s->grids[g], m->id, tets, count, corners));
    }
}

/* Another body under the same id. */
static void regrow(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    free_body(&m->shape);
    m->shape = make_shape(s);
    memset(m->off, 0, sizeof m->off);
    memset(m->removed, 0, sizeof m->removed);
    place(s, m, m->stride);
    const vox_mesh_desc desc = member_desc(m);
    for (int g = 0; g < 2; ++g) edit(vox_mesh_set_topology(s->grids[g], m->id, &desc));
}

static void stale_ids(soak* s) {
    const uint32_t tet = 0;
    uint64_t user_data = 0;
    for (int g = 0; g < 2 && s->stale; ++g) {
        demand(vox_body_is_valid(s->grids[g], s->stale) == 0);
        demand(vox_body_remove(s->grids[g], s->stale) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_body_get_user_data(s->grids[g], s->stale, &user_data) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_body_set_enabled(s->grids[g], s->stale, 0) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_mesh_remove_tets(s->grids[g], s->stale, &tet, 1) == VOX_ERROR_INVALID_HANDLE);
    }
}

static void reserve(soak* s) {
    const uint32_t meshes = below(s, 2 * max_members), contacts = below(s, 1000);
    for (int g = 0; g < 2; ++g) good(vox_grid_reserve(s->grids[g], meshes, contacts));
    ++s->epoch;
}

/* A step that fails leaves no contacts and no pairs, and loses none: the next one is compared with the last
 * that succeeded. */
static void nothing_left(soak* s, int g) {
    vox_contact_view contacts;
    vox_pair_view pairs;
    vox_constraint_view constraints;
    good(vox_grid_get_contacts(s->grids[g], &contacts));
    good(vox_grid_get_pairs(s->grids[g], &pairs));
    demand(contacts.count == 0 && pairs.count == 0);
    demand(vox_grid_get_constraints(s->grids[g], &constraints) == VOX_ERROR_INVALID_STATE);
    ++s->failures;
}

static void step_over_nan(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    const uint32_t v = below(s, m->shape.vertex_count), axis = below(s, 3);
    float* coordinate = &m->positions[m->stride * v + axis];
    const float old = *coordinate;
    if (!m->enabled) return;
    *coordinate = below(s, 2) ? NAN : INFINITY;
    for (int g = 0; g < 2; ++g) {
        demand(vox_grid_step(s->grids[g]) == VOX_ERROR_NON_FINITE);
        nothing_left(s, g);
    }
    ++s->epoch;
    *coordinate = old;
}

static void step_without_memory(soak* s) {
    good(vox_grid_set_worker_count(s->grids[0], 1)); /* so that the n-th call is always the same one */
    int failed[2] = {0, 0};
    for (int g = 0; g < 2; ++g) {
        s->ledgers[g].fail_at = s->ledgers[g].calls + 1 + below(s, 4);
        const vox_result result = vox_grid_step(s->grids[g]);
        s->ledgers[g].fail_at = 0;
        demand(result == VOX_OK || result == VOX_ERROR_OUT_OF_MEMORY);
        failed[g] = result != VOX_OK;
        if (failed[g]) nothing_left(s, g);
    }
    ++s->epoch;
    for (int g = 0; g < 2; ++g) /* both get a step that succeeded */
        if (failed[0] || failed[1]) good(vox_grid_step(s->grids[g]));
    if (failed[0] || failed[1]) ++s->epoch;
}

/* A grid is replaced by what its snapshot holds. */
static void save_and_load(soak* s) {
    const int g = (int)below(s, 2);
    uint64_t size = 0;
    vox_grid* loaded = NULL;
    good(vox_grid_save(s->grids[g], NULL, 0, &size));
    void* bytes = malloc((size_t)size);
    good(vox_grid_save(s->grids[g], bytes, size, &size));
    const vox_grid_desc desc = grid_desc(s, g);
    good(vox_grid_load(bytes, size, &desc, &loaded));
    vox_grid_destroy(s->grids[g]);
    s->grids[g] = loaded;
    free(bytes);
    if (below(s, 2)) { /* a step over the positions that it brought along, too */
        for (int i = 0; i < 2; ++i) good(vox_grid_step(s->grids[i]));
        ++s->epoch;
    } else if (g == 0) {
        s->last.count = 0; /* a snapshot has no results */
    }
    bind_all(s, g);
}

/* Going to and fro between two states, nothing is allocated any more once both have been passed through twice
 * (the first time, the engine does not know yet who is at rest). */
static void steady_state(soak* s) {
    static float here[max_members]
                     [5 * max_vertices]; /* coming back by sums would not lead to the same bits */
    uint64_t calls[2] = {0, 0};
    good(vox_grid_set_worker_count(s->grids[0], 1));
    for (uint32_t i = 0; i < s->count; ++i) memcpy(here[i], s->members[i].positions, sizeof here[i]);
    for (int round = 0; round < 6; ++round) {
        if (round == 4)
            for (int g = 0; g < 2; ++g) calls[g] = s->ledgers[g].calls;
        for (uint32_t i = 0; i < s->count; ++i) {
            member* m = &s->members[i];
            memcpy(m->positions, here[i], sizeof here[i]);
            for (uint32_t v = 0; round % 2 == 0 && i % 2 && v < m->shape.vertex_count; ++v)
                m->positions[m->stride * v] += 0.0625f;
        }
        for (int rest = 0; rest < 3; ++rest, ++s->epoch)
            for (int g = 0; g < 2; ++g) good(vox_grid_step(s->grids[g]));
    }
    for (int g = 0; g < 2; ++g) demand(s->ledgers[g].calls == calls[g]);
}

typedef struct operation {
    const char* name;
    void (*run)(soak* s);
    uint32_t weight;
} operation;

static const operation operations[] = {
    {"insert", insert, 20},
    {"remove", remove_one, 12},
    {"clear", clear, 4},
    {"jump", jump, 30},
    {"deform", deform, 30},
    {"cell size", set_cell_size, 5},
    {"worker count", set_worker_count, 5},
    {"filter", set_filter, 8},
    {"enable", set_enabled, 8},
    {"except", except_pair, 8},
    {"cut", cut, 24},
    {"split", split, 12},
    {"regrow", regrow, 4},
    {"stale ids", stale_ids, 2},
    {"reserve", reserve, 2},
    {"not finite", step_over_nan, 3},
    {"no memory", step_without_memory, 5},
    {"save and load", save_and_load, 5},
    {"steady state", steady_state, 2},
};
enum { operation_count = sizeof operations / sizeof *operations };

/* ---- the life ---- */

static void step(soak* s) {
    for (int g = 0; g < 2; ++g) good(vox_grid_step(s->grids[g]));
    ++s->epoch;
}

START_TEST(soak_life) {
    soak* s = (soak*)calloc(1, sizeof *s);
    const uint32_t steps = (uint32_t)volume_from("VOX_SOAK_STEPS", 400);
    uint32_t runs[operation_count] = {0}, total = 0;
    soak_seed = number_from("VOX_SOAK_SEED", 1);
    s->random = soak_seed;
    s->operation = "create";
    s->ids_given_out = (vox_body*)calloc(id_table, sizeof(vox_body));
    for (int g = 0; g < 2; ++g) {
        const vox_grid_desc desc = grid_desc(s, g);
        good(vox_grid_create(&desc, &s->grids[g]));
    }
    for (int i = 0; i < operation_count; ++i) total += operations[i].weight;

    for (s->step = 0; s->step < steps; ++s->step) {
        uint32_t chosen = 0, draw = below(s, total);
        while (draw >= operations[chosen].weight) draw -= operations[chosen++].weight;
        s->operation = operations[chosen].name;
        ++runs[chosen];
        operations[chosen].run(s);
        step(s);
        check(s);
        remember(s);

        uint64_t* most = &s->most_bytes[(uint64_t)s->step * 4 / steps];
        if (*most < s->ledgers[0].bytes + s->ledgers[1].bytes)
            *most = s->ledgers[0].bytes + s->ledgers[1].bytes;
    }

    s->operation = "end";
    for (int i = 0; i < operation_count; ++i) demand(runs[i] > 0 || steps < 300);
    demand(s->contacts > steps && s->changes > steps / 10 && s->failures > 0);
    /* Buffers have found their size in the first half, whatever comes: a leak would show in the last quarter.
     */
    if (steps >= 10000) demand(s->most_bytes[3] <= s->most_bytes[0] + s->most_bytes[0] / 4);
    while (s->count) forget(s, s->count - 1);
    for (int g = 0; g < 2; ++g) {
        vox_grid_destroy(s->grids[g]);
        demand(s->ledgers[g].bytes == 0);
    }
    printf("%u steps: %llu contacts, %llu pairs began or ended, %llu failures; at most %llu, %llu, %llu, "
           "%llu bytes in "
           "the quarters\n",
           steps, (unsigned long long)s->contacts, (unsigned long long)s->changes,
           (unsigned long long)s->failures, (unsigned long long)s->most_bytes[0],
           (unsigned long long)s->most_bytes[1], (unsigned long long)s->most_bytes[2],
           (unsigned long long)s->most_bytes[3]);
    free(s->ids_given_out);
    free(s->last.data);
    free(s);
}
END_TEST

SUITE(soak) {
    TCase* tests = add_case(suite, "soak");
    tcase_add_test(tests, soak_life);
}
