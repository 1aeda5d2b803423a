// Replays bindings/vectors through vox.hpp: the same results as in every other language.
#include <vox/vox_cell_size.hpp>
#include <vox/vox_query.hpp>

#include <algorithm>
#include <cinttypes>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "support/suite.h" // last: Check has a macro called fail

namespace {

using nlohmann::json;
using vox::span;

std::string digits_of(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

// As bindings/vectors/README.md has it; the last word is filled with zeros.
std::string hash_words(const void* data, std::size_t size) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (std::size_t i = 0; i < size; i += 4) {
        std::uint32_t word = 0;
        std::memcpy(&word, static_cast<const char*>(data) + i, std::min<std::size_t>(4, size - i));
        hash = (hash ^ (word == 0x80000000u ? 0 : word)) * 0x100000001b3u;
    }
    return digits_of(hash);
}

// [how many, the hash of their words], of a vector or span.
template <class R>
json summary(const R& items) {
    std::vector<std::decay_t<decltype(*items.begin())>> copies(items.begin(), items.end());
    return {copies.size(), hash_words(copies.data(), copies.size() * sizeof copies[0])};
}

std::uint64_t bits(const json& text) { return std::stoull(text.get<std::string>()); }

vox_filter filter_of(const json& fields) {
    vox_filter filter{};
    filter.group = fields["group"];
    filter.category = bits(fields["category"]);
    filter.mask = bits(fields["mask"]);
    filter.flags = fields["flags"];
    filter.world = fields["world"];
    filter.self_rings = fields["self_rings"];
    filter.self_rest_distance = fields["self_rest_distance"];
    return filter;
}

class replay {
public:
    explicit replay(std::string arrays) : arrays_(std::move(arrays)) {}

    // Makes a call, and compares what it gives.
    void run(const json& call, const std::string& scene) {
        place_ = scene + ": " + call.dump();
        std::string text = "nothing";
        int code = VOX_OK;
        try {
            make(call);
        } catch (const vox::error& error) {
            code = error.result();
            text = error.what();
        }
        ck_assert_msg(code == call.value("fails", int{VOX_OK}) && text == call.value("text", "nothing"),
                      "%d, %s: %s", code, text.c_str(), place_.c_str());
    }

private:
    std::string arrays_;
    vox::grid grid_;
    vox::locator locator_;
    std::string place_;

    void check(const json& call, const char* name, const json& found) const {
        ck_assert_msg(call.at(name) == found, "%s is %s: %s", name, found.dump().c_str(), place_.c_str());
    }

    template <class T>
    std::vector<T> array(const json& offset, const json& count) const {
        std::vector<T> items(count.get<std::size_t>());
        std::memcpy(items.data(), arrays_.data() + offset.get<std::size_t>(), items.size() * sizeof(T));
        return items;
    }
    using corners = std::array<std::uint32_t, 4>;
    std::vector<std::uint32_t> indices(const json& call, const char* name) const {
        return array<std::uint32_t>(call[name], call["count"]);
    }

    std::vector<std::array<double, 3>> points(const json& call, const char* name) const {
        return array<std::array<double, 3>>(call[name], call["count"]);
    }

    template <class T>
    void insert(const json& call) {
        const auto positions = array<std::array<T, 3>>(call["positions"], call["vertices"]);
        const auto tets = array<corners>(call["tets"], call["tet_count"]);
        vox_mesh_desc desc = vox::describe(positions, tets);
        desc.flags |= VOX_MESH_COPY_POSITIONS;
        desc.user_data = bits(call["user_data"]);
        if (call.contains("filter")) desc.filter = filter_of(call["filter"]);
        check(call, "mesh", grid_.insert(desc));
    }

    template <class T>
    void move(const json& call) {
        const auto positions = array<std::array<T, 3>>(call["positions"], call["vertices"]);
        const auto mapped = grid_.map_positions<T>(call["mesh"]);
        ck_assert_uint_eq(mapped.size(), positions.size());
        std::copy(positions.begin(), positions.end(), mapped.begin());
    }

    void make(const json& call) {
        const std::string name = call["call"];
        const vox_body mesh = call.value("mesh", vox_body{VOX_NULL_BODY});
        if (name == "create") {
            vox_grid_desc desc = vox_default_grid_desc();
            desc.flags = call["flags"];
            desc.cell_size = call["cell_size"];
            grid_ = vox::grid(desc);
        } else if (name == "insert") {
            call["format"] == 1 ? insert<double>(call) : insert<float>(call);
        } else if (name == "move") {
            call["format"] == 1 ? move<double>(call) : move<float>(call);
        } else if (name == "step") {
            grid_.step();
        } else if (name == "results") {
            results(call);
        } else if (name == "find_constraints") {
            vox_constraint_desc desc = vox_default_constraint_desc();
            desc.method = call["method"];
            grid_.find_constraints(desc);
            constraints(call);
        } else if (name == "update_locator") {
            locator_.update(grid_);
        } else if (name == "find_point_hits") {
            check(call, "hits", summary(locator_.find_point_hits(points(call, "points"))));
        } else if (name == "find_closest") {
            check(call, "hits", summary(locator_.find_closest(points(call, "points"))));
        } else if (name == "find_box_hits") {
            check(call, "hits", summary(locator_.find_box_hits(points(call, "min"), points(call, "max"))));
        } else if (name == "find_ray_hits") {
            vox_query_desc desc = vox_default_query_desc();
            desc.flags = call["flags"];
            check(call, "hits",
                  summary(locator_.find_ray_hits(points(call, "from"), points(call, "to"), desc)));
        } else if (name == "test_rays") {
            const auto blocked = locator_.test_rays(points(call, "from"), points(call, "to"));
            check(call, "blocked", std::accumulate(blocked.begin(), blocked.end(), 0));
        } else if (name == "meshes") {
            meshes(call);
        } else if (name == "set_transform") {
            grid_.set_transform(mesh, array<std::array<double, 12>>(call["matrix"], 1)[0]);
        } else if (name == "set_filter") {
            grid_.set_filter(mesh, filter_of(call["filter"]));
        } else if (name == "set_enabled") {
            grid_.set_enabled(mesh, call["enabled"] == 1);
        } else if (name == "set_pair_enabled") {
            grid_.set_pair_enabled(call["body_a"], call["body_b"], call["enabled"] == 1);
        } else if (name == "set_flags") {
            grid_.set_flags(call["flags"]);
        } else if (name == "remove") {
            grid_.remove(mesh);
        } else if (name == "clear") {
            grid_.clear();
        } else if (name == "set_tets_enabled") {
            grid_.set_tets_enabled(mesh, indices(call, "indices"), call["enabled"] == 1);
        } else if (name == "remove_tets") {
            grid_.remove_tets(mesh, indices(call, "indices"));
        } else if (name == "append_copies") {
            const auto copies_of = indices(call, "copies_of");
            vox_vertices_desc desc = vox_default_vertices_desc();
            desc.count = copies_of.size();
            desc.copies_of = copies_of.data();
            check(call, "first", grid_.append_vertices(mesh, desc));
        } else if (name == "replace_tets") {
            grid_.replace_tets(mesh, indices(call, "indices"),
                               array<corners>(call["corners"], call["count"]));
        } else if (name == "append_tets") {
            check(call, "first", grid_.append_tets(mesh, array<corners>(call["corners"], call["count"])));
        } else if (name == "save") {
            const std::vector<std::byte> bytes = grid_.save();
            check(call, "size", bytes.size());
            check(call, "hash", hash_words(bytes.data(), bytes.size()));
        } else if (name == "load") {
            grid_ = vox::grid::load(array<std::byte>(call["bytes"], call["size"]));
        } else if (name == "suggest") {
            suggest(call);
        } else if (name.starts_with("foreign_")) {
            foreign(name, call);
        } else {
            ck_abort_msg("a call that is not known: %s", place_.c_str());
        }
    }

    void constraints(const json& call) const {
        std::vector<std::uint64_t> offsets = {0};
        for (const vox_pair& pair : grid_.pairs())
            offsets.push_back(offsets.back() + grid_.constraints_of(pair).size());
        check(call, "constraints", summary(grid_.constraints()));
        check(call, "pair_offsets", summary(offsets));
    }

    void results(const json& call) const {
        check(call, "hash", digits_of(grid_.hash()));
        check(call, "epoch", grid_.info().epoch);
        check(call, "contacts", summary(grid_.contacts()));
        std::uint64_t interior = 0;
        for (std::uint8_t inside : grid_.interiors()) interior += inside;
        check(call, "interior", interior);
        std::vector<std::uint32_t> pair_contacts;
        for (const vox_pair& pair : grid_.pairs())
            for (std::uint32_t contact : grid_.contacts_of(pair)) pair_contacts.push_back(contact);
        check(call, "pairs", summary(grid_.pairs()));
        check(call, "pair_contacts", summary(pair_contacts));
        if (call.contains("constraints")) return constraints(call);
        try { // without the flag there are none
            (void)grid_.constraints();
            ck_abort_msg("constraints: %s", place_.c_str());
        } catch (const vox::error& error) {
            ck_assert_int_eq(error.result(), VOX_ERROR_INVALID_STATE);
        }
    }

    void meshes(const json& call) const {
        json found = json::array();
        for (vox_body mesh : grid_.meshes()) {
            const vox_body_info info = grid_.info(mesh);
            const auto tets = grid_.tets_of(mesh);
            found.push_back({{"mesh", mesh},
                             {"user_data", std::to_string(grid_.user_data(mesh))},
                             {"vertices", info.positions.count},
                             {"tet_count", info.tet_count},
                             {"enabled_tets", info.enabled_tet_count},
                             {"enabled", info.enabled},
                             {"flags", info.flags},
                             {"format", info.positions.format},
                             {"tets", hash_words(tets.data(), tets.size() * sizeof(corners))}});
        }
        check(call, "meshes", found);
    }

    void suggest(const json& call) const {
        std::vector<std::vector<std::array<float, 3>>> positions;
        std::vector<std::vector<corners>> tets;
        for (const json& mesh : call["meshes"]) {
            positions.push_back(array<std::array<float, 3>>(mesh["positions"], mesh["vertices"]));
            tets.push_back(array<corners>(mesh["tets"], mesh["tet_count"]));
        }
        std::vector<vox_mesh_desc> meshes;
        for (std::size_t i = 0; i < tets.size(); ++i) meshes.push_back(vox::describe(positions[i], tets[i]));
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        desc.model = call["model"];
        check_result(call, vox::suggest_cell_size(meshes, desc));
    }

    void check_result(const json& call, const vox_cell_size_result& found) const {
        check(call, "warnings", found.warnings);
        check(call, "note", found.note);
        check(call, "curve_count", vox::curve(found).size());
        check(call, "term_count", vox::terms(found).size());
        check_near(call["cell_size"], "cell_size", found.cell_size);
        check_near(call["zone_min"], "zone_min", found.zone_min);
        check_near(call["zone_max"], "zone_max", found.zone_max);
        check_near(call["cost"], "cost", found.cost);
        check_near(call["result_min_cell_size"], "min_cell_size", found.min_cell_size);
        check_sizes(call["rules"], "rules", vox::rules(found));
        check_sizes(call["runs"], "runs", vox::timings(found));
    }
    template <class T>
    void check_sizes(const json& expected, const char* name, vox::span<const T> found) const {
        ck_assert_uint_eq(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) check_near(expected[i], name, found[i].cell_size);
    }

    void check_near(const json& expected, const char* name, double value) const {
        ck_assert_msg(std::abs(value - expected.get<double>()) <= 1e-6 * std::abs(value), "%s is %.9g: %s",
                      name, value, place_.c_str());
    }

    // Primitives, and the arrays that they are of.
    struct primitives {
        std::vector<std::array<float, 3>> singles;
        std::vector<std::array<double, 3>> doubles;
        std::vector<std::uint32_t> indices;
        std::vector<double> radii;
        vox_primitives of;
    };

    void read(const json& given, primitives& to) const {
        const vox_primitive_type type = given["type"];
        const bool doubles = given["format"] == 1;
        const json &at = given["positions"], &count = given["vertices"];
        if (doubles)
            to.doubles = array<std::array<double, 3>>(at, count);
        else
            to.singles = array<std::array<float, 3>>(at, count);
        if (given.contains("indices")) {
            to.indices = array<std::uint32_t>(given["indices"], given["count"]);
            to.of = doubles ? vox::primitives(type, to.doubles, to.indices)
                            : vox::primitives(type, to.singles, to.indices);
        } else {
            to.of = doubles ? vox::primitives(type, to.doubles) : vox::primitives(type, to.singles);
        }
        if (given.contains("radii")) {
            to.radii = array<double>(given["radii"], to.of.count);
            to.of.radii = to.radii.data();
            to.of.radius_format = VOX_FORMAT_DOUBLE;
        }
        to.of.radius = given["radius"];
    }

    void foreign(const std::string& name, const json& call) const {
        primitives stored, querying;
        vox_foreign_grid grid = vox_default_foreign_grid();
        const bool described = call.contains("stored");
        if (described) {
            read(call["stored"], stored);
            grid = vox::foreign_grid(stored.of, call["known"]);
            if (call.contains("querying")) {
                read(call["querying"], querying);
                grid.querying = &querying.of;
            }
            grid.cells_stored = call["cells_stored"];
            grid.cells_queried = call["cells_queried"];
            grid.cells_kept = call["cells_kept"];
            const std::array<double, 7> w = call["weights"];
            grid.weights = {w[0], w[1], w[2], w[3], w[4], w[5], w[6]};
            grid.radius = call["radius"];
            grid.min_cell_size = call["min_cell_size"];
            grid.zone_loss = call["zone_loss"];
        }
        if (name == "foreign_suggest") {
            check_result(call, vox::foreign_grid_suggest(grid));
        } else if (name == "foreign_count") {
            const vox_foreign_counts c = vox::foreign_grid_count(grid, call["at"]);
            const double counts[] = {c.stored, c.visits, c.empty, c.reads, c.occupied, c.cells};
            for (std::size_t i = 0; i < std::size(counts); ++i)
                check_near(call["counts"][i], "counts", counts[i]);
        } else if (name == "foreign_fit") {
            std::vector<vox_timing> timings;
            for (const json& timing : call["timings"]) timings.push_back({timing[0], timing[1]});
            check_result(call, vox::foreign_grid_fit(grid, timings));
        } else if (name == "foreign_tune") {
            vox_tune_desc desc = vox_default_tune_desc();
            desc.first = call["first"];
            desc.max_runs = call["max_runs"];
            const std::array<double, 3> seconds = call["run"];
            const double fails_below = call["fails_below"];
            int left = call["stops_after"] == 0 ? -1 : call["stops_after"].get<int>();
            const auto run = [&](double d) {
                if (left-- == 0) return -1.0;
                return d < fails_below ? std::numeric_limits<double>::infinity()
                                       : seconds[0] + seconds[1] / (d * d) + seconds[2] * (d * d);
            };
            check_result(call, vox::foreign_grid_tune(described ? &grid : nullptr, run, desc));
        } else {
            ck_abort_msg("a call that is not known: %s", place_.c_str());
        }
    }
};

std::string contents_of(const std::string& name) {
    std::ifstream file(VECTORS "/" + name, std::ios::binary);
    ck_assert_msg(file.is_open(), "there is no %s", name.c_str());
    return {std::istreambuf_iterator<char>(file), {}};
}

START_TEST(the_same_as_in_every_language) {
    const json script = json::parse(contents_of("vectors.json"));
    ck_assert_uint_eq(script["abi"].get<std::uint32_t>(), vox::abi_version());
    replay all(contents_of("vectors.bin"));
    int calls = 0;
    for (const json& scene : script["scenes"])
        for (const json& call : scene["calls"]) {
            if (call.value("enabled", 0) > 1) continue; // a bool is no such number
            all.run(call, scene["name"]);
            ++calls;
        }
    ck_assert_int_gt(calls, 300);
}
END_TEST

} // namespace

SUITE(hpp_vectors) { tcase_add_each(add_case(suite, "all"), the_same_as_in_every_language); }
