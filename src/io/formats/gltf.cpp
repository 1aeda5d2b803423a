// glTF 2.0, .gltf and .glb (Khronos, glTF 2.0 Specification; ISO/IEC 12113): the triangles of the scene, with the
// transforms of its nodes. Skins, morph targets and animations are skipped. Buffers are in the file itself, in base64,
// or in files beside it.
#include "io/determinant.hpp"
#include "io/formats/base64.hpp"
#include "io/formats/file_bytes.hpp"
#include "io/formats/json.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <deque>
#include <filesystem>
#include <optional>

namespace vox::io {
namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr std::size_t glb_head = 12, glb_chunk_head = 8;

struct Buffer {
    std::uint64_t length = 0;
    std::size_t uri_at = 0; // place of the text in the JSON; 0: none, the binary chunk
    std::string_view bytes;
};

struct BufferView {
    std::uint64_t offset = 0, length = 0;
    std::uint32_t buffer = none, stride = 0;
};

enum ComponentType : std::uint32_t {
    gltf_int8 = 5120,
    gltf_uint8,
    gltf_int16,
    gltf_uint16,
    gltf_uint32 = 5125,
    gltf_float
};

struct Accessor {
    std::uint64_t offset = 0, count = 0;
    std::uint32_t view = none;
    std::uint32_t type = 0; // a ComponentType
    bool normalized = false, is_vec3 = false, is_scalar = false, sparse = false;
};

struct Primitive {
    std::uint32_t positions = none, indices = none; // accessors
    std::uint32_t mode = 4;
};

struct Matrix { // 3 x 4
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    Matrix of(const Matrix& child) const {
        Matrix out;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) {
                out.m[i][j] = j == 3 ? m[i][3] : 0;
                for (int k = 0; k < 3; ++k) out.m[i][j] += m[i][k] * child.m[k][j];
            }
        return out;
    }
    bool mirrors() const { return determinant(m[0], m[1], m[2]) < 0; }
};

// The bytes of an accessor, with the distance from one value to the next.
struct Values {
    const char* bytes = nullptr;
    std::uint64_t count = 0, stride = 0;
    std::uint32_t type = 0;
    bool normalized = false;
};

std::uint64_t size_of(std::uint32_t type) {
    return type == gltf_int8 || type == gltf_uint8 ? 1 : type == gltf_int16 || type == gltf_uint16 ? 2 : 4;
}

// A component as a number (section 3.6.2.2); normalized integers stand for -1 to 1 or 0 to 1 (section 3.11).
double component(const char* bytes, std::uint32_t type, bool normalized) {
    constexpr bool swap = host_is_big_endian;
    const auto scaled = [&](double value, double largest) {
        return normalized ? std::max(value / largest, -1.0) : value;
    };
    switch (type) {
    case gltf_int8:
        return scaled(load<std::int8_t>(bytes, swap), 127);
    case gltf_uint8:
        return scaled(load<std::uint8_t>(bytes, swap), 255);
    case gltf_int16:
        return scaled(load<std::int16_t>(bytes, swap), 32767);
    case gltf_uint16:
        return scaled(load<std::uint16_t>(bytes, swap), 65535);
    default:
        return static_cast<double>(load<float>(bytes, swap));
    }
}

std::uint32_t vertex_index(const char* bytes, std::uint32_t type) {
    constexpr bool swap = host_is_big_endian;
    return type == gltf_uint8    ? load<std::uint8_t>(bytes, swap)
           : type == gltf_uint16 ? load<std::uint16_t>(bytes, swap)
                                 : load<std::uint32_t>(bytes, swap);
}

class GltfReader {
public:
    GltfReader(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index)
        : file_(file), folder_(folder), mesh_index_(mesh_index) {}

    MeshData read() {
        const bool binary = file_.bytes.starts_with("glTF");
        json_text_ = file_;
        std::size_t json_at = 0;
        if (binary) json_at = read_chunks();
        JsonReader json(json_text_, json_at, binary);
        json_ = &json;
        read_document();

        std::uint64_t bytes = file_.bytes.size();
        load_buffers();
        for (const OtherFile& other : files_) bytes += other.bytes.file().bytes.size();
        surface_.emplace(file_.name, most_triangles(bytes), VOX_IO_ALL_MESHES);
        add_scene();
        if (mesh_index_ != VOX_IO_ALL_MESHES && mesh_index_ >= primitives_.size())
            refuse(format("%s: mesh %u was asked for, but the file holds %zu", file_.name.c_str(), mesh_index_,
                          primitives_.size()));
        MeshData data = surface_->finish();
        data.unit_in_metres = 1;
        return data;
    }

private:
    [[noreturn]] void fail(const std::string& text, vox_result result = VOX_ERROR_FORMAT) const {
        throw Error(result, format("%s: %s", file_.name.c_str(), text.c_str()));
    }

    // Returns where the JSON of a .glb begins (section 4.4), and sets its end and binary_.
    std::size_t read_chunks() {
        Scanner in(file_);
        in.count_bytes(true);
        const auto number = [&](const char* what) { return in.binary<std::uint32_t>(host_is_big_endian, what); };
        in.take(4, "glTF");
        const std::uint32_t version = number("a version");
        if (version != 2) in.fail(format("version %u: version 2 is read", version), VOX_ERROR_UNSUPPORTED);
        const std::uint32_t length = number("the length of the file");
        if (length != file_.bytes.size())
            in.fail(format("expected the length of the file, %zu, found %u", file_.bytes.size(), length));
        const std::uint32_t json_length = number("the length of a chunk");
        if (in.take(4, "the type of a chunk") != std::string_view("JSON", 4)) {
            in.seek(glb_head + 4);
            in.fail("expected a chunk of type JSON first");
        }
        const std::size_t json_at = in.offset();
        in.take(json_length, "JSON");
        json_text_.bytes = file_.bytes.substr(0, in.offset());
        if (in.remaining() >= glb_chunk_head) {
            const std::uint32_t binary_length = number("the length of a chunk");
            const std::string_view type(in.take(4, "the type of a chunk"), 4);
            const char* const bytes = in.take(binary_length, "a binary chunk");
            if (type == std::string_view("BIN\0", 4)) binary_ = {bytes, binary_length};
        }
        return json_at;
    }

    // ---- the document: only what follows is kept, all else is skipped ----

    void read_document() {
        JsonReader& json = *json_;
        bool has_version = false;
        std::uint32_t scene = none;
        json.object([&](const std::string& name) {
            if (name == "asset")
                json.object([&](const std::string& key) {
                    if (key != "version") return json.skip();
                    read_version();
                    has_version = true;
                });
            else if (name == "extensionsRequired")
                json.array([&] { check_extension(); });
            else if (name == "scene")
                scene = json.index("the number of a scene");
            else if (name == "scenes")
                json.array([&] { note_place(scenes_); });
            else if (name == "nodes")
                json.array([&] { note_place(nodes_); });
            else if (name == "meshes")
                json.array([&] { read_mesh(); });
            else if (name == "accessors")
                json.array([&] { read_accessor(); });
            else if (name == "bufferViews")
                json.array([&] { read_view(); });
            else if (name == "buffers")
                json.array([&] { read_buffer(); });
            else
                json.skip();
        });
        json.end();
        if (!has_version) fail("expected asset.version, found none");
        if (scene == none) scene = 0;
        if (scene >= scenes_.size())
            fail(format("expected scene %u, found %zu scenes", scene, scenes_.size()));
        scene_at_ = scenes_[scene];
    }

    void read_version() {
        const std::size_t at = json_->offset();
        const std::string version = json_->string("a version");
        if (version.starts_with("2.")) return;
        json_->seek(at);
        json_->fail(format("version %s: version 2 is read", printable(version).c_str()), VOX_ERROR_UNSUPPORTED);
    }

    // Extensions that change how something looks are no obstacle.
    void check_extension() {
        const std::size_t at = json_->offset();
        const std::string name = json_->string("the name of an extension");
        for (const char* harmless : {"KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_",
                                     "EXT_texture_", "EXT_lights_"})
            if (name.starts_with(harmless)) return;
        json_->seek(at);
        json_->fail(format("the extension %s is required and not read", printable(name).c_str()),
                    VOX_ERROR_UNSUPPORTED);
    }

    void note_place(std::vector<std::size_t>& places) {
        places.push_back(json_->offset());
        json_->skip();
    }

    void read_mesh() {
        first_primitive_.push_back(static_cast<std::uint32_t>(primitives_.size()));
        json_->object([&](const std::string& name) {
            if (name != "primitives") return json_->skip();
            json_->array([&] { read_primitive(); });
        });
    }

    void read_primitive() {
        Primitive primitive;
        json_->object([&](const std::string& name) {
            if (name == "attributes")
                json_->object([&](const std::string& attribute) {
                    if (attribute != "POSITION") return json_->skip();
                    primitive.positions = json_->index("the number of an accessor");
                });
            else if (name == "indices")
                primitive.indices = json_->index("the number of an accessor");
            else if (name == "mode")
                primitive.mode = json_->index("a mode");
            else
                json_->skip();
        });
        primitives_.push_back(primitive);
    }

    void read_accessor() {
        Accessor accessor;
        const std::size_t at = json_->offset();
        bool has_count = false;
        json_->object([&](const std::string& name) {
            if (name == "bufferView") {
                accessor.view = json_->index("the number of a buffer view");
            } else if (name == "byteOffset") {
                accessor.offset = json_->count("an offset");
            } else if (name == "componentType") {
                accessor.type = json_->index("a component type");
            } else if (name == "normalized") {
                accessor.normalized = json_->boolean("true or false");
            } else if (name == "count") {
                accessor.count = json_->count("a number of values");
                has_count = true;
            } else if (name == "type") {
                const std::string type = json_->string("a type");
                accessor.is_vec3 = type == "VEC3";
                accessor.is_scalar = type == "SCALAR";
            } else {
                accessor.sparse = accessor.sparse || name == "sparse";
                json_->skip();
            }
        });
        if (!has_count || accessor.type == 0) fail_at(at, "expected an accessor with count and componentType");
        accessors_.push_back(accessor);
    }

    void read_view() {
        BufferView view;
        const std::size_t at = json_->offset();
        bool has_length = false;
        json_->object([&](const std::string& name) {
            if (name == "buffer") {
                view.buffer = json_->index("the number of a buffer");
            } else if (name == "byteOffset") {
                view.offset = json_->count("an offset");
            } else if (name == "byteLength") {
                view.length = json_->count("a length");
                has_length = true;
            } else if (name == "byteStride") {
                view.stride = json_->index("a stride");
            } else {
                json_->skip();
            }
        });
        if (!has_length || view.buffer == none) fail_at(at, "expected a buffer view with buffer and byteLength");
        views_.push_back(view);
    }

    void read_buffer() {
        Buffer buffer;
        const std::size_t at = json_->offset();
        bool has_length = false;
        json_->object([&](const std::string& name) {
            if (name == "byteLength") {
                buffer.length = json_->count("a length");
                has_length = true;
            } else {
                if (name == "uri") buffer.uri_at = json_->offset();
                json_->skip();
            }
        });
        if (!has_length) fail_at(at, "expected a buffer with byteLength");
        buffers_.push_back(buffer);
    }

    [[noreturn]] void fail_at(std::size_t place, const char* text) {
        json_->seek(place);
        json_->fail(text);
    }

    // ---- buffers ----

    void load_buffers() {
        for (std::size_t b = 0; b < buffers_.size(); ++b) {
            Buffer& buffer = buffers_[b];
            if (buffer.uri_at == 0) {
                if (b == 0) buffer.bytes = binary_;
                continue;
            }
            json_->seek(buffer.uri_at);
            const std::string uri = json_->string("a URI");
            json_->seek(buffer.uri_at);
            buffer.bytes = uri.starts_with("data:") ? decoded(uri, buffer.length) : bytes_beside(uri);
        }
    }

    std::string_view decoded(const std::string& uri, std::uint64_t length) {
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
            json_->expected("data in base64");
        return decoded_.emplace_back(from_base64(std::string_view(uri).substr(comma + 1), length,
                                                 [&](const std::string& text) { json_->fail(text); }));
    }

    // A file in the folder of this one, or below. Nothing else is opened, whatever the document says.
    std::string_view bytes_beside(const std::string& uri) {
        if (!folder_)
            json_->fail(format("a buffer is in another file, %s: load this one by its path",
                               printable(uri, 200).c_str()));
        for (const OtherFile& file : files_)
            if (file.uri == uri) return file.bytes.file().bytes;
        const std::string name = without_percent(uri);
        bool inside = !name.empty() && name.find_first_of(":\\") == std::string::npos &&
                      name.find('\0') == std::string::npos;
        const std::filesystem::path relative(name);
        inside = inside && relative.is_relative();
        for (const auto& part : relative) inside = inside && part != "..";
        if (!inside)
            json_->fail(format("%s: only files in the same folder or below are read", printable(uri, 200).c_str()),
                        VOX_ERROR_UNSUPPORTED);
        if (files_.size() >= most_files)
            json_->fail(format("more than %zu other files", most_files), VOX_ERROR_LIMIT);
        const std::string path = (std::filesystem::path(*folder_) / relative).string();
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) // opening a pipe would wait
            throw Error(VOX_ERROR_FILE, format("%s, named in %s, is not a regular file", path.c_str(),
                                               file_.name.c_str()));
        return files_.emplace_back(uri, path).bytes.file().bytes;
    }

    static std::string without_percent(std::string_view uri) {
        std::string out;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            unsigned code = 0;
            const char* const digits = uri.data() + i + 1;
            if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
                out += static_cast<char>(code);
                i += 2;
            } else {
                out += uri[i];
            }
        }
        return out;
    }

    // The values of an accessor, checked against the bytes that there are.
    Values values(std::uint32_t number) {
        if (number >= accessors_.size())
            fail(format("expected an accessor from 0 to %lld, found %u", lld(accessors_.size()) - 1, number));
        const Accessor& accessor = accessors_[number];
        const auto refuse_it = [&](const std::string& text, vox_result result = VOX_ERROR_FORMAT) {
            fail(format("accessor %u: %s", number, text.c_str()), result);
        };
        if (accessor.sparse) refuse_it("sparse accessors are not read", VOX_ERROR_UNSUPPORTED);
        if (accessor.view >= views_.size())
            refuse_it(format("expected a buffer view from 0 to %lld", lld(views_.size()) - 1));
        const BufferView& view = views_[accessor.view];
        if (view.buffer >= buffers_.size())
            refuse_it(format("expected a buffer from 0 to %lld, found %u", lld(buffers_.size()) - 1, view.buffer));
        const std::string_view bytes = buffers_[view.buffer].bytes;
        if (view.offset > bytes.size() || view.length > bytes.size() - view.offset)
            refuse_it(format("its buffer view has bytes %llu to %llu of buffer %u, which has %zu", llu(view.offset),
                             llu(view.offset + view.length), view.buffer, bytes.size()));
        const std::uint64_t element = size_of(accessor.type) * (accessor.is_vec3 ? 3 : 1);
        const std::uint64_t stride = view.stride ? view.stride : element;
        if (stride < element)
            refuse_it(format("expected values at least %llu bytes apart, found %llu", llu(element), llu(stride)));
        if (accessor.count > 0 && (accessor.offset > view.length || element > view.length - accessor.offset ||
                                   accessor.count - 1 > (view.length - accessor.offset - element) / stride))
            refuse_it(format("%llu values of %llu bytes do not fit into the %llu bytes of its buffer view",
                             llu(accessor.count), llu(element), llu(view.length)));
        return {bytes.data() + view.offset + accessor.offset, accessor.count, stride, accessor.type,
                accessor.normalized};
    }

    // ---- the scene ----

    struct Level { // of the tree of nodes: the children that are still to be visited
        Matrix world;
        std::size_t next_at;
        bool more;
    };

    void add_scene() {
        visited_.assign(nodes_.size(), false);
        json_->seek(scene_at_);
        std::size_t roots_at = 0;
        json_->object([&](const std::string& name) {
            if (name == "nodes") roots_at = json_->offset();
            json_->skip();
        });
        if (roots_at) descend({}, roots_at);
        while (!levels_.empty()) {
            Level& level = levels_.back();
            if (!level.more) {
                levels_.pop_back();
                continue;
            }
            json_->seek(level.next_at);
            const std::uint32_t node = json_->index("the number of a node");
            level.more = json_->another(']');
            level.next_at = json_->offset();
            const Matrix world = level.world;
            visit(node, world);
        }
    }

    void descend(const Matrix& world, std::size_t children_at) {
        constexpr std::size_t most_levels = 1024;
        if (levels_.size() >= most_levels)
            fail(format("nodes are nested deeper than %zu levels", most_levels), VOX_ERROR_LIMIT);
        json_->seek(children_at);
        const bool more = json_->enter('[', ']', "an array");
        levels_.push_back({world, json_->offset(), more});
    }

    void visit(std::uint32_t node, const Matrix& parent) {
        if (node >= nodes_.size())
            fail(format("expected a node from 0 to %lld, found %u", lld(nodes_.size()) - 1, node));
        if (visited_[node]) fail(format("node %u is in the scene twice", node));
        visited_[node] = true;
        json_->seek(nodes_[node]);
        std::uint32_t mesh = none;
        std::size_t children_at = 0;
        Matrix matrix;
        bool has_matrix = false;
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        json_->object([&](const std::string& name) {
            if (name == "mesh") {
                mesh = json_->index("the number of a mesh");
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
                if (name == "children") children_at = json_->offset();
                json_->skip();
            }
        });
        if (!has_matrix) matrix = placed(translation, rotation, scale);
        const Matrix world = parent.of(matrix);
        if (mesh != none) add_mesh(mesh, world);
        if (children_at) descend(world, children_at);
    }

    void numbers(double* out, std::size_t count) {
        std::size_t found = 0;
        const std::size_t at = json_->offset();
        json_->array([&] {
            const double number = json_->number("a number");
            if (found < count) out[found] = number;
            ++found;
        });
        if (found == count) return;
        json_->seek(at);
        json_->fail(format("expected %zu numbers, found %zu", count, found));
    }

    // Scaled, rotated by a unit quaternion (x, y, z, w), then moved.
    static Matrix placed(const double t[3], const double q[4], const double s[3]) {
        const double x = q[0], y = q[1], z = q[2], w = q[3];
        const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
        Matrix out;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) out.m[i][j] = r[i][j] * s[j];
            out.m[i][3] = t[i];
        }
        return out;
    }

    void add_mesh(std::uint32_t mesh, const Matrix& world) {
        if (mesh >= first_primitive_.size())
            fail(format("expected a mesh from 0 to %lld, found %u", lld(first_primitive_.size()) - 1, mesh));
        const std::size_t last =
            mesh + std::size_t{1} < first_primitive_.size() ? first_primitive_[mesh + std::size_t{1}] : primitives_.size();
        for (std::size_t p = first_primitive_[mesh]; p < last; ++p)
            if (mesh_index_ == VOX_IO_ALL_MESHES || mesh_index_ == p) add_primitive(primitives_[p], world);
    }

    void add_primitive(const Primitive& primitive, const Matrix& world) {
        if (primitive.mode > 6) fail(format("expected a mode from 0 to 6, found %u", primitive.mode));
        if (primitive.positions == none) return surface_->skip(1);
        const Values positions = values(primitive.positions);
        if (!accessors_[primitive.positions].is_vec3 ||
            !(positions.type == gltf_float || (positions.type >= gltf_int8 && positions.type <= gltf_uint16)))
            fail(format("accessor %u: expected positions, of type VEC3", primitive.positions));
        const bool indexed = primitive.indices != none;
        Values indices;
        if (indexed) {
            indices = values(primitive.indices);
            if (!accessors_[primitive.indices].is_scalar ||
                !(indices.type == gltf_uint8 || indices.type == gltf_uint16 || indices.type == gltf_uint32))
                fail(format("accessor %u: expected indices, unsigned SCALAR", primitive.indices));
        }
        const std::uint64_t corners = indexed ? indices.count : positions.count;
        if (primitive.mode < 4) { // points, lines, a loop, a strip of lines
            const std::uint64_t loose[] = {corners, corners / 2, corners, corners - (corners > 0)};
            return surface_->skip(loose[primitive.mode]);
        }
        if (primitive.mode == 4 && corners % 3 != 0)
            fail(format("expected a multiple of 3 corners, found %llu", llu(corners)));

        // Remembers the vertex of each position, unless that took longer than the corners themselves.
        const bool remember = positions.count <= corners;
        vertices_.assign(remember ? positions.count : 0, none);
        const auto vertex = [&](std::uint64_t corner) {
            const std::uint64_t index =
                indexed ? vertex_index(indices.bytes + indices.stride * corner, indices.type) : corner;
            if (index >= positions.count)
                fail(format("accessor %u: expected a vertex number below %llu, found %llu", primitive.indices,
                            llu(positions.count), llu(index)));
            if (remember && vertices_[index] != none) return vertices_[index];
            const std::uint32_t found = place_vertex(positions, index, primitive.positions, world);
            if (remember) vertices_[index] = found;
            return found;
        };
        const bool mirrors = world.mirrors(); // what was outside stays outside
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mirrors ? surface_->triangle(a, c, b) : surface_->triangle(a, b, c);
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
                               const Matrix& world) {
        const char* const bytes = positions.bytes + positions.stride * index;
        double own[3], p[3];
        for (std::size_t k = 0; k < 3; ++k)
            own[k] = component(bytes + k * size_of(positions.type), positions.type, positions.normalized);
        for (int k = 0; k < 3; ++k) {
            const double* const row = world.m[k];
            p[k] = row[0] * own[0] + row[1] * own[1] + row[2] * own[2] + row[3];
            if (!std::isfinite(p[k]))
                fail(format("accessor %u, vertex %llu: expected a position, found a coordinate that is not finite",
                            accessor, llu(index)));
        }
        return surface_->vertex(p);
    }

    struct OtherFile {
        OtherFile(const std::string& its_uri, const std::string& path) : uri(its_uri), bytes(path) {}
        std::string uri;
        FileBytes bytes;
    };
    static constexpr std::size_t most_files = 64;

    const File& file_;
    const std::optional<std::string>& folder_;
    std::uint32_t mesh_index_;
    File json_text_;            // the file up to the end of the JSON
    std::string_view binary_;   // the binary chunk of a .glb
    JsonReader* json_ = nullptr;
    std::vector<std::size_t> scenes_, nodes_; // places in the JSON: their objects are read when they are visited
    std::vector<std::uint32_t> first_primitive_; // of each mesh
    std::vector<Primitive> primitives_;
    std::vector<Accessor> accessors_;
    std::vector<BufferView> views_;
    std::vector<Buffer> buffers_;
    std::deque<std::string> decoded_;
    std::deque<OtherFile> files_;
    std::size_t scene_at_ = 0;
    std::vector<bool> visited_;
    std::vector<Level> levels_;
    std::vector<std::uint32_t> vertices_;
    std::optional<SurfaceBuilder> surface_;
};

} // namespace

MeshData read_gltf(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index) {
    return GltfReader(file, folder, mesh_index).read();
}

} // namespace vox::io
