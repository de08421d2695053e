//! Slow motions, which must not be taken for rest.

use bevy::math::{DQuat, Vec3};
use tabletop_core::{JointMotion, JointedSpec, SceneItem};
use tabletop_geometry::Pose;
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld, TICK, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("slow-slide-0.3", || slide(0.3)),
    Experiment::new("slow-slide-0.1", || slide(0.1)),
    Experiment::new("slow-turn", turn),
    Experiment::new("slow-sink", sink),
];

/// A cube without friction on the table.
fn slide(speed: f32) -> Vec<Measurement> {
    const SECONDS: f64 = 3.0;
    let cube = Specimen::cube("cube")
        .at(Vec3::Z * 0.5)
        .rough(0.0)
        .moving(Vec3::X * speed);
    let mut world = SmallWorld::new(SHIPPED, &[cube]);
    world.seconds(SECONDS);
    let way = world.location("cube").x;
    let expected = f64::from(speed) * SECONDS;
    vec![Measurement::close("way", "v t", expected, way, 0.02)]
}

/// A cube that floats and turns.
fn turn() -> Vec<Measurement> {
    const SECONDS: f64 = 5.0;
    const SPIN: f32 = 0.1;
    let cube = Specimen::cube("cube")
        .at(Vec3::Z * 10.0)
        .spinning(Vec3::Z * SPIN);
    let settings = PhysicsSettings {
        gravity: 0.0,
        ..UNDAMPED
    };
    let mut world = SmallWorld::new(settings, &[cube]);
    world.seconds(SECONDS);
    let turned = world.rotation("cube").angle_between(DQuat::IDENTITY);
    let expected = f64::from(SPIN) * SECONDS;
    vec![Measurement::close("angle", "ω t", expected, turned, 0.02)]
}

/// A damped slider whose load sinks. A damper takes away its share of the speed in a tick, so the load sinks at
/// g dt (1 − d)/d.
fn sink() -> Vec<Measurement> {
    const DAMPING: f32 = 0.9;
    const WAY: f32 = 4.0;
    let joint = Pose::from_degrees(Vec3::Z * 10.0, Vec3::new(0.0, -90.0, 0.0));
    let upright = joint.rotation.inverse();
    let part = |id, mass| {
        let pose = Pose::new(Vec3::ZERO, upright);
        let block = Specimen::block(id, Vec3::splat(0.5));
        block.posed(pose).weighing(mass).spec
    };
    let slider = JointedSpec {
        pose: joint,
        objects: [part("post", 0.0), part("load", 1.0)],
        motion: JointMotion::Slide,
        limits: [0.0, WAY],
        init: 0.0,
        collides: false,
        damping: DAMPING,
    };
    let mut world = SmallWorld::with_items(SHIPPED, vec![SceneItem::Jointed(slider)]);
    world.seconds(1.0);
    let after_one = world.location("load").z;
    world.seconds(4.0);
    let speed = (after_one - world.location("load").z) / 4.0;
    world.seconds(30.0);
    let sunk = 10.0 - world.location("load").z;
    let damping = f64::from(DAMPING);
    let expected = G * TICK * (1.0 - damping) / damping;
    vec![
        Measurement::close("speed", "g dt (1 − d)/d", expected, speed, 0.03),
        Measurement::near("way", "to the end", f64::from(WAY), sunk, 0.02),
    ]
}
