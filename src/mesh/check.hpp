// Checks of a mesh description, before anything is computed from it, for vox_mesh_insert and
// vox_suggest_cell_size.
#pragma once

#include "base/error.hpp"
#include "base/positions.hpp"
#include "base/scene.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <string>

namespace vox {

enum class NullPositions : bool { rejected, allowed };

// Checks a description that read_struct() has completed and views it as a body (mesh_id 0; the caller sets
// it). Every error text starts with `where`, for example "mesh 1: ". Throws INVALID_ARGUMENT, INVALID_MESH,
// LIMIT. Does not read the positions: whether they are finite is checked when they are used.
Body check_mesh(const vox_mesh_desc& desc, const char* where, NullPositions null_positions);

// The name of a mesh in errors and the log: its id, slot and user data, if it has these.
std::string name_of(const Body& body);

// A failure that is about one mesh.
class MeshError : public Error {
public:
    MeshError(vox_result result, const Body& body, const std::string& text, std::uint32_t vertex = VOX_NONE)
        : Error(result, name_of(body) + text), mesh(body.mesh_id), vertex(vertex) {}

    std::uint32_t mesh, vertex;
};

// True if a coordinate is finite, and rounds to a finite float.
bool is_finite(const Body& body, std::uint32_t vertex) noexcept;

// The first vertex that is not; VOX_NONE if all are.
std::uint32_t first_bad_vertex(const Body& body) noexcept;

// Why a vertex is not: NON_FINITE, or LIMIT if its coordinates are finite.
vox_result bad_position(const Body& body, std::uint32_t vertex) noexcept;

// The error about such a vertex.
MeshError position_error(const Body& body, std::uint32_t vertex);

// Throws position_error() for the first bad vertex.
void check_finite(const Body& body);

// Throws MeshError with INVALID_ARGUMENT for positions that are read as floats but can only be doubles.
// Returns false if there are too few of them to tell.
bool check_not_doubles(const Body& body);

} // namespace vox
