/* Small files of every format, cut, bent and lied in: a reader gives an error or a sound mesh, reads nothing
 * beyond its buffer (which a sanitizer sees) and asks for no memory by a number that it has not checked. */
#include "support/io_files.h"

#define FOLDER VOX_TEST_DATA

/* The samples, made by data/make.py. TetGen: the file that is attacked; its partner stays whole. */
static const char* const samples[] = {"box_1.msh",
                                      "box_22.msh",
                                      "box_22_little.msh",
                                      "box_22_big.msh",
                                      "box_40.msh",
                                      "box_40_little.msh",
                                      "box_40_big.msh",
                                      "box_41.msh",
                                      "box_41_little.msh",
                                      "box_41_big.msh",
                                      "box.node",
                                      "box.ele",
                                      "box.mesh",
                                      "box.veg",
                                      "box_30.vtk",
                                      "box_30_binary.vtk",
                                      "box_51.vtk",
                                      "box_51_binary.vtk",
                                      "box_ascii.vtu",
                                      "box_base64.vtu",
                                      "box_base64_zlib.vtu",
                                      "box_appended.vtu",
                                      "box_appended_zlib_big.vtu",
                                      "box_appended_base64.vtu",
                                      "box_appended_base64_zlib.vtu"};
enum { sample_count = sizeof samples / sizeof *samples };

/* Reads a copy of exactly `size` bytes; the result is checked and destroyed. */
static vox_result attack(const char* name, const unsigned char* data, size_t size) {
    unsigned char* copy = (unsigned char*)malloc(size ? size : 1);
    memcpy(copy, data, size);
    bytes other = {NULL, 0};
    char* partner = NULL;
    if (is_tetgen(name)) {
        partner = partner_of(name);
        other = read_file(FOLDER, partner);
    }
    const vox_io_source sources[2] = {{name, copy, size}, {partner, other.data, other.size}};
    vox_io_mesh* mesh = NULL;
    const vox_result result = vox_io_read(sources, partner ? 2 : 1, NULL, &mesh);
    if (result == VOX_OK) {
        check_sound(mesh);
        vox_io_mesh_destroy(mesh);
    } else {
        ck_assert_msg(result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED ||
                          result == VOX_ERROR_LIMIT,
                      "%s: %s (%s)", name, vox_result_string(result), vox_last_error());
        ck_assert_ptr_null(mesh);
    }
    free(partner);
    free(other.data);
    free(copy);
    return result;
}

START_TEST(whole) {
    for (int s = 0; s < sample_count; ++s) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", FOLDER, samples[s]);
        vox_io_mesh* mesh = NULL;
        ck_ok(vox_io_load(path, NULL, &mesh));
        check_sound(mesh);
        const vox_io_report report = report_of(mesh);
        const int mixed = !is_tetgen(samples[s]) && strcmp(samples[s], "box.veg") != 0;
        ck_assert_msg(report.vertices == 12 && report.tets == 10, "%s: %llu vertices, %llu tets", samples[s],
                      (unsigned long long)report.vertices, (unsigned long long)report.tets);
        ck_assert_uint_eq(report.triangles, mixed ? 2 : 0);
        ck_assert_uint_eq(report.skipped_elements, mixed ? 1 : 0);
        ck_assert_uint_eq(report.boundary_facets, 20);
        ck_assert_msg(close_to(report.volume, 0.1, 1e-7), "%s: volume %.17g", samples[s], report.volume);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

START_TEST(cut_at_every_byte) {
    const char* name = samples[_i];
    const bytes file = read_file(FOLDER, name);
    ck_assert_ptr_nonnull(file.data);
    size_t loaded = 0;
    for (size_t size = 0; size < file.size; ++size) loaded += attack(name, file.data, size) == VOX_OK;
    /* Only an end that holds nothing of the mesh may be missing: a line end, a closing tag, data on points.
     */
    ck_assert_msg(loaded < 120, "%s: %zu cut files were taken for whole ones", name, loaded);
    free(file.data);
}
END_TEST

static uint32_t next_random(uint32_t* state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

START_TEST(bent_bytes) {
    const char* name = samples[_i];
    const bytes file = read_file(FOLDER, name);
    ck_assert_ptr_nonnull(file.data);
    uint32_t random = 12345;
    for (int round = 0; round < 1000; ++round) {
        bytes bent = {(unsigned char*)malloc(file.size), file.size};
        memcpy(bent.data, file.data, file.size);
        const uint32_t changes = 1 + next_random(&random) % 4;
        for (uint32_t c = 0; c < changes; ++c) {
            const size_t at = next_random(&random) % file.size;
            switch (next_random(&random) % 4) {
            case 0:
                bent.data[at] = (unsigned char)next_random(&random);
                break;
            case 1:
                bent.data[at] ^= (unsigned char)(1u << next_random(&random) % 8);
                break;
            case 2:
                bent.data[at] = (unsigned char)"0159-+.eE \n#$<>\"'"[next_random(&random) % 17];
                break;
            default: { /* move a piece over another */
                const size_t from = next_random(&random) % file.size, last = at > from ? at : from;
                memmove(bent.data + at, bent.data + from, (file.size - last) / 4);
            }
            }
        }
        attack(name, bent.data, bent.size);
        free(bent.data);
    }
    free(file.data);
}
END_TEST

/* Every number written in digits, replaced in turn by numbers that no such file may hold there or that wrap.
 */
START_TEST(lying_numbers) {
    static const char* const lies[] = {"1152921504606846976",
                                       "18446744073709551615",
                                       "18446744073709551628",
                                       "4294967296",
                                       "2147483647",
                                       "-1",
                                       "0",
                                       "nan",
                                       "1e999",
                                       "99999999999999999999",
                                       "",
                                       "x"};
    const char* name = samples[_i];
    const bytes file = read_file(FOLDER, name);
    ck_assert_ptr_nonnull(file.data);
    for (size_t start = 0; start < file.size; ++start) {
        size_t end = start;
        while (end < file.size && file.data[end] >= '0' && file.data[end] <= '9') ++end;
        if (end == start) continue;
        for (size_t lie = 0; lie < sizeof lies / sizeof *lies; ++lie) {
            const size_t length = strlen(lies[lie]);
            const size_t size = file.size - (end - start) + length;
            unsigned char* bent = (unsigned char*)malloc(size);
            memcpy(bent, file.data, start);
            memcpy(bent + start, lies[lie], length);
            memcpy(bent + start + length, file.data + end, file.size - end);
            attack(name, bent, size);
            free(bent);
        }
        start = end;
    }
    free(file.data);
}
END_TEST

/* Every aligned group of bytes of a binary file, replaced by large counts of either byte order. */
START_TEST(lying_words) {
    static const unsigned char lies[][8] = {{0, 0, 0, 0, 0, 0, 0, 0x10},
                                            {0x10, 0, 0, 0, 0, 0, 0, 0},
                                            {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff},
                                            {0xff, 0xff, 0xff, 0x7f, 0, 0, 0, 0},
                                            {0, 0, 0, 0, 0x7f, 0xff, 0xff, 0xff},
                                            {0, 0, 0, 0, 0, 0, 0xf0, 0x7f},
                                            {0, 0, 0, 0, 0, 0, 0, 0}};
    const char* name = samples[_i];
    if (!strstr(name, "binary") && !strstr(name, "little") && !strstr(name, "big") &&
        strcmp(name, "box_appended.vtu") != 0)
        return; /* text */
    const bytes file = read_file(FOLDER, name);
    ck_assert_ptr_nonnull(file.data);
    for (size_t at = 0; at + 8 <= file.size; ++at)
        for (size_t lie = 0; lie < sizeof lies / sizeof *lies; ++lie)
            for (size_t width = 4; width <= 8; width += 4) {
                unsigned char saved[8];
                memcpy(saved, file.data + at, 8);
                memcpy(file.data + at, lies[lie], width);
                attack(name, file.data, file.size);
                memcpy(file.data + at, saved, 8);
            }
    free(file.data);
}
END_TEST

/* A compressed array that claims to be a thousand times a thousand times its size. */
START_TEST(declared_sizes_are_checked_first) {
    static const char* const texts[] = {
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1152921504606846976\n1 0 0 0\n$EndNodes\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1152921504606846976 1 2\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n3 1 0 1\n1\n0 0 0\n$EndNodes\n$Elements\n"
        "1152921504606846976 1152921504606846976 1 1\n",
        "MeshVersionFormatted 2\nDimension 3\nVertices 1152921504606846976\n",
        "*VERTICES\n1152921504606846976 3 0 0\n1 0 0 0\n",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1152921504606846976 "
        "double\n",
        "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD f 1\na 4294967296 "
        "4294967296 double\n",
        "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"2000000000\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
        "format=\"binary\">AQAAAACAAAAAgAAAEAAAAA==</DataArray></Points></Piece></UnstructuredGrid></"
        "VTKFile>",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1152921504606846976\" "
        "NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" format=\"ascii\">0 0 "
        "0</DataArray></Points></Piece>"
        "</UnstructuredGrid></VTKFile>"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i)
        ck_assert_msg(attack("lie", (const unsigned char*)texts[i], strlen(texts[i])) != VOX_OK, "text %zu",
                      i);
}
END_TEST

int main(void) {
    Suite* suite = suite_create("io_hostile");
    TCase* tests = add_case(suite, "hostile");
    tcase_add_test(tests, whole);
    tcase_add_loop_test(tests, cut_at_every_byte, 0, sample_count);
    tcase_add_loop_test(tests, bent_bytes, 0, sample_count);
    tcase_add_loop_test(tests, lying_numbers, 0, sample_count);
    tcase_add_loop_test(tests, lying_words, 0, sample_count);
    tcase_add_test(tests, declared_sizes_are_checked_first);
    return run_suite(suite);
}
