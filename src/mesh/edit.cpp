// Edits of a mesh: first everything that can fail, then the change itself, then the repair of what was
// prepared of the mesh, which takes time in proportion to the edit.
#include "mesh/mesh.hpp"

#include "base/error.hpp"
#include "base/room.hpp"
#include "mesh/check.hpp"
#include "mesh/tet_changes.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstring>
#include <utility>

namespace vox {

namespace {

Tet hidden(const Tet& tet) { return {{tet.v[0], tet.v[0], tet.v[0], tet.v[0]}}; }

// Checks a list of tets or vertices, of which the mesh has `count`.
void check_items(std::span<const std::uint32_t> items, std::size_t count, const Bits& removed,
                 const char* name) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i] >= count)
            refuse(format("%s[%zu] is %" PRIu32 ", the mesh has %zu %s", name, i, items[i], count, name));
        if (removed[items[i]]) refuse(format("%s[%zu] is %" PRIu32 ", which was removed", name, i, items[i]));
    }
}

} // namespace

// ---- tetrahedra -----------------------------------------------------------------------------------

void Mesh::check_tets(std::span<const std::uint32_t> tets) const {
    check_items(tets, this->tets().size(), edits_.removed, "tets");
}

void Mesh::check_corners(std::uint32_t tet, const Tet& corners) const {
    for (const std::uint32_t vertex : corners.v) {
        if (vertex >= vertex_count_)
            throw Error(VOX_ERROR_INVALID_MESH, format("tet %" PRIu32 " names vertex %" PRIu32 " of %" PRIu32,
                                                       tet, vertex, vertex_count_));
        if (edits_.removed_vertices[vertex])
            throw Error(VOX_ERROR_INVALID_MESH,
                        format("tet %" PRIu32 " names vertex %" PRIu32 ", which was removed", tet, vertex));
    }
}

// Afterwards switch_off() cannot fail.
MeshEdits& Mesh::reserve_off() {
    own_tets();
    MeshEdits& edits = edits_;
    edits.off.reserve(tets_.size());
    if (edits.given.empty()) edits.given.assign(tets_.begin(), tets_.end());
    return edits;
}

void Mesh::switch_off(std::uint32_t tet, Array<TetChange>& changes) noexcept {
    MeshEdits& edits = edits_;
    if (edits.off[tet]) return;
    changes.push_back({tet, true, false, tets_[tet], {}});
    own_tets_[tet] = hidden(tets_[tet]);
    edits.off.add(tet);
}

void Mesh::set_tets_enabled(std::span<const std::uint32_t> tets, bool enabled) {
    check_tets(tets);
    if (enabled)
        for (const std::uint32_t tet : tets) check_corners(tet, given(tet));
    Array<TetChange> changes(memory());
    changes.reserve(tets.size());
    if (!enabled && !tets.empty()) reserve_off();

    for (const std::uint32_t tet : tets) {
        if (!enabled) switch_off(tet, changes);
        if (!enabled || !edits_.off[tet]) continue;
        own_tets_[tet] = edits_.given[tet]; // the mesh's own, as one of them is off
        edits_.off.remove(tet);
        changes.push_back({tet, false, true, {}, tets_[tet]});
    }
    apply(changes);
}

void Mesh::remove_tets(std::span<const std::uint32_t> tets) {
    check_tets(tets);
    Array<TetChange> changes(memory());
    changes.reserve(tets.size());
    if (tets.empty()) return;
    MeshEdits& edits = reserve_off();
    edits.removed.reserve(tets_.size());

    for (const std::uint32_t tet : tets) {
        switch_off(tet, changes);
        edits.removed.add(tet);
    }
    apply(changes);
}

void Mesh::replace_tets(std::span<const std::uint32_t> tets, std::span<const Tet> corners) {
    check_tets(tets);
    for (std::size_t i = 0; i < tets.size(); ++i) check_corners(tets[i], corners[i]);
    Array<TetChange> changes(memory());
    changes.reserve(tets.size());
    if (tets.empty()) return;
    Array<Tet>& own = own_tets();

    for (std::size_t i = 0; i < tets.size(); ++i) {
        const std::uint32_t tet = tets[i];
        const bool is_off = edits_.off[tet];
        if (!edits_.given.empty()) edits_.given[tet] = corners[i];
        if (!is_off) changes.push_back({tet, true, true, tets_[tet], corners[i]});
        own[tet] = is_off ? hidden(corners[i]) : corners[i];
    }
    apply(changes);
}

std::uint32_t Mesh::append_tets(std::span<const Tet> corners) {
    const auto first = static_cast<std::uint32_t>(tets().size());
    if (corners.empty()) return first;
    for (std::size_t i = 0; i < corners.size(); ++i)
        check_corners(first + static_cast<std::uint32_t>(i), corners[i]);
    Array<TetChange> changes(memory());
    changes.reserve(corners.size());
    Array<Tet>& own = own_tets();
    const std::size_t count = own.size() + corners.size();
    reserve_growing(own, count);
    tets_ = own; // may have moved
    const bool has_given = !edits_.given.empty();
    if (has_given) reserve_growing(edits_.given, count);

    if (has_given) edits_.given.insert(edits_.given.end(), corners.begin(), corners.end());
    for (const Tet& tet : corners) {
        changes.push_back({static_cast<std::uint32_t>(own.size()), false, true, {}, tet});
        own.push_back(tet);
    }
    tets_ = own;
    apply(changes);
    return first;
}

// ---- vertices -------------------------------------------------------------------------------------

Positions Mesh::check_appended(const vox_vertices_desc& desc, std::uint32_t count) const {
    if (!desc.positions.data) return {};
    const Positions given = check_positions(desc.positions, "positions");
    if (desc.positions.count != count)
        refuse(format("positions.count is %" PRIu64 ", expected %" PRIu32 ": the mesh %s",
                      desc.positions.count, count,
                      owns_positions_ ? "has positions of its own, and needs those of the new vertices"
                                      : "borrows its positions, and needs those of all vertices"));
    if (owns_positions_ && given.doubles != positions_.doubles)
        refuse(format("positions.format is VOX_FORMAT_%s, that of the mesh is not",
                      given.doubles ? "DOUBLE" : "FLOAT"));
    return given;
}

std::uint32_t Mesh::append_vertices(const vox_vertices_desc& desc) {
    const std::uint32_t before = vertex_count_;
    const auto added = static_cast<std::uint32_t>(desc.count), count = before + added;
    const bool owns = owns_positions_;
    const std::size_t size = position_size();
    const Positions given = check_appended(desc, owns ? added : count);
    for (std::uint32_t i = 0; desc.copies_of && i < added; ++i)
        if (desc.copies_of[i] >= before)
            refuse(format("copies_of[%" PRIu32 "] is %" PRIu32 ", the mesh has %" PRIu32 " vertices", i,
                          desc.copies_of[i], before));
    if (added == 0) return before;
    if (!given.data && !owns && positions_.data)
        refuse(
            format("positions.data is null: the mesh borrows its positions, and needs all %" PRIu32, count));
    if (owns && !given.data && !desc.copies_of)
        refuse(format(
            "positions.data and copies_of are null: the mesh has positions of its own, and needs %" PRIu32
            " more",
            added));

    // Positions: all of them where they are borrowed, else those of the new vertices.
    Array<std::byte> news(memory()); // apart: growing owned_ moves what they may be copied from
    if (owns) {
        news.resize(added * size);
        for (std::size_t i = 0; i < added; ++i)
            if (given.data)
                given.copy(i, news.data() + i * size);
            else
                positions_.copy(desc.copies_of[i], news.data() + i * size);
    }

    // The rest pose grows, too.
    RestPose rest(memory());
    const bool has_rest = !self_filter_.rest.empty() || (before == 0 && filter_.self_rest_distance > 0);
    if (has_rest && desc.rest_positions.data) {
        rest = rest_pose(check_positions_of(added, desc.rest_positions, "rest_positions"), added);
    } else if (has_rest && desc.copies_of) {
        rest = self_filter_.rest.of({desc.copies_of, added});
    } else if (has_rest) {
        Positions poses = given;
        if (owns)
            poses = packed(news.data());
        else if (given.data)
            poses.data += before * given.byte_stride;
        else
            throw Error(VOX_ERROR_INVALID_STATE,
                        "the mesh has a rest distance: its new vertices need rest_positions, or positions");
        if (has_transform_) poses.transform = transform_.data(); // the rest pose is that of the collisions
        rest = rest_pose(poses, added);
    }
    if (has_rest) self_filter_.rest.reserve_for(rest);
    const std::size_t doubles = (count * size + sizeof(double) - 1) / sizeof(double);
    if (owns) reserve_growing(owned_, doubles);

    self_filter_.rest.append(rest);
    vertex_count_ = count;
    if (owns) {
        owned_.resize(doubles);
        positions_ = packed(owned_.data());
        std::memcpy(reinterpret_cast<std::byte*>(owned_.data()) + before * size, news.data(), news.size());
    } else if (given.data) {
        bind(given);
    }
    apply_vertices(before);
    return before;
}

void Mesh::remove_vertices(std::span<const std::uint32_t> vertices) {
    check_items(vertices, vertex_count_, edits_.removed_vertices, "vertices");
    if (vertices.empty()) return;
    MeshEdits& edits = list_tets_of();
    for (const std::uint32_t v : vertices)
        if (const std::span<const std::uint32_t> around = std::as_const(edits.tets_of)[v]; !around.empty())
            refuse(format("vertex %" PRIu32 " is a corner of tet %" PRIu32 ", which is on", v,
                          *std::min_element(around.begin(), around.end())));
    edits.removed_vertices.reserve(vertex_count_);

    for (const std::uint32_t v : vertices) {
        edits.removed_vertices.add(v);
        if (has_tiles_) remove_loose(tiled_.boundary, v);
    }
}

void Mesh::restore_edits(std::span<const std::uint64_t> off, std::span<const std::uint64_t> removed,
                         std::span<const std::uint64_t> removed_vertices) {
    const auto tets = static_cast<std::uint32_t>(this->tets().size());
    MeshEdits& edits = edits_;
    edits.removed_vertices.reserve(vertex_count_);
    for (std::uint32_t v = 0; v < vertex_count_; ++v)
        if (has_bit(removed_vertices, v)) edits.removed_vertices.add(v);
    for (std::uint32_t t = 0; t < tets; ++t) {
        if (!has_bit(off, t)) check_corners(t, given(t));
        if (!has_bit(off, t) && has_bit(removed, t))
            throw Error(VOX_ERROR_INVALID_MESH, format("tet %" PRIu32 " is removed, but not off", t));
    }
    Array<TetChange> changes(memory());
    changes.reserve(tets);
    reserve_off();
    edits.removed.reserve(tets);
    for (std::uint32_t t = 0; t < tets; ++t) {
        if (has_bit(off, t)) switch_off(t, changes);
        if (has_bit(removed, t)) edits.removed.add(t);
    }
    invalidate_prepared();
}

// ---- what was prepared ----------------------------------------------------------------------------

MeshEdits& Mesh::list_tets_of() {
    MeshEdits& edits = edits_;
    if (!edits.has_tets_of) list_tets(tets(), edits.off.words(), vertex_count_, edits.tets_of);
    edits.has_tets_of = true;
    return edits;
}

void Mesh::invalidate_tiles() noexcept {
    tiled_ = TiledMesh(memory());
    has_tiles_ = false;
}

void Mesh::invalidate_prepared() noexcept {
    edits_.tets_of = IndexLists(memory());
    edits_.has_tets_of = false;
    drop_topology();
    self_filter_.rings = Rings(memory());
    has_rings_ = filter_.self_rings == 0;
    sample_.reset();
    invalidate_tiles();
}

void Mesh::apply(std::span<const TetChange> changes) noexcept {
    if (changes.empty()) return;
    sample_.reset();
    const bool has_rings = has_rings_ && filter_.self_rings != 0;
    const bool has_tets_of = edits_.has_tets_of;
    if (!has_tets_of && !has_tiles_ && !has_topology_ && !has_rings) return;
    // Repairing so many takes longer than making all anew.
    if (changes.size() > tets_.size() / 8 + 64) return invalidate_prepared();
    try {
        if (has_tets_of) apply_changes(changes, edits_.tets_of);
        const IndexLists& tets_of = list_tets_of().tets_of;
        if (has_tiles_ && !repair(tiled_, body(VOX_NULL_BODY), changes, tets_of)) invalidate_tiles();
        if (has_topology_) {
            check_tet_count(tets_.size());
            ++topology_version_;
            repair_topology(tets_, tets_of, changes, topology_);
        }
        if (has_rings) self_filter_.rings.repair(tets_, tets_of, changes, filter_.self_rings);
    } catch (...) { // out of memory, as a rule
        invalidate_prepared();
    }
}

void Mesh::apply_vertices(std::uint32_t count_before) noexcept {
    sample_.reset();
    try {
        if (edits_.has_tets_of) edits_.tets_of.resize(vertex_count_);
        if (has_tiles_ && !vox::add_vertices(tiled_, count_before, vertex_count_)) invalidate_tiles();
        if (has_topology_) add_vertices(vertex_count_, topology_);
        if (has_rings_ && filter_.self_rings != 0) self_filter_.rings.add_vertices(vertex_count_);
    } catch (...) {
        invalidate_prepared();
    }
}

// ---- another topology -----------------------------------------------------------------------------

Mesh Mesh::with_topology(const vox_mesh_desc& desc, const Body& view) const {
    Mesh made(desc, view, checked_filter({}), memory());
    made.set_transform(has_transform_ ? transform_.data() : nullptr);
    if (!desc.positions.data && view.vertex_count == vertex_count_) {
        made.positions_ = positions_; // take_over() moves owned ones
        if (!desc.rest_positions.data && !self_filter_.rest.empty())
            made.self_filter_.rest = self_filter_.rest;
    }
    made.set_filter(filter_);
    return made;
}

void Mesh::take_over(Mesh&& before) noexcept {
    if (before.owns_positions_ && positions_.data == before.positions_.data) {
        owned_ = std::move(before.owned_);
        owns_positions_ = true;
    }
    exceptions_ = std::move(before.exceptions_);
    user_data_ = before.user_data_;
    topology_version_ = before.topology_version_ + 1;
    enabled_ = before.enabled_;
}

} // namespace vox
