// Boost.Geometry's R-tree over the vertices at risk of each body, packed in each step; for each
// tetrahedron the vertices in its box.
#include "peers/peer.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

namespace bench {
namespace {

namespace bg = boost::geometry;

class Boost final : public Peer {
    using Point = bg::model::point<float, 3, bg::cs::cartesian>;
    using Value = std::pair<Point, std::uint32_t>;
    using Tree = bg::index::rtree<Value, bg::index::quadratic<16>>;

    struct IndexLists {
        Tree tree;
        std::vector<std::uint32_t> vertices, tets;
        std::vector<Box> tet_boxes;
    };
    std::vector<IndexLists> lists_;
    std::vector<Value> values_;

    void build() override { lists_.resize(scene().bodies.size()); }
    void update_vertices(std::size_t body) override {
        IndexLists& lists = lists_[body];
        vertices_at_risk(body, lists.vertices);
        values_.clear();
        for (std::uint32_t v : lists.vertices) {
            const float* p = position(body, v);
            values_.emplace_back(Point(p[0], p[1], p[2]), v);
        }
        lists.tree = Tree(values_); // packs
    }
    void update_tets(std::size_t body) override {
        tets_at_risk(body, lists_[body].tets, lists_[body].tet_boxes);
    }

    void collide(std::size_t a, std::size_t b) override {
        for (std::size_t i = 0; i < lists_[b].tets.size(); ++i) {
            const Box& box = lists_[b].tet_boxes[i];
            if (!body_box(a).meets(box)) continue;
            const bg::model::box<Point> query(Point(box.min[0], box.min[1], box.min[2]),
                                              Point(box.max[0], box.max[1], box.max[2]));
            const auto take = [&](const Value& value) { decide(a, value.second, b, lists_[b].tets[i]); };
            lists_[a].tree.query(bg::index::intersects(query), boost::make_function_output_iterator(take));
        }
    }
};

} // namespace

void add_boost(std::vector<EntrantMaker>& makers) {
    makers.push_back({"Boost R-tree", Kind::peer, [] { return std::make_unique<Boost>(); }});
}

} // namespace bench
