// Rigid shapes that options describe: floors, balls, boxes, capsules.
#pragma once

#include "command_line.hpp"
#include "json.hpp"

#include <vox/vox.h>

#include <array>
#include <string>
#include <vector>

namespace tool {

struct Rigid {
    const char* kind;            // "floor", "sphere", "box" or "capsule"
    std::vector<double> numbers; // as they were given
    vox_shape_desc desc;
    std::array<double, 12> place; // its transform
};

// Options that may be given several times: numbers with commas between them.
struct RigidOptions {
    std::vector<std::string> floors, spheres, boxes, capsules;

    // Floors first, then spheres, boxes, capsules. Throws WrongUsage.
    std::vector<Rigid> shapes() const;
};

void add_rigid(Command& command, RigidOptions& options);

// Inserts the shapes, and appends their ids.
void insert_rigid(vox_grid* grid, const std::vector<Rigid>& shapes, std::vector<vox_body>& ids);

// "sphere 0,0,0,1"
std::string name_of(const Rigid& shape);
// A list of {kind, numbers}.
Json rigid_list(const std::vector<Rigid>& shapes);

} // namespace tool
