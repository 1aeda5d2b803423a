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
mod shape;

pub use callbacks::{LogLevel, TaskSystem};
pub use cell_size::{
    calibrate, measure_geometry, minimise, suggest_cell_size, CellSizeOptions, CellSizeResult, CellSizeRule, CostModel,
    CostTerm, MeshArrays,
};
pub use error::{Error, ErrorCode, Result};
pub use foreign::{tune, CellsKept, CellsQueried, CellsStored, ForeignGrid, KnownGrid, Primitives, TuneOptions};
pub use grid::{step_grids, BodyInfo, Failure, Grid};
pub use locator::{Locator, QueryOptions};
pub use options::{Body, ConstraintOptions, DepthMethod, Filter, GridOptions, MeshOptions, Reference};
pub use shape::{polyline, Shape, ShapeOptions};

#[cfg(feature = "rayon")]
pub use callbacks::RayonTasks;

pub use voxtet_sys as sys;
pub use voxtet_sys::{VOX_ALL_CORES as ALL_CORES, VOX_NONE as NONE};

/// A vertex inside a tetrahedron; see `vox_contact` in vox.h.
pub type Contact = sys::vox_contact;
/// Two meshes that touch, or touched in the step before. `state` is one of the constants in [`pair_state`].
pub type Pair = sys::vox_pair;
/// What a solver needs to keep two points apart; see `vox_constraint` in vox.h. `kind` is one of the constants in
/// [`constraint_kind`], `state` of those in [`depth_state`], and `previous` is [`NONE`] if it is new.
pub type Constraint = sys::vox_constraint;
/// Where a point is. `state` is one of the constants in [`location_state`].
pub type Location = sys::vox_location;
/// The part of a segment that lies in one tetrahedron; its facets are [`NONE`] where it begins or ends within.
pub type TrackPiece = sys::vox_track_piece;
/// A tetrahedron that a triangle meets, with its edges that the triangle cuts.
pub type TriangleHit = sys::vox_triangle_hit;
/// A tetrahedron that contains a point.
pub type PointHit = sys::vox_point_hit;
/// The closest point of a surface, with a normal and a sign.
pub type ClosestHit = sys::vox_closest_hit;
/// A tetrahedron whose bounding box meets a box.
pub type BoxHit = sys::vox_box_hit;
/// A facet that a ray meets. `side` is one of the constants in [`side`].
pub type RayHit = sys::vox_ray_hit;
/// Lengths, areas, volumes and counts of meshes.
pub type Geometry = sys::vox_geometry;
/// Nanoseconds of each piece of the engines' work, for their models, from [`calibrate`]; 0: as shipped with the library.
pub type CostWeights = [f64; sys::VOX_COST_WEIGHT_CAPACITY as usize];
/// A point of a cost curve.
pub type CostSample = sys::vox_cost_sample;
/// A run at one cell size, and how long it took.
pub type Timing = sys::vox_timing;
/// How often a run of a foreign grid does what.
pub type ForeignCounts = sys::vox_foreign_counts;
/// How many nanoseconds a foreign grid takes for each kind of work.
pub type ForeignWeights = sys::vox_foreign_weights;

/// Values of [`Pair::state`].
pub mod pair_state {
    pub use voxtet_sys::{
        VOX_PAIR_BEGAN as BEGAN, VOX_PAIR_ENDED as ENDED, VOX_PAIR_NEAR as NEAR, VOX_PAIR_PERSISTED as PERSISTED,
    };
}

/// Values of [`Constraint::kind`].
pub mod constraint_kind {
    pub use voxtet_sys::{
        VOX_CONSTRAINT_EDGE as EDGE, VOX_CONSTRAINT_IMPACT as IMPACT, VOX_CONSTRAINT_INSIDE as INSIDE,
        VOX_CONSTRAINT_PROXIMITY as PROXIMITY,
    };
}

/// Values of [`BodyInfo::shape`].
pub mod shape_kind {
    pub use voxtet_sys::{
        VOX_SHAPE_BOX as BOX, VOX_SHAPE_CAPSULE as CAPSULE, VOX_SHAPE_CYLINDER as CYLINDER, VOX_SHAPE_FIELD as FIELD,
        VOX_SHAPE_HALF_SPACE as HALF_SPACE, VOX_SHAPE_HEIGHTFIELD as HEIGHTFIELD, VOX_SHAPE_NONE as NONE,
        VOX_SHAPE_SHEET as SHEET, VOX_SHAPE_SOLID as SOLID, VOX_SHAPE_SPHERE as SPHERE,
    };
}

/// Values of [`Constraint::state`].
pub mod depth_state {
    pub use voxtet_sys::{
        VOX_DEPTH_AMBIGUOUS as AMBIGUOUS, VOX_DEPTH_CLOSEST as CLOSEST, VOX_DEPTH_PLANE as PLANE,
        VOX_DEPTH_PROPAGATED as PROPAGATED, VOX_DEPTH_SURFACE as SURFACE, VOX_DEPTH_TOUCHING as TOUCHING,
        VOX_DEPTH_UNKNOWN as UNKNOWN,
    };
}

/// Values of [`Location::state`].
pub mod location_state {
    pub use voxtet_sys::{VOX_LOCATION_INSIDE as INSIDE, VOX_LOCATION_NONE as NONE, VOX_LOCATION_OUTSIDE as OUTSIDE};
}

/// Values of [`RayHit::side`].
pub mod side {
    pub use voxtet_sys::{VOX_SIDE_ENTERS as ENTERS, VOX_SIDE_LEAVES as LEAVES, VOX_SIDE_NONE as NONE};
}

/// What [`CellSizeResult::warnings`] combines; `vox_cell_size_warnings` in vox_cell_size.h explains each.
pub mod cell_size_warning {
    pub use voxtet_sys::{
        VOX_CELL_SIZE_AT_MINIMUM as AT_MINIMUM, VOX_CELL_SIZE_BY_RULE as BY_RULE,
        VOX_CELL_SIZE_FROM_SPACING as FROM_SPACING, VOX_CELL_SIZE_GUESSED_WEIGHTS as GUESSED_WEIGHTS,
        VOX_CELL_SIZE_MODEL_DISAGREES as MODEL_DISAGREES, VOX_CELL_SIZE_ONE_PLACE as ONE_PLACE,
        VOX_CELL_SIZE_OUT_OF_RANGE as OUT_OF_RANGE, VOX_CELL_SIZE_STOPPED as STOPPED,
        VOX_CELL_SIZE_TIMINGS_DISAGREE as TIMINGS_DISAGREE,
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
