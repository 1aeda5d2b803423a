/* The method for an algorithm that is not this library's: the density of a fluid at every particle, from all
 * neighbours within a radius (M. Mueller, D. Charypar, M. Gross, "Particle-Based Fluid Simulation for
 * Interactive Applications", SCA 2003).
 *
 * Particles are sorted into cells, x fastest; each one then looks through the rows of cells that meet the
 * cube around it. For cells of edge d, radius h and rho particles a unit of volume, the average for each
 * particle is
 *
 *     rows       (2h/d + 1)^2       a row of cells along x is one range of particles
 *     particles  rho (2h + d)^3     in these rows
 *     surprises  (2h/d + 2) m       loops over rows whose end the processor guesses wrong
 *
 * A loop takes floor(2h/d) + 1 rows, or one more with a chance of f = 2h/d - floor(2h/d); m is the lesser of
 * f and 1 - f.
 *
 * The last term was added when a clock said that cells of exactly the radius do better than the first two
 * allow. What each costs is fitted to the times at a few cell sizes; the least cost is found by
 * vox_cost_minimise, and checked with counters and a clock. */
#include "example.h"

#include <vox/vox_cell_size.h>

#include <time.h>

enum { side = 24, count = side * side * side, most_cells = 400000 };
static const double radius = 2.0; /* about 33 neighbours each, as in smoothed particle hydrodynamics */

static float position[count][3], sorted[count][3], density[count];
static uint32_t begin[most_cells + 2];

typedef struct work {
    double rows, particles, neighbours;
} work;

/* About one particle a unit of volume: a lattice, stirred. */
static void fill(void) {
    uint32_t state = 1;
    for (int i = 0; i < count; ++i) {
        const int place[3] = {i % side, i / side % side, i / side / side};
        for (int axis = 0; axis < 3; ++axis)
            position[i][axis] = (float)place[axis] + (float)(random_quick(&state) >> 8) / (float)(1 << 24);
    }
}

static int cell_of(double x, double d, int n) {
    const int cell = (int)(x > 0 ? x / d : 0);
    return cell < n ? cell : n - 1;
}

static work find_neighbours(double d) {
    const int n = (int)(side / d) + 1;
    work done = {0, 0, 0};
    for (int c = 0; c <= n * n * n; ++c) begin[c] = 0;
    for (int pass = 0; pass < 2; ++pass) { /* a counting sort: how many, then where to */
        for (int i = 0; i < count; ++i) {
            int c = 0;
            for (int axis = 2; axis >= 0; --axis) c = c * n + cell_of(position[i][axis], d, n);
            if (pass == 0) {
                ++begin[c + 1];
                continue;
            }
            const uint32_t to = begin[c]++;
            for (int axis = 0; axis < 3; ++axis) sorted[to][axis] = position[i][axis];
        }
        if (pass == 0)
            for (int c = 0; c < n * n * n; ++c) begin[c + 1] += begin[c];
    }
    /* begin[c] is now where c ends, so where c + 1 begins. */
    uint64_t rows = 0, particles = 0, neighbours = 0;
    const float limit = (float)(radius * radius);
    for (int i = 0; i < count; ++i) {
        const float* p = sorted[i];
        float sum = 0;
        int low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = cell_of(p[axis] - radius, d, n);
            high[axis] = cell_of(p[axis] + radius, d, n);
        }
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y) {
                const int row = (z * n + y) * n, first = row + low[0];
                const uint32_t from = first > 0 ? begin[first - 1] : 0, to = begin[row + high[0]];
                ++rows;
                particles += to - from;
                for (uint32_t j = from; j < to; ++j) {
                    const float x = sorted[j][0] - p[0], y2 = sorted[j][1] - p[1], z2 = sorted[j][2] - p[2];
                    const float left = limit - (x * x + y2 * y2 + z2 * z2);
                    neighbours += left > 0;
                    sum += left > 0 ? left * left * left : 0;
                }
            }
        density[i] = sum;
    }
    done.rows = (double)rows;
    done.particles = (double)particles;
    done.neighbours = (double)(neighbours - count); /* not itself */
    return done;
}

/* Along an axis, the mean over all places in the world of what [x - radius, x + radius] covers, cut at the
 * ends, of cells of edge d, and of length. */
static double cells_along(double d) { return (2 * radius - radius * radius / side) / d + 1; }
static double length_along(double d) {
    /* Each end reaches d/2 beyond on average, but not beyond the world. */
    const double reach = radius + d / 2 < side ? radius + d / 2 : side;
    return 2 * reach - reach * reach / side;
}

enum { terms = 3 };

static void counts_of(double d, double counts[terms]) {
    const double cells = cells_along(d), length = length_along(d),
                 part = 2 * radius / d - (int)(2 * radius / d);
    counts[0] = count * cells * cells;
    counts[1] = count * length * length * length;
    counts[2] = count * (cells + 1) * (part < 0.5 ? part : 1 - part);
}

/* `user` are the weights, nanoseconds. */
static double cost(double d, void* user) {
    const double* weight = (const double*)user;
    double counts[terms], sum = 0;
    counts_of(d, counts);
    for (int i = 0; i < terms; ++i) sum += weight[i] * counts[i];
    return sum;
}

/* Nanoseconds: the shortest of some, since what disturbs only adds. */
static double measure(double d, work* done) {
    double best = 0;
    for (int i = 0; i < 5; ++i) {
        const clock_t start = clock();
        *done = find_neighbours(d);
        const double time = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC;
        if (i == 0 || time < best) best = time;
    }
    return best;
}

/* Weights that are not negative, of the least squares of the parts that are missed, one after the other until
 * nothing changes any more. */
static void fit(const double sizes[], const double times[], int n, double weight[terms]) {
    for (int i = 0; i < terms; ++i) weight[i] = 1;
    for (int round = 0; round < 2000; ++round)
        for (int i = 0; i < terms; ++i) {
            double product = 0, square = 0;
            for (int k = 0; k < n; ++k) {
                double counts[terms];
                counts_of(sizes[k], counts);
                const double part = counts[i] / times[k];
                product += part * (1 - cost(sizes[k], weight) / times[k] + weight[i] * part);
                square += part * part;
            }
            weight[i] = product > 0 ? product / square : 0;
        }
}

static int near(double predicted, double counted) {
    return predicted < 1.1 * counted && predicted > 0.9 * counted;
}

int main(void) {
    fill();
    const double parts[] = {0.4, 0.55, 0.7, 1, 1.3, 2}; /* of the radius */
    enum { measured = sizeof parts / sizeof parts[0] };
    double sizes[measured], times[measured], weight[terms];
    work done;
    for (int i = 0; i < measured; ++i) times[i] = measure(sizes[i] = parts[i] * radius, &done);
    fit(sizes, times, measured, weight);

    vox_cell_size_result best;
    best.struct_size = sizeof best;
    must(vox_cost_minimise(cost, weight, radius / 6, 4 * radius, 0, &best));
    printf("a row %.1f ns, a particle %.2f ns, a surprise %.1f ns: cells of %.2f radii, good from %.2f to "
           "%.2f\n",
           weight[0], weight[1], weight[2], best.cell_size / radius, best.zone_min / radius,
           best.zone_max / radius);

    work chosen;
    const double time = measure(best.cell_size, &chosen);
    double least = time, least_size = best.cell_size;
    for (int i = 0; i < 16; ++i) {
        const double d = radius / 5 * (1 + 0.4 * i), t = measure(d, &done);
        double counts[terms];
        counts_of(d, counts);
        if (t < least) {
            least = t;
            least_size = d;
        }
        if (done.neighbours != chosen.neighbours || !near(counts[0], done.rows) ||
            !near(counts[1], done.particles)) {
            printf("at %.3f: %.0f rows, %.0f predicted, %.0f particles, %.0f predicted\n", d, done.rows,
                   counts[0], done.particles, counts[1]);
            return 1;
        }
    }
    printf("%.1f neighbours each at every cell size, rows and particles within 10 %% of the prediction\n",
           chosen.neighbours / count);
    printf("chosen %.2f ms, best of 16 sizes %.2f ms at %.2f radii\n", 1e-6 * time, 1e-6 * least,
           least_size / radius);
    return 0;
}
