/* Positions in columns, or with room between their numbers: everything is bit for bit what it is for the same
 * positions one after the other. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/locators.h"

enum { most = 3 };

/* Coordinate c of position v is at byte offset + v * stride + c * component. All 0: one after the other. */
typedef struct layout {
    const char* name;
    vox_format format;
    uint64_t stride, component; /* as told to the library; 0: as it says */
    int padding;                /* numbers between two columns, and bytes before the first */
} layout;

static const layout layouts[] = {{"columns", VOX_FORMAT_FLOAT, 0, 1, 0},
                                 {"columns", VOX_FORMAT_DOUBLE, 0, 1, 0},
                                 {"columns further apart, not aligned", VOX_FORMAT_FLOAT, 4, 1, 5},
                                 {"columns further apart, not aligned", VOX_FORMAT_DOUBLE, 8, 1, 3},
                                 {"columns with gaps", VOX_FORMAT_FLOAT, 12, 1, 1},
                                 {"columns with gaps", VOX_FORMAT_DOUBLE, 40, 1, 0},
                                 {"rows with gaps", VOX_FORMAT_FLOAT, 36, 8, 0},
                                 {"rows with gaps", VOX_FORMAT_DOUBLE, 64, 16, 0},
                                 {"rows, said in full", VOX_FORMAT_FLOAT, 12, 4, 0},
                                 {"rows, said in full", VOX_FORMAT_DOUBLE, 0, 8, 0}};
enum { layout_count = sizeof layouts / sizeof *layouts };

/* An array of some positions in a layout; `component` 1 stands for columns. */
typedef struct laid_out {
    unsigned char* memory;
    unsigned char* data;
    vox_format format;
    uint64_t stride, component;           /* to be told to the library */
    uint64_t real_stride, real_component; /* in bytes */
} laid_out;

static void write_position(const laid_out* a, uint32_t v, const float position[3]) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
        unsigned char* to = a->data + v * a->real_stride + axis * a->real_component;
        const double d = (double)position[axis];
        if (a->format == VOX_FORMAT_DOUBLE)
            memcpy(to, &d, sizeof d);
        else
            memcpy(to, &position[axis], sizeof(float));
    }
}

static laid_out lay_out(const layout* l, const float* positions, uint32_t count) {
    const uint64_t number = l->format == VOX_FORMAT_DOUBLE ? 8 : 4;
    const uint64_t padding = (uint64_t)l->padding;
    laid_out a = {NULL, NULL, l->format, l->stride, l->component, 0, 0};
    const int columns = l->component == 1;
    a.real_stride = l->stride ? l->stride : columns ? number : 3 * number;
    if (columns) a.component = (count + padding) * a.real_stride;
    a.real_component = a.component ? a.component : number;
    const uint64_t size = count * a.real_stride + 2 * a.real_component + number + padding;
    a.memory = (unsigned char*)malloc(size);
    memset(a.memory, 0xff, size); /* NaN between the numbers */
    a.data = a.memory + padding;
    for (uint32_t v = 0; v < count; ++v) write_position(&a, v, positions + 3 * v);
    return a;
}

/* The positions one after the other. */
static laid_out pack(vox_format format, const float* positions, uint32_t count) {
    const layout packed = {"packed", format, 0, 0, 0};
    return lay_out(&packed, positions, count);
}

static vox_positions positions_at(const laid_out* a, uint32_t count) {
    const vox_positions positions = {a->data, count, a->format, 0, a->stride, a->component};
    return positions;
}

static vox_mesh_desc laid_out_desc(const body* b, const laid_out* a) {
    vox_mesh_desc desc = body_desc(b);
    desc.positions = positions_at(a, b->vertex_count);
    return desc;
}

/* Two grids with the same bodies; those of `packed` have the usual layout. */
typedef struct scene {
    body bodies[most];
    laid_out packed_arrays[most], arrays[most];
    vox_grid *packed, *grid;
    vox_body packed_ids[most], ids[most];
} scene;

static scene new_scene(const layout* l, uint32_t mesh_flags) {
    scene s;
    vox_grid_desc grid_desc = engine_desc();
    grid_desc.flags = VOX_GRID_CONSTRAINTS;
    s.packed = grid_of(&grid_desc);
    s.grid = grid_of(&grid_desc);
    for (int b = 0; b < most; ++b) {
        body* box = &s.bodies[b];
        *box = make_box(4, 0.37f, 0.9f * (float)b, 0.1f * (float)b, 0.07f * (float)b);
        if (b == 2) /* folded through itself */
            for (uint32_t v = 0; v < box->vertex_count; ++v) {
                float* p = box->positions + 3 * v;
                if (p[0] > 2.5f) p[0] = 5 - 0.9f * p[0] + 0.1f * p[1];
            }
        s.packed_arrays[b] = pack(l->format, box->positions, box->vertex_count);
        s.arrays[b] = lay_out(l, box->positions, box->vertex_count);
        vox_mesh_desc usual = laid_out_desc(box, &s.packed_arrays[b]);
        vox_mesh_desc desc = laid_out_desc(box, &s.arrays[b]);
        if (b == 2) usual.filter.flags = desc.filter.flags = VOX_FILTER_SELF_COLLISION;
        desc.flags |= mesh_flags;
        s.packed_ids[b] = insert_mesh(s.packed, &usual);
        s.ids[b] = insert_mesh(s.grid, &desc);
    }
    return s;
}

static void free_scene(scene* s) {
    vox_grid_destroy(s->packed);
    vox_grid_destroy(s->grid);
    for (int b = 0; b < most; ++b) {
        free_body(&s->bodies[b]);
        free(s->packed_arrays[b].memory);
        free(s->arrays[b].memory);
    }
}

static void move(scene* s, int b, float by) {
    for (uint32_t v = 0; v < s->bodies[b].vertex_count; ++v) {
        float* p = s->bodies[b].positions + 3 * v;
        p[0] += by;
        write_position(&s->packed_arrays[b], v, p);
        write_position(&s->arrays[b], v, p);
    }
}

#define same_view(get)                                                                                       \
    do {                                                                                                     \
        ck_assert_uint_gt(get(s->packed).count, 20);                                                         \
        ck_assert_uint_eq(get(s->packed).count, get(s->grid).count);                                         \
        ck_assert_mem_eq(get(s->packed).data, get(s->grid).data,                                             \
                         get(s->grid).count * sizeof *get(s->grid).data);                                    \
    } while (0)

static void same_results(const scene* s) {
    same_view(contacts_of);
    same_view(constraints_of);
}

static void step_both(const scene* s) {
    ck_ok(vox_grid_step(s->packed));
    ck_ok(vox_grid_step(s->grid));
    same_results(s);
}

static void same_answers(const scene* s) {
    const double from[3] = {-1, 0.7, 0.6}, to[3] = {5, 0.9, 0.8};
    const vox_positions begin = vox_double_positions(from, 1), end = vox_double_positions(to, 1);
    vox_ray_hit hits[2];
    vox_closest_hit closest[2];
    vox_cell_size_result suggested[2];
    vox_grid* const grids[2] = {s->packed, s->grid};
    vox_constraint_desc by_closest = vox_default_constraint_desc();
    by_closest.method = VOX_DEPTH_METHOD_CLOSEST;
    memset(suggested, 0, sizeof suggested);
    for (int g = 0; g < 2; ++g) {
        uint64_t count = 0;
        vox_locator* locator = take_locator(grids[g]);
        ck_ok(vox_locator_find_ray_hits(locator, &begin, &end, NULL, &hits[g], 1, &count));
        ck_assert_uint_gt(count, 0);
        closest[g] = closest_to(locator, from, NULL);
        vox_locator_release(locator);
        suggested[g].struct_size = sizeof suggested[g];
        ck_ok(vox_grid_suggest_cell_size(grids[g], NULL, &suggested[g]));
        ck_ok(vox_grid_find_constraints(grids[g], &by_closest));
    }
    ck_assert_mem_eq(&hits[0], &hits[1], sizeof hits[0]);
    ck_assert_mem_eq(&closest[0], &closest[1], sizeof closest[0]);
    ck_assert_double_eq(suggested[0].rules[0].cell_size, suggested[1].rules[0].cell_size);
    ck_assert_double_eq_tol(suggested[0].cells_per_axis * suggested[0].cell_size,
                            suggested[1].cells_per_axis * suggested[1].cell_size, 1e-12);
    ck_assert_double_eq_tol(suggested[0].cell_size, suggested[1].cell_size, 0.05 * suggested[0].cell_size);
    same_view(constraints_of);
}

START_TEST(same_as_packed) {
    const layout* l = &layouts[_i];
    scene s = new_scene(l, 0);
    const double turn[12] = {0.8, -0.6, 0, 0.1, 0.6, 0.8, 0, -0.3, 0, 0, 1, 0.2};
    for (int step = 0; step < 9; ++step) { /* moving, at rest, turned */
        if (step < 2) move(&s, 1, 0.05f);
        if (step == 5) ck_ok(vox_body_set_transform(s.packed, s.packed_ids[0], turn));
        if (step == 5) ck_ok(vox_body_set_transform(s.grid, s.ids[0], turn));
        if (step == 6) move(&s, 2, -0.125f);
        step_both(&s);
        if (step % 3 == 0) same_answers(&s);
    }
    ck_assert_uint_eq(counters_of(s.grid).moved_bodies, suite_engine == ENGINE_FAST ? 0 : most);
    free_scene(&s);
}
END_TEST

/* What is made from columns: a copy, a mapped copy, a snapshot. */
START_TEST(copied) {
    const layout* l = &layouts[_i];
    scene s = new_scene(l, VOX_MESH_COPY_POSITIONS);
    for (int b = 0; b < most; ++b) memset(s.arrays[b].data, 0xff, 3 * (size_t)s.bodies[b].vertex_count);
    step_both(&s);
    uint64_t sizes[2];
    ck_ok(vox_grid_save(s.packed, NULL, 0, &sizes[0]));
    ck_ok(vox_grid_save(s.grid, NULL, 0, &sizes[1]));
    ck_assert_uint_eq(sizes[0], sizes[1]);
    unsigned char* saved[2] = {(unsigned char*)malloc(sizes[0]), (unsigned char*)malloc(sizes[1])};
    ck_ok(vox_grid_save(s.packed, saved[0], sizes[0], &sizes[0]));
    ck_ok(vox_grid_save(s.grid, saved[1], sizes[1], &sizes[1]));
    ck_assert_mem_eq(saved[0], saved[1], sizes[0]);
    free_scene(&s);
    /* Borrowed ones are saved as they are. */
    s = new_scene(l, 0);
    step_both(&s);
    ck_ok(vox_grid_save(s.grid, saved[1], sizes[1], &sizes[1]));
    ck_assert_mem_eq(saved[0], saved[1], sizes[0]);
    void* mapped = NULL;
    ck_ok(vox_mesh_map_positions(s.grid, s.ids[1], &mapped));
    ck_assert_mem_eq(mapped, s.packed_arrays[1].data,
                     (l->format == VOX_FORMAT_FLOAT ? 12 : 24) * (size_t)s.bodies[1].vertex_count);
    step_both(&s);
    /* And bound again. */
    ck_ok(bind_array(s.grid, s.ids[1], s.arrays[1].data, s.arrays[1].format, s.arrays[1].stride,
                     s.arrays[1].component));
    move(&s, 1, 0.0625f);
    step_both(&s);
    free_scene(&s);
    free(saved[0]);
    free(saved[1]);
}
END_TEST

/* Rest poses and vertices that are appended. */
START_TEST(rest_poses_and_growth) {
    const layout* l = &layouts[_i];
    scene s = new_scene(l, 0);
    for (int grows_own = 0; grows_own < 2; ++grows_own) {
        body rest = make_box(4, 0.37f, 1.8f, 0.2f, 0.14f);
        laid_out packed_rest = pack(l->format, rest.positions, rest.vertex_count);
        laid_out laid_rest = lay_out(l, rest.positions, rest.vertex_count);
        vox_filter filter = plain_filter();
        filter.flags = VOX_FILTER_SELF_COLLISION;
        filter.self_rest_distance = 1;
        vox_mesh_desc usual = laid_out_desc(&s.bodies[2], &s.packed_arrays[2]);
        vox_mesh_desc desc = laid_out_desc(&s.bodies[2], &s.arrays[2]);
        usual.rest_positions = positions_at(&packed_rest, rest.vertex_count);
        desc.rest_positions = positions_at(&laid_rest, rest.vertex_count);
        usual.filter = desc.filter = filter;
        usual.flags = desc.flags = grows_own ? VOX_MESH_COPY_POSITIONS : 0;
        ck_ok(vox_mesh_set_topology(s.packed, s.packed_ids[2], &usual));
        ck_ok(vox_mesh_set_topology(s.grid, s.ids[2], &desc));
        ck_ok(vox_body_set_filter(s.packed, s.packed_ids[2], &filter));
        ck_ok(vox_body_set_filter(s.grid, s.ids[2], &filter));
        step_both(&s);
        ck_assert_uint_gt(counters_of(s.grid).filtered, 0);

        /* Three vertices more, in the first body: all positions where they are borrowed, else the new ones.
         */
        const uint32_t before = s.bodies[2].vertex_count, first_new = grows_own ? 0 : before,
                       count = first_new + 3;
        float* grown = (float*)malloc(3 * sizeof(float) * count);
        for (uint32_t v = 0; v < count; ++v)
            for (uint32_t axis = 0; axis < 3; ++axis)
                grown[3 * v + axis] = v < first_new
                                          ? s.bodies[2].positions[3 * v + axis]
                                          : 0.3f + 0.1f * (float)axis + 0.05f * (float)(v - first_new);
        const float* new_rest = grown + 3 * first_new;
        laid_out packed_grown = pack(l->format, grown, count), laid_grown = lay_out(l, grown, count);
        laid_out packed_new_rest = pack(l->format, new_rest, 3), laid_new_rest = lay_out(l, new_rest, 3);
        vox_vertices_desc vertices = vox_default_vertices_desc();
        uint32_t first = 0;
        vertices.count = 3;
        vertices.positions = positions_at(&packed_grown, grows_own ? 3 : count);
        vertices.rest_positions = positions_at(&packed_new_rest, 3);
        ck_ok(vox_mesh_append_vertices(s.packed, s.packed_ids[2], &vertices, &first));
        vertices.positions = positions_at(&laid_grown, grows_own ? 3 : count);
        vertices.rest_positions = positions_at(&laid_new_rest, 3);
        ck_ok(vox_mesh_append_vertices(s.grid, s.ids[2], &vertices, &first));
        ck_assert_uint_eq(first, before);
        step_both(&s);
        free(packed_rest.memory);
        free(laid_rest.memory);
        if (grows_own == 0) { /* back to the borrowed arrays before these end */
            const vox_mesh_desc empty = vox_default_mesh_desc();
            ck_ok(vox_mesh_set_topology(s.packed, s.packed_ids[2], &empty));
            ck_ok(vox_mesh_set_topology(s.grid, s.ids[2], &empty));
        }
        free(packed_grown.memory);
        free(packed_new_rest.memory);
        free(laid_grown.memory);
        free(laid_new_rest.memory);
        free(grown);
        free_body(&rest);
    }
    free_scene(&s);
}
END_TEST

START_TEST(suggested_and_asked) {
    const layout* l = &layouts[_i];
    body box = make_box(4, 0.37f, 0, 0, 0);
    laid_out array = lay_out(l, box.positions, box.vertex_count);
    const vox_mesh_desc usual = body_desc(&box), desc = laid_out_desc(&box, &array);
    vox_cell_size_result suggested[2];
    memset(suggested, 0, sizeof suggested);
    suggested[0].struct_size = suggested[1].struct_size = sizeof suggested[0];
    ck_ok(vox_suggest_cell_size(NULL, &usual, 1, &suggested[0]));
    ck_ok(vox_suggest_cell_size(NULL, &desc, 1, &suggested[1]));
    ck_assert_double_eq(suggested[0].cell_size, suggested[1].cell_size);
    vox_geometry measured[2];
    memset(measured, 0, sizeof measured);
    measured[0].struct_size = measured[1].struct_size = sizeof measured[0];
    ck_ok(vox_measure_geometry(&usual, 1, &measured[0]));
    ck_ok(vox_measure_geometry(&desc, 1, &measured[1]));
    ck_assert_mem_eq(&measured[0], &measured[1], sizeof measured[0]);

    vox_grid* grid = engine_grid();
    (void)insert_mesh(grid, &usual);
    vox_locator* locator = take_locator(grid);
    vox_closest_hit* hits[2];
    for (int i = 0; i < 2; ++i) {
        const vox_positions asked = i ? desc.positions : usual.positions;
        hits[i] = (vox_closest_hit*)calloc(box.vertex_count, sizeof *hits[i]);
        ck_ok(vox_locator_find_closest(locator, &asked, NULL, hits[i]));
    }
    ck_assert_mem_eq(hits[0], hits[1], box.vertex_count * sizeof *hits[0]);
    free(hits[0]);
    free(hits[1]);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    free(array.memory);
    free_body(&box);
}
END_TEST

/* A mesh that begins without vertices and owns those that it gets: they are packed, whatever was said of
 * none. */
START_TEST(columns_of_nothing) {
    for (int maps = 0; maps < 2; ++maps) {
        body box = make_box(2, 0.5f, 0, 0, 0);
        vox_mesh_desc desc = vox_mesh_desc_floats(box.positions, 0, NULL, 0);
        desc.positions.component_byte_stride = 4000;
        desc.flags = maps ? 0 : VOX_MESH_COPY_POSITIONS;
        vox_grid* grid = engine_grid();
        const vox_body grown = insert_mesh(grid, &desc);
        void* memory;
        if (maps) ck_ok(vox_mesh_map_positions(grid, grown, &memory));
        vox_vertices_desc vertices = vox_default_vertices_desc();
        uint32_t first;
        vertices.count = box.vertex_count;
        vertices.positions = vox_float_positions(box.positions, box.vertex_count);
        ck_ok(vox_mesh_append_vertices(grid, grown, &vertices, &first));
        ck_ok(vox_mesh_append_tets(grid, grown, box.tets, box.tet_count, &first));
        const vox_mesh_desc usual = body_desc(&box);
        (void)insert_mesh(grid, &usual);
        ck_ok(vox_grid_step(grid));
        vox_contact_view contacts;
        ck_ok(vox_grid_get_contacts(grid, &contacts));
        ck_assert_uint_eq(contacts.count, 2 * (uint64_t)box.vertex_count); /* each in the other */
        vox_grid_destroy(grid);
        free_body(&box);
    }
}
END_TEST

START_TEST(strides_that_are_refused) {
    static const struct {
        vox_format format;
        uint64_t stride, component, count;
        const char* words;
    } bad[] = {{VOX_FORMAT_FLOAT, 0, 396, 100, "overlap; columns need at least 400"},
               {VOX_FORMAT_FLOAT, 0, 1, 100, "component_byte_stride is 1"},
               {VOX_FORMAT_DOUBLE, 0, 4, 100, "component_byte_stride is 4"},
               {VOX_FORMAT_DOUBLE, 16, 16, 100, "overlap"},
               {VOX_FORMAT_DOUBLE, 4, 800, 100, "is 4, expected 0 or at least 8"},
               {VOX_FORMAT_DOUBLE, 0, 1ull << 62, 100, "too large"},
               {VOX_FORMAT_DOUBLE, 1ull << 57, 0, 100, "too large"},
               {VOX_FORMAT_DOUBLE, 0, UINT64_MAX, 1, "too large"},
               {VOX_FORMAT_FLOAT, 8, 0, 100, "is 8, expected 0 or at least 12"}};
    double memory[300] = {0};
    vox_grid* grid = grid_of(NULL);
    vox_mesh_desc desc = vox_mesh_desc_doubles(memory, 100, NULL, 0);
    vox_body mesh = insert_mesh(grid, &desc), out = VOX_NULL_BODY;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        desc = vox_default_mesh_desc();
        desc.positions.count = bad[i].count;
        desc.positions.data = memory;
        desc.positions.format = bad[i].format;
        desc.positions.byte_stride = bad[i].stride;
        desc.positions.component_byte_stride = bad[i].component;
        ck_fails(vox_mesh_insert(grid, &desc, &out), VOX_ERROR_INVALID_ARGUMENT, bad[i].words);
        desc.positions.byte_stride = desc.positions.component_byte_stride = 0;
        desc.rest_positions = desc.positions;
        desc.rest_positions.byte_stride = bad[i].stride;
        desc.rest_positions.component_byte_stride = bad[i].component;
        ck_fails(vox_mesh_insert(grid, &desc, &out), VOX_ERROR_INVALID_ARGUMENT, bad[i].words);
        if (bad[i].count == 100)
            ck_fails(bind_array(grid, mesh, memory, bad[i].format, bad[i].stride, bad[i].component),
                     VOX_ERROR_INVALID_ARGUMENT, bad[i].words);
    }
    ck_assert_uint_eq(out, VOX_NULL_BODY);
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_loop_test(tests, same_as_packed, 0, layout_count);
    tcase_add_loop_test(tests, copied, 0, layout_count);
    tcase_add_loop_test(tests, rest_poses_and_growth, 0, layout_count);
    tcase_add_test(tests, columns_of_nothing);
}

SUITE(columns) {
    add_for_each_engine(suite, add_tests);
    TCase* tests = add_case(suite, "both engines, or none");
    tcase_add_loop_test(tests, suggested_and_asked, 0, layout_count);
    tcase_add_test(tests, strides_that_are_refused);
}
