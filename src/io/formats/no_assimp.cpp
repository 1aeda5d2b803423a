// In place of assimp.cpp where vox_io is built without assimp.
#include "io/formats/readers.hpp"

namespace vox::io {
namespace {

[[noreturn]] void refuse_assimp() {
    throw_error(VOX_ERROR_UNSUPPORTED, "this vox_io was built without assimp (CMake option VOX_IO_ASSIMP)");
}

} // namespace

MeshData read_by_assimp(const File&, const std::string&, std::uint32_t) { refuse_assimp(); }
MeshData read_by_assimp_at(const std::string&, std::uint32_t) { refuse_assimp(); }

} // namespace vox::io
