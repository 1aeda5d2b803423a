// Tiles of the mesh that reach the box of the shape are moved into its frame. There their edges look for
// triangles of the shape in a tree, and their faces for its edges. A tile has all crossings of its own edges;
// an edge of the shape may pass through faces of many tiles, so its contacts are listed when all are known.
#include "grid/shape_edges.hpp"

#include "base/boxes.hpp"
#include "base/room.hpp"
#include "base/rounding.hpp"
#include "base/vectors.hpp"
#include "exact/crossing.hpp"
#include "exact/facet_normal.hpp"
#include "shape/facets.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>

namespace vox {

namespace {

class EdgeSearch {
public:
    EdgeSearch(const ShapePair& of, const SurfaceFeatures& features, Array<ShapeCrossing>& of_mesh,
               Array<ShapeCrossing>& of_shape)
        : pair_(of), mesh_(of.scene.bodies[of.body]), facets_(*of.shape.facets()), features_(features),
          of_mesh_(of_mesh), of_shape_(of_shape) {}

    void run(std::size_t first, std::size_t last) {
        for (const SurfaceTile& tile : std::span(features_.tiles).subspan(first, last - first))
            if (is_near(tile)) search(tile);
    }

private:
    bool is_near(const SurfaceTile& tile) const {
        const Box* const blocks = pair_.scene.boxes->blocks.data() + pair_.scene.of[pair_.body].first_block;
        Box around = empty_box; // between blocks, too
        for (std::uint32_t b = 0; b < tile.block_count; ++b)
            vox::add(around, blocks[features_.blocks[tile.first_block + b]]);
        return overlap(around, pair_.box);
    }

    static auto overlaps(const Vec3d& lo, const Vec3d& hi) noexcept {
        const Box3f around{rounded_box(lo).min, rounded_box(hi).max};
        return [around](const Box3f& other) { return overlap(around, other); };
    }

    void search(const SurfaceTile& tile) {
        for (std::uint32_t v = 0; v < tile.vertex_count; ++v)
            at_[v] = pair_.place.to_shape(mesh_.positions.exact(vertex(tile, v)));
        for (std::uint32_t e = tile.first_edge; e < tile.first_edge + tile.edge_count; ++e) {
            auto [u, v] = features_.edges[e];
            if (vertex(tile, v) < vertex(tile, u)) std::swap(u, v);
            search_edge({vertex(tile, u), vertex(tile, v)}, at_[u], at_[v]);
        }
        for (std::uint32_t f = tile.first_face; f < tile.first_face + tile.face_count; ++f)
            search_face(tile, f);
    }

    void search_edge(const std::array<std::uint32_t, 2>& edge, const Vec3d& from, const Vec3d& to) {
        const Vec3d lo = min(from, to), hi = max(from, to);
        if (!is_in_reach(lo, hi)) return;
        const auto meet = [&](std::uint32_t t) {
            const ShapeTriangle& triangle = facets_.triangles[t];
            const Vec3d &a = facets_.corner(triangle, 0), &b = facets_.corner(triangle, 1),
                        &c = facets_.corner(triangle, 2);
            if (ShapeCrossing* const crossing = cross(from, to, a, b, c, of_mesh_)) {
                crossing->edge = edge;
                crossing->element = t;
            }
        };
        facets_.triangle_tree.visit_accepted(overlaps(lo, hi), meet);
    }

    void search_face(const SurfaceTile& tile, std::uint32_t face) {
        const auto& [u, v, w] = features_.faces[face];
        const Vec3d lo = min(min(at_[u], at_[v]), at_[w]), hi = max(max(at_[u], at_[v]), at_[w]);
        if (!is_in_reach(lo, hi)) return;
        const std::array<std::uint8_t, 3> corners = outward(tile, face);
        const auto meet = [&](std::uint32_t e) {
            const TriangleSide& edge = facets_.edges[e];
            if (ShapeCrossing* const crossing =
                    cross(facets_.points[edge.ends[0]], facets_.points[edge.ends[1]], at_[corners[0]],
                          at_[corners[1]], at_[corners[2]], of_shape_)) {
                crossing->edge = {e, 0};
                crossing->element = edge.triangle;
                for (std::size_t i = 0; i < 3; ++i) crossing->vertices[i] = vertex(tile, corners[i]);
            }
        };
        facets_.edge_tree.visit_accepted(overlaps(lo, hi), meet);
    }

    // Adds the crossing of an edge and a triangle, without what it is of; null if they do not meet.
    static ShapeCrossing* cross(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b,
                                const Vec3d& c, Array<ShapeCrossing>& out) {
        std::uint64_t exact_tests = 0;
        const Crossing met = find_crossing(from, to, a, b, c, exact_tests);
        if (met.kind == CrossingKind::none) return nullptr;
        reserve_growing(out, out.size() + 1);
        ShapeCrossing& crossing = out.emplace_back();
        crossing.at = met.edge_weights[1];
        crossing.face_weights = met.face_weights;
        crossing.is_through = met.kind == CrossingKind::through;
        crossing.from = from;
        crossing.to = to;
        crossing.corner = a;
        crossing.normal = triangle_normal(a, b, c);
        return &crossing;
    }

    bool is_in_reach(const Vec3d& lo, const Vec3d& hi) const noexcept {
        const RigidShape::Bounds& all = pair_.shape.bounds();
        return (lo.x <= all.max.x) & (lo.y <= all.max.y) & (lo.z <= all.max.z) & (hi.x >= all.min.x) &
               (hi.y >= all.min.y) & (hi.z >= all.min.z);
    }
    std::uint32_t vertex(const SurfaceTile& tile, std::uint32_t index) const noexcept {
        return features_.vertices[tile.first_vertex + index];
    }
    // The corners of a face, the lowest vertex first and counter-clockwise as seen from outside.
    std::array<std::uint8_t, 3> outward(const SurfaceTile& tile, std::uint32_t face) const {
        std::array<std::uint8_t, 3> corners = features_.faces[face];
        const auto lower = [&](std::uint8_t x, std::uint8_t y) { return vertex(tile, x) < vertex(tile, y); };
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), lower), corners.end());
        const std::uint32_t apex = mesh_.tets[features_.tets[face]].v[features_.facets[face]];
        const auto at = [&](std::uint32_t v) { return mesh_.positions.exact(v); };
        std::uint64_t exact_tests = 0;
        if (orientation(at(vertex(tile, corners[0])), at(vertex(tile, corners[1])),
                        at(vertex(tile, corners[2])), at(apex), exact_tests) > 0)
            std::swap(corners[1], corners[2]);
        return corners;
    }

    const ShapePair& pair_;
    const Body& mesh_;
    const ShapeFacets& facets_;
    const SurfaceFeatures& features_;
    Array<ShapeCrossing>&of_mesh_, &of_shape_;
    std::array<Vec3d, SurfaceTile::most_vertices> at_; // of a tile, in the shape's frame
};

// Makes contacts of crossings.
class ContactList {
public:
    ContactList(const ShapePair& of, Array<ShapeEdge>& to) : pair_(of), out_(to) {}

    // An edge of the mesh is as deep as the middle of its part inside the shape. A sheet has no inside: the
    // shorter part of the edge has to leave.
    void list_mesh_edges(Array<ShapeCrossing>& crossings) {
        for_each_crossing(crossings, [&](const ShapeCrossing& c, double before, double after) {
            ShapeEdge contact = start(c, 2);
            contact.vertices[0] = c.edge[0];
            contact.vertices[1] = c.edge[1];
            contact.weights[0] = 1 - c.at;
            contact.weights[1] = c.at;
            const Vec3d way = c.to - c.from;
            if (c.is_through && pair_.shape.kind() == VOX_SHAPE_SHEET) {
                const double at_from = dot(c.normal, c.from - c.corner),
                             at_to = dot(c.normal, c.to - c.corner);
                const bool from_leaves = std::abs(at_from) <= std::abs(at_to);
                set(contact, VOX_DEPTH_PLANE, std::min(std::abs(at_from), std::abs(at_to)),
                    (from_leaves ? at_from : at_to) < 0 ? c.normal : -1.0 * c.normal);
            } else if (c.is_through) {
                for (const double middle : {0.5 * (before + c.at), 0.5 * (c.at + after)}) {
                    ShapePoint seen;
                    if (pair_.shape.look(c.from + middle * way, 0, seen) && seen.is_inside &&
                        -seen.distance > -contact.gap)
                        set(contact, VOX_DEPTH_CLOSEST, -seen.distance, seen.normal);
                }
            }
            push(contact);
        });
    }

    // An edge of the shape, too, but in front of the plane of the face that it passes through: the face has
    // to move that way.
    void list_shape_edges(Array<ShapeCrossing>& crossings) {
        for_each_crossing(crossings, [&](const ShapeCrossing& c, double before, double after) {
            ShapeEdge contact = start(c, 3);
            contact.edge = c.edge[0];
            std::ranges::copy(c.vertices, contact.vertices);
            std::ranges::copy(c.face_weights, contact.weights);
            const Vec3d way = c.to - c.from;
            const double middle = dot(c.normal, way) > 0 ? 0.5 * (before + c.at) : 0.5 * (c.at + after);
            const double depth = c.is_through ? -dot(c.normal, c.from + middle * way - c.corner) : 0;
            set(contact, VOX_DEPTH_PLANE, std::max(depth, 0.0), -1.0 * c.normal);
            push(contact);
        });
    }

private:
    // Calls visit(crossed, before, after) for the crossings of each edge, with where the one before and the
    // one after are.
    template <class Visit>
    static void for_each_crossing(Array<ShapeCrossing>& all, const Visit& visit) {
        const auto key = [](const ShapeCrossing& c) {
            return std::tuple(c.edge, c.at, c.element, c.vertices);
        };
        std::sort(all.begin(), all.end(),
                  [&](const ShapeCrossing& a, const ShapeCrossing& b) { return key(a) < key(b); });
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto is_same_edge = [&](std::size_t j) { return all[j].edge == all[i].edge; };
            std::size_t before = i, after = i; // on edges, several triangles are met at once
            while (before > 0 && is_same_edge(before) && all[before].at >= all[i].at) --before;
            while (after + 1 < all.size() && is_same_edge(after) && all[after].at <= all[i].at) ++after;
            visit(all[i], is_same_edge(before) && all[before].at < all[i].at ? all[before].at : 0,
                  is_same_edge(after) && all[after].at > all[i].at ? all[after].at : 1);
        }
    }

    // At first they only touch.
    ShapeEdge start(const ShapeCrossing& c, std::uint32_t count) const noexcept {
        ShapeEdge contact{};
        contact.count = count;
        contact.element = c.element;
        set(contact, VOX_DEPTH_TOUCHING, 0, c.normal);
        return contact;
    }
    void set(ShapeEdge& contact, vox_depth_state state, double depth, const Vec3d& normal) const noexcept {
        const Vec3d out = pair_.place.to_world(normal);
        contact.state = depth > 0 ? state : VOX_DEPTH_TOUCHING;
        contact.gap = -depth * pair_.place.scale();
        contact.normal[0] = out.x, contact.normal[1] = out.y, contact.normal[2] = out.z;
    }
    void push(const ShapeEdge& contact) {
        reserve_growing(out_, out_.size() + 1);
        out_.push_back(contact);
    }

    const ShapePair& pair_;
    Array<ShapeEdge>& out_;
};

} // namespace

void find_shape_edges(const ShapePair& pair, const SurfaceFeatures& features, std::size_t first,
                      std::size_t last, ShapeCrossings& out) {
    out.of_one_search.clear();
    EdgeSearch(pair, features, out.of_one_search, out.of_shape).run(first, last);
    ContactList(pair, out.of_mesh).list_mesh_edges(out.of_one_search);
}

void join_shape_edges(const ShapePair& pair, Array<ShapeCrossing>& crossings, std::size_t first,
                      Array<ShapeEdge>& contacts) {
    ContactList(pair, contacts).list_shape_edges(crossings);
    const auto key = [](const ShapeEdge& c) {
        return std::tuple(c.vertices[0], c.vertices[1], c.vertices[2], c.count, c.element, c.edge);
    };
    std::sort(contacts.begin() + static_cast<std::ptrdiff_t>(first), contacts.end(),
              [&](const ShapeEdge& a, const ShapeEdge& b) { return key(a) < key(b); });
}

} // namespace vox
