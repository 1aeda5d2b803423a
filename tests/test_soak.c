/* A long life of two grids, one of each engine: random operations, after each of them a step, and a model of
 * what must hold. Environment: VOX_SOAK_STEPS (default 400), VOX_SOAK_SEED. ./dev soak takes 100,000 steps.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bodies.h"
#include "ledger.h"
#include "random.h"
#include "suite.h"

enum {
    max_members = 14,
    max_vertices = 80, /* of a body: a box of 3 * 3 * 3 cubes has 64 */
    max_tets = 135,
    max_pairs = max_members * max_members,
    max_inside = 1 << 16,
    id_table = 1 << 21
};

/* ---- the model ---- */

/* A mesh that is in both grids. */
typedef struct member {
    vox_mesh id;
    uint64_t user_data;
    body shape;                        /* its positions are the rest pose */
    float positions[5 * max_vertices]; /* what the grids read, `stride` floats apart */
    uint32_t stride;
    vox_filter filter;
    uint32_t enabled;
    uint8_t off[max_tets], removed[max_tets]; /* tets; those removed are off, too */
} member;

typedef struct pair {
    vox_mesh a, b; /* a <= b */
    uint64_t user_data_a, user_data_b;
} pair;

typedef struct inside {
    vox_mesh a;
    uint32_t vertex;
    vox_mesh b;
} inside;

typedef struct soak {
    uint64_t random;
    uint32_t step;
    const char* operation;
    ledger ledgers[2];
    vox_grid* grids[2];
    uint64_t epoch;
    member members[max_members]; /* ascending by id */
    uint32_t count;
    uint32_t excepted[max_pairs][2]; /* pairs of ids that do not collide */
    uint32_t excepted_count;
    vox_mesh* ids_given_out;            /* a hash table of all ids there ever were */
    vox_mesh stale;                     /* one of those that were removed; 0: none yet */
    pair was[max_pairs], is[max_pairs]; /* touching, in the last successful step and in this one */
    uint32_t was_count, is_count;
    inside *was_inside, *is_inside;
    uint64_t was_inside_count, is_inside_count;
    uint64_t most_bytes[4];              /* held by both grids, in each quarter of the steps */
    uint64_t contacts, events, failures; /* that there were, so that the test is of something */
} soak;

static uint64_t soak_seed = 1;

#define demand(condition)                                                                                    \
    ck_assert_msg(condition, "%s: step %u (%s), VOX_SOAK_SEED=%llu", #condition, s->step, s->operation,      \
                  (unsigned long long)soak_seed)
#define good(call)                                                                                           \
    do {                                                                                                     \
        const vox_result good_ = (call);                                                                     \
        ck_assert_msg(good_ == VOX_OK, "%s: %s (%s): step %u (%s), VOX_SOAK_SEED=%llu", #call,               \
                      vox_result_string(good_), vox_last_error(), s->step, s->operation,                     \
                      (unsigned long long)soak_seed);                                                        \
    } while (0)

static uint32_t below(soak* s, uint32_t count) { return random_below(&s->random, count); }

static vox_grid_desc grid_desc(soak* s, int g) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.engine = g == 0 ? VOX_ENGINE_FAST : VOX_ENGINE_REFERENCE;
    desc.flags |= VOX_GRID_CONTACT_EVENTS;
    desc.allocator = ledger_allocator(&s->ledgers[g]);
    return desc;
}

static member* find(soak* s, vox_mesh id) {
    for (uint32_t m = 0; m < s->count; ++m)
        if (s->members[m].id == id) return &s->members[m];
    return NULL;
}

static void never_seen_before(soak* s, vox_mesh id) {
    uint32_t at = id * 2654435761u % id_table;
    for (; s->ids_given_out[at]; at = (at + 1) % id_table) demand(s->ids_given_out[at] != id);
    s->ids_given_out[at] = id;
}

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

static vox_mesh_desc member_desc(const member* m) {
    vox_mesh_desc desc = array_desc(m->positions, m->shape.vertex_count, m->shape.tets, m->shape.tet_count);
    desc.position_byte_stride = m->stride * sizeof(float);
    desc.rest_positions = m->shape.positions;
    desc.user_data = m->user_data;
    desc.filter = &m->filter;
    return desc;
}

static vox_filter random_filter(soak* s) {
    vox_filter filter = vox_default_filter();
    if (below(s, 2)) filter.group = (int32_t)below(s, 4) - 2;
    if (below(s, 2)) filter.category = 1u + below(s, 3);
    if (below(s, 2)) filter.mask = 1u + below(s, 3);
    filter.self_collision = below(s, 3) == 0;
    filter.self_rings = below(s, 3);
    filter.self_rest_distance = below(s, 3) == 0 ? 0.2 : 0;
    return filter;
}

static void bind_all(soak* s, int g) {
    for (uint32_t i = 0; i < s->count; ++i)
        good(vox_mesh_bind_positions(s->grids[g], s->members[i].id, s->members[i].positions,
                                     VOX_FORMAT_FLOAT3, s->members[i].stride * sizeof(float)));
}

static void insert(soak* s) {
    if (s->count == max_members) return;
    member m;
    memset(&m, 0, sizeof m);
    m.shape = make_shape(s);
    m.user_data = random_next(&s->random);
    m.filter = vox_default_filter();
    if (below(s, 3) == 0) m.filter = random_filter(s);
    m.enabled = 1;
    place(s, &m, below(s, 2) ? 3 : 5);

    vox_mesh ids[2] = {0, 0};
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
    const vox_mesh id = s->members[index].id;
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
    for (int g = 0; g < 2; ++g) good(vox_mesh_remove(s->grids[g], s->members[index].id));
    forget(s, index);
    for (int g = 0; g < 2; ++g) bind_all(s, g);
}

static void clear(soak* s) {
    if (below(s, 8)) return; /* seldom */
    for (int g = 0; g < 2; ++g) good(vox_grid_clear(s->grids[g]));
    while (s->count) forget(s, s->count - 1);
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
    for (int g = 0; g < 2; ++g) good(vox_mesh_set_filter(s->grids[g], m->id, &m->filter));
}

static void set_enabled(soak* s) {
    if (s->count == 0) return;
    member* m = &s->members[below(s, s->count)];
    m->enabled = below(s, 2);
    for (int g = 0; g < 2; ++g) good(vox_mesh_set_enabled(s->grids[g], m->id, m->enabled));
}

static void except_pair(soak* s) {
    if (s->count < 2) return;
    const uint32_t i = below(s, s->count), j = (i + 1 + below(s, s->count - 1)) % s->count;
    const vox_mesh a = s->members[i < j ? i : j].id, b = s->members[i < j ? j : i].id;
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
#define edit(call)                                                                                               do {                                                                                                             if (below(s, 8) == 0) s->ledgers[g].fail_at = s->ledgers[g].calls + 1 + below(s, 6);                         if (may_fail(s, g, call)) good(call);                                                                    } while (0)

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
    desc.positions = m->positions;
    desc.position_byte_stride = m->stride * sizeof(float);
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
        demand(vox_mesh_is_valid(s->grids[g], s->stale) == 0);
        demand(vox_mesh_remove(s->grids[g], s->stale) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_mesh_user_data(s->grids[g], s->stale, &user_data) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_mesh_set_enabled(s->grids[g], s->stale, 0) == VOX_ERROR_INVALID_HANDLE);
        demand(vox_mesh_remove_tets(s->grids[g], s->stale, &tet, 1) == VOX_ERROR_INVALID_HANDLE);
    }
}

static void reserve(soak* s) {
    const uint32_t meshes = below(s, 2 * max_members), contacts = below(s, 1000);
    for (int g = 0; g < 2; ++g) good(vox_grid_reserve(s->grids[g], meshes, contacts));
    ++s->epoch;
}

/* A step that fails leaves no contacts and no events, and loses none: the next one is compared with the last
 * that succeeded. */
static void nothing_left(soak* s, int g) {
    vox_contact_view contacts;
    vox_touch_view events;
    good(vox_grid_contacts(s->grids[g], &contacts));
    good(vox_grid_touch_events(s->grids[g], &events));
    demand(contacts.count == 0 && events.count == 0);
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

/* ---- what must hold after each step ---- */

static int contact_before(const vox_contact* x, const vox_contact* y) {
    if (x->mesh_a != y->mesh_a) return x->mesh_a < y->mesh_a;
    if (x->vertex != y->vertex) return x->vertex < y->vertex;
    if (x->mesh_b != y->mesh_b) return x->mesh_b < y->mesh_b;
    return x->tet < y->tet;
}

static void check_contacts(soak* s, const vox_contact_view* view) {
    s->is_count = 0;
    s->is_inside_count = 0;
    for (uint64_t i = 0; i < view->count; ++i) {
        const vox_contact* c = &view->data[i];
        const member *a = find(s, c->mesh_a), *b = find(s, c->mesh_b);
        demand(i == 0 || contact_before(c - 1, c));
        demand(a && b && a->enabled && b->enabled);
        demand(c->vertex < a->shape.vertex_count && c->tet < b->shape.tet_count && !b->off[c->tet]);
        const float sum = c->barycentric[0] + c->barycentric[1] + c->barycentric[2] + c->barycentric[3];
        demand(fabsf(sum - 1) < 1e-5f);

        const member *low = a < b ? a : b, *high = a < b ? b : a;
        uint32_t at = 0;
        while (at < s->is_count && (s->is[at].a != low->id || s->is[at].b != high->id)) ++at;
        if (at == s->is_count) {
            const pair touching = {low->id, high->id, low->user_data, high->user_data};
            s->is[s->is_count++] = touching;
        }
        const inside now = {c->mesh_a, c->vertex, c->mesh_b};
        if (s->is_inside_count == 0 || memcmp(&s->is_inside[s->is_inside_count - 1], &now, sizeof now) != 0) {
            demand(s->is_inside_count < max_inside);
            s->is_inside[s->is_inside_count++] = now;
        }
    }
    for (uint32_t i = 1; i < s->is_count; ++i) /* sorted, as events come */
        for (uint32_t j = i; j > 0 && (s->is[j - 1].a > s->is[j].a ||
                                       (s->is[j - 1].a == s->is[j].a && s->is[j - 1].b > s->is[j].b));
             --j) {
            const pair swapped = s->is[j];
            s->is[j] = s->is[j - 1];
            s->is[j - 1] = swapped;
        }
    s->contacts += view->count;
}

static int has_pair(const pair* pairs, uint32_t count, const pair* p) {
    for (uint32_t i = 0; i < count; ++i)
        if (pairs[i].a == p->a && pairs[i].b == p->b) return 1;
    return 0;
}

/* Those of `these` that are (or are not) in `those`, in order, are the next events of that kind. */
static uint64_t expect_events(soak* s, const vox_touch_event* events, vox_touch kind, const pair* these,
                              uint32_t these_count, const pair* those, uint32_t those_count, int in_both) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < these_count; ++i) {
        if (has_pair(those, those_count, &these[i]) != in_both) continue;
        const vox_touch_event* e = &events[count++];
        demand(e->kind == kind && e->mesh_a == these[i].a && e->mesh_b == these[i].b);
        demand(e->user_data_a == these[i].user_data_a && e->user_data_b == these[i].user_data_b);
    }
    return count;
}

static void check_events(soak* s, const vox_grid* grid) {
    vox_touch_view view;
    good(vox_grid_touch_events(grid, &view));
    demand(view.began + view.persisted == s->is_count && view.persisted + view.ended == s->was_count);
    demand(view.count == view.began + view.persisted + view.ended);
    if (view.count > 0) { /* else data may be null, to which nothing may be added */
        const vox_touch_event* e = view.data;
        e += expect_events(s, e, VOX_TOUCH_BEGAN, s->is, s->is_count, s->was, s->was_count, 0);
        e += expect_events(s, e, VOX_TOUCH_PERSISTED, s->is, s->is_count, s->was, s->was_count, 1);
        e += expect_events(s, e, VOX_TOUCH_ENDED, s->was, s->was_count, s->is, s->is_count, 0);
        demand(e == view.data + view.count);
    }
    s->events += view.began + view.ended;

    /* Of vertices: as many began more than ended as there are more now. */
    vox_contact_event_view vertices;
    good(vox_grid_contact_events(grid, &vertices));
    demand(vertices.began + s->was_inside_count == vertices.ended + s->is_inside_count);
    uint64_t in_both = 0;
    for (uint64_t i = 0, j = 0; i < s->was_inside_count && j < s->is_inside_count;) {
        const inside *w = &s->was_inside[i], *n = &s->is_inside[j];
        const int order = w->a != n->a             ? (w->a < n->a ? -1 : 1)
                          : w->vertex != n->vertex ? (w->vertex < n->vertex ? -1 : 1)
                          : w->b != n->b           ? (w->b < n->b ? -1 : 1)
                                                   : 0;
        in_both += order == 0;
        i += order <= 0;
        j += order >= 0;
    }
    demand(vertices.began == s->is_inside_count - in_both);
}

/* The same meshes in a new grid have the same contacts. */
static void check_against_fresh(soak* s, const vox_contact_view* view) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* fresh = NULL;
    vox_mesh ids[max_members];
    uint32_t left[max_members][max_tets]; /* which tet the n-th one that is on is */
    desc.engine = below(s, 2) ? VOX_ENGINE_FAST : VOX_ENGINE_REFERENCE;
    desc.flags = 0;
    good(vox_grid_create(&desc, &fresh));
    for (uint32_t i = 0; i < s->count; ++i) {
        const member* m = &s->members[i];
        vox_mesh_desc mesh = member_desc(m);
        uint32_t tets[4 * max_tets], count = 0;
        for (uint32_t t = 0; t < m->shape.tet_count; ++t) {
            if (m->off[t]) continue;
            memcpy(tets + 4 * count, m->shape.tets + 4 * t, 4 * sizeof(uint32_t));
            left[i][count++] = t;
        }
        mesh.tets = tets;
        mesh.tet_count = count;
        good(vox_mesh_insert(fresh, &mesh, &ids[i]));
        good(vox_mesh_set_enabled(fresh, ids[i], s->members[i].enabled));
    }
    for (uint32_t i = 0; i < s->excepted_count; ++i)
        good(vox_grid_set_pair_enabled(fresh, ids[find(s, s->excepted[i][0]) - s->members],
                                       ids[find(s, s->excepted[i][1]) - s->members], 0));
    good(vox_grid_step(fresh));
    vox_contact_view again;
    good(vox_grid_contacts(fresh, &again));
    demand(again.count == view->count);
    for (uint64_t i = 0; i < view->count; ++i) {
        vox_contact c = view->data[i], other = again.data[i];
        other.tet = left[find(s, c.mesh_b) - s->members][other.tet];
        c.mesh_a = ids[find(s, c.mesh_a) - s->members];
        c.mesh_b = ids[find(s, c.mesh_b) - s->members];
        demand(memcmp(&c, &other, sizeof c) == 0);
    }
    vox_grid_destroy(fresh);
}

static void check(soak* s) {
    uint64_t hashes[2] = {0, 0}, epoch = 0, user_data = 0;
    vox_contact_view views[2];
    for (int g = 0; g < 2; ++g) {
        good(vox_grid_contacts(s->grids[g], &views[g]));
        good(vox_grid_hash(s->grids[g], &hashes[g]));
        good(vox_grid_epoch(s->grids[g], &epoch));
        demand(epoch == s->epoch && views[g].epoch == epoch);
        for (uint32_t i = 0; i < s->count; ++i) {
            demand(vox_mesh_is_valid(s->grids[g], s->members[i].id));
            good(vox_mesh_user_data(s->grids[g], s->members[i].id, &user_data));
            demand(user_data == s->members[i].user_data);
        }
        vox_counters counters = {.struct_size = sizeof counters};
        good(vox_grid_counters(s->grids[g], &counters));
        demand(counters.bytes == s->ledgers[g].bytes);
    }
    demand(hashes[0] == hashes[1]);
    demand(views[0].count == views[1].count);
    demand(views[0].count == 0 ||
           memcmp(views[0].data, views[1].data, (size_t)views[0].count * sizeof(vox_contact)) == 0);
    check_contacts(s, &views[0]);
    for (int g = 0; g < 2; ++g) check_events(s, s->grids[g]);
    if (s->step % 8 == 0) check_against_fresh(s, &views[0]);
}

/* What is, was. */
static void remember(soak* s) {
    memcpy(s->was, s->is, sizeof s->is);
    s->was_count = s->is_count;
    inside* swapped = s->was_inside;
    s->was_inside = s->is_inside;
    s->is_inside = swapped;
    s->was_inside_count = s->is_inside_count;
}

/* ---- the life ---- */

static void step(soak* s) {
    for (int g = 0; g < 2; ++g) good(vox_grid_step(s->grids[g]));
    ++s->epoch;
}

static uint64_t number_from(const char* variable, uint64_t usual) {
    const char* text = getenv(variable);
    return text ? strtoull(text, NULL, 10) : usual;
}

START_TEST(soak_life) {
    soak* s = (soak*)calloc(1, sizeof *s);
    const uint32_t steps = (uint32_t)number_from("VOX_SOAK_STEPS", 400);
    uint32_t runs[operation_count] = {0}, total = 0;
    soak_seed = number_from("VOX_SOAK_SEED", 1);
    s->random = soak_seed;
    s->operation = "create";
    s->ids_given_out = (vox_mesh*)calloc(id_table, sizeof(vox_mesh));
    s->was_inside = (inside*)calloc(max_inside, sizeof(inside));
    s->is_inside = (inside*)calloc(max_inside, sizeof(inside));
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
    demand(s->contacts > steps && s->events > steps / 10 && s->failures > 0);
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
           steps, (unsigned long long)s->contacts, (unsigned long long)s->events,
           (unsigned long long)s->failures, (unsigned long long)s->most_bytes[0],
           (unsigned long long)s->most_bytes[1], (unsigned long long)s->most_bytes[2],
           (unsigned long long)s->most_bytes[3]);
    free(s->ids_given_out);
    free(s->was_inside);
    free(s->is_inside);
    free(s);
}
END_TEST

int main(void) {
    Suite* suite = suite_create("soak");
    TCase* tests = tcase_create("soak");
    tcase_set_timeout(tests, 0);
    tcase_add_test(tests, soak_life);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
