// What a unit of each piece of work costs, in nanoseconds: the weights of the cost models.
#pragma once

#include <vox/vox_cell_size.h>

namespace vox {

struct CostWeights {
    // Of the reference engine.
    double classify_vertex, prepare_tet; // its box
    double visit_cell;                   // whose list is as long as the one before
    double scan_cell; // an occupied one, gone through instead of a box that meets more cells
    double read_vertex, test_box;
    double test_tet; // or its own corner, which is in the box as well
    double clear_bucket;
    double changed_list; // in a visited cell, of another length than the one before
    double fetch_vertex; // passed over, and not read just before
    // Of the fast engine.
    double bin_vertex, clear_cell;
    double visit_tile; // for one window
    double visit_row, found_vertex;
    double test_vertex; // one in a tile's box, against its tets
};

// Those that hold until others are given. With gcc 12, fitted to steps at many cell sizes: of the reference
// engine on a Zen 5 at 2.6 GHz, of the fast engine on a Xeon at 2.5 GHz. visit_row was fitted later, on the
// Zen 5.
inline constexpr CostWeights shipped_weights{.classify_vertex = 30,
                                             .prepare_tet = 15,
                                             .visit_cell = 2.6,
                                             .scan_cell = 1.3,
                                             .read_vertex = 1.2,
                                             .test_box = 0.6,
                                             .test_tet = 24,
                                             .clear_bucket = 0.2,
                                             .changed_list = 6.7 * 2.6, // visits of an empty cell
                                             .fetch_vertex = 1.8 * 1.2, // reads
                                             .bin_vertex = 5,
                                             .clear_cell = 0.7,
                                             .visit_tile = 170,
                                             .visit_row = 4,
                                             .found_vertex = 0.35,
                                             .test_vertex = 3};

// Weights as a program gives them; null: those shipped. Throws INVALID_ARGUMENT naming the number that is not
// finite or below 0.
CostWeights read_weights(const vox_cost_weights* given);

// The other way round.
vox_cost_weights as_given(const CostWeights& weights);

// Measured on the machine at hand (calibrate.cpp): steps both engines over a small scene at a few cell sizes
// and fits the weights to their times and counters. Takes about ten milliseconds; throws std::bad_alloc.
CostWeights measured_weights();

} // namespace vox
