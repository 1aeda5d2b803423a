// The commands of vox. Each function adds one to the command line.
#pragma once

#include "command_line.hpp"

namespace tool {

void add_info(CommandLine& line);
void add_check(CommandLine& line);
void add_suggest(CommandLine& line);
void add_collide(CommandLine& line);
void add_demo(CommandLine& line);
void add_replay(CommandLine& line);
void add_resolve(CommandLine& line);
void add_tetrahedralize(CommandLine& line);
void add_sweep(CommandLine& line);

} // namespace tool
