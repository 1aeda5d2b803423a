// The kernels of src/gpu, as loops, give the contacts of tests/portability/hashes.txt.
#include "gpu/gpu_run.hpp"

#include "scenes/scenes.h"

using namespace vox::test;

namespace {

// As vox_grid_get_hash (grid/contacts.cpp) and hashes.c compute them.
void add_number(std::uint64_t& hash, std::uint64_t number) {
    hash = (hash ^ number) * 0x9fb21c651e98df25u;
    hash ^= hash >> 29;
}
std::uint64_t hash_of(const WeighedContacts& contacts) {
    std::uint64_t hash = contacts.size();
    for (const WeighedContact& c : contacts) {
        add_number(hash, c.contact.body_a | std::uint64_t{c.contact.vertex} << 32);
        add_number(hash, c.contact.body_b | std::uint64_t{c.contact.tet} << 32);
    }
    return hash;
}
std::uint64_t hash_with_interiors(const WeighedContacts& contacts) {
    std::uint64_t hash = 1;
    for (const WeighedContact& c : contacts)
        for (const std::uint32_t n :
             {c.contact.body_a, c.contact.vertex, c.contact.body_b, c.contact.tet, std::uint32_t{c.interior}})
            add_number(hash, n);
    return hash;
}

// "NAME, frame F: N contacts HASH, closest ...", or "... HASH, N inside", which has interiors.
struct KnownFrame {
    std::string name;
    bool interiors;
    unsigned long long count, hash;
    bool met = false;
};

std::vector<KnownFrame> known_frames() {
    std::vector<KnownFrame> all;
    std::FILE* file = std::fopen(VOX_HASHES, "r");
    ck_assert_msg(file, "there is no " VOX_HASHES);
    char line[400];
    while (std::fgets(line, sizeof line, file)) {
        const char* colon = std::strchr(line, ':');
        KnownFrame frame{};
        if (!colon || std::sscanf(colon, ": %llu contacts %llx", &frame.count, &frame.hash) != 2) continue;
        frame.name = std::string(line, static_cast<std::size_t>(colon - line));
        frame.interiors = std::strstr(line, ", closest ") == nullptr;
        all.push_back(frame);
    }
    std::fclose(file);
    return all;
}

struct Recipe {
    const char* name;
    void (*make)(scene*);
    double factor;
};
const Recipe recipes[] = {
    {"pair", [](scene* s) { make_pair(s, 7); }, 1},
    {"self", [](scene* s) { make_self(s, 7); }, 1},
    {"ring", [](scene* s) { make_ring(s, 12); }, 1},
    {"many", [](scene* s) { make_many(s, 3, 3); }, 1},
    {"soup", [](scene* s) { make_soup(s, 80, 200); }, 1},
    {"tiny", [](scene* s) { make_pair(s, 4); }, 1e-36},
    {"least", [](scene* s) { make_pair(s, 4); }, 1e-41},
    {"huge", [](scene* s) { make_pair(s, 4); }, 1e30},
    {"huge ring", [](scene* s) { make_ring(s, 8); }, 1e20},
    {"response to pair", [](scene* s) { make_pair(s, 7); }, 1},
    {"response to ring", [](scene* s) { make_ring(s, 12); }, 1},
    {"response to soup", [](scene* s) { make_soup(s, 40, 60); }, 1},
    {"response to least", [](scene* s) { make_pair(s, 4); }, 1e-41},
    {"response to huge", [](scene* s) { make_pair(s, 4); }, 1e30},
};

void check_frame(std::vector<KnownFrame>& known, const std::string& name, const WeighedContacts& found) {
    int lines = 0;
    for (KnownFrame& frame : known) {
        if (frame.name != name) continue;
        const std::uint64_t hash = frame.interiors ? hash_with_interiors(found) : hash_of(found);
        ck_assert_msg(found.size() == frame.count && hash == frame.hash,
                      "%s: %zu contacts %016llx, expected %llu %016llx", name.c_str(), found.size(),
                      static_cast<unsigned long long>(hash), frame.count, frame.hash);
        frame.met = true;
        ++lines;
    }
    ck_assert_msg(lines > 0, "%s is not in hashes.txt", name.c_str());
}

} // namespace

START_TEST(hashes) {
    static scene s;
    std::vector<KnownFrame> known = known_frames();
    ck_assert_uint_eq(known.size(), 104);
    for (const Recipe& recipe : recipes) {
        recipe.make(&s);
        s.name = recipe.name;
        if (recipe.factor != 1) scale_scene(&s, recipe.factor);
        pose_scene(&s, 0);
        vox_grid* grid = grid_of(nullptr);
        ck_assert(insert_scene(&s, grid));
        HostScenes scenes({grid}, orders[_i]);
        for (int frame = 0; frame < 4; ++frame) {
            pose_scene(&s, frame < 3 ? frame : 2);
            scenes.step_completely();
            check_frame(known, recipe.name + (", frame " + std::to_string(frame)), scenes.contacts(0));
        }
        vox_grid_destroy(grid);
        free_scene(&s);
    }
    // What is left has self_rings, which the kernels do not know.
    std::size_t skipped = 0;
    for (const KnownFrame& frame : known)
        if (!frame.met) {
            ck_assert_msg(frame.name.find(", filtered") != std::string::npos, "%s was not checked",
                          frame.name.c_str());
            ++skipped;
        }
    ck_assert_uint_eq(skipped, 12);
}
END_TEST

START_TEST(weights_and_interiors) {
    static scene s;
    for (const Recipe& recipe : recipes) {
        recipe.make(&s);
        if (recipe.factor != 1) scale_scene(&s, recipe.factor);
        pose_scene(&s, 1);
        vox_grid* grid = grid_of(nullptr);
        ck_assert(insert_scene(&s, grid));
        const vox::gpu::StepStatus status = check_against_grids({grid}, recipe.name);
        ck_assert_msg(status.rough_weights == 0, "%s: %u weights are rough", recipe.name,
                      status.rough_weights);
        vox_grid_destroy(grid);
        free_scene(&s);
    }
}
END_TEST

SUITE(gpu_hashes) {
    TCase* tests = add_case(suite, "contacts");
    tcase_add_loop_test(tests, hashes, 0, static_cast<int>(std::size(orders)));
    tcase_add_test(tests, weights_and_interiors);
}
