use std::ptr::NonNull;

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::pointer;
use crate::options::Scalar;
use crate::{ClosestHit, FacetHit, Grid, Mesh, PointHit, RayHit, Result, SurfaceHit, TetHit};

/// Questions about the meshes of a grid, as they were when [`Grid::prepare_queries`] was called, or of a [`QueryView`].
/// Any number of threads may ask at once. `mask`: a mesh takes part if its filter's category has a bit in common with
/// it; `u64::MAX`: all. vox.h explains each under the name of the C function.
pub trait Queries {
    /// The tetrahedra that contain a point.
    fn point(&self, point: [f64; 3], mask: u64) -> Result<Vec<PointHit>>;
    /// The same for many points at once, sorted by point; faster than one by one.
    fn points<T: Scalar>(&self, points: &[[T; 3]], mask: u64) -> Result<Vec<PointHit>>;
    /// The tetrahedra whose bounding box meets a box.
    fn in_box(&self, min: [f64; 3], max: [f64; 3], mask: u64) -> Result<Vec<TetHit>>;
    /// The closest point of all surfaces, if there is one within `radius`.
    fn closest(&self, point: [f64; 3], radius: f64, mask: u64) -> Result<Option<SurfaceHit>>;
    /// The same for many points, with normals and signs; `mesh` is 0 where there is none within `max_distance`. A mask
    /// of 0 is all meshes here, and a `max_distance` of 0 any distance.
    fn closest_points<T: Scalar>(
        &self,
        points: &[[T; 3]],
        max_distance: f64,
        mask: u64,
        excluded: Option<Mesh>,
    ) -> Result<Vec<ClosestHit>>;
    /// The first tetrahedron and the first facet that a segment hits; `mesh` and `surface_mesh` are 0 where there is none.
    fn ray(&self, from: [f64; 3], to: [f64; 3], mask: u64) -> Result<RayHit>;
    /// All facets that a segment hits.
    fn ray_hits(&self, from: [f64; 3], to: [f64; 3], mask: u64, excluded: Option<Mesh>) -> Result<Vec<FacetHit>>;
    /// Whether a segment hits any tetrahedron.
    fn ray_any(&self, from: [f64; 3], to: [f64; 3], mask: u64, excluded: Option<Mesh>) -> Result<bool>;
}

/// Hits into an array that grows once if it was too small.
fn collect<T>(mut ask: impl FnMut(*mut T, u64, &mut u64) -> sys::vox_result) -> Result<Vec<T>> {
    let mut hits: Vec<T> = Vec::with_capacity(64);
    loop {
        let mut count = 0;
        let capacity = hits.capacity() as u64;
        check(ask(hits.as_mut_ptr(), capacity, &mut count))?;
        if count <= capacity {
            // SAFETY: written by the library.
            unsafe { hits.set_len(count as usize) };
            return Ok(hits);
        }
        hits.reserve_exact(count as usize);
    }
}

macro_rules! queries {
    ($type:ty, $handle:ident, $point:ident, $points:ident, $box:ident, $closest:ident, $closest_points:ident, $ray:ident,
     $ray_hits:ident, $ray_any:ident) => {
        // SAFETY of all: a handle that lives, and arrays that are as long as is said.
        impl Queries for $type {
            fn point(&self, point: [f64; 3], mask: u64) -> Result<Vec<PointHit>> {
                collect(|hits, capacity, count| unsafe {
                    sys::$point(self.$handle(), &point, mask, hits, capacity, count)
                })
            }

            fn points<T: Scalar>(&self, points: &[[T; 3]], mask: u64) -> Result<Vec<PointHit>> {
                collect(|hits, capacity, count| unsafe {
                    sys::$points(
                        self.$handle(),
                        points.as_ptr().cast(),
                        T::FORMAT,
                        0,
                        points.len() as u64,
                        mask,
                        hits,
                        capacity,
                        count,
                    )
                })
            }

            fn in_box(&self, min: [f64; 3], max: [f64; 3], mask: u64) -> Result<Vec<TetHit>> {
                collect(|hits, capacity, count| unsafe {
                    sys::$box(self.$handle(), &min, &max, mask, hits, capacity, count)
                })
            }

            fn closest(&self, point: [f64; 3], radius: f64, mask: u64) -> Result<Option<SurfaceHit>> {
                let mut hit: SurfaceHit = unsafe { std::mem::zeroed() };
                check(unsafe { sys::$closest(self.$handle(), &point, radius, mask, &mut hit) })?;
                Ok((hit.mesh != sys::VOX_NULL_BODY).then_some(hit))
            }

            fn closest_points<T: Scalar>(
                &self,
                points: &[[T; 3]],
                max_distance: f64,
                mask: u64,
                excluded: Option<Mesh>,
            ) -> Result<Vec<ClosestHit>> {
                let desc = sys::vox_closest_desc {
                    format: T::FORMAT,
                    points: pointer(points).cast(),
                    point_count: points.len() as u64,
                    mask,
                    max_distance,
                    excluded: excluded.map_or(sys::VOX_NULL_BODY, Mesh::id),
                    ..sized!(sys::vox_closest_desc)
                };
                let mut hits: Vec<ClosestHit> = Vec::with_capacity(points.len().max(1));
                check(unsafe { sys::$closest_points(self.$handle(), &desc, hits.as_mut_ptr()) })?;
                unsafe { hits.set_len(points.len()) };
                Ok(hits)
            }

            fn ray(&self, from: [f64; 3], to: [f64; 3], mask: u64) -> Result<RayHit> {
                let mut hit: RayHit = unsafe { std::mem::zeroed() };
                check(unsafe { sys::$ray(self.$handle(), &from, &to, mask, &mut hit) })?;
                Ok(hit)
            }

            fn ray_hits(
                &self,
                from: [f64; 3],
                to: [f64; 3],
                mask: u64,
                excluded: Option<Mesh>,
            ) -> Result<Vec<FacetHit>> {
                let excluded = excluded.map_or(sys::VOX_NULL_BODY, Mesh::id);
                collect(|hits, capacity, count| unsafe {
                    sys::$ray_hits(self.$handle(), &from, &to, mask, excluded, hits, capacity, count)
                })
            }

            fn ray_any(&self, from: [f64; 3], to: [f64; 3], mask: u64, excluded: Option<Mesh>) -> Result<bool> {
                let excluded = excluded.map_or(sys::VOX_NULL_BODY, Mesh::id);
                let mut any = 0;
                check(unsafe { sys::$ray_any(self.$handle(), &from, &to, mask, excluded, &mut any) })?;
                Ok(any != 0)
            }
        }
    };
}

queries!(
    Grid,
    raw,
    vox_grid_query_point,
    vox_grid_query_points,
    vox_grid_query_box,
    vox_grid_query_closest,
    vox_grid_query_closest_points,
    vox_grid_query_ray,
    vox_grid_query_ray_hits,
    vox_grid_query_ray_any
);
queries!(
    QueryView,
    raw,
    vox_query_view_point,
    vox_query_view_points,
    vox_query_view_box,
    vox_query_view_closest,
    vox_query_view_closest_points,
    vox_query_view_ray,
    vox_query_view_ray_hits,
    vox_query_view_ray_any
);

/// The meshes of a grid at one moment, to be asked at any later time and on any thread, also while the grid steps or
/// after it is gone. Clones share it.
pub struct QueryView(NonNull<sys::vox_query_view>);

// SAFETY: vox.h: any number of threads may ask, retain and release a view at any time.
unsafe impl Send for QueryView {}
unsafe impl Sync for QueryView {}

impl QueryView {
    pub(crate) fn new(view: NonNull<sys::vox_query_view>) -> Self {
        Self(view)
    }

    fn raw(&self) -> *const sys::vox_query_view {
        self.0.as_ptr()
    }

    /// [`Grid::epoch`] when the view was taken.
    pub fn epoch(&self) -> u64 {
        let mut epoch = 0;
        unsafe { sys::vox_query_view_epoch(self.raw(), &mut epoch) };
        epoch
    }

    /// The number that a mesh of the view was added with.
    pub fn user_data(&self, mesh: Mesh) -> Result<u64> {
        let mut user_data = 0;
        check(unsafe { sys::vox_query_view_user_data(self.raw(), mesh.id(), &mut user_data) })?;
        Ok(user_data)
    }
}

impl Clone for QueryView {
    fn clone(&self) -> Self {
        // SAFETY: this owner keeps it alive meanwhile.
        unsafe { sys::vox_query_view_retain(self.0.as_ptr()) };
        Self(self.0)
    }
}

impl Drop for QueryView {
    fn drop(&mut self) {
        // SAFETY: one owner less.
        unsafe { sys::vox_query_view_release(self.0.as_ptr()) }
    }
}

impl std::fmt::Debug for QueryView {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_struct("QueryView").field("epoch", &self.epoch()).finish_non_exhaustive()
    }
}
