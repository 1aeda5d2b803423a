// What Resolver finds: overlaps, and features closer than the gap, as contacts.
#include "base/llu.hpp"
#include "sim/resolve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vox::sim {

namespace {

constexpr double edge_part = 0.4; // of a crossed edge, which is pushed out by this much at most
constexpr double slack = 0.1;     // of the gap, added so that rounding does not take it away

Vec3 vec(const double p[3]) { return Vec3(p[0], p[1], p[2]); }

// Weights of the corners for the point of a triangle that is nearest to a point close to its plane, roughly.
std::array<double, 3> weights_at(const Vec3& point, const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 normal = (q - p).cross(r - p);
    const double area = normal.squaredNorm();
    if (!(area > 0)) return {1, 0, 0};
    const double second = std::clamp((point - p).cross(r - p).dot(normal) / area, 0.0, 1.0);
    const double third = std::clamp((q - p).cross(point - p).dot(normal) / area, 0.0, 1.0 - second);
    return {1 - second - third, second, third};
}

} // namespace

double depth_of(const Contact& c) {
    double depth = c.depth - c.slop;
    for (std::uint32_t i = 0; i < c.count; ++i)
        depth -= c.weights[i] * c.direction.dot(c.body(i).positions[c.vertices[i]]);
    return depth;
}

void Resolver::move_surface() {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        std::copy(bodies_[b]->positions.begin(), bodies_[b]->positions.end(),
                  all_.begin() + members_[b].first);
    vox_motion motion = vox_default_motion();
    motion.from = vox_double_positions(all_[0].data(), all_.size());
    check(vox_surface_move(surface_.get(), &motion));
}

void Resolver::note(std::uint32_t vertex_a, std::uint32_t vertex_b, const double position[3],
                    double distance) {
    if (report_.place_count < desc_.place_capacity)
        desc_.places[report_.place_count] = {member_of(body_at(vertex_a)).index,
                                             member_of(body_at(vertex_b)).index,
                                             distance,
                                             {position[0], position[1], position[2]}};
    ++report_.place_count;
    report_.least_distance = std::min(report_.least_distance, distance);
}

void Resolver::add_vertices(Contact& c, std::span<const std::uint32_t> vertices, const double* weights,
                            double sign) const {
    const std::uint32_t first = member_of(body_at(vertices[0])).first;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        c.vertices[c.count] = vertices[i] - first;
        c.weights[c.count++] = sign * weights[i];
    }
    if (sign > 0) c.count_a = c.count;
    (sign > 0 ? c.a : c.b) = &body_at(vertices[0]);
}

// Adds a contact that is `depth` deep now.
void Resolver::add(Contact& c, double depth) {
    c.motion = Vec3::Zero();
    c.depth = 0;
    c.depth = depth - depth_of(c);
    for (std::uint32_t i = 0; i < c.count; ++i)
        c.inverse_mass += c.weights[i] * c.weights[i] * c.body(i).inverse_masses[c.vertices[i]];
    if (c.inverse_mass > 0) contacts_.push_back(c);
}

// ---- overlaps -------------------------------------------------------------------------------------

// Puts the insides of closed surfaces to where these are now.
void Resolver::update_shapes() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Member& member = members_[b];
        const SoftBody& body = *bodies_[b];
        if (!body.tets.empty() || !member.solid) continue;
        vox_shape_desc desc = vox_default_shape_desc();
        desc.kind = VOX_SHAPE_SOLID;
        desc.positions = vox_double_positions(body.positions[0].data(), body.positions.size());
        desc.triangles = member.triangles[0].data();
        desc.triangle_count = member.triangles.size();
        desc.user_data = b;
        if (member.shape != VOX_NULL_BODY) check(vox_body_remove(grid_.get(), member.shape));
        member.shape = VOX_NULL_BODY;
        const vox_result result = vox_shape_insert(grid_.get(), &desc, &member.shape);
        if (result == VOX_ERROR_INVALID_MESH)
            member.solid = false; // its triangles do not wind alike
        else
            check(result);
        if (member.solid) check(vox_grid_set_pair_enabled(grid_.get(), body.mesh, member.shape, 0));
    }
}

// Finds what overlaps, and returns whether anything does.
bool Resolver::find_overlaps() {
    const bool is_first = report_.iterations == 0;
    update_shapes();
    check(vox_grid_step(grid_.get()));
    gather_contacts(grid_.get(), bodies_, nullptr,
                    {.friction = 0, .compliance = 0, .push_speed = 0, .slop = 0}, contacts_);
    add_shape_contacts();
    report_.inside_vertices = contacts_.size();
    // A body that did not overlap itself at first was folded by its neighbours, and its shape undoes that.
    if (is_first)
        for (const Contact& c : contacts_) members_[c.a->slot].overlaps_itself |= c.a == c.b;
    erase_if(contacts_, [&](const Contact& c) { return c.a == c.b && !member_of(*c.a).overlaps_itself; });
    deepest_ = 0;
    for (Contact& c : contacts_) {
        deepest_ = std::max(deepest_, depth_of(c));
        c.slop = -1.5 * desc_.gap;
    }
    move_surface();
    vox_crossing_view view{};
    check(vox_surface_find_crossings(surface_.get(), &view));
    const std::span crossings(view.data, static_cast<std::size_t>(view.count));
    report_.crossings = crossings.size();
    report_.place_count = 0;
    report_.least_distance = desc_.gap;
    if (is_first) {
        report_.first_crossings = crossings.size();
        report_.first_depth = deepest_;
    }
    if (!crossings.empty()) find_parts(crossings);
    for (const vox_crossing& crossing : crossings) {
        const std::uint32_t a = edges_.vertices[2 * std::size_t{crossing.edge}], b = faces_[crossing.face][0];
        note(a, b, crossing.position, 0);
        if (is_first && body_of_[a] == body_of_[b]) members_[body_of_[a]].overlaps_itself = true;
        add_crossing(crossing);
    }
    return report_.inside_vertices + report_.crossings > 0;
}

// Contacts with the insides of closed surfaces, where the closest point takes part.
void Resolver::add_shape_contacts() {
    vox_constraint_view view{};
    check(vox_grid_get_constraints(grid_.get(), &view));
    for (const vox_constraint& from : std::span(view.data, static_cast<std::size_t>(view.count))) {
        SoftBody& b = *bodies_[static_cast<std::size_t>(from.user_data_b)];
        if (from.body_b == b.mesh || from.element_b == VOX_NONE) continue;
        Contact c{};
        c.a = bodies_[static_cast<std::size_t>(from.user_data_a)].get();
        c.b = &b;
        c.direction = vec(from.normal);
        c.count_a = from.count_a;
        c.count = from.count_a + 3;
        std::copy_n(from.vertices, from.count_a, c.vertices);
        std::copy_n(from.weights, from.count_a, c.weights);
        const Corners& t = member_of(b).triangles[from.element_b];
        const auto weights = weights_at(vec(from.position) - from.gap * c.direction, b.positions[t[0]],
                                        b.positions[t[1]], b.positions[t[2]]);
        for (std::size_t i = 0; i < 3; ++i) {
            c.vertices[c.count_a + i] = t[i];
            c.weights[c.count_a + i] = -weights[i];
        }
        add(c, -from.gap);
    }
}

std::uint32_t Resolver::part_of(std::uint32_t v) {
    while (part_[v] != v) v = part_[v] = part_[part_[v]];
    return v;
}

// Finds the parts of the surfaces between contours of intersection.
void Resolver::find_parts(std::span<const vox_crossing> crossings) {
    std::iota(part_.begin(), part_.end(), 0u);
    const vox_crossing* next = crossings.data();
    const vox_crossing* const end = next + crossings.size();
    for (std::uint32_t e = 0; e < edges_.count; ++e) {
        while (next != end && next->edge < e) ++next;
        if (next != end && next->edge == e) continue;
        const std::uint32_t* ends = edges_.vertices + 2 * std::size_t{e};
        const std::uint32_t a = part_of(ends[0]), b = part_of(ends[1]);
        part_[std::max(a, b)] = std::min(a, b);
    }
    std::fill(part_size_.begin(), part_size_.end(), 0u);
    for (std::uint32_t v = 0; v < part_.size(); ++v) ++part_size_[part_of(v)];
    if (report_.iterations > 0) return;
    Array<bool> is_wrong(part_.size(), false, &memory_);
    for (const vox_crossing& crossing : crossings) {
        const std::uint32_t* ends = edges_.vertices + 2 * std::size_t{crossing.edge};
        const std::uint32_t wrong = wrong_end(ends[0], ends[1]);
        if (wrong != VOX_NONE) is_wrong[part_of(wrong)] = true;
    }
    for (std::uint32_t v = 0; v < part_.size(); ++v) wrong_[v] = is_wrong[part_of(v)];
}

// The end of a crossed edge that has to go back, or VOX_NONE if its surface does not tell. The first contours
// decide, as later ones may have gaps.
std::uint32_t Resolver::wrong_end(std::uint32_t p, std::uint32_t q) {
    if (wrong_[p] != wrong_[q]) return wrong_[p] ? p : q;
    const std::uint32_t of_p = part_of(p), of_q = part_of(q);
    if (of_p == of_q) return VOX_NONE;
    return std::tuple(part_size_[of_p], of_p) < std::tuple(part_size_[of_q], of_q) ? p : q;
}

// Pushes an edge out of a face.
void Resolver::add_crossing(const vox_crossing& crossing) {
    const std::uint32_t* ends = edges_.vertices + 2 * std::size_t{crossing.edge};
    const Corners& face = faces_[crossing.face];
    if (!body_at(ends[0]).tets.empty() && !body_at(face[0]).tets.empty()) return; // the grid knows the depth
    const Vec3 p = all_[ends[0]], q = all_[ends[1]], along = (q - p).normalized();
    const Vec3 normal = (all_[face[1]] - all_[face[0]]).cross(all_[face[2]] - all_[face[0]]).normalized();
    double most = edge_part * (q - p).norm();
    Contact c{};
    c.direction.setZero();
    const std::uint32_t wrong = wrong_end(ends[0], ends[1]);
    const double high_p = normal.dot(p - all_[face[0]]), high_q = normal.dot(q - all_[face[0]]);
    if (wrong != VOX_NONE && high_p * high_q < 0) {
        const double high = wrong == ends[0] ? high_p : high_q, whole = 1;
        add_vertices(c, {&wrong, 1}, &whole, 1);
        c.direction = high > 0 ? Vec3(-normal) : normal;
        most = std::min(most, std::abs(high));
    } else {
        const double slope = along.dot(normal), steep = std::copysign(std::max(std::abs(slope), 0.1), slope);
        for (std::uint32_t i = first_opposite_[crossing.edge]; i < first_opposite_[crossing.edge + 1]; ++i) {
            const Vec3 into = all_[opposites_[i]] - p;
            Vec3 line = normal.cross(along.cross(into)); // of the face at the edge and the crossed face
            const double length = line.norm();
            if (!(length > 0)) continue;
            line /= line.dot(into - into.dot(along) * along) < 0 ? -length : length;
            c.direction += line - (2 * along.dot(line) / steep) * normal;
        }
        const double length = c.direction.norm();
        if (!(length > 1e-9)) return; // the contour does not become shorter
        c.direction /= length;
        add_vertices(c, {ends, 2}, crossing.edge_weights, 1);
    }
    add_vertices(c, face, crossing.face_weights, -1);
    add(c, most + desc_.gap);
}

// ---- the gap --------------------------------------------------------------------------------------

// Finds features that are closer than the gap, and returns whether there are any.
bool Resolver::find_close() {
    move_surface();
    contacts_.clear();
    report_.close_pairs = report_.place_count = 0;
    report_.least_distance = desc_.gap;
    add_close(VOX_FEATURE_FACE, VOX_FEATURE_VERTEX);
    add_close(VOX_FEATURE_EDGE, VOX_FEATURE_EDGE);
    return report_.close_pairs > 0;
}

void Resolver::add_close(vox_feature a, vox_feature b) {
    vox_proximity_view view{};
    check(vox_surface_find_proximities(surface_.get(), a, b, desc_.gap, &view));
    const auto corners = [&](vox_feature kind, const std::uint32_t& index) -> std::span<const std::uint32_t> {
        if (kind == VOX_FEATURE_VERTEX) return {&index, 1};
        if (kind == VOX_FEATURE_EDGE) return {edges_.vertices + 2 * std::size_t{index}, 2};
        return faces_[index];
    };
    for (const vox_proximity& near : std::span(view.data, static_cast<std::size_t>(view.count))) {
        if (near.distance >= desc_.gap) continue;
        const auto of_a = corners(a, near.a), of_b = corners(b, near.b);
        ++report_.close_pairs;
        note(of_a[0], of_b[0], near.point_a, near.distance);
        Contact c{};
        c.direction = vec(near.point_a) - vec(near.point_b);
        const double distance = c.direction.norm();
        if (!(distance > 0)) continue;
        c.direction /= distance;
        add_vertices(c, of_a, near.weights_a, 1);
        add_vertices(c, of_b, near.weights_b, -1);
        add(c, (1 + slack) * desc_.gap - distance);
    }
}

} // namespace vox::sim
