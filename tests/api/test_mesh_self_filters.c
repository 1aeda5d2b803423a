/* Filters of self-contact, of vertices and tetrahedra of one mesh, against brute force in exact arithmetic
 * with the filters applied by definition; what they cost. */
#include <math.h>

#include "scenes/random.h"
#include "support/filter_checks.h"
#include "support/ledger.h"
#include "support/oracle.h"

/* ---- self-contact, by definition -------------------------------------------------------------- */

typedef struct shape {
    float* positions;
    float* rest;
    uint32_t* tets;
    uint32_t vertex_count, tet_count;
    uint32_t rings;
    double rest_distance;
    uint8_t* distance; /* along edges, vertex_count * vertex_count */
} shape;

/* Distances along edges, by relaxing all tetrahedra until nothing changes: not the library's search. */
static void find_distances(shape* s) {
    const uint32_t n = s->vertex_count;
    s->distance = (uint8_t*)malloc((size_t)n * n + 1);
    memset(s->distance, 255, (size_t)n * n);
    for (uint32_t v = 0; v < n; ++v) {
        uint8_t* d = s->distance + (size_t)v * n;
        d[v] = 0;
        for (int changed = 1; changed;) {
            changed = 0;
            for (uint32_t t = 0; t < s->tet_count; ++t) {
                const uint32_t* c = s->tets + 4 * t;
                uint8_t least = 255;
                for (int i = 0; i < 4; ++i) least = d[c[i]] < least ? d[c[i]] : least;
                for (int i = 0; i < 4 && least < 254; ++i)
                    if (d[c[i]] > least + 1) {
                        d[c[i]] = (uint8_t)(least + 1);
                        changed = 1;
                    }
            }
        }
    }
}

/* Distance from p to the hull of n points: the least over all faces of the simplex whose closest point, by
 * the normal equations, has weights >= 0. Weight 0 is p's own; degenerate faces are left to their sub-faces.
 */
static double simplex_distance(const double p[3], const double points[][3], int n) {
    double best = INFINITY;
    for (int face = 1; face < 1 << n; ++face) {
        int corner[4], m = 0;
        for (int i = 0; i < n; ++i)
            if (face >> i & 1) corner[m++] = i;
        double a[3][4] = {{0}}; /* normal equations of the m - 1 edges from corner[0] */
        const double* origin = points[corner[0]];
        for (int i = 1; i < m; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const double e = points[corner[i]][axis] - origin[axis];
                for (int j = 1; j < m; ++j) a[i - 1][j - 1] += e * (points[corner[j]][axis] - origin[axis]);
                a[i - 1][3] += e * (p[axis] - origin[axis]);
            }
        const int unknowns = m - 1;
        int solved = 1;
        for (int i = 0; i < unknowns && solved; ++i) { /* Gauss-Jordan with pivoting */
            int pivot = i;
            for (int r = i + 1; r < unknowns; ++r)
                if (fabs(a[r][i]) > fabs(a[pivot][i])) pivot = r;
            for (int c = 0; c < 4; ++c) {
                const double kept = a[i][c];
                a[i][c] = a[pivot][c];
                a[pivot][c] = kept;
            }
            solved = fabs(a[i][i]) > 1e-9;
            for (int r = 0; r < unknowns && solved; ++r) {
                if (r == i) continue;
                const double f = a[r][i] / a[i][i];
                for (int c = 0; c < 4; ++c) a[r][c] -= f * a[i][c];
            }
        }
        double weight = 1, offset[3] = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
        for (int i = 0; i < unknowns && solved; ++i) {
            const double w = a[i][3] / a[i][i];
            solved = w >= -1e-12;
            weight -= w;
            for (int axis = 0; axis < 3; ++axis)
                offset[axis] -= w * (points[corner[i + 1]][axis] - origin[axis]);
        }
        if (!solved || weight < -1e-12) continue;
        const double d = sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
        best = d < best ? d : best;
    }
    return best;
}

static int is_filtered(const shape* s, uint32_t vertex, const uint32_t* tet) {
    for (int c = 0; c < 4 && s->rings; ++c)
        if (s->distance[(size_t)vertex * s->vertex_count + tet[c]] <= s->rings) return 1;
    if (s->rest_distance <= 0) return 0;
    double p[3], corners[4][3];
    for (int axis = 0; axis < 3; ++axis) {
        p[axis] = (double)s->rest[3 * vertex + axis];
        for (int c = 0; c < 4; ++c) corners[c][axis] = (double)s->rest[3 * tet[c] + axis];
    }
    return simplex_distance(p, (const double(*)[3])corners, 4) < s->rest_distance;
}

/* The contacts that hits amount to without the filtered ones. */
static size_t filtered_contacts(const shape* shapes, const oracle_contact* hits, size_t count,
                                oracle_contact* out, uint64_t* dropped) {
    size_t kept = 0, left = 0;
    oracle_contact* rest = (oracle_contact*)malloc((count + 1) * sizeof *rest);
    for (size_t i = 0; i < count; ++i) {
        const oracle_contact* h = &hits[i];
        if (h->body_a == h->body_b &&
            is_filtered(&shapes[h->body_a], h->vertex, shapes[h->body_a].tets + 4 * h->tet))
            ++*dropped;
        else
            rest[left++] = *h;
    }
    for (size_t begin = 0, end; begin < left; begin = end) {
        int interior = 0;
        for (end = begin; end < left && rest[end].body_a == rest[begin].body_a &&
                          rest[end].vertex == rest[begin].vertex && rest[end].body_b == rest[begin].body_b;
             ++end)
            interior += rest[end].interior;
        if (!interior) out[kept++] = rest[begin];
        for (size_t h = begin; h < end; ++h)
            if (rest[h].interior) out[kept++] = rest[h];
    }
    free(rest);
    return kept;
}

/* A box crumpled so that it meets itself; by quarters of its edge when `coarse`, so that vertices fall on
 * faces, edges and corners of tets they are not part of. */
static shape crumpled(uint32_t n, int coarse, uint64_t* random) {
    body box = make_box(n, 1, 0, 0, 0);
    shape s = {box.positions, NULL, box.tets, box.vertex_count, box.tet_count, 0, 0, NULL};
    const size_t bytes = 3 * sizeof(float) * box.vertex_count;
    s.rest = (float*)malloc(bytes);
    memcpy(s.rest, s.positions, bytes);
    for (uint32_t i = 0; i < 3 * box.vertex_count; ++i) {
        const float moved = s.positions[i] * 0.5f + random_float(random, -0.75f, 0.75f);
        s.positions[i] = coarse ? 0.5f * roundf(2 * moved) : moved;
    }
    find_distances(&s);
    return s;
}

static void free_shape(shape* s) {
    free(s->positions);
    free(s->rest);
    free(s->tets);
    free(s->distance);
}

START_TEST(self_filters_by_definition) {
    uint64_t random = 1, all_dropped = 0, all_kept = 0;
    for (int scene = 0; scene < 60; ++scene) {
        shape shapes[2];
        oracle_mesh meshes[2];
        vox_body ids[2];
        vox_grid* grid = new_grid();
        for (int m = 0; m < 2; ++m) {
            shapes[m] = crumpled(1 + random_below(&random, 3), scene % 2, &random);
            shapes[m].rings = random_below(&random, 4);
            /* Not a distance that a lattice of unit edges has, where rounding would decide. */
            shapes[m].rest_distance =
                random_below(&random, 2) ? (double)random_float(&random, 0.01f, 2.5f) : 0;
            const shape* s = &shapes[m];
            vox_mesh_desc desc = vox_mesh_desc_floats(s->positions, s->vertex_count, s->tets, s->tet_count);
            vox_filter filter = plain_filter();
            filter.flags = VOX_FILTER_SELF_COLLISION;
            filter.self_rings = s->rings;
            filter.self_rest_distance = s->rest_distance;
            desc.rest_positions = vox_float_positions(s->rest, s->vertex_count);
            const int at_insertion = (int)random_below(&random, 2);
            if (at_insertion) desc.filter = filter;
            ids[m] = insert(grid, &desc);
            if (!at_insertion) ck_ok(vox_body_set_filter(grid, ids[m], &filter));
            meshes[m] = (oracle_mesh){s->positions, s->tets, s->vertex_count, s->tet_count, 1};
        }
        oracle_contact* hits = NULL;
        const size_t hit_count = oracle_hits(meshes, 2, &hits);
        oracle_contact* expected = (oracle_contact*)malloc((hit_count + 1) * sizeof *expected);
        uint64_t dropped = 0;
        const size_t count = filtered_contacts(shapes, hits, hit_count, expected, &dropped);
        const vox_contact_view view = stepped(grid);
        ck_assert_msg(view.count == count, "scene %d: %llu contacts, expected %zu", scene,
                      (unsigned long long)view.count, count);
        for (size_t i = 0; i < count; ++i) {
            ck_assert_uint_eq(view.data[i].body_a, ids[expected[i].body_a]);
            ck_assert_uint_eq(view.data[i].vertex, expected[i].vertex);
            ck_assert_uint_eq(view.data[i].body_b, ids[expected[i].body_b]);
            ck_assert_uint_eq(view.data[i].tet, expected[i].tet);
        }
        ck_assert_uint_eq(counters_of(grid).filtered, dropped);
        all_dropped += dropped;
        all_kept += count;
        free(hits);
        free(expected);
        vox_grid_destroy(grid);
        for (int m = 0; m < 2; ++m) free_shape(&shapes[m]);
    }
    ck_assert_uint_gt(all_dropped, 1000);
    ck_assert_uint_gt(all_kept, 1000);
}
END_TEST

/* Two tets share the face that a vertex lies on. The lower one is within an edge of the vertex, so with a
 * ring the higher one, which is not, takes its place. */
START_TEST(lowest_tet_that_is_left) {
    const float positions[] = {0,     0,     0,     1, 0,     0,     0,  1,
                               0,     0.25f, 0.25f, 1, 0.25f, 0.25f, -1, /* the two tets */
                               0.25f, 0.25f, 0,                          /* the vertex */
                               5,     0,     0,     5, 1,     0};
    /* 0: away, joins the vertex to corner 3; 1: above the face, 2: below it */
    const uint32_t tets[] = {5, 6, 7, 3, 0, 1, 2, 3, 0, 1, 2, 4};
    vox_grid* grid = new_grid();
    vox_mesh_desc desc = vox_mesh_desc_floats(positions, 8, tets, 3);
    vox_filter filter = plain_filter();
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    const vox_body mesh = insert(grid, &desc);
    vox_contact_view view = stepped(grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert_uint_eq(view.data[0].vertex, 5);
    ck_assert_uint_eq(view.data[0].tet, 1);
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    view = stepped(grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert_uint_eq(view.data[0].vertex, 5);
    ck_assert_uint_eq(view.data[0].tet, 2);
    filter.self_rings = 2; /* corners 0, 1, 2 are two edges away */
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    vox_grid_destroy(grid);
}
END_TEST

/* A body that overlaps itself in the rest pose (two boxes in one mesh) and does not move: no contact at any
 * distance; pressed together further, only what was apart. */
START_TEST(overlap_in_the_rest_pose) {
    body low = make_box(2, 1, 0, 0, 0), high = make_box(2, 1, 0.25f, 0.25f, 1.75f);
    const uint32_t n = low.vertex_count, m = low.tet_count;
    float* positions = (float*)malloc(6 * sizeof(float) * n);
    uint32_t* tets = (uint32_t*)malloc(8 * sizeof(uint32_t) * m);
    memcpy(positions, low.positions, 3 * sizeof(float) * n);
    memcpy(positions + 3 * n, high.positions, 3 * sizeof(float) * n);
    for (uint32_t i = 0; i < 4 * m; ++i) {
        tets[i] = low.tets[i];
        tets[4 * m + i] = high.tets[i] + n;
    }
    vox_grid* grid = new_grid();
    vox_mesh_desc desc = vox_mesh_desc_floats(positions, 2 * n, tets, 2 * m);
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    const vox_body mesh = insert(grid, &desc);
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    const uint64_t overlapping = stepped(grid).count;
    ck_assert_uint_gt(overlapping, 0);
    filter.self_rest_distance = 1e-30; /* the rest pose is taken here */
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    ck_assert_uint_eq(counters_of(grid).filtered > 0, 1);
    for (uint32_t v = n; v < 2 * n; ++v) positions[3 * v + 2] -= 1; /* deeper: new ones */
    ck_assert_uint_gt(stepped(grid).count, 0);
    filter.self_rest_distance = 0.1; /* and here it is kept */
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_gt(stepped(grid).count, 0);
    filter.self_rest_distance = 10;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    filter.self_rest_distance = 0;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_gt(stepped(grid).count, overlapping);
    filter.flags = 0;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    vox_grid_destroy(grid);
    free(positions);
    free(tets);
    free_body(&low);
    free_body(&high);
}
END_TEST

/* A rest pose in double, with a stride: the vertex is 0.5 away from the tet at rest, and in it now. */
START_TEST(rest_pose_in_double) {
    const double rest[5][4] = {{0, 0, 0, 9}, {1, 0, 0, 9}, {0, 1, 0, 9}, {0, 0, 1, 9}, {0.25, 0.25, -0.5, 9}};
    const double now[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.125, 0.25, 0.125};
    vox_grid* grid = new_grid();
    vox_mesh_desc desc = vox_default_mesh_desc();
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rest_distance = 0.5;
    desc.positions = vox_double_positions(now, 5);
    desc.tets = unit_tet;
    desc.tet_count = 1;
    desc.filter = filter;
    desc.rest_positions = vox_double_positions(&rest[0][0], 5);
    desc.rest_positions.byte_stride = sizeof rest[0];
    const vox_body mesh = insert(grid, &desc);
    ck_assert_uint_eq(stepped(grid).count, 1); /* not closer than that */
    filter.self_rest_distance = 0.50000001;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    vox_grid_destroy(grid);
}
END_TEST

/* Two tets that are 1 apart at rest, and in one another now, far from the origin: floats would take them for
 * close. */
static void far_apart(double offset, double rest[24], double now[24]) {
    static const double second[12] = {2, 0, 0, 3, 0, 0, 2, 1, 0, 2, 0, 1};
    for (int i = 0; i < 24; ++i) {
        rest[i] = offset + (i < 12 ? (double)unit_tet_positions[i] : second[i - 12]);
        now[i] = rest[i] - (i < 12 ? 0 : i % 3 == 0 ? 1.9 : i < 18 ? -0.1 : 0);
    }
}
static const uint32_t two_tets[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static void check_far_apart(vox_grid* grid, uint64_t contacts) {
    ck_assert_uint_eq(stepped(grid).count, contacts);
    ck_assert_uint_eq(counters_of(grid).filtered, 0);
}

START_TEST(rest_pose_far_away) {
    static const double offsets[] = {0, 1e7, 1e8, -1e9, 1e12};
    uint64_t contacts = 0;
    for (int i = 0; i < 5; ++i) {
        double rest[24], now[24];
        uint64_t size = 0;
        far_apart(offsets[i], rest, now);
        vox_grid *grid = new_grid(), *loaded;
        vox_mesh_desc desc = vox_mesh_desc_floats(NULL, 8, two_tets, 2);
        vox_filter filter = plain_filter();
        filter.flags = VOX_FILTER_SELF_COLLISION;
        filter.self_rest_distance = 0.5;
        desc.positions = vox_double_positions(now, 8);
        desc.rest_positions = vox_double_positions(rest, 8);
        desc.filter = filter;
        insert(grid, &desc);
        if (i == 0) contacts = stepped(grid).count;
        ck_assert_uint_gt(contacts, 0);
        check_far_apart(grid, contacts);

        ck_ok(vox_grid_save(grid, NULL, 0, &size));
        unsigned char* bytes = (unsigned char*)malloc((size_t)size);
        ck_ok(vox_grid_save(grid, bytes, size, &size));
        ck_ok(vox_grid_load(bytes, size, NULL, &loaded));
        check_far_apart(loaded, contacts);
        free(bytes);
        vox_grid_destroy(loaded);
        vox_grid_destroy(grid);
    }
}
END_TEST

/* A rest pose that floats hold until vertices are appended, given or copied, that they do not. */
START_TEST(rest_pose_that_grows) {
    double rest[24], now[24];
    uint32_t first;
    far_apart(1e8 + 3, rest, now);
    for (int i = 0; i < 12; ++i) now[i] = rest[i] = (double)(float)rest[i]; /* all one point */
    vox_grid* grid = new_grid();
    vox_mesh_desc desc = vox_mesh_desc_floats(NULL, 4, unit_tet, 1);
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rest_distance = 0.5;
    desc.positions = vox_double_positions(now, 4);
    desc.filter = filter;
    const vox_body mesh = insert(grid, &desc);

    /* The first tet once more, and the second. */
    double grown_rest[48], grown[48];
    far_apart(1e8 + 3, rest, now);
    for (int i = 0; i < 48; ++i)
        grown[i] = i < 12 ? (double)(float)rest[i] : i < 36 ? now[i - 12] : now[i - 24];
    memcpy(grown_rest, rest, sizeof rest);
    vox_vertices_desc more = vox_default_vertices_desc();
    more.count = 8;
    more.positions = vox_double_positions(grown, 12);
    more.rest_positions = vox_double_positions(grown_rest, 8);
    ck_ok(vox_mesh_append_vertices(grid, mesh, &more, &first));
    ck_assert_uint_eq(first, 4);
    const uint32_t copied[4] = {8, 9, 10, 11};
    more.count = 4;
    more.positions.count = 16;
    more.rest_positions.data = NULL;
    more.copies_of = copied;
    ck_ok(vox_mesh_append_vertices(grid, mesh, &more, &first));
    ck_assert_uint_eq(first, 12);
    /* The second tet, of copies of its vertices. */
    const uint32_t tets[8] = {4, 5, 6, 7, 12, 13, 14, 15};
    ck_ok(vox_mesh_append_tets(grid, mesh, tets, 2, &first));
    ck_assert_uint_gt(stepped(grid).count, 0);
    const uint64_t filtered = counters_of(grid).filtered;
    filter.self_rest_distance = 1.5; /* now they are close at rest */
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    ck_assert_uint_eq(stepped(grid).count, 0);
    ck_assert_uint_gt(counters_of(grid).filtered, filtered);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- memory ----------------------------------------------------------------------------------- */

static vox_grid* counted_grid(ledger* l) {
    vox_grid_desc desc = engine_desc();
    desc.flags = 0;
    desc.allocator = ledger_allocator(l);
    return grid_of(&desc);
}

START_TEST(steps_with_filters_allocate_nothing) {
    ledger l = {0};
    uint64_t random = 9;
    vox_grid* grid = counted_grid(&l);
    shape s = crumpled(4, 0, &random);
    body others[3] = {make_box(3, 1, 0, 0, 0), make_box(3, 1, 0.5f, 0.5f, 0.5f), make_box(3, 1, 1, 1, 1)};
    vox_mesh_desc desc = vox_mesh_desc_floats(s.positions, s.vertex_count, s.tets, s.tet_count);
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 2;
    filter.self_rest_distance = 0.25;
    filter.category = 2;
    desc.filter = filter;
    insert(grid, &desc);
    vox_body meshes[3];
    vox_filter blind = plain_filter();
    blind.mask = 1;
    for (int i = 0; i < 3; ++i) {
        desc = body_desc(&others[i]);
        desc.filter = i == 0 ? blind : plain_filter();
        meshes[i] = insert(grid, &desc);
    }
    ck_ok(vox_grid_set_pair_enabled(grid, meshes[1], meshes[2], 0));
    uint64_t before = 0;
    for (int frame = 0; frame < 12; ++frame) {
        if (frame == 4) before = l.calls;
        for (uint32_t i = 0; i < 3 * s.vertex_count; ++i) s.positions[i] *= frame % 2 ? 0.5f : 2;
        ck_assert_uint_gt(stepped(grid).count, 0);
        ck_assert_uint_gt(counters_of(grid).filtered, 0);
    }
    ck_assert_uint_eq(l.calls, before);
    vox_grid_destroy(grid);
    free_shape(&s);
    for (int i = 0; i < 3; ++i) free_body(&others[i]);
}
END_TEST

/* Out of memory at every call: nothing has changed then. */
START_TEST(failing_filters_change_nothing) {
    ledger l = {0}, fresh_l = {0};
    uint64_t random = 2;
    shape s = crumpled(2, 1, &random);
    body box = make_box(2, 1, 0, 0, 0);
    const vox_mesh_desc desc = vox_mesh_desc_floats(s.positions, s.vertex_count, s.tets, s.tet_count),
                        other = body_desc(&box);
    vox_grid* grid = counted_grid(&l);
    const vox_body mesh = insert(grid, &desc), second = insert(grid, &other);
    const uint64_t count = stepped(grid).count;
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 2;
    filter.self_rest_distance = 1;
    uint64_t failures = 0;
    for (vox_result result = VOX_ERROR_OUT_OF_MEMORY; result != VOX_OK; ++failures) {
        l.fail_at = l.calls + 1 + failures;
        result = vox_body_set_filter(grid, mesh, &filter);
        l.fail_at = 0;
        if (result == VOX_OK) break;
        ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_assert_uint_eq(filter_of(grid, mesh).flags, 0);
        ck_assert_uint_eq(stepped(grid).count, count);
    }
    ck_assert_uint_gt(failures, 4);
    const uint64_t filtered = stepped(grid).count;

    /* Nor has a rest pose been taken: here every failing call sees another one, in which all is close to all.
     */
    vox_grid* fresh = counted_grid(&fresh_l);
    const size_t bytes = 3 * sizeof(float) * s.vertex_count;
    float* kept = (float*)malloc(bytes);
    memcpy(kept, s.positions, bytes);
    const vox_body again = insert(fresh, &desc);
    insert(fresh, &other);
    ck_ok(vox_grid_step(fresh));
    memset(s.positions, 0, bytes);
    for (uint64_t failure = 1; failure <= failures; ++failure) {
        fresh_l.fail_at = fresh_l.calls + failure;
        ck_assert_int_eq(vox_body_set_filter(fresh, again, &filter), VOX_ERROR_OUT_OF_MEMORY);
    }
    memcpy(s.positions, kept, bytes);
    fresh_l.fail_at = 0;
    ck_ok(vox_body_set_filter(fresh, again, &filter));
    ck_assert_uint_eq(stepped(fresh).count, filtered);
    vox_grid_destroy(fresh);
    free(kept);
    for (vox_result result = VOX_ERROR_OUT_OF_MEMORY; result != VOX_OK;) {
        static uint64_t at = 0;
        l.fail_at = l.calls + ++at;
        result = vox_grid_set_pair_enabled(grid, mesh, second, 0);
        l.fail_at = 0;
        const uint64_t between = contacts_between(stepped(grid), mesh, second);
        ck_assert_int_eq(between == 0, result == VOX_OK);
    }
    vox_grid_destroy(grid);
    free_shape(&s);
    free_body(&box);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, lowest_tet_that_is_left, overlap_in_the_rest_pose, rest_pose_in_double,
                   rest_pose_far_away, rest_pose_that_grows, steps_with_filters_allocate_nothing,
                   failing_filters_change_nothing);
}

static void add_long_tests(TCase* tests) { tcase_add_test(tests, self_filters_by_definition); }

SUITE(mesh_self_filters) {
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
}
