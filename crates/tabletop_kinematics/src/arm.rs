//! An arm: the seven turning joints between two links.

use glam::{DAffine3, DMat3, DVec3};

use crate::{JointId, JointType, JointValues, LinkId, ModelError, RobotModel};

/// Joints of an arm.
pub const ARM_JOINTS: usize = 7;

/// How a body moves: the velocity of one of its points and its angular velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DTwist {
    /// Of the point, in m/s, or in m per rad of a joint.
    pub linear: DVec3,
    /// In rad/s, or in rad per rad of a joint.
    pub angular: DVec3,
}

/// The seven turning joints from a base link to a tip link, compiled for speed: what is fixed between them is merged.
///
/// Everything is in the base link's frame, in m and rad; angles are in the order from the base to the tip.
#[derive(Clone, Debug)]
pub struct ArmChain {
    joints: [JointId; ARM_JOINTS],
    limits: [[f64; 2]; ARM_JOINTS],
    segments: [Segment; ARM_JOINTS],
    /// From the tip link's frame to that of the last joint's child.
    end: DAffine3,
}

/// A joint and what is rigid before it.
#[derive(Clone, Copy, Debug)]
struct Segment {
    /// From the joint's frame to that of the joint before it.
    origin: DAffine3,
    /// In the joint's frame.
    axis: DVec3,
}

impl ArmChain {
    /// The arm between two links of these names.
    ///
    /// ```
    /// use tabletop_kinematics::{ArmChain, baxter};
    ///
    /// let arm = ArmChain::between(&baxter()?, "torso", "right_end_effector")?;
    /// assert_eq!(arm.limits()[3], [-0.05, 2.618]);
    /// # Ok::<(), tabletop_kinematics::ModelError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// There are no such links, or between them are not exactly seven turning joints that follow no other one.
    pub fn between(model: &RobotModel, base: &str, tip: &str) -> Result<Self, ModelError> {
        Self::new(model, model.find_link(base)?, model.find_link(tip)?)
    }

    /// The arm between two links.
    ///
    /// # Errors
    ///
    /// Between them are not exactly seven turning joints that follow no other one.
    pub fn new(model: &RobotModel, base: LinkId, tip: LinkId) -> Result<Self, ModelError> {
        let no_arm = |reason: String| ModelError::NoArm {
            base: model.link(base).name.clone(),
            tip: model.link(tip).name.clone(),
            reason,
        };
        let mut way = Vec::new();
        let mut link = tip;
        while link != base {
            let Some(joint) = model.link(link).joint else {
                return Err(no_arm("the tip does not hang on the base".to_owned()));
            };
            way.push(joint);
            link = model.joint(joint).parent;
        }

        let (mut joints, mut segments) = (Vec::new(), Vec::new());
        let mut rigid = DAffine3::IDENTITY;
        for id in way.into_iter().rev() {
            let joint = model.joint(id);
            rigid *= joint.origin;
            if joint.kind == JointType::Fixed {
                continue;
            }
            if !joint.kind.turns() || joint.mimic.is_some() {
                return Err(no_arm(format!(
                    "joint {} does not turn by itself",
                    joint.name
                )));
            }
            joints.push(id);
            segments.push(Segment {
                origin: std::mem::replace(&mut rigid, DAffine3::IDENTITY),
                axis: joint.axis,
            });
        }
        let count = joints.len();
        match (joints.try_into(), segments.try_into()) {
            (Ok(joints), Ok(segments)) => Ok(Self {
                limits: <[JointId; ARM_JOINTS]>::map(joints, |joint| model.joint(joint).limits),
                joints,
                segments,
                end: rigid,
            }),
            _ => Err(no_arm(format!("there are {count} joints instead of seven"))),
        }
    }

    /// The same arm with other limits: least and largest angle of each joint, in rad.
    #[must_use]
    pub const fn with_limits(mut self, limits: [[f64; 2]; ARM_JOINTS]) -> Self {
        self.limits = limits;
        self
    }

    /// The joints.
    pub const fn joints(&self) -> &[JointId; ARM_JOINTS] {
        &self.joints
    }

    /// Least and largest angle of each joint, in rad.
    pub const fn limits(&self) -> &[[f64; 2]; ARM_JOINTS] {
        &self.limits
    }

    /// The angles of the arm in a configuration of the whole model.
    pub fn angles(&self, configuration: &JointValues) -> [f64; ARM_JOINTS] {
        self.joints.map(|joint| configuration[joint])
    }

    /// Writes the angles of the arm into a configuration of the whole model.
    pub fn set_angles(&self, angles: &[f64; ARM_JOINTS], configuration: &mut JointValues) {
        for (&joint, &angle) in self.joints.iter().zip(angles) {
            configuration[joint] = angle;
        }
    }

    /// The angles, moved within the limits.
    pub fn clamp(&self, angles: &[f64; ARM_JOINTS]) -> [f64; ARM_JOINTS] {
        std::array::from_fn(|i| angles[i].max(self.limits[i][0]).min(self.limits[i][1]))
    }

    /// Where the tip is: from its frame to the base's.
    pub fn tip(&self, angles: &[f64; ARM_JOINTS]) -> DAffine3 {
        let mut frame = DAffine3::IDENTITY;
        for (segment, &angle) in self.segments.iter().zip(angles) {
            frame = segment.turned(frame, angle);
        }
        frame * self.end
    }

    /// How the tip moves per rad of each joint (the geometric Jacobian), in the base's frame.
    pub fn jacobian(&self, angles: &[f64; ARM_JOINTS]) -> [DTwist; ARM_JOINTS] {
        self.tip_and_jacobian(angles).1
    }

    pub(crate) fn tip_and_jacobian(
        &self,
        angles: &[f64; ARM_JOINTS],
    ) -> (DAffine3, [DTwist; ARM_JOINTS]) {
        let mut frame = DAffine3::IDENTITY;
        let axes = std::array::from_fn::<_, ARM_JOINTS, _>(|i| {
            let segment = &self.segments[i];
            frame = segment.turned(frame, angles[i]);
            (frame.translation, frame.matrix3 * segment.axis)
        });
        let tip = frame * self.end;
        let jacobian = axes.map(|(origin, axis)| DTwist {
            linear: axis.cross(tip.translation - origin),
            angular: axis,
        });
        (tip, jacobian)
    }
}

impl Segment {
    fn turned(&self, before: DAffine3, angle: f64) -> DAffine3 {
        let mut frame = before * self.origin;
        frame.matrix3 *= DMat3::from_axis_angle(self.axis, angle);
        frame
    }
}
