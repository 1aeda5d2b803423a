// A whole grid as bytes and back: docs/snapshot.md. Each part is one chunk, with a function that writes it
// and one that reads it.
#pragma once

#include "base/array.hpp"
#include "base/error.hpp"
#include "grid/grid.hpp"
#include "grid/snapshot_chunks.hpp"

#include <cinttypes>
#include <cstddef>
#include <cstdint>

namespace vox {

// What loading knows beside the grid.
struct Loading {
    vox_grid& grid;
    Array<vox_body> awaited; // meshes whose chunk has to come, ascending
    std::size_t next = 0;    // index in `awaited`
    Array<std::uint32_t> free_slots;
    vox_body last_filtered = VOX_NULL_BODY, last_cut = VOX_NULL_BODY, last_shape = VOX_NULL_BODY;
};

// Calls what a program would call; an argument that it refuses makes the snapshot invalid.
template <class Function>
void or_refuse(const SnapshotChunk& in, vox_body id, Function&& function) {
    try {
        function();
    } catch (const Error& error) {
        const vox_result result = error.result();
        if (result == VOX_ERROR_LIMIT || result == VOX_ERROR_BUDGET) throw;
        in.refuse(format("body %" PRIu32 ": %s", id, error.what()));
    }
}

class Snapshot {
public:
    // Throws Error(INVALID_STATE) for a grid that cannot be saved.
    static void check(const vox_grid& grid);
    // Reads the grid's arrays and positions, allocates nothing. Returns the number of bytes written; null:
    // only counts them.
    static std::uint64_t save(const vox_grid& grid, std::byte* bytes) noexcept;
    // The settings in a snapshot, over a caller's for the machine it runs on (vox_grid_load), checked as a
    // grid needs them. Throws Error(FORMAT, UNSUPPORTED).
    static vox_grid_desc settings(SnapshotReader in, const vox_grid_desc& machine,
                                  vox_reference_desc& reference);
    // Fills a grid made from these settings. Throws Error(FORMAT, UNSUPPORTED, LIMIT, BUDGET) or what the
    // memory throws; the grid is then only fit to be destroyed.
    static void load(SnapshotReader in, vox_grid& grid);

private:
    static void save_settings(const vox_grid& grid, SnapshotWriter& out);
    static vox_grid_desc read_settings(SnapshotChunk& in, vox_grid_desc desc, vox_reference_desc& reference,
                                       vox_grid* grid);
    static void load_settings(SnapshotChunk& in, Loading& to);
    static void save_slots(const vox_grid& grid, SnapshotWriter& out);
    static void load_slots(SnapshotChunk& in, Loading& to);
    static void save_meshes(const vox_grid& grid, SnapshotWriter& out);
    static void load_mesh(SnapshotChunk& in, Loading& to);
    static void save_shapes(const vox_grid& grid, SnapshotWriter& out);
    static void load_shape(SnapshotChunk& in, Loading& to);
    static void save_cuts(const vox_grid& grid, SnapshotWriter& out);
    static void load_cuts(SnapshotChunk& in, Loading& to);
    static void save_filters(const vox_grid& grid, SnapshotWriter& out);
    static void load_filter(SnapshotChunk& in, Loading& to);
    static void save_exceptions(const vox_grid& grid, SnapshotWriter& out);
    static void load_exceptions(SnapshotChunk& in, Loading& to);
    static void save_pairs(const vox_grid& grid, SnapshotWriter& out);
    static void load_pairs(SnapshotChunk& in, Loading& to);

    template <class Function>
    static void for_each_mesh(const vox_grid& grid, Function&& function) {
        grid.meshes_.for_each([&](vox_body id, const MeshSlot& slot) { function(id, slot.mesh); });
    }
    static vox_body mesh_that_was(SnapshotChunk& in, const vox_grid& grid);
    static Mesh& next_mesh(SnapshotChunk& in, vox_grid& grid, vox_body& last);

    // In the order in which they follow each other in a file.
    struct Part {
        const char* name;
        bool repeats;  // may come any number of times, else once
        bool required; // where it may come once
        void (*save)(const vox_grid& grid, SnapshotWriter& out);
        void (*load)(SnapshotChunk& in, Loading& to);
    };
    static constexpr Part parts[] = {{"GRID", false, true, save_settings, load_settings},
                                     {"SLOT", false, true, save_slots, load_slots},
                                     {"MESH", true, false, save_meshes, load_mesh},
                                     {"SHAP", true, false, save_shapes, load_shape},
                                     {"CUTS", true, false, save_cuts, load_cuts},
                                     {"FILT", true, false, save_filters, load_filter},
                                     {"PAIR", false, true, save_exceptions, load_exceptions},
                                     {"EVNT", false, true, save_pairs, load_pairs}};
};

} // namespace vox
