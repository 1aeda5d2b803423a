/* Surface to tetrahedra on the models of the meshes folder. */
#include "support/solid_checks.h"

#define FOLDER VOX_MESHES "/surfaces/"

static const char* const models[] = {"bunny", "armadillo", "cow_wrapped"};

static vox_io_mesh* loaded(const char* name, double* longest) {
    char path[4096];
    vox_io_mesh* mesh = NULL;
    vox_io_report report;
    snprintf(path, sizeof path, FOLDER "%s.obj", name);
    ck_ok(vox_io_load(path, NULL, &mesh));
    report.struct_size = sizeof report;
    ck_ok(vox_io_mesh_get_report(mesh, &report));
    *longest = 0;
    for (int k = 0; k < 3; ++k) *longest = fmax(*longest, report.bounds_max[k] - report.bounds_min[k]);
    return mesh;
}

START_TEST(fifty_cells) {
    double longest;
    vox_io_mesh* surface = loaded(models[_i], &longest);
    vox_io_tetrahedralize_desc desc;
    vox_io_mesh *mesh = NULL, *again = NULL;
    ck_ok(vox_io_tetrahedralize(surface, NULL, &mesh));
    desc = vox_default_io_tetrahedralize_desc();
    desc.cell = longest / 50;
    ck_ok(vox_io_tetrahedralize(surface, &desc, &again));
    check_same(mesh, again);
    vox_io_mesh_destroy(again);
    const solid_facts facts = check_stuffed(mesh);
    const vox_io_quality quality = quality_of(mesh, surface);
    ck_assert_double_eq_tol(facts.volume / quality.surface_volume, 1, 0.01);
    /* Without a wanted distance, creases and horns thinner than a cell are cut short. */
    ck_assert_double_lt(quality.mesh_to_surface, longest / 50);

    /* Coarser inside: the same boundary, fewer tets. */
    vox_io_mesh* coarse = NULL;
    desc.coarsen = 2;
    ck_ok(vox_io_tetrahedralize(surface, &desc, &coarse));
    const solid_facts coarse_facts = check_stuffed(coarse);
    ck_assert_uint_eq(coarse_facts.boundary_facets, facts.boundary_facets);
    ck_assert_double_eq_tol(coarse_facts.volume / facts.volume, 1, 1e-9);
    ck_assert_uint_lt(solid_view(coarse).tet_count, solid_view(mesh).tet_count);
    vox_io_mesh_destroy(coarse);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(surface);
}
END_TEST

/* With the distance asked for, it is kept, details thinner than a cell included. */
START_TEST(half_a_cell) {
    double longest;
    vox_io_mesh* surface = loaded(models[_i], &longest);
    vox_io_tetrahedralize_desc desc;
    vox_io_mesh* mesh = NULL;
    desc = vox_default_io_tetrahedralize_desc();
    desc.cell = longest / 50;
    desc.max_distance = desc.cell / 2;
    ck_ok(vox_io_tetrahedralize(surface, &desc, &mesh));
    const vox_io_quality quality = quality_of(mesh, surface);
    ck_assert_double_le(quality.hausdorff, desc.cell / 2);
    ck_assert_double_ge(quality.min_dihedral, LEAST_DIHEDRAL);
    ck_assert_double_le(quality.max_dihedral, MOST_DIHEDRAL);
    ck_assert_double_eq_tol(quality.volume / quality.surface_volume, 1, 0.01);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(surface);
}
END_TEST

/* The cow as found runs through itself: overlapping parts are joined into one solid. */
START_TEST(self_intersecting) {
    double longest, wrapped_longest;
    vox_io_mesh* surface = loaded("cow", &longest);
    vox_io_mesh* wrapped = loaded("cow_wrapped", &wrapped_longest);
    vox_io_mesh *mesh = NULL, *wrapped_mesh = NULL;
    ck_ok(vox_io_tetrahedralize(surface, NULL, &mesh));
    ck_ok(vox_io_tetrahedralize(wrapped, NULL, &wrapped_mesh));
    const solid_facts facts = check_stuffed(mesh), wrapped_facts = check_stuffed(wrapped_mesh);
    ck_assert_double_eq_tol(facts.volume / wrapped_facts.volume, 1, 0.03);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(wrapped_mesh);
    vox_io_mesh_destroy(surface);
    vox_io_mesh_destroy(wrapped);
}
END_TEST

START_TEST(million) {
    double longest;
    vox_io_mesh* surface = loaded("bunny", &longest);
    vox_io_tetrahedralize_desc desc;
    vox_io_mesh* mesh = NULL;
    desc = vox_default_io_tetrahedralize_desc();
    desc.cell = longest / 75;
    ck_ok(vox_io_tetrahedralize(surface, &desc, &mesh));
    ck_assert_uint_gt(solid_view(mesh).tet_count, 1000000);
    const vox_io_quality quality = quality_of(mesh, NULL);
    ck_assert_double_ge(quality.min_dihedral, LEAST_DIHEDRAL);
    ck_assert_double_le(quality.max_dihedral, MOST_DIHEDRAL);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(surface);
}
END_TEST

SUITE(solid_models) {
    if (!have_meshes(FOLDER "bunny.obj")) return;
    TCase* tests = add_case(suite, "models");
    tcase_add_loop_test(tests, fifty_cells, 0, 1);
    tcase_add_test(tests, self_intersecting);
    TCase* large = add_tagged_case(suite, "large", "large");
    tcase_add_loop_test(large, fifty_cells, 1, 3);
    tcase_add_loop_test(large, half_a_cell, 0, test_volume() > 1 ? 3 : 1); /* the others take half a minute */
    tcase_add_test(large, million);
}
