//! Hinges and sliders.

use bevy::math::Vec3;
use tabletop_core::{JointMotion, JointedSpec, SceneItem};
use tabletop_geometry::Pose;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SmallWorld, TICK, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("pendulum-5-degrees", || pendulum(5.0)),
    Experiment::new("pendulum-30-degrees", || pendulum(30.0)),
    Experiment::new("pendulum-90-degrees", || pendulum(90.0)),
    Experiment::new("pendulum-150-degrees", || pendulum(150.0)),
    Experiment::new("slider-on-slope", slider),
];

/// Height of the hinge or of the slider's beginning.
const HEIGHT: f32 = 20.0;

/// A pendulum of a block on a hinge, for 10 s.
fn pendulum(degrees: f32) -> Vec<Measurement> {
    const LENGTH: f32 = 2.0;
    let post = Specimen::block("post", Vec3::splat(0.2)).fixed();
    let bob = Specimen::block("bob", Vec3::splat(0.5)).at(Vec3::NEG_Z * LENGTH);
    let length = f64::from(LENGTH);
    let inertia = bob.mass() * length * length + bob.inertia().x;
    let small = std::f64::consts::TAU * (inertia / (bob.mass() * G * length)).sqrt();
    let amplitude = f64::from(degrees).to_radians();
    let expected = small / arithmetic_geometric_mean(1.0, (amplitude / 2.0).cos());
    let hinge = JointedSpec {
        pose: Pose::at(Vec3::Z * HEIGHT),
        objects: [post.spec, bob.spec],
        motion: JointMotion::Turn,
        limits: [-170.0, 170.0],
        init: degrees,
        collides: false,
        damping: 0.0,
    };
    let mut world = SmallWorld::with_items(UNDAMPED, vec![SceneItem::Jointed(hinge)]);
    let angle = |world: &SmallWorld| {
        let place = world.location("bob");
        place.y.atan2(f64::from(HEIGHT) - place.z)
    };
    let mut angles = vec![angle(&world)];
    let mut stretch: f64 = 0.0;
    world.watch(10.0, |world| {
        angles.push(angle(world));
        let place = world.location("bob") - Vec3::Z.as_dvec3() * f64::from(HEIGHT);
        stretch = stretch.max((place.length() - length).abs());
    });
    let last = &angles[angles.len() - (2.0 * expected / TICK) as usize..];
    let swing = last.iter().copied().fold(0.0, f64::max);
    vec![
        Measurement::close(
            "period",
            "2π √(I/m g l)/M(1, cos θ/2)",
            expected,
            period(&angles[..(3.5 * expected / TICK) as usize]),
            0.01,
        ),
        Measurement::close("amplitude after 10 s", "θ", amplitude, swing, 0.03),
        Measurement::none("stretch", stretch, 0.01),
    ]
}

/// The mean of two numbers that gives complete elliptic integrals, by Gauss.
fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    for _ in 0..30 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    a
}

/// The mean time between rises of an angle through 0.
fn period(angles: &[f64]) -> f64 {
    let pairs = angles.windows(2).enumerate();
    let rises = pairs.filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0);
    let times: Vec<_> = rises
        .map(|(tick, pair)| (tick as f64 + pair[0] / (pair[0] - pair[1])) * TICK)
        .collect();
    match times[..] {
        [first, .., last] => (last - first) / (times.len() - 1) as f64,
        _ => 0.0,
    }
}

/// A slider that goes down a slope of 30°.
fn slider() -> Vec<Measurement> {
    const SECONDS: f64 = 0.5;
    let pose = Pose::from_degrees(Vec3::Z * HEIGHT, Vec3::new(0.0, -30.0, 0.0));
    let slider = JointedSpec {
        pose,
        objects: [
            Specimen::block("post", Vec3::splat(0.5)).fixed().spec,
            Specimen::block("load", Vec3::splat(0.5)).spec,
        ],
        motion: JointMotion::Slide,
        limits: [0.0, 40.0],
        init: 0.0,
        collides: false,
        damping: 0.0,
    };
    let mut world = SmallWorld::with_items(UNDAMPED, vec![SceneItem::Jointed(slider)]);
    world.seconds(SECONDS);
    let way = world.location("load") - Vec3::Z.as_dvec3() * f64::from(HEIGHT);
    let speed = world.velocity("load").length();
    let pull = G * 0.5;
    vec![
        Measurement::close(
            "way",
            "g sin θ t²/2",
            pull * SECONDS * SECONDS / 2.0,
            way.length(),
            0.02,
        ),
        Measurement::close("speed", "g sin θ t", pull * SECONDS, speed, 0.02),
    ]
}
