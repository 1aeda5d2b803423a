// Labelle and Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles", SIGGRAPH
// 2007, Sect. 3 and Figure 3. The stencils are computed from the paper's rules rather than tabulated.
//
// The rule for the diagonal that splits a quadrilateral differs from the paper. The paper uses the lattice
// alone: the diagonal ends in the cut point of a long edge, or else the parity rule decides. Here it starts
// at the inside vertex whose edge keeps the larger part, and the paper's rule only decides ties. Both rules
// depend on nothing but the face, so neighbours agree. With the distances in io/solids/stuff.cpp, the rule
// used here gives better angles.
#include "io/solids/stencil.hpp"

#include "io/determinant.hpp"

#include <utility>

namespace vox::io {
namespace {

using Tet = std::array<std::uint8_t, 4>;
using Place = std::array<int, 3>;

std::uint8_t cut(unsigned a, unsigned b) {
    for (unsigned e = 0; e < tet_edges.size(); ++e)
        if ((tet_edges[e][0] == a && tet_edges[e][1] == b) || (tet_edges[e][0] == b && tet_edges[e][1] == a))
            return static_cast<std::uint8_t>(4 + e);
    return 0;
}

bool are_long_edge(unsigned a, unsigned b) { return (a ^ 1u) == b; }

using Stumps = std::array<std::array<double, 4>, 4>;

// Of a face (p, q, m) with p and q inside and m outside, the quadrilateral p, q, cut(q, m), cut(p, m)
// remains. Returns whether its diagonal starts at p rather than q. Both tetrahedra of the face must find the
// same diagonal. Over the three faces around one m, the rule orders the three inside vertices and never makes
// a cycle; with a cycle, the prism that remains could not be split.
bool starts_at_p(unsigned p, unsigned q, unsigned m, bool first_above, const Stumps& stumps) {
    if (stumps[p][m] != stumps[q][m]) return stumps[p][m] > stumps[q][m];
    if (are_long_edge(p, m)) return false;
    if (are_long_edge(q, m)) return true;
    // The parity rule, for a long edge p-q: the diagonal starts at p or q, whichever has an even number of
    // coordinates greater than those of m.
    const bool along = (p & 1) != 0;           // greater on its own edge's axis: the upper end
    const bool across = (m & 1) == 0;          // on the other edge's axis: m is the lower end
    const bool above = (p < 2) == first_above; // on the third axis
    return (along + across + above) % 2 == 0;
}

// Splits the prism with triangles a and b, in which a[i] is joined to b[i]. from_a[i][j] says that the face
// of i and j has the diagonal a[i]-b[j] rather than a[j]-b[i]. Both diagonals must start at a[i] for some i.
void split_prism(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b,
                 const std::array<std::array<bool, 3>, 3>& from_a, Stencil& out) {
    for (unsigned i = 0; i < 3; ++i) {
        const unsigned j = (i + 1) % 3, k = (i + 2) % 3;
        if (!from_a[i][j] || !from_a[i][k]) continue;
        out.add({a[i], b[0], b[1], b[2]});
        if (from_a[j][k]) {
            out.add({a[i], a[j], a[k], b[k]});
            out.add({a[i], a[j], b[k], b[j]});
        } else {
            out.add({a[i], a[j], a[k], b[j]});
            out.add({a[i], a[k], b[k], b[j]});
        }
        return;
    }
}

// The pieces, with any orientation.
Stencil cut_up(const std::array<Side, 4>& sides, bool first_above, const Stumps& stumps) {
    std::array<std::uint8_t, 4> in{}, out{}, on{};
    unsigned in_count = 0, out_count = 0, on_count = 0;
    for (std::uint8_t v = 0; v < 4; ++v) {
        if (sides[v] == Side::inside) in[in_count++] = v;
        if (sides[v] == Side::outside) out[out_count++] = v;
        if (sides[v] == Side::on) on[on_count++] = v;
    }
    Stencil pieces;
    if (in_count == 0) return pieces;
    const auto from = [&](unsigned p, unsigned q, unsigned m) {
        return starts_at_p(p, q, m, first_above, stumps);
    };
    if (out_count == 0) {
        pieces.add({0, 1, 2, 3});
    } else if (in_count == 1) {
        Tet tet{};
        for (unsigned v = 0; v < 4; ++v)
            tet[v] = sides[v] == Side::outside ? cut(in[0], v) : static_cast<std::uint8_t>(v);
        pieces.add(tet);
    } else if (in_count == 2 && out_count == 1) {
        const std::uint8_t p = in[0], q = in[1], m = out[0], apex = on[0];
        if (from(p, q, m)) {
            pieces.add({p, q, cut(q, m), apex});
            pieces.add({p, cut(q, m), cut(p, m), apex});
        } else {
            pieces.add({p, q, cut(p, m), apex});
            pieces.add({q, cut(q, m), cut(p, m), apex});
        }
    } else if (in_count == 3) {
        const std::uint8_t m = out[0];
        std::array<std::array<bool, 3>, 3> starts{};
        for (unsigned i = 0; i < 3; ++i)
            for (unsigned j = i + 1; j < 3; ++j) {
                starts[i][j] = from(in[i], in[j], m);
                starts[j][i] = !starts[i][j];
            }
        split_prism({in[0], in[1], in[2]}, {cut(in[0], m), cut(in[1], m), cut(in[2], m)}, starts, pieces);
    } else {
        // Two corners are inside and two outside, which leaves a prism over the triangles at p and at q. The
        // face of cut points belongs to no other tetrahedron; its diagonal is chosen so that the three make
        // no cycle.
        const std::uint8_t p = in[0], q = in[1], m = out[0], n = out[1];
        std::array<std::array<bool, 3>, 3> starts{};
        starts[0][1] = from(p, q, m);
        starts[0][2] = from(p, q, n);
        starts[1][2] = !starts[0][1];
        for (unsigned i = 0; i < 3; ++i)
            for (unsigned j = i + 1; j < 3; ++j) starts[j][i] = !starts[i][j];
        split_prism({p, cut(p, m), cut(p, n)}, {q, cut(q, m), cut(q, n)}, starts, pieces);
    }
    return pieces;
}

// Twice the position of a vertex, with cut points assumed in the middle of their edges.
Place place(unsigned v, bool first_above) {
    const int z = first_above ? -2 : 2;
    const std::array<Place, 4> corners = {{{0, 0, 0}, {4, 0, 0}, {2, -2, z}, {2, 2, z}}};
    if (v < 4) return corners[v];
    const Place &a = corners[tet_edges[v - 4][0]], &b = corners[tet_edges[v - 4][1]];
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

int six_volumes(const Tet& tet, bool first_above) {
    const Place a = place(tet[0], first_above);
    std::array<Place, 3> e{};
    for (unsigned i = 0; i < 3; ++i) {
        const Place b = place(tet[i + 1], first_above);
        for (unsigned k = 0; k < 3; ++k) e[i][k] = b[k] - a[k];
    }
    return determinant(e[0], e[1], e[2]);
}

} // namespace

Stencil make_stencil(const std::array<Side, 4>& sides, bool first_above, const Stumps& stumps) {
    Stencil stencil = cut_up(sides, first_above, stumps);
    const bool whole = six_volumes({0, 1, 2, 3}, first_above) > 0;
    for (unsigned t = 0; t < stencil.count; ++t)
        if ((six_volumes(stencil.tets[t], first_above) > 0) != whole)
            std::swap(stencil.tets[t][2], stencil.tets[t][3]);
    return stencil;
}

} // namespace vox::io
