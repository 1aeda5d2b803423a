/* libFuzzer target: one reader of vox_io, that of the files whose extension the environment names
 * (FUZZ_EXTENSION=msh). Whatever comes in, it gives an error or a sound mesh; a mesh that was read can be
 * written and read back. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox_io.h>

#include "bytes.h"

typedef struct buffer {
    unsigned char* data;
    size_t size;
} buffer;

static int32_t append(const void* data, size_t size, void* user) {
    buffer* b = (buffer*)user;
    unsigned char* larger = (unsigned char*)realloc(b->data, b->size + size);
    if (!larger) return 1;
    memcpy(larger + b->size, data, size);
    b->data = larger;
    b->size += size;
    return 0;
}

static void check(const vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    demand(vox_io_mesh_get_arrays(mesh, &view) == VOX_OK);
    for (uint64_t i = 0; i < 3 * view.vertex_count; ++i) demand(isfinite(view.positions[i]));
    for (uint64_t i = 0; i < 4 * view.tet_count; ++i) demand(view.tets[i] < view.vertex_count);
    for (uint64_t i = 0; i < 3 * view.triangle_count; ++i) demand(view.triangles[i] < view.vertex_count);
    demand(vox_io_mesh_get_warnings(mesh) != NULL);
    if (view.tet_count == 0) return; /* a surface, which no tet reader takes back */

    static const vox_io_write_format formats[] = {VOX_IO_WRITE_MSH_22, VOX_IO_WRITE_MSH_41, VOX_IO_WRITE_VTU};
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = formats[view.vertex_count % 3];
    desc.binary = view.tet_count & 1;
    buffer out = {NULL, 0};
    const vox_io_sink sink = {append, &out};
    demand(vox_io_write_to(mesh, &desc, &sink) == VOX_OK);
    const vox_io_source source = {NULL, out.data, out.size};
    vox_io_mesh* again = NULL;
    demand(vox_io_read(&source, 1, NULL, &again) == VOX_OK);
    vox_io_mesh_view copy;
    demand(vox_io_mesh_get_arrays(again, &copy) == VOX_OK);
    demand(copy.vertex_count == view.vertex_count && copy.tet_count == view.tet_count);
    demand(memcmp(copy.positions, view.positions, 24 * view.vertex_count) == 0);
    demand(memcmp(copy.tets, view.tets, 16 * view.tet_count) == 0);
    vox_io_mesh_destroy(again);
    free(out.data);
}

static char file_name[16];
static vox_io_format format = VOX_IO_FORMAT_SURFACE;

int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerInitialize(int* argc, char*** argv) {
    static const struct {
        const char* extension;
        vox_io_format format;
    } tets[] = {{"msh", VOX_IO_FORMAT_GMSH}, {"node", VOX_IO_FORMAT_TETGEN}, {"mesh", VOX_IO_FORMAT_MEDIT},
                {"veg", VOX_IO_FORMAT_VEGA}, {"vtk", VOX_IO_FORMAT_VTK},     {"vtu", VOX_IO_FORMAT_VTU},
                {"vtp", VOX_IO_FORMAT_VTU},  {"inp", VOX_IO_FORMAT_ABAQUS}};
    const char* extension = getenv("FUZZ_EXTENSION");
    (void)argc;
    (void)argv;
    demand(extension != NULL);
    snprintf(file_name, sizeof file_name, "fuzz.%s", extension);
    for (size_t i = 0; i < sizeof tets / sizeof *tets; ++i)
        if (strcmp(tets[i].extension, extension) == 0) format = tets[i].format;
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    vox_io_source sources[2] = {{file_name, data, size}, {NULL, NULL, 0}};
    size_t count = 1;
    if (format == VOX_IO_FORMAT_TETGEN) { /* .node and .ele in one input, a line of "===" between them */
        size_t cut = 0;
        while (cut + 4 < size && memcmp(data + cut, "===\n", 4) != 0) ++cut;
        if (cut + 4 >= size) return -1;
        sources[0].size = cut;
        sources[1].data = data + cut + 4;
        sources[1].size = size - cut - 4;
        count = 2;
    }
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.format = format;
    desc.flags = size % 2 ? VOX_IO_LOAD_SPLIT_CELLS : 0;
    vox_io_mesh* mesh = NULL;
    const vox_result result = vox_io_read(sources, count, &desc, &mesh);
    if (result == VOX_OK) {
        check(mesh);
        vox_io_mesh_destroy(mesh);
    } else {
        demand(mesh == NULL && *vox_last_error() != 0);
        demand(result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED || result == VOX_ERROR_LIMIT);
    }
    return 0;
}
