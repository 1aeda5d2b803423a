// ../grid/first_contact.c in C++: two bodies of one tetrahedron each; vertex 3 of the first lies inside the
// second.
#include <cstdio>
#include <vox/vox_cell_size.hpp>

int main() try {
    const std::vector<std::uint32_t> tet = {0, 1, 2, 3};
    const std::vector<float> first = {5, 5, 5, 6, 5, 5, 5, 6, 5, 0.2f, 0.3f, 0.4f},
                             second = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    vox::grid grid;
    grid.insert(first, tet, 1); // positions are borrowed: move them between steps as you like
    grid.insert(second, tet, 2);
    grid.step(); // once a frame
    for (const vox_contact& c : grid.contacts())
        std::printf("vertex %u of body %u in tet %u of body %u\n", c.vertex,
                    (unsigned)grid.user_data(c.body_a), c.tet, (unsigned)grid.user_data(c.body_b));

    // No grid yet? One call gives the cell size for these meshes.
    const vox_cell_size_result best =
        vox::suggest_cell_size(std::array{vox::describe(first, tet), vox::describe(second, tet)});
    std::printf("cell size %.3f, good from %.3f to %.3f\n", best.cell_size, best.zone_min, best.zone_max);
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
