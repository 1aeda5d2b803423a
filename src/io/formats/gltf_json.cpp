// Reads the JSON of glTF value by value, without building a tree, which would take many times the memory of
// the text.
#include "io/formats/gltf_document.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace vox::io::gltf {
namespace {

using nlohmann::json;

// The objects and arrays that are read; others are skipped. Every object in an array ends with [].
constexpr std::string_view read_objects[] = {"",
                                             ".asset",
                                             ".scenes[]",
                                             ".nodes[]",
                                             ".meshes[]",
                                             ".meshes[].primitives[]",
                                             ".meshes[].primitives[].attributes",
                                             ".accessors[]",
                                             ".accessors[].sparse",
                                             ".accessors[].sparse.indices",
                                             ".accessors[].sparse.values",
                                             ".bufferViews[]",
                                             ".buffers[]"};
constexpr std::string_view read_arrays[] = {
    ".extensionsRequired",  ".scenes",         ".scenes[].nodes",      ".nodes",
    ".nodes[].children",    ".nodes[].matrix", ".nodes[].rotation",    ".nodes[].scale",
    ".nodes[].translation", ".meshes",         ".meshes[].primitives", ".accessors",
    ".bufferViews",         ".buffers"};

// Receives the values in their order, as json::sax_parse passes them on.
class ContentsReader {
public:
    ContentsReader(const File& file, std::size_t first) : file_(file), first_(first) {}

    Contents finish() {
        if (!has_version_) fail("expected asset.version, found none");
        if (out_.roots_end.empty() && !has_scene_) show_all();
        if (out_.scene >= out_.roots_end.size())
            fail(format("expected scene %u, found %zu scenes", out_.scene, out_.roots_end.size()));
        return std::move(out_);
    }

    bool null() { return scalar(nullptr); }
    bool boolean(bool value) { return scalar(value); }
    bool number_integer(std::int64_t value) { return scalar(value); }
    bool number_unsigned(std::uint64_t value) { return scalar(value); }
    bool number_float(double value, const std::string&) { return scalar(value); }
    bool string(std::string& value) { return scalar(std::move(value)); }
    bool binary(json::binary_t&) { return true; } // there is none in text
    bool start_object(std::size_t) { return start(json::object()); }
    bool start_array(std::size_t) { return start(json::array()); }
    bool end_object() { return end(); }
    bool end_array() { return end(); }
    bool key(const std::string& name) {
        if (skipped_ > 0) return true;
        path_.resize(levels_.back().path);
        if (!is_part()) object_ = path_.size();
        // A name may look like a path.
        path_.append(".").append(name.find_first_of(".[") == std::string::npos ? name : "?");
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const json::exception& error) {
        std::string_view text = error.what(); // [json.exception.KIND] parse error at PLACE: TEXT
        for (const std::string_view mark : {"] ", "parse error at", ": "})
            text.remove_prefix(text.find(mark) < text.size() ? text.find(mark) + mark.size() : 0);
        Scanner in(file_);
        in.count_bytes(first_ > 0);
        in.fail_at(first_ + std::max<std::size_t>(position, 1) - 1, "expected JSON, found this: %s",
                   printable(text, 200).c_str());
    }

private:
    struct Level {            // an object or array that is not yet at its end
        std::size_t path;     // the length of its path
        std::uint64_t number; // of the element at hand, in an array
    };

    // ---- the way through the document ----

    // Whether the object at hand is a part of the one around it, of which its members are members, too.
    bool is_part() const {
        return path_.ends_with(".attributes") || path_.starts_with(".accessors[].sparse");
    }

    // Whether the value at hand is to be an object or an array; fails if `found` is something else.
    bool is_read(const json& found) {
        const auto fits = [&](const auto& list, json::value_t type, const char* what) {
            const bool listed = std::find(std::begin(list), std::end(list), path_) != std::end(list);
            if (listed && found.type() != type) expected(what, found);
            return listed;
        };
        return fits(read_objects, json::value_t::object, "an object") ||
               fits(read_arrays, json::value_t::array, "an array");
    }

    bool start(const json& empty) {
        if (skipped_ > 0 || !is_read(empty)) {
            if (skipped_++ == 0) keep(empty);
            return true;
        }
        if (path_ == ".meshes[]")
            out_.first_primitive.push_back(static_cast<std::uint32_t>(out_.primitives.size()));
        levels_.push_back({path_.size(), 0});
        if (empty.is_array()) {
            members_[path_.substr(object_ + 1)] = empty;
            path_ += "[]";
        } else if (!is_part()) {
            members_.clear();
            numbers_.clear();
        }
        return true;
    }

    bool end() {
        if (skipped_ == 0) {
            path_.resize(levels_.back().path);
            levels_.pop_back();
            end_object_or_array();
            member_ = nullptr;
        } else if (--skipped_ > 0) {
            return true;
        }
        return pass_element();
    }

    bool scalar(json value) {
        if (skipped_ > 0) return true;
        (void)is_read(value);
        keep(std::move(value));
        return pass_element();
    }

    bool pass_element() {
        if (path_.ends_with(']')) ++levels_.back().number;
        return true;
    }

    void end_object_or_array() {
        if (path_ == ".asset") read_version();
        if (path_ == ".scenes[]") out_.roots_end.push_back(static_cast<std::uint32_t>(out_.roots.size()));
        if (path_ == ".nodes[]") add_node();
        if (path_ == ".meshes[].primitives[]")
            out_.primitives.push_back({index("attributes.POSITION", "the number of an accessor"),
                                       index("indices", "the number of an accessor"),
                                       index("mode", "a mode", 4)});
        if (path_ == ".accessors[]") add_accessor();
        if (path_ == ".bufferViews[]") add_view();
        if (path_ == ".buffers[]") add_buffer();
    }

    // ---- what is in it ----

    // Takes an element of an array, or keeps a member of the object at hand.
    void keep(json value) {
        constexpr std::size_t most_members = 1000;
        if (path_ == ".extensionsRequired[]") return check_extension(text(value, "the name of an extension"));
        if (path_ == ".scenes[].nodes[]") return out_.roots.push_back(index(value, "the number of a node"));
        if (path_ == ".nodes[].children[]")
            return out_.children.push_back(index(value, "the number of a node"));
        if (path_ == ".scene") {
            has_scene_ = true;
            return void(out_.scene = index(value, "the number of a scene"));
        }
        if (members_.size() >= most_members)
            fail(format("an object has more than %zu members", most_members), VOX_ERROR_LIMIT);
        std::string name = path_.substr(object_ + 1);
        if (!name.ends_with(']')) {
            members_[name] = std::move(value);
            return;
        }
        if (!value.is_number()) expected("a number", value);
        name.resize(name.size() - 2);
        if (numbers_[name].size() <= 16) numbers_[name].push_back(value.get<double>());
    }

    // Extensions that change how something looks are no obstacle.
    void check_extension(const std::string& name) const {
        for (const char* harmless : {"KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_",
                                     "EXT_texture_", "EXT_lights_"})
            if (name.starts_with(harmless)) return;
        fail(format("the extension %s is required and not read", printable(name).c_str()),
             VOX_ERROR_UNSUPPORTED);
    }
    void read_version() {
        const json* const version = member("version");
        if (!version) return;
        if (!text(*version, "a version").starts_with("2."))
            fail(format("version %s: version 2 is read", printable(text(*version, "")).c_str()),
                 VOX_ERROR_UNSUPPORTED);
        has_version_ = true;
    }

    void add_node() {
        SceneNode& node = out_.nodes.emplace_back();
        node.mesh = index("mesh", "the number of a mesh");
        node.children_end = static_cast<std::uint32_t>(out_.children.size());
        double matrix[16], translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        const bool moved = numbers("translation", translation), turned = numbers("rotation", rotation),
                   scaled = numbers("scale", scale), has_matrix = numbers("matrix", matrix);
        if (!moved && !turned && !scaled && !has_matrix) return;
        if (turned) normalize(rotation);
        if (has_matrix && (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1)) {
            member_ = "matrix";
            fail(format("expected 0 0 0 1 as the last row, found %g %g %g %g", matrix[3], matrix[7],
                        matrix[11], matrix[15]));
        }
        node.placement = static_cast<std::uint32_t>(out_.placements.size());
        Placement& placement = out_.placements.emplace_back(placed(translation, rotation, scale));
        for (std::size_t i = 0; i < 12 && has_matrix; ++i)
            placement.m[i % 3][i / 3] = matrix[i / 3 * 4 + i % 3];
    }

    // Without scenes: the nodes that are not below others.
    void show_all() {
        std::vector<bool> is_below(out_.nodes.size());
        for (const std::uint32_t child : out_.children)
            if (child < is_below.size()) is_below[child] = true;
        for (std::uint32_t n = 0; n < is_below.size(); ++n)
            if (!is_below[n]) out_.roots.push_back(n);
        out_.roots_end.push_back(static_cast<std::uint32_t>(out_.roots.size()));
    }

    // Programs round a unit quaternion; whatever else it is, it would also scale.
    void normalize(double (&q)[4]) {
        double length = 0;
        for (const double x : q) length += x * x;
        length = std::sqrt(length);
        if (!(std::fabs(length - 1) <= 0.01)) {
            member_ = "rotation";
            fail(format("expected a quaternion of length 1, within 0.01, found %g %g %g %g, of length %g",
                        q[0], q[1], q[2], q[3], length));
        }
        for (double& x : q) x /= length;
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

    void add_accessor() {
        Accessor& accessor = out_.accessors.emplace_back();
        accessor.values = {count("byteOffset", "an offset", 0),
                           index("bufferView", "the number of a buffer view"),
                           index("componentType", "a component type", 0)};
        accessor.count = count("count", "a number of values", missing);
        accessor.sparse_count = count("sparse.count", "a number of values", 0);
        accessor.sparse_indices = {count("sparse.indices.byteOffset", "an offset", 0),
                                   index("sparse.indices.bufferView", "the number of a buffer view"),
                                   index("sparse.indices.componentType", "a component type", 0)};
        accessor.sparse_values = {count("sparse.values.byteOffset", "an offset", 0),
                                  index("sparse.values.bufferView", "the number of a buffer view"), 0};
        if (const json* const normalized = member("normalized")) {
            if (!normalized->is_boolean()) expected("true or false", *normalized);
            accessor.normalized = *normalized;
        }
        if (const json* const type = member("type")) {
            const std::string& name = text(*type, "a type");
            accessor.is_vec3 = name == "VEC3";
            accessor.is_scalar = name == "SCALAR";
        }
        demand(accessor.count != missing && accessor.values.type != 0,
               "an accessor with count and componentType");
    }
    void add_view() {
        BufferView& view = out_.views.emplace_back();
        view.buffer = index("buffer", "the number of a buffer");
        view.offset = count("byteOffset", "an offset", 0);
        view.length = count("byteLength", "a length", missing);
        view.stride = index("byteStride", "a stride", 0);
        demand(view.length != missing && view.buffer != none, "a buffer view with buffer and byteLength");
    }
    void add_buffer() {
        Buffer& buffer = out_.buffers.emplace_back();
        buffer.length = count("byteLength", "a length", missing);
        demand(buffer.length != missing, "a buffer with byteLength");
        if (json* const uri = member("uri")) {
            (void)text(*uri, "a URI");
            buffer.uri = std::move(uri->get_ref<std::string&>());
        }
    }

    // ---- values ----

    // That of the object at hand, or null. Failures name it from now on.
    json* member(const char* name) {
        member_ = name;
        const auto found = members_.find(name);
        return found == members_.end() ? nullptr : &found->second;
    }
    void demand(bool found, const char* what) {
        member_ = nullptr;
        if (!found) fail(format("expected %s", what));
    }
    // A number without fraction, from 0 to `most`.
    std::uint64_t count(const json& value, const char* what, double most = 0x1p53) const {
        const double number = value.is_number() ? value.get<double>() : -1;
        if (!(number >= 0 && number <= most && number == std::floor(number))) expected(what, value);
        return static_cast<std::uint64_t>(number);
    }
    std::uint32_t index(const json& value, const char* what) const {
        return static_cast<std::uint32_t>(count(value, what, none - 1.0));
    }
    const std::string& text(const json& value, const char* what) const {
        if (!value.is_string()) expected(what, value);
        return value.get_ref<const std::string&>();
    }
    std::uint64_t count(const char* name, const char* what, std::uint64_t otherwise) {
        const json* const value = member(name);
        return value ? count(*value, what) : otherwise;
    }
    std::uint32_t index(const char* name, const char* what, std::uint32_t otherwise = none) {
        const json* const value = member(name);
        return value ? index(*value, what) : otherwise;
    }
    template <std::size_t size>
    bool numbers(const char* name, double (&out)[size]) {
        if (!member(name)) return false;
        const std::vector<double>& found = numbers_[name];
        if (found.size() != size)
            fail(format("expected %zu numbers, found %zu%s", size, found.size(),
                        found.size() > 16 ? " or more" : ""));
        std::copy(found.begin(), found.end(), out);
        return true;
    }

    // ---- failures ----

    [[noreturn]] void expected(const char* what, const json& found) const {
        const std::string text = found.is_object()  ? "an object"
                                 : found.is_array() ? "an array"
                                                    : printable(found.dump());
        fail(format("expected %s, found %s", what, text.c_str()));
    }
    // Names the file and the value: its path, with the numbers of elements in it.
    [[noreturn]] void fail(const std::string& text, vox_result result = VOX_ERROR_FORMAT) const {
        std::string place;
        std::size_t from = 0;
        for (const Level& level : levels_) {
            if (path_.compare(level.path, 2, "[]") != 0) continue;
            place.append(path_, from, level.path + 1 - from).append(std::to_string(level.number));
            from = level.path + 1;
        }
        place.append(path_, from).append(member_ ? "." : "").append(member_ ? member_ : "");
        const std::string shown = place.empty() ? "" : printable(place.substr(1), 200) + ": ";
        throw_error(result, "%s: %s%s", file_.name.c_str(), shown.c_str(), text.c_str());
    }

    static constexpr std::uint64_t missing = ~std::uint64_t{0};

    const File& file_;
    const std::size_t first_;
    Contents out_;
    bool has_version_ = false, has_scene_ = false;
    std::string path_;          // of the value at hand: .accessors[].count; "" for the whole
    std::vector<Level> levels_; // as many as the longest path has
    std::uint64_t skipped_ = 0; // how many objects and arrays that are skipped we are in
    std::size_t object_ = 0;    // the length of the path of the object at hand
    // Its members, of arrays and objects only which they are: json allocates where it destroys full ones. And
    // the numbers of its arrays, at most one more than a matrix has.
    std::map<std::string, json> members_;
    std::map<std::string, std::vector<double>> numbers_;
    const char* member_ = nullptr; // the one at hand
};

} // namespace

Contents read_contents(const File& file, std::size_t first, std::string_view text) {
    ContentsReader reader(file, first);
    (void)json::sax_parse(text.begin(), text.end(), &reader);
    return reader.finish();
}

} // namespace vox::io::gltf
