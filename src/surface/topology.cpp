#include "surface/topology.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstring>

namespace vox {

namespace {

template <std::size_t corners>
void copy_features(const std::uint32_t* from, std::uint64_t count, std::uint32_t vertex_count,
                   const char* name, Array<std::array<std::uint32_t, corners>>& out) {
    if (count == 0) return;
    out.resize(static_cast<std::size_t>(count));
    std::memcpy(out.data(), from, out.size() * sizeof out[0]);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (const std::uint32_t v : out[i])
            if (v >= vertex_count)
                throw Error(VOX_ERROR_INVALID_MESH,
                            format("%s %zu names vertex %u of %u", name, i, v, vertex_count));
}

// Lists each edge of a face once, lower vertex first, ascending.
void list_edges(std::span<const SurfaceFace> faces, Array<SurfaceEdge>& out) {
    Array<std::uint64_t> keys(out.memory());
    keys.reserve(3 * faces.size());
    for (const SurfaceFace& face : faces)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t v = face[i], w = face[(i + 1) % 3];
            keys.push_back(std::uint64_t{std::min(v, w)} << 32 | std::max(v, w));
        }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    if (keys.size() > VOX_MAX_FEATURES)
        throw Error(VOX_ERROR_LIMIT,
                    format("the faces have %zu edges, the limit is %u", keys.size(), VOX_MAX_FEATURES));
    out.reserve(keys.size());
    for (const std::uint64_t key : keys)
        out.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)});
}

} // namespace

SurfaceTopology::SurfaceTopology(const vox_surface_desc& desc, std::pmr::memory_resource* memory)
    : edges(memory), faces(memory), patches(memory), patch_filters(memory) {
    if (desc.vertex_count == 0) refuse("vertex_count is 0, expected at least one vertex");
    check_limit(desc.vertex_count, VOX_MAX_FEATURES, "vertex_count");
    check_limit(desc.edge_count, VOX_MAX_FEATURES, "edge_count");
    check_limit(desc.face_count, VOX_MAX_FEATURES, "face_count");
    if (desc.face_count > 0) require(desc.faces, "faces");
    if (desc.edge_count > 0) require(desc.edges, "edges");
    vertex_count = static_cast<std::uint32_t>(desc.vertex_count);
    copy_features(desc.faces, desc.face_count, vertex_count, "face", faces);
    if (desc.edges)
        copy_features(desc.edges, desc.edge_count, vertex_count, "edge", edges);
    else
        list_edges(faces, edges);

    if (!desc.patches) {
        if (desc.patch_categories || desc.patch_masks)
            refuse("patches is null, but patch_categories or patch_masks is not");
        return;
    }
    if (desc.patch_count == 0) refuse("patch_count is 0, but patches is not null");
    check_limit(desc.patch_count, VOX_MAX_PATCHES, "patch_count");
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (desc.patches[v] >= desc.patch_count)
            refuse(format("vertex %u is in patch %u of %" PRIu64, v, desc.patches[v], desc.patch_count));
    patches.assign(desc.patches, desc.patches + vertex_count);
    patch_filters.resize(static_cast<std::size_t>(desc.patch_count));
    for (std::size_t p = 0; p < patch_filters.size(); ++p) {
        if (desc.patch_categories) patch_filters[p].category = desc.patch_categories[p];
        if (desc.patch_masks) patch_filters[p].mask = desc.patch_masks[p];
    }
}

bool SurfaceTopology::may_meet(std::span<const std::uint32_t> a,
                               std::span<const std::uint32_t> b) const noexcept {
    if (!has_patches()) return true;
    for (const std::uint32_t v : a)
        for (const std::uint32_t w : b) {
            const Patch &p = patch_filters[patches[v]], &q = patch_filters[patches[w]];
            if ((p.category & q.mask) != 0 && (q.category & p.mask) != 0) return true;
        }
    return false;
}

} // namespace vox
