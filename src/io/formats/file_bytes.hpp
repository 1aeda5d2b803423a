// The bytes of a file on disk, mapped into memory if the system supports it, and read otherwise.
#pragma once

#include "io/formats/scan.hpp"

#include <string>
#include <vector>

namespace vox::io {

class FileBytes {
public:
    // Throws Error(FILE) if `path` is not a readable regular file or pipe.
    explicit FileBytes(const std::string& path);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const File& file() const noexcept { return file_; }

private:
    File file_;
    std::vector<char> read_; // the bytes if the file is not mapped
    void* mapped_ = nullptr;
};

} // namespace vox::io
