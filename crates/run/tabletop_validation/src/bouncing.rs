//! Balls and cubes that bounce.

use bevy::math::Vec3;
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld, TICK, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("bounce-1-from-5", || ball(1.0, 5.0)),
    Experiment::new("bounce-1-from-0.5", || ball(1.0, 0.5)),
    Experiment::new("bounce-0.8-from-5", || ball(0.8, 5.0)),
    Experiment::new("bounce-0.8-from-0.5", || ball(0.8, 0.5)),
    Experiment::new("bounce-0.5-from-5", || ball(0.5, 5.0)),
    Experiment::new("bounce-0.5-from-0.5", || ball(0.5, 0.5)),
    Experiment::new("bounce-0-from-5", || ball(0.0, 5.0)),
    Experiment::new("bounce-mean", mean),
    Experiment::new("bounce-ten-times", ten_times),
    Experiment::new("bounce-low-0.02", || low(0.02)),
    Experiment::new("bounce-low-0.1", || low(0.1)),
    Experiment::new("bounce-0.9-to-rest", || to_rest(0.9)),
    Experiment::new("bounce-0.95-to-rest", || to_rest(0.95)),
    Experiment::new("bounce-0.97-to-rest", || to_rest(0.97)),
    Experiment::new("bounce-cube-0.8", || cube(0.8, &[])),
    Experiment::new("bounce-cube", || cube(0.5, &[])),
    Experiment::new("bounce-cube-small-plate", || cube(0.5, &[plate(0.0, 0.6)])),
    Experiment::new("bounce-cube-large-plate", || cube(0.5, &[plate(0.0, 3.0)])),
    Experiment::new("bounce-cube-seam", || {
        cube(0.5, &[plate(-1.0, 2.0), plate(1.0, 2.0)])
    }),
    Experiment::new("bounce-cube-corner", || {
        cube(0.5, &[plate(-1.3, 2.0), plate(0.7, 2.0)])
    }),
];

/// All surfaces of one restitution, so that it is that of the contact.
const fn all(restitution: f32) -> PhysicsSettings {
    PhysicsSettings {
        restitution,
        ..UNDAMPED
    }
}

/// The heights to which an object rises after each impact, above its height at rest: (z − z₀) + v²/2g.
fn heights(world: &mut SmallWorld, id: &str, rest: f64, seconds: f64) -> Vec<f64> {
    let mut heights = Vec::new();
    let mut was_falling = true;
    world.watch(seconds, |world| {
        let speed = world.velocity(id).z;
        let height = world.location(id).z - rest + speed * speed / (2.0 * G);
        let is_rising = speed > 0.05;
        if is_rising && was_falling {
            heights.push(height);
        } else if is_rising && let Some(last) = heights.last_mut() {
            *last = height;
        }
        was_falling = !is_rising;
    });
    heights
}

fn first(heights: &[f64]) -> f64 {
    heights.first().copied().unwrap_or_default()
}

fn ball(restitution: f32, drop: f64) -> Vec<Measurement> {
    let ball = Specimen::ball("ball", 0.5).at(Vec3::Z * (drop as f32 + 0.5));
    let mut world = SmallWorld::new(all(restitution), &[ball]);
    let found = first(&heights(&mut world, "ball", 0.5, 1.0));
    let expected = f64::from(restitution).powi(2) * drop;
    vec![match restitution == 0.0 {
        true => Measurement::none("height", found, 0.01),
        false => Measurement::close("height", "e² h", expected, found, 0.03),
    }]
}

/// The restitution of a contact is the mean of both surfaces'.
fn mean() -> Vec<Measurement> {
    let ball = Specimen::ball("ball", 0.5).at(Vec3::Z * 5.5).elastic(1.0);
    let mut world = SmallWorld::new(all(0.2), &[ball]);
    let found = first(&heights(&mut world, "ball", 0.5, 1.0));
    let expected = 5.0 * 0.6_f64.powi(2);
    vec![Measurement::close(
        "height",
        "((e₁ + e₂)/2)² h",
        expected,
        found,
        0.03,
    )]
}

fn ten_times() -> Vec<Measurement> {
    const DROP: f64 = 2.0;
    let ball = Specimen::ball("ball", 0.5).at(Vec3::Z * (DROP as f32 + 0.5));
    let mut world = SmallWorld::new(all(1.0), &[ball]);
    let mut found = heights(&mut world, "ball", 0.5, 5.0);
    found.truncate(10);
    let lowest = found.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = found.iter().copied().fold(0.0, f64::max);
    vec![
        Measurement::close("bounces", "10", 10.0, found.len() as f64, 0.01),
        Measurement::close("lowest", "h", DROP, lowest, 0.03),
        Measurement::close("highest", "h", DROP, highest, 0.03),
    ]
}

/// An elastic ball that falls from next to nothing.
fn low(drop: f64) -> Vec<Measurement> {
    let ball = Specimen::ball("ball", 0.5).at(Vec3::Z * (drop as f32 + 0.5));
    let mut world = SmallWorld::new(all(1.0), &[ball]);
    let found = heights(&mut world, "ball", 0.5, 3.0);
    let last = found.last().copied().unwrap_or_default();
    let highest = found.iter().copied().fold(0.0, f64::max);
    vec![
        Measurement::close("highest", "h", drop, highest, 0.1),
        Measurement::close("last", "h", drop, last, 0.1),
    ]
}

/// The time after which a lively ball rests: that of the first fall and of all bounces.
fn to_rest(restitution: f64) -> Vec<Measurement> {
    const DROP: f64 = 2.0;
    let ball = Specimen::ball("ball", 0.5).at(Vec3::Z * (DROP as f32 + 0.5));
    let mut world = SmallWorld::new(all(restitution as f32), &[ball]);
    let expected = (2.0 * DROP / G).sqrt() * (1.0 + restitution) / (1.0 - restitution);
    let (mut ticks, mut last) = (0_u32, 0_u32);
    world.watch(2.0 * expected, |world| {
        ticks += 1;
        if world.location("ball").z > 0.501 {
            last = ticks;
        }
    });
    let found = f64::from(last) * TICK;
    vec![Measurement::close(
        "time to rest",
        "√(2h/g) (1 + e)/(1 − e)",
        expected,
        found,
        0.03,
    )]
}

/// A fixed plate on the table.
fn plate(x: f32, span: f32) -> Specimen {
    Specimen::block(format!("plate{x}"), (span, span, 0.5))
        .at((x, 0.0, 0.25))
        .fixed()
}

/// A cube that falls flat.
fn cube(restitution: f32, plates: &[Specimen]) -> Vec<Measurement> {
    const DROP: f64 = 5.0;
    let rest = if plates.is_empty() { 0.5 } else { 1.0 };
    let cube = Specimen::cube("cube").at(Vec3::Z * (DROP + rest) as f32);
    let mut specimens = plates.to_vec();
    specimens.push(cube);
    let settings = PhysicsSettings {
        restitution,
        ..SHIPPED
    };
    let mut world = SmallWorld::new(settings, &specimens);
    let found = first(&heights(&mut world, "cube", rest, 0.45));
    let spin = world.spin("cube").length();
    let expected = f64::from(restitution).powi(2) * DROP;
    vec![
        Measurement::close("height", "e² h", expected, found, 0.03),
        Measurement::none("spin", spin, 0.05),
    ]
}
