#include "experiment/experiment.hpp"

#include "failure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <time.h>

namespace tool {

namespace {

// Nanoseconds in which this thread had a processor; where the system does not count them, those that passed.
double thread_nanoseconds() {
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec now{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0)
        return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
#endif
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value / static_cast<double>(values.size());
    return sum;
}

} // namespace

vox_sim_desc ExperimentSettings::default_sim() {
    vox_sim_desc desc = vox_default_sim_desc();
    std::fill_n(desc.floor_normal, 3, 0.0);
    desc.detect_every = desc.substeps; // detects once a frame, as in the paper
    return desc;
}

// ---- placing and recording --------------------------------------------------------------------------

Experiment::Experiment(const ExperimentSettings& settings, ExperimentBody a, ExperimentBody b)
    : bodies_{std::move(a), std::move(b)} {
    place_and_record(settings);
    vox_grid_desc desc = settings.grid;
    one_thread_ = desc.worker_count <= 1;
    grid_ = make_grid(desc, mesh_descs(frames_.front()), meshes_);
}

// The response pushes the bodies apart, so that later frames have fewer tets in contact than the first.
// Therefore the share of the first frame is corrected until the mean is the required one.
void Experiment::place_and_record(const ExperimentSettings& settings) {
    if (!settings.as_placed) {
        turn_first(bodies_[0].positions);
        turn_second(bodies_[1].positions);
    }
    const Point a = bounds_of(bodies_[0].positions).centre(), b = bounds_of(bodies_[1].positions).centre();
    move(bodies_[1].positions, {a[0] - b[0], a[1] - b[1], a[2] - b[2]});

    const std::vector<double>& to = settings.axis;
    const double length = std::hypot(to[0], to[1], to[2]), wanted = settings.contact_share;
    const Point axis = {to[0] / length, to[1] / length, to[2] / length};
    const ExperimentBody centred = bodies_[1];
    ContactShare share(bodies_[0], centred);

    double first = wanted, least_error = HUGE_VAL;
    for (int attempt = 0; attempt < 5 && least_error > 0.02; ++attempt) {
        double distance;
        try {
            distance = place_at_share(share, bodies_[0], centred, axis, first);
        } catch (const Failure&) {
            if (frames_.empty()) throw;
            break; // the required share can be reached, but not the corrected one
        }
        ExperimentBody placed = centred;
        move(placed.positions, {distance * axis[0], distance * axis[1], distance * axis[2]});
        std::vector<Frame> frames = record(settings, placed);
        std::vector<double> shares;
        for (const Frame& frame : frames) shares.push_back(frame.share);
        const double reached = mean(shares), error = std::abs(reached / wanted - 1);
        if (error < least_error) {
            least_error = error;
            distance_ = distance;
            frames_ = std::move(frames);
            shares_ = std::move(shares);
        }
        first *= std::clamp(wanted / reached, 0.25, 4.0);
        if (!(first < 1)) break;
    }
}

std::vector<Experiment::Frame> Experiment::record(const ExperimentSettings& settings,
                                                  const ExperimentBody& b) const {
    vox_sim* created = nullptr;
    check(vox_sim_create(&settings.sim, &created));
    const std::unique_ptr<vox_sim, decltype(&vox_sim_destroy)> sim(created, &vox_sim_destroy);
    vox_sim_body_view views[2] = {};
    for (int i = 0; i < 2; ++i) {
        const ExperimentBody& body = i == 0 ? bodies_[0] : b;
        vox_sim_body_desc desc = vox_default_sim_body_desc();
        desc.positions = body.positions.data();
        desc.vertex_count = body.positions.size() / 3;
        desc.tets = body.tets.data();
        desc.tet_count = body.tets.size() / 4;
        vox_body id = VOX_NULL_BODY;
        check(vox_sim_body_insert(sim.get(), &desc, &id));
        check(vox_sim_body_get_view(sim.get(), id, &views[i]));
    }
    vox_grid* grid = nullptr;
    check(vox_sim_get_grid(sim.get(), &grid));

    std::vector<Frame> frames(settings.frames);
    for (Frame& frame : frames) {
        // A step begins with the detection, which uses the present positions.
        for (int i = 0; i < 2; ++i)
            frame.positions[i].assign(views[i].grid_positions,
                                      views[i].grid_positions + 3 * views[i].vertex_count);
        check(vox_sim_step(sim.get(), settings.time_step));
        frame.hash = hash_of(grid);
        frame.contacts = contacts_of(grid).size();
        frame.share = share_in_contact(grid, tets());
    }
    return frames;
}

std::uint64_t Experiment::contacts() const {
    std::uint64_t sum = 0;
    for (const Frame& frame : frames_) sum += frame.contacts;
    return sum;
}

// FNV-1a, applied to whole numbers instead of bytes.
std::uint64_t Experiment::hash() const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const Frame& frame : frames_) hash = (hash ^ frame.hash) * 0x100000001b3u;
    return hash;
}

double Experiment::mean_share() const { return mean(shares_); }

Bounds Experiment::bounds() const {
    std::vector<double> all;
    for (const Frame& frame : frames_)
        for (const std::vector<float>& positions : frame.positions)
            all.insert(all.end(), positions.begin(), positions.end());
    return bounds_of(all);
}

// ---- measuring --------------------------------------------------------------------------------------

std::array<vox_mesh_desc, 2> Experiment::mesh_descs(const Frame& frame) const {
    return {mesh_of(frame.positions[0], bodies_[0].tets), mesh_of(frame.positions[1], bodies_[1].tets)};
}

vox_cell_size_result Experiment::suggest(const vox_cell_size_desc& desc) const {
    const std::array<vox_mesh_desc, 2> meshes = mesh_descs(frames_.front());
    auto result = sized<vox_cell_size_result>();
    check(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &result));
    return result;
}

vox_geometry Experiment::geometry() const {
    const std::array<vox_mesh_desc, 2> meshes = mesh_descs(frames_.front());
    auto geometry = sized<vox_geometry>();
    check(vox_measure_geometry(meshes.data(), meshes.size(), &geometry));
    return geometry;
}

double Experiment::step(const Frame& frame) {
    for (std::size_t body = 0; body < 2; ++body)
        check(vox_mesh_bind_floats(grid_.get(), meshes_[body], frame.positions[body].data(),
                                   frame.positions[body].size() / 3));
    const auto begin = std::chrono::steady_clock::now();
    const double thread_begin = thread_nanoseconds();
    check(vox_grid_step(grid_.get()));
    const double used = thread_nanoseconds() - thread_begin;
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - begin;
    return one_thread_ && used < passed.count() ? used / passed.count() : 1;
}

SweepSample Experiment::measure(double cell_size) {
    check(vox_grid_set_cell_size(grid_.get(), cell_size));
    step(frames_.back()); // not timed; allocates memory for this cell size, with another frame than the next

    SweepSample sample;
    sample.cell_size = cell_size;
    for (const Frame& frame : frames_) {
        const double share = step(frame);
        if (hash_of(grid_.get()) != frame.hash) {
            char text[128];
            std::snprintf(text, sizeof text,
                          "frame %zu: the contacts at cell size %.9g differ from those of the simulation",
                          sample.frame_ns.size(), cell_size);
            throw Failure(text);
        }
        const Counters counters = counters_of(grid_.get());
        const auto count = [&](const char* name) { return value_of(counters, name); };
        const std::uint64_t passed =
            count("bin_ns") + count("broad_ns") + count("narrow_ns") + count("contacts_ns");
        sample.frame_ns.push_back(
            static_cast<std::uint64_t>(std::llround(share * static_cast<double>(passed))));
        sample.contacts += count("contacts");
        sample.visited_cells += count("visited_cells");
        sample.visited_entries += count("visited_entries");
        sample.candidates += count("candidates");
    }
    return sample;
}

} // namespace tool
