// adapters/ipc_broad_phase.hpp in IPC Toolkit itself: random scenes in two and three dimensions, moving and
// standing still, with and without a filter, whose candidates must be those of the toolkit's BruteForce, and
// with culling a part of them.
//
//     c++ -std=c++20 -Iadapters -Iinclude bench/surface/ipc_toolkit.cpp [flags of the toolkit] -lipc_toolkit
//     -lvox && ./a.out [SCENES]
#include "ipc_broad_phase.hpp"

#include <ipc/broad_phase/brute_force.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

namespace {

using Pair = std::pair<long long, long long>;

Pair unordered(long long a, long long b) { return {std::min(a, b), std::max(a, b)}; }
Pair pair_of(const ipc::VertexVertexCandidate& c) { return unordered(c.vertex0_id, c.vertex1_id); }
Pair pair_of(const ipc::EdgeVertexCandidate& c) { return {c.edge_id, c.vertex_id}; }
Pair pair_of(const ipc::EdgeEdgeCandidate& c) { return unordered(c.edge0_id, c.edge1_id); }
Pair pair_of(const ipc::FaceVertexCandidate& c) { return {c.face_id, c.vertex_id}; }
Pair pair_of(const ipc::EdgeFaceCandidate& c) { return {c.edge_id, c.face_id}; }
Pair pair_of(const ipc::FaceFaceCandidate& c) { return unordered(c.face0_id, c.face1_id); }

struct Counts {
    std::size_t candidates = 0, culled = 0, wrong = 0;
};

template <class Candidate>
void compare(const ipc::BroadPhase& brute, const ipc::BroadPhase& ours, const ipc::BroadPhase& culled,
             void (ipc::BroadPhase::*detect)(std::vector<Candidate>&) const, Counts& counts) {
    const auto pairs = [&](const ipc::BroadPhase& phase) {
        std::vector<Candidate> candidates;
        (phase.*detect)(candidates);
        std::vector<Pair> found;
        for (const Candidate& c : candidates) found.push_back(pair_of(c));
        return found;
    };
    std::vector<Pair> expected = pairs(brute);
    std::sort(expected.begin(), expected.end());
    const std::vector<Pair> left = pairs(culled);
    counts.candidates += expected.size();
    counts.culled += expected.size() - left.size();
    counts.wrong +=
        expected != pairs(ours) || !std::includes(expected.begin(), expected.end(), left.begin(), left.end());
}

Counts try_scene(unsigned seed) {
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const int vertices = 60, dimensions = seed % 4 == 3 ? 2 : 3;
    Eigen::MatrixXd from(vertices, dimensions), to(vertices, dimensions);
    Eigen::MatrixXi edges(80, 2), faces(dimensions == 3 ? 60 : 0, 3);
    for (Eigen::Index i = 0; i < from.size(); ++i) { // half of the coordinates are equal to others
        from.data()[i] = random() % 2 ? unit() : static_cast<double>(random() % 5) / 4;
        to.data()[i] = from.data()[i] + unit() / 5;
    }
    for (Eigen::Index i = 0; i < edges.size(); ++i) edges.data()[i] = static_cast<int>(random() % vertices);
    for (Eigen::Index i = 0; i < faces.size(); ++i) faces.data()[i] = static_cast<int>(random() % vertices);
    ipc::BruteForce brute;
    vox::IpcBroadPhase ours(false, 1 + seed % 4), culled(true);
    for (ipc::BroadPhase* phase :
         {static_cast<ipc::BroadPhase*>(&brute), static_cast<ipc::BroadPhase*>(&ours),
          static_cast<ipc::BroadPhase*>(&culled)}) {
        if (seed % 7 == 0)
            phase->can_vertices_collide = [](std::size_t a, std::size_t b) { return (a + b) % 3 != 0; };
        const double radius = seed % 5 == 0 ? 0 : 0.01;
        if (seed % 3 == 0)
            phase->build(from, edges, faces, radius);
        else
            phase->build(from, to, edges, faces, radius);
    }
    Counts counts;
    compare(brute, ours, culled, &ipc::BroadPhase::detect_vertex_vertex_candidates, counts);
    compare(brute, ours, culled, &ipc::BroadPhase::detect_edge_vertex_candidates, counts);
    compare(brute, ours, culled, &ipc::BroadPhase::detect_edge_edge_candidates, counts);
    if (dimensions == 3) {
        compare(brute, ours, culled, &ipc::BroadPhase::detect_face_vertex_candidates, counts);
        compare(brute, ours, culled, &ipc::BroadPhase::detect_edge_face_candidates, counts);
        compare(brute, ours, culled, &ipc::BroadPhase::detect_face_face_candidates, counts);
    }
    return counts;
}

} // namespace

int main(int argc, char** argv) {
    const unsigned scenes = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 1000;
    Counts all;
    for (unsigned seed = 0; seed < scenes; ++seed) {
        const Counts counts = try_scene(seed);
        all.candidates += counts.candidates;
        all.culled += counts.culled;
        all.wrong += counts.wrong;
    }
    std::printf("%u scenes, %zu candidates, %zu of them culled; lists that differ from BruteForce: %zu\n",
                scenes, all.candidates, all.culled, all.wrong);
    return all.wrong != 0;
}
