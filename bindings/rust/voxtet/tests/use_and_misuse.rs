//! What a user may do wrong, and what threads may do at once.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use voxtet::*;

const TET: [[u32; 4]; 1] = [[0, 1, 2, 3]];
const UNIT: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A block of n^3 cubes with edge 1, five tetrahedra each, moved by `x`.
fn block(n: u32, x: f32) -> (Vec<[f32; 3]>, Vec<[u32; 4]>) {
    let m = n + 1;
    let positions = (0..m * m * m).map(|v| [x + (v % m) as f32, (v / m % m) as f32, (v / m / m) as f32]).collect();
    let mut tets = Vec::new();
    for c in 0..n * n * n {
        let (i, j, k) = (c % n, c / n % n, c / n / n);
        let corner = |d: u32| (i + (d & 1)) + m * (j + (d >> 1 & 1)) + m * m * (k + (d >> 2));
        let cut: [[u32; 4]; 5] = if (i + j + k) % 2 == 0 {
            [[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 7, 4, 2], [1, 2, 4, 7]]
        } else {
            [[1, 3, 0, 5], [2, 0, 3, 6], [4, 6, 5, 0], [7, 5, 6, 3], [0, 5, 3, 6]]
        };
        tets.extend(cut.map(|tet| tet.map(corner)));
    }
    (positions, tets)
}

/// Two blocks of n^3 cubes, of which half is in the other.
fn blocks_of(n: u32, options: GridOptions) -> (Grid, Body, Body) {
    let mut grid = Grid::with_options(options).unwrap();
    let (positions, tets) = block(n, 0.0);
    let a = grid.add(&positions, &tets).unwrap();
    let (positions, tets) = block(n, n as f32 / 2.0 + 0.3);
    let b = grid.add(&positions, &tets).unwrap();
    (grid, a, b)
}

fn two_blocks(options: GridOptions) -> (Grid, Body, Body) {
    blocks_of(6, options)
}

fn code<T>(result: Result<T>) -> ErrorCode {
    result.err().expect("a failure").code()
}

/// A point and a shape; the gap and normal of their only constraint.
fn touch(shape: Shape<'_>, at: [f64; 3]) -> (f64, [f64; 3]) {
    let mut grid = Grid::with_options(GridOptions { constraints: true, ..GridOptions::default() }).unwrap();
    let point = grid.add(&[at, [2.0, 3.0, 4.0]], &[]).unwrap();
    let options = ShapeOptions { user_data: 7, ..ShapeOptions::default() };
    let body = grid.add_shape(shape, options).unwrap();
    grid.step().unwrap();
    let [c] = grid.constraints().unwrap() else {
        panic!("{shape:?}: {} constraints", grid.constraints().unwrap().len())
    };
    assert!(c.body_a == point && c.body_b == body && c.user_data_b == 7);
    assert_eq!((c.count, c.count_a, c.vertices[0]), (1, 1, 0));
    assert_ne!(grid.info(body).unwrap().shape, shape_kind::NONE);
    assert_eq!(grid.info(point).unwrap().shape, shape_kind::NONE);
    (c.gap, c.normal)
}

#[test]
fn fields() {
    let mut grid = Grid::with_options(GridOptions { constraints: true, ..GridOptions::default() }).unwrap();
    grid.add(&[[0.0, 0.0, 0.75]], &[]).unwrap();
    let radius = vec![1.0];
    let ball = move |[x, y, z]: [f64; 3]| ((x * x + y * y + z * z).sqrt() - radius[0], [x, y, z]);
    let body = grid.add_field([1.0; 3], ball, ShapeOptions::default()).unwrap();
    grid.step().unwrap();
    assert!((grid.constraints().unwrap()[0].gap + 0.25).abs() < 1e-12);
    grid.remove(body).unwrap();
    grid.add_field([1.0; 3], |_| panic!("no distance"), ShapeOptions::default()).unwrap();
    assert!(grid.step().unwrap_err().to_string().contains("the field of a shape has distance nan"));
    grid.clear().unwrap();
    assert!(grid.add_field([-1.0; 3], |at| (1.0, at), ShapeOptions::default()).is_err());
}

#[test]
fn shapes() {
    let (half_length, triangles) = (1.0, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    let positions = UNIT.map(|p| p.map(f64::from));
    let (up, down, x, y) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let heights = [-0.5; 6];
    let line = polyline(2);
    let positions = &positions[..];
    for (shape, at, gap, normal) in [
        (Shape::HalfSpace, [3.0, 4.0, -0.25], -0.25, up),
        (Shape::Sphere { radius: 1.0 }, [0.5, 0.0, 0.0], -0.5, x),
        (Shape::Capsule { radius: 0.5, half_length }, [0.25, 0.0, 1.0], -0.25, x),
        (Shape::Cylinder { radius: 0.5, half_length }, [0.0, 0.25, 0.5], -0.25, y),
        (Shape::Box { half_size: [1.0, 0.5, 2.0] }, [0.0, 0.25, 0.0], -0.25, y),
        (Shape::Heightfield { heights: &heights, columns: 3, spacing: [1.0, 2.0] }, [1.0, 1.0, -0.75], -0.25, up),
        (Shape::Solid { positions, triangles: &triangles }, [0.25, 0.25, 0.125], -0.125, down),
        (Shape::Sheet { positions, triangles: &triangles, radius: 0.25 }, [0.25, 0.25, -0.125], -0.125, down),
        (Shape::Sheet { positions, triangles: &line, radius: 0.25 }, [0.5, 0.0, -0.125], -0.125, down),
    ] {
        let found = touch(shape, at);
        assert!((found.0 - gap).abs() < 1e-12, "{shape:?}: {found:?}");
        assert!((0..3).all(|k| (found.1[k] - normal[k]).abs() < 1e-12), "{shape:?}: {found:?}");
    }
    assert!(polyline(0).is_empty() && polyline(1).is_empty());
}

#[test]
fn shapes_move_and_are_refused() {
    let mut grid = Grid::with_options(GridOptions { constraints: true, ..GridOptions::default() }).unwrap();
    let point = grid.add(&[[0.0f64, 0.0, 3.0]], &[]).unwrap();
    let ball = grid.add_shape(Shape::Sphere { radius: 0.25 }, ShapeOptions::default()).unwrap();
    let at = |z: f64| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, z];
    grid.set_transform(ball, Some(&at(6.0))).unwrap();
    grid.set_previous_transform(ball, Some(&at(0.0))).unwrap();
    grid.step().unwrap();
    let c = grid.constraints().unwrap()[0];
    assert_eq!(c.kind, constraint_kind::IMPACT);
    assert!((c.time - 2.75 / 6.0).abs() < 1e-9);
    grid.set_previous_transform(ball, None).unwrap();
    grid.step().unwrap();
    assert!(grid.constraints().unwrap().is_empty());

    assert_eq!(code(grid.set_previous_transform(point, Some(&at(0.0)))), ErrorCode::InvalidArgument);
    let mut bent = at(0.0);
    bent[0] = 2.0;
    assert_eq!(code(grid.set_transform(ball, Some(&bent))), ErrorCode::InvalidArgument);
    let mut refused = |shape| code(grid.add_shape(shape, ShapeOptions::default()));
    assert_eq!(refused(Shape::Sphere { radius: -1.0 }), ErrorCode::InvalidArgument);
    let heights = [0.0; 5];
    for columns in [0, 2] {
        let uneven = Shape::Heightfield { heights: &heights, columns, spacing: [1.0, 1.0] };
        assert_eq!(refused(uneven), ErrorCode::InvalidArgument);
    }
    assert_eq!(refused(Shape::Solid { positions: &[], triangles: &[] }), ErrorCode::InvalidArgument);
    assert_eq!(
        refused(Shape::Sheet { positions: &[[0.0; 3]], triangles: &[[0, 0, 1]], radius: 1.0 }),
        ErrorCode::InvalidMesh
    );
    assert_eq!(code(grid.positions_mut::<f32>(ball)), ErrorCode::InvalidArgument);
    grid.remove(ball).unwrap();
    assert_eq!(code(grid.set_previous_transform(ball, None)), ErrorCode::InvalidHandle);
}

#[test]
fn errors() {
    let mut grid = Grid::new().unwrap();
    let mesh = grid.add(&UNIT, &TET).unwrap();
    let error = grid.add(&UNIT, &[[0, 1, 2, 4]]).unwrap_err();
    assert_eq!(error.code(), ErrorCode::InvalidMesh);
    assert!(error.to_string().contains("names vertex 4 of 4"), "{error}");
    assert_eq!(
        code(Grid::with_options(GridOptions { cell_size: -1.0, ..GridOptions::default() })),
        ErrorCode::InvalidArgument
    );
    assert_eq!(code(Grid::with_options(GridOptions { byte_budget: 10, ..GridOptions::default() })), ErrorCode::Budget);
    assert_eq!(code(Grid::load(b"no snapshot", GridOptions::default())), ErrorCode::Format);
    assert_eq!(code(grid.positions::<f64>(mesh)), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.positions_mut::<f64>(mesh)), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.constraints()), ErrorCode::InvalidState);
    assert_eq!(code(grid.find_constraints(ConstraintOptions::default())), ErrorCode::InvalidState);
    assert_eq!(code(grid.set_margin(-1.0)), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.set_previous_positions(mesh, &UNIT[..3])), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.replace_tets(mesh, &[0], &[])), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.remove_tets(mesh, &[1])), ErrorCode::InvalidArgument);
    let options = MeshOptions { rest_positions: Some(&UNIT[..3]), ..MeshOptions::default() };
    assert_eq!(code(grid.add_with(&UNIT, &TET, options)), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.append_vertices(mesh, &[[0.0f64; 3]])), ErrorCode::InvalidArgument);
    grid.positions_mut(mesh).unwrap()[1][2] = f32::NAN;
    let error = grid.step().unwrap_err();
    assert_eq!(error.code(), ErrorCode::NonFinite);
    assert!(error.to_string().contains("vertex 1"), "{error}");
    assert_eq!(grid.failures()[0].body, mesh);
    grid.positions_mut(mesh).unwrap()[1][2] = 0.0f32;
    grid.step().unwrap();
    assert!(grid.failures().is_empty());
    grid.remove(mesh).unwrap();
    for result in
        [grid.remove(mesh), grid.set_enabled(mesh, false), grid.info(mesh).map(drop), grid.tets(mesh).map(drop)]
    {
        assert_eq!(result.unwrap_err().code(), ErrorCode::InvalidHandle);
    }
    assert!(!grid.contains(mesh));
}

#[test]
fn empty_arrays() {
    let mut grid = Grid::new().unwrap();
    let none: [[f32; 3]; 0] = [];
    let mesh = grid.add(&none, &[]).unwrap();
    assert_eq!(grid.positions::<f32>(mesh).unwrap().len(), 0);
    assert_eq!(grid.positions_mut::<f32>(mesh).unwrap().len(), 0);
    assert!(grid.tets(mesh).unwrap().is_empty());
    grid.step().unwrap();
    assert!(grid.contacts().is_empty() && grid.pairs().is_empty());
    grid.find_constraints(ConstraintOptions::default()).unwrap();
    assert!(grid.constraints().unwrap().is_empty());
    assert_eq!(grid.pair_offsets().unwrap(), [0]);
    let (locator, all) = (grid.locator().unwrap(), QueryOptions::default());
    assert!(locator.find_point_hits(&none, all).unwrap().is_empty());
    assert!(locator.find_closest(&none, all).unwrap().is_empty());
    assert!(locator.test_rays(&none, &none, all).unwrap().is_empty());
    assert_eq!(grid.append_vertices(mesh, &UNIT).unwrap(), 0);
    assert_eq!(grid.append_tets(mesh, &TET).unwrap(), 0);
    assert_eq!(grid.positions::<f32>(mesh).unwrap(), &UNIT);
    grid.step().unwrap();
    step_grids(&mut [], 2).unwrap();
}

#[test]
fn views() {
    let (mut grid, a, b) = two_blocks(GridOptions::default());
    grid.step().unwrap();
    let kept = grid.contacts().to_vec();
    assert!(kept.len() > 100);
    let pair = grid.pairs()[0];
    assert_eq!((pair.state, pair.contact_count, pair.first_contact), (pair_state::BEGAN, kept.len() as u64, 0));
    assert_eq!(grid.pair_contacts().len(), kept.len());
    for p in grid.positions_mut::<f32>(b).unwrap() {
        p[0] += 100.0;
    }
    grid.step().unwrap();
    assert!(grid.contacts().is_empty());
    assert_eq!(grid.pairs()[0].state, pair_state::ENDED);
    assert!(kept.iter().all(|contact| contact.body_a == a || contact.body_a == b));
    assert_eq!(grid.counters()["contacts"], 0);
    assert!(grid.counters()["step_ns"] > 0);
}

/// Each kind, where it is expected, and what it says of the positions.
#[test]
fn constraints() {
    let options = GridOptions { constraints: true, edges: true, margin: 0.8, ..GridOptions::default() };
    let (mut grid, a, b) = two_blocks(options);
    grid.step().unwrap();
    let mut kinds = [0; 4];
    for c in grid.constraints().unwrap() {
        kinds[c.kind as usize] += 1;
        let at = [c.body_a, c.body_b].map(|id| grid.positions::<f32>(Body::from_id(id)).unwrap());
        let along = |i: usize| {
            let x = at[usize::from(i >= c.count_a as usize)][c.vertices[i] as usize].map(f64::from);
            c.weights[i] * (0..3).map(|k| c.normal[k] * x[k]).sum::<f64>()
        };
        let gap = c.offset + (0..c.count as usize).map(along).sum::<f64>();
        assert!((gap - c.gap).abs() < 1e-9, "{gap}, {c:?}");
        assert!((c.gap >= 0.0) == (c.kind == constraint_kind::PROXIMITY) || c.gap == 0.0, "{c:?}");
        assert_eq!(c.previous, NONE);
    }
    assert!(kinds[..3].iter().all(|&count| count > 0) && kinds[3] == 0, "{kinds:?}");
    assert_eq!(grid.constraints_of(0).unwrap(), grid.constraints().unwrap());
    let all = ConstraintOptions::default();
    grid.find_constraints(ConstraintOptions { method: DepthMethod::None, a: Some(b), b: Some(a), ..all }).unwrap();
    assert!(grid.constraints().unwrap().iter().any(|c| c.state == depth_state::UNKNOWN));
    let nearest = ConstraintOptions { method: DepthMethod::Closest, closest_budget: 1, ..all };
    grid.find_constraints(nearest).unwrap();
    let searched = |c: &&Constraint| c.kind == constraint_kind::INSIDE && c.state != depth_state::UNKNOWN;
    assert_eq!(grid.constraints().unwrap().iter().filter(searched).count(), 1);
    grid.find_constraints(ConstraintOptions { mask: 2, ..all }).unwrap();
    assert!(grid.constraints().unwrap().is_empty() && grid.constraints_of(0).unwrap().is_empty());
    assert_eq!(code(grid.find_constraints(ConstraintOptions { b: Some(a), ..all })), ErrorCode::InvalidArgument);
    grid.remove(b).unwrap();
    assert_eq!(code(grid.find_constraints(all)), ErrorCode::InvalidState);
}

/// A vertex that went through a mesh within the step, until its mesh stands still.
#[test]
fn previous_positions() {
    let mut grid = Grid::with_options(GridOptions { constraints: true, ..GridOptions::default() }).unwrap();
    grid.add(&UNIT, &TET).unwrap();
    let past = [[0.2f32, 0.2, -0.1]];
    let point = grid.add(&past, &[]).unwrap();
    grid.set_previous_positions(point, &[[0.2, 0.2, 3.0]]).unwrap();
    for _ in 0..2 {
        grid.step().unwrap();
        assert_eq!(grid.constraints().unwrap()[0].kind, constraint_kind::IMPACT);
        grid.set_previous_positions(point, &[[0.2f32, 0.2, 2.0]]).unwrap();
    }
    assert_eq!(code(grid.set_previous_positions(point, &UNIT)), ErrorCode::InvalidArgument);
    grid.end_previous_positions(point).unwrap();
    grid.step().unwrap();
    assert!(grid.constraints().unwrap().is_empty());
    grid.set_previous_positions(point, &past).unwrap();
    grid.remove(point).unwrap();
    grid.step().unwrap();
    assert_eq!(code(grid.set_previous_positions(point, &past)), ErrorCode::InvalidHandle);
    let point = grid.add(&past, &[]).unwrap();
    grid.set_previous_positions(point, &past).unwrap();
    grid.clear().unwrap();
    grid.step().unwrap();
}

#[test]
fn threads_read_one_grid() {
    let (mut grid, ..) = two_blocks(GridOptions { workers: ALL_CORES, ..GridOptions::default() });
    grid.step().unwrap();
    let (grid, hash) = (&grid, grid.hash());
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(move || {
                for _ in 0..50 {
                    assert_eq!(grid.hash(), hash);
                    assert!(!grid.contacts().is_empty());
                }
            });
        }
    });
}

#[test]
fn a_locator_outlives_its_grid() {
    let (mut grid, a, _) = two_blocks(GridOptions::default());
    let locator = grid.locator().unwrap();
    let asking = locator.clone();
    let thread = std::thread::spawn(move || {
        let hits = || asking.find_point_hits(&[[4.5, 2.25, 3.125]], QueryOptions::default());
        (0..200).map(|_| hits().unwrap().len()).sum::<usize>()
    });
    for _ in 0..5 {
        for p in grid.positions_mut::<f32>(a).unwrap() {
            p[2] += 0.01;
        }
        grid.step().unwrap();
    }
    drop(grid);
    assert_eq!(thread.join().unwrap(), 400);
    assert_eq!(locator.user_data(a).unwrap(), 0);
}

#[test]
fn locators() {
    let (mut grid, a, b) = two_blocks(GridOptions::default());
    let mut locator = grid.locator().unwrap();
    let all = QueryOptions::default();
    let (from, to) = ([[-1.0, 0.5, 0.5], [-1.0, 9.0, 0.0]], [[9.0, 0.5, 0.5], [9.0, 9.0, 0.0]]);
    let hits = locator.find_ray_hits(&from, &to, all).unwrap();
    assert!(hits.len() > 2 && hits.iter().all(|hit| hit.ray == 0));
    assert_eq!((hits[0].body, hits[0].side), (a.id(), side::ENTERS));
    let first = locator.find_ray_hits(&from, &to, QueryOptions { first_hit: true, ..all }).unwrap();
    assert_eq!(first, hits[..1]);
    let others = locator.find_ray_hits(&from, &to, QueryOptions { excluded: Some(a), ..all }).unwrap();
    assert!(others[0].body == b);
    assert_eq!(locator.test_rays(&from, &to, all).unwrap(), [true, false]);
    assert_eq!(locator.test_rays(&from, &to, QueryOptions { mask: 2, ..all }).unwrap(), [false, false]);
    assert_eq!(code(locator.test_rays(&from, &to[..1], all)), ErrorCode::InvalidArgument);
    let found = locator.locate(&from[..1], all).unwrap()[0];
    assert_eq!((found.body, found.state, found.distance), (a.id(), location_state::OUTSIDE, 1.0));
    assert!(found.weights.iter().all(|&weight| weight >= 0.0));
    let beyond = locator.locate(&from[..1], QueryOptions { extrapolate: true, ..all }).unwrap()[0];
    assert!(beyond.tet == found.tet && beyond.weights.iter().any(|&weight| weight < 0.0));
    let none = locator.locate(&from[..1], QueryOptions { max_distance: 0.5, ..all }).unwrap()[0];
    assert_eq!((none.body, none.state), (0, location_state::NONE));
    let pieces = locator.find_tracks(&from, &to, QueryOptions { excluded: Some(b), ..all }).unwrap();
    assert!(pieces.len() > 2 && pieces.windows(2).all(|next| next[0].t_out == next[1].t_in));
    assert_eq!(code(locator.find_tracks(&from, &to[..1], all)), ErrorCode::InvalidArgument);
    let axis = locator.find_closest_to_segments(&from, &to, all).unwrap();
    assert!(axis[0].distance == 0.0 && axis[0].body != 0 && axis[1].distance > 0.0);
    let blade = [from[0], to[0], to[0]];
    let cut = locator.find_triangle_hits(&blade, None, all).unwrap();
    assert!(cut.len() > 2 && cut.iter().all(|hit| hit.t == 0.0));
    assert!(locator.find_triangle_hits(&[from[0]; 3], Some(&blade), all).unwrap().iter().all(|hit| hit.t > 0.0));
    assert_eq!(code(locator.find_triangle_hits(&from, None, all)), ErrorCode::InvalidArgument);
    assert_eq!(locator.find_closest(&from[..1], all).unwrap()[0].distance, 1.0);
    let near = QueryOptions { max_distance: 0.5, ..all };
    assert_eq!(locator.find_closest(&from[..1], near).unwrap()[0].body, 0);
    let found = locator.find_box_hits(&[[-9.0f32; 3]], &[[99.0; 3]], all).unwrap();
    assert_eq!(found.len(), 2 * 6 * 6 * 6 * 5); // more than there is room for at first
    let (before, epoch) = (locator.clone(), locator.epoch());
    grid.positions_mut::<f32>(a).unwrap()[0][0] = f32::NAN;
    assert_eq!(code(locator.update(&mut grid)), ErrorCode::NonFinite);
    grid.remove(a).unwrap();
    assert!(locator.user_data(a).is_ok());
    grid.step().unwrap();
    locator.update(&mut grid).unwrap();
    assert_eq!(code(locator.user_data(a)), ErrorCode::InvalidHandle);
    assert!(before.user_data(a).is_ok());
    assert!(before.epoch() == epoch && locator.epoch() > epoch);
}

#[test]
fn the_log() {
    let lines = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&lines);
    let mut grid = Grid::with_options(GridOptions {
        log: Some(Box::new(move |level, text| {
            sink.lock().unwrap().push((level, text.to_owned()));
            panic!("of a log");
        })),
        ..GridOptions::default()
    })
    .unwrap();
    grid.add(&UNIT, &[]).unwrap(); // edges and faces collide with nothing
    let lines = lines.lock();
    let lines = lines.unwrap_or_else(std::sync::PoisonError::into_inner);
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0].0, LogLevel::Warning);
}

/// Threads that keep the rules, or break one.
struct Threads {
    defect: u32,
    calls: AtomicUsize,
}

impl TaskSystem for Threads {
    fn workers(&self) -> u32 {
        3
    }

    fn run(&self, workers: u32, task: &(dyn Fn(u32) + Sync)) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        match self.defect {
            1 => return,
            2 => return task(99),          // of no such worker
            4 => return task(workers - 1), // does all of the work
            _ => {}
        }
        std::thread::scope(|scope| {
            for worker in 0..workers {
                scope.spawn(move || task(worker));
                if self.defect == 5 {
                    scope.spawn(move || task(worker + workers));
                }
            }
        });
        assert!(self.defect != 3, "of a task system");
    }
}

#[test]
fn task_systems() {
    let (mut serial, a, _) = blocks_of(24, GridOptions::default());
    serial.step().unwrap();
    for defect in 0..6 {
        let tasks = Arc::new(Threads { defect, calls: AtomicUsize::new(0) });
        let (mut grid, ..) = blocks_of(24, GridOptions { tasks: Some(tasks.clone()), ..GridOptions::default() });
        for workers in [3, 2, 64] {
            grid.set_workers(workers).unwrap();
            grid.mark_moved(a).unwrap();
            let result = grid.step();
            match defect {
                1 | 2 => assert_eq!(code(result), ErrorCode::InvalidArgument),
                5 if result.is_err() => assert_eq!(code(result), ErrorCode::InvalidArgument),
                _ => {
                    result.unwrap(); // of 3: all items were run before the panic
                    assert_eq!(grid.hash(), serial.hash());
                }
            }
        }
        assert!(tasks.calls.load(Ordering::Relaxed) > 0);
        assert_eq!(code(grid.set_workers(ALL_CORES)), ErrorCode::InvalidArgument);
    }
}

#[cfg(feature = "rayon")]
#[test]
fn rayon_tasks() {
    let (mut serial, a, _) = blocks_of(24, GridOptions::default());
    serial.step().unwrap();
    let (mut grid, ..) = blocks_of(24, GridOptions { tasks: Some(Arc::new(RayonTasks)), ..GridOptions::default() });
    grid.step().unwrap();
    assert_eq!(grid.hash(), serial.hash());
    // Also in a pool of more threads than the one in which the grid was made, and of fewer.
    for threads in [rayon::current_num_threads() + 5, 1] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        grid.mark_moved(a).unwrap();
        pool.install(|| grid.step()).unwrap();
        assert_eq!(grid.hash(), serial.hash());
    }
}

#[test]
fn many_grids() {
    let mut grids: Vec<Grid> = (0..20).map(|_| two_blocks(GridOptions::default()).0).collect();
    step_grids(&mut grids, 2).unwrap();
    assert!(grids.iter().all(|grid| grid.hash() == grids[0].hash() && !grid.contacts().is_empty()));
    let mesh = grids[7].bodies()[0];
    grids[7].positions_mut(mesh).unwrap()[3][0] = f32::INFINITY;
    let (error, codes) = step_grids(&mut grids, ALL_CORES).unwrap_err();
    assert!(error.to_string().starts_with("grid 7: "), "{error}");
    assert_eq!(codes.iter().filter(|code| code.is_some()).count(), 1);
    assert_eq!(codes[7], Some(ErrorCode::NonFinite));
    let (error, codes) = step_grids(&mut grids, 1000).unwrap_err();
    assert_eq!(error.code(), ErrorCode::InvalidArgument);
    assert!(codes.is_empty());
}

#[test]
fn filters() {
    let (mut grid, a, b) = two_blocks(GridOptions::default());
    let of = |grid: &Grid, mesh| grid.filter(mesh).unwrap();
    assert_eq!(of(&grid, a), Filter { category: 1, mask: u64::MAX, ..Filter::default() });
    grid.set_filter(b, Filter { sensor: true, self_collision: true, ..Filter::default() }).unwrap();
    assert!(of(&grid, b).sensor && of(&grid, b).self_collision);
    grid.step().unwrap();
    grid.find_constraints(ConstraintOptions::default()).unwrap();
    assert!(!grid.contacts().is_empty() && grid.constraints().unwrap().is_empty());
    grid.set_filter(b, Filter { world: 7, ..Filter::default() }).unwrap();
    assert_eq!(of(&grid, b).world, 7);
    grid.step().unwrap();
    assert!(grid.contacts().is_empty());
}

#[test]
fn the_reference_engine() {
    let (mut fast, ..) = two_blocks(GridOptions::default());
    fast.step().unwrap();
    let box_of = [[-1.0; 3], [20.0; 3]];
    for reference in [
        Reference::default(),
        Reference { paper_hash: true, hash_table_size: 100, ..Reference::default() },
        Reference { dense: true, world: box_of, ..Reference::default() },
    ] {
        let (mut grid, ..) = two_blocks(GridOptions { reference: Some(reference), ..GridOptions::default() });
        grid.step().unwrap();
        assert_eq!(grid.hash(), fast.hash(), "{reference:?}");
    }
    let reference = Some(Reference { dense: true, world: [[1.0; 3]; 2], ..Reference::default() });
    assert_eq!(
        code(Grid::with_options(GridOptions { reference, ..GridOptions::default() })),
        ErrorCode::InvalidArgument
    );
}

#[test]
fn flags_go_with_a_snapshot() {
    let mut grid = Grid::new().unwrap();
    assert_eq!(grid.flags(), (false, false, false));
    for flags in [(false, true, false), (true, false, true), (true, true, false)] {
        grid.set_flags(flags.0, flags.1, flags.2).unwrap();
        assert_eq!(grid.flags(), flags);
        let copy = Grid::load(&grid.save().unwrap(), GridOptions::default()).unwrap();
        assert_eq!(copy.flags(), flags);
    }
}

#[test]
fn cell_sizes() {
    let (positions, tets) = block(4, 0.0);
    let meshes = [MeshArrays::new(&positions, &tets).with_self_collision()];
    let suggestion = suggest_cell_size(&meshes, CellSizeOptions::default()).unwrap();
    assert!(suggestion.zone_min < suggestion.cell_size && suggestion.cell_size < suggestion.zone_max);
    assert!(suggestion.terms.iter().all(|term| !term.name.is_empty()));
    let geometry = measure_geometry(&meshes).unwrap();
    assert_eq!((geometry.vertices, geometry.tets), (positions.len() as u64, tets.len() as u64));
    assert!(geometry.mean_edge > 0.0 && geometry.bounds_min[0] < geometry.bounds_max[0]);
    assert_eq!(code(measure_geometry(&[MeshArrays::new(&positions, &[[0, 1, 2, 9999]])])), ErrorCode::InvalidMesh);
    assert_eq!(code(suggest_cell_size(&[], CellSizeOptions::default())), ErrorCode::InvalidArgument);
    let least = minimise(|x| (x - 2.0).powi(2) + 1.0, 0.1, 10.0, 0.05).unwrap();
    assert!((least.cell_size - 2.0).abs() < 1e-3 && (least.cost - 1.0).abs() < 1e-6);
    assert!(std::panic::catch_unwind(|| minimise(|_| panic!("of a cost"), 0.1, 10.0, 0.05)).is_err());
    assert_eq!(code(minimise(|x| x, 2.0, 1.0, 0.0)), ErrorCode::InvalidArgument);
    let (grid, ..) = two_blocks(GridOptions::default());
    assert!(grid.suggest_cell_size(None).unwrap().cell_size > 0.0);
}

#[test]
fn weights() {
    let (positions, tets) = block(4, 0.0);
    let meshes = [MeshArrays::new(&positions, &tets).with_self_collision()];
    let slow = calibrate().unwrap().map(|ns| 1000.0 * ns); // of a machine that is far slower
    let reference = Some(Reference { weights: Some(slow), ..Reference::default() });
    let (grid, ..) = two_blocks(GridOptions { reference, ..GridOptions::default() });
    let options = |weights| CellSizeOptions { model: CostModel::Reference, weights, ..CellSizeOptions::default() };
    let costs = [Some(slow), Some([0.0; 24]), None].map(|weights| {
        let of_meshes = suggest_cell_size(&meshes, options(weights)).unwrap();
        let of_grid = grid.suggest_cell_size(Some(options(weights))).unwrap();
        (of_meshes.cost, of_grid.cost)
    });
    assert!(costs[0].0 > 10.0 * costs[1].0 && costs[0].1 > 10.0 * costs[1].1);
    assert_eq!(costs[2], (costs[1].0, costs[0].1)); // those shipped, those of the grid's engine
    assert_eq!(code(suggest_cell_size(&meshes, options(Some([-1.0; 24])))), ErrorCode::InvalidArgument);
}

#[test]
fn grids_of_others() {
    let (positions, tets) = block(4, 0.0);
    let stored = Primitives::tets(&positions, &tets);
    let radii = vec![0.1f32; positions.len()];
    let querying = Primitives::points(&positions).with_radii(&radii).unwrap().with_radius(0.2);
    let grid = ForeignGrid { querying: Some(querying), ..ForeignGrid::new(KnownGrid::Hashed, stored) };
    let suggestion = grid.suggest().unwrap();
    assert!(suggestion.zone_min <= suggestion.cell_size && suggestion.cell_size <= suggestion.zone_max);
    let sum: f64 = suggestion.terms.iter().map(|term| term.cost).sum();
    assert!((sum - suggestion.cost).abs() <= 1e-9 * sum);
    assert!(suggestion.rules.iter().any(|rule| (rule.cell_size - 0.3).abs() < 1e-6 && rule.name.contains("radius")));
    assert_eq!(suggestion.note.is_empty(), suggestion.warnings == 0);
    let unknown = ForeignGrid::new(KnownGrid::None, stored).suggest().unwrap();
    assert_ne!(unknown.warnings & voxtet::cell_size_warning::GUESSED_WEIGHTS, 0);
    assert!(!unknown.note.is_empty());

    // A grid that takes as long as its counts say.
    let seconds = |size: f64| {
        let counts = grid.count(size).unwrap();
        1e-9 * (20.0 * counts.stored + 9.0 * counts.visits + 3.0 * counts.reads)
    };
    let timings = [0.3, 0.6, 1.2, 2.4].map(|cell_size| Timing { cell_size, seconds: seconds(cell_size) });
    let fitted = grid.fit(&timings).unwrap();
    assert!(fitted.fit_error < 0.02 && fitted.weights.store > 0.0);
    let weighed = ForeignGrid { weights: fitted.weights, ..grid };
    assert_eq!(weighed.suggest().unwrap().weights, fitted.weights);
    let mut runs = Vec::new();
    let run = |cell_size| {
        runs.push(Timing { cell_size, seconds: seconds(cell_size) });
        seconds(cell_size)
    };
    let tuned = tune(Some(&grid), run, TuneOptions::default()).unwrap();
    assert_eq!(tuned.timings, runs);
    assert!(seconds(tuned.cell_size) <= 1.1 * seconds(fitted.cell_size));
    assert!(tuned.expected_loss < 0.1 && tuned.curve.len() > 1);

    // What is wrong.
    let first = TuneOptions { first: 1.0, ..TuneOptions::default() };
    assert!(std::panic::catch_unwind(|| tune(None, |_| panic!("of a run"), first)).is_err());
    assert_eq!(code(tune(None, |_| 1.0, TuneOptions::default())), ErrorCode::InvalidArgument);
    assert_eq!(code(tune(None, |_| f64::INFINITY, first)), ErrorCode::InvalidState);
    assert_eq!(code(grid.fit(&timings[..2])), ErrorCode::InvalidArgument);
    assert_eq!(code(grid.count(f64::NAN)), ErrorCode::InvalidArgument);
    assert_eq!(code(stored.with_radii(&[1.0])), ErrorCode::InvalidArgument);
    let suggest = |stored| ForeignGrid::new(KnownGrid::None, stored).suggest();
    assert_eq!(code(suggest(Primitives::boxes::<f64>(&[]))), ErrorCode::InvalidArgument);
    for wrong in [Primitives::edges(&positions, &[[0, 9999]]), Primitives::triangles(&positions, &[[0, 1, 9999]])] {
        assert_eq!(code(suggest(wrong)), ErrorCode::InvalidMesh);
    }
    let boxes = [[[0.0, 0.0, 0.0], [1.0, 1.0, f64::NAN]]];
    assert_eq!(code(suggest(Primitives::boxes(&boxes))), ErrorCode::NonFinite);
}

/// Calls with arguments at random: each succeeds or fails with a text, and the grid still steps.
#[test]
fn anything_goes() {
    let mut state = 1u64;
    let mut random = move |below: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) % below
    };
    let (mut grid, ..) = two_blocks(GridOptions::default());
    let (mut refused, mut done) = (0, 0);
    for _ in 0..3000 {
        let mesh = match random(4) {
            0 => Body::from_id(random(1 << 32) as u32),
            _ => {
                let meshes = grid.bodies();
                meshes.get(random(meshes.len() as u64 + 1) as usize).copied().unwrap_or(Body::from_id(0))
            }
        };
        let list: Vec<u32> = (0..random(4)).map(|_| random(1500) as u32).collect();
        let corners: Vec<[u32; 4]> = list.iter().map(|_| [0; 4].map(|_| random(345) as u32)).collect();
        let number = [0.0, 1.5, -2.0, 1e300, f64::NAN, f64::INFINITY][random(6) as usize];
        let result = match random(20) {
            0 => grid.remove_tets(mesh, &list),
            1 => grid.set_tets_enabled(mesh, &list, random(2) == 0),
            2 => grid.replace_tets(mesh, &list, &corners),
            3 => grid.append_tets(mesh, &corners).map(drop),
            4 => grid.append_copies(mesh, &list).map(drop),
            5 => grid.remove_vertices(mesh, &list),
            6 => grid.set_transform(mesh, Some(&[1.0, 0.0, 0.0, number, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
            7 => grid.set_transform(mesh, None),
            8 => grid.set_cell_size(number),
            9 => grid.set_pair_enabled(mesh, Body::from_id(random(9000) as u32), random(2) == 0),
            10 => {
                let mask = u64::MAX >> random(64);
                let self_rings = random(3) as u32;
                grid.set_filter(mesh, Filter { mask, self_collision: random(2) == 0, self_rings, ..Filter::default() })
            }
            11 => grid.set_enabled(mesh, random(2) == 0),
            12 => grid.set_flags(random(2) == 0, random(2) == 0, random(2) == 0),
            13 if random(9) == 0 => grid.remove(mesh),
            14 if grid.bodies().len() < 4 => {
                let (positions, tets) = block(3, random(40) as f32 / 10.0);
                grid.add(&positions, &tets).map(drop)
            }
            15 => grid.locator().and_then(|l| l.find_point_hits(&[[number; 3]], QueryOptions::default()).map(drop)),
            16 => {
                let method = [DepthMethod::Consistent, DepthMethod::Closest, DepthMethod::None][random(3) as usize];
                let a = (random(2) == 0).then_some(mesh);
                grid.find_constraints(ConstraintOptions { method, a, ..ConstraintOptions::default() })
            }
            17 => {
                let past = grid.positions::<f32>(mesh).map(<[_]>::to_vec).unwrap_or_default();
                grid.set_previous_positions(mesh, &past[past.len().min(random(2) as usize)..])
            }
            18 => grid.set_margin(number / 100.0),
            _ => grid.step(),
        };
        match result {
            Ok(()) => done += 1,
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
                assert_ne!(error.code(), ErrorCode::Internal, "{error}");
            }
        }
    }
    assert!(refused > 300 && done > 300, "{refused} refused, {done} done");
}
