//! Baxter, the robot of the report: its layout, and its arms and joints by name, for programs and tests made for it. All other code
//! asks the [`RobotLayout`].

use std::{fmt, sync::LazyLock};

use bevy::prelude::*;

use crate::robot::{
    layout::{BaseLayout, CameraCarrier, CameraLayout, JointId, JointLayout, LimbId, RobotLayout},
    layout_file::LayoutFile,
    name::{JointName, LimbName},
};

/// Joints of an arm of Baxter.
pub const JOINTS_PER_ARM: usize = 7;

/// Largest inner distance of the fingers of Baxter's grippers, in units.
pub const WIDEST_GRIP: f64 = 2.0;

impl RobotLayout {
    /// The Baxter of the report, with the limits of its table 1.
    pub fn baxter() -> &'static Self {
        static BAXTER: LazyLock<RobotLayout> = LazyLock::new(|| {
            let text = include_str!("../../../../../assets/baxter/robot.ron");
            let layout = LayoutFile::read(text).and_then(|file| file.layout(|_| None));
            layout.unwrap_or_else(|error| {
                error!("assets/baxter/robot.ron: {error}");
                RobotLayout::empty()
            })
        });
        &BAXTER
    }

    fn empty() -> Self {
        Self {
            name: String::new(),
            joints: Vec::new(),
            limbs: Vec::new(),
            neck: None,
            base: BaseLayout {
                behind_edge: 0.0,
                height: 0.0,
            },
            camera: CameraLayout {
                neck: Vec3::ZERO,
                at: Vec3::ZERO,
                tilt: 0.0,
            },
            hand_cameras: Vec::new(),
            screen: None,
            known_postures: Vec::new(),
            may_touch: Vec::new(),
        }
    }
}

impl Default for RobotLayout {
    /// [Baxter](Self::baxter).
    fn default() -> Self {
        Self::baxter().clone()
    }
}

impl Default for CameraCarrier {
    /// [Baxter](RobotLayout::baxter).
    fn default() -> Self {
        RobotLayout::baxter().into()
    }
}

/// One of Baxter's arms, as the robot sees them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Arm {
    /// The left arm, at negative X.
    Left,
    /// The right arm.
    Right,
}

impl Arm {
    /// The arms, in the order of the layout.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Its name.
    pub const fn name(self) -> LimbName {
        LimbName::from_static(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

impl fmt::Display for Arm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.name().fmt(f)
    }
}

impl From<Arm> for LimbId {
    fn from(arm: Arm) -> Self {
        Self(arm as u8)
    }
}

impl From<Arm> for LimbName {
    fn from(arm: Arm) -> Self {
        arm.name()
    }
}

/// One of Baxter's joints (report section 5, figure 10, table 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names are those of the report's figure 10")]
pub enum RobotJoint {
    LeftS0,
    LeftS1,
    LeftE0,
    LeftE1,
    LeftW0,
    LeftW1,
    LeftW2,
    RightS0,
    RightS1,
    RightE0,
    RightE1,
    RightW0,
    RightW1,
    RightW2,
    HeadPan,
    LeftGripper,
    RightGripper,
}

impl RobotJoint {
    /// All joints, in the order of the layout.
    pub const ALL: [Self; 17] = [
        Self::LeftS0,
        Self::LeftS1,
        Self::LeftE0,
        Self::LeftE1,
        Self::LeftW0,
        Self::LeftW1,
        Self::LeftW2,
        Self::RightS0,
        Self::RightS1,
        Self::RightE0,
        Self::RightE1,
        Self::RightW0,
        Self::RightW1,
        Self::RightW2,
        Self::HeadPan,
        Self::LeftGripper,
        Self::RightGripper,
    ];

    /// Its place in [`ALL`](Self::ALL) and in the layout.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The joints of an arm from shoulder to wrist: S0, S1, E0, E1, W0, W1, W2.
    pub fn of_arm(arm: Arm) -> [Self; JOINTS_PER_ARM] {
        std::array::from_fn(|i| Self::ALL[arm as usize * JOINTS_PER_ARM + i])
    }

    /// The gripper of an arm.
    pub const fn gripper(arm: Arm) -> Self {
        match arm {
            Arm::Left => Self::LeftGripper,
            Arm::Right => Self::RightGripper,
        }
    }

    /// Its entry in the layout.
    pub fn layout(self) -> &'static JointLayout {
        RobotLayout::baxter().joint(self.into())
    }

    /// Its name.
    pub fn name(self) -> JointName {
        self.layout().name
    }

    /// Least and largest value: table 1 of the report in radians, units for grippers.
    pub fn limits(self) -> (f64, f64) {
        self.layout().limits.into()
    }

    /// The value nearest to this one that is within the limits.
    pub fn clamp(self, value: f64) -> f64 {
        self.layout().clamp(value)
    }

    /// Its position when the program starts.
    pub fn home(self) -> f64 {
        self.layout().home
    }
}

impl fmt::Display for RobotJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.name().fmt(f)
    }
}

impl From<RobotJoint> for JointId {
    fn from(joint: RobotJoint) -> Self {
        Self(joint as u16)
    }
}

impl From<RobotJoint> for JointName {
    fn from(joint: RobotJoint) -> Self {
        joint.name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_layout() {
        for (joint, id) in RobotJoint::ALL
            .into_iter()
            .zip(RobotLayout::baxter().joint_ids())
        {
            assert_eq!(JointId::from(joint), id);
            assert_eq!(JointName::new(&format!("{joint:?}")), Ok(joint.name()));
        }
        for (arm, limb) in Arm::BOTH.into_iter().zip(&RobotLayout::baxter().limbs) {
            assert_eq!(arm.name(), limb.name);
            let gripper = RobotLayout::baxter().joint(limb.gripper.joint);
            assert_eq!(RobotJoint::gripper(arm).name(), gripper.name);
            assert_eq!(gripper.limits[1], WIDEST_GRIP);
        }
    }
}
