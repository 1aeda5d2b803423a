#include "io/formats/gltf_document.hpp"

#include "io/formats/base64.hpp"
#include "io/formats/paths.hpp"

#include <filesystem>

namespace vox::io::gltf {
namespace {

constexpr std::size_t glb_head = 12, glb_chunk_head = 8, most_files = 64, longest_name = 4096;

std::string without_percent(std::string_view uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            out += static_cast<char>(code);
            i += 2;
        } else {
            out += uri[i];
        }
    }
    return out;
}

} // namespace

std::uint64_t size_of(std::uint32_t type) {
    return type == int8 || type == uint8 ? 1 : type == int16 || type == uint16 ? 2 : 4;
}

Document::Document(const File& file, const std::optional<std::string>& folder)
    : file_(file), folder_(folder), json_text_(file) {
    const bool binary = file_.bytes.starts_with("glTF");
    const std::size_t json_at = binary ? read_chunks() : 0;
    json_.emplace(json_text_, json_at, binary);
    read_document();
    load_buffers();
}

void Document::fail(const std::string& text, vox_result result) const {
    throw Error(result, format("%s: %s", file_.name.c_str(), text.c_str()));
}

void Document::check_number(const char* what, std::uint32_t number, std::size_t count) const {
    if (number >= count) fail(format("expected the number of %s below %zu, found %u", what, count, number));
}

std::uint64_t Document::bytes() const {
    std::uint64_t bytes = file_.bytes.size();
    for (const FileBytes& other : files_) bytes += other.file().bytes.size();
    return bytes;
}

// Returns where the JSON of a .glb begins (section 4.4), and sets its end and binary_.
std::size_t Document::read_chunks() {
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
    if (std::string_view(in.take(4, "the type of a chunk"), 4) != "JSON") {
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

void Document::read_document() {
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
    if (scene >= scenes_.size()) fail(format("expected scene %u, found %zu scenes", scene, scenes_.size()));
    scene_at_ = scenes_[scene];
}

void Document::read_version() {
    const std::size_t at = json_->offset();
    const std::string version = json_->string("a version");
    if (version.starts_with("2.")) return;
    json_->seek(at);
    json_->fail(format("version %s: version 2 is read", printable(version).c_str()), VOX_ERROR_UNSUPPORTED);
}

// Extensions that change how something looks are no obstacle.
void Document::check_extension() {
    const std::size_t at = json_->offset();
    const std::string name = json_->string("the name of an extension");
    for (const char* harmless : {"KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_",
                                 "EXT_texture_", "EXT_lights_"})
        if (name.starts_with(harmless)) return;
    json_->seek(at);
    json_->fail(format("the extension %s is required and not read", printable(name).c_str()),
                VOX_ERROR_UNSUPPORTED);
}

void Document::note_place(std::deque<std::size_t>& places) {
    places.push_back(json_->offset());
    json_->skip();
}

void Document::read_mesh() {
    first_primitive_.push_back(static_cast<std::uint32_t>(primitives_.size()));
    json_->object([&](const std::string& name) {
        if (name != "primitives") return json_->skip();
        json_->array([&] { read_primitive(); });
    });
}

void Document::read_primitive() {
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

void Document::read_accessor() {
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

void Document::read_view() {
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

void Document::read_buffer() {
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

void Document::fail_at(std::size_t place, const char* text) {
    json_->seek(place);
    json_->fail(text);
}

// ---- buffers ----

void Document::load_buffers() {
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

std::string_view Document::decoded(const std::string& uri, std::uint64_t length) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
        json_->expected("data in base64");
    return decoded_.emplace_back(from_base64(std::string_view(uri).substr(comma + 1), length,
                                             [&](const std::string& text) { json_->fail(text); }));
}

// A file in the folder of this one, or below. Nothing else is opened, whatever the document says.
std::string_view Document::bytes_beside(const std::string& uri) {
    if (!folder_)
        json_->fail(format("a buffer is in another file, %s: load this one by its path",
                           printable(uri, 200).c_str()));
    const std::string name = without_percent(uri);
    if (name.size() > longest_name)
        json_->fail(
            format("a buffer is in another file, whose name has %zu bytes, more than the limit of %zu",
                   name.size(), longest_name),
            VOX_ERROR_LIMIT);
    bool inside = !name.empty() && name.find_first_of(":\\") == std::string::npos &&
                  name.find('\0') == std::string::npos;
    const std::filesystem::path relative = path_of(name).lexically_normal();
    inside = inside && relative.is_relative();
    for (const auto& part : relative) inside = inside && part != "..";
    if (!inside)
        json_->fail(
            format("%s: only files in the same folder or below are read", printable(uri, 200).c_str()),
            VOX_ERROR_UNSUPPORTED);
    const std::string path = utf8_of(path_of(*folder_) / relative);
    for (const FileBytes& other : files_)
        if (other.file().name == path) return other.file().bytes;
    if (files_.size() >= most_files)
        json_->fail(format("more than %zu other files", most_files), VOX_ERROR_LIMIT);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path_of(path), error)) // opening a pipe would wait
        throw Error(VOX_ERROR_FILE, format("%s, named in %s: %s", path.c_str(), file_.name.c_str(),
                                           error ? error.message().c_str() : "is not a regular file"));
    return files_.emplace_back(path).file().bytes;
}

Values Document::values(std::uint32_t number) const {
    check_number("an accessor", number, accessors_.size());
    const Accessor& accessor = accessors_[number];
    const auto refuse_it = [&](const std::string& text, vox_result result = VOX_ERROR_FORMAT) {
        fail(format("accessor %u: %s", number, text.c_str()), result);
    };
    if (accessor.sparse) refuse_it("sparse accessors are not read", VOX_ERROR_UNSUPPORTED);
    if (accessor.view == none) refuse_it("expected a buffer view, found none");
    check_number("a buffer view", accessor.view, views_.size());
    const BufferView& view = views_[accessor.view];
    check_number("a buffer", view.buffer, buffers_.size());
    const std::string_view bytes = buffers_[view.buffer].bytes;
    if (view.offset > bytes.size() || view.length > bytes.size() - view.offset)
        refuse_it(format("its buffer view has bytes %llu to %llu of buffer %u, which has %zu",
                         llu(view.offset), llu(view.offset + view.length), view.buffer, bytes.size()));
    const std::uint64_t element = size_of(accessor.type) * (accessor.is_vec3 ? 3 : 1);
    const std::uint64_t stride = view.stride ? view.stride : element;
    if (stride < element)
        refuse_it(format("expected values at least %llu bytes apart, found %llu", llu(element), llu(stride)));
    if (accessor.count == 0) return {nullptr, 0, stride, accessor.type, accessor.normalized};
    if (accessor.offset > view.length || element > view.length - accessor.offset ||
        accessor.count - 1 > (view.length - accessor.offset - element) / stride)
        refuse_it(format("%llu values of %llu bytes do not fit into the %llu bytes of its buffer view",
                         llu(accessor.count), llu(element), llu(view.length)));
    return {bytes.data() + view.offset + accessor.offset, accessor.count, stride, accessor.type,
            accessor.normalized};
}

} // namespace vox::io::gltf
