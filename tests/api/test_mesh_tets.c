/* Borrowed tetrahedra (VOX_MESH_BORROW_TETS): the same contacts for 16 bytes a tetrahedron less, and a copy
 * from the first edit on. */
#include <string.h>

#include "scenes/bodies.h"
#include "support/aligned.h"
#include "support/suite.h"

/* A grid with two boxes that overlap; the tetrahedra of the second, which collides with itself, are `tets`.
 */
static vox_grid* grid_of_boxes(const body* box, const body* other, const uint32_t* tets, uint32_t flags,
                               vox_body* mesh) {
    vox_grid_desc desc = engine_desc();
    desc.flags =
        VOX_GRID_CONSTRAINTS; /* what is prepared for these does not depend on whose the tetrahedra are */
    vox_grid* grid = grid_of(&desc);
    vox_mesh_desc a = body_desc(box), b = body_desc(other);
    (void)insert_mesh(grid, &a);
    b.tets = tets;
    b.flags = flags;
    b.filter.flags = VOX_FILTER_SELF_COLLISION;
    *mesh = insert_mesh(grid, &b);
    return grid;
}

static uint32_t* copy_of_tets(const body* b) {
    uint32_t* copy = (uint32_t*)malloc(4 * sizeof(uint32_t) * b->tet_count);
    memcpy(copy, b->tets, 4 * sizeof(uint32_t) * b->tet_count);
    return copy;
}

START_TEST(borrowed_ones_cost_16_bytes_less) {
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(5, 0.25f, 0.4f, 0.3f, 0.2f);
    vox_body mesh = 0;
    vox_grid* copying = grid_of_boxes(&box, &other, other.tets, 0, &mesh);
    vox_grid* borrowing = grid_of_boxes(&box, &other, other.tets, VOX_MESH_BORROW_TETS, &mesh);
    for (int frame = 0; frame < 3; ++frame) {
        ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
        for (uint32_t v = 0; v < other.vertex_count; ++v) other.positions[3 * v] -= 0.01f;
    }
    ck_assert_uint_gt(contacts_of(borrowing).count, 0);
    ck_assert_uint_eq(counters_of(copying).bytes - counters_of(borrowing).bytes,
                      4 * sizeof(uint32_t) * other.tet_count);
    vox_grid_destroy(copying);
    vox_grid_destroy(borrowing);
    free_body(&box);
    free_body(&other);
}
END_TEST

enum { turn_off, remove_some, replace_some, append_some, edit_count };

static void edit(vox_grid* grid, vox_body mesh, int what, uint64_t count) {
    const uint32_t tets[2] = {3, 40}, corners[8] = {0, 1, 2, 40, 1, 2, 3, 41};
    uint32_t first = 0;
    switch (what) {
    case turn_off:
        ck_ok(vox_mesh_set_tets_enabled(grid, mesh, tets, count, 0));
        break;
    case remove_some:
        ck_ok(vox_mesh_remove_tets(grid, mesh, tets, count));
        break;
    case replace_some:
        ck_ok(vox_mesh_replace_tets(grid, mesh, tets, count, corners));
        break;
    default:
        ck_ok(vox_mesh_append_tets(grid, mesh, corners, count, &first));
        break;
    }
}

/* From the first edit on the caller's array is not used any more, and it is never written to. */
START_TEST(first_edit_copies) {
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(5, 0.25f, 0.4f, 0.3f, 0.2f);
    const size_t bytes = 4 * sizeof(uint32_t) * other.tet_count;
    for (int what = 0; what < edit_count; ++what) {
        vox_body mesh = 0;
        uint32_t* lent = copy_of_tets(&other);
        vox_grid* copying = grid_of_boxes(&box, &other, other.tets, 0, &mesh);
        vox_grid* borrowing = grid_of_boxes(&box, &other, lent, VOX_MESH_BORROW_TETS, &mesh);
        ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
        edit(borrowing, mesh, what, 0); /* no edit */
        ck_assert_uint_eq(counters_of(copying).bytes - counters_of(borrowing).bytes, bytes);

        edit(copying, mesh, what, 2);
        edit(borrowing, mesh, what, 2);
        ck_assert_int_eq(memcmp(lent, other.tets, bytes), 0);
        memset(lent, 0xff, bytes);
        free(lent);
        ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
        edit(copying, mesh, append_some, 2);
        edit(borrowing, mesh, append_some, 2);
        ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
        vox_grid_destroy(copying);
        vox_grid_destroy(borrowing);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

/* Edits of vertices need no copy. Nor does a new topology, which may be borrowed as well. */
START_TEST(new_topology_may_be_borrowed) {
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(5, 0.25f, 0.4f, 0.3f, 0.2f);
    body third = make_box(4, 0.25f, 0.3f, 0.3f, 0.3f);
    vox_body mesh = 0;
    uint32_t* lent = copy_of_tets(&other);
    vox_grid* copying = grid_of_boxes(&box, &other, other.tets, 0, &mesh);
    vox_grid* borrowing = grid_of_boxes(&box, &other, lent, VOX_MESH_BORROW_TETS, &mesh);
    vox_mesh_desc desc = body_desc(&third);
    ck_ok(vox_mesh_set_topology(copying, mesh, &desc));
    desc.flags = VOX_MESH_BORROW_TETS;
    ck_ok(vox_mesh_set_topology(borrowing, mesh, &desc));
    memset(lent, 0xff, 4 * sizeof(uint32_t) * other.tet_count);
    free(lent);
    ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
    ck_assert_uint_eq(counters_of(copying).bytes - counters_of(borrowing).bytes,
                      4 * sizeof(uint32_t) * third.tet_count);

    body longer = make_box(4, 0.25f, 0.3f, 0.3f, 0.3f);
    const uint32_t loose = longer.vertex_count;
    longer.positions = (float*)realloc(longer.positions, 3 * sizeof(float) * (loose + 1));
    for (int axis = 0; axis < 3; ++axis) longer.positions[3 * loose + axis] = 0.7f;
    vox_vertices_desc vertices = vox_default_vertices_desc();
    vertices.count = 1;
    vertices.positions = vox_float_positions(longer.positions, loose + 1);
    uint32_t first = 0;
    ck_ok(vox_mesh_append_vertices(copying, mesh, &vertices, &first));
    ck_ok(vox_mesh_append_vertices(borrowing, mesh, &vertices, &first));
    ck_assert_uint_eq(first, loose);
    ck_ok(vox_mesh_remove_vertices(borrowing, mesh, &first, 1));
    ck_ok(vox_mesh_remove_vertices(copying, mesh, &first, 1));
    ck_assert_uint_eq(hash_of_step(copying), hash_of_step(borrowing));
    ck_assert_uint_eq(counters_of(copying).bytes - counters_of(borrowing).bytes,
                      4 * sizeof(uint32_t) * third.tet_count);
    vox_grid_destroy(copying);
    vox_grid_destroy(borrowing);
    free_body(&box);
    free_body(&other);
    free_body(&third);
    free_body(&longer);
}
END_TEST

START_TEST(snapshot_has_its_own) {
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(5, 0.25f, 0.4f, 0.3f, 0.2f);
    vox_body mesh = 0;
    uint32_t* lent = copy_of_tets(&other);
    vox_grid* grid = grid_of_boxes(&box, &other, lent, VOX_MESH_BORROW_TETS, &mesh);
    const uint64_t expected = hash_of_step(grid);
    uint64_t size = 0;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    void* saved = malloc((size_t)size);
    ck_ok(vox_grid_save(grid, saved, size, &size));
    vox_grid_destroy(grid);
    memset(lent, 0xff, 4 * sizeof(uint32_t) * other.tet_count);
    free(lent);
    grid = NULL;
    ck_ok(vox_grid_load(saved, size, NULL, &grid));
    ck_assert_uint_eq(hash_of_step(grid), expected);
    vox_grid_destroy(grid);
    free(saved);
    free_body(&box);
    free_body(&other);
}
END_TEST

static void* allocate_if_allowed(size_t size, size_t alignment, void* user) {
    return *(const int*)user ? allocate_aligned(size, alignment) : NULL;
}

static void release_always(void* memory, size_t size, size_t alignment, void* user) {
    (void)size, (void)alignment, (void)user;
    free_aligned(memory);
}

/* Without memory for the copy an edit fails, and the mesh goes on as before, with what it borrows. */
START_TEST(edit_without_memory_for_the_copy) {
    body box = make_box(5, 0.25f, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    desc.flags = VOX_MESH_BORROW_TETS;
    int allowed = 1;
    vox_grid_desc grid_desc = engine_desc();
    const vox_allocator allocator = {allocate_if_allowed, release_always, &allowed};
    grid_desc.allocator = &allocator;
    vox_grid* grid = grid_of(&grid_desc);
    const vox_body mesh = insert_mesh(grid, &desc);
    (void)insert_mesh(grid, &desc);
    const uint64_t expected = hash_of_step(grid), held = counters_of(grid).bytes;
    for (int what = 0; what < edit_count; ++what) {
        const uint32_t tet = 7, corners[4] = {0, 1, 2, 40};
        uint32_t first = 0;
        vox_result result = VOX_OK;
        allowed = 0;
        switch (what) {
        case turn_off:
            result = vox_mesh_set_tets_enabled(grid, mesh, &tet, 1, 0);
            break;
        case remove_some:
            result = vox_mesh_remove_tets(grid, mesh, &tet, 1);
            break;
        case replace_some:
            result = vox_mesh_replace_tets(grid, mesh, &tet, 1, corners);
            break;
        default:
            result = vox_mesh_append_tets(grid, mesh, corners, 1, &first);
            break;
        }
        ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_assert_uint_eq(counters_of(grid).bytes, held);
        allowed = 1;
        ck_assert_uint_eq(hash_of_step(grid), expected);
    }
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, borrowed_ones_cost_16_bytes_less, first_edit_copies, new_topology_may_be_borrowed,
                   snapshot_has_its_own, edit_without_memory_for_the_copy);
}

SUITE(mesh_tets) { add_for_each_engine(suite, add_tests); }
