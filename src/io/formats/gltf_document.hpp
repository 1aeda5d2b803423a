// What a glTF file says: its numbers checked, its buffers at hand. formats/gltf.cpp makes triangles of it.
#pragma once

#include "io/formats/file_bytes.hpp"
#include "io/formats/number_type.hpp"
#include "io/formats/placement.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox::io::gltf {

inline constexpr std::uint32_t none = 0xffffffffu;

struct Buffer {
    std::uint64_t length = 0;
    std::optional<std::string> uri; // none: the binary chunk
    std::string_view bytes;
};

struct BufferView {
    std::uint64_t offset = 0, length = 0;
    std::uint32_t buffer = none, stride = 0;
};

struct Stored { // values in a buffer view
    std::uint64_t offset = 0;
    std::uint32_t view = none;
    std::uint32_t type = 0; // as in the file
};

struct Accessor {
    Stored values; // without a view: zeros
    std::uint64_t count = 0, sparse_count = 0;
    Stored sparse_indices, sparse_values; // which values are others, and what they are
    bool normalized = false, is_vec3 = false, is_scalar = false;
};

struct Primitive {
    std::uint32_t positions = none, indices = none; // accessors
    std::uint32_t mode = 4;
};

struct SceneNode {
    std::uint32_t mesh = none;
    std::uint32_t placement = none; // none: that of its parent
    std::uint32_t children_end = 0; // they begin where those of the node before end
};

// Only this is kept of a document; all else is skipped. It takes at most 6 times the text: 12 bytes for an
// empty node or primitive, "{},", and 108 for a node with a placement, {"scale":[1,1,1]}. The deques hold
// pieces of 512 bytes, so that none of it is ever there twice.
struct Contents {
    std::uint32_t scene = 0;                    // of several
    std::deque<std::uint32_t> roots, roots_end; // nodes, and where those of each scene end
    std::deque<SceneNode> nodes;
    std::deque<std::uint32_t> children;
    std::deque<Placement> placements;
    std::deque<std::uint32_t> first_primitive; // of each mesh
    std::deque<Primitive> primitives;
    std::deque<Accessor> accessors;
    std::deque<BufferView> views;
    std::deque<Buffer> buffers;
};

// Reads `text`, the JSON of the file from byte `first` on. Errors name the file and the value, as in
// accessors[3].count, or where the text is no JSON.
Contents read_contents(const File& file, std::size_t first, std::string_view text);

// Bytes of values, with the distance from one to the next.
struct StoredRun {
    const char* bytes = nullptr;
    std::uint64_t count = 0, stride = 0;
    NumberType type{};

    const char* at(std::uint64_t index) const { return bytes + stride * index; }
    std::uint32_t integer(std::uint64_t index) const {
        return load_as<std::uint32_t>(type, at(index), host_is_big_endian);
    }
};

// The values of an accessor.
struct Values {
    StoredRun dense; // bytes null: zeros
    StoredRun sparse_indices, sparse_values;
    std::uint64_t count = 0;
    NumberType type{};
    bool normalized = false;

    const char* at(std::uint64_t index) const;
};

class Document {
public:
    // Files that the document names are looked for in `folder`; without one it must be complete.
    Document(const File& file, const std::optional<std::string>& folder);

    const Contents& contents() const noexcept { return contents_; }
    // The values of an accessor, checked against the bytes that there are.
    Values values(std::uint32_t accessor) const;
    // The bytes of the file, and of those that it names.
    std::uint64_t bytes() const;

    [[noreturn]] void fail(const std::string& text, vox_result result = VOX_ERROR_FORMAT) const;
    // Fails unless number < count.
    void check_number(const char* what, std::uint32_t number, std::size_t count) const;

private:
    using Fail = std::function<void(const std::string& text, vox_result result)>;

    void read_chunks();
    // `count` values of `components` numbers. `what` names them in errors.
    StoredRun run_of(const Stored& stored, std::uint64_t count, std::uint64_t components,
                     const std::string& what) const;
    void load_buffer(std::size_t number);
    std::string_view bytes_beside(const std::string& uri, const Fail& fail_here);

    const File& file_;
    const std::optional<std::string>& folder_;
    Contents contents_;
    std::string_view binary_; // the binary chunk of a .glb
    std::deque<std::string> decoded_;
    std::deque<FileBytes> files_;
};

} // namespace vox::io::gltf
