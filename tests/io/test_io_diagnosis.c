/* The report of a mesh, the C border of loading, and the exactness of what is called inverted or flat. */
#include "support/io_files.h"

#include <float.h>
#include <gmp.h>
#ifdef __unix__
#include <sys/stat.h>
#include <unistd.h>
#endif

static vox_io_mesh* made(const double* positions, uint64_t vertices, const uint32_t* tets, uint64_t tet_count,
                         const uint32_t* triangles, uint64_t triangle_count) {
    const vox_io_mesh_view arrays = {positions,      vertices, tets, tet_count, triangles,
                                     triangle_count, NULL,     NULL, NULL};
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_mesh_create(&arrays, &mesh));
    check_sound(mesh);
    return mesh;
}

static vox_io_report report_of_arrays(const double* positions, uint64_t vertices, const uint32_t* tets,
                                      uint64_t tet_count, const uint32_t* triangles,
                                      uint64_t triangle_count) {
    vox_io_mesh* mesh = made(positions, vertices, tets, tet_count, triangles, triangle_count);
    const vox_io_report report = report_of(mesh);
    vox_io_mesh_destroy(mesh);
    return report;
}

/* A unit corner tet, its copy elsewhere, and what can be wrong with tets. */
static const double corner[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 0, 0, 6,    0,    0,
                                5, 1, 0, 5, 0, 1, 1, 1, 0, 0, 0, 0, 9, 9, 9, 0.25, 0.25, 1e-12};

START_TEST(tets) {
    static const uint32_t two[] = {0, 1, 2, 3, 4, 5, 6, 7};
    vox_io_report r = report_of_arrays(corner, 8, two, 2, NULL, 0);
    ck_assert_uint_eq(r.components, 2);
    ck_assert_uint_eq(r.boundary_facets, 8);
    ck_assert(close_to(r.volume, 2.0 / 6, 1e-15));
    ck_assert_uint_eq(r.inverted_tets + r.degenerate_tets + r.nearly_flat_tets + r.duplicate_tets, 0);
    ck_assert_double_eq(r.bounds_max[0], 6);
    ck_assert_double_eq(r.bounds_min[0], 0);
    ck_assert_int_eq(r.format, VOX_IO_FORMAT_AUTO);

    static const uint32_t odd[] = {0, 1, 2, 3, /* good */
                                   1, 0, 2, 3, /* the same four, inverted */
                                   0, 1, 2, 8, /* flat */
                                   0, 1, 1, 3, /* flat: a vertex twice */
                                   0, 1, 2, 11 /* nearly flat */};
    r = report_of_arrays(corner, 12, odd, 5, NULL, 0);
    ck_assert_uint_eq(r.inverted_tets, 1);
    ck_assert_uint_eq(r.degenerate_tets, 2);
    ck_assert_uint_eq(r.nearly_flat_tets, 1);
    ck_assert_uint_eq(r.duplicate_tets, 1);
    ck_assert_uint_eq(r.duplicate_vertices, 1); /* 9 lies at 0 */
    ck_assert_uint_eq(r.unused_vertices, 6);    /* 4 to 7, 9, 10 */
    ck_assert_uint_eq(r.components, 1);
    ck_assert_uint_eq(r.non_manifold_facets, 1); /* 0 1 2, of four tets */
    ck_assert_double_eq(r.bounds_max[0], 1);     /* unused vertices do not widen the box */
    ck_assert(close_to(r.volume, 2.0 / 6, 1e-11));
}
END_TEST

START_TEST(closed_and_open_surfaces) {
    static const uint32_t closed[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}; /* outward */
    static const uint32_t inside_out[] = {0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3};
    static const uint32_t fan[] = {0, 1, 2, 1, 0, 3,
                                   0, 1, 8, 8, 8, 1}; /* three on edge 0 1, and a flat one */
    vox_io_report r = report_of_arrays(corner, 4, NULL, 0, closed, 4);
    ck_assert_uint_eq(r.open_edges + r.non_manifold_facets + r.misoriented_edges, 0);
    ck_assert_uint_eq(r.boundary_facets, 4);
    ck_assert(close_to(r.volume, 1.0 / 6, 1e-15));
    vox_io_mesh* mesh = made(corner, 4, NULL, 0, inside_out, 4);
    ck_assert(close_to(report_of(mesh).volume, -1.0 / 6, 1e-15));
    ck_assert_ptr_nonnull(strstr(vox_io_mesh_get_warnings(mesh), "inside out"));
    vox_io_mesh_destroy(mesh);

    r = report_of_arrays(corner, 4, NULL, 0, closed, 3);
    ck_assert_uint_eq(r.open_edges, 3);
    ck_assert_double_eq(r.volume, 0);
    r = report_of_arrays(corner, 9, NULL, 0, fan, 4);
    ck_assert_uint_eq(r.non_manifold_facets, 1);
    ck_assert_uint_eq(r.open_edges, 6);
    ck_assert_uint_eq(r.degenerate_triangles, 1);
    static const uint32_t turned[] = {0, 2, 1, 0, 3, 1,
                                      1, 2, 3, 0, 3, 2}; /* the second of `closed` turned over */
    r = report_of_arrays(corner, 4, NULL, 0, turned, 4);
    ck_assert_uint_eq(r.misoriented_edges, 3);
    ck_assert_double_eq(r.volume, 0);
}
END_TEST

START_TEST(empty_meshes_and_points) {
    vox_io_report r = report_of_arrays(NULL, 0, NULL, 0, NULL, 0);
    ck_assert_uint_eq(r.vertices + r.tets + r.triangles + r.components, 0);
    r = report_of_arrays(corner, 8, NULL, 0, NULL, 0);
    ck_assert_uint_eq(r.vertices, 8);
    ck_assert_uint_eq(r.unused_vertices, 8);
    ck_assert_double_eq(r.bounds_max[0], 6); /* of all, where none is in use */
}
END_TEST

/* Sign of the determinant of the tet's edges, in rationals. */
static int oracle_sign(const double* p) {
    mpq_t m[3][3], t, u, det;
    mpq_inits(t, u, det, NULL);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            mpq_init(m[i][k]);
            mpq_set_d(m[i][k], p[3 * (i + 1) + k]);
            mpq_set_d(t, p[k]);
            mpq_sub(m[i][k], m[i][k], t);
        }
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        mpq_mul(t, m[1][a], m[2][b]);
        mpq_mul(u, m[1][b], m[2][a]);
        mpq_sub(t, t, u);
        mpq_mul(t, t, m[0][k]);
        mpq_add(det, det, t);
    }
    const int sign = mpq_sgn(det);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) mpq_clear(m[i][k]);
    mpq_clears(t, u, det, NULL);
    return sign;
}

static uint64_t random_state = 88172645463325252u;
static uint64_t next_random(void) { /* xorshift64 (Marsaglia 2003) */
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state;
}

/* A finite double with an exponent between -`spread` and `spread`; often a short one, sometimes zero. */
static double random_double(int spread) {
    const uint64_t r = next_random();
    if (r % 11 == 0) return 0;
    const double mantissa =
        r % 3 == 0 ? (double)(int64_t)(r >> 60) - 8 : (double)(int64_t)(next_random() >> 11);
    const double value = ldexp(mantissa, (int)(next_random() % (uint64_t)(2 * spread + 1)) - spread - 52);
    return (next_random() & 1) != 0 ? value : -value;
}

START_TEST(signs_are_exact) {
    static const int spreads[] = {0, 3, 60, 400, 1020};
    const uint32_t tet[] = {0, 1, 2, 3};
    int flat = 0, hard = 0;
    for (int round = 0; round < 20000; ++round) {
        const int spread = spreads[round % 5];
        double p[12];
        for (int i = 0; i < 12; ++i) p[i] = random_double(spread);
        if (round % 2) { /* flat, or off by a rounding error: d is a combination of a, b, c */
            const double s = (double)(next_random() % 8) / 4, t = (double)(next_random() % 8) / 4;
            for (int k = 0; k < 3; ++k) {
                p[9 + k] = p[k] + s * (p[3 + k] - p[k]) + t * (p[6 + k] - p[k]);
                if (!isfinite(p[9 + k])) p[9 + k] = 0;
            }
            if (round % 4 == 1) p[9] = nextafter(p[9], round % 8 == 1 ? DBL_MAX : -DBL_MAX);
            ++hard;
        }
        for (int i = 0; i < 12; ++i)
            if (!isfinite(p[i])) p[i] = DBL_MAX;
        const vox_io_report r = report_of_arrays(p, 4, tet, 1, NULL, 0);
        const int found = r.inverted_tets ? -1 : r.degenerate_tets ? 0 : 1;
        ck_assert_msg(found == oracle_sign(p), "round %d: %d instead of %d", round, found, oracle_sign(p));
        flat += found == 0;
    }
    ck_assert_int_gt(flat, 300);
    ck_assert_int_gt(hard - flat, 500);
}
END_TEST

START_TEST(report_sizes) {
    vox_io_mesh* mesh = made(corner, 4, (const uint32_t[]){0, 1, 2, 3}, 1, NULL, 0);
    vox_io_report full, part;
    memset(&part, 0xab, sizeof part);
    full = report_of(mesh);
    part.struct_size = (uint32_t)offsetof(vox_io_report, tets);
    ck_ok(vox_io_mesh_get_report(mesh, &part));
    ck_assert_uint_eq(part.vertices, 4);
    ck_assert_uint_eq(part.tets, 0xababababababababu);
    struct {
        vox_io_report report;
        uint64_t more;
    } larger;
    memset(&larger, 0xab, sizeof larger);
    larger.report.struct_size = (uint32_t)sizeof larger;
    ck_ok(vox_io_mesh_get_report(mesh, &larger.report));
    ck_assert_uint_eq(larger.report.tets, full.tets);
    ck_assert_uint_eq(larger.more, 0xababababababababu);
    part.struct_size = 0;
    ck_fails(vox_io_mesh_get_report(mesh, &part), VOX_ERROR_INVALID_ARGUMENT, "struct_size");
    ck_fails(vox_io_mesh_get_report(mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "null");
    ck_fails(vox_io_mesh_get_report(NULL, &full), VOX_ERROR_INVALID_ARGUMENT, "mesh");
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(bad_arguments) {
    vox_io_mesh* const untouched = (vox_io_mesh*)(void*)&random_state;
    vox_io_mesh* mesh = untouched;
    vox_io_load_desc desc, good;
    good = vox_default_io_load_desc();
    ck_assert_uint_eq(good.mesh, 0);
    const char text[] = "$MeshFormat";
    const vox_io_source source = {NULL, text, sizeof text - 1}, no_data = {"x.msh", NULL, 5},
                        empty = {"x.msh", NULL, 0};

    ck_fails(vox_io_load(NULL, NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "path");
    ck_fails(vox_io_load("x.msh", NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh");
    ck_fails(vox_io_read(NULL, 1, NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "sources");
    ck_fails(vox_io_read(&source, 0, NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "source_count");
    ck_fails(vox_io_read(&source, 3, NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "source_count");
    ck_fails(vox_io_read(&source, 1, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh");
    ck_fails(vox_io_read(&no_data, 1, NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "data");
    ck_fails(vox_io_read(&empty, 1, NULL, &mesh), VOX_ERROR_FORMAT, "empty");
    ck_fails(vox_io_read(&source, 1, NULL, &mesh), VOX_ERROR_FORMAT, "source 0");
    desc = good;
    desc.format = (vox_io_format)99;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "format");
    desc = good;
    desc.flags = 4;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "flags is 0x4");
    desc = good;
    desc.format = VOX_IO_FORMAT_TETGEN;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "two sources");
    desc.format = VOX_IO_FORMAT_GMSH;
    const vox_io_source two[2] = {source, source};
    ck_fails(vox_io_read(two, 2, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "source_count");

    ck_fails(vox_io_mesh_get_arrays(NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "mesh");
    vox_io_mesh_view view = {corner, 4, NULL, 0, NULL, 0, NULL, NULL, NULL};
    ck_fails(vox_io_mesh_create(NULL, &mesh), VOX_ERROR_INVALID_ARGUMENT, "arrays");
    ck_fails(vox_io_mesh_create(&view, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh");
    view.positions = NULL;
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_INVALID_ARGUMENT, "positions");
    view.positions = corner;
    view.tet_count = 1;
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_INVALID_ARGUMENT, "tets");
    view.tets = (const uint32_t[]){0, 1, 2, 4};
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_INVALID_MESH, "tet 0 names vertex 4 of 4");
    view.tet_count = UINT64_MAX;
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_LIMIT, "tets");
    view.tet_count = 0;
    view.triangles = (const uint32_t[]){0, 1, 2, 0, 1, 9};
    view.triangle_count = 2;
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_INVALID_MESH, "triangle 1 names vertex 9 of 4");
    view.vertex_count = UINT64_MAX;
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_LIMIT, "positions");
    view.vertex_count = 4;
    view.triangle_count = 0;
    view.positions = (const double[]){0, 0, 0, 0, 0, INFINITY, 0, 0, 0, 0, 0, 0};
    ck_fails(vox_io_mesh_create(&view, &mesh), VOX_ERROR_NON_FINITE, "vertex 1");

    ck_assert_ptr_eq(mesh, untouched);
    vox_io_mesh_destroy(NULL);
    ck_assert_ptr_null(vox_io_mesh_get_warnings(NULL));
    for (int f = -1; f <= 8; ++f)
        ck_assert_str_ne(vox_io_format_string((vox_io_format)(f < 0 ? 1000 : f)), "");
}
END_TEST

START_TEST(no_files) {
    vox_io_mesh* mesh = NULL;
    ck_fails(vox_io_load("no/such/file.msh", NULL, &mesh), VOX_ERROR_FILE, "no/such/file.msh");
    ck_fails(vox_io_load("", NULL, &mesh), VOX_ERROR_FILE, "");
    ck_fails(vox_io_load(VOX_TEST_DATA, NULL, &mesh), VOX_ERROR_FILE, "directory");
    ck_fails(vox_io_load(VOX_TEST_DATA "/make.py", NULL, &mesh), VOX_ERROR_UNSUPPORTED, "extension");
#ifdef __unix__
    ck_fails(vox_io_load("/dev/null", NULL, &mesh), VOX_ERROR_FILE, "regular");
    mkdir("vox_test_directory.msh", 0700);
    ck_fails(vox_io_load("vox_test_directory.msh", NULL, &mesh), VOX_ERROR_FILE, "directory");
    rmdir("vox_test_directory.msh");
    FILE* file = fopen("vox_test_unreadable.msh", "wb");
    fputs("$MeshFormat\n", file);
    fclose(file);
    chmod("vox_test_unreadable.msh", 0);
    const vox_result result = vox_io_load("vox_test_unreadable.msh", NULL, &mesh);
    if (geteuid() == 0) /* who may read everything */
        ck_assert_int_eq(result, VOX_ERROR_FORMAT);
    else
        ck_assert_int_eq(result, VOX_ERROR_FILE);
    ck_assert_ptr_nonnull(strstr(vox_last_error(), "vox_test_unreadable.msh"));
    remove("vox_test_unreadable.msh");
#endif
    ck_assert_ptr_null(mesh);
}
END_TEST

/* Told by content whatever the name is; only then by the name. */
START_TEST(content_before_name) {
    static const struct {
        const char* file;
        vox_io_format format;
    } rows[] = {{"box_22.msh", VOX_IO_FORMAT_GMSH},       {"box_41_big.msh", VOX_IO_FORMAT_GMSH},
                {"box.mesh", VOX_IO_FORMAT_MEDIT},        {"box.veg", VOX_IO_FORMAT_VEGA},
                {"box_51_binary.vtk", VOX_IO_FORMAT_VTK}, {"box_appended.vtu", VOX_IO_FORMAT_VTU},
                {"box.inp", VOX_IO_FORMAT_ABAQUS}};
    static const char* const names[] = {NULL, "noname", "x.msh", "x.vtk", "x.obj", "a.b/c"};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        bytes file = read_file(VOX_TEST_DATA, rows[i].file);
        for (size_t n = 0; n < sizeof names / sizeof *names; ++n) {
            const vox_io_source source = {names[n], file.data, file.size};
            vox_io_mesh* mesh = NULL;
            ck_ok(vox_io_read(&source, 1, NULL, &mesh));
            ck_assert_int_eq(report_of(mesh).format, rows[i].format);
            vox_io_mesh_destroy(mesh);
        }
        /* Asked for as another format it is refused. */
        vox_io_load_desc desc = vox_default_io_load_desc();
        desc.format = rows[i].format == VOX_IO_FORMAT_VTK ? VOX_IO_FORMAT_GMSH : VOX_IO_FORMAT_VTK;
        const vox_io_source source = {"named", file.data, file.size};
        vox_io_mesh* mesh = NULL;
        ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_FORMAT, "named, line 1");
        free(file.data);
    }
}
END_TEST

/* TetGen's two files in either order, with and without names. */
START_TEST(two_sources) {
    bytes node = read_file(VOX_TEST_DATA, "box.node"), ele = read_file(VOX_TEST_DATA, "box.ele");
    for (int order = 0; order < 3; ++order) {
        const vox_io_source a = {order == 2 ? NULL : "b.node", node.data, node.size},
                            b = {order == 2 ? NULL : "b.ele", ele.data, ele.size};
        const vox_io_source sources[2] = {order == 1 ? b : a, order == 1 ? a : b};
        vox_io_mesh* mesh = NULL;
        ck_ok(vox_io_read(sources, 2, NULL, &mesh));
        ck_assert_uint_eq(report_of(mesh).tets, 10);
        vox_io_mesh_destroy(mesh);
    }
    free(node.data);
    free(ele.data);
}
END_TEST

START_TEST(surfaces_from_path_and_memory) {
    static const char* const files[] = {"cube.obj", "cube.off", "cube.ply", "cube.stl"};
    vox_io_mesh *mesh = NULL, *again = NULL;
    for (int i = 0; i < 4; ++i) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", VOX_TEST_DATA, files[i]);
        bytes file = read_file(VOX_TEST_DATA, files[i]);
        const vox_io_source source = {files[i], file.data, file.size};
        ck_ok(vox_io_load(path, NULL, &mesh));
        ck_ok(vox_io_read(&source, 1, NULL, &again));
        check_same(mesh, again);
        const vox_io_report r = report_of(mesh);
        /* Vertices that a format repeats for every facet or material are one again: the cube is closed. */
        ck_assert_uint_eq(r.vertices, 8);
        ck_assert_uint_eq(r.triangles, 12);
        ck_assert_uint_eq(r.open_edges + r.misoriented_edges + r.non_manifold_facets, 0);
        ck_assert(close_to(r.volume, 1, 1e-12));
        ck_assert_double_eq(r.unit_in_metres, 0);
        vox_io_mesh_destroy(mesh);
        vox_io_mesh_destroy(again);
        free(file.data);
    }
    const char nothing[] = "# a normal alone\nvn 0 0 1\n";
    const vox_io_source source = {"nothing.obj", nothing, sizeof nothing - 1};
    mesh = NULL;
    ck_fails(vox_io_read(&source, 1, NULL, &mesh), VOX_ERROR_FORMAT, "nothing.obj");
}
END_TEST

/* OFF as other programs write it: faces over several lines, a quadrilateral, colours and normals, comments,
 * CRLF, no extension to go by; and what must be refused. Cut anywhere, it is an error or a sound mesh. */
START_TEST(off_variants) {
    static const char* const good[] = {"OFF\n5 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 1\n4 0 \n3 \n\n2 "
                                       "\n1\n3 0\n1\n4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n",
                                       "# a pyramid\r\nCNOFF 5 5 8 # counts\r\n0 0 0 0 0 1 255 0 0\r\n1 0 0 "
                                       "0 0 1 255 0 0\r\n1 1 0 0 0 1 255 0 0\r\n"
                                       "0 1 0 0 0 1 255 0 0\r\n.5 .5 1 0 0 1 255 0 0\r\n4 0 3 2 1\r\n3 0 1 4 "
                                       "1 0 0\r\n3 1 2 4\r\n3 2 3 4\r\n3 3 0 4"};
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 4\n", "line 7: expected a vertex number from 0 to 3"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n", "line 5: expected a coordinate"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "line 6: number of corners"},
        {"OFF\n999999999999 1 0\n0 0 0\n", "line 2"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "expected triangles, found none"},
        {"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "expected triangles"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", "line 7: expected the end of the file"},
        {"4OFF\n3 1 0\n0 0 0 1\n1 0 0 0\n0 1 0 1\n3 0 1 2\n", "line 4: expected a fourth coordinate"},
        {"OFF BINARY\n3 1 0\n", "BINARY"}};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) {
        const size_t size = strlen(good[i]);
        for (size_t cut = 0; cut <= size; ++cut) {
            char* copy = (char*)malloc(cut ? cut : 1); /* a sanitizer sees what is read beyond it */
            memcpy(copy, good[i], cut);
            const vox_io_source source = {"pyramid", copy, cut};
            vox_io_mesh* mesh = NULL;
            if (vox_io_read(&source, 1, NULL, &mesh) == VOX_OK) {
                check_sound(mesh);
                const vox_io_report r = report_of(mesh);
                ck_assert_uint_eq(r.format, VOX_IO_FORMAT_SURFACE);
                ck_assert_uint_eq(r.triangles, 6);
                if (cut == size) ck_assert_uint_eq(r.vertices, 5);
                if (cut == size) ck_assert_uint_eq(r.open_edges, 0);
                vox_io_mesh_destroy(mesh);
            } else {
                ck_assert_uint_lt(cut, size);
            }
            free(copy);
        }
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        const vox_io_source source = {"bad.off", bad[i].text, strlen(bad[i].text)};
        vox_io_mesh* mesh = NULL;
        const vox_result result = vox_io_read(&source, 1, NULL, &mesh);
        ck_assert(result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED);
        ck_assert_msg(strstr(vox_last_error(), bad[i].words), "%s", vox_last_error());
        ck_assert_ptr_null(mesh);
    }
}
END_TEST

/* Node transforms are applied, a mirrored one keeps its outside, and one mesh of several can be taken. */
START_TEST(scenes) {
    const char* path = VOX_TEST_DATA "/two_tetrahedra.gltf";
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_load(path, NULL, &mesh));
    vox_io_report r = report_of(mesh);
    ck_assert_uint_eq(r.components, 2);
    ck_assert(close_to(r.volume, 1.0 / 6 + 8.0 / 6, 1e-6));
    ck_assert_double_eq(r.bounds_max[0], 11);
    ck_assert_double_eq(r.bounds_min[0], -2);
    ck_assert_double_eq(r.unit_in_metres, 1);
    vox_io_mesh_destroy(mesh);

    bytes file = read_file(VOX_TEST_DATA, "cube.obj");
    const vox_io_source source = {"cube.obj", file.data, file.size};
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.mesh = 4; /* a side: assimp makes a mesh of each material */
    ck_ok(vox_io_read(&source, 1, &desc, &mesh));
    r = report_of(mesh);
    ck_assert_uint_eq(r.triangles, 2);
    ck_assert_uint_eq(r.open_edges, 4);
    ck_assert_ptr_nonnull(strstr(vox_io_mesh_get_warnings(mesh), "open"));
    vox_io_mesh_destroy(mesh);
    desc.mesh = 7;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "holds 6");
    free(file.data);
}
END_TEST

SUITE(io_diagnosis) {
    TCase* tests = add_case(suite, "diagnosis");
    tcase_add_each(tests, tets, closed_and_open_surfaces, empty_meshes_and_points, signs_are_exact,
                   report_sizes, bad_arguments, no_files, content_before_name, two_sources,
                   surfaces_from_path_and_memory, off_variants, scenes);
}
