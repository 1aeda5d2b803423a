// Barycentric coordinates as floats, the same as accurate.hpp's doubles rounded to floats: in doubles, where
// their error does not matter for that, or else by numbers of twice the digits of a double
// (double_double-inl.hpp, operation by operation). For the kernels of src/gpu, one point at a time.
#pragma once

#include "base/device.hpp"
#include "exact/predicates.hpp"

#include <array>

namespace vox {

struct TwoDoubles {
    double high, low;
};

VOX_HD TwoDoubles exact_sum(double a, double b) {
    const double sum = a + b, part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}
VOX_HD TwoDoubles joined(double a, double b) { // |a| >= |b|
    const double sum = a + b;
    return {sum, b - (sum - a)};
}
VOX_HD TwoDoubles exact_product(double a, double b) {
    const double splitter = 134217729.0, product = a * b; // 2^27 + 1
    const double of_a = splitter * a, of_b = splitter * b;
    const double a1 = of_a - (of_a - a), a2 = a - a1, b1 = of_b - (of_b - b), b2 = b - b1;
    return {product, (((a1 * b1 - product) + a1 * b2) + a2 * b1) + a2 * b2};
}
VOX_HD TwoDoubles operator+(const TwoDoubles& a, const TwoDoubles& b) {
    const TwoDoubles high = exact_sum(a.high, b.high);
    return joined(high.high, high.low + (a.low + b.low));
}
VOX_HD TwoDoubles operator-(const TwoDoubles& a) { return {-a.high, -a.low}; }
VOX_HD TwoDoubles operator-(const TwoDoubles& a, const TwoDoubles& b) { return a + -b; }
VOX_HD TwoDoubles operator*(const TwoDoubles& a, const TwoDoubles& b) {
    const TwoDoubles high = exact_product(a.high, b.high);
    return joined(high.high, high.low + (a.high * b.low + a.low * b.high));
}
VOX_HD TwoDoubles operator/(const TwoDoubles& a, const TwoDoubles& b) {
    const double first = a.high / b.high;
    const TwoDoubles rest = a - b * TwoDoubles{first, 0};
    return joined(first, rest.high / b.high);
}

struct TwoDoublesPoint {
    TwoDoubles x, y, z;
};
VOX_HD TwoDoublesPoint exact_difference(const Vec3d& to, const Vec3d& from) {
    return {exact_sum(to.x, -from.x), exact_sum(to.y, -from.y), exact_sum(to.z, -from.z)};
}

// det[u, v, w], expanded like determinant(); `most` becomes at least the sum of the terms' magnitudes.
VOX_HD TwoDoubles accurate_determinant(const TwoDoublesPoint& u, const TwoDoublesPoint& v,
                                       const TwoDoublesPoint& w, double& most) {
    const auto size = [](const TwoDoubles& a) { return a.high < 0 ? -a.high : a.high; };
    TwoDoubles sum{0, 0};
    double permanent = 0;
    const auto add = [&](const TwoDoubles& z, const TwoDoublesPoint& a, const TwoDoublesPoint& b,
                         bool negative) {
        const TwoDoubles left = a.x * b.y, right = b.x * a.y, term = z * (left - right);
        permanent += size(z) * (size(left) + size(right));
        sum = sum + (negative ? -term : term);
    };
    add(u.z, v, w, false);
    add(v.z, u, w, true);
    add(w.z, u, v, false);
    most = permanent > most ? permanent : most;
    return sum;
}

VOX_HD float clamped_float(double weight) {
    return weight > 0 ? static_cast<float>(weight < 1.0 ? weight : 1.0) : 0.0f;
}

// False if the roundings of doubles may change a float; the weights are unspecified then. Of each volume the
// error is known, of their sum the sum of these and a few roundings.
VOX_HD bool weigh_in_doubles(const std::array<BoundedVolume, 4>& volumes, float* weights) {
    double total = 0, error = 0;
    for (const BoundedVolume& v : volumes) {
        total += v.volume;
        error += v.error;
    }
    const double size = total < 0 ? -total : total, off = 2 * (error / size) + 0x1p-49;
    bool certain = size > 0x1p-800 && off < 0x1p-20;
    for (int i = 0; i < 4; ++i) {
        const double weight = volumes[static_cast<std::size_t>(i)].volume / total;
        const float low = clamped_float(weight - off);
        certain = certain && low == clamped_float(weight + off);
        weights[i] = low;
    }
    return certain;
}

// The weights of point p in the closed tetrahedron of corner(0) to corner(3). False if its volume is less
// than 2^-40 of the sum of the terms of a volume: the weights may then be off by more than a rounding.
template <class Corner>
VOX_HD bool weigh_as_floats(const Vec3d& p, const Corner& corner, float* weights) {
    if (weigh_in_doubles(corner_volumes(p, corner(0), corner(1), corner(2), corner(3)), weights)) return true;
    double most = 0;
    // Without corner i: twice, as keeping four volumes takes more registers.
    const auto volume = [&](int i) {
        const TwoDoubles of = accurate_determinant(exact_difference(corner(i == 0), p),
                                                   exact_difference(corner(i < 2 ? 2 : 1), p),
                                                   exact_difference(corner(i < 3 ? 3 : 2), p), most);
        return i % 2 ? -of : of;
    };
    TwoDoubles halves[2] = {{0, 0}, {0, 0}};
    VOX_ROLLED for (int i = 0; i < 4; ++i) {
        const TwoDoubles of = volume(i);
        if (i < 2)
            halves[0] = halves[0] + of;
        else
            halves[1] = halves[1] + of;
    }
    const TwoDoubles total = halves[0] + halves[1];
    VOX_ROLLED for (int i = 0; i < 4; ++i) weights[i] = clamped_float((volume(i) / total).high);
    const double size = total.high < 0 ? -total.high : total.high;
    return size > 0x1p-40 * most && size > 0x1p-800;
}

} // namespace vox
