// Where all tets are positive, the number of tets that cover a point off the facets is the winding number of
// the boundary around it (the degree of the map; e.g. A. Jacobson, L. Kavan, O. Sorkine-Hornung, Robust
// inside-outside segmentation using generalized winding numbers, SIGGRAPH 2013). Suppose that a vertex v is
// in a tet that does not own it. Then next to v there are points that both this tet and v's own tets cover,
// so some winding number next to v is above one; or v and that tet meet at the boundary only (see below). So
// a region where no winding number exceeds one has no such vertex.
//
// Space is cut into cells. A cell that no boundary triangle touches has one winding number, the same as the
// untouched cells next to it: 0 outside, else it is counted at one point. A touched cell is safe if there is
// a direction d such that the normals of all its triangles have a positive product with d, and the cells that
// are entered from it by going against d are safe: along d the winding number only falls, from one at most.
// Two pieces of boundary that touch each other from outside face opposite ways, so no d suits both, and exact
// contact without overlap is not certified away. Neither is a vertex where two pieces that share a d meet:
// the inside of both is against d there, so they overlap.
//
// The same holds for an edge of the boundary and a facet of it, without a vertex in common, that have a point
// p in a safe cell. Let s be the edge, or its end if p is that, and t the facet, or its side or corner that p
// is in. All boundary triangles at s and at t touch the cell, as they contain p, so their normals have a
// positive product with d. Against d the boundary is only crossed inward: just before p lies a point that is
// covered by a tet at s, and by one at t. These are two tets: one with both s and t would have two faces
// whose insides meet in p, so s and t would be the same. The point is in the cell of p or in one that is
// entered from it, both safe, where no point is covered twice: so there is no such p.
//
// Tets that are not positive, or not certainly so, make every cell of their box unsafe. They do not count
// elsewhere.
#include "fast/winding/certificate.hpp"
#include "base/simd.hpp"

#include "base/parallel.hpp"
#include "exact/predicates.hpp"
#include "fast/broad_phase.hpp"

#include <algorithm>
#include <array>
#include <utility>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/winding/certificate.cpp"
#include "base/each_target.hpp"

#include "fast/tile-inl.hpp"

#ifndef VOX_FAST_WINDING_ONCE
#define VOX_FAST_WINDING_ONCE
namespace vox::fast {

// Some triangles of a boundary.
struct TriangleBatch {
    static constexpr std::size_t size = 64;
    alignas(64) float corner[3][3][size];   // [corner][axis]
    alignas(64) std::uint32_t facing[size]; // directions that their normals have a positive product with
    // The cells that meet the box: one of them, and how many more there are along each axis.
    alignas(64) std::uint32_t first[3][size], more[3][size];
};

} // namespace vox::fast
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// Loads the corners of `count` triangles, and repeats the last one until a register is full.
void LoadTriangles(const float* HWY_RESTRICT positions, std::uint32_t last_vertex,
                   const std::array<std::uint32_t, 3>* HWY_RESTRICT triangles, std::size_t count,
                   TriangleBatch& batch) {
    const auto load = [&](const std::uint32_t* triangle, std::size_t c) HWY_ATTR {
        const std::uint32_t v = triangle[c];
        return v == last_vertex ? LoadLastVertex(positions, v) : LoadVertex(positions, v);
    };
    const auto* corners = reinterpret_cast<const std::uint32_t*>(triangles);
    const std::size_t last = 3 * (count - 1);
    for (std::size_t i = 0; i < (count + 15) / 16 * 16; i += 4) {
        const std::uint32_t* four[4];
        for (std::size_t j = 0; j < 4; ++j) four[j] = corners + (3 * (i + j) < last ? 3 * (i + j) : last);
        for (std::size_t c = 0; c < 3; ++c) {
            const auto p0 = load(four[0], c), p1 = load(four[1], c);
            const auto p2 = load(four[2], c), p3 = load(four[3], c);
            StoreTransposed(p0, p1, p2, p3, batch.corner[c][0] + i, batch.corner[c][1] + i,
                            batch.corner[c][2] + i);
        }
    }
}

// Writes the set of directions that the normal of each triangle certainly has a positive product with, and
// the cells that meet its box. The components of a normal are off by less than 9 u L^2, where L is the
// largest difference of coordinates, and sums of three of them by less than 64 u L^2. Where coordinates are
// rounded and a difference is off by at most e, a component is off by another 2 e (2 L + e), and a sum of
// three by 12 e (L + e).
void Facing(TriangleBatch& batch, std::size_t count, const WindowLattice& lattice, float e_of_rounding) {
    const Floats d;
    const Words du;
    const hn::RebindToSigned<Floats> di;
    const V inverse = hn::Set(d, lattice.inverse);
    const auto cell = [&](V c, int axis) HWY_ATTR { // as WindowLattice::cell()
        const V t = hn::Mul(hn::Sub(c, hn::Set(d, lattice.origin[axis])), inverse);
        return hn::BitCast(
            du, hn::ConvertTo(di, hn::Min(hn::Max(t, hn::Zero(d)), hn::Set(d, lattice.last[axis]))));
    };
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        V e[2][3], longest = hn::Zero(d);
        for (int axis = 0; axis < 3; ++axis) {
            const V a = hn::Load(d, batch.corner[0][axis] + i), b = hn::Load(d, batch.corner[1][axis] + i);
            const V c = hn::Load(d, batch.corner[2][axis] + i);
            const auto first = cell(hn::Min(a, hn::Min(b, c)), axis);
            hn::Store(first, du, batch.first[axis] + i);
            hn::Store(hn::Sub(cell(hn::Max(a, hn::Max(b, c)), axis), first), du, batch.more[axis] + i);
            e[0][axis] = hn::Sub(b, a);
            e[1][axis] = hn::Sub(c, a);
            longest = hn::Max(longest, hn::Max(hn::Abs(e[0][axis]), hn::Abs(e[1][axis])));
        }
        V n[3];
        Cross(e[0], e[1], n);
        const V square = hn::Mul(longest, longest);
        V bound = hn::Add(hn::Mul(square, hn::Set(d, 64 * 0x1p-24f)),
                          hn::Mul(hn::Add(longest, hn::Set(d, 1.0f)), hn::Set(d, 0x1p-120f)));
        if (e_of_rounding > 0) {
            const V e = hn::Set(d, e_of_rounding);
            bound = hn::Add(bound, hn::Mul(hn::Mul(hn::Set(d, 12.0f), e), hn::Add(longest, e)));
        }
        const V minus_bound = hn::Neg(bound);
        const V xpy = hn::Add(n[0], n[1]), xmy = hn::Sub(n[0], n[1]);
        // They are in the order of `directions`.
        const V sums[13] = {n[0],
                            n[1],
                            n[2],
                            xpy,
                            xmy,
                            hn::Add(n[0], n[2]),
                            hn::Sub(n[0], n[2]),
                            hn::Add(n[1], n[2]),
                            hn::Sub(n[1], n[2]),
                            hn::Add(xpy, n[2]),
                            hn::Sub(xpy, n[2]),
                            hn::Add(xmy, n[2]),
                            hn::Sub(xmy, n[2])};
        auto set = hn::Zero(du);
        for (std::uint32_t k = 0; k < 13; ++k) {
            set = hn::Or(set, hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(sums[k], bound)),
                                                 hn::Set(du, 1u << 2 * k)));
            set = hn::Or(set, hn::IfThenElseZero(hn::RebindMask(du, hn::Lt(sums[k], minus_bound)),
                                                 hn::Set(du, 2u << 2 * k)));
        }
        const auto ordinary = hn::RebindMask(du, hn::Lt(longest, hn::Set(d, 0x1p60f)));
        hn::Store(hn::IfThenElseZero(ordinary, set), du, batch.facing + i);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

// While runs are joined, `component` is the index of another run of the same component, a lower one, or of
// the run itself.
std::uint32_t Components::root(std::uint32_t run) noexcept {
    while (runs[run].component != run) {
        runs[run].component = runs[runs[run].component].component; // halves the path for the next search
        run = runs[run].component;
    }
    return run;
}

// Joins the runs of a row with those runs of another one that they touch; its cells have indices lower by
// `cells_between`.
void Components::join(std::uint32_t row, std::uint32_t other, std::uint32_t cells_between) noexcept {
    std::uint32_t i = rows[row], j = rows[other];
    while (i < runs.size() && j < rows[other + 1]) {
        const std::uint32_t first = runs[j].first + cells_between, end = runs[j].end + cells_between;
        if (first < runs[i].end && runs[i].first < end) {
            std::uint32_t a = root(i), b = root(j);
            if (a < b) std::swap(a, b);
            runs[a].component = b;
        }
        if (end < runs[i].end)
            ++j;
        else
            ++i;
    }
}

void Components::find(const std::uint32_t* values, std::uint32_t wanted, const std::uint32_t (&cells)[3]) {
    const std::uint32_t nx = cells[0], ny = cells[1];
    runs.clear();
    rows.clear();
    rows.push_back(0);
    for (std::uint32_t row = 0; row < ny * cells[2]; ++row) {
        const std::uint32_t end = (row + 1) * nx;
        for (std::uint32_t c = row * nx; c < end; ++c) {
            if (values[c] != wanted) continue;
            const std::uint32_t first = c;
            while (c < end && values[c] == wanted) ++c;
            runs.push_back({first, c, static_cast<std::uint32_t>(runs.size())});
        }
        if (row % ny) join(row, row - 1, nx);
        if (row >= ny) join(row, row - ny, nx * ny);
        rows.push_back(static_cast<std::uint32_t>(runs.size()));
    }
    // A root comes before all other runs of its component, so its number is set before theirs.
    count = 0;
    for (std::uint32_t i = 0; i < runs.size(); ++i)
        runs[i].component = runs[i].component == i ? count++ : runs[runs[i].component].component;
}

namespace {

// 13 directions and their opposites: bit 2 k and bit 2 k + 1 of a set.
constexpr int direction_count = 13;
constexpr int directions[direction_count][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                                {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                                                {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};
constexpr std::uint32_t all_directions = (1u << 2 * direction_count) - 1; // and no triangle: bit 31
constexpr std::uint32_t untouched = 0x80000000u | all_directions;

class Certifier {
public:
    Certifier(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests)
        : body_(body), out_(out), exact_tests_(exact_tests) {}

    bool run() {
        const bool certified = certify();
        if (!oriented_) body_.orientation.is_used = false; // not worth following then
        return certified;
    }

private:
    bool certify() {
        const std::size_t most_cells = std::min<std::size_t>(
            2 * (body_.boundary.triangles.size() + body_.tiles.vertices.size()) + 64, 1u << 31);
        Box around = body_.box;
        for (int a = 0; a < 3; ++a) {
            around.lo[a] -= static_cast<float>(1.5 * body_.cell_size);
            around.hi[a] += static_cast<float>(1.5 * body_.cell_size);
            if (!(around.lo[a] > -float_infinity && around.hi[a] < float_infinity)) return false;
        }
        out_.lattice = make_lattice(around, body_.cell_size, most_cells);
        const WindowLattice& l = out_.lattice;
        nx_ = l.cells[0];
        nxy_ = nx_ * l.cells[1];
        cells_ = l.count();
        // Visits of cells by large triangles and boxes. More than a few for each cell and each triangle means
        // that the lattice is too fine for them, and certifying takes longer than testing all vertices.
        work_left_ = 8 * cells_ + 16 * body_.boundary.triangles.size();
        out_.directions.assign(cells_, untouched);
        if (!mark_surface()) return false;
        // The corner cell reaches out to infinity: nothing there, unless rounding ate the margin.
        if (out_.directions[0] != untouched) return false;
        // First as if all untouched cells that are not outside were covered once. This is cheap, and decides
        // whether more is worth doing.
        judge(false);
        if (!worthwhile()) return false;
        out_.bad.resize(body_.tiles.tiles.size());
        oriented_ = true;
        orient(body_, body_.orientation, out_.bad.data(), body_.workers);
        bool any_bad = false;
        if (!mark_bad_tets(any_bad)) return false;
        bool as_assumed = !any_bad;
        for (std::size_t i = 1; i < known_ && as_assumed; ++i)
            as_assumed = covered_at_most_once(first_cell_[i]);
        if (!as_assumed) {
            if (out_.directions[0] != untouched) return false;
            judge(true);
        }
        out_.complete = out_.touched.empty();
        return true;
    }

    Vec3d exact(std::uint32_t v) const {
        if (body_.rounded) return body_.exact.exact(v);
        const float* p = body_.positions + std::size_t{v} * 3;
        return {double{p[0]}, double{p[1]}, double{p[2]}};
    }

    using Vertices = std::array<std::uint32_t, 4>;
    Vertices corners_of(std::size_t tile, std::uint32_t tet) const {
        const Tiles& tiles = body_.tiles;
        Vertices corners;
        for (std::size_t c = 0; c < 4; ++c)
            corners[c] = tiles.vertices[tiles.tiles[tile].first_vertex +
                                        tiles.corners[(tile * 4 + c) * tile_size + tet]];
        return corners;
    }

    // Intersects the sets of some cells with `set`. False when that becomes too much work.
    bool mark(const std::uint32_t (&first)[3], const std::uint32_t (&more)[3], std::uint32_t set) {
        std::uint32_t* sets =
            out_.directions.data() + std::size_t{first[2]} * nxy_ + std::size_t{first[1]} * nx_ + first[0];
        if ((more[0] | more[1] | more[2]) <= 1) { // the same cell once more costs less than a branch
            const std::size_t x = more[0], y = std::size_t{more[1]} * nx_, z = std::size_t{more[2]} * nxy_;
            for (const std::size_t c : {std::size_t{0}, x, y, x + y, z, x + z, y + z, x + y + z})
                sets[c] &= set;
            return true;
        }
        const std::size_t work = (std::size_t{more[0]} + 1) * (more[1] + 1) * (more[2] + 1);
        if (work > work_left_) return false;
        work_left_ -= work;
        for (std::size_t z = 0; z <= more[2]; ++z)
            for (std::size_t y = 0; y <= more[1]; ++y)
                for (std::size_t x = 0; x <= more[0]; ++x) sets[z * nxy_ + y * nx_ + x] &= set;
        return true;
    }

    // Makes all cells of the box unsafe. False as mark().
    bool mark_unsafe(const Box& box) {
        const WindowLattice& l = out_.lattice;
        std::uint32_t first[3], more[3];
        for (int a = 0; a < 3; ++a) {
            first[a] = l.cell(box.lo[a], a);
            more[a] = l.cell(box.hi[a], a) - first[a];
        }
        return mark(first, more, 0);
    }

    bool mark_surface() {
        const auto load = VOX_SIMD_DISPATCH(LoadTriangles);
        const auto facing = VOX_SIMD_DISPATCH(Facing);
        float e_of_rounding = 0; // 2 u M and a little more, M the largest magnitude; see narrow-inl.hpp
        for (int a = 0; a < 3 && body_.rounded; ++a)
            e_of_rounding = std::max({e_of_rounding, -body_.box.lo[a] * (1.125f * 0x1p-23f),
                                      body_.box.hi[a] * (1.125f * 0x1p-23f)});
        const std::span<const std::array<std::uint32_t, 3>> triangles = body_.boundary.triangles;
        TriangleBatch batch;
        for (std::size_t first = 0; first < triangles.size(); first += TriangleBatch::size) {
            const std::size_t count = std::min(TriangleBatch::size, triangles.size() - first);
            load(body_.positions, body_.vertex_count - 1, triangles.data() + first, count, batch);
            facing(batch, count, out_.lattice, e_of_rounding);
            for (std::size_t i = 0; i < count; ++i)
                if (!mark({batch.first[0][i], batch.first[1][i], batch.first[2][i]},
                          {batch.more[0][i], batch.more[1][i], batch.more[2][i]}, batch.facing[i]))
                    return false;
        }
        return true;
    }

    // Decides which cells are safe. Untouched cells outside are. The other untouched ones are assumed to be
    // or, with `count`, decided by the winding number at one point of each component. Then the touched ones
    // follow.
    void judge(bool count) {
        const Components& components = find_components();
        bool safe[most_components + 1];
        for (std::size_t i = 0; i <= most_components; ++i)
            safe[i] = i == 0 || (i < known_ && (!count || covered_at_most_once(first_cell_[i])));
        out_.certified.assign(cells_ + Certificate::run, 0);
        for (const Components::Run& run : components.runs)
            std::fill(out_.certified.begin() + run.first, out_.certified.begin() + run.end,
                      std::uint8_t{safe[std::min<std::size_t>(run.component, most_components)]});
        judge_touched();
    }

    // Finds the components of untouched cells. The first is outside. For each of the others the tets around a
    // point may have to be counted, so only the first few are used.
    const Components& find_components() {
        Components& components = out_.components;
        components.find(out_.directions.data(), untouched, out_.lattice.cells);
        known_ = std::min<std::size_t>(components.count, most_components);
        inside_ = 0;
        std::size_t found = 0;
        for (const Components::Run& run : components.runs) {
            if (run.component == found && found < known_) first_cell_[found++] = run.first;
            if (run.component > 0 && run.component < known_) inside_ += run.end - run.first;
        }
        return components;
    }

    // A thin body has boundary everywhere, facing both ways, and so has one that lies on itself: most of it
    // stays uncertified. bench/README.md has what certifying such bodies costs ("Culling by winding numbers
    // also for bodies that are mostly surface").
    bool worthwhile() const {
        std::size_t inside = inside_;
        for (const std::uint32_t set : out_.directions) inside += set != untouched;
        return out_.touched.size() * 6 < inside;
    }

    bool mark_bad_tets(bool& any) {
        const Tiles& tiles = body_.tiles;
        std::size_t bad = 0;
        for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) {
            if (body_.positive[s]) continue; // it has none
            for (std::uint32_t t = tiles.super_first[s]; t < tiles.super_first[s + 1]; ++t)
                for (std::uint64_t left = out_.bad[t]; left; left &= left - 1) {
                    const Vertices corners =
                        corners_of(t, static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left)));
                    int sign = orientation(exact(corners[0]), exact(corners[1]), exact(corners[2]),
                                           exact(corners[3]), exact_tests_);
                    if (body_.boundary.mirrored[t] & (left & (~left + 1))) sign = -sign;
                    if (sign > 0) continue;
                    any = true;
                    Box box = empty_box;
                    for (const std::uint32_t v : corners) {
                        const float* p = body_.positions + std::size_t{v} * 3;
                        add(box, {{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}});
                    }
                    // With that many, little of the body would be certified.
                    if (++bad > tiles.tets.size() / 16 || !mark_unsafe(box)) return false;
                }
        }
        return true;
    }

    int count_holding(std::uint32_t tile, const Vec3d& at) {
        int holding = 0;
        for (std::uint32_t i = 0; i < body_.tiles.tiles[tile].tet_count; ++i) {
            const Vertices corners = corners_of(tile, i);
            const Containment where = locate(at, exact(corners[0]), exact(corners[1]), exact(corners[2]),
                                             exact(corners[3]), exact_tests_);
            holding += where == Containment::interior || where == Containment::boundary;
        }
        return holding;
    }

    bool covered_at_most_once(std::size_t cell) {
        const WindowLattice& l = out_.lattice;
        const std::uint32_t index[3] = {static_cast<std::uint32_t>(cell % nx_),
                                        static_cast<std::uint32_t>(cell / nx_ % l.cells[1]),
                                        static_cast<std::uint32_t>(cell / nxy_)};
        float p[3];
        for (int a = 0; a < 3; ++a) {
            p[a] = l.origin[a] + (static_cast<float>(index[a]) + 0.5f) / l.inverse;
            if (l.cell(p[a], a) != index[a]) return false;
        }
        const Vec3d at{p[0] + body_.origin.x, p[1] + body_.origin.y, p[2] + body_.origin.z};
        // The cell of the point is that of its rounded position.
        if (l.cell(static_cast<float>(at.x - body_.origin.x), 0) != index[0] ||
            l.cell(static_cast<float>(at.y - body_.origin.y), 1) != index[1] ||
            l.cell(static_cast<float>(at.z - body_.origin.z), 2) != index[2])
            return false;
        const Box point_box{{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
        const Tiles& tiles = body_.tiles;
        int covering = 0;
        for (std::uint32_t s = 0; s < tiles.super_tile_count() && covering < 2; ++s) {
            if (!overlap(body_.super_boxes[s], point_box)) continue;
            const std::uint32_t first = tiles.super_first[s], last = tiles.super_first[s + 1];
            make_tile_boxes(tiles, body_.positions, first, last, body_.tile_boxes, body_.tile_known);
            for (std::uint32_t t = first; t < last; ++t)
                if (overlap(body_.tile_boxes[t], point_box)) covering += count_holding(t, at);
        }
        return covering <= 1;
    }

    // Decides touched cells, in passes over the unsafe ones until a pass finds none that is safe.
    void judge_touched() {
        // enterable[n] is the set of directions that are open when the neighbours n (bits x-, x+, y-, y+, z-,
        // z+) are safe.
        std::uint32_t enterable[64];
        for (std::uint32_t n = 0; n < 64; ++n) {
            enterable[n] = 0;
            for (int k = 0; k < 2 * direction_count; ++k) {
                bool open = true;
                for (int a = 0; a < 3; ++a) {
                    const int step = directions[k / 2][a] * (k % 2 ? -1 : 1);
                    if (step) open = open && (n >> (2 * a + (step > 0 ? 0 : 1)) & 1);
                }
                if (open) enterable[n] |= 1u << k;
            }
        }
        Array<std::uint32_t>& touched = out_.touched;
        touched.clear();
        for (std::size_t c = 0; c < cells_; ++c)
            if (!out_.certified[c]) touched.push_back(static_cast<std::uint32_t>(c));
        const std::uint8_t* safe = out_.certified.data();
        const std::uint32_t nx = nx_, ny = out_.lattice.cells[1], nz = out_.lattice.cells[2];
        for (bool changed = true; changed;) {
            changed = false;
            std::size_t kept = 0;
            for (const std::uint32_t c : touched) {
                const std::uint32_t set = out_.directions[c];
                bool now_safe = false;
                if (set != 0 && set != untouched) {
                    const std::uint32_t x = c % nx, y = c / nx % ny, z = c / nxy_;
                    std::uint32_t n = 0;
                    n |= std::uint32_t{x > 0 && safe[c - 1]} << 0 | std::uint32_t{x + 1 < nx && safe[c + 1]}
                                                                        << 1;
                    n |= std::uint32_t{y > 0 && safe[c - nx]} << 2 | std::uint32_t{y + 1 < ny && safe[c + nx]}
                                                                         << 3;
                    n |= std::uint32_t{z > 0 && safe[c - nxy_]} << 4 |
                         std::uint32_t{z + 1 < nz && safe[c + nxy_]} << 5;
                    now_safe = (set & enterable[n]) != 0;
                }
                if (now_safe) {
                    out_.certified[c] = 1;
                    changed = true;
                } else {
                    touched[kept++] = c;
                }
            }
            touched.resize(kept);
        }
    }

    static constexpr std::size_t most_components =
        64; // whose cells can be certified; a body with more is no solid

    const WindingBody& body_;
    Certificate& out_;
    std::uint64_t& exact_tests_;
    std::uint32_t nx_ = 0, nxy_ = 0;
    std::size_t cells_ = 0, work_left_ = 0;
    bool oriented_ = false;
    std::size_t known_ = 0, inside_ = 0; // components; untouched cells that are not outside
    std::size_t first_cell_[most_components];
};

} // namespace

bool certify(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests) {
    return Certifier(body, out, exact_tests).run();
}

} // namespace vox::fast
#endif
