/* The progress of loading: from 0 to 1 and never back, in small steps, for every format; whoever cancels gets
 * no mesh, and no memory is lost. */
#include "support/io_files.h"
#include "support/ledger.h"

#include <stdarg.h>
#include <stddef.h>

/* A row of vertices. Tet i has the corners i to i + 3, triangle i has i to i + 2. */
enum { tet_count = 40000, vertex_count = tet_count + 3, triangle_count = tet_count + 1 };

static double coordinate(int vertex, int axis) { return axis == 0 ? vertex : (vertex * (3 + axis)) % 7; }

/* ---- files in memory, each longer than a few of the pieces after which readers report ---- */

typedef struct file {
    const char* name;
    char* data;
    size_t size, room;
} file;

static void add(file* f, const void* data, size_t size) {
    if (f->size + size > f->room) {
        f->room = 2 * (f->size + size);
        f->data = (char*)realloc(f->data, f->room);
    }
    memcpy(f->data + f->size, data, size);
    f->size += size;
}

static void say(file* f, const char* pattern, ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, pattern);
    const int length = vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    add(f, text, (size_t)length);
}

static void say_vertices(file* f, int number_from, const char* before, const char* after) {
    for (int v = 0; v < vertex_count; ++v) {
        say(f, "%s", before);
        if (number_from >= 0) say(f, "%d ", v + number_from);
        say(f, "%g %g %g%s\n", coordinate(v, 0), coordinate(v, 1), coordinate(v, 2), after);
    }
}

static void say_elements(file* f, int count, int corners, int number_from, const char* before,
                         int first_vertex, const char* after) {
    for (int e = 0; e < count; ++e) {
        say(f, "%s", before);
        if (number_from >= 0) say(f, "%d ", e + number_from);
        for (int c = 0; c < corners; ++c) say(f, "%d%s", e + c + first_vertex, c + 1 < corners ? " " : after);
        say(f, "\n");
    }
}

static void add_little_endian(file* f, uint32_t bits, int bytes) {
    for (int i = 0; i < bytes; ++i) {
        const char byte = (char)(bits >> 8 * i & 0xff);
        add(f, &byte, 1);
    }
}

static void add_float(file* f, double value) {
    const float number = (float)value;
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    add_little_endian(f, bits, 4);
}

static void add_point(file* f, int vertex) {
    for (int axis = 0; axis < 3; ++axis) add_float(f, coordinate(vertex, axis));
}

static int32_t add_piece(const void* data, size_t size, void* user) {
    add((file*)user, data, size);
    return 0;
}

static void write_tets(file* f, vox_io_write_format format, uint32_t binary) {
    double* positions = (double*)malloc(3 * sizeof(double) * vertex_count);
    uint32_t* tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * tet_count);
    for (int v = 0; v < vertex_count; ++v)
        for (int axis = 0; axis < 3; ++axis) positions[3 * v + axis] = coordinate(v, axis);
    for (int t = 0; t < 4 * tet_count; ++t) tets[t] = (uint32_t)(t / 4 + t % 4);
    const vox_io_mesh_view view = {positions, vertex_count, tets, tet_count, NULL, 0, NULL, NULL, NULL};
    const vox_io_sink sink = {add_piece, f};
    vox_io_mesh* mesh = NULL;
    vox_io_write_desc desc;
    ck_ok(vox_io_mesh_create(&view, &mesh));
    desc = vox_default_io_write_desc();
    desc.format = format;
    desc.binary = binary;
    ck_ok(vox_io_write_to(mesh, &desc, &sink));
    vox_io_mesh_destroy(mesh);
    free(positions);
    free(tets);
}

static void msh_22(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_MSH_22, 0); }
static void msh_22_binary(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_MSH_22, 1); }
static void msh_41(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_MSH_41, 0); }
static void msh_41_binary(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_MSH_41, 1); }
static void vtu(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_VTU, 0); }
static void vtu_binary(file* f, file* other) { (void)other, write_tets(f, VOX_IO_WRITE_VTU, 1); }

static void tetgen(file* node, file* ele) {
    ele->name = "row.ele";
    say(node, "%d 3 0 0\n", vertex_count);
    say_vertices(node, 0, "", "");
    say(ele, "%d 4 0\n", tet_count);
    say_elements(ele, tet_count, 4, 0, "", 0, "");
}

static void medit(file* f, file* other) {
    (void)other;
    say(f, "MeshVersionFormatted 2\nDimension 3\nVertices %d\n", vertex_count);
    say_vertices(f, -1, "", " 0");
    say(f, "Tetrahedra %d\n", tet_count);
    say_elements(f, tet_count, 4, -1, "", 1, " 0");
    say(f, "End\n");
}

static void vega(file* f, file* other) {
    (void)other;
    say(f, "*VERTICES\n%d 3 0 0\n", vertex_count);
    say_vertices(f, 1, "", "");
    say(f, "*ELEMENTS\nTET\n%d 4 0\n", tet_count);
    say_elements(f, tet_count, 4, 1, "", 1, "");
}

static void vtk(file* f, file* other) {
    (void)other;
    say(f, "# vtk DataFile Version 3.0\nrow\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n",
        vertex_count);
    say_vertices(f, -1, "", "");
    say(f, "CELLS %d %d\n", tet_count, 5 * tet_count);
    say_elements(f, tet_count, 4, -1, "4 ", 0, "");
    say(f, "CELL_TYPES %d\n", tet_count);
    for (int t = 0; t < tet_count; ++t) say(f, "10\n");
}

static void obj(file* f, file* other) {
    (void)other;
    say_vertices(f, -1, "v ", "");
    say_elements(f, triangle_count, 3, -1, "f ", 1, "");
}

static void off(file* f, file* other) {
    (void)other;
    say(f, "OFF\n%d %d 0\n", vertex_count, triangle_count);
    say_vertices(f, -1, "", "");
    say_elements(f, triangle_count, 3, -1, "3 ", 0, "");
}

static void ply_header(file* f, const char* format) {
    say(f,
        "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
        "element face %d\nproperty list uchar int vertex_indices\nend_header\n",
        format, vertex_count, triangle_count);
}

static void ply(file* f, file* other) {
    (void)other;
    ply_header(f, "ascii");
    say_vertices(f, -1, "", "");
    say_elements(f, triangle_count, 3, -1, "3 ", 0, "");
}

static void ply_binary(file* f, file* other) {
    (void)other;
    ply_header(f, "binary_little_endian");
    for (int v = 0; v < vertex_count; ++v) add_point(f, v);
    for (int t = 0; t < triangle_count; ++t) {
        add_little_endian(f, 3, 1);
        for (int c = 0; c < 3; ++c) add_little_endian(f, (uint32_t)(t + c), 4);
    }
}

static void stl(file* f, file* other) {
    (void)other;
    say(f, "solid row\n");
    for (int t = 0; t < triangle_count; ++t) {
        say(f, "facet normal 0 0 1\nouter loop\n");
        for (int v = t; v < t + 3; ++v)
            say(f, "vertex %g %g %g\n", coordinate(v, 0), coordinate(v, 1), coordinate(v, 2));
        say(f, "endloop\nendfacet\n");
    }
    say(f, "endsolid row\n");
}

static void stl_binary(file* f, file* other) {
    (void)other;
    say(f, "%-80s", "row");
    add_little_endian(f, triangle_count, 4);
    for (int t = 0; t < triangle_count; ++t) {
        add_point(f, 0); /* the normal */
        for (int c = 0; c < 3; ++c) add_point(f, t + c);
        add_little_endian(f, 0, 2);
    }
}

static const struct {
    const char* name;
    void (*make)(file* f, file* other);
} formats[] = {{"22.msh", msh_22},   {"22_binary.msh", msh_22_binary},
               {"41.msh", msh_41},   {"41_binary.msh", msh_41_binary},
               {"row.vtu", vtu},     {"binary.vtu", vtu_binary},
               {"row.node", tetgen}, {"row.mesh", medit},
               {"row.veg", vega},    {"row.vtk", vtk},
               {"row.obj", obj},     {"row.off", off},
               {"row.ply", ply},     {"binary.ply", ply_binary},
               {"row.stl", stl},     {"binary.stl", stl_binary}};
enum { format_count = sizeof formats / sizeof *formats };

/* ---- what is reported ---- */

typedef struct watched {
    double last, largest_step;
    int calls, reading; /* calls in all, and those while the file is read */
    int cancel_at;      /* this call cancels; 0: none */
} watched;

static int32_t watch(double fraction, void* user) {
    watched* w = (watched*)user;
    if (w->calls == 0) ck_assert_double_eq(fraction, 0);
    ck_assert_double_ge(fraction, w->last);
    ck_assert_double_le(fraction, 1);
    w->largest_step = fmax(w->largest_step, fraction - w->last);
    w->last = fraction;
    w->reading += fraction > 0 && fraction < 0.5;
    return ++w->calls == w->cancel_at;
}

static vox_io_load_desc watched_by(watched* w) {
    vox_io_load_desc desc = vox_default_io_load_desc();
    ck_assert_ptr_null((void*)(size_t)desc.progress);
    desc.progress = watch;
    desc.progress_user = w;
    return desc;
}

START_TEST(from_nothing_to_all) {
    file files[2] = {{formats[_i].name, NULL, 0, 0}, {NULL, NULL, 0, 0}};
    formats[_i].make(&files[0], &files[1]);
    const vox_io_source sources[2] = {{files[0].name, files[0].data, files[0].size},
                                      {files[1].name, files[1].data, files[1].size}};
    const size_t count = files[1].name ? 2 : 1;
    watched w = {0};
    vox_io_load_desc desc = watched_by(&w);
    vox_io_mesh *silent = NULL, *mesh = NULL;
    ck_ok(vox_io_read(sources, count, NULL, &silent));
    ck_ok(vox_io_read(sources, count, &desc, &mesh));
    ck_assert_uint_eq(report_of(mesh).vertices, vertex_count);
    check_same(mesh, silent);
    ck_assert_double_eq(w.last, 1);
    ck_assert_msg(w.reading >= 2, "%s: %d reports while %zu bytes were read", files[0].name, w.reading,
                  files[0].size + files[1].size);
    ck_assert_double_le(w.largest_step, 0.35);
    vox_io_mesh_destroy(silent);
    vox_io_mesh_destroy(mesh);

    ledger memory = {0};
    desc.allocator = ledger_allocator(&memory);
    const int calls = w.calls;
    for (int at = 1; at <= calls; ++at) {
        vox_io_mesh* untouched = NULL;
        w = (watched){0, 0, 0, 0, at};
        ck_fails(vox_io_read(sources, count, &desc, &untouched), VOX_ERROR_INVALID_STATE,
                 "cancelled by the progress function at ");
        ck_assert_int_eq(strncmp(vox_last_error(), "cancelled", 9), 0);
        ck_assert_int_eq(w.calls, at);
        ck_assert_ptr_null(untouched);
        ck_assert_uint_eq(memory.bytes, 0);
    }
    free(files[0].data);
    free(files[1].data);
}
END_TEST

/* Small files too, from the disk, of every format. */
START_TEST(small_files) {
    static const char* const names[] = {
        "box_22.msh",        "box.node",      "box.ele",  "box.mesh", "box.veg",
        "box_30_binary.vtk", "box_ascii.vtu", "cube.obj", "cube.stl", "two_tetrahedra.gltf",
        "two_tetrahedra.glb"};
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", VOX_TEST_DATA, names[_i]);
    watched w = {0};
    const vox_io_load_desc desc = watched_by(&w);
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_load(path, &desc, &mesh));
    ck_assert_double_eq(w.last, 1);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* A caller that was compiled before the function was added. */
START_TEST(older_descriptions) {
    vox_io_load_desc desc;
    memset(&desc, 0xff, sizeof desc);
    const vox_io_load_desc defaults = vox_default_io_load_desc();
    memcpy(&desc, &defaults, offsetof(vox_io_load_desc, progress));
    desc.struct_size = offsetof(vox_io_load_desc, progress);
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_load(VOX_TEST_DATA "/box_22.msh", &desc, &mesh)); /* what lies behind is not read */
    vox_io_mesh_destroy(mesh);
}
END_TEST

SUITE(io_progress) {
    TCase* tests = add_case(suite, "progress");
    tcase_add_loop_test(tests, from_nothing_to_all, 0, format_count);
    tcase_add_loop_test(tests, small_files, 0, 11);
    tcase_add_test(tests, older_descriptions);
}
