// A number for each tet, as readers find it: which array of a file holds them, and which groups of Gmsh.
#pragma once

#include "io/formats/scan.hpp"

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace vox::io {

// A number of the file as a region; 0, no region, for what 32 bits do not hold.
constexpr std::int32_t region_of(std::int64_t number) {
    const auto region = static_cast<std::int32_t>(number);
    return region == number ? region : 0;
}

// Chooses among arrays of numbers, one for each cell: the first with a name that programs use for regions,
// else the first of an integer type.
class RegionArray {
public:
    // Whether an array would take the place of what is there.
    bool wants(std::string_view name, std::uint64_t components, bool integers) const;
    // Takes it, unless a number is not whole or does not fit.
    void take(std::string_view name, const std::vector<double>& numbers);

    const std::vector<std::int32_t>& of_cells() const noexcept { return of_cells_; } // empty if there is none

private:
    bool named_ = false;
    std::vector<std::int32_t> of_cells_;
};

// The first physical group of each volume, by its number, from the body of Gmsh's section $Entities, versions
// 4.0 (40) and 4.1 (41).
std::map<std::int64_t, std::int32_t> gmsh_groups(const File& section, int version, bool binary, bool swap);

// Reads POINT_DATA and CELL_DATA of a legacy VTK file, up to its end or to what is not known.
RegionArray vtk_regions(Scanner& in, bool binary, std::uint64_t cells);

} // namespace vox::io
