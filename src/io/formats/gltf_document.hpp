// What a glTF file says: its numbers checked, its buffers at hand. formats/gltf.cpp makes triangles of it.
#pragma once

#include "io/formats/file_bytes.hpp"
#include "io/formats/json.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox::io::gltf {

inline constexpr std::uint32_t none = 0xffffffffu;

struct Buffer {
    std::uint64_t length = 0;
    std::size_t uri_at = 0; // place of the text in the JSON; 0: none, the binary chunk
    std::string_view bytes;
};

struct BufferView {
    std::uint64_t offset = 0, length = 0;
    std::uint32_t buffer = none, stride = 0;
};

enum ComponentType : std::uint32_t { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

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

// The bytes of an accessor, with the distance from one value to the next.
struct Values {
    const char* bytes = nullptr;
    std::uint64_t count = 0, stride = 0;
    std::uint32_t type = 0;
    bool normalized = false;
};

std::uint64_t size_of(std::uint32_t component_type);

// Only what follows is kept of a document; all else is skipped. That takes less memory than usual text, and
// at most 4.3 times the text, for empty primitives: 12 bytes for each "{},", in pieces of 512. Objects of
// scenes and nodes are read when they are visited.
class Document {
public:
    // Files that the document names are looked for in `folder`; without one it must be complete.
    Document(const File& file, const std::optional<std::string>& folder);

    JsonReader& json() noexcept { return *json_; }
    std::size_t scene_at() const noexcept { return scene_at_; } // place of the scene's object in the JSON
    const std::deque<std::size_t>& nodes() const noexcept { return nodes_; } // the same for each node
    std::size_t mesh_count() const noexcept { return first_primitive_.size(); }
    // Those of mesh m begin with first_primitive(m), and end where those of the next one begin.
    std::size_t first_primitive(std::size_t mesh) const noexcept {
        return mesh < first_primitive_.size() ? first_primitive_[mesh] : primitives_.size();
    }
    const std::deque<Primitive>& primitives() const noexcept { return primitives_; }
    const std::vector<Accessor>& accessors() const noexcept { return accessors_; }

    // The values of an accessor, checked against the bytes that there are.
    Values values(std::uint32_t accessor) const;
    // The bytes of the file, and of those that it names.
    std::uint64_t bytes() const;

    [[noreturn]] void fail(const std::string& text, vox_result result = VOX_ERROR_FORMAT) const;
    // Fails unless number < count.
    void check_number(const char* what, std::uint32_t number, std::size_t count) const;

private:
    std::size_t read_chunks();
    void read_document();
    void read_version();
    void check_extension();
    void note_place(std::deque<std::size_t>& places);
    void read_mesh();
    void read_primitive();
    void read_accessor();
    void read_view();
    void read_buffer();
    [[noreturn]] void fail_at(std::size_t place, const char* text);

    void load_buffers();
    std::string_view decoded(const std::string& uri, std::uint64_t length);
    std::string_view bytes_beside(const std::string& uri);

    const File& file_;
    const std::optional<std::string>& folder_;
    File json_text_;          // the file up to the end of the JSON
    std::string_view binary_; // the binary chunk of a .glb
    std::optional<JsonReader> json_;
    std::deque<std::size_t> scenes_, nodes_;
    std::vector<std::uint32_t> first_primitive_; // of each mesh
    std::deque<Primitive> primitives_;
    std::vector<Accessor> accessors_;
    std::vector<BufferView> views_;
    std::vector<Buffer> buffers_;
    std::deque<std::string> decoded_;
    std::deque<FileBytes> files_;
    std::size_t scene_at_ = 0;
};

} // namespace vox::io::gltf
