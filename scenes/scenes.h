/* Scenes that are the same bit for bit on every machine: they use no function of the C library, only
 * additions, products and divisions of doubles. For the portability check and the speed guard. */
#ifndef VOX_SCENES_SCENES_H
#define VOX_SCENES_SCENES_H

#include "scenes/bodies.h"
#include "scenes/waves.h"

#include <stdio.h>

#define MOST_BODIES 125

typedef struct scene {
    const char* name;
    uint32_t count;
    int self_collision;
    double amplitude, wave_length; /* of the deformation of the frames */
    body bodies[MOST_BODIES];
    float* rest[MOST_BODIES]; /* undeformed positions */
} scene;

static inline void add_body(scene* s, body b) {
    s->rest[s->count] = (float*)malloc(3 * sizeof(float) * b.vertex_count);
    memcpy(s->rest[s->count], b.positions, 3 * sizeof(float) * b.vertex_count);
    s->bodies[s->count++] = b;
}

/* Two balls that overlap a little. */
static inline void make_pair(scene* s, uint32_t radius) {
    s->amplitude = 0.02 * radius;
    s->wave_length = 2.0 * radius;
    for (int i = 0; i < 2; ++i) {
        body b = make_lattice_ball(&five_cut, radius, radius);
        jitter_body(&b, 0.1, (uint64_t)i + 1);
        move_body(&b, 1.85 * radius * i, 0.123 * i, 0.271 * i);
        add_body(s, b);
    }
}

/* One compact ball. */
static inline void make_self(scene* s, uint32_t radius) {
    body b = make_lattice_ball(&five_cut, radius, radius);
    jitter_body(&b, 0.1, 3);
    s->self_collision = 1;
    s->amplitude = 0.02 * radius;
    s->wave_length = 2.0 * radius;
    add_body(s, b);
}

/* One ball whose vertices are moved at random by up to the edge of a cube. */
static inline void make_tangled(scene* s, uint32_t radius) {
    body b = make_lattice_ball(&five_cut, radius, radius);
    jitter_body(&b, 1, 6);
    s->self_collision = 1;
    s->amplitude = 0.02 * radius;
    s->wave_length = 2.0 * radius;
    add_body(s, b);
}

/* side^3 small balls in a lattice, each overlapping its neighbours lightly. */
static inline void make_many(scene* s, uint32_t side, uint32_t radius) {
    const double apart = 1.93 * radius;
    s->amplitude = 0.02 * radius;
    s->wave_length = 2.0 * radius;
    for (uint32_t i = 0; i < side * side * side; ++i) {
        uint64_t seed = i + 10;
        body b = make_lattice_ball(&five_cut, radius, radius);
        jitter_body(&b, 0.1, seed);
        const double x = 0.05 * radius * random_symmetric(&seed), y = 0.05 * radius * random_symmetric(&seed);
        move_body(&b, apart * (i % side) + x, apart * (i / side % side) + y, apart * (i / side / side));
        add_body(s, b);
    }
}

/* A row of boxes bent around until its ends go through each other: the circle as a rational curve, squared as
 * a complex number so that one turn and more are covered. */
static inline void make_ring(scene* s, uint32_t n) {
    body b = make_box(n, 1, 0, 0, 0);
    jitter_body(&b, 0.1, 4);
    for (uint32_t v = 0; v < b.vertex_count; ++v) {
        float* p = b.positions + 3 * v;
        const double t = 1.25 * (2.0 * p[0] / n - 1), w = 1 + t * t; /* half an angle of up to 2 atan 1.25 */
        const double c = (1 - t * t) / w, h = 2 * t / w, around = 0.4 * n + 0.3 * p[1];
        p[0] = (float)(around * (c * c - h * h));
        p[1] = (float)(around * (2 * c * h));
        p[2] = (float)(0.3 * p[2]);
    }
    s->self_collision = 1;
    s->amplitude = 0.02 * n;
    s->wave_length = 2.0 * n;
    add_body(s, b);
}

/* Tets over random vertices of a coarse lattice: flat, inverted, coincident, touching in every way. */
static inline void make_soup(scene* s, uint32_t vertices, uint32_t tets) {
    uint64_t seed = 5;
    s->self_collision = 1;
    for (int i = 0; i < 3; ++i) {
        body b;
        b.vertex_count = vertices;
        b.tet_count = tets;
        b.positions = (float*)malloc(3 * sizeof(float) * vertices);
        b.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * tets);
        for (uint32_t k = 0; k < 3 * vertices; ++k)
            b.positions[k] = (float)((int32_t)(random_next(&seed) % 17) - 8) * 0.5f;
        for (uint32_t k = 0; k < 4 * tets; ++k) b.tets[k] = (uint32_t)(random_next(&seed) % vertices);
        add_body(s, b);
    }
}

static inline void scale_scene(scene* s, double factor) {
    s->amplitude *= factor;
    s->wave_length *= factor;
    for (uint32_t i = 0; i < s->count; ++i)
        for (uint32_t k = 0; k < 3 * s->bodies[i].vertex_count; ++k)
            s->rest[i][k] = (float)(s->rest[i][k] * factor);
}

/* Writes the positions of a frame. */
static inline void pose_scene(scene* s, int frame) {
    for (uint32_t i = 0; i < s->count; ++i)
        for (uint32_t v = 0; v < s->bodies[i].vertex_count; ++v) {
            const float* rest = s->rest[i] + 3 * v;
            float* p = s->bodies[i].positions + 3 * v;
            for (int a = 0; a < 3; ++a) {
                double moved = rest[a];
                if (s->wave_length > 0)
                    moved += s->amplitude * triangle_wave((double)rest[(a + 1) % 3] / s->wave_length +
                                                          0.017 * frame + 0.3 * a + 0.14 * i);
                p[a] = (float)moved;
            }
        }
}

static inline void free_scene(scene* s) {
    for (uint32_t i = 0; i < s->count; ++i) {
        free_body(&s->bodies[i]);
        free(s->rest[i]);
    }
    memset(s, 0, sizeof *s);
}

/* Inserts all bodies; if that fails, returns 0 and prints the reason on stderr. */
static inline int insert_scene(const scene* s, vox_grid* grid) {
    for (uint32_t i = 0; i < s->count; ++i) {
        vox_body mesh;
        vox_mesh_desc desc = body_desc(&s->bodies[i]);
        if (s->self_collision) desc.filter.flags |= VOX_FILTER_SELF_COLLISION;
        if (vox_mesh_insert(grid, &desc, &mesh) != VOX_OK) {
            fprintf(stderr, "%s: %s\n", s->name, vox_last_error());
            return 0;
        }
    }
    return 1;
}

#endif
