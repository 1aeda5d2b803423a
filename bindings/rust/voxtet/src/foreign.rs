//! The cell size of grids that are not this library's.

use std::marker::PhantomData;
use std::ptr::null;

use voxtet_sys as sys;

use crate::cell_size::{Call, CellSizeResult};
use crate::error::{check, sized};
use crate::grid::{or_null, pointer, positions_to_c};
use crate::options::Scalar;
use crate::{Error, ErrorCode, ForeignCounts, ForeignWeights, Result, Timing};

/// The cells that store a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellsStored {
    /// As in the known grid, else `Box`.
    #[default]
    Default = sys::VOX_CELLS_STORED_DEFAULT as isize,
    /// All cells that its box meets.
    Box = sys::VOX_CELLS_STORED_BOX as isize,
    /// The cell that contains the centre of its box.
    Centre = sys::VOX_CELLS_STORED_CENTRE as isize,
}

/// The cells that a query visits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellsQueried {
    /// As in the known grid, else `Box`.
    #[default]
    Default = sys::VOX_CELLS_QUERIED_DEFAULT as isize,
    /// All cells that its box meets.
    Box = sys::VOX_CELLS_QUERIED_BOX as isize,
    /// The cell that contains its centre, and the 26 cells around it. Only with [`CellsStored::Centre`].
    Queried27 = sys::VOX_CELLS_QUERIED_27 as isize,
    /// None: every pair within a cell is reported.
    Pairs = sys::VOX_CELLS_QUERIED_PAIRS as isize,
}

/// The cells that exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellsKept {
    /// As in the known grid, else `Occupied`.
    #[default]
    Default = sys::VOX_CELLS_KEPT_DEFAULT as isize,
    /// Those that store something.
    Occupied = sys::VOX_CELLS_KEPT_OCCUPIED as isize,
    /// All cells in the box of the stored primitives.
    Dense = sys::VOX_CELLS_KEPT_DENSE as isize,
}

/// Grids whose layout and weights are known; `vox_known_grid` in vox_cell_size.h explains each.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KnownGrid {
    #[default]
    None = sys::VOX_KNOWN_GRID_NONE as isize,
    Sorted = sys::VOX_KNOWN_GRID_SORTED as isize,
    Hashed = sys::VOX_KNOWN_GRID_HASHED as isize,
    Warp = sys::VOX_KNOWN_GRID_WARP as isize,
    Ipc = sys::VOX_KNOWN_GRID_IPC as isize,
    IpcPairs = sys::VOX_KNOWN_GRID_IPC_PAIRS as isize,
    Vtk = sys::VOX_KNOWN_GRID_VTK as isize,
    Pbat = sys::VOX_KNOWN_GRID_PBAT as isize,
    PointVoxels = sys::VOX_KNOWN_GRID_POINT_VOXELS as isize,
    Numpy = sys::VOX_KNOWN_GRID_NUMPY as isize,
}

/// What a grid stores, or what queries it. Of each primitive only the box counts.
#[derive(Clone, Copy)]
pub struct Primitives<'arrays> {
    desc: sys::vox_primitives,
    arrays: PhantomData<&'arrays [u32]>,
}

// SAFETY: it points to shared slices.
unsafe impl Send for Primitives<'_> {}
unsafe impl Sync for Primitives<'_> {}

impl<'arrays> Primitives<'arrays> {
    fn new<T: Scalar>(r#type: sys::vox_primitive_type, positions: &'arrays [[T; 3]], count: usize) -> Self {
        let (positions, count) = (positions_to_c(positions), count as u64);
        let desc = sys::vox_primitives { r#type, positions, count, ..sized!(sys::vox_primitives) };
        Self { desc, arrays: PhantomData }
    }

    fn indexed<T: Scalar, const N: usize>(
        type_of: sys::vox_primitive_type,
        positions: &'arrays [[T; 3]],
        indices: &'arrays [[u32; N]],
    ) -> Self {
        let mut primitives = Self::new(type_of, positions, indices.len());
        primitives.desc.indices = pointer(indices).cast();
        primitives
    }

    /// Points, or with a radius balls.
    pub fn points<T: Scalar>(positions: &'arrays [[T; 3]]) -> Self {
        Self::new(sys::VOX_PRIMITIVE_POINT, positions, positions.len())
    }

    /// Edges between vertices.
    pub fn edges<T: Scalar>(positions: &'arrays [[T; 3]], edges: &'arrays [[u32; 2]]) -> Self {
        Self::indexed(sys::VOX_PRIMITIVE_EDGE, positions, edges)
    }

    /// Triangles of vertices.
    pub fn triangles<T: Scalar>(positions: &'arrays [[T; 3]], triangles: &'arrays [[u32; 3]]) -> Self {
        Self::indexed(sys::VOX_PRIMITIVE_TRIANGLE, positions, triangles)
    }

    /// Tetrahedra of vertices.
    pub fn tets<T: Scalar>(positions: &'arrays [[T; 3]], tets: &'arrays [[u32; 4]]) -> Self {
        Self::indexed(sys::VOX_PRIMITIVE_TET, positions, tets)
    }

    /// Boxes along the axes, by two opposite corners each.
    pub fn boxes<T: Scalar>(corners: &'arrays [[[T; 3]; 2]]) -> Self {
        // SAFETY: arrays have no gaps.
        let positions = unsafe { std::slice::from_raw_parts(corners.as_ptr().cast(), 2 * corners.len()) };
        Self::new::<T>(sys::VOX_PRIMITIVE_BOX, positions, corners.len())
    }

    /// All are larger by this, in addition to radii of their own.
    pub fn with_radius(mut self, radius: f64) -> Self {
        self.desc.radius = radius;
        self
    }

    /// Each is larger by its radius. Fails unless there are as many as primitives.
    pub fn with_radii<T: Scalar>(mut self, radii: &'arrays [T]) -> Result<Self> {
        if radii.len() as u64 != self.desc.count {
            let text = format!("{} radii, expected {}", radii.len(), self.desc.count);
            return Err(Error::new(ErrorCode::InvalidArgument, text));
        }
        self.desc.radii = pointer(radii).cast();
        self.desc.radius_format = T::FORMAT;
        Ok(self)
    }
}

/// A uniform grid of another library. What is `Default`, or 0, is as `known` has it.
#[derive(Clone, Copy)]
pub struct ForeignGrid<'arrays> {
    /// The grid that it is like.
    pub known: KnownGrid,
    /// The cells that store a primitive.
    pub cells_stored: CellsStored,
    /// The cells that a query visits.
    pub cells_queried: CellsQueried,
    /// The cells that exist.
    pub cells_kept: CellsKept,
    /// The primitives in cells.
    pub stored: Primitives<'arrays>,
    /// The queries; `None`: the stored primitives query each other.
    pub querying: Option<Primitives<'arrays>>,
    /// Boxes of queries are larger by this on all sides.
    pub radius: f64,
    /// The smallest cell size that gives right answers; 0: any, or what 27 cells demand.
    pub min_cell_size: f64,
    /// The zone is where the cost is at most 1 + this times the least; 0: 0.05.
    pub zone_loss: f64,
    /// Nanoseconds of each kind of work.
    pub weights: ForeignWeights,
}

impl<'arrays> ForeignGrid<'arrays> {
    /// A grid like a known one.
    pub fn new(known: KnownGrid, stored: Primitives<'arrays>) -> Self {
        Self {
            known,
            cells_stored: CellsStored::Default,
            cells_queried: CellsQueried::Default,
            cells_kept: CellsKept::Default,
            stored,
            querying: None,
            radius: 0.0,
            min_cell_size: 0.0,
            zone_loss: 0.0,
            weights: sized!(sys::vox_foreign_grid).weights,
        }
    }

    /// As C has it, for as long as this lives.
    fn desc(&self) -> sys::vox_foreign_grid {
        sys::vox_foreign_grid {
            known: self.known as sys::vox_known_grid,
            cells_stored: self.cells_stored as sys::vox_cells_stored,
            cells_queried: self.cells_queried as sys::vox_cells_queried,
            cells_kept: self.cells_kept as sys::vox_cells_kept,
            stored: &self.stored.desc,
            querying: self.querying.as_ref().map_or(null(), |querying| &querying.desc),
            radius: self.radius,
            min_cell_size: self.min_cell_size,
            zone_loss: self.zone_loss,
            weights: self.weights,
            ..sized!(sys::vox_foreign_grid)
        }
    }

    /// The cell size with the least cost.
    pub fn suggest(&self) -> Result<CellSizeResult> {
        // SAFETY: here and below, a description of slices that live during the call.
        CellSizeResult::ask(|out| check(unsafe { sys::vox_foreign_grid_suggest(&self.desc(), out) }))
    }

    /// How often a run does what at a cell size.
    pub fn count(&self, cell_size: f64) -> Result<ForeignCounts> {
        let mut counts = ForeignCounts { stored: 0.0, visits: 0.0, empty: 0.0, reads: 0.0, occupied: 0.0, cells: 0.0 };
        check(unsafe { sys::vox_foreign_grid_count(&self.desc(), cell_size, &mut counts) })?;
        Ok(counts)
    }

    /// The weights, and the best cell size, from timings at three cell sizes or more.
    pub fn fit(&self, timings: &[Timing]) -> Result<CellSizeResult> {
        let count = timings.len() as u64;
        CellSizeResult::ask(|out| {
            check(unsafe { sys::vox_foreign_grid_fit(&self.desc(), pointer(timings), count, out) })
        })
    }
}

/// How to tune; `vox_tune_desc` in vox_cell_size.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TuneOptions {
    /// 3 to 32; 0: 7.
    pub max_runs: u32,
    /// Cell sizes to try; both 0: an eighth to eight times the first.
    pub min: f64,
    /// See `min`.
    pub max: f64,
    /// The cell size to begin with; 0: what [`ForeignGrid::suggest`] says. Must be set where no grid is described.
    pub first: f64,
    /// Stops when the expected loss is below this; 0: 0.02.
    pub wanted_loss: f64,
}

/// The best cell size of a grid, by running it. `run` runs it once at a cell size and returns how many seconds that took:
/// infinity if it cannot run at this size, NaN to stop. A panic of it goes on here.
pub fn tune(
    grid: Option<&ForeignGrid<'_>>,
    mut run: impl FnMut(f64) -> f64,
    options: TuneOptions,
) -> Result<CellSizeResult> {
    let TuneOptions { max_runs, min, max, first, wanted_loss } = options;
    let desc = sys::vox_tune_desc { max_runs, min, max, first, wanted_loss, ..sized!(sys::vox_tune_desc) };
    let grid = grid.map(ForeignGrid::desc);
    CellSizeResult::ask(|out| {
        Call::make(&mut run, |call, user| unsafe {
            sys::vox_foreign_grid_tune(or_null(&grid), &desc, Some(call), user, out)
        })
    })
}
