//! Free fall, and throws.

use bevy::math::Vec3;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("fall-ball", || fall(Specimen::ball("body", 0.5))),
    Experiment::new("fall-cube", || fall(Specimen::cube("body"))),
    Experiment::new("throw", throw),
];

fn fall(body: Specimen) -> Vec<Measurement> {
    const SECONDS: f64 = 0.5;
    let mut world = SmallWorld::new(SHIPPED, &[body.at(Vec3::Z * 30.0)]);
    world.seconds(SECONDS);
    let fallen = 30.0 - world.location("body").z;
    let speed = -world.velocity("body").z;
    vec![
        Measurement::close("way", "g t²/2", G * SECONDS * SECONDS / 2.0, fallen, 0.01),
        Measurement::close("speed", "g t", G * SECONDS, speed, 0.01),
    ]
}

/// A cube thrown up and along.
fn throw() -> Vec<Measurement> {
    const SECONDS: f64 = 0.4;
    let thrown = Specimen::cube("cube")
        .at(Vec3::Z * 10.0)
        .moving(Vec3::new(10.0, 0.0, 20.0));
    let mut world = SmallWorld::new(SHIPPED, &[thrown]);
    world.seconds(SECONDS);
    let place = world.location("cube");
    let height = 10.0 + 20.0 * SECONDS - G * SECONDS * SECONDS / 2.0;
    vec![
        Measurement::close("way along", "v t", 10.0 * SECONDS, place.x, 0.01),
        Measurement::close("height", "h + v t − g t²/2", height, place.z, 0.01),
    ]
}
