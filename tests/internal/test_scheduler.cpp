// The built-in scheduler: every item once, threads that are made once, kept and joined, no allocation in the
// steady state, and what it does where there are no threads to be had and after a fork.
#include "base/clock.hpp"
#include "base/scheduler.hpp"
#include "internal/random.hpp"
#include "internal/scheduler_work.hpp"
#include "support/suite.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <dirent.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VOX_TESTS_NO_THREADS_AFTER_FORK 1
#endif
#elif defined(__SANITIZE_THREAD__)
#define VOX_TESTS_NO_THREADS_AFTER_FORK 1
#endif

using namespace vox;

namespace {

START_TEST(every_item_once) {
    Random random{3};
    for (std::uint32_t asked = 2; asked <= 9; ++asked) {
        const std::uint32_t workers = std::strcmp(VOX_SCHEDULER, "oneTBB") == 0
                                          ? Scheduler::most_workers(asked)
                                          : asked; // else more than cores
        Scheduler scheduler(workers);
        for (int times = 0; times < 300; ++times)
            run_once(scheduler, workers, 1 + random.below(times % 8 == 0 ? 3000 : 20), random.below(12));
        run_once(scheduler, workers, 10, UINT64_MAX);
    }
}
END_TEST

START_TEST(workers_that_there_can_be) {
    ck_assert_uint_eq(Scheduler::most_workers(1), 1);
    const std::uint32_t all = Scheduler::most_workers(0);
    ck_assert(all >= 1 && all <= VOX_MAX_WORKERS);
    ck_assert_uint_eq(Scheduler::most_workers(VOX_MAX_WORKERS), all);
    ck_assert(std::strstr(vox_build_info(), ", " VOX_SCHEDULER ",") != nullptr);
#if defined(VOX_SCHEDULER_THREADS)
    ck_assert_uint_eq(all, std::min(std::max(std::thread::hardware_concurrency(), 1u), VOX_MAX_WORKERS));
#endif
}
END_TEST

#if defined(VOX_SCHEDULER_THREADS)

// Both of two items run at the same time, or not before half a minute is over.
struct Meeting {
    std::atomic<int> there{0}, met{0};

    static void task(std::uint64_t begin, std::uint64_t end, std::uint32_t, void* context) {
        Meeting& meeting = *static_cast<Meeting*>(context);
        meeting.there += int(end - begin);
        const std::uint64_t latest = nanoseconds() + 30'000'000'000u;
        while (meeting.there < 2 && nanoseconds() < latest) std::this_thread::yield();
        meeting.met += end - begin == 1 && meeting.there == 2;
    }
};

void meet(Scheduler& scheduler) {
    Meeting meeting;
    scheduler.run(&Meeting::task, 2, 1, &meeting);
    ck_assert_int_eq(meeting.met, 2);
}

START_TEST(items_run_at_the_same_time) {
    Scheduler scheduler(2);
    for (int times = 0; times < 100; ++times) {
        meet(scheduler);
        if (times % 10 == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(2)); // its thread goes to sleep
    }
    std::thread([&] { meet(scheduler); }).join(); // whichever thread calls
}
END_TEST

#if defined(__linux__)

int threads_of_process() {
    DIR* const folder = opendir("/proc/self/task");
    ck_assert_ptr_nonnull(folder);
    int count = 0;
    while (const dirent* entry = readdir(folder)) count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

START_TEST(threads_are_made_late_kept_and_joined) {
    std::thread([] {}).join(); // with the first thread a sanitizer makes one of its own
    const int before = threads_of_process();
    {
        Scheduler scheduler(5);
        ck_assert_int_eq(threads_of_process(), before);
        for (int times = 0; times < 50; ++times) {
            run_once(scheduler, 5, 100, 1);
            ck_assert_int_eq(threads_of_process(), before + 4);
        }
    }
    ck_assert_int_eq(threads_of_process(), before);
}
END_TEST

// What calls without a scheduler of their own leave to each other: one scheduler, or none.
START_TEST(threads_are_kept_from_call_to_call) {
    std::thread([] {}).join();
    const int before = threads_of_process();
    for (int times = 0; times < 20; ++times) {
        auto scheduler = Scheduler::of_last_call(4);
        run_once(*scheduler, 4, 100, 1);
        ck_assert_int_eq(threads_of_process(), before + 3);
        Scheduler::leave(std::move(scheduler));
        ck_assert_int_eq(threads_of_process(), before + 3);
    }
    // At the same time, each has its own; one of them stays.
    auto one = Scheduler::of_last_call(4), other = Scheduler::of_last_call(4);
    ck_assert_ptr_ne(one.get(), other.get());
    run_once(*other, 4, 100, 1);
    run_once(*one, 4, 100, 1);
    ck_assert_int_eq(threads_of_process(), before + 6);
    Scheduler* const last = other.get();
    Scheduler::leave(std::move(one));
    Scheduler::leave(std::move(other));
    ck_assert_int_eq(threads_of_process(), before + 3);
    other = Scheduler::of_last_call(4);
    ck_assert_ptr_eq(other.get(), last);
    Scheduler::leave(std::move(other));
    // As many as are asked for.
    other = Scheduler::of_last_call(2);
    ck_assert_int_eq(threads_of_process(), before);
    run_once(*other, 2, 100, 1);
    ck_assert_int_eq(threads_of_process(), before + 1);
    Scheduler::leave(std::move(other)); // the end of the process joins it
}
END_TEST

// From several threads at once, as calls of different grids may come.
START_TEST(calls_at_the_same_time) {
    const int before = threads_of_process();
    std::vector<std::thread> callers;
    std::atomic<int> wrong{0};
    for (std::uint32_t caller = 0; caller < 4; ++caller)
        callers.emplace_back([&, workers = 2 + caller / 2] {
            for (int times = 0; times < 200; ++times) {
                Work work(50, workers);
                auto scheduler = Scheduler::of_last_call(workers);
                scheduler->run(&Work::task, 50, 1, &work);
                Scheduler::leave(std::move(scheduler));
                wrong += !work.each_once();
            }
        });
    for (std::thread& caller : callers) caller.join();
    ck_assert_int_eq(wrong, 0);
    ck_assert_int_le(threads_of_process(), before + 3); // two of the last, and a sanitizer's
}
END_TEST

#if !defined(VOX_TESTS_NO_THREADS_AFTER_FORK)
START_TEST(a_forked_process_takes_none_of_its_parents) {
    auto scheduler = Scheduler::of_last_call(2);
    meet(*scheduler);
    Scheduler::leave(std::move(scheduler));
    for (const std::uint32_t workers : {2u, 3u}) {
        const pid_t child = fork();
        ck_assert_int_ge(child, 0);
        if (child == 0) {
            alarm(60);
            Meeting meeting;
            scheduler = Scheduler::of_last_call(workers);
            scheduler->run(&Meeting::task, 2, 1, &meeting);
            Scheduler::leave(std::move(scheduler));
            _exit(meeting.met == 2 ? 0 : 1);
        }
        int status = -1;
        ck_assert_int_eq(waitpid(child, &status, 0), child);
        ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "the child ended with %d", status);
    }
    scheduler = Scheduler::of_last_call(2);
    meet(*scheduler);
}
END_TEST

START_TEST(a_forked_process_has_threads_of_its_own) {
    for (const bool asleep : {false, true}) {
        Scheduler scheduler(2);
        auto unused = std::make_unique<Scheduler>(2); // its copy is destroyed without a task
        meet(scheduler);
        meet(*unused);
        if (asleep) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        const pid_t child = fork();
        ck_assert_int_ge(child, 0);
        if (child == 0) {
            alarm(60);
            Meeting meeting;
            scheduler.run(&Meeting::task, 2, 1, &meeting);
            unused.reset();
            _exit(meeting.met == 2 ? 0 : 1);
        }
        int status = -1;
        ck_assert_int_eq(waitpid(child, &status, 0), child);
        ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "the child ended with %d", status);
        meet(scheduler); // and the parent keeps its own
    }
}
END_TEST
#endif

#if defined(__GLIBC__)
START_TEST(no_threads_to_be_had) {
    // A stack larger than the address space.
    pthread_attr_t attributes;
    ck_assert_int_eq(pthread_attr_init(&attributes), 0);
    ck_assert_int_eq(pthread_attr_setstacksize(&attributes, std::size_t{1} << 48), 0);
    ck_assert_int_eq(pthread_setattr_default_np(&attributes), 0);
    const int before = threads_of_process();
    Scheduler scheduler(4);
    run_once(scheduler, 4, 1000, 1);
    ck_assert_int_eq(threads_of_process(), before);
    // One without its threads is not kept for later calls, when there may be some.
    auto one = Scheduler::of_last_call(4);
    run_once(*one, 4, 1000, 1);
    Scheduler::leave(std::move(one));
    ck_assert_int_eq(pthread_attr_setstacksize(&attributes, std::size_t{1} << 20), 0);
    ck_assert_int_eq(pthread_setattr_default_np(&attributes), 0);
    one = Scheduler::of_last_call(4);
    run_once(*one, 4, 1000, 1);
    ck_assert_int_eq(threads_of_process(), before + 3);
}
END_TEST
#endif

#endif
#endif

} // namespace

SUITE(scheduler) {
    TCase* tests = add_case(suite, "scheduler");
    tcase_add_test(tests, every_item_once);
    tcase_add_test(tests, workers_that_there_can_be);
#if defined(VOX_SCHEDULER_THREADS)
    tcase_add_test(tests, items_run_at_the_same_time);
#if defined(__linux__)
    tcase_add_test(tests, threads_are_made_late_kept_and_joined);
    tcase_add_test(tests, threads_are_kept_from_call_to_call);
    tcase_add_test(tests, calls_at_the_same_time);
#if !defined(VOX_TESTS_NO_THREADS_AFTER_FORK)
    tcase_add_test(tests, a_forked_process_takes_none_of_its_parents);
    tcase_add_test(tests, a_forked_process_has_threads_of_its_own);
#endif
#if defined(__GLIBC__)
    tcase_add_test(tests, no_threads_to_be_had);
#endif
#endif
#endif
}
