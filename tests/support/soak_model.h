/* A model of two grids, one of each engine, that hold the same meshes, and checks of what must hold after
 * each step. */
#ifndef VOX_TESTS_SOAK_MODEL_H
#define VOX_TESTS_SOAK_MODEL_H

#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/constraint_checks.h"
#include "support/ledger.h"

enum {
    max_members = 14,
    max_vertices = 80, /* of a body: a box of 3 * 3 * 3 cubes has 64 */
    max_tets = 135,
    max_pairs = max_members * max_members,
    id_table = 1 << 21
};

/* ---- the model ---- */

/* A mesh that is in both grids. */
typedef struct member {
    vox_body id;
    uint64_t user_data;
    body shape;                        /* its positions are the rest pose */
    float positions[5 * max_vertices]; /* what the grids read, `stride` floats apart */
    uint32_t stride;
    vox_filter filter;
    uint32_t enabled;
    uint8_t off[max_tets], removed[max_tets]; /* tets; those removed are off, too */
} member;

typedef struct pair {
    vox_body a, b; /* a <= b */
    uint64_t user_data_a, user_data_b;
} pair;

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
    vox_body* ids_given_out;            /* a hash table of all ids there ever were */
    vox_body stale;                     /* one of those that were removed; 0: none yet */
    pair was[max_pairs], is[max_pairs]; /* touching, in the last successful step and in this one */
    uint32_t was_count, is_count;
    kept_constraints last;                /* of the last step; none after results that are gone */
    uint64_t most_bytes[4];               /* held by both grids, in each quarter of the steps */
    uint64_t contacts, changes, failures; /* that there were, so that the test is of something */
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

static inline uint32_t below(soak* s, uint32_t count) { return random_below(&s->random, count); }

static inline vox_grid_desc grid_desc(soak* s, int g) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, g == 0 ? ENGINE_FAST : ENGINE_REFERENCE);
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.allocator = ledger_allocator(&s->ledgers[g]);
    return desc;
}

static inline member* find(soak* s, vox_body id) {
    for (uint32_t m = 0; m < s->count; ++m)
        if (s->members[m].id == id) return &s->members[m];
    return NULL;
}

static inline void never_seen_before(soak* s, vox_body id) {
    uint32_t at = id * 2654435761u % id_table;
    for (; s->ids_given_out[at]; at = (at + 1) % id_table) demand(s->ids_given_out[at] != id);
    s->ids_given_out[at] = id;
}

static inline vox_mesh_desc member_desc(const member* m) {
    vox_mesh_desc desc =
        vox_mesh_desc_floats(m->positions, m->shape.vertex_count, m->shape.tets, m->shape.tet_count);
    desc.positions.byte_stride = m->stride * sizeof(float);
    desc.rest_positions = vox_float_positions(m->shape.positions, m->shape.vertex_count);
    desc.user_data = m->user_data;
    desc.filter = m->filter;
    return desc;
}

/* ---- what must hold after each step ---- */

static inline int contact_before(const vox_contact* x, const vox_contact* y) {
    if (x->body_a != y->body_a) return x->body_a < y->body_a;
    if (x->vertex != y->vertex) return x->vertex < y->vertex;
    if (x->body_b != y->body_b) return x->body_b < y->body_b;
    return x->tet < y->tet;
}

static inline void check_contacts(soak* s, const vox_contact_view* view) {
    s->is_count = 0;
    for (uint64_t i = 0; i < view->count; ++i) {
        const vox_contact* c = &view->data[i];
        const member *a = find(s, c->body_a), *b = find(s, c->body_b);
        demand(i == 0 || contact_before(c - 1, c));
        demand(a && b && a->enabled && b->enabled);
        demand(c->vertex < a->shape.vertex_count && c->tet < b->shape.tet_count && !b->off[c->tet]);

        const member *low = a < b ? a : b, *high = a < b ? b : a;
        uint32_t at = 0;
        while (at < s->is_count && (s->is[at].a != low->id || s->is[at].b != high->id)) ++at;
        if (at == s->is_count) {
            const pair touching = {low->id, high->id, low->user_data, high->user_data};
            s->is[s->is_count++] = touching;
        }
    }
    for (uint32_t i = 1; i < s->is_count; ++i) /* sorted, as pairs come */
        for (uint32_t j = i; j > 0 && (s->is[j - 1].a > s->is[j].a ||
                                       (s->is[j - 1].a == s->is[j].a && s->is[j - 1].b > s->is[j].b));
             --j) {
            const pair swapped = s->is[j];
            s->is[j] = s->is[j - 1];
            s->is[j - 1] = swapped;
        }
    s->contacts += view->count;
}

static inline int has_pair(const pair* pairs, uint32_t count, const pair* p) {
    for (uint32_t i = 0; i < count; ++i)
        if (pairs[i].a == p->a && pairs[i].b == p->b) return 1;
    return 0;
}

/* Pairs that touch, or touched before: each once, in order. */
static inline void check_pairs(soak* s, const vox_grid* grid) {
    vox_pair_view view;
    uint32_t is = 0, was = 0;
    good(vox_grid_get_pairs(grid, &view));
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_pair* p = &view.data[i];
        const pair known = {p->body_a, p->body_b, p->user_data_a, p->user_data_b};
        const int now = has_pair(s->is, s->is_count, &known), before = has_pair(s->was, s->was_count, &known);
        demand(p->state == (!before ? VOX_PAIR_BEGAN : now ? VOX_PAIR_PERSISTED : VOX_PAIR_ENDED));
        demand(i == 0 || p[-1].body_a < p->body_a || (p[-1].body_a == p->body_a && p[-1].body_b < p->body_b));
        const pair* expected = now ? &s->is[is] : &s->was[0];
        while (!now && (expected->a != p->body_a || expected->b != p->body_b)) ++expected;
        demand(memcmp(expected, &known, sizeof known) == 0);
        is += (uint32_t)now;
        was += (uint32_t)before;
        s->changes += p->state != VOX_PAIR_PERSISTED;
    }
    demand(is == s->is_count && was == s->was_count);
}

/* Checks INSIDE constraints: one for each vertex in another body, the same in both grids, `previous`
 * included. */
static inline void check_constraints(soak* s) {
    const vox_contact_view contacts = contacts_of(s->grids[0]);
    uint64_t inside = 0;
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact* c = &contacts.data[i];
        inside +=
            i == 0 || c->body_a != c[-1].body_a || c->vertex != c[-1].vertex || c->body_b != c[-1].body_b;
    }
    demand(constraints_of(s->grids[0]).count == inside);
    check_previous(s->grids[0], &s->last);
    free(s->last.data);
    s->last = keep_constraints(s->grids[0]);
    same_constraints(s->grids[1], &s->last);
    if (s->step % 8 == 0) (void)checked_constraints(s->grids[s->step % 16 == 0]);
}

/* Checks that the meshes have the same contacts in a new grid. */
static inline void check_against_fresh(soak* s, const vox_contact_view* view) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* fresh = NULL;
    vox_body ids[max_members];
    uint32_t left[max_members][max_tets]; /* which tet the n-th one that is on is */
    use_engine(&desc, below(s, 2) ? ENGINE_FAST : ENGINE_REFERENCE);
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
        good(vox_body_set_enabled(fresh, ids[i], s->members[i].enabled));
    }
    for (uint32_t i = 0; i < s->excepted_count; ++i)
        good(vox_grid_set_pair_enabled(fresh, ids[find(s, s->excepted[i][0]) - s->members],
                                       ids[find(s, s->excepted[i][1]) - s->members], 0));
    good(vox_grid_step(fresh));
    vox_contact_view again;
    good(vox_grid_get_contacts(fresh, &again));
    demand(again.count == view->count);
    for (uint64_t i = 0; i < view->count; ++i) {
        vox_contact c = view->data[i], other = again.data[i];
        other.tet = left[find(s, c.body_b) - s->members][other.tet];
        c.body_a = ids[find(s, c.body_a) - s->members];
        c.body_b = ids[find(s, c.body_b) - s->members];
        demand(memcmp(&c, &other, sizeof c) == 0);
    }
    vox_grid_destroy(fresh);
}

static inline void check(soak* s) {
    uint64_t hashes[2] = {0, 0}, user_data = 0;
    vox_grid_info info = {.struct_size = sizeof info};
    vox_contact_view views[2];
    for (int g = 0; g < 2; ++g) {
        good(vox_grid_get_contacts(s->grids[g], &views[g]));
        good(vox_grid_get_hash(s->grids[g], &hashes[g]));
        good(vox_grid_get_info(s->grids[g], &info));
        demand(info.epoch == s->epoch);
        for (uint32_t i = 0; i < s->count; ++i) {
            demand(vox_body_is_valid(s->grids[g], s->members[i].id));
            good(vox_body_get_user_data(s->grids[g], s->members[i].id, &user_data));
            demand(user_data == s->members[i].user_data);
        }
        grid_counts counters;
        counters = counters_of(s->grids[g]);
        demand(counters.bytes == s->ledgers[g].bytes);
    }
    demand(hashes[0] == hashes[1]);
    demand(views[0].count == views[1].count);
    demand(views[0].count == 0 ||
           memcmp(views[0].data, views[1].data, (size_t)views[0].count * sizeof(vox_contact)) == 0);
    check_contacts(s, &views[0]);
    for (int g = 0; g < 2; ++g) check_pairs(s, s->grids[g]);
    check_constraints(s);
    if (s->step % 8 == 0) check_against_fresh(s, &views[0]);
}

/* The present state becomes the last one. */
static inline void remember(soak* s) {
    memcpy(s->was, s->is, sizeof s->is);
    s->was_count = s->is_count;
}

#endif
