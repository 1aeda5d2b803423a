// Surfaces that only assimp reads. A damaged file can crash assimp, keep it busy forever or fill its memory,
// so the tool reads them in a separate process with limits.
#pragma once

#include "body.hpp"

namespace tool {

// Fills `report`, too. Throws Failure with `refused`, which says why the library did not read the file. For a
// format that the library does not know, what assimp or the end of its process says follows.
Mesh load_by_assimp(const std::string& path, const std::string& refused, vox_io_report& report);

} // namespace tool
