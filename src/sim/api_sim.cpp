// The C border of the simulation.
#include "base/border.hpp"
#include "base/structs.hpp"
#include "sim/sim.hpp"

#include <cmath>

using namespace vox;

// ---- simulation -----------------------------------------------------------------------------------

vox_result vox_sim_create(const vox_sim_desc* desc, vox_sim** out_sim) {
    return border([&] {
        require(out_sim, "out_sim");
        const vox_sim_desc settings = desc ? read_struct(desc, "desc") : vox_default_sim_desc();
        check_allocator(settings.allocator, "sim allocator");
        CallerMemory memory(settings.allocator);
        *out_sim = std::pmr::polymorphic_allocator<>(&memory).new_object<vox_sim>(settings);
    });
}

void vox_sim_destroy(vox_sim* sim) {
    if (!sim) return;
    CallerMemory memory = sim->memory();
    std::pmr::polymorphic_allocator<>(&memory).delete_object(sim);
}

vox_result vox_sim_get_grid(const vox_sim* sim, vox_grid** out_grid) {
    return border([&] {
        require(sim, "sim");
        require(out_grid, "out_grid");
        *out_grid = sim->grid();
    });
}

vox_result vox_sim_step(vox_sim* sim, double time_step) {
    return border([&] {
        require(sim, "sim");
        sim->step(time_step);
    });
}

// ---- bodies ---------------------------------------------------------------------------------------

vox_result vox_sim_body_insert(vox_sim* sim, const vox_sim_body_desc* desc, vox_body* out_body) {
    return border([&] {
        require(sim, "sim");
        require(out_body, "out_body");
        *out_body = sim->insert(read_struct(desc, "desc"));
    });
}

vox_result vox_sim_body_remove(vox_sim* sim, vox_body body) {
    return border([&] {
        require(sim, "sim");
        sim->remove(body);
    });
}

vox_result vox_sim_body_get_view(const vox_sim* sim, vox_body body, vox_sim_body_view* out_view) {
    return border([&] {
        require(sim, "sim");
        require(out_view, "out_view");
        const sim::Body& b = sim->body(body);
        static_assert(sizeof(sim::Vec3) == 3 * sizeof(double));
        *out_view = {.positions = b.positions[0].data(),
                     .velocities = b.velocities[0].data(),
                     .masses = b.masses.data(),
                     .grid_positions = b.grid_positions.data(),
                     .tets = b.tets.data(),
                     .vertex_count = b.positions.size(),
                     .tet_count = b.tets.size() / 4};
    });
}

vox_result vox_sim_body_set_state(vox_sim* sim, vox_body body, const double* positions,
                                  const double* velocities) {
    return border([&] {
        require(sim, "sim");
        sim::set_state(sim->body(body), positions, velocities);
    });
}

vox_result vox_sim_body_set_acceleration(vox_sim* sim, vox_body body, const double acceleration[3]) {
    return border([&] {
        require(sim, "sim");
        sim::Body& target = sim->body(body);
        require(acceleration, "acceleration");
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(acceleration[axis]) <= 1e15))
                refuse(format("acceleration is %g on axis %d, expected a number of at most 1e15 in size",
                              acceleration[axis], axis));
        target.acceleration = sim::Vec3(acceleration[0], acceleration[1], acceleration[2]);
    });
}

// ---- measurements ---------------------------------------------------------------------------------

vox_result vox_sim_get_energy(const vox_sim* sim, vox_body body, vox_sim_energies* out_energies) {
    return border([&] {
        require(sim, "sim");
        check_out_struct(out_energies, "out_energies");
        write_struct(out_energies, sim->energies(body), "out_energies");
    });
}

vox_result vox_sim_get_counters(const vox_sim* sim, vox_counter_view* out_view) {
    return border([&] {
        require(sim, "sim");
        require(out_view, "out_view");
        *out_view = sim->counters();
    });
}
