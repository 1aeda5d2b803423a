#include "io/formats/file_bytes.hpp"

#include "io/formats/paths.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
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

std::string path_beside(const std::string& path, const std::string& extension) {
    const std::string expected = path.substr(0, path.rfind('.') + 1) + extension;
    const std::filesystem::path at = path_of(expected), folder = at.parent_path();
    const auto lower = [](std::string name) {
        for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        return name;
    };
    const std::string wanted = lower(utf8_of(at.filename()));
    std::string found; // the first by name, whatever the order of the folder
    std::error_code error;
    if (std::filesystem::exists(at, error)) return expected;
    std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string name = utf8_of(entry->path().filename());
        if (lower(name) == wanted && (found.empty() || name < found)) found = name;
    }
    return found.empty() ? expected : utf8_of(folder / path_of(found));
}

} // namespace vox::io
