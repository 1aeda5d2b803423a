// The experiment: two bodies placed in light contact, the recorded frames, samples of them at any cell size,
// the order of the samples and the time of their rounds.
#include "tools/body.hpp"
#include "tools/experiment/experiment.hpp"
#include "tools/experiment/fit.hpp"
#include "tools/failure.hpp"
#include "tools/zone_distance.h"

#include <cmath>
#include <cstring>

#include "support/suite.h" // whose macros no header of C++ may see

using tool::Experiment;
using tool::ExperimentSettings;
using tool::SweepSample;

namespace {

tool::ExperimentBody ball;

void setup() {
    vox_io_mesh* made = nullptr;
    ck_ok(vox_io_make_lattice_ball(3000, 1, &made));
    const tool::Mesh mesh(made);
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(made, &view));
    ball.positions.assign(view.positions, view.positions + 3 * view.vertex_count);
    ball.tets.assign(view.tets, view.tets + 4 * view.tet_count);
}

std::size_t tets() { return ball.tets.size() / 4; } // of one

template <class Call>
void refused(const Call& call, const char* words) {
    try {
        call();
        ck_abort_msg("expected: %s", words);
    } catch (const tool::Failure& failure) {
        ck_assert_msg(std::strstr(failure.what(), words) != nullptr, "%s", failure.what());
    }
}

} // namespace

START_TEST(one_percent_in_contact) {
    ExperimentSettings settings;
    settings.contact_share = _i == 0 ? 0.01 : 0.03;
    const Experiment experiment(settings, ball, ball);
    const std::vector<double>& shares = experiment.shares();
    ck_assert_uint_eq(shares.size(), 10);
    ck_assert_uint_eq(experiment.tets(), 2 * tets());
    ck_assert_double_eq_tol(experiment.mean_share() / settings.contact_share, 1, 0.15);
    double sum = 0;
    for (const double share : shares) sum += share;
    ck_assert_double_eq_tol(sum / 10, experiment.mean_share(), 1e-12);
    // The response pushes them apart.
    ck_assert_double_lt(shares[9], shares[0]);
    ck_assert_double_gt(shares[9], 0);
    // Balls of radius 1 that overlap a little, side by side along x, and fall freely.
    ck_assert_double_lt(experiment.distance(), 2);
    ck_assert_double_gt(experiment.distance(), 1.2);
    const tool::Bounds bounds = experiment.bounds();
    ck_assert_double_eq_tol(bounds.min[0], -1, 0.1);
    ck_assert_double_eq_tol(bounds.max[0], experiment.distance() + 1, 0.1);
    ck_assert_double_eq_tol(bounds.max[2], 1, 0.05);
    ck_assert_double_lt(bounds.min[2], -1);
}
END_TEST

// Detected by hand: without turning, the first frame is the body and its copy `distance` further along the
// axis.
START_TEST(first_frame_by_hand) {
    ExperimentSettings settings;
    settings.as_placed = true;
    settings.axis = {3, -1, 2};
    const Experiment experiment(settings, ball, ball);
    std::vector<float> positions[2];
    vox_grid* grid = grid_of(nullptr);
    for (int b = 0; b < 2; ++b) {
        for (std::size_t i = 0; i < ball.positions.size(); ++i)
            positions[b].push_back(static_cast<float>(
                ball.positions[i] + b * experiment.distance() * settings.axis[i % 3] / std::sqrt(14)));
        const vox_mesh_desc mesh = tool::mesh_of(positions[b], ball.tets);
        insert_mesh(grid, &mesh);
    }
    ck_ok(vox_grid_step(grid));
    const vox_contact_view view = contacts_of(grid);
    ck_assert_uint_gt(view.count, 0);
    std::vector<char> held(2 * tets());
    double count = 0;
    for (std::uint64_t i = 0; i < view.count; ++i) {
        const vox_contact& contact = view.data[i];
        char& mark = held[contact.tet + (contact.body_b == view.data->body_b ? 0 : tets())];
        count += mark == 0;
        mark = 1;
    }
    // Positions may be rounded once more on their way through the simulation: a tet or so may differ.
    ck_assert_double_eq_tol(count / double(held.size()), experiment.shares()[0], 2.5 / double(held.size()));
    vox_grid_destroy(grid);
}
END_TEST

// Whatever the grid that the simulation detects with, its engine and its cell size, the bodies move in the
// same way; and whatever is measured finds the same contacts in every frame.
START_TEST(the_cell_size_changes_nothing) {
    const double cell_sizes[] = {0, 0.07, 0.2, 1.7};
    std::uint64_t hash = 0;
    for (int i = 0; i < 8; ++i) {
        ExperimentSettings settings;
        vox_grid_desc inside = vox_default_grid_desc();
        use_engine(&inside, i % 2 ? ENGINE_REFERENCE : ENGINE_FAST);
        inside.cell_size = cell_sizes[i / 2];
        settings.sim.grid = &inside;
        use_engine(&settings.grid, i % 2 ? ENGINE_FAST : ENGINE_REFERENCE);
        if (i % 4 == 2) settings.grid.reference = reference_with(VOX_REFERENCE_DENSE);
        if (i % 4 == 0) settings.grid.reference = reference_with(VOX_REFERENCE_PAPER_HASH);
        Experiment experiment(settings, ball, ball);
        if (i == 0) hash = experiment.hash();
        ck_assert_uint_eq(experiment.hash(), hash);
        for (int k = 1; k < 4; ++k)
            ck_assert_uint_eq(experiment.measure(cell_sizes[k]).contacts, experiment.contacts());
    }
}
END_TEST

START_TEST(samples) {
    ExperimentSettings settings;
    settings.frames = 4;
    use_engine(&settings.grid, ENGINE_REFERENCE);
    Experiment experiment(settings, ball, ball);
    const SweepSample small = experiment.measure(0.1), large = experiment.measure(0.5),
                      again = experiment.measure(0.1);
    ck_assert(small.cell_size == 0.1);
    ck_assert_uint_eq(small.frame_ns.size(), 4);
    for (const std::uint64_t ns : small.frame_ns) ck_assert_uint_gt(ns, 0);
    ck_assert_uint_eq(small.visited_cells, again.visited_cells);
    ck_assert_uint_eq(small.visited_entries, again.visited_entries);
    ck_assert_uint_gt(small.visited_cells, 4 * large.visited_cells);
    ck_assert_uint_lt(small.visited_entries, large.visited_entries);
    ck_assert_uint_eq(small.candidates, large.candidates);
    // Every tet visits a cell at least, in each frame.
    ck_assert_uint_ge(large.visited_cells, 4 * 2 * tets());

    const vox_geometry geometry = experiment.geometry();
    ck_assert_uint_eq(geometry.tets, 2 * tets());
    ck_assert_double_eq_tol(experiment.suggest(vox_default_cell_size_desc()).cell_size / geometry.mean_edge,
                            1.46, 0.05);
}
END_TEST

// All of the experiment. Times are the machine's; what holds on any machine is checked.
START_TEST(from_bodies_to_epsilon) {
    constexpr std::size_t count = 8, rounds = 2;
    ExperimentSettings settings;
    settings.frames = 3;
    Experiment experiment(settings, ball, ball);
    const double suggested = experiment.suggest(vox_default_cell_size_desc()).cell_size;
    std::vector<double> sizes, times;
    for (std::size_t i = 0; i < count; ++i) sizes.push_back(suggested * std::pow(2, (double(i) - 3.5) / 2));
    std::vector<std::vector<std::uint64_t>> ns[count];
    for (std::uint64_t round = 0; round < rounds; ++round)
        for (const std::size_t i : tool::order_of_round(count, 1, round))
            ns[i].push_back(experiment.measure(sizes[i]).frame_ns);
    for (const auto& of_size : ns) times.push_back(tool::time_of_rounds(of_size));
    const tool::TimeFit fit = tool::fit_times(sizes, times);
    const auto [min, max] = tool::fit_zone(fit, 1.05 * fit.time);
    ck_assert(sizes[0] <= min && min <= fit.cell_size && fit.cell_size <= max && max <= sizes[count - 1]);
    ck_assert(zone_distance(4 / fit.cell_size, 4 / max, 4 / fit.cell_size, 4 / min) == 0);
    ck_assert_double_ge(zone_distance(4 / suggested, 4 / max, 4 / fit.cell_size, 4 / min), 0);
}
END_TEST

START_TEST(bad_bodies) {
    ExperimentSettings settings;
    settings.contact_share = 0.9; // which no position of two balls has
    refused([&] { Experiment(settings, ball, ball); }, "expected 0.9");
    settings.contact_share = 0.01;
    tool::ExperimentBody other = ball;
    other.positions[31] = NAN;
    refused([&] { Experiment(settings, ball, other); }, "nan");
    other = ball;
    other.tets[17 * 4] = 900000;
    refused([&] { Experiment(settings, ball, other); }, "tet 17 names vertex 900000");
}
END_TEST

START_TEST(orders) {
    constexpr std::size_t count = 100, rounds = 200;
    const std::vector<std::size_t> first = tool::order_of_round(count, 1, 0);
    ck_assert(first == tool::order_of_round(count, 1, 0));
    ck_assert(first != tool::order_of_round(count, 2, 0));
    double mean[count] = {}; // place of each number
    for (std::uint64_t round = 0; round < rounds; ++round) {
        const std::vector<std::size_t> order = tool::order_of_round(count, 1, round);
        int seen[count] = {};
        ck_assert_uint_eq(order.size(), count);
        if (round > 0) ck_assert(first != order);
        for (std::size_t i = 0; i < count; ++i) {
            ck_assert_uint_lt(order[i], count);
            ck_assert_int_eq(seen[order[i]]++, 0);
            mean[order[i]] += double(i) / rounds;
        }
    }
    // Each number is everywhere equally often: the standard deviation of a mean is 28.9 / sqrt(200) = 2.
    for (const double place : mean) ck_assert_double_eq_tol(place, 49.5, 10);
    ck_assert(tool::order_of_round(1, 5, 5) == std::vector<std::size_t>{0});
    // The same on every machine.
    ck_assert((tool::order_of_round(6, 1, 2) == std::vector<std::size_t>{1, 2, 5, 3, 4, 0}));
}
END_TEST

// A disturbance in one frame of one round does not show; one in most rounds does.
START_TEST(time_of_rounds) {
    std::vector<std::vector<std::uint64_t>> ns = {{10, 900, 30, 61}, {11, 20, 800, 42}, {700, 21, 31, 63}};
    ck_assert_double_eq_tol(tool::time_of_rounds(ns), (11 + 21 + 31 + 61) / 4.0, 1e-12);
    ns.pop_back();
    ck_assert_double_eq_tol(tool::time_of_rounds(ns), (10.5 + 460 + 415 + 51.5) / 4.0, 1e-12);
    ns.pop_back();
    ck_assert_double_eq_tol(tool::time_of_rounds(ns), (10 + 900 + 30 + 61) / 4.0, 1e-12);
}
END_TEST

SUITE(experiment) {
    TCase* tests = add_case(suite, "experiment");
    tcase_add_checked_fixture(tests, setup, nullptr);
    tcase_add_loop_test(tests, one_percent_in_contact, 0, 2);
    tcase_add_each(tests, first_frame_by_hand, the_cell_size_changes_nothing, samples, from_bodies_to_epsilon,
                   bad_bodies, orders, time_of_rounds);
}
