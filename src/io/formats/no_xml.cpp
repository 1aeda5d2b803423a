// In place of vtu.cpp where vox_io is built without pugixml and zlib. Writing needs neither.
#include "io/formats/readers.hpp"

namespace vox::io {

MeshData read_vtu(const File& file, std::uint32_t) {
    throw_error(VOX_ERROR_UNSUPPORTED,
                "%s: this vox_io was built without pugixml and zlib, which .vtu and .vtp need (CMake option "
                "VOX_IO_XML)",
                file.name.c_str());
}

} // namespace vox::io
