/* Writes the scene that the programs of this folder step, as 32-bit little-endian words: how many bodies, how
 * many frames; of each body how many vertices and tetrahedra; the tetrahedra of each; for each frame the
 * positions of each, as floats. usage: scene OUT */
#include "scenes/scenes.h"

enum { FRAMES = 8, RADIUS = 10 };

int main(int argc, char** argv) {
    static scene s;
    FILE* out = argc == 2 ? fopen(argv[1], "wb") : NULL;
    if (!out) return fprintf(stderr, "usage: scene OUT\n"), 1;
    make_pair(&s, RADIUS);
    const uint32_t counts[2] = {s.count, FRAMES};
    fwrite(counts, 4, 2, out);
    for (uint32_t b = 0; b < s.count; ++b) {
        fwrite(&s.bodies[b].vertex_count, 4, 1, out);
        fwrite(&s.bodies[b].tet_count, 4, 1, out);
    }
    for (uint32_t b = 0; b < s.count; ++b) fwrite(s.bodies[b].tets, 16, s.bodies[b].tet_count, out);
    for (int frame = 0; frame < FRAMES; ++frame) {
        pose_scene(&s, frame);
        for (uint32_t b = 0; b < s.count; ++b)
            fwrite(s.bodies[b].positions, 12, s.bodies[b].vertex_count, out);
    }
    free_scene(&s);
    return fclose(out) != 0;
}
