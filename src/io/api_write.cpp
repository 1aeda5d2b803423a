// The C border of writing.
#include "base/border.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "io/formats/paths.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/writers.hpp"
#include "io/mesh.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace vox::io {
namespace {

// `what` is the field's name, and `owner` what has values, of which there are `owners`.
void check_data(const char* what, const char* owner, const vox_io_point_data* list, std::uint64_t count,
                std::uint64_t owners) {
    if (count > 0) require(list, format("vox_io_write_desc.%s", what).c_str());
    for (std::uint64_t i = 0; i < count; ++i) {
        const vox_io_point_data& data = list[i];
        const std::string where = format("%s[%llu]", what, llu(i));
        require(data.name, (where + ".name").c_str());
        if (!*data.name) refuse(where + ".name is empty");
        for (const char* c = data.name; *c; ++c)
            if (static_cast<unsigned char>(*c) < ' ' || *c == '"' || *c == 0x7f)
                refuse(where + ".name holds a control character or a double quote");
        if (data.components != 1 && data.components != 3 && data.components != 9)
            refuse(where + format(".components is %u, not 1, 3 or 9", data.components));
        if (data.reserved != 0) refuse(where + format(".reserved is %u, not 0", data.reserved));
        const std::uint64_t values = data.components * owners;
        if (values > 0) require(data.values, (where + ".values").c_str());
        for (std::uint64_t v = 0; v < values; ++v)
            if (!std::isfinite(data.values[v]))
                throw Error(VOX_ERROR_NON_FINITE,
                            where + format(" (%s) is not finite at %s %llu", printable(data.name).c_str(),
                                           owner, llu(v / data.components)));
    }
}

vox_io_write_desc checked(const vox_io_write_desc* in, const vox_io_mesh& mesh) {
    vox_io_write_desc desc{};
    if (in) desc = read_struct(in, "vox_io_write_desc");
    check_enum(desc.format, VOX_IO_WRITE_VTU, "vox_io_write_desc.format");
    if (desc.binary > 1) refuse(format("vox_io_write_desc.binary is %u, neither 0 nor 1", desc.binary));
    if (desc.reserved != 0) refuse(format("vox_io_write_desc.reserved is %u, not 0", desc.reserved));
    const vox_io_report& report = mesh.report;
    check_data("point_data", "vertex", desc.point_data, desc.point_data_count, report.vertices);
    check_data("cell_data", "cell", desc.cell_data, desc.cell_data_count, report.triangles + report.tets);
    return desc;
}

void write(const vox_io_mesh& mesh, const vox_io_write_desc& desc,
           std::function<void(std::string_view)> sink) {
    Output out(std::move(sink));
    const WrittenData values{{desc.point_data, static_cast<std::size_t>(desc.point_data_count)},
                             {desc.cell_data, static_cast<std::size_t>(desc.cell_data_count)}};
    const bool binary = desc.binary != 0;
    if (desc.format == VOX_IO_WRITE_VTU)
        write_vtu(mesh.view, values, binary, out);
    else
        write_msh(mesh.view, desc.format, values, binary, out);
    out.flush();
}

[[noreturn]] void fail(const std::string& path, int error) {
    throw_error(VOX_ERROR_FILE, "%s: %s", path.c_str(), std::strerror(error));
}

// Writes to a file beside `path` and moves it there at the end. If `path` is not a regular file (a pipe, a
// terminal), it is written directly.
void write_file(const vox_io_mesh& mesh, const vox_io_write_desc& desc, const std::string& path) {
    const std::filesystem::path to = path_of(path);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(to, error);
    if (std::filesystem::is_directory(status)) fail(path, EISDIR);
    const bool direct = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    const std::string target = direct ? path : path + ".part";
    const std::filesystem::path part = path_of(target); // now, as `close` must not fail
    bool done = false;
    {
        const auto close = [&](std::FILE* file) {
            (void)std::fclose(file);
            if (!direct && !done) (void)std::filesystem::remove(part, error);
        };
        std::unique_ptr<std::FILE, decltype(close)> file(open_to_write(target), close);
        if (!file) fail(path, errno);
        write(mesh, desc, [&](std::string_view bytes) {
            if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) fail(path, errno);
        });
        if (std::fflush(file.get()) != 0) fail(path, errno);
        done = true;
    }
    if (direct) return;
    std::filesystem::rename(part, to, error);
    if (error) {
        const std::string reason = error.message();
        (void)std::filesystem::remove(part, error);
        throw_error(VOX_ERROR_FILE, "%s: %s", path.c_str(), reason.c_str());
    }
}

} // namespace
} // namespace vox::io

using namespace vox;
using namespace vox::io;

vox_result vox_io_write(const vox_io_mesh* mesh, const char* path, const vox_io_write_desc* desc) {
    return border([&] {
        require(mesh, "mesh");
        require(path, "path");
        vox_io_write_desc settings = checked(desc, *mesh);
        if (settings.format == VOX_IO_WRITE_AUTO) {
            const std::string extension = extension_of(path);
            if (extension != "msh" && extension != "vtu")
                throw_error(VOX_ERROR_UNSUPPORTED, "%s: expected a name that ends with .msh or .vtu", path);
            settings.format = extension == "msh" ? VOX_IO_WRITE_MSH_41 : VOX_IO_WRITE_VTU;
        }
        write_file(*mesh, settings, path);
    });
}

vox_result vox_io_write_to(const vox_io_mesh* mesh, const vox_io_write_desc* desc, const vox_io_sink* sink) {
    return border([&] {
        require(mesh, "mesh");
        require(sink, "sink");
        if (!sink->write) refuse("sink->write is null");
        const vox_io_write_desc settings = checked(desc, *mesh);
        if (settings.format == VOX_IO_WRITE_AUTO)
            refuse("vox_io_write_desc.format is AUTO, which needs a file name");
        write(*mesh, settings, [&](std::string_view bytes) {
            const CallersFloats floats;
            if (!bytes.empty() && sink->write(bytes.data(), bytes.size(), sink->user) != 0)
                throw_error(VOX_ERROR_FILE, "the sink reports a failure");
        });
    });
}
