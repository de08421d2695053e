//! Pairs of the robot's bodies that can collide.

use bevy::prelude::*;
use tabletop_core::JointRole;
use tabletop_geometry::Pose;
use tabletop_physics::SweptSolid;

use tabletop_robot::{Articulation, Body, Positions, TreePosition};

/// Number of joints between two bodies of a limb that can collide.
const JOINTS_BETWEEN: usize = 3;

/// Distance, in units, at which bodies count as touching in a posture that the real robot takes: their solids are rough there.
const ROUGH: f32 = 0.05;

/// The pairs of bodies that can collide.
#[derive(Resource, Clone, Debug)]
pub(crate) struct SelfCollisionMatrix {
    bodies: usize,
    can_meet: Vec<bool>,
    /// The bodies that each body can collide with.
    partners: Vec<Vec<usize>>,
}

impl SelfCollisionMatrix {
    /// True if two bodies can collide. They are given by their numbers.
    pub fn can_meet(&self, a: usize, b: usize) -> bool {
        self.can_meet[a * self.bodies + b]
    }

    /// The numbers of the bodies that a body can collide with.
    pub fn partners(&self, body: usize) -> &[usize] {
        &self.partners[body]
    }

    /// The pairs that are far enough apart along the robot, without those whose solids overlap in postures that the
    /// real robot takes.
    pub fn new(articulation: &Articulation) -> Self {
        let bodies = articulation.bodies.len();
        let mut self_collisions = Self {
            bodies,
            can_meet: vec![false; bodies * bodies],
            partners: Vec::new(),
        };
        let known = articulation.layout.known_postures.iter();
        let postures: Vec<_> = known
            .map(|angles| known_posture(articulation, angles))
            .collect();
        let may_touch = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|body| &articulation.bodies[body].id);
            let mut pairs = articulation.layout.may_touch.iter();
            pairs.any(|(one, other)| [[one, other], [other, one]].contains(&[a, b]))
        };
        for a in 0..bodies {
            for b in 0..a {
                let [place_a, place_b] = [a, b].map(|i| articulation.bodies[i].place);
                let can_meet = are_apart(place_a, place_b)
                    && !may_touch(a, b)
                    && !postures
                        .iter()
                        .any(|solids| overlap(&solids[a], &solids[b]));
                self_collisions.can_meet[a * bodies + b] = can_meet;
                self_collisions.can_meet[b * bodies + a] = can_meet;
            }
        }
        self_collisions.partners = (0..bodies)
            .map(|a| {
                let others = 0..bodies;
                others.filter(|b| self_collisions.can_meet(a, *b)).collect()
            })
            .collect();
        self_collisions
    }
}

/// True if bodies are far enough apart along the robot to collide.
const fn are_apart(a: TreePosition, b: TreePosition) -> bool {
    match (a, b) {
        (TreePosition::Limb(a, i), TreePosition::Limb(b, j)) if a.0 == b.0 => {
            i.abs_diff(j) >= JOINTS_BETWEEN
        }
        (TreePosition::Limb(..), TreePosition::Limb(..)) => true,
        (TreePosition::Limb(_, i), _) | (_, TreePosition::Limb(_, i)) => i >= JOINTS_BETWEEN,
        _ => false,
    }
}

/// The solids of every body in a known posture.
fn known_posture(articulation: &Articulation, angles: &[f64]) -> Vec<Vec<SweptSolid<usize>>> {
    let joints = articulation.layout.joints.iter();
    let positions: Positions = joints
        .map(|joint| match joint.role {
            JointRole::Limb { place, .. } => {
                let angle = angles.get(place);
                angle.map_or(joint.home, |angle| joint.sign * angle)
            }
            JointRole::Neck | JointRole::Gripper(_) => joint.home,
        })
        .collect();
    let posture = articulation.posture(&positions, Pose::IDENTITY);
    let solids = |(number, body): (usize, &Body)| {
        let pose = posture.bodies()[number];
        SweptSolid::moving(&body.parts, number, pose, pose).collect()
    };
    articulation.bodies.iter().enumerate().map(solids).collect()
}

fn overlap(a: &[SweptSolid<usize>], b: &[SweptSolid<usize>]) -> bool {
    a.iter().any(|a| b.iter().any(|b| a.is_within(ROUGH, b)))
}

#[cfg(test)]
mod tests {
    use tabletop_core::LimbId;

    use super::*;

    #[test]
    fn neighbours_cannot_meet_and_arms_can() {
        let arm = |i| TreePosition::Limb(LimbId(0), i);
        assert!(!are_apart(arm(2), arm(4)));
        assert!(are_apart(arm(2), arm(5)));
        assert!(are_apart(arm(1), TreePosition::Limb(LimbId(1), 1)));
        assert!(!are_apart(TreePosition::Trunk, arm(2)));
        assert!(are_apart(TreePosition::Head, arm(7)));
        assert!(!are_apart(TreePosition::Trunk, TreePosition::Head));
    }
}
