/* Touching pairs and events: what the views say of the contacts, and that nothing that happens between two
 * steps loses an event. A model replays all events and must know at every step what touches. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/ledger.h"
#include "support/suite.h"

static vox_grid* new_grid(uint32_t flags) {
    vox_grid_desc desc = engine_desc();
    desc.flags = flags;
    return grid_of(&desc);
}

static vox_body insert(vox_grid* grid, const body* b, uint64_t user_data) {
    vox_mesh_desc desc = body_desc(b);
    desc.user_data = user_data;
    return insert_mesh(grid, &desc);
}

static void shift(body* b, float x) {
    for (uint32_t v = 0; v < b->vertex_count; ++v) b->positions[3 * v] += x;
}

static vox_touch_view touch_events(const vox_grid* grid) {
    vox_touch_view view;
    memset(&view, 0, sizeof view);
    ck_ok(vox_grid_touch_events(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_touch_event));
    ck_assert_uint_eq(view.count, view.began + view.persisted + view.ended);
    return view;
}

static vox_contact_event_view contact_events(const vox_grid* grid) {
    vox_contact_event_view view;
    memset(&view, 0, sizeof view);
    ck_ok(vox_grid_contact_events(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_contact_event));
    ck_assert_uint_eq(view.count, view.began + view.ended);
    return view;
}

static vox_pair_view pairs_of(const vox_grid* grid) {
    vox_pair_view view;
    memset(&view, 0, sizeof view);
    ck_ok(vox_grid_get_pairs(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_pair));
    return view;
}

static void check_one_event(const vox_grid* grid, vox_touch kind, vox_body a, vox_body b) {
    const vox_touch_view view = touch_events(grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert_int_eq(view.data[0].kind, kind);
    ck_assert_uint_eq(view.data[0].body_a, a);
    ck_assert_uint_eq(view.data[0].body_b, b);
    ck_assert_uint_eq(view.data[0].user_data_a, 7);
    ck_assert_uint_eq(view.data[0].user_data_b, UINT64_MAX);
    ck_assert_uint_eq(view.data[0].pair, kind == VOX_TOUCH_ENDED ? VOX_NO_PAIR : 0);
    ck_assert_uint_eq(view.began, kind == VOX_TOUCH_BEGAN);
    ck_assert_uint_eq(view.ended, kind == VOX_TOUCH_ENDED);
}

/* Two boxes that overlap by a quarter. */
typedef struct meeting {
    vox_grid* grid;
    body box, other;
    vox_body a, b;
} meeting;

static meeting new_meeting(void) {
    meeting m;
    m.grid = new_grid(VOX_GRID_CONTACT_EVENTS);
    m.box = make_box(2, 1, 0, 0, 0);
    m.other = make_box(2, 1, 1.75f, 0.25f, 0.25f);
    m.a = insert(m.grid, &m.box, 7);
    m.b = insert(m.grid, &m.other, UINT64_MAX);
    return m;
}

static void end_meeting(meeting* m) {
    vox_grid_destroy(m->grid);
    free_body(&m->box);
    free_body(&m->other);
}

START_TEST(begin_persist_end) {
    meeting m = new_meeting();
    ck_assert_uint_eq(touch_events(m.grid).count, 0);
    ck_assert_uint_eq(contact_events(m.grid).count, 0);
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);

    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_BEGAN, m.a, m.b);
    ck_assert_uint_gt(contact_events(m.grid).began, 0);
    for (int frame = 0; frame < 3; ++frame) {
        shift(&m.other, 0.0625f);
        ck_ok(vox_grid_step(m.grid));
        check_one_event(m.grid, VOX_TOUCH_PERSISTED, m.a, m.b);
        ck_assert_uint_eq(contact_events(m.grid).count, 0); /* deeper in or not: the same vertices */
    }
    for (int frame = 0; frame < 3; ++frame) { /* at rest */
        ck_ok(vox_grid_step(m.grid));
        check_one_event(m.grid, VOX_TOUCH_PERSISTED, m.a, m.b);
        ck_assert_uint_eq(pairs_of(m.grid).count, 1);
        ck_assert_uint_eq(contact_events(m.grid).count, 0);
    }
    shift(&m.other, 9);
    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_ENDED, m.a, m.b);
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);
    const vox_contact_event_view gone = contact_events(m.grid);
    ck_assert_uint_gt(gone.ended, 0);
    ck_assert_uint_eq(gone.began, 0);
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(touch_events(m.grid).count, 0);
    ck_assert_uint_eq(contact_events(m.grid).count, 0);
    end_meeting(&m);
}
END_TEST

/* What a reader has added up of the views that it read. */
typedef struct totals {
    uint64_t touches_began, touches_ended, contacts_began, contacts_ended;
} totals;

static void read_events(const vox_grid* grid, totals* sums) {
    const vox_touch_view touches = touch_events(grid);
    const vox_contact_event_view contacts = contact_events(grid);
    sums->touches_began += touches.began;
    sums->touches_ended += touches.ended;
    sums->contacts_began += contacts.began;
    sums->contacts_ended += contacts.ended;
}

static void check_totals(const vox_grid* grid, const totals* sums) {
    const grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.total_touches_began, sums->touches_began);
    ck_assert_uint_eq(counters.total_touches_ended, sums->touches_ended);
    ck_assert_uint_eq(counters.total_contacts_began, sums->contacts_began);
    ck_assert_uint_eq(counters.total_contacts_ended, sums->contacts_ended);
}

/* Events are per step: one reader reads every step, the other every second one, and the totals show which is
 * right. */
START_TEST(totals_show_events_that_nobody_read) {
    meeting m = new_meeting();
    totals all = {0, 0, 0, 0}, half = all;
    check_totals(m.grid, &all);
    for (int step = 0; step < 24; ++step) {
        if (step % 3 != 2) shift(&m.other, step % 6 < 3 ? 1.0f : -1.0f); /* in, out, at rest; and back */
        if (step == 9) {                                                 /* a failed step has no events */
            const float kept = m.other.positions[0];
            m.other.positions[0] = NAN;
            ck_fails(vox_grid_step(m.grid), VOX_ERROR_NON_FINITE, "not finite");
            m.other.positions[0] = kept;
            check_totals(m.grid, &all);
        }
        if (step == 12) ck_ok(vox_grid_clear(m.grid)); /* the totals go on */
        if (step == 13) {
            m.a = insert(m.grid, &m.box, 7);
            m.b = insert(m.grid, &m.other, UINT64_MAX);
        }
        ck_ok(vox_grid_step(m.grid));
        read_events(m.grid, &all);
        check_totals(m.grid, &all);
        if (step % 2 == 1) read_events(m.grid, &half);
    }
    ck_assert_uint_ge(all.touches_ended, 3);
    const grid_counts counters = counters_of(m.grid);
    ck_assert_uint_gt(counters.total_touches_began, half.touches_began);
    ck_assert_uint_gt(counters.total_contacts_began, half.contacts_began);
    ck_assert_uint_eq(counters.total_touches_began - counters.total_touches_ended, pairs_of(m.grid).count);
    end_meeting(&m);
}
END_TEST

START_TEST(removal_ends_once_with_the_old_ids) {
    meeting m = new_meeting();
    ck_ok(vox_grid_step(m.grid));
    ck_ok(vox_body_remove(m.grid, m.b));
    check_one_event(m.grid, VOX_TOUCH_BEGAN, m.a, m.b); /* still the last step's */
    const vox_body again = insert(m.grid, &m.other, UINT64_MAX);
    ck_assert_uint_ne(again, m.b);
    ck_ok(vox_grid_step(m.grid));
    const vox_touch_view view = touch_events(m.grid);
    ck_assert_uint_eq(view.began, 1);
    ck_assert_uint_eq(view.persisted, 0);
    ck_assert_uint_eq(view.ended, 1);
    ck_assert_uint_eq(view.data[0].body_b, again);
    ck_assert_uint_eq(view.data[1].body_b, m.b);
    ck_assert_uint_eq(view.data[1].user_data_b, UINT64_MAX);
    ck_assert_uint_eq(vox_body_is_valid(m.grid, view.data[1].body_b), 0);
    ck_ok(vox_body_remove(m.grid, m.a));
    ck_ok(vox_body_remove(m.grid, again));
    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_ENDED, m.a, again);
    end_meeting(&m);
}
END_TEST

START_TEST(clear_ends_with_the_next_step) {
    meeting m = new_meeting();
    ck_ok(vox_grid_step(m.grid));
    ck_ok(vox_grid_clear(m.grid));
    check_one_event(m.grid, VOX_TOUCH_BEGAN, m.a, m.b); /* the clear itself is no event ... */
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);       /* ... but there are no contacts to point at */
    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_ENDED, m.a, m.b);
    ck_assert_uint_gt(contact_events(m.grid).ended, 0);
    ck_ok(vox_grid_clear(m.grid));
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(touch_events(m.grid).count, 0);
    end_meeting(&m);
}
END_TEST

START_TEST(failed_steps_lose_nothing) {
    meeting m = new_meeting();
    ck_ok(vox_grid_step(m.grid));
    const float kept = m.other.positions[0];
    for (int times = 0; times < 2; ++times) {
        m.other.positions[0] = NAN;
        ck_fails(vox_grid_step(m.grid), VOX_ERROR_NON_FINITE, "not finite");
        ck_assert_uint_eq(touch_events(m.grid).count, 0);
        ck_assert_uint_eq(contact_events(m.grid).count, 0);
        ck_assert_uint_eq(pairs_of(m.grid).count, 0);
        uint64_t count = 9;
        ck_ok(vox_mesh_copy_contacts(m.grid, m.a, NULL, 0, &count));
        ck_assert_uint_eq(count, 0);
    }
    m.other.positions[0] = kept;
    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_PERSISTED, m.a, m.b); /* it did not begin twice */
    m.other.positions[0] = NAN;
    ck_fails(vox_grid_step(m.grid), VOX_ERROR_NON_FINITE, "not finite");
    m.other.positions[0] = kept;
    shift(&m.other, 9);
    ck_ok(vox_grid_step(m.grid));
    check_one_event(m.grid, VOX_TOUCH_ENDED, m.a, m.b);
    end_meeting(&m);
}
END_TEST

/* Disabled, filtered, excepted: each ends the pair, and undoing it begins it again. */
START_TEST(filters_end_and_begin) {
    meeting m = new_meeting();
    vox_filter none = plain_filter(), all = none;
    none.world = 1;
    ck_ok(vox_grid_step(m.grid));
    for (int way = 0; way < 3; ++way)
        for (uint32_t on = 0; on < 2; ++on) {
            if (way == 0) ck_ok(vox_body_set_enabled(m.grid, m.b, on));
            if (way == 1) ck_ok(vox_body_set_filter(m.grid, m.b, on ? &all : &none));
            if (way == 2) ck_ok(vox_grid_set_pair_enabled(m.grid, m.b, m.a, on));
            ck_ok(vox_grid_step(m.grid));
            check_one_event(m.grid, on ? VOX_TOUCH_BEGAN : VOX_TOUCH_ENDED, m.a, m.b);
            ck_ok(vox_grid_step(m.grid));
            ck_assert_uint_eq(touch_events(m.grid).persisted, on);
            ck_assert_uint_eq(touch_events(m.grid).count, on);
        }
    end_meeting(&m);
}
END_TEST

/* Each contact is in the range of its pair, once, in order; mesh by mesh as vox_mesh_copy_contacts gives
 * them. */
static void check_pairs(const vox_grid* grid) {
    const vox_pair_view pairs = pairs_of(grid);
    const vox_contact_view contacts = contacts_of(grid);
    ck_assert_uint_eq(pairs.epoch, contacts.epoch);
    uint64_t next = 0;
    for (uint64_t i = 0; i < pairs.count; ++i) {
        const vox_pair* pair = &pairs.data[i];
        ck_assert_uint_le(pair->body_a, pair->body_b);
        ck_assert_uint_gt(pair->a_in_b + pair->b_in_a, 0);
        if (pair->body_a == pair->body_b) ck_assert_uint_eq(pair->b_in_a, 0);
        if (i > 0)
            ck_assert(pair[-1].body_a < pair->body_a ||
                      (pair[-1].body_a == pair->body_a && pair[-1].body_b < pair->body_b));
        ck_assert_uint_eq(pair->first, next);
        for (uint64_t c = 0; c < pair->a_in_b + pair->b_in_a; ++c) {
            const uint32_t index = pairs.contacts[pair->first + c];
            ck_assert_uint_lt(index, contacts.count);
            const vox_contact* contact = &contacts.data[index];
            ck_assert_uint_eq(contact->body_a, c < pair->a_in_b ? pair->body_a : pair->body_b);
            ck_assert_uint_eq(contact->body_b, c < pair->a_in_b ? pair->body_b : pair->body_a);
            if (c > 0) ck_assert_uint_lt(pairs.contacts[pair->first + c - 1], index);
        }
        next += pair->a_in_b + pair->b_in_a;
    }
    ck_assert_uint_eq(next, contacts.count); /* and ascending within a pair: so each once */
}

static void check_copies(const vox_grid* grid, vox_body mesh) {
    const vox_pair_view pairs = pairs_of(grid);
    const vox_contact_view contacts = contacts_of(grid);
    uint64_t count = 0, expected = 0;
    ck_ok(vox_mesh_copy_contacts(grid, mesh, NULL, 0, &count));
    vox_contact* copy = (vox_contact*)calloc(count + 1, sizeof *copy);
    for (uint64_t capacity = 0; capacity <= count; capacity += count > 4 ? count / 4 : 1) {
        uint64_t told = 0;
        memset(copy, 0xff, (count + 1) * sizeof *copy);
        ck_ok(vox_mesh_copy_contacts(grid, mesh, copy, capacity, &told));
        ck_assert_uint_eq(told, count);
        ck_assert_uint_eq(copy[capacity].body_a, UINT32_MAX); /* nothing past the end */
    }
    ck_ok(vox_mesh_copy_contacts(grid, mesh, copy, UINT64_MAX, &count));
    for (uint64_t i = 0; i < pairs.count; ++i) {
        const vox_pair* pair = &pairs.data[i];
        if (pair->body_a != mesh && pair->body_b != mesh) continue;
        for (uint64_t c = 0; c < pair->a_in_b + pair->b_in_a; ++c, ++expected)
            ck_assert_mem_eq(&copy[expected], &contacts.data[pairs.contacts[pair->first + c]], sizeof *copy);
    }
    ck_assert_uint_eq(expected, count);
    free(copy);
}

/* ---- the model -------------------------------------------------------------------------------- */

typedef struct key {
    uint32_t a, vertex, b; /* vertex 0 for pairs */
} key;

typedef struct key_set {
    key* keys;
    size_t count;
} key_set;

static int compare_keys(const void* left, const void* right) {
    const key *x = (const key*)left, *y = (const key*)right;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

static void sort_unique(key_set* set) {
    size_t kept = 0;
    qsort(set->keys, set->count, sizeof(key), compare_keys);
    for (size_t i = 0; i < set->count; ++i)
        if (kept == 0 || compare_keys(&set->keys[kept - 1], &set->keys[i]) != 0)
            set->keys[kept++] = set->keys[i];
    set->count = kept;
}

/* `model` without what ended, which it must hold, and with what began, which it must not. The events come as
 * sorted parts. */
static void replay(key_set* model, const key* began, size_t began_count, const key* ended,
                   size_t ended_count) {
    for (size_t i = 1; i < began_count; ++i) ck_assert_int_lt(compare_keys(&began[i - 1], &began[i]), 0);
    for (size_t i = 1; i < ended_count; ++i) ck_assert_int_lt(compare_keys(&ended[i - 1], &ended[i]), 0);
    for (size_t i = 0; i < began_count; ++i)
        ck_assert_msg(!bsearch(&began[i], model->keys, model->count, sizeof(key), compare_keys),
                      "%u, vertex %u, %u began and did not end before", began[i].a, began[i].vertex,
                      began[i].b);
    for (size_t i = 0; i < ended_count; ++i)
        ck_assert_msg(bsearch(&ended[i], model->keys, model->count, sizeof(key), compare_keys),
                      "%u, vertex %u, %u ended and had not begun", ended[i].a, ended[i].vertex, ended[i].b);
    key_set next = {(key*)malloc((model->count + began_count + 1) * sizeof(key)), 0};
    for (size_t i = 0; i < model->count; ++i)
        if (!bsearch(&model->keys[i], ended, ended_count, sizeof(key), compare_keys))
            next.keys[next.count++] = model->keys[i];
    for (size_t i = 0; i < began_count; ++i) next.keys[next.count++] = began[i];
    sort_unique(&next);
    free(model->keys);
    *model = next;
}

static void check_sets(const key_set* model, const key_set* expected, const char* what) {
    ck_assert_msg(model->count == expected->count, "%s: %zu by events, %zu by contacts", what, model->count,
                  expected->count);
    if (model->count) ck_assert_mem_eq(model->keys, expected->keys, model->count * sizeof(key));
}

/* User data by mesh id, for as many ids as the model sees. */
static uint64_t given[16 * (VOX_MAX_GENERATIONS + 1)];

static uint64_t user_data_of(vox_body mesh) { return given[mesh]; }

static void check_against_model(const vox_grid* grid, key_set* touching, key_set* inside) {
    const vox_touch_view touches = touch_events(grid);
    const vox_contact_event_view vertices = contact_events(grid);
    const vox_contact_view contacts = contacts_of(grid);
    const vox_pair_view pairs = pairs_of(grid);
    key* events = (key*)malloc((touches.count + vertices.count + 1) * sizeof(key));
    for (uint64_t i = 0; i < touches.count; ++i) {
        const vox_touch_event* e = &touches.data[i];
        const vox_touch kind = i < touches.began                       ? VOX_TOUCH_BEGAN
                               : i < touches.began + touches.persisted ? VOX_TOUCH_PERSISTED
                                                                       : VOX_TOUCH_ENDED;
        const key k = {e->body_a, 0, e->body_b};
        ck_assert_int_eq(e->kind, kind);
        ck_assert_uint_eq(e->user_data_a, user_data_of(e->body_a));
        ck_assert_uint_eq(e->user_data_b, user_data_of(e->body_b));
        if (kind == VOX_TOUCH_ENDED) {
            ck_assert_uint_eq(e->pair, VOX_NO_PAIR);
        } else {
            ck_assert_uint_lt(e->pair, pairs.count);
            ck_assert_uint_eq(pairs.data[e->pair].body_a, e->body_a);
            ck_assert_uint_eq(pairs.data[e->pair].body_b, e->body_b);
            ck_assert_uint_eq(pairs.data[e->pair].user_data_a, e->user_data_a);
            ck_assert_uint_eq(pairs.data[e->pair].user_data_b, e->user_data_b);
        }
        if (kind == VOX_TOUCH_PERSISTED) {
            ck_assert(bsearch(&k, touching->keys, touching->count, sizeof(key), compare_keys));
            if (i > touches.began) ck_assert_int_lt(compare_keys(&events[i - 1], &k), 0);
        }
        events[i] = k;
    }
    replay(touching, events, touches.began, events + touches.began + touches.persisted, touches.ended);
    for (uint64_t i = 0; i < vertices.count; ++i) {
        const vox_contact_event* e = &vertices.data[i];
        ck_assert_int_eq(e->kind, i < vertices.began ? VOX_TOUCH_BEGAN : VOX_TOUCH_ENDED);
        const key k = {e->body_a, e->vertex, e->body_b};
        events[i] = k;
    }
    replay(inside, events, vertices.began, events + vertices.began, vertices.ended);
    free(events);

    key_set in = {(key*)malloc((contacts.count + 1) * sizeof(key)), 0};
    key_set touch = {(key*)malloc((contacts.count + 1) * sizeof(key)), 0};
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact* c = &contacts.data[i];
        const key k = {c->body_a, c->vertex, c->body_b};
        const key pair = {c->body_a < c->body_b ? c->body_a : c->body_b, 0,
                          c->body_a < c->body_b ? c->body_b : c->body_a};
        in.keys[in.count++] = k;
        touch.keys[touch.count++] = pair;
    }
    sort_unique(&in);
    sort_unique(&touch);
    check_sets(touching, &touch, "pairs");
    check_sets(inside, &in, "vertices");
    ck_assert_uint_eq(pairs.count, touch.count);
    free(in.keys);
    free(touch.keys);
    check_pairs(grid);
}

enum { most_meshes = 7 };

typedef struct actor {
    body shape;
    vox_body mesh; /* 0: none */
} actor;

static void act(vox_grid* grid, actor* actors, uint64_t* random) {
    actor* one = &actors[random_below(random, most_meshes)];
    actor* other = &actors[random_below(random, most_meshes)];
    vox_filter filter = plain_filter();
    uint32_t cubes;
    float edge, at[3];
    switch (random_below(random, 12)) {
    case 0:
        if (!one->mesh) break;
        ck_ok(vox_body_remove(grid, one->mesh));
        free_body(&one->shape);
        one->mesh = 0;
        break;
    case 1:
    case 2:
        if (one->mesh) break;
        cubes = 1 + random_below(random, 2); /* one number a statement: arguments come in any order */
        edge = random_float(random, 0.5f, 1);
        for (int axis = 0; axis < 3; ++axis) at[axis] = random_float(random, 0, 3);
        one->shape = make_box(cubes, edge, at[0], at[1], at[2]);
        one->mesh = insert(grid, &one->shape, *random); /* any number */
        given[one->mesh] = *random;
        break;
    case 3:
        if (one->mesh) ck_ok(vox_body_set_enabled(grid, one->mesh, random_below(random, 3) != 0));
        break;
    case 4:
        if (!one->mesh) break;
        filter.group = (int32_t)random_below(random, 4) - 2;
        filter.category = 1u << random_below(random, 3);
        filter.mask = random_below(random, 3) ? UINT64_MAX : random_below(random, 8);
        filter.world = random_below(random, 6) == 0;
        filter.flags = random_below(random, 2) ? VOX_FILTER_SELF_COLLISION : 0u;
        filter.self_rings = random_below(random, 3);
        ck_ok(vox_body_set_filter(grid, one->mesh, &filter));
        break;
    case 5:
        if (one->mesh && other->mesh && one != other)
            ck_ok(vox_grid_set_pair_enabled(grid, one->mesh, other->mesh, random_below(random, 2)));
        break;
    case 6:
        if (random_below(random, 8)) break;
        ck_ok(vox_grid_clear(grid));
        for (int i = 0; i < most_meshes; ++i) {
            if (actors[i].mesh) free_body(&actors[i].shape);
            actors[i].mesh = 0;
        }
        break;
    case 7: {
        const uint32_t meshes = random_below(random, 20), contacts = random_below(random, 2000);
        ck_ok(vox_grid_reserve(grid, meshes, contacts));
        break;
    }
    case 8: { /* a step that fails */
        if (!one->mesh) break;
        const float kept = one->shape.positions[0];
        one->shape.positions[0] = INFINITY;
        ck_ok(vox_body_set_enabled(grid, one->mesh, 1));
        ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "not finite");
        one->shape.positions[0] = kept;
        break;
    }
    default: /* moves, folds now and then */
        if (!one->mesh) break;
        for (uint32_t v = 0; v < one->shape.vertex_count; ++v)
            for (int axis = 0; axis < 3; ++axis)
                if (random_below(random, 4) == 0)
                    one->shape.positions[3 * v + axis] += random_float(random, -0.25f, 0.25f);
    }
}

static void run_model(uint64_t seed, int frames) {
    vox_grid* grid = new_grid(VOX_GRID_CONTACT_EVENTS);
    actor actors[most_meshes];
    key_set touching = {NULL, 0}, inside = {NULL, 0};
    uint64_t began = 0, ended = 0;
    memset(actors, 0, sizeof actors);
    touching.keys = (key*)malloc(sizeof(key));
    inside.keys = (key*)malloc(sizeof(key));
    for (int frame = 0; frame <= frames; ++frame) {
        if (frame < frames)
            for (uint32_t n = random_below(&seed, 4); n > 0; --n) act(grid, actors, &seed);
        else
            ck_ok(vox_grid_clear(grid)); /* all that began ends */
        ck_ok(vox_grid_step(grid));
        check_against_model(grid, &touching, &inside);
        for (int i = 0; i < most_meshes && frame < frames; ++i)
            if (actors[i].mesh && frame % 8 == 0) check_copies(grid, actors[i].mesh);
        began += touch_events(grid).began;
        ended += touch_events(grid).ended;
    }
    ck_assert_uint_eq(touching.count, 0);
    ck_assert_uint_eq(inside.count, 0);
    ck_assert_uint_eq(began, ended);
    ck_assert_uint_gt(began, (uint64_t)frames / 40); /* something happened */
    for (int i = 0; i < most_meshes; ++i)
        if (actors[i].mesh) free_body(&actors[i].shape);
    free(touching.keys);
    free(inside.keys);
    vox_grid_destroy(grid);
}

START_TEST(every_event_has_its_pair) {
    for (uint64_t seed = 0; seed < 4; ++seed) run_model(seed, 400);
}
END_TEST

/* ---- memory and arguments --------------------------------------------------------------------- */

START_TEST(steady_state_allocates_nothing) {
    ledger l = {0};
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONTACT_EVENTS;
    desc.allocator = ledger_allocator(&l);
    vox_grid* grid = grid_of(&desc);
    ck_ok(vox_grid_reserve(grid, 3, 20000)); /* the first steps too have room for pairs and events */
    body boxes[3] = {make_box(4, 0.25f, 0, 0, 0), make_box(4, 0.25f, 0.3f, 0.3f, 0.2f),
                     make_box(4, 0.25f, 0.6f, 0.4f, 0.5f)};
    for (int i = 0; i < 3; ++i) insert(grid, &boxes[i], 0);
    for (int i = 0; i < 2; ++i) {
        shift(&boxes[0], 8 * (i == 0 ? 1.0f : -1.0f)); /* everything ends that can, and begins */
        ck_ok(vox_grid_step(grid));
        shift(&boxes[2], 8);
        ck_ok(vox_grid_step(grid));
        shift(&boxes[2], -8);
        ck_ok(vox_grid_step(grid));
    }
    const uint64_t before = l.calls;
    for (int frame = 0; frame < 12; ++frame) {
        shift(&boxes[1], frame % 4 == 3 ? -5.25f : 1.75f);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(touch_events(grid).count, 0);
    }
    ck_assert_uint_eq(l.calls, before);
    vox_grid_destroy(grid);
    for (int i = 0; i < 3; ++i) free_body(&boxes[i]);
}
END_TEST

START_TEST(arguments) {
    meeting m = new_meeting();
    vox_grid* plain = new_grid(0);
    vox_pair_view pairs;
    vox_touch_view touches;
    vox_contact_event_view vertices;
    vox_contact contact;
    uint64_t count = 77;
    ck_ok(vox_grid_step(m.grid));
    ck_fails(vox_grid_get_pairs(NULL, &pairs), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_get_pairs(m.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_grid_touch_events(NULL, &touches), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_touch_events(m.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_grid_contact_events(NULL, &vertices), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_contact_events(m.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    memset(&vertices, 0xaa, sizeof vertices);
    const vox_contact_event_view untouched = vertices;
    ck_fails(vox_grid_contact_events(plain, &vertices), VOX_ERROR_INVALID_STATE, "VOX_GRID_CONTACT_EVENTS");
    ck_assert_mem_eq(&vertices, &untouched, sizeof vertices);
    ck_fails(vox_mesh_copy_contacts(NULL, m.a, &contact, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_mesh_copy_contacts(m.grid, m.a, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "contacts is null");
    ck_fails(vox_mesh_copy_contacts(m.grid, m.a, &contact, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_mesh_copy_contacts(m.grid, 0, &contact, 1, &count), VOX_ERROR_INVALID_HANDLE,
             "mesh id is 0");
    ck_assert_uint_eq(count, 77);
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* none = NULL;
    desc.flags = 0x80000000u;
    ck_fails(vox_grid_create(&desc, &none), VOX_ERROR_INVALID_ARGUMENT, "0x80000000");
    vox_grid_destroy(plain);
    end_meeting(&m);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, begin_persist_end, totals_show_events_that_nobody_read,
                   removal_ends_once_with_the_old_ids, clear_ends_with_the_next_step,
                   failed_steps_lose_nothing, filters_end_and_begin, every_event_has_its_pair,
                   steady_state_allocates_nothing, arguments);
}

SUITE(events) { add_for_each_engine(suite, add_tests); }
