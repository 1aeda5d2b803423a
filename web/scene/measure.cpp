// The cell size: what models predict and what steps take.
#include "playground.hpp"

#include <algorithm>

using namespace play;

namespace {

// A grid over the bodies of the simulation, without depth.
vox_grid* grid_with(playground& play, std::uint32_t engine) {
    Grid& grid = play.measured[engine];
    if (grid) return grid.get();
    const vox_reference_desc reference = vox_default_reference_desc();
    vox_grid_desc desc = vox_default_grid_desc();
    if (engine == VOX_COST_MODEL_REFERENCE) desc.reference = &reference;
    vox_grid* made = nullptr;
    check(vox_grid_create(&desc, &made));
    Grid owned(made);
    for (const Body& body : play.bodies) {
        vox_mesh_desc mesh = vox_mesh_desc_floats(body.view.grid_positions, body.view.vertex_count,
                                                  body.tets.data(), body.view.tet_count);
        mesh.filter.flags =
            play.self_collision && body.kind != PLAY_FIXED ? std::uint32_t{VOX_FILTER_SELF_COLLISION} : 0u;
        vox_body id;
        check(vox_mesh_insert(made, &mesh, &id));
    }
    grid = std::move(owned);
    return made;
}

std::uint64_t stepped(playground& play, vox_grid* grid, double cell_size, std::uint32_t steps, double& ns) {
    check(vox_grid_set_cell_size(grid, cell_size));
    std::vector<vox_body> meshes(play.bodies.size());
    std::uint64_t count = 0;
    check(vox_grid_get_bodies(grid, meshes.data(), meshes.size(), &count));
    ns = 0;
    for (std::uint32_t i = 0; i < steps; ++i) {
        for (const vox_body mesh : meshes) check(vox_body_mark_moved(grid, mesh)); // or nothing is left to do
        check(vox_grid_step(grid));
        vox_grid_info info{};
        info.struct_size = sizeof info;
        check(vox_grid_get_info(grid, &info));
        ns += static_cast<double>(info.step_ns);
    }
    std::uint64_t hash = 0;
    check(vox_grid_get_hash(grid, &hash));
    return hash;
}

} // namespace

void play::check_engine(std::uint32_t engine) {
    if (engine != VOX_COST_MODEL_REFERENCE && engine != VOX_COST_MODEL_FAST)
        fail(VOX_ERROR_INVALID_ARGUMENT, "there is no engine " + std::to_string(engine));
}

vox_result play_measure(playground* play, uint32_t engine, double cell_size, uint32_t steps, double* out_ns,
                        uint32_t* out_same) {
    return guard([&] {
        check_engine(engine);
        if (play->default_hash_of != play->version) {
            double unused;
            play->default_hash = stepped(*play, grid_with(*play, VOX_COST_MODEL_FAST), 0, 1, unused);
            play->default_hash_of = play->version;
        }
        *out_same = stepped(*play, grid_with(*play, engine), cell_size, std::max(steps, 1u), *out_ns) ==
                    play->default_hash;
    });
}

const double* play_suggest_numbers(playground* play, uint32_t model) {
    vox_cell_size_result& s = play->suggestion;
    const vox_result result = guard([&] {
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        desc.model = static_cast<vox_cost_model>(model);
        desc.weights = &play->weights;
        check_engine(model);
        vox_grid* grid = grid_with(*play, model);
        s.struct_size = sizeof s;
        check(vox_grid_suggest_cell_size(grid, &desc, &s));
    });
    if (result != VOX_OK) return nullptr;
    double* next = play->suggestion_numbers;
    for (const double value : {s.cell_size, s.zone_min, s.zone_max, s.cost}) *next++ = value;
    for (const std::uint32_t count : {s.curve_count, s.term_count, s.rule_count}) *next++ = count;
    for (std::uint32_t i = 0; i < s.curve_count; ++i)
        *next++ = s.curve[i].cell_size, *next++ = s.curve[i].cost;
    for (std::uint32_t i = 0; i < s.term_count; ++i) *next++ = s.terms[i].count, *next++ = s.terms[i].cost;
    for (std::uint32_t i = 0; i < s.rule_count; ++i)
        *next++ = s.rules[i].cell_size, *next++ = s.rules[i].cost;
    return play->suggestion_numbers;
}

const char* play_term(const playground* play, uint32_t index) { return play->suggestion.terms[index].name; }

const char* play_rule(const playground* play, uint32_t index) { return play->suggestion.rules[index].name; }
