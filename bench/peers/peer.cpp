#include "peers/peer.hpp"
#include "base/array.hpp"

#include "exact/predicates.hpp"
#include "grid/contacts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace bench {
namespace {

// Bytes that malloc has given out; 0 where it does not say.
std::size_t allocated() {
#if defined(__GLIBC__)
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
#else
    return 0;
#endif
}

constexpr Box empty_box() {
    constexpr float far = std::numeric_limits<float>::infinity();
    return {{far, far, far}, {-far, -far, -far}};
}

void include(Box& box, const float* low, const float* high) {
    for (int k = 0; k < 3; ++k) {
        box.min[k] = std::min(box.min[k], low[k]);
        box.max[k] = std::max(box.max[k], high[k]);
    }
}

vox::Vec3f vec3(const float* p) { return {p[0], p[1], p[2]}; }

} // namespace

void Peer::setup(const Scene& scene) {
    const std::size_t before = allocated();
    scene_ = &scene;
    boxes_.resize(scene.bodies.size());
    risks_.resize(scene.bodies.size());
    vertices_known_.resize(scene.bodies.size());
    tets_known_.resize(scene.bodies.size());
    order_.resize(scene.bodies.size());
    std::iota(order_.begin(), order_.end(), std::size_t(0));
    build();
    step();
    const std::size_t after = allocated();
    bytes_ = after > before ? after - before : 0;
}

void Peer::step() {
    hits_.clear();
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        boxes_[b] = empty_box();
        const float* p = position(b, 0);
        for (std::size_t v = 0; v < scene_->bodies[b].vertex_count(); ++v, p += 3) include(boxes_[b], p, p);
    }
    find_pairs();
    vertices_known_.assign(boxes_.size(), false);
    tets_known_.assign(boxes_.size(), false);
    for (const Pair& pair : pairs_) {
        if (!vertices_known_[pair.a]) update_vertices(pair.a);
        if (!tets_known_[pair.b]) update_tets(pair.b);
        vertices_known_[pair.a] = tets_known_[pair.b] = true;
        collide(pair.a, pair.b);
    }
}

// Sweep along x.
void Peer::find_pairs() {
    pairs_.clear();
    std::fill(risks_.begin(), risks_.end(), empty_box());
    std::ranges::sort(order_, {}, [&](std::size_t b) { return boxes_[b].min[0]; });
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::size_t a = order_[i];
        if (scene_->bodies[a].self_collision) {
            pairs_.push_back({a, a});
            risks_[a] = boxes_[a];
        }
        for (std::size_t j = i + 1; j < order_.size() && boxes_[order_[j]].min[0] <= boxes_[a].max[0]; ++j) {
            const std::size_t b = order_[j];
            if (!boxes_[a].meets(boxes_[b])) continue;
            pairs_.push_back({a, b});
            pairs_.push_back({b, a});
            Box common;
            for (int k = 0; k < 3; ++k) {
                common.min[k] = std::max(boxes_[a].min[k], boxes_[b].min[k]);
                common.max[k] = std::min(boxes_[a].max[k], boxes_[b].max[k]);
            }
            include(risks_[a], common.min, common.max);
            include(risks_[b], common.min, common.max);
        }
    }
}

Box Peer::tet_box(std::size_t body, std::size_t tet) const {
    const std::uint32_t* corner = &scene_->bodies[body].tets[4 * tet];
    const float *a = position(body, corner[0]), *b = position(body, corner[1]),
                *c = position(body, corner[2]), *d = position(body, corner[3]);
    Box box;
    for (int k = 0; k < 3; ++k) {
        box.min[k] = std::min(std::min(a[k], b[k]), std::min(c[k], d[k]));
        box.max[k] = std::max(std::max(a[k], b[k]), std::max(c[k], d[k]));
    }
    return box;
}

void Peer::vertices_at_risk(std::size_t body, std::vector<std::uint32_t>& vertices) const {
    vertices.clear();
    const std::size_t count = scene_->bodies[body].vertex_count();
    for (std::uint32_t v = 0; v < count; ++v)
        if (risks_[body].holds(position(body, v))) vertices.push_back(v);
}

void Peer::tets_at_risk(std::size_t body, std::vector<std::uint32_t>& tets, std::vector<Box>& boxes) const {
    tets.clear();
    boxes.clear();
    const std::size_t count = scene_->bodies[body].tet_count();
    for (std::uint32_t t = 0; t < count; ++t) {
        const Box box = tet_box(body, t);
        if (!risks_[body].meets(box)) continue;
        tets.push_back(t);
        boxes.push_back(box);
    }
}

void Peer::decide(std::size_t a, std::uint32_t vertex, std::size_t b, std::uint32_t tet) {
    const std::uint32_t* corner = &scene_->bodies[b].tets[4 * std::size_t(tet)];
    if (a == b && (corner[0] == vertex || corner[1] == vertex || corner[2] == vertex || corner[3] == vertex))
        return;
    const vox::Containment where =
        vox::locate(vec3(position(a, vertex)), vec3(position(b, corner[0])), vec3(position(b, corner[1])),
                    vec3(position(b, corner[2])), vec3(position(b, corner[3])), exact_tests_);
    const bool interior = where == vox::Containment::interior;
    if (interior || where == vox::Containment::boundary)
        hits_.push_back({static_cast<std::uint32_t>(a), vertex, static_cast<std::uint32_t>(b),
                         tet & 0x7fffffffu, interior});
}

std::vector<vox_contact> Peer::contacts() {
    static_assert(sizeof(vox::Tet) == 4 * sizeof(std::uint32_t));
    std::vector<vox::Body> bodies;
    for (const Body& body : scene_->bodies)
        bodies.push_back({static_cast<std::uint32_t>(bodies.size()),
                          static_cast<std::uint32_t>(body.vertex_count()),
                          {reinterpret_cast<const std::byte*>(body.positions.data()), 3 * sizeof(float)},
                          {reinterpret_cast<const vox::Tet*>(body.tets.data()), body.tet_count()},
                          body.self_collision});
    std::pmr::memory_resource* const heap = std::pmr::get_default_resource();
    vox::Array<vox::Hit> hits(hits_.begin(), hits_.end(), heap);
    vox::Array<vox_contact> contacts(heap);
    vox::make_contacts(bodies, hits, contacts);
    return {contacts.begin(), contacts.end()};
}

std::vector<EntrantMaker> peers() {
    std::vector<EntrantMaker> makers;
#if defined(BENCH_EMBREE)
    add_embree(makers);
#endif
#if defined(BENCH_BULLET)
    add_bullet(makers);
#endif
#if defined(BENCH_FCL)
    add_fcl(makers);
#endif
#if defined(BENCH_CGAL)
    add_cgal(makers);
#endif
#if defined(BENCH_NANOFLANN)
    add_nanoflann(makers);
#endif
#if defined(BENCH_BOOST)
    add_boost(makers);
#endif
    return makers;
}

} // namespace bench
