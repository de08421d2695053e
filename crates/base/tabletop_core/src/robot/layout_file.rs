//! The file `robot.ron`: the properties of a robot that its URDF does not give.

use std::{f64::consts::TAU, fmt};

use bevy::prelude::*;
use ron::{Options, error::SpannedError, extensions::Extensions};
use serde::Deserialize;
use thiserror::Error;

use crate::{
    HandCamera,
    robot::{
        layout::{
            BaseLayout, CameraCarrier, CameraLayout, FingerLook, GripperKind, GripperLayout,
            HandCameraLayout, JointId, JointLayout, JointRole, LimbId, LimbLayout, LinkFrame,
            RobotLayout,
        },
        name::{JointName, LimbName},
    },
    ron_fault::located_ron_fault,
};

/// The content of a `robot.ron`; `docs/robot.md` explains it field by field.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Robot")]
pub struct LayoutFile {
    name: String,
    /// The URDF, beside the file.
    pub urdf: String,
    base: BaseLayout,
    camera: CameraLayout,
    #[serde(default)]
    hand_cameras: Vec<HandCameraLayout>,
    limbs: Vec<LimbEntry>,
    #[serde(default)]
    neck: Option<JointEntry>,
    #[serde(default)]
    screen: Option<String>,
    #[serde(default)]
    known_postures: Vec<Vec<f64>>,
    #[serde(default)]
    may_touch: Vec<(String, String)>,
    /// Joints of the URDF that stand still, each at its position in rad or m.
    #[serde(default)]
    pub still: Vec<(String, f64)>,
    /// The text that it was read from.
    #[serde(skip)]
    text: String,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimbEntry {
    name: String,
    label: String,
    prefix: String,
    joints: Vec<JointEntry>,
    gripper: GripperEntry,
    end_effector: Vec<LinkFrame>,
    #[serde(default)]
    trackers: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct JointEntry {
    name: String,
    label: String,
    #[serde(default)]
    limits: Option<[f64; 2]>,
    #[serde(default)]
    home: f64,
    #[serde(default = "forward")]
    sign: f64,
    #[serde(default)]
    effort: f64,
    #[serde(default)]
    speed: f64,
    #[serde(default)]
    key: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct GripperEntry {
    name: String,
    kind: GripperKind,
    opening: [f64; 2],
    finger: Vec3,
    #[serde(default)]
    look: Option<FingerLook>,
    #[serde(default)]
    finger_joints: Vec<String>,
    #[serde(default)]
    fingers: [Vec<String>; 2],
    #[serde(default)]
    open_key: Option<String>,
    #[serde(default)]
    close_key: Option<String>,
}

/// A joint as the URDF has it.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfJoint {
    /// Its name there.
    pub name: String,
    /// True if it slides instead of turning.
    pub slides: bool,
    /// Least and greatest position, in rad or m; infinite if nothing limits it.
    pub limits: [f64; 2],
}

/// How far a joint that nothing limits turns either way, in rad, unless the file says otherwise: as far as the cables of many arms.
const ENDLESS_TURN: f64 = 2.0 * TAU;

/// Largest side of a finger, and widest opening of a gripper, in units.
const LARGEST_FINGER: f32 = 100.0;

/// The position that is farthest from 0, in rad or m.
const FARTHEST: f64 = 1e4;

/// Largest effort, in N or N m, and speed, in rad/s or m/s.
const MOST_EFFORT: f64 = 1e9;

fn is_position(position: f64) -> bool {
    (-FARTHEST..=FARTHEST).contains(&position)
}

const fn forward() -> f64 {
    1.0
}

/// The error of a `robot.ron` that cannot be used.
#[derive(Debug, Error)]
pub enum LayoutError {
    /// Its syntax is wrong.
    #[error("{}", located_ron_fault(.0))]
    Syntax(#[from] Box<SpannedError>),
    /// Its content makes no sense.
    #[error("{0}")]
    Fault(String),
}

fn fault(text: impl fmt::Display) -> LayoutError {
    LayoutError::Fault(text.to_string())
}

impl LayoutFile {
    /// Reads the text of a file.
    ///
    /// # Errors
    ///
    /// The first syntax error, with its place.
    pub fn read(text: &str) -> Result<Self, LayoutError> {
        let options = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let file: Self = options.from_str(text).map_err(Box::new)?;
        let text = text.to_owned();
        Ok(Self { text, ..file })
    }

    /// The line, from 1, in which a name first stands as a text.
    pub fn line_of(&self, name: &str) -> Option<usize> {
        let before = &self.text[..self.text.find(&format!("\"{name}\""))?];
        Some(1 + before.matches('\n').count())
    }

    /// A fault of the part with this name, with its line.
    fn locate(&self, name: &str, error: LayoutError) -> LayoutError {
        match (error, self.line_of(name)) {
            (LayoutError::Fault(text), Some(line)) => fault(format!("line {line}: {text}")),
            (error, _) => error,
        }
    }

    /// The layout. `in_urdf` finds the joint that the URDF has for a name; its limits count where the file has none.
    ///
    /// # Errors
    ///
    /// The content makes no sense; the error names the place.
    pub fn layout(
        &self,
        in_urdf: impl Fn(&str) -> Option<UrdfJoint>,
    ) -> Result<RobotLayout, LayoutError> {
        let mut joints = Vec::new();
        for (i, limb) in self.limbs.iter().enumerate() {
            for (place, joint) in limb.joints.iter().enumerate() {
                if self.still.iter().any(|(still, _)| *still == joint.name) {
                    let problem = fault(format!("still: {} is a joint of a limb", joint.name));
                    return Err(self.locate(&joint.name, problem));
                }
                let limb = LimbId(i as u8);
                let layout = joint.layout(JointRole::Limb { limb, place }, &in_urdf);
                joints.push(layout.map_err(|error| self.locate(&joint.name, error))?);
            }
        }
        let neck = self.neck.as_ref().map(|neck| {
            let layout = neck.layout(JointRole::Neck, &in_urdf);
            joints.push(layout.map_err(|error| self.locate(&neck.name, error))?);
            Ok::<_, LayoutError>(JointId(joints.len() as u16 - 1))
        });
        let neck = neck.transpose()?;
        let mut limbs = Vec::new();
        let mut first = 0;
        for (i, limb) in self.limbs.iter().enumerate() {
            let gripper = JointId(joints.len() as u16);
            let opening = limb.gripper.opening(LimbId(i as u8));
            joints.push(opening.map_err(|error| self.locate(&limb.gripper.name, error))?);
            let layout = limb.layout(first, gripper);
            limbs.push(layout.map_err(|error| self.locate(&limb.name, error))?);
            first += limb.joints.len() as u16;
        }
        if limbs.is_empty() {
            return Err(fault("there are no limbs"));
        }
        if limbs.len() > usize::from(u8::MAX) || joints.len() > usize::from(u16::MAX) {
            return Err(fault("there are too many limbs or joints"));
        }
        let layout = RobotLayout {
            name: self.name.clone(),
            joints,
            limbs,
            neck,
            base: self.base,
            camera: self.camera,
            hand_cameras: self.hand_cameras.clone(),
            screen: self.screen.clone(),
            known_postures: self.known_postures.clone(),
            may_touch: self.may_touch.clone(),
        };
        let farthest = CameraCarrier::FARTHEST;
        if !CameraCarrier::from(&layout).is_within(farthest) {
            return Err(fault(format!(
                "base or camera: a number is not from -{farthest} to {farthest}"
            )));
        }
        let postures = layout.known_postures.iter().flatten();
        if !postures.clone().all(|position| is_position(*position)) {
            return Err(fault(format!(
                "known_postures: a position is not from -{FARTHEST} to {FARTHEST}"
            )));
        }
        check_hand_cameras(&layout.hand_cameras)?;
        for (i, joint) in layout.joints.iter().enumerate() {
            if layout.find_joint(joint.name) != Some(JointId(i as u16)) {
                return Err(fault(format!("there are two joints {}", joint.name)));
            }
        }
        for (i, limb) in layout.limbs.iter().enumerate() {
            if layout.find_limb(limb.name) != Some(LimbId(i as u8)) {
                return Err(fault(format!("there are two limbs {}", limb.name)));
            }
        }
        Ok(layout)
    }
}

impl LimbEntry {
    fn layout(&self, first: u16, gripper: JointId) -> Result<LimbLayout, LayoutError> {
        if self.joints.is_empty() {
            return Err(fault(format!("limb {}: it has no joints", self.name)));
        }
        let joints: Vec<_> = (first..).map(JointId).take(self.joints.len()).collect();
        let trackers = self.trackers.iter().map(|name| {
            let place = self.joints.iter().position(|joint| joint.name == *name);
            place.map(|place| joints[place]).ok_or_else(|| {
                let limb = &self.name;
                fault(format!("limb {limb}: trackers: it has no joint {name}"))
            })
        });
        for frame in &self.end_effector {
            if !frame.is_frame() {
                let (limb, link) = (&self.name, &frame.link);
                return Err(fault(format!(
                    "limb {limb}: end_effector: its axes on {link} are not at right angles, of length 1 and right-handed, or it is over 1000 m away"
                )));
            }
        }
        Ok(LimbLayout {
            name: LimbName::new(&self.name)
                .map_err(|error| fault(format!("limb {}: {error}", self.name)))?,
            label: self.label.clone(),
            prefix: self.prefix.clone(),
            trackers: trackers.collect::<Result<_, _>>()?,
            joints,
            gripper: GripperLayout {
                joint: gripper,
                kind: self.gripper.kind,
                finger: self.gripper.finger,
                look: self.gripper.look.clone(),
                finger_joints: self.gripper.finger_joints.clone(),
                fingers: self.gripper.fingers.clone(),
            },
            end_effector: self.end_effector.clone(),
        })
    }
}

impl JointEntry {
    fn layout(
        &self,
        role: JointRole,
        in_urdf: impl Fn(&str) -> Option<UrdfJoint>,
    ) -> Result<JointLayout, LayoutError> {
        let Self { name, home, .. } = self;
        let found = in_urdf(name);
        let limits = match (self.limits, &found) {
            (Some(limits), _) => limits,
            (None, Some(found)) => found.own_limits()?,
            (None, None) => {
                return Err(fault(format!(
                    "joint {name}: neither this file nor the URDF gives its limits"
                )));
            }
        };
        check_limits(name, limits, *home)?;
        for (what, number) in [("effort", self.effort), ("speed", self.speed)] {
            if !(0.0..=MOST_EFFORT).contains(&number) {
                return Err(fault(format!(
                    "joint {name}: its {what} is {number}, expected 0 to {MOST_EFFORT}"
                )));
            }
        }
        if self.sign.abs() != 1.0 {
            return Err(fault(format!("joint {name}: its sign is neither 1 nor -1")));
        }
        let back = self.key.as_ref().map(|key| format!("Shift+{key}"));
        Ok(JointLayout {
            name: JointName::new(name).map_err(|error| fault(format!("joint {name}: {error}")))?,
            label: self.label.clone(),
            slides: found.as_ref().is_some_and(|found| found.slides),
            urdf_name: found.map_or_else(|| name.clone(), |found| found.name),
            role,
            limits,
            home: *home,
            sign: self.sign,
            effort: self.effort,
            speed: self.speed,
            keys: [self.key.clone(), back],
        })
    }
}

impl UrdfJoint {
    fn own_limits(&self) -> Result<[f64; 2], LayoutError> {
        let Self { name, limits, .. } = self;
        match *limits {
            [least, largest] if least == largest => Err(fault(format!(
                "joint {name}: the URDF lets it move from {least} to {largest} only: give it `limits` here"
            ))),
            [f64::NEG_INFINITY, f64::INFINITY] if !self.slides => Ok([-ENDLESS_TURN, ENDLESS_TURN]),
            limits => Ok(limits),
        }
    }
}

impl GripperEntry {
    /// Its opening as a joint.
    fn opening(&self, limb: LimbId) -> Result<JointLayout, LayoutError> {
        let Self { name, opening, .. } = self;
        let [least, widest] = *opening;
        check_limits(name, *opening, widest)?;
        if least < 0.0 || widest <= least {
            return Err(fault(format!(
                "gripper {name}: it cannot open from {least} to {widest} units"
            )));
        }
        if !self.finger.is_finite() || self.finger.min_element() <= 0.0 {
            return Err(fault(format!(
                "gripper {name}: its fingers have no extents"
            )));
        }
        if self.finger.max_element() > LARGEST_FINGER || widest > f64::from(LARGEST_FINGER) {
            return Err(fault(format!(
                "gripper {name}: a finger or its opening is larger than {LARGEST_FINGER} units"
            )));
        }
        Ok(JointLayout {
            name: JointName::new(name)
                .map_err(|error| fault(format!("gripper {name}: {error}")))?,
            urdf_name: name.clone(),
            slides: false,
            label: "gripper".to_owned(),
            role: JointRole::Gripper(limb),
            limits: *opening,
            home: widest,
            sign: 1.0,
            effort: 0.0,
            speed: 0.0,
            keys: [self.open_key.clone(), self.close_key.clone()],
        })
    }
}

fn check_hand_cameras(cameras: &[HandCameraLayout]) -> Result<(), LayoutError> {
    let mut first = Vec::new();
    for camera in cameras {
        let name = &camera.name;
        let Some(frame) = camera.frame.first() else {
            return Err(fault(format!("hand_cameras: {name}: it has no frame")));
        };
        if let Some(frame) = camera.frame.iter().find(|frame| !frame.is_frame()) {
            let link = &frame.link;
            return Err(fault(format!(
                "hand_cameras: {name}: its axes on {link} are not at right angles, of length 1 and right-handed"
            )));
        }
        let mut on_each = camera.frame.iter().map(|frame| camera.on(frame));
        if let Some(problem) = on_each.find_map(|camera| camera.fault()) {
            return Err(fault(format!("hand_cameras: {problem}")));
        }
        first.push(camera.on(frame));
    }
    match HandCamera::fault_of(&first) {
        Some(problem) => Err(fault(format!("hand_cameras: {problem}"))),
        None => Ok(()),
    }
}

fn check_limits(joint: &str, [least, largest]: [f64; 2], home: f64) -> Result<(), LayoutError> {
    if !(least.is_finite() && largest.is_finite() && least <= largest) {
        return Err(fault(format!(
            "joint {joint}: it cannot go from {least} to {largest}; expected two finite `limits`, the least first"
        )));
    }
    if !is_position(least) || !is_position(largest) {
        return Err(fault(format!(
            "joint {joint}: it goes from {least} to {largest}, expected `limits` from -{FARTHEST} to {FARTHEST}"
        )));
    }
    if !(least..=largest).contains(&home) {
        return Err(fault(format!(
            "joint {joint}: its home {home} is not within {least} and {largest}"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = include_str!("../../../../../assets/baxter/robot.ron");

    fn error(text: &str) -> String {
        let layout = LayoutFile::read(text).and_then(|file| file.layout(|_| None));
        layout.unwrap_err().to_string()
    }

    #[test]
    fn limits_of_the_urdf_count_where_the_file_has_none() {
        let text = TEXT.replacen("limits: (-1.7, 1.7), ", "", 1);
        assert_eq!(
            error(&text),
            "line 37: joint left_s0: neither this file nor the URDF gives its limits"
        );
        let file = LayoutFile::read(&text).unwrap();
        let layout = file.layout(|joint| (joint == "left_s0").then(|| joint_with([-1.0, 0.5])));
        assert_eq!(layout.unwrap().joints[0].limits, [-1.0, 0.5]);
    }

    fn joint_with(limits: [f64; 2]) -> UrdfJoint {
        UrdfJoint {
            name: "LeftS0".to_owned(),
            slides: false,
            limits,
        }
    }

    #[test]
    fn a_joint_that_nothing_limits_makes_two_turns() {
        let endless = |_: &str| Some(joint_with([f64::NEG_INFINITY, f64::INFINITY]));
        let layout = LayoutFile::read(TEXT).unwrap().layout(endless).unwrap();
        assert_eq!(layout.joints[0].limits, [-1.7, 1.7], "the file's count");
        let text = TEXT.replacen("limits: (-1.7, 1.7), ", "", 1);
        let layout = LayoutFile::read(&text).unwrap().layout(endless).unwrap();
        let [least, largest] = layout.joints[0].limits;
        assert!((largest.to_degrees() - 720.0).abs() < 1e-9 && least == -largest);
    }

    #[test]
    fn a_joint_that_the_urdf_does_not_let_move_is_refused() {
        let text = TEXT.replacen("limits: (-1.7, 1.7), ", "", 1);
        let file = LayoutFile::read(&text).unwrap();
        let error = file.layout(|_| Some(joint_with([0.0; 2]))).unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 37: joint LeftS0: the URDF lets it move from 0 to 0 only: give it `limits` here"
        );
    }

    #[test]
    fn a_joint_keeps_the_name_and_the_motion_of_the_urdf() {
        let file = LayoutFile::read(TEXT).unwrap();
        let sliding = |joint: &str| {
            (joint == "left_s0").then(|| UrdfJoint {
                slides: true,
                ..joint_with([0.0, 0.4])
            })
        };
        let layout = file.layout(sliding).unwrap();
        let [first, second, ..] = &layout.joints[..] else {
            panic!("no joints")
        };
        assert_eq!(
            (first.name.as_str(), &*first.urdf_name),
            ("left_s0", "LeftS0")
        );
        assert_eq!(second.urdf_name, "left_s1");
        assert!(first.slides && !second.slides);
        assert_eq!(first.manual_speed(), 0.1, "a unit per second");
        assert_eq!(second.manual_speed(), 1.0);
    }

    #[test]
    fn faults_name_their_subject() {
        for (from, to, expected) in [
            (
                "home: 0.25",
                "home: 2.5",
                "line 37: joint left_s0: its home 2.5",
            ),
            (
                "\"left_s1\"",
                "\"left_s0\"",
                "limb left: trackers: it has no joint left_s1",
            ),
            ("sign: -1", "sign: -2", "its sign is neither 1 nor -1"),
            (
                "opening: (0, 2)",
                "opening: (2, 0)",
                "cannot go from 2 to 0",
            ),
            (
                "name: \"right\"",
                "name: \"left\"",
                "there are two limbs left",
            ),
            ("limits:", "limit:", "limit"),
            (
                "name: \"right_hand_camera\"",
                "name: \"left_hand_camera\"",
                "hand_cameras: there are two cameras left_hand_camera",
            ),
            (
                "size: (200, 125)",
                "size: (0, 125)",
                "hand_cameras: left_hand_camera: 0x125 is no size",
            ),
            (
                "axes: ((1, 0, 0), (0, -1, 0), (0, 0, -1))",
                "axes: ((1, 0, 0), (0, 1, 0), (0, 0, -1))",
                "left_hand_camera: its axes on left_end_effector are not at right angles",
            ),
        ] {
            assert!(TEXT.contains(from), "{from}");
            let error = error(&TEXT.replacen(from, to, 1));
            assert!(error.contains(expected), "{from}: {error}");
        }
    }
}
