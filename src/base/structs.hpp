// Structs of the caller that may grow from version to version. Their first field is uint32_t struct_size;
// only the bytes that it covers are read or written.
#pragma once

#include "base/error.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace vox {

inline void check_struct_size(std::uint32_t struct_size, const char* name) {
    if (struct_size < sizeof(std::uint32_t) || struct_size > 65536)
        refuse(format("%s.struct_size is %u, expected the size of the struct", name, struct_size));
}

inline std::uint32_t checked_struct_size(const void* from_caller, const char* name) {
    require(from_caller, name);
    std::uint32_t struct_size;
    std::memcpy(&struct_size, from_caller, sizeof struct_size);
    check_struct_size(struct_size, name);
    return struct_size;
}

// An enum of the caller as a number: a value outside the enum must not be read as one.
template <class Enum>
std::int32_t enum_value(const Enum& field) noexcept {
    static_assert(sizeof field == sizeof(std::int32_t));
    std::int32_t value;
    std::memcpy(&value, &field, sizeof value);
    return value;
}

template <class Enum>
void check_enum(const Enum& field, std::int32_t last, const char* name) {
    const std::int32_t value = enum_value(field);
    if (value < 0 || value > last) refuse(format("%s is %d, expected 0 to %d", name, value, last));
}

// A number of the caller that stands for a bool.
inline bool read_bool(std::uint32_t value, const char* name) {
    if (value > 1) refuse(format("%s is %u, expected 0 or 1", name, value));
    return value != 0;
}

// Returns the caller's struct. Fields that its struct_size does not cover are 0, the default.
template <class T>
T read_struct(const T* in, const char* name) {
    T read{};
    std::memcpy(&read, in, std::min<std::size_t>(checked_struct_size(in, name), sizeof(T)));
    read.struct_size = sizeof read;
    return read;
}

// Reads what an optional pointer of a desc points to, or zeros.
template <class T>
T value_of(const T* in) {
    return in ? *in : T{};
}

// Replaces 0 by the value that it stands for.
template <class T>
void set_default(T& field, T value) {
    if (field == T{}) field = value;
}

// Throws when `out` cannot be written. Call it before any work whose result goes there.
inline void check_out_struct(const void* out, const char* name) { (void)checked_struct_size(out, name); }

// Writes `value` to the caller's struct, as far as its struct_size reaches. struct_size stays.
template <class T>
void write_struct(T* out, T value, const char* name) {
    value.struct_size = checked_struct_size(out, name);
    std::memcpy(out, &value, std::min<std::size_t>(value.struct_size, sizeof(T)));
}

} // namespace vox
