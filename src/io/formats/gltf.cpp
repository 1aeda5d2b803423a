// glTF 2.0, .gltf and .glb (Khronos, glTF 2.0 Specification; ISO/IEC 12113): the triangles of the scene, with
// the transforms of its nodes. Skins, morph targets and animations are skipped. Buffers are in the file
// itself, in base64, or in files beside it.
#include "io/determinant.hpp"
#include "io/formats/gltf_document.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

namespace vox::io {
namespace {

using gltf::Primitive;
using gltf::Values;

struct Placement { // 3 x 4
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    Placement of(const Placement& child) const {
        Placement out;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) {
                out.m[i][j] = j == 3 ? m[i][3] : 0;
                for (int k = 0; k < 3; ++k) out.m[i][j] += m[i][k] * child.m[k][j];
            }
        return out;
    }
    bool mirrors() const { return determinant(m[0], m[1], m[2]) < 0; }
};

// A component as a number (section 3.6.2.2); normalized integers stand for -1 to 1 or 0 to 1 (section 3.11).
double component(const char* bytes, std::uint32_t type, bool normalized) {
    constexpr bool swap = host_is_big_endian;
    const auto scaled = [&](double value, double largest) {
        return normalized ? std::max(value / largest, -1.0) : value;
    };
    switch (type) {
    case gltf::int8:
        return scaled(load<std::int8_t>(bytes, swap), 127);
    case gltf::uint8:
        return scaled(load<std::uint8_t>(bytes, swap), 255);
    case gltf::int16:
        return scaled(load<std::int16_t>(bytes, swap), 32767);
    case gltf::uint16:
        return scaled(load<std::uint16_t>(bytes, swap), 65535);
    default:
        return static_cast<double>(load<float>(bytes, swap));
    }
}

std::uint32_t vertex_index(const char* bytes, std::uint32_t type) {
    constexpr bool swap = host_is_big_endian;
    return type == gltf::uint8    ? load<std::uint8_t>(bytes, swap)
           : type == gltf::uint16 ? load<std::uint16_t>(bytes, swap)
                                  : load<std::uint32_t>(bytes, swap);
}

class GltfReader {
public:
    GltfReader(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index)
        : document_(file, folder), mesh_index_(mesh_index),
          surface_(file.name, surface_limits(document_.bytes()), all_meshes),
          primitives_left_(surface_.limits().triangles) {
        const std::size_t meshes = document_.primitives().size();
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
    JsonReader& json() noexcept { return document_.json(); }

    struct Level { // of the tree of nodes: the children that are still to be visited
        Placement world;
        std::size_t next_at;
        bool more;
    };

    void add_scene() {
        visited_.assign(document_.nodes().size(), false);
        json().seek(document_.scene_at());
        std::size_t roots_at = 0;
        json().object([&](const std::string& name) {
            if (name == "nodes") roots_at = json().offset();
            json().skip();
        });
        if (roots_at) descend({}, roots_at);
        while (!levels_.empty()) {
            Level& level = levels_.back();
            if (!level.more) {
                levels_.pop_back();
                continue;
            }
            json().seek(level.next_at);
            const std::uint32_t node = json().index("the number of a node");
            level.more = json().another(']');
            level.next_at = json().offset();
            const Placement world = level.world;
            visit(node, world);
        }
    }

    void descend(const Placement& world, std::size_t children_at) {
        constexpr std::size_t most_levels = 1024;
        if (levels_.size() >= most_levels)
            document_.fail(format("nodes are nested deeper than %zu levels", most_levels), VOX_ERROR_LIMIT);
        json().seek(children_at);
        const bool more = json().enter('[', ']', "an array");
        levels_.push_back({world, json().offset(), more});
    }

    void visit(std::uint32_t node, const Placement& parent) {
        document_.check_number("a node", node, document_.nodes().size());
        if (visited_[node]) document_.fail(format("node %u is in the scene twice", node));
        visited_[node] = true;
        json().seek(document_.nodes()[node]);
        std::uint32_t mesh = gltf::none;
        std::size_t children_at = 0;
        Placement matrix;
        bool has_matrix = false;
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        json().object([&](const std::string& name) {
            if (name == "mesh") {
                mesh = json().index("the number of a mesh");
            } else if (name == "matrix") {
                double m[16];
                numbers(m, 16);
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 4; ++j) matrix.m[i][j] = m[4 * j + i];
                has_matrix = true;
            } else if (name == "translation") {
                numbers(translation, 3);
            } else if (name == "rotation") {
                numbers(rotation, 4);
            } else if (name == "scale") {
                numbers(scale, 3);
            } else {
                if (name == "children") children_at = json().offset();
                json().skip();
            }
        });
        if (!has_matrix) matrix = placed(translation, rotation, scale);
        const Placement world = parent.of(matrix);
        if (mesh != gltf::none) add_mesh(mesh, world);
        if (children_at) descend(world, children_at);
    }

    void numbers(double* out, std::size_t count) {
        std::size_t found = 0;
        const std::size_t at = json().offset();
        json().array([&] {
            const double number = json().number("a number");
            if (found < count) out[found] = number;
            ++found;
        });
        if (found == count) return;
        json().seek(at);
        json().fail(format("expected %zu numbers, found %zu", count, found));
    }

    // Scaled, rotated by a unit quaternion (x, y, z, w), then moved.
    static Placement placed(const double t[3], const double q[4], const double s[3]) {
        const double x = q[0], y = q[1], z = q[2], w = q[3];
        const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
        Placement out;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) out.m[i][j] = r[i][j] * s[j];
            out.m[i][3] = t[i];
        }
        return out;
    }

    void add_mesh(std::uint32_t mesh, const Placement& world) {
        document_.check_number("a mesh", mesh, document_.mesh_count());
        const std::size_t last = document_.first_primitive(mesh + std::size_t{1});
        for (std::size_t p = document_.first_primitive(mesh); p < last; ++p)
            if (mesh_index_ == all_meshes || mesh_index_ == p) {
                if (primitives_left_-- == 0)
                    document_.fail("the scene shows more primitives than the limit for a file of its size",
                                   VOX_ERROR_LIMIT);
                add_primitive(document_.primitives()[p], world);
            }
    }

    void add_primitive(const Primitive& primitive, const Placement& world) {
        if (primitive.mode > 6)
            document_.fail(format("expected a mode from 0 to 6, found %u", primitive.mode));
        if (primitive.positions == gltf::none) return surface_.skip(1);
        const Values positions = document_.values(primitive.positions);
        if (!document_.accessors()[primitive.positions].is_vec3 ||
            !(positions.type == gltf::float32 ||
              (positions.type >= gltf::int8 && positions.type <= gltf::uint16)))
            document_.fail(format("accessor %u: expected positions, of type VEC3", primitive.positions));
        const bool indexed = primitive.indices != gltf::none;
        Values indices;
        if (indexed) {
            indices = document_.values(primitive.indices);
            if (!document_.accessors()[primitive.indices].is_scalar ||
                !(indices.type == gltf::uint8 || indices.type == gltf::uint16 ||
                  indices.type == gltf::uint32))
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
                indexed ? vertex_index(indices.bytes + indices.stride * corner, indices.type) : corner;
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
        const char* const bytes = positions.bytes + positions.stride * index;
        double own[3], p[3];
        for (std::size_t k = 0; k < 3; ++k)
            own[k] =
                component(bytes + k * gltf::size_of(positions.type), positions.type, positions.normalized);
        for (int k = 0; k < 3; ++k) {
            const double* const row = world.m[k];
            p[k] = row[0] * own[0] + row[1] * own[1] + row[2] * own[2] + row[3];
            if (!std::isfinite(p[k]))
                document_.fail(format(
                    "accessor %u, vertex %llu: expected a position, found a coordinate that is not finite",
                    accessor, llu(index)));
        }
        return surface_.vertex(p);
    }

    gltf::Document document_;
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
