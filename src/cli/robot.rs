//! `tabletop robot`: the robot's kinematics for other programs, a line of JSON for a line of JSON.

use std::{fmt, io::BufRead as _, path::PathBuf, process::ExitCode};

use bevy::math::{DAffine3, DQuat, DVec3};
use clap::{Args, Subcommand};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Value, json};
use tabletop::{
    core::{Arm, JOINTS_PER_ARM, RobotJoint, Table, UNITS_PER_METER, robot_base},
    shipped::read_text,
};
use tabletop_kinematics::{ArmChain, ModelError, RobotModel, Target, Unreachable, baxter};

use super::{Failure, Output, WRONG_INPUT};

#[derive(Args)]
pub(super) struct RobotArgs {
    #[command(subcommand)]
    question: Question,
    /// A robot description (URDF) in place of the Baxter that comes with the program, with the same names of joints and hands
    #[arg(long, value_name = "FILE", global = true)]
    robot: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Question {
    /// Say where the robot's frames are, for joint angles from standard input
    Fk,
    /// Say which joint angles bring a hand somewhere, for poses from standard input
    Ik,
}

/// Answers every line of standard input.
pub(super) fn robot(args: &RobotArgs) -> Result<ExitCode, Failure> {
    let answerer = Answerer::new(args)?;
    let mut code = ExitCode::SUCCESS;
    let mut unreadable = false;
    for (i, line) in std::io::stdin().lock().split(b'\n').enumerate() {
        let line = line.map_err(|error| Failure::run(format!("standard input: {error}")))?;
        if line.trim_ascii().is_empty() {
            continue;
        }
        let answer = match args.question {
            Question::Fk => answerer.forward(&line),
            Question::Ik => answerer.inverse(&line),
        };
        let answer = answer.unwrap_or_else(|fault| match fault {
            Fault::Input(message) => {
                unreadable = true;
                json!({ "error": format!("line {}: {message}", i + 1) })
            }
            Fault::Unreachable(error) => {
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

/// Why a line has no answer.
enum Fault {
    /// The line is wrong.
    Input(String),
    /// No angles do what it asks for.
    Unreachable(Unreachable),
}

impl Fault {
    fn input(error: impl fmt::Display) -> Self {
        Self::Input(error.to_string())
    }
}

/// Angles in rad; what is left out is as in the robot's start posture.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Posture {
    left: Option<[f64; JOINTS_PER_ARM]>,
    right: Option<[f64; JOINTS_PER_ARM]>,
    head_pan: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reach {
    arm: Side,
    /// In m in the torso's frame, in units in the table's.
    position: [f64; 3],
    /// Any rotation does if it is left out.
    quaternion_xyzw: Option<[f64; 4]>,
    #[serde(default)]
    frame: Frame,
    /// What shall get there, in place of the end effector.
    link: Option<String>,
    /// Angles to stay near to, in rad.
    seed: Option<[f64; JOINTS_PER_ARM]>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Side {
    Left,
    Right,
}

impl From<Side> for Arm {
    fn from(side: Side) -> Self {
        match side {
            Side::Left => Self::Left,
            Side::Right => Self::Right,
        }
    }
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Frame {
    #[default]
    Table,
    Torso,
}

#[derive(Serialize)]
struct Placed {
    position: [f64; 3],
    quaternion_xyzw: [f64; 4],
}

struct Answerer {
    robot: RobotModel,
    /// From the torso's frame (m) to the table's, in m as well.
    table_from_torso: DAffine3,
}

impl Answerer {
    fn new(args: &RobotArgs) -> Result<Self, Failure> {
        let robot = match &args.robot {
            None => baxter().map_err(Failure::input)?,
            Some(file) => {
                let at = |error: &dyn fmt::Display| {
                    Failure::input(format!("{}: {error}", file.display()))
                };
                let text = read_text(file).map_err(|error| at(&error))?;
                RobotModel::from_urdf(&text).map_err(|error| at(&error))?
            }
        };
        let base = robot_base(&Table::default());
        Ok(Self {
            robot,
            table_from_torso: DAffine3::from_rotation_translation(
                base.rotation.as_dquat().normalize(),
                base.location.as_dvec3() / UNITS_PER_METER,
            ),
        })
    }

    fn forward(&self, line: &[u8]) -> Result<Value, Fault> {
        let posture: Posture = read(line)?;
        let mut configuration = self.robot.zero();
        let mut set = |name: &str, position: f64| -> Result<(), ModelError> {
            configuration[self.robot.find_joint(name)?] = position;
            Ok(())
        };
        for (arm, angles) in [(Arm::Left, posture.left), (Arm::Right, posture.right)] {
            let angles = angles.unwrap_or_else(|| home(arm));
            for (joint, angle) in RobotJoint::of_arm(arm).into_iter().zip(angles) {
                set(joint.name(), angle).map_err(Fault::input)?;
            }
        }
        let pan = RobotJoint::HeadPan;
        set(pan.name(), posture.head_pan.unwrap_or(pan.home())).map_err(Fault::input)?;
        for arm in Arm::BOTH {
            let opening = RobotJoint::gripper(arm).home() / UNITS_PER_METER;
            // Robots with other hands have other fingers.
            for joint in fingers(arm)
                .into_iter()
                .flat_map(|name| self.robot.find_joint(name))
            {
                configuration[joint] = opening / 2.0;
            }
        }

        let frames = self.robot.frames(&configuration);
        let mut answer = json!({ "torso": {}, "table": {} });
        for link in self.robot.links() {
            let name = &link.name;
            let in_torso = frames[self.robot.find_link(name).map_err(Fault::input)?];
            let in_table = self.table_from_torso * in_torso;
            answer["torso"][name] = json!(Placed::new(&in_torso, 1.0));
            answer["table"][name] = json!(Placed::new(&in_table, UNITS_PER_METER));
        }
        Ok(answer)
    }

    fn inverse(&self, line: &[u8]) -> Result<Value, Fault> {
        let reach: Reach = read(line)?;
        let arm = Arm::from(reach.arm);
        let tip = reach
            .link
            .unwrap_or_else(|| format!("{}_end_effector", arm.name()));
        let root = &self.robot.link(self.robot.root()).name;
        let chain = ArmChain::between(&self.robot, root, &tip).map_err(Fault::input)?;
        let shoulder = self.robot.find_joint(RobotJoint::of_arm(arm)[0].name());
        if shoulder != Ok(chain.joints()[0]) {
            return Err(Fault::Input(format!("link {tip} is not on the {arm} arm")));
        }

        let (torso_from_given, units) = match reach.frame {
            Frame::Table => (self.table_from_torso.inverse(), UNITS_PER_METER),
            Frame::Torso => (DAffine3::IDENTITY, 1.0),
        };
        let position = DVec3::from_array(reach.position) / units;
        let target = match reach.quaternion_xyzw.map(DQuat::from_array) {
            None => Target::Point(torso_from_given.transform_point3(position)),
            Some(rotation) => {
                let length = rotation.length();
                if !(length.is_finite() && length > 1e-6) {
                    return Err(Fault::input("quaternion_xyzw is no rotation"));
                }
                let given = DAffine3::from_rotation_translation(rotation / length, position);
                Target::Pose(torso_from_given * given)
            }
        };
        let seed = reach.seed.unwrap_or_else(|| home(arm));
        let angles = chain.solve(&target, &seed).map_err(Fault::Unreachable)?;
        let miss = chain.miss(&target, &angles);
        Ok(json!({
            "angles": angles,
            "position_error": miss.position,
            "rotation_error": miss.rotation,
        }))
    }
}

impl Placed {
    fn new(frame: &DAffine3, units_per_meter: f64) -> Self {
        Self {
            position: (frame.translation * units_per_meter).to_array(),
            quaternion_xyzw: DQuat::from_mat3(&frame.matrix3).to_array(),
        }
    }
}

fn home(arm: Arm) -> [f64; JOINTS_PER_ARM] {
    RobotJoint::of_arm(arm).map(RobotJoint::home)
}

/// Joints of the fingers of an arm's gripper.
const fn fingers(arm: Arm) -> [&'static str; 2] {
    match arm {
        Arm::Left => ["l_gripper_l_finger_joint", "l_gripper_r_finger_joint"],
        Arm::Right => ["r_gripper_l_finger_joint", "r_gripper_r_finger_joint"],
    }
}

fn read<T: DeserializeOwned>(line: &[u8]) -> Result<T, Fault> {
    serde_json::from_slice(line).map_err(|error| {
        // Its own line is always the first.
        let message = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        match message.strip_suffix(&place) {
            Some(message) => Fault::Input(format!("column {}: {message}", error.column())),
            None => Fault::Input(message),
        }
    })
}
