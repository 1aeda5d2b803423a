// The output of the commands as JSON.
#pragma once

#include "body.hpp"
#include "grid.hpp"
#include "json.hpp"

#include <vox/vox_cell_size.h>

#include <string>
#include <vector>

namespace tool {

Json bounds(const double (&min)[3], const double (&max)[3]);
Json geometry(const vox_geometry& geometry);
Json curve(const vox_cell_size_result& result);

// Whether anything collides. If not, every cell size is as good as any other.
bool collides(const vox_cell_size_result& result);

// Adds the fields of the result; a number that does not exist is null.
void add_suggestion(Json& json, const vox_cell_size_result& result);
// Adds also the other keys of `vox suggest` for meshes.
void add_suggestion(Json& json, const vox_cell_size_result& result, vox_cost_model model,
                    const vox_geometry& measured);

// Prints the curve, the rules, the terms of the cost, and the note. With a mean edge, the cell sizes of rules
// are also given in mean edges.
void print_reasons(const vox_cell_size_result& result, double mean_edge = 0);

// Adds the keys of `vox collide` except the cell size, for a grid whose constraints were found. In contacts
// and constraints, a mesh is its index in `ids`.
void add_collision(Json& json, const vox_grid* grid, const std::vector<vox_body>& ids, const Counters& times);

// Returns "paper", "reference", "fast" or "surface".
const char* model_name(vox_cost_model model);

// Returns "inside", "edge", "proximity" or "impact".
const char* kind_name(vox_constraint_kind kind);

// Returns "surface", "propagated", "closest", "ambiguous", "touching", "unknown" or "plane".
const char* state_name(vox_depth_state state);

// Adds the results of a step other than contacts: hash, profile, counters.
void add_result(Json& json, const vox_grid* grid, const Counters& times);

// Adds what a file holds, what was left out of it, and its warnings.
void add_report(Json& json, const vox_io_report& report, const std::vector<std::string>& warnings);
Json report_json(const vox_io_report& report, const std::vector<std::string>& warnings);

// A list of {file, vertices, tets, report}, one a body, in the order of the indices in contacts.
Json body_list(const std::vector<Body>& bodies);

// The index of `mesh` in `ids`, which must contain it.
std::size_t place_of(const std::vector<vox_body>& ids, vox_body mesh);

std::string hexadecimal(std::uint64_t value); // sixteen digits

// The text escaped for XML, with bytes that are not UTF-8 replaced.
std::string xml_text(const std::string& text);

// Says how many more there are than --limit lets commands print.
void print_rest(std::uint64_t count);

// Prints one line on standard output.
void print(const Json& json);

// Throws Failure if not everything could be written to standard output.
void finish_output();

} // namespace tool
