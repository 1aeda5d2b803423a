// vox_sim.hpp: vox_sim.h for C++20, under the rules of vox.hpp. Every function here stands for the one of
// vox_sim.h that its comment names.
#ifndef VOX_VOX_SIM_HPP
#define VOX_VOX_SIM_HPP

#include <vox/vox_cell_size.hpp>
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
    // vox_sim_body_set_acceleration
    void set_acceleration(vox_body body, const std::array<double, 3>& acceleration) {
        detail::check(vox_sim_body_set_acceleration(get(), body, acceleration.data()));
    }
    // vox_sim_get_energy
    vox_sim_energies energy(vox_body body = VOX_NULL_BODY) const {
        return detail::filled<vox_sim_energies>(vox_sim_get_energy, get(), body);
    }
    // vox_sim_get_counters
    vox_sim_counts counters() const { return detail::filled<vox_sim_counts>(vox_sim_get_counters, get()); }

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

// vox_experiment. Move-only; its destructor is vox_experiment_destroy.
class experiment {
public:
    explicit experiment(const vox_experiment_desc& desc) : experiment(create(desc)) {}
    // vox_experiment_create
    static experiment create(const vox_experiment_desc& desc) {
        vox_experiment* raw = nullptr;
        detail::check(vox_experiment_create(&desc, &raw));
        return experiment(raw);
    }
    vox_experiment* get() noexcept { return experiment_.get(); }
    const vox_experiment* get() const noexcept { return experiment_.get(); }
    // vox_experiment_get. Its shares live as long as the experiment.
    vox_experiment_facts facts() const& { return detail::filled<vox_experiment_facts>(vox_experiment_get, get()); }
    void facts() const&& = delete;
    // vox_experiment_suggest
    vox_suggestion suggest_cell_size(const vox_suggest_desc& desc = vox_default_suggest_desc()) const {
        return detail::filled<vox_suggestion>(vox_experiment_suggest, get(), &desc);
    }
    // vox_experiment_measure. `frame_ns` is empty or takes the time of each frame.
    vox_experiment_sample measure(double cell_size, span<std::uint64_t> frame_ns = {}) {
        vox_experiment_facts facts = detail::sized<vox_experiment_facts>();
        vox_experiment_sample sample = detail::sized<vox_experiment_sample>();
        detail::check(vox_experiment_get(get(), &facts));
        if (!frame_ns.empty() && frame_ns.size() < facts.frames)
            detail::refuse("measure: room for %llu times, of %llu frames", frame_ns.size(), facts.frames);
        detail::check(vox_experiment_measure(get(), cell_size, frame_ns.empty() ? nullptr : frame_ns.data(), &sample));
        return sample;
    }

private:
    struct deleter {
        void operator()(vox_experiment* raw) const noexcept { vox_experiment_destroy(raw); }
    };
    explicit experiment(vox_experiment* raw) noexcept : experiment_(raw) {}
    std::unique_ptr<vox_experiment, deleter> experiment_;
};

// vox_experiment_order
inline std::vector<std::uint64_t> order(std::size_t count, std::uint64_t seed, std::uint64_t round) {
    std::vector<std::uint64_t> order(count);
    detail::check(vox_experiment_order(count, seed, round, order.data()));
    return order;
}
// vox_experiment_time, of rounds with `frames` times each
inline double time_of(span<const std::uint64_t> frame_ns, std::size_t frames) {
    double time = 0;
    if (frames != 0 && frame_ns.size() % frames != 0)
        detail::refuse("time_of: %llu times are no whole rounds of %llu frames", frame_ns.size(), frames);
    detail::check(vox_experiment_time(frame_ns.data(), frames == 0 ? 0 : frame_ns.size() / frames, frames, &time));
    return time;
}
// vox_fit_times
inline vox_time_fit fit_times(span<const double> cell_sizes, span<const double> times) {
    vox_time_fit fit = detail::sized<vox_time_fit>();
    if (cell_sizes.size() != times.size())
        detail::refuse("fit_times: %llu cell sizes and %llu times", cell_sizes.size(), times.size());
    detail::check(vox_fit_times(cell_sizes.data(), times.data(), times.size(), &fit));
    return fit;
}
// vox_fit_time_at
inline double time_at(const vox_time_fit& fit, double cell_size) {
    return detail::filled<double>(vox_fit_time_at, &fit, cell_size);
}
// vox_fit_zone: its smallest and largest cell size
inline std::pair<double, double> zone(const vox_time_fit& fit, double limit) {
    std::pair<double, double> zone;
    detail::check(vox_fit_zone(&fit, limit, &zone.first, &zone.second));
    return zone;
}

} // namespace sim
} // namespace vox

#endif
