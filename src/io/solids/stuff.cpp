// Labelle and Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles", SIGGRAPH
// 2007. Lattice edges that cross the boundary get a cut point; nodes that are too close to a cut point are
// moved onto it; and every lattice tetrahedron is replaced by the stencil of its part inside.
#include "io/solids/stuff.hpp"

#include "base/llu.hpp"
#include "io/solids/coarsen.hpp"
#include "io/solids/stencil.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {
namespace {

// Distances, in edge lengths, within which a node is too close to a cut point. They were chosen for the rule
// of io/solids/stencil.cpp by a search over the extreme configurations, in which dihedral angles are 11.59 to
// 159.24 degrees; the paper's choices give 10.78 to 164.74 (or 8.97 to 158.76, or 9.32 to 161.64).
constexpr double alpha_long = 0.26, alpha_short = 0.38;

constexpr std::uint32_t none = NodeSet::none;

class Stuffing {
public:
    Stuffing(const SolidShape& body, std::uint64_t max_tets, const Progress& progress)
        : body_(body), max_tets_(max_tets), progress_(progress),
          nodes_(with_neighbours(body.frame, body.inside)), sides_(nodes_.size(), Side::outside),
          fringe_(nodes_.size(), none), numbers_(nodes_.size(), none) {}

    MeshData run(std::uint32_t coarsen) {
        find_sides();
        find_cuts();
        warp();
        const Octree octree(
            body_.frame, body_.inside,
            [&](const Node& node) {
                const std::uint32_t n = nodes_.find(node);
                return n != none && sides_[n] == Side::inside;
            },
            coarsen);
        fill(octree);
        octree.for_each_tet([&](const std::array<Node, 4>& tet) {
            std::array<std::uint32_t, 4> vertices{};
            for (std::size_t k = 0; k < 4; ++k) vertices[k] = node_vertex(nodes_.find(tet[k]), tet[k]);
            add_tet(vertices);
        });
        return std::move(mesh_);
    }

private:
    // A cut of the edge from `inside` to its neighbour number `neighbour`, at `fraction` of the edge.
    struct Cut {
        Node inside;
        std::uint32_t neighbour;
        double fraction;
        std::uint32_t vertex;
    };
    // A node that has a cut edge, with the cuts of its fourteen edges and the cut point it was moved to.
    struct Fringe {
        std::array<std::uint32_t, 14> cuts;
        std::uint32_t moved_to;
        std::uint32_t node;
    };

    void find_sides() {
        body_.inside.for_each_run([&](std::uint32_t, const Run& run) {
            const std::uint32_t first = nodes_.find({2 * run.first + (run.y & 1), run.y, run.z});
            const auto begin = sides_.begin() + static_cast<std::ptrdiff_t>(first);
            std::fill(begin, begin + (run.last - run.first + 1), Side::inside);
        });
    }

    Fringe& fringe_of(std::uint32_t node) {
        if (fringe_[node] == none) {
            fringe_[node] = static_cast<std::uint32_t>(fringes_.size());
            Fringe fringe{};
            fringe.cuts.fill(none);
            fringe.moved_to = none;
            fringe.node = node;
            fringes_.push_back(fringe);
        }
        return fringes_[fringe_[node]];
    }

    void find_cuts() {
        body_.inside.for_each_node([&](std::uint32_t number, const Node& node) {
            if (number % 65536 == 0) progress_.report(0.4 * number / body_.inside.size());
            std::uint32_t self = none;
            for (std::uint32_t k = 0; k < std::size(neighbour_steps); ++k) {
                const std::uint32_t other = nodes_.find(node + neighbour_steps[k]);
                if (sides_[other] == Side::inside) continue;
                if (self == none) self = nodes_.find(node);
                const auto cut = static_cast<std::uint32_t>(cuts_.size());
                cuts_.push_back({node, k, body_.leaves(node, k), none});
                fringe_of(self).cuts[k] = cut;
                fringe_of(other).cuts[k ^ 1] = cut;
            }
        });
    }

    // Moves every node that is too close to a cut point onto it, and removes the cut points of its edges.
    void warp() {
        std::vector<std::uint32_t> order(fringes_.size());
        for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return fringes_[a].node < fringes_[b].node; });
        for (const std::uint32_t f : order) {
            Fringe& fringe = fringes_[f];
            const bool inside = sides_[fringe.node] == Side::inside;
            double nearest = 2;
            for (std::uint32_t k = 0; k < std::size(neighbour_steps); ++k) {
                if (fringe.cuts[k] == none) continue;
                const double fraction = cuts_[fringe.cuts[k]].fraction;
                const double away = inside ? fraction : 1 - fraction;
                const bool is_long = k < long_neighbours;
                const double length = away * (is_long ? 2.0 : std::sqrt(3.0));
                if (away < (is_long ? alpha_long : alpha_short) && length < nearest) {
                    nearest = length;
                    fringe.moved_to = fringe.cuts[k];
                }
            }
            if (fringe.moved_to == none) continue;
            sides_[fringe.node] = Side::on;
            for (std::uint32_t k = 0; k < std::size(neighbour_steps); ++k) {
                if (fringe.cuts[k] == none) continue;
                const Cut& cut = cuts_[fringe.cuts[k]];
                const Node other = inside ? cut.inside + neighbour_steps[cut.neighbour] : cut.inside;
                fringes_[fringe_[nodes_.find(other)]].cuts[k ^ 1] = none;
                fringe.cuts[k] = none;
            }
        }
    }

    // Adds the tetrahedra around the long edges between cell centres: four around each, one for each edge of
    // the face between the two cells.
    void fill(const Octree& octree) {
        nodes_.for_each_node([&](std::uint32_t number, const Node& low) {
            if (number % 65536 == 0) progress_.report(0.4 + 0.6 * number / nodes_.size());
            if ((low.y & 1) == 0) return;
            const bool low_merged = octree.is_merged(low);
            for (unsigned d = 0; d < 3; ++d) {
                const Node high = low + neighbour_steps[2 * d];
                if (low_merged || octree.is_merged(high)) continue;
                const std::uint32_t high_number = nodes_.find(high);
                if (high_number == none) continue;
                // The face's corners, in cyclic order around the edge, on the axes u = (d + 1) % 3, v = (d +
                // 2) % 3.
                std::array<Node, 4> ring{};
                std::array<std::uint32_t, 4> ring_number{};
                for (unsigned c = 0; c < 4; ++c) {
                    const std::int32_t u = c == 1 || c == 2 ? 1 : -1, v = c >= 2 ? 1 : -1;
                    std::array<std::int32_t, 3> at{};
                    at[d] = 1;
                    at[(d + 1) % 3] = u;
                    at[(d + 2) % 3] = v;
                    ring[c] = low + Node{at[0], at[1], at[2]};
                    ring_number[c] = nodes_.find(ring[c]);
                }
                // Face edges 0-1 and 3-2 run along u, at v = -1 and 1; 0-3 and 1-2 along v, at u = -1 and 1.
                static constexpr std::array<std::array<std::uint8_t, 2>, 4> edges = {
                    {{0, 1}, {3, 2}, {0, 3}, {1, 2}}};
                for (unsigned e = 0; e < 4; ++e) {
                    const unsigned a = edges[e][0], b = edges[e][1];
                    if (ring_number[a] == none || ring_number[b] == none) continue;
                    const bool first_above = e == 0 || e == 2;
                    // With first_above the face edge e is on the negative side of the axis f across it, and
                    // the orientation is the sign of det(d, -f, e) = det(d, e, f), which is positive for e =
                    // u.
                    const bool positive = (e < 2) == first_above;
                    cut_tet({number, high_number, ring_number[a], ring_number[b]},
                            {low, high, ring[a], ring[b]}, first_above, positive);
                }
            }
        });
    }

    void cut_tet(const std::array<std::uint32_t, 4>& numbers, const std::array<Node, 4>& nodes,
                 bool first_above, bool positive) {
        std::array<Side, 4> sides{};
        bool cut = false, any = false;
        for (std::size_t k = 0; k < 4; ++k) {
            sides[k] = sides_[numbers[k]];
            cut = cut || sides[k] == Side::outside;
            any = any || sides[k] == Side::inside;
        }
        if (!any) return;
        if (!cut) {
            std::array<std::uint32_t, 4> tet{};
            for (std::size_t k = 0; k < 4; ++k) tet[k] = node_vertex(numbers[k], nodes[k]);
            if (!positive) std::swap(tet[2], tet[3]);
            add_tet(tet);
            return;
        }
        std::array<std::array<double, 4>, 4> stumps{};
        for (const auto& [a, b] : tet_edges) {
            if (sides[a] == Side::inside && sides[b] == Side::outside)
                stumps[a][b] = cut_of(numbers[a], nodes[a], nodes[b]).fraction;
            if (sides[b] == Side::inside && sides[a] == Side::outside)
                stumps[b][a] = cut_of(numbers[b], nodes[b], nodes[a]).fraction;
        }
        const Stencil stencil = make_stencil(sides, first_above, stumps);
        for (std::size_t t = 0; t < stencil.count; ++t) {
            std::array<std::uint32_t, 4> tet{};
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint8_t v = stencil.tets[t][k];
                tet[k] =
                    v < 4 ? node_vertex(numbers[v], nodes[v]) : cut_vertex(numbers, nodes, tet_edges[v - 4u]);
            }
            if (!positive) std::swap(tet[2], tet[3]);
            add_tet(tet);
        }
    }

    void add_tet(const std::array<std::uint32_t, 4>& tet) {
        if (mesh_.tets.size() / 4 >= max_tets_)
            throw_error(VOX_ERROR_LIMIT, "more than %llu tets (max_tets): choose larger cells than %g",
                        llu(max_tets_), 2 * body_.frame.half_cell);
        mesh_.tets.insert(mesh_.tets.end(), tet.begin(), tet.end());
    }

    std::uint32_t add_vertex(const std::array<double, 3>& position) {
        mesh_.positions.insert(mesh_.positions.end(), position.begin(), position.end());
        return static_cast<std::uint32_t>(mesh_.positions.size() / 3 - 1);
    }

    std::array<double, 3> cut_position(const Cut& cut) const {
        const Node& step = neighbour_steps[cut.neighbour];
        return body_.frame.position(cut.inside.x + cut.fraction * step.x,
                                    cut.inside.y + cut.fraction * step.y,
                                    cut.inside.z + cut.fraction * step.z);
    }

    std::uint32_t node_vertex(std::uint32_t number, const Node& node) {
        if (numbers_[number] == none)
            numbers_[number] = add_vertex(sides_[number] == Side::on
                                              ? cut_position(cuts_[fringes_[fringe_[number]].moved_to])
                                              : body_.frame.position(node.x, node.y, node.z));
        return numbers_[number];
    }

    Cut& cut_of(std::uint32_t number, const Node& from, const Node& to) {
        unsigned k = 0;
        while (neighbour_steps[k].x != to.x - from.x || neighbour_steps[k].y != to.y - from.y ||
               neighbour_steps[k].z != to.z - from.z)
            ++k;
        return cuts_[fringes_[fringe_[number]].cuts[k]];
    }

    std::uint32_t cut_vertex(const std::array<std::uint32_t, 4>& numbers, const std::array<Node, 4>& nodes,
                             const std::array<std::uint8_t, 2>& edge) {
        Cut& cut = cut_of(numbers[edge[0]], nodes[edge[0]], nodes[edge[1]]);
        if (cut.vertex == none) cut.vertex = add_vertex(cut_position(cut));
        return cut.vertex;
    }

    const SolidShape& body_;
    const std::uint64_t max_tets_;
    const Progress& progress_;
    const NodeSet nodes_; // the nodes inside, and their neighbours
    std::vector<Side> sides_;
    std::vector<std::uint32_t> fringe_;  // for each node an index into fringes_, or none
    std::vector<std::uint32_t> numbers_; // for each node its vertex, or none
    std::vector<Fringe> fringes_;
    std::vector<Cut> cuts_;
    MeshData mesh_;
};

} // namespace

void check_tet_count(const NodeSet& inside, const Frame& frame, std::uint32_t coarsen,
                     std::uint64_t max_tets) {
    // Six uniform tets for each node, and more than one at any boundary; each merging turns at most eight
    // into one.
    if (inside.size() >> std::min(3 * coarsen, 31u) > max_tets)
        throw_error(
            VOX_ERROR_LIMIT,
            "%u lattice points inside make about %llu tets%s, more than %llu (max_tets): choose larger cells "
            "than %g",
            inside.size(), llu(6 * std::uint64_t{inside.size()}), coarsen ? " before they are merged" : "",
            llu(max_tets), 2 * frame.half_cell);
}

MeshData stuff(const SolidShape& body, std::uint32_t coarsen, std::uint64_t max_tets,
               const Progress& progress) {
    check_tet_count(body.inside, body.frame, coarsen, max_tets);
    MeshData mesh = Stuffing(body, max_tets, progress).run(coarsen);
    progress.report(1);
    return mesh;
}

} // namespace vox::io
