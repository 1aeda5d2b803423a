// What the commands say in JSON. A number that does not exist, or that is infinite, is null.
#pragma once

#include "body.hpp"

#include <vox/vox.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tool {

using Json = nlohmann::ordered_json;

Json number(double value);
Json number(std::optional<double> value);
Json point(const double (&coordinates)[3]);
Json bounds(const double (&min)[3], const double (&max)[3]);

// Adds the keys of `vox suggest`.
void add_suggestion(Json& json, const vox_suggestion& suggestion);

// Adds the keys of `vox collide`, of a grid that has stepped. In contacts, a mesh is its place in `ids`.
void add_collision(Json& json, const vox_grid* grid, const std::vector<vox_mesh>& ids,
                   const vox_profile& profile);

// surface, propagated, enclosed, crossing or coincident.
const char* state_name(vox_penetration_state state);

// Adds what a step gives besides its contacts: hash, cell_size, profile, counters.
void add_result(Json& json, const vox_grid* grid, const vox_profile& profile);

// {file, vertices, tets} of each body, in the order of the numbers that contacts use.
Json body_list(const std::vector<Body>& bodies);

// The place in `ids` of a mesh that is there.
std::size_t place_of(const std::vector<vox_mesh>& ids, vox_mesh mesh);

std::string hash_of(const vox_grid* grid);

// One line on standard output.
void print(const Json& json);

// Throws Failure when standard output did not take everything.
void finish_output();

} // namespace tool
