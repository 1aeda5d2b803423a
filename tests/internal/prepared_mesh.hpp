// A mesh with what the depth stage needs of it.
#pragma once

#include "base/vectors.hpp"
#include "depth/walk.hpp"
#include "internal/meshes.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <memory_resource>
#include <utility>
#include <vector>

namespace vox::test {

struct Prepared {
    Mesh mesh;
    std::vector<Vec3d> doubles; // in place of the mesh's positions, unless it is empty
    Topology topology{std::pmr::get_default_resource()};

    explicit Prepared(Mesh m) : mesh(std::move(m)) { make_topology(mesh.tets, vertex_count(), topology); }

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(mesh.positions.size()); }
    depth::Solid solid() const {
        if (!doubles.empty())
            return {&topology, mesh.tets,
                    Positions{reinterpret_cast<const std::byte*>(doubles.data()), sizeof(Vec3d), true}};
        return {&topology, mesh.tets,
                Positions{reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)}};
    }
    Vec3d at(std::uint32_t v) const { return solid().at(v); }
    Vec3d at(const depth::SurfacePoint& p) const {
        const std::uint32_t* v = topology.triangles[p.triangle].v;
        return p.weight[0] * at(v[0]) + p.weight[1] * at(v[1]) + p.weight[2] * at(v[2]);
    }
};

} // namespace vox::test
