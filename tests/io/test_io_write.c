/* What is written reads back the same, bit for bit, in every format; failures leave what was there. */
#include "support/io_files.h"

#include <float.h>

static const struct {
    vox_io_write_format format;
    uint32_t binary;
    const char* extension;
} ways[] = {{VOX_IO_WRITE_MSH_22, 0, "msh"}, {VOX_IO_WRITE_MSH_22, 1, "msh"}, {VOX_IO_WRITE_MSH_41, 0, "msh"},
            {VOX_IO_WRITE_MSH_41, 1, "msh"}, {VOX_IO_WRITE_VTU, 0, "vtu"},    {VOX_IO_WRITE_VTU, 1, "vtu"}};
enum { way_count = sizeof ways / sizeof *ways };

/* A sink that keeps what it gets, and fails when `pieces_left` are used up. */
typedef struct keeper {
    bytes kept;
    int pieces_left;
} keeper;

static int32_t keep(const void* data, size_t size, void* user) {
    keeper* k = (keeper*)user;
    if (k->pieces_left-- == 0) return 1;
    k->kept.data = (unsigned char*)realloc(k->kept.data, k->kept.size + size + 1);
    memcpy(k->kept.data + k->kept.size, data, size);
    k->kept.size += size;
    k->kept.data[k->kept.size] = 0;
    return 0;
}

static vox_io_write_desc way_desc(int way) {
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = ways[way].format;
    desc.binary = ways[way].binary;
    return desc;
}

static bytes written(const vox_io_mesh* mesh, const vox_io_write_desc* desc) {
    keeper k = {{NULL, 0}, -1};
    const vox_io_sink sink = {keep, &k};
    ck_ok(vox_io_write_to(mesh, desc, &sink));
    ck_assert_ptr_nonnull(k.kept.data);
    return k.kept;
}

static vox_io_mesh* made(const double* positions, uint64_t vertices, const uint32_t* tets, uint64_t tet_count,
                         const uint32_t* triangles, uint64_t triangle_count) {
    const vox_io_mesh_view arrays = {positions,      vertices, tets, tet_count, triangles,
                                     triangle_count, NULL,     NULL, NULL};
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_mesh_create(&arrays, &mesh));
    return mesh;
}

/* Doubles of every size, which no text of fewer digits than needed gives back. */
static vox_io_mesh* hard_mesh(void) {
    static const double positions[] = {
        0.1,       1.0 / 3, -0.0,     DBL_MAX,  DBL_MIN, 4.9406564584124654e-324,
        -1e-5,     1e22,    123456.7, -DBL_MAX, 5,       2.2250738585072011e-308,
        1 + 1e-15, 1e100,   -7e-300};
    static const uint32_t tets[] = {0, 1, 2, 3, 4, 3, 2, 1}, triangles[] = {0, 1, 4};
    return made(positions, 5, tets, 2, triangles, 1);
}

START_TEST(round_trip) {
    vox_io_mesh* meshes[2] = {hard_mesh(), NULL};
    ck_ok(vox_io_make_lattice_ball(30000, 1.25, &meshes[1])); /* larger than any buffer of a writer */
    for (int m = 0; m < 2; ++m) {
        vox_io_mesh_view view;
        ck_ok(vox_io_mesh_get_arrays(meshes[m], &view));
        const vox_io_point_data data[2] = {{"position & <moved>", view.positions, 3, 0},
                                           {"depth", view.positions, 1, 0}};
        for (int with_data = 0; with_data < 2; ++with_data) {
            vox_io_write_desc desc = way_desc(_i);
            desc.point_data = data;
            desc.point_data_count = with_data ? 2 : 0;
            bytes file = written(meshes[m], &desc);
            const vox_io_source source = {ways[_i].extension, file.data, file.size};
            vox_io_mesh* again = NULL;
            ck_ok(vox_io_read(&source, 1, NULL, &again));
            check_same(meshes[m], again);
            vox_io_mesh_destroy(again);
            free(file.data);
        }
        vox_io_mesh_destroy(meshes[m]);
    }
}
END_TEST

/* The values on the vertices are in the file, under their names. */
START_TEST(point_data) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, depths[] = {0.25, 0, -1.5, 1e-7};
    static const uint32_t tet[] = {0, 1, 2, 3};
    vox_io_mesh* mesh = made(positions, 4, tet, 1, NULL, 0);
    const vox_io_point_data data = {"a<b", depths, 1, 0};
    vox_io_write_desc desc = way_desc(_i);
    desc.point_data = &data;
    desc.point_data_count = 1;
    bytes file = written(mesh, &desc);
    const int vtu = desc.format == VOX_IO_WRITE_VTU;
    const char* name =
        strstr((const char*)file.data, vtu ? "Name=\"a&lt;b\"" : "$NodeData\n1\n\"a<b\"\n1\n0\n3\n0\n1\n4\n");
    /* In a binary file the name may stand behind a zero byte. */
    for (size_t i = 0; !name && i < file.size; ++i)
        name = strstr((const char*)file.data + i, vtu ? "Name=\"a&lt;b\"" : "\"a<b\"\n1\n0\n3\n0\n1\n4\n");
    ck_assert_ptr_nonnull(name);
    if (!desc.binary) {
        ck_assert_ptr_nonnull(
            strstr(name, vtu ? "\n0.25\n0\n-1.5\n1e-07\n" : "\n1 0.25\n2 0\n3 -1.5\n4 1e-07\n"));
    } else {
        size_t found = 0;
        unsigned char pattern[8];
        memcpy(pattern, &depths[2], 8);
        for (size_t i = 0; i + 8 <= file.size; ++i) found += memcmp(file.data + i, pattern, 8) == 0;
        ck_assert_uint_eq(found, 1);
    }
    free(file.data);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(surface_alone) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t triangle[] = {0, 1, 2};
    vox_io_mesh* mesh = made(positions, 3, NULL, 0, triangle, 1);
    for (int way = 0; way < way_count; ++way) {
        const vox_io_write_desc desc = way_desc(way);
        bytes file = written(mesh, &desc);
        const vox_io_source source = {ways[way].extension, file.data, file.size};
        vox_io_mesh* again = NULL;
        ck_fails(vox_io_read(&source, 1, NULL, &again), VOX_ERROR_FORMAT, "but 1 triangle");
        free(file.data);
    }
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(failing_sink) {
    vox_io_mesh* ball = NULL;
    ck_ok(vox_io_make_lattice_ball(30000, 1, &ball));
    for (int way = 0; way < way_count; ++way) {
        const vox_io_write_desc desc = way_desc(way);
        for (int pieces = 0; pieces < 3; ++pieces) {
            keeper k = {{NULL, 0}, pieces};
            const vox_io_sink sink = {keep, &k};
            ck_fails(vox_io_write_to(ball, &desc, &sink), VOX_ERROR_FILE, "sink");
            free(k.kept.data);
        }
    }
    vox_io_mesh_destroy(ball);
}
END_TEST

START_TEST(files) {
    /* The last two in UTF-8: wuerfel, with its umlaut, and the Chinese for cube. */
    static const char* const names[] = {"vox_test_io_write.msh", "vox_test_io_write.vtu",
                                        "vox_test_w\xc3\xbcrfel.msh",
                                        "vox_test_\xe7\xab\x8b\xe6\x96\xb9\xe4\xbd\x93.vtu"};
    vox_io_mesh *mesh = hard_mesh(), *again = NULL;
    for (int i = 0; i < 4; ++i) {
        FILE* old = fopen(names[i], "wb");
        fputs("old", old);
        fclose(old);
        ck_ok(vox_io_write(mesh, names[i], NULL));
        ck_ok(vox_io_load(names[i], NULL, &again));
        check_same(mesh, again);
        vox_io_mesh_destroy(again);
        remove(names[i]);
    }
    /* A failure leaves what stood there, and nothing else. */
    FILE* old = fopen(names[0], "wb");
    fputs("old", old);
    fclose(old);
    static const double values[] = {0, 0, 0, 0, NAN};
    const vox_io_point_data bad = {"bad", values, 1, 0};
    vox_io_write_desc desc = way_desc(0);
    desc.point_data = &bad;
    desc.point_data_count = 1;
    ck_fails(vox_io_write(mesh, names[0], &desc), VOX_ERROR_NON_FINITE, "vertex 4");
    bytes kept = read_file(".", names[0]);
    ck_assert_str_eq((const char*)kept.data, "old");
    free(kept.data);
    remove(names[0]);
    ck_fails(vox_io_write(mesh, "no/such/folder/x.msh", NULL), VOX_ERROR_FILE, "no/such/folder/x.msh");
    ck_assert_ptr_null(strstr(vox_last_error(), ".part")); /* the name that the caller gave */
    ck_fails(vox_io_load("no \xe7\xab\x8b.msh", NULL, &again), VOX_ERROR_FILE, "no \xe7\xab\x8b.msh: ");
    ck_fails(vox_io_write(mesh, ".", &desc), VOX_ERROR_NON_FINITE, "bad");
    desc.point_data_count = 0;
    ck_fails(vox_io_write(mesh, ".", &desc), VOX_ERROR_FILE, "irectory");
    ck_fails(vox_io_write(mesh, "x.stl", NULL), VOX_ERROR_UNSUPPORTED, ".vtu");
    ck_fails(vox_io_write(mesh, "x", NULL), VOX_ERROR_UNSUPPORTED, ".msh");
#ifdef __linux__
    ck_fails(vox_io_write(mesh, "/dev/full", &desc), VOX_ERROR_FILE, "/dev/full");
#endif
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* The values on the cells are in the file, triangles first, and are checked as those on the vertices. */
START_TEST(cell_data) {
    static const double values[] = {-3, 0.5, 1e-7, NAN};
    vox_io_mesh* mesh = hard_mesh(); /* one triangle, two tets */
    vox_io_point_data data = {"inside", values, 1, 0};
    vox_io_write_desc desc = way_desc(_i);
    desc.cell_data = &data;
    desc.cell_data_count = 1;
    bytes file = written(mesh, &desc);
    const int vtu = desc.format == VOX_IO_WRITE_VTU;
    size_t named = 0, found = 0;
    const char* name = vtu ? "Name=\"inside\"" : "$ElementData\n1\n\"inside\"\n1\n0\n3\n0\n1\n3\n";
    const char* text = vtu ? "\n-3\n0.5\n1e-07\n" : "\n1 -3\n2 0.5\n3 1e-07\n";
    for (size_t i = 0; i < file.size; ++i) {
        named += i + strlen(name) <= file.size && memcmp(file.data + i, name, strlen(name)) == 0;
        if (!desc.binary)
            found += i + strlen(text) <= file.size && memcmp(file.data + i, text, strlen(text)) == 0;
        else
            found +=
                i + sizeof(double) <= file.size && memcmp(file.data + i, &values[2], sizeof(double)) == 0;
    }
    ck_assert_uint_eq(named, 1);
    ck_assert_uint_ge(found, 1);
    const vox_io_source source = {ways[_i].extension, file.data, file.size};
    vox_io_mesh* again = NULL;
    ck_ok(vox_io_read(&source, 1, NULL, &again));
    check_same(mesh, again);
    vox_io_mesh_destroy(again);
    free(file.data);

    keeper k = {{NULL, 0}, -1};
    const vox_io_sink sink = {keep, &k};
    data.values = values + 1;
    ck_fails(vox_io_write_to(mesh, &desc, &sink), VOX_ERROR_NON_FINITE,
             "cell_data[0] (inside) is not finite at cell 2");
    data.values = NULL;
    ck_fails(vox_io_write_to(mesh, &desc, &sink), VOX_ERROR_INVALID_ARGUMENT, "cell_data[0].values");
    desc.cell_data = NULL;
    ck_fails(vox_io_write_to(mesh, &desc, &sink), VOX_ERROR_INVALID_ARGUMENT, "cell_data");
    ck_assert_ptr_null(k.kept.data);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(bad_arguments) {
    vox_io_mesh* mesh = hard_mesh();
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    keeper k = {{NULL, 0}, -1};
    const vox_io_sink sink = {keep, &k}, no_write = {NULL, NULL};
    vox_io_write_desc desc = way_desc(0);
    ck_fails(vox_io_write(NULL, "x.msh", NULL), VOX_ERROR_INVALID_ARGUMENT, "mesh");
    ck_fails(vox_io_write(mesh, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "path");
    ck_fails(vox_io_write_to(NULL, &desc, &sink), VOX_ERROR_INVALID_ARGUMENT, "mesh");
    ck_fails(vox_io_write_to(mesh, &desc, NULL), VOX_ERROR_INVALID_ARGUMENT, "sink");
    ck_fails(vox_io_write_to(mesh, &desc, &no_write), VOX_ERROR_INVALID_ARGUMENT, "sink");
    ck_fails(vox_io_write_to(mesh, NULL, &sink), VOX_ERROR_INVALID_ARGUMENT, "AUTO");

    vox_io_write_desc bad = desc;
    bad.format = (vox_io_write_format)99;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "format");
    bad = desc;
    bad.binary = 2;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "binary");
    bad = desc;
    bad.reserved = 1;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "reserved");
    bad = desc;
    bad.point_data_count = 1;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "point_data");
    bad.struct_size = 3;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "struct_size");

    static const struct {
        const char* name;
        uint32_t components, reserved;
        const char* words;
    } rows[] = {{NULL, 1, 0, "name"},   {"", 1, 0, "name"},        {"a\"b", 1, 0, "name"},
                {"a\nb", 1, 0, "name"}, {"a", 0, 0, "components"}, {"a", 2, 0, "components"},
                {"a", 1, 5, "reserved"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        const vox_io_point_data data = {rows[i].name, view.positions, rows[i].components, rows[i].reserved};
        bad = desc;
        bad.point_data = &data;
        bad.point_data_count = 1;
        ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, rows[i].words);
    }
    const vox_io_point_data no_values = {"a", NULL, 1, 0};
    bad.point_data = &no_values;
    ck_fails(vox_io_write_to(mesh, &bad, &sink), VOX_ERROR_INVALID_ARGUMENT, "values");
    ck_assert_ptr_null(k.kept.data); /* nothing was written by then */

    /* An old program knows fewer fields: what it does not cover keeps its default. */
    bad = desc;
    bad.point_data_count = 1;
    bad.struct_size = (uint32_t)offsetof(vox_io_write_desc, point_data);
    ck_ok(vox_io_write_to(mesh, &bad, &sink));
    free(k.kept.data);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* Enums are 32 bits of the caller's, also those that a C++ compiler may take to be impossible. */
START_TEST(enums_of_any_bits) {
    static const int32_t values[] = {99, -1, INT32_MAX, INT32_MIN};
    const vox_io_source source = {"a.mesh", "", 0};
    vox_io_mesh *mesh = hard_mesh(), *made_of = NULL;
    keeper k = {{NULL, 0}, -1};
    const vox_io_sink sink = {keep, &k};
    vox_io_load_desc load;
    vox_io_write_desc desc = way_desc(0);
    vox_io_tetrahedralize_desc solid;
    load = vox_default_io_load_desc();
    solid = vox_default_io_tetrahedralize_desc();
    for (int i = 0; i < 4; ++i) {
        char expected[32];
        vox_io_format format;
        snprintf(expected, sizeof expected, " is %d,", (int)values[i]);
        memcpy(&load.format, &values[i], sizeof values[i]);
        memcpy(&desc.format, &values[i], sizeof values[i]);
        memcpy(&solid.kind, &values[i], sizeof values[i]);
        memcpy(&format, &values[i], sizeof values[i]);
        ck_fails(vox_io_read(&source, 1, &load, &made_of), VOX_ERROR_INVALID_ARGUMENT, expected);
        ck_fails(vox_io_write_to(mesh, &desc, &sink), VOX_ERROR_INVALID_ARGUMENT, expected);
        ck_fails(vox_io_tetrahedralize(mesh, &solid, &made_of), VOX_ERROR_INVALID_ARGUMENT, expected);
        ck_assert_str_eq(vox_io_format_string(format), "unknown format");
    }
    ck_assert_ptr_null(made_of);
    vox_io_mesh_destroy(mesh);
}
END_TEST

SUITE(io_write) {
    TCase* tests = add_case(suite, "write");
    tcase_add_loop_test(tests, round_trip, 0, way_count);
    tcase_add_loop_test(tests, point_data, 0, way_count);
    tcase_add_loop_test(tests, cell_data, 0, way_count);
    tcase_add_each(tests, surface_alone, failing_sink, files, bad_arguments, enums_of_any_bits);
}
