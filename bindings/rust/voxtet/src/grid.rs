use std::any::Any;
use std::collections::{BTreeMap, HashMap};
use std::ffi::CStr;
use std::ptr::{null, null_mut, NonNull};
use std::sync::atomic::Ordering;
use std::sync::Arc;

use voxtet_sys as sys;

use crate::callbacks::Callbacks;
use crate::cell_size::{CellSizeOptions, CellSizeResult};
use crate::error::{check, sized};
use crate::options::{grid_flags, weights_to_c, Scalar};
use crate::{
    Body, Constraint, ConstraintOptions, Contact, Error, ErrorCode, Filter, GridOptions, Locator, MeshOptions, Pair,
    Result,
};

/// A grid as it is now, and what its last step did; `vox_grid_info` in vox.h.
pub type GridInfo = sys::vox_grid_info;
/// A mesh that made a step fail, or that a step left out; `vox_failure` in vox.h.
pub type Failure = sys::vox_failure;

/// A mesh as it is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInfo {
    /// As given when the mesh was added.
    pub user_data: u64,
    /// One of the constants in [`shape_kind`](crate::shape_kind): `NONE` for a mesh.
    pub shape: sys::vox_shape_kind,
    /// With the removed ones.
    pub vertex_count: u64,
    /// With those that are disabled or removed.
    pub tet_count: u64,
    /// Without these.
    pub enabled_tet_count: u64,
    /// Whether the mesh takes part in steps.
    pub enabled: bool,
    /// Whether its positions are doubles.
    pub doubles: bool,
    /// Its transform: three rows of four.
    pub transform: [f64; 12],
}

/// A set of meshes that collide. Its memory is returned when it is dropped.
///
/// Everything that changes a grid takes `&mut self`, and what reads it `&self`, so the compiler sees to what vox.h asks of
/// its callers: many threads may read a grid, one may change it, and what a step found is not used after the next one.
///
/// ```compile_fail,E0502
/// let mut grid = voxtet::Grid::new()?;
/// let contacts = grid.contacts();
/// grid.step()?; // ends the view of the contacts
/// println!("{}", contacts.len());
/// # Ok::<(), voxtet::Error>(())
/// ```
pub struct Grid {
    grid: NonNull<sys::vox_grid>,
    callbacks: Arc<Callbacks>,                                    // for C to call
    previous: HashMap<Body, Vec<[f64; 3]>>,                       // positions that C borrows
    pub(crate) fields: HashMap<Body, Box<dyn Any + Send + Sync>>, // functions that C calls
}

// SAFETY: vox.h: a grid belongs to no thread; different ones are independent; functions of a const grid may run on any
// number of threads. Callbacks are Send and Sync.
unsafe impl Send for Grid {}
unsafe impl Sync for Grid {}

impl Drop for Grid {
    fn drop(&mut self) {
        // SAFETY: owned. What it borrows is dropped after it.
        unsafe { sys::vox_grid_destroy(self.grid.as_ptr()) }
    }
}

impl std::fmt::Debug for Grid {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_struct("Grid").field("bodies", &self.bodies()).field("epoch", &self.epoch()).finish_non_exhaustive()
    }
}

fn check_abi() -> Result<()> {
    // SAFETY: no arguments.
    let library = unsafe { sys::vox_abi_version() };
    if library == sys::VOX_ABI_VERSION {
        return Ok(());
    }
    Err(Error::new(
        ErrorCode::Unsupported,
        format!("libvox has ABI version {library}, voxtet was made for {}", sys::VOX_ABI_VERSION),
    ))
}

/// Of a slice for C: null if it is empty, as a dangling pointer of Rust's is none of C's.
pub(crate) fn pointer<T>(slice: &[T]) -> *const T {
    if slice.is_empty() {
        null()
    } else {
        slice.as_ptr()
    }
}

/// An array of C.
///
/// SAFETY: null, or `count` elements that live and stay as they are for 'a.
pub(crate) unsafe fn records<'a, T>(data: *const T, count: u64) -> &'a [T] {
    if data.is_null() || count == 0 {
        return &[];
    }
    unsafe { std::slice::from_raw_parts(data, count as usize) }
}

pub(crate) fn or_null<T>(value: &Option<T>) -> *const T {
    value.as_ref().map_or(null(), std::ptr::from_ref)
}

pub(crate) fn positions_to_c<T: Scalar>(positions: &[[T; 3]]) -> sys::vox_positions {
    sys::vox_positions {
        data: pointer(positions).cast(),
        count: positions.len() as u64,
        format: T::FORMAT,
        reserved: 0,
        byte_stride: 0,
        component_byte_stride: 0,
    }
}

pub(crate) fn mesh_desc<T: Scalar>(positions: &[[T; 3]], tets: &[[u32; 4]]) -> sys::vox_mesh_desc {
    sys::vox_mesh_desc {
        flags: sys::VOX_MESH_COPY_POSITIONS,
        positions: positions_to_c(positions),
        tets: pointer(tets).cast(),
        tet_count: tets.len() as u64,
        ..sized!(sys::vox_mesh_desc)
    }
}

/// The count of `count_of(null, 0)`, and so many items copied.
fn copy_all<T: Copy>(mut copy: impl FnMut(*mut T, u64, &mut u64) -> sys::vox_result) -> Result<Vec<T>> {
    let mut count = 0;
    check(copy(null_mut(), 0, &mut count))?;
    let mut items: Vec<T> = Vec::with_capacity(count as usize);
    check(copy(items.as_mut_ptr(), count, &mut count))?;
    // SAFETY: the library has written as many as there are, and there were as many before.
    unsafe { items.set_len(items.capacity().min(count as usize)) };
    Ok(items)
}

impl Grid {
    /// A grid with the default settings.
    pub fn new() -> Result<Self> {
        Self::with_options(GridOptions::default())
    }

    /// A grid with these settings.
    pub fn with_options(options: GridOptions) -> Result<Self> {
        // SAFETY: a valid description.
        Self::made(options, |desc, out| unsafe { sys::vox_grid_create(desc, out) })
    }

    /// A grid from the bytes of [`Grid::save`], which need not be trusted. Of the options only log, tasks, workers,
    /// margin, budget and `reference` are used; without that, the engine is the one that was saved.
    pub fn load(bytes: &[u8], options: GridOptions) -> Result<Self> {
        // SAFETY: as above; the bytes are checked.
        Self::made(options, |desc, out| unsafe {
            sys::vox_grid_load(bytes.as_ptr().cast(), bytes.len() as u64, desc, out)
        })
    }

    /// By a function of C, which copies what the description points to. Callbacks live as long as the grid.
    fn made(
        options: GridOptions,
        create: impl FnOnce(&sys::vox_grid_desc, &mut *mut sys::vox_grid) -> sys::vox_result,
    ) -> Result<Self> {
        check_abi()?;
        let callbacks = Callbacks::new(options.log, options.tasks, options.workers);
        let (log, tasks) = callbacks.to_c();
        let weights = options.reference.and_then(|reference| reference.weights).map(weights_to_c);
        let reference = options.reference.map(|reference| reference.to_c(&weights));
        let desc = sys::vox_grid_desc {
            flags: grid_flags(options.constraints, options.edges, options.skip_bad_bodies),
            worker_count: callbacks.workers.load(Ordering::Relaxed),
            cell_size: options.cell_size,
            byte_budget: options.byte_budget,
            margin: options.margin,
            max_constraints_per_pair: options.max_constraints_per_pair,
            log: &log,
            tasks: &tasks,
            reference: or_null(&reference),
            ..sized!(sys::vox_grid_desc)
        };
        let mut grid = null_mut();
        check(create(&desc, &mut grid))?;
        Ok(Self {
            grid: NonNull::new(grid).expect("a grid"),
            callbacks,
            previous: HashMap::new(),
            fields: HashMap::new(),
        })
    }

    /// The grid as bytes that are the same on every machine: settings, meshes, positions, and which pairs
    /// touch.
    pub fn save(&self) -> Result<Vec<u8>> {
        let mut size = 0;
        // SAFETY: asks for the size, then has room for as much.
        check(unsafe { sys::vox_grid_save(self.get(), null_mut(), 0, &mut size) })?;
        let mut bytes = vec![0u8; size as usize];
        check(unsafe { sys::vox_grid_save(self.get(), bytes.as_mut_ptr().cast(), size, &mut size) })?;
        Ok(bytes)
    }

    /// What a function that fills a view says. Reading a grid that lives cannot fail.
    fn view<T>(&self, get: unsafe extern "C" fn(*const sys::vox_grid, *mut T) -> sys::vox_result) -> T {
        // SAFETY: a view has pointers and numbers, each of which may be zero.
        unsafe {
            let mut view = std::mem::zeroed();
            get(self.get(), &mut view);
            view
        }
    }

    fn get(&self) -> *const sys::vox_grid {
        self.grid.as_ptr()
    }

    fn get_mut(&mut self) -> *mut sys::vox_grid {
        self.grid.as_ptr()
    }

    /// For functions of [`sys`](crate::sys) that are not wrapped. They must not destroy it, nor give it a mesh whose
    /// positions are borrowed, as [`Grid::positions`] takes all for the library's own.
    pub fn as_ptr(&mut self) -> *mut sys::vox_grid {
        self.grid.as_ptr()
    }

    /// Removes all meshes and contacts and keeps the settings.
    pub fn clear(&mut self) -> Result<()> {
        // SAFETY: here and below, a grid that lives, and arrays that are as long as is said.
        check(unsafe { sys::vox_grid_clear(self.get_mut()) })?;
        self.previous.clear();
        self.fields.clear();
        Ok(())
    }

    /// Takes memory for that many meshes and contacts in advance.
    pub fn reserve(&mut self, meshes: u32, contacts: u64) -> Result<()> {
        check(unsafe { sys::vox_grid_reserve(self.get_mut(), meshes, contacts) })
    }

    /// Makes now what steps make of a mesh once, when they first need it.
    pub fn prepare(&mut self) -> Result<()> {
        check(unsafe { sys::vox_grid_prepare(self.get_mut()) })
    }

    /// Sets the cell size of the following steps; 0: the library chooses.
    pub fn set_cell_size(&mut self, cell_size: f64) -> Result<()> {
        check(unsafe { sys::vox_grid_set_cell_size(self.get_mut(), cell_size) })
    }

    /// The cell size in use; 0 if none was chosen yet.
    pub fn cell_size(&self) -> f64 {
        self.state().cell_size
    }

    /// Threads of the following steps, as [`GridOptions::workers`]. With a task system: how many workers it gets.
    pub fn set_workers(&mut self, workers: u32) -> Result<()> {
        check(unsafe { sys::vox_grid_set_worker_count(self.get_mut(), workers) })?;
        self.callbacks.workers.store(workers, Ordering::Relaxed);
        Ok(())
    }

    /// Vertices outside another mesh, but no further from it than this, have constraints of kind
    /// [`PROXIMITY`](crate::constraint_kind::PROXIMITY) from the next step on; 0: none. Experimental.
    pub fn set_margin(&mut self, margin: f64) -> Result<()> {
        check(unsafe { sys::vox_grid_set_margin(self.get_mut(), margin) })
    }

    /// Whether the following steps find constraints, find edges that pass through faces, and leave out bad meshes.
    pub fn set_flags(&mut self, constraints: bool, edges: bool, skip_bad_bodies: bool) -> Result<()> {
        let flags = grid_flags(constraints, edges, skip_bad_bodies);
        check(unsafe { sys::vox_grid_set_flags(self.get_mut(), flags) })
    }

    /// What [`set_flags`](Grid::set_flags) sets, in its order; of a loaded grid as it was saved.
    pub fn flags(&self) -> (bool, bool, bool) {
        let flags = self.state().flags;
        let has = |flag| flags & flag != 0;
        (has(sys::VOX_GRID_CONSTRAINTS), has(sys::VOX_GRID_EDGES), has(sys::VOX_GRID_SKIP_BAD_BODIES))
    }

    // ---- meshes ----

    /// Adds a mesh of these vertices and tetrahedra. Both arrays are copied; [`Grid::positions_mut`] moves the vertices.
    pub fn add<T: Scalar>(&mut self, positions: &[[T; 3]], tets: &[[u32; 4]]) -> Result<Body> {
        self.insert(&mesh_desc(positions, tets))
    }

    /// The same with user data, a filter or a rest pose.
    pub fn add_with<T: Scalar>(
        &mut self,
        positions: &[[T; 3]],
        tets: &[[u32; 4]],
        options: MeshOptions<'_, T>,
    ) -> Result<Body> {
        let mut desc = mesh_desc(positions, tets);
        desc.user_data = options.user_data;
        desc.filter = options.filter.to_c();
        if let Some(rest) = options.rest_positions {
            desc.rest_positions = positions_to_c(rest);
        }
        self.insert(&desc)
    }

    fn insert(&mut self, desc: &sys::vox_mesh_desc) -> Result<Body> {
        let mut mesh = sys::VOX_NULL_BODY;
        check(unsafe { sys::vox_mesh_insert(self.get_mut(), desc, &mut mesh) })?;
        Ok(Body(mesh))
    }

    /// Removes a mesh or a shape. The contacts of the last step stay as they are until the next one.
    pub fn remove(&mut self, body: Body) -> Result<()> {
        check(unsafe { sys::vox_body_remove(self.get_mut(), body.0) })?;
        self.previous.remove(&body);
        self.fields.remove(&body);
        Ok(())
    }

    /// Whether `mesh` names a mesh of this grid.
    pub fn contains(&self, body: Body) -> bool {
        unsafe { sys::vox_body_is_valid(self.get(), body.0) != 0 }
    }

    /// All meshes and shapes, in the order of their ids.
    pub fn bodies(&self) -> Vec<Body> {
        copy_all(|meshes, capacity, count| unsafe { sys::vox_grid_get_bodies(self.get(), meshes, capacity, count) })
            .unwrap_or_default()
            .into_iter()
            .map(Body)
            .collect()
    }

    fn info_of(&self, mesh: Body) -> Result<sys::vox_body_info> {
        let mut info = sized!(sys::vox_body_info);
        check(unsafe { sys::vox_body_get_info(self.get(), mesh.0, &mut info) })?;
        Ok(info)
    }

    /// A mesh or a shape as it is now.
    pub fn info(&self, body: Body) -> Result<BodyInfo> {
        let info = self.info_of(body)?;
        Ok(BodyInfo {
            user_data: info.user_data,
            shape: info.shape as sys::vox_shape_kind,
            vertex_count: info.positions.count,
            tet_count: info.tet_count,
            enabled_tet_count: info.enabled_tet_count,
            enabled: info.enabled != 0,
            doubles: info.positions.format == sys::VOX_FORMAT_DOUBLE,
            transform: info.transform,
        })
    }

    /// The tetrahedra of a mesh as they were given, those that are disabled or removed, too.
    pub fn tets(&self, mesh: Body) -> Result<Vec<[u32; 4]>> {
        copy_all(|tets: *mut [u32; 4], capacity, count| unsafe {
            sys::vox_mesh_get_tets(self.get(), mesh.0, tets.cast(), null_mut(), capacity, count)
        })
    }

    /// Of each tetrahedron of a mesh, whether it is neither disabled nor removed.
    pub fn enabled_tets(&self, mesh: Body) -> Result<Vec<bool>> {
        let enabled: Vec<u8> = copy_all(|enabled, capacity, count| unsafe {
            sys::vox_mesh_get_tets(self.get(), mesh.0, null_mut(), enabled, capacity, count)
        })?;
        Ok(enabled.into_iter().map(|e| e != 0).collect())
    }

    /// The number given when the mesh was added.
    pub fn user_data(&self, body: Body) -> Result<u64> {
        Ok(self.info_of(body)?.user_data)
    }

    /// The positions of a mesh, before its transform, if they are of type `T`.
    pub fn positions<T: Scalar>(&self, mesh: Body) -> Result<&[[T; 3]]> {
        let info = self.info_of(mesh)?;
        check_format::<T>(&info)?;
        // SAFETY: all meshes have positions of their own, one after the other, which only &mut self can change.
        Ok(unsafe { records(info.positions.data.cast(), info.positions.count) })
    }

    /// The positions of a mesh, to be written before a step, if they are of type `T`, that of the array given to
    /// [`Grid::add`].
    pub fn positions_mut<T: Scalar>(&mut self, mesh: Body) -> Result<&mut [[T; 3]]> {
        let info = self.info_of(mesh)?;
        check_format::<T>(&info)?;
        let mut positions = null_mut();
        check(unsafe { sys::vox_mesh_map_positions(self.get_mut(), mesh.0, &mut positions) })?;
        if positions.is_null() || info.positions.count == 0 {
            return Ok(&mut []);
        }
        // SAFETY: packed, and exclusively borrowed.
        Ok(unsafe { std::slice::from_raw_parts_mut(positions.cast(), info.positions.count as usize) })
    }

    /// The positions that the vertices of a mesh had before, copied. From there they move to their positions in the
    /// following steps, which also find impacts. Set them before each step. Experimental.
    pub fn set_previous_positions<T: Scalar>(&mut self, mesh: Body, positions: &[[T; 3]]) -> Result<()> {
        let copy: Vec<[f64; 3]> = positions.iter().map(|p| p.map(T::into)).collect();
        check(unsafe { sys::vox_mesh_bind_previous_positions(self.get_mut(), mesh.0, &positions_to_c(&copy)) })?;
        self.previous.insert(mesh, copy); // what C borrowed before is dropped
        Ok(())
    }

    /// The mesh stands still in the following steps.
    pub fn end_previous_positions(&mut self, mesh: Body) -> Result<()> {
        check(unsafe { sys::vox_mesh_bind_previous_positions(self.get_mut(), mesh.0, null()) })?;
        self.previous.remove(&mesh);
        Ok(())
    }

    /// Moves a mesh as a whole by an affine map, three rows of four; `None`: not at all. A shape is rotated, moved, and
    /// scaled along all axes alike.
    pub fn set_transform(&mut self, body: Body, matrix: Option<&[f64; 12]>) -> Result<()> {
        let matrix = matrix.map_or(null(), std::ptr::from_ref);
        check(unsafe { sys::vox_body_set_transform(self.get_mut(), body.0, matrix) })
    }

    /// Sets what a mesh collides with.
    pub fn set_filter(&mut self, body: Body, filter: Filter) -> Result<()> {
        check(unsafe { sys::vox_body_set_filter(self.get_mut(), body.0, &filter.to_c()) })
    }

    /// What a mesh collides with. Neither category nor mask is 0.
    pub fn filter(&self, body: Body) -> Result<Filter> {
        Ok(Filter::of(&self.info_of(body)?.filter))
    }

    /// Leaves a mesh out of the following steps, or takes it in again.
    pub fn set_enabled(&mut self, body: Body, enabled: bool) -> Result<()> {
        check(unsafe { sys::vox_body_set_enabled(self.get_mut(), body.0, enabled.into()) })
    }

    /// Whether two meshes collide, if their filters let them.
    pub fn set_pair_enabled(&mut self, a: Body, b: Body, enabled: bool) -> Result<()> {
        check(unsafe { sys::vox_grid_set_pair_enabled(self.get_mut(), a.0, b.0, enabled.into()) })
    }

    /// Makes the next step process a mesh even if it did not move, for measurements.
    pub fn mark_moved(&mut self, body: Body) -> Result<()> {
        check(unsafe { sys::vox_body_mark_moved(self.get_mut(), body.0) })
    }

    // ---- cutting and growing ----

    /// Replaces vertices, tetrahedra and positions of a mesh.
    pub fn set_topology<T: Scalar>(&mut self, mesh: Body, positions: &[[T; 3]], tets: &[[u32; 4]]) -> Result<()> {
        let desc = mesh_desc(positions, tets);
        check(unsafe { sys::vox_mesh_set_topology(self.get_mut(), mesh.0, &desc) })
    }

    /// Disables tetrahedra, so that they contain nothing, or enables them again.
    pub fn set_tets_enabled(&mut self, mesh: Body, tets: &[u32], enabled: bool) -> Result<()> {
        check(unsafe {
            sys::vox_mesh_set_tets_enabled(self.get_mut(), mesh.0, pointer(tets), tets.len() as u64, enabled.into())
        })
    }

    /// Gives tetrahedra other corners: `tets[i]` gets `corners[i]`.
    pub fn replace_tets(&mut self, mesh: Body, tets: &[u32], corners: &[[u32; 4]]) -> Result<()> {
        check_length("corners", corners.len(), tets.len())?;
        check(unsafe {
            sys::vox_mesh_replace_tets(
                self.get_mut(),
                mesh.0,
                pointer(tets),
                tets.len() as u64,
                pointer(corners).cast(),
            )
        })
    }

    /// Adds tetrahedra; the index of the first.
    pub fn append_tets(&mut self, mesh: Body, corners: &[[u32; 4]]) -> Result<u32> {
        let mut first = 0;
        check(unsafe {
            sys::vox_mesh_append_tets(self.get_mut(), mesh.0, pointer(corners).cast(), corners.len() as u64, &mut first)
        })?;
        Ok(first)
    }

    /// Removes tetrahedra. Their vertices stay.
    pub fn remove_tets(&mut self, mesh: Body, tets: &[u32]) -> Result<()> {
        check(unsafe { sys::vox_mesh_remove_tets(self.get_mut(), mesh.0, pointer(tets), tets.len() as u64) })
    }

    fn append(&mut self, mesh: Body, desc: &sys::vox_vertices_desc) -> Result<u32> {
        let mut first = 0;
        check(unsafe { sys::vox_mesh_append_vertices(self.get_mut(), mesh.0, desc, &mut first) })?;
        Ok(first)
    }

    /// Adds vertices at these positions, which must be of the mesh's type; the index of the first.
    pub fn append_vertices<T: Scalar>(&mut self, mesh: Body, positions: &[[T; 3]]) -> Result<u32> {
        check_format::<T>(&self.info_of(mesh)?)?;
        self.positions_mut::<T>(mesh)?; // of its own, also in a mesh that has had no vertices
        let desc = sys::vox_vertices_desc {
            count: positions.len() as u64,
            positions: positions_to_c(positions),
            ..sized!(sys::vox_vertices_desc)
        };
        self.append(mesh, &desc)
    }

    /// Adds copies of vertices, where these are; the index of the first.
    pub fn append_copies(&mut self, mesh: Body, copies_of: &[u32]) -> Result<u32> {
        let desc = sys::vox_vertices_desc {
            count: copies_of.len() as u64,
            copies_of: pointer(copies_of),
            ..sized!(sys::vox_vertices_desc)
        };
        self.append(mesh, &desc)
    }

    /// Removes vertices that no enabled tetrahedron has.
    pub fn remove_vertices(&mut self, mesh: Body, vertices: &[u32]) -> Result<()> {
        check(unsafe {
            sys::vox_mesh_remove_vertices(self.get_mut(), mesh.0, pointer(vertices), vertices.len() as u64)
        })
    }

    // ---- step and results ----

    /// Finds all contacts of the positions as they are now.
    pub fn step(&mut self) -> Result<()> {
        check(unsafe { sys::vox_grid_step(self.get_mut()) })
    }

    /// The contacts of the last step, in canonical order; none before the first and after a failed one.
    pub fn contacts(&self) -> &[Contact] {
        let view: sys::vox_contact_view = self.view(sys::vox_grid_get_contacts);
        // SAFETY: here and below, they live until a change of the grid, which needs &mut self.
        unsafe { records(view.data, view.count) }
    }

    /// For each contact 1 if the vertex is in the interior of the tetrahedron, 0 if on its boundary.
    pub fn interiors(&self) -> &[u8] {
        let view: sys::vox_contact_view = self.view(sys::vox_grid_get_contacts);
        unsafe { records(view.interiors, view.count) }
    }

    /// The pairs of meshes that touch, are within the margin, or ended in the last step, sorted. Who steps twice and
    /// reads once misses what the first step began; [`total_began`](sys::vox_grid_info::total_began) of [`Grid::state`]
    /// shows it.
    pub fn pairs(&self) -> &[Pair] {
        let view: sys::vox_pair_view = self.view(sys::vox_grid_get_pairs);
        unsafe { records(view.data, view.count) }
    }

    /// Indices of the contacts, pair by pair: those of a pair begin at `first_contact`.
    pub fn pair_contacts(&self) -> &[u32] {
        let view: sys::vox_pair_view = self.view(sys::vox_grid_get_pairs);
        unsafe { records(view.contacts, self.contacts().len() as u64) } // each is of one pair
    }

    /// Finds constraints of the last step. With `constraints` in the options every step does so itself.
    pub fn find_constraints(&mut self, options: ConstraintOptions) -> Result<()> {
        let desc = sys::vox_constraint_desc {
            method: options.method as sys::vox_depth_method,
            body_a: options.a.map_or(sys::VOX_NULL_BODY, Body::id),
            body_b: options.b.map_or(sys::VOX_NULL_BODY, Body::id),
            mask: options.mask,
            closest_budget: options.closest_budget,
            ..sized!(sys::vox_constraint_desc)
        };
        check(unsafe { sys::vox_grid_find_constraints(self.get_mut(), &desc) })
    }

    fn constraint_view(&self) -> Result<sys::vox_constraint_view> {
        unsafe {
            let mut view = std::mem::zeroed();
            check(sys::vox_grid_get_constraints(self.get(), &mut view))?;
            Ok(view)
        }
    }

    /// The constraints that were found last, pair by pair; an error if none were looked for since the last step.
    pub fn constraints(&self) -> Result<&[Constraint]> {
        let view = self.constraint_view()?;
        Ok(unsafe { records(view.data, view.count) })
    }

    /// The constraints of `pairs()[p]` are those from element `p` on, and before element `p + 1`.
    pub fn pair_offsets(&self) -> Result<&[u64]> {
        let view = self.constraint_view()?;
        Ok(unsafe { records(view.pair_offsets, view.pair_count + 1) })
    }

    /// The constraints of `pairs()[pair]`. It panics if there are not so many pairs.
    pub fn constraints_of(&self, pair: usize) -> Result<&[Constraint]> {
        let offsets = self.pair_offsets()?;
        Ok(&self.constraints()?[offsets[pair] as usize..offsets[pair + 1] as usize])
    }

    /// A hash of the contacts: the same on every machine and in every language.
    pub fn hash(&self) -> u64 {
        let mut hash = 0;
        unsafe { sys::vox_grid_get_hash(self.get(), &mut hash) };
        hash
    }

    /// Number of steps and other changes so far.
    pub fn epoch(&self) -> u64 {
        self.state().epoch
    }

    /// The mesh that made the last step fail, or those that it left out.
    pub fn failures(&self) -> Vec<Failure> {
        let mut all = Vec::new();
        loop {
            let mut failure = sized!(Failure);
            unsafe { sys::vox_grid_get_failure(self.get(), all.len() as u32, &mut failure) };
            if failure.body == sys::VOX_NULL_BODY {
                return all;
            }
            all.push(failure);
        }
    }

    /// The grid as it is now.
    pub fn state(&self) -> GridInfo {
        let mut info = sized!(GridInfo);
        unsafe { sys::vox_grid_get_info(self.get(), &mut info) };
        info
    }

    /// What the last step did, and how long each stage of it took; `vox_grid_get_counters` in vox.h.
    pub fn counters(&self) -> BTreeMap<&'static str, u64> {
        let view: sys::vox_counter_view = self.view(sys::vox_grid_get_counters);
        let name = |c: &sys::vox_counter| unsafe { CStr::from_ptr(c.name) }.to_str().unwrap_or_default();
        unsafe { records(view.data, view.count) }.iter().map(|c| (name(c), c.value)).collect()
    }

    // ---- locators and suggestions ----

    /// The meshes as they are now, to be asked where they are.
    pub fn locator(&mut self) -> Result<Locator> {
        Locator::of(self)
    }

    /// The cell size with the least cost for the meshes of this grid. Without options, that of its engine.
    pub fn suggest_cell_size(&self, options: Option<CellSizeOptions>) -> Result<CellSizeResult> {
        CellSizeResult::of_meshes(options, |desc, out| unsafe {
            sys::vox_grid_suggest_cell_size(self.get(), desc, out)
        })
    }
}

fn check_length(name: &str, length: usize, expected: usize) -> Result<()> {
    if length == expected {
        return Ok(());
    }
    Err(Error::new(ErrorCode::InvalidArgument, format!("{name} has {length} elements, expected {expected}")))
}

fn check_format<T: Scalar>(info: &sys::vox_body_info) -> Result<()> {
    if info.positions.format == T::FORMAT {
        return Ok(());
    }
    let name = |format| if format == sys::VOX_FORMAT_DOUBLE { "f64" } else { "f32" };
    Err(Error::new(
        ErrorCode::InvalidArgument,
        format!("positions of the mesh are {}, asked for as {}", name(info.positions.format), name(T::FORMAT)),
    ))
}

/// Steps many grids, several at the same time, on `workers` threads (as [`GridOptions::workers`]). For many small scenes that have
/// nothing to do with each other. If grids fail, the others are stepped nevertheless: the error is that of the first of
/// them, its text begins with its index, and the codes tell the others (empty if no grid was stepped).
pub fn step_grids(grids: &mut [Grid], workers: u32) -> std::result::Result<(), (Error, Vec<Option<ErrorCode>>)> {
    const NOT_STEPPED: i32 = i32::MIN;
    let pointers: Vec<*mut sys::vox_grid> = grids.iter_mut().map(Grid::get_mut).collect();
    let mut results = vec![NOT_STEPPED; grids.len()];
    // SAFETY: exclusively borrowed, and therefore different, grids.
    let all = unsafe {
        sys::vox_grids_step(pointer(&pointers), pointers.len() as u64, workers, null(), results.as_mut_ptr())
    };
    check(all).map_err(|error| {
        results.retain(|&result| result != NOT_STEPPED);
        (error, results.into_iter().map(|result| (result != sys::VOX_OK).then(|| ErrorCode::of(result))).collect())
    })
}
