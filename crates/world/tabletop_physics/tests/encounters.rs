//! Bodies touch where they meet, and nowhere else.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{BALL, app, block, place, twist};
use tabletop_core::{Dynamics, prelude::*};
use tabletop_physics::PhysicsSettings;

const WEIGHTLESS: PhysicsSettings = PhysicsSettings {
    gravity: 0.0,
    friction: 0.0,
    restitution: 1.0,
    angular_damping: 0.0,
    rolling_damping: 0.0,
    ..PhysicsSettings::DEFAULT
};

fn add(app: &mut App, at: Vec3, mass: f32, shape: Shape, velocity: Vec3) -> Entity {
    let dynamics = Dynamics {
        velocity,
        ..default()
    };
    kit::add(app, Pose::at(at), mass, shape, dynamics)
}

#[test]
fn a_ball_falls_past_an_edge() {
    for drop in [2.0, 8.0] {
        let mut app = app(PhysicsSettings::DEFAULT);
        add(
            &mut app,
            Vec3::Z * 2.0,
            0.0,
            block(Vec3::splat(4.0)),
            Vec3::ZERO,
        );
        let above = Vec3::new(2.55, 0.0, 4.5 + drop);
        let ball = add(&mut app, above, 1.0, BALL, Vec3::ZERO);
        app.step(40);
        assert!(place(&app, ball).z < 4.0);
        assert_eq!(place(&app, ball).x, 2.55, "{drop}");
    }
}

#[test]
fn what_passes_with_a_little_air_is_not_struck() {
    for shape in [BALL, block(Vec3::ONE)] {
        for speed in [1.0, 20.0, 100.0] {
            for phase in 0..4_u8 {
                let mut app = app(WEIGHTLESS);
                let start = -1.2 - speed / 60.0 * (2.0 + f32::from(phase) / 4.0);
                let at = Vec3::new(start, 1.01, 0.0);
                let mover = add(&mut app, at, 1.0, shape.clone(), Vec3::X * speed);
                let still = add(&mut app, Vec3::ZERO, 1.0, shape.clone(), Vec3::ZERO);
                app.step(8 + (4.0 * 60.0 / speed) as u64);
                assert!(place(&app, mover).x > 1.0);
                let change = twist(&app, mover).linear - Vec3::X * speed;
                let changes = [
                    change,
                    twist(&app, mover).angular,
                    twist(&app, still).linear,
                ];
                let most = changes.map(Vec3::length).into_iter().fold(0.0, f32::max);
                assert!(most < 1e-3 * speed, "{speed} {phase}: {changes:?}");
            }
        }
    }
}

#[test]
fn a_glancing_blow_goes_along_the_line_of_centres() {
    for speed in [5.0, 20.0, 60.0] {
        for phase in 0..4_u8 {
            let mut app = app(WEIGHTLESS);
            let start = -1.2 - speed / 60.0 * (2.0 + f32::from(phase) / 4.0);
            let at = Vec3::new(start, 0.8, 0.0);
            add(&mut app, at, 1.0, BALL, Vec3::X * speed);
            let still = add(&mut app, Vec3::ZERO, 1.0, BALL, Vec3::ZERO);
            app.step(8 + (2.0 * 60.0 / speed) as u64);
            let expected = 0.6 * speed * Vec3::new(0.6, -0.8, 0.0);
            let error = twist(&app, still).linear - expected;
            assert!(error.length() < 0.005 * speed, "{speed} {phase}: {error}");
        }
    }
}
