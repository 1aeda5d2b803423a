// Edges of meshes through the flat sides of shapes, and edges of shapes through faces of meshes.
#pragma once

#include "fast/step_scene.hpp"
#include "grid/surface_features.hpp"
#include "shape/shape.hpp"

#include <vox/vox.h>

#include <cstdint>

namespace vox {

// A contact of a mesh with a shape: of a vertex, an edge or a face.
struct ShapeContact {
    vox_body body_a;
    vox_body body_b; // the shape
    vox_constraint_kind kind;
    vox_depth_state state;
    std::uint32_t count; // vertices
    std::uint32_t element;
    std::uint32_t vertices[3];
    double weights[3];
    double gap, time;
    double normal[3];
};

// A mesh and a shape in one step.
struct ShapePair {
    const StepScene& scene;
    std::uint32_t body;
    const Body& shape_body;
    const RigidShape& shape;
    const ShapePlace& place;
    Box box; // of floats around the shape, less scene.origin
};

// Appends the contacts of edges, sorted by vertices and then by element; `features` are those of the mesh.
// Decided exactly for the places of vertices in the shape's frame.
void find_shape_edges(const ShapePair& pair, const SurfaceFeatures& features, Array<ShapeContact>& out);

} // namespace vox
