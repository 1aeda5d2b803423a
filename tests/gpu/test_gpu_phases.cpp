// The checks of phases see kernels that would race on a GPU, and no others.
#include "gpu/group.hpp"
#include "gpu/host_backend.hpp"

#include "support/suite.h"

using namespace vox::gpu;

namespace {

struct TwoArrays {
    SharedArray<u32, 32> a, b;
};

// The fault that work(group, arrays) makes, or null.
template <class Work>
const char* fault_of(Work&& work) {
    for (const u32 order : {1u, 31u, 13u}) {
        TwoArrays arrays{};
        phase_check.fault = nullptr;
        work(Group(order, order / 2), arrays);
        if (phase_check.fault) return phase_check.fault;
    }
    return nullptr;
}

void check_fault(const char* fault, const char* words) {
    ck_assert_msg(fault && strstr(fault, words), "%s, expected: %s", fault ? fault : "no fault", words);
}

} // namespace

START_TEST(sound) {
    const char* fault = fault_of([](const Group& g, TwoArrays& w) {
        g.each([&](u32 lane) { w.a.set(lane, lane); });
        g.each([&](u32 lane) { w.b.set(lane, w.a[31 - lane] + w.a[lane]); });
        g.each([&](u32 lane) { w.a.set(lane, w.a[lane] + w.b[0]); });
    });
    ck_assert_msg(!fault, "%s", fault);
}
END_TEST

START_TEST(races) {
    check_fault(fault_of([](const Group& g, TwoArrays& w) {
                    g.each([&](u32 lane) { w.a.set(lane, lane); });
                    g.each([&](u32 lane) { w.a.set(lane, lane ? w.a[lane - 1] : 0); });
                }),
                "");
    check_fault(fault_of([](const Group& g, TwoArrays& w) { g.each([&](u32 lane) { w.a.set(0, lane); }); }),
                "two lanes write to one place");
    check_fault(fault_of([](const Group& g, TwoArrays& w) { // read by all, written by the last that comes
                    g.each([&](u32 lane) { w.a.set(lane, lane); });
                    g.each([&](u32 lane) {
                        w.b.set(lane, w.a[3]);
                        if (lane == 7) w.a.set(3, 0);
                    });
                }),
                "what another one");
    check_fault(
        fault_of([](const Group& g, TwoArrays& w) { g.each([&](u32 lane) { w.b.set(lane, w.a[lane]); }); }),
        "no lane has written");
    check_fault(fault_of([](const Group& g, TwoArrays& w) {
                    g.each([&](u32 lane) { w.a.set(lane, lane); });
                    g.each([&](u32 lane) {
                        if (lane == 0) w.a.set(w.a[31] + 1, 0);
                    });
                }),
                "past its end");
}
END_TEST

SUITE(gpu_phases) {
    TCase* tests = add_case(suite, "phases");
    tcase_add_each(tests, sound, races);
}
