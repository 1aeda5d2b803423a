// What becomes of the cells of a file, whatever their kind.
#pragma once

#include "io/formats/scan.hpp"
#include "io/mesh_data.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

// Those before `volume` have their corners first, in VTK's order, and maybe further nodes, which are not
// used.
enum class CellKind : std::uint8_t {
    tet,
    triangle,
    hexahedron,
    wedge,
    pyramid,
    volume, // any other volume element: left out, with a warning
    other   // points, lines, quadrilaterals and the like: left out
};

constexpr std::size_t most_corners = 8;
constexpr std::size_t corner_count(CellKind kind) {
    constexpr std::size_t counts[] = {4, 3, 8, 6, 5, 0, 0};
    return counts[static_cast<std::size_t>(kind)];
}

// Takes the cells of a file in its order.
class Cells {
public:
    explicit Cells(const File& file) : file_(file) {}

    // How many corners of a cell `add` needs; 0 if such cells are skipped.
    std::size_t corners_of(CellKind kind) const noexcept {
        return kind == CellKind::tet || kind == CellKind::triangle || file_.split_cells ? corner_count(kind)
                                                                                        : 0;
    }
    // Adds a cell, which has this number of nodes, to `data`.
    void add(CellKind kind, const char* name, std::uint64_t nodes, const std::uint32_t* corners,
             std::int32_t region, MeshData& data);
    // Counts cells that are left out, and by name those that are volume elements.
    void skip(CellKind kind, const char* name, std::uint64_t number, MeshData& data);

    // What every reader of tets ends with. Throws, naming the file, if there is no tet.
    MeshData finished(MeshData data) const;

private:
    struct Count {
        std::string name;
        std::uint64_t cells = 0, tets = 0, high = 0; // high: with further nodes
    };
    static Count& of_name(std::vector<Count>& counts, const char* name);
    void add_tet(const std::uint32_t* corners, std::int32_t region, MeshData& data) const;

    const File& file_;
    std::vector<Count> split_, skipped_;
    std::uint64_t skipped_cells_ = 0;
    bool could_split_ = false; // cells that were skipped
};

// Writes the numbers of the cells of so many tets where they are their own, and so not written yet.
void number_cells(MeshData& data, std::size_t tets);

// Splits a hexahedron, wedge or pyramid into tets, of its orientation; returns how many. Faces of four
// corners are split by the diagonal from the lowest corner, so that neighbours agree, and the cell by joining
// its lowest corner with all faces that it is not on (J. Dompierre et al., "How to subdivide pyramids,
// prisms, and hexahedra into tetrahedra", 1999). Tets with a corner twice, of collapsed cells, are left out.
std::size_t split_cell(CellKind kind, const std::uint32_t* corners, std::uint32_t (&tets)[6][4]);

} // namespace vox::io
