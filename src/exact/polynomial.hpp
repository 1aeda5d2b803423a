// Polynomials with integer coefficients, their real roots, and the signs of others there: exact, whatever the
// coefficients. Slow, so what doubles decide is not asked here. They use the heap.
#pragma once

#include "exact/integer.hpp"

#include <vector>

namespace vox {

using Whole = IntegerIn<AnyWords>;

// m / 2^powers
struct Dyadic {
    Whole m;
    int powers = 0;
};
Dyadic dyadic(double x); // x in [0, 1]

// Coefficients from the constant one up, the last one not zero; none: zero.
using Polynomial = std::vector<Whole>;

Polynomial linear(const Whole& at_0, const Whole& at_1);
Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator-(const Polynomial& a, const Polynomial& b);
Polynomial operator*(const Polynomial& a, const Polynomial& b);
int sign_at(const Polynomial& f, const Dyadic& x);

// A root of a polynomial in (0, 1], known by an interval around it that has no other root.
class Root {
public:
    // The sign of g at the root.
    int sign_of(const Polynomial& g) const;
    double rounded() const; // to nearest

private:
    friend std::vector<Root> roots(const Polynomial& f);

    Polynomial f_; // without roots at the ends of the interval
    Dyadic low_, high_;
    bool is_one_ = false; // the root is 1, and f_ unused
};

// All different ones in (0, 1], ascending. f is not zero.
std::vector<Root> roots(const Polynomial& f);

// A root in [low, high], a part of [0, 1], rounded to nearest: after it, and nowhere before, f has the sign
// `sign_after` in the interval.
double rounded_root(const Polynomial& f, int sign_after, double low, double high);

} // namespace vox
