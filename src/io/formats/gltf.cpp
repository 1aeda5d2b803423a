// glTF 2.0, .gltf and .glb (Khronos, glTF 2.0 Specification; ISO/IEC 12113): the triangles of the scene, with
// the transforms of its nodes. Skins, morph targets and animations are skipped. Buffers are in the file
// itself, in base64, or in files beside it.
#include "io/formats/gltf_document.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <limits>

namespace vox::io {
namespace {

using gltf::Primitive;
using gltf::Values;

// A component as a number (section 3.6.2.2); normalized integers stand for -1 to 1 or 0 to 1 (section 3.11).
double component(const char* bytes, NumberType type, bool normalized) {
    return visit_type(type, [&]<class T>(std::type_identity<T>) {
        const auto value = static_cast<double>(load<T>(bytes, host_is_big_endian));
        if (!normalized || !std::is_integral_v<T>) return value;
        return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
    });
}

class GltfReader {
public:
    GltfReader(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index)
        : document_(file, folder), contents_(document_.contents()), mesh_index_(mesh_index),
          surface_(file.name, surface_limits(document_.bytes()), all_meshes),
          primitives_left_(surface_.limits().triangles) {
        const std::size_t meshes = contents_.primitives.size();
        if (mesh_index != all_meshes && mesh_index >= meshes)
            refuse(format("%s: mesh %u was asked for, but the file holds %zu", file.name.c_str(),
                          mesh_index + 1, meshes));
    }

    MeshData read() {
        add_scene();
        MeshData data = surface_.finish();
        data.unit_in_metres = 1;
        return data;
    }

private:
    // The nodes of the scene, or those of a node, that are still to be visited.
    struct Level {
        Placement world;
        const std::deque<std::uint32_t>* nodes;
        std::size_t next, end;
    };

    void add_scene() {
        if (contents_.nodes.empty()) // a library of meshes: each once
            for (std::uint32_t m = 0; m < contents_.first_primitive.size(); ++m) add_mesh(m, {});
        const std::uint32_t scene = contents_.scene;
        visited_.assign(contents_.nodes.size(), false);
        descend({}, contents_.roots, scene ? contents_.roots_end[scene - 1] : 0, contents_.roots_end[scene]);
        while (!levels_.empty()) {
            Level& level = levels_.back();
            if (level.next == level.end)
                levels_.pop_back();
            else
                visit((*level.nodes)[level.next++], Placement(level.world));
        }
    }

    void descend(const Placement& world, const std::deque<std::uint32_t>& nodes, std::size_t first,
                 std::size_t end) {
        constexpr std::size_t most_levels = 1024;
        if (levels_.size() >= most_levels)
            document_.fail(format("nodes are nested deeper than %zu levels", most_levels), VOX_ERROR_LIMIT);
        if (first < end) levels_.push_back({world, &nodes, first, end});
    }

    void visit(std::uint32_t number, const Placement& parent) {
        document_.check_number("a node", number, contents_.nodes.size());
        if (visited_[number]) document_.fail(format("node %u is in the scene twice", number));
        visited_[number] = true;
        const gltf::SceneNode& node = contents_.nodes[number];
        const Placement world =
            parent.of(node.placement == gltf::none ? Placement() : contents_.placements[node.placement]);
        if (node.mesh != gltf::none) add_mesh(node.mesh, world);
        descend(world, contents_.children, number ? contents_.nodes[number - 1].children_end : 0,
                node.children_end);
    }

    void add_mesh(std::uint32_t mesh, const Placement& world) {
        const std::deque<std::uint32_t>& first = contents_.first_primitive;
        document_.check_number("a mesh", mesh, first.size());
        const std::size_t last = mesh + 1 < first.size() ? first[mesh + 1] : contents_.primitives.size();
        for (std::size_t p = first[mesh]; p < last; ++p)
            if (mesh_index_ == all_meshes || mesh_index_ == p) {
                if (primitives_left_-- == 0)
                    document_.fail("the scene shows more primitives than the limit for a file of its size",
                                   VOX_ERROR_LIMIT);
                add_primitive(contents_.primitives[p], world);
            }
    }

    void add_primitive(const Primitive& primitive, const Placement& world) {
        if (primitive.mode > 6)
            document_.fail(format("expected a mode from 0 to 6, found %u", primitive.mode));
        if (primitive.positions == gltf::none) return surface_.skip(1);
        const Values positions = document_.values(primitive.positions);
        if (!contents_.accessors[primitive.positions].is_vec3 ||
            !(positions.type == NumberType::float32 || positions.type <= NumberType::uint16))
            document_.fail(format("accessor %u: expected positions, of type VEC3", primitive.positions));
        const bool indexed = primitive.indices != gltf::none;
        Values indices;
        if (indexed) {
            indices = document_.values(primitive.indices);
            if (!contents_.accessors[primitive.indices].is_scalar ||
                !(indices.type == NumberType::uint8 || indices.type == NumberType::uint16 ||
                  indices.type == NumberType::uint32))
                document_.fail(format("accessor %u: expected indices, unsigned SCALAR", primitive.indices));
        }
        const std::uint64_t corners = indexed ? indices.count : positions.count;
        if (primitive.mode < 4) { // points, lines, a loop, a strip of lines
            const std::uint64_t loose[] = {corners, corners / 2, corners, corners - (corners > 0)};
            return surface_.skip(loose[primitive.mode]);
        }
        if (primitive.mode == 4 && corners % 3 != 0)
            document_.fail(format("expected a multiple of 3 corners, found %llu", llu(corners)));

        // Remembers the vertex of each position, unless that took longer than the corners themselves.
        const bool remember = positions.count <= corners;
        vertices_.assign(remember ? positions.count : 0, gltf::none);
        const auto vertex = [&](std::uint64_t corner) {
            const std::uint64_t index =
                indexed ? load_as<std::uint32_t>(indices.type, indices.at(corner), host_is_big_endian)
                        : corner;
            if (index >= positions.count)
                document_.fail(format("accessor %u: expected a vertex number below %llu, found %llu",
                                      primitive.indices, llu(positions.count), llu(index)));
            if (remember && vertices_[index] != gltf::none) return vertices_[index];
            const std::uint32_t found = place_vertex(positions, index, primitive.positions, world);
            if (remember) vertices_[index] = found;
            return found;
        };
        const bool mirrors = world.mirrors(); // what was outside stays outside
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mirrors ? surface_.triangle(a, c, b) : surface_.triangle(a, b, c);
        };
        if (corners < 3) return;
        if (primitive.mode == 4) {
            for (std::uint64_t i = 0; i < corners; i += 3) {
                const std::uint32_t a = vertex(i), b = vertex(i + 1);
                add(a, b, vertex(i + 2));
            }
            return;
        }
        std::uint32_t a = vertex(0), b = vertex(1);
        for (std::uint64_t i = 2; i < corners; ++i) {
            const std::uint32_t c = vertex(i);
            add(a, b, c);
            if (primitive.mode == 6) { // a fan
                b = c;
            } else if (i % 2 == 0) { // a strip
                a = c;
            } else {
                b = c;
            }
        }
    }

    std::uint32_t place_vertex(const Values& positions, std::uint64_t index, std::uint32_t accessor,
                               const Placement& world) {
        const char* const bytes = positions.at(index);
        double own[3], p[3];
        for (std::size_t k = 0; k < 3; ++k)
            own[k] = component(bytes + k * size_of(positions.type), positions.type, positions.normalized);
        world.apply(own, p);
        if (!is_finite(p))
            document_.fail(
                format("accessor %u, vertex %llu: expected a position, found a coordinate that is not finite",
                       accessor, llu(index)));
        return surface_.vertex(p);
    }

    gltf::Document document_;
    const gltf::Contents& contents_;
    std::uint32_t mesh_index_;
    SurfaceBuilder surface_;
    std::uint64_t primitives_left_; // as many as triangles: empty ones, shown many times, take time too
    std::vector<bool> visited_;     // nodes
    std::vector<Level> levels_;
    std::vector<std::uint32_t> vertices_; // of the positions of a primitive
};

} // namespace

MeshData read_gltf(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index) {
    return GltfReader(file, folder, mesh_index).read();
}

} // namespace vox::io
