#include "exact/first_contact.hpp"

#include "exact/polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vox {

namespace {

double coordinate(const Vec3d& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// ---- in double ------------------------------------------------------------------------------------

// Rows relative to the origin, and bounds of their coordinates and of how much these change.
struct SeenRows {
    Vec3d from[3], to[3];
    double most[3], change[3];

    explicit SeenRows(const ContactRows& rows) {
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = rows.from[i] - rows.origin;
            to[i] = rows.to[i] - rows.origin;
            most[i] = std::max(largest_coordinate(from[i]), largest_coordinate(to[i]));
            change[i] = largest_coordinate(to[i] - from[i]);
        }
    }
    Vec3d at(std::size_t i, double t) const { return (1 - t) * from[i] + t * to[i]; }

    // By how much a Bernstein coefficient of the determinant, or a value computed from these by dividing the
    // interval at most seven times, may be off. A coefficient is at most 6 times the product, and off by 16
    // roundings of that, a division by 9 more.
    double determinant_error() const { return 0x1p-43 * most[0] * most[1] * most[2] + 0x1p-900; }
};

// A cubic polynomial by its Bernstein coefficients.
using Bernstein = std::array<double, 4>;

Bernstein determinant_of(const SeenRows& rows) {
    const auto of = [&rows](int ends) { // bit i: row i at its end
        const auto row = [&](int i) { return (ends >> i & 1) != 0 ? rows.to[i] : rows.from[i]; };
        return determinant(row(0), row(1), row(2));
    };
    return {of(0), (of(1) + of(2) + of(4)) / 3, (of(6) + of(5) + of(3)) / 3, of(7)};
}

// Splits the interval at u, and returns the value there.
double split(const Bernstein& c, double u, Bernstein& below, Bernstein& above) {
    const auto mix = [u](double x, double y) { return (1 - u) * x + u * y; };
    const double a = mix(c[0], c[1]), b = mix(c[1], c[2]), d = mix(c[2], c[3]);
    const double ab = mix(a, b), bd = mix(b, d), value = mix(ab, bd);
    below = {c[0], a, ab, value};
    above = {value, bd, d, c[3]};
    return value;
}

struct RootsInDouble {
    FirstContact at[3];
    std::size_t count = 0;
    bool unsure = false;

    // The roots between two times, where c are the coefficients.
    void find(const Bernstein& c, double error, double begin, double end, int divisions) {
        const auto [least, most] = std::minmax_element(c.begin(), c.end());
        if (*least > error || *most < -error) return;
        const double step[3] = {c[1] - c[0], c[2] - c[1], c[3] - c[2]};
        const double up = std::min({step[0], step[1], step[2]}),
                     down = -std::max({step[0], step[1], step[2]}), slope = std::max(up, down) - 3 * error;
        if (slope > 0) {
            const double first = up > down ? c[0] : -c[0], last = up > down ? c[3] : -c[3];
            if (!(first < -error && last > error) || count == 3)
                unsure = true;
            else
                add(c, error, begin, end, 3 * slope, up > down ? 1 : -1);
            return;
        }
        unsure = unsure || divisions == 0;
        if (unsure) return;
        Bernstein below, above;
        constexpr double at = 0.46875; // few roots are there
        split(c, at, below, above);
        const double between = begin + at * (end - begin);
        find(below, error, begin, between, divisions - 1);
        find(above, error, between, end, divisions - 1);
    }

private:
    // The root where the derivative is at least `slope` or at most -slope.
    void add(const Bernstein& c, double error, double begin, double end, double slope, int sign_after) {
        Bernstein below, above;
        double u = c[0] / (c[0] - c[3]), value = split(c, u, below, above);
        for (int i = 0; i < 6 && std::abs(value) > error; ++i) {
            u = std::clamp(u - value / (3 * (above[1] - below[2])), 0.0, 1.0);
            value = split(c, u, below, above);
        }
        const double reach = (std::abs(value) + error) / slope + 0x1p-50;
        const double t = begin + u * (end - begin), around = reach * (end - begin) + 0x1p-51;
        at[count++] = {FirstContact::found, t, std::max(begin, t - around), std::min(end, t + around),
                       sign_after};
    }
};

// Whether the weights at a root are of the right signs.
FirstContact::Answer weigh(const SeenRows& rows, std::size_t moving, const FirstContact& root) {
    const double spread = root.high - root.low;
    const Vec3d row[3] = {rows.at(0, root.t), rows.at(1, root.t), rows.at(2, root.t)};
    Vec3d weight[3], sum{}, sum_of_moving{};
    double error[3], sum_error = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        weight[i] = cross(row[j], row[k]);
        error[i] = 0x1p-46 * rows.most[j] * rows.most[k] + 0x1p-900 +
                   3 * spread * (rows.change[j] * rows.most[k] + rows.most[j] * rows.change[k]);
        sum = sum + weight[i];
        sum_error += error[i];
        if (i < moving) sum_of_moving = sum_of_moving + weight[i];
    }
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(coordinate(sum_of_moving, i)) > std::abs(coordinate(sum_of_moving, axis))) axis = i;
    const double whole = coordinate(sum_of_moving, axis);
    if (!(std::abs(whole) > sum_error)) return FirstContact::unsure;
    FirstContact::Answer answer = FirstContact::found;
    const auto check = [&](double value, double its_error) {
        if (whole < 0) value = -value;
        if (value < -its_error) answer = FirstContact::none;
        if (!(value > its_error) && answer == FirstContact::found) answer = FirstContact::unsure;
    };
    for (std::size_t i = 0; i < 3; ++i)
        check(i < moving ? coordinate(weight[i], axis) : -coordinate(weight[i], axis), error[i]);
    check(coordinate(sum, axis), sum_error);
    return answer;
}

} // namespace

int constant_side(const ContactRows& rows) {
    const SeenRows seen(rows);
    const Bernstein c = determinant_of(seen);
    const auto [least, most] = std::minmax_element(c.begin(), c.end());
    const double error = seen.determinant_error();
    return *least > error ? 1 : *most < -error ? -1 : 0;
}

FirstContact quick_contact(const ContactRows& rows) {
    FirstContact contact;
    contact.answer = FirstContact::unsure;
    if (rows.count != 3) return contact;
    const SeenRows seen(rows);
    RootsInDouble roots;
    roots.find(determinant_of(seen), seen.determinant_error(), 0, 1, 6);
    if (roots.unsure) return contact;
    for (std::size_t i = 0; i < roots.count; ++i) {
        const FirstContact::Answer answer = weigh(seen, rows.moving, roots.at[i]);
        if (answer == FirstContact::found) return roots.at[i];
        if (answer == FirstContact::unsure) return contact;
    }
    return {};
}

void contact_weights(const ContactRows& rows, double t, double (&weight)[3]) {
    const SeenRows seen(rows);
    const Vec3d row[3] = {seen.at(0, t), seen.at(1, t), seen.at(2, t)};
    Vec3d products[3], sum_of_moving{};
    for (std::size_t i = 0; i < 3; ++i) {
        products[i] = cross(row[(i + 1) % 3], row[(i + 2) % 3]);
        if (i < rows.moving) sum_of_moving = sum_of_moving + products[i];
    }
    for (std::size_t i = 0; i < 3; ++i) weight[i] = dot(products[i], sum_of_moving);
}

// ---- exactly --------------------------------------------------------------------------------------

namespace {

using MovingPoint = std::array<Polynomial, 3>;

// The rows in units of the largest power of two that divides all coordinates.
std::array<MovingPoint, 3> moving_rows(const ContactRows& rows) {
    int unit = 1024;
    const auto look = [&unit](const Vec3d& p) {
        for (const double value : {p.x, p.y, p.z})
            if (const Parts from = parts(value); from.mantissa != 0) unit = std::min(unit, from.exponent);
    };
    look(rows.origin);
    for (std::size_t i = 0; i < rows.count; ++i) {
        look(rows.from[i]);
        look(rows.to[i]);
    }
    std::array<MovingPoint, 3> result;
    for (std::size_t i = 0; i < rows.count; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto whole = [&](const Vec3d& p) {
                return integer_of<AnyWords>(coordinate(p, axis), unit);
            };
            const Whole origin = whole(rows.origin);
            result[i][axis] = linear(whole(rows.from[i]) - origin, whole(rows.to[i]) - origin);
        }
    return result;
}

Polynomial minor_of(const MovingPoint& u, const MovingPoint& v, std::size_t axis) {
    const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
    return u[j] * v[k] - u[k] * v[j];
}

// The coefficients of a dependence, by one coordinate.
std::array<Polynomial, 3> weights_by(const std::array<MovingPoint, 3>& row, std::size_t count,
                                     std::size_t axis) {
    if (count == 2) return {row[1][axis], Polynomial{} - row[0][axis], Polynomial{}};
    return {minor_of(row[1], row[2], axis), minor_of(row[2], row[0], axis), minor_of(row[0], row[1], axis)};
}

// Polynomials that are all zero exactly when the rows are dependent.
std::vector<Polynomial> dependence(const std::array<MovingPoint, 3>& row, std::size_t count) {
    if (count == 1) return {row[0].begin(), row[0].end()};
    std::vector<Polynomial> all;
    for (std::size_t axis = 0; axis < 3; ++axis) all.push_back(minor_of(row[0], row[1], axis));
    if (count == 2) return all;
    return {all[0] * row[2][0] + all[1] * row[2][1] + all[2] * row[2][2]};
}

// Whether the two meet at a time when the rows are dependent.
bool meets_at(const Root& root, const std::array<MovingPoint, 3>& row, const ContactRows& rows,
              bool& degenerate) {
    if (rows.count == 1) return true;
    bool is_degenerate = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto weight = weights_by(row, rows.count, axis);
        Polynomial sum_of_moving;
        for (std::size_t i = 0; i < rows.moving; ++i) sum_of_moving = sum_of_moving + weight[i];
        const int side = root.sign_of(sum_of_moving);
        if (side == 0) continue;
        is_degenerate = false;
        bool meets = side * root.sign_of(weight[0] + weight[1] + weight[2]) >= 0;
        for (std::size_t i = 0; i < rows.count && meets; ++i)
            meets = (i < rows.moving ? side : -side) * root.sign_of(weight[i]) >= 0;
        if (meets) return true;
        break; // seen along this axis, no two points are one
    }
    degenerate |= is_degenerate;
    return false;
}

} // namespace

FirstContact exact_contact(const ContactRows& rows, bool& degenerate) {
    const auto row = moving_rows(rows);
    const std::vector<Polynomial> all = dependence(row, rows.count);
    const auto first = std::find_if(all.begin(), all.end(), [](const Polynomial& f) { return !f.empty(); });
    FirstContact contact;
    if (first == all.end()) return degenerate = true, contact;
    for (const Root& root : roots(*first)) {
        const bool dependent =
            std::all_of(first + 1, all.end(), [&](const Polynomial& f) { return root.sign_of(f) == 0; });
        if (!dependent || !meets_at(root, row, rows, degenerate)) continue;
        contact.answer = FirstContact::found;
        contact.t = contact.low = contact.high = root.rounded();
        return contact;
    }
    return contact;
}

double exact_time(const ContactRows& rows, const FirstContact& contact) {
    if (contact.sign_after == 0) return contact.t;
    return rounded_root(dependence(moving_rows(rows), 3)[0], contact.sign_after, contact.low, contact.high);
}

} // namespace vox
