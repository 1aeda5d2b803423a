// When a corner, a side or all of a triangle whose corners move linearly passes through a corner, an edge or
// a face that stands still. Whether it does is decided exactly.
//
// Let `origin` and the points that stand still span the still one, and the moving points the other one. Seen
// from the origin, the two have a point in common when the rows p_i(t) - origin are linearly dependent, with
// coefficients w_i of one sign for moving points, and of the other one for still points, and with a sum of
// the first sign, which is the origin's weight. For three rows that is a root of their determinant, a cubic,
// and the w_i are coordinates of their cross products.
#pragma once

#include "base/vectors.hpp"

#include <cstddef>

namespace vox {

struct ContactRows {
    Vec3d from[3], to[3]; // the moving points first
    std::size_t moving = 0, count = 0;
    Vec3d origin;

    void add_moving(const Vec3d& at_0, const Vec3d& at_1) {
        add_still(at_0);
        to[moving++] = at_1;
    }
    void add_still(const Vec3d& p) { from[count] = to[count] = p, ++count; }
};

struct FirstContact {
    enum Answer { none, found, unsure } answer = none;
    double t = 0, low = 0,
           high = 0;    // in [low, high]; if these are equal, t is the double nearest to the time
    int sign_after = 0; // of the determinant, else
};

// The sign that the determinant of three rows certainly has all the time; else 0.
int constant_side(const ContactRows& rows);

// In double. `unsure` if that does not decide; always, if there are not three rows.
FirstContact quick_contact(const ContactRows& rows);

// The first one in (0, 1]. `degenerate` is set if there may be contacts in which one of the two is less than
// these points span, or all points stay in one plane: such a contact is one of fewer points.
FirstContact exact_contact(const ContactRows& rows, bool& degenerate);

// The time of a contact that was found, rounded to nearest.
double exact_time(const ContactRows& rows, const FirstContact& contact);

// Weights of the rows at a time as above, up to a factor; their sum over moving points is not negative.
void contact_weights(const ContactRows& rows, double t, double (&weight)[3]);

} // namespace vox
