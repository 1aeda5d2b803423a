#include "sim/sim.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "sim/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

using namespace vox;
using namespace vox::sim;

namespace {

constexpr double shortest_time_step = 1e-12; // with 10000 substeps, their squares are still normal numbers

Vec3 check_vector(const double values[3], const char* name) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(values[axis]) <= 1e15))
            refuse(format("sim %s is %g on axis %d, expected a number of at most 1e15 in size", name,
                          values[axis], axis));
    return Vec3(values[0], values[1], values[2]);
}

double check_number(double value, const char* name) {
    if (!(value >= 0 && value <= 1e60))
        refuse(format("sim %s is %g, expected a number from 0 to 1e60", name, value));
    return value;
}

Floor floor_of(const vox_sim_desc& desc) {
    Floor floor{check_vector(desc.floor_normal, "floor_normal"), desc.floor_offset};
    if (!(std::abs(floor.offset) <= 1e15))
        refuse(format("sim floor_offset is %g, expected a number of at most 1e15 in size", floor.offset));
    if (!floor.normal.isZero(0)) floor.normal.stableNormalize();
    return floor;
}

} // namespace

vox_sim::vox_sim(const vox_sim_desc& desc)
    : memory_(desc.allocator), log_(value_of(desc.log)), gravity_(check_vector(desc.gravity, "gravity")),
      max_time_step_(desc.max_time_step), substeps_(desc.substeps), detect_every_(desc.detect_every),
      contact_settings_{.friction = check_number(desc.friction, "friction"),
                        .compliance = check_number(desc.contact_compliance, "contact_compliance"),
                        .push_speed = check_number(desc.max_push_speed, "max_push_speed"),
                        .slop = desc.contact_slop},
      floor_(floor_of(desc)), bodies_(&memory_), contacts_(&memory_), shapes_(&memory_) {
    if (!(max_time_step_ >= shortest_time_step && max_time_step_ <= 1e12))
        refuse(format("sim max_time_step is %g, expected a number from %g to 1e12", max_time_step_,
                      shortest_time_step));
    if (substeps_ == 0 || substeps_ > 10000)
        refuse(format("sim substeps is %u, expected 1 to 10000", substeps_));
    if (!(desc.contact_slop <= 1e60))
        refuse(format("sim contact_slop is %g, expected a number up to 1e60", desc.contact_slop));
    if (desc.reserved != 0) refuse(format("sim reserved is %u, expected 0", desc.reserved));
    vox_grid_desc settings = vox_default_grid_desc();
    if (desc.grid) settings = read_struct(desc.grid, "sim grid");
    if (!settings.allocator) settings.allocator = desc.allocator;
    settings.flags |= VOX_GRID_CONSTRAINTS; // which the response needs
    grid_ = create_grid(settings);
}

// ---- step -----------------------------------------------------------------------------------------

void vox_sim::step(double time_step) {
    if (!(time_step >= shortest_time_step) || std::isinf(time_step))
        refuse(format("time_step is %g, expected a finite number of at least %g", time_step,
                      shortest_time_step));
    const std::uint64_t start = nanoseconds();
    counts_.detect_ns = 0;
    if (time_step > max_time_step_) {
        if (counts_.clamped_steps++ == 0)
            write_log(VOX_LOG_WARNING,
                      format("time step %g clamped to max_time_step %g; further warnings suppressed",
                             time_step, max_time_step_));
        time_step = max_time_step_;
    }
    const double h = time_step / substeps_;
    set_substeps(h);
    run_substeps(h);
    for (const auto& body : bodies_) write_grid_positions(*body);
    ++counts_.steps;
    counts_.step_ns = nanoseconds() - start;
    counts_.solve_ns = counts_.step_ns - counts_.detect_ns;
}

void vox_sim::run_substeps(double h) {
    struct Moving {
        vox_sim& sim;
        std::uint32_t done = 0;
        double part(std::uint32_t substeps) const noexcept { return double(substeps) / sim.substeps_; }
        ~Moving() { sim.shapes_.end_step(sim.grid(), part(done)); }
    };
    shapes_.begin_step(grid(), bodies_);
    Moving moving{*this};
    for (std::uint32_t& i = moving.done; i < substeps_; ++i) {
        const std::uint32_t age = detect_every_ != 0 ? i % detect_every_ : 1;
        if (age == 0) {
            shapes_.begin_substep(grid(), moving.part(i), moving.part(i + 1));
            detect();
        }
        substep(h, age);
    }
}

void vox_sim::set_substeps(double h) {
    for (const auto& body : bodies_) {
        set_substep(*body, h);
        if (body->softened == 0 || softening_logged_) continue;
        softening_logged_ = true;
        write_log(VOX_LOG_WARNING,
                  format("%s: %llu of %zu constraints are too stiff for substeps of %g and were softened; "
                         "further warnings suppressed",
                         name_of(*body).c_str(), llu(body->softened),
                         body->edges.size() + body->volumes.size(), h));
    }
}

void vox_sim::detect() {
    for (const auto& body : bodies_) {
        write_grid_positions(*body);
        if (!body->is_exact_in_grid && is_far_away(*body)) bind_exactly(*body);
    }
    const std::uint64_t start = nanoseconds();
    check(vox_grid_step(grid_.get()));
    counts_.detect_ns += nanoseconds() - start;
    gather_contacts(grid_.get(), bodies_, &shapes_, contact_settings_, contacts_);
    ++counts_.detections;
    counts_.constraints = contacts_.size();
}

// From here on, as a body that comes and goes would move the contacts each time.
void vox_sim::bind_exactly(SoftBody& body) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    check(vox_mesh_bind_doubles(grid_.get(), body.mesh, body.positions[0].data(), body.positions.size()));
    body.is_exact_in_grid = true;
    write_log(VOX_LOG_INFO, format("%s: floats round its coordinates by up to %g, so the grid reads doubles",
                                   name_of(body).c_str(), body.most_rounded));
}

void vox_sim::substep(double h, std::uint32_t age) {
    for (const auto& body : bodies_) move_freely(*body, gravity_, h);
    for (const auto& body : bodies_) {
        solve_edges(*body);
        solve_volumes(*body);
    }
    solve_contacts(contacts_, age, contact_settings_, h);
    counts_.floor_contacts = 0;
    for (const auto& body : bodies_)
        counts_.floor_contacts += solve_floor(*body, floor_, contact_settings_, h);
    for (const auto& body : bodies_) {
        take_velocities(*body, h);
        damp(*body, h);
    }
    ++counts_.substeps;
}

// ---- bodies ---------------------------------------------------------------------------------------

vox_body vox_sim::insert(const vox_sim_body_desc& desc) {
    auto body = make_body(desc, &memory_);
    // Before the insertion into the grid, as nothing may fail after it.
    reserve_growing(bodies_, bodies_.size() + 1);

    vox_mesh_desc mesh = vox_default_mesh_desc();
    if (desc.flags & VOX_SIM_BODY_SELF_COLLISION) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
    mesh.positions.data = body->grid_positions.data();
    mesh.positions.count = body->positions.size();
    mesh.tets = body->tets.data();
    mesh.tet_count = desc.tet_count;
    mesh.user_data = desc.user_data;
    check(vox_mesh_insert(grid_.get(), &mesh, &body->mesh));
    body->slot = vox_body_slot(body->mesh);
    body->user_data = desc.user_data;

    const SoftBody& inserted = *body;
    // The grid may reuse a slot, so the new body's id need not be the greatest.
    const auto place = std::ranges::upper_bound(bodies_, body->mesh, {}, mesh_of);
    bodies_.insert(place, std::move(body));
    if (inserted.flat_tets + inserted.inverted_tets + inserted.raised_masses > 0)
        write_log(VOX_LOG_WARNING,
                  format("%s: %llu of %llu tets have no rest volume and thus no volume constraint, %llu are "
                         "inverted; %llu of %zu vertices were made heavier",
                         name_of(inserted).c_str(), llu(inserted.flat_tets), llu(desc.tet_count),
                         llu(inserted.inverted_tets), llu(inserted.raised_masses),
                         inserted.positions.size()));
    return inserted.mesh;
}

SoftBody& vox_sim::body(vox_body mesh) const {
    if (SoftBody* found = find_body(bodies_, mesh)) return *found;
    throw Error(VOX_ERROR_INVALID_HANDLE,
                format("body id %u names no body of the simulation, which has %zu", mesh, bodies_.size()));
}

void vox_sim::remove(vox_body mesh) {
    const SoftBody* removed = &body(mesh);
    if (vox_body_is_valid(grid(), mesh))
        check(vox_body_remove(grid(), mesh)); // else the caller did, in the grid
    contacts_.clear();
    erase_if(bodies_, [&](const auto& b) { return b.get() == removed; });
}

// ---- measurements ---------------------------------------------------------------------------------

vox_sim_energy vox_sim::energy(vox_body mesh) const {
    vox_sim_energy sum{};
    Vec3 momentum = Vec3::Zero(), moment = Vec3::Zero();
    const auto add = [&](const SoftBody& body) {
        for (std::size_t v = 0; v < body.positions.size(); ++v) {
            const double mass = body.masses[v], speed = body.velocities[v].norm();
            sum.mass += mass;
            sum.kinetic += mass * speed * speed / 2;
            sum.max_speed = std::max(sum.max_speed, speed);
            momentum += mass * body.velocities[v];
            moment += mass * (body.positions[v] + body.previous[v]) / 2;
        }
        sum.elastic += elastic_energy(body);
    };
    if (mesh != VOX_NULL_BODY) {
        add(body(mesh));
    } else {
        for (const auto& body : bodies_)
            if (!body->fixed) add(*body);
    }
    sum.potential = -gravity_.dot(moment);
    for (int axis = 0; axis < 3; ++axis) {
        sum.momentum[axis] = momentum[axis];
        sum.centre[axis] = sum.mass > 0 ? moment[axis] / sum.mass : 0;
    }
    return sum;
}

vox_counter_view vox_sim::counters() const {
    const auto sum = [&](auto&& of_body) {
        std::uint64_t total = 0;
        for (const auto& body : bodies_) total += of_body(*body);
        return total;
    };
    const vox_counter list[] = {{"bodies", bodies_.size()},
                                {"vertices", sum([](const SoftBody& b) { return b.positions.size(); })},
                                {"tets", sum([](const SoftBody& b) { return b.tets.size() / 4; })},
                                {"edges", sum([](const SoftBody& b) { return b.edges.size(); })},
                                {"volumes", sum([](const SoftBody& b) { return b.volumes.size(); })},
                                {"flat_tets", sum([](const SoftBody& b) { return b.flat_tets; })},
                                {"inverted_tets", sum([](const SoftBody& b) { return b.inverted_tets; })},
                                {"raised_masses", sum([](const SoftBody& b) { return b.raised_masses; })},
                                {"softened", sum([](const SoftBody& b) { return b.softened; })},
                                {"steps", counts_.steps},
                                {"substeps", counts_.substeps},
                                {"detections", counts_.detections},
                                {"clamped_steps", counts_.clamped_steps},
                                {"constraints", counts_.constraints},
                                {"floor_contacts", counts_.floor_contacts},
                                {"step_ns", counts_.step_ns},
                                {"detect_ns", counts_.detect_ns},
                                {"solve_ns", counts_.solve_ns}};
    static_assert(std::size(list) == counter_count);
    std::ranges::copy(list, counter_list_);
    return {counter_list_, std::size(counter_list_)};
}

void vox_sim::write_log(vox_log_level level, const std::string& text) const {
    if (!log_.write) return;
    const CallersFloats floats;
    log_.write(level, text.c_str(), log_.user);
}
