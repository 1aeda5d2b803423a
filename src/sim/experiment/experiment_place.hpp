// Places two bodies so that a given share of their tetrahedra is in contact.
#pragma once

#include "sim/library.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vox::sim {

using Point = std::array<double, 3>;

// Positions (3 a vertex) and tets (4 corners each) of a body.
struct Shape {
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
void round_positions(const std::vector<double>& positions, std::vector<float>& rounded);

// The share of all tetrahedra that contain a vertex of another mesh.
double share_in_contact(const vox_grid* grid, std::uint64_t tet_count);

// Computes the share in contact of two bodies for any position of the second one.
class ContactShare {
public:
    ContactShare(const Shape& a, const Shape& b);
    // The share with b moved by `offset` from its given position.
    double at(const Point& offset);

private:
    const Shape& b_;
    std::uint64_t tet_count_;
    std::vector<float> a_positions_, b_positions_;
    GridHandle grid_;
};

// How far b has to be moved along `axis` (of unit length), coming from outside, until the share first reaches
// `wanted`, to within half a percent of it if the tets are small enough. Throws INVALID_STATE if it never
// does.
double place_at_share(ContactShare& share, const Shape& a, const Shape& b, const Point& axis, double wanted);

} // namespace vox::sim
