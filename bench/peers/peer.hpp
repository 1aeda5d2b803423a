// What all peers share: which bodies to look at, which parts of them, and the decision. A peer gives
// candidate pairs of a vertex and a tetrahedron; the exact test here, the library's own, decides for all of
// them alike. Only the hits are part of a peer's time: order and shared boundaries, which vox
// includes, are made afterwards.
#pragma once

#include "base/array.hpp"
#include "entrant.hpp"

#include "base/scene.hpp"

#include <memory_resource>

namespace bench {

struct Box {
    float min[3], max[3];

    bool meets(const Box& other) const {
        for (int k = 0; k < 3; ++k)
            if (min[k] > other.max[k] || other.min[k] > max[k]) return false;
        return true;
    }
    bool holds(const float* p) const {
        for (int k = 0; k < 3; ++k)
            if (p[k] < min[k] || p[k] > max[k]) return false;
        return true;
    }
};

class Peer : public Entrant {
public:
    void setup(const Scene& scene) final;
    void step() final;
    std::vector<vox_contact> contacts() final;
    std::size_t bytes() const override { return bytes_; }

protected:
    // Builds what depends on the topology.
    virtual void build() {}
    // Brings the structures over the vertices or the tetrahedra of a body up to date; called once per step at
    // most, for the bodies that take part.
    virtual void update_vertices(std::size_t body) = 0;
    virtual void update_tets(std::size_t body) = 0;
    // Calls decide() for every vertex of body a (at least those in the box of b) and every tetrahedron of
    // body b whose boxes meet.
    virtual void collide(std::size_t a, std::size_t b) = 0;

    const Scene& scene() const { return *scene_; }
    const float* position(std::size_t body, std::size_t vertex) const {
        return scene_->bodies[body].positions.data() + 3 * vertex;
    }
    Box tet_box(std::size_t body, std::size_t tet) const;
    const Box& body_box(std::size_t body) const { return boxes_[body]; }
    // The vertices and tetrahedra of a body that can be in contact: those in the box around its overlaps with
    // its partners, or all when it collides with itself. For structures that are built in every step.
    void vertices_at_risk(std::size_t body, std::vector<std::uint32_t>& vertices) const;
    void tets_at_risk(std::size_t body, std::vector<std::uint32_t>& tets, std::vector<Box>& boxes) const;

    void decide(std::size_t a, std::uint32_t vertex, std::size_t b, std::uint32_t tet);

private:
    struct Pair {
        std::size_t a, b;
    };
    void find_pairs();

    const Scene* scene_ = nullptr;
    std::vector<Box> boxes_;
    std::vector<Box> risks_;
    std::vector<std::size_t> order_;
    std::vector<Pair> pairs_;
    std::vector<bool> vertices_known_, tets_known_;
    std::vector<vox::Hit> hits_;
    std::uint64_t exact_tests_ = 0;
    std::size_t bytes_ = 0;
};

// The peers that were found when this was built.
void add_embree(std::vector<EntrantMaker>& makers);
void add_bullet(std::vector<EntrantMaker>& makers);
void add_fcl(std::vector<EntrantMaker>& makers);
void add_cgal(std::vector<EntrantMaker>& makers);
void add_nanoflann(std::vector<EntrantMaker>& makers);
void add_boost(std::vector<EntrantMaker>& makers);

} // namespace bench
