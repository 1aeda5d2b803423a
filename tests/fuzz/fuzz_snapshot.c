/* libFuzzer target: vox_grid_load. Whatever comes in, it gives an error or a sound grid: one that can be
 * stepped, saved and loaded again, with the same contacts. The input is tried as it is, and with its size and
 * checksum put right, or nothing would get past them. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox.h>

#include "bytes.h"

static void put(unsigned char* at, int bytes, uint64_t value) {
    for (int i = 0; i < bytes; ++i) at[i] = (unsigned char)(value >> 8 * i);
}

static void seal(unsigned char* bytes, size_t size) {
    uint32_t remainder = 0xffffffffu;
    put(bytes + 16, 8, size);
    for (size_t i = 16; i < size; ++i) {
        remainder ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320u : 0);
    }
    put(bytes + 12, 4, ~remainder & 0xffffffffu);
}

static vox_grid* load(const void* bytes, size_t size) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    desc.byte_budget = 64u << 20;
    const vox_result result = vox_grid_load(bytes, size, &desc, &grid);
    if (result == VOX_OK) return grid;
    demand(grid == NULL && *vox_last_error() != 0);
    demand(result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED || result == VOX_ERROR_LIMIT ||
           result == VOX_ERROR_BUDGET);
    return NULL;
}

static void check(vox_grid* grid) {
    uint64_t size = 0, hash = 0, hash_again = 0;
    demand(vox_grid_save(grid, NULL, 0, &size) == VOX_OK);
    unsigned char* bytes = (unsigned char*)malloc((size_t)size);
    demand(bytes != NULL);
    demand(vox_grid_save(grid, bytes, size, &size) == VOX_OK);
    vox_grid* again = load(bytes, (size_t)size);
    demand(again != NULL);
    const vox_result stepped = vox_grid_step(grid);
    demand(stepped == VOX_OK || stepped == VOX_ERROR_NON_FINITE || stepped == VOX_ERROR_INVALID_STATE ||
           stepped == VOX_ERROR_BUDGET || stepped == VOX_ERROR_LIMIT);
    demand(vox_grid_step(again) == stepped || stepped == VOX_ERROR_BUDGET);
    demand(vox_grid_get_hash(grid, &hash) == VOX_OK && vox_grid_get_hash(again, &hash_again) == VOX_OK);
    demand(hash == hash_again || stepped != VOX_OK);
    vox_grid_destroy(again);
    free(bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    vox_grid* grid = load(data, size);
    if (!grid && size >= 24) {
        unsigned char* sealed = (unsigned char*)malloc(size);
        demand(sealed != NULL);
        memcpy(sealed, data, size);
        seal(sealed, size);
        grid = load(sealed, size);
        free(sealed);
    }
    if (grid) check(grid);
    vox_grid_destroy(grid);
    return 0;
}
