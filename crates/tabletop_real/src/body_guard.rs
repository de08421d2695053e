//! The guard of the robot's body: a model of it that runs beside.

use tabletop_bridge::{BridgeProfile, Guard, LimbTarget, RobotState, RobotTarget};
use tabletop_controller::{Angles, angles};
use tabletop_core::Table;
use tabletop_planner::RobotBody;

/// Refuses what would bring a limb nearer than 3 cm to the table or to the robot itself.
pub struct BodyGuard {
    body: RobotBody,
    table: Table,
    profile: BridgeProfile,
}

/// Distances, in units: the largest, 3 cm, is kept; one that is nearer already keeps the next, and can only leave.
const DISTANCES: [f32; 5] = [0.3, 0.25, 0.2, 0.1, 0.05];

/// Time, in s, for which a target is looked ahead: it may be followed for 0.1 s, and the joints come to rest within another.
const AHEAD: f64 = 0.2;

impl BodyGuard {
    /// A guard of this body at a table; the profile names its joints.
    pub const fn new(body: RobotBody, table: Table, profile: BridgeProfile) -> Self {
        Self {
            body,
            table,
            profile,
        }
    }

    /// The angles of all limbs of the body, from those of the robot's joints.
    fn angles(&self, of: impl Fn(&str, &str, usize) -> f64) -> Vec<Angles> {
        let limbs = self.body.limbs.iter().map(|limb| {
            let own = self.profile.limbs.iter().find(|own| own.name == limb.name);
            let joints = own.map_or(&[][..], |own| &own.joints);
            let measured = joints.iter().enumerate();
            match joints.is_empty() {
                true => limb.home,
                false => angles(measured.map(|(place, joint)| of(&limb.name, &joint.name, place))),
            }
        });
        limbs.collect()
    }

    fn openings(&self, state: &RobotState) -> Vec<f32> {
        let limbs = self.body.limbs.iter();
        let openings = limbs.map(|limb| {
            let reading = state.grippers.get(&limb.name);
            limb.widest * reading.map_or(1.0, |reading| reading.opening as f32)
        });
        openings.collect()
    }
}

impl Guard for BodyGuard {
    fn veto(&mut self, state: &RobotState, target: &RobotTarget) -> Option<String> {
        let here = |joint: &str| state.joints.get(joint).map_or(0.0, |it| it.position);
        let now = self.angles(|_, joint, _| here(joint));
        let then = self.angles(|limb, joint, place| match target.limbs.get(limb) {
            Some(LimbTarget::Velocities(speeds)) => {
                here(joint) + speeds.get(place).copied().unwrap_or(0.0) * AHEAD
            }
            Some(LimbTarget::Positions(positions)) => {
                positions.get(place).copied().unwrap_or_else(|| here(joint))
            }
            None => here(joint),
        });
        let openings = self.openings(state);
        let near = |angles: &[Angles], distance: f32| {
            self.body.near(&self.table, angles, &openings, distance)
        };
        let kept = DISTANCES.into_iter().find(|&it| near(&now, it).is_none());
        near(&then, kept?).map(|near| near.to_string())
    }
}
