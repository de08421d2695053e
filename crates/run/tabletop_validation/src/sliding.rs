//! Blocks that slide to a stop.

use std::f32::consts::FRAC_PI_4;

use bevy::math::{DVec3, Vec3};
use tabletop_geometry::turn_about;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("slide-along-x", || slide(Vec3::X, 0.5)),
    Experiment::new("slide-along-y", || slide(Vec3::Y, 0.5)),
    Experiment::new("slide-diagonally", || slide(Vec3::new(1.0, 1.0, 0.0), 0.5)),
    Experiment::new("slide-at-20-degrees", || {
        slide(Vec3::new(0.94, 0.342, 0.0), 0.5)
    }),
    Experiment::new("slide-rough", || slide(Vec3::X, 1.0)),
    Experiment::new("slide-smooth", || slide(Vec3::X, 0.2)),
    Experiment::new("slide-heavy", || slide_of(1000.0, Vec3::X, 0.5)),
    Experiment::new("slide-brick", || slide_aslant((3.0, 1.0, 0.5))),
    Experiment::new("slide-plank", || slide_aslant((6.0, 1.0, 0.5))),
    Experiment::new("slide-pillar", || slide_aslant((1.2, 1.0, 1.5))),
];

/// A block that is turned by 45° to its way: friction acts against its motion, whichever way it is turned.
fn slide_aslant(span: (f32, f32, f32)) -> Vec<Measurement> {
    const SPEED: f64 = 12.0;
    let block = Specimen::block("block", span)
        .at(Vec3::Z * (span.2 / 2.0))
        .turned(turn_about(Vec3::Z, FRAC_PI_4))
        .moving(Vec3::X * SPEED as f32);
    let mut world = SmallWorld::new(SHIPPED, &[block]);
    let friction = f64::from(SHIPPED.friction * SHIPPED.friction);
    world.seconds(SPEED / (friction * G) + 1.0);
    let way = world.location("block");
    vec![
        Measurement::close(
            "way",
            "v²/2μg",
            SPEED * SPEED / (2.0 * friction * G),
            way.x,
            0.02,
        ),
        Measurement::none("way aside", way.y, 0.01),
    ]
}

fn slide(direction: Vec3, friction: f32) -> Vec<Measurement> {
    slide_of(1.0, direction, friction)
}

/// A flat block with 10 units/s on the table. The friction of the contact is the product of both surfaces'.
fn slide_of(mass: f32, direction: Vec3, friction: f32) -> Vec<Measurement> {
    const SPEED: f64 = 10.0;
    let direction = direction.normalize();
    let block = Specimen::block("block", (1.0, 1.0, 0.5))
        .at(Vec3::Z * 0.25)
        .weighing(mass)
        .rough(friction)
        .moving(direction * SPEED as f32);
    let mut world = SmallWorld::new(SHIPPED, &[block]);
    let friction = f64::from(friction * SHIPPED.friction);
    world.seconds(SPEED / (friction * G) + 1.0);
    let way = world.location("block") - DVec3::Z * 0.25;
    let along = way.dot(direction.as_dvec3());
    let aside = (way - along * direction.as_dvec3()).length();
    let turned = world.rotation("block").angle_between(Default::default());
    let expected = SPEED * SPEED / (2.0 * friction * G);
    vec![
        Measurement::close("way", "v²/2μg", expected, along, 0.02),
        Measurement::none("way aside", aside, 0.01),
        Measurement::none("turn", turned, 0.01),
    ]
}
