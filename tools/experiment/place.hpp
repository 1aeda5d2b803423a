// Places two bodies so that a given share of their tetrahedra is in contact.
#pragma once

#include "grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tool {

using Point = std::array<double, 3>;

// Positions (3 a vertex) and tets (4 corners each) of a body.
struct ExperimentBody {
    std::vector<double> positions;
    std::vector<std::uint32_t> tets;
};

struct Bounds {
    Point min, max;
    Point centre() const;
};
Bounds bounds_of(const std::vector<double>& positions);

// Rotate about the centre of the bounding box. Neither rotation, nor the one from the first to the second, is
// a symmetry of a lattice.
void turn_first(std::vector<double>& positions);
void turn_second(std::vector<double>& positions);

void move(std::vector<double>& positions, const Point& by);

// Borrows both arrays.
vox_mesh_desc mesh_of(const std::vector<float>& positions, const std::vector<std::uint32_t>& tets);

// The share of all tetrahedra that contain a vertex of another mesh.
double share_in_contact(const vox_grid* grid, std::uint64_t tet_count);

// Computes the share in contact of two bodies for any position of the second one.
class ContactShare {
public:
    ContactShare(const ExperimentBody& a, const ExperimentBody& b);
    // The share with b moved by `offset` from its given position.
    double at(const Point& offset);

private:
    const ExperimentBody& b_;
    std::uint64_t tet_count_;
    std::vector<float> a_positions_, b_positions_;
    Grid grid_;
};

// How far b has to be moved along `axis` (of unit length), coming from outside, until the share first reaches
// `wanted`, to within half a percent of it if the tets are small enough. Throws Failure if it never does.
double place_at_share(ContactShare& share, const ExperimentBody& a, const ExperimentBody& b,
                      const Point& axis, double wanted);

} // namespace tool
