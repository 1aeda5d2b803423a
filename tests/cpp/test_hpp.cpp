// vox.hpp beside vox.h: the same values, errors as exceptions with code and text, moves, views, temporaries
// that are refused, callables.
#include <Eigen/Geometry>

#include <vox/vox_cell_size.hpp>
#include <vox/vox_query.hpp>

#include "cpp/scene.hpp"
#include "cpp/throws.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

// Vectors as other libraries have them.
namespace other {
struct glm_like {
    using value_type = float;
    static constexpr int length() { return 3; }
    float x, y, z;
};
struct plain {
    double x, y, z, w;
};
} // namespace other
template <>
struct vox::element<other::plain> {
    using number = double;
    static constexpr std::size_t count = 4;
};

namespace {

// A stepped grid of the scene, by vox.hpp.
struct Stepped {
    Scene scene;
    vox::grid grid;
    vox_body a, b;
    explicit Stepped(std::uint32_t flags = VOX_GRID_CONSTRAINTS) {
        grid.set_flags(flags);
        a = grid.insert(scene.a, scene.tets, 1);
        b = grid.insert(scene.b, scene.tets, 2);
        grid.step();
    }
};

// A span has the elements of a view of C, byte by byte.
template <class T, class V>
void same_view(vox::span<T> span, const V& c) {
    static_assert(std::is_same_v<T*, decltype(V::data)>);
    ck_assert_uint_gt(c.count, 0);
    ck_assert_uint_eq(span.size(), c.count);
    ck_assert_mem_eq(span.data(), c.data, span.size_bytes());
}
template <class T>
void same(const std::vector<T>& found, const std::vector<T>& c) {
    ck_assert_uint_eq(found.size(), c.size());
    ck_assert_uint_gt(c.size(), 0);
    ck_assert_mem_eq(found.data(), c.data(), c.size() * sizeof(T));
}

template <class T>
T sized_struct() {
    T value;
    memset(&value, 0, sizeof value);
    value.struct_size = static_cast<std::uint32_t>(sizeof value);
    return value;
}

START_TEST(results_equal_those_of_c) {
    Stepped with;
    const vox::grid& grid = with.grid;
    CGrid c(with.scene);
    ck_ok(vox_grid_step(c.grid));
    std::uint64_t hash = 0;
    ck_ok(vox_grid_get_hash(c.grid, &hash));
    ck_assert_uint_eq(grid.hash(), hash);
    ck_assert_uint_eq(grid.info().epoch, grid_info(with.grid.get()).epoch);

    vox_contact_view contacts;
    vox_pair_view pairs;
    vox_constraint_view constraints;
    ck_ok(vox_grid_get_contacts(c.grid, &contacts));
    ck_ok(vox_grid_get_pairs(c.grid, &pairs));
    ck_ok(vox_grid_get_constraints(c.grid, &constraints));
    same_view(grid.contacts(), contacts);
    ck_assert_uint_eq(grid.interiors().size(), contacts.count);
    ck_assert_mem_eq(grid.interiors().data(), contacts.interiors, contacts.count);
    same_view(grid.pairs(), pairs);
    same_view(grid.constraints(), constraints);

    vox_counter_view counters;
    ck_ok(vox_grid_get_counters(c.grid, &counters));
    ck_assert_uint_eq(grid.counters().size(), counters.count);
    ck_assert_str_eq(grid.counters()[2].name, counters.data[2].name);
    ck_assert_uint_eq(grid.counters()[2].value, counters.data[2].value);
    ck_assert_uint_eq(grid.failure().body, VOX_NULL_BODY);
    ck_assert_uint_eq(grid.info().flags, VOX_GRID_CONSTRAINTS);
    ck_assert_double_gt(grid.info().cell_size, 0);
}
END_TEST

// Three bodies in a row, of which the middle one touches both others.
START_TEST(what_a_pair_has) {
    Stepped with;
    std::vector<float> third = with.scene.b;
    for (std::size_t i = 0; i < third.size(); i += 3) third[i] += 0.6f;
    const vox_body c = with.grid.insert(third, with.scene.tets);
    with.grid.step();
    const vox::grid& grid = with.grid;
    vox_pair_view pairs;
    vox_constraint_view constraints;
    ck_ok(vox_grid_get_pairs(grid.get(), &pairs));
    ck_ok(vox_grid_get_constraints(grid.get(), &constraints));
    ck_assert_uint_eq(grid.pairs().size(), 2);
    std::size_t contacts = 0;
    for (std::size_t p = 0; p < 2; ++p) {
        const vox_pair pair = grid.pairs()[p]; // a copy is as good
        const auto indices = grid.contacts_of(pair);
        ck_assert_ptr_eq(indices.data(), pairs.contacts + pairs.data[p].first_contact);
        ck_assert_uint_eq(indices.size(), pairs.data[p].contact_count);
        for (std::uint32_t i : indices) {
            const vox_contact& contact = grid.contacts()[i];
            ck_assert_uint_eq(std::min(contact.body_a, contact.body_b), pair.body_a);
            ck_assert_uint_eq(std::max(contact.body_a, contact.body_b), pair.body_b);
        }
        contacts += indices.size();
        const auto found = grid.constraints_of(pair);
        ck_assert_uint_gt(found.size(), 0);
        ck_assert_ptr_eq(found.data(), constraints.data + constraints.pair_offsets[p]);
        ck_assert_uint_eq(found.size(), constraints.pair_offsets[p + 1] - constraints.pair_offsets[p]);
        for (const vox_constraint& constraint : found) ck_assert_uint_eq(constraint.pair, p);
    }
    ck_assert_uint_eq(contacts, grid.contacts().size());
    vox_pair none = grid.pairs()[1];
    none.body_a = with.a;
    none.body_b = c;
    ck_assert(grid.constraints_of(none).empty());

    // A pair that ended has neither.
    with.grid.set_enabled(c, false);
    with.grid.step();
    ck_assert_int_eq(grid.pairs()[0].state, VOX_PAIR_PERSISTED);
    ck_assert_int_eq(grid.pairs()[1].state, VOX_PAIR_ENDED);
    ck_assert(grid.contacts_of(grid.pairs()[1]).empty() && grid.constraints_of(grid.pairs()[1]).empty());
}
END_TEST

START_TEST(constraints_are_found_as_in_c) {
    Stepped with(0);
    CGrid c(with.scene, 0);
    ck_ok(vox_grid_step(c.grid));
    throws([&] { (void)with.grid.constraints(); }, VOX_ERROR_INVALID_STATE, "constraints");
    vox_constraint_desc desc = vox_default_constraint_desc();
    vox_constraint_view expected;
    ck_ok(vox_grid_find_constraints(c.grid, nullptr));
    ck_ok(vox_grid_get_constraints(c.grid, &expected));
    with.grid.find_constraints();
    same_view(with.grid.constraints(), expected);
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    desc.body_a = with.a;
    ck_ok(vox_grid_find_constraints(c.grid, &desc));
    ck_ok(vox_grid_get_constraints(c.grid, &expected));
    with.grid.find_constraints(desc);
    same_view(with.grid.constraints(), expected);

    // The gap where they were found, and after a has moved along the normal.
    std::vector<double> a(with.scene.a.begin(), with.scene.a.end()),
        b(with.scene.b.begin(), with.scene.b.end());
    const vox_constraint& first = with.grid.constraints()[0];
    const bool a_is_first = first.body_a == with.a;
    const std::vector<double>&of_a = a_is_first ? a : b, &of_b = a_is_first ? b : a;
    ck_assert_double_eq_tol(vox::constraint_gap(first, of_a, of_b), first.gap, 1e-12);
    for (std::size_t i = 0; i < a.size(); ++i) (a_is_first ? a : b)[i] += first.normal[i % 3];
    ck_assert_double_eq(vox::constraint_gap(first, of_a, of_b),
                        vox_constraint_gap(&first, of_a.data(), of_b.data()));
    ck_assert_double_eq_tol(vox::constraint_gap(first, of_a, of_b), first.gap + 1, 1e-12);
    with.grid.remove(with.b);
    throws([&] { with.grid.find_constraints(); }, VOX_ERROR_INVALID_STATE, "removed");
}
END_TEST

START_TEST(margins_and_previous_positions) {
    Stepped with;
    const vox::grid& grid = with.grid;
    const auto count = [&](vox_constraint_kind kind) {
        const auto all = grid.constraints();
        return std::count_if(all.begin(), all.end(), [&](const auto& c) { return c.kind == kind; });
    };
    const std::vector<float> before(with.scene.a.size(), 5.0f);
    with.grid.set_margin(0.5);
    ck_assert_double_eq(grid.info().margin, 0.5);
    with.grid.set_flags(VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES);
    with.grid.bind_previous(with.a, before);
    with.grid.step();
    for (vox_constraint_kind kind :
         {VOX_CONSTRAINT_INSIDE, VOX_CONSTRAINT_EDGE, VOX_CONSTRAINT_PROXIMITY, VOX_CONSTRAINT_IMPACT})
        ck_assert_int_gt(count(kind), 0);
    with.grid.end_previous(with.a);
    with.grid.set_margin(0);
    with.grid.step();
    ck_assert_int_eq(count(VOX_CONSTRAINT_PROXIMITY) + count(VOX_CONSTRAINT_IMPACT), 0);
}
END_TEST

// All of an array, and a field of its elements, as matrices in the same memory.
START_TEST(arrays_are_matrices) {
    Stepped with;
    const auto found = with.grid.constraints();
    const auto normals = vox::eigen_map(found, &vox_constraint::normal);
    const auto gaps = vox::eigen_map(found, &vox_constraint::gap);
    const auto vertices = vox::eigen_map(found, &vox_constraint::vertices);
    ck_assert_int_eq(normals.cols(), static_cast<Eigen::Index>(found.size()));
    ck_assert_ptr_eq(normals.data(), found[0].normal);
    static_assert(decltype(normals)::RowsAtCompileTime == 3 && decltype(vertices)::RowsAtCompileTime == 5);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        ck_assert_double_eq(normals(1, column), found[i].normal[1]);
        ck_assert_double_eq(gaps(column), found[i].gap);
        ck_assert_uint_eq(vertices(0, column), found[i].vertices[0]);
    }
    const auto positions = vox::eigen_map(std::as_const(with.grid).positions<float>(with.a));
    ck_assert_ptr_eq(positions.data(), with.scene.a.data());
    ck_assert_int_eq(positions.cols(), static_cast<Eigen::Index>(with.scene.vertices()));
    auto mapped = vox::eigen_map(with.grid.map_positions<float>(with.a));
    mapped.colwise() += Eigen::Vector3f(1, 0, 0);
    ck_assert_float_eq(with.grid.positions<float>(with.a)[7][0], with.scene.a[21] + 1);
    const vox::span<const vox_constraint> none;
    ck_assert_int_eq(vox::eigen_map(none, &vox_constraint::normal).cols(), 0);
}
END_TEST

START_TEST(meshes_tell_what_c_tells) {
    Stepped with;
    const vox::grid& grid = with.grid;
    ck_assert(grid.meshes() == std::vector<vox_body>({with.a, with.b}));
    ck_assert(grid.contains(with.a) && !grid.contains(VOX_NULL_BODY));
    ck_assert_uint_eq(grid.user_data(with.b), 2);
    vox_body_info info = sized_struct<vox_body_info>();
    ck_ok(vox_body_get_info(grid.get(), with.a, &info));
    const vox_body_info same_info = grid.info(with.a);
    ck_assert_mem_eq(&same_info, &info, sizeof info);
    const auto tets = grid.tets_of(with.a);
    ck_assert_uint_eq(tets.size(), with.scene.tet_count());
    ck_assert_mem_eq(tets.data(), with.scene.tets.data(), 4 * tets.size() * sizeof(std::uint32_t));
    with.grid.set_tets_enabled(with.a, std::vector<std::uint32_t>{3}, false);
    const auto enabled = grid.tets_enabled(with.a);
    ck_assert_int_eq(std::accumulate(enabled.begin(), enabled.end(), 0), static_cast<int>(tets.size()) - 1);
    ck_assert_uint_eq(enabled[3], 0);

    vox_filter filter{};
    filter.group = -7;
    with.grid.set_filter(with.a, filter);
    ck_assert_int_eq(grid.info(with.a).filter.group, -7);
    with.grid.set_enabled(with.b, false);
    ck_assert_uint_eq(grid.info(with.b).enabled, 0);
    with.grid.set_enabled(with.b, true);
    with.grid.step();
    ck_assert_uint_gt(grid.contacts().size(), 0);
    with.grid.set_pair_enabled(with.a, with.b, false);
    with.grid.step();
    ck_assert(grid.contacts().empty());
    with.grid.set_pair_enabled(with.a, with.b, true);
    with.grid.mark_moved(with.a);
    with.grid.step();
    ck_assert_uint_eq(grid.info().moved_bodies, 1);
    with.grid.set_worker_count(2);
    with.grid.set_cell_size(0.25);
    with.grid.reserve(8, 100);
    with.grid.step();
    ck_assert_double_eq(grid.info().cell_size, 0.25);
    with.grid.clear();
    ck_assert(grid.meshes().empty());
}
END_TEST

// The scene moved by (0.1, 0.2, 0.3) by each way to write a transform.
START_TEST(transforms) {
    Stepped with;
    const double rows[12] = {1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 0.3};
    ck_ok(vox_body_set_transform(with.grid.get(), with.a, rows));
    with.grid.step();
    const std::uint64_t hash = with.grid.hash();
    with.grid.clear_transform(with.a);
    with.grid.step();
    ck_assert_uint_ne(with.grid.hash(), hash);
    std::array<double, 12> array;
    std::copy(rows, rows + 12, array.begin());
    Eigen::Affine3d affine = Eigen::Affine3d::Identity();
    affine.translation() << 0.1, 0.2, 0.3;
    const std::function<void()> ways[] = {[&] { with.grid.set_transform(with.a, rows); },
                                          [&] { with.grid.set_transform(with.a, array); },
                                          [&] { with.grid.set_transform(with.a, affine); }};
    for (const auto& way : ways) {
        with.grid.clear_transform(with.a);
        way();
        with.grid.step();
        ck_assert_uint_eq(with.grid.hash(), hash);
    }
}
END_TEST

// ---- errors ----

START_TEST(errors_have_code_and_text) {
    Stepped with;
    throws(
        [&] {
            with.grid.insert(with.scene.a, {0, 1, 2, 900});
        },
        VOX_ERROR_INVALID_MESH, "names vertex 900 of 64");
    throws([&] { with.grid.user_data(VOX_NULL_BODY); }, VOX_ERROR_INVALID_HANDLE, "");
    throws([&] { with.grid.set_cell_size(-1); }, VOX_ERROR_INVALID_ARGUMENT, "-1");
    throws([&] { vox::grid::load(std::vector<std::byte>(100)); }, VOX_ERROR_FORMAT, "");
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = 1000;
    throws([&] { vox::grid grid(desc); }, VOX_ERROR_INVALID_ARGUMENT, "1000");
    with.scene.b[4] = NAN;
    throws([&] { with.grid.step(); }, VOX_ERROR_NON_FINITE, "nan");
    ck_assert_uint_eq(with.grid.failure().body, with.b);
    ck_assert_uint_eq(with.grid.failure().vertex, 1);

    // An error is a value: copies keep the text, whatever fails later.
    try {
        with.grid.user_data(77);
        ck_abort_msg("nothing was thrown");
    } catch (const std::exception& caught) {
        const vox::error error = static_cast<const vox::error&>(caught);
        const std::string text = vox_last_error();
        vox::error assigned(VOX_ERROR_FILE, "another");
        assigned = error;
        throws([&] { with.grid.set_cell_size(-1); }, VOX_ERROR_INVALID_ARGUMENT, "");
        ck_assert_str_eq(error.what(), text.c_str());
        ck_assert_str_eq(assigned.what(), text.c_str());
        ck_assert_int_eq(assigned.result(), VOX_ERROR_INVALID_HANDLE);
    }
    ck_assert_str_eq(vox::error(VOX_ERROR_BUDGET, "").what(), "VOX_ERROR_BUDGET");
}
END_TEST

START_TEST(arrays_of_another_size_are_errors) {
    Stepped with;
    std::vector<float> odd(13);
    const std::vector<std::uint32_t> five = {0, 1, 2, 3, 0}, two = {1, 2};
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic> matrix = Eigen::MatrixXd::Zero(5, 7);
    throws([&] { with.grid.insert(odd); }, VOX_ERROR_INVALID_ARGUMENT,
           "13 numbers are not three for each vertex");
    throws([&] { with.grid.insert(with.scene.a, five); }, VOX_ERROR_INVALID_ARGUMENT,
           "5 indices are not four");
    throws([&] { with.grid.insert(matrix); }, VOX_ERROR_INVALID_ARGUMENT, "a matrix of 5 x 7 has neither");
    throws([&] { (void)vox::describe(odd); }, VOX_ERROR_INVALID_ARGUMENT, "13 numbers");
    throws([&] { with.grid.append_tets(with.a, five); }, VOX_ERROR_INVALID_ARGUMENT, "5 indices");
    throws(
        [&] {
            with.grid.replace_tets(with.a, two, {0, 1, 2, 3});
        },
        VOX_ERROR_INVALID_ARGUMENT, "2 tets to replace, by 1");
    odd.resize(12);
    throws([&] { with.grid.bind(with.a, odd); }, VOX_ERROR_INVALID_ARGUMENT,
           "positions.count is 4, expected 64");
    throws([&] { with.grid.bind(77, odd); }, VOX_ERROR_INVALID_HANDLE, "");
    throws([&] { with.grid.append_vertices(with.a, 1, odd); }, VOX_ERROR_INVALID_ARGUMENT,
           "positions.count is 4, expected 65");
    throws([&] { with.grid.map_positions<double>(with.a); }, VOX_ERROR_INVALID_ARGUMENT,
           "not numbers of 8 bytes");
    throws([&] { (void)with.grid.positions<double>(with.a); }, VOX_ERROR_INVALID_ARGUMENT,
           "not numbers of 8 bytes");
    const vox::locator locator(with.grid);
    const Eigen::Matrix<float, Eigen::Dynamic, 3> columns =
        Eigen::Matrix<float, Eigen::Dynamic, 3>::Zero(4, 3);
    ck_assert_uint_eq(locator.find_point_hits(columns).size(), 4);
    ck_assert_uint_eq(locator.find_closest(columns).size(), 4);
    std::vector<vox_closest_hit> room(3);
    throws([&] { locator.find_closest(columns, room); }, VOX_ERROR_INVALID_ARGUMENT,
           "room for 3 hits, for 4");
    ck_assert_int_eq(locator.locate(columns).at(3).state, VOX_LOCATION_INSIDE);
    std::vector<vox_location> locations(3);
    throws([&] { locator.locate(columns, locations); }, VOX_ERROR_INVALID_ARGUMENT,
           "room for 3 locations, for 4");
    const Eigen::Matrix<float, Eigen::Dynamic, 3> ends = columns.array() + 0.25f;
    std::vector<vox_track_piece> pieces = locator.find_tracks(columns, ends), first(1);
    ck_assert_uint_ge(pieces.size(), 4);
    ck_assert_uint_eq(locator.find_tracks(columns, ends, first), pieces.size());
    ck_assert_mem_eq(first.data(), pieces.data(), sizeof first[0]);
    ck_assert_uint_eq(locator.find_closest_to_segments(columns, ends).size(), 4);
    throws([&] { locator.find_triangle_hits(columns); }, VOX_ERROR_INVALID_ARGUMENT, "multiple of 3");
    const Eigen::Matrix<float, Eigen::Dynamic, 3> blade = columns.topRows(3), moved = ends.topRows(3);
    ck_assert_uint_ge(locator.find_triangle_hits(blade, moved).size(),
                      locator.find_triangle_hits(blade).size());
    with.grid.step(); // and the grid is as it was
    ck_assert_uint_eq(with.grid.meshes().size(), 2);
}
END_TEST

// ---- ownership ----

// Counts what it has handed out.
struct Counting : std::pmr::memory_resource {
    std::uint64_t bytes = 0, most = 0;
    void* do_allocate(std::size_t size, std::size_t alignment) override {
        if (bytes + size > most) throw std::bad_alloc();
        bytes += size;
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* at, std::size_t size, std::size_t alignment) override {
        bytes -= size;
        std::pmr::new_delete_resource()->deallocate(at, size, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

START_TEST(grids_move_and_release) {
    static_assert(!std::is_copy_constructible_v<vox::grid> && !std::is_copy_assignable_v<vox::grid>);
    static_assert(std::is_nothrow_move_constructible_v<vox::grid> &&
                  std::is_nothrow_move_assignable_v<vox::grid>);
    const Scene scene;
    Counting memory;
    memory.most = 100 << 20;
    vox_grid_desc desc = vox_default_grid_desc();
    const vox_allocator allocator = vox::allocator_of(memory);
    desc.allocator = &allocator;
    {
        vox::grid grid(desc);
        const vox_body a = grid.insert(scene.a, scene.tets);
        grid.insert(scene.b, scene.tets);
        grid.step();
        const auto contacts = grid.contacts();
        const std::size_t count = contacts.size();
        ck_assert_uint_gt(memory.bytes, 0);
        vox::grid moved = std::move(grid);
        throws([&] { grid.step(); }, VOX_ERROR_INVALID_ARGUMENT,
               "null"); // NOLINT: what a moved-from grid does
        throws([&] { (void)grid.contacts(); }, VOX_ERROR_INVALID_ARGUMENT, "null"); // NOLINT
        ck_assert(!grid.contains(a));                                               // NOLINT
        ck_assert_uint_eq(std::distance(contacts.begin(), contacts.end()), count);  // the view moved with it
        vox::grid other(desc);
        other.insert(scene.a, scene.tets);
        other = std::move(moved);
        ck_assert(other.contains(a));
        ck_assert_uint_eq(contacts[0].body_a, a);

        // A locator outlives its grid; a copy is another owner.
        vox::locator locator(other);
        ck_assert_uint_eq(locator.epoch(), other.info().epoch);
        vox::locator copy = locator;
        other.step();
        locator.update(other);
        ck_assert_uint_eq(locator.epoch(), copy.epoch() + 1);
        locator = vox::locator();
        other = vox::grid();
        ck_assert_uint_eq(copy.find_point_hits(std::vector<double>{0.1, 0.1, 0.1}).size(), 1);
        ck_assert_uint_eq(copy.user_data(a), 0);
        ck_assert_uint_gt(memory.bytes, 0);
    }
    ck_assert_uint_eq(memory.bytes, 0);

    // A resource without memory gives OUT_OF_MEMORY, as its exception does not cross the library.
    memory.most = 1 << 20;
    vox::grid grid(desc);
    throws(
        [&] {
            for (;;) grid.insert_copy(scene.a, scene.tets);
        },
        VOX_ERROR_OUT_OF_MEMORY, "");
}
END_TEST

START_TEST(meshes_are_removed_by_their_owner) {
    Stepped with;
    {
        vox::unique_mesh mesh(with.grid, with.a);
        vox::unique_mesh moved = std::move(mesh);
        ck_assert_uint_eq(mesh.get(), VOX_NULL_BODY); // NOLINT
        mesh = std::move(moved);
        ck_assert_uint_eq(mesh.get(), with.a);
        ck_assert(with.grid.contains(with.a));
        vox::unique_mesh kept(with.grid, with.b);
        ck_assert_uint_eq(kept.release(), with.b);
    }
    ck_assert(!with.grid.contains(with.a) && with.grid.contains(with.b));
    // One that was removed already, and one that is assigned over.
    vox::unique_mesh mesh(with.grid, with.b);
    with.grid.remove(with.b);
    mesh = vox::unique_mesh(with.grid, with.grid.insert(with.scene.a));
    ck_assert_uint_eq(with.grid.meshes().size(), 1);
    mesh = {};
    ck_assert(with.grid.meshes().empty());
    // The owner's grid lives on where what borrowed it has gone.
    CGrid c(with.scene);
    {
        vox::grid borrowed = vox::grid::borrow(c.grid);
        mesh = vox::unique_mesh(borrowed, borrowed.insert(with.scene.a));
    }
    const vox_body id = mesh.get();
    ck_assert_uint_eq(vox_body_is_valid(c.grid, id), 1);
    mesh.reset();
    ck_assert_uint_eq(vox_body_is_valid(c.grid, id), 0);
}
END_TEST

START_TEST(grids_of_c_and_back) {
    const Scene scene;
    CGrid c(scene);
    {
        vox::grid borrowed = vox::grid::borrow(c.grid);
        borrowed.step();
        ck_assert_uint_gt(borrowed.contacts().size(), 0);
        ck_assert_ptr_eq(borrowed.get(), c.grid);
        ck_ok(vox_grid_step(borrowed.get()));
        ck_assert_uint_eq(borrowed.info().epoch, 2);
    }
    ck_assert_uint_ne(hash_of_step(c.grid), 0); // it is alive
    vox::grid adopted = vox::grid::adopt(std::exchange(c.grid, nullptr));
    ck_assert_uint_eq(adopted.meshes().size(), 2);
}
END_TEST

// ---- views ----

START_TEST(positions_are_mapped) {
    Stepped with;
    vox::grid& grid = with.grid;
    const auto read = grid.positions<float>(with.a);
    ck_assert_ptr_eq(read.data()->data(), with.scene.a.data());
    auto mapped = grid.map_positions<float>(with.a);
    ck_assert_uint_eq(mapped.size(), with.scene.vertices());
    const auto again = grid.map_positions<float>(with.a); // the same array
    for (auto& position : mapped) position[0] += 0.125f;
    ck_assert_float_eq(again[0][0], 0.125f);
    ck_assert_float_eq(grid.positions<float>(with.a)[0][0], 0.125f);
    grid.step(); // which does not end them
    ck_assert_float_eq(mapped[0][0], 0.125f);
    grid.append_vertices(with.a, 1, std::vector<std::array<float, 3>>{{{9, 9, 9}}}[0]);
    mapped = grid.map_positions<float>(with.a);
    ck_assert_float_eq(mapped.back()[2], 9);
}
END_TEST

// ---- what is passed in ----

template <class P, class = void>
struct can_insert : std::false_type {};
template <class P>
struct can_insert<P, std::void_t<decltype(std::declval<vox::grid&>().insert(std::declval<P>()))>>
    : std::true_type {};
template <class P, class = void>
struct can_copy : std::false_type {};
template <class P>
struct can_copy<P, std::void_t<decltype(std::declval<vox::grid&>().insert_copy(std::declval<P>()))>>
    : std::true_type {};
template <class G, class = void>
struct can_look : std::false_type {};
template <class G>
struct can_look<G, std::void_t<decltype(*std::declval<G>().contacts().begin())>> : std::true_type {};

START_TEST(temporaries_are_not_borrowed) {
    using floats = std::vector<float>;
    using triples = std::vector<std::array<double, 3>>;
    static_assert(can_insert<floats&>::value && can_insert<const floats&>::value &&
                  can_insert<triples&>::value);
    static_assert(!can_insert<floats>::value && !can_insert<const floats>::value &&
                  !can_insert<triples>::value);
    static_assert(!can_insert<Eigen::MatrixX3d>::value && can_insert<Eigen::MatrixX3d&>::value);
    static_assert(can_insert<vox::span<const float>>::value &&
                  can_insert<Eigen::Map<const Eigen::MatrixX3d>>::value);
    static_assert(can_insert<vox::span<const std::array<float, 3>>>::value);
    static_assert(can_insert<vox_positions>::value);
    static_assert(can_copy<floats>::value && can_copy<triples>::value);
    static_assert(std::is_constructible_v<vox::borrowed_tets, std::vector<int>&>);
    static_assert(!std::is_constructible_v<vox::borrowed_tets, std::vector<int>>);
    static_assert(!std::is_constructible_v<vox::borrowed_points, floats>);
    // What is no array of positions at all.
    static_assert(!can_insert<std::vector<int>&>::value && !can_insert<std::vector<floats>&>::value);
    static_assert(!can_insert<std::vector<std::array<float, 2>>&>::value && !can_insert<std::string&>::value);
    static_assert(!std::is_constructible_v<vox::tets, std::vector<std::uint64_t>&>);
    static_assert(!std::is_constructible_v<vox::tets, std::vector<std::array<int, 3>>&>);
    // Results of a temporary grid.
    static_assert(can_look<vox::grid&>::value && can_look<const vox::grid&>::value &&
                  !can_look<vox::grid>::value);
    static_assert(!std::is_constructible_v<vox::unique_mesh, vox::grid, vox_body>);
}
END_TEST

// Inserts the scene with `a` given as `positions`; the hash of a step.
template <class P, class T>
std::uint64_t hash_with(const Scene& scene, const P& positions, const T& tets) {
    vox::grid grid;
    grid.insert(positions, tets);
    grid.insert(scene.b, scene.tets);
    grid.step();
    return grid.hash();
}

START_TEST(arrays_of_all_kinds) {
    const Scene scene;
    const std::size_t n = scene.vertices();
    const std::uint64_t hash = hash_with(scene, scene.a, scene.tets);
    const auto number = [&](std::size_t v, std::size_t c) { return scene.a[3 * v + c]; };
    std::vector<std::array<float, 3>> arrays(n);
    std::vector<std::array<float, 4>> padded(n);
    std::vector<other::glm_like> glm(n);
    std::vector<other::plain> plain(n);
    std::vector<Eigen::Vector3f> vectors(n);
    std::vector<double> doubles(scene.a.begin(), scene.a.end());
    const auto rows = static_cast<Eigen::Index>(n);
    Eigen::Matrix<float, Eigen::Dynamic, 3> by_column(rows, 3);
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> by_row(rows, 3);
    Eigen::MatrixXf unknown(rows, 3);
    for (std::size_t v = 0; v < n; ++v) {
        arrays[v] = {number(v, 0), number(v, 1), number(v, 2)};
        padded[v] = {number(v, 0), number(v, 1), number(v, 2), 99};
        glm[v] = {number(v, 0), number(v, 1), number(v, 2)};
        plain[v] = {number(v, 0), number(v, 1), number(v, 2), 99};
        vectors[v] = {number(v, 0), number(v, 1), number(v, 2)};
        for (Eigen::Index c = 0; c < 3; ++c) {
            const auto at = static_cast<Eigen::Index>(v);
            by_column(at, c) = unknown(at, c) = number(v, static_cast<std::size_t>(c));
            by_row(at, c) = static_cast<double>(number(v, static_cast<std::size_t>(c)));
        }
    }
    const Eigen::Matrix<float, 3, Eigen::Dynamic> wide = by_column.transpose();
    const Eigen::VectorXf flat = Eigen::Map<const Eigen::VectorXf>(scene.a.data(), 3 * rows);
    ck_assert_uint_eq(hash_with(scene, arrays, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, padded, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, glm, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, plain, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, vectors, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, doubles, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, by_column, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, by_row, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, unknown, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, wide, scene.tets), hash);
    ck_assert_uint_eq(hash_with(scene, flat, scene.tets), hash);
    const float(&raw)[64][3] = *reinterpret_cast<const float(*)[64][3]>(scene.a.data());
    ck_assert_uint_eq(n, 64);
    ck_assert_uint_eq(hash_with(scene, raw, scene.tets), hash);

    std::vector<int> ints(scene.tets.begin(), scene.tets.end());
    std::vector<std::array<std::uint32_t, 4>> fours(scene.tet_count());
    Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> corners(static_cast<Eigen::Index>(fours.size()),
                                                                   4);
    for (std::size_t i = 0; i < scene.tets.size(); ++i) {
        fours[i / 4][i % 4] = scene.tets[i];
        corners(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = ints[i];
    }
    ck_assert_uint_eq(hash_with(scene, scene.a, ints), hash);
    ck_assert_uint_eq(hash_with(scene, scene.a, fours), hash);
    ck_assert_uint_eq(hash_with(scene, scene.a, corners), hash);
    const Eigen::Matrix<int, Eigen::Dynamic, 4> turned = corners;
    throws([&] { hash_with(scene, scene.a, turned); }, VOX_ERROR_INVALID_ARGUMENT,
           "do not lie one after the other");

    // Positions of one mesh bound to another; then a body that is copied, and one that is described.
    vox::grid grid;
    const vox_body first = grid.insert_copy(std::vector<float>(scene.a), scene.tets);
    const vox_body second = grid.insert(scene.b, scene.tets);
    grid.step();
    ck_assert_uint_eq(grid.hash(), hash);
    grid.bind(second, grid.positions<float>(first));
    grid.bind(second, grid.info(first).positions);
    grid.bind(second, doubles);
    grid.bind(second, scene.b);
    vox_mesh_desc desc = vox::describe(scene.a, scene.tets);
    desc.flags = VOX_MESH_BORROW_TETS;
    desc.user_data = 5;
    ck_assert_uint_eq(grid.user_data(grid.insert(desc)), 5);
    // No positions, of no vertices.
    const std::vector<float> none;
    const vox_body empty = grid.insert(none);
    grid.bind(empty, none);
    ck_assert_uint_eq(grid.info(empty).positions.count, 0);
    grid.step();
}
END_TEST

// Positions in records: read where they are, but not handed out as a span.
START_TEST(positions_with_gaps) {
    const Scene scene;
    struct record {
        float temperature, position[3];
    };
    std::vector<record> records(scene.vertices());
    for (std::size_t v = 0; v < records.size(); ++v)
        records[v] = {20, {scene.a[3 * v], scene.a[3 * v + 1], scene.a[3 * v + 2]}};
    vox_positions raw = vox_float_positions(records[0].position, records.size());
    raw.byte_stride = sizeof records[0];
    ck_assert_uint_eq(hash_with(scene, raw, scene.tets), hash_with(scene, scene.a, scene.tets));
    vox::grid grid;
    const vox_body id = grid.insert(raw);
    throws([&] { (void)grid.positions<float>(id); }, VOX_ERROR_UNSUPPORTED, "16 bytes apart");
    ck_assert_uint_eq(grid.info(id).positions.byte_stride, 16);
    const Eigen::Matrix<float, Eigen::Dynamic, 3> columns =
        Eigen::Matrix<float, Eigen::Dynamic, 3>::Zero(static_cast<Eigen::Index>(records.size()), 3);
    grid.bind(id, columns);
    throws([&] { (void)grid.positions<float>(id); }, VOX_ERROR_UNSUPPORTED, "their numbers 256");
}
END_TEST

// ---- callables ----

START_TEST(logs_are_callables) {
    Counting none; // without memory
    std::string text;
    vox_grid_desc desc = vox_default_grid_desc();
    const vox_reference_desc reference = vox_default_reference_desc();
    desc.reference = &reference;
    const Scene scene;
    {
        vox::grid grid(desc, [&](vox_log_level, const char* line) { text += line; });
        grid.insert(scene.a);
        ck_assert_msg(text.find("no tetrahedra") != std::string::npos || !text.empty(), "the log is \"%s\"",
                      text.c_str());
        text.clear();
        vox::grid moved = std::move(grid); // the callable stays where it is
        moved.insert(scene.b, scene.tets);
        moved.step();
        ck_assert_msg(text.find("cell size") != std::string::npos, "the log is \"%s\"", text.c_str());
    }
    int lines = 0;
    vox::grid grid(desc, [&](vox_log_level, const char*) {
        ++lines;
        throw std::runtime_error("no room");
    });
    grid.insert(scene.b, scene.tets);
    grid.step(); // which the log cannot fail
    ck_assert_int_gt(lines, 0);
}
END_TEST

START_TEST(task_systems_are_callables) {
    const Scene scene(20);
    bool fails = false;
    int tasks = 0;
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = 2;
    vox::grid grid(desc, {}, [&](std::uint64_t items, std::uint64_t, const vox::task& run) {
        ++tasks;
        if (fails) throw std::runtime_error("no threads");
        run(0, items / 2, 0);
        run(items / 2, items, 1);
    });
    grid.insert(scene.a, scene.tets);
    grid.insert(scene.b, scene.tets);
    grid.step();
    ck_assert_int_gt(tasks, 0);
    const std::uint64_t hash = grid.hash();
    fails = true;
    vox::locator locator;
    const std::function<void()> calls[] = {[&] { grid.step(); }, [&] { locator.update(grid); }};
    for (const auto& call : calls) {
        try {
            call();
            ck_abort_msg("nothing was thrown");
        } catch (const std::runtime_error& error) {
            ck_assert_str_eq(error.what(), "no threads");
        }
    }
    fails = false;
    grid.step();
    ck_assert_uint_eq(grid.hash(), hash);
}
END_TEST

// Of what the task systems of several grids throw in one call, nothing is left for a later one.
START_TEST(one_exception_a_call) {
    const Scene scene(20);
    bool fails = true;
    const auto run_all = [&](std::uint64_t items, std::uint64_t, const vox::task& run) {
        if (fails) throw std::runtime_error("no threads");
        run(0, items, 0);
    };
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = 2;
    std::vector<vox::grid> grids;
    for (int i = 0; i < 2; ++i) {
        grids.emplace_back(desc, vox::log_function(), run_all);
        grids.back().insert(scene.a, scene.tets);
        grids.back().insert(scene.b, scene.tets);
    }
    try {
        vox::step(grids, 1);
        ck_abort_msg("nothing was thrown");
    } catch (const std::runtime_error& error) {
        ck_assert_str_eq(error.what(), "no threads");
    }
    fails = false;
    for (vox::grid& grid : grids) {
        grid.step();
        ck_assert_uint_gt(grid.contacts().size(), 0);
    }
}
END_TEST

START_TEST(cost_functions_are_callables) {
    const auto cost = [](double d) { return d + 1 / d; };
    vox_cell_size_result expected = sized_struct<vox_cell_size_result>();
    ck_ok(vox_cost_minimise([](double d, void*) { return d + 1 / d; }, nullptr, 0.125, 8, 0, &expected));
    const vox_cell_size_result minimum = vox::minimise(cost, 0.125, 8);
    ck_assert_mem_eq(&minimum, &expected, sizeof minimum);
    int calls = 0;
    try {
        vox::minimise(
            [&](double) -> double {
                ++calls;
                throw std::out_of_range("no cost");
            },
            0.125, 8);
        ck_abort_msg("nothing was thrown");
    } catch (const std::out_of_range& error) {
        ck_assert_str_eq(error.what(), "no cost");
        ck_assert_int_eq(calls, 1); // it is not called again
    }
    throws([&] { vox::minimise(cost, 2, 1); }, VOX_ERROR_INVALID_ARGUMENT, "");
}
END_TEST

// ---- locators, cutting, cell sizes, snapshots, many grids ----

template <class Hit, class F>
std::vector<Hit> hits_of_c(F&& ask) {
    std::vector<Hit> hits(10000);
    std::uint64_t count = 0;
    ck_ok(ask(hits.data(), hits.size(), &count));
    hits.resize(count);
    return hits;
}

START_TEST(locators_equal_those_of_c) {
    Stepped with;
    CGrid c(with.scene);
    vox_locator* raw = nullptr;
    ck_ok(vox_grid_update_locator(c.grid, &raw));
    const vox::locator of_c = vox::locator::adopt(raw), asked(with.grid);
    const std::vector<float>&from = with.scene.a, &to = with.scene.b;
    std::vector<float> max = from;
    for (float& x : max) x += 0.3f;
    const std::uint64_t count = with.scene.vertices();
    const vox_positions begins = vox_float_positions(from.data(), count);
    const vox_positions ends = vox_float_positions(to.data(), count);
    const vox_positions highs = vox_float_positions(max.data(), count);
    vox_query_desc desc = vox_default_query_desc();
    desc.excluded = c.meshes[0];
    desc.flags = VOX_QUERY_FIRST_HIT;
    for (const vox_query_desc& which : {vox_default_query_desc(), desc}) {
        const auto points = hits_of_c<vox_point_hit>(
            [&](auto... out) { return vox_locator_find_point_hits(raw, &begins, &which, out...); });
        const auto boxes = hits_of_c<vox_box_hit>(
            [&](auto... out) { return vox_locator_find_box_hits(raw, &begins, &highs, &which, out...); });
        const auto rays = hits_of_c<vox_ray_hit>(
            [&](auto... out) { return vox_locator_find_ray_hits(raw, &begins, &ends, &which, out...); });
        same(asked.find_point_hits(from, which), points);
        same(asked.find_box_hits(from, max, which), boxes);
        same(asked.find_ray_hits(from, to, which), rays);
        std::vector<vox_point_hit> point(1);
        std::vector<vox_box_hit> box(1);
        std::vector<vox_ray_hit> ray(1);
        ck_assert_uint_eq(asked.find_point_hits(from, point, which), points.size());
        ck_assert_uint_eq(asked.find_box_hits(from, max, box, which), boxes.size());
        ck_assert_uint_eq(asked.find_ray_hits(from, to, ray, which), rays.size());
        ck_assert_mem_eq(point.data(), points.data(), sizeof point[0]);
        ck_assert_mem_eq(box.data(), boxes.data(), sizeof box[0]);
        ck_assert_mem_eq(ray.data(), rays.data(), sizeof ray[0]);
        std::vector<vox_closest_hit> closest(count), written(count);
        ck_ok(vox_locator_find_closest(raw, &begins, &which, closest.data()));
        same(asked.find_closest(from, which), closest);
        asked.find_closest(from, written, which);
        same(written, closest);
        std::vector<std::uint8_t> blocked(count);
        ck_ok(vox_locator_test_rays(raw, &begins, &ends, &which, blocked.data()));
        same(asked.test_rays(from, to, which), blocked);
    }
    same(asked.find_point_hits(from), of_c.find_point_hits(from));
    const std::vector<double> bad = {NAN, 0, 0}, two(6);
    throws([&] { (void)asked.find_point_hits(bad); }, VOX_ERROR_NON_FINITE, "nan");
    throws([&] { (void)asked.test_rays(from, two); }, VOX_ERROR_INVALID_ARGUMENT, "to.count is 2");
    throws([&] { (void)vox::locator().find_closest(from); }, VOX_ERROR_INVALID_ARGUMENT, "locator is null");
}
END_TEST

START_TEST(meshes_are_cut_as_in_c) {
    Stepped with;
    CGrid c(with.scene);
    vox_grid* raw = c.grid;
    const std::vector<std::uint32_t> some = {3, 9};
    const std::uint32_t corners[] = {0, 1, 2, 64};
    std::vector<float> grown = with.scene.a;
    grown.insert(grown.end(), {0.6f, 0.5f, 0.4f});
    vox_vertices_desc vertices = vox_default_vertices_desc();
    vertices.count = 1;
    vertices.positions = vox_float_positions(grown.data(), grown.size() / 3);
    std::uint32_t first = 0, first_tet = 0;
    ck_ok(vox_mesh_set_tets_enabled(raw, c.meshes[0], some.data(), 2, 0));
    ck_ok(vox_mesh_append_vertices(raw, c.meshes[0], &vertices, &first));
    ck_ok(vox_mesh_append_tets(raw, c.meshes[0], corners, 1, &first_tet));
    ck_ok(vox_mesh_replace_tets(raw, c.meshes[0], some.data(), 1, corners));
    ck_ok(vox_mesh_remove_tets(raw, c.meshes[0], some.data() + 1, 1));
    with.grid.set_tets_enabled(with.a, some, false);
    ck_assert_uint_eq(with.grid.append_vertices(with.a, 1, grown), first);
    ck_assert_uint_eq(with.grid.append_tets(with.a, {0, 1, 2, 64}), first_tet);
    with.grid.replace_tets(with.a, vox::span<const std::uint32_t>(some.data(), 1), corners);
    with.grid.remove_tets(with.a, vox::span<const std::uint32_t>(some.data() + 1, 1));
    with.grid.step();
    ck_assert_uint_eq(with.grid.hash(), hash_of_step(raw));

    // A copy of a vertex of a mesh with its own positions; then that vertex goes, and everything.
    const vox_body own = with.grid.insert_copy(with.scene.b, with.scene.tets);
    const std::vector<std::uint32_t> source = {5}, added = {64};
    const std::vector<float> at = {1, 2, 3};
    ck_assert_uint_eq(with.grid.append_vertices(own, 1, at, source), 64);
    ck_assert_float_eq(with.grid.positions<float>(own)[64][1], 2);
    with.grid.remove_vertices(own, added);
    throws([&] { with.grid.remove_vertices(own, added); }, VOX_ERROR_INVALID_ARGUMENT, "64");
    with.grid.set_topology(own, with.scene.a, with.scene.tets);
    ck_assert_uint_eq(with.grid.info(own).positions.count, 64);
    vox_mesh_desc desc = vox::describe(with.scene.b);
    with.grid.set_topology(own, desc);
    ck_assert_uint_eq(with.grid.info(own).tet_count, 0);
}
END_TEST

// Boxes of two corners each, triangles as flat indices and as a matrix, tets by their corners: as C is given
// them.
START_TEST(primitives_are_those_of_c) {
    Stepped with;
    const std::vector<float>& xyz = with.scene.a;
    const std::vector<std::uint32_t> flat = {0, 1, 2, 3, 4, 5};
    const std::vector<std::array<std::uint32_t, 3>> triples = {{0, 1, 2}, {3, 4, 5}};
    Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> rows(2, 3);
    rows << 0, 1, 2, 3, 4, 5;
    const Eigen::MatrixXi columns = rows;
    for (const vox_primitives& found : {vox::primitives(VOX_PRIMITIVE_TRIANGLE, xyz, flat),
                                        vox::primitives(VOX_PRIMITIVE_TRIANGLE, xyz, triples),
                                        vox::primitives(VOX_PRIMITIVE_TRIANGLE, xyz, rows)}) {
        ck_assert_int_eq(found.type, VOX_PRIMITIVE_TRIANGLE);
        ck_assert_ptr_eq(found.positions.data, xyz.data());
        ck_assert_uint_eq(found.positions.count, 64);
        ck_assert_uint_eq(found.count, 2);
        ck_assert_mem_eq(found.indices, flat.data(), 6 * sizeof flat[0]);
    }
    ck_assert_uint_eq(vox::primitives(VOX_PRIMITIVE_BOX, xyz).count, 32);
    ck_assert_ptr_null(vox::primitives(VOX_PRIMITIVE_POINT, xyz).indices);
    const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 10);
    ck_assert_int_eq(vox::primitives(VOX_PRIMITIVE_POINT, points).positions.format, VOX_FORMAT_DOUBLE);
    throws([&] { (void)vox::primitives(VOX_PRIMITIVE_TRIANGLE, xyz, columns); }, VOX_ERROR_INVALID_ARGUMENT,
           "2 for each primitive, expected 3");
    throws([&] { (void)vox::primitives(VOX_PRIMITIVE_TET, xyz, triples); }, VOX_ERROR_INVALID_ARGUMENT,
           "3 for each primitive, expected 4");
    throws([&] { (void)vox::primitives(VOX_PRIMITIVE_TET, xyz, flat); }, VOX_ERROR_INVALID_ARGUMENT,
           "6 vertices are not 4 for each");
    throws([&] { (void)vox::primitives(VOX_PRIMITIVE_TRIANGLE, xyz); }, VOX_ERROR_INVALID_ARGUMENT,
           "64 vertices");
    static_assert(!std::is_constructible_v<vox::borrowed_indices, std::vector<std::uint32_t>>);
    static_assert(std::is_constructible_v<vox::borrowed_indices, vox::span<const std::uint32_t>>);
    static_assert(!std::is_constructible_v<vox::borrowed_indices, const std::vector<float>&>);
    // None are given, which is not the same as that none are needed.
    const vox_primitives none = vox::primitives(VOX_PRIMITIVE_EDGE, xyz, vox::span<const std::uint32_t>());
    throws([&] { (void)vox::foreign_grid_suggest(vox::foreign_grid(none)); }, VOX_ERROR_INVALID_ARGUMENT,
           "count is 0");
}
END_TEST

START_TEST(cell_sizes_of_foreign_grids_equal_those_of_c) {
    Stepped with;
    const vox_primitives stored = vox::primitives(VOX_PRIMITIVE_TET, with.scene.a, with.scene.tets),
                         querying = vox::primitives(VOX_PRIMITIVE_POINT, with.scene.b);
    vox_foreign_grid grid = vox::foreign_grid(stored, VOX_KNOWN_GRID_SORTED);
    ck_assert_ptr_eq(grid.stored, &stored);
    ck_assert_int_eq(grid.known, VOX_KNOWN_GRID_SORTED);
    grid.querying = &querying;
    vox_cell_size_result expected = sized_struct<vox_cell_size_result>();
    ck_ok(vox_foreign_grid_suggest(&grid, &expected));
    const vox_cell_size_result suggested = vox::foreign_grid_suggest(grid);
    ck_assert_mem_eq(&suggested, &expected, sizeof expected);
    vox_foreign_counts counts;
    ck_ok(vox_foreign_grid_count(&grid, 0.5, &counts));
    const vox_foreign_counts counted = vox::foreign_grid_count(grid, 0.5);
    ck_assert_mem_eq(&counted, &counts, sizeof counts);
    throws([&] { (void)vox::foreign_grid_count(grid, 0); }, VOX_ERROR_INVALID_ARGUMENT, "cell_size is 0");

    const auto run = [](double d) { return 1e-3 * (d + 1 / d); };
    std::vector<vox_timing> timings;
    for (double d : {0.25, 0.5, 1.0, 2.0}) timings.push_back({d, run(d)});
    ck_ok(vox_foreign_grid_fit(&grid, timings.data(), timings.size(), &expected));
    const vox_cell_size_result fitted = vox::foreign_grid_fit(grid, timings);
    ck_assert_mem_eq(&fitted, &expected, sizeof expected);
    throws(
        [&] {
            (void)vox::foreign_grid_fit(grid, {timings.data(), 2});
        },
        VOX_ERROR_INVALID_ARGUMENT, "2 different");

    ck_ok(vox_foreign_grid_tune(
        &grid, nullptr, [](double d, void*) { return 1e-3 * (d + 1 / d); }, nullptr, &expected));
    const vox_cell_size_result tuned = vox::foreign_grid_tune(&grid, run);
    ck_assert_mem_eq(&tuned, &expected, sizeof expected);
    vox_tune_desc desc = vox_default_tune_desc();
    desc.first = 0.5;
    const vox_cell_size_result begun = vox::foreign_grid_tune(nullptr, run, desc);
    ck_assert_double_eq(vox::timings(begun)[0].cell_size, 0.5);
    throws([&] { (void)vox::foreign_grid_tune(nullptr, run); }, VOX_ERROR_INVALID_ARGUMENT,
           "desc.first is 0");
    int calls = 0;
    try {
        vox::foreign_grid_tune(&grid, [&](double) -> double {
            ++calls;
            throw std::out_of_range("no time");
        });
        ck_abort_msg("nothing was thrown");
    } catch (const std::out_of_range& error) {
        ck_assert_str_eq(error.what(), "no time");
        ck_assert_int_eq(calls, 1);
    }
}
END_TEST

template <class R>
concept has_spans = requires(R&& result) {
    vox::curve(std::forward<R>(result));
}
|| requires(R&& result) { vox::terms(std::forward<R>(result)); }
|| requires(R&& result) { vox::rules(std::forward<R>(result)); }
|| requires(R&& result) { vox::timings(std::forward<R>(result)); };

START_TEST(results_have_spans) {
    static_assert(has_spans<const vox_cell_size_result&> && !has_spans<vox_cell_size_result>);
    vox_cell_size_result result = {};
    result.curve_count = 1;
    result.term_count = 2;
    result.rule_count = 3;
    result.timing_count = 4;
    const auto are = [](auto span, const auto* data, std::size_t count) {
        ck_assert_ptr_eq(span.data(), data);
        ck_assert_uint_eq(span.size(), count);
    };
    are(vox::curve(result), result.curve, 1);
    are(vox::terms(result), result.terms, 2);
    are(vox::rules(result), result.rules, 3);
    are(vox::timings(result), result.timings, 4);
}
END_TEST

START_TEST(cell_sizes_equal_those_of_c) {
    Stepped with;
    const std::vector<vox_mesh_desc> meshes = {vox::describe(with.scene.a, with.scene.tets),
                                               vox::describe(with.scene.b, with.scene.tets)};
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    vox_cell_size_result expected = sized_struct<vox_cell_size_result>();
    const auto equals_expected = [&](const vox_cell_size_result& found) {
        ck_assert_mem_eq(&found, &expected, sizeof expected);
    };
    ck_ok(vox_suggest_cell_size(nullptr, meshes.data(), 2, &expected));
    equals_expected(vox::suggest_cell_size(meshes));
    ck_ok(vox_grid_suggest_cell_size(with.grid.get(), nullptr, &expected));
    equals_expected(vox::suggest_cell_size(with.grid));
    desc.model = VOX_COST_MODEL_REFERENCE;
    ck_ok(vox_grid_suggest_cell_size(with.grid.get(), &desc, &expected));
    equals_expected(vox::suggest_cell_size(with.grid, desc));
    ck_ok(vox_suggest_cell_size(&desc, meshes.data(), 2, &expected));
    equals_expected(vox::suggest_cell_size(meshes, desc));
    throws([&] { (void)vox::suggest_cell_size(vox::span<const vox_mesh_desc>()); },
           VOX_ERROR_INVALID_ARGUMENT, "");

    vox_geometry geometry = sized_struct<vox_geometry>();
    ck_ok(vox_measure_geometry(meshes.data(), 2, &geometry));
    const vox_geometry measured = vox::measure_geometry(meshes);
    ck_assert_mem_eq(&measured, &geometry, sizeof geometry);
    ck_assert_uint_eq(measured.tets, 2 * with.scene.tet_count());

    const vox_cost_weights weights = vox::calibrate();
    ck_assert_uint_eq(weights.measured, 1);
    desc.weights = &weights;
    ck_assert_double_gt(vox::suggest_cell_size(meshes, desc).cell_size, 0);
}
END_TEST

START_TEST(snapshots_hold_the_grid) {
    Stepped with;
    const std::vector<std::byte> bytes = with.grid.save();
    vox::grid loaded = vox::grid::load(bytes);
    ck_assert(loaded.meshes() == with.grid.meshes());
    loaded.step();
    ck_assert_uint_eq(loaded.hash(), with.grid.hash());
    const auto positions = loaded.positions<float>(with.a);
    ck_assert_mem_eq(positions.data(), with.scene.a.data(), with.scene.a.size() * sizeof(float));
}
END_TEST

START_TEST(many_grids_in_one_call) {
    const Scene scene;
    std::vector<vox::grid> grids(3);
    for (std::size_t i = 0; i < 3; ++i) {
        grids[i].insert(scene.a, scene.tets);
        if (i != 1) grids[i].insert(scene.b, scene.tets);
    }
    std::vector<vox_result> results(3, VOX_ERROR_INTERNAL);
    vox::step(grids, 1, results);
    ck_assert(results == std::vector<vox_result>(3, VOX_OK));
    for (std::size_t i = 0; i < 3; ++i) ck_assert((grids[i].contacts().size() > 0) == (i != 1));
    int tasks = 0;
    vox::step(grids, 2, {}, [&](std::uint64_t items, std::uint64_t, const vox::task& run) {
        ++tasks;
        run(0, items, 0);
    });
    ck_assert_int_gt(tasks, 0);
    try {
        vox::step(grids, 2, {},
                  [](std::uint64_t, std::uint64_t, const vox::task&) { throw std::runtime_error("stop"); });
        ck_abort_msg("nothing was thrown");
    } catch (const std::runtime_error& error) {
        ck_assert_str_eq(error.what(), "stop");
    }
    throws([&] { vox::step(grids, 1, vox::span<vox_result>(results.data(), 2)); }, VOX_ERROR_INVALID_ARGUMENT,
           "room for 2 results, of 3");
    const std::vector<float> bad = {NAN, 0, 0};
    grids[1].insert(bad);
    throws([&] { vox::step(grids); }, VOX_ERROR_NON_FINITE, "grid 1");
    ck_assert_uint_gt(grids[2].contacts().size(), 0);
}
END_TEST

START_TEST(versions) {
    ck_assert_uint_eq(vox::version(), vox_version());
    ck_assert_uint_eq(vox::abi_version(), VOX_ABI_VERSION);
    ck_assert_str_eq(vox::build_info(), vox_build_info());
}
END_TEST

} // namespace

SUITE(hpp) {
    tcase_add_each(add_case(suite, "results"), results_equal_those_of_c, what_a_pair_has,
                   constraints_are_found_as_in_c, margins_and_previous_positions, arrays_are_matrices,
                   meshes_tell_what_c_tells, transforms, locators_equal_those_of_c, meshes_are_cut_as_in_c,
                   cell_sizes_equal_those_of_c, primitives_are_those_of_c,
                   cell_sizes_of_foreign_grids_equal_those_of_c, results_have_spans, snapshots_hold_the_grid,
                   many_grids_in_one_call, versions);
    tcase_add_each(add_case(suite, "errors"), errors_have_code_and_text, arrays_of_another_size_are_errors);
    tcase_add_each(add_case(suite, "ownership"), grids_move_and_release, meshes_are_removed_by_their_owner,
                   grids_of_c_and_back);
    tcase_add_each(add_case(suite, "views"), positions_are_mapped);
    tcase_add_each(add_case(suite, "arrays"), temporaries_are_not_borrowed, arrays_of_all_kinds,
                   positions_with_gaps);
    tcase_add_each(add_case(suite, "callables"), logs_are_callables, task_systems_are_callables,
                   one_exception_a_call, cost_functions_are_callables);
}
