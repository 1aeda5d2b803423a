// The C border of the simulation.
#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "sim/resolve.hpp"
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
    return border(sim, "sim", out_grid, "out_grid", [&] { return sim->grid(); });
}

vox_result vox_sim_step(vox_sim* sim, double time_step) {
    return border(sim, "sim", [&] { sim->step(time_step); });
}

// ---- bodies ---------------------------------------------------------------------------------------

vox_result vox_sim_body_insert(vox_sim* sim, const vox_sim_body_desc* desc, vox_body* out_body) {
    return border(sim, "sim", out_body, "out_body", [&] { return sim->insert(read_struct(desc, "desc")); });
}

vox_result vox_sim_body_remove(vox_sim* sim, vox_body body) {
    return border(sim, "sim", [&] { sim->remove(body); });
}

vox_result vox_sim_body_get_view(const vox_sim* sim, vox_body body, vox_sim_body_view* out_view) {
    return border(sim, "sim", [&] {
        require(out_view, "out_view");
        const sim::SoftBody& b = sim->body(body);
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
    return border(sim, "sim", [&] { sim::set_state(sim->body(body), positions, velocities); });
}

// ---- measurements ---------------------------------------------------------------------------------

vox_result vox_sim_get_energy(const vox_sim* sim, vox_body body, vox_sim_energy* out_energy) {
    return border(sim, "sim", out_energy, "out_energy", [&] { return sim->energy(body); });
}

vox_result vox_sim_get_counters(const vox_sim* sim, vox_counter_view* out_view) {
    return border(sim, "sim", out_view, "out_view", [&] { return sim->counters(); });
}

// ---- repair ---------------------------------------------------------------------------------------

vox_result vox_resolve(const vox_resolve_desc* desc, vox_resolve_body* bodies, uint64_t body_count,
                       vox_resolve_report* out_report) {
    return border([&] {
        require(out_report, "out_report");
        check_struct_size(out_report->struct_size, "out_report");
        const vox_resolve_desc settings = desc ? read_struct(desc, "desc") : vox_default_resolve_desc();
        check_allocator(settings.allocator, "resolve allocator");
        if (body_count > 0) require(bodies, "bodies");
        if (body_count > VOX_MAX_BODIES / 2)
            refuse(format("there are %llu bodies, the limit is %u", llu(body_count), VOX_MAX_BODIES / 2));
        const std::span list(bodies, static_cast<std::size_t>(body_count));
        sim::Resolver resolver(settings, list);
        resolver.run();
        resolver.write(list, *out_report);
    });
}
