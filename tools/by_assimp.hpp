// Surfaces that only assimp reads. A damaged file can end a process within assimp, keep it busy without end
// or fill its memory, so the tool lets a process of its own read them, with limits.
#pragma once

#include "body.hpp"

namespace tool {

// Fills `report` as well, unless it is null; its struct_size must be set. Throws Failure with what the reader
// or the end of its process says, behind `refused`, which says why the library did not read the file.
Mesh load_by_assimp(const std::string& path, const std::string& refused, vox_io_report* report);

} // namespace tool
