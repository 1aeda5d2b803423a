// The scenes of test_dist over real MPI: run by mpirun on some processes.
#include "dist/whole.hpp"

#include <vox/vox_mpi.h>

#include <cmath>
#include <cstdio>

using namespace scenes;

namespace {

int fail(const char* what, std::uint64_t seed, int rank) {
    std::printf("rank %d, scene %llu: %s (%s)\n", rank, static_cast<unsigned long long>(seed), what,
                vox_last_error());
    std::fflush(stdout);
    return MPI_Abort(MPI_COMM_WORLD, 1);
}

} // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    vox_dist_transport transport{};
    if (vox_mpi_transport_create(MPI_COMM_WORLD, &transport) != VOX_ERROR_INVALID_ARGUMENT)
        return fail("a struct without a size is written", 0, -1);
    transport.struct_size = sizeof transport;
    if (vox_mpi_transport_create(MPI_COMM_WORLD, &transport) != VOX_OK) return fail("no transport", 0, -1);
    const int rank = static_cast<int>(transport.rank);
    std::uint64_t contacts = 0;
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
        const Scene scene = lattice(seed);
        std::vector<std::vector<float>> floats;
        vox_grid* grid = whole(scene, floats);
        std::uint64_t expected[2], hash[2];
        if (!grid || vox_grid_step(grid) != VOX_OK) return fail("one grid", seed, rank);
        const std::vector<vox_dist_contact> of_grid = global_contacts(scene, grid);
        hash_of(of_grid, expected);
        contacts += of_grid.size();
        vox_grid_destroy(grid);
        Random random(seed);
        Ranked mine(&transport);
        if (mine.result != VOX_OK) return fail("create", seed, rank);
        std::vector<std::vector<Share>> all;
        for (const Body& body : scene)
            all.push_back(shares(body, cut(body, transport.size, static_cast<Cut>(seed % 5), random),
                                 transport.size, random));
        for (std::size_t b = 0; b < scene.size(); ++b)
            if (mine.insert(scene[b], all[b][transport.rank]) != VOX_OK) return fail("insert", seed, rank);
        if (vox_dist_scene_step(mine.scene) != VOX_OK || vox_dist_scene_get_hash(mine.scene, hash) != VOX_OK)
            return fail("step", seed, rank);
        if (hash[0] != expected[0] || hash[1] != expected[1]) return fail("another hash", seed, rank);
        if (vox_dist_scene_check(mine.scene) != VOX_OK) return fail("check", seed, rank);
        // A NaN on one rank is the same failure on all, and the next step works.
        const std::uint32_t bad = static_cast<std::uint32_t>(seed) % transport.size;
        std::uint64_t has_vertices = 0;
        for (std::size_t b = 0; b < scene.size(); ++b) has_vertices |= all[b][bad].xyz.size();
        if (has_vertices == 0) continue;
        double* changed_double = nullptr;
        float* changed_float = nullptr;
        for (std::size_t b = 0;
             transport.rank == bad && !changed_double && !changed_float && b < scene.size(); ++b)
            if (!all[b][bad].xyz.empty()) {
                if (scene[b].doubles)
                    changed_double = &all[b][bad].xyz.back();
                else
                    changed_float = &all[b][bad].floats.back();
            }
        const double old = changed_double ? *changed_double : changed_float ? *changed_float : 0;
        if (changed_double) *changed_double = NAN;
        if (changed_float) *changed_float = NAN;
        if (vox_dist_scene_step(mine.scene) != VOX_ERROR_NON_FINITE)
            return fail("not the same failure", seed, rank);
        if (changed_double) *changed_double = old;
        if (changed_float) *changed_float = static_cast<float>(old);
        if (vox_dist_scene_step(mine.scene) != VOX_OK ||
            vox_dist_scene_get_hash(mine.scene, hash) != VOX_OK || hash[0] != expected[0] ||
            hash[1] != expected[1])
            return fail("the step after a failure", seed, rank);
    }
    if (contacts == 0) return fail("no contacts at all", 0, rank);
    vox_mpi_transport_destroy(&transport);
    MPI_Finalize();
    if (rank == 0)
        std::printf("25 scenes, %llu contacts: the same\n", static_cast<unsigned long long>(contacts));
    return 0;
}
