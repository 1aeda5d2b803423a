// Stands in for Jolt Physics (https://github.com/jrouwe/JoltPhysics, MIT): as much as the adapter uses, with
// the same names and types, and a solver of the same kind, so that the adapter is tested without Jolt.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace JPH {

using uint = unsigned int;
using uint32 = std::uint32_t;
template <typename T>
using Array = std::vector<T>;

class Vec3 {
public:
    Vec3() = default;
    Vec3(float x, float y, float z) : values{x, y, z} {}
    static Vec3 sZero() { return Vec3(0, 0, 0); }
    float GetX() const { return values[0]; }
    float GetY() const { return values[1]; }
    float GetZ() const { return values[2]; }
    float Dot(const Vec3& v) const {
        return values[0] * v.values[0] + values[1] * v.values[1] + values[2] * v.values[2];
    }
    float Length() const { return std::sqrt(Dot(*this)); }
    Vec3 Cross(const Vec3& v) const {
        return Vec3(values[1] * v.values[2] - values[2] * v.values[1],
                    values[2] * v.values[0] - values[0] * v.values[2],
                    values[0] * v.values[1] - values[1] * v.values[0]);
    }
    Vec3 operator+(const Vec3& v) const {
        return Vec3(GetX() + v.GetX(), GetY() + v.GetY(), GetZ() + v.GetZ());
    }
    Vec3 operator-(const Vec3& v) const {
        return Vec3(GetX() - v.GetX(), GetY() - v.GetY(), GetZ() - v.GetZ());
    }
    friend Vec3 operator*(float f, const Vec3& v) { return Vec3(f * v.GetX(), f * v.GetY(), f * v.GetZ()); }
    Vec3& operator+=(const Vec3& v) { return *this = *this + v; }

private:
    float values[4] = {}; // as wide as a vector register
};
using Vec3Arg = const Vec3&;

class Mat44 {
public:
    Vec3 columns[4];
    Vec3 GetColumn3(uint k) const { return columns[k]; }
    Vec3 GetTranslation() const { return columns[3]; }
};
using RMat44 = Mat44;

} // namespace JPH
