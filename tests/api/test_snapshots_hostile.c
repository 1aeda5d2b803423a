/* Snapshots: nothing that is wrong with a file gets in. */
#include "support/ledger.h"
#include "support/snapshot_checks.h"

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
    vox_grid* again = load(f, ENGINE_FAST); /* it was all put back */
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

/* The scene has slots 0 to 7, of which slot 2 is empty; body ids are slot << 12 | 1. */
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
    {"GRID", 0, 84, 4, 257, VOX_ERROR_FORMAT, "max_constraints_per_pair is 257"},
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
    {"SLOT", 0, 12, 4, 0x80000002u, VOX_ERROR_FORMAT, "it is of body 4097, expected body 4098"},
    {"SLOT", 0, 16, 4, 4095, VOX_ERROR_FORMAT, "1 free slots are listed, 0 are free"},
    {"SLOT", 0, 40, 4, 8, VOX_ERROR_FORMAT, "free slot 8 of 8 slots"},
    {"SLOT", 0, 40, 4, 3, VOX_ERROR_FORMAT, "slot 3 is listed as free, but"},
    {"MESH", 0, 0, 4, 4097, VOX_ERROR_FORMAT, "it is of body 4097, expected body 1"},
    {"MESH", 1, 0, 4, 1, VOX_ERROR_FORMAT, "it is of body 1, expected body 4097"},
    {"MESH", 1, 0, 4, 0, VOX_ERROR_FORMAT, "it is of body 0, expected body 4097"},
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
    {"MESH", 0, 40, 4, 27, VOX_ERROR_FORMAT, "body 1: tet 0 names vertex 27 of 27"},
    {"MESH", 5, 16, 8, 1ull << 60, VOX_ERROR_FORMAT, "positions"},
    {"MESH", 6, 16, 8, 1ull << 60, VOX_ERROR_LIMIT,
     "positions.count is 1152921504606846976"}, /* without positions */
    {"MESH", 6, -16, 4, 0x544c4946u, VOX_ERROR_FORMAT, "body 28673 is not in it"},
    {"CUTS", 0, 0, 4, 0, VOX_ERROR_FORMAT, "body 0 is not in it"},
    {"CUTS", 1, 0, 4, 1, VOX_ERROR_FORMAT, "body 1 comes after body 1"},
    {"CUTS", 0, 4, 4, 1, VOX_ERROR_FORMAT, "a reserved word is 1"},
    {"CUTS", 0, 8, 8, UINT64_MAX, VOX_ERROR_FORMAT, "tetrahedra that are off past the last one, number 40"},
    {"CUTS", 0, 16, 8, 1u << 2, VOX_ERROR_FORMAT, "body 1: tet 2 is removed, but not off"},
    {"CUTS", 0, 24, 8, 1u << 26, VOX_ERROR_FORMAT, "names vertex 26, which was removed"},
    {"CUTS", 0, 24, 8, 1u << 27, VOX_ERROR_FORMAT, "vertices that are removed past the last one, number 27"},
    {"CUTS", 0, -8, 8, 24, VOX_ERROR_FORMAT,
     "1 vertices that are removed of 8 bytes each, it has 0 more bytes"},
    {"CUTS", 0, -8, 8, 40, VOX_ERROR_FORMAT, "40 bytes, expected 32"},
    {"FILT", 0, 0, 4, 0, VOX_ERROR_FORMAT, "body 0 is not in it"},
    {"FILT", 1, 0, 4, 1, VOX_ERROR_FORMAT, "body 1 comes after body 1"},
    {"FILT", 0, 28, 4, 9, VOX_ERROR_LIMIT, "9"},
    {"FILT", 0, 32, 4, 1, VOX_ERROR_FORMAT, "a reserved word is 1"},
    {"FILT", 0, 40, 8, 0x7ff0000000000000ull, VOX_ERROR_FORMAT, "self_rest_distance"},
    {"FILT", 1, 36, 4, 2, VOX_ERROR_FORMAT, "positions of 24 bytes each"},
    {"FILT", 1, 36, 4, 3, VOX_ERROR_FORMAT, "its rest pose is of kind 3, expected 0 to 2"},
    {"FILT", 1, 36, 4, 0, VOX_ERROR_FORMAT, "bytes, expected"},
    {"FILT", 1, 48, 4, 0x7f800000u, VOX_ERROR_FORMAT, "not finite"},
    {"PAIR", 0, 0, 4, 20481, VOX_ERROR_FORMAT, "pair (20481, 20481) is out of order"},
    {"PAIR", 0, 4, 4, 8193, VOX_ERROR_FORMAT, "body id 8193 (slot 2, generation 1) is stale"},
    {"PAIR", 0, -8, 8, 4, VOX_ERROR_FORMAT, "1 number of 4 bytes each, it has 0 more"},
    {"EVNT", 0, 0, 8, 1ull << 60, VOX_ERROR_FORMAT, "1152921504606846976 pairs of 24 bytes each"},
    {"EVNT", 0, 8, 8, 1, VOX_ERROR_FORMAT, "a reserved number is 1, expected 0"},
    {"EVNT", 0, 16, 4, 2, VOX_ERROR_FORMAT, "body 2 was never in the grid"},
    {"EVNT", 0, 16, 4, 0, VOX_ERROR_FORMAT, "body 0 was never in the grid"},
    {"EVNT", 0, 16, 4, 8u << 12 | 1, VOX_ERROR_FORMAT, "body 32769 was never in the grid"},
    {"EVNT", 0, 16, 4, 7u << 12 | 1, VOX_ERROR_FORMAT, "pair 0 (28673, "},
    {"EVNT", 0, -16, 4, 0x44495247u, VOX_ERROR_FORMAT, "it comes after chunk PAIR"},
    {"EVNT", 0, -16, 4, 0x52494150u, VOX_ERROR_FORMAT, "it comes a second time"},
    {"EVNT", 0, -16, 4, 0x544e5665u, VOX_ERROR_FORMAT, "it has no chunk EVNT"},
};

START_TEST(hostile_numbers) {
    const defect* d = &defects[_i];
    scene s;
    make_scene(&s, ENGINE_FAST, 0);
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
    refused(fewer, VOX_ERROR_FORMAT, "it is of body 16385, expected body 12289");
    const file last = without_chunk(f, "MESH", 6);
    refused(last, VOX_ERROR_FORMAT, "it has 6 of 7 bodies, body 28673 is missing");
    const unsigned char* mesh = find_chunk(f, "MESH", 6);
    const file twice = with_bytes(f, (size_t)(mesh - f.bytes), mesh, chunk_bytes(mesh));
    refused(twice, VOX_ERROR_FORMAT, "it is of body 28673, expected no more bodies");
    const file grid_twice =
        with_bytes(f, header_bytes, f.bytes + header_bytes, chunk_bytes(f.bytes + header_bytes));
    refused(grid_twice, VOX_ERROR_FORMAT, "chunk GRID at byte 136: it comes a second time");

    /* A later version's remark that does not matter. */
    const file more = with_bytes(f, f.size, note, sizeof note);
    vox_grid* again = load(more, ENGINE_FAST);
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

START_TEST(every_word_turned_hostile) {
    /* Whatever stands in a file: it is refused with numbers, or it is a grid; in memory bounded by its size.
     */
    static const uint32_t values[] = {0,           1,           2,           0x7fffffffu,
                                      0x80000000u, 0x80000001u, 0xffffffffu, 0x10000000u};
    scene s;
    make_scene(&s, suite_engine, 0);
    for (int i = 1; i < scene_bodies; ++i) /* small, so that each word can have its turn */
        if (i != removed_body) ck_ok(vox_body_remove(s.grid, s.ids[i]));
    const file f = save(s.grid);
    uint64_t loaded = 0, rejected = 0;
    for (size_t at = 8; at + 4 <= f.size; at += 4) {
        if (at == 12) continue; /* the checksum */
        const uint64_t old = get(f.bytes + at, 4);
        for (size_t v = 0; v < sizeof values / sizeof *values; ++v) {
            ledger l = {0};
            vox_grid_desc desc = vox_default_grid_desc();
            vox_grid* grid = NULL;
            desc.allocator = ledger_allocator(&l);
            put(f.bytes + at, 4, values[v]);
            if (at >= 16 && at < 24) { /* the size, which seal() would correct */
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
    tcase_add_each(tests, cut_off_and_damaged, missing_and_additional_chunks);
}

static void add_long_tests(TCase* tests) { tcase_add_test(tests, every_word_turned_hostile); }

SUITE(snapshots_hostile) {
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
    TCase* hostile = add_case(suite, "hostile");
    tcase_add_loop_test(hostile, hostile_numbers, 0, (int)(sizeof defects / sizeof *defects));
}
