/* Penalty FEM: two elastic blocks collide, by explicit finite elements with penalty forces for contact.
 * Weights, normals and gaps are doubles, and all kinds of constraints are treated alike. The products
 * weights[i] * normal that share a force among the nodes are also the row of a constraint in the matrix of an
 * implicit method. */
#include "example.h"

#include <math.h>

#define H 5e-4          /* seconds of a time step */
#define STIFFNESS 500.0 /* of a contact */
#define DAMPING 0.2     /* of a contact, along its normal */
#define SHEAR 80.0      /* Lamé's constants of a material without damping */
#define DILATION 80.0

enum {
    cubes = 3,
    nodes_each = (cubes + 1) * (cubes + 1) * (cubes + 1),
    nodes = 2 * nodes_each,
    most_elements = 1000
};

/* A tetrahedron with linear shape functions. */
typedef struct element {
    uint32_t node[4];
    double volume, gradient[4][3]; /* at rest, of the shape functions */
} element;

static element elements[most_elements];
static uint32_t element_count;
static double x[nodes][3], v[nodes][3], force[nodes][3], mass[nodes];
static uint64_t first_node[2]; /* of each body, by slot */

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void add(double* to, double factor, const double* a) {
    for (int k = 0; k < 3; ++k) to[k] += factor * a[k];
}

/* ---- contacts ---- */

/* The global number of vertex i of a constraint. */
static uint64_t node_of(const vox_constraint* c, uint32_t i) {
    return first_node[vox_body_slot(i < c->count_a ? c->body_a : c->body_b)] + c->vertices[i];
}

static void add_contact_forces(const vox_constraint_view* found) {
    for (uint64_t n = 0; n < found->count; ++n) {
        const vox_constraint* c = &found->data[n];
        double rate = 0; /* of the gap */
        for (uint32_t i = 0; i < c->count; ++i) rate += c->weights[i] * dot(c->normal, v[node_of(c, i)]);
        const double push = -STIFFNESS * c->gap - DAMPING * rate;
        if (c->gap >= 0 || push <= 0) continue;
        for (uint32_t i = 0; i < c->count; ++i) add(force[node_of(c, i)], push * c->weights[i], c->normal);
    }
}

/* ---- elements ---- */

static void cross(const double* a, const double* b, double* out) {
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void make_element(element* e) {
    double edge[4][3] = {{0}};
    for (int i = 1; i < 4; ++i)
        for (int k = 0; k < 3; ++k) edge[i][k] = x[e->node[i]][k] - x[e->node[0]][k];
    for (int k = 0; k < 3; ++k) e->gradient[0][k] = 0;
    for (int i = 1; i < 4; ++i) {
        double area[3];
        cross(edge[i % 3 + 1], edge[(i + 1) % 3 + 1], area);
        const double determinant = dot(area, edge[i]);
        e->volume = determinant / 6;
        for (int k = 0; k < 3; ++k) e->gradient[i][k] = area[k] / determinant;
        add(e->gradient[0], -1, e->gradient[i]);
    }
    for (int i = 0; i < 4; ++i) mass[e->node[i]] += e->volume / 4; /* a body of mass 1 */
}

/* St. Venant and Kirchhoff's material. Returns its energy. */
static double add_elastic_forces(const element* e) {
    double deformation[3][3] = {{0}}, strain[3][3], energy = 0, trace = 0;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) add(deformation[k], x[e->node[i]][k], e->gradient[i]);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            strain[r][c] = r == c ? -0.5 : 0;
            for (int k = 0; k < 3; ++k) strain[r][c] += deformation[k][r] * deformation[k][c] / 2;
        }
    for (int k = 0; k < 3; ++k) {
        trace += strain[k][k];
        energy += SHEAR * dot(strain[k], strain[k]);
    }
    for (int i = 0; i < 4; ++i) {
        double along[3];
        for (int k = 0; k < 3; ++k)
            along[k] = 2 * SHEAR * dot(strain[k], e->gradient[i]) + DILATION * trace * e->gradient[i][k];
        for (int k = 0; k < 3; ++k) force[e->node[i]][k] -= e->volume * dot(deformation[k], along);
    }
    return e->volume * (energy + DILATION / 2 * trace * trace);
}

/* ---- bodies ---- */

/* A cube of edge length 1 around (px, py, pz), turned about z, that moves along x. */
static void insert(vox_grid* grid, uint64_t first, double px, double py, double pz, double turn,
                   double speed) {
    body shape = make_box(cubes, 1.0f / cubes, -0.5f, -0.5f, -0.5f);
    for (uint32_t i = 0; i < shape.vertex_count; ++i) {
        const float* p = shape.positions + 3 * i;
        double* at = x[first + i];
        at[0] = px + cos(turn) * p[0] - sin(turn) * p[1];
        at[1] = py + sin(turn) * p[0] + cos(turn) * p[1];
        at[2] = pz + p[2];
        v[first + i][0] = speed;
    }
    for (uint32_t t = 0; t < shape.tet_count; ++t) {
        element* e = &elements[element_count++];
        for (int i = 0; i < 4; ++i) e->node[i] = (uint32_t)first + shape.tets[4 * t + (uint32_t)i];
        make_element(e);
    }
    const vox_mesh_desc desc =
        vox_mesh_desc_doubles(x[first], shape.vertex_count, shape.tets, shape.tet_count);
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    first_node[vox_body_slot(id)] = first;
    free_body(&shape);
}

/* Of both bodies; angular momentum around the origin. */
static void measure(double momentum[3], double spin[3]) {
    for (uint32_t i = 0; i < nodes; ++i) {
        double turning[3];
        cross(x[i], v[i], turning);
        add(momentum, mass[i], v[i]);
        add(spin, mass[i], turning);
    }
}

int main(void) {
    vox_grid_desc grid_desc = vox_default_grid_desc();
    grid_desc.flags = VOX_GRID_EDGES;
    vox_grid* grid = NULL;
    must(vox_grid_create(&grid_desc, &grid));
    insert(grid, 0, -0.6, 0, 0, 0.2, 1);
    insert(grid, nodes_each, 0.7, 0.3, 0.1, 0.6, -1);
    double before[2][3] = {{0}}, after[2][3] = {{0}}, speed[2] = {0, 0}, energy = 0;
    measure(before[0], before[1]);
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST; /* the force acts on the face that is next to the vertex */
    for (int step = 0; step < 2000; ++step) {
        vox_constraint_view found;
        must(vox_grid_step(grid)); /* it reads x, which the grid borrows */
        must(vox_grid_find_constraints(grid, &desc));
        must(vox_grid_get_constraints(grid, &found));
        memset(force, 0, sizeof force);
        add_contact_forces(&found);
        energy = 0;
        for (uint32_t e = 0; e < element_count; ++e) energy += add_elastic_forces(&elements[e]);
        for (uint32_t i = 0; i < nodes; ++i) {
            add(v[i], H / mass[i], force[i]);
            add(x[i], H, v[i]);
        }
    }
    for (uint32_t i = 0; i < nodes; ++i) {
        energy += mass[i] * dot(v[i], v[i]) / 2;
        speed[i / nodes_each] += mass[i] * v[i][0];
    }
    measure(after[0], after[1]);
    for (int i = 0; i < 2; ++i) add(after[i], -1, before[i]);
    printf("speeds 1 and -1 became %.1f and %.1f, energy 1 became %.2f\n", speed[0], speed[1], energy);
    printf("momentum %s, angular momentum %s\n", dot(after[0], after[0]) < 1e-20 ? "is kept" : "IS LOST",
           dot(after[1], after[1]) < 1e-20 ? "too" : "IS LOST");
    vox_grid_destroy(grid);
    return 0;
}
