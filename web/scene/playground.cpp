#include "playground.hpp"

#include <vox/vox_io.h>
#include <vox/vox_query.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

namespace play {

void fail(vox_result result, const std::string& text) { throw Failure{vox_fail(result, text.c_str())}; }

std::span<const vox_constraint> constraints_of(const playground& play) {
    vox_constraint_view view{};
    if (vox_grid_get_constraints(play.grid, &view) != VOX_OK) return {};
    return list(view.data, view.count);
}

namespace {

constexpr double time_step = 1.0 / 60;
constexpr double still_speed = 0.04; // root mean square over all particles, for a second, before bodies sleep
constexpr double ring_radius = 3.4, ring_tube = 0.6;
constexpr double gap = 0.3; // between a body that is dropped and the highest one

void* allocate(std::size_t size, std::size_t alignment, void* user) {
    auto& account = *static_cast<Account*>(user);
    if (account.limit && size > account.limit - account.bytes) return nullptr;
    alignment = std::max(alignment, sizeof(void*));
    void* memory = std::aligned_alloc(
        alignment, std::max((size + alignment - 1) / alignment, std::size_t{1}) * alignment);
    if (memory) account.bytes += size;
    return memory;
}

void release(void* memory, std::size_t size, std::size_t, void* user) {
    static_cast<Account*>(user)->bytes -= size;
    std::free(memory);
}

struct DestroyMesh {
    void operator()(vox_io_mesh* mesh) const { vox_io_mesh_destroy(mesh); }
};
using Mesh = std::unique_ptr<vox_io_mesh, DestroyMesh>;

struct ReleaseLocator {
    void operator()(vox_locator* locator) const { vox_locator_release(locator); }
};

vox_io_mesh_view arrays_of(const Mesh& mesh) {
    vox_io_mesh_view view;
    check(vox_io_mesh_get_arrays(mesh.get(), &view));
    return view;
}

Sim make_sim(Account& account, std::uint32_t engine) {
    vox_sim_desc desc = vox_default_sim_desc();
    const vox_reference_desc reference = vox_default_reference_desc();
    vox_grid_desc grid = vox_default_grid_desc();
    if (engine == VOX_COST_MODEL_REFERENCE) grid.reference = &reference;
    desc.grid = &grid;
    desc.substeps = 5;
    desc.detect_every = desc.substeps; // once a frame, as a game would
    const vox_allocator allocator{allocate, release, &account};
    desc.allocator = &allocator;
    vox_sim* sim = nullptr;
    check(vox_sim_create(&desc, &sim));
    return Sim(sim);
}

// A rotation from four small whole numbers, so that no sine is needed, which differs from machine to machine.
struct Rotation {
    Vec rows[3];
    Vec operator*(const Vec& p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
};

Rotation rotation(std::uint32_t number) {
    std::uint32_t state = number * 2654435761u + 12345u;
    double q[4];
    for (double& part : q) {
        state = state * 1664525u + 1013904223u;
        part = static_cast<double>(static_cast<std::int32_t>(state >> 24) - 128) + 0.5;
    }
    const double s = 2 / ((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]));
    const auto [w, x, y, z] = q;
    return {{{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
             {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
             {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}}};
}

void make_ring(playground& play) {
    vox_io_mesh* made = nullptr;
    check(vox_io_make_torus(ring_radius, ring_tube, 0.45, &made));
    const Mesh mesh(made);
    const vox_io_mesh_view view = arrays_of(mesh);
    std::vector<double> positions(view.positions, view.positions + 3 * view.vertex_count);
    for (std::size_t z = 2; z < positions.size(); z += 3) positions[z] += ring_tube; // it lies on the floor
    play.bodies.push_back(insert(play, {positions, {}, {}, list(view.tets, 4 * view.tet_count), PLAY_FIXED}));
}

auto find_body(const playground& play, vox_body mesh) {
    return std::find_if(play.bodies.begin(), play.bodies.end(),
                        [mesh](const Body& body) { return body.mesh == mesh; });
}

double highest(const playground& play) {
    double z = 1;
    for (const Body& body : play.bodies)
        for (std::uint64_t v = 0; v < body.view.vertex_count; ++v)
            z = std::max(z, body.view.positions[3 * v + 2]);
    return z;
}

// Ends of the box of all vertices; infinite without any.
struct Ends {
    Vec low, high;
};

Ends ends_of(const vox_io_mesh_view& view) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Ends ends{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::uint64_t i = 0; i < 3 * view.vertex_count; ++i) {
        ends.low[i % 3] = std::min(ends.low[i % 3], view.positions[i]);
        ends.high[i % 3] = std::max(ends.high[i % 3], view.positions[i]);
    }
    return ends;
}

constexpr Rotation upright[2] = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}};

// Inserts a mesh turned, scaled to `size` along its longest side (0: as it is), above all others.
void drop(playground& play, const vox_io_mesh_view& view, std::uint32_t kind, double size,
          const Rotation& turn) {
    const auto [low, high] = ends_of(view);
    const Vec side = high - low, middle = 0.5 * (low + high);
    const double scale = size > 0 ? size / std::max({side[0], side[1], side[2]}) : 1;
    std::vector<double> positions(3 * view.vertex_count);
    double lowest = 0;
    for (std::uint32_t v = 0; v < view.vertex_count; ++v) {
        const Vec p = turn * (scale * (at(list(view.positions, 3 * view.vertex_count), v) - middle));
        for (std::size_t c = 0; c < 3; ++c) positions[3 * v + c] = p[c];
        lowest = std::min(lowest, p[2]);
    }
    // One after the other around the middle of the ring.
    ++play.dropped;
    constexpr double place[5][2] = {{0, 0}, {1.5, 0.5}, {-1.2, 1.3}, {0.3, -1.6}, {-1.5, -0.8}};
    const Vec to = {place[play.dropped % 5][0], place[play.dropped % 5][1], highest(play) + gap - lowest};
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += to[i % 3];
    try {
        play.bodies.push_back(insert(play, {positions, {}, {}, list(view.tets, 4 * view.tet_count), kind}));
    } catch (...) {
        --play.dropped;
        throw;
    }
    play.bodies_changed();
}

double cube_root(double x) { // by Newton's method: the C library's differs from machine to machine
    double root = 1;
    for (int i = 0; i < 100; ++i) root = (2 * root + x / (root * root)) / 3;
    return root;
}

// Lets the particles that are held fly to where they should be within a few steps.
void pull(playground& play) {
    if (play.held_mesh == VOX_NULL_BODY) return;
    vox_sim_body_view view;
    check(vox_sim_body_get_view(play.sim.get(), play.held_mesh, &view));
    play.velocities.assign(view.velocities, view.velocities + 3 * view.vertex_count);
    constexpr double rate = 12, fastest = 15; // per second; units per second
    for (const Held& held : play.held) {
        const Vec way =
            play.held_target + held.offset - at(list(view.positions, 3 * view.vertex_count), held.vertex);
        const double speed = rate * std::sqrt(dot(way, way));
        const Vec velocity = (speed > fastest ? rate * fastest / speed : rate) * way;
        for (std::size_t c = 0; c < 3; ++c) play.velocities[3 * held.vertex + c] = velocity[c];
    }
    check(vox_sim_body_set_state(play.sim.get(), play.held_mesh, nullptr, play.velocities.data()));
    play.was_touched();
}

// Inserts the meshes of a grid; the first is the fixed ring if it has its tetrahedra, else a ring comes
// before it.
void read_bodies(playground& play, const vox_grid* loaded, const Body& ring) {
    std::uint64_t count = 0;
    check(vox_grid_get_bodies(loaded, nullptr, 0, &count));
    std::vector<vox_body> meshes(static_cast<std::size_t>(count));
    check(vox_grid_get_bodies(loaded, meshes.data(), count, &count));
    for (const vox_body mesh : meshes) {
        vox_body_info info{};
        info.struct_size = sizeof info;
        check(vox_body_get_info(loaded, mesh, &info));
        if (info.tet_count == 0 || !info.positions.data) continue;
        constexpr double none[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        if (!std::equal(none, none + 12, info.transform))
            fail(VOX_ERROR_UNSUPPORTED,
                 "the snapshot has a mesh with a transform, which this page does not show");
        std::vector<std::uint32_t> corners(4 * static_cast<std::size_t>(info.tet_count)), tets;
        std::vector<std::uint8_t> enabled(static_cast<std::size_t>(info.tet_count));
        check(vox_mesh_get_tets(loaded, mesh, corners.data(), enabled.data(), info.tet_count, &count));
        for (std::size_t t = 0; t < enabled.size(); ++t)
            if (enabled[t]) tets.insert(tets.end(), &corners[4 * t], &corners[4 * t] + 4);
        std::vector<double> positions(3 * static_cast<std::size_t>(info.positions.count));
        const auto* data = static_cast<const unsigned char*>(info.positions.data);
        const bool floats = info.positions.format == VOX_FORMAT_FLOAT;
        const std::uint64_t number = floats ? sizeof(float) : sizeof(double);
        const std::uint64_t step =
            info.positions.component_byte_stride ? info.positions.component_byte_stride : number;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const unsigned char* place = data + i / 3 * info.positions.byte_stride + i % 3 * step;
            float single = 0;
            std::memcpy(floats ? static_cast<void*>(&single) : &positions[i], place, number);
            if (floats) positions[i] = static_cast<double>(single);
            if (!std::isfinite(positions[i])) positions[i] = 0; // a vertex that was removed
        }
        const bool fixed = play.bodies.empty() && tets == ring.tets;
        if (play.bodies.empty() && !fixed) make_ring(play);
        play.bodies.push_back(insert(play, {positions, {}, {}, tets, fixed ? PLAY_FIXED : PLAY_FILE}));
    }
    if (play.bodies.empty()) fail(VOX_ERROR_FORMAT, "the snapshot has no mesh with tetrahedra");
}

// Fills a new simulation, which gives meshes the ids of a new scene. If that fails, the old one is there.
template <class Fill>
void replace(playground& play, const Fill& fill) {
    Sim old_sim = std::exchange(play.sim, make_sim(play.account, play.engine));
    std::vector<Body> old_bodies = std::exchange(play.bodies, {});
    const Tool old_tool = std::exchange(play.tool, {});
    try {
        fill(old_bodies);
        check(vox_sim_get_grid(play.sim.get(), &play.grid));
        check(vox_grid_set_cell_size(play.grid, play.cell_size));
        if (old_tool.kind != PLAY_NO_TOOL) take_tool(play, old_tool);
    } catch (...) {
        play.bodies = std::move(old_bodies);
        play.sim = std::move(old_sim);
        play.tool = old_tool;
        throw;
    }
    play_let_go(&play);
    play.touching_parts.clear();
    play.bodies_changed();
}

// Whether there is a surface between two points, and the first that is.
bool find_first_hit(const playground& play, const double from[3], const double to[3], vox_ray_hit& hit) {
    vox_locator* taken = nullptr;
    check(vox_grid_update_locator(play.grid, &taken));
    const std::unique_ptr<vox_locator, ReleaseLocator> locator(taken);
    const vox_positions begin = vox_double_positions(from, 1), end = vox_double_positions(to, 1);
    vox_query_desc desc = vox_default_query_desc();
    desc.flags = VOX_QUERY_FIRST_HIT;
    std::uint64_t count = 0;
    check(vox_locator_find_ray_hits(taken, &begin, &end, &desc, &hit, 1, &count));
    return count > 0;
}

} // namespace

} // namespace play

using namespace play;

vox_result play_create(uint64_t byte_limit, playground** out) {
    return guard([&] {
        auto play = std::make_unique<playground>();
        play->account.limit = byte_limit;
        play->weights.struct_size = sizeof play->weights;
        check(vox_cost_calibrate(&play->weights));
        play->sim = make_sim(play->account, play->engine);
        check(vox_sim_get_grid(play->sim.get(), &play->grid));
        make_ring(*play);
        *out = play.release();
    });
}

void play_destroy(playground* play) { delete play; }

vox_result play_drop(playground* play, uint32_t kind, uint32_t tets) {
    return guard([&] {
        if (tets < 100 || tets > 200000)
            fail(VOX_ERROR_INVALID_ARGUMENT,
                 "a body of " + std::to_string(tets) + " tetrahedra; expected 100 to 200000");
        // Volumes; about 12 tetrahedra fill a cell of the lattice that bodies are cut from, a box's 5.
        constexpr double volumes[] = {2.15, 1.73, 1.42, 1.15, 0.68};
        if (kind > PLAY_BAR)
            fail(VOX_ERROR_INVALID_ARGUMENT, "there is no body of kind " + std::to_string(kind));
        const double cell = cube_root((kind == PLAY_BOX ? 5.0 : 12.0) * volumes[kind] / tets);
        vox_io_mesh* made = nullptr;
        switch (kind) {
        case PLAY_BALL:
            check(vox_io_make_ball(0.8, cell, &made));
            break;
        case PLAY_BOX:
            check(vox_io_make_box(1.2, 1.2, 1.2, cell, &made));
            break;
        case PLAY_RING:
            check(vox_io_make_torus(0.8, 0.3, cell, &made));
            break;
        case PLAY_CAPSULE:
            check(vox_io_make_capsule(0.45, 1.2, cell, &made));
            break;
        default:
            check(vox_io_make_cylinder(0.3, 2.4, cell, &made));
            break;
        }
        const Mesh mesh(made);
        drop(*play, arrays_of(mesh), kind, 0, rotation(play->dropped + 1));
    });
}

vox_result play_drop_file(playground* play, const char* name, const void* bytes, uint64_t size, uint32_t tets,
                          uint32_t y_up) {
    return guard([&] {
        const vox_io_source source = {name, bytes, static_cast<std::size_t>(size)};
        vox_io_mesh* read = nullptr;
        check(vox_io_read(&source, 1, nullptr, &read));
        Mesh mesh(read);
        vox_io_mesh_view view = arrays_of(mesh);
        std::string text;
        if (const char* warnings = vox_io_mesh_get_warnings(mesh.get())) text = warnings;
        if (view.tet_count == 0) {
            const auto [low, high] = ends_of(view);
            const Vec side = high - low;
            vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
            // As if it filled a third of its box. One that fills less gets fewer tetrahedra, but cells of a
            // hundredth of the longest side at least.
            const double longest = std::max({side[0], side[1], side[2]});
            const double box = (side[0] / longest) * (side[1] / longest) * (side[2] / longest);
            desc.cell = longest * std::clamp(cube_root(std::max(1e-9, 4 * box / tets)), 0.01, 0.25);
            vox_io_mesh* filled = nullptr;
            check(vox_io_tetrahedralize(mesh.get(), &desc, &filled));
            mesh.reset(filled);
            view = arrays_of(mesh);
            if (!text.empty()) text += '\n';
            text.append("filled with ").append(std::to_string(view.tet_count)).append(" tetrahedra");
        }
        drop(*play, view, PLAY_FILE, 2.4, upright[y_up ? 1 : 0]);
        play->text = std::move(text);
    });
}

const char* play_text(const playground* play) { return play->text.c_str(); }

vox_result play_clear(playground* play) {
    return guard([&] {
        for (std::size_t i = play->bodies.size(); i-- > 0;)
            if (play->bodies[i].kind != PLAY_FIXED) {
                remove(*play, play->bodies[i]);
                play->bodies.erase(play->bodies.begin() + static_cast<std::ptrdiff_t>(i));
            }
        play->bodies_changed();
    });
}

vox_result play_configure(playground* play, uint32_t engine, uint32_t self_collision, double stiffness) {
    return guard([&] {
        check_engine(engine);
        if (!(stiffness >= 1e3 && stiffness <= 1e8))
            fail(VOX_ERROR_INVALID_ARGUMENT,
                 "a stiffness of " + std::to_string(stiffness) + "; expected 1e3 to 1e8");
        const std::tuple old_settings(play->engine, play->self_collision, play->stiffness);
        const std::uint32_t next_serial = play->next_serial;
        play->engine = engine;
        play->self_collision = self_collision != 0;
        play->stiffness = stiffness;
        // A simulation keeps its engine, and its bodies their material and flags.
        try {
            replace(*play, [&](const std::vector<Body>& old_bodies) {
                for (const Body& body : old_bodies) {
                    play->next_serial = body.serial;
                    Body made =
                        insert(*play, {list(body.view.positions, 3 * body.view.vertex_count), body.rest,
                                       list(body.view.velocities, 3 * body.view.vertex_count), body.tets,
                                       body.kind, body.origin});
                    made.triangles = body.triangles;
                    made.uncut = body.uncut;
                    play->bodies.push_back(std::move(made));
                }
                play->next_serial = next_serial;
            });
        } catch (...) {
            play->next_serial = next_serial;
            std::tie(play->engine, play->self_collision, play->stiffness) = old_settings;
            throw;
        }
    });
}

vox_result play_set_cell_size(playground* play, double cell_size) {
    return guard([&] {
        check(vox_grid_set_cell_size(play->grid, cell_size));
        play->cell_size = cell_size;
    });
}

vox_result play_step(playground* play) {
    return guard([&] {
        if (play->asleep()) return;
        pull(*play);
        move_tool(*play);
        check(vox_sim_step(play->sim.get(), time_step));
        ++play->version;
        std::uint64_t hash = 0;
        check(vox_grid_get_hash(play->grid, &hash));
        play->hash = (play->hash ^ hash) * 0x100000001b3u + 1;
        ++play->steps;
        part(*play);
        vox_sim_energy energy;
        check(vox_sim_get_energy(play->sim.get(), VOX_NULL_BODY, &energy));
        play->facts.max_speed = energy.max_speed;
        play->still_steps =
            2 * energy.kinetic < still_speed * still_speed * energy.mass ? play->still_steps + 1 : 0;
    });
}

vox_result play_grab(playground* play, const double from[3], const double to[3], double out_point[3],
                     uint32_t* out_found) {
    return guard([&] {
        *out_found = 0;
        play_let_go(play);
        vox_ray_hit hit;
        if (!find_first_hit(*play, from, to, hit)) return;
        const auto body = find_body(*play, hit.body);
        if (body == play->bodies.end() || body->kind == PLAY_FIXED) return;
        const Vec a = {from[0], from[1], from[2]}, b = {to[0], to[1], to[2]};
        const Vec point = a + hit.t * (b - a);
        const std::span positions = list(body->view.positions, 3 * body->view.vertex_count);
        // All vertices near the point, and the corners of the tetrahedron, so that there are some.
        std::vector<Held> held;
        constexpr double near = 0.25;
        const std::uint32_t* corners = &body->tets[4 * hit.tet];
        for (std::uint32_t v = 0; v < body->view.vertex_count; ++v) {
            const Vec way = at(positions, v) - point;
            if (dot(way, way) <= near * near || std::find(corners, corners + 4, v) != corners + 4)
                held.push_back({v, way});
        }
        play->held = std::move(held);
        play->held_mesh = hit.body;
        play->held_target = point;
        std::copy(point.begin(), point.end(), out_point);
        play->was_touched();
        *out_found = 1;
    });
}

void play_drag(playground* play, const double point[3]) {
    Vec target = {point[0], point[1], std::max(point[2], 0.0)};
    for (double& x : target) x = std::isfinite(x) ? std::clamp(x, -20.0, 20.0) : 0;
    play->held_target = target;
    play->was_touched();
}

void play_let_go(playground* play) {
    play->held_mesh = VOX_NULL_BODY;
    play->held.clear();
}

uint32_t play_body_count(const playground* play) { return static_cast<std::uint32_t>(play->bodies.size()); }

const play_body* play_get_body(const playground* play, uint32_t index) {
    const Body& body = play->bodies[index];
    play->shown = {body.view.grid_positions,
                   body.triangles.data(),
                   static_cast<std::uint32_t>(body.view.vertex_count),
                   static_cast<std::uint32_t>(body.triangles.size() / 3),
                   static_cast<std::uint32_t>(body.uncut / 3),
                   body.serial,
                   body.origin,
                   body.kind};
    return &play->shown;
}

const float* play_penetrations(playground* play, uint32_t* out_count) {
    play->arrows.clear();
    for (const vox_constraint& c : constraints_of(*play)) {
        const auto body = find_body(*play, c.body_a);
        if (body == play->bodies.end() || (c.kind == VOX_CONSTRAINT_EDGE && c.body_b == play->tool.shape))
            continue; // removed since the step, or drawn as a line
        const float* vertex = body->view.grid_positions + 3 * std::size_t{c.vertices[0]};
        play->arrows.insert(play->arrows.end(), vertex, vertex + 3);
        for (const double n : c.normal) play->arrows.push_back(static_cast<float>(-c.gap * n));
    }
    *out_count = static_cast<std::uint32_t>(play->arrows.size() / 6);
    return play->arrows.data();
}

const play_facts* play_get_facts(playground* play) {
    play_facts& facts = play->facts;
    vox_contact_view contacts{};
    vox_counter_view counters{};
    if (vox_grid_get_contacts(play->grid, &contacts) == VOX_OK &&
        vox_sim_get_counters(play->sim.get(), &counters) == VOX_OK) {
        const auto counter = [&](std::string_view name) {
            const auto at = std::find_if(counters.data, counters.data + counters.count,
                                         [&](const vox_counter& c) { return c.name == name; });
            return static_cast<double>(at->value); // a simulation always has the same ones
        };
        facts.tets = counter("tets");
        facts.contacts = static_cast<double>(contacts.count);
        facts.step_ns = counter("step_ns");
        facts.detect_ns = counter("detect_ns");
    }
    facts.deepest = facts.touched = 0;
    for (const vox_constraint& c : constraints_of(*play)) {
        const bool is_tool = play->tool.kind != PLAY_NO_TOOL && c.body_b == play->tool.shape;
        if (is_tool)
            ++facts.touched;
        else
            facts.deepest = std::max(facts.deepest, -c.gap);
    }
    std::copy(play->tool.at.begin(), play->tool.at.end(), facts.tool);
    vox_grid_info info{};
    info.struct_size = sizeof info;
    if (vox_grid_get_info(play->grid, &info) == VOX_OK) {
        facts.cell_size = info.cell_size;
        facts.grid_ns = static_cast<double>(info.step_ns);
        facts.pairs = static_cast<double>(info.total_began - info.total_ended);
    }
    facts.steps = static_cast<double>(play->steps);
    facts.asleep = play->asleep() ? 1 : 0;
    facts.bytes = static_cast<double>(play->account.bytes);
    facts.byte_limit = static_cast<double>(play->account.limit);
    return &facts;
}

uint64_t play_hash(const playground* play) { return play->hash; }

vox_result play_save(playground* play, const void** out_bytes, uint64_t* out_size, uint64_t* out_hash) {
    return guard([&] {
        std::uint64_t size = 0;
        check(vox_grid_save(play->grid, nullptr, 0, &size));
        std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
        check(vox_grid_save(play->grid, bytes.data(), bytes.size(), &size));
        vox_grid* loaded = nullptr;
        check(vox_grid_load(bytes.data(), bytes.size(), nullptr, &loaded));
        const Grid grid(loaded);
        check(vox_grid_step(loaded));
        check(vox_grid_get_hash(loaded, out_hash));
        play->snapshot = std::move(bytes);
        *out_bytes = play->snapshot.data();
        *out_size = size;
    });
}

vox_result play_load(playground* play, const void* bytes, uint64_t size) {
    return guard([&] {
        vox_grid_desc desc = vox_default_grid_desc();
        const vox_allocator allocator{allocate, release, &play->account};
        desc.allocator = &allocator;
        vox_grid* loaded = nullptr;
        check(vox_grid_load(bytes, size, &desc, &loaded));
        const Grid grid(loaded);
        replace(*play,
                [&](const std::vector<Body>& old_bodies) { read_bodies(*play, loaded, old_bodies.front()); });
        play->hash = play->steps = 0;
    });
}
