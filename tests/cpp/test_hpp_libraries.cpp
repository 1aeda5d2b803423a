// vox_io.hpp and vox_sim.hpp beside their C headers.
#include <vox/vox_io.hpp>
#include <vox/vox_sim.hpp>

#include "cpp/scene.hpp"
#include "cpp/throws.hpp"

#include <stdexcept>
#include <string>

namespace {

START_TEST(files_and_bodies) {
    const vox::io::mesh ball = vox::io::make_ball(1, 0.25);
    vox_io_mesh* raw = nullptr;
    vox_io_mesh_view arrays;
    ck_ok(vox_io_make_ball(1, 0.25, &raw));
    const vox::io::mesh same = vox::io::mesh::adopt(raw);
    ck_ok(vox_io_mesh_get_arrays(same.get(), &arrays));
    ck_assert_uint_eq(ball.positions().size(), 3 * arrays.vertex_count);
    ck_assert_mem_eq(ball.positions().data(), arrays.positions, ball.positions().size() * sizeof(double));
    ck_assert_mem_eq(ball.tets().data(), arrays.tets, ball.tets().size() * sizeof(std::uint32_t));
    ck_assert_uint_eq(ball.view().tet_count, arrays.tet_count);
    ck_assert_uint_eq(ball.report().tets, arrays.tet_count);
    ck_assert_str_eq(ball.warnings(), vox_io_mesh_get_warnings(same.get()));
    ck_assert_double_gt(ball.quality().min_dihedral, 10.6);
    for (const auto& make : {vox::io::make_torus(2, 0.5, 0.25), vox::io::make_capsule(1, 1, 0.25),
                             vox::io::make_cylinder(1, 1, 0.25)})
        ck_assert_uint_gt(make.tets().size(), 0);
    ck_assert_uint_gt(vox::io::make_lattice_ball(1000, 1).report().tets, 900);

    // Written to memory, read back, and put into a grid.
    std::vector<std::byte> bytes;
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = VOX_IO_WRITE_MSH_41;
    ball.write_to(
        [&](vox::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); }, desc);
    const vox_io_source sources[] = {vox::io::source("ball.msh", bytes)};
    const vox::io::mesh read = vox::io::read(sources);
    ck_assert_mem_eq(read.positions().data(), arrays.positions, read.positions().size() * sizeof(double));
    ck_assert_str_eq(vox::io::name_of(read.report().format), vox_io_format_string(VOX_IO_FORMAT_GMSH));
    vox::grid grid;
    grid.insert(read.desc());
    grid.insert(ball.desc());
    grid.step();
    ck_assert_uint_gt(grid.contacts().size(), 0);
    static_assert(!std::is_invocable_v<decltype(&vox::io::mesh::report), int>);

    const vox::io::mesh copy = vox::io::create(ball.positions(), ball.tets());
    ck_assert_uint_eq(copy.tets().size(), ball.tets().size());
    const std::string path = "hpp_libraries.msh";
    copy.write(path);
    ck_assert_uint_eq(vox::io::load(path).report().tets, arrays.tet_count);
    double last = 0;
    const auto watch = [&](double fraction) { return last = fraction, true; };
    const vox::io::mesh watched = vox::io::load(path, vox_default_io_load_desc(), watch);
    ck_assert_double_eq(last, 1);
    ck_assert_uint_eq(watched.tets().size(), ball.tets().size());
    throws([&] { vox::io::load(path, vox_default_io_load_desc(), [](double) { return false; }); },
           VOX_ERROR_INVALID_STATE, "cancel");
    ck_assert_int_eq(remove(path.c_str()), 0);

    throws([&] { vox::io::load("no such file.msh"); }, VOX_ERROR_FILE, "no such file.msh");
    throws([&] { vox::io::make_ball(-1, 0.25); }, VOX_ERROR_INVALID_ARGUMENT, "-1");
    throws([&] { vox::io::create(std::vector<double>(4), {}); }, VOX_ERROR_INVALID_ARGUMENT, "4 numbers");
    const vox::io::mesh none;
    throws([&] { (void)none.report(); }, VOX_ERROR_INVALID_ARGUMENT, "null");
    ck_assert(none.positions().empty());
    try {
        ball.write_to([](vox::span<const std::byte>) { throw std::runtime_error("full"); }, desc);
        ck_abort_msg("nothing was thrown");
    } catch (const std::runtime_error& error) {
        ck_assert_str_eq(error.what(), "full");
    }
}
END_TEST

// A temporary mesh has no arrays to look at.
template <class M, class = void>
struct can_describe : std::false_type {};
template <class M>
struct can_describe<M, std::void_t<decltype(std::declval<M>().desc().tets)>> : std::true_type {};
static_assert(can_describe<const vox::io::mesh&>::value && !can_describe<vox::io::mesh>::value);

START_TEST(surfaces_are_filled_with_progress) {
    const std::vector<double> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::uint32_t> triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const vox::io::mesh surface = vox::io::create(corners, {}, triangles);
    ck_assert_uint_eq(surface.triangles().size(), 12);
    vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
    desc.cell = 0.1;
    double last = 0;
    const vox::io::mesh filled =
        vox::io::tetrahedralize(surface, desc, [&](double fraction) { return last = fraction, true; });
    ck_assert_double_eq(last, 1);
    ck_assert_uint_eq(filled.report().tets, vox::io::tetrahedralize(surface, desc).report().tets);
    ck_assert_double_lt(filled.quality(surface).hausdorff, 0.2);
    throws([&] { vox::io::tetrahedralize(surface, desc, [](double) { return false; }); },
           VOX_ERROR_INVALID_STATE, "cancel");
    try {
        vox::io::tetrahedralize(surface, desc, [](double) -> bool { throw std::logic_error("enough"); });
        ck_abort_msg("nothing was thrown");
    } catch (const std::logic_error& error) {
        ck_assert_str_eq(error.what(), "enough");
    }
}
END_TEST

START_TEST(bodies_fall_as_in_c) {
    const vox::io::mesh box = vox::io::make_box(1, 1, 1, 0.5);
    vox::sim::simulation sim;
    vox_sim_body_desc desc = vox::sim::describe(box.positions(), box.tets());
    desc.user_data = 9;
    const vox_body body = sim.insert(desc);
    vox_sim* raw = nullptr;
    vox_body same = VOX_NULL_BODY;
    ck_ok(vox_sim_create(nullptr, &raw));
    vox::sim::simulation c = vox::sim::simulation::adopt(raw);
    ck_ok(vox_sim_body_insert(raw, &desc, &same));
    for (int i = 0; i < 3; ++i) {
        sim.step(0.02);
        ck_ok(vox_sim_step(raw, 0.02));
    }
    const vox_sim_body_view view = sim.body(body), other = c.body(same);
    ck_assert_mem_eq(view.positions, other.positions, 3 * view.vertex_count * sizeof(double));
    ck_assert_double_gt(sim.energy().kinetic, 0);
    ck_assert_double_eq(sim.energy(body).mass, c.energy(same).mass);
    const auto steps = std::ranges::find(sim.counters(), std::string_view("steps"), &vox_counter::name);
    ck_assert_uint_eq(steps->value, 3);
    ck_assert_uint_eq(sim.grid().user_data(body), 9);
    ck_assert_ptr_eq(std::as_const(sim).grid().positions<float>(body).data(), view.grid_positions);
    sim.set_state(body, box.positions(), {});
    ck_assert_double_eq(sim.body(body).positions[0], box.positions()[0]);
    throws([&] { sim.set_state(body, std::vector<double>(6), {}); }, VOX_ERROR_INVALID_ARGUMENT, "6 numbers");
    throws([&] { sim.step(-1); }, VOX_ERROR_INVALID_ARGUMENT, "-1");
    vox::sim::simulation moved = std::move(sim);
    moved.remove(body);
    ck_assert(!moved.grid().contains(body));
    const std::vector<float> floats(12);
    throws([&] { (void)vox::sim::describe(floats, box.tets()); }, VOX_ERROR_INVALID_ARGUMENT,
           "no packed doubles");
}
END_TEST

} // namespace

SUITE(hpp_libraries) {
    tcase_add_each(add_case(suite, "all"), files_and_bodies, surfaces_are_filled_with_progress,
                   bodies_fall_as_in_c);
}
