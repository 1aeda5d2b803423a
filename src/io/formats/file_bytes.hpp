// The bytes of a file on disk: mapped where the system can, else read.
#pragma once

#include "io/formats/scan.hpp"

#include <string>
#include <vector>

namespace vox::io {

class FileBytes {
public:
    // Throws Error(FILE) when `path` is no readable regular file or pipe.
    explicit FileBytes(const std::string& path);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const File& file() const noexcept { return file_; }

private:
    File file_;
    std::vector<char> read_; // when not mapped
    void* mapped_ = nullptr;
};

} // namespace vox::io
