//! Steps and checks of the robot.

use bevy::prelude::*;
use serde::Deserialize;
use tabletop_core::{
    Drive, Face, JointId, JointName, LimbId, LimbName, Robot, RobotCommand, RobotLayout, SimCommand,
};
use tabletop_geometry::Pose;

use crate::{
    fault::{fault_of_time, fault_of_vector},
    seen::Seen,
};

/// Number of ticks without motion after which the robot is still: more than an arm waits for an object that it squeezes.
pub(crate) const TICKS_TO_STILL: u64 = 15;

/// Speed in rad/s, or units/s of a gripper, below which a joint is still: a motor that presses on something creeps for a long time.
const STILL: f64 = 1e-4;

/// A step of the robot. Positions of joints are in rad, openings of grippers in units, other angles in degrees.
/// All motions but [`Set`](Self::Set) take their time; [`WaitUntilStill`](Self::WaitUntilStill) waits for their end.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RobotStep {
    /// Put the robot at the table.
    Show,
    /// Take it away.
    Hide,
    /// Move joints to these positions at the speed of manual control.
    Move(Vec<(JointName, f64)>),
    /// Put joints at these positions at once.
    Set(Vec<(JointName, f64)>),
    /// Move all joints to their home positions.
    Home,
    /// Bring an end effector to a pose: with `degrees` 0 its fingers point down and open along X.
    ReachTo {
        /// The arm.
        arm: LimbName,
        /// The location, in units.
        at: Vec3,
        /// The rotation about the fixed X, then Y, then Z axis.
        #[serde(default)]
        degrees: Vec3,
    },
    /// Close a gripper until it holds or meets something.
    Close(LimbName),
    /// Open a gripper, which releases its objects.
    Open(LimbName),
    /// Show this face.
    Face(Face),
    /// Wait until nothing of the robot moves, at most this many seconds.
    WaitUntilStill(f32),
}

/// A condition of the robot that is to hold.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RobotCheck {
    /// A joint is at a position, in rad, or units for a gripper.
    Joint {
        /// The joint.
        joint: JointName,
        /// The position.
        at: f64,
        /// The tolerance.
        #[serde(default = "precise")]
        within: f64,
    },
    /// An end effector is at a location, in units.
    EndEffector {
        /// The arm.
        arm: LimbName,
        /// The location.
        at: Vec3,
        /// The tolerance.
        #[serde(default = "close")]
        within: f32,
    },
    /// A gripper holds an object.
    Holds {
        /// The arm.
        arm: LimbName,
        /// The object's id.
        object: String,
    },
    /// A gripper holds nothing.
    HoldsNothing(LimbName),
    /// An arm is stopped by an obstacle: an object's id, `table` or a part of the robot.
    BlockedBy {
        /// The arm.
        arm: LimbName,
        /// The obstacle's name.
        by: String,
    },
}

const fn precise() -> f64 {
    0.01
}

const fn close() -> f32 {
    0.05
}

impl RobotStep {
    /// Its fault, if it makes no sense for any robot.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Self::ReachTo { at, degrees, .. } => {
                fault_of_vector(*at).or_else(|| fault_of_vector(*degrees))
            }
            Self::WaitUntilStill(seconds) => fault_of_time(*seconds),
            Self::Show
            | Self::Hide
            | Self::Move(_)
            | Self::Set(_)
            | Self::Home
            | Self::Close(_)
            | Self::Open(_)
            | Self::Face(_) => None,
        }
    }

    /// The command for it; `None` if it only waits.
    ///
    /// # Errors
    ///
    /// This robot cannot do it.
    pub(crate) fn command(&self, layout: &RobotLayout) -> Result<Option<SimCommand>, String> {
        let gripper = |limb: LimbName, end: usize| {
            let limb = layout.limb(limb_of(layout, limb)?);
            let joint = layout.joint(limb.gripper.joint);
            Ok::<_, String>(vec![(joint.name, Drive::Toward(joint.limits[end]))])
        };
        let home = || {
            let joints = layout.joints.iter();
            joints.map(|joint| (joint.name, Drive::Toward(joint.home)))
        };
        let command = match self {
            Self::Show => RobotCommand::Show(true),
            Self::Hide => RobotCommand::Show(false),
            Self::Face(face) => RobotCommand::ShowFace(*face),
            Self::ReachTo { arm, at, degrees } => RobotCommand::ReachTo {
                arm: layout.limb(limb_of(layout, *arm)?).name,
                pose: Pose::from_degrees(*at, *degrees),
            },
            Self::WaitUntilStill(_) => return Ok(None),
            Self::Move(positions) => RobotCommand::Drive(each(layout, positions, Drive::Toward)?),
            Self::Set(positions) => RobotCommand::Drive(each(layout, positions, Drive::Position)?),
            Self::Home => RobotCommand::Drive(home().collect()),
            Self::Close(arm) => RobotCommand::Drive(gripper(*arm, 0)?),
            Self::Open(arm) => RobotCommand::Drive(gripper(*arm, 1)?),
        };
        Ok(Some(SimCommand::Robot(command)))
    }
}

fn each(
    layout: &RobotLayout,
    positions: &[(JointName, f64)],
    drive: fn(f64) -> Drive,
) -> Result<Vec<(JointName, Drive)>, String> {
    let positions = positions.iter().map(|&(name, position)| {
        let joint = layout.joint(joint_of(layout, name)?);
        let [least, largest] = joint.limits;
        if !(least..=largest).contains(&position) {
            return Err(format!(
                "joint {name} goes from {least} to {largest}, not to {position}"
            ));
        }
        Ok((joint.name, drive(position)))
    });
    positions.collect()
}

fn joint_of(layout: &RobotLayout, name: JointName) -> Result<JointId, String> {
    let joint = layout.find_joint(name);
    joint.ok_or_else(|| format!("the robot {} has no joint {name}", layout.name))
}

fn limb_of(layout: &RobotLayout, name: LimbName) -> Result<LimbId, String> {
    let limb = layout.find_limb(name);
    limb.ok_or_else(|| format!("the robot {} has no limb {name}", layout.name))
}

/// True if nothing of the robot has moved in the last tick.
pub(crate) fn is_still(robot: &Robot) -> bool {
    let mut joints = robot.joints.iter();
    joints.all(|joint| joint.velocity.abs() < STILL)
}

impl RobotCheck {
    /// Compares with the world; an error names the expectation and the finding.
    pub(crate) fn judge(&self, seen: &Seen) -> Result<(), String> {
        let robot = seen.robot;
        match self {
            Self::Joint { joint, at, within } => {
                let found = robot.joint(joint_of(seen.layout, *joint)?).position;
                let is_there = (found - at).abs() <= *within;
                is_there.then_some(()).ok_or_else(|| {
                    format!(
                        "expected joint {joint} within {within} of {at}, found it at {found:.4}"
                    )
                })
            }
            Self::EndEffector { arm, at, within } => {
                let found = robot
                    .limb(limb_of(seen.layout, *arm)?)
                    .end_effector
                    .location;
                let away = found.distance(*at);
                (away <= *within).then_some(()).ok_or_else(|| {
                    format!(
                        "expected the {arm} end effector within {within} of {at:.3}, found it at {found:.3}, {away:.3} away"
                    )
                })
            }
            Self::Holds { arm, object } => {
                let held = held(seen, *arm)?;
                held.contains(&object.as_str())
                    .then_some(())
                    .ok_or_else(|| {
                        format!(
                            "expected `{object}` in the {arm} gripper, found {}",
                            in_words(&held)
                        )
                    })
            }
            Self::HoldsNothing(arm) => {
                let held = held(seen, *arm)?;
                held.is_empty().then_some(()).ok_or_else(|| {
                    format!(
                        "expected nothing in the {arm} gripper, found {}",
                        in_words(&held)
                    )
                })
            }
            Self::BlockedBy { arm, by } => {
                let found = robot
                    .limb(limb_of(seen.layout, *arm)?)
                    .blocked_by
                    .as_ref()
                    .map(ToString::to_string);
                (found.as_ref() == Some(by)).then_some(()).ok_or_else(|| {
                    format!(
                        "expected the {arm} arm blocked by {by}, found it {}",
                        found.map_or("free".into(), |found| format!("blocked by {found}"))
                    )
                })
            }
        }
    }
}

/// Ids of the objects in a gripper.
fn held<'a>(seen: &'a Seen, arm: LimbName) -> Result<Vec<&'a str>, String> {
    let holds = &seen.robot.limb(limb_of(seen.layout, arm)?).holds;
    let held = seen
        .objects
        .iter()
        .filter(|object| holds.contains(&object.entity));
    Ok(held.map(|object| object.spec.id.as_str()).collect())
}

fn in_words(ids: &[&str]) -> String {
    match ids {
        [] => "nothing".into(),
        ids => format!("`{}`", ids.join("`, `")),
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Arm, RobotJoint};

    use super::*;
    use crate::test_stage::Stage;

    #[test]
    fn the_robot_is_commanded_as_its_steps_say() {
        let mut stage = Stage::new(
            "Robot(Show), Robot(Move([(RightE1, 1.5)])), Robot(Close(Left)), \
             Robot(ReachTo(arm: Right, at: (3, -2, 1), degrees: (0, 0, 90)))",
        );
        let given: Vec<_> = std::iter::from_fn(|| stage.tick()).collect();
        assert_eq!(
            given,
            [
                SimCommand::Robot(RobotCommand::Show(true)),
                SimCommand::Robot(RobotCommand::drive([(
                    RobotJoint::RightE1,
                    Drive::Toward(1.5)
                )])),
                SimCommand::Robot(RobotCommand::drive([(
                    RobotJoint::LeftGripper,
                    Drive::Toward(0.0)
                )])),
                SimCommand::Robot(RobotCommand::ReachTo {
                    arm: Arm::Right.name(),
                    pose: Pose::from_degrees(Vec3::new(3.0, -2.0, 1.0), Vec3::Z * 90.0),
                }),
            ]
        );
    }

    #[test]
    fn a_position_out_of_limits_is_a_fault() {
        let step = |joint: &str, at| RobotStep::Set(vec![(JointName::new(joint).unwrap(), at)]);
        let fault = |step: RobotStep| step.command(RobotLayout::baxter()).unwrap_err();
        assert_eq!(
            fault(step("LeftE1", 3.0)),
            "joint left_e1 goes from -0.05 to 2.618, not to 3"
        );
        assert_eq!(
            fault(step("panda_joint1", 0.0)),
            "the robot Baxter has no joint panda_joint1"
        );
    }

    #[test]
    fn waiting_ends_when_nothing_has_moved_for_a_while() {
        let mut stage = Stage::new("Robot(WaitUntilStill(2))");
        assert_eq!(stage.finish() + 1, TICKS_TO_STILL);
        let mut stage = Stage::new("Robot(WaitUntilStill(2))");
        stage.robot.joints[3].velocity = -1e-5;
        assert_eq!(stage.finish() + 1, TICKS_TO_STILL);
        let mut stage = Stage::new("Robot(WaitUntilStill(2))");
        stage.robot.joints[3].velocity = -0.1;
        assert!(stage.failure().contains("the robot to be still"));
    }

    #[test]
    fn failed_checks_state_the_expected_and_the_found() {
        for (check, words) in [
            ("Joint(joint: LeftE1, at: 1)", "found it at 2.6180"),
            ("EndEffector(arm: Left, at: (1, 0, 0))", "1.000 away"),
            ("Holds(arm: Left, object: \"low\")", "found nothing"),
            ("BlockedBy(arm: Left, by: \"table\")", "found it free"),
        ] {
            let mut stage = Stage::new(&format!("Expect(Robot({check}))"));
            let failure = stage.failure();
            assert!(failure.contains(words), "{failure}");
        }
        let all = "Expect(Robot(Joint(joint: LeftE1, at: 2.618))), \
             Expect(Robot(EndEffector(arm: Left, at: (0, 0, 0)))), Expect(Robot(HoldsNothing(Left)))";
        assert_eq!(Stage::new(all).failure(), "Done");
    }
}
