//! Soft bodies in Bevy: a plugin keeps one grid, steps it once a frame, and tells other systems who touches whom and
//! which way leads out. Any entity with a `SoftBody` and a `Transform` takes part.

use bevy_app::{App, Plugin, PostUpdate, Update};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::{prelude::*, TransformSystems};
use voxtet::{pair_state, Body, Grid, GridOptions, MeshOptions};

/// Vertices in the frame of the entity, which a simulation may move, and tetrahedra over them.
#[derive(Component)]
#[require(Transform, Push)]
struct SoftBody {
    vertices: Vec<Vec3>,
    tets: Vec<[u32; 4]>,
}

/// The mesh of a soft body in the grid.
#[derive(Component)]
struct InGrid(Body);

/// What the deepest vertex of a body needs to get out of the body that it is in; zero where none is inside.
#[derive(Component, Default)]
struct Push(Vec3);

/// Two bodies began to touch, or no longer do.
#[derive(Message)]
struct Touch {
    bodies: [Entity; 2],
    began: bool,
}

#[derive(Resource)]
struct Contacts(Grid);

struct SoftBodyPlugin;

impl Plugin for SoftBodyPlugin {
    fn build(&self, app: &mut App) {
        let options = GridOptions { constraints: true, ..Default::default() };
        let grid = Grid::with_options(options).expect("a grid that finds constraints");
        app.insert_resource(Contacts(grid))
            .add_message::<Touch>()
            .add_observer(insert)
            .add_observer(remove)
            .add_systems(PostUpdate, (place, step, report).chain().after(TransformSystems::Propagate));
    }
}

/// A body joins the grid when it is spawned. The grid keeps its entity for us.
fn insert(
    added: On<Add, SoftBody>,
    bodies: Query<&SoftBody>,
    mut grid: ResMut<Contacts>,
    mut commands: Commands,
) -> Result {
    let body = bodies.get(added.entity)?;
    let vertices: Vec<[f32; 3]> = body.vertices.iter().map(|v| v.to_array()).collect();
    let options = MeshOptions { user_data: added.entity.to_bits(), ..Default::default() };
    let mesh = grid.0.add_with(&vertices, &body.tets, options)?;
    commands.entity(added.entity).insert(InGrid(mesh));
    Ok(())
}

fn remove(removed: On<Remove, InGrid>, bodies: Query<&InGrid>, mut grid: ResMut<Contacts>) -> Result {
    Ok(grid.0.remove(bodies.get(removed.entity)?.0)?)
}

/// Writes where the vertices are into the grid's own arrays. Of bodies that neither moved nor changed, nothing is
/// written, and the grid carries their contacts over.
fn place(
    bodies: Query<(&SoftBody, &GlobalTransform, &InGrid), Or<(Changed<SoftBody>, Changed<GlobalTransform>)>>,
    mut grid: ResMut<Contacts>,
) -> Result {
    for (body, transform, mesh) in &bodies {
        let affine = transform.affine();
        for (to, vertex) in grid.0.positions_mut::<f32>(mesh.0)?.iter_mut().zip(&body.vertices) {
            *to = affine.transform_point3(*vertex).to_array();
        }
    }
    Ok(())
}

fn step(mut grid: ResMut<Contacts>) -> Result {
    Ok(grid.0.step()?)
}

fn report(grid: Res<Contacts>, mut touches: MessageWriter<Touch>, mut pushes: Query<&mut Push>) -> Result {
    for pair in grid.0.pairs() {
        let bodies = [pair.user_data_a, pair.user_data_b].map(Entity::from_bits);
        if [pair_state::BEGAN, pair_state::ENDED].contains(&pair.state) {
            touches.write(Touch { bodies, began: pair.state == pair_state::BEGAN });
        }
    }
    for mut push in &mut pushes {
        push.0 = Vec3::ZERO;
    }
    for c in grid.0.constraints()? {
        let mut push = pushes.get_mut(Entity::from_bits(c.user_data_a))?;
        let way = Vec3::from(c.normal.map(|x| (x * -c.gap) as f32));
        if way.length() > push.0.length() {
            push.0 = way;
        }
    }
    Ok(())
}

// ---- a game with it -----------------------------------------------------------------------------

#[derive(Component)]
struct Falls;

fn fall(mut bodies: Query<&mut Transform, With<Falls>>) {
    for mut transform in &mut bodies {
        transform.translation.y -= 0.25;
    }
}

fn print(mut touches: MessageReader<Touch>, names: Query<&Name>, pushes: Query<&Push>) -> Result {
    for touch in touches.read() {
        let [a, b] = touch.bodies;
        let what = if touch.began { "touches" } else { "no longer touches" };
        // A body that was despawned has no name any more.
        println!("{} {what} {}", name(&names, a), name(&names, b));
        if touch.began {
            println!("  {} is to move by {}", names.get(a)?, pushes.get(a)?.0);
        }
    }
    Ok(())
}

fn name<'w>(names: &'w Query<&Name>, entity: Entity) -> &'w str {
    names.get(entity).map_or("what is gone", Name::as_str)
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, SoftBodyPlugin)).add_systems(Update, (print, fall).chain());
    let corner = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let peak = vec![Vec3::ZERO, Vec3::new(-1.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 1.0)];
    let tets = vec![[0, 1, 2, 3]];
    let drop =
        (Name::new("drop"), SoftBody { vertices: peak, tets: tets.clone() }, Transform::from_xyz(0.2, 1.0, 0.2), Falls);
    let drop = app.world_mut().spawn(drop).id();
    app.world_mut().spawn((Name::new("ground"), SoftBody { vertices: corner, tets }));
    for _ in 0..4 {
        app.update();
    }
    app.world_mut().despawn(drop);
    for _ in 0..2 {
        app.update();
    }
}
