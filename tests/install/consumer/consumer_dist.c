#include <stdio.h>
#include <vox/vox_dist.h>

/* Two tetrahedra on one rank, the second with a vertex in the first. */
static int found(vox_dist_scene* scene, uint64_t* out_count) {
    static double positions[2][12];
    static const uint32_t tet[] = {0, 1, 2, 3};
    vox_dist_contact_view contacts;
    uint64_t hash[2];
    for (uint64_t body = 0; body < 2; ++body) {
        vox_dist_part_desc desc = vox_default_dist_part_desc();
        const vox_mesh_desc mesh = vox_mesh_desc_doubles(positions[body], 4, tet, 1);
        for (int i = 0; i < 12; ++i) positions[body][i] = 0.25 * (double)body + (i % 4 == 3);
        desc.body = body;
        desc.mesh = &mesh;
        if (vox_dist_scene_insert(scene, &desc) != VOX_OK) return 0;
    }
    if (vox_dist_scene_step(scene) != VOX_OK || vox_dist_scene_get_hash(scene, hash) != VOX_OK ||
        vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &contacts) != VOX_OK)
        return 0;
    *out_count = contacts.count;
    return hash[0] != 0;
}

int main(void) {
    vox_dist_scene* scene;
    uint64_t count = 0;
    int bad;
    if (vox_dist_scene_create(NULL, NULL, &scene) != VOX_OK) return puts(vox_last_error()), 1;
    bad = !found(scene, &count) || count != 1;
    vox_dist_scene_destroy(scene);
    return bad ? puts(vox_last_error()), 1 : 0;
}
