// What fails on one rank fails on all with the same code, nobody waits, and the next step works. What is not
// supported, or does not fit together, is refused with its numbers.
#include "dist/ranks.hpp"
#include "dist/whole.hpp"

#include "support/suite.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <mutex>

using namespace scenes;

namespace {

constexpr std::uint32_t size = 3;

// The heap of a scene, which fails once.
struct Heap {
    std::uint64_t calls = 0, fail_at = 0;
    std::int64_t held = 0;

    static void* allocate(std::size_t bytes, std::size_t alignment, void* user) {
        Heap& heap = *static_cast<Heap*>(user);
        if (++heap.calls == heap.fail_at) return nullptr;
        ++heap.held;
        return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    }
    static void release(void* memory, std::size_t, std::size_t, void* user) {
        --static_cast<Heap*>(user)->held;
        std::free(memory);
    }
    const vox_allocator allocator{allocate, release, this};
};

// Two blocks, one half a cube within the other, cut at random: contacts on facets, edges and corners across
// ranks.
Scene two_blocks() {
    Scene scene;
    for (int b = 0; b < 2; ++b) {
        const std::uint32_t n[3] = {2, 2, 2};
        const double origin[3] = {b * 0.5, b * 0.5, b * 1.0};
        scene.push_back(block(n, origin, 1));
        scene.back().number = 100 + static_cast<std::uint64_t>(b);
        scene.back().doubles = b != 0;
    }
    return scene;
}

// What the ranks of a test share.
struct Ranks {
    Scene scene = two_blocks();
    std::vector<std::vector<Share>> shares; // of each body, of each rank
    std::uint64_t expected[2] = {};
    std::mutex mutex;
    std::string fault;

    Ranks() {
        std::vector<std::vector<float>> floats;
        vox_grid* grid = whole(scene, floats);
        ck_ok(vox_grid_step(grid));
        const std::vector<vox_dist_contact> contacts = global_contacts(scene, grid);
        ck_assert_uint_gt(contacts.size(), 10);
        hash_of(contacts, expected);
        vox_grid_destroy(grid);
        Random random(21);
        for (const Body& body : scene)
            shares.push_back(scenes::shares(body, cut(body, size, Cut::random, random), size, random));
    }
    // Runs `function` on each rank.
    void run(const std::function<void(const vox_dist_transport*)>& function) {
        run_ranks(size, 1, function);
        ck_assert_msg(fault.empty(), "%s", fault.c_str());
    }
    // A condition that a rank expects; no exit from its thread, for which the others would wait.
    void expect(bool holds, const std::string& what) {
        if (holds) return;
        const std::string text = what + " (" + vox_last_error() + ")";
        const std::lock_guard lock(mutex);
        if (fault.empty()) fault = text;
    }
    void insert_all(Ranked& mine, std::uint32_t rank) {
        for (std::size_t b = 0; b < scene.size(); ++b)
            expect(mine.insert(scene[b], shares[b][rank]) == VOX_OK, "insert");
    }
    void expect_step(vox_dist_scene* mine) {
        std::uint64_t hash[2] = {};
        expect(vox_dist_scene_step(mine) == VOX_OK, "the next step");
        expect(vox_dist_scene_get_hash(mine, hash) == VOX_OK && hash[0] == expected[0] &&
                   hash[1] == expected[1],
               "the hash of the next step");
    }
    // All ranks have this result; those that did not fail themselves name the rank that did.
    void expect_everywhere(const vox_dist_transport* transport, vox_result result, std::uint32_t bad,
                           const std::string& what) {
        std::int64_t mine = result, all[size];
        const std::string text = vox_last_error();
        expect(transport->allgather(&mine, sizeof mine, all, transport->user) == VOX_OK, "allgather");
        for (const std::int64_t other : all)
            expect(other == mine,
                   what + ": " + vox_result_string(result) + " is not the result of all ranks");
        if (result != VOX_OK && transport->rank != bad)
            expect(text.find("rank " + std::to_string(bad) + " ") != std::string::npos,
                   what + ": the rank is not named");
    }
};

// Also one that there is not.
vox_dist_side side_of(std::uint32_t number) { return static_cast<vox_dist_side>(number); }

using Operation = std::function<vox_result(vox_dist_scene*)>;

vox_result locate(vox_dist_scene* scene) {
    const double points[6] = {0.5, 0.5, 1, 1.25, 1.25, 1.5};
    vox_dist_location found[2];
    const vox_positions asked = vox_double_positions(points, 2);
    return vox_dist_scene_locate(scene, &asked, found);
}

vox_result send(vox_dist_scene* scene) {
    vox_dist_contact_view contacts{}, of_tets{};
    (void)vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &contacts);
    (void)vox_dist_scene_get_contacts(scene, VOX_DIST_TETS, &of_tets);
    std::vector<std::uint64_t> in(contacts.count), out(of_tets.count);
    return vox_dist_scene_send(scene, VOX_DIST_VERTICES, 8, in.data(), out.data());
}

// With the n-th allocation of one rank failing, for all n. Returns how many there are. `steps` go before.
std::uint64_t fail_each(const Operation& operation, std::uint32_t bad, int steps) {
    Ranks ranks;
    std::uint64_t allocations = 0;
    ranks.run([&](const vox_dist_transport* transport) {
        for (std::uint64_t n = 1;; ++n) {
            Heap heap;
            {
                vox_grid_desc grid = vox_default_grid_desc();
                grid.flags = 0;
                grid.allocator = &heap.allocator;
                Ranked mine(transport, &grid);
                ranks.expect(mine.result == VOX_OK, "create");
                ranks.insert_all(mine, transport->rank);
                for (int step = 0; step < steps; ++step) ranks.expect_step(mine.scene);
                heap.calls = 0;
                heap.fail_at = transport->rank == bad ? n : 0;
                const vox_result result = operation(mine.scene);
                heap.fail_at = 0;
                ranks.expect(result == VOX_OK || result == VOX_ERROR_OUT_OF_MEMORY, "another code");
                ranks.expect_everywhere(transport, result, bad, "allocation " + std::to_string(n));
                ranks.expect_step(mine.scene);
                ranks.expect(operation(mine.scene) == VOX_OK, "the same again");
                std::uint64_t done = result == VOX_OK, sum = 0;
                (void)transport->agree(&done, 1, &sum, 1, transport->user);
                if (done || !ranks.fault.empty()) {
                    if (transport->rank == bad) allocations = n - 1;
                    n = UINT64_MAX;
                }
            }
            ranks.expect(heap.held == 0, "blocks are left");
            if (n == UINT64_MAX) return;
        }
    });
    return allocations;
}

// The exchange of a rank that fails once, after the others have their messages.
struct Torn {
    const vox_dist_transport* inner;
    int calls = 0, fail_at = 0;
    static vox_result allgather(const void* in, std::uint64_t bytes, void* out, void* user) {
        const vox_dist_transport& to = *static_cast<Torn*>(user)->inner;
        return to.allgather(in, bytes, out, to.user);
    }
    static vox_result exchange(const std::uint32_t* ranks, std::uint32_t count, const vox_dist_message* out,
                               vox_dist_message* in, void* user) {
        Torn& torn = *static_cast<Torn*>(user);
        const vox_result result = torn.inner->exchange(ranks, count, out, in, torn.inner->user);
        return ++torn.calls == torn.fail_at ? vox_fail(VOX_ERROR_OUT_OF_MEMORY, "torn") : result;
    }
    static vox_result agree(std::uint64_t* minima, std::uint32_t minimum_count, std::uint64_t* sums,
                            std::uint32_t sum_count, void* user) {
        const vox_dist_transport& to = *static_cast<Torn*>(user)->inner;
        return to.agree(minima, minimum_count, sums, sum_count, to.user);
    }
    vox_dist_transport transport() {
        return {sizeof(vox_dist_transport), inner->rank, inner->size, 0, allgather, exchange, agree, this};
    }
};

} // namespace

START_TEST(each_failed_allocation_of_a_step) {
    for (std::uint32_t bad = 0; bad < size; ++bad)
        ck_assert_uint_gt(fail_each(vox_dist_scene_step, bad, 0), 50);
    ck_assert_uint_gt(fail_each(vox_dist_scene_step, 1, 2), 10);
}
END_TEST

START_TEST(each_failed_allocation_of_other_calls) {
    ck_assert_uint_gt(fail_each(locate, 0, 0), 50);
    ck_assert_uint_gt(fail_each(locate, 2, 1), 10);
    ck_assert_uint_gt(fail_each(send, 1, 1), 2);
    ck_assert_uint_gt(fail_each(vox_dist_scene_check, 1, 0), 5);
}
END_TEST

START_TEST(each_failed_allocation_of_create) {
    Ranks ranks;
    std::uint64_t failures = 0;
    ranks.run([&](const vox_dist_transport* transport) {
        for (std::uint64_t n = 1;; ++n) {
            Heap heap;
            heap.fail_at = transport->rank == 1 ? n : 0;
            vox_grid_desc grid = vox_default_grid_desc();
            grid.flags = 0;
            grid.allocator = &heap.allocator;
            vox_dist_scene* scene = nullptr;
            const vox_result result = vox_dist_scene_create(&grid, transport, &scene);
            ranks.expect_everywhere(transport, result, 1, "create");
            ranks.expect((result == VOX_OK) == (scene != nullptr), "a scene that failed");
            vox_dist_scene_destroy(scene);
            ranks.expect(heap.held == 0, "blocks are left");
            if (result == VOX_OK) return;
            if (transport->rank == 1) ++failures;
        }
    });
    ck_assert_uint_gt(failures, 3);
}
END_TEST

START_TEST(a_budget_of_one_rank) {
    std::uint64_t failures = 0;
    for (std::uint64_t budget = 4096; budget < 4 << 20; budget += budget / 16) {
        Ranks ranks;
        ranks.run([&](const vox_dist_transport* transport) {
            vox_grid_desc grid = vox_default_grid_desc();
            grid.flags = 0;
            if (transport->rank == 2) grid.byte_budget = budget;
            Ranked mine(transport, &grid);
            if (mine.result != VOX_OK) return ranks.expect(mine.result == VOX_ERROR_BUDGET, "create");
            vox_result inserted = VOX_OK;
            for (std::size_t b = 0; b < ranks.scene.size() && inserted == VOX_OK; ++b)
                inserted = mine.insert(ranks.scene[b], ranks.shares[b][transport->rank]);
            std::int64_t one = inserted, all[size];
            (void)transport->allgather(&one, sizeof one, all, transport->user);
            if (all[2] != VOX_OK) return ranks.expect(all[2] == VOX_ERROR_BUDGET, "insert");
            const vox_result result = vox_dist_scene_step(mine.scene);
            ranks.expect(result == VOX_OK || result == VOX_ERROR_BUDGET, "another code");
            ranks.expect_everywhere(transport, result, 2, "budget");
            if (transport->rank == 0) failures += result == VOX_ERROR_BUDGET;
        });
    }
    ck_assert_uint_gt(failures, 0);
}
END_TEST

START_TEST(a_bad_number_on_one_rank) {
    for (std::uint32_t bad = 0; bad < size; ++bad)
        for (const double number : {double(NAN), double(INFINITY), 1e300}) {
            Ranks ranks;
            ranks.run([&](const vox_dist_transport* transport) {
                Ranked mine(transport);
                ranks.insert_all(mine, transport->rank);
                double* const changed = transport->rank == bad ? &ranks.shares[1][bad].xyz.back() : nullptr;
                const double before = changed ? *changed : 0;
                for (const Operation& operation :
                     {Operation(vox_dist_scene_step), Operation(locate), Operation(vox_dist_scene_check)}) {
                    if (changed) *changed = number;
                    const vox_result result = operation(mine.scene);
                    if (changed) *changed = before;
                    ranks.expect(result == (number == 1e300 ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE),
                                 "the code");
                    ranks.expect(!changed || std::strstr(vox_last_error(), " of body 101 "),
                                 "the vertex is not named");
                    ranks.expect_everywhere(transport, result, bad, "number");
                    ranks.expect_step(mine.scene);
                }
            });
        }
}
END_TEST

START_TEST(an_exchange_that_fails) {
    Ranks ranks;
    ranks.run([&](const vox_dist_transport* transport) {
        Torn torn{transport};
        const vox_dist_transport mine_transport = torn.transport();
        Ranked mine(&mine_transport);
        ranks.insert_all(mine, transport->rank);
        for (int n = 1; n <= 4; ++n) {
            torn.calls = 0;
            torn.fail_at = transport->rank == 1 ? n : 0;
            const vox_result result = vox_dist_scene_step(mine.scene);
            torn.fail_at = 0;
            if (n < 4) {
                ranks.expect(result == VOX_ERROR_OUT_OF_MEMORY, "the code");
                ranks.expect_everywhere(transport, result, 1, "exchange " + std::to_string(n));
            } else { // about boundaries, after all agreed: as the header says, on one rank alone
                ranks.expect(result == (transport->rank == 1 ? VOX_ERROR_OUT_OF_MEMORY : VOX_OK),
                             "the last exchange");
            }
            if (result != VOX_OK) {
                vox_dist_contact_view contacts{}, of_tets{};
                (void)vox_dist_scene_get_contacts(mine.scene, VOX_DIST_VERTICES, &contacts);
                (void)vox_dist_scene_get_contacts(mine.scene, VOX_DIST_TETS, &of_tets);
                ranks.expect(contacts.count == 0 && of_tets.count == 0, "contacts of a failed step");
            }
            ranks.expect_step(mine.scene);
        }
    });
}
END_TEST

START_TEST(ranks_that_call_different_functions) {
    Ranks ranks;
    ranks.run([&](const vox_dist_transport* transport) {
        Ranked mine(transport);
        ranks.insert_all(mine, transport->rank);
        const vox_result result = transport->rank == 1 ? locate(mine.scene) : vox_dist_scene_step(mine.scene);
        ranks.expect(result == VOX_ERROR_INVALID_STATE, "the code");
        ranks.expect_step(mine.scene);
    });
}
END_TEST

START_TEST(items_of_other_sizes) {
    Ranks ranks;
    ranks.run([&](const vox_dist_transport* transport) {
        Ranked mine(transport);
        ranks.insert_all(mine, transport->rank);
        ranks.expect_step(mine.scene);
        char items[4096] = {}, out[4096];
        ranks.expect(vox_dist_scene_send(mine.scene, VOX_DIST_VERTICES, 1 + transport->rank % 2, items,
                                         out) == VOX_ERROR_INVALID_ARGUMENT,
                     "items of 1 and of 2 bytes");
        ranks.expect(vox_dist_scene_send(mine.scene, side_of(transport->rank % 2), 1, items, out) ==
                         VOX_ERROR_INVALID_ARGUMENT,
                     "both sides");
        ranks.expect(vox_dist_scene_send(mine.scene, VOX_DIST_VERTICES, 1, items, out) == VOX_OK, "bytes");
    });
}
END_TEST

START_TEST(a_part_that_moves_to_other_memory) {
    double xyz[2][4][3] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};
    std::uint32_t corners[4] = {0, 1, 2, 4};
    vox_dist_scene* scene = nullptr;
    ck_ok(vox_dist_scene_create(nullptr, nullptr, &scene));
    vox_mesh_desc mesh = vox_mesh_desc_doubles(xyz[0][0], 4, corners, 1);
    vox_dist_part_desc part = vox_default_dist_part_desc();
    part.body = 5;
    part.mesh = &mesh;
    mesh.struct_size = 0;
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 0");
    mesh.struct_size = sizeof mesh;
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_INVALID_MESH, "tet 0 names vertex 4 of 4");
    corners[3] = 3;
    ck_ok(vox_dist_scene_insert(scene, &part));
    const double point[3] = {0.6, 0.6, 0.6};
    const vox_positions asked = vox_double_positions(point, 1);
    const vox_positions places[2] = {vox_double_positions(xyz[0][0], 4), vox_double_positions(xyz[1][0], 4)};
    vox_dist_location found{};
    ck_ok(vox_dist_scene_locate(scene, &asked, &found));
    ck_assert_uint_eq(found.state, VOX_LOCATION_OUTSIDE);
    ck_assert(std::abs(found.distance - 0.8 / std::sqrt(3.0)) < 1e-15);
    ck_ok(vox_dist_scene_bind_positions(scene, 5, &places[1]));
    ck_ok(vox_dist_scene_locate(scene, &asked, &found));
    ck_assert_uint_eq(found.rank, 0);
    ck_assert_uint_eq(found.body, 5);
    ck_assert_uint_eq(found.state, VOX_LOCATION_INSIDE);
    ck_fails(vox_dist_scene_bind_positions(scene, 6, &places[0]), VOX_ERROR_INVALID_HANDLE,
             "no part of body 6");
    ck_ok(vox_dist_scene_remove(scene, 5));
    ck_ok(vox_dist_scene_locate(scene, &asked, &found));
    ck_assert_uint_eq(found.rank, VOX_NONE);
    ck_assert_uint_eq(found.body | found.tet | static_cast<std::uint32_t>(found.state), 0);
    ck_fails(vox_dist_scene_remove(scene, 5), VOX_ERROR_INVALID_HANDLE, "no part of body 5");
    ck_fails(vox_dist_scene_bind_positions(scene, 5, &places[1]), VOX_ERROR_INVALID_HANDLE,
             "no part of body 5");
    vox_dist_scene_destroy(scene);
}
END_TEST

namespace {

// What vox_dist_scene_check says on all ranks, after `damage` to the shares of each.
std::string checked(const std::function<void(std::uint32_t rank, std::vector<Share>& of_body)>& damage) {
    Ranks ranks;
    std::string texts;
    ranks.run([&](const vox_dist_transport* transport) {
        Ranked mine(transport);
        std::vector<Share> of_body;
        for (const auto& shares : ranks.shares) of_body.push_back(shares[transport->rank]);
        damage(transport->rank, of_body);
        for (std::size_t b = 0; b < of_body.size(); ++b)
            ranks.expect(mine.insert(ranks.scene[b], of_body[b]) == VOX_OK, "insert");
        ranks.expect(vox_dist_scene_check(mine.scene) == VOX_ERROR_INVALID_STATE, "check");
        const std::lock_guard lock(ranks.mutex);
        texts = texts + vox_last_error() + '\n';
    });
    return texts;
}

void ck_contains(const std::string& text, const std::string& words) {
    ck_assert_msg(text.find(words) != std::string::npos, "\"%s\", expected \"%s\" in it", text.c_str(),
                  words.c_str());
}

} // namespace

START_TEST(check_names_what_does_not_fit) {
    const Ranks ranks;
    const Share& of_2 = ranks.shares[1][2];
    const auto copy =
        static_cast<std::size_t>(std::find(of_2.owned.begin(), of_2.owned.end(), 0) - of_2.owned.begin());
    ck_assert_uint_lt(copy, of_2.owned.size());
    const std::string vertex = "vertex " + std::to_string(of_2.vertex_ids[copy]) + " of body 101";
    std::string text = checked([&](std::uint32_t rank, std::vector<Share>& of_body) {
        if (rank == 2) of_body[1].xyz[3 * copy] = std::nextafter(of_body[1].xyz[3 * copy], 9);
    });
    ck_contains(text, vertex + " is at ");
    ck_contains(text, "on rank 2");
    text = checked([&](std::uint32_t rank, std::vector<Share>& of_body) {
        if (rank == 2) of_body[1].owned[copy] = 1;
    });
    ck_contains(text, vertex + " is owned by ranks ");
    text = checked([&](std::uint32_t, std::vector<Share>& of_body) {
        for (std::size_t i = 0; i < of_body[1].owned.size(); ++i)
            if (of_body[1].vertex_ids[i] == of_2.vertex_ids[copy]) of_body[1].owned[i] = 0;
    });
    ck_contains(text, vertex + " has a copy on rank ");
    ck_contains(text, "no rank owns it");
    const std::uint64_t tet = of_2.tet_ids[0];
    text = checked([&](std::uint32_t rank, std::vector<Share>& of_body) {
        if (rank == 0) of_body[1].tet_ids[0] = tet;
    });
    ck_contains(text, "tet " + std::to_string(tet) + " of body 101 is on ranks 0 and 2");
}
END_TEST

START_TEST(what_a_scene_cannot_be_created_from) {
    vox_dist_scene* scene = nullptr;
    vox_grid_desc grid = vox_default_grid_desc();
    grid.flags = VOX_GRID_CONSTRAINTS;
    ck_fails(vox_dist_scene_create(&grid, nullptr, &scene), VOX_ERROR_UNSUPPORTED, "flags is 1, expected 0");
    grid.flags = VOX_GRID_EDGES;
    ck_fails(vox_dist_scene_create(&grid, nullptr, &scene), VOX_ERROR_UNSUPPORTED, "flags is 2");
    grid.flags = 0;
    grid.margin = 0.5;
    ck_fails(vox_dist_scene_create(&grid, nullptr, &scene), VOX_ERROR_UNSUPPORTED, "margin is 0.5");
    grid.margin = 0;
    grid.struct_size = 0;
    ck_fails(vox_dist_scene_create(&grid, nullptr, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "grid.struct_size is 0");
    ck_fails(vox_dist_scene_create(nullptr, nullptr, nullptr), VOX_ERROR_INVALID_ARGUMENT, "out_scene");
    vox_dist_transport transport{};
    ck_fails(vox_dist_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "transport.struct_size is 0");
    transport.struct_size = sizeof transport;
    ck_fails(vox_dist_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "rank is 0 of 0");
    transport.size = 3;
    transport.rank = 3;
    ck_fails(vox_dist_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "rank is 3 of 3");
    transport.rank = 0;
    ck_fails(vox_dist_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "lacks one of its functions");
    ck_assert_ptr_null(scene);
    transport.size = 1; // needs none
    ck_ok(vox_dist_scene_create(nullptr, &transport, &scene));
    ck_ok(vox_dist_scene_step(scene));
    vox_dist_scene_destroy(scene);
    vox_dist_scene_destroy(nullptr);
}
END_TEST

START_TEST(arguments) {
    const Scene bodies = two_blocks();
    vox_dist_scene* scene = nullptr;
    ck_ok(vox_dist_scene_create(nullptr, nullptr, &scene));
    Body body = bodies[0];
    vox_mesh_desc mesh =
        vox_mesh_desc_doubles(body.xyz.data(), body.vertices(), body.tets.data(), body.tet_count());
    std::vector<std::uint64_t> ids(body.vertices());
    std::vector<std::uint8_t> owned(body.vertices(), 1);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 1000 - i;
    const std::uint64_t number = std::uint64_t{7} << 32; // more than 32 bits hold
    vox_dist_part_desc part = vox_default_dist_part_desc();
    part.body = number;
    part.mesh = &mesh;
    part.vertex_ids = ids.data();
    part.owned = owned.data();
    ids[5] = 1000;
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_INVALID_ARGUMENT, "1000");
    ids[5] = 995;
    owned[3] = 2;
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_INVALID_ARGUMENT, "2");
    owned[3] = 1;
    vox_filter filter{};
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    mesh.filter = filter;
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_UNSUPPORTED, "ring");
    mesh.filter = {};
    ck_fails(vox_dist_scene_remove(scene, number), VOX_ERROR_INVALID_HANDLE, "no part of body 30064771072");
    ck_ok(vox_dist_scene_insert(scene, &part));
    ck_fails(vox_dist_scene_insert(scene, &part), VOX_ERROR_INVALID_ARGUMENT, "body 30064771072 has a part");
    ck_fails(vox_dist_scene_remove(scene, number + 1), VOX_ERROR_INVALID_HANDLE,
             "no part of body 30064771073");
    ck_fails(vox_dist_scene_remove(scene, 0), VOX_ERROR_INVALID_HANDLE, "no part of body 0");
    std::uint64_t item = 0;
    ck_fails(vox_dist_scene_send(scene, VOX_DIST_VERTICES, 0, &item, &item), VOX_ERROR_INVALID_ARGUMENT,
             "item_bytes");
    ck_fails(vox_dist_scene_send(scene, VOX_DIST_VERTICES, 65537, &item, &item), VOX_ERROR_INVALID_ARGUMENT,
             "item_bytes is 65537");
    ck_ok(vox_dist_scene_send(scene, VOX_DIST_TETS, 65536, nullptr, nullptr)); // no contacts yet
    ck_fails(vox_dist_scene_send(scene, side_of(2), 8, &item, &item), VOX_ERROR_INVALID_ARGUMENT,
             "from is 2");
    const Body& other = bodies[1];
    mesh = vox_mesh_desc_doubles(other.xyz.data(), other.vertices(), other.tets.data(), other.tet_count());
    part.body = 6;
    part.vertex_ids = nullptr;
    part.owned = nullptr;
    ck_ok(vox_dist_scene_insert(scene, &part));
    ck_ok(vox_dist_scene_step(scene));
    vox_dist_contact_view view{};
    ck_fails(vox_dist_scene_get_contacts(scene, side_of(2), &view), VOX_ERROR_INVALID_ARGUMENT, "side is 2");
    ck_assert_ptr_null(view.data);
    ck_ok(vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &view));
    ck_assert_uint_gt(view.count, 0);
    ck_fails(vox_dist_scene_send(scene, VOX_DIST_VERTICES, 8, nullptr, &item), VOX_ERROR_INVALID_ARGUMENT,
             "in is null");
    ck_fails(vox_dist_scene_send(scene, VOX_DIST_TETS, 8, &item, nullptr), VOX_ERROR_INVALID_ARGUMENT,
             "out is null");
    vox_dist_cost costs[2];
    std::uint64_t count = 0;
    ck_ok(vox_dist_scene_get_costs(scene, costs, 1, &count));
    ck_assert_uint_eq(count, 2);
    ck_ok(vox_dist_scene_get_costs(scene, costs, 2, &count));
    ck_assert_uint_eq(costs[0].body, 6);
    ck_assert_uint_eq(costs[1].body, number);
    for (const vox_dist_cost& cost : costs) // of some tetrahedra: microseconds, not nanoseconds nor seconds
        ck_assert_msg(cost.seconds > 1e-8 && cost.seconds < 1e-2, "%g seconds", cost.seconds);
    ck_ok(vox_dist_scene_remove(scene, number));
    ck_ok(vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &view));
    ck_assert_uint_gt(view.count, 0); // those of the last step stay
    ck_ok(vox_dist_scene_step(scene));
    ck_ok(vox_dist_scene_get_contacts(scene, VOX_DIST_VERTICES, &view));
    ck_assert_uint_eq(view.count, 0);
    vox_dist_scene_destroy(scene);
}
END_TEST

SUITE(dist_failures) {
    TCase* tests = add_case(suite, "failures");
    tcase_set_timeout(tests, 240); // ranks that wait for each other
    tcase_add_each(tests, each_failed_allocation_of_a_step, each_failed_allocation_of_other_calls,
                   each_failed_allocation_of_create, a_budget_of_one_rank, a_bad_number_on_one_rank,
                   an_exchange_that_fails, ranks_that_call_different_functions, items_of_other_sizes,
                   a_part_that_moves_to_other_memory, check_names_what_does_not_fit,
                   what_a_scene_cannot_be_created_from, arguments);
}
