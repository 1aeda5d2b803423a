/* Files for the tests of vox_io: reading them whole, the folder of test meshes, and what every mesh must be.
 */
#ifndef VOX_TESTS_IO_FILES_H
#define VOX_TESTS_IO_FILES_H

#include "support/suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <vox/vox_io.h>

typedef struct bytes {
    unsigned char* data; /* ends with a 0 that size does not count */
    size_t size;
} bytes;

/* The file at folder/name; data is null where there is none. */
static inline bytes read_file(const char* folder, const char* name) {
    char path[1024];
    bytes out = {NULL, 0};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE* file = fopen(path, "rb");
    if (!file) return out;
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    fseek(file, 0, SEEK_SET);
    if (size >= 0) {
        out.size = (size_t)size;
        out.data = (unsigned char*)malloc(out.size + 1);
        if (fread(out.data, 1, out.size, file) != out.size) abort();
        out.data[out.size] = 0;
    }
    fclose(file);
    return out;
}

static inline const char* extension_of(const char* name) {
    const char* dot = strrchr(name, '.');
    return dot ? dot + 1 : "";
}

/* The other file of a TetGen pair; the caller frees it. */
static inline char* partner_of(const char* name) {
    const int is_node = strcmp(extension_of(name), "node") == 0;
    char* out = (char*)malloc(strlen(name) + 2);
    const size_t stem = strlen(name) - strlen(extension_of(name));
    memcpy(out, name, stem);
    strcpy(out + stem, is_node ? "ele" : "node");
    return out;
}

static inline int is_tetgen(const char* name) {
    return strcmp(extension_of(name), "node") == 0 || strcmp(extension_of(name), "ele") == 0;
}

static inline vox_io_report report_of(const vox_io_mesh* mesh) {
    vox_io_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = (uint32_t)sizeof report;
    ck_ok(vox_io_mesh_get_report(mesh, &report));
    return report;
}

/* Checks any mesh that was read: indices name vertices, positions are finite, the report agrees with the
 * arrays. */
static inline void check_sound(const vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    int unsound = 0; /* a single assertion, as each costs far more than its check */
    for (uint64_t i = 0; i < 3 * view.vertex_count; ++i) unsound |= !isfinite(view.positions[i]);
    for (uint64_t i = 0; i < 4 * view.tet_count; ++i) unsound |= view.tets[i] >= view.vertex_count;
    for (uint64_t i = 0; i < 3 * view.triangle_count; ++i) unsound |= view.triangles[i] >= view.vertex_count;
    ck_assert_int_eq(unsound, 0);
    const vox_io_report report = report_of(mesh);
    ck_assert_uint_eq(report.vertices, view.vertex_count);
    ck_assert_uint_eq(report.tets, view.tet_count);
    ck_assert_uint_eq(report.triangles, view.triangle_count);
    ck_assert(!isnan(report.volume));
    ck_assert_ptr_nonnull(vox_io_mesh_get_warnings(mesh));
}

/* Checks for equal vertices, tets and triangles, bit for bit. */
static inline void check_same(const vox_io_mesh* a, const vox_io_mesh* b) {
    vox_io_mesh_view p, q;
    ck_ok(vox_io_mesh_get_arrays(a, &p));
    ck_ok(vox_io_mesh_get_arrays(b, &q));
    ck_assert_uint_eq(p.vertex_count, q.vertex_count);
    ck_assert_uint_eq(p.tet_count, q.tet_count);
    ck_assert_uint_eq(p.triangle_count, q.triangle_count);
    ck_assert(!p.vertex_count || !memcmp(p.positions, q.positions, 24 * p.vertex_count));
    ck_assert(!p.tet_count || !memcmp(p.tets, q.tets, 16 * p.tet_count));
    ck_assert(!p.triangle_count || !memcmp(p.triangles, q.triangles, 12 * p.triangle_count));
}

static inline int close_to(double a, double b, double relative) {
    return fabs(a - b) <= relative * fmax(fabs(a), fabs(b));
}

#endif
