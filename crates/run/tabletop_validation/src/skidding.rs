//! Balls and cubes that skid when they bounce.

use bevy::math::{DVec3, Vec3};
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SmallWorld, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("skid-ball", || ball(1.0, 1.0)),
    Experiment::new("skid-ball-0.5", || ball(1.0, 0.5)),
    Experiment::new("skid-ball-smooth", || ball(0.04, 1.0)),
    Experiment::new("skid-cube", || cube(1.0, 0.3)),
    Experiment::new("skid-cube-elastic", || cube(1.0, 0.9)),
    Experiment::new("skid-cube-smooth", || cube(0.25, 0.3)),
    Experiment::new("skid-cube-smooth-elastic", || cube(0.25, 0.6)),
    Experiment::new("skid-rod", rod),
];

/// Speed along the table at first, in units/s.
const SPEED: f64 = 10.0;

/// Speed of the impact, in units/s.
const IMPACT: f64 = 30.0;

/// A world whose contacts have this friction and this restitution.
fn world(friction: f64, restitution: f64) -> PhysicsSettings {
    PhysicsSettings {
        friction: friction.sqrt() as f32,
        restitution: restitution as f32,
        ..UNDAMPED
    }
}

/// Falls onto the table at [`IMPACT`] and [`SPEED`], at several moments within a tick, and sees it in the air.
fn impacts(
    settings: PhysicsSettings,
    specimen: &Specimen,
    rest: f64,
) -> impl Iterator<Item = [DVec3; 2]> {
    (0..8).map(move |phase| {
        let drop = 2.0 + 0.07 * f64::from(phase);
        let first = (IMPACT * IMPACT - 2.0 * G * drop).sqrt();
        let velocity = DVec3::new(SPEED, 0.0, -first);
        let specimen = specimen.clone();
        let at = Vec3::new(-10.0, 0.0, (rest + drop) as f32);
        let mut world = SmallWorld::new(settings, &[specimen.at(at).moving(velocity.as_vec3())]);
        world.seconds((IMPACT - first) / G + 0.04);
        [world.velocity("it"), world.spin("it")]
    })
}

/// Friction stops the slip of a ball, if it can: it rolls with 5/7 of its speed.
fn ball(friction: f64, restitution: f64) -> Vec<Measurement> {
    const RADIUS: f64 = 0.5;
    let impulse = (friction * (1.0 + restitution) * IMPACT).min(SPEED * 2.0 / 7.0);
    let (mut speed, mut spin) = (0.0_f64, 0.0_f64);
    let expected = [SPEED - impulse, impulse / (0.4 * RADIUS)];
    for [velocity, turn] in impacts(
        world(friction, restitution),
        &Specimen::ball("it", 0.5),
        RADIUS,
    ) {
        speed = speed.max((velocity.x / expected[0] - 1.0).abs());
        spin = spin.max((turn.y / expected[1] - 1.0).abs());
    }
    vec![
        Measurement::none("error of the speed", speed, 0.01),
        Measurement::none("error of the spin", spin, 0.01),
    ]
}

/// Friction stops a flat cube, if it can, and does not turn it round.
fn cube(friction: f64, restitution: f64) -> Vec<Measurement> {
    let expected = (SPEED - friction * (1.0 + restitution) * IMPACT).max(0.0);
    let (mut error, mut spin) = (0.0_f64, 0.0_f64);
    for [velocity, turn] in impacts(world(friction, restitution), &Specimen::cube("it"), 0.5) {
        error = error.max((velocity.x - expected).abs());
        spin = spin.max(turn.length());
    }
    vec![
        Measurement::none("error of the speed/v", error / SPEED, 0.01),
        Measurement::none("spin", spin, 0.05),
    ]
}

/// A rod that falls on its end, tilted, and whose end slips: its energy does not rise.
fn rod() -> Vec<Measurement> {
    let mut most = 0.0_f64;
    for degrees in [10.0_f32, 30.0, 50.0, 70.0, 80.0] {
        let turned = tabletop_geometry::turn_about(Vec3::Y, degrees.to_radians());
        for speed in [-20.0, 0.0, 20.0] {
            let rod = Specimen::block("rod", (4.0, 0.2, 0.2))
                .turned(turned)
                .at((0.0, 0.0, 5.0))
                .moving((speed, 0.0, -20.0));
            let mut world = SmallWorld::new(self::world(0.8, 0.9), std::slice::from_ref(&rod));
            let before = world.energy(&rod);
            world.watch(0.4, |world| {
                most = most.max(world.energy(&rod) / before - 1.0)
            });
        }
    }
    vec![Measurement::none("gain of energy", most, 0.01)]
}
