#include "io/formats/regions.hpp"

#include "base/error.hpp"
#include "io/formats/vtk_cells.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace vox::io {
namespace {

// In lower case, as meshio, Gmsh, PyVista, dolfinx, VMTK, SALOME and OpenGeoSys write them.
constexpr std::string_view region_names[] = {
    "region",      "regions",   "region_id",    "regionid",     "region_ids",    "gmsh:physical",
    "medit:ref",   "cell_tags", "cell_markers", "celltags",     "cellentityids", "physical",
    "physical_id", "material",  "materials",    "materialids",  "material_id",   "material_ids",
    "mat_id",      "subdomain", "subdomains",   "subdomain_id", "domain",        "domain_id",
    "label",       "labels",    "part_id",      "tet_regions"};

bool names_regions(std::string_view name) {
    std::string lower(name);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::find(std::begin(region_names), std::end(region_names), lower) != std::end(region_names);
}

class EntityReader {
public:
    EntityReader(const File& section, int version, bool binary, bool swap)
        : in_(section), version_(version), binary_(binary), swap_(swap) {}

    std::map<std::int64_t, std::int32_t> read() {
        std::uint64_t counts[4];
        for (std::uint64_t& count : counts) count = number<std::uint64_t>("a number of entities");
        std::map<std::int64_t, std::int32_t> groups;
        for (int dimension = 0; dimension < 4; ++dimension)
            for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
                const auto entity = number<std::int32_t>("an entity");
                for (int k = dimension == 0 && version_ == 41 ? 3 : 6; k > 0; --k) skip_coordinate();
                const std::int32_t group = first_of_list();
                if (dimension > 0) first_of_list(); // of its boundary
                if (dimension == 3 && group != 0) groups.emplace(entity, group);
            }
        return groups;
    }

private:
    template <class Integer>
    Integer number(const char* what) {
        if (binary_) return in_.binary<Integer>(swap_, what);
        in_.skip_space();
        return in_.integer<Integer>(what);
    }
    void skip_coordinate() {
        if (binary_) {
            in_.take(sizeof(double), "a coordinate");
            return;
        }
        in_.skip_space();
        in_.word("a coordinate");
    }
    std::int32_t first_of_list() {
        std::int32_t first = 0;
        const auto count = number<std::uint64_t>("a number of tags");
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto tag = number<std::int32_t>("a tag");
            if (i == 0) first = tag;
        }
        return first;
    }

    Scanner in_;
    int version_;
    bool binary_, swap_;
};

// Attributes of a legacy VTK file ("VTK File Formats", Kitware, "Dataset Attribute Format").
class AttributeReader {
public:
    AttributeReader(Scanner& in, bool binary, std::uint64_t cells)
        : in_(in), binary_(binary), cells_(cells) {}

    RegionArray read() {
        try {
            for (in_.skip_space(); !in_.done(); in_.skip_space())
                if (!read_one(std::string(in_.word("a keyword")))) break;
        } catch (const Error& error) {
            if (error.result() == VOX_ERROR_INVALID_STATE) throw; // cancelled
        }
        return std::move(found_);
    }

private:
    bool read_one(const std::string& keyword) {
        if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
            of_cells_ = keyword == "CELL_DATA";
            owners_ = count("a number of points or cells");
            return true;
        }
        if (keyword == "METADATA") { // up to an empty line
            in_.line_end();
            while (!in_.done() && !in_.at_line_end()) in_.skip_line();
            return true;
        }
        const std::string name(in_.word("a name"));
        if (keyword == "FIELD") {
            for (std::uint64_t arrays = count("a number of arrays"); arrays > 0; --arrays) {
                in_.skip_space();
                const std::string array(in_.word("a name"));
                const std::uint64_t components = count("a number of components");
                const std::uint64_t tuples = count("a number of tuples");
                read_values(array, std::string(in_.word("a number type")), components, tuples);
            }
            return true;
        }
        if (keyword == "SCALARS") {
            const std::string type(in_.word("a number type"));
            const std::uint64_t components = in_.at_line_end() ? 1 : count("a number of components");
            in_.skip_space();
            const std::size_t values_at = in_.offset();
            if (in_.accept("LOOKUP_TABLE"))
                in_.word("a name");
            else
                in_.seek(values_at);
            read_values(name, type, components, owners_);
            return true;
        }
        if (keyword == "COLOR_SCALARS" || keyword == "LOOKUP_TABLE") {
            const std::uint64_t number = count("a number of values");
            const char* const type = binary_ ? "unsigned_char" : "float";
            if (keyword == "COLOR_SCALARS")
                read_values({}, type, number, owners_);
            else
                read_values({}, type, 4, number);
            return true;
        }
        const std::uint64_t components = keyword == "TEXTURE_COORDINATES" ? count("a dimension")
                                         : keyword == "GLOBAL_IDS"        ? 1
                                         : keyword == "TENSORS"           ? 9
                                         : keyword == "TENSORS6"          ? 6
                                                                          : 3;
        if (components == 3 && keyword != "VECTORS" && keyword != "NORMALS" &&
            keyword != "TEXTURE_COORDINATES")
            return false;
        read_values({}, std::string(in_.word("a number type")), components, owners_);
        return true;
    }

    std::uint64_t count(const char* what) { return in_.integer<std::uint64_t>(what); }

    void read_values(const std::string& name, const std::string& type_name, std::uint64_t components,
                     std::uint64_t tuples) {
        in_.line_end();
        const std::optional<NumberType> type = vtk_number(type_name);
        if (binary_ && !type) in_.unsupported("values of type %s", type_name.c_str());
        const bool wanted = type && of_cells_ && !name.empty() && tuples == cells_ &&
                            found_.wants(name, components, is_integer(*type));
        const std::size_t least = binary_ ? size_of(*type) : 1;
        if (tuples > 0 && components > in_.remaining() / least / tuples) in_.expected("more values");
        const std::uint64_t number = components * tuples;
        std::vector<double> values;
        if (binary_) {
            const char* const bytes = in_.take(number * size_of(*type), "values");
            if (wanted) append_numbers(*type, bytes, number, !host_is_big_endian, values);
        }
        for (std::uint64_t i = 0; !binary_ && i < number; ++i) {
            in_.skip_space();
            if (wanted)
                values.push_back(in_.real("a number"));
            else
                in_.word("a value");
        }
        if (wanted) found_.take(name, values);
    }

    Scanner& in_;
    bool binary_, of_cells_ = false;
    std::uint64_t cells_, owners_ = 0;
    RegionArray found_;
};

} // namespace

bool RegionArray::wants(std::string_view name, std::uint64_t components, bool integers) const {
    if (components != 1 || named_) return false;
    return names_regions(name) || (of_cells_.empty() && integers && !name.starts_with("vtk"));
}

void RegionArray::take(std::string_view name, const std::vector<double>& numbers) {
    const auto fits = [](double x) { return x == std::floor(x) && x >= -0x1p31 && x < 0x1p31; };
    if (!std::all_of(numbers.begin(), numbers.end(), fits)) return;
    of_cells_.clear();
    for (const double number : numbers) of_cells_.push_back(static_cast<std::int32_t>(number));
    named_ = names_regions(name);
}

std::map<std::int64_t, std::int32_t> gmsh_groups(const File& section, int version, bool binary, bool swap) {
    return EntityReader(section, version, binary, swap).read();
}

RegionArray vtk_regions(Scanner& in, bool binary, std::uint64_t cells) {
    return AttributeReader(in, binary, cells).read();
}

} // namespace vox::io
