//! Mesh files and ready-made bodies.

use std::ffi::{c_void, CStr, CString};
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::path::Path;
use std::ptr::{null, null_mut, NonNull};

use voxtet_sys as sys;

use crate::error::{check, sized, Error, ErrorCode};
use crate::grid::{pointer, records};
use crate::Result;

/// What was read, and what is odd about it; `vox_io_report` in vox_io.h.
pub type Report = sys::vox_io_report;
/// How good a mesh is; `vox_io_quality` in vox_io.h.
pub type Quality = sys::vox_io_quality;

/// Vertices, tetrahedra and triangles. It never changes.
pub struct MeshFile(NonNull<sys::vox_io_mesh>);

// SAFETY: vox_io.h: different meshes are independent, and one may be read by many threads at once.
unsafe impl Send for MeshFile {}
unsafe impl Sync for MeshFile {}

impl Drop for MeshFile {
    fn drop(&mut self) {
        // SAFETY: owned.
        unsafe { sys::vox_io_mesh_destroy(self.0.as_ptr()) }
    }
}

impl std::fmt::Debug for MeshFile {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            to,
            "MeshFile({} vertices, {} tets, {} triangles)",
            self.positions().len(),
            self.tets().len(),
            self.triangles().len()
        )
    }
}

/// How a surface is filled with tetrahedra; `vox_io_tetrahedralize_desc` in vox_io.h.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FillOptions {
    /// Uncut cubes that hold the surface, instead of a boundary that follows it.
    pub cubes: bool,
    /// Edge of a lattice cube; 0: a fiftieth of the longest side.
    pub cell: f64,
    /// Largest distance to the surface; 0: none is guaranteed.
    pub max_distance: f64,
    /// How many times cells inside may be merged.
    pub coarsen: u32,
}

fn made(call: impl FnOnce(*mut *mut sys::vox_io_mesh) -> sys::vox_result) -> Result<MeshFile> {
    let mut mesh = null_mut();
    check(call(&mut mesh))?;
    Ok(MeshFile(NonNull::new(mesh).expect("a mesh")))
}

fn c_path(path: &Path) -> Result<CString> {
    let text = path
        .to_str()
        .ok_or_else(|| Error::new(ErrorCode::InvalidArgument, format!("{} is not UTF-8", path.display())))?;
    CString::new(text)
        .map_err(|_| Error::new(ErrorCode::InvalidArgument, format!("{text:?} has a zero character in it")))
}

impl MeshFile {
    /// Reads a file of any format that docs/file-formats.md lists.
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let path = c_path(path.as_ref())?;
        // SAFETY: here and below, valid arguments that live during the call.
        made(|out| unsafe { sys::vox_io_load(path.as_ptr(), null(), out) })
    }

    /// The same from memory. The name tells the format where the bytes do not.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self> {
        let name = c_path(Path::new(name))?;
        let source = sys::vox_io_source { name: name.as_ptr(), data: bytes.as_ptr().cast(), size: bytes.len() };
        made(|out| unsafe { sys::vox_io_read(&source, 1, null(), out) })
    }

    /// Of arrays, which are copied.
    pub fn new(positions: &[[f64; 3]], tets: &[[u32; 4]], triangles: &[[u32; 3]]) -> Result<Self> {
        let view = sys::vox_io_mesh_view {
            positions: pointer(positions).cast(),
            vertex_count: positions.len() as u64,
            tets: pointer(tets).cast(),
            tet_count: tets.len() as u64,
            triangles: pointer(triangles).cast(),
            triangle_count: triangles.len() as u64,
            tet_regions: null(),
            file_vertices: null(),
            tet_cells: null(),
        };
        made(|out| unsafe { sys::vox_io_mesh_create(&view, out) })
    }

    /// A ball of about `tets` equal tetrahedra.
    pub fn lattice_ball(tets: u64, radius: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_lattice_ball(tets, radius, out) })
    }

    /// A ball made of cubes with edge `cell`.
    pub fn ball(radius: f64, cell: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_ball(radius, cell, out) })
    }

    /// A torus around the z axis.
    pub fn torus(radius: f64, tube_radius: f64, cell: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_torus(radius, tube_radius, cell, out) })
    }

    /// A capsule along the z axis.
    pub fn capsule(radius: f64, length: f64, cell: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_capsule(radius, length, cell, out) })
    }

    /// A cylinder along the z axis.
    pub fn cylinder(radius: f64, length: f64, cell: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_cylinder(radius, length, cell, out) })
    }

    /// A box.
    pub fn cuboid(size: [f64; 3], cell: f64) -> Result<Self> {
        made(|out| unsafe { sys::vox_io_make_box(size[0], size[1], size[2], cell, out) })
    }

    /// Fills the inside of this closed surface with tetrahedra. `progress` gets the fraction done, and cancels with `false`.
    pub fn tetrahedralize(&self, options: FillOptions, mut progress: impl FnMut(f64) -> bool) -> Result<Self> {
        struct Call<'f> {
            progress: &'f mut dyn FnMut(f64) -> bool,
            panic: Option<Box<dyn std::any::Any + Send>>,
        }
        unsafe extern "C" fn call(fraction: f64, user: *mut c_void) -> i32 {
            // SAFETY: the struct below, which nobody else uses meanwhile.
            let call = unsafe { &mut *user.cast::<Call<'_>>() };
            match catch_unwind(AssertUnwindSafe(|| (call.progress)(fraction))) {
                Ok(goes_on) => i32::from(!goes_on),
                Err(panic) => {
                    call.panic = Some(panic);
                    1
                }
            }
        }
        let mut user = Call { progress: &mut progress, panic: None };
        let desc = sys::vox_io_tetrahedralize_desc {
            kind: if options.cubes { sys::VOX_IO_SOLID_CUBES } else { sys::VOX_IO_SOLID_STUFFED },
            cell: options.cell,
            max_distance: options.max_distance,
            coarsen: options.coarsen,
            progress: Some(call),
            progress_user: std::ptr::from_mut(&mut user).cast(),
            ..sized!(sys::vox_io_tetrahedralize_desc)
        };
        let mesh = made(|out| unsafe { sys::vox_io_tetrahedralize(self.0.as_ptr(), &desc, out) });
        if let Some(panic) = user.panic {
            resume_unwind(panic);
        }
        mesh
    }

    fn view(&self) -> sys::vox_io_mesh_view {
        // SAFETY: a mesh that lives; it cannot fail for that.
        unsafe {
            let mut view = std::mem::zeroed();
            sys::vox_io_mesh_get_arrays(self.0.as_ptr(), &mut view);
            view
        }
    }

    /// The vertices.
    pub fn positions(&self) -> &[[f64; 3]] {
        let view = self.view();
        // SAFETY: here and below, they live as long as the mesh.
        unsafe { records(view.positions.cast(), view.vertex_count) }
    }

    /// The tetrahedra.
    pub fn tets(&self) -> &[[u32; 4]] {
        let view = self.view();
        unsafe { records(view.tets.cast(), view.tet_count) }
    }

    /// The triangles of the file.
    pub fn triangles(&self) -> &[[u32; 3]] {
        let view = self.view();
        unsafe { records(view.triangles.cast(), view.triangle_count) }
    }

    /// A number for each tetrahedron, where the file has some that are not 0.
    pub fn tet_regions(&self) -> Option<&[i32]> {
        let view = self.view();
        (!view.tet_regions.is_null()).then(|| unsafe { records(view.tet_regions, view.tet_count) })
    }

    /// For each vertex its number in the file, where vertices that belong to no tetrahedron were left out.
    pub fn file_vertices(&self) -> Option<&[u32]> {
        let view = self.view();
        (!view.file_vertices.is_null()).then(|| unsafe { records(view.file_vertices, view.vertex_count) })
    }

    /// For each tetrahedron the number of its cell in the file, where that differs from its own.
    pub fn tet_cells(&self) -> Option<&[u32]> {
        let view = self.view();
        (!view.tet_cells.is_null()).then(|| unsafe { records(view.tet_cells, view.tet_count) })
    }

    /// What was read, and what is odd about it.
    pub fn report(&self) -> Result<Report> {
        let mut report = sized!(Report);
        check(unsafe { sys::vox_io_mesh_get_report(self.0.as_ptr(), &mut report) })?;
        Ok(report)
    }

    /// What is odd about it in words, a line each.
    pub fn warnings(&self) -> String {
        // SAFETY: never null for a mesh.
        unsafe { CStr::from_ptr(sys::vox_io_mesh_get_warnings(self.0.as_ptr())) }.to_string_lossy().into_owned()
    }

    /// How good it is, and how close to a surface.
    pub fn quality(&self, surface: Option<&MeshFile>) -> Result<Quality> {
        let mut quality = sized!(Quality);
        let surface = surface.map_or(null(), |surface| surface.0.as_ptr().cast_const());
        check(unsafe { sys::vox_io_mesh_measure(self.0.as_ptr(), surface, &mut quality) })?;
        Ok(quality)
    }

    /// Writes .msh or .vtu.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = c_path(path.as_ref())?;
        check(unsafe { sys::vox_io_write(self.0.as_ptr(), path.as_ptr(), null()) })
    }
}
