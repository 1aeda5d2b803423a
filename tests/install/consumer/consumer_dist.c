#include <stdio.h>
#include <vox/vox_dist.h>

/* A tetrahedron on each of three ranks, each with a vertex in that of the one before. */
static int bad;
static void each(const vox_transport* transport, void* user) {
    const double x = 0.25 * transport->rank;
    const double positions[] = {x, x, x, x + 1, x, x, x, x + 1, x, x, x, x + 1};
    static const uint32_t tet[] = {0, 1, 2, 3};
    const vox_mesh_desc mesh = vox_mesh_desc_doubles(positions, 4, tet, 1);
    vox_part_desc desc = vox_default_part_desc();
    vox_part part;
    vox_scene* scene;
    uint64_t hash[2];
    (void)user;
    if (vox_scene_create(NULL, transport, &scene) != VOX_OK) {
        bad = 1;
        return;
    }
    desc.body = transport->rank;
    desc.mesh = &mesh;
    if (vox_scene_insert(scene, &desc, &part) != VOX_OK || vox_scene_step(scene) != VOX_OK ||
        vox_scene_hash(scene, hash) != VOX_OK || hash[0] == 0)
        bad = 1;
    vox_scene_destroy(scene);
}

int main(void) {
    if (vox_transport_run(3, 1, each, NULL) != VOX_OK) return puts(vox_last_error()), 1;
    return bad ? puts(vox_last_error()), 1 : 0;
}
