// The C border of the experiment, with the order and the statistics of its samples.
#include "base/border.hpp"
#include "base/sampling.hpp"
#include "base/structs.hpp"
#include "sim/experiment/experiment.hpp"
#include "sim/experiment/fit.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <numeric>

using namespace vox;
using namespace vox::sim;

namespace {

constexpr std::uint32_t max_frames = 1000;

void check_number(bool good, double value, const char* name, const char* expected) {
    if (!good || !std::isfinite(value)) refuse(format("%s is %.9g, expected %s", name, value, expected));
}

void check_positive(double value, const char* name) {
    check_number(value > 0, value, name, "a finite number above 0");
}

void check_experiment_desc(const vox_experiment_desc& desc) {
    require(desc.a, "desc.a");
    if (desc.frames == 0 || desc.frames > max_frames)
        refuse(format("desc.frames is %u, expected 1 to %u", desc.frames, max_frames));
    const double length = std::hypot(desc.axis[0], desc.axis[1], desc.axis[2]);
    if (!(length > 0) || !std::isfinite(length))
        refuse(format("desc.axis is (%.9g, %.9g, %.9g), expected a direction", desc.axis[0], desc.axis[1],
                      desc.axis[2]));
    check_number(desc.contact_share > 0 && desc.contact_share < 1, desc.contact_share, "desc.contact_share",
                 "a number between 0 and 1");
    check_positive(desc.time_step, "desc.time_step");
    if (desc.turn > 1) refuse(format("desc.turn is %u, expected 0 or 1", desc.turn));
    if (desc.reserved != 0) refuse(format("desc.reserved is %u, expected 0", desc.reserved));
}

double median(std::vector<std::uint64_t>& values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    const double upper = static_cast<double>(values[middle]);
    return values.size() % 2 ? upper : (static_cast<double>(values[middle - 1]) + upper) / 2;
}

vox_time_fit read_fit(const vox_time_fit* in) {
    const vox_time_fit fit = read_struct(in, "fit");
    if (fit.degree < 2 || fit.degree > max_fit_degree || !(fit.range_min > 0) ||
        !(fit.range_max > fit.range_min) || !std::isfinite(fit.range_max) ||
        !(fit.cell_size >= fit.range_min && fit.cell_size <= fit.range_max))
        refuse(format("fit was not filled by vox_fit_times: degree %u, range %.9g to %.9g, cell size "
                      "%.9g",
                      fit.degree, fit.range_min, fit.range_max, fit.cell_size));
    return fit;
}

} // namespace

vox_result vox_experiment_create(const vox_experiment_desc* desc, vox_experiment** out_experiment) {
    return border([&] {
        require(out_experiment, "out_experiment");
        const vox_experiment_desc settings = read_struct(desc, "desc");
        check_experiment_desc(settings);
        *out_experiment = new vox_experiment(settings);
    });
}

void vox_experiment_destroy(vox_experiment* experiment) { delete experiment; }

vox_result vox_experiment_get(const vox_experiment* experiment, vox_experiment_facts* out_facts) {
    return border([&] {
        require(experiment, "experiment");
        check_out_struct(out_facts, "out_facts");
        write_struct(out_facts, experiment->facts(), "out_facts");
    });
}

vox_result vox_experiment_suggest(const vox_experiment* experiment, const vox_suggest_desc* desc,
                                  vox_suggestion* out) {
    return border([&] {
        require(experiment, "experiment");
        check_out_struct(out, "out");
        write_struct(out, experiment->suggest(desc), "out");
    });
}

vox_result vox_experiment_measure(vox_experiment* experiment, double cell_size, std::uint64_t* frame_ns,
                                  vox_experiment_sample* out_sample) {
    return border([&] {
        require(experiment, "experiment");
        check_out_struct(out_sample, "out_sample");
        check_positive(cell_size, "cell_size");
        std::vector<std::uint64_t> times;
        write_struct(out_sample, experiment->measure(cell_size, times), "out_sample");
        if (frame_ns) std::copy(times.begin(), times.end(), frame_ns);
    });
}

vox_result vox_experiment_order(std::uint64_t count, std::uint64_t seed, std::uint64_t round,
                                std::uint64_t* out_order) {
    return border([&] {
        require(out_order, "out_order");
        if (count == 0) refuse("count is 0, expected at least 1");
        std::iota(out_order, out_order + count, std::uint64_t{0});
        std::uint64_t state = seed;
        state = next_random(state) + round;
        for (std::uint64_t i = count - 1; i > 0; --i)
            std::swap(out_order[i], out_order[next_random(state) % (i + 1)]); // Fisher and Yates
    });
}

vox_result vox_experiment_time(const std::uint64_t* frame_ns, std::uint64_t rounds, std::uint64_t frames,
                               double* out_ns) {
    return border([&] {
        require(frame_ns, "frame_ns");
        require(out_ns, "out_ns");
        if (rounds == 0 || frames == 0)
            refuse(format("%" PRIu64 " rounds of %" PRIu64 " frames, expected at least one of both", rounds,
                          frames));
        std::vector<std::uint64_t> of_frame;
        double sum = 0;
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            of_frame.clear();
            for (std::uint64_t round = 0; round < rounds; ++round)
                of_frame.push_back(frame_ns[round * frames + frame]);
            sum += median(of_frame);
        }
        *out_ns = sum / static_cast<double>(frames);
    });
}

vox_result vox_fit_times(const double* cell_sizes, const double* times, std::uint64_t count,
                         vox_time_fit* out_fit) {
    return border([&] {
        require(cell_sizes, "cell_sizes");
        require(times, "times");
        check_out_struct(out_fit, "out_fit");
        for (std::uint64_t i = 0; i < count; ++i) {
            check_positive(cell_sizes[i], format("cell_sizes[%" PRIu64 "]", i).c_str());
            check_positive(times[i], format("times[%" PRIu64 "]", i).c_str());
        }
        const auto items = static_cast<std::size_t>(count);
        const std::span<const double> sizes(cell_sizes, items);
        const std::size_t distinct = count_distinct(sizes);
        if (distinct < 5) refuse(format("%zu different cell sizes, expected at least 5", distinct));
        write_struct(out_fit, fit_times(sizes, {times, items}), "out_fit");
    });
}

vox_result vox_fit_time_at(const vox_time_fit* fit, double cell_size, double* out_time) {
    return border([&] {
        require(out_time, "out_time");
        const vox_time_fit read = read_fit(fit);
        if (!(cell_size >= read.range_min && cell_size <= read.range_max))
            refuse(format("cell_size is %.9g, the fit holds from %.9g to %.9g", cell_size, read.range_min,
                          read.range_max));
        *out_time = fitted_time(read, cell_size);
    });
}

vox_result vox_fit_zone(const vox_time_fit* fit, double limit, double* out_min, double* out_max) {
    return border([&] {
        require(out_min, "out_min");
        require(out_max, "out_max");
        const vox_time_fit read = read_fit(fit);
        if (!(limit >= read.time) || !std::isfinite(limit))
            refuse(format("limit is %.9g, expected at least the fit's least time, %.9g", limit, read.time));
        const FitZone zone = fit_zone(read, limit);
        *out_min = zone.min;
        *out_max = zone.max;
    });
}
