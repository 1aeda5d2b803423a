//! Mesh files and ready-made bodies.
#![cfg(feature = "io")]

use voxtet::io::{FillOptions, MeshFile};
use voxtet::{ErrorCode, Grid};

#[test]
fn from_a_file_to_contacts() {
    let folder = std::env::temp_dir().join(format!("voxtet-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("bälle.msh");
    let ball = MeshFile::ball(1.0, 0.3).unwrap();
    ball.save(&path).unwrap();
    let read = MeshFile::load(&path).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!((read.positions(), read.tets()), (ball.positions(), ball.tets()));
    assert_eq!(read.report().unwrap().inverted_tets, 0);
    assert_eq!(read.warnings(), "");
    let mut grid = Grid::new().unwrap();
    grid.add(read.positions(), read.tets()).unwrap();
    let other = grid.add(read.positions(), read.tets()).unwrap();
    for p in grid.positions_mut::<f64>(other).unwrap() {
        p[0] += 1.1;
    }
    grid.step().unwrap();
    assert!(grid.contacts().len() > 10);
    let error = MeshFile::load(&path).unwrap_err();
    assert_eq!(error.code(), ErrorCode::File);
    assert!(error.to_string().contains("bälle.msh"), "{error}");
}

#[test]
fn bodies() {
    for (mesh, volume) in [
        (MeshFile::lattice_ball(2000, 1.0), 4.19),
        (MeshFile::torus(1.0, 0.3, 0.1), 1.78),
        (MeshFile::capsule(0.5, 1.0, 0.1), 1.31),
        (MeshFile::cylinder(0.5, 1.0, 0.1), 0.79),
        (MeshFile::cuboid([1.0, 2.0, 3.0], 0.5), 6.0),
    ] {
        let mesh = mesh.unwrap();
        let found = mesh.quality(None).unwrap().volume;
        assert!((found / volume - 1.0).abs() < 0.1, "{mesh:?}: {found}, expected {volume}");
    }
    let error = MeshFile::ball(-1.0, 0.1).unwrap_err();
    assert_eq!(error.code(), ErrorCode::InvalidArgument);
}

#[test]
fn surfaces_are_filled() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let surface = MeshFile::new(&corners, &[], &facets).unwrap();
    let options = FillOptions { cell: 0.1, max_distance: 0.03, ..FillOptions::default() };
    let mut last = 0.0;
    let filled = surface
        .tetrahedralize(options, |fraction| {
            assert!(fraction >= last);
            last = fraction;
            true
        })
        .unwrap();
    assert!(filled.tets().len() > 100 && last > 0.9);
    assert!(filled.quality(Some(&surface)).unwrap().hausdorff <= 0.03);
    assert_eq!(surface.tetrahedralize(options, |_| false).unwrap_err().code(), ErrorCode::InvalidState);
    let panics = std::panic::AssertUnwindSafe(|| surface.tetrahedralize(options, |_| panic!("of a progress function")));
    assert!(std::panic::catch_unwind(panics).is_err());
    assert_eq!(MeshFile::read("a.msh", b"$Mesh").unwrap_err().code(), ErrorCode::Format);
    assert_eq!(MeshFile::load("a\0b.msh").unwrap_err().code(), ErrorCode::InvalidArgument);
    assert_eq!(MeshFile::new(&corners, &[[0, 1, 2, 9]], &[]).unwrap_err().code(), ErrorCode::InvalidMesh);
}
