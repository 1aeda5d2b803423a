// The commands of vox: each adds itself to the command line and runs when it is the one named there.
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
