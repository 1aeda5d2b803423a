// See step.c.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <vox/vox.hpp>

static std::uint64_t now() {
    const auto since = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(since).count());
}

int main(int argc, char** argv) {
    std::ifstream in(argc == 2 ? argv[1] : "", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), 4 * words.size());
    if (words.size() < 2) return std::fprintf(stderr, "usage: step SCENE\n"), 1;
    const std::size_t bodies = words[0], frames = words[1];
    const std::uint32_t *counts = words.data() + 2, *tets = counts + 2 * bodies;
    const auto* positions = reinterpret_cast<const std::array<float, 3>*>(tets);
    const auto* corners = reinterpret_cast<const std::array<std::uint32_t, 4>*>(tets);
    for (std::size_t b = 0; b < bodies; ++b)
        positions = reinterpret_cast<const std::array<float, 3>*>(
            reinterpret_cast<const std::uint32_t*>(positions) + 4 * counts[2 * b + 1]);

    vox::grid grid;
    std::vector<vox_body> meshes;
    const auto* xyz = positions;
    for (std::size_t b = 0; b < bodies; ++b) {
        meshes.push_back(
            grid.insert_copy(vox::span<const std::array<float, 3>>(xyz, counts[2 * b]),
                             vox::span<const std::array<std::uint32_t, 4>>(corners, counts[2 * b + 1])));
        xyz += counts[2 * b];
        corners += counts[2 * b + 1];
    }

    for (int passes; std::cin >> passes;) {
        std::uint64_t hashes = 0;
        std::vector<std::uint64_t> least(2 * frames, UINT64_MAX);
        for (; passes > 0; --passes) {
            xyz = positions;
            for (std::size_t f = 0; f < frames; ++f) {
                for (std::size_t b = 0; b < bodies; ++b) {
                    const auto mapped = grid.map_positions<float>(meshes[b]);
                    std::memcpy(mapped.data(), xyz, sizeof *xyz * counts[2 * b]);
                    xyz += counts[2 * b];
                }
                const std::uint64_t begin = now();
                grid.step();
                const std::uint64_t stepped = now();
                for (const vox_contact& c : grid.contacts()) hashes += c.vertex;
                const std::uint64_t end = now();
                least[2 * f] = std::min(least[2 * f], stepped - begin);
                least[2 * f + 1] = std::min(least[2 * f + 1], end - stepped);
                hashes += grid.hash();
            }
        }
        std::printf("%016llx", static_cast<unsigned long long>(hashes));
        for (std::uint64_t time : least) std::printf(" %llu", static_cast<unsigned long long>(time));
        std::puts("");
        std::fflush(stdout);
    }
}
