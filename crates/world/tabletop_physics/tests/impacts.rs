//! Impacts of elastic bodies have the results of the textbook.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{BALL, add_table, app, block, place, twist};
use tabletop_core::{Dynamics, prelude::*};
use tabletop_physics::PhysicsSettings;

/// A world with a table, in which all surfaces have this restitution.
fn world(restitution: f32) -> App {
    let mut app = app(PhysicsSettings {
        restitution,
        ..default()
    });
    add_table(&mut app);
    app
}

/// Adds a smooth object.
fn add(app: &mut App, at: Vec3, mass: f32, shape: Shape, velocity: Vec3) -> Entity {
    let dynamics = Dynamics {
        friction: Some(0.0),
        velocity,
        ..default()
    };
    kit::add(app, Pose::at(at), mass, shape, dynamics)
}

/// The greatest heights that an object reaches after each bounce.
fn peaks(app: &mut App, object: Entity, bounces: usize) -> Vec<f32> {
    let mut peaks = Vec::new();
    let mut rises = false;
    for _ in 0..2000 {
        let before = place(app, object).z;
        app.step(1);
        let now = place(app, object).z;
        if rises && now < before {
            peaks.push(before);
            if peaks.len() == bounces {
                break;
            }
        }
        rises = now > before;
    }
    peaks
}

#[test]
fn an_elastic_ball_keeps_its_height() {
    for drop in [0.5, 5.0] {
        let mut app = world(1.0);
        let ball = add(&mut app, Vec3::Z * (0.5 + drop), 1.0, BALL, Vec3::ZERO);
        for peak in peaks(&mut app, ball, 5) {
            let error = (peak - 0.5) / drop - 1.0;
            assert!(error.abs() < 0.01, "{drop}: {peak}");
        }
    }
}

#[test]
fn a_ball_rises_by_the_square_of_its_restitution() {
    for (restitution, drop) in [(0.8, 5.0), (0.5, 5.0), (0.8, 0.5)] {
        let mut app = world(restitution);
        let ball = add(&mut app, Vec3::Z * (0.5 + drop), 1.0, BALL, Vec3::ZERO);
        let peak = peaks(&mut app, ball, 1)[0] - 0.5;
        let expected = restitution * restitution * drop;
        assert!((peak / expected - 1.0).abs() < 0.02, "{peak} {expected}");
    }
}

#[test]
fn a_cube_that_falls_flat_does_not_turn() {
    for plate in [Vec3::new(0.5, 0.5, 0.5), Vec3::new(4.0, 3.0, 0.5)] {
        for restitution in [1.0, 0.1] {
            let mut app = world(restitution);
            add(&mut app, Vec3::Z * 0.25, 0.0, block(plate), Vec3::ZERO);
            let cube = add(&mut app, Vec3::Z * 6.0, 1.0, block(Vec3::ONE), Vec3::ZERO);
            let peak = peaks(&mut app, cube, 1)[0] - 1.0;
            let expected = restitution * restitution * 5.0;
            assert!((peak / expected - 1.0).abs() < 0.02, "{peak} {expected}");
            assert!(twist(&app, cube).angular.length() < 1e-3);
        }
    }
}

#[test]
fn a_row_of_elastic_balls_hands_on_its_speed() {
    for gap in [0.0, 0.01] {
        let mut app = world(1.0);
        let places = [-3.0, 0.0, 1.0, 2.0, 3.0, 4.0];
        let balls = places.map(|place: f32| {
            let at = Vec3::new(place * (1.0 + gap), 0.0, 0.5);
            let velocity = if place < 0.0 {
                Vec3::X * 10.0
            } else {
                Vec3::ZERO
            };
            add(&mut app, at, 1.0, BALL, velocity)
        });
        app.step(60);
        let speeds = balls.map(|ball| twist(&app, ball).linear.x);
        for (speed, expected) in speeds.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, 10.0]) {
            assert!((speed - expected).abs() < 0.01, "{gap}: {speeds:?}");
        }
    }
}

#[test]
fn a_small_ball_spins_as_fast_as_it_rolls() {
    let mut app = world(0.0);
    let ball = Shape::Sphere {
        radius: 0.1,
        color: Rgb::GRAY,
    };
    let ball = add(&mut app, Vec3::Z * 0.1, 1.0, ball, Vec3::ZERO);
    app.step(1);
    tabletop_physics::push(app.world_mut(), ball, Vec3::ZERO, Vec3::Y * 100.0);
    app.step(1);
    // Rolling damping takes 2 % of it in a tick.
    assert!(twist(&app, ball).angular.y > 90.0);
}

/// A world with a table, whose contacts have this friction and this restitution.
fn rough_world(friction: f32, restitution: f32) -> App {
    let mut app = app(PhysicsSettings {
        friction: friction.sqrt(),
        restitution,
        angular_damping: 0.0,
        rolling_damping: 0.0,
        ..default()
    });
    add_table(&mut app);
    app
}

/// The velocities of an object after it has met the table with 10 units/s along it.
fn after_skid(app: &mut App, shape: Shape) -> [Vec3; 2] {
    let dynamics = Dynamics {
        velocity: Vec3::new(10.0, 0.0, -22.0),
        ..default()
    };
    let at = Pose::at(Vec3::new(0.0, 0.0, 2.63));
    let object = kit::add(app, at, 1.0, shape, dynamics);
    app.step(7);
    let twist = twist(app, object);
    assert!(twist.linear.z > 0.0, "{twist:?}");
    [twist.linear, twist.angular]
}

#[test]
fn a_ball_that_skids_rolls_on() {
    for restitution in [0.5, 1.0] {
        let mut app = rough_world(1.0, restitution);
        let [linear, angular] = after_skid(&mut app, BALL);
        assert!((linear.x - 50.0 / 7.0).abs() < 0.02, "{linear}");
        assert!((angular.y - 100.0 / 7.0).abs() < 0.04, "{angular}");
    }
}

#[test]
fn friction_stops_a_flat_cube_and_does_not_turn_it_round() {
    let impact = (22.0_f32 * 22.0 + 2.0 * 98.1 * 2.13).sqrt();
    for (friction, restitution) in [(1.0, 0.3), (1.0, 0.9), (0.1, 0.3), (0.1, 0.9)] {
        let mut app = rough_world(friction, restitution);
        let [linear, angular] = after_skid(&mut app, block(Vec3::ONE));
        let expected = (10.0 - friction * (1.0 + restitution) * impact).max(0.0);
        assert!((linear.x - expected).abs() < 0.1, "{linear} {expected}");
        assert!(angular.length() < 0.05, "{angular}");
    }
}

#[test]
fn a_lively_ball_comes_to_rest() {
    let mut app = world(0.95);
    let ball = add(&mut app, Vec3::Z * 1.0, 1.0, BALL, Vec3::ZERO);
    app.step(330);
    assert!((place(&app, ball).z - 0.5).abs() < 1e-3);
}
