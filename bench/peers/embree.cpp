// Embree 3, rtcCollide: bounding volume hierarchies over user geometry, one over the vertices and one over
// the tetrahedra of each body. `rebuild` builds them in each step, over the primitives at risk; `refit`
// makes them once and moves their boxes.
#include "peers/peer.hpp"

#include <embree3/rtcore.h>

#include <stdexcept>

namespace bench {
namespace {

class Embree final : public Peer {
public:
    explicit Embree(bool refit) : refit_(refit) {
        device_ = rtcNewDevice("threads=1");
        if (!device_) throw std::runtime_error("Embree gives no device");
        rtcSetDeviceMemoryMonitorFunction(
            device_,
            [](void* bytes, ssize_t change, bool) {
                *static_cast<ssize_t*>(bytes) += change;
                return true;
            },
            &device_bytes_);
    }
    ~Embree() override {
        for (Tree& tree : trees_) {
            rtcReleaseGeometry(tree.geometry);
            rtcReleaseScene(tree.scene);
        }
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    std::size_t bytes() const override { return static_cast<std::size_t>(device_bytes_); }

private:
    struct Tree {
        const Embree* peer;
        std::size_t body;
        bool of_tets;
        RTCScene scene;
        RTCGeometry geometry;
        std::vector<std::uint32_t> primitives; // rebuild: those at risk
        std::vector<Box> boxes;                // of these tetrahedra
    };

    void build() override {
        trees_.reserve(2 * scene().bodies.size()); // geometries point to them
        for (std::size_t b = 0; b < scene().bodies.size(); ++b)
            for (bool of_tets : {false, true}) {
                trees_.push_back({this,
                                  b,
                                  of_tets,
                                  rtcNewScene(device_),
                                  rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER),
                                  {},
                                  {}});
                Tree& tree = trees_.back();
                const Body& body = scene().bodies[b];
                rtcSetSceneFlags(tree.scene, RTC_SCENE_FLAG_DYNAMIC);
                // Of low quality, a scene keeps a tree for each geometry, of the quality of that geometry.
                rtcSetSceneBuildQuality(tree.scene, RTC_BUILD_QUALITY_LOW);
                rtcSetGeometryBuildQuality(tree.geometry,
                                           refit_ ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
                set_count(tree, of_tets ? body.tet_count() : body.vertex_count());
                rtcSetGeometryUserData(tree.geometry, &tree);
                rtcSetGeometryBoundsFunction(tree.geometry, bounds, nullptr);
                rtcAttachGeometry(tree.scene, tree.geometry);
                if (refit_) commit(tree);
            }
    }

    static void set_count(Tree& tree, std::size_t count) {
        rtcSetGeometryUserPrimitiveCount(tree.geometry, static_cast<unsigned>(count));
    }
    static void commit(Tree& tree) {
        rtcCommitGeometry(tree.geometry);
        rtcCommitScene(tree.scene);
    }

    static void bounds(const RTCBoundsFunctionArguments* arguments) {
        const Tree& tree = *static_cast<const Tree*>(arguments->geometryUserPtr);
        const unsigned i = arguments->primID;
        Box box;
        if (!tree.of_tets) {
            const std::size_t vertex = tree.primitives.empty() ? i : tree.primitives[i];
            const float* p = tree.peer->position(tree.body, vertex);
            box = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        } else {
            box = tree.boxes.empty() ? tree.peer->tet_box(tree.body, i) : tree.boxes[i];
        }
        RTCBounds& out = *arguments->bounds_o;
        out.lower_x = box.min[0];
        out.lower_y = box.min[1];
        out.lower_z = box.min[2];
        out.upper_x = box.max[0];
        out.upper_y = box.max[1];
        out.upper_z = box.max[2];
    }

    void update_vertices(std::size_t body) override {
        Tree& tree = trees_[2 * body];
        if (!refit_) {
            vertices_at_risk(body, tree.primitives);
            set_count(tree, tree.primitives.size());
        }
        commit(tree);
    }
    void update_tets(std::size_t body) override {
        Tree& tree = trees_[2 * body + 1];
        if (!refit_) {
            tets_at_risk(body, tree.primitives, tree.boxes);
            set_count(tree, tree.primitives.size());
        }
        commit(tree);
    }

    void collide(std::size_t a, std::size_t b) override {
        vertices_ = &trees_[2 * a];
        tets_ = &trees_[2 * b + 1];
        if (!refit_ && (vertices_->primitives.empty() || tets_->primitives.empty())) return;
        rtcCollide(vertices_->scene, tets_->scene, receive, this);
    }

    static void receive(void* self, RTCCollision* collisions, unsigned count) {
        Embree& peer = *static_cast<Embree*>(self);
        const Tree &vertices = *peer.vertices_, &tets = *peer.tets_;
        for (unsigned c = 0; c < count; ++c) {
            unsigned vertex = collisions[c].primID0, tet = collisions[c].primID1;
            Box box;
            if (peer.refit_) {
                box = peer.tet_box(tets.body, tet);
            } else {
                box = tets.boxes[tet];
                vertex = vertices.primitives[vertex];
                tet = tets.primitives[tet];
            }
            // Embree reports what shares a leaf or nearly so.
            if (box.holds(peer.position(vertices.body, vertex)))
                peer.decide(vertices.body, vertex, tets.body, tet);
        }
    }

    bool refit_;
    RTCDevice device_ = nullptr;
    ssize_t device_bytes_ = 0;
    std::vector<Tree> trees_;
    const Tree *vertices_ = nullptr, *tets_ = nullptr; // of the rtcCollide that runs
};

} // namespace

void add_embree(std::vector<EntrantMaker>& makers) {
    makers.push_back({"Embree refit", Kind::peer, [] { return std::make_unique<Embree>(true); }});
    makers.push_back({"Embree rebuild", Kind::peer, [] { return std::make_unique<Embree>(false); }});
}

} // namespace bench
