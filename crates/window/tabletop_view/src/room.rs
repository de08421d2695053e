//! The room around the table: a floor on which the table stands, and which fades into the distance (`room.wgsl`).

use bevy::{
    asset::embedded_asset, camera::ClearColorConfig, prelude::*,
    render::render_resource::AsBindGroup, shader::ShaderRef,
};
use tabletop_core::Table;
use tabletop_user::{Ambience, UserCamera};

use crate::spans::Spans as _;

/// The colour of the distance, as displayed.
const DISTANCE: Srgba = Srgba::rgb(0.125, 0.14, 0.16);

/// The colour of the floor around the table, as displayed.
const FLOOR: Srgba = Srgba::rgb(0.27, 0.29, 0.32);

/// Side of the floor, in units: its edge is as far as nothing else.
const SIDE: f32 = 1000.0;

/// The material of the floor below a table.
#[derive(Asset, AsBindGroup, TypePath, Clone, Copy, Debug, PartialEq)]
pub(crate) struct Floor {
    #[uniform(0)]
    near: LinearRgba,
    #[uniform(0)]
    far: LinearRgba,
    /// The spans of the table, in units.
    #[uniform(0)]
    span: Vec2,
}

/// Marks the entity that is the floor.
#[derive(Component)]
struct FloorOfRoom;

impl Floor {
    fn below(table: &Table) -> Self {
        Self {
            near: FLOOR.into(),
            far: DISTANCE.into(),
            span: table.spans(),
        }
    }
}

pub(crate) fn plugin(app: &mut App) {
    embedded_asset!(app, "room.wgsl");
    app.add_plugins((MaterialPlugin::<Floor>::default(), systems));
}

/// All systems but those that draw it.
pub(crate) fn systems(app: &mut App) {
    app.init_resource::<Assets<Floor>>()
        .add_systems(Startup, spawn_floor)
        .add_systems(
            Update,
            (furnish.run_if(resource_changed::<Ambience>), lay_floor),
        );
}

fn spawn_floor(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Floor>>,
) {
    let table = Table::default();
    commands.spawn((
        FloorOfRoom,
        Visibility::default(),
        Mesh3d(meshes.add(Plane3d::new(Vec3::Z, Vec2::splat(SIDE / 2.0)))),
        MeshMaterial3d(materials.add(Floor::below(&table))),
        Transform::from_translation(Vec3::NEG_Z * Table::THICKNESS),
    ));
}

fn furnish(
    ambience: Res<Ambience>,
    mut floor: Single<&mut Visibility, With<FloorOfRoom>>,
    mut cameras: Query<&mut Camera, With<UserCamera>>,
) {
    let (visibility, distance) = match ambience.is_room() {
        true => (Visibility::Inherited, DISTANCE.into()),
        false => (Visibility::Hidden, Color::BLACK),
    };
    floor.set_if_neq(visibility);
    for mut camera in &mut cameras {
        camera.clear_color = ClearColorConfig::Custom(distance);
    }
}

fn lay_floor(
    tables: Query<&Table, Changed<Table>>,
    mut materials: ResMut<Assets<Floor>>,
    material: Single<&MeshMaterial3d<Floor>, With<FloorOfRoom>>,
) {
    let Some(table) = tables.iter().next() else {
        return;
    };
    let laid = Floor::below(table);
    if materials.get(*material) != Some(&laid) {
        drop(materials.insert(material.id(), laid));
    }
}

impl Material for Floor {
    fn fragment_shader() -> ShaderRef {
        "embedded://tabletop_view/room.wgsl".into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_app::test_app;

    #[test]
    fn the_floor_is_below_the_table_and_gone_from_a_plain_ambience() {
        let mut app = test_app(systems);
        app.world_mut().spawn((UserCamera, Camera::default()));
        app.world_mut().spawn(Table::default());
        for (ambience, visibility, color) in [
            (Ambience::Room, Visibility::Inherited, DISTANCE.into()),
            (Ambience::ChosenRoom, Visibility::Inherited, DISTANCE.into()),
            (Ambience::Plain, Visibility::Hidden, Color::BLACK),
        ] {
            app.insert_resource(ambience);
            app.update();
            let world = app.world_mut();
            let mut floors = world.query_filtered::<(&Transform, &Visibility), With<FloorOfRoom>>();
            let (place, seen) = floors.single(world).unwrap();
            assert_eq!((place.translation.z, *seen), (-4.0, visibility));
            let mut cameras = world.query_filtered::<&Camera, With<UserCamera>>();
            let clear = &cameras.single(world).unwrap().clear_color;
            assert!(matches!(clear, ClearColorConfig::Custom(clear) if *clear == color));
        }
    }
}
