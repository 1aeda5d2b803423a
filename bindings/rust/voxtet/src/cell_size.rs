use std::ffi::{c_void, CStr};
use std::marker::PhantomData;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::{mesh_desc, or_null, pointer};
use crate::options::{weights_to_c, Scalar};
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
    /// That of the surfaces of the meshes, as `vox_surface.h` has them, in nanoseconds of their grid alone.
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
    /// Of the models of the engines; `None`: those of the grid's reference engine, or those shipped with the library.
    pub weights: Option<CostWeights>,
}

impl SuggestOptions {
    fn desc(&self, weights: &Option<sys::vox_cost_weights>) -> sys::vox_suggest_desc {
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
            weights: or_null(weights),
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
        let weights = options.and_then(|options| options.weights).map(weights_to_c);
        let desc = options.map(|options| options.desc(&weights));
        let mut suggestion = Box::new(sized!(sys::vox_suggestion));
        check(call(or_null(&desc), &mut *suggestion))?;
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

/// Measures what work costs on this machine, for [`SuggestOptions::weights`] and
/// [`Reference::weights`](crate::Reference::weights), in about ten milliseconds.
pub fn calibrate() -> Result<CostWeights> {
    let mut weights = sized!(sys::vox_cost_weights);
    // SAFETY: a struct of its own size.
    check(unsafe { sys::vox_cost_calibrate(&mut weights) })?;
    Ok(weights.ns)
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

/// The method for any algorithm: the cell size between `min` and `max` of least `cost`; `zone_loss` is as in
/// [`SuggestOptions`]. A panic of `cost` goes on here.
pub fn minimise(mut cost: impl FnMut(f64) -> f64, min: f64, max: f64, zone_loss: f64) -> Result<Minimum> {
    let mut minimum = sized!(sys::vox_cost_minimum);
    // SAFETY: a struct of its own size; the closure lives during the call.
    Call::make(&mut cost, |call, user| unsafe {
        sys::vox_cost_minimise(Some(call), user, min, max, zone_loss, &mut minimum)
    })?;
    Ok(Minimum {
        cell_size: minimum.cell_size,
        cost: minimum.cost,
        zone: (minimum.zone_min, minimum.zone_max),
        curve: samples(&minimum.curve[..minimum.curve_count as usize]).collect(),
    })
}
