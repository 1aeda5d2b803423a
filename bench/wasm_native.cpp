// The native side of bench/wasm.mjs: prints the least time of a step, in milliseconds, the hash of the last
// one, and the least nanoseconds of each stage, in the order of wasm.mjs. Such as WebAssembly, on one thread.
// usage: wasm_native SCENE OFFSET STEPS portable|sse4|avx2|avx512
#include "base/simd.hpp"
#include "scenes/counters.h"

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

void check(vox_result result) {
    if (result == VOX_OK) return;
    std::fprintf(stderr, "%s\n", vox_last_error());
    std::exit(1);
}

template <class T>
bool read(std::FILE* file, std::vector<T>& to, std::size_t count) {
    to.resize(count);
    return std::fread(to.data(), sizeof(T), count, file) == count;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 5) return 2;
    const double offset = std::atof(argv[2]);
    const int steps = std::atoi(argv[3]);
    const std::string level = argv[4];
    vox::simd::force_level(level == "portable" ? vox::simd::Level::portable
                           : level == "sse4"   ? vox::simd::Level::sse4
                           : level == "avx2"   ? vox::simd::Level::avx2
                                               : vox::simd::Level::avx512);
    std::FILE* const file = std::fopen(argv[1], "rb");
    std::vector<std::uint32_t> counts, tets;
    std::vector<float> positions;
    if (!file || !read(file, counts, 2) || !read(file, positions, std::size_t{3} * counts[0]) ||
        !read(file, tets, std::size_t{4} * counts[1]))
        return 2;
    std::fclose(file);

    vox_grid* grid;
    vox_body still, body;
    const vox_mesh_desc desc = vox_mesh_desc_floats(positions.data(), counts[0], tets.data(), counts[1]);
    vox_grid_desc settings = vox_default_grid_desc();
    settings.flags = VOX_GRID_CONSTRAINTS;
    check(vox_grid_create(&settings, &grid));
    check(vox_mesh_insert(grid, &desc, &still));
    check(vox_mesh_insert(grid, &desc, &body));
    double least = std::numeric_limits<double>::infinity();
    std::array<std::uint64_t, 9> stages;
    stages.fill(UINT64_MAX);
    for (int i = 0; i < steps; ++i) {
        const double matrix[12] = {1, 0, 0, offset + 0.001 * (i % 2), 0, 1, 0, 0.013, 0, 0, 1, 0.017};
        check(vox_body_set_transform(grid, body, matrix));
        using Clock = std::chrono::steady_clock;
        const Clock::time_point began = Clock::now();
        check(vox_grid_step(grid));
        least = std::min(least, std::chrono::duration<double, std::milli>(Clock::now() - began).count());
        const grid_times p = times_of(grid);
        const std::array<std::uint64_t, 9> now = {p.stream_ns, p.broad_phase_ns, p.windows_ns,
                                                  p.lookup_ns, p.decide_ns,      p.contacts_ns,
                                                  p.depth_ns,  p.constraints_ns, p.pairs_ns};
        for (std::size_t k = 0; k < now.size(); ++k) stages[k] = std::min(stages[k], now[k]);
    }
    std::uint64_t hash;
    check(vox_grid_get_hash(grid, &hash));
    std::printf("%.6f %016llx", least, static_cast<unsigned long long>(hash));
    for (const std::uint64_t ns : stages) std::printf(" %llu", static_cast<unsigned long long>(ns));
    std::printf("\n");
    vox_grid_destroy(grid);
    return 0;
}
