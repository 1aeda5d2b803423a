// Contacts are grouped by the mesh that the vertices are in, so that the tree over its surface is built once.
#include "grid/readings.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace vox {

using namespace depth;

namespace {

void write(double (&out)[3], const Vec3d& v) noexcept {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

// In proportion to the largest coordinate, so that products neither vanish nor overflow.
Vec3d scaled(const Vec3d& v) noexcept {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0 ? Vec3d{v.x / largest, v.y / largest, v.z / largest} : v;
}

// The unit vector along the cross product; zero where that is.
Vec3d unit_normal(const Vec3d& u, const Vec3d& v) noexcept { return normalised(cross(scaled(u), scaled(v))); }

vox_mesh id_of(const ReadingBody& b) noexcept { return b.body.mesh_id; }

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

    for (std::size_t i = 0; i < 3; ++i) {
        out.triangle[i] = triangle.v[order[i]];
        out.barycentric[i] = closest.at.weight[order[i]];
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
    : bodies_(memory), runs_(memory), groups_(memory), trees_(memory), readings_(memory) {}

std::span<const vox_reading> Readings::all() const {
    if (!prepared_)
        throw Error(VOX_ERROR_INVALID_STATE, "the contacts of the last step were not read: call "
                                             "vox_grid_prepare_readings after it");
    return readings_;
}

std::span<ReadingBody> Readings::list_meshes(const Events& events) {
    bodies_.clear();
    bodies_.reserve(2 * events.pairs().size());
    for (const vox_pair& pair : events.pairs())
        for (const vox_mesh mesh : {pair.mesh_a, pair.mesh_b}) bodies_.emplace_back().body.mesh_id = mesh;
    std::ranges::sort(bodies_, {}, id_of);
    const auto same = [](const ReadingBody& x, const ReadingBody& y) { return id_of(x) == id_of(y); };
    bodies_.erase(std::unique(bodies_.begin(), bodies_.end(), same), bodies_.end());
    return bodies_;
}

const ReadingBody& Readings::body_of(vox_mesh mesh) const noexcept {
    return *std::ranges::lower_bound(bodies_, mesh, {}, id_of);
}

void Readings::prepare(std::span<const vox_contact> contacts, std::span<const vox_penetration> penetrations,
                       const Events& events, Workers& workers) {
    // Room for all comes first: after it only a task system of the caller can fail.
    std::size_t triangles = 0;
    for (const ReadingBody& body : bodies_)
        if (body.topology) triangles = std::max(triangles, body.topology->triangles.size());
    runs_.reserve(2 * events.pairs().size());
    groups_.reserve(2 * events.pairs().size());
    trees_.reserve(workers.count());
    while (trees_.size() < workers.count()) trees_.emplace_back(readings_.get_allocator().resource());
    for (SurfaceTree& tree : trees_) tree.reserve(triangles);
    readings_.reserve(contacts.size());

    prepared_ = false;
    readings_.assign(contacts.size(), {});
    list_depths(penetrations);
    list_runs(events);
    constexpr std::size_t least = 512; // contacts that are worth a task
    const std::size_t groups = groups_.size();
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
        for (std::size_t g = begin; g < end; ++g) read(groups_[g], contacts, trees_[worker]);
    };
    if (contacts.size() <= least)
        run(0, groups, 0);
    else
        workers.for_ranges(groups, std::max<std::size_t>(groups * least / contacts.size(), 1), run);
    prepared_ = true;
}

// Penetrations are in the order of contacts, one for all of the same vertex and mesh.
void Readings::list_depths(std::span<const vox_penetration> penetrations) noexcept {
    for (std::size_t i = 0; i < readings_.size(); ++i) readings_[i].contact = i;
    for (std::size_t n = 0; n < penetrations.size(); ++n) {
        const vox_penetration& from = penetrations[n];
        const std::size_t end = n + 1 < penetrations.size()
                                    ? static_cast<std::size_t>(penetrations[n + 1].contact)
                                    : readings_.size();
        for (auto i = static_cast<std::size_t>(from.contact); i < end; ++i) {
            vox_reading& to = readings_[i];
            to.state = from.state;
            to.depth = from.depth;
            std::copy_n(from.direction, 3, to.direction);
            to.known |= VOX_READING_DEPTH;
        }
    }
}

void Readings::list_runs(const Events& events) {
    runs_.clear();
    groups_.clear();
    for (const vox_pair& pair : events.pairs()) {
        const std::span<const std::uint32_t> contacts = events.contacts_of(pair);
        const ReadingBody *a = &body_of(pair.mesh_a), *b = &body_of(pair.mesh_b);
        const auto a_in_b = static_cast<std::size_t>(pair.a_in_b);
        if (pair.a_in_b > 0)
            runs_.push_back({pair.mesh_b, a, b, contacts.first(a_in_b), pair.user_data_a, pair.user_data_b});
        if (pair.b_in_a > 0)
            runs_.push_back(
                {pair.mesh_a, b, a, contacts.subspan(a_in_b), pair.user_data_b, pair.user_data_a});
    }
    std::sort(runs_.begin(), runs_.end(), [](const Run& x, const Run& y) {
        return std::tuple(x.mesh_b, x.contacts.data()) < std::tuple(y.mesh_b, y.contacts.data());
    });
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        if (i == 0 || runs_[i].mesh_b != runs_[i - 1].mesh_b) groups_.push_back({i, i});
        groups_.back().last = i + 1;
    }
}

void Readings::read(const Group& group, std::span<const vox_contact> contacts, SurfaceTree& tree) {
    const ReadingBody& b = *runs_[group.first].b;
    const bool has_surface = b.topology && !b.topology->triangles.empty();
    if (has_surface) tree.build(solid_of(b));
    for (std::size_t r = group.first; r < group.last; ++r) {
        const std::span<const std::uint32_t> all = runs_[r].contacts;
        for (std::size_t first = 0, last; first < all.size(); first = last) {
            last = first + 1;
            while (last < all.size() && contacts[all[last]].vertex == contacts[all[first]].vertex) ++last;
            vox_reading& out = readings_[all[first]];
            read_vertex(runs_[r], all.subspan(first, last - first), contacts, has_surface ? &tree : nullptr,
                        out);
            for (std::size_t i = first + 1; i < last; ++i) { // in several tetrahedra
                readings_[all[i]] = out;
                readings_[all[i]].contact = all[i];
            }
        }
    }
}

void Readings::read_vertex(const Run& run, std::span<const std::uint32_t> same,
                           std::span<const vox_contact> contacts, SurfaceTree* tree, vox_reading& out) {
    const Body &a = run.a->body, &b = run.b->body;
    const std::uint32_t vertex = contacts[same[0]].vertex;
    out.user_data_a = run.user_data_a;
    out.user_data_b = run.user_data_b;
    if (!run.a->topology || vertex >= a.vertex_count || has_bit(a.removed_vertices, vertex)) return;
    const Vec3d p = a.positions.exact(vertex);
    write(out.position, p);
    out.known |= VOX_READING_POSITION;
    // The first of the tetrahedra with the vertex that is still on.
    const auto tet = std::find_if(same.begin(), same.end(), [&](std::uint32_t contact) {
        return contacts[contact].tet < b.tets.size() && !has_bit(b.off, contacts[contact].tet);
    });
    if (!tree || tet == same.end()) return;
    Closest closest;
    std::uint64_t visited = 0;
    if (tree->find_of_contact(p, vertex, contacts[*tet].tet, run.a == run.b, closest, visited))
        write_surface(solid_of(*run.b), p, closest, out);
}

} // namespace vox
