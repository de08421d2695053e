//! Small worlds, for tests.
#![allow(dead_code, clippy::allow_attributes, reason = "each test uses a part")]

use bevy::prelude::*;
use tabletop_core::{Dynamics, Table, prelude::*};
use tabletop_geometry::Twist;
use tabletop_physics::{PhysicsPlugin, PhysicsSettings};

/// An app with physics and nothing in it.
pub fn app(settings: PhysicsSettings) -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin { settings },
    ))
    .start();
    app
}

pub fn add_table(app: &mut App) {
    app.world_mut().spawn(Table {
        xspan: 100.0,
        yspan: 100.0,
    });
}

pub const BALL: Shape = Shape::Sphere {
    radius: 0.5,
    color: Rgb::GRAY,
};

pub fn block(span: Vec3) -> Shape {
    let color = Rgb::GRAY;
    Shape::Block { span, color }
}

pub fn add(app: &mut App, at: Pose, mass: f32, shape: Shape, dynamics: Dynamics) -> Entity {
    let mut object = ObjectSpec::new(format!("{at:?}"), at, mass, shape);
    object.dynamics = dynamics;
    app.world_mut().spawn((object, Transform::from(at))).id()
}

pub fn place(app: &App, object: Entity) -> Vec3 {
    app.world().get::<Transform>(object).unwrap().translation
}

pub fn twist(app: &App, object: Entity) -> Twist {
    *app.world().get::<Twist>(object).unwrap()
}
