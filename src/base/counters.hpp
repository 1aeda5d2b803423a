// The counters of a step and the times of its stages. vox_counter lists the names, except those in
// vox_grid_info.
#pragma once

#include <cstdint>

namespace vox {

// Counters from `cells` to `skipped_degenerate` do not include what was carried over from the step before,
// nor do those from `leaving_edges` to `closest_tests`. `tets` counts enabled tetrahedra.
// `skipped_degenerate` counts tetrahedra of exactly zero volume: with the reference engine all of them, with
// the fast engine those that had a vertex to test.
struct Counters {
    std::uint64_t bodies = 0;
    std::uint64_t vertices = 0;
    std::uint64_t tets = 0;
    std::uint64_t cells = 0;           // occupied cells, summed over the cell sizes if there are several
    std::uint64_t entries = 0;         // vertices in those cells
    std::uint64_t fullest_cell = 0;    // most vertices in one cell
    std::uint64_t visited_cells = 0;   // cells visited for tetrahedra (the paper's objective voxels)
    std::uint64_t visited_entries = 0; // vertices found there
    std::uint64_t candidates = 0;  // (vertex, tet) pairs that passed the box test: the narrow phase's input
    std::uint64_t exact_tests = 0; // orientations that needed exact arithmetic
    std::uint64_t contacts = 0;
    std::uint64_t skipped_degenerate = 0;
    std::uint64_t moved_bodies = 0;     // bodies that were not at rest (see vox_grid_step)
    std::uint64_t carried_contacts = 0; // part of `contacts` from the previous step, between bodies at rest
    std::uint64_t penetrations = 0;
    std::uint64_t leaving_edges = 0;     // edges from a colliding vertex to one outside body_b
    std::uint64_t edge_tests = 0;        // tetrahedra visited along those edges
    std::uint64_t closest_searches = 0;  // penetrations that needed the closest point of the surface
    std::uint64_t closest_tests = 0;     // triangles whose closest point was computed for that
    std::uint64_t disabled_bodies = 0;   // not included in `bodies` (see vox_body_set_enabled)
    std::uint64_t filtered = 0;          // (vertex, tet) pairs excluded by self_rings or self_rest_distance
    std::uint64_t cell_size_changes = 0; // how often the reference engine chose another one
    std::uint64_t unknown_penetrations = 0; // part of `penetrations` for which closest_budget left no search
    std::uint64_t carried_penetrations = 0; // part of `penetrations` carried over with their contacts
    std::uint64_t skipped_bodies = 0;       // not included in `bodies` (VOX_GRID_SKIP_BAD_BODIES)
    std::uint64_t bodies_without_tets = 0;  // part of `bodies`; only their vertices collide
    // Pairs that began and ended in all steps since the grid was created or loaded.
    std::uint64_t total_touches_began = 0;
    std::uint64_t total_touches_ended = 0;
    std::uint64_t edges = 0;               // 0 without VOX_GRID_EDGES, as are the next two
    std::uint64_t carried_edges = 0;       // part of `edges` carried over from the step before
    std::uint64_t edge_candidates = 0;     // edges and faces whose boxes overlap, also along slivers
    std::uint64_t proximities = 0;         // 0 without a margin (vox_grid_set_margin), as is the next one
    std::uint64_t carried_proximities = 0; // part of `proximities` carried over from the step before
    std::uint64_t constraints = 0;         // that were found last; 0 where none were looked for
    std::uint64_t impacts = 0;             // 0 without previous positions (vox_mesh_bind_previous_positions)
    std::uint64_t shape_contacts = 0;      // 0 without shapes, as is the next one
    std::uint64_t carried_shape_contacts = 0; // part of `shape_contacts` carried over
    std::uint64_t constraints_left_out = 0;   // by max_constraints_per_pair, when they were found last
    std::uint64_t face_candidates = 0;        // vertices and faces of which a distance or a time was computed
};

// Nanoseconds. stream_ns to decide_ns are the stages of the fast engine, and bin_ns, broad_ns and narrow_ns
// are their sums. The reference engine has only these three stages.
struct Profile {
    std::uint64_t step_ns = 0;
    std::uint64_t bin_ns = 0;      // classify the vertices, recompute the boxes: stream + winding + windows
    std::uint64_t broad_ns = 0;    // cells and box tests: broad_phase + lookup
    std::uint64_t narrow_ns = 0;   // exact decisions: decide
    std::uint64_t contacts_ns = 0; // canonical order
    std::uint64_t depth_ns = 0;    // penetrations
    std::uint64_t constraints_ns = 0; // constraints, without depth
    std::uint64_t pairs_ns = 0;       // which bodies touch
    std::uint64_t stream_ns = 0;      // read all positions: boxes, and which bodies moved
    std::uint64_t winding_ns = 0;     // rule out self-contacts by winding numbers; of the slowest worker
    std::uint64_t broad_phase_ns = 0; // regions in which bodies may be in contact
    std::uint64_t windows_ns = 0;     // bin the vertices that lie there
    std::uint64_t lookup_ns = 0;      // tetrahedra against these: box tests, and all that floats can decide
    std::uint64_t decide_ns = 0;      // decide the rest exactly; of the worker that took longest over it
    std::uint64_t edges_ns = 0;       // edges through faces, with either engine
    std::uint64_t margin_ns = 0;      // proximities and impacts, with either engine
    std::uint64_t shapes_ns = 0;      // contacts with shapes, with either engine
};

// A name and its field, in the order of vox_counter_view.
struct NamedCounter {
    const char* name;
    std::uint64_t Counters::*field;
};
struct NamedTime {
    const char* name;
    std::uint64_t Profile::*field;
};

inline constexpr NamedCounter named_counters[] = {
    {"bodies", &Counters::bodies},
    {"vertices", &Counters::vertices},
    {"tets", &Counters::tets},
    {"cells", &Counters::cells},
    {"entries", &Counters::entries},
    {"fullest_cell", &Counters::fullest_cell},
    {"visited_cells", &Counters::visited_cells},
    {"visited_entries", &Counters::visited_entries},
    {"candidates", &Counters::candidates},
    {"exact_tests", &Counters::exact_tests},
    {"contacts", &Counters::contacts},
    {"skipped_degenerate", &Counters::skipped_degenerate},
    {"carried_contacts", &Counters::carried_contacts},
    {"penetrations", &Counters::penetrations},
    {"leaving_edges", &Counters::leaving_edges},
    {"edge_tests", &Counters::edge_tests},
    {"closest_searches", &Counters::closest_searches},
    {"closest_tests", &Counters::closest_tests},
    {"disabled_bodies", &Counters::disabled_bodies},
    {"filtered", &Counters::filtered},
    {"cell_size_changes", &Counters::cell_size_changes},
    {"unknown_penetrations", &Counters::unknown_penetrations},
    {"carried_penetrations", &Counters::carried_penetrations},
    {"bodies_without_tets", &Counters::bodies_without_tets},
    {"edge_contacts", &Counters::edges},
    {"carried_edge_contacts", &Counters::carried_edges},
    {"edge_candidates", &Counters::edge_candidates},
    {"proximities", &Counters::proximities},
    {"carried_proximities", &Counters::carried_proximities},
    {"constraints", &Counters::constraints},
    {"constraints_left_out", &Counters::constraints_left_out},
    {"passages", &Counters::impacts},
    {"face_candidates", &Counters::face_candidates},
    {"shape_contacts", &Counters::shape_contacts},
    {"carried_shape_contacts", &Counters::carried_shape_contacts},
};
inline constexpr NamedTime named_times[] = {
    {"step_ns", &Profile::step_ns},
    {"bin_ns", &Profile::bin_ns},
    {"broad_ns", &Profile::broad_ns},
    {"narrow_ns", &Profile::narrow_ns},
    {"contacts_ns", &Profile::contacts_ns},
    {"depth_ns", &Profile::depth_ns},
    {"constraints_ns", &Profile::constraints_ns},
    {"pairs_ns", &Profile::pairs_ns},
    {"stream_ns", &Profile::stream_ns},
    {"winding_ns", &Profile::winding_ns},
    {"broad_phase_ns", &Profile::broad_phase_ns},
    {"windows_ns", &Profile::windows_ns},
    {"lookup_ns", &Profile::lookup_ns},
    {"decide_ns", &Profile::decide_ns},
    {"edges_ns", &Profile::edges_ns},
    {"margin_ns", &Profile::margin_ns},
    {"shapes_ns", &Profile::shapes_ns},
};

} // namespace vox
