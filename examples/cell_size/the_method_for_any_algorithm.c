/* The method for any algorithm: the best cell size for a cost function of one's own, here a neighbour search
 * among particles: visiting a cell costs 1, and so does looking at five particles. */
#include "example.h"

#include <vox/vox_cell_size.h>

/* Of a search within radius 1 among 64 particles a unit of volume, with cells of edge `cell_size`. */
static double cost(double cell_size, void* user) {
    const double per_particle = *(const double*)user;
    const double cells = (2 / cell_size + 1) * (2 / cell_size + 1) * (2 / cell_size + 1);
    const double volume = (2 + cell_size) * (2 + cell_size) * (2 + cell_size);
    return cells + per_particle * 64 * volume;
}

int main(void) {
    double per_particle = 0.2;
    vox_cell_size_result best;
    best.struct_size = sizeof best;
    must(vox_cost_minimise(cost, &per_particle, 0.01, 10, 0, &best));
    printf("cell size %.2f, good from %.2f to %.2f; cost %.1f, with the radius as the cell size %.1f\n",
           best.cell_size, best.zone_min, best.zone_max, best.cost, cost(1, &per_particle));
    return 0;
}
