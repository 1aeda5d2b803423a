/* One block of tetrahedra a rank, each 0.3 into the next: contacts across ranks, a force for each contact,
 * and a point that only its rank knows. Of a build with -DVOX_MPI=ON that is installed:
 *
 *     mpicc blocks_on_ranks.c $(pkg-config --cflags --libs vox_mpi) -o blocks && mpirun -n 4 ./blocks
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <vox/vox_mpi.h>

enum { SIDE = 4, VERTICES = (SIDE + 1) * (SIDE + 1) * (SIDE + 1), TETS = 6 * SIDE * SIDE * SIDE };

static void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    MPI_Abort(MPI_COMM_WORLD, 1);
}

static uint32_t vertex(const uint32_t* at) { return (at[2] * (SIDE + 1) + at[1]) * (SIDE + 1) + at[0]; }

static void make_block(double origin, double* positions, uint32_t* tets) {
    static const int paths[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    uint32_t at[3];
    for (at[2] = 0; at[2] <= SIDE; ++at[2])
        for (at[1] = 0; at[1] <= SIDE; ++at[1])
            for (at[0] = 0; at[0] <= SIDE; ++at[0])
                for (int axis = 0; axis < 3; ++axis)
                    positions[3 * vertex(at) + axis] = (double)at[axis] / SIDE + (axis == 0 ? origin : 0);
    for (at[2] = 0; at[2] < SIDE; ++at[2])
        for (at[1] = 0; at[1] < SIDE; ++at[1])
            for (at[0] = 0; at[0] < SIDE; ++at[0])
                for (int path = 0; path < 6;
                     ++path) { /* from the lowest corner of a cube to the highest one */
                    uint32_t corner[3] = {at[0], at[1], at[2]};
                    *tets++ = vertex(corner);
                    ++corner[paths[path][0]];
                    *tets++ = vertex(corner);
                    ++corner[paths[path][1]];
                    *tets++ = vertex(corner);
                    *tets++ = vertex((uint32_t[3]){at[0] + 1, at[1] + 1, at[2] + 1});
                }
}

int main(int argc, char** argv) {
    static double positions[3 * VERTICES];
    static uint32_t tets[4 * TETS];
    MPI_Init(&argc, &argv);
    vox_dist_transport transport;
    transport.struct_size = (uint32_t)sizeof transport;
    check(vox_mpi_transport_create(MPI_COMM_WORLD, &transport));
    make_block(0.7 * transport.rank, positions, tets);

    vox_dist_scene* scene;
    check(vox_dist_scene_create(NULL, &transport, &scene));
    const vox_mesh_desc mesh = vox_mesh_desc_doubles(positions, VERTICES, tets, TETS);
    vox_dist_part_desc desc = vox_default_dist_part_desc();
    desc.body = transport.rank; /* a whole body here; parts of one body would have the same number */
    desc.mesh = &mesh;
    check(vox_dist_scene_insert(scene, &desc));
    check(vox_dist_scene_step(scene));

    /* Each vertex in contact pushes against the tetrahedron that it is in, wherever that lies. */
    vox_dist_contact_view contacts, of_tets;
    check(vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &contacts));
    check(vox_dist_scene_get_contacts(scene, VOX_DIST_TETS, &of_tets));
    double* out = (double*)malloc(sizeof(double) * (contacts.count + 1));
    double* in = (double*)malloc(sizeof(double) * (of_tets.count + 1));
    if (!out || !in) MPI_Abort(MPI_COMM_WORLD, 1);
    for (uint64_t i = 0; i < contacts.count; ++i) out[i] = 1;
    check(vox_dist_scene_send(scene, VOX_DIST_VERTICES, sizeof(double), out, in));
    double pushed = 0;
    for (uint64_t i = 0; i < of_tets.count; ++i) pushed += in[i];

    /* The middle of the last block, asked for by rank 0. */
    const double point[3] = {0.7 * (transport.size - 1) + 0.55, 0.5, 0.5};
    const vox_positions points = vox_double_positions(point, transport.rank == 0);
    vox_dist_location found;
    check(vox_dist_scene_locate(scene, &points, &found));

    uint64_t hash[2];
    check(vox_dist_scene_get_hash(scene, hash));
    const double mine[2] = {(double)contacts.count, pushed};
    double* all = (double*)malloc(sizeof mine * transport.size);
    if (!all) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Gather(mine, 2, MPI_DOUBLE, all, 2, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    for (uint32_t rank = 0; transport.rank == 0 && rank < transport.size; ++rank)
        printf("rank %" PRIu32 ": %g vertices in others' tetrahedra, pushed by %g\n", rank, all[2 * rank],
               all[2 * rank + 1]);
    free(all);
    if (transport.rank == 0)
        printf("the point is in tet %" PRIu64 " of body %" PRIu64 ", on rank %" PRIu32 "\nhash %016" PRIx64
               "%016" PRIx64 "\n",
               found.tet, found.body, found.rank, hash[0], hash[1]);
    free(out);
    free(in);
    vox_dist_scene_destroy(scene);
    vox_mpi_transport_destroy(&transport);
    MPI_Finalize();
    return 0;
}
