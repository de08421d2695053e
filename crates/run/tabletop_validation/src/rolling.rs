//! Balls and cylinders that roll.
//!
//! A rolling body of inertia k m r² on a slope, whose rotation dies away at the rate c, obeys (1 + k) dv/dt = g sin θ − c k v.

use bevy::math::{DVec3, Vec3};
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    slopes::{down, on, slope},
    small_world::{G, SHIPPED, SmallWorld, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("roll-ball-4-degrees", || roll_down(BALL, 4.0, UNDAMPED)),
    Experiment::new("roll-ball-20-degrees", || roll_down(BALL, 20.0, UNDAMPED)),
    Experiment::new("roll-cylinder-4-degrees", || {
        roll_down(CYLINDER, 4.0, UNDAMPED)
    }),
    Experiment::new("roll-cylinder-20-degrees", || {
        roll_down(CYLINDER, 20.0, UNDAMPED)
    }),
    Experiment::new("roll-ball-4-degrees-damped", || {
        roll_down(BALL, 4.0, SHIPPED)
    }),
    Experiment::new("roll-ball-20-degrees-damped", || {
        roll_down(BALL, 20.0, SHIPPED)
    }),
    Experiment::new("roll-cylinder-4-degrees-damped", || {
        roll_down(CYLINDER, 4.0, SHIPPED)
    }),
    Experiment::new("roll-cylinder-20-degrees-damped", || {
        roll_down(CYLINDER, 20.0, SHIPPED)
    }),
    Experiment::new("roll-small-ball", || roll_along(BALL, 0.1, 6.6, UNDAMPED)),
    Experiment::new("roll-small-ball-damped", || {
        roll_along(BALL, 0.1, 6.6, SHIPPED)
    }),
    Experiment::new("roll-ball", || roll_along(BALL, 0.5, 6.6, UNDAMPED)),
    Experiment::new("roll-ball-damped", || roll_along(BALL, 0.5, 6.6, SHIPPED)),
    Experiment::new("roll-cylinder", || roll_along(CYLINDER, 0.5, 6.6, UNDAMPED)),
    Experiment::new("roll-cylinder-slowly", || {
        roll_along(CYLINDER, 0.5, 1.0, UNDAMPED)
    }),
    Experiment::new("roll-cylinder-damped", || {
        roll_along(CYLINDER, 0.5, 6.6, SHIPPED)
    }),
    Experiment::new("roll-after-sliding", roll_after_sliding),
];

/// A shape that rolls: how it is made from a radius, and its k.
#[derive(Clone, Copy)]
struct Roller(fn(f32) -> Specimen, f64);

const BALL: Roller = Roller(|radius| Specimen::ball("body", radius), 0.4);
const CYLINDER: Roller = Roller(|radius| Specimen::cylinder("body", radius, 1.0), 0.5);

/// The speed after a time from rest on a slope.
fn speed(k: f64, damping: f64, radians: f64, seconds: f64) -> f64 {
    let pull = G * radians.sin();
    match damping == 0.0 {
        true => pull * seconds / (1.0 + k),
        false => pull / (damping * k) * (1.0 - (-damping * k * seconds / (1.0 + k)).exp()),
    }
}

fn roll_down(Roller(make, k): Roller, degrees: f64, settings: PhysicsSettings) -> Vec<Measurement> {
    const SECONDS: f64 = 1.0;
    const RADIUS: f32 = 0.5;
    let slope = slope("slope", degrees.to_radians(), Vec3::Z * 15.0, 60.0);
    let body = make(RADIUS).posed(on(&slope, RADIUS));
    let down = down(&slope);
    let mut world = SmallWorld::new(settings, &[slope, body]);
    world.seconds(SECONDS);
    let found = world.velocity("body").dot(down);
    let damping = f64::from(settings.rolling_damping);
    let expected = speed(k, damping, degrees.to_radians(), SECONDS);
    let formula = match damping == 0.0 {
        true => "g sin θ t/(1 + k)",
        false => "g sin θ (1 − exp(−c k t/(1 + k)))/c k",
    };
    let slip = found - world.spin("body").y * f64::from(RADIUS);
    vec![
        Measurement::close("speed", formula, expected, found, 0.02),
        Measurement::near("slip", "v − ω r = 0", 0.0, slip, 0.02 * expected),
    ]
}

/// A body that rolls along the table without slip.
fn roll_along(
    Roller(make, k): Roller,
    radius: f32,
    start: f32,
    settings: PhysicsSettings,
) -> Vec<Measurement> {
    const SECONDS: f64 = 2.0;
    let body = make(radius)
        .at(Vec3::Z * radius)
        .moving(Vec3::X * start)
        .spinning(Vec3::Y * start / radius);
    let mut world = SmallWorld::new(settings, &[body]);
    let mut hop: f64 = 0.0;
    let rest = f64::from(radius);
    world.watch(SECONDS, |world| {
        hop = hop.max((world.location("body").z - rest).abs());
    });
    let damping = f64::from(settings.rolling_damping);
    let expected = f64::from(start) * (-damping * k * SECONDS / (1.0 + k)).exp();
    let formula = match damping == 0.0 {
        true => "v",
        false => "v exp(−c k t/(1 + k))",
    };
    let found = world.velocity("body");
    vec![
        Measurement::close("speed", formula, expected, found.x, 0.02),
        Measurement::none("change of height", hop, 0.01),
        Measurement::none("speed aside", found.dot(DVec3::Y).abs(), 0.01),
    ]
}

/// A ball that begins to slide rolls in the end.
fn roll_after_sliding() -> Vec<Measurement> {
    let ball = Specimen::ball("ball", 0.5)
        .at(Vec3::Z * 0.5)
        .moving(Vec3::X * 10.0);
    let mut world = SmallWorld::new(UNDAMPED, &[ball]);
    world.seconds(1.0);
    let found = world.velocity("ball").x;
    vec![Measurement::close(
        "speed",
        "5/7 v",
        50.0 / 7.0,
        found,
        0.01,
    )]
}
