// Contacts of scenes that are cut among ranks: those of one grid, whatever the partition.
#include "dist/packed_box.hpp"
#include "dist/ranks.hpp"
#include "dist/whole.hpp"

#include "support/locators.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <span>
#include <string_view>

using namespace scenes;

namespace {

// One of the counters of a scene's last step.
std::uint64_t counter(const vox_dist_scene* scene, std::string_view name) {
    vox_counter_view view{};
    (void)vox_dist_scene_get_counters(scene, &view);
    for (const vox_counter& c : std::span(view.data, view.count))
        if (c.name == name) return c.value;
    return ~std::uint64_t{0};
}

constexpr std::uint32_t sizes[] = {1, 2, 3, 5, 8, 13, 64};

struct Run {
    const Scene* scene;
    std::vector<std::vector<Share>> shares; // of each body, of each rank
    std::uint64_t expected[2];
    std::vector<vox_dist_contact> expected_contacts;
    std::mutex mutex;
    std::vector<vox_dist_contact> contacts, of_tets; // the two sides, of all ranks
    const vox_locator* locator = nullptr;            // of the whole
    bool whole_bodies = false;                       // no body has tetrahedra on two ranks
    std::string fault;
};

void note(Run& run, const std::string& text) {
    const std::lock_guard lock(run.mutex);
    if (run.fault.empty()) run.fault = text;
}

void add(std::vector<vox_dist_contact>& all, const vox_dist_contact_view& view) {
    all.insert(all.end(), view.data, view.data + view.count);
}

const Share& share_of(const Run& run, std::uint64_t body, std::uint32_t rank) {
    std::size_t b = 0;
    while ((*run.scene)[b].number != body) ++b;
    return run.shares[b][rank];
}

bool owns(const Share& share, std::uint64_t vertex) {
    for (std::size_t i = 0; i < share.vertex_ids.size(); ++i)
        if (share.vertex_ids[i] == vertex) return share.owned[i] != 0;
    return false;
}

// `index` is of the side that lies here, and `rank` is where the other side lies.
void check_places(Run& run, std::uint32_t rank, const vox_dist_contact_view& contacts,
                  const vox_dist_contact_view& of_tets) {
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_dist_contact& c = contacts.data[i];
        const Share& here = share_of(run, c.body_a, rank);
        const auto& tets_there = share_of(run, c.body_b, c.rank).tet_ids;
        if (here.vertex_ids.at(c.index) != c.vertex || !here.owned[c.index])
            return note(run, "a contact of a vertex that is not owned here: " + text_of(c));
        if (std::find(tets_there.begin(), tets_there.end(), c.tet) == tets_there.end())
            return note(run, "the tetrahedron is not on that rank: " + text_of(c));
    }
    for (std::uint64_t i = 0; i < of_tets.count; ++i) {
        const vox_dist_contact& c = of_tets.data[i];
        if (share_of(run, c.body_b, rank).tet_ids.at(c.index) != c.tet)
            return note(run, "a contact with a tetrahedron that is not here: " + text_of(c));
        if (!owns(share_of(run, c.body_a, c.rank), c.vertex))
            return note(run, "that rank does not own the vertex: " + text_of(c));
    }
}

// Items of 8 bytes there and back: each arrives at the contact it belongs to.
void check_send(Run& run, vox_dist_scene* scene, const vox_dist_contact_view& contacts,
                const vox_dist_contact_view& of_tets) {
    const auto value = [](const vox_dist_contact& c) {
        return c.body_a * 31 + c.vertex * 1009 + c.body_b * 7919 + c.tet;
    };
    std::vector<std::uint64_t> there(of_tets.count), back(contacts.count), out;
    for (std::uint64_t i = 0; i < contacts.count; ++i) out.push_back(value(contacts.data[i]));
    if (vox_dist_scene_send(scene, VOX_DIST_VERTICES, 8, out.data(), there.data()) != VOX_OK)
        return note(run, vox_last_error());
    for (std::uint64_t i = 0; i < of_tets.count; ++i)
        if (there[i] != value(of_tets.data[i])) return note(run, "an item went to another tetrahedron");
    for (std::uint64_t& item : there) item = ~item;
    if (vox_dist_scene_send(scene, VOX_DIST_TETS, 8, there.data(), back.data()) != VOX_OK)
        return note(run, vox_last_error());
    for (std::uint64_t i = 0; i < contacts.count; ++i)
        if (back[i] != ~out[i]) return note(run, "an item went back to another vertex");
}

// Points on multiples of 1/4, inside and outside, and some on none: what one locator says, bit for bit.
void check_locate(Run& run, const vox_locator* locator, vox_dist_scene* scene, std::uint32_t rank) {
    constexpr std::uint32_t count = 40;
    Random random(rank);
    std::vector<double> points;
    for (std::uint32_t i = 0; i < 3 * count; ++i)
        points.push_back(below(random, 41) / 4.0 - 2.5 + (i < 60 ? 0 : below(random, 1000) / 9973.0));
    vox_dist_location found[count];
    vox_location expected[count];
    const vox_positions asked = vox_double_positions(points.data(), count);
    if (vox_dist_scene_locate(scene, &asked, found) != VOX_OK) return note(run, vox_last_error());
    if (vox_locator_locate(locator, &asked, nullptr, expected) != VOX_OK) return note(run, vox_last_error());
    for (std::uint32_t i = 0; i < count; ++i) {
        const vox_location& one = expected[i];
        std::uint64_t body = 0;
        if (one.body != VOX_NULL_BODY) (void)vox_locator_get_user_data(locator, one.body, &body);
        if (found[i].state != one.state || found[i].body != body || found[i].tet != one.tet ||
            std::memcmp(found[i].weights, one.weights, sizeof one.weights) != 0 ||
            std::memcmp(&found[i].distance, &one.distance, sizeof one.distance) != 0)
            return note(run, "point " + std::to_string(i) + ": state " + std::to_string(found[i].state) +
                                 ", body " + std::to_string(found[i].body) + ", tet " +
                                 std::to_string(found[i].tet) + "; one locator has " +
                                 std::to_string(one.state) + ", " + std::to_string(body) + ", " +
                                 std::to_string(one.tet));
        const bool none = one.state == VOX_LOCATION_NONE;
        if (none != (found[i].rank == VOX_NONE)) return note(run, "the rank of a point in no body");
        if (none) continue;
        const auto& there = share_of(run, body, found[i].rank).tet_ids;
        if (std::find(there.begin(), there.end(), one.tet) == there.end())
            return note(run, "the tetrahedron of a point is not on that rank");
    }
}

void rank(const vox_dist_transport* transport, Run& run) {
    Ranked mine(transport);
    if (mine.result != VOX_OK) return note(run, vox_last_error());
    for (std::size_t b = 0; b < run.scene->size(); ++b)
        if (mine.insert((*run.scene)[b], run.shares[b][transport->rank]) != VOX_OK)
            note(run, vox_last_error());
    for (int step = 0; step < 2; ++step) {
        if (vox_dist_scene_step(mine.scene) != VOX_OK) return note(run, vox_last_error());
        std::uint64_t hash[2];
        if (vox_dist_scene_get_hash(mine.scene, hash) != VOX_OK) return note(run, vox_last_error());
        if (hash[0] != run.expected[0] || hash[1] != run.expected[1]) note(run, "another hash");
    }
    vox_dist_contact_view contacts, of_tets;
    (void)vox_dist_scene_get_contacts(mine.scene, VOX_DIST_VERTICES, &contacts);
    (void)vox_dist_scene_get_contacts(mine.scene, VOX_DIST_TETS, &of_tets);
    const std::uint64_t messages = counter(mine.scene, "messages"),
                        neighbours = counter(mine.scene, "neighbours");
    if (messages > (run.whole_bodies ? 3u : 4u) * neighbours)
        note(run, std::to_string(messages) + " messages for " + std::to_string(neighbours) + " neighbours");
    if (counter(mine.scene, "collectives") != 2) note(run, "not two collectives");
    check_places(run, transport->rank, contacts, of_tets);
    check_send(run, mine.scene, contacts, of_tets);
    check_locate(run, run.locator, mine.scene, transport->rank);
    if (vox_dist_scene_check(mine.scene) != VOX_OK) note(run, vox_last_error());
    std::uint64_t parts = 0;
    if (vox_dist_scene_get_costs(mine.scene, nullptr, 0, &parts) != VOX_OK) note(run, vox_last_error());
    const std::lock_guard lock(run.mutex);
    add(run.contacts, contacts);
    add(run.of_tets, of_tets);
}

// Returns what differs, or "".
std::string differs(const Scene& scene, std::uint32_t size, Cut how, std::uint64_t seed,
                    std::uint32_t parallel) {
    std::vector<std::vector<float>> floats;
    vox_grid* grid = whole(scene, floats);
    if (!grid || vox_grid_step(grid) != VOX_OK) return vox_last_error();
    Run run;
    run.scene = &scene;
    run.expected_contacts = global_contacts(scene, grid);
    hash_of(run.expected_contacts, run.expected);
    vox_locator* locator = take_locator(grid);
    run.locator = locator;
    run.whole_bodies = how == Cut::one;
    Random random(seed);
    for (const Body& body : scene)
        run.shares.push_back(shares(body, cut(body, size, how, random), size, random));
    run_ranks(size, parallel, [&](const vox_dist_transport* transport) { rank(transport, run); });
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    if (!run.fault.empty()) return run.fault;
    for (auto* side : {&run.contacts, &run.of_tets}) {
        if (side->size() != run.expected_contacts.size()) return "another number of contacts";
        std::sort(side->begin(), side->end(), before);
        for (std::size_t i = 0; i < side->size(); ++i)
            if (!same((*side)[i], run.expected_contacts[i]))
                return std::string(side == &run.contacts ? "vertices" : "tets") + ": " + text_of((*side)[i]) +
                       ", in one grid " + text_of(run.expected_contacts[i]);
    }
    return "";
}

// Bodies that move, some of them in some steps alone; one leaves, and comes back.
constexpr std::uint32_t frames = 6;

double offset(std::size_t body, std::uint32_t frame, int axis) {
    return static_cast<int>(body % 3) == axis ? static_cast<double>(frame * (body + 1) / 2 % 4) / 2 : 0;
}
bool present(std::size_t body, std::uint32_t frame) { return body != 0 || (frame != 2 && frame != 3); }

struct Moving {
    Run run;
    std::vector<vox_locator*> locators; // of the whole, in each frame
    std::vector<std::array<std::uint64_t, 2>> expected;
};

void moving_rank(const vox_dist_transport* transport, Moving& moving) {
    Run& run = moving.run;
    const Scene& scene = *run.scene;
    Ranked mine(transport);
    if (mine.result != VOX_OK) return note(run, vox_last_error());
    std::vector<Share> shares, still;
    for (std::size_t b = 0; b < scene.size(); ++b) still.push_back(run.shares[b][transport->rank]);
    shares = still;
    for (std::uint32_t frame = 0; frame < moving.locators.size(); ++frame) {
        for (std::size_t b = 0; b < scene.size(); ++b) {
            for (std::size_t i = 0; i < still[b].xyz.size(); ++i) {
                shares[b].xyz[i] = still[b].xyz[i] + offset(b, frame, static_cast<int>(i % 3));
                shares[b].floats[i] = static_cast<float>(shares[b].xyz[i]);
            }
            const bool was = frame != 0 && present(b, frame - 1);
            if (present(b, frame) && !was && mine.insert(scene[b], shares[b]) != VOX_OK)
                note(run, vox_last_error());
            if (!present(b, frame) && was && mine.remove(scene[b]) != VOX_OK) note(run, vox_last_error());
        }
        std::uint64_t hash[2] = {};
        if (vox_dist_scene_step(mine.scene) != VOX_OK || vox_dist_scene_get_hash(mine.scene, hash) != VOX_OK)
            return note(run, vox_last_error());
        if (hash[0] != moving.expected[frame][0] || hash[1] != moving.expected[frame][1])
            note(run, "another hash in frame " + std::to_string(frame));
        check_locate(run, moving.locators[frame], mine.scene, transport->rank);
    }
}

std::string differs_in_motion(const Scene& scene, std::uint32_t size, Cut how, std::uint64_t seed) {
    Moving moving;
    moving.run.scene = &scene;
    std::vector<Scene> moved(frames, scene);
    std::vector<std::vector<std::vector<float>>> floats(frames);
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        for (std::size_t b = scene.size(); b-- > 0;) {
            Body& body = moved[frame][b];
            for (std::size_t i = 0; i < body.xyz.size(); ++i)
                body.xyz[i] += offset(b, frame, static_cast<int>(i % 3));
            if (!present(b, frame)) moved[frame].erase(moved[frame].begin() + static_cast<std::ptrdiff_t>(b));
        }
        vox_grid* grid = whole(moved[frame], floats[frame]);
        moving.expected.emplace_back();
        if (!grid || vox_grid_step(grid) != VOX_OK) return vox_last_error();
        moving.locators.push_back(take_locator(grid));
        hash_of(global_contacts(moved[frame], grid), moving.expected.back().data());
        vox_grid_destroy(grid);
    }
    Random random(seed);
    for (const Body& body : scene)
        moving.run.shares.push_back(shares(body, cut(body, size, how, random), size, random));
    run_ranks(size, 2, [&](const vox_dist_transport* transport) { moving_rank(transport, moving); });
    for (vox_locator* locator : moving.locators) vox_locator_release(locator);
    return moving.run.fault;
}

// A restart: ranks save grids of their parts, and what was saved goes on with other ranks and another
// partition. Global numbers are the caller's to keep.
using Snapshot = std::vector<std::byte>;

Snapshot saved(const Scene& scene, std::vector<std::vector<Share>>& all, std::uint32_t rank) {
    vox_grid* grid = nullptr;
    ck_assert_int_eq(vox_grid_create(nullptr, &grid), VOX_OK);
    for (std::size_t b = 0; b < scene.size(); ++b) {
        Share& share = all[b][rank];
        vox_mesh_desc mesh = scene[b].doubles
                                 ? vox_mesh_desc_doubles(share.xyz.data(), share.vertex_ids.size(),
                                                         share.tets.data(), share.tet_ids.size())
                                 : vox_mesh_desc_floats(share.floats.data(), share.vertex_ids.size(),
                                                        share.tets.data(), share.tet_ids.size());
        mesh.user_data = b;
        mesh.filter = scene[b].filter;
        vox_body id;
        ck_assert_int_eq(vox_mesh_insert(grid, &mesh, &id), VOX_OK);
    }
    std::uint64_t size = 0;
    ck_assert_int_eq(vox_grid_save(grid, nullptr, 0, &size), VOX_OK);
    Snapshot bytes(size);
    ck_assert_int_eq(vox_grid_save(grid, bytes.data(), size, &size), VOX_OK);
    vox_grid_destroy(grid);
    return bytes;
}

double number_at(const vox_body_info& info, std::uint64_t vertex, unsigned axis) {
    const auto* at = static_cast<const std::byte*>(info.positions.data) +
                     vertex * info.positions.byte_stride + axis * info.positions.component_byte_stride;
    double number = 0;
    float single = 0;
    if (info.positions.format == VOX_FORMAT_DOUBLE)
        std::memcpy(&number, at, sizeof number);
    else
        std::memcpy(&single, at, sizeof single);
    return info.positions.format == VOX_FORMAT_DOUBLE ? number : static_cast<double>(single);
}

// Puts what one rank saved into the whole bodies, which have room and no values.
void restore(const Snapshot& bytes, const std::vector<std::vector<Share>>& all, std::uint32_t rank,
             Scene& scene) {
    vox_grid* grid = nullptr;
    ck_assert_int_eq(vox_grid_load(bytes.data(), bytes.size(), nullptr, &grid), VOX_OK);
    std::vector<vox_body> meshes(scene.size());
    std::uint64_t count = 0;
    ck_assert_int_eq(vox_grid_get_bodies(grid, meshes.data(), meshes.size(), &count), VOX_OK);
    ck_assert_uint_eq(count, scene.size());
    for (const vox_body mesh : meshes) {
        vox_body_info info{};
        info.struct_size = sizeof info;
        ck_assert_int_eq(vox_body_get_info(grid, mesh, &info), VOX_OK);
        Body& body = scene[info.user_data];
        body.filter = info.filter;
        const Share& share = all[info.user_data][rank];
        ck_assert_uint_eq(info.positions.count, share.vertex_ids.size());
        for (std::uint64_t v = 0; v < info.positions.count; ++v)
            for (unsigned axis = 0; axis < 3; ++axis)
                body.xyz[3 * share.vertex_ids[v] + axis] = number_at(info, v, axis);
        std::vector<std::uint32_t> corners(4 * info.tet_count);
        ck_assert_int_eq(vox_mesh_get_tets(grid, mesh, corners.data(), nullptr, info.tet_count, &count),
                         VOX_OK);
        ck_assert_uint_eq(count, share.tet_ids.size());
        for (std::uint64_t t = 0; t < count; ++t)
            for (unsigned c = 0; c < 4; ++c)
                body.tets[4 * share.tet_ids[t] + c] =
                    static_cast<std::uint32_t>(share.vertex_ids[corners[4 * t + c]]);
    }
    vox_grid_destroy(grid);
}

std::string differs_after_restart(const Scene& scene, std::uint32_t before, std::uint32_t after, Cut how,
                                  std::uint64_t seed) {
    Random random(seed);
    std::vector<std::vector<Share>> all;
    for (const Body& body : scene)
        all.push_back(shares(body, cut(body, before, how, random), before, random));
    Scene restored = scene;
    for (Body& body : restored) {
        std::fill(body.xyz.begin(), body.xyz.end(), -1000);
        std::fill(body.tets.begin(), body.tets.end(), 0);
        body.filter = vox_filter{};
    }
    for (std::uint32_t rank = 0; rank < before; ++rank) restore(saved(scene, all, rank), all, rank, restored);

    std::vector<std::vector<float>> floats;
    vox_grid* grid = whole(scene, floats); // as it was before the restart
    if (!grid || vox_grid_step(grid) != VOX_OK) return vox_last_error();
    Moving moving;
    moving.run.scene = &restored;
    moving.locators.assign(1, take_locator(grid));
    moving.expected.emplace_back();
    hash_of(global_contacts(scene, grid), moving.expected[0].data());
    vox_grid_destroy(grid);
    for (const Body& body : restored)
        moving.run.shares.push_back(shares(body, cut(body, after, Cut::rcb, random), after, random));
    run_ranks(after, 2, [&](const vox_dist_transport* transport) { moving_rank(transport, moving); });
    vox_locator_release(moving.locators[0]);
    return moving.run.fault;
}

std::uint64_t first_scene() { return number_from("VOX_DIST_FIRST", 0); }
std::uint64_t scene_count() { return volume_from("VOX_DIST_SCENES", 75); }

} // namespace

START_TEST(any_partition_has_the_contacts_of_one_grid) {
    for (std::uint64_t seed = first_scene(); seed < first_scene() + scene_count(); ++seed) {
        const Scene scene = lattice(seed);
        const std::uint32_t size = sizes[seed % std::size(sizes)];
        const auto how = static_cast<Cut>(seed / std::size(sizes) % static_cast<int>(Cut::count));
        const std::string difference = differs(scene, size, how, seed, seed % 3 == 0 ? 1 : 2);
        ck_assert_msg(difference.empty(), "scene %llu, %u ranks, partition %d: %s",
                      static_cast<unsigned long long>(seed), size, static_cast<int>(how), difference.c_str());
    }
}
END_TEST

START_TEST(moving_bodies_have_the_contacts_of_one_grid) {
    for (std::uint64_t seed = first_scene(); seed < first_scene() + scene_count() / 2; ++seed) {
        const Scene scene = lattice(seed);
        const std::uint32_t size = sizes[seed % std::size(sizes)];
        const auto how = static_cast<Cut>(seed / std::size(sizes) % static_cast<int>(Cut::count));
        const std::string difference = differs_in_motion(scene, size, how, seed);
        ck_assert_msg(difference.empty(), "scene %llu, %u ranks, partition %d: %s",
                      static_cast<unsigned long long>(seed), size, static_cast<int>(how), difference.c_str());
    }
}
END_TEST

START_TEST(a_restart_from_snapshots_on_other_ranks_has_the_same_contacts) {
    for (std::uint64_t seed = first_scene(); seed < first_scene() + scene_count() / 2; ++seed) {
        const std::uint32_t before = sizes[seed % std::size(sizes)];
        const std::uint32_t after = sizes[(seed * 3 + 1) % std::size(sizes)];
        const auto how = static_cast<Cut>(seed % static_cast<int>(Cut::count));
        const std::string difference = differs_after_restart(lattice(seed), before, after, how, seed);
        ck_assert_msg(difference.empty(), "scene %llu, from %u ranks to %u, partition %d: %s",
                      static_cast<unsigned long long>(seed), before, after, static_cast<int>(how),
                      difference.c_str());
    }
}
END_TEST

// One block among four ranks, which have nothing to tell each other unless it collides with itself.
void lone_body_rank(const vox_dist_transport* transport, Run& run) {
    const Body& body = run.scene->front();
    Ranked mine(transport);
    if (mine.result != VOX_OK || mine.insert(body, run.shares[0][transport->rank]) != VOX_OK ||
        vox_dist_scene_step(mine.scene) != VOX_OK)
        return note(run, vox_last_error());
    if ((counter(mine.scene, "neighbours") != 0) != ((body.filter.flags & VOX_FILTER_SELF_COLLISION) != 0))
        note(run, "other neighbours");
}

START_TEST(ranks_of_one_body_are_neighbours_only_if_it_collides_with_itself) {
    const std::uint32_t cubes[3] = {4, 4, 4};
    const double origin[3] = {0, 0, 0};
    for (const std::uint32_t self : {0u, 1u}) {
        Scene scene = {block(cubes, origin, 1)};
        scene[0].filter.flags = self ? std::uint32_t{VOX_FILTER_SELF_COLLISION} : 0u;
        Random random(1);
        Run run;
        run.scene = &scene;
        run.shares.push_back(shares(scene[0], cut(scene[0], 4, Cut::rcb, random), 4, random));
        run_ranks(4, 2, [&](const vox_dist_transport* transport) { lone_body_rank(transport, run); });
        ck_assert_msg(run.fault.empty(), "%s", run.fault.c_str());
    }
}
END_TEST

// Frames of all sizes, flat ones too, far from the origin and near it.
START_TEST(packed_boxes_hold_the_boxes_and_stay_near_them) {
    Random random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int round = 0; round < 200000; ++round) {
        vox::Box3f frame, box;
        for (int axis = 0; axis < 3; ++axis) {
            const float size = std::ldexp(unit(random), static_cast<int>(below(random, 60)) - 30);
            const float low = std::ldexp(unit(random) - 0.5f, static_cast<int>(below(random, 60)) - 30);
            const float high = below(random, 8) ? low + size : low;
            const auto inside = [&] {
                const float part = below(random, 4) ? unit(random) : static_cast<float>(below(random, 2));
                return std::clamp(low + part * (high - low), low, high);
            };
            const float a = inside(), b = inside();
            (&frame.min.x)[axis] = low;
            (&frame.max.x)[axis] = high;
            (&box.min.x)[axis] = std::min(a, b);
            (&box.max.x)[axis] = std::max(a, b);
        }
        const vox::dist::BoxPacking packing(frame);
        const vox::Box3f back = packing.unpack(packing.pack(box));
        for (int axis = 0; axis < 3; ++axis) {
            const auto low = [axis](const vox::Box3f& of) { return double{(&of.min.x)[axis]}; };
            const auto high = [axis](const vox::Box3f& of) { return double{(&of.max.x)[axis]}; };
            const double off = (high(frame) - low(frame)) / 1000 + 1e-6 * std::fabs(low(frame));
            ck_assert(low(back) <= low(box) && high(back) >= high(box));
            ck_assert(low(back) >= low(frame) && high(back) <= high(frame));
            ck_assert_double_le(low(box) - low(back), off);
            ck_assert_double_le(high(back) - high(box), off);
        }
    }
}
END_TEST

START_TEST(a_scene_on_any_number_of_ranks) {
    for (const std::uint32_t size : {1u, 3u, 9u, 27u}) {
        const std::string difference = differs(lattice(11), size, Cut::random, size, 2);
        ck_assert_msg(difference.empty(), "%u ranks: %s", size, difference.c_str());
    }
}
END_TEST

SUITE(dist) {
    TCase* contacts = add_case(suite, "contacts");
    tcase_add_each(contacts, any_partition_has_the_contacts_of_one_grid, a_scene_on_any_number_of_ranks,
                   ranks_of_one_body_are_neighbours_only_if_it_collides_with_itself);
    TCase* motion = add_case(suite, "motion and restart");
    tcase_add_each(motion, moving_bodies_have_the_contacts_of_one_grid,
                   a_restart_from_snapshots_on_other_ranks_has_the_same_contacts);
    TCase* boxes = add_case(suite, "boxes");
    tcase_add_each(boxes, packed_boxes_hold_the_boxes_and_stay_near_them);
}
