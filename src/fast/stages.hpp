// The stages of a step of the fast engine, by the name each has everywhere: its file or folder, its time in
// Profile (with _ns), its row in bench/stages, and its line in src/README.md.
#pragma once

namespace vox::fast {

// In the order in which they begin. Part of `winding` runs within the tasks of `windows`, and all of `decide`
// within those of `lookup`.
inline constexpr const char* stage_names[] = {"stream",  "winding", "broad_phase",
                                              "windows", "lookup",  "decide"};

} // namespace vox::fast
