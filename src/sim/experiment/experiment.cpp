// Two bodies in contact are simulated once, and every sample detects the contacts of the recorded frames.
// This is equivalent to the paper's experiment, without the time of the solver, since contacts and therefore
// the motion are the same for every cell size.
#include "sim/experiment/experiment.hpp"

#include "base/border.hpp"
#include "base/clock.hpp"
#include "base/structs.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>

using namespace vox;
using namespace vox::sim;

namespace {

vox_sim_body_desc read_body(const vox_sim_body_desc* body, const char* name) {
    const vox_sim_body_desc desc = read_struct(body, name);
    if (desc.vertex_count == 0 || desc.tet_count == 0 || !desc.positions || !desc.tets)
        refuse(format("%s has %" PRIu64 " vertices%s and %" PRIu64 " tets%s, expected some of both", name,
                      desc.vertex_count, desc.positions ? "" : " (null)", desc.tet_count,
                      desc.tets ? "" : " (null)"));
    if (desc.vertex_count > VOX_MAX_VERTICES || desc.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT,
                    format("%s has %" PRIu64 " vertices and %" PRIu64 " tets, the limits are %u, %u", name,
                           desc.vertex_count, desc.tet_count, VOX_MAX_VERTICES, VOX_MAX_TETS));
    for (std::size_t i = 0; i < 3 * desc.vertex_count; ++i)
        if (!(std::abs(desc.positions[i]) <= 1e15))
            throw Error(VOX_ERROR_NON_FINITE,
                        format("%s: vertex %zu has coordinate %.9g, expected -1e15 to 1e15", name, i / 3,
                               desc.positions[i]));
    return desc;
}

// The settings of the motion: the caller's, or vox_sim's defaults without a floor.
vox_sim_desc sim_settings(const vox_sim_desc* given) {
    vox_sim_desc desc = vox_default_sim_desc();
    if (given)
        desc = read_struct(given, "desc.sim");
    else
        std::fill_n(desc.floor_normal, 3, 0.0);
    desc.detect_every = desc.substeps; // detects once a frame, as in the paper
    return desc;
}

// FNV-1a, applied to whole numbers instead of bytes.
std::uint64_t mix(std::uint64_t hash, std::uint64_t number) { return (hash ^ number) * 0x100000001b3u; }
constexpr std::uint64_t mix_start = 0xcbf29ce484222325u;

} // namespace

// ---- placing and recording --------------------------------------------------------------------------

vox_experiment::vox_experiment(const vox_experiment_desc& desc) {
    vox_sim_body_desc bodies[2] = {read_body(desc.a, "desc.a"),
                                   desc.b ? read_body(desc.b, "desc.b") : read_body(desc.a, "desc.a")};
    for (int i = 0; i < 2; ++i) {
        shapes_[i].positions.assign(bodies[i].positions, bodies[i].positions + 3 * bodies[i].vertex_count);
        shapes_[i].tets.assign(bodies[i].tets, bodies[i].tets + 4 * bodies[i].tet_count);
    }
    place_and_record(desc, bodies);
    make_grid(desc.grid);
}

// The response pushes the bodies apart, so that later frames have fewer tets in contact than the first.
// Therefore the share of the first frame is corrected until the mean is the required one.
void vox_experiment::place_and_record(const vox_experiment_desc& desc, vox_sim_body_desc (&bodies)[2]) {
    if (desc.turn) {
        turn_first(shapes_[0].positions);
        turn_second(shapes_[1].positions);
    }
    const Point a = bounds_of(shapes_[0].positions).centre(), b = bounds_of(shapes_[1].positions).centre();
    move(shapes_[1].positions, {a[0] - b[0], a[1] - b[1], a[2] - b[2]});

    const double length = std::hypot(desc.axis[0], desc.axis[1], desc.axis[2]);
    const Point axis = {desc.axis[0] / length, desc.axis[1] / length, desc.axis[2] / length};
    const Shape centred = shapes_[1];
    ContactShare share(shapes_[0], centred);

    double first = desc.contact_share, least_error = HUGE_VAL;
    for (int attempt = 0; attempt < 5 && least_error > 0.02; ++attempt) {
        double distance;
        try {
            distance = place_at_share(share, shapes_[0], centred, axis, first);
        } catch (const Error&) {
            if (frames_.empty()) throw;
            break; // the required share can be reached, but not the corrected one
        }
        Shape placed = centred;
        move(placed.positions, {distance * axis[0], distance * axis[1], distance * axis[2]});
        std::vector<Frame> frames = record(desc, bodies, placed);
        double mean = 0;
        for (const Frame& frame : frames) mean += frame.share / static_cast<double>(frames.size());
        const double error = std::abs(mean / desc.contact_share - 1);
        if (error < least_error) {
            least_error = error;
            distance_ = distance;
            frames_ = std::move(frames);
        }
        first *= std::clamp(desc.contact_share / mean, 0.25, 4.0);
        if (!(first < 1)) break;
    }
    for (const Frame& frame : frames_) shares_.push_back(frame.share);
}

std::vector<vox_experiment::Frame> vox_experiment::record(const vox_experiment_desc& desc,
                                                          vox_sim_body_desc (&bodies)[2],
                                                          const Shape& b) const {
    const vox_sim_desc settings = sim_settings(desc.sim);
    vox_sim* created = nullptr;
    check(vox_sim_create(&settings, &created));
    const std::unique_ptr<vox_sim, decltype(&vox_sim_destroy)> sim(created, &vox_sim_destroy);
    vox_sim_body_view views[2] = {};
    for (int i = 0; i < 2; ++i) {
        bodies[i].positions = i == 0 ? shapes_[0].positions.data() : b.positions.data();
        vox_body id = VOX_NULL_BODY;
        check(vox_sim_body_insert(sim.get(), &bodies[i], &id));
        check(vox_sim_body_get_view(sim.get(), id, &views[i]));
    }
    vox_grid* grid = nullptr;
    check(vox_sim_get_grid(sim.get(), &grid));

    std::vector<Frame> frames(desc.frames);
    for (Frame& frame : frames) {
        // A step begins with the detection, which uses the present positions.
        for (int i = 0; i < 2; ++i)
            frame.positions[i].assign(views[i].grid_positions,
                                      views[i].grid_positions + 3 * views[i].vertex_count);
        check(vox_sim_step(sim.get(), desc.time_step));
        vox_contact_view contacts{};
        check(vox_grid_get_contacts(grid, &contacts));
        check(vox_grid_get_hash(grid, &frame.hash));
        frame.contacts = contacts.count;
        frame.share = share_in_contact(grid, views[0].tet_count + views[1].tet_count);
    }
    return frames;
}

vox_experiment_facts vox_experiment::facts() const {
    vox_experiment_facts facts{};
    facts.frames = static_cast<std::uint32_t>(frames_.size());
    facts.hash = mix_start;
    facts.distance = distance_;
    facts.shares = shares_.data();
    for (const Shape& shape : shapes_) {
        facts.vertices += shape.positions.size() / 3;
        facts.tets += shape.tets.size() / 4;
    }
    std::fill_n(facts.bounds_min, 3, HUGE_VAL);
    std::fill_n(facts.bounds_max, 3, -HUGE_VAL);
    for (const Frame& frame : frames_) {
        facts.contacts += frame.contacts;
        facts.hash = mix(facts.hash, frame.hash);
        facts.mean_share += frame.share / static_cast<double>(frames_.size());
        for (const std::vector<float>& positions : frame.positions)
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const double x = positions[i];
                facts.bounds_min[i % 3] = std::min(facts.bounds_min[i % 3], x);
                facts.bounds_max[i % 3] = std::max(facts.bounds_max[i % 3], x);
            }
    }
    return facts;
}

// ---- measuring --------------------------------------------------------------------------------------

vox_mesh_desc vox_experiment::mesh_desc(int body, const Frame& frame) const {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(frame.positions[body].data(), frame.positions[body].size() / 3);
    desc.tets = shapes_[body].tets.data();
    desc.tet_count = shapes_[body].tets.size() / 4;
    return desc;
}

void vox_experiment::make_grid(const vox_grid_desc* given) {
    const vox_reference_desc reference = vox_default_reference_desc();
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = &reference;
    if (given) desc = read_struct(given, "desc.grid");
    desc.flags &= ~static_cast<std::uint32_t>(VOX_GRID_PENETRATIONS); // only detection is measured
    one_thread_ = desc.worker_count <= 1;
    grid_ = create_grid(&desc);
    for (int body = 0; body < 2; ++body) {
        const vox_mesh_desc mesh = mesh_desc(body, frames_.front());
        check(vox_mesh_insert(grid_.get(), &mesh, &meshes_[body]));
    }
}

double vox_experiment::step(const Frame& frame) {
    for (int body = 0; body < 2; ++body)
        check(vox_mesh_bind_floats(grid_.get(), meshes_[body], frame.positions[body].data(),
                                   frame.positions[body].size() / 3));
    const std::uint64_t begin = nanoseconds(), thread_begin = thread_nanoseconds();
    check(vox_grid_step(grid_.get()));
    const auto used = static_cast<double>(thread_nanoseconds() - thread_begin);
    const auto passed = static_cast<double>(nanoseconds() - begin);
    return one_thread_ && used < passed ? used / passed : 1;
}

vox_suggestion vox_experiment::suggest(const vox_suggest_desc* desc) const {
    const vox_mesh_desc meshes[2] = {mesh_desc(0, frames_.front()), mesh_desc(1, frames_.front())};
    vox_suggestion suggestion{};
    suggestion.struct_size = sizeof suggestion;
    check(vox_suggest_cell_size(desc, meshes, 2, &suggestion));
    return suggestion;
}

vox_experiment_sample vox_experiment::measure(double cell_size, std::vector<std::uint64_t>& frame_ns) {
    check(vox_grid_set_cell_size(grid_.get(), cell_size));
    step(frames_.back()); // not timed; allocates memory for this cell size, with another frame than the next

    vox_experiment_sample sample{};
    sample.cell_size = cell_size;
    for (const Frame& frame : frames_) {
        const double share = step(frame);
        std::uint64_t hash = 0;
        check(vox_grid_get_hash(grid_.get(), &hash));
        if (hash != frame.hash)
            throw Error(
                VOX_ERROR_INTERNAL,
                format("frame %zu: the contacts at cell size %.9g differ from those of the simulation (hash "
                       "%016" PRIx64 ", expected %016" PRIx64 ")",
                       frame_ns.size(), cell_size, hash, frame.hash));
        vox_profile profile{};
        profile.struct_size = sizeof profile;
        check(vox_grid_profile(grid_.get(), &profile));
        vox_counters counters{};
        counters.struct_size = sizeof counters;
        check(vox_grid_get_counters(grid_.get(), &counters));
        const std::uint64_t passed =
            profile.bin_ns + profile.broad_ns + profile.narrow_ns + profile.contacts_ns;
        const auto ns = static_cast<std::uint64_t>(std::llround(share * static_cast<double>(passed)));
        frame_ns.push_back(ns);
        sample.mean_ns += static_cast<double>(ns) / static_cast<double>(frames_.size());
        sample.contacts += counters.contacts;
        sample.visited_cells += counters.visited_cells;
        sample.visited_entries += counters.visited_entries;
        sample.candidates += counters.candidates;
    }
    return sample;
}
