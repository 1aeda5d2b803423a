// vox as a broad phase of IPC Toolkit (https://github.com/ipc-sim/ipc-toolkit, 1.6). Header only; link
// vox::vox.
//
//     #include <vox/adapters/ipc_broad_phase.hpp>
//     ipc::Candidates candidates;
//     vox::IpcBroadPhase broad_phase(/*cull=*/true);
//     candidates.build(mesh, vertices_t0, vertices_t1, inflation_radius, &broad_phase);
//     double step = candidates.compute_collision_free_stepsize(mesh, vertices_t0, vertices_t1);
//
// Keep one IpcBroadPhase for all steps: what depends on the topology alone is prepared once. Candidates are
// those of ipc::BruteForce, ascending: boxes are compared in doubles. With `cull` those are left out that are
// proven to stay further apart than twice the inflation radius while vertices move along straight lines: none
// of them is a collision, and there are a tenth as many. One thread at a time may use one.
#pragma once

#include <ipc/broad_phase/broad_phase.hpp>
#include <vox/vox_surface.h>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace vox {

class IpcBroadPhase : public ipc::BroadPhase {
public:
    explicit IpcBroadPhase(bool cull = false, std::uint32_t worker_count = 1)
        : cull_(cull), worker_count_(worker_count) {}

    std::string name() const override { return "vox"; }

    using ipc::BroadPhase::build;

    void build(Eigen::ConstRef<Eigen::MatrixXd> vertices, Eigen::ConstRef<Eigen::MatrixXi> edges,
               Eigen::ConstRef<Eigen::MatrixXi> faces, const double inflation_radius = 0) override {
        prepare(static_cast<std::size_t>(vertices.rows()), edges, faces, vertices.cols());
        const Eigen::MatrixXd from = three_columns(vertices);
        move(from, nullptr, inflation_radius, cull_);
    }

    void build(Eigen::ConstRef<Eigen::MatrixXd> vertices_t0, Eigen::ConstRef<Eigen::MatrixXd> vertices_t1,
               Eigen::ConstRef<Eigen::MatrixXi> edges, Eigen::ConstRef<Eigen::MatrixXi> faces,
               const double inflation_radius = 0) override {
        if (vertices_t1.rows() != vertices_t0.rows() || vertices_t1.cols() != vertices_t0.cols())
            throw std::invalid_argument("vox: " + std::to_string(vertices_t0.rows()) +
                                        " vertices at the beginning, " + std::to_string(vertices_t1.rows()) +
                                        " at the end");
        prepare(static_cast<std::size_t>(vertices_t0.rows()), edges, faces, vertices_t0.cols());
        const Eigen::MatrixXd from = three_columns(vertices_t0), to = three_columns(vertices_t1);
        move(from, to.data(), inflation_radius, cull_);
    }

    // Boxes of the caller's, as they are: a vertex that moves from one corner to the other has that box. One
    // with a side of less than two numbers gets larger by so little. Nothing is culled, as nothing is known
    // of the motion.
    void build(const ipc::AABBs& boxes, Eigen::ConstRef<Eigen::MatrixXi> edges,
               Eigen::ConstRef<Eigen::MatrixXi> faces, const std::uint8_t dimensions) override {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        prepare(boxes.size(), edges, faces, dimensions);
        Eigen::MatrixXd from = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(boxes.size()), 3), to = from;
        for (std::size_t v = 0; v < boxes.size(); ++v)
            for (Eigen::Index axis = 0; axis < dimensions; ++axis) {
                // The box of a motion is larger by one number on each side.
                from(static_cast<Eigen::Index>(v), axis) = std::nextafter(boxes[v].min[axis], infinity);
                to(static_cast<Eigen::Index>(v), axis) = std::nextafter(boxes[v].max[axis], -infinity);
            }
        move(from, to.data(), 0, false);
    }

    void clear() override {
        ipc::BroadPhase::clear();
        moved_ = false;
    }

    void detect_vertex_vertex_candidates(std::vector<ipc::VertexVertexCandidate>& candidates) const override {
        detect(VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, candidates);
    }
    void detect_edge_vertex_candidates(std::vector<ipc::EdgeVertexCandidate>& candidates) const override {
        detect(VOX_FEATURE_EDGE, VOX_FEATURE_VERTEX, candidates);
    }
    void detect_edge_edge_candidates(std::vector<ipc::EdgeEdgeCandidate>& candidates) const override {
        detect(VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, candidates);
    }
    void detect_face_vertex_candidates(std::vector<ipc::FaceVertexCandidate>& candidates) const override {
        detect(VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, candidates);
    }
    void detect_edge_face_candidates(std::vector<ipc::EdgeFaceCandidate>& candidates) const override {
        detect(VOX_FEATURE_EDGE, VOX_FEATURE_FACE, candidates);
    }
    void detect_face_face_candidates(std::vector<ipc::FaceFaceCandidate>& candidates) const override {
        detect(VOX_FEATURE_FACE, VOX_FEATURE_FACE, candidates);
    }

private:
    struct Destroy {
        void operator()(vox_surface* surface) const noexcept { vox_surface_destroy(surface); }
    };

    static void check(vox_result result) {
        if (result != VOX_OK) throw std::runtime_error(std::string("vox: ") + vox_last_error());
    }

    static std::vector<std::uint32_t> indices_of(Eigen::ConstRef<Eigen::MatrixXi> rows) {
        std::vector<std::uint32_t> indices;
        indices.reserve(static_cast<std::size_t>(rows.size()));
        for (Eigen::Index i = 0; i < rows.rows(); ++i)
            for (Eigen::Index k = 0; k < rows.cols(); ++k)
                indices.push_back(static_cast<std::uint32_t>(rows(i, k)));
        return indices;
    }

    // Columns, in one piece; z is 0 in two dimensions.
    static Eigen::MatrixXd three_columns(Eigen::ConstRef<Eigen::MatrixXd> vertices) {
        Eigen::MatrixXd three = Eigen::MatrixXd::Zero(vertices.rows(), 3);
        three.leftCols(vertices.cols()) = vertices;
        return three;
    }

    // Makes the surface, unless it is that of the last call.
    void prepare(std::size_t vertex_count, Eigen::ConstRef<Eigen::MatrixXi> edges,
                 Eigen::ConstRef<Eigen::MatrixXi> faces, Eigen::Index dimensions) {
        clear();
        dim = static_cast<std::uint8_t>(dimensions); // of the base: which candidates it asks for
        std::vector<std::uint32_t> edge_indices = indices_of(edges), face_indices = indices_of(faces);
        if (vertex_count == 0) { // nothing to find, and no surface
            surface_.reset();
            vertex_count_ = 0;
            return;
        }
        if (surface_ && vertex_count == vertex_count_ && edge_indices == edges_ && face_indices == faces_)
            return;
        const std::uint32_t none = 0; // so that no edges are not those of the faces
        vox_surface_desc desc = vox_default_surface_desc();
        desc.worker_count = worker_count_;
        desc.vertex_count = vertex_count;
        desc.edge_count = edge_indices.size() / 2;
        desc.edges = edge_indices.empty() ? &none : edge_indices.data();
        desc.face_count = face_indices.size() / 3;
        desc.faces = face_indices.data();
        vox_surface* surface = nullptr;
        check(vox_surface_create(&desc, &surface));
        surface_.reset(surface);
        vertex_count_ = vertex_count;
        edges_.swap(edge_indices);
        faces_.swap(face_indices);
    }

    void move(const Eigen::MatrixXd& from, const double* to, double radius, bool cull) {
        if (!surface_) return;
        vox_motion motion = vox_default_motion();
        motion.flags = cull ? VOX_MOTION_CULL : 0;
        motion.from = vox_double_positions(from.data(), vertex_count_);
        if (vertex_count_ > 1) // of one position, columns are rows
            motion.from.component_byte_stride = sizeof(double) * vertex_count_;
        motion.to = motion.from;
        motion.to.data = to;
        motion.radius = radius;
        check(vox_surface_move(surface_.get(), &motion));
        moved_ = true;
    }

    const std::uint32_t* corners(vox_feature feature, const std::uint32_t& index) const {
        if (feature == VOX_FEATURE_VERTEX) return &index;
        return feature == VOX_FEATURE_EDGE ? &edges_[2 * std::size_t{index}]
                                           : &faces_[3 * std::size_t{index}];
    }

    // As IPC Toolkit has it: some vertex of one may meet some vertex of the other.
    bool may_meet(vox_feature a, std::uint32_t i, vox_feature b, std::uint32_t j) const {
        const std::uint32_t *p = corners(a, i), *q = corners(b, j);
        for (int m = 0; m <= static_cast<int>(a); ++m)
            for (int n = 0; n <= static_cast<int>(b); ++n)
                if (can_vertices_collide(p[m], q[n])) return true;
        return false;
    }

    // Whether the filter says so, where it has a word for it: it need not be asked about each pair then.
    template <class Filter>
    static auto accepts_all(const Filter& filter, int) -> decltype(static_cast<bool>(filter.accepts_all())) {
        return filter.accepts_all();
    }
    template <class Filter>
    static bool accepts_all(const Filter&, long) {
        return false;
    }

    template <class Candidate>
    void detect(vox_feature a, vox_feature b, std::vector<Candidate>& candidates) const {
        candidates.clear();
        if (!moved_) return;
        const bool all = accepts_all(can_vertices_collide, 0);
        for (std::uint64_t first = 0;;) { // in pieces where one would not fit into the byte budget
            vox_partner_lists lists{};
            check(vox_surface_find_pairs(surface_.get(), a, b, first,
                                         std::numeric_limits<std::uint64_t>::max(), &lists));
            if (lists.count == 0) return;
            candidates.reserve(candidates.size() + static_cast<std::size_t>(lists.offsets[lists.count]));
            for (std::uint64_t i = 0; i < lists.count; ++i)
                for (std::uint64_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) {
                    const auto own = static_cast<std::uint32_t>(first + i), partner = lists.partners[k];
                    if (all || may_meet(a, own, b, partner)) candidates.emplace_back(own, partner);
                }
            first += lists.count;
        }
    }

    bool cull_, moved_ = false;
    std::uint32_t worker_count_;
    std::size_t vertex_count_ = 0;
    std::vector<std::uint32_t> edges_, faces_;
    std::unique_ptr<vox_surface, Destroy> surface_;
};

} // namespace vox
