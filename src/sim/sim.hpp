// A simulation: bodies, the grid they collide in, and step(), which runs the substeps.
#pragma once

#include "base/array.hpp"
#include "base/caller_memory.hpp"
#include "base/library.hpp"
#include "sim/body.hpp"
#include "sim/contacts.hpp"
#include "sim/shapes.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace vox::sim {

// Totals since the creation, and times of the last step.
struct SimCounts {
    std::uint64_t steps = 0, substeps = 0, detections = 0, clamped_steps = 0;
    std::uint64_t constraints = 0, floor_contacts = 0;
    std::uint64_t step_ns = 0, detect_ns = 0, solve_ns = 0;
};

inline constexpr std::size_t counter_count = 18;

} // namespace vox::sim

// Every public vox_sim_* function is a member here. All of them throw, and change nothing if they do, except
// step (see vox_sim_step).
struct vox_sim {
public:
    // Its memory is that of desc.allocator. Throws INVALID_ARGUMENT naming the field and its value.
    explicit vox_sim(const vox_sim_desc& desc);

    const vox::CallerMemory& memory() const noexcept { return memory_; }
    vox_grid* grid() const noexcept { return grid_.get(); }
    void step(double time_step);

    vox_body insert(const vox_sim_body_desc& desc);
    void remove(vox_body mesh);
    vox::sim::SoftBody& body(vox_body mesh) const;

    vox_sim_energy energy(vox_body mesh) const;
    vox_counter_view counters() const;

private:
    void set_substeps(double h);
    void run_substeps(double h);
    void detect();
    void bind_exactly(vox::sim::SoftBody& body);
    void substep(double h, std::uint32_t age);
    void write_log(vox_log_level level, const std::string& text) const;

    vox::CallerMemory memory_; // first: the other members are released to it
    vox_log log_;
    vox::sim::Vec3 gravity_;
    double max_time_step_;
    std::uint32_t substeps_;
    std::uint32_t detect_every_;
    vox::sim::ContactSettings contact_settings_;
    vox::sim::Floor floor_;

    vox::GridHandle grid_;
    vox::Array<vox::sim::BodyHandle> bodies_; // ascending in mesh
    vox::Array<vox::sim::Contact> contacts_;  // from the last detection
    vox::sim::Shapes shapes_;

    bool softening_logged_ = false;
    vox::sim::SimCounts counts_;
    mutable vox_counter counter_list_[vox::sim::counter_count]; // for a vox_counter_view
};
