// Regret: how much longer a step takes with the cell size that a rule chooses than with the best one of a
// fine sweep. Both engines, many scenes; the rules are the library's own cost models, a grid that chooses by
// itself, the paper's formula, the mean edge and the median box side.
#include "bodies.hpp"
#include "scenes.hpp"
#include "stopwatch.hpp"

#include <vox/vox.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {
namespace {

void must(vox_result result) {
    if (result != VOX_OK) throw std::runtime_error(vox_last_error());
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n == 0 ? 0 : n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

double quantile(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    const auto place = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
    return values.empty() ? 0 : values[std::min(std::max<std::size_t>(place, 1), values.size()) - 1];
}

// ---- scenes of unlike sizes -----------------------------------------------------------------------

// Frames of a body that stands at `place` and waves a little.
void add(Scene& scene, const Solid& solid, double scale, const Vec3& place, double radius,
         bool self = false) {
    Body body;
    for (int frame = 0; frame < 4; ++frame) {
        std::vector<float> positions;
        for (const Vec3& p : solid.positions) {
            const double a = 0.01 * radius, k = std::numbers::pi / radius, run = 0.1 * frame;
            positions.push_back(
                static_cast<float>(place.x + scale * p.x + a * std::sin(k * scale * p.y + run)));
            positions.push_back(
                static_cast<float>(place.y + scale * p.y + a * std::sin(k * scale * p.z + run + 1)));
            positions.push_back(
                static_cast<float>(place.z + scale * p.z + a * std::sin(k * scale * p.x + run + 2)));
        }
        positions.push_back(0);
        body.frames.push_back(std::move(positions));
    }
    body.positions = body.frames[0];
    body.tets = solid.tets;
    body.self_collision = self;
    scene.bodies.push_back(std::move(body));
}

// A ball whose tetrahedra get smaller towards its surface, or towards its centre.
Solid graded_ball(double tets, double power, std::uint64_t seed) {
    Solid ball = lattice_ball(tets, seed);
    const double radius = ball_radius(tets);
    for (Vec3& p : ball.positions) {
        const double r = std::hypot(p.x, p.y, p.z);
        if (r == 0) continue;
        const double factor = std::pow(r / radius, power - 1);
        p = {p.x * factor, p.y * factor, p.z * factor};
    }
    return ball;
}

Scene graded_pair(double tets, double power) {
    const double radius = ball_radius(tets / 2);
    Scene scene;
    add(scene, graded_ball(tets / 2, power, 1), 1, {0, 0, 0}, radius);
    add(scene, graded_ball(tets / 2, power, 2), 1, {1.8 * radius, 0.01 * radius, 0.02 * radius}, radius);
    return scene;
}

Scene graded_self(double tets, double power) {
    Scene scene;
    add(scene, graded_ball(tets, power, 1), 1, {0, 0, 0}, ball_radius(tets), true);
    return scene;
}

// A coarse ball and a fine one at its surface, with edges smaller by `ratio`.
Scene unlike_pair(double tets, double ratio) {
    const double coarse = ball_radius(tets / 3), fine = ball_radius(tets * 2 / 3) / ratio;
    Scene scene;
    const Vec3 place{0.37, 0.21, 0.73}; // not at the corner of a cell
    add(scene, lattice_ball(tets / 3, 1), 1, place, coarse);
    add(scene, lattice_ball(tets * 2 / 3, 2), 1 / ratio, {place.x + coarse - 0.3 * fine, place.y, place.z},
        fine);
    return scene;
}

double mean_edge(const Scene& scene) {
    double sum = 0, count = 0;
    for (const Body& body : scene.bodies)
        for (std::size_t t = 0; t < body.tets.size(); t += 4)
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < i; ++j, count += 1) {
                    const float* a = &body.positions[3 * body.tets[t + i]];
                    const float* b = &body.positions[3 * body.tets[t + j]];
                    sum += std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
                }
    return sum / count;
}

std::vector<SceneMaker> all_scenes(const std::string& meshes) {
    std::vector<SceneMaker> makers = scene_makers(meshes);
    // What rests costs the fast engine nothing, whatever the cell size.
    std::erase_if(makers, [](const SceneMaker& maker) { return maker.name.ends_with("-rest"); });
    const auto own = [&](const std::string& name, const std::string& title, auto make) {
        makers.push_back({name, title, true, [=](double tets, bool) {
                              Scene scene = make(tets);
                              scene.name = name;
                              scene.mean_edge = mean_edge(scene);
                              return scene;
                          }});
    };
    own("graded", "two balls, finer inside, 1:10", [](double n) { return graded_pair(n, 2); });
    own("graded-self", "one ball, finer inside, 1:10, self", [](double n) { return graded_self(n, 2); });
    own("graded-100", "two balls, finer inside, 1:100", [](double n) { return graded_pair(n, 3); });
    own("unlike-10", "two balls, edges 1:10", [](double n) { return unlike_pair(n, 10); });
    own("unlike-100", "two balls, edges 1:100", [](double n) { return unlike_pair(n, 100); });
    return makers;
}

// ---- timing ---------------------------------------------------------------------------------------

class Grid {
public:
    Grid(vox_engine engine, Scene& scene) : scene_(scene) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.engine = engine;
        desc.byte_budget = 0;
        must(vox_grid_create(&desc, &grid_));
        for (const vox_mesh_desc& mesh : descs(scene)) {
            vox_mesh id = 0;
            must(vox_mesh_insert(grid_, &mesh, &id));
        }
    }
    ~Grid() { vox_grid_destroy(grid_); }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    static std::vector<vox_mesh_desc> descs(const Scene& scene) {
        std::vector<vox_mesh_desc> descs;
        for (const Body& body : scene.bodies) {
            vox_mesh_desc desc = vox_default_mesh_desc();
            if (body.self_collision) desc.flags = VOX_MESH_SELF_COLLISION;
            desc.positions = body.positions.data();
            desc.vertex_count = body.vertex_count();
            desc.tets = body.tets.data();
            desc.tet_count = body.tet_count();
            descs.push_back(desc);
        }
        return descs;
    }

    // Seconds of a step at this cell size, in the mean over all frames, or a few rounds of them where they
    // are short; the first step is not counted. 0: the grid's own size, left as it is.
    double seconds(double cell_size) {
        if (cell_size > 0) must(vox_grid_set_cell_size(grid_, cell_size));
        step();
        double sum = 0;
        std::size_t count = 0;
        do {
            for (std::size_t frame = 0; frame < scene_.frame_count(); ++frame, ++count) {
                next_frame();
                sum += seconds_of([&] { must(vox_grid_step(grid_)); });
            }
        } while (sum < 2e-3);
        return sum / static_cast<double>(count);
    }

    double cell_size() const {
        double size = 0;
        must(vox_grid_cell_size(grid_, &size));
        return size;
    }

private:
    void next_frame() { scene_.pose(frame_ = (frame_ + 1) % scene_.frame_count()); }
    void step() {
        next_frame();
        must(vox_grid_step(grid_));
    }

    Scene& scene_;
    vox_grid* grid_ = nullptr;
    std::size_t frame_ = 0;
};

struct Row {
    std::string scene;
    std::string engine;
    std::size_t tets = 0;
    double best_seconds = 0, best_size = 0, suggest_seconds = 0, uniform_loss = 0; // sizes in mean edges
    std::map<std::string, double> size, regret;
};

const std::vector<std::string> rule_names = {"model", "grid", "mean edge", "paper", "median box"};

struct Settings {
    int sizes = 40, rounds = 9;
    double least = 0.2, most = 10;
};

Row measure(Scene& scene, vox_engine engine, const Settings& settings) {
    Row row;
    row.scene = scene.name;
    row.engine = engine == VOX_ENGINE_FAST ? "fast" : "reference";
    row.tets = scene.tet_count();
    scene.pose(0);

    const std::vector<vox_mesh_desc> meshes = Grid::descs(scene);
    vox_suggestion paper{}, model{};
    paper.struct_size = model.struct_size = sizeof(vox_suggestion);
    must(vox_suggest_cell_size(nullptr, meshes.data(), meshes.size(), &paper));
    vox_suggest_desc desc = vox_default_suggest_desc();
    desc.model = engine == VOX_ENGINE_FAST ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
    must(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &model));
    row.uniform_loss = model.uniform_loss;

    Grid fixed(engine, scene), own(engine, scene);
    row.suggest_seconds = seconds_of([&] { own.seconds(0); }); // with the first step, for what it is worth

    // The sweep: all sizes, fewer and fewer of them.
    struct Entry {
        double size;
        std::vector<double> times;
    };
    std::vector<Entry> sweep;
    for (int i = 0; i < settings.sizes; ++i)
        sweep.push_back({scene.mean_edge * settings.least *
                             std::pow(settings.most / settings.least, double(i) / (settings.sizes - 1)),
                         {}});
    const auto by_time = [](const Entry& a, const Entry& b) { return median(a.times) < median(b.times); };
    for (const std::size_t keep : {std::size_t{16}, std::size_t{10}, std::size_t{6}}) {
        // From the middle outwards: what is hopeless is not tried to the end.
        std::sort(sweep.begin(), sweep.end(), [&](const Entry& a, const Entry& b) {
            return std::abs(std::log(a.size / model.cell_size)) <
                   std::abs(std::log(b.size / model.cell_size));
        });
        double best = std::numeric_limits<double>::infinity();
        bool above = false, below = false; // sizes above, below are worse than three times the best
        for (Entry& entry : sweep) {
            if (entry.size > model.cell_size ? above : below) {
                entry.times.push_back(std::numeric_limits<double>::infinity());
                continue;
            }
            entry.times.push_back(fixed.seconds(entry.size));
            best = std::min(best, entry.times.back());
            if (entry.times.back() > 3 * best) (entry.size > model.cell_size ? above : below) = true;
        }
        std::sort(sweep.begin(), sweep.end(), by_time);
        sweep.resize(std::min(sweep.size(), keep));
    }

    // The rules beside the best of the sweep, in turns.
    std::map<std::string, Entry> rules;
    rules["model"].size = model.cell_size;
    rules["grid"].size = 0;
    rules["mean edge"].size = paper.rules.mean_edge;
    rules["paper"].size = paper.cell_size;
    rules["median box"].size = paper.rules.median_box_side;
    for (Entry& entry : sweep) entry.times.clear();
    for (int round = 0; round < settings.rounds; ++round) {
        for (Entry& entry : sweep) entry.times.push_back(fixed.seconds(entry.size));
        for (auto& [name, entry] : rules) {
            // Very bad ones need no second look.
            if (round > 2 && median(entry.times) > 3 * median(sweep[0].times)) continue;
            entry.times.push_back((entry.size > 0 ? fixed : own).seconds(entry.size));
        }
    }
    const Entry& best = *std::min_element(sweep.begin(), sweep.end(), by_time);
    row.best_seconds = median(best.times);
    row.best_size = best.size / scene.mean_edge;
    for (const auto& [name, entry] : rules) {
        row.size[name] = (entry.size > 0 ? entry.size : own.cell_size()) / scene.mean_edge;
        row.regret[name] = median(entry.times) / row.best_seconds - 1;
    }
    return row;
}

// ---- results --------------------------------------------------------------------------------------

void print_head(std::FILE* out) {
    std::fprintf(out, "engine,scene,tets,best_ms,best_size,uniform_loss");
    for (const std::string& name : rule_names)
        std::fprintf(out, ",%s size,%s regret", name.c_str(), name.c_str());
    std::fprintf(out, "\n");
}

void print(std::FILE* out, const Row& row) {
    std::fprintf(out, "%s,%s,%zu,%.4f,%.3f,%.3f", row.engine.c_str(), row.scene.c_str(), row.tets,
                 row.best_seconds * 1e3, row.best_size, row.uniform_loss);
    for (const std::string& name : rule_names)
        std::fprintf(out, ",%.3f,%.4f", row.size.at(name), row.regret.at(name));
    std::fprintf(out, "\n");
    std::fflush(out);
}

std::string summary(const std::vector<Row>& rows) {
    std::string text = "| engine | rule | median | 95th percentile | worst |\n|---|---|---|---|---|\n";
    for (const char* engine : {"reference", "fast"})
        for (const std::string& name : rule_names) {
            std::vector<double> regrets;
            for (const Row& row : rows)
                if (row.engine == engine) regrets.push_back(row.regret.at(name));
            if (regrets.empty()) continue;
            char line[160];
            std::snprintf(line, sizeof line, "| %s | %s | %.1f %% | %.1f %% | %.1f %% |\n", engine,
                          name.c_str(), 100 * median(regrets), 100 * quantile(regrets, 0.95),
                          100 * quantile(regrets, 1));
            text += line;
        }
    return text;
}

// A line for each scene: the best size of the sweep, the model's, and what each rule loses.
std::string details(const std::vector<Row>& rows) {
    std::string text = "| engine | scene | tets | best, ms | best size | model's size |";
    for (const std::string& name : rule_names) text += " " + name + " |";
    text += "\n|---|---|---|---|---|---|";
    for (std::size_t i = 0; i < rule_names.size(); ++i) text += "---|";
    text += "\n";
    for (const Row& row : rows) {
        char line[200];
        std::snprintf(line, sizeof line, "| %s | %s | %zu | %.3f | %.2f | %.2f |", row.engine.c_str(),
                      row.scene.c_str(), row.tets, row.best_seconds * 1e3, row.best_size,
                      row.size.at("model"));
        text += line;
        for (const std::string& name : rule_names) {
            std::snprintf(line, sizeof line, " %+.0f %% |", 100 * row.regret.at(name));
            text += line;
        }
        text += "\n";
    }
    return text;
}

// Puts the text between the two lines of a page that say where it goes.
void write_between(const std::string& path, const std::string& text) {
    const std::string begin = "<!-- bench/regret -->\n", end = "<!-- /bench/regret -->";
    std::ifstream in(path, std::ios::binary);
    std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::size_t from = page.find(begin), to = page.find(end);
    if (!in || from == std::string::npos || to == std::string::npos || to < from)
        throw std::runtime_error(path + " has no lines " + begin + "and " + end);
    page.replace(from + begin.size(), to - from - begin.size(), text);
    std::ofstream out(path, std::ios::binary);
    out << page;
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

int run(int argc, char** argv) {
    CLI::App app("Time lost by each rule for the cell size, against the best of a sweep");
    std::vector<double> tets = {5000, 40000};
    std::vector<std::string> engines = {"reference", "fast"}, scenes;
    std::string meshes, csv, page;
    Settings settings;
    bool calibrate = false;
    app.add_option("--tets", tets, "Tetrahedra of a scene")->delimiter(',');
    app.add_option("--engine", engines, "reference, fast")->delimiter(',');
    app.add_option("--scene", scenes, "Names of scenes; all by default")->delimiter(',');
    app.add_option("--meshes", meshes, "Folder with bunny.msh, cow.msh, armadillo.msh");
    app.add_option("--rounds", settings.rounds, "Turns of each rule and of the best sizes");
    app.add_option("--sizes", settings.sizes, "Cell sizes of the sweep")->check(CLI::Range(3, 1000));
    app.add_option("--csv", csv, "Write the rows here, too");
    app.add_option("--page", page, "Write the tables into this page, docs/cell-size.md");
    app.add_flag("--calibrate", calibrate, "Measure the weights first");
    CLI11_PARSE(app, argc, argv);
    if (calibrate) must(vox_cost_calibrate(nullptr));

    std::FILE* file = csv.empty() ? nullptr : std::fopen(csv.c_str(), "w");
    if (!csv.empty() && !file) throw std::runtime_error("cannot write " + csv);
    std::vector<Row> rows;
    print_head(stdout);
    if (file) print_head(file);
    for (const SceneMaker& maker : all_scenes(meshes)) {
        if (!scenes.empty() && std::find(scenes.begin(), scenes.end(), maker.name) == scenes.end()) continue;
        for (const double count : tets) {
            if (!maker.sized && count != tets.front()) continue;
            Scene scene = maker.make(count, false);
            for (const std::string& engine : engines) {
                rows.push_back(
                    measure(scene, engine == "fast" ? VOX_ENGINE_FAST : VOX_ENGINE_REFERENCE, settings));
                print(stdout, rows.back());
                if (file) print(file, rows.back());
            }
        }
    }
    std::printf("\n%s", summary(rows).c_str());
    if (file) std::fclose(file);
    if (!page.empty()) write_between(page, summary(rows) + "\n" + details(rows));
    return 0;
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    try {
        return bench::run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "regret: %s\n", error.what());
        return 1;
    }
}
