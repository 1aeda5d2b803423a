// The determinant of three rows, of doubles or integers.
#pragma once

namespace vox::io {

// Products and sums are always taken in this order, so that the result is the same bit for bit everywhere.
template <class Row>
auto determinant(const Row& u, const Row& v, const Row& w) {
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

} // namespace vox::io
