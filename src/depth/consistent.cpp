// Stages 2 to 4 of Heidelberger, Teschner, Keiser, Mueller, Gross, "Consistent Penetration Depth Estimation
// for Deformable Collision Response", Vision, Modeling, Visualization 2004. docs/depth.md says what differs,
// and why.
#include "depth/consistent.hpp"

#include "base/vectors.hpp"
#include "depth/closest.hpp"
#include "exact/predicates.hpp"

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
    bool write(Point& point) const {
        const double mean = length(direction_);
        if (!(mean >= least_mean * weights_) || weights_ == 0) return false;
        const Vec3d direction = (1 / mean) * direction_;
        const double depth = (depth_ + dot(way_, direction) / 2) / weights_;
        if (!(depth > 0)) return false;
        point.depth = depth;
        point.direction = direction;
        return true;
    }

private:
    double weights_ = 0, depth_ = 0;
    Vec3d way_{0, 0, 0}, direction_{0, 0, 0};
};

class Stages {
public:
    Stages(const BodyPair& pair, std::span<Point> points, std::span<std::uint32_t> number,
           std::span<std::uint32_t> queue, Normals& normals, Counts& counts)
        : pair_(pair), points_(points), number_(number), queue_(queue), normals_(normals), counts_(counts) {}

    void run() {
        normals_.begin(pair_.b); // the only call that can fail
        for (std::uint32_t i = 0; i < points_.size(); ++i) number_[points_[i].vertex] = i + 1;
        find_border();
        propagate();
        mark_unreached();
        for (const Point& point : points_) number_[point.vertex] = 0;
    }

private:
    Vec3d position(std::uint32_t vertex) const { return pair_.positions_a.exact(vertex); }
    std::span<const std::uint32_t> neighbours(const Point& point) const {
        return pair_.topology_a->neighbours_of(point.vertex);
    }
    // The point of a vertex, or null when the vertex does not collide.
    Point* colliding(std::uint32_t vertex) const {
        const std::uint32_t number = number_[vertex];
        return number == 0 ? nullptr : &points_[number - 1];
    }
    void push(const Point& point) { queue_[queued_++] = static_cast<std::uint32_t>(&point - points_.data()); }

    void find_border();
    bool is_coincident(Point& point) const;
    void trace_edges(Point& point);
    void propagate();
    void take_mean(Point& point) const;
    void mark_unreached();

    const BodyPair& pair_;
    std::span<Point> points_;
    std::span<std::uint32_t> number_; // by vertex of body a, its place in points_ plus 1, or 0
    std::span<std::uint32_t> queue_;
    std::size_t queued_ = 0;
    Normals& normals_;
    Counts& counts_;
};

// The first wave is made of the points with an edge that leads out.
void Stages::find_border() {
    for (Point& point : points_) {
        const bool coincident = !point.interior && is_coincident(point);
        bool border = false;
        for (const std::uint32_t q : neighbours(point)) border |= number_[q] == 0;
        if (!border) continue;
        if (!coincident) trace_edges(point);
        point.wave = point.state == VOX_PENETRATION_CROSSING ? Point::unusable : 1;
        push(point);
    }
}

// Whether a point, which may be on the boundary of its tetrahedron, is on the surface. It is when the corners
// whose weights are not zero are corners of one triangle of the surface. Sets its state and direction then.
bool Stages::is_coincident(Point& point) const {
    const Solid& b = pair_.b;
    const Tet& tet = b.tets[point.tet];
    const Vec3d p = position(point.vertex);
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
    point.interior = count == 4;
    if (count == 0 || count == 4) return false;
    bool on_surface = false;
    for (const std::uint32_t t : b.topology->ring_of(support[0])) {
        const Triangle& triangle = b.topology->triangles[t];
        if (pair_.self && has_corner(triangle, point.vertex)) continue;
        if (count > 1 && !has_corner(triangle, support[1])) continue;
        if (count > 2 && !has_corner(triangle, support[2])) continue;
        on_surface = true;
        const Closest closest = closest_point(b, t, p);
        point.direction = normals_.at(closest.at, closest.at.point - b.at(triangle.apex));
        if (length(point.direction) > 0) break;
    }
    if (!on_surface) return false;
    if (!(length(point.direction) > 0))
        point.direction = facet_normal(b, point.tet, on); // all triangles are without area
    point.state = VOX_PENETRATION_COINCIDENT;
    return true;
}

void Stages::trace_edges(Point& point) {
    const Vec3d p = position(point.vertex);
    Vec3d inside = p;
    if (!point.interior) { // start from where no facet or edge can be missed
        const Solid& b = pair_.b;
        const std::uint32_t* v = b.tets[point.tet].v;
        const Vec3d middle = 0.25 * ((b.at(v[0]) + b.at(v[1])) + (b.at(v[2]) + b.at(v[3])));
        inside = p + 0x1p-20 * (middle - p);
    }
    NeighbourMean mean;
    bool lost = false;
    for (const std::uint32_t neighbour : neighbours(point)) {
        if (number_[neighbour] != 0) continue;
        ++counts_.leaving_edges;
        const Vec3d q = position(neighbour);
        SurfacePoint crossing;
        Vec3d normal{0, 0, 0};
        if (walk_out(pair_.b, point.tet, inside, q, crossing, counts_.edge_tests) &&
            !(pair_.self && has_corner(pair_.b.topology->triangles[crossing.triangle], point.vertex)))
            normal = normals_.at(crossing, q - p);
        if (!(length(normal) > 0)) {
            lost = true;
            continue;
        }
        const Vec3d way = crossing.point - p;
        const double squared = dot(way, way);
        if (!(squared > no_distance)) {
            point.state = VOX_PENETRATION_COINCIDENT;
            point.direction = normal;
            return;
        }
        mean.add(1 / squared, way, 0, normal);
    }
    point.state = !lost && mean.write(point) ? VOX_PENETRATION_SURFACE : VOX_PENETRATION_CROSSING;
}

// Each wave takes its means over all points of the waves before it.
void Stages::propagate() {
    std::size_t first = 0;
    for (std::uint32_t wave = 2; first < queued_; ++wave) {
        const std::size_t last = queued_;
        for (; first < last; ++first) {
            const Point& from = points_[queue_[first]];
            if (from.wave == Point::unusable) continue;
            for (const std::uint32_t neighbour : neighbours(from)) {
                Point* to = colliding(neighbour);
                if (!to || to->wave != Point::unreached) continue;
                to->wave = wave;
                push(*to);
            }
        }
        for (std::size_t i = last; i < queued_; ++i)
            if (points_[queue_[i]].state != VOX_PENETRATION_COINCIDENT) take_mean(points_[queue_[i]]);
        // Only now, because points of one wave must not see each other.
        for (std::size_t i = last; i < queued_; ++i) {
            Point& point = points_[queue_[i]];
            if (point.state == VOX_PENETRATION_CROSSING) point.wave = Point::unusable;
        }
    }
}

void Stages::take_mean(Point& point) const {
    const Vec3d p = position(point.vertex);
    NeighbourMean mean;
    for (const std::uint32_t neighbour : neighbours(point)) {
        const Point* from = colliding(neighbour);
        if (!from || from->wave >= point.wave || from->wave == Point::unreached) continue;
        const Vec3d way = position(neighbour) - p;
        const double squared = dot(way, way);
        if (!(squared > no_distance)) { // at the same place
            mean = NeighbourMean();
            mean.add(1, way, from->depth, from->direction);
            break;
        }
        mean.add(1 / squared, way, from->depth, from->direction);
    }
    point.state = mean.write(point) ? VOX_PENETRATION_PROPAGATED : VOX_PENETRATION_CROSSING;
}

// Points that no wave reached become CROSSING when they are connected to a CROSSING point, and stay ENCLOSED
// otherwise.
void Stages::mark_unreached() {
    queued_ = 0;
    for (const Point& point : points_)
        if (point.wave == Point::unusable) push(point);
    for (std::size_t first = 0; first < queued_; ++first)
        for (const std::uint32_t neighbour : neighbours(points_[queue_[first]])) {
            Point* to = colliding(neighbour);
            if (!to || to->wave != Point::unreached) continue;
            to->wave = Point::unusable;
            if (to->state != VOX_PENETRATION_COINCIDENT) to->state = VOX_PENETRATION_CROSSING;
            push(*to);
        }
}

} // namespace

void find_consistent_depths(const BodyPair& pair, std::span<Point> points, std::span<std::uint32_t> number,
                            std::span<std::uint32_t> queue, Normals& normals, Counts& counts) {
    Stages(pair, points, number, queue, normals, counts).run();
}

} // namespace vox::depth
