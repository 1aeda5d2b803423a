// A scene in one grid, and among ranks.
#pragma once

#include "dist/scenes.hpp"

#include <map>
#include <string>

namespace scenes {

inline std::string text_of(const vox_scene_contact& c) {
    return std::to_string(c.body_a) + ' ' + std::to_string(c.vertex) + ' ' + std::to_string(c.body_b) + ' ' +
           std::to_string(c.tet) + ' ' + std::to_string(c.interior) + ' ' + std::to_string(c.barycentric[0]);
}

// A rank's share of a scene, in a vox_scene.
class Ranked {
public:
    Ranked(const vox_transport* transport, const vox_scene_desc* desc = nullptr) {
        result = vox_scene_create(desc, transport, &scene);
    }
    ~Ranked() { vox_scene_destroy(scene); }
    Ranked(const Ranked&) = delete;
    Ranked& operator=(const Ranked&) = delete;

    vox_result insert(const Body& body, Share& share) {
        if (share.vertex_ids.empty()) return VOX_OK;
        vox_mesh_desc mesh = body.doubles ? vox_mesh_desc_doubles(share.xyz.data(), share.vertex_ids.size(),
                                                                  share.tets.data(), share.tet_ids.size())
                                          : vox_mesh_desc_floats(share.floats.data(), share.vertex_ids.size(),
                                                                 share.tets.data(), share.tet_ids.size());
        mesh.filter = body.filter;
        vox_part_desc part = vox_default_part_desc();
        part.body = body.number;
        part.mesh = &mesh;
        part.vertex_ids = share.vertex_ids.data();
        part.tet_ids = share.tet_ids.data();
        part.owned = share.owned.data();
        vox_part handle;
        const vox_result inserted = vox_scene_insert(scene, &part, &handle);
        if (inserted == VOX_OK) parts[body.number] = handle;
        return inserted;
    }
    vox_result remove(const Body& body) {
        const auto part = parts.find(body.number);
        if (part == parts.end()) return VOX_OK; // not on this rank
        const vox_result removed = vox_scene_remove(scene, part->second);
        parts.erase(part);
        return removed;
    }

    vox_scene* scene = nullptr;
    vox_result result;
    std::map<std::uint64_t, vox_part> parts; // of bodies
};

// All bodies in one grid, which borrows `floats`.
inline vox_grid* whole(const Scene& scene, std::vector<std::vector<float>>& floats) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = 0;
    vox_grid* grid = nullptr;
    if (vox_grid_create(&desc, &grid) != VOX_OK) return nullptr;
    floats.assign(scene.size(), {});
    for (std::size_t b = 0; b < scene.size(); ++b) {
        const Body& body = scene[b];
        for (const double number : body.xyz) floats[b].push_back(static_cast<float>(number));
        vox_mesh_desc mesh =
            body.doubles
                ? vox_mesh_desc_doubles(body.xyz.data(), body.vertices(), body.tets.data(), body.tet_count())
                : vox_mesh_desc_floats(floats[b].data(), body.vertices(), body.tets.data(), body.tet_count());
        mesh.filter = body.filter;
        mesh.user_data = body.number;
        vox_body id;
        if (vox_mesh_insert(grid, &mesh, &id) != VOX_OK) return nullptr;
    }
    return grid;
}

} // namespace scenes
