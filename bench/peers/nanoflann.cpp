// nanoflann: a k-d tree over the vertices at risk of each body, built in each step; for each tetrahedron
// the vertices in the ball around its box, then in the box.
#include "peers/peer.hpp"

#include <nanoflann.hpp>

#include <deque>

namespace bench {
namespace {

class Nanoflann final : public Peer {
    // The points of one body as nanoflann asks for them.
    struct Points {
        const Nanoflann* peer = nullptr;
        std::size_t body = 0;
        std::vector<std::uint32_t> vertices;

        std::size_t kdtree_get_point_count() const { return vertices.size(); }
        float kdtree_get_pt(std::uint32_t i, std::size_t axis) const {
            return peer->position(body, vertices[i])[axis];
        }
        template <class BoundingBox>
        bool kdtree_get_bbox(BoundingBox&) const {
            return false; // it finds the box itself
        }
    };
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3,
                                                     std::uint32_t>;
    struct IndexLists {
        Points points;
        std::unique_ptr<Tree> tree;
        std::vector<std::uint32_t> tets;
        std::vector<Box> tet_boxes;
    };
    std::deque<IndexLists> lists_; // trees point to their points

    void build() override {
        for (std::size_t b = 0; b < scene().bodies.size(); ++b) {
            IndexLists& lists = lists_.emplace_back();
            lists.points.peer = this;
            lists.points.body = b;
        }
    }

    void update_vertices(std::size_t body) override {
        constexpr std::size_t leaf_size = 10;
        IndexLists& lists = lists_[body];
        vertices_at_risk(body, lists.points.vertices);
        lists.tree =
            std::make_unique<Tree>(3, lists.points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
        lists.tree->buildIndex();
    }
    void update_tets(std::size_t body) override {
        tets_at_risk(body, lists_[body].tets, lists_[body].tet_boxes);
    }

    // Takes every point that the search meets within the radius and never asks for less.
    struct Visitor {
        using DistanceType = float;
        Nanoflann* peer;
        std::size_t a, b;
        std::uint32_t tet;
        Box box;
        float squared_radius;

        bool full() const { return true; }
        float worstDist() const { return squared_radius; }
        bool addPoint(float squared_distance, std::uint32_t i) {
            if (squared_distance > squared_radius) return true;
            const std::uint32_t vertex = peer->lists_[a].points.vertices[i];
            if (box.holds(peer->position(a, vertex))) peer->decide(a, vertex, b, tet);
            return true;
        }
    };

    void collide(std::size_t a, std::size_t b) override {
        if (lists_[a].points.vertices.empty()) return;
        for (std::size_t i = 0; i < lists_[b].tets.size(); ++i) {
            const Box& box = lists_[b].tet_boxes[i];
            if (!body_box(a).meets(box)) continue;
            float centre[3], squared_radius = 0;
            for (int k = 0; k < 3; ++k) {
                centre[k] = (box.min[k] + box.max[k]) / 2;
                const float half = std::max(box.max[k] - centre[k], centre[k] - box.min[k]);
                squared_radius += half * half;
            }
            // Rounding of the radius and of the distances must lose no vertex.
            Visitor visitor{this, a, b, lists_[b].tets[i], box, squared_radius * 1.00001f};
            lists_[a].tree->findNeighbors(visitor, centre, nanoflann::SearchParams(0, 0.0f, false));
        }
    }
};

} // namespace

void add_nanoflann(std::vector<EntrantMaker>& makers) {
    makers.push_back({"nanoflann", Kind::peer, [] { return std::make_unique<Nanoflann>(); }});
}

} // namespace bench
