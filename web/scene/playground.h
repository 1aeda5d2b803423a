/* The scene of the playground: soft bodies that fall into a ring, and what a visitor does to them. The page
 * runs it as WebAssembly in a worker; the tests run the same code natively and compare hashes.
 *
 * Everything goes through the public libraries, except inside.cpp, which shows what the fast engine keeps to
 * itself. Functions return vox_result, and vox_last_error() has the text. A function that fails changes
 * nothing. What is pointed to belongs to the playground, until the next call that is not const. One thread.
 */
#ifndef VOX_WEB_PLAYGROUND_H
#define VOX_WEB_PLAYGROUND_H

#include <vox/vox_cell_size.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct playground playground;

typedef enum play_kind {
    PLAY_BALL = 0,
    PLAY_BOX = 1,
    PLAY_RING = 2,
    PLAY_CAPSULE = 3,
    PLAY_BAR = 4,
    PLAY_FILE = 5,  /* of the visitor's own */
    PLAY_FIXED = 6, /* the ring on the floor */
} play_kind;

/* A scene with the fixed ring alone, which the caller ends with play_destroy. Its simulation may hold
 * `byte_limit` bytes; 0: no limit. */
vox_result play_create(uint64_t byte_limit, playground** out);
void play_destroy(playground* play);

/* Drops a body of about `tets` tetrahedra (100 to 200000) above all others. */
vox_result play_drop(playground* play, uint32_t kind, uint32_t tets);
/* The same for a file, which stands upright: along its y axis if `y_up` is 1, along its z axis if it is 0. A
 * surface is filled with about `tets` tetrahedra. play_text() says what was odd about it. */
vox_result play_drop_file(playground* play, const char* name, const void* bytes, uint64_t size, uint32_t tets,
                          uint32_t y_up);
const char* play_text(const playground* play);
/* Removes all bodies but the fixed ring. */
vox_result play_clear(playground* play);
/* Of all bodies, now and later: the engine that finds their contacts (the vox_cost_model that predicts it),
 * whether they collide with themselves (0 or 1), and their Young's modulus. At first the fast engine, 0 and
 * 2e5. */
vox_result play_configure(playground* play, uint32_t engine, uint32_t self_collision, double stiffness);
/* The cell size of the scene's grid; 0, as at first: the grid chooses. */
vox_result play_set_cell_size(playground* play, double cell_size);

/* Moves everything by 1/60 s, unless all bodies have come to rest: then they sleep until something is done to
 * them. */
vox_result play_step(playground* play);

/* Takes hold of the body that the segment hits first; out_point is where. VOX_OK with *out_found 0 if there
 * is none. */
vox_result play_grab(playground* play, const double from[3], const double to[3], double out_point[3],
                     uint32_t* out_found);
/* Where the grabbed point is to go. */
void play_drag(playground* play, const double point[3]);
void play_let_go(playground* play);
/* Cuts every body that crosses the triangle (eye, first, second), extended without end beyond first and
 * second, between its tetrahedra. Parts that come apart are bodies of their own, with a gap between them; two
 * that still touch are no pair until they are apart. *out_cut: how many bodies were cut. */
vox_result play_cut(playground* play, const double eye[3], const double first[3], const double second[3],
                    uint32_t* out_cut);

typedef enum play_tool {
    PLAY_NO_TOOL = 0,
    PLAY_SPHERE = 1, /* pushes bodies */
    PLAY_BLADE = 2,  /* upright; also shows the edges that it crosses */
} play_tool;

/* Takes a tool into the hand; a blade stands along a direction x, y. A new one is at the point at once. One
 * that is held goes there, at 6 m/s at most. */
vox_result play_hold(playground* play, uint32_t tool, const double point[3], const double along[2]);
/* Six floats for each line: edges that the blade crosses, and sides of faces that its rim passes through. */
const float* play_touched(playground* play, uint32_t* out_count);

/* What there is to draw of a body. `serial` is another for each body and for each part of one; parts have the
 * `origin` of what they were cut from, the serial of a body that was dropped. */
typedef struct play_body {
    const float* positions;    /* 3 * vertex_count */
    const uint32_t* triangles; /* of the surface; 3 * triangle_count. Cut faces come last */
    uint32_t vertex_count;
    uint32_t triangle_count;
    uint32_t uncut_count; /* of the triangles */
    uint32_t serial, origin;
    uint32_t kind;
} play_body;
uint32_t play_body_count(const playground* play);
const play_body* play_get_body(const playground* play, uint32_t index);

/* Six floats for each vertex in a body: the vertex, and the way out as a vector. */
const float* play_penetrations(playground* play, uint32_t* out_count);

/* Boxes, six floats each (min, max): of tiles (what 0), and of windows of the last step (what 1). */
const float* play_boxes(playground* play, uint32_t what, uint32_t* out_count);

typedef struct play_facts {
    double tets, contacts, deepest;
    double step_ns, detect_ns, grid_ns; /* of the last step that was not slept through: all, what finds
                                           contacts and depths, and contacts alone */
    double cell_size;
    double max_speed;
    double steps;
    double asleep; /* 1: all bodies are */
    double bytes, byte_limit;
    double pairs;   /* of bodies that touch */
    double touched; /* constraints with the tool */
    double tool[3]; /* where it is */
} play_facts;
const play_facts* play_get_facts(playground* play);
/* Combines vox_grid_get_hash of all steps since the scene was made or loaded. */
uint64_t play_hash(const playground* play);

/* ---- the cell size ---- */

/* Steps a grid of its own over the bodies as they are, with this engine (the vox_cost_model that predicts it)
 * and cell size, `steps` times, without depth. *out_ns: time of these steps together. *out_same: whether the
 * contacts are those that a grid of the default settings finds. */
vox_result play_measure(playground* play, uint32_t engine, double cell_size, uint32_t steps, double* out_ns,
                        uint32_t* out_same);
/* What vox_grid_suggest_cell_size says of those bodies for a model (vox_cost_model), as numbers alone: cell
 * size, zone (2), cost, numbers of samples, terms and rules; then samples (cell size, cost), terms (count,
 * cost) and rules (cell size, cost). Costs are seconds. Null where it fails. */
const double* play_suggest_numbers(playground* play, uint32_t model);
/* Names of a term and of a rule of the last suggestion. */
const char* play_term(const playground* play, uint32_t index);
const char* play_rule(const playground* play, uint32_t index);

/* ---- snapshots, as `vox replay` reads them ---- */

/* *out_hash: what a step of that snapshot finds. */
vox_result play_save(playground* play, const void** out_bytes, uint64_t* out_size, uint64_t* out_hash);
/* Bodies as a snapshot has them, in place of all others; how they are there is their rest shape. */
vox_result play_load(playground* play, const void* bytes, uint64_t size);

#ifdef __cplusplus
}
#endif

#endif
