//! Paths of an arm.

use bevy::math::Vec3;
use tabletop_controller::Angles;
use tabletop_geometry::Pose;
use tabletop_task::angle_between;

use crate::clearance::Clearance;

/// A path as a list of postures without the first one.
pub(crate) type Path = Vec<Angles>;

/// Largest step between postures of a straight line, in units and rad.
const LINE_STEP: (f32, f32) = (0.25, 0.25);
/// Largest turn of a joint between neighbouring postures of a line, in rad.
const JUMP: f64 = 0.5;
/// Largest turn of a joint between neighbouring postures of a free path, in rad.
const JOINT_STEP: f64 = 0.03;

/// The largest turn of a joint between two postures, in rad.
pub(crate) fn largest_turn(a: &Angles, b: &Angles) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn between(a: &Angles, b: &Angles, part: f64) -> Angles {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part)
}

/// The path on which all joints turn evenly.
pub(crate) fn even(from: &Angles, to: &Angles) -> Path {
    let steps = (largest_turn(from, to) / JOINT_STEP).ceil().max(1.0) as u32;
    (1..=steps)
        .map(|step| between(from, to, f64::from(step) / f64::from(steps)))
        .collect()
}

/// The path on which the end effector goes straight to a pose; `None` if the arm cannot.
pub(crate) fn line(clearance: &Clearance, from: &Angles, to: Pose) -> Option<Path> {
    let start = clearance.end_effector(from);
    let length = start.location.distance(to.location);
    let angle = angle_between(start.rotation, to.rotation);
    let steps = (length / LINE_STEP.0)
        .max(angle / LINE_STEP.1)
        .ceil()
        .max(1.0);
    let mut angles = *from;
    let mut path = Path::new();
    for step in 1..=steps as u16 {
        let part = f32::from(step) / steps;
        let pose = Pose::new(
            start.location.lerp(to.location, part),
            start.rotation.slerp(to.rotation, part),
        );
        let next = clearance.reach_from(pose, &angles)?;
        if largest_turn(&next, &angles) > JUMP {
            return None;
        }
        path.push(next);
        angles = next;
    }
    Some(path)
}

/// The path on which the end effector goes straight up.
pub(crate) fn lift(clearance: &Clearance, from: &Angles, by: f32) -> Option<Path> {
    let mut to = clearance.end_effector(from);
    to.location += Vec3::Z * by;
    line(clearance, from, to)
}

/// The way on which the end effector goes straight back from where its fingers point to.
pub(crate) fn withdraw(clearance: &Clearance, from: &Angles, by: f32) -> Option<Path> {
    let mut to = clearance.end_effector(from);
    to.location += to.rotation * Vec3::Z * by;
    line(clearance, from, to)
}
