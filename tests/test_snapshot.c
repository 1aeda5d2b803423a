/* Snapshots: the loaded grid is the saved one, and nothing that is wrong with a file gets in. The format is
 * spelled out here once more, by itself (docs/snapshot.md). */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "ledger.h"
#include "suite.h"

/* ---- bytes ---- */

enum { header_bytes = 24, chunk_header_bytes = 16 };

typedef struct file {
    unsigned char* bytes;
    size_t size;
} file;

static file save(const vox_grid* grid) {
    file f = {NULL, 0};
    uint64_t size = 0, written = 0;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    f.size = (size_t)size;
    f.bytes = (unsigned char*)malloc(f.size);
    ck_ok(vox_grid_save(grid, f.bytes, f.size, &written));
    ck_assert_uint_eq(size, written);
    return f;
}

static vox_grid* load(file f, vox_engine engine) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    desc.engine = engine;
    ck_ok(vox_grid_load(f.bytes, f.size, &desc, &grid));
    return grid;
}

static uint64_t get(const unsigned char* at, int bytes) {
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;) value = value << 8 | at[i];
    return value;
}

static void put(unsigned char* at, int bytes, uint64_t value) {
    for (int i = 0; i < bytes; ++i) at[i] = (unsigned char)(value >> 8 * i);
}

/* CRC-32, bit by bit. */
static void seal(file f) {
    uint32_t remainder = 0xffffffffu;
    put(f.bytes + 16, 8, f.size);
    for (size_t i = 16; i < f.size; ++i) {
        remainder ^= f.bytes[i];
        for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320u : 0);
    }
    put(f.bytes + 12, 4, ~remainder & 0xffffffffu);
}

static file copy_of(file f) {
    file copy = {(unsigned char*)malloc(f.size), f.size};
    memcpy(copy.bytes, f.bytes, f.size);
    return copy;
}

static size_t chunk_bytes(const unsigned char* chunk) {
    return chunk_header_bytes + (size_t)((get(chunk + 8, 8) + 7) / 8 * 8);
}

/* The n-th chunk of that name, from 0. */
static unsigned char* find_chunk(file f, const char* name, int n) {
    for (size_t at = header_bytes; at < f.size; at += chunk_bytes(f.bytes + at))
        if (memcmp(f.bytes + at, name, 4) == 0 && n-- == 0) return f.bytes + at;
    ck_abort_msg("no chunk %s", name);
    return NULL;
}

static unsigned char* payload(file f, const char* name, int n) {
    return find_chunk(f, name, n) + chunk_header_bytes;
}

/* Takes a chunk out, or puts `added` bytes in before it. */
static file without_chunk(file f, const char* name, int n) {
    const unsigned char* chunk = find_chunk(f, name, n);
    const size_t at = (size_t)(chunk - f.bytes), size = chunk_bytes(chunk);
    file shorter = copy_of(f);
    memmove(shorter.bytes + at, shorter.bytes + at + size, f.size - at - size);
    shorter.size -= size;
    seal(shorter);
    return shorter;
}

static file with_bytes(file f, size_t at, const void* added, size_t size) {
    file longer = {(unsigned char*)malloc(f.size + size), f.size + size};
    memcpy(longer.bytes, f.bytes, at);
    memcpy(longer.bytes + at, added, size);
    memcpy(longer.bytes + at + size, f.bytes + at, f.size - at);
    seal(longer);
    return longer;
}

static void refused(file f, vox_result code, const char* words) {
    vox_grid* grid = NULL;
    ck_fails(vox_grid_load(f.bytes, f.size, NULL, &grid), code, words);
    ck_assert_ptr_null(grid);
}

/* ---- a grid with something of everything ---- */

typedef struct scene {
    vox_grid* grid;
    body bodies[6];
    vox_mesh ids[8]; /* of the bodies, of one without positions, of an empty one */
    float strided[5 * 4];
    double doubles[3 * 64]; /* of body 5 */
} scene;

enum { scene_bodies = 6, removed_body = 2, disabled_body = 4 };

static void make_scene(scene* s, vox_engine engine, double cell_size) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.engine = engine;
    desc.cell_size = cell_size;
    desc.flags |= VOX_GRID_CONTACT_EVENTS;
    ck_ok(vox_grid_create(&desc, &s->grid));
    for (uint32_t i = 0; i < scene_bodies; ++i) {
        s->bodies[i] = make_box(2 + i % 2, 0.25f, 0.3f * (float)i, 0.1f * (float)i, 0.05f * (float)i);
        vox_mesh_desc mesh = body_desc(&s->bodies[i]);
        mesh.user_data = 1000 + i;
        if (i % 2) mesh.flags = VOX_MESH_COPY_POSITIONS;
        if (i == 1) mesh.flags |= VOX_MESH_SELF_COLLISION;
        ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[i]));
    }
    vox_filter filter = vox_default_filter();
    filter.self_collision = 1;
    filter.self_rings = 1;
    filter.self_rest_distance = 0.01;
    ck_ok(vox_mesh_set_filter(s->grid, s->ids[3], &filter));
    filter = vox_default_filter();
    filter.group = -7;
    filter.category = 1ull << 63;
    filter.mask = ~2ull;
    ck_ok(vox_mesh_set_filter(s->grid, s->ids[0], &filter));
    ck_ok(vox_grid_set_pair_enabled(s->grid, s->ids[5], s->ids[0], 0));
    ck_assert_uint_le(s->bodies[5].vertex_count, 64);
    for (uint32_t i = 0; i < 3 * s->bodies[5].vertex_count; ++i)
        s->doubles[i] = s->bodies[5].positions[i] + 1e-12 * i; /* what no float could keep */
    ck_ok(vox_mesh_bind_positions(s->grid, s->ids[5], s->doubles, VOX_FORMAT_DOUBLE3, 0));
    static const double turn[12] = {0.8, -0.6, 0, 0.2, 0.6, 0.8, 0, 0.1, 0, 0, 1, 0.05};
    ck_ok(vox_mesh_set_transform(s->grid, s->ids[3], turn));

    vox_mesh_desc mesh = array_desc(NULL, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[6]));
    for (int v = 0; v < 4; ++v) memcpy(s->strided + 5 * v, unit_tet_positions + 3 * v, 3 * sizeof(float));
    ck_ok(vox_mesh_bind_positions(s->grid, s->ids[6], s->strided, VOX_FORMAT_FLOAT3, 5 * sizeof(float)));
    mesh = vox_default_mesh_desc();
    ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[7]));

    /* Cut: tets of two meshes off or removed, and a corner of the first. */
    static const uint32_t off[] = {20, 21, 22}, removed[] = {21, 0, 33};
    uint32_t around[8], count = 0;
    for (uint32_t t = 0; t < s->bodies[0].tet_count; ++t)
        for (int c = 0; c < 4; ++c)
            if (s->bodies[0].tets[4 * t + c] == 0) around[count++] = t;
    ck_ok(vox_mesh_set_tets_enabled(s->grid, s->ids[0], around, count, 0));
    const uint32_t corner = 0;
    ck_ok(vox_mesh_remove_vertices(s->grid, s->ids[0], &corner, 1));
    for (int i = 0; i < 2; ++i) {
        ck_ok(vox_mesh_set_tets_enabled(s->grid, s->ids[i], off, 3, 0));
        ck_ok(vox_mesh_remove_tets(s->grid, s->ids[i], removed, 3));
    }

    ck_ok(vox_grid_step(s->grid));
    /* From here on the last step's results are out of date: what follows must survive all the same. */
    ck_ok(vox_mesh_remove(s->grid, s->ids[removed_body]));
    ck_ok(vox_mesh_set_enabled(s->grid, s->ids[disabled_body], 0));
    for (uint32_t v = 0; v < s->bodies[0].vertex_count; ++v) s->bodies[0].positions[3 * v] += 0.1f;
}

static void free_scene(scene* s) {
    vox_grid_destroy(s->grid);
    for (int i = 0; i < scene_bodies; ++i) free_body(&s->bodies[i]);
}

static void same_results(const vox_grid* a, const vox_grid* b) {
    vox_contact_view x, y;
    vox_touch_view p, q;
    vox_contact_event_view u, v;
    uint64_t hash_a = 1, hash_b = 2, epoch_a = 1, epoch_b = 2;
    ck_ok(vox_grid_contacts(a, &x));
    ck_ok(vox_grid_contacts(b, &y));
    ck_assert_uint_eq(x.count, y.count);
    if (x.count) ck_assert_int_eq(memcmp(x.data, y.data, (size_t)x.count * sizeof *x.data), 0);
    ck_ok(vox_grid_touch_events(a, &p));
    ck_ok(vox_grid_touch_events(b, &q));
    ck_assert_uint_eq(p.count, q.count);
    ck_assert_uint_eq(p.began, q.began);
    ck_assert_uint_eq(p.ended, q.ended);
    if (p.count) ck_assert_int_eq(memcmp(p.data, q.data, (size_t)p.count * sizeof *p.data), 0);
    ck_ok(vox_grid_contact_events(a, &u));
    ck_ok(vox_grid_contact_events(b, &v));
    ck_assert_uint_eq(u.count, v.count);
    ck_assert_uint_eq(u.began, v.began);
    if (u.count) ck_assert_int_eq(memcmp(u.data, v.data, (size_t)u.count * sizeof *u.data), 0);
    ck_ok(vox_grid_hash(a, &hash_a));
    ck_ok(vox_grid_hash(b, &hash_b));
    ck_assert_uint_eq(hash_a, hash_b);
    ck_ok(vox_grid_epoch(a, &epoch_a));
    ck_ok(vox_grid_epoch(b, &epoch_b));
    ck_assert_uint_eq(epoch_a, epoch_b);
}

/* ---- the loaded grid is the saved one ---- */

START_TEST(loaded_grid_goes_on_as_the_saved_one) {
    static const double cell_sizes[] = {0, 0.2};
    for (int i = 0; i < 2; ++i) {
        scene s;
        make_scene(&s, suite_engine, cell_sizes[i]);
        const file f = save(s.grid);
        vox_grid* again = load(f, VOX_ENGINE_AUTO);

        double before = 1, after = 2;
        ck_ok(vox_grid_cell_size(s.grid, &before));
        ck_ok(vox_grid_cell_size(again, &after));
        ck_assert_double_eq(before, after);
        for (int m = 0; m < 8; ++m) {
            ck_assert_uint_eq(vox_mesh_is_valid(again, s.ids[m]), m != removed_body);
            if (m == removed_body) continue;
            uint64_t user_data = 0;
            vox_filter x = vox_default_filter(), y = vox_default_filter();
            ck_ok(vox_mesh_user_data(again, s.ids[m], &user_data));
            ck_assert_uint_eq(user_data, m < scene_bodies ? 1000u + (unsigned)m : 0u);
            ck_ok(vox_mesh_filter(s.grid, s.ids[m], &x));
            ck_ok(vox_mesh_filter(again, s.ids[m], &y));
            ck_assert_int_eq(memcmp(&x, &y, sizeof x), 0);
        }
        vox_contact_view none = {NULL, 0, 9, 0};
        ck_ok(vox_grid_contacts(again, &none));
        ck_assert_uint_eq(none.count, 0);

        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_step(again));
        same_results(s.grid, again);
        ck_ok(vox_grid_contacts(again, &none));
        ck_assert_uint_gt(none.count, 10);
        vox_touch_view events;
        ck_ok(vox_grid_touch_events(again, &events));
        ck_assert_uint_gt(events.persisted, 0); /* it knew what touched before */
        ck_assert_uint_gt(events.ended, 0);     /* of the mesh that was removed, and of the disabled one */

        /* What comes later is the same as well: ids, a mesh that comes back, a pair that is allowed again. */
        vox_grid* const both[2] = {s.grid, again};
        vox_mesh fresh[2][3];
        for (int g = 0; g < 2; ++g) {
            const vox_mesh_desc mesh = body_desc(&s.bodies[removed_body]);
            for (int n = 0; n < 3; ++n) ck_ok(vox_mesh_insert(both[g], &mesh, &fresh[g][n]));
            ck_ok(vox_mesh_set_enabled(both[g], s.ids[disabled_body], 1));
            ck_ok(vox_grid_set_pair_enabled(both[g], s.ids[0], s.ids[5], 1));
            ck_ok(vox_grid_step(both[g]));
        }
        ck_assert_int_eq(memcmp(fresh[0], fresh[1], sizeof fresh[0]), 0);
        same_results(s.grid, again);
        vox_grid_destroy(again);
        free_scene(&s);
        free(f.bytes);
    }
}
END_TEST

START_TEST(saving_the_loaded_grid_gives_the_same_bytes) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    vox_grid* again = load(f, VOX_ENGINE_AUTO);
    const file g = save(again);
    ck_assert_uint_eq(f.size, g.size);
    ck_assert_int_eq(memcmp(f.bytes, g.bytes, f.size), 0);
    vox_grid_destroy(again);
    free_scene(&s);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

START_TEST(every_engine_takes_it) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    ck_ok(vox_grid_step(s.grid));
    for (int engine = VOX_ENGINE_REFERENCE; engine <= VOX_ENGINE_FAST; ++engine) {
        vox_grid* again = load(f, (vox_engine)engine);
        ck_ok(vox_grid_step(again));
        same_results(s.grid, again);
        const file g = save(again);
        ck_assert_uint_eq(get(payload(g, "GRID", 0), 4),
                          (uint64_t)engine); /* it is the one that was asked for */
        vox_grid_destroy(again);
        free(g.bytes);
    }
    free_scene(&s);
    free(f.bytes);
}
END_TEST

START_TEST(generations_and_retired_slots) {
    vox_grid* grid = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    vox_mesh mesh = 0, kept = 0, first = 0;
    const vox_mesh_desc tet = array_desc(unit_tet_positions, 4, unit_tet, 1);
    desc.engine = suite_engine;
    ck_ok(vox_grid_create(&desc, &grid));
    ck_ok(vox_mesh_insert(grid, &tet, &kept));
    ck_ok(vox_mesh_insert(grid, &tet, &first));
    ck_ok(vox_mesh_remove(grid, first));
    for (uint32_t use = 1; use < VOX_MAX_GENERATIONS; ++use) {
        ck_ok(vox_mesh_insert(grid, &tet, &mesh));
        ck_ok(vox_mesh_remove(grid, mesh));
    }
    const file f = save(grid);
    vox_grid* again = load(f, VOX_ENGINE_AUTO);
    vox_mesh x = 0, y = 1;
    ck_ok(vox_mesh_insert(grid, &tet, &x));
    ck_ok(vox_mesh_insert(again, &tet, &y));
    ck_assert_uint_eq(x, y);
    ck_assert_uint_ne(x, first); /* the slot is used up */
    ck_assert_uint_eq(vox_mesh_is_valid(again, kept), 1);
    ck_assert_uint_eq(vox_mesh_is_valid(again, mesh), 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(again);
    free(f.bytes);
}
END_TEST

START_TEST(positions_keep_their_bits) {
    /* -0, the smallest denormal and a NaN with a payload. */
    static const uint32_t bits[12] = {0x80000000u, 1,           0x7fc12345u, 0x3f800000u, 0, 0,
                                      0,           0x3f800000u, 0,           0,           0, 0x3f800000u};
    float positions[12];
    memcpy(positions, bits, sizeof bits);
    vox_grid* grid = NULL;
    vox_mesh mesh = 0;
    const vox_mesh_desc desc = array_desc(positions, 4, unit_tet, 1);
    vox_grid_desc settings = vox_default_grid_desc();
    settings.engine = suite_engine;
    ck_ok(vox_grid_create(&settings, &grid));
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    const file f = save(grid);
    const unsigned char* chunk = find_chunk(f, "MESH", 0);
    const unsigned char* end = chunk + chunk_header_bytes + get(chunk + 8, 8);
    for (int i = 0; i < 12; ++i) ck_assert_uint_eq(get(end - 48 + 4 * i, 4), bits[i]);
    vox_grid* again = load(f, VOX_ENGINE_AUTO);
    ck_fails(vox_grid_step(again), VOX_ERROR_NON_FINITE, "vertex 0");
    memset(positions, 0, sizeof positions); /* the loaded grid has its own */
    const file g = save(again);
    ck_assert_uint_eq(f.size, g.size);
    ck_assert_int_eq(memcmp(find_chunk(f, "MESH", 0), find_chunk(g, "MESH", 0), (size_t)(end - chunk)), 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(again);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

START_TEST(an_empty_grid_and_one_without_positions) {
    vox_grid* grid = NULL;
    vox_mesh mesh = 0;
    vox_grid_desc settings = vox_default_grid_desc();
    settings.engine = suite_engine;
    ck_ok(vox_grid_create(&settings, &grid));
    file f = save(grid);
    vox_grid* again = load(f, VOX_ENGINE_AUTO);
    ck_ok(vox_grid_step(again));
    vox_grid_destroy(again);
    free(f.bytes);

    const vox_mesh_desc desc = array_desc(NULL, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    f = save(grid);
    again = load(f, VOX_ENGINE_AUTO);
    ck_fails(vox_grid_step(again), VOX_ERROR_INVALID_STATE, "no positions");
    ck_ok(vox_mesh_bind_positions(again, mesh, unit_tet_positions, VOX_FORMAT_FLOAT3, 0));
    ck_ok(vox_grid_step(again));
    vox_grid_destroy(again);
    vox_grid_destroy(grid);
    free(f.bytes);
}
END_TEST

START_TEST(arguments) {
    vox_grid* grid = NULL;
    uint64_t size = 77;
    unsigned char bytes[16];
    ck_ok(vox_grid_create(NULL, &grid));
    ck_fails(vox_grid_save(NULL, NULL, 0, &size), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_save(grid, NULL, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_size is null");
    memset(bytes, 7, sizeof bytes);
    ck_fails(vox_grid_save(grid, bytes, sizeof bytes, &size), VOX_ERROR_INVALID_ARGUMENT, "capacity is 16");
    ck_assert_uint_eq(size, 77);
    for (size_t i = 0; i < sizeof bytes; ++i) ck_assert_uint_eq(bytes[i], 7);

    const file f = save(grid);
    vox_grid* again = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    ck_fails(vox_grid_load(NULL, 9, NULL, &again), VOX_ERROR_INVALID_ARGUMENT, "bytes is null");
    ck_fails(vox_grid_load(f.bytes, f.size, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_grid is null");
    desc.worker_count = VOX_MAX_WORKERS + 1;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT,
             "worker_count is 257");
    desc = vox_default_grid_desc();
    put((unsigned char*)&desc.engine, 4, 99);
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT, "engine is 99");
    desc = vox_default_grid_desc();
    desc.byte_budget = 1;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_BUDGET, "byte budget is 1");
    desc.struct_size = 2;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 2");
    ck_assert_ptr_null(again);
    vox_grid_destroy(grid);
    free(f.bytes);
}
END_TEST

/* ---- what is wrong with a file ---- */

START_TEST(cut_off_and_damaged) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    for (size_t size = 0; size < f.size; size += size < 300 ? 1 : 97) {
        const file cut = {f.bytes, size};
        refused(cut, VOX_ERROR_FORMAT, size < header_bytes ? "the header alone has 24" : "it is cut off");
    }
    for (size_t byte = 0; byte < f.size; byte += byte < 300 ? 1 : 97) {
        f.bytes[byte] ^= (unsigned char)(1u << byte % 8);
        const int later_version = byte >= 9 && byte < 12; /* byte 8 becomes version 0 */
        refused(f, later_version ? VOX_ERROR_UNSUPPORTED : VOX_ERROR_FORMAT, "snapshot: ");
        f.bytes[byte] ^= (unsigned char)(1u << byte % 8);
    }
    const file longer = with_bytes(f, f.size, "12345678", 8);
    refused(longer, VOX_ERROR_FORMAT, "8 bytes at byte"); /* sealed, but no chunk */
    put(longer.bytes + 16, 8, f.size);
    refused(longer, VOX_ERROR_FORMAT, "the header says");
    vox_grid* again = load(f, VOX_ENGINE_AUTO); /* it was all put back */
    vox_grid_destroy(again);
    free_scene(&s);
    free(f.bytes);
    free(longer.bytes);
}
END_TEST

typedef struct defect {
    const char* chunk;
    int n;     /* which of that name */
    int at;    /* in its payload; negative: in its header, -16 is the name */
    int bytes; /* of the number there */
    uint64_t value;
    vox_result result;
    const char* words;
} defect;

/* The scene has slots 0 to 7, of which slot 2 is empty; mesh ids are slot << 12 | 1. */
static const defect defects[] = {
    {"GRID", 0, -16, 4, 0x41414141u, VOX_ERROR_FORMAT, "chunk AAAA at byte 24: expected chunk GRID first"},
    {"GRID", 0, -12, 4, 5, VOX_ERROR_FORMAT, "its second word is 5"},
    {"GRID", 0, -8, 8, 1ull << 60, VOX_ERROR_FORMAT, "1152921504606846976 bytes, the snapshot only"},
    {"GRID", 0, -8, 8, UINT64_MAX, VOX_ERROR_FORMAT, "18446744073709551615 bytes, the snapshot only"},
    {"GRID", 0, -8, 8, 40, VOX_ERROR_FORMAT,
     "chunk GRID at byte 24: 1 number of 8 bytes each, it has 0 more"},
    {"GRID", 0, 0, 4, 3, VOX_ERROR_FORMAT, "engine is 3, expected 0 to 2"},
    {"GRID", 0, 0, 4, 0, VOX_ERROR_FORMAT, "engine is 0, expected the one in use"},
    {"GRID", 0, 4, 4, 9, VOX_ERROR_FORMAT, "storage is 9"},
    {"GRID", 0, 8, 4, UINT32_MAX, VOX_ERROR_FORMAT, "hash is 4294967295"},
    {"GRID", 0, 12, 4, 1u << 30, VOX_ERROR_FORMAT, "of which 0x40000000 is unknown"},
    {"GRID", 0, 16, 8, 1ull << 60, VOX_ERROR_FORMAT, "hash_table_size is 1152921504606846976"},
    {"GRID", 0, 24, 8, 0x7ff8000000000000ull, VOX_ERROR_FORMAT, "world is [nan"},
    {"GRID", 0, 72, 8, 0x7ff0000000000000ull, VOX_ERROR_FORMAT, "cell size is inf"},
    {"GRID", 0, 72, 8, 0xbff0000000000000ull, VOX_ERROR_FORMAT, "cell size is -1"},
    {"GRID", 0, 80, 4, 2, VOX_ERROR_FORMAT, "whether the cell size was chosen is 2"},
    {"GRID", 0, 84, 4, 1, VOX_ERROR_FORMAT, "a reserved word is 1"},
    {"SLOT", 0, -16, 4, 0x4f4c4f53u, VOX_ERROR_UNSUPPORTED, "chunk SOLO is unknown"},
    {"SLOT", 0, -16, 4, 0xff4c4f53u, VOX_ERROR_UNSUPPORTED, "chunk SOL? is unknown"},
    {"SLOT", 0, -16, 4, 0x4f4c4f73u, VOX_ERROR_FORMAT,
     "expected chunk SLOT before it"}, /* skipped, but needed */
    {"SLOT", 0, 0, 4, 1u << 21, VOX_ERROR_FORMAT, "2097152 slots, the limit is 1048576"},
    {"SLOT", 0, 0, 4, 1u << 20, VOX_ERROR_FORMAT, "1048577 slots of 4 bytes each"},
    {"SLOT", 0, 4, 4, UINT32_MAX, VOX_ERROR_FORMAT, "slots of 4 bytes each"},
    {"SLOT", 0, 4, 4, 0, VOX_ERROR_FORMAT, "0 free slots are listed, 1 are free"},
    {"SLOT", 0, 8, 4, 0, VOX_ERROR_FORMAT, "slot 0 has generation 0, expected 1 to 4095"},
    {"SLOT", 0, 8, 4, 0x80000000u, VOX_ERROR_FORMAT, "slot 0 has generation 0"},
    {"SLOT", 0, 8, 4, 4096, VOX_ERROR_FORMAT, "slot 0 has generation 4096"},
    {"SLOT", 0, 8, 4, 1, VOX_ERROR_FORMAT, "1 free slots are listed, 2 are free"},
    {"SLOT", 0, 12, 4, 0x80000002u, VOX_ERROR_FORMAT, "it is of mesh 4097, expected mesh 4098"},
    {"SLOT", 0, 16, 4, 4095, VOX_ERROR_FORMAT, "1 free slots are listed, 0 are free"},
    {"SLOT", 0, 40, 4, 8, VOX_ERROR_FORMAT, "free slot 8 of 8 slots"},
    {"SLOT", 0, 40, 4, 3, VOX_ERROR_FORMAT, "slot 3 is listed as free, but"},
    {"MESH", 0, 0, 4, 4097, VOX_ERROR_FORMAT, "it is of mesh 4097, expected mesh 1"},
    {"MESH", 1, 0, 4, 1, VOX_ERROR_FORMAT, "it is of mesh 1, expected mesh 4097"},
    {"MESH", 1, 0, 4, 0, VOX_ERROR_FORMAT, "it is of mesh 0, expected mesh 4097"},
    {"MESH", 0, 4, 4, 64, VOX_ERROR_FORMAT, "of which 0x40 is unknown"},
    {"MESH", 2, 40, 8, 0x7ff0000000000000ull, VOX_ERROR_FORMAT, "its transform has the element inf"},
    {"MESH", 0, 4, 4, 4, VOX_ERROR_FORMAT,
     "chunk MESH"}, /* a transform that is not there: all else moves on */
    {"MESH", 0, 16, 8, 1ull << 60, VOX_ERROR_FORMAT, "1152921504606846976 positions of 12 bytes each"},
    {"MESH", 0, 16, 8, 5, VOX_ERROR_FORMAT, "expected"},
    {"MESH", 0, 24, 8, 1ull << 60, VOX_ERROR_FORMAT, "1152921504606846976 tetrahedra of 16 bytes each"},
    {"MESH", 0, 24, 8, UINT64_MAX, VOX_ERROR_FORMAT, "tetrahedra of 16 bytes each"},
    {"MESH", 0, 32, 4, 2, VOX_ERROR_FORMAT, "whether it has positions is 2"},
    {"MESH", 0, 32, 4, 0, VOX_ERROR_FORMAT, "bytes, expected"},
    {"MESH", 0, 36, 4, 77, VOX_ERROR_FORMAT, "position format is 77"},
    {"MESH", 0, 36, 4, 1, VOX_ERROR_FORMAT, "27 positions of 24 bytes each, it has 324 more bytes"},
    {"MESH", 4, 36, 4, 0, VOX_ERROR_FORMAT, "bytes, expected"},
    {"MESH", 0, 40, 4, 27, VOX_ERROR_FORMAT, "mesh 1: tet 0 names vertex 27 of 27"},
    {"MESH", 5, 16, 8, 1ull << 60, VOX_ERROR_FORMAT, "positions"},
    {"MESH", 6, 16, 8, 1ull << 60, VOX_ERROR_LIMIT,
     "vertex_count is 1152921504606846976"}, /* without positions */
    {"MESH", 6, -16, 4, 0x544c4946u, VOX_ERROR_FORMAT, "mesh 28673 is not in it"},
    {"CUTS", 0, 0, 4, 0, VOX_ERROR_FORMAT, "mesh 0 is not in it"},
    {"CUTS", 1, 0, 4, 1, VOX_ERROR_FORMAT, "mesh 1 comes after mesh 1"},
    {"CUTS", 0, 4, 4, 1, VOX_ERROR_FORMAT, "a reserved word is 1"},
    {"CUTS", 0, 8, 8, UINT64_MAX, VOX_ERROR_FORMAT, "tetrahedra that are off past the last one, number 40"},
    {"CUTS", 0, 16, 8, 1u << 2, VOX_ERROR_FORMAT, "mesh 1: tet 2 is removed, but not off"},
    {"CUTS", 0, 24, 8, 1u << 26, VOX_ERROR_FORMAT, "names vertex 26, which was removed"},
    {"CUTS", 0, 24, 8, 1u << 27, VOX_ERROR_FORMAT, "vertices that are removed past the last one, number 27"},
    {"CUTS", 0, -8, 8, 24, VOX_ERROR_FORMAT, "1 vertices that are removed of 8 bytes each, it has 0 more bytes"},
    {"CUTS", 0, -8, 8, 40, VOX_ERROR_FORMAT, "40 bytes, expected 32"},
    {"FILT", 0, 0, 4, 0, VOX_ERROR_FORMAT, "mesh 0 is not in it"},
    {"FILT", 1, 0, 4, 1, VOX_ERROR_FORMAT, "mesh 1 comes after mesh 1"},
    {"FILT", 0, 24, 4, 9, VOX_ERROR_LIMIT, "9"},
    {"FILT", 0, 32, 8, 0x7ff0000000000000ull, VOX_ERROR_FORMAT, "self_rest_distance"},
    {"FILT", 1, 28, 4, 0, VOX_ERROR_FORMAT, "bytes, expected"},
    {"FILT", 1, 40, 4, 0x7f800000u, VOX_ERROR_FORMAT, "not finite"},
    {"PAIR", 0, 0, 4, 20481, VOX_ERROR_FORMAT, "pair (20481, 20481) is out of order"},
    {"PAIR", 0, 4, 4, 8193, VOX_ERROR_FORMAT, "mesh id 8193 (slot 2, generation 1) is stale"},
    {"PAIR", 0, -8, 8, 4, VOX_ERROR_FORMAT, "1 number of 4 bytes each, it has 0 more"},
    {"EVNT", 0, 0, 8, 1ull << 60, VOX_ERROR_FORMAT, "1152921504606846976 pairs of 24 bytes each"},
    {"EVNT", 0, 8, 8, 1ull << 60, VOX_ERROR_FORMAT,
     "1152921504606846976 vertices in meshes of 12 bytes each"},
    {"EVNT", 0, 16, 4, 2, VOX_ERROR_FORMAT, "mesh 2 was never in the grid"},
    {"EVNT", 0, 16, 4, 0, VOX_ERROR_FORMAT, "mesh 0 was never in the grid"},
    {"EVNT", 0, 16, 4, 8u << 12 | 1, VOX_ERROR_FORMAT, "mesh 32769 was never in the grid"},
    {"EVNT", 0, 16, 4, 7u << 12 | 1, VOX_ERROR_FORMAT, "pair 0 (28673, "},
    {"EVNT", 0, -16, 4, 0x44495247u, VOX_ERROR_FORMAT, "it comes after chunk PAIR"},
    {"EVNT", 0, -16, 4, 0x52494150u, VOX_ERROR_FORMAT, "it comes a second time"},
    {"EVNT", 0, -16, 4, 0x544e5665u, VOX_ERROR_FORMAT, "it has no chunk EVNT"},
};

START_TEST(hostile_numbers) {
    const defect* d = &defects[_i];
    scene s;
    make_scene(&s, VOX_ENGINE_FAST, 0);
    const file f = save(s.grid);
    put(payload(f, d->chunk, d->n) + d->at, d->bytes, d->value);
    seal(f);
    vox_grid* grid = NULL;
    const vox_result result = vox_grid_load(f.bytes, f.size, NULL, &grid);
    ck_assert_msg(result == d->result, "%s[%d] at %d: %s (%s)", d->chunk, d->n, d->at,
                  vox_result_string(result), vox_last_error());
    ck_assert_msg(strstr(vox_last_error(), d->words) != NULL, "%s[%d] at %d: \"%s\"", d->chunk, d->n, d->at,
                  vox_last_error());
    ck_assert_ptr_null(grid);
    free_scene(&s);
    free(f.bytes);
}
END_TEST

START_TEST(missing_and_additional_chunks) {
    static const char* const required[] = {"GRID", "SLOT", "PAIR", "EVNT"};
    static const unsigned char note[24] = {'n', 'o', 't', 'e', 0, 0, 0,   0,   3,  0,
                                           0,   0,   0,   0,   0, 0, 'x', 'y', 'z'};
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    for (int i = 0; i < 4; ++i) {
        const file g = without_chunk(f, required[i], 0);
        refused(g, VOX_ERROR_FORMAT, required[i]);
        free(g.bytes);
    }
    const file fewer = without_chunk(f, "MESH", 2);
    refused(fewer, VOX_ERROR_FORMAT, "it is of mesh 16385, expected mesh 12289");
    const file last = without_chunk(f, "MESH", 6);
    refused(last, VOX_ERROR_FORMAT, "it has 6 of 7 meshes, mesh 28673 is missing");
    const unsigned char* mesh = find_chunk(f, "MESH", 6);
    const file twice = with_bytes(f, (size_t)(mesh - f.bytes), mesh, chunk_bytes(mesh));
    refused(twice, VOX_ERROR_FORMAT, "it is of mesh 28673, expected no more meshes");
    const file grid_twice =
        with_bytes(f, header_bytes, f.bytes + header_bytes, chunk_bytes(f.bytes + header_bytes));
    refused(grid_twice, VOX_ERROR_FORMAT, "chunk GRID at byte 136: it comes a second time");

    /* A later version's remark that does not matter. */
    const file more = with_bytes(f, f.size, note, sizeof note);
    vox_grid* again = load(more, VOX_ENGINE_AUTO);
    ck_ok(vox_grid_step(again));
    ck_ok(vox_grid_step(s.grid));
    same_results(s.grid, again);
    vox_grid_destroy(again);

    const file nothing = {f.bytes, header_bytes};
    seal(nothing);
    refused(nothing, VOX_ERROR_FORMAT, "it has no chunk");
    free_scene(&s);
    free(f.bytes);
    free(fewer.bytes);
    free(last.bytes);
    free(twice.bytes);
    free(grid_twice.bytes);
    free(more.bytes);
}
END_TEST

/* ---- memory ---- */

static vox_grid_desc ledger_desc(ledger* l) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.allocator = ledger_allocator(l);
    return desc;
}

START_TEST(allocation_n_fails) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    ck_ok(vox_grid_step(s.grid));
    ledger l = {0};
    const vox_grid_desc desc = ledger_desc(&l);
    vox_grid* grid = NULL;
    uint64_t n = 0;
    while (!grid) {
        l.calls = 0;
        l.fail_at = ++n;
        if (vox_grid_load(f.bytes, f.size, &desc, &grid) == VOX_OK) break;
        ck_assert_ptr_null(grid);
        ck_assert_str_eq(vox_last_error(), "out of memory");
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(n, 20); /* there were allocations to fail */
    ck_ok(vox_grid_step(grid));
    same_results(s.grid, grid);
    const uint64_t calls = l.calls;
    const file g = save(grid);
    ck_assert_uint_eq(l.calls, calls); /* saving allocates nothing */
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_scene(&s);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

START_TEST(every_word_turned_hostile) {
    /* Whatever stands in a file: it is refused with numbers, or it is a grid; in memory bounded by its size.
     */
    static const uint32_t values[] = {0,           1,           2,           0x7fffffffu,
                                      0x80000000u, 0x80000001u, 0xffffffffu, 0x10000000u};
    scene s;
    make_scene(&s, suite_engine, 0);
    for (int i = 1; i < scene_bodies; ++i) /* small, so that each word can have its turn */
        if (i != removed_body) ck_ok(vox_mesh_remove(s.grid, s.ids[i]));
    const file f = save(s.grid);
    uint64_t loaded = 0, rejected = 0;
    for (size_t at = 8; at + 4 <= f.size; at += 4) {
        if (at == 12) continue; /* the checksum */
        const uint64_t old = get(f.bytes + at, 4);
        for (size_t v = 0; v < sizeof values / sizeof *values; ++v) {
            ledger l = {0};
            const vox_grid_desc desc = ledger_desc(&l);
            vox_grid* grid = NULL;
            put(f.bytes + at, 4, values[v]);
            if (at >= 16 && at < 24) { /* the size, which seal() would mend */
                if (values[v] != old) refused(f, VOX_ERROR_FORMAT, "snapshot: ");
                continue;
            }
            seal(f);
            const vox_result result = vox_grid_load(f.bytes, f.size, &desc, &grid);
            if (result == VOX_OK) {
                const vox_result stepped = vox_grid_step(grid);
                ck_assert(stepped == VOX_OK || stepped == VOX_ERROR_NON_FINITE ||
                          stepped == VOX_ERROR_INVALID_STATE ||
                          stepped == VOX_ERROR_BUDGET); /* of the reference engine's table */
                vox_grid_destroy(grid);
                ++loaded;
            } else {
                ck_assert_msg(result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED ||
                                  result == VOX_ERROR_LIMIT,
                              "word %zu: %s", at, vox_result_string(result));
                ck_assert_uint_lt(l.peak, 65536 + 200 * f.size);
                ++rejected;
            }
            ck_assert_uint_eq(l.bytes, 0);
        }
        put(f.bytes + at, 4, old);
        seal(f);
    }
    ck_assert_uint_gt(loaded, 100);
    ck_assert_uint_gt(rejected, 100);
    free_scene(&s);
    free(f.bytes);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_test(tests, loaded_grid_goes_on_as_the_saved_one);
    tcase_add_test(tests, saving_the_loaded_grid_gives_the_same_bytes);
    tcase_add_test(tests, every_engine_takes_it);
    tcase_add_test(tests, generations_and_retired_slots);
    tcase_add_test(tests, positions_keep_their_bits);
    tcase_add_test(tests, an_empty_grid_and_one_without_positions);
    tcase_add_test(tests, arguments);
    tcase_add_test(tests, cut_off_and_damaged);
    tcase_add_test(tests, missing_and_additional_chunks);
    tcase_add_test(tests, allocation_n_fails);
}

static void add_long_tests(TCase* tests) {
    tcase_add_test(tests, every_word_turned_hostile);
}

int main(void) {
    Suite* suite = suite_create("snapshot");
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
    TCase* hostile = tcase_create("hostile");
    tcase_set_timeout(hostile, 0);
    tcase_add_loop_test(hostile, hostile_numbers, 0, (int)(sizeof defects / sizeof *defects));
    suite_add_tcase(suite, hostile);
    return run_suite(suite);
}
