use std::ffi::{c_char, c_void, CStr};
use std::marker::PhantomData;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::{mesh_desc, or_null, pointer};
use crate::options::{weights_to_c, Scalar};
use crate::{CostSample, CostWeights, ForeignWeights, Geometry, Result, Timing};

/// Whose cost is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CostModel {
    /// The paper's, in visits of cells per tetrahedron.
    #[default]
    Paper = sys::VOX_COST_MODEL_PAPER as isize,
    /// A step of the paper's engine, counted tetrahedron by tetrahedron.
    Reference = sys::VOX_COST_MODEL_REFERENCE as isize,
    /// A step of the fast engine, with the same cell size everywhere.
    Fast = sys::VOX_COST_MODEL_FAST as isize,
    /// The searches of `vox_surface.h` in the surfaces of the meshes.
    Surface = sys::VOX_COST_MODEL_SURFACE as isize,
}

/// How to suggest a cell size; `vox_cell_size_desc` in vox_cell_size.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellSizeOptions {
    /// Whose cost is minimised.
    pub model: CostModel,
    /// The zone is where the predicted cost is at most 1 + this times the least; 0: 0.05.
    pub zone_loss: f64,
    /// Share of tetrahedra without a contact; 0: 0.99.
    pub p_nc: f64,
    /// Cost of a particle test divided by that of a cell visit; 0: 5.
    pub cost_ratio: f64,
    /// For `cells_per_axis`; 0: the longest side of the box of all vertices.
    pub world_edge: f64,
    /// Most bytes of dense cells; 0: no limit.
    pub byte_budget: u64,
    /// Of the reference engine; see [`Reference::dense`](crate::Reference::dense).
    pub dense: bool,
    /// Of the models of the engines; `None`: those of the grid's reference engine, or those shipped with the library.
    pub weights: Option<CostWeights>,
}

impl CellSizeOptions {
    fn desc(&self, weights: &Option<sys::vox_cost_weights>) -> sys::vox_cell_size_desc {
        sys::vox_cell_size_desc {
            model: self.model as sys::vox_cost_model,
            zone_loss: self.zone_loss,
            p_nc: self.p_nc,
            cost_ratio: self.cost_ratio,
            world_edge: self.world_edge,
            byte_budget: self.byte_budget,
            reference_flags: u32::from(self.dense) * sys::VOX_REFERENCE_DENSE,
            weights: or_null(weights),
            ..sized!(sys::vox_cell_size_desc)
        }
    }
}

/// A mesh without a grid.
#[derive(Clone, Copy)]
pub struct MeshArrays<'arrays> {
    desc: sys::vox_mesh_desc,
    arrays: PhantomData<&'arrays [u32]>,
}

// SAFETY: it points to shared slices.
unsafe impl Send for MeshArrays<'_> {}
unsafe impl Sync for MeshArrays<'_> {}

impl<'arrays> MeshArrays<'arrays> {
    /// Of these vertices and tetrahedra.
    pub fn new<T: Scalar>(positions: &'arrays [[T; 3]], tets: &'arrays [[u32; 4]]) -> Self {
        Self { desc: mesh_desc(positions, tets), arrays: PhantomData }
    }

    /// Vertices are looked for in the mesh's own tetrahedra, too (models of the engines).
    pub fn with_self_collision(mut self) -> Self {
        self.desc.filter.flags |= sys::VOX_FILTER_SELF_COLLISION;
        self
    }
}

fn descs(meshes: &[MeshArrays<'_>]) -> Vec<sys::vox_mesh_desc> {
    meshes.iter().map(|mesh| mesh.desc).collect()
}

/// One kind of work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostTerm {
    /// What it is.
    pub name: &'static str,
    /// How often it is done at the suggested cell size.
    pub count: f64,
    /// What that costs.
    pub cost: f64,
}

/// The cell size that a rule of thumb gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellSizeRule {
    /// The rule.
    pub name: &'static str,
    /// 0: it does not apply.
    pub cell_size: f64,
    /// The predicted cost there; 0: not known.
    pub cost: f64,
}

/// A cell size and the reasons for it. Costs are seconds of a step or a run; those of [`CostModel::Paper`] are visits of
/// cells per tetrahedron, and those of [`minimise`] are the function's. What a call does not know is 0 or empty.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSizeResult {
    /// The best cell size.
    pub cell_size: f64,
    /// Smallest cell size that is nearly as good.
    pub zone_min: f64,
    /// Largest cell size that is nearly as good.
    pub zone_max: f64,
    /// The cost at the best cell size.
    pub cost: f64,
    /// The smallest cell size that gives right answers, or fits the byte budget; 0: any.
    pub min_cell_size: f64,
    /// Edge of the world divided by the cell size.
    pub cells_per_axis: f64,
    /// Of fits and tuning: root mean square of (fitted time / measured time - 1).
    pub fit_error: f64,
    /// Of tuning: how much longer a run may take than at the best cell size; 0.03 means 3 %.
    pub expected_loss: f64,
    /// Costs by cell size, ascending.
    pub curve: Vec<CostSample>,
    /// Their costs add up to `cost`.
    pub terms: Vec<CostTerm>,
    /// Rules of thumb.
    pub rules: Vec<CellSizeRule>,
    /// Of tuning: the runs, in order.
    pub timings: Vec<Timing>,
    /// Of foreign grids: those used, or those found by fits and tuning.
    pub weights: ForeignWeights,
    /// Constants of [`cell_size_warning`](crate::cell_size_warning), combined with |.
    pub warnings: u32,
    /// The same in words, with numbers; empty if there are none.
    pub note: String,
}

impl CellSizeResult {
    /// What a call of the library finds.
    pub(crate) fn ask(call: impl FnOnce(*mut sys::vox_cell_size_result) -> Result<()>) -> Result<Self> {
        let mut found = sized!(sys::vox_cell_size_result);
        call(&mut found)?;
        // SAFETY: names are static texts, and the note ends with 0 within its array.
        let name = |name: *const c_char| unsafe { CStr::from_ptr(name) }.to_str().unwrap_or_default();
        let note = unsafe { CStr::from_ptr(found.note.as_ptr()) }.to_string_lossy().into_owned();
        let (terms, rules) = (&found.terms[..found.term_count as usize], &found.rules[..found.rule_count as usize]);
        Ok(Self {
            cell_size: found.cell_size,
            zone_min: found.zone_min,
            zone_max: found.zone_max,
            cost: found.cost,
            min_cell_size: found.min_cell_size,
            cells_per_axis: found.cells_per_axis,
            fit_error: found.fit_error,
            expected_loss: found.expected_loss,
            curve: found.curve[..found.curve_count as usize].to_vec(),
            terms: terms.iter().map(|t| CostTerm { name: name(t.name), count: t.count, cost: t.cost }).collect(),
            rules: rules
                .iter()
                .map(|r| CellSizeRule { name: name(r.name), cell_size: r.cell_size, cost: r.cost })
                .collect(),
            timings: found.timings[..found.timing_count as usize].to_vec(),
            weights: found.weights,
            warnings: found.warnings,
            note,
        })
    }

    /// Of meshes.
    pub(crate) fn of_meshes(
        options: Option<CellSizeOptions>,
        call: impl FnOnce(*const sys::vox_cell_size_desc, *mut sys::vox_cell_size_result) -> sys::vox_result,
    ) -> Result<Self> {
        let weights = options.and_then(|options| options.weights).map(weights_to_c);
        let desc = options.map(|options| options.desc(&weights));
        Self::ask(|out| check(call(or_null(&desc), out)))
    }
}

/// The cell size with the least cost for these meshes.
pub fn suggest_cell_size(meshes: &[MeshArrays<'_>], options: CellSizeOptions) -> Result<CellSizeResult> {
    let descs = descs(meshes);
    // SAFETY: here and below, descriptions of slices that live during the call.
    CellSizeResult::of_meshes(Some(options), |desc, out| unsafe {
        sys::vox_suggest_cell_size(desc, pointer(&descs), descs.len() as u64, out)
    })
}

/// Sizes in meshes.
pub fn measure_geometry(meshes: &[MeshArrays<'_>]) -> Result<Geometry> {
    let descs = descs(meshes);
    let mut geometry = sized!(sys::vox_geometry);
    check(unsafe { sys::vox_measure_geometry(pointer(&descs), descs.len() as u64, &mut geometry) })?;
    Ok(geometry)
}

/// Measures what work costs on this machine, for [`CellSizeOptions::weights`] and
/// [`Reference::weights`](crate::Reference::weights), in about ten milliseconds.
pub fn calibrate() -> Result<CostWeights> {
    let mut weights = sized!(sys::vox_cost_weights);
    // SAFETY: a struct of its own size.
    check(unsafe { sys::vox_cost_calibrate(&mut weights) })?;
    Ok(weights.ns)
}

/// A closure that C calls, and its panic.
pub(crate) struct Call<'f> {
    function: &'f mut dyn FnMut(f64) -> f64,
    panic: Option<Box<dyn std::any::Any + Send>>,
}

type CallFunction = unsafe extern "C" fn(f64, *mut c_void) -> f64;

impl<'f> Call<'f> {
    /// Makes a call of the library with the function, and `user` for it. A panic of the function goes on here.
    pub(crate) fn make(
        function: &'f mut dyn FnMut(f64) -> f64,
        call: impl FnOnce(CallFunction, *mut c_void) -> sys::vox_result,
    ) -> Result<()> {
        let mut user = Self { function, panic: None };
        let result = call(Self::run, std::ptr::from_mut(&mut user).cast());
        if let Some(panic) = user.panic {
            resume_unwind(panic);
        }
        check(result)
    }

    unsafe extern "C" fn run(cell_size: f64, user: *mut c_void) -> f64 {
        // SAFETY: the struct above, which nobody else uses meanwhile.
        let call = unsafe { &mut *user.cast::<Call<'_>>() };
        if call.panic.is_some() {
            return f64::NAN;
        }
        catch_unwind(AssertUnwindSafe(|| (call.function)(cell_size))).unwrap_or_else(|panic| {
            call.panic = Some(panic);
            f64::NAN
        })
    }
}

/// The method for any algorithm: the cell size between `min` and `max` of least `cost`; `zone_loss` is as in
/// [`CellSizeOptions`]. A panic of `cost` goes on here.
pub fn minimise(mut cost: impl FnMut(f64) -> f64, min: f64, max: f64, zone_loss: f64) -> Result<CellSizeResult> {
    // SAFETY: the closure lives during the call.
    CellSizeResult::ask(|out| {
        Call::make(&mut cost, |call, user| unsafe {
            sys::vox_cost_minimise(Some(call), user, min, max, zone_loss, out)
        })
    })
}
