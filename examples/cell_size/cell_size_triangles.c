/* The method for an algorithm that is not this library's: collision of triangle meshes on a voxel grid, after
 * D. Borro, A. Garcia-Alonso, L. Matey, "Approximation of Optimal Voxel Size for Collision Detection in
 * Maintainability Simulations within Massive Virtual Environments", Computer Graphics Forum 23(1), 2004.
 *
 * A static world of triangles is entered into all voxels that they cross. In every frame each of the n
 * triangles of a moving object looks into the voxels of its box and is tested against the triangles that it
 * finds there:
 *
 *     voxels of a moving triangle with a box of side s    v(d) = (s/d + 1)^3
 *     static triangles in one voxel                       t(d) = p d^2 / A_t * (1 + s/d)^2
 *     cost                                                n v(d) (visit + test t(d))
 *
 * A voxel of the surface holds a patch of about d^2, and a triangle of area A_t and box side s is in all
 * voxels that it crosses; p is the part of the voxels near the object that hold any surface. Multiplied out,
 * the cost is a table of powers of d, and needs no code at all. */
#include "example.h"

#include <math.h>
#include <vox/vox_cell_size.h>

/* Nanoseconds of a frame: visits of the voxels around each triangle, and tests against the points in them. */
static double cost(double d, void* user) {
    const double side = 0.02, area = 0.00017; /* of a triangle: metres, square metres */
    const double occupied = 0.3;              /* part of the voxels there that hold surface */
    const double visit = 12, test = 90;       /* nanoseconds, measured */
    const double triangles = 20000;           /* of the moving object */
    (void)user;
    return triangles * pow(side / d + 1, 3) * (visit + test * occupied / area * pow(side / d + 1, 2) * d * d);
}

int main(void) {
    vox_cell_size_result best;
    best.struct_size = sizeof best;
    must(vox_cost_minimise(cost, NULL, 0.001, 0.4, 0, &best));
    const vox_cost_sample* largest = &best.curve[best.curve_count - 1];
    printf("voxels of %.1f mm, good from %.1f to %.1f mm: %.1f ms a frame; with %.0f mm %.0f times that\n",
           1e3 * best.cell_size, 1e3 * best.zone_min, 1e3 * best.zone_max, 1e-6 * best.cost,
           1e3 * largest->cell_size, largest->cost / best.cost);
    return 0;
}
