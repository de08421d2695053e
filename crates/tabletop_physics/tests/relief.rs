//! What is pressed on something that does not move stays outside it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{TICK_SECONDS, prelude::*};
use tabletop_physics::PhysicsPlugin;

/// Speed of the press, in units/s.
const SPEED: f32 = 12.0;

#[derive(Component)]
struct Press;

fn press(mut presses: Query<&mut Transform, With<Press>>) {
    for mut place in &mut presses {
        place.translation.z -= SPEED * TICK_SECONDS;
    }
}

/// How deep, in units, an object is at most in a fixed slab, while another body is moved down on it and through it.
fn most_depth_under_a_press(shape: Shape, half_height: f32) -> f32 {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
    ))
    .add_systems(FixedUpdate, press.in_set(SimSystems::Actuate))
    .start();
    let span = Vec3::new(8.0, 8.0, 2.0);
    let color = Rgb::GRAY;
    let slab = ObjectSpec::new(
        "slab",
        Pose::at(Vec3::NEG_Z),
        0.0,
        Shape::Block { span, color },
    );
    let at = Vec3::Z * half_height;
    let object = ObjectSpec::new("object", Pose::at(at), 1.0, shape);
    app.world_mut()
        .spawn((slab, Transform::from_translation(Vec3::NEG_Z)));
    let object = app
        .world_mut()
        .spawn((object, Transform::from_translation(at)))
        .id();
    app.world_mut().spawn((
        Press,
        RigidBody::KinematicPositionBased,
        Collider::cuboid(1.5, 1.5, 0.5),
        Transform::from_xyz(0.0, 0.0, 3.5),
    ));
    let depths = (0..60).map(|_| {
        app.step(1);
        half_height - app.world().get::<Transform>(object).unwrap().translation.z
    });
    depths.fold(0.0, f32::max)
}

#[test]
fn nothing_is_pressed_into_what_does_not_move() {
    let color = Rgb::GRAY;
    let block = Shape::Block {
        span: Vec3::ONE,
        color,
    };
    let ball = Shape::Sphere { radius: 0.5, color };
    for shape in [block, ball] {
        let depth = most_depth_under_a_press(shape.clone(), 0.5);
        assert!(depth < 0.05, "{shape:?}: {depth}");
    }
}
