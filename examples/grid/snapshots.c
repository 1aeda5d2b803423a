/* Snapshots: a grid as bytes, for a bug report or for another day; and what becomes of a damaged one. */
#include "example.h"

int main(void) {
    vox_grid *grid = NULL, *again = NULL;
    must(vox_grid_create(NULL, &grid));
    const cube first = cube_at(0, 0, 0), second = cube_at(0.5f, 0.5f, 0.5f);
    insert_cube(grid, &first);
    insert_cube(grid, &second);

    uint64_t size = 0;
    must(vox_grid_save(grid, NULL, 0, &size)); /* how large? */
    unsigned char* bytes = (unsigned char*)malloc((size_t)size);
    must(vox_grid_save(grid, bytes, size, &size));
    must(vox_grid_load(bytes, size, NULL, &again));

    uint64_t hashes[2];
    must(vox_grid_step(grid));
    must(vox_grid_step(again));
    must(vox_grid_get_hash(grid, &hashes[0]));
    must(vox_grid_get_hash(again, &hashes[1]));
    printf("%" PRIu64 " bytes; hash %016" PRIx64 ", from the snapshot %016" PRIx64 "\n", size, hashes[0],
           hashes[1]);
    vox_grid_destroy(again);

    bytes[size / 2] ^= 1;
    if (vox_grid_load(bytes, size, NULL, &again) != VOX_OK) printf("one bit turned: %s\n", vox_last_error());
    free(bytes);
    vox_grid_destroy(grid);
    return hashes[0] == hashes[1] ? 0 : 1;
}
