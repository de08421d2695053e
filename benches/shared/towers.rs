//! Unit blocks in towers, which benchmarks simulate.

use bevy::prelude::*;
use tabletop::{
    physics::{PhysicsPlugin, PhysicsSettings},
    prelude::*,
};

/// Places of the blocks: towers of five on a grid.
pub fn towers_of_five(blocks: usize) -> impl Iterator<Item = Vec3> {
    (0..blocks).map(|block| {
        let (tower, storey) = (block / 5, block % 5);
        let (column, row) = (tower % 8, tower / 8);
        Vec3::new(
            column as f32 * 2.0 - 7.0,
            row as f32 * 2.0 - 4.0,
            storey as f32 + 0.5,
        )
    })
}

/// The whole simulator, with unit blocks at these places.
pub fn simulator(settings: PhysicsSettings, locations: impl Iterator<Item = Vec3>) -> App {
    let physics = PhysicsPlugin { settings };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(physics));
    let items = locations
        .enumerate()
        .map(|(block, location)| {
            let shape = Shape::Block {
                span: Vec3::ONE,
                color: Rgb::GRAY,
            };
            let id = format!("block{block}");
            SceneItem::Object(ObjectSpec::new(id, Pose::at(location), 1.0, shape))
        })
        .collect();
    let scene = SceneSpec { items, ..default() };
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app
}
