// Edges of meshes through the flat sides of shapes, and edges of shapes through faces of meshes.
#pragma once

#include "fast/step_scene.hpp"
#include "grid/surface_features.hpp"
#include "shape/shape.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

// A contact of an edge of a mesh with a triangle of a shape, or of a face with an edge.
struct ShapeEdge {
    std::uint32_t count; // vertices
    std::uint32_t element;
    std::uint32_t edge; // of the shape, if it is one; for the order alone
    std::uint32_t vertices[3];
    vox_depth_state state;
    double weights[3];
    double gap;
    double normal[3];
};

// Where an edge, of the mesh or of the shape, passes through a triangle of the other.
struct ShapeCrossing {
    std::array<std::uint32_t, 2> edge;     // of the shape: its number and 0
    std::array<std::uint32_t, 3> vertices; // of the face, if it is the mesh's
    std::uint32_t element;
    double at; // from 0 to 1 along the edge
    std::array<double, 3> face_weights;
    bool is_through;
    Vec3d from, to;       // of the edge
    Vec3d corner, normal; // of the triangle, out of what it belongs to
};

// What searches have found; kept from step to step.
struct ShapeCrossings {
    explicit ShapeCrossings(std::pmr::memory_resource* memory) noexcept
        : of_one_search(memory), of_shape(memory), of_mesh(memory) {}

    Array<ShapeCrossing> of_one_search; // the last one
    Array<ShapeCrossing> of_shape;      // of edges of shapes
    Array<ShapeEdge> of_mesh;           // contacts of edges of meshes
};

// A mesh and a shape in one step.
struct ShapePair {
    const StepScene& scene;
    std::uint32_t body;
    const RigidShape& shape;
    const ShapePlace& place;
    Box box; // of floats around the shape, less scene.origin
};

// Searches tiles [first, last) of the mesh, of which `features` are, and appends what it finds. Decided
// exactly for the places of vertices in the shape's frame.
void find_shape_edges(const ShapePair& pair, const SurfaceFeatures& features, std::size_t first,
                      std::size_t last, ShapeCrossings& out);

// Sorts contacts [first, end) of a pair, all those of edges of the mesh, by vertices and then by element,
// together with those of all edges of the shape, which pass through faces at `crossings`.
void join_shape_edges(const ShapePair& pair, Array<ShapeCrossing>& crossings, std::size_t first,
                      Array<ShapeEdge>& contacts);

} // namespace vox
