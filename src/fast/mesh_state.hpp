// The fast engine's state of a mesh, kept from step to step.
#pragma once

#include "fast/last_positions.hpp"
#include "fast/winding/orientation.hpp"
#include "mesh/tiled_mesh.hpp"

#include <cstdint>
#include <memory_resource>

namespace vox::fast {

struct MeshState {
    explicit MeshState(std::pmr::memory_resource* memory) noexcept
        : last_positions(memory), orientation(memory) {}

    LastPositions last_positions;
    OrientationCache orientation; // of bodies that winding numbers may be of use for

    // Brings the state up to date with the tiles of a mesh, before a step. `version` is that of the tiles:
    // where they were made anew, so is the state, else it takes in the edits since the last call. Throws what
    // the memory throws; the next call completes what is missing then.
    void update(const TiledMesh& mesh, std::uint32_t version, std::uint32_t vertex_count);

    // The next step takes the mesh for one that moved.
    void invalidate_positions() noexcept {
        for (LastPositions::Part& part : last_positions.parts) part.copied = false;
    }

private:
    void make_room(const Tiles& tiles, std::uint32_t vertex_count);

    std::uint32_t version_ = 0; // of the tiles at the last update; 0 before the first
    std::uint64_t changes_ = 0; // TilePlaces::changes then
};

// A body as a step gets it: the tiles and the boundary of its mesh are only read.
struct PreparedBody {
    const Tiles* tiles;
    const Boundary* boundary;
    MeshState* state;
};

} // namespace vox::fast
