//! The simulator in an ordinary Bevy app with a camera, materials and keys of its own:
//! `cargo run --release --example custom_app`.
//!
//! Only the plugins that simulate are added. The app draws the objects in its own way, and writes the same commands that
//! the program's own window writes: Space loads the next task file, G lifts the first object.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    window::WindowPlugin,
};
use tabletop::{geometry::Solid, prelude::*};

const TASKS: [&str; 3] = [
    "tablesetup/shapes.xml",
    "tablesetup/tower.xml",
    "tablesetup/logs.xml",
];

fn main() -> AppExit {
    App::new()
        .add_plugins(DefaultPlugins.set(WindowPlugin {
            primary_window: Some(Window {
                title: "my own app".into(),
                ..default()
            }),
            ..default()
        }))
        .add_plugins(TabletopSimPlugins)
        .add_systems(Startup, set_up)
        .add_systems(Update, (press_keys, draw_new_objects))
        .run()
}

fn set_up(mut commands: Commands, mut orders: CommandWriter) {
    commands.spawn((
        Camera3d::default(),
        bevy::core_pipeline::tonemapping::Tonemapping::None,
        Transform::from_xyz(-14.0, -16.0, 12.0).looking_at(Vec3::Z * 2.0, Vec3::Z),
    ));
    commands.spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(-4.0, -6.0, 10.0).looking_at(Vec3::ZERO, Vec3::Z),
    ));
    orders.write(Actor::App, SceneCommand::Load(TASKS[0].into()));
}

fn press_keys(
    keys: Res<ButtonInput<KeyCode>>,
    objects: Query<&ObjectSpec>,
    index: Res<ObjectIndex>,
    mut next: Local<usize>,
    mut orders: CommandWriter,
) {
    if keys.just_pressed(KeyCode::Space) {
        *next = (*next + 1) % TASKS.len();
        orders.write(Actor::App, SceneCommand::Load(TASKS[*next].into()));
    }
    let first = index
        .iter()
        .next()
        .and_then(|object| objects.get(object).ok());
    if let Some(first) = first
        && keys.just_pressed(KeyCode::KeyG)
    {
        let hand = Hand::Any;
        orders.write(
            Actor::App,
            HandCommand::Grasp {
                hand,
                object: first.id.clone(),
            },
        );
        orders.write(
            Actor::App,
            HandCommand::MoveBy {
                hand,
                offset: Vec3::Z * 3.0,
            },
        );
    }
}

/// Gives every object and the table a mesh for each of their solids, as children that move along.
fn draw_new_objects(
    objects: Query<(Entity, &ObjectSpec), Added<ObjectSpec>>,
    tables: Query<(Entity, &Table), Added<Table>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let objects = objects
        .iter()
        .map(|(object, spec)| (object, spec.shape.drawn()));
    let tables = tables
        .iter()
        .map(|(table, size)| (table, vec![size.slab()]));
    for (body, solids) in objects.chain(tables) {
        commands.entity(body).insert(Visibility::default());
        for part in solids {
            let mesh = match part.solid {
                Solid::Cuboid(span) => Mesh::from(Cuboid::from_size(span)),
                Solid::Cylinder { radius, yspan } => Mesh::from(Cylinder::new(radius, yspan)),
                Solid::Ball(radius) => Mesh::from(Sphere::new(radius)),
                Solid::Polyhedron(polyhedron) => {
                    let surface = polyhedron.surface(Rgb::WHITE);
                    Mesh::new(
                        PrimitiveTopology::TriangleList,
                        RenderAssetUsages::default(),
                    )
                    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, surface.positions)
                    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, surface.normals)
                    .with_inserted_indices(Indices::U32(surface.indices.concat()))
                }
            };
            let color = Color::srgb(part.color.red, part.color.green, part.color.blue);
            commands.spawn((
                ChildOf(body),
                Transform::from(part.pose),
                Mesh3d(meshes.add(mesh)),
                MeshMaterial3d(materials.add(color)),
            ));
        }
    }
}
