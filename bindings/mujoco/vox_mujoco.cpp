// The MuJoCo plugin vox.contact: penetrations between flexes of tetrahedra, and passive forces that end them.
#include "vox_mujoco.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <locale>
#include <memory>
#include <new>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr const char* plugin_name = "vox.contact";
// What the sensor of an instance gives: penetrations, and the greatest depth.
constexpr int sensor_size = 2;
// Damped at this rate, no mode of contacts alone is unstable; see `respond`.
constexpr double least_timesteps = 2;

struct Settings {
    double timeconst = 0;  // seconds; 0: the least
    double stiffness = -1; // N/m of a penetration; negative: from timeconst
    double damping = -1;   // N s/m of a penetration; negative: critical
    double workers = 1;
    double self = 0;
    double rings = 0;
};

enum class Kind { real, whole, boolean };

// A number that an instance can be configured with, and the range it has to be in.
struct Key {
    const char* name;
    double Settings::*value;
    double least, greatest;
    Kind kind;
};
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array<Key, 6> keys = {{
    {"timeconst", &Settings::timeconst, 0, infinity, Kind::real},
    {"stiffness", &Settings::stiffness, 0, infinity, Kind::real},
    {"damping", &Settings::damping, 0, infinity, Kind::real},
    {"self", &Settings::self, 0, 1, Kind::boolean},
    {"rings", &Settings::rings, 0, VOX_MAX_RINGS, Kind::whole},
    {"workers", &Settings::workers, 0, VOX_MAX_WORKERS, Kind::whole},
}};
constexpr const char* flexes_key = "flexes";

struct GridDeleter {
    void operator()(vox_grid* grid) const { vox_grid_destroy(grid); }
};

// An instance in one mjData. Nothing of the mjModel is kept, as it may be freed first.
struct Instance {
    std::unique_ptr<vox_grid, GridDeleter> grid;
    Settings settings;
    std::vector<int> flexes;           // ids of those that take part, ascending
    std::vector<vox_body> meshes;      // of each of them, ascending; empty until there are positions
    const mjtNum* positions = nullptr; // d->flexvert_xpos, as bound
    std::vector<double> load; // of each body: sum of the weights by which penetrations move it; else 0
    std::string failure; // text of the last step's error, so that it is reported once; "" if it succeeded
    double penetrations = 0;
    double greatest_depth = 0;
};

void check(vox_result result) {
    if (result != VOX_OK) throw std::runtime_error(vox_last_error());
}

template <typename... Values>
[[noreturn]] void fail(const char* format, Values... values) {
    char text[512];
    std::snprintf(text, sizeof text, format, values...);
    throw std::runtime_error(text);
}

std::string config(const mjModel* m, int instance, const char* key) {
    const char* text = mj_getPluginConfig(m, instance, key);
    return text ? text : "";
}

Settings read_settings(const mjModel* m, int instance) {
    Settings settings;
    for (const Key& key : keys) {
        const std::string text = config(m, instance, key.name);
        if (text.empty()) continue;
        std::istringstream in(text);
        in.imbue(std::locale::classic()); // a point, whatever the program's locale
        double value = text == "true";
        const bool word = key.kind == Kind::boolean && (text == "true" || text == "false");
        if (!word && (!(in >> value) || !(in >> std::ws).eof() || !std::isfinite(value)))
            fail("%s = \"%.100s\" is not a number", key.name, text.c_str());
        const bool whole = key.kind != Kind::real;
        if (value < key.least || value > key.greatest || (whole && value != std::floor(value)))
            fail("%s = %g is not %s in [%g, %g]", key.name, value, whole ? "a whole number" : "a number",
                 key.least, key.greatest);
        settings.*key.value = value;
    }
    return settings;
}

const char* flex_name(const mjModel* m, int flex) {
    const char* name = mj_id2name(m, mjOBJ_FLEX, flex);
    return name ? name : "";
}

// The flexes that are named, or else all flexes of tetrahedra.
std::vector<int> read_flexes(const mjModel* m, int instance) {
    std::vector<int> flexes;
    std::istringstream names(config(m, instance, flexes_key));
    for (std::string name; names >> name;) {
        const int flex = mj_name2id(m, mjOBJ_FLEX, name.c_str());
        if (flex < 0) fail("%s names \"%.100s\", but no flex of the model", flexes_key, name.c_str());
        if (m->flex_dim[flex] != 3)
            fail("flex \"%.100s\" has dim %d; only those of tetrahedra, dim 3, can take part", name.c_str(),
                 m->flex_dim[flex]);
        flexes.push_back(flex);
    }
    if (flexes.empty()) {
        for (int flex = 0; flex < static_cast<int>(m->nflex); ++flex)
            if (m->flex_dim[flex] == 3) flexes.push_back(flex);
    }
    std::sort(flexes.begin(), flexes.end());
    flexes.erase(std::unique(flexes.begin(), flexes.end()), flexes.end());
    if (flexes.empty())
        fail("the model has %d flexes, but none of tetrahedra (dim 3)", static_cast<int>(m->nflex));
    for (const int flex : flexes)
        if (m->flex_interp[flex] != 0)
            fail("the vertices of flex %d \"%.100s\" are interpolated from nodes (dof \"trilinear\" or "
                 "\"quadratic\"); "
                 "forces can be applied to vertices with bodies of their own alone",
                 flex, flex_name(m, flex));
    return flexes;
}

std::unique_ptr<Instance> make_instance(const mjModel* m, int id) {
    auto instance = std::make_unique<Instance>();
    instance->settings = read_settings(m, id);
    instance->flexes = read_flexes(m, id);
    instance->meshes.reserve(instance->flexes.size());
    instance->load.resize(static_cast<size_t>(m->nbody));
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    const int workers = instance->settings.workers;
    desc.worker_count = workers == 0 ? VOX_ALL_CORES : static_cast<uint32_t>(workers);
    vox_grid* grid = nullptr;
    check(vox_grid_create(&desc, &grid));
    instance->grid.reset(grid);
    return instance;
}

// Positions of the vertices of a flex.
vox_positions flex_positions(const mjModel* m, const mjData* d, int flex) {
    vox_positions positions = VOX_ZERO;
    positions.data = d->flexvert_xpos + 3 * static_cast<ptrdiff_t>(m->flex_vertadr[flex]);
    positions.count = static_cast<uint64_t>(m->flex_vertnum[flex]);
    positions.format = sizeof(mjtNum) == sizeof(double) ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    return positions;
}

// Gives the grid its meshes. This is done before the first step, not in `init`: tiles are made by the
// positions at insertion, and mjData has none before kinematics.
void insert_meshes(Instance& instance, const mjModel* m, const mjData* d) {
    check(vox_grid_clear(instance.grid.get()));
    instance.meshes.clear();
    vox_filter filter{};
    filter.flags = static_cast<uint32_t>(instance.settings.self) ? VOX_FILTER_SELF_COLLISION : 0u;
    filter.self_rings = static_cast<uint32_t>(instance.settings.rings);
    for (const int flex : instance.flexes) {
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions = flex_positions(m, d, flex);
        desc.tets =
            reinterpret_cast<const uint32_t*>(m->flex_elem + m->flex_elemdataadr[flex]); // none is negative
        desc.tet_count = static_cast<uint64_t>(m->flex_elemnum[flex]);
        desc.user_data = static_cast<uint64_t>(flex);
        desc.filter = filter;
        vox_body mesh = VOX_NULL_BODY;
        check(vox_mesh_insert(instance.grid.get(), &desc, &mesh));
        instance.meshes.push_back(mesh);
    }
    instance.positions = d->flexvert_xpos;
}

void find_penetrations(Instance& instance, const mjModel* m, const mjData* d) {
    if (instance.meshes.size() != instance.flexes.size()) {
        insert_meshes(instance, m, d);
    } else if (instance.positions != d->flexvert_xpos) {
        for (size_t i = 0; i < instance.flexes.size(); ++i) {
            const vox_positions positions = flex_positions(m, d, instance.flexes[i]);
            check(vox_mesh_bind_positions(instance.grid.get(), instance.meshes[i], &positions));
        }
        instance.positions = d->flexvert_xpos;
    }
    check(vox_grid_step(instance.grid.get()));
}

struct Vector {
    double x = 0, y = 0, z = 0;
};
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename Number>
Vector vector(const Number* v) {
    return {v[0], v[1], v[2]};
}

// From the point that spatial vectors of a body refer to, the centre of mass of its tree, to a vertex.
Vector lever(const mjModel* m, const mjData* d, int vertex, int body) {
    return vector(d->flexvert_xpos + 3 * static_cast<ptrdiff_t>(vertex)) -
           vector(d->subtree_com + 3 * static_cast<ptrdiff_t>(m->body_rootid[body]));
}

Vector velocity(const mjModel* m, const mjData* d, int vertex) {
    const int body = m->flex_vertbodyid[vertex];
    const mjtNum* v = d->cvel + 6 * static_cast<ptrdiff_t>(body);
    return vector(v + 3) + cross(vector(v), lever(m, d, vertex, body));
}

// Adds a force on a vertex to qfrc_passive. As mj_applyFT, but without its Jacobian of 3 rows and nv columns:
// only the dofs between the vertex's body and the world are visited, which are 3 for a vertex of its own.
void apply(const mjModel* m, mjData* d, int vertex, Vector force) {
    int body = m->flex_vertbodyid[vertex];
    if (d->body_awake[body] == mjS_ASLEEP)
        return; // passive forces of sleeping bodies are not set to 0 in a step
    const Vector torque = cross(lever(m, d, vertex, body), force);
    while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
    if (body == 0) return;
    for (int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1; dof >= 0; dof = m->dof_parentid[dof]) {
        const mjtNum* axis = d->cdof + 6 * static_cast<ptrdiff_t>(dof);
        d->qfrc_passive[dof] += static_cast<mjtNum>(dot(vector(axis), torque) + dot(vector(axis + 3), force));
    }
}

// Forces that end the penetrations: a spring and a damper along each direction, and friction across it.
//
// Stiffness follows from the masses, so that no mesh is too fine. Let J have a row for each penetration, the
// weights times its direction, M be the masses and A = J M^-1 J^T. Entries of A are at most the sum over
// bodies of |w| |w'| / m; so row sums of |A| are at most 1/mass, with 1/mass = sum of |w| load / m and load =
// sum of |w| over all penetrations of a body. With stiffness mass / t^2 and damping 2 mass / t, by
// Gershgorin's theorem every mode of the contacts has at most the frequency 1/t and is damped critically at
// most. A step of semi-implicit Euler is then stable if (h/t)^2 + 4 h/t < 4, so for t >= 2 h with room for
// the flexes' own elasticity.
void respond(Instance& instance, const mjModel* m, mjData* d) {
    vox_constraint_view view{};
    check(vox_grid_get_constraints(instance.grid.get(), &view));
    const std::span constraints(view.data, static_cast<size_t>(view.count));
    const auto vertex = [m](const vox_constraint& c, size_t i) {
        return m->flex_vertadr[i < c.count_a ? c.user_data_a : c.user_data_b] +
               static_cast<int>(c.vertices[i]);
    };
    const auto body = [&](const vox_constraint& c, size_t i) {
        return static_cast<size_t>(m->flex_vertbodyid[vertex(c, i)]);
    };

    for (const vox_constraint& c : constraints)
        for (size_t i = 0; i < c.count; ++i) instance.load[body(c, i)] += std::abs(c.weights[i]);
    const Settings& settings = instance.settings;
    const double timeconst = std::max(settings.timeconst, least_timesteps * m->opt.timestep);
    instance.penetrations = static_cast<double>(constraints.size());
    for (const vox_constraint& c : constraints) {
        instance.greatest_depth = std::max(instance.greatest_depth, -c.gap);
        double inverse_mass = 0;
        Vector speed; // of the vertex, as seen from the tetrahedron
        for (size_t i = 0; i < c.count; ++i) {
            inverse_mass +=
                std::abs(c.weights[i]) * instance.load[body(c, i)] * m->body_invweight0[2 * body(c, i)];
            speed = speed + c.weights[i] * velocity(m, d, vertex(c, i));
        }
        if (!(inverse_mass > 0)) continue; // nothing that could move
        const double mass = 1 / inverse_mass;
        const double stiffness =
            settings.stiffness >= 0 ? settings.stiffness : mass / (timeconst * timeconst);
        const double damping = settings.damping >= 0 ? settings.damping : 2 * std::sqrt(stiffness * mass);
        const double friction = std::max(m->flex_friction[3 * c.user_data_a], // as MuJoCo combines two
                                         m->flex_friction[3 * c.user_data_b]);
        const Vector normal = vector(c.normal);
        const double leaving = dot(speed, normal);
        const double pressure = std::max(0.0, -stiffness * c.gap - damping * leaving);
        // Friction by Coulomb's law, and no more of it than the damper needs to end the sliding.
        const Vector sliding = speed - leaving * normal;
        const double rate = std::sqrt(dot(sliding, sliding));
        const double drag = damping * rate > friction * pressure ? friction * pressure / rate : damping;
        const Vector force = pressure * normal - drag * sliding;
        for (size_t i = 0; i < c.count; ++i) apply(m, d, vertex(c, i), c.weights[i] * force);
    }
    for (const vox_constraint& c : constraints)
        for (size_t i = 0; i < c.count; ++i) instance.load[body(c, i)] = 0;
}

Instance* get(const mjData* d, int instance) { return reinterpret_cast<Instance*>(d->plugin_data[instance]); }

// mju_error does not return, and may leave by longjmp: no object with a destructor may be alive here.
int init(const mjModel* m, mjData* d, int instance) {
    char text[1024];
    d->plugin_data[instance] = 0;
    try {
        d->plugin_data[instance] = reinterpret_cast<uintptr_t>(make_instance(m, instance).release());
        return 0;
    } catch (const std::exception& error) {
        std::snprintf(text, sizeof text, "%s", error.what());
    }
    mju_error("%s: %s", plugin_name, text);
    return -1;
}

void destroy(mjData* d, int instance) {
    delete get(d, instance);
    d->plugin_data[instance] = 0;
}

// Without springs and dampers MuJoCo computes no passive forces: what the last ones found is no longer true.
bool is_off(const mjModel* m) {
    constexpr int no_passive_forces = mjDSBL_SPRING | mjDSBL_DAMPER;
    const int off = m->opt.disableflags;
    return (off & mjDSBL_CONTACT) || (off & no_passive_forces) == no_passive_forces;
}

void write_sensors(const Instance& instance, const mjModel* m, mjData* d, int id) {
    for (int sensor = 0; sensor < static_cast<int>(m->nsensor); ++sensor) {
        if (m->sensor_type[sensor] != mjSENS_PLUGIN || m->sensor_plugin[sensor] != id) continue;
        mjtNum* out = d->sensordata + m->sensor_adr[sensor];
        out[0] = static_cast<mjtNum>(instance.penetrations);
        out[1] = static_cast<mjtNum>(instance.greatest_depth);
    }
}

void compute(const mjModel* m, mjData* d, int id, int capability) {
    Instance* instance = get(d, id);
    if (!instance) return;
    const bool off = is_off(m);
    if (off || capability != mjPLUGIN_SENSOR) instance->penetrations = instance->greatest_depth = 0;
    if (capability == mjPLUGIN_SENSOR) {
        write_sensors(*instance, m, d, id);
        return;
    }
    if (off) return;
    char text[1024] = "";
    try {
        find_penetrations(*instance, m, d);
        respond(*instance, m, d);
        instance->failure.clear();
    } catch (const std::exception& error) {
        // The simulation goes on without these forces. MuJoCo itself ends or resets one whose state is bad.
        if (instance->failure != error.what()) std::snprintf(text, sizeof text, "%s", error.what());
        try {
            instance->failure = error.what();
        } catch (const std::bad_alloc&) {
        } // it is reported again
    }
    if (text[0]) mju_warning("%s: no forces: %s", plugin_name, text);
}

} // namespace

extern "C" const vox_grid* vox_mujoco_grid(const mjData* d, int instance) {
    int slot = -1;
    if (!d || instance < 0 || instance >= d->nplugin || !mjp_getPlugin(plugin_name, &slot)) return nullptr;
    if (d->plugin[instance] != slot || !get(d, instance)) return nullptr;
    return get(d, instance)->grid.get();
}

mjPLUGIN_LIB_INIT(vox_contact) {
    // Structures of MuJoCo change from version to version, and nothing else would notice.
    if (mj_version() != mjVERSION_HEADER) {
        mju_warning("%s was built for MuJoCo %d and is not loaded into %d", plugin_name, mjVERSION_HEADER,
                    mj_version());
        return;
    }
    std::array<const char*, keys.size() + 1> names{};
    for (size_t i = 0; i < keys.size(); ++i) names[i] = keys[i].name;
    names.back() = flexes_key;

    mjpPlugin plugin;
    mjp_defaultPlugin(&plugin);
    plugin.name = plugin_name;
    plugin.nattribute = static_cast<int>(names.size());
    plugin.attributes = names.data();
    plugin.capabilityflags = mjPLUGIN_PASSIVE | mjPLUGIN_SENSOR;
    plugin.needstage = mjSTAGE_VEL;
    plugin.nstate = [](const mjModel*, int) { return 0; };
    plugin.nsensordata = [](const mjModel*, int, int) { return sensor_size; };
    plugin.init = init;
    plugin.destroy = destroy;
    plugin.reset = [](const mjModel*, mjtNum*, void*, int) {}; // every step begins anew
    plugin.compute = compute;
    mjp_registerPlugin(&plugin);
}
