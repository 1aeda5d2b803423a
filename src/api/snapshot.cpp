// The C border of snapshots.

#include "grid/snapshot.hpp"
#include "base/border.hpp"
#include "base/library.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"

using namespace vox;

vox_result vox_grid_save(const vox_grid* grid, void* bytes, uint64_t capacity, uint64_t* out_size) {
    return border(grid, "grid", [&] {
        require(out_size, "out_size");
        Snapshot::check(*grid);
        const std::uint64_t size = Snapshot::save(*grid, nullptr);
        if (bytes) {
            if (capacity < size)
                refuse(format("capacity is %llu, the snapshot has %llu bytes", llu(capacity), llu(size)));
            (void)Snapshot::save(*grid, static_cast<std::byte*>(bytes));
        }
        *out_size = size;
    });
}

vox_result vox_grid_load(const void* bytes, uint64_t size, const vox_grid_desc* desc, vox_grid** out_grid) {
    return border([&] {
        require(bytes, "bytes");
        require(out_grid, "out_grid");
        const vox_grid_desc machine = desc ? read_struct(desc, "desc") : vox_default_grid_desc();
        check_grid_desc(machine);
        const SnapshotReader in({static_cast<const std::byte*>(bytes), static_cast<std::size_t>(size)});
        vox_reference_desc reference;
        const vox_grid_desc settings = Snapshot::settings(in, machine, reference);
        GridHandle grid = create_grid(settings);
        Snapshot::load(in, *grid);
        *out_grid = grid.release();
    });
}
