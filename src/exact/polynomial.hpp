// Polynomials with integer coefficients, their real roots, and the signs of others there: exact, whatever the
// coefficients. Slow, so what doubles decide is not asked here. They use the heap.
#pragma once

#include "exact/integer.hpp"

#include <utility>
#include <vector>

namespace vox {

using Whole = IntegerIn<AnyWords>;

struct Ratio {
    Whole over, under; // this one is positive
};

// Coefficients from the constant one up, the last one not zero; none: zero.
using Polynomial = std::vector<Whole>;

Polynomial linear(const Whole& at_0, const Whole& at_1);
Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator-(const Polynomial& a, const Polynomial& b);
Polynomial operator*(const Polynomial& a, const Polynomial& b);
int sign_at(const Polynomial& f, const Ratio& x);

// A root in (0, 1], known as the only one of a polynomial between two numbers that are not roots of it. It is
// a simple one.
class Root {
public:
    Root(Polynomial f, Ratio low, Ratio high);
    int sign_of(const Polynomial& g) const; // at the root, for degrees up to 2
    double rounded() const;                 // to nearest

private:
    bool reached(const Ratio& x) const;

    Polynomial f_;
    Ratio low_, high_; // in the end neighbouring doubles, or closer
    int sign_after_;
    std::pair<double, double> around_; // neighbouring doubles
    bool is_high_ = false;             // the root is the upper one
};

// All different ones in (0, 1], ascending. f is not zero.
std::vector<Root> roots(const Polynomial& f);

// A root in [low, high], a part of [0, 1], rounded to nearest: after it, and nowhere before, f has the sign
// `sign_after` in the interval.
double rounded_root(const Polynomial& f, int sign_after, double low, double high);

} // namespace vox
