//! Rigid shapes: floors, tools, terrain.

use std::ffi::c_void;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::ptr::null;

use voxtet_sys as sys;

use crate::error::{check, sized};
use crate::grid::{pointer, positions_to_c};
use crate::{Body, Error, ErrorCode, Filter, Grid, Result};

/// A rigid shape, in a frame of its own: [`Grid::set_transform`] places it. Lengths may be 0. Experimental.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<'arrays> {
    /// All z <= 0: a floor.
    HalfSpace,
    /// A ball around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// Along the z axis, around the origin.
    Capsule {
        /// Of its round ends.
        radius: f64,
        /// Half the distance between the centres of these.
        half_length: f64,
    },
    /// Along the z axis, around the origin, with flat ends.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Half its length.
        half_length: f64,
    },
    /// Around the origin.
    Box {
        /// Half its sides.
        half_size: [f64; 3],
    },
    /// Terrain, solid below. Between four heights are two triangles, with the diagonal from the lower left to the upper
    /// right.
    Heightfield {
        /// z at x = column * spacing\[0\], y = row * spacing\[1\], row after row.
        heights: &'arrays [f64],
        /// Heights in a row.
        columns: u32,
        /// Distances between columns, and between rows.
        spacing: [f64; 2],
    },
    /// The inside of a closed surface.
    Solid {
        /// Of its vertices.
        positions: &'arrays [[f64; 3]],
        /// Counter-clockwise as seen from outside.
        triangles: &'arrays [[u32; 3]],
    },
    /// What is within `radius` of triangles, such as a blade or a wall, or of segments, such as a needle, which are
    /// triangles that name a vertex twice.
    Sheet {
        /// Of its vertices.
        positions: &'arrays [[f64; 3]],
        /// Of vertices; see [`polyline`].
        triangles: &'arrays [[u32; 3]],
        /// Half its thickness.
        radius: f64,
    },
}

/// Segments between `count` positions, one after the other, for [`Shape::Sheet`]: a needle, a thread.
pub fn polyline(count: u32) -> Vec<[u32; 3]> {
    (1..count).map(|i| [i - 1, i, i]).collect()
}

/// Of a shape, beside itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShapeOptions {
    /// Any number of the caller's, which comes back with pairs and constraints.
    pub user_data: u64,
    /// What the shape collides with. Self-collision, rings and rest distance have no meaning.
    pub filter: Filter,
}

impl Shape<'_> {
    fn to_c(self) -> Result<sys::vox_shape_desc> {
        let mut desc = sized!(sys::vox_shape_desc);
        desc.kind = match self {
            Shape::HalfSpace => sys::VOX_SHAPE_HALF_SPACE,
            Shape::Sphere { radius } => {
                desc.radius = radius;
                sys::VOX_SHAPE_SPHERE
            }
            Shape::Capsule { radius, half_length } => {
                (desc.radius, desc.half_length) = (radius, half_length);
                sys::VOX_SHAPE_CAPSULE
            }
            Shape::Cylinder { radius, half_length } => {
                (desc.radius, desc.half_length) = (radius, half_length);
                sys::VOX_SHAPE_CYLINDER
            }
            Shape::Box { half_size } => {
                desc.half_size = half_size;
                sys::VOX_SHAPE_BOX
            }
            Shape::Heightfield { heights, columns, spacing } => {
                let rows = heights.len().checked_div(columns as usize).unwrap_or(0);
                if rows * columns as usize != heights.len() || u32::try_from(rows).is_err() {
                    let text = format!("{} heights in rows of {columns}", heights.len());
                    return Err(Error::new(ErrorCode::InvalidArgument, text));
                }
                (desc.heights, desc.columns, desc.rows, desc.spacing) =
                    (pointer(heights), columns, rows as u32, spacing);
                sys::VOX_SHAPE_HEIGHTFIELD
            }
            Shape::Solid { positions, triangles } => {
                desc.positions = positions_to_c(positions);
                (desc.triangles, desc.triangle_count) = (pointer(triangles).cast(), triangles.len() as u64);
                sys::VOX_SHAPE_SOLID
            }
            Shape::Sheet { positions, triangles, radius } => {
                desc = Shape::Solid { positions, triangles }.to_c()?;
                desc.radius = radius;
                sys::VOX_SHAPE_SHEET
            }
        };
        Ok(desc)
    }
}

unsafe extern "C" fn evaluate<F>(
    at: *const f64,
    count: u64,
    distances: *mut f64,
    gradients: *mut f64,
    user: *mut c_void,
) where
    F: Fn([f64; 3]) -> (f64, [f64; 3]),
{
    // SAFETY: `user` lives as long as the shape; the arrays have `count` elements.
    let field = unsafe { &*user.cast::<F>() };
    for i in 0..count as usize {
        let point = unsafe { *at.cast::<[f64; 3]>().add(i) };
        // No distance makes the step fail. The panic was reported by its hook.
        let (distance, gradient) = catch_unwind(AssertUnwindSafe(|| field(point))).unwrap_or((f64::NAN, [0.0; 3]));
        unsafe {
            *distances.add(i) = distance;
            *gradients.cast::<[f64; 3]>().add(i) = gradient;
        }
    }
}

impl Grid {
    /// Adds a rigid shape, which is copied, and takes part from the next step on. The vertices of meshes collide with it. A
    /// shape has no vertices: its constraints have vertices of `body_a` alone. The id is good wherever a shape has what
    /// a mesh has: transform, filter, user data, whether it is enabled. Experimental.
    pub fn add_shape(&mut self, shape: Shape<'_>, options: ShapeOptions) -> Result<Body> {
        let desc = shape.to_c()?;
        self.insert_shape(desc, options)
    }

    fn insert_shape(&mut self, mut desc: sys::vox_shape_desc, options: ShapeOptions) -> Result<Body> {
        desc.user_data = options.user_data;
        desc.filter = options.filter.to_c();
        let mut id = sys::VOX_NULL_BODY;
        // SAFETY: a grid that lives; the arrays of the shape are copied.
        check(unsafe { sys::vox_shape_insert(self.as_ptr(), &desc, &mut id) })?;
        Ok(Body(id))
    }

    /// Adds a shape that is where a function is not positive, in a box around the origin with half these sides. The function
    /// gives the distance of a point in the shape's frame, and a gradient that points out of the shape. Outside, the distance
    /// is at most the true one. It is called on several threads at once. If it panics, the step fails. Experimental.
    ///
    /// ```
    /// let mut grid = voxtet::Grid::new()?;
    /// let ball = |[x, y, z]: [f64; 3]| ((x * x + y * y + z * z).sqrt() - 1.0, [x, y, z]);
    /// grid.add_field([1.0; 3], ball, Default::default())?;
    /// # Ok::<(), voxtet::Error>(())
    /// ```
    pub fn add_field<F>(&mut self, half_size: [f64; 3], field: F, options: ShapeOptions) -> Result<Body>
    where
        F: Fn([f64; 3]) -> (f64, [f64; 3]) + Send + Sync + 'static,
    {
        let field = Box::new(field);
        let desc = sys::vox_shape_desc {
            kind: sys::VOX_SHAPE_FIELD,
            half_size,
            field: Some(evaluate::<F>),
            field_user: std::ptr::from_ref::<F>(&field).cast_mut().cast(),
            ..sized!(sys::vox_shape_desc)
        };
        let id = self.insert_shape(desc, options)?;
        self.fields.insert(id, field);
        Ok(id)
    }

    /// Where a shape was before, as in [`Grid::set_transform`]. In the following steps it moves from there to its
    /// transform, and they also find impacts with it; `None`: it stands still. Experimental.
    pub fn set_previous_transform(&mut self, shape: Body, matrix: Option<&[f64; 12]>) -> Result<()> {
        let matrix = matrix.map_or(null(), std::ptr::from_ref);
        // SAFETY: a grid that lives; the matrix is copied.
        check(unsafe { sys::vox_shape_set_previous_transform(self.as_ptr(), shape.0, matrix) })
    }
}
