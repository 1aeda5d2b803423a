// vox_io.hpp: vox_io.h for C++20, under the rules of vox.hpp. Every function here stands for the one of
// vox_io.h that its comment names.
#ifndef VOX_VOX_IO_HPP
#define VOX_VOX_IO_HPP

#include <vox/vox.hpp>
#include <vox/vox_io.h>

namespace vox {
namespace io {

// vox_io_mesh. Move-only; its destructor is vox_io_mesh_destroy. One that was moved from is null: calls fail.
class mesh {
public:
    mesh() noexcept = default; // null
    // Takes over a mesh made in C.
    static mesh adopt(vox_io_mesh* raw) noexcept { return mesh(raw); }
    // The mesh that `call` makes in C.
    template <class F>
    static mesh made(F&& call) {
        vox_io_mesh* raw = nullptr;
        detail::check(call(&raw));
        return mesh(raw);
    }
    // The same under a desc with a callable for its progress. What that throws cancels the call.
    template <class D, class F, class C>
    static mesh made(D desc, F& progress, C&& call) {
        using context = detail::called_back<F>;
        context with{progress};
        desc.progress = [](double fraction, void* user) -> std::int32_t {
            context& at = *static_cast<context*>(user);
            bool go_on = false;
            at.caught.run([&] { go_on = at.call(fraction); });
            return go_on ? 0 : 1;
        };
        desc.progress_user = &with;
        vox_io_mesh* raw = nullptr;
        const vox_result result = call(desc, &raw);
        mesh made(raw);
        with.caught.rethrow();
        detail::check(result);
        return made;
    }
    const vox_io_mesh* get() const noexcept { return mesh_.get(); }

    // vox_io_mesh_get_arrays. The spans live as long as the mesh.
    vox_io_mesh_view view() const& { return detail::filled<vox_io_mesh_view>(vox_io_mesh_get_arrays, get()); }
    void view() const&& = delete;
    // Three numbers a vertex, four corners a tetrahedron, three a triangle; empty for a null mesh.
    span<const double> positions() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.positions, static_cast<std::size_t>(3 * v.vertex_count)};
    }
    span<const std::uint32_t> tets() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.tets, static_cast<std::size_t>(4 * v.tet_count)};
    }
    span<const std::uint32_t> triangles() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.triangles, static_cast<std::size_t>(3 * v.triangle_count)};
    }
    // A number for each tetrahedron, and for each vertex and tetrahedron its number in the file; empty where the view
    // has null.
    span<const std::int32_t> tet_regions() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.tet_regions, static_cast<std::size_t>(v.tet_regions ? v.tet_count : 0)};
    }
    span<const std::uint32_t> file_vertices() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.file_vertices, static_cast<std::size_t>(v.file_vertices ? v.vertex_count : 0)};
    }
    span<const std::uint32_t> tet_cells() const& noexcept {
        const vox_io_mesh_view v = arrays();
        return {v.tet_cells, static_cast<std::size_t>(v.tet_cells ? v.tet_count : 0)};
    }
    void tet_regions() const&& = delete;
    void tet_cells() const&& = delete;
    void file_vertices() const&& = delete;
    void positions() const&& = delete;
    void tets() const&& = delete;
    void triangles() const&& = delete;
    // vox_io_mesh_describe over the defaults, for grid::insert: borrows the mesh.
    vox_mesh_desc desc() const& {
        vox_mesh_desc desc = vox_default_mesh_desc();
        detail::check(vox_io_mesh_describe(get(), &desc));
        return desc;
    }
    void desc() const&& = delete;
    // vox_io_mesh_get_report
    vox_io_report report() const { return detail::filled<vox_io_report>(vox_io_mesh_get_report, get()); }
    // vox_io_mesh_get_warnings
    const char* warnings() const& noexcept { return vox_io_mesh_get_warnings(get()); }
    void warnings() const&& = delete;
    // vox_io_mesh_measure, beside a surface or by itself
    vox_io_quality quality(const mesh& surface) const { return measured(surface.get()); }
    vox_io_quality quality() const { return measured(nullptr); }
    // vox_io_write
    void write(const char* path, const vox_io_write_desc& desc = vox_default_io_write_desc()) const {
        return detail::check(vox_io_write(get(), path, &desc));
    }
    void write(const std::string& path, const vox_io_write_desc& desc = vox_default_io_write_desc()) const {
        return write(path.c_str(), desc);
    }
    // vox_io_write_to: `sink` takes a span<const std::byte>. What it throws ends the writing.
    template <class F>
    requires std::is_invocable_v<F&, span<const std::byte>>
    void write_to(F&& sink, const vox_io_write_desc& desc) const {
        using context = detail::called_back<std::remove_reference_t<F>>;
        context with{sink};
        const vox_io_sink to = {[](const void* data, std::size_t size, void* user) -> std::int32_t {
                                    context& at = *static_cast<context*>(user);
                                    const span<const std::byte> bytes(static_cast<const std::byte*>(data), size);
                                    return at.caught.run([&] { at.call(bytes); }) ? 0 : 1;
                                },
                                &with};
        const vox_result result = vox_io_write_to(get(), &desc, &to);
        with.caught.rethrow();
        detail::check(result);
    }

private:
    struct deleter {
        void operator()(vox_io_mesh* raw) const noexcept { vox_io_mesh_destroy(raw); }
    };
    explicit mesh(vox_io_mesh* raw) noexcept : mesh_(raw) {}
    vox_io_mesh_view arrays() const noexcept {
        vox_io_mesh_view view{};
        if (mesh_) (void)vox_io_mesh_get_arrays(get(), &view);
        return view;
    }
    vox_io_quality measured(const vox_io_mesh* surface) const {
        return detail::filled<vox_io_quality>(vox_io_mesh_measure, get(), surface);
    }
    std::unique_ptr<vox_io_mesh, deleter> mesh_;
};

// A file in memory: vox_io_source.
inline vox_io_source source(const char* name, span<const std::byte> bytes) noexcept {
    return {name, bytes.data(), bytes.size()};
}

// vox_io_load
inline mesh load(const char* path, const vox_io_load_desc& desc = vox_default_io_load_desc()) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_load(path, &desc, out); });
}
inline mesh load(const std::string& path, const vox_io_load_desc& desc = vox_default_io_load_desc()) {
    return load(path.c_str(), desc);
}
// The same with a callable for the progress: takes the fraction and returns whether to go on. What it throws cancels.
template <class F>
requires std::is_invocable_r_v<bool, F&, double> mesh load(const std::string& path, const vox_io_load_desc& desc,
                                                           F&& progress) {
    return mesh::made(desc, progress, [&](const vox_io_load_desc& with, vox_io_mesh** out) {
        return vox_io_load(path.c_str(), &with, out);
    });
}
// vox_io_read: one source, or both files of TetGen
inline mesh read(span<const vox_io_source> sources, const vox_io_load_desc& desc = vox_default_io_load_desc()) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_read(sources.data(), sources.size(), &desc, out); });
}
// vox_io_mesh_create, of packed doubles and indices, three a triangle
inline mesh create(span<const double> positions, const vox::tets& tets, span<const std::uint32_t> triangles = {}) {
    vox_io_mesh_view arrays{};
    arrays.positions = positions.data();
    arrays.vertex_count = positions.size() / 3;
    arrays.tets = tets.data;
    arrays.tet_count = tets.count;
    arrays.triangles = triangles.data();
    arrays.triangle_count = triangles.size() / 3;
    if (positions.size() % 3 != 0 || triangles.size() % 3 != 0)
        detail::refuse("create: %llu numbers of positions and %llu of triangles, not in threes", positions.size(),
                       triangles.size());
    return mesh::made([&](vox_io_mesh** out) { return vox_io_mesh_create(&arrays, out); });
}
// vox_io_tetrahedralize
inline mesh tetrahedralize(const mesh& surface,
                           const vox_io_tetrahedralize_desc& desc = vox_default_io_tetrahedralize_desc()) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_tetrahedralize(surface.get(), &desc, out); });
}
// The same with a callable for the progress, as for load.
template <class F>
requires std::is_invocable_r_v<bool, F&, double>
    mesh tetrahedralize(const mesh& surface, const vox_io_tetrahedralize_desc& desc, F&& progress) {
    return mesh::made(desc, progress, [&](const vox_io_tetrahedralize_desc& with, vox_io_mesh** out) {
        return vox_io_tetrahedralize(surface.get(), &with, out);
    });
}

// vox_io_format_string
inline const char* name_of(vox_io_format format) noexcept { return vox_io_format_string(format); }

// vox_io_make_X
inline mesh make_lattice_ball(std::uint64_t tet_count, double radius) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_lattice_ball(tet_count, radius, out); });
}
inline mesh make_ball(double radius, double cell) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_ball(radius, cell, out); });
}
inline mesh make_torus(double radius, double tube_radius, double cell) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_torus(radius, tube_radius, cell, out); });
}
inline mesh make_capsule(double radius, double length, double cell) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_capsule(radius, length, cell, out); });
}
inline mesh make_cylinder(double radius, double length, double cell) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_cylinder(radius, length, cell, out); });
}
inline mesh make_box(double size_x, double size_y, double size_z, double cell) {
    return mesh::made([&](vox_io_mesh** out) { return vox_io_make_box(size_x, size_y, size_z, cell, out); });
}

} // namespace io
} // namespace vox

#endif
