// A scene in one grid, and among ranks, and their contacts.
#pragma once

#include "dist/hash.hpp" // of src/
#include "dist/scenes.hpp"
#include "exact/predicates.hpp" // of src/

#include <numeric>
#include <set>
#include <string>
#include <tuple>

namespace scenes {

inline std::string text_of(const vox_dist_contact& c) {
    return std::to_string(c.body_a) + ' ' + std::to_string(c.vertex) + ' ' + std::to_string(c.body_b) + ' ' +
           std::to_string(c.tet) + ' ' + std::to_string(c.interior) + ' ' + std::to_string(c.weights[0]);
}

// A rank's share of a scene.
class Ranked {
public:
    Ranked(const vox_dist_transport* transport, const vox_grid_desc* grid = nullptr) {
        result = vox_dist_scene_create(grid, transport, &scene);
    }
    ~Ranked() { vox_dist_scene_destroy(scene); }
    Ranked(const Ranked&) = delete;
    Ranked& operator=(const Ranked&) = delete;

    vox_result insert(const Body& body, Share& share) {
        if (share.vertex_ids.empty()) return VOX_OK;
        vox_mesh_desc mesh = body.doubles ? vox_mesh_desc_doubles(share.xyz.data(), share.vertex_ids.size(),
                                                                  share.tets.data(), share.tet_ids.size())
                                          : vox_mesh_desc_floats(share.floats.data(), share.vertex_ids.size(),
                                                                 share.tets.data(), share.tet_ids.size());
        mesh.filter = body.filter;
        vox_dist_part_desc part = vox_default_dist_part_desc();
        part.body = body.number;
        part.mesh = &mesh;
        part.vertex_ids = share.vertex_ids.data();
        part.tet_ids = share.tet_ids.data();
        part.owned = share.owned.data();
        const vox_result inserted = vox_dist_scene_insert(scene, &part);
        if (inserted == VOX_OK) bodies.insert(body.number);
        return inserted;
    }
    vox_result remove(const Body& body) {
        if (!bodies.erase(body.number)) return VOX_OK; // not on this rank
        return vox_dist_scene_remove(scene, body.number);
    }

    vox_dist_scene* scene = nullptr;
    vox_result result;
    std::set<std::uint64_t> bodies; // with a part here
};

// All bodies in one grid, in the order of their numbers. It borrows `floats`.
inline vox_grid* whole(const Scene& scene, std::vector<std::vector<float>>& floats) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = 0;
    vox_grid* grid = nullptr;
    if (vox_grid_create(&desc, &grid) != VOX_OK) return nullptr;
    floats.assign(scene.size(), {});
    std::vector<std::size_t> order(scene.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return scene[a].number < scene[b].number; });
    for (const std::size_t b : order) {
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

inline bool before(const vox_dist_contact& a, const vox_dist_contact& b) {
    return std::tie(a.body_a, a.vertex, a.body_b, a.tet) < std::tie(b.body_a, b.vertex, b.body_b, b.tet);
}

// Where a vertex is that a grid has read as floats or doubles.
inline vox::Vec3d position_of(const vox_positions& positions, std::uint64_t vertex) {
    const auto at = [&](const auto* numbers) {
        return vox::Vec3d{numbers[3 * vertex], numbers[3 * vertex + 1], numbers[3 * vertex + 2]};
    };
    return positions.format == VOX_FORMAT_DOUBLE ? at(static_cast<const double*>(positions.data))
                                                 : at(static_cast<const float*>(positions.data));
}

// The contacts that a step of such a grid of the scene found, in the order and with the numbers of a
// vox_dist_scene. Without index and rank.
inline std::vector<vox_dist_contact> global_contacts(const Scene& scene, const vox_grid* grid) {
    vox_contact_view contacts{};
    if (vox_grid_get_contacts(grid, &contacts) != VOX_OK) return {};
    const auto tets_of = [&](std::uint64_t number) -> const std::vector<std::uint32_t>& {
        return std::find_if(scene.begin(), scene.end(), [&](const Body& b) { return b.number == number; })
            ->tets;
    };
    const auto positions_of = [&](vox_body body) {
        vox_body_info info{};
        info.struct_size = sizeof info;
        (void)vox_body_get_info(grid, body, &info);
        return info.positions;
    };
    std::vector<vox_dist_contact> found(contacts.count);
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact& hit = contacts.data[i];
        vox_dist_contact& contact = found[i];
        (void)vox_body_get_user_data(grid, hit.body_a, &contact.body_a);
        (void)vox_body_get_user_data(grid, hit.body_b, &contact.body_b);
        contact.vertex = hit.vertex;
        contact.tet = hit.tet;
        const std::uint32_t* tet = &tets_of(contact.body_b)[4 * contact.tet];
        const vox_positions of_b = positions_of(hit.body_b);
        const auto corner = [&](std::size_t c) { return position_of(of_b, tet[c]); };
        const vox::Vec3d vertex = position_of(positions_of(hit.body_a), contact.vertex);
        const auto weights = vox::exact_weights(vertex, corner(0), corner(1), corner(2), corner(3));
        std::copy(weights.begin(), weights.end(), contact.weights);
        contact.interior = contacts.interiors[i];
    }
    std::sort(found.begin(), found.end(), before);
    return found;
}

// Whether two contacts are the same, on whatever sides and ranks.
inline bool same(const vox_dist_contact& a, const vox_dist_contact& b) {
    return !before(a, b) && !before(b, a) && a.interior == b.interior &&
           std::memcmp(a.weights, b.weights, sizeof a.weights) == 0;
}

// What vox_dist_scene_get_hash gives for these contacts.
inline void hash_of(const std::vector<vox_dist_contact>& contacts, std::uint64_t out[2]) {
    vox::dist::ContactSum sum;
    for (const vox_dist_contact& contact : contacts) sum.add(contact);
    sum.write(out);
}

} // namespace scenes
