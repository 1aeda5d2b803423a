// The sign of another polynomial at a root is a Cauchy index, which the sign changes of remainders give
// (C. Sturm, 1829): S. Basu, R. Pollack, M.-F. Roy, Algorithms in Real Algebraic Geometry, 2006, Sect. 2.2.
// Most need no remainders, by the rule of Descartes on Bernstein coefficients.
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
        Whole top = std::move(f.back());
        top.negative = top.negative != g.back().negative;
        f.pop_back(); // the rest cancels it
        const std::size_t shift = f.size() + 1 - g.size();
        for (Whole& c : f) c = c * leading;
        for (std::size_t i = 0; i + 1 < g.size(); ++i) f[shift + i] = f[shift + i] - top * g[i];
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

int sign_changes(const Chain& chain, const Ratio& x) {
    int changes = 0, last = 0;
    for (const Polynomial& f : chain) {
        const int sign = sign_at(f, x);
        changes += sign * last < 0;
        if (sign != 0) last = sign;
    }
    return changes;
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

int sign_at(const Polynomial& f, const Ratio& x) {
    if (f.empty()) return 0;
    Whole value = f.back(), power = x.under;
    for (std::size_t i = f.size() - 1; i-- > 0;) {
        value = value * x.over + power * f[i];
        if (i > 0) power = power * x.under;
    }
    return value.sign();
}

namespace {

Ratio ratio(double x) { // in [0, 1]
    const int unit = std::min(parts(x).exponent, 0);
    return {integer_of<AnyWords>(x, unit), integer_of<AnyWords>(1, unit)};
}

int compare(const Ratio& a, const Ratio& b) { return (a.over * b.under - b.over * a.under).sign(); }

using Neighbours = std::pair<double, double>;

// The doubles before and after a number in [low, high]. reached(x): whether x is not before it.
template <class Reached>
Neighbours neighbours(double low, double high, const Reached& reached) {
    auto before = std::bit_cast<std::uint64_t>(low), after = std::bit_cast<std::uint64_t>(high);
    while (after - before > 1) {
        const std::uint64_t between = before + (after - before) / 2;
        (reached(ratio(std::bit_cast<double>(between))) ? after : before) = between;
    }
    return {std::bit_cast<double>(before), std::bit_cast<double>(after)};
}

// The one of them that is nearer, the lower one of two.
template <class Reached>
double nearest(const Neighbours& of, const Reached& reached) {
    if (of.first == of.second) return of.first;
    const Ratio x = ratio(of.first), y = ratio(of.second);
    return reached({x.over * y.under + y.over * x.under, whole(2) * x.under * y.under}) ? of.first
                                                                                        : of.second;
}

// Points in (0, 1), ascending, that divide the roots of a polynomial of degree 3 or less: each multiple root
// is one of them, and no two others are neighbours. The inflection of a cubic f is between its outermost
// roots, as their mean. f = q * f' + r, where q is zero there; so r has different signs at two roots on one
// side of it, and is zero at a multiple root.
std::vector<Ratio> dividing_points(const Polynomial& f) {
    std::vector<Ratio> points;
    const auto add_root_of = [&points](const Polynomial& line) {
        if (line.size() != 2) return;
        Ratio x{line[0], line[1]};
        x.over.negative = x.over.negative == x.under.negative;
        x.under.negative = false;
        if (x.over.sign() > 0 && smaller_magnitude(x.over, x.under)) points.push_back(x);
    };
    const Polynomial slope = derivative(f);
    add_root_of(f.size() == 4 ? derivative(slope) : slope);
    if (f.size() == 4) add_root_of(minus_remainder(f, slope));
    if (points.size() == 2 && compare(points[0], points[1]) > 0) std::swap(points[0], points[1]);
    return points;
}

// Divides by all factors that have the root x. Whether there are any.
bool divide_out(Polynomial& f, const Ratio& x) {
    bool is_root = false;
    for (; sign_at(f, x) == 0; is_root = true) {
        Polynomial quotient(f.size() - 1);
        Whole sum = f.back(), power = whole(1);
        for (std::size_t i = quotient.size(); i-- > 0;) {
            quotient[i] = sum;
            power = power * x.under;
            sum = sum * x.over + f[i] * power;
        }
        power = whole(1);
        for (Whole& c : quotient) {
            c = c * power;
            power = power * x.under;
        }
        f = std::move(quotient);
    }
    return is_root;
}

} // namespace

double rounded_root(const Polynomial& f, int sign_after, double low, double high) {
    const auto reached = [&](const Ratio& x) { return sign_at(f, x) != -sign_after; };
    return nearest(neighbours(low, high, reached), reached);
}

Root::Root(Polynomial f, Ratio low, Ratio high)
    : f_(std::move(f)), low_(std::move(low)), high_(std::move(high)), sign_after_(sign_at(f_, high_)),
      around_(neighbours(0, 1, [this](const Ratio& x) { return reached(x); })) {
    const Ratio before = ratio(around_.first), after = ratio(around_.second);
    if (compare(before, low_) > 0) low_ = before;
    if (compare(after, high_) < 0) high_ = after;
    is_high_ = sign_at(f_, high_) == 0;
}

bool Root::reached(const Ratio& x) const {
    return compare(x, low_) > 0 && (compare(x, high_) >= 0 || sign_at(f_, x) != -sign_after_);
}

double Root::rounded() const {
    return is_high_ ? around_.second : nearest(around_, [this](const Ratio& x) { return reached(x); });
}

int Root::sign_of(const Polynomial& g) const {
    if (g.size() <= 1) return g.empty() ? 0 : g[0].sign();
    const int sign = sign_at(g, high_);
    if (is_high_) return sign;
    if (sign != 0 && sign == sign_at(g, low_)) {
        if (g.size() == 2) return sign;
        const Whole sum = low_.over * high_.under + high_.over * low_.under;
        const Whole between = whole(2) * (low_.under * high_.under * g[0] + low_.over * high_.over * g[2]);
        if (sign == (between + sum * g[1]).sign()) return sign;
    }
    const Chain chain = remainders(f_, g);
    return (sign_changes(chain, low_) - sign_changes(chain, high_)) * sign_after_;
}

std::vector<Root> roots(const Polynomial& f) {
    Polynomial rest = f;
    while (rest[0].size == 0) rest.erase(rest.begin()); // roots at 0
    const Ratio zero{whole(0), whole(1)}, one{whole(1), whole(1)}, two{whole(2), whole(1)};
    std::vector<Ratio> ends;
    if (bernstein_changes(rest) > 1) ends = dividing_points(rest);
    ends.push_back(one);
    std::vector<bool> is_root;
    for (const Ratio& end : ends) is_root.push_back(divide_out(rest, end));
    std::vector<Root> found;
    const Ratio* low = &zero;
    int sign_at_low = rest[0].sign();
    for (std::size_t i = 0; i < ends.size(); low = &ends[i++]) {
        const int sign_at_end = sign_at(rest, ends[i]);
        if (sign_at_end != sign_at_low) found.push_back({rest, *low, ends[i]});
        if (is_root[i]) found.push_back({{whole(0) - ends[i].over, ends[i].under}, zero, two});
        sign_at_low = sign_at_end;
    }
    return found;
}

} // namespace vox
