#include "io/unused.hpp"

#include <algorithm>

namespace vox::io {

void leave_out_unused(MeshData& data) {
    if (data.tets.empty()) return;
    constexpr std::uint32_t none = 0xffffffffu;
    const std::size_t count = data.positions.size() / 3;
    std::vector<std::uint32_t> mesh_vertex(count, none);
    for (const std::uint32_t vertex : data.tets) mesh_vertex[vertex] = 0;
    const auto unused = static_cast<std::size_t>(std::count(mesh_vertex.begin(), mesh_vertex.end(), none));
    if (unused == 0) return;

    std::vector<std::uint32_t>& kept = data.file_vertices;
    std::vector<double> positions;
    kept.reserve(count - unused);
    positions.reserve(3 * (count - unused));
    for (std::size_t v = 0; v < count; ++v) {
        if (mesh_vertex[v] == none) continue;
        mesh_vertex[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(static_cast<std::uint32_t>(v));
        for (std::size_t k = 0; k < 3; ++k) positions.push_back(data.positions[3 * v + k]);
    }
    data.positions = std::move(positions);
    data.left_out_vertices = unused;
    for (std::uint32_t& vertex : data.tets) vertex = mesh_vertex[vertex];

    std::size_t end = 0;
    for (std::size_t t = 0; t < data.triangles.size(); t += 3) {
        bool whole = true;
        for (std::size_t i = t; i < t + 3; ++i) {
            data.triangles[end + i - t] = mesh_vertex[data.triangles[i]];
            whole = whole && data.triangles[end + i - t] != none;
        }
        if (whole) end += 3;
    }
    data.left_out_triangles = (data.triangles.size() - end) / 3;
    data.triangles.resize(end);
}

} // namespace vox::io
