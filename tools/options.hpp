// Options shared by commands.
#pragma once

#include "body.hpp"
#include "command_line.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>

namespace tool {

enum class Engine { automatic, fast, reference };
enum class Cells { automatic, hashed, dense };
enum class CellHash { mixed, paper };

inline constexpr Choice<Engine> engines[] = {
    {"auto", Engine::automatic}, {"fast", Engine::fast}, {"reference", Engine::reference}};
inline constexpr Choice<Cells> storages[] = {
    {"auto", Cells::automatic}, {"hashed", Cells::hashed}, {"dense", Cells::dense}};
inline constexpr Choice<CellHash> hashes[] = {{"mixed", CellHash::mixed}, {"paper", CellHash::paper}};

// Settings of a grid from options.
struct GridOptions {
    vox_grid_desc desc = vox_default_grid_desc();
    std::uint32_t threads = 1;
    Engine engine = Engine::automatic;
    Cells cells = Cells::automatic;
    CellHash hash = CellHash::mixed;

    // The storage option implies the reference engine.
    bool is_reference() const {
        return engine == Engine::reference || (engine == Engine::automatic && cells != Cells::automatic);
    }
    // The result points into this object.
    vox_grid_desc grid_desc() {
        vox_grid_desc made = desc;
        made.worker_count = threads == 0 ? VOX_ALL_CORES : threads;
        if (cells == Cells::dense) reference.flags |= VOX_REFERENCE_DENSE;
        if (hash == CellHash::paper) reference.flags |= VOX_REFERENCE_PAPER_HASH;
        if (is_reference()) made.reference = &reference;
        return made;
    }

private:
    vox_reference_desc reference = vox_default_reference_desc();
};

inline void add_threads(Command& command, GridOptions& grid) {
    command.option("--threads", grid.threads, "Threads of a step; 0: one per core").range(0, VOX_MAX_WORKERS);
}

// How the reference engine stores cells.
inline void add_cells(Command& command, GridOptions& grid) {
    command.choice("--storage", grid.cells, storages, "How cells are stored");
    command.choice("--hash", grid.hash, hashes, "Hash of a cell, for hashed storage");
}

inline void add_what_is_read(Command& command, Reading& reading) {
    command.flag("--keep-unused", reading.keep_unused,
                 "Keep vertices that belong to no tetrahedron; they collide like others");
    command.flag("--split-cells", reading.split_cells,
                 "Split hexahedra, wedges and pyramids into tetrahedra; otherwise they are left out");
}

// Adds the options of commands that need tetrahedra but may get surfaces.
inline void add_reading(Command& command, Reading& reading) {
    add_what_is_read(command, reading);
    const Option flag = command.flag("--fill", reading.fill_surfaces, "Fill surfaces with tetrahedra first");
    command
        .option("--fill-cell", reading.cell,
                "Edge of a lattice cell for --fill; 0: a fiftieth of the longest side")
        .not_negative()
        .needs(flag);
}

} // namespace tool
