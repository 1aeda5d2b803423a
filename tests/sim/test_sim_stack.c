/* A stack of ten: bodies of 900 tets that come to rest, or those of docs/sim.md for longer where the
 * environment asks for volume (VOX_TEST_VOLUME). */
#include "sim/stack.h"

START_TEST(ten_bodies_rest_stacked) {
    if (test_volume() > 1)
        rests_stacked(10, 0.143, 1000);
    else
        rests_stacked(10, 0.25, 120);
}
END_TEST

SUITE(sim_stack) { tcase_add_test(add_case(suite, "motion"), ten_bodies_rest_stacked); }
