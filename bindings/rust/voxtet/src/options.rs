use std::fmt;
use std::sync::Arc;

use voxtet_sys as sys;

use crate::callbacks::{LogLevel, TaskSystem};
use crate::error::struct_size;

/// Names a mesh in its grid. A removed mesh's id is never used again, so a stale one is an error and nothing worse.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Mesh(pub(crate) u32);

impl Mesh {
    /// The number that contacts, pairs and events have in `body_a` and `body_b`.
    pub fn id(self) -> u32 {
        self.0
    }

    /// Of such a number.
    pub fn from_id(id: u32) -> Self {
        Self(id)
    }
}

impl fmt::Debug for Mesh {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "Mesh({})", self.0)
    }
}

impl PartialEq<u32> for Mesh {
    fn eq(&self, id: &u32) -> bool {
        self.0 == *id
    }
}

impl PartialEq<Mesh> for u32 {
    fn eq(&self, mesh: &Mesh) -> bool {
        *self == mesh.0
    }
}

/// Which algorithm runs. Contacts do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// Fast, or reference if a storage is requested.
    #[default]
    Auto,
    /// The paper's algorithm as printed.
    Reference,
    /// Tiles of tetrahedra against windows of cells, with SIMD.
    Fast,
}

/// How the reference engine stores cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Storage {
    /// The engine's choice.
    #[default]
    Auto,
    /// Unbounded space, hashed.
    Hashed,
    /// One list for each cell of a box.
    Dense,
}

pub(crate) type LogFunction = Box<dyn Fn(LogLevel, &str) + Send + Sync>;

/// Settings of a grid; `vox_grid_desc` in vox.h explains each. Fields that are not named have their defaults:
/// `GridOptions { workers: 0, ..Default::default() }`.
pub struct GridOptions {
    /// Which algorithm runs.
    pub engine: Engine,
    /// How the reference engine stores cells.
    pub storage: Storage,
    /// Edge length of a cell; 0: the library chooses it.
    pub cell_size: f64,
    /// World box for dense storage, lowest and highest corner; all zero: the box of all positions.
    pub world: [[f64; 3]; 2],
    /// Most bytes the grid may hold; 0: no limit.
    pub byte_budget: u64,
    /// Buckets of the hash table; 0: twice the number of vertices.
    pub hash_table_size: u64,
    /// Threads of a step; 0: one per core. Not used with a task system, which says how many it has.
    pub workers: u32,
    /// Whether a step finds penetrations.
    pub penetrations: bool,
    /// Whether it reports events of single vertices.
    pub contact_events: bool,
    /// Whether meshes with NaN or infinite coordinates are left out of a step instead of failing it.
    pub skip_bad_bodies: bool,
    /// Most searches for a closest point in a step; 0: no limit.
    pub closest_budget: u64,
    /// Receives warnings and notes, a line each.
    pub log: Option<LogFunction>,
    /// Runs the tasks of a step instead of the built-in threads.
    pub tasks: Option<Arc<dyn TaskSystem>>,
}

impl Default for GridOptions {
    fn default() -> Self {
        let desc = defaults();
        Self {
            engine: Engine::Auto,
            storage: Storage::Auto,
            cell_size: desc.cell_size,
            world: [desc.world_min, desc.world_max],
            byte_budget: desc.byte_budget,
            hash_table_size: desc.hash_table_size,
            workers: desc.worker_count,
            penetrations: desc.flags & sys::VOX_GRID_PENETRATIONS != 0,
            contact_events: desc.flags & sys::VOX_GRID_CONTACT_EVENTS != 0,
            skip_bad_bodies: desc.flags & sys::VOX_GRID_SKIP_BAD_BODIES != 0,
            closest_budget: desc.closest_budget,
            log: None,
            tasks: None,
        }
    }
}

impl GridOptions {
    pub(crate) fn flags(&self) -> u32 {
        (if self.penetrations { sys::VOX_GRID_PENETRATIONS } else { 0 })
            | (if self.contact_events { sys::VOX_GRID_CONTACT_EVENTS } else { 0 })
            | (if self.skip_bad_bodies { sys::VOX_GRID_SKIP_BAD_BODIES } else { 0 })
    }

    /// Without callbacks.
    pub(crate) fn desc(&self) -> sys::vox_grid_desc {
        let mut desc = defaults();
        desc.engine = match self.engine {
            Engine::Auto => sys::VOX_ENGINE_AUTO,
            Engine::Reference => sys::VOX_ENGINE_REFERENCE,
            Engine::Fast => sys::VOX_ENGINE_FAST,
        };
        desc.storage = match self.storage {
            Storage::Auto => sys::VOX_STORAGE_AUTO,
            Storage::Hashed => sys::VOX_STORAGE_HASHED,
            Storage::Dense => sys::VOX_STORAGE_DENSE,
        };
        desc.cell_size = self.cell_size;
        [desc.world_min, desc.world_max] = self.world;
        desc.byte_budget = self.byte_budget;
        desc.hash_table_size = self.hash_table_size;
        desc.worker_count = self.workers;
        desc.flags = self.flags();
        desc.closest_budget = self.closest_budget;
        desc
    }
}

fn defaults() -> sys::vox_grid_desc {
    // SAFETY: a struct of numbers and null pointers, of its own size. It cannot fail for that.
    unsafe {
        let mut desc = std::mem::zeroed();
        sys::vox_grid_desc_init(&mut desc, struct_size::<sys::vox_grid_desc>());
        desc
    }
}

/// What a mesh does not collide with; `vox_filter` in vox.h explains each field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// Meshes with the same group other than 0 collide if it is positive, and do not if it is negative.
    pub group: i32,
    /// All others collide if the category of each has a bit in common with the mask of the other.
    pub category: u64,
    /// See `category`.
    pub mask: u64,
    /// Whether vertices of the mesh inside its own tetrahedra are contacts.
    pub self_collision: bool,
    /// Self-contact skips tetrahedra with a corner within this many edges of the vertex.
    pub self_rings: u32,
    /// Self-contact skips tetrahedra closer than this in the rest pose.
    pub self_rest_distance: f64,
    /// Which contacts get a penetration.
    pub penetration_mask: u64,
}

impl Default for Filter {
    fn default() -> Self {
        // SAFETY: a struct of numbers, of its own size. It cannot fail for that.
        Self::of(&unsafe {
            let mut filter = std::mem::zeroed();
            sys::vox_filter_init(&mut filter, struct_size::<sys::vox_filter>());
            filter
        })
    }
}

impl Filter {
    pub(crate) fn of(filter: &sys::vox_filter) -> Self {
        Self {
            group: filter.group,
            category: filter.category,
            mask: filter.mask,
            self_collision: filter.self_collision != 0,
            self_rings: filter.self_rings,
            self_rest_distance: filter.self_rest_distance,
            penetration_mask: filter.penetration_mask,
        }
    }

    pub(crate) fn to_c(self) -> sys::vox_filter {
        sys::vox_filter {
            struct_size: struct_size::<sys::vox_filter>(),
            group: self.group,
            category: self.category,
            mask: self.mask,
            self_collision: self.self_collision.into(),
            self_rings: self.self_rings,
            self_rest_distance: self.self_rest_distance,
            penetration_mask: self.penetration_mask,
        }
    }
}

/// Of a mesh, beside its arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshOptions<'arrays, T> {
    /// Any number of the caller's, which comes back with pairs, events and readings.
    pub user_data: u64,
    /// What the mesh does not collide with.
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
pub trait Scalar: Copy + sealed::Sealed + 'static {
    #[doc(hidden)]
    const FORMAT: sys::vox_format;
}

impl Scalar for f32 {
    const FORMAT: sys::vox_format = sys::VOX_FORMAT_FLOAT;
}

impl Scalar for f64 {
    const FORMAT: sys::vox_format = sys::VOX_FORMAT_DOUBLE;
}
