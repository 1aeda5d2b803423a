// vox demo: two soft balls wobble through each other. Shows the contacts of every frame, and what the cell
// size is worth.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "report.hpp"
#include "stepping.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tool {

namespace {

struct Options {
    std::uint64_t tets = 20000;
    std::uint32_t frames = 12;
    vox_engine engine = VOX_ENGINE_AUTO;
    bool json = false;
};

constexpr int rounds = 5; // steps a frame under each cell size: their median is the frame's time

// Where a point of the ball at rest is at `time` in [0, 1]. The ball (side -1 or 1) crosses the scene along x
// and spins about z, while a wave squashes it along x at constant volume and twists it about x. At time 0 it
// has its shape at rest.
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

// One cell size under test: a grid of its own over the same positions.
struct Contender {
    Grid grid;
    std::vector<vox_mesh> ids;
    std::vector<vox_profile> profiles; // of this frame's steps
    double total_ns = 0;               // sum of the frames' medians
};

Contender make_contender(const std::vector<Body>& balls, vox_engine engine, double cell_size) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.engine = engine;
    desc.cell_size = cell_size;
    Contender contender;
    contender.grid = make_grid(desc, balls, false, contender.ids);
    return contender;
}

// Steps the contenders in turn, so that whatever else the machine does meets them alike.
void measure_frame(std::array<Contender, 2>& contenders) {
    for (Contender& contender : contenders) contender.profiles.clear();
    for (int round = 0; round < rounds; ++round)
        for (std::size_t turn = 0; turn < contenders.size(); ++turn) {
            Contender& contender = contenders[(turn + static_cast<std::size_t>(round)) % contenders.size()];
            check(vox_grid_step(contender.grid.get()));
            contender.profiles.push_back(profile_of(contender.grid.get()));
        }
    for (Contender& contender : contenders)
        contender.total_ns += static_cast<double>(median(contender.profiles).step_ns);
}

struct Frame {
    std::uint64_t contacts;
    vox_profile profile;
};

// Longest bar: the frame with the most contacts.
void print_frames(const std::vector<Frame>& frames, std::uint64_t most) {
    std::printf("%5s %9s %9s\n", "frame", "contacts", "step");
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double share =
            most > 0 ? static_cast<double>(frames[i].contacts) / static_cast<double>(most) : 0.0;
        std::printf("%5zu %9llu %6.2f ms  %s\n", i, static_cast<unsigned long long>(frames[i].contacts),
                    static_cast<double>(frames[i].profile.step_ns) * 1e-6, bar(share, 40).c_str());
    }
}

void print_comparison(const vox_suggestion& suggestion, double suggested_ns, double mean_edge_ns) {
    const auto line = [](const char* rule, double cell_size, double ns) {
        std::printf("  %-28s %8.4f %9.2f ms\n", rule, cell_size, ns * 1e-6);
    };
    std::printf("\n  %-28s %8s %12s\n", "cell size", "", "mean step");
    line("suggested (cost model)", suggestion.cell_size, suggested_ns);
    line("mean edge (the usual rule)", suggestion.rules.mean_edge, mean_edge_ns);
    const double more = mean_edge_ns / suggested_ns - 1;
    std::printf("\nOn this machine the mean edge costs %.0f %% %s time than the suggested cell size.\n",
                std::abs(more) * 100, more >= 0 ? "more" : "less");
    std::printf("The contacts are exact, and were the same under both in every frame.\n");
    std::printf("\nWith files of your own:  vox suggest MESH...   vox collide A B   vox --help\n");
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

    std::array<Contender, 2> contenders = {make_contender(balls, options.engine, suggestion.cell_size),
                                           make_contender(balls, options.engine, suggestion.rules.mean_edge)};
    for (const Contender& contender : contenders) check(vox_grid_step(contender.grid.get())); // warm up
    if (!options.json)
        std::printf("Two soft balls of %llu tetrahedra each (%llu vertices) wobble through each other.\n\n",
                    static_cast<unsigned long long>(balls[0].view.tet_count),
                    static_cast<unsigned long long>(balls[0].view.vertex_count));

    std::vector<Frame> frames;
    std::uint32_t busiest = 0;
    bool same_contacts = true;
    {
        Progress progress("frame", options.frames);
        for (std::uint32_t i = 0; i < options.frames; ++i) {
            progress.show(i + std::uint64_t{1});
            move(balls, time_of(i, options.frames));
            measure_frame(contenders);
            frames.push_back({contacts_of(contenders[0].grid.get()).count, median(contenders[0].profiles)});
            if (frames[i].contacts > frames[busiest].contacts) busiest = i;
            same_contacts &= hash_of(contenders[0].grid.get()) == hash_of(contenders[1].grid.get());
        }
    }
    if (!same_contacts)
        throw Failure("the contacts depend on the cell size: a defect of vox, please report it");

    const double suggested_ns = contenders[0].total_ns / options.frames;
    const double mean_edge_ns = contenders[1].total_ns / options.frames;
    if (!options.json) {
        print_frames(frames, frames[busiest].contacts);
        return print_comparison(suggestion, suggested_ns, mean_edge_ns);
    }

    Json json = {{"meshes", body_list(balls)}, {"frames", Json::array()}};
    for (std::uint32_t i = 0; i < options.frames; ++i)
        json["frames"].push_back(
            {{"frame", i}, {"contacts", frames[i].contacts}, {"step_ns", frames[i].profile.step_ns}});
    json["comparison"] = {
        {"suggested", {{"cell_size", number(suggestion.cell_size)}, {"step_ns", std::llround(suggested_ns)}}},
        {"mean_edge",
         {{"cell_size", number(suggestion.rules.mean_edge)}, {"step_ns", std::llround(mean_edge_ns)}}}};
    add_suggestion(json, suggestion);
    // The keys of collide speak of the frame with the most contacts.
    json["frame"] = busiest;
    move(balls, time_of(busiest, options.frames));
    check(vox_grid_step(contenders[0].grid.get()));
    add_collision(json, contenders[0].grid.get(), contenders[0].ids, frames[busiest].profile);
    print(json);
}

} // namespace

void add_demo(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("demo", "Two deforming bodies collide; needs no file");
    command->add_option("--tets", options->tets, "Tetrahedra of each body, about")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100000000}));
    command->add_option("--frames", options->frames, "Frames of the motion")->check(CLI::Range(1u, 1000000u));
    add_choice(*command, "--engine", options->engine, engines, "Algorithm");
    command->add_flag("--json", options->json, "Print one JSON object");
    command->callback([options] { run(*options); });
}

} // namespace tool
