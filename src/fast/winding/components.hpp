// The connected components of some cells of a lattice, where cells are connected through facets.
//
// Runs are maximal rows of such cells along x; there are two to three orders of magnitude fewer of them than
// of cells. Each run is joined with those next to it in the row before and in the layer before (A. Rosenfeld,
// J. L. Pfaltz, Sequential operations in digital picture processing, J. ACM 13, 1966; joined as in R. E.
// Tarjan, Efficiency of a good but not linear set union algorithm, J. ACM 22, 1975).
#pragma once

#include "base/array.hpp"

#include <cstdint>
#include <memory_resource>

namespace vox::fast {

struct Components {
    explicit Components(std::pmr::memory_resource* memory) noexcept : runs(memory), rows(memory) {}

    struct Run {
        std::uint32_t first, end; // cells, x fastest
        std::uint32_t component;  // numbered in the order of their first cells
    };
    Array<Run> runs;           // in the order of their cells
    Array<std::uint32_t> rows; // of each row its first run, and the end
    std::uint32_t count = 0;

    // Of the cells with values[cell] == wanted.
    void find(const std::uint32_t* values, std::uint32_t wanted, const std::uint32_t (&cells)[3]);

private:
    std::uint32_t root(std::uint32_t run) noexcept;
    void join(std::uint32_t row, std::uint32_t other, std::uint32_t cells_between) noexcept;
};

} // namespace vox::fast
