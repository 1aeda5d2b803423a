// Checks of a mesh description, before anything is computed from it, for vox_mesh_insert and
// vox_suggest_cell_size.
#pragma once

#include "base/scene.hpp"

#include <vox/vox.h>

namespace vox {

enum class NullPositions : bool { rejected, allowed };

// Checks a description that read_struct() has completed and views it as a body (mesh_id 0; the caller sets
// it). `where` starts every error text: "" or e.g. "mesh 1: ". Throws Error: INVALID_ARGUMENT, INVALID_MESH,
// LIMIT. The positions are not looked at: whether they are finite is known only when they are used.
Body check_mesh(const vox_mesh_desc& desc, const char* where, NullPositions null_positions);

// Checks a byte stride of the caller, where 0 means tightly packed, and returns it as a number of bytes.
std::size_t check_stride(std::uint64_t byte_stride, vox_format format, std::uint64_t vertex_count,
                         const char* where);

// Throws INVALID_ARGUMENT for a format that this version does not know.
void check_format(const vox_format& format, const char* where);

// Throws NON_FINITE naming the mesh and the first vertex whose position is not finite, LIMIT when it is
// finite but rounds to no finite float.
void check_finite(const Body& body);

// The same for one vertex.
void check_finite(const Body& body, std::uint32_t vertex);

} // namespace vox
