// The experiment of the paper's Sect. 5: time of detection against cell size, over recorded frames of two
// bodies in contact.
#pragma once

#include "experiment/place.hpp"
#include "experiment/samples.hpp"
#include "grid.hpp"

#include <vox/vox_cell_size.h>
#include <vox/vox_sim.h>

#include <array>
#include <vector>

namespace tool {

struct ExperimentSettings {
    std::uint32_t frames = 10;            // detections in a sample
    std::vector<double> axis = {1, 0, 0}; // from a to b; not zero
    double contact_share = 0.01;          // required share of all tets in contact, mean over the frames
    double time_step = 0.01;              // of a frame
    bool as_placed = false;               // otherwise the bodies are rotated first
    vox_sim_desc sim = default_sim();     // the motion, without a floor
    vox_grid_desc grid = vox_default_grid_desc(); // which is measured

private:
    static vox_sim_desc default_sim();
};

// Two bodies are placed so that the required share of their tetrahedra is in contact; the response pushes
// them apart and deforms them. Contacts do not depend on the cell size, so the motion does not either. It is
// simulated once, here, and every sample detects the contacts of the same recorded frames.
class Experiment {
public:
    // The share is met only roughly, since the number of tets is finite and the bodies may part quickly.
    // Throws Failure if it cannot be reached on this axis.
    Experiment(const ExperimentSettings& settings, ExperimentBody a, ExperimentBody b);

    std::uint64_t tets() const { return (bodies_[0].tets.size() + bodies_[1].tets.size()) / 4; }
    std::uint64_t contacts() const; // of all frames
    // Combines the hashes of the contacts of all frames; the same for every cell size and engine.
    std::uint64_t hash() const;
    Bounds bounds() const; // of all frames

    double distance() const { return distance_; } // initial distance of the centres, along the axis
    const std::vector<double>& shares() const { return shares_; } // of tets in contact, in each frame
    double mean_share() const;

    // For the first frame.
    vox_cell_size_result suggest(const vox_cell_size_desc& desc) const;
    vox_geometry geometry() const;

    // Measures one sample, after one step that is not timed: times of detection, without depth. With one
    // worker, they are processor time of this thread, which a busy machine lengthens much less; with several,
    // elapsed time. Throws Failure if the contacts are not those found during the simulation.
    SweepSample measure(double cell_size);

private:
    struct Frame {
        std::vector<float> positions[2]; // of the bodies
        std::uint64_t hash;              // of the contacts
        std::uint64_t contacts;
        double share;
    };

    void place_and_record(const ExperimentSettings& settings);
    std::vector<Frame> record(const ExperimentSettings& settings, const ExperimentBody& b) const;
    std::array<vox_mesh_desc, 2> mesh_descs(const Frame& frame) const;
    // Returns the share of the step in which its thread had a processor; 1 if it had several threads.
    double step(const Frame& frame);

    ExperimentBody bodies_[2];
    double distance_ = 0;
    std::vector<Frame> frames_;
    std::vector<double> shares_;
    Grid grid_; // whose steps are measured
    std::vector<vox_body> meshes_;
    bool one_thread_ = false;
};

} // namespace tool
