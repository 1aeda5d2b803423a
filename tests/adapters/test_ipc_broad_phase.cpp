// The broad phase for IPC Toolkit, against loops over all pairs of boxes made as IPC Toolkit makes them.
#include "ipc_broad_phase.hpp"

#include "internal/random.hpp"

#include <algorithm>
#include <utility>

#include "support/suite.h" // last: it defines macros with common names

namespace {

using Pairs = std::vector<std::pair<std::int64_t, std::int64_t>>;

struct Scene {
    Eigen::MatrixXd from, to;
    Eigen::MatrixXi edges, faces;
    double radius = 0.01;

    explicit Scene(std::uint64_t seed, Eigen::Index dimensions = 3) {
        vox::test::Random random{seed};
        const Eigen::Index count = 40;
        from.resize(count, dimensions);
        to.resize(count, dimensions);
        for (Eigen::Index i = 0; i < from.size(); ++i) {
            from.data()[i] = random.below(2) ? random.unit() : random.below(5) / 4.0;
            to.data()[i] = from.data()[i] + random.unit() / 5;
        }
        edges.resize(60, 2);
        faces.resize(dimensions == 3 ? 50 : 0, 3);
        for (Eigen::Index i = 0; i < edges.size(); ++i) edges.data()[i] = int(random.below(40));
        for (Eigen::Index i = 0; i < faces.size(); ++i) faces.data()[i] = int(random.below(40));
    }

    std::vector<int> corners(int kind, Eigen::Index i) const {
        if (kind == 0) return {int(i)};
        const Eigen::MatrixXi& rows = kind == 1 ? edges : faces;
        std::vector<int> found;
        for (Eigen::Index k = 0; k < rows.cols(); ++k) found.push_back(rows(i, k));
        return found;
    }
    Eigen::Index count(int kind) const {
        return kind == 0 ? from.rows() : kind == 1 ? edges.rows() : faces.rows();
    }

    ipc::AABB box(int kind, Eigen::Index i) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        ipc::AABB all{Eigen::Array3d::Constant(infinity), Eigen::Array3d::Constant(-infinity)};
        for (const int v : corners(kind, i))
            for (Eigen::Index a = 0; a < 3; ++a)
                for (const Eigen::MatrixXd* at : {&from, &to}) {
                    const double x = a < at->cols() ? (*at)(v, a) : 0;
                    all.min[a] = std::min(all.min[a], std::nextafter(x - radius, -infinity));
                    all.max[a] = std::max(all.max[a], std::nextafter(x + radius, infinity));
                }
        return all;
    }

    template <class May>
    Pairs by_definition(int a, int b, May&& may) const {
        Pairs pairs;
        for (Eigen::Index i = 0; i < count(a); ++i)
            for (Eigen::Index j = a == b ? i + 1 : 0; j < count(b); ++j) {
                const ipc::AABB p = box(a, i), q = box(b, j);
                bool meet = (p.min <= q.max).all() && (q.min <= p.max).all(), allowed = false;
                for (const int v : corners(a, i))
                    for (const int w : corners(b, j)) {
                        meet = meet && v != w;
                        allowed = allowed || may(std::size_t(v), std::size_t(w));
                    }
                if (meet && allowed) pairs.emplace_back(i, j);
            }
        return pairs;
    }
};

template <class Candidate>
Pairs pairs_of(const std::vector<Candidate>& candidates) {
    Pairs pairs;
    for (const Candidate& c : candidates) pairs.emplace_back(c.a, c.b);
    return pairs;
}

template <class May>
void check(const Scene& s, const vox::IpcBroadPhase& phase, May&& may) {
    std::vector<ipc::VertexVertexCandidate> vv;
    std::vector<ipc::EdgeVertexCandidate> ev;
    std::vector<ipc::EdgeEdgeCandidate> ee;
    std::vector<ipc::FaceVertexCandidate> fv;
    std::vector<ipc::EdgeFaceCandidate> ef;
    std::vector<ipc::FaceFaceCandidate> ff;
    phase.detect_vertex_vertex_candidates(vv);
    phase.detect_edge_vertex_candidates(ev);
    phase.detect_edge_edge_candidates(ee);
    phase.detect_face_vertex_candidates(fv);
    phase.detect_edge_face_candidates(ef);
    phase.detect_face_face_candidates(ff);
    ck_assert(pairs_of(vv) == s.by_definition(0, 0, may));
    ck_assert(pairs_of(ev) == s.by_definition(1, 0, may));
    ck_assert(pairs_of(ee) == s.by_definition(1, 1, may));
    ck_assert(pairs_of(fv) == s.by_definition(2, 0, may));
    ck_assert(pairs_of(ef) == s.by_definition(1, 2, may));
    ck_assert(pairs_of(ff) == s.by_definition(2, 2, may));
    ck_assert(!ee.empty());
}

constexpr auto all = [](std::size_t, std::size_t) { return true; };

START_TEST(candidates_are_those_of_brute_force) {
    vox::IpcBroadPhase phase;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Scene s(seed, seed % 3 == 0 ? 2 : 3);
        phase.build(s.from, s.to, s.edges, s.faces, s.radius);
        check(s, phase, all);
        phase.build(s.from, s.edges, s.faces, s.radius);
        s.to = s.from;
        check(s, phase, all);
    }
}
END_TEST

START_TEST(boxes_of_the_caller_are_taken_as_they_are) {
    const Scene s(7);
    ipc::AABBs boxes;
    for (Eigen::Index v = 0; v < s.count(0); ++v) boxes.push_back(s.box(0, v));
    vox::IpcBroadPhase phase(true); // of which nothing is known that could cull them
    phase.build(boxes, s.edges, s.faces, 3);
    check(s, phase, all);
}
END_TEST

START_TEST(filters_hold) {
    const Scene s(8);
    vox::IpcBroadPhase phase;
    const auto may = [](std::size_t v, std::size_t w) { return (v + w) % 3 == 0; };
    phase.can_vertices_collide = may;
    phase.build(s.from, s.to, s.edges, s.faces, s.radius);
    check(s, phase, may);
}
END_TEST

START_TEST(culling_leaves_some_out) {
    const Scene s(9);
    vox::IpcBroadPhase whole, culled(true, 2);
    std::vector<ipc::EdgeEdgeCandidate> more, less;
    whole.build(s.from, s.to, s.edges, s.faces, s.radius);
    whole.detect_edge_edge_candidates(more);
    culled.build(s.from, s.to, s.edges, s.faces, s.radius);
    culled.detect_edge_edge_candidates(less);
    ck_assert_uint_lt(less.size(), more.size());
    const Pairs of_more = pairs_of(more), of_less = pairs_of(less);
    ck_assert(std::includes(of_more.begin(), of_more.end(), of_less.begin(), of_less.end()));
    culled.clear();
    culled.detect_edge_edge_candidates(less);
    ck_assert(less.empty());
}
END_TEST

} // namespace

SUITE(ipc_broad_phase) {
    TCase* tests = add_case(suite, "ipc_broad_phase");
    tcase_add_each(tests, candidates_are_those_of_brute_force, boxes_of_the_caller_are_taken_as_they_are,
                   filters_hold, culling_leaves_some_out);
}
