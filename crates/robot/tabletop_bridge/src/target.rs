//! What a program wants of a robot.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::{profile::BridgeProfile, state::RobotState};

/// The farthest way of a joint, in rad, to a position that is named without leave to make moves: a script that sets angles "at once" means a
/// small step, and what is a jump in the simulation has no counterpart.
pub const FARTHEST_STEP: f64 = 0.2;

/// What a program wants of a robot, until it wants something else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotTarget {
    /// The limbs, by name. A limb that is driven and not named here rests.
    pub limbs: BTreeMap<String, LimbTarget>,
    /// Openings of the grippers, by the names of their limbs, from 0 (closed) to 1 (open).
    pub grippers: BTreeMap<String, f64>,
    /// The head's angle, in rad, positive to the robot's left.
    pub head: Option<f64>,
}

/// What a limb's joints do, from the base to the tip.
#[derive(Clone, Debug, PartialEq)]
pub enum LimbTarget {
    /// They turn at these speeds, in rad/s.
    Velocities(Vec<f64>),
    /// They go to these angles, in rad.
    Positions(Vec<f64>),
}

/// A target that a robot is not sent.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TargetError {
    /// There is no such limb.
    #[error("the robot has no limb {limb:?} that is driven")]
    NoLimb {
        /// Its name.
        limb: String,
    },
    /// There is no such gripper.
    #[error("limb {limb:?} has no gripper that can be moved")]
    NoGripper {
        /// The limb's name.
        limb: String,
    },
    /// The gripper does not know its range.
    #[error("the gripper of limb {limb:?} is not calibrated")]
    NotCalibrated {
        /// The limb's name.
        limb: String,
    },
    /// There is no head that turns.
    #[error("the robot has no head that turns")]
    NoHead,
    /// It is driven by velocities alone.
    #[error("limb {limb:?} is driven by velocities alone")]
    NoPositions {
        /// The limb's name.
        limb: String,
    },
    /// Their number is wrong.
    #[error("limb {limb:?} has {joints} joints, not {given}")]
    WrongCount {
        /// The limb's name.
        limb: String,
        /// How many joints it has.
        joints: usize,
        /// How many numbers were given.
        given: usize,
    },
    /// It is not a finite number.
    #[error("{what} is {value}; it must be a finite number")]
    NotFinite {
        /// The joint, gripper or head.
        what: String,
        /// The number.
        value: f64,
    },
    /// It is too far away for a step.
    #[error(
        "{joint} is {distance:.2} rad away from its target, farther than {FARTHEST_STEP} rad: a real robot cannot jump there (moves must be allowed)"
    )]
    TooFar {
        /// The joint.
        joint: String,
        /// How far it is, in rad.
        distance: f64,
    },
    /// A guard does not let it pass.
    #[error("{0}")]
    Vetoed(String),
    /// The robot is no longer driven.
    #[error("the robot is not driven: {0}")]
    NotDriven(String),
}

impl RobotTarget {
    /// Makes sure that a robot can be sent this.
    pub(crate) fn check(
        &self,
        profile: &BridgeProfile,
        driven: &[usize],
        state: &RobotState,
        may_move: bool,
    ) -> Result<(), TargetError> {
        for (name, target) in &self.limbs {
            let place = profile.limb(name).filter(|place| driven.contains(place));
            let place = place.ok_or_else(|| TargetError::NoLimb { limb: name.clone() })?;
            let limb = &profile.limbs[place];
            let (LimbTarget::Velocities(numbers) | LimbTarget::Positions(numbers)) = target;
            if numbers.len() != limb.joints.len() {
                return Err(TargetError::WrongCount {
                    limb: name.clone(),
                    joints: limb.joints.len(),
                    given: numbers.len(),
                });
            }
            for (joint, number) in limb.joints.iter().zip(numbers) {
                require_finite(&joint.name, *number)?;
                let measured = state.joints.get(&joint.name).map(|it| it.position);
                match (target, measured) {
                    (LimbTarget::Positions(_), Some(measured)) if !may_move => {
                        let distance = (number - measured).abs();
                        if distance > FARTHEST_STEP {
                            let joint = joint.name.clone();
                            return Err(TargetError::TooFar { joint, distance });
                        }
                    }
                    (LimbTarget::Positions(_) | LimbTarget::Velocities(_), _) => {}
                }
            }
            if matches!(target, LimbTarget::Positions(_)) && limb.positions.is_none() {
                return Err(TargetError::NoPositions { limb: name.clone() });
            }
        }
        for (name, opening) in &self.grippers {
            let reading = state.grippers.get(name);
            let reading = reading.ok_or_else(|| TargetError::NoGripper { limb: name.clone() })?;
            if !reading.is_calibrated {
                return Err(TargetError::NotCalibrated { limb: name.clone() });
            }
            require_finite(&format!("the opening of limb {name:?}"), *opening)?;
        }
        match (self.head, &profile.head) {
            (Some(angle), Some(_)) => require_finite("the head's angle", angle),
            (Some(_), None) => Err(TargetError::NoHead),
            (None, _) => Ok(()),
        }
    }
}

fn require_finite(what: &str, value: f64) -> Result<(), TargetError> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(TargetError::NotFinite {
            what: what.to_owned(),
            value,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::JointReading;

    fn refusal(target: LimbTarget, may_move: bool) -> Option<String> {
        let profile = BridgeProfile::shipped("baxter").unwrap();
        let mut state = RobotState::default();
        for joint in profile.joints() {
            state
                .joints
                .insert(joint.name.clone(), JointReading::default());
        }
        let target = RobotTarget {
            limbs: [("left".to_owned(), target)].into(),
            ..RobotTarget::default()
        };
        let checked = target.check(&profile, &[0], &state, may_move);
        checked.err().map(|error| error.to_string())
    }

    #[test]
    fn a_target_that_no_robot_can_have_is_refused_with_its_joint() {
        let mut speeds = vec![0.0; 7];
        assert_eq!(refusal(LimbTarget::Velocities(speeds.clone()), false), None);
        speeds[3] = f64::NAN;
        assert_eq!(
            refusal(LimbTarget::Velocities(speeds.clone()), false).unwrap(),
            "left_e1 is NaN; it must be a finite number"
        );
        speeds.pop();
        assert_eq!(
            refusal(LimbTarget::Velocities(speeds), false).unwrap(),
            "limb \"left\" has 7 joints, not 6"
        );
    }

    #[test]
    fn a_far_position_needs_leave_to_move() {
        let mut angles = vec![0.1; 7];
        assert_eq!(refusal(LimbTarget::Positions(angles.clone()), false), None);
        angles[1] = -0.3;
        let refused = refusal(LimbTarget::Positions(angles.clone()), false).unwrap();
        assert!(refused.starts_with("left_s1 is 0.30 rad away"), "{refused}");
        assert_eq!(refusal(LimbTarget::Positions(angles), true), None);
    }
}
