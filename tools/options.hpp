// Options shared by commands.
#pragma once

#include "body.hpp"
#include "command_line.hpp"

#include <vox/vox.h>

namespace tool {

inline constexpr Choice<vox_engine> engines[] = {
    {"auto", VOX_ENGINE_AUTO},
    {"fast", VOX_ENGINE_FAST},
    {"reference", VOX_ENGINE_REFERENCE},
};
inline constexpr Choice<vox_storage> storages[] = {
    {"auto", VOX_STORAGE_AUTO}, {"hashed", VOX_STORAGE_HASHED}, {"dense", VOX_STORAGE_DENSE}};
inline constexpr Choice<vox_hash> hashes[] = {{"mixed", VOX_HASH_MIXED}, {"paper", VOX_HASH_PAPER}};

inline void add_threads(Command& command, vox_grid_desc& grid) {
    command.option("--threads", grid.worker_count, "Threads of a step; 0: one per core")
        .range(0, VOX_MAX_WORKERS);
}

// How the reference engine stores cells.
inline void add_cells(Command& command, vox_grid_desc& grid) {
    command.choice("--storage", grid.storage, storages, "How cells are stored");
    command.choice("--hash", grid.hash, hashes, "Hash of a cell, for hashed storage");
}

// Adds the options of commands that need tetrahedra but may get surfaces.
inline void add_fill(Command& command, Fill& fill) {
    const Option flag = command.flag("--fill", fill.surfaces, "Fill surfaces with tetrahedra first");
    command
        .option("--fill-cell", fill.cell,
                "Edge of a lattice cell for --fill; 0: a fiftieth of the longest side")
        .not_negative()
        .needs(flag);
}

} // namespace tool
