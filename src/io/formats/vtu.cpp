// VTK XML unstructured grids, .vtu, and surfaces, .vtp ("VTK XML Formats", Kitware), with ASCII, base64 and
// appended arrays, raw or compressed, headers of 32 or 64 bits, and either byte order.
#include "io/formats/base64.hpp"
#include "io/formats/unpack.hpp"
#include "io/formats/vtk_cells.hpp"

#include <pugixml.hpp>

#include <cctype>
#include <iterator>

namespace vox::io {
namespace {

struct Array {
    NumberType type = NumberType::int8;
    std::string bytes; // of binary and appended arrays
    bool text = false; // an ASCII array, with its numbers in `where.child_value()`
    pugi::xml_node where;
};

class VtuReader {
public:
    VtuReader(const File& file, std::uint32_t mesh_index)
        : file_(file), mesh_index_(mesh_index), cells_(file) {}

    MeshData read() {
        parse();
        const pugi::xml_node root = document_.child("VTKFile");
        if (!root) fail({}, "expected an element VTKFile, found none");
        const std::string_view type = root.attribute("type").value();
        if (type != "UnstructuredGrid" && type != "PolyData")
            fail(root, format("expected type=\"UnstructuredGrid\" or \"PolyData\", found \"%s\"",
                              printable(type).c_str()));
        const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
        if (order != "LittleEndian" && order != "BigEndian")
            fail(root, format("expected a byte_order of LittleEndian or BigEndian, found \"%s\"",
                              printable(order).c_str()));
        swap_ = (order == "BigEndian") != host_is_big_endian;
        const std::string_view header = root.attribute("header_type").as_string("UInt32");
        if (header != "UInt32" && header != "UInt64")
            fail(root, format("expected a header_type of UInt32 or UInt64, found \"%s\"",
                              printable(header).c_str()));
        header_size_ = header == "UInt32" ? 4 : 8;
        const std::string_view compressor = root.attribute("compressor").value();
        const std::optional<Packing> packing = packing_of(compressor);
        if (!packing)
            fail(root,
                 format("compressor %s: vtkZLibDataCompressor, vtkLZ4DataCompressor and "
                        "vtkLZMADataCompressor are read",
                        printable(compressor).c_str()),
                 VOX_ERROR_UNSUPPORTED);
        if (!can_unpack(*packing))
            fail(root,
                 format("%s: this vox_io was built without liblzma (CMake option VOX_IO_LZMA)",
                        compressor.data()),
                 VOX_ERROR_UNSUPPORTED);
        packing_ = *packing;

        const std::string grid_name(type);
        const pugi::xml_node grid = root.child(grid_name.c_str());
        if (!grid) fail(root, format("expected an element %s, found none", grid_name.c_str()));
        const auto pieces = grid.children("Piece");
        const auto count = static_cast<double>(std::distance(pieces.begin(), pieces.end()));
        if (count == 0) fail(grid, "expected an element Piece, found none");
        double done = 0;
        // What is packed may hold more than its size; of no ordinary surface it is 16 times as much.
        SurfaceBuilder surface(file_.name,
                               surface_limits(file_.bytes.size() * (packing_ == Packing::none ? 1 : 16)),
                               mesh_index_);
        for (const pugi::xml_node piece : pieces) {
            const Progress progress = file_.progress.part(done / count, (done + 1) / count);
            if (type == "PolyData")
                read_surface_piece(piece, progress, surface);
            else
                read_piece(piece, progress);
            ++done;
        }
        return type == "PolyData" ? surface.finish() : cells_.finished(std::move(data_));
    }

private:
    [[noreturn]] void fail(const pugi::xml_node& where, const std::string& text,
                           vox_result result = VOX_ERROR_FORMAT) const {
        std::string place = file_.name;
        if (where && where.offset_debug() >= 0)
            place += format(", byte %lld (%s %s)", lld(where.offset_debug()), where.name(),
                            printable(where.attribute("Name").value()).c_str());
        throw_error(result, "%s: %s", place.c_str(), text.c_str());
    }

    // Appended data may be raw bytes, which are not XML, so it is cut out before the rest is parsed.
    void parse() {
        std::string_view xml = file_.bytes;
        std::string rest;
        const std::size_t start = xml.find("<AppendedData");
        if (start != std::string_view::npos) {
            const std::size_t mark = xml.find('_', xml.find('>', start));
            const std::size_t end = xml.rfind("</AppendedData");
            if (mark == std::string_view::npos || end == std::string_view::npos || end < mark)
                fail({}, format("byte %zu: expected appended data from \"_\" to </AppendedData>", start));
            appended_ = xml.substr(mark + 1, end - mark - 1);
            const std::string_view tag = xml.substr(start, xml.find('>', start) - start);
            appended_base64_ = tag.find("base64") != std::string_view::npos;
            rest.reserve(mark + xml.size() - end);
            rest.append(xml.substr(0, mark)).append(xml.substr(end));
            xml = rest;
        }
        const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
        if (!result)
            fail({},
                 format("byte %lld: expected XML, found this: %s", lld(result.offset), result.description()));
    }

    // ---- arrays ----

    Array open(const pugi::xml_node& array, std::uint64_t values) {
        Array out;
        out.where = array;
        const std::string_view name = array.attribute("type").value();
        const std::optional<NumberType> type = vtk_number(name);
        if (!type)
            fail(array, format("expected a number type (Float64, Int64 ...), found \"%s\"",
                               printable(name).c_str()));
        out.type = *type;
        const std::string_view kind = array.attribute("format").as_string("ascii");
        const std::size_t size = size_of(out.type);
        if (kind == "ascii") {
            const std::size_t length = std::strlen(array.child_value());
            if (values > (length + 1) / 2)
                fail(array, format("expected %llu values, found %zu characters", llu(values), length));
            out.text = true;
        } else if (kind == "binary") {
            out.bytes = decode(array, array.child_value(), true, values, size);
        } else if (kind == "appended") {
            const std::uint64_t offset = array.attribute("offset").as_ullong(~0ull);
            if (offset > appended_.size())
                fail(array, format("expected an offset into %zu bytes of appended data, found \"%s\"",
                                   appended_.size(), printable(array.attribute("offset").value()).c_str()));
            out.bytes = decode(array, appended_.substr(offset), appended_base64_, values, size);
        } else {
            fail(array,
                 format("expected format ascii, binary or appended, found \"%s\"", printable(kind).c_str()));
        }
        return out;
    }

    std::uint64_t header_word(const std::string& bytes, std::size_t index) const {
        const char* at = bytes.data() + index * header_size_;
        return header_size_ == 4 ? load<std::uint32_t>(at, swap_) : load<std::uint64_t>(at, swap_);
    }

    // The first `size` bytes of `source`, decoded.
    std::string decoded(const pugi::xml_node& array, std::string_view source, bool base64,
                        std::size_t size) const {
        std::string bytes =
            base64 ? from_base64(source, size, [&](const std::string& text) { fail(array, text); })
                   : std::string(source.substr(0, size));
        if (bytes.size() < size)
            fail(array, format("expected %zu bytes, found only %zu", size, bytes.size()));
        bytes.resize(size);
        return bytes;
    }

    // The values of a binary array, which follow a header, in one piece or in compressed blocks.
    std::string decode(const pugi::xml_node& array, std::string_view source, bool base64,
                       std::uint64_t values, std::size_t value_size) const {
        const std::size_t available = base64 ? source.size() / 4 * 3 + 3 : source.size();
        const auto too_many = [&](const char* what, std::uint64_t number) {
            fail(array,
                 format("%s: %llu are declared, but only %zu bytes follow", what, llu(number), available));
        };
        if (packing_ == Packing::none) {
            if (values > available / value_size) too_many("values", values);
            const std::size_t size = values * value_size;
            const std::string head = decoded(array, source, base64, header_size_);
            const std::uint64_t declared = header_word(head, 0);
            if (declared != size)
                fail(array, format("expected %zu bytes of values, found a header that says %llu", size,
                                   llu(declared)));
            return decoded(array, source, base64, header_size_ + size).substr(header_size_);
        }

        // The header holds the number of blocks, the size of a block, the size of the last one (0: as the
        // others), and the compressed size of each.
        const std::string start = decoded(array, source, base64, 3 * header_size_);
        const std::uint64_t blocks = header_word(start, 0);
        if (blocks > available / header_size_) too_many("blocks", blocks);
        const std::uint64_t block_size = header_word(start, 1);
        const std::uint64_t last = header_word(start, 2);
        if (values / most_unpacked(packing_) > available / value_size) too_many("values", values);
        const std::size_t size = values * value_size;
        const std::size_t header = (3 + blocks) * header_size_;
        const std::string head = decoded(array, source, base64, header);
        std::uint64_t packed = 0;
        for (std::uint64_t b = 0; b < blocks; ++b) {
            const std::uint64_t own = header_word(head, 3 + b);
            if (own > available - std::min<std::uint64_t>(packed, available))
                too_many("compressed bytes", own);
            packed += own;
        }
        const std::string all = decoded(array, source, base64, header + packed);
        std::string out(size, '\0');
        std::size_t from = header, to = 0;
        for (std::uint64_t b = 0; b < blocks; ++b) {
            const std::uint64_t wanted = b + 1 == blocks && last != 0 ? last : block_size;
            if (wanted > size - to)
                fail(array, format("expected %zu bytes of values, found blocks of more", size));
            const std::uint64_t own = header_word(head, 3 + b);
            const std::string wrong =
                unpack(packing_, std::string_view(all).substr(from, own), out.data() + to, wanted);
            if (!wrong.empty())
                fail(array, format("block %llu: expected %llu bytes %s", llu(b), llu(wanted), wrong.c_str()));
            from += own;
            to += wanted;
        }
        if (to != size) fail(array, format("expected %zu bytes of values, found blocks of %zu", size, to));
        return out;
    }

    template <class Out>
    void append(const Array& array, std::uint64_t values, std::vector<Out>& out, const Progress& progress) {
        progress.report(0);
        out.reserve(out.size() + values);
        if (!array.text) {
            if (!std::is_floating_point_v<Out> && !is_integer(array.type))
                fail(array.where, "expected an integer type, found a floating-point type");
            return append_numbers(array.type, array.bytes.data(), values, swap_, out);
        }
        const File text{file_.name, array.where.child_value(), progress};
        Scanner in(text);
        try {
            for (std::uint64_t i = 0; i < values; ++i) {
                in.skip_space();
                if constexpr (std::is_floating_point_v<Out>)
                    out.push_back(in.real("a coordinate"));
                else
                    out.push_back(static_cast<Out>(in.integer<std::int64_t>("a whole number")));
            }
            in.skip_space();
            if (!in.done()) in.expected("the end of the array");
        } catch (const Error& error) {
            if (error.result() == VOX_ERROR_INVALID_STATE) throw; // cancelled
            fail(array.where, format("in the array's text: %s", error.what()), error.result());
        }
    }

    std::uint64_t number_of(const pugi::xml_node& piece, const char* name) {
        const std::string_view text = piece.attribute(name).value();
        std::uint64_t number = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc{} || stop != text.data() + text.size() || number > max_count)
            fail(piece, format("expected %s from 0 to %llu, found \"%s\"", name, llu(max_count),
                               printable(text).c_str()));
        return number;
    }

    pugi::xml_node cell_array(const pugi::xml_node& cells, const char* name) {
        const pugi::xml_node array = cells.find_child_by_attribute("DataArray", "Name", name);
        if (!array) fail(cells, format("expected a DataArray named %s, found none", name));
        return array;
    }

    // Appends the points of a piece to the positions; returns how many.
    std::uint64_t read_points(const pugi::xml_node& piece, const Progress& progress) {
        const std::uint64_t points = number_of(piece, "NumberOfPoints");
        const std::uint64_t first_vertex = data_.positions.size() / 3;
        if (first_vertex + points > max_count)
            fail(piece, format("more than %llu points in all", llu(max_count)), VOX_ERROR_LIMIT);
        if (points > 0) {
            const pugi::xml_node array = piece.child("Points").child("DataArray");
            if (!array) fail(piece, "expected a DataArray in an element Points, found none");
            const auto components = array.attribute("NumberOfComponents").as_ullong(3);
            if (components != 3) fail(array, format("expected 3 components, found %llu", llu(components)));
            append(open(array, 3 * points), 3 * points, data_.positions, progress);
            for (std::uint64_t i = 3 * first_vertex; i < data_.positions.size(); ++i)
                if (!std::isfinite(data_.positions[i]))
                    fail(array, format("point %llu: expected a coordinate, found one that is not finite",
                                       llu(i / 3 - first_vertex)));
        }
        return points;
    }

    // The offsets and the connectivity of `cells` cells.
    VtkPolygons read_list(const pugi::xml_node& node, std::uint64_t cells, const Progress& progress) {
        VtkPolygons out;
        std::vector<std::uint64_t>& ends = out.ends;
        const pugi::xml_node offsets = cell_array(node, "offsets");
        append(open(offsets, cells), cells, ends, progress.part(0, 0.2));
        for (std::uint64_t c = 0; c < cells; ++c)
            if (ends[c] < (c == 0 ? 0 : ends[c - 1]) || ends[c] > 8 * max_count)
                fail(offsets, format("expected offsets that ascend, found %lld at cell %llu",
                                     static_cast<long long>(ends[c]), llu(c)));
        const pugi::xml_node list = cell_array(node, "connectivity");
        append(open(list, ends.back()), ends.back(), out.connectivity, progress.part(0.2, 1));
        return out;
    }
    VtkFail fail_at(const pugi::xml_node& node) const {
        return [this, list = node.find_child_by_attribute("DataArray", "Name", "connectivity")](
                   std::size_t cell, const std::string& text) {
            fail(list, format("cell %zu: %s", cell, text.c_str()));
        };
    }

    void read_piece(const pugi::xml_node& piece, const Progress& progress) {
        const std::uint64_t cells = number_of(piece, "NumberOfCells");
        const std::uint64_t first_vertex = data_.positions.size() / 3;
        const std::uint64_t points = read_points(piece, progress.part(0, 0.4));
        if (cells == 0) return;
        const pugi::xml_node node = piece.child("Cells");
        if (!node) fail(piece, "expected an element Cells, found none");
        const VtkPolygons list = read_list(node, cells, progress.part(0.4, 0.9));
        std::vector<std::uint64_t> types;
        const pugi::xml_node kinds = cell_array(node, "types");
        append(open(kinds, cells), cells, types, progress.part(0.9, 1));
        take_vtk_cells(list, types, regions_of(piece, cells), first_vertex, points, data_, cells_,
                       fail_at(node));
    }

    // Files are read without regions if these cannot be read.
    RegionArray regions_of(const pugi::xml_node& piece, std::uint64_t cells) {
        RegionArray found;
        for (const pugi::xml_node array : piece.child("CellData").children("DataArray")) {
            const std::string_view name = array.attribute("Name").value();
            const std::optional<NumberType> type = vtk_number(array.attribute("type").value());
            if (!type ||
                !found.wants(name, array.attribute("NumberOfComponents").as_ullong(1), is_integer(*type)))
                continue;
            std::vector<double> numbers;
            try {
                append(open(array, cells), cells, numbers, {});
                found.take(name, numbers);
            } catch (const Error& error) {
                if (error.result() == VOX_ERROR_INVALID_STATE) throw; // cancelled
                data_.notes.push_back(format("a cell array was left out: %s", error.what()));
            }
        }
        return found;
    }

    void read_surface_piece(const pugi::xml_node& piece, const Progress& progress, SurfaceBuilder& surface) {
        const std::size_t first_point = surface.points();
        const std::uint64_t points = read_points(piece, progress.part(0, 0.4));
        surface.begin_mesh();
        surface.reserve_points(first_point + points);
        for (std::size_t i = 0; i < 3 * points; i += 3) surface.point(&data_.positions[i]);
        data_.positions.clear();
        const auto cells_of = [&](const char* number) {
            return piece.attribute(number) ? number_of(piece, number) : 0;
        };
        for (const char* loose : {"NumberOfVerts", "NumberOfLines"}) surface.skip(cells_of(loose));
        for (const bool strips : {false, true}) {
            const std::uint64_t cells = cells_of(strips ? "NumberOfStrips" : "NumberOfPolys");
            if (cells == 0) continue;
            const pugi::xml_node node = piece.child(strips ? "Strips" : "Polys");
            if (!node) fail(piece, format("expected an element %s, found none", strips ? "Strips" : "Polys"));
            const VtkPolygons list =
                read_list(node, cells, strips ? progress.part(0.8, 1) : progress.part(0.4, 0.8));
            take_vtk_polygons(list, strips, first_point, surface, fail_at(node));
        }
    }

    const File& file_;
    std::uint32_t mesh_index_; // of a surface
    pugi::xml_document document_;
    std::string_view appended_;
    bool appended_base64_ = false;
    bool swap_ = false;
    Packing packing_ = Packing::none;
    std::size_t header_size_ = 4;
    MeshData data_;
    Cells cells_;
};

} // namespace

MeshData read_vtu(const File& file, std::uint32_t mesh_index) { return VtuReader(file, mesh_index).read(); }

} // namespace vox::io
