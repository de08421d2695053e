//! A light object carries a heavy one.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{add_table, app, block, place, twist};
use tabletop_core::{Dynamics, prelude::*};

fn world() -> App {
    let mut app = app(default());
    add_table(&mut app);
    app
}

fn add(app: &mut App, at: Vec3, mass: f32, span: Vec3, velocity: Vec3) -> Entity {
    let dynamics = Dynamics {
        velocity,
        ..default()
    };
    kit::add(app, Pose::at(at), mass, block(span), dynamics)
}

/// How far the cubes of a tower are from their places at most, in 5 s; from below. The uppermost one falls from this height.
fn most_error(masses: &[f32], fall: f32) -> f32 {
    let mut app = world();
    let places: Vec<_> = (0..masses.len())
        .map(|number| Vec3::Z * (number as f32 + 0.5))
        .collect();
    let mut cubes = Vec::new();
    for (number, (at, mass)) in places.iter().zip(masses).enumerate() {
        let above = if number + 1 == masses.len() {
            fall
        } else {
            0.0
        };
        cubes.push(add(
            &mut app,
            *at + Vec3::Z * above,
            *mass,
            Vec3::ONE,
            Vec3::ZERO,
        ));
    }
    let mut most = 0.0_f32;
    for tick in 0..300 {
        app.step(1);
        for (number, (cube, at)) in cubes.iter().zip(&places).enumerate() {
            if number + 1 == masses.len() && fall > 0.0 && tick < 60 {
                continue;
            }
            most = most.max(place(&app, *cube).distance(*at));
        }
    }
    most
}

#[test]
fn a_light_cube_carries_heavy_ones() {
    for masses in [
        &[1.0, 1000.0][..],
        &[1.0, 10_000.0],
        &[1.0, 100_000.0],
        &[0.01, 1000.0],
        &[1.0, 100.0, 10_000.0],
        &[1.0, 1.0, 1.0, 1000.0],
        &[1000.0, 1.0, 1000.0],
        &[1000.0, 1.0, 10_000.0, 1.0],
    ] {
        let error = most_error(masses, 0.0);
        assert!(error < 0.01, "{masses:?}: {error}");
    }
}

#[test]
fn a_light_cube_catches_a_heavy_one() {
    for fall in [0.1, 1.0, 3.0] {
        let error = most_error(&[1.0, 10_000.0], fall);
        assert!(error < 0.04, "from {fall}: {error}");
    }
}

#[test]
fn four_light_legs_carry_a_heavy_plate() {
    let mut app = world();
    let mut legs = Vec::new();
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let at = Vec3::new(x, y, 0.5);
        legs.push((add(&mut app, at, 1.0, Vec3::ONE, Vec3::ZERO), at));
    }
    let at = Vec3::Z * 1.25;
    let span = Vec3::new(3.0, 3.0, 0.5);
    legs.push((add(&mut app, at, 10_000.0, span, Vec3::ZERO), at));
    app.step(300);
    for (body, at) in legs {
        let error = place(&app, body).distance(at);
        assert!(error < 0.01, "{at}: {error}");
    }
}

#[test]
fn a_light_object_is_as_light_as_before_once_its_load_is_gone() {
    let mut app = world();
    let light = add(&mut app, Vec3::Z * 0.5, 1.0, Vec3::ONE, Vec3::ZERO);
    let heavy = add(&mut app, Vec3::Z * 1.5, 10_000.0, Vec3::ONE, Vec3::ZERO);
    app.step(60);
    tabletop_physics::remove_object(app.world_mut(), heavy);
    app.step(2);
    add(
        &mut app,
        Vec3::new(-1.2, 0.0, 0.5),
        1.0,
        Vec3::ONE,
        Vec3::X * 10.0,
    );
    let mut fastest = 0.0_f32;
    for _ in 0..30 {
        app.step(1);
        fastest = fastest.max(twist(&app, light).linear.length());
    }
    assert!(fastest > 3.0, "{fastest}");
}
