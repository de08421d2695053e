//! Messages put together to a state.

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

use serde_json::Value as Json;

use super::{
    GripperReading, JointReading, RobotState, health::health, jump::jump, sender_clock::SenderClock,
};
use crate::{
    profile::{BridgeProfile, GripperProfile, JointProfile, RosVersion},
    transport::{Received, TopicType},
};

/// The most names of joints of others that are remembered.
const MOST_STRANGERS: usize = 64;

/// Puts messages together to a [`RobotState`].
#[derive(Debug)]
pub struct StateReader {
    profile: BridgeProfile,
    /// Topics of grippers' states, with the names of their limbs.
    grippers: BTreeMap<String, String>,
    /// When each joint was measured.
    measured_at: BTreeMap<String, Duration>,
    /// Joints that are not of the profile.
    strangers: BTreeSet<String>,
    clock: SenderClock,
    /// The moments for which all joints were known first and last, and how many there were.
    known: Option<(Duration, Duration, u32)>,
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
            grippers: grippers.collect(),
            profile: profile.clone(),
            measured_at: BTreeMap::new(),
            strangers: BTreeSet::new(),
            clock: SenderClock::default(),
            known: None,
            state: RobotState::default(),
        }
    }

    /// The topics that it reads.
    pub fn topics(&self) -> Vec<TopicType> {
        let of = |topic: &str, message: &str| TopicType {
            topic: topic.to_owned(),
            message: self.profile.ros.type_name(message),
        };
        let health = &self.profile.health;
        let mut topics = vec![
            of(&self.profile.joint_states, "sensor_msgs/JointState"),
            of(health.topic(), health.message()),
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
        let all = self.profile.joints().map(|joint| joint.name.as_str());
        all.filter(|name| !self.state.joints.contains_key(*name))
            .collect()
    }

    /// Joints that messages have named and the profile has not.
    pub fn strangers(&self) -> impl Iterator<Item = &str> {
        self.strangers.iter().map(String::as_str)
    }

    /// The mean time from one state of all joints to the next; none before there were three.
    pub fn period(&self) -> Option<Duration> {
        let (first, last, count) = self.known?;
        (count > 2).then(|| (last - first) / (count - 1))
    }

    /// Takes a message. One that makes no sense is counted and changes nothing else.
    pub fn take(&mut self, received: &Received) {
        let Received { topic, message, at } = received;
        let understood = if *topic == self.profile.joint_states {
            self.take_joints(message, *at)
        } else if topic == self.profile.health.topic() {
            let health = health(&self.profile.health, message);
            if health.is_some() {
                (self.state.health, self.state.health_at) = (health, Some(*at));
            }
            health.map(|_| ())
        } else if let Some(limb) = self.grippers.get(topic) {
            let reading = GripperReading::of(message, *at);
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

    /// Joints are matched by name: messages list them in any order, beside others, and some of them in each of several messages.
    fn take_joints(&mut self, message: &Json, at: Duration) -> Option<()> {
        let names = message.get("name")?.as_array()?;
        let positions = message.get("position")?.as_array()?;
        if names.len() != positions.len() {
            return None;
        }
        let numbers = |field: &str| message.get(field).and_then(Json::as_array);
        let (velocities, efforts) = (numbers("velocity"), numbers("effort"));
        let mut joints = Vec::new();
        for (place, name) in names.iter().enumerate() {
            let name = name.as_str()?;
            let Some(joint) = self.profile.joint_of(name) else {
                if self.strangers.len() < MOST_STRANGERS {
                    self.strangers.insert(name.to_owned());
                }
                continue;
            };
            let of = |numbers: Option<&Vec<Json>>| numbers?.get(place)?.as_f64();
            let reading = JointReading {
                position: positions[place].as_f64()?,
                velocity: of(velocities),
                effort: of(efforts),
            };
            joints.push((joint.clone(), reading));
        }
        if joints.is_empty() {
            return Some(());
        }
        let excess = match stamp(self.profile.ros, message) {
            Some(sent) => self.clock.excess(sent, at),
            None => Duration::ZERO,
        };
        self.state.pace = self.clock.pace();
        let measured = at.saturating_sub(excess);
        for (joint, reading) in joints {
            self.take_joint(&joint, reading, measured);
        }
        self.note_known();
        Some(())
    }

    fn take_joint(&mut self, joint: &JointProfile, reading: JointReading, at: Duration) {
        let before = self.state.joints.insert(joint.name.clone(), reading);
        let last = self.measured_at.insert(joint.name.clone(), at);
        // Where a head is endangers nobody.
        let mut of_limbs = self.profile.limbs.iter().flat_map(|limb| &limb.joints);
        if let (Some(before), Some(last)) = (before, last)
            && of_limbs.any(|it| it.name == joint.name)
        {
            let found = jump(joint, (before.position, last), (reading.position, at));
            self.state.jump = self.state.jump.take().or(found);
        }
    }

    /// Notes the moment for which all joints are known.
    fn note_known(&mut self) {
        let times = self
            .profile
            .joints()
            .map(|joint| self.measured_at.get(&joint.name));
        let Some(times) = times.collect::<Option<Vec<_>>>() else {
            return;
        };
        let Some(&oldest) = times.into_iter().min() else {
            return;
        };
        let last = self.state.joints_at;
        if last.is_none_or(|last| oldest > last) {
            self.state.joints_at = Some(oldest);
            self.known = Some(match self.known {
                None => (oldest, oldest, 1),
                Some((first, _, count)) => (first, oldest, count + 1),
            });
        }
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
        assert_eq!(
            reader.strangers().collect::<Vec<_>>(),
            ["panda_finger_joint1"]
        );
    }

    #[test]
    fn joints_in_several_messages_are_as_old_as_the_oldest() {
        let mut reader = reader();
        let (names, angles) = (names(), angles());
        reader.take(&joints(0.0, 5, &names[..4], &angles[..4]));
        assert_eq!(reader.state().joints_at, None);
        assert_eq!(reader.missing().len(), 3);
        reader.take(&joints(0.0, 8, &names[4..], &angles[4..]));
        assert_eq!(reader.state().joints_at, Some(Duration::from_millis(5)));
        reader.take(&joints(0.0, 15, &names[..4], &angles[..4]));
        assert_eq!(reader.state().joints_at, Some(Duration::from_millis(8)));
        reader.take(&joints(0.0, 18, &names[4..], &angles[4..]));
        assert_eq!(reader.period(), Some(Duration::from_millis(5)));
    }

    #[test]
    fn a_panda_may_have_the_names_of_its_newer_drivers() {
        let mut reader = reader();
        let names: Vec<_> = (1..8).map(|joint| format!("fer_joint{joint}")).collect();
        reader.take(&joints(0.0, 5, &names, &angles()));
        assert_eq!(reader.state().joints["panda_joint3"].position, 0.3);
        assert_eq!(reader.missing(), Vec::<&str>::new());
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
    fn a_jump_that_no_joint_can_make_is_kept() {
        let mut reader = reader();
        reader.take(&joints(0.0, 5, &names(), &angles()));
        let mut other = angles();
        other[1] = json!(5.2);
        reader.take(&joints(0.0, 15, &names(), &other));
        reader.take(&joints(0.0, 25, &names(), &angles()));
        let jump = reader.state().jump.as_ref().unwrap();
        assert_eq!((jump.joint.as_str(), jump.by), ("panda_joint2", 5.0));
    }
}
