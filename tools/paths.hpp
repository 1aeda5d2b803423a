// File names are UTF-8 on every system, as in vox_io. Converts them to the system's form.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace tool {

inline std::filesystem::path path_of(const std::string& utf8) {
#if defined(_WIN32)
    return std::u8string(utf8.begin(), utf8.end());
#else
    return utf8; // any bytes
#endif
}

inline std::string utf8_of(const std::filesystem::path& path) {
    const std::u8string text = path.u8string();
    return std::string(text.begin(), text.end());
}

// Like fopen.
inline std::FILE* open_file(const std::string& utf8, const char* mode) {
#if defined(_WIN32)
    return _wfopen(path_of(utf8).c_str(), path_of(mode).c_str());
#else
    return std::fopen(utf8.c_str(), mode);
#endif
}

} // namespace tool
