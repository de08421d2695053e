//! Plates that rock on round things, and never gain energy.

use bevy::math::{Quat, Vec3};

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("rock-on-ball", || {
        rock(Specimen::ball("support", RADIUS).fixed())
    }),
    Experiment::new("rock-on-cylinder", || {
        rock(Specimen::cylinder("support", RADIUS, 4.0).fixed())
    }),
    Experiment::new("rock-on-free-cylinder", || {
        rock(Specimen::cylinder("support", RADIUS, 4.0))
    }),
    Experiment::new("rock-on-free-ball", || {
        rock(Specimen::ball("support", RADIUS))
    }),
    Experiment::new("rock-tilted", tilted),
];

/// Radius of the support.
const RADIUS: f32 = 1.0;

/// Thickness of the plate.
const THICKNESS: f32 = 0.2;

fn plate() -> Specimen {
    Specimen::block("plate", (4.0, 4.0, THICKNESS)).at(Vec3::Z * (2.0 * RADIUS + THICKNESS / 2.0))
}

/// A plate on the top of a round support, for 15 s.
fn rock(support: Specimen) -> Vec<Measurement> {
    let is_fixed = support.spec.is_fixed();
    let (gain, off) = gain(support.at(Vec3::Z * RADIUS), plate());
    let mut measurements = vec![Measurement::none("gain of energy/m g", gain, 0.01)];
    // On a support that rolls it may fall at any time.
    if is_fixed {
        measurements.push(Measurement::none("way of the plate", off, 0.05));
    }
    measurements
}

/// A plate that rolls to and fro on a lying cylinder, by 6° at first.
fn tilted() -> Vec<Measurement> {
    let tilt = f32::to_radians(6.0);
    let turn = Quat::from_rotation_y(tilt);
    // It touches the cylinder in the direction of the plate's normal, as far from the plate's middle as it has rolled.
    let touch = turn * Vec3::Z * (RADIUS + THICKNESS / 2.0) - turn * Vec3::X * (RADIUS * tilt);
    let plate = plate().at(Vec3::Z * RADIUS + touch).turned(turn);
    let support = Specimen::cylinder("support", RADIUS, 4.0)
        .at(Vec3::Z * RADIUS)
        .rough(1.0)
        .fixed();
    let (gain, _) = gain(support, plate.rough(1.0));
    vec![Measurement::none("gain of energy/m g", gain, 0.01)]
}

/// The greatest gain of energy within 15 s, as a height of the plate, and how far the plate goes.
fn gain(support: Specimen, plate: Specimen) -> (f64, f64) {
    let start = plate.spec.pose.location.as_dvec3();
    let weight = plate.mass() * G;
    let specimens = [support, plate];
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    let energy = |world: &SmallWorld| specimens.iter().map(|it| world.energy(it)).sum::<f64>();
    let first = energy(&world);
    let (mut most, mut off) = (first, 0.0);
    world.watch(15.0, |world| {
        most = most.max(energy(world));
        off = f64::max(off, world.location("plate").distance(start));
    });
    ((most - first) / weight, off)
}
