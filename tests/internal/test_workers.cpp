// What a task system of the caller may do wrong: Workers notices every set of ranges that is not the whole,
// and two ranges that one worker has at the same time.
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "internal/random.hpp"
#include "support/suite.h"

#include <cstring>
#include <utility>
#include <vector>

using namespace vox;

namespace {

constexpr std::uint32_t worker_count = 4;

// Runs these ranges, whatever the items are.
struct Ranges {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> list;
    vox_task* task = nullptr; // the last one
    void* context = nullptr;
};

void* enqueue(vox_task* task, std::uint64_t, std::uint64_t, void* context, void* user) {
    Ranges& ranges = *static_cast<Ranges*>(user);
    ranges.task = task;
    ranges.context = context;
    std::uint32_t worker = 0;
    for (const auto& [begin, end] : ranges.list) task(begin, end, worker++ % worker_count, context);
    return nullptr;
}
void finish(void*, void*) { ck_abort_msg("finish without a handle"); }

// The text of the error, or "".
template <class Function>
std::string run(Ranges& ranges, std::size_t items, Function&& function) {
    Workers workers({enqueue, finish, &ranges}, worker_count);
    try {
        workers.for_ranges(items, 1, function);
        return "";
    } catch (const Error& error) {
        ck_assert_int_eq(error.result(), VOX_ERROR_INVALID_ARGUMENT);
        return error.what();
    }
}

START_TEST(ranges_are_the_whole_or_an_error) {
    Random random{5};
    std::size_t whole = 0, as_many = 0;
    for (int times = 0; times < 20000; ++times) {
        const std::size_t items = 2 + random.below(8);
        Ranges ranges;
        for (std::uint32_t count = random.below(5); count > 0; --count) {
            std::uint64_t begin = random.below(std::uint32_t(items) + 1),
                          end = random.below(std::uint32_t(items) + 1);
            if (begin > end) std::swap(begin, end);
            ranges.list.push_back({begin, end});
        }
        if (random.below(4) == 0) ranges.list.push_back({0, 0});
        if (random.below(4) == 0) { // the whole, in two parts
            const std::uint64_t middle = random.below(std::uint32_t(items));
            ranges.list = {{middle, items}, {0, middle}};
        }
        std::vector<int> runs(items, 0);
        const std::string text = run(ranges, items, [&](std::size_t begin, std::size_t end, std::uint32_t) {
            for (std::size_t i = begin; i < end; ++i) ++runs[i];
        });
        std::size_t done = 0;
        bool each_once = true;
        for (const int count : runs) {
            done += std::size_t(count);
            each_once = each_once && count == 1;
        }
        ck_assert_msg(text.empty() == each_once, "%s", text.c_str());
        whole += each_once;
        as_many += !each_once && done == items;
    }
    ck_assert_uint_gt(whole, 1000);
    ck_assert_uint_gt(as_many, 500); // a sum of items alone would let these pass
}
END_TEST

START_TEST(ranges_out_of_bounds_are_not_run) {
    for (const auto& [begin, end] :
         {std::pair<std::uint64_t, std::uint64_t>{0, 11}, {7, 3}, {11, 11}, {~0ull, 3}}) {
        Ranges ranges{.list = {{begin, end}}};
        const std::string text =
            run(ranges, 10, [](std::size_t, std::size_t, std::uint32_t) { ck_abort_msg("was run"); });
        ck_assert_ptr_nonnull(std::strstr(text.c_str(), "of 10 on worker 0 of 4"));
    }
}
END_TEST

START_TEST(a_worker_has_one_range_at_a_time) {
    Ranges ranges{.list = {{0, 5}}};
    int runs = 0;
    const std::string text = run(ranges, 10, [&](std::size_t, std::size_t, std::uint32_t worker) {
        if (++runs == 1) ranges.task(5, 10, worker, ranges.context); // before this one has returned
    });
    ck_assert_int_eq(runs, 1);
    ck_assert_str_eq(
        text.c_str(),
        "the task system ran two ranges on worker 0 at the same time, one of them items 5 to 10 of 10");
    // Another worker, and the same one afterwards, are right.
    runs = 0;
    ranges.list = {{0, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 8}};
    const std::string sound = run(ranges, 10, [&](std::size_t, std::size_t, std::uint32_t worker) {
        if (++runs == 1) ranges.task(8, 10, worker + 1, ranges.context);
    });
    ck_assert_str_eq(sound.c_str(), "");
}
END_TEST

} // namespace

SUITE(workers) {
    TCase* tests = add_case(suite, "task systems");
    for (const TTest* test : {ranges_are_the_whole_or_an_error, ranges_out_of_bounds_are_not_run,
                              a_worker_has_one_range_at_a_time})
        tcase_add_test(tests, test);
}
