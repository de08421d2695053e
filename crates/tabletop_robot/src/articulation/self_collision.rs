//! Which bodies of the robot can meet.

use bevy::prelude::*;
use tabletop_core::{Pose, RobotJoint};

use crate::{
    articulation::tree::{Articulation, Body, TreePosition},
    clearance::{Owner, Solid},
};

/// Joints between two bodies of an arm that can meet.
const JOINTS_BETWEEN: usize = 3;

/// Distance, in units, at which bodies meet in a pose that the real robot takes: their solids are rough there.
const ROUGH: f32 = 0.05;

/// The bodies that can meet, as a table of all pairs.
#[derive(Resource, Clone, Debug)]
pub(crate) struct SelfCollisionMatrix {
    bodies: usize,
    can_meet: Vec<bool>,
}

impl SelfCollisionMatrix {
    /// Whether two bodies can meet, by their numbers.
    pub fn can_meet(&self, a: usize, b: usize) -> bool {
        self.can_meet[a * self.bodies + b]
    }

    /// The pairs that are far enough from each other along the robot, without those whose solids overlap in poses that the
    /// real robot takes.
    pub fn new(articulation: &Articulation) -> Self {
        let bodies = articulation.bodies.len();
        let mut self_collisions = Self {
            bodies,
            can_meet: vec![false; bodies * bodies],
        };
        let postures = KNOWN.map(|angles| known_posture(articulation, angles));
        for a in 0..bodies {
            for b in 0..a {
                let [place_a, place_b] = [a, b].map(|i| articulation.bodies[i].place);
                let can_meet = are_apart(place_a, place_b)
                    && !postures
                        .iter()
                        .any(|solids| overlap(&solids[a], &solids[b]));
                self_collisions.can_meet[a * bodies + b] = can_meet;
                self_collisions.can_meet[b * bodies + a] = can_meet;
            }
        }
        self_collisions
    }
}

/// Whether bodies are far enough from each other along the robot to meet.
const fn are_apart(a: TreePosition, b: TreePosition) -> bool {
    match (a, b) {
        (TreePosition::Arm(a, i), TreePosition::Arm(b, j)) if a as u8 == b as u8 => {
            i.abs_diff(j) >= JOINTS_BETWEEN
        }
        (TreePosition::Arm(..), TreePosition::Arm(..)) => true,
        (TreePosition::Arm(_, i), _) | (_, TreePosition::Arm(_, i)) => i >= JOINTS_BETWEEN,
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
fn known_posture(articulation: &Articulation, angles: [f64; 7]) -> Vec<Vec<Solid>> {
    let positions = RobotJoint::ALL.map(|joint| match joint.arm() {
        Some(_) if !joint.is_gripper() => joint.mirror() * angles[joint.index() % angles.len()],
        _ => joint.home(),
    });
    let posture = articulation.posture(&positions);
    let solids = |(number, body): (usize, &Body)| {
        let pose = articulation.pose(body, &posture, Pose::IDENTITY);
        Solid::moving(&body.parts, Owner::Body(number), pose, pose).collect()
    };
    articulation.bodies.iter().enumerate().map(solids).collect()
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
        let arm = |i| TreePosition::Arm(Arm::Left, i);
        assert!(!are_apart(arm(2), arm(4)));
        assert!(are_apart(arm(2), arm(5)));
        assert!(are_apart(arm(1), TreePosition::Arm(Arm::Right, 1)));
        assert!(!are_apart(TreePosition::Trunk, arm(2)));
        assert!(are_apart(TreePosition::Head, arm(7)));
        assert!(!are_apart(TreePosition::Trunk, TreePosition::Head));
    }
}
