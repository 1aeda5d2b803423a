// The demo: two soft balls wobble through each other. Shows the contacts of every frame, and how much time
// the right cell size saves. Both `vox demo` and vox_demo run it.
#pragma once

#include "failure.hpp"
#include "grid.hpp"

#include <vox/vox_cell_size.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tool {

// An engine with a rule for the cell size, which has its own grid over the same positions.
struct Contender {
    const char* engine;
    const char* rule;
    double cell_size;
    Grid grid;
    std::vector<vox_body> ids;
    std::vector<std::uint64_t> frames; // nanoseconds: median of each frame's steps

    double mean_step_ns() const;
};

class TwoBalls {
public:
    // The arrays of the ball at rest, of radius 1, must live as long: three numbers a vertex, four corners a
    // tet.
    TwoBalls(std::span<const double> rest, std::span<const std::uint32_t> tets);
    TwoBalls(const TwoBalls&) = delete; // the grids borrow the positions
    TwoBalls& operator=(const TwoBalls&) = delete;

    // Steps every contender in every frame. Throws Failure if their contacts differ.
    void run(std::uint32_t frames);

    void print_balls() const;
    void print_results(const char* program) const; // whose commands are to be tried next: "vox"

    std::size_t vertex_count() const { return rest_.size() / 3; }
    std::size_t tet_count() const { return tets_.size() / 4; }
    const vox_cell_size_result& suggestion() const { return suggestion_; } // of the paper's model
    const vox_geometry& geometry() const { return geometry_; }             // of the balls at rest
    // The fast engine with the suggested cell size and with the mean edge, then the reference engine.
    std::span<const Contender> contenders() const { return contenders_; }
    std::span<const std::uint64_t> contacts() const { return contacts_; } // of each frame
    // Steps the first contender once more, in a frame that has been run, and finds its constraints.
    void show(std::uint32_t frame);

private:
    void move(double time);

    std::span<const double> rest_;
    std::span<const std::uint32_t> tets_;
    std::array<std::vector<float>, 2> positions_;
    vox_cell_size_result suggestion_ = sized<vox_cell_size_result>();
    vox_geometry geometry_ = sized<vox_geometry>();
    std::vector<Contender> contenders_;
    std::vector<std::uint64_t> contacts_;
};

} // namespace tool
