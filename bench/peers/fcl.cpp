// FCL's DynamicAABBTreeCollisionManager: one over the vertices and one over the tetrahedra of each body,
// updated (refitted and rebalanced as it sees fit) in each step.
#include "peers/peer.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <deque>

namespace bench {
namespace {

using Manager = fcl::DynamicAABBTreeCollisionManager<double>;
using Aabb = fcl::AABB<double>;

// Geometry that objects must have; their boxes are set directly.
struct NoGeometry final : fcl::CollisionGeometry<double> {
    void computeLocalAABB() override {}
};

struct Primitive final : fcl::CollisionObject<double> {
    Primitive(const std::shared_ptr<fcl::CollisionGeometry<double>>& geometry, std::uint32_t i)
        : CollisionObject(geometry), index(i) {}
    void set(const Box& box) {
        aabb.min_ = {box.min[0], box.min[1], box.min[2]};
        aabb.max_ = {box.max[0], box.max[1], box.max[2]};
    }
    std::uint32_t index;
};

class Fcl final : public Peer {
    struct Tree {
        std::deque<Primitive> primitives;
        Manager manager;
    };
    struct Trees {
        Tree vertices, tets;
    };
    std::deque<Trees> trees_;

    Box vertex_box(std::size_t body, std::size_t vertex) const {
        const float* p = position(body, vertex);
        return {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    }

    template <class BoxOf>
    static void fill(Tree& tree, std::size_t count, const BoxOf& box_of) {
        const auto geometry = std::make_shared<NoGeometry>();
        std::vector<fcl::CollisionObject<double>*> objects;
        for (std::uint32_t i = 0; i < count; ++i) {
            tree.primitives.emplace_back(geometry, i);
            tree.primitives.back().set(box_of(i));
            objects.push_back(&tree.primitives.back());
        }
        tree.manager.registerObjects(objects);
        tree.manager.setup();
    }

    void build() override {
        for (std::size_t b = 0; b < scene().bodies.size(); ++b) {
            Trees& trees = trees_.emplace_back();
            fill(trees.vertices, scene().bodies[b].vertex_count(),
                 [&](std::size_t v) { return vertex_box(b, v); });
            fill(trees.tets, scene().bodies[b].tet_count(), [&](std::size_t t) { return tet_box(b, t); });
        }
    }

    void update_vertices(std::size_t body) override {
        for (Primitive& vertex : trees_[body].vertices.primitives) vertex.set(vertex_box(body, vertex.index));
        trees_[body].vertices.manager.update();
    }
    void update_tets(std::size_t body) override {
        for (Primitive& tet : trees_[body].tets.primitives) tet.set(tet_box(body, tet.index));
        trees_[body].tets.manager.update();
    }

    struct Pair {
        Fcl* peer;
        std::size_t a, b;
    };

    void collide(std::size_t a, std::size_t b) override {
        Pair pair{this, a, b};
        trees_[a].vertices.manager.collide(
            &trees_[b].tets.manager, &pair,
            [](fcl::CollisionObject<double>* vertex, fcl::CollisionObject<double>* tet, void* data) {
                const Pair& p = *static_cast<const Pair*>(data);
                p.peer->decide(p.a, static_cast<const Primitive*>(vertex)->index, p.b,
                               static_cast<const Primitive*>(tet)->index);
                return false; // go on
            });
    }
};

} // namespace

void add_fcl(std::vector<EntrantMaker>& makers) {
    makers.push_back({"FCL AABB trees", Kind::peer, [] { return std::make_unique<Fcl>(); }});
}

} // namespace bench
