// The bytes of a file on disk.
#pragma once

#include "io/formats/scan.hpp"

#include <string>
#include <vector>

namespace vox::io {

class FileBytes {
public:
    // Throws Error(FILE) if `path` is not a readable regular file or pipe.
    explicit FileBytes(const std::string& path);
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const File& file() const noexcept { return file_; }

private:
    std::vector<char> bytes_;
    File file_;
};

// The path of the file beside `path`, in UTF-8, that has another extension. Its name may differ in upper and
// lower case.
std::string path_beside(const std::string& path, const std::string& extension);

} // namespace vox::io
