//! What a robot says of itself.

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

use serde_json::Value as Json;

use crate::{
    orders::SENDER,
    profile::{BridgeProfile, GripperProfile, HealthTopic, RosVersion},
    transport::{Received, TopicType},
};

/// How far apart two robots' clocks may drift is forgotten after this time: a shortest delay is that of the last one or two such spans.
const DELAY_SPAN: Duration = Duration::from_secs(10);

/// The newest that is known of a robot. Times are those of the bridge's clock.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotState {
    /// The joints, by the robot's names for them.
    pub joints: BTreeMap<String, JointReading>,
    /// When all joints of the profile were known last: the moment of arrival, earlier by what the message was delayed beyond the quickest one.
    pub joints_at: Option<Duration>,
    /// Whether it is on.
    pub health: Option<RobotHealth>,
    /// The grippers, by the names of their limbs.
    pub grippers: BTreeMap<String, GripperReading>,
    /// Messages that made no sense, such as angles that are no numbers. None of them is used.
    pub nonsense: u64,
}

/// A joint as it was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReading {
    /// Its angle, in rad.
    pub position: f64,
    /// Its speed, in rad/s, if it is measured.
    pub velocity: Option<f64>,
    /// Its torque, in N m, if it is measured.
    pub effort: Option<f64>,
}

/// Whether a robot can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotHealth {
    /// Its motors are on.
    Enabled,
    /// Its motors are off.
    Disabled,
    /// A person has stopped it, or it has stopped itself, until a person resets it.
    EmergencyStop,
    /// A part of it is faulty.
    Error,
}

/// A gripper as it reports itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripperReading {
    /// The id that commands must name.
    pub id: u32,
    /// Whether it knows its range.
    pub is_calibrated: bool,
    /// Whether it holds something.
    pub is_gripping: bool,
    /// Its opening, from 0 (closed) to 1 (open).
    pub opening: f64,
    /// The number of this program's last command that it has got.
    pub sequence: Option<u32>,
}

impl RobotState {
    /// The age of the joints' angles; none if they were never known.
    pub fn age(&self, now: Duration) -> Option<Duration> {
        self.joints_at.map(|at| now.saturating_sub(at))
    }
}

/// Puts messages together to a [`RobotState`].
#[derive(Debug)]
pub struct StateReader {
    ros: RosVersion,
    joint_states: String,
    health: HealthTopic,
    /// Topics of grippers' states, with the names of their limbs.
    grippers: BTreeMap<String, String>,
    /// The joints without which a message of joints is not of this robot's arms.
    wanted: BTreeSet<String>,
    delay: ShortestDelay,
    state: RobotState,
}

impl StateReader {
    /// A reader of a robot's messages.
    pub fn new(profile: &BridgeProfile) -> Self {
        let grippers = profile.limbs.iter().filter_map(|limb| {
            let GripperProfile::EndEffector(topic) = limb.gripper.as_ref()?;
            Some((format!("{topic}/state"), limb.name.clone()))
        });
        Self {
            ros: profile.ros,
            joint_states: profile.joint_states.clone(),
            health: profile.health.clone(),
            grippers: grippers.collect(),
            wanted: profile.joints().map(|joint| joint.name.clone()).collect(),
            delay: ShortestDelay::default(),
            state: RobotState::default(),
        }
    }

    /// The topics that it reads.
    pub fn topics(&self) -> Vec<TopicType> {
        let of = |topic: &str, message: &str| TopicType {
            topic: topic.to_owned(),
            message: self.ros.type_name(message),
        };
        let mut topics = vec![
            of(&self.joint_states, "sensor_msgs/JointState"),
            of(self.health.topic(), self.health.message()),
        ];
        let grippers = self.grippers.keys();
        topics.extend(grippers.map(|topic| of(topic, "baxter_core_msgs/EndEffectorState")));
        topics
    }

    /// The state as of the last message.
    pub fn state(&self) -> &RobotState {
        &self.state
    }

    /// The joints of the profile that no message has named.
    pub fn missing(&self) -> Vec<&str> {
        let missing = self
            .wanted
            .iter()
            .filter(|name| !self.state.joints.contains_key(*name));
        missing.map(String::as_str).collect()
    }

    /// Takes a message. One that makes no sense is counted and changes nothing else.
    pub fn take(&mut self, received: &Received) {
        let message = &received.message;
        let understood = if received.topic == self.joint_states {
            self.take_joints(message, received.at)
        } else if received.topic == self.health.topic() {
            let health = health(&self.health, message);
            self.state.health = health.or(self.state.health);
            health.map(|_| ())
        } else if let Some(limb) = self.grippers.get(&received.topic) {
            let reading = gripper(message);
            if let Some(reading) = reading {
                self.state.grippers.insert(limb.clone(), reading);
            }
            reading.map(|_| ())
        } else {
            Some(())
        };
        if understood.is_none() {
            self.state.nonsense += 1;
        }
    }

    /// Joints are matched by name: messages list them in any order, beside others, and grippers publish on the same topic.
    fn take_joints(&mut self, message: &Json, at: Duration) -> Option<()> {
        let names = message.get("name")?.as_array()?;
        let positions = message.get("position")?.as_array()?;
        if names.len() != positions.len() {
            return None;
        }
        let numbers = |field: &str| message.get(field).and_then(Json::as_array);
        let (velocities, efforts) = (numbers("velocity"), numbers("effort"));
        let mut joints = BTreeMap::new();
        for (place, name) in names.iter().enumerate() {
            let name = name.as_str()?;
            if !self.wanted.contains(name) {
                continue;
            }
            let of = |numbers: Option<&Vec<Json>>| numbers?.get(place)?.as_f64();
            let reading = JointReading {
                position: positions[place].as_f64()?,
                velocity: of(velocities),
                effort: of(efforts),
            };
            joints.insert(name.to_owned(), reading);
        }
        if joints.is_empty() {
            return Some(());
        }
        let is_whole = joints.len() == self.wanted.len();
        self.state.joints.extend(joints);
        if is_whole {
            let excess = match stamp(self.ros, message) {
                Some(sent) => self.delay.excess(sent, at),
                None => Duration::ZERO,
            };
            let measured = at.saturating_sub(excess);
            self.state.joints_at = Some(
                self.state
                    .joints_at
                    .map_or(measured, |last| last.max(measured)),
            );
        }
        Some(())
    }
}

/// The time when a message was sent, on the robot's clock; none if it has no stamp.
fn stamp(ros: RosVersion, message: &Json) -> Option<Duration> {
    let stamp = message.get("header")?.get("stamp")?;
    let (seconds, nanoseconds) = match ros {
        RosVersion::Ros1 => ("secs", "nsecs"),
        RosVersion::Ros2 => ("sec", "nanosec"),
    };
    let seconds = stamp.get(seconds)?.as_u64()?;
    let nanoseconds = u32::try_from(stamp.get(nanoseconds)?.as_u64()?).ok()?;
    let sent = Duration::new(seconds, nanoseconds.min(999_999_999));
    (!sent.is_zero()).then_some(sent)
}

fn health(topic: &HealthTopic, message: &Json) -> Option<RobotHealth> {
    match topic {
        HealthTopic::AssemblyState(_) => {
            let is = |field: &str| message.get(field)?.as_bool();
            let (enabled, stopped, error) = (is("enabled")?, is("stopped")?, is("error")?);
            let button = message.get("estop_button")?.as_u64()?;
            Some(if stopped || button != 0 {
                RobotHealth::EmergencyStop
            } else if error {
                RobotHealth::Error
            } else if enabled {
                RobotHealth::Enabled
            } else {
                RobotHealth::Disabled
            })
        }
        HealthTopic::FrankaRobotState(_) => Some(match message.get("robot_mode")?.as_u64()? {
            1 | 2 => RobotHealth::Enabled,
            4 | 6 => RobotHealth::Error,
            5 => RobotHealth::EmergencyStop,
            _ => RobotHealth::Disabled,
        }),
    }
}

fn gripper(message: &Json) -> Option<GripperReading> {
    let number = |field: &str| message.get(field)?.as_u64();
    Some(GripperReading {
        id: u32::try_from(number("id")?).ok()?,
        is_calibrated: number("calibrated")? == 1,
        is_gripping: number("gripping")? == 1,
        opening: message.get("position")?.as_f64()? / 100.0,
        sequence: match message.get("command_sender")?.as_str()? == SENDER {
            true => u32::try_from(number("command_sequence")?).ok(),
            false => None,
        },
    })
}

/// The shortest time that messages were on their way lately. The clocks of robot and program differ by an unknown time, so only what a
/// message took longer than the quickest one can be known.
#[derive(Debug, Default)]
struct ShortestDelay {
    /// When the present span began; the least differences of arrival and stamp of this span and the one before, in s.
    since: Duration,
    present: Option<f64>,
    before: Option<f64>,
}

impl ShortestDelay {
    /// What a message was on its way longer than the quickest one.
    fn excess(&mut self, sent: Duration, at: Duration) -> Duration {
        let delay = at.as_secs_f64() - sent.as_secs_f64();
        if at.saturating_sub(self.since) > DELAY_SPAN {
            self.since = at;
            self.before = self.present.take();
        }
        let present = self.present.map_or(delay, |least| least.min(delay));
        self.present = Some(present);
        let least = self.before.map_or(present, |before| before.min(present));
        Duration::try_from_secs_f64(delay - least).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn reader() -> StateReader {
        StateReader::new(&BridgeProfile::shipped("panda").unwrap())
    }

    fn names() -> Vec<String> {
        (1..8).map(|joint| format!("panda_joint{joint}")).collect()
    }

    fn joints(stamp: f64, at_ms: u64, names: &[String], positions: &[Json]) -> Received {
        let nanosec = (stamp.fract() * 1e9) as u64;
        let header = json!({"stamp": {"sec": stamp as u64, "nanosec": nanosec}});
        Received {
            topic: "/joint_states".into(),
            message: json!({"header": header, "name": names, "position": positions}),
            at: Duration::from_millis(at_ms),
        }
    }

    fn angles() -> Vec<Json> {
        (1..8).map(|joint| json!(f64::from(joint) / 10.0)).collect()
    }

    #[test]
    fn joints_are_matched_by_name_in_any_order_beside_others() {
        let mut reader = reader();
        let mut names = names();
        let mut angles = angles();
        names.reverse();
        angles.reverse();
        names.insert(3, "panda_finger_joint1".into());
        angles.insert(3, json!(9.0));
        reader.take(&joints(0.0, 5, &names, &angles));
        let state = reader.state();
        assert_eq!(state.joints.len(), 7);
        assert_eq!(state.joints["panda_joint3"].position, 0.3);
        assert_eq!(
            state.age(Duration::from_millis(8)),
            Some(Duration::from_millis(3))
        );
    }

    #[test]
    fn a_message_without_our_joints_is_passed_over() {
        let mut reader = reader();
        reader.take(&joints(0.0, 5, &["gripper".into()], &[json!(1.0)]));
        assert_eq!(reader.state(), &RobotState::default());
        assert_eq!(reader.missing().len(), 7);
    }

    #[test]
    fn an_angle_that_is_no_number_makes_the_message_nonsense() {
        let mut reader = reader();
        reader.take(&joints(0.0, 5, &names(), &angles()));
        let mut broken = angles();
        broken[2] = Json::Null;
        reader.take(&joints(0.0, 50, &names(), &broken));
        reader.take(&joints(0.0, 60, &names()[..3], &angles()));
        assert_eq!(reader.state().nonsense, 2);
        assert_eq!(reader.state().joints["panda_joint3"].position, 0.3);
        assert_eq!(reader.state().joints_at, Some(Duration::from_millis(5)));
    }

    #[test]
    fn a_late_message_is_as_old_as_its_stamp_says() {
        let mut reader = reader();
        reader.take(&joints(1000.0, 10, &names(), &angles()));
        reader.take(&joints(1000.02, 530, &names(), &angles()));
        let age = reader.state().age(Duration::from_millis(530)).unwrap();
        assert!((age.as_secs_f64() - 0.5).abs() < 1e-6, "{age:?}");
        reader.take(&joints(1000.6, 610, &names(), &angles()));
        assert!(reader.state().age(Duration::from_millis(610)).unwrap() < Duration::from_millis(1));
    }

    #[test]
    fn a_drifting_clock_makes_no_message_old() {
        let mut reader = reader();
        for second in 0..600 {
            let at = second as f64 * 1.001;
            reader.take(&joints(
                1000.0 + second as f64,
                (at * 1000.0) as u64,
                &names(),
                &angles(),
            ));
            let age = reader
                .state()
                .age(Duration::from_millis((at * 1000.0) as u64));
            assert!(age.unwrap() < Duration::from_millis(25), "{age:?}");
        }
    }

    #[test]
    fn a_pressed_button_is_an_emergency_stop_whatever_else_is_said() {
        let topic = HealthTopic::AssemblyState("/robot/state".into());
        let of = |enabled: bool, stopped: bool, error: bool, button: u8| {
            let message = json!({"ready": true, "enabled": enabled, "stopped": stopped, "error": error, "estop_button": button, "estop_source": 0});
            health(&topic, &message)
        };
        assert_eq!(of(true, false, false, 0), Some(RobotHealth::Enabled));
        assert_eq!(of(false, false, false, 0), Some(RobotHealth::Disabled));
        assert_eq!(of(true, false, true, 0), Some(RobotHealth::Error));
        assert_eq!(of(true, false, false, 1), Some(RobotHealth::EmergencyStop));
        assert_eq!(of(false, true, true, 3), Some(RobotHealth::EmergencyStop));
        assert_eq!(health(&topic, &json!({"enabled": true})), None);
    }
}
