#include <cstdio>
#include <vox/vox.hpp>
#ifdef WITH_io
#include <vox/vox_io.hpp>
#endif
#ifdef WITH_sim
#include <vox/vox_sim.hpp>
#endif

int main() try {
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    vox::grid grid;
    grid.insert(positions, {0, 1, 2, 3});
    grid.step();
#ifdef WITH_io
    if (vox::io::make_ball(1, 0.5).report().tets == 0) return 1;
#endif
#ifdef WITH_sim
    vox::sim::simulation().step(0.01);
#endif
    return grid.meshes().size() == 1 && vox::version() == vox_version() ? 0 : 1;
} catch (const vox::error& error) {
    return std::puts(error.what()), 1;
}
