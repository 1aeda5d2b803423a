/* Steps built-in scenes with both engines and prints the hash of the contacts of every frame: the same text
 * on every machine and instruction set. `./dev portability` compares them. */
#include "scenes.h"

#include <inttypes.h>

static int run(scene* s, const char* name, double factor) {
    static const vox_engine engines[2] = {VOX_ENGINE_FAST, VOX_ENGINE_REFERENCE};
    int ok = 1;
    s->name = name;
    if (factor != 1) scale_scene(s, factor);
    pose_scene(s, 0);
    for (int e = 0; ok && e < 2; ++e) {
        vox_grid* grid = NULL;
        vox_grid_desc desc = vox_default_grid_desc();
        desc.engine = engines[e];
        ok = vox_grid_create(&desc, &grid) == VOX_OK && insert_scene(s, grid);
        for (int frame = 0; ok && frame < 3; ++frame) {
            vox_contact_view view;
            uint64_t hash;
            pose_scene(s, frame);
            ok = vox_grid_step(grid) == VOX_OK && vox_grid_contacts(grid, &view) == VOX_OK &&
                 vox_grid_hash(grid, &hash) == VOX_OK;
            if (ok)
                printf("%s, frame %d, %s: %" PRIu64 " contacts, %016" PRIx64 "\n", name, frame,
                       e == 0 ? "fast" : "reference", view.count, hash);
        }
        if (!ok) fprintf(stderr, "%s: %s\n", name, vox_last_error());
        vox_grid_destroy(grid);
    }
    free_scene(s);
    return ok;
}

int main(void) {
    static scene s;
    int ok = 1;
    make_pair(&s, 9), ok &= run(&s, "pair", 1);
    make_self(&s, 9), ok &= run(&s, "self", 1);
    make_ring(&s, 16), ok &= run(&s, "ring", 1);
    make_many(&s, 3, 4), ok &= run(&s, "many", 1);
    make_soup(&s, 120, 400), ok &= run(&s, "soup", 1);
    make_pair(&s, 6), ok &= run(&s, "tiny", 1e-36);  /* areas and volumes are too small for a float */
    make_pair(&s, 6), ok &= run(&s, "least", 1e-41); /* and so are normal coordinates */
    make_pair(&s, 6), ok &= run(&s, "huge", 1e30);   /* or too large */
    make_ring(&s, 10), ok &= run(&s, "huge ring", 1e20);
    /* Errors cross the border the same way everywhere. */
    {
        vox_grid* grid = NULL;
        make_pair(&s, 3);
        pose_scene(&s, 0);
        s.bodies[1].positions[7] = (float)(1e300 * 1e300);
        ok &= vox_grid_create(NULL, &grid) == VOX_OK && insert_scene(&s, grid);
        const vox_result result = ok ? vox_grid_step(grid) : VOX_OK;
        printf("not finite: %s\n", vox_result_string(result));
        vox_grid_destroy(grid);
        free_scene(&s);
    }
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
