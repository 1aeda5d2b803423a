#include "io/formats/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#if defined(__unix__) || defined(__APPLE__)
#define VOX_IO_POSIX 1
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#else
#include "io/formats/paths.hpp"
#endif

namespace vox::io {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
    throw Error(VOX_ERROR_FILE, format("%s: %s", path.c_str(), reason.c_str()));
}

} // namespace

#if VOX_IO_POSIX

FileBytes::FileBytes(const std::string& path) : file_{path, {}} {
    struct Descriptor {
        int number;
        ~Descriptor() {
            if (number >= 0) close(number);
        }
    } const descriptor{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (descriptor.number < 0) fail(path, std::strerror(errno));
    struct stat status;
    if (fstat(descriptor.number, &status) != 0) fail(path, std::strerror(errno));
    if (S_ISDIR(status.st_mode)) fail(path, "is a directory");
    if (S_ISREG(status.st_mode)) {
        const auto size = static_cast<std::size_t>(status.st_size);
        if (size == 0) return;
        void* const memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.number, 0);
        if (memory == MAP_FAILED) fail(path, std::strerror(errno));
        madvise(memory, size, MADV_SEQUENTIAL);
        mapped_ = memory;
        file_.bytes = {static_cast<const char*>(memory), size};
        return;
    }
    if (!S_ISFIFO(status.st_mode)) fail(path, "is neither a regular file nor a pipe");
    for (;;) {
        const std::size_t size = read_.size();
        read_.resize(size + (std::size_t{1} << 20));
        const ssize_t got = read(descriptor.number, read_.data() + size, read_.size() - size);
        read_.resize(size + (got > 0 ? static_cast<std::size_t>(got) : 0));
        if (got < 0 && errno != EINTR) fail(path, std::strerror(errno));
        if (got == 0) break;
    }
    file_.bytes = {read_.data(), read_.size()};
}

FileBytes::~FileBytes() {
    if (mapped_) munmap(mapped_, file_.bytes.size());
}

#else

FileBytes::FileBytes(const std::string& path) : file_{path, {}} {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path_of(path), error);
    if (std::filesystem::is_directory(status)) fail(path, "is a directory");
    if (!std::filesystem::is_regular_file(status))
        fail(path, error ? error.message() : "is not a regular file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(open_to_read(path), &std::fclose);
    if (!stream) fail(path, std::strerror(errno));
    for (;;) {
        const std::size_t size = read_.size();
        read_.resize(size + (std::size_t{1} << 20));
        const std::size_t got = std::fread(read_.data() + size, 1, read_.size() - size, stream.get());
        read_.resize(size + got);
        if (got == 0) break;
    }
    if (std::ferror(stream.get())) fail(path, "cannot be read");
    file_.bytes = {read_.data(), read_.size()};
}

FileBytes::~FileBytes() = default;

#endif

} // namespace vox::io
