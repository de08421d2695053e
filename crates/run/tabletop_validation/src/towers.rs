//! Towers, which stand still.

use std::f32::consts::FRAC_PI_2;

use bevy::math::{Quat, Vec3};
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("tower-of-ten", || stand(&cubes(), AWAKE, 60.0)),
    Experiment::new("tower-of-planks", || stand(&planks(), SHIPPED, 600.0)),
    Experiment::new("tower-of-planks-awake", || stand(&planks(), AWAKE, 600.0)).long(),
];

/// Settings in which nothing falls asleep.
const AWAKE: PhysicsSettings = PhysicsSettings {
    sleep: false,
    ..SHIPPED
};

/// Ten cubes on each other.
fn cubes() -> Vec<Specimen> {
    (0..10)
        .map(|storey| Specimen::cube(format!("cube{storey}")).at(Vec3::Z * (storey as f32 + 0.5)))
        .collect()
}

/// Thirty storeys of two Kapla planks each, crosswise.
fn planks() -> Vec<Specimen> {
    const SPAN: Vec3 = Vec3::new(1.17, 0.234, 0.078);
    let plank = |number: usize| {
        let (storey, side) = (number / 2, (number % 2) as f32 * 2.0 - 1.0);
        let turn = Quat::from_rotation_z(if storey % 2 == 0 { 0.0 } else { FRAC_PI_2 });
        let aside = turn * Vec3::Y * side * (SPAN.x - SPAN.y) / 2.0;
        Specimen::block(format!("plank{number}"), SPAN)
            .at(aside + Vec3::Z * (storey as f32 + 0.5) * SPAN.z)
            .turned(turn)
            .weighing(0.01)
    };
    (0..60).map(plank).collect()
}

fn stand(tower: &[Specimen], settings: PhysicsSettings, seconds: f64) -> Vec<Measurement> {
    let mut world = SmallWorld::new(settings, tower);
    world.seconds(seconds);
    let drift = tower
        .iter()
        .map(|part| {
            let start = part.spec.pose.location.as_dvec3();
            world.location(&part.spec.id).distance(start)
        })
        .fold(0.0, f64::max);
    vec![Measurement::none("drift", drift, 0.01)]
}
