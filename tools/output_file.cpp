#include "output_file.hpp"

#include "failure.hpp"
#include "paths.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace tool {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw Failure(path + ": cannot be written: " + why);
}

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

} // namespace

bool has_ending(const std::string& path, const char* ending) { return lower_case(path).ends_with(ending); }

void check_output(const std::string& path, std::initializer_list<const char*> endings) {
    const auto matches = [&](const char* ending) { return has_ending(path, ending); };
    if (endings.size() > 0 && std::none_of(endings.begin(), endings.end(), matches)) {
        std::string words;
        for (const char* ending : endings) words += (words.empty() ? "" : " or ") + std::string(ending);
        throw Failure(path + ": expected a name that ends with " + words);
    }
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path_of(path), error);
    if (std::filesystem::is_directory(status)) fail(path, std::strerror(EISDIR));
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return; // a pipe, a terminal
    // Only opening a file tells whether it can be written. An existing one is opened, but not changed.
    const bool existed = std::filesystem::exists(status);
    std::FILE* const file = open_file(path, "ab");
    if (!file) fail(path, std::strerror(errno));
    std::fclose(file);
    // If `path` was a symbolic link to no file, removes the new file, not the link.
    if (!existed) std::filesystem::remove(std::filesystem::canonical(path_of(path), error), error);
}

void write_file(const std::string& path, const std::string& text) {
    std::FILE* file = open_file(path, "wb");
    const bool written = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = file && std::fclose(file) == 0;
    if (!written || !closed) fail(path, std::strerror(errno));
}

} // namespace tool
