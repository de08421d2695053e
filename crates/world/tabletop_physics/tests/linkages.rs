//! Linkages keep their energy.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use std::f32::consts::FRAC_PI_3;

use bevy::prelude::*;
use kit::{app, block, place, twist};
use tabletop_core::{Dynamics, Joint, JointKind, prelude::*};
use tabletop_physics::PhysicsSettings;

/// Length of an arm in units.
const LENGTH: f32 = 2.0;

/// Width of a bob in units.
const BOB: f32 = 0.5;

const UNDAMPED: PhysicsSettings = PhysicsSettings {
    angular_damping: 0.0,
    ..PhysicsSettings::DEFAULT
};

const FREE_HINGE: JointKind = JointKind::Hinge {
    min: -3.1,
    max: 3.1,
    damping: 0.0,
};

/// Pendulums, each on the one before, at 60° at first. Returns their bobs.
fn pendulums(app: &mut App, count: u8, kind: JointKind) -> Vec<Entity> {
    let turned = Quat::from_rotation_x(FRAC_PI_3);
    let arm = turned * (Vec3::NEG_Z * LENGTH);
    let mut bobs = Vec::new();
    let post = kit::add(
        app,
        Pose::IDENTITY,
        0.0,
        block(Vec3::splat(0.1)),
        Dynamics::default(),
    );
    let mut above = (post, Vec3::ZERO);
    for number in 1..=count {
        let at = Pose {
            location: arm * f32::from(number),
            rotation: turned,
        };
        let span = block(Vec3::splat(BOB));
        let bob = kit::add(app, at, 1.0, span, Dynamics::default());
        let joint = Joint {
            objects: [above.0, bob],
            frames: [Pose::at(above.1), Pose::at(Vec3::Z * LENGTH)],
            kind,
            collides: false,
        };
        app.world_mut().spawn((joint, ChildOf(bob)));
        bobs.push(bob);
        above = (bob, Vec3::ZERO);
    }
    bobs
}

/// The energy of bobs of 1 kg above their lowest places, in kg units²/s².
fn energy(app: &App, bobs: &[Entity]) -> f32 {
    let inertia = BOB * BOB / 6.0;
    let energies = (1_u8..).zip(bobs).map(|(number, bob)| {
        let twist = twist(app, *bob);
        let squares = twist.linear.length_squared() + inertia * twist.angular.length_squared();
        let height = place(app, *bob).z + LENGTH * f32::from(number);
        PhysicsSettings::DEFAULT.gravity * height + squares / 2.0
    });
    energies.sum()
}

#[test]
fn pendulums_keep_their_energy() {
    for kind in [FREE_HINGE, JointKind::Ball] {
        for count in 1..=3 {
            let mut app = app(UNDAMPED);
            let bobs = pendulums(&mut app, count, kind);
            app.step(1);
            let first = energy(&app, &bobs);
            for second in 1..=10 {
                app.step(60);
                let share = energy(&app, &bobs) / first;
                assert!(
                    (share - 1.0).abs() < 0.05,
                    "{kind:?}, {count} bobs: {share} after {second} s"
                );
            }
        }
    }
}

#[test]
fn a_pendulum_whose_rotation_dies_away_loses_what_that_takes() {
    let energies = [UNDAMPED, PhysicsSettings::DEFAULT].map(|settings| {
        let mut app = app(settings);
        let bobs = pendulums(&mut app, 1, FREE_HINGE);
        app.step(600);
        energy(&app, &bobs)
    });
    // Half of the energy turns the bob about itself by 1/24 of it, and dies away at twice the rate.
    let inertia = BOB * BOB / 6.0;
    let share = inertia / (inertia + LENGTH * LENGTH);
    let rate = 2.0 * PhysicsSettings::DEFAULT.angular_damping * share / 2.0;
    let expected = (-10.0 * rate).exp();
    let left = energies[1] / energies[0];
    assert!((left - expected).abs() < 0.02, "{left}, not {expected}");
}

#[test]
fn a_pendulum_that_is_stopped_gets_nothing_back() {
    let mut app = app(UNDAMPED);
    let stopped = JointKind::Hinge {
        min: 0.0,
        max: 3.1,
        damping: 0.0,
    };
    let bobs = pendulums(&mut app, 1, stopped);
    app.step(60);
    assert!(energy(&app, &bobs) < 1.0, "{}", energy(&app, &bobs));
}
