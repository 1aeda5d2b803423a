// The built-in scheduler allocates nothing in the steady state, and does without threads where they cannot be
// had for lack of memory.
#include "base/clock.hpp"
#include "base/scheduler.hpp"
#include "internal/scheduler_work.hpp"
#include "support/failing_heap.hpp"
#include "support/suite.h"

#include <utility>

using namespace vox;

namespace {

#if defined(VOX_SCHEDULER_THREADS)

START_TEST(no_allocation_once_there_are_threads) {
    Scheduler scheduler(4);
    Work work(5000, 4);
    heap::calls = 0;
    scheduler.run(&Work::task, 5000, 3, &work);
    ck_assert_uint_gt(heap::calls, 0); // the threads
    heap::calls = 0;
    for (int times = 0; times < 200; ++times) scheduler.run(&Work::task, 5000, 3, &work);
    ck_assert_uint_eq(heap::calls, 0);
    ck_assert_int_eq(work.wrong, 0);
}
END_TEST

#if !defined(_WIN32)
START_TEST(no_allocation_from_call_to_call) {
    Work work(5000, 4);
    for (int times = 0; times < 100; ++times) {
        if (times == 1) heap::calls = 0;
        auto scheduler = Scheduler::of_last_call(4);
        scheduler->run(&Work::task, 5000, 3, &work);
        Scheduler::leave(std::move(scheduler));
    }
    ck_assert_uint_eq(heap::calls, 0);
    ck_assert_int_eq(work.wrong, 0);
}
END_TEST
#endif

START_TEST(no_memory_for_threads) {
    for (std::uint64_t fails = 1; fails <= 6; ++fails) {
        Scheduler scheduler(5);
        Work work(1000, 5);
        heap::fail_on = true;
        heap::calls = 0;
        heap::fail_at = fails;
        scheduler.run(&Work::task, 1000, 1, &work);
        heap::fail_at = 0;
        heap::fail_on = false;
        ck_assert(work.each_once());
        run_once(scheduler, 5, 1000, 1);
    }
}
END_TEST

#endif

} // namespace

SUITE(scheduler_memory) {
    TCase* tests = add_case(suite, "memory");
#if defined(VOX_SCHEDULER_THREADS)
    tcase_add_test(tests, no_allocation_once_there_are_threads);
    tcase_add_test(tests, no_memory_for_threads);
#if !defined(_WIN32)
    tcase_add_test(tests, no_allocation_from_call_to_call);
#endif
#else
    (void)tests;
#endif
}
