#include "mesh/mesh.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>
#include <utility>

namespace vox {

Mesh::Mesh(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter,
           std::pmr::memory_resource* memory)
    : owned_(memory), filter_(checked_filter({})), user_data_(desc.user_data), positions_(view.positions),
      tets_(view.tets), vertex_count_(view.vertex_count) {
    if (!(desc.flags & VOX_MESH_BORROW_TETS) && !tets_.empty()) own_tets();
    if ((desc.flags & VOX_MESH_COPY_POSITIONS) && has_positions()) {
        check_format_once(VOX_NULL_BODY);
        map_positions();
    }
    if (desc.rest_positions.data)
        self_filter_.make(memory).rest = rest_pose(
            check_positions_of(vertex_count_, desc.rest_positions, "rest_positions"), vertex_count_);
    set_filter(filter);
}

// For changes: what the mesh shares it lets go of, and keeps a copy of the tets unless they are borrowed.
PreparedTets& Mesh::own_prepared() {
    if (prepared_ && !is_shared_) return *prepared_;
    auto made =
        std::allocate_shared<PreparedTets>(std::pmr::polymorphic_allocator<PreparedTets>(memory()), memory());
    if (!is_shared_) return *(prepared_ = std::move(made));
    const bool borrows = borrows_tets();
    if (!borrows) {
        made->tets.assign(tets_.begin(), tets_.end());
        tets_ = made->tets;
    }
    prepared_ = std::move(made);
    owns_tets_ = !borrows;
    is_shared_ = has_tiles_ = false;
    if (has_topology_) ++topology_version_;
    has_topology_ = false;
    return *prepared_;
}

// For changes: a copy of those that are borrowed or shared.
Array<Tet>& Mesh::own_tets() {
    PreparedTets& own = own_prepared();
    if (owns_tets_) return own.tets;
    own.tets.assign(tets_.begin(), tets_.end());
    tets_ = own.tets;
    owns_tets_ = true;
    return own.tets;
}

void Mesh::share(SharedTets& shared) {
    std::shared_ptr<PreparedTets> of_all = shared.find_or_add(tets_, vertex_count_);
    if (owns_tets_) tets_ = of_all->tets;
    prepared_ = std::move(of_all);
    owns_tets_ = false;
    is_shared_ = true;
}

void Mesh::make_tiles() {
    if (has_tiles_) return;
    if (vertex_count_ > 0) {
        PreparedTets& made = is_shared_ ? *prepared_ : own_prepared();
        if (!is_shared_ || !made.has_tiles)
            make_tiled_mesh(body(VOX_NULL_BODY), made.tiled, has_topology_ ? &made.topology : nullptr);
        made.has_tiles = true;
    }
    has_tiles_ = true;
    ++tiles_version_;
}

void Mesh::make_topology() {
    if (has_topology_) return;
    if (!tets_.empty()) {
        PreparedTets& made = is_shared_ ? *prepared_ : own_prepared();
        if (!is_shared_ || !made.has_topology) vox::make_topology(tets(), vertex_count_, made.topology);
        made.has_topology = true;
    }
    has_topology_ = true;
    ++topology_version_;
}

const Topology& Mesh::topology() const noexcept {
    static const Topology none(std::pmr::null_memory_resource());
    return has_topology_ && prepared_ ? prepared_->topology : none;
}

const TiledMesh& Mesh::tiled() const noexcept {
    static const TiledMesh none(std::pmr::null_memory_resource());
    return has_tiles_ && prepared_ ? prepared_->tiled : none;
}

void Mesh::drop_topology() noexcept {
    if (prepared_ && !is_shared_) prepared_->topology = Topology(memory());
    has_topology_ = false;
    ++topology_version_;
}

// From the heap, as a const call must not use the memory of the grid.
const MeshSample& Mesh::sample() const {
    return sample_.get([this] {
        return make_sample(body(VOX_NULL_BODY), kept_sample(tets().size()), std::pmr::new_delete_resource(),
                           tiled().places.changes == 0 ? tiles_if_made() : nullptr);
    });
}

void Mesh::make_rings() {
    if (has_rings_) return;
    if (filter_.self_rings != 0)
        self_filter_.make(memory()).rings = Rings(tets(), vertex_count_, filter_.self_rings, memory());
    has_rings_ = true;
}

void Mesh::bind(const Positions& positions) noexcept {
    // A program that binds in every frame pays for the check once.
    format_checked_ = format_checked_ && positions.doubles == positions_.doubles;
    positions_ = positions;
    owns_positions_ = false;
    owned_ = Array<double>(owned_.memory());
}

void Mesh::check_format_once(vox_body id) {
    if (!format_checked_) format_checked_ = check_not_doubles(body(id));
}

Positions Mesh::packed(const void* data) const noexcept {
    return {.data = static_cast<const std::byte*>(data),
            .byte_stride = position_size(),
            .doubles = positions_.doubles};
}

void* Mesh::map_positions() {
    if (owned_.empty() && vertex_count_ > 0) {
        const std::size_t size = position_size();
        Array<double> owned((vertex_count_ * size + sizeof(double) - 1) / sizeof(double), 0.0,
                            owned_.memory());
        auto* to = reinterpret_cast<std::byte*>(owned.data());
        if (positions_.data)
            for (std::size_t v = 0; v < vertex_count_; ++v) positions_.copy(v, to + v * size);
        owned_ = std::move(owned);
        positions_ = packed(to);
    }
    owns_positions_ = true;
    return owned_.data();
}

void Mesh::set_transform(const double* matrix) {
    if (matrix) std::copy_n(matrix, 12, transform_.make(memory()).rows.begin());
    has_transform_ = matrix != nullptr;
}

vox_body_info Mesh::info() const noexcept {
    vox_body_info info{};
    info.struct_size = sizeof info;
    info.user_data = user_data_;
    info.tet_count = tet_count();
    info.enabled_tet_count = tet_count() - edits_->off.count();
    info.enabled = enabled_ ? 1 : 0;
    if (owns_positions_) info.flags |= VOX_MESH_COPY_POSITIONS;
    if (borrows_tets()) info.flags |= VOX_MESH_BORROW_TETS;
    info.positions = as_given(positions_, vertex_count_);
    if (!positions_.data) info.positions.byte_stride = info.positions.component_byte_stride = 0;
    for (const std::size_t i : {0u, 5u, 10u}) info.transform[i] = 1;
    if (has_transform_) std::copy(transform_->rows.begin(), transform_->rows.end(), info.transform);
    info.filter = filter_;
    return info;
}

Body Mesh::body(vox_body id) const noexcept {
    return {.mesh_id = id,
            .vertex_count = vertex_count_,
            .positions = positions(),
            .tets = tets(),
            .self_collision = collides_with_itself(filter_),
            .sensor = is_sensor(filter_),
            .filter = {filter_.category, filter_.mask, filter_.group, filter_.world},
            .exceptions = exceptions_->meshes,
            .self_filter =
                filter_.self_rings != 0 || filter_.self_rest_distance > 0 ? &*self_filter_ : nullptr,
            .off = edits_->off.words(),
            .off_count = edits_->off.count(),
            .removed_vertices = edits_->removed_vertices.words(),
            .slot = id == VOX_NULL_BODY ? Body::no_slot : slot_of(id),
            .user_data = user_data_};
}

void Mesh::set_filter(const vox_filter& filter) {
    RestPose rest(memory());
    if (filter.self_rest_distance > 0 && self_filter_->rest.empty() && vertex_count_ > 0) {
        if (!has_positions())
            throw Error(VOX_ERROR_INVALID_STATE,
                        "self_rest_distance needs a rest pose: the mesh has no positions "
                        "yet and was inserted without rest_positions");
        rest = rest_pose(body(VOX_NULL_BODY).positions, vertex_count_); // as they collide
    }
    if (filter.self_rings != 0 || filter.self_rest_distance > 0) self_filter_.make(memory());
    Rings rings(memory());
    const bool other_rings = !has_rings_ || filter.self_rings != filter_.self_rings;
    if (other_rings) rings = Rings(tets(), vertex_count_, filter.self_rings, memory());
    // More is prepared of bodies with self-collision.
    const bool first_self = collides_with_itself(filter) && !collides_with_itself(filter_);
    if (first_self && is_shared_) own_prepared();
    if (has_tiles_ && first_self) {
        Body with_self = body(VOX_NULL_BODY);
        with_self.self_collision = true;
        PreparedTets& own = own_prepared();
        make_tiled_mesh(with_self, own.tiled, has_topology_ ? &own.topology : nullptr);
        ++tiles_version_;
    }
    if (SelfFilter* own = self_filter_.if_made()) {
        if (!rest.empty()) own->rest = std::move(rest);
        if (other_rings) own->rings = std::move(rings);
        own->rest_distance = filter.self_rest_distance;
    }
    has_rings_ = true;
    filter_ = filter;
}

RestPose Mesh::rest_pose(const Positions& positions, std::uint32_t count) const {
    check_finite(
        {.vertex_count = count, .positions = positions, .slot = Body::no_slot, .user_data = user_data_});
    return RestPose(positions, count, memory());
}

void Mesh::reserve_exception() {
    Array<vox_body>& meshes = exceptions_.make(memory()).meshes;
    if (meshes.size() == meshes.capacity()) meshes.reserve(2 * meshes.size() + 2);
}

void Mesh::add_exception(vox_body other) noexcept {
    Array<vox_body>& meshes = exceptions_.if_made()->meshes;
    const auto place = std::lower_bound(meshes.begin(), meshes.end(), other);
    if (place == meshes.end() || *place != other) meshes.insert(place, other);
}

void Mesh::remove_exception(vox_body other) noexcept {
    if (Exceptions* made = exceptions_.if_made()) erase(made->meshes, other);
}

} // namespace vox
