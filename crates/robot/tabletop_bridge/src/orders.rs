//! What a robot is sent, and the messages that say it.

use serde_json::{Value as Json, json};

use crate::{
    profile::{BridgeProfile, CommandTopic, GripperProfile, LimbProfile},
    transport::TopicType,
};

/// Modes of a `baxter_core_msgs/JointCommand`. There are more, of torques and unfiltered positions, which are never sent.
const POSITION_MODE: i32 = 1;
const VELOCITY_MODE: i32 = 2;

/// The share of its greatest speed at which a head turns.
const HEAD_SPEED: f64 = 0.2;

/// Who sends a gripper's commands.
pub(crate) const SENDER: &str = "tabletop";

/// What a robot is sent. Limbs are their places in the profile.
#[derive(Clone, Debug, PartialEq)]
pub enum RobotOrder {
    /// Speeds of a limb's joints, in rad/s.
    Velocities {
        /// The limb.
        limb: usize,
        /// A speed for each joint.
        speeds: Vec<f64>,
    },
    /// Angles of a limb's joints, in rad.
    Positions {
        /// The limb.
        limb: usize,
        /// An angle for each joint.
        angles: Vec<f64>,
    },
    /// A gripper moves.
    MoveGripper {
        /// The limb.
        limb: usize,
        /// The gripper's id.
        id: u32,
        /// What it does.
        motion: GripperMotion,
        /// The number by which the gripper says that it has got this.
        sequence: u32,
    },
    /// The head turns to an angle, in rad.
    TurnHead(f64),
    /// A limb stops by itself if it gets no command for this time, in s.
    LimitTime {
        /// The limb.
        limb: usize,
        /// The time.
        seconds: f64,
    },
    /// Positions of a limb are approached at this share of its greatest speed.
    LimitSpeed {
        /// The limb.
        limb: usize,
        /// The share.
        ratio: f64,
    },
    /// The motors are switched on.
    Enable,
}

/// What a gripper does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GripperMotion {
    /// It goes to an opening, from 0 (closed) to 1 (open).
    Open(f64),
    /// It finds out its range, by closing and opening.
    Calibrate,
}

/// The topics on which orders are sent, and whether the last message of each is kept for those who listen later.
pub(crate) fn topics(profile: &BridgeProfile, driven: &[usize]) -> Vec<(TopicType, bool)> {
    let of = |topic: &str, message: &str| TopicType {
        topic: topic.to_owned(),
        message: profile.ros.type_name(message),
    };
    let mut topics = Vec::new();
    let mut add = |topic: TopicType, is_latched: bool| {
        if topics.iter().all(|(known, _)| *known != topic) {
            topics.push((topic, is_latched));
        }
    };
    for limb in driven.iter().map(|place| &profile.limbs[*place]) {
        for commands in [&limb.velocities].into_iter().chain(&limb.positions) {
            add(of(commands.topic(), commands.message()), false);
        }
        if let Some(limit) = &limb.time_limit {
            add(of(&limit.topic, "std_msgs/Float64"), true);
        }
        if let Some(topic) = &limb.speed_ratio {
            add(of(topic, "std_msgs/Float64"), true);
        }
        if let Some(GripperProfile::EndEffector(topic)) = &limb.gripper {
            add(
                of(
                    &format!("{topic}/command"),
                    "baxter_core_msgs/EndEffectorCommand",
                ),
                false,
            );
        }
    }
    if let Some(head) = &profile.head {
        add(of(&head.topic, "baxter_core_msgs/HeadPanCommand"), false);
    }
    if let Some(topic) = &profile.enable {
        add(of(topic, "std_msgs/Bool"), false);
    }
    topics
}

/// The topic and the message of an order; none if the robot has nothing for it.
pub(crate) fn message(profile: &BridgeProfile, order: &RobotOrder) -> Option<(String, Json)> {
    let limb = |place: &usize| &profile.limbs[*place];
    match order {
        RobotOrder::Velocities {
            limb: place,
            speeds,
        } => {
            let limb = limb(place);
            Some(joint_command(limb, &limb.velocities, VELOCITY_MODE, speeds))
        }
        RobotOrder::Positions {
            limb: place,
            angles,
        } => {
            let limb = limb(place);
            let topic = limb.positions.as_ref()?;
            Some(joint_command(limb, topic, POSITION_MODE, angles))
        }
        RobotOrder::MoveGripper {
            limb: place,
            id,
            motion,
            sequence,
        } => {
            let GripperProfile::EndEffector(topic) = limb(place).gripper.as_ref()?;
            let (command, arguments) = match motion {
                GripperMotion::Open(opening) => {
                    let percent = 100.0 * opening.clamp(0.0, 1.0);
                    ("go", json!({"position": percent}).to_string())
                }
                GripperMotion::Calibrate => ("calibrate", String::new()),
            };
            let message = json!({"id": id, "command": command, "args": arguments, "sender": SENDER, "sequence": sequence});
            Some((format!("{topic}/command"), message))
        }
        RobotOrder::TurnHead(angle) => {
            let topic = profile.head.as_ref()?.topic.clone();
            let message =
                json!({"target": angle, "speed_ratio": HEAD_SPEED, "enable_pan_request": 1});
            Some((topic, message))
        }
        RobotOrder::LimitTime {
            limb: place,
            seconds,
        } => {
            let topic = limb(place).time_limit.as_ref()?.topic.clone();
            Some((topic, json!({"data": seconds})))
        }
        RobotOrder::LimitSpeed { limb: place, ratio } => {
            let topic = limb(place).speed_ratio.clone()?;
            Some((topic, json!({"data": ratio})))
        }
        RobotOrder::Enable => Some((profile.enable.clone()?, json!({"data": true}))),
    }
}

fn joint_command(
    limb: &LimbProfile,
    topic: &CommandTopic,
    mode: i32,
    numbers: &[f64],
) -> (String, Json) {
    let message = match topic {
        CommandTopic::JointCommand(_) => {
            let names: Vec<_> = limb
                .joints
                .iter()
                .map(|joint| joint.name.as_str())
                .collect();
            json!({"mode": mode, "command": numbers, "names": names})
        }
        CommandTopic::Float64MultiArray(_) => {
            json!({"layout": {"dim": [], "data_offset": 0}, "data": numbers})
        }
    };
    (topic.topic().to_owned(), message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_baxter_is_sent_joint_commands_by_name() {
        let profile = BridgeProfile::shipped("baxter").unwrap();
        let order = RobotOrder::Velocities {
            limb: 1,
            speeds: vec![0.5; 7],
        };
        let (topic, sent) = message(&profile, &order).unwrap();
        assert_eq!(topic, "/robot/limb/right/joint_command");
        assert_eq!(sent["mode"], 2);
        assert_eq!(sent["names"][6], "right_w2");
        let order = RobotOrder::MoveGripper {
            limb: 0,
            id: 65538,
            motion: GripperMotion::Open(0.4),
            sequence: 7,
        };
        let (topic, sent) = message(&profile, &order).unwrap();
        assert_eq!(topic, "/robot/end_effector/left_gripper/command");
        assert_eq!(sent["args"], "{\"position\":40.0}");
    }

    #[test]
    fn a_panda_is_sent_arrays_and_nothing_that_it_lacks() {
        let profile = BridgeProfile::shipped("panda").unwrap();
        let order = RobotOrder::Velocities {
            limb: 0,
            speeds: vec![0.1; 7],
        };
        let (topic, sent) = message(&profile, &order).unwrap();
        assert_eq!(topic, "/joint_velocity_controller/commands");
        assert_eq!(sent["data"].as_array().unwrap().len(), 7);
        for order in [
            RobotOrder::Enable,
            RobotOrder::TurnHead(0.1),
            RobotOrder::LimitTime {
                limb: 0,
                seconds: 0.1,
            },
        ] {
            assert_eq!(message(&profile, &order), None);
        }
        let [(topic, false)] = &topics(&profile, &[0])[..] else {
            panic!("it has one topic");
        };
        assert_eq!(topic.message, "std_msgs/msg/Float64MultiArray");
    }
}
