/* The engine of a grid, which a pointer in vox_grid_desc chooses. */
#ifndef VOX_SCENES_ENGINES_H
#define VOX_SCENES_ENGINES_H

#include <vox/vox_cell_size.h>

typedef enum engine_kind { ENGINE_REFERENCE = 0, ENGINE_FAST = 1 } engine_kind;

/* The reference engine, with vox_reference_flags. */
static inline const vox_reference_desc* reference_with(uint32_t flags) {
    static const vox_reference_desc all[4] = {{sizeof all[0], 0, 0, {0, 0, 0}, {0, 0, 0}, NULL},
                                              {sizeof all[0], 1, 0, {0, 0, 0}, {0, 0, 0}, NULL},
                                              {sizeof all[0], 2, 0, {0, 0, 0}, {0, 0, 0}, NULL},
                                              {sizeof all[0], 3, 0, {0, 0, 0}, {0, 0, 0}, NULL}};
    return &all[flags];
}

static inline void use_engine(vox_grid_desc* desc, engine_kind engine) {
    desc->reference = engine == ENGINE_REFERENCE ? reference_with(0) : NULL;
}

#endif
