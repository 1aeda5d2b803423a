/* Whatever floating-point environment the caller has set: the same bytes, and the environment stays as it
 * was. */
#include "support/float_modes.h"
#include "support/io_files.h"

typedef struct record {
    bytes kept;
    uint64_t state; /* the caller's environment, which sink and progress function see */
    int wrong, reports;
} record;

static int32_t keep(const void* data, size_t size, void* user) {
    record* r = (record*)user;
    r->wrong += r->state != 0 && float_state() != r->state;
    r->kept.data = (unsigned char*)realloc(r->kept.data, r->kept.size + size + 1);
    memcpy(r->kept.data + r->kept.size, data, size);
    r->kept.size += size;
    return 0;
}

static int32_t watch(double fraction, void* user) {
    record* r = (record*)user;
    (void)fraction;
    r->wrong += float_state() != r->state;
    ++r->reports;
    return 0;
}

/* Coordinates that have to be rounded, one of them to a denormal. */
static const char tetrahedron[] =
    "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0.1 0.2 0.3 0\n1.1 4.3e-320 0 0\n"
    "0.7 1.3 0.123456789012345678901 0\n0.3 0.3 1e-5 0\nTetrahedra 1\n1 2 3 4 0\nEnd\n";

static record results(const float_mode* mode) {
    record r = {{NULL, 0}, 0, 0, 0};
    const vox_io_source source = {"a.mesh", tetrahedron, sizeof tetrahedron - 1};
    const vox_io_sink sink = {keep, &r};
    static const double corners[12] = {0.1, 0.2, 0.3, 1.7, 0, 0.1, 0, 1.3, 0.2, 0.1, 0.4, 1.9};
    static const uint32_t facets[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    const vox_io_mesh_view surface = {corners, 4, NULL, 0, facets, 4, NULL, NULL, NULL};
    vox_io_mesh* meshes[5];
    vox_io_write_desc desc;
    vox_io_load_desc load;
    vox_io_tetrahedralize_desc fill;
    vox_io_report report;
    vox_io_quality quality;
    memset(&report, 0, sizeof report);
    memset(&quality, 0, sizeof quality);
    report.struct_size = sizeof report;
    quality.struct_size = sizeof quality;
    fill = vox_default_io_tetrahedralize_desc();
    load = vox_default_io_load_desc();
    fill.progress = load.progress = watch;
    fill.progress_user = load.progress_user = &r;
    desc = vox_default_io_write_desc();
    desc.format = VOX_IO_WRITE_MSH_41;
    ck_in_mode(mode, vox_io_make_ball(0.7, 0.23, &meshes[1]));
    ck_in_mode(mode, vox_io_make_torus(1.0, 0.3, 0.17, &meshes[2]));
    ck_in_mode(mode, vox_io_mesh_create(&surface, &meshes[3]));
    set_float_mode(mode);
    r.state = float_state();
    set_float_mode(&float_modes[0]);
    ck_in_mode(mode, vox_io_read(&source, 1, &load, &meshes[0]));
    ck_assert_int_gt(r.reports, 0);
    r.reports = 0;
    ck_in_mode(mode, vox_io_tetrahedralize(meshes[3], &fill, &meshes[4]));
    ck_assert_int_gt(r.reports, 0);
    for (int i = 0; i < 5; ++i) {
        ck_in_mode(mode, vox_io_write_to(meshes[i], &desc, &sink));
        ck_in_mode(mode, vox_io_mesh_get_report(meshes[i], &report));
        ck_in_mode(mode, vox_io_mesh_measure(meshes[i], NULL, &quality));
        r.state = 0;
        keep(&report, sizeof report, &r);
        keep(&quality, sizeof quality, &r);
        set_float_mode(mode);
        r.state = float_state();
        set_float_mode(&float_modes[0]);
        vox_io_mesh_destroy(meshes[i]);
    }
    return r;
}

START_TEST(same_bytes) {
    const record expected = results(&float_modes[0]);
    ck_assert_uint_gt(expected.kept.size, 10000);
    for (int m = 0; m < float_mode_count; ++m) {
        const record found = results(&float_modes[m]);
        ck_assert_msg(found.kept.size == expected.kept.size &&
                          memcmp(found.kept.data, expected.kept.data, found.kept.size) == 0,
                      "%s: other bytes", float_modes[m].name);
        ck_assert_msg(found.wrong == 0, "%s: the sink or the progress function saw another environment",
                      float_modes[m].name);
        free(found.kept.data);
    }
    free(expected.kept.data);
}
END_TEST

SUITE(io_float_environment) {
    TCase* tests = add_case(suite, "modes");
    tcase_add_test(tests, same_bytes);
}
