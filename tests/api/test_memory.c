/* The per-grid allocator, the byte budget, and what a failed allocation leaves behind. */
#include <string.h>

#include "scenes/bodies.h"
#include "support/aligned.h"
#include "support/suite.h"

/* Counts what is held, checks that it comes back as it was given, and fails at a chosen call. */
typedef struct ledger {
    size_t bytes;
    size_t blocks;
    uint64_t calls;
    uint64_t fail_at; /* the call that returns null; 0: none */
    vox_allocator allocator;
} ledger;

typedef struct block {
    size_t size, alignment;
} block;

static void* counted_allocate(size_t size, size_t alignment, void* user) {
    ledger* l = (ledger*)user;
    if (++l->calls == l->fail_at) return NULL;
    const size_t head = alignment > sizeof(block) ? alignment : sizeof(block);
    unsigned char* memory =
        (unsigned char*)allocate_aligned((head + size + alignment - 1) / alignment * alignment, alignment);
    ck_assert_ptr_nonnull(memory);
    block* b = (block*)(void*)(memory + head - sizeof(block));
    b->size = size;
    b->alignment = alignment;
    memset(memory + head, 0xcd, size);
    l->bytes += size;
    l->blocks += 1;
    return memory + head;
}

static void counted_release(void* memory, size_t size, size_t alignment, void* user) {
    ledger* l = (ledger*)user;
    const size_t head = alignment > sizeof(block) ? alignment : sizeof(block);
    const block* b = (const block*)(const void*)((unsigned char*)memory - sizeof(block));
    ck_assert_uint_eq(b->size, size);
    ck_assert_uint_eq(b->alignment, alignment);
    l->bytes -= size;
    l->blocks -= 1;
    free_aligned((unsigned char*)memory - head);
}

static vox_grid_desc counted_desc(ledger* l) {
    vox_grid_desc desc = vox_default_grid_desc();
    const vox_allocator allocator = {counted_allocate, counted_release, l};
    l->allocator = allocator;
    desc.allocator = &l->allocator;
    use_engine(&desc, suite_engine);
    desc.cell_size = 0.25;
    desc.flags = VOX_GRID_CONSTRAINTS;
    return desc;
}

START_TEST(everything_comes_back) {
    ledger l = {0};
    const vox_grid_desc desc = counted_desc(&l);
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(5, 0.25f, 0.4f, 0.3f, 0.2f);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    b.flags = VOX_MESH_COPY_POSITIONS;
    vox_body mesh = 0;
    vox_grid* grid = grid_of(&desc);
    for (int round = 0; round < 3; ++round) {
        ck_ok(vox_mesh_insert(grid, &a, &mesh));
        ck_ok(vox_mesh_insert(grid, &b, &mesh));
        ck_ok(vox_grid_step(grid));
        grid_counts counters = counters_of(grid);
        ck_assert_uint_eq(counters.bytes, l.bytes); /* what counters say is what the allocator saw */
        ck_ok(vox_grid_clear(grid));
    }
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    ck_assert_uint_eq(l.blocks, 0);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(steady_state_allocates_nothing) {
    ledger l = {0};
    vox_grid_desc desc = counted_desc(&l);
    body box = make_box(8, 0.125f, 0, 0, 0), other = make_box(8, 0.125f, 0.2f, 0.3f, 0.2f);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    a.filter.flags = VOX_FILTER_SELF_COLLISION;
    for (int dense = 0; dense < 2; ++dense) {
        vox_reference_desc reference = vox_default_reference_desc();
        if (dense) reference.flags = VOX_REFERENCE_DENSE;
        reference.world_max[0] = reference.world_max[1] = reference.world_max[2] = 2;
        if (suite_engine == ENGINE_REFERENCE) desc.reference = &reference;
        vox_grid* grid = grid_of(&desc);
        vox_body mesh = insert_mesh(grid, &a);
        ck_ok(vox_mesh_insert(grid, &b, &mesh));
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_step(grid));
        const uint64_t calls = l.calls;
        for (int frame = 0; frame < 10; ++frame) {
            for (uint32_t v = 0; v < other.vertex_count; ++v)
                other.positions[3 * v] += 0.001f; /* moving apart */
            ck_ok(vox_grid_step(grid));
        }
        ck_assert_uint_eq(l.calls, calls);
        vox_grid_destroy(grid);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

/* One whole life; stops at the first failure and returns it. */
static vox_result life(const vox_grid_desc* desc, const vox_mesh_desc* a, const vox_mesh_desc* b, ledger* l,
                       uint64_t* out_hash) {
    vox_grid* grid = NULL;
    vox_body body_a = 0, body_b = 0;
    vox_result result = vox_grid_create(desc, &grid);
    if (result != VOX_OK) {
        ck_assert_ptr_null(grid);
        *out_hash = 0;
        return result;
    }
    result = vox_mesh_insert(grid, a, &body_a);
    if (result == VOX_OK) result = vox_mesh_insert(grid, b, &body_b);
    if (result == VOX_OK) result = vox_grid_step(grid);
    if (result != VOX_OK) {
        /* Nothing is half done: from here on it works, and gives what it would have given. */
        l->fail_at = 0;
        vox_contact_view view = contacts_of(grid);
        ck_assert_uint_eq(view.count, 0);
        if (!body_a) ck_ok(vox_mesh_insert(grid, a, &body_a));
        if (!body_b) ck_ok(vox_mesh_insert(grid, b, &body_b));
        ck_ok(vox_grid_step(grid));
    }
    ck_ok(vox_grid_get_hash(grid, out_hash));
    vox_grid_destroy(grid);
    return result;
}

START_TEST(allocation_n_fails) {
    enum { without_grid = 2 }; /* as many allocations make a grid */
    ledger l = {0};
    vox_grid_desc desc = counted_desc(&l);
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box);
    vox_mesh_desc b = body_desc(&other);
    b.flags = VOX_MESH_COPY_POSITIONS;
    b.filter.flags = VOX_FILTER_SELF_COLLISION;
    for (uint32_t dense = 0; dense < 2; ++dense) {
        uint64_t expected = 0, hash = 0;
        l.fail_at = 0;
        if (suite_engine == ENGINE_REFERENCE) desc.reference = reference_with(dense * VOX_REFERENCE_DENSE);
        ck_ok(life(&desc, &a, &b, &l, &expected));
        uint64_t n = 1;
        for (vox_result result = VOX_ERROR_OUT_OF_MEMORY; result != VOX_OK; ++n) {
            l.calls = 0;
            l.fail_at = n;
            result = life(&desc, &a, &b, &l, &hash);
            ck_assert(result == VOX_OK || result == VOX_ERROR_OUT_OF_MEMORY);
            if (n > 2 || result == VOX_OK)
                ck_assert_uint_eq(hash, expected); /* the first two are the grid itself */
            ck_assert_uint_eq(l.bytes, 0);
        }
        ck_assert_uint_gt(n, 10); /* there were allocations to fail */
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(budget_is_kept) {
    ledger l = {0};
    vox_grid_desc desc = counted_desc(&l);
    body box = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    uint64_t expected = 0, needed = 0;
    ck_ok(life(&desc, &a, &b, &l, &expected));

    vox_grid* grid = grid_of(&desc);
    vox_body mesh = insert_mesh(grid, &a);
    ck_ok(vox_mesh_insert(grid, &b, &mesh));
    ck_ok(vox_grid_step(grid));
    grid_counts counters = counters_of(grid);
    needed = counters.peak_bytes;
    vox_grid_destroy(grid);

    for (uint64_t budget = 256; budget < needed; budget += 1 + needed / 97) {
        desc.byte_budget = budget;
        vox_result result = vox_grid_create(&desc, &grid);
        if (result == VOX_OK) {
            result = vox_mesh_insert(grid, &a, &mesh);
            if (result == VOX_OK) result = vox_mesh_insert(grid, &b, &mesh);
            if (result == VOX_OK) result = vox_grid_step(grid);
            ck_assert_uint_le(l.bytes, budget);
            counters = counters_of(grid);
            ck_assert_uint_le(counters.peak_bytes, budget);
            vox_grid_destroy(grid);
        }
        ck_assert_int_eq(result, VOX_ERROR_BUDGET);
        ck_assert_ptr_nonnull(strstr(vox_last_error(), "budget"));
        ck_assert_uint_eq(l.bytes, 0);
    }
    desc.byte_budget = needed;
    uint64_t hash = 0;
    ck_ok(life(&desc, &a, &b, &l, &hash));
    ck_assert_uint_eq(hash, expected);
    free_body(&box);
    free_body(&other);
}
END_TEST

static void move_x(body* b, float distance) {
    for (uint32_t v = 0; v < b->vertex_count; ++v) b->positions[3 * v] += distance;
}

/* What a grid holds for the contacts of a step. */
typedef struct contact_bytes {
    uint64_t reserved, step; /* by vox_grid_reserve, and by the step after it */
    grid_counts counts;
} contact_bytes;

/* Steps over a fine box in many coarse ones, which hold half of it or the whole: many contacts of few
 * vertices, so that what the vertices take hardly counts. `reserved` contacts have room before. */
static contact_bytes bytes_of_contacts(int whole, uint64_t reserved, uint32_t flags) {
    enum { coarse = 16 };
    ledger l = {0};
    contact_bytes held;
    vox_grid_desc desc = counted_desc(&l);
    desc.worker_count = 1;
    desc.flags = flags;
    vox_grid* grid = grid_of(&desc);
    body bodies[coarse + 1];
    bodies[0] = make_box(12, 1 / 12.0f, 1000, 0.017f, 0.019f); /* far from the others */
    for (int b = 1; b <= coarse; ++b) {
        const float shift = 0.003f * (float)b;
        bodies[b] = make_box(1, 4, whole ? -1.5f - shift : 0.41f + shift, -1.5f - shift, -1.4f - shift);
    }
    for (int b = 0; b <= coarse; ++b) {
        const vox_mesh_desc mesh = body_desc(&bodies[b]);
        (void)insert_mesh(grid, &mesh);
    }
    ck_ok(vox_grid_step(grid));
    const uint64_t apart = l.bytes;
    ck_ok(vox_grid_reserve(grid, 0, reserved));
    held.reserved = l.bytes - apart;
    move_x(&bodies[0], -1000);
    ck_ok(vox_grid_step(grid));
    held.counts = counters_of(grid);
    held.step = l.bytes - apart - held.reserved;
    vox_grid_destroy(grid);
    for (int b = 0; b <= coarse; ++b) free_body(&bodies[b]);
    return held;
}

/* A contact takes at most 48 bytes, with its constraint and the one of the step before 640; with
 * vox_grid_reserve a step takes no more than what vertices need and a search for a closest point. */
START_TEST(contacts_in_a_step) {
    enum { each_searched = 24, for_vertices = 12 };
    for (int whole = 0; whole < 2; ++whole)
        for (uint32_t flags = 0; flags < 2; ++flags) {
            const uint64_t each = flags & VOX_GRID_CONSTRAINTS ? 640 : 48;
            const contact_bytes grown = bytes_of_contacts(whole, 0, flags);
            const uint64_t count = grown.counts.contacts;
            ck_assert_uint_ge(count, 19000);
            ck_assert_uint_eq(grown.counts.constraints, flags ? count : 0);
            ck_assert_uint_ge(grown.counts.closest_searches, flags && whole ? 35000 : 0);
            ck_assert_uint_le(grown.step, each * count);
            const contact_bytes reserved = bytes_of_contacts(whole, count, flags);
            ck_assert_uint_le(reserved.reserved, each * count);
            ck_assert_uint_ge(reserved.reserved, sizeof(vox_contact) * count);
            ck_assert_uint_le(reserved.step,
                              for_vertices * count + each_searched * reserved.counts.closest_searches);
        }
}
END_TEST

START_TEST(reserved_room) {
    ledger l = {0};
    vox_grid_desc desc = counted_desc(&l);
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other), empty = vox_default_mesh_desc();
    uint64_t before = 0, after = 0, epoch = 0, count = 0;
    vox_grid* grid = grid_of(&desc);
    vox_body mesh = insert_mesh(grid, &a);
    ck_ok(vox_mesh_insert(grid, &b, &mesh));
    ck_ok(vox_grid_step(grid));
    vox_contact_view view = contacts_of(grid);
    ck_ok(vox_grid_get_hash(grid, &before));
    epoch = grid_info(grid).epoch, count = view.count;
    ck_ok(vox_grid_reserve(grid, 100, 10000));
    ck_ok(vox_grid_get_contacts(grid, &view)); /* the same contacts, a new view */
    ck_ok(vox_grid_get_hash(grid, &after));
    ck_assert_uint_eq(view.count, count);
    ck_assert_uint_eq(before, after);
    ck_assert_uint_gt(grid_info(grid).epoch, epoch);
    ck_assert_uint_ge(l.bytes, 3 * 10000 * 16);

    const uint64_t calls = l.calls, bytes = l.bytes;
    for (int i = 0; i < 98; ++i) ck_ok(vox_mesh_insert(grid, &empty, &mesh));
    ck_assert_uint_eq(l.calls, calls); /* empty meshes need only their slots */
    ck_ok(vox_grid_reserve(grid, 1, 1));
    ck_assert_uint_eq(l.bytes, bytes);
    ck_fails(vox_grid_reserve(grid, VOX_MAX_BODIES + 1, 0), VOX_ERROR_LIMIT, "mesh_count is 1048577");
    ck_fails(vox_grid_reserve(grid, 0, 1ull << 40), VOX_ERROR_BUDGET, "budget");
    ck_fails(vox_grid_reserve(grid, 0, UINT64_MAX), VOX_ERROR_OUT_OF_MEMORY, "memory");
    ck_fails(vox_grid_reserve(NULL, 0, 0), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(many_meshes) {
    /* Insertion stays cheap and ids stay unique when meshes come by the thousand. */
    vox_body meshes[3000];
    const vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    vox_grid* grid = grid_of(NULL);
    for (int i = 0; i < 3000; ++i) {
        ck_ok(vox_mesh_insert(grid, &desc, &meshes[i]));
        if (i) ck_assert_uint_gt(meshes[i], meshes[i - 1]);
    }
    for (int i = 0; i < 3000; i += 2) ck_ok(vox_body_remove(grid, meshes[i]));
    for (int i = 0; i < 3000; ++i) ck_assert_uint_eq(vox_body_is_valid(grid, meshes[i]), i % 2);
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, everything_comes_back, steady_state_allocates_nothing, allocation_n_fails,
                   budget_is_kept, contacts_in_a_step, reserved_room, many_meshes);
}

SUITE(memory) { add_for_each_engine(suite, add_tests); }
