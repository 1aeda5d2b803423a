#include "io/formats/file_bytes.hpp"

#include "io/formats/paths.hpp"

#include <cerrno>
#include <cstring>
#include <memory>

namespace vox::io {

// Read, not mapped: a mapped file that another program shortens ends this one.
FileBytes::FileBytes(const std::string& path) {
    const auto fail = [&](const std::string& reason) {
        throw_error(VOX_ERROR_FILE, "%s: %s", path.c_str(), reason.c_str());
    };
    std::error_code error;
    const std::filesystem::path at = path_of(path);
    const std::filesystem::file_status status = std::filesystem::status(at, error);
    const bool regular = std::filesystem::is_regular_file(status);
    if (std::filesystem::is_directory(status)) fail("is a directory");
    if (std::filesystem::exists(status) && !regular && !std::filesystem::is_fifo(status))
        fail("is neither a regular file nor a pipe");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(open_to_read(path), &std::fclose);
    if (!stream) fail(std::strerror(errno));
    constexpr std::size_t piece = std::size_t{1} << 18;
    if (const std::uintmax_t size = regular ? std::filesystem::file_size(at, error) : 0; !error)
        bytes_.reserve(static_cast<std::size_t>(size) + piece);
    for (std::size_t size = 0, got = 1; got > 0; size += got) {
        bytes_.resize(size + piece);
        got = std::fread(bytes_.data() + size, 1, piece, stream.get());
        bytes_.resize(size + got);
    }
    if (std::ferror(stream.get())) fail(std::strerror(errno));
    file_ = {path, {bytes_.data(), bytes_.size()}};
}

} // namespace vox::io
