// Rational numbers (GMP), for tests that decide exactly.
#pragma once

#include <gmp.h>

namespace vox::test {

class Rational {
public:
    Rational() { mpq_init(value_); }
    Rational(double value) : Rational() { mpq_set_d(value_, value); }
    Rational(const Rational& other) : Rational() { mpq_set(value_, other.value_); }
    Rational& operator=(const Rational& other) {
        mpq_set(value_, other.value_);
        return *this;
    }
    ~Rational() { mpq_clear(value_); }

    int sign() const { return mpq_sgn(value_); }
    double rounded() const { return mpq_get_d(value_); }
    friend Rational operator+(const Rational& a, const Rational& b) { return of(mpq_add, a, b); }
    friend Rational operator-(const Rational& a, const Rational& b) { return of(mpq_sub, a, b); }
    friend Rational operator*(const Rational& a, const Rational& b) { return of(mpq_mul, a, b); }
    friend Rational operator/(const Rational& a, const Rational& b) { return of(mpq_div, a, b); }
    friend bool operator<(const Rational& a, const Rational& b) { return mpq_cmp(a.value_, b.value_) < 0; }

private:
    template <class Operation>
    static Rational of(Operation operation, const Rational& a, const Rational& b) {
        Rational result;
        operation(result.value_, a.value_, b.value_);
        return result;
    }

    mpq_t value_;
};

} // namespace vox::test
