// As much of IPC Toolkit 1.6 as adapters/ipc_broad_phase.hpp uses: names and types alone, so that the adapter
// compiles here.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace Eigen {
template <class T>
using ConstRef = const Ref<const T>&;
}

namespace ipc {

struct AABB {
    Eigen::Array3d min, max;
};
using AABBs = std::vector<AABB>;

template <int>
struct MockCandidate {
    MockCandidate(std::int64_t first, std::int64_t second) : a(first), b(second) {}
    std::int64_t a, b;
};
using VertexVertexCandidate = MockCandidate<0>;
using EdgeVertexCandidate = MockCandidate<1>;
using EdgeEdgeCandidate = MockCandidate<2>;
using FaceVertexCandidate = MockCandidate<3>;
using EdgeFaceCandidate = MockCandidate<4>;
using FaceFaceCandidate = MockCandidate<5>;

class BroadPhase {
public:
    virtual ~BroadPhase() = default;
    virtual std::string name() const = 0;
    virtual void build(Eigen::ConstRef<Eigen::MatrixXd> vertices, Eigen::ConstRef<Eigen::MatrixXi> edges,
                       Eigen::ConstRef<Eigen::MatrixXi> faces, const double inflation_radius = 0) = 0;
    virtual void build(Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
                       Eigen::ConstRef<Eigen::MatrixXd> vertices_t1, Eigen::ConstRef<Eigen::MatrixXi> edges,
                       Eigen::ConstRef<Eigen::MatrixXi> faces, const double inflation_radius = 0) = 0;
    virtual void build(const AABBs& vertex_boxes, Eigen::ConstRef<Eigen::MatrixXi> edges,
                       Eigen::ConstRef<Eigen::MatrixXi> faces, const uint8_t dim) = 0;
    virtual void clear() {}
    virtual void detect_vertex_vertex_candidates(std::vector<VertexVertexCandidate>& candidates) const = 0;
    virtual void detect_edge_vertex_candidates(std::vector<EdgeVertexCandidate>& candidates) const = 0;
    virtual void detect_edge_edge_candidates(std::vector<EdgeEdgeCandidate>& candidates) const = 0;
    virtual void detect_face_vertex_candidates(std::vector<FaceVertexCandidate>& candidates) const = 0;
    virtual void detect_edge_face_candidates(std::vector<EdgeFaceCandidate>& candidates) const = 0;
    virtual void detect_face_face_candidates(std::vector<FaceFaceCandidate>& candidates) const = 0;

    std::function<bool(size_t, size_t)> can_vertices_collide = [](size_t, size_t) { return true; };

protected:
    virtual void build(Eigen::ConstRef<Eigen::MatrixXi>, Eigen::ConstRef<Eigen::MatrixXi>) {}
    uint8_t dim = 0;
};

} // namespace ipc
