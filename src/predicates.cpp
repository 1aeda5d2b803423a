// The exact part of predicates.hpp: determinants as expansions, after Shewchuk 1997 (cited there), Sects. 2.1
// to 2.8.
//
// An expansion is a sum of doubles that is never rounded: its parts are ordered by magnitude and do not
// overlap, so the largest one has the sign of the whole. All values here are integer multiples of 2^-447
// below 2^391, hence no part and no rounding error of a product underflows, and everything is exact for any
// finite floats.
#include "predicates.hpp"

#include <algorithm>
#include <cfloat>

#if defined(FLT_EVAL_METHOD)
static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1, "doubles must be rounded to double");
#endif

namespace vox {
namespace {

struct Pair {
    double value, error; // value + error is the exact result, value the rounded one
};

Pair two_sum(double a, double b) { // Knuth
    const double sum = a + b;
    const double b_part = sum - a;
    const double a_part = sum - b_part;
    return {sum, (a - a_part) + (b - b_part)};
}

Pair split(double a) {                         // Veltkamp: two halves of at most 26 bits
    const double shifted = 0x1.0000002p27 * a; // 2^27 + 1
    const double high = shifted - (shifted - a);
    return {high, a - high};
}

Pair two_product(double a, double b) { // Dekker
    const double product = a * b;
    const Pair x = split(a), y = split(b);
    const double error =
        x.error * y.error - (((product - x.value * y.value) - x.error * y.value) - x.value * y.error);
    return {product, error};
}

struct Expansion {
    // A difference has 2 parts, the product of two differences 8, a minor 16, times a difference 64, a sum of
    // three of these 192.
    double part[192];
    int size = 0;

    void append(double value) {
        if (value != 0) part[size++] = value;
    }

    void add(double value) { // GROW-EXPANSION, zeros dropped
        const int count = size;
        size = 0;
        for (int i = 0; i < count; ++i) {
            const Pair sum = two_sum(value, part[i]);
            append(sum.error);
            value = sum.value;
        }
        append(value);
    }

    void add(const Expansion& other) { // EXPANSION-SUM
        for (int i = 0; i < other.size; ++i) add(other.part[i]);
    }

    void subtract(const Expansion& other) {
        for (int i = 0; i < other.size; ++i) add(-other.part[i]);
    }
};

Expansion exact_difference(float a, float b) {
    const Pair pair = two_sum(double(a), -double(b));
    Expansion result;
    result.append(pair.error);
    result.append(pair.value);
    return result;
}

Expansion scaled(const Expansion& e, double factor) { // SCALE-EXPANSION
    Expansion result;
    if (e.size == 0) return result;
    Pair carry = two_product(e.part[0], factor);
    result.append(carry.error);
    for (int i = 1; i < e.size; ++i) {
        const Pair product = two_product(e.part[i], factor);
        const Pair low = two_sum(carry.value, product.error);
        result.append(low.error);
        carry = two_sum(product.value, low.value);
        result.append(carry.error);
    }
    result.append(carry.value);
    return result;
}

// `few` has at most two parts.
Expansion product(const Expansion& many, const Expansion& few) {
    Expansion result;
    for (int i = 0; i < few.size; ++i) result.add(scaled(many, few.part[i]));
    return result;
}

// det[b-a, c-a, d-a]
Expansion exact_volume(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
    struct Row {
        Expansion x, y, z;
    };
    const auto row = [&a](const Vec3f& p) {
        return Row{exact_difference(p.x, a.x), exact_difference(p.y, a.y), exact_difference(p.z, a.z)};
    };
    const auto exact_minor = [](const Row& u, const Row& v) {
        Expansion result = product(u.x, v.y);
        result.subtract(product(v.x, u.y));
        return result;
    };
    const Row u = row(b), v = row(c), w = row(d);
    Expansion result = product(exact_minor(v, w), u.z);
    result.subtract(product(exact_minor(u, w), v.z));
    result.add(product(exact_minor(u, v), w.z));
    return result;
}

// The value to within one unit in the last place: the downward half of COMPRESS moves all that a double can
// hold into the top parts, and what is left adds up from below.
double estimate(const Expansion& e) {
    if (e.size == 0) return 0;
    double compressed[192];
    int count = 0;
    double top = e.part[e.size - 1];
    for (int i = e.size - 2; i >= 0; --i) {
        const Pair sum = two_sum(top, e.part[i]);
        top = sum.value;
        if (sum.error != 0) {
            compressed[count++] = top;
            top = sum.error;
        }
    }
    for (int i = count - 1; i >= 0; --i) top = compressed[i] + top;
    return top;
}

} // namespace

int exact_orientation(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
    const Expansion volume = exact_volume(a, b, c, d);
    if (volume.size == 0) return 0;
    return volume.part[volume.size - 1] > 0 ? 1 : -1;
}

std::array<float, 4> barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c,
                                 const Vec3f& d) {
    const std::array<BoundedVolume, 4> bounded = corner_volumes(p, a, b, c, d);
    double volume[4] = {bounded[0].volume, bounded[1].volume, bounded[2].volume, bounded[3].volume};
    double total = volume[0] + volume[1] + volume[2] + volume[3];
    const double error = std::max({bounded[0].error, bounded[1].error, bounded[2].error, bounded[3].error});
    // A volume is off by `error`, their sum by four of it: below 2^-24 of the sum, a weight is off by at most
    // five times that. Otherwise the exact volumes are rounded once; they have one sign, so nothing cancels
    // in the sum.
    if (!(error < 0x1p-24 * std::abs(total))) {
        volume[0] = estimate(exact_volume(p, b, c, d));
        volume[1] = estimate(exact_volume(a, p, c, d));
        volume[2] = estimate(exact_volume(a, b, p, d));
        volume[3] = estimate(exact_volume(a, b, c, p));
        total = volume[0] + volume[1] + volume[2] + volume[3];
    }
    std::array<float, 4> weights;
    for (std::size_t i = 0; i < 4; ++i) {
        const double weight = volume[i] / total;
        weights[i] = weight > 0 ? float(std::min(weight, 1.0)) : 0.0f; // never -0
    }
    return weights;
}

} // namespace vox
