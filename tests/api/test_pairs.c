/* Pairs: which bodies touch, began to touch or stopped touching, and which contacts they have. A model
 * replays what began and ended and must know at every step what touches, whatever happens between two steps.
 */
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

/* The one pair of a meeting, in that state. */
static void check_one_pair(const vox_grid* grid, vox_pair_state state, vox_body a, vox_body b) {
    const vox_pair_view view = pairs_of(grid);
    ck_assert_uint_eq(view.count, 1);
    const vox_pair* pair = view.data;
    ck_assert_int_eq(pair->state, state);
    ck_assert_uint_eq(pair->body_a, a);
    ck_assert_uint_eq(pair->body_b, b);
    ck_assert_uint_eq(pair->user_data_a, 7);
    ck_assert_uint_eq(pair->user_data_b, UINT64_MAX);
    ck_assert_uint_eq(pair->reserved, 0);
    ck_assert_uint_eq(pair->contact_count > 0, state != VOX_PAIR_ENDED);
}

/* Two boxes that overlap by a quarter. */
typedef struct meeting {
    vox_grid* grid;
    body box, other;
    vox_body a, b;
} meeting;

static meeting new_meeting(void) {
    meeting m;
    m.grid = new_grid(0);
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
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);
    ck_ok(vox_grid_step(m.grid));
    check_one_pair(m.grid, VOX_PAIR_BEGAN, m.a, m.b);
    for (int frame = 0; frame < 6; ++frame) { /* moving, then at rest */
        if (frame < 3) shift(&m.other, 0.0625f);
        ck_ok(vox_grid_step(m.grid));
        check_one_pair(m.grid, VOX_PAIR_PERSISTED, m.a, m.b);
    }
    shift(&m.other, 9);
    ck_ok(vox_grid_step(m.grid));
    check_one_pair(m.grid, VOX_PAIR_ENDED, m.a, m.b);
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);
    end_meeting(&m);
}
END_TEST

/* What a reader has added up of the views that it read. */
typedef struct totals {
    uint64_t began, ended;
} totals;

static void read_pairs(const vox_grid* grid, totals* sums) {
    sums->began += count_pairs(grid, VOX_PAIR_BEGAN);
    sums->ended += count_pairs(grid, VOX_PAIR_ENDED);
}

static void check_totals(const vox_grid* grid, const totals* sums) {
    ck_assert_uint_eq(grid_info(grid).total_began, sums->began);
    ck_assert_uint_eq(grid_info(grid).total_ended, sums->ended);
}

/* Each step reports its own changes: one reader reads every step, the other every second one, and the totals
 * show which is right. */
START_TEST(totals_show_what_nobody_read) {
    meeting m = new_meeting();
    totals all = {0, 0}, half = all;
    check_totals(m.grid, &all);
    for (int step = 0; step < 24; ++step) {
        if (step % 3 != 2) shift(&m.other, step % 6 < 3 ? 1.0f : -1.0f); /* in, out, at rest; and back */
        if (step == 9) {                                                 /* a failed step has no pairs */
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
        read_pairs(m.grid, &all);
        check_totals(m.grid, &all);
        if (step % 2 == 1) read_pairs(m.grid, &half);
    }
    ck_assert_uint_ge(all.ended, 3);
    ck_assert_uint_gt(all.began, half.began);
    ck_assert_uint_eq(all.began - all.ended,
                      count_pairs(m.grid, VOX_PAIR_BEGAN) + count_pairs(m.grid, VOX_PAIR_PERSISTED));
    end_meeting(&m);
}
END_TEST

START_TEST(removal_ends_once_with_the_old_ids) {
    meeting m = new_meeting();
    ck_ok(vox_grid_step(m.grid));
    ck_ok(vox_body_remove(m.grid, m.b));
    check_one_pair(m.grid, VOX_PAIR_BEGAN, m.a, m.b); /* still the last step's */
    const vox_body again = insert(m.grid, &m.other, 5);
    ck_assert_uint_gt(again, m.b);
    ck_ok(vox_grid_step(m.grid));
    const vox_pair_view view = pairs_of(m.grid);
    ck_assert_uint_eq(view.count, 2);
    ck_assert_uint_eq(view.data[0].body_b, m.b);
    ck_assert_int_eq(view.data[0].state, VOX_PAIR_ENDED);
    ck_assert_uint_eq(view.data[0].user_data_b, UINT64_MAX);
    ck_assert_uint_eq(view.data[0].contact_count, 0);
    ck_assert_uint_eq(vox_body_is_valid(m.grid, m.b), 0);
    ck_assert_uint_eq(view.data[1].body_b, again);
    ck_assert_int_eq(view.data[1].state, VOX_PAIR_BEGAN);
    ck_assert_uint_eq(view.data[1].user_data_b, 5);
    ck_ok(vox_body_remove(m.grid, m.a));
    ck_ok(vox_body_remove(m.grid, again));
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(pairs_of(m.grid).count, 1);
    ck_assert_uint_eq(pairs_of(m.grid).data[0].body_b, again);
    ck_assert_int_eq(pairs_of(m.grid).data[0].state, VOX_PAIR_ENDED);
    end_meeting(&m);
}
END_TEST

START_TEST(clear_ends_with_the_next_step) {
    meeting m = new_meeting();
    ck_ok(vox_grid_step(m.grid));
    ck_ok(vox_grid_clear(m.grid));
    ck_assert_uint_eq(pairs_of(m.grid).count, 0); /* no results */
    ck_ok(vox_grid_step(m.grid));
    check_one_pair(m.grid, VOX_PAIR_ENDED, m.a, m.b);
    ck_ok(vox_grid_clear(m.grid));
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);
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
        ck_assert_uint_eq(pairs_of(m.grid).count, 0);
    }
    m.other.positions[0] = kept;
    ck_ok(vox_grid_step(m.grid));
    check_one_pair(m.grid, VOX_PAIR_PERSISTED, m.a, m.b); /* it did not begin twice */
    m.other.positions[0] = NAN;
    ck_fails(vox_grid_step(m.grid), VOX_ERROR_NON_FINITE, "not finite");
    m.other.positions[0] = kept;
    shift(&m.other, 9);
    ck_ok(vox_grid_step(m.grid));
    check_one_pair(m.grid, VOX_PAIR_ENDED, m.a, m.b);
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
            check_one_pair(m.grid, on ? VOX_PAIR_BEGAN : VOX_PAIR_ENDED, m.a, m.b);
            ck_ok(vox_grid_step(m.grid));
            ck_assert_uint_eq(pairs_of(m.grid).count, on);
            ck_assert_uint_eq(count_pairs(m.grid, VOX_PAIR_PERSISTED), on);
        }
    end_meeting(&m);
}
END_TEST

/* Near and touching are one list: two bodies within the margin are a pair before they touch, and after. */
START_TEST(near_before_and_after) {
    static const struct {
        float by;
        vox_pair_state state;
    } moves[] = {{0.5f, VOX_PAIR_NEAR},  {0, VOX_PAIR_NEAR}, {-0.5f, VOX_PAIR_BEGAN}, {0, VOX_PAIR_PERSISTED},
                 {0.5f, VOX_PAIR_ENDED}, {0, VOX_PAIR_NEAR}, {-0.5f, VOX_PAIR_BEGAN}, {9, VOX_PAIR_ENDED}};
    meeting m = new_meeting();
    ck_ok(vox_grid_set_margin(m.grid, 0.5));
    for (size_t i = 0; i < sizeof moves / sizeof *moves; ++i) {
        shift(&m.other, moves[i].by);
        ck_ok(vox_grid_step(m.grid));
        const vox_pair_view view = pairs_of(m.grid);
        ck_assert_uint_eq(view.count, 1);
        ck_assert_int_eq(view.data[0].state, moves[i].state);
        ck_assert_uint_eq(view.data[0].user_data_a, 7);
        ck_assert_uint_eq(view.data[0].user_data_b, UINT64_MAX);
        ck_assert_uint_eq(view.data[0].contact_count > 0,
                          moves[i].state == VOX_PAIR_BEGAN || moves[i].state == VOX_PAIR_PERSISTED);
    }
    ck_ok(vox_grid_step(m.grid));
    ck_assert_uint_eq(pairs_of(m.grid).count, 0);
    ck_assert_uint_eq(grid_info(m.grid).total_began, 2);
    ck_assert_uint_eq(grid_info(m.grid).total_ended, 2);
    end_meeting(&m);
}
END_TEST

/* Each contact is in the range of its pair, once, in order: first those of vertices of body_a. */
static void check_ranges(const vox_grid* grid) {
    const vox_pair_view pairs = pairs_of(grid);
    const vox_contact_view contacts = contacts_of(grid);
    uint64_t next = 0;
    for (uint64_t i = 0; i < pairs.count; ++i) {
        const vox_pair* pair = &pairs.data[i];
        ck_assert_uint_le(pair->body_a, pair->body_b);
        if (i > 0)
            ck_assert(pair[-1].body_a < pair->body_a ||
                      (pair[-1].body_a == pair->body_a && pair[-1].body_b < pair->body_b));
        ck_assert_uint_eq(pair->first_contact, next);
        int of_b = 0;
        for (uint64_t c = 0; c < pair->contact_count; ++c) {
            const uint32_t index = pairs.contacts[next + c];
            ck_assert_uint_lt(index, contacts.count);
            const vox_contact* contact = &contacts.data[index];
            of_b = of_b || contact->body_a != pair->body_a;
            ck_assert_uint_eq(contact->body_a, of_b ? pair->body_b : pair->body_a);
            ck_assert_uint_eq(contact->body_b, of_b ? pair->body_a : pair->body_b);
            if (c > 0) ck_assert_uint_lt(pairs.contacts[next + c - 1], index);
        }
        next += pair->contact_count;
    }
    ck_assert_uint_eq(next, contacts.count); /* and ascending within a pair: so each once */
}

/* ---- the model -------------------------------------------------------------------------------- */

typedef struct key {
    vox_body a, b;
} key;

typedef struct key_set {
    key* keys;
    size_t count;
} key_set;

static int compare_keys(const void* left, const void* right) {
    const key *x = (const key*)left, *y = (const key*)right;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

static void add_key(key_set* set, vox_body a, vox_body b) {
    const key k = {a < b ? a : b, a < b ? b : a};
    set->keys = (key*)realloc(set->keys, (set->count + 1) * sizeof(key));
    set->keys[set->count++] = k;
}

static int has_key(const key_set* set, vox_body a, vox_body b) {
    const key k = {a < b ? a : b, a < b ? b : a};
    for (size_t i = 0; i < set->count; ++i)
        if (compare_keys(&set->keys[i], &k) == 0) return 1;
    return 0;
}

/* User data by body id, for as many ids as the model sees. */
static uint64_t given[16 << 12];

/* What touches and what is near, by the contacts and the constraints of the step. */
static void find_by_contacts(const vox_grid* grid, int with_constraints, key_set* touching, key_set* near) {
    const vox_contact_view contacts = contacts_of(grid);
    for (uint64_t i = 0; i < contacts.count; ++i)
        if (!has_key(touching, contacts.data[i].body_a, contacts.data[i].body_b))
            add_key(touching, contacts.data[i].body_a, contacts.data[i].body_b);
    if (!with_constraints) return;
    const vox_constraint_view constraints = constraints_of(grid);
    for (int pass = 0; pass < 2; ++pass) /* what touches first */
        for (uint64_t i = 0; i < constraints.count; ++i) {
            const vox_constraint* c = &constraints.data[i];
            if ((c->kind == VOX_CONSTRAINT_PROXIMITY) != pass || has_key(touching, c->body_a, c->body_b) ||
                has_key(near, c->body_a, c->body_b))
                continue;
            add_key(pass ? near : touching, c->body_a, c->body_b);
        }
}

/* Replays the states of the pairs in `model`, which then has to be what touches. */
static void check_against_model(const vox_grid* grid, int with_constraints, key_set* model, uint64_t* seen) {
    const vox_pair_view pairs = pairs_of(grid);
    key_set touching = {NULL, 0}, near = {NULL, 0};
    find_by_contacts(grid, with_constraints, &touching, &near);
    uint64_t known = 0, touching_pairs = 0;
    for (uint64_t i = 0; i < pairs.count; ++i) {
        const vox_pair* p = &pairs.data[i];
        const int was = has_key(model, p->body_a, p->body_b), is = has_key(&touching, p->body_a, p->body_b);
        const vox_pair_state expected = is    ? was ? VOX_PAIR_PERSISTED : VOX_PAIR_BEGAN
                                        : was ? VOX_PAIR_ENDED
                                              : VOX_PAIR_NEAR;
        ck_assert_msg(p->state == expected, "pair (%u, %u) has the state %d, expected %d", p->body_a,
                      p->body_b, (int)p->state, (int)expected);
        if (expected == VOX_PAIR_NEAR) ck_assert(has_key(&near, p->body_a, p->body_b));
        ck_assert_uint_eq(p->user_data_a, given[p->body_a]);
        ck_assert_uint_eq(p->user_data_b, given[p->body_b]);
        known += (uint64_t)was;
        touching_pairs += (uint64_t)is;
        ++seen[p->state];
    }
    ck_assert_uint_eq(known, model->count); /* so each that touched persists or ends */
    ck_assert_uint_eq(touching_pairs, touching.count);
    for (size_t i = 0; i < near.count; ++i) {
        uint64_t p = 0;
        while (p < pairs.count &&
               (pairs.data[p].body_a != near.keys[i].a || pairs.data[p].body_b != near.keys[i].b))
            ++p;
        ck_assert_uint_lt(p, pairs.count);
    }
    check_ranges(grid);
    free(model->keys);
    free(near.keys);
    *model = touching;
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

/* With contacts alone; and with all that makes bodies a pair. */
START_TEST(every_beginning_has_its_end) {
    enum { frames = 400 };
    for (uint64_t seed = 0; seed < 6; ++seed) {
        const int with_constraints = seed >= 4;
        uint64_t random = seed, seen[4] = {0};
        vox_grid* grid = new_grid(with_constraints ? VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES : 0);
        if (with_constraints) ck_ok(vox_grid_set_margin(grid, 0.125));
        actor actors[most_meshes];
        key_set touching = {NULL, 0};
        memset(actors, 0, sizeof actors);
        for (int frame = 0; frame <= frames; ++frame) {
            if (frame < frames)
                for (uint32_t n = random_below(&random, 4); n > 0; --n) act(grid, actors, &random);
            else
                ck_ok(vox_grid_clear(grid)); /* all that began ends */
            ck_ok(vox_grid_step(grid));
            check_against_model(grid, with_constraints, &touching, seen);
        }
        ck_assert_uint_eq(touching.count, 0);
        ck_assert_uint_eq(seen[VOX_PAIR_BEGAN], seen[VOX_PAIR_ENDED]);
        ck_assert_uint_eq(seen[VOX_PAIR_BEGAN], grid_info(grid).total_began);
        ck_assert_uint_eq(seen[VOX_PAIR_ENDED], grid_info(grid).total_ended);
        ck_assert_uint_gt(seen[VOX_PAIR_BEGAN], frames / 40); /* something happened */
        ck_assert_uint_eq(seen[VOX_PAIR_NEAR] > 10, with_constraints);
        for (int i = 0; i < most_meshes; ++i)
            if (actors[i].mesh) free_body(&actors[i].shape);
        free(touching.keys);
        vox_grid_destroy(grid);
    }
}
END_TEST

/* ---- memory and arguments --------------------------------------------------------------------- */

START_TEST(steady_state_allocates_nothing) {
    ledger l = {0};
    vox_grid_desc desc = engine_desc();
    desc.allocator = ledger_allocator(&l);
    vox_grid* grid = grid_of(&desc);
    ck_ok(vox_grid_reserve(grid, 3, 20000)); /* the first steps too have room for pairs */
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
        ck_assert_uint_gt(pairs_of(grid).count, 0);
    }
    ck_assert_uint_eq(l.calls, before);
    vox_grid_destroy(grid);
    for (int i = 0; i < 3; ++i) free_body(&boxes[i]);
}
END_TEST

START_TEST(arguments) {
    meeting m = new_meeting();
    vox_pair_view view = {NULL, 7, NULL};
    ck_ok(vox_grid_step(m.grid));
    ck_fails(vox_grid_get_pairs(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_get_pairs(m.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_assert_uint_eq(view.count, 7);
    end_meeting(&m);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, begin_persist_end, totals_show_what_nobody_read, removal_ends_once_with_the_old_ids,
                   clear_ends_with_the_next_step, failed_steps_lose_nothing, filters_end_and_begin,
                   near_before_and_after, every_beginning_has_its_end, steady_state_allocates_nothing,
                   arguments);
}

SUITE(pairs) { add_for_each_engine(suite, add_tests); }
