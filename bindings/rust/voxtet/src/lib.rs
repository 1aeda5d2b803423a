#![doc = include_str!("../README.md")]
#![warn(missing_docs)]

mod callbacks;
mod cell_size;
mod error;
mod foreign;
mod grid;
#[cfg(feature = "io")]
pub mod io;
mod locator;
mod options;
mod view;

pub use callbacks::{LogLevel, TaskSystem};
pub use cell_size::{
    calibrate, minimise, suggest_cell_size, CostModel, MeshArrays, Minimum, SuggestOptions, Suggestion,
};
pub use error::{Error, ErrorCode, Result};
pub use foreign::{
    count_for, fit, suggest_for, tune, CellContent, CellLook, ForeignGrid, ForeignSuggestion, GridFit, KnownGrid,
    Primitives, TuneOptions, Tuning,
};
pub use grid::{step_grids, Failure, Grid, MeshInfo};
pub use locator::{Locator, QueryOptions};
pub use options::{Filter, GridOptions, Mesh, MeshOptions, Reference};
pub use view::{Contacts, Events, Pairs, View};

#[cfg(feature = "rayon")]
pub use callbacks::RayonTasks;

pub use voxtet_sys as sys;
pub use voxtet_sys::VOX_ALL_CORES as ALL_CORES;

/// A vertex inside a tetrahedron; see `vox_contact` in vox.h.
pub type Contact = sys::vox_contact;
/// How deep a vertex is and which way leads out. `state` is one of the constants in [`penetration_state`].
pub type Penetration = sys::vox_penetration;
/// Depth and direction in double.
pub type Depth = sys::vox_depth;
/// Two meshes that touch.
pub type Pair = sys::vox_pair;
/// A pair of meshes began to touch, still does, or ended. `kind` is one of the constants in [`touch`].
pub type TouchEvent = sys::vox_touch_event;
/// A vertex entered or left a mesh.
pub type ContactEvent = sys::vox_contact_event;
/// Geometry of a contact: where the vertex is, the closest part of the surface, how deep it is.
pub type Reading = sys::vox_reading;
/// A tetrahedron that contains a point.
pub type PointHit = sys::vox_point_hit;
/// The closest point of a surface, with a normal and a sign.
pub type ClosestHit = sys::vox_closest_hit;
/// A tetrahedron whose bounding box meets a box.
pub type BoxHit = sys::vox_box_hit;
/// A facet that a ray meets. `side` is one of the constants in [`side`].
pub type RayHit = sys::vox_ray_hit;
/// Lengths, areas, volumes and counts of meshes.
pub type GeometryStats = sys::vox_geometry_stats;
/// Nanoseconds of each piece of the engines' work, for their models, from [`calibrate`]; 0: as shipped with the library.
pub type CostWeights = [f64; sys::VOX_COST_WEIGHT_CAPACITY as usize];
/// What a run of a grid does at one cell size.
pub type GridWork = sys::vox_grid_work;
/// Nanoseconds of each piece of a grid's work.
pub type GridWeights = sys::vox_grid_weights;

/// Values of [`Penetration::state`].
pub mod penetration_state {
    pub use voxtet_sys::{
        VOX_PENETRATION_COINCIDENT as COINCIDENT, VOX_PENETRATION_CROSSING as CROSSING,
        VOX_PENETRATION_ENCLOSED as ENCLOSED, VOX_PENETRATION_PROPAGATED as PROPAGATED,
        VOX_PENETRATION_SURFACE as SURFACE, VOX_PENETRATION_UNKNOWN as UNKNOWN,
    };
}

/// Values of [`TouchEvent::kind`] and [`ContactEvent::kind`].
pub mod touch {
    pub use voxtet_sys::{VOX_TOUCH_BEGAN as BEGAN, VOX_TOUCH_ENDED as ENDED, VOX_TOUCH_PERSISTED as PERSISTED};
}

/// Values of [`RayHit::side`].
pub mod side {
    pub use voxtet_sys::{VOX_SIDE_ENTERS as ENTERS, VOX_SIDE_LEAVES as LEAVES, VOX_SIDE_NONE as NONE};
}

/// Parts of a [`Reading`], for [`Grid::prepare_readings`] and [`Reading::known`](sys::vox_reading::known).
pub mod reading {
    pub use voxtet_sys::{
        VOX_READING_DEPTH as DEPTH, VOX_READING_POSITION as POSITION, VOX_READING_SURFACE as SURFACE,
    };
    /// All of them.
    pub const ALL: u32 = POSITION | SURFACE | DEPTH;
}

/// What [`ForeignSuggestion::warnings`] combines; `vox_foreign_warnings` in vox.h explains each.
pub mod foreign_warning {
    pub use voxtet_sys::{
        VOX_FOREIGN_AT_LEAST_SIZE as AT_LEAST_SIZE, VOX_FOREIGN_BY_RULE as BY_RULE,
        VOX_FOREIGN_MODEL_DISAGREES as MODEL_DISAGREES, VOX_FOREIGN_NO_SIZE as NO_SIZE,
        VOX_FOREIGN_ONE_PLACE as ONE_PLACE, VOX_FOREIGN_OUT_OF_RANGE as OUT_OF_RANGE, VOX_FOREIGN_STOPPED as STOPPED,
        VOX_FOREIGN_TIMINGS_DISAGREE as TIMINGS_DISAGREE, VOX_FOREIGN_WEIGHTS_UNKNOWN as WEIGHTS_UNKNOWN,
    };
}

/// Version of the C library that is linked, as "major.minor.patch".
pub fn version() -> &'static str {
    build_info().split([' ', ',']).nth(1).unwrap_or("")
}

/// Compiler, instruction sets and options of that library.
pub fn build_info() -> &'static str {
    // SAFETY: static text, zero-terminated and ASCII.
    unsafe { std::ffi::CStr::from_ptr(sys::vox_build_info()) }.to_str().unwrap_or("")
}
