// A row of bodies of one tetrahedron that do not touch, and the same vertices in a hundred bodies, all
// moving: bytes a body, insertion, and steps by turns. usage: bench_small_bodies [--tets N] [--rounds K]
#include "program.hpp"
#include "scenes/counters.h"
#include "timing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

namespace {

using bench::must;

class Row {
public:
    Row(std::size_t tets, std::size_t bodies) : positions_(12 * (tets / bodies * bodies)), bodies_(bodies) {
        const std::size_t each = tets / bodies;
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            const float corner = i % 12 == 3 || i % 12 == 7 || i % 12 == 11 ? 1 : 0;
            positions_[i] = corner + (i % 3 == 0 ? 2 * static_cast<float>(i / 12) : 0);
        }
        for (std::uint32_t v = 0; v < 4 * each; ++v) corners_.push_back(v);
        must(vox_grid_create(nullptr, &grid_));
        const double start = now();
        for (std::size_t b = 0; b < bodies; ++b) {
            const vox_mesh_desc desc =
                vox_mesh_desc_floats(&positions_[12 * each * b], 4 * each, corners_.data(), each);
            vox_body mesh;
            must(vox_mesh_insert(grid_, &desc, &mesh));
        }
        insertion = now() - start;
    }
    ~Row() { vox_grid_destroy(grid_); }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;

    // Every coordinate moves a little.
    void step(int round) {
        const float to = round % 2 ? 1e30f : -1e30f;
        for (float& x : positions_) x = std::nextafter(x, to);
        const double start = now();
        must(vox_grid_step(grid_));
        if (round > 0) least_step = std::min(least_step, now() - start); // the first one prepares
    }
    double bytes() const {
        grid_counts counters;
        counters = counters_of(grid_);
        if (counters.contacts != 0) throw std::runtime_error("bodies of the row touch");
        return static_cast<double>(counters.bytes) / static_cast<double>(bodies_);
    }

    double insertion, least_step = std::numeric_limits<double>::infinity();

private:
    std::vector<float> positions_;
    std::vector<std::uint32_t> corners_;
    std::size_t bodies_;
    vox_grid* grid_ = nullptr;
};

int run(int argc, char** argv) {
    bench::Size size{1e6, 7};
    if (!bench::read_size(argc, argv, "bench_small_bodies", size)) return 2;
    const auto tets = static_cast<std::size_t>(size.tets);
    Row many(tets, tets), few(tets, 100);
    for (int round = 0; round <= size.rounds; ++round)
        for (Row* row : {&many, &few}) row->step(round);
    for (Row* row : {&many, &few})
        std::printf("%8zu bodies: insertion %7.1f ms, a step %6.2f ms, %.0f bytes a body\n",
                    row == &many ? tets : std::size_t{100}, 1e3 * row->insertion, 1e3 * row->least_step,
                    row->bytes());
    std::printf("a step takes %.1f times as long\n", many.least_step / few.least_step);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    return bench::run_program("bench_small_bodies", [&] { return run(argc, argv); });
}
