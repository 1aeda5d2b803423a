// Two bodies put so that a given share of their tetrahedra is in contact.
#pragma once

#include <vox/vox.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vox::sim {

using Point = std::array<double, 3>;

struct GridDeleter {
    void operator()(vox_grid* grid) const noexcept { vox_grid_destroy(grid); }
};
using GridHandle = std::unique_ptr<vox_grid, GridDeleter>;

// Throws what a function of the library failed with.
void check(vox_result result);

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

// Turns about the centre of the bounding box. The two turns have no symmetry of a lattice, alone or relative
// to one another.
void turn_first(std::vector<double>& positions);
void turn_second(std::vector<double>& positions);

void move(std::vector<double>& positions, const Point& by);
void round_positions(const std::vector<double>& positions, std::vector<float>& rounded);

// The share of the tetrahedra of all meshes that are in contact: that hold a vertex of another mesh.
double share_in_contact(const vox_grid* grid, std::uint64_t tet_count);

// Shares of two bodies, the second one at any place.
class ContactShare {
public:
    ContactShare(const Shape& a, const Shape& b);
    // With b moved by this from where it was given.
    double at(const Point& offset);

private:
    const Shape& b_;
    std::uint64_t tet_count_;
    std::vector<float> a_positions_, b_positions_;
    GridHandle grid_;
};

// How far along `axis` (of unit length) b has to be moved, coming from outside, until the share is `wanted`
// for the first time, to half a percent of it where the tets are small enough. Throws INVALID_STATE when it
// never is.
double place_at_share(ContactShare& share, const Shape& a, const Shape& b, const Point& axis, double wanted);

} // namespace vox::sim
