#include "mesh/mesh.hpp"

#include "base/error.hpp"
#include "mesh/check.hpp"
#include "mesh/ids.hpp"

#include <algorithm>

namespace vox {

Mesh::Mesh(const vox_mesh_desc& desc, const Body& view, const vox_filter& filter,
           std::pmr::memory_resource* memory)
    : Mesh(memory) {
    user_data_ = desc.user_data;
    positions_ = view.positions;
    tets_ = view.tets;
    vertex_count_ = view.vertex_count;
    if (!(desc.flags & VOX_MESH_BORROW_TETS)) own_tets();
    if ((desc.flags & VOX_MESH_COPY_POSITIONS) && has_positions()) {
        check_format_once(VOX_NULL_BODY);
        map_positions();
    }
    if (desc.rest_positions.data)
        self_filter_.rest = rest_pose(
            check_positions_of(vertex_count_, desc.rest_positions, "rest_positions"), vertex_count_);
    set_filter(filter);
}

// Copies borrowed tetrahedra, so that they can change.
Array<Tet>& Mesh::own_tets() {
    if (borrows_tets()) {
        own_tets_.assign(tets_.begin(), tets_.end());
        tets_ = own_tets_;
    }
    return own_tets_;
}

void Mesh::make_tiles() {
    if (has_tiles_) return;
    if (vertex_count_ > 0) make_tiled_mesh(body(VOX_NULL_BODY), tiled_, has_topology_ ? &topology_ : nullptr);
    has_tiles_ = true;
    ++tiles_version_;
}

void Mesh::make_topology() {
    if (has_topology_) return;
    if (!tets_.empty()) vox::make_topology(tets(), vertex_count_, topology_);
    has_topology_ = true;
    ++topology_version_;
}

void Mesh::drop_topology() noexcept {
    topology_ = Topology(memory());
    has_topology_ = false;
    ++topology_version_;
}

// It comes from the heap, as a const call must not use the memory of the grid.
const MeshSample& Mesh::sample() const {
    return sample_.get([this] {
        return make_sample(body(VOX_NULL_BODY), kept_sample(tets().size()), std::pmr::new_delete_resource(),
                           tiled().places.changes == 0 ? tiles_if_made() : nullptr);
    });
}

void Mesh::make_rings() {
    if (has_rings_) return;
    if (filter_.self_rings != 0)
        self_filter_.rings = Rings(tets(), vertex_count_, filter_.self_rings, memory());
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

void Mesh::set_transform(const double* matrix) noexcept {
    if (matrix) std::copy_n(matrix, 12, transform_.begin());
    has_transform_ = matrix != nullptr;
}

vox_body_info Mesh::info() const noexcept {
    vox_body_info info{};
    info.struct_size = sizeof info;
    info.user_data = user_data_;
    info.tet_count = tet_count();
    info.enabled_tet_count = tet_count() - edits_.off.count();
    info.enabled = enabled_ ? 1 : 0;
    if (owns_positions_) info.flags |= VOX_MESH_COPY_POSITIONS;
    if (borrows_tets()) info.flags |= VOX_MESH_BORROW_TETS;
    info.positions = as_given(positions_, vertex_count_);
    if (!positions_.data) info.positions.byte_stride = info.positions.component_byte_stride = 0;
    for (const std::size_t i : {0u, 5u, 10u}) info.transform[i] = 1;
    if (has_transform_) std::ranges::copy(transform_, info.transform);
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
            .exceptions = exceptions_,
            .self_filter =
                filter_.self_rings != 0 || filter_.self_rest_distance > 0 ? &self_filter_ : nullptr,
            .off = edits_.off.words(),
            .off_count = edits_.off.count(),
            .removed_vertices = edits_.removed_vertices.words(),
            .slot = id == VOX_NULL_BODY ? Body::no_slot : slot_of(id),
            .user_data = user_data_,
            .shape = shape_.get()};
}

void Mesh::set_filter(const vox_filter& filter) {
    RestPose rest(memory());
    if (filter.self_rest_distance > 0 && self_filter_.rest.empty() && vertex_count_ > 0) {
        if (!has_positions())
            throw Error(VOX_ERROR_INVALID_STATE,
                        "self_rest_distance needs a rest pose: the mesh has no positions "
                        "yet and was inserted without rest_positions");
        rest = rest_pose(body(VOX_NULL_BODY).positions, vertex_count_); // as they collide
    }
    Rings rings(memory());
    const bool other_rings = !has_rings_ || filter.self_rings != filter_.self_rings;
    if (other_rings) rings = Rings(tets(), vertex_count_, filter.self_rings, memory());
    // More is prepared of bodies with self-collision.
    const bool first_self = collides_with_itself(filter) && !collides_with_itself(filter_);
    if (has_tiles_ && first_self) {
        Body with_self = body(VOX_NULL_BODY);
        with_self.self_collision = true;
        make_tiled_mesh(with_self, tiled_, has_topology_ ? &topology_ : nullptr);
        ++tiles_version_;
    }
    if (!rest.empty()) self_filter_.rest = std::move(rest);
    if (other_rings) self_filter_.rings = std::move(rings);
    self_filter_.rest_distance = filter.self_rest_distance;
    has_rings_ = true;
    filter_ = filter;
}

RestPose Mesh::rest_pose(const Positions& positions, std::uint32_t count) const {
    check_finite(
        {.vertex_count = count, .positions = positions, .slot = Body::no_slot, .user_data = user_data_});
    return RestPose(positions, count, memory());
}

void Mesh::reserve_exception() {
    if (exceptions_.size() == exceptions_.capacity()) exceptions_.reserve(2 * exceptions_.size() + 2);
}

void Mesh::add_exception(vox_body other) noexcept {
    const auto place = std::lower_bound(exceptions_.begin(), exceptions_.end(), other);
    if (place == exceptions_.end() || *place != other) exceptions_.insert(place, other);
}

} // namespace vox
