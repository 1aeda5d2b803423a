/* XPBD: blocks fall onto a floor and onto each other, and come to rest (M. Macklin, M. Müller, N. Chentanez,
 * XPBD: Position-Based Simulation of Compliant Constrained Dynamics, 2016). One loop treats vertices inside
 * bodies, crossing edges and vertices within the margin alike. The constraints of one detection serve several
 * substeps, since their gap is computed again. */
#include "example.h"

#include <math.h>

#define H (1.0 / 1200) /* seconds of a substep */
#define DETECT_EVERY 4 /* substeps */
#define MARGIN 0.02    /* more than bodies approach between detections: no contact is deep when it is found */
#define COMPLIANCE 1e-7 /* of a contact: its inverse stiffness */
#define FRICTION 0.5
#define GRAVITY 9.81

enum { bodies = 2, cubes = 3, vertices = (cubes + 1) * (cubes + 1) * (cubes + 1) };

typedef struct soft {
    body shape;
    double inverse_mass;                                        /* of a vertex */
    double x[vertices][3], before[vertices][3], v[vertices][3]; /* before: at the beginning of the substep */
    double length[6 * 5 * cubes * cubes * cubes]; /* at rest, of six edges for each tetrahedron */
} soft;

static soft all[bodies];

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void add(double* to, double factor, const double* a) {
    for (int k = 0; k < 3; ++k) to[k] += factor * a[k];
}

/* ---- contacts ---- */

/* The user data of a body is its index. */
static soft* body_of(const vox_constraint* c, uint32_t i) {
    return &all[i < c->count_a ? c->user_data_a : c->user_data_b];
}

/* Moves the vertices by `impulse` over their masses, by their weights. Those of two bodies add up to 0, so
 * momentum is kept. */
static void push(const vox_constraint* c, double impulse, const double direction[3]) {
    for (uint32_t i = 0; i < c->count; ++i) {
        soft* s = body_of(c, i);
        add(s->x[c->vertices[i]], impulse * c->weights[i] * s->inverse_mass, direction);
    }
}

/* Undoes how far the two points have slid along each other in the substep, by Coulomb's law. */
static void rub(const vox_constraint* c, double inverse_mass, double normal_impulse) {
    double slip[3] = {0, 0, 0};
    for (uint32_t i = 0; i < c->count; ++i) {
        const soft* s = body_of(c, i);
        add(slip, c->weights[i], s->x[c->vertices[i]]);
        add(slip, -c->weights[i], s->before[c->vertices[i]]);
    }
    add(slip, -dot(slip, c->normal), c->normal);
    const double length = sqrt(dot(slip, slip));
    if (length > 0) push(c, -fmin(1 / inverse_mass, FRICTION * normal_impulse / length), slip);
}

static void solve_contacts(const vox_constraint_view* found) {
    for (uint64_t n = 0; n < found->count; ++n) {
        const vox_constraint* c = &found->data[n];
        const double gap = vox_constraint_gap(c, all[c->user_data_a].x[0], all[c->user_data_b].x[0]);
        if (gap >= 0) continue;
        double inverse_mass = 0; /* of the two points against each other */
        for (uint32_t i = 0; i < c->count; ++i)
            inverse_mass += c->weights[i] * c->weights[i] * body_of(c, i)->inverse_mass;
        const double impulse = -gap / (inverse_mass + COMPLIANCE / (H * H));
        push(c, impulse, c->normal);
        rub(c, inverse_mass, impulse);
    }
}

/* ---- bodies ---- */

static void ends_of(const soft* s, uint32_t edge, uint32_t ends[2]) {
    static const uint32_t corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (int k = 0; k < 2; ++k) ends[k] = s->shape.tets[4 * (edge / 6) + corners[edge % 6][k]];
}

/* A block of edge length 1 around (x, y, z), turned about the axes z and y. */
static void place_block(soft* s, double x, double y, double z, double turn, double tilt) {
    s->shape = make_box(cubes, 1.0f / cubes, -0.5f, -0.5f, -0.5f);
    s->inverse_mass = vertices; /* a body of mass 1 */
    for (uint32_t i = 0; i < vertices; ++i) {
        const float* p = s->shape.positions + 3 * i;
        const double along = cos(turn) * p[0] - sin(turn) * p[1];
        s->x[i][0] = x + cos(tilt) * along + sin(tilt) * p[2];
        s->x[i][1] = y + sin(turn) * p[0] + cos(turn) * p[1];
        s->x[i][2] = z + cos(tilt) * p[2] - sin(tilt) * along;
    }
    for (uint32_t e = 0; e < 6 * s->shape.tet_count; ++e) {
        uint32_t ends[2];
        ends_of(s, e, ends);
        double along[3] = {0, 0, 0};
        add(along, 1, s->x[ends[1]]);
        add(along, -1, s->x[ends[0]]);
        s->length[e] = sqrt(dot(along, along));
    }
}

/* Edges keep their length, and lose some of the speed at which it changes. */
static void solve_edges(soft* s) {
    for (uint32_t e = 0; e < 6 * s->shape.tet_count; ++e) {
        uint32_t ends[2];
        ends_of(s, e, ends);
        double *p = s->x[ends[0]], *q = s->x[ends[1]];
        const double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        const double length = sqrt(dot(along, along)), move = 0.1 * (length - s->length[e]) / length;
        add(p, move, along);
        add(q, -move, along);
    }
}

static void damp_edges(soft* s) {
    for (uint32_t e = 0; e < 6 * s->shape.tet_count; ++e) {
        uint32_t ends[2];
        ends_of(s, e, ends);
        const double *p = s->x[ends[0]], *q = s->x[ends[1]];
        double *u = s->v[ends[0]], *v = s->v[ends[1]];
        const double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        const double change = 0.1 * (dot(along, v) - dot(along, u)) / dot(along, along);
        add(u, change, along);
        add(v, -change, along);
    }
}

static void substep(const vox_constraint_view* found) {
    static const double down[3] = {0, 0, -1};
    for (int b = 0; b < bodies; ++b)
        for (uint32_t i = 0; i < vertices; ++i) {
            memcpy(all[b].before[i], all[b].x[i], sizeof all[b].x[i]);
            add(all[b].v[i], GRAVITY * H, down);
            add(all[b].x[i], H, all[b].v[i]);
        }
    for (int b = 0; b < bodies; ++b) solve_edges(&all[b]);
    solve_contacts(found);
    for (int b = 0; b < bodies; ++b) {
        for (uint32_t i = 0; i < vertices; ++i)
            for (int k = 0; k < 3; ++k) all[b].v[i][k] = (all[b].x[i][k] - all[b].before[i][k]) / H;
        damp_edges(&all[b]);
    }
}

/* ---- measurements ---- */

static double mean_height(const soft* s) {
    double sum = 0;
    for (uint32_t i = 0; i < vertices; ++i) sum += s->x[i][2] / vertices;
    return sum;
}

static double kinetic_energy(void) {
    double sum = 0;
    for (int b = 0; b < bodies; ++b)
        for (uint32_t i = 0; i < vertices; ++i) sum += dot(all[b].v[i], all[b].v[i]) / (2 * vertices);
    return sum;
}

static double total_energy(void) {
    double sum = kinetic_energy();
    for (int b = 0; b < bodies; ++b) sum += GRAVITY * mean_height(&all[b]);
    return sum;
}

int main(void) {
    static const char* const kinds[] = {"inside", "edge", "proximity", "impact"};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    desc.margin = MARGIN;
    vox_grid* grid = NULL;
    vox_constraint_view found;
    must(vox_grid_create(&desc, &grid));
    place_block(&all[0], 0, 0, 0.7, 0, 0.1);
    place_block(&all[1], 0.1, 0.1, 2, 0.8, 0);
    vox_shape_desc floor = vox_default_shape_desc(); /* its constraints have vertices of body_a alone */
    floor.kind = VOX_SHAPE_HALF_SPACE;
    vox_body floor_id = VOX_NULL_BODY;
    must(vox_shape_insert(grid, &floor, &floor_id));
    for (uint32_t b = 0; b < bodies; ++b) {
        const body* shape = &all[b].shape;
        vox_mesh_desc mesh =
            vox_mesh_desc_doubles(all[b].x[0], shape->vertex_count, shape->tets, shape->tet_count);
        mesh.user_data = b;
        vox_body id = VOX_NULL_BODY;
        must(vox_mesh_insert(grid, &mesh, &id));
    }
    const double first = total_energy();
    double highest = 0;
    for (int step = 0; step < 3600; ++step) {
        if (step % DETECT_EVERY == 0) {
            must(vox_grid_step(grid)); /* it reads x, which the grid borrows */
            must(vox_grid_get_constraints(grid, &found));
        }
        substep(&found);
        highest = fmax(highest, total_energy());
    }
    uint64_t count[4] = {0, 0, 0, 0};
    for (uint64_t n = 0; n < found.count; ++n) ++count[found.data[n].kind];
    printf("constraints at the end:");
    for (int kind = 0; kind < 4; ++kind)
        if (count[kind] > 0) printf(" %s", kinds[kind]);
    printf("\nheights of the blocks: %.2f %.2f\n", mean_height(&all[0]), mean_height(&all[1]));
    printf("energy %s, the blocks %s\n", highest < 1.001 * first ? "never rose" : "ROSE",
           kinetic_energy() < 0.002 ? "are at rest" : "DO NOT REST");
    vox_grid_destroy(grid);
    for (int b = 0; b < bodies; ++b) free_body(&all[b].shape);
    return 0;
}
