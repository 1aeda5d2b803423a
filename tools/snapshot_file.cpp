#include "snapshot_file.hpp"

#include "failure.hpp"
#include "paths.hpp"

#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <unordered_map>

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

// Reads the little-endian numbers of a snapshot (docs/snapshot.md), one after the other.
class Numbers {
public:
    explicit Numbers(const unsigned char* bytes) : bytes_(bytes) {}

    template <class Number>
    Number next() {
        using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
        Bits bits = 0;
        for (std::size_t i = 0; i < sizeof bits; ++i) bits |= Bits{bytes_[i]} << (8 * i);
        bytes_ += sizeof bits;
        return std::bit_cast<Number>(bits);
    }

private:
    const unsigned char* bytes_;
};

void place(const std::array<double, 12>& m, std::vector<double>& positions) {
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const double x = positions[i], y = positions[i + 1], z = positions[i + 2];
        for (std::size_t row = 0; row < 3; ++row)
            positions[i + row] =
                ((m[4 * row] * x + m[4 * row + 1] * y) + m[4 * row + 2] * z) + m[4 * row + 3];
    }
}

// Removes the tetrahedra whose bit is set.
void keep_on(DrawnMesh& mesh, Numbers off) {
    const std::size_t tets = mesh.tets.size() / 4;
    std::vector<std::uint32_t> kept;
    std::uint64_t word = 0;
    for (std::size_t t = 0; t < tets; ++t) {
        if (t % 64 == 0) word = off.next<std::uint64_t>();
        if (word >> (t % 64) & 1) continue;
        mesh.numbers.push_back(static_cast<std::uint32_t>(t));
        kept.insert(kept.end(), &mesh.tets[4 * t], &mesh.tets[4 * t] + 4);
    }
    mesh.tets = std::move(kept);
}

} // namespace

void save_snapshot(const vox_grid* grid, const std::string& path) {
    std::uint64_t size = 0;
    check(vox_grid_save(grid, nullptr, 0, &size));
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    check(vox_grid_save(grid, bytes.data(), bytes.size(), &size));
    File file(open_file(path, "wb"));
    if (!file) fail(path, "be written");
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) fail(path, "be written");
    if (std::fclose(file.release()) != 0) fail(path, "be written");
}

Snapshot load_snapshot(const std::string& path, const vox_grid_desc& machine) {
    const File file(open_file(path, "rb"));
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
    return {std::move(bytes), Grid(grid)};
}

std::vector<DrawnMesh> drawn_meshes(const std::vector<unsigned char>& bytes) {
    constexpr std::size_t header = 24;
    constexpr std::uint32_t is_disabled = 2, is_transformed = 4;
    std::vector<DrawnMesh> meshes;
    std::unordered_map<std::uint32_t, std::size_t> place_of; // a mesh, by its id
    for (std::size_t at = header; at < bytes.size();) {
        const std::string name(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at) + 4);
        Numbers chunk(bytes.data() + at + 8);
        const auto size = static_cast<std::size_t>(chunk.next<std::uint64_t>());
        at += 16 + (size + 7) / 8 * 8;
        if (name == "MESH") {
            DrawnMesh mesh;
            mesh.id = chunk.next<std::uint32_t>();
            mesh.name = "body " + std::to_string(mesh.id);
            const auto bits = chunk.next<std::uint32_t>();
            (void)chunk.next<std::uint64_t>(); // user data
            const auto vertices = static_cast<std::size_t>(chunk.next<std::uint64_t>());
            const auto tets = static_cast<std::size_t>(chunk.next<std::uint64_t>());
            const bool placed = chunk.next<std::uint32_t>() != 0;
            const bool doubles = chunk.next<std::uint32_t>() == VOX_FORMAT_DOUBLE;
            std::array<double, 12> transform{};
            if (bits & is_transformed)
                for (double& value : transform) value = chunk.next<double>();
            mesh.tets.resize(4 * tets);
            for (std::uint32_t& corner : mesh.tets) corner = chunk.next<std::uint32_t>();
            mesh.positions.resize(3 * vertices);
            if (placed)
                for (double& x : mesh.positions)
                    x = doubles ? chunk.next<double>() : static_cast<double>(chunk.next<float>());
            if (bits & is_transformed) place(transform, mesh.positions);
            for (double& x : mesh.positions)
                if (!std::isfinite(x)) x = 0; // a removed vertex
            if (!placed || (bits & is_disabled)) continue;
            place_of.emplace(mesh.id, meshes.size());
            meshes.push_back(std::move(mesh));
        } else if (name == "CUTS") { // after the meshes
            const auto id = chunk.next<std::uint32_t>();
            (void)chunk.next<std::uint32_t>();
            if (const auto found = place_of.find(id); found != place_of.end())
                keep_on(meshes[found->second], chunk);
        }
    }
    return meshes;
}

} // namespace tool
