// Features that are close, and how far every vertex may move before any touch.
#pragma once

#include "base/array.hpp"
#include "surface/gathered.hpp"
#include "surface/pairs.hpp"

#include <vox/vox_surface.h>

#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

// A number that many threads may lower at once, and that a vector can hold.
struct SharedLeast {
    SharedLeast() noexcept = default;
    SharedLeast(const SharedLeast& other) noexcept : number(other.number.load(std::memory_order_relaxed)) {}
    std::atomic<double> number = 0;
};

class CloseSearch {
public:
    explicit CloseSearch(std::pmr::memory_resource* memory) noexcept;

    // As vox_surface_find_proximities, for kinds and a distance that it accepts. The answer lives until the
    // next call.
    std::span<const vox_proximity> find(vox_surface& surface, vox_feature a, vox_feature b, double distance);
    // As vox_surface_find_clearances; the distances are written when nothing can fail any more.
    void clearance(vox_surface& surface, double most, double* out_distances);
    // The memory of an answer that has ended. Whether there was any.
    bool release_found() noexcept;

private:
    Gathered<vox_proximity> gathered_;
    Array<vox_proximity> found_;
    Array<SharedLeast> clearance_; // of each vertex
};

} // namespace vox
