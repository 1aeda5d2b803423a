// Parts that do not fit together are named with their ranks, bad arguments with their numbers; positions go
// to any number of ranks.
#include "dist/whole.hpp"

#include "support/suite.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <mutex>

using namespace scenes;

namespace {

constexpr std::uint32_t ranks = 4;

// Runs a function on each rank. Assertions hold on the main thread alone, so the others report the first that
// fails.
class Reports {
public:
    void expect(bool holds, const std::string& text) {
        const std::lock_guard lock(mutex_);
        if (!holds && first_.empty()) first_ = text;
    }
    void expect(vox_result found, vox_result expected, const char* call) {
        expect(found == expected, std::string(call) + ": " + vox_result_string(found) + ", expected " +
                                      vox_result_string(expected) + " (" + vox_last_error() + ")");
    }
    // The text of the lowest rank that failed.
    void add_text(const std::string& text) {
        const std::lock_guard lock(mutex_);
        texts_ += text + '\n';
    }
    const std::string& first() const { return first_; }
    const std::string& texts() const { return texts_; }

private:
    std::mutex mutex_;
    std::string first_, texts_;
};

using OnRank = std::function<void(const vox_transport&, Reports&)>;

// Returns the texts that were added.
std::string run(const OnRank& on_rank, std::uint32_t size = ranks) {
    struct Context {
        const OnRank& function;
        Reports reports;
    } context{on_rank, {}};
    const auto call = [](const vox_transport* transport, void* user) {
        Context& c = *static_cast<Context*>(user);
        c.function(*transport, c.reports);
    };
    ck_ok(vox_transport_run(size, 2, call, &context));
    ck_assert_msg(context.reports.first().empty(), "%s", context.reports.first().c_str());
    return context.reports.texts();
}

// Two blocks that overlap, cut in stripes, so that every rank has copies of others' vertices.
struct Cuts {
    explicit Cuts(bool doubles = true) {
        const std::uint32_t n[3] = {3, 3, 2};
        const double at[2][3] = {{0, 0, 0}, {1.25, 0.5, 0.75}};
        Random random(1);
        for (std::uint64_t b = 0; b < 2; ++b) {
            scene.push_back(block(n, at[b], 1));
            scene.back().number = 100 + b;
            scene.back().doubles = doubles;
        }
        std::vector<std::vector<float>> floats;
        vox_grid* grid = whole(scene, floats);
        ck_assert_ptr_nonnull(grid);
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_scene_hash_of_grid(grid, expected));
        ck_assert_uint_gt(contacts_of(grid).count, 0);
        vox_grid_destroy(grid);
        for (const Body& body : scene)
            all.push_back(shares(body, cut(body, ranks, Cut::stripes, random), ranks, random));
    }
    std::vector<Share>& share(std::uint32_t rank, std::vector<Share>& mine) const {
        for (const auto& of_body : all) mine.push_back(of_body[rank]);
        return mine;
    }

    Scene scene;
    std::vector<std::vector<Share>> all;
    std::uint64_t expected[2];
};

void insert_all(const Cuts& cuts, Ranked& mine, std::vector<Share>& own, Reports& reports) {
    for (std::size_t b = 0; b < cuts.scene.size(); ++b)
        reports.expect(mine.insert(cuts.scene[b], own[b]), VOX_OK, "insert");
}

void expect_hash(const Cuts& cuts, Ranked& mine, Reports& reports) {
    std::uint64_t hash[2];
    reports.expect(vox_scene_step(mine.scene), VOX_OK, "step");
    reports.expect(vox_scene_hash(mine.scene, hash), VOX_OK, "hash");
    reports.expect(hash[0] == cuts.expected[0] && hash[1] == cuts.expected[1], "another hash");
}

// What vox_scene_check says after `damage` of the shares of this rank.
std::string checked(const Cuts& cuts,
                    const std::function<void(std::uint32_t rank, std::vector<Share>&)>& damage) {
    return run([&](const vox_transport& transport, Reports& reports) {
        Ranked mine(&transport);
        std::vector<Share> own;
        cuts.share(transport.rank, own);
        damage(transport.rank, own);
        insert_all(cuts, mine, own, reports);
        reports.expect(vox_scene_check(mine.scene), VOX_ERROR_INVALID_STATE, "check");
        reports.add_text(vox_last_error());
    });
}

std::size_t copy_in(const Share& share) {
    return static_cast<std::size_t>(std::find(share.owned.begin(), share.owned.end(), 0) -
                                    share.owned.begin());
}

void ck_contains(const std::string& text, const std::string& words) {
    ck_assert_msg(text.find(words) != std::string::npos, "\"%s\", expected \"%s\" in it", text.c_str(),
                  words.c_str());
}

} // namespace

START_TEST(check_names_what_does_not_fit) {
    const Cuts cuts;
    const Share& of_2 = cuts.all[0][2];
    const std::size_t copy = copy_in(of_2);
    ck_assert_uint_lt(copy, of_2.owned.size());
    const std::string vertex = "vertex " + std::to_string(of_2.vertex_ids[copy]) + " of body 100";
    std::string text = checked(cuts, [&](std::uint32_t rank, std::vector<Share>& own) {
        if (rank == 2) own[0].xyz[3 * copy] = std::nextafter(own[0].xyz[3 * copy], 9);
    });
    ck_contains(text, vertex + " is at ");
    ck_contains(text, "on rank 2");
    text = checked(cuts, [&](std::uint32_t rank, std::vector<Share>& own) {
        if (rank == 2) own[0].owned[copy] = 1;
    });
    ck_contains(text, vertex + " is owned by ranks ");
    text = checked(cuts, [&](std::uint32_t, std::vector<Share>& own) {
        for (std::size_t i = 0; i < own[0].owned.size(); ++i)
            if (own[0].vertex_ids[i] == of_2.vertex_ids[copy]) own[0].owned[i] = 0;
    });
    ck_contains(text, vertex + " has a copy on rank ");
    ck_contains(text, "no rank owns it");
    const std::uint64_t tet = cuts.all[1][3].tet_ids[0];
    text = checked(cuts, [&](std::uint32_t rank, std::vector<Share>& own) {
        if (rank == 0) own[1].tet_ids[0] = tet;
    });
    ck_contains(text, "tet " + std::to_string(tet) + " of body 101 is on ranks 0 and 3");
}
END_TEST

START_TEST(arguments) {
    const Cuts cuts;
    vox_scene* scene = nullptr;
    vox_scene_desc desc;
    ck_ok(vox_scene_desc_init(&desc, sizeof desc));
    vox_grid_desc grid = vox_default_grid_desc();
    desc.grid = &grid;
    grid.flags = VOX_GRID_EDGE_CONTACTS;
    ck_fails(vox_scene_create(&desc, nullptr, &scene), VOX_ERROR_UNSUPPORTED, "flags is 8");
    grid.flags = 0;
    grid.margin = 0.5;
    ck_fails(vox_scene_create(&desc, nullptr, &scene), VOX_ERROR_UNSUPPORTED, "margin is 0.5");
    ck_fails(vox_scene_create(nullptr, nullptr, nullptr), VOX_ERROR_INVALID_ARGUMENT, "out_scene");
    vox_transport transport;
    ck_ok(vox_transport_init(&transport, sizeof transport));
    transport.size = 3;
    transport.rank = 3;
    ck_fails(vox_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT, "rank is 3 of 3");
    transport.rank = 0;
    ck_fails(vox_scene_create(nullptr, &transport, &scene), VOX_ERROR_INVALID_ARGUMENT,
             "lacks one of its functions");
    ck_assert_ptr_null(scene);
    ck_fails(vox_transport_run(
                 0, 1, [](const vox_transport*, void*) {}, nullptr),
             VOX_ERROR_INVALID_ARGUMENT, "0");

    ck_ok(vox_scene_create(nullptr, nullptr, &scene));
    Body body = cuts.scene[0];
    vox_mesh_desc mesh =
        vox_mesh_desc_doubles(body.xyz.data(), body.vertices(), body.tets.data(), body.tet_count());
    std::vector<std::uint64_t> ids(body.vertices());
    std::vector<std::uint8_t> owned(body.vertices(), 1);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 1000 - i;
    vox_part_desc part;
    ck_ok(vox_part_desc_init(&part, sizeof part));
    part.body = 7;
    part.mesh = &mesh;
    part.vertex_ids = ids.data();
    part.owned = owned.data();
    vox_part handle = 0;
    ids[5] = 1000;
    ck_fails(vox_scene_insert(scene, &part, &handle), VOX_ERROR_INVALID_ARGUMENT, "1000");
    ids[5] = 995;
    owned[3] = 2;
    ck_fails(vox_scene_insert(scene, &part, &handle), VOX_ERROR_INVALID_ARGUMENT, "2");
    owned[3] = 1;
    vox_filter filter = vox_default_filter();
    filter.self_collision = 1;
    filter.self_rings = 1;
    mesh.filter = &filter;
    ck_fails(vox_scene_insert(scene, &part, &handle), VOX_ERROR_UNSUPPORTED, "ring");
    mesh.filter = nullptr;
    ck_assert_uint_eq(handle, 0);
    ck_ok(vox_scene_insert(scene, &part, &handle));
    vox_part second = 0;
    ck_fails(vox_scene_insert(scene, &part, &second), VOX_ERROR_INVALID_ARGUMENT, "7");
    ck_fails(vox_scene_remove(scene, handle + 1), VOX_ERROR_INVALID_HANDLE, "part");
    std::uint64_t item = 0;
    ck_fails(vox_scene_send(scene, VOX_DIRECTION_TO_TETS, 0, &item, &item), VOX_ERROR_INVALID_ARGUMENT,
             "item_bytes");
    const Body& other = cuts.scene[1];
    mesh = vox_mesh_desc_doubles(other.xyz.data(), other.vertices(), other.tets.data(), other.tet_count());
    part.body = 6;
    part.vertex_ids = nullptr;
    part.owned = nullptr;
    ck_ok(vox_scene_insert(scene, &part, &second));
    ck_ok(vox_scene_step(scene));
    vox_part_cost costs[2];
    std::uint64_t count = 0;
    ck_ok(vox_scene_costs(scene, costs, 1, &count));
    ck_assert_uint_eq(count, 2);
    ck_ok(vox_scene_costs(scene, costs, 2, &count));
    ck_assert_uint_eq(costs[0].body, 6);
    ck_assert_uint_eq(costs[0].part, second);
    ck_assert_uint_eq(costs[1].body, 7);
    ck_assert_uint_eq(costs[1].part, handle);
    ck_assert(costs[0].predicted_ns > 0 && costs[1].predicted_ns > 0);
    ck_ok(vox_scene_remove(scene, handle));
    ck_ok(vox_scene_step(scene));
    vox_scene_destroy(scene);
    vox_scene_destroy(nullptr);
}
END_TEST

// Positions that some ranks hold go to another number of them: the same contacts.
START_TEST(another_number_of_ranks) {
    const Cuts cuts;
    for (const std::uint32_t size : {1u, 3u, 9u}) {
        Random random(size);
        std::vector<std::vector<Share>> all;
        for (const Body& body : cuts.scene)
            all.push_back(shares(body, cut(body, size, Cut::random, random), size, random));
        run(
            [&](const vox_transport& transport, Reports& reports) {
                Ranked mine(&transport);
                for (std::size_t b = 0; b < cuts.scene.size(); ++b)
                    reports.expect(mine.insert(cuts.scene[b], all[b][transport.rank]), VOX_OK, "insert");
                expect_hash(cuts, mine, reports);
            },
            size);
    }
}
END_TEST

int main() {
    Suite* suite = suite_create("dist_faults");
    TCase* tests = tcase_create("faults");
    tcase_set_timeout(tests, 0);
    tcase_add_test(tests, check_names_what_does_not_fit);
    tcase_add_test(tests, arguments);
    tcase_add_test(tests, another_number_of_ranks);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
