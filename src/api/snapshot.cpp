// The C border of snapshots.

#include "grid/snapshot.hpp"
#include "base/border.hpp"
#include "base/structs.hpp"

#include <memory>

using namespace vox;

namespace {

struct Destroy {
    void operator()(vox_grid* grid) const noexcept { vox_grid_destroy(grid); }
};

} // namespace

vox_result vox_grid_save(const vox_grid* grid, void* bytes, uint64_t capacity, uint64_t* out_size) {
    return border(grid, "grid", [&] {
        require(out_size, "out_size");
        const std::uint64_t size = Snapshot::save(*grid, nullptr);
        if (bytes) {
            if (capacity < size)
                throw Error(VOX_ERROR_INVALID_ARGUMENT,
                            format("capacity is %llu, the snapshot has %llu bytes",
                                   static_cast<unsigned long long>(capacity),
                                   static_cast<unsigned long long>(size)));
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
        vox_grid* created = nullptr;
        const vox_result result = vox_grid_create(&settings, &created);
        if (result != VOX_OK) throw Error(result, vox_last_error());
        std::unique_ptr<vox_grid, Destroy> grid(created);
        Snapshot::load(in, *grid);
        *out_grid = grid.release();
    });
}
