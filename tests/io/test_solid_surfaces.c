/* Surface to tetrahedra on surfaces made here: exact shapes, degenerate positions, holes, nesting,
 * orientation. */
#include "support/solid_checks.h"

typedef struct {
    double positions[3 * 20000];
    uint32_t triangles[3 * 20000];
    uint64_t vertices, count;
} surface;

static surface s; /* one at a time; emptied before each test */

static void clear(void) { s.vertices = s.count = 0; }

static uint32_t vertex(double x, double y, double z) {
    double* p = s.positions + 3 * s.vertices;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return (uint32_t)s.vertices++;
}

static void triangle(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t* t = s.triangles + 3 * s.count++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

/* Outwards oriented; `sides` has a bit for each side: -x +x -y +y -z +z. */
static void add_box(double x0, double y0, double z0, double x1, double y1, double z1, unsigned sides) {
    static const unsigned char quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    uint32_t v[8];
    for (int c = 0; c < 8; ++c) v[c] = vertex(c & 1 ? x1 : x0, c & 2 ? y1 : y0, c & 4 ? z1 : z0);
    for (int q = 0; q < 6; ++q)
        if (sides >> q & 1) {
            triangle(v[quads[q][0]], v[quads[q][1]], v[quads[q][2]]);
            triangle(v[quads[q][0]], v[quads[q][2]], v[quads[q][3]]);
        }
}
enum { all_sides = 63, no_top = 31 };

static void add_sphere(double x, double y, double z, double r, int rings, int inwards) {
    const double pi = 3.14159265358979323846;
    const int around = 2 * rings;
    const uint32_t south = vertex(x, y, z - r);
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double a = pi * i / rings - pi / 2, b = 2 * pi * j / around;
            vertex(x + r * cos(a) * cos(b), y + r * cos(a) * sin(b), z + r * sin(a));
        }
    const uint32_t north = vertex(x, y, z + r);
    const uint64_t first = s.count;
    for (int j = 0; j < around; ++j) {
        const uint32_t k = (uint32_t)((j + 1) % around), a = (uint32_t)j;
        triangle(south, south + 1 + k, south + 1 + a);
        for (int i = 0; i + 2 < rings; ++i) {
            const uint32_t low = south + 1 + (uint32_t)(i * around), high = low + (uint32_t)around;
            triangle(low + a, low + k, high + k);
            triangle(low + a, high + k, high + a);
        }
        triangle(north, north - (uint32_t)around + a, north - (uint32_t)around + k);
    }
    if (inwards)
        for (uint64_t t = first; t < s.count; ++t) {
            const uint32_t swap = s.triangles[3 * t];
            s.triangles[3 * t] = s.triangles[3 * t + 1];
            s.triangles[3 * t + 1] = swap;
        }
}

static vox_io_mesh* made(void) {
    vox_io_mesh_view view = {s.positions, 0, NULL, 0, s.triangles, 0, NULL, NULL, NULL};
    vox_io_mesh* mesh = NULL;
    view.vertex_count = s.vertices;
    view.triangle_count = s.count;
    ck_ok(vox_io_mesh_create(&view, &mesh));
    return mesh;
}

static vox_io_tetrahedralize_desc with_cell(double cell) {
    vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
    desc.cell = cell;
    return desc;
}

static vox_io_mesh* stuffed(const vox_io_mesh* mesh, double cell) {
    const vox_io_tetrahedralize_desc desc = with_cell(cell);
    vox_io_mesh* tets = NULL;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &tets));
    return tets;
}

/* ---- shapes whose figures are known ---- */

START_TEST(box) {
    /* With 0.1 the sides lie exactly on lattice planes, and edges of the surface on lattice lines. */
    static const double cells[] = {0.1, 0.125, 0.07, 0.053};
    add_box(-0.5, -0.5, -0.5, 0.5, 0.5, 0.5, all_sides);
    vox_io_mesh* mesh = made();
    vox_io_mesh* tets = stuffed(mesh, cells[_i]);
    const solid_facts facts = check_stuffed(tets);
    const vox_io_quality quality = quality_of(tets, mesh);
    ck_assert_double_eq_tol(quality.surface_volume, 1, 1e-12);
    ck_assert_double_eq_tol(facts.volume, 1, 6 * cells[_i] * cells[_i]); /* twelve edges, rounded */
    ck_assert_uint_eq(facts.pinched_edges, 0);
    ck_assert_int_eq(facts.euler, 2);
    ck_assert_double_lt(quality.mesh_to_surface, 0.5 * cells[_i]);
    ck_assert_double_lt(quality.surface_to_mesh, 0.9 * cells[_i]); /* the corners */
    if (_i < 2) {
        /* Planes of the lattice are met exactly. */
        const vox_io_mesh_view view = solid_view(tets);
        for (size_t v = 0; v < 3 * view.vertex_count; ++v)
            ck_assert_double_le(fabs(view.positions[v]), 0.5 + 1e-9);
    }
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(sphere) {
    add_sphere(0, 0, 0, 1, 60, 0);
    vox_io_mesh* mesh = made();
    vox_io_mesh* tets = NULL;
    ck_ok(vox_io_tetrahedralize(mesh, NULL, &tets)); /* 50 cells across */
    const solid_facts facts = check_stuffed(tets);
    const vox_io_quality quality = quality_of(tets, mesh);
    ck_assert_double_eq_tol(facts.volume / quality.surface_volume, 1, 0.01);
    ck_assert_double_lt(quality.hausdorff, 0.5 * 2 / 50);
    ck_assert_double_gt(quality.hausdorff, 0);
    ck_assert_double_eq(quality.hausdorff, fmax(quality.mesh_to_surface, quality.surface_to_mesh));
    ck_assert_uint_eq(facts.pinched_edges, 0);
    ck_assert_int_eq(facts.euler, 2);
    ck_assert_str_eq(vox_io_mesh_get_warnings(tets), "");
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(distance_is_exact) {
    /* A box in a box, 0.25 apart on each side and sqrt(3) / 4 at the corners. */
    add_box(-1, -1, -1, 1, 1, 1, all_sides);
    vox_io_mesh* outer = made();
    vox_io_mesh* inner = NULL;
    ck_ok(vox_io_make_box(1.5, 1.5, 1.5, 0.1, &inner));
    const vox_io_quality quality = quality_of(inner, outer);
    ck_assert_double_eq_tol(quality.mesh_to_surface, 0.25, 1e-12);
    ck_assert_double_eq_tol(quality.surface_to_mesh, sqrt(3) / 4, 1e-12);
    ck_assert_double_eq_tol(quality.hausdorff, sqrt(3) / 4, 1e-12);
    ck_assert_double_eq_tol(quality.surface_volume, 8, 1e-12);
    ck_assert_double_eq_tol(quality.volume, 3.375, 1e-12);
    vox_io_mesh_destroy(inner);
    vox_io_mesh_destroy(outer);
}
END_TEST

START_TEST(kept_distance) {
    /* The blade is a quarter of a cell thick: too thin for the lattice, unless a distance is asked for. */
    add_sphere(0, 0, 0, 1, 24, 0);
    add_box(0.5, -0.4, -0.02, 1.6, 0.4, 0.02, all_sides);
    vox_io_mesh* mesh = made();
    vox_io_tetrahedralize_desc desc = with_cell(0.16);
    vox_io_mesh *coarse = NULL, *fine = NULL;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &coarse));
    ck_assert_double_gt(quality_of(coarse, mesh).hausdorff, 0.5);
    desc.max_distance =
        0.55; /* the half of the blade that lies inside the sphere stays as far from the boundary */
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &fine));
    check_stuffed(fine);
    const vox_io_quality quality = quality_of(fine, mesh);
    ck_assert_double_le(quality.hausdorff, 0.55);
    ck_assert_uint_gt(quality.tets, quality_of(coarse, mesh).tets);

    vox_io_mesh* untouched = NULL;
    desc.max_distance = 0.01; /* out of reach, for the same reason */
    desc.max_tets = 20000;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT, "max_distance");
    ck_assert_ptr_null(untouched);
    vox_io_mesh_destroy(coarse);
    vox_io_mesh_destroy(fine);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* A tip is approached linearly, and only by ever more tets: refused while they are few. */
START_TEST(thin_spike) {
    const double pi = 3.14159265358979323846;
    for (int diagonal = 0; diagonal < 2; ++diagonal) {
        clear();
        const uint32_t base = vertex(0, 0, 0), tip = diagonal ? vertex(0.6, 0.6, 0.5) : vertex(0, 0, 1);
        for (int i = 0; i < 16; ++i) {
            const double x = 0.005 * cos(pi * i / 8), y = 0.005 * sin(pi * i / 8);
            vertex(x, y, diagonal ? -(x + y) * 1.2 : 0);
        }
        for (uint32_t i = 0; i < 16; ++i) {
            const uint32_t a = tip + 1 + i, b = tip + 1 + (i + 1) % 16;
            triangle(base, b, a);
            triangle(a, b, tip);
        }
        vox_io_mesh *mesh = made(), *untouched = NULL;
        vox_io_tetrahedralize_desc desc = with_cell(0.01);
        desc.max_distance = 0.0002;
        ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT,
                 "0.0002 (max_distance) would take about");
        unsigned long long tets = 0;
        const char* found = strstr(vox_last_error(), ", ");
        ck_assert(found && sscanf(found + 2, "%llu tets", &tets) == 1);
        ck_assert_msg(tets < 1000000, "%llu tets were made first", tets);
        /* Its long triangles are sampled in rows: the tip that is lost is still found, exactly. */
        vox_io_mesh* short_of_it = stuffed(mesh, 0.004);
        vox_io_mesh_view view;
        ck_ok(vox_io_mesh_get_arrays(short_of_it, &view));
        double nearest = 2;
        const double p[3] = {diagonal ? 0.6 : 0, diagonal ? 0.6 : 0, diagonal ? 0.5 : 1};
        for (uint64_t v = 0; v < view.vertex_count; ++v)
            nearest =
                fmin(nearest, hypot(hypot(view.positions[3 * v] - p[0], view.positions[3 * v + 1] - p[1]),
                                    view.positions[3 * v + 2] - p[2]));
        ck_assert_double_eq_tol(quality_of(short_of_it, mesh).surface_to_mesh, nearest, 1e-3 * nearest);
        vox_io_mesh_destroy(short_of_it);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

/* ---- inside and outside ---- */

START_TEST(cavity) {
    const double pi = 3.14159265358979323846;
    add_sphere(0, 0, 0, 1, 30, 0);
    add_sphere(0, 0, 0, 0.5, 20, 1);
    vox_io_mesh* mesh = made();
    vox_io_mesh* tets = stuffed(mesh, 0.07);
    const solid_facts facts = check_stuffed(tets);
    ck_assert_double_eq_tol(facts.volume, 4 * pi / 3 * (1 - 0.125), 0.06);
    ck_assert_int_eq(facts.euler, 4); /* two spheres */
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(overlapping_parts_join) {
    add_box(0, 0, 0, 1, 1, 1, all_sides);
    add_box(0.5, 0.25, 0.25, 1.5, 0.75, 0.75, all_sides);
    vox_io_mesh* mesh = made();
    vox_io_mesh* tets = stuffed(mesh, 0.05);
    const solid_facts facts = check_stuffed(tets);
    ck_assert_double_eq_tol(facts.volume, 1.125, 0.01);
    ck_assert_int_eq(facts.euler, 2);
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(orientation_does_not_matter) {
    add_sphere(0.3, -7, 2, 1, 20, 0);
    vox_io_mesh* outwards = made();
    clear();
    add_sphere(0.3, -7, 2, 1, 20, 1);
    vox_io_mesh* inwards = made();
    s.triangles[3] ^= s.triangles[4];
    s.triangles[4] ^= s.triangles[3];
    s.triangles[3] ^= s.triangles[4]; /* one the other way round */
    vox_io_mesh* mixed = made();
    vox_io_mesh *a = stuffed(outwards, 0.1), *b = stuffed(inwards, 0.1), *c = stuffed(mixed, 0.1);
    check_stuffed(a);
    check_same(a, b);
    check_same(a, c);
    ck_assert_str_eq(vox_io_mesh_get_warnings(a), "");
    ck_assert_ptr_nonnull(strstr(vox_io_mesh_get_warnings(c), "orientation"));
    vox_io_mesh_destroy(a);
    vox_io_mesh_destroy(b);
    vox_io_mesh_destroy(c);
    vox_io_mesh_destroy(outwards);
    vox_io_mesh_destroy(inwards);
    vox_io_mesh_destroy(mixed);
}
END_TEST

START_TEST(soup_is_welded) {
    add_sphere(0, 0, 0, 1, 12, 0);
    vox_io_mesh* mesh = made();
    static surface soup;
    soup.vertices = soup.count = 0;
    for (uint64_t i = 0; i < 3 * s.count; ++i) {
        memcpy(soup.positions + 3 * soup.vertices, s.positions + 3 * s.triangles[i], 3 * sizeof(double));
        soup.triangles[i] = (uint32_t)soup.vertices++;
    }
    soup.count = s.count;
    s = soup;
    vox_io_mesh* apart = made();
    vox_io_mesh *a = stuffed(mesh, 0.1), *b = stuffed(apart, 0.1);
    check_same(a, b);
    vox_io_mesh_destroy(a);
    vox_io_mesh_destroy(b);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(apart);
}
END_TEST

START_TEST(small_hole_is_closed) {
    add_sphere(0, 0, 0, 1, 40, 0);
    s.triangles[3 * 700] = s.triangles[3 * 700 + 1]; /* one triangle of 6240 */
    vox_io_mesh* mesh = made();
    vox_io_mesh* tets = stuffed(mesh, 0.06);
    const solid_facts facts = check_stuffed(tets);
    ck_assert_double_eq_tol(facts.volume, 4.18879, 0.03);
    ck_assert_ptr_nonnull(strstr(vox_io_mesh_get_warnings(tets), "open edges"));
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(open_surfaces_are_refused) {
    const vox_io_tetrahedralize_desc desc = with_cell(0.05);
    vox_io_mesh* untouched = NULL;
    add_box(0, 0, 0, 1, 1, 1, no_top);
    vox_io_mesh* mesh = made();
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_MESH, "4 of its");
    vox_io_mesh_destroy(mesh);

    clear();
    add_sphere(0, 0, 0, 1, 30, 0);
    s.count -= s.count / 3;
    mesh = made();
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_MESH, "open");
    vox_io_mesh_destroy(mesh);

    clear();
    triangle(vertex(0, 0, 0), vertex(1, 0, 0.3), vertex(0, 1, 0.2));
    mesh = made();
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_MESH, "3 of its 3 edges");
    vox_io_mesh_destroy(mesh);
    ck_assert_ptr_null(untouched);
}
END_TEST

START_TEST(nothing_inside) {
    const vox_io_tetrahedralize_desc desc = with_cell(0);
    vox_io_mesh* untouched = NULL;
    /* A triangle, both sides of it: closed, without volume. */
    const uint32_t a = vertex(0, 0, 0), b = vertex(1, 0, 0.3), c = vertex(0, 1, 0.2);
    triangle(a, b, c);
    triangle(c, b, a);
    vox_io_mesh* mesh = made();
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no tet fits");
    vox_io_mesh_destroy(mesh);
    /* All in one point. */
    clear();
    triangle(vertex(1, 2, 3), vertex(1, 2, 3), vertex(1, 2, 3));
    mesh = made();
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no cells");
    vox_io_mesh_destroy(mesh);
    /* Cells far too large. */
    clear();
    add_box(0, 0, 0, 1, 1, 1, all_sides);
    mesh = made();
    const vox_io_tetrahedralize_desc large = with_cell(1e6);
    ck_fails(vox_io_tetrahedralize(mesh, &large, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no tet fits");
    vox_io_mesh_destroy(mesh);
    ck_assert_ptr_null(untouched);
}
END_TEST

START_TEST(any_place_and_scale) {
    /* Powers of two and what they carry: the same tets, moved and scaled. */
    vox_io_mesh* tets[3];
    static const double scale[] = {1, 0x1p-40, 0x1p60};
    for (int i = 0; i < 3; ++i) {
        clear();
        add_box(0, 0, 0, scale[i], 0.75 * scale[i], 0.5 * scale[i], all_sides);
        vox_io_mesh* mesh = made();
        tets[i] = stuffed(mesh, 0);
        vox_io_mesh_destroy(mesh);
    }
    const vox_io_mesh_view a = solid_view(tets[0]);
    for (int i = 1; i < 3; ++i) {
        const vox_io_mesh_view b = solid_view(tets[i]);
        ck_assert_uint_eq(a.tet_count, b.tet_count);
        ck_assert_uint_eq(a.vertex_count, b.vertex_count);
        for (size_t k = 0; k < 3 * a.vertex_count; ++k)
            ck_assert_double_eq(b.positions[k], a.positions[k] * scale[i]);
    }
    for (int i = 0; i < 3; ++i) vox_io_mesh_destroy(tets[i]);
    /* Far from the origin. */
    clear();
    add_sphere(1e6, -2e6, 3e6, 1, 20, 0);
    vox_io_mesh* mesh = made();
    vox_io_mesh* far_off = stuffed(mesh, 0.1);
    check_stuffed(far_off);
    vox_io_mesh_destroy(far_off);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* ---- options ---- */

START_TEST(coarser_inside) {
    add_sphere(0, 0, 0, 1, 40, 0);
    vox_io_mesh* mesh = made();
    vox_io_tetrahedralize_desc desc = with_cell(0.06);
    vox_io_mesh *fine = NULL, *coarse = NULL;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &fine));
    desc.coarsen = 3;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &coarse));
    const solid_facts f = check_stuffed(fine), c = check_stuffed(coarse);
    ck_assert_uint_lt(3 * solid_view(coarse).tet_count, 2 * solid_view(fine).tet_count);
    ck_assert_uint_eq(c.boundary_facets, f.boundary_facets);
    ck_assert_double_eq_tol(c.volume, f.volume, 1e-9);
    ck_assert_double_eq(quality_of(coarse, mesh).hausdorff, quality_of(fine, mesh).hausdorff);
    vox_io_mesh_destroy(fine);
    vox_io_mesh_destroy(coarse);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(cubes) {
    add_sphere(0, 0, 0, 1, 20, 0);
    vox_io_mesh* mesh = made();
    vox_io_tetrahedralize_desc desc = with_cell(0.1);
    desc.kind = VOX_IO_SOLID_CUBES;
    vox_io_mesh* tets = NULL;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &tets));
    solid_facts facts = check_solid(tets);
    const uint64_t all = solid_view(tets).tet_count;
    ck_assert_uint_eq(all % 5, 0);
    ck_assert_double_eq_tol(facts.volume, (double)all / 5 * 0.001, 1e-9);
    ck_assert_double_gt(facts.volume, 4.19);
    /* Cubes that reach out of the ball by less than their diagonal, and no gap inside. */
    ck_assert_double_lt(facts.volume, 4.19 * pow(1 + 0.1 * sqrt(3), 3));
    ck_assert_int_eq(facts.euler, 2);
    /* The surface lies inside: its vertices are farther from the boundary than nothing, and not farther than
     * a cube's diagonal. */
    ck_assert_double_le(quality_of(tets, mesh).hausdorff, 0.1 * sqrt(3) + 1e-9);
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);

    /* An open sheet: the cubes that it touches. The plane z = 0.5 between two lattice planes touches one
     * layer. */
    clear();
    const uint32_t a = vertex(0, 0, 0.5), b = vertex(1, 0, 0.5), c = vertex(1, 1, 0.5), d = vertex(0, 1, 0.5);
    triangle(a, b, c);
    triangle(a, c, d);
    mesh = made();
    desc.cell = 0.21;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &tets));
    facts = check_solid(tets);
    const uint64_t sheet = solid_view(tets).tet_count;
    ck_assert_msg(sheet == 5 * 5 * 5 || sheet == 2 * 5 * 5 * 5, "%llu tets", (unsigned long long)sheet);
    vox_io_mesh_destroy(tets);
    vox_io_mesh_destroy(mesh);
}
END_TEST

typedef struct {
    double last;
    int calls, cancel_at;
} progress_log;

static int32_t log_progress(double fraction, void* user) {
    progress_log* log = user;
    ck_assert_double_ge(fraction, log->last);
    ck_assert_double_le(fraction, 1);
    log->last = fraction;
    return ++log->calls == log->cancel_at;
}

START_TEST(progress_and_cancel) {
    add_sphere(0, 0, 0, 1, 20, 0);
    vox_io_mesh* mesh = made();
    vox_io_tetrahedralize_desc desc = with_cell(0.2);
    progress_log log = {0, 0, 0};
    vox_io_mesh* tets = NULL;
    desc.progress = log_progress;
    desc.progress_user = &log;
    desc.max_distance = 0.02;
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &tets));
    ck_assert_double_eq(log.last, 1);
    const int calls = log.calls;
    ck_assert_int_gt(calls, 10);
    vox_io_mesh_destroy(tets);
    for (int at = 1; at <= calls; at += 4) {
        vox_io_mesh* untouched = NULL;
        log = (progress_log){0, 0, at};
        ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_STATE, "cancelled");
        ck_assert_int_eq(log.calls, at);
        ck_assert_ptr_null(untouched);
    }
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(old_and_new_structs) {
    add_sphere(0, 0, 0, 1, 12, 0);
    vox_io_mesh* mesh = made();
    vox_io_tetrahedralize_desc desc;
    memset(&desc, 0xff, sizeof desc);
    desc.struct_size = offsetof(vox_io_tetrahedralize_desc, max_tets);
    desc.kind = VOX_IO_SOLID_STUFFED;
    desc.cell = 0.2; /* what lies behind is not read */
    vox_io_mesh *a = NULL, *b = stuffed(mesh, 0.2);
    ck_ok(vox_io_tetrahedralize(mesh, &desc, &a));
    check_same(a, b);
    vox_io_quality quality;
    memset(&quality, 0xee, sizeof quality);
    quality.struct_size = offsetof(vox_io_quality, tets);
    ck_ok(vox_io_mesh_measure(a, NULL, &quality));
    ck_assert_uint_eq(quality.vertices, solid_view(a).vertex_count);
    ck_assert_uint_eq(quality.tets, 0xeeeeeeeeeeeeeeeeu);
    vox_io_mesh_destroy(a);
    vox_io_mesh_destroy(b);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(bad_arguments) {
    static const double bad[] = {-1, INFINITY, -INFINITY, NAN};
    vox_io_mesh* untouched = NULL;
    vox_io_quality quality;
    vox_io_tetrahedralize_desc desc;
    add_box(0, 0, 0, 1, 1, 1, all_sides);
    vox_io_mesh* mesh = made();
    ck_fails(vox_io_tetrahedralize(NULL, NULL, &untouched), VOX_ERROR_INVALID_ARGUMENT, "surface is null");
    ck_fails(vox_io_tetrahedralize(mesh, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        desc = with_cell(bad[i]);
        ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "desc.cell is");
        desc = with_cell(0);
        desc.max_distance = bad[i];
        ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT,
                 "max_distance is");
    }
    desc = with_cell(0);
    desc.kind = (vox_io_solid_kind)2;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "desc.kind is 2");
    desc = with_cell(0);
    desc.max_tets = UINT64_MAX;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "max_tets is");
    desc.max_tets = 1000;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT,
             "about 1500000 tets, more than 1000 (max_tets)");
    desc.kind = VOX_IO_SOLID_CUBES;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT, "at most 1000");
    desc = with_cell(0);
    desc.reserved = 1;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "reserved is 1");
    desc = with_cell(0);
    desc.struct_size = 3;
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 3");
    desc = with_cell(1e-5);
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT, "100000 cells along x");
    desc = with_cell(1e-310);
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no cells");
    desc = with_cell(1 / 600.0); /* 600^3 cells: refused before they are laid out */
    ck_fails(vox_io_tetrahedralize(mesh, &desc, &untouched), VOX_ERROR_LIMIT, "choose larger cells");

    vox_io_mesh* box = NULL;
    ck_ok(vox_io_make_box(1, 1, 1, 0.5, &box));
    ck_fails(vox_io_tetrahedralize(box, NULL, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no triangles");
    ck_fails(vox_io_mesh_measure(NULL, NULL, &quality), VOX_ERROR_INVALID_ARGUMENT, "mesh is null");
    ck_fails(vox_io_mesh_measure(box, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_quality is null");
    quality.struct_size = 2;
    ck_fails(vox_io_mesh_measure(box, NULL, &quality), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 2");
    quality = quality_of(mesh, mesh); /* a surface has no tets to measure */
    ck_assert_uint_eq(quality.tets, 0);
    ck_assert_double_eq(quality.hausdorff, 0);
    ck_assert_ptr_null(untouched);
    vox_io_mesh_destroy(box);
    vox_io_mesh_destroy(mesh);
}
END_TEST

SUITE(solid_surfaces) {
    TCase* tests = add_case(suite, "surfaces");
    tcase_add_checked_fixture(tests, clear, NULL);
    tcase_add_loop_test(tests, box, 0, 4);
    tcase_add_each(tests, distance_is_exact, kept_distance, thin_spike, cavity, overlapping_parts_join,
                   orientation_does_not_matter, soup_is_welded, small_hole_is_closed,
                   open_surfaces_are_refused, nothing_inside, any_place_and_scale, cubes, progress_and_cancel,
                   old_and_new_structs, bad_arguments);
    TCase* large = add_tagged_case(suite, "large", "large");
    tcase_add_checked_fixture(large, clear, NULL);
    tcase_add_each(large, sphere, coarser_inside);
}
