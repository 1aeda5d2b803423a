// The exact sign of a tetrahedron's volume, over the whole range of finite doubles.
#pragma once

namespace vox::io {

// Sign (-1, 0, +1) of det[b-a, c-a, d-a], as if computed in infinite precision. Coordinates must be finite.
int volume_sign(const double* a, const double* b, const double* c, const double* d);

} // namespace vox::io
