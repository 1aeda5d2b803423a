// What depth/near.* finds near a point is decided in double: the closest point, and in a fold the closest
// that a straight line reaches.
#include "depth/closest.hpp"

#include "base/vectors.hpp"
#include "exact/closest_point.hpp"

#include <cmath>

namespace vox::depth {

namespace {

float most_of(const float (&p)[3]) { return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}); }

} // namespace

Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p) {
    const std::uint32_t* v = solid.topology->triangles[triangle].v;
    const Vec3d a = solid.at(v[0]), b = solid.at(v[1]), c = solid.at(v[2]);
    const auto [at, way] = closest_seen_from(p, a, b, c);
    return {{triangle, {at.weight[0], at.weight[1], at.weight[2]}, p + way}, way, at.squared_distance};
}

// ---- searches ---------------------------------------------------------------------------------------

// A point in the frame of the tree, and how far a search has to look for points up to some distance.
class SurfaceTree::Query {
public:
    Query(const SurfaceTree& tree, const Vec3d& p) : scale_(tree.scale_) {
        const Vec3d at = tree.scale_ * (p - tree.middle_);
        p_[0] = static_cast<float>(at.x);
        p_[1] = static_cast<float>(at.y);
        p_[2] = static_cast<float>(at.z);
        const float most = most_of(p_);
        constexpr float far = 0x1p40f; // beyond it, squares might overflow
        if (most < far) {
            slack_ = 0x1p-18 * double{most + tree.most_};
        } else {
            for (float& x : p_) x = 0;
            slack_ = infinity;
        }
    }
    const float (&point() const)[3] { return p_; }
    float reach(double squared) const {
        constexpr double rounding = 1 + 0x1p-19;
        return static_cast<float>(rounding * (std::sqrt(squared) * scale_ + slack_));
    }

private:
    float p_[3];
    double scale_, slack_;
};

// Receives the triangles near a point.
class SurfaceTree::Receiver {
protected:
    Receiver(const SurfaceTree& tree, const Vec3d& p, std::uint32_t left_out, std::uint32_t part,
             SearchState& state)
        : tree_(tree), query_(tree, p), p_(p), left_out_(left_out), part_(part), state_(state) {}

    // The closest point of a triangle; false where it is left out.
    bool look_at(std::uint32_t triangle, Closest& found) {
        const Triangle& corners = tree_.solid_.topology->triangles[triangle];
        if (has_corner(corners, left_out_) || !tree_.is_in(part_, corners)) return false;
        ++state_.visited;
        found = closest_point(tree_.solid_, triangle, p_);
        return true;
    }
    // The VisitTriangle of a receiver with take() and reach().
    template <class Kind>
    static float visit(void* self, std::uint32_t triangle) {
        static_cast<Kind*>(self)->take(triangle);
        return static_cast<Kind*>(self)->reach();
    }

    const SurfaceTree& tree_;
    const Query query_;
    const Vec3d p_;
    const std::uint32_t left_out_, part_;
    SearchState& state_;
};

// Keeps the closest.
class SurfaceTree::NearestOne : Receiver {
public:
    NearestOne(const SurfaceTree& tree, const Vec3d& p, std::uint32_t left_out, std::uint32_t part,
               SearchState& state, Closest& out)
        : Receiver(tree, p, left_out, part, state), out_(out) {}

    bool run() {
        if (state_.near != SearchState::none) take(state_.near);
        find_near(tree_.view_, part_, query_.point(), reach_, visit<NearestOne>, this);
        if (found_) state_.near = out_.at.triangle;
        return found_;
    }

private:
    friend Receiver;

    float reach() const { return reach_; }
    void take(std::uint32_t triangle) {
        if (found_ && triangle == out_.at.triangle) return;
        Closest candidate;
        if (!look_at(triangle, candidate)) return;
        if (found_ && (candidate.squared > out_.squared ||
                       (candidate.squared == out_.squared &&
                        !tree_.solid_.topology->before(candidate.at.triangle, out_.at.triangle))))
            return;
        found_ = true;
        out_ = candidate;
        reach_ = query_.reach(candidate.squared);
    }

    Closest& out_;
    float reach_ = std::numeric_limits<float>::infinity();
    bool found_ = false;
};

bool SurfaceTree::find_among(const Vec3d& p, std::uint32_t left_out, std::uint32_t part, SearchState& state,
                             Closest& out) const {
    return NearestOne(*this, p, left_out, part, state, out).run();
}

// ---- folds ------------------------------------------------------------------------------------------

// Where a closest point lies: inside a triangle, inside an edge or at a vertex, by the corners with a weight.
struct Place {
    std::uint32_t vertex[3] = {SurfaceTree::no_vertex, SurfaceTree::no_vertex, SurfaceTree::no_vertex};
    std::uint32_t count = 0;

    Place() = default;
    Place(const Topology& topology, const SurfacePoint& at) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (at.weight[i] == 0) continue;
            std::size_t k = count++;
            const std::uint32_t corner = topology.triangles[at.triangle].v[i];
            for (; k > 0 && vertex[k - 1] > corner; --k) vertex[k] = vertex[k - 1];
            vertex[k] = corner;
        }
    }
    bool operator==(const Place&) const = default;
};

namespace {

// The way from p to the closest point there, the same for all triangles that meet there.
Vec3d way_to(const Solid& solid, const Place& place, const Vec3d& p, const Closest& found) {
    if (place.count == 3) return found.way;
    const Vec3d a = solid.at(place.vertex[0]);
    if (place.count == 1) return a - p;
    const Vec3d along = solid.at(place.vertex[1]) - a;
    const double squared = dot(along, along);
    const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
    return (a - p) + t * along;
}

// True if no point of the surface next to the place is nearer than the place is, which is at the end of
// `way`.
bool is_local_minimum(const Solid& solid, const Place& place, const Vec3d& way) {
    if (place.count == 3) return true;
    const Vec3d origin = solid.at(place.vertex[0]);
    const Vec3d along = place.count == 2 ? solid.at(place.vertex[1]) - origin : Vec3d{0, 0, 0};
    const double squared = dot(along, along);
    for (const std::uint32_t t : solid.topology->ring_of(place.vertex[0])) {
        const Triangle& triangle = solid.topology->triangles[t];
        if (place.count == 2 && !has_corner(triangle, place.vertex[1])) continue;
        for (const std::uint32_t v : triangle.v) {
            if (v == place.vertex[0] || v == place.vertex[1]) continue;
            // The way into the triangle, at right angles to the edge.
            Vec3d into = solid.at(v) - origin;
            if (squared > 0) into = into - (dot(into, along) / squared) * along;
            constexpr double rounding = 1e-12, squared_rounding = rounding * rounding;
            const double nearer = -dot(way, into);
            if (nearer > 0 && nearer * nearer > squared_rounding * dot(way, way) * dot(into, into))
                return false;
        }
    }
    return true;
}

} // namespace

struct FoundPlace {
    Place place;
    Closest found;
};

// The nearest of different places, in order.
template <std::size_t capacity>
class Nearest {
public:
    explicit Nearest(const Topology& topology) : topology_(topology) {}

    bool before(const Closest& a, const Closest& b) const {
        return a.squared != b.squared ? a.squared < b.squared
                                      : topology_.before(a.at.triangle, b.at.triangle);
    }
    // Call it before add().
    bool wants(const Closest& found) const {
        return size_ < capacity || before(found, list_[size_ - 1].found);
    }
    void add(const Place& place, const Closest& found) {
        std::size_t last = 0;
        while (last < size_ && !(list_[last].place == place)) ++last;
        if (last < size_ && !before(found, list_[last].found)) return;
        if (last == size_) {
            if (size_ < capacity) ++size_;
            last = size_ - 1;
        }
        for (; last > 0 && before(found, list_[last - 1].found); --last) list_[last] = list_[last - 1];
        list_[last] = {place, found};
    }
    bool has(const Place& place) const {
        return std::any_of(begin(), end(), [&](const FoundPlace& known) { return known.place == place; });
    }
    // The squared distance within which another is wanted.
    double squared() const { return size_ < capacity ? infinity : list_[size_ - 1].found.squared; }

    const FoundPlace* begin() const { return list_; }
    const FoundPlace* end() const { return list_ + size_; }

private:
    const Topology& topology_;
    FoundPlace list_[capacity];
    std::size_t size_ = 0;
};

// Keeps the nearest places for a vertex in a fold.
class SurfaceTree::NearestPlaces : Receiver {
public:
    NearestPlaces(const SurfaceTree& tree, const Line& line, std::uint32_t part, SearchState& state)
        : Receiver(tree, line.p, line.vertex, part, state), line_(line), places_(*tree.solid_.topology) {}

    // Returns whether a straight line reaches one of them, not the first, which was tried before.
    bool run(Closest& out) {
        find_nearest_first(tree_.view_, part_, query_.point(), query_.reach(infinity), visit<NearestPlaces>,
                           this);
        for (const FoundPlace* next = places_.begin() + 1; next < places_.end(); ++next) {
            const Vec3d way = way_to(tree_.solid_, next->place, line_.p, next->found);
            if (!tree_.reaches(line_, way)) continue;
            out = next->found;
            return true;
        }
        return false;
    }

    bool has(const Place& place) const { return places_.has(place); }

private:
    friend Receiver;

    float reach() const { return query_.reach(places_.squared()); }
    void take(std::uint32_t triangle) {
        Closest found;
        if (look_at(triangle, found) && places_.wants(found))
            places_.add(Place(*tree_.solid_.topology, found.at), found);
    }

    const Line line_;
    Nearest<4> places_;
};

// Tries the nearest places where the distance from a vertex in a fold has a local minimum.
class SurfaceTree::NearestMinima : Receiver {
public:
    // Those in `tried` are known not to be reached. None is tried at a greater squared distance than
    // `squared_exit`.
    NearestMinima(const SurfaceTree& tree, const Line& line, std::uint32_t part, const NearestPlaces& tried,
                  double squared_exit, SearchState& state)
        : Receiver(tree, line.p, line.vertex, part, state), line_(line), tried_(tried),
          squared_exit_(squared_exit), minima_(*tree.solid_.topology) {}

    // Returns whether a straight line reaches one of them.
    bool run(Closest& out) {
        find_nearest_first(tree_.view_, part_, query_.point(), reach(), visit<NearestMinima>, this);
        if (!is_reached_ || !minima_.has(reached_.place)) return false;
        out = reached_.found;
        return true;
    }

private:
    friend Receiver;

    float reach() const {
        const double squared = std::min(squared_exit_, minima_.squared());
        return query_.reach(is_reached_ ? std::min(squared, reached_.found.squared) : squared);
    }

    // Tries each place at once, since one that is reached makes the search short.
    void take(std::uint32_t triangle) {
        Closest found;
        if (!look_at(triangle, found)) return;
        if (found.squared > squared_exit_ || !minima_.wants(found)) return;
        if (is_reached_ && !minima_.before(found, reached_.found)) return;
        const Place place(*tree_.solid_.topology, found.at);
        const Vec3d way = way_to(tree_.solid_, place, line_.p, found);
        const bool is_known = minima_.has(place);
        if (!is_known && !is_local_minimum(tree_.solid_, place, way)) return;
        minima_.add(place, found);
        // A place is tried once, and belongs to the first of the triangles that meet there.
        if (is_known ? !(is_reached_ && reached_.place == place)
                     : tried_.has(place) || !tree_.reaches(line_, way))
            return;
        is_reached_ = true;
        reached_ = {place, found};
    }

    const Line line_;
    const NearestPlaces& tried_;
    const double squared_exit_;
    Nearest<8> minima_;
    FoundPlace reached_;
    bool is_reached_ = false;
};

// The squared distance at which a line in the direction of `way` leaves the fold, or 0 where it does not.
double SurfaceTree::squared_exit(const Line& line, const Vec3d& way) const {
    // A fixed multiple: what a walk meets may depend on rounding where the line passes through a vertex.
    constexpr double beyond = 0x1p12;
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (!walk_out(solid_, line.tet, line.p, line.p + beyond * way, out, tets) ||
        has_corner(solid_.topology->triangles[out.triangle], line.vertex))
        return 0;
    const Vec3d whole = out.point - line.p;
    return dot(whole, whole);
}

// True if a line leads inside the fold to the point at the end of `way`.
bool SurfaceTree::reaches(const Line& line, const Vec3d& way) const {
    if (dot(way, way) == 0) return true;
    // The walk goes twice as far, so that rounding does not end it too early.
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (!walk_out(solid_, line.tet, line.p, line.p + 2.0 * way, out, tets)) return false;
    const Vec3d whole = out.point - line.p, rest = whole - way;
    constexpr double rounding = 1e-12; // squared
    return !has_corner(solid_.topology->triangles[out.triangle], line.vertex) &&
           dot(rest, rest) <= rounding * dot(whole, whole);
}

bool SurfaceTree::find_in_part(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, SearchState& state,
                               Closest& out) const {
    const std::uint32_t part = part_of(tet);
    return find_among(p, vertex, part, state, out) || (part != all_parts && find(p, vertex, state, out));
}

bool SurfaceTree::find_in_fold(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, SearchState& state,
                               Closest& out) const {
    const std::uint32_t part = part_of(tet);
    if (!find_among(p, vertex, part, state, out)) return part != all_parts && find(p, vertex, state, out);
    const Line line{p, vertex, tet};
    if (reaches(line, out.way)) return true;
    NearestPlaces places(*this, line, part, state);
    Closest other;
    bool found = places.run(other);
    if (!found) {
        const double exit = squared_exit(line, out.way);
        found = exit > 0 && NearestMinima(*this, line, part, places, exit, state).run(other);
    }
    if (found) out = other;
    return found || part == all_parts || find(p, vertex, state, out);
}

} // namespace vox::depth
