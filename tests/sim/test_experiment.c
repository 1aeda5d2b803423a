/* The experiment: two bodies placed in light contact, the recorded frames, and samples of them at any cell
 * size. */
#include "support/suite.h"
#include "tools/zone_distance.h"

#include <math.h>
#include <string.h>
#include <vox/vox_io.h>
#include <vox/vox_sim.h>

static vox_io_mesh* ball;
static vox_sim_body_desc body;

static void setup(void) {
    vox_io_mesh_view view;
    ck_ok(vox_io_make_lattice_ball(3000, 1, &ball));
    ck_ok(vox_io_mesh_get_arrays(ball, &view));
    body = vox_default_sim_body_desc();
    body.positions = view.positions;
    body.vertex_count = view.vertex_count;
    body.tets = view.tets;
    body.tet_count = view.tet_count;
}

static void teardown(void) { vox_io_mesh_destroy(ball); }

static vox_experiment_desc plain(void) {
    vox_experiment_desc desc = vox_default_experiment_desc();
    desc.a = &body;
    return desc;
}

static vox_experiment* create(const vox_experiment_desc* desc) {
    vox_experiment* experiment = NULL;
    ck_ok(vox_experiment_create(desc, &experiment));
    return experiment;
}

static vox_experiment_facts facts_of(const vox_experiment* experiment) {
    vox_experiment_facts facts;
    memset(&facts, 0, sizeof facts);
    facts.struct_size = sizeof facts;
    ck_ok(vox_experiment_get(experiment, &facts));
    return facts;
}

static vox_experiment_sample measure(vox_experiment* experiment, double cell_size, uint64_t* frame_ns) {
    vox_experiment_sample sample;
    memset(&sample, 0, sizeof sample);
    sample.struct_size = sizeof sample;
    ck_ok(vox_experiment_measure(experiment, cell_size, frame_ns, &sample));
    return sample;
}

START_TEST(one_percent_in_contact) {
    vox_experiment_desc desc = plain();
    desc.contact_share = _i == 0 ? 0.01 : 0.03;
    vox_experiment* experiment = create(&desc);
    const vox_experiment_facts facts = facts_of(experiment);
    ck_assert_uint_eq(facts.frames, 10);
    ck_assert_uint_eq(facts.tets, 2 * body.tet_count);
    ck_assert_uint_eq(facts.vertices, 2 * body.vertex_count);
    ck_assert_double_eq_tol(facts.mean_share / desc.contact_share, 1, 0.15);
    double sum = 0;
    for (uint32_t frame = 0; frame < facts.frames; ++frame) sum += facts.shares[frame];
    ck_assert_double_eq_tol(sum / 10, facts.mean_share, 1e-12);
    /* The response pushes them apart. */
    ck_assert_double_lt(facts.shares[9], facts.shares[0]);
    ck_assert_double_gt(facts.shares[9], 0);
    /* Balls of radius 1 that overlap a little, side by side along x, and fall freely. */
    ck_assert_double_lt(facts.distance, 2);
    ck_assert_double_gt(facts.distance, 1.2);
    ck_assert_double_eq_tol(facts.bounds_min[0], -1, 0.1);
    ck_assert_double_eq_tol(facts.bounds_max[0], facts.distance + 1, 0.1);
    ck_assert_double_eq_tol(facts.bounds_max[2], 1, 0.05);
    ck_assert_double_lt(facts.bounds_min[2], -1);
    vox_experiment_destroy(experiment);
}
END_TEST

/* Detected by hand: without turning, the first frame is the body and its copy `distance` further along the
 * axis. */
START_TEST(first_frame_by_hand) {
    vox_experiment_desc desc = plain();
    desc.turn = 0;
    desc.axis[0] = 3;
    desc.axis[1] = -1;
    desc.axis[2] = 2;
    vox_experiment* experiment = create(&desc);
    const vox_experiment_facts facts = facts_of(experiment);
    const size_t count = 3 * (size_t)body.vertex_count;
    float* positions[2];
    vox_grid* grid = NULL;
    ck_ok(vox_grid_create(NULL, &grid));
    for (int b = 0; b < 2; ++b) {
        positions[b] = malloc(count * sizeof(float));
        for (size_t i = 0; i < count; ++i)
            positions[b][i] = (float)(body.positions[i] + b * facts.distance * desc.axis[i % 3] / sqrt(14));
        vox_mesh_desc mesh = vox_default_mesh_desc();
        mesh.positions.data = positions[b];
        mesh.positions.count = body.vertex_count;
        mesh.tets = body.tets;
        mesh.tet_count = body.tet_count;
        vox_body id;
        ck_ok(vox_mesh_insert(grid, &mesh, &id));
    }
    ck_ok(vox_grid_step(grid));
    vox_contact_view view;
    ck_ok(vox_grid_get_contacts(grid, &view));
    ck_assert_uint_gt(view.count, 0);
    char* held = calloc(2 * (size_t)body.tet_count, 1);
    double tets = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_contact* contact = (const vox_contact*)((const char*)view.data + i * view.byte_stride);
        char* mark = &held[contact->tet + (contact->body_b == view.data->body_b ? 0 : body.tet_count)];
        tets += *mark == 0;
        *mark = 1;
    }
    /* Positions may be rounded once more on their way through the simulation: a tet or so may differ. */
    ck_assert_double_eq_tol(tets / (2 * (double)body.tet_count), facts.shares[0],
                            2.5 / (2 * (double)body.tet_count));
    free(held);
    vox_grid_destroy(grid);
    free(positions[0]);
    free(positions[1]);
    vox_experiment_destroy(experiment);
}
END_TEST

/* Whatever the grid that the simulation detects with, its engine and its cell size, the bodies move in the
 * same way; and whatever is measured finds the same contacts in every frame. */
START_TEST(the_cell_size_changes_nothing) {
    vox_sim_desc sim = vox_default_sim_desc();
    memset(sim.floor_normal, 0, sizeof sim.floor_normal);
    const double cell_sizes[] = {0, 0.07, 0.2, 1.7};
    uint64_t hash = 0;
    for (int i = 0; i < 8; ++i) {
        vox_grid_desc inside = vox_default_grid_desc(), measured = vox_default_grid_desc();
        use_engine(&inside, i % 2 ? ENGINE_REFERENCE : ENGINE_FAST);
        inside.cell_size = cell_sizes[i / 2];
        use_engine(&measured, i % 2 ? ENGINE_FAST : ENGINE_REFERENCE);
        if (i % 4 == 2) measured.reference = reference_with(VOX_REFERENCE_DENSE);
        if (i % 4 == 0) measured.reference = reference_with(VOX_REFERENCE_PAPER_HASH);
        sim.grid = &inside;
        vox_experiment_desc desc = plain();
        desc.sim = &sim;
        desc.grid = &measured;
        vox_experiment* experiment = create(&desc);
        const vox_experiment_facts facts = facts_of(experiment);
        if (i == 0) hash = facts.hash;
        ck_assert_uint_eq(facts.hash, hash);
        for (int k = 1; k < 4; ++k)
            ck_assert_uint_eq(measure(experiment, cell_sizes[k], NULL).contacts, facts.contacts);
        vox_experiment_destroy(experiment);
    }
}
END_TEST

START_TEST(samples) {
    vox_experiment_desc desc = plain();
    desc.frames = 4;
    vox_experiment* experiment = create(&desc);
    uint64_t ns[4] = {0, 0, 0, 0};
    const vox_experiment_sample small = measure(experiment, 0.1, ns), large = measure(experiment, 0.5, NULL),
                                again = measure(experiment, 0.1, NULL);
    ck_assert(small.cell_size == 0.1);
    double sum = 0;
    for (int frame = 0; frame < 4; ++frame) {
        ck_assert_uint_gt(ns[frame], 0);
        sum += (double)ns[frame];
    }
    ck_assert_double_eq_tol(small.mean_ns, sum / 4, 1e-6 * sum);
    ck_assert_uint_eq(small.visited_cells, again.visited_cells);
    ck_assert_uint_eq(small.visited_entries, again.visited_entries);
    ck_assert_uint_gt(small.visited_cells, 4 * large.visited_cells);
    ck_assert_uint_lt(small.visited_entries, large.visited_entries);
    ck_assert_uint_eq(small.candidates, large.candidates);
    /* Every tet visits a cell at least, in each frame. */
    ck_assert_uint_ge(large.visited_cells, 4 * 2 * body.tet_count);

    vox_suggestion suggestion;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_experiment_suggest(experiment, NULL, &suggestion));
    ck_assert_uint_eq(suggestion.stats.tets, 2 * body.tet_count);
    ck_assert_double_eq_tol(suggestion.cell_size / suggestion.rules.mean_edge, 1.46, 0.05);
    vox_experiment_destroy(experiment);
}
END_TEST

/* All of the experiment as vox_sim.h describes it. Times are the machine's; what holds on any machine is
 * checked. */
START_TEST(from_create_to_epsilon) {
    enum { count = 8, rounds = 2, frames = 3 };
    vox_experiment_desc desc = plain();
    desc.frames = frames;
    vox_experiment* experiment = create(&desc);
    vox_suggestion suggestion;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_experiment_suggest(experiment, NULL, &suggestion));
    double sizes[count], times[count];
    uint64_t ns[count][rounds][frames], order[count];
    for (int i = 0; i < count; ++i) sizes[i] = suggestion.cell_size * pow(2, (i - 3.5) / 2);
    for (uint64_t round = 0; round < rounds; ++round) {
        ck_ok(vox_experiment_order(count, 1, round, order));
        for (int i = 0; i < count; ++i) measure(experiment, sizes[order[i]], ns[order[i]][round]);
    }
    for (int i = 0; i < count; ++i) {
        ck_ok(vox_experiment_time(ns[i][0], rounds, frames, &times[i]));
        ck_assert_double_gt(times[i], 0);
    }
    vox_time_fit fit;
    fit.struct_size = sizeof fit;
    ck_ok(vox_fit_times(sizes, times, count, &fit));
    double min = 0, max = 0, epsilon = -1;
    ck_ok(vox_fit_zone(&fit, 1.05 * fit.time, &min, &max));
    ck_assert(sizes[0] <= min && min <= fit.cell_size && fit.cell_size <= max && max <= sizes[count - 1]);
    epsilon = zone_distance(4 / fit.cell_size, 4 / max, 4 / fit.cell_size, 4 / min);
    ck_assert(epsilon == 0);
    epsilon = zone_distance(4 / suggestion.cell_size, 4 / max, 4 / fit.cell_size, 4 / min);
    ck_assert_double_ge(epsilon, 0);
    vox_experiment_destroy(experiment);
}
END_TEST

START_TEST(bad_input) {
    const vox_result bad = VOX_ERROR_INVALID_ARGUMENT;
    vox_experiment* untouched = NULL;
    vox_experiment_desc desc = plain();
    ck_fails(vox_experiment_create(NULL, &untouched), bad, "desc is null");
    ck_fails(vox_experiment_create(&desc, NULL), bad, "out_experiment is null");
    desc.a = NULL;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.a is null");
    const double wrong[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; ++i) {
        desc = plain();
        desc.time_step = wrong[i];
        ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.time_step is");
        desc = plain();
        desc.contact_share = wrong[i];
        ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.contact_share is");
        desc = plain();
        desc.axis[0] = wrong[i];
        if (i != 1) ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.axis is");
    }
    desc = plain();
    desc.contact_share = 1;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.contact_share is 1");
    desc = plain();
    desc.frames = 0;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.frames is 0");
    desc.frames = 1001;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.frames is 1001");
    desc = plain();
    desc.turn = 2;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.turn is 2");
    desc = plain();
    desc.reserved = 1;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.reserved is 1");
    desc = plain();
    desc.struct_size = 2;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "struct_size is 2");

    /* A share that no position of two balls has. */
    desc = plain();
    desc.contact_share = 0.9;
    ck_fails(vox_experiment_create(&desc, &untouched), VOX_ERROR_INVALID_STATE, "expected 0.9");

    vox_sim_body_desc other = body;
    desc = plain();
    desc.b = &other;
    other.positions = NULL;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "desc.b has");
    other = body;
    other.tet_count = 0;
    ck_fails(vox_experiment_create(&desc, &untouched), bad, "0 tets");
    other = body;
    double* positions = malloc(3 * (size_t)body.vertex_count * sizeof(double));
    memcpy(positions, body.positions, 3 * (size_t)body.vertex_count * sizeof(double));
    positions[31] = NAN;
    other.positions = positions;
    ck_fails(vox_experiment_create(&desc, &untouched), VOX_ERROR_NON_FINITE,
             "desc.b: vertex 10 has coordinate nan");
    free(positions);
    uint32_t* tets = malloc(4 * (size_t)body.tet_count * sizeof(uint32_t));
    memcpy(tets, body.tets, 4 * (size_t)body.tet_count * sizeof(uint32_t));
    tets[17 * 4] = 900000;
    other = body;
    other.tets = tets;
    ck_fails(vox_experiment_create(&desc, &untouched), VOX_ERROR_INVALID_MESH, "tet 17 names vertex 900000");
    free(tets);
    ck_assert_ptr_null(untouched);
    vox_experiment_destroy(NULL);

    desc = plain();
    desc.frames = 1;
    vox_experiment* experiment = create(&desc);
    vox_experiment_sample sample;
    memset(&sample, 0, sizeof sample);
    sample.struct_size = sizeof sample;
    for (int i = 0; i < 4; ++i)
        ck_fails(vox_experiment_measure(experiment, wrong[i], NULL, &sample), bad, "cell_size is");
    ck_fails(vox_experiment_measure(NULL, 0.1, NULL, &sample), bad, "experiment is null");
    ck_fails(vox_experiment_measure(experiment, 0.1, NULL, NULL), bad, "out_sample is null");
    ck_assert(sample.cell_size == 0);
    ck_fails(vox_experiment_get(experiment, NULL), bad, "out_facts is null");
    ck_fails(vox_experiment_get(NULL, NULL), bad, "experiment is null");
    ck_fails(vox_experiment_suggest(experiment, NULL, NULL), bad, "out is null");
    ck_assert_uint_gt(measure(experiment, 0.1, NULL).visited_cells, 0); /* still good */
    vox_experiment_destroy(experiment);
}
END_TEST

SUITE(experiment) {
    TCase* tests = add_case(suite, "experiment");
    tcase_add_checked_fixture(tests, setup, teardown);
    tcase_add_loop_test(tests, one_percent_in_contact, 0, 2);
    tcase_add_each(tests, first_frame_by_hand, the_cell_size_changes_nothing, samples, from_create_to_epsilon,
                   bad_input);
}
