/* The main of a program of suites: runs those that its arguments name, or all of them. CMake writes the file
 * that includes this, with the names of the program's suites in EACH_SUITE(X), from the list by which it
 * compiles them (vox_suites in tests/CMakeLists.txt). */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct named_suite {
    const char* name;
    void (*fill)(Suite*);
} named_suite;

#define DECLARE(name) void suite_##name(Suite*);
EACH_SUITE(DECLARE)
#define NAMED(name) {#name, suite_##name},
static const named_suite suites[] = {EACH_SUITE(NAMED)};
enum { suite_count = sizeof suites / sizeof *suites };

static void add_suite(SRunner* runner, const named_suite* named) {
    Suite* suite = suite_create(named->name);
    named->fill(suite);
    srunner_add_suite(runner, suite);
}

int main(int argc, char** argv) {
    SRunner* runner = srunner_create(NULL);
    for (int i = 0; argc == 1 && i < suite_count; ++i) add_suite(runner, &suites[i]);
    for (int a = 1; a < argc; ++a) {
        int i = 0;
        while (i < suite_count && strcmp(suites[i].name, argv[a]) != 0) ++i;
        if (i == suite_count) {
            fprintf(stderr, "there is no suite %s; there are:", argv[a]);
            for (i = 0; i < suite_count; ++i) fprintf(stderr, " %s", suites[i].name);
            fprintf(stderr, "\n");
            return EXIT_FAILURE;
        }
        add_suite(runner, &suites[i]);
    }
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
    srunner_free(runner);
    if (run == 0) return 77; /* to ctest: skipped */
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
