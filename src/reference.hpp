// The paper's algorithm as printed (Sect. 3): every particle is classified into a uniform grid, then every
// tetrahedron tests the particles of the cells that its box covers. Baseline, oracle, and the subject of the
// paper's cost function.
#pragma once

#include "scene.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

struct ReferenceSettings {
    double cell_size = 0; // > 0, finite
    vox_storage storage = VOX_STORAGE_HASHED;
    vox_hash hash = VOX_HASH_MIXED;
    std::uint64_t hash_table_size = 0;
    Vec3d world_min{}, world_max{}; // dense storage: both zero means the box of all positions
};

// The engine's buffers live here from step to step, so that the steady state allocates nothing.
class Reference {
public:
    explicit Reference(std::pmr::memory_resource* memory);

    // Appends a Hit for every vertex in a closed tetrahedron that does not own it (all of them: canonical
    // filtering is contacts.hpp's). Throws Error(NON_FINITE) naming mesh and vertex; sets the counters from
    // `cells` to `skipped_degenerate` and the stage times from `bin_ns` to `narrow_ns`.
    void detect(std::span<const Body> bodies, const ReferenceSettings& settings, std::pmr::vector<Hit>& hits,
                vox_counters& counters, vox_profile& profile);

private:
    std::pmr::vector<Vec3f> points_;
};

} // namespace vox
