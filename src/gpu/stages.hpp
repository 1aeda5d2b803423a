// The order of the kernels of a step, for a launcher: items(n, kernel) and groups(n, kernel) call a kernel
// for each number below n, counted(count, room, least, kernel) for as many as the device says, and none if
// there is no room for them, but for `least` at least; sum(from, to, n) writes the sum of what is before
// each.
#pragma once

#include "gpu/kernels/contacts.hpp"
#include "gpu/kernels/decide.hpp"
#include "gpu/kernels/look_up.hpp"
#include "gpu/kernels/mark.hpp"
#include "gpu/kernels/risk.hpp"

namespace vox::gpu {

template <class Launcher>
void launch_step(Launcher& launcher, const SceneArrays& s) {
    const u32 vertices = s.vertex_count;
    const u32 *at_risk = s.vertex_risk + vertices, *found = &s.status->needed_findings;
    if (s.gathers) launcher.items(vertices, Gather{s});
    launcher.items(Clear{s}.count(), Clear{s});
    launcher.groups(s.tile_count, MarkTiles{s});
    launcher.items(vertices, FindRisk{s});
    launcher.sum(s.vertex_flag, s.vertex_risk, vertices + 1);
    launcher.sum(s.cell_count, s.cell_begin, s.slots() + 1);
    launcher.items(vertices, PlacePoints{s});
    launcher.groups(s.tile_count, LookUp{s});
    launcher.counted(found, s.finding_room, 0, Decide{s});
    launcher.sum(s.hits_of, s.hits_begin, vertices + 1);
    launcher.counted(found, s.finding_room, 0, PlaceHits{s});
    launcher.counted(at_risk, vertices, 0, KeepHits{s});
    launcher.sum(s.kept_of, s.kept_begin, vertices + 1);
    launcher.counted(at_risk, vertices, s.scene_count + 1, WriteContacts{s});
}

} // namespace vox::gpu
