/* VOX_COST_MODEL_SURFACE: the surfaces of meshes, beside the vox_surface that they make. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox_surface.h>

#include "support/ledger.h"
#include "support/suggest_scenes.h"

static vox_cell_size_desc surface_desc(void) {
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = VOX_COST_MODEL_SURFACE;
    return desc;
}

/* The facets that a tetrahedron shares with no other one, in the order of tetrahedra. */
static uint32_t* surface_of(const body* b, uint64_t* out_count) {
    static const int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    uint32_t* faces = (uint32_t*)malloc(sizeof(uint32_t) * 12 * b->tet_count);
    *out_count = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t)
        for (int f = 0; f < 4; ++f) {
            const uint32_t* face[3];
            for (int c = 0; c < 3; ++c) face[c] = &b->tets[4 * t + (uint32_t)corners[f][c]];
            int shared = 0;
            for (uint32_t u = 0; u < b->tet_count && !shared; ++u) {
                int common = 0;
                for (int c = 0; u != t && c < 3; ++c)
                    for (int d = 0; d < 4; ++d) common += b->tets[4 * u + (uint32_t)d] == *face[c];
                shared = common == 3;
            }
            for (int c = 0; !shared && c < 3; ++c) faces[3 * *out_count + (uint32_t)c] = *face[c];
            *out_count += !shared;
        }
    return faces;
}

static vox_cell_size_result of_kinds(vox_surface* surface, vox_feature a, vox_feature b) {
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    ck_ok(vox_surface_suggest_cell_size(surface, a, b, &found));
    return found;
}

/* The same work as that of the surface's own two searches, so the size lies between those that are best for
 * either. */
START_TEST(the_size_of_the_surface_that_the_meshes_make) {
    body box = make_box(10, 0.5f, 0, 0, 0);
    jitter_body(&box, 0.05, 3);
    const vox_mesh_desc mesh = body_desc(&box);
    const vox_cell_size_desc desc = surface_desc();
    const vox_cell_size_result found = suggest_ok(&desc, &mesh, 1);

    vox_surface_desc surface_of_box = vox_default_surface_desc();
    uint32_t* faces = surface_of(&box, &surface_of_box.face_count);
    ck_assert_uint_eq(surface_of_box.face_count, 6 * 2 * 10 * 10);
    surface_of_box.faces = faces;
    surface_of_box.vertex_count = box.vertex_count;
    vox_surface* surface = NULL;
    ck_ok(vox_surface_create(&surface_of_box, &surface));
    vox_motion motion = vox_default_motion();
    motion.from.data = box.positions;
    motion.from.count = motion.to.count = box.vertex_count;
    motion.from.format = motion.to.format = VOX_FORMAT_FLOAT;
    ck_ok(vox_surface_move(surface, &motion));
    const vox_cell_size_result edges = of_kinds(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE);
    ck_assert_double_gt(edges.cost, 0);
    ck_assert_double_ge(found.cost, edges.cost);
    ck_assert_double_lt(found.cost, 10 * edges.cost); /* both in seconds */
    ck_assert_double_gt(found.cell_size, edges.zone_min / 4);
    ck_assert_double_lt(found.cell_size, edges.zone_max * 4);
    ck_assert_uint_gt(found.curve_count, 30);
    for (uint32_t i = 0; i < found.curve_count; ++i) /* none is better */
        ck_assert_double_ge(found.curve[i].cost, found.cost * (1 - 1e-3));
    /* The surface takes it, and answers the same. */
    vox_partner_lists lists;
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
    const uint64_t pairs = lists.offsets[lists.count];
    ck_ok(vox_surface_set_cell_size(surface, found.cell_size));
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
    ck_assert_uint_eq(lists.offsets[lists.count], pairs);
    vox_surface_destroy(surface);
    free(faces);
    free_body(&box);
}
END_TEST

/* What is disabled is not there, in a grid as in an array; and inner vertices play no part. */
START_TEST(of_the_tetrahedra_that_are_there) {
    body box = make_box(6, 0.5f, 0, 0, 0), half = make_box(6, 0.5f, 0, 0, 0);
    half.tet_count /= 2;
    vox_grid* grid = grid_of(NULL);
    const vox_mesh_desc whole = body_desc(&box), part = body_desc(&half);
    const vox_body mesh = insert_mesh(grid, &whole);
    const vox_cell_size_desc desc = surface_desc();
    vox_cell_size_result in_grid;
    in_grid.struct_size = sizeof in_grid;
    ck_ok(vox_grid_suggest_cell_size(grid, &desc, &in_grid));
    ck_assert_double_eq(in_grid.cell_size, suggest_ok(&desc, &whole, 1).cell_size);
    uint32_t* off = (uint32_t*)malloc(sizeof(uint32_t) * box.tet_count);
    for (uint32_t t = half.tet_count; t < box.tet_count; ++t) off[t - half.tet_count] = t;
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, off, box.tet_count - half.tet_count, 0));
    ck_ok(vox_grid_suggest_cell_size(grid, &desc, &in_grid));
    ck_assert_double_eq(in_grid.cell_size, suggest_ok(&desc, &part, 1).cell_size);
    vox_grid_destroy(grid);
    free(off);
    free_body(&box);
    free_body(&half);
}
END_TEST

START_TEST(what_has_no_surface) {
    const vox_cell_size_desc desc = surface_desc();
    vox_cell_size_result out;
    memset(&out, 0x55, sizeof out);
    out.struct_size = sizeof out;
    const vox_cell_size_result before = out;
    float at[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    const uint32_t sphere[20] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 3, 4, 0, 2, 3, 4, 1, 2, 3, 4};
    vox_mesh_desc mesh = vox_mesh_desc_floats(at, 5, sphere, 0);
    ck_fails(vox_suggest_cell_size(&desc, &mesh, 1, &out), VOX_ERROR_INVALID_ARGUMENT,
             "no tetrahedra: 5 vertices alone give no surface");
    ck_fails(vox_suggest_cell_size(&desc, NULL, 0, &out), VOX_ERROR_INVALID_ARGUMENT,
             "no tetrahedra: 0 vertices");
    mesh.tet_count = 5; /* each facet belongs to two of them */
    ck_fails(vox_suggest_cell_size(&desc, &mesh, 1, &out), VOX_ERROR_INVALID_ARGUMENT, "no surface");
    mesh.tet_count = 1;
    at[4] = NAN;
    ck_fails(vox_suggest_cell_size(&desc, &mesh, 1, &out), VOX_ERROR_NON_FINITE, "vertex 1");
    memset(at, 0, sizeof at);
    ck_fails(vox_suggest_cell_size(&desc, &mesh, 1, &out), VOX_ERROR_INVALID_ARGUMENT, "1 tets of no size");
    ck_assert_mem_eq(&out, &before, sizeof out);
    /* Twice the same tetrahedron is one; sizes at the ends of the range. */
    const uint32_t doubled[8] = {0, 1, 2, 3, 0, 1, 2, 3};
    const float sizes[] = {1, 1e-30f, 3e38f};
    for (int i = 0; i < 3; ++i) {
        const float a = sizes[i];
        const float corners[12] = {0, 0, 0, a, 0, 0, 0, a, 0, 0, 0, a};
        mesh = vox_mesh_desc_floats(corners, 4, doubled, 2);
        const vox_cell_size_result found = suggest_ok(&desc, &mesh, 1);
        ck_assert(found.cell_size > 0 && isfinite(found.cell_size));
        ck_assert(found.zone_min <= found.cell_size && found.cell_size <= found.zone_max);
        ck_assert(isfinite(found.cost));
    }
}
END_TEST

/* All memory is from the caller's functions, and given back. */
START_TEST(memory_is_the_callers) {
    body box = make_box(4, 0.5f, 0, 0, 0);
    const vox_mesh_desc mesh = body_desc(&box);
    uint64_t calls = 0;
    for (uint64_t fail_at = 0; fail_at <= calls; fail_at += 1 + fail_at / 8) {
        ledger book = {0};
        book.fail_at = fail_at;
        vox_cell_size_desc desc = surface_desc();
        desc.allocator = ledger_allocator(&book);
        vox_cell_size_result out;
        out.struct_size = sizeof out;
        const vox_result result = vox_suggest_cell_size(&desc, &mesh, 1, &out);
        ck_assert_int_eq(result, fail_at == 0 ? VOX_OK : VOX_ERROR_OUT_OF_MEMORY);
        ck_assert_uint_eq(book.bytes, 0);
        if (fail_at == 0) calls = book.calls;
    }
    ck_assert_uint_gt(calls, 10);
    free_body(&box);
}
END_TEST

SUITE(cell_size_surfaces) {
    TCase* tests = add_case(suite, "surfaces");
    tcase_add_each(tests, the_size_of_the_surface_that_the_meshes_make, of_the_tetrahedra_that_are_there,
                   what_has_no_surface, memory_is_the_callers);
}
