// vox_sim.hpp: vox_sim.h for C++20, under the rules of vox.hpp. Every function here stands for the one of
// vox_sim.h that its comment names.
#ifndef VOX_VOX_SIM_HPP
#define VOX_VOX_SIM_HPP

#include <vox/vox.hpp>
#include <vox/vox_sim.h>

namespace vox {
namespace sim {

// A vox_sim_body_desc of arrays, which are read when the body is inserted; its other fields have their defaults. The
// positions are packed doubles.
inline vox_sim_body_desc describe(const borrowed_points& positions, const borrowed_tets& tets) {
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.positions = static_cast<const double*>(positions.data);
    desc.vertex_count = positions.count;
    desc.tets = tets.data;
    desc.tet_count = tets.count;
    const std::uint64_t along = positions.byte_stride, across = positions.component_byte_stride;
    const bool packed = (along == 0 || along == 3 * sizeof(double)) && (across == 0 || across == sizeof(double));
    if (positions.format != VOX_FORMAT_DOUBLE || !packed)
        detail::refuse("describe: positions of format %llu, %llu bytes apart, are no packed doubles", positions.format,
                       along);
    return desc;
}

// vox_sim. Move-only; its destructor is vox_sim_destroy. One that was moved from is null: calls fail.
class simulation {
public:
    // vox_sim_create
    simulation() : simulation(vox_default_sim_desc()) {}
    explicit simulation(const vox_sim_desc& desc) : simulation(detail::filled<vox_sim*>(vox_sim_create, &desc)) {}
    // Takes over a simulation made in C.
    static simulation adopt(vox_sim* raw) { return simulation(raw); }
    vox_sim* get() noexcept { return sim_.get(); }
    const vox_sim* get() const noexcept { return sim_.get(); }

    // vox_sim_get_grid. It lives as long as the simulation.
    vox::grid& grid() & noexcept { return grid_; }
    const vox::grid& grid() const& noexcept { return grid_; }
    void grid() && = delete;
    // vox_sim_step
    void step(double time_step) { detail::check(vox_sim_step(get(), time_step)); }
    // vox_sim_body_insert
    vox_body insert(const vox_sim_body_desc& desc) {
        return detail::filled<vox_body>(vox_sim_body_insert, get(), &desc);
    }
    // vox_sim_body_remove
    void remove(vox_body body) { detail::check(vox_sim_body_remove(get(), body)); }
    // vox_sim_body_get_view. The arrays live until the body is removed; every step writes them.
    vox_sim_body_view body(vox_body body) const& {
        return detail::filled<vox_sim_body_view>(vox_sim_body_get_view, get(), body);
    }
    void body(vox_body body) const&& = delete;
    // vox_sim_body_set_state. An empty span leaves positions or velocities as they are.
    void set_state(vox_body body, span<const double> positions, span<const double> velocities) {
        vox_sim_body_view view{};
        detail::check(vox_sim_body_get_view(get(), body, &view));
        for (const auto& numbers : {positions, velocities})
            if (!numbers.empty() && numbers.size() != 3 * view.vertex_count)
                detail::refuse("set_state: %llu numbers for %llu vertices", numbers.size(), view.vertex_count);
        detail::check(vox_sim_body_set_state(get(), body, positions.empty() ? nullptr : positions.data(),
                                             velocities.empty() ? nullptr : velocities.data()));
    }
    // vox_sim_get_energy
    vox_sim_energy energy(vox_body body = VOX_NULL_BODY) const {
        vox_sim_energy energy{};
        detail::check(vox_sim_get_energy(get(), body, &energy));
        return energy;
    }
    // vox_sim_get_counters
    std::span<const vox_counter> counters() const {
        vox_counter_view view;
        detail::check(vox_sim_get_counters(get(), &view));
        return {view.data, static_cast<std::size_t>(view.count)};
    }

private:
    struct deleter {
        void operator()(vox_sim* raw) const noexcept { vox_sim_destroy(raw); }
    };
    explicit simulation(vox_sim* raw) : sim_(raw), grid_(vox::grid::borrow(grid_of(raw))) {}
    static vox_grid* grid_of(const vox_sim* raw) noexcept {
        vox_grid* grid = nullptr;
        if (raw) (void)vox_sim_get_grid(raw, &grid);
        return grid;
    }
    std::unique_ptr<vox_sim, deleter> sim_;
    vox::grid grid_; // ends first, with its views
};

} // namespace sim
} // namespace vox

#endif
