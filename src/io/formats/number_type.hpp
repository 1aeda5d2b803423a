// The types of numbers in binary files.
#pragma once

#include "io/formats/scan.hpp"

#include <type_traits>
#include <vector>

namespace vox::io {

enum class NumberType : std::uint8_t {
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64
};

constexpr bool is_integer(NumberType type) { return type < NumberType::float32; }

// visit(std::type_identity<T>()), with the C++ type.
template <class Visit>
auto visit_type(NumberType type, const Visit& visit) {
    switch (type) {
    case NumberType::int8:
        return visit(std::type_identity<std::int8_t>());
    case NumberType::uint8:
        return visit(std::type_identity<std::uint8_t>());
    case NumberType::int16:
        return visit(std::type_identity<std::int16_t>());
    case NumberType::uint16:
        return visit(std::type_identity<std::uint16_t>());
    case NumberType::int32:
        return visit(std::type_identity<std::int32_t>());
    case NumberType::uint32:
        return visit(std::type_identity<std::uint32_t>());
    case NumberType::int64:
        return visit(std::type_identity<std::int64_t>());
    case NumberType::uint64:
        return visit(std::type_identity<std::uint64_t>());
    case NumberType::float32:
        return visit(std::type_identity<float>());
    default:
        return visit(std::type_identity<double>());
    }
}

inline std::size_t size_of(NumberType type) {
    return visit_type(type, []<class T>(std::type_identity<T>) { return sizeof(T); });
}

// The number stored at `data`, converted.
template <class Out>
Out load_as(NumberType type, const char* data, bool swap) {
    return visit_type(type,
                      [&]<class T>(std::type_identity<T>) { return static_cast<Out>(load<T>(data, swap)); });
}

// Appends `count` numbers: to integers only integers, as their bits.
template <class Out>
void append_numbers(NumberType type, const char* data, std::uint64_t count, bool swap,
                    std::vector<Out>& out) {
    visit_type(type, [&]<class T>(std::type_identity<T>) {
        if constexpr (std::is_floating_point_v<Out> || std::is_integral_v<T>)
            for (std::uint64_t i = 0; i < count; ++i)
                out.push_back(static_cast<Out>(load<T>(data + i * sizeof(T), swap)));
    });
}

} // namespace vox::io
