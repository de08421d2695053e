//! Which bodies of the robot can meet.

use bevy::prelude::*;
use tabletop_core::{Pose, RobotJoint};

use crate::{
    clearance::{Owner, Solid},
    skeleton::{Place, Skeleton},
};

/// Joints between two bodies of an arm that can meet.
const JOINTS_BETWEEN: usize = 3;

/// Distance, in units, at which bodies meet in a pose that the real robot takes: their solids are rough there.
const ROUGH: f32 = 0.05;

/// The bodies that can meet, as a table of all pairs.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Meetings {
    bodies: usize,
    can_meet: Vec<bool>,
}

impl Meetings {
    /// Whether two bodies can meet, by their numbers.
    pub fn can_meet(&self, a: usize, b: usize) -> bool {
        self.can_meet[a * self.bodies + b]
    }

    /// The pairs that are far enough from each other along the robot, without those whose solids overlap in poses that the
    /// real robot takes.
    pub fn new(skeleton: &Skeleton) -> Self {
        let bodies = skeleton.bodies.len();
        let mut meetings = Self {
            bodies,
            can_meet: vec![false; bodies * bodies],
        };
        let postures = KNOWN.map(|angles| known_posture(skeleton, angles));
        for a in 0..bodies {
            for b in 0..a {
                let [place_a, place_b] = [a, b].map(|i| skeleton.bodies[i].place);
                let can_meet = are_apart(place_a, place_b)
                    && !postures
                        .iter()
                        .any(|solids| overlap(&solids[a], &solids[b]));
                meetings.can_meet[a * bodies + b] = can_meet;
                meetings.can_meet[b * bodies + a] = can_meet;
            }
        }
        meetings
    }
}

/// Whether bodies are far enough from each other along the robot to meet.
const fn are_apart(a: Place, b: Place) -> bool {
    match (a, b) {
        (Place::Arm(a, i), Place::Arm(b, j)) if a as u8 == b as u8 => {
            i.abs_diff(j) >= JOINTS_BETWEEN
        }
        (Place::Arm(..), Place::Arm(..)) => true,
        (Place::Arm(_, i), _) | (_, Place::Arm(_, i)) => i >= JOINTS_BETWEEN,
        _ => false,
    }
}

/// Angles of the left arm in poses that the real robot takes; the right arm mirrors them: home, straight, untucked,
/// tucked, neutral.
const KNOWN: [[f64; 7]; 5] = [
    [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0],
    [0.0; 7],
    [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.5],
    [-1.0, -2.07, 3.0, 2.55, 0.0, 0.01, 0.0],
    [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0],
];

/// The solids of every body in a known pose.
fn known_posture(skeleton: &Skeleton, angles: [f64; 7]) -> Vec<Vec<Solid>> {
    let positions = RobotJoint::ALL.map(|joint| match joint.arm() {
        Some(_) if !joint.is_gripper() => joint.mirror() * angles[joint.index() % angles.len()],
        _ => joint.home(),
    });
    let posture = skeleton.posture(&positions);
    let solids = |(number, body): (usize, &crate::skeleton::Body)| {
        let pose = skeleton.pose(body, &posture, Pose::IDENTITY);
        Solid::moving(&body.parts, Owner::Body(number), pose, pose).collect()
    };
    skeleton.bodies.iter().enumerate().map(solids).collect()
}

fn overlap(a: &[Solid], b: &[Solid]) -> bool {
    a.iter().any(|a| b.iter().any(|b| a.is_within(ROUGH, b)))
}

#[cfg(test)]
mod tests {
    use tabletop_core::Arm;

    use super::*;

    #[test]
    fn neighbours_cannot_meet_and_arms_can() {
        let arm = |i| Place::Arm(Arm::Left, i);
        assert!(!are_apart(arm(2), arm(4)));
        assert!(are_apart(arm(2), arm(5)));
        assert!(are_apart(arm(1), Place::Arm(Arm::Right, 1)));
        assert!(!are_apart(Place::Trunk, arm(2)));
        assert!(are_apart(Place::Head, arm(7)));
        assert!(!are_apart(Place::Trunk, Place::Head));
    }
}
