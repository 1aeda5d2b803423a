// Names of files are UTF-8 on every system. Here is the one place that turns them into what the system wants.
#pragma once

#include "io/throw_error.hpp"

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

namespace vox::io {

inline std::filesystem::path path_of(const std::string& utf8) {
#if defined(_WIN32)
    try {
        return std::filesystem::path(std::u8string(utf8.begin(), utf8.end()));
    } catch (const std::system_error&) {
        throw_error(VOX_ERROR_FILE, "%s: expected a path in UTF-8", utf8.c_str());
    }
#else
    return utf8; // any bytes, as the system takes them
#endif
}

inline std::string utf8_of(const std::filesystem::path& path) {
    const std::u8string text = path.u8string();
    return std::string(text.begin(), text.end());
}

// As fopen, in binary mode. Sets errno where it returns null.
inline std::FILE* open_to_read(const std::string& utf8) {
#if defined(_WIN32)
    return _wfopen(path_of(utf8).c_str(), L"rb");
#else
    return std::fopen(utf8.c_str(), "rb");
#endif
}
inline std::FILE* open_to_write(const std::string& utf8) {
#if defined(_WIN32)
    return _wfopen(path_of(utf8).c_str(), L"wb");
#else
    return std::fopen(utf8.c_str(), "wb");
#endif
}

} // namespace vox::io
