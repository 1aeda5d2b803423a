// Gmsh .msh, versions 1, 2.0-2.2, 4.0 and 4.1, ASCII and binary of either byte order
// (C. Geuzaine and J.-F. Remacle, Gmsh reference manual, "File formats").
#include "io/formats/node_numbers.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"

namespace vox::io {
namespace {

struct ElementType {
    std::uint16_t nodes; // 0: not known
    CellKind cell;
    const char* name;
};

// The element types that the manual does not list (GmshDefines.h of Gmsh 4): `count` of them from `first` on,
// all of one kind. Every one has its corners first.
struct MoreTypes {
    std::uint8_t first, count;
    CellKind cell;
    const char* name;
    std::uint16_t nodes[10];
};

ElementType more_element_type(std::int64_t type) {
    using enum CellKind;
    static constexpr MoreTypes more[] = {
        {32, 2, tet, "tetrahedra of higher order", {22, 28}},
        {36, 6, other, "quadrangles of higher order", {16, 25, 36, 12, 16, 20}},
        {42, 5, triangle, "triangles of higher order", {28, 36, 45, 55, 66}},
        {47, 5, other, "quadrangles of higher order", {49, 64, 81, 100, 121}},
        {52, 5, triangle, "triangles of higher order", {18, 21, 24, 27, 30}},
        {57, 5, other, "quadrangles of higher order", {24, 28, 32, 36, 40}},
        {62, 5, other, "lines of higher order", {7, 8, 9, 10, 11}},
        {71, 5, tet, "tetrahedra of higher order", {84, 120, 165, 220, 286}},
        {79, 5, tet, "tetrahedra of higher order", {34, 40, 46, 52, 58}},
        {84, 3, other, "elements of one node", {1, 1, 1}},
        {87, 3, volume, "elements of one node", {1, 1, 1}},
        {90, 2, wedge, "prisms of higher order", {40, 75}},
        {92, 7, hexahedron, "hexahedra of higher order", {64, 125, 216, 343, 512, 729, 1000}},
        {99, 7, hexahedron, "hexahedra of higher order", {32, 44, 56, 68, 80, 92, 104}},
        {106, 5, wedge, "prisms of higher order", {126, 196, 288, 405, 550}},
        {111, 7, wedge, "prisms of higher order", {24, 33, 42, 51, 60, 69, 78}},
        {118, 7, pyramid, "pyramids of higher order", {30, 55, 91, 140, 204, 285, 385}},
        {125, 7, pyramid, "pyramids of higher order", {21, 29, 37, 45, 53, 61, 69}},
        {132, 1, volume, "elements of one node", {1}},
        {137, 1, tet, "tetrahedra of higher order", {16}},
        {138, 1, triangle, "triangles of higher order", {4}},
        {139, 1, tet, "tetrahedra of higher order", {5}},
        {140, 1, volume, "trihedra", {4}}};
    for (const MoreTypes& types : more)
        if (type >= types.first && type < types.first + types.count)
            return {types.nodes[type - types.first], types.cell, types.name};
    return {0, volume, "elements of unknown type"};
}

// `nodes` is 0 for a number of which nothing is known, polygons and polyhedra among them.
ElementType element_type(std::int64_t type) {
    using enum CellKind;
    static constexpr ElementType types[] = {{0, other, ""},
                                            {2, other, "lines"},
                                            {3, triangle, "triangles"},
                                            {4, other, "quadrangles"},
                                            {4, tet, "tetrahedra"},
                                            {8, hexahedron, "hexahedra"},
                                            {6, wedge, "prisms"},
                                            {5, pyramid, "pyramids"},
                                            {3, other, "second-order lines"},
                                            {6, triangle, "second-order triangles"},
                                            {9, other, "second-order quadrangles"},
                                            {10, tet, "second-order tetrahedra"},
                                            {27, hexahedron, "second-order hexahedra"},
                                            {18, wedge, "second-order prisms"},
                                            {14, pyramid, "second-order pyramids"},
                                            {1, other, "points"},
                                            {8, other, "second-order quadrangles"},
                                            {20, hexahedron, "second-order hexahedra"},
                                            {15, wedge, "second-order prisms"},
                                            {13, pyramid, "second-order pyramids"},
                                            {9, triangle, "third-order triangles"},
                                            {10, triangle, "third-order triangles"},
                                            {12, triangle, "fourth-order triangles"},
                                            {15, triangle, "fourth-order triangles"},
                                            {15, triangle, "fifth-order triangles"},
                                            {21, triangle, "fifth-order triangles"},
                                            {4, other, "third-order edges"},
                                            {5, other, "fourth-order edges"},
                                            {6, other, "fifth-order edges"},
                                            {20, tet, "third-order tetrahedra"},
                                            {35, tet, "fourth-order tetrahedra"},
                                            {56, tet, "fifth-order tetrahedra"}};
    return type > 0 && type < 32 ? types[type] : more_element_type(type);
}

class GmshReader {
public:
    explicit GmshReader(const File& file) : file_(file), in_(file), cells_(file) {}

    MeshData read() {
        std::size_t elements_at = 0; // where an $Elements section begins that precedes the nodes
        for (in_.skip_space(); !in_.done(); in_.skip_space()) {
            std::string_view name = in_.peek();
            if (!name.starts_with('$')) in_.expected("a section ($...)");
            in_.word("a section");
            name.remove_prefix(1);
            if (name == "MeshFormat") {
                in_.line_end();
                read_format();
            } else if (name == "Nodes" || name == "ParametricNodes" || name == "NOD") {
                if (have_nodes_) in_.fail("expected one section of nodes, found a second one");
                begin_section(name);
                read_nodes();
                have_nodes_ = true;
                end_section(name);
            } else if (name == "Elements" || name == "ELM") {
                if (have_elements_ || elements_at)
                    in_.fail("expected one section of elements, found a second one");
                begin_section(name);
                if (!have_nodes_) {
                    elements_at = in_.offset();
                    skip_section(name);
                    continue;
                }
                read_elements();
                end_section(name);
            } else if (name == "Entities" && version_ >= 40) {
                read_entities();
            } else {
                skip_section(name);
            }
        }
        if (!have_nodes_) in_.expected("a $Nodes section");
        if (elements_at) {
            in_.seek(elements_at);
            read_elements();
            end_section(version_ == 10 ? "ELM" : "Elements");
        }
        if (!have_elements_) in_.expected("an $Elements section");
        if (version_ >= 40) // a group for an entity
            for (std::int32_t& region : data_.tet_regions) {
                const auto group = groups_.find(region);
                region = group == groups_.end() ? 0 : group->second;
            }
        return cells_.finished(std::move(data_));
    }

private:
    // ---- sections ----

    void read_format() {
        const double version = in_.real("a version");
        version_ = version > 0 && version < 100 ? static_cast<int>(std::lround(version * 10)) : 0;
        if (version_ != 10 && (version_ < 20 || version_ > 22) && version_ != 40 && version_ != 41)
            in_.unsupported("version %g: the versions read are 1, 2.0 to 2.2, 4.0 and 4.1", version);
        const auto type = in_.integer<int>("a file type (0: ASCII, 1: binary)");
        if (type != 0 && type != 1) in_.fail("expected file type 0 (ASCII) or 1 (binary), found %d", type);
        const auto data_size = in_.integer<int>("a data size");
        in_.line_end();
        binary_ = type == 1;
        if (binary_) {
            if (data_size != 8) in_.unsupported("data size %d: binary files are read with size 8", data_size);
            in_.count_bytes(true);
            const std::size_t start = in_.offset();
            const auto one = in_.binary<std::uint32_t>(false, "the integer 1");
            if (one != 1 && one != 0x01000000u)
                in_.fail_at(start,
                            "expected the integer 1, which shows the byte order, found another number");
            swap_ = one != 1;
        }
        end_section("MeshFormat");
    }

    void begin_section(std::string_view name) {
        in_.line_end();
        if (name == "NOD" || name == "ELM") {
            version_ = 10;
            binary_ = false;
        } else if (version_ == 0) {
            in_.fail("expected $MeshFormat before this section");
        }
        parametric_ = name == "ParametricNodes";
        if (parametric_ && binary_) in_.unsupported("$ParametricNodes is read from ASCII files only");
    }

    static std::string end_mark(std::string_view name) {
        return (name == "NOD" || name == "ELM" ? "$END" : "$End") + std::string(name);
    }

    void end_section(std::string_view name) {
        in_.skip_space();
        const std::string mark = end_mark(name);
        if (!in_.accept(mark)) in_.expected(mark.c_str());
    }

    void skip_section(std::string_view name) {
        const std::string mark = end_mark(name);
        const std::size_t distance = in_.rest().find(mark);
        if (distance == std::string_view::npos)
            in_.fail("expected %s after $%s, found the end of the file", printable(mark).c_str(),
                     printable(name).c_str());
        in_.seek(in_.offset() + distance + mark.size());
    }

    // Files are read without the groups of their volumes, if these cannot be read.
    void read_entities() {
        in_.line_end();
        const std::string_view bytes = in_.rest();
        skip_section("Entities");
        const File section{file_.name, bytes.substr(0, bytes.size() - in_.remaining())};
        try {
            groups_ = gmsh_groups(section, version_, binary_, swap_);
        } catch (const Error&) {
            data_.notes.emplace_back("the section $Entities is damaged: regions are not known");
        }
    }

    // ---- nodes ----

    void read_nodes() {
        if (version_ < 40) {
            in_.skip_space();
            const auto count = in_.count("number of nodes", binary_ ? 28 : 7, max_count);
            in_.line_end();
            data_.positions.reserve(3 * count);
            for (std::uint64_t i = 0; i < count; ++i) read_node(0);
        } else {
            read_node_blocks();
        }
        numbers_.finish(in_);
    }

    void read_node(std::size_t extra) {
        begin_line();
        numbers_.add(short_number("a node number"));
        read_position(extra);
    }

    // The rest of a line, or in a binary file 24 bytes and `extra` ones that are not needed.
    void read_position(std::size_t extra) {
        if (!binary_) {
            for (int k = 0; k < 3; ++k) data_.positions.push_back(in_.real("a coordinate"));
            return parametric_ ? in_.skip_line() : in_.line_end();
        }
        const std::size_t start = in_.offset();
        const char* bytes = in_.take(24 + extra, "a position");
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = load<double>(bytes + 8 * k, swap_);
            if (!std::isfinite(x))
                in_.fail_at(start, "expected a position, found a coordinate that is not finite");
            data_.positions.push_back(x);
        }
    }

    void read_node_blocks() {
        const std::size_t start = in_.offset();
        const std::uint64_t blocks = block_count();
        const std::uint64_t total = total_count("number of nodes", binary_ ? 28 : 8);
        data_.positions.reserve(3 * total);
        for (std::uint64_t b = 0; b < blocks; ++b) {
            begin_line();
            const auto first = read_number<std::int32_t>("an entity");
            const auto second = read_number<std::int32_t>("an entity");
            const int dimension = version_ == 40 ? second : first;
            parametric_ = read_number<std::int32_t>("parametric (0 or 1)") != 0;
            if (dimension < 0 || dimension > 3)
                in_.fail("expected an entity of dimension 0 to 3, found %d", dimension);
            const std::uint64_t count = in_block("nodes in this block", binary_ ? 28 : 8);
            if (data_.positions.size() / 3 + count > total)
                in_.fail("expected %llu nodes in all, found a block of %llu after %zu", llu(total),
                         llu(count), data_.positions.size() / 3);
            const std::size_t extra = parametric_ ? 8 * static_cast<std::size_t>(dimension) : 0;
            if (version_ == 40) {
                for (std::uint64_t i = 0; i < count; ++i) read_node(extra);
            } else {
                for (std::uint64_t i = 0; i < count; ++i) {
                    begin_line();
                    numbers_.add(read_number<std::int64_t>("a node number"));
                    if (!binary_) in_.line_end();
                }
                for (std::uint64_t i = 0; i < count; ++i) {
                    begin_line();
                    read_position(extra);
                }
            }
        }
        if (data_.positions.size() / 3 != total)
            wrong_total("nodes", start, total, data_.positions.size() / 3);
    }

    // ---- elements ----

    void read_elements() {
        have_elements_ = true;
        if (version_ >= 40) return read_element_blocks();
        in_.skip_space();
        const auto count = in_.count("number of elements", binary_ ? 8 : 7, max_count);
        in_.line_end();
        data_.tets.reserve(4 * std::min<std::uint64_t>(count, in_.remaining() / (binary_ ? 20 : 13)));
        if (!binary_)
            for (std::uint64_t i = 0; i < count; ++i) text_element();
        else
            for (std::uint64_t done = 0; done < count;) done += binary_elements(count - done);
    }

    // In versions 1 and 2 an element is its number, type, tags and nodes.
    void text_element() {
        in_.skip_space();
        in_.integer<std::int64_t>("an element number");
        const ElementType type = checked_type(in_.integer<std::int64_t>("an element type"));
        if (version_ == 10) {
            region_ = region_of(in_.integer<std::int64_t>("a physical region"));
            in_.integer<std::int64_t>("an elementary region");
            const auto nodes = in_.integer<std::int64_t>("a number of nodes");
            if (type.nodes && nodes != type.nodes)
                in_.fail("expected %d nodes (%s), found %lld", type.nodes, type.name, lld(nodes));
        } else {
            const auto tags = in_.integer<std::int64_t>("a number of tags");
            if (tags < 0) in_.fail("expected a number of tags, found %lld", lld(tags));
            region_ = 0;
            for (std::int64_t i = 0; i < tags; ++i) {
                const auto tag = in_.integer<std::int64_t>("a tag");
                if (i == 0) region_ = region_of(tag);
            }
        }
        text_nodes(type);
    }

    void text_nodes(const ElementType& type) {
        const std::size_t wanted = cells_.corners_of(type.cell);
        if (wanted == 0) {
            cells_.skip(type.cell, type.name, 1, data_);
            return in_.skip_line();
        }
        std::uint32_t corners[most_corners];
        for (std::size_t i = 0; i < type.nodes; ++i) {
            const auto number = in_.integer<std::int64_t>("a node number");
            if (i < wanted) corners[i] = numbers_.vertex_of(number, in_);
        }
        in_.line_end();
        cells_.add(type.cell, type.name, type.nodes, corners, region_, data_);
    }

    // A block of version 2 begins with the type, the number of elements and the number of tags; then come
    // number, tags and nodes of each element.
    std::uint64_t binary_elements(std::uint64_t most) {
        const std::size_t start = in_.offset();
        const ElementType type = checked_type(in_.binary<std::int32_t>(swap_, "an element type"));
        const auto count = in_.binary<std::int32_t>(swap_, "a number of elements");
        const auto tags = in_.binary<std::int32_t>(swap_, "a number of tags");
        if (count < 1 || static_cast<std::uint64_t>(count) > most || tags < 0)
            in_.fail_at(start, "expected a block of 1 to %llu elements, found one of %d with %d tags",
                        llu(most), count, tags);
        const std::size_t before = 4 * (1 + static_cast<std::size_t>(tags));
        binary_block<std::int32_t>(type, static_cast<std::uint64_t>(count), before);
        return static_cast<std::uint64_t>(count);
    }

    // Each of the `count` elements has `before` bytes that are not needed, then its nodes as Integers.
    template <class Integer>
    void binary_block(const ElementType& type, std::uint64_t count, std::size_t before) {
        const std::size_t size = before + type.nodes * sizeof(Integer);
        if (count > in_.remaining() / size)
            in_.fail("expected %llu elements of %zu bytes, but only %zu bytes follow", llu(count), size,
                     in_.remaining());
        const std::size_t wanted = cells_.corners_of(type.cell);
        if (wanted == 0) {
            cells_.skip(type.cell, type.name, count, data_);
            in_.take(count * size, "elements");
            return;
        }
        for (std::uint64_t e = 0; e < count; ++e) {
            const char* const element = in_.take(size, "an element");
            const char* const nodes = element + before;
            if (version_ < 40) region_ = before > 4 ? load<std::int32_t>(element + 4, swap_) : 0;
            std::uint32_t corners[most_corners];
            for (std::size_t i = 0; i < wanted; ++i)
                corners[i] = numbers_.vertex_of(
                    static_cast<std::int64_t>(load<Integer>(nodes + i * sizeof(Integer), swap_)), in_);
            cells_.add(type.cell, type.name, type.nodes, corners, region_, data_);
        }
    }

    // In versions 4.x a block holds elements of one type, each with its number and nodes.
    void read_element_blocks() {
        const std::size_t start = in_.offset();
        const std::uint64_t blocks = block_count();
        const std::uint64_t total = total_count("number of elements", binary_ ? 8 : 4);
        std::uint64_t done = 0;
        for (std::uint64_t b = 0; b < blocks; ++b) {
            begin_line();
            const std::int64_t first = short_number("an entity"), second = short_number("an entity");
            region_ = region_of(version_ == 40 ? first : second); // for now, the entity
            const ElementType type = checked_type(short_number("an element type"));
            const std::uint64_t count = in_block("elements in this block", binary_ ? 8 : 4);
            if (done + count > total)
                in_.fail("expected %llu elements in all, found a block of %llu after %llu", llu(total),
                         llu(count), llu(done));
            done += count;
            if (type.cell == CellKind::tet) {
                const std::size_t line = binary_ ? 20 : 9; // at least
                const std::size_t need =
                    data_.tets.size() + 4 * std::min<std::uint64_t>(count, in_.remaining() / line);
                if (need > data_.tets.capacity())
                    data_.tets.reserve(std::max(need, data_.tets.capacity() / 2 * 3));
            }
            if (binary_ && version_ == 40)
                binary_block<std::int32_t>(type, count, 4);
            else if (binary_)
                binary_block<std::int64_t>(type, count, 8);
            else
                for (std::uint64_t i = 0; i < count; ++i) {
                    in_.skip_space();
                    in_.integer<std::int64_t>("an element number");
                    text_nodes(type);
                }
        }
        if (done != total) wrong_total("elements", start, total, done);
    }

    // ---- shared ----

    void begin_line() {
        if (!binary_) in_.skip_space();
    }
    template <class Integer>
    Integer read_number(const char* what) {
        return binary_ ? in_.binary<Integer>(swap_, what) : in_.integer<Integer>(what);
    }

    // Of 32 bits in a binary file.
    std::int64_t short_number(const char* what) {
        return binary_ ? in_.binary<std::int32_t>(swap_, what) : in_.integer<std::int64_t>(what);
    }

    // A section of versions 4.x begins with the number of blocks and the total number of nodes or elements.
    // Version 4.1 adds their lowest and highest number, which are not needed.
    std::uint64_t block_count() {
        begin_line();
        return read_count("number of blocks", binary_ ? 20 : 4);
    }
    std::uint64_t total_count(const char* what, std::size_t bytes) {
        const std::uint64_t total = read_count(what, bytes);
        if (version_ == 41)
            for (const char* number : {"the lowest number", "the highest number"})
                read_number<std::uint64_t>(number);
        if (!binary_) in_.line_end();
        return total;
    }
    std::uint64_t in_block(const char* what, std::size_t bytes) {
        const std::uint64_t count = read_count(what, bytes);
        if (!binary_) in_.line_end();
        return count;
    }
    std::uint64_t read_count(const char* what, std::size_t bytes) {
        if (!binary_) return in_.count(what, bytes, max_count);
        const std::size_t start = in_.offset();
        const auto count = in_.binary<std::uint64_t>(swap_, what);
        in_.check_count(what, count, bytes, max_count, start);
        return count;
    }
    [[noreturn]] void wrong_total(const char* what, std::size_t start, std::uint64_t total,
                                  std::uint64_t found) {
        in_.fail_at(start, "%llu %s are declared, but the blocks hold %llu", llu(total), what, llu(found));
    }

    // In text a line ends an element, so that one of unknown type can be left out.
    ElementType checked_type(std::int64_t number) {
        const ElementType type = element_type(number);
        if (number < 1 || (binary_ && type.nodes == 0))
            in_.fail("expected an element type of Gmsh with a fixed number of nodes, found %lld",
                     lld(number));
        return type;
    }

    const File& file_;
    Scanner in_;
    MeshData data_;
    NodeNumbers numbers_;
    Cells cells_;
    std::int32_t region_ = 0;                     // of the element at hand
    std::map<std::int64_t, std::int32_t> groups_; // by the entity
    int version_ = 0;                             // times ten
    bool binary_ = false;
    bool swap_ = false;
    bool parametric_ = false;
    bool have_nodes_ = false;
    bool have_elements_ = false;
};

} // namespace

MeshData read_gmsh(const File& file) { return GmshReader(file).read(); }

} // namespace vox::io
