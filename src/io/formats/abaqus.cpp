// Abaqus input files, .inp, as CalculiX, Gmsh and others write them, too (Abaqus Keywords Reference Guide,
// "Node", "Element", "Part", "Instance"): tetrahedra, triangles, and the instances of parts where they are
// placed.
#include "io/formats/node_numbers.hpp"
#include "io/formats/placement.hpp"
#include "io/formats/readers.hpp"

#include <cctype>
#include <deque>
#include <map>
#include <numbers>

namespace vox::io {
namespace {

std::string upper_case(std::string_view text) {
    std::string out;
    for (const char c : text)
        if (!Scanner::is_blank(c)) out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return out;
}

struct ElementKind {
    CellKind cell;
    int nodes; // 0 for elements that are always left out
    const char* name;
};

// DC3D4, C3D10M and others of heat, sound and hybrid or modified formulation have letters before and behind.
ElementKind kind_of(const std::string& type) {
    const std::size_t solid = type.find("C3D"), shell = type.starts_with("SC") ? 2 : std::string::npos;
    const std::size_t digits = solid != std::string::npos ? solid + 3 : shell; // continuum shells: SC8R
    int nodes = 0;
    if (digits != std::string::npos) std::from_chars(type.data() + digits, type.data() + type.size(), nodes);
    if (nodes == 4 || nodes == 10) return {CellKind::tet, nodes, ""};
    if (nodes == 5 || nodes == 13) return {CellKind::pyramid, nodes, "pyramids"};
    if (nodes == 6 || nodes == 15) return {CellKind::wedge, nodes, "wedges"};
    if (nodes == 8 || nodes == 20 || nodes == 27) return {CellKind::hexahedron, nodes, "hexahedra"};
    if (digits != std::string::npos || type.starts_with("COH3D"))
        return {CellKind::volume, 0, "elements of other types"};
    for (const std::string_view prefix : {"STRI", "SFM3D", "DS", "M3D", "R3D", "CPS", "CPE", "S"}) {
        if (!type.starts_with(prefix)) continue;
        std::from_chars(type.data() + prefix.size(), type.data() + type.size(), nodes);
        if (nodes == 65) nodes = 6; // STRI65: five degrees of freedom
        if (nodes == 3 || nodes == 6) return {CellKind::triangle, nodes, ""};
        break;
    }
    return {CellKind::other, 0, ""};
}

// Node numbers are those of a part, of an instance that has a mesh of its own, or of the assembly.
struct Part {
    std::string name;
    NodeNumbers numbers;
    MeshData data;
};

struct Instance {
    std::string of; // a part
    std::size_t at; // in the file
    Placement placement;
};

class AbaqusReader {
public:
    explicit AbaqusReader(const File& file) : file_(file), in_(file, 0, ','), cells_(file) {
        parts_.emplace_back();
    }

    // Nodes first, as elements may precede them.
    MeshData read() {
        read_blocks(true);
        for (Part& part : parts_) part.numbers.finish(in_);
        read_blocks(false);
        MeshData data = std::move(parts_[0].data);
        for (std::size_t p = 1; p < parts_.size(); ++p)
            if (instances_.empty() || parts_[p].name.empty()) append(parts_[p].data, {}, data);
        for (const Instance& instance : instances_) {
            const auto found = std::find_if(parts_.begin() + 1, parts_.end(),
                                            [&](const Part& part) { return part.name == instance.of; });
            if (!instance.of.empty() && found == parts_.end())
                in_.fail_at(instance.at, "expected the name of a part, found %s",
                            printable(instance.of).c_str());
            if (!instance.of.empty()) append(found->data, instance.placement, data);
        }
        data.notes = std::move(notes_);
        return cells_.finished(std::move(data));
    }

private:
    // ---- lines ----

    // Goes to the next line that is no comment. Returns whether it holds data, and not a keyword.
    bool next_data() {
        for (in_.skip_space(); in_.rest().starts_with("**"); in_.skip_space()) in_.skip_line();
        return !in_.done() && !in_.rest().starts_with('*');
    }

    // Reads a keyword, without its star, and its parameters. A comma at the end of a line continues it.
    std::string read_keyword(std::map<std::string, std::string>& parameters) {
        parameters.clear();
        std::string line;
        do {
            const std::string_view rest = in_.rest();
            line += upper_case(rest.substr(0, rest.find_first_of("\r\n")));
            in_.skip_line();
        } while (line.ends_with(',') && next_data());
        std::size_t end = std::min(line.find(','), line.size());
        const std::string keyword = line.substr(1, end - 1);
        while (end < line.size()) {
            const std::size_t start = end + 1;
            end = std::min(line.find(',', start), line.size());
            const std::size_t equals = std::min(line.find('=', start), end);
            std::string value = line.substr(std::min(equals + 1, end), end - std::min(equals + 1, end));
            std::erase(value, '"');
            parameters[line.substr(start, equals - start)] = std::move(value);
        }
        return keyword;
    }

    void read_blocks(bool nodes) {
        in_.seek(0);
        next_part_ = 1;
        part_ = 0;
        assembly_ = 0;
        std::map<std::string, std::string> parameters;
        while (next_data() || !in_.done()) {
            const std::size_t at = in_.offset();
            if (!in_.rest().starts_with('*')) in_.expected("a keyword (*...)");
            const std::string keyword = read_keyword(parameters);
            if (keyword == "PART" || keyword == "ASSEMBLY" || keyword == "INSTANCE") {
                part_ = next_part_++;
                if (keyword == "ASSEMBLY") assembly_ = part_;
                if (nodes) parts_.emplace_back().name = keyword == "PART" ? parameters["NAME"] : "";
                if (nodes && keyword == "INSTANCE") read_instance(parameters["PART"], at);
            } else if (keyword == "ENDINSTANCE") {
                part_ = assembly_;
            } else if (keyword == "ENDPART" || keyword == "ENDASSEMBLY") {
                part_ = assembly_ = 0;
            } else if (nodes) {
                read_nodes(keyword, parameters, at);
            } else if (keyword == "ELEMENT") {
                read_elements(kind_of(parameters["TYPE"]));
            }
            while (next_data()) in_.skip_line(); // data that are not needed
        }
    }

    // A translation, and in the next line a rotation: two points on its axis, and degrees.
    void read_instance(const std::string& of, std::size_t at) {
        Instance& instance = instances_.emplace_back(Instance{of, at, {}});
        Placement& placement = instance.placement;
        if (!next_data()) return;
        for (auto& row : placement.m) row[3] = field();
        in_.skip_line();
        if (!next_data()) return;
        double a[3], axis[3], length = 0;
        for (double& x : a) x = field();
        for (int k = 0; k < 3; ++k) {
            axis[k] = field() - a[k];
            length += axis[k] * axis[k];
        }
        const double angle = field() * std::numbers::pi / 180;
        if (!(length > 0) || !std::isfinite(length))
            in_.fail("expected two points of an axis, found the same twice, or too far away");
        const double c = std::cos(angle), s = std::sin(angle);
        for (double& x : axis) x /= std::sqrt(length);
        Placement turn;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            turn.m[i][i] = c + (1 - c) * axis[i] * axis[i];
            turn.m[i][j] = (1 - c) * axis[i] * axis[j] - s * axis[k];
            turn.m[i][k] = (1 - c) * axis[i] * axis[k] + s * axis[j];
        }
        for (int i = 0; i < 3; ++i)
            turn.m[i][3] = a[i] - turn.m[i][0] * a[0] - turn.m[i][1] * a[1] - turn.m[i][2] * a[2];
        placement = turn.of(placement);
        in_.skip_line();
    }

    // The next number of the line; 0 where there is none.
    double field() {
        const bool empty = in_.at_line_end() || in_.peek().empty();
        const double value = empty ? 0 : in_.real("a number");
        in_.accept_separator();
        return value;
    }

    // ---- nodes and elements ----

    void read_nodes(const std::string& keyword, std::map<std::string, std::string>& parameters,
                    std::size_t at) {
        for (const char* made : {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"})
            if (keyword == made)
                throw_error(VOX_ERROR_UNSUPPORTED,
                            "%s: *%s is not read: nodes and elements must be in the file",
                            in_.place(at).c_str(), made);
        const bool mesh = keyword == "NODE" || keyword == "ELEMENT";
        const std::string& system = parameters["SYSTEM"];
        if (mesh && !system.empty() && system != "R")
            throw_error(VOX_ERROR_UNSUPPORTED, "%s: SYSTEM=%s: rectangular coordinates are read",
                        in_.place(at).c_str(), printable(system).c_str());
        if (keyword == "INCLUDE" || (mesh && parameters.contains("INPUT")))
            notes_.push_back(format("%s: *%s: what is in another file, %s, was left out",
                                    in_.place(at).c_str(), keyword.c_str(),
                                    printable(parameters["INPUT"]).c_str()));
        if (keyword != "NODE") return;
        Part& part = parts_[part_];
        while (next_data()) {
            part.numbers.add(in_.integer<std::int64_t>("a node number"));
            in_.accept_separator();
            for (int k = 0; k < 3; ++k) part.data.positions.push_back(field());
            in_.skip_line();
            if (part.data.positions.size() / 3 > max_count) too_many("nodes");
        }
    }

    void read_elements(const ElementKind& kind) {
        Part& part = parts_[part_];
        const std::size_t wanted = cells_.corners_of(kind.cell);
        if (wanted == 0) {
            std::uint64_t count = 0;
            for (bool continued = false; next_data(); in_.skip_line()) {
                count += !continued;
                const std::string_view rest = in_.rest(), line = rest.substr(0, rest.find_first_of("\r\n"));
                continued = line.substr(0, line.find_last_not_of(" \t") + 1).ends_with(',');
            }
            return cells_.skip(kind.cell, kind.name, count, part.data);
        }
        while (next_data()) {
            in_.integer<std::int64_t>("an element number");
            std::uint32_t corners[most_corners];
            for (std::size_t i = 0; i < static_cast<std::size_t>(kind.nodes); ++i) {
                in_.accept_separator();
                if (in_.at_line_end() && !next_data()) in_.expected("a node number");
                const auto number = in_.integer<std::int64_t>("a node number");
                if (i < wanted) corners[i] = part.numbers.vertex_of(number, in_);
            }
            in_.skip_line();
            cells_.add(kind.cell, kind.name, static_cast<std::uint64_t>(kind.nodes), corners, 0, part.data);
        }
    }

    // Appends a placed part. As instances repeat parts, there may be no more nodes than a surface of the
    // file's size has, and twice as many tets, of which a hexahedron is six.
    void append(MeshData& part, const Placement& placement, MeshData& data) {
        const std::size_t first = data.positions.size() / 3;
        const std::uint64_t limit = std::min<std::uint64_t>(max_count, file_.bytes.size() / 6 + (1u << 17));
        if (first + part.positions.size() / 3 > limit || (data.tets.size() + part.tets.size()) / 8 > limit)
            too_many("nodes or tetrahedra", limit);
        for (std::size_t i = 0; i < part.positions.size(); i += 3) {
            double p[3];
            placement.apply(&part.positions[i], p);
            if (!is_finite(p))
                throw_error(VOX_ERROR_FORMAT, "%s: an instance of a part reaches beyond the range of doubles",
                            file_.name.c_str());
            data.positions.insert(data.positions.end(), p, p + 3);
        }
        const auto add = [](const std::vector<std::uint32_t>& from, std::size_t before,
                            std::vector<std::uint32_t>& to) {
            for (const std::uint32_t number : from) to.push_back(static_cast<std::uint32_t>(before + number));
        };
        number_cells(data, data.tets.size() / 4);
        number_cells(part, part.tets.size() / 4);
        add(part.high_tets, data.tets.size() / 4, data.high_tets);
        add(part.tets, first, data.tets);
        add(part.triangles, first, data.triangles);
        add(part.tet_cells, static_cast<std::size_t>(data.cells), data.tet_cells);
        data.cells += part.cells;
    }

    [[noreturn]] void too_many(const char* what, std::uint64_t limit = max_count) const {
        throw_error(VOX_ERROR_LIMIT, "%s: more %s than the limit of %llu", file_.name.c_str(), what,
                    llu(limit));
    }

    const File& file_;
    Scanner in_;
    std::deque<Part> parts_; // the first: what is in none
    std::vector<Instance> instances_;
    std::size_t part_ = 0, next_part_ = 1, assembly_ = 0; // at hand, next to begin, around instances
    Cells cells_;
    std::vector<std::string> notes_;
};

} // namespace

bool is_abaqus(std::string_view text) {
    const File file{"", text};
    Scanner in(file, 0, ',');
    for (in.skip_space(); in.rest().starts_with("**"); in.skip_space()) in.skip_line();
    const std::string keyword = upper_case(in.peek());
    static constexpr std::string_view starts[] = {"*HEADING",  "*NODE",     "*PART",    "*ELEMENT",
                                                  "*PREPRINT", "*ASSEMBLY", "*INCLUDE", "*MATERIAL"};
    return std::find(std::begin(starts), std::end(starts), keyword) != std::end(starts);
}

MeshData read_abaqus(const File& file) { return AbaqusReader(file).read(); }

} // namespace vox::io
