use std::ptr::null_mut;

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::positions_to_c;
use crate::options::Scalar;
use crate::{Body, BoxHit, ClosestHit, Grid, Location, PointHit, RayHit, Result, TrackPiece, TriangleHit};

/// Which meshes answer, and how far to look. The default: all, at any distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QueryOptions {
    /// Only the first hit of each ray.
    pub first_hit: bool,
    /// For [`Locator::locate`]: outside, the weights of the point itself rather than of the closest point.
    pub extrapolate: bool,
    /// Only meshes whose category had a bit in common with it; 0: all.
    pub mask: u64,
    /// Not this mesh.
    pub excluded: Option<Body>,
    /// For the functions for closest points and [`Locator::locate`], no further than this; 0: any distance.
    pub max_distance: f64,
}

impl QueryOptions {
    fn to_c(self) -> sys::vox_query_desc {
        sys::vox_query_desc {
            flags: u32::from(self.first_hit) * sys::VOX_QUERY_FIRST_HIT
                | u32::from(self.extrapolate) * sys::VOX_QUERY_EXTRAPOLATE,
            mask: self.mask,
            excluded: self.excluded.map_or(sys::VOX_NULL_BODY, Body::id),
            max_distance: self.max_distance,
            ..sized!(sys::vox_query_desc)
        }
    }
}

/// The meshes of a grid at one moment ([`Grid::locator`]), to be asked on any thread, also while the grid steps or after it
/// is gone. A clone has the same meshes. `vox_query.h` explains each question.
pub struct Locator(*mut sys::vox_locator);

// SAFETY: vox_query.h: any number of threads may ask, retain and release a locator at any time.
unsafe impl Send for Locator {}
unsafe impl Sync for Locator {}

/// Hits into an array that grows once if it was too small.
fn collect<T>(guess: usize, mut ask: impl FnMut(*mut T, u64, &mut u64) -> sys::vox_result) -> Result<Vec<T>> {
    let mut hits: Vec<T> = Vec::with_capacity(guess);
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

/// One record for each of `count` questions.
fn each<T>(count: usize, ask: impl FnOnce(*mut T) -> sys::vox_result) -> Result<Vec<T>> {
    let mut out: Vec<T> = Vec::with_capacity(count);
    check(ask(out.as_mut_ptr()))?;
    // SAFETY: written by the library.
    unsafe { out.set_len(count) };
    Ok(out)
}

// SAFETY of all: a locator that lives, and arrays that are as long as is said.
impl Locator {
    pub(crate) fn of(grid: &mut Grid) -> Result<Self> {
        let mut taken = Self(null_mut());
        taken.update(grid)?;
        Ok(taken)
    }

    /// Takes the meshes of a grid as they are now instead of those it had. Clones keep theirs.
    pub fn update(&mut self, grid: &mut Grid) -> Result<()> {
        check(unsafe { sys::vox_grid_update_locator(grid.as_ptr(), &mut self.0) })
    }

    /// [`Grid::epoch`] when the meshes were taken.
    pub fn epoch(&self) -> u64 {
        let mut epoch = 0;
        unsafe { sys::vox_locator_get_epoch(self.0, &mut epoch) };
        epoch
    }

    /// The number that a mesh was added with.
    pub fn user_data(&self, body: Body) -> Result<u64> {
        let mut user_data = 0;
        check(unsafe { sys::vox_locator_get_user_data(self.0, body.id(), &mut user_data) })?;
        Ok(user_data)
    }

    /// The tetrahedra that contain points, sorted by point.
    pub fn find_point_hits<T: Scalar>(&self, points: &[[T; 3]], options: QueryOptions) -> Result<Vec<PointHit>> {
        let (at, desc) = (positions_to_c(points), options.to_c());
        collect(points.len() + 16, |hits, capacity, count| unsafe {
            sys::vox_locator_find_point_hits(self.0, &at, &desc, hits, capacity, count)
        })
    }

    /// Where each point is, with the weights that interpolate a field there; outside, of the closest point.
    pub fn locate<T: Scalar>(&self, points: &[[T; 3]], options: QueryOptions) -> Result<Vec<Location>> {
        let (at, desc) = (positions_to_c(points), options.to_c());
        each(points.len(), |out| unsafe { sys::vox_locator_locate(self.0, &at, &desc, out) })
    }

    /// The closest point of all surfaces, for each point; its `body` is 0 where there is none.
    pub fn find_closest<T: Scalar>(&self, points: &[[T; 3]], options: QueryOptions) -> Result<Vec<ClosestHit>> {
        let (at, desc) = (positions_to_c(points), options.to_c());
        each(points.len(), |out| unsafe { sys::vox_locator_find_closest(self.0, &at, &desc, out) })
    }

    /// The tetrahedra whose bounding boxes meet boxes, sorted by box.
    pub fn find_box_hits<T: Scalar>(
        &self,
        min: &[[T; 3]],
        max: &[[T; 3]],
        options: QueryOptions,
    ) -> Result<Vec<BoxHit>> {
        let (min, max, desc) = (positions_to_c(min), positions_to_c(max), options.to_c());
        collect(64, |hits, capacity, count| unsafe {
            sys::vox_locator_find_box_hits(self.0, &min, &max, &desc, hits, capacity, count)
        })
    }

    /// The facets that rays meet, sorted by (ray, t).
    pub fn find_ray_hits<T: Scalar>(
        &self,
        from: &[[T; 3]],
        to: &[[T; 3]],
        options: QueryOptions,
    ) -> Result<Vec<RayHit>> {
        let (from, to, desc) = (positions_to_c(from), positions_to_c(to), options.to_c());
        collect(64, |hits, capacity, count| unsafe {
            sys::vox_locator_find_ray_hits(self.0, &from, &to, &desc, hits, capacity, count)
        })
    }

    /// The tetrahedra that segments pass through, sorted by (segment, body, t_in).
    pub fn find_tracks<T: Scalar>(
        &self,
        from: &[[T; 3]],
        to: &[[T; 3]],
        options: QueryOptions,
    ) -> Result<Vec<TrackPiece>> {
        let (from, to, desc) = (positions_to_c(from), positions_to_c(to), options.to_c());
        collect(64, |pieces, capacity, count| unsafe {
            sys::vox_locator_find_tracks(self.0, &from, &to, &desc, pieces, capacity, count)
        })
    }

    /// The closest points of segments and all surfaces; `body` is 0 where there is none, and the distance 0 where a
    /// segment meets a surface.
    pub fn find_closest_to_segments<T: Scalar>(
        &self,
        from: &[[T; 3]],
        to: &[[T; 3]],
        options: QueryOptions,
    ) -> Result<Vec<ClosestHit>> {
        let (begins, ends, desc) = (positions_to_c(from), positions_to_c(to), options.to_c());
        each(from.len(), |out| unsafe { sys::vox_locator_find_closest_to_segments(self.0, &begins, &ends, &desc, out) })
    }

    /// The tetrahedra that triangles meet, each of three corners, which move to those in `to`; sorted by
    /// (triangle, body, t).
    pub fn find_triangle_hits<T: Scalar>(
        &self,
        from: &[[T; 3]],
        to: Option<&[[T; 3]]>,
        options: QueryOptions,
    ) -> Result<Vec<TriangleHit>> {
        let (from, to, desc) = (positions_to_c(from), to.map(positions_to_c), options.to_c());
        let to = to.as_ref().map_or(std::ptr::null(), |to| to as *const _);
        collect(64, |hits, capacity, count| unsafe {
            sys::vox_locator_find_triangle_hits(self.0, &from, to, &desc, hits, capacity, count)
        })
    }

    /// Whether each ray meets a tetrahedron.
    pub fn test_rays<T: Scalar>(&self, from: &[[T; 3]], to: &[[T; 3]], options: QueryOptions) -> Result<Vec<bool>> {
        let (begins, ends, desc) = (positions_to_c(from), positions_to_c(to), options.to_c());
        // Each is written as 0 or 1.
        each(from.len(), |out: *mut bool| unsafe {
            sys::vox_locator_test_rays(self.0, &begins, &ends, &desc, out.cast())
        })
    }
}

impl Clone for Locator {
    fn clone(&self) -> Self {
        // SAFETY: this owner keeps it alive meanwhile.
        unsafe { sys::vox_locator_retain(self.0) };
        Self(self.0)
    }
}

impl Drop for Locator {
    fn drop(&mut self) {
        // SAFETY: one owner less.
        unsafe { sys::vox_locator_release(self.0) }
    }
}

impl std::fmt::Debug for Locator {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_struct("Locator").field("epoch", &self.epoch()).finish_non_exhaustive()
    }
}
