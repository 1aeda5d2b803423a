// vox demo: runs two_balls.hpp, as text or JSON.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "report.hpp"
#include "two_balls.hpp"

#include <algorithm>
#include <cmath>

namespace tool {

namespace {

struct DemoOptions {
    std::uint64_t tets = 20000;
    std::uint32_t frames = 12;
    bool json = false;
};

void print_demo_json(TwoBalls& balls) {
    Json meshes = Json::array(), frames = Json::array(), comparison = Json::array();
    for (const char* name : {"ball A", "ball B"})
        meshes.push_back({{"file", name}, {"vertices", balls.vertex_count()}, {"tets", balls.tet_count()}});
    const std::span<const Contender> contenders = balls.contenders();
    const std::span<const std::uint64_t> contacts = balls.contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i)
        frames.push_back({{"frame", i},
                          {"contacts", contacts[i]},
                          {"step_ns", contenders[0].frames[i]},
                          {"reference_step_ns", contenders[2].frames[i]}});
    for (const Contender& contender : contenders)
        comparison.push_back({{"engine", contender.engine},
                              {"rule", contender.rule},
                              {"cell_size", contender.cell_size},
                              {"step_ns", std::llround(contender.mean_step_ns())}});
    Json json = {{"meshes", meshes}, {"frames", frames}, {"comparison", comparison}};
    add_suggestion(json, balls.suggestion(), VOX_COST_MODEL_PAPER, balls.geometry());
    // The keys shared with collide describe the frame with the most contacts.
    const auto busiest =
        static_cast<std::uint32_t>(std::max_element(contacts.begin(), contacts.end()) - contacts.begin());
    json.add("frame", busiest);
    balls.show(busiest);
    add_collision(json, contenders[0].grid.get(), contenders[0].ids, counters_of(contenders[0].grid.get()));
    print(json);
}

void run_demo(const DemoOptions& options) {
    vox_io_mesh* made = nullptr;
    check(vox_io_make_lattice_ball(options.tets, 1, &made));
    const Mesh mesh(made);
    vox_io_mesh_view view{};
    check(vox_io_mesh_get_arrays(made, &view));
    TwoBalls balls({view.positions, 3 * view.vertex_count}, {view.tets, 4 * view.tet_count});
    if (!options.json) balls.print_balls();
    balls.run(options.frames);
    options.json ? print_demo_json(balls) : balls.print_results("vox");
}

} // namespace

void add_demo(CommandLine& line) {
    const auto options = std::make_shared<DemoOptions>();
    Command command = line.add("demo", "Two deforming bodies collide; needs no file");
    command.option("--tets", options->tets, "Approximate number of tetrahedra of each body")
        .range(1, 100000000);
    command.option("--frames", options->frames, "Number of frames").range(1, 1000000);
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox demo\n  vox demo --tets 100000 --frames 5");
    command.runs([options] { run_demo(*options); });
}

} // namespace tool
