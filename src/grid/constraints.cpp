// Two passes over what the stages found: the first counts constraints by pair and kind, the second lists
// where each comes from. Then each is written by itself.
#include "grid/constraints.hpp"

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "depth/closest.hpp"
#include "exact/accurate.hpp"
#include "exact/predicates.hpp"
#include "grid/pairs.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vox {

namespace {

void write_vector(double (&out)[3], const Vec3d& v) noexcept {
    out[0] = v.x + 0.0; // never -0
    out[1] = v.y + 0.0;
    out[2] = v.z + 0.0;
}

void write_pair(const Body& a, const Body& b, vox_constraint_kind kind, std::uint32_t pair,
                std::uint32_t left_out, vox_constraint& c) noexcept {
    c.body_a = a.mesh_id;
    c.body_b = b.mesh_id;
    c.user_data_a = a.user_data;
    c.user_data_b = b.user_data;
    c.kind = kind;
    c.pair = pair;
    c.left_out = left_out;
}

// When a vertex inside met the surface; 1 if that is not known.
double time_of(std::span<const SurfaceMeeting> meetings, vox_body a, std::uint32_t vertex,
               vox_body b) noexcept {
    const std::tuple sought(a, vertex, b);
    const auto at = std::ranges::lower_bound(meetings, sought, {}, place_of<SurfaceMeeting>);
    return at != meetings.end() && place_of(*at) == sought ? at->time : 1;
}

// The closest triangle in place of the tetrahedron: corners, the lowest first and counter-clockwise as seen
// from outside, and weights.
void write_triangle(const depth::Solid& solid, std::uint32_t index, const Vec3d& p,
                    vox_constraint& c) noexcept {
    const Triangle& triangle = solid.topology->triangles[index];
    std::size_t order[3] = {0, 1, 2}; // of its corners
    const auto lowest = static_cast<std::size_t>(std::min_element(triangle.v, triangle.v + 3) - triangle.v);
    std::rotate(order, order + lowest, order + 3);
    const auto corner = [&](std::size_t i) { return solid.at(triangle.v[order[i]]); };
    std::uint64_t exact_tests = 0;
    int inside = orientation(corner(0), corner(1), corner(2), solid.at(triangle.apex), exact_tests);
    if (inside == 0) inside = orientation(corner(0), corner(1), corner(2), p, exact_tests);
    if (inside > 0 || (inside == 0 && triangle.v[order[1]] > triangle.v[order[2]]))
        std::swap(order[1], order[2]);
    const std::array<double, 3> weights = normalised(depth::closest_point(solid, index, p).at.weight);
    const Vec3d normal = vector_of(c.normal);
    double sum = dot(normal, p);
    for (std::size_t i = 0; i < 3; ++i) {
        c.vertices[1 + i] = triangle.v[order[i]];
        c.weights[1 + i] = -weights[order[i]];
        sum += c.weights[1 + i] * dot(normal, corner(i));
    }
    c.count = 4;
    c.vertices[4] = 0;
    c.weights[4] = 0;
    c.offset = c.gap - sum;
}

} // namespace

Constraints::Constraints(std::pmr::memory_resource* memory)
    : now_(memory), last_(memory), pair_offsets_(memory), sources_(memory), listed_(memory), place_(memory),
      spots_(memory), kept_(memory), left_out_(memory) {}

void Constraints::clear(bool all) noexcept {
    found_ = false; // the list keeps its size, as setting it again would fill it with zeros
    if (all) last_.pairs.clear();
}

void Constraints::begin_step(bool last_succeeded) noexcept {
    if (found_) std::swap(now_, last_);
    clear(!found_ && last_succeeded);
}

Constraints::Key Constraints::key_of(const vox_constraint& c) noexcept {
    Key key{c.body_a, {c.vertices[0], 0, 0, 0, 0}};
    if (c.kind != VOX_CONSTRAINT_EDGE) return key;
    if (c.count == c.count_a) { // with a shape
        key.vertices = {c.vertices[0], c.vertices[1], c.vertices[2], c.count, c.element_b};
        return key;
    }
    std::copy(c.vertices, c.vertices + 5, key.vertices.begin());
    std::sort(key.vertices.begin() + 2, key.vertices.end());
    return key;
}

// With room for a few more, so that a few more in a later step allocate nothing.
void Constraints::make_room(std::size_t listed, std::size_t count, std::size_t pairs) {
    reserve_sparingly(sources_, listed);
    reserve_sparingly(listed_, listed);
    reserve_growing(place_, kinds * pairs);
    reserve_growing(left_out_, pairs);
    reserve_growing(pair_offsets_, pairs + 1);
    for (List* list : {&now_, &last_}) {
        reserve_sparingly(list->all, count);
        reserve_growing(list->pairs, pairs);
        reserve_growing(list->first, kinds * pairs + 1);
    }
}

void Constraints::reserve(std::size_t body_count, std::size_t contact_count) {
    make_room(contact_count, contact_count, 2 * std::min(8 * body_count, contact_count));
}

// ---- where they come from --------------------------------------------------------------------------

// Where constraints come from, kind by kind. Returns where each kind ends.
Constraints::Ends Constraints::list(const ConstraintSources& from) {
    Ends ends{};
    place_.assign(kinds * from.pairs.size(), 0);
    const std::size_t most = from.hits.size() + from.edges.size() + from.proximities.size() +
                             from.impacts.size() + from.shape_count;
    reserve_sparingly(listed_, most);
    if (listed_.size() < most) listed_.resize(most);
    reserve_growing(now_.pairs, from.pairs.size()); // which are the same for all constraints of a step
    now_.pairs.clear();
    for (const vox_pair& pair : from.pairs) now_.pairs.push_back({pair.body_a, pair.body_b});
    PairIndex<IdPair> index(now_.pairs);
    Listed* end = listed_.data();
    const auto count = [&] { return static_cast<std::size_t>(end - listed_.data()); };
    const auto add = [&](vox_body a, vox_body b, vox_constraint_kind kind, std::size_t source) {
        const std::size_t pair = index(a, b);
        if (pair >= from.pairs.size() || !from.chosen[pair]) return;
        ++place_[kinds * pair + kind];
        *end++ = {static_cast<std::uint32_t>(pair), static_cast<std::uint32_t>(source)};
    };
    const auto add_shapes = [&](vox_constraint_kind kind) {
        for (const ShapeRun& run : from.shapes) {
            const std::size_t some = run.of_kind[kind], pair = some > 0 ? index(run.body_a, run.body_b) : 0;
            if (some == 0 || pair >= from.pairs.size() || !from.chosen[pair]) continue;
            place_[kinds * pair + kind] += static_cast<std::uint32_t>(some);
            for (std::size_t i = 0; i < run.count(); ++i)
                if (run.vertices.empty() || run.vertices[i].kind == kind)
                    *end++ = {static_cast<std::uint32_t>(pair), static_cast<std::uint32_t>(run.first + i)};
        }
    };
    if (from.penetrations) {
        const std::span<const Penetration> all = from.penetrations->all();
        for (std::size_t i = 0; i < all.size(); ++i)
            add(all[i].body_a, all[i].body_b, VOX_CONSTRAINT_INSIDE, i);
    } else {
        for (std::size_t i = 0; i < from.hits.size(); ++i)
            if (is_first_of_vertex(from.hits, i))
                add(from.bodies[from.hits[i].body_a].mesh_id, from.bodies[from.hits[i].body_b].mesh_id,
                    VOX_CONSTRAINT_INSIDE, i);
    }
    add_shapes(VOX_CONSTRAINT_INSIDE);
    ends[VOX_CONSTRAINT_INSIDE] = count();
    for (std::size_t i = 0; i < from.edges.size(); ++i)
        add(from.edges[i].body_a, from.edges[i].body_b, VOX_CONSTRAINT_EDGE, i);
    add_shapes(VOX_CONSTRAINT_EDGE);
    ends[VOX_CONSTRAINT_EDGE] = count();
    std::size_t impact = 0; // no vertex has two constraints with one body
    for (std::size_t i = 0; i < from.proximities.size(); ++i) {
        const auto place = place_of(from.proximities[i]);
        while (impact < from.impacts.size() && place_of(from.impacts[impact]) < place) ++impact;
        if (impact < from.impacts.size() && place_of(from.impacts[impact]) == place) continue;
        add(from.proximities[i].body_a, from.proximities[i].body_b, VOX_CONSTRAINT_PROXIMITY, i);
    }
    add_shapes(VOX_CONSTRAINT_PROXIMITY);
    ends[VOX_CONSTRAINT_PROXIMITY] = count();
    for (std::size_t i = 0; i < from.impacts.size(); ++i)
        add(from.impacts[i].body_a, from.impacts[i].body_b, VOX_CONSTRAINT_IMPACT, i);
    add_shapes(VOX_CONSTRAINT_IMPACT);
    ends[VOX_CONSTRAINT_IMPACT] = count();
    return ends;
}

// Those of one pair and kind next to each other, in the order in which they were listed.
void Constraints::order(const ConstraintSources& from, const Ends& ends) {
    const std::size_t count = ends.back();
    check_contact_count(count, "constraints");
    const std::size_t kept = count_kept(from, count);
    make_room(count, kept, from.pairs.size()); // all that can fail
    found_ = false;
    listed_count_ = count;
    now_.all.resize(kept);
    now_.method = from.method;
    now_.closest_budget = from.closest_budget;
    sources_.resize(count);
    pair_offsets_.resize(from.pairs.size() + 1);
    std::exclusive_scan(place_.begin(), place_.end(), place_.begin(), 0u);
    now_.first.assign(place_.begin(), place_.end());
    now_.first.push_back(static_cast<std::uint32_t>(count));
    for (std::size_t p = 0; p <= from.pairs.size(); ++p) pair_offsets_[p] = now_.first[kinds * p];
    std::size_t i = 0;
    for (std::size_t kind = 0; kind < kinds; ++kind)
        for (; i < ends[kind]; ++i) sources_[place_[kinds * listed_[i].pair + kind]++] = listed_[i].source;
}

// ---- the same in the step before -------------------------------------------------------------------

// Looks up constraints of one pair. Keys of a kind ascend, so each search begins where the last one ended.
class Constraints::Previous {
public:
    explicit Previous(const List& last) noexcept : last_(last) {}

    // Pairs in ascending order.
    void begin(const IdPair& pair) noexcept {
        if (at_ == none)
            at_ = static_cast<std::size_t>(std::ranges::lower_bound(last_.pairs, pair) - last_.pairs.begin());
        while (at_ < last_.pairs.size() && last_.pairs[at_] < pair) ++at_;
        known_ = at_ < last_.pairs.size() && last_.pairs[at_] == pair;
        if (!known_) return;
        first_ = last_.first.data() + kinds * at_;
        std::copy(first_, first_ + kinds, next_.begin());
    }

    // The index of the first constraint of a kind, of which there have to be so many; or VOX_NONE.
    std::uint32_t first(vox_constraint_kind kind, std::size_t count) const noexcept {
        return known_ && first_[kind + 1] - first_[kind] == count ? first_[kind] : VOX_NONE;
    }

    std::uint32_t find(vox_constraint_kind kind, const Key& key) noexcept {
        if (!known_) return VOX_NONE;
        // As a rule the next one is the same.
        const std::uint32_t next = next_[kind];
        if (next < first_[kind + 1] && has_key(last_.all[next], key)) return next_[kind]++;
        std::uint32_t found = find_among(kind, key);
        if (kind == VOX_CONSTRAINT_EDGE) return found;
        for (const auto other : {VOX_CONSTRAINT_INSIDE, VOX_CONSTRAINT_PROXIMITY, VOX_CONSTRAINT_IMPACT})
            if (found == VOX_NONE && other != kind) found = find_among(other, key);
        return found;
    }

private:
    // As a rule the first two numbers say it.
    static bool has_key(const vox_constraint& c, const Key& key) noexcept {
        return c.vertices[0] == key.vertices[0] && c.body_a == key.body_a &&
               (c.kind != VOX_CONSTRAINT_EDGE || key_of(c) == key);
    }

    // Constraints of another kind are looked up in any order, hence the first test.
    std::uint32_t find_among(vox_constraint_kind kind, const Key& key) noexcept {
        const auto key_at = [&](std::uint32_t i) { return key_of(last_.all[i]); };
        const std::uint32_t end = first_[kind + 1];
        std::uint32_t low = next_[kind];
        if (low > first_[kind] && key_at(low - 1) >= key) low = first_[kind];
        std::uint32_t high = low;
        for (std::uint32_t step = 1; high < end && key_at(high) < key; step *= 2) {
            low = high + 1;
            high = end - high > step ? high + step : end;
        }
        const auto between = std::span(last_.all).subspan(low, high - low);
        const auto at = std::ranges::lower_bound(between, key, {}, key_of);
        next_[kind] = low + static_cast<std::uint32_t>(at - between.begin());
        return next_[kind] < end && has_key(last_.all[next_[kind]], key) ? next_[kind] : VOX_NONE;
    }

    const List& last_;
    static constexpr std::size_t none = ~std::size_t{0};
    std::size_t at_ = none;                // of the pair
    const std::uint32_t* first_ = nullptr; // of its kinds
    std::array<std::uint32_t, kinds> next_{};
    bool known_ = false;
};

// ---- each of them -----------------------------------------------------------------------------------

namespace {

// Writes stencil, normal, gap, state, element and time of a constraint that is not INSIDE. Returns body_a.
struct Writer {
    const ConstraintSources& from;

    vox_body write_edge(std::uint32_t source, vox_constraint& c) const {
        const EdgeContact& contact = from.edges[source];
        c.count_a = 2;
        c.count = 5;
        std::copy_n(contact.edge, 2, c.vertices);
        std::copy_n(contact.face, 3, c.vertices + 2);
        c.element_b = contact.tet;
        c.weights[0] = contact.edge_weights[0];
        c.weights[1] = contact.edge_weights[1];
        for (int i = 0; i < 3; ++i) c.weights[2 + i] = -contact.face_weights[i];
        c.time = 1;
        c.state = contact.kind == CrossingKind::through ? VOX_DEPTH_UNKNOWN : VOX_DEPTH_TOUCHING;
        if (c.state == VOX_DEPTH_TOUCHING) std::copy_n(contact.normal, 3, c.normal);
        if (from.edge_depths.empty() || c.state == VOX_DEPTH_TOUCHING) return contact.body_a;
        const Depth& depth = from.edge_depths[source];
        c.state = !(depth.depth > 0)                 ? VOX_DEPTH_TOUCHING
                  : contact.body_a == contact.body_b ? VOX_DEPTH_PLANE
                                                     : VOX_DEPTH_CLOSEST;
        c.gap = depth.depth > 0 ? -depth.depth : 0;
        std::copy_n(depth.direction, 3, c.normal);
        return contact.body_a;
    }

    // The vertex of an impact or a proximity, and its face.
    template <class Contact>
    void write_face(const Contact& contact, const double (&weights)[3], vox_constraint& c) const {
        c.count_a = 1;
        c.count = 4;
        c.vertices[0] = contact.vertex;
        std::copy_n(contact.face, 3, c.vertices + 1);
        for (int i = 0; i < 3; ++i) c.weights[1 + i] = -weights[i];
        c.element_b = contact.tet;
    }

    vox_body write_proximity(std::uint32_t source, vox_constraint& c) const {
        const Proximity& contact = from.proximities[source];
        write_face(contact, contact.face_weights, c);
        c.gap = contact.distance;
        c.state = contact.distance > 0 ? VOX_DEPTH_CLOSEST : VOX_DEPTH_TOUCHING;
        std::copy_n(contact.normal, 3, c.normal);
        c.time = 1;
        return contact.body_a;
    }

    vox_body write_impact(std::uint32_t source, vox_constraint& c) const {
        const Impact& impact = from.impacts[source];
        write_face(impact, impact.weights, c);
        c.gap = impact.gap;
        c.state = VOX_DEPTH_PLANE;
        std::copy_n(impact.normal, 3, c.normal);
        c.time = impact.time;
        return impact.body_a;
    }
};

} // namespace

// The constraints of two meshes and one kind other than INSIDE.
void Constraints::write_others(const ConstraintSources& from, const Run& run, Previous& previous) noexcept {
    const Writer writer{from};
    const auto& [lower, higher] = now_.pairs[run.pair];
    const Body* const bodies[2] = {&from.bodies[body_index(from.bodies, lower)],
                                   &from.bodies[body_index(from.bodies, higher)]};
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const std::uint32_t source = sources_[i];
        vox_constraint& c = now_.all[i];
        c = {};
        c.weights[0] = 1;
        const vox_body id_a = run.kind == VOX_CONSTRAINT_EDGE        ? writer.write_edge(source, c)
                              : run.kind == VOX_CONSTRAINT_PROXIMITY ? writer.write_proximity(source, c)
                                                                     : writer.write_impact(source, c);
        const bool swapped = id_a != lower;
        const Body &a = *bodies[swapped], &b = *bodies[!swapped];
        write_pair(a, b, run.kind, run.pair, left_out_[run.pair], c);
        write_vector(c.normal, vector_of(c.normal));
        c.previous = previous.find(run.kind, key_of(c));
        double sum = 0;
        for (std::uint32_t v = 0; v < c.count; ++v) {
            const Vec3d x = (v < c.count_a ? a : b).positions.exact(c.vertices[v]);
            if (v == 0 && run.kind != VOX_CONSTRAINT_EDGE) write_vector(c.position, x);
            sum += c.weights[v] * dot(vector_of(c.normal), x);
        }
        if (run.kind == VOX_CONSTRAINT_EDGE) std::copy_n(from.edges[source].position, 3, c.position);
        c.offset = c.gap - sum;
    }
}

// A mesh with a shape.
void Constraints::write_shapes(const ConstraintSources& from, const Run& run, Previous& previous) noexcept {
    const ShapeRun* found = from.run_of(sources_[run.begin]);
    const Body &a = from.bodies[body_index(from.bodies, found->body_a)],
               &b = from.bodies[body_index(from.bodies, found->body_b)];
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const std::uint32_t source = sources_[i];
        while (source - found->first >= found->count()) ++found;
        const std::size_t at = source - found->first;
        vox_constraint& c = now_.all[i];
        c = {};
        write_pair(a, b, run.kind, run.pair, left_out_[run.pair], c);
        const auto write_common = [&c](const auto& contact) {
            c.element_b = contact.element;
            c.state = contact.state;
            c.gap = contact.gap;
            write_vector(c.normal, vector_of(contact.normal));
        };
        c.count_a = c.count = 1;
        c.weights[0] = c.time = 1;
        if (found->edges.empty()) {
            const ShapeVertex& contact = found->vertices[at];
            write_common(contact);
            c.vertices[0] = contact.vertex;
            c.time = contact.time;
        } else {
            const ShapeEdge& contact = found->edges[at];
            write_common(contact);
            c.count_a = c.count = contact.count;
            std::copy_n(contact.vertices, 3, c.vertices);
            std::copy_n(contact.weights, 3, c.weights);
        }
        Vec3d point{0, 0, 0};
        for (std::uint32_t v = 0; v < c.count; ++v)
            point = point + c.weights[v] * a.positions.exact(c.vertices[v]);
        write_vector(c.position, point);
        c.offset = c.gap - dot(vector_of(c.normal), point);
        c.previous = previous.find(run.kind, key_of(c));
    }
}

// ---- vertices inside -------------------------------------------------------------------------------

namespace {

// Contacts that are weighed together. Their tetrahedra and positions are anywhere in memory, and waiting for
// them takes longer than the arithmetic: while a block is written, those of the next one arrive in the cache.
struct HitBlock {
    std::array<Hit, point_block> hits;
    std::size_t count = 0;

    void fetch(const ConstraintSources& from, std::span<const std::uint32_t> sources) noexcept {
        count = std::min(point_block, sources.size());
        for (std::size_t i = 0; i < count; ++i) {
            hits[i] = from.hit_of(sources[i]);
            prefetch(&from.bodies[hits[i].body_b].tets[hits[i].tet]);
        }
    }
    void prefetch_positions(std::span<const Body> bodies) const noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            const Body& b = bodies[hits[i].body_b];
            const Positions &of_a = bodies[hits[i].body_a].positions, &of_b = b.positions;
            prefetch(of_a.data + hits[i].vertex * of_a.byte_stride);
            for (const std::uint32_t v : b.tets[hits[i].tet].v) prefetch(of_b.data + v * of_b.byte_stride);
        }
    }
    void gather(std::span<const Body> bodies, PointBlock& block) const noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            const Body& b = bodies[hits[i].body_b];
            set(block.point, i, bodies[hits[i].body_a].positions.exact(hits[i].vertex));
            for (std::size_t c = 0; c < 4; ++c)
                set(block.corner[c], i, b.positions.exact(b.tets[hits[i].tet].v[c]));
        }
        fill_last_register(block, count);
    }
};

// Writes all but the previous one. `miss` is the sum of weight * (corner - p).
void write_vertex(const ConstraintSources& from, const Hit& hit, std::uint32_t source, const Vec3d& p,
                  const std::array<double, 4>& weights, const Vec3d& miss, vox_constraint& c) noexcept {
    const Body &a = from.bodies[hit.body_a], &b = from.bodies[hit.body_b];
    c.count_a = 1;
    c.count = 5;
    c.vertices[0] = hit.vertex;
    c.weights[0] = 1;
    for (std::size_t k = 0; k < 4; ++k) {
        c.vertices[1 + k] = b.tets[hit.tet].v[k];
        c.weights[1 + k] = -weights[k];
    }
    c.element_b = hit.tet;
    write_vector(c.position, p);
    c.time = from.meetings.empty() ? 1 : time_of(from.meetings, a.mesh_id, hit.vertex, b.mesh_id);
    c.state = VOX_DEPTH_UNKNOWN;
    c.gap = 0;
    Vec3d normal{0, 0, 0};
    if (from.penetrations) {
        const Depth& depth = from.penetrations->depths()[source];
        c.state = from.penetrations->all()[source].state;
        c.gap = depth.depth > 0 ? -depth.depth : 0;
        normal = depth.way_out();
    }
    write_vector(c.normal, normal);
    c.offset = c.gap + dot(normal, miss);
    if (from.method != VOX_DEPTH_METHOD_CLOSEST || c.state == VOX_DEPTH_UNKNOWN) return;
    const std::uint32_t triangle = from.penetrations->closest()[source];
    if (triangle != no_triangle)
        write_triangle({from.topologies[hit.body_b], b.tets, b.positions}, triangle, p, c);
}

} // namespace

// If a pair's constraints are those of the step before, copies them.
bool Constraints::carry_inside(const ConstraintSources& from, const Run& run,
                               const Previous& previous) noexcept {
    if (now_.method != last_.method || now_.closest_budget != last_.closest_budget) return false;
    const Hit& hit = from.hit_of(sources_[run.begin]);
    if (!from.bodies[hit.body_a].carried || !from.bodies[hit.body_b].carried) return false;
    const std::uint32_t* const bounds = now_.first.data() + kinds * run.pair;
    const std::uint32_t old = previous.first(VOX_CONSTRAINT_INSIDE, bounds[1] - bounds[0]);
    if (old == VOX_NONE) return false;
    for (std::size_t i = run.begin; left_out_[run.pair] > 0 && i < run.end;
         ++i) // others may have stayed then
        if (last_.all[old + (i - bounds[0])].vertices[0] != from.hit_of(sources_[i]).vertex) return false;
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const std::size_t same = old + (i - bounds[0]);
        vox_constraint& c = now_.all[i];
        c = last_.all[same];
        c.pair = run.pair;
        c.left_out = left_out_[run.pair];
        c.previous = static_cast<std::uint32_t>(same);
        c.time = time_of(from.meetings, c.body_a, c.vertices[0], c.body_b);
    }
    return true;
}

// A block at a time, whatever pairs they are of: gather the points and the corners of their tetrahedra, weigh
// them, write.
void Constraints::write_inside(const ConstraintSources& from, const Run& run, Previous& previous) noexcept {
    if (run.begin == run.end) return;
    const std::span<const Body> bodies = from.bodies;
    const std::span<const std::uint32_t> sources = std::span(sources_).first(run.end);
    std::uint32_t pair = run.pair;
    previous.begin(now_.pairs[pair]);
    PointBlock block;
    AccurateWeights weights;
    HitBlock now, next;
    next.fetch(from, sources.subspan(run.begin));
    next.prefetch_positions(bodies);
    for (std::size_t begin = run.begin; begin < run.end; begin += point_block) {
        now = next;
        next.fetch(from, sources.subspan(begin + now.count));
        now.gather(bodies, block);
        next.prefetch_positions(bodies);
        weigh_accurately(block, now.count, true, weights);
        for (std::size_t i = 0; i < now.count; ++i) {
            const Hit& hit = now.hits[i];
            const Body &a = bodies[hit.body_a], &b = bodies[hit.body_b];
            if (begin + i >= pair_offsets_[pair + 1]) {
                while (begin + i >= pair_offsets_[pair + 1]) ++pair;
                previous.begin(now_.pairs[pair]);
            }
            vox_constraint& c = now_.all[begin + i];
            write_pair(a, b, VOX_CONSTRAINT_INSIDE, pair, left_out_[pair], c);
            c.previous = previous.find(VOX_CONSTRAINT_INSIDE, {a.mesh_id, {hit.vertex, 0, 0, 0, 0}});
            const auto at = [i](const double(&of)[3][point_block]) {
                return Vec3d{of[0][i], of[1][i], of[2][i]};
            };
            const Vec3d p = at(block.point);
            std::array<double, 4> w;
            Vec3d miss{0, 0, 0};
            for (std::size_t k = 0; k < 4; ++k) {
                w[k] = weights.weight[k][i];
                miss = miss + w[k] * (at(block.corner[k]) - p);
            }
            write_vertex(from, hit, sources[begin + i], p, w, miss, c);
        }
    }
}

// ---- all of them -----------------------------------------------------------------------------------

bool ConstraintSources::has_shape(const IdPair& pair) const noexcept {
    return !shapes.empty() &&
           (bodies[body_index(bodies, pair.body_a)].shape || bodies[body_index(bodies, pair.body_b)].shape);
}

void Constraints::write(const ConstraintSources& from, std::size_t begin, std::size_t end) noexcept {
    Previous previous(last_), previous_inside(last_);
    Run inside{}; // vertices inside that wait, as long as they follow each other
    const Array<std::uint32_t>& first = now_.first;
    // The pair and kind that `begin` is in; empty ones are passed.
    auto bucket = static_cast<std::size_t>(
        std::upper_bound(first.begin(), first.end(), static_cast<std::uint32_t>(begin)) - first.begin() - 1);
    while (begin < end) {
        while (first[bucket + 1] <= begin) ++bucket;
        const Run run{static_cast<std::uint32_t>(bucket / kinds),
                      static_cast<vox_constraint_kind>(bucket % kinds), begin,
                      std::min<std::size_t>(end, first[bucket + 1])};
        begin = run.end;
        previous.begin(now_.pairs[run.pair]);
        if (from.has_shape(now_.pairs[run.pair])) {
            write_shapes(from, run, previous);
        } else if (run.kind != VOX_CONSTRAINT_INSIDE) {
            write_others(from, run, previous);
        } else if (!carry_inside(from, run, previous)) {
            if (inside.end != run.begin) {
                write_inside(from, inside, previous_inside);
                inside = run;
            }
            inside.end = run.end;
        }
    }
    write_inside(from, inside, previous_inside);
}

void Constraints::find(const ConstraintSources& from, Workers& workers) {
    order(from, list(from));
    if (left_out() > 0) limit(from, workers);
    constexpr std::size_t least = 512; // that are worth a task
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t) { write(from, begin, end); };
    if (now_.all.size() > least)
        workers.for_ranges(now_.all.size(), least, run);
    else
        run(0, now_.all.size(), 0);
    found_ = true;
}

} // namespace vox
