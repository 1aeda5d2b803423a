/* Callbacks into JavaScript. WebAssembly reaches JavaScript through imports alone, so each kind of callback
 * is one import, and `user` says which function is meant. */
#include <vox/vox_cell_size.h>

#define IMPORT(name) __attribute__((import_module("env"), import_name(#name)))
#define EXPORT __attribute__((used, visibility("default")))

IMPORT(voxtet_log) void voxtet_log(vox_log_level level, const char* text, void* user);
IMPORT(voxtet_cost) double voxtet_cost(double cell_size, void* user);

static void write_log(vox_log_level level, const char* text, void* user) { voxtet_log(level, text, user); }

static double cost(double cell_size, void* user) { return voxtet_cost(cell_size, user); }

/* A log that goes to the function `user`. */
EXPORT void voxtet_set_log(vox_log* log, void* user) {
    log->write = write_log;
    log->user = user;
}

/* vox_cost_minimise with the function `user`. */
EXPORT vox_result voxtet_cost_minimise(void* user, double min, double max, double zone_loss,
                                       vox_cell_size_result* out) {
    return vox_cost_minimise(cost, user, min, max, zone_loss, out);
}

/* vox_foreign_grid_tune with the function `user`. */
EXPORT vox_result voxtet_foreign_grid_tune(const vox_foreign_grid* grid, const vox_tune_desc* desc,
                                           void* user, vox_cell_size_result* out) {
    return vox_foreign_grid_tune(grid, desc, cost, user, out);
}
