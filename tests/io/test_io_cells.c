/* Hexahedra, wedges and pyramids of a file become tets that fit together, in every format that has such
 * cells. */
#include "scenes/random.h"
#include "support/io_files.h"

#include <stdarg.h>

enum { SIDE = 4, CUBES = SIDE * SIDE * SIDE, NODES = (SIDE + 1) * (SIDE + 1) * (SIDE + 1), MOST = 8 * CUBES };

typedef enum { HEXAHEDRON, WEDGE, PYRAMID, TET, KINDS } kind;
static const int corners_of[] = {8, 6, 5, 4}, vtk_types[] = {12, 13, 14, 10}, gmsh_types[] = {5, 6, 7, 4},
                 tets_of[] = {6, 3, 2, 1};
static const double volumes[] = {1, 0.5, 1.0 / 3, 1.0 / 6};

typedef struct {
    kind kind;
    uint32_t v[8];
} cell;

static struct {
    double points[3 * NODES];
    cell cells[MOST];
    int count, of_kind[KINDS];
} block;

/* The corners of a cube in VTK's order, and its faces, counter-clockwise as seen from outside. */
static const int lattice[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

static void add(kind kind, const uint32_t* v) {
    cell* to = &block.cells[block.count++];
    to->kind = kind;
    memcpy(to->v, v, sizeof(uint32_t) * (size_t)corners_of[kind]);
    ++block.of_kind[kind];
}

/* A cube as three pyramids with their apex at its lowest corner, or as six tets there. */
static void add_from_lowest(const uint32_t* v, int as_tets) {
    int lowest = 0;
    for (int i = 1; i < 8; ++i)
        if (v[i] < v[lowest]) lowest = i;
    for (int f = 0; f < 6; ++f) {
        uint32_t q[4];
        int least = 0, on = 0;
        for (int i = 0; i < 4; ++i) {
            q[i] = v[faces[f][i]];
            on |= faces[f][i] == lowest;
            if (q[i] < q[least]) least = i;
        }
        if (on) continue;
        const uint32_t base[5] = {q[3], q[2], q[1], q[0], v[lowest]};
        const uint32_t a = q[least], b = q[(least + 1) % 4], c = q[(least + 2) % 4], d = q[(least + 3) % 4];
        if (!as_tets) {
            add(PYRAMID, base);
        } else {
            add(TET, (const uint32_t[]){v[lowest], a, b, c});
            add(TET, (const uint32_t[]){v[lowest], a, c, d});
        }
    }
}

/* A block of cubes with its nodes in any order, and inside off the lattice by `warp`. Columns of cubes are
 * split into wedges, and other cubes are whole, pyramids or tets. The cells are sorted by kind, as some
 * formats need it. */
static void make_block(double warp) {
    static uint64_t state = 44;
    uint32_t number[NODES];
    memset(&block, 0, sizeof block);
    random_order(&state, NODES, number);
    for (int i = 0; i < NODES; ++i) {
        const int at[3] = {i % (SIDE + 1), i / (SIDE + 1) % (SIDE + 1), i / (SIDE + 1) / (SIDE + 1)};
        for (int k = 0; k < 3; ++k) {
            int inside = 1;
            for (int a = 0; a < 3; ++a) inside = inside && at[a] > 0 && at[a] < SIDE;
            const double off = random_symmetric(&state);
            block.points[3 * number[i] + (uint32_t)k] = at[k] + (inside ? warp * off : 0);
        }
    }
    for (int kind = 0; kind < KINDS; ++kind)
        for (int c = 0; c < CUBES; ++c) {
            const int x = c % SIDE, y = c / SIDE % SIDE, z = c / SIDE / SIDE;
            const int wedges = (x + 2 * y) % 5 == 0;
            uint32_t v[8];
            for (int i = 0; i < 8; ++i)
                v[i] = number[x + lattice[i][0] +
                              (SIDE + 1) * (y + lattice[i][1] + (SIDE + 1) * (z + lattice[i][2]))];
            const int which = wedges ? WEDGE : (int[]){HEXAHEDRON, PYRAMID, TET}[(3 * x + y + 2 * z) % 3];
            if (which != kind) continue;
            if (kind == HEXAHEDRON) add(HEXAHEDRON, v);
            if (kind == WEDGE) {
                add(WEDGE, (const uint32_t[]){v[0], v[1], v[2], v[4], v[5], v[6]});
                add(WEDGE, (const uint32_t[]){v[0], v[2], v[3], v[4], v[6], v[7]});
            }
            if (kind >= PYRAMID) add_from_lowest(v, kind == TET);
        }
}

/* ---- files, in which a line precedes the cells, and cell c has the region 1 + c % 3 ---- */

static char text[1 << 18];
static size_t length;

static void put(const char* words, ...) {
    va_list list;
    va_start(list, words);
    length += (size_t)vsnprintf(text + length, sizeof text - length, words, list);
    va_end(list);
    ck_assert_uint_lt(length, sizeof text - 1000);
}

static void put_points(const char* before, const char* separator, const char* behind) {
    for (int i = 0; i < NODES; ++i) {
        const double* p = &block.points[3 * i];
        if (*before) put(before, i + 1);
        put("%.17g%s%.17g%s%.17g%s", p[0], separator, p[1], separator, p[2], behind);
    }
}

/* The cells from `first` on that are of a kind, or of all, with the first node as 0 or 1. */
static void put_nodes(const cell* c, int first, const char* separator) {
    for (int i = 0; i < corners_of[c->kind]; ++i) put("%s%u", i ? separator : "", c->v[i] + (uint32_t)first);
}

static void put_msh(int version) {
    put("$MeshFormat\n%s 0 8\n$EndMeshFormat\n", version == 22 ? "2.2" : "4.1");
    if (version == 22) {
        put("$Nodes\n%d\n", NODES);
        put_points("%d ", " ", "\n");
        put("$EndNodes\n$Elements\n%d\n1 1 2 9 9 1 2\n", block.count + 1);
    } else {
        put("$Nodes\n1 %d 1 %d\n3 1 0 %d\n", NODES, NODES, NODES);
        for (int i = 0; i < NODES; ++i) put("%d\n", i + 1);
        put_points("", " ", "\n");
        put("$EndNodes\n$Elements\n5 %d 1 %d\n1 1 1 1\n1 1 2\n", block.count + 1, block.count + 1);
    }
    for (int c = 0; c < block.count; ++c) {
        const kind kind = block.cells[c].kind;
        if (version == 41 && (c == 0 || block.cells[c - 1].kind != kind))
            put("3 1 %d %d\n", gmsh_types[kind], block.of_kind[kind]);
        put("%d ", c + 2);
        if (version == 22) put("%d 2 %d 1 ", gmsh_types[kind], 1 + c % 3);
        put_nodes(&block.cells[c], 1, " ");
        put("\n");
    }
    put("$EndElements\n");
}

static void put_vtk(void) {
    int size = 3;
    for (int c = 0; c < block.count; ++c) size += 1 + corners_of[block.cells[c].kind];
    put("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n", NODES);
    put_points("", " ", "\n");
    put("CELLS %d %d\n2 0 1\n", block.count + 1, size);
    for (int c = 0; c < block.count; ++c) {
        put("%d ", corners_of[block.cells[c].kind]);
        put_nodes(&block.cells[c], 0, " ");
        put("\n");
    }
    put("CELL_TYPES %d\n3\n", block.count + 1);
    for (int c = 0; c < block.count; ++c) put("%d\n", vtk_types[block.cells[c].kind]);
    put("CELL_DATA %d\nSCALARS region int\nLOOKUP_TABLE default\n9\n", block.count + 1);
    for (int c = 0; c < block.count; ++c) put("%d\n", 1 + c % 3);
}

static void put_vtu(void) {
    put("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"%d\" "
        "NumberOfCells=\"%d\">"
        "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">",
        NODES, block.count + 1);
    put_points("", " ", " ");
    put("</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1");
    for (int c = 0; c < block.count; ++c) {
        put(" ");
        put_nodes(&block.cells[c], 0, " ");
    }
    put("</DataArray><DataArray type=\"Int64\" Name=\"offsets\">2");
    for (int c = 0, end = 2; c < block.count; ++c) put(" %d", end += corners_of[block.cells[c].kind]);
    put("</DataArray><DataArray type=\"UInt8\" Name=\"types\">3");
    for (int c = 0; c < block.count; ++c) put(" %d", vtk_types[block.cells[c].kind]);
    put("</DataArray></Cells><CellData><DataArray type=\"Int32\" Name=\"region\">9");
    for (int c = 0; c < block.count; ++c) put(" %d", 1 + c % 3);
    put("</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>");
}

static void put_medit(void) {
    static const char* const names[] = {"Hexahedra", "Prisms", "Pyramids", "Tetrahedra"};
    put("MeshVersionFormatted 2\nDimension 3\nVertices %d\n", NODES);
    put_points("", " ", " 0\n");
    put("Edges 1\n1 2 9\n");
    for (int c = 0; c < block.count; ++c) {
        const kind kind = block.cells[c].kind;
        if (c == 0 || block.cells[c - 1].kind != kind) put("%s\n%d\n", names[kind], block.of_kind[kind]);
        put_nodes(&block.cells[c], 1, " ");
        put(" %d\n", 1 + c % 3);
    }
    put("End\n");
}

static void put_inp(void) {
    static const char* const names[] = {"C3D8R", "C3D6", "C3D5", "C3D4"};
    put("*NODE\n");
    put_points("%d, ", ", ", "\n");
    put("*ELEMENT, TYPE=T3D2\n1, 1, 2\n");
    for (int c = 0; c < block.count; ++c) {
        const kind kind = block.cells[c].kind;
        if (c == 0 || block.cells[c - 1].kind != kind) put("*ELEMENT, TYPE=%s\n", names[kind]);
        put("%d, ", c + 2);
        put_nodes(&block.cells[c], 1, ", ");
        put("\n");
    }
}

static const struct {
    const char* name;
    int has_regions;
} files[] = {{"a.msh", 1}, {"b.msh", 0}, {"a.vtk", 1}, {"a.mesh", 1}, {"a.inp", 0},
#ifdef VOX_TEST_XML
             {"a.vtu", 1}
#endif
};

static void put_file(int file) {
    length = 0;
    if (file < 2) put_msh(file == 0 ? 22 : 41);
    if (file == 2) put_vtk();
    if (file == 3) put_medit();
    if (file == 4) put_inp();
    if (file == 5) put_vtu();
}

static vox_io_mesh* load(const char* name, const void* data, size_t size, uint32_t flags) {
    const vox_io_source source = {name, data, size};
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.flags = flags;
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_read(&source, 1, &desc, &mesh));
    check_sound(mesh);
    return mesh;
}

static double volume_of(const vox_io_mesh_view* view, uint64_t t) {
    const uint32_t* tet = &view->tets[4 * t];
    double e[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            e[i][k] =
                view->positions[3 * tet[i + 1] + (uint32_t)k] - view->positions[3 * tet[0] + (uint32_t)k];
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
            e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6;
}

/* Each tet has its cell's corners and region, and those of a cell fill it. */
static void check_cells(const vox_io_mesh_view* view, int has_regions, int flat_faces) {
    double filled[MOST] = {0};
    int tets[MOST] = {0};
    for (uint64_t t = 0; t < view->tet_count; ++t) {
        ck_assert_uint_gt(view->tet_cells[t], 0); /* the line */
        const uint32_t c = view->tet_cells[t] - 1;
        ck_assert_uint_lt(c, (uint32_t)block.count);
        if (t) ck_assert_uint_ge(view->tet_cells[t], view->tet_cells[t - 1]);
        if (has_regions) ck_assert_int_eq(view->tet_regions[t], (int)(1 + c % 3));
        const cell* cell = &block.cells[c];
        for (int i = 0; i < 4; ++i) {
            int found = 0;
            for (int k = 0; k < corners_of[cell->kind]; ++k)
                found |= cell->v[k] == view->tets[4 * t + (uint32_t)i];
            ck_assert(found);
        }
        filled[c] += volume_of(view, t);
        ++tets[c];
    }
    for (int c = 0; c < block.count; ++c) {
        ck_assert_int_eq(tets[c], tets_of[block.cells[c].kind]);
        if (flat_faces) ck_assert(close_to(filled[c], volumes[block.cells[c].kind], 1e-12));
    }
}

START_TEST(fit_together) {
    const double warp = _i % 2 ? 0.15 : 0;
    make_block(warp);
    vox_io_mesh* first = NULL;
    for (size_t f = 0; f < sizeof files / sizeof *files; ++f) {
        put_file((int)f);
        vox_io_mesh* mesh = load(files[f].name, text, length, VOX_IO_LOAD_SPLIT_CELLS);
        const vox_io_report report = report_of(mesh);
        ck_assert_uint_eq(report.vertices, NODES);
        ck_assert_uint_eq(report.split_cells, (uint64_t)(block.count - block.of_kind[TET]));
        ck_assert_uint_eq(report.skipped_elements, 1);
        ck_assert_uint_eq(report.inverted_tets + report.degenerate_tets, 0);
        ck_assert(close_to(report.volume, CUBES, 1e-12));
        /* Every facet inside of the block is one of exactly two tets. */
        ck_assert_uint_eq(report.boundary_facets, 12 * SIDE * SIDE);
        ck_assert_uint_eq(report.non_manifold_facets, 0);
        ck_assert_uint_eq(report.components, 1);
        char words[100];
        snprintf(words, sizeof words, "%d cells were split into %d tets: hexahedra\n",
                 block.of_kind[HEXAHEDRON], 6 * block.of_kind[HEXAHEDRON]);
        ck_assert_msg(strstr(vox_io_mesh_get_warnings(mesh), words) != NULL, "%s: %s", files[f].name,
                      vox_io_mesh_get_warnings(mesh));
        vox_io_mesh_view view, other;
        ck_ok(vox_io_mesh_get_arrays(mesh, &view));
        ck_assert_int_eq(view.tet_regions != NULL, files[f].has_regions);
        check_cells(&view, files[f].has_regions, warp == 0);
        if (first) {
            ck_ok(vox_io_mesh_get_arrays(first, &other));
            ck_assert_uint_eq(view.tet_count, other.tet_count);
            ck_assert_mem_eq(view.tets, other.tets, 16 * view.tet_count);
            ck_assert_mem_eq(view.tet_cells, other.tet_cells, 4 * view.tet_count);
            vox_io_mesh_destroy(mesh);
        } else {
            first = mesh;
        }
        /* Without the flag they are left out, and said. */
        mesh = load(files[f].name, text, length, 0);
        ck_assert_uint_eq(report_of(mesh).tets, (uint64_t)block.of_kind[TET]);
        ck_assert_uint_eq(report_of(mesh).skipped_elements, (uint64_t)(block.count - block.of_kind[TET] + 1));
        ck_assert_ptr_nonnull(strstr(vox_io_mesh_get_warnings(mesh), "were left out: pyramids\n"));
        ck_ok(vox_io_mesh_get_arrays(mesh, &view));
        ck_assert_uint_eq(view.tet_cells[0], (uint32_t)(1 + block.count - block.of_kind[TET]));
        vox_io_mesh_destroy(mesh);
    }
    vox_io_mesh_destroy(first);
}
END_TEST

/* The samples of mixed elements, binary ones among them: two triangles, a hexahedron, ten tets. */
START_TEST(samples) {
    static const char* const names[] = {"box_1.msh",         "box_22_little.msh", "box_22_big.msh",
                                        "box_40_little.msh", "box_40_big.msh",    "box_41_little.msh",
                                        "box_41_big.msh",    "box_30_binary.vtk", "box_51_binary.vtk",
                                        "box.mesh",          "box.inp",
#ifdef VOX_TEST_XML
                                        "box_appended.vtu"
#endif
    };
    static const uint32_t hexahedron[] = {0, 4, 5, 7, 0, 4, 7, 6, 0, 1, 3, 7,
                                          0, 1, 7, 5, 0, 2, 6, 7, 0, 2, 7, 3};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        const bytes file = read_file(VOX_TEST_DATA, names[i]);
        vox_io_mesh* mesh = load(names[i], file.data, file.size, VOX_IO_LOAD_SPLIT_CELLS);
        const vox_io_report report = report_of(mesh);
        ck_assert_uint_eq(report.tets, 16);
        ck_assert_uint_eq(report.split_cells, 1);
        ck_assert(close_to(report.volume, 0.15, 1e-7));
        vox_io_mesh_view view;
        ck_ok(vox_io_mesh_get_arrays(mesh, &view));
        for (uint32_t t = 0; t < 16; ++t) ck_assert_uint_eq(view.tet_cells[t], t < 6 ? 2 : t - 3);
        ck_assert_mem_eq(view.tets, hexahedron, sizeof hexahedron);
        vox_io_mesh_destroy(mesh);
        free(file.data);
    }
}
END_TEST

/* ---- one cell, the unit cube or a part of it, with nodes that are not used or named twice ---- */

#define CUBE "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 .5 .5 .5"

static vox_io_mesh* vtk_cell(int type, int nodes, const int* of, uint32_t flags) {
    length = 0;
    put("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n" CUBE
        "\nCELLS 2 %d\n"
        "4 0 1 3 4\n%d",
        nodes + 6, nodes);
    for (int i = 0; i < nodes; ++i) put(" %d", of[i]);
    put("\nCELL_TYPES 2\n10\n%d\n", type);
    return load("a.vtk", text, length, flags);
}

START_TEST(vtk_kinds) {
    static const struct {
        int type, nodes, corners;
        const char* name;
    } rows[] = {{12, 8, 8, NULL},
                {11, 8, 8, NULL},
                {13, 6, 6, NULL},
                {14, 5, 5, NULL},
                {25, 20, 8, "quadratic hexahedra"},
                {29, 27, 8, "triquadratic hexahedra"},
                {33, 24, 8, "biquadratic hexahedra"},
                {72, 8, 8, NULL},
                {72, 64, 8, "Lagrange hexahedra"},
                {79, 27, 8, "Bezier hexahedra"},
                {67, 27, 8, "hexahedra of higher order"},
                {26, 15, 6, "quadratic wedges"},
                {31, 12, 6, "quadratic-linear wedges"},
                {32, 18, 6, "biquadratic wedges"},
                {73, 40, 6, "Lagrange wedges"},
                {80, 18, 6, "Bezier wedges"},
                {27, 13, 5, "quadratic pyramids"},
                {37, 19, 5, "triquadratic pyramids"},
                {74, 14, 5, "Lagrange pyramids"},
                {81, 14, 5, "Bezier pyramids"}};
    static const int of_hexahedron[] = {0, 1, 2, 3, 4, 5, 6, 7}, of_voxel[] = {0, 1, 3, 2, 4, 5, 7, 6},
                     of_wedge[] = {0, 1, 3, 4, 5, 7}, of_pyramid[] = {0, 1, 2, 3, 4};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        int nodes[64];
        for (int n = 0; n < 64; ++n) nodes[n] = 8;
        memcpy(nodes,
               rows[i].type == 11     ? of_voxel
               : rows[i].corners == 8 ? of_hexahedron
               : rows[i].corners == 6 ? of_wedge
                                      : of_pyramid,
               sizeof(int) * (size_t)rows[i].corners);
        vox_io_mesh* mesh = vtk_cell(rows[i].type, rows[i].nodes, nodes, VOX_IO_LOAD_SPLIT_CELLS);
        const kind kind = rows[i].corners == 8 ? HEXAHEDRON : rows[i].corners == 6 ? WEDGE : PYRAMID;
        const vox_io_report report = report_of(mesh);
        ck_assert_msg(close_to(report.volume, volumes[kind] + 1.0 / 6, 1e-12), "type %d: volume %g",
                      rows[i].type, report.volume);
        ck_assert_uint_eq(report.split_cells, 1);
        ck_assert_uint_eq(report.inverted_tets, 0);
        char words[120];
        snprintf(words, sizeof words, "1 cell has more nodes than corners, which alone were used: %s\n",
                 rows[i].name ? rows[i].name : "");
        const char* const warnings = vox_io_mesh_get_warnings(mesh);
        ck_assert_msg((strstr(warnings, rows[i].name ? words : "more nodes") != NULL) ==
                          (rows[i].name != NULL),
                      "type %d: %s", rows[i].type, warnings);
        vox_io_mesh_destroy(mesh);
        mesh = vtk_cell(rows[i].type, rows[i].nodes, nodes, 0);
        ck_assert_uint_eq(report_of(mesh).tets, 1);
        ck_assert_ptr_nonnull(
            strstr(vox_io_mesh_get_warnings(mesh), "1 volume element of another kind was left out"));
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

/* A hexahedron with corners named twice is a wedge or a pyramid. */
START_TEST(collapsed) {
    static const struct {
        int nodes[8];
        double volume;
    } rows[] = {{{0, 1, 2, 2, 4, 5, 6, 6}, 0.5},     {{2, 2, 0, 1, 6, 6, 4, 5}, 0.5},
                {{6, 5, 4, 4, 2, 1, 0, 0}, 0.5},     {{1, 2, 3, 0, 4, 4, 4, 4}, 1.0 / 3},
                {{4, 4, 4, 4, 3, 2, 1, 0}, 1.0 / 3}, {{0, 1, 3, 3, 4, 4, 4, 4}, 1.0 / 6},
                {{5, 5, 5, 5, 5, 5, 5, 5}, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh* mesh = vtk_cell(12, 8, rows[i].nodes, VOX_IO_LOAD_SPLIT_CELLS);
        const vox_io_report report = report_of(mesh);
        ck_assert_msg(close_to(report.volume, rows[i].volume + 1.0 / 6, 1e-12), "%zu: volume %g", i,
                      report.volume);
        ck_assert_uint_eq(report.degenerate_tets, 0);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

#define MEDIT                                                                                                \
    "MeshVersionFormatted 2\nDimension 3\nVertices 8\n"                                                      \
    "0 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0 0 0 1 0 1 0 1 0 1 1 1 0 0 1 1 0\n"
#define GMSH(elements)                                                                                       \
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 "   \
    "1\n"                                                                                                    \
    "7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n" elements "$EndElements\n"
#define INP "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
#define PART(element) "*PART, NAME=p\n" INP "*ELEMENT, TYPE=T3D2\n1,1,2\n" element "*END PART\n"

START_TEST(other_formats) {
    static const struct {
        const char *name, *text;
        double volume;
        int tets;
        const char* words;
    } rows[] = {
        {"a.veg",
         "*VERTICES\n8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 "
         "1\n*ELEMENTS\n"
         "CUBIC\n1 8 0\n1 1 2 3 4 5 6 7 8\n",
         1, 6, "1 cell was split into 6 tets: cubes\n"},
        {"a.msh", GMSH("1\n1 17 2 0 1 1 2 3 4 5 6 7 8 1 1 1 1 1 1 1 1 1 1 1 1\n"), 1, 6,
         "which alone were used: second-order hexahedra"},
        {"a.msh",
         GMSH(
             "2\n1 18 2 0 1 1 2 4 5 6 8 1 1 1 1 1 1 1 1 1\n2 13 2 0 1 2 3 4 6 7 8 1 1 1 1 1 1 1 1 1 1 1 1\n"),
         1, 6, "which alone were used: second-order prisms"},
        {"a.msh", GMSH("1\n1 19 2 0 1 1 2 3 4 5 1 1 1 1 1 1 1 1\n"), 1.0 / 3, 2,
         "1 cell was split into 2 tets: second-order pyramids"},
        {"a.inp", INP "*ELEMENT, TYPE=C3D20R\n1, 1,2,3,4,5,6,7,8, 1,1,1,1,1,1,1,\n1,1,1,1,1\n", 1, 6,
         "which alone were used: hexahedra"},
        {"a.inp", INP "*ELEMENT, TYPE=SC8R\n1, 1,2,3,4,5,6,7,8\n", 1, 6,
         "1 cell was split into 6 tets: hexahedra"},
        {"a.inp", INP "*ELEMENT, TYPE=C3D15\n1, 1,2,4,5,6,8, 1,1,1,1,1,1,1,1,1\n", 0.5, 3, "wedges"},
        {"a.inp",
         PART("*ELEMENT, TYPE=DC3D8\n2, 1,2,3,4,5,6,7,8\n") "*INSTANCE,PART=p\n*END "
                                                            "INSTANCE\n*INSTANCE,PART=p\n1.,0.,0.\n*END "
                                                            "INSTANCE\n",
         2, 12, "1 cell was split into 6 tets: hexahedra"},
        {"a.mesh",
         MEDIT "HexahedraQ2Ordering 27\n0 0 0 2 0 0 2 2 0 0 2 0 0 0 2 2 0 2 2 2 2 0 2 2\n"
               "1 0 0 2 1 0 1 2 0 0 1 0 1 0 2 2 1 2 1 2 2 0 1 2 0 0 1 2 0 1 2 2 1 0 2 1\n"
               "1 1 0 1 1 2 1 0 1 2 1 1 1 2 1 0 1 1 1 1 1\n"
               "HexahedraQ2 1\n1 2 3 4 5 6 7 8 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 5\nEnd\n",
         1, 6, "which alone were used: hexahedra"},
        {"a.mesh",
         MEDIT "PyramidsP2Ordering 14\n0 0 0 2 0 0 2 2 0 0 2 0 1 1 2\n"
               "1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\n"
               "PyramidsP2 1\n1 2 3 4 5 1 1 1 1 1 1 1 1 1 5\nEnd\n",
         1.0 / 3, 2, "pyramids"},
        {"a.mesh",
         MEDIT "PrismsP1Ordering 6\n1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1 0 1 0 1 0 0 1 1\nPrisms 1\n1 2 4 5 6 8 "
               "5\nEnd\n",
         0.5, 3, "1 cell was split into 3 tets: prisms\n"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh* mesh = load(rows[i].name, rows[i].text, strlen(rows[i].text), VOX_IO_LOAD_SPLIT_CELLS);
        const vox_io_report report = report_of(mesh);
        ck_assert_msg(close_to(report.volume, rows[i].volume, 1e-12), "%zu: volume %g", i, report.volume);
        ck_assert_uint_eq(report.tets, (uint64_t)rows[i].tets);
        ck_assert_uint_eq(report.inverted_tets, 0);
        ck_assert_msg(strstr(vox_io_mesh_get_warnings(mesh), rows[i].words) != NULL, "%zu: %s", i,
                      vox_io_mesh_get_warnings(mesh));
        if (rows[i].tets == 12) { /* instances of a line and a hexahedron */
            vox_io_mesh_view view;
            ck_ok(vox_io_mesh_get_arrays(mesh, &view));
            for (int t = 0; t < 12; ++t) ck_assert_uint_eq(view.tet_cells[t], t < 6 ? 1u : 3u);
        }
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

static void refused(const char* name, const char* data, uint32_t flags, vox_result result,
                    const char* words) {
    const vox_io_source source = {name, data, strlen(data)};
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.flags = flags;
    vox_io_mesh* mesh = NULL;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), result, words);
    ck_assert_ptr_null(mesh);
}

START_TEST(refusals) {
    const uint32_t split = VOX_IO_LOAD_SPLIT_CELLS;
    static const char hexahedron[] = GMSH("1\n1 5 2 0 1 1 2 3 4 5 6 7 8\n");
    refused("a.msh", hexahedron, 0, VOX_ERROR_FORMAT,
            "expected tetrahedra, found none; 1 volume element of another kind was left out: hexahedra (they "
            "are split "
            "into tetrahedra on request: split_cells)");
    refused("a.msh", GMSH("1\n1 5 2 0 1 1 2 3 4 5 6 7 9\n"), split, VOX_ERROR_FORMAT,
            "the number of a node, found 9");
    refused("a.msh", GMSH("1\n1 5 2 0 1 1 1 1 1 1 1 1 1\n"), split, VOX_ERROR_FORMAT, "found none");
    refused("a.mesh", MEDIT "Hexahedra 1\n1 2 3 4 5 6 7 9 0\nEnd\n", split, VOX_ERROR_FORMAT,
            "expected a vertex number from 1 to 8, found 9");
    refused("a.mesh", MEDIT "HexahedraQ1Ordering 8\n1 0 0 0 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nEnd\n",
            split, VOX_ERROR_UNSUPPORTED, "HexahedraQ1Ordering: elements are read whose corners come first");
    length = 0;
    put("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n" CUBE
        "\nCELLS 1 8\n"
        "7 0 1 2 3 4 5 6\nCELL_TYPES 1\n12\n");
    refused("a.vtk", text, split, VOX_ERROR_FORMAT, "cell 0: expected 8 points (hexahedra), found 7");
}
END_TEST

/* ---- tets of higher order whose corners lie in one plane ---- */

#define FLAT "1 tet has more than four nodes but its corners in one plane, and was left out\n"
#define VTK_FLAT(nodes, more, type)                                                                          \
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n" CUBE                \
    "\nCELLS 2 " more "\n4 0 1 3 4\n" nodes " 0 1 2 3 4 4 4 4 4 4\nCELL_TYPES 2\n10\n" type "\n"

START_TEST(flat_corners) {
    static const struct {
        const char *name, *text;
    } rows[] = {
        {"a.mesh", MEDIT "TetrahedraP2 1\n1 2 3 4 5 5 5 5 5 5 7\nTetrahedra 1\n1 2 4 5 3\nEnd\n"},
        {"a.mesh",
         MEDIT "Tetrahedra 1\n1 2 4 5 3\nTetrahedraP3 1\n1 2 3 4 5 6 7 8 5 6 7 8 5 6 7 8 5 6 7 8 7\nEnd\n"},
        {"a.msh", GMSH("2\n1 11 2 7 1 1 2 3 4 5 5 5 5 5 5\n2 4 2 3 1 1 2 4 5\n")},
        {"a.msh", GMSH("2\n1 29 2 7 1 1 2 3 4 5 5 5 5 5 5 5 5 5 5 5 5 5 5 5 5\n2 4 2 3 1 1 2 4 5\n")},
        {"a.vtk", VTK_FLAT("10", "16", "24")},
        {"a.vtk", VTK_FLAT("10", "16", "71")},
        {"a.inp", INP "*ELEMENT, TYPE=C3D10\n1, 1,2,3,4,5,5,5,5,5,5\n*ELEMENT, TYPE=C3D4\n1, 1,2,4,5\n"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh* mesh = load(rows[i].name, rows[i].text, strlen(rows[i].text), 0);
        const vox_io_report report = report_of(mesh);
        vox_io_mesh_view view;
        ck_ok(vox_io_mesh_get_arrays(mesh, &view));
        ck_assert_uint_eq(report.tets, 1);
        ck_assert_uint_eq(report.left_out_tets, 1);
        ck_assert_uint_eq(report.second_order_tets, 0);
        ck_assert(close_to(report.volume, 1.0 / 6, 1e-12));
        ck_assert_msg(strstr(vox_io_mesh_get_warnings(mesh), FLAT) != NULL, "%zu: %s", i,
                      vox_io_mesh_get_warnings(mesh));
        if (view.tet_regions) ck_assert_int_eq(view.tet_regions[0], 3);
        const int is_second = i != 1 && i != 4 && i != 5;
        ck_assert_int_eq(view.tet_cells != NULL, is_second);
        if (is_second) ck_assert_uint_eq(view.tet_cells[0], 1);
        vox_io_mesh_destroy(mesh);
    }
    /* One of four nodes is what the file says, and stays. */
    static const char four[] = MEDIT "Tetrahedra 2\n1 2 4 5 0\n1 2 3 4 0\nEnd\n";
    vox_io_mesh* mesh = load("a.mesh", four, sizeof four - 1, 0);
    ck_assert_uint_eq(report_of(mesh).tets, 2);
    ck_assert_uint_eq(report_of(mesh).degenerate_tets, 1);
    vox_io_mesh_destroy(mesh);
    refused("a.mesh", MEDIT "TetrahedraP2 1\n1 2 3 4 5 5 5 5 5 5 7\nEnd\n", 0, VOX_ERROR_FORMAT,
            "found none; 1 tet of more than four nodes has its corners in one plane");
}
END_TEST

SUITE(io_cells) {
    TCase* tests = add_case(suite, "cells");
    tcase_add_loop_test(tests, fit_together, 0, 8);
    tcase_add_test(tests, samples);
    tcase_add_test(tests, vtk_kinds);
    tcase_add_test(tests, collapsed);
    tcase_add_test(tests, other_formats);
    tcase_add_test(tests, refusals);
    tcase_add_test(tests, flat_corners);
}
