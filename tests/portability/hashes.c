/* Steps built-in scenes and prints hashes of what every frame gives: contacts, vertices inside, pairs, edges,
 * proximities, impacts; closest points, answers of locators; answers of surfaces. The text
 * is the same on every machine, with every compiler and instruction set, engine, number of workers and format
 * of positions: matrix.py, `./dev hashes`, `./dev cross`. hashes [--engine fast|reference] [--workers N]
 * [--doubles] [--moved] [--level 0..3] [--cell-size FACTOR] */
#include "portability/simd_level.h"
#include "scenes/engines.h"
#include "scenes/scenes.h"

#include <inttypes.h>
#include <math.h>
#include <vox/vox_query.h>
#include <vox/vox_surface.h>

typedef struct settings {
    engine_kind engine;
    uint32_t workers;
    int doubles;      /* positions given as doubles, of the same values */
    int moved;        /* by a transform to where they are */
    double cell_size; /* in edges of a tetrahedron; 0: the library's choice */
} settings;

/* ---- hashes ---- */

static void add_number(uint64_t* hash, uint64_t value) {
    *hash = (*hash ^ value) * 0x9fb21c651e98df25u;
    *hash ^= *hash >> 29;
}

static void add_double(uint64_t* hash, double value) {
    uint64_t bits;
    value += 0; /* one zero */
    memcpy(&bits, &value, sizeof bits);
    add_number(hash, bits);
}

static void add_doubles(uint64_t* hash, const double values[3]) {
    for (int i = 0; i < 3; ++i) add_double(hash, values[i]);
}

static void add_hit(uint64_t* hash, uint32_t question, vox_body body, uint32_t tet) {
    add_number(hash, question), add_number(hash, body), add_number(hash, tet);
}

static void add_place(uint64_t* hash, uint32_t facet, const uint32_t face[3], const double weights[3]) {
    add_number(hash, facet), add_doubles(hash, weights);
    for (int c = 0; c < 3; ++c) add_number(hash, face[c]);
}

/* Of a few points, boxes and rays around the first body's vertices. */
static int hash_answers(vox_grid* grid, const scene* s, uint64_t* hash) {
    enum { most = 24, room = 16384 };
    static vox_point_hit points[room];
    static vox_box_hit boxes[room];
    static vox_ray_hit rays[room];
    vox_closest_hit closest[most];
    uint8_t blocked[most];
    double from[most][3], to[most][3], least[most][3], greatest[most][3];
    uint64_t count = 0, point_count = 0, box_count = 0, ray_count = 0;
    vox_locator* locator = NULL;
    const body* b = &s->bodies[0];
    for (uint32_t v = 0; v < b->vertex_count; v += 1 + b->vertex_count / 23, ++count)
        for (uint32_t i = 0; i < 3; ++i) {
            const double p = from[count][i] = (double)b->positions[3 * v + i];
            const double q = to[count][i] = (double)b->positions[3 * (b->vertex_count - 1 - v) + i];
            least[count][i] = p < q ? p : q;
            greatest[count][i] = p < q ? q : p;
        }
    const vox_positions begins = vox_double_positions(from[0], count),
                        ends = vox_double_positions(to[0], count);
    const vox_positions lows = vox_double_positions(least[0], count),
                        highs = vox_double_positions(greatest[0], count);
    const int ok =
        vox_grid_update_locator(grid, &locator) == VOX_OK &&
        vox_locator_find_point_hits(locator, &begins, NULL, points, room, &point_count) == VOX_OK &&
        vox_locator_find_closest(locator, &begins, NULL, closest) == VOX_OK &&
        vox_locator_find_box_hits(locator, &lows, &highs, NULL, boxes, room, &box_count) == VOX_OK &&
        vox_locator_find_ray_hits(locator, &begins, &ends, NULL, rays, room, &ray_count) == VOX_OK &&
        vox_locator_test_rays(locator, &begins, &ends, NULL, blocked) == VOX_OK;
    vox_locator_release(locator);
    if (!ok) return 0;
    add_number(hash, point_count), add_number(hash, box_count), add_number(hash, ray_count);
    for (uint64_t i = 0; i < point_count && i < room; ++i) {
        add_hit(hash, points[i].point, points[i].body, points[i].tet);
        for (int c = 0; c < 4; ++c) add_double(hash, points[i].weights[c]);
    }
    for (uint64_t i = 0; i < box_count && i < room; ++i)
        add_hit(hash, boxes[i].box, boxes[i].body, boxes[i].tet);
    for (uint64_t i = 0; i < ray_count && i < room; ++i) {
        add_hit(hash, rays[i].ray, rays[i].body, rays[i].tet);
        add_place(hash, rays[i].facet, rays[i].face, rays[i].weights);
        add_number(hash, (uint64_t)rays[i].side), add_double(hash, rays[i].t);
    }
    for (uint64_t i = 0; i < count; ++i) {
        add_hit(hash, closest[i].inside, closest[i].body, closest[i].tet);
        add_place(hash, closest[i].facet, closest[i].face, closest[i].weights);
        add_doubles(hash, closest[i].position), add_doubles(hash, closest[i].normal);
        add_double(hash, closest[i].distance), add_number(hash, blocked[i]);
    }
    return 1;
}

/* ---- what a response needs ---- */

static int hash_contacts(const vox_grid* grid, uint64_t* count, uint64_t* hash) {
    vox_contact_view view;
    if (vox_grid_get_contacts(grid, &view) != VOX_OK) return 0;
    *count = view.count;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_contact* c = &view.data[i];
        add_number(hash, c->body_a), add_number(hash, c->vertex), add_number(hash, c->body_b);
        add_number(hash, c->tet), add_number(hash, view.interiors[i]);
    }
    return 1;
}

static int touches(const vox_pair* p) { return p->state == VOX_PAIR_BEGAN || p->state == VOX_PAIR_PERSISTED; }

/* Pairs that touch, then those that began to and those that ended. */
static int hash_pairs_of_bodies(const vox_grid* grid, uint64_t* count, uint64_t* hash) {
    vox_pair_view pairs;
    if (vox_grid_get_pairs(grid, &pairs) != VOX_OK) return 0;
    *count = 0;
    for (uint64_t i = 0; i < pairs.count; ++i) {
        const vox_pair* p = &pairs.data[i];
        if (!touches(p)) continue;
        ++*count;
        add_number(hash, p->body_a), add_number(hash, p->body_b);
        add_number(hash, p->user_data_a), add_number(hash, p->user_data_b);
        for (uint64_t c = 0; c < p->contact_count; ++c)
            add_number(hash, pairs.contacts[p->first_contact + c]);
    }
    for (int ended = 0; ended < 2; ++ended)
        for (uint64_t i = 0; i < pairs.count; ++i)
            if (pairs.data[i].state == (ended ? VOX_PAIR_ENDED : VOX_PAIR_BEGAN))
                add_number(hash, pairs.data[i].body_a), add_number(hash, pairs.data[i].body_b);
    return 1;
}

static int by_number(uint32_t x, uint32_t y) { return (x > y) - (x < y); }

/* The order of contacts: body_a, its vertices, body_b, and of a face the vertices in ascending order. */
static int by_contact(const void* x, const void* y) {
    const vox_constraint *c = *(const vox_constraint*const*)x, *d = *(const vox_constraint*const*)y;
    int order = by_number(c->body_a, d->body_a);
    for (uint32_t i = 0; i < c->count_a && !order; ++i) order = by_number(c->vertices[i], d->vertices[i]);
    if (!order) order = by_number(c->body_b, d->body_b);
    for (int k = 0; k < 3 && !order && c->kind == VOX_CONSTRAINT_EDGE; ++k) {
        const uint32_t* const faces[2] = {c->vertices + 2, d->vertices + 2};
        uint32_t nth[2];
        for (int i = 0; i < 2; ++i) {
            const uint32_t *f = faces[i], rest[2] = {f[1] < f[2] ? f[1] : f[2], f[1] < f[2] ? f[2] : f[1]};
            nth[i] = k == 0 ? f[0] : rest[k - 1]; /* the first is the lowest */
        }
        order = by_number(nth[0], nth[1]);
    }
    return order;
}

/* Constraints of one kind, in the order of contacts. Edges and faces to the precision of a double, weights of
 * tetrahedra to that of a float. */
static int hash_constraints(const vox_grid* grid, vox_constraint_kind kind, uint64_t* count, uint64_t* hash) {
    vox_constraint_view view;
    const vox_constraint** sorted;
    if (vox_grid_get_constraints(grid, &view) != VOX_OK) return 0;
    sorted = (const vox_constraint**)malloc((size_t)(view.count + 1) * sizeof *sorted);
    *count = 0;
    for (uint64_t i = 0; i < view.count; ++i)
        if (view.data[i].kind == kind) sorted[(*count)++] = &view.data[i];
    qsort((void*)sorted, (size_t)*count, sizeof *sorted, by_contact);
    for (uint64_t i = 0; i < *count; ++i) {
        const vox_constraint* c = sorted[i];
        const uint32_t* of_b = c->vertices + c->count_a;
        const uint32_t count_b = c->count - c->count_a;
        double weights[4];
        for (uint32_t k = 0; k < count_b; ++k) weights[k] = -c->weights[c->count_a + k];
        add_number(hash, c->body_a);
        for (uint32_t k = 0; k < c->count_a; ++k) add_number(hash, c->vertices[k]);
        add_number(hash, c->body_b);
        if (kind == VOX_CONSTRAINT_INSIDE) add_number(hash, (uint64_t)c->state);
        add_number(hash, c->element_b);
        if (kind == VOX_CONSTRAINT_INSIDE) {
            for (uint32_t k = 0; k < count_b; ++k) add_double(hash, (double)(float)weights[k]);
        } else {
            for (uint32_t k = 0; k < count_b; ++k) add_number(hash, of_b[k]);
            if (kind == VOX_CONSTRAINT_EDGE) add_double(hash, c->weights[0]), add_double(hash, c->weights[1]);
            add_doubles(hash, weights);
        }
        if (kind == VOX_CONSTRAINT_EDGE) add_doubles(hash, c->position);
        if (kind == VOX_CONSTRAINT_IMPACT) add_double(hash, c->time);
        add_double(hash, kind == VOX_CONSTRAINT_PROXIMITY ? c->gap : -c->gap), add_doubles(hash, c->normal);
    }
    free((void*)sorted);
    return 1;
}

/* ---- scenes ---- */

static double *as_doubles[MOST_BODIES], *previous[MOST_BODIES];

static void write_doubles(const scene* s, double* const* to) {
    for (uint32_t b = 0; b < s->count; ++b)
        for (uint32_t i = 0; i < 3 * s->bodies[b].vertex_count; ++i)
            to[b][i] = (double)s->bodies[b].positions[i];
}

/* The id of a fresh grid's meshes: the slot, and the first generation. */
static vox_body mesh_of(uint32_t body) { return (body << 12) + 1; }

/* The first body comes from as far as it is wide, so that vertices go through others. */
static void write_previous(const scene* s) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    write_doubles(s, previous);
    for (uint32_t i = 0; i < 3 * s->bodies[0].vertex_count; i += 3) {
        least = fmin(least, previous[0][i]);
        most = fmax(most, previous[0][i]);
    }
    for (uint32_t i = 0; i < 3 * s->bodies[0].vertex_count; i += 3) previous[0][i] -= most - least;
}

static int bind_previous(const scene* s, vox_grid* grid) {
    for (uint32_t b = 0; b < s->count; ++b) {
        const vox_positions before = vox_double_positions(previous[b], s->bodies[b].vertex_count);
        if (vox_mesh_bind_previous_positions(grid, mesh_of(b), &before) != VOX_OK) return 0;
    }
    return 1;
}

/* As the settings want it: doubles in place of floats, a transform, rings. */
static int fit_meshes(const scene* s, const settings* how, uint32_t rings, vox_grid* grid) {
    static const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    int ok = 1;
    for (uint32_t b = 0; ok && b < s->count; ++b) {
        const vox_body mesh = mesh_of(b);
        if (how->doubles)
            ok = vox_mesh_bind_doubles(grid, mesh, as_doubles[b], s->bodies[b].vertex_count) == VOX_OK;
        if (how->moved) ok = ok && vox_body_set_transform(grid, mesh, here) == VOX_OK;
        if (rings > 0) {
            vox_filter filter = VOX_ZERO;
            filter.flags = VOX_FILTER_SELF_COLLISION;
            filter.self_rings = rings;
            ok = ok && vox_body_set_filter(grid, mesh, &filter) == VOX_OK;
        }
    }
    return ok;
}

/* What a frame gives. */
static int print_contacts(vox_grid* grid, const scene* s, int frame) {
    vox_contact_view view;
    vox_constraint_desc desc = vox_default_constraint_desc();
    uint64_t hash, count, parts[2] = {3, 4};
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    if (vox_grid_get_contacts(grid, &view) != VOX_OK || vox_grid_get_hash(grid, &hash) != VOX_OK ||
        vox_grid_find_constraints(grid, &desc) != VOX_OK ||
        !hash_constraints(grid, VOX_CONSTRAINT_INSIDE, &count, &parts[0]) ||
        vox_grid_find_constraints(grid, NULL) != VOX_OK || !hash_answers(grid, s, &parts[1]))
        return 0;
    printf("%s, frame %d: %" PRIu64 " contacts %016" PRIx64 ", closest %016" PRIx64 ", queries %016" PRIx64
           "\n",
           s->name, frame, view.count, hash, parts[0], parts[1]);
    return 1;
}

static int print_response(vox_grid* grid, const scene* s, int frame) {
    uint64_t counts[3] = {0}, parts[3] = {1, 2, 3};
    if (!hash_contacts(grid, &counts[0], &parts[0]) ||
        !hash_constraints(grid, VOX_CONSTRAINT_INSIDE, &counts[1], &parts[1]) ||
        !hash_pairs_of_bodies(grid, &counts[2], &parts[2]))
        return 0;
    printf("%s, frame %d: %" PRIu64 " contacts %016" PRIx64 ", %" PRIu64 " inside %016" PRIx64 ", %" PRIu64
           " pairs %016" PRIx64 "\n",
           s->name, frame, counts[0], parts[0], counts[1], parts[1], counts[2], parts[2]);
    return 1;
}

static int print_experimental(vox_grid* grid, const scene* s, int frame) {
    uint64_t counts[3] = {0}, parts[3] = {1, 2, 3};
    for (int i = 0; i < 3; ++i)
        if (!hash_constraints(grid, (vox_constraint_kind)(VOX_CONSTRAINT_EDGE + i), &counts[i], &parts[i]))
            return 0;
    printf("%s, frame %d: %" PRIu64 " edges %016" PRIx64 ", %" PRIu64 " proximities %016" PRIx64 ", %" PRIu64
           " impacts %016" PRIx64 "\n",
           s->name, frame, counts[0], parts[0], counts[1], parts[1], counts[2], parts[2]);
    return 1;
}

/* `margin` in edges of a tetrahedron; where it is not 0, also the edges, and what happens between frames. */
static int run(scene* s, const char* name, double factor, uint32_t rings, double margin,
               const settings* how) {
    enum { frames = 4 }; /* the last one at rest */
    vox_grid* grid = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    int ok;
    s->name = name;
    if (factor != 1) scale_scene(s, factor);
    pose_scene(s, 0);
    for (uint32_t b = 0; b < s->count; ++b)
        for (int i = 0; i < 2; ++i)
            (i ? previous : as_doubles)[b] = (double*)malloc(3 * sizeof(double) * s->bodies[b].vertex_count);
    write_doubles(s, as_doubles);
    use_engine(&desc, how->engine);
    desc.worker_count = how->workers;
    desc.cell_size = how->cell_size * factor;
    desc.flags |= VOX_GRID_CONSTRAINTS | (margin > 0 ? VOX_GRID_EDGES : 0);
    desc.margin = margin * factor;
    ok = vox_grid_create(&desc, &grid) == VOX_OK && insert_scene(s, grid) &&
         fit_meshes(s, how, rings, grid) && (margin == 0 || bind_previous(s, grid));
    for (int frame = 0; ok && frame < frames; ++frame) {
        write_previous(s);
        pose_scene(s, frame < 3 ? frame : 2);
        write_doubles(s, as_doubles);
        ok = vox_grid_step(grid) == VOX_OK && (margin > 0 || print_contacts(grid, s, frame)) &&
             print_response(grid, s, frame) && (margin == 0 || print_experimental(grid, s, frame));
    }
    if (!ok) fprintf(stderr, "%s: %s\n", name, vox_last_error());
    vox_grid_destroy(grid);
    for (uint32_t b = 0; b < s->count; ++b) free(as_doubles[b]), free(previous[b]);
    free_scene(s);
    return ok;
}

/* ---- surfaces ---- */

/* All bodies as one surface, with every facet of every tetrahedron, also the inner and the double ones;
 * positions of two frames. */
typedef struct soup_of_faces {
    vox_surface* surface;
    uint32_t vertex_count;
    void* at[2]; /* floats, or doubles where the settings say so */
} soup_of_faces;

static void* all_positions(const scene* s, uint32_t count, const settings* how) {
    float* floats = (float*)malloc(3 * sizeof(float) * count);
    double* doubles = (double*)malloc(3 * sizeof(double) * count);
    uint32_t n = 0;
    for (uint32_t b = 0; b < s->count; ++b)
        for (uint32_t i = 0; i < 3 * s->bodies[b].vertex_count; ++i, ++n)
            floats[n] = s->bodies[b].positions[i], doubles[n] = (double)floats[n];
    free(how->doubles ? (void*)floats : (void*)doubles);
    return how->doubles ? (void*)doubles : (void*)floats;
}

static int make_faces(scene* s, const settings* how, double cell_size, soup_of_faces* out) {
    static const uint32_t facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    uint64_t tets = 0, count = 0;
    uint32_t* faces;
    int result;
    vox_surface_desc desc = vox_default_surface_desc();
    memset(out, 0, sizeof *out);
    for (uint32_t b = 0; b < s->count; ++b) tets += s->bodies[b].tet_count;
    faces = (uint32_t*)malloc(12 * sizeof(uint32_t) * (size_t)tets);
    for (uint32_t b = 0; b < s->count; ++b) {
        for (uint32_t t = 0; t < s->bodies[b].tet_count; ++t)
            for (int f = 0; f < 4; ++f)
                for (int c = 0; c < 3; ++c)
                    faces[count++] = out->vertex_count + s->bodies[b].tets[4 * t + facets[f][c]];
        out->vertex_count += s->bodies[b].vertex_count;
    }
    for (int frame = 0; frame < 2; ++frame) {
        pose_scene(s, frame);
        out->at[frame] = all_positions(s, out->vertex_count, how);
    }
    desc.vertex_count = out->vertex_count;
    desc.faces = faces;
    desc.face_count = 4 * tets;
    desc.worker_count = how->workers;
    desc.cell_size = cell_size;
    result = vox_surface_create(&desc, &out->surface) == VOX_OK;
    free(faces);
    return result;
}

static int hash_pairs(vox_surface* surface, uint64_t* count, uint64_t* hash) {
    static const vox_feature kinds[6][2] = {
        {VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX}, {VOX_FEATURE_EDGE, VOX_FEATURE_VERTEX},
        {VOX_FEATURE_EDGE, VOX_FEATURE_EDGE},     {VOX_FEATURE_FACE, VOX_FEATURE_VERTEX},
        {VOX_FEATURE_EDGE, VOX_FEATURE_FACE},     {VOX_FEATURE_FACE, VOX_FEATURE_FACE}};
    for (int k = 0; k < 6; ++k) {
        vox_partner_lists lists;
        if (vox_surface_find_pairs(surface, kinds[k][0], kinds[k][1], 0, UINT64_MAX, &lists) != VOX_OK)
            return 0;
        *count += lists.offsets[lists.count];
        for (uint64_t i = 0; i <= lists.count; ++i) add_number(hash, lists.offsets[i]);
        for (uint64_t i = 0; i < lists.offsets[lists.count]; ++i) add_number(hash, lists.partners[i]);
    }
    return 1;
}

static int hash_crossings(vox_surface* surface, uint64_t* hash) {
    vox_crossing_view view;
    if (vox_surface_find_crossings(surface, &view) != VOX_OK) return 0;
    add_number(hash, view.count);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_crossing* c = &view.data[i];
        add_number(hash, c->edge), add_number(hash, c->face), add_number(hash, (uint64_t)c->kind);
        add_double(hash, c->edge_weights[0]), add_double(hash, c->edge_weights[1]);
        add_doubles(hash, c->face_weights), add_doubles(hash, c->position);
    }
    return 1;
}

static int hash_distances(vox_surface* surface, uint32_t vertices, double distance, uint64_t* hash) {
    double* clearance = (double*)malloc(sizeof(double) * vertices);
    int ok = vox_surface_find_clearances(surface, distance, clearance) == VOX_OK;
    for (uint32_t v = 0; ok && v < vertices; ++v) add_double(hash, clearance[v]);
    free(clearance);
    for (int k = 0; ok && k < 2; ++k) {
        vox_proximity_view view;
        ok = vox_surface_find_proximities(surface, k ? VOX_FEATURE_EDGE : VOX_FEATURE_FACE,
                                          k ? VOX_FEATURE_EDGE : VOX_FEATURE_VERTEX, distance,
                                          &view) == VOX_OK;
        if (!ok) break;
        add_number(hash, view.count);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_proximity* p = &view.data[i];
            add_number(hash, p->a), add_number(hash, p->b), add_double(hash, p->distance);
            add_doubles(hash, p->weights_a), add_doubles(hash, p->weights_b);
            add_doubles(hash, p->point_a), add_doubles(hash, p->point_b);
        }
    }
    return ok;
}

static int hash_times(vox_surface* surface, uint64_t* hash) {
    vox_safe_step step;
    vox_impact_view view;
    if (vox_surface_find_safe_step(surface, NULL, &step) != VOX_OK ||
        vox_surface_find_impacts(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, NULL, &view) != VOX_OK)
        return 0;
    add_double(hash, step.step), add_number(hash, step.pairs), add_number(hash, step.unfinished);
    add_number(hash, (uint64_t)step.kind_a), add_number(hash, step.a), add_number(hash, step.b);
    add_number(hash, view.count);
    for (uint64_t i = 0; i < view.count; ++i)
        add_number(hash, view.data[i].a), add_number(hash, view.data[i].b),
            add_double(hash, view.data[i].time);
    return 1;
}

/* The answers of the bodies' surface on its way from one frame to the next, with culling and without. */
static int run_surface(scene* s, const char* name, double factor, const settings* how) {
    soup_of_faces soup;
    uint64_t count = 0, parts[5] = {1, 2, 3, 4, 5};
    int ok;
    if (factor != 1) scale_scene(s, factor);
    ok = make_faces(s, how, how->cell_size * factor, &soup);
    for (int cull = 0; ok && cull < 2; ++cull) {
        vox_motion motion = vox_default_motion();
        motion.from.data = soup.at[0];
        motion.to.data = soup.at[1];
        motion.from.count = motion.to.count = soup.vertex_count;
        motion.from.format = motion.to.format = how->doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
        motion.flags = cull ? VOX_MOTION_CULL : 0;
        ok = vox_surface_move(soup.surface, &motion) == VOX_OK &&
             hash_pairs(soup.surface, &count, &parts[cull]);
    }
    ok = ok && hash_crossings(soup.surface, &parts[2]) &&
         hash_distances(soup.surface, soup.vertex_count, 0.1 * factor, &parts[3]) &&
         hash_times(soup.surface, &parts[4]);
    if (ok)
        printf("%s: %" PRIu64 " pairs %016" PRIx64 ", culled %016" PRIx64 ", crossings %016" PRIx64
               ", distances %016" PRIx64 ", times %016" PRIx64 "\n",
               name, count, parts[0], parts[1], parts[2], parts[3], parts[4]);
    else
        fprintf(stderr, "%s: %s\n", name, vox_last_error());
    vox_surface_destroy(soup.surface);
    free(soup.at[0]);
    free(soup.at[1]);
    free_scene(s);
    return ok;
}

/* Errors cross the border the same way everywhere. */
static int refuse(scene* s, const settings* how) {
    vox_grid* grid = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    vox_result result = VOX_OK;
    make_pair(s, 3);
    pose_scene(s, 0);
    s->bodies[1].positions[7] = (float)(1e300 * 1e300);
    use_engine(&desc, how->engine);
    const int ok = vox_grid_create(&desc, &grid) == VOX_OK && insert_scene(s, grid);
    if (ok) result = vox_grid_step(grid);
    printf("not finite: %s\n", vox_result_string(result));
    vox_grid_destroy(grid);
    free_scene(s);
    return ok;
}

static int usage(void) {
    fprintf(stderr,
            "usage: hashes [--engine fast|reference] [--workers N] [--doubles] [--moved] [--level 0..3] "
            "[--cell-size FACTOR]\n");
    return 2;
}

int main(int argc, char** argv) {
    static scene s;
    settings how = {ENGINE_FAST, 1, 0, 0, 0};
    int ok = 1;
    for (int i = 1; i < argc; ++i) {
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "--doubles") == 0) {
            how.doubles = 1;
        } else if (strcmp(argv[i], "--moved") == 0) {
            how.moved = 1;
        } else if (strcmp(argv[i], "--engine") == 0 &&
                   (strcmp(value, "fast") == 0 || strcmp(value, "reference") == 0)) {
            how.engine = value[0] == 'f' ? ENGINE_FAST : ENGINE_REFERENCE;
            ++i;
        } else if (strcmp(argv[i], "--workers") == 0 && atoi(value) > 0) {
            how.workers = (uint32_t)atoi(value);
            ++i;
        } else if (strcmp(argv[i], "--cell-size") == 0 && atof(value) > 0) {
            how.cell_size = atof(value);
            ++i;
        } else if (strcmp(argv[i], "--level") == 0 && value[0] >= '0' && value[0] <= '3') {
            fprintf(stderr, "%s\n", force_simd_level(value[0] - '0'));
            ++i;
        } else {
            return usage();
        }
    }
    make_pair(&s, 7), ok &= run(&s, "pair", 1, 0, 0, &how);
    make_self(&s, 7), ok &= run(&s, "self", 1, 0, 0, &how);
    make_ring(&s, 12), ok &= run(&s, "ring", 1, 0, 0, &how);
    make_ring(&s, 12), ok &= run(&s, "ring, filtered", 1, 2, 0, &how);
    make_many(&s, 3, 3), ok &= run(&s, "many", 1, 0, 0, &how);
    make_soup(&s, 80, 200), ok &= run(&s, "soup", 1, 0, 0, &how);
    make_pair(&s, 4),
        ok &= run(&s, "tiny", 1e-36, 0, 0, &how); /* areas and volumes are too small for a float */
    make_pair(&s, 4), ok &= run(&s, "least", 1e-41, 0, 0, &how); /* and so are normal coordinates */
    make_pair(&s, 4), ok &= run(&s, "huge", 1e30, 0, 0, &how);   /* or too large */
    make_ring(&s, 8), ok &= run(&s, "huge ring", 1e20, 0, 0, &how);
    make_pair(&s, 7), ok &= run(&s, "response to pair", 1, 0, 0.2, &how);
    make_ring(&s, 12), ok &= run(&s, "response to ring", 1, 0, 0.2, &how);
    make_ring(&s, 12), ok &= run(&s, "response to ring, filtered", 1, 2, 0.2, &how);
    make_soup(&s, 40, 60), ok &= run(&s, "response to soup", 1, 0, 0.2, &how);
    make_pair(&s, 4), ok &= run(&s, "response to least", 1e-41, 0, 0.2, &how);
    make_pair(&s, 4), ok &= run(&s, "response to huge", 1e30, 0, 0.2, &how);
    make_pair(&s, 3), ok &= run_surface(&s, "surface of pair", 1, &how);
    make_ring(&s, 8), ok &= run_surface(&s, "surface of ring", 1, &how);
    make_soup(&s, 40, 60), ok &= run_surface(&s, "surface of soup", 1, &how);
    make_pair(&s, 2), ok &= run_surface(&s, "surface of tiny", 1e-36, &how);
    make_pair(&s, 2), ok &= run_surface(&s, "surface of huge", 1e30, &how);
    ok &= refuse(&s, &how);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
