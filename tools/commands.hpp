// The commands of vox. Each function adds one to the command line, whose parser runs the one that is named
// there.
#pragma once

#include <CLI/CLI.hpp>

namespace tool {

void add_info(CLI::App& app);
void add_suggest(CLI::App& app);
void add_collide(CLI::App& app);
void add_demo(CLI::App& app);
void add_replay(CLI::App& app);
void add_tetrahedralize(CLI::App& app);
void add_sweep(CLI::App& app);

} // namespace tool
