//! What there is to know of a real robot's interface: the topics, message types and limits of its `bridge.ron`.

use std::{collections::BTreeSet, fmt, path::Path};

use ron::{Options, extensions::Extensions};
use serde::Deserialize;
use tabletop_storage::{Symlinks, read_regular_text};
use thiserror::Error;

/// The profiles inside the program, by the names that addresses have.
const SHIPPED: [(&str, &str); 3] = [
    (
        "baxter",
        include_str!("../../../../assets/baxter/bridge.ron"),
    ),
    ("panda", include_str!("../../../../assets/panda/bridge.ron")),
    (
        "fr3",
        include_str!("../../../../assets/panda/fr3.bridge.ron"),
    ),
];

/// The most bytes of a profile.
const MOST_BYTES: u64 = 1 << 16;
/// The most limbs of a robot, and joints of a limb.
const MOST_PARTS: usize = 16;
/// The fastest that a joint of any robot may turn, in rad/s.
const MOST_SPEED: f64 = 20.0;

/// A robot's interface.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename = "Bridge", deny_unknown_fields)]
pub struct BridgeProfile {
    /// The robot's name in messages.
    pub robot: String,
    /// The ROS that it speaks.
    pub ros: RosVersion,
    /// The version of the robot's software that this was made for; unknown if none.
    #[serde(default)]
    pub software: Option<SoftwareVersion>,
    /// The topic of the joints' states (`sensor_msgs/JointState`).
    pub joint_states: String,
    /// Other beginnings of the joints' names in those states, each with the one that it stands for, such as `("fer_", "panda_")`.
    #[serde(default)]
    pub also_named: Vec<(String, String)>,
    /// Where the robot says whether it is on, stopped or faulty.
    pub health: HealthTopic,
    /// The topic that switches the motors on (`std_msgs/Bool`); none if that is done on the robot alone.
    #[serde(default)]
    pub enable: Option<String>,
    /// The limbs.
    pub limbs: Vec<LimbProfile>,
    /// The joint that turns the head.
    #[serde(default)]
    pub head: Option<HeadProfile>,
    /// The cameras.
    #[serde(default)]
    pub cameras: Vec<CameraProfile>,
}

/// The two kinds of ROS, which name types and stamps differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum RosVersion {
    /// `std_msgs/Bool`, `secs` and `nsecs`.
    Ros1,
    /// `std_msgs/msg/Bool`, `sec` and `nanosec`.
    Ros2,
}

/// A version of the robot's software.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoftwareVersion {
    /// The parameter that holds it.
    pub parameter: String,
    /// The versions that are known.
    pub known: Vec<String>,
}

/// The topic of a robot's health, by its message type.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub enum HealthTopic {
    /// `baxter_core_msgs/AssemblyState`.
    AssemblyState(String),
    /// `franka_msgs/FrankaRobotState`.
    FrankaRobotState(String),
}

/// A limb's interface.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimbProfile {
    /// The name that it has in `robot.ron`.
    pub name: String,
    /// Its joints, from the base to the tip.
    pub joints: Vec<JointProfile>,
    /// Where velocities go.
    pub velocities: CommandTopic,
    /// Where positions go; none if the robot is driven by velocities alone.
    #[serde(default)]
    pub positions: Option<CommandTopic>,
    /// The robot's own time limit for commands; none if it has none, and then keeps the last velocity for ever.
    #[serde(default)]
    pub time_limit: Option<TimeLimit>,
    /// The topic of the share of its greatest speed that position commands have (`std_msgs/Float64`).
    #[serde(default)]
    pub speed_ratio: Option<String>,
    /// Its gripper.
    #[serde(default)]
    pub gripper: Option<GripperProfile>,
}

/// A joint's limits.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointProfile {
    /// Its name in the joints' states.
    pub name: String,
    /// Least and largest angle, in rad.
    pub limits: (f64, f64),
    /// Greatest speed, in rad/s.
    pub speed: f64,
}

/// A topic of commands, by its message type.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub enum CommandTopic {
    /// `baxter_core_msgs/JointCommand`. Its mode follows from what is sent: no profile can ask for torques or for unfiltered positions.
    JointCommand(String),
    /// `std_msgs/Float64MultiArray`, a number for each joint in their order.
    Float64MultiArray(String),
}

/// The time after which a robot stops by itself if no command comes (`std_msgs/Float64`), in s.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeLimit {
    /// Its topic.
    pub topic: String,
    /// While this program drives.
    pub driven: f64,
    /// Otherwise.
    pub idle: f64,
}

/// A gripper's interface.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub enum GripperProfile {
    /// `command` and `state` below this topic: `baxter_core_msgs/EndEffectorCommand` and `EndEffectorState`.
    EndEffector(String),
}

/// The head's interface.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadProfile {
    /// The joint that turns it.
    pub joint: JointProfile,
    /// Where `baxter_core_msgs/HeadPanCommand` goes.
    pub topic: String,
}

/// A camera's interface.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraProfile {
    /// Its name in `robot.ron`; `head` is the robot's eye.
    pub name: String,
    /// The topic of its pictures (`sensor_msgs/Image`).
    pub topic: String,
    /// How it is opened; none if it always is.
    #[serde(default)]
    pub opening: Option<CameraOpening>,
}

/// How a camera is opened (`baxter_core_msgs/OpenCamera`).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraOpening {
    /// The service.
    pub service: String,
    /// The camera's name there.
    pub name: String,
    /// Columns and rows of its pictures.
    pub size: (u32, u32),
    /// Pictures a second.
    pub rate: f64,
    /// Whether it hangs upside down, so that the robot must turn its pictures.
    pub is_upside_down: bool,
}

/// A `bridge.ron` that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{place}: {fault}")]
pub struct ProfileError {
    place: String,
    fault: String,
}

impl RosVersion {
    /// The name of a type, of which `package/Name` is given.
    pub(crate) fn type_name(self, package_and_name: &str) -> String {
        match self {
            Self::Ros1 => package_and_name.to_owned(),
            Self::Ros2 => package_and_name.replacen('/', "/msg/", 1),
        }
    }
}

impl fmt::Display for RosVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ros1 => "ROS 1",
            Self::Ros2 => "ROS 2",
        })
    }
}

impl HealthTopic {
    /// The topic.
    pub fn topic(&self) -> &str {
        match self {
            Self::AssemblyState(topic) | Self::FrankaRobotState(topic) => topic,
        }
    }

    pub(crate) fn message(&self) -> &'static str {
        match self {
            Self::AssemblyState(_) => "baxter_core_msgs/AssemblyState",
            Self::FrankaRobotState(_) => "franka_msgs/FrankaRobotState",
        }
    }
}

impl CommandTopic {
    /// The topic.
    pub fn topic(&self) -> &str {
        match self {
            Self::JointCommand(topic) | Self::Float64MultiArray(topic) => topic,
        }
    }

    pub(crate) fn message(&self) -> &'static str {
        match self {
            Self::JointCommand(_) => "baxter_core_msgs/JointCommand",
            Self::Float64MultiArray(_) => "std_msgs/Float64MultiArray",
        }
    }
}

impl BridgeProfile {
    /// The names of the profiles inside the program.
    pub fn shipped_names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// A profile inside the program, such as `baxter`.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn shipped(name: &str) -> Result<Self, ProfileError> {
        let found = SHIPPED.iter().find(|(known, _)| *known == name);
        let Some((_, text)) = found else {
            let names: Vec<_> = Self::shipped_names().collect();
            return Err(ProfileError {
                place: format!("robot {name:?}"),
                fault: format!(
                    "there is no profile of this name, only {}",
                    names.join(", ")
                ),
            });
        };
        Self::parse(text, &format!("bridge.ron of {name}"))
    }

    /// The profile in a file.
    ///
    /// # Errors
    /// The file cannot be read, or is no profile.
    pub fn read(path: &Path) -> Result<Self, ProfileError> {
        let place = path.display().to_string();
        let text = read_regular_text(path, MOST_BYTES, Symlinks::Followed);
        let text = text.map_err(|error| ProfileError {
            place: place.clone(),
            fault: error.to_string(),
        })?;
        Self::parse(&text, &place)
    }

    /// The profile in a text, which refusals call by the name of its place.
    ///
    /// # Errors
    /// It is no profile, or says what no robot has.
    pub fn parse(text: &str, place: &str) -> Result<Self, ProfileError> {
        let options = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let profile: Self = options.from_str(text).map_err(|error| ProfileError {
            place: format!("{place}:{}", error.span.start),
            fault: error.code.to_string(),
        })?;
        let error = |fault| ProfileError {
            place: place.to_owned(),
            fault,
        };
        profile.check().map_err(error)?;
        Ok(profile)
    }

    /// The place of a limb.
    pub(crate) fn limb(&self, name: &str) -> Option<usize> {
        self.limbs.iter().position(|limb| limb.name == name)
    }

    /// The places of the limbs of these names; of all limbs if there is none. An error is the name of one that there is not.
    pub(crate) fn places(&self, names: &[String]) -> Result<Vec<usize>, String> {
        if names.is_empty() {
            return Ok((0..self.limbs.len()).collect());
        }
        let places = names
            .iter()
            .map(|name| self.limb(name).ok_or_else(|| name.clone()));
        let mut places: Vec<_> = places.collect::<Result<_, _>>()?;
        places.sort_unstable();
        places.dedup();
        Ok(places)
    }

    /// True if a limb keeps its last speed when no more commands come, so that somebody must be there when this program is killed.
    pub fn needs_sentinel(&self) -> bool {
        self.limbs.iter().any(|limb| limb.time_limit.is_none())
    }

    /// All joints, those of the limbs first.
    pub(crate) fn joints(&self) -> impl Iterator<Item = &JointProfile> {
        let of_limbs = self.limbs.iter().flat_map(|limb| &limb.joints);
        of_limbs.chain(self.head.iter().map(|head| &head.joint))
    }

    /// The joint that a state calls by this name.
    pub(crate) fn joint_of(&self, name: &str) -> Option<&JointProfile> {
        let other = self.also_named.iter().find_map(|(other, own)| {
            let rest = name.strip_prefix(other.as_str())?;
            Some(format!("{own}{rest}"))
        });
        let is_meant = |joint: &&JointProfile| {
            joint.name == name || other.as_ref().is_some_and(|other| joint.name == *other)
        };
        self.joints().find(is_meant)
    }

    fn check(&self) -> Result<(), String> {
        if self.limbs.is_empty() || self.limbs.len() > MOST_PARTS {
            return Err(format!("limbs: there must be 1 to {MOST_PARTS}"));
        }
        let mut names = BTreeSet::new();
        for limb in &self.limbs {
            let within = format!("limb {:?}", limb.name);
            if limb.joints.is_empty() || limb.joints.len() > MOST_PARTS {
                return Err(format!("{within}: there must be 1 to {MOST_PARTS} joints"));
            }
            if !names.insert(&limb.name) {
                return Err(format!("{within}: there is another of this name"));
            }
            let limit = limb.time_limit.as_ref();
            let is_time = |seconds: f64| (0.01..=1.0).contains(&seconds);
            if limit.is_some_and(|it| !is_time(it.driven) || !is_time(it.idle)) {
                return Err(format!("{within}: time_limit must be 0.01 to 1 s"));
            }
        }
        for joint in self.joints() {
            if !names.insert(&joint.name) {
                return Err(format!(
                    "joint {:?}: there is another of this name",
                    joint.name
                ));
            }
            joint.check()?;
        }
        for topic in self.topics() {
            let is_of_topic =
                |letter: char| letter.is_ascii_alphanumeric() || "/_~".contains(letter);
            if !topic.starts_with('/') || !topic.chars().all(is_of_topic) {
                return Err(format!(
                    "{topic:?} is no topic: it begins with a slash and consists of letters, digits, _ and /"
                ));
            }
        }
        Ok(())
    }

    fn topics(&self) -> impl Iterator<Item = &str> {
        let of_limbs = self.limbs.iter().flat_map(|limb| {
            let gripper = limb
                .gripper
                .as_ref()
                .map(|GripperProfile::EndEffector(topic)| topic.as_str());
            let limit = limb.time_limit.as_ref().map(|limit| limit.topic.as_str());
            let positions = limb.positions.as_ref().map(CommandTopic::topic);
            let optional = [gripper, limit, positions, limb.speed_ratio.as_deref()];
            [limb.velocities.topic()]
                .into_iter()
                .chain(optional.into_iter().flatten())
        });
        let whole = [
            Some(self.joint_states.as_str()),
            Some(self.health.topic()),
            self.enable.as_deref(),
        ];
        let head = self.head.as_ref().map(|head| head.topic.as_str());
        let cameras = self.cameras.iter().flat_map(|camera| {
            let service = camera
                .opening
                .as_ref()
                .map(|opening| opening.service.as_str());
            [camera.topic.as_str()].into_iter().chain(service)
        });
        of_limbs
            .chain(whole.into_iter().flatten())
            .chain(head)
            .chain(cameras)
    }
}

impl JointProfile {
    fn check(&self) -> Result<(), String> {
        let Self {
            name,
            limits: (least, largest),
            speed,
        } = self;
        if !(least.is_finite() && largest.is_finite() && least < largest) {
            return Err(format!(
                "joint {name:?}: limits must be two angles, the lesser first"
            ));
        }
        if !(*speed > 0.0 && *speed <= MOST_SPEED) {
            return Err(format!(
                "joint {name:?}: speed must be above 0 and at most {MOST_SPEED} rad/s"
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_profiles_are_those_of_their_robots() {
        let baxter = BridgeProfile::shipped("baxter").unwrap();
        assert_eq!(baxter.joints().count(), 15);
        assert_eq!(baxter.limb("right"), Some(1));
        let panda = BridgeProfile::shipped("panda").unwrap();
        assert_eq!(panda.joints().count(), 7);
        let refusal = BridgeProfile::shipped("sawyer").unwrap_err().to_string();
        assert_eq!(
            refusal,
            "robot \"sawyer\": there is no profile of this name, only baxter, panda, fr3"
        );
    }

    #[test]
    fn a_refusal_says_where_the_fault_is() {
        let text = SHIPPED[0].1;
        for (old, new, fault) in [
            (
                "robot:",
                "robott:",
                "x.ron:4:5: Unexpected field named `robott`",
            ),
            (
                "speed: 1.5",
                "speed: 0",
                "joint \"left_s0\": speed must be above 0",
            ),
            (
                "limits: (-2.147, 1.047)",
                "limits: (2, 1)",
                "joint \"left_s1\": limits must be",
            ),
            (
                "\"left_s1\"",
                "\"left_s0\"",
                "joint \"left_s0\": there is another",
            ),
            (
                "\"/robot/state\"",
                "\"robot/state\"",
                "\"robot/state\" is no topic",
            ),
            (
                "driven: 0.1",
                "driven: 60",
                "limb \"left\": time_limit must be",
            ),
            ("JointCommand(", "TorqueCommand(", "TorqueCommand"),
        ] {
            assert!(text.contains(old), "{old}");
            let refusal = BridgeProfile::parse(&text.replacen(old, new, 1), "x.ron");
            let refusal = refusal.unwrap_err().to_string();
            assert!(refusal.contains(fault), "{refusal}");
        }
    }
}
