// What Resolver makes of its input: bodies, one surface, a grid.
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "sim/constraints.hpp"
#include "sim/resolve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vox::sim {

namespace {

constexpr double stiffest = 1e60; // softened to what a sweep can handle

void check_body(const vox_resolve_body& body, std::uint32_t index) {
    const auto wrong = [index](const std::string& what) {
        refuse(format("body %u: %s", index, what.c_str()));
    };
    if (body.struct_size != sizeof body)
        wrong(format("struct_size is %u, expected %zu", body.struct_size, sizeof body));
    if (body.flags & ~std::uint32_t{VOX_RESOLVE_FIXED})
        wrong(format("flags are 0x%x, expected a combination of 0x%x", body.flags, VOX_RESOLVE_FIXED));
    if (!body.positions || body.vertex_count == 0) wrong("it has no positions");
    if (body.vertex_count > VOX_MAX_VERTICES || body.tet_count > VOX_MAX_SURFACE_TETS ||
        body.face_count > VOX_MAX_FEATURES)
        throw Error(VOX_ERROR_LIMIT,
                    format("body %u has %llu vertices, %llu tets and %llu faces", index,
                           llu(body.vertex_count), llu(body.tet_count), llu(body.face_count)));
    if ((body.tet_count == 0) == (body.face_count == 0))
        wrong(format("it has %llu tets and %llu faces, expected tets or faces", llu(body.tet_count),
                     llu(body.face_count)));
    if (body.tet_count > 0 ? !body.tets : !body.faces)
        wrong(body.tet_count > 0 ? "tets are null" : "faces are null");
    for (std::uint64_t i = 0; i < 3 * body.face_count; ++i)
        if (body.faces[i] >= body.vertex_count)
            throw Error(VOX_ERROR_INVALID_MESH, format("body %u: face %llu names vertex %u of %llu", index,
                                                       llu(i / 3), body.faces[i], llu(body.vertex_count)));
    for (std::uint64_t i = 0; i < 3 * body.vertex_count; ++i)
        if (!(std::abs(body.positions[i]) <= 1e15))
            throw Error(VOX_ERROR_NON_FINITE, format("body %u: coordinate %c of vertex %llu is %g", index,
                                                     "xyz"[i % 3], llu(i / 3), body.positions[i]));
}

// The facets of exactly one tetrahedron, outward if it has a positive volume.
void add_boundary(const vox_resolve_body& body, Array<std::array<std::uint32_t, 3>>& out) {
    using Facet = std::array<std::uint32_t, 6>; // its corners ascending, then as they wind
    Array<Facet> facets(out.memory());
    for (std::uint64_t t = 0; t < body.tet_count; ++t) {
        const std::uint32_t* v = body.tets + 4 * t;
        constexpr std::size_t sides[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
        for (const auto& side : sides) {
            Facet f{v[side[0]], v[side[1]], v[side[2]], v[side[0]], v[side[1]], v[side[2]]};
            std::sort(f.begin(), f.begin() + 3);
            facets.push_back(f);
        }
    }
    std::sort(facets.begin(), facets.end());
    for (std::size_t i = 0, end; i < facets.size(); i = end) {
        for (end = i + 1; end < facets.size() && std::equal(&facets[i][0], &facets[i][3], &facets[end][0]);)
            ++end;
        if (end == i + 1) out.push_back({facets[i][3], facets[i][4], facets[i][5]});
    }
}

double check_length(double value, const char* name) {
    if (!(value >= 0 && value <= 1e15))
        refuse(format("%s is %g, expected a number from 0 to 1e15", name, value));
    return value;
}

} // namespace

double volume_inside(const Vec3* x, std::span<const std::array<std::uint32_t, 3>> triangles) {
    double sum = 0;
    for (const auto& t : triangles) sum += volume6(x[0], x[t[0]], x[t[1]], x[t[2]]);
    return sum / 6;
}

Resolver::Resolver(const vox_resolve_desc& desc, std::span<const vox_resolve_body> bodies)
    : memory_(desc.allocator), desc_(desc), bodies_(&memory_), members_(&memory_), contacts_(&memory_),
      all_(&memory_), start_(&memory_), body_of_(&memory_), faces_(&memory_), first_opposite_(&memory_),
      opposites_(&memory_), part_(&memory_), part_size_(&memory_), wrong_(&memory_), clearances_(&memory_),
      gradients_(&memory_) {
    check_length(desc.gap, "gap");
    check_length(desc.max_move, "max_move");
    if (desc.reserved != 0) refuse(format("reserved is %u, expected 0", desc.reserved));
    if (desc.place_capacity > 0 && !desc.places) refuse("places are null, but place_capacity is not 0");
    if (bodies.empty()) refuse("there are no bodies");
    if (desc_.max_iterations == 0) desc_.max_iterations = 400;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) check_body(bodies[b], b);
    for (const bool with_tets : {false, true})
        for (std::uint32_t b = 0; b < bodies.size(); ++b)
            if ((bodies[b].tet_count > 0) == with_tets) read(bodies[b], b);
    start_.assign(all_.begin(), all_.end());
    make_surface();
    vox_grid_desc settings = vox_default_grid_desc();
    settings.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    settings.worker_count = desc.worker_count;
    settings.byte_budget = UINT64_MAX;
    settings.allocator = desc.allocator;
    grid_ = create_grid(settings);
    for (Member& member : members_) {
        const vox_resolve_body& from = bodies[member.index];
        bodies_.push_back(from.tet_count > 0 ? make_solid(from) : make_shell(from, member));
        bodies_.back()->slot = static_cast<std::uint32_t>(bodies_.size() - 1);
        set_substep(*bodies_.back(), 1);
        insert(*bodies_.back());
    }
}

// Adds a body to the surface.
void Resolver::read(const vox_resolve_body& body, std::uint32_t index) {
    if (all_.size() + body.vertex_count > VOX_MAX_VERTICES)
        throw Error(VOX_ERROR_LIMIT, format("the bodies have more than %u vertices", VOX_MAX_VERTICES));
    const auto first = static_cast<std::uint32_t>(all_.size());
    const auto member = static_cast<std::uint32_t>(members_.size());
    for (std::uint64_t v = 0; v < body.vertex_count; ++v) {
        const double* p = body.positions + 3 * v;
        all_.push_back(Vec3(p[0], p[1], p[2]));
        body_of_.push_back(member);
    }
    for (std::uint64_t i = 0; i < 4 * body.tet_count; ++i)
        if (body.tets[i] >= body.vertex_count)
            throw Error(VOX_ERROR_INVALID_MESH, format("body %u: tet %llu names vertex %u of %llu", index,
                                                       llu(i / 4), body.tets[i], llu(body.vertex_count)));
    members_.push_back(
        {index, first, body.tet_count > 0, false, VOX_NULL_BODY, 0, 0, Array<Corners>(&memory_)});
    Array<Corners>& triangles = members_.back().triangles;
    add_boundary(body, triangles);
    for (std::uint64_t f = 0; f < body.face_count; ++f)
        triangles.push_back({body.faces[3 * f], body.faces[3 * f + 1], body.faces[3 * f + 2]});
    for (const Corners& t : triangles) faces_.push_back({first + t[0], first + t[1], first + t[2]});
}

void Resolver::make_surface() {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = desc_.worker_count;
    desc.vertex_count = all_.size();
    desc.face_count = faces_.size();
    desc.faces = faces_.empty() ? nullptr : faces_[0].data();
    desc.byte_budget = UINT64_MAX;
    desc.allocator = desc_.allocator;
    vox_surface* made = nullptr;
    check(vox_surface_create(&desc, &made));
    surface_.reset(made);
    check(vox_surface_get_features(made, VOX_FEATURE_EDGE, &edges_));
    find_opposites();
    part_.resize(all_.size());
    part_size_.resize(all_.size());
    wrong_.resize(all_.size(), false);
    clearances_.resize(all_.size());
}

void Resolver::find_opposites() {
    using Side = std::array<std::uint32_t, 3>; // two ends, ascending, and the corner across
    Array<Side> sides(&memory_);
    for (const Corners& f : faces_)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = f[k], b = f[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), f[(k + 2) % 3]});
        }
    std::sort(sides.begin(), sides.end());
    for (std::size_t e = 0; e < edges_.count; ++e) {
        first_opposite_.push_back(static_cast<std::uint32_t>(opposites_.size()));
        const std::uint32_t a = edges_.vertices[2 * e], b = edges_.vertices[2 * e + 1];
        const std::uint32_t low = std::min(a, b), high = std::max(a, b);
        auto at = std::lower_bound(sides.begin(), sides.end(), Side{low, high, 0});
        for (; at != sides.end() && (*at)[0] == low && (*at)[1] == high; ++at) opposites_.push_back((*at)[2]);
    }
    first_opposite_.push_back(static_cast<std::uint32_t>(opposites_.size()));
}

BodyHandle Resolver::make_solid(const vox_resolve_body& body) {
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.flags = body.flags & VOX_RESOLVE_FIXED ? VOX_SIM_BODY_FIXED : 0;
    desc.positions = body.positions;
    desc.vertex_count = body.vertex_count;
    desc.tets = body.tets;
    desc.tet_count = body.tet_count;
    desc.youngs_modulus = desc.bulk_modulus = stiffest;
    return make_body(desc, &memory_);
}

// A shell as thick as its mean edge is long. Springs across edges resist bending.
BodyHandle Resolver::make_shell(const vox_resolve_body& body, Member& member) {
    BodyHandle made(std::pmr::polymorphic_allocator<>(&memory_).new_object<SoftBody>(&memory_));
    SoftBody& shell = *made;
    shell.fixed = (body.flags & VOX_RESOLVE_FIXED) != 0;
    const std::uint32_t first = member.first;
    const auto count = static_cast<std::size_t>(body.vertex_count);
    shell.positions.assign(&all_[first], &all_[first] + count);
    shell.previous.assign(&all_[first], &all_[first] + count);
    const auto spring = [&](std::uint32_t a, std::uint32_t b) {
        if (a != b) shell.edges.push_back({a - first, b - first, (all_[a] - all_[b]).norm(), 0, 0});
    };
    const auto is_here = [&](std::uint32_t v) { return v - first < count; }; // also if v < first
    member.solid = true;
    for (std::size_t e = 0; e < edges_.count; ++e) {
        const std::uint32_t* ends = edges_.vertices + 2 * e;
        if (!is_here(ends[0])) continue;
        spring(ends[0], ends[1]);
        member.solid = member.solid && first_opposite_[e + 1] - first_opposite_[e] == 2;
    }
    for (const EdgeConstraint& edge : shell.edges) shell.mean_edge += edge.rest_length;
    member.first_bend = shell.edges.size();
    shell.mean_edge /= static_cast<double>(std::max<std::size_t>(member.first_bend, 1));
    for (std::size_t e = 0; e < edges_.count; ++e)
        for (std::uint32_t i = first_opposite_[e]; i + 1 < first_opposite_[e + 1]; ++i)
            if (is_here(opposites_[i])) spring(opposites_[i], opposites_[i + 1]);

    shell.masses.assign(count, 0);
    const double density = 1000 * shell.mean_edge;
    const Vec3* x = shell.positions.data();
    for (const Corners& t : member.triangles)
        for (const std::uint32_t v : t)
            shell.masses[v] += density * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm() / 6;
    const double total = std::accumulate(shell.masses.begin(), shell.masses.end(), 0.0);
    if (!(total >= 1e-60 && total <= 1e60)) refuse(format("body %u: its faces have no area", member.index));
    shell.inverse_masses.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
        shell.masses[v] = std::max(shell.masses[v], total / static_cast<double>(count) / 100);
        shell.inverse_masses[v] = shell.fixed ? 0 : 1 / shell.masses[v];
    }
    member.volume = volume_inside(x, member.triangles);
    if (member.solid && member.volume < 0) {
        for (Corners& t : member.triangles) std::swap(t[1], t[2]);
        member.volume = -member.volume;
    }
    return made;
}

// Without tetrahedra it is a set of points there, which have a depth in others.
void Resolver::insert(SoftBody& body) {
    vox_mesh_desc mesh = vox_mesh_desc_doubles(body.positions[0].data(), body.positions.size(),
                                               body.tets.data(), body.tets.size() / 4);
    mesh.flags = VOX_MESH_BORROW_TETS;
    if (!body.tets.empty()) mesh.filter.flags = VOX_FILTER_SELF_COLLISION;
    mesh.user_data = body.slot;
    check(vox_mesh_insert(grid_.get(), &mesh, &body.mesh));
    body.is_exact_in_grid = true;
}

} // namespace vox::sim
