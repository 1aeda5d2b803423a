// Scenes whose contacts are quickly found, and where it is hard to say how deep they are.
#pragma once

#include "scenes.hpp"

#include <vector>

namespace bench {

std::vector<SceneMaker> hard_scene_makers();

} // namespace bench
