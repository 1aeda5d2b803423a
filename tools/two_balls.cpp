#include "two_balls.hpp"

#include "failure.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <string>

namespace tool {

namespace {

constexpr std::size_t rounds = 5; // steps of each contender in a frame, whose median is the frame's time

// The position at `time` in [0, 1] of a point of the ball at rest. The ball (side -1 or 1) crosses the scene
// along x and spins about z, while a wave squashes it along x at constant volume and twists it about x. At
// time 0 it has its shape at rest.
std::array<double, 3> moved(const double* rest, double side, double time) {
    constexpr double pi = std::numbers::pi;
    const double squash = 1 - 0.3 * std::sin(3 * pi * time), swell = 1 / std::sqrt(squash);
    const double twist = 0.6 * std::sin(2 * pi * time) * rest[0];
    const double y = rest[1] * std::cos(twist) - rest[2] * std::sin(twist);
    const double z = rest[1] * std::sin(twist) + rest[2] * std::cos(twist);
    const double spin = side * (0.4 + 1.5 * time);
    const double along = rest[0] * squash, across = y * swell;
    return {along * std::cos(spin) - across * std::sin(spin) + side * (1 - 2 * time),
            along * std::sin(spin) + across * std::cos(spin) + side * 0.75, z * swell};
}

double time_of(std::size_t frame, std::size_t frames) {
    return frames > 1 ? static_cast<double>(frame) / static_cast<double>(frames - 1) : 0;
}

Contender make_contender(std::span<const vox_mesh_desc> balls, const vox_reference_desc* reference,
                         const char* rule, double cell_size) {
    Contender contender{reference ? "reference" : "fast", rule, cell_size, {}, {}, {}};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = reference;
    desc.cell_size = cell_size;
    contender.grid = make_grid(desc, balls, contender.ids);
    check(vox_grid_step(contender.grid.get())); // warm up
    return contender;
}

// Steps the two rules of one engine in turn, so that disturbances of the machine affect both equally.
void measure_frame(std::span<Contender> rules) {
    std::vector<std::vector<std::uint64_t>> times(rules.size());
    for (std::size_t round = 0; round < rounds; ++round)
        for (std::size_t turn = 0; turn < rules.size(); ++turn) {
            const std::size_t i = (turn + round) % rules.size();
            step_anew(rules[i].grid.get(), rules[i].ids);
            times[i].push_back(info_of(rules[i].grid.get()).step_ns);
        }
    for (std::size_t i = 0; i < rules.size(); ++i) {
        std::ranges::sort(times[i]);
        rules[i].frames.push_back((times[i][(rounds - 1) / 2] + times[i][rounds / 2]) / 2);
    }
}

void require_same_contacts(const std::vector<Contender>& contenders) {
    for (const Contender& contender : contenders)
        if (hash_of(contender.grid.get()) != hash_of(contenders.front().grid.get()))
            throw Failure(
                "contacts depend on engine or cell size, which is a defect of vox; please report it");
}

double milliseconds(double nanoseconds) { return nanoseconds * 1e-6; }

void print_frames(std::span<const std::uint64_t> contacts, const Contender& fast,
                  const Contender& reference) {
    const double most = static_cast<double>(*std::max_element(contacts.begin(), contacts.end()));
    std::printf("%5s %9s %14s %18s\n", "frame", "contacts", "fast engine", "paper's algorithm");
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const double share = most > 0 ? static_cast<double>(contacts[i]) / most : 0.0;
        std::printf("%5zu %9llu %11.3f ms %15.3f ms%s%s\n", i, llu(contacts[i]),
                    milliseconds(static_cast<double>(fast.frames[i])),
                    milliseconds(static_cast<double>(reference.frames[i])), share > 0 ? "  " : "",
                    bar(share, 25).c_str());
    }
}

void print_comparison(const Contender& fast, const Contender& fast_mean_edge, const Contender& reference,
                      const Contender& reference_mean_edge, const char* program) {
    const auto line = [](const char* rule, const Contender& left, const Contender& right) {
        std::printf("  %-30s %9.4g %11.3f ms %15.3f ms\n", rule, left.cell_size,
                    milliseconds(left.mean_step_ns()), milliseconds(right.mean_step_ns()));
    };
    std::printf("\nMean time of a step:\n  %-30s %9s %14s %18s\n", "rule", "cell size", "fast engine",
                "paper's algorithm");
    line("suggested (least cost)", fast, reference);
    line("mean edge (the usual rule)", fast_mean_edge, reference_mean_edge);
    std::printf("\nThe suggestion is the minimum of the paper's cost model, for the paper's algorithm. The "
                "fast engine,\n"
                "the default, chooses its own size in every step (cell_size = 0), and hardly depends on it.\n"
                "In every frame all four found the same contacts: they are exact, and depend on neither\n"
                "engine nor cell size.\n"
                "\nWith your own files:  %s suggest MESH...   %s collide A B   %s --help\n",
                program, program, program);
}

} // namespace

double Contender::mean_step_ns() const {
    double sum = 0;
    for (const std::uint64_t time : frames) sum += static_cast<double>(time);
    return sum / static_cast<double>(frames.size());
}

TwoBalls::TwoBalls(std::span<const double> rest, std::span<const std::uint32_t> tets)
    : rest_(rest), tets_(tets) {
    std::vector<vox_mesh_desc> balls;
    for (std::vector<float>& positions : positions_) {
        positions.resize(rest.size());
        vox_mesh_desc& ball = balls.emplace_back(vox_default_mesh_desc());
        ball.positions = vox_float_positions(positions.data(), vertex_count());
        ball.tets = tets.data();
        ball.tet_count = tet_count();
    }
    move(0);
    check(vox_suggest_cell_size(nullptr, balls.data(), balls.size(), &suggestion_));
    check(vox_measure_geometry(balls.data(), balls.size(), &geometry_));
    const vox_reference_desc reference = vox_default_reference_desc();
    for (const vox_reference_desc* engine : {static_cast<const vox_reference_desc*>(nullptr), &reference}) {
        contenders_.push_back(make_contender(balls, engine, "suggested", suggestion_.cell_size));
        contenders_.push_back(make_contender(balls, engine, "mean_edge", geometry_.mean_edge));
    }
}

void TwoBalls::move(double time) {
    for (std::size_t ball = 0; ball < positions_.size(); ++ball) {
        const double side = ball == 0 ? -1 : 1;
        for (std::size_t v = 0; v < vertex_count(); ++v) {
            const auto position = moved(&rest_[3 * v], side, time);
            for (std::size_t axis = 0; axis < 3; ++axis)
                positions_[ball][3 * v + axis] = static_cast<float>(position[axis]);
        }
    }
}

void TwoBalls::run(std::uint32_t frames) {
    Progress progress;
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    for (std::uint32_t i = 0; i < frames; ++i) {
        progress.show("frame " + std::to_string(i + 1) + " of " + std::to_string(frames));
        move(time_of(i, frames));
        measure_frame(std::span(contenders_).first(2));
        measure_frame(std::span(contenders_).last(2));
        require_same_contacts(contenders_);
        contacts_.push_back(contacts_of(contenders_[0].grid.get()).size());
    }
    progress.hide();
    warn_if_busy(std::chrono::steady_clock::now() - begin, double(std::clock() - used) / CLOCKS_PER_SEC);
}

void TwoBalls::print_balls() const {
    std::printf("Two soft balls of %zu tetrahedra each (%zu vertices) wobble through each other.\n\n",
                tet_count(), vertex_count());
}

void TwoBalls::print_results(const char* program) const {
    print_frames(contacts_, contenders_[0], contenders_[2]);
    print_comparison(contenders_[0], contenders_[1], contenders_[2], contenders_[3], program);
}

void TwoBalls::show(std::uint32_t frame) {
    move(time_of(frame, contacts_.size()));
    check(vox_grid_step(contenders_[0].grid.get()));
    check(vox_grid_find_constraints(contenders_[0].grid.get(), nullptr));
}

} // namespace tool
