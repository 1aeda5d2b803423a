// vox suggest for other grids than vox's: any primitives, and a program of the user that is run at cell
// sizes.
#pragma once

#include "body.hpp"
#include "command_line.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tool {

struct ForeignOptions {
    std::optional<vox_known_grid> known;
    bool points = false, triangles = false;
    std::vector<std::string> querying; // files with the queries; none: the stored primitives query each other
    double radius = 0, first = 0;
    std::string tune; // command to run; empty: none
    std::uint32_t max_runs = 7;

    bool any() const {
        return known.has_value() || points || triangles || !querying.empty() || radius > 0 || !tune.empty();
    }
};

void add_foreign(Command& command, ForeignOptions& options);

// Prints the suggestion for these bodies' primitives, or the result of tuning, for which there may be no
// bodies.
void suggest_foreign(const ForeignOptions& options, const std::vector<Body>& bodies, double zone_loss,
                     const std::string& svg, bool json);

} // namespace tool
