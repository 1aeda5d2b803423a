// Edges of meshes through the flat sides of shapes, and edges of shapes through faces of meshes.
#pragma once

#include "fast/step_scene.hpp"
#include "grid/surface_features.hpp"
#include "shape/shape.hpp"

#include <vox/vox.h>

#include <cstdint>

namespace vox {

// A contact of an edge of a mesh with a triangle of a shape, or of a face with an edge.
struct ShapeEdge {
    std::uint32_t count; // vertices
    std::uint32_t element;
    std::uint32_t vertices[3];
    vox_depth_state state;
    double weights[3];
    double gap;
    double normal[3];
};

// A mesh and a shape in one step.
struct ShapePair {
    const StepScene& scene;
    std::uint32_t body;
    const RigidShape& shape;
    const ShapePlace& place;
    Box box; // of floats around the shape, less scene.origin
};

// Appends the contacts of edges, sorted by vertices and then by element; `features` are those of the mesh.
// Decided exactly for the places of vertices in the shape's frame.
void find_shape_edges(const ShapePair& pair, const SurfaceFeatures& features, Array<ShapeEdge>& out);

} // namespace vox
