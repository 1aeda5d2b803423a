// A tool in the visitor's hand: a sphere that pushes bodies, or a blade that shows the edges it crosses.
#include "playground.hpp"

#include <algorithm>
#include <cmath>

namespace play {

namespace {

constexpr double radius = 0.6, half_width = 0.9, half_height = 0.9; // of the sphere, and of the blade
constexpr double fastest = 0.1;                                     // way of a step

vox_body insert_tool(vox_grid* grid, std::uint32_t kind) {
    constexpr double corners[12] = {-half_width, 0, -half_height, half_width,  0, -half_height,
                                    half_width,  0, half_height,  -half_width, 0, half_height};
    constexpr std::uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    vox_shape_desc desc = vox_default_shape_desc();
    desc.kind = kind == PLAY_BLADE ? VOX_SHAPE_SHEET : VOX_SHAPE_SPHERE;
    if (kind == PLAY_BLADE) {
        desc.positions = vox_double_positions(corners, 4);
        desc.triangles = triangles;
        desc.triangle_count = 2;
    } else {
        desc.radius = radius;
    }
    vox_body made = VOX_NULL_BODY;
    check(vox_shape_insert(grid, &desc, &made));
    return made;
}

void place(playground& play) {
    const auto& [x, y, z] = play.tool.at;
    const auto [c, s] = play.tool.along;
    const double matrix[12] = {c, -s, 0, x, s, c, 0, y, 0, 0, 1, z};
    check(vox_body_set_transform(play.grid, play.tool.shape, matrix));
}

} // namespace

void take_tool(playground& play, const Tool& tool) {
    // Edges take time, so only a blade has them looked for.
    const std::uint32_t edges = tool.kind == PLAY_BLADE ? VOX_GRID_EDGES : 0;
    check(vox_grid_set_flags(play.grid, VOX_GRID_CONSTRAINTS | edges));
    const vox_body before = play.tool.shape;
    const vox_body made = tool.kind == PLAY_NO_TOOL ? VOX_NULL_BODY : insert_tool(play.grid, tool.kind);
    play.tool = tool;
    play.tool.shape = made;
    if (made != VOX_NULL_BODY) place(play);
    if (vox_body_is_valid(play.grid, before)) check(vox_body_remove(play.grid, before));
}

void move_tool(playground& play) {
    if (play.tool.kind == PLAY_NO_TOOL) return;
    const Vec way = play.tool.target - play.tool.at;
    const double length = std::sqrt(dot(way, way));
    play.tool.at = play.tool.at + std::min(1.0, fastest / std::max(length, fastest)) * way;
    place(play);
}

} // namespace play

using namespace play;

vox_result play_hold(playground* play, uint32_t kind, const double point[3], const double along[2]) {
    return guard([&] {
        if (kind > PLAY_BLADE)
            fail(VOX_ERROR_INVALID_ARGUMENT, "there is no tool of kind " + std::to_string(kind));
        const double length = std::sqrt(along[0] * along[0] + along[1] * along[1]);
        Tool tool = play->tool;
        for (int axis = 0; axis < 3; ++axis)
            tool.target[axis] = std::isfinite(point[axis]) ? std::clamp(point[axis], -20.0, 20.0) : 0;
        tool.target[2] = std::max(tool.target[2], 0.0);
        tool.along = {1, 0};
        if (length > 0 && std::isfinite(length)) tool.along = {along[0] / length, along[1] / length};
        if (kind != tool.kind) {
            tool.kind = kind;
            tool.at = tool.target;
            take_tool(*play, tool);
        } else {
            play->tool = tool;
        }
        play->was_touched();
    });
}

const float* play_touched(playground* play, uint32_t* out_count) {
    std::vector<float>& lines = play->touched;
    lines.clear();
    for (const vox_constraint& c : constraints_of(*play)) {
        if (c.body_b != play->tool.shape || c.kind != VOX_CONSTRAINT_EDGE) continue;
        const auto body = std::find_if(play->bodies.begin(), play->bodies.end(),
                                       [&](const Body& one) { return one.mesh == c.body_a; });
        if (body == play->bodies.end()) continue; // removed since the step
        // An edge, or the sides of a face.
        for (std::uint32_t i = 0; i + 1 < c.count || (i + 1 == c.count && c.count == 3); ++i)
            for (const std::uint32_t v : {c.vertices[i], c.vertices[(i + 1) % c.count]}) {
                const float* at = body->view.grid_positions + 3 * std::size_t{v};
                lines.insert(lines.end(), at, at + 3);
            }
    }
    *out_count = static_cast<std::uint32_t>(lines.size() / 6);
    return lines.data();
}
