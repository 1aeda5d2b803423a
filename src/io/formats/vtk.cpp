// VTK legacy files, versions 1.0 to 5.1, ASCII and binary ("VTK File Formats", Kitware): DATASET
// UNSTRUCTURED_GRID or POLYDATA. Binary numbers are big endian.
#include "io/formats/vtk_cells.hpp"

namespace vox::io {
namespace {

constexpr bool swap = !host_is_big_endian;

class VtkReader {
public:
    VtkReader(const File& file, std::uint32_t mesh_index) : file_(file), in_(file), mesh_index_(mesh_index) {}

    MeshData read() {
        read_header();
        read_sections();
        if (!have_points_) in_.expected("POINTS");
        if (surface_) return read_surface();
        if (!have_cells_) in_.expected("CELLS");
        if (!have_types_) in_.expected("CELL_TYPES");
        if (types_.size() != cells_.ends.size())
            in_.fail_at(types_at_, "expected %zu cell types, as many as cells, found %zu", cells_.ends.size(),
                        types_.size());
        Cells cells(file_);
        take_vtk_cells(cells_, types_, regions_, 0, data_.positions.size() / 3, data_, cells,
                       fail_at(cells_at_));
        return cells.finished(std::move(data_));
    }

private:
    void read_sections() {
        while (next_keyword()) {
            const std::size_t start = in_.offset();
            const std::string keyword(in_.word("a keyword"));
            if (keyword == "POINTS") {
                read_points();
            } else if (!surface_ && keyword == "CELLS") {
                if (have_cells_) in_.fail("expected one section CELLS, found a second one");
                have_cells_ = true;
                cells_at_ = start;
                read_cells(cells_);
            } else if (surface_ && (keyword == "POLYGONS" || keyword == "TRIANGLE_STRIPS")) {
                VtkPolygons& list = keyword == "POLYGONS" ? cells_ : strips_;
                if (!list.ends.empty())
                    in_.fail("expected one section %s, found a second one", keyword.c_str());
                (keyword == "POLYGONS" ? cells_at_ : strips_at_) = start;
                read_cells(list);
            } else if (surface_ && (keyword == "VERTICES" || keyword == "LINES")) {
                VtkPolygons loose;
                read_cells(loose);
                data_.skipped_elements += loose.ends.size();
            } else if (!surface_ && keyword == "CELL_TYPES") {
                read_types();
            } else if (keyword == "FIELD") {
                skip_field();
            } else if (keyword == "METADATA") {
                skip_metadata();
            } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                in_.seek(start);
                if (!surface_) regions_ = vtk_regions(in_, binary_, cells_.ends.size());
                break;
            } else {
                in_.seek(start);
                in_.expected(surface_
                                 ? "POINTS, POLYGONS, TRIANGLE_STRIPS, VERTICES, LINES, FIELD, METADATA, "
                                   "POINT_DATA or CELL_DATA"
                                 : "POINTS, CELLS, CELL_TYPES, FIELD, METADATA, POINT_DATA or CELL_DATA");
            }
        }
    }

    MeshData read_surface() {
        SurfaceBuilder surface(file_.name, surface_limits(file_.bytes.size()), mesh_index_);
        surface.skip(data_.skipped_elements);
        surface.reserve_points(data_.positions.size() / 3);
        for (std::size_t i = 0; i < data_.positions.size(); i += 3) surface.point(&data_.positions[i]);
        data_.positions = std::vector<double>();
        take_vtk_polygons(cells_, false, 0, surface, fail_at(cells_at_));
        take_vtk_polygons(strips_, true, 0, surface, fail_at(strips_at_));
        return surface.finish();
    }
    VtkFail fail_at(std::size_t section) {
        return [this, section](std::size_t cell, const std::string& text) {
            in_.fail_at(section, "cell %zu: %s", cell, text.c_str());
        };
    }

    void read_header() {
        in_.skip_space();
        if (!in_.rest().starts_with("# vtk DataFile Version")) in_.expected("# vtk DataFile Version");
        for (int i = 0; i < 4; ++i) in_.word("# vtk DataFile Version");
        const double version = in_.real("a version");
        if (!(version >= 1 && version < 6))
            in_.unsupported("version %g: the versions read are 1.0 to 5.1", version);
        in_.line_end();
        in_.skip_line(); // title
        in_.skip_space();
        if (in_.accept("BINARY"))
            binary_ = true;
        else if (!in_.accept("ASCII"))
            in_.expected("ASCII or BINARY");
        in_.line_end();
        in_.skip_space();
        if (!in_.accept("DATASET")) in_.expected("DATASET");
        surface_ = in_.accept("POLYDATA");
        if (!surface_ && !in_.accept("UNSTRUCTURED_GRID")) in_.expected("UNSTRUCTURED_GRID or POLYDATA");
        in_.line_end();
        in_.count_bytes(binary_);
    }

    bool next_keyword() {
        in_.skip_space();
        return !in_.done();
    }

    NumberType number_type(const char* what) {
        const std::optional<NumberType> type = vtk_number(in_.peek());
        if (!type) in_.expected(what);
        in_.word(what);
        return *type;
    }

    // Reads a count of values that each take at least `size` bytes in a binary file.
    std::uint64_t count(const char* what, std::size_t size) {
        return in_.count(what, binary_ ? size : 1, max_count * 8);
    }

    template <class Out>
    void read_numbers(NumberType type, std::uint64_t number, std::vector<Out>& out, const char* what) {
        in_.line_end();
        const std::size_t least = binary_ ? size_of(type) : 2; // the last number may lack its blank
        in_.check_count(what, number > 0 && !binary_ ? number - 1 : number, least, max_count * 8,
                        in_.offset());
        out.reserve(out.size() + number);
        if (binary_) return append_numbers(type, in_.take(number * size_of(type), what), number, swap, out);
        for (std::uint64_t i = 0; i < number; ++i) {
            in_.skip_space();
            if constexpr (std::is_floating_point_v<Out>)
                out.push_back(in_.real(what));
            else
                out.push_back(static_cast<Out>(in_.integer<std::int64_t>(what)));
        }
    }

    void read_points() {
        if (have_points_) in_.fail("expected one section POINTS, found a second one");
        have_points_ = true;
        const std::uint64_t points = in_.count("number of points", 3, max_count);
        const NumberType type = number_type("a number type (float, double ...)");
        const std::size_t start = in_.offset();
        read_numbers(type, 3 * points, data_.positions, "coordinates");
        for (std::size_t i = 0; i < data_.positions.size(); ++i)
            if (!std::isfinite(data_.positions[i]))
                in_.fail_at(start, "point %zu: expected a coordinate, found one that is not finite", i / 3);
    }

    void read_cells(VtkPolygons& cells) {
        std::vector<std::uint64_t>&ends = cells.ends, &list = cells.connectivity;
        const std::uint64_t first = count("number of cells", 1);
        const std::uint64_t second = count("size of the cell list", 1);
        const std::size_t start = in_.offset();
        in_.line_end();
        if (next_keyword() && in_.accept("OFFSETS")) {
            // Version 5.1 has `first` offsets, one more than cells, and `second` points.
            const NumberType offset_type = number_type("a number type (vtktypeint64 ...)");
            read_numbers(offset_type, first, ends, "offsets");
            if (ends.empty() || ends[0] != 0) in_.fail("expected offsets that start with 0");
            ends.erase(ends.begin());
            in_.skip_space();
            if (!in_.accept("CONNECTIVITY")) in_.expected("CONNECTIVITY");
            const NumberType point_type = number_type("a number type (vtktypeint64 ...)");
            read_numbers(point_type, second, list, "points of cells");
            if (!ends.empty() && ends.back() != second)
                in_.fail("expected offsets that end with %llu, found %llu", llu(second), llu(ends.back()));
            return;
        }
        // Earlier versions have `first` cells, each as its number of points and the points, `second` numbers
        // in all.
        in_.seek(start);
        read_numbers(NumberType::int32, second, list, "points of cells");
        ends.reserve(std::min(first, second));
        std::uint64_t from = 0, to = 0;
        for (std::uint64_t c = 0; c < first; ++c) {
            const std::uint64_t points = from < second ? list[from] : 0;
            if (from >= second || points > second - from - 1)
                in_.fail_at(start, "expected %llu cells in %llu numbers, found only %llu", llu(first),
                            llu(second), llu(c));
            for (std::uint64_t i = 0; i < points; ++i) list[to++] = list[from + 1 + i]; // drop the counts
            from += 1 + points;
            ends.push_back(to);
        }
        if (from != second)
            in_.fail_at(start, "expected the %llu cells to fill %llu numbers, found %llu", llu(first),
                        llu(second), llu(from));
        list.resize(to);
    }

    void read_types() {
        if (have_types_) in_.fail("expected one section CELL_TYPES, found a second one");
        have_types_ = true;
        types_at_ = in_.offset();
        const std::uint64_t number = count("number of cell types", 4);
        read_numbers(NumberType::int32, number, types_, "a cell type");
    }

    // A field is its name, the number of arrays, and for each array its name, components, tuples, type and
    // values; a missing one is its name alone, and metadata may follow each.
    void skip_field() {
        in_.word("a field name");
        const std::uint64_t arrays = count("number of arrays", 1);
        in_.line_end();
        for (std::uint64_t a = 0; a < arrays; ++a) {
            in_.skip_space();
            const std::string_view name = in_.word("an array name");
            if (name == "NULL_ARRAY") continue;
            if (name == "METADATA") {
                skip_metadata();
                --a;
                continue;
            }
            const std::uint64_t components = count("number of components", 1);
            const std::uint64_t tuples = count("number of tuples", 1);
            const std::string type(in_.word("a number type"));
            in_.line_end();
            if (tuples > 0)
                in_.check_count("values of the array", components, tuples, max_count * 8, in_.offset());
            skip_values(components * tuples, type);
        }
    }

    void skip_values(std::uint64_t values, const std::string& type_name) {
        const bool strings = type_name == "string" || type_name == "utf8_string";
        if (binary_ && strings) {
            for (std::uint64_t i = 0; i < values; ++i) skip_string();
        } else if (strings || type_name == "variant") { // a line each
            for (std::uint64_t i = 0; i < values; ++i) in_.skip_line();
        } else if (!binary_) {
            for (std::uint64_t i = 0; i < values; ++i) {
                in_.skip_space();
                in_.word("a value");
            }
        } else if (type_name == "bit") {
            in_.take((values + 7) / 8, "values of the array");
        } else {
            const std::optional<NumberType> type = vtk_number(type_name);
            if (!type)
                in_.unsupported("a field of type %s in a binary file is not read",
                                printable(type_name).c_str());
            in_.check_count("values of the array", values, size_of(*type), max_count * 8, in_.offset());
            in_.take(values * size_of(*type), "values of the array");
        }
    }

    // The first two bits say how many bytes the length has, together with them (vtkDataWriter): 11 means one,
    // 00 eight.
    void skip_string() {
        const auto first = static_cast<unsigned char>(*in_.take(1, "a string's length"));
        const std::size_t more = (std::size_t{1} << (3 - first / 64)) - 1;
        std::uint64_t length = first % 64;
        for (const char c : std::string_view(in_.take(more, "a string's length"), more))
            length = length << 8 | static_cast<unsigned char>(c);
        in_.check_count("bytes of a string", length, 1, max_count * 8, in_.offset());
        in_.take(length, "a string");
    }

    // Metadata end with an empty line.
    void skip_metadata() {
        in_.line_end();
        while (!in_.done() && !in_.at_line_end()) in_.skip_line();
    }

    const File& file_;
    Scanner in_;
    MeshData data_;
    std::uint32_t mesh_index_; // of a surface
    VtkPolygons cells_, strips_;
    std::vector<std::uint64_t> types_;
    RegionArray regions_;
    std::size_t cells_at_ = 0, strips_at_ = 0, types_at_ = 0;
    bool binary_ = false, surface_ = false;
    bool have_points_ = false, have_cells_ = false, have_types_ = false;
};

} // namespace

MeshData read_vtk(const File& file, std::uint32_t mesh_index) { return VtkReader(file, mesh_index).read(); }

} // namespace vox::io
