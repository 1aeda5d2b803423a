use std::fmt;
use std::sync::Arc;

use voxtet_sys as sys;

use crate::callbacks::{LogLevel, TaskSystem};
use crate::error::sized;
use crate::grid::or_null;
use crate::CostWeights;

/// Names a mesh or a rigid shape in its grid. A removed one's id is never used again, so a stale one is an error and nothing worse.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Body(pub(crate) u32);

impl Body {
    /// The number that contacts, pairs and constraints have in `body_a` and `body_b`.
    pub fn id(self) -> u32 {
        self.0
    }

    /// Of such a number.
    pub fn from_id(id: u32) -> Self {
        Self(id)
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "Body({})", self.0)
    }
}

impl PartialEq<u32> for Body {
    fn eq(&self, id: &u32) -> bool {
        self.0 == *id
    }
}

impl PartialEq<Body> for u32 {
    fn eq(&self, mesh: &Body) -> bool {
        *self == mesh.0
    }
}

/// The paper's engine, to compare with; `vox_reference_desc` in vox_cell_size.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    /// One list for each cell of a box, instead of a hash table.
    pub dense: bool,
    /// The paper's hash, instead of a better one.
    pub paper_hash: bool,
    /// Buckets of the hash table; 0: twice the number of vertices.
    pub hash_table_size: u64,
    /// The box of dense cells, lowest and highest corner; all zero: the box of all positions.
    pub world: [[f64; 3]; 2],
    /// What it chooses a cell size by; `None`: those shipped with the library.
    pub weights: Option<CostWeights>,
}

pub(crate) fn weights_to_c(ns: CostWeights) -> sys::vox_cost_weights {
    sys::vox_cost_weights { ns, ..sized!(sys::vox_cost_weights) }
}

impl Reference {
    pub(crate) fn to_c(self, weights: &Option<sys::vox_cost_weights>) -> sys::vox_reference_desc {
        let [world_min, world_max] = self.world;
        sys::vox_reference_desc {
            flags: (u32::from(self.dense) * sys::VOX_REFERENCE_DENSE)
                | (u32::from(self.paper_hash) * sys::VOX_REFERENCE_PAPER_HASH),
            hash_table_size: self.hash_table_size,
            world_min,
            world_max,
            weights: or_null(weights),
            ..sized!(sys::vox_reference_desc)
        }
    }
}

pub(crate) type LogFunction = Box<dyn Fn(LogLevel, &str) + Send + Sync>;

/// Settings of a grid; `vox_grid_desc` in vox.h explains each. Fields that are not named have their defaults:
/// `GridOptions { workers: 4, ..Default::default() }`.
#[derive(Default)]
pub struct GridOptions {
    /// The paper's engine instead of the fast one, and how it stores cells. Contacts do not depend on it.
    pub reference: Option<Reference>,
    /// Edge length of a cell; 0: the library chooses it.
    pub cell_size: f64,
    /// Most bytes the grid may hold; 0: 4 GiB; `u64::MAX`: no limit.
    pub byte_budget: u64,
    /// Threads of a step; 0: one; [`ALL_CORES`](crate::ALL_CORES): one per core. Not used with a task system, which says
    /// how many it has.
    pub workers: u32,
    /// See [`Grid::set_margin`](crate::Grid::set_margin).
    pub margin: f64,
    /// Most constraints of a pair, the deepest one first, then spread; 0: all. A snapshot keeps it.
    pub max_constraints_per_pair: u32,
    /// Whether every step finds constraints.
    pub constraints: bool,
    /// Whether it also finds edges that pass through faces. Experimental.
    pub edges: bool,
    /// Whether meshes with NaN or infinite coordinates are left out of a step instead of failing it.
    pub skip_bad_bodies: bool,
    /// Receives warnings and notes, a line each.
    pub log: Option<LogFunction>,
    /// Runs the tasks of a step instead of the built-in threads.
    pub tasks: Option<Arc<dyn TaskSystem>>,
}

pub(crate) fn grid_flags(constraints: bool, edges: bool, skip_bad_bodies: bool) -> u32 {
    (u32::from(constraints) * sys::VOX_GRID_CONSTRAINTS)
        | (u32::from(edges) * sys::VOX_GRID_EDGES)
        | (u32::from(skip_bad_bodies) * sys::VOX_GRID_SKIP_BAD_BODIES)
}

/// How the depth of a vertex in a mesh is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthMethod {
    /// Smooth along the surface: for response.
    #[default]
    Consistent = sys::VOX_DEPTH_METHOD_CONSISTENT as isize,
    /// To the closest point of the surface.
    Closest = sys::VOX_DEPTH_METHOD_CLOSEST as isize,
    /// Not at all.
    None = sys::VOX_DEPTH_METHOD_NONE as isize,
}

/// Which constraints to find: by default all. `vox_constraint_desc` in vox.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintOptions {
    /// How depths are found.
    pub method: DepthMethod,
    /// Only pairs of this mesh.
    pub a: Option<Body>,
    /// Only its pair with `a`.
    pub b: Option<Body>,
    /// Only pairs in which the category of a mesh has a bit in common with it; 0: all.
    pub mask: u64,
    /// Most searches for a closest point; 0: no limit.
    pub closest_budget: u64,
}

/// What a mesh collides with; `vox_filter` in vox.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filter {
    /// Whether vertices of the mesh inside its own tetrahedra are contacts.
    pub self_collision: bool,
    /// Whether the mesh has contacts and pairs, but no constraints.
    pub sensor: bool,
    /// Meshes with the same group other than 0 collide if it is positive, and do not if it is negative.
    pub group: i32,
    /// All others collide if the category of each has a bit in common with the mask of the other. 0 stands for 1.
    pub category: u64,
    /// See `category`. 0 stands for all bits.
    pub mask: u64,
    /// Meshes in different worlds never collide.
    pub world: u32,
    /// Self-contact skips tetrahedra with a corner within this many edges of the vertex.
    pub self_rings: u32,
    /// Self-contact skips tetrahedra closer than this in the rest pose.
    pub self_rest_distance: f64,
}

impl Filter {
    pub(crate) fn of(filter: &sys::vox_filter) -> Self {
        let &sys::vox_filter { flags, group, category, mask, world, self_rings, self_rest_distance } = filter;
        let self_collision = flags & sys::VOX_FILTER_SELF_COLLISION != 0;
        let sensor = flags & sys::VOX_FILTER_SENSOR != 0;
        Self { self_collision, sensor, group, category, mask, world, self_rings, self_rest_distance }
    }

    pub(crate) fn to_c(self) -> sys::vox_filter {
        let Self { self_collision, sensor, group, category, mask, world, self_rings, self_rest_distance } = self;
        let flags =
            (u32::from(self_collision) * sys::VOX_FILTER_SELF_COLLISION) | (u32::from(sensor) * sys::VOX_FILTER_SENSOR);
        sys::vox_filter { flags, group, category, mask, world, self_rings, self_rest_distance }
    }
}

/// Of a mesh, beside its arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshOptions<'arrays, T> {
    /// Any number of the caller's, which comes back with pairs and constraints.
    pub user_data: u64,
    /// What the mesh collides with.
    pub filter: Filter,
    /// Positions of the rest pose, for [`Filter::self_rest_distance`].
    pub rest_positions: Option<&'arrays [[T; 3]]>,
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Numbers that positions can be made of.
pub trait Scalar: Copy + Into<f64> + sealed::Sealed + 'static {
    #[doc(hidden)]
    const FORMAT: sys::vox_format;
}

impl Scalar for f32 {
    const FORMAT: sys::vox_format = sys::VOX_FORMAT_FLOAT;
}

impl Scalar for f64 {
    const FORMAT: sys::vox_format = sys::VOX_FORMAT_DOUBLE;
}
