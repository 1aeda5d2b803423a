/* Writes the vectors that every binding replays: vectors.json, a script of calls with what each has to give,
 * and vectors.bin, the arrays that the calls name by offset. bindings/vectors/README.md describes both.
 * usage: write_vectors FOLDER */
#include "scenes/scenes.h"

#include <vox/vox_cell_size.h>
#include <vox/vox_query.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>

static FILE *script, *arrays;
static uint64_t array_size;
static int scene_calls; /* of the scene that is being written */
static vox_grid* grid;
static vox_locator* locator;

/* ---- writing ---- */

static void stop(const char* what) {
    fprintf(stderr, "write_vectors: %s: %s\n", what, vox_last_error());
    exit(EXIT_FAILURE);
}

static void expect(vox_result result, const char* what) {
    if (result != VOX_OK) stop(what);
}

/* Appends an array to vectors.bin, at a multiple of 8 bytes; its offset. */
static uint64_t store(const void* data, size_t size) {
    static const char zeros[8];
    const uint64_t offset = array_size;
    const size_t padding = (8 - size % 8) % 8;
    if (fwrite(data, 1, size, arrays) != size || fwrite(zeros, 1, padding, arrays) != padding) {
        fprintf(stderr, "write_vectors: %s\n", strerror(errno));
        exit(EXIT_FAILURE);
    }
    array_size += size + padding;
    return offset;
}

static void begin_call(const char* name) {
    fprintf(script, "%s\n   {\"call\": \"%s\"", scene_calls++ ? "," : "", name);
}

static void field(const char* name, const char* pattern, ...) {
    va_list arguments;
    va_start(arguments, pattern);
    fprintf(script, ", \"%s\": ", name);
    vfprintf(script, pattern, arguments);
    va_end(arguments);
}

static void numbers_field(const char* name, const double* values, int count) {
    fprintf(script, ", \"%s\": [", name);
    for (int i = 0; i < count; ++i) fprintf(script, "%s%.17g", i ? ", " : "", values[i]);
    fprintf(script, "]");
}

static void end_call(void) { fprintf(script, "}"); }

/* Of 32-bit words. The sign of a zero, which compilers may differ in, does not count. */
static uint64_t hash_words(const void* data, uint64_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint64_t i = 0; i < size; i += 4) {
        uint32_t word;
        memcpy(&word, (const char*)data + i, 4);
        if (word == 0x80000000u) word = 0;
        hash = (hash ^ word) * 0x100000001b3u;
    }
    return hash;
}

/* [how many, the hash of their words] */
static void items_field(const char* name, const void* data, uint64_t count, size_t size) {
    field(name, "[%" PRIu64 ", \"%016" PRIx64 "\"]", count, hash_words(data, count * size));
}

static void begin_scene(const char* name, const char* what, uint32_t flags, double cell_size) {
    static int scenes;
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = flags;
    desc.cell_size = cell_size;
    expect(vox_grid_create(&desc, &grid), name);
    fprintf(script, "%s\n  {\"name\": \"%s\", \"what\": \"%s\", \"calls\": [", scenes++ ? "," : "", name,
            what);
    scene_calls = 0;
    begin_call("create");
    field("flags", "%u", flags);
    field("cell_size", "%.17g", cell_size);
    end_call();
}

static void end_scene(void) {
    fprintf(script, "]}");
    vox_locator_release(locator);
    locator = NULL;
    vox_grid_destroy(grid);
    grid = NULL;
}

/* What a call gave if it failed. */
static vox_result tell(vox_result result) {
    if (result != VOX_OK) {
        field("fails", "%d", (int)result);
        field("text", "\"%s\"", vox_last_error()); /* without quotation marks and backslashes */
    }
    return result;
}

static vox_result finish(vox_result result) {
    tell(result);
    end_call();
    return result;
}

/* ---- calls ---- */

static void filter_field(const vox_filter* f) {
    fprintf(script,
            ", \"filter\": {\"group\": %d, \"category\": \"%" PRIu64 "\", \"mask\": \"%" PRIu64
            "\", \"flags\": %u, \"world\": %u, \"self_rings\": %u, \"self_rest_distance\": %.17g}",
            f->group, f->category, f->mask, f->flags, f->world, f->self_rings, f->self_rest_distance);
}

static double* as_doubles(const body* b) {
    double* doubles = (double*)malloc(3 * sizeof *doubles * b->vertex_count);
    for (uint32_t i = 0; i < 3 * b->vertex_count; ++i) doubles[i] = (double)b->positions[i];
    return doubles;
}

static uint64_t store_positions(const body* b, vox_format format) {
    double* doubles = as_doubles(b);
    const uint64_t offset = format == VOX_FORMAT_DOUBLE
                                ? store(doubles, 3 * sizeof(double) * b->vertex_count)
                                : store(b->positions, 3 * sizeof(float) * b->vertex_count);
    free(doubles);
    return offset;
}

/* Positions are copied, so that the vectors need no array of the caller's. */
static vox_body insert(const body* b, vox_format format, const vox_filter* filter, uint64_t user_data) {
    double* doubles = as_doubles(b);
    vox_mesh_desc desc = body_desc(b);
    vox_body mesh = VOX_NULL_BODY;
    desc.flags = VOX_MESH_COPY_POSITIONS;
    desc.positions.format = format;
    desc.positions.data = format == VOX_FORMAT_DOUBLE ? (const void*)doubles : b->positions;
    if (filter) desc.filter = *filter;
    desc.user_data = user_data;
    begin_call("insert");
    field("format", "%d", (int)format);
    field("positions", "%" PRIu64, store_positions(b, format));
    field("vertices", "%u", b->vertex_count);
    field("tets", "%" PRIu64, store(b->tets, 4 * sizeof(uint32_t) * b->tet_count));
    field("tet_count", "%u", b->tet_count);
    field("user_data", "\"%" PRIu64 "\"", user_data);
    if (filter) filter_field(filter);
    const vox_result result = vox_mesh_insert(grid, &desc, &mesh);
    if (result == VOX_OK) field("mesh", "%u", mesh);
    finish(result);
    free(doubles);
    return mesh;
}

static void move(vox_body mesh, const body* b, vox_format format) {
    void* positions;
    expect(vox_mesh_map_positions(grid, mesh, &positions), "move");
    double* doubles = as_doubles(b);
    if (format == VOX_FORMAT_DOUBLE)
        memcpy(positions, doubles, 3 * sizeof(double) * b->vertex_count);
    else
        memcpy(positions, b->positions, 3 * sizeof(float) * b->vertex_count);
    free(doubles);
    begin_call("move");
    field("mesh", "%u", mesh);
    field("format", "%d", (int)format);
    field("positions", "%" PRIu64, store_positions(b, format));
    field("vertices", "%u", b->vertex_count);
    end_call();
}

static void constraints_fields(void) {
    vox_constraint_view view;
    expect(vox_grid_get_constraints(grid, &view), "constraints");
    items_field("constraints", view.data, view.count, sizeof *view.data);
    items_field("pair_offsets", view.pair_offsets, view.pair_count + 1, sizeof *view.pair_offsets);
}

/* A step, and everything that it leaves. */
static void step(void) {
    begin_call("step");
    if (finish(vox_grid_step(grid)) != VOX_OK) return;
    vox_contact_view contacts;
    vox_pair_view pairs;
    uint64_t hash;
    vox_grid_info info = {.struct_size = sizeof info};
    expect(vox_grid_get_contacts(grid, &contacts), "contacts");
    expect(vox_grid_get_pairs(grid, &pairs), "pairs");
    expect(vox_grid_get_hash(grid, &hash), "hash");
    expect(vox_grid_get_info(grid, &info), "info");
    begin_call("results");
    field("hash", "\"%016" PRIx64 "\"", hash);
    field("epoch", "%" PRIu64, info.epoch);
    items_field("contacts", contacts.data, contacts.count, sizeof *contacts.data);
    uint64_t inside = 0;
    for (uint64_t i = 0; i < contacts.count; ++i) inside += contacts.interiors[i];
    field("interior", "%" PRIu64, inside);
    items_field("pairs", pairs.data, pairs.count, sizeof *pairs.data);
    items_field("pair_contacts", pairs.contacts, contacts.count, sizeof *pairs.contacts);
    if (info.flags & VOX_GRID_CONSTRAINTS) constraints_fields();
    end_call();
}

static void find_constraints(vox_depth_method method) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = method;
    begin_call("find_constraints");
    field("method", "%d", (int)method);
    if (tell(vox_grid_find_constraints(grid, &desc)) == VOX_OK) constraints_fields();
    end_call();
}

/* How many hits there are, all of which a list with room for `capacity` has. */
static uint64_t fitting(uint64_t count, uint64_t capacity) {
    expect(count <= capacity ? VOX_OK : VOX_ERROR_LIMIT, "hits");
    return count;
}

/* A question about `count` positions, or pairs of positions, at these offsets. */
static void begin_question(const char* name, int count, const char* a, uint64_t at_a, const char* b,
                           uint64_t at_b) {
    begin_call(name);
    field("count", "%d", count);
    field(a, "%" PRIu64, at_a);
    if (b) field(b, "%" PRIu64, at_b);
}

/* At vertices of a body, and from each to the one that is as far from the other end. */
static void query(const body* b) {
    enum { count = 24, capacity = 65536 };
    static vox_point_hit points[capacity];
    static vox_box_hit boxes[capacity];
    static vox_ray_hit rays[capacity];
    vox_closest_hit closest[count];
    uint8_t blocked[count];
    double from[count][3], to[count][3], min[count][3], max[count][3];
    uint64_t hit_count = 0;
    begin_call("update_locator");
    finish(vox_grid_update_locator(grid, &locator));
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            from[i][a] = (double)b->positions[3 * (i * (b->vertex_count - 1) / count) + (uint32_t)a];
            to[count - 1 - i][a] = from[i][a];
        }
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            min[i][a] = from[i][a] < to[i][a] ? from[i][a] : to[i][a];
            max[i][a] = from[i][a] < to[i][a] ? to[i][a] : from[i][a];
        }
    const uint64_t at_from = store(from, sizeof from), at_to = store(to, sizeof to);
    const uint64_t at_min = store(min, sizeof min), at_max = store(max, sizeof max);
    const vox_positions begins = vox_double_positions(from[0], count),
                        ends = vox_double_positions(to[0], count);
    const vox_positions lows = vox_double_positions(min[0], count),
                        highs = vox_double_positions(max[0], count);
    expect(vox_locator_find_point_hits(locator, &begins, NULL, points, capacity, &hit_count), "point hits");
    begin_question("find_point_hits", count, "points", at_from, NULL, 0);
    items_field("hits", points, fitting(hit_count, capacity), sizeof *points);
    end_call();
    expect(vox_locator_find_closest(locator, &begins, NULL, closest), "closest");
    begin_question("find_closest", count, "points", at_from, NULL, 0);
    items_field("hits", closest, count, sizeof *closest);
    end_call();
    expect(vox_locator_find_box_hits(locator, &lows, &highs, NULL, boxes, capacity, &hit_count), "box hits");
    begin_question("find_box_hits", count, "min", at_min, "max", at_max);
    items_field("hits", boxes, fitting(hit_count, capacity), sizeof *boxes);
    end_call();
    for (uint32_t flags = 0; flags <= VOX_QUERY_FIRST_HIT; ++flags) {
        vox_query_desc desc = vox_default_query_desc();
        desc.flags = flags;
        expect(vox_locator_find_ray_hits(locator, &begins, &ends, &desc, rays, capacity, &hit_count),
               "ray hits");
        begin_question("find_ray_hits", count, "from", at_from, "to", at_to);
        field("flags", "%" PRIu32, flags);
        items_field("hits", rays, fitting(hit_count, capacity), sizeof *rays);
        end_call();
    }
    expect(vox_locator_test_rays(locator, &begins, &ends, NULL, blocked), "rays");
    begin_question("test_rays", count, "from", at_from, "to", at_to);
    uint32_t sum = 0;
    for (int i = 0; i < count; ++i) sum += blocked[i];
    field("blocked", "%" PRIu32, sum);
    end_call();
}

/* The bytes are the same on every machine. */
static uint64_t save(void** out_bytes, uint64_t* out_size) {
    expect(vox_grid_save(grid, NULL, 0, out_size), "size of a snapshot");
    *out_bytes = calloc((*out_size + 3) / 4, 4);
    expect(vox_grid_save(grid, *out_bytes, *out_size, out_size), "snapshot");
    begin_call("save");
    field("size", "%" PRIu64, *out_size);
    field("hash", "\"%016" PRIx64 "\"",
          hash_words(*out_bytes, (*out_size + 3) / 4 * 4)); /* zeros at the end */
    end_call();
    return store(*out_bytes, *out_size);
}

static void load(const void* bytes, uint64_t size, uint64_t offset) {
    vox_grid* loaded = NULL;
    begin_call("load");
    field("bytes", "%" PRIu64, offset);
    field("size", "%" PRIu64, size);
    if (finish(vox_grid_load(bytes, size, NULL, &loaded)) != VOX_OK) return;
    vox_grid_destroy(grid);
    grid = loaded;
}

/* The meshes of the grid: ids, counts, and the hash of their tetrahedra. */
static void meshes(void) {
    vox_body ids[MOST_BODIES];
    uint64_t count = 0;
    expect(vox_grid_get_bodies(grid, ids, MOST_BODIES, &count), "meshes");
    begin_call("meshes");
    fprintf(script, ", \"meshes\": [");
    for (uint64_t i = 0; i < count; ++i) {
        vox_body_info info;
        uint64_t tet_count;
        info.struct_size = sizeof info;
        expect(vox_body_get_info(grid, ids[i], &info), "info");
        uint32_t* tets = (uint32_t*)malloc(4 * sizeof *tets * info.tet_count + 1);
        expect(vox_mesh_get_tets(grid, ids[i], tets, NULL, info.tet_count, &tet_count), "tets");
        fprintf(script,
                "%s{\"mesh\": %u, \"user_data\": \"%" PRIu64 "\", \"vertices\": %" PRIu64
                ", \"tet_count\": %" PRIu64 ", \"enabled_tets\": %" PRIu64
                ", \"enabled\": %u, \"flags\": %u, \"format\": %d, \"tets\": \"%016" PRIx64 "\"}",
                i ? ", " : "", ids[i], info.user_data, info.positions.count, info.tet_count,
                info.enabled_tet_count, info.enabled, info.flags, (int)info.positions.format,
                hash_words(tets, 16 * tet_count));
        free(tets);
    }
    fprintf(script, "]");
    end_call();
}

/* To nine digits: models use functions of the C library, which machines may round differently. */
static void result_fields(const vox_cell_size_result* found) {
    field("cell_size", "%.9g", found->cell_size);
    field("zone_min", "%.9g", found->zone_min);
    field("zone_max", "%.9g", found->zone_max);
    field("cost", "%.9g", found->cost);
    field("result_min_cell_size", "%.9g", found->min_cell_size);
    field("curve_count", "%u", found->curve_count);
    field("term_count", "%u", found->term_count);
    fprintf(script, ", \"rules\": [");
    for (uint32_t i = 0; i < found->rule_count; ++i)
        fprintf(script, "%s%.9g", i ? ", " : "", found->rules[i].cell_size);
    fprintf(script, "], \"runs\": [");
    for (uint32_t i = 0; i < found->timing_count; ++i)
        fprintf(script, "%s%.9g", i ? ", " : "", found->timings[i].cell_size);
    fprintf(script, "]");
    field("warnings", "%u", found->warnings);
    field("note", "\"%s\"", found->note);
}

static void suggest(const scene* s, vox_cost_model model) {
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    vox_mesh_desc descs[MOST_BODIES];
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    desc.model = model;
    for (uint32_t i = 0; i < s->count; ++i) descs[i] = body_desc(&s->bodies[i]);
    begin_call("suggest");
    field("model", "%d", (int)model);
    fprintf(script, ", \"meshes\": [");
    for (uint32_t i = 0; i < s->count; ++i) {
        const body* b = &s->bodies[i];
        const uint64_t positions = store_positions(b, VOX_FORMAT_FLOAT);
        const uint64_t tets = store(b->tets, 16 * (size_t)b->tet_count);
        fprintf(script,
                "%s{\"positions\": %" PRIu64 ", \"vertices\": %u, \"tets\": %" PRIu64 ", \"tet_count\": %u}",
                i ? ", " : "", positions, b->vertex_count, tets, b->tet_count);
    }
    fprintf(script, "]");
    expect(vox_suggest_cell_size(&desc, descs, s->count, &found), "suggest");
    result_fields(&found);
    end_call();
}

/* ---- grids of other programs ---- */

/* The arrays of many calls are the same, and are stored once. */
static uint64_t store_once(const void* data, size_t size) {
    enum { most = 32 };
    static struct { uint64_t hash, size, offset; } stored[most];
    static int count;
    const uint64_t hash = hash_words(data, size);
    for (int i = 0; i < count; ++i)
        if (stored[i].hash == hash && stored[i].size == size) return stored[i].offset;
    const uint64_t offset = store(data, size);
    if (count < most) {
        stored[count].hash = hash;
        stored[count].size = size;
        stored[count++].offset = offset;
    }
    return offset;
}

/* What is put into a grid, or asks it. */
static void primitives_field(const char* name, const vox_primitives* p) {
    static const uint64_t vertices_of[] = {1, 2, 3, 4, 2};
    const uint64_t number = p->positions.format == VOX_FORMAT_DOUBLE ? sizeof(double) : sizeof(float);
    fprintf(script,
            ", \"%s\": {\"type\": %d, \"format\": %d, \"positions\": %" PRIu64 ", \"vertices\": %" PRIu64,
            name, (int)p->type, (int)p->positions.format,
            store_once(p->positions.data, 3 * number * p->positions.count), p->positions.count);
    if (p->indices) {
        const uint64_t size = p->count * vertices_of[p->type];
        field("indices", "%" PRIu64, store_once(p->indices, sizeof(uint32_t) * size));
        field("count", "%" PRIu64, size);
    }
    if (p->radii) field("radii", "%" PRIu64, store_once(p->radii, sizeof(double) * p->count));
    field("radius", "%.17g", p->radius);
    fprintf(script, "}");
}

static void foreign_fields(const vox_foreign_grid* g) {
    const vox_foreign_weights* w = &g->weights;
    const double weights[7] = {w->run, w->store, w->visit, w->found, w->read, w->occupied, w->cell};
    primitives_field("stored", g->stored);
    if (g->querying) primitives_field("querying", g->querying);
    field("known", "%d", (int)g->known);
    field("cells_stored", "%d", (int)g->cells_stored);
    field("cells_queried", "%d", (int)g->cells_queried);
    field("cells_kept", "%d", (int)g->cells_kept);
    numbers_field("weights", weights, 7);
    field("radius", "%.17g", g->radius);
    field("min_cell_size", "%.17g", g->min_cell_size);
    field("zone_loss", "%.17g", g->zone_loss);
}

/* Ends a call that gives a result. */
static void finish_result(vox_result result, const vox_cell_size_result* found) {
    if (result == VOX_OK) result_fields(found);
    finish(result);
}

static void foreign_suggest(const vox_foreign_grid* g) {
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    begin_call("foreign_suggest");
    foreign_fields(g);
    finish_result(vox_foreign_grid_suggest(g, &found), &found);
}

static void foreign_count(const vox_foreign_grid* g, double at) {
    vox_foreign_counts c = {0, 0, 0, 0, 0, 0};
    begin_call("foreign_count");
    foreign_fields(g);
    field("at", "%.17g", at);
    const vox_result result = vox_foreign_grid_count(g, at, &c);
    if (result == VOX_OK) {
        const double counts[6] = {c.stored, c.visits, c.empty, c.reads, c.occupied, c.cells};
        fprintf(script, ", \"counts\": [");
        for (int i = 0; i < 6; ++i) fprintf(script, "%s%.9g", i ? ", " : "", counts[i]);
        fprintf(script, "]");
    }
    finish(result);
}

static void foreign_fit(const vox_foreign_grid* g, const vox_timing* timings, int count) {
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    begin_call("foreign_fit");
    foreign_fields(g);
    fprintf(script, ", \"timings\": [");
    for (int i = 0; i < count; ++i)
        fprintf(script, "%s[%.17g, %.17g]", i ? ", " : "", timings[i].cell_size, timings[i].seconds);
    fprintf(script, "]");
    finish_result(vox_foreign_grid_fit(g, timings, (uint64_t)count, &found), &found);
}

/* Stands for a program that is timed. */
typedef struct made_up_run {
    double fixed, falls, grows; /* seconds: fixed + falls / d^2 + grows * d^2 */
    double fails_below;         /* it cannot run at smaller cell sizes */
    int stops_after;            /* so many runs; 0: never */
    int runs;
} made_up_run;

static double run_made_up(double d, void* user) {
    made_up_run* r = (made_up_run*)user;
    if (r->stops_after && ++r->runs > r->stops_after) return -1;
    if (d < r->fails_below) return INFINITY;
    return r->fixed + r->falls / (d * d) + r->grows * (d * d);
}

/* grid null: nothing is known of it. */
static void foreign_tune(const vox_foreign_grid* g, double first, uint32_t max_runs, made_up_run run) {
    vox_cell_size_result found;
    vox_tune_desc desc = vox_default_tune_desc();
    found.struct_size = sizeof found;
    desc.first = first;
    desc.max_runs = max_runs;
    begin_call("foreign_tune");
    if (g) foreign_fields(g);
    field("first", "%.17g", first);
    field("max_runs", "%u", max_runs);
    field("run", "[%.17g, %.17g, %.17g]", run.fixed, run.falls, run.grows);
    field("fails_below", "%.17g", run.fails_below);
    field("stops_after", "%d", run.stops_after);
    finish_result(vox_foreign_grid_tune(g, &desc, run_made_up, &run, &found), &found);
}

static void transform(vox_body mesh, const double matrix[12]) {
    begin_call("set_transform");
    field("mesh", "%u", mesh);
    field("matrix", "%" PRIu64, store(matrix, 12 * sizeof *matrix));
    finish(vox_body_set_transform(grid, mesh, matrix));
}

static void set_filter(vox_body mesh, const vox_filter* filter) {
    begin_call("set_filter");
    field("mesh", "%u", mesh);
    filter_field(filter);
    finish(vox_body_set_filter(grid, mesh, filter));
}

static void set_enabled(vox_body mesh, uint32_t enabled) {
    begin_call("set_enabled");
    field("mesh", "%u", mesh);
    field("enabled", "%u", enabled);
    finish(vox_body_set_enabled(grid, mesh, enabled));
}

static void set_pair_enabled(vox_body a, vox_body b, uint32_t enabled) {
    begin_call("set_pair_enabled");
    field("body_a", "%u", a);
    field("body_b", "%u", b);
    field("enabled", "%u", enabled);
    finish(vox_grid_set_pair_enabled(grid, a, b, enabled));
}

static void remove_mesh(vox_body mesh) {
    begin_call("remove");
    field("mesh", "%u", mesh);
    finish(vox_body_remove(grid, mesh));
}

static void set_flags(uint32_t flags) {
    begin_call("set_flags");
    field("flags", "%u", flags);
    finish(vox_grid_set_flags(grid, flags));
}

static void clear(void) {
    begin_call("clear");
    finish(vox_grid_clear(grid));
}

/* "set_tets_enabled" or "remove_tets". */
static void switch_tets(const char* name, vox_body mesh, const uint32_t* tets, uint64_t count,
                        uint32_t enabled) {
    begin_call(name);
    field("mesh", "%u", mesh);
    field("indices", "%" PRIu64, store(tets, count * sizeof *tets));
    field("count", "%" PRIu64, count);
    if (strcmp(name, "remove_tets") == 0) {
        finish(vox_mesh_remove_tets(grid, mesh, tets, count));
    } else {
        field("enabled", "%u", enabled);
        finish(vox_mesh_set_tets_enabled(grid, mesh, tets, count, enabled));
    }
}

/* Copies of vertices, and the tetrahedra that use them from now on. */
static uint32_t append_copies(vox_body mesh, const uint32_t* copies_of, uint64_t count) {
    vox_vertices_desc desc = vox_default_vertices_desc();
    uint32_t first = 0;
    desc.count = count;
    desc.copies_of = copies_of;
    begin_call("append_copies");
    field("mesh", "%u", mesh);
    field("copies_of", "%" PRIu64, store(copies_of, count * sizeof *copies_of));
    field("count", "%" PRIu64, count);
    const vox_result result = vox_mesh_append_vertices(grid, mesh, &desc, &first);
    if (result == VOX_OK) field("first", "%u", first);
    finish(result);
    return first;
}

static void replace_tets(vox_body mesh, const uint32_t* tets, uint64_t count, const uint32_t* corners) {
    begin_call("replace_tets");
    field("mesh", "%u", mesh);
    field("indices", "%" PRIu64, store(tets, count * sizeof *tets));
    field("count", "%" PRIu64, count);
    field("corners", "%" PRIu64, store(corners, 4 * count * sizeof *corners));
    finish(vox_mesh_replace_tets(grid, mesh, tets, count, corners));
}

static void append_tets(vox_body mesh, const uint32_t* corners, uint64_t count) {
    uint32_t first = 0;
    begin_call("append_tets");
    field("mesh", "%u", mesh);
    field("corners", "%" PRIu64, store(corners, 4 * count * sizeof *corners));
    field("count", "%" PRIu64, count);
    const vox_result result = vox_mesh_append_tets(grid, mesh, corners, count, &first);
    if (result == VOX_OK) field("first", "%u", first);
    finish(result);
}

/* ---- scenes ---- */

static const uint32_t all_flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;

/* Frames of a scene with all that a step gives, the last one at rest. */
static void frames(scene* s, const char* name, const char* what, double factor, vox_format format,
                   uint32_t rings) {
    vox_body ids[MOST_BODIES];
    vox_filter filter = VOX_ZERO;
    filter.flags = s->self_collision ? VOX_FILTER_SELF_COLLISION : 0;
    filter.self_rings = rings;
    s->name = name;
    if (factor != 1) scale_scene(s, factor);
    begin_scene(name, what, all_flags, 0);
    pose_scene(s, 0);
    for (uint32_t b = 0; b < s->count; ++b) ids[b] = insert(&s->bodies[b], format, &filter, 100 + b);
    step();
    for (int frame = 1; frame < 3; ++frame) {
        pose_scene(s, 40 * frame);
        for (uint32_t b = 0; b < s->count; ++b) move(ids[b], &s->bodies[b], format);
        step();
    }
    for (int m = VOX_DEPTH_METHOD_CLOSEST; m <= VOX_DEPTH_METHOD_NONE; ++m)
        find_constraints((vox_depth_method)m);
    query(&s->bodies[0]);
    step();
    end_scene();
    free_scene(s);
}

static void readme(void) {
    float first[12] = {5, 5, 5, 6, 5, 5, 5, 6, 5, 0.2f, 0.3f, 0.4f};
    float second[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    uint32_t tet[4] = {0, 1, 2, 3};
    const body bodies[2] = {{first, tet, 4, 1}, {second, tet, 4, 1}};
    begin_scene("readme", "the two tetrahedra of the README", VOX_GRID_CONSTRAINTS, 0);
    for (uint32_t b = 0; b < 2; ++b) insert(&bodies[b], VOX_FORMAT_FLOAT, NULL, b + 1);
    step();
    find_constraints(VOX_DEPTH_METHOD_CLOSEST);
    end_scene();
}

/* Bodies come, go and change what they collide with. */
static void life(void) {
    static scene s;
    vox_body ids[8];
    const double turned[12] = {0, -1, 0, 0.5, 1, 0, 0, 0.25, 0, 0, 1, 0};
    const double back[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    make_many(&s, 2, 2);
    pose_scene(&s, 0);
    begin_scene("life", "bodies come, go and change what they collide with", all_flags, 0.75);
    for (uint32_t b = 0; b < 8; ++b) ids[b] = insert(&s.bodies[b], VOX_FORMAT_FLOAT, NULL, 1000000007ull * b);
    step();
    remove_mesh(ids[2]);
    set_enabled(ids[5], 0);
    set_pair_enabled(ids[0], ids[1], 0);
    step();
    meshes();
    const vox_body again = insert(&s.bodies[2], VOX_FORMAT_DOUBLE, NULL, 0xfedcba9876543210u);
    set_enabled(ids[5], 1);
    transform(ids[6], turned);
    vox_filter filter = VOX_ZERO;
    filter.category = 2;
    filter.mask = ~(uint64_t)2;
    set_filter(ids[3], &filter);
    set_filter(ids[7], &filter);
    step();
    transform(ids[6], back);
    set_flags(0);
    step();
    set_flags(VOX_GRID_CONSTRAINTS);
    step();
    meshes();
    remove_mesh(again);
    clear();
    step();
    insert(&s.bodies[0], VOX_FORMAT_FLOAT, NULL, 5);
    insert(&s.bodies[1], VOX_FORMAT_FLOAT, NULL, 6);
    step();
    end_scene();
    free_scene(&s);
}

/* A cut through one of two balls, and a tetrahedron more. */
static void cutting(void) {
    enum { most = 2000 };
    static scene s;
    static uint32_t tets[most], copies[most], corners[4 * most], copy_of[most];
    uint32_t tet_count = 0, copy_count = 0;
    make_pair(&s, 4);
    pose_scene(&s, 0);
    const body* b = &s.bodies[0];
    begin_scene("cutting", "a ball is cut open and loses tetrahedra", all_flags, 0);
    const vox_body first = insert(b, VOX_FORMAT_FLOAT, NULL, 1);
    insert(&s.bodies[1], VOX_FORMAT_FLOAT, NULL, 2);
    step();
    /* Vertices on the cut are those of tetrahedra on both sides; the upper side gets copies. */
    static uint8_t below[most], above[most];
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        float middle = 0;
        for (int c = 0; c < 4; ++c) middle += b->positions[3 * b->tets[4 * t + (uint32_t)c] + 2];
        for (int c = 0; c < 4; ++c) (middle > 0 ? above : below)[b->tets[4 * t + (uint32_t)c]] = 1;
    }
    for (uint32_t v = 0; v < b->vertex_count; ++v)
        if (below[v] && above[v]) copy_of[v] = b->vertex_count + copy_count, copies[copy_count++] = v;
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        float middle = 0;
        int on_cut = 0;
        for (int c = 0; c < 4; ++c) middle += b->positions[3 * b->tets[4 * t + (uint32_t)c] + 2];
        for (int c = 0; c < 4; ++c) {
            const uint32_t v = b->tets[4 * t + (uint32_t)c];
            on_cut |= copy_of[v] != 0;
            corners[4 * tet_count + (uint32_t)c] = copy_of[v] ? copy_of[v] : v;
        }
        if (middle > 0 && on_cut) tets[tet_count++] = t;
    }
    append_copies(first, copies, copy_count);
    replace_tets(first, tets, tet_count, corners);
    step();
    switch_tets("set_tets_enabled", first, tets, 20, 0);
    step();
    switch_tets("remove_tets", first, tets, 10, 0);
    switch_tets("set_tets_enabled", first, tets + 10, 10, 1);
    append_tets(first, b->tets, 3);
    meshes();
    step();
    find_constraints(VOX_DEPTH_METHOD_CLOSEST);
    end_scene();
    free_scene(&s);
}

/* A snapshot, damaged and as it is; the loaded grid goes on. */
static void snapshot(void) {
    static scene s;
    void* bytes;
    uint64_t size;
    vox_body ids[2];
    make_pair(&s, 3);
    pose_scene(&s, 0);
    begin_scene("snapshot", "a grid is saved, and goes on from its bytes", all_flags, 0);
    for (uint32_t b = 0; b < 2; ++b) ids[b] = insert(&s.bodies[b], VOX_FORMAT_DOUBLE, NULL, 70 + b);
    step();
    const uint64_t offset = save(&bytes, &size);
    ((char*)bytes)[size / 2] ^= 0x40;
    load(bytes, size, store(bytes, size));
    ((char*)bytes)[size / 2] ^= 0x40;
    load(bytes, size - 9, offset);
    load(bytes, size, offset);
    meshes();
    step();
    pose_scene(&s, 90);
    for (uint32_t b = 0; b < 2; ++b) move(ids[b], &s.bodies[b], VOX_FORMAT_DOUBLE);
    step();
    query(&s.bodies[1]);
    free(bytes);
    end_scene();
    free_scene(&s);
}

/* What is refused, with its code and text; the grid works on after each. */
static void errors(void) {
    static scene s;
    double matrix[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    make_pair(&s, 3);
    pose_scene(&s, 0);
    begin_scene("errors", "what is refused, with its code and text", VOX_GRID_CONSTRAINTS, 0);
    const vox_body first = insert(&s.bodies[0], VOX_FORMAT_FLOAT, NULL, 11);
    const vox_body second = insert(&s.bodies[1], VOX_FORMAT_FLOAT, NULL, 12);
    step();
    const uint32_t tet = s.bodies[1].tets[70];
    s.bodies[1].tets[70] = s.bodies[1].vertex_count + 5;
    insert(&s.bodies[1], VOX_FORMAT_FLOAT, NULL, 13);
    s.bodies[1].tets[70] = tet;
    const uint32_t beyond[2] = {0, s.bodies[0].tet_count};
    switch_tets("remove_tets", first, beyond, 2, 0);
    set_flags(0x41);
    set_enabled(first, 2);
    set_pair_enabled(first, first, 0);
    vox_filter filter = VOX_ZERO;
    filter.self_rings = VOX_MAX_RINGS + 1;
    set_filter(second, &filter);
    matrix[7] = NAN;
    transform(second, matrix);
    remove_mesh(first + 1);
    const float good = s.bodies[1].positions[17];
    s.bodies[1].positions[17] = (float)NAN;
    move(second, &s.bodies[1], VOX_FORMAT_FLOAT);
    step();
    s.bodies[1].positions[17] = good;
    move(second, &s.bodies[1], VOX_FORMAT_FLOAT);
    step();
    remove_mesh(second);
    remove_mesh(second);
    set_enabled(second, 1);
    step();
    end_scene();
    free_scene(&s);
}

static void suggestions(void) {
    static scene s;
    begin_scene("suggestions", "the cell size for two balls, by each model", 0, 0);
    make_pair(&s, 4);
    pose_scene(&s, 0);
    suggest(&s, VOX_COST_MODEL_PAPER);
    suggest(&s, VOX_COST_MODEL_REFERENCE);
    suggest(&s, VOX_COST_MODEL_FAST);
    end_scene();
    free_scene(&s);
}

static vox_primitives primitives_of(const body* b, vox_primitive_type type) {
    vox_primitives p = vox_default_primitives();
    p.type = type;
    p.positions.data = b->positions;
    p.positions.count = b->vertex_count;
    p.count = b->vertex_count;
    if (type == VOX_PRIMITIVE_TET) {
        p.indices = b->tets;
        p.count = b->tet_count;
    }
    return p;
}

/* The cell size for grids that are not this library's, and what is refused there. */
static void foreign_grids(void) {
    enum { grids = 4 };
    static const vox_known_grid known[grids] = {VOX_KNOWN_GRID_SORTED, VOX_KNOWN_GRID_WARP,
                                                VOX_KNOWN_GRID_IPC_PAIRS, VOX_KNOWN_GRID_NONE};
    static scene s;
    vox_timing timings[4] = {{1.5, 7.25e-5}, {3, 5.04e-5}, {6, 9.98e-5}, {12, 2.51e-4}};
    double radii[16];
    begin_scene("foreign grids",
                "the cell size for grids of other programs, by description, timings and runs", 0, 0);
    make_pair(&s, 3);
    pose_scene(&s, 0);
    body* first = &s.bodies[0];
    vox_primitives tets = primitives_of(first, VOX_PRIMITIVE_TET);
    vox_primitives points = primitives_of(&s.bodies[1], VOX_PRIMITIVE_POINT);
    vox_foreign_grid g = vox_default_foreign_grid();
    g.stored = &tets;
    g.querying = &points;
    g.known = VOX_KNOWN_GRID_HASHED;
    const vox_foreign_weights weights = {100, 20, 9, 5, 3, 40, 0};
    g.weights = weights;
    foreign_suggest(&g);
    foreign_count(&g, 0.75);
    foreign_count(&g, 3);
    foreign_fit(&g, timings, 4);
    timings[2].seconds *= 3;
    foreign_fit(&g, timings, 4);
    g.cells_kept = VOX_CELLS_KEPT_DENSE;
    g.weights.cell = 0.5;
    foreign_suggest(&g);
    for (int i = 0; i < grids; ++i) {
        g.radius = 0.25 * i;
        g.querying = i == 2 ? NULL : &points;
        g.known = known[i];
        foreign_suggest(&g);
    }
    /* Points with radii, in doubles, from 27 cells. */
    double* doubles = as_doubles(&s.bodies[1]);
    points.positions.data = doubles;
    points.positions.format = VOX_FORMAT_DOUBLE;
    points.count = points.positions.count = 16;
    for (int i = 0; i < 16; ++i) radii[i] = 0.125 * (i % 3);
    points.radii = radii;
    points.radius_format = VOX_FORMAT_DOUBLE;
    points.radius = 0.5;
    g = vox_default_foreign_grid();
    g.stored = &points;
    g.known = VOX_KNOWN_GRID_PBAT;
    foreign_suggest(&g);

    g.stored = &tets;
    g.known = VOX_KNOWN_GRID_HASHED;
    g.weights = weights;
    const made_up_run run = {1e-3, 2e-3, 1e-3, 0, 0, 0};
    made_up_run other = run;
    foreign_tune(NULL, 0.5, 7, run);
    foreign_tune(&g, 0, 7, run);
    other.fails_below = 0.75;
    foreign_tune(NULL, 1, 9, other);
    other.fails_below = 0;
    other.stops_after = 3;
    foreign_tune(NULL, 1, 9, other);

    /* What is refused. */
    other.stops_after = 0;
    other.fails_below = 1e30;
    foreign_tune(NULL, 1, 7, other);
    foreign_tune(NULL, 0, 7, run);
    foreign_tune(NULL, 1, 2, run);
    other.fails_below = other.fixed = other.falls = other.grows = 0;
    foreign_tune(NULL, 1, 7, other);
    foreign_fit(&g, timings, 2);
    timings[1].seconds = 0;
    foreign_fit(&g, timings, 3);
    foreign_count(&g, 0);
    g.radius = -1;
    foreign_suggest(&g);
    g.radius = 0;
    g.cells_queried = VOX_CELLS_QUERIED_27;
    foreign_suggest(&g);
    g.cells_queried = VOX_CELLS_QUERIED_BOX;
    g.zone_loss = -0.5;
    foreign_suggest(&g);
    g.zone_loss = 0.05;
    const uint32_t corner = first->tets[70];
    first->tets[70] = first->vertex_count;
    foreign_suggest(&g);
    first->tets[70] = corner;
    radii[7] = -2;
    g.stored = &points;
    foreign_suggest(&g);
    radii[7] = 0;
    doubles[10] = NAN;
    foreign_suggest(&g);
    free(doubles);
    end_scene();
    free_scene(&s);
}

static FILE* create(const char* folder, const char* name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE* file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "write_vectors: %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    return file;
}

int main(int argc, char** argv) {
    static scene s;
    if (argc != 2) {
        fprintf(stderr, "usage: write_vectors FOLDER\n");
        return 2;
    }
    script = create(argv[1], "vectors.json");
    arrays = create(argv[1], "vectors.bin");
    fprintf(script, "{\"abi\": %u, \"scenes\": [", vox_abi_version());
    readme();
    make_pair(&s, 4), frames(&s, "pair", "two balls that overlap", 1, VOX_FORMAT_FLOAT, 0);
    make_pair(&s, 3), frames(&s, "doubles", "two balls of doubles", 1, VOX_FORMAT_DOUBLE, 0);
    make_ring(&s, 6),
        frames(&s, "ring", "a ring through itself, without near neighbours", 1, VOX_FORMAT_FLOAT, 1);
    make_tangled(&s, 3),
        frames(&s, "tangled", "a ball of which hardly a tetrahedron is where it was", 1, VOX_FORMAT_FLOAT, 0);
    make_soup(&s, 40, 60),
        frames(&s, "soup", "flat, inverted, coincident tetrahedra", 1, VOX_FORMAT_FLOAT, 0);
    make_pair(&s, 3), frames(&s, "least", "positions that are denormal floats", 1e-41, VOX_FORMAT_FLOAT, 0);
    make_pair(&s, 3), frames(&s, "huge", "positions whose volumes are no floats", 1e30, VOX_FORMAT_FLOAT, 0);
    life();
    cutting();
    snapshot();
    errors();
    suggestions();
    foreign_grids();
    fprintf(script, "]}\n");
    const int failed = ferror(script) | ferror(arrays);
    return (fclose(script) | fclose(arrays) | failed) ? EXIT_FAILURE : EXIT_SUCCESS;
}
