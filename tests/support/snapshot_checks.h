/* Snapshots as bytes, the format spelled out once more by itself (docs/snapshot.md); a grid with something of
 * everything to be saved; and what two grids must have in common. */
#ifndef VOX_TESTS_SNAPSHOT_CHECKS_H
#define VOX_TESTS_SNAPSHOT_CHECKS_H

#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

/* ---- bytes ---- */

enum { header_bytes = 24, chunk_header_bytes = 16 };

typedef struct file {
    unsigned char* bytes;
    size_t size;
} file;

static inline file save(const vox_grid* grid) {
    file f = {NULL, 0};
    uint64_t size = 0, written = 0;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    f.size = (size_t)size;
    f.bytes = (unsigned char*)malloc(f.size);
    ck_ok(vox_grid_save(grid, f.bytes, f.size, &written));
    ck_assert_uint_eq(size, written);
    return f;
}

static inline vox_grid* load(file f, engine_kind engine) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    use_engine(&desc, engine);
    ck_ok(vox_grid_load(f.bytes, f.size, &desc, &grid));
    return grid;
}

static inline uint64_t get(const unsigned char* at, int bytes) {
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;) value = value << 8 | at[i];
    return value;
}

static inline void put(unsigned char* at, int bytes, uint64_t value) {
    for (int i = 0; i < bytes; ++i) at[i] = (unsigned char)(value >> 8 * i);
}

/* CRC-32, bit by bit. */
static inline void seal(file f) {
    uint32_t remainder = 0xffffffffu;
    put(f.bytes + 16, 8, f.size);
    for (size_t i = 16; i < f.size; ++i) {
        remainder ^= f.bytes[i];
        for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320u : 0);
    }
    put(f.bytes + 12, 4, ~remainder & 0xffffffffu);
}

static inline file copy_of(file f) {
    file copy = {(unsigned char*)malloc(f.size), f.size};
    memcpy(copy.bytes, f.bytes, f.size);
    return copy;
}

static inline size_t chunk_bytes(const unsigned char* chunk) {
    return chunk_header_bytes + (size_t)((get(chunk + 8, 8) + 7) / 8 * 8);
}

/* The n-th chunk of that name, from 0. */
static inline unsigned char* find_chunk(file f, const char* name, int n) {
    for (size_t at = header_bytes; at < f.size; at += chunk_bytes(f.bytes + at))
        if (memcmp(f.bytes + at, name, 4) == 0 && n-- == 0) return f.bytes + at;
    ck_abort_msg("no chunk %s", name);
    return NULL;
}

static inline unsigned char* payload(file f, const char* name, int n) {
    return find_chunk(f, name, n) + chunk_header_bytes;
}

/* Takes a chunk out, or puts `added` bytes in before it. */
static inline file without_chunk(file f, const char* name, int n) {
    const unsigned char* chunk = find_chunk(f, name, n);
    const size_t at = (size_t)(chunk - f.bytes), size = chunk_bytes(chunk);
    file shorter = copy_of(f);
    memmove(shorter.bytes + at, shorter.bytes + at + size, f.size - at - size);
    shorter.size -= size;
    seal(shorter);
    return shorter;
}

static inline file with_bytes(file f, size_t at, const void* added, size_t size) {
    file longer = {(unsigned char*)malloc(f.size + size), f.size + size};
    memcpy(longer.bytes, f.bytes, at);
    memcpy(longer.bytes + at, added, size);
    memcpy(longer.bytes + at + size, f.bytes + at, f.size - at);
    seal(longer);
    return longer;
}

static inline void refused(file f, vox_result code, const char* words) {
    vox_grid* grid = NULL;
    ck_fails(vox_grid_load(f.bytes, f.size, NULL, &grid), code, words);
    ck_assert_ptr_null(grid);
}

/* ---- a grid with something of everything ---- */

typedef struct scene {
    vox_grid* grid;
    body bodies[6];
    vox_body ids[8]; /* of the bodies, of one without positions, of an empty one */
    float strided[5 * 4];
    double doubles[3 * 64]; /* of body 5 */
} scene;

enum { scene_bodies = 6, removed_body = 2, disabled_body = 4 };

static inline void make_scene(scene* s, engine_kind engine, double cell_size) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, engine);
    desc.cell_size = cell_size;
    desc.flags = VOX_GRID_CONSTRAINTS;
    ck_ok(vox_grid_create(&desc, &s->grid));
    for (uint32_t i = 0; i < scene_bodies; ++i) {
        s->bodies[i] = make_box(2 + i % 2, 0.25f, 0.3f * (float)i, 0.1f * (float)i, 0.05f * (float)i);
        vox_mesh_desc mesh = body_desc(&s->bodies[i]);
        mesh.user_data = 1000 + i;
        if (i % 2) mesh.flags = VOX_MESH_COPY_POSITIONS;
        if (i == 1) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
        ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[i]));
    }
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    filter.self_rest_distance = 0.01;
    filter.world = 7; /* alone in it, but for itself */
    ck_ok(vox_body_set_filter(s->grid, s->ids[3], &filter));
    filter = plain_filter();
    filter.group = -7;
    filter.category = 1ull << 63;
    filter.mask = ~2ull;
    filter.flags |= VOX_FILTER_SENSOR;
    ck_ok(vox_body_set_filter(s->grid, s->ids[0], &filter));
    ck_ok(vox_grid_set_pair_enabled(s->grid, s->ids[5], s->ids[0], 0));
    ck_assert_uint_le(s->bodies[5].vertex_count, 64);
    for (uint32_t i = 0; i < 3 * s->bodies[5].vertex_count; ++i)
        s->doubles[i] = s->bodies[5].positions[i] + 1e-12 * i; /* what no float could keep */
    ck_ok(bind_array(s->grid, s->ids[5], s->doubles, VOX_FORMAT_DOUBLE, 0, 0));
    static const double turn[12] = {0.8, -0.6, 0, 0.2, 0.6, 0.8, 0, 0.1, 0, 0, 1, 0.05};
    ck_ok(vox_body_set_transform(s->grid, s->ids[3], turn));

    vox_mesh_desc mesh = vox_mesh_desc_floats(NULL, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[6]));
    for (int v = 0; v < 4; ++v) memcpy(s->strided + 5 * v, unit_tet_positions + 3 * v, 3 * sizeof(float));
    ck_ok(bind_array(s->grid, s->ids[6], s->strided, VOX_FORMAT_FLOAT, 5 * sizeof(float), 0));
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
    ck_ok(vox_body_remove(s->grid, s->ids[removed_body]));
    ck_ok(vox_body_set_enabled(s->grid, s->ids[disabled_body], 0));
    for (uint32_t v = 0; v < s->bodies[0].vertex_count; ++v) s->bodies[0].positions[3 * v] += 0.1f;
}

static inline void free_scene(scene* s) {
    vox_grid_destroy(s->grid);
    for (int i = 0; i < scene_bodies; ++i) free_body(&s->bodies[i]);
}

static inline void same_results(const vox_grid* a, const vox_grid* b) {
    uint64_t hash_a = 1, hash_b = 2;
    const vox_contact_view x = contacts_of(a), y = contacts_of(b);
    ck_assert_uint_eq(x.count, y.count);
    if (x.count) ck_assert_int_eq(memcmp(x.data, y.data, (size_t)x.count * sizeof *x.data), 0);
    const vox_pair_view p = pairs_of(a), q = pairs_of(b);
    ck_assert_uint_eq(p.count, q.count);
    if (p.count) ck_assert_int_eq(memcmp(p.data, q.data, (size_t)p.count * sizeof *p.data), 0);
    const vox_constraint_view c = constraints_of(a), d = constraints_of(b);
    ck_assert_uint_eq(c.count, d.count);
    for (uint64_t i = 0; i < c.count; ++i) { /* which were there before is not saved */
        vox_constraint mine = c.data[i], other = d.data[i];
        mine.previous = other.previous = VOX_NONE;
        ck_assert_int_eq(memcmp(&mine, &other, sizeof mine), 0);
    }
    ck_ok(vox_grid_get_hash(a, &hash_a));
    ck_ok(vox_grid_get_hash(b, &hash_b));
    ck_assert_uint_eq(hash_a, hash_b);
    ck_assert_uint_eq(grid_info(a).epoch, grid_info(b).epoch);
}

#endif
