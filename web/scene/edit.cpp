// Bodies come and go, and are cut.
#include "playground.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

using namespace play;

namespace {

constexpr double opening = 0.03;       // how far each part is moved away from the cut
constexpr double opening_speed = 0.35; // and how fast it goes on

using Triangle = std::array<std::uint32_t, 3>;

Triangle sorted(Triangle corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}

// Puts the triangles of a part last that were no part of the surface before, or were cut faces already.
void put_cut_faces_last(Body& part, const std::vector<std::uint32_t>& old_vertex, const Body& whole) {
    std::set<Triangle> uncut;
    for (std::size_t i = 0; i < whole.uncut; i += 3)
        uncut.insert(sorted({whole.triangles[i], whole.triangles[i + 1], whole.triangles[i + 2]}));
    std::vector<std::uint32_t> first, last;
    for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
        const std::uint32_t* t = &part.triangles[i];
        const bool old = uncut.contains(sorted({old_vertex[t[0]], old_vertex[t[1]], old_vertex[t[2]]}));
        (old ? first : last).insert((old ? first : last).end(), t, t + 3);
    }
    part.uncut = first.size();
    first.insert(first.end(), last.begin(), last.end());
    part.triangles = std::move(first);
}

// A body of a part, moved away from the cut if there are others.
Body insert_part(playground& play, const Body& whole, const Part& part, const Stroke& stroke, bool alone) {
    std::vector<double> now, rest, velocities;
    Vec sum{};
    for (const std::uint32_t v : part.old_vertex) {
        sum = sum + at(list(whole.view.positions, 3 * whole.view.vertex_count), v);
        for (std::size_t c = 0; c < 3; ++c) {
            now.push_back(whole.view.positions[3 * v + c]);
            rest.push_back(whole.rest[3 * v + c]);
            velocities.push_back(whole.view.velocities[3 * v + c]);
        }
    }
    if (!alone) {
        const bool above = stroke.above((1.0 / static_cast<double>(part.old_vertex.size())) * sum);
        const Vec away = (above ? 1.0 : -1.0) * stroke.normal();
        for (std::size_t i = 0; i < now.size(); ++i) {
            now[i] += opening * away[i % 3];
            velocities[i] += opening_speed * away[i % 3];
        }
    }
    Body body = insert(play, {now, rest, velocities, part.tets, whole.kind, whole.origin});
    put_cut_faces_last(body, part.old_vertex, whole);
    return body;
}

} // namespace

namespace play {

Body insert(playground& play, const Shape& shape) {
    Body body;
    body.kind = shape.kind;
    body.serial = play.next_serial;
    const std::span<const double> rest = shape.rest.empty() ? shape.positions : shape.rest;
    body.rest.assign(rest.begin(), rest.end());
    body.tets.assign(shape.tets.begin(), shape.tets.end());
    body.origin = shape.origin ? shape.origin : body.serial;
    body.triangles = surface_of(body.tets, body.rest);
    body.uncut = body.triangles.size();
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.flags =
        (shape.kind == PLAY_FIXED ? std::uint32_t{VOX_SIM_BODY_FIXED} : 0u) |
        (play.self_collision && shape.kind != PLAY_FIXED ? std::uint32_t{VOX_SIM_BODY_SELF_COLLISION} : 0u);
    desc.positions = shape.positions.data();
    desc.rest_positions = body.rest.data();
    desc.velocities = shape.velocities.empty() ? nullptr : shape.velocities.data();
    desc.vertex_count = shape.positions.size() / 3;
    desc.tets = body.tets.data();
    desc.tet_count = body.tets.size() / 4;
    desc.youngs_modulus = desc.bulk_modulus = play.stiffness;
    desc.damping = 0.05;
    desc.user_data = body.serial;
    check(vox_sim_body_insert(play.sim.get(), &desc, &body.mesh));
    check(vox_sim_body_get_view(play.sim.get(), body.mesh, &body.view));
    ++play.next_serial;
    return body;
}

void remove(playground& play, const Body& body) {
    (void)vox_sim_body_remove(play.sim.get(), body.mesh);
    if (body.mesh == play.held_mesh) play_let_go(&play);
}

void part(playground& play) {
    if (play.touching_parts.empty()) return;
    vox_grid* made = nullptr;
    check(vox_grid_create(nullptr, &made));
    const Grid grid(made);
    for (const Body& body : play.bodies) {
        if (std::none_of(play.touching_parts.begin(), play.touching_parts.end(),
                         [&](const Parts& parts) { return parts.a == body.mesh || parts.b == body.mesh; }))
            continue;
        vox_mesh_desc mesh = vox_mesh_desc_floats(body.view.grid_positions, body.view.vertex_count,
                                                  body.tets.data(), body.tets.size() / 4);
        mesh.user_data = body.mesh;
        vox_body id;
        check(vox_mesh_insert(made, &mesh, &id));
    }
    check(vox_grid_step(made));
    vox_pair_view pairs;
    check(vox_grid_get_pairs(made, &pairs));
    std::erase_if(play.touching_parts, [&](const Parts& parts) {
        for (const vox_pair& pair : list(pairs.data, pairs.count))
            if (std::minmax(pair.user_data_a, pair.user_data_b) ==
                std::minmax<std::uint64_t>(parts.a, parts.b))
                return false;
        // One of them may be gone.
        (void)vox_grid_set_pair_enabled(play.grid, parts.a, parts.b, 1);
        return true;
    });
}

} // namespace play

vox_result play_cut(playground* play, const double eye[3], const double first[3], const double second[3],
                    uint32_t* out_cut) {
    return guard([&] {
        *out_cut = 0;
        const Stroke stroke({eye[0], eye[1], eye[2]}, {first[0], first[1], first[2]},
                            {second[0], second[1], second[2]});
        std::vector<Body> made;
        std::vector<vox_body> gone;
        std::vector<Parts> touching;
        try {
            for (const Body& body : play->bodies) {
                if (body.kind == PLAY_FIXED) continue;
                const std::span positions = list(body.view.positions, 3 * body.view.vertex_count);
                const std::vector<Part> parts = cut(body.tets, positions, stroke);
                if (parts.empty()) continue;
                gone.push_back(body.mesh);
                const std::size_t begin = made.size();
                for (const Part& part : parts) {
                    made.push_back(insert_part(*play, body, part, stroke, parts.size() == 1));
                    for (std::size_t i = begin; i + 1 < made.size(); ++i) {
                        check(vox_grid_set_pair_enabled(play->grid, made[i].mesh, made.back().mesh, 0));
                        touching.push_back({made[i].mesh, made.back().mesh});
                    }
                }
            }
        } catch (...) {
            for (const Body& body : made) remove(*play, body);
            throw;
        }
        if (gone.empty()) return;
        std::vector<Body> kept;
        for (Body& body : play->bodies) {
            if (std::find(gone.begin(), gone.end(), body.mesh) != gone.end())
                remove(*play, body);
            else
                kept.push_back(std::move(body));
        }
        kept.insert(kept.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
        play->bodies = std::move(kept);
        play->touching_parts.insert(play->touching_parts.end(), touching.begin(), touching.end());
        play->bodies_changed();
        *out_cut = static_cast<std::uint32_t>(gone.size());
    });
}
