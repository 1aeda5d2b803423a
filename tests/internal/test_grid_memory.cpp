// A grid takes all its memory from its own allocator: with no other memory resource at hand it still works.
#include "scenes/bodies.h"
#include "support/locators.h"

#include <cstring>
#include <memory_resource>

namespace {

void add_mesh(vox_grid* grid, const body& b) {
    vox_mesh_desc desc = body_desc(&b);
    desc.flags = VOX_MESH_COPY_POSITIONS;
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    insert_mesh(grid, &desc);
}

START_TEST(nothing_from_the_default_resource) {
    body box = make_box(14, 0.125f, 0, 0, 0), other = make_box(6, 0.25f, 0.4f, 0.3f, 0.2f);
    std::pmr::memory_resource* const usual = std::pmr::set_default_resource(std::pmr::null_memory_resource());
    for (const std::uint32_t flags : {0u, std::uint32_t{VOX_REFERENCE_DENSE}}) {
        vox_grid_desc desc = vox_default_grid_desc();
        if (suite_engine == ENGINE_REFERENCE) desc.reference = reference_with(flags);
        vox_grid* grid = nullptr;
        ck_ok(vox_grid_create(&desc, &grid));
        add_mesh(grid, box);
        add_mesh(grid, other);
        for (int step = 0; step < 2; ++step) ck_ok(vox_grid_step(grid)); // the cell size is chosen, too
        vox_contact_view view{};
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert_uint_gt(view.count, 0);
        vox_locator* locator = take_locator(grid);
        ck_ok(vox_grid_update_locator(grid, &locator));
        vox_grid_destroy(grid);
        vox_locator_release(locator);
    }
    std::pmr::set_default_resource(usual);
    free_body(&box);
    free_body(&other);
}
END_TEST

void add_tests(TCase* tests) { tcase_add_test(tests, nothing_from_the_default_resource); }

} // namespace

SUITE(grid_memory) { add_for_each_engine(suite, add_tests); }
