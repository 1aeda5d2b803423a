#include "mesh/tiled_mesh.hpp"

#include "base/bits.hpp"

#include <cstring>
#include <utility>

namespace vox {

void make_tiled_mesh(const Body& body, TiledMesh& out, const MatchedFacets* facets) {
    std::pmr::memory_resource* memory = out.boundary.triangles.memory();
    TiledMesh made(memory);
    make_tiles(body.tets, body.vertex_count, body.positions, made.tiles, body.off);
    if (body.self_collision) {
        make_boundary(body.tets, body.vertex_count, body.positions, made.tiles, made.boundary, facets);
        if (!boundary_pays(made.boundary.triangles.size(), made.tiles.tets.size()))
            made.boundary = Boundary(memory);
        erase_if(made.boundary.loose, [&](std::uint32_t v) { return has_bit(body.removed_vertices, v); });
    }
    // Winding numbers leave few tiles in which vertices of the same body are looked up.
    if (!body.self_collision || made.boundary.is_closed) {
        made.tiles.own.clear();
        made.tiles.own.shrink_to_fit();
    }
    made.places.first_young_super = made.tiles.super_tile_count();
    made.places.first_young_vertex = body.vertex_count;
    out = std::move(made);
}

// ---- shared by small meshes ----------------------------------------------------------------------------

// Takes itself off the list when the last mesh lets go of it.
struct SharedTets::Shared final : PreparedTets, std::enable_shared_from_this<Shared> {
    Shared(const Key& of, SharedTets& list)
        : PreparedTets(list.all_.get_allocator().resource()), list_(list) {
        tets.assign(of.tets.begin(), of.tets.end());
        key = {tets, of.vertex_count};
    }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;
    ~Shared() {
        if (is_listed) list_.all_.erase(this);
    }

    Key key;
    bool is_listed = false;

private:
    SharedTets& list_;
};

bool SharedTets::Key::operator<(const Key& other) const noexcept {
    if (vertex_count != other.vertex_count) return vertex_count < other.vertex_count;
    if (tets.size() != other.tets.size()) return tets.size() < other.tets.size();
    return std::memcmp(tets.data(), other.tets.data(), tets.size_bytes()) < 0;
}

bool SharedTets::Before::operator()(const Shared* a, const Shared* b) const noexcept {
    return a->key < b->key;
}
bool SharedTets::Before::operator()(const Key& a, const Shared* b) const noexcept { return a < b->key; }
bool SharedTets::Before::operator()(const Shared* a, const Key& b) const noexcept { return a->key < b; }

std::shared_ptr<PreparedTets> SharedTets::find_or_add(std::span<const Tet> tets, std::uint32_t vertex_count) {
    const Key key{tets, vertex_count};
    if (const auto found = all_.find(key); found != all_.end()) return (*found)->shared_from_this();
    const auto made = std::allocate_shared<Shared>(
        std::pmr::polymorphic_allocator<Shared>(all_.get_allocator().resource()), key, *this);
    all_.insert(made.get());
    made->is_listed = true;
    return made;
}

void SharedTets::drop_topologies() noexcept {
    for (Shared* shared : all_) {
        shared->topology = Topology(all_.get_allocator().resource());
        shared->has_topology = false;
    }
}

} // namespace vox
