// First all but the surfaces, contact by contact. Then the surfaces, by the mesh that the vertices are in, in
// the order of a curve, so that each search begins next to the one before.
#include "grid/readings.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "depth/points.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace vox {

using namespace depth;

namespace {

void write(double (&out)[3], const Vec3d& v) noexcept {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

// The unit vector along the cross product; zero where that is.
Vec3d unit_normal(const Vec3d& u, const Vec3d& v) noexcept { return normalised(cross(scaled(u), scaled(v))); }

Solid solid_of(const ReadingBody& b) noexcept { return {b.topology, b.body.tets, b.body.positions}; }

// The closest point to the vertex at p, with its triangle wound as vox_reading says.
void write_surface(const Solid& solid, const Vec3d& p, const Closest& closest, vox_reading& out) noexcept {
    const Triangle& triangle = solid.topology->triangles[closest.at.triangle];
    std::size_t order[3] = {0, 1, 2}; // of its corners
    const std::size_t lowest =
        static_cast<std::size_t>(std::min_element(triangle.v, triangle.v + 3) - triangle.v);
    std::rotate(order, order + lowest, order + 3);
    const auto corner = [&](std::size_t i) { return solid.at(triangle.v[order[i]]); };

    std::uint64_t exact_tests = 0;
    const auto side_of = [&](const Vec3d& q) {
        return orientation(corner(0), corner(1), corner(2), q, exact_tests);
    };
    int inside = side_of(solid.at(triangle.apex));
    if (inside == 0) inside = side_of(p);
    if (inside > 0 || (inside == 0 && triangle.v[order[1]] > triangle.v[order[2]]))
        std::swap(order[1], order[2]);

    const std::array<double, 3> weights = normalised(closest.at.weight);
    for (std::size_t i = 0; i < 3; ++i) {
        out.triangle[i] = triangle.v[order[i]];
        out.barycentric[i] = weights[order[i]];
    }
    Vec3d normal = unit_normal(corner(1) - corner(0), corner(2) - corner(0));
    if (!(length(normal) > 0)) normal = normalised(scaled(closest.way));
    if (!(length(normal) > 0)) normal = {0, 0, 1};
    write(out.normal, normal);
    write(out.surface_position, closest.at.point);
    out.distance = std::sqrt(closest.squared);
    out.known |= VOX_READING_SURFACE;
}

} // namespace

Readings::Readings(std::pmr::memory_resource* memory)
    : ids_(memory), bodies_(memory), chosen_(memory), asks_(memory), readings_(memory), depths_(memory) {}

void Readings::require_prepared() const {
    if (!prepared_)
        throw Error(VOX_ERROR_INVALID_STATE, "the contacts of the last step were not read: call "
                                             "vox_grid_prepare_readings after it");
}

const vox_reading* Readings::find(std::uint64_t contact) const noexcept {
    if (contact < readings_.size() && readings_[contact].contact == contact) return &readings_[contact];
    const auto at = std::ranges::lower_bound(readings_, contact, {}, &vox_reading::contact);
    return at != readings_.end() && at->contact == contact ? &*at : nullptr;
}

// ---- which contacts --------------------------------------------------------------------------------

std::span<ReadingBody> Readings::choose(const Events& events, std::span<const vox_body> meshes) {
    all_ = meshes.empty();
    ids_.clear();
    ids_.reserve(2 * events.pairs().size());
    chosen_.clear();
    events.for_pairs_of(meshes, [&](const vox_pair& pair) {
        for (const vox_body id : {pair.body_a, pair.body_b}) ids_.push_back(id);
        const std::span<const std::uint32_t> contacts = events.contacts_of(pair);
        if (!all_) chosen_.insert(chosen_.end(), contacts.begin(), contacts.end());
    });
    std::ranges::sort(chosen_);
    std::ranges::sort(ids_);
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    bodies_.assign(ids_.size(), {});
    for (std::size_t i = 0; i < ids_.size(); ++i) bodies_[i].body.mesh_id = ids_[i];
    events.for_pairs_of(meshes, [&](const vox_pair& pair) {
        ReadingBody &a = bodies_[body_of(pair.body_a)], &b = bodies_[body_of(pair.body_b)];
        a.user_data = pair.user_data_a;
        b.user_data = pair.user_data_b;
        a.is_entered |= pair.b_in_a > 0;
        b.is_entered |= pair.a_in_b > 0;
    });
    return bodies_;
}

std::uint32_t Readings::body_of(vox_body mesh) const noexcept {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(ids_, mesh) - ids_.begin());
}

// ---- all of them -----------------------------------------------------------------------------------

std::uint64_t Readings::prepare(std::uint32_t what, std::uint64_t closest_budget,
                                std::span<const vox_contact> contacts, const Penetrations& penetrations,
                                SurfaceTrees& trees, Workers& workers) {
    const Step step{what, closest_budget, contacts, penetrations};
    const std::size_t count = all_ ? contacts.size() : chosen_.size();
    const bool surfaces = (what & VOX_READING_SURFACE) != 0;
    std::uint64_t left_out = 0;
    // First all that can fail, but for a task system of the caller.
    if (what & (VOX_READING_POSITION | VOX_READING_SURFACE)) check_positions(step, count);
    if (surfaces) {
        left_out = list_asks(step, count);
        fit_trees(trees);
        sort_asks(step);
    }
    const std::size_t depths = what & VOX_READING_DEPTH ? count : 0;
    depths_.reserve(depths);
    readings_.reserve(count);

    prepared_ = false;
    readings_.resize(count);
    depths_.resize(depths);
    // At most one task: that of the surfaces takes longer.
    constexpr std::size_t least_copies = 8192, least_searches = 256; // that are worth a task
    const auto share = [&](bool is_task, std::size_t items, std::size_t least, auto&& function) {
        const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t) { function({begin, end}); };
        if (is_task && items > least)
            workers.for_ranges(items, least, run);
        else
            run(0, items, 0);
    };
    share(!surfaces, count, least_copies, [&](const Range& range) { read_range(range, step); });
    if (surfaces)
        share(true, asks_.size(), least_searches, [&](const Range& asks) { read_surfaces(asks, step); });
    prepared_ = true;
    return left_out;
}

// Where a vertex is, and whether that is known.
bool Readings::has_position(const ReadingBody& a, std::uint32_t vertex) noexcept {
    return a.is_present && vertex < a.body.vertex_count && !has_bit(a.body.removed_vertices, vertex);
}

std::size_t Readings::end_of_vertex(std::size_t first, std::size_t last, const Step& step) const noexcept {
    const vox_contact& contact = step.contacts[contact_of(first)];
    for (++first; first < last; ++first) {
        const vox_contact& next = step.contacts[contact_of(first)];
        if (next.vertex != contact.vertex || next.body_a != contact.body_a || next.body_b != contact.body_b)
            break;
    }
    return first;
}

void Readings::check_positions(const Step& step, std::size_t count) const {
    const ReadingBody* a = nullptr;
    for (std::size_t k = 0; k < count; k = end_of_vertex(k, count, step)) {
        const vox_contact& contact = step.contacts[contact_of(k)];
        if (!a || a->body.mesh_id != contact.body_a) a = &bodies_[body_of(contact.body_a)];
        if (has_position(*a, contact.vertex)) check_finite(a->body, contact.vertex);
    }
}

// ---- all but the surfaces --------------------------------------------------------------------------

// Goes through the penetrations along with contacts, which ascend. They are in the same order, one for all of
// the same vertex and mesh, or none.
class Readings::PenetrationOf {
public:
    static constexpr std::size_t none = ~std::size_t{0};

    explicit PenetrationOf(const Step& step) : all_(step.penetrations.all()), contacts_(step.contacts) {}

    // The place of that of a contact, or none.
    std::size_t operator()(std::uint32_t index) noexcept {
        if (is_reached(index)) ++next_; // as a rule that is all
        if (is_reached(index))
            next_ = static_cast<std::size_t>(
                std::upper_bound(all_.begin() + static_cast<std::ptrdiff_t>(next_), all_.end(), index,
                                 [](std::uint32_t i, const vox_penetration& p) { return i < p.contact; }) -
                all_.begin());
        if (next_ == 0) return none;
        const vox_penetration& last = all_[next_ - 1];
        const vox_contact& contact = contacts_[index];
        const bool same =
            last.vertex == contact.vertex && last.body_a == contact.body_a && last.body_b == contact.body_b;
        return same ? next_ - 1 : none;
    }

private:
    bool is_reached(std::uint32_t index) const noexcept {
        return next_ < all_.size() && all_[next_].contact <= index;
    }

    std::span<const vox_penetration> all_;
    std::span<const vox_contact> contacts_;
    std::size_t next_ = 0; // the first one after the contact
};

void Readings::read_range(const Range& range, const Step& step) noexcept {
    const ReadingBody *a = nullptr, *b = nullptr;
    PenetrationOf penetration_of(step);
    for (std::size_t k = range.first, last; k < range.last; k = last) {
        last = end_of_vertex(k, range.last, step);
        const vox_contact& contact = step.contacts[contact_of(k)];
        if (!a || a->body.mesh_id != contact.body_a) a = &bodies_[body_of(contact.body_a)];
        if (!b || b->body.mesh_id != contact.body_b) b = &bodies_[body_of(contact.body_b)];
        vox_reading out{};
        out.user_data_a = a->user_data;
        out.user_data_b = b->user_data;
        if ((step.what & VOX_READING_POSITION) && has_position(*a, contact.vertex)) {
            write(out.position, a->body.positions.exact(contact.vertex));
            out.known |= VOX_READING_POSITION;
        }
        vox_depth depth{};
        const std::size_t place =
            step.what & VOX_READING_DEPTH ? penetration_of(contact_of(k)) : PenetrationOf::none;
        if (place != PenetrationOf::none) {
            const vox_penetration& from = step.penetrations.all()[place];
            out.state = from.state;
            out.depth = from.depth;
            std::copy_n(from.direction, 3, out.direction);
            out.known |= VOX_READING_DEPTH;
            depth = step.penetrations.depths()[place];
        }
        for (std::size_t same = k; same < last; ++same) { // in several tetrahedra
            out.contact = contact_of(same);
            readings_[same] = out;
            if (step.what & VOX_READING_DEPTH) depths_[same] = depth;
        }
    }
}

// ---- surfaces --------------------------------------------------------------------------------------

// Returns how many were not listed, as no search was left for them.
std::uint64_t Readings::list_asks(const Step& step, std::size_t count) {
    asks_.clear();
    asks_.reserve(count);
    std::uint64_t searches = 0;
    const ReadingBody* a = nullptr;
    std::uint32_t b = 0;
    PenetrationOf penetration_of(step);
    for (std::size_t k = 0, last; k < count; k = last) {
        last = end_of_vertex(k, count, step);
        const vox_contact& contact = step.contacts[contact_of(k)];
        if (!a || a->body.mesh_id != contact.body_a) a = &bodies_[body_of(contact.body_a)];
        if (ids_[b] != contact.body_b) b = body_of(contact.body_b);
        if (!bodies_[b].topology || !has_position(*a, contact.vertex)) continue;
        bodies_[b].is_in_itself |= a == &bodies_[b];
        const std::size_t place =
            bodies_[b].is_as_stepped ? penetration_of(contact_of(k)) : PenetrationOf::none;
        const std::uint32_t closest =
            place != PenetrationOf::none ? step.penetrations.closest()[place] : no_triangle;
        const bool is_searched = closest == no_triangle;
        searches += is_searched;
        if (is_searched && step.closest_budget > 0 && searches > step.closest_budget) continue;
        asks_.push_back({b, 0, static_cast<std::uint32_t>(k), closest});
    }
    return step.closest_budget > 0 && searches > step.closest_budget ? searches - step.closest_budget : 0;
}

// Of the meshes whose surfaces are searched, for the depth stage has not found all closest points.
void Readings::fit_trees(SurfaceTrees& trees) {
    const auto is_searched = [](const Ask& ask) { return ask.closest == no_triangle; };
    for (const Ask& ask : asks_)
        if (is_searched(ask)) trees.add(ids_[ask.body_b]);
    for (const Ask& ask : asks_)
        if (is_searched(ask)) bodies_[ask.body_b].tree = &trees[ids_[ask.body_b]];
    for (const ReadingBody& body : bodies_)
        if (body.tree) body.tree->update(solid_of(body), body.is_in_itself, nullptr);
}

// So that each search begins next to the one before.
void Readings::sort_asks(const Step& step) noexcept {
    const ReadingBody* a = nullptr;
    for (Ask& ask : asks_) {
        const SurfaceTree* tree = bodies_[ask.body_b].tree;
        if (!tree) continue;
        const vox_contact& contact = step.contacts[contact_of(ask.first)];
        if (!a || a->body.mesh_id != contact.body_a) a = &bodies_[body_of(contact.body_a)];
        ask.code = tree->place_on_curve(a->body.positions.exact(contact.vertex));
    }
    std::sort(asks_.begin(), asks_.end(), [](const Ask& x, const Ask& y) {
        return std::tie(x.body_b, x.code, x.first) < std::tie(y.body_b, y.code, y.first);
    });
}

void Readings::read_surfaces(const Range& asks, const Step& step) noexcept {
    const ReadingBody* a = nullptr;
    SearchState state;
    for (std::size_t i = asks.first; i < asks.last; ++i) {
        const Ask& ask = asks_[i];
        const ReadingBody& b = bodies_[ask.body_b];
        const std::size_t last = end_of_vertex(ask.first, readings_.size(), step);
        const vox_contact& contact = step.contacts[contact_of(ask.first)];
        if (!a || a->body.mesh_id != contact.body_a) a = &bodies_[body_of(contact.body_a)];
        if (i > asks.first && asks_[i - 1].body_b != ask.body_b) state.near = SearchState::none;
        // The first of the tetrahedra with the vertex that is still on.
        std::size_t at = ask.first;
        const auto is_on = [&](std::size_t k) {
            const std::uint32_t tet = step.contacts[contact_of(k)].tet;
            return tet < b.body.tets.size() && !has_bit(b.body.off, tet);
        };
        while (at < last && !is_on(at)) ++at;
        if (at == last) continue;
        const std::uint32_t tet = step.contacts[contact_of(at)].tet;
        const Vec3d p = a->body.positions.exact(contact.vertex);
        Closest closest;
        if (ask.closest != no_triangle) // the depth stage has found it
            closest = closest_point(solid_of(b), ask.closest, p);
        else if (!(a == &b ? b.tree->find_in_fold(p, contact.vertex, tet, state, closest)
                           : b.tree->find(p, SurfaceTree::no_vertex, state, closest)))
            continue;
        write_surface(solid_of(b), p, closest, readings_[ask.first]);
        for (std::size_t k = ask.first + 1; k < last; ++k) {
            readings_[k] = readings_[ask.first];
            readings_[k].contact = contact_of(k);
        }
    }
}

} // namespace vox
