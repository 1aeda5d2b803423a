// The compressors of VTK's XML files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vox::io {

enum class Packing : std::uint8_t { none, zlib, lz4, lzma };

// The packing that a name in a file says: vtkZLibDataCompressor, ...; "" is none.
std::optional<Packing> packing_of(std::string_view compressor);
// Whether this library unpacks it.
bool can_unpack(Packing packing);
// How many times its size a block may unpack to, at most.
std::uint64_t most_unpacked(Packing packing);
// Unpacks a block, which fills `size` bytes at `out`. Returns what is wrong with it; "" if nothing is.
std::string unpack(Packing packing, std::string_view packed, char* out, std::size_t size);

} // namespace vox::io
