// The samples of the experiment: in which order they are measured, and the time that they give together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tool {

// The detection of all frames at one cell size. The counts are sums over the frames.
struct SweepSample {
    std::string name; // the rule that the cell size comes from; "" for a size of the range
    double cell_size = 0;
    std::uint64_t round = 0;
    std::vector<std::uint64_t> frame_ns;
    std::uint64_t contacts = 0, visited_cells = 0, visited_entries = 0, candidates = 0;
};

// The order in which a round measures `count` cell sizes: 0 to count - 1, shuffled. It differs for each round
// and seed and is the same on every machine. Thus a temporary disturbance of the machine does not always hit
// the same cell sizes.
std::vector<std::size_t> order_of_round(std::size_t count, std::uint64_t seed, std::uint64_t round);

// The time of one cell size: the mean over the frames of the median over the rounds, each of which has a time
// for every frame. A frame means the same work in every round, so a disturbance affects only the frames in
// which it happens, not the whole round. Medians are used because on a busy machine the minimum over the
// rounds depends on a few lucky ones (docs/evidence/paper.md has figures).
double time_of_rounds(const std::vector<std::vector<std::uint64_t>>& rounds);

} // namespace tool
