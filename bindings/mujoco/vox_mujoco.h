/* vox in MuJoCo: the plugin vox.contact (README.md), for C programs that want to read more than its forces
 * and sensors give. Nothing here is needed to use the plugin. */
#ifndef VOX_MUJOCO_H
#define VOX_MUJOCO_H

#include <mujoco/mujoco.h>
#include <vox/vox.h>

#if defined(_WIN32)
#define VOX_MUJOCO_EXPORT __declspec(dllexport)
#else
#define VOX_MUJOCO_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The grid of plugin instance `instance` in `d`, whose last step saw d->flexvert_xpos as they were when
 * passive forces were computed last: for its contacts, pairs and constraints. Mesh by mesh it has
 * the flexes that take part, in the order of the model, and then the geoms; vox_body_get_user_data is the id
 * of either. It belongs to the plugin and lives as long as `d`; whoever uses it has to be the thread that may
 * use `d`. Null if there is no such instance of vox.contact. It has no meshes before passive forces were
 * computed for the first time. */
VOX_MUJOCO_EXPORT const vox_grid* vox_mujoco_grid(const mjData* d, int instance);

#ifdef __cplusplus
}
#endif

#endif
