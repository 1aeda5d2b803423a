// PLY, text and binary of either byte order (G. Turk, The PLY polygon file format, 1994): the elements
// "vertex", "face" and "tristrips"; other elements and properties are skipped.
#include "io/formats/number_type.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

namespace vox::io {
namespace {

// In the order of NumberType, which has two more.
constexpr std::string_view ply_types[][2] = {{"char", "int8"},
                                             {"uchar", "uint8"},
                                             {"short", "int16"},
                                             {"ushort", "uint16"},
                                             {"int", "int32"},
                                             {"uint", "uint32"},
                                             {},
                                             {},
                                             {"float", "float32"},
                                             {"double", "float64"}};

struct Property {
    std::string_view name;
    NumberType type{};
    bool is_list = false;
    NumberType count_type{}; // of a list
};

struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::size_t counted_at = 0;
    std::vector<Property> properties;
};

class PlyReader {
    static constexpr std::size_t most_lines = 4096; // about elements and properties

public:
    PlyReader(const File& file, std::uint32_t mesh_index)
        : in_(file), surface_(file.name, surface_limits(file.bytes.size()), mesh_index) {}

    MeshData read() {
        read_header();
        in_.count_bytes(!text_);
        for (const Element& element : elements_) {
            check_count(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else if (element.name == "tristrips")
                read_strips(element);
            else
                for (std::uint64_t i = 0; i < element.count; ++i)
                    for (const Property& property : element.properties) skip(property);
        }
        in_.skip_space(); // some programs end binary data with a line end, too
        if (!in_.done()) in_.expected("the end of the file after the last element");
        return surface_.finish();
    }

private:
    // ---- header ----

    void read_header() {
        if (!in_.accept("ply")) in_.expected("ply");
        next_line();
        while (in_.accept("comment") || in_.accept("obj_info")) next_line();
        if (!in_.accept("format")) in_.expected("format");
        const std::string_view format_name = in_.word("a format");
        text_ = format_name == "ascii";
        if (format_name == "binary_little_endian")
            swap_ = host_is_big_endian;
        else if (format_name == "binary_big_endian")
            swap_ = !host_is_big_endian;
        else if (!text_)
            in_.unsupported("format %s: ascii, binary_little_endian and binary_big_endian are read",
                            printable(format_name).c_str());
        if (in_.peek() != "1.0") in_.expected("version 1.0");
        in_.word("version 1.0");
        std::size_t lines = 0;
        for (next_line(); !in_.accept("end_header"); next_line()) {
            if (in_.accept("comment") || in_.accept("obj_info")) continue;
            if (++lines > most_lines)
                throw_error(VOX_ERROR_LIMIT, "%s: more than %zu elements and properties", in_.place().c_str(),
                            most_lines);
            if (in_.accept("element"))
                read_element();
            else if (in_.accept("property") && !elements_.empty())
                read_property();
            else
                in_.expected("element, property, comment or end_header");
        }
        next_line();
    }

    // What is left of a line of the header is skipped. Binary data follow the last one at once, and may begin
    // with the byte of a line feed.
    void next_line() {
        const std::string_view rest = in_.rest();
        const std::size_t end = rest.find_first_of("\r\n");
        if (end == std::string_view::npos) {
            in_.seek(in_.offset() + rest.size());
            in_.expected("end_header");
        }
        const bool two = rest.substr(end).starts_with("\r\n") && !lone_returns_;
        if (rest[end] == '\r' && !two) lone_returns_ = true;
        in_.seek(in_.offset() + end + (two ? 2 : 1));
    }

    void read_element() {
        Element element;
        element.name = in_.word("the name of an element");
        in_.skip_blanks();
        element.counted_at = in_.offset();
        if (in_.peek().starts_with('-')) in_.expected("a number of elements");
        element.count = in_.integer<std::uint64_t>("a number of elements");
        elements_.push_back(std::move(element));
    }

    void read_property() {
        Property property;
        property.is_list = in_.accept("list");
        if (property.is_list) {
            property.count_type = read_type();
            if (!is_integer(property.count_type))
                in_.fail("expected an integer type for the length of a list");
        }
        property.type = read_type();
        property.name = in_.word("the name of a property");
        elements_.back().properties.push_back(property);
    }

    NumberType read_type() {
        const std::string_view word = in_.peek();
        for (std::size_t i = 0; i < std::size(ply_types); ++i)
            if (!word.empty() && (word == ply_types[i][0] || word == ply_types[i][1])) {
                in_.word("a type");
                return static_cast<NumberType>(i);
            }
        in_.expected("a type, char to double or int8 to float64");
    }

    // Nothing is reserved, and no loop entered, by a number that the rest of the file cannot hold.
    void check_count(const Element& element) {
        std::size_t bytes = 0;
        for (const Property& property : element.properties)
            bytes += text_ ? 2 : size_of(property.is_list ? property.count_type : property.type);
        if (text_ && bytes > 0) --bytes; // the file may end without a line end
        if (bytes == 0 && element.count > 0)
            in_.fail_at(element.counted_at, "element %s: expected properties, found none",
                        printable(element.name).c_str());
        const std::string what = "number of elements " + printable(element.name);
        if (bytes > 0) in_.check_count(what.c_str(), element.count, bytes, max_count, element.counted_at);
    }

    // ---- values ----

    // Text is a sequence of words, whatever their lines.
    void begin_value() {
        if (text_) in_.skip_space();
    }

    template <class Number>
    Number value(NumberType type, const char* what) {
        return load_as<Number>(type, in_.take(size_of(type), what), swap_);
    }
    std::int64_t integer(NumberType type, const char* what) {
        begin_value();
        return text_ ? in_.integer<std::int64_t>(what) : value<std::int64_t>(type, what);
    }
    double real(NumberType type, const char* what) {
        begin_value();
        if (text_) return in_.real(what);
        const std::size_t at = in_.offset();
        const auto x = value<double>(type, what);
        if (std::isfinite(x)) return x;
        in_.fail_at(at, "expected %s, found %g, which is not finite", what, x);
    }

    std::uint64_t length_of_list(const Property& property) {
        begin_value();
        const std::size_t at = in_.offset();
        const std::int64_t length = integer(property.count_type, "the length of a list");
        const std::size_t bytes = text_ ? 2 : size_of(property.type);
        const auto most = (in_.remaining() + 1) / bytes; // the file may end without a line end
        if (length >= 0 && static_cast<std::uint64_t>(length) <= most)
            return static_cast<std::uint64_t>(length);
        in_.fail_at(at,
                    "expected the length of a list, at most %llu for what is left of the file, found %lld",
                    llu(most), lld(length));
    }

    void skip(const Property& property) {
        const std::uint64_t values = property.is_list ? length_of_list(property) : 1;
        if (!text_) {
            in_.take(values * size_of(property.type), "a property");
            return;
        }
        for (std::uint64_t i = 0; i < values; ++i) {
            begin_value();
            in_.word("a value");
        }
    }

    // ---- elements ----

    void read_vertices(const Element& element) {
        int axis_of[3] = {-1, -1, -1};
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            for (std::size_t k = 0; k < 3; ++k)
                if (property.name == std::string_view("xyz").substr(k, 1) && !property.is_list)
                    axis_of[k] = static_cast<int>(i);
        }
        for (std::size_t k = 0; k < 3; ++k)
            if (axis_of[k] < 0)
                in_.fail_at(element.counted_at, "vertices: expected a property %c, found none", "xyz"[k]);
        if (surface_.points() > 0)
            in_.fail_at(element.counted_at, "expected one element vertex, found another");
        surface_.reserve_points(element.count);
        for (std::uint64_t v = 0; v < element.count; ++v) {
            double p[3];
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                const auto number = static_cast<int>(i);
                const std::size_t k = number == axis_of[0]   ? 0
                                      : number == axis_of[1] ? 1
                                      : number == axis_of[2] ? 2
                                                             : 3;
                if (k < 3)
                    p[k] = real(element.properties[i].type, "a coordinate");
                else
                    skip(element.properties[i]);
            }
            surface_.point(p);
        }
        surface_.reserve(std::min(surface_.points(), in_.remaining()));
    }

    // Calls visit(point) for each value of the list in `element` that numbers vertices; -1, where strips end,
    // only if `ends`. after() is called behind each item.
    template <class Visit, class After>
    void read_lists(const Element& element, bool ends, const Visit& visit, const After& after) {
        const auto is_indices = [](const Property& property) {
            return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
        };
        const auto indices = std::find_if(element.properties.begin(), element.properties.end(), is_indices);
        if (indices == element.properties.end() || !is_integer(indices->type))
            in_.fail_at(element.counted_at,
                        "element %s: expected a list of integers vertex_indices, found none",
                        printable(element.name).c_str());
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties) {
                if (&property != &*indices) {
                    skip(property);
                    continue;
                }
                const std::uint64_t length = length_of_list(property);
                for (std::uint64_t c = 0; c < length; ++c) {
                    begin_value();
                    const std::size_t at = in_.offset();
                    const std::int64_t point = integer(property.type, "a vertex number");
                    if ((point < 0 || point >= static_cast<std::int64_t>(surface_.points())) &&
                        !(ends && point == -1))
                        in_.fail_at(at, "expected a vertex number below %llu, found %lld",
                                    llu(surface_.points()), lld(point));
                    visit(point);
                }
            }
            after();
        }
    }

    void read_faces(const Element& element) {
        const bool wanted = element.count > 0 && surface_.begin_element();
        read_lists(
            element, false,
            [&](std::int64_t point) {
                if (wanted) surface_.corner(surface_.vertex_of(static_cast<std::uint32_t>(point)));
            },
            [&] {
                if (wanted) surface_.end_polygon();
            });
    }

    // In a strip every vertex makes a triangle with the two before it. The one of even number comes first,
    // which turns every other triangle over.
    void read_strips(const Element& element) {
        const bool wanted = element.count > 0 && surface_.begin_element();
        std::uint32_t last[2] = {0, 0};
        std::uint64_t length = 0;
        read_lists(
            element, true,
            [&](std::int64_t point) {
                if (point < 0 || !wanted) {
                    length = 0;
                    return;
                }
                const std::uint32_t vertex = surface_.vertex_of(static_cast<std::uint32_t>(point));
                if (length >= 2) surface_.triangle(last[0], last[1], vertex);
                last[length % 2] = vertex;
                ++length;
            },
            [&] { length = 0; });
    }

    Scanner in_;
    bool text_ = false;
    bool swap_ = false;
    bool lone_returns_ = false; // lines end in a carriage return alone
    std::vector<Element> elements_;
    SurfaceBuilder surface_;
};

} // namespace

MeshData read_ply(const File& file, std::uint32_t mesh_index) { return PlyReader(file, mesh_index).read(); }

} // namespace vox::io
