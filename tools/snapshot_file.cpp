#include "snapshot_file.hpp"

#include "failure.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace tool {

namespace {

struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void fail(const std::string& path, const char* what) {
    const int error = errno;
    throw Failure(path + ": cannot " + what + ": " + std::strerror(error));
}

} // namespace

void save_snapshot(const vox_grid* grid, const std::string& path) {
    std::uint64_t size = 0;
    check(vox_grid_save(grid, nullptr, 0, &size));
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    check(vox_grid_save(grid, bytes.data(), bytes.size(), &size));
    File file(std::fopen(path.c_str(), "wb"));
    if (!file) fail(path, "be written");
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) fail(path, "be written");
    if (std::fclose(file.release()) != 0) fail(path, "be written");
}

Grid load_snapshot(const std::string& path, const vox_grid_desc& machine) {
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) fail(path, "be opened");
    std::vector<unsigned char> bytes;
    for (;;) {
        const std::size_t size = bytes.size(), piece = 1 << 16;
        bytes.resize(size + piece);
        const std::size_t read = std::fread(bytes.data() + size, 1, piece, file.get());
        bytes.resize(size + read);
        if (read < piece) break;
    }
    if (std::ferror(file.get())) fail(path, "be read");
    vox_grid* grid = nullptr;
    const vox_result result = vox_grid_load(bytes.data(), bytes.size(), &machine, &grid);
    if (result != VOX_OK) check(vox_fail(result, (path + ": " + vox_last_error()).c_str()));
    return Grid(grid);
}

} // namespace tool
