//! Stacks of unequal masses.

use bevy::math::Vec3;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("stack-10-on-1", || stack([1.0, 10.0])),
    Experiment::new("stack-100-on-1", || stack([1.0, 100.0])),
    Experiment::new("stack-1000-on-1", || stack([1.0, 1000.0])),
    Experiment::new("stack-10000-on-1", || stack([1.0, 10_000.0])),
    Experiment::new("stack-1-on-1000", || stack([1000.0, 1.0])),
];

/// A cube on a cube, for 5 s; masses from below.
fn stack(masses: [f32; 2]) -> Vec<Measurement> {
    let cube = |number: usize| {
        Specimen::cube(["lower", "upper"][number])
            .at(Vec3::Z * (number as f32 + 0.5))
            .weighing(masses[number])
    };
    let mut world = SmallWorld::new(SHIPPED, &[cube(0), cube(1)]);
    let mut deepest: f64 = 0.0;
    world.watch(5.0, |world| {
        let [lower, upper] = ["lower", "upper"].map(|id| world.location(id).z);
        deepest = deepest.max(0.5 - lower).max(1.0 - (upper - lower));
    });
    let drift = ["lower", "upper"]
        .map(|id| world.location(id).truncate().length())
        .into_iter()
        .fold(0.0, f64::max);
    let height = world.location("upper").z;
    vec![
        Measurement::none("penetration", deepest, 0.01),
        Measurement::none("drift", drift, 0.01),
        Measurement::near("height", "3/2", 1.5, height, 0.01),
    ]
}
