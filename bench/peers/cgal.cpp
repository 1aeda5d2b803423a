// CGAL's box_intersection_d: streamed segment trees over the boxes at risk, built for each pair of
// bodies. Zomorodian, Edelsbrunner, "Fast software for box intersections", IJCGA 12, 2002.
#include "peers/peer.hpp"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

namespace bench {
namespace {

class Cgal final : public Peer {
    using Primitive = CGAL::Box_intersection_d::Box_with_info_d<float, 3, std::uint32_t,
                                                                CGAL::Box_intersection_d::ID_EXPLICIT>;
    struct IndexLists {
        std::vector<std::uint32_t> vertices, tets;
        std::vector<Box> tet_boxes;
    };
    std::vector<IndexLists> lists_;
    std::vector<Primitive> vertices_, tets_; // of the pair at hand

    static constexpr std::ptrdiff_t cutoff = 100; // boxes below which all pairs are tried; tuned

    void build() override { lists_.resize(scene().bodies.size()); }
    void update_vertices(std::size_t body) override { vertices_at_risk(body, lists_[body].vertices); }
    void update_tets(std::size_t body) override {
        tets_at_risk(body, lists_[body].tets, lists_[body].tet_boxes);
    }

    void collide(std::size_t a, std::size_t b) override {
        vertices_.clear();
        tets_.clear();
        for (std::uint32_t v : lists_[a].vertices) {
            const float* p = position(a, v);
            if (!body_box(b).holds(p)) continue;
            float corner[3] = {p[0], p[1], p[2]};
            vertices_.emplace_back(corner, corner, v);
        }
        for (std::size_t i = 0; i < lists_[b].tets.size(); ++i) {
            Box box = lists_[b].tet_boxes[i];
            if (body_box(a).meets(box)) tets_.emplace_back(box.min, box.max, lists_[b].tets[i]);
        }
        CGAL::box_intersection_d(
            vertices_.begin(), vertices_.end(), tets_.begin(), tets_.end(),
            [&](const Primitive& vertex, const Primitive& tet) { decide(a, vertex.info(), b, tet.info()); },
            cutoff, CGAL::Box_intersection_d::CLOSED);
    }
};

} // namespace

void add_cgal(std::vector<EntrantMaker>& makers) {
    makers.push_back({"CGAL box intersection", Kind::peer, [] { return std::make_unique<Cgal>(); }});
}

} // namespace bench
