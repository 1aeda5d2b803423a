// What a byte budget that is short of the whole costs: each question of a surface is asked again and again
// with budgets from the least that holds the answer to one in which everything fits, and takes as many times
// as long as without a budget. Prints the worst of each question. Every answer must be that without a budget.
//
// Usage: bench_surface_budgets [faces [budgets]], a million and 24 by default.
#include "program.hpp"
#include "timing.h"

#include <vox/vox_surface.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace bench {
namespace {

// Two sheets of halved squares with noise, one half a square above the other.
struct Sheets {
    std::vector<float> from, to;
    std::vector<std::uint32_t> faces;
    explicit Sheets(std::size_t face_count) {
        const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(face_count) / 4));
        std::minstd_rand random(1);
        std::uniform_real_distribution<float> noise(-0.15f, 0.15f);
        for (int sheet = 0; sheet < 2; ++sheet) {
            const auto first = static_cast<std::uint32_t>(from.size() / 3);
            for (std::uint32_t y = 0; y <= side; ++y)
                for (std::uint32_t x = 0; x <= side; ++x)
                    for (const float at :
                         {static_cast<float>(x), static_cast<float>(y), 0.5f * static_cast<float>(sheet)})
                        from.push_back(at + noise(random));
            for (std::uint32_t y = 0; y < side; ++y)
                for (std::uint32_t x = 0; x < side; ++x) {
                    const std::uint32_t a = first + y * (side + 1) + x, b = a + 1, c = a + side + 1,
                                        d = c + 1;
                    faces.insert(faces.end(), {a, b, d, a, d, c});
                }
        }
        to = from;
        for (float& at : to) at += noise(random);
    }
};

struct Question {
    const char* name;
    std::function<vox_result(vox_surface*, double& answer)> ask; // a number that stands for all of it
};

constexpr double near = 0.4;

std::vector<double> per_vertex;

const Question questions[] = {
    {"crossings",
     [](vox_surface* surface, double& answer) {
         vox_crossing_view view{};
         const vox_result result = vox_surface_find_crossings(surface, &view);
         answer = static_cast<double>(view.count);
         return result;
     }},
    {"close edges",
     [](vox_surface* surface, double& answer) {
         vox_proximity_view view{};
         const vox_result result =
             vox_surface_find_proximities(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, near, &view);
         answer = static_cast<double>(view.count);
         return result;
     }},
    {"clearance",
     [](vox_surface* surface, double& answer) {
         const vox_result result = vox_surface_find_clearances(surface, near, per_vertex.data());
         answer = std::accumulate(per_vertex.begin(), per_vertex.end(), 0.0);
         return result;
     }},
    {"safe step",
     [](vox_surface* surface, double& answer) {
         vox_safe_step found{};
         const vox_result result = vox_surface_find_safe_step(surface, nullptr, &found);
         answer = found.step;
         return result;
     }},
    {"times of edges",
     [](vox_surface* surface, double& answer) {
         vox_impact_view view{};
         const vox_result result =
             vox_surface_find_impacts(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, nullptr, &view);
         answer = static_cast<double>(view.count);
         return result;
     }},
};

struct Asked {
    bool fits;
    double seconds, answer;
    std::uint64_t peak;
};

// A new surface, moved and asked twice: the time of the second answer.
Asked ask(const Sheets& sheets, const Question& question, std::uint64_t budget) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = sheets.from.size() / 3;
    desc.faces = sheets.faces.data();
    desc.face_count = sheets.faces.size() / 3;
    desc.byte_budget = budget;
    vox_motion motion = vox_default_motion();
    motion.from.data = sheets.from.data();
    motion.to.data = sheets.to.data();
    motion.from.count = motion.to.count = desc.vertex_count;
    vox_surface* surface = nullptr;
    const auto fits = [](vox_result result) {
        if (result != VOX_ERROR_BUDGET) must(result);
        return result == VOX_OK;
    };
    Asked asked{};
    asked.fits = fits(vox_surface_create(&desc, &surface)) && fits(vox_surface_move(surface, &motion)) &&
                 fits(question.ask(surface, asked.answer));
    if (asked.fits) {
        asked.seconds = seconds_of([&] { asked.fits = fits(question.ask(surface, asked.answer)); });
        vox_counter_view counters;
        must(vox_surface_get_counters(surface, &counters));
        asked.peak = counters.data[counters.count - 1].value; // peak_bytes
    }
    vox_surface_destroy(surface);
    return asked;
}

void run(std::size_t faces, int budgets) {
    const Sheets sheets(faces);
    per_vertex.resize(sheets.from.size() / 3);
    std::printf(
        "%zu faces\n| question | ms without a budget | MB then | least MB | worst, times as long | its MB |\n"
        "|---|---|---|---|---|---|\n",
        sheets.faces.size() / 3);
    for (const Question& question : questions) {
        const Asked whole = ask(sheets, question, 0);
        std::uint64_t none = 0, least = whole.peak;
        while (least - none > whole.peak / 256) {
            const std::uint64_t middle = none + (least - none) / 2;
            (ask(sheets, question, middle).fits ? least : none) = middle;
        }
        double worst = 0;
        std::uint64_t worst_budget = 0;
        for (int i = 0; i < budgets; ++i) {
            const double share = static_cast<double>(i) / budgets;
            const auto budget =
                least + static_cast<std::uint64_t>(share * static_cast<double>(whole.peak - least));
            const Asked asked = ask(sheets, question, budget);
            if (!asked.fits) continue;
            if (asked.answer != whole.answer)
                throw std::runtime_error(std::string(question.name) + ": another answer with a budget");
            const double times = asked.seconds / whole.seconds;
            if (times < worst) continue;
            worst = times;
            worst_budget = budget;
        }
        std::printf("| %s | %.0f | %.0f | %.0f | %.1f | %.0f |\n", question.name, 1e3 * whole.seconds,
                    1e-6 * static_cast<double>(whole.peak), 1e-6 * static_cast<double>(least), worst,
                    1e-6 * static_cast<double>(worst_budget));
        std::fflush(stdout);
    }
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    return bench::run_program("bench_surface_budgets", [&] {
        bench::run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000,
                   argc > 2 ? std::atoi(argv[2]) : 24);
        return 0;
    });
}
