// What the tests of the C++ headers share: two boxes in contact as vectors, and a grid of them made by C
// calls alone.
#ifndef VOX_TESTS_CPP_SCENE_HPP
#define VOX_TESTS_CPP_SCENE_HPP

#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

#include <vector>

struct Scene {
    std::vector<float> a, b;
    std::vector<std::uint32_t> tets;
    explicit Scene(std::uint32_t n = 3) {
        body first = make_box(n, 0.25f, 0, 0, 0), second = make_box(n, 0.25f, 0.4f, 0.3f, 0.2f);
        a.assign(first.positions, first.positions + 3 * first.vertex_count);
        b.assign(second.positions, second.positions + 3 * second.vertex_count);
        tets.assign(first.tets, first.tets + 4 * first.tet_count);
        free_body(&first);
        free_body(&second);
    }
    std::uint64_t vertices() const { return a.size() / 3; }
    std::uint64_t tet_count() const { return tets.size() / 4; }
};

// A grid of C with the two boxes; its destructor destroys it.
struct CGrid {
    vox_grid* grid = nullptr;
    vox_body meshes[2] = {0, 0};
    explicit CGrid(const Scene& scene, std::uint32_t flags = VOX_GRID_CONSTRAINTS) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = flags;
        grid = grid_of(&desc);
        const std::vector<float>* positions[] = {&scene.a, &scene.b};
        for (std::size_t i = 0; i < 2; ++i) {
            vox_mesh_desc mesh = vox_mesh_desc_floats(positions[i]->data(), scene.vertices(),
                                                      scene.tets.data(), scene.tet_count());
            mesh.user_data = i + 1;
            meshes[i] = insert_mesh(grid, &mesh);
        }
    }
    ~CGrid() { vox_grid_destroy(grid); }
    CGrid(const CGrid&) = delete;
    CGrid& operator=(const CGrid&) = delete;
};

#endif
