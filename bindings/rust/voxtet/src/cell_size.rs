use std::ffi::{c_void, CStr};
use std::marker::PhantomData;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr::null;

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::{mesh_desc, pointer};
use crate::options::Scalar;
use crate::{CostWeights, GeometryStats, Result};

/// Whose cost is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CostModel {
    /// The paper's, from means, in cell visits.
    #[default]
    Paper = sys::VOX_COST_MODEL_PAPER as isize,
    /// The reference engine's, counted tetrahedron by tetrahedron, in nanoseconds.
    Reference = sys::VOX_COST_MODEL_REFERENCE as isize,
    /// The fast engine's, with one cell size in all windows, in nanoseconds.
    Fast = sys::VOX_COST_MODEL_FAST as isize,
    /// That of the surfaces of the meshes, as `vox_pairs.h` has them, in nanoseconds of their grid alone.
    Surface = sys::VOX_COST_MODEL_SURFACE as isize,
}

/// How a cell size is chosen; `vox_suggest_desc` in vox.h explains each field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SuggestOptions {
    /// Whose cost is minimised.
    pub model: CostModel,
    /// Probability that a tetrahedron has no collision; 0: 0.99.
    pub p_nc: f64,
    /// Cost of a particle test divided by that of a cell visit; 0: 5.
    pub cost_ratio: f64,
    /// Edge of the cubic world; 0: the longest side of the bounds.
    pub world_edge: f64,
    /// The zone is where the predicted cost is at most 1 + this times the minimum; 0: 0.05.
    pub zone_loss: f64,
    /// For the rule of a multiple of the mean edge; 0: 2.
    pub mean_edge_factor: f64,
    /// For the rule of a required resolution; 0: none.
    pub resolution: f64,
    /// Most bytes of dense cells; 0: no limit.
    pub byte_budget: u64,
    /// Of the reference engine; see [`Reference::dense`](crate::Reference::dense).
    pub dense: bool,
}

impl SuggestOptions {
    fn desc(&self) -> sys::vox_suggest_desc {
        sys::vox_suggest_desc {
            model: self.model as sys::vox_cost_model,
            p_nc: self.p_nc,
            cost_ratio: self.cost_ratio,
            world_edge: self.world_edge,
            zone_loss: self.zone_loss,
            mean_edge_factor: self.mean_edge_factor,
            resolution: self.resolution,
            byte_budget: self.byte_budget,
            reference_flags: u32::from(self.dense) * sys::VOX_REFERENCE_DENSE,
            ..sized!(sys::vox_suggest_desc)
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

/// A cell size, and why. Its fields are those of `vox_suggestion` in vox.h, read through [`Suggestion::raw`].
#[derive(Clone, Debug)]
pub struct Suggestion(Box<sys::vox_suggestion>);

impl Suggestion {
    pub(crate) fn ask(
        options: Option<SuggestOptions>,
        call: impl FnOnce(*const sys::vox_suggest_desc, *mut sys::vox_suggestion) -> sys::vox_result,
    ) -> Result<Self> {
        let desc = options.map(|options| options.desc());
        let mut suggestion = Box::new(sized!(sys::vox_suggestion));
        check(call(desc.as_ref().map_or(null(), std::ptr::from_ref), &mut *suggestion))?;
        Ok(Self(suggestion))
    }

    /// The best cell size.
    pub fn cell_size(&self) -> f64 {
        self.0.cell_size
    }

    /// Smallest and largest cell size that are nearly as good.
    pub fn zone(&self) -> (f64, f64) {
        (self.0.zone_min, self.0.zone_max)
    }

    /// The cost at the best cell size.
    pub fn predicted_cost(&self) -> f64 {
        self.0.predicted_cost
    }

    /// Cell sizes and their costs.
    pub fn curve(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        samples(&self.0.curve[..self.0.curve_count as usize])
    }

    /// What the cost is made of: name of a piece of work, how often it is done, what that costs.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (String, f64, f64)> + '_ {
        terms(&self.0.terms[..self.0.term_count as usize])
    }

    /// Of the meshes.
    pub fn stats(&self) -> &GeometryStats {
        &self.0.stats
    }

    /// All fields.
    pub fn raw(&self) -> &sys::vox_suggestion {
        &self.0
    }
}

pub(crate) fn samples(curve: &[sys::vox_cost_sample]) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
    curve.iter().map(|sample| (sample.cell_size, sample.cost))
}

pub(crate) fn terms(terms: &[sys::vox_cost_share]) -> impl ExactSizeIterator<Item = (String, f64, f64)> + '_ {
    terms.iter().map(|term| {
        // SAFETY: zero-terminated within its 24 bytes.
        let name = unsafe { CStr::from_ptr(term.name.as_ptr()) };
        (name.to_string_lossy().into_owned(), term.count, term.cost)
    })
}

/// The cell size that minimises the cost model for these meshes.
pub fn suggest_cell_size(meshes: &[MeshArrays<'_>], options: SuggestOptions) -> Result<Suggestion> {
    let descs = descs(meshes);
    // SAFETY: descriptions of slices that live during the call.
    Suggestion::ask(Some(options), |desc, out| unsafe {
        sys::vox_suggest_cell_size(desc, pointer(&descs), descs.len() as u64, out)
    })
}

/// A cost at one cell size.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The whole.
    pub cost: f64,
    /// Name of a piece of work, how often it is done, what that costs.
    pub terms: Vec<(String, f64, f64)>,
}

/// The cost that a model predicts for these meshes at one cell size.
pub fn predict(meshes: &[MeshArrays<'_>], cell_size: f64, options: SuggestOptions) -> Result<Prediction> {
    let descs = descs(meshes);
    let mut prediction = sized!(sys::vox_cost_prediction);
    // SAFETY: as above.
    check(unsafe {
        sys::vox_cost_predict(&options.desc(), pointer(&descs), descs.len() as u64, cell_size, &mut prediction)
    })?;
    let terms = terms(&prediction.terms[..prediction.term_count as usize]).collect();
    Ok(Prediction { cost: prediction.cost, terms })
}

fn weights_from(call: impl FnOnce(*mut CostWeights) -> sys::vox_result) -> Result<CostWeights> {
    let mut weights = sized!(CostWeights);
    check(call(&mut weights))?;
    Ok(weights)
}

/// Measures the weights of the models of the engines on this machine, and uses them from now on in this process.
pub fn calibrate() -> Result<CostWeights> {
    // SAFETY: here and below, a struct of its own size.
    weights_from(|out| unsafe { sys::vox_cost_calibrate(out) })
}

/// The weights in use.
pub fn weights() -> Result<CostWeights> {
    weights_from(|out| unsafe { sys::vox_cost_get_weights(out) })
}

/// Uses saved weights, or with `None` those that the library has for all machines.
pub fn set_weights(weights: Option<&CostWeights>) -> Result<()> {
    check(unsafe { sys::vox_cost_set_weights(weights.map_or(null(), std::ptr::from_ref)) })
}

/// Where a cost function is least.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// The best cell size.
    pub cell_size: f64,
    /// The cost there.
    pub cost: f64,
    /// The range around it with nearly that cost.
    pub zone: (f64, f64),
    /// Cell sizes and their costs.
    pub curve: Vec<(f64, f64)>,
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

/// The method for any algorithm: the cell size between `min` and `max` of least `cost`. A panic of `cost` goes on here.
pub fn minimise(mut cost: impl FnMut(f64) -> f64, min: f64, max: f64, zone_loss: f64) -> Result<Minimum> {
    let bounds = sys::vox_cost_bounds { min, max, zone_loss, ..sized!(sys::vox_cost_bounds) };
    let mut minimum = sized!(sys::vox_cost_minimum);
    // SAFETY: structs of their own size; the closure lives during the call.
    Call::make(&mut cost, |call, user| unsafe { sys::vox_cost_minimise(Some(call), user, &bounds, &mut minimum) })?;
    Ok(Minimum {
        cell_size: minimum.cell_size,
        cost: minimum.cost,
        zone: (minimum.zone_min, minimum.zone_max),
        curve: samples(&minimum.curve[..minimum.curve_count as usize]).collect(),
    })
}

/// The paper's Eq. 9: how far `n` cells per axis are from the best number, in units of the zone.
pub fn zone_distance(n: f64, n_min: f64, n_opt: f64, n_max: f64) -> Result<f64> {
    let mut distance = 0.0;
    check(unsafe { sys::vox_zone_distance(n, n_min, n_opt, n_max, &mut distance) })?;
    Ok(distance)
}
