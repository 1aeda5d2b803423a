/* Bodies of many sizes, dealt out by number, are dealt out again by what a step over each of them costs:
 * Zoltan's recursive bisection, with vox_dist_scene_get_costs as weights. The hash of all contacts stays. Of
 * a build with -DVOX_MPI=ON that is installed, with Debian's libtrilinos-zoltan-dev:
 *
 *     mpicc partition_by_weights.c -I/usr/include/trilinos $(pkg-config --cflags --libs vox_mpi) \
 *         -ltrilinos_zoltan -o partition && mpirun -n 4 ./partition
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <vox/vox_mpi.h>
#include <zoltan.h>

enum { BODIES = 96, MOST = 9 }; /* a body is a block of 2 to MOST cubes along each side */

typedef struct body {
    double* positions;
    int here; /* 1: on this rank */
    float weight;
} body;

static body bodies[BODIES];
static vox_dist_scene* scene;
static int rank, size;

static void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    MPI_Abort(MPI_COMM_WORLD, 1);
}

static void check_zoltan(int result) {
    if (result == ZOLTAN_OK) return;
    fprintf(stderr, "Zoltan fails with %d\n", result);
    MPI_Abort(MPI_COMM_WORLD, 1);
}

static void* memory(size_t bytes) {
    void* made = malloc(bytes);
    if (!made) MPI_Abort(MPI_COMM_WORLD, 1);
    return made;
}

/* The large ones come first, and lie together. */
static uint32_t side_of(int b) { return MOST - (uint32_t)b * (MOST - 1) / BODIES; }

static void place_of(int b, double* place) {
    place[0] = 4.5 * (b % 6);
    place[1] = 4.5 * (b / 6 % 4);
    place[2] = 4.5 * (b / 24);
}

/* Any rank can make any body; a simulation would send its state. */
static void insert(int b) {
    static const int paths[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    const uint32_t n = side_of(b), stride[3] = {1, n + 1, (n + 1) * (n + 1)}, vertices = (n + 1) * stride[2];
    double* p = bodies[b].positions = (double*)memory(3 * vertices * sizeof *p);
    uint32_t* tets = (uint32_t*)memory(24 * n * n * n * sizeof *tets);
    double place[3];
    place_of(b, place);
    for (uint32_t v = 0; v < vertices; ++v)
        for (int axis = 0; axis < 3; ++axis)
            p[3 * v + (uint32_t)axis] = place[axis] + 5.0 / n * (v / stride[axis] % (n + 1));
    uint32_t* corner = tets;
    for (uint32_t v = 0; v < vertices; ++v) {
        if (v % (n + 1) == n || v / stride[1] % (n + 1) == n || v / stride[2] == n) continue;
        for (int path = 0; path < 6; ++path) { /* from the lowest corner of a cube to the highest one */
            *corner++ = v;
            *corner++ = v + stride[paths[path][0]];
            *corner++ = v + stride[paths[path][0]] + stride[paths[path][1]];
            *corner++ = v + stride[0] + stride[1] + stride[2];
        }
    }
    const vox_mesh_desc mesh = vox_mesh_desc_doubles(p, vertices, tets, 6 * n * n * n);
    vox_dist_part_desc desc = vox_default_dist_part_desc();
    desc.body = (uint64_t)b;
    desc.mesh = &mesh;
    check(vox_dist_scene_insert(scene, &desc));
    bodies[b].here = 1;
    free(tets); /* they were copied */
}

static void drop(int b) {
    check(vox_dist_scene_remove(scene, (uint64_t)b));
    free(bodies[b].positions);
    bodies[b].here = 0;
}

/* Steps, and weighs the bodies here. Returns the predicted cost of the busiest rank over the mean. */
static double step(uint64_t hash[2]) {
    check(vox_dist_scene_step(scene));
    check(vox_dist_scene_get_hash(scene, hash));
    vox_dist_cost costs[BODIES];
    uint64_t count;
    check(vox_dist_scene_get_costs(scene, costs, BODIES, &count));
    double mine = 0, most, all;
    for (uint64_t i = 0; i < count; ++i) {
        bodies[costs[i].body].weight = (float)costs[i].seconds;
        mine += costs[i].seconds;
    }
    MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return most / (all / size);
}

/* What Zoltan asks. */
static int count_bodies(void* unused, int* error) {
    (void)unused;
    int count = 0;
    for (int b = 0; b < BODIES; ++b) count += bodies[b].here;
    *error = ZOLTAN_OK;
    return count;
}

static void list_bodies(void* unused, int global_size, int local_size, ZOLTAN_ID_PTR global,
                        ZOLTAN_ID_PTR local, int weights, float* weight, int* error) {
    (void)unused, (void)global_size, (void)local_size, (void)local, (void)weights;
    for (int b = 0; b < BODIES; ++b)
        if (bodies[b].here) {
            *global++ = (ZOLTAN_ID_TYPE)b;
            *weight++ = bodies[b].weight;
        }
    *error = ZOLTAN_OK;
}

static int dimensions(void* unused, int* error) {
    (void)unused;
    *error = ZOLTAN_OK;
    return 3;
}

static void centre_of(void* unused, int global_size, int local_size, ZOLTAN_ID_PTR global,
                      ZOLTAN_ID_PTR local, double* out, int* error) {
    (void)unused, (void)global_size, (void)local_size, (void)local;
    place_of((int)*global, out);
    for (int axis = 0; axis < 3; ++axis) out[axis] += 2.5;
    *error = ZOLTAN_OK;
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    vox_dist_transport transport;
    transport.struct_size = (uint32_t)sizeof transport;
    check(vox_mpi_transport_create(MPI_COMM_WORLD, &transport));
    check(vox_dist_scene_create(NULL, &transport, &scene));
    for (int b = 0; b < BODIES; ++b)
        if (b * size / BODIES == rank) insert(b); /* as many on each rank */
    uint64_t before[2], after[2];
    const double skewed = step(before);

    float version;
    check_zoltan(Zoltan_Initialize(argc, argv, &version));
    struct Zoltan_Struct* zoltan = Zoltan_Create(MPI_COMM_WORLD);
    Zoltan_Set_Param(zoltan, "LB_METHOD", "RCB");
    Zoltan_Set_Param(zoltan, "OBJ_WEIGHT_DIM", "1");
    Zoltan_Set_Param(zoltan, "NUM_LID_ENTRIES", "0");
    Zoltan_Set_Param(zoltan, "DEBUG_LEVEL", "0");
    Zoltan_Set_Num_Obj_Fn(zoltan, count_bodies, NULL);
    Zoltan_Set_Obj_List_Fn(zoltan, list_bodies, NULL);
    Zoltan_Set_Num_Geom_Fn(zoltan, dimensions, NULL);
    Zoltan_Set_Geom_Fn(zoltan, centre_of, NULL);
    int changed, global_size, local_size, arriving, leaving, *from, *from_part, *to, *to_part;
    ZOLTAN_ID_PTR arrives, arrives_local, leaves, leaves_local;
    check_zoltan(Zoltan_LB_Partition(zoltan, &changed, &global_size, &local_size, &arriving, &arrives,
                                     &arrives_local, &from, &from_part, &leaving, &leaves, &leaves_local, &to,
                                     &to_part));
    for (int i = 0; i < leaving; ++i) drop((int)leaves[i]);
    for (int i = 0; i < arriving; ++i) insert((int)arrives[i]);
    int moved = 0;
    MPI_Reduce(&arriving, &moved, 1, MPI_INT, MPI_SUM, 0, MPI_COMM_WORLD);
    Zoltan_LB_Free_Part(&arrives, &arrives_local, &from, &from_part);
    Zoltan_LB_Free_Part(&leaves, &leaves_local, &to, &to_part);
    Zoltan_Destroy(&zoltan);

    const double even = step(after);
    if (before[0] != after[0] || before[1] != after[1]) {
        fprintf(stderr, "other contacts\n");
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    if (rank == 0)
        printf("the busiest of %d ranks: %.2f times the mean before, %.2f after %d bodies moved; the same "
               "contacts, %016" PRIx64 "\n",
               size, skewed, even, moved, after[0]);
    for (int b = 0; b < BODIES; ++b)
        if (bodies[b].here) drop(b);
    vox_dist_scene_destroy(scene);
    vox_mpi_transport_destroy(&transport);
    MPI_Finalize();
    return 0;
}
