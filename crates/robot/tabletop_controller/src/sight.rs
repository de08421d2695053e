//! The world as a controller sees it.

use std::collections::BTreeMap;

use tabletop_core::{JointSpec, Shape, Table};
use tabletop_geometry::Pose;
use tabletop_kinematics::MOST_ARM_JOINTS;

/// The angles of an arm from its base to its tip, in rad; 0 beyond its last joint.
pub type Angles = [f64; MOST_ARM_JOINTS];

/// These angles, with 0 beyond the last.
pub fn angles(each: impl IntoIterator<Item = f64>) -> Angles {
    let mut all = Angles::default();
    for (place, angle) in all.iter_mut().zip(each) {
        *place = angle;
    }
    all
}

/// The world at the end of a tick.
#[derive(Clone, Debug, Default)]
pub struct Sight {
    /// The table.
    pub table: Table,
    /// The objects, by id.
    pub objects: BTreeMap<String, SeenObject>,
    /// Joints between objects.
    pub joints: Vec<JointSpec>,
    /// The robot's limbs.
    pub limbs: Vec<LimbSight>,
}

/// An object that is seen.
#[derive(Clone, Debug)]
pub struct SeenObject {
    /// Its shape.
    pub shape: Shape,
    /// Its pose.
    pub pose: Pose,
    /// True if nothing can move it.
    pub is_fixed: bool,
}

/// A limb of the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LimbSight {
    /// The angles of its joints, in rad.
    pub angles: Angles,
    /// Opening of its gripper, in units.
    pub opening: f64,
    /// Ids of the objects that its gripper holds.
    pub holds: Vec<String>,
    /// Whether the gripper of a real robot says that it holds something; `None` in a simulation.
    pub says_it_grips: Option<bool>,
    /// The obstacle in its way.
    pub blocked_by: Option<String>,
}
