// The kernels as loops, for tests and for programs that are written where there is no GPU.
#pragma once

#include "gpu/backend.hpp"

namespace vox::gpu {

struct HostOrder {
    u32 lanes = 1, lane_offset = 0; // lanes in the order (i * lanes + offset) mod 32; an odd number
    u32 items = 1, item_offset = 0; // likewise, a prime that does not divide their number
    u32 workers = 1;
    bool poison = false; // what a step has to write, before it
};

std::unique_ptr<Backend> make_host_backend(const HostOrder& order);

// The first fault that phases had since the last call (PhaseCheck), or null.
const char* take_phase_fault();

// Whether nothing was written around the arrays.
bool guards_hold(const Backend& host);

} // namespace vox::gpu
