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

Document::Document(const File& file, const std::optional<std::string>& folder)
    : file_(file), folder_(folder) {
    if (file_.bytes.starts_with("glTF"))
        read_chunks();
    else
        contents_ = read_contents(file_, 0, file_.bytes);
    for (std::size_t b = 0; b < contents_.buffers.size(); ++b) load_buffer(b);
}

void Document::fail(const std::string& text, vox_result result) const {
    throw_error(result, "%s: %s", file_.name.c_str(), text.c_str());
}

void Document::check_number(const char* what, std::uint32_t number, std::size_t count) const {
    if (number >= count) fail(format("expected the number of %s below %zu, found %u", what, count, number));
}

std::uint64_t Document::bytes() const {
    std::uint64_t bytes = file_.bytes.size();
    for (const FileBytes& other : files_) bytes += other.file().bytes.size();
    return bytes;
}

// A .glb holds the JSON, and bytes (section 4.4).
void Document::read_chunks() {
    Scanner in(file_);
    in.count_bytes(true);
    const auto number = [&](const char* what) { return in.binary<std::uint32_t>(host_is_big_endian, what); };
    in.take(4, "glTF");
    const std::uint32_t version = number("a version");
    if (version != 2) in.unsupported("version %u: version 2 is read", version);
    const std::uint32_t length = number("the length of the file");
    if (length != file_.bytes.size())
        in.fail("expected the length of the file, %zu, found %u", file_.bytes.size(), length);
    const std::uint32_t json_length = number("the length of a chunk");
    if (std::string_view(in.take(4, "the type of a chunk"), 4) != "JSON")
        in.fail_at(glb_head + 4, "expected a chunk of type JSON first");
    const std::string_view json(in.take(json_length, "JSON"), json_length);
    if (in.remaining() >= glb_chunk_head) {
        const std::uint32_t binary_length = number("the length of a chunk");
        const std::string_view type(in.take(4, "the type of a chunk"), 4);
        const char* const bytes = in.take(binary_length, "a binary chunk");
        if (type == std::string_view("BIN\0", 4)) binary_ = {bytes, binary_length};
    }
    contents_ = read_contents(file_, glb_head + glb_chunk_head, json);
}

void Document::load_buffer(std::size_t number) {
    Buffer& buffer = contents_.buffers[number];
    if (!buffer.uri) {
        if (number == 0) buffer.bytes = binary_;
        return;
    }
    const std::string uri = std::move(*buffer.uri);
    const auto fail_here = [&](const std::string& text, vox_result result = VOX_ERROR_FORMAT) {
        fail(format("buffers[%zu].uri: %s", number, text.c_str()), result);
    };
    if (!uri.starts_with("data:")) {
        buffer.bytes = bytes_beside(uri, fail_here);
        return;
    }
    const std::size_t comma = std::min(uri.find(','), uri.size());
    const std::string_view text = std::string_view(uri).substr(comma);
    if (text.empty() || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
        fail_here(format("expected data in base64, found \"%s\"", printable(uri, 24).c_str()));
    buffer.bytes = decoded_.emplace_back(from_base64(text.substr(1), buffer.length, fail_here));
}

// A file in the folder of this one, or below. Nothing else is opened, whatever the document says.
std::string_view Document::bytes_beside(const std::string& uri, const Fail& fail_here) {
    if (!folder_)
        fail_here(
            format("a buffer is in another file, %s: load this one by its path", printable(uri, 200).c_str()),
            VOX_ERROR_FORMAT);
    const std::string name = without_percent(uri);
    if (name.size() > longest_name)
        fail_here(format("a buffer is in another file, whose name has %zu bytes, more than the limit of %zu",
                         name.size(), longest_name),
                  VOX_ERROR_LIMIT);
    bool inside = !name.empty() && name.find_first_of(":\\") == std::string::npos &&
                  name.find('\0') == std::string::npos;
    const std::filesystem::path relative = path_of(name).lexically_normal();
    inside = inside && relative.is_relative();
    for (const auto& part : relative) inside = inside && part != "..";
    if (!inside)
        fail_here(format("%s: only files in the same folder or below are read", printable(uri, 200).c_str()),
                  VOX_ERROR_UNSUPPORTED);
    const std::string path = utf8_of(path_of(*folder_) / relative);
    for (const FileBytes& other : files_)
        if (other.file().name == path) return other.file().bytes;
    if (files_.size() >= most_files)
        fail_here(format("more than %zu other files", most_files), VOX_ERROR_LIMIT);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path_of(path), error)) // opening a pipe would wait
        throw_error(VOX_ERROR_FILE, "%s, named in %s: %s", path.c_str(), file_.name.c_str(),
                    error ? error.message().c_str() : "is not a regular file");
    return files_.emplace_back(path).file().bytes;
}

StoredRun Document::run_of(const Stored& stored, std::uint64_t count, std::uint64_t components,
                           const std::string& what) const {
    const auto refuse_it = [&](const std::string& text) { fail(what + ": " + text); };
    constexpr std::uint32_t first_type = 5120;
    constexpr NumberType types[] = {NumberType::int8,   NumberType::uint8, NumberType::int16,
                                    NumberType::uint16, NumberType::int32, NumberType::uint32,
                                    NumberType::float32};
    if (stored.type < first_type || stored.type - first_type >= std::size(types))
        refuse_it(format("expected a component type from %u to %zu, found %u", first_type,
                         first_type + std::size(types) - 1, stored.type));
    const NumberType type = types[stored.type - first_type];
    const std::uint64_t element = size_of(type) * components;
    if (stored.view == none) return {nullptr, count, element, type};
    check_number("a buffer view", stored.view, contents_.views.size());
    const BufferView& view = contents_.views[stored.view];
    check_number("a buffer", view.buffer, contents_.buffers.size());
    const std::string_view bytes = contents_.buffers[view.buffer].bytes;
    if (view.offset > bytes.size() || view.length > bytes.size() - view.offset)
        refuse_it(format("its buffer view has bytes %llu to %llu of buffer %u, which has %zu",
                         llu(view.offset), llu(view.offset + view.length), view.buffer, bytes.size()));
    const std::uint64_t stride = view.stride ? view.stride : element;
    if (stride < element)
        refuse_it(format("expected values at least %llu bytes apart, found %llu", llu(element), llu(stride)));
    if (count == 0) return {nullptr, 0, stride, type};
    if (stored.offset > view.length || element > view.length - stored.offset ||
        count - 1 > (view.length - stored.offset - element) / stride)
        refuse_it(format("%llu values of %llu bytes do not fit into the %llu bytes of its buffer view",
                         llu(count), llu(element), llu(view.length)));
    return {bytes.data() + view.offset + stored.offset, count, stride, type};
}

Values Document::values(std::uint32_t number) const {
    check_number("an accessor", number, contents_.accessors.size());
    const Accessor& accessor = contents_.accessors[number];
    const std::string name = format("accessor %u", number);
    const std::uint64_t components = accessor.is_vec3 ? 3 : 1, sparse = accessor.sparse_count;
    Values out;
    out.dense = run_of(accessor.values, accessor.count, components, name);
    out.count = accessor.count;
    out.type = out.dense.type;
    out.normalized = accessor.normalized;
    if (sparse == 0) {
        if (accessor.values.view == none) fail(name + ": expected a buffer view, found none");
        return out;
    }
    // Zeros take no bytes.
    if (const std::uint64_t most = std::max<std::uint64_t>(bytes(), 1 << 17);
        accessor.values.view == none && accessor.count > most)
        fail(format("%s: %llu values without a buffer view are more than the limit of %llu", name.c_str(),
                    llu(accessor.count), llu(most)),
             VOX_ERROR_LIMIT);
    if (accessor.sparse_indices.view == none || accessor.sparse_values.view == none)
        fail(name + ".sparse: expected a buffer view, found none");
    out.sparse_indices = run_of(accessor.sparse_indices, sparse, 1, name + ".sparse.indices");
    out.sparse_values =
        run_of({accessor.sparse_values.offset, accessor.sparse_values.view, accessor.values.type}, sparse,
               components, name + ".sparse.values");
    const NumberType type = out.sparse_indices.type;
    if (type != NumberType::uint8 && type != NumberType::uint16 && type != NumberType::uint32)
        fail(format("%s.sparse.indices: expected an unsigned type, found %u", name.c_str(),
                    accessor.sparse_indices.type));
    for (std::uint64_t i = 0; i < sparse; ++i) {
        const std::uint32_t index = out.sparse_indices.integer(i);
        if (index >= accessor.count || (i > 0 && index <= out.sparse_indices.integer(i - 1)))
            fail(format("%s.sparse.indices: expected numbers below %llu that ascend, found %u at %llu",
                        name.c_str(), llu(accessor.count), index, llu(i)));
    }
    return out;
}

const char* Values::at(std::uint64_t index) const {
    static constexpr char zeros[3 * sizeof(float)] = {};
    std::uint64_t first = 0, last = sparse_indices.count;
    while (first < last) {
        const std::uint64_t middle = (first + last) / 2, found = sparse_indices.integer(middle);
        if (found == index) return sparse_values.at(middle);
        (found < index ? first : last) = found < index ? middle + 1 : middle;
    }
    return dense.bytes ? dense.at(index) : zeros;
}

} // namespace vox::io::gltf
