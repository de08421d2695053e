//! Depenetration: an object that is pressed on a fixed body stays outside it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::prelude as rapier};
use tabletop_core::{TICK_SECONDS, prelude::*};
use tabletop_physics::{PhysicsPlugin, collider};

const COLOR: Rgb = Rgb::GRAY;

/// A body that moves down at a speed, in units/s.
#[derive(Component)]
struct Press(f32);

fn press(mut presses: Query<(&mut Transform, &Press)>) {
    for (mut place, Press(speed)) in &mut presses {
        place.translation.z -= speed * TICK_SECONDS;
    }
}

/// How deep, in units, an object is at most in the middle of a fixed slab, while a press is moved down on it and through it.
fn most_depth_under_a_press(shape: Shape, at: Pose, press_from: Vec3, speed: f32) -> f32 {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
    ))
    .add_systems(FixedUpdate, press.in_set(SimSystems::Actuate))
    .start();
    let span = Vec3::new(8.0, 8.0, 2.0);
    let slab = ObjectSpec::new(
        "slab",
        Pose::at(Vec3::NEG_Z),
        0.0,
        Shape::Block { span, color: COLOR },
    );
    let lowest = {
        let shape = collider(&shape).raw;
        move |at: &Transform| {
            let at = rapier::Pose::from_parts(at.translation, at.rotation);
            shape.compute_aabb(&at).mins.z
        }
    };
    let object = ObjectSpec::new("object", at, 1.0, shape);
    app.world_mut()
        .spawn((slab, Transform::from_translation(Vec3::NEG_Z)));
    let object = app.world_mut().spawn((object, Transform::from(at))).id();
    app.world_mut().spawn((
        Press(speed),
        RigidBody::KinematicPositionBased,
        Collider::cuboid(1.5, 1.5, 0.5),
        Transform::from_translation(press_from),
    ));
    let depths = (0..60).map(|_| {
        app.step(1);
        let at = app.world().get::<Transform>(object).unwrap();
        match at.translation.xy().abs().max_element() < 2.5 {
            true => -lowest(at),
            false => 0.0,
        }
    });
    depths.fold(0.0, f32::max)
}

#[test]
fn nothing_is_pressed_into_a_fixed_body() {
    let block = Shape::Block {
        span: Vec3::ONE,
        color: COLOR,
    };
    let ball = Shape::Sphere {
        radius: 0.5,
        color: COLOR,
    };
    for shape in [block, ball] {
        let at = Pose::at(Vec3::Z * 0.5);
        let depth = most_depth_under_a_press(shape.clone(), at, Vec3::Z * 3.5, 12.0);
        assert!(depth < 0.05, "{shape:?}: {depth}");
    }
}

#[test]
fn a_pressed_and_turning_stick_stays_out_of_a_fixed_body() {
    let span = Vec3::new(2.0, 0.6, 0.6);
    let stick = Shape::Block { span, color: COLOR };
    for number in 0..400 {
        let [a, b, c, d, e] =
            [2.0f32, 3.0, 5.0, 7.0, 11.0].map(|it| (number as f32 * it.sqrt()).fract());
        let tilt = Vec3::new(360.0 * a, 360.0 * b, 40.0);
        let at = Pose::from_degrees(Vec3::Z * (1.1 + 0.5 * c), tilt);
        let from = Vec3::new(2.2, 0.0, 3.0 + 0.3 * d);
        let depth = most_depth_under_a_press(stick.clone(), at, from, 5.0 + 40.0 * e);
        assert!(depth < 0.05, "{number}: {depth}");
    }
}
