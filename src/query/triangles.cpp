// Queries for the tetrahedra that a triangle, which may move, meets.
#include "query/queries.hpp"

#include "base/vectors.hpp"
#include "exact/moving_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace vox {

namespace {

// Whether a box may meet the hull of the corners at both times: by axes, and by the normal of the triangle
// at first, to rounding.
class TriangleBound {
public:
    explicit TriangleBound(const MovingTriangle& triangle)
        : low_(triangle.from()[0]), high_(low_),
          normal_(cross(triangle.from()[1] - triangle.from()[0], triangle.from()[2] - triangle.from()[0])) {
        for (const Vec3d* corners : {triangle.from(), triangle.to()})
            for (std::size_t i = 0; i < 3; ++i) {
                low_ = min(low_, corners[i]);
                high_ = max(high_, corners[i]);
            }
        origin_ = triangle.from()[0];
        for (const Vec3d* corners : {triangle.from(), triangle.to()})
            for (std::size_t i = 0; i < 3; ++i) {
                const double height = dot(corners[i] - origin_, normal_);
                least_ = std::min(least_, height);
                most_ = std::max(most_, height);
            }
        const double reach = largest_coordinate(high_ - low_);
        slack_ = 0x1p-46 * reach * largest_coordinate(normal_) + 0x1p-900;
    }

    bool operator()(const Box3f& box) const {
        const Vec3d least{box.min.x, box.min.y, box.min.z}, most{box.max.x, box.max.y, box.max.z};
        if (least.x > high_.x || least.y > high_.y || least.z > high_.z || most.x < low_.x ||
            most.y < low_.y || most.z < low_.z)
            return false;
        const auto height = [this](double x, double y, double z) {
            return (x - origin_.x) * normal_.x + (y - origin_.y) * normal_.y + (z - origin_.z) * normal_.z;
        };
        const bool x = normal_.x < 0, y = normal_.y < 0, z = normal_.z < 0;
        const double bottom = height(x ? most.x : least.x, y ? most.y : least.y, z ? most.z : least.z),
                     top = height(x ? least.x : most.x, y ? least.y : most.y, z ? least.z : most.z);
        const Vec3d side = max(most - origin_, origin_ - least);
        const double slack = slack_ + 0x1p-46 * largest_coordinate(side) * largest_coordinate(normal_);
        return !(bottom > most_ + slack || top < least_ - slack);
    }

private:
    Vec3d low_, high_, normal_, origin_;
    double least_ = 0, most_ = 0, slack_ = 0;
};

} // namespace

void Queries::triangle_hits(const Vec3d* from, const Vec3d* to, QueryMeshes which,
                            Array<vox_triangle_hit>& hits) const {
    const MovingTriangle triangle(from, to);
    const TriangleBound bound(triangle);
    tree_.visit_accepted(bound, [&](std::uint32_t leaf) {
        if (!wants(leaves_[leaf], which)) return;
        const LeafTets tets = tets_of(leaves_[leaf]);
        for (std::size_t i = 0; i < tets.size(); ++i) {
            if (!bound(tets.box(i))) continue;
            const std::uint32_t vertex[4] = {tets.vertex(i, 0), tets.vertex(i, 1), tets.vertex(i, 2),
                                             tets.vertex(i, 3)};
            const Vec3d* const corner[4] = {&tets.at(vertex[0]), &tets.at(vertex[1]), &tets.at(vertex[2]),
                                            &tets.at(vertex[3])};
            const TetMeeting meeting = triangle.meet(corner, vertex);
            if (!meeting.any) continue;
            vox_triangle_hit hit{0, meshes_[leaves_[leaf].mesh].id, tets.index(i), meeting.edges, meeting.t,
                                 {}};
            std::ranges::copy(meeting.s, hit.s);
            hits.push_back(hit);
        }
    });
    std::sort(hits.begin(), hits.end(), [](const vox_triangle_hit& x, const vox_triangle_hit& y) {
        return std::tie(x.body, x.t, x.tet) < std::tie(y.body, y.t, y.tet);
    });
}

} // namespace vox
