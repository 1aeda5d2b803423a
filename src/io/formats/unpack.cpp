// zlib and liblzma unpack their own formats; LZ4 is unpacked here (Y. Collet, "LZ4 block format
// description").
#include "io/formats/unpack.hpp"

#include <algorithm>
#include <cstring>
#include <zlib.h>
#ifdef VOX_IO_LZMA
#include <lzma.h>
#endif

namespace vox::io {
namespace {

bool unpack_lz4(std::string_view in, char* out, std::size_t size) {
    std::size_t from = 0, to = 0;
    // A length of 15 goes on in the next bytes, up to one below 255.
    const auto length = [&](unsigned half, std::size_t& found) {
        found = half;
        for (unsigned byte = half == 15 ? 255 : 0; byte == 255; found += byte) {
            if (from == in.size()) return false;
            byte = static_cast<unsigned char>(in[from++]);
        }
        return true;
    };
    while (from < in.size()) {
        const unsigned token = static_cast<unsigned char>(in[from++]);
        std::size_t literals = 0, copies = 0;
        if (!length(token >> 4, literals) || literals > in.size() - from || literals > size - to)
            return false;
        std::copy_n(in.data() + from, literals, out + to);
        from += literals;
        to += literals;
        if (from == in.size()) break; // the last ones
        if (in.size() - from < 2) return false;
        const std::size_t back = static_cast<unsigned char>(in[from]) +
                                 256 * std::size_t{static_cast<unsigned char>(in[from + 1])};
        from += 2;
        if (!length(token & 15, copies)) return false;
        copies += 4;
        if (back == 0 || back > to || copies > size - to) return false;
        for (; copies > 0; --copies, ++to)
            out[to] = out[to - back]; // what is copied may be what was just written
    }
    return to == size;
}

#ifdef VOX_IO_LZMA
bool unpack_lzma(std::string_view in, char* out, std::size_t size) {
    std::uint64_t memory = std::uint64_t{1} << 28; // its presets need at most 65 MB
    std::size_t from = 0, to = 0;
    const lzma_ret status =
        lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(in.data()),
                                  &from, in.size(), reinterpret_cast<std::uint8_t*>(out), &to, size);
    return status == LZMA_OK && to == size;
}
#endif

} // namespace

std::optional<Packing> packing_of(std::string_view compressor) {
    static constexpr std::string_view names[] = {"", "vtkZLibDataCompressor", "vtkLZ4DataCompressor",
                                                 "vtkLZMADataCompressor"};
    const auto* const found = std::find(std::begin(names), std::end(names), compressor);
    if (found == std::end(names)) return std::nullopt;
    return static_cast<Packing>(found - std::begin(names));
}

bool can_unpack(Packing packing) {
#ifdef VOX_IO_LZMA
    (void)packing;
    return true;
#else
    return packing != Packing::lzma;
#endif
}

std::uint64_t most_unpacked(Packing packing) {
    constexpr std::uint64_t most[] = {1, 1032, 255, 8192};
    return most[static_cast<std::size_t>(packing)];
}

std::string unpack(Packing packing, std::string_view packed, char* out, std::size_t size) {
    if (packing == Packing::lz4)
        return unpack_lz4(packed, out, size) ? "" : "packed by LZ4, found other data";
#ifdef VOX_IO_LZMA
    if (packing == Packing::lzma)
        return unpack_lzma(packed, out, size) ? "" : "packed by LZMA, found other data";
#endif
    uLongf length = static_cast<uLongf>(size);
    const int status =
        uncompress(reinterpret_cast<Bytef*>(out), &length, reinterpret_cast<const Bytef*>(packed.data()),
                   static_cast<uLong>(packed.size()));
    if (status == Z_OK && length == size) return "";
    return std::string("packed by zlib, found other data (") + zError(status) + ")";
}

} // namespace vox::io
