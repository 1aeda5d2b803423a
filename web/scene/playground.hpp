// The parts of a playground that more than one file needs.
#pragma once

#include "playground.h"
#include "tet_mesh.hpp"

#include <vox/vox_sim.h>

#include <memory>
#include <string>
#include <vector>

namespace play {

struct Failure {
    vox_result result;
};

// Inside the functions that guard() runs; vox_last_error() has the text already.
inline void check(vox_result result) {
    if (result != VOX_OK) throw Failure{result};
}
[[noreturn]] void fail(vox_result result, const std::string& text);

template <class Work>
vox_result guard(const Work& work) noexcept {
    try {
        work();
        return VOX_OK;
    } catch (const Failure& failure) {
        return failure.result;
    } catch (...) { // what the C++ library throws: memory
        return vox_fail(VOX_ERROR_OUT_OF_MEMORY, "there is not enough memory");
    }
}

struct DestroyGrid {
    void operator()(vox_grid* grid) const { vox_grid_destroy(grid); }
};
using Grid = std::unique_ptr<vox_grid, DestroyGrid>;

struct DestroySim {
    void operator()(vox_sim* sim) const { vox_sim_destroy(sim); }
};
using Sim = std::unique_ptr<vox_sim, DestroySim>;

struct Body {
    vox_body mesh;
    std::uint32_t kind, serial, origin;
    std::vector<double> rest;
    std::vector<std::uint32_t> tets, triangles; // cut faces come last
    std::size_t uncut;                          // indices of `triangles` before them
    vox_sim_body_view view;
};

// Memory of the simulation and its grid, counted.
struct Account {
    std::uint64_t bytes = 0, limit = 0;
};

// What insert() is given.
struct Shape {
    std::span<const double> positions, rest, velocities; // the last two may be empty
    std::span<const std::uint32_t> tets;
    std::uint32_t kind, origin = 0; // 0: it has none
};

// Parts of one cut that still touch, so that they are no pair.
struct Parts {
    vox_body a, b;
};

struct Held {
    std::uint32_t vertex;
    Vec offset; // from the point that is held
};

struct Tool {
    std::uint32_t kind = PLAY_NO_TOOL;
    vox_body shape = VOX_NULL_BODY;
    Vec at{}, target{};
    std::array<double, 2> along{1, 0};
};

} // namespace play

struct playground {
    play::Account account;
    play::Sim sim;
    vox_grid* grid = nullptr; // the simulation's
    std::vector<play::Body> bodies;
    std::uint32_t next_serial = 1, dropped = 0;
    std::uint32_t engine = VOX_COST_MODEL_FAST;
    bool self_collision = false;
    double stiffness = 2e5, cell_size = 0;
    std::vector<play::Parts> touching_parts;
    std::uint64_t hash = 0, steps = 0;
    std::uint32_t still_steps = 0;
    vox_body held_mesh = VOX_NULL_BODY;
    std::vector<play::Held> held;
    play::Vec held_target{};
    play::Tool tool;
    std::vector<double> velocities; // scratch
    std::string text;

    // Grids that measure; remade when the bodies are others.
    play::Grid measured[3]; // by the vox_cost_model that predicts the engine
    std::uint64_t default_hash = 0, default_hash_of = ~std::uint64_t{0};
    std::uint64_t version = 0; // of the bodies and their positions

    vox_cost_weights weights{};
    vox_cell_size_result suggestion;
    double suggestion_numbers[7 + 2 * (VOX_CURVE_CAPACITY + VOX_TERM_CAPACITY + VOX_RULE_CAPACITY)];
    std::vector<float> arrows, boxes, touched;
    std::vector<unsigned char> snapshot;
    mutable play_body shown;
    play_facts facts{};

    void was_touched() { still_steps = 0, ++version; }
    void bodies_changed() {
        was_touched();
        for (play::Grid& grid_of_engine : measured) grid_of_engine.reset();
    }
    bool asleep() const { return still_steps >= 60; }
};

namespace play {

// The body is in the simulation when this returns, and not yet in the list.
Body insert(playground& play, const Shape& shape);
void remove(playground& play, const Body& body);
// Makes parts of a cut a pair again once they are apart.
void part(playground& play);
void check_engine(std::uint32_t engine);
// Of the last detection; none before the first.
std::span<const vox_constraint> constraints_of(const playground& play);
// Holds a tool in place of the one before.
void take_tool(playground& play, const Tool& tool);
// Moves it towards its target.
void move_tool(playground& play);

} // namespace play
