// Regret: how much longer a step takes with the cell size that a rule chooses than with the best one of a
// fine sweep. Both engines, many scenes; the rules are the library's own cost models, a grid that chooses by
// itself, the paper's formula, the mean edge and the median box side. bench/cell_size/regret.py makes tables
// of it.
//
// The best of forty noisy times is too good to be true (the winner's curse), and every rule then seems to
// lose by the noise. So the sweep only names the candidates: its curve is smoothed, and the sizes around its
// least value are timed again, in turns with those of the rules. In each round every size has one turn, over
// the same frames, and counts by its time over that of the best in the same round, which takes out what makes
// the whole machine slower for a while. Which candidate is the best is decided by one half of the rounds and
// how much the rules lose by the other half, and the other way round: a candidate that was only lucky in one
// half is not so in the other. The model's size has two turns in each round; by how much they differ in the
// end is the noise of a figure.
#include "cell_size/unlike.hpp"
#include "program.hpp"
#include "scenes.hpp"
#include "scenes/engines.h"
#include "timing.h"

#include <vox/vox_cell_size.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {
namespace {

// ---- scenes ---------------------------------------------------------------------------------------

std::vector<SceneMaker> all_scenes(const std::string& meshes) {
    std::vector<SceneMaker> makers = scene_makers(meshes);
    // What rests costs the fast engine nothing, whatever the cell size.
    std::erase_if(makers, [](const SceneMaker& maker) { return maker.name.ends_with("-rest"); });
    std::ranges::move(unlike_scenes(), std::back_inserter(makers));
    if (meshes.empty()) return makers;
    for (const std::string body : {"sphere01", "sphere02", "sphere03", "sphere04", "sphere05", "bunny", "cow",
                                   "armadillo"}) { // the paper's pairs
        const std::string name = "paper-" + body, path = meshes + "/" + body + ".msh";
        makers.push_back({name, body + " pair, 1 % of tets in contact", false, [=](double, bool) {
                              Scene scene = pair_from_file(path, 0.01);
                              scene.name = name;
                              return scene;
                          }});
    }
    return makers;
}

// ---- timing ---------------------------------------------------------------------------------------

class Grid {
public:
    Grid(engine_kind engine, Scene& scene, std::uint32_t flags) : scene_(scene) {
        vox_grid_desc desc = vox_default_grid_desc();
        use_engine(&desc, engine);
        desc.flags = flags;
        desc.byte_budget = UINT64_MAX;
        must(vox_grid_create(&desc, &grid_));
        for (const vox_mesh_desc& mesh : descs(scene)) {
            vox_body id = 0;
            must(vox_mesh_insert(grid_, &mesh, &id));
        }
    }
    ~Grid() { vox_grid_destroy(grid_); }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    static std::vector<vox_mesh_desc> descs(const Scene& scene) {
        std::vector<vox_mesh_desc> descs;
        for (const Body& body : scene.bodies) descs.push_back(body.desc());
        return descs;
    }

    // Seconds of a step at this cell size (0: the grid's own choice), averaged over the frames of a turn.
    // A turn always has the same frames; its first step is not counted.
    double turn(double cell_size) {
        must(vox_grid_set_cell_size(grid_, cell_size));
        frame_ = 0;
        scene_.pose(frame_);
        must(vox_grid_step(grid_));
        double sum = 0;
        for (std::size_t i = 0; i < steps_; ++i) {
            scene_.pose(frame_ = (frame_ + 1) % scene_.frame_count());
            sum += seconds_of([&] { must(vox_grid_step(grid_)); });
        }
        return sum / static_cast<double>(steps_);
    }

    // As many steps a turn as it takes to measure well.
    void set_turn(double seconds_a_step) {
        steps_ = seconds_a_step > 0.02
                     ? 1
                     : std::max(scene_.frame_count(), static_cast<std::size_t>(2e-3 / seconds_a_step) + 1);
    }

    double cell_size() const {
        vox_grid_info info;
        info.struct_size = sizeof info;
        must(vox_grid_get_info(grid_, &info));
        return info.cell_size;
    }

    struct Suggestion {
        double step_seconds, steps;  // of a step, and the suggestion's time over it: medians
        vox_cell_size_result answer; // the last one
    };
    // Of some: the first ones are slower, the code and what it reads being far away.
    Suggestion suggest(int times) {
        Suggestion result{};
        std::vector<double> steps, ratios;
        for (int i = 0; i < times; ++i) {
            steps.push_back(turn(0));
            result.answer.struct_size = sizeof result.answer;
            const double seconds =
                seconds_of([&] { must(vox_grid_suggest_cell_size(grid_, nullptr, &result.answer)); });
            ratios.push_back(seconds / steps.back());
        }
        result.step_seconds = median(steps);
        result.steps = median(ratios);
        return result;
    }

    // The time of the first one, which looks at the meshes, over that of a step.
    double first_suggestion() {
        const double step = turn(0);
        vox_cell_size_result answer;
        answer.struct_size = sizeof answer;
        return seconds_of([&] { must(vox_grid_suggest_cell_size(grid_, nullptr, &answer)); }) / step;
    }

private:
    Scene& scene_;
    vox_grid* grid_ = nullptr;
    std::size_t frame_ = 0, steps_ = 4;
};

// ---- the sweep ------------------------------------------------------------------------------------

struct Settings {
    double sizes = 40; // of a sweep from 0.2 to 10 mean edges
    double seconds = 10;
    int least_rounds = 6, most_rounds = 40;
    vox_cost_weights weights{}; // all 0: those shipped
};

struct Sample {
    double size, seconds;
    double predicted = 0; // seconds
};

constexpr double least = 0.2, most = 10;
// A size that takes so many times the best is the last one on its side.
constexpr double hopeless = 5;

// From 0.2 mean edges of the finest body to 10 of the coarsest.
std::vector<double> sweep_sizes(const Scene& scene, double sizes) {
    double finest = scene.mean_edge, coarsest = scene.mean_edge;
    for (const Body& body : scene.bodies) {
        finest = std::min(finest, mean_edge({&body, 1}));
        coarsest = std::max(coarsest, mean_edge({&body, 1}));
    }
    const double ratio = std::pow(most / least, 1 / (sizes - 1));
    std::vector<double> list;
    for (double size = least * finest; size < most * coarsest * std::sqrt(ratio); size *= ratio)
        list.push_back(size);
    return list;
}

// Outwards from `start`.
std::vector<Sample> sweep(Grid& grid, const std::vector<double>& sizes, double start) {
    std::vector<Sample> samples;
    const auto middle = std::lower_bound(sizes.begin(), sizes.end(), start);
    double best = std::numeric_limits<double>::infinity();
    const auto try_size = [&](double size) {
        double seconds = grid.turn(size);
        if (seconds < 0.1) seconds = std::min(seconds, grid.turn(size));
        samples.push_back({size, seconds, 0});
        best = std::min(best, seconds);
        return seconds <= hopeless * best;
    };
    for (auto size = middle; size != sizes.end() && try_size(*size);) ++size;
    for (auto size = middle; size != sizes.begin() && try_size(*(size - 1));) --size;
    std::sort(samples.begin(), samples.end(),
              [](const Sample& a, const Sample& b) { return a.size < b.size; });
    return samples;
}

// The value at sample i of the parabola through it and three neighbours on either side, in logarithms: local
// regression (W. S. Cleveland, 1979) without weights.
double smoothed(const std::vector<Sample>& samples, std::size_t i) {
    const std::size_t first = i > 3 ? i - 3 : 0, last = std::min(i + 4, samples.size());
    // Normal equations in powers of x, the distance from sample i: the value there is the constant.
    double a[3][4] = {};
    for (std::size_t j = first; j < last; ++j) {
        const double x = std::log(samples[j].size / samples[i].size), y = std::log(samples[j].seconds);
        const double power[3] = {1, x, x * x};
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) a[r][c] += power[r] * power[c];
            a[r][3] += power[r] * y;
        }
    }
    if (last - first < 4) return std::log(samples[i].seconds);
    for (int p = 0; p < 3; ++p) // positive definite: no pivoting
        for (int r = 0; r < 3; ++r) {
            if (r == p) continue;
            const double factor = a[r][p] / a[p][p];
            for (int c = p; c < 4; ++c) a[r][c] -= factor * a[p][c];
        }
    return a[0][3] / a[0][0];
}

// Those that may be the best: the four of the least smoothed times, and the one of the least time.
std::vector<double> candidates(const std::vector<Sample>& samples) {
    std::vector<std::pair<double, std::size_t>> order;
    std::size_t quickest = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        order.emplace_back(smoothed(samples, i), i);
        if (samples[i].seconds < samples[quickest].seconds) quickest = i;
    }
    std::sort(order.begin(), order.end());
    std::set<std::size_t> chosen{quickest};
    for (std::size_t i = 0; i < std::min<std::size_t>(4, order.size()); ++i) chosen.insert(order[i].second);
    std::vector<double> sizes;
    for (const std::size_t i : chosen) sizes.push_back(samples[i].size);
    return sizes;
}

// ---- the rules ------------------------------------------------------------------------------------

constexpr std::array rules = {"model", "grid", "mean_edge", "paper", "median_box"};

struct Row {
    std::string engine, scene;
    double asked = 0; // tetrahedra; 0: those of a file
    std::size_t tets = 0, rounds = 0;
    double best_seconds = 0, best_size = 0; // sizes in mean edges
    double noise = 0, suggest_steps = 0;
    std::array<double, rules.size()> size{}, regret{};
};

// Times of a size, a turn each.
struct Contender {
    double size;
    std::vector<double> seconds;

    std::vector<double> half(std::size_t which) const {
        std::vector<double> part;
        for (std::size_t i = which; i < seconds.size(); i += 2) part.push_back(seconds[i]);
        return part;
    }
};

double ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
    return median(ratios);
}

// The candidate of the least time in one half of the rounds.
const Contender& best_of(const std::vector<Contender>& candidates, std::size_t half) {
    const auto beside_first = [&](const Contender& c) {
        return ratio(c.half(half), candidates[0].half(half));
    };
    return *std::min_element(
        candidates.begin(), candidates.end(),
        [&](const Contender& a, const Contender& b) { return beside_first(a) < beside_first(b); });
}

// The cost that a suggestion predicts at a cell size, from its curve; 0 beyond its ends.
double predicted(const vox_cell_size_result& suggestion, double size) {
    for (std::uint32_t i = 1; i < suggestion.curve_count; ++i) {
        const vox_cost_sample &a = suggestion.curve[i - 1], &b = suggestion.curve[i];
        if (size < a.cell_size || size > b.cell_size) continue;
        const double part = std::log(size / a.cell_size) / std::log(b.cell_size / a.cell_size);
        return a.cost * std::pow(b.cost / a.cost, part);
    }
    return 0;
}

Row measure(Scene& scene, engine_kind engine, const Settings& settings, std::vector<Sample>& curve) {
    Row row;
    row.scene = scene.name;
    row.engine = engine == ENGINE_FAST ? "fast" : "reference";
    row.tets = scene.tet_count();
    scene.pose(0);

    const std::vector<vox_mesh_desc> meshes = Grid::descs(scene);
    vox_cell_size_result paper{}, model{};
    paper.struct_size = model.struct_size = sizeof(vox_cell_size_result);
    must(vox_suggest_cell_size(nullptr, meshes.data(), meshes.size(), &paper));
    vox_geometry geometry{};
    geometry.struct_size = sizeof geometry;
    must(vox_measure_geometry(meshes.data(), meshes.size(), &geometry));
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = engine == ENGINE_FAST ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
    desc.weights = &settings.weights;
    must(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &model));

    // All sizes in one grid: memory at other addresses alone changes times by per cents.
    Grid grid(engine, scene, 0); // contacts alone
    grid.set_turn(grid.turn(model.cell_size));
    curve = sweep(grid, sweep_sizes(scene, settings.sizes), model.cell_size);
    for (Sample& sample : curve) sample.predicted = predicted(model, sample.size);
    std::vector<Contender> best;
    for (const double size : candidates(curve)) best.push_back({size, {}});
    std::array<Contender, rules.size()> rule = {
        Contender{model.cell_size, {}}, Contender{0, {}}, Contender{geometry.mean_edge, {}},
        Contender{paper.cell_size, {}}, Contender{geometry.median_box_side, {}}};
    Contender again{model.cell_size, {}};

    std::vector<Contender*> all{&again};
    for (Contender& c : best) all.push_back(&c);
    for (Contender& c : rule) all.push_back(&c);
    double spent = 0;
    for (int round = 0; round < settings.most_rounds; ++round) {
        if (round >= settings.least_rounds && round % 2 == 0 && spent > settings.seconds) break;
        // Another one begins in each round, so that none always comes after the same one's end.
        std::rotate(all.begin(), all.begin() + 1, all.end());
        spent += seconds_of([&] {
            for (Contender* c : all) {
                // A hopeless one need not be timed again and again.
                const bool known = c->seconds.size() > 1 && c->seconds[1] > hopeless * best[0].seconds[0];
                c->seconds.push_back(known ? c->seconds[1] : grid.turn(c->size));
            }
        });
    }
    row.rounds = again.seconds.size();
    row.noise = std::abs(ratio(again.seconds, rule[0].seconds) - 1);
    for (std::size_t half = 0; half < 2; ++half) {
        const Contender& found = best_of(best, half);
        const std::size_t other = 1 - half;
        row.best_seconds += median(found.half(other)) / 2;
        row.best_size += found.size / scene.mean_edge / 2;
        for (std::size_t i = 0; i < rules.size(); ++i)
            row.regret[i] += (ratio(rule[i].half(other), found.half(other)) - 1) / 2;
    }
    grid.turn(0);
    for (std::size_t i = 0; i < rules.size(); ++i)
        row.size[i] = (rule[i].size > 0 ? rule[i].size : grid.cell_size()) / scene.mean_edge;
    row.suggest_steps = Grid(engine, scene, vox_default_grid_desc().flags).suggest(5).steps;
    return row;
}

// ---- suggestions alone ----------------------------------------------------------------------------

// Seconds of vox_suggest_cell_size: the least of some, of which the first ones fault in their memory.
double seconds_of_call(const vox_cell_size_desc& desc, const std::vector<vox_mesh_desc>& meshes,
                       vox_cell_size_result& answer) {
    double least = std::numeric_limits<double>::infinity();
    answer.struct_size = sizeof answer;
    for (int i = 0; i < 9; ++i)
        least = std::min(least, seconds_of([&] {
                             must(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &answer));
                         }));
    return least;
}

// What suggestions cost: of vox_suggest_cell_size, for the paper's model and the engine's; in a grid with
// constraints, and without, the first one and later ones, in steps. And how far the grid's is from the
// former: the cost at its size over the least one, both by what vox_suggest_cell_size has looked at.
std::string suggestions(Scene& scene, engine_kind engine) {
    scene.pose(0);
    const std::vector<vox_mesh_desc> meshes = Grid::descs(scene);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = engine == ENGINE_FAST ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
    vox_cell_size_result model{};
    const vox_cell_size_desc paper = vox_default_cell_size_desc();
    const double paper_seconds = seconds_of_call(paper, meshes, model);
    const double model_seconds = seconds_of_call(desc, meshes, model);
    char calls[80];
    std::snprintf(calls, sizeof calls, ",%.1f,%.1f", paper_seconds * 1e6, model_seconds * 1e6);
    std::string text = "," + std::to_string(scene.tet_count()) + calls;
    for (const std::uint32_t flags : {std::uint32_t{VOX_GRID_CONSTRAINTS}, std::uint32_t{0}}) {
        const Grid::Suggestion found = Grid(engine, scene, flags).suggest(15);
        const double size = found.answer.cell_size;
        std::vector<double> first;
        for (int i = 0; i < 3; ++i) first.push_back(Grid(engine, scene, flags).first_suggestion());
        char part[120];
        std::snprintf(part, sizeof part, ",%.2f,%.3f,%.3f,%.3f,%.3f", found.step_seconds * 1e6, found.steps,
                      median(first), size / model.cell_size, predicted(model, size) / model.cost - 1);
        text += part;
    }
    return text + "\n";
}

std::string suggestions_head() {
    return "engine,scene,asked,tets,paper_us,model_us,step_us,suggest_steps,first_steps,size_ratio,loss,"
           "bare_step_us,bare_suggest_steps,bare_first_steps,bare_size_ratio,bare_loss\n";
}

// ---- results --------------------------------------------------------------------------------------

std::string key(const std::string& engine, const std::string& scene, double asked) {
    std::ostringstream text;
    text << engine << ',' << scene << ',' << static_cast<std::uint64_t>(asked);
    return text.str();
}

std::string head() {
    std::string text = "engine,scene,asked,tets,rounds,best_ms,best_size,noise,suggest_steps";
    for (const std::string rule : rules) text += "," + rule + "_size," + rule + "_regret";
    return text + "\n";
}

std::string line(const Row& row) {
    char text[160];
    std::snprintf(text, sizeof text, ",%zu,%zu,%.5f,%.4f,%.4f,%.3f", row.tets, row.rounds,
                  row.best_seconds * 1e3, row.best_size, row.noise, row.suggest_steps);
    std::string all = key(row.engine, row.scene, row.asked) + text;
    for (std::size_t i = 0; i < rules.size(); ++i) {
        std::snprintf(text, sizeof text, ",%.4f,%.4f", row.size[i], row.regret[i]);
        all += text;
    }
    return all + "\n";
}

// The rows that a file has: engine, scene and size of each.
std::set<std::string> rows_of(const std::string& path) {
    std::set<std::string> found;
    std::ifstream in(path);
    for (std::string row; std::getline(in, row);) {
        std::size_t end = 0;
        for (int i = 0; i < 3 && end != std::string::npos; ++i) end = row.find(',', end + (i > 0));
        found.insert(row.substr(0, end));
    }
    return found;
}

void append(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::app | std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

int run(int argc, char** argv) {
    CLI::App app("Time lost by each rule for the cell size, against the best of a sweep");
    std::vector<double> tets = {5000, 40000};
    std::vector<std::string> engines = {"reference", "fast"}, scenes;
    std::string meshes, csv, curves;
    double most_tets = std::numeric_limits<double>::infinity(), stop_after = most_tets;
    Settings settings;
    bool calibrate = false, only_suggest = false;
    app.add_option("--tets", tets, "Tetrahedra of a scene")->delimiter(',');
    app.add_option("--max-tets", most_tets, "Leave out the files' scenes of more");
    app.add_option("--engine", engines, "reference, fast")->delimiter(',');
    app.add_option("--scenes", scenes, "Names of scenes; all by default")->delimiter(',');
    app.add_option("--meshes", meshes, "Folder with the paper's bodies as Gmsh files");
    app.add_option("--seconds", settings.seconds, "To compare the rules, for each scene and engine");
    app.add_option("--rounds", settings.most_rounds, "Most turns of each size")->check(CLI::Range(4, 1000));
    app.add_option("--sizes", settings.sizes, "Cell sizes from 0.2 to 10 mean edges")
        ->check(CLI::Range(3, 1000));
    app.add_option("--csv", csv, "Append the rows to this file; what it has is not measured again");
    app.add_option("--curves", curves, "Append the sweeps to this file");
    app.add_option("--stop-after", stop_after, "Begin no scene after so many seconds");
    app.add_flag("--calibrate", calibrate, "Measure the weights first");
    app.add_flag("--suggestions", only_suggest,
                 "Measure what suggestions cost, and nothing else; --csv makes rows of their own kind");
    CLI11_PARSE(app, argc, argv);
    settings.least_rounds = std::min(settings.least_rounds, settings.most_rounds);
    settings.weights.struct_size = sizeof settings.weights;
    if (calibrate) must(vox_cost_calibrate(&settings.weights));

    const std::set<std::string> done = csv.empty() ? std::set<std::string>{} : rows_of(csv);
    const std::string title = only_suggest ? suggestions_head() : head();
    if (!csv.empty() && done.empty()) append(csv, title);
    std::printf("%s", title.c_str());
    double spent = 0;
    for (const SceneMaker& maker : all_scenes(meshes)) {
        if (!scenes.empty() && std::find(scenes.begin(), scenes.end(), maker.name) == scenes.end()) continue;
        for (const double count : tets) {
            if (!maker.sized && count != tets.front()) continue;
            const double asked = maker.sized ? count : 0;
            std::vector<std::string> left;
            for (const std::string& engine : engines)
                if (!done.count(key(engine, maker.name, asked))) left.push_back(engine);
            if (left.empty() || spent > stop_after) continue;
            spent += seconds_of([&] {
                Scene scene = maker.make(count, false);
                if (static_cast<double>(scene.tet_count()) > most_tets) return;
                for (const std::string& engine : left) {
                    std::vector<Sample> curve;
                    Row row{};
                    std::string text = key(engine, scene.name, asked);
                    const engine_kind kind = engine == "fast" ? ENGINE_FAST : ENGINE_REFERENCE;
                    if (only_suggest) {
                        text += suggestions(scene, kind);
                    } else {
                        row = measure(scene, kind, settings, curve);
                        row.asked = asked;
                        text = line(row);
                    }
                    std::printf("%s", text.c_str());
                    std::fflush(stdout);
                    if (!csv.empty()) append(csv, text);
                    for (const Sample& s : curve) {
                        if (curves.empty()) break;
                        char text[120];
                        std::snprintf(text, sizeof text, ",%.5f,%.6f,%.6f\n", s.size / scene.mean_edge,
                                      s.seconds * 1e3, s.predicted * 1e3);
                        append(curves, key(row.engine, row.scene, row.asked) + text);
                    }
                }
            });
        }
    }
    return 0;
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    return bench::run_program("regret", [&] { return bench::run(argc, argv); });
}
