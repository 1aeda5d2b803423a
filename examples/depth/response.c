/* Response: what a solver makes of penetrations. One row for each, solved by XPBD (M. Macklin, M. Müller, N.
 * Chentanez, XPBD: Position-Based Simulation of Compliant Constrained Dynamics, 2016) with small steps:
 * several substeps use one detection. Two boxes collide in free space, then one falls onto a floor, a slab
 * that never moves. */
#include "example.h"

#include <math.h>

#define SUBSTEPS 20     /* of a frame of 1/60 s */
#define DETECT_EVERY 4  /* substeps that use the rows of one detection */
#define COMPLIANCE 1e-7 /* of a contact; the inverse of its stiffness */
#define SLOP 0.002      /* depth that is tolerated, so that a resting contact is found again */
#define PUSH_SPEED 1.0  /* at most, for depth from before a substep */

enum { vertices = 125, tets = 320, edges = 6 * tets, most_rows = 1000 };

typedef struct soft {
    body shape; /* its positions, as floats, are what the grid reads */
    vox_body mesh;
    double inverse_mass; /* of a vertex; 0 for a body that nothing moves */
    double x[vertices][3], before[vertices][3], v[vertices][3];
    uint32_t edge[edges][2];
    double length[edges];
} soft;

/* A penetration: a vertex of a, and the point at which it was in a tetrahedron of b. */
typedef struct row {
    soft *a, *b;
    uint32_t vertex, corner[4];
    double weight[4], direction[3], depth;
    double inverse_mass; /* against the motion of vertex and point apart */
} row;

static row rows[most_rows];
static uint32_t row_count;

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void add(double* to, double factor, const double* a) {
    for (int k = 0; k < 3; ++k) to[k] += factor * a[k];
}

/* ---- rows ---- */

/* The user data of a mesh is the number of its body in `bodies`. */
static void make_rows(vox_grid* grid, soft* bodies) {
    vox_contact_view contacts;
    vox_penetration_view found;
    must(vox_grid_get_contacts(grid, &contacts));
    must(vox_grid_penetrations(grid, &found));
    row_count = 0;
    for (uint64_t i = 0; i < found.count && row_count < most_rows; ++i) {
        const vox_penetration* p = &found.data[i];
        const vox_contact* in_tet = &contacts.data[p->contact]; /* which tetrahedron, and where in it */
        uint64_t a = 0, b = 0;
        must(vox_body_get_user_data(grid, p->body_a, &a));
        must(vox_body_get_user_data(grid, p->body_b, &b));
        row* r = &rows[row_count++];
        r->a = &bodies[a];
        r->b = &bodies[b];
        r->vertex = p->vertex;
        r->depth = p->depth;
        r->inverse_mass = r->a->inverse_mass;
        for (int k = 0; k < 3; ++k) r->direction[k] = p->direction[k];
        for (int k = 0; k < 4; ++k) {
            r->corner[k] = r->b->shape.tets[4 * in_tet->tet + (uint32_t)k];
            r->weight[k] = in_tet->barycentric[k];
            r->inverse_mass += r->weight[k] * r->weight[k] * r->b->inverse_mass;
        }
    }
}

/* The depth at other positions of the bodies, `x` or `before`. Vertex and point were at one place when the
 * row was made. What they have moved apart since, along the direction, is no longer depth: without this term
 * a solver would push again in every substep for the depth that it has already undone. */
static double depth_of(const row* r, double (*a)[3], double (*b)[3]) {
    double apart[3] = {a[r->vertex][0], a[r->vertex][1], a[r->vertex][2]};
    for (int k = 0; k < 4; ++k) add(apart, -r->weight[k], b[r->corner[k]]);
    return r->depth - dot(r->direction, apart);
}

/* Moves vertex and tetrahedron apart, each by the impulse over its mass. The weights have the sum 1, so
 * momentum is kept. */
static void push(const row* r, double impulse, double (*a)[3], double (*b)[3]) {
    add(a[r->vertex], impulse * r->a->inverse_mass, r->direction);
    for (int k = 0; k < 4; ++k)
        add(b[r->corner[k]], -impulse * r->weight[k] * r->b->inverse_mass, r->direction);
}

static void solve_row(const row* r, double h) {
    if (r->inverse_mass == 0) return;
    const double old = depth_of(r, r->a->before, r->b->before), now = depth_of(r, r->a->x, r->b->x);
    const double allowed = fmax(SLOP, old - PUSH_SPEED * h);
    const double rigid = (now - allowed) / r->inverse_mass;
    const double compliant = (now - SLOP) / (r->inverse_mass + COMPLIANCE / (h * h));
    const double impulse = fmin(rigid, compliant);
    if (!(impulse > 0)) return;
    /* The part that undoes depth from before this substep moves both positions, and so makes no velocity. */
    const double undo = fmin(fmax((old - allowed) / r->inverse_mass, 0), impulse);
    push(r, impulse, r->a->x, r->b->x);
    push(r, undo, r->a->before, r->b->before);
}

/* ---- bodies ---- */

static void place(soft* s, double x, double y, double z, double tilt, double speed) {
    s->shape = make_box(4, 0.25f, -0.5f, -0.5f, -0.5f);
    s->inverse_mass = vertices; /* a body of mass 1 */
    for (uint32_t i = 0; i < vertices; ++i) {
        const float* p = s->shape.positions + 3 * i;
        s->x[i][0] = x + cos(tilt) * p[0] - sin(tilt) * p[2];
        s->x[i][1] = y + p[1];
        s->x[i][2] = z + sin(tilt) * p[0] + cos(tilt) * p[2];
        s->v[i][0] = speed;
        s->v[i][1] = s->v[i][2] = 0;
    }
    for (uint32_t e = 0; e < edges; ++e) { /* those of several tetrahedra count for each */
        static const uint32_t ends[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
        double along[3] = {0, 0, 0};
        for (uint32_t k = 0; k < 2; ++k) {
            s->edge[e][k] = s->shape.tets[4 * (e / 6) + ends[e % 6][k]];
            add(along, k ? 1 : -1, s->x[s->edge[e][k]]);
        }
        s->length[e] = sqrt(dot(along, along));
    }
}

/* Edges keep their length, and lose some of the speed at which it changes. */
static void solve_edges(soft* s) {
    for (uint32_t e = 0; e < edges; ++e) {
        double *p = s->x[s->edge[e][0]], *q = s->x[s->edge[e][1]];
        double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        const double length = sqrt(dot(along, along)), move = 0.1 * (length - s->length[e]) / length;
        add(p, move, along);
        add(q, -move, along);
    }
}

static void damp_edges(soft* s) {
    for (uint32_t e = 0; e < edges; ++e) {
        const uint32_t i = s->edge[e][0], j = s->edge[e][1];
        double along[3] = {s->x[j][0] - s->x[i][0], s->x[j][1] - s->x[i][1], s->x[j][2] - s->x[i][2]};
        const double change = 0.02 * (dot(along, s->v[j]) - dot(along, s->v[i])) / dot(along, along);
        add(s->v[i], change, along);
        add(s->v[j], -change, along);
    }
}

static void insert(vox_grid* grid, soft* s, uint64_t index) {
    vox_mesh_desc desc = body_desc(&s->shape);
    desc.user_data = index;
    must(vox_mesh_insert(grid, &desc, &s->mesh));
}

/* A frame of 1/60 s; nothing moves bodies from `moving` on. */
static void frame(vox_grid* grid, soft* bodies, int moving, double gravity) {
    const double h = 1.0 / (60 * SUBSTEPS);
    for (int substep = 0; substep < SUBSTEPS; ++substep) {
        if (substep % DETECT_EVERY == 0) {
            for (int b = 0; b < moving; ++b)
                for (uint32_t i = 0; i < 3 * vertices; ++i)
                    bodies[b].shape.positions[i] = (float)bodies[b].x[i / 3][i % 3];
            must(vox_grid_step(grid));
            make_rows(grid, bodies);
        }
        for (int b = 0; b < moving; ++b)
            for (uint32_t i = 0; i < vertices; ++i) {
                memcpy(bodies[b].before[i], bodies[b].x[i], sizeof bodies[b].x[i]);
                bodies[b].v[i][2] -= gravity * h;
                add(bodies[b].x[i], h, bodies[b].v[i]);
            }
        for (int b = 0; b < moving; ++b) solve_edges(&bodies[b]);
        for (uint32_t r = 0; r < row_count; ++r) solve_row(&rows[r], h);
        for (int b = 0; b < moving; ++b) {
            for (uint32_t i = 0; i < vertices; ++i)
                for (int k = 0; k < 3; ++k)
                    bodies[b].v[i][k] = (bodies[b].x[i][k] - bodies[b].before[i][k]) / h;
            damp_edges(&bodies[b]);
        }
    }
}

static double mean(double (*of)[3], int axis) {
    double sum = 0;
    for (uint32_t i = 0; i < vertices; ++i) sum += of[i][axis];
    return sum / vertices;
}

/* ---- scenes ---- */

static soft bodies[2];

static void collide_in_free_space(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    place(&bodies[0], 0, 0, 0, 0, 2);
    place(&bodies[1], 1.2, 0.2, 0.1, 0.3, -1);
    for (int b = 0; b < 2; ++b) insert(grid, &bodies[b], (uint64_t)b);
    uint32_t most = 0;
    for (int f = 0; f < 60; ++f) {
        frame(grid, bodies, 2, 0);
        if (row_count > most) most = row_count;
    }
    const double a = mean(bodies[0].v, 0), b = mean(bodies[1].v, 0);
    printf("collision: up to %u rows, speeds 2 and -1 became %.2f and %.2f\n", (unsigned)most, a, b);
    printf("momentum %s\n", fabs(a + b - 1) < 1e-6 && most > 0 && a < b ? "is conserved" : "IS LOST");
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_body(&bodies[i].shape);
}

static void fall_on_a_floor(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    place(&bodies[0], 0, 0, 1, 0.2, 0);
    insert(grid, &bodies[0], 0);
    /* Five tetrahedra, 40 by 40 and 2 thick; bodies must not fall through it within one detection. */
    soft* slab = &bodies[1];
    memset(slab, 0, sizeof *slab);
    slab->shape = make_block(&five_cut, 1, 1, 1);
    for (uint32_t i = 0; i < slab->shape.vertex_count; ++i)
        for (int k = 0; k < 3; ++k) {
            float* p = &slab->shape.positions[3 * i + (uint32_t)k];
            *p = k == 2 ? 2 * *p - 2 : 40 * *p - 20;
            slab->x[i][k] = slab->before[i][k] = *p;
        }
    insert(grid, slab, 1);
    const double energy = 9.81 * mean(bodies[0].x, 2);
    double highest = 0, fastest = 0;
    for (int f = 0; f < 360; ++f) {
        frame(grid, bodies, 1, 9.81);
        double now = 9.81 * mean(bodies[0].x, 2);
        fastest = 0;
        for (uint32_t i = 0; i < vertices; ++i) {
            const double square = dot(bodies[0].v[i], bodies[0].v[i]);
            now += square / (2 * vertices);
            fastest = fmax(fastest, sqrt(square));
        }
        highest = fmax(highest, now);
    }
    printf("floor: %u rows, centre at %.3f, fastest vertex %.4f m/s, energy at most %.3f of the first\n",
           (unsigned)row_count, mean(bodies[0].x, 2), fastest, highest / energy);
    printf("the box %s\n",
           fastest < 0.02 && highest < 1.001 * energy && row_count > 0 ? "is at rest" : "DOES NOT REST");
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_body(&bodies[i].shape);
}

int main(void) {
    collide_in_free_space();
    fall_on_a_floor();
    return 0;
}
