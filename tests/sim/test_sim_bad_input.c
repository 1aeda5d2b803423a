/* What nobody should do to bodies: clear errors with numbers, or motion that stays finite and slow. Also:
 * what must not change the motion. */
#include "sim/scene.h"

/* ---- starts that penetrate -------------------------------------------------------------------- */

/* Two seconds without gravity; the bodies stay finite, nothing is faster than `speed`, and they calm down. */
static void stays_calm(vox_sim* sim, double speed) {
    double last = 0;
    for (int frame = 0; frame < 120; ++frame) {
        ck_ok(vox_sim_step(sim, 1.0 / 60));
        if (frame == 0) ck_assert_uint_gt(counter(sim, "constraints"), 0);
        const vox_sim_energy now = energy_of(sim, VOX_NULL_BODY);
        ck_assert(isfinite(total(&now)));
        ck_assert_msg(now.max_speed <= speed, "frame %d: speed %g", frame, now.max_speed);
        last = now.max_speed;
    }
    ck_assert_double_le(last, speed / 2);
}

START_TEST(crossing_bars) {
    const vox_sim_desc desc = weightless();
    vox_sim* sim = open_sim(&desc);
    vox_io_mesh* bar = box(4, 0.5, 0.5, 0.25);
    const vox_body a = insert(sim, bar, NULL, 0, 0, 0, 0),
                   b = insert(sim, bar, NULL, acos(-1.0) / 2, 0, 0, 0.1);
    stays_calm(sim, 5);
    ck_finite(sim, a);
    ck_finite(sim, b);
    vox_io_mesh_destroy(bar);
    vox_sim_destroy(sim);
}
END_TEST

START_TEST(coincident_bodies) {
    const vox_sim_desc desc = weightless();
    vox_sim* sim = open_sim(&desc);
    vox_io_mesh* mesh = ball(0.5, 0.2);
    const vox_body a = insert(sim, mesh, NULL, 0, 0, 0, 0), b = insert(sim, mesh, NULL, 0, 0, 0, 0);
    stays_calm(sim, 5);
    ck_finite(sim, a);
    ck_finite(sim, b);
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
}
END_TEST

START_TEST(enclosed_body) {
    const vox_sim_desc desc = weightless();
    vox_sim* sim = open_sim(&desc);
    vox_io_mesh *outer = ball(1, 0.25), *inner = ball(0.2, 0.1);
    const vox_body a = insert(sim, outer, NULL, 0, 0, 0, 0),
                   b = insert(sim, inner, NULL, 0.3, 0.2, 0.1, 0.05);
    stays_calm(sim, 20); /* squeezed out through the wall, which springs back */
    ck_finite(sim, a);
    ck_finite(sim, b);
    vox_io_mesh_destroy(outer);
    vox_io_mesh_destroy(inner);
    vox_sim_destroy(sim);
}
END_TEST

START_TEST(below_the_floor) {
    vox_sim* sim = open_sim(NULL);
    vox_io_mesh* mesh = ball(0.5, 0.2);
    const vox_body body = insert(sim, mesh, NULL, 0, 0, 0, -0.2);
    double fastest = 0;
    for (int frame = 0; frame < 180; ++frame) {
        ck_ok(vox_sim_step(sim, 1.0 / 60));
        fastest = fmax(fastest, energy_of(sim, body).max_speed);
    }
    ck_assert_double_le(fastest, 5); /* it is pushed up at 1 */
    ck_assert_double_gt(energy_of(sim, body).centre[2], 0.4);
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
}
END_TEST

/* ---- shapes ----------------------------------------------------------------------------------- */

/* A ball squashed flat, or turned inside out, comes back without an explosion. */
START_TEST(squashed_and_inverted) {
    static const double scales[] = {0, -1, 1e-9};
    vox_io_mesh* mesh = ball(0.5, 0.2);
    vox_io_mesh_view rest;
    ck_ok(vox_io_mesh_get_arrays(mesh, &rest));
    for (int s = 0; s < 3; ++s) {
        const vox_sim_desc desc = weightless();
        vox_sim* sim = open_sim(&desc);
        const vox_body body = insert(sim, mesh, NULL, 0, 0, 0, 0);
        double* squashed = (double*)malloc(3 * sizeof(double) * rest.vertex_count);
        for (uint64_t i = 0; i < 3 * rest.vertex_count; ++i)
            squashed[i] = rest.positions[i] * (i % 3 == 2 ? scales[s] : 1);
        ck_ok(vox_sim_body_set_state(sim, body, squashed, NULL));
        free(squashed);
        const vox_sim_energy before = energy_of(sim, body);
        for (int frame = 0; frame < 120; ++frame) {
            ck_ok(vox_sim_step(sim, 1.0 / 60));
            ck_assert_double_le(energy_of(sim, body).max_speed, 100);
        }
        const vox_sim_energy after = energy_of(sim, body);
        ck_finite(sim, body);
        ck_assert_double_le(total(&after), total(&before) * (1 + 1e-9));
        vox_sim_destroy(sim);
    }
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* One good tet, one flat, one inverted, and a vertex in none. */
static const double odd_positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, -1, 5, 5, 5};
static const uint32_t odd_tets[] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5};

static vox_sim_body_desc odd_body(void) {
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.positions = odd_positions;
    desc.vertex_count = 7;
    desc.tets = odd_tets;
    desc.tet_count = 3;
    return desc;
}

START_TEST(flat_and_inverted_tets_are_counted) {
    log_book book = {0, ""};
    vox_sim_desc settings = vox_default_sim_desc();
    const vox_log log = {write_log, &book};
    settings.log = &log;
    vox_sim* sim = open_sim(&settings);
    vox_sim_body_desc desc = odd_body();
    desc.user_data = 77;
    vox_body body;
    ck_ok(vox_sim_body_insert(sim, &desc, &body));
    ck_assert_uint_eq(counter(sim, "tets"), 3);
    ck_assert_uint_eq(counter(sim, "flat_tets"), 1);
    ck_assert_uint_eq(counter(sim, "inverted_tets"), 1);
    ck_assert_uint_eq(counter(sim, "volumes"), 2);
    ck_assert_uint_eq(counter(sim, "edges"), 12);
    ck_assert_uint_eq(counter(sim, "raised_masses"),
                      2); /* of the flat tet's own corner, and of the loose vertex */
    ck_assert_int_eq(book.lines, 1);
    ck_assert_ptr_nonnull(
        strstr(book.text, "body 1 (slot 0, user data 77): 1 of 3 tets have no rest volume"));
    ck_assert_double_eq_tol(energy_of(sim, body).mass, 1000.0 / 3, 100);
    steps(sim, 120);
    ck_finite(sim, body);
    vox_sim_destroy(sim);
}
END_TEST

/* ---- time steps and stiffness ----------------------------------------------------------------- */

START_TEST(too_large_a_step_is_cut_down) {
    log_book book = {0, ""};
    vox_io_mesh* mesh = ball(0.5, 0.25);
    vox_sim_desc desc = vox_default_sim_desc();
    vox_sim* regular = open_sim(&desc);
    const vox_log log = {write_log, &book};
    desc.log = &log;
    vox_sim* clamped = open_sim(&desc);
    vox_sim_body_desc soft = vox_default_sim_body_desc();
    soft.youngs_modulus = soft.bulk_modulus = 1e4;
    const vox_body a = insert(regular, mesh, &soft, 0, 0, 0, 1), b = insert(clamped, mesh, &soft, 0, 0, 0, 1);
    for (int i = 0; i < 60; ++i) {
        ck_ok(vox_sim_step(regular, 1.0 / 30));
        ck_ok(vox_sim_step(clamped, i % 2 ? 5 : 1e300));
    }
    ck_assert_int_eq(book.lines, 1);
    ck_assert_ptr_nonnull(strstr(book.text, "time step 1e+300 clamped to max_time_step 0.0333333"));
    ck_assert_uint_eq(counter(clamped, "clamped_steps"), 60);
    ck_assert_uint_eq(counter(regular, "clamped_steps"), 0);
    const vox_sim_body_view x = view_of(regular, a), y = view_of(clamped, b);
    ck_assert_mem_eq(x.positions, y.positions, 3 * sizeof(double) * x.vertex_count);
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(regular);
    vox_sim_destroy(clamped);
}
END_TEST

START_TEST(absurd_stiffness_is_cut_down) {
    log_book book = {0, ""};
    vox_io_mesh* mesh = ball(0.5, 0.25);
    vox_sim_desc desc = vox_default_sim_desc();
    const vox_log log = {write_log, &book};
    desc.log = &log;
    vox_sim* sim = open_sim(&desc);
    vox_sim_body_desc hard = vox_default_sim_body_desc();
    hard.youngs_modulus = 1e60;
    hard.bulk_modulus = 1e60;
    hard.damping = 1e60;
    insert(sim, mesh, &hard, 0, 0, 0, 0.6);
    insert(sim, mesh, &hard, 0, 0.1, 0, 1.7);
    for (int frame = 0; frame < 120; ++frame) {
        ck_ok(vox_sim_step(sim, 1.0 / 60));
        ck_assert_double_le(energy_of(sim, VOX_NULL_BODY).max_speed, 10);
    }
    ck_assert_uint_eq(counter(sim, "softened"), counter(sim, "edges") + counter(sim, "volumes"));
    ck_assert_int_eq(book.lines, 1);
    ck_assert_ptr_nonnull(strstr(book.text, "body 1 (slot 0, user data 0): "));
    ck_assert_ptr_nonnull(strstr(book.text, "are too stiff for substeps of 0.00166667"));
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
}
END_TEST

/* ---- what does not change the motion ---------------------------------------------------------- */

/* Three bodies fall on each other; the state of the last after a second goes to `state`. */
static size_t fall(engine_kind engine, uint32_t workers, double cell_size, double* state) {
    vox_grid_desc grid = vox_default_grid_desc();
    use_engine(&grid, engine);
    grid.worker_count = workers;
    grid.cell_size = cell_size;
    vox_sim_desc desc = vox_default_sim_desc();
    desc.grid = &grid;
    vox_sim* sim = open_sim(&desc);
    vox_io_mesh* mesh = ball(0.5, 0.2);
    vox_body body = VOX_NULL_BODY;
    for (int i = 0; i < 3; ++i) body = insert(sim, mesh, NULL, 0.4 * i, 0.1 * i, -0.05 * i, 0.55 + 1.05 * i);
    uint64_t most = 0;
    for (int frame = 0; frame < 60; ++frame) {
        ck_ok(vox_sim_step(sim, 1.0 / 60));
        const uint64_t found = counter(sim, "constraints");
        if (found > most) most = found;
    }
    ck_assert_uint_gt(most, 10);
    const vox_sim_body_view view = view_of(sim, body);
    const size_t count = 3 * (size_t)view.vertex_count;
    memcpy(state, view.positions, count * sizeof(double));
    memcpy(state + count, view.velocities, count * sizeof(double));
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
    return 2 * count;
}

START_TEST(the_same_bits_every_time) {
    static double first[20000], other[20000];
    const size_t count = fall(ENGINE_FAST, 1, 0, first);
    ck_assert_uint_le(count, 20000);
    static const struct {
        engine_kind engine;
        uint32_t workers;
        double cell_size;
    } ways[] = {{ENGINE_FAST, 1, 0},
                {ENGINE_FAST, 2, 0},
                {ENGINE_FAST, 5, 0},
                {ENGINE_FAST, 1, 0.7},
                {ENGINE_REFERENCE, 1, 0.3}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; ++i) {
        fall(ways[i].engine, ways[i].workers, ways[i].cell_size, other);
        ck_assert_msg(memcmp(first, other, count * sizeof(double)) == 0, "way %zu moves differently", i);
    }
}
END_TEST

/* ---- the interface ---------------------------------------------------------------------------- */

START_TEST(refuses_bad_settings) {
    vox_sim* sim = NULL;
    vox_sim_desc desc = vox_default_sim_desc();
#define REFUSED(field, value, words)                                                                         \
    desc = vox_default_sim_desc();                                                                           \
    desc.field = (value);                                                                                    \
    ck_fails(vox_sim_create(&desc, &sim), VOX_ERROR_INVALID_ARGUMENT, words);                                \
    ck_assert_ptr_null(sim)
    REFUSED(substeps, 0, "substeps is 0");
    REFUSED(substeps, 10001, "substeps is 10001");
    REFUSED(reserved, 7, "reserved is 7");
    REFUSED(gravity[1], NAN, "gravity is nan on axis 1");
    REFUSED(max_time_step, 0, "max_time_step is 0");
    REFUSED(max_time_step, INFINITY, "max_time_step is inf");
    REFUSED(floor_normal[0], INFINITY, "floor_normal is inf on axis 0");
    REFUSED(floor_offset, NAN, "floor_offset is nan");
    REFUSED(friction, -1, "friction is -1");
    REFUSED(contact_compliance, -2, "contact_compliance is -2");
    REFUSED(max_push_speed, NAN, "max_push_speed is nan");
    REFUSED(contact_slop, NAN, "contact_slop is nan");
    REFUSED(struct_size, 3, "struct_size is 3");
#undef REFUSED
    vox_grid_desc grid = vox_default_grid_desc();
    desc = vox_default_sim_desc();
    desc.grid = &grid;
    grid.cell_size = -1;
    ck_fails(vox_sim_create(&desc, &sim), VOX_ERROR_INVALID_ARGUMENT, "cell_size is -1");
    ck_fails(vox_sim_create(NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_sim is null");
    vox_sim_destroy(NULL);
}
END_TEST

START_TEST(refuses_bad_bodies) {
    vox_sim* sim = open_sim(NULL);
    vox_body body = VOX_NULL_BODY;
    double bad[21];
    vox_sim_body_desc desc;
#define REFUSED(field, value, code, words)                                                                   \
    desc = odd_body();                                                                                       \
    desc.field = (value);                                                                                    \
    ck_fails(vox_sim_body_insert(sim, &desc, &body), code, words);                                           \
    ck_assert_uint_eq(body, VOX_NULL_BODY)
    REFUSED(positions, NULL, VOX_ERROR_INVALID_ARGUMENT, "positions are null");
    REFUSED(tets, NULL, VOX_ERROR_INVALID_ARGUMENT, "at least one tet");
    REFUSED(tet_count, 0, VOX_ERROR_INVALID_ARGUMENT, "tet_count is 0");
    REFUSED(vertex_count, 4, VOX_ERROR_INVALID_MESH, "tet 1 names vertex 4 of 4");
    REFUSED(vertex_count, 1ull << 40, VOX_ERROR_LIMIT, "1099511627776 vertices");
    REFUSED(flags, 4, VOX_ERROR_INVALID_ARGUMENT, "flags are 0x4");
    REFUSED(density, 0, VOX_ERROR_INVALID_ARGUMENT, "density is 0");
    REFUSED(density, 1e61, VOX_ERROR_INVALID_ARGUMENT, "at most 1e60");
    REFUSED(density, NAN, VOX_ERROR_INVALID_ARGUMENT, "density is nan");
    REFUSED(youngs_modulus, -1, VOX_ERROR_INVALID_ARGUMENT, "youngs_modulus is -1");
    REFUSED(bulk_modulus, INFINITY, VOX_ERROR_INVALID_ARGUMENT, "bulk_modulus is inf");
    REFUSED(damping, NAN, VOX_ERROR_INVALID_ARGUMENT, "damping is nan");
    memcpy(bad, odd_positions, sizeof bad);
    bad[5] = NAN;
    REFUSED(positions, bad, VOX_ERROR_NON_FINITE, "positions of vertex 1");
    REFUSED(rest_positions, bad, VOX_ERROR_NON_FINITE, "rest_positions of vertex 1");
    bad[5] = -INFINITY;
    REFUSED(velocities, bad, VOX_ERROR_NON_FINITE, "velocities of vertex 1");
    bad[5] = 1e20;
    REFUSED(positions, bad, VOX_ERROR_INVALID_ARGUMENT, "is 1e+20, expected at most 1e+15");
    for (int i = 2; i < 21; i += 3) bad[i] = 0;
    REFUSED(rest_positions, bad, VOX_ERROR_INVALID_ARGUMENT, "mass of 0: 3 of its 3 tets");
#undef REFUSED
    ck_assert_uint_eq(counter(sim, "bodies"), 0);
    ck_fails(vox_sim_body_insert(NULL, &desc, &body), VOX_ERROR_INVALID_ARGUMENT, "sim is null");
    ck_fails(vox_sim_body_insert(sim, NULL, &body), VOX_ERROR_INVALID_ARGUMENT, "desc is null");
    ck_fails(vox_sim_body_insert(sim, &desc, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_body is null");
    vox_sim_destroy(sim);
}
END_TEST

START_TEST(refuses_bad_calls) {
    vox_sim* sim = open_sim(NULL);
    const vox_sim_body_desc desc = odd_body();
    vox_body body, again;
    ck_ok(vox_sim_body_insert(sim, &desc, &body));
    static const double steps[] = {0, -1, NAN, INFINITY, 1e-300};
    for (int i = 0; i < 5; ++i)
        ck_fails(vox_sim_step(sim, steps[i]), VOX_ERROR_INVALID_ARGUMENT, "time_step is");
    double bad[21];
    memcpy(bad, odd_positions, sizeof bad);
    bad[20] = NAN;
    ck_fails(vox_sim_body_set_state(sim, body, bad, NULL), VOX_ERROR_NON_FINITE, "vertex 6");
    ck_fails(vox_sim_body_set_state(sim, body, odd_positions, bad), VOX_ERROR_NON_FINITE, "vertex 6");
    ck_assert_mem_eq(view_of(sim, body).positions, odd_positions, sizeof odd_positions);

    vox_sim_body_view view;
    vox_sim_energy e;
    vox_grid* grid;
    ck_fails(vox_sim_step(NULL, 1), VOX_ERROR_INVALID_ARGUMENT, "sim is null");
    ck_fails(vox_sim_get_grid(NULL, &grid), VOX_ERROR_INVALID_ARGUMENT, "sim is null");
    ck_fails(vox_sim_get_grid(sim, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_grid is null");
    ck_fails(vox_sim_body_get_view(sim, body, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_sim_get_energy(sim, body, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_energy is null");
    ck_fails(vox_sim_get_counters(sim, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");

    ck_ok(vox_sim_body_remove(sim, body));
    ck_ok(vox_sim_body_insert(sim, &desc, &again)); /* in the same slot of the grid */
    const vox_body ids[] = {VOX_NULL_BODY, body, 12345};
    for (int i = 0; i < 3; ++i) {
        ck_fails(vox_sim_body_remove(sim, ids[i]), VOX_ERROR_INVALID_HANDLE, "names no body");
        ck_fails(vox_sim_body_get_view(sim, ids[i], &view), VOX_ERROR_INVALID_HANDLE, "names no body");
        ck_fails(vox_sim_body_set_state(sim, ids[i], NULL, NULL), VOX_ERROR_INVALID_HANDLE, "names no body");
        if (i > 0) ck_fails(vox_sim_get_energy(sim, ids[i], &e), VOX_ERROR_INVALID_HANDLE, "names no body");
    }
    vox_sim_destroy(sim);
}
END_TEST

/* A smaller struct of an older program: what it does not cover is 0, or is not written. */
START_TEST(structs_may_be_smaller) {
    vox_sim_desc desc = vox_default_sim_desc();
    memset(&desc.grid, 0xab, sizeof desc - offsetof(vox_sim_desc, grid));
    desc.struct_size = offsetof(vox_sim_desc, grid);
    vox_sim* sim = open_sim(&desc);
    vox_sim_destroy(sim);
}
END_TEST

/* Whatever the flags of its grid, it has the constraints that it responds to. */
START_TEST(sets_the_flag_that_it_needs) {
    vox_sim_desc desc = vox_default_sim_desc();
    vox_grid_desc of_grid = vox_default_grid_desc();
    vox_grid_info info;
    vox_grid* grid;
    info.struct_size = sizeof info;
    of_grid.flags = VOX_GRID_EDGES;
    desc.grid = &of_grid;
    vox_sim* sim = open_sim(&desc);
    ck_ok(vox_sim_get_grid(sim, &grid));
    ck_ok(vox_grid_get_info(grid, &info));
    ck_assert_uint_eq(info.flags, VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS);
    vox_sim_destroy(sim);
}
END_TEST

/* A mesh that somebody else put into the grid is detected but not answered; the grid tells the contacts'
 * bodies. */
START_TEST(the_grid_is_within_reach) {
    const vox_sim_desc desc = weightless();
    vox_sim* sim = open_sim(&desc);
    vox_io_mesh* mesh = ball(0.5, 0.25);
    vox_sim_body_desc like = vox_default_sim_body_desc();
    like.user_data = 77;
    const vox_body body = insert(sim, mesh, &like, 0, 0, 0, 0);
    vox_grid* grid;
    ck_ok(vox_sim_get_grid(sim, &grid));
    static const float point[3] = {0.1f, 0.1f, 0.1f};
    vox_mesh_desc probe = vox_default_mesh_desc();
    probe.positions = vox_float_positions(point, 1);
    vox_body probe_id;
    ck_ok(vox_mesh_insert(grid, &probe, &probe_id));
    steps(sim, 10);
    vox_contact_view contacts;
    ck_ok(vox_grid_get_contacts(grid, &contacts));
    ck_assert_uint_gt(contacts.count, 0);
    ck_assert_uint_eq(contacts.data[0].body_a, probe_id);
    ck_assert_uint_eq(contacts.data[0].body_b, body);
    uint64_t user_data = 0;
    ck_ok(vox_body_get_user_data(grid, body, &user_data));
    ck_assert_uint_eq(user_data, 77);
    ck_assert_uint_eq(counter(sim, "constraints"), 0);
    ck_assert_double_le(energy_of(sim, body).max_speed, 1e-9);
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
}
END_TEST

/* ---- bodies changed in the grid, behind the back of the simulation ---- */

/* A hundred vertices and tets within the two cubes of `changed_sim`. */
static float crowd[300];
static uint32_t crowd_tets[400];

static void other_topology(vox_grid* grid, vox_body body) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(crowd, 100);
    desc.tets = crowd_tets;
    desc.tet_count = 100;
    ck_ok(vox_mesh_set_topology(grid, body, &desc));
}
static void more_vertices(vox_grid* grid, vox_body body) {
    vox_vertices_desc desc = vox_default_vertices_desc();
    uint32_t first;
    desc.count = 92;
    desc.positions = vox_float_positions(crowd, 100);
    ck_ok(vox_mesh_append_vertices(grid, body, &desc, &first));
}
static void other_positions(vox_grid* grid, vox_body body) {
    ck_ok(bind_array(grid, body, crowd, VOX_FORMAT_FLOAT, 0, 0));
}
static void no_constraints(vox_grid* grid, vox_body body) {
    (void)body;
    ck_ok(vox_grid_set_flags(grid, 0));
}
static void removed(vox_grid* grid, vox_body body) { ck_ok(vox_body_remove(grid, body)); }
static void cleared(vox_grid* grid, vox_body body) {
    (void)body;
    ck_ok(vox_grid_clear(grid));
}

static const struct {
    void (*change)(vox_grid* grid, vox_body body);
    const char* error; /* null: the simulation goes on without the body's contacts */
} changes[] = {{other_topology, "changed through vox_sim_get_grid"},
               {more_vertices, "changed through vox_sim_get_grid"},
               {other_positions, "changed through vox_sim_get_grid"},
               {no_constraints, "VOX_GRID_CONSTRAINTS"},
               {removed, NULL},
               {cleared, NULL}};
enum { change_count = sizeof changes / sizeof *changes };

/* It says so instead of reading what is not there, and the bodies can still be read and removed. */
START_TEST(changes_in_its_grid) {
    const vox_sim_desc settings = weightless();
    static const uint32_t cube[20] = {1, 2, 4, 7, 0, 1, 2, 4, 3, 1, 2, 7, 5, 1, 4, 7, 6, 2, 4, 7};
    vox_sim* sim = open_sim(&settings);
    vox_body bodies[2];
    vox_grid* grid;
    for (int i = 0; i < 300; ++i) crowd[i] = (float)(i * 5 % 7) * 0.2f + 0.1f;
    for (uint32_t i = 0; i < 400; ++i) crowd_tets[i] = i * 37 % 100;
    for (int b = 0; b < 2; ++b) {
        double positions[24];
        for (int i = 0; i < 24; ++i) positions[i] = (i / 3 >> i % 3 & 1) + 0.3 * b;
        vox_sim_body_desc desc = vox_default_sim_body_desc();
        desc.positions = positions;
        desc.vertex_count = 8;
        desc.tets = cube;
        desc.tet_count = 5;
        desc.user_data = 50 + (uint64_t)b;
        ck_ok(vox_sim_body_insert(sim, &desc, &bodies[b]));
    }
    ck_ok(vox_sim_step(sim, 1e-4));
    ck_assert_uint_gt(counter(sim, "constraints"), 0);
    ck_ok(vox_sim_get_grid(sim, &grid));
    changes[_i].change(grid, bodies[0]);
    if (changes[_i].error) {
        const double before = view_of(sim, bodies[1]).positions[5];
        ck_fails(vox_sim_step(sim, 1e-4), VOX_ERROR_INVALID_STATE, changes[_i].error);
        if (changes[_i].change != no_constraints)
            ck_assert_ptr_nonnull(strstr(vox_last_error(), "body 4097 (slot 1, user data 51)"));
        ck_assert(view_of(sim, bodies[1]).positions[5] == before);
    } else {
        ck_ok(vox_sim_step(sim, 1e-4));
        ck_assert_uint_eq(counter(sim, "constraints"), 0);
    }
    ck_ok(vox_sim_body_remove(sim, bodies[0]));
    if (changes[_i].change != no_constraints) ck_ok(vox_sim_step(sim, 1e-4));
    vox_sim_destroy(sim);
}
END_TEST

/* ---- repair ----------------------------------------------------------------------------------- */

START_TEST(resolve_refuses) {
    double positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, before[12];
    memcpy(before, positions, sizeof before);
    const uint32_t tet[4] = {0, 1, 2, 3}, face[3] = {0, 1, 4};
    vox_resolve_desc desc = vox_default_resolve_desc();
    vox_resolve_report report = {.struct_size = sizeof report};
    vox_resolve_body body = vox_default_resolve_body();
    body.positions = positions;
    body.vertex_count = 4;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "0 tets and 0 faces");
    body.faces = face;
    body.face_count = 1;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_MESH, "face 0 names vertex 4 of 4");
    body.tets = tet;
    body.tet_count = 1;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "1 tets and 1 faces");
    body.face_count = 0;
    body.flags = 2;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "flags are 0x2");
    body.flags = 0;
    desc.gap = -1;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "gap is -1");
    desc.gap = 0;
    desc.place_capacity = 1;
    ck_fails(vox_resolve(&desc, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "places are null");
    ck_fails(vox_resolve(NULL, &body, 0, &report), VOX_ERROR_INVALID_ARGUMENT, "no bodies");
    ck_fails(vox_resolve(NULL, &body, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_report");
    report.struct_size = 0;
    ck_fails(vox_resolve(NULL, &body, 1, &report), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 0");
    ck_assert_mem_eq(positions, before, sizeof before);
    report.struct_size = sizeof report;
    ck_ok(vox_resolve(NULL, &body, 1, &report));
    ck_assert_uint_eq(report.resolved, 1);
    ck_assert_mem_eq(positions, before, sizeof before);
}
END_TEST

SUITE(sim_bad_input) {
    TCase* tests = add_case(suite, "bad input");
    tcase_add_each(tests, crossing_bars, coincident_bodies, enclosed_body, below_the_floor,
                   squashed_and_inverted, flat_and_inverted_tets_are_counted, too_large_a_step_is_cut_down,
                   absurd_stiffness_is_cut_down, the_same_bits_every_time, refuses_bad_settings,
                   refuses_bad_bodies, refuses_bad_calls, structs_may_be_smaller, sets_the_flag_that_it_needs,
                   the_grid_is_within_reach, resolve_refuses);
    tcase_add_loop_test(tests, changes_in_its_grid, 0, change_count);
}
