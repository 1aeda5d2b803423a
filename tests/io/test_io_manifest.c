/* Every malformed, hostile or merely odd file of the test meshes gives what their manifest says. */
#include "support/io_files.h"

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&                 \
    !defined(__has_feature)
#include <sys/resource.h>
#define LIMIT_MEMORY 1
#endif

#define FOLDER VOX_MESHES "/bad"

static int split(char* line, char* fields[], int most) {
    int count = 0;
    line[strcspn(line, "\r\n")] = 0;
    for (char* field = line; field && count < most; ++count) {
        fields[count] = field;
        field = strchr(field, '\t');
        if (field) *field++ = 0;
    }
    return count;
}

/* `allowed` is "-" (anything), a number, or "A or B". */
static int allows(const char* allowed, double value) {
    if (strcmp(allowed, "-") == 0) return 1;
    for (const char* part = allowed; part; part = strstr(part, "or ")) {
        if (strncmp(part, "or ", 3) == 0) part += 3;
        if (close_to(strtod(part, NULL), value, 1e-9)) return 1;
    }
    return 0;
}

/* The same from memory; a TetGen pair of which a file is missing cannot be given. */
static vox_result read_from_memory(const char* name, vox_io_mesh** out) {
    char* partner = is_tetgen(name) ? partner_of(name) : NULL;
    const bytes first = read_file(FOLDER, name);
    const bytes second = partner ? read_file(FOLDER, partner) : first;
    const vox_io_source sources[2] = {{name, first.data, first.size}, {partner, second.data, second.size}};
    const vox_result result =
        first.data && second.data ? vox_io_read(sources, partner ? 2 : 1, NULL, out) : VOX_ERROR_FILE;
    free(first.data);
    if (partner) free(second.data);
    free(partner);
    return result;
}

static void check_row(const char* name, const char* must, const char* vertices, const char* tets,
                      const char* volume) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", FOLDER, name);
    vox_io_mesh *mesh = NULL, *again = NULL;
    const vox_result result = vox_io_load(path, NULL, &mesh);
    ck_assert_msg(read_from_memory(name, &again) == result, "%s: another result from memory", name);
    if (result != VOX_OK) {
        ck_assert_msg(strstr(must, "error") != NULL, "%s must load: %s", name, vox_last_error());
        ck_assert(result == VOX_ERROR_FILE || result == VOX_ERROR_FORMAT || result == VOX_ERROR_UNSUPPORTED ||
                  result == VOX_ERROR_LIMIT);
        ck_assert(!mesh && !again);
        /* The text names the file (of a pair: either), and says more than that. */
        const char* dot = strrchr(name, '.');
        char stem[256];
        snprintf(stem, sizeof stem, "%.*s", (int)(dot ? dot - name : (long)strlen(name)), name);
        const char* found = strstr(vox_last_error(), stem);
        ck_assert_msg(found != NULL, "%s is not named: %s", name, vox_last_error());
        ck_assert_msg(strlen(found) > strlen(name) + 10, "%s: no reason: %s", name, vox_last_error());
        return;
    }
    check_sound(mesh);
    check_same(mesh, again);
    const vox_io_report report = report_of(mesh);
    const char* warnings = vox_io_mesh_get_warnings(mesh);
    ck_assert_msg(strcmp(must, "error") != 0, "%s must be refused, but gives %llu tets", name,
                  (unsigned long long)report.tets);
    const double read = (double)report.vertices, left_out = (double)report.left_out_vertices;
    ck_assert_msg(allows(vertices, read) || allows(vertices, read + left_out), "%s: %g vertices, %g left out",
                  name, read, left_out);
    ck_assert_msg(allows(tets, (double)report.tets), "%s: %llu tets", name, (unsigned long long)report.tets);
    ck_assert_msg(allows(volume, report.volume), "%s: volume %.17g", name, report.volume);
    if (strstr(must, "warn") && !strstr(must, "ok")) ck_assert_msg(*warnings != 0, "%s: nothing said", name);
    if (!strstr(must, "warn")) /* a word on elements that were left out is no warning */
        for (const char* line = warnings; *line; line = strchr(line, '\n') + 1)
            ck_assert_msg(strstr(line, "left out") != NULL, "%s: %s", name, warnings);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(again);
}

START_TEST(manifest) {
#if LIMIT_MEMORY
    const struct rlimit limit = {1u << 29, 1u << 29};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &limit), 0);
#endif
    const bytes list = read_file(FOLDER, "MANIFEST.tsv");
    ck_assert_ptr_nonnull(list.data);
    int rows = 0;
    for (char* line = (char*)list.data; line;) {
        char* next = strchr(line, '\n');
        if (next) *next++ = 0;
        char* fields[7];
        if (*line && *line != '#') {
            ck_assert_int_eq(split(line, fields, 7), 7);
            check_row(fields[0], fields[2], fields[3], fields[4], fields[5]);
            ++rows;
        }
        line = next;
    }
    ck_assert_int_gt(rows, 130);
    free(list.data);
}
END_TEST

SUITE(io_manifest) {
    if (!have_meshes(VOX_MESHES "/bad/MANIFEST.tsv")) return;
    TCase* tests = add_case(suite, "bad");
    tcase_add_test(tests, manifest);
}
