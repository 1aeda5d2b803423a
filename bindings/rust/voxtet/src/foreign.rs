//! The cell size of grids that are not this library's.

use std::ffi::{c_char, CStr};
use std::marker::PhantomData;
use std::ptr::null;

use voxtet_sys as sys;

use crate::cell_size::{samples, terms, Call};
use crate::error::{check, sized};
use crate::grid::{pointer, positions_to_c};
use crate::options::Scalar;
use crate::{Error, ErrorCode, GridWeights, GridWork, Result};

/// Which cells hold a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellContent {
    /// The one with the centre of its box.
    Centres = sys::VOX_CELLS_HOLD_CENTRES as isize,
    /// All that its box meets.
    Boxes = sys::VOX_CELLS_HOLD_BOXES as isize,
}

/// Which cells a primitive that asks looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellLook {
    /// Those that its box meets.
    Box = sys::VOX_LOOK_BOX as isize,
    /// The one with the centre of its box, and the 26 around.
    Around = sys::VOX_LOOK_AROUND as isize,
    /// Nobody asks: what is in a cell is paired.
    Pairs = sys::VOX_LOOK_PAIRS as isize,
}

/// Grids that weights are shipped for; `vox_known_grid` in vox.h explains each.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KnownGrid {
    #[default]
    Any = sys::VOX_KNOWN_GRID_ANY as isize,
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

/// What a grid holds, or what asks it. Of each primitive only the box counts.
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

/// A uniform grid that is not this library's. What is `None` is as `known` has it.
#[derive(Clone, Copy)]
pub struct ForeignGrid<'arrays> {
    /// What is put into cells.
    pub held: Primitives<'arrays>,
    /// What asks; `None`: those held ask themselves.
    pub asking: Option<Primitives<'arrays>>,
    /// The grid that it is like.
    pub known: KnownGrid,
    /// Which cells hold a primitive.
    pub content: Option<CellContent>,
    /// Which cells one that asks looks at.
    pub look: Option<CellLook>,
    /// Whether there is a list for each cell of the box of all that is held.
    pub dense: Option<bool>,
    /// Nanoseconds of each piece of work.
    pub weights: Option<GridWeights>,
    /// Boxes that ask are larger by this on all sides.
    pub radius: f64,
    /// The smallest cell size that gives right answers; 0: follows from `look`.
    pub least_cell_size: f64,
    /// The zone is where the cost is at most 1 + this times its minimum; 0: 0.05.
    pub zone_loss: f64,
}

impl<'arrays> ForeignGrid<'arrays> {
    /// A grid like a known one.
    pub fn new(known: KnownGrid, held: Primitives<'arrays>) -> Self {
        Self {
            held,
            asking: None,
            known,
            content: None,
            look: None,
            dense: None,
            weights: None,
            radius: 0.0,
            least_cell_size: 0.0,
            zone_loss: 0.0,
        }
    }

    /// Makes a call with the description as C has it.
    fn described<R>(&self, call: impl FnOnce(&sys::vox_foreign_grid) -> Result<R>) -> Result<R> {
        let mut desc = sized!(sys::vox_foreign_grid);
        // SAFETY: a struct of its own size.
        check(unsafe { sys::vox_foreign_grid_set_known(&mut desc, self.known as sys::vox_known_grid) })?;
        desc.held = &self.held.desc;
        desc.asking = self.asking.as_ref().map_or(null(), |asking| &asking.desc);
        desc.content = self.content.map_or(desc.content, |content| content as sys::vox_cell_content);
        desc.look = self.look.map_or(desc.look, |look| look as sys::vox_cell_look);
        desc.flags = self.dense.map_or(desc.flags, |dense| if dense { sys::VOX_FOREIGN_DENSE } else { 0 });
        desc.weights = self.weights.unwrap_or(desc.weights);
        desc.radius = self.radius;
        desc.least_cell_size = self.least_cell_size;
        desc.zone_loss = self.zone_loss;
        call(&desc)
    }
}

/// A cell size for a grid, and why. Costs are nanoseconds of a run.
#[derive(Clone, Debug)]
pub struct ForeignSuggestion(Box<sys::vox_foreign_suggestion>);

/// Weights from timings, and the cell size that they lead to. Costs are seconds of a run.
#[derive(Clone, Debug)]
pub struct GridFit(Box<sys::vox_grid_fit>);

/// What tuning found. Costs are seconds of a run.
#[derive(Clone, Debug)]
pub struct Tuning(Box<sys::vox_tuning>);

/// What the three have in common.
macro_rules! answer {
    ($answer:ident, $raw:ty) => {
        impl $answer {
            fn ask(call: impl FnOnce(*mut $raw) -> Result<()>) -> Result<Self> {
                let mut found = Box::new(sized!($raw));
                call(&mut *found)?;
                Ok(Self(found))
            }

            /// The best cell size.
            pub fn cell_size(&self) -> f64 {
                self.0.cell_size
            }

            /// Smallest and largest cell size that are nearly as good.
            pub fn zone(&self) -> (f64, f64) {
                (self.0.zone_min, self.0.zone_max)
            }

            /// The weights that were used, or found.
            pub fn weights(&self) -> GridWeights {
                self.0.weights
            }

            /// What it was based on: constants of [`foreign_warning`](crate::foreign_warning), combined with |.
            pub fn warnings(&self) -> u32 {
                self.0.warnings
            }

            /// The same in words, with numbers.
            pub fn note(&self) -> String {
                text(&self.0.note)
            }

            /// Cell sizes and their costs.
            pub fn curve(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
                samples(&self.0.curve[..self.0.curve_count as usize])
            }

            /// All fields.
            pub fn raw(&self) -> &$raw {
                &self.0
            }
        }
    };
}
answer!(ForeignSuggestion, sys::vox_foreign_suggestion);
answer!(GridFit, sys::vox_grid_fit);
answer!(Tuning, sys::vox_tuning);

fn text(characters: &[c_char]) -> String {
    // SAFETY: zero-terminated within its array.
    unsafe { CStr::from_ptr(characters.as_ptr()) }.to_string_lossy().into_owned()
}

impl ForeignSuggestion {
    /// The cost at the best cell size.
    pub fn predicted_cost(&self) -> f64 {
        self.0.predicted_cost
    }

    /// What the cost is made of: name of a piece of work, how often it is done, what that costs.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (String, f64, f64)> + '_ {
        terms(&self.0.terms[..self.0.term_count as usize])
    }
}

impl GridFit {
    /// Of a run at the best cell size.
    pub fn seconds(&self) -> f64 {
        self.0.predicted_seconds
    }

    /// How far the fit is from the timings: root mean square of the relative errors.
    pub fn residual(&self) -> f64 {
        self.0.residual
    }
}

impl Tuning {
    /// Of a run at the best cell size, as fitted.
    pub fn seconds(&self) -> f64 {
        self.0.seconds
    }

    /// How much longer a run may take than at the best cell size, as far as it can tell; 0.03 for 3 %.
    pub fn expected_loss(&self) -> f64 {
        self.0.expected_loss
    }

    /// All runs in order: cell size and seconds.
    pub fn runs(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        self.0.runs[..self.0.run_count as usize].iter().map(|run| (run.cell_size, run.seconds))
    }
}

/// The cell size that costs a grid least.
pub fn suggest_for(grid: &ForeignGrid<'_>) -> Result<ForeignSuggestion> {
    // SAFETY: here and below, a description of slices that live during the call.
    ForeignSuggestion::ask(|out| grid.described(|desc| check(unsafe { sys::vox_suggest_for(desc, out) })))
}

/// What a run of a grid does at one cell size.
pub fn count_for(grid: &ForeignGrid<'_>, cell_size: f64) -> Result<GridWork> {
    grid.described(|desc| unsafe {
        let mut work: GridWork = std::mem::zeroed();
        check(sys::vox_count_for(desc, cell_size, &mut work))?;
        Ok(work)
    })
}

/// The weights of a grid, and its best cell size, from timings at three cell sizes or more: cell size and seconds of each.
pub fn fit(grid: &ForeignGrid<'_>, timings: &[(f64, f64)]) -> Result<GridFit> {
    let timings: Vec<_> =
        timings.iter().map(|&(cell_size, seconds)| sys::vox_grid_timing { cell_size, seconds }).collect();
    GridFit::ask(|out| {
        grid.described(|desc| check(unsafe { sys::vox_cost_fit(desc, pointer(&timings), timings.len() as u64, out) }))
    })
}

/// How to tune; `vox_tune_desc` in vox.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TuneOptions {
    /// 3 to 32; 0: 7.
    pub most_runs: u32,
    /// Cell sizes to try; both 0: an eighth to eight times the first.
    pub min: f64,
    /// See `min`.
    pub max: f64,
    /// The cell size to begin with; 0: what [`suggest_for`] says. Must be set where no grid is described.
    pub first: f64,
    /// The zone is where a run takes at most 1 + this times the shortest time; 0: 0.05.
    pub zone_loss: f64,
    /// Stops where the cell size is within this of the best one, as far as it can tell; 0: 0.02.
    pub wanted_loss: f64,
}

/// The best cell size of a grid, by running it. `run` runs it once at a cell size and returns how many seconds that took:
/// infinity if it cannot run at this size, NaN to stop. A panic of it goes on here.
pub fn tune(grid: Option<&ForeignGrid<'_>>, mut run: impl FnMut(f64) -> f64, options: TuneOptions) -> Result<Tuning> {
    let TuneOptions { most_runs, min, max, first, zone_loss, wanted_loss } = options;
    let desc = sys::vox_tune_desc { most_runs, min, max, first, zone_loss, wanted_loss, ..sized!(sys::vox_tune_desc) };
    Tuning::ask(|out| {
        let mut call = |grid: *const sys::vox_foreign_grid| {
            Call::make(&mut run, |function, user| unsafe { sys::vox_cost_tune(grid, &desc, Some(function), user, out) })
        };
        match grid {
            Some(grid) => grid.described(|desc| call(desc)),
            None => call(null()),
        }
    })
}
