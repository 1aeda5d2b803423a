// The manual page and shell completions, made from the usage of the command line.
#pragma once

#include "command_line.hpp"

#include <string>

namespace tool {

// The manual page in troff, with the macros of man(7).
std::string manual_page(const Usage& usage, const std::string& version);

std::string bash_completion(const Usage& usage);
std::string zsh_completion(const Usage& usage);
std::string fish_completion(const Usage& usage);

} // namespace tool
