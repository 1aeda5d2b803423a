// Bullet's btDbvt: a dynamic tree over the vertices and one over the tetrahedra of each body, made once,
// their boxes refitted from the leaves up in each step, as btSoftBody does with its own trees.
#include "peers/peer.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <deque>

namespace bench {
namespace {

class Bullet final : public Peer {
    struct Trees {
        btDbvt vertices, tets;
    };
    std::deque<Trees> trees_; // they cannot move

    static btDbvtVolume volume(const Box& box) {
        return btDbvtVolume::FromMM(btVector3(box.min[0], box.min[1], box.min[2]),
                                    btVector3(box.max[0], box.max[1], box.max[2]));
    }
    btDbvtVolume vertex_volume(std::size_t body, std::size_t vertex) const {
        const float* p = position(body, vertex);
        const btVector3 point(p[0], p[1], p[2]);
        return btDbvtVolume::FromMM(point, point);
    }

    void build() override {
        for (std::size_t b = 0; b < scene().bodies.size(); ++b) {
            Trees& trees = trees_.emplace_back();
            for (std::size_t v = 0; v < scene().bodies[b].vertex_count(); ++v)
                trees.vertices.insert(vertex_volume(b, v), data(v));
            for (std::size_t t = 0; t < scene().bodies[b].tet_count(); ++t)
                trees.tets.insert(volume(tet_box(b, t)), data(t));
            trees.vertices.optimizeTopDown();
            trees.tets.optimizeTopDown();
        }
    }

    static void* data(std::size_t index) { return reinterpret_cast<void*>(index); }
    static std::uint32_t index(const btDbvtNode* leaf) {
        return static_cast<std::uint32_t>(reinterpret_cast<std::size_t>(leaf->data));
    }

    template <class LeafVolume>
    static void refit(btDbvtNode* node, const LeafVolume& leaf_volume) {
        if (node->isleaf()) {
            node->volume = leaf_volume(index(node));
            return;
        }
        refit(node->childs[0], leaf_volume);
        refit(node->childs[1], leaf_volume);
        Merge(node->childs[0]->volume, node->childs[1]->volume, node->volume);
    }

    void update_vertices(std::size_t body) override {
        refit(trees_[body].vertices.m_root, [&](std::size_t vertex) { return vertex_volume(body, vertex); });
    }
    void update_tets(std::size_t body) override {
        refit(trees_[body].tets.m_root, [&](std::size_t tet) { return volume(tet_box(body, tet)); });
    }

    void collide(std::size_t a, std::size_t b) override {
        struct ExactDecisions final : btDbvt::ICollide {
            Bullet* peer;
            std::size_t a, b;
            ExactDecisions(Bullet* peer_, std::size_t a_, std::size_t b_) : peer(peer_), a(a_), b(b_) {}
            void Process(const btDbvtNode* vertex, const btDbvtNode* tet) override {
                peer->decide(a, index(vertex), b, index(tet));
            }
        } decide_pair(this, a, b);
        trees_[a].vertices.collideTTpersistentStack(trees_[a].vertices.m_root, trees_[b].tets.m_root,
                                                    decide_pair);
    }
};

} // namespace

void add_bullet(std::vector<EntrantMaker>& makers) {
    makers.push_back({"Bullet btDbvt refit", Kind::peer, [] { return std::make_unique<Bullet>(); }});
}

} // namespace bench
