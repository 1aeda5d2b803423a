// vox.hpp without exceptions and without type information: every call returns a value or an error.
#define VOX_HPP_CHECKED 1
#include <vox/vox_cell_size.hpp>

#include "cpp/scene.hpp"

#include <sys/wait.h>
#include <unistd.h>

static_assert(!VOX_HPP_THROWS && VOX_HPP_CHECKED);

namespace {

// The call gives an error with this result, and these words in its text.
template <class R>
void fails(const R& returned, vox_result result, const char* words) {
    ck_assert(!returned.has_value() && !returned);
    ck_assert_msg(returned.error().result() == result, "%s: %s", vox_result_string(returned.error().result()),
                  returned.error().what());
    ck_assert_msg(strstr(returned.error().what(), words) != nullptr, "the text is \"%s\"",
                  returned.error().what());
}

// `read` prints and aborts, in a process of its own.
template <class F>
void aborts(F&& read) {
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        if (!freopen("/dev/null", "w", stderr)) _exit(2);
        read();
        _exit(0);
    }
    int status = 0;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT);
}

START_TEST(values_and_errors) {
    const Scene scene;
    vox::expected<vox::grid> made = vox::grid::create();
    ck_assert(made && made.has_value());
    vox::grid grid = std::move(*made);
    const vox::expected<vox_body> a = grid.insert(scene.a, scene.tets, 7),
                                  b = grid.insert(scene.b, scene.tets);
    ck_assert(a && b && *a != *b);
    ck_assert(grid.step());
    CGrid c(scene);
    ck_assert_uint_eq(*grid.hash(), hash_of_step(c.grid));
    std::size_t count = 0;
    for (const vox_contact& contact : *grid.contacts()) count += contact.body_a == *a || contact.body_b == *a;
    ck_assert_uint_eq(count, grid.contacts()->size());
    ck_assert_uint_gt(count, 0);
    ck_assert_uint_eq(grid.user_data(*a).value_or(0), 7);
    ck_assert_uint_eq(grid.counters().value().contacts, count);
    const std::vector<std::byte> bytes = grid.save().value();
    ck_assert_uint_eq(vox::grid::load(bytes)->meshes()->size(), 2);

    fails(grid.user_data(99), VOX_ERROR_INVALID_HANDLE, "");
    ck_assert_uint_eq(grid.user_data(99).value_or(3), 3);
    fails(grid.insert(scene.a, {0, 1, 2, 900}), VOX_ERROR_INVALID_MESH, "names vertex 900 of 64");
    fails(grid.insert(scene.a, {0, 1, 2}), VOX_ERROR_INVALID_ARGUMENT, "3 indices");
    fails(grid.bind(*a, vox::span<const float>(scene.a.data(), 12)), VOX_ERROR_INVALID_ARGUMENT,
          "positions.count is 4, expected 64");
    fails(grid.readings(), VOX_ERROR_INVALID_STATE, "readings");
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = 1000;
    fails(vox::grid::create(desc), VOX_ERROR_INVALID_ARGUMENT, "1000");
    vox::grid moved = std::move(grid);
    fails(grid.step(), VOX_ERROR_INVALID_ARGUMENT, "null"); // NOLINT: what a moved-from grid does
    const auto minimum = vox::minimise([](double d) { return d + 1 / d; }, 0.1, 10);
    ck_assert(minimum && minimum->cell_size > 0.99 && minimum->cell_size < 1.01);
    aborts([&] { (void)*moved.user_data(99); });
    aborts([&] { moved.set_cell_size(-1).value(); });
}
END_TEST

START_TEST(ended_views_say_so) {
    const Scene scene;
    vox::grid grid = vox::grid::create().value();
    const vox_body a = grid.insert(scene.a, scene.tets).value();
    grid.insert(scene.b, scene.tets).value();
    grid.step().value();
    const auto contacts = grid.contacts().value();
    const auto positions = grid.map_positions<float>(a).value();
    ck_assert(contacts.check() && positions.check());
    grid.step().value();
    fails(contacts.check(), VOX_ERROR_INVALID_STATE, "a view of epoch 1 is read in epoch 2");
    ck_assert(positions.check());
    grid.remove(a).value();
    fails(positions.check(), VOX_ERROR_INVALID_STATE, "mapped positions");
    aborts([&] { (void)contacts[0].tet; });
    aborts([&] { (void)contacts.begin(); });
}
END_TEST

} // namespace

SUITE(hpp_results) { tcase_add_each(add_case(suite, "all"), values_and_errors, ended_views_say_so); }
