// Roots are counted by the sign changes of remainders (C. Sturm, 1829), and so is the sign of another
// polynomial at a root (A. Tarski): S. Basu, R. Pollack, M.-F. Roy, Algorithms in Real Algebraic Geometry,
// 2006, Sect. 2.2. Most intervals need no remainders, by the rule of Descartes on Bernstein coefficients.
#include "exact/polynomial.hpp"

#include <utility>

namespace vox {

namespace {

Whole whole(std::uint32_t value) {
    Whole result;
    result.size = value != 0;
    result.word()[0] = value;
    return result;
}

void trim(Polynomial& f) {
    while (!f.empty() && f.back().size == 0) f.pop_back();
}

Polynomial derivative(const Polynomial& f) {
    Polynomial result;
    for (std::size_t i = 1; i < f.size(); ++i) result.push_back(f[i] * whole(static_cast<std::uint32_t>(i)));
    return result;
}

// A positive multiple of -(f mod g), for g other than zero.
Polynomial minus_remainder(Polynomial f, const Polynomial& g) {
    Whole leading = g.back();
    leading.negative = false;
    while (f.size() >= g.size()) {
        Whole top = f.back();
        top.negative = top.negative != g.back().negative;
        const std::size_t shift = f.size() - g.size();
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = f[i] * leading;
        for (std::size_t i = 0; i < g.size(); ++i) f[shift + i] = f[shift + i] - top * g[i];
        trim(f);
    }
    for (Whole& c : f) c.negative = !c.negative;
    return f;
}

using Chain = std::vector<Polynomial>;

Chain remainders(const Polynomial& f, const Polynomial& g) {
    Chain chain{f};
    for (Polynomial next = g; !next.empty();) {
        chain.push_back(std::move(next));
        next = minus_remainder(chain[chain.size() - 2], chain.back());
    }
    return chain;
}

int sign_changes(const Chain& chain, const Dyadic& x) {
    int changes = 0, last = 0;
    for (const Polynomial& f : chain) {
        const int sign = sign_at(f, x);
        changes += sign * last < 0;
        if (sign != 0) last = sign;
    }
    return changes;
}

Dyadic middle(const Dyadic& a, const Dyadic& b, std::uint32_t of_a = 1, std::uint32_t of_b = 1,
              int powers = 1) {
    const int most = std::max(a.powers, b.powers);
    return {shifted_left(a.m, most - a.powers) * whole(of_a) +
                shifted_left(b.m, most - b.powers) * whole(of_b),
            most + powers};
}

bool is_before(const Dyadic& a, const Dyadic& b) {
    const int most = std::max(a.powers, b.powers);
    return (shifted_left(a.m, most - a.powers) - shifted_left(b.m, most - b.powers)).sign() < 0;
}

// How many times the Bernstein coefficients in [0, 1] change their sign, for degrees up to 3: as many roots
// in (0, 1) as that, or fewer by an even number.
int bernstein_changes(const Polynomial& f) {
    Polynomial c = f;
    c.resize(4);
    const Whole three = whole(3), two = whole(2);
    const int signs[4] = {c[0].sign(), (three * c[0] + c[1]).sign(),
                          (three * c[0] + two * c[1] + c[2]).sign(), (c[0] + c[1] + c[2] + c[3]).sign()};
    int changes = 0, last = 0;
    for (const int sign : signs) {
        changes += sign * last < 0;
        if (sign != 0) last = sign;
    }
    return changes;
}

} // namespace

Dyadic dyadic(double x) {
    const Parts of = parts(x);
    const int unit = std::min(of.exponent, 0);
    return {integer_of<AnyWords>(x, unit), -unit};
}

Polynomial linear(const Whole& at_0, const Whole& at_1) {
    Polynomial result{at_0, at_1 - at_0};
    trim(result);
    return result;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    Polynomial result = a.size() < b.size() ? b : a;
    const Polynomial& shorter = a.size() < b.size() ? a : b;
    for (std::size_t i = 0; i < shorter.size(); ++i) result[i] = result[i] + shorter[i];
    trim(result);
    return result;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    Polynomial result = a;
    result.resize(std::max(a.size(), b.size()));
    for (std::size_t i = 0; i < b.size(); ++i) result[i] = result[i] - b[i];
    trim(result);
    return result;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial result;
    if (a.empty() || b.empty()) return result;
    result.resize(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) result[i + j] = result[i + j] + a[i] * b[j];
    return result;
}

int sign_at(const Polynomial& f, const Dyadic& x) {
    if (f.empty()) return 0;
    Whole value = f.back();
    int powers = 0;
    for (std::size_t i = f.size() - 1; i-- > 0;) {
        powers += x.powers;
        value = value * x.m + shifted_left(f[i], powers);
    }
    return value.sign();
}

int Root::sign_of(const Polynomial& g) const {
    if (g.size() <= 1) return g.empty() ? 0 : g[0].sign();
    if (is_one_) return sign_at(g, dyadic(1));
    const Chain chain = remainders(f_, derivative(f_) * g);
    return sign_changes(chain, low_) - sign_changes(chain, high_);
}

namespace {

// The double nearest to a number in [low, high], the lower one of two. reached(x): whether x is not before
// it.
template <class Reached>
double nearest(double low, double high, const Reached& reached) {
    auto before = std::bit_cast<std::uint64_t>(low), after = std::bit_cast<std::uint64_t>(high);
    while (after - before > 1) {
        const std::uint64_t between = before + (after - before) / 2;
        (reached(dyadic(std::bit_cast<double>(between))) ? after : before) = between;
    }
    if (before == after) return low;
    const auto x = std::bit_cast<double>(before), y = std::bit_cast<double>(after);
    return reached(middle(dyadic(x), dyadic(y))) ? x : y;
}

} // namespace

double rounded_root(const Polynomial& f, int sign_after, double low, double high) {
    return nearest(low, high, [&](const Dyadic& x) { return sign_at(f, x) != -sign_after; });
}

double Root::rounded() const {
    if (is_one_) return 1;
    const int before = sign_at(f_, low_), after = sign_at(f_, high_);
    Chain chain; // for a root without a change of sign
    if (before == after) chain = remainders(f_, derivative(f_));
    const int changes = sign_changes(chain, low_);
    return nearest(0, 1, [&](const Dyadic& x) {
        if (is_before(x, low_)) return false;
        if (!is_before(x, high_)) return true;
        const int sign = sign_at(f_, x);
        return before != after ? sign != before : sign == 0 || sign_changes(chain, x) < changes;
    });
}

std::vector<Root> roots(const Polynomial& f) {
    std::vector<Root> found;
    Polynomial rest = f;
    while (rest[0].size == 0) rest.erase(rest.begin()); // roots at 0
    const Dyadic one = dyadic(1);
    bool at_one = false;
    for (; sign_at(rest, one) == 0; at_one = true) { // divide by t - 1
        for (std::size_t i = rest.size() - 1; i-- > 0;) rest[i] = rest[i] + rest[i + 1];
        rest.erase(rest.begin());
    }
    Root root;
    root.f_ = rest;
    const int changes = bernstein_changes(rest);
    if (changes == 1) {
        root.low_ = dyadic(0);
        root.high_ = one;
        found.push_back(root);
    } else if (changes > 1) {
        const Chain chain = remainders(rest, derivative(rest));
        std::vector<std::pair<Dyadic, Dyadic>> open{{dyadic(0), one}};
        while (!open.empty()) {
            auto [low, high] = open.back();
            open.pop_back();
            const int count = sign_changes(chain, low) - sign_changes(chain, high);
            if (count == 0) continue;
            root.low_ = low;
            root.high_ = high;
            if (count == 1) {
                found.push_back(root);
                continue;
            }
            Dyadic split = middle(low, high);
            for (std::uint32_t part = 3; sign_at(rest, split) == 0; ++part)
                split = middle(low, high, 16 - part, part, 4);
            open.push_back({split, high});
            open.push_back({low, split});
        }
    }
    if (at_one) {
        root.is_one_ = true;
        found.push_back(root);
    }
    return found;
}

} // namespace vox
