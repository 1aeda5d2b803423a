// The MuJoCo plugin vox.contact: penetrations between flexes of tetrahedra and of geoms, and passive forces
// that end them.
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
constexpr const char* geoms_key = "geoms";
constexpr const char* exclude_key = "exclude";

struct GridDeleter {
    void operator()(vox_grid* grid) const { vox_grid_destroy(grid); }
};

// A body that moves a vertex with this weight: its own, or that of a node which it is interpolated from.
struct Carrier {
    int body;
    int node; // -1: the body is the vertex's own
    double weight;
};

// An instance in one mjData. Nothing of the mjModel is kept, as it may be freed first.
struct Instance {
    std::unique_ptr<vox_grid, GridDeleter> grid;
    Settings settings;
    std::vector<int> flexes;             // ids of those that take part, ascending
    std::vector<vox_body> meshes;        // of each of them, ascending; empty until there are positions
    std::vector<int> geoms;              // that are shapes
    std::vector<vox_body> shapes;        // of each of them
    const mjtNum* positions = nullptr;   // d->flexvert_xpos, as bound
    std::vector<uint32_t> first_carrier; // of each vertex of the model, and of one past the last
    std::vector<Carrier> carriers;
    std::vector<uint8_t> excluded; // of each element of the model: takes no part
    std::vector<uint8_t> silent;   // of each vertex: all of its elements are excluded
    std::vector<double> load;      // of each body: sum of the weights by which penetrations move it; else 0
    std::string failure; // text of the last step's error, so that it is reported once; "" if it succeeded
    double penetrations = 0;
    double greatest_depth = 0;

    std::span<const Carrier> carriers_of(int vertex) const {
        const uint32_t* first = first_carrier.data() + vertex;
        return std::span(carriers).subspan(first[0], first[1] - first[0]);
    }
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
        if (m->flex_interp[flex] < 0 || m->flex_interp[flex] > 2)
            fail("flex %d \"%.100s\" is a shell: the nodes inside of it follow from others (elastic2d). "
                 "vox.contact "
                 "knows dof \"full\", \"trilinear\" and \"quadratic\"",
                 flex, flex_name(m, flex));
    return flexes;
}

// The geoms that are named. MuJoCo must not collide them with the flexes, too.
std::vector<int> read_geoms(const mjModel* m, int instance, const std::vector<int>& flexes) {
    std::vector<int> geoms;
    std::istringstream names(config(m, instance, geoms_key));
    for (std::string name; names >> name;) {
        const int geom = mj_name2id(m, mjOBJ_GEOM, name.c_str());
        if (geom < 0) fail("%s names \"%.100s\", but no geom of the model", geoms_key, name.c_str());
        if (m->geom_type[geom] == mjGEOM_ELLIPSOID || m->geom_type[geom] == mjGEOM_SDF)
            fail("geom \"%.100s\" is an ellipsoid or an sdf, which cannot take part", name.c_str());
        for (const int flex : flexes)
            if ((m->geom_contype[geom] & m->flex_conaffinity[flex]) ||
                (m->flex_contype[flex] & m->geom_conaffinity[geom]))
                fail("MuJoCo collides geom \"%.100s\" with flex %d \"%.100s\", too: their contype and "
                     "conaffinity have a bit in common",
                     name.c_str(), flex, flex_name(m, flex));
        geoms.push_back(geom);
    }
    std::sort(geoms.begin(), geoms.end());
    geoms.erase(std::unique(geoms.begin(), geoms.end()), geoms.end());
    return geoms;
}

// Marks the elements that `exclude` names: "flex:3 flex:10-19".
void read_excluded(Instance& instance, const mjModel* m, int id) {
    std::istringstream parts(config(m, id, exclude_key));
    for (std::string part; parts >> part;) {
        const size_t colon = part.rfind(':');
        const std::string name = part.substr(0, colon);
        const int flex = colon == std::string::npos ? -1 : mj_name2id(m, mjOBJ_FLEX, name.c_str());
        if (!std::binary_search(instance.flexes.begin(), instance.flexes.end(), flex))
            fail("%s has \"%.100s\", which is not a flex that takes part, a colon and elements", exclude_key,
                 part.c_str());
        int first = -1, last = -1, used = 0;
        const char* range = part.c_str() + colon + 1;
        if (std::sscanf(range, "%d%n-%d%n", &first, &used, &last, &used) == 1) last = first;
        if (range[used] || first < 0 || last < first || last >= m->flex_elemnum[flex])
            fail("%s has \"%.100s\", but flex \"%.100s\" has elements 0 to %d", exclude_key, part.c_str(),
                 name.c_str(), m->flex_elemnum[flex] - 1);
        const auto begin = instance.excluded.begin() + m->flex_elemadr[flex];
        std::fill(begin + first, begin + last + 1, uint8_t{1});
    }
    for (const int flex : instance.flexes) {
        const auto vertices = instance.silent.begin() + m->flex_vertadr[flex];
        const int* corner = m->flex_elem + m->flex_elemdataadr[flex];
        for (int element = 0; element < m->flex_elemnum[flex]; ++element)
            for (int k = 0; k < 4; ++k, ++corner)
                if (!instance.excluded[static_cast<size_t>(m->flex_elemadr[flex] + element)])
                    vertices[*corner] = 0;
    }
}

// The polynomials of one dimension that interpolate between order + 1 nodes on [0, 1].
std::array<double, 3> basis(int order, double x) {
    if (order == 1) return {1 - x, x, 0};
    return {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
}

// The nodes that MuJoCo interpolates a vertex from: those of its cell in a lattice of cells, z fastest.
void add_nodes(Instance& instance, const mjModel* m, int flex, int vertex) {
    const int order = m->flex_interp[flex];
    const int* cells = m->flex_cellnum + 3 * static_cast<ptrdiff_t>(flex);
    const mjtNum* at = m->flex_vert0 + 3 * static_cast<ptrdiff_t>(vertex);
    std::array<int, 3> first;
    std::array<std::array<double, 3>, 3> weights;
    for (size_t k = 0; k < 3; ++k) {
        const int cell = static_cast<int>(std::clamp(std::floor(at[k] * cells[k]), 0.0, cells[k] - 1.0));
        first[k] = cell * order;
        weights[k] = basis(order, std::clamp<double>(at[k] * cells[k] - cell, 0, 1));
    }
    for (int i = 0; i <= order; ++i)
        for (int j = 0; j <= order; ++j)
            for (int k = 0; k <= order; ++k) {
                const double weight = weights[0][static_cast<size_t>(i)] *
                                      weights[1][static_cast<size_t>(j)] * weights[2][static_cast<size_t>(k)];
                if (weight == 0) continue;
                const int row = (first[0] + i) * (cells[1] * order + 1) + first[1] + j;
                const int node = m->flex_nodeadr[flex] + row * (cells[2] * order + 1) + first[2] + k;
                instance.carriers.push_back({m->flex_nodebodyid[node], node, weight});
            }
}

void find_carriers(Instance& instance, const mjModel* m) {
    instance.first_carrier.push_back(0);
    for (int flex = 0; flex < static_cast<int>(m->nflex); ++flex) {
        const bool takes_part = std::binary_search(instance.flexes.begin(), instance.flexes.end(), flex);
        for (int i = 0; i < m->flex_vertnum[flex]; ++i) {
            const int vertex = m->flex_vertadr[flex] + i;
            if (takes_part && m->flex_interp[flex] != 0)
                add_nodes(instance, m, flex, vertex);
            else if (takes_part)
                instance.carriers.push_back({m->flex_vertbodyid[vertex], -1, 1});
            instance.first_carrier.push_back(static_cast<uint32_t>(instance.carriers.size()));
        }
    }
}

std::unique_ptr<Instance> make_instance(const mjModel* m, int id) {
    auto instance = std::make_unique<Instance>();
    instance->settings = read_settings(m, id);
    instance->flexes = read_flexes(m, id);
    instance->geoms = read_geoms(m, id, instance->flexes);
    instance->meshes.reserve(instance->flexes.size());
    instance->load.resize(static_cast<size_t>(m->nbody));
    instance->excluded.resize(static_cast<size_t>(m->nflexelem));
    instance->silent.assign(static_cast<size_t>(m->nflexvert), 1);
    read_excluded(*instance, m, id);
    find_carriers(*instance, m);
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

vox_positions mesh_positions(const mjModel* m, int mesh) {
    return vox_float_positions(m->mesh_vert + 3 * static_cast<ptrdiff_t>(m->mesh_vertadr[mesh]),
                               static_cast<uint64_t>(m->mesh_vertnum[mesh]));
}

// Where a terrain's lowest corner is in the frame of its geom.
struct Corner {
    double x = 0, y = 0;
};

Corner corner_of(const mjModel* m, int geom) {
    if (m->geom_type[geom] != mjGEOM_HFIELD) return {};
    const mjtNum* size = m->hfield_size + 4 * static_cast<ptrdiff_t>(m->geom_dataid[geom]);
    return {-size[0], -size[1]};
}

vox_body insert_shape(vox_grid* grid, const mjModel* m, int geom) {
    const mjtNum* size = m->geom_size + 3 * static_cast<ptrdiff_t>(geom);
    const int data = m->geom_dataid[geom];
    vox_shape_desc desc = vox_default_shape_desc();
    desc.user_data = static_cast<uint64_t>(geom);
    desc.radius = size[0];
    desc.half_length = size[1];
    std::vector<double> heights;
    switch (m->geom_type[geom]) {
    case mjGEOM_PLANE:
        desc.kind = VOX_SHAPE_HALF_SPACE;
        break;
    case mjGEOM_SPHERE:
        desc.kind = VOX_SHAPE_SPHERE;
        break;
    case mjGEOM_CAPSULE:
        desc.kind = VOX_SHAPE_CAPSULE;
        break;
    case mjGEOM_CYLINDER:
        desc.kind = VOX_SHAPE_CYLINDER;
        break;
    case mjGEOM_BOX:
        desc.kind = VOX_SHAPE_BOX;
        std::copy(size, size + 3, desc.half_size);
        break;
    case mjGEOM_HFIELD: {
        const mjtNum* extent = m->hfield_size + 4 * static_cast<ptrdiff_t>(data);
        desc.kind = VOX_SHAPE_HEIGHTFIELD;
        desc.columns = static_cast<uint32_t>(m->hfield_ncol[data]);
        desc.rows = static_cast<uint32_t>(m->hfield_nrow[data]);
        desc.spacing[0] = 2 * extent[0] / (desc.columns - 1);
        desc.spacing[1] = 2 * extent[1] / (desc.rows - 1);
        const float* from = m->hfield_data + m->hfield_adr[data];
        heights.assign(from, from + static_cast<ptrdiff_t>(desc.columns) * desc.rows);
        for (double& height : heights) height *= extent[2];
        desc.heights = heights.data();
        break;
    }
    default: // a mesh
        desc.kind = VOX_SHAPE_SOLID;
        desc.positions = mesh_positions(m, data);
        desc.triangles = reinterpret_cast<const uint32_t*>(
            m->mesh_face + 3 * static_cast<ptrdiff_t>(m->mesh_faceadr[data])); // none is negative
        desc.triangle_count = static_cast<uint64_t>(m->mesh_facenum[data]);
    }
    vox_body shape = VOX_NULL_BODY;
    check(vox_shape_insert(grid, &desc, &shape));
    return shape;
}

void place_shapes(const Instance& instance, const mjModel* m, const mjData* d) {
    for (size_t i = 0; i < instance.geoms.size(); ++i) {
        const int geom = instance.geoms[i];
        const mjtNum *p = d->geom_xpos + 3 * static_cast<ptrdiff_t>(geom),
                     *r = d->geom_xmat + 9 * static_cast<ptrdiff_t>(geom);
        const Corner corner = corner_of(m, geom);
        double matrix[12];
        for (size_t row = 0; row < 3; ++row) {
            std::copy(r + 3 * row, r + 3 * row + 3, matrix + 4 * row);
            matrix[4 * row + 3] = p[row] + r[3 * row] * corner.x + r[3 * row + 1] * corner.y;
        }
        check(vox_body_set_transform(instance.grid.get(), instance.shapes[i], matrix));
    }
}

// A geom does not collide with a flex that is a part of the same body.
void insert_shapes(Instance& instance, const mjModel* m) {
    instance.shapes.clear();
    for (const int geom : instance.geoms) {
        instance.shapes.push_back(insert_shape(instance.grid.get(), m, geom));
        for (size_t i = 0; i < instance.flexes.size(); ++i) {
            const int* bodies = m->flex_vertbodyid + m->flex_vertadr[instance.flexes[i]];
            if (std::all_of(bodies, bodies + m->flex_vertnum[instance.flexes[i]],
                            [&](int body) { return body == m->geom_bodyid[geom]; }))
                check(vox_grid_set_pair_enabled(instance.grid.get(), instance.meshes[i],
                                                instance.shapes.back(), 0));
        }
    }
}

// Gives the grid its meshes and shapes. This is done before the first step, not in `init`: tiles are made by
// the positions at insertion, and mjData has none before kinematics.
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
    insert_shapes(instance, m);
    instance.positions = d->flexvert_xpos;
}

void find_penetrations(Instance& instance, const mjModel* m, const mjData* d) {
    if (instance.meshes.size() != instance.flexes.size() || instance.shapes.size() != instance.geoms.size()) {
        insert_meshes(instance, m, d);
    } else if (instance.positions != d->flexvert_xpos) {
        for (size_t i = 0; i < instance.flexes.size(); ++i) {
            const vox_positions positions = flex_positions(m, d, instance.flexes[i]);
            check(vox_mesh_bind_positions(instance.grid.get(), instance.meshes[i], &positions));
        }
        instance.positions = d->flexvert_xpos;
    }
    place_shapes(instance, m, d);
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

// A vertex of a flex, a node that carries one, or a point of a geom, with the weight that it has in a
// penetration.
struct Point {
    int body;
    double weight;
    Vector at;
};

// From the point that spatial vectors of a body refer to, the centre of mass of its tree.
Vector lever(const mjModel* m, const mjData* d, const Point& point) {
    return point.at - vector(d->subtree_com + 3 * static_cast<ptrdiff_t>(m->body_rootid[point.body]));
}

Vector velocity(const mjModel* m, const mjData* d, const Point& point) {
    const mjtNum* v = d->cvel + 6 * static_cast<ptrdiff_t>(point.body);
    return vector(v + 3) + cross(vector(v), lever(m, d, point));
}

// At most how fast a unit of force at the point moves it, per time.
double inverse_mass(const mjModel* m, const mjData* d, const Point& point) {
    const mjtNum* inverse = m->body_invweight0 + 2 * static_cast<ptrdiff_t>(point.body);
    if (inverse[1] == 0) return inverse[0];
    const Vector arm = point.at - vector(d->xipos + 3 * static_cast<ptrdiff_t>(point.body));
    return inverse[0] + inverse[1] * dot(arm, arm);
}

// Adds a force on a point to qfrc_passive. As mj_applyFT, but without its Jacobian of 3 rows and nv columns:
// only the dofs between its body and the world are visited, which are 3 for a vertex of its own.
void apply(const mjModel* m, mjData* d, const Point& point, Vector force) {
    int body = point.body;
    if (d->body_awake[body] == mjS_ASLEEP)
        return; // passive forces of sleeping bodies are not set to 0 in a step
    const Vector torque = cross(lever(m, d, point), force);
    while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
    if (body == 0) return;
    for (int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1; dof >= 0; dof = m->dof_parentid[dof]) {
        const mjtNum* axis = d->cdof + 6 * static_cast<ptrdiff_t>(dof);
        d->qfrc_passive[dof] += static_cast<mjtNum>(dot(vector(axis), torque) + dot(vector(axis + 3), force));
    }
}

bool with_geom(const vox_constraint& c) { return c.count == c.count_a; }

int vertex_of(const mjModel* m, const vox_constraint& c, size_t i) {
    const auto flex = static_cast<size_t>(i < c.count_a ? c.user_data_a : c.user_data_b);
    return m->flex_vertadr[flex] + static_cast<int>(c.vertices[i]);
}

bool is_excluded(const Instance& instance, const mjModel* m, const vox_constraint& c) {
    if (instance.silent[static_cast<size_t>(vertex_of(m, c, 0))]) return true;
    return !with_geom(c) &&
           instance.excluded[static_cast<size_t>(m->flex_elemadr[c.user_data_b]) + c.element_b];
}

Vector node_position(const mjModel* m, const mjData* d, const Carrier& carrier) {
    const ptrdiff_t body = carrier.body;
    const Vector local = vector(m->flex_node + 3 * static_cast<ptrdiff_t>(carrier.node));
    const mjtNum* row = d->xmat + 9 * body;
    return vector(d->xpos + 3 * body) +
           Vector{dot(vector(row), local), dot(vector(row + 3), local), dot(vector(row + 6), local)};
}

// Visits what a penetration moves: what carries its vertices, and with a geom the place on that.
template <typename Visit>
void each_point(const Instance& instance, const mjModel* m, const mjData* d, const vox_constraint& c,
                const Visit& visit) {
    for (size_t i = 0; i < c.count; ++i) {
        const int vertex = vertex_of(m, c, i);
        for (const Carrier& carrier : instance.carriers_of(vertex))
            visit(Point{carrier.body, c.weights[i] * carrier.weight,
                        carrier.node < 0 ? vector(d->flexvert_xpos + 3 * static_cast<ptrdiff_t>(vertex))
                                         : node_position(m, d, carrier)});
    }
    if (with_geom(c)) visit(Point{m->geom_bodyid[c.user_data_b], -1, vector(c.position)});
}

// Forces that end the penetrations: a spring and a damper along each direction, and friction across it.
//
// Stiffness follows from the masses, so that no mesh is too fine. Let J have a row for each penetration, the
// weights times its direction, M be the masses and A = J M^-1 J^T. Entries of A are at most the sum over
// bodies of |w| |w'| / m; so row sums of |A| are at most 1/mass, with 1/mass = sum of |w| load / m and load =
// sum of |w| over all penetrations of a body. With stiffness mass / t^2 and damping 2 mass / t, by
// Gershgorin's theorem every mode of the contacts has at most the frequency 1/t and is damped critically at
// most. A step of semi-implicit Euler is then stable if (h/t)^2 + 4 h/t < 4, so for t >= 2 h with room for
// the flexes' own elasticity. A vertex between nodes has the weights of its nodes in place of its own.
void respond(Instance& instance, const mjModel* m, mjData* d) {
    vox_constraint_view view{};
    check(vox_grid_get_constraints(instance.grid.get(), &view));
    const std::span constraints(view.data, static_cast<size_t>(view.count));
    const auto load = [&](const Point& p) -> double& { return instance.load[static_cast<size_t>(p.body)]; };
    for (const vox_constraint& c : constraints)
        if (!is_excluded(instance, m, c))
            each_point(instance, m, d, c, [&](const Point& p) { load(p) += std::abs(p.weight); });

    const Settings& settings = instance.settings;
    const double timeconst = std::max(settings.timeconst, least_timesteps * m->opt.timestep);
    for (const vox_constraint& c : constraints) {
        if (is_excluded(instance, m, c)) continue;
        ++instance.penetrations;
        instance.greatest_depth = std::max(instance.greatest_depth, -c.gap);
        double inverse = 0;
        Vector speed; // of the vertex, as seen from the tetrahedron or the geom
        each_point(instance, m, d, c, [&](const Point& p) {
            inverse += std::abs(p.weight) * load(p) * inverse_mass(m, d, p);
            speed = speed + p.weight * velocity(m, d, p);
        });
        if (!(inverse > 0)) continue; // nothing that could move
        const double mass = 1 / inverse;
        const double stiffness =
            settings.stiffness >= 0 ? settings.stiffness : mass / (timeconst * timeconst);
        const double damping = settings.damping >= 0 ? settings.damping : 2 * std::sqrt(stiffness * mass);
        const double friction =
            std::max(m->flex_friction[3 * c.user_data_a], // as MuJoCo combines two
                     (with_geom(c) ? m->geom_friction : m->flex_friction)[3 * c.user_data_b]);
        const Vector normal = vector(c.normal);
        const double leaving = dot(speed, normal);
        const double pressure = std::max(0.0, -stiffness * c.gap - damping * leaving);
        // Friction by Coulomb's law, and no more of it than the damper needs to end the sliding.
        const Vector sliding = speed - leaving * normal;
        const double rate = std::sqrt(dot(sliding, sliding));
        const double drag = damping * rate > friction * pressure ? friction * pressure / rate : damping;
        const Vector force = pressure * normal - drag * sliding;
        each_point(instance, m, d, c, [&](const Point& p) { apply(m, d, p, p.weight * force); });
    }
    for (const vox_constraint& c : constraints)
        each_point(instance, m, d, c, [&](const Point& p) { load(p) = 0; });
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
    std::array<const char*, keys.size() + 3> names{};
    for (size_t i = 0; i < keys.size(); ++i) names[i] = keys[i].name;
    names[keys.size()] = flexes_key;
    names[keys.size() + 1] = geoms_key;
    names.back() = exclude_key;

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
