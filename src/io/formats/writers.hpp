// The writers, one for each format, turn a mesh and numbers on its vertices and cells into bytes.
#pragma once

#include "io/formats/decimal.hpp"
#include "io/mesh_data.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <span>
#include <string_view>

namespace vox::io {

// Collects bytes and passes them on in large pieces. `flush` must be called at the end.
class Output {
public:
    explicit Output(std::function<void(std::string_view)> write) : write_(std::move(write)) {
        buffer_.reserve(piece + 64);
    }

    Output& operator<<(std::string_view text) {
        buffer_.append(text);
        return checked();
    }
    Output& operator<<(char c) {
        buffer_ += c;
        return checked();
    }
    // A double as the shortest text that gives it again.
    template <class Number>
    requires std::is_arithmetic_v<Number> Output& operator<<(Number value) {
        char text[32];
        char* end = nullptr;
        if constexpr (std::is_floating_point_v<Number>)
            end = write_double(text, text + sizeof text, value);
        else
            end = std::to_chars(text, text + sizeof text, value).ptr;
        return *this << std::string_view(text, static_cast<std::size_t>(end - text));
    }

    template <class T>
    Output& binary(T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof value);
        buffer_.append(bytes, sizeof bytes);
        return checked();
    }

    void flush() {
        write_(buffer_);
        buffer_.clear();
    }

private:
    static constexpr std::size_t piece = std::size_t{1} << 18;

    Output& checked() {
        if (buffer_.size() >= piece) flush();
        return *this;
    }

    std::function<void(std::string_view)> write_;
    std::string buffer_;
};

// Numbers on the vertices and on the cells: the triangles, then the tets.
struct WrittenData {
    std::span<const vox_io_point_data> points, cells;
};

// `version` is VOX_IO_WRITE_MSH_22 or VOX_IO_WRITE_MSH_41.
void write_msh(const vox_io_mesh_view& mesh, vox_io_write_format version, const WrittenData& values,
               bool binary, Output& out);
void write_vtu(const vox_io_mesh_view& mesh, const WrittenData& values, bool binary, Output& out);

} // namespace vox::io
