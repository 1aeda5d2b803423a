// Writes Gmsh .msh 2.2 and 4.1 (Gmsh reference manual, "File formats"). All triangles belong to entity 1 of
// dimension 2, all tets to entity 1 of dimension 3.
#include "base/llu.hpp"
#include "io/formats/writers.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <limits>

namespace vox::io {
namespace {

struct Kind {
    std::span<const std::uint32_t> corners;
    std::uint32_t nodes, type, dimension;
    std::uint64_t count() const { return corners.size() / nodes; }
};

// Writes the sections of a file. Numbers are bytes, or text in rows with a blank between two numbers.
class MshWriter {
public:
    MshWriter(const vox_io_mesh_view& mesh, bool binary, Output& out)
        : mesh_(mesh), binary_(binary), out_(out) {}

    void write(vox_io_write_format version, const WrittenData& values) {
        const bool version_41 = version == VOX_IO_WRITE_MSH_41;
        out_ << "$MeshFormat\n" << (version_41 ? "4.1" : "2.2") << (binary_ ? " 1 8\n" : " 0 8\n");
        if (binary_) out_.binary<std::uint32_t>(1) << '\n';
        out_ << "$EndMeshFormat\n";
        if (version_41)
            write_blocks();
        else
            write_lists();
        for (const vox_io_point_data& data : values.points) write_values("NodeData", data, vertices_);
        for (const vox_io_point_data& data : values.cells) write_values("ElementData", data, elements_);
    }

private:
    template <class Number>
    void put(Number number) {
        if (binary_) {
            out_.binary(number);
            return;
        }
        if (!row_is_empty_) out_ << ' ';
        out_ << number;
        row_is_empty_ = false;
    }
    void end_row() {
        if (!binary_) out_ << '\n';
        row_is_empty_ = true;
    }
    template <class... Number>
    void row(Number... numbers) {
        (put(numbers), ...);
        end_row();
    }

    void end_section(std::string_view mark) { out_ << (binary_ ? "\n" : "") << mark; }

    // ---- version 2.2; integers have 32 bits ----

    void write_lists() {
        if (elements_ > std::numeric_limits<std::int32_t>::max())
            throw_error(VOX_ERROR_LIMIT, "%llu elements are more than .msh 2.2 can number", llu(elements_));
        out_ << "$Nodes\n" << vertices_ << '\n';
        const double* p = mesh_.positions;
        for (std::uint32_t v = 0; v < vertices_; ++v, p += 3) row(v + 1, p[0], p[1], p[2]);
        end_section("$EndNodes\n");

        out_ << "$Elements\n" << elements_ << '\n';
        const std::uint32_t tags = 2;
        std::uint32_t number = 1;
        for (const Kind& kind : kinds_) {
            if (kind.count() == 0) continue;
            if (binary_) row(kind.type, static_cast<std::uint32_t>(kind.count()), tags);
            for (std::size_t i = 0; i < kind.corners.size(); i += kind.nodes) {
                put(number++);
                if (!binary_) {
                    put(kind.type);
                    put(tags);
                }
                put(std::uint32_t{1});
                put(std::uint32_t{1});
                for (std::uint32_t c = 0; c < kind.nodes; ++c) put(kind.corners[i + c] + 1);
                end_row();
            }
        }
        end_section("$EndElements\n");
    }

    // ---- version 4.1; counts and the numbers of nodes and elements have 64 bits ----

    void write_blocks() {
        constexpr std::uint32_t entity = 1, parametric = 0;
        constexpr std::uint64_t one = 1;
        const bool volume = kinds_[1].count() > 0, surface = kinds_[0].count() > 0 || !volume;
        write_entities(surface, volume);

        out_ << "$Nodes\n"; // in one block
        row(one, vertices_, one, vertices_);
        row(std::uint32_t{volume ? 3u : 2u}, entity, parametric, vertices_);
        for (std::uint64_t v = 0; v < vertices_; ++v) row(v + 1);
        const double* p = mesh_.positions;
        for (std::uint64_t v = 0; v < vertices_; ++v, p += 3) row(p[0], p[1], p[2]);
        end_section("$EndNodes\n");

        out_ << "$Elements\n";
        const std::uint64_t blocks = (kinds_[0].count() > 0) + (kinds_[1].count() > 0);
        row(blocks, elements_, one, elements_);
        std::uint64_t number = 1;
        for (const Kind& kind : kinds_) {
            if (kind.count() == 0) continue;
            row(kind.dimension, entity, kind.type, kind.count());
            for (std::size_t i = 0; i < kind.corners.size(); i += kind.nodes) {
                put(number++);
                for (std::uint32_t c = 0; c < kind.nodes; ++c) put(std::uint64_t{kind.corners[i + c]} + 1);
                end_row();
            }
        }
        end_section("$EndElements\n");
    }

    // At most one surface and one volume, both with the box of all vertices, and without physical groups and
    // boundaries.
    void write_entities(bool surface, bool volume) {
        constexpr std::uint64_t none = 0;
        double box[6] = {};
        for (std::size_t i = 0; i < 3 * vertices_; ++i) {
            const std::size_t k = i % 3;
            box[k] = i < 3 ? mesh_.positions[i] : std::min(box[k], mesh_.positions[i]);
            box[3 + k] = i < 3 ? mesh_.positions[i] : std::max(box[3 + k], mesh_.positions[i]);
        }
        out_ << "$Entities\n";
        row(none, none, std::uint64_t{surface}, std::uint64_t{volume});
        for (const bool present : {surface, volume})
            if (present) row(std::uint32_t{1}, box[0], box[1], box[2], box[3], box[4], box[5], none, none);
        end_section("$EndEntities\n");
    }

    // ---- both versions ----

    // `section` is NodeData or ElementData.
    void write_values(const std::string& section, const vox_io_point_data& array, std::uint64_t count) {
        out_ << "$" << section << "\n1\n\"" << array.name << "\"\n1\n0\n3\n0\n"
             << array.components << '\n'
             << count << '\n';
        const double* value = array.values;
        for (std::uint32_t i = 0; i < count; ++i) {
            put(i + 1);
            for (std::uint32_t c = 0; c < array.components; ++c) put(*value++);
            end_row();
        }
        end_section("$End" + section + "\n");
    }

    const vox_io_mesh_view& mesh_;
    const bool binary_;
    Output& out_;
    bool row_is_empty_ = true;
    const std::uint64_t vertices_ = mesh_.vertex_count;
    const Kind kinds_[2] = {{{mesh_.triangles, static_cast<std::size_t>(3 * mesh_.triangle_count)}, 3, 2, 2},
                            {{mesh_.tets, static_cast<std::size_t>(4 * mesh_.tet_count)}, 4, 4, 3}};
    const std::uint64_t elements_ = kinds_[0].count() + kinds_[1].count();
};

} // namespace

void write_msh(const vox_io_mesh_view& mesh, vox_io_write_format version, const WrittenData& values,
               bool binary, Output& out) {
    MshWriter(mesh, binary, out).write(version, values);
}

} // namespace vox::io
