// vox demo: two soft balls wobble through each other. Shows the contacts of every frame, and how much time
// the right cell size saves.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "report.hpp"
#include "stepping.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

namespace tool {

namespace {

struct Options {
    std::uint64_t tets = 20000;
    std::uint32_t frames = 12;
    bool json = false;
};

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

void move(std::vector<Body>& balls, double time) {
    for (std::size_t ball = 0; ball < balls.size(); ++ball) {
        const double side = ball == 0 ? -1 : 1;
        for (std::size_t v = 0; v < balls[ball].view.vertex_count; ++v) {
            const auto position = moved(balls[ball].view.positions + 3 * v, side, time);
            for (std::size_t axis = 0; axis < 3; ++axis)
                balls[ball].positions[3 * v + axis] = static_cast<float>(position[axis]);
        }
    }
}

double time_of(std::uint32_t frame, std::uint32_t frames) {
    return frames > 1 ? static_cast<double>(frame) / (frames - 1) : 0;
}

vox_suggestion suggest_for(const std::vector<Body>& bodies) {
    std::vector<vox_mesh_desc> meshes;
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    vox_suggestion suggestion{};
    suggestion.struct_size = sizeof suggestion;
    check(vox_suggest_cell_size(nullptr, meshes.data(), meshes.size(), &suggestion));
    return suggestion;
}

// An engine with a rule for the cell size, which has its own grid over the same positions.
struct Contender {
    const char* engine;
    const char* rule;
    double cell_size;
    Grid grid;
    std::vector<vox_mesh> ids;
    std::vector<vox_profile> frames; // median of each frame's steps
};

Contender make_contender(const std::vector<Body>& balls, vox_engine engine, const char* rule,
                         double cell_size) {
    Contender contender{engine == VOX_ENGINE_FAST ? "fast" : "reference", rule, cell_size, {}, {}, {}};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.engine = engine;
    desc.cell_size = cell_size;
    contender.grid = make_grid(desc, balls, false, contender.ids);
    check(vox_grid_step(contender.grid.get())); // warm up
    return contender;
}

// Steps the two rules of one engine in turn, so that disturbances of the machine affect both equally.
void measure_frame(std::span<Contender> rules) {
    std::vector<std::vector<vox_profile>> profiles(rules.size());
    for (std::size_t round = 0; round < rounds; ++round)
        for (std::size_t turn = 0; turn < rules.size(); ++turn) {
            const std::size_t i = (turn + round) % rules.size();
            step_anew(rules[i].grid.get(), rules[i].ids);
            profiles[i].push_back(profile_of(rules[i].grid.get()));
        }
    for (std::size_t i = 0; i < rules.size(); ++i) rules[i].frames.push_back(median(profiles[i]));
}

void require_same_contacts(const std::vector<Contender>& contenders) {
    for (const Contender& contender : contenders)
        if (hash_of(contender.grid.get()) != hash_of(contenders.front().grid.get()))
            throw Failure(
                "contacts depend on engine or cell size, which is a defect of vox; please report it");
}

double mean_step_ns(const Contender& contender) {
    double sum = 0;
    for (const vox_profile& frame : contender.frames) sum += static_cast<double>(frame.step_ns);
    return sum / static_cast<double>(contender.frames.size());
}

double milliseconds(double nanoseconds) { return nanoseconds * 1e-6; }

void print_frames(const std::vector<std::uint64_t>& contacts, const Contender& fast,
                  const Contender& reference) {
    const double most = static_cast<double>(*std::max_element(contacts.begin(), contacts.end()));
    std::printf("%5s %9s %14s %18s\n", "frame", "contacts", "fast engine", "paper's algorithm");
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const double share = most > 0 ? static_cast<double>(contacts[i]) / most : 0.0;
        std::printf("%5zu %9llu %11.3f ms %15.3f ms%s%s\n", i, static_cast<unsigned long long>(contacts[i]),
                    milliseconds(static_cast<double>(fast.frames[i].step_ns)),
                    milliseconds(static_cast<double>(reference.frames[i].step_ns)), share > 0 ? "  " : "",
                    bar(share, 25).c_str());
    }
}

void print_comparison(const Contender& fast, const Contender& fast_mean_edge, const Contender& reference,
                      const Contender& reference_mean_edge) {
    const auto line = [](const char* rule, const Contender& left, const Contender& right) {
        std::printf("  %-30s %9.4g %11.3f ms %15.3f ms\n", rule, left.cell_size,
                    milliseconds(mean_step_ns(left)), milliseconds(mean_step_ns(right)));
    };
    std::printf("\nMean time of a step:\n  %-30s %9s %14s %18s\n", "rule", "cell size", "fast engine",
                "paper's algorithm");
    line("suggested (least cost)", fast, reference);
    line("mean edge (the usual rule)", fast_mean_edge, reference_mean_edge);
    const auto lost = [](const Contender& mean_edge, const Contender& suggested) {
        const double percent = 100 * (mean_step_ns(mean_edge) / mean_step_ns(suggested) - 1);
        char words[48];
        std::snprintf(words, sizeof words, "%.0f %% %s", std::abs(percent), percent < 0 ? "less" : "more");
        return std::string(words);
    };
    std::printf("\nThe suggestion is the minimum of the paper's cost model. With the mean edge, the paper's\n"
                "algorithm takes %s time, the fast engine %s. In every frame all four found\n"
                "the same contacts: they are exact, and depend on neither engine nor cell size.\n"
                "\nWith your own files:  vox suggest MESH...   vox collide A B   vox --help\n",
                lost(reference_mean_edge, reference).c_str(), lost(fast_mean_edge, fast).c_str());
}

void run(const Options& options) {
    std::vector<Body> balls;
    for (const char* name : {"ball A", "ball B"}) {
        vox_io_mesh* mesh = nullptr;
        check(vox_io_make_lattice_ball(options.tets, 1, &mesh));
        balls.push_back(own_body(name, mesh));
    }
    move(balls, 0);
    const vox_suggestion suggestion = suggest_for(balls);
    std::vector<Contender> contenders;
    for (const vox_engine engine : {VOX_ENGINE_FAST, VOX_ENGINE_REFERENCE}) {
        contenders.push_back(make_contender(balls, engine, "suggested", suggestion.cell_size));
        contenders.push_back(make_contender(balls, engine, "mean_edge", suggestion.rules.mean_edge));
    }
    if (!options.json)
        std::printf("Two soft balls of %llu tetrahedra each (%llu vertices) wobble through each other.\n\n",
                    static_cast<unsigned long long>(balls[0].view.tet_count),
                    static_cast<unsigned long long>(balls[0].view.vertex_count));

    std::vector<std::uint64_t> contacts; // of each frame
    {
        Progress progress;
        for (std::uint32_t i = 0; i < options.frames; ++i) {
            progress.show("frame " + std::to_string(i + 1) + " of " + std::to_string(options.frames));
            move(balls, time_of(i, options.frames));
            measure_frame(std::span(contenders).first(2));
            measure_frame(std::span(contenders).last(2));
            require_same_contacts(contenders);
            contacts.push_back(contacts_of(contenders[0].grid.get()).count);
        }
    }
    if (!options.json) {
        print_frames(contacts, contenders[0], contenders[2]);
        return print_comparison(contenders[0], contenders[1], contenders[2], contenders[3]);
    }

    Json json = {{"meshes", body_list(balls)}, {"frames", Json::array()}, {"comparison", Json::array()}};
    for (std::uint32_t i = 0; i < options.frames; ++i)
        json["frames"].push_back({{"frame", i},
                                  {"contacts", contacts[i]},
                                  {"step_ns", contenders[0].frames[i].step_ns},
                                  {"reference_step_ns", contenders[2].frames[i].step_ns}});
    for (const Contender& contender : contenders)
        json["comparison"].push_back({{"engine", contender.engine},
                                      {"rule", contender.rule},
                                      {"cell_size", number(contender.cell_size)},
                                      {"step_ns", std::llround(mean_step_ns(contender))}});
    add_suggestion(json, suggestion);
    // The keys shared with collide describe the frame with the most contacts.
    const auto busiest =
        static_cast<std::uint32_t>(std::max_element(contacts.begin(), contacts.end()) - contacts.begin());
    json["frame"] = busiest;
    move(balls, time_of(busiest, options.frames));
    check(vox_grid_step(contenders[0].grid.get()));
    add_collision(json, contenders[0].grid.get(), contenders[0].ids, contenders[0].frames[busiest]);
    print(json);
}

} // namespace

void add_demo(CommandLine& line) {
    const auto options = std::make_shared<Options>();
    Command command = line.add("demo", "Two deforming bodies collide; needs no file");
    command.option("--tets", options->tets, "Approximate number of tetrahedra of each body")
        .range(1, 100000000);
    command.option("--frames", options->frames, "Number of frames").range(1, 1000000);
    command.flag("--json", options->json, "Print one JSON object");
    command.runs([options] { run(*options); });
}

} // namespace tool
