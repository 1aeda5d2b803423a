/* Small files of every format, cut, bent and lied in: a reader gives an error or a sound mesh, reads nothing
 * beyond its buffer (which a sanitizer sees), soon ends, and takes no more memory than 16 times the file and
 * 16 MB. FUZZ_SECONDS in the environment asks for that many thousand mutations of each file, and for a line
 * about each. */
#include "support/heap_peak.h"
#include "support/io_files.h"

#include <time.h>

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
                                      "box_appended_base64_zlib.vtu",
                                      "box_base64_lz4.vtu",
                                      "box.inp",
                                      "cube.stl", /* from here on surfaces */
                                      "cube_text.stl",
                                      "cube.obj",
                                      "cube.ply",
                                      "cube_little.ply",
                                      "cube_big.ply",
                                      "cube_strips.ply",
                                      "cube.off",
                                      "cube.vtk",
                                      "cube.vtp",
                                      "two_tetrahedra.gltf",
                                      "two_tetrahedra.glb"};
enum { sample_count = sizeof samples / sizeof *samples, first_surface = 27 };

/* Processor time in seconds. */
static double seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

static double slowest;   /* of all attacks so far: seconds of processor time */
static size_t most_heap; /* and bytes beyond 16 times the file */

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
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.flags = size % 2 ? VOX_IO_LOAD_SPLIT_CELLS : 0;
    vox_io_mesh* mesh = NULL;
    heap_begin();
    const double start = seconds();
    const vox_result result = vox_io_read(sources, partner ? 2 : 1, &desc, &mesh);
    const double taken = seconds() - start;
    const size_t heap = heap_peak(), fair = 16 * (size + other.size);
    if (taken > slowest) slowest = taken;
    if (heap > fair && heap - fair > most_heap) most_heap = heap - fair;
    ck_assert_msg(heap <= fair + 16000000, "%s: %zu bytes of memory for a file of %zu", name, heap, size);
    /* A thousand times what the slowest takes: only a loop without end, or nearly so, comes there. */
    ck_assert_msg(taken < 100, "%s: %g s for %zu bytes", name, taken, size);
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
        if (s >= first_surface) {
            const int two = strstr(samples[s], "two") != NULL;
            ck_assert_msg(report.vertices == 8 && report.triangles == (two ? 8 : 12),
                          "%s: %llu vertices, %llu triangles", samples[s],
                          (unsigned long long)report.vertices, (unsigned long long)report.triangles);
            ck_assert_uint_eq(report.open_edges + report.misoriented_edges + report.non_manifold_facets, 0);
            ck_assert_uint_eq(report.components, two ? 2 : 1);
            ck_assert_double_gt(report.volume, 0.99);
            vox_io_mesh_destroy(mesh);
            continue;
        }
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
     * OBJ has no end: every whole face makes a mesh. */
    ck_assert_msg(strcmp(extension_of(name), "obj") == 0 || loaded < 120,
                  "%s: %zu cut files were taken for whole ones", name, loaded);
    free(file.data);
}
END_TEST

static uint32_t next_random(uint64_t* state) { /* splitmix64 */
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

/* Replaces `removed` bytes of `file` at `at` by `size` others. */
static void splice(bytes* file, size_t at, size_t removed, const void* data, size_t size) {
    unsigned char* out = (unsigned char*)malloc(file->size - removed + size + 1);
    memcpy(out, file->data, at);
    memcpy(out + at, data, size);
    memcpy(out + at + size, file->data + at + removed, file->size - at - removed);
    file->size += size - removed;
    free(file->data);
    file->data = out;
}

static void mutate(bytes* file, uint64_t* random) {
    static const char* const words[] = {"-1",     "0",  "4294967295", "99999999", "1e309", "nan", "-",
                                        "1e-320", "\n", " ",          "\r\n",     "\"",    "{}",  "[",
                                        "]",      "}",  ",",          "/",        "#",     "\\"};
    const size_t n = file->size, at = next_random(random) % n;
    const size_t piece = 1 + next_random(random) % (next_random(random) % 4 ? 8 : 64);
    const size_t length = piece < n - at ? piece : n - at;
    switch (next_random(random) % 8) {
    case 0:
        file->data[at] = (unsigned char)next_random(random);
        break;
    case 1:
        file->data[at] ^= (unsigned char)(1u << next_random(random) % 8);
        break;
    case 2:
        file->data[at] = (unsigned char)"0159-+.eE \n#$<>\"'"[next_random(random) % 17];
        break;
    case 3: { /* a piece over another */
        const size_t from = next_random(random) % n, last = at > from ? at : from;
        memmove(file->data + at, file->data + from, (n - last) / 4);
        break;
    }
    case 4:
        if (length < n) splice(file, at, length, "", 0);
        break;
    case 5: { /* a word in place of a number, or put in */
        const char* const word = words[next_random(random) % (sizeof words / sizeof *words)];
        size_t start = at, end = at;
        while (end < n && strchr("+-.0123456789", file->data[end]) && file->data[end]) ++end;
        while (start > 0 && end > at && strchr("+-.0123456789", file->data[start - 1]) &&
               file->data[start - 1])
            --start;
        splice(file, start, end - start, word, strlen(word));
        break;
    }
    case 6: { /* a piece once more, elsewhere */
        unsigned char copy[64];
        memcpy(copy, file->data + at, length);
        splice(file, next_random(random) % n, 0, copy, length);
        break;
    }
    default: /* an integer of four bytes, in either byte order */
        if (n >= 4) {
            const uint32_t value =
                next_random(random) % 2 ? next_random(random) : 1u << next_random(random) % 32;
            memcpy(file->data + next_random(random) % (n - 3), &value, 4);
        }
    }
}

START_TEST(mutations) {
    const char *name = samples[_i], *asked = getenv("FUZZ_SECONDS");
    const long rounds = asked ? 1000 * atol(asked) : 1000;
    const bytes file = read_file(FOLDER, name);
    ck_assert_ptr_nonnull(file.data);
    uint64_t random = (uint64_t)_i;
    long loaded = 0;
    for (long round = 0; round < rounds; ++round) {
        bytes bent = {(unsigned char*)malloc(file.size), file.size};
        memcpy(bent.data, file.data, file.size);
        for (uint32_t changes = 1 + next_random(&random) % 4; changes > 0; --changes) mutate(&bent, &random);
        loaded += attack(name, bent.data, bent.size) == VOX_OK;
        free(bent.data);
    }
    if (asked)
        printf("%-32s %ld mutations, %ld meshes; at most %.3f s and %zu bytes of memory beyond 16 times the "
               "file\n",
               name, rounds, loaded, slowest, most_heap);
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
    if (!strstr(name, "binary") && !strstr(name, "little") && !strstr(name, "big") && !strstr(name, ".glb") &&
        strcmp(name, "cube.stl") != 0 && strcmp(name, "box_appended.vtu") != 0)
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

/* ---- files that stand for far more than they hold ---- */

static bytes text = {NULL, 0}; /* the file that is being written */
static size_t text_room = 0;

static void put(const void* data, size_t size) {
    if (text.size + size > text_room) {
        text_room = 2 * (text.size + size);
        text.data = (unsigned char*)realloc(text.data, text_room);
    }
    memcpy(text.data + text.size, data, size);
    text.size += size;
}
static void say(const char* words) { put(words, strlen(words)); }
static void repeat(const char* words, size_t times) {
    for (size_t i = 0; i < times; ++i) say(words);
}

/* Reads what was written, as a file of that name. */
static void expect(const char* name, vox_result result, const char* words) {
    slowest = 0;
    const vox_result found = attack(name, text.data, text.size);
    if (getenv("FUZZ_SECONDS"))
        printf("%-32s %zu bytes; %.3f s, %zu bytes of memory\n", name, text.size, slowest, heap_peak());
    ck_assert_msg(found == result, "%s: %s (%s), expected %s", name, vox_result_string(found),
                  vox_last_error(), vox_result_string(result));
    if (result != VOX_OK) ck_assert_msg(strstr(vox_last_error(), words), "%s: %s", name, vox_last_error());
    text.size = 0;
}

static const char ply_points[] = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty char "
                                 "x\nproperty char y\nproperty char z\n";

START_TEST(polygons) {
    say("v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    repeat(" 1 2 3", 500000);
    expect("fan.obj", VOX_ERROR_LIMIT, "more triangles than the limit of 631076");

    say(ply_points);
    say("element face 10000\nproperty list uchar uchar vertex_index\nend_header\n");
    put("\0\0\0\1\0\0\0\1\0\0\0\1", 12);
    for (int i = 0; i < 10000; ++i) {
        put("\xff", 1);
        repeat("\1", 255);
    }
    expect("fans.ply", VOX_ERROR_LIMIT, "more triangles");

    say(ply_points);
    say("element tristrips 1\nproperty list int uchar vertex_index\nend_header\n");
    put("\0\0\0\1\0\0\0\1\0\0\0\1\0\0\x10\0", 16);
    repeat("\1", 1048576);
    expect("strip.ply", VOX_ERROR_LIMIT, "more triangles");

    /* A comb: every ear is looked for among many corners, until that takes too long; then the rest is cut
     * anyhow. */
    for (int tooth = 0; tooth < 30000; ++tooth) {
        char line[64];
        snprintf(line, sizeof line, "v %d 0 0\nv %d.5 %d 0\n", tooth, tooth, tooth % 2 ? 1 : 2);
        say(line);
    }
    say("v 30000 0 0\nv 30000 -1 0\nv 0 -1 0\nf");
    for (int corner = 60003; corner > 0; --corner) {
        char word[16];
        snprintf(word, sizeof word, " %d", corner);
        say(word);
    }
    expect("comb.obj", VOX_OK, "");
}
END_TEST

START_TEST(points) {
    repeat("v 0 0 0\n", 500000);
    expect("points.obj", VOX_OK, "");
    say("ply\nformat ascii 1.0\nelement vertex 500000000\nproperty float x\nproperty float y\nproperty float "
        "z\n"
        "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n");
    expect("claim.ply", VOX_ERROR_FORMAT,
           "line 3: number of elements vertex: 500000000 are declared, but only 6 bytes");
    say("ply\nformat ascii 1.0\nelement nothing 1000000000000000000\nend_header\n");
    expect("nothing.ply", VOX_ERROR_FORMAT, "line 3: element nothing: expected properties");
    say("ply\nformat ascii 1.0\n");
    repeat("element a 0\n", 200000);
    expect("elements.ply", VOX_ERROR_LIMIT, "line 4099: more than 4096 elements and properties");
    say("ply\nformat ascii 1.0\nelement a 0\n");
    repeat("property char a\n", 200000);
    expect("properties.ply", VOX_ERROR_LIMIT, "line 4099: more than 4096 elements and properties");
    repeat("v 0 0 0\n", 700000);
    expect("many_points.obj", VOX_ERROR_LIMIT, "more vertices than the limit of 691072");
    say("OFF 700000 1 0\n");
    repeat("0 0 0\n", 700000);
    say("3 0 1 2\n");
    expect("many_points.off", VOX_ERROR_LIMIT, "more vertices than the limit of 5510");
    say("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000");
    repeat(" 0", 4000000);
    expect("polygon.off", VOX_ERROR_LIMIT, "more triangles than the limit of 14644");
}
END_TEST

/* A surface of 100002 vertices; `one_hash`: at positions made so that PositionTable gives them all one hash.
 * Returns the seconds that reading it takes. */
static double many_positions(int one_hash) {
    char line[128];
    uint32_t count = 0;
    for (uint64_t i = 1; count < 100002; ++i) {
        double x = (double)i, y = 1 / x;
        if (one_hash) { /* what the table mixes with y brings every x to the same state */
            uint64_t bits;
            memcpy(&bits, &x, 8);
            bits *= 0x9e3779b97f4a7c15u;
            bits ^= (bits >> 32) ^ 0x3ff0000000000000u;
            memcpy(&y, &bits, 8);
            if (!isfinite(y) || fabs(y) < 1e-300) continue;
        }
        snprintf(line, sizeof line, "v %.0f %.17g 0\n", x, y);
        say(line);
        ++count;
    }
    for (uint32_t i = 1; i <= count; i += 3) {
        snprintf(line, sizeof line, "f %u %u %u\n", i, i + 1, i + 2);
        say(line);
    }
    expect(one_hash ? "one_hash.obj" : "many_hashes.obj", VOX_OK, "");
    return slowest;
}

/* A search among all of them would take a thousand times longer; the tree takes a few times longer. */
START_TEST(positions_of_one_hash) {
    const double usual = many_positions(0), found = many_positions(1);
    ck_assert_msg(found < 1 + 20 * usual, "%g s, for usual positions %g s", found, usual);
}
END_TEST

#define GLTF_MESH                                                                                            \
    "\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"                              \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"               \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"            \
    "\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]"

START_TEST(scenes) {
    say("{" GLTF_MESH ",\"meshes\":[{\"primitives\":[");
    repeat("{\"attributes\":{\"POSITION\":0}},", 999);
    say("{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"children\":[");
    for (int i = 1; i < 1000; ++i) {
        char number[16];
        snprintf(number, sizeof number, i < 999 ? "%d," : "%d", i);
        say(number);
    }
    say("]}");
    repeat(",{\"mesh\":0}", 999);
    say("]}");
    expect("copies.gltf", VOX_ERROR_LIMIT, "more primitives than the limit");

    say("{" GLTF_MESH
        ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}");
    repeat(",{}", 1000000);
    say("]}");
    expect("nodes.gltf", VOX_OK, "");

    say("{" GLTF_MESH ",\"nodes\":[");
    for (int i = 0; i < 100000; ++i) {
        char node[64];
        snprintf(node, sizeof node, "{\"scale\":[1,1,1],\"children\":[%d]},", i + 1);
        say(node);
    }
    say("{}]}");
    expect("deep.gltf", VOX_ERROR_LIMIT, "nested deeper than 1024");

    say("{" GLTF_MESH ",\"meshes\":[{\"primitives\":[{\"attributes\":{}}");
    repeat(",{\"attributes\":{}}", 50000);
    say("]}],\"nodes\":[{\"children\":[1");
    for (int i = 2; i < 50000; ++i) {
        char number[16];
        snprintf(number, sizeof number, ",%d", i);
        say(number);
    }
    say("]}");
    repeat(",{\"mesh\":0}", 50000);
    say("]}");
    expect("empty_copies.gltf", VOX_ERROR_LIMIT, "more primitives");

    say("{" GLTF_MESH ",\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}");
    expect("circle.gltf", VOX_ERROR_FORMAT, "node 0 is in the scene twice");

    say("{\"extras\":");
    repeat("[", 2000000);
    expect("brackets.gltf", VOX_ERROR_FORMAT, "unexpected end of input");

    say("{" GLTF_MESH ",\"scenes\":[{}");
    repeat(",{}", 500000);
    say("],\"nodes\":[{}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":1}");
    repeat(",{\"buffer\":0,\"byteLength\":1}", 100000);
    say("]}");
    expect("views.gltf", VOX_ERROR_FORMAT, "expected triangles, found none");
}
END_TEST

/* A .glb with one primitive of `count` distinct positions, three bytes each and without indices, which
 * `nodes` nodes show, at `places` places in turn, and with `empty` primitives that nothing shows. */
static void say_glb(uint32_t mode, uint32_t count, uint32_t nodes, uint32_t places, size_t empty) {
    char words[512];
    const uint32_t size = 3 * count, padded = (size + 3) / 4 * 4;
    put("glTF\2\0\0\0........JSON", 20); /* the lengths follow below */
    snprintf(
        words, sizeof words,
        "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"bufferView\":0,\"componentType\":5121,"
        "\"count\":%u,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%u}],"
        "\"buffers\":[{\"byteLength\":%u}],"
        "\"meshes\":[{\"primitives\":[{\"mode\":%u,\"attributes\":{\"POSITION\":0}}]},{\"primitives\":[{}",
        count, size, padded, mode);
    say(words);
    repeat(",{}", empty);
    say("]}],\"scenes\":[{\"nodes\":[0");
    for (uint32_t i = 1; i < nodes; ++i) {
        snprintf(words, sizeof words, ",%u", i);
        say(words);
    }
    say("]}],\"nodes\":[{\"mesh\":0}");
    for (uint32_t i = 1; i < nodes; ++i) {
        snprintf(words, sizeof words, ",{\"mesh\":0,\"translation\":[0,0,%u]}", 256 * (i % places));
        say(words);
    }
    say("]}");
    while (text.size % 4) say(" ");
    const uint32_t json = (uint32_t)text.size - 20;
    put(&padded, 4);
    put("BIN", 4);
    for (uint32_t i = 0; i < padded / 3 + 1; ++i) {
        const unsigned char position[3] = {(unsigned char)i, (unsigned char)(i >> 8),
                                           (unsigned char)(i >> 16)};
        put(position, padded - 3 * i < 3 ? padded - 3 * i : 3);
    }
    const uint32_t all = (uint32_t)text.size;
    memcpy(text.data + 8, &all, 4);
    memcpy(text.data + 12, &json, 4);
}

/* Vertices that are all distinct: more than the limit where triangles are fewer, and nearly as many of both
 * as the limits allow. */
START_TEST(distinct_vertices) {
    say_glb(4, 900, 440, 440, 0);
    expect("elsewhere.glb", VOX_ERROR_LIMIT, "more vertices than the limit of 133");
    say_glb(4, 4194306, 1, 1, 0);
    expect("small_positions.glb", VOX_ERROR_LIMIT, "more vertices than the limit of 13894");
    say_glb(5, 900, 146, 146, 0);
    expect("strips.glb", VOX_OK, "");
    say_glb(5, 187000, 1, 1, 0);
    expect("long_strip.glb", VOX_OK, "");
    say_glb(5, 900, 730, 498, 1 << 20);
    expect("empty_primitives.glb", VOX_OK, "");
}
END_TEST

/* The hash of PositionTable. */
static uint64_t hash_of(const double* p) {
    uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        uint64_t bits;
        memcpy(&bits, p + k, 8);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

/* As many points, vertices, triangles and corners of one polygon as there may be, each of as few bytes as can
 * be; and of all positions in bytes those that want the same slots, a 32nd of the table. */
START_TEST(chosen_positions) {
    const uint32_t points = 518000, strip = points, polygon = 260000;
    char words[512];
    snprintf(words, sizeof words,
             "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty uchar x\nproperty uchar y\n"
             "property uchar z\nelement tristrips 1\nproperty list int int vertex_index\n"
             "element face 1\nproperty list int uchar vertex_index\nend_header\n",
             points);
    say(words);
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < 1u << 24 && chosen < points; ++i) {
        const unsigned char bytes_of[3] = {(unsigned char)i, (unsigned char)(i >> 8),
                                           (unsigned char)(i >> 16)};
        const double p[3] = {bytes_of[0], bytes_of[1], bytes_of[2]};
        if (hash_of(p) >> 59) continue;
        put(bytes_of, 3);
        ++chosen;
    }
    ck_assert_uint_eq(chosen, points);
    put(&strip, 4);
    for (uint32_t i = 0; i < points; ++i) put(&i, 4);
    put(&polygon, 4);
    for (uint32_t i = 0; i < polygon; ++i) put("", 1);
    expect("chosen_positions.ply", VOX_OK, "");
}
END_TEST

SUITE(io_hostile) {
    TCase* tests = add_case(suite, "hostile");
    tcase_add_test(tests, whole);
    tcase_add_loop_test(tests, cut_at_every_byte, 0, sample_count);
    tcase_add_loop_test(tests, mutations, 0, sample_count);
    tcase_add_loop_test(tests, lying_numbers, 0, sample_count);
    tcase_add_loop_test(tests, lying_words, 0, sample_count);
    tcase_add_each(tests, declared_sizes_are_checked_first, polygons, points, positions_of_one_hash, scenes,
                   distinct_vertices, chosen_positions);
}
