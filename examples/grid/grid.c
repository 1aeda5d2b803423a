/* Grid: engines and cell sizes change how contacts are found, never which. */
#include "example.h"

#include <vox/vox_cell_size.h>

int main(void) {
    static const char* const names[] = {"reference", "fast"};
    static const double cell_sizes[] = {0, 0.1, 10};
    const cube first = cube_at(0, 0, 0), second = cube_at(0.9f, 0.2f, 0.1f);
    for (int engine = 0; engine < 2; ++engine) {
        const vox_reference_desc reference = vox_default_reference_desc();
        vox_grid_desc desc = vox_default_grid_desc();
        if (engine == 0) desc.reference = &reference; /* the paper's engine */
        vox_grid* grid = NULL;
        must(vox_grid_create(&desc, &grid));
        must(vox_grid_reserve(grid, 2, 100)); /* so that nothing need be allocated for them later */
        insert_cube(grid, &first);
        insert_cube(grid, &second);
        for (int i = 0; i < 3; ++i) {
            vox_grid_info info = {.struct_size = sizeof info};
            uint64_t hash = 0;
            must(vox_grid_set_cell_size(grid, cell_sizes[i])); /* 0: the library chooses */
            must(vox_grid_step(grid));
            must(vox_grid_get_info(grid, &info));
            must(vox_grid_get_hash(grid, &hash));
            printf("%-9s cell size %-5.2g %" PRIu64 " contacts, hash %016" PRIx64 "\n", names[engine],
                   info.cell_size, contact_count(grid), hash);
        }
        must(vox_grid_clear(grid));
        vox_grid_destroy(grid);
    }
    return 0;
}
