//! The layout of a robot: its limbs and joints.

use bevy::{
    math::{DMat3, DQuat, DVec3},
    prelude::*,
};
use serde::{Deserialize, Serialize};
use tabletop_geometry::{Pose, UNITS_PER_METER};

use crate::{
    HandCamera, Table,
    robot::{
        FINGER_SPEED, MANUAL_SPEED,
        name::{JointName, LimbName},
    },
};

/// A joint of the robot, by its place in [`RobotLayout::joints`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
pub struct JointId(pub u16);

impl JointId {
    /// Its place in [`RobotLayout::joints`].
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A limb of the robot, by its place in [`RobotLayout::limbs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
pub struct LimbId(pub u8);

impl LimbId {
    /// Its place in [`RobotLayout::limbs`].
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The limbs and joints of the robot. The layout is read from a `robot.ron` (`docs/robot.md`) and a URDF, and never changes while the
/// program runs.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct RobotLayout {
    /// The robot's name.
    pub name: String,
    /// All joints, by [`JointId`]: those of the limbs, one limb after the other from its base to its tip, then the neck, then the
    /// openings of the grippers.
    pub joints: Vec<JointLayout>,
    /// The limbs, by [`LimbId`]: the order of rows in scripts.
    pub limbs: Vec<LimbLayout>,
    /// The joint that turns the head and its camera.
    pub neck: Option<JointId>,
    /// The place of the robot.
    pub base: BaseLayout,
    /// The place of its camera.
    pub camera: CameraLayout,
    /// The cameras on its links.
    pub hand_cameras: Vec<HandCameraLayout>,
    /// The link whose front shows a face.
    pub screen: Option<String>,
    /// Positions of the limbs' joints in postures that the real robot takes. If the solids of two links overlap in one of them, they are too
    /// rough there: these links never stop each other.
    pub known_postures: Vec<Vec<f64>>,
    /// Links, by name, that never stop each other.
    pub may_touch: Vec<(String, String)>,
}

/// A joint of the robot, or the opening of a gripper.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLayout {
    /// Its name in files and commands.
    pub name: JointName,
    /// Its name in the URDF, letter by letter; that of an opening is not there.
    pub urdf_name: String,
    /// Its name on the screen, beside that of its limb: `E1`.
    pub label: String,
    /// The part that it moves.
    pub role: JointRole,
    /// True if it slides instead of turning: its positions are then in m, its motor pulls in N.
    pub slides: bool,
    /// Least and greatest position, in rad or m; in units for a gripper's opening.
    pub limits: [f64; 2],
    /// Position when the program starts.
    pub home: f64,
    /// 1, or -1 for a joint that manual control turns the other way, so that the limbs move as mirror images.
    pub sign: f64,
    /// Largest torque of its motor, in N m or N, if the URDF gives none.
    pub effort: f64,
    /// Largest speed of its motor, in rad/s or m/s, if the URDF gives none.
    pub speed: f64,
    /// The key that moves it up and the one that moves it down unless the user binds others, as `robot.ron` names them.
    pub keys: [Option<String>; 2],
}

impl JointLayout {
    /// The value nearest to this one that is within the limits.
    pub const fn clamp(&self, value: f64) -> f64 {
        value.clamp(self.limits[0], self.limits[1])
    }

    /// Its speed in manual control, in rad/s; 1 unit/s for what slides: in m/s for a joint, in units/s for a gripper's opening.
    pub fn manual_speed(&self) -> f64 {
        match self.slides {
            true => MANUAL_SPEED / UNITS_PER_METER,
            false => MANUAL_SPEED,
        }
    }

    /// Its speed when it goes where it is sent, in rad/s or m/s, and in units/s for a gripper's opening: that of its motor, if the layout says so.
    pub fn travel_speed(&self) -> f64 {
        match self.role {
            JointRole::Gripper(_) => FINGER_SPEED,
            JointRole::Limb { .. } | JointRole::Neck if self.speed > 0.0 => self.speed,
            JointRole::Limb { .. } | JointRole::Neck => self.manual_speed(),
        }
    }

    /// True if it is the opening of a gripper, in units, and not an angle.
    pub const fn is_gripper(&self) -> bool {
        matches!(self.role, JointRole::Gripper(_))
    }

    /// The limb that it belongs to; `None` for the neck.
    pub const fn limb(&self) -> Option<LimbId> {
        match self.role {
            JointRole::Limb { limb, .. } | JointRole::Gripper(limb) => Some(limb),
            JointRole::Neck => None,
        }
    }
}

/// The part that a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointRole {
    /// A limb.
    Limb {
        /// The limb.
        limb: LimbId,
        /// Number of joints between it and the limb's base.
        place: usize,
    },
    /// The head.
    Neck,
    /// The fingers of a limb's gripper.
    Gripper(LimbId),
}

/// A limb of the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct LimbLayout {
    /// Its name in files and commands: `left`.
    pub name: LimbName,
    /// Its name on the screen: `Left`.
    pub label: String,
    /// Prefix of its tracked points' names in scripts: `l`.
    pub prefix: String,
    /// Its joints from the base to the tip.
    pub joints: Vec<JointId>,
    /// Its gripper.
    pub gripper: GripperLayout,
    /// The point midway between the fingers, as a frame on the first of these links that the URDF has.
    pub end_effector: Vec<LinkFrame>,
    /// The joints whose origins scripts may track.
    pub trackers: Vec<JointId>,
}

/// A gripper of the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct GripperLayout {
    /// The joint that is its opening.
    pub joint: JointId,
    /// The motion of its fingers.
    pub kind: GripperKind,
    /// Extents of a finger in units, along x, y and z of the end effector's frame; x is along the opening, z along the finger.
    pub finger: Vec3,
    /// Look of a finger; without it, the simulator draws the finger's collision shape.
    pub look: Option<FingerLook>,
    /// The joints of the fingers in the URDF; each moves by half of the opening. Only frames follow them.
    pub finger_joints: Vec<String>,
    /// The links of the URDF that its left and its right finger are, with all that hangs on them; they are no bodies of their own. Without
    /// any, a finger looks as `look` says.
    pub fingers: [Vec<String>; 2],
}

impl GripperLayout {
    /// Distances of the finger tips from the end effector when the gripper is wide open, across and along it, in units. `widest` is the
    /// largest opening.
    pub fn finger_ends(&self, widest: f64) -> Vec2 {
        Vec2::new(
            widest as f32 / 2.0 + self.finger.x / 2.0,
            self.finger.z / 2.0,
        )
    }
}

/// The motion of a gripper's fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum GripperKind {
    /// Two fingers move towards each other and stay parallel.
    Parallel,
}

/// A frame on a link.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkFrame {
    /// The link's name in the URDF.
    pub link: String,
    /// The frame's origin, in m in the link's frame.
    #[serde(default)]
    pub at: [f64; 3],
    /// The frame's x, y and z axis in the link's frame.
    #[serde(default = "unturned")]
    pub axes: [[f64; 3]; 3],
}

/// A camera on a link.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandCameraLayout {
    /// Its name.
    pub name: String,
    /// Its frame on the first of these links that the URDF has: x to the right in its pictures, y down, z the way it looks.
    pub frame: Vec<LinkFrame>,
    /// Angle between the lower and upper edges of its pictures in radians.
    pub fov: f32,
    /// Columns and rows of its pictures.
    pub size: (u32, u32),
}

impl HandCameraLayout {
    /// The camera where this frame has it.
    pub fn on(&self, frame: &LinkFrame) -> HandCamera {
        let [x, y, z] = frame.axes.map(DVec3::from_array);
        let axes = DMat3::from_cols(x, -y, -z);
        HandCamera {
            name: self.name.clone(),
            link: frame.link.clone(),
            mount: Pose::new(
                (DVec3::from_array(frame.at) * UNITS_PER_METER).as_vec3(),
                DQuat::from_mat3(&axes).normalize().as_quat(),
            ),
            vertical_fov: self.fov,
            width: self.size.0,
            height: self.size.1,
        }
    }
}

impl LinkFrame {
    /// True if its axes are at right angles, of length 1 and right-handed.
    pub(crate) fn is_frame(&self) -> bool {
        const PLAY: f64 = 1e-3;
        /// In m.
        const FARTHEST_FRAME: f64 = 1000.0;
        let [x, y, z] = self.axes.map(DVec3::from_array);
        let is_near = |one: DVec3, other: DVec3| (one - other).length() < PLAY;
        let is_turn = is_near(x.cross(y), z) && is_near(y.cross(z), x) && is_near(z.cross(x), y);
        is_turn && self.at.into_iter().all(|at| at.abs() <= FARTHEST_FRAME)
    }
}

/// The look of a finger.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FingerLook {
    /// Its shape file, of any kind that a URDF can name.
    pub file: String,
    /// The shape's x, y and z axes in the finger's frame: x towards the other finger, z along the finger, back to the wrist.
    #[serde(default = "unturned")]
    pub axes: [[f64; 3]; 3],
}

const fn unturned() -> [[f64; 3]; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

/// The place of the robot before the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[serde(deny_unknown_fields)]
pub struct BaseLayout {
    /// Distance from the table's near edge back to the origin of the URDF's root link, in units.
    pub behind_edge: f32,
    /// Height of that origin above the table's top, in units.
    pub height: f32,
}

impl BaseLayout {
    /// The frame of the URDF's root link before a table: x forward, along the table's Y, y left, z up.
    pub fn pose(&self, table: &Table) -> Pose {
        Pose::from_degrees(
            Vec3::new(0.0, -(table.yspan / 2.0 + self.behind_edge), self.height),
            Vec3::new(0.0, 0.0, 90.0),
        )
    }
}

/// The place of the head camera on the robot. Lengths in units, in axes like the table's: x right, y forward, z up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[serde(deny_unknown_fields)]
pub struct CameraLayout {
    /// Location of the neck's axis, from the robot's origin.
    pub neck: Vec3,
    /// Location of the camera, from the neck's axis.
    pub at: Vec3,
    /// Angle below the horizon at which it looks, in rad.
    pub tilt: f64,
}

/// The robot that carries the head camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct CameraCarrier {
    /// The place of the robot.
    pub base: BaseLayout,
    /// The place of the camera on it.
    pub camera: CameraLayout,
}

impl CameraCarrier {
    /// The number that is farthest from 0, in units or rad.
    pub const FARTHEST: f32 = 10_000.0;

    /// True if none of its numbers is farther from 0.
    pub fn is_within(&self, most: f32) -> bool {
        let Self { base, camera } = self;
        let places = [camera.neck, camera.at].map(|place| place.to_array());
        let places = places.into_iter().flatten();
        let mut lengths = [base.behind_edge, base.height].into_iter().chain(places);
        lengths.all(|length| length.abs() <= most) && camera.tilt.abs() <= f64::from(most)
    }
}

impl From<&RobotLayout> for CameraCarrier {
    fn from(layout: &RobotLayout) -> Self {
        Self {
            base: layout.base,
            camera: layout.camera,
        }
    }
}

impl RobotLayout {
    /// A joint.
    pub fn joint(&self, joint: JointId) -> &JointLayout {
        &self.joints[joint.index()]
    }

    /// A limb.
    pub fn limb(&self, limb: LimbId) -> &LimbLayout {
        &self.limbs[limb.index()]
    }

    /// All joints.
    pub fn joint_ids(&self) -> impl ExactSizeIterator<Item = JointId> + Clone + use<> {
        (0..self.joints.len() as u16).map(JointId)
    }

    /// All limbs.
    pub fn limb_ids(&self) -> impl ExactSizeIterator<Item = LimbId> + Clone + use<> {
        (0..self.limbs.len() as u8).map(LimbId)
    }

    /// The joint with this name.
    pub fn find_joint(&self, name: JointName) -> Option<JointId> {
        let found = self.joints.iter().position(|joint| joint.name == name)?;
        Some(JointId(found as u16))
    }

    /// The limb with this name.
    pub fn find_limb(&self, name: LimbName) -> Option<LimbId> {
        let found = self.limbs.iter().position(|limb| limb.name == name)?;
        Some(LimbId(found as u8))
    }

    /// A joint's name on the screen, with that of its limb: `Left E1`, `Left gripper`, `Head H0`.
    pub fn label_of(&self, joint: JointId) -> String {
        let JointLayout { label, role, .. } = self.joint(joint);
        match *role {
            JointRole::Limb { limb, .. } | JointRole::Gripper(limb) => {
                let limb = &self.limb(limb).label;
                [&**limb, label].join(" ").trim().to_owned()
            }
            JointRole::Neck => label.clone(),
        }
    }

    /// Largest number of joints of a limb: the number of columns in scripts.
    pub fn most_joints_of_a_limb(&self) -> usize {
        let counts = self.limbs.iter().map(|limb| limb.joints.len());
        counts.max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_those_of_the_limbs_then_the_neck_then_the_grippers() {
        let baxter = RobotLayout::baxter();
        let names: Vec<_> = baxter.joints.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(
            names,
            [
                "left_s0",
                "left_s1",
                "left_e0",
                "left_e1",
                "left_w0",
                "left_w1",
                "left_w2",
                "right_s0",
                "right_s1",
                "right_e0",
                "right_e1",
                "right_w0",
                "right_w1",
                "right_w2",
                "head_pan",
                "left_gripper",
                "right_gripper",
            ]
        );
        for id in baxter.joint_ids() {
            let joint = baxter.joint(id);
            assert_eq!(baxter.find_joint(joint.name), Some(id));
            let limb = joint.limb().map(|limb| baxter.limb(limb).name.as_str());
            let prefix = joint.name.as_str().split_once('_').unwrap().0;
            assert_eq!(limb, Some(prefix).filter(|prefix| *prefix != "head"));
        }
        assert_eq!(baxter.neck, Some(JointId(14)));
        assert_eq!(baxter.label_of(JointId(3)), "Left E1");
        assert_eq!(baxter.label_of(JointId(14)), "Head H0");
        assert_eq!(baxter.label_of(JointId(16)), "Right gripper");
    }

    #[test]
    fn home_is_within_the_limits_and_the_same_for_both_arms() {
        let baxter = RobotLayout::baxter();
        for joint in &baxter.joints {
            assert_eq!(joint.clamp(joint.home), joint.home, "{}", joint.name);
        }
        let [left, right] = &baxter.limbs[..] else {
            panic!("{} limbs", baxter.limbs.len())
        };
        for (left, right) in left.joints.iter().zip(&right.joints) {
            let (left, right) = (baxter.joint(*left), baxter.joint(*right));
            assert_eq!(left.home.to_bits(), (right.sign * right.home).to_bits());
            assert_eq!(left.limits, right.limits);
        }
    }

    #[test]
    fn the_fingers_ends_are_where_the_report_has_them() {
        let baxter = RobotLayout::baxter();
        let gripper = &baxter.limbs[0].gripper;
        assert_eq!(gripper.finger_ends(2.0), Vec2::new(1.15, 0.75));
    }
}
