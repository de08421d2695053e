//! Faults in the description of a robot.

use thiserror::Error;

/// The error of a text that is no robot, or of a robot that lacks a link or joint. Lines count from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ModelError {
    /// The text is no URDF.
    #[error("line {line}: {element}: {message}")]
    Syntax {
        /// The line in which the element starts.
        line: usize,
        /// The element that cannot be read, such as `joint left_s0`.
        element: String,
        /// The reader's message.
        message: String,
    },
    /// The text is a template of URDFs.
    #[error(
        "line {line}: {found} is xacro, which makes URDF: expand it with `xacro NAME.urdf.xacro > NAME.urdf` (ROS, or `pip install xacro`) and use the result"
    )]
    Xacro {
        /// The line of the first element that is.
        line: usize,
        /// The element, or the expression in it.
        found: String,
    },
    /// Elements inside elements without end.
    #[error("line {line}: elements are nested more than {deepest} deep")]
    TooDeep {
        /// The line in which the first one too many starts.
        line: usize,
        /// As deep as they may be.
        deepest: usize,
    },
    /// Two links or two joints have one name.
    #[error(
        "line {line}: there is already a {what} named {name}: give each {what} a name of its own"
    )]
    Duplicate {
        /// The line in which the second one starts.
        line: usize,
        /// `link` or `joint`.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A joint names a link that is not there.
    #[error("line {line}: joint {joint}: there is no link {link}")]
    MissingLink {
        /// The line in which the joint starts.
        line: usize,
        /// The joint.
        joint: String,
        /// The link that it names.
        link: String,
    },
    /// Two joints carry one link.
    #[error("line {line}: joint {joint}: link {link} already hangs on joint {other}")]
    TwoParents {
        /// The line in which the second joint starts.
        line: usize,
        /// The second joint.
        joint: String,
        /// The link.
        link: String,
        /// The first joint.
        other: String,
    },
    /// The text holds no link.
    #[error("there is no link: a robot has at least one")]
    Empty,
    /// Several links hang on nothing.
    #[error(
        "line {line}: link {link} hangs on no joint, and neither does {root}: only one link may be the root"
    )]
    SecondRoot {
        /// The line in which the second root starts.
        line: usize,
        /// The second root.
        link: String,
        /// The first root.
        root: String,
    },
    /// Links hang on one another in a ring.
    #[error("line {line}: link {link} hangs on itself by way of its joints")]
    Cycle {
        /// The line in which a link of the ring starts.
        line: usize,
        /// That link.
        link: String,
    },
    /// A joint of a kind that no arm has.
    #[error(
        "line {line}: joint {joint}: {kind} joints are not supported: use fixed, revolute, continuous or prismatic"
    )]
    JointType {
        /// The line in which the joint starts.
        line: usize,
        /// The joint.
        joint: String,
        /// Its kind.
        kind: &'static str,
    },
    /// A joint follows one that it cannot follow.
    #[error("line {line}: joint {joint}: it cannot mimic {leader}: {reason}")]
    Mimic {
        /// The line in which the joint starts.
        line: usize,
        /// The joint.
        joint: String,
        /// The joint that it names.
        leader: String,
        /// The fault.
        reason: &'static str,
    },
    /// A number that cannot be.
    #[error("line {line}: {element}: {fault}")]
    Number {
        /// The line in which the element starts.
        line: usize,
        /// Whose number it is, such as `joint left_s0`.
        element: String,
        /// The fault.
        fault: &'static str,
    },
    /// There is no such link.
    #[error("robot {robot} has no link {link}")]
    NoSuchLink {
        /// The robot's name.
        robot: String,
        /// The link's name.
        link: String,
    },
    /// There is no such joint.
    #[error("robot {robot} has no joint {joint}")]
    NoSuchJoint {
        /// The robot's name.
        robot: String,
        /// The joint's name.
        joint: String,
    },
    /// The way between two links is no arm.
    #[error("no arm leads from link {base} to link {tip}: {reason}")]
    NoArm {
        /// The link in which the arm should start.
        base: String,
        /// The link in which it should end.
        tip: String,
        /// The reason why it cannot.
        reason: String,
    },
}
