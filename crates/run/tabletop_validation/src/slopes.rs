//! Blocks on slopes.

use bevy::math::{DVec3, Quat, Vec3};
use tabletop_geometry::Pose;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("slope-holds-0.25", || steepest(0.25)),
    Experiment::new("slope-holds-0.5", || steepest(0.5)),
    Experiment::new("slope-holds-0.8", || steepest(0.8)),
    Experiment::new("slope-slides-smooth", || slide(0.0)),
    Experiment::new("slope-slides-rough", || slide(0.25)),
];

/// Thickness of a slope.
const THICKNESS: f32 = 1.0;

/// A fixed slope of friction 1 that goes down along X.
pub(crate) fn slope(id: &str, radians: f64, location: Vec3, length: f32) -> Specimen {
    let tilt = Quat::from_rotation_y(radians as f32);
    Specimen::block(id, (length, 2.0, THICKNESS))
        .posed(Pose::new(location, tilt))
        .rough(1.0)
        .fixed()
}

/// The pose of an object that stands on a slope, so high above its surface.
pub(crate) fn on(slope: &Specimen, height: f32) -> Pose {
    slope.spec.pose * Pose::at(Vec3::Z * (THICKNESS / 2.0 + height))
}

/// The direction down a slope.
pub(crate) fn down(slope: &Specimen) -> DVec3 {
    (slope.spec.pose.rotation * Vec3::X).as_dvec3()
}

/// The steepest of many slopes, whose tangents are 1 % apart, on which a block stands for 2 s.
fn steepest(friction: f32) -> Vec<Measurement> {
    const PERCENT: i32 = 15;
    let tangent = |percent: i32| f64::from(friction) * (1.0 + f64::from(percent) / 100.0);
    let mut specimens = Vec::new();
    for percent in -PERCENT..=PERCENT {
        let place = Vec3::new(0.0, 3.0 * percent as f32, 5.0);
        let id = format!("slope{percent}");
        let slope = slope(&id, tangent(percent).atan(), place, 6.0);
        let block = Specimen::block(format!("block{percent}"), (1.0, 1.0, 0.5))
            .posed(on(&slope, 0.25))
            .rough(friction);
        specimens.extend([slope, block]);
    }
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    world.seconds(2.0);
    let stands = |specimen: &Specimen| {
        let start = specimen.spec.pose.location.as_dvec3();
        world.location(&specimen.spec.id).distance(start) < 0.05
    };
    let standing = specimens.chunks(2).take_while(|pair| stands(&pair[1]));
    let held = -PERCENT - 1 + standing.count() as i32;
    let (expected, measured) = (f64::from(friction), tangent(held));
    vec![Measurement::close(
        "steepest tan θ",
        "μ",
        expected,
        measured,
        0.02,
    )]
}

/// A flat block on a slope of 30°.
fn slide(friction: f32) -> Vec<Measurement> {
    const SECONDS: f64 = 0.5;
    let angle = f64::to_radians(30.0);
    let slope = slope("slope", angle, Vec3::Z * 15.0, 40.0);
    let block = Specimen::block("block", (1.0, 1.0, 0.5))
        .posed(on(&slope, 0.25))
        .rough(friction);
    let start = block.spec.pose.location.as_dvec3();
    let down = down(&slope);
    let mut world = SmallWorld::new(SHIPPED, &[slope, block]);
    world.seconds(SECONDS);
    let acceleration = G * (angle.sin() - f64::from(friction) * angle.cos());
    let speed = world.velocity("block").dot(down);
    let way = (world.location("block") - start).dot(down);
    let expected = acceleration * SECONDS;
    vec![
        Measurement::close("speed", "g (sin θ − μ cos θ) t", expected, speed, 0.02),
        Measurement::close(
            "way",
            "g (sin θ − μ cos θ) t²/2",
            expected * SECONDS / 2.0,
            way,
            0.02,
        ),
    ]
}
