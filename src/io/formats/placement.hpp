// Where a node of a scene puts what it shows.
#pragma once

#include "io/determinant.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {

struct Placement { // 3 x 4
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    Placement of(const Placement& child) const {
        Placement out;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) {
                out.m[i][j] = j == 3 ? m[i][3] : 0;
                for (int k = 0; k < 3; ++k) out.m[i][j] += m[i][k] * child.m[k][j];
            }
        return out;
    }
    void apply(const double p[3], double out[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
    }
    // By rows of length 1 or so, whose determinant is a double however small they were.
    bool mirrors() const {
        double rows[3][3];
        for (int i = 0; i < 3; ++i) {
            const double largest = std::max({std::fabs(m[i][0]), std::fabs(m[i][1]), std::fabs(m[i][2])});
            for (int k = 0; k < 3; ++k) rows[i][k] = m[i][k] / largest;
        }
        return determinant(rows[0], rows[1], rows[2]) < 0;
    }
};

} // namespace vox::io
