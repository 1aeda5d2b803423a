// Rational geometry, and locators of several meshes, for tests of queries by definition.
#pragma once

#include "base/vectors.hpp"
#include "internal/meshes.hpp"
#include "internal/query_definition.hpp"
#include "internal/rational.hpp"
#include "support/locators.h"

#include <array>
#include <vector>

namespace vox::test {

using RationalPoint = std::array<Rational, 3>;

inline RationalPoint between(const Vec3d& from, const Vec3d& to) {
    return {Rational(to.x) - Rational(from.x), Rational(to.y) - Rational(from.y),
            Rational(to.z) - Rational(from.z)};
}
inline RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Rational dot(const RationalPoint& a, const RationalPoint& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Rational volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return dot(cross(between(a, b), between(a, c)), between(a, d));
}

class OwnLocator {
public:
    explicit OwnLocator(vox_locator* locator) : locator_(locator) {}
    ~OwnLocator() { vox_locator_release(locator_); }
    OwnLocator(const OwnLocator&) = delete;
    OwnLocator& operator=(const OwnLocator&) = delete;
    const vox_locator* get() const { return locator_; }

private:
    vox_locator* locator_;
};

inline OwnLocator locator_of(const std::vector<QueryDefinition>& meshes, std::vector<vox_body>& ids) {
    vox_grid* grid = engine_grid();
    for (const QueryDefinition& mesh : meshes) {
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions = vox_double_positions(&mesh.positions().data()->x, mesh.positions().size());
        desc.tets = mesh.tets().front().v;
        desc.tet_count = mesh.tets().size();
        ids.push_back(insert_mesh(grid, &desc));
    }
    vox_locator* locator = take_locator(grid);
    vox_grid_destroy(grid);
    return OwnLocator(locator);
}

inline QueryDefinition definition_of(const Mesh& mesh) {
    return {{mesh.positions.begin(), mesh.positions.end()}, mesh.tets};
}

} // namespace vox::test
