// The experiment of the paper's Sect. 5: time of detection against cell size, over recorded frames of two
// bodies in contact.
#pragma once

#include "sim/experiment/experiment_place.hpp"

#include <vox/vox_sim.h>

#include <vector>

struct vox_experiment {
public:
    // The caller has checked the fields of `desc` itself.
    explicit vox_experiment(const vox_experiment_desc& desc);

    vox_experiment_facts facts() const;
    vox_suggestion suggest(const vox_suggest_desc* desc) const;
    // Appends the time of each frame.
    vox_experiment_sample measure(double cell_size, std::vector<std::uint64_t>& frame_ns);

private:
    struct Frame {
        std::vector<float> positions[2]; // of the bodies
        std::uint64_t hash;              // of the contacts
        std::uint64_t contacts;
        double share;
    };

    void place_and_record(const vox_experiment_desc& desc, vox_sim_body_desc (&bodies)[2]);
    std::vector<Frame> record(const vox_experiment_desc& desc, vox_sim_body_desc (&bodies)[2],
                              const vox::sim::Shape& b) const;
    vox_mesh_desc mesh_desc(int body, const Frame& frame) const;
    void make_grid(const vox_grid_desc* given);
    // Returns the share of the step in which its thread had a processor; 1 if it had several threads.
    double step(const Frame& frame);

    vox::sim::Shape shapes_[2];
    double distance_ = 0;
    std::vector<Frame> frames_;
    std::vector<double> shares_;
    vox::sim::GridHandle grid_; // whose steps are measured
    vox_body meshes_[2] = {};
    bool one_thread_ = false;
};
