// Scenes whose tetrahedra are of unlike sizes: what a rule for the cell size has trouble with.
#pragma once

#include "scenes.hpp"

#include <vector>

namespace bench {

// Graded bodies, pairs of a coarse and a fine body.
std::vector<SceneMaker> unlike_scenes();

} // namespace bench
