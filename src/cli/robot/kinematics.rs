//! The robot's kinematics for other programs, a line of JSON for a line of JSON.

use std::{collections::BTreeMap, fmt, io::BufRead as _, path::Path, process::ExitCode};

use crate::{
    core::{JointName, JointRole, LimbLayout, LimbName, RobotLayout, Table},
    geometry::UNITS_PER_METER,
    robot::Description,
};
use bevy::math::{DAffine3, DQuat, DVec3};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Value, json};
use tabletop_kinematics::{ArmChain, ModelError, RobotModel, Target, Unreachable};

use crate::cli::{Failure, Output, WRONG_INPUT, robot_options::describe};

/// A question of another program.
#[derive(Clone, Copy)]
pub(super) enum Question {
    /// Frames, for joint angles.
    Forward,
    /// Joint angles, for the pose of a hand.
    Inverse,
}

/// Answers every line of standard input.
pub(super) fn answer(question: Question, robot: Option<&Path>) -> Result<ExitCode, Failure> {
    let answerer = Answerer::new(robot)?;
    let mut code = ExitCode::SUCCESS;
    let mut unreadable = false;
    for (i, line) in std::io::stdin().lock().split(b'\n').enumerate() {
        let line = line.map_err(|error| Failure::run(format!("standard input: {error}")))?;
        if line.trim_ascii().is_empty() {
            continue;
        }
        let answer = match question {
            Question::Forward => answerer.forward(&line),
            Question::Inverse => answerer.inverse(&line),
        };
        let answer = answer.unwrap_or_else(|fault| match fault {
            NoAnswer::Input(message) => {
                unreadable = true;
                json!({ "error": format!("line {}: {message}", i + 1) })
            }
            NoAnswer::Unreachable(error) => {
                code = ExitCode::FAILURE;
                json!({ "error": error.to_string() })
            }
        });
        Output::Stdout.write(format!("{answer}\n").as_bytes())?;
    }
    Ok(match unreadable {
        true => ExitCode::from(WRONG_INPUT),
        false => code,
    })
}

/// The reason why a line has no answer.
enum NoAnswer {
    /// The line is wrong.
    Input(String),
    /// No angles reach the pose.
    Unreachable(Unreachable),
}

impl NoAnswer {
    fn input(error: impl fmt::Display) -> Self {
        Self::Input(error.to_string())
    }
}

/// Angles in rad: seven of Baxter's `left` arm, one of `head_pan`. Missing ones are as in the robot's home posture.
type Posture = BTreeMap<String, Angles>;

#[derive(Deserialize)]
#[serde(untagged)]
enum Angles {
    OfJoint(f64),
    OfLimb(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReachGoal {
    arm: LimbName,
    /// In m in the torso's frame, in units in the table's.
    position: [f64; 3],
    /// Any rotation if it is left out.
    quaternion_xyzw: Option<[f64; 4]>,
    #[serde(default)]
    frame: BaseFrame,
    /// The link that is to get there, in place of the end effector.
    link: Option<String>,
    /// Angles to stay near to, in rad.
    seed: Option<Vec<f64>>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum BaseFrame {
    #[default]
    Table,
    Torso,
}

#[derive(Serialize)]
struct PlacedFrame {
    position: [f64; 3],
    quaternion_xyzw: [f64; 4],
}

struct Answerer {
    robot: RobotModel,
    layout: RobotLayout,
    /// From the torso's frame (m) to the table's, also in m.
    table_from_torso: DAffine3,
}

impl Answerer {
    fn new(robot: Option<&Path>) -> Result<Self, Failure> {
        let Description { model, layout, .. } = match robot {
            None => Description::baxter().map_err(Failure::input)?,
            Some(file) => describe(file)?,
        };
        let base = layout.base.pose(&Table::default());
        Ok(Self {
            robot: model,
            layout,
            table_from_torso: DAffine3::from_rotation_translation(
                base.rotation.as_dquat().normalize(),
                base.location.as_dvec3() / UNITS_PER_METER,
            ),
        })
    }

    fn limb(&self, name: LimbName) -> Result<&LimbLayout, NoAnswer> {
        let limb = self.layout.find_limb(name);
        let limb = limb.map(|limb| self.layout.limb(limb));
        limb.ok_or_else(|| {
            let known = self.layout.limbs.iter().map(|limb| limb.name.as_str());
            let known = known.collect::<Vec<_>>().join(", ");
            NoAnswer::Input(format!("the robot has no limb {name}, only {known}"))
        })
    }

    /// The link that is the end effector of a limb.
    fn end_effector(&self, limb: &LimbLayout) -> Option<String> {
        let mut frames = limb.end_effector.iter();
        let frame = frames.find(|frame| self.robot.find_link(&frame.link).is_ok())?;
        Some(frame.link.clone())
    }

    fn forward(&self, line: &[u8]) -> Result<Value, NoAnswer> {
        let posture: Posture = read(line)?;
        let layout = &self.layout;
        let mut positions: Vec<f64> = layout.joints.iter().map(|joint| joint.home).collect();
        for (name, angles) in posture {
            match angles {
                Angles::OfLimb(angles) => {
                    let joints = &self
                        .limb(LimbName::new(&name).map_err(NoAnswer::input)?)?
                        .joints;
                    if joints.len() != angles.len() {
                        return Err(NoAnswer::Input(format!(
                            "{name} has {} joints, not {}",
                            joints.len(),
                            angles.len()
                        )));
                    }
                    for (joint, angle) in joints.iter().zip(angles) {
                        positions[joint.index()] = angle;
                    }
                }
                Angles::OfJoint(angle) => {
                    let joint = JointName::new(&name).map_err(NoAnswer::input)?;
                    let joint = layout.find_joint(joint);
                    let joint = joint.filter(|joint| layout.neck == Some(*joint));
                    let joint = joint.ok_or_else(|| {
                        NoAnswer::Input(format!("{name} is neither a limb nor the neck"))
                    })?;
                    positions[joint.index()] = angle;
                }
            }
        }
        let mut configuration = self.robot.zero();
        for (joint, position) in layout.joints.iter().zip(&positions) {
            match joint.role {
                JointRole::Limb { .. } | JointRole::Neck => {
                    let joint = self.robot.find_joint(&joint.urdf_name);
                    configuration[joint.map_err(NoAnswer::input)?] = *position;
                }
                JointRole::Gripper(limb) => {
                    // Robots with other hands have other fingers.
                    let fingers = layout.limb(limb).gripper.finger_joints.iter();
                    for finger in fingers.flat_map(|name| self.robot.find_joint(name)) {
                        configuration[finger] = position / UNITS_PER_METER / 2.0;
                    }
                }
            }
        }

        let frames = self.robot.frames(&configuration);
        let mut answer = json!({ "torso": {}, "table": {} });
        for link in self.robot.links() {
            let name = &link.name;
            let in_torso = frames[self.robot.find_link(name).map_err(NoAnswer::input)?];
            let in_table = self.table_from_torso * in_torso;
            answer["torso"][name] = json!(PlacedFrame::new(&in_torso, 1.0));
            answer["table"][name] = json!(PlacedFrame::new(&in_table, UNITS_PER_METER));
        }
        Ok(answer)
    }

    fn inverse(&self, line: &[u8]) -> Result<Value, NoAnswer> {
        let reach: ReachGoal = read(line)?;
        let limb = self.limb(reach.arm)?;
        let arm = limb.name;
        let root = &self.robot.link(self.robot.root()).name;
        let tip = reach
            .link
            .or_else(|| self.end_effector(limb))
            .unwrap_or_else(|| format!("{arm}_end_effector"));
        let chain = ArmChain::between(&self.robot, root, &tip).map_err(NoAnswer::input)?;
        let (joints, found) = (limb.joints.len(), chain.joints().len());
        if joints != found {
            return Err(NoAnswer::input(ModelError::NoArm {
                base: root.clone(),
                tip,
                reason: format!("there are {found} joints instead of {joints}"),
            }));
        }
        let shoulder = &self.layout.joint(limb.joints[0]).urdf_name;
        if self.robot.find_joint(shoulder) != Ok(chain.joints()[0]) {
            return Err(NoAnswer::Input(format!(
                "link {tip} is not on the {arm} arm"
            )));
        }
        if reach.seed.as_ref().is_some_and(|seed| seed.len() != joints) {
            return Err(NoAnswer::Input(format!("seed: {arm} has {joints} joints")));
        }

        let (torso_from_given, units) = match reach.frame {
            BaseFrame::Table => (self.table_from_torso.inverse(), UNITS_PER_METER),
            BaseFrame::Torso => (DAffine3::IDENTITY, 1.0),
        };
        let position = DVec3::from_array(reach.position) / units;
        let target = match reach.quaternion_xyzw.map(DQuat::from_array) {
            None => Target::Point(torso_from_given.transform_point3(position)),
            Some(rotation) => {
                let length = rotation.length();
                if !(length.is_finite() && length > 1e-6) {
                    return Err(NoAnswer::input("quaternion_xyzw is no rotation"));
                }
                let given = DAffine3::from_rotation_translation(rotation / length, position);
                Target::Pose(torso_from_given * given)
            }
        };
        let home = || {
            let joints = limb.joints.iter();
            joints.map(|joint| self.layout.joint(*joint).home).collect()
        };
        let seed = reach.seed.unwrap_or_else(home);
        let angles = chain.solve(&target, &seed).map_err(NoAnswer::Unreachable)?;
        let miss = chain.miss(&target, &angles);
        Ok(json!({
            "angles": angles,
            "position_error": miss.position,
            "rotation_error": miss.rotation,
        }))
    }
}

impl PlacedFrame {
    fn new(frame: &DAffine3, units_per_meter: f64) -> Self {
        Self {
            position: (frame.translation * units_per_meter).to_array(),
            quaternion_xyzw: DQuat::from_mat3(&frame.matrix3).to_array(),
        }
    }
}

fn read<T: DeserializeOwned>(line: &[u8]) -> Result<T, NoAnswer> {
    serde_json::from_slice(line).map_err(|error| {
        // Its own line is always the first.
        let message = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        match message.strip_suffix(&place) {
            Some(message) => NoAnswer::Input(format!("column {}: {message}", error.column())),
            None => NoAnswer::Input(message),
        }
    })
}
