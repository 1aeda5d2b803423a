// vox_sim over a C++ heap that fails: every allocation in turn in the life of two bodies.
#include "scenes/bodies.h"
#include "support/failing_heap.hpp"

#include <vox/vox_sim.h>

#include <vector>

namespace {

struct Shape {
    body box = make_box(2, 0.5f, 0, 0, 0);
    std::vector<double> positions{box.positions, box.positions + 3 * box.vertex_count};
    ~Shape() { free_body(&box); }

    vox_sim_body_desc desc() const {
        vox_sim_body_desc desc = vox_default_sim_body_desc();
        desc.positions = positions.data();
        desc.vertex_count = box.vertex_count;
        desc.tets = box.tets;
        desc.tet_count = box.tet_count;
        return desc;
    }
};

START_TEST(each_allocation_of_a_simulation) {
    Shape low, high;
    for (std::size_t v = 0; v < high.positions.size(); v += 3) {
        high.positions[v] += 0.3;
        high.positions[v + 2] += 0.9;
    }
    heap::fail_each([&](heap::Life& life) {
        struct Held {
            vox_sim* sim = nullptr;
            ~Held() { vox_sim_destroy(sim); }
        } held;
        const vox_sim_body_desc a = low.desc(), b = high.desc();
        vox_body bodies[2];
        vox_sim_body_view view;
        const bool done = life([&] { return vox_sim_create(nullptr, &held.sim); }) &&
                          life([&] { return vox_sim_body_insert(held.sim, &a, &bodies[0]); }) &&
                          life([&] { return vox_sim_body_insert(held.sim, &b, &bodies[1]); }) &&
                          life([&] { return vox_sim_step(held.sim, 0.01); }) &&
                          life([&] { return vox_sim_body_remove(held.sim, bodies[0]); });
        if (!done) return;
        ck_ok(vox_sim_body_get_view(held.sim, bodies[1], &view));
        life.hash = view.vertex_count;
    });
}
END_TEST

} // namespace

SUITE(sim_heap) { tcase_add_test(add_case(suite, "heap"), each_allocation_of_a_simulation); }
