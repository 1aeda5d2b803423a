/* Good files of every format: one ball in all of them, meshes as found, the paper's models, surfaces. */
#include "support/io_files.h"

static vox_io_mesh* loaded(const char* folder, const char* name) {
    char path[1024];
    vox_io_mesh* mesh = NULL;
    snprintf(path, sizeof path, "%s/%s/%s", VOX_MESHES, folder, name);
    ck_ok(vox_io_load(path, NULL, &mesh));
    check_sound(mesh);
    return mesh;
}

/* What the core measures, over positions in single precision. */
static vox_geometry geometry_of(const vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    float* positions = (float*)malloc(3 * sizeof(float) * view.vertex_count);
    for (uint64_t i = 0; i < 3 * view.vertex_count; ++i) positions[i] = (float)view.positions[i];
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = positions;
    desc.positions.count = view.vertex_count;
    desc.tets = view.tets;
    desc.tet_count = view.tet_count;
    vox_geometry geometry;
    geometry.struct_size = (uint32_t)sizeof geometry;
    ck_ok(vox_measure_geometry(&desc, 1, &geometry));
    free(positions);
    return geometry;
}

static uint64_t boundary_vertices(const vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    unsigned char* seen = (unsigned char*)calloc(view.vertex_count, 1);
    for (uint64_t t = 0; t < view.tet_count; ++t)
        for (int skip = 0; skip < 4; ++skip) {
            const uint32_t* own = view.tets + 4 * t;
            int twins = 0;
            for (uint64_t other = 0; other < view.tet_count; ++other) {
                int shared = 0;
                for (int i = 0; i < 4; ++i)
                    for (int j = 0; j < 4; ++j)
                        shared += i != skip && own[i] == view.tets[4 * other + (uint64_t)j];
                twins += shared == 3;
            }
            if (twins == 1)
                for (int i = 0; i < 4; ++i)
                    if (i != skip) seen[own[i]] = 1;
        }
    uint64_t count = 0;
    for (uint64_t v = 0; v < view.vertex_count; ++v) count += seen[v];
    free(seen);
    return count;
}

START_TEST(ball_in_every_format) {
    const bytes list = read_file(VOX_MESHES "/formats", "EXPECTED.tsv");
    ck_assert_ptr_nonnull(list.data);
    vox_io_mesh* first = NULL;
    int files = 0;
    for (char* line = strtok((char*)list.data, "\r\n"); line; line = strtok(NULL, "\r\n")) {
        if (*line == '#') continue;
        line[strcspn(line, "\t")] = 0;
        vox_io_mesh* mesh = loaded("formats", line);
        const vox_io_report report = report_of(mesh);
        const vox_geometry geometry = geometry_of(mesh);
        ck_assert_msg(report.vertices == 256 && report.tets == 883, "%s: %llu vertices, %llu tets", line,
                      (unsigned long long)report.vertices, (unsigned long long)report.tets);
        ck_assert_msg(close_to(report.volume, 4.0641183218, 1e-10), "%s: volume %.12g", line, report.volume);
        ck_assert_uint_eq(report.boundary_facets, 380);
        ck_assert_uint_eq(report.non_manifold_facets, 0);
        ck_assert_uint_eq(report.components, 1);
        ck_assert(report.triangles == 0 || report.triangles == 380);
        ck_assert_str_eq(vox_io_mesh_get_warnings(mesh), "");
        ck_assert_uint_eq(geometry.edges, 1328);
        ck_assert_uint_eq(geometry.facets, 1956);
        ck_assert(close_to(geometry.mean_edge, 0.3522863976, 1e-6));
        ck_assert(close_to(geometry.mean_facet_area, 0.05258673656, 1e-6));
        if (!first) {
            ck_assert_uint_eq(boundary_vertices(mesh), 192);
            first = mesh;
        } else { /* the same tets in the same order */
            vox_io_mesh_view a, b;
            ck_ok(vox_io_mesh_get_arrays(first, &a));
            ck_ok(vox_io_mesh_get_arrays(mesh, &b));
            ck_assert_msg(memcmp(a.tets, b.tets, 16 * a.tet_count) == 0, "%s: other tets", line);
            double farthest = 0;
            for (uint64_t i = 0; i < 3 * a.vertex_count; ++i)
                farthest = fmax(farthest, fabs(a.positions[i] - b.positions[i]));
            ck_assert_double_lt(farthest, 1e-11);
            vox_io_mesh_destroy(mesh);
        }
        ++files;
    }
    ck_assert_int_eq(files, 19);
    vox_io_mesh_destroy(first);
    free(list.data);
}
END_TEST

START_TEST(meshes_as_found) {
    static const struct {
        const char *name, *twin;
        uint64_t tets;
        vox_io_format format;
    } rows[] = {{"liver.msh", "liver_v22.msh", 596, VOX_IO_FORMAT_GMSH},
                {"torus_low_res.msh", "torus_low_res_v22.msh", 862, VOX_IO_FORMAT_GMSH},
                {"cylinder.msh", "cylinder_v22.msh", 2430, VOX_IO_FORMAT_GMSH},
                {"Bunny.vtk", "Bunny_v22.msh", 5897, VOX_IO_FORMAT_VTU},
                {"Bunny_legacy.vtk", "Bunny_v22.msh", 5897, VOX_IO_FORMAT_VTK}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh *mesh = loaded("real", rows[i].name), *twin = loaded("real", rows[i].twin);
        vox_io_mesh_view a, b;
        ck_ok(vox_io_mesh_get_arrays(mesh, &a));
        ck_ok(vox_io_mesh_get_arrays(twin, &b));
        ck_assert_uint_eq(a.tet_count, rows[i].tets);
        ck_assert_uint_eq(b.tet_count, rows[i].tets);
        ck_assert_uint_eq(a.vertex_count, b.vertex_count);
        ck_assert_int_eq(memcmp(a.tets, b.tets, 16 * a.tet_count), 0);
        ck_assert_int_eq(report_of(mesh).format, rows[i].format);
        ck_assert(close_to(report_of(mesh).volume, report_of(twin).volume, 1e-7));
        vox_io_mesh_destroy(mesh);
        vox_io_mesh_destroy(twin);
    }
}
END_TEST

START_TEST(paper_models) {
    static const struct {
        const char* name;
        uint64_t vertices, tets;
        double volume;
    } rows[] = {{"sphere01", 8183, 41883, 4.1790},  {"sphere02", 10097, 52313, 4.1803},
                {"sphere03", 11609, 60616, 4.1811}, {"sphere04", 13786, 72497, 4.1820},
                {"sphere05", 15291, 80915, 4.1824}, {"bunny", 4717, 20426, 1.5102},
                {"cow", 11615, 50156, 1.0724},      {"armadillo", 4315, 16385, 1.2420}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        char name[64];
        snprintf(name, sizeof name, "%s.msh", rows[i].name);
        vox_io_mesh* msh = loaded("paper", name);
        snprintf(name, sizeof name, "%s.%s", rows[i].name, i % 2 ? "node" : "ele");
        vox_io_mesh* node = loaded("paper", name);
        check_same(msh, node);
        const vox_io_report report = report_of(msh);
        ck_assert_uint_eq(report.vertices, rows[i].vertices);
        ck_assert_uint_eq(report.tets, rows[i].tets);
        ck_assert(fabs(report.volume - rows[i].volume) < 1e-4);
        ck_assert_str_eq(vox_io_mesh_get_warnings(msh), "");
        vox_io_mesh_destroy(msh);
        vox_io_mesh_destroy(node);
    }
    vox_io_mesh* lattice = loaded("paper-lattice", "sphere01_lattice.msh");
    ck_assert_uint_eq(report_of(lattice).tets, 41946);
    vox_io_mesh_destroy(lattice);
}
END_TEST

START_TEST(surfaces) {
    static const struct {
        const char* name;
        uint64_t vertices, components;
    } rows[] = {{"bunny.obj", 8904, 1},
                {"cow.obj", 2903, 1},
                {"cow_wrapped.obj", 6803, 1},
                {"armadillo.obj", 12602, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh* mesh = loaded("surfaces", rows[i].name);
        const vox_io_report report = report_of(mesh);
        ck_assert_int_eq(report.format, VOX_IO_FORMAT_SURFACE);
        ck_assert_uint_eq(report.vertices, rows[i].vertices);
        ck_assert_uint_eq(report.tets, 0);
        ck_assert_uint_eq(report.open_edges + report.non_manifold_facets + report.misoriented_edges, 0);
        ck_assert_uint_eq(report.components, rows[i].components);
        ck_assert_double_gt(report.volume, 0);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

SUITE(io_meshes) {
    if (!have_meshes(VOX_MESHES "/bad/MANIFEST.tsv")) return;
    TCase* tests = add_case(suite, "good");
    tcase_add_each(tests, ball_in_every_format, meshes_as_found, paper_models, surfaces);
}
