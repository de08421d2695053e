//! What rolls and slides does it as the textbook says, over seams, too.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{BALL, app, block, place, twist};
use tabletop_core::{Dynamics, prelude::*};
use tabletop_physics::PhysicsSettings;

const CYLINDER: Shape = Shape::Cylinder {
    radius: 0.5,
    yspan: 1.0,
    color: Rgb::GRAY,
};

/// A world without damping.
fn world() -> App {
    app(PhysicsSettings {
        angular_damping: 0.0,
        rolling_damping: 0.0,
        ..default()
    })
}

fn add(app: &mut App, at: Pose, mass: f32, shape: Shape, friction: f32, velocity: Vec3) -> Entity {
    let dynamics = Dynamics {
        friction: Some(friction),
        velocity,
        ..default()
    };
    kit::add(app, at, mass, shape, dynamics)
}

fn velocity(app: &App, object: Entity) -> Vec3 {
    twist(app, object).linear
}

/// A floor of tiles along X, with its top at 0.
fn add_tiles(app: &mut App) {
    for tile in 0..16_u8 {
        let at = Pose::at(Vec3::new(2.0 * f32::from(tile), 0.0, -0.25));
        let tile = block(Vec3::new(2.0, 4.0, 0.5));
        add(app, at, 0.0, tile, 0.5, Vec3::ZERO);
    }
}

#[test]
fn smooth_things_keep_their_speed_over_seams() {
    for shape in [block(Vec3::ONE), BALL, CYLINDER] {
        let mut app = world();
        add_tiles(&mut app);
        let at = Pose::at(Vec3::Z * 0.5);
        let slider = add(&mut app, at, 1.0, shape.clone(), 0.0, Vec3::X * 10.0);
        for _ in 0..150 {
            app.step(1);
            let place = place(&app, slider);
            assert!((place.z - 0.5).abs() < 0.005, "{shape:?} at {place}");
        }
        let speed = velocity(&app, slider);
        assert!(
            (speed - Vec3::X * 10.0).length() < 0.05,
            "{shape:?} {speed}"
        );
    }
}

#[test]
fn a_block_stops_beyond_a_seam_where_friction_lets_it() {
    let mut app = world();
    add_tiles(&mut app);
    let cube = block(Vec3::ONE);
    let at = Pose::at(Vec3::Z * 0.5);
    let cube = add(&mut app, at, 1.0, cube, 0.5, Vec3::X * 10.0);
    app.step(120);
    let way = place(&app, cube).x;
    let expected = 100.0 / (2.0 * 0.25 * 98.1);
    assert!((way / expected - 1.0).abs() < 0.02, "{way} {expected}");
}

#[test]
fn a_step_still_stops_a_block() {
    let mut app = world();
    add_tiles(&mut app);
    let step = Pose::at(Vec3::new(2.0, 0.0, 0.1));
    add(
        &mut app,
        step,
        0.0,
        block(Vec3::new(1.0, 4.0, 0.2)),
        0.5,
        Vec3::ZERO,
    );
    let at = Pose::at(Vec3::Z * 0.5);
    let cube = add(&mut app, at, 1.0, block(Vec3::ONE), 0.0, Vec3::X * 5.0);
    app.step(60);
    let place = place(&app, cube);
    assert!(place.x < 1.05, "{place}");
}

#[test]
fn balls_and_cylinders_roll_down_slopes() {
    for (shape, share) in [(BALL, 5.0 / 7.0), (CYLINDER, 2.0 / 3.0)] {
        for degrees in [4.0_f32, 20.0] {
            let mut app = world();
            let slope = Quat::from_rotation_y(degrees.to_radians());
            let tilted = |above: f32| Pose {
                location: slope * Vec3::Z * above,
                rotation: slope,
            };
            let plane = block(Vec3::new(200.0, 20.0, 2.0));
            add(&mut app, tilted(-1.0), 0.0, plane, 1.0, Vec3::ZERO);
            let roller = add(&mut app, tilted(0.5), 1.0, shape.clone(), 1.0, Vec3::ZERO);
            app.step(30);
            let before = velocity(&app, roller).length();
            app.step(30);
            let acceleration = (velocity(&app, roller).length() - before) / 0.5;
            let expected = share * 98.1 * degrees.to_radians().sin();
            assert!(
                (acceleration / expected - 1.0).abs() < 0.02,
                "{shape:?} at {degrees}°: {acceleration} {expected}"
            );
        }
    }
}

#[test]
fn a_lying_cylinder_stays_where_it_is() {
    let mut app = world();
    let floor = block(Vec3::new(20.0, 20.0, 2.0));
    add(&mut app, Pose::at(Vec3::NEG_Z), 0.0, floor, 0.5, Vec3::ZERO);
    let lying = Pose {
        location: Vec3::Z * 0.51,
        rotation: Quat::from_rotation_z(0.7),
    };
    let cylinder = add(&mut app, lying, 1.0, CYLINDER, 0.5, Vec3::ZERO);
    app.step(300);
    let place = place(&app, cylinder);
    assert!(place.truncate().length() < 0.01, "{place}");
}
