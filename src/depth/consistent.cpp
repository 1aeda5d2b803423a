// Stages 2 to 4 of Heidelberger, Teschner, Keiser, Mueller, Gross, "Consistent Penetration Depth Estimation
// for Deformable Collision Response", Vision, Modeling, Visualization 2004. docs/depth-method.md says what
// differs, and why.
#include "depth/consistent.hpp"

#include "base/prefetch.hpp"
#include "base/vectors.hpp"
#include "depth/closest.hpp"
#include "depth/walk.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"

#include <array>
#include <cstddef>

namespace vox::depth {

namespace {

// If the mean of unit vectors is shorter than this, they point to opposite sides rather than to one.
constexpr double least_mean = 0.25;
// A squared distance below this counts as zero. The inverse of any other can be squared without overflow.
constexpr double no_distance = 1e-140;

// The mean of what is known at the points around one, that is, of their directions and of the depths they
// imply. In the paper, the depth changes along the way to a neighbour at the rate given by the direction at
// its end. Here the rate is the mean of the directions at both ends, which is the exact integral when the
// direction changes evenly, and so makes the depths of curved bodies more exact by an order.
class NeighbourMean {
public:
    void add(double weight, const Vec3d& way, double depth, const Vec3d& direction) {
        weights_ += weight;
        depth_ += weight * (depth + dot(way, direction) / 2);
        way_ = way_ + weight * way;
        direction_ = direction_ + weight * direction;
    }

    // Returns false, and writes nothing, when the mean is of no use.
    bool write(Depth& out) const {
        const double mean = length(direction_);
        if (!(mean >= least_mean * weights_) || weights_ == 0) return false;
        const Vec3d direction = (1 / mean) * direction_;
        const double depth = (depth_ + dot(way_, direction) / 2) / weights_;
        if (!(depth > 0)) return false;
        out.set(depth, direction);
        return true;
    }

private:
    double weights_ = 0, depth_ = 0;
    Vec3d way_{0, 0, 0}, direction_{0, 0, 0};
};

// The nearest of the points around one, which answers alone where the mean is of no use.
class NearestNeighbour {
public:
    void add(double squared, const Vec3d& way, double depth, const Vec3d& direction) {
        if (squared >= squared_) return;
        squared_ = squared;
        way_ = way;
        depth_ = depth;
        direction_ = direction;
    }

    // Returns the state of the point. Without neighbours, depth and direction stay what they are.
    vox_depth_state write(Depth& out) const {
        if (squared_ == infinity) return VOX_DEPTH_AMBIGUOUS;
        out.set(depth_ + dot(way_, direction_), direction_);
        if (out.depth > 0) return VOX_DEPTH_AMBIGUOUS;
        const Vec3d straight = way_ + depth_ * direction_; // to the surface
        const Stretch stretch(straight);
        if (!(stretch.length > 0)) return VOX_DEPTH_TOUCHING; // at a neighbour that is on the surface
        const double inverse = 1 / stretch.length;
        out.set(stretch.length, stretch.length > 1e-140 ? inverse * straight : stretch.direction);
        return VOX_DEPTH_AMBIGUOUS;
    }

private:
    double squared_ = infinity, depth_ = 0;
    Vec3d way_{0, 0, 0}, direction_{0, 0, 0};
};

// Edges from border points that are followed together.
constexpr std::size_t walks_at_once = 64;

class Stages {
public:
    Stages(const BodyPair& pair, std::span<const Hit> hits, Penetrations& penetrations,
           std::span<std::uint32_t> queue, ConsistentScratch& scratch, Counts& counts)
        : pair_(pair), hits_(hits), penetrations_(penetrations), waves_(scratch.waves), queue_(queue),
          normals_(scratch.normals), counts_(counts) {
        waves_.reserve(pair_.vertex_count_a);
        for (const std::uint32_t place : pair_.places) waves_.add(vertex_at(place), unreached, place);
    }
    ~Stages() {
        for (const std::uint32_t place : pair_.places) waves_.remove(vertex_at(place));
    }
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    void run() {
        find_border();
        const std::uint32_t wave = propagate(2, false);
        propagate_crossing(wave);
        mark_unreached();
    }

private:
    Vec3d position(std::uint32_t vertex) const { return pair_.positions_a.exact(vertex); }
    LinkRange neighbours(std::uint32_t vertex) const { return pair_.topology_a->neighbours_of(vertex); }
    std::uint32_t vertex_at(std::uint32_t place) const { return penetrations_.of(place).vertex; }
    vox_depth_state& state(std::uint32_t vertex) { return penetrations_.of(waves_[vertex].place).state; }
    Depth& depth(std::uint32_t vertex) { return penetrations_.depth_of(waves_[vertex].place); }
    std::uint32_t wave_of(std::uint32_t vertex) const { return waves_[vertex].wave; }
    void push(std::uint32_t vertex, std::uint32_t wave) {
        waves_.set_wave(vertex, wave);
        queue_[queued_++] = vertex;
    }
    // Calls visit(vertex, place) for each neighbour of a vertex that collides and has a wave in [first,
    // last). They are gathered first, without branches, since no processor predicts which ones they are.
    template <class Visit>
    void for_colliding(std::uint32_t vertex, std::uint32_t first, std::uint32_t last, Visit&& visit) const {
        struct Colliding {
            std::uint32_t vertex, place;
        };
        std::array<Colliding, 32> gathered;
        std::uint32_t count = 0;
        const auto flush = [&] {
            for (std::uint32_t i = 0; i < count; ++i) visit(gathered[i].vertex, gathered[i].place);
            count = 0;
        };
        for (const std::uint32_t neighbour : neighbours(vertex)) {
            const auto [wave, place] = waves_[neighbour];
            gathered[count] = {neighbour, place};
            count += wave - first < last - first;
            if (count == gathered.size()) flush();
        }
        flush();
    }

    template <class Vertex>
    void prefetch_links(std::size_t next, std::size_t count, Vertex&& vertex) const;
    void prefetch_queued(std::size_t next) const;
    void find_border();
    bool is_coincident(std::uint32_t place, std::uint32_t tet);
    Vec3d inside(const Vec3d& p, std::uint32_t tet) const;
    void follow(std::uint32_t vertex, std::uint32_t tet, const Vec3d& from, std::uint32_t neighbour);
    void take_walks();
    void take_edge(const Walk& walk);
    void finish_border_point();
    std::uint32_t propagate(std::uint32_t wave, bool is_crossing);
    void propagate_crossing(std::uint32_t wave);
    void take_mean(std::uint32_t vertex, bool is_crossing);
    void mark_unreached();

    const BodyPair& pair_;
    std::span<const Hit> hits_;
    Penetrations& penetrations_;
    static constexpr std::uint32_t unreached = 0, unusable = WaveTable::absent - 1;

    WaveTable& waves_;               // of body a's vertices
    std::span<std::uint32_t> queue_; // of vertices
    std::size_t queued_ = 0;
    std::size_t lost_ = 0; // border points without any edge that leads out
    Normals& normals_;
    Counts& counts_;

    // Edges that wait to be followed, and where they begin.
    std::array<Walk, walks_at_once> walks_;
    std::array<std::uint32_t, walks_at_once> vertices_of_walks_;
    std::size_t waiting_ = 0;
    // The border point whose edges are being taken.
    static constexpr std::uint32_t no_vertex = ~0u;
    struct Border {
        std::uint32_t vertex = no_vertex;
        vox_depth_state* state = nullptr;
        Depth* depth = nullptr;
        Vec3d position{};
        NeighbourMean mean{};
        NearestNeighbour nearest{};
        bool lost = false; // an edge does not lead out
    } border_;
};

// Prefetches run so many points ahead, and twice and three times as many for what leads to their data.
constexpr std::size_t ahead = 8;

// Prefetches the links of points after `next`; vertex(i) names point i, for i below `count`.
template <class Vertex>
void Stages::prefetch_links(std::size_t next, std::size_t count, Vertex&& vertex) const {
    const VertexLinks& links = pair_.topology_a->links;
    if (next + 2 * ahead < count) prefetch(links.place_of(vertex(next + 2 * ahead)));
    if (next + ahead < count) prefetch(links.record_of(vertex(next + ahead)));
}

void Stages::prefetch_queued(std::size_t next) const {
    if (next + 3 * ahead < queued_) {
        const std::uint32_t place = waves_[queue_[next + 3 * ahead]].place;
        prefetch(&penetrations_.of(place));
        prefetch(&penetrations_.depth_of(place));
    }
    prefetch_links(next, queued_, [&](std::size_t i) { return queue_[i]; });
}

// The first wave is made of the points with an edge that leads out.
void Stages::find_border() {
    for (std::size_t i = 0; i < pair_.places.size(); ++i) {
        if (!pair_.topology_a->links.empty())
            prefetch_links(i, pair_.places.size(), [&](std::size_t k) { return vertex_at(pair_.places[k]); });
        const std::uint32_t place = pair_.places[i], vertex = vertex_at(place);
        const Hit hit = hits_[penetrations_.of(place).contact];
        const bool coincident = !hit.interior && is_coincident(place, hit.tet);
        bool border = false;
        Vec3d from;
        for (const std::uint32_t q : neighbours(vertex)) {
            if (wave_of(q) != WaveTable::absent) continue;
            if (!border && !coincident) {
                from = position(vertex);
                if (!hit.interior) from = inside(from, hit.tet);
            }
            border = true;
            if (coincident) break;
            follow(vertex, hit.tet, from, q);
        }
        if (!border || !coincident) continue;
        push(vertex, 1);
    }
    take_walks();
    finish_border_point();
}

// True if a point on the boundary of its tetrahedron is on the surface. It is when the corners whose weights
// are not zero are corners of one triangle of the surface. Sets its state and direction then.
bool Stages::is_coincident(std::uint32_t place, std::uint32_t number) {
    const Solid& b = pair_.b;
    const Tet& tet = b.tets[number];
    const std::uint32_t vertex = vertex_at(place);
    const Vec3d p = position(vertex);
    std::uint32_t support[4], count = 0;
    int on = 0; // a facet on which the point is
    std::uint64_t exact_tests = 0;
    for (int i = 0; i < 4; ++i) {
        const auto& [x, y, z] = facet_corners[i];
        if (orientation(b.at(tet.v[x]), b.at(tet.v[y]), b.at(tet.v[z]), p, exact_tests) != 0)
            support[count++] = tet.v[i];
        else
            on = i;
    }
    if (count == 0 || count == 4) return false;
    bool on_surface = false;
    Vec3d direction{0, 0, 0};
    for (const std::uint32_t t : b.topology->ring_of(support[0])) {
        const Triangle& triangle = b.topology->triangles[t];
        if (pair_.self && has_corner(triangle, vertex)) continue;
        if (count > 1 && !has_corner(triangle, support[1])) continue;
        if (count > 2 && !has_corner(triangle, support[2])) continue;
        on_surface = true;
        const Closest closest = closest_point(b, t, p);
        direction = normals_.at(closest.at, closest.at.point - b.at(triangle.apex));
        if (length(direction) > 0) break;
    }
    if (!on_surface) return false;
    if (!(length(direction) > 0)) direction = facet_normal(b, number, on); // all triangles are without area
    penetrations_.depth_of(place).set(0, direction);
    penetrations_.of(place).state = VOX_DEPTH_TOUCHING;
    return true;
}

// Where walks from a point on the boundary of a tetrahedron begin, so that no facet or edge can be missed.
Vec3d Stages::inside(const Vec3d& p, std::uint32_t tet) const {
    const Solid& b = pair_.b;
    const std::uint32_t* v = b.tets[tet].v;
    const Vec3d middle = 0.25 * ((b.at(v[0]) + b.at(v[1])) + (b.at(v[2]) + b.at(v[3])));
    return p + 0x1p-20 * (middle - p);
}

void Stages::follow(std::uint32_t vertex, std::uint32_t tet, const Vec3d& from, std::uint32_t neighbour) {
    if (waiting_ == walks_.size()) take_walks();
    Walk& walk = walks_[waiting_];
    walk.p = from;
    walk.q = position(neighbour);
    walk.tet = tet;
    vertices_of_walks_[waiting_++] = vertex;
}

// Follows the edges that wait. Those of a point may come in several parts.
void Stages::take_walks() {
    const std::span<Walk> walks = std::span(walks_).first(waiting_);
    waiting_ = 0;
    walk_out(pair_.b, walks);
    std::array<std::uint32_t, walks_at_once> triangles;
    std::size_t count = 0;
    for (const Walk& walk : walks)
        if (walk.leaves) triangles[count++] = walk.exit.triangle;
    normals_.prepare(std::span(triangles).first(count));
    for (std::size_t i = 0; i < walks.size(); ++i) {
        if (const std::uint32_t vertex = vertices_of_walks_[i]; vertex != border_.vertex) {
            finish_border_point();
            border_ = {.vertex = vertex,
                       .state = &state(vertex),
                       .depth = &depth(vertex),
                       .position = position(vertex)};
        }
        if (*border_.state != VOX_DEPTH_TOUCHING) take_edge(walks[i]);
    }
}

void Stages::take_edge(const Walk& walk) {
    ++counts_.leaving_edges;
    counts_.edge_tests += walk.visited;
    const Vec3d& p = border_.position;
    Vec3d normal{0, 0, 0};
    if (walk.leaves &&
        !(pair_.self && has_corner(pair_.b.topology->triangles[walk.exit.triangle], border_.vertex)))
        normal = normals_.at(walk.exit, walk.q - p);
    if (!(dot(normal, normal) > 0)) {
        border_.lost = true;
        return;
    }
    const Vec3d way = walk.exit.point - p;
    const double squared = dot(way, way);
    if (squared > no_distance) {
        border_.mean.add(1 / squared, way, 0, normal);
        border_.nearest.add(squared, way, 0, normal);
    } else {
        *border_.state = VOX_DEPTH_TOUCHING;
        border_.depth->set(0, normal);
    }
}

void Stages::finish_border_point() {
    if (border_.vertex == no_vertex) return;
    if (*border_.state != VOX_DEPTH_TOUCHING)
        *border_.state = !border_.lost && border_.mean.write(*border_.depth)
                             ? VOX_DEPTH_SURFACE
                             : border_.nearest.write(*border_.depth);
    const bool is_crossing = *border_.state == VOX_DEPTH_AMBIGUOUS;
    lost_ += is_crossing && !border_.depth->has_answer();
    push(border_.vertex, is_crossing ? unusable : 1);
}

// Sends waves from the points in the queue, of which the first has the number `wave`. Each takes its means
// over all points of the waves before it. Returns the number of the first wave without points.
std::uint32_t Stages::propagate(std::uint32_t wave, bool is_crossing) {
    for (std::size_t first = 0; first < queued_ && queued_ < queue_.size(); ++wave) {
        const std::size_t last = queued_;
        for (; first < last; ++first) {
            prefetch_queued(first);
            const std::uint32_t from = queue_[first];
            if (wave_of(from) == unusable) continue;
            for_colliding(from, unreached, unreached + 1,
                          [&](std::uint32_t to, std::uint32_t) { push(to, wave); });
        }
        for (std::size_t i = last; i < queued_; ++i) {
            prefetch_queued(i);
            if (state(queue_[i]) != VOX_DEPTH_TOUCHING) take_mean(queue_[i], is_crossing);
        }
        if (is_crossing) continue;
        // Marked only now, because points of one wave must not see each other.
        for (std::size_t i = last; i < queued_; ++i)
            if (state(queue_[i]) == VOX_DEPTH_AMBIGUOUS) waves_.set_wave(queue_[i], unusable);
    }
    return wave;
}

// Now CROSSING points send waves, too, to those that no other wave reached. These are CROSSING as well.
void Stages::propagate_crossing(std::uint32_t wave) {
    if (queued_ == queue_.size() && lost_ == 0) return; // all have an answer
    queued_ = 0;
    for (const std::uint32_t place : pair_.places) {
        const std::uint32_t vertex = vertex_at(place);
        if (wave_of(vertex) == unusable)
            waves_.set_wave(vertex, penetrations_.depth_of(place).has_answer() ? wave : unreached);
        if (wave_of(vertex) != unreached) queue_[queued_++] = vertex;
    }
    propagate(wave + 1, true);
}

void Stages::take_mean(std::uint32_t vertex, bool is_crossing) {
    const Vec3d p = position(vertex);
    const auto for_known = [&](auto&& visit) {
        for_colliding(vertex, unreached + 1, wave_of(vertex), [&](std::uint32_t known, std::uint32_t place) {
            const Depth& from = penetrations_.depth_of(place);
            const Vec3d way = position(known) - p;
            visit(dot(way, way), way, from.depth, from.way_out());
        });
    };
    NeighbourMean mean;
    bool at_one = false; // a neighbour is at the same place: what is known there counts alone
    for_known([&](double squared, const Vec3d& way, double depth, const Vec3d& direction) {
        if (at_one) return;
        at_one = !(squared > no_distance);
        if (at_one) mean = NeighbourMean();
        mean.add(at_one ? 1 : 1 / squared, way, depth, direction);
    });
    if (mean.write(depth(vertex))) {
        state(vertex) = is_crossing ? VOX_DEPTH_AMBIGUOUS : VOX_DEPTH_PROPAGATED;
        return;
    }
    NearestNeighbour nearest;
    for_known([&](double squared, const Vec3d& way, double depth, const Vec3d& direction) {
        nearest.add(squared, way, depth, direction);
    });
    state(vertex) = nearest.write(depth(vertex));
}

// Points without an answer become CROSSING when they are connected to a border point, and stay ENCLOSED
// otherwise.
void Stages::mark_unreached() {
    if (queued_ == queue_.size()) return; // all were reached
    queued_ = 0;
    for (const std::uint32_t place : pair_.places)
        if (wave_of(vertex_at(place)) == unreached && penetrations_.of(place).state == VOX_DEPTH_AMBIGUOUS)
            push(vertex_at(place), unusable);
    for (std::size_t first = 0; first < queued_; ++first)
        for_colliding(queue_[first], unreached, unreached + 1, [&](std::uint32_t to, std::uint32_t place) {
            vox_depth_state& state = penetrations_.of(place).state;
            if (state != VOX_DEPTH_TOUCHING) state = VOX_DEPTH_AMBIGUOUS;
            push(to, unusable);
        });
}

} // namespace

void find_consistent_depths(const BodyPair& pair, std::span<const Hit> hits, Penetrations& penetrations,
                            std::span<std::uint32_t> queue, ConsistentScratch& scratch, Counts& counts) {
    Stages(pair, hits, penetrations, queue, scratch, counts).run();
}

} // namespace vox::depth
