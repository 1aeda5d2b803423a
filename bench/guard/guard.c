/* One small scene, stepped a few times; guard.py counts the instructions of vox_grid_step. The data are the
 * same bit for bit on every machine (scenes/scenes.h). The grid has constraints where the name says so; else
 * it is the default one. */
#include "scenes/scenes.h"

int main(int argc, char** argv) {
    static scene s;
    s.name = argc == 2 ? argv[1] : "";
    vox_grid_desc desc = vox_default_grid_desc();
    if (strncmp(s.name, "constraints-", 12) == 0) {
        s.name += 12;
        desc.flags = VOX_GRID_CONSTRAINTS;
    }
    if (strcmp(s.name, "--build") == 0) { /* which compiler the baseline must be of */
        puts(vox_build_info());
        return EXIT_SUCCESS;
    } else if (strcmp(s.name, "pair") == 0) {
        make_pair(&s, 12);
    } else if (strcmp(s.name, "self") == 0) {
        make_self(&s, 13);
    } else if (strcmp(s.name, "many") == 0) {
        make_many(&s, 4, 5);
    } else if (strcmp(s.name, "tangled") == 0) {
        make_tangled(&s, 6);
    } else {
        fprintf(stderr, "usage: guard --build | [constraints-]pair | [constraints-]self | [constraints-]many "
                        "| [constraints-]tangled\n");
        return 2;
    }

    vox_grid* grid = NULL;
    vox_contact_view view = {0};
    int ok = vox_grid_create(&desc, &grid) == VOX_OK && insert_scene(&s, grid);
    for (int frame = 0; ok && frame < 4; ++frame) {
        pose_scene(&s, frame);
        ok = vox_grid_step(grid) == VOX_OK && vox_grid_get_contacts(grid, &view) == VOX_OK;
    }
    uint64_t tets = 0;
    for (uint32_t i = 0; i < s.count; ++i) tets += s.bodies[i].tet_count;
    if (ok)
        printf("%llu tets, %llu contacts\n", (unsigned long long)tets, (unsigned long long)view.count);
    else
        fprintf(stderr, "%s: %s\n", s.name, vox_last_error());
    vox_grid_destroy(grid);
    free_scene(&s);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
