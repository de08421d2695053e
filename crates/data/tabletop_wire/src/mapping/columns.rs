//! Numbers of states and actions.

use serde::Deserialize;

/// A number of a state.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum StateColumn {
    /// Where a joint is.
    Joint(ScaledJoint),
    /// Where an end effector is, in the frame of the robot's base.
    EndEffector {
        /// The limb.
        limb: String,
        /// The part of its pose.
        part: PosePart,
        /// What is added: where that frame is in another one.
        #[serde(default)]
        plus: f64,
    },
    /// Always this number.
    Constant(f64),
}

/// What a number of an action does.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ActionColumn {
    /// It is where a joint is to be at the action's end.
    Position(ScaledJoint),
    /// It is the speed of a joint.
    Velocity {
        /// The joint.
        joint: String,
        /// The speed of a number 1, in rad/s; in units/s for a gripper's opening.
        scale: f64,
    },
    /// It displaces an end effector from where the action begins, in the frame of the robot's base.
    Displacement {
        /// The limb.
        limb: String,
        /// The part of its pose.
        part: PosePart,
        /// What a number 1 displaces, in m or rad.
        scale: f64,
    },
    /// It does nothing.
    Ignored,
}

/// A joint whose positions are numbers between two others. Without them, they are the robot's own: in rad, m for joints that slide, units for a gripper's opening.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaledJoint {
    /// The joint's name.
    pub name: String,
    /// The position whose number is 0.
    #[serde(default)]
    pub zero: f64,
    /// The position whose number is 1.
    #[serde(default = "unscaled")]
    pub one: f64,
}

const fn unscaled() -> f64 {
    1.0
}

impl ScaledJoint {
    /// The number of a position.
    pub fn number(&self, position: f64) -> f64 {
        (position - self.zero) / (self.one - self.zero)
    }

    /// The position of a number.
    pub fn position(&self, number: f64) -> f64 {
        self.zero + (self.one - self.zero) * number
    }
}

/// A part of an end effector's pose: its location in m, or its rotation as a vector along the axis, as long as the angle in rad. The rotation is of the frame
/// whose y is along the opening and whose z leads out of the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum PosePart {
    /// Along x: in front of the robot.
    X,
    /// Along y: to its left.
    Y,
    /// Along z: up.
    Z,
    /// About x.
    TurnX,
    /// About y.
    TurnY,
    /// About z.
    TurnZ,
}

impl PosePart {
    /// Its place among the six.
    pub const fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
            Self::TurnX => 3,
            Self::TurnY => 4,
            Self::TurnZ => 5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gripper_that_is_open_at_zero_is_closed_at_one() {
        let gripper = ScaledJoint {
            name: "panda_gripper".into(),
            zero: 0.8,
            one: 0.0,
        };
        assert_eq!(gripper.number(0.8), 0.0);
        assert_eq!(gripper.number(0.0), 1.0);
        assert!((gripper.position(0.25) - 0.6).abs() < 1e-12);
    }
}
